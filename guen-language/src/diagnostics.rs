//! Mistakes of a declaration: collected while a stage runs, reported together when it ends.
//!
//! A sink exists only inside [`collect`], and what it gathered leaves as a [`FaultReport`] beside the result, so no
//! path through a stage can lose a fault: nobody else can make or drop a [`Faults`]. Functions that could not do
//! their part return [`Reported`], which only a sink hands out; a failure without a message cannot be written.

use std::collections::BTreeSet;
use std::fmt;

use proc_macro2::{Span, TokenStream};
use quote::quote_spanned;

extern crate proc_macro;

/// The line that ends the last error of a declaration: where all of them are explained. Once, however many there are.
pub const POINTER: &str = "note: the book, under \"Errors\", has an example and a repair of every error";

/// A mistake of the user, at the smallest token that carries it.
#[derive(Debug, Clone)]
pub struct Fault {
    span: Span,
    message: String,
    notes: Vec<String>,
    helps: Vec<String>,
}

impl Fault {
    /// A mistake at a place. The message is one line that stands alone.
    pub fn new(span: Span, message: impl Into<String>) -> Self {
        Fault { span, message: message.into(), notes: Vec::new(), helps: Vec::new() }
    }

    /// Adds what to write instead.
    #[must_use]
    pub fn help(mut self, text: impl fmt::Display) -> Self {
        self.helps.push(format!("help: {text}"));
        self
    }

    /// Adds a fact that explains the mistake.
    #[must_use]
    pub fn note(mut self, text: impl fmt::Display) -> Self {
        self.notes.push(format!("note: {text}"));
        self
    }

    /// Adds the other place of a conflict, named by its line: stable Rust underlines one place per error.
    #[must_use]
    pub fn note_place(self, what: &str, place: Span) -> Self {
        self.note(format_args!("{what} at line {}", line_of(place)))
    }

    /// Returns the place of the mistake.
    pub fn span(&self) -> Span {
        self.span
    }

    /// Whether a name or a function is the mistake that nothing declares, or nothing so far.
    pub(crate) fn is_missing_name(&self) -> bool {
        let is_unknown =
            ["unknown name `", "unknown function `"].iter().any(|begin| self.message.starts_with(begin));
        is_unknown || self.message.ends_with("` is used before it is declared")
    }

    /// The message of the fault, in one line.
    pub fn message(&self) -> &str {
        &self.message
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)?;
        self.notes.iter().chain(&self.helps).try_for_each(|line| write!(f, "\n{line}"))
    }
}

/// Proof that a fault is in the sink. Only [`Faults`] makes it.
#[derive(Debug, Clone, Copy)]
pub struct Reported(());

/// The sink of a running stage.
#[derive(Debug)]
pub struct Faults {
    faults: Vec<Fault>,
    seen: BTreeSet<(String, String)>,
}

impl Faults {
    /// Takes a fault in. Of faults with the same place and text the first one stays; texts that differ in the indices of
    /// entries are one, so that a mistake in a loop is reported once.
    pub fn report(&mut self, fault: Fault) -> Reported {
        // `Span` cannot be compared; its debug text names the bytes and the macro it came through.
        if self.seen.insert((format!("{:?}", fault.span), without_indices(&fault.to_string()))) {
            self.faults.push(fault);
        }
        Reported(())
    }

    /// Runs a part of the stage and tells whether it was free of faults.
    pub fn part<T>(&mut self, part: impl FnOnce(&mut Faults) -> T) -> Result<T, Reported> {
        let before = self.faults.len();
        let result = part(self);
        if self.faults.len() == before { Ok(result) } else { Err(Reported(())) }
    }

    /// Takes in what an earlier stage or a part with a sink of its own has found.
    pub fn absorb(&mut self, report: FaultReport) {
        for fault in report.faults {
            self.report(fault);
        }
    }

    /// The proof for something that could not be done because of a fault that is in the sink already.
    pub fn reported_before(&self) -> Reported {
        debug_assert!(!self.faults.is_empty(), "a failure without a message");
        Reported(())
    }

    /// Adds a place to the faults that were reported since.
    pub fn note_since(&mut self, before: usize, what: &str, place: Span) {
        for fault in self.faults.iter_mut().skip(before) {
            *fault = fault.clone().note_place(what, place);
        }
    }

    /// Notes of the faults that were reported since for which values of loop variables they were found first.
    pub fn note_first(&mut self, before: usize, values: &str) {
        for fault in self.faults.iter_mut().skip(before) {
            if !fault.notes.iter().any(|note| note.starts_with(FIRST)) {
                fault.notes.push(format!("{FIRST}{values}"));
            }
        }
    }

    /// Names the instance in the faults that were reported since, which are mistakes in its component. Of one mistake that several
    /// instances show the first stays.
    pub fn of_instance(&mut self, before: usize, what: &str, place: Span) {
        self.keep_since(before, |_| true);
        self.note_since(before, what, place);
    }

    /// Keeps those of the faults that were reported since for which a condition holds, and which stand where none was before.
    pub fn keep_since(&mut self, before: usize, keep: impl Fn(&Fault) -> bool) {
        let at = |fault: &Fault| format!("{:?}", fault.span);
        let known: BTreeSet<String> = self.faults[..before].iter().map(at).collect();
        let mut index = 0;
        self.faults.retain(|fault| {
            index += 1;
            index <= before || !known.contains(&at(fault)) && keep(fault)
        });
    }

