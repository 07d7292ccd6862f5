//! What a prepared system computes: rates, energies, momenta, reactions, residuals, linearisation.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::layout::{Layout, inputs};
use super::{integrated, limits};
use crate::derive::{Subject, function};
use crate::model::FormKind;

pub(super) fn items(subject: &Subject<'_, '_>, layout: &Layout) -> TokenStream {
    let rates = rates(layout);
    let whole = layout.is_whole.then(|| whole(layout));
    let chosen = chosen(subject, layout);
    let domain = domain(subject);
    let residuals = residuals(subject, layout);
    let pivots = pivots(subject);
    let systems = systems(subject, layout);
    let state = layout.is_whole.then(|| state(subject, layout));
    quote! {
        impl<R: __guen::Real> Prepared<R> {
            #rates
            #whole
            #chosen
            #domain
            #residuals
            #pivots
        }
        #state
        #systems
    }
}

/// A function of time and state with one result.
fn scalar(name: &str, docs: &str) -> TokenStream {
    let method = format_ident!("{name}");
    quote! {
        #[doc = #docs]
        #[inline]
        pub fn #method(&self, t: R, state: &State<R>) -> R {
            let [value] = program::#method(&self.constants, &self.hoisted, t, &::core::convert::From::from(*state));
            value
        }
    }
}

fn rates(layout: &Layout) -> TokenStream {
    let (parameter, argument) = inputs(layout);
    quote! {
        /// The rates of the state: velocities by (1.8), accelerations by (2.7). No allocation, no branch.
        #[inline]
        pub fn rhs(&self, t: R, state: &State<R> #parameter) -> State<R> {
            ::core::convert::From::from(program::rhs(
                &self.constants, &self.hoisted, t, &::core::convert::From::from(*state), #argument,
            ))
        }
    }
}

