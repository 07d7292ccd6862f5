//! Functions that the program supplies, in generated types: a parameter for each.
//!
//! The items of a level are emitted as if it had none. Where it has some, [`Supplied::spread`] adds their parameters to every type that
//! holds them, and to the implementations in whose heads such a type stands. Other systems do not pay for them.

use proc_macro2::{Delimiter, Group, Ident, Literal, Punct, Spacing, Span, TokenStream, TokenTree};
use quote::quote;

use super::fields::{Fields, template};
use crate::emit::documentation;
use crate::model::Model;
use crate::syntax::{Name, Step};

/// The macros of the runtime that name a type with parameters.
const MACROS: [&str; 15] = [
    "actuated",
    "copied",
    "differentiable",
    "held_through_modes",
    "linearizable",
    "monitored",
    "operators",
    "output_map",
    "prepare",
    "prepared",
    "simulated",
    "simulated_through_modes",
    "sourced",
    "state_of_system",
    "with_scalar",
];

/// A function that the program supplies.
struct Function {
    /// The way to its field: `left.torque` for that of an instance.
    name: Name,
    /// The place of its parameter of types among all of them.
    kind: usize,
    docs: TokenStream,
}

/// A parameter of types: the functions of an array of instances share one.
struct Kind {
    parameter: Ident,
    /// The number of arguments of the functions.
    arguments: usize,
    /// The name of the first function without numbers of indices.
    template: String,
}

/// The functions that the program supplies, as fields and as parameters of types.
pub(in crate::emit) struct Supplied {
    functions: Vec<Function>,
    /// The parameters of types, in the order of the fields.
    kinds: Vec<Kind>,
    /// The types that have the parameters.
    types: Vec<String>,
}

impl Supplied {
    /// The functions of a system.
    pub(in crate::emit) fn new(model: &Model<'_>) -> Self {
        let declaration = model.declaration;
        let scenes = model.scenes.iter().map(|entry| &entry.scene.name.ident);
        let systems: Vec<String> = scenes.chain([&declaration.name.ident]).map(ToString::to_string).collect();
        let mut taken = systems.clone();
        let mut kinds: Vec<Kind> = Vec::new();
        let functions = model.functions.iter().map(|function| {
            let name = &function.name;
            let arguments: Vec<&str> = function.arguments.iter().map(|name| name.text.as_str()).collect();
            let template = template(name);
            let known = kinds.iter().position(|kind| kind.template == template);
            let kind = known.unwrap_or_else(|| {
                let mut text = format!("{}Function", camel(&template));
                while taken.contains(&text) {
                    text.push('_');
                }
                taken.push(text.clone());
                let parameter = Ident::new(&text, Span::call_site());
                kinds.push(Kind { parameter, arguments: arguments.len(), template });
                kinds.len() - 1
            });
            let own = match name.path().and_then(|path| path.steps.last()) {
                Some(Step::Field(field)) => super::fields::plain(field),
                _ => name.text.clone(),
            };
            let fallback = format!("The function `{own}({})`.", arguments.join(", "));
            Function { name: name.clone(), kind, docs: documentation::entry(&function.docs, &fallback, None) }
        });
        let functions: Vec<Function> = functions.collect();
        let own = ["Prepared", "Driven", "__guen_system"].map(str::to_owned);
        let supplied = Supplied { functions, kinds, types: own.into_iter().chain(systems).collect() };
        supplied.in_the_order_of_fields(model)
    }

