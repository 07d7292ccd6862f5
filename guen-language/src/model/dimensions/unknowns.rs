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
pub(super) struct Unknowns {
    found: Vec<Option<Partial>>,
    /// Dimensions that are known from the beginning.
    elected: BTreeMap<usize, Dimension>,
    /// The dimensions that follow from each equation with one unknown, where nothing else is done with equations.
    votes: Option<BTreeMap<usize, Vec<(Dimension, usize)>>>,
}

impl Unknowns {
    /// Unknown dimensions of which some are known from the beginning.
    pub(super) fn elected(elected: BTreeMap<usize, Dimension>) -> Self {
        Unknowns { elected, ..Unknowns::default() }
    }

    /// Unknown dimensions that only collect what each equation says of them.
    pub(super) fn voting(elected: BTreeMap<usize, Dimension>) -> Self {
        Unknowns { elected, votes: Some(BTreeMap::new()), ..Unknowns::default() }
    }

    /// Returns the unknown dimensions that more equations agree on than on any other.
    pub(super) fn winners(self) -> BTreeMap<usize, Dimension> {
        let most = |(name, mut votes): (usize, Vec<(Dimension, usize)>)| {
            votes.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
            let is_tie = matches!(&votes[..], [(_, first), (_, second), ..] if first == second);
            votes.into_iter().next().filter(|_| !is_tie).map(|(own, _)| (name, own))
        };
        self.votes.unwrap_or_default().into_iter().filter_map(most).collect()
    }

    /// Returns a new dimension of which nothing is known.
    pub(super) fn fresh(&mut self) -> Partial {
        let name = self.found.len();
        self.found.push(self.elected.get(&name).cloned().map(Partial::from));
        Partial { known: Dimension::one(), unknown: BTreeMap::from([(name, Rational::integer(1))]) }
    }

    /// Returns a dimension with all that is found written in.
    pub(super) fn resolved(&self, partial: &Partial) -> Partial {
        let mut resolved = partial.clone();
        while let Some((name, found)) =
            resolved.unknown.keys().find_map(|name| Some((*name, self.found[*name].as_ref()?)))
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
            return if quotient.known.is_one() || self.votes.is_some() {
                Ok(())
            } else {
                Err(Box::new([self.resolved(a), self.resolved(b)]))
            };
        };
        let mut rest = quotient;
        rest.unknown.remove(&name);
        // 1 = x^p * rest, so that x = rest^(-1/p).
        let exponent = power.recip().map_or(Rational::ZERO, |inverse| -inverse);
        let own = rest.raised(&exponent);
        let Some(votes) = &mut self.votes else {
            self.found[name] = Some(own);
            return Ok(());
        };
        if let Some(own) = own.known() {
            let votes = votes.entry(name).or_default();
            match votes.iter_mut().find(|(other, _)| other == own) {
                Some((_, count)) => *count += 1,
                None => votes.push((own.clone(), 1)),
            }
        }
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
