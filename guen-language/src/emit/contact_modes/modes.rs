//! Modes: the states of every contact, in fields, arrays and structs as in the state, and the list of all modes.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use crate::derive::{ContactFacts, Subject, function};
use crate::emit::documentation;
use crate::emit::layouts::fields::{Fields, Part, Tree, plain};
use crate::emit::layouts::parts::{self, Modules};
use crate::emit::layouts::text;
use crate::model::{ContactEntry, ContactState, Contacts};
use crate::names::{MODES, type_name};
use crate::report::row_name;
use crate::syntax::Instance;

const RECORD: &str = MODES;

/// `Mode` and the types of states that no instance has, those of the system in a scene, and the list of all modes.
pub(super) fn items(
    subject: &Subject<'_, '_>,
    contacts: &Contacts<'_>,
    of_level: &ContactFacts,
) -> TokenStream {
    let entries = &contacts.entries;
    let instances = &subject.model.declaration.instances;
    let structure = structure(contacts);
    let count = entries.len();
    let names = structure.names();
    let accesses = structure.accesses();
    let from_states: Vec<TokenStream> =
        (0..count).map(|i| quote!(::core::convert::From::from(mode.0[#i]))).collect();
    let literal = structure.literal(&from_states);
    let records = match subject.level.scene {
        Some(_) => {
            let own = own_types(structure.trees());
            quote!(#[doc(inline)] pub use super::{Mode #(, #own)*};)
        }
        None => {
            let states = states(structure.trees(), entries);
            let fields = fields(structure.trees(), entries, instances, 0);
            quote! {
                #states
                __guen::contact_mode! { #count { #(#fields)* } [#(#names)*] |mode| [#(mode.#accesses),*] { #literal } }
            }
        }
    };
    let types = types(&structure);
    let table = of_level.modes.iter().map(|mode| {
        let values = entries.iter().zip(mode).zip(&types).map(|((entry, state), of)| {
            let variant = variant(entry.states()[*state]);
            quote!(#of::#variant)
        });
        let literal = structure.literal(&values.collect::<Vec<_>>());
        quote!(Mode { #literal })
    });
    let cost = subject.level.program(function::FREE_MOTION).map(|program| text::cost(&program.cost));
    let info = of_level.modes.iter().enumerate().map(|(place, mode)| {
        let rows = rows(contacts, mode);
        let painleve_free = of_level.painleve.doubtful[place].is_empty();
        let own = of_level.eliminated.iter().position(|eliminated| *eliminated == place);
        let own = own.and_then(|own| subject.level.program(&function::mode_rates(own)));
        let cost = own.map_or_else(|| quote!(#cost), |program| text::cost(&program.cost));
        quote! {
            __guen::hybrid::ModeInfo { mode: MODES[#place], rows: &[#(#rows),*], painleve_free: #painleve_free, cost: #cost }
        }
    });
    quote! {
        #records

        /// Every mode that the declaration allows.
        pub const MODES: &[Mode] = &[#(#table),*];

        /// Rows, cost and the proof of Painlevé's condition of each of the [`MODES`].
        pub const MODE_INFO: &[__guen::hybrid::ModeInfo<Mode>] = &[#(#info),*];
    }
}

/// The rows of a mode that have a reaction.
fn rows(contacts: &Contacts<'_>, mode: &[usize]) -> Vec<String> {
    let states = || contacts.entries.iter().zip(mode).map(|(entry, state)| (entry, entry.states()[*state]));
    let rows = states().flat_map(|(entry, state)| {
        let normal = usize::from(entry.gap.is_some());
        let count = match state {
            ContactState::Open | ContactState::Free => 0,
            ContactState::Closed | ContactState::Locked | ContactState::Stick => entry.rows.len(),
            ContactState::SlipPlus | ContactState::SlipMinus | ContactState::Slip => normal,
        };
        (0..count).map(|row| row_name(entry, row))
    });
    rows.collect()
}

/// Adds the modes of instances, and the types of their states, to the modules of the instances.
pub(in crate::emit) fn add(modules: &mut Modules, subject: &Subject<'_, '_>) {
    let (Some(contacts), Some(_)) = (&subject.model.contacts, &subject.level.contacts) else { return };
    let instances = &subject.model.declaration.instances;
    for part in structure(contacts).parts() {
        let Part { fields: trees, module, .. } = part;
        let trees = || trees.iter().map(|(ident, tree)| (ident, tree));
        if subject.level.scene.is_some() {
            let outside = (0..=module.len()).map(|_| quote!(super::));
            let own = own_types(trees());
            modules.add(module, quote!(#[doc(inline)] pub use #(#outside)* #(#module::)* {Mode #(, #own)*};));
            continue;
        }
        let states = states(trees(), &contacts.entries);
        let fields = fields(trees(), &contacts.entries, instances, module.len());
        modules.add(
            module,
            quote! {
                #states
                __guen::instance_mode! { #(#fields)* }
            },
        );
    }
}

fn structure(contacts: &Contacts<'_>) -> Fields {
    let names: Vec<_> = contacts.entries.iter().map(|entry| entry.name).collect();
    let states: Vec<_> = contacts.entries.iter().map(|entry| entry.states()).collect();
    Fields::of_types(&names, &states).of_record(RECORD).without_reals()
}

/// The names of the types of the states of the contacts among some fields.
fn own_types<'t>(trees: impl Iterator<Item = (&'t Ident, &'t Tree)>) -> Vec<Ident> {
    trees.filter(|(_, tree)| tree.instance().is_none()).map(|(ident, _)| type_of(ident)).collect()
}

/// The types of the states of the contacts among some fields.
fn states<'t>(
    trees: impl Iterator<Item = (&'t Ident, &'t Tree)>,
    entries: &[ContactEntry<'_>],
) -> TokenStream {
    let own = trees.filter(|(_, tree)| tree.instance().is_none());
    let enums = own.filter_map(|(ident, tree)| {
        let entry = &entries[tree.first()?];
        let name = type_of(ident);
        let docs = match tree {
            Tree::Leaf(_) => format!("The state of `{}`.", entry.name),
            _ => format!("The states of `{}`.", plain(ident)),
        };
        let variants = entry.states().iter().map(|state| variant(*state));
        Some(quote!(__guen::contact_states! { #docs #name #(#variants)* }))
    });
    enums.collect()
}

/// The fields of a struct of modes, so many modules inside of that of the system.
fn fields<'t>(
    trees: impl Iterator<Item = (&'t Ident, &'t Tree)>,
    entries: &[ContactEntry<'_>],
    instances: &[Instance],
    depth: usize,
) -> Vec<TokenStream> {
    let fields = trees.map(|(ident, tree)| {
        let name = type_of(ident);
        let kind = tree.inner_type(&|_| quote!(#name), depth);
        let docs = match (tree.instance(), tree.first()) {
            (Some(part), _) => parts::docs_of_instance(instances, part),
            (None, Some(first)) => {
                let entry = &entries[first];
                documentation::entry(entry.docs, &format!("The state of `{}`.", entry.name), None)
            }
            (None, None) => TokenStream::new(),
        };
        quote!(#docs pub #ident: #kind,)
    });
    fields.collect()
}

/// The type of the states of every contact, seen from the module of the system.
fn types(structure: &Fields) -> Vec<TokenStream> {
    fn collect(ident: &Ident, tree: &Tree, module: &[Ident], types: &mut [TokenStream]) {
        match tree {
            Tree::Leaf(place) => {
                let name = type_of(ident);
                types[*place] = quote!(#(#module::)* #name);
            }
            Tree::Array(entries) => entries.iter().for_each(|entry| collect(ident, entry, module, types)),
            Tree::Instance(part) => {
                part.fields.iter().for_each(|(ident, tree)| collect(ident, tree, &part.module, types));
            }
        }
    }
    let mut types = vec![TokenStream::new(); structure.len()];
    structure.trees().for_each(|(ident, tree)| collect(ident, tree, &[], &mut types));
    types
}

fn type_of(field: &Ident) -> Ident {
    format_ident!("{}", type_name(&plain(field)), span = field.span())
}

pub(super) fn variant(state: ContactState) -> Ident {
    format_ident!(
        "{}",
        match state {
            ContactState::Open => "Open",
            ContactState::Closed => "Closed",
            ContactState::Stick => "Stick",
            ContactState::SlipPlus => "SlipForward",
            ContactState::SlipMinus => "SlipBackward",
            ContactState::Slip => "Slip",
            ContactState::Free => "Free",
            ContactState::Locked => "Locked",
        }
    )
}
