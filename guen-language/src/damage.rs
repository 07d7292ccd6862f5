//! Declarations as faults of the grammar and of loops leave them, so that other faults are told beside them.
//!
//! The statement around such a fault is damaged: what it declares may be missing, and nothing else is said about it. A fault that is
//! found in what is left counts unless it stands in a damaged statement or at a name that one of these may have declared.

use std::collections::BTreeSet;

use proc_macro2::{Delimiter, Group, Span, TokenStream, TokenTree};

use crate::diagnostics::{Fault, file_of, position_of};
use crate::names::array_of;
use crate::syntax::{ComponentPath, Declaration, Index, Item};

/// The parts that a declaration lacks because of faults that were reported before.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Damage {
    /// Nothing.
    None,
    /// Entries that the motion does not need.
    Leaves,
    /// Entries of any kind.
    Core,
}

/// A line and a column.
type Position = (usize, usize);

/// The place of a fault.
enum FaultPlace {
    /// A line and column between the first token of the declaration and the last.
    Position(Position),
    /// A token from the arguments of another macro: the debug text of its span, because spans cannot be compared.
    Token(String),
}

impl FaultPlace {
    /// Whether one of some tokens is at the place.
    fn is_among(&self, tokens: &[TokenTree]) -> bool {
        let FaultPlace::Token(text) = self else { return true };
        let mut is_there = false;
        each(tokens, &mut |token| is_there |= places(token).contains(text));
        is_there
    }
}

/// The damaged statements of a declaration.
pub(crate) struct Damaged {
    /// The file, inside a macro.
    file: Option<String>,
    /// From the first token to the last.
    extent: (Position, Position),
    /// Whether a fault stands in no token of the declaration: it is in a component that is declared elsewhere.
    is_damaged_elsewhere: bool,
    /// The tokens of damaged statements whose fault stands in the arguments of another macro.
    tokens: BTreeSet<String>,
    /// The statements, each from its first token to that of the next.
    statements: Vec<(Position, Position)>,
    /// The names in them that nothing else declares.
    names: BTreeSet<String>,
    /// The arrays in them, of which some entries may be missing.
    arrays: BTreeSet<String>,
    /// The names that may be missing.
    pub(crate) damage: Damage,
    /// Whether an instance has lost its name, so that anything with members may be this instance.
    has_lost_instance: bool,
    /// Whether a count is damaged, so that entries of arrays may be missing.
    has_lost_count: bool,
    /// The names of components that have a fault. If it is in the head, the component is missing from the items.
    lost_components: BTreeSet<String>,
    /// Whether a component has lost its name, so that any unknown one may be this component.
    has_unnamed_component: bool,
    /// The names of instances that are missing.
    lost_instances: BTreeSet<String>,
}

/// The statements of a declaration in which no fault was found.
pub(crate) struct Sound {
    damaged: Option<Damaged>,
    unread: Option<Damaged>,
}

impl Sound {
    /// The statements without the faults so far. The first `unread` of these were found before names had a meaning.
    pub(crate) fn new(declaration: &Declaration, faults: &[Fault], unread: usize) -> Self {
        let damaged_by = |faults: &[Fault]| {
            (!faults.is_empty()).then(|| Damaged::new(&declaration.tokens, &declaration.items, faults))
        };
        let (before, later) = faults.split_at(unread);
        // An unknown name says nothing against the rest of its statement.
        let later = later.iter().filter(|fault| !fault.is_missing_name());
        let all: Vec<Fault> = before.iter().chain(later).cloned().collect();
        Sound { damaged: damaged_by(&all), unread: damaged_by(before) }
    }

    /// Whether there is no fault in the statement of a place.
    pub(crate) fn has(&self, place: Span) -> bool {
        !self.damaged.as_ref().is_some_and(|damaged| damaged.holds(place))
    }

    /// Whether the statement of a place was read, though its names may have no meaning.
    pub(crate) fn is_read(&self, place: Span) -> bool {
        !self.unread.as_ref().is_some_and(|unread| unread.holds(place))
    }
}

/// A statement, or an entry of a list.
struct Statement<'t> {
    tokens: &'t [TokenTree],
    end: Position,
}

/// The sections that the motion does not need.
const LEAVES: [&str; 8] =
    ["forces", "switches", "contacts", "resets", "modes", "outputs", "provide", "scene"];

