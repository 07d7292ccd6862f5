//! Statistics of columns, computed while motions come and go: exact sums, counts and extremes, which merge in any order with the
//! same bits.

use std::fmt;

use super::block::{Block, Column};
use super::exact_sum::{ExactSum, Parts, UNIT};
use super::natural::Integer;
use super::scaled::{self, Scaled};
use super::sketch::Sketch;

/// Equal bins between two ends.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Bins {
    pub(super) column: usize,
    pub(super) low: f64,
    pub(super) high: f64,
    pub(super) count: usize,
}

/// The columns that statistics are of, by their places among those of a block: axes first, then kept values.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Plan {
    pub(super) columns: Vec<Column>,
    pub(super) places: Vec<usize>,
    pub(super) bins: Vec<Bins>,
    /// Rows at the same place of their motions have statistics of their own.
    pub(super) groups: usize,
}

/// Statistics of one column in one group.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct OfColumn {
    /// Finite values in rows of which another value is not finite: their number, sum, and sum of squares.
    pub(super) lone: u64,
    pub(super) lone_sum: Option<[ExactSum; 2]>,
    pub(super) not_finite: u64,
    /// The smallest and the largest value.
    pub(super) ends: Option<[f64; 2]>,
    pub(super) sketch: Sketch,
    /// Counts below the range, in each bin, and above, of the histogram where there is one.
    pub(super) bins: Vec<u64>,
}

/// Statistics of the rows at one place of their motions.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Group {
    /// Rows all of whose values are finite.
    pub(super) complete: u64,
    /// Over those: the sum of each column, and of the products of two, `(0, 0), (1, 0), (1, 1), (2, 0), ..`.
    pub(super) sums: Vec<ExactSum>,
    pub(super) products: Vec<ExactSum>,
    pub(super) columns: Vec<OfColumn>,
}

/// Means, covariances, quantiles and histograms of a sweep's columns.
///
/// Sums are exact, and rounded once, at the end: a mean, a variance and a covariance are the doubles nearest to those of the exact values.
/// Quantiles are good to a 256th, histograms and extremes are exact. All of it has the same bits in whatever order and parts the motions were
/// computed.
///
/// Rows of faulty motions do not count, nor do values that are not finite, such as the time of an event that did not happen: see
/// [`ColumnStatistics::not_finite`]. A covariance is over the rows all of whose values are finite.
#[derive(Clone, PartialEq)]
pub struct Statistics {
    pub(super) plan: Plan,
    pub(super) groups: Vec<Group>,
    pub(super) motions: u64,
    pub(super) faults: u64,
}

impl fmt::Debug for Statistics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let means = self.names().map(|name| (name, self.column(name).and_then(|of| of.mean())));
        f.debug_struct("Statistics")
            .field("motions", &self.motions)
            .field("faults", &self.faults)
            .field("means", &means.collect::<Vec<_>>())
            .finish_non_exhaustive()
    }
}

fn product(i: usize, j: usize) -> usize {
    let (i, j) = (i.max(j), i.min(j));
    i * (i + 1) / 2 + j
}

impl Statistics {
    pub(super) fn new(plan: Plan) -> Self {
        let width = plan.columns.len();
        let group = || {
            let bins = |column| {
                let own = plan.bins.iter().find(|bins| bins.column == column);
                own.map_or(Vec::new(), |bins| vec![0; bins.count + 2])
            };
            Group {
                complete: 0,
                sums: vec![ExactSum::default(); width],
                products: vec![ExactSum::default(); width * (width + 1) / 2],
                columns: (0..width)
                    .map(|column| OfColumn { bins: bins(column), ..OfColumn::default() })
                    .collect(),
            }
        };
        let groups = (0..plan.groups).map(|_| group()).collect();
        Self { plan, groups, motions: 0, faults: 0 }
    }

