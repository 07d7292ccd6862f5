//! Reduces a curve in picture coordinates to what can be seen of it.

/// Returns the first, the lowest, the highest and the last of successive points in one column of the given width, in
/// the order of the curve.
///
/// A dropped point lies between the lowest and the highest of its column, and the thinned line passes through
/// every height between them without leaving the column: so neither line is farther than the width from the
/// other.
pub(super) fn thin(points: &[(f64, f64)], width: f64) -> Vec<(f64, f64)> {
    let mut thinned = Vec::new();
    for run in points.chunk_by(|a, b| (a.0 / width).floor() == (b.0 / width).floor()) {
        let last = run.len() - 1;
        let by_height = |&i: &usize, &j: &usize| run[i].1.total_cmp(&run[j].1);
        let lowest = (0..=last).min_by(by_height).unwrap_or(0);
        let highest = (0..=last).max_by(by_height).unwrap_or(last);
        let mut kept = [0, lowest.min(highest), lowest.max(highest), last].to_vec();
        kept.dedup();
        thinned.extend(kept.into_iter().map(|i| run[i]));
    }
    thinned
}

#[cfg(test)]
mod tests {
    use super::thin;

    fn distance(p: (f64, f64), line: &[(f64, f64)]) -> f64 {
        line.windows(2)
            .map(|ends| {
                let (dx, dy) = (ends[1].0 - ends[0].0, ends[1].1 - ends[0].1);
                let length = dx * dx + dy * dy;
                let along = (p.0 - ends[0].0) * dx + (p.1 - ends[0].1) * dy;
                let s = if length > 0.0 { (along / length).clamp(0.0, 1.0) } else { 0.0 };
                f64::hypot(p.0 - ends[0].0 - s * dx, p.1 - ends[0].1 - s * dy)
            })
            .fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn extremes_and_ends_stay() {
        let mut points: Vec<(f64, f64)> = (0..100_000)
            .map(|k| f64::from(k) * 5e-3)
            .map(|x| (x, (40.0 * x).sin() * (1.0 + x / 500.0)))
            .collect();
        points[33_333].1 = 7.0;
        points[77_777].1 = -9.0;
        let thinned = thin(&points, 0.25);
        assert!(thinned.len() <= 4 * 2001, "{}", thinned.len());
        assert!(thinned.contains(&points[33_333]) && thinned.contains(&points[77_777]));
        assert_eq!((thinned.first(), thinned.last()), (points.first(), points.last()));
        let mut rest = points.iter();
        assert!(
            thinned.iter().all(|point| rest.any(|other| other == point)),
            "points of the curve, in its order"
        );
    }

    #[test]
    fn no_curve_leaves_the_other() {
        let rose: Vec<(f64, f64)> = (0..6000)
            .map(|k| f64::from(k) * 1e-3)
            .map(|s| (20.0 * (3.0 * s).cos() * s.cos(), 20.0 * (3.0 * s).cos() * s.sin()))
            .collect();
        let thinned = thin(&rose, 0.25);
        assert!(thinned.len() < rose.len() / 2);
        for point in &rose {
            assert!(distance(*point, &thinned) <= 0.25);
        }
        for ends in thinned.windows(2) {
            let middle = ((ends[0].0 + ends[1].0) / 2.0, (ends[0].1 + ends[1].1) / 2.0);
            assert!(distance(middle, &rose) <= 0.25);
        }
    }

    #[test]
    fn small_curves_stay_as_they_are() {
        assert_eq!(thin(&[], 1.0), []);
        let points = [(0.5, 1.0), (1.5, 0.0), (0.5, 3.0), (0.6, 3.0), (0.6, 3.0)];
        assert_eq!(thin(&points[..3], 1.0), points[..3]);
        assert_eq!(thin(&points[2..], 1.0).len(), 2);
    }
}
