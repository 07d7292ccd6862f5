//! Elementary functions as states: a right-hand side without a single elementary call.
//!
//! What comes in are the rates of some variables; what goes out are equal rates in which every elementary function of the
//! state is a symbol, and the rates of these symbols. A function has such a rate where its derivative is rational in
//! itself, in its argument and in other functions that are carried:
//!
//! ```text
//! (sin u)' = cos(u) u'     (cos u)' = -sin(u) u'    (sinh u)' = cosh(u) u'    (cosh u)' = sinh(u) u'
//! (exp u)' = exp(u) u'     (ln u)'  = u'/u          (tanh u)' = (1 - tanh(u)^2) u'
//! (atan u)' = u'/(1 + u^2) (u^(1/q))' = u'/(q u^((q-1)/q))
//! (asin u)' = -(acos u)' = u'/sqrt(1 - u^2)         atan2(y, x)' = (x y' - y x')/(x^2 + y^2)
//! ```
//!
//! The rates `u'` are those of the variables, already computed. Sines and cosines of sums of angles are rotations of those
//! that are carried, wherever a program would compute them so (`passes/angles.rs`). `abs` and `sign` stay: they are no
//! calls but single instructions, and have no differential equation where their argument vanishes.

use super::passes::angles::{Angle, Angles};
use crate::algebra::{
    ExprId, FastMap, Flow, Function, Graph, Multivariate, Node, Rational, Role, Substitution,
};

/// An elementary function that is carried as a state.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct CarriedFunction {
    /// The symbol that stands for it; its name is a new one.
    pub symbol: ExprId,
    /// The expression that the symbol stands for, in the variables.
    pub value: ExprId,
    /// The rate, of the variables and of the symbols.
    pub rate: ExprId,
    /// The value next to the symbol's that keeps the relations among the symbols better; the symbol where there are none.
    pub rejoined: ExprId,
}

/// Rates without elementary calls.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Carried {
    /// The functions, each after those that its argument contains.
    pub functions: Vec<CarriedFunction>,
    /// The rates of the variables, of the variables and of the symbols.
    pub rates: Vec<ExprId>,
    /// Expressions that vanish where the symbols have the values that they stand for: `sin^2 + cos^2 - 1`, `1 -
    /// (sinh^2 + 1)/cosh^2`, `1 - u/root^q`; without units.
    pub invariants: Vec<ExprId>,
    /// Further expressions that must not vanish: roots, arguments of logarithms, radii of `atan2`.
    pub edges: Vec<ExprId>,
}

/// The reason why rates have no carried form.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum NotCarried {
    /// The rates call no function of the state.
    Nothing,
    /// A function of an input, which jumps where the input does.
    Input(ExprId),
    /// A function that the program supplies, whose derivatives would need further ones without end.
    Supplied(ExprId),
}

/// Functions that are carried together.
#[derive(Clone, Copy)]
enum Group {
    /// Sine and cosine of an angle.
    Circle,
    /// Hyperbolic sine and cosine.
    Hyperbola,
    /// A single function.
    Single(Function),
    /// `atan2`.
    Angle,
}

/// Symbols with what they stand for.
struct Member {
    group: Group,
    symbols: [ExprId; 2],
    values: [ExprId; 2],
    /// The argument, or the two of `atan2`, of variables and symbols; beside an inverse sine `sqrt(1 - u^2)`.
    arguments: [ExprId; 2],
}

