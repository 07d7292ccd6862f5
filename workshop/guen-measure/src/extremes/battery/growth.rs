//! How errors grow along a motion, by its variational equations, and what an adaptive method may therefore be off by.
//!
//! ```text
//! G = max_k max_i sum_j |Phi(t_end, t_k)_ij| s_j(t_k) / s_i
//! ```
//!
//! with the derivative `Phi` of the end by the state at `t_k`, the sizes `s` of the entries on the whole path, and their
//! sizes about `t_k`: an error of one part in the state at some time is one of `G` parts at the end, at most. Each part of
//! the reference's path is run with duals that start there, so that nothing has to be inverted.

use guen::prelude::*;
use guen::{Dual, Liftable, seeded};

use super::reference::{Exact, Reference};

/// No answer may be further off than this, whatever the tolerance and the growth say: a question whose bound would be
/// larger asks nothing.
const WORST: f64 = 1e-3;

/// What the end may be off by after so many accepted steps. In each the error in the mean over the `N` entries is at most
/// the tolerance, so that an entry is off by `sqrt(N)` of it at most; and it grows.
pub fn allowed<const N: usize>(steps: u64, growth: f64, tolerance: f64) -> f64 {
    (steps as f64 * (N as f64).sqrt() * growth * tolerance).min(WORST)
}

/// A system over duals whose directions are the entries of the state.
struct Varied<'a, S>(&'a S);

impl<S, R, const N: usize> System<Dual<R, N>, N> for Varied<'_, S>
where
    R: Exact,
    S: Liftable<R, N, 0>,
{
    fn rhs(&self, t: Dual<R, N>, state: &[Dual<R, N>; N]) -> [Dual<R, N>; N] {
        self.0.lifted_rates(t, state, &[])
    }
}

/// An explicit method of order eight is stable up to about six times the inverse of the fastest rate.
const STABLE: f64 = 4.0;
/// Beyond as many runs for a part of the path how errors grow is not known.
const MOST_RUNS: f64 = 1e5;

/// About the largest absolute value of the eigenvalues: `|J^64|^(1/64)`.
fn fastest<const N: usize>(jacobian: &[[f64; N]; N]) -> f64 {
    let size = |a: &[[f64; N]; N]| a.iter().flatten().fold(0.0_f64, |most, entry| most.max(entry.abs()));
    let (mut power, mut logarithm) = (*jacobian, 0.0);
    for _ in 0..6 {
        let scale = size(&power);
        if scale == 0.0 {
            return 0.0;
        }
        let part = power.map(|row| row.map(|entry| entry / scale));
        power =
            std::array::from_fn(|i| std::array::from_fn(|j| (0..N).map(|k| part[i][k] * part[k][j]).sum()));
        logarithm = 2.0 * (logarithm + scale.ln());
    }
    ((logarithm + size(&power).ln()) / 64.0).exp()
}

/// By how much relative errors on the way grow until the end; the text of the error where that cannot be computed.
pub fn growth<R, S, const N: usize>(system: &S, reference: &Reference<N>) -> Result<f64, String>
where
    R: Exact,
    S: Liftable<R, N, 0>,
{
    // Two digits of the growth are enough.
    let tolerance = f64::max(1e-6, 100.0 * R::epsilon().to_f64());
    let sizes = reference.sizes;
    // Of the end by the state at the end of the part.
    let mut onwards = vec![[0.0; N]; N];
    for (i, row) in onwards.iter_mut().enumerate() {
        row[i] = 1.0;
    }
    let varied = Varied(system);
    let mut worst = 1.0_f64;
    for (k, part) in reference.path.windows(2).enumerate().rev() {
        let (from, to) = (part[0].0.to_f64(), part[1].0.to_f64());
        let start: [R; N] = part[0].1.map(|x| R::from_f64(x.to_f64()));
        let time = |t: f64| Dual::constant(R::from_f64(t));
        let method = Dop853::new(tolerance, 1e-3 * tolerance).with_max_steps(1_000_000);
        // The values alone choose the steps, which may be longer than is stable where they rest: so in short runs.
        let jacobian = varied.rhs(time(from), &seeded(&start)).map(|rate| rate.tangent.map(Real::to_f64));
        let runs = ((to - from).abs() * fastest(&jacobian) / STABLE).ceil().clamp(1.0, MOST_RUNS);
        let mut reached = seeded(&start);
        for run in 1..=runs as u32 {
            let at = |run: u32| time(from + (to - from) * (f64::from(run) / runs));
            let run =
                Integration::new(&varied, at(run - 1), &reached).guard(Guard::FINITE).run(&method, at(run));
            reached = run.map_err(|error| error.cause.to_string())?.state;
        }
        let matrix = reached.map(|x| x.tangent.map(Real::to_f64));
        let product = |row: &[f64; N]| -> [f64; N] {
            std::array::from_fn(|j| (0..N).map(|k| row[k] * matrix[k][j]).sum())
        };
        onwards = onwards.iter().map(product).collect();
        let here = reference.sizes_about(k);
        for (i, row) in onwards.iter().enumerate() {
            let sum: f64 = row.iter().zip(here).map(|(entry, size)| entry.abs() * size).sum();
            let grown = sum / sizes[i];
            worst = if grown > worst || grown.is_nan() { grown } else { worst };
        }
    }
    if worst.is_finite() { Ok(worst) } else { Err("it is not finite".to_owned()) }
}
