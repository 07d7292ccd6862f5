//! Draws a declared body by itself: as the homogeneous solid that has its mass and its inertia.

use guen_runtime::Body;

use super::shape::Shape;
use super::turn::Turn;

/// The longest extent of a body whose size nothing tells, before the page fits it to the motion.
const UNKNOWN: f64 = 1.0;

/// Extents below this part of the longest one are drawn so.
const THINNEST: f64 = 0.04;

/// The homogeneous solid with the mass and inertia of a body.
///
/// Of the second moments `j_i = (I_1 + I_2 + I_3)/(2 m) - I_i/m`, along principal axes,
///
/// ```text
/// all equal: a ball of radius sqrt(5 j)
/// two equal: a cylinder of radius 2 sqrt(j_1) and length sqrt(12 j_3); a disc if j_3 = 0, a rod if j_1 = 0
/// else: a box with edges sqrt(12 j_i)
/// ```
///
/// so that every homogeneous body of these kinds looks like itself. What is in a plane and declares `diag(0, 0, I)` is a
/// disc. A hoop cannot be told from a disc of `sqrt(2)` times its radius. Without a mass, proportions are kept and the size
/// is chosen; without an inertia it is a small ball.
pub(super) fn drawing(body: &Body, small: f64) -> Shape {
    let Some(inertia) = body.inertia.filter(|entries| entries.iter().all(|e| e.is_finite())) else {
        return Shape::sphere(small);
    };
    let (moments, axes) = principal(inertia);
    let sum: f64 = moments.iter().sum();
    let mass = body.mass.filter(|m| *m > 0.0);
    let second = moments.map(|moment| (sum / 2.0 - moment).max(0.0) / mass.unwrap_or(1.0));
    let most = second.iter().copied().fold(0.0, f64::max);
    if !(most > 0.0 && most.is_finite()) {
        return Shape::sphere(small);
    }
    let second = match mass {
        Some(_) => second,
        // The longest edge of the box.
        None => second.map(|j| j / most * UNKNOWN * UNKNOWN / 12.0),
    };
    let most = second.iter().copied().fold(0.0, f64::max);
    let equal = |a: f64, b: f64| (a - b).abs() <= 1e-6 * most;
    let edge = |j: f64| (12.0 * j.max(THINNEST * THINNEST * most)).sqrt();
    if equal(second[0], second[1]) && equal(second[1], second[2]) {
        return Shape { turn: axes, ..Shape::sphere((5.0 * second[0]).sqrt()) };
    }
    // The axis of revolution, if there is one.
    let lone = (0..3).find(|&k| equal(second[(k + 1) % 3], second[(k + 2) % 3]));
    let Some(lone) = lone else {
        return Shape { turn: axes, ..Shape::cuboid(second.map(edge)) };
    };
    let radius = 2.0 * second[(lone + 1) % 3].max(THINNEST * THINNEST * most).sqrt();
    let to_lone = Turn::from_z(std::array::from_fn(|i| f64::from(u8::from(i == lone))));
    Shape { turn: axes.times(to_lone), ..Shape::cylinder(radius, edge(second[lone])) }
}

/// Principal moments, and the turn from principal axes to the body's, by Jacobi's rotations: each makes one entry beside
/// the diagonal zero, and the sum of their squares falls by that entry's.
fn principal([xx, yy, zz, xy, yz, zx]: [f64; 6]) -> ([f64; 3], Turn) {
    /// Convergence is quadratic; three by three are done after four or five rounds.
    const ROUNDS: usize = 20;
    let mut m = [[xx, xy, zx], [xy, yy, yz], [zx, yz, zz]];
    let mut axes = Turn::NONE;
    for _ in 0..ROUNDS {
        for (p, q) in [(0, 1), (1, 2), (0, 2)] {
            if m[p][q].abs() <= f64::EPSILON * (m[p][p].abs() + m[q][q].abs()) {
                continue;
            }
            let angle = 0.5 * f64::atan2(2.0 * m[p][q], m[p][p] - m[q][q]);
            let (s, c) = angle.sin_cos();
            // Q is the turn by `angle` from axis p to axis q: M becomes Q^T M Q.
            for row in &mut m {
                (row[p], row[q]) = (c * row[p] + s * row[q], c * row[q] - s * row[p]);
            }
            let (a, b) = (m[p], m[q]);
            for k in 0..3 {
                (m[p][k], m[q][k]) = (c * a[k] + s * b[k], c * b[k] - s * a[k]);
            }
            let normal = 3 - p - q;
            let sense = if (p + 1) % 3 == q { 1.0 } else { -1.0 };
            axes = axes
                .times(Turn::about(std::array::from_fn(|i| if i == normal { sense } else { 0.0 }), angle));
        }
    }
    (std::array::from_fn(|i| m[i][i]), axes)
}

#[cfg(test)]
mod tests {
    use super::super::shape::Kind;
    use super::*;