impl Damaged {
    /// The statements that faults have damaged.
    pub(crate) fn new(tokens: &TokenStream, items: &[Item], faults: &[Fault]) -> Self {
        let tokens: Vec<TokenTree> = tokens.clone().into_iter().collect();
        let tokens = without_crate_path(&tokens);
        let last = match tokens.last() {
            Some(TokenTree::Group(group)) => Some(group.span_close()),
            last => last.map(TokenTree::span),
        };
        let mut damaged = Damaged {
            file: tokens.first().and_then(|token| file_of(token.span())),
            extent: (tokens.first().map_or((0, 0), start), last.map_or((0, 0), position_of)),
            is_damaged_elsewhere: false,
            tokens: BTreeSet::new(),
            statements: Vec::new(),
            names: BTreeSet::new(),
            arrays: BTreeSet::new(),
            has_lost_instance: false,
            has_lost_count: false,
            lost_components: BTreeSet::new(),
            has_unnamed_component: false,
            lost_instances: BTreeSet::new(),
            damage: if faults.is_empty() { Damage::None } else { Damage::Leaves },
        };
        for fault in faults {
            let place = match damaged.is_here(fault.span()) {
                true => FaultPlace::Position(position_of(fault.span())),
                false => FaultPlace::Token(format!("{:?}", fault.span())),
            };
            if !place.is_among(tokens) {
                damaged.is_damaged_elsewhere = true;
            }
            damaged.add(tokens, &place, 0);
        }
        damaged.add_lost(tokens);
        if !faults.is_empty() {
            damaged.add_lost_instances(tokens, items);
        }
        let declared = items.iter().flat_map(|item| item.declared());
        for name in declared {
            let text = array_of(&name.text);
            let is_array = text != name.text || !matches!(name.index, Index::None);
            if damaged.names.remove(text) && is_array {
                damaged.arrays.insert(text.to_owned());
            }
        }
        damaged
    }

    /// Whether a place is between the first token of the declaration and the last.
    fn is_here(&self, span: Span) -> bool {
        let (first, last) = self.extent;
        (first..=last).contains(&position_of(span)) && file_of(span) == self.file
    }

    /// Whether a statement that holds a place says nothing, because of a fault in it.
    pub(crate) fn holds(&self, span: Span) -> bool {
        let at = position_of(span);
        let is_token = || self.tokens.contains(&format!("{span:?}"));
        match self.is_here(span) {
            true => self.statements.iter().any(|(from, to)| *from <= at && at < *to),
            false => self.is_damaged_elsewhere || !self.tokens.is_empty() && is_token(),
        }
    }

