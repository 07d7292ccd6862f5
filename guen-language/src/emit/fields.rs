//! The layout of a generated struct: the values, which are a flat list, in fields, arrays and structs.
//!
//! A name is the way to its value: `q[3]` is the entry 3 of the field `q`. Where a struct has only some entries of an array,
//! as that of a scene may, each has a field of its own, `q_3`.

use std::collections::BTreeMap;

use proc_macro2::{Ident, TokenStream};
use quote::quote;

use crate::syntax::{Name, Step};

/// The fields of a struct whose values are a flat list.
#[derive(Clone)]
pub(super) struct Fields {
    fields: Vec<(Ident, Tree)>,
    names: Vec<String>,
    accesses: Vec<TokenStream>,
}

/// The content of a field, with the places of values in the list.
#[derive(Clone)]
pub(super) enum Tree {
    /// One value.
    Leaf(usize),
    /// An array.
    Array(Vec<Tree>),
    /// A component with its fields.
    Instance(Vec<(Ident, Tree)>),
}

/// A value on its way into the tree: the steps that are left, and its place in the list.
type Waiting<'a> = (&'a [Step], usize);

impl Fields {
    /// The fields for values of these names.
    pub(super) fn new<'a>(names: impl IntoIterator<Item = &'a Name>) -> Self {
        let names: Vec<&Name> = names.into_iter().collect();
        let mut order: Vec<&Ident> = Vec::new();
        let mut groups: BTreeMap<String, Vec<Waiting<'_>>> = BTreeMap::new();
        for (place, name) in names.iter().enumerate() {
            let group = groups.entry(name.root().to_string()).or_default();
            if group.is_empty() {
                order.push(name.root());
            }
            group.push((name.path().map_or(&[][..], |path| &path.steps), place));
        }
        let mut fields = Vec::new();
        let mut accesses = vec![TokenStream::new(); names.len()];
        for root in order {
            let group = &groups[&root.to_string()];
            match tree(group) {
                Some(tree) => {
                    tree.reach(&quote!(#root), &mut accesses);
                    fields.push((root.clone(), tree));
                }
                None => {
                    for (_, place) in group {
                        let own = &names[*place].ident;
                        accesses[*place] = quote!(#own);
                        fields.push((own.clone(), Tree::Leaf(*place)));
                    }
                }
            }
        }
        Fields { fields, names: names.into_iter().map(|name| name.text.clone()).collect(), accesses }
    }

    /// Whether every value has a field of its own.
    pub(super) fn is_flat(&self) -> bool {
        self.fields.iter().all(|(_, tree)| matches!(tree, Tree::Leaf(_)))
    }

    /// Whether every value has a field of its own that is called as it is: a struct without anything of arrays.
    pub(super) fn is_plain(&self) -> bool {
        self.is_flat() && self.fields.iter().zip(&self.names).all(|((ident, _), name)| plain(ident) == *name)
    }

    /// The bound of the real where values are taken out one by one: out of an array they are copied.
    pub(super) fn copied(&self) -> Option<TokenStream> {
        (!self.is_flat()).then(|| quote!(: ::core::marker::Copy))
    }

    /// The number of values.
    pub(super) fn len(&self) -> usize {
        self.names.len()
    }

    /// The names of the values.
    pub(super) fn names(&self) -> &[String] {
        &self.names
    }

    /// The identifiers of the fields.
    pub(super) fn idents(&self) -> impl Iterator<Item = &Ident> {
        self.fields.iter().map(|(ident, _)| ident)
    }

    /// The fields with what they hold.
    pub(super) fn trees(&self) -> impl Iterator<Item = (&Ident, &Tree)> {
        self.fields.iter().map(|(ident, tree)| (ident, tree))
    }

    /// The way to a value behind the point: `q[3]`.
    pub(super) fn access(&self, place: usize) -> &TokenStream {
        &self.accesses[place]
    }

    /// The ways to all values.
    pub(super) fn accesses(&self) -> &[TokenStream] {
        &self.accesses
    }

    /// The fields of a literal of the struct, without its braces, from an expression for each value.
    pub(super) fn literal(&self, values: &[TokenStream]) -> TokenStream {
        let fields = self.fields.iter().map(|(ident, tree)| {
            let value = tree.literal(values);
            quote!(#ident: #value,)
        });
        quote!(#(#fields)*)
    }

    /// The serde shape of the fields, as constants of the runtime.
    pub(super) fn shape(&self) -> TokenStream {
        let fields = self.fields.iter().map(|(ident, tree)| {
            let (name, shape) = (plain(ident), tree.shape());
            quote!((#name, #shape))
        });
        quote!(&[#(#fields),*])
    }

    /// The places of the values in the order in which the fields hold them.
    pub(super) fn order(&self) -> Vec<usize> {
        let mut places = Vec::new();
        self.fields.iter().for_each(|(_, tree)| tree.leaves(&mut places));
        places
    }
}

/// The tree of values with steps before them; none where an array would have gaps or entries of several kinds.
fn tree(waiting: &[Waiting<'_>]) -> Option<Tree> {
    if let [([], place)] = waiting {
        return Some(Tree::Leaf(*place));
    }
    let mut rows: BTreeMap<usize, Vec<Waiting<'_>>> = BTreeMap::new();
    let mut fields: Vec<(Ident, Vec<Waiting<'_>>)> = Vec::new();
    let mut length = 0;
    for (steps, place) in waiting {
        let (first, rest) = steps.split_first()?;
        match first {
            Step::Index { at, of } => {
                length = *of;
                rows.entry(*at).or_default().push((rest, *place));
            }
            Step::Field(ident) => match fields.iter_mut().find(|(known, _)| known == ident) {
                Some((_, group)) => group.push((rest, *place)),
                None => fields.push((ident.clone(), vec![(rest, *place)])),
            },
        }
    }
    match (rows.is_empty(), fields.is_empty()) {
        (false, true) => {
            let entries: Option<Vec<Tree>> = (0..length).map(|at| tree(rows.get(&at)?)).collect();
            entries.filter(|entries| entries.iter().all(|entry| entry.is_like(&entries[0]))).map(Tree::Array)
        }
        (true, false) => {
            let fields = fields.into_iter().map(|(ident, group)| Some((ident, tree(&group)?)));
            fields.collect::<Option<_>>().map(Tree::Instance)
        }
        _ => None,
    }
}

impl Tree {
    /// Whether both have one type.
    fn is_like(&self, other: &Tree) -> bool {
        match (self, other) {
            (Tree::Leaf(_), Tree::Leaf(_)) => true,
            (Tree::Array(a), Tree::Array(b)) => {
                a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.is_like(b))
            }
            (Tree::Instance(a), Tree::Instance(b)) => {
                a.len() == b.len() && a.iter().zip(b).all(|((i, a), (j, b))| i == j && a.is_like(b))
            }
            _ => false,
        }
    }

    fn reach(&self, way: &TokenStream, accesses: &mut [TokenStream]) {
        match self {
            Tree::Leaf(place) => accesses[*place] = way.clone(),
            Tree::Array(entries) => entries.iter().enumerate().for_each(|(at, entry)| {
                let at = proc_macro2::Literal::usize_unsuffixed(at);
                entry.reach(&quote!(#way[#at]), accesses);
            }),
            Tree::Instance(fields) => {
                fields.iter().for_each(|(field, tree)| tree.reach(&quote!(#way.#field), accesses));
            }
        }
    }

    /// The places of the values, in the order of the tree.
    pub(super) fn leaves(&self, places: &mut Vec<usize>) {
        match self {
            Tree::Leaf(place) => places.push(*place),
            Tree::Array(entries) => entries.iter().for_each(|entry| entry.leaves(places)),
            Tree::Instance(fields) => fields.iter().for_each(|(_, tree)| tree.leaves(places)),
        }
    }

    /// The place of the first value.
    pub(super) fn first(&self) -> Option<usize> {
        let mut places = Vec::new();
        self.leaves(&mut places);
        places.first().copied()
    }

    /// The type, from that of a value.
    pub(super) fn of_type(&self, leaf: &TokenStream) -> TokenStream {
        match self {
            Tree::Leaf(_) => leaf.clone(),
            Tree::Array(entries) => {
                let count = entries.len();
                let inner = entries.first().map_or_else(|| leaf.clone(), |entry| entry.of_type(leaf));
                quote!([#inner; #count])
            }
            // A struct of its own stands for these.
            Tree::Instance(fields) => {
                let inner = fields.iter().map(|(_, tree)| tree.of_type(leaf));
                quote!((#(#inner,)*))
            }
        }
    }

    /// The value from an expression for each leaf.
    pub(super) fn literal(&self, values: &[TokenStream]) -> TokenStream {
        match self {
            Tree::Leaf(place) => values[*place].clone(),
            Tree::Array(entries) => {
                let entries = entries.iter().map(|entry| entry.literal(values));
                quote!([#(#entries),*])
            }
            Tree::Instance(fields) => {
                let fields = fields.iter().map(|(_, tree)| tree.literal(values));
                quote!((#(#fields,)*))
            }
        }
    }

    /// A literal with one value everywhere, whatever the length.
    pub(super) fn filled(&self, value: &TokenStream) -> TokenStream {
        match self {
            Tree::Leaf(_) => value.clone(),
            Tree::Array(entries) => {
                let inner = entries.first().map_or_else(|| value.clone(), |entry| entry.filled(value));
                quote!(::core::array::from_fn(|_| #inner))
            }
            Tree::Instance(fields) => {
                let fields = fields.iter().map(|(_, tree)| tree.filled(value));
                quote!((#(#fields,)*))
            }
        }
    }

    fn shape(&self) -> TokenStream {
        match self {
            Tree::Leaf(_) => quote!(__guen::Shape::Value),
            Tree::Array(entries) => {
                let (count, inner) = (
                    entries.len(),
                    entries.first().map_or_else(|| quote!(__guen::Shape::Value), Tree::shape),
                );
                quote!(__guen::Shape::Array(#count, &#inner))
            }
            Tree::Instance(fields) => {
                let fields = fields.iter().map(|(ident, tree)| {
                    let (name, shape) = (plain(ident), tree.shape());
                    quote!((#name, #shape))
                });
                quote!(__guen::Shape::Struct(&[#(#fields),*]))
            }
        }
    }
}

/// An identifier without `r#`.
pub(super) fn plain(ident: &Ident) -> String {
    ident.to_string().trim_start_matches("r#").to_owned()
}