    /// Forgets all motions, and keeps the memory: whoever takes many blocks in turn allocates once.
    pub(super) fn clear(&mut self) {
        for Group { complete, sums, products, columns } in &mut self.groups {
            *complete = 0;
            sums.iter_mut().chain(products).for_each(ExactSum::clear);
            for OfColumn { lone, lone_sum, not_finite, ends, sketch, bins } in columns {
                (*lone, *lone_sum, *not_finite, *ends) = (0, None, 0, None);
                sketch.clear();
                bins.fill(0);
            }
        }
        (self.motions, self.faults) = (0, 0);
    }

    /// Counts the rows of a block of so many motions.
    pub(super) fn take(&mut self, block: &Block, motions: u64) {
        let Self { plan, groups, .. } = self;
        let axes = block.points.len();
        let columns: Vec<&[f64]> = plan
            .places
            .iter()
            .filter_map(|place| match place.checked_sub(axes) {
                None => block.points.get(*place),
                Some(kept) => block.kept.get(kept),
            })
            .map(Vec::as_slice)
            .collect();
        let mut faulty = block.faults.iter().map(|(row, _)| *row).peekable();
        let mut rows: Vec<Vec<u32>> = vec![Vec::new(); groups.len()];
        for row in 0..block.len() {
            if faulty.next_if_eq(&row).is_some() {
                continue;
            }
            let group = if groups.len() == 1 { 0 } else { block.places[row] as usize };
            if columns.iter().all(|column| column[row].is_finite()) {
                rows[group].push(row as u32);
            } else {
                groups[group].take_incomplete(&columns, row);
                groups[group].count(plan, &columns, row);
            }
        }
        for (group, rows) in groups.iter_mut().zip(&rows) {
            group.take(plan, &columns, rows);
        }
        self.motions += motions;
        self.faults += block.faults.len() as u64;
    }

    /// Adds the statistics of other motions.
    pub(super) fn merge(&mut self, other: &Self) {
        self.groups.iter_mut().zip(&other.groups).for_each(|(own, other)| own.merge(other));
        self.motions += other.motions;
        self.faults += other.faults;
    }

    /// The number of motions.
    pub fn motions(&self) -> u64 {
        self.motions
    }

    /// The number of motions that have failed.
    pub fn faults(&self) -> u64 {
        self.faults
    }

    /// The names of the columns that statistics are of.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.plan.columns.iter().map(|column| column.name.as_str())
    }

    /// The statistics of a column; none if there is no such column. Of samples at several times this is the first of them: see
    /// [`at`](Self::at).
    pub fn column(&self, name: &str) -> Option<ColumnStatistics<'_>> {
        self.at(0, name)
    }

    /// The statistics of a column in the rows at this place of their motions, as at the time with this number in samples.
    pub fn at(&self, place: usize, name: &str) -> Option<ColumnStatistics<'_>> {
        let column = self.place(name)?;
        self.groups.get(place).map(|group| ColumnStatistics { plan: &self.plan, group, column })
    }

    /// The covariance of two columns, that of `n - 1` degrees of freedom; none of fewer than two rows. Of samples it is that at the first time: see
    /// [`covariance_at`](Self::covariance_at).
    pub fn covariance(&self, first: &str, second: &str) -> Option<f64> {
        self.covariance_at(0, first, second)
    }

    /// The covariance in the rows at this place of their motions.
    pub fn covariance_at(&self, place: usize, first: &str, second: &str) -> Option<f64> {
        let (i, j) = (self.place(first)?, self.place(second)?);
        let group = self.groups.get(place)?;
        let sum = |place: usize| group.sums[place].integer();
        spread(group.complete, &group.products[product(i, j)].integer(), &sum(i), &sum(j))
    }

    /// The coefficient of correlation of two columns, between minus one and one; none of fewer than two rows, or of a column that does not vary.
    pub fn correlation(&self, first: &str, second: &str) -> Option<f64> {
        let both = self.covariance(first, second)?;
        let (a, b) = (self.covariance(first, first)?, self.covariance(second, second)?);
        let scale = a.sqrt() * b.sqrt();
        (scale > 0.0).then(|| (both / scale).clamp(-1.0, 1.0))
    }

    fn place(&self, name: &str) -> Option<usize> {
        self.plan.columns.iter().position(|column| column.name == name)
    }
}