    fn add(&mut self, tokens: &[TokenTree], at: &FaultPlace, depth: usize) {
        let end = (usize::MAX, 0);
        let statements = statements(tokens, end);
        let holds = |statement: &&Statement<'_>| match at {
            FaultPlace::Position(at) => statement.tokens.first().is_some_and(|token| start(token) <= *at),
            FaultPlace::Token(_) => at.is_among(statement.tokens),
        };
        let Some(statement) = statements.iter().rev().find(holds).or(statements.first()) else {
            self.damage = Damage::Core;
            return;
        };
        if depth == 1 && !head(statement.tokens).is_some_and(|word| LEAVES.contains(&word.as_str())) {
            self.damage = Damage::Core;
        }
        // Two words in a row: a name behind `as`, or behind a path without `as`.
        let is_named = || {
            let words = |pair: &[TokenTree]| match pair {
                [TokenTree::Ident(_), TokenTree::Ident(name)] => name != "as",
                _ => false,
            };
            let behind = statement.tokens.iter().skip_while(|token| !matches!(token, TokenTree::Ident(_)));
            let behind: Vec<TokenTree> = behind.skip(1).cloned().collect();
            behind.windows(2).any(words)
        };
        match head(statement.tokens).as_deref() {
            Some("count") => self.has_lost_count = true,
            Some("component") => match word_behind(statement.tokens, "component") {
                Some(name) => {
                    self.lost_components.insert(name);
                }
                None => self.has_unnamed_component = true,
            },
            Some("use") => self.has_lost_instance |= !is_named(),
            _ => {}
        }
        let is_inside = |group: &&Group| match at {
            FaultPlace::Position(at) => {
                position_of(group.span_open()) < *at && *at < position_of(group.span_close())
            }
            FaultPlace::Token(_) => at.is_among(&group.stream().into_iter().collect::<Vec<TokenTree>>()),
        };
        let inside = |group: &&Group| group.delimiter() == Delimiter::Brace && is_inside(group);
        let groups = statement.tokens.iter().filter_map(|token| match token {
            TokenTree::Group(group) => Some(group),
            _ => None,
        });
        if let Some(group) = groups.clone().find(inside) {
            let within: Vec<TokenTree> = group.stream().into_iter().collect();
            if !within.is_empty() {
                let known = self.statements.len();
                self.add(&within, at, depth + 1);
                // The last one of a group ends where the group does.
                for (_, end) in &mut self.statements[known..] {
                    *end = (*end).min(position_of(group.span_close()));
                }
                return;
            }
        }
        if depth == 0 {
            self.damage = Damage::Core;
        }
        // The head of a system or a component says nothing of what stands in the braces.
        let has_sections = depth == 0 || head(statement.tokens).as_deref() == Some("component");
        let (tokens, end) = match statement.tokens.split_last() {
            Some((TokenTree::Group(body), head)) if has_sections && body.delimiter() == Delimiter::Brace => {
                (head, position_of(body.span_open()))
            }
            _ => (statement.tokens, statement.end),
        };
        if let Some(first) = tokens.first() {
            self.statements.push((start(first), end));
            if matches!(at, FaultPlace::Token(_)) {
                each(tokens, &mut |token| self.tokens.extend(places(token)));
            }
            words(tokens, &mut self.names);
        }
    }

    /// Adds the arrays and instances that may be missing although no damaged statement names them.
    fn add_lost(&mut self, tokens: &[TokenTree]) {
        if !self.has_lost_count && !self.has_lost_instance {
            return;
        }
        let is_dot = |token: Option<&TokenTree>| matches!(token, Some(TokenTree::Punct(mark)) if mark.as_char() == '.');
        for (place, token) in tokens.iter().enumerate() {
            match (token, tokens.get(place + 1)) {
                (TokenTree::Ident(name), Some(TokenTree::Group(group)))
                    if group.delimiter() == Delimiter::Bracket && self.has_lost_count =>
                {
                    self.arrays.insert(name.to_string());
                }
                // Whatever has members may be the instance.
                (TokenTree::Ident(name), next) if is_dot(next) && self.has_lost_instance => {
                    self.arrays.insert(name.to_string());
                }
                (TokenTree::Group(group), _) => {
                    self.add_lost(&group.stream().into_iter().collect::<Vec<TokenTree>>());
                }
                _ => {}
            }
        }
    }

    /// Adds the statements that speak of instances of which the items have nothing. Whatever the faults are, they are the reason: they are in
    /// the `use`, in a loop around it, or in the component.
    fn add_lost_instances(&mut self, tokens: &[TokenTree], items: &[Item]) {
        uses(tokens, (usize::MAX, 0), &mut self.lost_instances);
        for name in items.iter().flat_map(|item| item.declared()) {
            for step in name.text.split('.') {
                self.lost_instances.remove(array_of(step));
            }
        }
        if !self.lost_instances.is_empty() {
            self.add_mentions(tokens, (usize::MAX, 0));
        }
    }

    /// Adds the smallest statements that name an instance which is missing.
    fn add_mentions(&mut self, tokens: &[TokenTree], end: Position) {
        for statement in statements(tokens, end) {
            let mut is_inside = false;
            for token in statement.tokens {
                if let TokenTree::Group(group) = token
                    && group.delimiter() == Delimiter::Brace
                {
                    let within: Vec<TokenTree> = group.stream().into_iter().collect();
                    if mentions(&within, &self.lost_instances) {
                        is_inside = true;
                        self.add_mentions(&within, position_of(group.span_close()));
                    }
                }
            }
            if let Some(first) = statement.tokens.first()
                && !is_inside
                && mentions(statement.tokens, &self.lost_instances)
            {
                self.statements.push((start(first), statement.end));
            }
        }
    }

    /// Whether a component that the items lack may be one that is declared here with a fault. Then it is no macro.
    pub(crate) fn may_declare(&self, path: &ComponentPath) -> bool {
        path.is_name() && (self.has_unnamed_component || self.lost_components.contains(&path.text))
    }

    /// Whether a fault that was found in what is left may be a consequence of the damage.
    pub(crate) fn explains(&self, fault: &Fault) -> bool {
        let at = position_of(fault.span());
        let message = fault.message();
        let is_at_name = || fault.span().source_text().is_some_and(|text| self.names.contains(&text));
        let is_missing = || ["unknown ", "used before", "out of range"].iter().any(|w| message.contains(w));
        // The first quoted name of such a message is missing; further ones tell the place.
        let missing = message.split('`').nth(1).unwrap_or_default();
        let root = missing.split(['[', '.']).next().unwrap_or_default();
        let has_lost = || self.names.contains(root) || self.arrays.contains(root);
        self.statements.iter().any(|(from, to)| *from <= at && at < *to)
            || is_at_name()
            || is_missing() && has_lost()
            || self.has_unnamed_component && message.starts_with("unknown component")
            || !self.lost_instances.is_empty() && message.starts_with("there are no contacts")
    }
}

