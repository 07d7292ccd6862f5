//! The outline of what controllers ask of a prepared system.

use proc_macro2::TokenStream;
use quote::quote;

/// Sizes and the parameter of inputs: coordinates, state, parameters, inputs.
pub(super) struct Sizes {
    pub(super) n: usize,
    pub(super) size: usize,
    pub(super) inputs: usize,
}

pub(super) fn items(sizes: &Sizes, constrained: bool, has_outputs: bool) -> TokenStream {
    let Sizes { n, size, inputs } = *sizes;
    let l = size - n;
    let driven = (inputs > 0).then(|| quote!(, inputs: &Inputs<R>));
    let steady = if inputs > 0 { quote!((State<R>, Inputs<R>)) } else { quote!(State<R>) };
    let steady = quote!(::core::result::Result<#steady, __guen::control::SteadyError>);
    let inverse = (inputs > 0).then(|| {
        quote! {
            /// The inputs that produce given accelerations.
            pub fn inverse_dynamics(
                &self, t: R, state: &State<R>, rate: &State<R>,
            ) -> ::core::result::Result<Inputs<R>, __guen::control::InverseDynamicsError> {
                ::core::unreachable!()
            }
            /// The inputs that produce given accelerations, from a start.
            pub fn inverse_dynamics_from(
                &self, t: R, state: &State<R>, rate: &State<R>, start: &Inputs<R>,
            ) -> ::core::result::Result<Inputs<R>, __guen::control::InverseDynamicsError> {
                ::core::unreachable!()
            }
        }
    });
    let covector = constrained.then(|| {
        quote! {
            /// The reactions as a covector.
            pub fn reaction_covector(&self, t: R, state: &State<R> #driven) -> Coordinates<R> { ::core::unreachable!() }
        }
    });
    let outputs = has_outputs.then(|| {
        quote! {
            /// The linearisation of the outputs.
            pub fn linearize_outputs<const P: usize>(
                &self, t: R, state: &State<R> #driven
            ) -> __guen::OutputLinearization<R, #size, #inputs, { P }> {
                ::core::unreachable!()
            }
        }
    });
    quote! {
        /// The size of the reduced basis.
        pub const REDUCED: usize = #size;
        /// The cost of a linearisation.
        pub const LINEARIZATION_COST: ::core::option::Option<__guen::Cost> = ::core::option::Option::None;
        impl<R: __guen::Real> Prepared<R> {
            /// The equations of motion apart.
            pub fn mass_form(
                &self, t: R, state: &State<R> #driven
            ) -> __guen::control::MassForm<R, #l, #inputs> {
                ::core::unreachable!()
            }
            /// A steady motion.
            pub fn steady_motion(
                &self, t: R, state: &State<R> #driven, drifting: &[&'static str], fixed: &[&'static str],
            ) -> #steady {
                ::core::unreachable!()
            }
            /// An equilibrium.
            pub fn equilibrium(&self, t: R, state: &State<R> #driven, fixed: &[&'static str]) -> #steady {
                ::core::unreachable!()
            }
            /// The linearisation on the leaf.
            pub fn reduce<const Z: usize>(
                &self, t: R, state: &State<R> #driven, independent: &[&'static str],
            ) -> ::core::result::Result<__guen::control::Reduced<R, #size, #inputs, { Z }>, __guen::control::ReduceError> {
                ::core::unreachable!()
            }
            #inverse
            #covector
            #outputs
        }
        impl<R: __guen::Lift<R>> __guen::Linearizable<R, #size, #inputs> for Prepared<R> {
            fn rates(&self, _: R, _: &[R; #size], _: &[R; #inputs]) -> [R; #size] { ::core::unreachable!() }
            fn linearization(
                &self, _: R, _: &[R; #size], _: &[R; #inputs]
            ) -> __guen::Linearization<R, #size, #inputs> {
                ::core::unreachable!()
            }
        }
        impl<R: __guen::Real> __guen::Liftable<R, #size, #inputs> for Prepared<R> {
            fn lifted_rates<S: __guen::Real + __guen::Lift<R>>(
                &self, _: S, _: &[S; #size], _: &[S; #inputs]
            ) -> [S; #size] {
                ::core::unreachable!()
            }
        }
    }
}
