//! Levels of detail as types with a common trait: how states and constants of the system and of a scene become each other.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::formula::default_text;
use super::layout::{Layout, is_derived, variable_ident};
use super::text::tokens;
use crate::derive::{Level, StateIndex, Subject};
use crate::model::Model;
use crate::names::module_name;

/// `Level` for what steppers integrate; for a scene the conversions too.
pub(super) fn items(subject: &Subject<'_, '_>, layout: &Layout) -> TokenStream {
    let Subject { model, level } = subject;
    let (_, full) = model.sizes();
    let size = layout.size;
    let places = &level.selection.variables;
    let name = &subject.name().text;
    let layers: Vec<TokenStream> = subject.scene().map_or(Vec::new(), |(_, facts)| {
        let layers = facts.quadratures.iter();
        let places = layers.map(|layer| layer.iter().map(|quadrature| quadrature.place));
        places.map(|places| quote!(&[#(#places),*])).collect()
    });
    let determined: Vec<StateIndex> =
        subject.scene().map_or(Vec::new(), |(_, facts)| facts.determined.iter().map(|(i, _)| *i).collect());
    let held = level.selection.held.iter().map(|held| held.place);
    let held: Vec<(StateIndex, usize)> = held.zip(level.selection.constants.len()..).collect();
    let owner = |owner: TokenStream, prepared: TokenStream| {
        let hold = (!held.is_empty()).then(|| {
            let values = held.iter().map(|(place, c)| quote!(full[#place] = #prepared.constants[#c];));
            quote! {
                #[inline]
                fn hold(&self, full: &mut [R; #full]) {
                    #(#values)*
                }
            }
        });
        let determine = (!determined.is_empty()).then(|| {
            let values = determined.iter().enumerate().map(|(k, place)| quote!(full[#place] = values[#k];));
            quote! {
                const DETERMINED: &'static [usize] = &[#(#determined),*];

                #[inline]
                fn determine(&self, t: R, state: &[R; #size], full: &mut [R; #full]) {
                    let values = program::determined(&#prepared.constants, &#prepared.hoisted, t, state);
                    #(#values)*
                }
            }
        });
        let of_scene = (!layout.is_whole).then(|| {
            quote! {
                const PLACES: [usize; #size] = [#(#places),*];
                const QUADRATURES: &'static [&'static [usize]] = &[#(#layers),*];
            }
        });
        quote! {
            impl<R: __guen::Real> __guen::Level<R, #size, #full> for #owner {
                #of_scene
                const INFO: __guen::LevelInfo = INFO;
                #hold
                #determine
            }
        }
    };
    let prepared = owner(quote!(Prepared<R>), quote!(self));
    let driven = (layout.inputs > 0).then(|| owner(quote!(Driven<R>), quote!(self.system)));
    let conversions = (!layout.is_whole).then(|| conversions(subject, layout));
    quote! {
        __guen::level_info!(#name);
        #prepared
        #driven
        #conversions
    }
}

/// The table of all levels.
pub(super) fn table(model: &Model<'_>, scenes: &[Level]) -> TokenStream {
    let modules: Vec<Ident> = scenes
        .iter()
        .filter_map(|level| level.scene.as_ref())
        .map(|facts| module_name(&model.scenes[facts.index].scene.name.ident, "scene"))
        .collect();
    let count = 1 + modules.len();
    quote!(__guen::levels!(#count #(#modules)*);)
}

fn conversions(subject: &Subject<'_, '_>, layout: &Layout) -> TokenStream {
    let Subject { model, level } = subject;
    let scene = &layout.system;
    let whole = &model.declaration.name.ident;
    let fields = &layout.state;
    let selection = &level.selection;
    let constants: Vec<&Ident> =
        selection.constants.iter().map(|c| &model.constants[*c].name.ident).collect();
    let held: Vec<Ident> = selection.held.iter().map(|held| variable_ident(model, held.place)).collect();
    let marker = |is_empty: bool| is_empty.then(|| quote!(real: ::core::marker::PhantomData,));
    let own_marker = marker(layout.constants == 0);
    let whole_marker = marker(model.constants.is_empty());
    let fixes = subject.scene().map_or(&[][..], |(_, facts)| &facts.fixes);
    let locals: Vec<Ident> = (0..constants.len()).map(|i| format_ident!("__guen_c{i}")).collect();
    let fixed: Vec<&Ident> = fixes.iter().map(|(c, _)| &model.constants[*c].name.ident).collect();
    let fixed_names: Vec<&str> = fixes.iter().map(|(c, _)| model.constants[*c].name.text.as_str()).collect();
    let values: Vec<TokenStream> =
        fixes.iter().map(|(_, value)| tokens(&default_text(subject, *value))).collect();
    let inputs: Vec<&Ident> = selection.inputs.iter().map(|u| &model.inputs[*u].name.ident).collect();
    let of_inputs = (!inputs.is_empty()).then(|| {
        quote! {
            impl<R> ::core::convert::From<super::Inputs<R>> for Inputs<R> {
                /// Returns the inputs of the system that the scene has.
                #[inline]
                fn from(inputs: super::Inputs<R>) -> Self {
                    Inputs { #(#inputs: inputs.#inputs),* }
                }
            }
        }
    });
    // Constants that follow others are numbers among the values alone.
    let is_derived = |c: usize| is_derived(model, &model.constants[c]);
    let whole_values =
        (0..model.constants.len()).any(is_derived).then(|| quote!(let values = system.__guen_values();));
    let of_whole = |c: usize| {
        let name = &model.constants[c].name.ident;
        if whole_values.is_some() { quote!(values[#c]) } else { quote!(system.#name) }
    };
    let given: Vec<TokenStream> = selection.constants.iter().map(|c| of_whole(*c)).collect();
    let given_fixed: Vec<TokenStream> = fixes.iter().map(|(c, _)| of_whole(*c)).collect();
    // One that would follow itself in the scene is a number there.
    let held_back = |i: usize| is_derived(selection.constants[i]) && !layout.derived.contains(&i);
    let kept: Vec<TokenStream> = constants
        .iter()
        .enumerate()
        .map(|(i, name)| if held_back(i) { of_whole(selection.constants[i]) } else { quote!(system.#name) })
        .collect();
    let back = constants.iter().enumerate().map(|(i, name)| match held_back(i) {
        true => quote!(__guen::Derived::Set(self.#name)),
        false => quote!(self.#name),
    });
    let own_values = (!layout.derived.is_empty()).then(|| quote!(let values = self.__guen_values();));
    let own = constants.iter().enumerate().map(|(i, name)| match own_values {
        Some(_) => quote!(values[#i]),
        None => quote!(self.#name),
    });
    let put = fixes.iter().zip(&values).map(|((c, _), value)| match is_derived(*c) {
        true => quote!(__guen::Derived::Set(#value)),
        false => quote!(#value),
    });
    let kept_values = (0..constants.len()).any(held_back).then(|| whole_values.clone());
    let built = quote!(#(#constants: #kept,)*);
    let what = if fixes.is_empty() { "" } else { ", if they are those that the scene fixes" };
    let docs =
        format!("The scene with the constants of the system{what}, and what it holds as it is in a state.");
    let of_system = held.is_empty().then(|| {
        if fixes.is_empty() {
            quote! {
                impl<R: __guen::Real> ::core::convert::From<super::#whole<R>> for #scene<R> {
                    #[inline]
                    fn from(system: super::#whole<R>) -> Self {
                        let _ = &system;
                        #kept_values
                        #scene { #built #own_marker }
                    }
                }
            }
        } else {
            quote! {
                impl<R: __guen::Real> ::core::convert::TryFrom<super::#whole<R>> for #scene<R> {
                    type Error = __guen::ConstantsError;
                    #[inline]
                    fn try_from(system: super::#whole<R>) -> ::core::result::Result<Self, Self::Error> {
                        Self::check_fixed(&system)?;
                        #kept_values
                        ::core::result::Result::Ok(#scene { #built #own_marker })
                    }
                }
            }
        }
    });
    let state_name = if held.is_empty() { quote!(_state) } else { quote!(state) };
    let count = constants.len();
    quote! {
        impl<R: __guen::Real> #scene<R> {
            #[doc = #docs]
            ///
            /// # Errors
            ///
            /// `Contradicted` with the first constant that has another value in the system than the scene fixes.
            pub fn of(
                system: &super::#whole<R>,
                #state_name: &super::State<R>,
            ) -> ::core::result::Result<Self, __guen::ConstantsError> {
                Self::check_fixed(system)?;
                #kept_values
                ::core::result::Result::Ok(#scene {
                    #built
                    #(#held: #state_name.#held,)*
                    #own_marker
                })
            }

            #[allow(unused_variables, reason = "the fixed constants need not use every other")]
            fn check_fixed(system: &super::#whole<R>) -> ::core::result::Result<(), __guen::ConstantsError> {
                #whole_values
                let [#(#locals),*]: [R; #count] = [#(#given),*];
                #(__guen::check_fixed(#given_fixed, #values, #fixed_names)?;)*
                ::core::result::Result::Ok(())
            }

            /// The constants of the system, with those that the scene fixes at their values.
            #[allow(unused_variables, reason = "the fixed constants need not use every other")]
            pub fn system(&self) -> super::#whole<R> {
                #own_values
                let [#(#locals),*]: [R; #count] = [#(#own),*];
                super::#whole { #(#constants: #back,)* #(#fixed: #put,)* #whole_marker }
            }
        }

        #of_system

        impl<R: ::core::marker::Copy> ::core::convert::From<&super::State<R>> for State<R> {
            /// The variables of the scene out of a state of the system.
            #[inline]
            fn from(state: &super::State<R>) -> Self {
                State { #(#fields: state.#fields),* }
            }
        }

        impl<R: ::core::marker::Copy> ::core::convert::From<super::State<R>> for State<R> {
            #[inline]
            fn from(state: super::State<R>) -> Self {
                ::core::convert::From::from(&state)
            }
        }

        impl<R> State<R> {
            /// A state of the system: its variables that the scene has from here, the others from `rest`.
            #[inline]
            #[allow(clippy::needless_update, unused_variables, reason = "a scene may have every variable")]
            pub fn within(self, rest: super::State<R>) -> super::State<R> {
                super::State { #(#fields: self.#fields,)* ..rest }
            }
        }

        #of_inputs
    }
}
