//! Systems with contacts written by hand: masses, forces and rows in, the free motion out.

use guen_runtime::Real;
use guen_runtime::hybrid::FreeMotion;

/// The parts of the equations of `L` velocities and `W` rows at one state.
pub struct Parts<R, const L: usize, const W: usize, const C: usize> {
    /// The inverse of the mass matrix.
    pub inverse: [[R; L]; L],
    /// Forces less velocity terms, `Q - b`.
    pub forces: [R; L],
    /// `W`, `w` and `zeta`.
    pub rows: [[R; L]; W],
    pub drifts: [R; W],
    pub biases: [R; W],
    pub gaps: [R; C],
    pub friction: [R; C],
    pub stiction: [R; C],
    pub limits: [R; C],
}

impl<R: Real, const L: usize, const W: usize, const C: usize> Parts<R, L, W, C> {
    /// Nothing acts, nothing touches.
    pub fn nothing() -> Self {
        let zero = R::zero();
        Self {
            inverse: [[zero; L]; L],
            forces: [zero; L],
            rows: [[zero; L]; W],
            drifts: [zero; W],
            biases: [zero; W],
            gaps: [zero; C],
            friction: [zero; C],
            stiction: [zero; C],
            limits: [zero; C],
        }
    }

    pub fn masses(mut self, masses: [R; L]) -> Self {
        for (i, mass) in masses.into_iter().enumerate() {
            self.inverse[i][i] = mass.recip();
        }
        self
    }

    /// The free motion, where the velocities are those of the coordinates.
    pub fn free_motion<const N: usize>(self, state: &[R; N]) -> FreeMotion<R, N, W, C> {
        assert_eq!(N, 2 * L);
        let velocities: [R; L] = core::array::from_fn(|i| state[L + i]);
        let dot = |a: &[R; L], b: &[R; L]| a.iter().zip(b).fold(R::zero(), |sum, (a, b)| sum + *a * *b);
        let accelerations: [R; L] = core::array::from_fn(|i| dot(&self.inverse[i], &self.forces));
        let joined = |upper: &[R; L], lower: &[R; L]| {
            core::array::from_fn(|i| if i < L { upper[i] } else { lower[i - L] })
        };
        let responses: [[R; L]; W] =
            core::array::from_fn(|w| core::array::from_fn(|i| dot(&self.inverse[i], &self.rows[w])));
        FreeMotion {
            rates: joined(&velocities, &accelerations),
            gaps: self.gaps,
            row_rates: core::array::from_fn(|w| dot(&self.rows[w], &velocities) + self.drifts[w]),
            biases: core::array::from_fn(|w| dot(&self.rows[w], &accelerations) + self.biases[w]),
            delassus: core::array::from_fn(|w| core::array::from_fn(|v| dot(&self.rows[w], &responses[v]))),
            responses: core::array::from_fn(|w| joined(&[R::zero(); L], &responses[w])),
            friction: self.friction,
            stiction: self.stiction,
            limits: self.limits,
        }
    }
}

/// The parts of the trait that systems without inputs, conditions and resets have in common.
#[macro_export]
macro_rules! without_inputs {
    ($count:literal elements) => {
        type Mode = guen_runtime::hybrid::Mode<$count>;
        type Inputs = ();

        fn with_inputs(&self, (): ()) -> Self {
            *self
        }
    };
}
