//! Scenes with closed forms: one for each kind of element and of transition.

use core::ops::ControlFlow;

use guen_runtime::Lift;
use guen_runtime::hybrid::{
    Conditions, Element, ElementState, FreeMotion, Hybrid, HybridCause, HybridError, HybridSystem, InMode,
    Mode, Signal, Transition, TransitionKind,
};
use guen_runtime::steppers::{Dop853, Method, Taylor, Tsit5};

use crate::bodies::Parts;

fn c<R: Lift<f64>>(value: f64) -> R {
    R::lift(value)
}

type Told<const N: usize, const W: usize, const C: usize> = Vec<Transition<Mode<C>, N, W, C>>;

/// A run to a time, with what it tells.
fn run<H, M, const N: usize, const W: usize, const C: usize, const S: usize>(
    system: &H,
    method: &M,
    start: [f64; N],
    end: f64,
) -> (Told<N, W, C>, Result<([f64; N], Mode<C>), HybridError<N, C>>)
where
    H: HybridSystem<N, W, C, S, Mode = Mode<C>> + Clone,
    M: Method<f64, InMode<H, N, W, C, S>, N>,
{
    let mut told = Vec::new();
    let done = Hybrid::new(system, 0.0, &start)
        .transitions(&mut |tr| {
            told.push(*tr);
            ControlFlow::Continue(())
        })
        .run(method, end);
    (told, done.map(|done| (done.state, done.mode)))
}

fn kinds<const N: usize, const W: usize, const C: usize>(told: &Told<N, W, C>) -> Vec<TransitionKind> {
    told.iter().map(|tr| tr.kind).collect()
}

const TIGHT: (f64, f64) = (1e-11, 1e-11);

fn dop853() -> Dop853<f64> {
    Dop853::new(TIGHT.0, TIGHT.1)
}

/// A point on a vertical line between a floor and a ceiling, under gravity.
#[derive(Clone, Copy, Debug)]
pub struct Shaft {
    pub g: f64,
    pub height: f64,
    pub restitution: f64,
    /// The amplitude and the frequency of the floor.
    pub shakes: (f64, f64),
}

impl HybridSystem<2, 2, 2, 0> for Shaft {
    const ELEMENTS: [Element; 2] = [Element::smooth("floor", 0), Element::smooth("ceiling", 1)];
    const SIGNALS: [Signal; 0] = [];
    const COORDINATES: usize = 1;
    crate::without_inputs!(2 elements);

    fn free_motion<R: Lift<f64>>(&self, t: R, x: &[R; 2], _: &[R; 0], _: &[R; 2]) -> FreeMotion<R, 2, 2, 2> {
        let (amplitude, frequency) = (c::<R>(self.shakes.0), c::<R>(self.shakes.1));
        let (sin, cos) = (frequency * t).sin_cos();
        let mut parts = Parts::<R, 1, 2, 2>::nothing().masses([R::one()]);
        parts.forces = [-c::<R>(self.g)];
        parts.rows = [[R::one()], [-R::one()]];
        parts.drifts = [-amplitude * frequency * cos, R::zero()];
        parts.biases = [amplitude * frequency * frequency * sin, R::zero()];
        parts.gaps = [x[0] - amplitude * sin, c::<R>(self.height) - x[0]];
        parts.free_motion(x)
    }

    fn row_drifts(&self, t: f64, _x: &[f64; 2]) -> [f64; 2] {
        [-self.shakes.0 * self.shakes.1 * f64::cos(self.shakes.1 * t), 0.0]
    }

    fn restitutions(&self) -> [f64; 2] {
        [self.restitution; 2]
    }

    fn signals<R: Lift<f64>>(&self, _t: R, _x: &[R; 2]) -> [R; 0] {
        []
    }
}

