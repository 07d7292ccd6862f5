//! The operators of displacement and their brackets.

use guen_symbolic::{ExprId, Role, Roles, Workbench};
use proc_macro2::TokenStream;
use quote::{format_ident, quote};

use super::Layout;
use crate::derive::{Derived, bracket_pairs};

pub(super) fn items(derived: &mut Derived<'_>, layout: &Layout) -> TokenStream {
    let n = layout.n;
    let operators = (0..=n).map(|j| {
        let name = format_ident!("X{j}");
        let places = (j * n)..((j + 1) * n);
        let docs = match j {
            0 => "The operator `X_0 = d/dt + sum_i xi_0^i d/dx_i`: what happens by itself, (1.7).".to_owned(),
            _ => format!("The operator `X_{j}` of the form `{}`, (1.4).", derived.model.forms[j - 1].name),
        };
        let is_time = j == 0;
        quote! {
            #[doc = #docs]
            #[::core::prelude::v1::derive(
                ::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug, ::core::default::Default,
                ::core::cmp::PartialEq, ::core::cmp::Eq
            )]
            pub struct #name;

            impl<B: __guen::Real> __guen::Operator<B, #n> for #name {
                type Prepared = Prepared<B>;
                const TIME: bool = #is_time;
                fn coefficients<R: __guen::Real + __guen::Lift<B>>(
                    prepared: &Prepared<B>,
                    t: R,
                    x: &[R; #n],
                ) -> [R; #n] {
                    let lifted: Prepared<R> = prepared.lift();
                    let all = program::operators(&lifted.constants, &lifted.hoisted, t, x);
                    [#(all[#places]),*]
                }
            }
        }
    });
    let operators: Vec<_> = operators.collect();
    let brackets = brackets(derived, layout);
    quote! {
        #(#operators)*

        /// The commutator `(X_I, X_J) = sum_t C_IJt X_t`, (1.14), for `I` and `J` up to the number of parameters.
        ///
        /// What the derivation knows of each coefficient is in `COEFFICIENTS`, their values come from
        /// `coefficients`.
        #[::core::prelude::v1::derive(
            ::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug, ::core::default::Default,
            ::core::cmp::PartialEq, ::core::cmp::Eq
        )]
        pub struct Bracket<const I: usize, const J: usize>;
        #(#brackets)*
    }
}

fn brackets(derived: &mut Derived<'_>, layout: &Layout) -> Vec<TokenStream> {
    let (n, l) = (layout.n, layout.l);
    let pairs = bracket_pairs(&mut derived.model.bench, &mut derived.derivation);
    let mut items = Vec::new();
    for s in 0..=l {
        for r in 0..=l {
            let Derived { model, derivation, .. } = derived;
            let coefficients: Vec<ExprId> =
                (1..=n).map(|t| derivation.frame.brackets.coefficient(&mut model.bench, r, s, t)).collect();
            let zero = coefficients.iter().all(|c| model.bench.graph.is_zero(*c));
            if zero {
                items.push(quote!(__guen::zero_bracket!(#r, #s, #n);));
                continue;
            }
            let known = coefficients.iter().map(|c| knowledge(&mut model.bench, *c));
            let known: Vec<_> = known.collect();
            let place = pairs.iter().position(|pair| *pair == (r.min(s), r.max(s))).unwrap_or(0);
            let places = (place * n)..((place + 1) * n);
            let sign = (r > s).then(|| quote!(-));
            items.push(quote! {
                impl<B: __guen::Real> __guen::BracketCoefficients<B, #n> for Bracket<#r, #s> {
                    type Prepared = Prepared<B>;
                    const I: usize = #r;
                    const J: usize = #s;
                    const COEFFICIENTS: [__guen::Coefficient; #n] = [#(#known),*];
                    fn coefficients<R: __guen::Real + __guen::Lift<B>>(
                        prepared: &Prepared<B>,
                        t: R,
                        x: &[R; #n],
                    ) -> [R; #n] {
                        let lifted: Prepared<R> = prepared.lift();
                        let all = program::brackets(&lifted.constants, &lifted.hoisted, t, x);
                        [#(#sign all[#places]),*]
                    }
                }
            });
        }
    }
    items
}

/// What is known of a coefficient at compile time.
fn knowledge(bench: &mut Workbench, c: ExprId) -> TokenStream {
    if let Some(value) = bench.graph.as_number(c) {
        if value.is_zero() {
            return quote!(__guen::Coefficient::Zero);
        }
        if let Some((numerator, denominator)) = value.to_i64_pair() {
            return quote!(__guen::Coefficient::Number { numerator: #numerator, denominator: #denominator });
        }
    }
    let moving = Roles::of(Role::Coordinate).or(Roles::of(Role::Time));
    if bench.graph.roles(c).meets(moving) {
        quote!(__guen::Coefficient::Variable)
    } else {
        quote!(__guen::Coefficient::Constant)
    }
}
