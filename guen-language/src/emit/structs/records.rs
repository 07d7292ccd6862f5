//! Structs with a named field for everything: state, positions, inputs, momenta, reactions, residuals, outputs.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use crate::derive::Subject;
use crate::emit::contact_modes::modes;
use crate::emit::documentation;
use crate::emit::layouts::fields::{Entry, Fields, Tree};
use crate::emit::layouts::layout::{Layout, carried_field, variable_name};
use crate::emit::layouts::parts::{self, Modules};
use crate::emit::methods::integrated::units;
use crate::model::{FormEntry, FormKind, OutputEntry, momentum, reaction, residual};
use crate::syntax::{Docs, Instance, Name};

/// A value of a record.
#[derive(Clone)]
struct Field {
    name: Name,
    docs: TokenStream,
}

pub(in crate::emit) fn items(subject: &Subject<'_, '_>, layout: &Layout) -> TokenStream {
    let Subject { model, level, .. } = subject;
    let selection = &level.selection;
    let units = &model.units;
    let field = |name: &Name, docs: &Docs, fallback: String, unit: Option<&String>| Field {
        name: name.clone(),
        docs: documentation::entry(docs, &fallback, unit),
    };
    let coordinates = selection.coordinates.iter().map(|i| &model.coordinates[*i]);
    let coordinates: Vec<Field> = coordinates
        .map(|c| field(c.name, c.docs, format!("The coordinate `{}`.", c.name), units.get(&c.name.text)))
        .collect();
    let forms = |indices: &[usize], what: &str, unit_of: fn(&FormEntry<'_>) -> String| -> Vec<Field> {
        let forms = indices.iter().map(|j| &model.forms[*j]);
        let described = forms.map(|form| {
            let fallback = format!("{what} `{}`.", form.name);
            field(&form.own_name(), form.docs, fallback, units.get(&unit_of(form)))
        });
        described.collect()
    };
    let parameters = selection.parameters.iter().map(|j| &model.forms[*j]);
    let parameters: Vec<Field> = parameters
        .map(|form| {
            let fallback = format!("The quasi-velocity `{}`.", form.name);
            field(&form.own_name(), form.docs, fallback, units.get(&form.name))
        })
        .collect();
    let whose = if layout.is_whole { "the system" } else { "the scene" };
    let count = |count: usize, noun: &str| format!("{count} {noun}{}", if count == 1 { "" } else { "s" });
    let (kept, speeds) =
        (count(layout.n, "coordinate"), count(layout.l, "quasi-velocity").replace("ys", "ies"));
    let states = selection.states.iter().map(|k| &model.states[*k]);
    let states: Vec<Field> = states
        .map(|z| {
            let fallback = format!("The state `{}`.", z.name);
            field(z.name, z.docs, fallback, units.get(&z.name.text))
        })
        .collect();
    let further = match states.len() {
        0 => String::new(),
        _ => format!(", then {}", count(states.len(), "state").replace("states", "states beside the motion")),
    };
    let state_docs =
        format!("A state of {whose}: {kept}, then {speeds}{further}, in the order of the declaration.");
    let mut items = Vec::new();
    let mut modules = Modules::default();
    super::constants::parts(subject, layout, &mut modules);
    let instances = &model.declaration.instances;
    let mut add = |name: &'static str, docs: &str, fields: &[Field]| {
        if !fields.is_empty() {
            items.push(record(name, docs, fields, instances, &mut modules));
        }
    };
    let state = [coordinates.clone(), parameters, states].concat();
    add("State", &state_docs, &state);
    let positions = "A value for each coordinate: a position, or the velocities `x'`.";
    // A scene needs them for its holonomic constraints only.
    if layout.is_whole || !selection.holonomic.is_empty() {
        add("Coordinates", positions, &coordinates);
    }
    add(
        "Momenta",
        "The momenta `dT/d eta_s`, and `(dT°/d eta_v)` for the constraints, (2.8), as far as the kinetic energy speaks of them.",
        &forms(&selection.momenta, "The momentum that goes with", |form| momentum(&form.name)),
    );
    let bound: Vec<usize> = if layout.is_whole {
        (layout.l..model.forms.len()).collect()
    } else {
        selection.holonomic.iter().map(|h| level.derivation.system.holonomic[*h].form).collect()
    };
    let mut reactions = forms(&selection.reactions, "The multiplier of", |form| reaction(&form.name));
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
    let mut residuals = forms(&bound, "What is left of", |form| match form.kind {
        FormKind::Holonomic => residual(&form.name),
        _ => form.name.clone(),
    });
    residuals.extend(selection.redundant.iter().map(|r| {
        let entry = &model.redundant[*r].entry;
        field(
            &entry.own_name(),
            entry.docs,
            format!("What is left of `{}`, which follows from others.", entry.name),
            units.get(&residual(&entry.name)),
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
        .map(|u| field(u.name, u.docs, format!("The input `{}`.", u.name), units.get(&u.name.text)))
        .collect();
    add("Inputs", "The control inputs, constant during a step.", &inputs);
    let size = layout.size;
    items.push(quote!(__guen::nalgebra_conversions!(State, #size);));
    if !selection.outputs.is_empty() {
        items.push(outputs(subject, layout, &mut modules));
    }
    modes::add(&mut modules, subject);
    let modules = modules.tokens();
    quote!(#(#items)* #modules)
}

/// The state of a carried form: the variables, then the functions.
pub(in crate::emit) fn carried(subject: &Subject<'_, '_>, layout: &Layout) -> TokenStream {
    let Subject { model, level, .. } = subject;
    let places = level.selection.variables.iter().map(|place| format!("`{}`.", model.variable_name(*place)));
    let functions = level.selection.carried.iter();
    let functions = functions.map(|f| {
        let value =
            model.bench.graph.text_limited(f.value, 400).unwrap_or_else(|| "a long expression".to_owned());
        format!("`{value}`, carried.")
    });
    let fields: Vec<Field> = places
        .chain(functions)
        .zip(names(subject))
        .map(|(docs, name)| Field { name, docs: quote!(#[doc = #docs]) })
        .collect();
    let size = layout.size;
    let mut modules = Modules::default();
    let docs = "A state of the carried form: the variables, then the functions.";
    let state = record("State", docs, &fields, &model.declaration.instances, &mut modules);
    let modules = modules.tokens();
    quote!(#state #modules __guen::nalgebra_conversions!(State, #size);)
}

/// The names of the states of a carried form.
fn names(subject: &Subject<'_, '_>) -> Vec<Name> {
    let Subject { model, level, .. } = subject;
    let variables = level.selection.variables.iter().map(|place| variable_name(model, *place));
    variables.chain(level.selection.carried.iter().map(|f| carried_field(model, f))).collect()
}

/// A record of reals with conversions from and to an array.
fn record(
    name: &'static str,
    docs: &str,
    fields: &[Field],
    instances: &[Instance],
    modules: &mut Modules,
) -> TokenStream {
    let record = format_ident!("{name}");
    let count = fields.len();
    let structure = Fields::new(fields.iter().map(|field| &field.name)).of_record(name);
    if !structure.is_plain() {
        let docs_of = |tree: &Tree| docs_of(tree, fields, instances);
        parts::add(modules, name, &structure, &docs_of, &|_| quote!(R), true);
        return structured(&record, docs, fields, &structure, instances);
    }
    let raw = structure.idents().any(|ident| ident.to_string().starts_with("r#")).then(|| quote!([raw]));
    // A name in a pattern would mean a constant or an operator of that name, if there is one.
    let fields = fields.iter().zip(structure.idents()).enumerate().map(|(i, (Field { docs, .. }, ident))| {
        let local = format_ident!("__guen_{i}");
        quote!(#docs #ident #local,)
    });
    quote!(__guen::record! { #[doc = #docs] #record #count #raw #(#fields)* })
}

/// A record with arrays.
fn structured(
    record: &Ident,
    docs: &str,
    values: &[Field],
    structure: &Fields,
    instances: &[Instance],
) -> TokenStream {
    let count = structure.len();
    let fields = structure.trees().map(|(ident, tree)| {
        let (docs, kind) = (docs_of(tree, values, instances), tree.of_type(&quote!(R)));
        quote!(#docs pub #ident: #kind,)
    });
    let (names, idents) = (structure.names_of_values(), structure.idents());
    let array = structure.list(&|_| false, &|Entry { access, .. }| quote!(self.#access));
    let literal = structure.literal_of(&|_| false, &|Entry { index, .. }| quote!(values[#index]), []);
    let default = quote!(::core::default::Default::default());
    let defaults = structure.trees().map(|(ident, tree)| {
        let value = tree.filled(&default);
        quote!(#ident: #value,)
    });
    quote! {
        __guen::structured! {
            #[doc = #docs] #record #count { #(#fields)* } [#names] [#(#idents)*]
            |self, values| (#array) { #literal } { #(#defaults)* }
        }
    }
}

/// The documentation of a field: that of its first value, and of an array the names of its entries.
fn docs_of(tree: &Tree, values: &[Field], instances: &[Instance]) -> TokenStream {
    if let Some(part) = tree.instance() {
        return parts::docs_of_instance(instances, part);
    }
    let mut places = Vec::new();
    tree.leaves(&mut places);
    let (Some(first), Some(last)) = (places.first(), places.last()) else { return TokenStream::new() };
    let docs = &values[*first].docs;
    if first == last {
        return docs.clone();
    }
    let range = format!("The entries `{}` to `{}`.", values[*first].name, values[*last].name);
    quote!(#docs #[doc = ""] #[doc = #range])
}

/// Outputs: scalars are reals, vectors arrays of three.
fn outputs(subject: &Subject<'_, '_>, layout: &Layout, modules: &mut Modules) -> TokenStream {
    let instances = &subject.model.declaration.instances;
    let outputs: Vec<_> =
        subject.level.selection.outputs.iter().map(|o| &subject.model.outputs[*o]).collect();
    let structure = Fields::new(outputs.iter().map(|o| o.name)).of_record("Outputs");
    let entries: Vec<Field> = outputs
        .iter()
        .map(|o| Field {
            name: o.name.clone(),
            docs: documentation::entry(
                o.docs,
                &format!("The output `{}`.", o.name),
                subject.model.units.get(&o.name.text),
            ),
        })
        .collect();
    let of_output = |o: &OutputEntry<'_>| if o.components.len() == 1 { quote!(R) } else { quote!([R; 3]) };
    let fields: Vec<TokenStream> = structure
        .trees()
        .map(|(ident, tree)| {
            let docs = docs_of(tree, &entries, instances);
            let kind =
                tree.of_type(&tree.first().map_or_else(|| quote!(R), |first| of_output(outputs[first])));
            quote!(#docs pub #ident: #kind,)
        })
        .collect();
    let docs = |tree: &Tree| docs_of(tree, &entries, instances);
    parts::add(modules, "Outputs", &structure, &docs, &|place| of_output(outputs[place]), true);
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
    let without_axis = |name: &String| match name.rsplit_once('.') {
        Some((output, "x" | "y" | "z")) => output.to_owned(),
        _ => name.clone(),
    };
    let names: Vec<String> = names.collect();
    let units = units(subject.model, names.iter().map(without_axis));
    let size = layout.size;
    let owner = if layout.inputs == 0 {
        quote!((self) => self, &[])
    } else {
        quote!((self) => self.system, &::core::convert::From::from(self.inputs))
    };
    let integrated = format_ident!("{}", if layout.inputs == 0 { "Prepared" } else { "Driven" });
    let literal = structure.literal(&values);
    let is_short = structure.is_flat();
    let derived = is_short.then(|| quote!(, ::core::default::Default));
    let default = (!is_short).then(|| {
        let values = structure.trees().map(|(ident, tree)| {
            let value = tree.filled(&quote!(::core::default::Default::default()));
            quote!(#ident: #value,)
        });
        quote! {
            impl<R: ::core::default::Default> ::core::default::Default for Outputs<R> {
                fn default() -> Self {
                    Outputs { #(#values)* }
                }
            }
        }
    });
    quote! {
        __guen::output_map!(#integrated #size #count [#(#names)*] [#(#units)*] #owner);

        /// The declared outputs.
        #[::core::prelude::v1::derive(
            ::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug, ::core::cmp::PartialEq #derived
        )]
        pub struct Outputs<R = f64> {
            #(#fields)*
        }

        #default

        impl<R: ::core::marker::Copy> Outputs<R> {
            #[inline]
            fn from_values(values: &[R; #count]) -> Self {
                Outputs { #literal }
            }
        }
    }
}
