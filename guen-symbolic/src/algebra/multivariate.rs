//! Nodes of functions of several arguments, in normal form.

use super::function::{Function, MAX_ARGUMENTS, Multivariate, SuppliedFunction};
use super::graph::Graph;
use super::id::ExprId;
use super::node::Node;

impl Graph {
    /// Declares a function that the program supplies; at most [`MAX_ARGUMENTS`] arguments.
    pub fn declare_function(&mut self, name: &str, arguments: &[&str]) -> Multivariate {
        assert!((1..=MAX_ARGUMENTS).contains(&arguments.len()), "whoever declares counts the arguments");
        let function = u16::try_from(self.supplied.len()).expect("there are few functions");
        let arguments = arguments.iter().map(|name| (*name).to_owned()).collect();
        self.supplied.push(SuppliedFunction { name: name.to_owned(), arguments });
        Multivariate::Supplied { function, orders: [0; MAX_ARGUMENTS] }
    }

    /// The functions that the program supplies, by their numbers.
    pub fn supplied_functions(&self) -> &[SuppliedFunction] {
        &self.supplied
    }

    /// Whether a function that the program supplies stands in an expression.
    pub fn has_supplied(&self, e: ExprId) -> bool {
        let is_supplied =
            |e: &ExprId| matches!(self.node(*e), Node::Multivariate(Multivariate::Supplied { .. }, _));
        !self.supplied.is_empty() && self.reachable(&[e], |_| false).iter().any(is_supplied)
    }

    /// A function of several arguments, in normal form.
    pub fn multivariate(&mut self, function: Multivariate, arguments: &[ExprId]) -> ExprId {
        match (function, arguments) {
            (Multivariate::Atan2, [y, x]) => self.atan2(*y, *x),
            (Multivariate::Select, [c, a, b]) => self.select(*c, *a, *b),
            (Multivariate::Minimum, [a, b]) => self.minimum(*a, *b),
            (Multivariate::Maximum, [a, b]) => self.maximum(*a, *b),
            _ => self.intern(Node::Multivariate(function, arguments.into())),
        }
    }

    /// `atan2(y, x)`, the angle of the point `(x, y)`.
    pub fn atan2(&mut self, y: ExprId, x: ExprId) -> ExprId {
        if self.is_zero(y) && self.manifestly_positive(x) {
            return self.zero();
        }
        self.intern(Node::Multivariate(Multivariate::Atan2, [y, x].into()))
    }

    /// `a` where `c >= 0`, `b` elsewhere. A positive number before `c` is left out.
    pub fn select(&mut self, c: ExprId, a: ExprId, b: ExprId) -> ExprId {
        if a == b || self.manifestly_nonnegative(c) {
            return a;
        }
        let opposite = self.neg(c);
        if self.manifestly_positive(opposite) {
            return b;
        }
        let (content, _) = match self.node(c) {
            Node::Sum { .. } => self.split_content(c),
            _ => self.split_coefficient(c),
        };
        let c = match content.abs().recip() {
            Some(scale) => self.scale(c, &scale),
            None => c,
        };
        self.intern(Node::Multivariate(Multivariate::Select, [c, a, b].into()))
    }

    /// The smaller of two.
    pub fn minimum(&mut self, a: ExprId, b: ExprId) -> ExprId {
        self.extremum(Multivariate::Minimum, a, b)
    }

    /// The larger of two.
    pub fn maximum(&mut self, a: ExprId, b: ExprId) -> ExprId {
        self.extremum(Multivariate::Maximum, a, b)
    }

    fn extremum(&mut self, function: Multivariate, a: ExprId, b: ExprId) -> ExprId {
        let difference = self.sub(b, a);
        let opposite = self.neg(difference);
        let [smaller, larger] = match () {
            () if self.manifestly_nonnegative(difference) => [a, b],
            () if self.manifestly_nonnegative(opposite) => [b, a],
            // The order of the arguments says nothing.
            () => {
                let sorted = if self.key(b) < self.key(a) { [b, a] } else { [a, b] };
                return self.intern(Node::Multivariate(function, sorted.into()));
            }
        };
        if function == Multivariate::Minimum { smaller } else { larger }
    }

