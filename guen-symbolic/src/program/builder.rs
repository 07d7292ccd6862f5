//! Running the stages: every function by itself, what they share in *prepare*.

use crate::program::thresholds::{
    COLD_NODES, FINALIST_COST, FINALISTS, HARDLY_MORE, MOST_JOINED, NAMES_WITH_CANDIDATES,
    OPTIMISED_WITHOUT_NAMES,
};
use std::collections::BTreeMap;

use super::accuracy::{self, Candidate};
use super::cost::{OperationCount, weighted_cost};
use super::instruction::{FunctionProgram, Operation, Programs};
use super::lower::{Code, PreparedTable, lower};
use super::net::{Conversion, Field, Net, NetNode};
use super::part::needed;
use super::passes::{CANDIDATES, Changes, JOINED, Pass, affordable, apply, rebuild};
use super::regular;
use super::reuse::reused;
use super::shape::Indices;
use super::terms::NetId;
use crate::algebra::{ExprId, FastMap, Graph, Node, Role, Substitution};

/// A way to compute the outputs of a function.
///
/// Definitions name intermediate results by symbols that later definitions and the outputs use. They stay whole: the
/// optimiser works on what is defined at one depth together, and does not look through a name. A solve written with
/// named entries keeps its sharing, and stays cheap to optimise.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Formulation {
    /// Symbols and what they stand for; a definition uses only symbols defined before it.
    pub definitions: Vec<(ExprId, ExprId)>,
    /// The expressions to compute.
    pub outputs: Vec<ExprId>,
}

/// The effort with which a function is optimised.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Effort {
    /// Every candidate that is affordable.
    Hot,
    /// The first candidate alone, to rank formulations.
    Brief,
    /// The first candidate alone, and none for small functions.
    Cold,
    /// None.
    Regular,
}

/// Collects functions and turns them into code.
///
/// ```
/// use guen_symbolic::{Graph, ProgramBuilder, Role};
/// let mut g = Graph::new();
/// let (x, m, k) = (g.symbol("x", Role::Coordinate), g.symbol("m", Role::Constant), g.symbol("k", Role::Constant));
/// let ratio = g.div(k, m);
/// let force = g.mul(ratio, x);
/// let mut builder = ProgramBuilder::new(&mut g);
/// builder.add_function("rates", &[force]);
/// let programs = builder.finish();
/// // k/m is computed once, the function is one multiplication.
/// assert_eq!(programs.prepared.len(), 1);
/// assert_eq!(programs.functions[0].cost.operations(), 1);
/// ```
pub struct ProgramBuilder<'a> {
    graph: &'a mut Graph,
    prepared: PreparedTable,
    functions: Vec<FunctionProgram>,
    names: FastMap<ExprId, ExprId>,
}

impl<'a> ProgramBuilder<'a> {
    /// A builder without functions.
    pub fn new(graph: &'a mut Graph) -> Self {
        ProgramBuilder {
            graph,
            prepared: PreparedTable::default(),
            functions: Vec::new(),
            names: FastMap::default(),
        }
    }

    /// Adds a function of everything that its outputs depend on, optimised with all effort.
    pub fn add_function(&mut self, name: &str, outputs: &[ExprId]) {
        self.add_equal(name, &[outputs.to_vec()]);
    }

    /// Adds a function that is called now and then: the time of expansion counts more than an operation.
    pub fn add_cold(&mut self, name: &str, outputs: &[ExprId]) {
        self.add_lists(name, &[outputs.to_vec()], Effort::Cold);
    }

    /// Adds a function given by several lists of equal expressions; returns which list was taken.
    ///
    /// What is kept whole in them gets a name; small functions are tried without names too.
    pub fn add_equal(&mut self, name: &str, lists: &[Vec<ExprId>]) -> usize {
        self.add_lists(name, lists, Effort::Hot)
    }

    fn add_lists(&mut self, name: &str, lists: &[Vec<ExprId>], effort: Effort) -> usize {
        let mut formulations = Vec::new();
        let mut origin = Vec::new();
        for (index, outputs) in lists.iter().enumerate() {
            let named = self.named(outputs);
            let plain =
                named.as_ref().is_none_or(|_| weighted_cost(self.graph, outputs) <= OPTIMISED_WITHOUT_NAMES);
            if plain {
                formulations.push(Formulation { definitions: Vec::new(), outputs: outputs.clone() });
                origin.push(index);
            }
            if let Some(named) = named {
                formulations.push(named);
                origin.push(index);
            }
        }
        let taken = self.add(name, &formulations, effort);
        origin.get(taken).copied().unwrap_or(0)
    }