#[test]
fn a_ceiling_that_is_grazed_is_a_touch() {
    let still = Shaft { g: 10.0, height: 5.0, restitution: 0.5, shakes: (0.0, 0.0) };
    let (told, _) = run(&still, &dop853(), [0.0, 10.0], 1.5);
    assert_eq!(kinds(&told), [TransitionKind::Touch], "{told:?}");
    assert!((told[0].t - 1.0).abs() < 1e-7 && told[0].elements == [false, true]);
    let (told, _) = run(&still, &Taylor::new(1e-14, 1e-14), [0.0, 10.0], 1.5);
    assert_eq!(kinds(&told), [TransitionKind::Touch]);
    // A little faster it bounces, a little slower it passes: both within one step.
    let (told, _) = run(&still, &dop853(), [0.0, 10.0 + 1e-7], 1.5);
    assert_eq!(kinds(&told), [TransitionKind::Impact]);
    let speed = f64::sqrt(2.0 * 10.0 * 1e-7);
    assert!(
        (told[0].state_before[1] - speed).abs() < 1e-7 && (told[0].state_after[1] + 0.5 * speed).abs() < 1e-7
    );
    let (told, _) = run(&still, &dop853(), [0.0, 10.0 - 1e-7], 1.5);
    assert!(told.is_empty());
}

#[test]
fn a_shaken_floor_lifts_what_rests_on_it() {
    // It rests on the floor until the floor's acceleration is -g: sin(w t) = g/(A w^2).
    let (amplitude, frequency) = (0.5, 6.0);
    let shaken = Shaft { g: 10.0, height: 1e9, restitution: 0.0, shakes: (amplitude, frequency) };
    let (told, _) = run(&shaken, &dop853(), [0.0, amplitude * frequency], 0.4);
    let lifted = f64::asin(10.0 / (amplitude * frequency * frequency)) / frequency;
    assert_eq!(kinds(&told)[..1], [TransitionKind::Lifted], "{told:?}");
    assert!((told[0].t - lifted).abs() < 1e-10, "{} {lifted}", told[0].t);
    // It lands without a rebound; the energy that the impact takes is that of the mass, whatever the floor does.
    let (told, done) = run(&shaken, &dop853(), [0.0, amplitude * frequency], 2.0);
    let landing = told.iter().find(|tr| tr.kind == TransitionKind::Impact).unwrap();
    let (before, after) = (landing.state_before[1], landing.state_after[1]);
    assert!((after - amplitude * frequency * f64::cos(frequency * landing.t)).abs() < 1e-9);
    assert!((landing.energy - 0.5 * (after * after - before * before)).abs() < 1e-9);
    assert!(done.is_ok());
}

#[test]
fn bouncing_without_loss_goes_back_the_way_it_came() {
    let elastic = Shaft { g: 10.0, height: 5.0, restitution: 1.0, shakes: (0.0, 0.0) };
    let method = Taylor::new(1e-15, 1e-15);
    let (told, done) = run(&elastic, &method, [3.0, 8.0], 20.0);
    assert!(told.len() > 20 && told.iter().all(|tr| tr.kind == TransitionKind::Impact));
    let ([z, v], _) = done.unwrap();
    let (_, back) = run(&elastic, &method, [z, -v], 20.0);
    let ([z, v], _) = back.unwrap();
    assert!((z - 3.0).abs() < 1e-10 && (v + 8.0).abs() < 1e-10, "{z} {v}");
}

#[test]
fn thousands_of_transitions_lose_nothing() {
    // An elastic ball between floor and ceiling: its energy is that of the start after every impact.
    let elastic = Shaft { g: 10.0, height: 1.0, restitution: 1.0, shakes: (0.0, 0.0) };
    let end = if std::env::var_os("GUEN_ROUNDS").is_some() { 1000.0 } else { 100.0 };
    let energy = |x: &[f64; 2]| 0.5 * x[1] * x[1] + 10.0 * x[0];
    let (start, mut count, mut worst) = ([0.5, 9.0], 0, 0.0_f64);
    let done = Hybrid::new(&elastic, 0.0, &start)
        .transitions(&mut |tr: &Transition<Mode<2>, 2, 2, 2>| {
            assert_eq!(tr.kind, TransitionKind::Impact);
            count += 1;
            worst = worst.max((energy(&tr.state_after) - energy(&start)).abs());
            ControlFlow::Continue(())
        })
        .run(&dop853(), end)
        .unwrap();
    assert!(f64::from(count) > 8.0 * end && done.transitions == u64::try_from(count).unwrap());
    assert!(worst < 1e-12 * f64::from(count), "{worst:e} after {count}");
}

