//! The forms of the kinetic energy as differences from each other: a spanning tree in which these are short.

use crate::algebra::{ExprId, Rational};
use crate::motion::definition::projection::Squares;
use crate::motion::mass_matrix::sparse::Vector;
use crate::motion::thresholds::MOST_FORMS;
use crate::workbench::Workbench;

/// The forms of the kinetic energy as differences, `S u = B eta + ..`, with what the equations of their squares have beside.
pub(in crate::motion) struct Differences {
    /// `m_k`.
    pub(in crate::motion) masses: Vec<ExprId>,
    /// The form that each form is taken relative to; none is rest.
    pub(in crate::motion) edges: Vec<Option<Edge>>,
    /// The rows of `B`.
    pub(in crate::motion) rows: Vec<Vector>,
    /// The components of the differences along `X_0`.
    pub(in crate::motion) drifts: Vec<ExprId>,
    /// `g_s`, as in [`Squares`].
    pub(in crate::motion) rest: Vec<ExprId>,
}

/// A form less a multiple of another one.
#[derive(Clone)]
pub(in crate::motion) struct Edge {
    pub(in crate::motion) parent: usize,
    /// The multiple, a number: forms are given up to a factor.
    pub(in crate::motion) multiple: Rational,
}

impl Differences {
    /// The forms of squares relative to each other; `None` where they are too many for the parameters, or nothing is gained.
    pub(super) fn of_squares(bench: &mut Workbench, squares: &Squares) -> Option<Self> {
        // Each constraint force costs as much as a parameter at least.
        let is_moving = |row: &&Vec<ExprId>| row.iter().any(|e| !bench.graph.is_zero(*e));
        if squares.components.iter().filter(is_moving).count() > MOST_FORMS * squares.rest.len() {
            return None;
        }
        let differences = Differences {
            masses: squares.masses.clone(),
            edges: vec![None; squares.masses.len()],
            rows: squares.components.iter().map(|row| Vector::of_list(&bench.graph, row)).collect(),
            drifts: squares.drifts.clone(),
            rest: squares.rest.clone(),
        };
        differences.joined(bench)
    }

    /// Takes forms that were relative to rest relative to each other; `None` where nothing is gained.
    pub(in crate::motion) fn joined(self, bench: &mut Workbench) -> Option<Self> {
        let mut forms = self.moving()?;
        let roots: Vec<usize> = (0..forms.rows.len()).filter(|k| forms.edges[*k].is_none()).collect();
        let components: Vec<Vector> = roots.iter().map(|k| forms.rows[*k].clone()).collect();
        let drifts: Vec<ExprId> = roots.iter().map(|k| forms.drifts[*k]).collect();
        for (own, edge) in spanning(bench, &components).into_iter().enumerate() {
            let Some(Edge { parent, multiple }) = edge else { continue };
            let k = roots[own];
            forms.rows[k] = difference(bench, [&components[own], &components[parent]], &multiple);
            let part = bench.graph.scale(drifts[parent], &multiple);
            forms.drifts[k] = bench.graph.sub(drifts[own], part);
            forms.edges[k] = Some(Edge { parent: roots[parent], multiple });
        }
        let components = forms.rows.iter().map(Vector::len).sum::<usize>();
        (components <= densest(forms.rest.len(), forms.rows.len())).then_some(forms)
    }

    /// The forms that parameters move; `None` where one is relative to a form that they do not move, whose speed it would lack.
    fn moving(self) -> Option<Self> {
        let moves = |mut k: usize| loop {
            match &self.edges[k] {
                _ if self.rows[k].len() > 0 => return true,
                Some(edge) => k = edge.parent,
                None => return false,
            }
        };
        let moves: Vec<bool> = (0..self.rows.len()).map(moves).collect();
        let kept: Vec<usize> = (0..self.rows.len()).filter(|k| moves[*k]).collect();
        if kept.iter().any(|k| self.edges[*k].as_ref().is_some_and(|edge| !moves[edge.parent])) {
            return None;
        }
        let mut place = vec![0; self.rows.len()];
        kept.iter().enumerate().for_each(|(new, k)| place[*k] = new);
        let edge = |k: &usize| {
            let Edge { parent, multiple } = self.edges[*k].clone()?;
            Some(Edge { parent: place[parent], multiple })
        };
        Some(Differences {
            masses: kept.iter().map(|k| self.masses[*k]).collect(),
            edges: kept.iter().map(edge).collect(),
            rows: kept.iter().map(|k| self.rows[*k].clone()).collect(),
            drifts: kept.iter().map(|k| self.drifts[*k]).collect(),
            rest: self.rest,
        })
    }
}

