//! The second route: the kinetic energy as weighted products of velocity forms, projected on the operators.
//!
//! For a term `w u v` of `T°`, with `u_s` the component of `u` along `X_s`, (2.7) becomes
//!
//! ```text
//! w (u' v_s + v' u_s) + w (u E_s(v) + v E_s(u)) + D(w) (u v_s + v u_s) - X_s(w) u v,
//! ```
//!
//! where `D` is the rate along the motion at fixed `eta`, `u' = D(u) + sum_t eta_t' u_t`, and `E_s(u)` is the exterior
//! derivative of the form `u` on (motion, `X_s`). A true velocity is a closed form, so that `E_s` is zero and costs
//! nothing; quasi-velocities give their gyroscopic terms through the structure coefficients of their own form alone.
//! Rows `s > l` are the equations of the reactions.
//!
//! Where `T°` is a sum of squares with constant masses, the forms are handed on as they are, before they are
//! multiplied out: see `constraint_forces`.

use core::ops::Range;

use crate::algebra::{ExprId, FastMap, Flow, Graph, Node, Rational};
use crate::geometry::{MANY_COORDINATES, is_nested};
use crate::motion::quasi_velocities::velocity_forms::VelocityPartials;
use crate::motion::{Frame, KineticTerm, Mechanics, MotionEquations, VelocityForm};
use crate::program::weighted_cost;
use crate::workbench::Workbench;

/// A velocity form with everything that the projection needs of it, each computed once.
#[derive(Clone)]
pub(in crate::motion) struct Measured {
    /// `u` on the constraints.
    pub(in crate::motion) value: ExprId,
    /// `u_s` for `s = 1..n`.
    pub(in crate::motion) components: Vec<ExprId>,
    /// The component along `X_0`.
    pub(in crate::motion) drift: ExprId,
    /// `D(u)`: the acceleration at `eta' = 0`.
    pub(in crate::motion) acceleration: ExprId,
    /// `E_s(u)` for each row.
    pub(in crate::motion) turning: Vec<ExprId>,
}

/// The forms of the kinetic energy, in the order in which its terms have them.
pub(in crate::motion) type MeasuredForms = FastMap<ExprId, Measured>;

/// The quadratic part of `T°` as `1/2 sum_k m_k u_k^2` with constants `m_k` of one sign:
/// `sum_k m_k u_ks (D(u_k) + sum_t u_kt eta_t') = g_s`.
pub(in crate::motion) struct Squares {
    /// `m_k`.
    pub(in crate::motion) masses: Vec<ExprId>,
    /// `u_ks`, a row for each form, `s = 1..l`.
    pub(in crate::motion) components: Vec<Vec<ExprId>>,
    /// The components along `X_0`.
    pub(in crate::motion) drifts: Vec<ExprId>,
    /// `g_s`, everything but the inertia and the accelerations of the forms, without the generalised forces.
    pub(in crate::motion) rest: Vec<ExprId>,
}

/// The equations of a route, and what they were multiplied out from.
pub(in crate::motion) struct Projected {
    /// `sum_t M_st eta_t' = f_s` for the rows asked for, without the generalised forces.
    pub(in crate::motion) equations: MotionEquations,
    /// `None` where the energy is no sum of squares with constant masses.
    pub(in crate::motion) squares: Option<Squares>,
    /// The forms of the energy.
    pub(in crate::motion) forms: MeasuredForms,
}

/// `sum_t M_st eta_t' = f_s` for some rows, counted from 0, without the generalised forces.
pub(in crate::motion) fn equations(
    bench: &mut Workbench,
    system: &Mechanics,
    frame: &mut Frame,
    partials: &mut VelocityPartials,
    terms: &[KineticTerm],
    rows: Range<usize>,
) -> Projected {
    let resting = resting_accelerations(bench, system, frame);
    let mut curl = Curl::new(bench, system);
    let mut forms = MeasuredForms::default();
    for u in terms.iter().flat_map(|term| &term.forms) {
        if !forms.contains_key(u) {
            let measured = measure(bench, system, frame, partials, (&resting, &mut curl), *u, rows.clone());
            forms.insert(*u, measured);
        }
    }
    let displacements = &mut frame.displacements[rows.clone()];
    let (equations, rest) =
        assemble(bench, system, (rows.start, displacements), &mut frame.motion, terms, &forms);
    let l = system.forms.degrees;
    let squares = if rows.start == 0 && rows.end >= l { squares(bench, terms) } else { None };
    let squares = squares.map(|list| with_factors(bench, system, frame, &forms, list, rest));
    Projected { equations, squares, forms }
}

