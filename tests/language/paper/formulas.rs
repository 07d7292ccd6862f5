//! A derived system beside formulas as a person writes them: both become expressions of one graph, and their
//! difference is zero-tested.

use guen_language::diagnostics::collect;
use guen_language::model::{Model, resolve};
use guen_language::parse::{parse, parse_expression};
use guen_language::syntax::{AddOperator, Expression, ExpressionKind, MultiplyOperator};
use guen_symbolic::{Derivation, ExprId, Rational, Substitution, Verdict};

/// A derived system that formulas can be held against.
pub struct Formulas<'a> {
    pub model: Model<'a>,
    pub derivation: Derivation,
}

/// Derives a declaration and shows it to `check`.
pub fn derive(declaration: &str, check: impl FnOnce(&mut Formulas<'_>)) {
    let (declaration, report) = parse(declaration.parse().unwrap());
    assert!(report.is_empty(), "{report}");
    let declaration = declaration.unwrap();
    let (model, report) = collect(|faults| resolve(&declaration, faults));
    assert!(report.is_empty(), "{report}");
    let mut model = model.unwrap();
    let derivation = Derivation::new(&mut model.bench, model.mechanics.clone()).unwrap();
    check(&mut Formulas { model, derivation });
}

impl Formulas<'_> {
    /// Asserts that a derived expression is the formula.
    pub fn holds(&mut self, what: &str, found: ExprId, formula: &str) {
        let expected = self.formula(formula);
        self.equal(what, found, expected);
    }

    /// Asserts that two expressions are the same function.
    pub fn equal(&mut self, what: &str, found: ExprId, expected: ExprId) {
        let bench = &mut self.model.bench;
        let difference = bench.graph.sub(found, expected);
        let verdict = bench.zero.verdict(&mut bench.graph, difference);
        let graph = &bench.graph;
        assert_eq!(verdict, Verdict::Zero, "{what}: {} is not {}", graph.text(found), graph.text(expected));
    }

    /// Asserts the coefficients `xi_j^1 .. xi_j^n` of an operator.
    pub fn operator(&mut self, j: usize, formulas: &[&str]) {
        assert_eq!(formulas.len(), self.model.coordinates.len());
        for (i, formula) in formulas.iter().enumerate() {
            let found = self.derivation.frame.operators.xi[j][i];
            self.holds(&format!("xi_{j}^{}", i + 1), found, formula);
        }
    }

    /// Asserts the coefficients `C_ij1 .. C_ijn` of a bracket, either way round.
    pub fn bracket(&mut self, i: usize, j: usize, formulas: &[&str]) {
        assert_eq!(formulas.len(), self.model.coordinates.len());
        for (t, formula) in formulas.iter().enumerate() {
            let bench = &mut self.model.bench;
            let found = self.derivation.frame.brackets.coefficient(bench, i, j, t + 1);
            self.holds(&format!("C_{i}{j}{}", t + 1), found, formula);
            let bench = &mut self.model.bench;
            let turned = self.derivation.frame.brackets.coefficient(bench, j, i, t + 1);
            let turned = bench.graph.neg(turned);
            self.holds(&format!("-C_{j}{i}{}", t + 1), turned, formula);
        }
    }

    /// Asserts the left side of an equation of motion, `sum_t M_st eta_t' - f_s`.
    pub fn equation(&mut self, s: usize, formula: &str) {
        let graph = &mut self.model.bench.graph;
        let row = &self.derivation.equations.mass[s - 1];
        let mut terms: Vec<ExprId> =
            row.iter().zip(&self.derivation.system.accelerations).map(|(m, a)| graph.mul(*m, *a)).collect();
        terms.push(graph.neg(self.derivation.equations.forces[s - 1]));
        let left = graph.sum(terms);
        self.holds(&format!("equation {s}"), left, formula);
    }

    /// `T°` with all parameters free, as declared, differentiated by `eta_v`.
    pub fn free_momentum(&mut self, v: usize) -> ExprId {
        let system = &self.derivation.system;
        let graph = &mut self.model.bench.graph;
        let xi = &self.derivation.frame.operators.xi;
        let velocities: Vec<(ExprId, ExprId)> = (0..system.velocities.len())
            .map(|i| {
                let mut terms = vec![xi[0][i]];
                terms.extend(system.etas.iter().zip(&xi[1..]).map(|(eta, xi)| graph.mul(*eta, xi[i])));
                (system.velocities[i], graph.sum(terms))
            })
            .collect();
        let free = Substitution::new(velocities).of(graph, system.kinetic_energy);
        let eta = system.etas[v - 1];
        self.model.bench.partial(free, eta)
    }

    /// The derivative of a formula by `eta_v`.
    pub fn formula_by(&mut self, v: usize, formula: &str) -> ExprId {
        let (e, eta) = (self.formula(formula), self.derivation.system.etas[v - 1]);
        self.model.bench.partial(e, eta)
    }

    /// A formula in the names of the declaration; `dot(eta1)` is the rate of a parameter.
    pub fn formula(&mut self, text: &str) -> ExprId {
        let (expression, report) = parse_expression(text.parse().unwrap());
        assert!(report.is_empty(), "{text}: {report}");
        self.value(&expression.unwrap())
    }

    fn value(&mut self, e: &Expression) -> ExprId {
        match &e.kind {
            ExpressionKind::Number(number) => {
                let value = Rational::from_decimal(&number.digits, number.exponent).unwrap();
                self.model.bench.graph.number(value)
            }
            ExpressionKind::Name(name) => self.symbol(&name.text),
            ExpressionKind::Call { function, arguments, .. } => {
                if let ("dot", ExpressionKind::Name(name)) = (function.text.as_str(), &arguments[0].kind) {
                    return self.symbol(&format!("{}'", name.text));
                }
                let x = self.value(&arguments[0]);
                let graph = &mut self.model.bench.graph;
                match function.text.as_str() {
                    "sin" => graph.sin(x),
                    "cos" => graph.cos(x),
                    "cot" => graph.cot(x),
                    other => panic!("the paper has no `{other}`"),
                }
            }
            ExpressionKind::Negation(operand) => {
                let value = self.value(operand);
                self.model.bench.graph.neg(value)
            }
            ExpressionKind::Sum { first, rest } => {
                let mut sum = self.value(first);
                for term in rest {
                    let value = self.value(&term.value);
                    let graph = &mut self.model.bench.graph;
                    sum = match term.operator {
                        AddOperator::Plus => graph.add(sum, value),
                        AddOperator::Minus => graph.sub(sum, value),
                    };
                }
                sum
            }
            ExpressionKind::Product { first, rest } => {
                let mut product = self.value(first);
                for factor in rest {
                    let value = self.value(&factor.value);
                    let graph = &mut self.model.bench.graph;
                    product = match factor.operator {
                        MultiplyOperator::Times => graph.mul(product, value),
                        MultiplyOperator::Over => graph.div(product, value),
                    };
                }
                product
            }
            ExpressionKind::Power { base, exponent } => {
                let (base, exponent) = (self.value(base), self.value(exponent));
                self.model.bench.graph.power(base, exponent).unwrap()
            }
            other => panic!("the paper does not write {other:?}"),
        }
    }

    fn symbol(&mut self, name: &str) -> ExprId {
        let graph = &self.model.bench.graph;
        let found = graph.symbols().find(|symbol| graph.symbol_info(*symbol).name == name);
        graph.symbol_expr(found.unwrap_or_else(|| panic!("no symbol `{name}`")))
    }
}
