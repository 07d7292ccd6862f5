//! One drawn system through all comparisons, and the tally over many.

use std::collections::BTreeMap;

use guen_symbolic::{Class, Mechanics};

use crate::brackets::{self, Coefficients};
use crate::closure::{Closure, Shapes};
use crate::declared::Declared;
use crate::derived::{Derived, derive};
use crate::draw::Draw;
use crate::system::drawn;
use crate::words::Words;
use crate::{energies, multipliers, poincare};

/// What rounding may make of a comparison, in units of condition times size.
pub const ROUNDING: f64 = 1e-12;
/// A residual of (2.7) above this is a disagreement, far beyond what rounding makes.
pub const DISAGREEMENT: f64 = 1e-6;

/// What was seen over many systems.
#[derive(Default)]
pub struct Tally {
    pub drawn: usize,
    pub ill_conditioned: usize,
    pub singular: usize,
    /// Systems in which each feature differs from zero.
    pub features: BTreeMap<&'static str, usize>,
    /// The largest differences, in units of what is allowed.
    pub worst: BTreeMap<&'static str, f64>,
    /// Systems that show the sign of each term of (2.7) turned.
    pub turned: [usize; 8],
}

impl Tally {
    /// Both tallies together.
    pub fn joined(mut self, other: Tally) -> Tally {
        self.drawn += other.drawn;
        self.ill_conditioned += other.ill_conditioned;
        self.singular += other.singular;
        for (name, count) in other.features {
            *self.features.entry(name).or_default() += count;
        }
        for (name, worst) in other.worst {
            let known = self.worst.entry(name).or_default();
            *known = known.max(worst);
        }
        for (own, count) in self.turned.iter_mut().zip(other.turned) {
            *own += count;
        }
        self
    }

    /// The systems that were compared.
    pub fn compared(&self) -> usize {
        self.drawn - self.ill_conditioned - self.singular
    }

    fn count(&mut self, name: &'static str, present: bool) {
        *self.features.entry(name).or_default() += usize::from(present);
    }

    fn hold(&mut self, seed: u64, name: &'static str, ratio: f64) {
        assert!(ratio <= ROUNDING, "seed {seed}: {name} differ by {ratio:e} of what they are");
        let worst = self.worst.entry(name).or_default();
        *worst = worst.max(ratio);
    }

    /// Draws the system of a seed and compares all that is known of it.
    pub fn examine(&mut self, seed: u64, shapes: &mut Shapes) {
        self.drawn += 1;
        let (words, mechanics) = drawn(seed);
        let declared = Declared::new(&words.graph, &mechanics);
        let mut draw = Draw::new(!seed);
        let mut point = declared.state(&mut draw);
        let reference = multipliers::solve(&declared, &point);
        let derived = derive(words.graph, mechanics, seed);
        let Some(mut derived) = derived else {
            assert!(reference.is_none(), "seed {seed}: called singular, and is not");
            self.singular += 1;
            return;
        };
        let Some(reference) = reference else {
            self.ill_conditioned += 1;
            return;
        };
        let differences = derived.compare(&declared, &mut point, &reference);
        self.hold(seed, "eta'", differences.accelerations);
        self.hold(seed, "rates in other words", differences.alternatives);
        self.count("rates in other words", !derived.alternatives.is_empty());
        self.hold(seed, "lambda", differences.reactions);
        self.hold(seed, "reaction covector", differences.covector);

        let tape = brackets::coefficients(&mut derived, declared.n);
        let (c, differences) = brackets::compare(&derived, &tape, &declared, &point);
        self.hold(seed, "operators", differences.operators);
        self.hold(seed, "commutators", differences.commutators);
        self.hold(seed, "Jacobi's identity", differences.jacobi);
        let elsewhere = declared.moved(point.clone(), &mut draw);
        let other = Coefficients::new(&tape, declared.n, &elsewhere);
        self.classify(seed, shapes, &derived, &declared, [&point, &elsewhere], [&c, &other]);

        let differences = energies::compare(&derived, &declared, &point, &reference.accelerations);
        self.hold(seed, "momenta", differences.momenta);
        self.hold(seed, "energies", differences.energies);
        if let Some(power) = differences.power {
            self.hold(seed, "h' and power", power / reference.condition);
            let conserved = differences.rate < 1e-10;
            assert_eq!(
                derived.derivation.conservative, conserved,
                "seed {seed}: h' = {:e}",
                differences.rate
            );
        }
        let derivation = &derived.derivation;
        let scleronomic = energies::scleronomic(&declared, &point);
        assert_eq!(derivation.scleronomic, scleronomic, "seed {seed}: scleronomic");
        assert_eq!(derivation.catastatic, energies::catastatic(&declared, &point), "seed {seed}: catastatic");
        self.count("conservative", derivation.conservative);
        self.count("rheonomic", !scleronomic);

        let equations = poincare::terms(&derived, &declared, &c, &point, &reference.accelerations);
        let size = reference.condition * reference.scale;
        self.hold(seed, "(2.7) as written", poincare::residual(&equations, None) / size);
        for (k, count) in self.turned.iter_mut().enumerate() {
            *count += usize::from(poincare::residual(&equations, Some(k)) > DISAGREEMENT);
        }
        self.features(&declared, &c, &point);
    }

