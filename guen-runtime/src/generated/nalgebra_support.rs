//! Conversions between named states and nalgebra's vectors, as a macro that generated code calls always and that
//! expands to nothing without the feature `nalgebra`: only this crate knows whether the feature is on.

/// Implements `From` both ways between `State<R>` and `nalgebra::SVector<R, n>`, through the state's own
/// conversions from and to `[R; n]`.
///
/// Without the feature `nalgebra` it expands to nothing. Works without a prelude and from any crate name.
///
/// ```
/// #[derive(Clone, Copy, Debug, PartialEq)]
/// struct State<R> {
///     x: R,
///     v: R,
/// }
/// impl<R> From<[R; 2]> for State<R> {
///     fn from([x, v]: [R; 2]) -> Self {
///         Self { x, v }
///     }
/// }
/// impl<R> From<State<R>> for [R; 2] {
///     fn from(state: State<R>) -> Self {
///         [state.x, state.v]
///     }
/// }
/// guen_runtime::nalgebra_conversions!(State, 2);
///
/// # #[cfg(feature = "nalgebra")] {
/// let vector: guen_runtime::nalgebra::SVector<f64, 2> = State { x: 1.0, v: 2.0 }.into();
/// assert_eq!(State::from(vector), State { x: 1.0, v: 2.0 });
/// # }
/// ```
#[cfg(feature = "nalgebra")]
#[macro_export]
macro_rules! nalgebra_conversions {
    ($State:ident, $n:literal) => {
        impl<R: $crate::Real + $crate::nalgebra::Scalar> ::core::convert::From<$State<R>>
            for $crate::nalgebra::SVector<R, $n>
        {
            #[inline]
            fn from(state: $State<R>) -> Self {
                let entries: [R; $n] = ::core::convert::From::from(state);
                ::core::convert::From::from(entries)
            }
        }

        impl<R: $crate::Real + $crate::nalgebra::Scalar>
            ::core::convert::From<$crate::nalgebra::SVector<R, $n>> for $State<R>
        {
            #[inline]
            fn from(vector: $crate::nalgebra::SVector<R, $n>) -> Self {
                let entries: [R; $n] = ::core::convert::From::from(vector);
                ::core::convert::From::from(entries)
            }
        }
    };
}

/// Expands to nothing: the feature `nalgebra`, with which it implements conversions between a state and nalgebra's
/// vectors, is off.
#[cfg(not(feature = "nalgebra"))]
#[macro_export]
macro_rules! nalgebra_conversions {
    ($State:ident, $n:literal) => {};
}
