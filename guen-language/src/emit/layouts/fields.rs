//! The layout of a generated struct: the values, which are a flat list, in fields, arrays and structs.
//!
//! A name is the way to its value: `q[3]` is the entry 3 of the field `q`. Where a struct has only some entries of an array,
//! as that of a scene may, each has a field of its own, `q_3`, or `q_3_` where another value is called so.

mod long_arrays;

use std::collections::{BTreeMap, BTreeSet};

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use crate::syntax::{Name, Path, Step};
pub(in crate::emit) use long_arrays::{Entry, by_number};

/// The fields of a struct whose values are a flat list.
#[derive(Clone)]
pub(in crate::emit) struct Fields {
    fields: Vec<(Ident, Tree)>,
    names: Vec<String>,
    accesses: Vec<TokenStream>,
    /// The number of values that are functions, behind all others.
    functions: usize,
}

/// The content of a field, with the places of values in the list.
#[derive(Clone)]
pub(in crate::emit) enum Tree {
    /// One value.
    Leaf(usize),
    /// An array.
    Array(Vec<Tree>),
    /// An instance of a component.
    Instance(Part),
}

/// The values of an instance, in a struct of their own: `State` in the module `left` has the states of the instance `left`.
#[derive(Clone)]
pub(in crate::emit) struct Part {
    /// The fields.
    pub(in crate::emit) fields: Vec<(Ident, Tree)>,
    /// The module of the struct, seen from that of the level: `left::hip`.
    pub(in crate::emit) module: Vec<Ident>,
    /// The module of the level, seen from where the struct is named: nothing, or `super::`.
    level: TokenStream,
    /// The name of the struct.
    record: &'static str,
    /// The type of reals; of a struct without a parameter none.
    real: Option<TokenStream>,
    /// The types of the functions in it.
    pub(in crate::emit) kinds: Vec<Ident>,
    /// Whether it has functions and nothing else, so that a field of its own names the type of reals.
    pub(super) has_marker: bool,
}

/// A value on its way into the tree: the steps that are left, and its place in the list.
type Waiting<'a> = (&'a [Step], usize);

