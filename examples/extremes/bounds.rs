//! The errors of right-hand sides against what the arithmetic allows.
//!
//! ```text
//! |f_computed - f| <= 8 u (cond + kappa_inf(M)) |f|,   cond = | sum_j |df/dz_j| |z_j| | / |f|
//! ```
//!
//! in the largest entry, with the unit roundoff `u`, the entries `z` of state and constants, and the mass matrix `M`. The
//! condition is computed with duals in 71 digits, and so is `f`. For systems with up to three parameters the same holds of
//! every entry by itself.

use std::fmt;

use guen::{Dual, Real, System};
use guen_benchmarks::Random;
use guen_study::Digits71;

/// The factor of the bound.
pub const FACTOR: f64 = 8.0;

/// Ratios of errors to `u (cond + kappa)`: at random states and along paths to the edge, in one precision.
#[derive(Clone, Debug, Default)]
pub struct Ratios(Vec<f64>);

impl Ratios {
    fn push(&mut self, error: Digits71, allowed: f64) {
        let error = error.abs().to_f64();
        // No error is none, whatever is allowed.
        self.0.push(if error == 0.0 { 0.0 } else { error / allowed });
    }

    /// The part of the ratios that lies below this one.
    pub fn quantile(&mut self, part: f64) -> f64 {
        self.0.sort_by(f64::total_cmp);
        let last = self.0.len().saturating_sub(1);
        self.0.get((part * last as f64) as usize).copied().unwrap_or(0.0)
    }

    /// The largest.
    pub fn largest(&self) -> f64 {
        self.0.iter().fold(0.0, |most, ratio| if *ratio > most || ratio.is_nan() { *ratio } else { most })
    }
}

/// What was found of a system.
#[derive(Clone, Debug)]
pub struct Found {
    pub system: &'static str,
    pub parameters: usize,
    /// In `f64` and `f32`, of the whole and of every entry: at random states, along paths.
    pub whole: [[Ratios; 2]; 2],
    pub entries: [[Ratios; 2]; 2],
}

impl Found {
    /// Whether everything is within the bound.
    pub fn holds(&self) -> bool {
        let within =
            |ratios: &[[Ratios; 2]; 2]| ratios.iter().flatten().all(|ratios| ratios.largest() <= FACTOR);
        within(&self.whole) && (self.parameters > 3 || within(&self.entries))
    }
}

impl fmt::Display for Found {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (k, precision) in ["f64", "f32"].into_iter().enumerate() {
            for (p, place) in ["random", "to the edge"].into_iter().enumerate() {
                for (what, ratios) in [("norm", &self.whole), ("entries", &self.entries)] {
                    let mut ratios = ratios[k][p].clone();
                    let [half, most, nearly] = [0.5, 0.9, 0.999].map(|part| ratios.quantile(part));
                    writeln!(
                        f,
                        "| {} | {precision} | {place} | {what} | {half:.2} | {most:.2} | {nearly:.2} | {:.2} |",
                        self.system,
                        ratios.largest(),
                    )?;
                }
            }
        }
        Ok(())
    }
}

/// The head of the table that [`Found`] displays rows of.
pub const HEAD: &str = "| system | real | states | error | median | 90 % | 99.9 % | largest |
| --- | --- | --- | --- | --- | --- | --- | --- |
";

/// A system in the reals that are compared; of the duals the first `N` directions are the state, the others constants.
pub struct Bounded<D, F, V, K, const N: usize, const C: usize> {
    pub name: &'static str,
    pub parameters: usize,
    pub double: D,
    pub single: F,
    pub varied: V,
    /// The condition of the mass matrix in the largest row sum.
    pub kappa: K,
    pub constants: [f64; C],
}

