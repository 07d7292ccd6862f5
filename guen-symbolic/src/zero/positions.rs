//! Points where equations on positions hold, over the reals: from a drawn point by the method of Levenberg and Marquardt with a
//! damping of `|f|^2`, which converges quadratically where gradients become dependent, too (Yamashita and Fukushima 2001).

use super::manifold::solve_dense;
use super::real::{Real, evaluate_in};
use crate::algebra::{ExprId, FastMap, Flow, Graph, Rational, Role, SignBound, SymbolId, mix};

/// Steps of one search.
const STEPS: usize = 120;

/// The drawn value of a symbol.
pub(super) type Drawn<'d> = &'d dyn Fn(SymbolId) -> f64;

/// The equations with their derivatives.
pub(super) struct MotionEquations<'a> {
    pub(super) graph: &'a Graph,
    pub(super) equations: &'a [ExprId],
    /// The equations, and their derivatives row by row.
    roots: Vec<ExprId>,
    /// The nodes of these, in an order in which they can be evaluated.
    order: Vec<ExprId>,
    /// The symbols along which a point may move: coordinates and constants.
    pub(super) variables: Vec<SymbolId>,
    /// Tells for each variable whether it is a coordinate.
    pub(super) moving: Vec<bool>,
}

impl<'a> MotionEquations<'a> {
    pub(super) fn new(graph: &'a mut Graph, equations: &'a [ExprId]) -> Self {
        let symbols = graph.symbols_in(equations).into_iter();
        let variables: Vec<SymbolId> = symbols
            .filter(|s| matches!(graph.symbol_info(*s).role, Role::Coordinate | Role::Constant))
            .collect();
        let mut flows: Vec<Flow> =
            variables.iter().map(|symbol| Flow::partial(graph, graph.symbol_expr(*symbol))).collect();
        let mut roots = equations.to_vec();
        for equation in equations {
            let own = graph.symbols_in(&[*equation]);
            let zero = graph.zero();
            roots.extend(
                variables.iter().zip(&mut flows).map(|(symbol, flow)| {
                    if own.contains(symbol) { flow.of(graph, *equation) } else { zero }
                }),
            );
        }
        let moving = variables.iter().map(|s| graph.symbol_info(*s).role == Role::Coordinate).collect();
        let order = graph.reachable(&roots, |_| false);
        MotionEquations { graph, equations, roots, order, variables, moving }
    }

    /// Left sides and gradients by all variables.
    pub(super) fn values<R: Real + From<f64>>(&self, x: &[R], drawn: Drawn<'_>) -> (Vec<R>, Vec<Vec<R>>) {
        let value = |symbol: SymbolId| match self.variables.iter().position(|own| *own == symbol) {
            Some(i) => x[i],
            None => R::from(drawn(symbol)),
        };
        let mut values = evaluate_in(self.graph, &self.order, &self.roots, &value);
        let jacobian = values.split_off(self.equations.len());
        (values, jacobian.chunks(self.variables.len().max(1)).map(<[R]>::to_vec).collect())
    }

