//! A declared system in numbers: its forms, energies and forces as tapes, and states to look at it.
//!
//! Nothing here comes from the derivation: `T°`, `U`, the forces and the forms are evaluated as they were declared.

use guen_symbolic::{ExprId, Graph, Mechanics};

use crate::draw::Draw;
use crate::scalar::{Dual, Scalar, solve};
use crate::tape::Tape;

/// The declared functions, and the places of symbols in a point.
pub struct Declared {
    pub n: usize,
    pub degrees: usize,
    pub time: usize,
    pub x: Vec<usize>,
    pub velocities: Vec<usize>,
    pub etas: Vec<usize>,
    pub accelerations: Vec<usize>,
    symbols: usize,
    forms: Tape,
    kinetic: Tape,
    potential: Tape,
    magnitudes: Tape,
    along: Tape,
    positions: Tape,
    bound: Vec<usize>,
}

impl Declared {
    pub fn new(graph: &Graph, system: &Mechanics) -> Self {
        let places = |symbols: &[ExprId]| -> Vec<usize> {
            symbols.iter().map(|s| graph.as_symbol(*s).expect("a symbol").index()).collect()
        };
        let forms: Vec<ExprId> = system
            .forms
            .forms
            .iter()
            .flat_map(|form| form.row.iter().chain([&form.offset]))
            .copied()
            .collect();
        let magnitudes: Vec<ExprId> = system.forces.iter().map(|force| force.magnitude).collect();
        let along: Vec<ExprId> = system.forces.iter().map(|force| force.along).collect();
        let positions: Vec<ExprId> = system.holonomic.iter().map(|h| h.equation).collect();
        // The coordinate that an equation is solved for: the only one that its row has alone.
        let bound = system
            .holonomic
            .iter()
            .map(|h| {
                let others: Vec<_> = system.holonomic.iter().filter(|o| o.form != h.form).collect();
                let own = |i: &usize| {
                    system.forms.forms[h.form].row[*i] == graph.one()
                        && others.iter().all(|o| graph.is_zero(system.forms.forms[o.form].row[*i]))
                };
                let i = (0..system.forms.len()).find(own).expect("positions have a coordinate of their own");
                places(&system.forms.coordinates)[i]
            })
            .collect();
        Declared {
            n: system.forms.len(),
            degrees: system.forms.degrees,
            time: places(&[system.forms.time])[0],
            x: places(&system.forms.coordinates),
            velocities: places(&system.velocities),
            etas: places(&system.etas),
            accelerations: places(&system.accelerations),
            symbols: graph.symbols().count(),
            forms: Tape::new(graph, &forms),
            kinetic: Tape::new(graph, &[system.kinetic_energy]),
            potential: Tape::new(graph, &[system.force_function]),
            magnitudes: Tape::new(graph, &magnitudes),
            along: Tape::new(graph, &along),
            positions: Tape::new(graph, &positions),
            bound,
        }
    }

    /// A random state on the constraints: values of all symbols, `eta'` left at zero.
    pub fn state(&self, draw: &mut Draw) -> Vec<f64> {
        // Constants and inputs are the symbols without a place of their own.
        let point = (0..self.symbols).map(|_| draw.real(0.5, 1.5)).collect();
        self.moved(point, draw)
    }

    /// Another state with the same constants and inputs.
    pub fn moved(&self, mut point: Vec<f64>, draw: &mut Draw) -> Vec<f64> {
        for i in self.x.iter().chain([&self.time]) {
            point[*i] = draw.real(-1.0, 1.0);
        }
        for i in &self.etas[..self.degrees] {
            point[*i] = draw.real(-1.5, 1.5);
        }
        for i in self.etas[self.degrees..].iter().chain(&self.accelerations) {
            point[*i] = 0.0;
        }
        // x_b + f(t, others) = 0
        for (i, value) in self.bound.iter().zip(self.positions.at(&point)) {
            point[*i] -= value;
        }
        self.set_velocities(&mut point);
        point
    }

    /// `x'` from the `eta` of a point.
    pub fn set_velocities(&self, point: &mut [f64]) {
        let forms = self.forms_at(point);
        let matrix = forms.iter().map(|row| row[..self.n].to_vec()).collect();
        let right = forms.iter().zip(&self.etas).map(|(row, eta)| vec![point[*eta] - row[self.n]]).collect();
        for (i, value) in self.velocities.iter().zip(solve(matrix, right)) {
            point[*i] = value[0];
        }
    }

    /// `a_j1..a_jn, a_j0` for each form.
    pub fn forms_at<R: Scalar>(&self, point: &[R]) -> Vec<Vec<R>> {
        self.forms.at(point).chunks(self.n + 1).map(<[R]>::to_vec).collect()
    }

