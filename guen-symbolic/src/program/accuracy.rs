//! Rounding errors of equal programs: a running error analysis at random points and next to poles.
//!
//! Every operation adds its own rounding to what it carries over of those before it (Wilkinson), in units of the unit
//! roundoff; symbols are exact, so that what is left is what the program alone does. Points are drawn with a fixed seed.
//! Next to a pole, a divisor of some candidate is a hundred-thousandth of what it was at random: there terms cancel that
//! other programs do not have.

use super::cost::OperationCount;
use super::evaluate::{Arithmetic, run};
use super::instruction::{Instruction, Operation, Value};
use super::lower::{Code, PreparedTable, lower};
use super::net::Net;
use super::part::needed;
use super::terms::NetId;
use crate::algebra::{ExprId, Function, Graph, Multivariate, Rational, Role, SignBound, SymbolId, mix};
use crate::zero::evaluate;

/// Random points.
const ACCURACY_POINTS: u64 = 4;
/// Divisors that are made small, the first of each program.
const POLES: usize = 4;
/// The fraction to which such a divisor is reduced.
const POLE_DISTANCE: f64 = 1e-5;
/// Programs with more instructions are not analysed: expansion must stay quick.
const ANALYSED_INSTRUCTIONS: usize = 3000;
/// A program that loses so many times more than another is no candidate, however cheap: six bits,
const RELATIVE_LOSS: f64 = 64.0;
/// if it loses more than this at all: six of sixteen digits.
const SERIOUS_LOSS: f64 = 1e6;

/// A value and a first-order bound of its error in units of the unit roundoff.
#[derive(Clone, Copy, Debug)]
struct Running {
    value: f64,
    error: f64,
}

impl Running {
    fn exact(value: f64) -> Self {
        Running { value, error: 0.0 }
    }

    fn rounded(value: f64, carried: f64) -> Self {
        Running { value, error: carried + value.abs() }
    }
}

impl Arithmetic for Running {
    fn from_rational(value: &Rational) -> Self {
        Running::exact(value.to_f64())
    }
    fn pi() -> Self {
        Running::exact(std::f64::consts::PI)
    }
    fn add(&self, other: &Self) -> Self {
        Running::rounded(self.value + other.value, self.error + other.error)
    }
    fn sub(&self, other: &Self) -> Self {
        Running::rounded(self.value - other.value, self.error + other.error)
    }
    fn neg(&self) -> Self {
        Running { value: -self.value, error: self.error }
    }
    fn mul(&self, other: &Self) -> Self {
        let carried = self.value.abs() * other.error + other.value.abs() * self.error;
        Running::rounded(self.value * other.value, carried)
    }
    fn div(&self, other: &Self) -> Self {
        let value = self.value / other.value;
        Running::rounded(value, (self.error + value.abs() * other.error) / other.value.abs())
    }
    fn call(function: Function, x: &Self) -> Self {
        let value = f64::call(function, &x.value);
        let u = x.value;
        let slope = match function {
            Function::Sin => u.cos(),
            Function::Cos => u.sin(),
            Function::Asin | Function::Acos => ((1.0 - u) * (1.0 + u)).sqrt().recip(),
            Function::Atan => (1.0 + u * u).recip(),
            Function::Exp => value,
            Function::Ln => u.recip(),
            Function::Sinh => u.cosh(),
            Function::Cosh => u.sinh(),
            Function::Tanh => u.cosh().powi(-2),
            Function::Abs => 1.0,
            Function::Sign | Function::Floor => 0.0,
            Function::Root(q) => value / u / f64::from(q),
        };
        // An exact argument stays exact at the end of a function's domain too.
        let carried = if x.error == 0.0 { 0.0 } else { slope.abs() * x.error };
        match function {
            Function::Abs | Function::Sign | Function::Floor => Running { value, error: carried },
            _ => Running::rounded(value, carried),
        }
    }
    fn apply(function: Multivariate, arguments: &[Self]) -> Self {
        let values: Vec<f64> = arguments.iter().map(|x| x.value).collect();
        let value = f64::apply(function, &values);
        match (function, arguments) {
            (Multivariate::Select, [c, a, b]) => {
                if c.value >= 0.0 {
                    *a
                } else {
                    *b
                }
            }
            (Multivariate::Minimum | Multivariate::Maximum, [a, b]) => {
                if value == a.value {
                    *a
                } else {
                    *b
                }
            }
            (Multivariate::Atan2, [y, x]) => {
                let square = x.value * x.value + y.value * y.value;
                let carried = (x.value.abs() * y.error + y.value.abs() * x.error) / square;
                Running::rounded(value, carried)
            }
            // Nobody knows the slopes: those of order one.
            _ => Running::rounded(value, arguments.iter().map(|x| x.error).sum()),
        }
    }
}