    /// The outputs with a symbol for everything that is kept whole, or `None` if nothing is.
    fn named(&mut self, outputs: &[ExprId]) -> Option<Formulation> {
        let kept: Vec<ExprId> = self
            .graph
            .reachable(outputs, |_| false)
            .into_iter()
            .filter(|id| matches!(self.graph.node(*id), Node::Kept(_)))
            .collect();
        if kept.is_empty() {
            return None;
        }
        let mut definitions = Vec::new();
        let mut names = Substitution::default();
        for id in kept {
            let Node::Kept(inside) = *self.graph.node(id) else { continue };
            let definition = names.of(self.graph, inside);
            // Any role will do that marks a state; these symbols never leave the program.
            let symbol = match self.names.get(&id) {
                Some(symbol) => *symbol,
                None => {
                    let symbol = self.graph.symbol("", Role::QuasiAcceleration);
                    self.names.insert(id, symbol);
                    symbol
                }
            };
            names.add(id, symbol);
            definitions.push((symbol, definition));
        }
        let outputs = outputs.iter().map(|e| names.of(self.graph, *e)).collect();
        Some(Formulation { definitions, outputs })
    }

    /// Adds a function in the cheapest of several formulations, the first of equals; returns which one that is.
    pub(super) fn add(&mut self, name: &str, formulations: &[Formulation], effort: Effort) -> usize {
        if let [only] = formulations {
            let mut net = Net::default();
            let roots = staged(self.graph, &mut net, only, effort);
            let roots = joined(self.graph, &mut net, (roots, only), effort);
            self.push_cheaper(name, (net, roots), only, effort);
            return 0;
        }
        // Each formulation is looked at briefly; all effort goes into the best ones.
        let is_short = effort == Effort::Cold;
        let mut tried: Vec<(usize, Net, Vec<NetId>)> = Vec::new();
        let mut programs: Vec<Candidate> = Vec::new();
        let attempt = |graph: &mut Graph, programs: &mut Vec<Candidate>, index: usize, effort: Effort| {
            let mut net = Net::default();
            let roots = staged(graph, &mut net, &formulations[index], effort);
            programs.push(Candidate::new(graph, &net, &roots));
            (index, net, roots)
        };
        let brief = if is_short { effort } else { Effort::Brief };
        let mut best = 0;
        for (index, formulation) in formulations.iter().enumerate() {
            if !formulations[..index].contains(formulation) {
                tried.push(attempt(self.graph, &mut programs, index, brief));
            }
        }
        if tried.len() > 1 {
            best = accuracy::promising(self.graph, &programs);
        }
        if !is_short {
            let finalists = finalists(&programs, best).into_iter().map(|place| tried[place].0);
            for index in finalists.collect::<Vec<usize>>() {
                tried.push(attempt(self.graph, &mut programs, index, effort));
            }
            best = accuracy::best(self.graph, &programs);
        }
        let (index, mut net, roots) =
            if tried.is_empty() { Default::default() } else { tried.swap_remove(best) };
        match formulations.first() {
            Some(first) => {
                let roots = joined(self.graph, &mut net, (roots, &formulations[index]), effort);
                self.push_cheaper(name, (net, roots), first, effort);
            }
            None => self.push(name, &net, &roots),
        }
        index
    }

    /// Adds the code of some roots; of a long family their code as it is written regularly, without passes, if that costs hardly more:
    /// then loops are found in it.
    fn push_cheaper(
        &mut self,
        name: &str,
        (mut net, roots): (Net, Vec<NetId>),
        plain: &Formulation,
        effort: Effort,
    ) {
        if !self.graph.nests_sums() {
            return match effort {
                Effort::Hot => self.push_reused(name, &net, &roots),
                _ => self.push(name, &net, &roots),
            };
        }
        let indices = Indices::new(self.graph);
        let mut other = Net::default();
        let plain = staged(self.graph, &mut other, plain, Effort::Regular);
        let plain = regular::rebuild(self.graph, &mut other, &plain, &indices);
        let cost = |graph: &mut Graph, net: &Net, roots: &[NetId]| Candidate::new(graph, net, roots).cost();
        let (optimised, regular) = (cost(self.graph, &net, &roots), cost(self.graph, &other, &plain));
        if 100 * regular <= HARDLY_MORE * optimised {
            self.push(name, &other, &plain);
        } else {
            let roots = regular::rebuild(self.graph, &mut net, &roots, &indices);
            self.push(name, &net, &roots);
        }
    }

