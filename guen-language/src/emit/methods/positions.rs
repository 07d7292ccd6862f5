//! Methods of a system with constraints on positions, beside its motion.

use proc_macro2::TokenStream;
use quote::quote;

use crate::derive::Subject;
use crate::emit::layouts::layout::Layout;

pub(in crate::emit) fn items(subject: &Subject<'_, '_>, layout: &Layout) -> TokenStream {
    let Subject { model, level, .. } = subject;
    let count = level.selection.holonomic.len();
    if count == 0 {
        return TokenStream::new();
    }
    let n = layout.n;
    let all = count + level.selection.redundant.len();
    // An equation that follows from others is checked, but Newton's method does not solve it.
    let surplus = (all > count).then(|| {
        quote! {
            fn further(&self, t: R, coordinates: &[R; #n], take: &mut dyn ::core::ops::FnMut(R, &[R; #n])) {
                let values = program::gradients(&self.constants, &self.hoisted, t, coordinates);
                for v in #count..#all {
                    take(values[v], &::core::array::from_fn(|i| values[#all + v * #n + i]));
                }
            }
        }
    });
    let passed = (all > count).then(|| {
        quote! {
            fn further(&self, t: R, coordinates: &[R; #n], take: &mut dyn ::core::ops::FnMut(R, &[R; #n])) {
                __guen::Positions::further(&self.system, t, coordinates, take);
            }
        }
    });
    let gaps = if all > count {
        quote! {
            let values = program::positions(&self.constants, &self.hoisted, t, coordinates);
            ::core::array::from_fn(|v| values[v])
        }
    } else {
        quote!(program::positions(&self.constants, &self.hoisted, t, coordinates))
    };
    let coordinates = level.selection.coordinates.iter().map(|i| &model.coordinates[*i]);
    let names: Vec<&str> = coordinates.map(|c| c.name.text.as_str()).collect();
    let driven = (layout.inputs > 0).then(|| {
        quote! {
            impl<R: __guen::Real> __guen::Positions<R, #n, #count> for Driven<R> {
                #[inline]
                fn gaps(&self, t: R, coordinates: &[R; #n]) -> [R; #count] {
                    __guen::Positions::gaps(&self.system, t, coordinates)
                }

                #[inline]
                fn linearized(&self, t: R, coordinates: &[R; #n]) -> ([R; #count], [[R; #n]; #count]) {
                    __guen::Positions::linearized(&self.system, t, coordinates)
                }

                #passed
            }
        }
    });
    quote! {
        impl<R: __guen::Real> __guen::Positions<R, #n, #count> for Prepared<R> {
            #[inline]
            fn gaps(&self, t: R, coordinates: &[R; #n]) -> [R; #count] {
                #gaps
            }

            #[inline]
            fn linearized(&self, t: R, coordinates: &[R; #n]) -> ([R; #count], [[R; #n]; #count]) {
                let values = program::gradients(&self.constants, &self.hoisted, t, coordinates);
                let row = |v| ::core::array::from_fn(|i| values[#all + v * #n + i]);
                (::core::array::from_fn(|v| values[v]), ::core::array::from_fn(row))
            }

            #surplus
        }
        #driven

        impl<R: __guen::Ordered> Prepared<R> {
            /// Coordinates that fulfil the holonomic constraints at time `t`, near the guess: those named in `given`
            /// stay as they are in it, the others are found by Newton's method.
            ///
            /// # Errors
            ///
            /// Too many are given, a name is unknown, or nothing near the guess fulfils the constraints.
            pub fn consistent(
                &self,
                t: R,
                guess: &Coordinates<R>,
                given: &[&'static str],
            ) -> ::core::result::Result<Coordinates<R>, __guen::PositionsError> {
                let found = __guen::consistent(self, t, &::core::convert::From::from(*guess), &[#(#names),*], given)?;
                ::core::result::Result::Ok(::core::convert::From::from(found))
            }
        }
    }
}