/// A point: a number for every symbol.
#[derive(Clone, Copy)]
pub(super) struct Point {
    seed: u64,
    /// A symbol that is moved from its draw.
    moved: Option<(SymbolId, f64)>,
    /// Whether constants of which no sign is known have either.
    has_all_signs: bool,
    /// The size of what has no sign, in units of that of other points.
    size: f64,
}

impl Point {
    /// The point of a number, at which all constants are positive that may be.
    fn drawn(seed: u64) -> Self {
        Point { seed, moved: None, has_all_signs: false, size: 1.0 }
    }

    /// The point of a number, at which everything may be that is not excluded.
    pub(super) fn anywhere(seed: u64) -> Self {
        Point { has_all_signs: true, ..Self::drawn(seed) }
    }

    /// A point as [`Point::anywhere`], at which symbols without a sign are so many times as large.
    pub(super) fn far(seed: u64, size: f64) -> Self {
        Point { size, ..Self::anywhere(seed) }
    }

    pub(super) fn value(&self, graph: &Graph, symbol: SymbolId) -> f64 {
        if let Some((moved, value)) = self.moved
            && moved == symbol
        {
            return value;
        }
        // 53 bits, in [0, 1).
        let draw = mix(mix(self.seed) ^ symbol.index() as u64) >> 11;
        let part = draw as f64 / (1_u64 << 53) as f64;
        let info = graph.symbol_info(symbol);
        match info.bound {
            SignBound::Positive | SignBound::NonNegative => 0.3 + 1.5 * part,
            SignBound::Negative | SignBound::NonPositive => -0.3 - 1.5 * part,
            // What a bound promises must not change which program is taken.
            _ if info.role == Role::Constant && !self.has_all_signs => 0.3 + 1.5 * part,
            SignBound::Free | SignBound::NonZero => self.size * (3.0 * part - 1.5),
        }
    }
}

/// A candidate with the constants that it loads.
pub(super) struct Candidate {
    code: Code,
    prepared: PreparedTable,
}

impl Candidate {
    /// The program of some roots.
    pub(super) fn new(graph: &mut Graph, net: &Net, roots: &[NetId]) -> Self {
        let mut prepared = PreparedTable::default();
        let code = lower(graph, net, roots, &mut prepared);
        Candidate { code, prepared }
    }

    /// The code, and the constants that it loads.
    pub(super) fn parts(&self) -> (&Code, &[ExprId]) {
        (&self.code, &self.prepared.expressions)
    }

    /// Other code that loads the same constants.
    pub(super) fn with(&self, code: Code) -> Self {
        Candidate { code, prepared: self.prepared.clone() }
    }

    /// The code, with what it loads in a table that functions share.
    pub(super) fn loading(self, shared: &mut PreparedTable) -> Code {
        let Candidate { mut code, prepared } = self;
        for instruction in &mut code.instructions {
            if let Operation::Prepared(k) = &mut instruction.operation {
                *k = shared.index(prepared.expressions[*k]);
            }
        }
        code
    }

    /// The weighted operations of the program.
    pub(super) fn cost(&self) -> u64 {
        OperationCount::of(&self.code.instructions).weighted()
    }

    /// Returns the prepared values of the program at a random point; symbols that move are none of its constants.
    fn prepared(&self, graph: &Graph, point: &Point) -> Vec<f64> {
        evaluate(graph, &self.prepared.expressions, &|symbol| point.value(graph, symbol))
    }

    /// Whether it is the same program.
    pub(super) fn equals(&self, other: &Candidate) -> bool {
        self.code.instructions == other.code.instructions
            && self.code.outputs == other.code.outputs
            && self.prepared.expressions == other.prepared.expressions
    }

