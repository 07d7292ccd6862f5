//! Does an expression vanish? Three answers: yes, no, unknown.
//!
//! What comes in is an expression of the graph; what goes out is a [`Verdict`] about it as a function of
//! all symbols, or of the points of the constraint manifold. *Zero* rests on random points modulo a
//! prime, *Nonzero* on one such point, confirmed at a real point in about 200 bits wherever a residue
//! could differ while the function does not. All draws have fixed seeds: the same question has the
//! same answer in every expansion.

mod drawn;
pub(crate) mod field;
pub(crate) mod jets;
mod manifold;
mod observed;
mod positions;
mod real;
mod redundant;
mod sample;
mod table;
#[cfg(test)]
mod tests;

use manifold::Manifold;
pub(crate) use positions::drawn_states;
use real::{RealPoint, RealRank, Sighting};
pub(crate) use sample::{DrawnRoots, Sample};
use table::{ATOM, OPAQUE, PIECEWISE, ROOT, SIGN, TRANSCENDENTAL, Table, UNDEFINED};

pub(crate) use real::apply;
pub use real::{Real, evaluate, evaluate_f64};
pub use redundant::Redundant;

use crate::algebra::{ExprId, FastMap, Flow, Function, Graph, Node};

/// The answer to a question that cannot always be decided.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Verdict {
    /// Vanishes identically.
    Zero,
    /// Does not vanish identically.
    Nonzero,
    /// Undecided; never to be taken for one of the others.
    Unknown,
}

/// Points that must agree before an expression counts as zero.
const POINTS: usize = 3;
/// Points that must agree where each may have a root's sign right by chance.
pub(crate) const POINTS_WITH_ROOTS: usize = 64;
/// Draws in vain, one after the other, before the real route is taken.
pub(crate) const REDRAWS: usize = 64;
/// Draws in all for one expression.
const DRAWS: usize = 512;
/// Points with roots that suffice where all draws are used up.
pub(crate) const FEWEST_POINTS_WITH_ROOTS: usize = 32;
/// Points that keep their values; those beyond serve one question only.
const KEPT_POINTS: usize = 128;
/// Real points tried.
const REAL_POINTS: usize = 12;
/// Real points in the domain that must show nothing before an expression with inverse functions counts as zero.
const REAL_WITNESSES: usize = 8;
/// Real points that must show a dependence of rows before it is one.
const LEAST_WITNESSES: usize = 4;
/// Derivatives of derivatives that are looked at for inverse functions.
const DERIVATIVE_DEPTH: u32 = 2;
/// Work on derivatives after which the question stays open: those of nested functions may be a thousand times as large as the
/// function.
const DERIVATIVE_WORK: u64 = 1_000_000;

/// Decides whether expressions of one graph vanish, remembering all that it computed.
///
/// ```
/// use guen_symbolic::{Graph, Role, Verdict, ZeroTest};
/// let mut g = Graph::new();
/// let x = g.symbol("x", Role::Coordinate);
/// let two_x = g.add(x, x);
/// let (s, c) = g.sin_cos(x);
/// let product = g.mul(s, c);
/// let twice = g.add(product, product);
/// let s2 = g.sin(two_x);
/// let difference = g.sub(s2, twice);
/// let mut test = ZeroTest::new();
/// assert_eq!(test.verdict(&mut g, difference), Verdict::Zero);
/// assert_eq!(test.verdict(&mut g, s2), Verdict::Nonzero);
/// ```
#[derive(Debug, Default)]
pub struct ZeroTest {
    table: Table,
    free: Domain,
    manifold: Option<Manifold>,
    bound: Domain,
}

/// The points of one domain, and what was decided there.
#[derive(Debug, Default)]
struct Domain {
    samples: Vec<Sample>,
    /// The samples with drawn roots.
    drawn: Vec<Sample>,
    generation: u32,
    reals: Vec<Option<RealPoint>>,
    verdicts: FastMap<ExprId, Verdict>,
    /// Whether roots are those of squares.
    roots_of_squares: FastMap<ExprId, bool>,
}

/// A manifold that is not asked for a while, with what was decided on it.
pub(crate) struct FormerManifold {
    manifold: Option<Manifold>,
    domain: Domain,
}

