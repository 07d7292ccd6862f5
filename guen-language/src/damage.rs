//! Declarations as faults of the grammar and of loops leave them, so that other faults are told beside them.
//!
//! The statement around such a fault is damaged: what it declares may be missing, and nothing else is said about it. A fault that is
//! found in what is left counts unless it stands in a damaged statement or at a name that one of these may have declared.

use std::collections::BTreeSet;

use proc_macro2::{Delimiter, Group, TokenStream, TokenTree};

use crate::diagnostics::{Fault, FaultReport, position_of};
use crate::names::array_of;
use crate::syntax::{Declaration, Index};

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

/// The damaged statements of a declaration.
pub(crate) struct Damaged {
    /// The statements, each from its first token to that of the next.
    statements: Vec<(Position, Position)>,
    /// The names in them that nothing else declares.
    names: BTreeSet<String>,
    /// The arrays in them, of which some entries may be missing.
    arrays: BTreeSet<String>,
    /// The names that may be missing.
    pub(crate) damage: Damage,
    /// Whether it cannot be told which names may be missing: a count, a component or the name of an instance is.
    pub(crate) is_beyond_names: bool,
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
    pub(crate) fn new(tokens: &TokenStream, declaration: &Declaration, report: &FaultReport) -> Self {
        let mut damaged = Damaged {
            statements: Vec::new(),
            names: BTreeSet::new(),
            arrays: BTreeSet::new(),
            is_beyond_names: false,
            damage: if report.is_empty() { Damage::None } else { Damage::Leaves },
        };
        let tokens: Vec<TokenTree> = tokens.clone().into_iter().collect();
        for fault in report.faults() {
            damaged.add(&tokens, position_of(fault.span()), 0);
        }
        let declared = declaration.items.iter().flat_map(|item| item.declared());
        for name in declared {
            let text = array_of(&name.text);
            let is_array = text != name.text || !matches!(name.index, Index::None);
            if damaged.names.remove(text) && is_array {
                damaged.arrays.insert(text.to_owned());
            }
        }
        damaged
    }

    fn add(&mut self, tokens: &[TokenTree], at: Position, depth: usize) {
        let end = (usize::MAX, 0);
        let statements = statements(tokens, end);
        let begins = |statement: &&Statement<'_>| statement.tokens.first().is_some_and(|t| start(t) <= at);
        let Some(statement) = statements.iter().rev().find(begins).or(statements.first()) else {
            self.damage = Damage::Core;
            return;
        };
        if depth == 1 && !head(statement.tokens).is_some_and(|word| LEAVES.contains(&word.as_str())) {
            self.damage = Damage::Core;
        }
        if depth == 1 {
            let is_named = || statement.tokens.iter().any(|token| token.to_string() == "as");
            self.is_beyond_names |= match head(statement.tokens).as_deref() {
                Some("count" | "component") => true,
                Some("use") => !is_named(),
                _ => false,
            };
        }
        let inside = |group: &&Group| {
            group.delimiter() == Delimiter::Brace
                && position_of(group.span_open()) < at
                && at < position_of(group.span_close())
        };
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
        if let Some(first) = statement.tokens.first() {
            self.statements.push((start(first), statement.end));
            words(statement.tokens, &mut self.names);
        }
    }

    /// Whether a fault that was found in what is left may be a consequence of the damage.
    pub(crate) fn explains(&self, fault: &Fault) -> bool {
        let at = position_of(fault.span());
        let message = fault.message();
        let is_at_name = || fault.span().source_text().is_some_and(|text| self.names.contains(&text));
        let is_missing = || ["unknown ", "used before", "out of range"].iter().any(|w| message.contains(w));
        let roots = || {
            let quoted = message.split('`').skip(1).step_by(2);
            quoted.filter_map(|text| text.split(['[', '.']).next())
        };
        let has_lost = || roots().any(|root| self.names.contains(root) || self.arrays.contains(root));
        self.statements.iter().any(|(from, to)| *from <= at && at < *to)
            || is_at_name()
            || is_missing() && has_lost()
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
    for token in tokens {
        match token {
            TokenTree::Ident(word) => {
                found.insert(word.to_string());
            }
            TokenTree::Group(group) => {
                words(&group.stream().into_iter().collect::<Vec<TokenTree>>(), found);
            }
            _ => {}
        }
    }
}