    /// The relative error of each output at a point, given what is prepared there; none where one is not finite.
    fn loss(&self, graph: &Graph, point: &Point, prepared: &[f64]) -> Option<Vec<f64>> {
        let prepared: Vec<Running> = prepared.iter().map(|value| Running::rounded(*value, 0.0)).collect();
        let Code { instructions, values, outputs } = &self.code;
        let symbols = |symbol| Running::exact(point.value(graph, symbol));
        let outputs = run(instructions, *values, outputs, &prepared, symbols);
        let relative = |Running { value, error }| if value == 0.0 { 0.0 } else { error / f64::abs(value) };
        let found = |output: Running| {
            Some(relative(output)).filter(|loss| output.value.is_finite() && loss.is_finite())
        };
        outputs.into_iter().map(found).collect()
    }

    /// Divisors that depend on the state, in their order.
    fn divisors(&self) -> Vec<Value> {
        let mut found = Vec::new();
        for Instruction { operation, .. } in &self.code.instructions {
            if let Operation::Div(_, divisor) = operation
                && !found.contains(divisor)
            {
                found.push(*divisor);
            }
        }
        found
    }

    /// A point next to a zero of a divisor, from a point where it is not small: one symbol of the state moves, by the
    /// secant method.
    fn near_pole(&self, graph: &Graph, point: &Point, prepared: &[f64], divisor: Value) -> Option<Point> {
        const SECANT_STEPS: usize = 40;
        let steps = needed(&self.code.instructions, self.code.values, &[divisor]);
        let at = |symbol: SymbolId, x: f64| {
            let moved = Point { moved: Some((symbol, x)), ..*point };
            run(&steps, self.code.values, &[divisor], prepared, |symbol| moved.value(graph, symbol))[0]
        };
        let symbols = self.code.instructions.iter().filter_map(|instruction| match instruction.operation {
            Operation::Symbol(symbol) if graph.symbol_info(symbol).role != Role::Constant => Some(symbol),
            _ => None,
        });
        for symbol in symbols {
            let start = point.value(graph, symbol);
            let (mut a, mut b) = (start, start + 0.1);
            let (mut at_a, mut at_b) = (at(symbol, a), at(symbol, b));
            let first = at_a.abs();
            if at_a == at_b {
                continue;
            }
            for _ in 0..SECANT_STEPS {
                let next = b - at_b * (b - a) / (at_b - at_a);
                if !next.is_finite() || (next - start).abs() > 4.0 {
                    break;
                }
                (a, at_a, b, at_b) = (b, at_b, next, at(symbol, next));
                if at_b.abs() <= 1e-14 * first || a == b {
                    // A divisor that is a square comes down as the square of the distance.
                    let near = b + POLE_DISTANCE * if start == b { 1.0 } else { start - b };
                    return Some(Point { moved: Some((symbol, near)), ..*point });
                }
            }
        }
        None
    }
}

/// The best of some programs: those that lose six digits or more where another does not are left out, then the cheapest are
/// taken, of these the most accurate, of these the first. Programs that are too long for the analysis differ by their cost
/// alone.
pub(super) fn best(graph: &Graph, candidates: &[Candidate]) -> usize {
    chosen(graph, candidates, true).unwrap_or_else(|| cheapest(candidates))
}

/// Chooses as [`best`] does, but of equally cheap candidates the first: for programs that are not finished yet.
pub(super) fn promising(graph: &Graph, candidates: &[Candidate]) -> usize {
    chosen(graph, candidates, false).unwrap_or_else(|| cheapest(candidates))
}

fn cheapest(candidates: &[Candidate]) -> usize {
    (0..candidates.len()).min_by_key(|i| candidates[*i].cost()).unwrap_or(0)
}

