//! Levels of detail as types with a common trait: how states and constants of the system and of a scene become each other.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::constants::marker_of;
use crate::derive::{StateIndex, Subject};
use crate::emit::layouts::fields::Fields;
use crate::emit::layouts::layout::{Layout, variable_name};
use crate::emit::layouts::text::tokens;
use crate::emit::programs::formula::default_text;
use crate::names::module_name;
use crate::syntax::Name;

/// `Level` for what steppers integrate; for a scene the conversions too.
pub(in crate::emit) fn items(subject: &Subject<'_, '_>, layout: &Layout) -> TokenStream {
    let Subject { level, whole, .. } = subject;
    let (_, full) = whole.sizes();
    let size = layout.size;
    let places = level.selection.variables.iter().map(|place| subject.place_in_whole(*place));
    let places: Vec<StateIndex> = places.collect();
    let name = &subject.name().text;
    let layers: Vec<TokenStream> = subject.scene().map_or(Vec::new(), |(_, facts)| {
        let layers = facts.quadratures.iter();
        let places =
            layers.map(|layer| layer.iter().map(|quadrature| subject.place_in_whole(quadrature.place)));
        places.map(|places| quote!(&[#(#places),*])).collect()
    });
    let determined: Vec<StateIndex> = subject.scene().map_or(Vec::new(), |(_, facts)| {
        let coordinates = facts.determined.iter().map(|(i, _)| subject.place_in_whole(*i));
        coordinates.chain(facts.followers.iter().map(|(name, _)| subject.named_in_whole(name))).collect()
    });
    let held = level.selection.held.iter().map(|held| subject.place_in_whole(held.place));
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
pub(in crate::emit) fn table(scenes: &[Subject<'_, '_>]) -> TokenStream {
    let modules: Vec<Ident> = scenes.iter().map(|scene| module_name(&scene.name().ident, "scene")).collect();
    let count = 1 + modules.len();
    quote!(__guen::levels!(#count #(#modules)*);)
}

fn conversions(subject: &Subject<'_, '_>, layout: &Layout) -> TokenStream {
    let Subject { model, level, whole: whole_model } = subject;
    let scene = &layout.system;
    let whole = &model.declaration.name.ident;
    let selection = &level.selection;
    let held: Vec<Name> = selection.held.iter().map(|held| variable_name(model, held.place)).collect();
    let given = selection.constants.iter().map(|c| model.constants[*c].name);
    // The structs of the constants and of the state, here and in the system.
    let own_fields = layout.supplied.behind(given.chain(&held));
    let whole_names = model.constants.iter().map(|constant| constant.name);
    let whole_fields = layout.supplied.behind(whole_names).of_outer();
    let (_, full) = whole_model.sizes();
    let names = (0..full).map(|place| variable_name(whole_model, place));
    let whole_state = Fields::new(&names.collect::<Vec<Name>>());
    let count = selection.constants.len();
    let (own_marker, whole_marker) = (marker_of(&own_fields), marker_of(&whole_fields));
    let fixes = subject.scene().map_or(&[][..], |(_, facts)| &facts.fixes);
    let locals: Vec<Ident> = (0..count).map(|i| format_ident!("__guen_c{i}")).collect();
    let fixed_names: Vec<&str> = fixes.iter().map(|(c, _)| model.constants[*c].name.text.as_str()).collect();
    let values: Vec<TokenStream> =
        fixes.iter().map(|(_, value)| tokens(&default_text(subject, *value))).collect();
    let own_inputs = Fields::new(selection.inputs.iter().map(|u| model.inputs[*u].name)).of_record("Inputs");
    let whole_inputs = Fields::new(model.inputs.iter().map(|input| input.name));
    let of_inputs = (own_inputs.len() > 0).then(|| {
        let values = selection.inputs.iter().map(|u| {
            let way = whole_inputs.access(*u);
            quote!(inputs.#way)
        });
        let values = own_inputs.literal(&values.collect::<Vec<_>>());
        let copied = whole_inputs.copied();
        quote! {
            impl<R #copied> ::core::convert::From<super::Inputs<R>> for Inputs<R> {
                /// Returns the inputs of the system that the scene has.
                #[inline]
                fn from(inputs: super::Inputs<R>) -> Self {
                    Inputs { #values }
                }
            }
        }
    });
    // Constants that follow others are numbers among the values alone.
    let is_derived = |c: usize| model.constants[c].is_derived;
    let whole_values =
        (0..model.constants.len()).any(is_derived).then(|| quote!(let values = system.__guen_values();));
    let of_whole = |c: usize| {
        let name = whole_fields.access(c);
        if whole_values.is_some() { quote!(values[#c]) } else { quote!(system.#name) }
    };
    let given: Vec<TokenStream> = selection.constants.iter().map(|c| of_whole(*c)).collect();
    let given_fixed: Vec<TokenStream> = fixes.iter().map(|(c, _)| of_whole(*c)).collect();
    // One that would follow itself in the scene is a number there.
    let held_back = |i: usize| is_derived(selection.constants[i]) && !layout.derived.contains(&i);
    let kept = (0..count).map(|i| match (held_back(i), selection.constants[i]) {
        (true, c) => of_whole(c),
        (false, c) => {
            let name = whole_fields.access(c);
            quote!(system.#name)
        }
    });
    let at_rest = selection.held.iter().map(|held| {
        let name = whole_state.access(subject.place_in_whole(held.place));
        quote!(state.#name)
    });
    let functions = layout.supplied.taken(&whole_fields, &quote!(system));
    let built = own_fields.literal(&kept.chain(at_rest).chain(functions).collect::<Vec<_>>());
    let own_values = (!layout.derived.is_empty()).then(|| quote!(let values = self.__guen_values();));
    let own = (0..count).map(|i| {
        let name = own_fields.access(i);
        if own_values.is_some() { quote!(values[#i]) } else { quote!(self.#name) }
    });
    // The constants of the system: those that the scene has, and those that it fixes.
    let whole_constants = (0..model.constants.len()).map(|c| {
        if let Some(i) = selection.constants.iter().position(|own| *own == c) {
            let name = own_fields.access(i);
            return if held_back(i) { quote!(__guen::Derived::Set(self.#name)) } else { quote!(self.#name) };
        }
        let value = fixes.iter().zip(&values).find(|((fixed, _), _)| *fixed == c).map(|(_, value)| value);
        if is_derived(c) { quote!(__guen::Derived::Set(#value)) } else { quote!(#value) }
    });
    let functions = layout.supplied.taken(&own_fields, &quote!(self));
    let whole_constants = whole_fields.literal(&whole_constants.chain(functions).collect::<Vec<_>>());
    let kept_values = (0..count).any(held_back).then(|| whole_values.clone());
    let of_state = level.selection.variables.iter().map(|place| {
        let name = whole_state.access(subject.place_in_whole(*place));
        quote!(state.#name)
    });
    let of_state = layout.state.literal(&of_state.collect::<Vec<_>>());
    let within = within(subject, layout, &whole_state);
    let copied = whole_state.copied();
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
                super::#whole { #whole_constants #whole_marker }
            }
        }

        #of_system

        impl<R: ::core::marker::Copy> ::core::convert::From<&super::State<R>> for State<R> {
            /// The variables of the scene out of a state of the system.
            #[inline]
            fn from(state: &super::State<R>) -> Self {
                State { #of_state }
            }
        }

        impl<R: ::core::marker::Copy> ::core::convert::From<super::State<R>> for State<R> {
            #[inline]
            fn from(state: super::State<R>) -> Self {
                ::core::convert::From::from(&state)
            }
        }

        impl<R #copied> State<R> {
            /// A state of the system: its variables that the scene has from here, the others from `rest`.
            #[inline]
            #[allow(clippy::needless_update, unused_variables, reason = "a scene may have every variable")]
            pub fn within(self, rest: super::State<R>) -> super::State<R> {
                #within
            }
        }

        #of_inputs
    }
}

/// The state of the system out of that of a scene and of `rest`.
fn within(subject: &Subject<'_, '_>, layout: &Layout, whole: &Fields) -> TokenStream {
    let variables = &subject.level.selection.variables;
    if whole.is_flat() && layout.state.is_flat() {
        let fields = &layout.state.accesses()[..variables.len()];
        return quote!(super::State { #(#fields: self.#fields,)* ..rest });
    }
    let set = variables.iter().enumerate().map(|(own, place)| {
        let (to, from) = (whole.access(subject.place_in_whole(*place)), layout.state.access(own));
        quote!(all.#to = self.#from;)
    });
    quote! {
        let mut all = rest;
        #(#set)*
        all
    }
}
