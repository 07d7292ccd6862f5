//! `simulate` of systems with contacts: methods of their own, which go before those of the trait `Simulate`, whose motions know no contacts.

/// `simulate` and `simulation` through modes: the owner, with the numbers of states, rows, elements and signals.
#[doc(hidden)]
#[cfg(feature = "alloc")]
#[macro_export]
macro_rules! simulated_through_modes {
    ($([$($F:ident $N:literal)*])? $Owner:ident $size:tt $rows:tt $count:tt $signals:tt) => {
        impl $(<$($F: $crate::Smooth<$N>),*>)? $Owner<::core::primitive::f64 $($(, $F)*)?> {
            /// Simulates the motion from a state over a span of time, through its modes, with DOP853 at a tolerance of 1e-9.
            ///
            /// # Errors
            ///
            /// The reason why the motion could not go on, with the trajectory until then.
            #[allow(clippy::type_complexity, clippy::result_large_err)]
            pub fn simulate(
                &self,
                start: &State<::core::primitive::f64>,
                span: ::core::ops::Range<::core::primitive::f64>,
            ) -> ::core::result::Result<
                $crate::hybrid::HybridTrajectory<
                    Self,
                    State<::core::primitive::f64>,
                    $size,
                    $rows,
                    $count,
                    $signals,
                >,
                $crate::hybrid::HybridSimulationError<
                    Self,
                    State<::core::primitive::f64>,
                    $size,
                    $rows,
                    $count,
                    $signals,
                >,
            > {
                $crate::hybrid::HybridSystem::simulate(self, start, span)
            }

            /// A simulation through modes from a state, to be described further and run.
            pub fn simulation(
                &self,
                start: &State<::core::primitive::f64>,
            ) -> $crate::hybrid::HybridSimulation<
                '_,
                Self,
                State<::core::primitive::f64>,
                $size,
                $rows,
                $count,
                $signals,
            > {
                $crate::hybrid::HybridSystem::simulation(self, start)
            }
        }
    };
}

/// Nothing, without the feature `alloc`.
#[doc(hidden)]
#[cfg(not(feature = "alloc"))]
#[macro_export]
macro_rules! simulated_through_modes {
    ($($tokens:tt)*) => {};
}

/// `simulation`, `with_law` and `with_inputs` of a prepared system with contacts and so many inputs, which go before those of the trait
/// `Actuated`, whose motions know no contacts.
#[doc(hidden)]
#[macro_export]
macro_rules! held_through_modes {
    ($([$($F:ident $N:literal)*])? $inputs:literal) => {
        $crate::held_through_modes_in_memory!($([$($F $N)*])?);

        impl<R: $crate::Real $($(, $F: $crate::Smooth<$N>)*)?> Prepared<R $($(, $F)*)?> {
            /// The system with inputs by a law that is written for every real, which runs through modes.
            pub fn with_law<L: $crate::InputLaw<Self>>(self, law: L) -> $crate::hybrid::ByLaw<Self, L, $inputs> {
                $crate::hybrid::ByLaw::new(self, law)
            }

            /// Refused: a run through modes needs the derivatives of what its inputs are.
            pub fn with_inputs<X>(&self, _law: X)
            where
                Self: $crate::hybrid::ThroughModes,
            {
            }
        }
    };
}

/// `simulation` of a prepared system with contacts and inputs.
#[doc(hidden)]
#[cfg(feature = "alloc")]
#[macro_export]
macro_rules! held_through_modes_in_memory {
    ($([$($F:ident $N:literal)*])?) => {
        impl<R: $crate::Real $($(, $F: $crate::Smooth<$N>)*)?> Prepared<R $($(, $F)*)?> {
            /// A simulation through modes from a state, which first needs inputs: by a `law`, or those that a controller `hold`s.
            pub fn simulation(&self, start: &State<R>) -> $crate::hybrid::ModesWithoutInputs<Self, State<R>> {
                $crate::hybrid::ModesWithoutInputs::new(*self, *start)
            }
        }
    };
}

/// Nothing, without the feature `alloc`.
#[doc(hidden)]
#[cfg(not(feature = "alloc"))]
#[macro_export]
macro_rules! held_through_modes_in_memory {
    ($($tokens:tt)*) => {};
}

/// `System::restore` of a system with contacts, with the number of states: refused, since its own rates know no contacts.
#[doc(hidden)]
#[macro_export]
macro_rules! restored_by_modes {
    ($size:literal) => {
        #[inline]
        fn restore(
            &self,
            _t: R,
            _state: &mut [R; $size],
        ) -> ::core::result::Result<(), $crate::PositionsError> {
            ::core::result::Result::Err($crate::PositionsError::Contacts)
        }
    };
}
