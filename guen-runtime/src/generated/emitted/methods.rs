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

/// The trait `OutputMap` of what steppers integrate, with the numbers of states and of outputs, the names of the outputs, and where
/// the prepared values and the inputs are.
#[doc(hidden)]
#[macro_export]
macro_rules! output_map {
    ($Owner:ident $size:literal $count:literal [$($name:literal)*] ($self:ident) => $prepared:expr, $given:expr) => {
        impl<R: $crate::Real> $crate::OutputMap<R, $size, $count> for $Owner<R> {
            type Outputs = Outputs<R>;
            const OUTPUTS: [&'static ::core::primitive::str; $count] = [$($name),*];

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

/// `mass_form`, with the numbers of parameters and of inputs, and where the bias and the matrix of the inputs begin.
#[doc(hidden)]
#[macro_export]
macro_rules! mass_form {
    ($l:literal, $count:literal, $bias:literal, $input:literal $(, $inputs:ident)?) => {
        /// The equations of motion apart, `M eta' + bias = G u`: the mass matrix, what the forces are without inputs
        /// with its sign turned, and the matrix of the inputs. Where forces are not affine in the inputs, `G` holds
        /// their derivatives, and the equation is exact at these inputs.
        pub fn mass_form(
            &self, t: R, state: &State<R> $(, $inputs: &Inputs<R>)?
        ) -> $crate::control::MassForm<R, $l, $count> {
            let state = &::core::convert::From::from(*state);
            let given = &$crate::array_of_inputs!($($inputs)?);
            let entries = program::mass_form(&self.constants, &self.hoisted, t, state, given);
            let entry = |s: usize, k: usize| {
                if s < k { entries[k * (k + 1) / 2 + s] } else { entries[s * (s + 1) / 2 + k] }
            };
            $crate::control::MassForm {
                mass: ::core::array::from_fn(|s| ::core::array::from_fn(|k| entry(s, k))),
                bias: ::core::array::from_fn(|s| entries[$bias + s]),
                input: ::core::array::from_fn(|s| ::core::array::from_fn(|j| entries[$input + s * $count + j])),
            }
        }
    };
}

/// `steady_motion` and `equilibrium`, with the numbers of states and of inputs.
#[doc(hidden)]
#[macro_export]
macro_rules! steady_motions {
    ($size:literal, $count:literal) => {
        $crate::steady_motions!(
            @ $size, $count, State<R>, [], [], (state, []) => ::core::convert::From::from(state);
        );
    };
    ($size:literal, $count:literal, $inputs:ident) => {
        $crate::steady_motions!(
            @ $size, $count, (State<R>, Inputs<R>), ::core::convert::From::from(*$inputs), Inputs::<f64>::NAMES,
            (state, held) => (::core::convert::From::from(state), ::core::convert::From::from(held));
            $inputs
        );
    };
    (
        @ $size:literal, $count:literal, $Motion:ty, $held:expr, $names:expr, $found:pat => $motion:expr;
        $($inputs:ident)?
    ) => {
        /// A steady motion near a guess: the rates of everything vanish but of what is `drifting`, such as the place of a
        /// car that drives in a circle.
        ///
        /// The search stays near the guess. What is fixed, and what drifts, stays as it is there; names are those of the
        /// state and of the inputs. Newton's method with the exact linearisation.
        ///
        /// # Errors
        ///
        /// An unknown name; a family of solutions, of which as many further quantities have to be fixed as it has
        /// dimensions; no solution near the guess.
        pub fn steady_motion(
            &self, t: R, state: &State<R> $(, $inputs: &Inputs<R>)?, drifting: &[&'static str], fixed: &[&'static str],
        ) -> ::core::result::Result<$Motion, $crate::control::SteadyError> {
            let states = State::<f64>::NAMES;
            let names: [&'static str; $count] = $names;
            let (drifting, _) = $crate::control::named(drifting, &states, &[])?;
            let (fixed_states, fixed_inputs) = $crate::control::named(fixed, &states, &names)?;
            let request = $crate::control::SteadyMotion::<$size, $count> { drifting, fixed_states, fixed_inputs };
            let start: [R; $size] = ::core::convert::From::from(*state);
            let $found = $crate::control::steady(self, t, &start, &$held, &request)?;
            ::core::result::Result::Ok($motion)
        }

        /// An equilibrium near a guess: all rates vanish.
        ///
        /// The search stays near the guess. What is fixed stays as it is there; names are those of the state and of the
        /// inputs. Newton's method with the exact linearisation.
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
            let s: [R; $size] = ::core::convert::From::from(*state);
            let coordinates: [R; $n] = ::core::array::from_fn(|i| s[i]);
            let entries: [R; 0] = [];
            let _ = entries;
            $(let entries = program::$leaf(&self.constants, &self.hoisted, t, &coordinates);)?
            let leaf = $crate::control::Leaf::<R, $n, $combinations> {
                coordinates,
                velocities: program::velocities(&self.constants, &self.hoisted, t, &s),
                rows: ::core::array::from_fn(|row| ::core::array::from_fn(|i| entries[row * $n + i])),
                quaternions: &[$($quaternion)*],
                independent: $crate::control::independent(independent, &State::<f64>::NAMES)?,
                names: &State::<f64>::NAMES,
            };
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
    ($size:literal, $count:literal $(, $inputs:ident)?) => {
        impl<R: $crate::Real> $crate::Liftable<R, $size, $count> for Prepared<R> {
            #[inline]
            fn lifted_rates<S: $crate::Real + $crate::Lift<R>>(
                &self,
                t: S,
                state: &[S; $size],
                given: &[S; $count],
            ) -> [S; $size] {
                let lifted: Prepared<S> = self.lift();
                program::rhs(&lifted.constants, &lifted.hoisted, t, state, given)
            }
        }

        impl<R> $crate::Linearizable<R, $size, $count> for Prepared<R>
        where
            R: $crate::Lift<R>,
        {
            #[inline]
            fn rates(&self, t: R, state: &[R; $size], given: &[R; $count]) -> [R; $size] {
                program::rhs(&self.constants, &self.hoisted, t, state, given)
            }

            #[inline]
            fn linearization(
                &self,
                t: R,
                state: &[R; $size],
                given: &[R; $count],
            ) -> $crate::Linearization<R, $size, $count> {
                let _ = given;
                $(let $inputs = &::core::convert::From::from(*given);)?
                self.linearize(t, &::core::convert::From::from(*state) $(, $inputs)?)
            }
        }
    };
}

/// Entries of a matrix from a list: row, column and place of each.
#[doc(hidden)]
#[macro_export]
macro_rules! cells {
    ($matrix:ident, $entries:ident: $($row:literal $column:literal $place:literal),*) => {
        $($matrix[$row][$column] = $entries[$place];)*
    };
}
