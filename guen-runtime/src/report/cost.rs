//! The arithmetic of a straight-line program, counted when it was generated.

use core::fmt;
use core::ops::Add;

/// The number of operations of one evaluation, by kind.
///
/// The counts are those of the program as emitted; what rustc merges or reorders does not show here.
///
/// ```
/// use guen_runtime::Cost;
///
/// const COST: Cost = Cost { additions: 9, negations: 0, multiplications: 17, divisions: 1, roots: 0, calls: 2 };
/// assert_eq!(COST.total(), 29);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Cost {
    /// Additions and subtractions.
    pub additions: u32,
    /// Changes of sign.
    pub negations: u32,
    /// Multiplications.
    pub multiplications: u32,
    /// Divisions and reciprocals.
    pub divisions: u32,
    /// Square roots and higher roots.
    pub roots: u32,
    /// Calls of elementary functions; the sine and cosine of one angle are one call.
    pub calls: u32,
}

impl Cost {
    /// No operations.
    pub const ZERO: Self =
        Self { additions: 0, negations: 0, multiplications: 0, divisions: 0, roots: 0, calls: 0 };

    /// The counts in the order of the fields, as generated code states them.
    #[doc(hidden)]
    pub const fn of([additions, negations, multiplications, divisions, roots, calls]: [u32; 6]) -> Self {
        Self { additions, negations, multiplications, divisions, roots, calls }
    }

    /// Returns the number of all operations, each counted once.
    pub const fn total(self) -> u32 {
        self.additions + self.negations + self.multiplications + self.divisions + self.roots + self.calls
    }

    /// The cost of two programs, one after the other.
    pub const fn plus(self, other: Self) -> Self {
        Self {
            additions: self.additions + other.additions,
            negations: self.negations + other.negations,
            multiplications: self.multiplications + other.multiplications,
            divisions: self.divisions + other.divisions,
            roots: self.roots + other.roots,
            calls: self.calls + other.calls,
        }
    }
}

impl Add for Cost {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        self.plus(other)
    }
}

impl fmt::Display for Cost {
    /// Lists what occurs: `29 operations (9 additions, 17 multiplications, 1 division, 2 calls)`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let counts = [
            (self.additions, "addition"),
            (self.negations, "negation"),
            (self.multiplications, "multiplication"),
            (self.divisions, "division"),
            (self.roots, "root"),
            (self.calls, "call"),
        ];
        count(f, self.total(), "operation")?;
        let mut opening = " (";
        for (number, name) in counts.into_iter().filter(|(number, _)| *number > 0) {
            f.write_str(opening)?;
            count(f, number, name)?;
            opening = ", ";
        }
        if self.total() > 0 { f.write_str(")") } else { Ok(()) }
    }
}

fn count(f: &mut fmt::Formatter<'_>, number: u32, name: &str) -> fmt::Result {
    write!(f, "{number} {name}{}", if number == 1 { "" } else { "s" })
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::Cost;
    use std::string::ToString;

    #[test]
    fn display_lists_what_occurs() {
        let cost = Cost { additions: 9, negations: 0, multiplications: 17, divisions: 1, roots: 0, calls: 2 };
        let text = "29 operations (9 additions, 17 multiplications, 1 division, 2 calls)";
        assert_eq!(cost.to_string(), text);
        assert_eq!(Cost::ZERO.to_string(), "0 operations");
        assert_eq!((cost + cost).total(), 58);
    }
}
