//! Drawn systems with contacts, a switch and two resets. The switch changes and the resets happen exactly where their functions go
//! through zero, and the laws of contacts hold at all times.

use guen_runtime::Lift;
use guen_runtime::hybrid::{
    Element, FreeMotion, HybridCause, HybridSystem, HybridTrajectory, InMode, Mode, Signal, Transition,
    TransitionKind,
};

use crate::laws::Judged;
use crate::tree::{Mixed, Random};
use crate::{is_expected, mixed, rounds};

/// A drawn system with a constant force along its second angle.
#[derive(Clone, Copy, Debug)]
struct Pushed {
    system: Mixed,
    force: f64,
}

/// The row that the force is along.
const ROW: usize = 3;

impl Pushed {
    fn free<R: Lift<f64>>(&self, state: &[R; 6], force: R) -> FreeMotion<R, 6, 4, 3> {
        let mut free = self.system.0.free(state);
        for i in 0..6 {
            free.rates[i] += force * free.responses[ROW][i];
        }
        for w in 0..4 {
            free.biases[w] += force * free.delassus[w][ROW];
        }
        free
    }
}

impl HybridSystem<6, 4, 3, 0> for Pushed {
    const ELEMENTS: [Element; 3] = <Mixed as HybridSystem<6, 4, 3, 0>>::ELEMENTS;
    const SIGNALS: [Signal; 0] = [];
    const COORDINATES: usize = 3;
    crate::without_inputs!(3 elements);

    fn free_motion<R: Lift<f64>>(
        &self,
        _t: R,
        state: &[R; 6],
        _: &[R; 0],
        _: &[R; 3],
    ) -> FreeMotion<R, 6, 4, 3> {
        self.free(state, R::lift(self.force))
    }

    fn restitutions(&self) -> [f64; 3] {
        self.system.0.restitutions
    }

    fn signals<R: Lift<f64>>(&self, _t: R, _x: &[R; 6]) -> [R; 0] {
        []
    }
}

/// The same system with a switch that turns the force on, and with two resets.
#[derive(Clone, Copy, Debug)]
struct Signalled {
    pushed: Pushed,
    /// Of each signal the factors of the state, of the time and of a sine of the time, and a constant.
    functions: [[f64; 9]; 3],
    /// The first reset multiplies the velocities by this factor, which may be negative.
    factor: f64,
    /// The second reset applies an impulse of this size along a row, that of a gap.
    kick: f64,
    kicked: usize,
}

/// The angular frequency of the sines.
const FREQUENCY: f64 = 7.0;

const SWITCH: usize = 0;
const SCALED: usize = 1;
const KICKED: usize = 2;

impl HybridSystem<6, 4, 3, 3> for Signalled {
    const ELEMENTS: [Element; 3] = <Mixed as HybridSystem<6, 4, 3, 0>>::ELEMENTS;
    const SIGNALS: [Signal; 3] =
        [Signal::switch("on"), Signal::reset_rising("scaled"), Signal::reset_falling("kicked")];
    const COORDINATES: usize = 3;
    crate::without_inputs!(3 elements);

    fn free_motion<R: Lift<f64>>(
        &self,
        _t: R,
        state: &[R; 6],
        switches: &[R; 3],
        _: &[R; 3],
    ) -> FreeMotion<R, 6, 4, 3> {
        self.pushed.free(state, R::lift(self.pushed.force) * switches[SWITCH])
    }

    fn restitutions(&self) -> [f64; 3] {
        self.pushed.system.0.restitutions
    }

    fn signals<R: Lift<f64>>(&self, t: R, x: &[R; 6]) -> [R; 3] {
        self.functions.map(|factors| {
            let [a, b, c, d, e, f, of_time, of_sine, constant] = factors.map(R::lift);
            let (sine, _) = (R::lift(FREQUENCY) * t).sin_cos();
            let of_state = a * x[0] + b * x[1] + c * x[2] + d * x[3] + e * x[4] + f * x[5];
            of_state + of_time * t + of_sine * sine + constant
        })
    }

