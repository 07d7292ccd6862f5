//! The macro that holds the tokens of a component, under the name of the component.

use proc_macro2::{Delimiter, Group, Ident, Punct, Spacing, TokenStream, TokenTree};
use quote::{format_ident, quote};

use super::bundle;
use crate::syntax::{Component, Visibility, digest_of};

/// The macro, and its name as visible as the component.
pub(super) fn items(
    component: &Component,
    tokens: TokenStream,
    inner: &[Group],
    is_faulty: bool,
) -> TokenStream {
    let tokens = visible_groups(without_crate(tokens, component));
    let hidden = hidden_name(component, &tokens);
    let bundle = Group::new(Delimiter::Brace, bundle(tokens, inner, is_faulty));
    let name = &component.name.ident;
    let visibility = component.visibility.outside();
    let is_public = matches!(component.visibility, Visibility::Public(_));
    let export = is_public.then(|| quote!(#[macro_export]));
    let dollar = Punct::new('$', Spacing::Alone);
    quote! {
        #[doc(hidden)]
        #[allow(non_local_definitions, unused_macros, reason = "systems anywhere may use a component")]
        #export
        macro_rules! #hidden {
            ({ #dollar(#dollar next:tt)* } #dollar(#dollar rest:tt)*) => {
                #dollar(#dollar next)*! { #dollar(#dollar rest)* #bundle }
            };
        }
        #[doc(hidden)]
        #[allow(unused_imports, reason = "systems anywhere may use a component")]
        #visibility use #hidden as #name;
    }
}

/// A name that no other component of the crate has: macros that other crates can use are all beside each other.
fn hidden_name(component: &Component, tokens: &TokenStream) -> Ident {
    let name = &component.name.text;
    if !matches!(component.visibility, Visibility::Public(_)) {
        return format_ident!("__guen_component_{name}");
    }
    let (line, column) = crate::diagnostics::position_of(component.name.span());
    let text = format!("{line}:{column}:{tokens}");
    format_ident!("__guen_component_{name}_{}", format!("{:016x}", digest_of(&text)))
}

/// The tokens without `crate = path;`, which says something about the place of the declaration.
fn without_crate(tokens: TokenStream, component: &Component) -> TokenStream {
    if component.crate_path.is_none() {
        return tokens;
    }
    let is_end = |token: &TokenTree| matches!(token, TokenTree::Punct(mark) if mark.as_char() == ';');
    let mut tokens = tokens.into_iter();
    tokens.by_ref().find(is_end);
    tokens.collect()
}

/// The tokens with invisible groups, as fragments of `macro_rules!` leave them, in parentheses: another macro could not hold them.
fn visible_groups(tokens: TokenStream) -> TokenStream {
    let visible = tokens.into_iter().map(|token| match token {
        TokenTree::Group(group) => {
            let inside = visible_groups(group.stream());
            let mut alone = inside.clone().into_iter();
            match (group.delimiter(), alone.next(), alone.next()) {
                (Delimiter::None, first, None) => first.into_iter().collect(),
                (delimiter, ..) => {
                    let delimiter =
                        if delimiter == Delimiter::None { Delimiter::Parenthesis } else { delimiter };
                    let mut visible = Group::new(delimiter, inside);
                    visible.set_span(group.span());
                    TokenStream::from(TokenTree::from(visible))
                }
            }
        }
        token => token.into(),
    });
    visible.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fragments_of_other_macros_keep_their_meaning() {
        let sum: TokenStream = "a + b".parse().unwrap();
        let name: TokenStream = "x".parse().unwrap();
        let invisible = |stream| TokenTree::from(Group::new(Delimiter::None, stream));
        let product: TokenStream =
            [invisible(name), Punct::new('*', Spacing::Alone).into(), invisible(sum)].into_iter().collect();
        assert_eq!(visible_groups(product).to_string(), "x * (a + b)");
    }
}