/// The verdict of the points modulo the prime.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Residues {
    Vanish,
    Differ,
    /// Too few points have a value; those that have one vanish.
    Few,
}

impl ZeroTest {
    /// A test that has seen nothing.
    pub fn new() -> Self {
        ZeroTest::default()
    }

    /// Whether an expression vanishes for all values of all symbols.
    pub fn verdict(&mut self, g: &mut Graph, e: ExprId) -> Verdict {
        self.decide(g, e, false, DERIVATIVE_DEPTH)
    }

    /// Whether an expression is proved to vanish.
    pub fn is_zero(&mut self, g: &mut Graph, e: ExprId) -> bool {
        self.verdict(g, e) == Verdict::Zero
    }

    /// Declares the manifold by the functions that vanish on it, of time, coordinates and constants.
    pub fn set_manifold(&mut self, g: &mut Graph, equations: &[ExprId]) {
        self.bound = Domain::default();
        let equations: Vec<_> = equations.iter().copied().filter(|e| !g.is_zero(*e)).collect();
        self.manifold = (!equations.is_empty()).then(|| Manifold::new(g, &mut self.table, &equations));
    }

    /// Takes the manifold out with all that was decided on it: none is left.
    pub(crate) fn take_manifold(&mut self) -> FormerManifold {
        FormerManifold { manifold: self.manifold.take(), domain: core::mem::take(&mut self.bound) }
    }

    /// Puts a manifold back in place of the present one.
    pub(crate) fn return_to(&mut self, former: FormerManifold) {
        (self.manifold, self.bound) = (former.manifold, former.domain);
    }

    /// Whether the manifold's points can be found, so that verdicts on it are possible.
    pub(crate) fn manifold_is_solved(&self) -> bool {
        self.manifold.as_ref().is_none_or(Manifold::is_solved)
    }

    /// Whether there are points where the equations of the manifold hold that can be solved: what holds there holds on the manifold.
    pub(crate) fn manifold_has_points(&self) -> bool {
        self.manifold.as_ref().is_none_or(Manifold::has_points)
    }

    /// Whether an expression vanishes at all points of the manifold, for all values of the other symbols.
    pub fn verdict_on_manifold(&mut self, g: &mut Graph, e: ExprId) -> Verdict {
        match self.verdict(g, e) {
            Verdict::Zero => Verdict::Zero,
            free if self.manifold.is_none() => free,
            _ => self.decide(g, e, true, 0),
        }
    }

    /// Whether expressions vanish wherever some equations hold, others than those of the manifold: at one point where those hold that can be
    /// solved, and at several where signs may be right by chance.
    pub(crate) fn vanish_where(&mut self, g: &mut Graph, equations: &[ExprId], es: &[ExprId]) -> bool {
        let manifold = Manifold::new(g, &mut self.table, equations);
        let has_signs = es.iter().any(|e| self.has_signs_or_roots(g, *e));
        let points = if has_signs { FEWEST_POINTS_WITH_ROOTS } else { 1 };
        (0..points).all(|number| {
            let point = new_sample(g, &self.table, Some(&manifold), number);
            point.is_some_and(|mut point| es.iter().all(|e| point.value(g, &self.table, *e) == Some(0)))
        })
    }

    /// Whether a point shows that an expression does not vanish, on the manifold or anywhere: no more is asked where what is
    /// not shown is left alone. It takes the work of evaluations, and no derivatives, which may be many times as large.
    pub(crate) fn is_shown_nonzero(&mut self, g: &mut Graph, e: ExprId, on_manifold: bool) -> bool {
        match g.node(e) {
            Node::Number(value) => !value.is_zero(),
            Node::Undefined => false,
            _ => self.sight(g, e, on_manifold && self.manifold.is_some()) == Ok(Verdict::Nonzero),
        }
    }

    /// Whether an expression has no derivative by any of the variables: `Zero` means that it is constant.
    pub fn is_constant(&mut self, g: &mut Graph, e: ExprId, variables: &[ExprId]) -> Verdict {
        self.derivatives_vanish(g, e, variables, DERIVATIVE_DEPTH)
    }

