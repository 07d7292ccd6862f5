//! Functions restricted to the constraints on positions, and the equations there.
//!
//! Two equations are the same wherever the constraints hold if what they differ by vanishes there; and derivatives along
//! `X_0..X_l` and along the motion, which are tangential, are those of the functions there. So equations may be made of
//! functions that are equal on the constraints only. `|q|^2` is a number there, what vanishes there is left out, and with it
//! terms that would be large and cancel: in the rate of a hoop's third spin all three spins would occur, and it depends on
//! two of them.
//!
//! A function is never written with fewer coordinates, as `w^2 = 1 - i^2 - j^2 - k^2` would allow: where `w` is small nothing
//! would be left of its digits. It is made homogeneous instead, by powers of `|q|^2`.
//!
//! The operators are not touched, and velocities only so that the constraints are integrals of them everywhere: what is off a
//! constraint stays as far off it.

use crate::algebra::{ExprId, FastMap, Flow, Function, Node, Rational, Role, Roles, Substitution};
use crate::motion::{Mechanics, MotionEquations};
use crate::normal::{Limits, normal_coefficients, normal_form};
use crate::program::weighted_cost;
use crate::workbench::Workbench;
use crate::zero::Verdict;

/// Powers of what is constant that are taken out of one expression.
const POWERS_OF_CONSTANTS: usize = 4;

/// Functions of the coordinates that the constraints make constant: `|q|^2` where `|q|^2 = 1`.
pub(in crate::motion) struct Restriction {
    /// Each with its value, which vanishes nowhere.
    constants: Vec<(ExprId, ExprId)>,
    /// Roots that were looked at.
    roots: FastMap<ExprId, ExprId>,
}

impl Restriction {
    pub(in crate::motion) fn new(bench: &mut Workbench, system: &Mechanics) -> Self {
        let equations: Vec<ExprId> = system.holonomic.iter().map(|holonomic| holonomic.equation).collect();
        let constants = equations.into_iter().filter_map(|e| split(bench, e)).collect();
        Restriction { constants, roots: FastMap::default() }
    }

    /// The expression tidied, as it is on the constraints.
    pub(in crate::motion) fn tidy(&mut self, bench: &mut Workbench, e: ExprId) -> ExprId {
        self.normal(bench, e, &mut |bench, e| Some(bench.tidy(e))).unwrap_or(e)
    }

    /// The expression tidied, as it is on the constraints, if that is shorter.
    fn shortened(&mut self, bench: &mut Workbench, e: ExprId) -> ExprId {
        let tidy = self.tidy(bench, e);
        let cost = |e: ExprId| weighted_cost(&bench.graph, &[e]);
        if cost(tidy) < cost(e) { tidy } else { e }
    }

    /// An expression as it is on the constraints, in a normal form: powers of what is constant there are taken out of it. `None`
    /// where there is no normal form.
    pub(in crate::motion) fn normal(
        &mut self,
        bench: &mut Workbench,
        e: ExprId,
        normal: &mut dyn FnMut(&mut Workbench, ExprId) -> Option<ExprId>,
    ) -> Option<ExprId> {
        if self.constants.is_empty() {
            return normal(bench, e);
        }
        if bench.verdict_on_manifold(e) == Verdict::Zero {
            return Some(bench.graph.zero());
        }
        let e = self.with_even_roots(bench, e);
        let mut found = normal(bench, e)?;
        for (function, value) in &self.constants {
            if !bench.graph.support(*function).meets(bench.graph.support(found)) {
                continue;
            }
            for _ in 0..POWERS_OF_CONSTANTS {
                let quotient = bench.graph.product(&[(found, 1), (*function, -1), (*value, 1)]);
                let Some(quotient) = normal(bench, quotient) else { break };
                let cost = |e: ExprId| weighted_cost(&bench.graph, &[e]);
                if cost(quotient) >= cost(found) {
                    break;
                }
                found = quotient;
            }
        }
        let mut by_value = Substitution::new(self.constants.iter().copied());
        Some(by_value.of(&mut bench.graph, found))
    }

