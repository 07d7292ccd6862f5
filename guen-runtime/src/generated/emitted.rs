//! Code that is the same in every expansion, as macros that generated code calls: the compiler copies what the
//! derivation of each system would write down token by token.
//!
//! They expand inside the module of a system, which defines `Prepared`, `Bracket` and the module `program`, and work
//! without a prelude and from any crate name.

mod methods;

/// Straight-line functions of a module, each as `name(prepared; time; given) -> results { .. }`: names and lengths of the
/// arrays of prepared values, the name of the time if the function depends on it, and the arrays of the state and what
/// comes with it. The real is `R` in their bodies.
#[doc(hidden)]
#[macro_export]
macro_rules! program_functions {
    ($(
        $name:ident($($prepared:ident $p:literal),*; $($t:ident)?; $($given:ident $g:literal),*) -> $n:literal $body:tt
    )*) => {$(
        #[inline]
        pub(super) fn $name<R: $crate::Real>(
            $($prepared: &[R; $p],)* $($t: R,)? $($given: &[R; $g],)*
        ) -> [R; $n] {
            // The closure is compiled with the instructions of the real.
            <R as $crate::Real>::vectorize(#[inline(always)] || $body)
        }
    )*};
}

/// A struct of reals with conversions from and to an array, and the names of its fields: each field with its documentation
/// and the name of a local variable.
#[doc(hidden)]
#[macro_export]
macro_rules! record {
    ($(#[$($docs:tt)*])* $Record:ident $n:literal $($(#[$($doc:tt)*])* $field:ident $local:ident,)*) => {
        $(#[$($docs)*])*
        #[::core::prelude::v1::derive(
            ::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug, ::core::cmp::PartialEq,
            ::core::default::Default
        )]
        pub struct $Record<R = f64> {
            $($(#[$($doc)*])* pub $field: R,)*
        }

        impl $Record<f64> {
            /// The names of the fields, in order.
            pub const NAMES: [&'static str; $n] = [$($crate::checks::plain(::core::stringify!($field))),*];
        }

        impl<R> ::core::convert::From<[R; $n]> for $Record<R> {
            #[inline]
            fn from([$($local),*]: [R; $n]) -> Self {
                $Record { $($field: $local),* }
            }
        }

        impl<R> ::core::convert::From<$Record<R>> for [R; $n] {
            #[inline]
            fn from(record: $Record<R>) -> Self {
                [$(record.$field),*]
            }
        }
    };
}

/// An operator of displacement: the type, the number of coordinates, whether it has `d/dt`, and where its coefficients
/// begin among those of all operators.
#[doc(hidden)]
#[macro_export]
macro_rules! operator {
    ($docs:literal $X:ident $n:literal $time:literal $first:literal) => {
        #[doc = $docs]
        #[::core::prelude::v1::derive(
            ::core::clone::Clone,
            ::core::marker::Copy,
            ::core::fmt::Debug,
            ::core::default::Default,
            ::core::cmp::PartialEq,
            ::core::cmp::Eq
        )]
        pub struct $X;

        impl<B: $crate::Real> $crate::Operator<B, $n> for $X {
            type Prepared = Prepared<B>;
            const TIME: bool = $time;
            fn coefficients<R: $crate::Real + $crate::Lift<B>>(
                prepared: &Prepared<B>,
                t: R,
                x: &[R; $n],
            ) -> [R; $n] {
                let lifted: Prepared<R> = prepared.lift();
                let all = program::operators(&lifted.constants, &lifted.hoisted, t, x);
                ::core::array::from_fn(|i| all[$first + i])
            }
        }
    };
}

/// A bracket `(X_i, X_j)` that does not vanish: its indices, the number of coordinates, where its coefficients begin among
/// those of all brackets, what is known of them, and a minus where they are those of `(X_j, X_i)`.
#[doc(hidden)]
#[macro_export]
macro_rules! bracket {
    ($i:literal $j:literal $n:literal $first:literal [$($known:tt)*] $($minus:tt)?) => {
        impl<B: $crate::Real> $crate::BracketCoefficients<B, $n> for Bracket<$i, $j> {
            type Prepared = Prepared<B>;
            const I: usize = $i;
            const J: usize = $j;
            const COEFFICIENTS: [$crate::Coefficient; $n] = {
                #[allow(unused_imports, reason = "not every bracket has every kind of coefficient")]
                use $crate::Coefficient::{Constant, Number, Variable, Zero};
                [$($known)*]
            };
            fn coefficients<R: $crate::Real + $crate::Lift<B>>(
                prepared: &Prepared<B>,
                t: R,
                x: &[R; $n],
            ) -> [R; $n] {
                let lifted: Prepared<R> = prepared.lift();
                let all = program::brackets(&lifted.constants, &lifted.hoisted, t, x);
                ::core::array::from_fn(|i| $($minus)? all[$first + i])
            }
        }
    };
}

#[cfg(test)]
mod tests {
    record! {
        /// A point.
        Point 2
        /// To the right.
        x a,
        /// Upwards.
        r#type b,
    }

    #[test]
    fn a_record_is_its_array() {
        assert_eq!(Point::NAMES, ["x", "type"]);
        let point = Point::from([1.0, 2.0]);
        assert_eq!((point.x, point.r#type), (1.0, 2.0));
        assert_eq!(<[f64; 2]>::from(point), [1.0, 2.0]);
    }
}
