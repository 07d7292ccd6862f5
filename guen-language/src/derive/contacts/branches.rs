//! Branches of piecewise functions in the motion between contacts. Each is held within a mode, as switches are, so that no step goes across
//! two formulas; its switching function is a signal, whose zeros end the mode.

use guen_symbolic::{ExprId, Function, Graph, Multivariate, Node, Role, Roles, Substitution};

/// A branch that is held.
#[derive(Clone, Debug)]
pub struct Branch {
    /// The symbol of its value: one where the function is positive, zero where it is negative, a half where it stays zero.
    pub symbol: ExprId,
    /// The switching function.
    pub function: ExprId,
    /// The function as text.
    pub text: String,
}

/// The branches of some expressions, and the expressions with them held.
pub(super) struct Held {
    pub(super) branches: Vec<Branch>,
    substitution: Substitution,
}

impl Held {
    /// The piecewise functions of expressions. In their switching functions `values` stand for the symbols that the state determines.
    pub(super) fn new(graph: &mut Graph, expressions: &[ExprId], values: &mut Substitution) -> Self {
        // Inputs may follow a law.
        let moving = [Role::Time, Role::Coordinate, Role::QuasiVelocity, Role::State, Role::Input];
        let moving =
            moving.into_iter().map(Roles::of).reduce(Roles::or).unwrap_or_else(|| Roles::of(Role::Time));
        let mut held = Held { branches: Vec::new(), substitution: Substitution::default() };
        for id in graph.reachable(expressions, |_| false) {
            let Some(function) = graph.switching_function(id) else { continue };
            let function = values.of(graph, function);
            if graph.roles(function).meets(moving) {
                let value = held.value(graph, function);
                if let Some(image) = held.image(graph, id, value) {
                    held.substitution.add(id, image);
                }
            }
        }
        held
    }

    /// An expression with its branches held.
    pub(super) fn of(&mut self, graph: &mut Graph, e: ExprId) -> ExprId {
        self.substitution.of(graph, e)
    }

    /// The value of the branch of a switching function.
    fn value(&mut self, graph: &mut Graph, function: ExprId) -> ExprId {
        let opposite = graph.neg(function);
        for branch in &self.branches {
            if branch.function == function {
                return branch.symbol;
            }
            if branch.function == opposite {
                let one = graph.one();
                return graph.sub(one, branch.symbol);
            }
        }
        let text = graph
            .text_limited(function, SWITCH_CHARACTERS)
            .unwrap_or_else(|| "a switching function".to_owned());
        let symbol = graph.symbol(&format!("branch of {text}"), Role::Input);
        self.branches.push(Branch { symbol, function, text });
        symbol
    }

    /// A piecewise function on the branch that `value` says; `None` of `floor`, which has more than two.
    fn image(&mut self, graph: &mut Graph, id: ExprId, value: ExprId) -> Option<ExprId> {
        let one = graph.one();
        let two = graph.number(2);
        let three = graph.number(3);
        let sign = {
            let double = graph.mul(two, value);
            graph.sub(double, one)
        };
        let between = |graph: &mut Graph, part: ExprId, a: ExprId, b: ExprId| {
            let difference = graph.sub(a, b);
            let difference = graph.mul(part, difference);
            graph.add(b, difference)
        };
        match graph.node(id).clone() {
            Node::Function(Function::Sign, _) => Some(sign),
            Node::Function(Function::Abs, x) => {
                let x = self.of(graph, x);
                Some(graph.mul(sign, x))
            }
            Node::Multivariate(function, arguments) => {
                let arguments: Vec<ExprId> = arguments.iter().map(|e| self.of(graph, *e)).collect();
                match (function, arguments.as_slice()) {
                    // At zero `select` takes its first branch: the value of a half counts as one.
                    (Multivariate::Select, [_, a, b]) => {
                        let double = graph.mul(two, value);
                        let rest = graph.sub(three, double);
                        let part = graph.mul(value, rest);
                        Some(between(graph, part, *a, *b))
                    }
                    (Multivariate::Maximum, [a, b]) => Some(between(graph, value, *a, *b)),
                    (Multivariate::Minimum, [a, b]) => Some(between(graph, value, *b, *a)),
                    _ => None,
                }
            }
            _ => None,
        }
    }
}

/// The most characters of a switching function in a text.
const SWITCH_CHARACTERS: usize = 60;