    fn body(mass: f64, inertia: [f64; 6]) -> Body {
        Body { name: "b", mass: Some(mass), inertia: Some(inertia), center: None, orientation: None }
    }

    fn diagonal(mass: f64, [a, b, c]: [f64; 3]) -> Body {
        body(mass, [a, b, c, 0.0, 0.0, 0.0])
    }

    fn assert_lengths(found: &[f64], expected: &[f64]) {
        assert!(
            found.len() == expected.len()
                && found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9 * b.abs()),
            "{found:?} and {expected:?}"
        );
    }

    #[test]
    fn homogeneous_bodies_look_like_themselves() {
        let m = 3.0;
        let r: f64 = 0.4;
        let ball = drawing(&diagonal(m, [0.4 * m * r * r; 3]), 0.1);
        assert!(matches!(ball.kind, Kind::Sphere(_)));
        assert_lengths(ball.kind.parts().1, &[r]);

        // A wheel about y, of thickness w.
        let w: f64 = 0.1;
        let across = m * (r * r / 4.0 + w * w / 12.0);
        let wheel = drawing(&diagonal(m, [across, m * r * r / 2.0, across]), 0.1);
        assert!(matches!(wheel.kind, Kind::Cylinder(_)));
        assert_lengths(wheel.kind.parts().1, &[r, w]);
        assert!(wheel.turn.nearness(Turn::from_z([0.0, 1.0, 0.0])) > 1.0 - 1e-12);

        let [a, b, c]: [f64; 3] = [0.5, 1.0, 2.0];
        let edges = [b * b + c * c, a * a + c * c, a * a + b * b].map(|s| m * s / 12.0);
        let box_ = drawing(&diagonal(m, edges), 0.1);
        assert!(matches!(box_.kind, Kind::Cuboid(_)));
        assert_lengths(box_.kind.parts().1, &[a, b, c]);

        // A thin rod along x: as long as it is, and thin.
        let rod = drawing(&diagonal(m, [0.0, m * c * c / 12.0, m * c * c / 12.0]), 0.1);
        assert_lengths(&rod.kind.parts().1[1..], &[c]);
        assert!(rod.turn.nearness(Turn::from_z([1.0, 0.0, 0.0])) > 1.0 - 1e-12);
    }

    #[test]
    fn a_body_in_a_plane_is_a_disc_in_it() {
        let (m, r) = (2.0, 0.7);
        let disc = drawing(&diagonal(m, [0.0, 0.0, m * r * r / 2.0]), 0.1);
        assert_lengths(&disc.kind.parts().1[..1], &[r]);
        assert_eq!(disc.turn, Turn::NONE);
    }

    #[test]
    fn principal_axes_are_found() {
        // diag(1, 2, 4) seen in axes turned by a known rotation.
        let turn = Turn::about([1.0, -2.0, 0.5], 0.9);
        let [w, x, y, z] = turn.0;
        let r = [
            [w * w + x * x - y * y - z * z, 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
            [2.0 * (x * y + w * z), w * w - x * x + y * y - z * z, 2.0 * (y * z - w * x)],
            [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), w * w - x * x - y * y + z * z],
        ];
        let entry = |i: usize, j: usize| (0..3).map(|k| r[i][k] * [1.0, 2.0, 4.0][k] * r[j][k]).sum::<f64>();
        let entries = [entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(1, 2), entry(2, 0)];
        let (moments, axes) = principal(entries);
        // The axes diagonalise, in whatever order: R' diag R'^T is the matrix again.
        let [w, x, y, z] = axes.0;
        let r = [
            [w * w + x * x - y * y - z * z, 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
            [2.0 * (x * y + w * z), w * w - x * x + y * y - z * z, 2.0 * (y * z - w * x)],
            [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), w * w - x * x - y * y + z * z],
        ];
        let again = |i: usize, j: usize| (0..3).map(|k| r[i][k] * moments[k] * r[j][k]).sum::<f64>();
        let again = [again(0, 0), again(1, 1), again(2, 2), again(0, 1), again(1, 2), again(2, 0)];
        assert!(entries.iter().zip(again).all(|(a, b)| (a - b).abs() < 1e-14), "{entries:?} and {again:?}");
        let mut sorted = moments;
        sorted.sort_by(f64::total_cmp);
        assert_lengths(&sorted, &[1.0, 2.0, 4.0]);
    }

    #[test]
    fn what_is_not_known_is_small_or_of_unit_size() {
        let nothing = Body { name: "n", mass: Some(1.0), inertia: None, center: None, orientation: None };
        assert_eq!(drawing(&nothing, 0.2), Shape::sphere(0.2));
        let massless = Body { mass: None, ..diagonal(1.0, [3.0, 4.0, 5.0]) };
        let edges = drawing(&massless, 0.1);
        let longest = edges.kind.parts().1.iter().copied().fold(0.0, f64::max);
        assert!((longest - UNKNOWN).abs() < 1e-12);
    }
}
