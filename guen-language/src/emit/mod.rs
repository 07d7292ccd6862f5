//! From a derived system to Rust items, one file for each kind of item.
//!
//! Two piles: what users name (the constants, the state, the operators, ...) carries their spans, visibility and
//! documentation; straight-line code sits in the private module `program`, where lint allowances are.

mod bodies;
pub(crate) mod carried;
mod classification;
mod code;
mod constants;
mod control;
mod documentation;
mod functions;
mod integrated;
mod lanes;
mod levels;
mod limits;
mod linearization;
mod missing;
mod motion;
mod operators;
mod outline;
mod physical;
mod positions;
mod recast;
mod records;
mod serde;
mod series;
mod uses;

use proc_macro2::{Ident, Span, TokenStream};
use quote::{format_ident, quote};

use crate::derive::{Derived, Level, Place, SceneFacts};
use crate::model::Model;
use crate::syntax::{Declaration, Name, Scene};

pub use outline::outline;

/// The name of the module beside the struct: `RollingHoop` becomes `rolling_hoop`; where that is the name itself, what
/// it is a module of (a system, a scene) is appended.
pub(crate) fn module_name(system: &Ident, what: &str) -> Ident {
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
        name.push('_');
        name.push_str(what);
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

/// A level of detail on its way to Rust items: the system itself, or one of its scenes. The same files emit both.
pub(crate) struct Subject<'d, 'a> {
    /// The model.
    pub(crate) model: &'d Model<'a>,
    /// The level.
    pub(crate) level: &'d Level,
}

impl<'d, 'a> Subject<'d, 'a> {
    /// The scene, unless it is the system itself.
    pub(crate) fn scene(&self) -> Option<(&'d Scene, &'d SceneFacts)> {
        let facts = self.level.scene.as_ref()?;
        Some((self.model.scenes[facts.index].scene, facts))
    }

    /// The name of the struct.
    pub(crate) fn name(&self) -> &'d Name {
        self.scene().map_or(&self.model.declaration.name, |(scene, _)| &scene.name)
    }
}

/// Sizes and names that every part of the emission needs.
struct Layout {
    /// The name of the struct.
    system: Ident,
    /// Numbers: coordinates, parameters and state of the level, coordinates of the whole system, constants, hoisted
    /// values, inputs.
    n: usize,
    l: usize,
    size: usize,
    all: usize,
    constants: usize,
    hoisted: usize,
    inputs: usize,
    /// The constants that follow others until they are set, each behind those that its formula reads.
    derived: Vec<usize>,
    /// Fields of the state.
    state: Vec<Ident>,
    /// Whether this is the system itself.
    is_whole: bool,
}

impl Layout {
    fn new(subject: &Subject<'_, '_>) -> Self {
        let Subject { model, level } = subject;
        let selection = &level.selection;
        Layout {
            system: subject.name().ident.clone(),
            n: selection.coordinates.len(),
            l: selection.parameters.len(),
            size: selection.variables.len() + selection.carried.len(),
            all: model.coordinates.len(),
            constants: selection.constants.len() + selection.held.len(),
            hoisted: level.programs.prepared.len(),
            inputs: selection.inputs.len(),
            derived: constants::derived(model, level),
            state: {
                let variables = selection.variables.iter().map(|place| variable_ident(model, *place));
                variables.chain(selection.carried.iter().map(|f| carried::ident(model, f))).collect()
            },
            is_whole: level.scene.is_none(),
        }
    }
}

/// The field of a variable.
fn variable_ident(model: &Model<'_>, place: Place) -> Ident {
    match place.checked_sub(model.coordinates.len()) {
        None => model.coordinates[place].name.ident.clone(),
        Some(s) => form_ident(&model.forms[s]),
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
///
/// In a compiler it is read by the compiler's lexer alone, which is optimised. `proc_macro2` would read it twice there,
/// first with its own lexer to see whether it is Rust: a sixth of the hoop's expansion.
fn tokens(text: &str) -> TokenStream {
    let read = if proc_macro::is_available() {
        text.parse().ok().map(|tokens: proc_macro::TokenStream| tokens.into())
    } else {
        text.parse().ok()
    };
    read.unwrap_or_else(|| {
        let message = "guen emitted text that is not Rust: this is a bug of guen";
        quote!(::core::compile_error!(#message))
    })
}

/// Emits a derived system with its scenes.
pub fn emit(derived: Derived<'_>) -> TokenStream {
    let Derived { model, system, scenes } = &derived;
    let facade = facade(model.declaration);
    let whole = Subject { model, level: system };
    let inner: Vec<TokenStream> = scenes
        .iter()
        .map(|scene| {
            let private = quote!(super::__guen);
            module(&Subject { model, level: scene }, &private, &quote!(pub), &TokenStream::new())
        })
        .collect();
    let levels = levels::table(model, scenes);
    let uses = uses::items(&model.identifiers);
    let visibility = model.declaration.visibility.outside();
    module(&whole, &quote!(#facade::__private), &quote!(#visibility), &quote!(#levels #uses #(#inner)*))
}

/// The module of a level, and the struct beside it.
fn module(
    subject: &Subject<'_, '_>,
    private: &TokenStream,
    visibility: &TokenStream,
    inner: &TokenStream,
) -> TokenStream {
    let layout = Layout::new(subject);
    let system = &layout.system;
    let module = module_name(system, if layout.is_whole { "system" } else { "scene" });
    let report = crate::report::Report::new(subject);
    let parts = [
        constants::items(subject, &layout, &report),
        records::items(subject, &layout),
        motion::items(subject, &layout),
        lanes::items(&layout),
        series::items(subject, &layout),
        linearization::items(subject, &layout),
        control::items(subject, &layout),
        limits::items(subject, &layout),
        serde::items(subject, &layout),
        positions::items(subject, &layout),
        physical::items(subject, &layout),
        bodies::items(subject, &layout),
        operators::items(subject, &layout),
        classification::items(subject, &layout),
        levels::items(subject, &layout),
        missing::items(subject, &layout),
        documentation::constants(&report),
        functions::modules(subject, &layout),
        carried::items(subject, &layout),
    ];
    let docs = documentation::module(&report, system, layout.is_whole);
    let alias = Ident::new("__guen", Span::call_site());
    quote! {
        #docs
        #[allow(non_snake_case, non_camel_case_types, non_upper_case_globals, reason = "names are the user's own")]
        #[allow(unreachable_pub, reason = "the visibility of the module is the user's choice")]
        #visibility mod #module {
            #[allow(unused_imports, reason = "small systems use few of its items")]
            use #private as #alias;
            #(#parts)*
            #inner
        }
        #[allow(unused_imports, reason = "the module alone may be what is used")]
        #visibility use #module::#system;
    }
}
