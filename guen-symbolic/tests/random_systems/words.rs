//! The functions that drawn systems are made of: trigonometric and polynomial in `t`, `x` and constants.

use guen_symbolic::{ExprId, Graph, Rational, Role, SignBound};

use crate::draw::Draw;

/// A graph with the symbols of one system, and the draws that fill it.
pub struct Words {
    pub graph: Graph,
    pub draw: Draw,
    pub time: ExprId,
    pub x: Vec<ExprId>,
    pub velocities: Vec<ExprId>,
    pub etas: Vec<ExprId>,
    pub accelerations: Vec<ExprId>,
    pub constants: Vec<ExprId>,
    pub inputs: Vec<ExprId>,
    /// Whether functions may depend on time.
    pub timed: bool,
}

impl Words {
    /// The symbols of a system with `n` coordinates.
    pub fn new(draw: Draw, n: usize) -> Self {
        let mut graph = Graph::new();
        let time = graph.symbol("t", Role::Time);
        let mut family = |letter: &str, count: usize, role: Role| -> Vec<ExprId> {
            (1..=count).map(|k| graph.symbol(&format!("{letter}{k}"), role)).collect()
        };
        let x = family("x", n, Role::Coordinate);
        let velocities = family("v", n, Role::Velocity);
        let etas = family("eta", n, Role::QuasiVelocity);
        let accelerations = family("deta", n, Role::QuasiAcceleration);
        let inputs = family("u", 1, Role::Input);
        let constants = vec![
            graph.bounded_symbol("k1", Role::Constant, SignBound::Positive),
            graph.bounded_symbol("k2", Role::Constant, SignBound::Free),
        ];
        Words { graph, draw, time, x, velocities, etas, accelerations, constants, inputs, timed: true }
    }

    pub fn number(&mut self) -> Rational {
        let (n, d) = self.draw.pick(&[(1, 1), (-1, 1), (1, 2), (-1, 2), (1, 3), (2, 3), (-2, 3), (3, 4)]);
        Rational::new(n, d)
    }

    /// `t` in one of `times` if the system may depend on it, else one of the coordinates.
    fn variable(&mut self, among: &[usize], times: usize) -> ExprId {
        if self.timed && (among.is_empty() || self.draw.once_in(times)) {
            return self.time;
        }
        match among {
            [] => self.constants[0],
            _ => self.x[self.draw.pick(among)],
        }
    }

    /// A function of `t` and of the coordinates with the given indices; it may vanish at places.
    pub fn coefficient(&mut self, among: &[usize]) -> ExprId {
        let (a, b) = (self.variable(among, 4), self.variable(among, 4));
        let factor = self.number();
        let form = self.draw.below(8);
        let g = &mut self.graph;
        let function = match form {
            0 | 1 => a,
            2 => g.sin(a),
            3 => g.cos(a),
            4 => g.mul(a, b),
            5 => {
                let s = g.sin(a);
                g.mul(s, b)
            }
            6 => {
                // Sums and differences, halves and multiples, constants: some of them base angles, some not.
                let argument = match factor.to_i64_pair() {
                    Some((1, 2)) => g.linear(&[(a, Rational::new(1, 2)), (b, Rational::new(1, 2))]),
                    Some((-1, 2)) => g.linear(&[(a, Rational::new(1, 2)), (b, Rational::MINUS_ONE)]),
                    Some((1, 3)) => g.sum([a, b, self.constants[1]]),
                    Some((2, 3)) => g.linear(&[(a, Rational::integer(2)), (b, Rational::ONE)]),
                    Some((-2, 3)) => g.sub(a, b),
                    _ => g.add(a, b),
                };
                g.cos(argument)
            }
            _ => {
                let s = g.sin(a);
                g.mul(s, self.constants[form % 2])
            }
        };
        g.scale(function, &factor)
    }

    /// A function that vanishes nowhere.
    pub fn positive(&mut self, among: &[usize]) -> ExprId {
        let a = self.variable(among, 3);
        let form = self.draw.below(3);
        let g = &mut self.graph;
        let (base, part) = match form {
            0 => (g.number(2), g.sin(a)),
            1 => (g.ratio(3, 2), g.cos(a)),
            _ => (g.one(), g.powi(a, 2)),
        };
        g.add(base, part)
    }

    /// All indices of coordinates.
    pub fn everywhere(&self) -> Vec<usize> {
        (0..self.x.len()).collect()
    }
}
