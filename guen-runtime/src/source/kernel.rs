//! Kernels: the text of a system with a function that computes many motions, one for each thread of a graphics processor.

use core::fmt;

use super::Source;
use crate::steppers::explicit::tableau::Tableau;

/// The beginning of the text: steps are watched, and the words of the dialect are given unless whoever compiles the text has others.
const DIALECT: &str = "#define GUEN_WATCHED\n#ifndef GUEN_KERNEL\n#define GUEN_KERNEL extern \"C\" __global__\n#define GUEN_FUNCTION static __device__\n#endif\n";
/// A motion in steps of one size, and one by DOP853.
const FIXED_MOTION: &str = include_str!("fixed_motion.c");
const ADAPTIVE_MOTION: &str = include_str!("adaptive_motion.c");
/// The function that is launched.
const KERNEL: &str = include_str!("kernel.c");

/// A method of a kernel.
///
/// ```
/// use guen_runtime::KernelMethod;
/// assert_eq!(KernelMethod::Rk4.stepper(), "rk4");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum KernelMethod {
    /// [`Rk4`](crate::steppers::Rk4); its settings are `[step, 0, 0, 0]`.
    Rk4,
    /// [`Rk8`](crate::steppers::Rk8); its settings are `[step, 0, 0, 0]`.
    Rk8,
    /// [`Dop853`](crate::steppers::Dop853); its settings are `[rtol, atol, first_step, max_steps]`, with a first step of 0 where
    /// it is estimated.
    Dop853,
}

impl KernelMethod {
    /// The last word of the stepper's name in C.
    pub fn stepper(self) -> &'static str {
        match self {
            Self::Rk4 => "rk4",
            Self::Rk8 => "rk8",
            Self::Dop853 => "dop853",
        }
    }

    /// The evaluations of a step of fixed size.
    pub(super) fn evaluations(self) -> u32 {
        match self {
            Self::Rk4 => 4,
            Self::Rk8 | Self::Dop853 => 12,
        }
    }
}

/// A kernel of a system and a method, which `Display` writes: a text of CUDA C without includes, for a compiler at run time
/// (`--fmad=false`: fused operations have other bits).
///
/// A motion ends with status 5 after a step over which a function that must not vanish changed its sign, or by more than a factor of two where steps
/// are of one size, as a [`Guard`](crate::steppers::Guard) would find there; the last good state is that before the step.
///
/// As C it is the header of the [`Source`] with one function more. Whoever defines `GUEN_KERNEL` and `GUEN_FUNCTION`, and has
/// `blockIdx`, `blockDim` and `threadIdx` as variables, compiles it by any compiler of C.
///
/// [`Source::kernel`] makes it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kernel {
    pub(super) source: Source,
    pub(super) method: KernelMethod,
}

impl Kernel {
    /// The name of the function to launch.
    pub fn entry(&self) -> impl fmt::Display + use<> {
        Entry(self.source.name)
    }

    /// The method.
    pub fn method(&self) -> KernelMethod {
        self.method
    }
}

impl fmt::Display for Kernel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { source, method } = self;
        let tableau = Tableau::new();
        let motion = if *method == KernelMethod::Dop853 { ADAPTIVE_MOTION } else { FIXED_MOTION };
        write!(f, "{DIALECT}{source}")?;
        for text in [motion, KERNEL] {
            source.fill(text, &tableau, Some(*method), f)?;
        }
        Ok(())
    }
}

/// The name of a kernel's function.
struct Entry(&'static str);

impl fmt::Display for Entry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.0)?;
        f.write_str("_motions")
    }
}
