//! Jumps: where a piecewise function makes positions, velocities or energies leap, there is an impact that the equations do not have.

use guen_symbolic::{
    ExprId, Flow, Function, Multivariate, Node, Role, Roles, Substitution, Verdict, Workbench,
};
use proc_macro2::Span;

use super::evaluate::{Evaluated, Evaluator};
use super::expression_place::ExpressionPlace;
use super::value::Value;
use crate::diagnostics::Fault;
use crate::syntax::{Expression, ExpressionKind};

/// The piecewise functions that a message points to.
const PIECEWISE: [&str; 7] = ["select", "sign", "floor", "abs", "min", "max", "clamp"];

impl Evaluator<'_> {
    /// Refuses what jumps in a form, a mass or an energy, and what has a kink in a position. Where nobody can tell it is accepted.
    pub(super) fn check_jumps(
        &mut self,
        place: ExpressionPlace,
        value: &Value,
        e: &Expression,
    ) -> Evaluated<()> {
        let has_slopes = match place {
            ExpressionPlace::Parameter
            | ExpressionPlace::Constraint
            | ExpressionPlace::Slip
            | ExpressionPlace::Grip
            | ExpressionPlace::KineticEnergy
            | ExpressionPlace::Mass
            | ExpressionPlace::ForceFunction => false,
            ExpressionPlace::Position
            | ExpressionPlace::Holonomic
            | ExpressionPlace::Gap
            | ExpressionPlace::Latch => true,
            _ => return Ok(()),
        };
        if !self.bench.graph.has_branches() {
            return Ok(());
        }
        for part in value.expressions() {
            let leaps = jump(&mut self.bench, part).map(|switch| ("jumps", switch));
            let kink = |bench: &mut Workbench| {
                let positions = Roles::of(Role::Coordinate).or(Roles::of(Role::Time));
                let symbols = bench.graph.symbols_in(&[part]);
                symbols.into_iter().find_map(|symbol| {
                    let x = bench.graph.symbol_expr(symbol);
                    if !bench.graph.roles(x).meets(positions) {
                        return None;
                    }
                    let slope = Flow::partial(&bench.graph, x).of(&mut bench.graph, part);
                    jump(bench, slope).map(|switch| ("has a kink", switch))
                })
            };
            let found = leaps.or_else(|| if has_slopes { kink(&mut self.bench) } else { None });
            let Some((what, switch)) = found else { continue };
            let place_of_switch = self.zero_in_words(switch);
            let description = place.description(self.entry.as_deref());
            let text = format!("{description} {what}{place_of_switch}");
            let fault = Fault::new(culprit(e).unwrap_or(e.extent()), text);
            return self.fail(match place {
                ExpressionPlace::ForceFunction => fault
                    .note("an energy that jumps is a force without bounds, which no step can follow")
                    .help("let both branches agree there, or write what jumps under `forces`"),
                _ => fault
                    .note("velocities or momenta would jump there, as in an impact, and the equations of motion have none")
                    .help(match has_slopes {
                        true => "let both branches and their slopes agree there",
                        false => "let both branches agree there",
                    }),
            });
        }
        Ok(())
    }

    /// ` where x = 0`, of a function and its opposite the one that reads better.
    fn zero_in_words(&mut self, switch: Switch) -> String {
        let graph = &mut self.bench.graph;
        match switch {
            Switch::Whole(x) => graph
                .text_limited(x, FUNCTION_CHARACTERS)
                .map_or(String::new(), |text| format!(" where `{text}` is a whole number")),
            Switch::Zero(e) => {
                let opposite = graph.neg(e);
                let texts = [e, opposite].map(|e| graph.text_limited(e, FUNCTION_CHARACTERS));
                let found = texts.into_iter().flatten().min_by_key(|text| text.starts_with('-'));
                found.map_or(String::new(), |text| format!(" where `{text} = 0`"))
            }
        }
    }
}

/// The most characters of a function in a message.
const FUNCTION_CHARACTERS: usize = 60;

/// The places where a piecewise function changes its branch.
#[derive(Clone, Copy)]
enum Switch {
    /// The zeros of an expression.
    Zero(ExprId),
    /// The places where it is a whole number.
    Whole(ExprId),
}

/// The first piecewise function inside an expression.
fn culprit(e: &Expression) -> Option<Span> {
    match &e.kind {
        ExpressionKind::Call { function: name, .. } | ExpressionKind::Method { name, .. }
            if PIECEWISE.contains(&name.text.as_str()) =>
        {
            Some(name.span())
        }
        _ => e.children().into_iter().find_map(culprit),
    }
}

/// The places where an expression is proved to jump. Only those that are linear in some variable are looked at: there the
/// variable is replaced by the zero.
fn jump(bench: &mut Workbench, e: ExprId) -> Option<Switch> {
    let nodes = bench.graph.reachable(&[e], |_| false);
    for id in nodes {
        let graph = &mut bench.graph;
        let (one, minus) = (graph.one(), graph.number(-1));
        let (told, switch, sides) = match graph.node(id).clone() {
            Node::Function(Function::Sign, x) => (Switch::Zero(x), x, [one, minus]),
            // Just above a whole number, and just below.
            Node::Function(Function::Floor, x) => {
                let whole = graph.symbol("a whole number", Role::Constant);
                (Switch::Whole(x), graph.sub(x, whole), [whole, graph.add(whole, minus)])
            }
            Node::Multivariate(Multivariate::Select, arguments) => {
                (Switch::Zero(arguments[0]), arguments[0], [arguments[1], arguments[2]])
            }
            _ => continue,
        };
        let on_sides = sides.map(|side| Substitution::new([(id, side)]).of(&mut bench.graph, e));
        let leap = bench.graph.sub(on_sides[0], on_sides[1]);
        let Some((x, zero)) = linear_zero(bench, switch) else { continue };
        let leap = Substitution::new([(x, zero)]).of(&mut bench.graph, leap);
        if bench.zero.verdict(&mut bench.graph, leap) == Verdict::Nonzero {
            return Some(told);
        }
    }
    None
}

/// A variable in which an expression is linear, and the value of the variable for which it vanishes.
fn linear_zero(bench: &mut Workbench, e: ExprId) -> Option<(ExprId, ExprId)> {
    let moving = Roles::of(Role::Coordinate).or(Roles::of(Role::Time));
    for symbol in bench.graph.symbols_in(&[e]) {
        let x = bench.graph.symbol_expr(symbol);
        if !bench.graph.roles(x).meets(moving) {
            continue;
        }
        let graph = &mut bench.graph;
        let slope = Flow::partial(graph, x).of(graph, e);
        let (zero, depends) = (graph.zero(), graph.symbols_in(&[slope]).contains(&symbol));
        if depends || graph.is_zero(slope) {
            continue;
        }
        let rest = Substitution::new([(x, zero)]).of(graph, e);
        let quotient = graph.div(rest, slope);
        return Some((x, graph.neg(quotient)));
    }
    None
}