#[test]
fn what_penetrates_at_the_start_is_refused() {
    let still = Shaft { g: 10.0, height: 5.0, restitution: 0.5, shakes: (0.0, 0.0) };
    let (_, done) = run(&still, &dop853(), [-0.1, 0.0], 1.0);
    assert_eq!(done.unwrap_err().cause, HybridCause::Penetrating { contact: "floor", gap: -0.1 });
    // On the floor and moving into it: an impact at once.
    let (told, done) = run(&still, &dop853(), [0.0, -2.0], 0.1);
    assert_eq!(kinds(&told), [TransitionKind::Impact]);
    assert!((told[0].t, told[0].state_after[1]) == (0.0, 1.0) && done.is_ok());
    // At rest on it.
    let (told, done) = run(&still, &dop853(), [0.0, 0.0], 0.1);
    assert!(told.is_empty());
    assert_eq!(done.unwrap().1, Mode([ElementState::Closed, ElementState::Open]));
}

/// A cart that a growing force pushes, held by a grip; a switch turns the force off.
#[derive(Clone, Copy, Debug)]
pub struct GrippedCart {
    pub limit: f64,
    pub off: f64,
    pub push: f64,
}

impl HybridSystem<2, 1, 1, 1> for GrippedCart {
    const ELEMENTS: [Element; 1] = [Element::grip("brake", &[0])];
    const SIGNALS: [Signal; 1] = [Signal::switch("pushed")];
    const COORDINATES: usize = 1;
    type Mode = Mode<1>;
    type Inputs = f64;

    fn with_inputs(&self, push: f64) -> Self {
        Self { push, ..*self }
    }

    fn free_motion<R: Lift<f64>>(&self, t: R, x: &[R; 2], on: &[R; 1], _: &[R; 1]) -> FreeMotion<R, 2, 1, 1> {
        let mut parts = Parts::<R, 1, 1, 1>::nothing().masses([c(2.0)]);
        parts.forces = [c::<R>(self.push) * t * on[0]];
        parts.rows = [[R::one()]];
        parts.limits = [c(self.limit)];
        parts.free_motion(x)
    }

    fn restitutions(&self) -> [f64; 1] {
        [0.0]
    }

    fn signals<R: Lift<f64>>(&self, t: R, _x: &[R; 2]) -> [R; 1] {
        [c::<R>(self.off) - t]
    }
}

#[test]
fn a_grip_holds_to_its_limit_slips_and_holds_again() {
    // 2 x'' = t - 3 from t = 3 to 5, then 2 x'' = -3.
    let cart = GrippedCart { limit: 3.0, off: 5.0, push: 1.0 };
    let (told, done) = run(&cart, &dop853(), [0.0, 0.0], 6.0);
    assert_eq!(kinds(&told), [TransitionKind::Slips, TransitionKind::Switched, TransitionKind::Sticks]);
    // (t - 3)^2/4 is one at the switch, and is used up by 3/2.
    let expected = [3.0, 5.0, 5.0 + 1.0 / 1.5];
    for (tr, expected) in told.iter().zip(expected) {
        assert!((tr.t - expected).abs() < 1e-11, "{} {expected}", tr.t);
    }
    let (state, mode) = done.unwrap();
    assert_eq!(mode, Mode([ElementState::Stick]));
    assert!((state[0] - (8.0 / 12.0 + 1.0 / 3.0)).abs() < 1e-10 && state[1].abs() < 1e-15, "{state:?}");
    assert_eq!(
        (told[0].before, told[0].after),
        (Mode([ElementState::Stick]), Mode([ElementState::SlipForward]))
    );
}