    /// The partial derivative of a function by the argument at a place.
    pub(crate) fn multivariate_partial(
        &mut self,
        function: Multivariate,
        arguments: &[ExprId],
        place: usize,
    ) -> ExprId {
        match function {
            Multivariate::Atan2 => {
                // d atan2(y, x) = (x dy - y dx)/(x^2 + y^2)
                let (y, x) = (arguments[0], arguments[1]);
                let (x2, y2) = (self.powi(x, 2), self.powi(y, 2));
                let square = self.add(x2, y2);
                let above = if place == 0 { x } else { self.neg(y) };
                self.div(above, square)
            }
            // Where the branches change there is no derivative: a run restarts there.
            Multivariate::Select if place == 0 => self.zero(),
            Multivariate::Select => self.branch(arguments[0], place == 1),
            Multivariate::Minimum | Multivariate::Maximum => {
                let difference = self.sub(arguments[0], arguments[1]);
                self.branch(difference, (place == 0) == (function == Multivariate::Maximum))
            }
            Multivariate::Supplied { function, mut orders } => {
                orders[place] = orders[place].saturating_add(1);
                self.multivariate(Multivariate::Supplied { function, orders }, arguments)
            }
        }
    }

    /// One where `c >= 0` and zero elsewhere, or the other way round.
    fn branch(&mut self, c: ExprId, above: bool) -> ExprId {
        let (one, zero) = (self.one(), self.zero());
        if above { self.select(c, one, zero) } else { self.select(c, zero, one) }
    }

    /// The differential of a function along those of its arguments.
    pub(super) fn multivariate_differential(
        &mut self,
        function: Multivariate,
        arguments: &[ExprId],
        rates: &[ExprId],
    ) -> ExprId {
        match function {
            Multivariate::Atan2 => {
                let ((y, x), (dy, dx)) = ((arguments[0], arguments[1]), (rates[0], rates[1]));
                let (xdy, ydx) = (self.mul(x, dy), self.mul(y, dx));
                let numerator = self.sub(xdy, ydx);
                let (x2, y2) = (self.powi(x, 2), self.powi(y, 2));
                let denominator = self.add(x2, y2);
                self.div(numerator, denominator)
            }
            // A choice between rates: what the other branch does with its argument is not looked at.
            Multivariate::Select => self.choice(arguments[0], rates[1], rates[2]),
            Multivariate::Minimum | Multivariate::Maximum => {
                let difference = self.sub(arguments[0], arguments[1]);
                match function {
                    Multivariate::Maximum => self.choice(difference, rates[0], rates[1]),
                    _ => self.choice(difference, rates[1], rates[0]),
                }
            }
            Multivariate::Supplied { .. } => {
                let mut sum = self.zero();
                for (place, rate) in rates.iter().enumerate() {
                    if !self.is_zero(*rate) {
                        let slope = self.multivariate_partial(function, arguments, place);
                        let term = self.mul(slope, *rate);
                        sum = self.add(sum, term);
                    }
                }
                sum
            }
        }
    }

    /// A choice between rates. One that is not zero has its factors in front that are finite everywhere: derivatives by other coordinates
    /// have the same choice.
    fn choice(&mut self, c: ExprId, a: ExprId, b: ExprId) -> ExprId {
        let rate = match (self.is_zero(a), self.is_zero(b)) {
            (false, true) => a,
            (true, false) => b,
            _ => return self.select(c, a, b),
        };
        let (coefficient, monomial) = self.split_coefficient(rate);
        let factors = match self.node(monomial) {
            Node::Product(factors) => factors.to_vec(),
            _ => vec![(monomial, 1)],
        };
        let (finite, others): (Vec<_>, Vec<_>) =
            factors.into_iter().partition(|(base, exponent)| *exponent > 0 && self.is_finite(*base));
        let [finite, others] = [finite, others].map(|factors| self.product(&factors));
        let chosen = if rate == a { self.select(c, others, b) } else { self.select(c, a, others) };
        let product = self.mul(finite, chosen);
        self.scale(product, &coefficient)
    }

    /// Whether a polynomial in symbols, sines and cosines: what is finite wherever the symbols are.
    fn is_finite(&self, e: ExprId) -> bool {
        self.reachable(&[e], |_| false).into_iter().all(|id| match self.node(id) {
            Node::Number(_) | Node::Pi | Node::Symbol(_) | Node::Sum { .. } | Node::Kept(_) => true,
            Node::Product(factors) => factors.iter().all(|(_, exponent)| *exponent > 0),
            Node::Function(function, _) => matches!(function, Function::Sin | Function::Cos),
            Node::Multivariate(..) | Node::Undefined => false,
        })
    }

