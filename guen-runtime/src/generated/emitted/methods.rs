//! Methods of prepared systems that differ by sizes alone. Where a system has inputs, the name `inputs` comes last in the
//! calls and is that of the parameter.

/// The inputs as an array; an empty one where there are none.
#[doc(hidden)]
#[macro_export]
macro_rules! array_of_inputs {
    () => {
        []
    };
    ($inputs:ident) => {
        ::core::convert::From::from(*$inputs)
    };
}

/// `Simulate::onto_constraints` of a system with constraints on positions, with the number of states.
#[doc(hidden)]
#[macro_export]
macro_rules! onto_constraints {
    ($size:literal) => {
        #[inline]
        fn onto_constraints(
            &self,
            t: R,
            state: &mut [R; $size],
        ) -> ::core::result::Result<(), $crate::PositionsError>
        where
            R: $crate::Ordered,
        {
            $crate::project(self, t, state).map(|_| ())
        }
    };
}

/// The trait `OutputMap` of what steppers integrate, with the numbers of states and of outputs, the names of the outputs and their
/// units, if there are some, and where the prepared values and the inputs are.
#[doc(hidden)]
#[macro_export]
macro_rules! output_map {
    (
        $([$($F:ident $N:literal)*])?
        $Owner:ident $size:literal $count:literal [$($name:literal)*] [$($unit:literal)*] ($self:ident) => $prepared:expr, $given:expr
    ) => {
        impl<R: $crate::Real $($(, $F: $crate::Smooth<$N>)*)?> $crate::OutputMap<R, $size, $count> for $Owner<R $($(, $F)*)?> {
            type Outputs = Outputs<R>;
            const OUTPUTS: [&'static ::core::primitive::str; $count] = [$($name),*];
            const OUTPUT_UNITS: &'static [&'static ::core::primitive::str] = &[$($unit),*];

            #[inline]
            fn output_values(&$self, t: R, state: &[R; $size]) -> [R; $count] {
                program::outputs(&$prepared.constants, &$prepared.hoisted, t, state, $given)
            }

            #[inline]
            fn named_outputs(values: &[R; $count]) -> Outputs<R> {
                Outputs::from_values(values)
            }
        }
    };
}

/// `mass_form`, with the numbers of parameters and of inputs.
#[doc(hidden)]
#[macro_export]
macro_rules! mass_form {
    ($l:literal, $count:literal $(, $inputs:ident)?) => {
        /// The equations of motion apart, `M eta' + bias = G u`: the mass matrix, what the forces are without inputs
        /// with its sign turned, and the matrix of the inputs. Where forces are not affine in the inputs, `G` holds
        /// their derivatives, and the equation is exact at these inputs.
        pub fn mass_form(
            &self, t: R, state: &State<R> $(, $inputs: &Inputs<R>)?
        ) -> $crate::control::MassForm<R, $l, $count> {
            let given = &$crate::array_of_inputs!($($inputs)?);
            $crate::control::MassForm::unpacked(
                &program::mass_form(&self.constants, &self.hoisted, t, &state.__guen_array(), given)
            )
        }
    };
}