impl<D, F, V, K, const N: usize, const C: usize> Bounded<D, F, V, K, N, C>
where
    D: System<f64, N>,
    F: System<f32, N>,
    K: Fn(&[f64; N]) -> f64,
{
    /// Measures at random states and along a path, whose parameter goes from zero to one at the edge.
    pub fn measure<const M: usize>(
        &self,
        states: usize,
        state: impl Fn(&mut Random) -> [f64; N],
        path: impl Fn(&mut Random, f64) -> [f64; N],
    ) -> Found
    where
        V: System<Dual<Digits71, M>, N>,
    {
        assert_eq!(M, N + C, "a direction for each entry of the state and each constant");
        let mut found = Found {
            system: self.name,
            parameters: self.parameters,
            whole: Default::default(),
            entries: Default::default(),
        };
        let mut random = Random::new(2024);
        for round in 0..states {
            let drawn = [state(&mut random), path(&mut random, round as f64 / states as f64)];
            for (place, x) in drawn.into_iter().enumerate() {
                let short = x.map(|x| x as f32);
                let of_short = short.map(f64::from);
                let rates = self.double.rhs(0.0, &x);
                self.compare(&mut found, 0, place, &x, f64::EPSILON / 2.0, rates.map(Digits71::from_f64));
                let rates = self.single.rhs(0.0, &short).map(|rate| Digits71::from_f64(f64::from(rate)));
                self.compare(&mut found, 1, place, &of_short, f64::from(f32::EPSILON) / 2.0, rates);
            }
        }
        found
    }

    fn compare<const M: usize>(
        &self,
        found: &mut Found,
        precision: usize,
        place: usize,
        x: &[f64; N],
        unit: f64,
        rates: [Digits71; N],
    ) where
        V: System<Dual<Digits71, M>, N>,
    {
        let seeds: [Dual<Digits71, M>; N] =
            std::array::from_fn(|i| Dual::variable(Digits71::from_f64(x[i]), i));
        let exact = self.varied.rhs(Dual::constant(Digits71::zero()), &seeds);
        let arguments: Vec<f64> = x.iter().chain(&self.constants).map(|z| z.abs()).collect();
        let kappa = (self.kappa)(x);
        let sensitivity = exact.map(|rate| {
            let terms = rate.tangent.iter().zip(&arguments).map(|(slope, z)| slope.abs().to_f64() * z);
            terms.sum::<f64>()
        });
        let sizes = exact.map(|rate| rate.value.abs().to_f64());
        let most = |values: &[f64; N]| values.iter().fold(0.0_f64, |most, value| most.max(*value));
        let mut worst = Digits71::zero();
        for i in 0..N {
            let error = rates[i] - exact[i].value;
            // What is no number is worst.
            if error.abs().to_f64().partial_cmp(&worst.abs().to_f64()).is_none_or(|order| order.is_gt()) {
                worst = error;
            }
            found.entries[precision][place].push(error, unit * (sensitivity[i] + kappa * sizes[i]));
        }
        let allowed = unit * (most(&sensitivity) + kappa * most(&sizes));
        found.whole[precision][place].push(worst, allowed);
    }
}

/// The condition of a matrix in the largest row sum, by elimination in 71 digits.
pub fn kappa<const L: usize>(matrix: [[Digits71; L]; L]) -> f64 {
    let norm = |m: &[[Digits71; L]; L]| {
        m.iter().map(|row| row.iter().map(|e| e.abs().to_f64()).sum::<f64>()).fold(0.0, f64::max)
    };
    let size = norm(&matrix);
    let mut m = matrix;
    let mut inverse: [[Digits71; L]; L] =
        std::array::from_fn(|i| std::array::from_fn(|j| Digits71::from_ratio(i64::from(i == j), 1)));
    for k in 0..L {
        // Positive definite: no exchanges.
        let pivot = m[k][k];
        for j in 0..L {
            m[k][j] /= pivot;
            inverse[k][j] /= pivot;
        }
        for i in (0..L).filter(|i| *i != k) {
            let factor = m[i][k];
            for j in 0..L {
                let (above, beside) = (m[k][j], inverse[k][j]);
                m[i][j] -= factor * above;
                inverse[i][j] -= factor * beside;
            }
        }
    }
    size * norm(&inverse)
}

