//! Dimensions that are not all known: powers of unknown ones, found as sums show that two are equal.

use std::collections::BTreeMap;

use guen_symbolic::Rational;

use crate::syntax::Dimension;

/// A dimension times powers of unknown ones.
#[derive(Clone, Debug)]
pub(super) struct Partial {
    known: Dimension,
    unknown: BTreeMap<usize, Rational>,
}

impl From<Dimension> for Partial {
    fn from(known: Dimension) -> Self {
        Partial { known, unknown: BTreeMap::new() }
    }
}

impl Partial {
    /// The dimension of a number.
    pub(super) fn one() -> Self {
        Dimension::one().into()
    }

    /// The product with a power of another.
    pub(super) fn times(&self, other: &Partial, power: &Rational) -> Self {
        let mut product = self.clone();
        product.known = product.known.times(&other.known, power);
        for (name, own) in &other.unknown {
            let sum = product.unknown.remove(name).unwrap_or_default() + own * power;
            if !sum.is_zero() {
                product.unknown.insert(*name, sum);
            }
        }
        product
    }

    /// A power.
    pub(super) fn raised(&self, power: &Rational) -> Self {
        Partial::one().times(self, power)
    }

    /// The dimension, if nothing in it is unknown.
    pub(super) fn known(&self) -> Option<&Dimension> {
        self.unknown.is_empty().then_some(&self.known)
    }
}

/// The unknown dimensions of a declaration, as far as they are found.
#[derive(Default)]
pub(super) struct Unknowns(Vec<Option<Partial>>);

impl Unknowns {
    /// One that nothing is known of.
    pub(super) fn fresh(&mut self) -> Partial {
        self.0.push(None);
        let name = self.0.len() - 1;
        Partial { known: Dimension::one(), unknown: BTreeMap::from([(name, Rational::integer(1))]) }
    }

    /// Returns a dimension with all that is found written in.
    pub(super) fn resolved(&self, partial: &Partial) -> Partial {
        let mut resolved = partial.clone();
        while let Some((name, found)) =
            resolved.unknown.keys().find_map(|name| Some((*name, self.0[*name].as_ref()?)))
        {
            let power = resolved.unknown.remove(&name).unwrap_or_default();
            resolved = resolved.times(found, &power);
        }
        resolved
    }

    /// Makes two dimensions equal; both as they are known where they cannot be.
    pub(super) fn equal(&mut self, a: &Partial, b: &Partial) -> Result<(), Box<[Partial; 2]>> {
        let quotient = self.resolved(&a.times(b, &Rational::integer(-1)));
        let Some((name, power)) = quotient.unknown.iter().next().map(|(name, power)| (*name, power.clone()))
        else {
            return if quotient.known.is_one() {
                Ok(())
            } else {
                Err(Box::new([self.resolved(a), self.resolved(b)]))
            };
        };
        let mut rest = quotient;
        rest.unknown.remove(&name);
        // 1 = x^p * rest, so that x = rest^(-1/p).
        let exponent = power.recip().map_or(Rational::ZERO, |inverse| -inverse);
        self.0[name] = Some(rest.raised(&exponent));
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unknown_dimensions_follow_from_equal_ones() {
        let unit = |name: &str| Partial::from(Dimension::of_unit(name).unwrap());
        let two = Rational::integer(2);
        let mut unknowns = Unknowns::default();
        let (x, y) = (unknowns.fresh(), unknowns.fresh());
        // x^2 y = J and y = kg, so that x = m/s.
        unknowns.equal(&y.times(&x, &two), &unit("J")).unwrap();
        assert!(unknowns.resolved(&x).known().is_none());
        unknowns.equal(&y, &unit("kg")).unwrap();
        assert_eq!(unknowns.resolved(&x).known().unwrap().to_string(), "m/s");
        assert!(unknowns.equal(&x, &unit("m")).is_err());
        assert!(unknowns.equal(&x.times(&unit("s"), &Rational::integer(1)), &unit("m")).is_ok());
    }
}
