//! How often a promise is made, kept and refused, and how often a refusal was not needed: choices of a dozen systems, tried
//! from other states. The former rule, a comparison of two runs in doubles alone, is counted beside.
//!
//! ```text
//! GUEN_PROMISES=20 cargo test --release -p guen-study --features study --test study forecasts -- --nocapture
//! ```

use std::ops::Range;

use guen_runtime::steppers::{Dop853, Integration, Method, Rk8, Tsit5};
use guen_runtime::{Equations, Generic, Real, generic};
use guen_study::{Row, Study, Trade};

use crate::systems::Planar;

const PROMISE: f64 = 10.0;
/// States that every run of the tests tries, of three systems.
const QUICK: usize = 3;

/// What became of forecasts.
#[derive(Clone, Copy, Debug, Default)]
struct Count {
    promises: u32,
    broken: u32,
    refusals: u32,
    /// Refusals of what would have held.
    needless: u32,
}

impl Count {
    fn take(&mut self, promised: bool, held: bool) {
        self.promises += u32::from(promised);
        self.broken += u32::from(promised && !held);
        self.refusals += u32::from(!promised);
        self.needless += u32::from(!promised && held);
    }
}

/// By the rule as it is, and by the former one.
#[derive(Clone, Copy, Debug, Default)]
struct Counts {
    now: Count,
    before: Count,
    no_choice: u32,
}

struct Battery {
    states: usize,
    counts: Counts,
}

impl Battery {
    /// Chooses for the first state, and tries what was chosen from others.
    fn try_system<E, const N: usize>(
        &mut self,
        name: &str,
        equations: E,
        start: [f64; N],
        span: Range<f64>,
        asked: &[f64],
    ) where
        E: Equations<N> + Clone + 'static,
    {
        let system = generic(equations);
        let trade = Study::new(system.clone(), start, span.clone())
            .unwrap()
            .count_evaluations()
            .keep(|method, real| real == "f64" && ["RK8", "Tsit5", "DOP853"].contains(&method))
            .probes(3, 0.2)
            .scan(1 << 14)
            .within(std::time::Duration::from_secs(3600))
            .run();
        let mut own = Counts::default();
        for &asked in asked {
            let Ok(choice) = trade.report.fastest_within(asked) else {
                own.no_choice += 1;
                continue;
            };
            let states = Trade::around(&start, self.states, 0.4, 1618);
            for tried in trade.trial(choice.index, asked, states, span.clone()) {
                let held = tried.error <= PROMISE * asked;
                own.now.take(tried.forecast.holds(), held);
                assert_eq!(tried.kept, !tried.forecast.holds() || held);
                own.before.take(former(&system, choice.row, asked, &tried.start, &span), held);
            }
        }
        println!(
            "{name:<12} now {:?}\n             before {:?}, no choice {}",
            own.now, own.before, own.no_choice
        );
        for (sum, one) in [(&mut self.counts.now, own.now), (&mut self.counts.before, own.before)] {
            sum.promises += one.promises;
            sum.broken += one.broken;
            sum.refusals += one.refusals;
            sum.needless += one.needless;
        }
        self.counts.no_choice += own.no_choice;
    }
}

/// The former rule: DOP853 at a thousandth of what was asked for, and at ten times that.
fn former<E: Equations<N> + Clone, const N: usize>(
    system: &Generic<E>,
    row: &Row,
    asked: f64,
    start: &[f64; N],
    span: &Range<f64>,
) -> bool {
    let tolerance = (1e-3 * asked).clamp(1e-14, 1e-4);
    let run = |tolerance| end(system, &Dop853::new(tolerance, tolerance), start, span);
    let setting = row.setting;
    let found = match row.method.as_str() {
        "RK8" => end(system, &Rk8::new(setting), start, span),
        "Tsit5" => end(system, &Tsit5::new(setting, setting), start, span),
        _ => run(setting),
    };
    let (Some(found), Some(fine), Some(coarse)) = (found, run(tolerance), run(10.0 * tolerance)) else {
        return false;
    };
    let off =
        |x: [f64; N]| (0..N).map(|i| (x[i] - fine[i]).abs() / fine[i].abs().max(1.0)).fold(0.0, f64::max);
    off(found) + off(coarse) <= 0.5 * PROMISE * asked
}

fn end<E: Equations<N> + Clone, const N: usize>(
    system: &Generic<E>,
    method: &impl Method<f64, Generic<E>, N>,
    start: &[f64; N],
    span: &Range<f64>,
) -> Option<[f64; N]> {
    Some(Integration::new(system, span.start, start).run(method, span.end).ok()?.state)
}

