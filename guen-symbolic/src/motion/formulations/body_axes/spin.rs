//! Velocities along the axes of a body: its angular velocity, and those of its mass centre.

use super::is_orthogonal;
use super::slopes::{normal, rates_of};
use crate::algebra::{ExprId, Flow, Rational};
use crate::motion::coordinates::restriction::Restriction;
use crate::motion::definition::projection::Measured;
use crate::motion::{Frame, Mechanics};
use crate::workbench::Workbench;

/// Three velocities along the axes of a body.
pub(super) struct Triple {
    /// Along `X_0..X_l`.
    pub(super) along: Vec<[ExprId; 3]>,
    /// The velocities in the motion.
    pub(super) values: [ExprId; 3],
    /// The rates of these at fixed `eta`.
    pub(super) rates: [ExprId; 3],
}

impl Triple {
    pub(super) fn measured(&self, a: usize, turning: Vec<ExprId>) -> Measured {
        Measured {
            value: self.values[a],
            components: self.along[1..].iter().map(|along| along[a]).collect(),
            drift: self.along[0][a],
            acceleration: self.rates[a],
            turning,
        }
    }
}

/// The velocities of a centre as they depend on the parameters.
pub(super) fn in_parameters(
    bench: &mut Workbench,
    system: &Mechanics,
    restriction: &mut Restriction,
    flows: &mut Flows<'_>,
    rows: &[[ExprId; 3]; 3],
    world: &[[ExprId; 3]],
) -> Option<Triple> {
    let mut along: Vec<[ExprId; 3]> = Vec::with_capacity(world.len());
    for world in world {
        let mut own = [bench.graph.zero(); 3];
        for (a, own) in own.iter_mut().enumerate() {
            let sum = bench.dot(&column(rows, a), world);
            *own = normal(bench, restriction, sum)?;
        }
        along.push(own);
    }
    let values: [ExprId; 3] = std::array::from_fn(|a| {
        let value = in_motion(bench, system, |s| along[s][a]);
        bench.keep_large(value)
    });
    let rates = by_slopes(bench, system, restriction, flows, &along).unwrap_or_else(|| {
        values.map(|value| {
            let rate = flows.frame.motion.of(&mut bench.graph, value);
            bench.keep_large(rate)
        })
    });
    Some(Triple { along, values, rates })
}

/// The rates at fixed `eta` of what is linear in these, from those of its components.
fn by_slopes(
    bench: &mut Workbench,
    system: &Mechanics,
    restriction: &mut Restriction,
    flows: &mut Flows<'_>,
    along: &[[ExprId; 3]],
) -> Option<[ExprId; 3]> {
    let weights = &system.etas[..system.forms.degrees];
    let entries: Vec<ExprId> = along.iter().flatten().copied().collect();
    let rates = rates_of(bench, restriction, &entries, weights, |bench, e| {
        (0..along.len()).map(|s| flows.along(bench, s, e)).collect()
    })?;
    Some(std::array::from_fn(|a| {
        let rate = in_motion(bench, system, |s| rates[3 * s + a]);
        bench.keep_large(rate)
    }))
}

/// Derivatives along each of `X_0..X_l`.
pub(super) struct Flows<'a> {
    frame: &'a mut Frame,
    drift: Flow,
}

impl<'a> Flows<'a> {
    pub(super) fn new(bench: &Workbench, system: &Mechanics, frame: &'a mut Frame) -> Self {
        let forms = &system.forms;
        let rates = forms.coordinates.iter().copied().zip(frame.operators.xi[0].iter().copied());
        let drift = Flow::new(&bench.graph, rates.chain([(forms.time, bench.graph.one())]));
        Flows { frame, drift }
    }

    pub(super) fn along(&mut self, bench: &mut Workbench, s: usize, e: ExprId) -> ExprId {
        let flow = if s == 0 { &mut self.drift } else { &mut self.frame.displacements[s - 1] };
        flow.of(&mut bench.graph, e)
    }
}

/// The angular velocity of a body in its own axes.
pub(super) struct Spin {
    /// Along `X_0..X_l`, in normal form: the poles of the angles are gone.
    pub(super) along: Vec<[ExprId; 3]>,
    /// The angular velocity in the motion.
    pub(super) values: [ExprId; 3],
}

impl Spin {
    /// `[omega]x = R^T X_s(R)`.
    pub(super) fn new(
        bench: &mut Workbench,
        system: &Mechanics,
        restriction: &mut Restriction,
        flows: &mut Flows<'_>,
        rows: &[[ExprId; 3]; 3],
    ) -> Self {
        let along: Vec<[ExprId; 3]> = (0..=system.forms.degrees)
            .map(|s| {
                std::array::from_fn(|a| {
                    // omega_a = (R^T R')_kj
                    let (j, k) = ((a + 1) % 3, (a + 2) % 3);
                    let rates = rows.map(|row| flows.along(bench, s, row[j]));
                    let sum = bench.dot(&column(rows, k), &rates);
                    restriction.tidy(bench, sum)
                })
            })
            .collect();
        let values = std::array::from_fn(|a| {
            let value = in_motion(bench, system, |s| along[s][a]);
            bench.keep_large(value)
        });
        Spin { along, values }
    }

    /// The rates at fixed `eta`: those of each component along each operator by themselves, so that no pole is left.
    pub(super) fn rates(
        &self,
        bench: &mut Workbench,
        system: &Mechanics,
        restriction: &mut Restriction,
        flows: &mut Flows<'_>,
    ) -> [ExprId; 3] {
        let l = system.forms.degrees;
        std::array::from_fn(|a| {
            let mut rates = Vec::new();
            for along in &self.along {
                let slopes: Vec<ExprId> = (0..=l)
                    .map(|r| {
                        let slope = flows.along(bench, r, along[a]);
                        restriction.tidy(bench, slope)
                    })
                    .collect();
                rates.push(in_motion(bench, system, |r| slopes[r]));
            }
            let rate = in_motion(bench, system, |s| rates[s]);
            bench.keep_large(rate)
        })
    }