/// The statements of a group: what ends with a semicolon or a group in braces, or with a comma where nothing has a semicolon.
fn statements(tokens: &[TokenTree], end: Position) -> Vec<Statement<'_>> {
    let is = |token: &TokenTree, mark: char| matches!(token, TokenTree::Punct(p) if p.as_char() == mark);
    let is_list = !tokens.iter().any(|token| is(token, ';'));
    let ends = |token: &TokenTree| {
        let is_braces = matches!(token, TokenTree::Group(g) if g.delimiter() == Delimiter::Brace);
        is_braces || is(token, if is_list { ',' } else { ';' })
    };
    let mut found: Vec<Statement<'_>> =
        tokens.split_inclusive(ends).map(|tokens| Statement { tokens, end }).collect();
    let starts: Vec<Position> =
        found.iter().skip(1).filter_map(|statement| statement.tokens.first().map(start)).collect();
    for (statement, next) in found.iter_mut().zip(starts) {
        statement.end = next;
    }
    found
}

/// The tokens behind `crate = path;`, which stands in another file where guen's own macro has written it.
fn without_crate_path(tokens: &[TokenTree]) -> &[TokenTree] {
    let is = |token: &TokenTree, mark: char| matches!(token, TokenTree::Punct(p) if p.as_char() == mark);
    match tokens {
        [TokenTree::Ident(word), equals, ..] if word == "crate" && is(equals, '=') => {
            let path = tokens.iter().take_while(|token| !is(token, ';')).count();
            tokens.get(path + 1..).unwrap_or(&[])
        }
        _ => tokens,
    }
}

/// The name of the instance of every `use`.
fn uses(tokens: &[TokenTree], end: Position, found: &mut BTreeSet<String>) {
    for statement in statements(tokens, end) {
        if head(statement.tokens).as_deref() == Some("use") {
            found.extend(word_behind(statement.tokens, "as"));
            continue;
        }
        for token in statement.tokens {
            if let TokenTree::Group(group) = token
                && group.delimiter() == Delimiter::Brace
            {
                let within: Vec<TokenTree> = group.stream().into_iter().collect();
                uses(&within, position_of(group.span_close()), found);
            }
        }
    }
}

/// Whether some tokens name one of some instances: in front of a point, behind one, or as what a scene tracks.
fn mentions(tokens: &[TokenTree], instances: &BTreeSet<String>) -> bool {
    let is_dot =
        |token: Option<&TokenTree>| matches!(token, Some(TokenTree::Punct(mark)) if mark.as_char() == '.');
    let is_index = |token: Option<&TokenTree>| matches!(token, Some(TokenTree::Group(group)) if group.delimiter() == Delimiter::Bracket);
    let is_track = head(tokens).is_some_and(|word| word == "track");
    tokens.iter().enumerate().any(|(place, token)| match token {
        TokenTree::Ident(name) if instances.contains(&name.to_string()) => {
            let behind = place + 1 + usize::from(is_index(tokens.get(place + 1)));
            is_track || is_dot(tokens.get(behind)) || place > 0 && is_dot(tokens.get(place - 1))
        }
        TokenTree::Group(group) => {
            mentions(&group.stream().into_iter().collect::<Vec<TokenTree>>(), instances)
        }
        _ => false,
    })
}

/// The word behind another.
fn word_behind(tokens: &[TokenTree], word: &str) -> Option<String> {
    let mut behind = tokens.iter().skip_while(|token| !matches!(token, TokenTree::Ident(own) if own == word));
    match behind.nth(1) {
        Some(TokenTree::Ident(name)) => Some(name.to_string()),
        _ => None,
    }
}

/// The debug texts of the spans of a token. For a group also those of its delimiters, at which some faults are reported.
fn places(token: &TokenTree) -> Vec<String> {
    let spans = match token {
        TokenTree::Group(group) => vec![group.span(), group.span_open(), group.span_close()],
        other => vec![other.span()],
    };
    spans.iter().map(|span| format!("{span:?}")).collect()
}

fn start(token: &TokenTree) -> Position {
    match token {
        TokenTree::Group(group) => position_of(group.span_open()),
        other => position_of(other.span()),
    }
}

/// The first word of a statement, behind its documentation.
fn head(tokens: &[TokenTree]) -> Option<String> {
    tokens.iter().find_map(|token| match token {
        TokenTree::Ident(word) => Some(word.to_string()),
        _ => None,
    })
}

/// Every identifier in some tokens.
fn words(tokens: &[TokenTree], found: &mut BTreeSet<String>) {
    each(tokens, &mut |token| {
        if let TokenTree::Ident(word) = token {
            found.insert(word.to_string());
        }
    });
}

/// Calls a function for every token, those inside of groups included.
fn each<T>(tokens: &[TokenTree], visit: &mut dyn FnMut(&TokenTree) -> T) {
    for token in tokens {
        visit(token);
        if let TokenTree::Group(group) = token {
            each(&group.stream().into_iter().collect::<Vec<TokenTree>>(), visit);
        }
    }
}
