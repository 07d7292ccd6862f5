//! What is narrower than a step: ramps and bumps of the force, in time, in a coordinate, in a velocity, of widths from a tenth of
//! a step to a hundred-thousandth, times all methods, `Bounded` and lanes. A run is right, or ends with a typed error, or it is one of
//! those that `docs/design/narrow-features.md` states as a limit, with the numbers that are asked for here.
//!
//! ```text
//! cargo test -p guen-runtime --test steppers narrow_features -- --include-ignored --nocapture     # the whole battery
//! ```

mod methods;
mod series;

use guen_runtime::prelude::*;
use guen_runtime::steppers::Bounded;
use guen_runtime::{Coefficients, Differentiable, Equations, Generic, System, TaylorSeries, generic};

use methods::{BOUNDED, FIXED, Fate, METHODS, run};

/// What the feature is a function of.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Of {
    Time,
    Coordinate,
    Velocity,
}

/// An oscillator, `x'' = -x`, and a force of one feature.
#[derive(Clone, Copy, Debug)]
struct Hidden {
    of: Of,
    /// A ramp from one force to another, or a bump.
    lasting: bool,
    place: f64,
    width: f64,
    force: f64,
}

impl Equations<2> for Hidden {
    fn rates<R: Real>(&self, t: R, &[x, v]: &[R; 2]) -> [R; 2] {
        let of = match self.of {
            Of::Time => t,
            Of::Coordinate => x,
            Of::Velocity => v,
        };
        let s = (of - R::from_f64(self.place)) / R::from_f64(self.width);
        let feature = if self.lasting { s.tanh() } else { (-(s * s)).exp() };
        [v, R::from_f64(self.force) * feature - x]
    }
}

#[derive(Clone, Copy)]
struct Expanded(Generic<Hidden>, Hidden);

impl System<f64, 2> for Expanded {
    fn rhs(&self, t: f64, state: &[f64; 2]) -> [f64; 2] {
        self.0.rhs(t, state)
    }
}

impl Differentiable<f64, 2> for Expanded {
    fn jacobian(&self, t: f64, state: &[f64; 2]) -> [[f64; 2]; 2] {
        self.0.jacobian(t, state)
    }

    fn along(&self, t: f64, state: &[f64; 2], dt: f64, dx: &[f64; 2]) -> [f64; 2] {
        self.0.along(t, state, dt, dx)
    }
}

impl TaylorSeries<f64, 2> for Expanded {
    const PRODUCTS: usize = 4;

    fn series(&self, t: f64, state: &[f64; 2], scale: f64, order: usize, to: &mut Coefficients<f64, 2>) {
        series::series(&self.1, t, state, scale, order, to);
    }
}

const START: [f64; 2] = [0.3, 1.1];
const END: f64 = 4.0;
/// The end for bounded work, which is meant for control periods: in more time errors may grow, and it says so.
const PERIOD: f64 = 1.0;

/// The motion, by steps that are short beside the distance to the feature: to 1e-9 at the least.
fn reference(system: &Expanded, end: f64) -> [f64; 2] {
    /// The step where the velocity is held.
    const HELD: f64 = 1e-2;

    let (mut t, mut state) = (0.0_f64, START);
    let hidden = system.1;
    let by = Bounded::dop853(12);
    let stiff = Radau5::new(1e-12, 1e-14);
    while t < end {
        let [x, v] = state;
        let [_, a] = system.rhs(t, &state);
        // How fast what the feature is of moves, with what its force can add.
        let (at, speed) = match hidden.of {
            Of::Time => (t, 1.0),
            Of::Coordinate => (x, v.abs() + 1e-3),
            Of::Velocity => (v, a.abs() + 1e-3),
        };
        let near = (at - hidden.place).abs() + 0.5 * hidden.width;
        let mut step = (0.15 * near / speed).min(0.03);
        if hidden.of == Of::Coordinate {
            // Turning there, it is as fast as the acceleration makes it.
            step = step.min((0.1 * near / (a.abs() + hidden.force.abs())).sqrt());
        }
        // Where the force holds the velocity it is stiff, and what lasts is seen by steps of any length.
        let held = system.jacobian(t, &state)[1][1].abs() * step > 1.0;
        step = if held { HELD } else { step };
        let next = if t + 1.01 * step > end { end } else { t + step };
        state = if held {
            Integration::new(system, t, &state).run(&stiff, next).expect("stiff").state
        } else {
            by.advance(system, t, &state, next).expect("a short step").state
        };
        t = next;
    }
    state
}

