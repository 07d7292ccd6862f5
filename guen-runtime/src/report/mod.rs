//! The derivation, as constants of text, and written as text, Markdown or LaTeX; the operations that a program takes.

pub(crate) mod cost;
mod latex;
mod markdown;

use core::fmt;

pub use latex::LatexDocument;
pub use markdown::MarkdownDocument;

/// Headings with lines: coordinates, forms, operators, brackets, classification, equations of motion, domain, cost.
///
/// Generated systems have it as `REPORT`; as text by `Display`, as [`markdown`](Report::markdown), or as a
/// [`latex`](Report::latex) document. `LATEX` is another one whose lines are the formulas of the first as LaTeX.
///
/// ```
/// use guen_runtime::{Report, ReportSection};
/// const REPORT: Report = Report {
///     name: "Pendulum",
///     summary: "1 coordinate, 1 degree of freedom, 0 constraints: holonomic, a Lie group.",
///     sections: &[ReportSection {
///         title: "Operators",
///         lines: &["X1 = d/dphi"],
///         formulas: &[r"X_{1} = \frac{\partial}{\partial \phi}"],
///     }],
/// };
/// assert_eq!(REPORT.lines("Operators"), ["X1 = d/dphi"]);
/// assert!(REPORT.to_string().ends_with("Operators\n  X1 = d/dphi\n"));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Report {
    /// The system's name.
    pub name: &'static str,
    /// A sentence that sums up the system.
    pub summary: &'static str,
    /// The sections in order.
    pub sections: &'static [ReportSection],
}

/// A heading and its lines: formulas first, then words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ReportSection {
    /// The heading of the lines.
    pub title: &'static str,
    /// The lines.
    pub lines: &'static [&'static str],
    /// The first of these lines, those that are formulas, as LaTeX mathematics without delimiters.
    pub formulas: &'static [&'static str],
}

impl ReportSection {
    /// The lines that are no formulas.
    fn words(&self) -> &'static [&'static str] {
        self.lines.get(self.formulas.len()..).unwrap_or(&[])
    }
}

impl Report {
    /// The sections at these places, with their formulas as their lines.
    #[doc(hidden)]
    pub const fn of_formulas<const N: usize>(&self, places: [usize; N]) -> [ReportSection; N] {
        let mut sections = [ReportSection { title: "", lines: &[], formulas: &[] }; N];
        let mut i = 0;
        while i < N {
            let section = self.sections[places[i]];
            sections[i] = ReportSection { lines: section.formulas, ..section };
            i += 1;
        }
        sections
    }

    /// The lines of the first section whose title begins with these words; none if there is no such section.
    pub fn lines(&self, title: &str) -> &'static [&'static str] {
        self.sections
            .iter()
            .find(|section| section.title.starts_with(title))
            .map_or(&[], |section| section.lines)
    }

    /// The report as Markdown: headings, formulas between `$$` as GitHub, mdBook with MathJax, and notebooks set them, and
    /// lists. `level` is that of the first heading, from 1 to 5.
    ///
    /// ```
    /// # use guen_runtime::{Report, ReportSection};
    /// # const OPERATORS: ReportSection =
    /// #     ReportSection { title: "Operators", lines: &["X1 = d/dphi"], formulas: &["X_{1}"] };
    /// # const REPORT: Report = Report { name: "Pendulum", summary: "One angle.", sections: &[OPERATORS] };
    /// assert_eq!(
    ///     REPORT.markdown(2).to_string(),
    ///     "## Pendulum\n\nOne angle.\n\n### Operators\n\n$$X_{1}$$\n",
    /// );
    /// ```
    pub fn markdown(&self, level: usize) -> MarkdownDocument<'_> {
        MarkdownDocument { report: self, level: level.clamp(1, 5) }
    }

    /// The report as a LaTeX document, which every LaTeX compiles with the package `amsmath`; names with letters that are
    /// neither Latin nor Greek need `lualatex` or `xelatex`. Long formulas are broken between their terms.
    ///
    /// ```
    /// # use guen_runtime::{Report, ReportSection};
    /// # const OPERATORS: ReportSection =
    /// #     ReportSection { title: "Operators", lines: &["X1 = d/dphi"], formulas: &["X_{1}"] };
    /// # const REPORT: Report = Report { name: "Pendulum", summary: "One angle.", sections: &[OPERATORS] };
    /// let document = REPORT.latex().to_string();
    /// assert!(document.starts_with("\\documentclass") && document.ends_with("\\end{document}\n"));
    /// // For a document of one's own: the sections alone.
    /// assert!(REPORT.latex().body().to_string().starts_with("\\section*{Pendulum}"));
    /// ```
    pub fn latex(&self) -> LatexDocument<'_> {
        LatexDocument { report: self, whole: true }
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}: {}", self.name, self.summary)?;
        for section in self.sections {
            writeln!(f, "\n{}", section.title)?;
            for line in section.lines {
                writeln!(f, "  {line}")?;
            }
        }
        Ok(())
    }
}
