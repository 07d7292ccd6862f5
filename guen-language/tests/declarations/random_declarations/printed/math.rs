//! Set mathematics, whether it came from LaTeX or from MathML, and how it is read.

use super::names::Name;
use super::term::{Term, Unread};

/// A part of a formula.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Math {
    Number(String),
    Word {
        text: String,
        upright: bool,
    },
    /// A function, whose argument follows.
    Function(String),
    Mark(char),
    /// What stands between parentheses or bars.
    Fenced(char, Vec<Math>),
    Fraction(Vec<Math>, Vec<Math>),
    Root(Option<Vec<Math>>, Vec<Math>),
    /// A base with what is below and above.
    Script {
        base: Box<Math>,
        below: Option<Vec<Math>>,
        above: Option<Vec<Math>>,
    },
    Dotted(usize, Vec<Math>),
    /// A group without marks of its own.
    Group(Vec<Math>),
    Prose(String),
}

/// Groups of one and scripts on scripts as they are meant: `{x_1}^2` is `x_1^2`.
pub fn script(base: Math, below: Option<Vec<Math>>, above: Option<Vec<Math>>) -> Math {
    let base = match base {
        Math::Group(mut items) if items.len() == 1 => items.remove(0),
        base => base,
    };
    match base {
        Math::Script { base, below: Some(own), above: None } if below.is_none() => {
            Math::Script { base, below: Some(own), above }
        }
        base => Math::Script { base: Box::new(base), below, above },
    }
}

/// The sides of equations and of inequalities.
pub fn sides(items: &[Math]) -> Vec<&[Math]> {
    items.split(|item| matches!(item, Math::Mark('=' | '≠'))).collect()
}

/// A sum.
pub fn read(items: &[Math]) -> Result<Term, Unread> {
    let mut terms = Vec::new();
    let mut rest = items;
    let mut minus = false;
    if let Some((Math::Mark('-'), others)) = rest.split_first() {
        (minus, rest) = (true, others);
    }
    loop {
        let end = rest.iter().position(|item| matches!(item, Math::Mark('+' | '-'))).unwrap_or(rest.len());
        terms.push((minus, product(&rest[..end])?));
        match rest.get(end) {
            None => break,
            Some(mark) => minus = *mark == Math::Mark('-'),
        }
        rest = &rest[end + 1..];
    }
    Ok(match &terms[..] {
        [(false, one)] => one.clone(),
        _ => Term::Sum(terms),
    })
}

fn product(items: &[Math]) -> Result<Term, Unread> {
    let mut factors = Vec::new();
    let mut rest = items;
    while !rest.is_empty() {
        let (factor, after) = factor(rest)?;
        factors.push((false, factor));
        rest = after;
    }
    match factors.len() {
        0 => Err("nothing to multiply".to_owned()),
        1 => Ok(factors.remove(0).1),
        _ => Ok(Term::Product(factors)),
    }
}

/// The first factor and what follows: a function takes the one thing behind it.
fn factor(items: &[Math]) -> Result<(Term, &[Math]), Unread> {
    let (first, rest) = items.split_first().ok_or("no factor")?;
    let (function, above) = match first {
        Math::Function(name) => (name.clone(), None),
        Math::Script { base, below, above } => match &**base {
            // A derivative has the arguments as indices.
            Math::Function(name) => {
                let by = below.iter().flat_map(|below| below.split(|item| *item == Math::Mark(',')));
                let by: Option<Vec<String>> = by.map(word).collect();
                let by = by.ok_or_else(|| format!("the indices {below:?}"))?;
                ([std::slice::from_ref(name), &by[..]].concat().join("_"), above.as_deref())
            }
            _ => return Ok((atom(first)?, rest)),
        },
        _ => return Ok((atom(first)?, rest)),
    };
    let (next, _) = rest.split_first().ok_or_else(|| format!("`{function}` of nothing"))?;
    if let Math::Script { base, .. } = next
        && matches!(&**base, Math::Fenced('(', _))
    {
        return Err(format!("`{function}(..)^..` is the power of either"));
    }
    let (arguments, after) = match next {
        Math::Fenced('(', inner) => {
            let argument = |items: &[Math]| match items {
                // The condition of `select`.
                [c @ .., Math::Mark('≥'), Math::Number(zero)] if zero == "0" => read(c),
                _ => read(items),
            };
            let arguments: Result<Vec<Term>, Unread> =
                inner.split(|item| *item == Math::Mark(',')).map(argument).collect();
            (arguments?, &rest[1..])
        }
        _ => {
            let (argument, after) = factor(rest)?;
            (vec![argument], after)
        }
    };
    let call = Term::Call(function.clone(), arguments);
    Ok((raised(call, above)?, after))
}

fn raised(base: Term, above: Option<&[Math]>) -> Result<Term, Unread> {
    let Some(above) = above else { return Ok(base) };
    let (p, q) = read(above)?.as_ratio()?;
    Ok(Term::Power(Box::new(base), p, q))
}