/// `mass_matrix`, `coriolis_and_gravity` and `gravity`, with the numbers of coordinates, of parameters, of states and of inputs, and the
/// programs of a mass matrix that is not diagonal and of forces besides those of the inputs, where there are some.
#[doc(hidden)]
#[macro_export]
macro_rules! dynamics {
    (@ $self:ident, $t:ident, $state:ident, $n:literal, $count:literal, []) => {
        program::mass_form(&$self.constants, &$self.hoisted, $t, &$state, &[R::zero(); $count])
    };
    (@ $self:ident, $t:ident, $state:ident, $n:literal, $count:literal, [$mass:ident]) => {
        program::$mass(&$self.constants, &$self.hoisted, $t, &$crate::checks::first::<R, $n>(&$state))
    };
    (@bias $self:ident, $t:ident, $state:ident, $idle:ident, $l:literal, []) => {{
        let entries = program::mass_form(&$self.constants, &$self.hoisted, $t, $state, $idle);
        ::core::array::from_fn(|s| entries[$l * ($l + 1) / 2 + s])
    }};
    (@bias $self:ident, $t:ident, $state:ident, $idle:ident, $l:literal, [$coasting:ident]) => {
        program::$coasting(&$self.constants, &$self.hoisted, $t, $state, $idle)
    };
    ($n:literal, $l:literal, $size:literal, $count:literal, [$($mass:ident)?], [$($coasting:ident)?]) => {
        /// The mass matrix `M`, symmetric: `M eta' + coriolis_and_gravity = forces`.
        pub fn mass_matrix(&self, t: R, state: &State<R>) -> [[R; $l]; $l] {
            let state: [R; $size] = ::core::convert::From::from(*state);
            $crate::checks::symmetric(&$crate::dynamics!(@ self, t, state, $n, $count, [$($mass)?]))
        }

        /// The generalised forces that inertia and the force function ask for at these velocities, `M eta' + coriolis_and_gravity =
        /// forces`: Coriolis and centrifugal terms, moving constraints, and [`gravity`](Self::gravity). Declared `forces` are none of
        /// it, whatever they depend on. Takes its own operations, or those of [`mass_form`](Self::mass_form) where no forces are declared.
        pub fn coriolis_and_gravity(&self, t: R, state: &State<R>) -> [R; $l] {
            let state = &::core::convert::From::from(*state);
            let idle = &[R::zero(); $count];
            $crate::dynamics!(@bias self, t, state, idle, $l, [$($coasting)?])
        }

        /// The generalised forces that balance the force function, `-X_s(U)`: gravity, and springs that are declared as a
        /// potential. Takes the operators and an evaluation of the force function in duals.
        pub fn gravity(&self, t: R, state: &State<R>) -> [R; $l] {
            let lifted = self.lift::<$crate::Dual<R, $l>>();
            let [value] = program::force_function(
                &lifted.constants, &lifted.hoisted, $crate::Dual::constant(t), &self.__guen_displaced(t, state),
            );
            value.tangent.map(|slope| -slope)
        }

        /// The coordinates with their displacements along the operators `X_1 .. X_l`.
        fn __guen_displaced(&self, t: R, state: &State<R>) -> [$crate::Dual<R, $l>; $n] {
            let state: [R; $size] = ::core::convert::From::from(*state);
            let x = $crate::checks::first::<R, $n>(&state);
            let operators = program::operators(&self.constants, &self.hoisted, t, &x);
            ::core::array::from_fn(|i| $crate::Dual {
                value: x[i],
                tangent: ::core::array::from_fn(|s| operators[(s + 1) * $n + i]),
            })
        }
    };
}

