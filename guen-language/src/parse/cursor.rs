//! A position in a list of tokens, with the few questions that the parsers ask of what comes next.

use proc_macro2::{Delimiter, Group, Ident, Spacing, Span, TokenStream, TokenTree};

use crate::names::is_rust_keyword;
use crate::syntax::SectionKind;

/// A position in the tokens of one group.
pub(crate) struct Cursor {
    tokens: Vec<TokenTree>,
    at: usize,
    end: Span,
    /// Whether the words that begin a section are landmarks here: true directly inside of `system Name { .. }`.
    has_sections: bool,
}

impl Cursor {
    /// Creates a cursor at the beginning of a stream that ends at a place.
    pub(crate) fn new(stream: TokenStream, end: Span) -> Self {
        Cursor { tokens: stream.into_iter().collect(), at: 0, end, has_sections: false }
    }

    /// Creates a cursor at the beginning of what a group holds.
    pub(crate) fn inside(group: &Group) -> Self {
        let end = if group.delimiter() == Delimiter::None { group.span() } else { group.span_close() };
        Cursor::new(group.stream(), end)
    }

    /// Creates a cursor at the beginning of what the braces of a system hold.
    pub(crate) fn inside_system(group: &Group) -> Self {
        Cursor { has_sections: true, ..Cursor::inside(group) }
    }

    pub(crate) fn peek(&self) -> Option<&TokenTree> {
        self.tokens.get(self.at)
    }

    pub(crate) fn peek_nth(&self, n: usize) -> Option<&TokenTree> {
        self.tokens.get(self.at + n)
    }

    pub(crate) fn is_end(&self) -> bool {
        self.at >= self.tokens.len()
    }

    pub(crate) fn position(&self) -> usize {
        self.at
    }

    /// Place of the next token, or of the end.
    pub(crate) fn span(&self) -> Span {
        self.peek().map_or(self.end, span_of)
    }

    /// Place of the token before, or of the next one where there is none.
    pub(crate) fn span_before(&self) -> Span {
        match self.at.checked_sub(1).and_then(|before| self.tokens.get(before)) {
            Some(TokenTree::Group(group)) if group.delimiter() != Delimiter::None => group.span_close(),
            Some(token) => token.span(),
            None => self.span(),
        }
    }

    /// The next token for a message.
    pub(crate) fn found(&self) -> String {
        match self.peek() {
            None => "the end".to_owned(),
            Some(TokenTree::Group(group)) => match group.delimiter() {
                Delimiter::Parenthesis => "`(`".to_owned(),
                Delimiter::Brace => "`{`".to_owned(),
                Delimiter::Bracket => "`[`".to_owned(),
                Delimiter::None => format!("`{}`", shortened(&group.stream().to_string())),
            },
            Some(TokenTree::Punct(_)) => {
                // Operators such as `==` and `+=` come in pieces.
                let mut text = String::new();
                for token in &self.tokens[self.at..] {
                    let TokenTree::Punct(punct) = token else { break };
                    if !text.is_empty() && matches!(punct.as_char(), ';' | ',' | '-') {
                        break;
                    }
                    text.push(punct.as_char());
                    if punct.spacing() == Spacing::Alone {
                        break;
                    }
                }
                format!("`{text}`")
            }
            Some(TokenTree::Ident(ident)) if is_rust_keyword(&ident.to_string()) => {
                format!("keyword `{ident}`")
            }
            Some(token) => format!("`{}`", shortened(&token.to_string())),
        }
    }

    pub(crate) fn next(&mut self) -> Option<TokenTree> {
        let token = self.tokens.get(self.at).cloned();
        self.at += usize::from(token.is_some());
        token
    }

    pub(crate) fn skip(&mut self, count: usize) {
        self.at = (self.at + count).min(self.tokens.len());
    }

    /// Whether the token `n` places ahead is this mark.
    pub(crate) fn is_punct_at(&self, n: usize, mark: char) -> bool {
        matches!(self.peek_nth(n), Some(TokenTree::Punct(punct)) if punct.as_char() == mark)
    }

    pub(crate) fn is_punct(&self, mark: char) -> bool {
        self.is_punct_at(0, mark)
    }

