//! Functions and expressions of constants that must not vanish.

use guen_symbolic::{Contracted, Derivation, ExprId, Function, Graph, Node};

use crate::derive::contacts::friction;
use crate::model::Model;

/// Expressions of constants that must not vanish.
pub(in crate::derive) fn constant_pivots(derivation: &Derivation) -> Vec<ExprId> {
    let operators = &derivation.frame.operators.constant_pivots;
    operators.iter().chain(&derivation.solution.constant_pivots).copied().collect()
}

/// The words for a function that vanishes where the forms are dependent.
pub(in crate::derive) const CHART: &str = "a factor of det A";

/// A function that must not vanish, as it is written, and in words that hold wherever it is seen from.
pub(in crate::derive) struct Singularity {
    pub(in crate::derive) function: ExprId,
    pub(in crate::derive) text: String,
    pub(in crate::derive) words: String,
    /// The reason: what degenerates where it vanishes, in the names of the declaration.
    pub(in crate::derive) origin: String,
    /// Whether it is the determinant of a block of the mass matrix, which the words tell by its rows.
    pub(in crate::derive) is_determinant: bool,
}

/// The functions that must not vanish: large determinants are told by their rows.
pub(in crate::derive) fn domain(
    model: &Model<'_>,
    derivation: &Derivation,
    shown: &Contracted,
) -> Vec<Singularity> {
    let named = |e: &ExprId, words: &str, origin: String| Singularity {
        function: *e,
        text: written(model, shown.image(*e), words),
        words: words.to_owned(),
        origin,
        is_determinant: false,
    };
    let operators = &derivation.frame.operators;
    let chart = operators.chart.iter().zip(&operators.chart_forms);
    let chart = chart.map(|(e, forms)| named(e, CHART, dependent(model, forms)));
    let pivot = "the mass matrix is singular";
    let pivots =
        derivation.solution.pivots.iter().map(|e| named(e, "a pivot of the mass matrix", pivot.to_owned()));
    let determinants = derivation.solution.determinants.iter().map(|(rows, e)| {
        let names: Vec<&str> = rows.iter().map(|s| model.forms[*s].name.as_str()).collect();
        let words = format!("det M[{}]", names.join(", "));
        let origin = format!("{pivot} in {}", listed(&names));
        Singularity { function: *e, text: words.clone(), words, origin, is_determinant: true }
    });
    let divisors = friction::divisors(model, derivation)
        .map(|(e, origin)| named(&e, "a divisor of friction", origin.to_owned()));
    let divisors = divisors.filter(|divisor| !model.bench.graph.manifestly_nonzero(divisor.function));
    chart.chain(pivots).chain(determinants).chain(divisors).collect()
}

/// The reason for a factor of det A: which forms are dependent where it vanishes.
fn dependent(model: &Model<'_>, forms: &[usize]) -> String {
    let l = model.mechanics.forms.degrees;
    let of = |is_parameter: bool, one: &str, several: &str| {
        let names = forms.iter().filter(|j| (**j < l) == is_parameter).map(|j| model.forms[*j].name.as_str());
        let names: Vec<&str> = names.collect();
        let noun = if names.len() == 1 { one } else { several };
        (!names.is_empty()).then(|| format!("{noun} {}", listed(&names)))
    };
    let parts = [of(true, "the parameter", "the parameters"), of(false, "the constraint", "the constraints")];
    let who: Vec<String> = parts.into_iter().flatten().collect();
    match forms.len() {
        1 => format!("{} does not determine a velocity", who.concat()),
        _ => format!("{} do not determine the velocities", who.join(" and ")),
    }
}

/// `a, b and c`; of many the first ones.
fn listed(names: &[&str]) -> String {
    const LISTED_NAMES: usize = 6;
    match names {
        [] => String::new(),
        [one] => (*one).to_owned(),
        [first @ .., last] if names.len() <= LISTED_NAMES => format!("{} and {last}", first.join(", ")),
        _ => {
            format!("{} and {} others", names[..LISTED_NAMES - 1].join(", "), names.len() - LISTED_NAMES + 1)
        }
    }
}