fn atom(item: &Math) -> Result<Term, Unread> {
    match item {
        Math::Number(digits) => Term::digits(digits),
        Math::Fenced('(', inner) | Math::Group(inner) => read(inner),
        Math::Fenced('|', inner) => Ok(Term::Call("abs".to_owned(), vec![read(inner)?])),
        Math::Fraction(above, below) => match partial(above, below) {
            Some(variable) => Ok(Term::Name(Name::Partial(Box::new(variable)))),
            None => Ok(Term::Product(vec![(false, read(above)?), (true, read(below)?)])),
        },
        Math::Root(order, inner) => {
            let q = match order {
                None => 2,
                Some(order) => read(order)?.as_ratio()?.0 as u32,
            };
            Ok(Term::Power(Box::new(read(inner)?), 1, q))
        }
        Math::Script { base, below, above } => {
            let base = match below {
                None => atom(base)?,
                Some(_) => {
                    let name = Math::Script { base: base.clone(), below: below.clone(), above: None };
                    Term::Name(named(&name).ok_or_else(|| format!("the name {name:?}"))?)
                }
            };
            raised(base, above.as_deref())
        }
        Math::Word { .. } | Math::Dotted(..) => {
            named(item).map(Term::Name).ok_or_else(|| format!("the name {item:?}"))
        }
        Math::Function(_) | Math::Mark(_) | Math::Fenced(..) | Math::Prose(_) => Err(format!("{item:?}")),
    }
}

/// The variable of `d/dx`.
fn partial(above: &[Math], below: &[Math]) -> Option<Name> {
    let is_partial = |item: &Math| matches!(item, Math::Word { text, .. } if text == "∂");
    match (above, below) {
        ([top], [bottom, variable]) if is_partial(top) && is_partial(bottom) => named(variable),
        _ => None,
    }
}

/// A name with indices and dots.
pub fn named(item: &Math) -> Option<Name> {
    match item {
        Math::Word { text, upright } => {
            Some(Name::Set { head: text.clone(), upright: *upright, indices: Vec::new(), dots: 0 })
        }
        Math::Group(items) => match &items[..] {
            [one] => named(one),
            _ => None,
        },
        Math::Dotted(count, inner) => match inner.iter().map(named).collect::<Vec<_>>().pop()?? {
            Name::Set { head, upright, indices, dots } if inner.len() == 1 => {
                Some(Name::Set { head, upright, indices, dots: dots + count })
            }
            _ => None,
        },
        Math::Script { base, below: Some(below), above: None } => match named(base)? {
            Name::Set { head, upright, indices, dots } if indices.is_empty() => {
                let words = below.split(|item| *item == Math::Mark(','));
                let words: Option<Vec<String>> = words.map(word).collect();
                Some(Name::Set { head, upright, indices: words?, dots })
            }
            _ => None,
        },
        _ => None,
    }
}

/// A word of an index.
fn word(items: &[Math]) -> Option<String> {
    let parts: Option<Vec<&str>> = items
        .iter()
        .map(|item| match item {
            Math::Word { text, .. } | Math::Number(text) => Some(&text[..]),
            _ => None,
        })
        .collect();
    parts.map(|parts| parts.concat()).filter(|word| !word.is_empty())
}

/// What stands on the left of an equation, as text.
pub fn label(items: &[Math], written: &dyn Fn(&Name) -> Result<String, Unread>) -> Result<String, Unread> {
    let is = |item: &Math, text: &str| matches!(item, Math::Word { text: own, .. } if own == text);
    match items {
        // `(X1, X2)`
        [Math::Fenced('(', inner)] => match &inner[..] {
            [Math::Fraction(above, below)] => match (&above[..], &below[..]) {
                ([d, Math::Script { base, below: None, above: Some(mark) }], [b, name])
                    if is(d, "∂")
                        && is(b, "∂")
                        && is(base, "T")
                        && mark[..].len() == 1
                        && is(&mark[0], "∘") =>
                {
                    let name = named(name).ok_or("no form")?;
                    Ok(format!("(dT°/d{})", written(&name)?))
                }
                _ => Err(format!("{inner:?}")),
            },
            _ => {
                let parts: Result<Vec<String>, Unread> =
                    inner.split(|item| *item == Math::Mark(',')).map(|part| label(part, written)).collect();
                Ok(format!("({})", parts?.join(", ")))
            }
        },
        [Math::Fraction(above, below)] => match (&above[..], &below[..]) {
            ([d, t], [b, name]) if is(d, "∂") && is(b, "∂") && is(t, "T") => {
                let name = named(name).ok_or("no form")?;
                Ok(format!("dT/d{}", written(&name)?))
            }
            _ => Err(format!("{items:?}")),
        },
        [one] => written(&named(one).ok_or_else(|| format!("{one:?}"))?),
        _ => Err(format!("{items:?}")),
    }
}