    /// The expression with radicands that are homogeneous polynomials, where they are such on the constraints.
    fn with_even_roots(&mut self, bench: &mut Workbench, e: ExprId) -> ExprId {
        let mut images = Substitution::default();
        for id in bench.graph.reachable(&[e], |_| false) {
            let Node::Function(function @ Function::Root(_), radicand) = *bench.graph.node(id) else {
                continue;
            };
            if let Some(root) = self.roots.get(&id) {
                images.add(id, *root);
                continue;
            }
            let inside = images.of(&mut bench.graph, radicand);
            let even = self.constants.iter().find_map(|constant| evened(bench, inside, *constant));
            let root = bench.graph.function(function, even.unwrap_or(inside));
            self.roots.insert(id, root);
            self.roots.insert(root, root);
            images.add(id, root);
        }
        images.of(&mut bench.graph, e)
    }
}

/// Returns a polynomial as it is where `f = c`, with all its terms of one degree: each times a power of `f/c`, and no
/// power of it in all. `None` where it is no such polynomial, or more expensive so.
fn evened(bench: &mut Workbench, e: ExprId, (function, value): (ExprId, ExprId)) -> Option<ExprId> {
    let limits = Limits::default();
    let symbols = bench.graph.symbols_in(&[function]);
    let variables: Vec<ExprId> = symbols.into_iter().map(|s| bench.graph.symbol_expr(s)).collect();
    let own = homogeneous(bench, function, &variables)?;
    let rows = normal_coefficients(&mut bench.graph, e, &variables, &limits)?;
    let degree = |exponents: &[u32]| exponents.iter().sum::<u32>();
    let most = rows.iter().map(|(exponents, _)| degree(exponents)).max()?;
    if rows.iter().any(|(exponents, _)| (most - degree(exponents)) % own != 0) {
        return None;
    }
    let mut terms = Vec::new();
    for (exponents, coefficient) in rows {
        let power = ((most - degree(&exponents)) / own) as i32;
        let mut factors = vec![(coefficient, 1), (function, power), (value, -power)];
        factors.extend(variables.iter().zip(exponents).map(|(x, k)| (*x, k as i32)));
        terms.push(bench.graph.product(&factors));
    }
    let mut even = bench.graph.sum(terms);
    for power in (0..=most / own).rev() {
        let power = power as i32;
        let quotient = bench.graph.product(&[(even, 1), (function, -power), (value, power)]);
        let Some(normal) = normal_form(&mut bench.graph, quotient, &limits) else { continue };
        if power == 0 || homogeneous(bench, normal, &variables).is_some() {
            even = normal;
            break;
        }
    }
    let cost = |e: ExprId| weighted_cost(&bench.graph, &[e]);
    (cost(even) < cost(e)).then_some(even)
}

/// The degree of a homogeneous polynomial.
fn homogeneous(bench: &mut Workbench, e: ExprId, variables: &[ExprId]) -> Option<u32> {
    let rows = normal_coefficients(&mut bench.graph, e, variables, &Limits::default())?;
    let mut degrees = rows.iter().map(|(exponents, _)| exponents.iter().sum::<u32>());
    let first = degrees.next()?;
    degrees.all(|degree| degree == first).then_some(first).filter(|degree| *degree > 0)
}

/// An equation `f(x) = c` as the pair of both, if `f` is a polynomial and `c` constant and nowhere zero.
fn split(bench: &mut Workbench, equation: ExprId) -> Option<(ExprId, ExprId)> {
    let graph = &mut bench.graph;
    let Node::Sum { constant, terms } = graph.node(equation).clone() else { return None };
    let moving = Roles::of(Role::Coordinate).or(Roles::of(Role::Time));
    let (moving, constants): (Vec<_>, Vec<_>) =
        terms.iter().cloned().partition(|(term, _)| graph.roles(*term).meets(moving));
    let rest = graph.linear(&constants);
    let constant = graph.number(constant);
    let value = graph.add(rest, constant);
    let function = graph.linear(&moving);
    let (content, function) = graph.split_content(function);
    let value = graph.scale(value, &-(&Rational::ONE / &content));
    if !graph.manifestly_nonzero(value) || !graph.roles(value).is_constant() {
        return None;
    }
    let symbols = graph.symbols_in(&[function]);
    let variables: Vec<ExprId> = symbols.into_iter().map(|s| graph.symbol_expr(s)).collect();
    normal_coefficients(graph, function, &variables, &Limits::small())?;
    Some((function, value))
}

/// Whether constraints on positions are integrals of these velocities, as they are of those by the operators: everywhere, so
/// that nothing drifts faster off them.
pub(in crate::motion) fn stay(bench: &mut Workbench, system: &Mechanics, velocities: &[ExprId]) -> bool {
    let equations: Vec<ExprId> = system.holonomic.iter().map(|holonomic| holonomic.equation).collect();
    stays(bench, (system.forms.time, &system.forms.coordinates), &equations, velocities)
}

