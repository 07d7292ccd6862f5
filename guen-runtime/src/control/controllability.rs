//! Controllability: the directions that the inputs of a linear model reach, and the components that nothing in it
//! moves.

use core::error::Error;
use core::fmt;

use crate::linear_algebra::dense::{Basis, apply, largest, length, transpose};
use crate::numbers::real::Ordered;
use crate::system::derivatives::linearization::Linearization;

/// The directions that the inputs reach: see [`controllability`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Controllability<R, const N: usize> {
    /// The rank of `[B, A B, .. A^(N-1) B]`: the dimension of what the inputs reach, at most `N`.
    pub rank: usize,
    /// The number of uncontrollable zero modes: independent combinations `w` of the state with `w A = 0` and `w B = 0`.
    pub zero_modes: usize,
    modes: [[R; N]; N],
}

impl<R, const N: usize> Controllability<R, N> {
    /// The combinations `w` of the uncontrollable zero modes, orthonormal: `w . d(state)` stays what it is, whatever
    /// the inputs do.
    pub fn modes(&self) -> &[[R; N]] {
        &self.modes[..self.zero_modes]
    }

    /// The rank, if it is full: what a design by pole placement or a Riccati equation needs.
    ///
    /// # Errors
    ///
    /// [`Uncontrollable`], with the counts.
    pub fn require(&self) -> Result<usize, Uncontrollable> {
        if self.rank == N {
            return Ok(N);
        }
        Err(Uncontrollable { states: N, rank: self.rank, zero_modes: self.zero_modes })
    }
}

/// The inputs do not reach all of a linear model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Uncontrollable {
    /// The size of the state.
    pub states: usize,
    /// The dimension of what the inputs reach.
    pub rank: usize,
    /// The number of combinations of the state that nothing in the linear model moves.
    pub zero_modes: usize,
}

impl fmt::Display for Uncontrollable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { states, rank, zero_modes } = self;
        write!(f, "the inputs reach {rank} of {states} dimensions of the linear model")?;
        if *zero_modes > 0 {
            write!(
                f,
                "; {zero_modes} of the others stand still in it whatever the inputs do, as sideways positions of a \
                 nonholonomic system at rest: linearise about a motion, or control a part of the state"
            )?;
        }
        Ok(())
    }
}

impl Error for Uncontrollable {}

/// The controllability of `z' = A z + B u`.
///
/// ```text
/// rank [B, A B, A^2 B, ..]        uncontrollable zero modes: w A = 0, w B = 0
/// ```
///
/// - The reachable space grows from the columns of `B` by applying `A` to an orthonormal basis of it, until nothing
///   new appears; a direction is new if more than `tolerance` of it is left, in units of the largest column of `A` or
///   `B`. With `1e-9` what is controllable by a billionth counts.
/// - A nonholonomic system at rest has uncontrollable zero modes although its brackets reach everything: no linear
///   feedback stabilises it there (Brockett's condition). What the brackets reach is the last entry of the system's
///   `GROWTH`, the dimension of the leaf.
/// - Of a model with an entry that is infinite or NaN nothing is known: the rank is zero.
///
/// ```
/// use guen_runtime::{Linearization, control::controllability};
/// // A cart that can be pushed forwards, and not sideways.
/// let a = [[0.0, 0.0, 1.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]];
/// let found = controllability(&Linearization { a, b: [[0.0], [0.0], [1.0]] }, 1e-9);
/// assert_eq!((found.rank, found.zero_modes), (2, 1));
/// assert_eq!(found.modes()[0].map(f64::abs), [0.0, 1.0, 0.0]);
/// assert!(found.require().is_err());
/// ```
pub fn controllability<R: Ordered, const N: usize, const M: usize>(
    linear: &Linearization<R, N, M>,
    tolerance: f64,
) -> Controllability<R, N> {
    if !linear.a.iter().flatten().chain(linear.b.iter().flatten()).all(|x| x.is_finite()) {
        return Controllability { rank: 0, zero_modes: 0, modes: [[R::zero(); N]; N] };
    }
    let columns_a = transpose(&linear.a);
    let columns_b = transpose(&linear.b);
    let size_a = tolerance * largest(columns_a.iter().map(length));
    let size_b = tolerance * largest(columns_b.iter().map(length));
    let mut reached = Basis::new();
    for column in &columns_b {
        reached.add(column, size_b);
    }
    let mut next = 0;
    while next < reached.count {
        let image = apply(&linear.a, &reached.vectors[next]);
        reached.add(&image, size_a);
        next += 1;
    }
    // The left null space of [A B] is what is left of the space beside its columns.
    let mut moved = Basis::new();
    moved.add_all(N, |j| columns_a.get(j).copied(), size_a);
    moved.add_all(M, |j| columns_b.get(j).copied(), size_b);
    let rank = moved.count;
    let mut modes = [[R::zero(); N]; N];
    let mut zero_modes = 0;
    while zero_modes + rank < N {
        let mut best: Option<(R, [R; N])> = None;
        for i in 0..N {
            let mut vector = [R::zero(); N];
            vector[i] = R::one();
            let rest = moved.remainder(&vector);
            let size = length(&rest);
            if best.is_none_or(|(most, _)| size > most) {
                best = Some((size, rest));
            }
        }
        let Some((size, rest)) = best else { break };
        let mode = rest.map(|x| x / size);
        if !moved.add(&mode, 0.0) {
            break;
        }
        modes[zero_modes] = mode;
        zero_modes += 1;
    }
    Controllability { rank: reached.count, zero_modes, modes }
}
