//! Constants without which nothing has inertia.
//!
//! Where the mass matrix is singular at all states once a constant is zero, a system with that value has no equations of
//! motion: everything may be divided by the constant, whatever is declared of its sign, and `prepare` refuses zero. For a
//! chain these are the mass of its last particle and the lengths of its links.

use std::collections::BTreeSet;

use crate::algebra::{ExprId, FastMap, Node, Role, SignBound, SymbolId};
use crate::motion::quasi_velocities::velocity_forms::VelocityPartials;
use crate::motion::thresholds::VALUES_AT_POINTS;
use crate::motion::{Frame, KineticTerm, Mechanics};
use crate::workbench::Workbench;
use crate::zero::{Sample, field};

/// Points at which the mass matrix must be singular.
const SINGULARITY_POINTS: u64 = 2;

/// The terms that the mass matrix is made of.
struct Energy {
    /// Weights, with the places of their forms.
    terms: Vec<(ExprId, [usize; 2])>,
    /// The coefficients of each form, by rates of coordinates and by parameters.
    forms: Vec<[Vec<(usize, ExprId)>; 2]>,
    /// `xi_s^i`, a row for each parameter.
    operators: Vec<Vec<ExprId>>,
}

/// Finds those of these constants of which it was not known, and remembers in the graph that they differ from zero.
pub(in crate::motion) fn find(
    bench: &mut Workbench,
    system: &Mechanics,
    frame: &Frame,
    partials: &mut VelocityPartials,
    terms: &[KineticTerm],
) -> Vec<ExprId> {
    if !has_candidates(bench, system, terms) {
        return Vec::new();
    }
    let Some(energy) = Energy::new(bench, system, frame, partials, terms) else { return Vec::new() };
    let all = energy.expressions();
    let reachable = bench.graph.reachable(&all, |_| false);
    let graph = &bench.graph;
    // A function may have other values at zero than points modulo p know.
    let arguments: Vec<ExprId> = reachable
        .iter()
        .flat_map(|e| match graph.node(*e) {
            Node::Function(..) | Node::Multivariate(..) => graph.children(*e),
            _ => Vec::new(),
        })
        .collect();
    let within = graph.symbols_in(&arguments);
    let is_open = |symbol: &SymbolId| {
        let info = graph.symbol_info(*symbol);
        info.role == Role::Constant
            && matches!(info.bound, SignBound::Free | SignBound::NonNegative | SignBound::NonPositive)
            && !within.contains(symbol)
    };
    let symbols = graph.symbols_in(&all);
    let mut open: Vec<SymbolId> = symbols.iter().copied().filter(is_open).collect();
    open.truncate(VALUES_AT_POINTS / reachable.len().max(1));
    let dependents = dependents(bench, &reachable, &open);
    let mut points: Vec<Option<At>> = Vec::new();
    for (symbol, dependent) in open.into_iter().zip(&dependents) {
        let mut is_singular = true;
        for number in 0..SINGULARITY_POINTS {
            if points.len() as u64 <= number {
                points.push(At::new(bench, &energy, &all, number));
            }
            let at = &points[number as usize];
            is_singular =
                at.as_ref().is_some_and(|at| at.is_singular_without(bench, &energy, &all, symbol, dependent));
            if !is_singular {
                break;
            }
        }
        if is_singular {
            bench.graph.set_indispensable(symbol);
        }
    }
    // Those that a derivation before found are to be looked at too.
    let found = symbols.into_iter().filter(|symbol| bench.graph.is_indispensable(*symbol));
    found.map(|symbol| bench.graph.symbol_expr(symbol)).collect()
}

/// Whether the mass matrix depends on a constant that may be zero, as far as its sign is declared, or on one that was found before.
fn has_candidates(bench: &Workbench, system: &Mechanics, terms: &[KineticTerm]) -> bool {
    let forms = system.forms.forms.iter().flat_map(|form| &form.row);
    let of_terms = terms.iter().flat_map(|term| term.forms.iter().chain([&term.weight]));
    let all: Vec<ExprId> = forms.chain(of_terms).copied().collect();
    let graph = &bench.graph;
    graph.symbols_in(&all).into_iter().any(|symbol| {
        let info = graph.symbol_info(symbol);
        let is_open = matches!(info.bound, SignBound::Free | SignBound::NonNegative | SignBound::NonPositive);
        info.role == Role::Constant && is_open || graph.is_indispensable(symbol)
    })
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

    /// The components of a form along the operators that are not zero, out of the values of all expressions, which begin
    /// with the weights.
    fn components(&self, values: &[u64], form: usize) -> Vec<(usize, u64)> {
        let [velocities, etas] = &self.forms[form];
        let before: usize = self.forms[..form].iter().flatten().map(Vec::len).sum();
        let own = &values[self.terms.len() + before..];
        let width = self.operators.first().map_or(0, Vec::len);
        let operators = &values[values.len() - self.operators.len() * width..];
        let mut found = Vec::new();
        for s in 0..self.operators.len() {
            let mut sum = 0;
            for (place, (i, _)) in velocities.iter().enumerate() {
                let along = operators[s * width + i];
                if along != 0 {
                    sum = field::add(sum, field::mul(own[place], along));
                }
            }
            for (place, (j, _)) in etas.iter().enumerate() {
                if *j == s {
                    sum = field::add(sum, own[velocities.len() + place]);
                }
            }
            if sum != 0 {
                found.push((s, sum));
            }
        }
        found
    }
}

