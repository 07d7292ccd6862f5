//! Rotations of bodies as unit quaternions.

/// A rotation `v -> q v q*` by a unit quaternion `w, x, y, z`, from body axes to the world's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Turn(pub(super) [f64; 4]);

/// The most that rows of a matrix may be off from being orthonormal: a tenth, far more than what integration leaves.
const MOST_OFF: f64 = 0.1;

impl Turn {
    pub(super) const NONE: Self = Self([1.0, 0.0, 0.0, 0.0]);

    /// Creates a turn by an angle about an axis of any length but zero, which is no turn.
    pub(super) fn about(axis: [f64; 3], angle: f64) -> Self {
        let length = norm(axis);
        if length == 0.0 {
            return Self::NONE;
        }
        let (s, c) = (angle / 2.0).sin_cos();
        let part = s / length;
        // Of an axis that is as short as numbers are, the quotient would overflow.
        let [x, y, z] = if part.is_finite() { axis.map(|e| e * part) } else { axis.map(|e| e / length * s) };
        Self([c, x, y, z])
    }

    /// The turn whose matrix, row by row, is a positive multiple of this one; what is no turn, as a reflection or a shear, makes something
    /// that is not finite.
    ///
    /// Of the four formulas by the trace and the diagonal, the one that divides by the largest component (Shepperd 1978).
    pub(super) fn from_matrix(m: &[[f64; 3]; 3]) -> Self {
        // A quaternion that drifted off the unit sphere declares |q|^2 R.
        let scale = f64::cbrt(determinant(m));
        let m = m.map(|row| row.map(|e| e / scale));
        let product = |i: usize, j: usize| (0..3).map(|k| m[i][k] * m[j][k]).sum::<f64>();
        let is_off = |i: usize, j: usize| (product(i, j) - f64::from(u8::from(i == j))).abs() > MOST_OFF;
        if scale <= 0.0 || (0..3).any(|i| (0..=i).any(|j| is_off(i, j))) {
            return Self([f64::NAN; 4]);
        }
        let [[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]] = m;
        let four_squares = [1.0 + xx + yy + zz, 1.0 + xx - yy - zz, 1.0 - xx + yy - zz, 1.0 - xx - yy + zz];
        let columns = [
            [four_squares[0], zy - yz, xz - zx, yx - xy],
            [zy - yz, four_squares[1], xy + yx, xz + zx],
            [xz - zx, xy + yx, four_squares[2], yz + zy],
            [yx - xy, xz + zx, yz + zy, four_squares[3]],
        ];
        let largest = (0..4).fold(0, |best, k| if four_squares[k] > four_squares[best] { k } else { best });
        Self(columns[largest]).normalized()
    }

    /// The shortest turn from the direction of `z` to another one.
    pub(super) fn from_z(to: [f64; 3]) -> Self {
        let [x, y, z] = to;
        match norm(to) {
            0.0 => Self::NONE,
            _ if x == 0.0 && y == 0.0 => {
                if z < 0.0 {
                    Self([0.0, 1.0, 0.0, 0.0])
                } else {
                    Self::NONE
                }
            }
            _ => Self::about([-y, x, 0.0], x.hypot(y).atan2(z)),
        }
    }

    /// Returns this turn after another.
    pub(super) fn times(self, other: Self) -> Self {
        let ([a, b, c, d], [w, x, y, z]) = (self.0, other.0);
        Self([
            a * w - b * x - c * y - d * z,
            a * x + b * w + c * z - d * y,
            a * y - b * z + c * w + d * x,
            a * z + b * y - c * x + d * w,
        ])
    }

    /// Returns a vector, turned.
    pub(super) fn applied(self, v: [f64; 3]) -> [f64; 3] {
        // v + 2 w (u x v) + 2 u x (u x v), for the vector part u.
        let [w, x, y, z] = self.0;
        let cross = |[a, b, c]: [f64; 3]| [y * c - z * b, z * a - x * c, x * b - y * a];
        let once = cross(v);
        let twice = cross(once);
        std::array::from_fn(|i| v[i] + 2.0 * (w * once[i] + twice[i]))
    }

    /// The product of two turns as vectors of four numbers: the cosine of half the angle between them.
    pub(super) fn dot(self, other: Self) -> f64 {
        let ([a, b, c, d], [w, x, y, z]) = (self.0, other.0);
        a * w + b * x + c * y + d * z
    }

    pub(super) fn normalized(self) -> Self {
        let length = self.0.iter().map(|e| e * e).sum::<f64>().sqrt();
        Self(self.0.map(|e| e / length))
    }

    /// The cosine of half the angle between two turns.
    #[cfg(test)]
    pub(super) fn nearness(self, other: Self) -> f64 {
        self.0.iter().zip(other.0).map(|(a, b)| a * b).sum::<f64>().abs()
    }