impl Carried {
    /// The rates of `variables` with everything carried that depends on the state. New names are none of `taken`.
    ///
    /// ```
    /// use guen_symbolic::{Carried, Graph, Role};
    /// let mut g = Graph::new();
    /// let (x, v) = (g.symbol("x", Role::Coordinate), g.symbol("v", Role::QuasiVelocity));
    /// let s = g.sin(x);
    /// let pull = g.neg(s);
    /// let carried = Carried::new(&mut g, &[x, v], &[v, pull], &[]).unwrap();
    /// let rates: Vec<String> = carried.functions.iter().map(|f| g.text(f.rate)).collect();
    /// assert_eq!(rates, ["v*cos_x", "-v*sin_x"]);
    /// assert_eq!(g.text(carried.rates[1]), "-sin_x");
    /// ```
    ///
    /// # Errors
    ///
    /// [`NotCarried`]
    pub fn new(
        graph: &mut Graph,
        variables: &[ExprId],
        rates: &[ExprId],
        taken: &[String],
    ) -> Result<Self, NotCarried> {
        let mut carrying = Carrying {
            graph,
            images: Substitution::default(),
            pairs: FastMap::default(),
            members: Vec::new(),
            taken: taken.to_vec(),
            unnamed: 0,
        };
        carrying.replace(rates)?;
        if carrying.members.is_empty() {
            return Err(NotCarried::Nothing);
        }
        let rates = rates.iter().map(|e| carrying.images.of(carrying.graph, *e)).collect();
        Ok(carrying.finish(variables, rates))
    }
}

struct Carrying<'a> {
    graph: &'a mut Graph,
    images: Substitution,
    /// Sine and cosine, hyperbolic ones apart, by their argument.
    pairs: FastMap<(ExprId, ExprId), [ExprId; 2]>,
    members: Vec<Member>,
    taken: Vec<String>,
    unnamed: usize,
}