#[test]
fn inputs_change_at_their_times() {
    let cart = GrippedCart { limit: 3.0, off: 9.0, push: 0.0 };
    let mut told = Vec::new();
    // From t = 1 on the force is -2 t: it slips backwards from t = 3/2 on.
    Hybrid::new(&cart, 0.0, &[0.0, 0.0])
        .inputs(&[(1.0, -2.0)])
        .transitions(&mut |tr| {
            told.push((tr.t, tr.kind, tr.after));
            ControlFlow::Continue(())
        })
        .run(&Tsit5::new(1e-9, 1e-9), 3.0)
        .unwrap();
    let [(t, TransitionKind::Slips, Mode([ElementState::SlipBackward]))] = told[..] else {
        panic!("{told:?}")
    };
    assert!((t - 1.5).abs() < 1e-9);
}

/// A door with a latch, closed by a constant torque while `when` is positive, pushed open later.
#[derive(Clone, Copy, Debug)]
pub struct Door {
    pub armed: bool,
}

impl HybridSystem<2, 1, 1, 1> for Door {
    const ELEMENTS: [Element; 1] = [Element::latch("bolt", 0).with_condition()];
    const SIGNALS: [Signal; 1] = [Signal::switch("opening")];
    const COORDINATES: usize = 1;
    crate::without_inputs!(1 elements);

    fn free_motion<R: Lift<f64>>(
        &self,
        _t: R,
        x: &[R; 2],
        on: &[R; 1],
        _: &[R; 1],
    ) -> FreeMotion<R, 2, 1, 1> {
        let mut parts = Parts::<R, 1, 1, 1>::nothing().masses([R::one()]);
        parts.forces = [c::<R>(-2.0) + c::<R>(3.0) * on[0]];
        parts.rows = [[R::one()]];
        parts.gaps = [x[0]];
        parts.free_motion(x)
    }

    fn restitutions(&self) -> [f64; 1] {
        [0.0]
    }

    fn conditions<R: Lift<f64>>(&self, t: R, _x: &[R; 2], _: &[R; 1]) -> Conditions<R, 1> {
        let when = if self.armed { R::one() } else { -R::one() };
        Conditions { when: [when], release: [t - c(2.0)] }
    }

    fn signals<R: Lift<f64>>(&self, t: R, _x: &[R; 2]) -> [R; 1] {
        [(t - c(1.5)) * (c::<R>(3.0) - t)]
    }
}

#[test]
fn a_latch_locks_is_released_and_locks_again() {
    // From 1 with -2/2 t^2: at zero at t = 1. Free again at t = 2, with an acceleration of one until 3, then of -2.
    let (told, done) = run(&Door { armed: true }, &dop853(), [1.0, 0.0], 6.0);
    let expected = [
        (1.0, TransitionKind::Locked),
        (1.5, TransitionKind::Switched),
        (2.0, TransitionKind::Released),
        (3.0, TransitionKind::Switched),
        // 1/2 + s - s^2 = 0
        (3.0 + 0.5 * (1.0 + f64::sqrt(3.0)), TransitionKind::Locked),
    ];
    assert_eq!(told.len(), expected.len(), "{told:?}");
    for (tr, (t, kind)) in told.iter().zip(expected) {
        assert!((tr.t - t).abs() < 1e-10 && tr.kind == kind, "{tr:?} instead of {kind:?} at {t}");
    }
    assert!((told[0].impulses[0] - 2.0).abs() < 1e-11 && (told[0].energy + 2.0).abs() < 1e-11);
    assert_eq!(done.unwrap().1, Mode([ElementState::Locked]));
    // Without its condition it passes through.
    let (told, done) = run(&Door { armed: false }, &dop853(), [1.0, 0.0], 1.4);
    assert!(told.is_empty() && done.unwrap().0[0] < -0.5);
    // It may begin locked.
    let (told, done) = run(&Door { armed: true }, &dop853(), [0.0, 0.0], 1.0);
    assert!(told.is_empty() && done.unwrap().1 == Mode([ElementState::Locked]));
}