/// What only the system itself has, and no scene can choose.
fn whole(layout: &Layout) -> TokenStream {
    let (parameter, argument) = inputs(layout);
    let (n, size) = (layout.n, layout.size);
    let positions: Vec<usize> = (0..n).collect();
    let accelerations: Vec<usize> = (n..size).collect();
    let kinetic = scalar("kinetic_energy", "The kinetic energy `T` on the constraints.");
    quote! {
        /// The velocities `x' = xi_0 + sum_s eta_s xi_s` of a state, (1.8).
        #[inline]
        pub fn velocities(&self, t: R, state: &State<R>) -> Coordinates<R> {
            ::core::convert::From::from(program::velocities(
                &self.constants, &self.hoisted, t, &::core::convert::From::from(*state),
            ))
        }

        #kinetic

        /// The force function `U`.
        #[inline]
        pub fn force_function(&self, t: R, state: &State<R>) -> R {
            let s: [R; #size] = ::core::convert::From::from(*state);
            let [value] = program::force_function(&self.constants, &self.hoisted, t, &[#(s[#positions]),*]);
            value
        }

        /// The momenta `dT/d eta_s`, and `(dT°/d eta_v)` for the constraints, (2.8).
        #[inline]
        pub fn momenta(&self, t: R, state: &State<R>) -> Momenta<R> {
            ::core::convert::From::from(program::momenta(
                &self.constants, &self.hoisted, t, &::core::convert::From::from(*state),
            ))
        }

        /// The rate of [`energy`](Self::energy) along the motion, by forces, moving constraints and explicit time:
        /// `h' = Q.x' - sum_v lambda_v a_v0 - d(T° + U)/dt`.
        #[inline]
        pub fn power(&self, t: R, state: &State<R> #parameter) -> R {
            let s: [R; #size] = ::core::convert::From::from(*state);
            let rates = program::rhs(&self.constants, &self.hoisted, t, &s, #argument);
            let [value] = program::power(
                &self.constants, &self.hoisted, t, &s, #argument, &[#(rates[#accelerations]),*],
            );
            value
        }
    }
}

/// Energy, reactions and outputs: what a scene has if it provides them.
fn chosen(subject: &Subject<'_, '_>, layout: &Layout) -> TokenStream {
    let (parameter, argument) = inputs(layout);
    let size = layout.size;
    let accelerations: Vec<usize> = (layout.n..size).collect();
    let selection = &subject.level.selection;
    let energy = selection.energy.then(|| {
        scalar(
            "energy",
            "The energy integral `h = sum x' dT°/dx' - T° - U`; kinetic plus potential energy where `T°` is homogeneous in the velocities.",
        )
    });
    let reactions = (!selection.reactions.is_empty()).then(|| {
        quote! {
            /// The reactions at a state, from `lambda_v = d/dt (dT°/d eta_v) - X_v(T° + U) - ... - Q_v` on the motion.
            #[inline]
            pub fn reactions(&self, t: R, state: &State<R> #parameter) -> Reactions<R> {
                let s: [R; #size] = ::core::convert::From::from(*state);
                let rates = program::rhs(&self.constants, &self.hoisted, t, &s, #argument);
                ::core::convert::From::from(program::reactions(
                    &self.constants, &self.hoisted, t, &s, #argument, &[#(rates[#accelerations]),*],
                ))
            }
        }
    });
    let outputs = (!selection.outputs.is_empty()).then(|| {
        quote! {
            /// The declared outputs at a state.
            #[inline]
            pub fn outputs(&self, t: R, state: &State<R> #parameter) -> Outputs<R> {
                Outputs::from_values(&program::outputs(
                    &self.constants, &self.hoisted, t, &::core::convert::From::from(*state), #argument,
                ))
            }
        }
    });
    quote!(#energy #reactions #outputs)
}

/// The functions that must not vanish.
fn domain(subject: &Subject<'_, '_>) -> TokenStream {
    let count = subject.level.domain_names.len();
    let size = subject.level.selection.variables.len();
    // Masses do not depend on inputs.
    let system = if subject.level.selection.inputs.is_empty() {
        quote!(self)
    } else {
        quote!(&self.driven(::core::default::Default::default()))
    };
    let condition = subject.level.scene.is_none().then(|| {
        quote! {
            /// How ill conditioned the equations for the accelerations are, whatever the units: one where parameters are
            /// not coupled. See [`System::condition`](__guen::System::condition).
            pub fn condition(&self, t: R, state: &State<R>) -> R {
                __guen::System::<R, #size>::condition(#system, t, &::core::convert::From::from(*state))
            }
        }
    });
    let distances = match subject.level.program(function::DOMAIN) {
        Some(_) => {
            let state = quote!(&<[R; #size]>::from(*state).map(__guen::RunningError::once));
            let domain = integrated::rounded(
                &quote!(domain),
                &quote!(self),
                &quote!(__guen::RunningError::once(t)),
                &state,
            );
            quote!(#domain.map(__guen::RunningError::left))
        }
        None => quote!([]),
    };
    let (inputs, values) = match subject.level.program(function::DOMAIN) {
        Some(_) => (
            quote!(t: R, state: &State<R>),
            quote!(program::domain(&self.constants, &self.hoisted, t, &::core::convert::From::from(*state))),
        ),
        None => (quote!(_t: R, _state: &State<R>), quote!([])),
    };
    quote! {
        /// Functions that must not vanish: where one of them is zero the declaration's chart ends. Their formulas
        /// are in [`DOMAIN`].
        #[inline]
        pub fn domain(&self, #inputs) -> [R; #count] {
            #values
        }

        /// How far the state is from the edge of the chart: of each function of [`DOMAIN`] what is left of it, from one
        /// where it is as certain as what it is made of to zero where it vanishes. Times and states count as rounded
        /// once; so do the constants. See [`RunningError`](__guen::RunningError).
        pub fn distances(&self, #inputs) -> [R; #count] {
            #distances
        }

        #condition
    }
}

/// Residuals of constraints: for the whole system of all, through the velocities that the state stands for; for a scene
/// of the holonomic ones whose coordinates it has.
fn residuals(subject: &Subject<'_, '_>, layout: &Layout) -> TokenStream {
    let holonomic = &subject.level.selection.holonomic;
    let (n, size) = (layout.n, layout.size);
    let positions: Vec<usize> = (0..n).collect();
    let at_positions = (!holonomic.is_empty())
        .then(|| quote!(let positions = program::positions(&self.constants, &self.hoisted, t, &x);));
    if !layout.is_whole {
        return at_positions.map_or_else(TokenStream::new, |at_positions| {
            quote! {
                /// What is left of the holonomic constraints at a state.
                pub fn residuals(&self, t: R, state: &State<R>) -> Residuals<R> {
                    let s: [R; #size] = ::core::convert::From::from(*state);
                    let x = [#(s[#positions]),*];
                    #at_positions
                    ::core::convert::From::from(positions)
                }
            }
        });
    }
    let constraints = &subject.model.forms[layout.l..];
    if constraints.is_empty() {
        return TokenStream::new();
    }
    let mut positions_before = 0_usize;
    let mut values: Vec<_> = constraints
        .iter()
        .enumerate()
        .map(|(v, form)| {
            if form.kind == FormKind::Holonomic {
                let i = positions_before;
                positions_before += 1;
                quote!(positions[#i])
            } else {
                let j = layout.l + v;
                quote!(forms[#j])
            }
        })
        .collect();
    values.extend(subject.level.selection.redundant.iter().map(|r| {
        let i = positions_before + r;
        quote!(positions[#i])
    }));
    quote! {
        /// What is left of every constraint at a state.
        pub fn residuals(&self, t: R, state: &State<R>) -> Residuals<R> {
            let s: [R; #size] = ::core::convert::From::from(*state);
            let x = [#(s[#positions]),*];
            let velocities = program::velocities(&self.constants, &self.hoisted, t, &s);
            let forms = program::forms(&self.constants, &self.hoisted, t, &x, &velocities);
            #at_positions
            let _ = &forms;
            ::core::convert::From::from([#(#values),*])
        }
    }
}

/// Pivots that depend on constants alone.
fn pivots(subject: &Subject<'_, '_>) -> TokenStream {
    let Subject { model, level } = subject;
    let texts: Vec<String> = level.constant_pivots.iter().map(|e| model.bench.graph.text(*e)).collect();
    let indices = 0..texts.len();
    let limits = limits::has_any(subject).then(|| quote!(self.check_limits()?;));
    let values =
        (!texts.is_empty()).then(|| quote!(let pivots = program::pivots(&self.constants, &self.hoisted);));
    quote! {
        fn check_pivots(&self) -> ::core::result::Result<(), __guen::ConstantsError> {
            #values
            #(__guen::check_pivot(pivots[#indices], #texts)?;)*
            #limits
            for value in &self.hoisted {
                __guen::check_hoisted(*value)?;
            }
            ::core::result::Result::Ok(())
        }
    }
}

/// `State::from_velocities`.
fn state(subject: &Subject<'_, '_>, layout: &Layout) -> TokenStream {
    let (n, l) = (layout.n, layout.l);
    let constraints = subject.model.forms.len() - l;
    let parameters: Vec<usize> = (0..l).collect();
    let rest: Vec<usize> = (l..subject.model.forms.len()).collect();
    let positions: Vec<usize> = (0..n).collect();
    let fields: Vec<&Ident> = layout.state[..n].iter().collect();
    quote! {
        impl<R: __guen::Real> State<R> {
            /// The state at given coordinates and velocities: the quasi-velocities are `eta_s = sum_i a_si x_i' +
            /// a_s0`, (1.6). Beside it the residuals `eta_v` of the constraints (their rates, where they are
            /// holonomic): how far the velocities are from being possible.
            pub fn from_velocities(
                system: &Prepared<R>,
                t: R,
                coordinates: &Coordinates<R>,
                velocities: &Coordinates<R>,
            ) -> (Self, [R; #constraints]) {
                let x: [R; #n] = ::core::convert::From::from(*coordinates);
                let forms = program::forms(
                    &system.constants, &system.hoisted, t, &x, &::core::convert::From::from(*velocities),
                );
                let _ = &forms;
                (
                    ::core::convert::From::from([#(x[#positions],)* #(forms[#parameters]),*]),
                    [#(forms[#rest]),*],
                )
            }

            /// The coordinates of the state.
            pub fn coordinates(&self) -> Coordinates<R> {
                Coordinates { #(#fields: self.#fields),* }
            }
        }
    }
}

/// The prepared system, or the system with held inputs, as something that steppers integrate.
fn systems(subject: &Subject<'_, '_>, layout: &Layout) -> TokenStream {
    let (size, n) = (layout.size, layout.n);
    let positions: Vec<usize> = (0..n).collect();
    let selection = &subject.level.selection;
    let residual = |prepared: &TokenStream| {
        if selection.holonomic.is_empty() {
            return quote! {
                fn residual(&self, _t: R, _state: &[R; #size]) -> R {
                    R::zero()
                }
            };
        }
        quote! {
            fn residual(&self, t: R, state: &[R; #size]) -> R {
                let x = [#(state[#positions]),*];
                __guen::largest(&program::positions(&#prepared.constants, &#prepared.hoisted, t, &x))
            }
        }
    };
    let monitored = |owner: TokenStream, prepared: TokenStream| {
        if !selection.energy {
            return TokenStream::new();
        }
        let residual = residual(&prepared);
        quote! {
            impl<R: __guen::Real> __guen::Monitored<R, #size> for #owner {
                fn energy(&self, t: R, state: &[R; #size]) -> R {
                    let [value] = program::energy(&#prepared.constants, &#prepared.hoisted, t, state);
                    value
                }

                #residual
            }
        }
    };
    if layout.inputs == 0 {
        let (owner, prepared) = (quote!(Prepared<R>), quote!(self));
        let guarded = integrated::guarded(subject, layout, &prepared);
        let differentiable = integrated::differentiable(layout, &owner, &prepared);
        let monitored = monitored(owner, prepared);
        return quote! {
            impl<R: __guen::Real> __guen::System<R, #size> for Prepared<R> {
                #[inline]
                fn rhs(&self, t: R, state: &[R; #size]) -> [R; #size] {
                    program::rhs(&self.constants, &self.hoisted, t, state, &[])
                }

                #guarded
            }
            #differentiable
            #monitored
        };
    }
    let (owner, prepared) = (quote!(Driven<R>), quote!(self.system));
    let guarded = integrated::guarded(subject, layout, &prepared);
    let differentiable = integrated::differentiable(layout, &owner, &prepared);
    let monitored = monitored(owner, prepared);
    quote! {
        /// A prepared system with inputs that are held: what steppers integrate during a step.
        #[::core::prelude::v1::derive(
            ::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug, ::core::cmp::PartialEq
        )]
        pub struct Driven<R = f64> {
            /// The system.
            pub system: Prepared<R>,
            /// The inputs that are held.
            pub inputs: Inputs<R>,
        }

        impl<R: __guen::Real> Prepared<R> {
            /// The system with these inputs held.
            #[inline]
            pub fn driven(&self, inputs: Inputs<R>) -> Driven<R> {
                Driven { system: *self, inputs }
            }
        }

        impl<R: __guen::Real> __guen::System<R, #size> for Driven<R> {
            #[inline]
            fn rhs(&self, t: R, state: &[R; #size]) -> [R; #size] {
                let inputs = ::core::convert::From::from(self.inputs);
                program::rhs(&self.system.constants, &self.system.hoisted, t, state, &inputs)
            }

            #guarded
        }
        #differentiable
        #monitored
    }
}