/// `(sum of products - product of sums / n) / (n - 1)`, the double nearest to its exact value.
fn spread(count: u64, products: &Integer, first: &Integer, second: &Integer) -> Option<f64> {
    if count < 2 {
        return None;
    }
    // The product of two sums has the square of the unit.
    let digits = (-UNIT / 32) as usize;
    let difference = products.times_count(count).shifted(digits).minus(&first.times(second));
    Some(difference.quotient(2 * UNIT, &[count, count - 1]))
}

impl Group {
    /// Counts rows all of whose values are finite: column by column, so that what is added to stays near.
    fn take(&mut self, plan: &Plan, columns: &[&[f64]], rows: &[u32]) {
        self.complete += rows.len() as u64;
        let mut scaled: Vec<Scaled> = columns.iter().map(|_| Scaled::new()).collect();
        for rows in rows.chunks(scaled::ROWS) {
            for (scaled, column) in scaled.iter_mut().zip(columns) {
                scaled.take(rows.iter().map(|row| column[*row as usize]));
            }
            for (i, own) in scaled.iter().enumerate() {
                own.add_to(&mut self.sums[i]);
                for (other, sum) in scaled[..=i].iter().zip(&mut self.products[product(i, 0)..]) {
                    own.add_products_to(other, sum);
                }
            }
        }
        for (of, column) in self.columns.iter_mut().zip(columns) {
            rows.iter().for_each(|row| of.count(column[*row as usize]));
        }
        for bins in &plan.bins {
            let counts = &mut self.columns[bins.column].bins;
            rows.iter().for_each(|row| bins.count(counts, columns[bins.column][*row as usize]));
        }
    }

    /// Sums the finite values of a row that has others, too.
    fn take_incomplete(&mut self, columns: &[&[f64]], row: usize) {
        for (of, column) in self.columns.iter_mut().zip(columns) {
            let x = column[row];
            if x.is_finite() {
                of.lone += 1;
                let [sum, squares] = of.lone_sum.get_or_insert_default();
                sum.add(Parts::of(x));
                squares.add_product(Parts::of(x), Parts::of(x));
            } else {
                of.not_finite += 1;
            }
        }
    }

    /// Counts the finite values of a row.
    fn count(&mut self, plan: &Plan, columns: &[&[f64]], row: usize) {
        for (of, column) in self.columns.iter_mut().zip(columns) {
            if column[row].is_finite() {
                of.count(column[row]);
            }
        }
        for bins in plan.bins.iter().filter(|bins| columns[bins.column][row].is_finite()) {
            bins.count(&mut self.columns[bins.column].bins, columns[bins.column][row]);
        }
    }

    fn merge(&mut self, other: &Self) {
        self.complete += other.complete;
        self.sums.iter_mut().zip(&other.sums).for_each(|(sum, more)| sum.merge(more));
        self.products.iter_mut().zip(&other.products).for_each(|(sum, more)| sum.merge(more));
        for (own, other) in self.columns.iter_mut().zip(&other.columns) {
            own.lone += other.lone;
            if let Some([sum, squares]) = &other.lone_sum {
                let [own_sum, own_squares] = own.lone_sum.get_or_insert_default();
                own_sum.merge(sum);
                own_squares.merge(squares);
            }
            own.not_finite += other.not_finite;
            other.ends.iter().flatten().for_each(|x| widen(own.ends.get_or_insert([*x, *x]), *x));
            own.sketch.merge(&other.sketch);
            own.bins.iter_mut().zip(&other.bins).for_each(|(count, more)| *count += more);
        }
    }
}

impl OfColumn {
    #[inline]
    fn count(&mut self, x: f64) {
        widen(self.ends.get_or_insert([x, x]), x);
        self.sketch.add(x);
    }
}