/// A point that a reset throws back up where it falls through zero.
#[derive(Clone, Copy, Debug)]
pub struct Thrown;

impl HybridSystem<2, 0, 0, 1> for Thrown {
    const ELEMENTS: [Element; 0] = [];
    const SIGNALS: [Signal; 1] = [Signal::reset_falling("racket")];
    const COORDINATES: usize = 1;
    crate::without_inputs!(0 elements);

    fn free_motion<R: Lift<f64>>(&self, _t: R, x: &[R; 2], _: &[R; 1], _: &[R; 0]) -> FreeMotion<R, 2, 0, 0> {
        let mut parts = Parts::<R, 1, 0, 0>::nothing().masses([R::one()]);
        parts.forces = [c(-10.0)];
        parts.free_motion(x)
    }

    fn restitutions(&self) -> [f64; 0] {
        []
    }

    fn signals<R: Lift<f64>>(&self, _t: R, x: &[R; 2]) -> [R; 1] {
        [x[0]]
    }

    fn reset<R: Lift<f64>>(&self, signal: usize, _t: R, x: &[R; 2], _: &[R; 1]) -> [R; 2] {
        assert_eq!(signal, 0);
        [x[0], c(5.0)]
    }
}

#[test]
fn resets_happen_at_every_fall_through_zero() {
    let (told, _) = run(&Thrown, &dop853(), [5.0, 0.0], 4.5);
    assert_eq!(kinds(&told), [TransitionKind::Reset; 4]);
    for (k, tr) in told.iter().enumerate() {
        assert!((tr.t - (1.0 + k as f64)).abs() < 1e-11, "{tr:?}");
    }
}

/// A point that a reset slows to half of its velocity where it falls through zero; it falls on.
#[derive(Clone, Copy, Debug)]
pub struct Slowed {
    pub a: f64,
}

impl HybridSystem<2, 0, 0, 1> for Slowed {
    const ELEMENTS: [Element; 0] = [];
    const SIGNALS: [Signal; 1] = [Signal::reset_falling("slowed")];
    const COORDINATES: usize = 1;
    crate::without_inputs!(0 elements);

    fn free_motion<R: Lift<f64>>(&self, _t: R, x: &[R; 2], _: &[R; 1], _: &[R; 0]) -> FreeMotion<R, 2, 0, 0> {
        let mut parts = Parts::<R, 1, 0, 0>::nothing().masses([R::one()]);
        parts.forces = [c(-self.a)];
        parts.free_motion(x)
    }

    fn restitutions(&self) -> [f64; 0] {
        []
    }

    fn signals<R: Lift<f64>>(&self, _t: R, x: &[R; 2]) -> [R; 1] {
        [x[0]]
    }

    fn reset<R: Lift<f64>>(&self, _: usize, _t: R, x: &[R; 2], _: &[R; 1]) -> [R; 2] {
        [x[0], c::<R>(0.5) * x[1]]
    }
}

/// The located zero of a bare coordinate is off by rounding, to either side. A reset that leaves the coordinate there happens once.
#[test]
fn a_reset_that_leaves_its_function_at_zero_happens_once() {
    for k in 0..400 {
        let (v, a) = (0.3 + 0.017 * f64::from(k), 0.5 + 0.013 * f64::from(k % 37));
        // It rises, and falls back with the same velocity.
        let back = 2.0 * v / a;
        let (told, done) = run(&Slowed { a }, &dop853(), [0.0, v], 1.5 * back);
        assert_eq!(kinds(&told), [TransitionKind::Reset], "{v} {a}: {told:?}");
        assert!((told[0].t - back).abs() < 1e-10 * back, "{v} {a}: {told:?} {back}");
        let further = 0.5 * back;
        let end = done.unwrap().0;
        let expected = [-0.5 * v * further - 0.5 * a * further * further, -0.5 * v - a * further];
        let error = (end[0] - expected[0]).abs().max((end[1] - expected[1]).abs());
        assert!(error < 1e-9 * (1.0 + expected[0].abs()), "{v} {a}: {end:?} {expected:?}");
    }
}