    /// Whether the next two tokens are these marks without a space between them.
    pub(crate) fn is_pair(&self, first: char, second: char) -> bool {
        matches!(self.peek(), Some(TokenTree::Punct(punct))
            if punct.as_char() == first && punct.spacing() == Spacing::Joint)
            && self.is_punct_at(1, second)
    }

    pub(crate) fn eat(&mut self, mark: char) -> Option<Span> {
        if !self.is_punct(mark) {
            return None;
        }
        let span = self.span();
        self.skip(1);
        Some(span)
    }

    pub(crate) fn ident_at(&self, n: usize) -> Option<&Ident> {
        match self.peek_nth(n) {
            Some(TokenTree::Ident(ident)) => Some(ident),
            _ => None,
        }
    }

    /// Whether the token `n` places ahead is this word.
    pub(crate) fn is_word_at(&self, n: usize, word: &str) -> bool {
        self.ident_at(n).is_some_and(|ident| ident == word)
    }

    pub(crate) fn is_word(&self, word: &str) -> bool {
        self.is_word_at(0, word)
    }

    pub(crate) fn eat_word(&mut self, word: &str) -> Option<Span> {
        if !self.is_word(word) {
            return None;
        }
        let span = self.span();
        self.skip(1);
        Some(span)
    }

    pub(crate) fn group_at(&self, n: usize, delimiter: Delimiter) -> Option<&Group> {
        match self.peek_nth(n) {
            Some(TokenTree::Group(group)) if group.delimiter() == delimiter => Some(group),
            _ => None,
        }
    }

    pub(crate) fn eat_group(&mut self, delimiter: Delimiter) -> Option<Group> {
        let group = self.group_at(0, delimiter)?.clone();
        self.skip(1);
        Some(group)
    }

    /// The number of tokens of a name here: two where an index stands behind it.
    pub(crate) fn name_length(&self) -> usize {
        1 + usize::from(self.group_at(1, Delimiter::Bracket).is_some())
    }

    /// Replaces an invisible group, as a fragment of `macro_rules!` leaves it, by what it holds. For places where
    /// a group cannot mean parentheses.
    pub(crate) fn open_invisible(&mut self) {
        while let Some(group) = self.group_at(0, Delimiter::None) {
            let stream = group.stream();
            self.tokens.splice(self.at..=self.at, stream);
        }
    }

    /// Whether a section of a system begins here.
    pub(crate) fn starts_section(&self) -> bool {
        let Some(ident) = self.ident_at(0).filter(|_| self.has_sections) else { return false };
        match SectionKind::of_word(&ident.to_string()) {
            None => false,
            Some(SectionKind::Use) => self.ident_at(1).is_some() || self.is_punct_at(1, ':'),
            Some(
                SectionKind::Count
                | SectionKind::Component
                | SectionKind::Let
                | SectionKind::Function
                | SectionKind::Scene
                | SectionKind::Provide,
            ) => self.ident_at(1).is_some(),
            Some(_) => {
                self.group_at(1, Delimiter::Brace).is_some()
                    || (self.is_punct_at(1, '=') && !self.is_punct_at(2, '='))
            }
        }
    }

    /// Recovers from a fault: goes on to the end of the entry, behind its `;`.
    pub(crate) fn recover(&mut self) {
        while !self.is_end() && !self.starts_section() {
            if self.eat(';').is_some() {
                return;
            }
            self.skip(1);
        }
    }

    /// Recovers from a fault in a list with commas: goes on to the next `,` or `;`, without taking it.
    pub(crate) fn recover_to_comma(&mut self) {
        while !self.is_end() && !self.is_punct(',') && !self.is_punct(';') {
            self.skip(1);
        }
    }
}

/// The place of a token; of a group the place where it opens.
fn span_of(token: &TokenTree) -> Span {
    match token {
        TokenTree::Group(group) if group.delimiter() != Delimiter::None => group.span_open(),
        _ => token.span(),
    }
}

/// Text that fits into a message.
fn shortened(text: &str) -> String {
    const QUOTED_CHARACTERS: usize = 40;
    if text.chars().count() <= QUOTED_CHARACTERS {
        return text.to_owned();
    }
    text.chars().take(QUOTED_CHARACTERS).chain(['…']).collect()
}