/// Numbers between zero and one, the same in every run.
fn draws() -> impl FnMut() -> f64 {
    let mut state = 0x2545_f491_4f6c_dd1d_u64;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Runs of one method with features of one kind and width.
struct Row {
    method: usize,
    of: Of,
    lasting: bool,
    width: f64,
    /// Right, refused and wrong ones.
    counts: [usize; 3],
    /// The largest error of the wrong ones, as it is, and in units of what a step of the full force makes.
    worst: f64,
    steps: f64,
}

fn row(rounds: usize, width: f64, of: Of, lasting: bool, method: usize) -> Row {
    let mut number = draws();
    let mut row = Row { method, of, lasting, width, counts: [0; 3], worst: 0.0, steps: 0.0 };
    let step = METHODS[method].1;
    for _ in 0..rounds {
        let between = |from: f64, to: f64, part: f64| from + (to - from) * part;
        // Within a period the coordinate rises from 0.3, and the velocity falls from 1.1 to less than 0.5.
        let (end, place) = match (of, method < BOUNDED) {
            (Of::Time, true) => (END, between(0.5, 3.5, number())),
            (Of::Coordinate | Of::Velocity, true) => (END, between(-0.7, 0.7, number())),
            (Of::Time, false) => (PERIOD, between(0.1, 0.9, number())),
            (Of::Coordinate, false) => (PERIOD, between(0.4, 0.9, number())),
            (Of::Velocity, false) => (PERIOD, between(0.6, 1.0, number())),
        };
        let force = (0.2 + 0.6 * number()) * if number() < 0.5 { 1.0 } else { -1.0 };
        let hidden = Hidden { of, lasting, place, width: width * step, force };
        let system = Expanded(generic(hidden), hidden);
        match run(method, &system, &reference(&system, end)) {
            Fate::Right => row.counts[0] += 1,
            Fate::Refused => row.counts[1] += 1,
            Fate::Wrong(off) => {
                row.counts[2] += 1;
                row.worst = row.worst.max(off);
                row.steps = row.steps.max((off - METHODS[method].2) / (force.abs() * step));
            }
        }
    }
    row
}

/// Widths as parts of a step: those that are asked for, after two that are none of a hidden feature.
const WIDTHS: [f64; 7] = [1.0, 0.3, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5];

fn battery(rounds: usize) -> Vec<Row> {
    let kinds = [Of::Time, Of::Coordinate, Of::Velocity];
    let kinds = [true, false].into_iter().flat_map(|lasting| kinds.map(|of| (lasting, of)));
    let methods = kinds.flat_map(|kind| (0..METHODS.len()).map(move |method| (kind, method)));
    methods
        .flat_map(|((lasting, of), method)| WIDTHS.map(|width| row(rounds, width, of, lasting, method)))
        .collect()
}

/// Bumps that are as wide as this part of a step are not stepped over.
const SEEN: f64 = 1.0;
/// What a fixed step is off by at most, beside what it is off by anyway, as a part of what the force of the feature makes in a step.
/// RK8's weights are up to 5.8, and of both signs.
fn left(name: &str) -> f64 {
    if name.starts_with("rk8") { 8.0 } else { 1.0 }
}
/// Of so many runs of bounded work with what lasts one may be off by more than its bound.
const HELD_BY_BOUNDS: usize = 200;

/// Prints the counts, and asks for the limits that the documentation states.
fn judge(rows: &[Row]) {
    println!("right, refused, wrong, by width as a part of the step: {WIDTHS:?}; the largest error");
    for rows in rows.chunks(WIDTHS.len()) {
        let Row { method, of, lasting, .. } = rows[0];
        let kind = if lasting { "ramp" } else { "bump" };
        let cells: Vec<String> = rows.iter().map(|row| format!("{:?}", row.counts)).collect();
        let most = |of: fn(&Row) -> f64| rows.iter().map(of).fold(0.0, f64::max);
        let (worst, steps) = (most(|row| row.worst), most(|row| row.steps));
        println!("{kind}, {of:?}, {}: {} {worst:.0e} {steps:.2}", METHODS[method].0, cells.join(" "));
    }
    for Row { method, of, lasting, width, counts: [_, _, wrong], steps, .. } in rows {
        let name = METHODS[*method].0;
        if *method < FIXED {
            assert!(*steps <= left(name), "{name}, {of:?}, {width}: {steps}");
        } else if *method < BOUNDED && (*lasting || *width >= SEEN) {
            assert_eq!(*wrong, 0, "{name}, {of:?}, {width}");
        }
    }
    let bounded = rows.iter().filter(|row| row.method >= BOUNDED && row.lasting);
    let [right, refused, wrong] = bounded.fold([0; 3], |sum, row| [0, 1, 2].map(|i| sum[i] + row.counts[i]));
    assert!(wrong * HELD_BY_BOUNDS <= right + refused + wrong, "{right}, {refused}, {wrong}");
}

#[test]
#[ignore = "the whole battery, 7,560 runs"]
fn every_method_meets_what_its_steps_do_not_resolve() {
    judge(&battery(12));
}

#[test]
fn what_lasts_is_seen() {
    judge(&battery(1));
}
