//! Outputs on the constraints, with what they ask of the motion.

use crate::algebra::{ExprId, Flow, Function, Node, Role, Roles, Substitution};
use crate::motion::formulations::Formulated;
use crate::motion::formulations::multibody::measured::{self, Along};
use crate::motion::quasi_velocities::velocity_forms::VelocityPartials;
use crate::motion::results::agreement::agree;
use crate::motion::{Frame, Mechanics, MotionSymbol};
use crate::program::weighted_cost;
use crate::workbench::Workbench;

/// The outputs as functions of the state. Where they ask for accelerations there are two ways: derivatives along coordinates into which
/// `x''` is put, and recursions over axes and points; what promises less is taken.
pub(in crate::motion) fn outputs(
    bench: &mut Workbench,
    system: &Mechanics,
    frame: &mut Frame,
    partials: &mut VelocityPartials,
    formulations: &[Formulated],
    reactions: &[Option<ExprId>],
) -> Vec<ExprId> {
    let (n, l) = (system.forms.len(), system.forms.degrees);
    let constrained: Vec<ExprId> =
        system.outputs.iter().map(|e| frame.constrain.of(&mut bench.graph, *e)).collect();
    let accelerated = Roles::of(Role::QuasiAcceleration);
    if !constrained.iter().any(|e| bench.graph.roles(*e).meets(accelerated)) {
        return constrained;
    }
    let (constrained, functions) = without_functions(bench, constrained);
    let rates = cheapest(bench, formulations, n + l);
    let accelerations = &rates[n..];
    let solved: Vec<(ExprId, ExprId)> =
        system.accelerations.iter().copied().zip(accelerations.iter().copied()).collect();
    let mut by_motion = Substitution::new(solved.iter().copied());
    // d/dt along the motion: t at one, x at x', eta at eta'.
    let velocities = system.forms.coordinates.iter().copied().zip(frame.velocities.iter().copied());
    let etas = system.etas[..l].iter().copied().zip(accelerations.iter().copied());
    let time = (system.forms.time, bench.graph.one());
    let mut flow = Flow::new(&bench.graph, velocities.chain(etas).chain([time]));
    let zero = bench.graph.zero();
    let (mut images, mut second, mut others) = (Vec::new(), Vec::new(), Vec::new());
    for (symbol, meaning) in &system.motion_symbols {
        let image = match meaning {
            MotionSymbol::CoordinateAcceleration(i) => {
                second.push((*symbol, *i));
                flow.of(&mut bench.graph, frame.velocities[*i])
            }
            MotionSymbol::ConstraintRate => {
                others.push((*symbol, zero));
                zero
            }
            // Whoever asks for a reaction that is not known has been told.
            MotionSymbol::Reaction(j) => {
                let reaction = reactions[*j - l].unwrap_or(zero);
                others.push((*symbol, reaction));
                by_motion.of(&mut bench.graph, reaction)
            }
        };
        images.push((*symbol, bench.keep_large(image)));
    }
    let mut by_motion = Substitution::new(solved.into_iter().chain(images));
    let written: Vec<ExprId> = constrained.iter().map(|e| by_motion.of(&mut bench.graph, *e)).collect();
    let along = Along { rates, images: &others, second: &second };
    let taken = match measured::outputs(bench, system, partials, &along, &constrained) {
        Some(found) if promises_less(bench, &found, &written) && agree(bench, &found, &written) => found,
        _ => written,
    };
    with_functions(bench, taken, functions)
}

/// A function of what moves: a symbol that stands for it, and the function with as many arguments.
struct Cut {
    symbol: ExprId,
    function: Node,
    arguments: usize,
}

/// Expressions with symbols for functions of velocities and accelerations, and behind them the arguments of these: equal functions have
/// equal values only where their arguments are written in the same way.
fn without_functions(bench: &mut Workbench, mut es: Vec<ExprId>) -> (Vec<ExprId>, Vec<Cut>) {
    const MOVING: Roles = Roles::of(Role::QuasiAcceleration).or(Roles::of(Role::Velocity));
    let mut without = Substitution::default();
    let (mut cuts, mut arguments) = (Vec::new(), Vec::new());
    for id in bench.graph.reachable(&es, |_| false) {
        let function = bench.graph.node(id).clone();
        let is_root = matches!(function, Node::Function(Function::Root(_), _));
        let is_function = matches!(function, Node::Function(..) | Node::Multivariate(..)) && !is_root;
        if !is_function || !bench.graph.roles(id).meets(MOVING) {
            continue;
        }
        let children = bench.graph.children(id);
        arguments.extend(children.iter().map(|child| without.of(&mut bench.graph, *child)));
        let symbol = bench.graph.symbol(&format!("function {} of the motion", cuts.len()), Role::Input);
        without.add(id, symbol);
        cuts.push(Cut { symbol, function, arguments: children.len() });
    }
    es.iter_mut().for_each(|e| *e = without.of(&mut bench.graph, *e));
    es.extend(arguments);
    (es, cuts)
}

/// Puts the functions back.
fn with_functions(bench: &mut Workbench, mut es: Vec<ExprId>, cuts: Vec<Cut>) -> Vec<ExprId> {
    let count: usize = cuts.iter().map(|cut| cut.arguments).sum();
    let mut arguments = es.split_off(es.len() - count).into_iter();
    let mut back = Substitution::default();
    for Cut { symbol, function, arguments: count } in cuts {
        let own: Vec<ExprId> = arguments.by_ref().take(count).map(|e| back.of(&mut bench.graph, e)).collect();
        let image = match function {
            Node::Function(function, _) => bench.graph.function(function, own[0]),
            Node::Multivariate(function, _) => bench.graph.multivariate(function, &own),
            _ => symbol,
        };
        back.add(symbol, image);
    }
    es.into_iter().map(|e| back.of(&mut bench.graph, e)).collect()
}

/// The rates that promise least; those by the spins of bodies where there are some, which lose no digits next to an edge.
fn cheapest<'a>(bench: &Workbench, formulations: &'a [Formulated], count: usize) -> &'a [ExprId] {
    let is_wanted = formulations.iter().any(|formulated| formulated.is_by_spins);
    let wanted = formulations.iter().filter(|formulated| formulated.is_by_spins || !is_wanted);
    let least = wanted.min_by_key(|formulated| weighted_cost(&bench.graph, &formulated.rates[..count]));
    &least.expect("there is a formulation").rates[..count]
}

fn promises_less(bench: &Workbench, own: &[ExprId], other: &[ExprId]) -> bool {
    weighted_cost(&bench.graph, own) < weighted_cost(&bench.graph, other)
}