fn stays(
    bench: &mut Workbench,
    (time, coordinates): (ExprId, &[ExprId]),
    equations: &[ExprId],
    velocities: &[ExprId],
) -> bool {
    let rates = coordinates.iter().copied().zip(velocities.iter().copied());
    let mut motion = Flow::new(&bench.graph, rates.chain([(time, bench.graph.one())]));
    equations.iter().all(|equation| {
        let rate = motion.of(&mut bench.graph, *equation);
        bench.vanishes(rate)
    })
}

/// The equations without what is constant or vanishes wherever all constraints on positions hold: entries of the mass matrix,
/// parameters on which a force does not depend there, and what it is at rest.
pub(in crate::motion) fn restricted(
    bench: &mut Workbench,
    system: &Mechanics,
    mut equations: MotionEquations,
) -> MotionEquations {
    if system.holonomic.is_empty() {
        return equations;
    }
    let l = system.forms.degrees;
    let zero = bench.graph.zero();
    let mut restriction = Restriction::new(bench, system);
    for s in 0..l {
        for t in 0..=s {
            let open = written_out(bench, equations.mass[s][t]);
            let entry = restriction.tidy(bench, open);
            let entry = if bench.graph.roles(entry).is_constant() {
                entry
            } else {
                restriction.shortened(bench, equations.mass[s][t])
            };
            (equations.mass[s][t], equations.mass[t][s]) = (entry, entry);
        }
        equations.forces[s] = restriction.shortened(bench, equations.forces[s]);
    }
    for eta in &system.etas[..l] {
        let mut at_rest = Substitution::new([(*eta, zero)]);
        for force in &mut equations.forces {
            let without = at_rest.of(&mut bench.graph, *force);
            if without != *force && depends_not(bench, *force, without) {
                *force = without;
            }
        }
    }
    let mut at_rest = Substitution::new(system.etas[..l].iter().map(|eta| (*eta, zero)));
    for force in &mut equations.forces {
        let weight = at_rest.of(&mut bench.graph, *force);
        if bench.verdict_on_manifold(weight) == Verdict::Zero {
            *force = bench.graph.sub(*force, weight);
        }
    }
    equations
}

/// Whether both are the same on the constraints.
fn depends_not(bench: &mut Workbench, a: ExprId, b: ExprId) -> bool {
    let difference = bench.graph.sub(a, b);
    bench.verdict_on_manifold(difference) == Verdict::Zero
}

/// The expression with nothing kept whole.
pub(in crate::motion) fn written_out(bench: &mut Workbench, e: ExprId) -> ExprId {
    let graph = &mut bench.graph;
    let kept = graph.reachable(&[e], |_| false);
    let mut open = Substitution::default();
    for id in kept {
        if let Node::Kept(inside) = *graph.node(id) {
            let image = open.of(graph, inside);
            open.add(id, image);
        }
    }
    open.of(graph, e)
}

#[cfg(test)]
mod tests {
    use super::{Restriction, split, stays};
    use crate::algebra::{ExprId, FastMap, Graph, Rational, Role, SignBound, SymbolId};
    use crate::workbench::Workbench;
    use crate::zero::evaluate;

    /// Coordinates with `sum x^2 = value`.
    fn sphere(
        names: &[&str],
        value: impl FnOnce(&mut Graph) -> ExprId,
    ) -> (Workbench, Restriction, Vec<ExprId>) {
        let mut graph = Graph::new();
        let x: Vec<ExprId> = names.iter().map(|name| graph.symbol(name, Role::Coordinate)).collect();
        let mut bench = Workbench::new(graph);
        let square = bench.dot(&x, &x);
        let value = value(&mut bench.graph);
        let equation = bench.graph.sub(square, value);
        bench.zero.set_manifold(&mut bench.graph, &[equation]);
        let constants = vec![split(&mut bench, equation).expect("a function that is constant")];
        (bench, Restriction { constants, roots: FastMap::default() }, x)
    }

    fn at(bench: &Workbench, e: ExprId, value: impl Fn(SymbolId) -> f64) -> f64 {
        evaluate::<f64>(&bench.graph, &[e], &value)[0]
    }

