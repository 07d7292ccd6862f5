//! Writing nodes, children first, so that depth costs no stack.

use crate::algebra::{ExprId, FastMap, Function, Graph, Node, Rational};

use super::Style;
use super::names::latex_name;
use super::order::{FactorKey, TermKey, merge_symbols};

/// All texts made on the way may be this many times as long as the result.
const WORK_FACTOR: usize = 256;

/// How tightly a text binds.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
enum Level {
    Sum,
    Product,
    Power,
    Atom,
}

/// A node as text. Sums keep their negative too: which of the two is shown depends on the place.
#[derive(Clone, Debug)]
struct Piece {
    text: String,
    negated: Option<String>,
    leads_negative: bool,
    level: Level,
    symbols: Vec<u32>,
}

/// One factor of a product as it will be shown: `cot(x)` has taken the place of two.
struct Shown {
    key: FactorKey,
    text: String,
    level: Level,
    exponent: i32,
    // LaTeX writes `\sin^{2} x`: the name and the argument apart.
    function: Option<(&'static str, String)>,
    // An exponent over the order of a root above two.
    order: u32,
}

pub(super) struct Printer<'g> {
    graph: &'g Graph,
    style: Style,
    limit: usize,
    work: usize,
    pieces: FastMap<ExprId, Piece>,
}

impl<'g> Printer<'g> {
    pub(super) fn new(graph: &'g Graph, style: Style, limit: usize) -> Self {
        Printer { graph, style, limit, work: limit.saturating_mul(WORK_FACTOR), pieces: Default::default() }
    }

