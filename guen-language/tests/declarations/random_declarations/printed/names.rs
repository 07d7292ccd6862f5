//! Names as they are printed, and what they stand for.

use std::cell::RefCell;
use std::collections::BTreeMap;

use guen_symbolic::ExprId;

use guen_language::parse;

use super::term::Unread;
use crate::random_declarations::draw::Draw;
use crate::random_declarations::scenes::Names;

/// Names of which many are set alike if nobody takes care.
pub const ALIKE: [&str; 40] = [
    "e",
    "x",
    "x1",
    "x_1",
    "x1_2",
    "x_1_2",
    "x12",
    "alpha",
    "α",
    "alpha_1",
    "alpha1",
    "α1",
    "αβ",
    "T",
    "U",
    "h",
    "l",
    "d",
    "q",
    "q_",
    "m_body",
    "mass_of_the_body",
    "theta",
    "θ",
    "Theta",
    "xi",
    "ξ",
    "i",
    "omega_x1",
    "omega_x_1",
    "质",
    "λ1",
    "lambda_1",
    "partial",
    "arcsin",
    "sgn",
    "r2d2",
    "D",
    "p",
    "π1",
];

/// A declaration with these names in place of its own, as far as they go.
pub fn exchanged(text: &str, draw: &mut Draw) -> String {
    let (declaration, _) = parse::parse(text.parse().expect("tokens"));
    let names = Names::of(&declaration.expect("a declaration"));
    let all = [
        names.constants,
        names.inputs,
        names.coordinates,
        names.parameters,
        names.constraints,
        names.outputs,
    ];
    // Vectors have names with components, which are the names of others here.
    let is_vector =
        |name: &String| ["spin", "closed", "touch", "seen"].iter().any(|stem| name.starts_with(stem));
    let own: Vec<String> = all.concat().into_iter().filter(|name| !is_vector(name) && *name != "g").collect();
    let order = draw.permutation(ALIKE.len());
    let begin = draw.below(own.len());
    let chosen = own.iter().cycle().skip(begin).take(own.len());
    let others: BTreeMap<&String, &str> = chosen.zip(order.iter().map(|i| ALIKE[*i])).collect();
    let mut exchanged = String::new();
    let mut word = String::new();
    for c in text.chars().chain([' ']) {
        if c.is_alphanumeric() || c == '_' {
            word.push(c);
            continue;
        }
        exchanged.push_str(others.get(&word).copied().unwrap_or(&word));
        exchanged.push(c);
        word.clear();
    }
    exchanged
}

/// A name as it was read.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum Name {
    /// As in a declaration, with the places of arrays, and with `dot( )` around it or `'` behind it.
    Text(String),
    /// As in a formula: a word with indices and dots.
    Set { head: String, upright: bool, indices: Vec<String>, dots: usize },
    /// The derivative by a variable, as an operator.
    Partial(Box<Name>),
}

/// Names of a declaration, rates and operators among them, and what they stand for.
#[derive(Default)]
pub struct Scope {
    names: BTreeMap<String, ExprId>,
    /// Names that were set, and what they were found to be.
    known: RefCell<BTreeMap<Name, Result<String, Unread>>>,
}

const GREEK: &str = "alpha α beta β gamma γ delta δ epsilon ε zeta ζ eta η theta θ iota ι kappa κ lambda λ mu μ nu ν xi ξ \
                     omicron ο pi π rho ρ sigma σ tau τ upsilon υ phi φ chi χ psi ψ omega ω Gamma Γ Delta Δ Theta Θ \
                     Lambda Λ Xi Ξ Pi Π Sigma Σ Upsilon Υ Phi Φ Psi Ψ Omega Ω";

/// The letter of a Greek name.
pub fn greek(word: &str) -> Option<&'static str> {
    let words: Vec<&str> = GREEK.split_whitespace().collect();
    words.chunks(2).find(|pair| pair[0] == word).map(|pair| pair[1])
}

/// A word of a name as it is set: a Greek letter where it is the name of one, with the digits behind it.
fn set(word: &str) -> String {
    let stem = word.trim_end_matches(|c: char| c.is_ascii_digit());
    let digits = &word[stem.len()..];
    match greek(stem) {
        // The letter that looks Latin is set as that.
        Some("ο") => format!("o{digits}"),
        Some(letter) => format!("{letter}{digits}"),
        None => word.replace('ο', "o"),
    }
}

impl Scope {
    pub fn add(&mut self, name: &str, e: ExprId) {
        self.names.insert(name.to_owned(), e);
        self.known.borrow_mut().clear();
    }

    pub fn symbol(&self, name: &Name) -> Result<ExprId, Unread> {
        let name = self.written(name)?;
        self.names.get(&name).copied().ok_or_else(|| format!("the name `{name}`"))
    }

    /// The name as text.
    pub fn written(&self, name: &Name) -> Result<String, Unread> {
        match name {
            Name::Text(text) => Ok(text.clone()),
            Name::Partial(variable) => Ok(format!("d/d{}", self.written(variable)?)),
            Name::Set { head, upright, indices, dots } => {
                if let Some(known) = self.known.borrow().get(name) {
                    return known.clone();
                }
                let fits = |known: &&String| {
                    let (stem, dotted) = undotted(known);
                    if dotted != *dots {
                        return false;
                    }
                    let verbatim = *upright && indices.is_empty() && stem == head;
                    verbatim || fitting(stem, head, *upright, indices)
                };
                let found: Vec<&String> = self.names.keys().filter(fits).collect();
                let found = match &found[..] {
                    [one] => Ok((*one).clone()),
                    [] => Err(format!("{name:?}")),
                    _ => Err(format!("{name:?} may be any of {found:?}")),
                };
                self.known.borrow_mut().insert(name.clone(), found.clone());
                found
            }
        }
    }
}

impl Scope {
    /// A name that need not be declared, such as that of an energy.
    pub fn label(&self, name: &Name) -> Result<String, Unread> {
        match (self.written(name), name) {
            (Err(why), Name::Set { head, upright, indices, dots }) if !why.contains("any of") => {
                // The rate of a state is no symbol, the state is one.
                let (head, indices) = (head.clone(), indices.clone());
                let plain = format!("{head}{}", indices.concat());
                let still = Name::Set { head, upright: *upright, indices, dots: 0 };
                Ok(format!("{}{}", self.written(&still).unwrap_or(plain), "'".repeat(*dots)))
            }
            (known, _) => known,
        }
    }
}

/// A name without what says that it is a rate, and how often it says so.
fn undotted(name: &str) -> (&str, usize) {
    let inner = name.strip_prefix("dot(").and_then(|rest| rest.strip_suffix(')'));
    match inner.or_else(|| name.strip_suffix('\'')) {
        Some(inner) => {
            let (stem, dots) = undotted(inner);
            (stem, dots + 1)
        }
        None => (name, 0),
    }
}

/// Whether a name is set with this head and these indices.
fn fitting(name: &str, head: &str, upright: bool, indices: &[String]) -> bool {
    let words: Vec<&str> = name.split(['_', '[', ']', '.']).filter(|word| !word.is_empty()).collect();
    let Some((first, rest)) = words.split_first() else { return head == name && indices.is_empty() };
    let stem = first.trim_end_matches(|c: char| c.is_ascii_digit());
    let stem = if stem.is_empty() { first } else { stem };
    let digits = &first[stem.len()..];
    let wanted = [digits].into_iter().filter(|digits| !digits.is_empty()).chain(rest.iter().copied());
    let own = set(stem);
    // Words stand upright, letters do not.
    own == head && upright == (own.chars().count() > 1) && wanted.map(set).eq(indices.iter().cloned())
}
