//! The laws that a motion through modes keeps, judged from the free motion alone.

use guen_runtime::hybrid::{
    Element, ElementState, FreeMotion, HybridSystem, InMode, Kind, Mode, Transition, TransitionKind,
};
use nalgebra::{DMatrix, DVector};

use crate::held;
use crate::lcp::{Part, Tangent, forces};

/// What was judged.
#[derive(Clone, Copy, Debug, Default)]
pub struct Judged {
    pub transitions: usize,
    pub modes: usize,
    pub impacts: usize,
    /// Problems in which Lemke's pivoting ends in a ray.
    pub rays: usize,
    /// Modes and impacts beside which others are possible: with more rows than freedom Coulomb's law does not determine the motion.
    pub several: usize,
    /// The largest violation of a law, and the largest difference from the other solver, relative to the sizes of the rates.
    pub violation: f64,
    pub difference: f64,
}

fn matrix<const W: usize>(free: &[[f64; W]; W]) -> DMatrix<f64> {
    DMatrix::from_fn(W, W, |i, j| free[i][j])
}

fn free<H, const N: usize, const W: usize, const C: usize>(
    system: &H,
    t: f64,
    x: &[f64; N],
) -> FreeMotion<f64, N, W, C>
where
    H: HybridSystem<N, W, C, 0>,
{
    system.free_motion(t, x, &[], &[0.0; C])
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(1.0, |most: f64, value| most.max(value.abs()))
}

/// The slip of an element that counts as none, and the one from which it may as well be one in the direction of its mode.
const STILL: f64 = 1e-12;
const HARDLY: f64 = 1e-15;

/// The parts in which slips that are hardly any have the directions of the mode.
fn directed<const C: usize>(mut parts: [Part; C], mode: &Mode<C>, rates: &[f64], of_rates: f64) -> [Part; C] {
    for (part, state) in parts.iter_mut().zip(&mode.0) {
        let sign = match state {
            ElementState::SlipForward => 1.0,
            ElementState::SlipBackward => -1.0,
            _ => continue,
        };
        let (Part::Contact { tangent: Some(Tangent { row, slips, .. }), .. } | Part::Grip { row, slips, .. }) =
            part
        else {
            continue;
        };
        if slips.is_none() && rates[*row].abs() > HARDLY * of_rates {
            *slips = Some(sign);
        }
    }
    parts
}

/// Whether accelerations lead on in a mode: what is open and touches does not close, and slips that are hardly any begin along their directions.
fn leads_on<const C: usize>(
    elements: &[Element; C],
    parts: &[Part; C],
    mode: &Mode<C>,
    accelerations: &[f64],
    of_biases: f64,
) -> bool {
    let holds = |acceleration: f64| acceleration >= -1e-10 * of_biases;
    elements.iter().zip(parts).zip(&mode.0).all(|((element, part), state)| match (part, state) {
        (Part::Contact { normal, .. }, ElementState::Open) => holds(accelerations[*normal]),
        (
            Part::Contact { tangent: Some(Tangent { slips: None, .. }), .. } | Part::Grip { slips: None, .. },
            ElementState::SlipForward | ElementState::SlipBackward,
        ) => holds(f64::from(state.sign()) * accelerations[element.tangential[0]]),
        _ => true,
    })
}

