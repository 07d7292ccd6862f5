//! The tools of every stage of the derivation: the graph, the zero test, and tidying with a memory.

use crate::algebra::{BaseAngles, ExprId, FastMap, Flow, Graph, Node};
use crate::normal::{Limits, normal_form};
use crate::program::weighted_cost;
use crate::zero::{Verdict, ZeroTest};

/// The limits of tidying. Coefficients and entries are within them; a larger expression stays as it is, since more
/// steps hardly ever make it shorter.
const TIDYING: Limits = Limits { terms: 150, generators: 32, degree: 32, nodes: 400, steps: 2_600 };

/// Steps of building ([`Graph::work`]) beyond which a derivation is given up: some seconds without optimisation,
/// many times what the largest systems need that can be run at all.
pub const MAX_WORK: u64 = 6_000_000;

/// The graph together with what answers questions about it.
pub struct Workbench {
    /// The expressions.
    pub graph: Graph,
    /// The zero test.
    pub zero: ZeroTest,
    tidied: FastMap<ExprId, ExprId>,
    /// Expressions whose normal forms are beyond the limits.
    beyond: FastMap<ExprId, ()>,
    limits: Limits,
    /// Work that was done before the present derivation began.
    before: u64,
    /// The formulations that are not tried.
    left_out: Vec<&'static str>,
}

impl Workbench {
    /// A workbench around a graph.
    pub fn new(graph: Graph) -> Self {
        Workbench {
            graph,
            zero: ZeroTest::new(),
            tidied: FastMap::default(),
            beyond: FastMap::default(),
            limits: TIDYING,
            before: 0,
            left_out: Vec::new(),
        }
    }

    /// The expression in normal form where that is small, zero if it is proved to vanish, else as it is.
    pub fn tidy(&mut self, e: ExprId) -> ExprId {
        if self.graph.as_number(e).is_some() || self.graph.as_symbol(e).is_some() {
            return e;
        }
        if let Some(known) = self.tidied.get(&e) {
            return *known;
        }
        if self.is_exhausted() {
            return e;
        }
        let tidy = if self.vanishes(e) {
            self.graph.zero()
        } else if self.is_beyond(e) {
            e
        } else {
            match normal_form(&mut self.graph, e, &self.limits) {
                Some(normal) if self.is_worth(normal, e) => normal,
                Some(_) => e,
                None => {
                    self.beyond.insert(e, ());
                    e
                }
            }
        };
        self.tidied.insert(e, tidy);
        self.tidied.insert(tidy, tidy);
        tidy
    }

    /// Tidies one of several expressions that are alike: where one has no normal form within the limits, those that cost as
    /// much are only asked whether they vanish. `least` keeps the least cost of such a one.
    pub(crate) fn tidy_alike(&mut self, e: ExprId, least: &mut Option<u64>) -> ExprId {
        let cost = weighted_cost(&self.graph, &[e]);
        if least.is_some_and(|least| cost >= least) && !self.tidied.contains_key(&e) {
            return self.dropped(e);
        }
        let tidy = self.tidy(e);
        if self.beyond.contains_key(&e) {
            *least = Some(least.map_or(cost, |least| least.min(cost)));
        }
        tidy
    }

    /// Whether something in the expression has no normal form within the limits: then the whole rarely has one either.
    fn is_beyond(&mut self, e: ExprId) -> bool {
        if self.beyond.is_empty() {
            return false;
        }
        let graph = &self.graph;
        let parts = graph.reachable(&[e], |id| matches!(graph.node(id), Node::Kept(_)));
        parts.iter().any(|part| self.beyond.contains_key(part))
    }

    /// Whether a normal form does not cost much more than what was written: multiplied out, sines of long sums of
    /// angles and products of sums do.
    fn is_worth(&self, normal: ExprId, written: ExprId) -> bool {
        let (new, old) = (weighted_cost(&self.graph, &[normal]), weighted_cost(&self.graph, &[written]));
        new <= old + old / 2
    }

    /// Whether the expression is proved to be zero as a function of all its symbols.
    pub fn vanishes(&mut self, e: ExprId) -> bool {
        if self.graph.as_number(e).is_some() || self.is_exhausted() {
            return self.graph.is_zero(e);
        }
        self.zero.verdict(&mut self.graph, e) == Verdict::Zero
    }

    /// Whether the expression vanishes wherever the holonomic constraints hold.
    pub fn verdict_on_manifold(&mut self, e: ExprId) -> Verdict {
        if self.graph.as_number(e).is_some() {
            return if self.graph.is_zero(e) { Verdict::Zero } else { Verdict::Nonzero };
        }
        if self.is_exhausted() {
            return Verdict::Unknown;
        }
        self.zero.verdict_on_manifold(&mut self.graph, e)
    }

    /// Whether the expression vanishes wherever the holonomic constraints hold, as far as that is proved or, where nothing can be, as points show
    /// in 237 bits.
    pub fn is_seen_to_vanish(&mut self, e: ExprId) -> bool {
        match self.verdict_on_manifold(e) {
            Verdict::Zero => true,
            Verdict::Nonzero => false,
            Verdict::Unknown => {
                !self.is_exhausted() && self.zero.observed_rank(&mut self.graph, &[vec![e]]) == Some(0)
            }
        }
    }

    /// Whether more was built than a compiler should spend. From then on questions about expressions stay open, so
    /// that whoever is at work comes to an end soon; the result is given up.
    pub(crate) fn is_exhausted(&self) -> bool {
        self.share_of_work() > 1.0
    }

