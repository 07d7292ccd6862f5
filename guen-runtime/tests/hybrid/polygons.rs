//! Polygons that are thrown onto a rough floor: at random, whatever happens is one of the laws' motions.

use guen_runtime::Lift;
use guen_runtime::hybrid::{
    Element, ElementState, FreeMotion, HybridCause, HybridSystem, InMode, Mode, Signal, TransitionKind,
};

use crate::bodies::Parts;

const G: f64 = 9.81;

/// A rigid quadrangle: its corners, inertia, friction and restitution.
#[derive(Clone, Copy, Debug)]
struct Polygon {
    corners: [[f64; 2]; 4],
    inertia: f64,
    friction: f64,
    restitution: f64,
}

impl HybridSystem<6, 8, 4, 0> for Polygon {
    const ELEMENTS: [Element; 4] = [
        Element::rough("a", 0, &[1]),
        Element::rough("b", 2, &[3]),
        Element::rough("c", 4, &[5]),
        Element::rough("d", 6, &[7]),
    ];
    const SIGNALS: [Signal; 0] = [];
    const COORDINATES: usize = 3;
    crate::without_inputs!(4 elements);

    fn free_motion<R: Lift<f64>>(&self, _t: R, x: &[R; 6], _: &[R; 0], _: &[R; 4]) -> FreeMotion<R, 6, 8, 4> {
        let c = |value: f64| R::lift(value);
        let (zero, one) = (R::zero(), R::one());
        let mut parts = Parts::<R, 3, 8, 4>::nothing().masses([one, one, c(self.inertia)]);
        parts.forces = [zero, c(-G), zero];
        let ((sin, cos), omega) = (x[2].sin_cos(), x[5]);
        for (k, [a, b]) in self.corners.into_iter().enumerate() {
            let (dx, dz) = (cos * c(a) - sin * c(b), sin * c(a) + cos * c(b));
            parts.rows[2 * k] = [zero, one, dx];
            parts.rows[2 * k + 1] = [one, zero, -dz];
            parts.biases[2 * k] = -dz * omega * omega;
            parts.biases[2 * k + 1] = -dx * omega * omega;
            parts.gaps[k] = x[1] + dz;
        }
        (parts.friction, parts.stiction) = ([c(self.friction); 4], [c(self.friction); 4]);
        parts.free_motion(x)
    }

    fn restitutions(&self) -> [f64; 4] {
        [self.restitution; 4]
    }

    fn signals<R: Lift<f64>>(&self, _t: R, _x: &[R; 6]) -> [R; 0] {
        []
    }
}

impl Polygon {
    fn energy(&self, x: &[f64; 6]) -> f64 {
        0.5 * (x[3] * x[3] + x[4] * x[4] + self.inertia * x[5] * x[5]) + G * x[1]
    }

    /// The largest violation of the laws in a mode at a state.
    fn residual(&self, t: f64, x: &[f64; 6], mode: &Mode<4>) -> f64 {
        let in_mode = InMode::new(*self, *mode, t, x);
        let motion = in_mode.reactions(t, x);
        let accelerations = motion.row_accelerations();
        let least = in_mode.with_least_norm(&motion);
        let mut worst = 0.0_f64;
        for c in 0..4 {
            let (n, s) = (2 * c, 2 * c + 1);
            let (normal, along) = (least.reactions[n], least.reactions[s]);
            let violation = match mode.0[c] {
                ElementState::Open => (-motion.free.gaps[c]).max(0.0),
                state => {
                    let still = motion.free.gaps[c].abs().max(motion.free.row_rates[n].abs());
                    let held = accelerations[n].abs();
                    let push = if in_mode.is_redundant() { 0.0 } else { (-normal).max(0.0) };
                    let slip = motion.free.row_rates[s];
                    let friction = match state {
                        ElementState::Stick if in_mode.is_redundant() => slip.abs(),
                        ElementState::Stick => {
                            slip.abs().max(accelerations[s].abs()).max(along.abs() - self.friction * normal)
                        }
                        ElementState::SlipForward => (along + self.friction * normal).abs().max(-slip),
                        ElementState::SlipBackward => (along - self.friction * normal).abs().max(slip),
                        state => panic!("{state:?}"),
                    };
                    still.max(held).max(push).max(friction)
                }
            };
            worst = worst.max(violation);
        }
        worst
    }
}

