//! Contacts: the trait by which they run.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};

use crate::derive::{Branch, ContactFacts, Subject, function};
use crate::emit::layouts::layout::Layout;
use crate::model::{ContactKind, Contacts};
use crate::syntax::Crossing;

pub(in crate::emit) fn items(subject: &Subject<'_, '_>, layout: &Layout) -> TokenStream {
    let (Some(contacts), Some(facts)) = (&subject.model.contacts, &subject.level.contacts) else {
        return TokenStream::new();
    };
    let Layout { size, n, .. } = layout;
    let count = contacts.entries.len();
    let rows = contacts.rows().count();
    let switches = facts.switches.len() + facts.resets.len() + facts.branches.len();
    let elements = elements(contacts);
    let signals = facts.switches.iter().map(|s| {
        let name = &contacts.switches[*s].name.text;
        quote!(__guen::hybrid::Signal::switch(#name))
    });
    let resets = facts.resets.iter().map(|own| {
        let reset = &contacts.resets[own.reset];
        let name = &reset.name.text;
        match reset.crossing {
            Crossing::Rises => quote!(__guen::hybrid::Signal::reset_rising(#name)),
            Crossing::Falls => quote!(__guen::hybrid::Signal::reset_falling(#name)),
        }
    });
    let branches =
        facts.branches.iter().map(|Branch { text, .. }| quote!(__guen::hybrid::Signal::branch(#text)));
    let signals = signals.chain(resets).chain(branches);
    let (owner, system) = match layout.inputs {
        0 => (quote!(Prepared), quote!(self)),
        _ => (quote!(Driven), quote!(self.system)),
    };
    let given = layout.inputs;
    let inputs = match given {
        0 => quote!([]),
        _ => {
            quote!(<[::core::primitive::f64; #given]>::from(self.inputs).map(<S as __guen::Lift<::core::primitive::f64>>::lift))
        }
    };
    let lifted_of = |system: &TokenStream, inputs: &TokenStream| {
        quote! {
            let constants = #system.constants.map(<S as __guen::Lift<::core::primitive::f64>>::lift);
            let hoisted = #system.hoisted.map(<S as __guen::Lift<::core::primitive::f64>>::lift);
            let inputs: [S; #given] = #inputs;
        }
    };
    let lifted = lifted_of(&system, &inputs);
    // Programs in which inputs stand are those of the prepared system, with whatever inputs.
    let with_any = match given {
        0 => lifted.clone(),
        _ => lifted_of(&quote!(self), &quote!(*inputs)),
    };
    let program = |name: &str, rest: &TokenStream| {
        let name = format_ident!("{name}");
        quote!(program::#name(&constants, &hoisted, t, state, &inputs, #rest))
    };
    let has = |name: &str| subject.level.program(name).is_some();
    let still = quote!(&[<S as __guen::Real>::zero(); #switches], &[<S as __guen::Real>::zero(); #count]);
    let free_motion = program(function::FREE_MOTION, &quote!(switches, speeds));
    let free_rates = program(function::FREE_RATES, &quote!(switches, &[<S as __guen::Real>::zero(); #count]));
    let row_rates = has(function::ROW_RATES).then(|| {
        let program = program(function::ROW_RATES, &still);
        quote! {
            #[inline]
            fn row_rates<S: __guen::Lift<::core::primitive::f64>>(&self, t: S, state: &[S; #size]) -> [S; #rows] {
                #lifted
                #program
            }
        }
    });
    let row_drifts = has(function::ROW_DRIFTS).then(|| {
        let program = program(function::ROW_DRIFTS, &still);
        quote! {
            #[inline]
            fn row_drifts(
                &self, t: ::core::primitive::f64, state: &[::core::primitive::f64; #size],
            ) -> [::core::primitive::f64; #rows] {
                type S = ::core::primitive::f64;
                #lifted
                #program
            }
        }
    });
    let conditions = has(function::CONDITIONS).then(|| {
        let program =
            program(function::CONDITIONS, &quote!(switches, &[<S as __guen::Real>::zero(); #count]));
        quote! {
            #[inline]
            fn conditions<S: __guen::Lift<::core::primitive::f64>>(
                &self, t: S, state: &[S; #size], switches: &[S; #switches],
            ) -> __guen::hybrid::Conditions<S, #count> {
                #lifted
                __guen::checks::conditions(&#program)
            }
        }
    });
    let signal_values = if has(function::SIGNALS) {
        let program = program(function::SIGNALS, &still);
        quote!(#with_any #program)
    } else {
        quote!([])
    };
    let reset = has(function::RESETS).then(|| {
        let program = program(function::RESETS, &quote!(switches, &[<S as __guen::Real>::zero(); #count]));
        let changes = changes(facts);
        Function {
            name: "reset",
            leading: vec![(quote!(signal), quote!(::core::primitive::usize))],
            result: quote!([S; #size]),
            body: quote! {
                #with_any
                let values = #program;
                let mut after = *state;
                match signal {
                    #changes
                    _ => {}
                }
                after
            },
            trailing: vec![(quote!(switches), quote!(&[S; #switches]))],
        }
    });
    let restitutions = if has(function::RESTITUTIONS) {
        quote!(program::restitutions(&#system.constants, &#system.hoisted))
    } else {
        quote!([])
    };
    let inputs_type = match given {
        0 => quote!(()),
        _ => quote!(Inputs<::core::primitive::f64>),
    };
    let with_inputs = match given {
        0 => quote!((): ()),
        _ => quote!(inputs: Inputs<::core::primitive::f64>),
    };
    let with_held = match given {
        0 => quote!(*self),
        _ => quote!(self.system.driven(inputs)),
    };
    let painleve_free = facts.painleve.is_excluded();
    let holonomic = subject.level.selection.holonomic.len();
    let all_holonomic = holonomic + subject.level.selection.redundant.len();
    let onto_constraints = (holonomic > 0).then(|| {
        quote! {
            fn onto_constraints<S: __guen::Lift<::core::primitive::f64>>(
                &self, t: S, state: &[S; #size],
            ) -> ::core::result::Result<[S; #size], __guen::PositionsError> {
                let constants = #system.constants.map(<S as __guen::Lift<::core::primitive::f64>>::lift);
                let hoisted = #system.hoisted.map(<S as __guen::Lift<::core::primitive::f64>>::lift);
                __guen::onto::<S, #n, #size, #holonomic>(t, state, |t, coordinates| {
                    let values = program::gradients(&constants, &hoisted, t, coordinates);
                    let row = |v| ::core::array::from_fn(|i| values[#all_holonomic + v * #n + i]);
                    (::core::array::from_fn(|v| values[v]), ::core::array::from_fn(row))
                })
            }
        }
    });
    let count_of_singularities = subject.level.singularities;
    let singularities = (count_of_singularities > 0).then(|| {
        quote! {
            #[inline]
            fn singularities<S: __guen::Lift<::core::primitive::f64>>(
                &self, t: __guen::RunningError<S>, state: &[__guen::RunningError<S>; #size],
                values: &mut [__guen::RunningError<S>],
            ) -> ::core::primitive::usize {
                let constants = #system.constants.map(<S as __guen::Lift<::core::primitive::f64>>::lift);
                let hoisted = #system.hoisted.map(<S as __guen::Lift<::core::primitive::f64>>::lift);
                let (constants, hoisted) = (&__guen::rounded(&constants), &__guen::PreparedValues::rounded_once(&hoisted));
                __guen::checks::placed(values, &program::domain(constants, hoisted, t, state), #count_of_singularities)
            }
        }
    });
    let eliminated = eliminated(contacts, facts, *size, &with_any);
    let (modes_of_programs, eliminated_rates) = eliminated.unzip();
    let functions = [
        Function {
            name: "free_motion",
            leading: Vec::new(),
            trailing: vec![
                (quote!(switches), quote!(&[S; #switches])),
                (quote!(speeds), quote!(&[S; #count])),
            ],
            result: quote!(__guen::hybrid::FreeMotion<S, #size, #rows, #count>),
            body: quote!(#with_any __guen::checks::free_motion::<S, #n, #size, #rows, #count>(&#free_motion)),
        },
        Function {
            name: "free_rates",
            leading: Vec::new(),
            trailing: vec![(quote!(switches), quote!(&[S; #switches]))],
            result: quote!([S; #size]),
            body: quote!(#with_any #free_rates),
        },
        Function {
            name: "signals",
            leading: Vec::new(),
            trailing: Vec::new(),
            result: quote!([S; #switches]),
            body: signal_values,
        },
    ];
    let loads = has(function::LOADS).then(|| {
        let program = program(function::LOADS, &quote!(switches, &[<S as __guen::Real>::zero(); #count]));
        let entries = contacts.entries.iter().enumerate();
        let loaded = entries.filter(|(_, entry)| entry.load_reaction.is_some()).map(|(place, _)| place);
        Function {
            name: "loads",
            leading: Vec::new(),
            trailing: vec![(quote!(switches), quote!(&[S; #switches]))],
            result: quote!(__guen::hybrid::Loads<S, #rows, #count>),
            body: quote!(#with_any __guen::checks::loads::<S, #rows, #count>(&[#(#loaded),*], &#program)),
        }
    });
    let functions: Vec<Function> =
        functions.into_iter().chain(loads).chain(reset).chain(eliminated_rates).collect();
    let sizes = quote!(#size, #rows, #count, #switches);
    let own = functions.iter().map(|function| function.of_system(*size, given, &sizes));
    let actuated = (given > 0).then(|| {
        let with_inputs = functions.iter().map(|function| function.with_inputs(*size, given));
        quote! {
            #[allow(unused_variables, reason = "every function has the signature of the trait")]
            impl __guen::hybrid::ActuatedModes<#sizes, #given> for Prepared<::core::primitive::f64> {
                type Held = Driven<::core::primitive::f64>;

                #[inline]
                fn at_zero(&self) -> Self::Held {
                    self.driven(::core::default::Default::default())
                }

                #[inline]
                fn inputs_by<S: __guen::Real, L: __guen::InputLaw<Self>>(law: &L, t: S, state: &[S; #size]) -> [S; #given] {
                    ::core::convert::From::from(__guen::InputLaw::<Self>::at(law, t, &::core::convert::From::from(*state)))
                }

                #(#with_inputs)*
            }
        }
    });
    let modes = super::modes::items(subject, contacts, facts);
    let in_mode = in_mode(facts.switches.len(), &[*size, rows, count, switches]);
    let outputs = outputs(subject, layout, &[*size, rows, count, switches]);
    let held = (given > 0).then(|| quote!(__guen::held_through_modes!(#given);));
    quote! {
        #modes

        __guen::simulated_through_modes!(#owner #size #rows #count #switches);
        #held

        impl #owner<::core::primitive::f64> {
            #in_mode
            #outputs
        }

        #[allow(unused_variables, reason = "every function has the signature of the trait")]
        impl __guen::hybrid::HybridSystem<#size, #rows, #count, #switches> for #owner<::core::primitive::f64> {
            const ELEMENTS: [__guen::hybrid::Element; #count] = [#(#elements),*];
            const SIGNALS: [__guen::hybrid::Signal; #switches] = [#(#signals),*];
            const COORDINATES: ::core::primitive::usize = #n;
            const PAINLEVE_FREE: ::core::primitive::bool = #painleve_free;

            type Mode = Mode;
            type Inputs = #inputs_type;

            #[inline]
            fn with_inputs(&self, #with_inputs) -> Self {
                #with_held
            }

            #modes_of_programs
            #(#own)*
            #row_rates
            #row_drifts
            #conditions

            #onto_constraints
            #singularities

            #[inline]
            fn restitutions(&self) -> [::core::primitive::f64; #count] {
                #restitutions
            }

            #[inline]
            fn allows(&self, mode: &__guen::hybrid::Mode<#count>) -> ::core::primitive::bool {
                MODES.contains(&::core::convert::From::from(*mode))
            }
        }

        #actuated
    }
}

/// A function of the trait in which inputs may stand.
struct Function {
    name: &'static str,
    /// The arguments before time and state, and those behind them, with their types.
    leading: Vec<(TokenStream, TokenStream)>,
    trailing: Vec<(TokenStream, TokenStream)>,
    result: TokenStream,
    body: TokenStream,
}

impl Function {
    fn written(
        &self,
        name: &proc_macro2::Ident,
        size: usize,
        inputs: &TokenStream,
        body: &TokenStream,
    ) -> TokenStream {
        let list = |arguments: &[(TokenStream, TokenStream)]| -> TokenStream {
            arguments.iter().map(|(name, kind)| quote!(#name: #kind,)).collect()
        };
        let (leading, trailing, result) = (list(&self.leading), list(&self.trailing), &self.result);
        quote! {
            #[inline]
            fn #name<S: __guen::Lift<::core::primitive::f64>>(
                &self, #leading t: S, state: &[S; #size], #inputs #trailing
            ) -> #result {
                #body
            }
        }
    }

    /// The function of the system, or of the system with its inputs held.
    fn of_system(&self, size: usize, given: usize, sizes: &TokenStream) -> TokenStream {
        let name = format_ident!("{}", self.name);
        if given == 0 {
            return self.written(&name, size, &TokenStream::new(), &self.body);
        }
        let with = format_ident!("{}_with", self.name);
        let names = |arguments: &[(TokenStream, TokenStream)]| -> TokenStream {
            arguments.iter().map(|(name, _)| quote!(#name,)).collect()
        };
        let (leading, trailing) = (names(&self.leading), names(&self.trailing));
        let body = quote! {
            let inputs = <[::core::primitive::f64; #given]>::from(self.inputs);
            let inputs = inputs.map(<S as __guen::Lift<::core::primitive::f64>>::lift);
            __guen::hybrid::ActuatedModes::<#sizes, #given>::#with(&self.system, #leading t, state, &inputs, #trailing)
        };
        self.written(&name, size, &TokenStream::new(), &body)
    }

    /// The function of the prepared system with whatever inputs.
    fn with_inputs(&self, size: usize, given: usize) -> TokenStream {
        let name = format_ident!("{}_with", self.name);
        self.written(&name, size, &quote!(inputs: &[S; #given],), &self.body)
    }
}

/// The assignments of each reset, by its signal: resets come after the switches.
fn changes(facts: &ContactFacts) -> TokenStream {
    let mut given = 0_usize;
    let arms = facts.resets.iter().enumerate().map(|(place, reset)| {
        let signal = facts.switches.len() + place;
        let first = given;
        given += reset.assignments.len();
        let assigned = reset.assignments.iter().zip(first..);
        let assigned = assigned.map(|((_, variable), value)| quote!(after[#variable] = values[#value];));
        quote!(#signal => { #(#assigned)* })
    });
    arms.collect()
}

/// The modes that have a program of their own, and their rates.
fn eliminated(
    contacts: &Contacts<'_>,
    facts: &ContactFacts,
    size: usize,
    lifted: &TokenStream,
) -> Option<(TokenStream, Function)> {
    let count = contacts.entries.len();
    let modes = facts.eliminated.iter().map(|place| {
        let states = contacts.entries.iter().zip(&facts.modes[*place]);
        let states = states.map(|(entry, state)| super::modes::variant(entry.states()[*state]));
        quote!(__guen::hybrid::Mode([#(__guen::hybrid::ElementState::#states),*]))
    });
    let last = facts.eliminated.len().checked_sub(1)?;
    let arms = (0..=last).map(|place| {
        let program = format_ident!("{}", function::mode_rates(place));
        let pattern = if place < last { quote!(#place) } else { quote!(_) };
        quote!(#pattern => program::#program(&constants, &hoisted, t, state, &inputs),)
    });
    let modes = quote!(const ELIMINATED: &'static [__guen::hybrid::Mode<#count>] = &[#(#modes),*];);
    let rates = Function {
        name: "eliminated_rates",
        leading: vec![(quote!(place), quote!(::core::primitive::usize))],
        trailing: Vec::new(),
        result: quote!([S; #size]),
        body: quote!(#lifted match place { #(#arms)* }),
    };
    Some((modes, rates))
}

/// `in_mode`, with so many declared switches; `sizes` are the numbers of states, rows, contacts and switches.
fn in_mode(declared: usize, sizes: &[usize; 4]) -> TokenStream {
    let [size, rows, count, switches] = sizes;
    let (parameter, values, docs) = if declared == 0 {
        (quote!(), quote!([false; #switches]), "")
    } else {
        let docs = ", with these values of its switches";
        let values = quote!(__guen::checks::padded::<#declared, #switches>(&switches));
        (quote!(, switches: [::core::primitive::bool; #declared]), values, docs)
    };
    let docs = format!("The system in a mode{docs}: a smooth system that every stepper runs.");
    quote! {
        #[doc = #docs]
        pub fn in_mode(
            &self, mode: Mode #parameter
        ) -> __guen::hybrid::InMode<Self, #size, #rows, #count, #switches> {
            __guen::hybrid::InMode::anywhere(*self, ::core::convert::From::from(mode), #values)
        }
    }
}

/// `outputs_in_mode`, where there are outputs.
fn outputs(subject: &Subject<'_, '_>, layout: &Layout, sizes: &[usize; 4]) -> Option<TokenStream> {
    subject.level.program(function::CONTACT_OUTPUTS)?;
    let [_, rows, count, switches] = sizes;
    let (system, inputs) = match layout.inputs {
        0 => (quote!(self), quote!(&[])),
        _ => (quote!(self.system), quote!(&::core::convert::From::from(self.inputs))),
    };
    Some(quote! {
        /// The declared outputs at a state in a mode, with the reactions of the contacts there.
        pub fn outputs_in_mode(
            &self, mode: Mode, t: ::core::primitive::f64, state: &State<::core::primitive::f64>,
        ) -> Outputs<::core::primitive::f64> {
            let state = &::core::convert::From::from(*state);
            let in_mode = __guen::hybrid::InMode::<_, _, #rows, #count, #switches>::new(
                *self, ::core::convert::From::from(mode), t, state,
            );
            let reactions = in_mode.reactions(t, state).reactions;
            Outputs::from_values(&program::contact_outputs(
                &#system.constants, &#system.hoisted, t, state, #inputs, &in_mode.switches(), &[0.0; #count], &reactions,
            ))
        }
    })
}

/// The table of contacts, grips and latches.
fn elements(contacts: &Contacts<'_>) -> Vec<TokenStream> {
    let mut row = 0_usize;
    contacts
        .entries
        .iter()
        .map(|entry| {
            let name = &entry.name.text;
            let first = row;
            row += entry.rows.len();
            let tangential = first + usize::from(entry.gap.is_some())..row;
            let element = match entry.kind {
                ContactKind::Smooth => quote!(__guen::hybrid::Element::smooth(#name, #first)),
                ContactKind::Planar | ContactKind::Spatial => {
                    quote!(__guen::hybrid::Element::rough(#name, #first, &[#(#tangential),*]))
                }
                ContactKind::Grip => quote!(__guen::hybrid::Element::grip(#name, &[#(#tangential),*])),
                ContactKind::Latch => quote!(__guen::hybrid::Element::latch(#name, #first)),
            };
            let loaded = entry.loaded_by.map(|row| quote!(.loaded_by(#row)));
            let loaded = loaded.or(entry.load_reaction.map(|_| quote!(.loaded_by_constraint())));
            let of_speed = entry.friction_of_speed.then(|| quote!(.with_friction_of_speed()));
            let conditional = entry.when.map(|_| quote!(.with_condition()));
            quote!(#element #loaded #of_speed #conditional)
        })
        .collect()
}
