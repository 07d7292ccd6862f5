//! Constants that follow others unless they are set.

use crate::numbers::real::Real;

/// A physical constant whose default is made of other constants: it follows them until it is set.
///
/// With `constants { m = 1, r = 1, J = m*r^2/2 }` the field `J` of the generated struct has this type, and `prepare` computes
/// it from the `m` and `r` that are there then, however the struct was made. All other fields are plain numbers.
///
/// ```
/// use guen_runtime::Derived;
///
/// let (m, r) = (1.7, 0.6);
/// let formula = || m * r * r / 2.0;
/// assert_eq!(Derived::Follows.resolve(formula), 1.7 * 0.6 * 0.6 / 2.0);
/// assert_eq!(Derived::from(0.25).resolve(formula), 0.25);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Derived<R = f64> {
    /// The constant follows the declaration.
    #[default]
    Follows,
    /// The constant has a value of its own.
    Set(R),
}

impl<R> Derived<R> {
    /// The value, from the formula if it follows.
    #[inline]
    pub fn resolve(self, formula: impl FnOnce() -> R) -> R {
        match self {
            Self::Follows => formula(),
            Self::Set(value) => value,
        }
    }

    /// The value that was set.
    ///
    /// ```
    /// use guen_runtime::Derived;
    /// assert_eq!((Derived::Set(2.0).value(), Derived::<f64>::Follows.value()), (Some(2.0), None));
    /// ```
    #[inline]
    pub fn value(self) -> Option<R> {
        match self {
            Self::Follows => None,
            Self::Set(value) => Some(value),
        }
    }

    /// Whether it follows others.
    #[inline]
    pub const fn follows(&self) -> bool {
        matches!(self, Self::Follows)
    }

    /// Converts the value to another real; a value that follows from other constants goes on to follow from them.
    ///
    /// ```
    /// use guen_runtime::Derived;
    /// assert_eq!(Derived::Set(0.5_f32).map(f64::from), 0.5);
    /// assert_eq!(Derived::<f32>::Follows.map(f64::from), Derived::Follows);
    /// ```
    #[inline]
    pub fn map<S>(self, convert: impl FnOnce(R) -> S) -> Derived<S> {
        match self {
            Self::Follows => Derived::Follows,
            Self::Set(value) => Derived::Set(convert(value)),
        }
    }
}

impl<R> From<R> for Derived<R> {
    #[inline]
    fn from(value: R) -> Self {
        Self::Set(value)
    }
}

/// Equal to the number that it was set to, and to none where it follows.
impl<R: Real> PartialEq<R> for Derived<R> {
    #[inline]
    fn eq(&self, other: &R) -> bool {
        matches!(self, Self::Set(value) if value == other)
    }
}

#[cfg(feature = "serde")]
impl<R: serde::Serialize> serde::Serialize for Derived<R> {
    /// Serialises the value as an option: nothing where it follows.
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Follows => serializer.serialize_none(),
            Self::Set(value) => serializer.serialize_some(value),
        }
    }
}

#[cfg(feature = "serde")]
impl<'de, R: serde::Deserialize<'de>> serde::Deserialize<'de> for Derived<R> {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Ok(Option::deserialize(deserializer)?.map_or(Self::Follows, Self::Set))
    }
}
