//! Items that a scene does not provide: methods that no call can satisfy, so that the compiler names the line to add. A bound
//! that nothing fulfils keeps them out of the program.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};

use crate::derive::Subject;
use crate::emit::layouts::layout::Layout;
use crate::emit::layouts::signatures::{self, Signature};
use crate::model::FormKind;

/// A quantity that the system has and the scene has not.
struct Quantity {
    signature: Signature,
    /// The line to add.
    note: String,
}

pub(in crate::emit) fn items(subject: &Subject<'_, '_>, layout: &Layout) -> TokenStream {
    let Some((scene, _)) = subject.scene() else { return TokenStream::new() };
    let quantities = quantities(subject);
    let traits = quantities.iter().map(|quantity| {
        let method = quantity.signature.method;
        let name = format_ident!("{method}");
        let message = format!("scene `{}` does not provide `{method}`", scene.name);
        let label = format!("not in scene `{}`", scene.name);
        let note = &quantity.note;
        quote! {
            #[diagnostic::on_unimplemented(message = #message, label = #label, note = #note)]
            pub trait #name {}
        }
    });
    let methods = quantities.iter().map(|quantity| {
        let name = format_ident!("{}", quantity.signature.method);
        let head = quantity.signature.head(layout, &quote!(super::));
        quote! {
            #[doc(hidden)]
            #head
            where
                Self: missing::#name,
            {
                ::core::unreachable!()
            }
        }
    });
    if quantities.is_empty() {
        return TokenStream::new();
    }
    quote! {
        #[allow(dead_code, non_camel_case_types, reason = "for messages: nothing implements them")]
        mod missing {
            #(#traits)*
        }

        #[allow(unused_variables, reason = "for messages: nothing can call them")]
        impl<R: __guen::Real> Prepared<R> {
            #(#methods)*
        }
    }
}

fn quantities(subject: &Subject<'_, '_>) -> Vec<Quantity> {
    let Subject { model, level, .. } = subject;
    let (selection, name) = (&level.selection, subject.name());
    let line = |line: &str| format!("write `provide {line};` in scene `{name}`");
    let system = &model.declaration.name;
    let whole = format!("no scene has it: ask the system `{system}`");
    let mut found = Vec::new();
    let mut add = |is_there: bool, signature, note: String| {
        if !is_there {
            found.push(Quantity { signature, note });
        }
    };
    add(selection.energy, signatures::ENERGY, line("energy"));
    let has_reactions = level.derivation.reactions.iter().any(Option::is_some);
    // The records of the whole system are not those of one that has other constraints.
    let has_records = std::ptr::eq(subject.model, subject.whole);
    add(
        !has_records || !has_reactions || !selection.reactions.is_empty(),
        signatures::REACTIONS,
        line("reactions"),
    );
    let outputs: Vec<&str> = model.outputs.iter().map(|output| output.name.text.as_str()).collect();
    let no_outputs = outputs.is_empty() || !selection.outputs.is_empty();
    add(no_outputs, signatures::OUTPUTS, line(&outputs.join(", ")));
    add(selection.linearization, signatures::LINEARIZE, line("linearization"));
    let mut wanted = if selection.outputs.is_empty() { outputs.clone() } else { Vec::new() };
    if !selection.linearization {
        wanted.push("linearization");
    }
    let is_there = outputs.is_empty() || wanted.is_empty();
    let rows = model.outputs.iter().map(|output| output.components.len()).sum();
    add(is_there, signatures::linearize_outputs(rows), line(&wanted.join(", ")));
    let is_position = |form: &crate::model::FormEntry<'_>| form.kind == FormKind::Holonomic;
    let has_residuals = !selection.holonomic.is_empty() || !model.forms.iter().any(is_position);
    let note = "a scene has the residuals of holonomic equations of which it keeps every coordinate";
    add(!has_records || has_residuals, signatures::RESIDUALS, note.to_owned());
    let note = "the velocities of a scene's coordinates are in `rhs`";
    add(false, signatures::VELOCITIES, note.to_owned());
    for signature in
        [signatures::KINETIC_ENERGY, signatures::FORCE_FUNCTION, signatures::MOMENTA, signatures::POWER]
    {
        add(false, signature, whole.clone());
    }
    found
}
