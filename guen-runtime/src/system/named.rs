//! Names of the entries of a record.

/// A record of numbers whose entries have names, as the `State` of a declared system: the headers of tables, the labels of plots.
///
/// ```
/// use guen_runtime::Named;
///
/// struct Oscillation;
/// impl Named for Oscillation {
///     const NAMES: &'static [&'static str] = &["x", "v"];
/// }
/// assert_eq!(Oscillation::NAMES[1], "v");
/// ```
#[diagnostic::on_unimplemented(
    message = "the entries of `{Self}` have no names",
    note = "declared systems have a `State` with names; for other systems `Recording::new(&[..])` takes them"
)]
pub trait Named {
    /// The names of the entries, in order.
    const NAMES: &'static [&'static str];
}
