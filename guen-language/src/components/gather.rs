//! The chain of calls that brings the tokens of components to the system that uses them.

use proc_macro2::{Delimiter, Group, Ident, Span, TokenStream, TokenTree};
use quote::quote;

use super::unbundle;
use crate::syntax::{ComponentPath, Imported};

/// The tokens of an invocation, and the components that were added to it.
pub(crate) struct Gathered {
    /// The invocation as it was written.
    pub(crate) tokens: TokenStream,
    /// A bundle for each path, in their order.
    pub(crate) bundles: Vec<Group>,
}

/// Calls the components of the paths one after the other, and then a macro of the facade with the tokens and what they added.
pub(crate) fn gather(
    facade: Option<&TokenStream>,
    back: &str,
    paths: &[&ComponentPath],
    tokens: TokenStream,
) -> TokenStream {
    let facade = facade.cloned().unwrap_or_else(|| quote!(::guen));
    let back = Ident::new(back, Span::call_site());
    let mut ways: Vec<TokenStream> = paths.iter().map(|path| path.tokens.clone()).collect();
    ways.push(quote!(#facade::__private::#back));
    let first = ways.remove(0);
    let ways = ways.iter().map(|way| Group::new(Delimiter::Brace, way.clone()));
    let tokens = Group::new(Delimiter::Brace, tokens);
    quote!(#first! { #(#ways)* #tokens })
}

/// Takes apart what a chain of calls has put together.
pub(crate) fn split(tokens: TokenStream) -> Gathered {
    let mut groups = tokens.into_iter().filter_map(|token| match token {
        TokenTree::Group(group) => Some(group),
        _ => None,
    });
    let tokens = groups.next().map(|group| group.stream()).unwrap_or_default();
    Gathered { tokens, bundles: groups.collect() }
}

/// The components of some paths, each with whether mistakes in it have been reported already.
pub(crate) fn imported(paths: &[&ComponentPath], bundles: &[Group]) -> Vec<Imported> {
    let pairs = paths.iter().zip(bundles);
    let read = pairs.filter_map(|(path, group)| {
        let (component, is_faulty) = unbundle(group)?;
        Some(Imported { path: path.text.clone(), component, is_faulty })
    });
    read.collect()
}