impl Carrying<'_> {
    /// Gives every function below some expressions its image.
    fn replace(&mut self, roots: &[ExprId]) -> Result<(), NotCarried> {
        let nodes = self.graph.reachable(roots, |id| self.graph.roles(id).is_constant());
        let angles = Angles::of(self.graph, &nodes);
        for id in nodes {
            let image = match *self.graph.node(id) {
                Node::Function(Function::Abs | Function::Sign | Function::Floor, _) => continue,
                Node::Multivariate(function, _) if function.is_choice() => continue,
                Node::Multivariate(Multivariate::Supplied { .. }, _) => return Err(NotCarried::Supplied(id)),
                Node::Function(..) | Node::Multivariate(..) if self.graph.roles(id).has(Role::Input) => {
                    return Err(NotCarried::Input(id));
                }
                Node::Function(function @ (Function::Sin | Function::Cos), x) => {
                    let [sine, cosine] = match angles.get(x) {
                        Some(angle) => self.rotated(angle),
                        None => self.pair(Group::Circle, x),
                    };
                    if function == Function::Sin { sine } else { cosine }
                }
                Node::Function(Function::Sinh, x) => self.pair(Group::Hyperbola, x)[0],
                Node::Function(Function::Cosh, x) => self.pair(Group::Hyperbola, x)[1],
                Node::Function(function, x) => self.single(id, function, x)?,
                Node::Multivariate(_, ref arguments) => {
                    let [y, x] = [arguments[0], arguments[1]];
                    let symbol = self.symbol("atan2", None);
                    let arguments = [y, x].map(|e| self.images.of(self.graph, e));
                    let (symbols, values) = ([symbol; 2], [id; 2]);
                    self.members.push(Member { group: Group::Angle, symbols, values, arguments });
                    symbol
                }
                _ => continue,
            };
            self.images.add(id, image);
        }
        Ok(())
    }

    /// A new symbol: `sin_theta`, or `sin_1` where the argument has no name.
    fn symbol(&mut self, function: &str, argument: Option<ExprId>) -> ExprId {
        let symbol = argument.and_then(|x| self.graph.as_symbol(x));
        let mut name = match symbol {
            Some(symbol) => format!("{function}_{}", self.graph.symbol_info(symbol).name),
            None => {
                self.unnamed += 1;
                format!("{function}_{}", self.unnamed)
            }
        };
        while self.taken.contains(&name) {
            name.push('_');
        }
        self.taken.push(name.clone());
        // Like a quasi-velocity: a variable of the state that no constraint on positions knows.
        self.graph.symbol(&name, Role::QuasiVelocity)
    }

    /// Sine and cosine of an angle, or the hyperbolic ones.
    fn pair(&mut self, group: Group, x: ExprId) -> [ExprId; 2] {
        let (names, functions) = match group {
            Group::Hyperbola => (["sinh", "cosh"], [Function::Sinh, Function::Cosh]),
            _ => (["sin", "cos"], [Function::Sin, Function::Cos]),
        };
        let values = functions.map(|function| self.graph.function(function, x));
        if let Some(known) = self.pairs.get(&(values[0], values[1])) {
            return *known;
        }
        let first = self.symbol(names[0], Some(x));
        if self.graph.as_symbol(x).is_none() {
            // Both of one argument have its number.
            self.unnamed -= 1;
        }
        let symbols = [first, self.symbol(names[1], Some(x))];
        let argument = self.images.of(self.graph, x);
        self.pairs.insert((values[0], values[1]), symbols);
        self.members.push(Member { group, symbols, values, arguments: [argument; 2] });
        symbols
    }

    /// Sine and cosine of a sum of multiples of base angles, by rotation.
    fn rotated(&mut self, angle: &Angle) -> [ExprId; 2] {
        let mut turned: Option<(ExprId, ExprId)> = None;
        for (base, multiple) in angle {
            let [sine, cosine] = self.pair(Group::Circle, *base);
            let sine = if *multiple < 0 { self.graph.neg(sine) } else { sine };
            for _ in 0..multiple.unsigned_abs() {
                turned = Some(match turned {
                    None => (sine, cosine),
                    Some(turned) => self.graph.rotate(turned, (sine, cosine)),
                });
            }
        }
        let (sine, cosine) = turned.expect("an angle has at least one part");
        [sine, cosine]
    }

    fn single(&mut self, id: ExprId, function: Function, x: ExprId) -> Result<ExprId, NotCarried> {
        let argument = self.images.of(self.graph, x);
        let beside = match function {
            Function::Asin | Function::Acos => {
                let (one, square) = (self.graph.one(), self.graph.powi(x, 2));
                let rest = self.graph.sub(one, square);
                let root = self.graph.sqrt(rest);
                self.replace(&[root])?;
                self.images.of(self.graph, root)
            }
            _ => argument,
        };
        let symbol = self.symbol(function.name(), Some(x));
        let (symbols, values) = ([symbol; 2], [id; 2]);
        let arguments = [argument, beside];
        self.members.push(Member { group: Group::Single(function), symbols, values, arguments });
        Ok(symbol)
    }

    fn finish(self, variables: &[ExprId], rates: Vec<ExprId>) -> Carried {
        let Carrying { graph, members, .. } = self;
        let one = graph.one();
        let time = graph.symbols().filter(|symbol| graph.symbol_info(*symbol).role == Role::Time);
        let time = time.map(|symbol| (graph.symbol_expr(symbol), one));
        // What moves, and how: the variables, then the functions one after the other.
        let mut moving: Vec<(ExprId, ExprId)> =
            variables.iter().copied().zip(rates.iter().copied()).chain(time).collect();
        let mut carried = Carried { functions: Vec::new(), rates, invariants: Vec::new(), edges: Vec::new() };
        for member in &members {
            let mut flow = Flow::new(graph, moving.iter().copied());
            let slopes = member.arguments.map(|u| flow.of(graph, u));
            // Relations that contain other functions are met with these as they will be.
            let before = carried.functions.iter().map(|function| (function.symbol, function.rejoined));
            let ahead = Substitution::new(before).of(graph, member.arguments[0]);
            let functions = member.functions(graph, slopes, ahead, &mut carried);
            moving.extend(functions.iter().map(|function| (function.symbol, function.rate)));
            carried.functions.extend(functions);
        }
        carried
    }
}