impl Judged {
    /// Judges a mode at a state: its laws, and its accelerations beside those of another solver.
    pub fn mode<H, const N: usize, const W: usize, const C: usize>(
        &mut self,
        system: &H,
        (t, x): (f64, &[f64; N]),
        mode: &Mode<C>,
    ) -> Result<(), String>
    where
        H: HybridSystem<N, W, C, 0> + Copy,
    {
        let in_mode = InMode::new(*system, *mode, t, x);
        let motion = in_mode.reactions(t, x);
        let (accelerations, reactions) = (motion.row_accelerations(), motion.reactions);
        let free = free::<H, N, W, C>(system, t, x);
        let (of_rates, of_biases) = (largest(&free.row_rates), largest(&free.biases));
        let of_forces = largest(&reactions);
        let mut parts = [Part::None; C];
        let mut worst = 0.0_f64;
        let mut spatial = false;
        // Where reactions are not determined the other solver finds some, and the accelerations are those of all of them.
        let determined = if in_mode.is_redundant() { 0.0 } else { 1.0 };
        for (c, element) in H::ELEMENTS.iter().enumerate() {
            let state = mode.0[c];
            let slips = |row: usize| {
                let slip = free.row_rates[row];
                (slip.abs() > STILL * of_rates).then(|| slip.signum())
            };
            let violation = match element.normal {
                Some(row) => {
                    let (gap, rate) = (free.gaps[c], free.row_rates[row]);
                    // Bounces that die out are lower than digits, and not at rest.
                    let touches = gap.abs() < 1e-15 && rate.abs() < 1e-15 * of_rates;
                    if touches || state != ElementState::Open {
                        let tangent = element.tangential.first().map(|&row| Tangent {
                            row,
                            friction: free.friction[c],
                            slips: slips(row),
                        });
                        parts[c] = Part::Contact { normal: row, floor: 0.0, tangent };
                    }
                    match state {
                        ElementState::Open => (-gap).max(0.0),
                        _ => {
                            let still = gap.abs().max(rate.abs() / of_rates);
                            let held = accelerations[row].abs() / of_biases;
                            still.max(held).max(determined * (-reactions[row]).max(0.0) / of_forces)
                        }
                    }
                }
                None => {
                    let row = element.tangential[0];
                    parts[c] = Part::Grip { row, limit: free.limits[c], slips: slips(row) };
                    0.0
                }
            };
            worst = worst.max(violation);
            if state == ElementState::Open || element.kind == Kind::Smooth {
                continue;
            }
            let normal = element.normal.map_or(0.0, |row| reactions[row]);
            let limit = free.limits[c] + free.friction[c] * normal;
            let along: Vec<f64> = element.tangential.iter().map(|&row| reactions[row]).collect();
            let slip: Vec<f64> = element.tangential.iter().map(|&row| free.row_rates[row]).collect();
            let size = |vector: &[f64]| vector.iter().map(|entry| entry * entry).sum::<f64>().sqrt();
            worst = worst.max(determined * (size(&along) - limit).max(0.0) / of_forces);
            spatial |= element.tangential.len() == 2;
            let friction = match state {
                ElementState::Stick => {
                    let held = element.tangential.iter().map(|&row| accelerations[row].abs());
                    (size(&slip) / of_rates).max(held.fold(0.0, f64::max) / of_biases)
                }
                ElementState::SlipForward => (along[0] + limit).abs() / of_forces + (-slip[0]).max(0.0),
                ElementState::SlipBackward => (along[0] - limit).abs() / of_forces + slip[0].max(0.0),
                // Against the slip, and at the limit; next to rest the slip does not tell the direction.
                ElementState::Slip if size(&slip) > 1e-3 => {
                    (0..2)
                        .map(|k| along[k] * size(&slip) + limit * slip[k])
                        .fold(0.0, |m: f64, v| m.max(v.abs()))
                        / (of_forces * size(&slip))
                }
                _ => 0.0,
            };
            worst = worst.max(friction);
        }
        self.modes += 1;
        self.violation = self.violation.max(worst);
        if worst > 1e-10 {
            return Err(format!("violation {worst:e} in ({mode}) at {t}, {x:?}"));
        }
        if spatial {
            return Ok(());
        }
        let delassus = matrix(&free.delassus);
        let biases = DVector::from_row_slice(&free.biases);
        let Some(found) = forces(&delassus, &biases, &parts) else {
            self.rays += 1;
            return Ok(());
        };
        let other = &biases + &delassus * found;
        let apart = |other: &DVector<f64>| {
            (0..W).map(|w| (other[w] - accelerations[w]).abs()).fold(0.0, f64::max) / of_biases.max(of_forces)
        };
        let mut difference = apart(&other);
        if difference > 1e-7
            && let Some(found) = forces(&delassus, &biases, &directed(parts, mode, &free.row_rates, of_rates))
        {
            difference = difference.min(apart(&(&biases + &delassus * found)));
        }
        if difference > 1e-7 && in_mode.is_redundant() {
            // Both go on where forces exist for both.
            if let Some(found) = held::forces(&H::ELEMENTS, &free, mode) {
                difference = apart(&(biases + delassus * found));
            }
            self.several += 1;
        } else if difference > 1e-7 && leads_on(&H::ELEMENTS, &parts, mode, &accelerations, of_biases) {
            // Forces and accelerations of the mode satisfy every law: Coulomb's law has two answers here, and the other solver found one.
            difference = 0.0;
            self.several += 1;
        }
        self.difference = self.difference.max(difference);
        if difference > 1e-7 {
            let ours = accelerations;
            return Err(format!(
                "accelerations {ours:?}, of the other solver {other:?}, in ({mode}) at {t}, {x:?} {parts:?}"
            ));
        }
        Ok(())
    }