/// The sums over the terms of the energy; a row for each displacement, the first of them at its place. Beside the equations the part of the forces
/// that the accelerations of the forms do not have, term by term.
pub(in crate::motion) fn assemble(
    bench: &mut Workbench,
    system: &Mechanics,
    (first, displacements): (usize, &mut [Flow]),
    motion: &mut Flow,
    terms: &[KineticTerm],
    forms: &MeasuredForms,
) -> (MotionEquations, Vec<Vec<ExprId>>) {
    let (l, rows) = (system.forms.degrees, displacements.len());
    let mut mass: Vec<Vec<Vec<ExprId>>> = vec![vec![Vec::new(); l]; rows];
    let mut forces: Vec<Vec<ExprId>> = vec![Vec::new(); rows];
    let mut rest: Vec<Vec<ExprId>> = vec![Vec::new(); rows];
    for (displacement, force) in displacements.iter_mut().zip(&mut rest) {
        force.push(displacement.of(&mut bench.graph, system.force_function));
    }
    for term in terms {
        let w = term.weight;
        let w_rate = motion.of(&mut bench.graph, w);
        let factors: Vec<&Measured> = term.forms.iter().map(|u| &forms[u]).collect();
        for s in 0..rows {
            // - X_s(w) u v
            let w_slope = displacements[s].of(&mut bench.graph, w);
            if !bench.graph.is_zero(w_slope) {
                let values = factors.iter().map(|u| u.value);
                let all: Vec<_> = values.chain([w_slope]).map(|e| (e, 1)).collect();
                rest[s].push(bench.graph.product(&all));
            }
            for (place, u) in factors.iter().enumerate() {
                let partner =
                    factors.iter().enumerate().find(|(other, _)| *other != place).map(|(_, other)| *other);
                let one = bench.graph.one();
                let partner_value = partner.map_or(one, |other| other.value);
                let component = u.components[first + s];
                if !bench.graph.is_zero(component) {
                    // D(w) v u_s + w v' u_s
                    if !bench.graph.is_zero(w_rate) {
                        let part = bench.graph.product(&[(w_rate, 1), (partner_value, 1), (component, 1)]);
                        rest[s].push(bench.graph.neg(part));
                    }
                    if let Some(other) = partner {
                        let part = bench.graph.product(&[(w, 1), (other.acceleration, 1), (component, 1)]);
                        forces[s].push(bench.graph.neg(part));
                        for (t, row) in mass[s].iter_mut().enumerate() {
                            row.push(bench.graph.product(&[
                                (w, 1),
                                (other.components[t], 1),
                                (component, 1),
                            ]));
                        }
                    }
                }
                // w v E_s(u)
                if !bench.graph.is_zero(u.turning[s]) {
                    let part = bench.graph.product(&[(w, 1), (partner_value, 1), (u.turning[s], 1)]);
                    rest[s].push(bench.graph.neg(part));
                }
            }
        }
    }
    let equations = MotionEquations {
        mass: mass
            .into_iter()
            .map(|row| row.into_iter().map(|terms| bench.graph.sum(terms)).collect())
            .collect(),
        forces: forces
            .into_iter()
            .zip(&rest)
            .map(|(a, b)| bench.graph.sum(b.iter().copied().chain(a)))
            .collect(),
    };
    (equations, rest)
}

