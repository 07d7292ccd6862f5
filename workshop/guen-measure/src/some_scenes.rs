//! Systems with scenes and without, for those who ask what a scene costs that is not used.

use proc_macro2::{Group, TokenStream, TokenTree};

/// Five scenes each for the first systems of two examples.
pub const FIVE: [(&str, &str); 2] = [
    (
        "hoop",
        "scene A { track theta; } scene B { track theta; fix a = 1, g = 9.81; } scene C { track psi; provide energy; }
         scene D { track theta; provide reactions; } scene E { track theta; provide linearization; }",
    ),
    (
        "chaplygin_sled",
        "scene A { track phi; } scene B { track phi; fix alpha = 0; } scene C { fix incline = 0; }
         scene D { fix beta = 0; } scene E { provide energy; }",
    ),
];

/// The declaration in the text of a file: the group after `mechanical_system!`.
pub fn declaration(source: &str) -> TokenStream {
    let tokens: Vec<TokenTree> =
        source.parse::<TokenStream>().expect("an example is Rust").into_iter().collect();
    let found = tokens.windows(3).find_map(|three| match three {
        [TokenTree::Ident(name), TokenTree::Punct(mark), TokenTree::Group(group)]
            if name == "mechanical_system" && mark.as_char() == '!' =>
        {
            Some(group.stream())
        }
        _ => None,
    });
    found.expect("an example declares a system")
}

/// The declaration with more at the end of its last group.
pub fn added(tokens: TokenStream, scenes: &str) -> TokenStream {
    let mut tokens: Vec<TokenTree> = tokens.into_iter().collect();
    let Some(TokenTree::Group(group)) = tokens.pop() else { panic!("a declaration ends with a group") };
    let inside = group.stream().into_iter().chain(scenes.parse::<TokenStream>().expect("these are tokens"));
    tokens.push(TokenTree::Group(Group::new(group.delimiter(), inside.collect())));
    tokens.into_iter().collect()
}
