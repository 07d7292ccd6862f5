//! A sketch of a distribution: counts of numbers in intervals whose length is a 128th of what is in them.
//!
//! The intervals are fixed by the bits of a double, so sketches merge by adding counts: in any order, with the same result.

/// The bits of the fraction that tell intervals apart: 128 of them between powers of two.
const FRACTION: u32 = 7;

/// Counts of sizes: those of consecutive intervals, from the first one that was met.
#[derive(Clone, Debug, Default, PartialEq)]
struct Sizes {
    first: u32,
    counts: Vec<u64>,
}

impl Sizes {
    fn add(&mut self, key: u32, count: u64) {
        self.room(key, 1)[0] += count;
    }

    /// The counts of so many intervals from this one on.
    fn room(&mut self, key: u32, length: usize) -> &mut [u64] {
        if self.counts.is_empty() {
            self.first = key;
        }
        if key < self.first {
            let missing = (self.first - key) as usize;
            self.counts.splice(0..0, std::iter::repeat_n(0, missing));
            self.first = key;
        }
        let place = (key - self.first) as usize;
        if place + length > self.counts.len() {
            self.counts.resize(place + length, 0);
        }
        &mut self.counts[place..place + length]
    }

    fn merge(&mut self, other: &Self) {
        let counted = |count: &u64| *count > 0;
        // Zeros at the ends are room that nothing was counted in.
        if let (Some(first), Some(last)) =
            (other.counts.iter().position(counted), other.counts.iter().rposition(counted))
        {
            let more = &other.counts[first..=last];
            let own = self.room(other.first + first as u32, more.len());
            own.iter_mut().zip(more).for_each(|(own, more)| *own += more);
        }
    }

    /// The intervals with counts, from the smallest sizes on.
    fn iter(&self) -> impl DoubleEndedIterator<Item = (u32, u64)> + '_ {
        let all = self.counts.iter().enumerate().map(|(place, count)| (self.first + place as u32, *count));
        all.filter(|(_, count)| *count > 0)
    }
}

/// The sketch of finite numbers.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Sketch {
    negative: Sizes,
    positive: Sizes,
}

impl Sketch {
    /// Forgets all numbers, and keeps the room for those that are like them.
    pub(super) fn clear(&mut self) {
        [&mut self.negative, &mut self.positive].into_iter().for_each(|sizes| sizes.counts.fill(0));
    }

    #[inline]
    pub(super) fn add(&mut self, x: f64) {
        let key = (x.abs().to_bits() >> (52 - FRACTION)) as u32;
        let sizes = if x < 0.0 { &mut self.negative } else { &mut self.positive };
        match sizes.counts.get_mut(key.wrapping_sub(sizes.first) as usize) {
            Some(count) => *count += 1,
            None => sizes.add(key, 1),
        }
    }

    pub(super) fn merge(&mut self, other: &Self) {
        self.negative.merge(&other.negative);
        self.positive.merge(&other.positive);
    }

    /// The middle of the interval in which the number of this rank lies, counted from one.
    pub(super) fn ranked(&self, rank: u64) -> Option<f64> {
        let middle = |key: u32| {
            let end = |key: u32| f64::from_bits(u64::from(key) << (52 - FRACTION));
            // The last interval ends at infinity.
            let upper = if end(key + 1).is_finite() { end(key + 1) } else { f64::MAX };
            end(key) / 2.0 + upper / 2.0
        };
        let negative = self.negative.iter().rev().map(|(key, count)| (-middle(key), count));
        let positive = self.positive.iter().map(|(key, count)| (middle(key), count));
        let mut below = 0;
        negative.chain(positive).find_map(|(middle, count)| {
            below += count;
            (below >= rank).then_some(middle)
        })
    }

    /// The counts as text: intervals of negative numbers, then of the others.
    pub(super) fn text(&self) -> String {
        let text = |sizes: &Sizes| {
            let pairs: Vec<String> = sizes.iter().map(|(key, count)| format!("{key}:{count}")).collect();
            if pairs.is_empty() { "-".to_owned() } else { pairs.join(",") }
        };
        format!("{} {}", text(&self.negative), text(&self.positive))
    }

    /// Parses the text that [`text`](Self::text) writes.
    pub(super) fn parse(text: &str) -> Option<Self> {
        let read = |text: &str| {
            let mut sizes = Sizes::default();
            for pair in text.split(',').filter(|_| text != "-") {
                let (key, count) = pair.split_once(':')?;
                let key = key.parse().ok().filter(|key| *key < 1 << (11 + FRACTION))?;
                sizes.add(key, count.parse().ok()?);
            }
            Some(sizes)
        };
        let (negative, positive) = text.split_once(' ')?;
        Some(Self { negative: read(negative)?, positive: read(positive)? })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sweep::random::Philox;

    #[test]
    fn ranks_are_met_to_a_256th() {
        let random = Philox::new(8);
        let mut values: Vec<f64> = (0..5000)
            .map(|k| (random.unit(k, 0) - 0.4) * 10.0_f64.powf(20.0 * random.unit(k, 1) - 10.0))
            .chain([0.0, -0.0, f64::MAX, f64::MIN, 5e-324])
            .collect();
        let mut sketch = Sketch::default();
        values.iter().for_each(|x| sketch.add(*x));
        values.sort_by(f64::total_cmp);
        for rank in [1, 2, 100, 1999, 2500, 4000, 5005] {
            let (exact, found) = (values[rank - 1], sketch.ranked(rank as u64).unwrap());
            assert!((found - exact).abs() <= exact.abs() / 256.0 + 1e-300, "{rank}: {found} for {exact}");
        }
        assert_eq!(sketch.ranked(5006), None);
        assert_eq!(Sketch::parse(&sketch.text()), Some(sketch.clone()));
    }

    #[test]
    fn merging_is_counting_in_any_order() {
        let random = Philox::new(9);
        let values: Vec<f64> = (0..999).map(|k| 1.0 / (random.unit(k, 0) - 0.5)).collect();
        let mut all = Sketch::default();
        values.iter().for_each(|x| all.add(*x));
        let mut merged = Sketch::default();
        for part in values.chunks(100).rev() {
            let mut own = Sketch::default();
            part.iter().rev().for_each(|x| own.add(*x));
            merged.merge(&own);
        }
        assert_eq!(merged.text(), all.text());
    }
}
