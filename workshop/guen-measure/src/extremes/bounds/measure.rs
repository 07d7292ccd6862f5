//! One system at many states, in doubles, in single precision, and in duals of 71 digits.

use std::time::Instant;

use guen::{Dual, Real, System};
use guen_benchmarks::Random;
use guen_study::Digits71;

use super::{Found, Worst};

/// A system in the reals that are compared; of the duals the first `N` directions are the state, the others constants.
pub struct Bounded<D, F, V, K, const N: usize, const C: usize> {
    pub name: &'static str,
    pub parameters: usize,
    pub double: D,
    /// Or why the constants are refused in single precision.
    pub single: Result<F, String>,
    pub varied: V,
    /// The condition of the mass matrix in the largest row sum.
    pub kappa: K,
    pub constants: [f64; C],
}

impl<D, F, V, K, const N: usize, const C: usize> Bounded<D, F, V, K, N, C>
where
    D: System<f64, N>,
    F: System<f32, N>,
    K: Fn(f64, &[f64; N]) -> f64,
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
        let begun = Instant::now();
        let mut found = Found {
            system: self.name,
            parameters: self.parameters,
            whole: Default::default(),
            entries: Default::default(),
            not_finite: Default::default(),
            refused: self.single.as_ref().err().cloned(),
            worst: Default::default(),
            seconds: 0.0,
        };
        let mut random = Random::new(2024);
        for round in 0..states {
            // A time that single precision has too.
            let t = random.between(-2.0, 2.0) as f32;
            let part = (round + 1) as f64 / states as f64;
            let drawn = [state(&mut random), path(&mut random, part)];
            for (place, x) in drawn.into_iter().enumerate() {
                let t_long = f64::from(t);
                let rates = self.double.rhs(t_long, &x).map(Digits71::from_f64);
                self.compare(&mut found, [0, place], t_long, &x, f64::EPSILON / 2.0, rates);
                let Ok(single) = &self.single else { continue };
                let short = x.map(|x| x as f32);
                let rates = single.rhs(t, &short).map(|rate| Digits71::from_f64(f64::from(rate)));
                let unit = f64::from(f32::EPSILON) / 2.0;
                self.compare(&mut found, [1, place], t_long, &short.map(f64::from), unit, rates);
            }
        }
        found.seconds = begun.elapsed().as_secs_f64();
        found
    }

    fn compare<const M: usize>(
        &self,
        found: &mut Found,
        [real, place]: [usize; 2],
        t: f64,
        x: &[f64; N],
        unit: f64,
        rates: [Digits71; N],
    ) where
        V: System<Dual<Digits71, M>, N>,
    {
        if !rates.iter().all(|rate| rate.is_finite()) {
            found.not_finite[real][place] += 1;
            return;
        }
        let seeds: [Dual<Digits71, M>; N] =
            std::array::from_fn(|i| Dual::variable(Digits71::from_f64(x[i]), i));
        let exact = self.varied.rhs(Dual::constant(Digits71::from_f64(t)), &seeds);
        let sizes_of_arguments: Vec<f64> = x.iter().chain(&self.constants).map(|z| z.abs()).collect();
        let kappa = (self.kappa)(t, x);
        let sensitivity = exact.map(|rate| {
            let terms = rate.tangent.iter().zip(&sizes_of_arguments);
            terms.map(|(slope, z)| slope.abs().to_f64() * z).sum::<f64>()
        });
        let sizes = exact.map(|rate| rate.value.abs().to_f64());
        let most = |values: &[f64; N]| values.iter().fold(0.0_f64, |most, value| most.max(*value));
        let mut worst = Digits71::zero();
        for i in 0..N {
            let error = rates[i] - exact[i].value;
            if error.abs().to_f64() > worst.abs().to_f64() {
                worst = error;
            }
            let ratio = found.entries[real][place].push(error, unit * (sensitivity[i] + kappa * sizes[i]));
            if ratio > found.worst.ratio {
                found.worst = Worst { ratio, real, entry: i, time: t, state: x.to_vec() };
            }
        }
        let allowed = unit * (most(&sensitivity) + kappa * most(&sizes));
        found.whole[real][place].push(worst, allowed);
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