/// Numbers between minus one and one, from a seed.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 11) as f64 / (1_u64 << 52) as f64) - 1.0
    }
}

#[test]
fn thrown_polygons_keep_the_laws_and_lose_energy() {
    let rounds = std::env::var("GUEN_ROUNDS").ok().and_then(|rounds| rounds.parse().ok()).unwrap_or(6);
    let mut random = Random(2026);
    let (mut transitions, mut rests, mut failures) = (0, 0, 0);
    for round in 0..rounds {
        let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
            .map(|corner: [f64; 2]| corner.map(|entry| entry * (0.6 + 0.4 * random.next().abs())));
        let polygon = Polygon {
            corners,
            inertia: 0.3 + 0.3 * random.next().abs(),
            friction: 0.05 + 0.5 * random.next().abs(),
            restitution: 0.7 * random.next().abs(),
        };
        let start =
            [0.0, 2.5 + random.next(), 3.0 * random.next(), 2.0 * random.next(), 0.0, 2.0 * random.next()];
        let motion = match polygon.simulation(&start).tolerance(1e-11).run(0.0..4.0) {
            Ok(motion) => motion,
            Err(failed) => {
                println!("round {round}: {failed} with {polygon:?}");
                let expected = matches!(
                    failed.error.cause,
                    HybridCause::EnergyGain { .. }
                        | HybridCause::Painleve { .. }
                        | HybridCause::SeveralImpacts
                );
                assert!(expected, "{failed:?} {:#?}", failed.trajectory.transitions().last());
                failures += 1;
                *failed.trajectory
            }
        };
        transitions += motion.transitions().len();
        let mut last = polygon.energy(&start);
        for transition in motion.transitions() {
            let (before, after) =
                (polygon.energy(&transition.state_before), polygon.energy(&transition.state_after));
            assert!(before <= last + 1e-8, "round {round}: {before} after {last}");
            assert!(after <= before + 1e-10, "round {round}: {transition:?}");
            assert!((after - before - transition.energy).abs() < 1e-9, "{transition:?}");
            last = after;
            if matches!(transition.kind, TransitionKind::Rest { .. }) {
                rests += 1;
            }
        }
        for (t, x) in motion.sample(0.01) {
            let residual = polygon.residual(t, &x, &motion.mode_at(t));
            assert!(residual < 1e-9, "round {round} at {t}: {residual:e} in {}", motion.mode_at(t));
        }
    }
    println!(
        "{transitions} transitions, {rests} ends of accumulations, {failures} typed errors in {rounds} runs"
    );
    assert!(transitions > 5 * rounds && rests > rounds / 4 && failures <= rounds / 10);
}

#[test]
fn the_order_of_declaration_does_not_matter() {
    let mut random = Random(5);
    for _ in 0..4 {
        let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
            .map(|corner: [f64; 2]| corner.map(|entry| entry * (0.6 + 0.4 * random.next().abs())));
        let polygon = Polygon { corners, inertia: 0.5, friction: 0.3, restitution: 0.4 };
        let [a, b, c, d] = corners;
        let permuted = Polygon { corners: [c, a, d, b], ..polygon };
        let start = [0.0, 2.5, random.next(), random.next(), 0.0, random.next()];
        let run = |polygon: &Polygon| polygon.simulation(&start).tolerance(1e-11).run(0.0..1.5).unwrap();
        let (one, other) = (run(&polygon), run(&permuted));
        let pairs = one.transitions().iter().zip(other.transitions());
        assert!(one.transitions().len() > 1 && one.transitions().len() == other.transitions().len());
        for (one, other) in pairs {
            let [first, second, third, fourth] = one.after.0;
            assert!((one.t - other.t).abs() < 1e-9, "{one:?} {other:?}");
            assert_eq!(other.after.0, [third, first, fourth, second]);
        }
    }
}
