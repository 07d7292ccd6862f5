//! Energies, momenta and what is conserved, against duals of the declared functions.

use crate::declared::{Declared, lift};
use crate::derived::Derived;
use crate::tape::Tape;

/// Differences in units of the size of what is compared.
pub struct Differences {
    pub momenta: f64,
    pub energies: f64,
    /// `h'` against `power`; `None` where a reaction would be needed that is not known.
    pub power: Option<f64>,
    /// `|h'|` in units of the terms it may consist of.
    pub rate: f64,
}

/// Compares at a state that has its `eta'`.
pub fn compare(derived: &Derived, declared: &Declared, point: &[f64], accelerations: &[f64]) -> Differences {
    let (n, l) = (declared.n, declared.degrees);
    let energies = &derived.derivation.energies;
    let ratio = |a: f64, b: f64, size: f64| {
        let ratio = (a - b).abs() / size.max(1.0);
        if ratio.is_nan() { f64::INFINITY } else { ratio }
    };

    let momenta: Vec<f64> = (0..n)
        .map(|j| declared.kinetic_of_etas(lift(point, |k| if k == declared.etas[j] { 1.0 } else { 0.0 })).du)
        .collect();
    let largest = momenta.iter().map(|p| p.abs()).fold(1.0, f64::max);
    let found = derived.tape(&energies.momenta).at(point);
    let momentum = found.iter().zip(&momenta).map(|(a, b)| ratio(*a, *b, largest)).fold(0.0, f64::max);

    // sum_i x_i' d/dx_i' as one direction.
    let scaling = lift(point, |k| if declared.velocities.contains(&k) { point[k] } else { 0.0 });
    let kinetic = declared.kinetic(scaling);
    let potential = declared.potential(point);
    let size = kinetic.re.abs() + kinetic.du.abs() + potential.abs();
    let h = derived.tape(&[energies.integral]);
    let energy = ratio(derived.tape(&[energies.kinetic]).at(point)[0], kinetic.re, size).max(ratio(
        h.at(point)[0],
        kinetic.du - kinetic.re - potential,
        size,
    ));

    let rates = declared.rates(point, accelerations);
    let rate = h.at(&lift(point, |k| rates[k]))[0].du;
    // The powers that h' is the balance of: inertia, momenta, gravity.
    let motion: f64 = accelerations.iter().zip(&found[..l]).map(|(a, p)| (a * p).abs()).sum();
    let size = size + motion + rate.abs();
    let needed = derived
        .derivation
        .reactions
        .iter()
        .zip(&derived.derivation.system.forms.forms[l..])
        .all(|(reaction, form)| reaction.is_some() || derived.bench.graph.is_zero(form.offset));
    let power = needed.then(|| ratio(derived.tape(&[derived.derivation.power]).at(point)[0], rate, size));
    Differences { momenta: momentum, energies: energy, power, rate: rate.abs() / size.max(1.0) }
}

/// Whether time is absent from the forms of the constraints, from `T°` as a function of `x, x'`, and from `U`.
pub fn scleronomic(declared: &Declared, point: &[f64]) -> bool {
    let moving = lift(point, |k| if k == declared.time { 1.0 } else { 0.0 });
    let still = |slope: f64| slope.abs() < 1e-12;
    declared.forms_at(&moving)[declared.degrees..].iter().flatten().all(|a| still(a.du))
        && still(declared.kinetic(moving.clone()).du)
        && still(declared.potential(&moving).du)
}

/// Whether no constraint has a term without velocity.
pub fn catastatic(declared: &Declared, point: &[f64]) -> bool {
    declared.forms_at(point)[declared.degrees..].iter().all(|row| row[declared.n] == 0.0)
}

/// `T°` and its slopes by `x'` at rest: do the constant and the linear part differ from zero?
pub fn lower_parts(declared: &Declared, point: &[f64]) -> (bool, bool) {
    let mut resting = point.to_vec();
    for v in &declared.velocities {
        resting[*v] = 0.0;
    }
    let constant = declared.kinetic(resting.clone()).abs() > 1e-9;
    let linear = declared
        .velocities
        .iter()
        .any(|v| declared.kinetic(lift(&resting, |k| if k == *v { 1.0 } else { 0.0 })).du.abs() > 1e-9);
    (constant, linear)
}

/// The momenta `dT/d eta_s` and `(dT°/d eta_v)` as a tape.
pub fn momenta(derived: &Derived) -> Tape {
    derived.tape(&derived.derivation.energies.momenta)
}
