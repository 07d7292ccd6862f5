//! Items that a scene does not provide: methods that no call can satisfy, so that the compiler names the line to add. A bound
//! that nothing fulfils keeps them out of the program.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};

use super::layout::{Layout, inputs};
use crate::derive::Subject;
use crate::model::FormKind;

/// A quantity that the system has and the scene has not.
struct Quantity {
    /// The method.
    method: &'static str,
    /// The line to add.
    note: String,
    /// Whether it takes the inputs.
    is_driven: bool,
    /// The type that the system's method returns.
    returns: TokenStream,
}

pub(super) fn items(subject: &Subject<'_, '_>, layout: &Layout) -> TokenStream {
    let Some((scene, _)) = subject.scene() else { return TokenStream::new() };
    let (parameter, _) = inputs(layout);
    let quantities = quantities(subject, layout);
    let traits = quantities.iter().map(|quantity| {
        let name = format_ident!("{}", quantity.method);
        let message = format!("scene `{}` does not provide `{}`", scene.name, quantity.method);
        let label = format!("not in scene `{}`", scene.name);
        let note = &quantity.note;
        quote! {
            #[diagnostic::on_unimplemented(message = #message, label = #label, note = #note)]
            pub trait #name {}
        }
    });
    let methods = quantities.iter().map(|quantity| {
        let (name, returns) = (format_ident!("{}", quantity.method), &quantity.returns);
        let parameter = quantity.is_driven.then_some(&parameter);
        quote! {
            #[doc(hidden)]
            pub fn #name(&self, _t: R, _state: &State<R> #parameter) -> #returns
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

fn quantities(subject: &Subject<'_, '_>, layout: &Layout) -> Vec<Quantity> {
    let Subject { model, level } = subject;
    let (selection, name) = (&level.selection, subject.name());
    let (size, inputs) = (layout.size, layout.inputs);
    let line = |line: &str| format!("write `provide {line};` in scene `{name}`");
    let system = &model.declaration.name;
    let whole = format!("no scene has it: ask the system `{system}`");
    let mut found = Vec::new();
    let mut add = |is_there: bool, method, note: String, is_driven, returns| {
        if !is_there {
            found.push(Quantity { method, note, is_driven, returns });
        }
    };
    add(selection.energy, "energy", line("energy"), false, quote!(R));
    let has_reactions = level.derivation.reactions.iter().any(Option::is_some);
    let reactions = line("reactions");
    add(
        !has_reactions || !selection.reactions.is_empty(),
        "reactions",
        reactions,
        true,
        quote!(super::Reactions<R>),
    );
    let outputs: Vec<&str> = model.outputs.iter().map(|output| output.name.text.as_str()).collect();
    let no_outputs = outputs.is_empty() || !selection.outputs.is_empty();
    add(no_outputs, "outputs", line(&outputs.join(", ")), true, quote!(super::Outputs<R>));
    let linearization = quote!(__guen::Linearization<R, #size, #inputs>);
    add(selection.linearization, "linearize", line("linearization"), true, linearization);
    let mut wanted = if selection.outputs.is_empty() { outputs.clone() } else { Vec::new() };
    if !selection.linearization {
        wanted.push("linearization");
    }
    let is_there = outputs.is_empty() || wanted.is_empty();
    let rows: usize = model.outputs.iter().map(|output| output.components.len()).sum();
    let linearization = quote!(__guen::OutputLinearization<R, #size, #inputs, #rows>);
    add(is_there, "linearize_outputs", line(&wanted.join(", ")), true, linearization);
    let is_position = |form: &crate::model::FormEntry<'_>| form.kind == FormKind::Holonomic;
    if selection.holonomic.is_empty() && model.forms.iter().any(is_position) {
        let note =
            "a scene has the residuals of holonomic equations of which it keeps every coordinate".to_owned();
        add(false, "residuals", note, false, quote!(super::Residuals<R>));
    }
    add(
        false,
        "velocities",
        "the velocities of a scene's coordinates are in `rhs`".to_owned(),
        false,
        quote!(super::Coordinates<R>),
    );
    add(false, "kinetic_energy", whole.clone(), false, quote!(R));
    add(false, "force_function", whole.clone(), false, quote!(R));
    add(false, "momenta", whole.clone(), false, quote!(super::Momenta<R>));
    add(false, "power", whole, true, quote!(R));
    found
}

#[cfg(test)]
mod tests {
    /// The types that the system's methods return.
    #[test]
    fn missing_methods_return_what_the_systems_return() {
        let text = crate::expand(
            "pub system S {
                constants { m > 0 } coordinates { x, y } parameters { u = dot(x); v = dot(y); }
                kinetic_energy = m*(u^2 + v^2)/2;
                outputs { place = vec(x, y); speed = u; }
                scene Bare { track x; }
             }"
            .parse()
            .unwrap(),
        );
        let text: String = text.to_string().split_whitespace().collect();
        let of_scene = &text[text.find("modmissing").unwrap()..];
        for (method, returns) in [
            ("energy", "R"),
            ("outputs", "super::Outputs<R>"),
            ("linearize", "__guen::Linearization<R,2usize,0usize>"),
            ("linearize_outputs", "__guen::OutputLinearization<R,2usize,0usize,4usize>"),
            ("velocities", "super::Coordinates<R>"),
            ("momenta", "super::Momenta<R>"),
            ("power", "R"),
        ] {
            let signature = format!("pubfn{method}(&self,_t:R,_state:&State<R>)->{returns}where");
            assert!(of_scene.contains(&signature), "{signature} in {of_scene}");
        }
    }
}
