//! Names of a declaration as LaTeX: Greek letters, indices, dots of rates.

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
/// assert_eq!(guen_symbolic::latex_name("mass_body"), "\\mathrm{mass}_{\\mathrm{body}}");
/// ```
pub fn latex_name(name: &str) -> String {
    if let Some(variable) = name.strip_prefix("d/d") {
        return format!("\\frac{{\\partial}}{{\\partial {}}}", latex_name(variable));
    }
    let (mut stem, mut dots) = (name, 0);
    loop {
        if let Some(inner) = stem.strip_prefix("dot(").and_then(|rest| rest.strip_suffix(')')) {
            (stem, dots) = (inner, dots + 1);
        } else if let Some(inner) = stem.strip_suffix('\'') {
            (stem, dots) = (inner, dots + 1);
        } else {
            break;
        }
    }
    let (head, indices) = split_indices(stem);
    let mut text = word(head);
    if dots > 0 {
        text = format!("\\{}ot{{{text}}}", "d".repeat(dots));
    }
    if !indices.is_empty() {
        let indices: Vec<_> = indices.iter().map(|index| word(index)).collect();
        text = format!("{text}_{{{}}}", indices.join(","));
    }
    text
}

/// `omega_x1` is `omega` with the indices `x` and `1`; digits at the end of the first word are an index too.
fn split_indices(name: &str) -> (&str, Vec<&str>) {
    let mut words = name.split('_').filter(|word| !word.is_empty());
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
    let upright = text.chars().map(|c| match GREEK.iter().find(|(_, letter, _)| *letter == c) {
        Some((_, _, command)) => format!("{{{command}}}"),
        None => c.to_string(),
    });
    format!("\\mathrm{{{}}}", upright.collect::<String>())
}
