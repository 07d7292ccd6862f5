//! Friction in a system that is another one in a mode in which contacts slip: its loads are reactions of the same motion.
//!
//! The force along a slip in the direction `d` is `-mu N d`, and the load `N` the reaction of the gap. Rates and reactions are affine in
//! the loads, so that these solve `N = b + A N`: the equations with loads as inputs tell `b` and `A`. Elimination divides by pivots that
//! are positive where each load has one value whatever the motion is; the first is `1 - A_11 = (D_nn - mu D_nt d)/D_nn`.

use guen_symbolic::{Derivation, ExprId, Function, Substitution, Workbench};

use super::affine;
use crate::derive::faults;
use crate::diagnostics::{Fault, Faults};
use crate::model::{Divisor, Model};

/// Puts the loads in place of their symbols; `None` after a fault.
pub(in crate::derive) fn solve_loads(model: &mut Model<'_>, faults: &mut Faults) -> Option<()> {
    if model.loads.is_empty() {
        return Some(());
    }
    // One that is a magnitude is known once all others are.
    model.loads.sort_by_key(|load| load.is_magnitude);
    if let [.., first, second] = &model.loads[..]
        && first.is_magnitude
    {
        let text = format!("`{}` and `{}` slip under the reactions of constraints", first.name, second.name);
        let fault = Fault::new(second.name.span(), text);
        faults.report(fault.note("the magnitudes of two reactions are not solved for in one mode"));
        return None;
    }
    let symbols: Vec<ExprId> = model.loads.iter().map(|load| load.symbol).collect();
    let mut mechanics = model.mechanics.clone();
    mechanics.inputs.extend(&symbols);
    mechanics.outputs = model.loads.iter().map(|load| load.reaction).collect();
    mechanics.states.clear();
    let derivation = match Derivation::new(&mut model.bench, mechanics) {
        Ok(derivation) => derivation,
        Err(error) => {
            faults::report(model, error, faults);
            return None;
        }
    };
    let before = faults.count();
    faults::report_unknown_reactions(model, &derivation, faults);
    if faults.count() > before {
        return None;
    }
    let values = affine(&mut model.bench, &symbols, &derivation.outputs);
    let (mut free, mut slopes) = (Vec::new(), Vec::new());
    for row in values.chunks(1 + symbols.len()) {
        free.push(row[0]);
        slopes.push(row[1..].to_vec());
    }
    let (pivots, divisors) = eliminate(model, &mut free, &mut slopes);
    for (divisor, load) in divisors.into_iter().zip(&model.loads) {
        let origin =
            format!("the reaction that loads the friction of {} has no value, or several", load.name);
        model.divisors.push(Divisor { output: model.mechanics.outputs.len(), origin });
        model.mechanics.outputs.push(divisor);
    }
    let found = substitute_back(&mut model.bench, &free, &slopes, &pivots);
    let mut loads = Substitution::new(symbols.iter().copied().zip(found));
    for force in &mut model.mechanics.forces {
        force.magnitude = loads.of(&mut model.bench.graph, force.magnitude);
    }
    // In outputs they stay what is asked of the motion; rates of states depend on no force of a contact.
    let graph = &mut model.bench.graph;
    let asked = model.loads.iter().map(|load| {
        let value =
            if load.is_magnitude { graph.function(Function::Abs, load.reaction) } else { load.reaction };
        (load.symbol, value)
    });
    let mut asked = Substitution::new(asked.collect::<Vec<_>>());
    for e in &mut model.mechanics.outputs {
        *e = asked.of(&mut model.bench.graph, *e);
    }
    Some(())
}

/// Brings `N = free + slopes N` to the form in which each load depends on those behind it. Returns the pivots, and functions of the
/// state that vanish where these are not positive. A magnitude stands last, where `N = |free + slope N|` has the one solution
/// `|free|/(1 - sign(free) slope)` while the slope lies between minus one and one.
fn eliminate(
    model: &mut Model<'_>,
    free: &mut [ExprId],
    slopes: &mut [Vec<ExprId>],
) -> (Vec<ExprId>, Vec<ExprId>) {
    let bench = &mut model.bench;
    let (zero, one) = (bench.graph.zero(), bench.graph.one());
    let (mut pivots, mut divisors) = (Vec::new(), Vec::new());
    for (k, load) in model.loads.iter().enumerate() {
        let mut slope = slopes[k][k];
        let mut divisor = bench.graph.sub(one, slope);
        if load.is_magnitude {
            let other = bench.graph.add(one, slope);
            divisor = bench.graph.mul(divisor, other);
            let sign = bench.graph.function(Function::Sign, free[k]);
            slope = bench.graph.mul(sign, slope);
            free[k] = bench.graph.function(Function::Abs, free[k]);
        }
        let pivot = bench.graph.sub(one, slope);
        let pivot = bench.tidy(pivot);
        pivots.push(bench.keep_large(pivot));
        let divisor = bench.tidy(divisor);
        // Below zero a load has no value or several, as where it vanishes.
        let is_safe = bench.graph.manifestly_positive(divisor);
        divisors.push(if is_safe { divisor } else { bench.graph.maximum(divisor, zero) });
        for i in k + 1..free.len() {
            let factor = bench.graph.div(slopes[i][k], pivots[k]);
            let plus = |bench: &mut Workbench, to: ExprId, from: ExprId| {
                let term = bench.graph.mul(factor, from);
                let sum = bench.graph.add(to, term);
                let sum = bench.tidy(sum);
                bench.keep_large(sum)
            };
            free[i] = plus(bench, free[i], free[k]);
            let (above, below) = slopes.split_at_mut(i);
            for (slope, pivot_row) in below[0].iter_mut().zip(&above[k]).skip(k + 1) {
                *slope = plus(bench, *slope, *pivot_row);
            }
        }
    }
    (pivots, divisors)
}

/// The loads, the last one first found.
fn substitute_back(
    bench: &mut Workbench,
    free: &[ExprId],
    slopes: &[Vec<ExprId>],
    pivots: &[ExprId],
) -> Vec<ExprId> {
    let mut found: Vec<ExprId> = free.to_vec();
    for k in (0..free.len()).rev() {
        let others = bench.dot(&slopes[k][k + 1..], &found[k + 1..]);
        let sum = bench.graph.add(free[k], others);
        let load = bench.graph.div(sum, pivots[k]);
        let load = bench.tidy(load);
        found[k] = bench.keep_large(load);
    }
    found
}

/// The functions that must not vanish, so that loads and directions of slips are there: each with its reason.
pub(in crate::derive) fn divisors<'m>(
    model: &'m Model<'_>,
    derivation: &'m Derivation,
) -> impl Iterator<Item = (ExprId, &'m str)> {
    model.divisors.iter().map(|divisor| (derivation.outputs[divisor.output], divisor.origin.as_str()))
}