    /// The parameters as the fields of the struct of constants have them.
    fn in_the_order_of_fields(mut self, model: &Model<'_>) -> Self {
        if self.kinds.len() < 2 {
            return self;
        }
        let names: Vec<&Name> = model.constants.iter().map(|constant| constant.name).collect();
        let structure = Fields::new(names.iter().copied().chain(self.names()));
        let places = structure.order().into_iter().filter_map(|place| place.checked_sub(names.len()));
        let mut order: Vec<usize> = Vec::new();
        for kind in places.map(|place| self.functions[place].kind) {
            if !order.contains(&kind) {
                order.push(kind);
            }
        }
        let rank = |kind: usize| order.iter().position(|other| *other == kind).unwrap_or(kind);
        self.functions.iter_mut().for_each(|function| function.kind = rank(function.kind));
        let mut kinds: Vec<(usize, Kind)> =
            self.kinds.into_iter().enumerate().map(|(kind, entry)| (rank(kind), entry)).collect();
        kinds.sort_by_key(|(rank, _)| *rank);
        self.kinds = kinds.into_iter().map(|(_, kind)| kind).collect();
        self
    }

    /// Whether there are none.
    pub(in crate::emit) fn is_empty(&self) -> bool {
        self.functions.is_empty()
    }

    /// The parameters of types, in their order.
    fn parameter_names(&self) -> impl Iterator<Item = &Ident> {
        self.kinds.iter().map(|kind| &kind.parameter)
    }

    /// The parameters of types, in a list.
    pub(in crate::emit) fn parameter_list(&self) -> Vec<Ident> {
        self.parameter_names().cloned().collect()
    }