fn chosen(graph: &Graph, codes: &[Candidate], accurate: bool) -> Option<usize> {
    let same = |candidate: &Candidate| candidate.code.instructions == codes[0].code.instructions;
    let long = |candidate: &Candidate| candidate.code.instructions.len() > ANALYSED_INSTRUCTIONS;
    if codes.iter().all(same) || codes.iter().any(long) {
        return None;
    }
    let costs: Vec<u64> = codes.iter().map(Candidate::cost).collect();
    let losses = losses(graph, codes);
    // Where every program loses as much it is the output that is ill conditioned at that point.
    let excess: Vec<f64> = losses.iter().map(|losses| losses.excess).collect();
    let limit = excess.iter().copied().fold(f64::INFINITY, f64::min).max(1.0);
    let tolerable = |i: &usize| excess[*i] <= limit;
    let cost = (0..codes.len()).filter(tolerable).map(|i| costs[i]).min()?;
    let mut cheapest = (0..codes.len()).filter(tolerable).filter(|i| costs[*i] == cost);
    if accurate {
        cheapest.min_by(|i, j| losses[*i].largest.total_cmp(&losses[*j].largest))
    } else {
        cheapest.next()
    }
}

/// The digits that a program loses, over all points at which some program is defined.
#[derive(Clone, Copy)]
struct Losses {
    /// The largest.
    largest: f64,
    /// The largest by that which is tolerable of the same output at the same point; at most one for a program to be taken.
    excess: f64,
}

/// Returns the digits that each program loses.
fn losses(graph: &Graph, codes: &[Candidate]) -> Vec<Losses> {
    let mut points: Vec<Point> = (0..ACCURACY_POINTS).map(Point::drawn).collect();
    // Equal programs lose as much, and no constant moves: each is looked at once.
    let mut different: Vec<&Candidate> = Vec::new();
    let mut kinds = Vec::new();
    for candidate in codes {
        let kind = different.iter().position(|other| other.equals(candidate));
        kinds.push(kind.unwrap_or(different.len()));
        if kind.is_none() {
            different.push(candidate);
        }
    }
    let random = points.clone();
    let prepared: Vec<Vec<Vec<f64>>> = different
        .iter()
        .map(|candidate| random.iter().map(|point| candidate.prepared(graph, point)).collect())
        .collect();
    for (candidate, prepared) in different.iter().zip(&prepared) {
        for divisor in candidate.divisors().into_iter().take(POLES) {
            points.extend(candidate.near_pole(graph, &random[0], &prepared[0], divisor));
        }
    }
    let mut worst = vec![Losses { largest: 0.0, excess: 0.0 }; different.len()];
    for point in &points {
        let found: Vec<Option<Vec<f64>>> = different
            .iter()
            .zip(&prepared)
            .map(|(candidate, prepared)| candidate.loss(graph, point, &prepared[point.seed as usize]))
            .collect();
        let Some(defined) = found.iter().flatten().next() else { continue };
        let mut least = vec![f64::INFINITY; defined.len()];
        for losses in found.iter().flatten() {
            for (least, loss) in least.iter_mut().zip(losses) {
                *least = least.min(*loss);
            }
        }
        for (worst, found) in worst.iter_mut().zip(found) {
            let Some(losses) = found else {
                *worst = Losses { largest: f64::INFINITY, excess: f64::INFINITY };
                continue;
            };
            for (loss, least) in losses.into_iter().zip(&least) {
                worst.largest = worst.largest.max(loss);
                worst.excess = worst.excess.max(loss / SERIOUS_LOSS.max(RELATIVE_LOSS * least));
            }
        }
    }
    kinds.into_iter().map(|kind| worst[kind]).collect()
}

#[cfg(test)]
mod tests {
    use crate::algebra::{ExprId, Graph, Role};
    use crate::program::{ProgramBuilder, Programs, evaluate_function, evaluate_prepare};

    use super::super::net::{Conversion, Field, Net};
    use super::{Candidate, best, promising};

    /// The program of an expression as it is written.
    fn candidate(graph: &mut Graph, e: ExprId) -> Candidate {
        let mut net = Net::default();
        let roots = Conversion::roots(graph, &mut net, Field::Constants, &[e]);
        Candidate::new(graph, &net, &roots)
    }

    /// The program taken of equal lists, and its values where all symbols are at `at`.
    fn taken(graph: &mut Graph, lists: &[Vec<ExprId>], at: &[f64]) -> (Programs, usize, Vec<f64>) {
        let mut builder = ProgramBuilder::new(graph);
        let index = builder.add_equal("f", lists);
        let programs = builder.finish();
        let value = |symbol: crate::algebra::SymbolId| at[symbol.index()];
        let prepared = evaluate_prepare(&programs, value);
        let found = evaluate_function(&programs, 0, &prepared, value);
        (programs, index, found)
    }

