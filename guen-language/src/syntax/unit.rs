//! Units as written behind a name: products of powers of SI units.

use std::fmt;

use guen_symbolic::Rational;
use proc_macro2::Span;

/// The base units, in the order of [`Dimension`].
const BASE: [&str; 7] = ["kg", "m", "s", "A", "K", "mol", "cd"];

/// Units with names of their own: exponents of kg, m, s, A, K.
const DERIVED: [(&str, [i64; 5]); 15] = [
    ("N", [1, 1, -2, 0, 0]),
    ("J", [1, 2, -2, 0, 0]),
    ("W", [1, 2, -3, 0, 0]),
    ("Pa", [1, -1, -2, 0, 0]),
    ("Hz", [0, 0, -1, 0, 0]),
    ("rad", [0, 0, 0, 0, 0]),
    ("C", [0, 0, 1, 1, 0]),
    ("V", [1, 2, -3, -1, 0]),
    ("Ohm", [1, 2, -3, -2, 0]),
    ("S", [-1, -2, 3, 2, 0]),
    ("F", [-1, -2, 4, 2, 0]),
    ("H", [1, 2, -2, -2, 0]),
    ("Wb", [1, 2, -2, -1, 0]),
    ("T", [1, 0, -2, -1, 0]),
    ("deg", [0, 0, 0, 0, 0]),
];

/// The names that are shown beside the powers of base units, where they are one.
const SHOWN: [&str; 8] = ["N", "J", "W", "Pa", "V", "Ohm", "F", "H"];

/// A dimension: the powers of kg, m, s, A, K, mol and cd.
#[derive(Debug, Clone, PartialEq)]
pub struct Dimension(pub [Rational; 7]);

/// A unit behind the name of a constant, coordinate or input.
#[derive(Debug, Clone)]
pub struct Unit {
    /// Place of its first token.
    pub span: Span,
    /// The unit as written.
    pub text: String,
    /// The dimension that it has.
    pub dimension: Dimension,
    /// Whether the value is given in degrees.
    pub is_degrees: bool,
}

impl Dimension {
    /// The dimension of a number.
    pub fn one() -> Self {
        Dimension(std::array::from_fn(|_| Rational::ZERO))
    }

    /// The dimension of a unit by its name.
    pub fn of_unit(name: &str) -> Option<Self> {
        let mut powers = Dimension::one();
        if let Some(place) = BASE.iter().position(|base| *base == name) {
            powers.0[place] = Rational::integer(1);
            return Some(powers);
        }
        let (_, derived) = DERIVED.iter().find(|(own, _)| *own == name)?;
        for (power, own) in powers.0.iter_mut().zip(derived) {
            *power = Rational::integer(*own);
        }
        Some(powers)
    }

    /// The names of all units.
    pub fn names() -> impl Iterator<Item = &'static str> {
        BASE.into_iter().chain(DERIVED.iter().map(|(name, _)| *name))
    }

    /// The product with a power of another dimension.
    pub fn times(&self, other: &Dimension, power: &Rational) -> Self {
        Dimension(std::array::from_fn(|i| &self.0[i] + &(&other.0[i] * power)))
    }

    /// The name of a unit of its own, else the powers of base units.
    pub fn short(&self) -> String {
        let own = SHOWN.iter().find(|name| Dimension::of_unit(name).as_ref() == Some(self));
        own.map_or_else(|| self.powers(), |own| (*own).to_owned())
    }

    /// Whether it is that of a number.
    pub fn is_one(&self) -> bool {
        self.0.iter().all(Rational::is_zero)
    }
}

impl Dimension {
    /// The powers of base units, as `kg*m/s^2`.
    fn powers(&self) -> String {
        let part = |(base, power): (&str, Rational)| match power.to_i64_pair() {
            Some((1, 1)) => base.to_owned(),
            Some((n, 1)) => format!("{base}^{n}"),
            Some((n, d)) => format!("{base}^({n}/{d})"),
            None => base.to_owned(),
        };
        let powers = || BASE.into_iter().zip(self.0.iter().cloned());
        let above: Vec<String> =
            powers().filter(|(_, power)| !power.is_zero() && !power.is_negative()).map(part).collect();
        let below: Vec<String> =
            powers().filter(|(_, p)| p.is_negative()).map(|(base, p)| part((base, p.abs()))).collect();
        let above = if above.is_empty() { "1".to_owned() } else { above.join("*") };
        match &below[..] {
            [] => above,
            [only] => format!("{above}/{only}"),
            all => format!("{above}/({})", all.join("*")),
        }
    }
}

impl fmt::Display for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (powers, short) = (self.powers(), self.short());
        f.write_str(&powers)?;
        if short == powers { Ok(()) } else { write!(f, " ({short})") }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dimensions_are_written_as_powers_of_base_units() {
        for (unit, text) in [("N", "kg*m/s^2 (N)"), ("rad", "1"), ("Hz", "1/s"), ("Pa", "kg/(m*s^2) (Pa)")] {
            assert_eq!(Dimension::of_unit(unit).unwrap().to_string(), text);
        }
        let root = Dimension::one().times(&Dimension::of_unit("m").unwrap(), &Rational::new(1, 2));
        assert_eq!(root.to_string(), "m^(1/2)");
    }

    /// A volt is a watt by an ampere, and so on: every derived unit by others.
    #[test]
    fn derived_units_are_those_of_the_si() {
        let product = |parts: &[(&str, i64)]| {
            parts.iter().fold(Dimension::one(), |all, (unit, power)| {
                all.times(&Dimension::of_unit(unit).unwrap(), &Rational::integer(*power))
            })
        };
        for (unit, parts) in [
            ("J", &[("N", 1), ("m", 1)][..]),
            ("W", &[("J", 1), ("s", -1)]),
            ("Pa", &[("N", 1), ("m", -2)]),
            ("C", &[("A", 1), ("s", 1)]),
            ("V", &[("W", 1), ("A", -1)]),
            ("Ohm", &[("V", 1), ("A", -1)]),
            ("S", &[("Ohm", -1)]),
            ("F", &[("C", 1), ("V", -1)]),
            ("Wb", &[("V", 1), ("s", 1)]),
            ("H", &[("Wb", 1), ("A", -1)]),
            ("T", &[("Wb", 1), ("m", -2)]),
            ("N", &[("kg", 1), ("m", 1), ("s", -2)]),
        ] {
            assert_eq!(Dimension::of_unit(unit).unwrap(), product(parts), "{unit}");
        }
    }
}
