//! Systems drawn as numbers: planar trees of links on a fixed or a floating base, and spatial ones with constant masses.

use guen_runtime::Lift;
use guen_runtime::hybrid::{Element, FreeMotion, HybridSystem, Signal};

use crate::bodies::Parts;

/// Numbers between minus one and one, from a seed.
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 11) as f64 / (1_u64 << 52) as f64) - 1.0
    }

    /// A number between two others.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * 0.5 * (self.next() + 1.0)
    }

    pub fn below(&mut self, count: usize) -> usize {
        (self.between(0.0, count as f64) as usize).min(count - 1)
    }
}

/// A form of the velocities, and the position of which it is the rate.
#[derive(Clone, Copy, Debug)]
pub enum Row {
    /// A point of a link, at a distance from its joint, along a direction.
    Point { link: usize, at: f64, along: [f64; 2] },
    /// The angle of a link, less that of its parent, with a sign.
    Angle { link: usize, sign: f64 },
    /// A constant combination of velocities, of which there are up to six.
    Constant([f64; 6]),
}

/// What is drawn: `D` velocities, `W` rows, `C` elements.
#[derive(Clone, Copy, Debug)]
pub struct Drawn<const D: usize, const W: usize, const C: usize> {
    /// The number of translations of the base, which come first: none or two.
    pub base: usize,
    /// The parents of links, by their velocities; itself for a root.
    pub parents: [usize; D],
    pub lengths: [f64; D],
    pub centers: [f64; D],
    pub masses: [f64; D],
    pub inertias: [f64; D],
    /// Torques against the angle and its rate relative to the parent.
    pub springs: [f64; D],
    pub dampers: [f64; D],
    /// A constant mass matrix in place of that of links.
    pub constant: Option<[[f64; D]; D]>,
    pub push: [f64; D],
    pub rows: [Row; W],
    /// The row of each element's gap, and the constant of the gap.
    pub gaps: [Option<(usize, f64)>; C],
    pub friction: [f64; C],
    pub limits: [f64; C],
    pub restitutions: [f64; C],
}

pub const GRAVITY: f64 = 9.81;

impl<const D: usize, const W: usize, const C: usize> Drawn<D, W, C> {
    /// The arms of a point of a link: how far each link carries it.
    fn arms(&self, link: usize, at: f64) -> [f64; D] {
        let mut arms = [0.0; D];
        arms[link] = at;
        let mut child = link;
        while self.parents[child] != child {
            child = self.parents[child];
            arms[child] = self.lengths[child];
        }
        arms
    }

    /// The place of a point, its Jacobian, and its acceleration without those of the coordinates.
    fn point<R: Lift<f64>>(
        &self,
        (q, v): (&[R; D], &[R; D]),
        (link, at): (usize, f64),
    ) -> ([R; 2], [[R; D]; 2], [R; 2]) {
        let zero = R::zero();
        let (mut place, mut jacobian, mut rest) = ([zero; 2], [[zero; D]; 2], [zero; 2]);
        for k in 0..self.base {
            place[k] = q[k];
            jacobian[k][k] = R::one();
        }
        let arms = self.arms(link, at);
        for k in self.base..D {
            if arms[k] != 0.0 {
                let (arm, (sin, cos)) = (R::lift(arms[k]), q[k].sin_cos());
                let (x, y) = (arm * cos, arm * sin);
                (place[0], place[1]) = (place[0] + x, place[1] + y);
                (jacobian[0][k], jacobian[1][k]) = (-y, x);
                let square = v[k] * v[k];
                (rest[0], rest[1]) = (rest[0] - x * square, rest[1] - y * square);
            }
        }
        (place, jacobian, rest)
    }

