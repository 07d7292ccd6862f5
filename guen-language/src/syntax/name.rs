//! Names, documentation and visibility as written.

use std::fmt;

use proc_macro2::{Ident, Span, TokenStream};
use quote::{format_ident, quote};

use super::{Index, Path};
use crate::names::array_of;

/// A name, kept with the identifier that the expansion will use.
#[derive(Debug, Clone)]
pub struct Name {
    /// The name as shown to the user, without `r#`: of an entry of an array its path, `q[3]`.
    pub text: String,
    /// The identifier as written, with its span; of an entry of an array one of its own, `q_3`.
    pub ident: Ident,
    /// The index, if there is one.
    pub index: Index,
}

impl Name {
    /// The name of an identifier.
    pub fn new(ident: Ident) -> Self {
        let written = ident.to_string();
        let text = written.strip_prefix("r#").map(str::to_owned).unwrap_or(written);
        Name { text, ident, index: Index::None }
    }

    /// The name at the end of a path.
    pub fn at(path: Path) -> Self {
        Name { text: path.text(), ident: path.flat(), index: Index::Entry(Box::new(path)) }
    }

    /// The path of an entry of an array; none of a plain name.
    pub fn path(&self) -> Option<&Path> {
        match &self.index {
            Index::Entry(path) => Some(path),
            _ => None,
        }
    }

    /// The identifier as it was written, without an index.
    pub fn root(&self) -> &Ident {
        self.path().map_or(&self.ident, |path| &path.root)
    }

    /// The name of a part: `w_x` of `w`, and `w_x[3]` of `w[3]`.
    pub fn suffixed(&self, suffix: &str) -> Name {
        match self.path() {
            None => {
                let ident = format_ident!("{}{suffix}", self.ident, span = self.span());
                Name { text: format!("{}{suffix}", self.text), ident, index: self.index.clone() }
            }
            Some(path) => {
                let mut path = path.clone();
                let last = path.steps.iter_mut().rev().find_map(|step| match step {
                    super::Step::Field(field) => Some(field),
                    super::Step::Index { .. } => None,
                });
                let field = last.unwrap_or(&mut path.root);
                *field = format_ident!("{field}{suffix}", span = field.span());
                Name::at(path)
            }
        }
    }

    /// The name of a part of what has this name, as `v_x[1]` is of `v[1]`, and `contact_n[0]` of `contact[0]`; the name itself where both are
    /// the same. `None` if the text names no part.
    pub fn part(&self, text: &str) -> Option<Name> {
        match array_of(text).strip_prefix(array_of(&self.text))? {
            "" => Some(self.clone()),
            suffix => suffix.starts_with('_').then(|| self.suffixed(suffix)),
        }
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
