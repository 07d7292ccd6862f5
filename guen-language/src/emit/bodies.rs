//! The places of the declared bodies and particles, for pictures of a motion.

use guen_symbolic::ExprId;
use proc_macro2::TokenStream;
use quote::{format_ident, quote};

use super::formula::default_text;
use super::layout::Layout;
use super::text::tokens;
use crate::derive::Subject;

pub(super) fn items(subject: &Subject<'_, '_>, layout: &Layout) -> TokenStream {
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
    let mut bodies: Vec<TokenStream> = bodies.collect();
    for (i, (mass, _)) in model.particles.iter().enumerate() {
        let name = format!("particle {}", i + 1);
        let mass = option(constant(subject, *mass));
        let center = next(3);
        let none = option(None);
        bodies.push(quote! {
            __guen::Body {
                name: #name,
                mass: #mass,
                inertia: #none,
                center: ::core::option::Option::Some([#(#center),*]),
                orientation: #none,
            }
        });
    }
    let (size, n) = (layout.size, layout.n);
    let positions = 0..n;
    let locals = (0..layout.constants).map(|i| format_ident!("__guen_c{i}"));
    let functions = (!layout.supplied.is_empty()).then(|| quote!(, self.hoisted.functions));
    let program = (values > 0).then(|| {
        quote! {
            let hoisted = placed::prepare(&self.constants #functions);
            let values = placed::bodies(&self.constants, &hoisted, t, &[#(s[#positions]),*]);
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
                let [#(#locals),*] = self.constants;
                #program
                [#(#bodies),*]
            }
        }
        #driven
    }
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