/// The squares with the factors of their forms multiplied into them.
fn with_factors(
    bench: &mut Workbench,
    system: &Mechanics,
    frame: &mut Frame,
    forms: &MeasuredForms,
    list: Vec<Square>,
    rest: Vec<Vec<ExprId>>,
) -> Squares {
    let l = system.forms.degrees;
    let mut found =
        Squares { masses: Vec::new(), components: Vec::new(), drifts: Vec::new(), rest: Vec::new() };
    let mut rest = rest[..l].to_vec();
    for Square { mass, factor, form } in list {
        let form = &forms[&form];
        // In place of 2 D(w) u u_s with w = m c^2/2 the form c u has m c D(c) u u_s in its acceleration.
        let rate = frame.motion.of(&mut bench.graph, factor);
        let mut components = Vec::new();
        for (s, component) in form.components[..l].iter().enumerate() {
            let own = bench.graph.mul(factor, *component);
            components.push(bench.tidy(own));
            if !bench.graph.is_zero(rate) && !bench.graph.is_zero(*component) {
                let all = [mass, factor, rate, form.value, *component].map(|e| (e, 1));
                rest[s].push(bench.graph.product(&all));
            }
        }
        found.masses.push(mass);
        found.components.push(components);
        found.drifts.push(bench.graph.mul(factor, form.drift));
    }
    found.rest = rest.into_iter().map(|terms| bench.graph.sum(terms)).collect();
    found
}

/// `1/2 m (c u)^2` with a constant `m`; all of one sign.
pub(in crate::motion) struct Square {
    pub(in crate::motion) mass: ExprId,
    /// `c(t, x)`.
    pub(in crate::motion) factor: ExprId,
    pub(in crate::motion) form: ExprId,
}

/// The quadratic part of the energy as squares, if it is seen to be a sum of such.
pub(in crate::motion) fn squares(bench: &mut Workbench, terms: &[KineticTerm]) -> Option<Vec<Square>> {
    let graph = &mut bench.graph;
    let mut found = Vec::new();
    for term in terms {
        let [form, other] = term.forms[..] else { continue };
        if form != other {
            return None;
        }
        let weights: Vec<ExprId> = match graph.node(term.weight).clone() {
            Node::Sum { constant, terms } => {
                let constant = graph.number(constant);
                let others = terms.iter().map(|(e, c)| graph.scale(*e, c)).collect::<Vec<_>>();
                others.into_iter().chain([constant]).filter(|e| !graph.is_zero(*e)).collect()
            }
            _ => vec![term.weight],
        };
        // A constant sum is one mass.
        let weights = if graph.roles(term.weight).is_constant() { vec![term.weight] } else { weights };
        for weight in weights {
            let (content, rest) = graph.split_coefficient(weight);
            let factors: Vec<(ExprId, i32)> = match graph.node(rest) {
                Node::Product(factors) => factors.to_vec(),
                _ => vec![(rest, 1)],
            };
            // Squares belong to the form, as in the velocity that they come from; what is all constant is a mass.
            let is_constant = graph.roles(rest).is_constant();
            let (masses, squares): (Vec<_>, Vec<_>) =
                factors.into_iter().partition(|(_, e)| is_constant || e % 2 != 0);
            if masses.iter().any(|(base, _)| !graph.roles(*base).is_constant()) {
                return None;
            }
            let mass = graph.product(&masses);
            let mass = graph.scale(mass, &(&content * &Rational::integer(2)));
            let squares: Vec<_> = squares.into_iter().map(|(base, e)| (base, e / 2)).collect();
            let factor = graph.product(&squares);
            found.push(Square { mass, factor, form });
        }
    }
    // The masses have one sign, which need not be known.
    let first = found.first()?.mass;
    let have_sign_of = |graph: &mut Graph, sign: ExprId| {
        found.iter().all(|square| {
            let ratio = graph.div(square.mass, sign);
            graph.manifestly_positive(ratio)
        })
    };
    let one = graph.one();
    let have_one_sign =
        have_sign_of(graph, one) || (graph.manifestly_nonzero(first) && have_sign_of(graph, first));
    have_one_sign.then_some(found)
}