    /// The variables at a point where all equations hold, in double precision, sought from a drawn one; constants move or stay.
    pub(super) fn point(&self, drawn: Drawn<'_>, constants_move: bool) -> Option<Vec<f64>> {
        let moves: Vec<bool> = self.moving.iter().map(|moving| *moving || constants_move).collect();
        let mut x: Vec<f64> = self.variables.iter().map(|s| drawn(*s)).collect();
        let size = |f: &[f64]| f.iter().map(|f| f * f).sum::<f64>();
        let mut damping = 1.0;
        let held = |mut rows: Vec<Vec<f64>>| {
            rows.iter_mut().for_each(|row| {
                row.iter_mut().zip(&moves).for_each(|(a, moves)| *a *= f64::from(u8::from(*moves)))
            });
            rows
        };
        let (mut f, rows) = self.values(&x, drawn);
        let mut rows = held(rows);
        for _ in 0..STEPS {
            let left = size(&f);
            if !left.is_finite() {
                return None;
            }
            let mut system: Vec<Vec<f64>> = rows
                .iter()
                .zip(&f)
                .map(|(row, f)| rows.iter().map(|other| dot(row, other)).chain([*f]).collect())
                .collect();
            let mean = (0..f.len()).map(|i| system[i][i]).sum::<f64>() / f.len() as f64;
            for (i, row) in system.iter_mut().enumerate() {
                row[i] += mean * (damping * left.min(1.0)).max(1e-14);
            }
            let multipliers = solve_dense(system)?;
            let step = |j: usize| rows.iter().zip(&multipliers).map(|(row, m)| row[j] * m).sum::<f64>();
            let trial: Vec<f64> = x.iter().enumerate().map(|(j, x)| x - step(j)).collect();
            let length = x.iter().zip(&trial).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            let (next, gradients) = self.values(&trial, drawn);
            // Roundings may not make the last steps larger.
            if size(&next) <= left || left < 1e-20 {
                (x, f, rows) = (trial, next, held(gradients));
                damping = (damping / 4.0).max(1e-3);
                if length < 1e-11 {
                    break;
                }
            } else if damping > 1e12 {
                return None;
            } else {
                damping *= 8.0;
            }
        }
        let keeps = |(symbol, x): (&SymbolId, &f64)| match self.graph.symbol_info(*symbol).bound {
            SignBound::Positive | SignBound::NonNegative => *x > 1e-3,
            SignBound::Negative | SignBound::NonPositive => *x < -1e-3,
            SignBound::Free | SignBound::NonZero => true,
        };
        (size(&f) < 1e-20 && self.variables.iter().zip(&x).all(keeps)).then_some(x)
    }
}

pub(super) fn dot<R: Real>(a: &[R], b: &[R]) -> R {
    a.iter().zip(b).fold(R::rational(&Rational::ZERO), |sum, (a, b)| sum + *a * *b)
}

/// A state that was drawn: the values of its symbols.
pub(crate) struct State {
    seed: u64,
    /// Values of the symbols that moved onto the manifold.
    solved: FastMap<SymbolId, f64>,
}

impl State {
    /// Whether the symbol moved onto the manifold.
    pub(crate) fn is_known(&self, symbol: SymbolId) -> bool {
        self.solved.contains_key(&symbol)
    }

    /// The value of a symbol, between `-pi` and `pi` unless it moved onto the manifold.
    pub(crate) fn value(&self, symbol: SymbolId) -> f64 {
        let drawn = || {
            let bits = mix(self.seed ^ mix(symbol.index() as u64));
            core::f64::consts::PI * ((bits >> 11) as f64 / (1_u64 << 52) as f64 - 1.0)
        };
        self.solved.get(&symbol).copied().unwrap_or_else(drawn)
    }
}

/// Draws states where all equations hold. Constants are as given; only where no position keeps the equations so, they move, too. Where
/// hardly any state is found the equations are left aside.
pub(crate) fn drawn_states(
    graph: &mut Graph,
    equations: &[ExprId],
    count: usize,
    constant: &dyn Fn(SymbolId) -> f64,
) -> Vec<State> {
    let anywhere = |seed: usize| State { seed: seed as u64, solved: FastMap::default() };
    if equations.is_empty() {
        return (0..count).map(anywhere).collect();
    }
    let equations = MotionEquations::new(graph, equations);
    let on_manifold = |seed: usize| {
        let start = anywhere(seed);
        let drawn = |symbol: SymbolId| match equations.graph.symbol_info(symbol).role {
            Role::Constant => constant(symbol),
            _ => start.value(symbol),
        };
        let x = equations.point(&drawn, false).or_else(|| equations.point(&drawn, true))?;
        Some(State { solved: equations.variables.iter().copied().zip(x).collect(), ..start })
    };
    let found: Vec<State> = (0..2 * count).filter_map(on_manifold).take(count).collect();
    if found.len() < count / 8 { (0..count).map(anywhere).collect() } else { found }
}
