//! The front: the settings worth choosing among errors and costs.

/// The positions of the points `(error, cost)` that no other one beats: none is at most as large in both and smaller in
/// one. In the order of falling errors, so of rising costs; of equal points the first. Points that are not finite are
/// none.
///
/// ```
/// use guen_study::pareto_front;
/// let points = [(1e-3, 5.0), (1e-6, 9.0), (1e-3, 7.0), (1e-7, f64::NAN), (1e-5, 9.0)];
/// assert_eq!(pareto_front(&points), [0, 1]);
/// ```
pub fn pareto_front(points: &[(f64, f64)]) -> Vec<usize> {
    let finite = |i: &usize| points[*i].0.is_finite() && points[*i].1.is_finite();
    let mut order: Vec<usize> = (0..points.len()).filter(finite).collect();
    // By cost, then by error: each is on the front if it errs less than all that are cheaper.
    order.sort_by(|a, b| {
        let ((error_a, cost_a), (error_b, cost_b)) = (points[*a], points[*b]);
        cost_a.total_cmp(&cost_b).then(error_a.total_cmp(&error_b)).then(a.cmp(b))
    });
    let mut least = f64::INFINITY;
    order.retain(|i| {
        let better = points[*i].0 < least;
        least = least.min(points[*i].0);
        better
    });
    order
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn beats(a: (f64, f64), b: (f64, f64)) -> bool {
        a.0 <= b.0 && a.1 <= b.1 && a != b
    }

    proptest! {
        #[test]
        fn nothing_beats_the_front_and_the_front_beats_or_equals_the_rest(
            // Few different values, so that ties occur.
            points in prop::collection::vec((0_u8..12, 0_u8..12), 0..60)
        ) {
            let points: Vec<(f64, f64)> = points.iter().map(|&(e, c)| (f64::from(e), f64::from(c))).collect();
            let front = pareto_front(&points);
            for &i in &front {
                prop_assert!(!points.iter().any(|&other| beats(other, points[i])));
            }
            for (k, &point) in points.iter().enumerate() {
                let covered = front.iter().any(|&i| points[i] == point || beats(points[i], point));
                prop_assert!(front.contains(&k) || covered);
            }
            for pair in front.windows(2) {
                prop_assert!(points[pair[0]].0 > points[pair[1]].0 && points[pair[0]].1 < points[pair[1]].1);
            }
        }

        #[test]
        fn a_further_point_that_is_beaten_changes_nothing(
            points in prop::collection::vec((0.0_f64..1.0, 0.0_f64..1.0), 1..40),
            which in any::<prop::sample::Index>(),
        ) {
            let front = pareto_front(&points);
            let (error, cost) = points[which.index(points.len())];
            let mut more = points.clone();
            more.push((error + 0.1, cost + 0.1));
            prop_assert_eq!(front, pareto_front(&more));
        }
    }
}
