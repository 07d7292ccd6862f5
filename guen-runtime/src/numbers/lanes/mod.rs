//! Lanes: several numbers that are computed with at once, by instructions that are chosen at run time.
//!
//! A default build for x86-64 may use registers of 128 bits alone, since older processors have no longer ones. Here the
//! processor is asked when the program runs; code that is generic in [`Lanes`] is compiled for each kind of register,
//! and [`dispatch`] picks. On other platforms, and without the feature `std`, lanes are arrays, unless the build itself
//! is for a newer processor.
//!
//! - **The same bits**: a lane computes what an `f64` would, in every backend and at every width.
//! - **One lane does not see another**: where one becomes NaN the others go on; [`Lanes::finite`] tells which.
//! - **Straight-line code** gains; elementary functions other than `sin_cos` and `sqrt` are called lane by lane, and
//!   [`Dual`](crate::Dual)s of lanes are right, but not fast.
//!
//! ```
//! use guen_runtime::Real;
//! use guen_runtime::lanes::{LaneTask, Lanes, Width, dispatch};
//!
//! /// The sum of the sines of numbers.
//! struct SumOfSines<'a>(&'a [f64]);
//!
//! impl LaneTask for SumOfSines<'_> {
//!     type Output = f64;
//!
//!     #[inline(always)]
//!     fn run<L: Lanes>(self) -> f64 {
//!         let mut sum = L::zero();
//!         for part in self.0.chunks_exact(L::COUNT) {
//!             sum += L::from_fn(|i| part[i]).sin();
//!         }
//!         (0..L::COUNT).map(|i| sum.lane(i)).sum()
//!     }
//! }
//!
//! let numbers: [f64; 16] = core::array::from_fn(|i| i as f64);
//! let sum = dispatch(Width::Four, SumOfSines(&numbers));
//! let one_by_one: f64 = numbers.iter().map(|x| x.sin()).sum();
//! assert!((sum - one_by_one).abs() < 1e-14);
//! ```

mod real;
pub(crate) mod register;
#[cfg(target_arch = "x86_64")]
mod x86;

/// Two lanes that the target always has.
#[cfg(target_arch = "x86_64")]
pub(crate) type Two = x86::Sse2;
#[cfg(not(target_arch = "x86_64"))]
pub(crate) type Two = Pair<f64>;

use register::{Pair, Register, Vector};

use crate::numbers::lift::Lift;
use crate::numbers::real::Real;

/// A [`Real`] that consists of several `f64`, the lanes; `f64` itself is one with a single lane.
///
/// The types are nameless: code is given one as a type parameter, by [`dispatch`], and this is what proves that the
/// processor has its instructions. Arithmetic and functions are [`Real`]'s; [`Real::to_f64`] is the first lane,
/// [`Real::is_finite`] asks all of them, equality compares all.
pub trait Lanes: Real + Lift<f64> + Lift<Self> {
    /// The number of lanes: 1, 4 or 8.
    const COUNT: usize;

    /// A number for each lane, by its index.
    fn from_fn(lane: impl FnMut(usize) -> f64) -> Self;

    /// The number in one lane.
    ///
    /// # Panics
    ///
    /// If the index is not below [`COUNT`](Self::COUNT).
    fn lane(self, index: usize) -> f64;

    /// The lanes whose number is neither infinite nor NaN.
    fn finite(self) -> Mask;

    /// Sine and cosine with an absolute error below 1e-13: [`Approx13`](crate::Approx13) calls it.
    fn sin_cos_13(self) -> (Self, Self);

    /// Sine and cosine with an absolute error below 4e-8: [`Approx7`](crate::Approx7) calls it.
    fn sin_cos_7(self) -> (Self, Self);

    /// `self * b + c`, rounded once, by whatever means: [`Fused`](crate::Fused) calls it.
    fn fused(self, b: Self, c: Self) -> Self;

    /// [`Real::vectorize`] with the instruction for [`fused`](Self::fused) at hand, if the processor has it.
    fn vectorize_fused<T>(function: impl FnOnce() -> T) -> T;
}

/// Arrays of numbers put together, one in each lane: `of(lane)` is that of a lane.
///
/// ```
/// use guen_runtime::lanes::{Lanes, gathered};
/// let [mass] = gathered::<f64, 1>(|_lane| &[2.0]);
/// assert_eq!(mass.lane(0), 2.0);
/// ```
pub fn gathered<'a, L: Lanes, const N: usize>(of: impl Fn(usize) -> &'a [f64; N]) -> [L; N] {
    core::array::from_fn(|k| L::from_fn(|lane| of(lane)[k]))
}

/// A set of lanes.
///
/// ```
/// use guen_runtime::lanes::Mask;
/// let failed = Mask::all(4) - Mask::from_bits(0b1101);
/// assert!(failed.contains(1) && !failed.is_empty());
/// assert_eq!(failed.lanes().count(), 1);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Mask(u32);

impl Mask {
    /// The set with one bit for each lane, the first lowest.
    #[inline(always)]
    pub fn from_bits(bits: u32) -> Self {
        Self(bits)
    }

