//! Families of constraints and parameters: exact, integrable but not exact, integrable only in combination, and not.

use guen_symbolic::{ExprId, Flow, Form, Forms, Rational};

use crate::words::Words;

/// How the rows of the constraints are made.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Family {
    /// No constraints at all.
    Free,
    /// Rates of functions of `t` and `x`.
    Exact,
    /// The same times functions: integrable, not exact.
    Scaled,
    /// Neither `t` nor offsets, not integrable.
    Catastatic,
    /// Affine and with `t`, not integrable.
    Affine,
    /// Some rows exact or scaled, others not integrable.
    Mixed,
    /// Two rows that regular combinations make one exact and one not integrable.
    Combined,
}

/// Families with their shares in sixteen.
pub const FAMILIES: [Family; 16] = {
    use Family::*;
    [
        Free, Exact, Exact, Scaled, Scaled, Scaled, Catastatic, Catastatic, Affine, Affine, Affine, Affine,
        Mixed, Mixed, Combined, Combined,
    ]
};

/// The forms of a system, with the functions of positions whose rates are among them.
pub struct Rows {
    pub forms: Forms,
    /// `(index of the form, function)`.
    pub positions: Vec<(usize, ExprId)>,
}

struct Row {
    form: Form,
    position: Option<ExprId>,
}

/// Draws parameters and constraints; `order` lists the coordinates, those of the parameters first.
pub fn draw_rows(words: &mut Words, family: Family, degrees: usize, order: &[usize]) -> Rows {
    let (free, bound) = order.split_at(degrees);
    let parameters: Vec<Form> = free.iter().map(|i| parameter(words, *i)).collect();
    let mut constraints: Vec<Row> = Vec::new();
    for (k, i) in bound.iter().enumerate() {
        let row = match family {
            Family::Free | Family::Exact => exact(words, *i, free),
            Family::Scaled if k == 0 || words.draw.once_in(2) => scaled(words, *i, free),
            Family::Scaled => exact(words, *i, free),
            Family::Catastatic | Family::Affine => nonintegrable(words, *i, free, family == Family::Affine),
            Family::Mixed if k == 0 => nonintegrable(words, *i, free, words.timed),
            Family::Mixed if words.draw.once_in(2) => scaled(words, *i, free),
            Family::Mixed => exact(words, *i, free),
            Family::Combined if k % 2 == 0 => exact(words, *i, free),
            Family::Combined => nonintegrable(words, *i, free, words.timed),
        };
        constraints.push(row);
    }
    if family == Family::Combined && constraints.len() >= 2 {
        combine(words, &mut constraints);
    }
    let positions = constraints
        .iter()
        .enumerate()
        .filter_map(|(k, row)| row.position.map(|position| (degrees + k, position)))
        .collect();
    let forms = parameters.into_iter().chain(constraints.into_iter().map(|row| row.form)).collect();
    Rows { forms: Forms { time: words.time, coordinates: words.x.clone(), forms, degrees }, positions }
}

/// `g x_i' + ... + a_s0`.
fn parameter(words: &mut Words, i: usize) -> Form {
    let all = words.everywhere();
    let mut row = vec![words.graph.zero(); all.len()];
    row[i] = if words.draw.once_in(3) { words.positive(&all) } else { words.graph.one() };
    if all.len() > 1 && words.draw.once_in(2) {
        let other = (i + words.draw.between(1, all.len() - 1)) % all.len();
        row[other] = words.coefficient(&all);
    }
    let offset = if words.draw.once_in(2) { words.coefficient(&all) } else { words.graph.zero() };
    Form { row, offset }
}

/// The rate of `x_i + f(t, free coordinates)`.
fn exact(words: &mut Words, i: usize, free: &[usize]) -> Row {
    let mut terms = vec![words.x[i]];
    for _ in 0..words.draw.between(1, 2) {
        let (a, b) = (words.coefficient(free), words.coefficient(free));
        terms.push(if words.draw.once_in(3) { words.graph.mul(a, b) } else { a });
    }
    let position = words.graph.sum(terms);
    let row =
        words.x.iter().map(|x| Flow::partial(&words.graph, *x).of(&mut words.graph, position)).collect();
    let offset = Flow::partial(&words.graph, words.time).of(&mut words.graph, position);
    Row { form: Form { row, offset }, position: Some(position) }
}

/// An exact row times a function.
fn scaled(words: &mut Words, i: usize, free: &[usize]) -> Row {
    let row = exact(words, i, free);
    let all = words.everywhere();
    let factor = words.positive(&all);
    Row { form: times(words, factor, &row.form), position: None }
}

/// `x_i' + sum f x' + a_0` over some of the free coordinates, `f` and `a_0` functions of everything.
fn nonintegrable(words: &mut Words, i: usize, free: &[usize], affine: bool) -> Row {
    let all = words.everywhere();
    let mut row = vec![words.graph.zero(); all.len()];
    row[i] = words.graph.one();
    for _ in 0..free.len().min(2) {
        row[words.draw.pick(free)] = words.coefficient(&all);
    }
    let offset = if affine && !words.draw.once_in(4) { words.coefficient(&all) } else { words.graph.zero() };
    Row { form: Form { row, offset }, position: None }
}

/// Replaces the first two rows by `B11 r1 + B12 r2` and `B21 r1 + B22 r2`.
fn combine(words: &mut Words, rows: &mut [Row]) {
    let all = words.everywhere();
    let (b11, b12, b22) = (words.positive(&all), words.coefficient(&all), words.graph.one());
    let b21 =
        if words.draw.once_in(3) { words.graph.number(Rational::new(1, 3)) } else { words.graph.zero() };
    let (first, second) = (rows[0].form.clone(), rows[1].form.clone());
    for (row, (a, b)) in rows.iter_mut().zip([(b11, b12), (b21, b22)]) {
        let (left, right) = (times(words, a, &first), times(words, b, &second));
        let sum = left.row.iter().zip(&right.row).map(|(a, b)| words.graph.add(*a, *b)).collect();
        row.form = Form { row: sum, offset: words.graph.add(left.offset, right.offset) };
        row.position = None;
    }
}

/// A form times a function.
pub fn times(words: &mut Words, factor: ExprId, form: &Form) -> Form {
    let row = form.row.iter().map(|a| words.graph.mul(factor, *a)).collect();
    Form { row, offset: words.graph.mul(factor, form.offset) }
}
