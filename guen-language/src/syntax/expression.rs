//! Expressions as written.

use proc_macro2::Span;

use super::{Name, Number, Range};

/// An expression.
#[derive(Debug, Clone)]
pub struct Expression {
    /// The token that names the node: the operator, the function's name, the literal. Of a sum or a product it is
    /// the first operator.
    pub span: Span,
    /// The parentheses around the expression, where there are some.
    pub parentheses: Option<Span>,
    /// The kind of the expression.
    pub kind: ExpressionKind,
}

/// The kinds of expressions.
#[derive(Debug, Clone)]
pub enum ExpressionKind {
    /// Something whose fault has been reported.
    Missing,
    /// A number.
    Number(Number),
    /// A name: of anything declared, or `t`, or `pi`.
    Name(Name),
    /// `function(arguments)`; the name need not be that of a function.
    Call {
        /// The name in front.
        function: Name,
        /// The arguments.
        arguments: Vec<Expression>,
        /// The argument list with its parentheses.
        list: Span,
    },
    /// `base.name`.
    Field {
        /// The operand before the point.
        base: Box<Expression>,
        /// The name behind the point.
        name: Name,
    },
    /// `base.name(arguments)`.
    Method {
        /// The operand before the point.
        base: Box<Expression>,
        /// The name behind the point.
        name: Name,
        /// The arguments.
        arguments: Vec<Expression>,
        /// The argument list with its parentheses.
        list: Span,
    },
    /// `-operand`.
    Negation(Box<Expression>),
    /// `first + .. - ..`, from left to right; kept flat so that long sums are not deep. Never without terms.
    Sum {
        /// The first term.
        first: Box<Expression>,
        /// The terms after it.
        rest: Vec<Term>,
    },
    /// `first * .. / ..`, from left to right; never without factors.
    Product {
        /// The first factor.
        first: Box<Expression>,
        /// The factors after it.
        rest: Vec<Factor>,
    },
    /// `left >= right`: the first argument of `select`.
    Comparison {
        /// The left side.
        left: Box<Expression>,
        /// The relation.
        order: Order,
        /// The right side.
        right: Box<Expression>,
    },
    /// `base ^ exponent`.
    Power {
        /// The base.
        base: Box<Expression>,
        /// The exponent.
        exponent: Box<Expression>,
    },
    /// `sum(i in 0..n: e)` or `product(i in 0..n: e)`. There is none left once loops are unfolded.
    Fold(Box<Fold>),
}

/// A sum or product over a range.
#[derive(Debug, Clone)]
pub struct Fold {
    /// The word in front.
    pub function: Name,
    /// The loop variable.
    pub variable: Name,
    /// The numbers that it runs through.
    pub range: Range,
    /// The term or factor.
    pub body: Expression,
}

/// A term of a sum after the first.
#[derive(Debug, Clone)]
pub struct Term {
    /// Added or subtracted.
    pub operator: AddOperator,
    /// Place of the operator.
    pub span: Span,
    /// The term.
    pub value: Expression,
}

/// A factor of a product after the first.
#[derive(Debug, Clone)]
pub struct Factor {
    /// Multiplied or divided by.
    pub operator: MultiplyOperator,
    /// Place of the operator.
    pub span: Span,
    /// The factor.
    pub value: Expression,
}

/// `+` or `-`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AddOperator {
    /// `+`.
    Plus,
    /// `-`.
    Minus,
}

/// A relation between two numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Order {
    /// `>=`.
    AtLeast,
    /// `>`.
    Above,
    /// `<=`.
    AtMost,
    /// `<`.
    Below,
}

impl Order {
    /// The relation as it is written.
    pub fn sign(self) -> &'static str {
        match self {
            Order::AtLeast => ">=",
            Order::Above => ">",
            Order::AtMost => "<=",
            Order::Below => "<",
        }
    }
}

/// `*` or `/`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MultiplyOperator {
    /// `*`.
    Times,
    /// `/`.
    Over,
}

impl Expression {
    /// An expression without parentheses around it.
    pub fn new(span: Span, kind: ExpressionKind) -> Self {
        Expression { span, parentheses: None, kind }
    }

    /// The stand-in for something whose fault has been reported.
    pub fn missing(span: Span) -> Self {
        Expression::new(span, ExpressionKind::Missing)
    }

    /// Whether a fault inside has been reported, so that nothing can be said about the whole.
    pub fn has_missing(&self) -> bool {
        self.any(&|part| matches!(part.kind, ExpressionKind::Missing))
    }

    /// Whether a name stands inside.
    pub fn mentions(&self, name: &str) -> bool {
        self.any(&|part| matches!(&part.kind, ExpressionKind::Name(own) if own.text == name))
    }

    /// The most expressions inside of each other, itself among them.
    pub fn depth(&self) -> usize {
        1 + self.children().into_iter().map(Expression::depth).max().unwrap_or_default()
    }

    /// Whether something holds for the expression or for one inside of it.
    fn any(&self, holds: &dyn Fn(&Expression) -> bool) -> bool {
        holds(self) || self.children().into_iter().any(|part| part.any(holds))
    }

    /// The number, if the expression is just a literal.
    pub fn as_number(&self) -> Option<&Number> {
        match &self.kind {
            ExpressionKind::Number(number) => Some(number),
            _ => None,
        }
    }

    /// The place for a fault of the whole expression: the parentheses around it, else its first token. Joining
    /// the places of all tokens is for unstable compilers only, and messages are the same for all.
    pub fn extent(&self) -> Span {
        self.parentheses.unwrap_or_else(|| self.first_token())
    }

    /// The first token.
    pub fn first_token(&self) -> Span {
        if let Some(parentheses) = self.parentheses {
            return parentheses;
        }
        match &self.kind {
            ExpressionKind::Missing
            | ExpressionKind::Number(_)
            | ExpressionKind::Name(_)
            | ExpressionKind::Call { .. }
            | ExpressionKind::Fold(_)
            | ExpressionKind::Negation(_) => self.span,
            ExpressionKind::Field { base, .. }
            | ExpressionKind::Method { base, .. }
            | ExpressionKind::Power { base, .. } => base.first_token(),
            ExpressionKind::Comparison { left, .. } => left.first_token(),
            ExpressionKind::Sum { first, .. } | ExpressionKind::Product { first, .. } => first.first_token(),
        }
    }
}