    /// The first so many lanes, at most 32.
    #[inline(always)]
    pub fn all(count: usize) -> Self {
        Self(u32::MAX.checked_shr(32_u32.saturating_sub(count as u32)).unwrap_or(0))
    }

    /// Returns one bit for each lane, the first lowest.
    #[inline(always)]
    pub fn bits(self) -> u32 {
        self.0
    }

    /// Whether there is no lane in it.
    #[inline(always)]
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Whether a lane is in it.
    #[inline(always)]
    pub fn contains(self, lane: usize) -> bool {
        lane < 32 && self.0 >> lane & 1 == 1
    }

    /// Returns the set with one lane more, below 32.
    ///
    /// ```
    /// use guen_runtime::lanes::Mask;
    /// assert_eq!(Mask::from_bits(0b10).with(0), Mask::from_bits(0b11));
    /// ```
    #[inline(always)]
    #[must_use]
    pub fn with(self, lane: usize) -> Self {
        Self(self.0 | 1_u32.checked_shl(lane as u32).unwrap_or(0))
    }

    /// The indices of its lanes.
    pub fn lanes(self) -> impl Iterator<Item = usize> {
        let mut rest = self.0;
        core::iter::from_fn(move || {
            let lane = (rest != 0).then(|| rest.trailing_zeros() as usize);
            rest &= rest.wrapping_sub(1);
            lane
        })
    }
}

impl core::ops::BitAnd for Mask {
    type Output = Self;

    /// The lanes in both.
    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }
}

impl core::ops::Sub for Mask {
    type Output = Self;

    /// The lanes in the first and not in the second.
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }
}

/// The number of lanes to compute with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Width {
    /// One: plain `f64`.
    One,
    /// Four.
    Four,
    /// Eight.
    Eight,
}

impl Width {
    /// The number of lanes.
    pub fn lanes(self) -> usize {
        match self {
            Self::One => 1,
            Self::Four => 4,
            Self::Eight => 8,
        }
    }
}

/// The registers that lanes are made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Backend {
    /// Pairs of `f64`, for every platform; on x86-64 in registers of 128 bits.
    Portable,
    /// Registers of 256 bits, with fused multiply-add: x86-64 since about 2013.
    Avx2,
    /// Registers of 512 bits: AVX-512 F, DQ and VL.
    Avx512,
}

impl Backend {
    /// The widths, the slowest first.
    pub const ALL: [Self; 3] = [Self::Portable, Self::Avx2, Self::Avx512];

    /// Whether this processor has it.
    pub fn is_available(self) -> bool {
        match self {
            Self::Portable => true,
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => x86::has_avx2(),
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => x86::has_avx512(),
            #[cfg(not(target_arch = "x86_64"))]
            Self::Avx2 | Self::Avx512 => false,
        }
    }

    /// Returns the number of lanes that suits its registers, as measured by `workshop/benches/lanes.rs`.
    pub fn width(self) -> Width {
        match self {
            Self::Portable | Self::Avx2 => Width::Four,
            Self::Avx512 => Width::Eight,
        }
    }

    /// The fastest that this processor has.
    pub fn best() -> Self {
        let available = |backend: &Self| backend.is_available();
        Self::ALL.into_iter().rfind(available).unwrap_or(Self::Portable)
    }
}

/// Something to do in lanes of whatever kind.
pub trait LaneTask: Sized {
    /// The result of the task.
    type Output;

    /// Does it. Mark it `#[inline(always)]` if it does more than to call functions that use
    /// [`Real::vectorize`] themselves, as generated right-hand sides and steppers do.
    fn run<L: Lanes>(self) -> Self::Output;
}

/// Does something in lanes of the best kind that this processor has.
///
/// Costs the look at a flag and a call; lanes pay for work that is much longer.
pub fn dispatch<T: LaneTask>(width: Width, task: T) -> T::Output {
    dispatch_on(Backend::best(), width, task)
}

/// Does something in lanes of a certain kind; if this processor does not have it, in arrays, with the same result.
pub fn dispatch_on<T: LaneTask>(backend: Backend, width: Width, task: T) -> T::Output {
    let result = match backend {
        #[cfg(target_arch = "x86_64")]
        Backend::Avx2 => x86::avx2(width, task),
        #[cfg(target_arch = "x86_64")]
        Backend::Avx512 => x86::avx512(width, task),
        _ => Err(task),
    };
    result.unwrap_or_else(|task| match width {
        Width::One => task.run::<f64>(),
        Width::Four => run::<Pair<Two>, T>(task),
        Width::Eight => run::<Pair<Pair<Two>>, T>(task),
    })
}

/// Calls a function that may use the longest registers of this processor: its loops over adjacent numbers are compiled
/// for each kind.
#[inline(always)]
pub(crate) fn wide<T>(function: impl FnOnce() -> T) -> T {
    #[cfg(target_arch = "x86_64")]
    {
        x86::wide(function)
    }
    #[cfg(not(target_arch = "x86_64"))]
    {
        function()
    }
}

fn run<V: Register, T: LaneTask>(task: T) -> T::Output {
    V::vectorize(
        #[inline(always)]
        || task.run::<Vector<V>>(),
    )
}
