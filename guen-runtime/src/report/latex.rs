//! A report as a LaTeX document.

use core::fmt::{self, Write};

use super::Report;

/// The document that [`Report::latex`] displays.
#[derive(Clone, Copy, Debug)]
pub struct LatexDocument<'r> {
    pub(super) report: &'r Report,
    pub(super) whole: bool,
}

impl LatexDocument<'_> {
    /// The sections alone, for a document of one's own. Its preamble has to load `amsmath`.
    pub fn body(self) -> Self {
        Self { whole: false, ..self }
    }
}

const HEAD: &str = r"\documentclass[a4paper]{article}
\usepackage[margin=25mm]{geometry}
\usepackage{iftex}
\ifPDFTeX\usepackage[T1]{fontenc}\usepackage{lmodern}\else\usepackage{fontspec}\fi
\usepackage{amsmath}
\setlength{\parindent}{0pt}
\begin{document}
";

/// A formula is a paragraph of its own, ragged, so that it breaks between terms; what follows the first line hangs.
const FORMULA: &str = r"{\raggedright\hangindent=2em\hangafter=1$\displaystyle ";
const AFTER: &str = "$\\par}\\smallskip\n";

impl fmt::Display for LatexDocument<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Report { name, summary, sections } = self.report;
        if self.whole {
            f.write_str(HEAD)?;
        }
        f.write_str("\\section*{")?;
        escaped(f, name)?;
        f.write_str("}\n")?;
        escaped(f, summary)?;
        f.write_char('\n')?;
        for section in *sections {
            f.write_str("\n\\subsection*{")?;
            escaped(f, section.title)?;
            f.write_str("}\n")?;
            for formula in section.formulas {
                f.write_str(FORMULA)?;
                breakable(f, formula)?;
                f.write_str(AFTER)?;
            }
            let words = section.words();
            for (i, line) in words.iter().enumerate() {
                f.write_str(if i == 0 { "\\begin{itemize}\n\\item " } else { "\\item " })?;
                escaped(f, line)?;
                f.write_char('\n')?;
            }
            if !words.is_empty() {
                f.write_str("\\end{itemize}\n")?;
            }
        }
        f.write_str(if self.whole { "\\end{document}\n" } else { "" })
    }
}

/// A formula whose lines may break in its outer parentheses too, if it is long: between `\left` and `\right` LaTeX breaks
/// nothing.
fn breakable(f: &mut fmt::Formatter<'_>, formula: &str) -> fmt::Result {
    /// About a line.
    const LINE_CHARACTERS: usize = 160;
    if formula.len() <= LINE_CHARACTERS {
        return f.write_str(formula);
    }
    let mut depth = 0_i32;
    let mut rest = formula;
    while let Some(c) = rest.chars().next() {
        let outer = [("\\left(", "\\bigl("), ("\\right)", "\\bigr)")];
        if let Some((from, to)) = outer.iter().find(|(from, _)| depth == 0 && rest.starts_with(from)) {
            f.write_str(to)?;
            rest = &rest[from.len()..];
            continue;
        }
        depth += i32::from(c == '{') - i32::from(c == '}');
        f.write_char(c)?;
        rest = &rest[c.len_utf8()..];
    }
    Ok(())
}

/// The small letters from alpha to omega, in the order of their code points.
const GREEK: [&str; 25] = [
    "alpha",
    "beta",
    "gamma",
    "delta",
    "epsilon",
    "zeta",
    "eta",
    "theta",
    "iota",
    "kappa",
    "lambda",
    "mu",
    "nu",
    "xi",
    "mathit{o}",
    "pi",
    "rho",
    "varsigma",
    "sigma",
    "tau",
    "upsilon",
    "phi",
    "chi",
    "psi",
    "omega",
];

/// The capital letters that do not look Latin.
const CAPITALS: [(char, &str); 11] = [
    ('Γ', "Gamma"),
    ('Δ', "Delta"),
    ('Θ', "Theta"),
    ('Λ', "Lambda"),
    ('Ξ', "Xi"),
    ('Π', "Pi"),
    ('Σ', "Sigma"),
    ('Υ', "Upsilon"),
    ('Φ', "Phi"),
    ('Ψ', "Psi"),
    ('Ω', "Omega"),
];

/// Words: what is between backticks in typewriter, and everything that LaTeX would understand otherwise as a letter.
fn escaped(f: &mut fmt::Formatter<'_>, line: &str) -> fmt::Result {
    let mut in_code = false;
    let pairs = line.matches('`').count() / 2 * 2;
    let mut ticks = 0;
    for c in line.chars() {
        match c {
            '`' if ticks < pairs => {
                f.write_str(if in_code { "}" } else { "\\texttt{" })?;
                in_code = !in_code;
                ticks += 1;
            }
            '\\' => f.write_str("\\textbackslash{}")?,
            '^' => f.write_str("\\textasciicircum{}")?,
            '~' => f.write_str("\\textasciitilde{}")?,
            '<' | '>' | '|' => write!(f, "${c}$")?,
            'α'..='ω' => write!(f, "$\\{}$", GREEK[c as usize - 'α' as usize])?,
            'Γ'..='Ω' => match CAPITALS.iter().find(|(letter, _)| *letter == c) {
                Some((_, command)) => write!(f, "$\\{command}$")?,
                None => f.write_char(c)?,
            },
            '°' => f.write_str("$^\\circ$")?,
            '{' | '}' | '$' | '&' | '#' | '%' | '_' => write!(f, "\\{c}")?,
            c => f.write_char(c)?,
        }
    }
    Ok(())
}
