//! Names of a declaration as LaTeX: Greek letters, indices, dots of rates.

use std::collections::{BTreeMap, BTreeSet};

use crate::algebra::Graph;

/// The Greek letters with their LaTeX commands; those that look Latin have none of their own.
const GREEK: &[(&str, char, &str)] = &[
    ("alpha", 'α', "\\alpha"),
    ("beta", 'β', "\\beta"),
    ("gamma", 'γ', "\\gamma"),
    ("delta", 'δ', "\\delta"),
    ("epsilon", 'ε', "\\epsilon"),
    ("zeta", 'ζ', "\\zeta"),
    ("eta", 'η', "\\eta"),
    ("theta", 'θ', "\\theta"),
    ("iota", 'ι', "\\iota"),
    ("kappa", 'κ', "\\kappa"),
    ("lambda", 'λ', "\\lambda"),
    ("mu", 'μ', "\\mu"),
    ("nu", 'ν', "\\nu"),
    ("xi", 'ξ', "\\xi"),
    ("omicron", 'ο', "o"),
    ("pi", 'π', "\\pi"),
    ("rho", 'ρ', "\\rho"),
    ("sigma", 'σ', "\\sigma"),
    ("tau", 'τ', "\\tau"),
    ("upsilon", 'υ', "\\upsilon"),
    ("phi", 'φ', "\\phi"),
    ("chi", 'χ', "\\chi"),
    ("psi", 'ψ', "\\psi"),
    ("omega", 'ω', "\\omega"),
    ("Gamma", 'Γ', "\\Gamma"),
    ("Delta", 'Δ', "\\Delta"),
    ("Theta", 'Θ', "\\Theta"),
    ("Lambda", 'Λ', "\\Lambda"),
    ("Xi", 'Ξ', "\\Xi"),
    ("Pi", 'Π', "\\Pi"),
    ("Sigma", 'Σ', "\\Sigma"),
    ("Upsilon", 'Υ', "\\Upsilon"),
    ("Phi", 'Φ', "\\Phi"),
    ("Psi", 'Ψ', "\\Psi"),
    ("Omega", 'Ω', "\\Omega"),
];

/// The letter behind a command of LaTeX, `eta` for `\\eta`.
///
/// ```
/// assert_eq!(guen_symbolic::greek_letter("eta"), Some('η'));
/// assert_eq!(guen_symbolic::greek_letter("sin"), None);
/// ```
pub fn greek_letter(command: &str) -> Option<char> {
    GREEK.iter().find(|(name, ..)| *name == command).map(|(_, letter, _)| *letter)
}

/// A name of a declaration as LaTeX: `eta1` is `\eta_{1}`, `dot(x)` and `x'` are rates, `d/dx` is an operator.
///
/// ```
/// assert_eq!(guen_symbolic::latex_name("dot(theta)"), "\\dot{\\theta}");
/// assert_eq!(guen_symbolic::latex_name("eta1'"), "\\dot{\\eta}_{1}");
/// assert_eq!(guen_symbolic::latex_name("αβ"), "\\mathrm{{\\alpha}{\\beta}}");
/// assert_eq!(guen_symbolic::latex_name("q_x[3]"), "q_{x,3}");
/// assert_eq!(guen_symbolic::latex_name("mass_body"), "\\mathrm{mass}_{\\mathrm{body}}");
/// ```
pub fn latex_name(name: &str) -> String {
    LatexNames::default().of_name(name)
}

/// The names of a graph as LaTeX, each in its own way: of `x1` and `x_1`, which are both `x_{1}`, letters are printed as they are.
#[derive(Clone, Debug, Default)]
pub(super) struct LatexNames {
    /// Names that others are printed like.
    shared: BTreeSet<String>,
}

