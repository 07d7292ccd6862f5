//! Code that is the same in every expansion, as macros that generated code calls: the compiler copies what the
//! derivation of each system would write down token by token.
//!
//! They expand inside the module of a system, which defines `Prepared`, `Bracket` and the module `program`, and work
//! without a prelude and from any crate name.

mod facts;
mod methods;
mod motion;

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

/// The operators of displacement and their brackets, with the number of coordinates and the highest index of an operator in a
/// bracket: the names of the operators, each with its documentation, and the brackets `(X_r, X_s)`, `r < s`, that do not vanish,
/// with what is known of their coefficients.
#[doc(hidden)]
#[macro_export]
macro_rules! operators {
    (
        $n:literal $last:literal
        $($docs:literal $X:ident $j:literal)*;
        $($r:literal $s:literal [$($known:tt)*])*
    ) => {
        impl $crate::Frame<$n> for Prepared<f64> {
            type Over<B: $crate::Real> = Prepared<B>;
            const LAST: usize = $last;
            const BRACKETS: &'static [(usize, usize, [$crate::Coefficient; $n])] = {
                #[allow(unused_imports, reason = "not every system has every kind of coefficient")]
                use $crate::Coefficient::{Constant, Number, Variable, Zero};
                &[$(($r, $s, [$($known)*])),*]
            };

            #[inline]
            fn operator<B: $crate::Real, R: $crate::Real + $crate::Lift<B>>(
                prepared: &Prepared<B>, t: R, x: &[R; $n], index: usize,
            ) -> [R; $n] {
                let lifted: Prepared<R> = prepared.lift();
                let all = program::operators(&lifted.constants, &lifted.hoisted, t, x);
                ::core::array::from_fn(|i| all[index * $n + i])
            }

            #[inline]
            fn bracket<B: $crate::Real, R: $crate::Real + $crate::Lift<B>>(
                prepared: &Prepared<B>, t: R, x: &[R; $n], place: usize,
            ) -> [R; $n] {
                $crate::values_of_brackets!(prepared, t, x, place, $n, $($r)*)
            }
        }

        $(
            #[doc = $docs]
            pub type $X = $crate::Displacement<Prepared, $j>;
            #[doc = $docs]
            pub const $X: $X = $crate::Displacement::NEW;
        )*

        impl<B: $crate::Real, const I: usize, const J: usize> $crate::BracketCoefficients<B, $n> for Bracket<{ I }, { J }> {
            type Prepared = Prepared<B>;
            const I: usize = I;
            const J: usize = J;
            const COEFFICIENTS: [$crate::Coefficient; $n] = $crate::known_bracket::<Prepared<f64>, $n>(I, J);

            #[inline]
            fn coefficients<R: $crate::Real + $crate::Lift<B>>(
                prepared: &Prepared<B>, t: R, x: &[R; $n],
            ) -> [R; $n] {
                $crate::bracket_values::<Prepared<f64>, B, R, $n, { I }, { J }>(prepared, t, x)
            }
        }
    };
}

/// The coefficients of a bracket out of those of all; where there are none there is no function.
#[doc(hidden)]
#[macro_export]
macro_rules! values_of_brackets {
    ($prepared:ident, $t:ident, $x:ident, $place:ident, $n:literal,) => {{
        let _ = ($prepared, $t, $x, $place);
        [<R as $crate::Real>::zero(); $n]
    }};
    ($prepared:ident, $t:ident, $x:ident, $place:ident, $n:literal, $($some:literal)+) => {{
        let lifted: Prepared<R> = $prepared.lift();
        let all = program::brackets(&lifted.constants, &lifted.hoisted, $t, $x);
        ::core::array::from_fn(|i| all[$place * $n + i])
    }};
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