/// A block on two feet that a growing force pushes at a height: half width, height, friction.
#[derive(Clone, Copy, Debug)]
pub struct Block {
    pub half: f64,
    pub up: f64,
    pub mu: f64,
    pub push: f64,
}

impl HybridSystem<6, 4, 2, 0> for Block {
    const ELEMENTS: [Element; 2] = [Element::rough("left", 0, &[1]), Element::rough("right", 2, &[3])];
    const SIGNALS: [Signal; 0] = [];
    const COORDINATES: usize = 3;
    crate::without_inputs!(2 elements);

    fn free_motion<R: Lift<f64>>(&self, t: R, x: &[R; 6], _: &[R; 0], _: &[R; 2]) -> FreeMotion<R, 6, 4, 2> {
        let (b, h) = (c::<R>(self.half), c::<R>(self.up));
        let (sin, cos) = x[2].sin_cos();
        let (zero, one) = (R::zero(), R::one());
        let mut parts = Parts::<R, 3, 4, 2>::nothing();
        // The force acts at the mass centre.
        let third = R::from_ratio(1, 3);
        parts = parts.masses([one, one, third * (b * b + h * h)]);
        parts.forces = [c::<R>(self.push) * t, c(-10.0), zero];
        // A foot at (s b, -h) of the body.
        let foot = |s: R| {
            let (dx, dz) = (cos * s * b + sin * h, sin * s * b - cos * h);
            (dx, dz)
        };
        let omega = x[5];
        for (k, s) in [-one, one].into_iter().enumerate() {
            let (dx, dz) = foot(s);
            parts.rows[2 * k] = [zero, one, dx];
            parts.rows[2 * k + 1] = [one, zero, -dz];
            parts.biases[2 * k] = -dz * omega * omega;
            parts.biases[2 * k + 1] = -dx * omega * omega;
            parts.gaps[k] = x[1] + dz;
        }
        (parts.friction, parts.stiction) = ([c(self.mu); 2], [c(self.mu); 2]);
        parts.free_motion(x)
    }

    fn restitutions(&self) -> [f64; 2] {
        [0.0; 2]
    }

    fn signals<R: Lift<f64>>(&self, _t: R, _x: &[R; 6]) -> [R; 0] {
        []
    }
}

#[test]
fn a_block_on_two_feet_slides_or_tips() {
    let start = [0.0, 0.5, 0.0, 0.0, 0.0, 0.0];
    // It slides where the force is mu m g before it tips at m g b/h.
    let block = Block { half: 1.0, up: 0.5, mu: 0.6, push: 2.0 };
    let (told, done) = run(&block, &dop853(), start, 4.0);
    assert_eq!(kinds(&told), [TransitionKind::Slips], "{told:?} {done:?}");
    assert!((told[0].t - 3.0).abs() < 1e-10);
    assert_eq!(told[0].after, Mode([ElementState::SlipForward; 2]));
    let (state, _) = done.unwrap();
    assert!((state[3] - 1.0).abs() < 1e-9 && state[2].abs() < 1e-12, "{state:?}");
    // It tips about the right foot.
    let block = Block { half: 0.25, up: 1.0, mu: 0.6, push: 2.0 };
    let (told, done) = run(&block, &dop853(), [0.0, 1.0, 0.0, 0.0, 0.0, 0.0], 1.4);
    assert_eq!(kinds(&told), [TransitionKind::Lifted], "{told:?} {done:?}");
    assert!((told[0].t - 1.25).abs() < 1e-10);
    assert_eq!(told[0].after, Mode([ElementState::Open, ElementState::Stick]));
    // The reactions of least norm are those of a symmetric block.
    let in_mode = InMode::new(block, Mode([ElementState::Stick; 2]), 0.0, &[0.0, 1.0, 0.0, 0.0, 0.0, 0.0]);
    assert!(in_mode.is_redundant());
    let motion = in_mode.reactions(0.5, &[0.0, 1.0, 0.0, 0.0, 0.0, 0.0]);
    let least = in_mode.with_least_norm(&motion).reactions;
    assert!((least[1] - least[3]).abs() < 1e-12 && (least[1] + 0.5).abs() < 1e-12, "{least:?}");
}