/// Moves two ends out to `x`, in the total order of doubles: zeros with and without a sign differ in it. Otherwise the result would depend on the
/// order of the numbers, and on the processor.
#[inline]
pub(super) fn widen([low, high]: &mut [f64; 2], x: f64) {
    if x.total_cmp(low).is_lt() {
        *low = x;
    }
    if x.total_cmp(high).is_gt() {
        *high = x;
    }
}

impl Bins {
    /// The upper end of a bin, where the next one begins. Number zero is below the range.
    fn end(&self, k: usize) -> f64 {
        match k {
            0 => self.low,
            k if k >= self.count => self.high,
            k => self.low + (self.high - self.low) * (k as f64 / self.count as f64),
        }
    }

    #[inline]
    fn count(&self, counts: &mut [u64], x: f64) {
        let place = if x < self.low {
            0
        } else if x >= self.high {
            self.count + 1
        } else {
            let part = (x - self.low) / (self.high - self.low) * self.count as f64;
            let mut place = 1 + (part as usize).min(self.count - 1);
            // Of a number at an end, rounding may have made one beside it.
            while x < self.end(place - 1) {
                place -= 1;
            }
            while x >= self.end(place) {
                place += 1;
            }
            place
        };
        counts[place] += 1;
    }
}

/// Statistics of the values of one column.
#[derive(Clone, Copy, Debug)]
pub struct ColumnStatistics<'a> {
    plan: &'a Plan,
    group: &'a Group,
    column: usize,
}

impl ColumnStatistics<'_> {
    fn of(&self) -> &OfColumn {
        &self.group.columns[self.column]
    }

    /// The number of finite values.
    pub fn count(&self) -> u64 {
        self.group.complete + self.of().lone
    }

    /// The number of values that are infinite or no number: they enter nothing else.
    pub fn not_finite(&self) -> u64 {
        self.of().not_finite
    }

    /// The declared unit; empty where there is none.
    pub fn unit(&self) -> &str {
        &self.plan.columns[self.column].unit
    }

    /// The sums of the values and of their squares.
    fn sums(&self) -> [Integer; 2] {
        let (mut sum, mut squares) = (
            self.group.sums[self.column].clone(),
            self.group.products[product(self.column, self.column)].clone(),
        );
        if let Some([more, more_squares]) = &self.of().lone_sum {
            sum.merge(more);
            squares.merge(more_squares);
        }
        [sum.integer(), squares.integer()]
    }

    /// The mean: the double nearest to that of the exact values.
    pub fn mean(&self) -> Option<f64> {
        let [sum, _] = self.sums();
        (self.count() > 0).then(|| sum.quotient(UNIT, &[self.count()]))
    }

    /// The variance with `n - 1` degrees of freedom: the double nearest to that of the exact values. None of fewer than two values.
    pub fn variance(&self) -> Option<f64> {
        let [sum, squares] = self.sums();
        spread(self.count(), &squares, &sum, &sum)
    }

    /// The standard deviation, the root of the [`variance`](Self::variance).
    pub fn standard_deviation(&self) -> Option<f64> {
        self.variance().map(f64::sqrt)
    }

    /// The smallest value.
    pub fn minimum(&self) -> Option<f64> {
        self.of().ends.map(|[low, _]| low)
    }

    /// The largest value.
    pub fn maximum(&self) -> Option<f64> {
        self.of().ends.map(|[_, high]| high)
    }

    /// The value that this part of the values do not exceed, from zero to one, to a 256th of itself: that of rank `ceil(part n)`.
    pub fn quantile(&self, part: f64) -> Option<f64> {
        let [low, high] = self.of().ends?;
        let rank = (part * self.count() as f64).ceil().clamp(1.0, self.count() as f64);
        if part.is_nan() {
            return None;
        }
        if rank == 1.0 || rank == self.count() as f64 {
            return Some(if rank == 1.0 { low } else { high });
        }
        self.of().sketch.ranked(rank as u64).map(|found| found.clamp(low, high))
    }

    /// The bins of the column's histogram: the lower and the upper end of each with its count, of values that are not below the lower and
    /// below the upper one. The first one is below the range and the last one above. Empty where none was asked for.
    pub fn histogram(&self) -> Vec<(f64, f64, u64)> {
        let Some(bins) = self.plan.bins.iter().find(|bins| bins.column == self.column) else {
            return Vec::new();
        };
        let counts = self.of().bins.iter().enumerate();
        let ends = |k: usize| {
            let lower = if k == 0 { f64::NEG_INFINITY } else { bins.end(k - 1) };
            let upper = if k > bins.count { f64::INFINITY } else { bins.end(k) };
            (lower, upper)
        };
        counts.map(|(k, count)| (ends(k).0, ends(k).1, *count)).collect()
    }
}