impl LatexNames {
    /// The names of all symbols.
    pub(super) fn of(graph: &Graph) -> Self {
        let mut names: BTreeMap<String, BTreeSet<&str>> = BTreeMap::new();
        for symbol in graph.symbols() {
            let (name, _) = undotted(&graph.symbol_info(symbol).name);
            names.entry(indexed(name, 0)).or_default().insert(name);
        }
        let shared = names.into_values().filter(|names| names.len() > 1);
        LatexNames { shared: shared.flatten().map(str::to_owned).collect() }
    }

    /// [`latex_name`], or the letters of a name that another one is printed like.
    pub(super) fn of_name(&self, name: &str) -> String {
        if let Some(variable) = name.strip_prefix("d/d") {
            return format!("\\frac{{\\partial}}{{\\partial {}}}", self.of_name(variable));
        }
        let (stem, dots) = undotted(name);
        if self.shared.contains(stem) {
            return dotted(&upright(stem), dots);
        }
        indexed(stem, dots)
    }
}

/// A name without the marks of rates, and how many there are.
fn undotted(name: &str) -> (&str, usize) {
    let (mut stem, mut dots) = (name, 0);
    loop {
        if let Some(inner) = stem.strip_prefix("dot(").and_then(|rest| rest.strip_suffix(')')) {
            (stem, dots) = (inner, dots + 1);
        } else if let Some(inner) = stem.strip_suffix('\'') {
            (stem, dots) = (inner, dots + 1);
        } else {
            return (stem, dots);
        }
    }
}

fn dotted(text: &str, dots: usize) -> String {
    if dots == 0 { text.to_owned() } else { format!("\\{}ot{{{text}}}", "d".repeat(dots)) }
}

/// A name with indices and dots.
fn indexed(stem: &str, dots: usize) -> String {
    let (head, indices) = split_indices(stem);
    let text = dotted(&word(head), dots);
    if indices.is_empty() {
        return text;
    }
    let indices: Vec<_> = indices.iter().map(|index| word(index)).collect();
    format!("{text}_{{{}}}", indices.join(","))
}

/// `omega_x1` is `omega` with the indices `x` and `1`, as `k[1][2]` is `k` and `rear[2].angle` is `rear` with theirs.
/// Digits at the end of the first word are an index too.
fn split_indices(name: &str) -> (&str, Vec<&str>) {
    let mut words = name.split(['_', '[', ']', '.']).filter(|word| !word.is_empty());
    let Some(first) = words.next() else { return (name, Vec::new()) };
    let head = first.trim_end_matches(|c: char| c.is_ascii_digit());
    if head.is_empty() {
        return (first, words.collect());
    }
    let digits = &first[head.len()..];
    (head, (!digits.is_empty()).then_some(digits).into_iter().chain(words).collect())
}

fn word(text: &str) -> String {
    let mut letters = text.chars();
    let single = letters.next().filter(|_| letters.next().is_none());
    for (name, letter, command) in GREEK {
        if *name == text || single == Some(*letter) {
            return (*command).to_owned();
        }
    }
    if single.is_some() || text.chars().all(|c| c.is_ascii_digit()) {
        return text.to_owned();
    }
    let digits = text.trim_start_matches(|c: char| !c.is_ascii_digit());
    let stem = &text[..text.len() - digits.len()];
    if !digits.is_empty() && digits.chars().all(|c| c.is_ascii_digit()) && !stem.is_empty() {
        return format!("{}{digits}", word(stem));
    }
    upright(text)
}

/// The name of a function that a declaration has named: its letters as they are.
pub(super) fn operator(name: &str) -> String {
    upright(name).replacen("\\mathrm", "\\operatorname", 1)
}

/// The letters of a name as they are.
fn upright(text: &str) -> String {
    let letters = text.chars().map(|c| match GREEK.iter().find(|(_, letter, _)| *letter == c) {
        Some((_, _, command)) => format!("{{{command}}}"),
        None if c == '_' => "\\_".to_owned(),
        None => c.to_string(),
    });
    format!("\\mathrm{{{}}}", letters.collect::<String>())
}
