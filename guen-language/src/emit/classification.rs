//! Classification and costs as constants, and the marker traits.

use guen_symbolic::Class;
use proc_macro2::TokenStream;
use quote::{format_ident, quote};

use super::layout::Layout;
use super::text::cost;
use crate::derive::{Subject, function};

pub(super) fn items(subject: &Subject<'_, '_>, layout: &Layout) -> TokenStream {
    let derivation = &subject.level.derivation;
    let system = &layout.system;
    let class = match derivation.class {
        Class::LieGroup => "HolonomicConstant",
        Class::Holonomic => "HolonomicVariable",
        Class::IncompleteLieGroup => "NonholonomicConstant",
        Class::Nonholonomic => "NonholonomicVariable",
        Class::Undecided => "Undecided",
    };
    let class = format_ident!("{class}");
    let growth = &derivation.closure.growth;
    let steps = growth.len();
    let integrable = derivation.closure.integrable.len();
    let unfinished = (!derivation.closure.complete).then(|| {
        quote!(#[doc = " The brackets of this system were not followed to the end: this is what is known."])
    });
    let complete = derivation.closure.complete;
    let (scleronomic, catastatic, conservative) =
        (derivation.scleronomic, derivation.catastatic, derivation.conservative);
    let rhs = subject.level.program(function::RHS).map(|f| f.cost).unwrap_or_default();
    let (cost, prepare_cost) = (cost(&rhs), cost(&subject.level.programs.prepare_cost));
    let domain = &subject.level.domain_names;
    let domain_count = domain.len();
    let mut markers = Vec::new();
    match derivation.class {
        Class::LieGroup => markers.extend(["Holonomic", "LieGroup"]),
        Class::Holonomic => markers.push("Holonomic"),
        Class::IncompleteLieGroup => markers.extend(["Nonholonomic", "IncompleteLieGroup"]),
        Class::Nonholonomic => markers.push("Nonholonomic"),
        Class::Undecided => {}
    }
    markers.push(if scleronomic { "Scleronomic" } else { "Rheonomic" });
    if catastatic {
        markers.push("Catastatic");
    }
    if conservative {
        markers.push("Conservative");
    }
    let markers = markers.into_iter().map(|marker| {
        let marker = format_ident!("{marker}");
        let driven = (layout.inputs > 0).then(|| quote!(impl<R> __guen::#marker for Driven<R> {}));
        quote! {
            impl<R> __guen::#marker for Prepared<R> {}
            #driven
        }
    });
    quote! {
        /// The class of the forms as declared.
        pub const CLASS: __guen::Class = __guen::Class::#class;
        /// The growth vector: ranks less one of the distributions that iterated brackets of `X_0 .. X_l` span.
        #unfinished
        pub const GROWTH: [usize; #steps] = [#(#growth),*];
        /// The number of independent integrable combinations of the constraints.
        #unfinished
        pub const INTEGRABLE: usize = #integrable;
        /// Whether the brackets were followed to the end; if not, `GROWTH` is only its beginning and `INTEGRABLE` counts
        /// nothing.
        pub const GROWTH_IS_COMPLETE: bool = #complete;
        /// Whether time occurs in neither the constraints nor the energies.
        pub const SCLERONOMIC: bool = #scleronomic;
        /// Whether the constraints have no terms without velocity.
        pub const CATASTATIC: bool = #catastatic;
        /// Whether the energy integral is constant along every motion.
        pub const CONSERVATIVE: bool = #conservative;
        /// The operations of one right-hand side.
        pub const COST: __guen::Cost = #cost;
        /// The operations that `prepare` does once.
        pub const PREPARE_COST: __guen::Cost = #prepare_cost;
        /// The functions that must not vanish, in the names of the declaration: the domain of the chart.
        pub const DOMAIN: [&str; #domain_count] = [#(#domain),*];

        impl #system<f64> {
            /// The class of the forms as declared.
            pub const CLASS: __guen::Class = CLASS;
            /// The growth vector.
            pub const GROWTH: &'static [usize] = &GROWTH;
            /// The operations of one right-hand side.
            pub const COST: __guen::Cost = COST;
            /// The operations that `prepare` does once.
            pub const PREPARE_COST: __guen::Cost = PREPARE_COST;
        }

        #(#markers)*
    }
}
