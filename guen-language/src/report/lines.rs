//! Sections of a report and how their lines are written: as text and as LaTeX.

use guen_symbolic::{Class, ExprId, Notation};

/// A heading with its lines: formulas, then words.
#[derive(Clone)]
pub struct SectionLines {
    /// The heading of the lines.
    pub title: &'static str,
    /// The lines as text.
    pub text: Vec<String>,
    /// The formulas as LaTeX: the first of these lines.
    pub latex: Vec<String>,
}

impl SectionLines {
    /// Lines that are no formulas.
    pub(super) fn words(title: &'static str, text: Vec<String>) -> Self {
        SectionLines { title, text, latex: Vec::new() }
    }
}

/// The report of a system: its lines, as text and as LaTeX.
pub struct ReportLines {
    /// The system's name.
    pub name: String,
    /// A sentence that sums up the system.
    pub summary: String,
    /// The sections, in order.
    pub sections: Vec<SectionLines>,
}

impl ReportLines {
    /// The report of what stands in for a faulty declaration.
    pub(crate) fn stand_in(system: &proc_macro2::Ident) -> Self {
        let summary = "The declaration has faults: nothing was derived.".to_owned();
        ReportLines { name: system.to_string(), summary, sections: Vec::new() }
    }
}

/// Coefficients with the names that they multiply.
pub(super) type Terms = Vec<(ExprId, String)>;

/// The text in place of a longer line.
pub(super) const TOO_LONG: &str = ".. (too long to print)";
/// The formula in place of a longer one.
pub(super) const LATEX_TOO_LONG: &str = r"\ldots";

/// The two notations of a report, text and LaTeX.
pub(super) struct Writer<'g> {
    pub(super) text: Notation<'g>,
    pub(super) latex: Notation<'g>,
}

/// Lines that are formulas, written twice.
pub(super) struct Lines<'w, 'g> {
    pub(super) writer: &'w mut Writer<'g>,
    pub(super) section: SectionLines,
}

impl<'w, 'g> Lines<'w, 'g> {
    pub(super) fn new(writer: &'w mut Writer<'g>, title: &'static str) -> Self {
        Lines { writer, section: SectionLines { title, text: Vec::new(), latex: Vec::new() } }
    }

    /// `name = right`, of a symbol or of its rate.
    pub(super) fn named(&mut self, name: &str, right: ExprId) {
        let latex = self.writer.latex.name(name);
        self.equation(name, &latex, right);
    }

    /// `left = right` with an expression on the right.
    pub(super) fn equation(&mut self, left: &str, left_latex: &str, right: ExprId) {
        let text = self.writer.text.expression(right);
        let latex = self.writer.latex.expression(right);
        self.push(left, left_latex, text, latex);
    }

    /// `left = sum of coefficients times names`.
    pub(super) fn combination(&mut self, left: &str, left_latex: &str, terms: &[(ExprId, String)]) {
        // Both sums take the plain names: LaTeX is made of them there.
        let terms: Vec<_> = terms.iter().map(|(c, name)| (*c, name.as_str())).collect();
        let text = self.writer.text.sum(&terms);
        let latex = self.writer.latex.sum(&terms);
        self.push(left, left_latex, text, latex);
    }

    pub(super) fn push(&mut self, left: &str, left_latex: &str, text: Option<String>, latex: Option<String>) {
        self.section.text.push(format!("{left} = {}", text.as_deref().unwrap_or(TOO_LONG)));
        self.section.latex.push(format!("{left_latex} = {}", latex.as_deref().unwrap_or(LATEX_TOO_LONG)));
    }
}

/// The class in words.
pub(super) fn class_name(class: Class) -> &'static str {
    match class {
        Class::LieGroup => "holonomic, a Lie group",
        Class::Holonomic => "holonomic, with variable coefficients",
        Class::IncompleteLieGroup => "nonholonomic, an incomplete Lie group",
        Class::Nonholonomic => "nonholonomic, with variable coefficients",
        Class::Undecided => "not classified",
    }
}

pub(super) fn plural(count: usize, noun: &str) -> String {
    if count == 1 { format!("1 {noun}") } else { format!("{count} {noun}s") }
}
