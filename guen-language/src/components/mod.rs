//! Components on their way from where they are declared to the systems that use them.
//!
//! A procedural macro sees the tokens of its own invocation only. Therefore `mechanical_component!` makes, under the name
//! of the component, a macro that holds its tokens. A system with `use wheels::Wheel as left` expands to a call of
//! `wheels::Wheel!`, which adds its tokens and calls the next component, and the last one calls the macro of the system again:
//! paths, imports and visibility are those of Rust. A component that uses others holds their tokens too, because their paths
//! mean something where it is declared and nowhere else.

mod carried;
mod gather;

use proc_macro2::{Delimiter, Group, TokenStream, TokenTree};

use crate::damage::Damaged;
use crate::diagnostics::{Fault, FaultReport, Faults, collect};
use crate::emit;
use crate::model;
use crate::parse;
use crate::syntax::{Component, ComponentPath, Declaration, Imported, Item, undeclared_components};
use crate::unfold;

pub(crate) use gather::{Gathered, gather, imported, split};

/// Expands one invocation of `mechanical_component!`.
pub(crate) fn expand(tokens: TokenStream) -> TokenStream {
    let (component, report) = parse::parse_component(tokens.clone());
    let Some(component) = component else {
        return report.to_compile_errors();
    };
    let paths = imports_of(&component, &tokens, &report);
    if !paths.is_empty() {
        // Told now, because the compiler stops at a component that it does not find.
        let mut items = report.to_compile_errors();
        items.extend(gather(component.crate_path.as_ref(), "mechanical_component_with", &paths, tokens));
        return items;
    }
    finish(tokens, component, Vec::new(), report, None)
}

/// Expands a component to which those that it uses have been added.
pub(crate) fn expand_with(tokens: TokenStream) -> TokenStream {
    let Gathered { tokens, bundles } = split(tokens);
    let (component, report) = parse::parse_component(tokens.clone());
    match component {
        None => report.to_compile_errors(),
        Some(component) => {
            let told = report.clone();
            finish(tokens, component, bundles, report, Some(&told))
        }
    }
}

fn finish(
    tokens: TokenStream,
    mut component: Component,
    bundles: Vec<Group>,
    report: FaultReport,
    told: Option<&FaultReport>,
) -> TokenStream {
    let paths = imports_of(&component, &tokens, &report);
    component.imported = imported(&paths, &bundles);
    let damaged = Damaged::new(&tokens, &component.items, report.faults());
    let (constants, further) = collect(|faults| {
        faults.absorb(report);
        let before = faults.count();
        uses_itself(&component, faults);
        unfold::check_names(&component, faults);
        faults.keep_since(before, |fault| !damaged.explains(fault));
        // Faults of names are found again when loops are written out and when constants get values; each is kept once.
        let before = faults.count();
        let constants = unfold::constants(&component, faults);
        let constants = Declaration { tokens: tokens.clone(), ..constants };
        faults.keep_since(before, |fault| !damaged.explains(fault));
        // Defaults and bounds mean something without a system.
        let before = faults.count();
        let _ = model::resolved(&constants, damaged.damage, faults);
        faults.keep_since(before, |fault| !damaged.explains(fault));
        constants
    });
    let mut items = told.map_or_else(|| further.clone(), |told| further.beside(told)).to_compile_errors();
    items.extend(carried::items(&component, tokens, &bundles, !further.is_empty()));
    let facade = component.crate_path.clone().unwrap_or_else(|| quote::quote!(::guen));
    items.extend(structure(&component, &constants, &facade));
    items
}

/// The paths of the components that items use and that other invocations declare, each once, in the order of the uses.
pub(crate) fn imports<'i>(
    items: &'i [Item],
    tokens: &TokenStream,
    report: &FaultReport,
) -> Vec<&'i ComponentPath> {
    let damaged = Damaged::new(tokens, items, report.faults());
    undeclared_components(items).into_iter().filter(|path| !damaged.may_declare(path)).collect()
}

/// The paths that the items of a component import.
fn imports_of<'c>(
    component: &'c Component,
    tokens: &TokenStream,
    report: &FaultReport,
) -> Vec<&'c ComponentPath> {
    let paths = imports(&component.items, tokens, report);
    paths.into_iter().filter(|path| path.text != component.name.text).collect()
}

/// The struct of the constants; nothing where these have faults.
fn structure(component: &Component, constants: &Declaration, facade: &TokenStream) -> TokenStream {
    let (model, _) = collect(|faults| model::resolve(constants, faults));
    model.map_or_else(TokenStream::new, |model| emit::component(component, &model, facade))
}

/// A component that stands in itself has no end.
fn uses_itself(component: &Component, faults: &mut Faults) {
    for item in &component.items {
        let Item::Use(instance) = item else { continue };
        if instance.path.text == component.name.text {
            let fault = Fault::new(instance.path.name.span(), format!("`{}` uses itself", component.name));
            faults.report(fault.help("a component may use others, each of which ends somewhere"));
        }
    }
}

/// The tokens of a bundle: the component, and those that it uses.
fn bundle(tokens: TokenStream, inner: &[Group], is_faulty: bool) -> TokenStream {
    let faulty =
        is_faulty.then(|| TokenTree::from(proc_macro2::Ident::new("faulty", proc_macro2::Span::call_site())));
    let own = TokenTree::from(Group::new(Delimiter::Brace, tokens));
    faulty.into_iter().chain([own]).chain(inner.iter().cloned().map(TokenTree::from)).collect()
}

/// Reads a bundle.
fn unbundle(group: &Group) -> Option<(Component, bool)> {
    let mut tokens = group.stream().into_iter().peekable();
    let is_faulty = matches!(tokens.peek(), Some(TokenTree::Ident(_)));
    let mut groups = tokens.filter_map(|token| match token {
        TokenTree::Group(group) => Some(group),
        _ => None,
    });
    let own = groups.next()?;
    let (component, report) = parse::parse_component(own.stream());
    let mut component = component?;
    let inner: Vec<Group> = groups.collect();
    let paths = imports_of(&component, &own.stream(), &report);
    let found: Vec<Imported> = imported(&paths, &inner);
    component.imported = found;
    Some((component, is_faulty))
}