#[cfg(test)]
mod tests {
    use num_bigint::BigInt;
    use num_rational::BigRational;

    use super::*;
    use crate::sweep::random::Philox;

    fn plan(columns: usize, groups: usize) -> Plan {
        let columns: Vec<Column> = (0..columns).map(|k| Column::new(k.to_string(), "")).collect();
        let places = (0..columns.len()).collect();
        let bins = vec![Bins { column: 0, low: -1.0, high: 1.0, count: 4 }];
        Plan { columns, places, bins, groups }
    }

    fn block(rows: &[[f64; 3]], first: u64) -> Block {
        let mut block = Block::new(1, 2);
        for (k, row) in rows.iter().enumerate() {
            if row[0] > 0.9 {
                let fault = Fault { time: None, cause: "far".to_owned() };
                block.push_fault(first + k as u64, &row[..1], fault);
            } else {
                block.push(first + k as u64, &row[..1], (k % 2) as u32, row[1..].iter().copied());
            }
        }
        block
    }

    use crate::sweep::block::Fault;

    fn rows(count: u64) -> Vec<[f64; 3]> {
        let random = Philox::new(6);
        let row = |k| {
            let [a, b, c] = [0, 1, 2].map(|axis| 2.0 * random.unit(k, axis) - 1.0);
            // A large offset: a sum of rounded squares would lose all digits of the second column's variance.
            [a, 1e9 + b, if c > 0.8 { f64::NAN } else { a * 1e-3 + c }]
        };
        (0..count).map(row).collect()
    }

    fn rational(x: f64) -> BigRational {
        BigRational::from_float(x).unwrap()
    }

    fn covariance(pairs: &[(f64, f64)]) -> f64 {
        let n = BigRational::from(BigInt::from(pairs.len()));
        let sum = |of: &dyn Fn(&(f64, f64)) -> BigRational| -> BigRational { pairs.iter().map(of).sum() };
        let (x, y) = (sum(&|pair| rational(pair.0)), sum(&|pair| rational(pair.1)));
        let xy = sum(&|pair| rational(pair.0) * rational(pair.1));
        let exact = (xy - x * y / &n) / (n - BigRational::from(BigInt::from(1)));
        num_traits::ToPrimitive::to_f64(&exact).unwrap()
    }