#[test]
fn a_block_that_rocks_comes_to_rest() {
    // A block that rocks loses the part 1 - r^2 of its energy in every impact, r = 1 - (3/2) sin(a)^2 with the half angle a, in the same
    // time between impacts as it would take from its height: the sum is that of a geometric series for small angles.
    let block = Block { half: 0.5, up: 1.0, mu: 1e3, push: 0.0 };
    let angle = 1e-3_f64;
    let (sin, cos) = angle.sin_cos();
    // Turned about the right foot, which stays where it is.
    let height = 0.5 * sin + cos;
    let start = [0.0, height, -angle, 0.0, 0.0, 0.0];
    let (told, done) = run(&block, &dop853(), start, 3.0);
    let TransitionKind::Rest { until, impacts } = told.last().unwrap().kind else {
        panic!("{:?} {done:?}", told.last())
    };
    let ratio = 1.0 - 1.5 * 0.25 / 1.25;
    let rates: Vec<f64> = told
        .iter()
        .filter(|tr| tr.kind == TransitionKind::Impact)
        .map(|tr| tr.state_after[5].abs())
        .collect();
    for pair in rates.windows(2) {
        assert!((pair[1] / pair[0] - ratio).abs() < 1e-6, "{pair:?} {ratio}");
    }
    assert!(impacts > 10, "{impacts}");
    assert_eq!(done.unwrap().1, Mode([ElementState::Stick; 2]));
    // The same end from a sequence that is followed further.
    let mut further = 0.0;
    Hybrid::new(&block, 0.0, &start)
        .resting_accuracy(1e-15)
        .transitions(&mut |tr| {
            if let TransitionKind::Rest { until, .. } = tr.kind {
                further = until;
            }
            ControlFlow::Continue(())
        })
        .run(&dop853(), 3.0)
        .unwrap();
    assert!((until - further).abs() < 1e-9, "{until} {further}");
}

/// A mass that falls on a floor, and one on a spring that comes to its own floor at nearly the same time.
#[derive(Clone, Copy)]
struct Neighbours {
    stiffness: f64,
    rest: f64,
}

impl HybridSystem<4, 2, 2, 0> for Neighbours {
    const ELEMENTS: [Element; 2] = [Element::smooth("falls", 0), Element::smooth("swings", 1)];
    const SIGNALS: [Signal; 0] = [];
    const COORDINATES: usize = 2;
    crate::without_inputs!(2 elements);

    fn free_motion<R: Lift<f64>>(&self, _t: R, x: &[R; 4], _: &[R; 0], _: &[R; 2]) -> FreeMotion<R, 4, 2, 2> {
        let mut parts = Parts::<R, 2, 2, 2>::nothing().masses([R::one(), R::one()]);
        parts.forces = [-c::<R>(10.0), c::<R>(self.stiffness) * (c::<R>(self.rest) - x[1])];
        parts.rows = [[R::one(), R::zero()], [R::zero(), R::one()]];
        parts.gaps = [x[0], x[1]];
        parts.free_motion(x)
    }

    fn restitutions(&self) -> [f64; 2] {
        [0.5; 2]
    }

    fn signals<R: Lift<f64>>(&self, _t: R, _x: &[R; 4]) -> [R; 0] {
        []
    }
}

