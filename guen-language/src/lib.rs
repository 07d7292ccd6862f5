//! The language of guen: from the tokens of a declaration to Rust items.
//!
//! An ordinary library on `proc_macro2`, so that tests, benchmarks and other front ends can call every stage
//! without a compiler around it. The stages, each with types of its own:
//!
//! tokens -[`parse`]-> [`syntax`] -[`unfold`]-> [`syntax`] without loops -[`model`]-> checked model -[`mod@derive`]-> derivation and programs -[`emit`]-> Rust items
//!
//! Every stage reports what is wrong through [`diagnostics`]; [`report`] writes down what was derived. For a declaration
//! with faults the stages run once more on the sound one that [`outline`] puts in its place.
#![cfg_attr(docsrs, feature(doc_cfg))]
#![forbid(unsafe_code)]

extern crate proc_macro;

mod components;
mod damage;
pub mod derive;
pub mod diagnostics;
pub mod emit;
pub mod limits;
pub mod model;
pub mod names;
pub mod outline;
pub mod parse;
pub mod report;
pub mod syntax;
pub mod unfold;

use proc_macro2::{Literal, TokenStream};
use quote::ToTokens;
use syn::parse::{ParseStream, Parser};

use diagnostics::collect;

/// Expands one invocation of `mechanical_system!`: the items of the system, or compile errors at the places of the
/// mistakes together with an outline of the items.
///
/// The same tokens give the same tokens: nothing depends on hashing, counters or time.
///
/// ```
/// let tokens = "pub system Pendulum {
///     constants { l > 0, g = 9.81 }
///     coordinates { phi }
///     parameters { omega = dot(phi); }
///     kinetic_energy = 1/2*l^2*omega^2;
///     potential_energy = -g*l*cos(phi);
/// }";
/// let items = guen_language::expand(tokens.parse().unwrap());
/// assert!(items.to_string().contains("struct Pendulum"));
/// ```
pub fn expand(tokens: TokenStream) -> TokenStream {
    let (declaration, report) = parse::written(tokens.clone());
    let Some(declaration) = declaration else {
        return report.to_compile_errors();
    };
    let paths = components::imports(&declaration.items, &tokens, &report);
    if !paths.is_empty() {
        let mut items = without_imports(&declaration, &report).to_compile_errors();
        let back = "mechanical_system_with";
        items.extend(components::gather(declaration.crate_path.as_ref(), back, &paths, tokens));
        return items;
    }
    finish(&tokens, declaration, report, None)
}

/// Returns the faults that do not depend on imported components: those of the grammar or, if there are none, names that nothing declares.
/// They are told before the components are looked for, because the compiler stops at a component that it does not find.
fn without_imports(
    declaration: &syntax::Declaration,
    report: &diagnostics::FaultReport,
) -> diagnostics::FaultReport {
    if !report.is_empty() {
        return report.clone();
    }
    collect(|faults| unfold::unknown_names::report(unfold::unknown_names::unknown_names(declaration), faults))
        .1
}

/// Expands one invocation of `mechanical_system!` to which the components that it uses have been added.
pub fn expand_with(tokens: TokenStream) -> TokenStream {
    let components::Gathered { tokens, bundles } = components::split(tokens);
    let (declaration, report) = parse::written(tokens.clone());
    let Some(mut declaration) = declaration else {
        return report.to_compile_errors();
    };
    let paths = components::imports(&declaration.items, &tokens, &report);
    declaration.imported = components::imported(&paths, &bundles);
    let told = without_imports(&declaration, &report);
    if declaration.imported.iter().any(|imported| imported.is_faulty) {
        // The faults are reported where the components are declared.
        let (declaration, _) = parse::unfolded(&tokens, declaration, report);
        return expand_outline(&declaration);
    }
    finish(&tokens, declaration, report, Some(&told))
}

/// Expands one invocation of `mechanical_component!`: the struct of its constants, and the macro that brings its tokens to the
/// systems that use it.
pub fn expand_component(tokens: TokenStream) -> TokenStream {
    components::expand(tokens)
}

/// Expands one invocation of `mechanical_component!` to which the components that it uses have been added.
pub fn expand_component_with(tokens: TokenStream) -> TokenStream {
    components::expand_with(tokens)
}

/// The most names of a declaration that is looked at again after a fault of its grammar or its loops. A chain of 160 links takes half
/// of the time that it takes without a fault.
const MOST_NAMES: usize = 1_500;

/// The most operations of such a declaration.
const MOST_OPERATIONS: usize = 30_000;

