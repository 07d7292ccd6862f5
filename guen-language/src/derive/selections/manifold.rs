//! Uses holonomic equations for a scene: unit quaternions stay whole, and coordinates that a scene does not need are
//! replaced by what the equations say of them.

use guen_symbolic::{ExprId, Flow, Mechanics, Role, Substitution, Verdict, Workbench};

use super::fixed::Holding;
use super::selection::StateIndex;

/// The coordinates in an equation, by index.
fn coordinates(bench: &Workbench, system: &Mechanics, equation: ExprId) -> Vec<usize> {
    let graph = &bench.graph;
    let symbols = graph.symbols_in(&[equation]);
    let coordinates =
        symbols.into_iter().filter(|symbol| graph.symbol_info(*symbol).role == Role::Coordinate);
    coordinates
        .filter_map(|symbol| system.forms.coordinates.iter().position(|x| *x == graph.symbol_expr(symbol)))
        .collect()
}

/// The coordinates `x` of an equation that says `sum x^2 = 1`.
fn unit(bench: &mut Workbench, system: &Mechanics, equation: ExprId) -> Option<Vec<usize>> {
    let found = coordinates(bench, system, equation);
    let zero = bench.graph.zero();
    let symbols: Vec<ExprId> = found.iter().map(|i| system.forms.coordinates[*i]).collect();
    let at_origin = Substitution::new(symbols.iter().map(|x| (*x, zero))).of(&mut bench.graph, equation);
    if found.len() < 2 || bench.graph.as_number(at_origin).is_none_or(|value| value.is_zero()) {
        return None;
    }
    let squares: Vec<ExprId> = symbols.iter().map(|x| bench.graph.powi(*x, 2)).collect();
    let sum = bench.graph.sum(squares);
    let scaled = bench.graph.mul(at_origin, sum);
    let rest = bench.graph.sub(at_origin, scaled);
    let difference = bench.graph.sub(equation, rest);
    bench.vanishes(difference).then_some(found)
}

/// Unit quaternions: groups of four coordinates that a scene keeps together or not at all.
pub(in crate::derive) fn quaternions(bench: &mut Workbench, system: &Mechanics) -> Vec<Vec<StateIndex>> {
    let equations: Vec<ExprId> = system.holonomic.iter().map(|h| h.equation).collect();
    equations.into_iter().filter_map(|e| unit(bench, system, e)).filter(|group| group.len() == 4).collect()
}

/// Coordinates in place of which something else can be put, because of one holonomic equation.
pub(in crate::derive) struct Replacement {
    /// The coordinates.
    pub(in crate::derive) coordinates: Vec<usize>,
    substitution: Substitution,
    /// Whether the result must be compared with what was there.
    pub(in crate::derive) is_trial: bool,
}

impl Replacement {
    /// Returns the replacements that the equations offer, in their order: a coordinate that enters linearly with a
    /// number before it is solved for, and a point of a unit sphere stands for all of them where nothing depends on
    /// which one it is. Variables that are held are constants in the equations, too.
    pub(in crate::derive) fn all(
        bench: &mut Workbench,
        system: &Mechanics,
        holding: &mut Holding,
    ) -> Vec<Replacement> {
        let mut found = Vec::new();
        for holonomic in &system.holonomic {
            let equation = holding.of(bench, holonomic.equation);
            if let Some(coordinates) = unit(bench, system, equation) {
                let values = coordinates.iter().enumerate().map(|(k, i)| {
                    let value = if k == 0 { bench.graph.one() } else { bench.graph.zero() };
                    (system.forms.coordinates[*i], value)
                });
                let substitution = Substitution::new(values);
                found.push(Replacement { coordinates, substitution, is_trial: true });
                continue;
            }
            for i in coordinates(bench, system, equation) {
                let x = system.forms.coordinates[i];
                let slope = Flow::partial(&bench.graph, x).of(&mut bench.graph, equation);
                let slope = bench.tidy(slope);
                if bench.graph.as_number(slope).is_none_or(|value| value.is_zero()) {
                    continue;
                }
                let zero = bench.graph.zero();
                let rest = Substitution::new([(x, zero)]).of(&mut bench.graph, equation);
                let quotient = bench.graph.div(rest, slope);
                let value = bench.graph.neg(quotient);
                let substitution = Substitution::new([(x, value)]);
                found.push(Replacement { coordinates: vec![i], substitution, is_trial: false });
            }
        }
        found
    }

    /// The expression with the replacement made, where it is then the same on the holonomic constraints.
    pub(in crate::derive) fn of(&mut self, bench: &mut Workbench, e: ExprId) -> ExprId {
        let image = self.substitution.of(&mut bench.graph, e);
        if !self.is_trial || image == e {
            return image;
        }
        let difference = bench.graph.sub(e, image);
        if bench.verdict_on_manifold(difference) == Verdict::Zero { image } else { e }
    }
}