    /// The work of the derivation so far, as a share of what a compiler should spend.
    pub(crate) fn share_of_work(&self) -> f64 {
        (self.graph.work() - self.before) as f64 / MAX_WORK as f64
    }

    /// Begins a further derivation in the same graph, with a limit of its own.
    pub fn begin_another(&mut self) {
        self.before = self.graph.work();
    }

    /// Leaves a formulation out of the derivations to come, to measure or to test the others. Where none of these has rates, the equations
    /// as they are stated are solved nevertheless.
    ///
    /// ```
    /// use guen_symbolic::{Graph, Workbench};
    /// let mut bench = Workbench::new(Graph::new());
    /// bench.leave_out("recursive");
    /// assert!(bench.leaves_out("recursive") && !bench.leaves_out("bodies"));
    /// ```
    pub fn leave_out(&mut self, formulation: &'static str) {
        self.left_out.push(formulation);
    }

    /// Whether a formulation is left out.
    #[must_use]
    pub fn leaves_out(&self, formulation: &str) -> bool {
        self.left_out.contains(&formulation)
    }

    /// A large expression kept whole, so that its users share it; a small one as it is.
    pub fn keep_large(&mut self, e: ExprId) -> ExprId {
        // Larger than every coefficient of the paper's systems: those are written out, and simplify together.
        self.keep_above(e, 24)
    }

    /// An expression of more than so many nodes kept whole.
    pub(crate) fn keep_above(&mut self, e: ExprId, small: usize) -> ExprId {
        let graph = &self.graph;
        let stop = |id| graph.roles(id).is_constant();
        let mut size = 0;
        let mut stack = vec![e];
        while let Some(id) = stack.pop() {
            if stop(id) {
                continue;
            }
            size += 1;
            if size > small {
                return self.graph.keep(e);
            }
            if !matches!(graph.node(id), Node::Kept(_)) {
                stack.extend(graph.children(id));
            }
        }
        e
    }

    /// Chooses base angles for some expressions, see [`Graph::choose_base_angles`]. What was tidied before may be
    /// tidied again.
    pub(crate) fn choose_base_angles(&mut self, given: &[ExprId], roots: &[ExprId]) {
        self.graph.choose_base_angles(given, roots);
        self.tidied = FastMap::default();
        self.beyond = FastMap::default();
    }

    /// Does something with base angles for some expressions, and returns to those of today with all that is remembered.
    ///
    /// ```
    /// use guen_symbolic::{Graph, Role, Workbench};
    /// let mut bench = Workbench::new(Graph::new());
    /// let (p, q) = (bench.graph.symbol("p", Role::Coordinate), bench.graph.symbol("q", Role::Coordinate));
    /// let sum = bench.graph.add(p, q);
    /// let (link, next, between) = (bench.graph.cos(p), bench.graph.cos(sum), bench.graph.cos(q));
    /// let told_apart = |bench: &mut Workbench| {
    ///     bench.graph.is_in_base_angles(next) && !bench.graph.is_in_base_angles(between)
    /// };
    /// assert!(bench.in_base_angles(&[link, next], told_apart));
    /// assert!(bench.in_base_angles(&[between], |bench| bench.graph.is_in_base_angles(between)));
    /// ```
    pub fn in_base_angles<T>(&mut self, roots: &[ExprId], work: impl FnOnce(&mut Self) -> T) -> T {
        let mut angles = BaseAngles::default();
        self.graph.exchange_base_angles(&mut angles);
        let tidied = core::mem::take(&mut self.tidied);
        let beyond = core::mem::take(&mut self.beyond);
        self.choose_base_angles(&[], roots);
        let result = work(self);
        self.graph.exchange_base_angles(&mut angles);
        (self.tidied, self.beyond) = (tidied, beyond);
        result
    }

    /// Does something on the manifold of some equations, and returns to that of today with all that is remembered.
    ///
    /// ```
    /// use guen_symbolic::{Graph, Role, Verdict, Workbench};
    /// let mut bench = Workbench::new(Graph::new());
    /// let (p, q) = (bench.graph.symbol("p", Role::Coordinate), bench.graph.symbol("q", Role::Coordinate));
    /// let gap = bench.graph.sub(p, q);
    /// assert_eq!(bench.on_manifold(&[gap], |bench| bench.verdict_on_manifold(gap)), Verdict::Zero);
    /// assert_eq!(bench.verdict_on_manifold(gap), Verdict::Nonzero);
    /// ```
    pub fn on_manifold<T>(&mut self, equations: &[ExprId], work: impl FnOnce(&mut Self) -> T) -> T {
        let former = self.zero.take_manifold();
        self.zero.set_manifold(&mut self.graph, equations);
        let result = work(self);
        self.zero.return_to(former);
        result
    }

    /// Zero if it is proved to vanish, else the expression as it is: cheaper than [`Workbench::tidy`].
    pub fn dropped(&mut self, e: ExprId) -> ExprId {
        if self.vanishes(e) { self.graph.zero() } else { e }
    }

    /// `sum a_i b_i`.
    pub fn dot(&mut self, a: &[ExprId], b: &[ExprId]) -> ExprId {
        let products: Vec<_> = a.iter().zip(b).map(|(a, b)| self.graph.mul(*a, *b)).collect();
        self.graph.sum(products)
    }

    /// The derivative of `e` by a symbol; for many derivatives by one symbol keep a [`Flow`].
    pub fn partial(&mut self, e: ExprId, symbol: ExprId) -> ExprId {
        Flow::partial(&self.graph, symbol).of(&mut self.graph, e)
    }
}
