//! Lines of a report: what stands there, and what was derived.

use f256::f256;
use guen_symbolic::{ExprId, Graph, SymbolId, Verdict, Workbench, evaluate};

use super::math::{self, Math};
use super::names::Scope;
use super::term::{Term, Unread};
use super::{latex, mathml, text};

/// What a line has to say.
pub enum Line {
    /// `label = value`, and that this vanishes; beside it a function whose rate it is.
    Equation { label: String, value: ExprId, vanishes: bool, rate_of: Option<ExprId> },
    /// `value = 0`.
    Vanishes(ExprId),
    /// `value != 0`.
    Differs(ExprId),
    /// Things with names that vanish, and how they are separated.
    All(Vec<String>),
    /// Behind words, a combination.
    Behind(&'static str, ExprId),
}

/// What a line is written in.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Format {
    Text,
    Latex,
    MathMl,
}

/// What was found in a line.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Found {
    Same,
    /// A note in place of what is too long.
    TooLong,
}

/// One side of an equation.
enum Side {
    Text(String),
    Math(Vec<Math>),
}

impl Side {
    fn label(&self, scope: &Scope) -> Result<String, Unread> {
        match self {
            Side::Text(text) => Ok(rated(text)),
            Side::Math(items) => math::label(items, &|name| scope.label(name)).map(|label| rated(&label)),
        }
    }

    /// The formula; none if it was too long.
    fn term(&self) -> Result<Option<Term>, Unread> {
        match self {
            Side::Text(text) if text.contains("too long to print") => Ok(None),
            Side::Text(text) => text::read(text).map(Some),
            Side::Math(items) if *items == [Math::Mark('…')] => Ok(None),
            Side::Math(items) => math::read(items).map(Some),
        }
    }

    fn is_zero(&self) -> bool {
        match self {
            Side::Text(text) => text == "0",
            Side::Math(items) => *items == [Math::Number("0".to_owned())],
        }
    }
}

/// Rates in one way: `x'` for `dot(x)`.
fn rated(label: &str) -> String {
    match label.strip_prefix("dot(").and_then(|rest| rest.strip_suffix(')')) {
        Some(inner) => format!("{inner}'"),
        None => label.to_owned(),
    }
}

/// A line cut at its relations: its sides, and the equation in the note behind it.
struct Cut {
    sides: Vec<Side>,
    relation: &'static str,
    note: Option<Vec<Side>>,
}

fn cut(line: &str, format: Format) -> Result<Cut, Unread> {
    let items = match format {
        Format::Text => {
            let (formula, note) = match line.split_once("   (the rate of ") {
                Some((formula, note)) => (formula, Some(note.strip_suffix(')').ok_or("an open note")?)),
                None => (line, None),
            };
            let relation = if formula.contains(" != ") { "!=" } else { "=" };
            let sides = |text: &str| -> Vec<Side> {
                let mark = format!(" {relation} ");
                text.split(&mark).map(|side| Side::Text(side.to_owned())).collect()
            };
            return Ok(Cut { sides: sides(formula), relation, note: note.map(sides) });
        }
        Format::Latex => latex::read(line)?,
        Format::MathMl => mathml::read(&mathml::page(line))?,
    };
    let relation = if items.contains(&Math::Mark('≠')) { "!=" } else { "=" };
    let sides =
        |items: &[Math]| math::sides(items).into_iter().map(|side| Side::Math(side.to_vec())).collect();
    let (formula, note) = match items.iter().position(|item| matches!(item, Math::Prose(_))) {
        None => (&items[..], None),
        Some(place) => {
            let open = items[place] == Math::Prose("(the rate of ".to_owned());
            let close = items.last() == Some(&Math::Prose(")".to_owned()));
            if !open || !close {
                return Err(format!("the words in {line}"));
            }
            (&items[..place], Some(&items[place + 1..items.len() - 1]))
        }
    };
    Ok(Cut { sides: sides(formula), relation, note: note.map(sides) })
}

