//! Conversions to nalgebra's vectors, expanded where no prelude is in scope.

/// What generated code may find itself in.
mod hostile {
    #![no_implicit_prelude]

    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct State<R> {
        pub x: R,
        pub y: R,
        pub z: R,
    }

    impl<R> ::core::convert::From<[R; 3]> for State<R> {
        fn from([x, y, z]: [R; 3]) -> Self {
            Self { x, y, z }
        }
    }

    impl<R> ::core::convert::From<State<R>> for [R; 3] {
        fn from(state: State<R>) -> Self {
            [state.x, state.y, state.z]
        }
    }

    ::guen_runtime::nalgebra_conversions!(State, 3);
}

#[test]
fn the_state_converts_through_arrays() {
    let state = hostile::State { x: 1.0, y: 2.0, z: 3.0 };
    let entries: [f64; 3] = state.into();
    assert_eq!(hostile::State::from(entries), state);
}

#[cfg(feature = "nalgebra")]
#[test]
fn the_state_converts_to_a_vector_and_back() {
    use guen_runtime::Dual;
    use guen_runtime::nalgebra::SVector;

    let state = hostile::State { x: 1.0, y: 2.0, z: 3.0 };
    let vector: SVector<f64, 3> = state.into();
    assert_eq!(vector, SVector::from([1.0, 2.0, 3.0]));
    assert_eq!(hostile::State::from(vector), state);
    let dual = hostile::State::from([Dual::<f64, 2>::constant(0.5); 3]);
    assert_eq!(hostile::State::from(SVector::from(dual)), dual);
}