/// The polynomial of a step and the method, which says where an impact is, are of different errors: a second gap may be above zero by the
/// one and below by the other.
#[test]
fn impacts_at_nearly_the_same_time_are_all_met() {
    let time = f64::sqrt(0.2);
    for phase in [1.6, 2.0, 2.5, 2.8, 2.9, 3.0, 3.05, 3.1, 3.12, 3.135] {
        for later in (12..50).map(|k| 0.1_f64.powf(0.25 * f64::from(k))).flat_map(|later| [-later, later]) {
            let frequency = phase / time;
            let rest = -f64::cos(frequency * (time + later));
            let system = Neighbours { stiffness: frequency * frequency, rest };
            let method = Dop853::new(1e-3, 1e-3);
            let (told, done) = run(&system, &method, [1.0, 1.0 + rest, 0.0, 0.0], time + 0.05);
            let (end, _) = done.unwrap();
            let lowest = end[0].min(end[1]);
            assert!(lowest > -1e-12, "{lowest:e} with {phase} {later:e}: {told:?}");
        }
    }
}

/// Two masses that move along a line each, without forces: their contact's gap is the sum of their coordinates.
#[derive(Clone, Copy, Debug)]
struct Pair<const CONDITIONAL: bool> {
    when: f64,
}

impl<const CONDITIONAL: bool> HybridSystem<4, 1, 1, 0> for Pair<CONDITIONAL> {
    const ELEMENTS: [Element; 1] = [Element { conditional: CONDITIONAL, ..Element::smooth("pair", 0) }];
    const SIGNALS: [Signal; 0] = [];
    const COORDINATES: usize = 2;
    crate::without_inputs!(1 elements);

    fn free_motion<R: Lift<f64>>(&self, _: R, x: &[R; 4], _: &[R; 0], _: &[R; 1]) -> FreeMotion<R, 4, 1, 1> {
        let mut parts = Parts::<R, 2, 1, 1>::nothing().masses([R::one(); 2]);
        parts.rows = [[R::one(); 2]];
        parts.gaps = [x[0] + x[1]];
        parts.free_motion(x)
    }

    fn restitutions(&self) -> [f64; 1] {
        [0.5]
    }

    fn conditions<R: Lift<f64>>(&self, _: R, _: &[R; 4], _: &[R; 0]) -> Conditions<R, 1> {
        Conditions { when: [c(self.when)], ..Conditions::none() }
    }

    fn signals<R: Lift<f64>>(&self, _: R, _: &[R; 4]) -> [R; 0] {
        []
    }
}

/// Nine digits of the velocities cancel in the rate of the gap, which is no rounding for that.
#[test]
fn a_slow_impact_of_fast_masses_is_an_impact() {
    let (told, done) =
        run(&Pair::<false> { when: 1.0 }, &dop853(), [1.0, -1.0 + 4e-9, 1.0, -1.0 - 1e-9], 5.0);
    assert_eq!(kinds(&told), [TransitionKind::Impact]);
    assert!((told[0].t - 4.0).abs() < 1e-5, "{told:?}");
    let (state, _) = done.unwrap();
    let rate = state[2] + state[3];
    assert!((rate - 0.5e-9).abs() < 1e-15, "{rate:e}");
}

/// A gap that passes zero though its element has no condition is told of before it is lost.
#[test]
fn a_gap_that_was_missed_ends_the_run() {
    let start = [1.0, -0.9, -1.0, 0.0];
    let (_, done) = run(&Pair::<false> { when: -1.0 }, &dop853(), start, 5.0);
    let failed = done.unwrap_err();
    assert!(matches!(failed.cause, HybridCause::Penetrating { contact: "pair", gap } if gap < 0.0));
    assert!(failed.t < 5.0, "{failed}");
    let (told, done) = run(&Pair::<true> { when: -1.0 }, &dop853(), start, 5.0);
    assert!(told.is_empty() && (done.unwrap().0[0] + 4.0).abs() < 1e-12);
}
