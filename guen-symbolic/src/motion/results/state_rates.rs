//! The rates of the states beside the motion, by the velocities and accelerations of each formulation.

use crate::algebra::{ExprId, Flow, Substitution};
use crate::motion::formulations::Formulated;
use crate::motion::{Frame, Mechanics, MotionSymbol};
use crate::workbench::Workbench;

/// Appends the rates of the states to the rates of every formulation. A state costs its own expression: velocities and
/// accelerations in it are those that the formulation computes anyway.
pub(in crate::motion) fn append(
    bench: &mut Workbench,
    system: &Mechanics,
    frame: &Frame,
    reactions: &[Option<ExprId>],
    formulations: &mut [Formulated],
) {
    if system.states.is_empty() {
        return;
    }
    let (n, l) = (system.forms.len(), system.forms.degrees);
    let mut rates: Vec<ExprId> = system.states.iter().map(|state| state.rate).collect();
    if !system.motion_symbols.is_empty() {
        let mut asked = Substitution::new(meanings(bench, system, frame, reactions));
        rates.iter_mut().for_each(|rate| *rate = asked.of(&mut bench.graph, *rate));
    }
    let zero = bench.graph.zero();
    for formulated in formulations {
        let (velocities, accelerations) = formulated.rates.split_at(n);
        // A long acceleration is computed once, and not multiplied out a second time.
        let accelerations: Vec<ExprId> = accelerations.iter().map(|e| bench.keep_large(*e)).collect();
        let moving = system.velocities.iter().copied().zip(velocities.iter().copied());
        let accelerated = system.accelerations.iter().copied().zip(accelerations);
        let constrained = system.etas[l..].iter().map(|eta| (*eta, zero));
        let mut on_motion = Substitution::new(moving.chain(accelerated).chain(constrained));
        let own = rates.iter().map(|rate| on_motion.of(&mut bench.graph, *rate));
        let own: Vec<ExprId> = own.collect();
        formulated.rates.extend(own);
    }
}

/// The symbols for what follows from the motion, each with its expression of `eta'`.
fn meanings(
    bench: &mut Workbench,
    system: &Mechanics,
    frame: &Frame,
    reactions: &[Option<ExprId>],
) -> Vec<(ExprId, ExprId)> {
    let l = system.forms.degrees;
    let places = system.forms.coordinates.iter().copied().zip(frame.velocities.iter().copied());
    let speeds = system.etas[..l].iter().copied().zip(system.accelerations.iter().copied());
    let time = (system.forms.time, bench.graph.one());
    let mut along = Flow::new(&bench.graph, places.chain(speeds).chain([time]));
    let meaning = |(symbol, meaning): &(ExprId, MotionSymbol)| {
        let image = match meaning {
            MotionSymbol::CoordinateAcceleration(i) => along.of(&mut bench.graph, frame.velocities[*i]),
            MotionSymbol::ConstraintRate => bench.graph.zero(),
            // Whoever asks for a reaction that is not known has been told.
            MotionSymbol::Reaction(j) => reactions[*j - l].unwrap_or(bench.graph.zero()),
        };
        (*symbol, image)
    };
    system.motion_symbols.iter().map(meaning).collect()
}
