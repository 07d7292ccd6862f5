//! `for i in 0..n { .. }` and `if i < k { .. } else { .. }` among the entries of a list.

use proc_macro2::{Delimiter, Group};

use super::cursor::Cursor;
use super::index::{condition, range};
use super::names::name;
use crate::diagnostics::{Fault, Faults, Reported};
use crate::limits::{MAX_BRANCHES, MAX_NESTED_LOOPS};
use crate::syntax::{Condition, Conditional, Docs, EntryNode, Loop, Section};

const HELP_LOOP: &str = "a loop reads `for i in 0..n { .. }`";
const HELP_CHOICE: &str = "a choice reads `if i < k { .. } else { .. }`";

/// Entries, and their order where loops and conditions stand between them.
pub(crate) struct Entries<T> {
    pub(crate) list: Vec<T>,
    nodes: Vec<EntryNode>,
    has_blocks: bool,
    depth: usize,
}

impl<T> Entries<T> {
    pub(crate) fn new() -> Self {
        Entries { list: Vec::new(), nodes: Vec::new(), has_blocks: false, depth: 0 }
    }

    pub(crate) fn push(&mut self, entry: T) {
        self.nodes.push(EntryNode::Entry(self.list.len()));
        self.list.push(entry);
    }

    /// Whether the entries that are read now stand in a loop or a choice.
    pub(crate) fn is_inside(&self) -> bool {
        self.depth > 0
    }

    /// The order of the entries; none where they stand one behind the other.
    pub(crate) fn nesting(self) -> (Vec<T>, Vec<EntryNode>) {
        (self.list, if self.has_blocks { self.nodes } else { Vec::new() })
    }

    /// The entries as a section.
    pub(crate) fn section(self, docs: Docs, keyword: proc_macro2::Span) -> Section<T> {
        let (entries, nesting) = self.nesting();
        Section { docs, keyword, entries, nesting }
    }

    /// Reads a loop or a choice, if one begins here; `read` reads the entries inside of braces.
    pub(crate) fn block(
        &mut self,
        cursor: &mut Cursor,
        faults: &mut Faults,
        read: &mut dyn FnMut(&Group, &mut Faults, &mut Self),
    ) -> bool {
        let keyword = cursor.span();
        let is_loop = cursor.is_word("for");
        if !(is_loop || cursor.is_word("if") && !is_expression(cursor)) {
            return false;
        }
        cursor.skip(1);
        self.has_blocks = true;
        if self.depth >= MAX_NESTED_LOOPS {
            let text = format!("more than {MAX_NESTED_LOOPS} loops and choices inside of each other");
            faults.report(Fault::new(keyword, text));
            pass(cursor);
            return true;
        }
        let node = if is_loop {
            self.repeated(cursor, faults, read)
                .map(|(variable, range, body)| EntryNode::For(Loop { keyword, variable, range, body }))
        } else {
            self.choice(cursor, faults, read).map(EntryNode::If)
        };
        match node {
            Ok(node) => self.nodes.push(node),
            Err(Reported { .. }) => pass(cursor),
        }
        true
    }

    fn repeated(
        &mut self,
        cursor: &mut Cursor,
        faults: &mut Faults,
        read: &mut dyn FnMut(&Group, &mut Faults, &mut Self),
    ) -> Result<(crate::syntax::Name, crate::syntax::Range, Vec<EntryNode>), Reported> {
        let variable = name(cursor, faults, "a loop variable")?;
        if cursor.eat_word("in").is_none() {
            let fault = Fault::new(cursor.span(), format!("expected `in`, found {}", cursor.found()));
            return Err(faults.report(fault.help(HELP_LOOP)));
        }
        let range = range(cursor, faults)?;
        let body = self.braces(cursor, faults, HELP_LOOP, read)?;
        Ok((variable, range, body))
    }

    fn choice(
        &mut self,
        cursor: &mut Cursor,
        faults: &mut Faults,
        read: &mut dyn FnMut(&Group, &mut Faults, &mut Self),
    ) -> Result<Conditional, Reported> {
        let mut branches = vec![self.branch(cursor, faults, read)?];
        let mut otherwise = Vec::new();
        while let Some(span) = cursor.eat_word("else") {
            if cursor.eat_word("if").is_none() {
                otherwise = self.braces(cursor, faults, HELP_CHOICE, read)?;
                break;
            }
            if branches.len() >= MAX_BRANCHES {
                return Err(faults.report(Fault::new(span, format!("more than {MAX_BRANCHES} branches"))));
            }
            branches.push(self.branch(cursor, faults, read)?);
        }
        // There is a branch at least.
        let Some((condition, then)) = branches.pop() else { return Err(faults.reported_before()) };
        let last = Conditional { condition, then, otherwise };
        Ok(branches.into_iter().rev().fold(last, |inner, (condition, then)| Conditional {
            condition,
            then,
            otherwise: vec![EntryNode::If(inner)],
        }))
    }

    /// A condition and the entries where it holds.
    fn branch(
        &mut self,
        cursor: &mut Cursor,
        faults: &mut Faults,
        read: &mut dyn FnMut(&Group, &mut Faults, &mut Self),
    ) -> Result<(Condition, Vec<EntryNode>), Reported> {
        let condition = condition(cursor, faults).unwrap_or_else(|Reported { .. }| {
            while !cursor.is_end() && cursor.group_at(0, Delimiter::Brace).is_none() {
                cursor.skip(1);
            }
            Condition::Missing
        });
        Ok((condition, self.braces(cursor, faults, HELP_CHOICE, read)?))
    }

    /// The entries between braces.
    fn braces(
        &mut self,
        cursor: &mut Cursor,
        faults: &mut Faults,
        help: &str,
        read: &mut dyn FnMut(&Group, &mut Faults, &mut Self),
    ) -> Result<Vec<EntryNode>, Reported> {
        let Some(group) = cursor.eat_group(Delimiter::Brace) else {
            let fault = Fault::new(cursor.span(), format!("expected `{{`, found {}", cursor.found()));
            return Err(faults.report(fault.help(help)));
        };
        let before = std::mem::take(&mut self.nodes);
        self.depth += 1;
        read(&group, faults, self);
        self.depth -= 1;
        Ok(std::mem::replace(&mut self.nodes, before))
    }
}

/// Whether an expression goes on behind the braces of an `if`: then the `if` was meant as a part of it.
fn is_expression(cursor: &Cursor) -> bool {
    let mut place = 1;
    loop {
        while cursor.group_at(place, Delimiter::Brace).is_none() {
            if cursor.peek_nth(place).is_none() {
                return false;
            }
            place += 1;
        }
        place += 1;
        if !cursor.is_word_at(place, "else") {
            return cursor.is_word_at(place, "along")
                || cursor.is_word_at(place, "at")
                || ['+', '-', '*', '/', '=', ';'].iter().any(|mark| cursor.is_punct_at(place, *mark));
        }
    }
}

/// Goes on behind the braces of a loop or choice that could not be read, and behind those of its other branches.
fn pass(cursor: &mut Cursor) {
    loop {
        while !cursor.is_end() && cursor.eat_group(Delimiter::Brace).is_none() {
            if cursor.starts_section() {
                return;
            }
            cursor.skip(1);
        }
        if cursor.eat_word("else").is_none() {
            return;
        }
    }
}