/// Whether a line says what it has to.
pub fn check(
    line: &str,
    format: Format,
    expected: &Line,
    bench: &mut Workbench,
    scope: &Scope,
) -> Result<Found, Unread> {
    if let Line::Behind(words, value) = expected {
        let rest = line.strip_prefix(words).ok_or_else(|| format!("not behind `{words}`"))?;
        return same(&read(rest, format)?, *value, bench, scope).map(|()| Found::Same);
    }
    let Cut { sides, relation, note } = cut(line, format)?;
    let wanted = if matches!(expected, Line::Differs(_)) { "!=" } else { "=" };
    if relation != wanted {
        return Err(format!("`{relation}` and not `{wanted}`"));
    }
    let ends = |sides: &[Side]| match sides.last() {
        Some(side) if side.is_zero() => Ok(()),
        _ => Err("no zero at the end".to_owned()),
    };
    let mut compared = |side: &Side, value: ExprId| match side.term()? {
        None => Ok(Found::TooLong),
        Some(term) => same(&term, value, bench, scope).map(|()| Found::Same),
    };
    let count = |count: usize| match sides.len() == count {
        true => Ok(()),
        false => Err(format!("{} sides", sides.len())),
    };
    match expected {
        Line::Vanishes(value) | Line::Differs(value) => {
            count(2)?;
            ends(&sides)?;
            compared(&sides[0], *value)
        }
        Line::Equation { label, value, vanishes, rate_of } => {
            count(if *vanishes { 3 } else { 2 })?;
            if *vanishes {
                ends(&sides)?;
            }
            let own = sides[0].label(scope)?;
            if own != rated(label) {
                return Err(format!("`{own}` and not `{label}`"));
            }
            match (note, rate_of) {
                (None, None) => {}
                (Some(note), Some(function)) if note.len() == 2 => {
                    ends(&note)?;
                    compared(&note[0], *function)?;
                }
                _ => return Err("the note".to_owned()),
            }
            compared(&sides[1], *value)
        }
        Line::All(names) => {
            count(names.len() + 1)?;
            ends(&sides)?;
            let own: Result<Vec<String>, Unread> =
                sides[..names.len()].iter().map(|side| side.label(scope)).collect();
            let own = own?;
            if own == *names { Ok(Found::Same) } else { Err(format!("{own:?} and not {names:?}")) }
        }
        Line::Behind(..) => unreachable!("it has returned"),
    }
}

/// Longest formulas that are looked at where a report has a note in their place.
const LONGEST: usize = 6_000;

/// What stands in place of a note, if it is not much longer: whether that would be right.
pub fn long(expected: &Line, format: Format, bench: &mut Workbench, scope: &Scope) -> Result<Found, Unread> {
    let (Line::Equation { value, .. } | Line::Vanishes(value) | Line::Differs(value)) = expected else {
        return Ok(Found::TooLong);
    };
    let written = match format {
        Format::Text => bench.graph.text_limited(*value, LONGEST),
        // Longer by as much.
        _ => bench.graph.latex_limited(*value, 2 * LONGEST),
    };
    let Some(formula) = written else { return Ok(Found::TooLong) };
    let term = read(&formula, format)?;
    same(&term, *value, bench, scope).map(|()| Found::TooLong)
}

/// A formula by itself.
pub fn read(formula: &str, format: Format) -> Result<Term, Unread> {
    match format {
        Format::Text => text::read(formula),
        Format::Latex => math::read(&latex::read(formula)?),
        Format::MathMl => math::read(&mathml::read(&mathml::page(formula))?),
    }
}

/// Whether a formula is an expression, by the zero test; at points where that does not know.
pub fn same(term: &Term, value: ExprId, bench: &mut Workbench, scope: &Scope) -> Result<(), Unread> {
    let own = term.build(&mut bench.graph, scope)?;
    let difference = bench.graph.sub(own, value);
    match bench.zero.verdict(&mut bench.graph, difference) {
        Verdict::Zero => Ok(()),
        Verdict::Nonzero => Err("another value".to_owned()),
        Verdict::Unknown => match agree(&bench.graph, own, value) {
            Some(true) => Ok(()),
            Some(false) => Err("another value at a point".to_owned()),
            None => Err("no value at any point".to_owned()),
        },
    }
}

/// Whether two expressions have equal values; none if they have none.
fn agree(graph: &Graph, a: ExprId, b: ExprId) -> Option<bool> {
    let mut seen = None;
    for round in 1..=100_u32 {
        let value = |symbol: SymbolId| {
            f256::from(0.1 + 0.8 * (f64::from(round) * 1.7 + symbol.index() as f64 * 2.3).sin().abs())
        };
        let values = evaluate(graph, &[a, b], &value);
        if values.iter().all(|value| value.is_finite()) {
            if (values[0] - values[1]).abs() > f256::from(1e-30) * (f256::ONE + values[0].abs()) {
                return Some(false);
            }
            seen = Some(true);
        }
    }
    seen
}