/// Returns for each symbol the nodes that depend on it; every node is listed behind those that it is made of.
fn dependents(bench: &Workbench, nodes: &[ExprId], symbols: &[SymbolId]) -> Vec<Vec<ExprId>> {
    const BITS: usize = u64::BITS as usize;
    let words = symbols.len().div_ceil(BITS);
    let mut found = vec![Vec::new(); symbols.len()];
    let mut sets: FastMap<ExprId, Vec<u64>> = FastMap::default();
    for id in nodes {
        let mut set = vec![0; words];
        if let Some(place) =
            bench.graph.as_symbol(*id).and_then(|symbol| symbols.iter().position(|other| *other == symbol))
        {
            set[place / BITS] |= 1 << (place % BITS);
        }
        bench.graph.visit_children(*id, |child| {
            if let Some(below) = sets.get(&child) {
                for (word, other) in set.iter_mut().zip(below) {
                    *word |= other;
                }
            }
        });
        for (word, bits) in set.iter().enumerate() {
            let mut bits = *bits;
            while bits != 0 {
                found[word * BITS + bits.trailing_zeros() as usize].push(*id);
                bits &= bits - 1;
            }
        }
        sets.insert(*id, set);
    }
    found
}

/// The mass matrix at a point where no constant is zero: of that where one is, only the terms that know of it differ.
struct At {
    sample: Sample,
    values: Vec<u64>,
    components: Vec<Vec<(usize, u64)>>,
    mass: Vec<Vec<u64>>,
    /// The inverse of the mass matrix, if there is one.
    inverse: Option<Vec<Vec<u64>>>,
}

impl At {
    /// `None` where an expression has no value.
    fn new(bench: &mut Workbench, energy: &Energy, all: &[ExprId], number: u64) -> Option<Self> {
        let mut sample = bench.zero.point(&bench.graph, number);
        let values = bench.zero.values_at(&bench.graph, &mut sample, all)?;
        let components: Vec<_> =
            (0..energy.forms.len()).map(|form| energy.components(&values, form)).collect();
        let l = energy.operators.len();
        let mut mass = vec![vec![0; l]; l];
        for (weight, (_, [u, v])) in values.iter().zip(&energy.terms) {
            add_products(&mut mass, *weight, &components[*u], &components[*v]);
        }
        let inverse = field::inverse_of_symmetric(&mass);
        Some(At { sample, values, components, mass, inverse })
    }

    /// Whether the mass matrix is singular where a constant is zero; not where it has no value there.
    fn is_singular_without(
        &self,
        bench: &Workbench,
        energy: &Energy,
        all: &[ExprId],
        symbol: SymbolId,
        dependent: &[ExprId],
    ) -> bool {
        let mut sample = self.sample.without(symbol, dependent);
        let Some(values) = bench.zero.values_at(&bench.graph, &mut sample, all) else { return false };
        let count = energy.terms.len();
        let forms: usize = energy.forms.iter().flatten().map(Vec::len).sum();
        let operators_differ = values[count + forms..] != self.values[count + forms..];
        // The components of a form, where they differ from those at the point.
        let mut changed: Vec<Option<Vec<(usize, u64)>>> = Vec::new();
        let mut at = count;
        for (form, [velocities, etas]) in energy.forms.iter().enumerate() {
            let end = at + velocities.len() + etas.len();
            let differs = operators_differ || values[at..end] != self.values[at..end];
            changed.push(differs.then(|| energy.components(&values, form)));
            at = end;
        }
        let mut mass = self.mass.clone();
        let mut touched: BTreeSet<usize> = BTreeSet::new();
        let mut add = |weight: u64, first: &[(usize, u64)], second: &[(usize, u64)]| {
            add_products(&mut mass, weight, first, second);
            touched.extend(first.iter().chain(second).map(|(s, _)| *s));
        };
        for (term, (_, [u, v])) in energy.terms.iter().enumerate() {
            let (old, new) = (self.values[term], values[term]);
            if old == new && changed[*u].is_none() && changed[*v].is_none() {
                continue;
            }
            let [first, second] = [u, v].map(|form| &self.components[*form]);
            add(field::neg(old), first, second);
            let [first, second] =
                [u, v].map(|form| changed[*form].as_ref().unwrap_or(&self.components[*form]));
            add(new, first, second);
        }
        self.is_singular_with(&mass, &touched.into_iter().collect::<Vec<_>>())
    }

    /// Whether a mass matrix is singular. It differs from the one at the point, `M`, in the rows and columns of the `touched` parameters only. With the
    /// difference `D`, `det(M + D) = det(M) det(1 + D M^-1)`; the second determinant takes the touched rows and columns alone.
    fn is_singular_with(&self, mass: &[Vec<u64>], touched: &[usize]) -> bool {
        let Some(inverse) = &self.inverse else { return field::rank(mass) < mass.len() };
        let differences = touched.iter().map(|s| {
            touched.iter().map(|t| field::sub(mass[*s][*t], self.mass[*s][*t])).collect::<Vec<u64>>()
        });
        let own = differences.enumerate().map(|(place, difference)| {
            let entry = |(other, t): (usize, &usize)| {
                let unit = u64::from(place == other);
                let products = difference.iter().zip(touched).map(|(d, s)| field::mul(*d, inverse[*s][*t]));
                products.fold(unit, field::add)
            };
            touched.iter().enumerate().map(entry).collect::<Vec<u64>>()
        });
        let own: Vec<Vec<u64>> = own.collect();
        field::rank(&own) < own.len()
    }
}

/// Adds `w (u v^T + v u^T)`.
fn add_products(mass: &mut [Vec<u64>], w: u64, u: &[(usize, u64)], v: &[(usize, u64)]) {
    if w == 0 {
        return;
    }
    for (s, a) in u {
        let scaled = field::mul(w, *a);
        for (t, b) in v {
            let product = field::mul(scaled, *b);
            mass[*s][*t] = field::add(mass[*s][*t], product);
            mass[*t][*s] = field::add(mass[*t][*s], product);
        }
    }
}
