//! The reason why constants are refused, with the facts needed to act on it.

use core::error::Error;
use core::fmt;

/// The reason why a set of physical constants was refused. Each variant carries the offending value, as an `f64` for the
/// message.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum ConstantsError {
    /// A constant is infinite or NaN.
    NotFinite {
        /// The constant's name.
        name: &'static str,
        /// The value.
        value: f64,
    },
    /// A constant is outside its declared bound.
    OutOfBound {
        /// The constant's name.
        name: &'static str,
        /// The bound as declared, such as `a > 0`.
        bound: &'static str,
        /// The value.
        value: f64,
    },
    /// An expression of constants alone that the derivation divides by is zero or not finite.
    SingularPivot {
        /// The expression, in the names of the declaration.
        what: &'static str,
        /// The value.
        value: f64,
    },
    /// A constant of the system has another value than a scene fixes.
    Contradicted {
        /// The constant's name.
        name: &'static str,
        /// The value that the scene fixes.
        fixed: f64,
        /// The value in the system.
        value: f64,
    },
    /// The lower limit of an input is above the upper one.
    Limits {
        /// The input's name.
        input: &'static str,
        /// The lower limit.
        lower: f64,
        /// The upper limit.
        upper: f64,
    },
    /// A negative mass or moment of inertia, written as a number, leaves directions in which the kinetic energy is negative.
    Indefinite {
        /// The body's name.
        body: &'static str,
    },
    /// A body that no distribution of mass has.
    NotPhysical {
        /// The body's name.
        body: &'static str,
        /// The fault of the body.
        fault: BodyFault,
    },
}

/// The reason why a body is none that could be made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum BodyFault {
    /// The mass is negative.
    NegativeMass,
    /// A principal moment of inertia is negative, or larger than the sum of the other two.
    Inertia,
}

impl fmt::Display for ConstantsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFinite { name, value } => write!(f, "constant `{name}` is {value}, which is not finite"),
            Self::OutOfBound { name, bound, value } => {
                write!(f, "constant `{name}` is {value}, but `{bound}` is declared")
            }
            Self::Contradicted { name, fixed, value } => {
                write!(f, "constant `{name}` is {value}, but the scene fixes it at {fixed}")
            }
            Self::Limits { input, lower, upper } => {
                write!(f, "the limits of input `{input}` leave no value: from {lower} to {upper}")
            }
            Self::Indefinite { body } => {
                write!(f, "the mass or inertia of `{body}` is negative, and makes the mass matrix indefinite")
            }
            Self::NotPhysical { body, fault: BodyFault::NegativeMass } => {
                write!(f, "body `{body}` has a negative mass")
            }
            Self::NotPhysical { body, fault: BodyFault::Inertia } => {
                write!(
                    f,
                    "no distribution of mass has the inertia of body `{body}`: a principal moment is negative, "
                )?;
                f.write_str("or larger than the sum of the other two")
            }
            Self::SingularPivot { what, value } => {
                write!(f, "these constants make `{what}`, which the equations divide by, equal to {value}")
            }
        }
    }
}

impl Error for ConstantsError {}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::ConstantsError;
    use std::string::ToString;

    #[test]
    fn messages_name_constant_and_bound() {
        let error = ConstantsError::OutOfBound { name: "a", bound: "a > 0", value: -1.0 };
        assert_eq!(error.to_string(), "constant `a` is -1, but `a > 0` is declared");
        let error = ConstantsError::NotFinite { name: "g", value: f64::NAN };
        assert_eq!(error.to_string(), "constant `g` is NaN, which is not finite");
    }
}