    #[test]
    fn moments_are_those_of_exact_fractions() {
        let rows = rows(300);
        let mut statistics = Statistics::new(plan(3, 1));
        statistics.take(&block(&rows, 0), 300);
        let good: Vec<&[f64; 3]> = rows.iter().filter(|row| row[0] <= 0.9).collect();
        assert_eq!((statistics.motions(), statistics.faults()), (300, 300 - good.len() as u64));
        for (column, name) in ["0", "1", "2"].into_iter().enumerate() {
            let values: Vec<f64> = good.iter().map(|row| row[column]).filter(|x| x.is_finite()).collect();
            let of = statistics.column(name).unwrap();
            assert_eq!(of.count(), values.len() as u64);
            assert_eq!(of.not_finite(), (good.len() - values.len()) as u64);
            let sum: BigRational = values.iter().map(|x| rational(*x)).sum();
            let mean = sum / BigRational::from(BigInt::from(values.len()));
            assert_eq!(of.mean(), num_traits::ToPrimitive::to_f64(&mean));
            let pairs: Vec<(f64, f64)> = values.iter().map(|x| (*x, *x)).collect();
            assert_eq!(of.variance(), Some(covariance(&pairs)));
            assert_eq!(of.minimum(), values.iter().copied().reduce(f64::min));
            assert_eq!(of.maximum(), values.iter().copied().reduce(f64::max));
            let mut sorted = values.clone();
            sorted.sort_by(f64::total_cmp);
            let median = sorted[sorted.len().div_ceil(2) - 1];
            assert!((of.quantile(0.5).unwrap() - median).abs() <= median.abs() / 256.0);
        }
        let complete: Vec<(f64, f64)> =
            good.iter().filter(|row| row[2].is_finite()).map(|row| (row[0], row[1])).collect();
        assert_eq!(statistics.covariance("0", "1"), Some(covariance(&complete)));
        assert_eq!(statistics.covariance("1", "0"), statistics.covariance("0", "1"));
        assert!(statistics.correlation("0", "2").is_some_and(|found| found.abs() < 0.2));
        assert_eq!(statistics.covariance("0", "x"), None);
        // Bins of the first column by counting.
        let histogram = statistics.column("0").unwrap().histogram();
        assert_eq!(histogram.len(), 6);
        for (low, high, count) in histogram {
            let inside = good.iter().filter(|row| row[0] >= low && row[0] < high).count();
            assert_eq!(count, inside as u64, "{low} to {high}");
        }
        assert!(statistics.column("1").unwrap().histogram().is_empty());
    }

    #[test]
    fn parts_in_any_order_have_the_same_bits() {
        for groups in [1, 2] {
            let rows = rows(250);
            let mut all = Statistics::new(plan(3, groups));
            all.take(&block(&rows, 0), 250);
            let mut merged = Statistics::new(plan(3, groups));
            // Parts of even length, so that places within motions are the same.
            for (k, part) in rows.chunks(38).enumerate().rev() {
                let mut own = Statistics::new(plan(3, groups));
                own.take(&block(part, 38 * k as u64), part.len() as u64);
                merged.merge(&own);
            }
            assert_eq!(merged.text(), all.text());
            assert_eq!(Statistics::parse(&plan(3, groups), &all.text()), Some(all));
        }
    }

    #[test]
    fn ends_do_not_depend_on_the_order_of_zeros() {
        for zeros in [[0.0, -0.0], [-0.0, 0.0]] {
            let mut ends = [zeros[0]; 2];
            widen(&mut ends, zeros[1]);
            assert_eq!(ends.map(f64::to_bits), [-0.0_f64, 0.0].map(f64::to_bits));
        }
    }

    #[test]
    fn a_number_at_an_end_is_in_the_bin_that_begins_there() {
        for (low, high, count) in [(-0.1, 0.7, 35), (0.0, 1.0, 49), (-3.0, 0.3, 1000), (1.0, 1.0 + 1e-15, 9)]
        {
            let bins = Bins { column: 0, low, high, count };
            for k in 0..count {
                let (x, next) = (bins.end(k), bins.end(k + 1));
                let mut counts = vec![0; count + 2];
                [x, next.next_down()].into_iter().for_each(|x| bins.count(&mut counts, x));
                // Bins of a few roundings may be empty.
                let expected = if x < next { (k + 1, 2) } else { (0, 0) };
                assert!(x == next || counts[expected.0] == expected.1, "{low} {high} {count}: {k}");
            }
        }
    }

    #[test]
    fn of_nothing_there_is_nothing() {
        let statistics = Statistics::new(plan(1, 1));
        let of = statistics.column("0").unwrap();
        assert_eq!((of.count(), of.mean(), of.variance(), of.quantile(0.5)), (0, None, None, None));
        assert_eq!((of.minimum(), of.maximum()), (None, None));
        assert_eq!(statistics.covariance("0", "0"), None);
    }
}