    #[test]
    fn powers_of_what_is_constant_are_taken_out() {
        let (mut bench, mut restriction, x) = sphere(&["x", "y"], |graph| {
            let l = graph.bounded_symbol("l", Role::Constant, SignBound::Positive);
            graph.powi(l, 2)
        });
        let square = bench.dot(&x, &x);
        let l = restriction.constants[0].1;
        for power in [-2, -1, 1, 2] {
            let e = bench.graph.product(&[(x[0], 1), (square, power)]);
            let expected = bench.graph.product(&[(x[0], 1), (l, power)]);
            assert_eq!(restriction.tidy(&mut bench, e), expected, "{power}");
        }
        let excess = bench.graph.sub(square, l);
        let e = bench.graph.mul(x[1], excess);
        let tidy = restriction.tidy(&mut bench, e);
        assert!(bench.graph.is_zero(tidy));
    }

    #[test]
    fn radicands_become_homogeneous() {
        // |e_z - n c|^2 for the axle c of a hoop, with c_z = n = w^2 - i^2 - j^2 + k^2: 4 (w^2 + k^2) (i^2 + j^2) where the
        // quaternion has length one.
        let (mut bench, mut restriction, q) = sphere(&["w", "i", "j", "k"], |graph| graph.one());
        let graph = &mut bench.graph;
        let squares: Vec<ExprId> = q.iter().map(|x| graph.powi(*x, 2)).collect();
        let (plus, minus) = (graph.add(squares[0], squares[3]), graph.add(squares[1], squares[2]));
        let n = graph.sub(plus, minus);
        let mut pair = |a: usize, b: usize, c: usize, d: usize, sign: i64| {
            let (first, second) = (graph.mul(q[a], q[b]), graph.mul(q[c], q[d]));
            let sum = graph.linear(&[(first, Rational::integer(2)), (second, Rational::integer(2 * sign))]);
            graph.mul(sum, n)
        };
        let (x, y) = (pair(0, 2, 1, 3, 1), pair(2, 3, 0, 1, -1));
        let (one, square) = (graph.one(), graph.powi(n, 2));
        let z = graph.sub(square, one);
        let radicand = [x, y, z].map(|e| graph.powi(e, 2));
        let radicand = graph.sum(radicand);
        let root = graph.sqrt(radicand);
        let even = restriction.tidy(&mut bench, root);
        let point = [0.1, -0.7, 0.5, 0.5_f64];
        let value = |scale: f64| {
            let symbols: Vec<SymbolId> = q.iter().map(|x| bench.graph.as_symbol(*x).unwrap()).collect();
            at(&bench, even, |symbol| scale * point[symbols.iter().position(|s| *s == symbol).unwrap()])
        };
        assert!((value(1.0) - 2.0 * (0.26_f64 * 0.74).sqrt()).abs() < 1e-15);
        assert!((value(3.0) - 9.0 * value(1.0)).abs() < 1e-13, "of degree two, off the constraint too");
    }

    /// The powers of a constant count if it is not one: `l^2 - x^2` is `y^2`.
    #[test]
    fn radicands_become_homogeneous_on_a_circle_of_any_size() {
        let (mut bench, mut restriction, x) = sphere(&["x", "y"], |graph| {
            let l = graph.bounded_symbol("l", Role::Constant, SignBound::Positive);
            graph.powi(l, 2)
        });
        let l2 = restriction.constants[0].1;
        let square = bench.graph.powi(x[0], 2);
        let rest = bench.graph.sub(l2, square);
        let [root, other] = [rest, bench.graph.powi(x[1], 2)].map(|e| bench.graph.sqrt(e));
        assert_eq!(restriction.tidy(&mut bench, root), bench.tidy(other));
    }

    /// Velocities may be replaced by others that keep a constraint everywhere, and by no others.
    #[test]
    fn velocities_keep_what_is_off_a_constraint_where_it_is() {
        let (mut bench, _, x) = sphere(&["x", "y"], |graph| graph.one());
        let square = bench.dot(&x, &x);
        let one = bench.graph.one();
        let equation = bench.graph.sub(square, one);
        let time = bench.graph.symbol("t", Role::Time);
        let turning = [bench.graph.neg(x[1]), x[0]];
        // Equal on the circle: off it they lead away.
        let away: Vec<ExprId> = x.iter().map(|e| bench.graph.mul(*e, equation)).collect();
        let leading = [0, 1].map(|i| bench.graph.add(turning[i], away[i]));
        assert!(stays(&mut bench, (time, &x), &[equation], &turning));
        assert!(!stays(&mut bench, (time, &x), &[equation], &leading));
    }
}