    fn reset<R: Lift<f64>>(&self, signal: usize, _t: R, x: &[R; 6], _: &[R; 3]) -> [R; 6] {
        let factor = R::lift(self.factor);
        let responses = self.pushed.system.0.free(x).responses[self.kicked];
        core::array::from_fn(|i| match signal {
            SCALED if i >= 3 => factor * x[i],
            KICKED if i >= 3 => x[i] + R::lift(self.kick) * responses[i],
            _ => x[i],
        })
    }
}

impl Signalled {
    /// The system with the switch held.
    fn frozen(&self, on: bool) -> Pushed {
        Pushed { force: if on { self.pushed.force } else { 0.0 }, ..self.pushed }
    }
}

fn drawn(random: &mut Random) -> (Signalled, [f64; 6]) {
    let (system, start) = mixed(random);
    let mut functions = [[0.0; 9]; 3];
    for (s, factors) in functions.iter_mut().enumerate() {
        // Of positions, of velocities, of both, of time alone; or a sine that is above zero for a moment.
        let of = random.below(5);
        let up = if s == SCALED { -1.0 } else { 1.0 };
        if of == 4 {
            (factors[7], factors[8]) = (up, up * (10_f64.powf(random.between(-6.0, -1.0)) - 1.0));
            continue;
        }
        for (i, factor) in factors.iter_mut().take(6).enumerate() {
            let is_velocity = i >= 3;
            if of == 2 || of == usize::from(is_velocity) {
                *factor = random.next() * if is_velocity { 0.3 } else { 1.0 };
            }
        }
        if of == 3 || random.below(2) == 0 {
            factors[6] = 0.5 * random.next();
        }
        let at_start: f64 = (0..6).map(|i| factors[i] * start[i]).sum();
        // On the side from which it goes through zero, or on the other one.
        let side = if random.below(3) == 0 { -up } else { up };
        factors[8] = side * random.between(0.02, 0.4) - at_start;
    }
    let signalled = Signalled {
        pushed: Pushed { system, force: random.between(0.5, 6.0) },
        functions,
        factor: random.between(-1.0, 0.9),
        kick: 0.5 * random.next(),
        kicked: [0, 2][random.below(2)],
    };
    (signalled, start)
}

/// The numbers of events in all motions.
#[derive(Default, Debug)]
struct Count {
    scaled: usize,
    kicked: usize,
    switched: usize,
    /// Resets with an impact in them.
    struck: usize,
    /// Jumps of a switch in an impact or a reset.
    jumped: usize,
    transitions: usize,
}

/// The largest value of a function at the time at which its zero was located.
const ZERO: f64 = 1e-9;
/// A function beyond this value is clearly on one side of zero.
const CLEAR: f64 = 1e-7;

type Told = Transition<Mode<3>, 6, 4, 3>;
type Motion = HybridTrajectory<Signalled, [f64; 6], 6, 4, 3, 3>;

