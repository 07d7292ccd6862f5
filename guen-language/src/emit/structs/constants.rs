//! The struct of physical constants, `prepare`, and the prepared system.

use std::ops::Range;

use guen_symbolic::ExprId;
use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::{limits, physical};
use crate::derive::Subject;
use crate::emit::documentation;
use crate::emit::layouts::fields::{Entry, Fields, Tree, plain};
use crate::emit::layouts::layout::{Layout, variable_name};
use crate::emit::layouts::parts::{self, Modules};
use crate::emit::layouts::text::tokens;
use crate::emit::methods::{integrated, motion, with_scalar};
use crate::emit::programs::formula::default_text;
use crate::names::REAL;
use crate::report::ReportLines;
use crate::syntax::{BoundKind, Expression, Item, Name};

/// A field of the struct of constants.
struct Field {
    written: Name,
    /// The name without `r#`, with its index.
    name: String,
    docs: TokenStream,
    bound: Option<BoundKind>,
    default: Option<ExprId>,
    /// Whether the default is made of other constants.
    is_derived: bool,
}

/// The values of the constants of a struct, where those that are derived are computed.
pub(super) fn values(layout: &Layout, structure: &Fields, of: &TokenStream) -> TokenStream {
    match layout.derived.is_empty() {
        true => structure.list(&|_| false, &|Entry { access, .. }| quote!(#of.#access)),
        false => quote!(#of.__guen_values()),
    }
}

/// The constants that a scene does not fix, then the variables that it holds.
fn fields(subject: &Subject<'_, '_>, layout: &Layout) -> Vec<Field> {
    let Subject { model, level, .. } = subject;
    let constants = level.selection.constants.iter().map(|c| &model.constants[*c]).enumerate();
    let constants = constants.map(|(i, c)| {
        let is_derived = layout.derived.contains(&i);
        Field {
            written: c.name.clone(),
            name: c.name.text.clone(),
            docs: documentation::entry(
                c.docs,
                &format!("The constant `{}`.", c.name),
                model.units.get(&c.name.text),
            ),
            bound: c.bound,
            default: c.default.filter(|_| is_derived || !c.is_derived),
            is_derived,
        }
    });
    let held = level.selection.held.iter().map(|held| {
        let name = model.variable_name(held.place).to_owned();
        let text = format!("The value at which `{name}` stays.");
        let written = variable_name(model, held.place);
        Field { written, name, docs: quote!(#[doc = #text]), bound: None, default: None, is_derived: false }
    });
    constants.chain(held).collect()
}

pub(in crate::emit) fn items(
    subject: &Subject<'_, '_>,
    layout: &Layout,
    report: &ReportLines,
) -> TokenStream {
    let (system, declared) = (&layout.system, &layout.declared);
    let fields = fields(subject, layout);
    let real = format_ident!("{}", if system == declared { REAL } else { "Scalar" });
    let supplied = &layout.supplied;
    let structure = supplied.behind(fields.iter().map(|field| &field.written)).over(&real);
    let declared_fields: Vec<TokenStream> = structure
        .trees()
        .map(|(ident, tree)| {
            let mut places = Vec::new();
            tree.leaves(&mut places);
            let kind = tree.of_type(&kind(&structure, layout, &fields, tree, &quote!(#real)));
            if let Some(part) = tree.instance() {
                let docs = parts::docs_of_instance(&subject.model.declaration.instances, part);
                return quote!(#docs pub #ident: #kind,);
            }
            if let Some(function) = structure.function(places[0]) {
                let docs = supplied.docs(function);
                return quote!(#docs pub #ident: #kind,);
            }
            let (first, last) = (&fields[places[0]], &fields[places[places.len() - 1]]);
            let docs = &first.docs;
            let range = (places.len() > 1).then(|| {
                let range = format!("The entries `{}` to `{}`.", first.name, last.name);
                quote!(#[doc = ""] #[doc = #range])
            });
            quote!(#docs #range pub #ident: #kind,)
        })
        .collect();
    let compared = structure.trees().map(|(ident, _)| ident);
    let written = subject.scene().map_or(&subject.model.declaration.docs, |(scene, _)| &scene.docs);
    let (count, hoisted) = (layout.constants, layout.hoisted);
    let checks = checks(subject, &fields, &structure);
    let constructors = constructors(subject, layout, &fields, &structure);
    // A system without constants still has a type parameter to carry; its name is a value, as that of a unit struct.
    let marker = structure.has_marker().then(|| quote!(real: ::core::marker::PhantomData<#real>,));
    let marker_value = marker_of(&structure);
    let is_type_like = declared.to_string().starts_with(char::is_uppercase);
    let unit = (count == 0 && is_type_like && supplied.is_empty()).then(|| {
        let docs = format!("The system [`{declared}`](struct@{declared}): it has no constants.");
        quote! {
            #[doc = #docs]
            pub const #declared: #system = #system { #marker_value };
        }
    });
    let supplied_kinds = supplied.declared();
    let item = quote! {
        #[::core::prelude::v1::derive(::core::fmt::Debug)]
        pub struct #declared<#real = f64 #supplied_kinds> {
            #(#declared_fields)*
            #marker
        }
        __guen::copied!(#real #declared, #(#compared)*);
    };
    let item = documentation::reported(report, written, layout.is_whole, &item);
    let values = values(layout, &structure, &quote!(self));
    let resolution = resolution(subject, layout, &fields, &structure);
    let derived: Vec<&TokenStream> = layout.derived.iter().map(|i| structure.access(*i)).collect();
    let (follows, follows_field) = match derived.len() {
        0 => (None, None),
        count => (
            Some(quote!(follows: [#(__guen::Derived::follows(&self.#derived)),*],)),
            Some(quote!(, follows #count)),
        ),
    };
    let is_derived = |place: usize| layout.derived.contains(&place);
    let given = |Entry { place, index, .. }: &Entry| match layout
        .derived
        .iter()
        .position(|derived| derived == place)
    {
        None => quote!(self.constants[#index]),
        Some(k) => quote! {
            if self.follows[#k] { __guen::Derived::Follows } else { __guen::Derived::Set(self.constants[#index]) }
        },
    };
    let given = structure.literal_of(&is_derived, &given, supplied.prepared(&quote!(self.hoisted)));
    let functions = (!supplied.is_empty()).then(|| {
        let functions = supplied.tuple(&structure, &quote!(self));
        quote!(, functions #functions)
    });
    let hoisted = supplied.hoisted(hoisted);
    let definite = physical::definite(subject, layout);
    let pivots = motion::pivots(subject);
    let limits = limits::has_any(subject).then(|| quote!(prepared.check_limits()?;));
    let with_scalar = with_scalar::items(layout, &structure, marker_value.as_ref());
    let what = if layout.is_whole { "system" } else { "scene" };
    let through_modes = if integrated::has_modes(subject) {
        " Methods take it in a mode, `in_mode(mode)`: its own rates know no contacts and no resets, and a run by them ends before its first step."
    } else {
        ""
    };
    let prepared_docs = format!(
        "The {what} [`{declared}`] with its constants checked and everything that depends on them alone computed once. Immutable; it alone runs.{through_modes}"
    );
    quote! {
        #item
        #unit

        #constructors

        #resolution

        impl<R> __guen::Unprepared for #system<R> {}

        __guen::prepare!(
            self constants hoisted prepared; #system #count, #values #functions, { #checks } { #pivots } { #follows } { #limits } { #definite }
        );

        __guen::prepared!(#prepared_docs #count #hoisted #follows_field);

        impl<R: __guen::Real> Prepared<R> {
            /// The constants that the system was prepared from.
            pub fn constants(&self) -> #system<R> {
                #system { #given #marker_value }
            }
        }

        #with_scalar
    }
}

/// Adds the types of the constants of instances.
pub(super) fn parts(subject: &Subject<'_, '_>, layout: &Layout, modules: &mut Modules) {
    let model = subject.model;
    let names = model.constants.iter().map(|constant| constant.name);
    let whole = layout.supplied.behind(names);
    if layout.is_whole {
        return parts::add_constants(modules, &whole);
    }
    let fields = fields(subject, layout);
    let structure = layout.supplied.behind(fields.iter().map(|field| &field.written));
    let docs = |tree: &Tree| match tree.instance() {
        Some(part) => parts::docs_of_instance(&model.declaration.instances, part),
        None => tree.first().map_or_else(TokenStream::new, |first| match structure.function(first) {
            Some(function) => layout.supplied.docs(function).clone(),
            None => fields[first].docs.clone(),
        }),
    };
    let kinds = layout.supplied.kinds();
    let leaf = |place: usize| match structure.function(place) {
        Some(function) => {
            let kind = &kinds[function];
            quote!(#kind)
        }
        None if fields[place].is_derived => quote!(__guen::Derived<R>),
        None => quote!(R),
    };
    parts::add_constants_of_scene(modules, &structure, &whole, &docs, &leaf);
}

/// Returns the code that makes numbers of constants that follow others; nothing where there are none.
fn resolution(
    subject: &Subject<'_, '_>,
    layout: &Layout,
    fields: &[Field],
    structure: &Fields,
) -> Option<TokenStream> {
    if layout.derived.is_empty() {
        return None;
    }
    let system = &layout.system;
    let count = fields.len();
    let locals: Vec<Ident> = (0..count).map(|i| format_ident!("__guen_c{i}")).collect();
    // Formulas come last, each behind those that it reads.
    let plain = (0..count).filter(|i| !fields[*i].is_derived).map(|i| {
        let (local, name) = (&locals[i], structure.access(i));
        quote!(let #local: R = self.#name;)
    });
    let formulas = layout.derived.iter().map(|i| {
        let (local, name) = (&locals[*i], structure.access(*i));
        let formula = fields[*i].default.map(|e| tokens(&default_text(subject, e)));
        quote!(let #local: R = __guen::Derived::resolve(self.#name, || #formula);)
    });
    let resolved = fields.iter().enumerate().map(|(i, field)| {
        let value = quote!(values[#i]);
        if field.is_derived { quote!(__guen::Derived::Set(#value)) } else { value }
    });
    let functions = layout.supplied.taken(structure, &quote!(self));
    let resolved = structure.literal(&resolved.chain(functions).collect::<Vec<_>>());
    Some(quote! {
        impl<R: __guen::Real> #system<R> {
            /// Returns the constants with every derived one set to its present value.
            pub fn resolved(&self) -> Self {
                let values = self.__guen_values();
                #system { #resolved }
            }

            /// The constants as numbers, each out of those before it.
            fn __guen_values(&self) -> [R; #count] {
                #(#plain)*
                #(#formulas)*
                [#(#locals),*]
            }
        }
    })
}

/// Finite, and inside the bound, each constant.
fn checks(subject: &Subject<'_, '_>, fields: &[Field], structure: &Fields) -> TokenStream {
    let given = checks_of_bounds(fields, structure);
    // A constant that is fixed to a number was checked when it was declared; one that is made of others is checked here.
    let graph = &subject.model.bench.graph;
    let fixes = subject.scene().map_or(&[][..], |(_, facts)| &facts.fixes);
    let fixed: Vec<TokenStream> = fixes
        .iter()
        .filter(|(_, value)| graph.as_number(*value).is_none())
        .filter_map(|(c, value)| {
            let constant = &subject.model.constants[*c];
            let value = tokens(&default_text(subject, *value));
            constant.bound.map(|bound| check_bound(&constant.name.text, bound, &value))
        })
        .collect();
    let mut fixed = fixed;
    fixed.extend(limited(subject));
    let locals = (0..fields.len()).map(|i| format_ident!("__guen_c{i}"));
    let locals = (!fixed.is_empty()).then(|| {
        quote! {
            #[allow(unused_variables, reason = "the fixed constants need not use every other")]
            let [#(#locals),*] = constants;
        }
    });
    quote!(#given #locals #(#fixed)*)
}

/// Inside the limits, each constant that has some; restitutions that are made of constants from 0 to 1.
fn limited(subject: &Subject<'_, '_>) -> Vec<TokenStream> {
    let model = subject.model;
    let text = |e: ExprId| tokens(&default_text(subject, e));
    let within = |value: ExprId, [lower, upper]: [ExprId; 2], name: &str, words: &str| {
        let (value, lower, upper) = (text(value), text(lower), text(upper));
        quote!(__guen::check_within(#value, #lower, #upper, #name, #words)?;)
    };
    let limits = model.constants.iter().zip(written_limits(subject)).filter_map(|(constant, written)| {
        let words = format!("{} in {}..{}", constant.name, written?[0].source(), written?[1].source());
        Some(within(constant.symbol, constant.limits?, &constant.name.text, &words))
    });
    let mut found: Vec<TokenStream> = limits.collect();
    let graph = &model.bench.graph;
    let unit = [graph.zero(), graph.one()];
    for entry in model.contacts.iter().flat_map(|contacts| &contacts.entries) {
        if graph.as_number(entry.restitution).is_none() {
            let (name, words) =
                (graph.text(entry.restitution), format!("restitution of {} in 0..1", entry.name));
            found.push(within(entry.restitution, unit, &name, &words));
        }
    }
    found
}

/// The limits of the constants as they are written.
fn written_limits<'d>(subject: &Subject<'d, '_>) -> Vec<Option<&'d [Expression; 2]>> {
    let items = subject.model.declaration.items.iter();
    let sections = items.filter_map(|item| match item {
        Item::Constants(section) => Some(section),
        _ => None,
    });
    sections.flat_map(|section| &section.entries).map(|constant| constant.limits.as_deref()).collect()
}

fn check_bound(name: &str, bound: BoundKind, value: &TokenStream) -> TokenStream {
    let (words, _, check) = words(name, bound);
    quote!(__guen::#check(#value, #name, #words)?;)
}

/// The bounds of all constants; long arrays whose entries have one bound are checked entry by entry.
fn checks_of_bounds(fields: &[Field], structure: &Fields) -> TokenStream {
    let bound = |field: &Field| {
        let name = &field.name;
        let bound = match field.bound {
            None => quote!(None),
            Some(bound) => {
                let (words, kind, _) = words(name, bound);
                quote!(#kind(#words))
            }
        };
        quote!((#name, __guen::Bound::#bound))
    };
    let mut runs: Vec<Range<usize>> =
        structure.trees().filter_map(|(_, tree)| tree.long_run(&|_| false)).collect();
    runs.retain(|run| fields[run.clone()].iter().all(|field| field.bound == fields[run.start].bound));
    if runs.is_empty() {
        let bounds = fields.iter().map(bound);
        return quote!(__guen::check_constants(&constants, &[#(#bounds),*])?;);
    }
    runs.sort_by_key(|run| run.start);
    runs.push(fields.len()..fields.len());
    let mut code = TokenStream::new();
    let mut from = 0;
    for run in runs {
        if from < run.start {
            let (places, bounds) = (from..run.start, fields[from..run.start].iter().map(bound));
            code.extend(quote!(__guen::check_constants(&[#(constants[#places]),*], &[#(#bounds),*])?;));
        }
        from = run.end;
        let Some(last) = fields[run.clone()].last() else { continue };
        let (start, end, count) = (run.start, run.end, run.len());
        let (before, _) = last.name.split_at(last.name.rfind('[').map_or(0, |at| at + 1));
        let (after, kind) = match last.bound {
            None => ("]".to_owned(), quote!(|_| __guen::Bound::None)),
            Some(bound) => {
                let (after, kind, _) = words("]", bound);
                (after, quote!(__guen::Bound::#kind))
            }
        };
        let (length, longest) = (last.name.len(), last.name.len() - 1 + after.len());
        code.extend(quote! {{
            const NAMES: &__guen::EntryNames<#count, #length> = &__guen::EntryNames::new(#before, 0, "]");
            const WORDS: &__guen::EntryNames<#count, #longest> = &__guen::EntryNames::new(#before, 0, #after);
            __guen::check_entries(&constants[#start..#end], NAMES, WORDS, #kind)?;
        }});
    }
    code
}

/// A bound in words, its variant of `Bound`, and the function that checks it.
fn words(name: &str, bound: BoundKind) -> (String, TokenStream, TokenStream) {
    let (kind, check) = match bound {
        BoundKind::Positive => (quote!(Positive), quote!(check_positive)),
        BoundKind::Nonnegative => (quote!(Nonnegative), quote!(check_nonnegative)),
        BoundKind::Nonzero => (quote!(Nonzero), quote!(check_nonzero)),
    };
    (format!("{name} {}", bound.relation()), kind, check)
}

/// `new` with the constants that have no default, and `Default` if all have one.
fn constructors(
    subject: &Subject<'_, '_>,
    layout: &Layout,
    fields: &[Field],
    structure: &Fields,
) -> TokenStream {
    let system = &layout.system;
    // A parameter named like a constant of the module, an operator or `None` would be a pattern.
    let parameter = |ident: &Ident| match crate::names::is_pattern(&plain(ident)) {
        true => format_ident!("{ident}_", span = ident.span()),
        false => ident.clone(),
    };
    // An array is given as a whole if one of its entries has no default, and so is an instance with functions.
    let is_given = |place: &usize| fields.get(*place).is_none_or(|field| field.default.is_none());
    let defaults: Vec<TokenStream> = fields
        .iter()
        .map(|field| match field.default {
            None => TokenStream::new(),
            Some(_) if field.is_derived => quote!(__guen::Derived::Follows),
            Some(default) => tokens(&default_text(subject, default)),
        })
        .collect();
    // One number for all entries.
    let is_equal =
        |own: &[Field]| own.iter().all(|field| field.default == own[0].default && !field.is_derived);
    let (mut required, mut kinds) = (Vec::new(), Vec::new());
    let mut values = Vec::new();
    for (name, tree) in structure.trees() {
        let mut places = Vec::new();
        tree.leaves(&mut places);
        if !places.iter().any(is_given) {
            let value = match tree.long_run(&|_| false).filter(|run| is_equal(&fields[run.clone()])) {
                Some(run) => tree.filled(&defaults[run.start]),
                None => tree.literal(&|place| defaults[place].clone()),
            };
            values.push(quote!(#name: #value));
            continue;
        }
        let parameter = parameter(name);
        kinds.push(tree.of_type(&kind(structure, layout, fields, tree, &quote!(R))));
        // `a: a` would be a lint in the user's file.
        values.push(if *name == parameter { quote!(#name) } else { quote!(#name: #parameter) });
        required.push(parameter);
    }
    let marker = marker_of(structure);
    if !layout.supplied.is_empty() {
        let arguments: Vec<TokenStream> =
            required.iter().zip(&kinds).map(|(name, kind)| quote!(#name: #kind)).collect();
        let has_defaults = fields.iter().all(|field| field.default.is_some());
        let default = has_defaults.then(|| {
            let functions = layout.supplied.names().map(|_| quote!(::core::default::Default::default()));
            let all: Vec<TokenStream> = defaults.iter().cloned().chain(functions).collect();
            let all = structure.literal(&all);
            quote!(#all #marker)
        });
        return with_functions(layout, (&required, &arguments), &quote!(#(#values,)* #marker), default);
    }
    let docs = if required.is_empty() {
        "The system with its default constants.".to_owned()
    } else {
        let list: Vec<String> = required.iter().map(|name| format!("`{name}`")).collect();
        format!("The system with {}, and the defaults of all other constants.", list.join(", "))
    };
    if required.is_empty() {
        // For one real, so that a call without arguments has a type.
        return quote! {
            impl #system<::core::primitive::f64> {
                #[doc = #docs]
                pub fn new() -> Self {
                    Self::with_defaults()
                }

                /// [`new`](Self::new) over another real: `with_defaults::<f32>()`.
                pub fn with_defaults<R: __guen::Real>() -> #system<R> {
                    #system { #(#values,)* #marker }
                }
            }

            impl ::core::default::Default for #system<::core::primitive::f64> {
                fn default() -> Self {
                    Self::new()
                }
            }
        };
    }
    quote! {
        impl<R: __guen::Real> #system<R> {
            #[doc = #docs]
            #[allow(clippy::too_many_arguments, reason = "one for each constant without a default")]
            pub fn new(#(#required: #kinds),*) -> Self {
                #system { #(#values,)* #marker }
            }
        }
    }
}

/// `new` with the constants that have no default and the functions that the program supplies, and `Default` if all constants have one:
/// the arguments with their names, and the fields of the literals.
fn with_functions(
    layout: &Layout,
    (names, arguments): (&[Ident], &[TokenStream]),
    made: &TokenStream,
    default: Option<TokenStream>,
) -> TokenStream {
    let (system, supplied) = (&layout.system, &layout.supplied);
    let names: Vec<String> = names.iter().map(|name| format!("`{}`", plain(name))).collect();
    let docs = format!("The system with {}, and the defaults of all other constants.", names.join(", "));
    let default = default.map(|made| {
        let default = quote!(::core::default::Default);
        let (bounded, kinds) = (supplied.bounded(&default), supplied.arguments());
        let real = quote!(::core::primitive::f64);
        // The bound is one of this implementation alone: a path keeps the name from those that get the parameters of all others.
        quote! {
            impl<#bounded> #default for self::#system<#real #kinds> {
                fn default() -> Self {
                    #[allow(dead_code, reason = "defaults may be no numbers")]
                    type R = #real;
                    #[allow(unused_imports, reason = "defaults may be no quotients")]
                    use __guen::Real as _;
                    #system { #made }
                }
            }
        }
    });
    quote! {
        impl<R: __guen::Real> #system<R> {
            #[doc = #docs]
            #[allow(clippy::too_many_arguments, reason = "one for each constant without a default, and one for each function")]
            pub fn new(#(#arguments),*) -> Self {
                #system { #made }
            }
        }
        #default
    }
}

/// The type of the values of a field.
fn kind(
    structure: &Fields,
    layout: &Layout,
    fields: &[Field],
    tree: &Tree,
    real: &TokenStream,
) -> TokenStream {
    let Some(place) = tree.first() else { return real.clone() };
    match structure.function(place) {
        Some(function) => {
            let kind = &layout.supplied.kinds()[function];
            quote!(#kind)
        }
        None if fields[place].is_derived => quote!(__guen::Derived<#real>),
        None => real.clone(),
    }
}

/// The value of the field that names the type of reals, of a struct without constants.
pub(super) fn marker_of(structure: &Fields) -> Option<TokenStream> {
    structure.has_marker().then(|| quote!(real: ::core::marker::PhantomData,))
}
