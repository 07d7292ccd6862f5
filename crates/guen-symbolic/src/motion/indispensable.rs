//! Constants without which nothing has inertia.
//!
//! Where the mass matrix is singular at all states once a constant is zero, a system with that value has no equations of
//! motion: everything may be divided by the constant, whatever is declared of its sign, and `prepare` refuses zero. For a
//! chain these are the mass of its last particle and the lengths of its links.

use super::velocity_forms::VelocityPartials;
use super::{Frame, KineticTerm, Mechanics};
use crate::algebra::{Bound, ExprId, Node, Role, SymbolId};
use crate::workbench::Workbench;
use crate::zero::field;

/// Values at points beyond which no constant is tried: each takes one of every expression of the energy.
const MOST_VALUES: usize = 400_000;

/// Points at which the mass matrix must be singular.
const POINTS: u64 = 2;

/// What the mass matrix is made of.
struct Energy {
    /// Weights, with the places of their forms.
    terms: Vec<(ExprId, [usize; 2])>,
    /// For each form its coefficients by rates of coordinates and by parameters.
    forms: Vec<[Vec<(usize, ExprId)>; 2]>,
    /// `xi_s^i`, a row for each parameter.
    operators: Vec<Vec<ExprId>>,
}

/// Finds those of these constants of which it was not known, and remembers in the graph that they differ from zero.
pub(super) fn find(
    bench: &mut Workbench,
    system: &Mechanics,
    frame: &Frame,
    partials: &mut VelocityPartials,
    terms: &[KineticTerm],
) -> Vec<ExprId> {
    let Some(energy) = Energy::new(bench, system, frame, partials, terms) else { return Vec::new() };
    let all = energy.expressions();
    let reachable = bench.graph.reachable(&all, |_| false);
    let graph = &bench.graph;
    // A function may have other values at zero than points modulo p know.
    let arguments: Vec<ExprId> = reachable
        .iter()
        .flat_map(|e| match graph.node(*e) {
            Node::Function(_, x) => vec![*x],
            Node::Atan2(y, x) => vec![*y, *x],
            _ => Vec::new(),
        })
        .collect();
    let within = graph.symbols_in(&arguments);
    let is_open = |symbol: &SymbolId| {
        let info = graph.symbol_info(*symbol);
        info.role == Role::Constant
            && matches!(info.bound, Bound::Free | Bound::NonNegative | Bound::NonPositive)
            && !within.contains(symbol)
    };
    let symbols = graph.symbols_in(&all);
    let mut open: Vec<SymbolId> = symbols.iter().copied().filter(is_open).collect();
    open.truncate(MOST_VALUES / reachable.len().max(1));
    for symbol in open {
        if (0..POINTS).all(|point| energy.is_singular_without(bench, symbol, &all, point)) {
            bench.graph.set_indispensable(symbol);
        }
    }
    // Those that a derivation before found are to be looked at too.
    let found = symbols.into_iter().filter(|symbol| bench.graph.is_indispensable(*symbol));
    found.map(|symbol| bench.graph.symbol_expr(symbol)).collect()
}

impl Energy {
    fn new(
        bench: &mut Workbench,
        system: &Mechanics,
        frame: &Frame,
        partials: &mut VelocityPartials,
        terms: &[KineticTerm],
    ) -> Option<Self> {
        let l = system.forms.degrees;
        let operators = frame.operators.xi[1..=l].to_vec();
        let mut energy = Energy { terms: Vec::new(), forms: Vec::new(), operators };
        let mut known: Vec<ExprId> = Vec::new();
        for term in terms {
            let [u, v] = term.forms[..] else { continue };
            let mut places = [0; 2];
            for (place, form) in places.iter_mut().zip([u, v]) {
                *place = match known.iter().position(|other| *other == form) {
                    Some(place) => place,
                    None => {
                        let affine = partials.affine(bench, form)?;
                        energy.forms.push([affine.on_velocities, affine.on_etas]);
                        known.push(form);
                        known.len() - 1
                    }
                };
            }
            energy.terms.push((term.weight, places));
        }
        Some(energy)
    }

    fn expressions(&self) -> Vec<ExprId> {
        let weights = self.terms.iter().map(|(weight, _)| *weight);
        let coefficients = self.forms.iter().flatten().flatten().map(|(_, e)| *e);
        weights.chain(coefficients).chain(self.operators.iter().flatten().copied()).collect()
    }

    /// Whether the mass matrix is singular at a point where a constant is zero; not where it has no value there.
    fn is_singular_without(
        &self,
        bench: &mut Workbench,
        symbol: SymbolId,
        all: &[ExprId],
        point: u64,
    ) -> bool {
        let Some(values) = bench.zero.residues_without(&bench.graph, symbol, all, point) else {
            return false;
        };
        let mut values = values.into_iter();
        let weights: Vec<u64> = values.by_ref().take(self.terms.len()).collect();
        let mut coefficients = Vec::new();
        for [velocities, etas] in &self.forms {
            coefficients.push([velocities, etas].map(|list| -> Vec<(usize, u64)> {
                list.iter().zip(values.by_ref()).map(|((place, _), value)| (*place, value)).collect()
            }));
        }
        let operators: Vec<Vec<u64>> =
            self.operators.iter().map(|row| values.by_ref().take(row.len()).collect()).collect();
        let components: Vec<Vec<u64>> = coefficients
            .iter()
            .map(|[velocities, etas]| {
                let component = |(s, operator): (usize, &Vec<u64>)| {
                    let along = velocities.iter().map(|(i, c)| field::mul(*c, operator[*i]));
                    let own = etas.iter().filter(|(j, _)| *j == s).map(|(_, c)| *c);
                    along.chain(own).fold(0, field::add)
                };
                operators.iter().enumerate().map(component).collect()
            })
            .collect();
        let l = operators.len();
        let mut mass = vec![vec![0; l]; l];
        for (weight, (_, [u, v])) in weights.into_iter().zip(&self.terms) {
            for (s, row) in mass.iter_mut().enumerate() {
                for (a, b) in [(u, v), (v, u)] {
                    let scaled = field::mul(weight, components[*a][s]);
                    for (entry, other) in row.iter_mut().zip(&components[*b]) {
                        *entry = field::add(*entry, field::mul(scaled, *other));
                    }
                }
            }
        }
        field::rank(&mass) < l
    }
}