    /// Adds the code of some roots, with values by products of others unless digits are lost so.
    fn push_reused(&mut self, name: &str, net: &Net, roots: &[NetId]) {
        let program = Candidate::new(self.graph, net, roots);
        let (code, prepared) = program.parts();
        let other = reused(self.graph, code, prepared).map(|code| program.with(code));
        let mut programs: Vec<Candidate> = [program].into_iter().chain(other).collect();
        let best = accuracy::best(self.graph, &programs);
        let code = programs.swap_remove(best).loading(&mut self.prepared);
        self.push_code(name, code);
    }

    /// Adds the code of some roots.
    fn push(&mut self, name: &str, net: &Net, roots: &[NetId]) {
        let code = lower(self.graph, net, roots, &mut self.prepared);
        self.push_code(name, code);
    }

    fn push_code(&mut self, name: &str, Code { instructions, outputs, values }: Code) {
        let cost = OperationCount::of(&instructions);
        self.functions.push(FunctionProgram { name: name.to_owned(), instructions, outputs, values, cost });
    }

    /// Brings prepared values of one shape together, so that a loop over a family goes through them in order.
    fn order_prepared(&mut self) {
        let indices = Indices::new(self.graph);
        let order = regular::order(self.graph, &self.prepared.expressions, &indices);
        let mut places = vec![0; order.len()];
        order.iter().enumerate().for_each(|(place, old)| places[*old] = place);
        self.prepared.expressions = order.iter().map(|old| self.prepared.expressions[*old]).collect();
        for instruction in self.functions.iter_mut().flat_map(|function| &mut function.instructions) {
            if let Operation::Prepared(k) = &mut instruction.operation {
                *k = places[*k];
            }
        }
    }

    /// The functions, and the code that prepares their constants.
    pub fn finish(mut self) -> Programs {
        if self.graph.nests_sums() {
            self.order_prepared();
        }
        let mut net = Net::default();
        let roots = Conversion::roots(self.graph, &mut net, Field::Numbers, &self.prepared.expressions);
        let mut none = PreparedTable::default();
        let roots = if self.graph.nests_sums() {
            let indices = Indices::new(self.graph);
            regular::rebuild(self.graph, &mut net, &roots, &indices)
        } else {
            roots
        };
        let code = lower(self.graph, &net, &roots, &mut none);
        debug_assert!(none.expressions.is_empty(), "numbers need no preparation");
        // A quotient of a number is one division, beside a reciprocal that only it would have read.
        let prepare = needed(&code.instructions, code.values, &code.outputs);
        let prepare_cost = OperationCount::of(&prepare);
        Programs {
            prepare,
            prepared: code.outputs,
            prepare_values: code.values,
            prepare_cost,
            functions: self.functions,
        }
    }
}

/// Returns the programs that may be the cheapest once all effort goes into them: the best one, and small ones that
/// cost little more.
fn finalists(programs: &[Candidate], best: usize) -> Vec<usize> {
    let least = programs[best].cost();
    let mut found = vec![best];
    for (place, program) in programs.iter().enumerate() {
        let is_near = least <= FINALIST_COST && 16 * program.cost() <= 17 * least;
        if found.len() < FINALISTS && is_near && !found.iter().any(|other| program.equals(&programs[*other]))
        {
            found.push(place);
        }
    }
    found
}

