//! Expressions as a mechanics text writes them, in the language's own grammar or in LaTeX.
//!
//! What comes in is an expression or a linear combination with named unknowns; what goes out is text in a
//! reader's order: numbers and constants before functions before velocities, accelerations first in a
//! sum. The order depends on the declaration only, never on how the graph stores things.

mod contracted;
mod names;
mod order;
mod product;
mod render;

use crate::algebra::{ExprId, Graph};
use render::{Printer, sign};

pub use contracted::Contracted;
pub use names::{greek_letter, latex_name};

/// The characters of a text above which [`Graph::text`] replaces it by a note: it helps no reader.
const LONGEST_TEXT: usize = 20_000;

/// The notation of printed expressions.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Style {
    /// The grammar of the language.
    Text,
    /// LaTeX mathematics, without delimiters.
    Latex,
}

impl Graph {
    /// The expression in the language's grammar; one that is too long to read becomes a note.
    ///
    /// ```
    /// use guen_symbolic::{Graph, Role};
    /// let mut g = Graph::new();
    /// let a = g.symbol("a", Role::Constant);
    /// let theta = g.symbol("theta", Role::Coordinate);
    /// let cot = g.cot(theta);
    /// let e = g.mul(cot, a);
    /// assert_eq!(g.text(e), "a*cot(theta)");
    /// ```
    pub fn text(&self, e: ExprId) -> String {
        self.text_limited(e, LONGEST_TEXT).unwrap_or_else(|| self.note(e))
    }

    /// The expression in LaTeX, without delimiters; one that is too long to read becomes a note.
    pub fn latex(&self, e: ExprId) -> String {
        self.latex_limited(e, LONGEST_TEXT).unwrap_or_else(|| format!("\\text{{{}}}", self.note(e)))
    }

    /// [`Graph::text`], or `None` if it has more than `max_chars` bytes.
    pub fn text_limited(&self, e: ExprId, max_chars: usize) -> Option<String> {
        if let Some(symbol) = self.as_symbol(e) {
            let name = &self.symbol_info(symbol).name;
            return (name.len() <= max_chars).then(|| name.clone());
        }
        Printer::new(self, Style::Text, max_chars).expression(e)
    }

    /// [`Graph::latex`], or `None` if it has more than `max_chars` bytes.
    pub fn latex_limited(&self, e: ExprId, max_chars: usize) -> Option<String> {
        Printer::new(self, Style::Latex, max_chars).expression(e)
    }

    fn note(&self, e: ExprId) -> String {
        format!("(an expression of {} parts, too long to show)", self.reachable(&[e], |_| false).len())
    }
}

/// A way of writing that remembers what it has written: for many expressions that share their parts.
///
/// ```
/// use guen_symbolic::{Graph, Notation, Role};
/// let mut g = Graph::new();
/// let x = g.symbol("x", Role::Coordinate);
/// let (s, c) = g.sin_cos(x);
/// let mut notation = Notation::text(&g, 100);
/// assert_eq!(notation.expression(s).as_deref(), Some("sin(x)"));
/// assert_eq!(notation.sum(&[(c, "X1"), (s, "X2")]).as_deref(), Some("cos(x) X1 + sin(x) X2"));
/// ```
pub struct Notation<'g> {
    printer: Printer<'g>,
    style: Style,
    images: Option<&'g Contracted>,
}

impl<'g> Notation<'g> {
    /// The grammar of the language; expressions with more than `longest` bytes are not written.
    pub fn text(graph: &'g Graph, longest: usize) -> Self {
        Notation { printer: Printer::new(graph, Style::Text, longest), style: Style::Text, images: None }
    }

    /// LaTeX mathematics without delimiters.
    pub fn latex(graph: &'g Graph, longest: usize) -> Self {
        Notation { printer: Printer::new(graph, Style::Latex, longest), style: Style::Latex, images: None }
    }

    /// Writes the images of expressions in their place.
    pub fn of_images(self, images: &'g Contracted) -> Self {
        Notation { images: Some(images), ..self }
    }

    fn image(&self, e: ExprId) -> ExprId {
        self.images.map_or(e, |images| images.image(e))
    }

    /// An expression, or `None` if it is too long.
    pub fn expression(&mut self, e: ExprId) -> Option<String> {
        self.printer.expression(self.image(e))
    }

    /// The name of a symbol, of its rate `x'` or of the operator `d/dx`, as the symbol is written in expressions.
    pub fn name(&self, name: &str) -> String {
        match self.style {
            Style::Text => name.to_owned(),
            Style::Latex => self.printer.names.of_name(name),
        }
    }

    /// A linear combination of named things, or `None` if a coefficient is too long; zero coefficients are left out.
    pub fn sum(&mut self, terms: &[(ExprId, &str)]) -> Option<String> {
        self.combination(terms, None)
    }

    /// Writes a combination with an expression behind it, unless that is zero.
    pub fn affine(&mut self, terms: &[(ExprId, &str)], rest: ExprId) -> Option<String> {
        self.combination(terms, Some(rest))
    }

    fn combination(&mut self, terms: &[(ExprId, &str)], rest: Option<ExprId>) -> Option<String> {
        let mut line = String::new();
        for (coefficient, name) in terms {
            if self.printer.graph.is_zero(*coefficient) {
                continue;
            }
            let (minus, text) = self.printer.coefficient(self.image(*coefficient))?;
            line.push_str(sign(&line, minus));
            if text != "1" {
                line.push_str(&text);
                line.push_str(if self.style == Style::Latex { "\\," } else { " " });
            }
            line.push_str(&self.name(name));
        }
        if let Some(rest) = rest.filter(|rest| !self.printer.graph.is_zero(*rest)) {
            let text = self.expression(rest)?;
            match text.strip_prefix('-') {
                // The terms of `-a + b` go on in the line.
                Some(positive) => line.extend([sign(&line, true), positive]),
                None => line.extend([sign(&line, false), &text]),
            }
        }
        Some(if line.is_empty() { "0".to_owned() } else { line })
    }
}

#[cfg(test)]
mod tests;