    pub(super) fn graph(&self) -> &'g Graph {
        self.graph
    }

    /// The text of an expression, or `None` beyond the limit.
    pub(super) fn expression(&mut self, e: ExprId) -> Option<String> {
        self.prepare(e)?;
        let text = self.pieces[&e].text.clone();
        (text.len() <= self.limit).then_some(text)
    }

    /// The coefficient of a named thing: its sign, and a text that a product may begin with.
    pub(super) fn coefficient(&mut self, e: ExprId) -> Option<(bool, String)> {
        self.prepare(e)?;
        Some(match self.graph.node(e) {
            Node::Number(value) => (value.is_negative(), self.number(&value.abs())),
            Node::Sum { constant, terms } if terms.len() == 1 && constant.is_zero() => {
                (terms[0].1.is_negative(), self.term(&terms[0].1.abs(), terms[0].0).1)
            }
            Node::Sum { .. } => {
                let piece = &self.pieces[&e];
                match &piece.negated {
                    Some(negated) if piece.leads_negative => (true, self.parentheses(negated)),
                    _ => (false, self.parentheses(&piece.text)),
                }
            }
            // Written already, with its sign.
            Node::Product(_) => match self.pieces[&e].text.strip_prefix('-') {
                Some(text) => (true, text.to_owned()),
                None => (false, self.pieces[&e].text.clone()),
            },
            _ => self.term(&Rational::ONE, e),
        })
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
            self.work = self.work.checked_sub(piece.text.len())?;
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
        if matches!(self.graph.node(id), Node::Sum { .. }) {
            return self.sum(id, symbols);
        }
        if let Node::Kept(x) = self.graph.node(id) {
            return self.pieces[x].clone();
        }
        let simple =
            |text: String, level| Piece { text, negated: None, leads_negative: false, level, symbols };
        match self.graph.node(id) {
            Node::Number(value) => {
                let sign = if value.is_negative() { "-" } else { "" };
                let level = match (value.is_negative(), value.is_integer()) {
                    (true, _) => Level::Sum,
                    (false, true) => Level::Atom,
                    (false, false) => Level::Product,
                };
                simple(format!("{sign}{}", self.number(&value.abs())), level)
            }
            Node::Pi => {
                simple(if self.style == Style::Latex { "\\pi" } else { "pi" }.to_owned(), Level::Atom)
            }
            Node::Kept(_) => unreachable!("what is kept has returned"),
            Node::Undefined => simple("undefined".to_owned(), Level::Atom),
            Node::Symbol(symbol) => {
                let name = &self.graph.symbol_info(*symbol).name;
                simple(if self.style == Style::Latex { latex_name(name) } else { name.clone() }, Level::Atom)
            }
            Node::Function(Function::Root(q), x) if self.style == Style::Latex => {
                let order = if *q == 2 { String::new() } else { format!("[{q}]") };
                simple(format!("\\sqrt{order}{{{}}}", self.pieces[x].text), Level::Atom)
            }
            Node::Function(Function::Root(q), x) if *q > 2 => {
                simple(format!("{}^(1/{q})", self.wrapped(&self.pieces[x], Level::Atom)), Level::Power)
            }
            Node::Function(Function::Exp, x) if self.style == Style::Latex => {
                simple(format!("e^{{{}}}", self.pieces[x].text), Level::Power)
            }
            Node::Function(Function::Abs, x) if self.style == Style::Latex => {
                simple(format!("\\left|{}\\right|", self.pieces[x].text), Level::Atom)
            }
            Node::Function(function, x) => match self.argument(*x) {
                // sin(-x + y) = -sin(x - y)
                (true, argument) if function.is_odd() => {
                    let positive = self.call(function.name(), argument);
                    let negative = simple(format!("-{positive}"), Level::Sum);
                    Piece { negated: Some(positive), leads_negative: true, ..negative }
                }
                (true, argument) if function.is_even() => {
                    simple(self.call(function.name(), argument), Level::Atom)
                }
                _ => simple(self.call(function.name(), &self.pieces[x].text), Level::Atom),
            },
            Node::Atan2(y, x) => {
                let (y, x) = (&self.pieces[y].text, &self.pieces[x].text);
                simple(
                    match self.style {
                        Style::Text => format!("atan2({y}, {x})"),
                        Style::Latex => format!("\\operatorname{{atan2}}\\left({y}, {x}\\right)"),
                    },
                    Level::Atom,
                )
            }
            Node::Product(_) => {
                let (negative, text) = self.term(&Rational::ONE, id);
                if negative { simple(format!("-{text}"), Level::Sum) } else { simple(text, Level::Product) }
            }
            Node::Sum { .. } => unreachable!("sums have returned"),
        }
    }

    fn sum(&self, id: ExprId, symbols: Vec<u32>) -> Piece {
        // Long sums are stored nested; a reader sees one sum.
        let mut terms = Vec::new();
        let mut number = Rational::ZERO;
        let mut stack = vec![(id, Rational::ONE)];
        while let Some((sum, factor)) = stack.pop() {
            let Node::Sum { constant, terms: inner } = self.graph.node(sum) else { continue };
            number = number + constant * &factor;
            for (term, c) in inner {
                let c = c * &factor;
                if c.abs().is_one() && matches!(self.graph.node(*term), Node::Sum { .. }) {
                    stack.push((*term, c));
                } else {
                    terms.push((*term, c));
                }
            }
        }
        let mut lines: Vec<_> = terms
            .into_iter()
            .map(|(term, c)| {
                let (negative, text) = self.term(&c.abs(), term);
                (Some(self.term_key(term)), negative != c.is_negative(), text)
            })
            .collect();
        lines.sort_by(|a, b| a.0.cmp(&b.0));
        if !number.is_zero() {
            let line = (None, number.is_negative(), self.number(&number.abs()));
            // `1 - x`, not `-x + 1`.
            let first = lines.first().is_some_and(|line| line.1) && !number.is_negative();
            lines.insert(if first { 0 } else { lines.len() }, line);
        }
        let join = |flip: bool| {
            let mut text = String::new();
            for (_, negative, term) in &lines {
                text.push_str(match (text.is_empty(), *negative != flip) {
                    (true, false) => "",
                    (true, true) => "-",
                    (false, false) => " + ",
                    (false, true) => " - ",
                });
                text.push_str(term);
            }
            text
        };
        let leads_negative = lines.first().is_some_and(|line| line.1);
        Piece {
            text: join(false),
            negated: leads_negative.then(|| join(true)),
            leads_negative,
            level: Level::Sum,
            symbols,
        }
    }

    fn factors(&self, id: ExprId) -> Vec<(ExprId, i32)> {
        match self.graph.node(id) {
            Node::Product(factors) => factors.to_vec(),
            _ => vec![(id, 1)],
        }
    }

    fn factor_key(&self, base: ExprId) -> FactorKey {
        let piece = &self.pieces[&base];
        FactorKey::new(self.graph, base, piece.symbols.clone(), &piece.text)
    }

    fn term_key(&self, term: ExprId) -> TermKey {
        let mut factors: Vec<_> =
            self.factors(term).into_iter().map(|(base, e)| (base, self.factor_key(base), e)).collect();
        factors.sort_by(|a, b| a.1.cmp(&b.1));
        TermKey::new(self.graph, factors)
    }

    /// `|coefficient| * term` without its sign, and whether that is a minus: sums inside lead with a plus.
    fn term(&self, coefficient: &Rational, term: ExprId) -> (bool, String) {
        let mut negative = false;
        let mut shown = Vec::new();
        let factors = self.factors(term);
        if let ([(base, 1)], true) = (&factors[..], coefficient.is_one())
            && self.pieces.contains_key(base)
            && !matches!(self.graph.node(*base), Node::Sum { .. })
        {
            let piece = &self.pieces[base];
            return match &piece.negated {
                Some(negated) if piece.leads_negative => (true, negated.clone()),
                _ => (false, piece.text.clone()),
            };
        }
        for (base, e) in &factors {
            for (name, exponent) in self.quotient(&factors, *base, *e) {
                let piece = &self.pieces[base];
                let mut item = Shown {
                    key: self.factor_key(*base),
                    text: piece.text.clone(),
                    level: piece.level,
                    exponent,
                    function: None,
                    order: 1,
                };
                match self.graph.node(*base) {
                    Node::Function(Function::Root(q), x) if self.style == Style::Text && *q > 2 => {
                        item.text = self.wrapped(&self.pieces[x], Level::Atom);
                        (item.order, item.level) = (*q, Level::Atom);
                    }
                    Node::Function(function @ (Function::Sin | Function::Cos), x) => {
                        let (flipped, argument) = self.argument(*x);
                        // Tangents and cotangents are odd.
                        let is_odd = name.is_some() || *function == Function::Sin;
                        negative ^= flipped && is_odd && exponent % 2 != 0;
                        let name = name.unwrap_or(function.name());
                        (item.text, item.level) = (self.call(name, argument), Level::Atom);
                        item.function = Some((name, argument.to_owned()));
                    }
                    Node::Function(..) if piece.leads_negative => {
                        negative ^= exponent % 2 != 0;
                        (item.text, item.level) = (piece.negated.clone().unwrap_or_default(), Level::Atom);
                    }
                    Node::Sum { .. } if piece.leads_negative && exponent % 2 != 0 => {
                        negative = !negative;
                        item.text = piece.negated.clone().unwrap_or_default();
                    }
                    _ => {}
                }
                shown.push(item);
            }
        }
        shown.sort_by(|a, b| a.key.cmp(&b.key));
        let (above, below): (Vec<_>, Vec<_>) = shown.iter().partition(|item| item.exponent > 0);
        (negative, self.quotient_text(coefficient, &above, &below))
    }

    /// A factor `sin(x)^e` beside a power of `cos(x)` of other sign: the common part is a tangent or cotangent.
    fn quotient(&self, factors: &[(ExprId, i32)], base: ExprId, e: i32) -> Vec<(Option<&'static str>, i32)> {
        let Node::Function(function @ (Function::Sin | Function::Cos), x) = *self.graph.node(base) else {
            return vec![(None, e)];
        };
        let (partner, name) = match function {
            Function::Sin => (Function::Cos, "tan"),
            _ => (Function::Sin, "cot"),
        };
        let Some(partner) = factors
            .iter()
            .find(|(b, _)| matches!(*self.graph.node(*b), Node::Function(f, y) if f == partner && x == y))
        else {
            return vec![(None, e)];
        };
        if (partner.1 > 0) == (e > 0) {
            return vec![(None, e)];
        }
        let common = e.abs().min(partner.1.abs());
        let rest = e.signum() * (e.abs() - common);
        // The factor above shows the quotient, the one below only what is left of it.
        let mut parts = Vec::new();
        if e > 0 {
            parts.push((Some(name), common));
        }
        if rest != 0 {
            parts.push((None, rest));
        }
        parts
    }

    fn quotient_text(&self, coefficient: &Rational, above: &[&Shown], below: &[&Shown]) -> String {
        let (n, d) = match coefficient.to_i64_pair() {
            Some((n, d)) => (n.to_string(), d.to_string()),
            None => {
                let (n, d) = coefficient.to_big_pair();
                (n.to_string(), d.to_string())
            }
        };
        let above: Vec<String> = above
            .iter()
            .map(|item| self.factor(item, above.len() + below.len() == 1 && coefficient.is_one()))
            .collect();
        let below_texts: Vec<String> = below.iter().map(|item| self.factor(item, false)).collect();
        match self.style {
            Style::Text => {
                let mut top = Vec::new();
                let mut bottom = below_texts;
                if above.is_empty() {
                    top.push(n);
                    if d != "1" {
                        bottom.insert(0, d);
                    }
                } else if d != "1" {
                    top.push(format!("{n}/{d}"));
                } else if n != "1" {
                    top.push(n);
                }
                top.extend(above);
                let top = top.join("*");
                match bottom.len() {
                    0 => top,
                    1 => format!("{top}/{}", bottom[0]),
                    _ => format!("{top}/({})", bottom.join("*")),
                }
            }
            Style::Latex => {
                let plain = below_texts.is_empty();
                let mut top = Vec::new();
                let mut bottom = below_texts;
                if plain && d != "1" {
                    top.push(format!("\\frac{{{n}}}{{{d}}}"));
                } else {
                    if n != "1" || above.is_empty() {
                        top.push(n);
                    }
                    if d != "1" {
                        bottom.insert(0, d);
                    }
                }
                top.extend(above);
                let top = top.join("\\,");
                if bottom.is_empty() { top } else { format!("\\frac{{{top}}}{{{}}}", bottom.join("\\,")) }
            }
        }
    }

    /// A factor with the absolute value of its exponent.
    fn factor(&self, item: &Shown, alone: bool) -> String {
        let e = item.exponent.unsigned_abs();
        if e == 1 && item.order == 1 {
            let bare =
                matches!(item.level, Level::Power | Level::Atom) || alone && item.level == Level::Product;
            return if bare { item.text.clone() } else { self.parentheses(&item.text) };
        }
        if self.style == Style::Latex
            && let Some((name, argument)) = &item.function
        {
            return format!("\\{name}^{{{e}}}{}", latex_argument(argument));
        }
        let base = if item.level == Level::Atom { item.text.clone() } else { self.parentheses(&item.text) };
        match (self.style, item.order) {
            (Style::Text, 1) => format!("{base}^{e}"),
            (Style::Text, q) => format!("{base}^({e}/{q})"),
            (Style::Latex, _) if item.text.contains('\'') => format!("{{{base}}}^{{{e}}}"),
            (Style::Latex, _) => format!("{base}^{{{e}}}"),
        }
    }

    /// An argument that leads with a plus, and whether it is the negative of what is asked for.
    fn argument(&self, x: ExprId) -> (bool, &str) {
        let piece = &self.pieces[&x];
        match &piece.negated {
            Some(negated) if piece.leads_negative => (true, negated),
            _ => (false, &piece.text),
        }
    }

    fn call(&self, name: &str, argument: &str) -> String {
        match (self.style, name) {
            (Style::Text, _) => format!("{name}({argument})"),
            (Style::Latex, "asin" | "acos" | "atan") => {
                format!("\\arc{}{}", &name[1..], latex_argument(argument))
            }
            (Style::Latex, "sign") => format!("\\operatorname{{sign}}\\left({argument}\\right)"),
            (Style::Latex, _) => format!("\\{name}{}", latex_argument(argument)),
        }
    }

    fn wrapped(&self, piece: &Piece, least: Level) -> String {
        if piece.level >= least { piece.text.clone() } else { self.parentheses(&piece.text) }
    }

    fn parentheses(&self, text: &str) -> String {
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

/// One symbol needs no parentheses behind `\sin`.
fn latex_argument(argument: &str) -> String {
    let compound = argument.contains(|c: char| " +-,^(".contains(c)) || argument.contains("\\frac");
    if compound {
        format!("\\left({argument}\\right)")
    } else if argument.starts_with('\\') {
        argument.to_owned()
    } else {
        format!(" {argument}")
    }
}