    /// `X_0..X_n` as vector fields over `t, x_1..x_n`, from the inverse of the forms.
    pub fn fields_at<R: Scalar>(&self, point: &[R]) -> Vec<Vec<R>> {
        let n = self.n;
        let forms = self.forms_at(point);
        let matrix = forms.iter().map(|row| row[..n].to_vec()).collect();
        // A xi_0 = -a_0, A xi_j = e_j
        let right = forms
            .iter()
            .enumerate()
            .map(|(k, row)| {
                let unit = (0..n).map(|j| R::constant(if j == k { 1.0 } else { 0.0 }));
                [row[n].scaled(-1.0)].into_iter().chain(unit).collect()
            })
            .collect();
        let columns: Vec<Vec<R>> = solve(matrix, right);
        (0..=n)
            .map(|j| {
                let time = R::constant(if j == 0 { 1.0 } else { 0.0 });
                [time].into_iter().chain(columns.iter().map(|row| row[j].clone())).collect()
            })
            .collect()
    }

    /// The rates of all symbols along a vector field over `t, x_1..x_n`.
    pub fn along_field(&self, point: &[f64], field: &[f64]) -> Vec<f64> {
        let mut rates = vec![0.0; point.len()];
        for (place, rate) in [self.time].iter().chain(&self.x).zip(field) {
            rates[*place] = *rate;
        }
        rates
    }

    /// The partial derivatives of `a_j1..a_jn, a_j0` by `t, x_1..x_n`, outermost index first.
    pub fn form_slopes(&self, point: &[f64]) -> Vec<Vec<Vec<f64>>> {
        [self.time]
            .iter()
            .chain(&self.x)
            .map(|place| {
                let moving = lift(point, |k| if k == *place { 1.0 } else { 0.0 });
                self.forms_at(&moving).iter().map(|row| row.iter().map(|a| a.du).collect()).collect()
            })
            .collect()
    }

    /// Sets the `eta` of a point to the forms of its `x'`.
    pub fn set_etas<R: Scalar>(&self, point: &mut [R]) {
        for (row, eta) in self.forms_at(point).iter().zip(&self.etas) {
            point[*eta] = self
                .velocities
                .iter()
                .zip(row)
                .fold(row[self.n].clone(), |sum, (v, a)| sum.plus(&point[*v].times(a)));
        }
    }

    /// `T°` as a function of `t, x, x'` alone.
    pub fn kinetic<R: Scalar>(&self, mut point: Vec<R>) -> R {
        self.set_etas(&mut point);
        self.kinetic.at(&point).remove(0)
    }

    /// `T°` as a function of `t, x, eta_1..eta_n` alone.
    pub fn kinetic_of_etas<R: Scalar>(&self, mut point: Vec<R>) -> R {
        let forms = self.forms_at(&point);
        let matrix = forms.iter().map(|row| row[..self.n].to_vec()).collect();
        let right =
            forms.iter().zip(&self.etas).map(|(row, eta)| vec![point[*eta].minus(&row[self.n])]).collect();
        for (i, mut value) in self.velocities.iter().zip(solve(matrix, right)) {
            point[*i] = value.remove(0);
        }
        self.kinetic.at(&point).remove(0)
    }

    /// `U`.
    pub fn potential<R: Scalar>(&self, point: &[R]) -> R {
        self.potential.at(point).remove(0)
    }

    /// `Q_i`: each force times the derivative of its form by `x_i'`.
    pub fn generalised_forces(&self, point: &[f64]) -> Vec<f64> {
        let magnitudes = self.magnitudes.at(point);
        (0..self.n)
            .map(|i| {
                let mut moving = lift(point, |k| if k == self.velocities[i] { 1.0 } else { 0.0 });
                self.set_etas(&mut moving);
                self.along.at(&moving).iter().zip(&magnitudes).map(|(form, f)| form.du * f).sum()
            })
            .collect()
    }

    /// The rates of all symbols along a motion: `t' = 1`, `x'`, and `eta'` for the parameters.
    pub fn rates(&self, point: &[f64], accelerations: &[f64]) -> Vec<f64> {
        let mut rates = vec![0.0; point.len()];
        rates[self.time] = 1.0;
        for (x, v) in self.x.iter().zip(&self.velocities) {
            rates[*x] = point[*v];
        }
        for (eta, value) in self.etas.iter().zip(accelerations) {
            rates[*eta] = *value;
        }
        rates
    }
}

/// The point with each symbol moving at a rate.
pub fn lift(point: &[f64], rate: impl Fn(usize) -> f64) -> Vec<Dual<f64>> {
    point.iter().enumerate().map(|(k, value)| Dual { re: *value, du: rate(k) }).collect()
}