    /// The angle between two turns.
    #[cfg(test)]
    pub(super) fn angle(self, other: Self) -> f64 {
        // Without the loss of digits of an arc cosine near one.
        4.0 * (self.chord(other) / 2.0).min(1.0).asin()
    }

    /// The distance of two turns as quaternions: half the angle between them where that is small.
    #[cfg(test)]
    pub(super) fn chord(self, other: Self) -> f64 {
        let square = |sign: f64| self.0.iter().zip(other.0).map(|(a, b)| (a - sign * b).powi(2)).sum::<f64>();
        square(1.0).min(square(-1.0)).sqrt()
    }

    pub(super) fn is_finite(self) -> bool {
        self.0.iter().all(|e| e.is_finite())
    }
}

pub(super) fn norm([x, y, z]: [f64; 3]) -> f64 {
    let square = x * x + y * y + z * z;
    // Where the squares neither vanish nor overflow; a million vectors are then a matter of milliseconds.
    if (1e-280..1e280).contains(&square) { square.sqrt() } else { x.hypot(y).hypot(z) }
}

fn determinant([a, b, c]: &[[f64; 3]; 3]) -> f64 {
    let minor = |i: usize, j: usize| b[i] * c[j] - b[j] * c[i];
    a[0] * minor(1, 2) - a[1] * minor(0, 2) + a[2] * minor(0, 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The matrix of a turn, by the formula for `q v q*`.
    fn matrix(turn: Turn) -> [[f64; 3]; 3] {
        let [w, x, y, z] = turn.0;
        [
            [w * w + x * x - y * y - z * z, 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
            [2.0 * (x * y + w * z), w * w - x * x + y * y - z * z, 2.0 * (y * z - w * x)],
            [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), w * w - x * x - y * y + z * z],
        ]
    }

    fn apply(turn: Turn, v: [f64; 3]) -> [f64; 3] {
        matrix(turn).map(|row| row.iter().zip(v).map(|(a, b)| a * b).sum())
    }

    fn assert_near(a: [f64; 3], b: [f64; 3]) {
        assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-14), "{a:?} and {b:?}");
    }

    #[test]
    fn a_quarter_about_z_takes_x_to_y() {
        let quarter = Turn::about([0.0, 0.0, 2.0], std::f64::consts::FRAC_PI_2);
        assert_near(apply(quarter, [1.0, 0.0, 0.0]), [0.0, 1.0, 0.0]);
        let then = quarter.times(Turn::about([1.0, 0.0, 0.0], std::f64::consts::FRAC_PI_2));
        // First about the body's x, then about the world's z.
        assert_near(apply(then, [0.0, 1.0, 0.0]), [0.0, 0.0, 1.0]);
        assert_near(apply(then, [1.0, 0.0, 0.0]), [0.0, 1.0, 0.0]);
    }

    #[test]
    fn matrices_give_their_turn_back_whatever_their_size() {
        for k in 0..200 {
            let k = f64::from(k);
            let turn = Turn::about([k.sin(), (2.0 * k).cos(), (3.0 * k + 1.0).sin()], 0.1 * k - 9.0);
            for scale in [1.0, 0.25, 9.0] {
                let found = Turn::from_matrix(&matrix(turn).map(|row| row.map(|e| scale * e)));
                assert!((found.nearness(turn) - 1.0).abs() < 1e-14, "{turn:?} and {found:?}");
            }
        }
        // Half turns, where the trace is least.
        for axis in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] {
            let half = Turn::about(axis, std::f64::consts::PI);
            assert!(Turn::from_matrix(&matrix(half)).nearness(half) > 1.0 - 1e-15);
        }
        for none in [
            [[0.0; 3]; 3],
            // A mirror, a shear, a stretch, and no numbers.
            [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]],
            [[1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            [[2.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            [[f64::NAN; 3]; 3],
        ] {
            assert!(!Turn::from_matrix(&none).is_finite(), "{none:?}");
        }
        // A matrix that integration errors have made a little oblique is still drawn.
        let drifted = [[1.0, 0.03, 0.0], [0.0, 0.99, 0.0], [0.0, 0.0, 1.02]];
        assert!(Turn::from_matrix(&drifted).is_finite());
    }

    #[test]
    fn z_is_taken_to_any_direction() {
        for to in [[1.0, 2.0, -3.0], [0.0, 0.0, -2.0], [0.0, 0.0, 5.0], [-1e-9, 0.0, 1.0], [0.0, 1.0, 0.0]] {
            let length = norm(to);
            assert_near(apply(Turn::from_z(to), [0.0, 0.0, 1.0]), to.map(|e| e / length));
        }
        assert_eq!(Turn::from_z([0.0; 3]), Turn::NONE);
    }
}
