//! The places of the declared bodies and particles, for pictures of a motion.

use std::collections::BTreeMap;
use std::ops::Range;

use guen_symbolic::{ExprId, SymbolId};
use proc_macro2::{TokenStream, TokenTree};
use quote::{format_ident, quote};

use crate::derive::Subject;
use crate::emit::layouts::fields::by_number;
use crate::emit::layouts::layout::Layout;
use crate::emit::layouts::text::tokens;
use crate::emit::programs::formula::default_text;
use crate::emit::thresholds::LONG_ARRAY;

pub(in crate::emit) fn items(subject: &Subject<'_, '_>, layout: &Layout) -> TokenStream {
    let Subject { model, .. } = subject;
    let count = model.bodies.len() + model.particles.len();
    // The state of a scene need not tell where its bodies are.
    if count == 0 || !layout.is_whole {
        return TokenStream::new();
    }
    let mut values = 0_usize;
    let mut next = |number: usize| {
        let first = values;
        values += number;
        (first..values).map(|i| quote!(values[#i])).collect::<Vec<_>>()
    };
    let bodies = model.bodies.iter().map(|body| {
        let center = option(body.center.map(|_| {
            let center = next(3);
            quote!([#(#center),*])
        }));
        let orientation = option(body.orientation.map(|_| {
            let rows = [next(3), next(3), next(3)].map(|row| quote!([#(#row),*]));
            quote!([#(#rows),*])
        }));
        let mass = option(body.mass.and_then(|mass| constant(subject, mass)));
        let inertia = body.inertia.and_then(|entries| {
            let entries = entries.map(|entry| constant(subject, entry));
            entries.iter().all(Option::is_some).then(|| quote!([#(#entries),*]))
        });
        let (name, inertia) = (&body.name, option(inertia));
        quote! {
            __guen::Body { name: #name, mass: #mass, inertia: #inertia, center: #center, orientation: #orientation }
        }
    });
    let bodies: Vec<TokenStream> = bodies.collect();
    let first_value = values;
    values += 3 * model.particles.len();
    let families = families(subject);
    let is_long = families.iter().any(|family| family.places.len() >= LONG_ARRAY);
    let mut names = TokenStream::new();
    let particles = families.iter().flat_map(|Family { places, masses }| {
        let from = bodies.len() + places.start;
        if places.len() < LONG_ARRAY {
            let alone = places.clone().map(|i| {
                let (place, value) = (bodies.len() + i, first_value + 3 * i);
                let name = format!("particle {}", i + 1);
                let mass = option(constant(subject, model.particles[i].0));
                let center = value..value + 3;
                let center = quote!([#(values[#center]),*]);
                (quote!(#place), particle(&quote!(#name), &mass, &center))
            });
            return alone.collect::<Vec<_>>();
        }
        let (count, first, to) = (places.len(), places.start + 1, from + places.len() - 1);
        let list = format_ident!("NAMES_{first}");
        let length = "particle ".len() + places.end.to_string().len();
        names.extend(quote! {
            const #list: &__guen::EntryNames<#count, #length> = &__guen::EntryNames::new("particle ", #first, "");
        });
        let mass = option(Some(match masses {
            Some(first) => quote!(self.constants[#first + __guen_i - #from]),
            None => constant(subject, model.particles[places.start].0).unwrap_or_default(),
        }));
        let value = quote!(#first_value + 3 * (__guen_i - #from));
        let center = quote!([values[#value], values[#value + 1], values[#value + 2]]);
        vec![(quote!(#from..=#to), particle(&quote!(#list.get(__guen_i - #from)), &mass, &center))]
    });
    let particles: Vec<(TokenStream, TokenStream)> = particles.collect();
    let bodies = if is_long {
        let first = bodies.iter().enumerate().map(|(place, body)| (quote!(#place), body.clone()));
        let all = by_number(first.chain(particles).collect());
        quote!(#names #all)
    } else {
        let particles = particles.iter().map(|(_, body)| body);
        let all = bodies.iter().chain(particles);
        quote!([#(#all),*])
    };
    let (size, n) = (layout.size, layout.n);
    let positions = match n >= LONG_ARRAY {
        true => quote!(&::core::array::from_fn::<R, #n, _>(|__guen_i| s[__guen_i])),
        false => {
            let positions = 0..n;
            quote!(&[#(s[#positions]),*])
        }
    };
    // Masses by the constants' own names, unless whole families go by their numbers.
    let locals = (0..layout.constants).map(|i| format_ident!("__guen_c{i}"));
    let locals = match mentions_constants(&bodies) {
        true => Some(quote!(let [#(#locals),*] = self.constants;)),
        false => None,
    };
    let functions = (!layout.supplied.is_empty()).then(|| quote!(, self.hoisted.functions));
    let program = (values > 0).then(|| {
        quote! {
            let hoisted = placed::prepare(&self.constants #functions);
            let values = placed::bodies(&self.constants, &hoisted, t, #positions);
        }
    });
    let driven = (layout.inputs > 0).then(|| {
        quote! {
            impl<R: __guen::Real> __guen::Bodies<R, #size, #count> for Driven<R> {
                fn bodies(&self, t: R, s: &[R; #size]) -> [__guen::Body<R>; #count] {
                    __guen::Bodies::bodies(&self.system, t, s)
                }
            }
        }
    });
    quote! {
        impl<R: __guen::Real> __guen::Bodies<R, #size, #count> for Prepared<R> {
            #[allow(unused_variables, reason = "bodies need not use every constant, nor time")]
            fn bodies(&self, t: R, s: &[R; #size]) -> [__guen::Body<R>; #count] {
                #locals
                #program
                #bodies
            }
        }
        #driven
    }
}

/// Particles one behind the other whose masses stand one behind the other among the constants, from a place on, or are one expression.
struct Family {
    places: Range<usize>,
    masses: Option<usize>,
}

/// The particles in families; those with masses that are not constant are in none with others.
fn families(subject: &Subject<'_, '_>) -> Vec<Family> {
    let Subject { model, level, .. } = subject;
    let graph = &model.bench.graph;
    let mut place_of: BTreeMap<SymbolId, usize> = BTreeMap::new();
    for (place, c) in level.selection.constants.iter().enumerate() {
        place_of.extend(graph.as_symbol(model.constants[*c].symbol).map(|symbol| (symbol, place)));
    }
    let of_mass = |mass: ExprId| graph.as_symbol(mass).and_then(|symbol| place_of.get(&symbol).copied());
    let mut found: Vec<Family> = Vec::new();
    for (i, (mass, _)) in model.particles.iter().enumerate() {
        let own = of_mass(*mass);
        if let Some(Family { places, masses }) = found.last_mut() {
            let first = model.particles[places.start].0;
            // Of one particle alone it is open whether others go on from its mass, or have it too.
            let goes_on = match (own, of_mass(first)) {
                (Some(own), Some(first)) => own == first + i - places.start,
                _ => false,
            };
            let is_same = *mass == first && model.is_constant(first);
            let fits = if places.len() == 1 {
                goes_on || is_same
            } else {
                masses.is_some() == goes_on && (goes_on || is_same)
            };
            if fits {
                *masses = if goes_on { of_mass(first) } else { None };
                places.end = i + 1;
                continue;
            }
        }
        found.push(Family { places: i..i + 1, masses: None });
    }
    found
}

/// The code of a particle.
fn particle(name: &TokenStream, mass: &TokenStream, center: &TokenStream) -> TokenStream {
    let none = option(None);
    quote! {
        __guen::Body {
            name: #name,
            mass: #mass,
            inertia: #none,
            center: ::core::option::Option::Some(#center),
            orientation: #none,
        }
    }
}

/// Whether code names constants by the locals `__guen_c0`, ..
fn mentions_constants(code: &TokenStream) -> bool {
    code.clone().into_iter().any(|token| match token {
        TokenTree::Ident(ident) => ident.to_string().starts_with("__guen_c"),
        TokenTree::Group(group) => mentions_constants(&group.stream()),
        _ => false,
    })
}

/// A mass or moment as an expression over the locals `__guen_c0`, .., if it depends on constants alone. These are written
/// out where they are used: as prepared values they would cost every program that never looks at a body.
fn constant(subject: &Subject<'_, '_>, e: ExprId) -> Option<TokenStream> {
    let known = subject.model.is_constant(e);
    known.then(|| tokens(&default_text(subject, e)))
}

fn option(value: Option<TokenStream>) -> TokenStream {
    match value {
        Some(value) => quote!(::core::option::Option::Some(#value)),
        None => quote!(::core::option::Option::None),
    }
}