    /// The class and the closure of the derivation against brackets of jets.
    fn classify(
        &mut self,
        seed: u64,
        shapes: &mut Shapes,
        derived: &Derived,
        declared: &Declared,
        points: [&[f64]; 2],
        coefficients: [&Coefficients; 2],
    ) {
        let (n, l) = (declared.n, declared.degrees);
        let derivation = &derived.derivation;
        let (mut point, mut closure) = (points[0], Closure::new(shapes, declared, points[0]));
        if closure.growth != derivation.closure.growth {
            // At special points ranks fall.
            (point, closure) = (points[1], Closure::new(shapes, declared, points[1]));
        }
        assert!(derivation.closure.complete, "seed {seed}: the closure was not followed to its end");
        assert_eq!(derivation.closure.growth, closure.growth, "seed {seed}: growth vector");
        assert_eq!(derivation.closure.integrable.len(), closure.integrable(n), "seed {seed}: integrable");

        let mut constant = true;
        for s in 1..=l {
            for r in 0..s {
                for t in 1..=n {
                    let [a, b] = coefficients.map(|c| c.at(r, s, t));
                    constant &= (a - b).abs() <= 1e-9 * a.abs().max(1.0);
                }
            }
        }
        let class = match (closure.growth.len() > 1, constant) {
            (true, true) => Class::IncompleteLieGroup,
            (true, false) => Class::Nonholonomic,
            (false, true) => Class::LieGroup,
            (false, false) => Class::Holonomic,
        };
        assert_eq!(derivation.class, class, "seed {seed}: class");

        let forms = declared.forms_at(point);
        for combination in &derivation.closure.integrable {
            let factors: Option<Vec<_>> = combination.terms.iter().map(|(_, f)| *f).collect();
            let Some(factors) = factors else { continue };
            let factors = derived.tape(&factors).at(point);
            let mut sum = vec![0.0; n + 1];
            for ((v, _), factor) in combination.terms.iter().zip(factors) {
                sum.iter_mut().zip(&forms[*v]).for_each(|(sum, a)| *sum += factor * a);
            }
            assert!(closure.annihilates(&sum), "seed {seed}: a combination is not integrable");
        }

        let slopes = declared.form_slopes(point);
        // a_p with p = 0 for the offset, as the variables are ordered.
        let slope = |p: usize, v: usize, q: usize| slopes[p][v][if q == 0 { n } else { q - 1 }];
        let exact =
            |v: usize| (0..=n).all(|p| (0..p).all(|q| (slope(p, v, q) - slope(q, v, p)).abs() < 1e-9));
        let alone: Vec<usize> = (l..n).filter(|v| closure.annihilates(&forms[*v])).collect();
        self.count("integrable row, not exact", alone.iter().any(|v| !exact(*v)));
        self.count("integrable only in combination", closure.integrable(n) > alone.len());
        self.count("holonomic", l < n && closure.growth.len() == 1);
        self.count("nonholonomic", closure.growth.len() > 1);
    }

    /// Which coefficients and which parts of `T°` differ from zero.
    fn features(&mut self, declared: &Declared, c: &Coefficients, point: &[f64]) {
        let (n, l) = (declared.n, declared.degrees);
        let any = |r: std::ops::RangeInclusive<usize>,
                   s: std::ops::RangeInclusive<usize>,
                   t: std::ops::RangeInclusive<usize>| {
            r.clone().any(|r| s.clone().any(|s| t.clone().any(|t| c.at(r, s, t).abs() > 1e-9)))
        };
        self.count("C_0st", any(0..=0, 1..=l, 1..=l));
        self.count("C_0sv", any(0..=0, 1..=l, l + 1..=n));
        self.count("C_rst", any(1..=l, 1..=l, 1..=l));
        self.count("C_rsv", any(1..=l, 1..=l, l + 1..=n));
        self.count("C_rvt", any(1..=l, l + 1..=n, 1..=n));
        self.count("C_0vt", any(0..=0, l + 1..=n, 1..=n));
        let (constant, linear) = energies::lower_parts(declared, point);
        self.count("constant part of T°", constant);
        self.count("linear part of T°", linear);
    }
}

/// A drawn system that is regular, derived and compared with the multipliers at one state: it, and the largest difference.
pub fn compared(words: Words, mechanics: Mechanics, seed: u64) -> Option<(Derived, f64)> {
    let declared = Declared::new(&words.graph, &mechanics);
    let mut point = declared.state(&mut Draw::new(!seed));
    let reference = multipliers::solve(&declared, &point)?;
    let derived = derive(words.graph, mechanics, seed)
        .unwrap_or_else(|| panic!("seed {seed}: called singular, and is not"));
    let differences = derived.compare(&declared, &mut point, &reference);
    for (name, ratio) in
        [("eta'", differences.accelerations), ("rates in other words", differences.alternatives)]
    {
        assert!(ratio <= ROUNDING, "seed {seed}: {name} differ by {ratio:e} of what they are");
    }
    Some((derived, differences.accelerations.max(differences.alternatives)))
}
