//! Long arrays in code: it goes through them by number, and does not name their entries one by one.

use std::ops::Range;

use proc_macro2::{Ident, TokenStream};
use quote::quote;

use super::{Fields, Tree};
use crate::emit::thresholds::LONG_ARRAY;

/// A value of a struct, as code speaks of it; of a long array every entry at once, by the number `__guen_i` of the entry.
pub(in crate::emit) struct Entry {
    /// The place in the list of values, of a long array that of its first entry.
    pub(in crate::emit) place: usize,
    /// The place as code.
    pub(in crate::emit) index: TokenStream,
    /// The way to the value behind the point.
    pub(in crate::emit) access: TokenStream,
}

/// Values that code speaks of together.
struct Group {
    /// The places of the values.
    places: Range<usize>,
    /// The array that these are, where it is long.
    array: Option<Ident>,
}

impl Fields {
    /// The values in the order of the fields, long arrays together, except those with values that are told apart.
    fn groups(&self, is_apart: &dyn Fn(usize) -> bool) -> Vec<Group> {
        let mut groups = Vec::new();
        for (ident, tree) in &self.fields {
            let mut places = Vec::new();
            tree.leaves(&mut places);
            match tree.long_run(is_apart) {
                Some(run) => groups.push(Group { places: run, array: Some(ident.clone()) }),
                None => groups.extend(places.into_iter().map(|k| Group { places: k..k + 1, array: None })),
            }
        }
        groups
    }

    /// An array of expressions for the constants, or for all values of a record. `is_apart` tells values that are not written as the others
    /// of their array.
    pub(in crate::emit) fn list(
        &self,
        is_apart: &dyn Fn(usize) -> bool,
        value: &dyn Fn(&Entry) -> TokenStream,
    ) -> TokenStream {
        let mut groups = self.groups(is_apart);
        groups.retain(|group| group.places.end <= self.constants());
        groups.sort_by_key(|group| group.places.start);
        self.listed(&groups, value)
    }

    /// An array of expressions for the values in the order of the fields.
    pub(in crate::emit) fn list_of_fields(
        &self,
        is_apart: &dyn Fn(usize) -> bool,
        value: &dyn Fn(&Entry) -> TokenStream,
    ) -> TokenStream {
        self.listed(&self.groups(is_apart), value)
    }

    fn listed(&self, groups: &[Group], value: &dyn Fn(&Entry) -> TokenStream) -> TokenStream {
        if groups.iter().all(|group| group.array.is_none()) {
            let values = groups.iter().map(|group| value(&self.entry(group.places.start)));
            return quote!([#(#values),*]);
        }
        let mut before = 0_usize;
        let arms = groups.iter().map(|Group { places, array }| {
            let (from, to) = (before, before + places.len() - 1);
            before = to + 1;
            let value = match array {
                None => value(&self.entry(places.start)),
                Some(array) => {
                    let at = if from == 0 { quote!(__guen_i) } else { quote!(__guen_i - #from) };
                    let index = shifted(places.start as i64 - from as i64);
                    value(&Entry { place: places.start, index, access: quote!(#array[#at]) })
                }
            };
            (if from == to { quote!(#from) } else { quote!(#from..=#to) }, value)
        });
        by_number(arms.collect())
    }

    /// The names of the values as the macro `names!` of the runtime takes them.
    pub(in crate::emit) fn names_of_values(&self) -> TokenStream {
        let groups = self.groups(&|_| false);
        let name = |group: &&Group| self.names[group.places.start].clone();
        if groups.iter().all(|group| group.array.is_none()) {
            let names = &self.names;
            return quote!(#(#names)*);
        }
        let (long, single): (Vec<&Group>, Vec<&Group>) =
            groups.iter().partition(|group| group.array.is_some());
        let names: Vec<String> = single.iter().map(name).collect();
        let places = single.iter().map(|group| group.places.start);
        let long = long.iter().map(|group| {
            let (from, count) = (group.places.start, group.places.len());
            let last = &self.names[group.places.end - 1];
            let before = last.rfind('[').map_or("", |at| &last[..=at]);
            let length = last.len();
            quote!(#from #count #length #before)
        });
        quote!({ #(#places #names)* } #(#long)*)
    }

    fn entry(&self, place: usize) -> Entry {
        Entry { place, index: quote!(#place), access: self.access(place).clone() }
    }

    /// The fields of a literal of the struct, without its braces, from an expression for each constant, or for each value of a record, and
    /// the functions of the struct.
    pub(in crate::emit) fn literal_of(
        &self,
        is_apart: &dyn Fn(usize) -> bool,
        value: &dyn Fn(&Entry) -> TokenStream,
        functions: impl IntoIterator<Item = TokenStream>,
    ) -> TokenStream {
        let functions: Vec<TokenStream> = functions.into_iter().collect();
        let of_place = |place: usize| match self.function(place) {
            Some(function) => functions[function].clone(),
            None => value(&self.entry(place)),
        };
        let fields = self.fields.iter().map(|(ident, tree)| {
            let content = match tree.long_run(is_apart) {
                Some(run) => {
                    let index = shifted(run.start as i64);
                    let value = value(&Entry { place: run.start, index, access: quote!(#ident[__guen_i]) });
                    quote!(::core::array::from_fn(|__guen_i| #value))
                }
                None => tree.literal(&of_place),
            };
            quote!(#ident: #content,)
        });
        quote!(#(#fields)*)
    }
}

impl Tree {
    /// The places of an array of values that stand one behind the other.
    pub(in crate::emit) fn run(&self) -> Option<Range<usize>> {
        let Tree::Array(entries) = self else { return None };
        let first = match entries.first()? {
            Tree::Leaf(first) => *first,
            _ => return None,
        };
        let mut places = entries.iter().zip(first..);
        places
            .all(|(entry, at)| matches!(entry, Tree::Leaf(place) if *place == at))
            .then(|| first..first + entries.len())
    }

    /// The places of a long array of values of which none is told apart.
    pub(in crate::emit) fn long_run(&self, is_apart: &dyn Fn(usize) -> bool) -> Option<Range<usize>> {
        self.run().filter(|run| run.len() >= LONG_ARRAY && !run.clone().any(is_apart))
    }
}

/// An array from an expression for the numbers `__guen_i` of each pattern; the last of these are all that are left.
pub(in crate::emit) fn by_number(mut arms: Vec<(TokenStream, TokenStream)>) -> TokenStream {
    let Some((_, last)) = arms.pop() else { return quote!([]) };
    if arms.is_empty() {
        return quote!(::core::array::from_fn(|__guen_i| #last));
    }
    let arms = arms.iter().map(|(numbers, value)| quote!(#numbers => #value));
    quote!(::core::array::from_fn(|__guen_i| match __guen_i { #(#arms,)* _ => #last }))
}

/// The number `__guen_i` of an entry and a distance.
fn shifted(distance: i64) -> TokenStream {
    let size = distance.unsigned_abs() as usize;
    match distance {
        0 => quote!(__guen_i),
        1.. => quote!(__guen_i + #size),
        _ => quote!(__guen_i - #size),
    }
}