    #[test]
    fn the_dearer_program_is_taken_where_the_cheaper_one_cancels_next_to_a_pole() {
        // (1 - cos x)/x^2 against 1/2 (sin(x/2)/(x/2))^2: next to zero the first has no digits.
        let mut g = Graph::new();
        let x = g.symbol("x", Role::Coordinate);
        let (one, half) = (g.one(), g.ratio(1, 2));
        let (_, c) = g.sin_cos(x);
        let difference = g.sub(one, c);
        let cancels = g.product(&[(difference, 1), (x, -2)]);
        let middle = g.mul(half, x);
        let s = g.sin(middle);
        let keeps = g.product(&[(half, 1), (s, 2), (middle, -2)]);
        for lists in [[vec![cancels], vec![keeps]], [vec![keeps], vec![cancels]]] {
            let (_, _, found) = taken(&mut g, &lists, &[1e-7]);
            assert!((found[0] - 0.5).abs() < 1e-14, "{}", found[0]);
        }
        // An output that nobody can find to more digits does not hide what is lost of another one.
        let large = g.ratio(1_000_000_000_000, 1);
        let phase = g.mul(large, x);
        let lost = g.sin(phase);
        for lists in [[vec![lost, cancels], vec![lost, keeps]], [vec![lost, keeps], vec![lost, cancels]]] {
            let (_, _, found) = taken(&mut g, &lists, &[1e-7]);
            assert!((found[1] - 0.5).abs() < 1e-14, "{}", found[1]);
        }
    }

    #[test]
    fn accuracy_breaks_ties() {
        // x^2 - y^2 and (x + y)(x - y): three operations each, but the squares bring their roundings into the difference. Of
        // some of them, so that at some point two numbers are near each other.
        let mut g = Graph::new();
        let (mut squares, mut product) = (g.one(), g.one());
        for k in 0..6 {
            let [x, y] = ["x", "y"].map(|name| g.symbol(&format!("{name}{k}"), Role::Coordinate));
            let (xx, yy) = (g.mul(x, x), g.mul(y, y));
            let (sum, difference) = (g.add(x, y), g.sub(x, y));
            let (plain, factored) = (g.sub(xx, yy), g.mul(sum, difference));
            (squares, product) = (g.mul(squares, plain), g.mul(product, factored));
        }
        let candidates = [candidate(&mut g, squares), candidate(&mut g, product)];
        assert_eq!(candidates[0].cost(), candidates[1].cost());
        assert_eq!(best(&g, &candidates), 1);
        let [squares, product] = candidates;
        let turned = [product, squares];
        assert_eq!(best(&g, &turned), 0);
        // Before programs are finished the order decides.
        assert_eq!(promising(&g, &turned), 0);
        let [product, squares] = turned;
        assert_eq!(promising(&g, &[squares, product]), 0);
    }

    #[test]
    fn the_factored_form_is_taken_next_to_a_pole() {
        let mut g = Graph::new();
        let (x, y) = (g.symbol("x", Role::Coordinate), g.symbol("y", Role::Coordinate));
        let (xx, yy) = (g.mul(x, x), g.mul(y, y));
        let squares = g.sub(xx, yy);
        let (sum, difference) = (g.add(x, y), g.sub(x, y));
        let product = g.mul(sum, difference);
        // Divided by x - y, so that next to the pole the numerator cancels.
        let cubes = [(squares, 1), (difference, -2)];
        let cancels = g.product(&cubes);
        let keeps = g.product(&[(product, 1), (difference, -2)]);
        for lists in [[vec![cancels], vec![keeps]], [vec![keeps], vec![cancels]]] {
            let (_, _, found) = taken(&mut g, &lists, &[1.0 + 1e-9, 1.0]);
            let (x, y) = (1.0 + 1e-9_f64, 1.0_f64);
            let exact = (x + y) / (x - y);
            assert!((found[0] / exact - 1.0).abs() < 1e-14, "{:e}", found[0] / exact - 1.0);
        }
    }
}
