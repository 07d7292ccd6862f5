//! From a derived system to Rust items, one file for each kind of item.
//!
//! Two piles: what users name (the constants, the state, the operators, ...) carries their spans, visibility and
//! documentation; straight-line code sits in the private module `program`, where lint allowances are.

mod classification;
mod code;
mod constants;
mod control;
mod documentation;
mod functions;
mod limits;
mod linearization;
mod motion;
mod operators;
mod outline;
mod physical;
mod positions;
mod records;
mod serde;
mod uses;

use proc_macro2::{Ident, Span, TokenStream};
use quote::{format_ident, quote};

use crate::derive::Derived;
use crate::syntax::Declaration;

pub use outline::outline;

/// The name of the module beside the struct: `RollingHoop` becomes `rolling_hoop`.
pub(crate) fn module_name(system: &Ident) -> Ident {
    let text = system.to_string();
    let text = text.strip_prefix("r#").unwrap_or(&text);
    let letters: Vec<char> = text.chars().collect();
    let mut name = String::new();
    for (i, letter) in letters.iter().enumerate() {
        let starts_word = letter.is_uppercase()
            && i > 0
            && (letters[i - 1].is_lowercase()
                || letters[i - 1].is_numeric()
                || letters.get(i + 1).is_some_and(|next| next.is_lowercase()));
        if starts_word && letters[i - 1] != '_' {
            name.push('_');
        }
        name.extend(letter.to_lowercase());
    }
    if name == text {
        name.push_str("_system");
    }
    if crate::names::is_rust_keyword(&name) {
        if crate::names::can_be_raw(&name) {
            return Ident::new_raw(&name, system.span());
        }
        name.push('_');
    }
    Ident::new(&name, system.span())
}

/// The path of the facade in the user's crate.
pub(crate) fn facade(declaration: &Declaration) -> TokenStream {
    declaration.crate_path.clone().unwrap_or_else(|| quote!(::guen))
}

/// Sizes and names that every part of the emission needs.
struct Layout {
    /// The system's name.
    system: Ident,
    /// Numbers: coordinates `n`, parameters `l`, state `n + l`, constants, hoisted values, inputs.
    n: usize,
    l: usize,
    size: usize,
    constants: usize,
    hoisted: usize,
    inputs: usize,
    /// Fields of the state.
    state: Vec<Ident>,
}

impl Layout {
    fn new(derived: &Derived<'_>) -> Self {
        let model = &derived.model;
        let (n, l) = (model.coordinates.len(), model.mechanics.forms.degrees);
        let parameters = model.forms[..l].iter().map(form_ident);
        let state = model.coordinates.iter().map(|c| c.name.ident.clone()).chain(parameters).collect();
        Layout {
            system: model.declaration.name.ident.clone(),
            n,
            l,
            size: n + l,
            constants: model.constants.len(),
            hoisted: derived.programs.prepared.len(),
            inputs: model.inputs.len(),
            state,
        }
    }
}

/// The field of a form: its name as written, with the component where a vector was written.
fn form_ident(form: &crate::model::FormEntry<'_>) -> Ident {
    if form.name == form.written.text {
        form.written.ident.clone()
    } else {
        format_ident!("{}", form.name, span = form.written.span())
    }
}

/// Text of Rust as tokens; what is written here is ours, so that a failure is a bug of ours.
fn tokens(text: &str) -> TokenStream {
    text.parse().unwrap_or_else(|_| {
        let message = "guen emitted text that is not Rust: this is a bug of guen";
        quote!(::core::compile_error!(#message))
    })
}

/// Emits a derived system.
pub fn emit(mut derived: Derived<'_>) -> TokenStream {
    let layout = Layout::new(&derived);
    let facade = facade(derived.model.declaration);
    let module = module_name(&layout.system);
    let visibility = derived.model.declaration.visibility.outside();
    let report = crate::report::Report::new(&mut derived);
    let system = &layout.system;
    let parts = [
        constants::items(&derived, &layout, &report),
        records::items(&derived, &layout),
        motion::items(&derived, &layout),
        linearization::items(&derived, &layout),
        control::items(&derived, &layout),
        limits::items(&derived, &layout),
        serde::items(&derived, &layout),
        positions::items(&derived, &layout),
        physical::items(&derived, &layout),
        operators::items(&mut derived, &layout),
        classification::items(&derived, &layout),
        documentation::constants(&report),
        functions::module(&derived, &layout),
        uses::items(&derived.model),
    ];
    let docs = documentation::module(&report, system);
    let span = Span::call_site();
    let alias = Ident::new("__guen", span);
    quote! {
        #docs
        #[allow(non_snake_case, non_camel_case_types, non_upper_case_globals, reason = "names are the user's own")]
        #[allow(unreachable_pub, reason = "the visibility of the module is the user's choice")]
        #visibility mod #module {
            #[allow(unused_imports, reason = "small systems use few of its items")]
            use #facade::__private as #alias;
            #(#parts)*
        }
        #[allow(unused_imports, reason = "the module alone may be what is used")]
        #visibility use #module::#system;
    }
}
