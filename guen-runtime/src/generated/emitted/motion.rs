//! Methods and traits of a prepared system that its straight-line functions compute: the same for every system but for sizes.

/// `rhs`.
#[doc(hidden)]
#[macro_export]
macro_rules! rates {
    ($($inputs:ident)?) => {
        /// The rates of the state: velocities by (1.8), accelerations by (2.7). No allocation, no branch.
        #[inline]
        pub fn rhs(&self, t: R, state: &State<R> $(, $inputs: &Inputs<R>)?) -> State<R> {
            ::core::convert::From::from(program::rhs(
                &self.constants,
                &self.hoisted,
                t,
                &state.__guen_array(),
                &$crate::array_of_inputs!($($inputs)?),
            ))
        }
    };
}

/// A method of time and state with one result, by the function of its name.
#[doc(hidden)]
#[macro_export]
macro_rules! quantity {
    ($(#[$($docs:tt)*])* $method:ident) => {
        $(#[$($docs)*])*
        #[inline]
        pub fn $method(&self, t: R, state: &State<R>) -> R {
            let [value] =
                program::$method(&self.constants, &self.hoisted, t, &state.__guen_array());
            value
        }
    };
}

/// `energy`.
#[doc(hidden)]
#[macro_export]
macro_rules! energy {
    () => {
        $crate::quantity! {
            /// The energy integral `h = sum x' dT°/dx' - T° - U`; kinetic plus potential energy where `T°` is homogeneous
            /// in the velocities.
            energy
        }
    };
}

/// `momenta`.
#[doc(hidden)]
#[macro_export]
macro_rules! momenta {
    () => {
        /// The momenta `dT/d eta_s`, and `(dT°/d eta_v)` for the constraints, (2.8).
        #[inline]
        pub fn momenta(&self, t: R, state: &State<R>) -> Momenta<R> {
            ::core::convert::From::from(program::momenta(
                &self.constants,
                &self.hoisted,
                t,
                &state.__guen_array(),
            ))
        }
    };
}

/// The items of the system itself that no scene can choose, with the numbers of coordinates, of parameters and of states, and the program
/// of the power where it is not zero.
#[doc(hidden)]
#[macro_export]
macro_rules! motion_of_system {
    (@ $self:ident, $t:ident, $state:ident, [], $n:literal, $l:literal, $size:literal $(, $inputs:ident)?) => {{
        let _ = ($t, $state $(, $inputs)?);
        R::zero()
    }};
    (@ $self:ident, $t:ident, $state:ident, [$power:ident], $n:literal, $l:literal, $size:literal $(, $inputs:ident)?) => {{
        let [value] = $crate::at_accelerations!($self, $t, $state, $power, $n, $l, $size $(, $inputs)?);
        value
    }};
    ([$($power:ident)?], $n:literal, $l:literal, $size:literal $(, $inputs:ident)?) => {
        /// The velocities `x' = xi_0 + sum_s eta_s xi_s` of a state, (1.8).
        #[inline]
        pub fn velocities(&self, t: R, state: &State<R>) -> Coordinates<R> {
            ::core::convert::From::from(program::velocities(
                &self.constants,
                &self.hoisted,
                t,
                &state.__guen_array(),
            ))
        }

        $crate::quantity! {
            /// The kinetic energy `T` on the constraints.
            kinetic_energy
        }

        /// The force function `U`.
        #[inline]
        pub fn force_function(&self, t: R, state: &State<R>) -> R {
            let s = state.__guen_array();
            let [value] =
                program::force_function(&self.constants, &self.hoisted, t, &$crate::checks::first::<R, $n>(&s));
            value
        }

        /// The rate of [`energy`](Self::energy) along the motion, by forces, moving constraints and explicit time:
        /// `h' = Q.x' - sum_v lambda_v a_v0 - d(T° + U)/dt`.
        #[inline]
        pub fn power(&self, t: R, state: &State<R> $(, $inputs: &Inputs<R>)?) -> R {
            $crate::motion_of_system!(@ self, t, state, [$($power)?], $n, $l, $size $(, $inputs)?)
        }
    };
}

/// A function of time, state, inputs and the accelerations there.
#[doc(hidden)]
#[macro_export]
macro_rules! at_accelerations {
    ($self:ident, $t:ident, $state:ident, $of:ident, $n:literal, $l:literal, $size:literal $(, $inputs:ident)?) => {{
        let s = $state.__guen_array();
        let given = &$crate::array_of_inputs!($($inputs)?);
        let rates = program::rhs(&$self.constants, &$self.hoisted, $t, &s, given);
        program::$of(
            &$self.constants,
            &$self.hoisted,
            $t,
            &s,
            given,
            &$crate::checks::first::<R, $l>(rates.split_at($n).1),
        )
    }};
}

/// `reactions`, and where all are known `reaction_covector`.
#[doc(hidden)]
#[macro_export]
macro_rules! reactions {
    ($n:literal, $l:literal, $size:literal $(, $inputs:ident)?) => {
        /// The reactions at a state, from `lambda_v = d/dt (dT°/d eta_v) - X_v(T° + U) - ... - Q_v` on the motion.
        #[inline]
        pub fn reactions(&self, t: R, state: &State<R> $(, $inputs: &Inputs<R>)?) -> Reactions<R> {
            ::core::convert::From::from(
                $crate::at_accelerations!(self, t, state, reactions, $n, $l, $size $(, $inputs)?)
            )
        }
    };
}

/// `reaction_covector`.
#[doc(hidden)]
#[macro_export]
macro_rules! reaction_covector {
    ($n:literal, $l:literal, $size:literal $(, $inputs:ident)?) => {
        /// The reactions of all constraints as one covector on the velocities, `R_i = sum_v lambda_v a_vi`: the
        /// generalised force on every coordinate.
        pub fn reaction_covector(&self, t: R, state: &State<R> $(, $inputs: &Inputs<R>)?) -> Coordinates<R> {
            ::core::convert::From::from(
                $crate::at_accelerations!(self, t, state, reaction_covector, $n, $l, $size $(, $inputs)?)
            )
        }
    };
}

/// `domain` and `distances`, with the numbers of functions and of states; of states alone where there is no function.
#[doc(hidden)]
#[macro_export]
macro_rules! domain {
    ($size:literal) => {
        /// Functions that must not vanish: where one of them is zero the declaration's chart ends. Their formulas
        /// are in [`DOMAIN`].
        #[inline]
        pub fn domain(&self, _t: R, _state: &State<R>) -> [R; 0] {
            []
        }

        /// Returns the distance of the state from the edge of the chart: of each function of [`DOMAIN`] what is left of it, from one
        /// where it is as certain as what it is made of to zero where it vanishes. Times and states count as rounded
        /// once; so do the constants. See [`RunningError`](__guen::RunningError).
        pub fn distances(&self, _t: R, _state: &State<R>) -> [R; 0] {
            []
        }
    };
    ($size:literal, $count:literal) => {
        /// Functions that must not vanish: where one of them is zero the declaration's chart ends. Their formulas
        /// are in [`DOMAIN`].
        #[inline]
        pub fn domain(&self, t: R, state: &State<R>) -> [R; $count] {
            program::domain(&self.constants, &self.hoisted, t, &state.__guen_array())
        }

        /// Returns the distance of the state from the edge of the chart: of each function of [`DOMAIN`] what is left of it, from one
        /// where it is as certain as what it is made of to zero where it vanishes. Times and states count as rounded
        /// once; so do the constants. See [`RunningError`](__guen::RunningError).
        pub fn distances(&self, t: R, state: &State<R>) -> [R; $count] {
            $crate::checks::left(program::domain(
                &$crate::checks::rounded(&self.constants),
                &$crate::PreparedValues::rounded_once(&self.hoisted),
                $crate::RunningError::once(t),
                &$crate::checks::rounded_once(state.__guen_array()),
            ))
        }
    };
}

/// `condition`, with the number of states.
#[doc(hidden)]
#[macro_export]
macro_rules! condition {
    ($size:literal $(, $inputs:ident)?) => {
        /// Returns the condition of the equations for the accelerations, whatever the units: one where parameters are
        /// not coupled. See [`Guarded::condition`](__guen::Guarded::condition).
        pub fn condition(&self, t: R, state: &State<R>) -> R {
            let system = self;
            $(
                // Masses do not depend on inputs.
                let $inputs = ::core::default::Default::default();
                let system = &system.driven($inputs);
            )?
            $crate::Guarded::<R, $size>::condition(system, t, &state.__guen_array())
        }
    };
}

/// `State::from_velocities` and `State::coordinates`, with the numbers of coordinates, of parameters, of states and of
/// constraints.
#[doc(hidden)]
#[macro_export]
macro_rules! state_of_system {
    ($([$($F:ident $N:literal)*])? $n:literal, $l:literal, $size:literal, $constraints:literal) => {
        impl<R: $crate::Real> State<R> {
            /// The state at given coordinates and velocities: the quasi-velocities are `eta_s = sum_i a_si x_i' +
            /// a_s0`, (1.6). Beside it the residuals `eta_v` of the constraints (their rates, where they are
            /// holonomic): how far the velocities are from being possible. States beside the motion are zero.
            pub fn from_velocities$(<$($F: $crate::Smooth<$N>),*>)?(
                system: &Prepared<R $($(, $F)*)?>,
                t: R,
                coordinates: &Coordinates<R>,
                velocities: &Coordinates<R>,
            ) -> (Self, [R; $constraints]) {
                let x = coordinates.__guen_array();
                let w = velocities.__guen_array();
                let forms = program::forms(&system.constants, &system.hoisted, t, &x, &w);
                let state: [R; $size] = $crate::checks::joined(&x, forms.split_at($l).0);
                (::core::convert::From::from(state), $crate::checks::first(forms.split_at($l).1))
            }

            /// The coordinates of the state.
            pub fn coordinates(&self) -> Coordinates<R> {
                ::core::convert::From::from($crate::checks::first::<R, $n>(&self.__guen_array()))
            }
        }
    };
}

/// The trait `Differentiable`, by dual numbers over the real: of a prepared system with the number of states, or of a driven
/// one with that of inputs, too. After `; code` the Jacobian is that of `linearize`.
#[doc(hidden)]
#[macro_export]
macro_rules! differentiable {
    ($([$($functions:tt)*])? $size:literal $(; $code:ident)?) => {
        $crate::differentiable!(
            @ [$($($functions)*)?] Prepared, $size, (self, t, state) => self, |_| []
            $(; $code self.linearize(t, &::core::convert::From::from(*state)))?
        );
    };
    ($([$($functions:tt)*])? $size:literal, $count:literal $(; $code:ident)?) => {
        $crate::differentiable!(
            @ [$($($functions)*)?] Driven, $size, (self, t, state) => self.system, |held|
            <[R; $count] as ::core::convert::From<Inputs<R>>>::from(self.inputs).map(held)
            $(; $code self.system.linearize(t, &::core::convert::From::from(*state), &self.inputs))?
        );
    };
    (@ implementation [] [$($F:ident $N:literal)*] $Owner:ident, $size:literal $methods:tt) => {
        impl<R: $crate::Real $(, $F: $crate::Smooth<$N>)*> $crate::Differentiable<R, $size> for $Owner<R $(, $F)*>
        where
            $crate::Dual<R, $size>: $crate::Lift<R>,
            $crate::Dual<R, 1>: $crate::Lift<R>,
        $methods
    };
    (@ implementation [$code:ident] [$($F:ident $N:literal)*] $Owner:ident, $size:literal $methods:tt) => {
        impl<R: $crate::Real $(, $F: $crate::Smooth<$N>)*> $crate::Differentiable<R, $size> for $Owner<R $(, $F)*>
        where
            $crate::Dual<R, 1>: $crate::Lift<R>,
        $methods
    };
    (@ jacobian $size:literal, ($t:ident, $state:ident) => $prepared:expr, $given:expr) => {{
        let lifted = $prepared.lift::<$crate::Dual<R, $size>>();
        let rates = program::rhs(
            &lifted.constants,
            &lifted.hoisted,
            <$crate::Dual<R, $size>>::constant($t),
            &$crate::seeded($state),
            &($given)(<$crate::Dual<R, $size>>::constant),
        );
        $crate::tangents(rates)
    }};
    (@ jacobian $size:literal, ($t:ident, $state:ident) => $prepared:expr, $given:expr; code $linearized:expr) => {
        $linearized.a
    };
    (
        @ $functions:tt $Owner:ident, $size:literal, ($self:ident, $t:ident, $state:ident) => $prepared:expr, $given:expr
        $(; $code:ident $linearized:expr)?
    ) => {
        $crate::differentiable! {
            @ implementation [$($code)?] $functions $Owner, $size {
            fn jacobian(&$self, $t: R, $state: &[R; $size]) -> [[R; $size]; $size] {
                $crate::differentiable!(@ jacobian $size, ($t, $state) => $prepared, $given $(; $code $linearized)?)
            }

            fn along(&$self, t: R, state: &[R; $size], dt: R, dx: &[R; $size]) -> [R; $size] {
                let lifted = $prepared.lift::<$crate::Dual<R, 1>>();
                let (time, state) = $crate::moving(t, state, dt, dx);
                let given = &($given)(<$crate::Dual<R, 1>>::constant);
                $crate::slopes(program::rhs(&lifted.constants, &lifted.hoisted, time, &state, given))
            }
            }
        }
    };
}

/// The trait `Laned` of a prepared system without inputs and without constants that follow others.
#[doc(hidden)]
#[macro_export]
macro_rules! laned {
    ($size:literal) => {
        impl $crate::Laned<$size> for Prepared<f64> {
            type Over<L: $crate::lanes::Lanes> = Prepared<L>;

            fn gather<'a, L: $crate::lanes::Lanes>(
                member: impl ::core::ops::Fn(usize) -> &'a Self,
            ) -> Prepared<L> {
                Prepared {
                    constants: $crate::lanes::gathered(|lane| &member(lane).constants),
                    hoisted: $crate::lanes::gathered(|lane| &member(lane).hoisted),
                }
            }
        }
    };
}

/// The prepared system: its documentation, the number of constants, the type of what is prepared, and where constants follow others the
/// field that says which, with their number.
#[doc(hidden)]
#[macro_export]
macro_rules! prepared {
    (
        $([$($F:ident $N:literal)*])?
        $docs:literal $count:literal $hoisted:ty $(, $follows:ident $derived:literal)?
    ) => {
        #[doc = $docs]
        #[::core::prelude::v1::derive(::core::fmt::Debug)]
        pub struct Prepared<R = f64 $($(, $F = f64)*)?> {
            constants: [R; $count],
            hoisted: $hoisted,
            $($follows: [bool; $derived],)?
        }

        $crate::copied!($([$($F $N)*])? R Prepared, constants hoisted $($follows)?);

        impl<R: $crate::Real $($(, $F: $crate::Smooth<$N>)*)?> Prepared<R $($(, $F)*)?> {
            /// The system over a real that contains `R`, such as duals over it: every prepared value becomes
            /// a constant there.
            pub fn lift<S: $crate::Lift<R>>(&self) -> Prepared<S $($(, $F)*)?> {
                Prepared {
                    constants: self.constants.map(S::lift),
                    hoisted: self.hoisted.map(S::lift),
                    $($follows: self.$follows,)?
                }
            }
        }
    };
}

/// `WithScalar`, from the constants over another real: of the constants and of the prepared system, or with inputs of the system that
/// holds them.
#[doc(hidden)]
#[macro_export]
macro_rules! with_scalar {
    ($([$($F:ident $N:literal)*])? $system:ident $size:literal, $constants:ident: $made:expr) => {
        impl $(<$($F: $crate::Smooth<$N>),*>)? $crate::WithScalar<$size> for $system<f64 $($(, $F)*)?> {
            type Over<R: $crate::Real> = Prepared<R $($(, $F)*)?>;

            fn with_scalar<R: $crate::Real>(
                &self,
            ) -> ::core::result::Result<Prepared<R $($(, $F)*)?>, $crate::ConstantsError> {
                let $constants = self;
                let _ = $constants;
                $made.prepare()
            }
        }

        impl $(<$($F: $crate::Smooth<$N>),*>)? $crate::WithScalar<$size> for Prepared<f64 $($(, $F)*)?> {
            type Over<R: $crate::Real> = Prepared<R $($(, $F)*)?>;

            fn with_scalar<R: $crate::Real>(
                &self,
            ) -> ::core::result::Result<Prepared<R $($(, $F)*)?>, $crate::ConstantsError> {
                $crate::WithScalar::with_scalar(&self.constants())
            }
        }
    };
    ($([$($F:ident $N:literal)*])? $system:ident $size:literal, $constants:ident: $made:expr, $inputs:literal) => {
        impl $(<$($F: $crate::Smooth<$N>),*>)? $crate::WithScalar<$size> for Driven<f64 $($(, $F)*)?> {
            type Over<R: $crate::Real> = Driven<R $($(, $F)*)?>;

            fn with_scalar<R: $crate::Real>(
                &self,
            ) -> ::core::result::Result<Driven<R $($(, $F)*)?>, $crate::ConstantsError> {
                let $constants = self.system.constants();
                let _ = &$constants;
                let inputs: [f64; $inputs] = ::core::convert::From::from(self.inputs);
                ::core::result::Result::Ok(Driven {
                    system: $made.prepare()?,
                    inputs: ::core::convert::From::from(inputs.map(R::from_f64)),
                })
            }
        }
    };
}

/// `System::guarded` of a system that answers itself, with the number of states.
#[doc(hidden)]
#[macro_export]
macro_rules! guarded {
    ($size:literal) => {
        #[inline]
        fn guarded(&self) -> impl $crate::Guarded<R, $size> {
            self
        }
    };
}

/// The methods of the trait `Guarded`: the path to the prepared system, the numbers of coordinates and of states, the cost of a check and, in
/// hundredths, that of its singularities, `kept` where the energy is constant, `positions` where there are holonomic constraints, the
/// number of functions that must not vanish, and that of parameters where there is a mass matrix to look at.
#[doc(hidden)]
#[macro_export]
macro_rules! guard_answers {
    (
        $self:ident $(. $inner:ident)?; $n:literal $size:literal, $all:literal $hundredths:literal, [$($kept:ident)?] [$($positions:ident)?]
        $([$edges:literal])? $(; $l:literal)?
    ) => {
        fn conserved(&$self, t: R, state: &[R; $size]) -> $crate::Invariants<R> {
            <R as $crate::Real>::vectorize(#[inline(always)] || {
                let prepared = &$self $(.$inner)?;
                let x: [R; $n] = $crate::checks::head(state);
                let _ = (prepared, t, &x);
                let (energy, scale) = $crate::guard_answers!(@ energy [$($kept)?] prepared t state x);
                let residual = $crate::guard_answers!(@ residual [$($positions)?] prepared t x);
                $crate::Invariants { energy, scale, residual, carried: R::zero() }
            })
        }

        $crate::guard_answers!(@ singularities [$self $(. $inner)?] $size $($edges)?);
        $crate::guard_answers!(@ condition [$self $(. $inner)?] $n $size $($l)?);

        fn check_costs(&$self) -> $crate::CheckCosts {
            $crate::CheckCosts::of($all, $hundredths)
        }
    };
    (@ singularities [$self:ident $(. $inner:ident)?] $size:literal) => {};
    (@ singularities [$self:ident $(. $inner:ident)?] $size:literal $edges:literal) => {
        #[inline]
        fn singularities(
            &$self,
            t: $crate::RunningError<R>,
            state: &[$crate::RunningError<R>; $size],
            values: &mut [$crate::RunningError<R>],
        ) -> usize {
            let prepared = &$self $(.$inner)?;
            let (constants, hoisted) =
                (&$crate::checks::rounded(&prepared.constants), &$crate::PreparedValues::rounded_once(&prepared.hoisted));
            $crate::checks::placed(values, &program::domain(constants, hoisted, t, state), $edges)
        }
    };
    (@ condition [$self:ident $(. $inner:ident)?] $n:literal $size:literal) => {};
    (@ condition [$self:ident $(. $inner:ident)?] $n:literal $size:literal $l:literal) => {
        fn condition(&$self, t: R, state: &[R; $size]) -> R {
            <R as $crate::Real>::vectorize(#[inline(always)] || {
                let prepared = &$self $(.$inner)?;
                let x: [R; $n] = $crate::checks::head(state);
                $crate::checks::condition::<R, $l>(&program::mass(&prepared.constants, &prepared.hoisted, t, &x))
            })
        }
    };
    (@ energy [] $prepared:ident $t:ident $state:ident $x:ident) => {
        (::core::option::Option::None, R::zero())
    };
    (@ energy [kept] $prepared:ident $t:ident $state:ident $x:ident) => {{
        let [energy] = program::energy(&$prepared.constants, &$prepared.hoisted, $t, $state);
        let [kinetic] = program::kinetic_energy(&$prepared.constants, &$prepared.hoisted, $t, $state);
        let [potential] = program::force_function(&$prepared.constants, &$prepared.hoisted, $t, &$x);
        let scale = $crate::Real::abs(kinetic) + $crate::Real::abs(potential);
        (::core::option::Option::Some(energy), scale)
    }};
    (@ residual [] $prepared:ident $t:ident $x:ident) => {
        R::zero()
    };
    (@ residual [positions] $prepared:ident $t:ident $x:ident) => {
        $crate::checks::furthest(&program::positions(
            &$crate::checks::rounded(&$prepared.constants),
            &$crate::PreparedValues::rounded_once(&$prepared.hoisted),
            $crate::RunningError::once($t),
            &$crate::checks::positions_rounded_once($x),
        ))
    };
}

