//! Methods of a prepared system: rates, energies, momenta, reactions, residuals, linearisation.

use guen_symbolic::{Instruction, Operation};
use proc_macro2::TokenStream;
use quote::quote;

use super::integrated;
use crate::derive::{DerivedLevel, Subject, function};
use crate::emit::layouts::layout::{Layout, given, given_alone, inputs};
use crate::emit::layouts::signatures;
use crate::model::FormKind;

pub(in crate::emit) fn items(subject: &Subject<'_, '_>, layout: &Layout) -> TokenStream {
    let arguments = given_alone(layout);
    let whole = layout.is_whole.then(|| whole(subject, layout));
    let chosen = chosen(subject, layout);
    let domain = domain(subject, layout);
    let residuals = residuals(subject, layout);
    let systems = systems(subject, layout);
    let state = layout.is_whole.then(|| state(subject, layout));
    quote! {
        impl<R: __guen::Real> Prepared<R> {
            __guen::rates!(#arguments);
            #whole
            #chosen
            #domain
            #residuals
        }
        #state
        #systems
    }
}

/// Emits the items that only the system itself has, and no scene can choose.
fn whole(subject: &Subject<'_, '_>, layout: &Layout) -> TokenStream {
    let Layout { n, l, size, .. } = layout;
    let given = given(layout);
    let momenta = (!subject.level.selection.momenta.is_empty()).then(|| quote!(__guen::momenta!();));
    let power = has_power(subject.level).then(|| quote!(power));
    quote!(__guen::motion_of_system!([#power], #n, #l, #size #given); #momenta)
}

/// Whether the energy changes along a motion as far as its program tells; if not, `power` returns zero and has no function.
pub(in crate::emit) fn has_power(level: &DerivedLevel) -> bool {
    level.program(function::POWER).is_some_and(|power| match &power.instructions[..] {
        [Instruction { operation: Operation::Number(value), .. }] => !value.is_zero(),
        _ => true,
    })
}

/// Energy, reactions and outputs: what a scene has if it provides them.
fn chosen(subject: &Subject<'_, '_>, layout: &Layout) -> TokenStream {
    let (_, argument) = inputs(layout);
    let Layout { n, l, size, .. } = layout;
    let given = given(layout);
    let selection = &subject.level.selection;
    let energy = selection.energy.then(|| quote!(__guen::energy!();));
    let reactions =
        (!selection.reactions.is_empty()).then(|| quote!(__guen::reactions!(#n, #l, #size #given);));
    let outputs = (!selection.outputs.is_empty()).then(|| {
        let head = signatures::OUTPUTS.head(layout, &quote!());
        quote! {
            /// The declared outputs at a state.
            #[inline]
            #head {
                Outputs::from_values(&program::outputs(
                    &self.constants, &self.hoisted, t, &::core::convert::From::from(*state), #argument,
                ))
            }
        }
    });
    quote!(#energy #reactions #outputs)
}

/// The functions that must not vanish, and how far they and the mass matrix are from it.
fn domain(subject: &Subject<'_, '_>, layout: &Layout) -> TokenStream {
    let (size, given) = (layout.size, given(layout));
    let count = subject.level.domain_names.len();
    let has_any = subject.level.program(function::DOMAIN).is_some();
    let count = has_any.then(|| quote!(, #count));
    let condition = layout.is_whole.then(|| quote!(__guen::condition!(#size #given);));
    quote! {
        __guen::domain!(#size #count);
        #condition
    }
}

/// Residuals of constraints: for the whole system of all, through the velocities that the state stands for; for a scene
/// of the holonomic ones whose coordinates it has.
fn residuals(subject: &Subject<'_, '_>, layout: &Layout) -> TokenStream {
    let holonomic = &subject.level.selection.holonomic;
    let at_positions = (!holonomic.is_empty())
        .then(|| quote!(let positions = program::positions(&self.constants, &self.hoisted, t, &x);));
    let head = signatures::RESIDUALS.head(layout, &quote!());
    if !layout.is_whole {
        return at_positions.map_or_else(TokenStream::new, |at_positions| {
            quote! {
                /// Returns the residuals of the holonomic constraints at a state.
                #head {
                    let x = __guen::first(&state.__guen_array());
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
        /// Returns the residuals of all constraints at a state.
        #head {
            let s = state.__guen_array();
            let x = __guen::first(&s);
            let velocities = program::velocities(&self.constants, &self.hoisted, t, &s);
            let forms = program::forms(&self.constants, &self.hoisted, t, &x, &velocities);
            #at_positions
            let _ = &forms;
            ::core::convert::From::from([#(#values),*])
        }
    }
}

/// The checks of pivots that depend on constants alone, where `constants` and `hoisted` are at hand.
pub(in crate::emit) fn pivots(subject: &Subject<'_, '_>) -> Option<TokenStream> {
    let Subject { model, level, .. } = subject;
    let texts: Vec<String> = level.constant_pivots.iter().map(|e| model.bench.graph.text(*e)).collect();
    let indices = 0..texts.len();
    (!texts.is_empty()).then(|| {
        quote! {
            let pivots = program::pivots(&constants, &hoisted);
            #(__guen::check_pivot(pivots[#indices], #texts)?;)*
        }
    })
}

/// `State::from_velocities`.
fn state(subject: &Subject<'_, '_>, layout: &Layout) -> TokenStream {
    let Layout { n, l, size, .. } = layout;
    let constraints = subject.model.forms.len() - l;
    quote!(__guen::state_of_system!(#n, #l, #size, #constraints);)
}

/// The prepared system, or the system with held inputs, as something that steppers integrate.
fn systems(subject: &Subject<'_, '_>, layout: &Layout) -> TokenStream {
    let (size, n) = (layout.size, layout.n);
    let selection = &subject.level.selection;
    let monitored = selection.energy.then(|| {
        let (owner, inner) = (integrated::owner(layout), (layout.inputs > 0).then(|| quote!(.system)));
        let positions = (!selection.holonomic.is_empty()).then(|| quote!(, #n));
        quote!(__guen::monitored!(#owner, |owner| owner #inner, #size #positions);)
    });
    if layout.inputs == 0 {
        let prepared = quote!(self);
        let integrated = integrated::integrated(subject, layout, &prepared);
        let guarded = integrated::guarded(subject, layout, &prepared);
        let differentiable = integrated::differentiable(layout, subject.level.jacobians.rates.is_some());
        let simulate = integrated::simulate(subject, layout, true, !selection.holonomic.is_empty());
        return quote! {
            impl<R: __guen::Real> __guen::System<R, #size> for Prepared<R> {
                #[inline]
                fn rhs(&self, t: R, state: &[R; #size]) -> [R; #size] {
                    program::rhs(&self.constants, &self.hoisted, t, state, &[])
                }

                #integrated
            }
            #guarded
            #differentiable
            #monitored
            #simulate
        };
    }
    let prepared = quote!(self.system);
    let integrated = integrated::integrated(subject, layout, &prepared);
    let guarded = integrated::guarded(subject, layout, &prepared);
    let differentiable = integrated::differentiable(layout, subject.level.jacobians.rates.is_some());
    let simulate = integrated::simulate(subject, layout, true, !selection.holonomic.is_empty());
    quote! {
        __guen::actuated!(#size, "system");

        impl<R: __guen::Real> __guen::System<R, #size> for Driven<R> {
            #[inline]
            fn rhs(&self, t: R, state: &[R; #size]) -> [R; #size] {
                let inputs = ::core::convert::From::from(self.inputs);
                program::rhs(&self.system.constants, &self.system.hoisted, t, state, &inputs)
            }

            #integrated
        }
        #guarded
        #differentiable
        #monitored
        #simulate
    }
}
