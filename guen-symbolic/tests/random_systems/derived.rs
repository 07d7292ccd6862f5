//! The derivation's results as tapes, compared with the multipliers.

use guen_symbolic::{Derivation, DerivationError, ExprId, Graph, Mechanics, Workbench};

use crate::declared::{Declared, lift};
use crate::multipliers::Multipliers;
use crate::tape::Tape;

/// A system that was derived.
pub struct Derived {
    pub bench: Workbench,
    pub derivation: Derivation,
    pub accelerations: Tape,
    /// The rates in other words, velocities first.
    pub alternatives: Vec<Tape>,
    /// Those of the constraints whose reaction is known.
    pub reactions: Vec<(usize, Tape)>,
}

/// Derives a system; `None` where the forms or the mass matrix are singular, which the caller confirms.
pub fn derive(graph: Graph, mechanics: Mechanics, seed: u64) -> Option<Derived> {
    let mut bench = Workbench::new(graph);
    let derivation = match Derivation::new(&mut bench, mechanics) {
        Ok(derivation) => derivation,
        Err(DerivationError::SingularForms(_) | DerivationError::SingularMass(_)) => return None,
        Err(other) => panic!("seed {seed}: {other:?}"),
    };
    let accelerations = Tape::new(&bench.graph, &derivation.solution.accelerations);
    let alternatives = derivation.formulations[1..].iter();
    let alternatives = alternatives.map(|other| Tape::new(&bench.graph, &other.rates)).collect();
    let reactions = derivation
        .reactions
        .iter()
        .enumerate()
        .filter_map(|(v, e)| e.map(|e| (v, Tape::new(&bench.graph, &[e]))))
        .collect();
    Some(Derived { bench, derivation, accelerations, alternatives, reactions })
}

/// Differences from the multipliers in units of condition times scale.
pub struct Differences {
    pub accelerations: f64,
    pub alternatives: f64,
    pub reactions: f64,
    pub covector: f64,
}

impl Derived {
    /// `eta'` at a state, and the state with these put in.
    pub fn accelerate(&self, declared: &Declared, point: &mut [f64]) -> Vec<f64> {
        let accelerations = self.accelerations.at(point);
        for (i, value) in declared.accelerations.iter().zip(&accelerations) {
            point[*i] = *value;
        }
        accelerations
    }

    /// Compares `eta'`, `lambda_v` and `R_i` at a state; the point gets its `eta'`.
    pub fn compare(&self, declared: &Declared, point: &mut [f64], reference: &Multipliers) -> Differences {
        let unit = reference.condition * reference.scale;
        let worst = |pairs: &mut dyn Iterator<Item = (f64, f64)>| {
            // NaN is worse than anything.
            let ratio = |(a, b): (f64, f64)| {
                Some((a - b).abs() / unit).filter(|x| !x.is_nan()).unwrap_or(f64::INFINITY)
            };
            pairs.map(ratio).fold(0.0, f64::max)
        };
        let own = self.accelerate(declared, point);
        let accelerations = worst(&mut own.into_iter().zip(reference.accelerations.iter().copied()));
        let rates: Vec<f64> = declared
            .velocities
            .iter()
            .map(|v| point[*v])
            .chain(reference.accelerations.iter().copied())
            .collect();
        let mut alternatives = 0.0_f64;
        for tape in &self.alternatives {
            let found = worst(&mut tape.at(point).into_iter().zip(rates.iter().copied()));
            alternatives = alternatives.max(found);
        }
        let lambdas: Vec<(usize, f64)> =
            self.reactions.iter().map(|(v, tape)| (*v, tape.at(point).remove(0))).collect();
        let reactions = worst(&mut lambdas.iter().map(|(v, value)| (*value, reference.reactions[*v])));
        // Constraints without momentum have no reaction to offer: theirs is taken over.
        let mut all = reference.reactions.clone();
        for (v, value) in &lambdas {
            all[*v] = *value;
        }
        let forms = declared.forms_at(point);
        let covector = (0..declared.n).map(|i| {
            all.iter().zip(&forms[declared.degrees..]).map(|(lambda, row)| lambda * row[i]).sum::<f64>()
        });
        let covector = worst(&mut covector.zip(reference.covector.iter().copied()));
        Differences { accelerations, alternatives, reactions, covector }
    }

    /// `x''` at a state that has its `eta'`.
    pub fn second(&self, declared: &Declared, point: &[f64], accelerations: &[f64]) -> Vec<f64> {
        let rates = declared.rates(point, accelerations);
        let velocities = self.tape(&self.derivation.frame.velocities);
        velocities.at(&lift(point, |k| rates[k])).iter().map(|v| v.du).collect()
    }

    /// `R_i = sum_v lambda_v a_vi` at a state that has its `eta'`; `None` if a reaction is not known.
    pub fn covector(&self, declared: &Declared, point: &[f64]) -> Option<Vec<f64>> {
        if self.reactions.len() < declared.n - declared.degrees {
            return None;
        }
        let lambdas: Vec<f64> = self.reactions.iter().map(|(_, tape)| tape.at(point)[0]).collect();
        let forms = &declared.forms_at(point)[declared.degrees..];
        let component = |i: usize| lambdas.iter().zip(forms).map(|(lambda, row)| lambda * row[i]).sum();
        Some((0..declared.n).map(component).collect())
    }

    /// A tape of expressions of the derivation.
    pub fn tape(&self, roots: &[ExprId]) -> Tape {
        Tape::new(&self.bench.graph, roots)
    }
}