    fn derivatives_vanish(&mut self, g: &mut Graph, e: ExprId, variables: &[ExprId], depth: u32) -> Verdict {
        self.table.scan(g);
        // Between its jumps a function may be constant, and change at them.
        let jumps = self.table.flags[e.index()] & PIECEWISE != 0;
        let mut verdict = if jumps { Verdict::Unknown } else { Verdict::Zero };
        let before = g.work();
        for variable in variables {
            if g.work() - before > DERIVATIVE_WORK {
                return Verdict::Unknown;
            }
            let derivative = Flow::partial(g, *variable).of(g, e);
            match self.decide(g, derivative, false, depth) {
                Verdict::Zero => {}
                Verdict::Nonzero => return Verdict::Nonzero,
                Verdict::Unknown => verdict = Verdict::Unknown,
            }
        }
        verdict
    }

    /// The values of expressions modulo a prime at one random point, the same for all of them.
    ///
    /// `None` if no point was found, or if an expression has a division by zero.
    pub fn residues(
        &mut self,
        g: &mut Graph,
        sample: usize,
        es: &[ExprId],
        on_manifold: bool,
    ) -> Option<Vec<u64>> {
        self.table.scan(g);
        let mut found = 0;
        for point in 0..sample + REDRAWS {
            let point = self.sample(g, point, on_manifold)?;
            let (table, samples) = self.parts(on_manifold);
            let values: Option<Vec<_>> = es.iter().map(|e| samples[point].value(g, table, *e)).collect();
            if let Some(values) = values {
                if found == sample {
                    return Some(values);
                }
                found += 1;
            }
        }
        None
    }

    /// The point of a number without any values yet: symbols may be placed.
    pub(crate) fn fresh(&mut self, g: &Graph, number: usize, on_manifold: bool) -> Option<Sample> {
        self.table.scan(g);
        let number = self.sample(g, number, on_manifold)?;
        Some(self.parts(on_manifold).1[number].fresh())
    }

    /// Whether a residue that differs from zero shows that an expression of these does.
    pub(crate) fn is_exact(&mut self, g: &Graph, es: &[ExprId], on_manifold: bool) -> bool {
        self.table.scan(g);
        es.iter().all(|e| {
            let enters = match &mut self.manifold {
                Some(manifold) if on_manifold => !manifold.is_solved() || manifold.enters_functions(g, *e),
                _ => false,
            };
            !enters && self.table.flags[e.index()] & (ROOT | ATOM | TRANSCENDENTAL | OPAQUE | UNDEFINED) == 0
        })
    }

    /// A random point modulo the prime, of those at which symbols may be made zero.
    pub(crate) fn point(&mut self, g: &Graph, number: u64) -> Sample {
        self.table.scan(g);
        Sample::new(number)
    }

    /// The values of expressions at such a point; `None` where one has none.
    pub(crate) fn values_at(&self, g: &Graph, point: &mut Sample, es: &[ExprId]) -> Option<Vec<u64>> {
        es.iter().map(|e| point.value(g, &self.table, *e)).collect()
    }

    /// The value of an expression at the point of a number; `None` at a pole, or if there is no such point.
    pub(crate) fn value_at(
        &mut self,
        g: &mut Graph,
        point: usize,
        e: ExprId,
        on_manifold: bool,
    ) -> Option<u64> {
        self.table.scan(g);
        let point = self.sample(g, point, on_manifold)?;
        let (table, samples) = self.parts(on_manifold);
        samples[point].value(g, table, e)
    }

    /// Whether a residue has a sign by chance, so that one point tells nothing of others: where absolute values or signs occur, or roots of
    /// squares.
    pub(crate) fn has_signs(&mut self, g: &Graph, e: ExprId) -> bool {
        self.table.scan(g);
        self.table.flags[e.index()] & SIGN != 0 || self.has_roots_of_squares(g, e)
    }

    /// Whether absolute values, signs or roots occur. A root may be a product with something whose sign a residue has by chance, as
    /// `sqrt(x^2 (1 + y^2))` is.
    pub(crate) fn has_signs_or_roots(&mut self, g: &Graph, e: ExprId) -> bool {
        self.table.scan(g);
        self.table.flags[e.index()] & (SIGN | ROOT) != 0
    }