/// Systems of one size are one type: see `systems`.
macro_rules! systems {
    ($all:ident, $n:literal: $($(#[$doc:meta])* $name:ident, |$t:ident, $x:pat_param, $number:ident| $rates:expr;)*) => {
        #[derive(Clone)]
        pub enum $all {
            $($(#[$doc])* $name,)*
        }
        impl Equations<$n> for $all {
            fn rates<R: Real>(&self, t: R, x: &[R; $n]) -> [R; $n] {
                match self {
                    $(Self::$name => {
                        #[allow(unused_variables)]
                        let ($t, $x, $number) = (t, x, |value: f64| R::from_f64(value));
                        $rates
                    })*
                }
            }
        }
    };
}

systems! { Two, 2:
    Pendulum, |t, &[q, w], n| [w, -n(9.81) * q.sin() - n(0.05) * w];
    Duffing, |t, &[x, v], n| [v, x - x * x * x - n(0.2) * v + n(0.3) * (n(1.2) * t).cos()];
    VanDerPol, |t, &[x, v], n| [v, n(5.0) * (n(1.0) - x * x) * v - x];
    Decay, |t, &[x, y], n| [n(-40.0) * (x - t.cos()), x - y];
    Brusselator, |t, &[x, y], n| [n(1.0) + x * x * y - n(4.0) * x, n(3.0) * x - x * x * y];
}

systems! { Three, 3:
    Lorenz, |t, &[x, y, z], n| [n(10.0) * (y - x), x * (n(28.0) - z) - y, x * y - n(8.0) / n(3.0) * z];
    Top, |t, &[a, b, c], n| [n(-0.7) * b * c, n(0.9) * c * a, n(-0.35) * a * b];
}

systems! { Four, 4:
    Kepler, |t, &[x, y, u, v], n| {
        let r = (x * x + y * y).sqrt();
        let cube = r * r * r;
        [u, v, -x / cube, -y / cube]
    };
    HenonHeiles, |t, &[x, y, u, v], n| [u, v, -x - n(2.0) * x * y, -y - x * x + y * y];
    /// A pendulum on a spring.
    Spring, |t, &[r, q, v, w], n| {
        [v, w, r * w * w - n(20.0) * (r - n(1.0)) + n(9.81) * q.cos(), -(n(2.0) * v * w + n(9.81) * q.sin()) / r]
    };
    /// Two pendulums, one on the other.
    Double, |t, &[a, b, u, v], n| {
        let (sin, cos) = (a - b).sin_cos();
        let below = n(2.0) - cos * cos;
        let (p, q) = (-sin * v * v - n(2.0) * a.sin(), sin * u * u - b.sin());
        [u, v, (p - cos * q) / below, (n(2.0) * q - cos * p) / below]
    };
    Sled, |t, &[phi, x, w, v], n| [w, v * phi.cos(), n(-0.4) * v * w, n(0.2) * w * w + n(0.98) * phi.cos()];
}

fn battery(states: usize) -> Counts {
    let mut battery = Battery { states, counts: Counts::default() };
    let all = states > QUICK;
    let asked: &[f64] = if all { &[1e-3, 1e-6, 1e-9, 1e-12] } else { &[1e-6, 1e-12] };
    battery.try_system("Lorenz", Three::Lorenz, [1.0, 2.0, 20.0], 0.0..8.0, asked);
    battery.try_system(
        "Van der Pol",
        Planar::Battery(Two::VanDerPol),
        [1.5, 0.5],
        0.0..if all { 20.0 } else { 5.0 },
        asked,
    );
    battery.try_system(
        "pendulum",
        Planar::Battery(Two::Pendulum),
        [1.0, 0.5],
        0.0..if all { 10.0 } else { 3.0 },
        asked,
    );
    if all {
        battery.try_system("Duffing", Planar::Battery(Two::Duffing), [0.5, 0.1], 0.0..30.0, asked);
        battery.try_system("Kepler", Four::Kepler, [0.6, 0.1, 0.1, 1.4], 0.0..12.0, asked);
        battery.try_system("Henon-Heiles", Four::HenonHeiles, [0.2, 0.1, 0.3, 0.2], 0.0..40.0, asked);
        battery.try_system("top", Three::Top, [1.0, 0.1, 0.8], 0.0..20.0, asked);
        battery.try_system("spring", Four::Spring, [1.3, 0.5, 0.0, 0.2], 0.0..8.0, asked);
        battery.try_system("decay", Planar::Battery(Two::Decay), [0.5, 0.2], 0.0..5.0, asked);
        battery.try_system("Brusselator", Planar::Battery(Two::Brusselator), [1.5, 3.0], 0.0..15.0, asked);
        battery.try_system("double", Four::Double, [1.2, 0.8, 0.3, -0.2], 0.0..10.0, asked);
        battery.try_system("sled", Four::Sled, [0.3, 0.0, 0.7, 0.5], 0.0..10.0, asked);
    }
    println!("all          now {:?}\n             before {:?}", battery.counts.now, battery.counts.before);
    battery.counts
}

#[test]
fn promises_are_kept_and_refusals_are_needed() {
    let states = std::env::var("GUEN_PROMISES").ok().and_then(|text| text.parse().ok()).unwrap_or(QUICK);
    let Counts { now, before, .. } = battery(states);
    assert_eq!(now.broken, 0, "{now:?}");
    assert!(now.promises > now.refusals, "{now:?}");
    assert!(before.needless > 0 && 2 * now.needless <= before.needless, "{now:?} {before:?}");
}