/// Non-zero components in all differences beyond which nothing is gained.
fn densest(parameters: usize, forms: usize) -> usize {
    parameters * forms / 2 + 2 * forms
}

/// A component, as a number times the rest.
struct Component {
    e: ExprId,
    content: Rational,
    rest: ExprId,
}

/// Returns the form that each form is taken relative to; `None` is rest.
///
/// The tree has the fewest components in all differences together (Prim's algorithm from rest): each particle of a
/// chain moves relative to the one before with the rate of one link.
fn spanning(bench: &mut Workbench, rows: &[Vector]) -> Vec<Option<Edge>> {
    let rows: Vec<Vec<(usize, Component)>> = rows
        .iter()
        .map(|row| {
            let parts = row.entries().iter().map(|(s, e)| {
                let (content, rest) = bench.graph.split_content(*e);
                (*s, Component { e: *e, content, rest })
            });
            parts.collect()
        })
        .collect();
    let mut nearest: Vec<(usize, Option<Edge>)> = rows.iter().map(|row| (row.len(), None)).collect();
    let mut edges = vec![None; rows.len()];
    let mut outside: Vec<usize> = (0..rows.len()).collect();
    while let Some(next) = (0..outside.len()).min_by_key(|place| nearest[outside[*place]].0) {
        let k = outside.remove(next);
        edges[k] = nearest[k].1.take();
        for j in &outside {
            // Forms of different lengths differ by as many components at least.
            if rows[*j].len().abs_diff(rows[k].len()) >= nearest[*j].0 {
                continue;
            }
            let (equal, multiple) = in_common(&rows[*j], &rows[k]);
            let distance = rows[*j].len() + rows[k].len() - equal.0 - equal.1;
            if equal.1 > 0 && distance < nearest[*j].0 {
                nearest[*j] = (distance, Some(Edge { parent: k, multiple }));
            }
        }
    }
    edges
}

/// Returns the number of components that two forms have at the same places, the number of these in one ratio, and
/// this ratio.
fn in_common(own: &[(usize, Component)], other: &[(usize, Component)]) -> ((usize, usize), Rational) {
    let (mut i, mut j, mut both) = (0, 0, 0);
    let mut ratios: Vec<(Rational, usize)> = Vec::new();
    let mut equal = 0;
    while i < own.len() && j < other.len() {
        let ((s, a), (t, b)) = (&own[i], &other[j]);
        i += usize::from(s <= t);
        j += usize::from(t <= s);
        if s != t {
            continue;
        }
        both += 1;
        if a.e == b.e {
            equal += 1;
        } else if a.rest == b.rest
            && let Some(inverse) = b.content.recip()
        {
            let ratio = &a.content * &inverse;
            match ratios.iter_mut().find(|(known, _)| *known == ratio) {
                Some((_, count)) => *count += 1,
                None => ratios.push((ratio, 1)),
            }
        }
    }
    let mut best = (Rational::ONE, equal);
    for (ratio, count) in ratios {
        if count > best.1 {
            best = (ratio, count);
        }
    }
    ((both, best.1), best.0)
}

/// The components of a form relative to a multiple of another one.
fn difference(bench: &mut Workbench, [form, other]: [&Vector; 2], multiple: &Rational) -> Vector {
    let mut found = form.clone();
    for (s, e) in other.entries() {
        let part = bench.graph.scale(*e, multiple);
        let own = form.get(*s).unwrap_or(bench.graph.zero());
        if part == own {
            found.remove(*s);
        } else {
            let difference = bench.graph.sub(own, part);
            let difference = bench.tidy(difference);
            found.set(&bench.graph, *s, difference);
        }
    }
    found
}