/// Judges a motion between and at its transitions.
fn judged(
    system: &Signalled,
    motion: &Motion,
    is_whole: bool,
    laws: &mut Judged,
    count: &mut Count,
) -> Result<(), String> {
    let functions = |t: f64, x: &[f64; 6]| system.signals(t, x);
    let kinetic = |x: &[f64]| system.pushed.system.0.kinetic(x);
    let told: Vec<&Told> = motion.transitions().iter().collect();
    let ends: Vec<f64> = told.iter().map(|tr| tr.t).chain([motion.end_time()]).collect();
    let mut from = (motion.start_time(), motion.start());
    for (k, &end) in ends.iter().enumerate() {
        // Nothing goes through zero inside.
        let mut last: Option<[f64; 3]> = None;
        let steps = (((end - from.0) / 0.03) as usize).clamp(2, 100);
        let mut most = [f64::NEG_INFINITY; 3];
        for step in 0..=steps {
            let t = from.0 + (end - from.0) * step as f64 / steps as f64;
            let x = if step == 0 {
                from.1
            } else if step == steps {
                told.get(k).map_or_else(|| motion.end(), |tr| tr.state_before)
            } else {
                motion.at(t)
            };
            let values = functions(t, &x);
            let side = [values[SWITCH], -values[SCALED], values[KICKED]];
            if let Some(last) = last {
                let gone = |s: usize| last[s] > CLEAR && side[s] < -CLEAR;
                let back = last[SWITCH] < -CLEAR && side[SWITCH] > CLEAR;
                if gone(SWITCH) || back || gone(SCALED) || gone(KICKED) {
                    return Err(format!("{last:?} becomes {side:?} at {t} and nothing happens"));
                }
            }
            last = Some(side);
            (0..3).for_each(|s| most[s] = most[s].max(side[s]));
            // Where an error ends the run, what fired there has not yet led to another mode.
            let is_inside = 0 < step && step < steps && (is_whole || k < told.len()) && end - from.0 > 1e-9;
            if is_inside && step % 5 == 1 && values[SWITCH].abs() > CLEAR {
                let (frozen, mode) = (system.frozen(values[SWITCH] > 0.0), motion.mode_at(t));
                laws.mode(&frozen, (t, &x), &mode)?;
                // The motion has these rates, so the switch has the value that its function says.
                let h = 1e-6_f64.min(0.1 * (end - from.0) / steps as f64);
                let rates: [f64; 6] = InMode::new(frozen, mode, t, &x).rates(t, &x);
                let (ahead, behind) = (motion.at(t + h), motion.at(t - h));
                let apart = (0..6).map(|i| (0.5 * (ahead[i] - behind[i]) - h * rates[i]).abs());
                let of_rates = rates.iter().fold(1.0, |most: f64, rate| most.max(rate.abs()));
                if apart.fold(0.0, f64::max) > 1e-3 * h * of_rates + 1e-12 {
                    return Err(format!(
                        "rates {rates:?} at {t} are not those between {behind:?} and {ahead:?}"
                    ));
                }
            }
        }
        // A function may have changed its side for a moment only, right before its zero.
        let before_end = end - 1e-6_f64.min(0.5 * (end - from.0));
        let values = functions(before_end, &motion.at(before_end));
        let side = [values[SWITCH], -values[SCALED], values[KICKED]];
        (0..3).for_each(|s| most[s] = most[s].max(side[s]));
        let Some(tr) = told.get(k) else { break };
        count.transitions += 1;
        let (before, after) = (functions(tr.t, &tr.state_before), functions(tr.t, &tr.state_after));
        let mut onto = **tr;
        if tr.kind == TransitionKind::Reset {
            let Some(s @ (SCALED | KICKED)) = tr.signal else { return Err(format!("no signal: {tr:?}")) };
            *(if s == SCALED { &mut count.scaled } else { &mut count.kicked }) += 1;
            if before[s].abs() > ZERO || most[s] <= 0.0 {
                return Err(format!("a reset at {before:?}, after at most {most:?}: {tr:?}"));
            }
            let given = system.reset(s, tr.t, &tr.state_before, &[0.0; 3]);
            let struck = tr.impulses.iter().any(|impulse| *impulse != 0.0);
            let apart = (0..6).map(|i| (given[i] - tr.state_after[i]).abs()).fold(0.0, f64::max);
            if !struck && apart > 1e-12 {
                return Err(format!("{given:?} is given: {tr:?}"));
            }
            count.struck += usize::from(struck);
            // The laws are those of the impact that follows the reset, if there is one.
            onto.state_before = given;
            onto.kind = if struck { TransitionKind::Impact } else { TransitionKind::Switched };
        } else if tr.kind == TransitionKind::Switched {
            count.switched += 1;
            if tr.signal != Some(SWITCH) || before[SWITCH].abs() > ZERO {
                return Err(format!("a switch at {before:?}: {tr:?}"));
            }
        }
        let side = |value: f64| (value.abs() > CLEAR).then_some(value > 0.0);
        count.jumped +=
            usize::from(matches!((side(before[0]), side(after[0])), (Some(a), Some(b)) if a != b));
        // The side on which the switch goes on.
        let next = ends.get(k + 1).copied().unwrap_or(tr.t);
        let soon = tr.t + 0.3 * (next - tr.t);
        let on = side(after[SWITCH]).or_else(|| side(functions(soon, &motion.at(soon))[SWITCH]));
        // After many resets velocities may be as small as 1e-50. The other solver takes them for rest.
        let moves = tr.state_after[3..].iter().any(|velocity| velocity.abs() > 1e-9);
        if let Some(on) = on.filter(|_| moves) {
            laws.transition(&system.frozen(on), &onto, kinetic)?;
        }
        from = (tr.t, tr.state_after);
    }
    // Sines go through zero at times that are known.
    for s in [SCALED, KICKED].into_iter().filter(|s| system.functions[*s][7] != 0.0) {
        let above = system.functions[s][8].abs().asin();
        let falls = |k: usize| (core::f64::consts::PI * (2 * k + 1) as f64 - above) / FREQUENCY;
        let expected: Vec<f64> = (0..).map(falls).take_while(|t| *t < motion.end_time()).collect();
        let found: Vec<f64> = told.iter().filter(|tr| tr.signal == Some(s)).map(|tr| tr.t).collect();
        if found.len() != expected.len() || found.iter().zip(&expected).any(|(a, b)| (a - b).abs() > ZERO) {
            return Err(format!("resets at {found:?} in place of {expected:?}"));
        }
    }
    Ok(())
}