    /// Whether a fault at this place is in the sink.
    pub fn has_at(&self, place: Span) -> bool {
        let at = format!("{place:?}");
        self.faults.iter().any(|fault| format!("{:?}", fault.span) == at)
    }

    /// The faults so far, in the order in which they were found.
    pub(crate) fn found(&self) -> &[Fault] {
        &self.faults
    }

    /// Number of faults so far.
    pub fn count(&self) -> usize {
        self.faults.len()
    }
}

/// The beginning of the note that says for which entry of a loop a fault was found.
const FIRST: &str = "note: found first for ";

/// A text with nothing between the brackets of its names.
fn without_indices(text: &str) -> String {
    let mut kept = String::with_capacity(text.len());
    let mut depth = 0_usize;
    for letter in text.chars() {
        depth = depth.saturating_sub(usize::from(letter == ']'));
        if depth == 0 {
            kept.push(letter);
        }
        depth += usize::from(letter == '[');
    }
    kept
}

/// Runs a stage with an empty sink. The only way to get one.
pub fn collect<T>(stage: impl FnOnce(&mut Faults) -> T) -> (T, FaultReport) {
    let mut faults = Faults { faults: Vec::new(), seen: BTreeSet::new() };
    let result = stage(&mut faults);
    let mut faults = faults.faults;
    // Where the compiler tells places; faults of one place stay in the order in which they were found.
    faults.sort_by_key(|fault| position_of(fault.span));
    (result, FaultReport { faults })
}

/// Everything a stage found wrong, in the order of the places.
#[derive(Debug, Clone)]
#[must_use = "a report that is not emitted hides mistakes from the user"]
pub struct FaultReport {
    faults: Vec<Fault>,
}

impl FaultReport {
    /// Returns `true` if no fault was reported.
    pub fn is_empty(&self) -> bool {
        self.faults.is_empty()
    }

    /// The faults, in the order of their places.
    pub fn faults(&self) -> &[Fault] {
        &self.faults
    }

    /// Returns the faults at whose places another report has none.
    pub(crate) fn beside(&self, told: &FaultReport) -> FaultReport {
        let at = |fault: &Fault| format!("{:?}", fault.span);
        let known: BTreeSet<String> = told.faults.iter().map(at).collect();
        FaultReport {
            faults: self.faults.iter().filter(|fault| !known.contains(&at(fault))).cloned().collect(),
        }
    }

    /// Returns the message and the place of each fault, as the compiler shows them; the last one ends with
    /// [`POINTER`].
    pub fn errors(&self) -> impl Iterator<Item = (Span, String)> {
        let last = self.faults.len().saturating_sub(1);
        self.faults.iter().enumerate().map(move |(k, fault)| {
            let text = if k == last { format!("{fault}\n{POINTER}") } else { fault.to_string() };
            (fault.span, text)
        })
    }

    /// Returns one `compile_error!` item for each fault, at its place.
    pub fn to_compile_errors(&self) -> TokenStream {
        self.errors().map(|(span, text)| quote_spanned!(span=> ::core::compile_error! { #text })).collect()
    }
}

impl fmt::Display for FaultReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for fault in &self.faults {
            writeln!(f, "line {}: {fault}", line_of(fault.span))?;
        }
        Ok(())
    }
}

/// The line of a place.
pub fn line_of(span: Span) -> usize {
    position_of(span).0
}

/// The file of a place, inside a macro.
pub(crate) fn file_of(span: Span) -> Option<String> {
    proc_macro::is_available().then(|| span.unwrap().file())
}

/// Line and column of a place: from the compiler inside a macro, from the text outside of one.
pub(crate) fn position_of(span: Span) -> (usize, usize) {
    if proc_macro::is_available() {
        let span = span.unwrap();
        return (span.line(), span.column());
    }
    let start = span.start();
    (start.line, start.column)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_faults_are_merged_and_ordered_by_place() {
        let tokens: Vec<_> = "a b".parse::<TokenStream>().unwrap().into_iter().collect();
        let (a, b) = (tokens[0].span(), tokens[1].span());
        let (healthy, report) = collect(|faults| {
            faults.report(Fault::new(b, "second place"));
            faults.report(Fault::new(a, "first place").help("a repair").note("a fact"));
            faults.report(Fault::new(b, "second place"));
            faults.part(|_| 1).is_ok() && faults.part(|faults| faults.report(Fault::new(a, "x"))).is_err()
        });
        assert!(healthy);
        let texts: Vec<_> = report.faults().iter().map(ToString::to_string).collect();
        assert_eq!(texts, ["first place\nnote: a fact\nhelp: a repair", "x", "second place"]);
        let errors = report.to_compile_errors().to_string();
        assert_eq!(errors.matches("compile_error").count(), 3);
        assert!(errors.contains(":: core :: compile_error ! { \"x\" }"), "{errors}");
        // The book is named once, by the last.
        assert_eq!(errors.matches("the book").count(), 1);
        assert!(errors.contains("{ \"second place\\nnote: the book"), "{errors}");
    }
}
