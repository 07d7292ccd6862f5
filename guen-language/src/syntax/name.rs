//! Names, documentation and visibility as written.

use std::fmt;

use proc_macro2::{Ident, Span, TokenStream};
use quote::quote;

/// A name, kept with the identifier that the expansion will use.
#[derive(Debug, Clone)]
pub struct Name {
    /// The name as shown to the user, without `r#`.
    pub text: String,
    /// The identifier as written, with its span.
    pub ident: Ident,
}

impl Name {
    /// The name of an identifier.
    pub fn new(ident: Ident) -> Self {
        let written = ident.to_string();
        let text = written.strip_prefix("r#").map(str::to_owned).unwrap_or(written);
        Name { text, ident }
    }

    /// Returns the place of the name.
    pub fn span(&self) -> Span {
        self.ident.span()
    }
}

impl fmt::Display for Name {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

/// Doc comments in front of something.
#[derive(Debug, Clone, Default)]
pub struct Docs {
    /// The right side of each `doc = ..`, to be emitted as it is: it may be a macro call such as `concat!`.
    pub values: Vec<TokenStream>,
    /// The lines of those that are string literals.
    pub lines: Vec<String>,
}

/// The visibility of the generated items.
#[derive(Debug, Clone)]
pub enum Visibility {
    /// The module around the invocation: no visibility is written.
    Private,
    /// `pub`.
    Public(Span),
    /// `pub(crate)`, `pub(super)`, `pub(self)` or `pub(in path)`.
    Restricted {
        /// Place of the `pub`.
        span: Span,
        /// The path, without `in`.
        path: TokenStream,
    },
}

impl Visibility {
    /// The visibility for an item beside the invocation.
    pub fn outside(&self) -> TokenStream {
        match self {
            Visibility::Private => TokenStream::new(),
            Visibility::Public(_) => quote!(pub),
            Visibility::Restricted { path, .. } => quote!(pub(in #path)),
        }
    }

    /// Returns the visibility for an item in a module that the expansion opens: paths that are relative to the module
    /// around the invocation are one step longer there.
    pub fn inside(&self) -> TokenStream {
        match self {
            Visibility::Private => quote!(pub(super)),
            Visibility::Public(_) => quote!(pub),
            Visibility::Restricted { path, .. } => match path.to_string().split([' ', ':']).next() {
                Some("crate") => quote!(pub(in #path)),
                Some("self") => quote!(pub(super)),
                _ => quote!(pub(in super::#path)),
            },
        }
    }
}
