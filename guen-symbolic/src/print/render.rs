//! Writing nodes, children first, so that depth costs no stack.

use crate::algebra::{ExprId, FastMap, Function, Graph, Node, Rational};

use super::Style;
use super::names::LatexNames;
use super::order::{FactorKey, TermKey, merge_symbols};

/// The factor by which all texts made on the way may be longer than the result.
const WORK_FACTOR: usize = 256;

/// The precedence of a text: how tightly it binds.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(super) enum Precedence {
    Sum,
    Product,
    Power,
    Atom,
}

/// A node as text: a sign, and the text of its negative where the sign is a minus.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    /// Whether the expression is the negative of `text`.
    pub(super) minus: bool,
    /// The text with a leading plus.
    pub(super) text: String,
    /// The expression itself, where it is a sum that leads with a minus: `-a + b`, while `text` is `a - b`.
    turned: Option<String>,
    pub(super) level: Precedence,
    symbols: Vec<u32>,
}

impl Piece {
    /// The expression with its sign, as it stands alone, in parentheses or as an argument.
    pub(super) fn signed(&self) -> String {
        match (&self.turned, self.minus) {
            (Some(text), _) => text.clone(),
            (None, true) => format!("-{}", self.text),
            (None, false) => self.text.clone(),
        }
    }

    fn len(&self) -> usize {
        self.text.len() + self.turned.as_ref().map_or(0, String::len)
    }
}

/// A term of a sum on its way to a line.
struct Summand {
    /// The place in the sum; a number stands last, or first before a minus.
    key: Option<TermKey>,
    minus: bool,
    text: String,
}

pub(super) struct Printer<'g> {
    pub(super) graph: &'g Graph,
    pub(super) style: Style,
    pub(super) names: LatexNames,
    limit: usize,
    work: usize,
    pub(super) pieces: FastMap<ExprId, Piece>,
}

impl<'g> Printer<'g> {
    pub(super) fn new(graph: &'g Graph, style: Style, limit: usize) -> Self {
        let names = if style == Style::Latex { LatexNames::of(graph) } else { LatexNames::default() };
        let work = limit.saturating_mul(WORK_FACTOR);
        Printer { graph, style, names, limit, work, pieces: Default::default() }
    }

    /// The text of an expression, or `None` beyond the limit.
    pub(super) fn expression(&mut self, e: ExprId) -> Option<String> {
        self.prepare(e)?;
        let text = self.pieces[&e].signed();
        (text.len() <= self.limit).then_some(text)
    }

    /// The coefficient of a named thing: its sign, and a text that a product may begin with.
    pub(super) fn coefficient(&mut self, e: ExprId) -> Option<(bool, String)> {
        self.prepare(e)?;
        let piece = &self.pieces[&e];
        let text =
            if piece.level == Precedence::Sum { self.parentheses(&piece.text) } else { piece.text.clone() };
        Some((piece.minus, text))
    }

    fn prepare(&mut self, e: ExprId) -> Option<()> {
        // Each expression may cost so much, also when many are written with one memory.
        self.work = self.limit.saturating_mul(WORK_FACTOR);
        let pending = self.graph.reachable(&[e], |id| self.pieces.contains_key(&id));
        for id in pending {
            let piece = self.piece(id);
            if piece.text.len() > self.limit {
                return None;
            }
            self.work = self.work.checked_sub(piece.len())?;
            self.pieces.insert(id, piece);
        }
        Some(())
    }

    fn piece(&self, id: ExprId) -> Piece {
        let mut symbols = Vec::new();
        self.graph.visit_children(id, |child| merge_symbols(&mut symbols, &self.pieces[&child].symbols));
        if let Some(symbol) = self.graph.as_symbol(id) {
            symbols.push(symbol.index() as u32);
        }
        let (minus, text, level) = match self.graph.node(id) {
            Node::Kept(x) => return self.pieces[x].clone(),
            Node::Sum { .. } => return self.sum(id, symbols),
            Node::Number(value) => {
                let level = if value.is_integer() { Precedence::Atom } else { Precedence::Product };
                (value.is_negative(), self.number(&value.abs()), level)
            }
            Node::Pi => (false, self.either("pi", "\\pi"), Precedence::Atom),
            Node::Undefined => (false, self.either("undefined", "\\text{undefined}"), Precedence::Atom),
            Node::Symbol(symbol) => {
                let name = &self.graph.symbol_info(*symbol).name;
                let text = if self.style == Style::Latex { self.names.of_name(name) } else { name.clone() };
                (false, text, Precedence::Atom)
            }
            Node::Function(function, x) => self.function(*function, *x),
            Node::Multivariate(function, _) => {
                (false, self.call(&self.multivariate(*function, id), 1), Precedence::Atom)
            }
            Node::Product(_) => self.product(&Rational::ONE, id),
        };
        Piece { minus, text, turned: None, level, symbols }
    }

    fn either(&self, text: &str, latex: &str) -> String {
        if self.style == Style::Latex { latex.to_owned() } else { text.to_owned() }
    }

    fn function(&self, function: Function, x: ExprId) -> (bool, String, Precedence) {
        let piece = &self.pieces[&x];
        match (function, self.style) {
            (Function::Root(q), Style::Latex) => {
                let order = if q == 2 { String::new() } else { format!("[{q}]") };
                (false, format!("\\sqrt{order}{{{}}}", piece.signed()), Precedence::Atom)
            }
            (Function::Root(q), Style::Text) if q > 2 => {
                (false, format!("{}^(1/{q})", self.wrapped(x, Precedence::Atom)), Precedence::Power)
            }
            (Function::Abs, Style::Latex) => {
                (false, format!("\\left|{}\\right|", piece.text), Precedence::Atom)
            }
            _ => {
                let (minus, argument) = self.argument(function, x);
                (minus, self.call(&self.applied(function.name(), x, &argument), 1), Precedence::Atom)
            }
        }
    }