/// `switches` of the trait `System`: the path to the prepared system, the numbers of states and of functions, and the inputs.
#[doc(hidden)]
#[macro_export]
macro_rules! switches {
    ($self:ident $(. $inner:ident)?; $size:literal $count:literal $inputs:expr) => {
        #[inline]
        fn switches(&$self, t: R, state: &[R; $size], values: &mut [R]) -> usize {
            let prepared = &$self $(.$inner)?;
            let found = program::switches(&prepared.constants, &prepared.hoisted, t, state, &$inputs);
            $crate::checks::placed(values, &found, $count)
        }
    };
}

/// `prepare` of the constants: the struct, their number, their values, the functions that the program supplies if there are some, the
/// checks of the constants, and those of the prepared system.
#[doc(hidden)]
#[macro_export]
macro_rules! prepare {
    (
        $([$($F:ident $N:literal)*])?
        $self:ident $constants:ident $hoisted:ident $prepared:ident; $System:ident $count:literal, $values:expr
        $(, functions $functions:expr)?,
        { $($checks:tt)* } { $($pivots:tt)* } { $($follows:tt)* } { $($limits:tt)* } { $($further:tt)* }
    ) => {
        impl<R: $crate::Real $($(, $F: $crate::Smooth<$N>)*)?> $System<R $($(, $F)*)?> {
            /// Checks the constants and computes what depends on them alone.
            ///
            /// # Errors
            ///
            /// A constant that is not finite or outside of its bound, or constants that make something vanish
            /// which the equations divide by.
            pub fn prepare($self) -> ::core::result::Result<Prepared<R $($(, $F)*)?>, $crate::ConstantsError> {
                let $constants: [R; $count] = $values;
                $($checks)*
                let $hoisted = program::prepare(&$constants $(, $functions)?);
                $($pivots)*
                let $prepared = Prepared { constants: $constants, hoisted: $hoisted, $($follows)* };
                $($limits)*
                $crate::checks::check_hoisted(&$prepared.hoisted)?;
                $($further)*
                ::core::result::Result::Ok($prepared)
            }
        }
    };
}