/// `x''` at `eta' = 0`: `A x'' = -(A' x' + a_0')` along the motion, so that the operators are never differentiated.
fn resting_accelerations(bench: &mut Workbench, system: &Mechanics, frame: &mut Frame) -> Vec<ExprId> {
    let n = system.forms.len();
    let right: Vec<ExprId> = system
        .forms
        .forms
        .iter()
        .map(|form| {
            let mut terms = vec![frame.motion.of(&mut bench.graph, form.offset)];
            for (a, velocity) in form.row.iter().zip(&frame.velocities) {
                let rate = frame.motion.of(&mut bench.graph, *a);
                terms.push(bench.graph.mul(rate, *velocity));
            }
            let sum = bench.graph.sum(terms);
            let right = bench.graph.neg(sum);
            bench.keep_large(right)
        })
        .collect();
    let by_operators: Vec<ExprId> = (0..n)
        .map(|i| {
            let column: Vec<ExprId> = (1..=n).map(|j| frame.operators.xi[j][i]).collect();
            let acceleration = bench.dot(&column, &right);
            bench.keep_large(acceleration)
        })
        .collect();
    let Some(one_by_one) = frame.operators.solved(bench, right) else { return by_operators };
    let cost = |list: &[ExprId]| weighted_cost(&bench.graph, list);
    // An estimate: what promises little more may be shorter once the whole is known.
    if 10 * cost(&one_by_one) < 7 * cost(&by_operators) { one_by_one } else { by_operators }
}

fn measure(
    bench: &mut Workbench,
    system: &Mechanics,
    frame: &mut Frame,
    partials: &mut VelocityPartials,
    (resting, curl): (&[ExprId], &mut Curl),
    u: ExprId,
    rows: Range<usize>,
) -> Measured {
    let (n, l) = (system.forms.len(), system.forms.degrees);
    let form = partials.affine(bench, u).expect("the decomposition yields affine forms");
    let components: Vec<ExprId> = (1..=n)
        .map(|s| {
            let component = frame.component(bench, &form, s);
            // Those of the constraints are for reactions only.
            let is_left = s > l && n > MANY_COORDINATES && is_nested(bench, component);
            let tidy = if is_left { component } else { bench.tidy(component) };
            bench.keep_large(tidy)
        })
        .collect();
    // The value by components along the operators, or by coordinates: what has fewer terms.
    let drift = frame.component(bench, &form, 0);
    let drift = bench.tidy(drift);
    let by_components = components[..l].iter().filter(|c| !bench.graph.is_zero(**c)).count();
    let value = if by_components <= form.on_velocities.len() + form.on_etas.len() {
        let moving = bench.dot(&components[..l], &system.etas[..l]);
        bench.graph.add(drift, moving)
    } else {
        frame.constrain.of(&mut bench.graph, u)
    };
    // u' = sum_i (b_i x_i'' + b_i' x_i') + sum_j c_j' eta_j + u_0' at eta' = 0
    let mut terms = vec![frame.motion.of(&mut bench.graph, form.offset)];
    for (i, b) in &form.on_velocities {
        let rate = frame.motion.of(&mut bench.graph, *b);
        terms.push(bench.graph.mul(*b, resting[*i]));
        terms.push(bench.graph.mul(rate, frame.velocities[*i]));
    }
    for (j, c) in form.on_etas.iter().filter(|(j, _)| *j < l) {
        let rate = frame.motion.of(&mut bench.graph, *c);
        terms.push(bench.graph.mul(rate, system.etas[*j]));
    }
    let mut acceleration = bench.graph.sum(terms);
    if by_components <= form.on_velocities.len() + form.on_etas.len() {
        // The same from the components, u' = sum_s u_s' eta_s + ..: short where the operators have made them short.
        let other = frame.motion.of(&mut bench.graph, value);
        let cost = |e: ExprId| weighted_cost(&bench.graph, &[e]);
        if other != acceleration && cost(other) < cost(acceleration) {
            acceleration = other;
        }
    }
    let turning = if curl.vanishes(bench, system, &form) {
        vec![bench.graph.zero(); rows.len()]
    } else {
        rows.map(|s| exterior(bench, system, frame, &form, s)).collect()
    };
    Measured {
        value: bench.keep_large(value),
        components,
        drift,
        acceleration: bench.keep_large(acceleration),
        turning,
    }
}