/// Returns the origin of a function of the chart, and the states at which it vanishes if more can be said of them than that it does.
pub(in crate::derive) fn reason(graph: &Graph, e: ExprId, origin: &str) -> String {
    match zeros(graph, e) {
        Some(places) if !places.is_empty() && !matches!(&places[..], [Zero::Plain(known)] if *known == e) => {
            let places: Vec<String> = places.into_iter().map(|place| place.text(graph)).collect();
            format!("{origin} where {}", places.join(", or "))
        }
        _ => format!("{origin} where it vanishes"),
    }
}

/// States at which a function vanishes.
enum Zero {
    /// The zeros of this expression.
    Plain(ExprId),
    /// Places in words.
    Told(String),
}

impl Zero {
    fn text(self, graph: &Graph) -> String {
        match self {
            Self::Plain(e) => format!("{} = 0", graph.text(e)),
            Self::Told(text) => text,
        }
    }
}

/// The places where an expression vanishes; none where these would take too many words.
fn zeros(graph: &Graph, e: ExprId) -> Option<Vec<Zero>> {
    const CONDITION_CHARACTERS: usize = 60;
    if graph.manifestly_nonzero(e) {
        return Some(Vec::new());
    }
    let told = |e: ExprId, words: &str| {
        Some(vec![Zero::Told(format!("{} {words}", graph.text_limited(e, CONDITION_CHARACTERS)?))])
    };
    match graph.node(e) {
        Node::Kept(inside) => zeros(graph, *inside),
        Node::Symbol(_) => told(e, "= 0"),
        Node::Product(factors) => {
            let mut found = Vec::new();
            for (base, _) in factors.iter().filter(|(_, exponent)| *exponent > 0) {
                found.extend(zeros(graph, *base)?);
            }
            Some(found)
        }
        Node::Function(function, argument) => match function {
            Function::Sin => told(*argument, "is a multiple of pi"),
            Function::Cos => told(*argument, "is an odd multiple of pi/2"),
            Function::Acos | Function::Ln => told(*argument, "= 1"),
            Function::Exp | Function::Cosh => Some(Vec::new()),
            Function::Floor => None,
            Function::Asin
            | Function::Atan
            | Function::Sinh
            | Function::Tanh
            | Function::Abs
            | Function::Sign
            | Function::Root(_) => zeros(graph, *argument),
        },
        Node::Sum { constant, terms } => {
            if let ([(term, _)], true) = (&terms[..], constant.is_zero()) {
                return zeros(graph, *term);
            }
            let is_square = |term: ExprId| graph.manifestly_nonnegative(term);
            let first = terms.first().is_some_and(|(_, c)| c.is_negative());
            let are_squares = terms.iter().all(|(term, c)| is_square(*term) && c.is_negative() == first);
            if !(are_squares && constant.is_zero()) {
                return graph.text_limited(e, CONDITION_CHARACTERS).map(|_| vec![Zero::Plain(e)]);
            }
            // All of them vanish at once.
            let each =
                terms.iter().map(|(term, _)| zeros(graph, *term).filter(|places| places.len() == 1)?.pop());
            let each: Option<Vec<Zero>> = each.collect();
            let mut each: Vec<String> = each?.into_iter().map(|place| place.text(graph)).collect();
            each.sort_unstable();
            Some(vec![Zero::Told(each.join(" and "))])
        }
        Node::Number(_) | Node::Pi | Node::Multivariate(..) | Node::Undefined => None,
    }
}

/// A function that must not vanish in words; another text where it is too long.
pub(in crate::derive) fn written(model: &Model<'_>, e: ExprId, otherwise: &str) -> String {
    const MESSAGE_CHARACTERS: usize = 400;
    model.bench.graph.text_limited(e, MESSAGE_CHARACTERS).unwrap_or(otherwise.to_owned())
}
