//! Code that is the same in every expansion, as macros that generated code calls: the compiler copies what the
//! derivation of each system would write down token by token.
//!
//! They expand inside the module of a system, which defines `Prepared` and the module `program`, and work
//! without a prelude and from any crate name.

mod contacts;
mod facts;
mod methods;
mod motion;

/// A module of straight-line functions: its name, further items, `prepare`, the arrays that functions take with their lengths, the
/// constants and the prepared values first, then each function as `name(time; given) -> results { .. }`, with the name of the time if
/// the function depends on it, and the arrays of the state and what comes with it, a name and the array that it is. The real is `R` in
/// their bodies. In front of `prepare` stand the functions that the program supplies, where there are some.
// A type for each array: a length in brackets would be a constant to check wherever it stands.
#[doc(hidden)]
#[macro_export]
macro_rules! program {
    ($name:ident { $($more:tt)* } $($functions:tt)*) => {
        #[allow(unused_imports, unused_variables, reason = "every function has the signature of its kind")]
        #[allow(
            clippy::all, clippy::pedantic, clippy::nursery, clippy::restriction, reason = "straight-line code for the compiler"
        )]
        mod $name {
            use super::__guen;
            $crate::program_functions! { $($functions)* }
            $($more)*
        }
    };
}

/// The functions of [`program!`](crate::program).
#[doc(hidden)]
#[macro_export]
macro_rules! program_functions {
    (
        { $($prepare:tt)* }
        $c:ident $constants:literal $k:ident $hoisted:literal $($array:ident $length:literal)*;
        $($name:ident($($t:ident)?; $($given:ident $kind:ident)*) -> $n:literal $body:tt)*
    ) => {
        type $c<R> = [R; $constants];
        type $k<R> = [R; $hoisted];
        $(#[allow(dead_code, reason = "small systems use few of them")] type $array<R> = [R; $length];)*
        #[inline]
        pub(super) fn prepare<R: $crate::Real>($c: &$c<R>) -> $k<R> {
            $($prepare)*
        }
        $(
            #[inline]
            pub(super) fn $name<R: $crate::Real>($c: &$c<R>, $k: &$k<R>, $($t: R,)? $($given: &$kind<R>,)*) -> [R; $n] {
                // The closure is compiled with the instructions of the real.
                <R as $crate::Real>::vectorize(#[inline(always)] || $body)
            }
        )*
    };
    (
        $supplied:tt $functions:ident $members:tt $prepare:tt
        $c:ident $constants:literal $k:ident $hoisted:literal $($array:ident $length:literal)*;
        $($name:ident($($t:ident)?; $($given:ident $kind:ident)*) -> $n:literal $body:tt)*
    ) => {
        type $c<R> = [R; $constants];
        $crate::program_function!(@ prepared $supplied $members $k $hoisted);
        $(#[allow(dead_code, reason = "small systems use few of them")] type $array<R> = [R; $length];)*
        $crate::program_function!(@ prepare $supplied $members $functions $c $k $prepare);
        $($crate::program_function! {
            $supplied $functions $c $k $name($($t)?; $($given $kind)*) -> $n $body
        })*
    };
}

/// A straight-line function of [`program_functions!`](crate::program_functions) where the program supplies functions: their types
/// with the numbers of their arguments, the name by which the code has them, and the function. The members of the tuple of
/// functions are several of one type where an array of instances has them.
#[doc(hidden)]
#[macro_export]
macro_rules! program_function {
    (
        [$($F:ident $N:literal)*] $functions:ident $c:ident $k:ident
        $name:ident($($t:ident)?; $($given:ident $kind:ident)*) -> $n:literal $body:tt
    ) => {
        #[inline]
        pub(super) fn $name<R: $crate::Real $(, $F: $crate::Smooth<$N>)*>(
            $c: &$c<R>, $k: &$k<R $(, $F)*>, $($t: R,)? $($given: &$kind<R>,)*
        ) -> [R; $n] {
            let $functions = &$k.functions;
            // The closure is compiled with the instructions of the real.
            <R as $crate::Real>::vectorize(#[inline(always)] || $body)
        }
    };
    (@ prepared [$($F:ident $N:literal)*] ($($members:tt)*) $k:ident $hoisted:literal) => {
        pub(super) type $k<R $(, $F)*> = $crate::Hoisted<R, $hoisted, ($($members)*)>;
    };
    (
        @ prepare [$($F:ident $N:literal)*] ($($members:tt)*) $functions:ident $c:ident $k:ident $values:tt
    ) => {
        #[inline]
        pub(super) fn prepare<R: $crate::Real $(, $F: $crate::Smooth<$N>)*>(
            $c: &$c<R>, $functions: ($($members)*),
        ) -> $k<R $(, $F)*> {
            $crate::Hoisted { values: $values, functions: $functions }
        }
    };
}

/// `Clone` and `Copy` of a struct over reals that are `Copy`, as all are, by the name of its parameter: what the compiler would derive clones field by field. With fields
/// behind a comma `PartialEq` too: what the compiler would derive makes it read the implementations of one trait more.
#[doc(hidden)]
#[macro_export]
macro_rules! copied {
    ($([$($F:ident $N:literal)*])? $R:ident $Name:ident) => {
        #[automatically_derived]
        impl<$R: ::core::marker::Copy $($(, $F: ::core::marker::Copy)*)?> ::core::clone::Clone for $Name<$R $($(, $F)*)?> {
            #[inline]
            fn clone(&self) -> Self {
                *self
            }
        }

        impl<$R: ::core::marker::Copy $($(, $F: ::core::marker::Copy)*)?> ::core::marker::Copy for $Name<$R $($(, $F)*)?> {}
    };
    ($([$($F:ident $N:literal)*])? $R:ident $Name:ident, $($field:ident)*) => {
        $crate::copied!($([$($F $N)*])? $R $Name);

        impl<$R: ::core::cmp::PartialEq $($(, $F: ::core::cmp::PartialEq)*)?> ::core::cmp::PartialEq for $Name<$R $($(, $F)*)?> {
            #[inline]
            fn eq(&self, other: &Self) -> bool {
                let _ = other;
                true $(&& self.$field == other.$field)*
            }
        }
    };
}

/// A struct of reals with conversions from and to an array, and the names of its fields: each field with its documentation
/// and the name of a local variable; before them `[raw]` where a field is a raw identifier.
#[doc(hidden)]
#[macro_export]
macro_rules! record {
    (@ [] $names:expr) => { $names };
    (@ [raw] $names:expr) => { $crate::checks::plain($names) };
    ($(#[$($docs:tt)*])* $Record:ident $n:literal $([$raw:ident])? $($(#[$($doc:tt)*])* $field:ident $local:ident,)*) => {
        $(#[$($docs)*])*
        #[::core::prelude::v1::derive(::core::default::Default)]
        pub struct $Record<R = f64> {
            $($(#[$($doc)*])* pub $field: R,)*
        }

        $crate::copied!(R $Record);

        impl $Record<f64> {
            /// The names of the fields, in order.
            pub const NAMES: [&'static str; $n] = $crate::record!(@ [$($raw)?] [$(::core::stringify!($field)),*]);
        }

        impl<R> $Record<R> {
            #[inline]
            fn __guen_array(self) -> [R; $n] {
                [$(self.$field),*]
            }

            #[inline]
            fn __guen_each(&self) -> [&R; $n] {
                [$(&self.$field),*]
            }
        }

        // By way of an array: the compiler has less to check than in what it would derive.
        impl<R: ::core::fmt::Debug> ::core::fmt::Debug for $Record<R> {
            fn fmt(&self, f: &mut ::core::fmt::Formatter<'_>) -> ::core::fmt::Result {
                $crate::checks::show(f, ::core::stringify!($Record), &$Record::<f64>::NAMES, &self.__guen_each())
            }
        }

        impl<R: ::core::cmp::PartialEq> ::core::cmp::PartialEq for $Record<R> {
            #[inline]
            fn eq(&self, other: &Self) -> bool {
                $crate::checks::equal(self.__guen_each(), other.__guen_each())
            }
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
                record.__guen_array()
            }
        }
    };
}

/// A struct of reals in fields and arrays, as [`record!`](crate::record): its fields, the names of the values, the ways to
/// them, and a literal of the struct from local variables and from default values.
#[doc(hidden)]
#[macro_export]
macro_rules! structured {
    (
        $(#[$($docs:tt)*])* $Record:ident $n:literal { $($fields:tt)* } [$($names:tt)*] [$($shown:ident)*]
        |$self:ident, $values:ident| ($array:expr) { $($literal:tt)* } { $($default:tt)* }
    ) => {
        $(#[$($docs)*])*
        #[::core::prelude::v1::derive(::core::clone::Clone, ::core::marker::Copy, ::core::cmp::PartialEq)]
        pub struct $Record<R = f64> {
            $($fields)*
        }

        impl $Record<f64> {
            /// The names of the values, in order.
            pub const NAMES: [&'static str; $n] = $crate::names!($n $($names)*);
        }

        impl<R: ::core::marker::Copy> $Record<R> {
            #[inline]
            fn __guen_array($self) -> [R; $n] {
                $array
            }
        }

        impl<R: ::core::default::Default> ::core::default::Default for $Record<R> {
            fn default() -> Self {
                $Record { $($default)* }
            }
        }

        impl<R: ::core::fmt::Debug> ::core::fmt::Debug for $Record<R> {
            fn fmt(&self, f: &mut ::core::fmt::Formatter<'_>) -> ::core::fmt::Result {
                let mut all = ::core::fmt::Formatter::debug_struct(f, ::core::stringify!($Record));
                $(all.field($crate::checks::plain([::core::stringify!($shown)])[0], &self.$shown);)*
                all.finish()
            }
        }

        impl<R: ::core::marker::Copy> ::core::convert::From<[R; $n]> for $Record<R> {
            #[inline]
            fn from($values: [R; $n]) -> Self {
                $Record { $($literal)* }
            }
        }

        impl<R: ::core::marker::Copy> ::core::convert::From<$Record<R>> for [R; $n] {
            #[inline]
            fn from(record: $Record<R>) -> Self {
                record.__guen_array()
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
        $([$($F:ident $N:literal)*])?
        $n:literal $last:literal
        $(X0 $docs:literal)? $($form:literal $X:ident $j:literal)*;
        $($r:literal $s:literal [$($known:tt)*])*
    ) => {
        #[doc = ::core::concat!(
            "The commutator `(X_I, X_J) = sum_t C_IJt X_t`, (1.14), for `I` and `J` from 0 to ", $last, "."
        )]
        ///
        /// `COEFFICIENTS` says of each coefficient whether it is zero, a number, constant or variable;
        /// `coefficients` computes their values at a time and state.
        // In braces, which say that they are constants: a system may be called `I` or `J`.
        pub type Bracket<const I: usize, const J: usize $($(, $F = f64)*)?> =
            $crate::Commutator<Prepared<f64 $($(, $F)*)?>, { I }, { J }, $n>;

        impl $(<$($F: $crate::Smooth<$N>),*>)? $crate::Frame<$n> for Prepared<f64 $($(, $F)*)?> {
            type Over<B: $crate::Real> = Prepared<B $($(, $F)*)?>;
            const LAST: usize = $last;
            const BRACKETS: &'static [(usize, usize, [$crate::Coefficient; $n])] = {
                #[allow(unused_imports, reason = "not every system has every kind of coefficient")]
                use $crate::Coefficient::{Constant, Number, Variable, Zero};
                &[$(($r, $s, [$($known)*])),*]
            };

            #[inline]
            fn operator<B: $crate::Real, R: $crate::Real + $crate::Lift<B>>(
                prepared: &Prepared<B $($(, $F)*)?>, t: R, x: &[R; $n], index: usize,
            ) -> [R; $n] {
                let lifted = prepared.lift::<R>();
                $crate::checks::row(&program::operators(&lifted.constants, &lifted.hoisted, t, x), index)
            }

            #[inline]
            fn bracket<B: $crate::Real, R: $crate::Real + $crate::Lift<B>>(
                prepared: &Prepared<B $($(, $F)*)?>, t: R, x: &[R; $n], place: usize,
            ) -> [R; $n] {
                $crate::values_of_brackets!(prepared, t, x, place, $n, $($r)*)
            }
        }

        $(
            #[doc = $docs]
            pub type X0 = $crate::Displacement<Prepared, 0>;
            #[doc = $docs]
            pub const X0: X0 = $crate::Displacement::NEW;
        )?
        $(
            #[doc = ::core::concat!("The operator `X_", $j, "` of the form `", $form, "`, (1.4).")]
            pub type $X = $crate::Displacement<Prepared, $j>;
            #[doc = ::core::concat!("The operator `X_", $j, "` of the form `", $form, "`, (1.4).")]
            pub const $X: $X = $crate::Displacement::NEW;
        )*
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
        let lifted = $prepared.lift::<R>();
        $crate::checks::row::<_, $n>(&program::brackets(&lifted.constants, &lifted.hoisted, $t, $x), $place)
    }};
}

#[cfg(test)]
mod tests {
    record! {
        /// A point.
        Point 2 [raw]
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