/// Whether a motion cannot go on: resets follow each other ever faster, or both sides of the switch lead back to its zero.
fn cannot_go_on(system: &Signalled, motion: &Motion) -> bool {
    let last = &motion.transitions()[motion.transitions().len().saturating_sub(40)..];
    if last.iter().any(|tr| tr.kind == TransitionKind::Reset) {
        return true;
    }
    let Some(tr) = last.last() else { return false };
    let rate = |on: bool| {
        let x = &tr.state_after;
        let rates = InMode::new(system.frozen(on), tr.after, tr.t, x).rates(tr.t, x);
        let factors = system.functions[SWITCH];
        let of_time = factors[6] + factors[7] * FREQUENCY * (FREQUENCY * tr.t).cos();
        of_time + (0..6).map(|i| factors[i] * rates[i]).sum::<f64>()
    };
    rate(true) < 0.0 && rate(false) > 0.0
}

#[test]
fn signals_do_what_they_say_and_the_laws_hold() {
    let rounds = rounds(6);
    let mut random = Random(20_261_128);
    let (mut laws, mut count, mut ends, mut wrong) = (Judged::default(), Count::default(), Vec::new(), 0);
    for round in 0..rounds {
        let (system, start) = drawn(&mut random);
        let simulation = HybridSystem::<6, 4, 3, 3>::simulation(&system, &start).tolerance(1e-10);
        let (motion, is_whole) = match simulation.run(0.0..1.5) {
            Ok(motion) => (motion, true),
            Err(failed) => {
                let cause = &failed.error.cause;
                let chatters = matches!(cause, HybridCause::Chattering { .. });
                let is_expected = is_expected(cause) || chatters && cannot_go_on(&system, &failed.trajectory);
                if !is_expected {
                    wrong += 1;
                    let last = failed.trajectory.transitions().last();
                    println!("round {round}: {failed}\n{system:?}\nfrom {start:?}\n{last:#?}");
                }
                ends.push(format!("{failed}"));
                (*failed.trajectory, false)
            }
        };
        if let Err(why) = judged(&system, &motion, is_whole, &mut laws, &mut count) {
            wrong += 1;
            println!("round {round}: {why}\n{system:?}\nfrom {start:?}");
        }
    }
    println!("{rounds} systems, {ends:?}: {count:?}, {laws:?}");
    assert_eq!(wrong, 0);
    assert!(ends.len() <= rounds / 2);
    assert!([count.scaled, count.kicked, count.switched].iter().all(|of| *of > rounds / 2));
    assert!(count.struck > rounds / 5 && count.jumped > rounds / 5);
}