    /// The function by whose zeros a piecewise function changes its branch; none of any other node.
    pub fn switching_function(&mut self, id: ExprId) -> Option<ExprId> {
        match self.node(id).clone() {
            Node::Function(Function::Abs | Function::Sign, x) => Some(x),
            // The whole numbers are the zeros of sin(pi x).
            Node::Function(Function::Floor, x) => {
                let pi = self.pi();
                let angle = self.mul(pi, x);
                Some(self.sin(angle))
            }
            Node::Multivariate(Multivariate::Select, arguments) => Some(arguments[0]),
            Node::Multivariate(Multivariate::Minimum | Multivariate::Maximum, arguments) => {
                Some(self.sub(arguments[0], arguments[1]))
            }
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::{Flow, Graph, Role};

    #[test]
    fn extrema_do_not_depend_on_the_order_of_their_arguments() {
        let mut g = Graph::new();
        let [x, y] = ["x", "y"].map(|name| g.symbol(name, Role::Coordinate));
        assert_eq!(g.maximum(x, y), g.maximum(y, x));
        assert_ne!(g.maximum(x, y), g.minimum(x, y));
        let [two, three] = [g.number(2), g.number(3)];
        assert_eq!((g.maximum(two, three), g.minimum(two, three)), (three, two));
        let square = g.powi(x, 2);
        let zero = g.zero();
        assert_eq!((g.maximum(zero, square), g.minimum(square, zero)), (square, zero));
    }

    #[test]
    fn derivatives_choose_the_branch() {
        let mut g = Graph::new();
        let [x, y] = ["x", "y"].map(|name| g.symbol(name, Role::Coordinate));
        let larger = g.maximum(x, y);
        let (one, zero) = (g.one(), g.zero());
        let by_x = Flow::partial(&g, x).of(&mut g, larger);
        let difference = g.sub(x, y);
        let expected = g.select(difference, one, zero);
        let other = g.neg(difference);
        let turned = g.select(other, zero, one);
        assert!(by_x == expected || by_x == turned, "{}", g.text(by_x));
        let smaller = g.minimum(x, y);
        let by_x_of_smaller = Flow::partial(&g, x).of(&mut g, smaller);
        assert_ne!(by_x, by_x_of_smaller);
    }

    /// A rope that is slack has a length of zero somewhere: what is not finite there stays behind the choice.
    #[test]
    fn factors_that_are_finite_stand_before_a_choice() {
        let mut g = Graph::new();
        let [x, y, l] = ["x", "y", "l"].map(|name| g.symbol(name, Role::Coordinate));
        let (cosine, squares) = (g.cos(y), [x, y].map(|e| g.powi(e, 2)));
        let square = g.sum(squares);
        let (length, zero) = (g.sqrt(square), g.zero());
        let product = g.mul(length, cosine);
        let stretch = g.sub(product, l);
        let opposite = g.neg(product);
        let pull = g.maximum(stretch, zero);
        let least = g.minimum(product, zero);
        let (one, inverse) = (g.one(), g.product(&[(length, 1), (square, -1)]));
        let minus_one = g.number(-1);
        for (e, along, c, finite, chosen) in [
            (pull, x, stretch, &[(x, 1), (cosine, 1)][..], inverse),
            (pull, l, stretch, &[(minus_one, 1)], one),
            // The other branch of a minimum.
            (least, x, opposite, &[(x, 1), (cosine, 1)], inverse),
        ] {
            let found = Flow::partial(&g, along).of(&mut g, e);
            let opposite = g.neg(c);
            // The order of the arguments says nothing.
            let choices = [g.select(c, chosen, zero), g.select(opposite, zero, chosen)];
            let finite = g.product(finite);
            let expected = choices.map(|choice| g.mul(finite, choice));
            assert!(expected.contains(&found), "{}", g.text(found));
        }
    }

    #[test]
    fn supplied_functions_have_partial_derivatives() {
        let mut g = Graph::new();
        let [x, y] = ["x", "y"].map(|name| g.symbol(name, Role::Coordinate));
        let ground = g.declare_function("ground", &["x", "y"]);
        let square = g.powi(x, 2);
        let height = g.multivariate(ground, &[square, y]);
        let slope = Flow::partial(&g, x).of(&mut g, height);
        assert_eq!(g.text(slope), "2*ground_x(x^2, y)*x");
        let mixed = Flow::partial(&g, y).of(&mut g, slope);
        assert_eq!(g.text(mixed), "2*ground_x_y(x^2, y)*x");
    }
}