    /// The parameters in the declaration of a type, with defaults: constant functions.
    pub(in crate::emit) fn declared(&self) -> TokenStream {
        let kinds = self.parameter_names();
        quote!(#(, #kinds = ::core::primitive::f64)*)
    }

    /// The parameters of a type behind its real.
    pub(in crate::emit) fn arguments(&self) -> TokenStream {
        let kinds = self.parameter_names();
        quote!(#(, #kinds)*)
    }

    /// The parameters of an implementation or function, with their bounds, each behind a comma.
    pub(in crate::emit) fn parameters(&self) -> TokenStream {
        let parameters = self.kinds.iter().map(|Kind { parameter, arguments, .. }| {
            let arguments = Literal::usize_unsuffixed(*arguments);
            quote!(, #parameter: __guen::Smooth<#arguments>)
        });
        parameters.collect()
    }

    /// The parameter of types of each function.
    pub(in crate::emit) fn kinds(&self) -> Vec<Ident> {
        self.functions.iter().map(|function| self.kinds[function.kind].parameter.clone()).collect()
    }

    /// The fields of a struct of constants, with these functions behind them.
    pub(in crate::emit) fn behind<'a>(&'a self, constants: impl IntoIterator<Item = &'a Name>) -> Fields {
        Fields::of_constants(constants.into_iter().chain(self.names()), &self.kinds())
    }

    /// The documentation of the field of a function.
    pub(in crate::emit) fn docs(&self, function: usize) -> &TokenStream {
        &self.functions[function].docs
    }

    /// The functions in a tuple, out of the fields of a struct whose ways to all values these are.
    pub(in crate::emit) fn tuple(&self, structure: &Fields, of: &TokenStream) -> TokenStream {
        tuple(self.taken(structure, of))
    }

    /// The functions out of the fields of a struct.
    pub(in crate::emit) fn taken(&self, structure: &Fields, of: &TokenStream) -> Vec<TokenStream> {
        let ways = &structure.accesses()[structure.len() - self.functions.len()..];
        ways.iter().map(|way| quote!(#of.#way)).collect()
    }

    /// The functions out of the prepared values at `of`.
    pub(in crate::emit) fn prepared(&self, of: &TokenStream) -> Vec<TokenStream> {
        (0..self.functions.len())
            .map(|i| {
                let place = self.place(i);
                quote!(#of.functions #place)
            })
            .collect()
    }

    /// The way to a function in the tuple, behind its name.
    fn place(&self, function: usize) -> TokenStream {
        let steps = steps(function, self.functions.len()).into_iter();
        steps.map(Literal::usize_unsuffixed).flat_map(|step| quote!(.#step)).collect()
    }

    /// The names, which are the ways to the fields.
    pub(in crate::emit) fn names(&self) -> impl Iterator<Item = &Name> {
        self.functions.iter().map(|function| &function.name)
    }

    /// The parameters with a further bound, for an implementation.
    pub(in crate::emit) fn bounded(&self, bound: &TokenStream) -> TokenStream {
        let parameters = self.kinds.iter().map(|Kind { parameter, arguments, .. }| {
            let arguments = Literal::usize_unsuffixed(*arguments);
            quote!(#parameter: __guen::Smooth<#arguments> + #bound,)
        });
        parameters.collect()
    }

    /// The type of the prepared values, `[R; count]` where there is no function.
    pub(in crate::emit) fn hoisted(&self, count: usize) -> TokenStream {
        if self.is_empty() {
            return quote!([R; #count]);
        }
        let members = self.members();
        quote!(__guen::Hoisted<R, #count, #members>)
    }

    /// The type of the tuple of functions.
    pub(in crate::emit) fn members(&self) -> TokenStream {
        tuple(self.kinds().iter().map(|kind| quote!(#kind)).collect())
    }

    /// The functions in lanes: of each lane its own, in a tuple, and their types behind commas.
    pub(in crate::emit) fn in_lanes(&self, member: &TokenStream) -> (TokenStream, TokenStream) {
        let functions = self.functions.iter().enumerate().map(|(i, function)| {
            let arguments = self.kinds[function.kind].arguments;
            let (place, n) = (self.place(i), Literal::usize_unsuffixed(arguments));
            quote! {
                __guen::EachLane::gathered::<#n>(<L as __guen::Lanes>::COUNT, |lane| #member.hoisted.functions #place)
            }
        });
        let kinds = self.parameter_names();
        (tuple(functions.collect()), quote!(#(, __guen::EachLane<#kinds>)*))
    }

    /// The parameters of types as macros of the runtime take them, each with the number of arguments of its functions.
    pub(in crate::emit) fn list(&self) -> TokenStream {
        let list = self.kinds.iter().map(|Kind { parameter, arguments, .. }| {
            let arguments = Literal::usize_unsuffixed(*arguments);
            quote!(#parameter #arguments)
        });
        quote!([#(#list)*])
    }

    /// Adds the parameters to the types that hold functions and to their implementations.
    pub(in crate::emit) fn spread(&self, items: TokenStream) -> TokenStream {
        if self.is_empty() { items } else { self.spread_over(items) }
    }

    fn spread_over(&self, tokens: TokenStream) -> TokenStream {
        let tokens: Vec<TokenTree> = tokens.into_iter().collect();
        let mut spread = Vec::with_capacity(tokens.len());
        // The place behind which parameters of an implementation are, and the places behind which a type ends.
        let mut heads = Vec::new();
        let mut ends = Vec::new();
        for (place, token) in tokens.iter().enumerate() {
            if is_word(token, "impl")
                && let Some(head) = self.head(&tokens, place)
            {
                heads.push(head);
            }
            if self.is_type(&tokens, place)
                && let Some(end) = closing(&tokens, place + 1)
                && !tokens[place + 1..end].iter().any(|token| is_word(token, "EachLane"))
            {
                ends.push(end);
            }
        }
        for (place, token) in tokens.iter().enumerate() {
            if ends.contains(&place) {
                spread.extend(self.arguments());
            }
            match heads.iter().find(|head| head.place == place) {
                Some(Head { is_list: true, .. }) => spread.extend(self.parameters()),
                Some(Head { is_list: false, .. }) => {
                    // Without the comma in front.
                    spread.push(punct('<'));
                    spread.extend(self.parameters().into_iter().skip(1));
                    spread.push(punct('>'));
                }
                None => {}
            }
            spread.push(match token {
                TokenTree::Group(group) => {
                    let mut inside = self.spread_over(group.stream());
                    if is_call(&tokens, place) {
                        inside = self.list().into_iter().chain(inside).collect();
                    }
                    let mut own = Group::new(group.delimiter(), inside);
                    own.set_span(group.span());
                    TokenTree::Group(own)
                }
                other => other.clone(),
            });
        }
        spread.into_iter().collect()
    }

    /// Whether a type that holds functions is named at a place, with its real behind it.
    fn is_type(&self, tokens: &[TokenTree], place: usize) -> bool {
        let TokenTree::Ident(ident) = &tokens[place] else { return false };
        let is_path = place >= 2 && [1, 2].iter().all(|back| is_punct(&tokens[place - back], ':'));
        let is_outer = place >= 3 && is_word(&tokens[place - 3], "super");
        let is_declared = place > 0 && is_word(&tokens[place - 1], "struct");
        tokens.get(place + 1).is_some_and(|token| is_punct(token, '<'))
            && self.types.iter().any(|known| ident == known)
            && (!is_path || is_outer)
            && !is_declared
    }

    /// The place for the parameters of an implementation whose head names such a type: in front of the `>` of its own
    /// parameters, or behind `impl` if it has none.
    fn head(&self, tokens: &[TokenTree], place: usize) -> Option<Head> {
        let body = tokens[place..].iter().position(
            |token| matches!(token, TokenTree::Group(group) if group.delimiter() == Delimiter::Brace),
        )?;
        let mut head = place + 1..place + body;
        if !head.any(|place| self.is_type(tokens, place)) {
            return None;
        }
        Some(match tokens.get(place + 1).is_some_and(|token| is_punct(token, '<')) {
            true => Head { place: closing(tokens, place + 1)?, is_list: true },
            false => Head { place: place + 1, is_list: false },
        })
    }
}

/// The place for the parameters of an implementation.
struct Head {
    place: usize,
    /// Whether they stand among others.
    is_list: bool,
}

/// The place of the `>` that closes the `<` at a place.
fn closing(tokens: &[TokenTree], open: usize) -> Option<usize> {
    let mut depth = 0_usize;
    for (place, token) in tokens.iter().enumerate().skip(open) {
        if is_punct(token, '<') {
            depth += 1;
        } else if is_punct(token, '>')
            && !is_punct(&tokens[place - 1], '-')
            && !is_punct(&tokens[place - 1], '=')
        {
            depth -= 1;
            if depth == 0 {
                return Some(place);
            }
        }
    }
    None
}

/// Whether the group at a place holds the arguments of a macro of the runtime that takes functions.
fn is_call(tokens: &[TokenTree], place: usize) -> bool {
    place >= 2
        && is_punct(&tokens[place - 1], '!')
        && MACROS.iter().any(|known| is_word(&tokens[place - 2], known))
}

fn is_word(token: &TokenTree, word: &str) -> bool {
    matches!(token, TokenTree::Ident(ident) if ident == word)
}

fn is_punct(token: &TokenTree, mark: char) -> bool {
    matches!(token, TokenTree::Punct(punct) if punct.as_char() == mark)
}

fn punct(mark: char) -> TokenTree {
    TokenTree::Punct(Punct::new(mark, Spacing::Alone))
}

/// The most members of a tuple: of longer ones the library of Rust knows neither equality nor text.
const MEMBERS: usize = 8;

/// A tuple; where there are many members, a tuple of tuples.
fn tuple(members: Vec<TokenStream>) -> TokenStream {
    if members.len() <= MEMBERS {
        return quote!((#(#members,)*));
    }
    tuple(members.chunks(MEMBERS).map(|chunk| tuple(chunk.to_vec())).collect())
}

/// The indices that lead to a member of such a tuple of so many.
pub(in crate::emit) fn steps(member: usize, of: usize) -> Vec<usize> {
    if of <= MEMBERS {
        return vec![member];
    }
    let mut steps = steps(member / MEMBERS, of.div_ceil(MEMBERS));
    steps.push(member % MEMBERS);
    steps
}

/// A name in camel case: `rolling_drag` gives `RollingDrag`.
fn camel(name: &str) -> String {
    // The function of an instance is a path; an identifier has none of these.
    let words = name.split(['_', '.', '[', ']', '#']).filter(|word| !word.is_empty());
    words
        .map(|word| {
            let mut letters = word.chars();
            letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
        })
        .collect()
}