    /// The mass matrix, and the forces less the velocity terms.
    pub fn dynamics<R: Lift<f64>>(&self, q: &[R; D], v: &[R; D]) -> ([[R; D]; D], [R; D]) {
        let zero = R::zero();
        let (mut matrix, mut forces) = ([[zero; D]; D], self.push.map(R::lift));
        if let Some(constant) = self.constant {
            for k in 0..D {
                forces[k] -= R::lift(self.springs[k]) * q[k] + R::lift(self.dampers[k]) * v[k];
            }
            return (constant.map(|row| row.map(R::lift)), forces);
        }
        for link in self.base..D {
            let (_, jacobian, rest) = self.point((q, v), (link, self.centers[link]));
            let mass = R::lift(self.masses[link]);
            for i in 0..D {
                for j in 0..D {
                    matrix[i][j] +=
                        mass * (jacobian[0][i] * jacobian[0][j] + jacobian[1][i] * jacobian[1][j]);
                }
                let acceleration = [-rest[0], R::lift(-GRAVITY) - rest[1]];
                forces[i] += mass * (jacobian[0][i] * acceleration[0] + jacobian[1][i] * acceleration[1]);
            }
            matrix[link][link] += R::lift(self.inertias[link]);
            let parent = self.parents[link];
            let relative = |x: &[R; D]| if parent == link { x[link] } else { x[link] - x[parent] };
            let torque =
                R::lift(self.springs[link]) * relative(q) + R::lift(self.dampers[link]) * relative(v);
            forces[link] -= torque;
            if parent != link {
                forces[parent] += torque;
            }
        }
        (matrix, forces)
    }

    /// The value of a row's position, its coefficients, and its rate without accelerations.
    pub fn row<R: Lift<f64>>(&self, q: &[R; D], v: &[R; D], row: Row) -> (R, [R; D], R) {
        let zero = R::zero();
        match row {
            Row::Point { link, at, along } => {
                let (place, jacobian, rest) = self.point((q, v), (link, at));
                let [a, b] = along.map(R::lift);
                let along = |pair: [R; 2]| a * pair[0] + b * pair[1];
                let form = core::array::from_fn(|k| along([jacobian[0][k], jacobian[1][k]]));
                (along(place), form, along(rest))
            }
            Row::Angle { link, sign } => {
                let mut form = [zero; D];
                form[link] = R::lift(sign);
                if self.parents[link] != link {
                    form[self.parents[link]] = R::lift(-sign);
                }
                let value = form.iter().zip(q).fold(zero, |sum, (a, q)| sum + *a * *q);
                (value, form, zero)
            }
            Row::Constant(entries) => {
                let form: [R; D] = core::array::from_fn(|k| R::lift(entries[k]));
                let value = form.iter().zip(q).fold(zero, |sum, (a, q)| sum + *a * *q);
                (value, form, zero)
            }
        }
    }

    pub fn free<R: Lift<f64>, const N: usize>(&self, state: &[R; N]) -> FreeMotion<R, N, W, C> {
        let (q, v) = (core::array::from_fn(|i| state[i]), core::array::from_fn(|i| state[D + i]));
        let mut parts = Parts::<R, D, W, C>::nothing();
        let (matrix, forces) = self.dynamics(&q, &v);
        (parts.inverse, parts.forces) = (inverse(matrix), forces);
        let mut positions = [R::zero(); W];
        for (w, position) in positions.iter_mut().enumerate() {
            (*position, parts.rows[w], parts.biases[w]) = self.row(&q, &v, self.rows[w]);
        }
        parts.gaps =
            self.gaps.map(|gap| gap.map_or(R::zero(), |(row, constant)| positions[row] + R::lift(constant)));
        let lifted = |values: [f64; C]| values.map(R::lift);
        parts.friction = lifted(self.friction);
        parts.stiction = lifted(self.friction);
        parts.limits = lifted(self.limits);
        parts.free_motion(state)
    }

    /// The kinetic energy, from the mass matrix.
    pub fn kinetic(&self, state: &[f64]) -> f64 {
        let (q, v): ([f64; D], [f64; D]) =
            (core::array::from_fn(|i| state[i]), core::array::from_fn(|i| state[D + i]));
        let (matrix, _) = self.dynamics(&q, &v);
        (0..D).map(|i| (0..D).map(|j| 0.5 * v[i] * matrix[i][j] * v[j]).sum::<f64>()).sum()
    }

