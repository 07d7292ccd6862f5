//! The reasons for which motions are not computed on the device that was asked for.

use std::error::Error;
use std::fmt;

use super::Device;

/// The reason for which motions were computed on the CPU, although another device was asked for.
///
/// ```
/// use guen_study::DeviceFault;
/// assert_eq!(DeviceFault::NoDriver.to_string(), "the library of the CUDA driver is not found");
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum DeviceFault {
    /// The crate `guen-study` is built without the feature `cuda`.
    NotBuilt,
    /// The library of the CUDA driver is not found.
    NoDriver,
    /// The library of the run-time compiler, NVRTC, is not found.
    NoCompiler,
    /// There is no such device, or it does not answer.
    NoDevice {
        /// The device that was asked for.
        device: Device,
        /// The driver's words.
        reason: String,
    },
    /// The text of the system has no such method: where constraints of positions are restored after steps there is none, and no DOP853
    /// where functions of the motion are piecewise.
    NoMethod {
        /// The method, as its functions in C are called.
        method: &'static str,
    },
    /// The compiler refused the kernel.
    Compiler {
        /// The compiler's words.
        log: String,
    },
    /// The device stopped before all motions were computed: memory ran out, say.
    Stopped {
        /// The driver's words.
        reason: String,
    },
}

impl fmt::Display for DeviceFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotBuilt => f.write_str("guen-study is built without the feature `cuda`"),
            Self::NoDriver => f.write_str("the library of the CUDA driver is not found"),
            Self::NoCompiler => f.write_str("the library of the CUDA compiler (NVRTC) is not found"),
            Self::NoDevice { device, reason } => write!(f, "there is no {device}: {reason}"),
            Self::NoMethod { method } => write!(f, "the system's text of C has no `{method}`"),
            Self::Compiler { log } => write!(f, "the compiler refused the kernel: {log}"),
            Self::Stopped { reason } => write!(f, "the device stopped: {reason}"),
        }
    }
}

impl Error for DeviceFault {}