    /// Whether roots occur that are something or its opposite, as `sqrt(tanh(x)^2)` is, and on a manifold `sqrt(x^2 + y^2)` where
    /// `x^2 + y^2 = l^2`. A root that a constraint has is what that says it is.
    pub(crate) fn has_roots_of_squares(&mut self, g: &Graph, e: ExprId) -> bool {
        self.table.scan(g);
        let has_roots = |flags: &[table::Flags], e: ExprId| flags[e.index()] & ROOT != 0;
        if !has_roots(&self.table.flags, e) {
            return false;
        }
        let (flags, known) = (&self.table.flags, &self.bound.roots_of_squares);
        for id in g.reachable(&[e], |id| !has_roots(flags, id) || known.get(&id).is_some()) {
            let known = &self.bound.roots_of_squares;
            let below = g.children(id).iter().any(|child| known.get(child) == Some(&true));
            let found = below
                || match g.node(id) {
                    Node::Function(Function::Root(q), radicand) if q % 2 == 0 => {
                        self.is_square(g, id, *radicand)
                    }
                    _ => false,
                };
            self.bound.roots_of_squares.insert(id, found);
        }
        self.bound.roots_of_squares.get(&e) == Some(&true)
    }

    /// Whether a radicand is a square at all points of the manifold, though no constraint has its root; without a manifold at all points, where
    /// positive symbols are no squares.
    fn is_square(&mut self, g: &Graph, root: ExprId, radicand: ExprId) -> bool {
        /// Points at which another radicand is a square with a probability of 1 in 4096.
        const SQUARES: usize = 12;
        // A number is the same at all points.
        let is_number = g.symbols_in(&[radicand]).is_empty();
        if is_number || self.manifold.as_ref().is_some_and(|manifold| manifold.has(g, root)) {
            return false;
        }
        let mut squares = 0;
        for number in 0..REDRAWS {
            let sample = match self.manifold {
                Some(_) => self.fresh(g, number, true),
                None => Some(Sample::without_bounds(number as u64)),
            };
            let value = sample.and_then(|mut sample| sample.value(g, &self.table, radicand));
            match value.map(field::sqrt) {
                Some(None) => return false,
                Some(Some(_)) => squares += 1,
                None => {}
            }
            if squares == SQUARES {
                return true;
            }
        }
        false
    }

    /// Changes when the values at all points do.
    pub(crate) fn generation(&self) -> u32 {
        self.table.generation
    }

    /// The rank of a matrix at general points; `None` if no point was found.
    pub fn rank(&mut self, g: &mut Graph, rows: &[Vec<ExprId>], on_manifold: bool) -> Option<usize> {
        if on_manifold && !self.manifold_is_solved() {
            return None;
        }
        let flat: Vec<ExprId> = rows.iter().flatten().copied().collect();
        let mut rank = 0;
        for sample in 0..2 {
            let mut values = self.residues(g, sample, &flat, on_manifold)?.into_iter();
            let matrix: Vec<Vec<u64>> =
                rows.iter().map(|row| values.by_ref().take(row.len()).collect()).collect();
            rank = rank.max(field::rank(&matrix));
            // No point shows more than all rows.
            if rank == rows.len() {
                break;
            }
        }
        let has_signs = flat.iter().any(|e| self.has_signs_or_roots(g, *e));
        // A residue may differ where the function does not, and has the sign of a root by chance, which two points need not have both:
        // `|x| - x` vanishes at half of them.
        let needs_points =
            (rank > 0 && !self.is_exact(g, &flat, on_manifold)) || (rank < rows.len() && has_signs);
        if !needs_points {
            return Some(rank);
        }
        let (mut observed, mut witnesses) = (0, 0);
        for number in 0..REAL_POINTS {
            let Some(point) = self.real_point(g, number, on_manifold) else { continue };
            let Some(RealRank { rank: own, is_certain }) = point.rank(g, rows) else { continue };
            observed = observed.max(own);
            witnesses += usize::from(is_certain);
            if observed == rows.len() || (observed == rank && !has_signs) {
                break;
            }
        }
        Some(if witnesses < LEAST_WITNESSES { rank.max(observed) } else { observed })
    }