    /// Returns the velocities with their rates.
    pub(super) fn triple(
        &self,
        bench: &mut Workbench,
        system: &Mechanics,
        restriction: &mut Restriction,
        flows: &mut Flows<'_>,
    ) -> Triple {
        let rates = self.rates(bench, system, restriction, flows);
        Triple { along: self.along.clone(), values: self.values, rates }
    }

    /// The velocities of a centre as linear functions of the angular velocity, `u = rho omega`: where the parameters are spins
    /// about other axes than the body's, `rho` is short and the components along the operators are long.
    pub(super) fn by_spin(
        &self,
        bench: &mut Workbench,
        system: &Mechanics,
        restriction: &mut Restriction,
        flows: &mut Flows<'_>,
        rows: &[[ExprId; 3]; 3],
        world: &[[ExprId; 3]],
    ) -> Option<Triple> {
        let Spin { along, values } = self;
        let still = along[0].iter().chain(&world[0]).all(|e| bench.graph.is_zero(*e));
        let constant = along.iter().flatten().all(|e| bench.graph.roles(*e).is_constant());
        let by_parameter: &[[ExprId; 3]; 3] = along[1..].try_into().ok()?;
        if !still || constant || !is_orthogonal(bench, by_parameter) {
            return None;
        }
        let mut rho = [[bench.graph.zero(); 3]; 3];
        for (a, row) in rho.iter_mut().enumerate() {
            let own: Vec<ExprId> =
                world[1..].iter().map(|world| bench.dot(&column(rows, a), world)).collect();
            for (b, entry) in row.iter_mut().enumerate() {
                let sum = bench.dot(&own, &column(by_parameter, b));
                *entry = normal(bench, restriction, sum)?;
            }
        }
        let rates = self.rates(bench, system, restriction, flows);
        // Along the body's own axes, of which the components know.
        let entries: Vec<ExprId> = rho.iter().flatten().copied().collect();
        let slopes = rates_of(bench, restriction, &entries, values, |bench, e| {
            let slopes: Vec<ExprId> = (0..along.len()).map(|s| flows.along(bench, s, e)).collect();
            let own = (0..3).map(|b| bench.dot(&column(by_parameter, b), &slopes[1..]));
            let own: Vec<ExprId> = own.collect();
            [vec![slopes[0]], own].concat()
        });
        let mut of_row = |bench: &mut Workbench, a: usize| {
            let along = along.iter().map(|spin| {
                let component = bench.dot(&rho[a], spin);
                bench.keep_large(component)
            });
            let along: Vec<ExprId> = along.collect();
            let value = bench.dot(&rho[a], values);
            let slopes = match &slopes {
                Some(slopes) => [0, 1, 2].map(|b| slopes[3 * a + b]),
                None => rho[a].map(|e| flows.frame.motion.of(&mut bench.graph, e)),
            };
            let (first, second) = (bench.dot(&slopes, values), bench.dot(&rho[a], &rates));
            let rate = bench.graph.add(first, second);
            (along, bench.keep_large(value), bench.keep_large(rate))
        };
        let [x, y, z] = [0, 1, 2].map(|a| of_row(bench, a));
        Some(Triple {
            along: (0..along.len()).map(|s| [x.0[s], y.0[s], z.0[s]]).collect(),
            values: [x.1, y.1, z.1],
            rates: [x.2, y.2, z.2],
        })
    }

    /// `omega_s x u - omega x u_s`, for each `X_s`.
    pub(super) fn crossed(&self, bench: &mut Workbench, a: usize, u: &Triple) -> Vec<ExprId> {
        let (j, k) = ((a + 1) % 3, (a + 2) % 3);
        let Spin { along, values } = self;
        (1..along.len())
            .map(|s| {
                let products = [
                    (along[s][j], u.values[k], Rational::ONE),
                    (along[s][k], u.values[j], -Rational::ONE),
                    (values[j], u.along[s][k], -Rational::ONE),
                    (values[k], u.along[s][j], Rational::ONE),
                ];
                let terms: Vec<_> =
                    products.into_iter().map(|(x, y, sign)| (bench.graph.mul(x, y), sign)).collect();
                let sum = bench.graph.linear(&terms);
                bench.keep_large(sum)
            })
            .collect()
    }

    /// `omega_s x omega`, for each `X_s`.
    pub(super) fn crossed_with_itself(&self, bench: &mut Workbench, a: usize) -> Vec<ExprId> {
        let (j, k) = ((a + 1) % 3, (a + 2) % 3);
        let Spin { along, values } = self;
        along[1..]
            .iter()
            .map(|along| {
                let plus = bench.graph.mul(along[j], values[k]);
                let minus = bench.graph.mul(along[k], values[j]);
                let sum = bench.graph.sub(plus, minus);
                bench.keep_large(sum)
            })
            .collect()
    }
}

pub(super) fn column(rows: &[[ExprId; 3]; 3], a: usize) -> [ExprId; 3] {
    [rows[0][a], rows[1][a], rows[2][a]]
}

/// `e_0 + sum_s e_s eta_s`.
fn in_motion(bench: &mut Workbench, system: &Mechanics, e: impl Fn(usize) -> ExprId) -> ExprId {
    let l = system.forms.degrees;
    let terms: Vec<ExprId> = (1..=l).map(|s| bench.graph.mul(e(s), system.etas[s - 1])).collect();
    bench.graph.sum(terms.into_iter().chain([e(0)]))
}
