//! What the macro derived, as constants of text.

use core::fmt;

/// Headings with lines: forms, operators, brackets, classification, equations of motion, cost.
///
/// Generated systems have two: `REPORT` as text and `LATEX` with the formulas as LaTeX.
///
/// ```
/// use guen_runtime::{Report, ReportSection};
/// const REPORT: Report = Report {
///     name: "Pendulum",
///     summary: "1 coordinate, 1 degree of freedom, 0 constraints: holonomic, a Lie group.",
///     sections: &[ReportSection { title: "Operators", lines: &["X1 = d/dphi"] }],
/// };
/// assert_eq!(REPORT.lines("Operators"), ["X1 = d/dphi"]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Report {
    /// The system's name.
    pub name: &'static str,
    /// One sentence.
    pub summary: &'static str,
    /// The sections in order.
    pub sections: &'static [ReportSection],
}

/// A heading and its lines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ReportSection {
    /// What the lines are.
    pub title: &'static str,
    /// The lines.
    pub lines: &'static [&'static str],
}

impl Report {
    /// The lines of the first section whose title begins with these words; none if there is no such section.
    pub fn lines(&self, title: &str) -> &'static [&'static str] {
        self.sections
            .iter()
            .find(|section| section.title.starts_with(title))
            .map_or(&[], |section| section.lines)
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