/// Adds to the faults that the parser found what else is wrong in a declaration, as far as it can be told beside them.
///
/// ```
/// let tokens = "system Pendulum {
///     constants { l > 0, g = 9.81 }
///     coordinates { phi }
///     parameters { omega == dot(phi); }
///     kinetic_energy = 1/2*l^2*omega^2;
///     potential_energy = -g*h*cos(phi);
/// }";
/// let tokens = tokens.parse().unwrap();
/// let (declaration, report) = guen_language::parse::parse(proc_macro2::TokenStream::clone(&tokens));
/// assert_eq!(report.faults().len(), 1);
/// let report = guen_language::with_further_faults(&tokens, &declaration.unwrap(), report);
/// assert!(report.faults()[1].message().starts_with("unknown name `h`"));
/// ```
pub fn with_further_faults(
    tokens: &TokenStream,
    declaration: &syntax::Declaration,
    report: diagnostics::FaultReport,
) -> diagnostics::FaultReport {
    let damaged = damage::Damaged::new(tokens, &declaration.items, report.faults());
    let is_coordinates = |item: &syntax::Item| matches!(item, syntax::Item::Coordinates(_));
    let names: usize = declaration.items.iter().map(|item| item.declared().len()).sum();
    let mut waiting: Vec<&syntax::Expression> =
        declaration.items.iter().flat_map(|item| item.expressions()).collect();
    let mut size = 0;
    while let Some(e) = waiting.pop().filter(|_| size <= MOST_OPERATIONS) {
        size += 1;
        waiting.extend(e.children());
    }
    if names > MOST_NAMES || size > MOST_OPERATIONS || !declaration.items.iter().any(is_coordinates) {
        return collect(|faults| {
            faults.absorb(report);
            model::check_dimensions(declaration, faults);
        })
        .1;
    }
    let ((), report) = collect(|faults| {
        faults.absorb(report);
        let before = faults.count();
        if let Some(model) = model::resolved(declaration, damaged.damage, faults) {
            derive::derive(model, faults);
        }
        faults.keep_since(before, |fault| !damaged.explains(fault));
    });
    report
}

fn finish(
    tokens: &TokenStream,
    declaration: syntax::Declaration,
    report: diagnostics::FaultReport,
    told: Option<&diagnostics::FaultReport>,
) -> TokenStream {
    let with_outline = |declaration: &syntax::Declaration, report: diagnostics::FaultReport| {
        let further = told.map(|told| report.beside(told)).unwrap_or(report);
        let mut items = further.to_compile_errors();
        items.extend(expand_outline(declaration));
        items
    };
    let (declaration, report) = parse::unfolded(tokens, declaration, report);
    if !report.is_empty() {
        let report = with_further_faults(tokens, &declaration, report);
        return with_outline(&declaration, report);
    }
    let (derived, report) = collect(|faults| {
        let model = model::resolve(&declaration, faults)?;
        derive::derive(model, faults)
    });
    match derived {
        Some(derived) if report.is_empty() => emit::emit(derived),
        _ => with_outline(&declaration, report),
    }
}

/// Expands one invocation of `page!`, which expansions of [`expand`] have in their documentation for rustdoc: the literals of a
/// report, its summary and for each section the title, lines and formulas in LaTeX, become one literal with formulas in MathML.
pub fn expand_page(tokens: TokenStream) -> TokenStream {
    match report_of.parse2(tokens) {
        Ok((summary, sections)) => {
            let sections = sections.iter();
            let sections = sections.map(|(title, lines, formulas)| (&title[..], &lines[..], &formulas[..]));
            Literal::string(&report::set(&report::page(&summary, sections))).into_token_stream()
        }
        Err(error) => error.to_compile_error(),
    }
}

/// A summary and sections: title, lines and formulas.
type Page = (String, Vec<(String, Vec<String>, Vec<String>)>);

fn report_of(input: ParseStream<'_>) -> syn::Result<Page> {
    let text = |input: ParseStream<'_>| syn::Result::Ok(input.parse::<syn::LitStr>()?.value());
    let list = |input: ParseStream<'_>| {
        let inside;
        syn::bracketed!(inside in input);
        let mut lines = Vec::new();
        while !inside.is_empty() {
            lines.push(text(&inside)?);
        }
        syn::Result::Ok(lines)
    };
    let (summary, mut sections) = (text(input)?, Vec::new());
    while !input.is_empty() {
        sections.push((text(input)?, list(input)?, list(input)?));
    }
    Ok((summary, sections))
}

/// Expands a faulty declaration to the items that it would have, with the signatures of the real ones; nothing if its name
/// is among the faults.
pub fn expand_outline(declaration: &syntax::Declaration) -> TokenStream {
    let sound = outline::sound(declaration);
    let (derived, report) = collect(|faults| {
        let model = model::resolve(&sound, faults)?;
        derive::derive(model, faults)
    });
    derived.filter(|_| report.is_empty()).map(emit::outline).unwrap_or_default()
}
