//! Levels of detail: a system and its scenes, as types that code can be generic over.

use core::fmt;

use crate::numbers::real::Real;
use crate::report::cost::Cost;

/// A level of detail of a system with `FULL` variables: the system itself, or a scene that keeps `N` of them.
///
/// Generated systems and scenes implement it beside [`System`](crate::System), for what steppers integrate. A run can
/// change its level at any time: [`embed`](Level::embed) what it has into a state of the system, and
/// [`project`](Level::project) that to the next level. No number is computed on the way, so that what both levels keep
/// is the same to the bit.
///
/// ```
/// use guen_runtime::{Cost, Level, LevelInfo};
///
/// /// Free fall of which only the height and its rate are kept, out of `x, z, x', z'`.
/// struct Height;
/// impl Level<f64, 2, 4> for Height {
///     const PLACES: [usize; 2] = [1, 3];
///     const QUADRATURES: &'static [&'static [usize]] = &[];
///     const INFO: LevelInfo =
///         LevelInfo { name: "Height", variables: &["z", "w"], cost: Cost::ZERO, prepare_cost: Cost::ZERO };
/// }
///
/// let full = [1.0, 2.0, 3.0, 4.0];
/// assert_eq!(Height.project(&full), [2.0, 4.0]);
/// assert_eq!(Height.embed(&[5.0, 6.0], &full), [1.0, 5.0, 3.0, 6.0]);
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is no level of {N} variables of a system that has {FULL}",
    note = "the levels of a system are it and its scenes, prepared"
)]
pub trait Level<R: Real, const N: usize, const FULL: usize> {
    /// The place of each variable of the level in a state of the system, in their order; of the system itself each its own.
    const PLACES: [usize; N] = own_places();

    /// Variables that the level leaves out and that are integrals of what it keeps: in layers, the rates of each depend
    /// on time, on what is kept and on the layers before. They can be recovered from a recorded run.
    const QUADRATURES: &'static [&'static [usize]] = &[];

    /// Coordinates that the level leaves out and that holonomic equations say of what it keeps.
    const DETERMINED: &'static [usize] = &[];

    /// The name and the cost of the level.
    const INFO: LevelInfo;

    /// Puts the variables that the level holds constant into a state of the system; does nothing where there are none.
    #[inline]
    fn hold(&self, _full: &mut [R; FULL]) {}

    /// Puts the [`DETERMINED`](Self::DETERMINED) coordinates at a state of the level into a state of the system; does nothing
    /// where there are none.
    #[inline]
    fn determine(&self, _t: R, _state: &[R; N], _full: &mut [R; FULL]) {}

    /// The level's state out of a state of the system.
    #[inline]
    fn project(&self, full: &[R; FULL]) -> [R; N] {
        Self::PLACES.map(|place| full[place])
    }

    /// A state of the system with what the level keeps and holds, and all other variables from `rest`.
    #[inline]
    fn embed(&self, state: &[R; N], rest: &[R; FULL]) -> [R; FULL] {
        let mut full = *rest;
        for (place, value) in Self::PLACES.into_iter().zip(state) {
            full[place] = *value;
        }
        self.hold(&mut full);
        full
    }
}

impl<R: Real, S: Level<R, N, FULL>, const N: usize, const FULL: usize> Level<R, N, FULL> for &S {
    const PLACES: [usize; N] = S::PLACES;
    const QUADRATURES: &'static [&'static [usize]] = S::QUADRATURES;
    const DETERMINED: &'static [usize] = S::DETERMINED;
    const INFO: LevelInfo = S::INFO;

    #[inline]
    fn hold(&self, full: &mut [R; FULL]) {
        (**self).hold(full);
    }

    #[inline]
    fn determine(&self, t: R, state: &[R; N], full: &mut [R; FULL]) {
        (**self).determine(t, state, full);
    }
}

/// The place of each variable in a state that has it at its own.
const fn own_places<const N: usize>() -> [usize; N] {
    let mut places = [0; N];
    let mut i = 0;
    while i < N {
        places[i] = i;
        i += 1;
    }
    places
}

/// The cost of a level of detail, counted when it was generated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LevelInfo {
    /// The name of the system or of the scene.
    pub name: &'static str,
    /// The variables of its state.
    pub variables: &'static [&'static str],
    /// The operations of one right-hand side.
    pub cost: Cost,
    /// The operations of `prepare`.
    pub prepare_cost: Cost,
}

impl LevelInfo {
    /// The size of a state over the real `R` in bytes.
    ///
    /// ```
    /// use guen_runtime::{Cost, LevelInfo};
    /// let info = LevelInfo { name: "Tilt", variables: &["theta", "eta1"], cost: Cost::ZERO, prepare_cost: Cost::ZERO };
    /// assert_eq!((info.bytes::<f64>(), info.bytes::<f32>()), (16, 8));
    /// ```
    pub const fn bytes<R>(&self) -> usize {
        self.variables.len() * size_of::<R>()
    }
}

/// Levels side by side: displays as a table with a row for each. Bytes are those of a state of `f64`.
///
/// ```
/// use guen_runtime::{Cost, LevelInfo, Levels};
/// const WHOLE: LevelInfo =
///     LevelInfo { name: "Hoop", variables: &["x", "v"], cost: Cost::ZERO, prepare_cost: Cost::ZERO };
/// let text = Levels(&[WHOLE]).to_string();
/// assert!(text.lines().nth(1).unwrap().starts_with("Hoop"));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Levels(pub &'static [LevelInfo]);

impl fmt::Display for Levels {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let width = self.0.iter().map(|info| info.name.chars().count()).max().unwrap_or(0).max("level".len());
        write!(f, "{:width$}  variables  bytes  operations  calls  prepared once", "level")?;
        for info in self.0 {
            let (cost, prepare) = (info.cost, info.prepare_cost.total());
            let operations = cost.total() - cost.calls;
            write!(
                f,
                "\n{:width$}  {:9}  {:5}  {operations:10}  {:5}  {prepare:13}",
                info.name,
                info.variables.len(),
                info.bytes::<f64>(),
                cost.calls,
            )?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use std::string::ToString;

    #[test]
    fn the_table_is_aligned() {
        const COST: Cost = Cost { additions: 5, multiplications: 8, calls: 1, ..Cost::ZERO };
        const LEVELS: [LevelInfo; 2] = [
            LevelInfo { name: "RollingHoop", variables: &["a"; 9], cost: COST, prepare_cost: Cost::ZERO },
            LevelInfo { name: "Tilt", variables: &["a"; 4], cost: COST, prepare_cost: Cost::ZERO },
        ];
        let text = Levels(&LEVELS).to_string();
        let expected = "\
level        variables  bytes  operations  calls  prepared once
RollingHoop          9     72          13      1              0
Tilt                 4     32          13      1              0";
        assert_eq!(text, expected);
    }
}