    /// Chooses the constant of a gap so that it has a value at some coordinates.
    pub fn set_gap(&mut self, element: usize, coordinates: &[f64; D], value: f64) {
        if let Some((row, constant)) = &mut self.gaps[element] {
            let row = *row;
            *constant = 0.0;
            let still = [0.0; D];
            let (position, ..) = self.row(coordinates, &still, self.rows[row]);
            self.gaps[element] = Some((row, value - position));
        }
    }
}

/// The inverse of a symmetric positive definite matrix, without pivots.
fn inverse<R: Lift<f64>, const D: usize>(mut matrix: [[R; D]; D]) -> [[R; D]; D] {
    let mut inverse: [[R; D]; D] =
        core::array::from_fn(|i| core::array::from_fn(|j| if i == j { R::one() } else { R::zero() }));
    for k in 0..D {
        let pivot = matrix[k][k].recip();
        for j in 0..D {
            matrix[k][j] *= pivot;
            inverse[k][j] *= pivot;
        }
        for i in (0..D).filter(|i| *i != k) {
            let factor = matrix[i][k];
            for j in 0..D {
                let (a, b) = (matrix[k][j], inverse[k][j]);
                matrix[i][j] -= factor * a;
                inverse[i][j] -= factor * b;
            }
        }
    }
    inverse
}

/// A family of drawn systems, with its elements.
macro_rules! family {
    ($(#[$docs:meta])* $Name:ident $size:literal $rows:literal $count:literal $elements:expr) => {
        $(#[$docs])*
        #[derive(Clone, Copy, Debug)]
        pub struct $Name(pub Drawn<{ $size / 2 }, $rows, $count>);

        impl HybridSystem<$size, $rows, $count, 0> for $Name {
            const ELEMENTS: [Element; $count] = $elements;
            const SIGNALS: [Signal; 0] = [];
            const COORDINATES: usize = $size / 2;
            crate::without_inputs!($count elements);

            fn free_motion<R: Lift<f64>>(
                &self,
                _t: R,
                state: &[R; $size],
                _: &[R; 0],
                _: &[R; $count],
            ) -> FreeMotion<R, $size, $rows, $count> {
                self.0.free(state)
            }

            fn restitutions(&self) -> [f64; $count] {
                self.0.restitutions
            }

            fn signals<R: Lift<f64>>(&self, _t: R, _x: &[R; $size]) -> [R; 0] {
                []
            }
        }
    };
}

family! {
    /// Three links on a fixed base, with a stop at two joints.
    Stops 6 2 2 [Element::smooth("first", 0), Element::smooth("second", 1)]
}
family! {
    /// Two links that fly, with two feet on a rough floor.
    Feet 8 4 2 [Element::rough("left", 0, &[1]), Element::rough("right", 2, &[3])]
}
family! {
    /// Three links on a fixed base, with a rough floor, a stop and a joint that grips.
    Mixed 6 4 3 [Element::rough("tip", 0, &[1]), Element::smooth("stop", 2), Element::grip("joint", &[3])]
}
family! {
    /// Two links that fly, with two feet, a stop and a joint that grips.
    Four 8 6 4 [
        Element::rough("left", 0, &[1]), Element::rough("right", 2, &[3]), Element::smooth("stop", 4),
        Element::grip("joint", &[5]),
    ]
}
family! {
    /// Four coordinates with constant masses, and one rough contact in space.
    Spatial 8 3 1 [Element::rough("point", 0, &[1, 2])]
}
family! {
    /// Six coordinates with constant masses, and two rough contacts in space.
    TwoPoints 12 6 2 [Element::rough("first", 0, &[1, 2]), Element::rough("second", 3, &[4, 5])]
}