impl Fields {
    /// The fields for values of these names.
    pub(in crate::emit) fn new<'a>(names: impl IntoIterator<Item = &'a Name>) -> Self {
        let names: Vec<&Name> = names.into_iter().collect();
        Fields::of_types(&names, &vec![(); names.len()])
    }

    /// The fields for values of these names and types: entries of several types have a field each.
    pub(in crate::emit) fn of_types<T: PartialEq>(names: &[&Name], types: &[T]) -> Self {
        let mut order: Vec<&Name> = Vec::new();
        let mut groups: BTreeMap<String, Vec<Waiting<'_>>> = BTreeMap::new();
        let incomplete = incomplete(names, types);
        for (place, name) in names.iter().enumerate() {
            if incomplete.contains(&template(name)) {
                continue;
            }
            let group = groups.entry(name.root().to_string()).or_default();
            if group.is_empty() {
                order.push(name);
            }
            group.push((name.path().map_or(&[][..], |path| &path.steps), place));
        }
        let mut fields = Vec::new();
        let mut accesses = vec![TokenStream::new(); names.len()];
        let mut taken: BTreeSet<String> = groups.keys().cloned().collect();
        let mut alone = |name: &Name| {
            let mut own = name.ident.clone();
            while !taken.insert(own.to_string()) {
                own = format_ident!("{own}_", span = own.span());
            }
            own
        };
        for name in order {
            let root = name.root();
            let group = &groups[&root.to_string()];
            let module = name.path().map_or(root, Path::module);
            match tree(group, std::slice::from_ref(module)) {
                Some(tree) => {
                    tree.reach(&quote!(#root), &mut accesses);
                    fields.push((root.clone(), tree));
                }
                None => {
                    for (_, place) in group {
                        let own = alone(names[*place]);
                        accesses[*place] = quote!(#own);
                        fields.push((own, Tree::Leaf(*place)));
                    }
                }
            }
        }
        for (place, name) in names.iter().enumerate().filter(|(_, name)| incomplete.contains(&template(name)))
        {
            let own = alone(name);
            accesses[place] = quote!(#own);
            fields.push((own, Tree::Leaf(place)));
        }
        let names = names.iter().map(|name| name.text.clone()).collect();
        Fields { fields, names, accesses, functions: 0 }
    }

    /// The fields of a struct of constants; the last ones are functions that the program supplies, of these kinds.
    pub(super) fn of_constants<'a>(names: impl IntoIterator<Item = &'a Name>, kinds: &[Ident]) -> Self {
        let mut fields = Fields::new(names).of_record("Constants");
        let first = fields.len() - kinds.len();
        fields.functions = kinds.len();
        if !kinds.is_empty() {
            fields.each_part(&mut |part| {
                let mut places = Vec::new();
                part.fields.iter().for_each(|(_, tree)| tree.leaves(&mut places));
                for kind in places.iter().filter_map(|place| kinds.get(place.checked_sub(first)?)) {
                    if !part.kinds.contains(kind) {
                        part.kinds.push(kind.clone());
                    }
                }
                part.has_marker = are_functions(&part.fields, first);
            });
        }
        fields
    }

    /// Whether no value but functions is in the struct, so that a field of its own names the type of reals.
    pub(in crate::emit) fn has_marker(&self) -> bool {
        are_functions(&self.fields, self.constants())
    }

    /// The number of constants.
    pub(super) fn constants(&self) -> usize {
        self.names.len() - self.functions
    }

    /// The place of a function among all functions, where a value is one.
    pub(in crate::emit) fn function(&self, place: usize) -> Option<usize> {
        place.checked_sub(self.constants())
    }

    /// Sets the name of the record, whose instances have structs of that name.
    pub(in crate::emit) fn of_record(mut self, record: &'static str) -> Self {
        self.each_part(&mut |part| part.record = record);
        self
    }

    /// Sets the name of the type of reals.
    pub(in crate::emit) fn over(mut self, real: &Ident) -> Self {
        self.each_part(&mut |part| part.real = Some(quote!(#real)));
        self
    }

    /// Takes the structs of instances to be without a type of reals.
    pub(in crate::emit) fn without_reals(mut self) -> Self {
        self.each_part(&mut |part| part.real = None);
        self
    }

    /// Names structs from a module inside of that of the level.
    pub(in crate::emit) fn of_outer(mut self) -> Self {
        self.each_part(&mut |part| part.level = quote!(super::));
        self
    }

    fn each_part(&mut self, change: &mut dyn FnMut(&mut Part)) {
        self.fields.iter_mut().for_each(|(_, tree)| tree.each_part(change));
    }

    /// The instances, each behind the one that it is a part of; of an array of them the first.
    pub(in crate::emit) fn parts(&self) -> Vec<&Part> {
        let mut found = Vec::new();
        self.fields.iter().for_each(|(_, tree)| tree.parts(&mut found));
        found
    }

    /// Whether every value has a field of its own.
    pub(in crate::emit) fn is_flat(&self) -> bool {
        self.fields.iter().all(|(_, tree)| matches!(tree, Tree::Leaf(_)))
    }

    /// Whether every value has a field of its own that is called as it is: a struct without anything of arrays.
    pub(in crate::emit) fn is_plain(&self) -> bool {
        self.is_flat() && self.fields.iter().zip(&self.names).all(|((ident, _), name)| plain(ident) == *name)
    }

    /// The bound of the real where values are taken out one by one: out of an array they are copied.
    pub(in crate::emit) fn copied(&self) -> Option<TokenStream> {
        (!self.is_flat()).then(|| quote!(: ::core::marker::Copy))
    }

    /// The number of values.
    pub(in crate::emit) fn len(&self) -> usize {
        self.names.len()
    }

    /// The names of the values.
    pub(in crate::emit) fn names(&self) -> &[String] {
        &self.names
    }

    /// The identifiers of the fields.
    pub(in crate::emit) fn idents(&self) -> impl Iterator<Item = &Ident> {
        self.fields.iter().map(|(ident, _)| ident)
    }

    /// The fields with what they hold.
    pub(in crate::emit) fn trees(&self) -> impl Iterator<Item = (&Ident, &Tree)> {
        self.fields.iter().map(|(ident, tree)| (ident, tree))
    }

    /// The way to a value behind the point: `q[3]`.
    pub(in crate::emit) fn access(&self, place: usize) -> &TokenStream {
        &self.accesses[place]
    }

    /// The ways to all values.
    pub(in crate::emit) fn accesses(&self) -> &[TokenStream] {
        &self.accesses
    }

    /// The fields of a literal of the struct, without its braces, from an expression for each value.
    pub(in crate::emit) fn literal(&self, values: &[TokenStream]) -> TokenStream {
        let fields = self.fields.iter().map(|(ident, tree)| {
            let value = tree.literal(&|place| values[place].clone());
            quote!(#ident: #value,)
        });
        quote!(#(#fields)*)
    }

    /// The serde shape of the fields, as constants of the runtime.
    pub(in crate::emit) fn shape(&self) -> TokenStream {
        let fields = self.fields.iter().map(|(ident, tree)| {
            let (name, shape) = (plain(ident), tree.shape());
            quote!((#name, #shape))
        });
        quote!(&[#(#fields),*])
    }

    /// The places of the values in the order in which the fields hold them.
    pub(in crate::emit) fn order(&self) -> Vec<usize> {
        let mut places = Vec::new();
        self.fields.iter().for_each(|(_, tree)| tree.leaves(&mut places));
        places
    }
}

/// Whether all fields are functions, given the place of the first function.
fn are_functions(fields: &[(Ident, Tree)], first: usize) -> bool {
    fields.iter().all(|(_, tree)| matches!(tree, Tree::Leaf(place) if *place >= first))
}

/// A name without the numbers of its indices: entries of one array have one of them.
pub(super) fn template(name: &Name) -> String {
    let steps = name.path().into_iter().flat_map(|path| &path.steps);
    let steps = steps.map(|step| match step {
        Step::Index { .. } => "[]".to_owned(),
        Step::Field(field) => format!(".{field}"),
    });
    std::iter::once(name.root().to_string()).chain(steps).collect()
}

/// The templates of arrays of which there are some entries only, or whose entries have several types.
fn incomplete<T: PartialEq>(names: &[&Name], types: &[T]) -> BTreeSet<String> {
    let mut counts: BTreeMap<String, (usize, usize)> = BTreeMap::new();
    let mut first: BTreeMap<String, &T> = BTreeMap::new();
    let mut several = BTreeSet::new();
    for (name, of) in names.iter().zip(types) {
        if **first.entry(template(name)).or_insert(of) != *of {
            several.insert(template(name));
        }
        let sizes = name.path().into_iter().flat_map(|path| &path.steps).map(|step| match step {
            Step::Index { of, .. } => *of,
            Step::Field(_) => 1,
        });
        counts.entry(template(name)).or_insert((0, sizes.product())).0 += 1;
    }
    several.extend(counts.into_iter().filter(|(_, (found, all))| found != all).map(|(template, _)| template));
    several
}

/// The tree of values with steps before them; none where an array would have gaps or entries of several kinds.
fn tree(waiting: &[Waiting<'_>], module: &[Ident]) -> Option<Tree> {
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
            let entries: Option<Vec<Tree>> = (0..length).map(|at| tree(rows.get(&at)?, module)).collect();
            entries.filter(|entries| entries.iter().all(|entry| entry.is_like(&entries[0]))).map(Tree::Array)
        }
        (true, false) => {
            let fields = fields.into_iter().map(|(ident, group)| {
                let inner: Vec<Ident> = module.iter().cloned().chain([ident.clone()]).collect();
                Some((ident, tree(&group, &inner)?))
            });
            let fields = fields.collect::<Option<_>>()?;
            let (module, level) = (module.to_vec(), TokenStream::new());
            let (kinds, has_marker) = (Vec::new(), false);
            let real = Some(quote!(R));
            Some(Tree::Instance(Part { fields, module, level, record: "", real, kinds, has_marker }))
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
                let (a, b) = (&a.fields, &b.fields);
                a.len() == b.len() && a.iter().zip(b).all(|((i, a), (j, b))| i == j && a.is_like(b))
            }
            _ => false,
        }
    }

    /// A value that is everywhere the same, inside of the module of an instance.
    pub(super) fn inner_filled(&self, value: &TokenStream, depth: usize) -> TokenStream {
        let mut inner = self.clone();
        inner.each_part(&mut |part| part.level = outward(depth));
        inner.filled(value)
    }

    /// The instance that the field is, or of an array of them the first.
    pub(in crate::emit) fn instance(&self) -> Option<&Part> {
        match self {
            Tree::Leaf(_) => None,
            Tree::Array(entries) => entries.first()?.instance(),
            Tree::Instance(part) => Some(part),
        }
    }

    fn each_part(&mut self, change: &mut dyn FnMut(&mut Part)) {
        match self {
            Tree::Leaf(_) => {}
            Tree::Array(entries) => entries.iter_mut().for_each(|entry| entry.each_part(change)),
            Tree::Instance(part) => {
                change(part);
                part.fields.iter_mut().for_each(|(_, tree)| tree.each_part(change));
            }
        }
    }

    fn parts<'a>(&'a self, found: &mut Vec<&'a Part>) {
        match self {
            Tree::Leaf(_) => {}
            Tree::Array(entries) => entries.iter().take(1).for_each(|entry| entry.parts(found)),
            Tree::Instance(part) => {
                found.push(part);
                part.fields.iter().for_each(|(_, tree)| tree.parts(found));
            }
        }
    }

    /// The type inside of the module of an instance, where the level is some modules further out, from that of a value.
    pub(in crate::emit) fn inner_type(
        &self,
        leaf: &dyn Fn(usize) -> TokenStream,
        depth: usize,
    ) -> TokenStream {
        match self {
            Tree::Leaf(place) => leaf(*place),
            Tree::Array(entries) => {
                let count = entries.len();
                let inner = entries.first().map_or_else(|| quote!(R), |entry| entry.inner_type(leaf, depth));
                quote!([#inner; #count])
            }
            Tree::Instance(part) => part.of_type(&outward(depth)),
        }
    }

    fn reach(&self, way: &TokenStream, accesses: &mut [TokenStream]) {
        match self {
            Tree::Leaf(place) => accesses[*place] = way.clone(),
            Tree::Array(entries) => entries.iter().enumerate().for_each(|(at, entry)| {
                let at = proc_macro2::Literal::usize_unsuffixed(at);
                entry.reach(&quote!(#way[#at]), accesses);
            }),
            Tree::Instance(part) => {
                part.fields.iter().for_each(|(field, tree)| tree.reach(&quote!(#way.#field), accesses));
            }
        }
    }

    /// The places of the values, in the order of the tree.
    pub(in crate::emit) fn leaves(&self, places: &mut Vec<usize>) {
        match self {
            Tree::Leaf(place) => places.push(*place),
            Tree::Array(entries) => entries.iter().for_each(|entry| entry.leaves(places)),
            Tree::Instance(part) => part.fields.iter().for_each(|(_, tree)| tree.leaves(places)),
        }
    }

    /// The place of the first value.
    pub(in crate::emit) fn first(&self) -> Option<usize> {
        let mut places = Vec::new();
        self.leaves(&mut places);
        places.first().copied()
    }

    /// The type, from that of a value.
    pub(in crate::emit) fn of_type(&self, leaf: &TokenStream) -> TokenStream {
        match self {
            Tree::Leaf(_) => leaf.clone(),
            Tree::Array(entries) => {
                let count = entries.len();
                let inner = entries.first().map_or_else(|| leaf.clone(), |entry| entry.of_type(leaf));
                quote!([#inner; #count])
            }
            Tree::Instance(part) => part.of_type(&TokenStream::new()),
        }
    }

    /// The value from an expression for each leaf.
    pub(in crate::emit) fn literal(&self, values: &dyn Fn(usize) -> TokenStream) -> TokenStream {
        match self {
            Tree::Leaf(place) => values(*place),
            Tree::Array(entries) => {
                let entries = entries.iter().map(|entry| entry.literal(values));
                quote!([#(#entries),*])
            }
            Tree::Instance(part) => {
                let path = part.path(&part.level);
                let fields = part.fields.iter().map(|(ident, tree)| {
                    let value = tree.literal(values);
                    quote!(#ident: #value)
                });
                let marker = part.has_marker.then(|| quote!(, real: ::core::marker::PhantomData));
                quote!(#path { #(#fields),* #marker })
            }
        }
    }

    /// A literal with one value everywhere, whatever the length.
    pub(in crate::emit) fn filled(&self, value: &TokenStream) -> TokenStream {
        match self {
            Tree::Leaf(_) => value.clone(),
            Tree::Array(entries) => {
                let inner = entries.first().map_or_else(|| value.clone(), |entry| entry.filled(value));
                quote!(::core::array::from_fn(|_| #inner))
            }
            Tree::Instance(part) => {
                let path = part.path(&part.level);
                let fields = part.fields.iter().map(|(ident, tree)| {
                    let value = tree.filled(value);
                    quote!(#ident: #value)
                });
                quote!(#path { #(#fields),* })
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
            Tree::Instance(part) => {
                let fields = part.fields.iter().map(|(ident, tree)| {
                    let (name, shape) = (plain(ident), tree.shape());
                    quote!((#name, #shape))
                });
                quote!(__guen::Shape::Struct(&[#(#fields),*]))
            }
        }
    }
}

/// The way out of some modules.
pub(super) fn outward(depth: usize) -> TokenStream {
    (0..depth).flat_map(|_| quote!(super::)).collect()
}

impl Part {
    /// Whether both have the same fields.
    pub(super) fn is_like(&self, other: &Part) -> bool {
        Tree::Instance(self.clone()).is_like(&Tree::Instance(other.clone()))
    }

    /// The struct, where the level is further out by some `super::`.
    fn path(&self, outer: &TokenStream) -> TokenStream {
        let (module, record) = (&self.module, quote::format_ident!("{}", self.record));
        quote!(#outer #(#module::)* #record)
    }

    fn of_type(&self, outer: &TokenStream) -> TokenStream {
        let outer = if outer.is_empty() { &self.level } else { outer };
        let (path, real) = (self.path(outer), &self.real);
        let kinds = &self.kinds;
        let real = real.as_ref().map(|real| quote!(<#real #(, #kinds)*>));
        quote!(#path #real)
    }
}

/// An identifier without `r#`.
pub(in crate::emit) fn plain(ident: &Ident) -> String {
    ident.to_string().trim_start_matches("r#").to_owned()
}