/// `jacobian` and `bias_acceleration` of outputs, with the numbers of coordinates, of parameters, of states and of inputs.
#[doc(hidden)]
#[macro_export]
macro_rules! jacobians {
    ($n:literal, $l:literal, $size:literal, $count:literal) => {
        /// The Jacobian of outputs that are places or angles, by the quasi-velocities: `J_ks = X_s(y_k)`, so that `y' = J eta`, and what
        /// time adds. `of` chooses a vector, `|outputs| outputs.tip`, or as many scalars as it likes. An output that depends on
        /// velocities is taken at these. Exact; takes the operators and an evaluation of the outputs in duals.
        pub fn jacobian<const K: usize>(
            &self,
            t: R,
            state: &State<R>,
            of: impl ::core::ops::Fn(&Outputs<$crate::Dual<R, $l>>) -> [$crate::Dual<R, $l>; K],
        ) -> [[R; $l]; K] {
            let s: [R; $size] = ::core::convert::From::from(*state);
            let displaced = self.__guen_displaced(t, state);
            let moved: [$crate::Dual<R, $l>; $size] =
                ::core::array::from_fn(|i| if i < $n { displaced[i] } else { $crate::Dual::constant(s[i]) });
            let lifted = self.lift::<$crate::Dual<R, $l>>();
            let idle = &[<$crate::Dual<R, $l> as $crate::Real>::zero(); $count];
            let outputs =
                program::outputs(&lifted.constants, &lifted.hoisted, $crate::Dual::constant(t), &moved, idle);
            of(&Outputs::from_values(&outputs)).map(|value| value.tangent)
        }

        /// The accelerations of outputs that are places or angles while no quasi-velocity changes, `J' eta` and what time adds: with
        /// [`jacobian`](Self::jacobian) `y'' = J eta' + bias_acceleration`. `of` as there. Exact; takes the velocities in duals, and the
        /// outputs in duals over duals.
        pub fn bias_acceleration<const K: usize>(
            &self,
            t: R,
            state: &State<R>,
            of: impl ::core::ops::Fn(
                &Outputs<$crate::Dual<$crate::Dual<R, 1>, 1>>,
            ) -> [$crate::Dual<$crate::Dual<R, 1>, 1>; K],
        ) -> [R; K] {
            let (zero, one) = (R::zero(), R::one());
            let s: [R; $size] = ::core::convert::From::from(*state);
            let velocities = program::velocities(&self.constants, &self.hoisted, t, &s);
            let inner = self.lift::<$crate::Dual<R, 1>>();
            let along: [$crate::Dual<R, 1>; $size] = ::core::array::from_fn(|i| $crate::Dual {
                value: s[i],
                tangent: [if i < $n { velocities[i] } else { zero }],
            });
            let time = $crate::Dual { value: t, tangent: [one] };
            let rates = program::velocities(&inner.constants, &inner.hoisted, time, &along);
            let moved = ::core::array::from_fn(|i| $crate::Dual {
                value: along[i],
                tangent: [if i < $n { rates[i] } else { $crate::Dual::constant(zero) }],
            });
            let lifted = self.lift::<$crate::Dual<$crate::Dual<R, 1>, 1>>();
            let time = $crate::Dual { value: time, tangent: [$crate::Dual::constant(one)] };
            let idle = &[$crate::Dual::constant($crate::Dual::constant(zero)); $count];
            let outputs = program::outputs(&lifted.constants, &lifted.hoisted, time, &moved, idle);
            of(&Outputs::from_values(&outputs)).map(|value| value.tangent[0].tangent[0])
        }
    };
}

