//! Elements of arrays as local variables.
//!
//! An index is an expression that the compiler looks up, checks and gives a branch of its own: `s[0]` costs it several times what `*s0` does.
//! So a body takes the arrays apart at its beginning. The variables are references: a value is read where it is used, which gives the
//! same machine code as indices do. Copies were read at the beginning, and a right-hand side took 2 to 3 percent more instructions.

use std::fmt::Write;
use std::ops::Range;

use crate::emit::thresholds::ELEMENTS_PER_INDEX;

/// The arrays that a body takes apart, with flags of the elements that it needs.
pub(super) struct Unpacked {
    arrays: Vec<(String, Vec<bool>)>,
}

impl Unpacked {
    /// Takes the elements among names of values; `length` is that of an array.
    pub(super) fn new<'a>(names: impl Iterator<Item = &'a str>, length: impl Fn(&str) -> usize) -> Self {
        let mut arrays: Vec<(String, Vec<bool>)> = Vec::new();
        for (array, index) in names.filter_map(indexed) {
            let place = arrays.iter().position(|(name, _)| name == array).unwrap_or_else(|| {
                arrays.push((array.to_owned(), vec![false; length(array)]));
                arrays.len() - 1
            });
            if let Some(needed) = arrays[place].1.get_mut(index) {
                *needed = true;
            }
        }
        arrays.retain(|(_, needed)| is_worth_it(needed));
        Unpacked { arrays }
    }

    /// Returns the local variable of an element; other names stay as they are.
    pub(super) fn local(&self, name: String) -> String {
        match indexed(&name) {
            Some((array, index)) if self.arrays.iter().any(|(other, _)| other == array) => {
                format!("*{array}{index}")
            }
            _ => name,
        }
    }

    /// The statements that define the variables; `place` says where an array is.
    pub(super) fn statements(&self, place: impl Fn(&str) -> String) -> String {
        let mut text = String::new();
        for (array, needed) in &self.arrays {
            let gap = longest_gap(needed);
            let parts = needed.iter().enumerate().filter_map(|(index, needed)| match needed {
                true => Some(format!("{array}{index}")),
                false if index == gap.start => Some("..".to_owned()),
                false if gap.contains(&index) => None,
                false => Some("_".to_owned()),
            });
            let parts: Vec<String> = parts.collect();
            let _ = write!(text, "let [{}] = {};", parts.join(","), place(array));
        }
        text
    }
}

/// The longest run of elements that nobody needs: a pattern can leave out one.
fn longest_gap(needed: &[bool]) -> Range<usize> {
    let mut longest = 0..0;
    let mut start = 0;
    for (index, needed) in needed.iter().enumerate() {
        if *needed {
            start = index + 1;
        } else if index + 1 - start > longest.len() {
            longest = start..index + 1;
        }
    }
    longest
}

/// Whether a pattern of an array costs the compiler less than indices: not where it names few of many elements.
fn is_worth_it(needed: &[bool]) -> bool {
    let count = needed.iter().filter(|needed| **needed).count();
    count * ELEMENTS_PER_INDEX >= needed.len() - longest_gap(needed).len()
}

/// The array and the index of an element as it is written.
pub(super) fn indexed(name: &str) -> Option<(&str, usize)> {
    let (array, index) = name.strip_suffix(']')?.split_once('[')?;
    Some((array, index.parse().ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(names: &[&str], length: usize) -> (String, Vec<String>) {
        let unpacked = Unpacked::new(names.iter().copied(), |_| length);
        let locals = names.iter().map(|name| unpacked.local((*name).to_owned())).collect();
        (unpacked.statements(|array| format!("self.{array}")), locals)
    }

    #[test]
    fn elements_that_are_needed_get_names() {
        let (statements, locals) = text(&["s[0]", "s[1]", "t"], 2);
        assert_eq!(statements, "let [s0,s1] = self.s;");
        assert_eq!(locals, ["*s0", "*s1", "t"]);
    }

    #[test]
    fn a_pattern_leaves_out_its_longest_gap() {
        assert_eq!(text(&["k[1]", "k[2]", "k[3]", "k[6]"], 9).0, "let [_,k1,k2,k3,..,k6,_,_] = self.k;");
        assert_eq!(longest_gap(&[true, false, true, false, false]), 3..5);
        assert_eq!(longest_gap(&[true, true]), 0..0);
    }

    #[test]
    fn few_of_many_elements_stay_indices() {
        let (statements, locals) = text(&["c[0]", "c[9]", "c[19]"], 30);
        assert_eq!(statements, "");
        assert_eq!(locals, ["c[0]", "c[9]", "c[19]"]);
    }
}