/// The outputs, optimised depth by depth, with the definitions in place of their symbols.
fn staged(graph: &mut Graph, net: &mut Net, formulation: &Formulation, effort: Effort) -> Vec<NetId> {
    // Definitions that are constants, symbols or numbers need no name: they join the coefficients.
    let mut trivial = Substitution::default();
    let mut depths: BTreeMap<ExprId, usize> = BTreeMap::new();
    let mut levels: Vec<Vec<(Option<ExprId>, ExprId)>> = Vec::new();
    let mut plain: Vec<(ExprId, ExprId)> = Vec::new();
    let named = formulation.definitions.iter().map(|(symbol, e)| (Some(*symbol), *e));
    let mut places: Vec<(usize, usize)> = Vec::new();
    for (symbol, e) in named.chain(formulation.outputs.iter().map(|e| (None, *e))) {
        let e = if plain.is_empty() { e } else { trivial.of(graph, e) };
        if let Some(symbol) = symbol
            && (graph.roles(e).is_constant() || graph.as_symbol(e).is_some())
        {
            plain.push((symbol, e));
            trivial = Substitution::new(plain.iter().copied());
            continue;
        }
        let depth = if depths.is_empty() {
            0
        } else {
            let below = graph.symbols_in(&[e]);
            below
                .into_iter()
                .filter_map(|s| depths.get(&graph.symbol_expr(s)).map(|d| d + 1))
                .max()
                .unwrap_or(0)
        };
        if levels.len() <= depth {
            levels.resize(depth + 1, Vec::new());
        }
        match symbol {
            Some(symbol) => {
                depths.insert(symbol, depth);
            }
            None => places.push((depth, levels[depth].len())),
        }
        levels[depth].push((symbol, e));
    }
    let mut link = Changes::default();
    let mut done: Vec<Vec<NetId>> = Vec::new();
    // A level may be small where the whole is large: the time that can be spent is that of the whole.
    let all: usize = levels.iter().map(Vec::len).sum();
    for level in levels {
        let expressions: Vec<ExprId> = level.iter().map(|(_, e)| *e).collect();
        let roots = Conversion::roots(graph, net, Field::Constants, &expressions);
        let most = if all > NAMES_WITH_CANDIDATES { 2 } else { CANDIDATES.len() };
        let best = cheapest(graph, net, roots, effort, most);
        for ((symbol, _), root) in level.iter().zip(&best) {
            if let Some(symbol) = symbol {
                let atom = net.intern(NetNode::Atom(*symbol));
                link.insert(atom, NetNode::Product(vec![(*root, 1)]));
            }
        }
        done.push(best);
    }
    let roots: Vec<NetId> = places.into_iter().map(|(depth, index)| done[depth][index]).collect();
    let roots = if depths.is_empty() { roots } else { rebuild(graph, net, &roots, &link) };
    // Signs may move across the depths; they never add an operation.
    if effort == Effort::Regular {
        return roots;
    }
    apply(Pass::Signs, graph, net, &roots)
}

/// The roots optimised once more as a whole, if that is cheaper: what different depths have in common was not seen at any of them. What
/// is optimised as a whole from the start is sometimes cheaper still.
fn joined(
    graph: &mut Graph,
    net: &mut Net,
    (roots, formulation): (Vec<NetId>, &Formulation),
    effort: Effort,
) -> Vec<NetId> {
    let nodes = net.reachable(&roots).0.len();
    if effort != Effort::Hot || affordable(nodes) == 0 {
        return roots;
    }
    let mut starts = vec![roots.clone()];
    // In a long family the regular code is taken nearly always.
    if !formulation.definitions.is_empty() && !graph.nests_sums() {
        starts.push(staged(graph, net, formulation, Effort::Regular));
    }
    let mut found = vec![roots];
    for start in starts {
        let mut whole = start;
        for _ in 0..MOST_JOINED {
            let before = whole.clone();
            for pass in JOINED {
                whole = apply(pass, graph, net, &whole);
            }
            if whole == before {
                break;
            }
            found.push(whole.clone());
        }
    }
    let programs: Vec<Candidate> = found.iter().map(|roots| Candidate::new(graph, net, roots)).collect();
    found.swap_remove(accuracy::best(graph, &programs))
}

/// The roots as the cheapest sequence of passes leaves them.
fn cheapest(graph: &mut Graph, net: &mut Net, roots: Vec<NetId>, effort: Effort, most: usize) -> Vec<NetId> {
    let nodes = net.reachable(&roots).0.len();
    let tried = match effort {
        Effort::Hot | Effort::Brief => affordable(nodes),
        // Small functions have little to share beyond equal nodes, which are one already.
        Effort::Regular => 0,
        Effort::Cold if nodes < COLD_NODES => 0,
        Effort::Cold => affordable(nodes).min(1),
    };
    let tried = if effort == Effort::Brief { tried.min(1) } else { tried.min(most) };
    if tried == 0 {
        return roots;
    }
    let mut rewritten = vec![roots];
    for passes in &CANDIDATES[..tried] {
        let mut candidate = rewritten[0].clone();
        for pass in *passes {
            candidate = apply(*pass, graph, net, &candidate);
        }
        rewritten.push(candidate);
    }
    let programs: Vec<Candidate> = rewritten.iter().map(|roots| Candidate::new(graph, net, roots)).collect();
    rewritten.swap_remove(accuracy::best(graph, &programs))
}
