//! Functions that the program supplies, in generated types: a parameter for each.
//!
//! The items of a level are emitted as if it had none. Where it has some, [`Supplied::spread`] adds their parameters to every type that
//! holds them, and to the implementations in whose heads such a type stands. Other systems do not pay for them.

use proc_macro2::{Delimiter, Group, Ident, Literal, Punct, Spacing, Span, TokenStream, TokenTree};
use quote::quote;

use super::documentation;
use crate::model::Model;

/// The macros of the runtime that name a type with parameters.
const MACROS: [&str; 13] = [
    "actuated",
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
    "state_of_system",
    "with_scalar",
];

/// A function that the program supplies.
struct Function {
    field: Ident,
    /// The parameter of types.
    kind: Ident,
    /// The number of its arguments.
    arguments: usize,
    docs: TokenStream,
}

/// The functions that the program supplies, as fields and as parameters of types.
pub(super) struct Supplied {
    functions: Vec<Function>,
    /// The types that have the parameters.
    types: Vec<String>,
}

impl Supplied {
    /// The functions of a system.
    pub(super) fn new(model: &Model<'_>) -> Self {
        let declaration = model.declaration;
        let scenes = model.scenes.iter().map(|entry| &entry.scene.name.ident);
        let systems: Vec<String> = scenes.chain([&declaration.name.ident]).map(ToString::to_string).collect();
        let mut taken = systems.clone();
        let functions = model.functions.iter().map(|function| {
            let name = &function.name;
            let mut kind = format!("{}Function", camel(&name.text));
            while taken.contains(&kind) {
                kind.push('_');
            }
            taken.push(kind.clone());
            let arguments: Vec<&str> = function.arguments.iter().map(|name| name.text.as_str()).collect();
            let fallback = format!("The function `{name}({})`.", arguments.join(", "));
            Function {
                field: name.ident.clone(),
                kind: Ident::new(&kind, Span::call_site()),
                arguments: arguments.len(),
                docs: documentation::entry(&function.docs, &fallback, None),
            }
        });
        let functions: Vec<Function> = functions.collect();
        let own = ["Prepared", "Driven", "__guen_system"].map(str::to_owned);
        Supplied { functions, types: own.into_iter().chain(systems).collect() }
    }

    /// Whether there are none.
    pub(super) fn is_empty(&self) -> bool {
        self.functions.is_empty()
    }

    /// The parameters in the declaration of a type, with defaults: constant functions.
    pub(super) fn declared(&self) -> TokenStream {
        let kinds = self.functions.iter().map(|function| &function.kind);
        quote!(#(, #kinds = ::core::primitive::f64)*)
    }

    /// The parameters of a type behind its real.
    pub(super) fn arguments(&self) -> TokenStream {
        let kinds = self.functions.iter().map(|function| &function.kind);
        quote!(#(, #kinds)*)
    }

    /// The parameters of an implementation or function, with their bounds, each behind a comma.
    pub(super) fn parameters(&self) -> TokenStream {
        let parameters = self.functions.iter().map(|Function { kind, arguments, .. }| {
            let arguments = Literal::usize_unsuffixed(*arguments);
            quote!(, #kind: __guen::Smooth<#arguments>)
        });
        parameters.collect()
    }

    /// The fields of a struct.
    pub(super) fn fields(&self) -> TokenStream {
        let fields =
            self.functions.iter().map(|Function { field, kind, docs, .. }| quote!(#docs pub #field: #kind,));
        fields.collect()
    }

    /// The fields of a literal, out of those of another struct.
    pub(super) fn taken(&self, of: &TokenStream) -> TokenStream {
        self.functions.iter().map(|Function { field, .. }| quote!(#field: #of.#field,)).collect()
    }

    /// The fields of a literal, out of the prepared values at `of`.
    pub(super) fn prepared(&self, of: &TokenStream) -> TokenStream {
        let fields = self.functions.iter().enumerate().map(|(i, Function { field, .. })| {
            let i = Literal::usize_unsuffixed(i);
            quote!(#field: #of.functions.#i,)
        });
        fields.collect()
    }

    /// The functions as arguments of a constructor, and as fields of a literal from them.
    pub(super) fn given(&self) -> (Vec<TokenStream>, TokenStream) {
        let arguments = self.functions.iter().map(|Function { field, kind, .. }| quote!(#field: #kind));
        let fields = self.functions.iter().map(|Function { field, .. }| quote!(#field,));
        (arguments.collect(), fields.collect())
    }

    /// The names of the fields.
    pub(super) fn names(&self) -> Vec<String> {
        self.functions.iter().map(|function| function.field.to_string()).collect()
    }

    /// The parameters with a further bound, for an implementation.
    pub(super) fn bounded(&self, bound: &TokenStream) -> TokenStream {
        let parameters = self.functions.iter().map(|Function { kind, arguments, .. }| {
            let arguments = Literal::usize_unsuffixed(*arguments);
            quote!(#kind: __guen::Smooth<#arguments> + #bound,)
        });
        parameters.collect()
    }

    /// A default for each.
    pub(super) fn defaults(&self) -> Vec<TokenStream> {
        self.functions.iter().map(|_| quote!(::core::default::Default::default())).collect()
    }

    /// The type of the prepared values, `[R; count]` where there is no function.
    pub(super) fn hoisted(&self, count: usize) -> TokenStream {
        if self.is_empty() {
            return quote!([R; #count]);
        }
        let kinds = self.functions.iter().map(|function| &function.kind);
        quote!(__guen::Hoisted<R, #count, (#(#kinds,)*)>)
    }

    /// The functions in lanes: of each lane its own, in a tuple, and their types behind commas.
    pub(super) fn in_lanes(&self, member: &TokenStream) -> (TokenStream, TokenStream) {
        let functions = self.functions.iter().enumerate().map(|(i, Function { arguments, .. })| {
            let (i, n) = (Literal::usize_unsuffixed(i), Literal::usize_unsuffixed(*arguments));
            quote! {
                __guen::EachLane::gathered::<#n>(<L as __guen::Lanes>::COUNT, |lane| #member.hoisted.functions.#i),
            }
        });
        let kinds = self.functions.iter().map(|function| &function.kind);
        (quote!((#(#functions)*)), quote!(#(, __guen::EachLane<#kinds>)*))
    }

    /// The functions as macros of the runtime take them: the field, the parameter and the number of arguments of each.
    pub(super) fn list(&self) -> TokenStream {
        let list = self.functions.iter().map(|Function { field, kind, arguments, .. }| {
            let arguments = Literal::usize_unsuffixed(*arguments);
            quote!(#field #kind #arguments)
        });
        quote!([#(#list)*])
    }

    /// Adds the parameters to the types that hold functions and to their implementations.
    pub(super) fn spread(&self, items: TokenStream) -> TokenStream {
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

/// A name in camel case: `rolling_drag` gives `RollingDrag`.
fn camel(name: &str) -> String {
    // A faulty component may have put the function of an instance here; an identifier has none of these.
    let words = name.split(['_', '.', '[', ']', '#']).filter(|word| !word.is_empty());
    words
        .map(|word| {
            let mut letters = word.chars();
            letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
        })
        .collect()
}
