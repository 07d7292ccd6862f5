//! Structs with a named field for everything: state, positions, inputs, momenta, reactions, residuals, outputs.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::documentation;
use super::integrated::units;
use super::layout::{Layout, form_ident};
use crate::derive::Subject;
use crate::syntax::Docs;

/// A field of a record.
#[derive(Clone)]
struct Field {
    ident: Ident,
    docs: TokenStream,
}

pub(super) fn items(subject: &Subject<'_, '_>, layout: &Layout) -> TokenStream {
    let Subject { model, level } = subject;
    let selection = &level.selection;
    let units = &model.units;
    let field = |ident: &Ident, docs: &Docs, fallback: String, unit: Option<&String>| Field {
        ident: ident.clone(),
        docs: documentation::entry(docs, &fallback, unit),
    };
    let coordinates = selection.coordinates.iter().map(|i| &model.coordinates[*i]);
    let coordinates: Vec<Field> = coordinates
        .map(|c| {
            field(&c.name.ident, c.docs, format!("The coordinate `{}`.", c.name), units.get(&c.name.text))
        })
        .collect();
    let forms = |indices: &[usize], what: &str| -> Vec<Field> {
        let forms = indices.iter().map(|j| &model.forms[*j]);
        forms
            .map(|form| field(&form_ident(form), form.docs, format!("{what} `{}`.", form.name), None))
            .collect()
    };
    let parameters = selection.parameters.iter().map(|j| &model.forms[*j]);
    let parameters: Vec<Field> = parameters
        .map(|form| {
            let fallback = format!("The quasi-velocity `{}`.", form.name);
            field(&form_ident(form), form.docs, fallback, units.get(&form.name))
        })
        .collect();
    let whose = if layout.is_whole { "the system" } else { "the scene" };
    let count = |count: usize, noun: &str| format!("{count} {noun}{}", if count == 1 { "" } else { "s" });
    let (kept, speeds) =
        (count(layout.n, "coordinate"), count(layout.l, "quasi-velocity").replace("ys", "ies"));
    let state_docs = format!("A state of {whose}: {kept}, then {speeds}, in the order of the declaration.");
    let mut items = Vec::new();
    let mut add = |name: &str, docs: &str, fields: &[Field]| {
        if !fields.is_empty() {
            items.push(record(name, docs, fields));
        }
    };
    let state = [coordinates.clone(), parameters].concat();
    add("State", &state_docs, &state);
    let positions = "A value for each coordinate: a position, or the velocities `x'`.";
    // A scene needs them for its holonomic constraints only.
    if layout.is_whole || !selection.holonomic.is_empty() {
        add("Coordinates", positions, &coordinates);
    }
    add(
        "Momenta",
        "The momenta `dT/d eta_s`, and `(dT°/d eta_v)` for the constraints, (2.8), as far as the kinetic energy speaks of them.",
        &forms(&selection.momenta, "The momentum that goes with"),
    );
    let bound: Vec<usize> = if layout.is_whole {
        (layout.l..model.forms.len()).collect()
    } else {
        selection.holonomic.iter().map(|h| level.derivation.system.holonomic[*h].form).collect()
    };
    let mut reactions = forms(&selection.reactions, "The multiplier of");
    for (field, form) in reactions.iter_mut().zip(&selection.reactions) {
        let surplus = model.redundant.iter().filter(|redundant| redundant.beside.contains(form));
        let names: Vec<String> = surplus.map(|redundant| format!("`{}`", redundant.entry.name)).collect();
        if !names.is_empty() {
            let (docs, names) = (&field.docs, names.join(", "));
            let note = format!(
                "Not determined by itself, because {names} follows from this constraint and others: given for none of {names}."
            );
            field.docs = quote!(#docs #[doc = ""] #[doc = #note]);
        }
    }
    let mut residuals = forms(&bound, "What is left of");
    residuals.extend(selection.redundant.iter().map(|r| {
        let entry = &model.redundant[*r].entry;
        field(
            &form_ident(entry),
            entry.docs,
            format!("What is left of `{}`, which follows from others.", entry.name),
            None,
        )
    }));
    add(
        "Residuals",
        "What is left of each constraint: `eta_v` of a velocity constraint, `f(t, x)` of a holonomic one; zero where it holds.",
        &residuals,
    );
    add(
        "Reactions",
        "The reactions `lambda_v`: the generalised force of each constraint along its own form. As a covector on `x'` they are `R_i = sum_v lambda_v a_vi`.",
        &reactions,
    );
    let inputs = selection.inputs.iter().map(|u| &model.inputs[*u]);
    let inputs: Vec<Field> = inputs
        .map(|u| field(&u.name.ident, u.docs, format!("The input `{}`.", u.name), units.get(&u.name.text)))
        .collect();
    add("Inputs", "The control inputs, constant during a step.", &inputs);
    let size = layout.size;
    items.push(quote!(__guen::nalgebra_conversions!(State, #size);));
    if !selection.outputs.is_empty() {
        items.push(outputs(subject, layout));
    }
    quote!(#(#items)*)
}

/// The state of a carried form: the variables, then the functions.
pub(super) fn carried(subject: &Subject<'_, '_>, layout: &Layout) -> TokenStream {
    let Subject { model, level } = subject;
    let places = level.selection.variables.iter().map(|place| format!("`{}`.", model.variable_name(*place)));
    let functions = level.selection.carried.iter();
    let functions = functions.map(|f| {
        let value =
            model.bench.graph.text_limited(f.value, 400).unwrap_or_else(|| "a long expression".to_owned());
        format!("`{value}`, carried.")
    });
    let fields: Vec<Field> = places
        .chain(functions)
        .zip(&layout.state)
        .map(|(docs, ident)| Field { ident: ident.clone(), docs: quote!(#[doc = #docs]) })
        .collect();
    let size = layout.size;
    let state = record("State", "A state of the carried form: the variables, then the functions.", &fields);
    quote!(#state __guen::nalgebra_conversions!(State, #size);)
}

/// A record of reals with conversions from and to an array.
fn record(name: &str, docs: &str, fields: &[Field]) -> TokenStream {
    let record = format_ident!("{name}");
    let count = fields.len();
    // A name in a pattern would mean a constant or an operator of that name, if there is one.
    let fields = fields.iter().enumerate().map(|(i, Field { ident, docs })| {
        let local = format_ident!("__guen_{i}");
        quote!(#docs #ident #local,)
    });
    quote!(__guen::record! { #[doc = #docs] #record #count #(#fields)* })
}

/// Outputs: scalars are reals, vectors arrays of three.
fn outputs(subject: &Subject<'_, '_>, layout: &Layout) -> TokenStream {
    let outputs: Vec<_> =
        subject.level.selection.outputs.iter().map(|o| &subject.model.outputs[*o]).collect();
    let idents: Vec<&Ident> = outputs.iter().map(|o| &o.name.ident).collect();
    let docs = outputs.iter().map(|o| {
        documentation::entry(
            o.docs,
            &format!("The output `{}`.", o.name),
            subject.model.units.get(&o.name.text),
        )
    });
    let types = outputs.iter().map(|o| if o.components.len() == 1 { quote!(R) } else { quote!([R; 3]) });
    let mut count = 0_usize;
    let values: Vec<TokenStream> = outputs
        .iter()
        .map(|o| {
            let parts: Vec<TokenStream> = (0..o.components.len())
                .map(|i| {
                    let place = count + i;
                    quote!(values[#place])
                })
                .collect();
            count += parts.len();
            if parts.len() == 1 { quote!(#(#parts)*) } else { quote!([#(#parts),*]) }
        })
        .collect();
    let names = outputs.iter().flat_map(|o| match o.components.len() {
        1 => vec![o.name.text.clone()],
        _ => ["x", "y", "z"].map(|axis| format!("{}.{axis}", o.name.text)).to_vec(),
    });
    let of_output = |name: &String| name.split('.').next().unwrap_or_default().to_owned();
    let names: Vec<String> = names.collect();
    let units = units(subject.model, names.iter().map(of_output));
    let size = layout.size;
    let owner = if layout.inputs == 0 {
        quote!((self) => self, &[])
    } else {
        quote!((self) => self.system, &::core::convert::From::from(self.inputs))
    };
    let integrated = format_ident!("{}", if layout.inputs == 0 { "Prepared" } else { "Driven" });
    quote! {
        __guen::output_map!(#integrated #size #count [#(#names)*] [#(#units)*] #owner);

        /// The declared outputs.
        #[::core::prelude::v1::derive(
            ::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug, ::core::cmp::PartialEq,
            ::core::default::Default
        )]
        pub struct Outputs<R = f64> {
            #(#docs pub #idents: #types,)*
        }

        impl<R: ::core::marker::Copy> Outputs<R> {
            #[inline]
            fn from_values(values: &[R; #count]) -> Self {
                Outputs { #(#idents: #values),* }
            }
        }
    }
}
