//! The outline of carried forms. Which functions one carries is not known where the declaration has faults: its state has
//! the variables here.

use proc_macro2::TokenStream;
use quote::quote;

use super::{Names, record};
use crate::syntax::Provide;

/// The module of a carried form, if it is provided.
pub(super) fn items(names: &Names, provides: &[&Provide]) -> TokenStream {
    if provides.iter().all(|provide| provide.name.text != "carried") {
        return TokenStream::new();
    }
    let size = names.state.len();
    let state = record("State", &names.state);
    let has_inputs = !names.inputs.is_empty();
    let driven = has_inputs.then(|| quote!(, inputs: &super::Inputs<R>));
    let hold = has_inputs.then(|| {
        quote! {
            /// The system with held inputs.
            #[::core::prelude::v1::derive(
                ::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug, ::core::cmp::PartialEq
            )]
            pub struct Driven<R = f64> {
                /// The carried form.
                pub system: Prepared<R>,
                /// The inputs.
                pub inputs: super::Inputs<R>,
            }
            impl<R: __guen::Real> Prepared<R> {
                /// The system with these inputs held.
                pub fn driven(&self, inputs: super::Inputs<R>) -> Driven<R> { ::core::unreachable!() }
            }
        }
    });
    let owner = if has_inputs { quote!(Driven<R>) } else { quote!(Prepared<R>) };
    quote! {
        /// The module of the carried form of a system whose declaration has faults.
        pub mod carried {
            use super::__guen;
            #state
            /// The carried form.
            #[::core::prelude::v1::derive(
                ::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug, ::core::cmp::PartialEq
            )]
            pub struct Prepared<R = f64>(::core::marker::PhantomData<R>);
            impl<R: __guen::Real> Prepared<R> {
                /// The system.
                pub fn system(&self) -> &super::Prepared<R> { ::core::unreachable!() }
                /// The rates.
                pub fn rhs(&self, t: R, state: &State<R> #driven) -> State<R> { ::core::unreachable!() }
                /// A state with the functions.
                pub fn carry(&self, t: R, state: &super::State<R>) -> State<R> { ::core::unreachable!() }
                /// How far the functions are off.
                pub fn drift(&self, t: R, state: &State<R>) -> R { ::core::unreachable!() }
                /// What vanishes.
                pub fn invariants(&self, t: R, state: &State<R>) -> [R; 0] { ::core::unreachable!() }
                /// The system over a larger real.
                pub fn lift<S: __guen::Lift<R>>(&self) -> Prepared<S> { ::core::unreachable!() }
            }
            #hold
            impl<R: __guen::Real> __guen::System<R, #size> for #owner {
                fn rhs(&self, _: R, _: &[R; #size]) -> [R; #size] { ::core::unreachable!() }
            }
            impl<R: __guen::Real> __guen::Simulate<R, #size> for #owner {
                type State = State<R>;
            }
            impl<R: __guen::Real> __guen::Monitored<R, #size> for #owner {
                fn energy(&self, _: R, _: &[R; #size]) -> R { ::core::unreachable!() }
                fn residual(&self, _: R, _: &[R; #size]) -> R { ::core::unreachable!() }
            }
            impl<R: __guen::Real> __guen::Differentiable<R, #size> for #owner {
                fn jacobian(&self, _: R, _: &[R; #size]) -> [[R; #size]; #size] { ::core::unreachable!() }
                fn along(&self, _: R, _: &[R; #size], _: R, _: &[R; #size]) -> [R; #size] { ::core::unreachable!() }
            }
            impl<R: __guen::Real> __guen::AuxiliaryStates<R, #size> for #owner {
                fn renormalize(&self, _: R, _: &mut [R; #size]) { ::core::unreachable!() }
            }
            /// The functions.
            pub const FUNCTIONS: [&str; 0] = [];
            /// What must not vanish.
            pub const EDGES: [&str; 0] = [];
            /// The cost.
            pub const COST: __guen::Cost = super::NO_COST;
            /// The cost of the preparation.
            pub const PREPARE_COST: __guen::Cost = super::NO_COST;
        }
        pub use carried::Prepared as Carried;
        impl<R: __guen::Real> Prepared<R> {
            /// The carried form.
            pub fn carried(&self) -> ::core::result::Result<Carried<R>, __guen::ConstantsError> { ::core::unreachable!() }
        }
        impl<R: __guen::Real> State<R> {
            /// The state with the functions.
            pub fn carried(&self, system: &Carried<R>, t: R) -> carried::State<R> { ::core::unreachable!() }
        }
        impl<R> ::core::convert::From<carried::State<R>> for State<R> {
            fn from(_: carried::State<R>) -> Self { ::core::unreachable!() }
        }
    }
}