/// `steady_motion` and `equilibrium`, with the numbers of states and of inputs; on constraints on positions with a word for these.
#[doc(hidden)]
#[macro_export]
macro_rules! steady_motions {
    ($size:literal, $count:literal $(; on $constraints:ident)?) => {
        $crate::steady_motions!(
            @ [$($constraints)?] $size, $count, State<R>, [], [], (state, []) => ::core::convert::From::from(state);
        );
    };
    ($size:literal, $count:literal, $inputs:ident $(; on $constraints:ident)?) => {
        $crate::steady_motions!(
            @ [$($constraints)?] $size, $count, (State<R>, Inputs<R>), ::core::convert::From::from(*$inputs),
            Inputs::<f64>::NAMES,
            (state, held) => (::core::convert::From::from(state), ::core::convert::From::from(held));
            $inputs
        );
    };
    (@ search []) => { $crate::control::steady };
    (@ search [constraints]) => { $crate::control::steady_on_constraints };
    (
        @ $on:tt $size:literal, $count:literal, $Motion:ty, $held:expr, $names:expr, $found:pat => $motion:expr;
        $($inputs:ident)?
    ) => {
        /// A steady motion near a guess: the rates of everything vanish but of what is `drifting`, such as the place of a
        /// car that drives in a circle.
        ///
        /// The search stays near the guess, and on the holonomic constraints. What is fixed, and what drifts, stays as it is
        /// in the guess; names are those of the state and of the inputs. Newton's method with the exact linearisation.
        ///
        /// # Errors
        ///
        /// An unknown name; a family of solutions, of which as many further quantities have to be fixed as it has
        /// dimensions; no solution near the guess.
        pub fn steady_motion(
            &self, t: R, state: &State<R> $(, $inputs: &Inputs<R>)?, drifting: &[&'static str], fixed: &[&'static str],
        ) -> ::core::result::Result<$Motion, $crate::control::SteadyError> {
            let request = $crate::control::SteadyMotion::<$size, $count>::of_names(
                drifting, fixed, &State::<f64>::NAMES, &$names,
            )?;
            let search = $crate::steady_motions!(@ search $on);
            let $found = search(self, t, &state.__guen_array(), &$held, &request)?;
            ::core::result::Result::Ok($motion)
        }

        /// An equilibrium near a guess: all rates vanish.
        ///
        /// The search stays near the guess, and on the holonomic constraints. What is fixed stays as it is in the guess;
        /// names are those of the state and of the inputs. Newton's method with the exact linearisation.
        ///
        /// # Errors
        ///
        /// An unknown name; a family of solutions, of which as many further quantities have to be fixed as it has
        /// dimensions; no solution near the guess.
        pub fn equilibrium(
            &self, t: R, state: &State<R> $(, $inputs: &Inputs<R>)?, fixed: &[&'static str],
        ) -> ::core::result::Result<$Motion, $crate::control::SteadyError> {
            self.steady_motion(t, state $(, $inputs)?, &[], fixed)
        }
    };
}

/// `reduce`, with the numbers of coordinates, of states, of inputs, of the reduced basis and of integrable combinations, the
/// program of their differentials if there are some, and the components of the quaternions.
#[doc(hidden)]
#[macro_export]
macro_rules! reduce {
    (
        $n:literal, $size:literal, $count:literal, $reduced:literal, $combinations:literal,
        [$($leaf:ident)?], [$($quaternion:tt)*] $(, $inputs:ident)?
    ) => {
        /// The linearisation on the leaf of all integrable combinations of constraints: independent positions, then the
        /// parameters, [`REDUCED`] in all. Coordinates named in `independent` stay independent, the others are chosen by
        /// pivots; of a quaternion its three rotation components are taken. `names` of the result has what they are called. Exact at equilibria and away from them.
        ///
        /// # Errors
        ///
        /// An unknown name; more names than there are independent positions, or an edge of the chart.
        pub fn reduce(
            &self, t: R, state: &State<R> $(, $inputs: &Inputs<R>)?, independent: &[&'static str],
        ) -> ::core::result::Result<
            $crate::control::Reduced<R, $size, $count, $reduced>,
            $crate::control::ReduceError,
        > {
            let s = state.__guen_array();
            let entries: &[R] = &[];
            $(let entries = &program::$leaf(&self.constants, &self.hoisted, t, &$crate::checks::first(&s));)?
            let _ = entries;
            let leaf = $crate::control::Leaf::<R, $n, $combinations>::at(
                &s,
                program::velocities(&self.constants, &self.hoisted, t, &s),
                entries,
                &[$($quaternion)*],
                $crate::control::independent(independent, &State::<f64>::NAMES)?,
                &State::<f64>::NAMES,
            );
            let given = &$crate::array_of_inputs!($($inputs)?);
            let rates = program::rhs(&self.constants, &self.hoisted, t, &s, given);
            leaf.reduce(&self.linearize(t, state $(, $inputs)?), &rates)
        }
    };
}

/// Implements the traits of the runtime's analyses: rates and linearisation over arrays, with the inputs beside the
/// state.
#[doc(hidden)]
#[macro_export]
macro_rules! linearizable {
    (@ is modes) => { true };
    ($([$($functions:tt)*])? $size:literal, $count:literal; by duals $(; through $modes:ident)?) => {
        $crate::linearizable!(
            @ rates [$($($functions)*)?] [$($modes)?] $size, $count, [$crate::linearized(self, t, state, given)]
            (self, t, state, given)
        );
    };
    ($([$($functions:tt)*])? $size:literal, $count:literal $(, $inputs:ident)? $(; through $modes:ident)?) => {
        $crate::linearizable!(@ rates [$($($functions)*)?] [$($modes)?] $size, $count, [{
            let _ = given;
            $(let $inputs = &::core::convert::From::from(*given);)?
            self.linearize(t, &::core::convert::From::from(*state) $(, $inputs)?)
        }] (self, t, state, given));
    };
    (
        @ rates [$($F:ident $N:literal)*] [$($modes:ident)?] $size:literal, $count:literal, [$linearization:expr]
        ($self:ident, $t:ident, $state:ident, $given:ident)
    ) => {
        impl<R: $crate::Real $(, $F: $crate::Smooth<$N>)*> $crate::Liftable<R, $size, $count> for Prepared<R $(, $F)*> {
            $(const THROUGH_MODES: bool = $crate::linearizable!(@ is $modes);)?

            #[inline]
            fn lifted_rates<S: $crate::Real + $crate::Lift<R>>(
                &self,
                t: S,
                state: &[S; $size],
                given: &[S; $count],
            ) -> [S; $size] {
                let lifted = self.lift::<S>();
                program::rhs(&lifted.constants, &lifted.hoisted, t, state, given)
            }
        }

        impl<R $(, $F: $crate::Smooth<$N>)*> $crate::Linearizable<R, $size, $count> for Prepared<R $(, $F)*>
        where
            R: $crate::Lift<R>,
        {
            #[inline]
            fn rates(&self, t: R, state: &[R; $size], given: &[R; $count]) -> [R; $size] {
                program::rhs(&self.constants, &self.hoisted, t, state, given)
            }

            #[inline]
            fn linearization(
                &$self,
                $t: R,
                $state: &[R; $size],
                $given: &[R; $count],
            ) -> $crate::Linearization<R, $size, $count> {
                $linearization
            }
        }
    };
}

/// A system with inputs and what steppers integrate of it, with the number of states and what it is called.
#[doc(hidden)]
#[macro_export]
macro_rules! actuated {
    ($([$($F:ident $N:literal)*])? $size:literal, $what:literal) => {
        #[doc = ::core::concat!("A ", $what, ", prepared, with inputs that are held: what steppers integrate during a step.")]
        #[::core::prelude::v1::derive(::core::fmt::Debug)]
        pub struct Driven<R = f64 $($(, $F = f64)*)?> {
            #[doc = ::core::concat!("The ", $what, ".")]
            pub system: Prepared<R $($(, $F)*)?>,
            /// The inputs that are held.
            pub inputs: Inputs<R>,
        }

        $crate::copied!($([$($F $N)*])? R Driven, system inputs);

        impl<R: $crate::Real $($(, $F: $crate::Smooth<$N>)*)?> Prepared<R $($(, $F)*)?> {
            #[doc = ::core::concat!("The ", $what, " with these inputs held.")]
            #[inline]
            pub fn driven(&self, inputs: Inputs<R>) -> Driven<R $($(, $F)*)?> {
                Driven { system: *self, inputs }
            }
        }

        impl<R: $crate::Real $($(, $F: $crate::Smooth<$N>)*)?> $crate::Actuated<R, $size> for Prepared<R $($(, $F)*)?> {
            type Inputs = Inputs<R>;
            type Driven = Driven<R $($(, $F)*)?>;

            #[inline]
            fn held(&self, inputs: Inputs<R>) -> Driven<R $($(, $F)*)?> {
                self.driven(inputs)
            }
        }

        impl<R: $crate::Real $($(, $F: $crate::Smooth<$N>)*)?> $crate::InputRecords for Prepared<R $($(, $F)*)?> {
            type StateOver<S: $crate::Real> = State<S>;
            type InputsOver<S: $crate::Real> = Inputs<S>;
        }
    };
}