impl Member {
    /// The functions with their rates, where those of the arguments are given, and the argument among rejoined functions.
    fn functions(
        &self,
        graph: &mut Graph,
        slopes: [ExprId; 2],
        ahead: ExprId,
        carried: &mut Carried,
    ) -> Vec<CarriedFunction> {
        let g = graph;
        let (one, [s, c], [u, beside], [du, _]) = (g.one(), self.symbols, self.arguments, slopes);
        let new = |index: usize, rate, rejoined| CarriedFunction {
            symbol: self.symbols[index],
            value: self.values[index],
            rate,
            rejoined,
        };
        match self.group {
            Group::Circle => {
                let (squares, half) = ([s, c].map(|e| g.powi(e, 2)), Rational::new(1, 2));
                let length = g.add(squares[0], squares[1]);
                carried.invariants.push(g.sub(length, one));
                // 1/sqrt(length) up to the square of what is to be mended.
                let three = g.number(3);
                let missing = g.sub(three, length);
                let factor = g.scale(missing, &half);
                let (ds, dc) = (g.mul(c, du), g.mul(s, du));
                let (ds, dc) = (ds, g.neg(dc));
                vec![new(0, ds, g.mul(s, factor)), new(1, dc, g.mul(c, factor))]
            }
            Group::Hyperbola => {
                let square = g.powi(s, 2);
                let right = g.add(square, one);
                let ratio = g.product(&[(right, 1), (c, -2)]);
                carried.invariants.push(g.sub(one, ratio));
                // Newton's step for the root of sinh^2 + 1: cosh^2 - sinh^2 itself cancels.
                let quotient = g.div(right, c);
                let sum = g.add(c, quotient);
                let rejoined = g.scale(sum, &Rational::new(1, 2));
                vec![new(0, g.mul(c, du), s), new(1, g.mul(s, du), rejoined)]
            }
            Group::Angle => {
                let ([y, x], [dy, dx]) = (self.arguments, slopes);
                let squares = [y, x].map(|e| g.powi(e, 2));
                let radius = g.add(squares[0], squares[1]);
                carried.edges.push(radius);
                let (ahead, behind) = (g.mul(x, dy), g.mul(y, dx));
                let turned = g.sub(ahead, behind);
                vec![new(0, g.div(turned, radius), s)]
            }
            Group::Single(function) => {
                let mut rejoined = s;
                let slope = match function {
                    Function::Exp => s,
                    Function::Ln => {
                        carried.edges.push(u);
                        g.powi(u, -1)
                    }
                    Function::Tanh => {
                        let square = g.powi(s, 2);
                        g.sub(one, square)
                    }
                    Function::Atan => {
                        let square = g.powi(u, 2);
                        let below = g.add(one, square);
                        g.powi(below, -1)
                    }
                    Function::Asin => g.powi(beside, -1),
                    Function::Acos => {
                        let slope = g.powi(beside, -1);
                        g.neg(slope)
                    }
                    Function::Root(q) => {
                        carried.edges.push(s);
                        let (order, share) = (q as i32, Rational::new(1, q.into()));
                        let quotient = g.product(&[(u, 1), (s, -order)]);
                        carried.invariants.push(g.sub(one, quotient));
                        // Newton's step: w + (u/w^(q-1) - w)/q.
                        let ahead = g.product(&[(ahead, 1), (s, 1 - order)]);
                        let missing = g.sub(ahead, s);
                        let step = g.scale(missing, &share);
                        rejoined = g.add(s, step);
                        let slope = g.powi(s, 1 - order);
                        g.scale(slope, &share)
                    }
                    // Pairs are above; these have no rate.
                    Function::Sin | Function::Cos | Function::Sinh | Function::Cosh => one,
                    Function::Abs | Function::Sign | Function::Floor => g.zero(),
                };
                vec![new(0, g.mul(slope, du), rejoined)]
            }
        }
    }
}
