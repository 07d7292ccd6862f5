//! A report as Markdown.

use core::fmt::{self, Write};

use super::Report;

/// The document that [`Report::markdown`] displays.
#[derive(Clone, Copy, Debug)]
pub struct MarkdownDocument<'r> {
    pub(super) report: &'r Report,
    pub(super) level: usize,
}

const MARKS: &str = "######";

impl fmt::Display for MarkdownDocument<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Report { name, summary, sections } = self.report;
        write!(f, "{} ", &MARKS[..self.level])?;
        escaped(f, name)?;
        f.write_str("\n\n")?;
        escaped(f, summary)?;
        f.write_char('\n')?;
        for section in *sections {
            write!(f, "\n{} {}\n", &MARKS[..=self.level], section.title)?;
            for formula in section.formulas {
                write!(f, "\n$${formula}$$\n")?;
            }
            for (i, line) in section.words().iter().enumerate() {
                f.write_str(if i == 0 { "\n- " } else { "- " })?;
                escaped(f, line)?;
                f.write_char('\n')?;
            }
        }
        Ok(())
    }
}

/// A line of words, in which only `code` keeps its meaning.
fn escaped(f: &mut fmt::Formatter<'_>, line: &str) -> fmt::Result {
    let mut in_code = false;
    for c in line.chars() {
        in_code ^= c == '`';
        if !in_code && matches!(c, '\\' | '*' | '_' | '[' | ']' | '<' | '>' | '#' | '$' | '|' | '~') {
            f.write_char('\\')?;
        }
        f.write_char(c)?;
    }
    Ok(())
}