    /// The equations `f(t, x) = 0` that follow from others of them wherever all hold, although gradients by the coordinates are
    /// independent elsewhere, not those whose gradients depend on theirs everywhere. The manifold is that of the equations afterwards.
    ///
    /// Where points modulo the prime can be found, independence is decided there. Else it is observed: at four real points from
    /// random starts, in 237 bits.
    ///
    /// ```
    /// use guen_symbolic::{Graph, Redundant, Role, ZeroTest};
    /// let mut g = Graph::new();
    /// let angles = ["a", "b", "c"].map(|name| g.symbol(name, Role::Coordinate));
    /// let parts = angles.map(|angle| g.sin_cos(angle));
    /// // sin(a) = sin(b), cos(a) = cos(b) and sin(a) cos(c) = cos(b) sin(c).
    /// let (left, right) = (g.mul(parts[0].0, parts[2].1), g.mul(parts[1].1, parts[2].0));
    /// let equations = [g.sub(parts[0].0, parts[1].0), g.sub(parts[0].1, parts[1].1), g.sub(left, right)];
    /// let redundant = ZeroTest::new().redundant(&mut g, &equations, &angles);
    /// assert_eq!(redundant, [Redundant { equation: 1, beside: vec![0] }]);
    /// ```
    pub fn redundant(
        &mut self,
        g: &mut Graph,
        equations: &[ExprId],
        coordinates: &[ExprId],
    ) -> Vec<Redundant> {
        self.set_manifold(g, equations);
        let rows: Vec<Vec<ExprId>> = equations
            .iter()
            .map(|e| coordinates.iter().map(|x| Flow::partial(g, *x).of(g, *e)).collect())
            .collect();
        if rows.len() < 2 || self.rank(g, &rows, true) == Some(rows.len()) {
            return Vec::new();
        }
        let mut found = redundant::find(g, equations);
        found.retain(|Redundant { equation, beside }| {
            let together: Vec<_> = beside.iter().chain([equation]).map(|i| rows[*i].clone()).collect();
            self.rank(g, &together, false) == Some(together.len())
        });
        found
    }

    fn parts(&mut self, on_manifold: bool) -> (&Table, &mut Vec<Sample>) {
        let domain = if on_manifold && self.manifold.is_some() { &mut self.bound } else { &mut self.free };
        (&self.table, &mut domain.samples)
    }

    /// Makes sure that the sample of a number exists; `None` if the manifold has no such point.
    fn sample(&mut self, g: &Graph, number: usize, on_manifold: bool) -> Option<usize> {
        let manifold = self.manifold.as_ref().filter(|_| on_manifold);
        let domain = if manifold.is_some() { &mut self.bound } else { &mut self.free };
        // Points that solve equations move with the points of the circle they were computed from.
        if manifold.is_some() && domain.generation != self.table.generation {
            domain.samples.clear();
            domain.drawn.clear();
        }
        domain.generation = self.table.generation;
        while domain.samples.len() <= number {
            domain.samples.push(new_sample(g, &self.table, manifold, domain.samples.len())?);
        }
        Some(number)
    }

    fn decide(&mut self, g: &mut Graph, e: ExprId, on_manifold: bool, depth: u32) -> Verdict {
        match g.node(e) {
            Node::Number(value) => return if value.is_zero() { Verdict::Zero } else { Verdict::Nonzero },
            Node::Undefined => return Verdict::Unknown,
            _ => {}
        }
        let domain = if on_manifold { &self.bound } else { &self.free };
        if let Some(known) = domain.verdicts.get(&e) {
            return *known;
        }
        let verdict = self.examine(g, e, on_manifold, depth);
        let domain = if on_manifold { &mut self.bound } else { &mut self.free };
        // An answer that lacked depth may be better next time.
        if verdict != Verdict::Unknown || depth == DERIVATIVE_DEPTH || on_manifold {
            domain.verdicts.insert(e, verdict);
        }
        verdict
    }

    fn examine(&mut self, g: &mut Graph, e: ExprId, on_manifold: bool, depth: u32) -> Verdict {
        let (flags, witnesses) = match self.sight(g, e, on_manifold) {
            Ok(verdict) => return verdict,
            Err(seen) => seen,
        };
        if on_manifold || flags & (ATOM | TRANSCENDENTAL) == 0 || witnesses < REAL_WITNESSES {
            return Verdict::Unknown;
        }
        // All derivatives vanish, and so does the constant in 200 bits.
        let variables: Vec<_> = g.symbols_in(&[e]).into_iter().map(|symbol| g.symbol_expr(symbol)).collect();
        if !variables.is_empty() && (depth == 0 || flags & ATOM == 0) {
            return Verdict::Unknown;
        }
        match self.derivatives_vanish(g, e, &variables, depth.saturating_sub(1)) {
            Verdict::Zero => Verdict::Zero,
            _ => Verdict::Unknown,
        }
    }

