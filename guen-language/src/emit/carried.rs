//! The carried form of a level: a module with a state, a system and a program of its own.

use guen_symbolic::{CarriedFunction, ExprId};
use proc_macro2::TokenStream;
use quote::quote;

use super::layouts::layout::{Layout, carried_name, inputs};
use super::layouts::text::cost;
use super::methods::integrated::{self, CheckOperations};
use super::methods::lanes;
use super::programs::functions;
use super::structs::{records, serde};
use crate::derive::{Subject, function};

/// The module, and the methods of the level that lead there; nothing where it is not provided.
pub(super) fn items(subject: &Subject<'_, '_>, layout: &Layout) -> TokenStream {
    let Some(level) = &subject.level.carried else { return TokenStream::new() };
    let carried = Subject { level, ..*subject };
    let own = Layout { is_whole: false, ..Layout::new(&carried) };
    let checks = CheckOperations::of(&carried, &own).and(CheckOperations::of(subject, layout));
    let module = module(&carried, &own, layout, checks);
    let size = layout.size;
    let without = layout.state.accesses().iter().map(|name| quote!(state.#name));
    let without = layout.state.literal(&without.collect::<Vec<_>>());
    let copied = layout.state.copied();
    quote! {
        #[doc = " What belongs to the carried form, [`Carried`]: its state, and which functions it carries."]
        pub mod carried {
            #[allow(unused_imports, reason = "small systems use few of its items")]
            use super::__guen;
            #module
        }
        #[doc(inline)]
        pub use carried::Prepared as Carried;

        impl<R: __guen::Real> Prepared<R> {
            /// Returns the system with the elementary functions of its rates as states: no calls in its right-hand side.
            ///
            /// # Errors
            ///
            /// Constants that make something infinite which it prepares.
            pub fn carried(&self) -> ::core::result::Result<Carried<R>, __guen::ConstantsError> {
                let carried = carried::of(*self);
                carried.check()?;
                ::core::result::Result::Ok(carried)
            }
        }

        impl<R: __guen::Real> State<R> {
            /// Returns this state with the functions that a carried form has as states, at time `t`.
            pub fn carried(&self, system: &Carried<R>, t: R) -> carried::State<R> {
                system.carry(t, self)
            }
        }

        impl<R #copied> ::core::convert::From<carried::State<R>> for State<R> {
            /// The state without the functions that are carried.
            #[inline]
            fn from(state: carried::State<R>) -> Self {
                State { #without }
            }
        }

        const _: () = ::core::assert!(#size == State::<f64>::NAMES.len());
    }
}

fn module(subject: &Subject<'_, '_>, layout: &Layout, base: &Layout, checks: CheckOperations) -> TokenStream {
    let Subject { model, level, .. } = subject;
    let text = |e: ExprId| model.bench.graph.text_limited(e, 400).unwrap_or_else(|| "(long)".to_owned());
    let lines = |texts: Vec<String>| {
        let count = texts.len();
        (count, quote!([#(#texts),*]))
    };
    let carried = &level.selection.carried;
    let named = |e: fn(&CarriedFunction) -> ExprId, mark: &str| {
        carried
            .iter()
            .map(|f| format!("{}{mark} = {}", carried_name(model, f), text(e(f))))
            .collect::<Vec<_>>()
    };
    let (values, rates) = (named(|f| f.value, ""), named(|f| f.rate, "'"));
    let table = format!(
        "The functions that are carried, and their rates.\n\n```text\n{}\n{}\n```",
        values.join("\n"),
        rates.join("\n")
    );
    let (count, values) = lines(values);
    let (singularities, singularity_texts) = lines(level.domain_names.clone());
    let program = |name: &str| level.program(name).map(|program| program.outputs.len());
    let invariants = program(function::INVARIANTS).unwrap_or(0);
    let rhs = level.program(function::RHS).map(|program| program.cost).unwrap_or_default();
    let (cost, prepare_cost) = (cost(&rhs), cost(&level.programs.prepare_cost));
    let state = records::carried(subject, layout);
    let serde = serde::state(layout);
    let prepared = prepared(subject, layout, base, invariants);
    let systems = systems(subject, layout, base, (invariants, singularities), checks);
    let code = functions::modules(subject, layout);
    quote! {
        #state
        #serde
        #[doc = #table]
        pub const FUNCTIONS: [&str; #count] = #values;
        /// The operations of one right-hand side; `abs` and `sign` count as calls.
        pub const COST: __guen::Cost = #cost;
        /// The operations that are done once.
        pub const PREPARE_COST: __guen::Cost = #prepare_cost;
        /// Functions that must not vanish beside those of `DOMAIN` of the system.
        pub const SINGULARITIES: [&str; #singularities] = #singularity_texts;
        #prepared
        #systems
        #code
    }
}

/// The struct and its own methods.
fn prepared(subject: &Subject<'_, '_>, layout: &Layout, base: &Layout, invariants: usize) -> TokenStream {
    let (size, hoisted, constants, variables) = (layout.size, layout.hoisted, layout.constants, base.size);
    let (parameter, argument) = inputs(layout);
    let fields = base.state.accesses().iter().map(|name| quote!(state.#name));
    let parts = (0..subject.level.selection.carried.len()).map(|i| quote!(values[#i]));
    let carried = layout.state.literal(&fields.chain(parts).collect::<Vec<_>>());
    let places = 0..variables;
    let given = (layout.inputs > 0).then(|| {
        quote!(
            use super::Inputs;
        )
    });
    let invariants = (invariants > 0).then(|| {
        quote! {
            /// Returns expressions that vanish where the functions have their values: `sin^2 + cos^2 - 1`, `1 - (sinh^2 + 1)/cosh^2`,
            /// `1 - u/root^q`. No calls, no units.
            pub fn invariants(&self, t: R, state: &State<R>) -> [R; #invariants] {
                program::invariants(&self.constants, &self.hoisted, t, &::core::convert::From::from(*state))
            }
        }
    });
    quote! {
        #given
        /// A prepared system with the elementary functions of its rates as states, listed in [`FUNCTIONS`]: its
        /// right-hand side calls none. Immutable; made by `carried` of the prepared system.
        #[::core::prelude::v1::derive(::core::fmt::Debug)]
        pub struct Prepared<R = f64> {
            system: super::Prepared<R>,
            constants: [R; #constants],
            hoisted: [R; #hoisted],
        }
        __guen::copied!(R Prepared, system constants hoisted);

        #[inline]
        pub(super) fn of<R: __guen::Real>(system: super::Prepared<R>) -> Prepared<R> {
            Prepared { system, constants: system.constants, hoisted: program::prepare(&system.constants) }
        }

        impl<R: __guen::Real> Prepared<R> {
            /// The system that this is a form of.
            pub fn system(&self) -> &super::Prepared<R> {
                &self.system
            }

            pub(super) fn check(&self) -> ::core::result::Result<(), __guen::ConstantsError> {
                __guen::check_hoisted(&self.hoisted)
            }

            /// The rates of the state: those of the system's variables, then those of the functions. No elementary
            /// calls, no allocation, no branch.
            #[inline]
            pub fn rhs(&self, t: R, state: &State<R> #parameter) -> State<R> {
                ::core::convert::From::from(program::rhs(
                    &self.constants, &self.hoisted, t, &::core::convert::From::from(*state), #argument,
                ))
            }

            /// A state of the system with the functions as they are there: one elementary call for each.
            pub fn carry(&self, t: R, state: &super::State<R>) -> State<R> {
                let mut all = [R::zero(); #size];
                let variables: [R; #variables] = ::core::convert::From::from(*state);
                all[..#variables].copy_from_slice(&variables);
                let values = program::carry(&self.constants, &self.hoisted, t, &all);
                State { #carried }
            }

            /// Returns the distance of the carried functions from what they stand for, at the coordinates and parameters of the
            /// state: the largest `|w - f|/(1 + |f|)`. One elementary call for each.
            pub fn drift(&self, t: R, state: &State<R>) -> R {
                let all: [R; #size] = ::core::convert::From::from(*state);
                __guen::drift(&program::carry(&self.constants, &self.hoisted, t, &all), &all[#variables..])
            }

            #invariants

            /// Returns the form over a real that contains `R`.
            pub fn lift<S: __guen::Lift<R>>(&self) -> Prepared<S> {
                Prepared {
                    system: self.system.lift(),
                    constants: self.constants.map(<S as __guen::Lift<R>>::lift),
                    hoisted: self.hoisted.map(<S as __guen::Lift<R>>::lift),
                }
            }

            fn variables(state: &[R; #size]) -> [R; #variables] {
                [#(state[#places]),*]
            }
        }
    }
}

/// Implements the traits of steppers.
fn systems(
    subject: &Subject<'_, '_>,
    layout: &Layout,
    base: &Layout,
    (invariants, singularities): (usize, usize),
    checks: CheckOperations,
) -> TokenStream {
    let (size, count, variables) = (layout.size, layout.inputs, base.size);
    let renormalized =
        subject.level.program(function::RENORMALIZED).map_or(0, |program| program.outputs.len());
    let kept = (invariants > 0).then(|| {
        quote! {
            let broken = __guen::largest(&program::invariants(&prepared.constants, &prepared.hoisted, t, state));
            let drift = __guen::largest(&[drift, broken]);
        }
    });
    let further = (singularities > 0).then(|| {
        let domain = integrated::rounded(&quote!(domain), &quote!(prepared), &quote!(t), &quote!(state));
        quote! {
            if let ::core::option::Option::Some(rest) = values.get_mut(written..) {
                written += __guen::placed(rest, &#domain, #singularities);
            }
        }
    });
    // The system that this is a form of, with inputs held where it has some.
    let (owner, prepared, below, held) = if count == 0 {
        (quote!(Prepared<R>), quote!(self), quote!(self.system), quote!(&[]))
    } else {
        (
            quote!(Driven<R>),
            quote!(self.system),
            quote!(self.system.system.driven(self.inputs)),
            quote!(&::core::convert::From::from(self.inputs)),
        )
    };
    let driven = (count > 0).then(|| quote!(__guen::actuated!(#size, "carried form");));
    let monitored = subject.level.selection.energy.then(|| {
        quote! {
            impl<R: __guen::Real> __guen::Monitored<R, #size> for #owner {
                fn energy(&self, t: R, state: &[R; #size]) -> R {
                    __guen::Monitored::energy(&#below, t, &Prepared::variables(state))
                }

                fn residual(&self, t: R, state: &[R; #size]) -> R {
                    __guen::Monitored::residual(&#below, t, &Prepared::variables(state))
                }
            }
        }
    });
    let renormalize = (renormalized > 0).then(|| {
        quote! {
            impl<R: __guen::Real> __guen::AuxiliaryStates<R, #size> for #owner {
                fn renormalize(&self, t: R, state: &mut [R; #size]) {
                    let prepared = &#prepared;
                    let values = program::renormalized(&prepared.constants, &prepared.hoisted, t, state);
                    state[#variables..].copy_from_slice(&values);
                }
            }
        }
    });
    let switches = (!subject.level.switches.is_empty()).then(|| {
        quote! {
            #[inline]
            fn switches(&self, t: R, state: &[R; #size], values: &mut [R]) -> usize {
                __guen::System::switches(&#below, t, &Prepared::variables(state), values)
            }
        }
    });
    let (all, hundredths) = checks.in_rates(subject, layout);
    let restored = integrated::restored(subject, layout);
    let modes = integrated::through_modes(subject);
    let differentiable = integrated::differentiable(layout, false);
    let simulate = integrated::simulate(subject, layout, false, false);
    let lanes = lanes::carried(layout);
    quote! {
        #driven

        impl<R: __guen::Real> __guen::System<R, #size> for #owner {
            #[inline]
            fn rhs(&self, t: R, state: &[R; #size]) -> [R; #size] {
                program::rhs(&#prepared.constants, &#prepared.hoisted, t, state, #held)
            }

            #switches
            #restored
            __guen::guarded!(#size);
        }

        impl<R: __guen::Real> __guen::Guarded<R, #size> for #owner {
            fn conserved(&self, t: R, state: &[R; #size]) -> __guen::Invariants<R> {
                <R as __guen::Real>::vectorize(#[inline(always)] || {
                    let prepared = &#prepared;
                    let values = program::carry(&prepared.constants, &prepared.hoisted, t, state);
                    let drift = __guen::drift(&values, &state[#variables..]);
                    #kept
                    let below = __guen::Guarded::conserved(&#below, t, &Prepared::variables(state));
                    __guen::Invariants { carried: drift, ..below }
                })
            }

            #[inline]
            fn singularities(&self, t: __guen::RunningError<R>, state: &[__guen::RunningError<R>; #size], values: &mut [__guen::RunningError<R>],
            ) -> usize {
                let prepared = &#prepared;
                let _ = &prepared;
                let variables = Prepared::<__guen::RunningError<R>>::variables(state);
                #[allow(unused_mut, reason = "there may be no further singularities")]
                let mut written = __guen::Guarded::singularities(&#below, t, &variables, values);
                #further
                written
            }

            fn condition(&self, t: R, state: &[R; #size]) -> R {
                __guen::Guarded::condition(&#below, t, &Prepared::variables(state))
            }

            fn check_costs(&self) -> __guen::CheckCosts {
                __guen::CheckCosts::of(#all, #hundredths)
            }
        }
        #differentiable
        __guen::linearizable!(#size, #count; by duals #modes);
        #simulate
        #monitored
        #renormalize
        #lanes
    }
}
