//! Entries of long arrays, which generated code does not name one by one.

/// The names of the entries of an array, made by the compiler: a number between two words.
///
/// `N` entries, of at most `L` bytes.
///
/// ```
/// use guen_runtime::EntryNames;
/// const NAMES: &EntryNames<12, 5> = &EntryNames::new("q[", 0, "]");
/// assert_eq!((NAMES.get(0), NAMES.get(11)), ("q[0]", "q[11]"));
/// ```
#[doc(hidden)]
#[derive(Debug)]
pub struct EntryNames<const N: usize, const L: usize> {
    bytes: [[u8; L]; N],
    lengths: [usize; N],
}

impl<const N: usize, const L: usize> EntryNames<N, L> {
    /// The names of entries from the number `first` on.
    ///
    /// The compiler evaluates constants slowly, so a name is the one before it with its last digit counted on; only every
    /// tenth is written anew.
    #[must_use]
    pub const fn new(before: &str, first: usize, after: &str) -> Self {
        let mut names = EntryNames { bytes: [[0; L]; N], lengths: [0; N] };
        let mut entry = 0;
        while entry < N {
            let (mut name, length) = numbered(before, first + entry, after);
            let last = length - after.len() - 1;
            loop {
                names.bytes[entry] = name;
                names.lengths[entry] = length;
                entry += 1;
                if entry == N || name[last] == b'9' {
                    break;
                }
                name[last] += 1;
            }
        }
        names
    }

    /// The name of an entry.
    #[must_use]
    pub const fn get(&'static self, entry: usize) -> &'static str {
        match core::str::from_utf8(self.bytes[entry].split_at(self.lengths[entry]).0) {
            Ok(name) => name,
            Err(_) => "",
        }
    }
}

/// A number between two words, and the length of all three.
const fn numbered<const L: usize>(before: &str, mut number: usize, after: &str) -> ([u8; L], usize) {
    let mut digits = 1;
    let mut rest = number / 10;
    while rest > 0 {
        digits += 1;
        rest /= 10;
    }
    let length = before.len() + digits + after.len();
    let mut name = [0; L];
    let mut at = length;
    while at > 0 {
        at -= 1;
        name[at] = if at >= before.len() + digits {
            after.as_bytes()[at - before.len() - digits]
        } else if at >= before.len() {
            let digit = (number % 10) as u8;
            number /= 10;
            b'0' + digit
        } else {
            before.as_bytes()[at]
        };
    }
    (name, length)
}

/// A list of names in which some are those of the entries of an array, from a place on.
///
/// ```
/// use guen_runtime::{EntryNames, with_entries};
/// const NAMES: &EntryNames<2, 4> = &EntryNames::new("q[", 0, "]");
/// assert_eq!(with_entries(["x", "", ""], 1, NAMES), ["x", "q[0]", "q[1]"]);
/// ```
#[doc(hidden)]
#[must_use]
pub const fn with_entries<const N: usize, const L: usize, const ALL: usize>(
    mut names: [&'static str; ALL],
    from: usize,
    entries: &'static EntryNames<N, L>,
) -> [&'static str; ALL] {
    let mut entry = 0;
    while entry < N {
        names[from + entry] = entries.get(entry);
        entry += 1;
    }
    names
}

/// The values of an array, of which a file need not have all.
///
/// ```
/// use guen_runtime::entries;
/// assert_eq!(entries(&[Some(1.0), Some(2.0)]), Some([1.0, 2.0]));
/// assert_eq!(entries::<f64, 2>(&[Some(1.0), None]), None);
/// ```
#[doc(hidden)]
pub fn entries<R: Copy, const N: usize>(values: &[Option<R>]) -> Option<[R; N]> {
    let first = (*values.first()?)?;
    let mut all = [first; N];
    for (own, value) in all.iter_mut().zip(values) {
        *own = (*value)?;
    }
    Some(all)
}

/// A list of names: words, or places with words, and arrays with their places, lengths and the words around their numbers.
#[doc(hidden)]
#[macro_export]
macro_rules! names {
    ($all:literal $($name:literal)*) => { [$($name),*] };
    ($all:literal { $($at:literal $name:literal)* } $($from:literal $count:literal $length:literal $before:literal)*) => {{
        let mut names = [""; $all];
        $(names[$at] = $name;)*
        $(
            names = {
                const ENTRIES: &$crate::EntryNames<$count, $length> = &$crate::EntryNames::new($before, 0, "]");
                $crate::with_entries(names, $from, ENTRIES)
            };
        )*
        names
    }};
}

#[cfg(test)]
mod tests {
    extern crate std;
    use std::format;

    use super::EntryNames;

    #[test]
    fn names_carry_their_digits() {
        const FROM_ZERO: &EntryNames<1003, 7> = &EntryNames::new("q[", 0, "]");
        const FROM_ONE: &EntryNames<99, 11> = &EntryNames::new("particle ", 1, "");
        const WORDS: &EntryNames<2, 9> = &EntryNames::new("m[", 9, "] > 0");
        for entry in 0..1003 {
            assert_eq!(FROM_ZERO.get(entry), format!("q[{entry}]"));
        }
        for entry in 0..99 {
            assert_eq!(FROM_ONE.get(entry), format!("particle {}", entry + 1));
        }
        assert_eq!((WORDS.get(0), WORDS.get(1)), ("m[9] > 0", "m[10] > 0"));
    }
}