    /// Returns the verdict of the points; without one, the flags of the expression and the number of real points that
    /// showed no difference.
    fn sight(&mut self, g: &mut Graph, e: ExprId, on_manifold: bool) -> Result<Verdict, (u8, usize)> {
        self.table.scan(g);
        let mut flags = self.table.flags[e.index()];
        if flags & UNDEFINED != 0 {
            return Ok(Verdict::Unknown);
        }
        if on_manifold
            && let Some(manifold) = &mut self.manifold
            && (!manifold.is_solved() || manifold.enters_functions(g, e))
        {
            flags |= OPAQUE;
        }
        let residues = self.residues_of(g, e, on_manifold, flags & ROOT != 0);
        if residues == Residues::Vanish {
            return Ok(Verdict::Zero);
        }
        if residues == Residues::Differ && flags & (ROOT | ATOM | TRANSCENDENTAL | OPAQUE) == 0 {
            return Ok(Verdict::Nonzero);
        }
        match self.at_real_points(g, e, on_manifold) {
            None => Ok(Verdict::Nonzero),
            Some(witnesses) => Err((flags, witnesses)),
        }
    }

    fn residues_of(&mut self, g: &Graph, e: ExprId, on_manifold: bool, roots: bool) -> Residues {
        if roots && self.vanishes_whatever_roots_are(g, e, on_manifold) {
            return Residues::Vanish;
        }
        let wanted = if roots { POINTS_WITH_ROOTS } else { POINTS };
        let (mut seen, mut in_vain) = (0, 0);
        for number in 0..DRAWS {
            let value = if number < KEPT_POINTS {
                let Some(point) = self.sample(g, number, on_manifold) else { return Residues::Few };
                let (table, samples) = self.parts(on_manifold);
                samples[point].value(g, table, e)
            } else {
                let manifold = self.manifold.as_ref().filter(|_| on_manifold);
                match new_sample(g, &self.table, manifold, number) {
                    Some(mut sample) => sample.value(g, &self.table, e),
                    None => return Residues::Few,
                }
            };
            match value {
                None => in_vain += 1,
                Some(0) => (seen, in_vain) = (seen + 1, 0),
                Some(_) => return Residues::Differ,
            }
            if seen == wanted {
                return Residues::Vanish;
            }
            if in_vain > REDRAWS {
                break;
            }
        }
        if roots && seen >= FEWEST_POINTS_WITH_ROOTS {
            return Residues::Vanish;
        }
        Residues::Few
    }

    /// The real point of a number, which is made once; `None` if there is no such point.
    fn real_point(&mut self, g: &Graph, number: usize, on_manifold: bool) -> Option<&mut RealPoint> {
        let manifold = self.manifold.as_ref().filter(|_| on_manifold);
        let domain = if on_manifold { &mut self.bound } else { &mut self.free };
        while domain.reals.len() <= number {
            let next = domain.reals.len() as u64;
            domain.reals.push(match manifold {
                Some(manifold) => manifold.real_point(g, next),
                None => Some(RealPoint::new(next)),
            });
        }
        domain.reals[number].as_mut()
    }

    /// Looks at real points: `None` if one shows that the value is not zero, else how many show nothing.
    fn at_real_points(&mut self, g: &mut Graph, e: ExprId, on_manifold: bool) -> Option<usize> {
        let mut small = 0;
        for number in 0..REAL_POINTS {
            let Some(point) = self.real_point(g, number, on_manifold) else { continue };
            match point.sight(g, e) {
                Sighting::Nonzero => return None,
                Sighting::Small => small += 1,
                Sighting::Nothing => {}
            }
            if small == REAL_WITNESSES {
                break;
            }
        }
        Some(small)
    }
}

fn new_sample(g: &Graph, table: &Table, manifold: Option<&Manifold>, number: usize) -> Option<Sample> {
    match manifold {
        None => Some(Sample::new(number as u64)),
        Some(manifold) => manifold.sample(g, table, number as u64),
    }
}