/// A declared system with its constants, in all reals.
macro_rules! bounded {
    ($name:literal, $System:ident in $module:ident { $($constant:ident: $value:expr),* }, $parameters:literal parameters,
        $n:literal + $c:literal = $m:literal) => {{
        let long = guen_benchmarks::systems::$System { $($constant: Digits71::from_f64($value)),* }.prepare();
        let long = long.expect("constants in their bounds");
        let mut direction = $n;
        let mut variable = |value: f64| {
            direction += 1;
            Dual::<Digits71, $m>::variable(Digits71::from_f64(value), direction - 1)
        };
        let varied = guen_benchmarks::systems::$System { $($constant: variable($value)),* }.prepare();
        Bounded::<_, _, _, _, $n, $c> {
            name: $name,
            parameters: $parameters,
            double: guen_benchmarks::systems::$System { $($constant: $value),* }.prepare().expect("in their bounds"),
            single: guen_benchmarks::systems::$System::<f32> { $($constant: $value as f32),* }
                .prepare()
                .expect("in their bounds"),
            varied: varied.expect("constants in their bounds"),
            kappa: move |x: &[f64; $n]| {
                let state = guen_benchmarks::systems::$module::State::from(x.map(Digits71::from_f64));
                kappa(long.mass_form(Digits71::zero(), &state).mass)
            },
            constants: [$($value),*],
        }
    }};
}

/// A state with entries between minus two and two, and this one towards an edge: from one to 1e-12 from it, on the side
/// that the edge has.
fn towards<const N: usize>(random: &mut Random, index: usize, edge: f64, part: f64) -> [f64; N] {
    let mut x: [f64; N] = std::array::from_fn(|_| random.between(-2.0, 2.0));
    let distance = 10.0_f64.powf(-12.0 * part);
    x[index] = if edge == 0.0 { distance } else { edge - distance };
    x
}

fn anywhere<const N: usize>(random: &mut Random) -> [f64; N] {
    std::array::from_fn(|_| random.between(-2.0, 2.0))
}

/// All systems, so many states of either kind.
pub fn all(states: usize) -> Vec<Found> {
    use std::f64::consts::PI;
    // Constants that single precision has too.
    let hoop =
        bounded!("hoop", Hoop in hoop { a: 0.75, A: 0.5, C: 1.25, g: 9.8125 }, 3 parameters, 9 + 4 = 13);
    let appell = bounded!("appell", Appell in appell { a: 0.75, A: 0.5, C: 1.25, g: 9.8125 }, 3 parameters, 9 + 4 = 13);
    let sled = bounded!("sled", Sled in sled { m: 1.5, alpha: 0.25, beta: 0.5, k: 0.75, incline: 0.375, g: 9.8125 },
        2 parameters, 5 + 6 = 11);
    let flat = bounded!("sled, gamma^2 - beta^2 = 3e-7", Sled in sled { m: 1.5, alpha: 1.0 / 4096.0, beta: 1.0, k: 1.0 / 2048.0, incline: 0.375, g: 9.8125 },
        2 parameters, 5 + 6 = 11);
    let turntable = bounded!("turntable", EvenTurntable in even_turntable { m: 1.5, a: 0.125, Omega: 0.75 }, 3 parameters, 8 + 3 = 11);
    let top = bounded!("top", EulerTop in euler_top { I1: 1.0, I2: 2.5, I3: 3.25 }, 3 parameters, 6 + 3 = 9);
    let chain =
        bounded!("chain of 5", Chain5 in chain5 { m: 0.75, l: 0.5, g: 9.8125 }, 5 parameters, 10 + 3 = 13);
    let side = |random: &mut Random| if random.bits() & 1 == 0 { 0.0 } else { PI };
    vec![
        hoop.measure::<13>(states, anywhere, |random, part| {
            let edge = side(random);
            towards(random, 0, edge, part)
        }),
        appell.measure::<13>(states, anywhere, |random, part| {
            let edge = side(random);
            towards(random, 0, edge, part)
        }),
        // No edge: towards the headings at which the incline pulls along the blade and across it.
        sled.measure::<11>(states, anywhere, |random, part| {
            let edge = side(random) / 2.0;
            towards(random, 0, edge, part)
        }),
        flat.measure::<11>(states, anywhere, |random, part| {
            let edge = side(random) / 2.0;
            towards(random, 0, edge, part)
        }),
        turntable.measure::<11>(states, anywhere, |random, part| {
            let edge = side(random);
            towards(random, 3, edge, part)
        }),
        top.measure::<9>(states, anywhere, |random, part| {
            let edge = side(random);
            towards(random, 1, edge, part)
        }),
        // Towards the folded and the straight chain.
        chain.measure::<13>(states, anywhere, |random, part| {
            let mut x: [f64; 10] = anywhere(random);
            for angle in &mut x[..5] {
                *angle = side(random) + *angle * 10.0_f64.powf(-12.0 * part);
            }
            x
        }),
    ]
}
