//! The check that a system's bodies are bodies: masses and inertias, where they depend on constants alone.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};

use crate::derive::Subject;
use crate::emit::layouts::layout::Layout;
use crate::emit::layouts::text::tokens;
use crate::emit::programs::formula::default_text;

pub(in crate::emit) fn items(subject: &Subject<'_, '_>, layout: &Layout) -> TokenStream {
    let known = |e: &guen_symbolic::ExprId| subject.model.is_constant(*e);
    let value = |e: &guen_symbolic::ExprId| tokens(&default_text(subject, *e));
    let mut checks = Vec::new();
    for body in &subject.model.bodies {
        let name = &body.name;
        if let Some(mass) = body.mass.as_ref().filter(|mass| known(mass)) {
            let mass = value(mass);
            checks.push(quote!(__guen::check_mass::<R>(#mass, #name)?;));
        }
        if let Some(entries) = body.inertia.as_ref().filter(|entries| entries.iter().all(known)) {
            let entries = entries.iter().map(value);
            checks.push(quote!(__guen::check_inertia::<R>(&[#(#entries),*], #name)?;));
        }
    }
    if checks.is_empty() {
        return TokenStream::new();
    }
    let system = &layout.system;
    let locals = (0..layout.constants).map(|i| format_ident!("__guen_c{i}"));
    quote! {
        impl<R: __guen::Real> #system<R> {
            /// [`prepare`](Self::prepare), and a check that every body is one that could be made: no mass is negative,
            /// and every inertia is that of a distribution of mass in space, so that its principal moments are not
            /// negative and none exceeds the sum of the others. What depends on the position is not checked.
            ///
            /// # Errors
            ///
            /// Those of `prepare`, and `NotPhysical` with the name of the body.
            pub fn prepare_physical(self) -> ::core::result::Result<Prepared<R>, __guen::ConstantsError> {
                let prepared = self.prepare()?;
                #[allow(unused_variables, reason = "bodies need not use every constant")]
                let [#(#locals),*] = prepared.constants;
                #(#checks)*
                ::core::result::Result::Ok(prepared)
            }
        }
    }
}

/// The check that a negative number does not make the mass matrix indefinite. On constraints on positions there is none: the matrix
/// says something only where they hold; nor where the matrix is not written out.
pub(super) fn definite(subject: &Subject<'_, '_>, layout: &Layout) -> Option<TokenStream> {
    let (size, l, count) = (layout.size, layout.l, layout.inputs);
    let name = subject.model.suspicious_body()?;
    let derivation = &subject.level.derivation;
    if !layout.is_whole || l == 0 || !derivation.is_written_out() || !derivation.system.holonomic.is_empty() {
        return None;
    }
    let convert = quote!(::core::convert::From::from);
    let inputs = (count > 0).then(|| quote!(, &#convert([R::zero(); #count])));
    Some(quote! {
        let mass = |state: [R; #size]| prepared.mass_form(R::zero(), &#convert(state) #inputs).mass;
        __guen::check_definite::<R, #size, #l>(mass, #name)?;
    })
}
