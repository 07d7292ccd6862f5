//! Formulas as they were read, whatever they were written in, and the expressions that they are.

use guen_symbolic::{ExprId, Function, Graph, MAX_ARGUMENTS, Multivariate, Rational};

use super::names::{Name, Scope};

/// The reason why a line could not be read.
pub type Unread = String;

/// A formula.
#[derive(Clone, Debug)]
pub enum Term {
    Number(Rational),
    Name(Name),
    /// Terms, and whether each is subtracted.
    Sum(Vec<(bool, Term)>),
    /// Factors, and whether each divides.
    Product(Vec<(bool, Term)>),
    /// A base to the power of a quotient of whole numbers.
    Power(Box<Term>, i32, u32),
    Call(String, Vec<Term>),
}

impl Term {
    /// A number from its digits.
    pub fn digits(text: &str) -> Result<Term, Unread> {
        Rational::from_decimal(text, 0).map(Term::Number).ok_or_else(|| format!("the number `{text}`"))
    }

    /// `p/q`, as an exponent.
    pub fn as_ratio(&self) -> Result<(i32, u32), Unread> {
        let wrong = || format!("the exponent {self:?}");
        let whole = |term: &Term| match term {
            Term::Number(value) => value.to_i64().ok_or_else(wrong),
            _ => Err(wrong()),
        };
        match self {
            Term::Number(_) => Ok((whole(self)? as i32, 1)),
            Term::Product(factors) => match &factors[..] {
                [(false, p), (true, q)] => Ok((whole(p)? as i32, whole(q)? as u32)),
                _ => Err(wrong()),
            },
            Term::Sum(terms) => match &terms[..] {
                [(true, term)] => term.as_ratio().map(|(p, q)| (-p, q)),
                _ => Err(wrong()),
            },
            _ => Err(wrong()),
        }
    }

    /// The expression.
    pub fn build(&self, graph: &mut Graph, scope: &Scope) -> Result<ExprId, Unread> {
        Ok(match self {
            Term::Number(value) => graph.number(value.clone()),
            Term::Name(name) => scope.symbol(name)?,
            Term::Sum(terms) => {
                let mut sum = Vec::new();
                for (minus, term) in terms {
                    let sign = if *minus { Rational::MINUS_ONE } else { Rational::ONE };
                    sum.push((term.build(graph, scope)?, sign));
                }
                graph.linear(&sum)
            }
            Term::Product(factors) => {
                let mut product = Vec::new();
                for (over, factor) in factors {
                    product.push((factor.build(graph, scope)?, if *over { -1 } else { 1 }));
                }
                graph.product(&product)
            }
            Term::Power(base, p, q) => {
                let base = base.build(graph, scope)?;
                let root = if *q == 1 { base } else { graph.root(base, *q) };
                graph.powi(root, *p)
            }
            Term::Call(name, arguments) => {
                let built: Result<Vec<ExprId>, Unread> =
                    arguments.iter().map(|argument| argument.build(graph, scope)).collect();
                return call(graph, name, &built?);
            }
        })
    }
}

/// A function of the program, or a derivative: `ground_x_y(x, y)`.
fn supplied(graph: &mut Graph, name: &str, arguments: &[ExprId]) -> Option<ExprId> {
    let known = graph.supplied_functions().iter().enumerate();
    let mut found = known.filter_map(|(function, known)| {
        let mut rest = name.strip_prefix(known.name.as_str())?;
        let mut orders = [0_u8; MAX_ARGUMENTS];
        while !rest.is_empty() {
            let place = known.arguments.iter().position(|argument| {
                let after = rest.strip_prefix('_').and_then(|rest| rest.strip_prefix(argument.as_str()));
                after.is_some_and(|after| after.is_empty() || after.starts_with('_'))
            })?;
            orders[place] += 1;
            rest = &rest[1 + known.arguments[place].len()..];
        }
        let is_it = known.arguments.len() == arguments.len();
        is_it.then_some(Multivariate::Supplied { function: function as u16, orders })
    });
    let function = found.next()?;
    drop(found);
    Some(graph.multivariate(function, arguments))
}

fn call(graph: &mut Graph, name: &str, arguments: &[ExprId]) -> Result<ExprId, Unread> {
    let function = match name {
        "sin" => Function::Sin,
        "cos" => Function::Cos,
        "asin" | "arcsin" => Function::Asin,
        "acos" | "arccos" => Function::Acos,
        "atan" | "arctan" => Function::Atan,
        "exp" => Function::Exp,
        "ln" => Function::Ln,
        "sinh" => Function::Sinh,
        "cosh" => Function::Cosh,
        "tanh" => Function::Tanh,
        "abs" => Function::Abs,
        "sign" => Function::Sign,
        "floor" => Function::Floor,
        "sqrt" => Function::Root(2),
        _ => {
            return match (name, arguments) {
                ("tan", [x]) => Ok(graph.tan(*x)),
                ("cot", [x]) => Ok(graph.cot(*x)),
                ("atan2", [y, x]) => Ok(graph.atan2(*y, *x)),
                ("min", [a, b]) => Ok(graph.minimum(*a, *b)),
                ("max", [a, b]) => Ok(graph.maximum(*a, *b)),
                ("select", [c, a, b]) => Ok(graph.select(*c, *a, *b)),
                _ => supplied(graph, name, arguments)
                    .ok_or_else(|| format!("the function `{name}` of {} arguments", arguments.len())),
            };
        }
    };
    match arguments {
        [x] => Ok(graph.function(function, *x)),
        _ => Err(format!("`{name}` of {} arguments", arguments.len())),
    }
}