/// The exterior derivative of velocities on two directions that nothing restricts: `(1, x')` and `(0, eta)`. It says of
/// all `E_s(u)` at once that they are zero, without the operators, which have the roots and divisions of the constraints.
pub(in crate::motion) struct Curl {
    along: Flow,
    across: Flow,
}

impl Curl {
    pub(in crate::motion) fn new(bench: &Workbench, system: &Mechanics) -> Self {
        let forms = &system.forms;
        let direction = |rates: &[ExprId]| {
            let rates: Vec<_> = forms.coordinates.iter().copied().zip(rates.iter().copied()).collect();
            rates
        };
        let time = (forms.time, bench.graph.one());
        let along = direction(&system.velocities).into_iter().chain([time]);
        Curl {
            along: Flow::new(&bench.graph, along),
            across: Flow::new(&bench.graph, direction(&system.etas)),
        }
    }

    /// Whether a form of velocities alone is proved to be closed.
    pub(in crate::motion) fn vanishes(
        &mut self,
        bench: &mut Workbench,
        system: &Mechanics,
        form: &VelocityForm,
    ) -> bool {
        if !form.on_etas.is_empty() {
            return false;
        }
        let mut terms = Vec::new();
        for (i, b) in &form.on_velocities {
            let rate = self.along.of(&mut bench.graph, *b);
            let slope = self.across.of(&mut bench.graph, *b);
            terms.push(bench.graph.mul(rate, system.etas[*i]));
            let back = bench.graph.mul(slope, system.velocities[*i]);
            terms.push(bench.graph.neg(back));
        }
        let slope = self.across.of(&mut bench.graph, form.offset);
        terms.push(bench.graph.neg(slope));
        let sum = bench.graph.sum(terms);
        bench.vanishes(sum)
    }
}

/// `E_s(u)`, the exterior derivative of `u = sum b_i dx_i + sum c_j eta_j + u_0 dt` on (motion, `X_{s+1}`):
/// `sum_i (D(b_i) xi_s^i - X_s(b_i) x_i') - X_s(u_0) + sum_j (D(c_j) delta_js - X_s(c_j) eta_j - c_j (C_0sj + sum_r eta_r C_rsj))`.
fn exterior(
    bench: &mut Workbench,
    system: &Mechanics,
    frame: &mut Frame,
    form: &VelocityForm,
    s: usize,
) -> ExprId {
    let mut terms = Vec::new();
    for (i, b) in &form.on_velocities {
        let rate = frame.motion.of(&mut bench.graph, *b);
        let slope = frame.displacements[s].of(&mut bench.graph, *b);
        terms.push(bench.graph.mul(rate, frame.operators.xi[s + 1][*i]));
        let back = bench.graph.mul(slope, frame.velocities[*i]);
        terms.push(bench.graph.neg(back));
    }
    let slope = frame.displacements[s].of(&mut bench.graph, form.offset);
    terms.push(bench.graph.neg(slope));
    for (j, c) in &form.on_etas {
        if *j == s {
            terms.push(frame.motion.of(&mut bench.graph, *c));
        }
        if *j < system.forms.degrees {
            let slope = frame.displacements[s].of(&mut bench.graph, *c);
            let back = bench.graph.mul(slope, system.etas[*j]);
            terms.push(bench.graph.neg(back));
        }
        let turning = frame.brackets.along_motion(bench, &system.etas, s + 1, j + 1);
        let back = bench.graph.mul(*c, turning);
        terms.push(bench.graph.neg(back));
    }
    let sum = bench.graph.sum(terms);
    // Zero as a function is seldom zero as written.
    let turning = bench.dropped(sum);
    bench.keep_large(turning)
}
