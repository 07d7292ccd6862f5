//! The median of repeated measurements, and how sure it is.

/// The median, and the interval between order statistics that it lies in with 95 percent: of `n` values as many as the
/// binomial distribution with `p = 1/2` has beyond 2.5 percent are left out on either side. With five values or fewer
/// the interval is all of them, and covers less. None without values.
///
/// ```
/// use guen_study::median_with_interval;
/// let mut values = [5.0, 1.0, 4.0, 2.0, 3.0, 6.0, 7.0, 9.0, 8.0];
/// assert_eq!(median_with_interval(&mut values), Some((5.0, (2.0, 8.0))));
/// assert_eq!(median_with_interval(&mut []), None);
/// ```
pub fn median_with_interval(values: &mut [f64]) -> Option<(f64, (f64, f64))> {
    if values.is_empty() {
        return None;
    }
    values.sort_by(f64::total_cmp);
    let n = values.len();
    // Of more than a thousand values the first probabilities are below the least number, and their logarithms are not.
    let mut logarithm = -(n as f64) * std::f64::consts::LN_2;
    let (mut below, mut out) = (logarithm.exp(), 0);
    while out + 1 < n / 2 {
        logarithm += ((n - out) as f64 / (out + 1) as f64).ln();
        let probability = logarithm.exp();
        if below + probability > 0.025 {
            break;
        }
        below += probability;
        out += 1;
    }
    let median = if n % 2 == 1 { values[n / 2] } else { 0.5 * (values[n / 2 - 1] + values[n / 2]) };
    Some((median, (values[out], values[n - 1 - out])))
}

#[cfg(test)]
mod tests {
    use super::median_with_interval;

    #[test]
    fn the_interval_of_31_values_leaves_nine_out_on_either_side() {
        // Tables of the sign test: 9 of 31 is the critical value at 5 percent, two-sided.
        let mut values: Vec<f64> = (0..31).rev().map(f64::from).collect();
        assert_eq!(median_with_interval(&mut values), Some((15.0, (9.0, 21.0))));
    }

    #[test]
    fn many_values_have_an_interval_too() {
        // The quantiles of the binomial distribution, by SciPy.
        for (n, out) in [(500, 227), (1000, 468), (1073, 503), (1075, 504), (2001, 956), (100_000, 49_689)] {
            let mut values: Vec<f64> = (0..n).map(f64::from).collect();
            let ends = (f64::from(out), f64::from(n - 1 - out));
            assert_eq!(median_with_interval(&mut values), Some((f64::from(n - 1) / 2.0, ends)));
        }
    }
}