    /// Judges a transition: energies, the law of impact by another solver, and the mode after it.
    pub fn transition<H, const N: usize, const W: usize, const C: usize>(
        &mut self,
        system: &H,
        transition: &Transition<Mode<C>, N, W, C>,
        kinetic: impl Fn(&[f64]) -> f64,
    ) -> Result<(), String>
    where
        H: HybridSystem<N, W, C, 0> + Copy,
    {
        self.transitions += 1;
        let (before, after) = (kinetic(&transition.state_before), kinetic(&transition.state_after));
        // Where infinitely many impacts are left out, forces do their work from here on: that of the time until the end of the sequence.
        let ahead = match transition.kind {
            TransitionKind::Rest { until, .. } => 100.0 * (until - transition.t),
            _ => 0.0,
        };
        if after > before + (1e-11 + ahead) * before.max(1.0) {
            return Err(format!("the energy grows from {before} to {after}: {transition:?}"));
        }
        if (after - before - transition.energy).abs() > 1e-10 * before.max(1.0) {
            return Err(format!("the energy changes by {}: {transition:?}", after - before));
        }
        if transition.kind == TransitionKind::Impact {
            self.impact(system, transition)?;
        }
        // Where infinitely many impacts are left out, or a touch is told of, the mode has no beginning there.
        if !matches!(transition.kind, TransitionKind::Touch) {
            self.mode(system, (transition.t, &transition.state_after), &transition.after)?;
        }
        Ok(())
    }

    fn impact<H, const N: usize, const W: usize, const C: usize>(
        &mut self,
        system: &H,
        transition: &Transition<Mode<C>, N, W, C>,
    ) -> Result<(), String>
    where
        H: HybridSystem<N, W, C, 0> + Copy,
    {
        let free = free::<H, N, W, C>(system, transition.t, &transition.state_before);
        let after = system.row_rates(transition.t, &transition.state_after);
        let of_rates = largest(&free.row_rates);
        // A gap of a ten-billionth is one: bounces that die out are that low.
        let touches = |c: usize| {
            transition.before.0[c].is_closed() || transition.elements[c] || free.gaps[c].abs() < 3e-16
        };
        let spatial = H::ELEMENTS.iter().any(|element| element.tangential.len() == 2);
        for (c, element) in H::ELEMENTS.iter().enumerate() {
            let Some(row) = element.normal.filter(|_| touches(c)) else { continue };
            let size = |values: &[f64; W]| {
                element.tangential.iter().map(|&row| values[row] * values[row]).sum::<f64>().sqrt()
            };
            let (normal, along) = (transition.impulses[row], size(&transition.impulses));
            let outside = (along - free.friction[c] * normal).max(-normal).max(-after[row]);
            if outside > 1e-10 * of_rates.max(normal) {
                return Err(format!("an impulse outside of its cone by {outside:e}: {transition:?}"));
            }
        }
        self.impacts += 1;
        if spatial {
            return Ok(());
        }
        let delassus = matrix(&free.delassus);
        let parts = |floors: [f64; C]| -> [Part; C] {
            core::array::from_fn(|c| {
                let element: &Element = &H::ELEMENTS[c];
                let touches = touches(c);
                let Some(normal) = element.normal.filter(|_| touches) else { return Part::None };
                let tangent = element.tangential.first().map(|&row| Tangent {
                    row,
                    friction: free.friction[c],
                    slips: None,
                });
                Part::Contact { normal, floor: floors[c], tangent }
            })
        };
        let biases = DVector::from_row_slice(&free.row_rates);
        let Some(compression) = forces(&delassus, &biases, &parts([0.0; C])) else {
            self.rays += 1;
            return Ok(());
        };
        let middle = &biases + &delassus * &compression;
        let restitutions = system.restitutions();
        let floors = core::array::from_fn(|c| {
            let impulse = H::ELEMENTS[c].normal.map_or(0.0, |row| compression[row]);
            restitutions[c] * impulse
        });
        let Some(expansion) = forces(&delassus, &middle, &parts(floors)) else {
            self.rays += 1;
            return Ok(());
        };
        let end = middle + &delassus * expansion;
        let difference = (0..W).map(|w| (end[w] - after[w]).abs()).fold(0.0, f64::max) / of_rates;
        let struck = H::ELEMENTS.iter().enumerate().filter(|(c, _)| touches(*c));
        let rows: usize =
            struck.map(|(_, element)| usize::from(element.normal.is_some()) + element.tangential.len()).sum();
        if difference > 1e-8 && rows > N / 2 {
            self.several += 1;
            return Ok(());
        }
        self.difference = self.difference.max(difference);
        if difference > 1e-8 {
            return Err(format!(
                "rates after the impact {after:?}, of the other solver {end:?}: {transition:?}"
            ));
        }
        Ok(())
    }
}