    /// Returns the text of a function's argument, and whether the result has to be negated: `sin(-x + y)` is `-sin(x
    /// - y)`.
    pub(super) fn argument(&self, function: Function, x: ExprId) -> (bool, String) {
        let piece = &self.pieces[&x];
        if piece.minus && (function.is_odd() || function.is_even()) {
            return (function.is_odd(), piece.text.clone());
        }
        (false, piece.signed())
    }

    /// A sum: long ones are stored nested or are kept whole, and a reader sees one.
    fn sum(&self, id: ExprId, symbols: Vec<u32>) -> Piece {
        let (number, terms) = self.terms(id);
        let mut lines: Vec<Summand> = terms
            .into_iter()
            .map(|(term, c)| {
                let (minus, text, level) = self.product(&c, term);
                // A sum among the terms has a factor before it or is one of several factors; alone it was put in.
                let text = if level == Precedence::Sum { self.parentheses(&text) } else { text };
                Summand { key: Some(self.term_key(term)), minus, text }
            })
            .collect();
        lines.sort_by(|a, b| a.key.cmp(&b.key));
        if !number.is_zero() || lines.is_empty() {
            let minus = number.is_negative();
            // `1 - x`, not `-x + 1`.
            let first = lines.first().is_some_and(|line| line.minus) && !minus;
            let place = if first { 0 } else { lines.len() };
            lines.insert(place, Summand { key: None, minus, text: self.number(&number.abs()) });
        }
        let minus = lines[0].minus;
        if let [line] = &mut lines[..] {
            let (text, level) = match line.key {
                None if number.is_integer() => (core::mem::take(&mut line.text), Precedence::Atom),
                _ => (core::mem::take(&mut line.text), Precedence::Product),
            };
            return Piece { minus, text, turned: None, level, symbols };
        }
        let join = |flip: bool| {
            let mut text = String::new();
            for line in &lines {
                text.push_str(sign(&text, line.minus != flip));
                text.push_str(&line.text);
            }
            text
        };
        let turned = minus.then(|| join(false));
        Piece { minus, text: join(minus), turned, level: Precedence::Sum, symbols }
    }

    /// The number and the terms of a sum, with those of sums among its terms, each once.
    fn terms(&self, id: ExprId) -> (Rational, Vec<(ExprId, Rational)>) {
        let mut number = Rational::ZERO;
        let mut terms: Vec<(ExprId, Rational)> = Vec::new();
        let mut places: FastMap<ExprId, usize> = FastMap::default();
        let mut stack = vec![(id, Rational::ONE)];
        while let Some((e, factor)) = stack.pop() {
            let e = self.opened(e);
            match self.graph.node(e) {
                Node::Number(value) => number = number + value * &factor,
                Node::Sum { constant, terms: inner }
                    if factor.abs().is_one() || inner.len() == 1 && constant.is_zero() =>
                {
                    number = number + constant * &factor;
                    stack.extend(inner.iter().map(|(term, c)| (*term, c * &factor)));
                }
                _ => match places.get(&e) {
                    Some(place) => terms[*place].1 = &terms[*place].1 + &factor,
                    None => {
                        places.insert(e, terms.len());
                        terms.push((e, factor));
                    }
                },
            }
        }
        terms.retain(|(_, c)| !c.is_zero());
        (number, terms)
    }

    /// Returns the expression inside one that is kept whole.
    pub(super) fn opened(&self, mut e: ExprId) -> ExprId {
        while let Node::Kept(x) = self.graph.node(e) {
            e = *x;
        }
        e
    }

    pub(super) fn factor_key(&self, base: ExprId) -> FactorKey {
        let piece = &self.pieces[&base];
        FactorKey::new(self.graph, base, piece.symbols.clone(), &piece.signed())
    }

    fn term_key(&self, term: ExprId) -> TermKey {
        let (_, factors) = self.factors(&Rational::ONE, term);
        let mut factors: Vec<_> =
            factors.into_iter().map(|(base, e)| (base, self.factor_key(base), e)).collect();
        factors.sort_by(|a, b| a.1.cmp(&b.1));
        TermKey::new(self.graph, factors)
    }

    /// An expression that binds at least so tightly, in parentheses where it does not by itself.
    pub(super) fn wrapped(&self, e: ExprId, least: Precedence) -> String {
        let piece = &self.pieces[&e];
        if !piece.minus && piece.level >= least {
            return piece.text.clone();
        }
        self.parentheses(&piece.signed())
    }

    pub(super) fn parentheses(&self, text: &str) -> String {
        match self.style {
            Style::Text => format!("({text})"),
            Style::Latex => format!("\\left({text}\\right)"),
        }
    }

    /// A number that is not negative.
    fn number(&self, value: &Rational) -> String {
        match (self.style, value.is_integer()) {
            (Style::Latex, false) => {
                let (n, d) = value.to_big_pair();
                format!("\\frac{{{n}}}{{{d}}}")
            }
            _ => value.to_string(),
        }
    }
}

/// The sign of a term behind what was written before.
pub(super) fn sign(before: &str, minus: bool) -> &'static str {
    match (before.is_empty(), minus) {
        (true, false) => "",
        (true, true) => "-",
        (false, false) => " + ",
        (false, true) => " - ",
    }
}
