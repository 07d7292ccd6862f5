//! Extrapolation of the midpoint rule: the method of references, of any even order without a coefficient to be wrong.

use guen_runtime::{Ordered, System};

/// The columns of the table: order `2 COLUMNS`, and `COLUMNS (COLUMNS + 1) + 1` evaluations for a step.
const COLUMNS: usize = 12;
const SAFETY: f64 = 0.8;
const SHORTEN: f64 = 0.1;
const GROW: f64 = 4.0;
/// Steps below this part of the span are short, and a jump of the rates is gone over by some 50 trials of them: by more there is a
/// singularity.
const SHORTEST_STEP: f64 = 1e-12;
const MOST_SHORT: u32 = 200;

/// The reason why a run ended early.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Stop {
    /// The step no longer moves the time, or nothing finite was found however short it was.
    Underflow,
    /// The observer stopped the run.
    Cancelled,
}

/// Carries `state` from `t0` through `times`, which run in one direction, and returns the states there and the number of
/// evaluations.
///
/// The midpoint rule with `n = 2, 4, .., 2 COLUMNS` substeps has an error in even powers of the substep, which Neville's
/// scheme eliminates one by one:
///
/// ```text
/// y_0 = x,  y_1 = x + h f(x),  y_(m+1) = y_(m-1) + 2 h f(y_m),  h = H/n
/// T_j,k = T_j,k-1 + (T_j,k-1 - T_j-1,k-1) / ((n_j / n_(j-k+1))^2 - 1)
/// ```
///
/// A step is accepted where the last two columns differ by at most `tolerance` of `max(1, |x_i|)` in every entry. Source:
/// Hairer, Norsett and Wanner, *Solving Ordinary Differential Equations I*, section II.9, equations (9.10) and (9.13).
pub(super) fn extrapolate<R, S, W, const N: usize>(
    system: &S,
    t0: R,
    start: &[R; N],
    times: &[R],
    tolerance: f64,
    mut watch: W,
) -> Result<(Vec<[R; N]>, u64), Stop>
where
    R: Ordered,
    S: System<R, N>,
    W: FnMut(R) -> bool,
{
    let (mut t, mut x) = (t0, *start);
    let mut states = Vec::with_capacity(times.len());
    let mut evaluations = 0;
    let span = times.last().map_or(0.0, |last| (*last - t0).to_f64().abs());
    // Shortened by the first trials, if it is too long.
    let mut size = span / 64.0;
    let mut short = 0;
    for &target in times {
        while t != target {
            if !watch(t) {
                return Err(Stop::Cancelled);
            }
            let rest = target - t;
            let landing = size >= 0.999 * rest.to_f64().abs();
            let step = if landing { rest } else { R::from_f64(size.copysign(rest.to_f64())) };
            let next = if landing { target } else { t + step };
            short = if size < SHORTEST_STEP * span { short + 1 } else { 0 };
            if next == t || short > MOST_SHORT {
                return Err(Stop::Underflow);
            }
            let (trial, error) = attempt(system, t, &x, step, tolerance);
            evaluations += (COLUMNS * (COLUMNS + 1) + 1) as u64;
            let used = step.to_f64().abs();
            let exponent = -1.0 / (2 * COLUMNS - 1) as f64;
            let factor = if error.is_finite() { SAFETY * error.powf(exponent) } else { SHORTEN };
            let mut accepted = trial;
            let good = error <= 1.0 && system.restore(next, &mut accepted).is_ok();
            if good {
                (t, x) = (next, accepted);
                let longer = used * factor.clamp(SHORTEN, GROW);
                // What was asked for beyond a landing has not become wrong by it.
                size = if landing { longer.max(size) } else { longer };
            } else {
                size = used * factor.clamp(SHORTEN, 0.9);
            }
        }
        states.push(x);
    }
    Ok((states, evaluations))
}

/// A step, and its error in units of the tolerance.
fn attempt<R, S, const N: usize>(system: &S, t: R, x: &[R; N], step: R, tolerance: f64) -> ([R; N], f64)
where
    R: Ordered,
    S: System<R, N>,
{
    let slope = system.rhs(t, x);
    // Of the table one row at a time: `row[k]` is `T_j,k`.
    let mut row: Vec<[R; N]> = Vec::with_capacity(COLUMNS);
    let mut last = [R::zero(); N];
    for j in 0..COLUMNS {
        let count = 2 * (j + 1) as i64;
        let mut above = midpoint(system, t, x, &slope, step, count);
        for (k, entry) in row.iter_mut().enumerate() {
            let fewer = 2 * (j - k) as i64;
            let ratio = R::from_ratio(count * count - fewer * fewer, fewer * fewer);
            let before = std::mem::replace(entry, above);
            last = above;
            for i in 0..N {
                above[i] += (above[i] - before[i]) / ratio;
            }
        }
        row.push(above);
    }
    let best = row[COLUMNS - 1];
    let mut error = 0.0_f64;
    for i in 0..N {
        let scale = tolerance * best[i].to_f64().abs().max(1.0);
        let part = (best[i] - last[i]).to_f64().abs() / scale;
        error = if part.is_nan() { f64::INFINITY } else { error.max(part) };
    }
    (best, error)
}

fn midpoint<R, S, const N: usize>(system: &S, t: R, x: &[R; N], slope: &[R; N], step: R, count: i64) -> [R; N]
where
    R: Ordered,
    S: System<R, N>,
{
    let h = step / R::from_ratio(count, 1);
    let twice = h + h;
    let mut before = *x;
    let mut now: [R; N] = std::array::from_fn(|i| x[i] + h * slope[i]);
    for m in 1..count {
        let rates = system.rhs(t + h * R::from_ratio(m, 1), &now);
        for i in 0..N {
            before[i] += twice * rates[i];
        }
        std::mem::swap(&mut before, &mut now);
    }
    now
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::Digits71;
    use guen_runtime::{Equations, Real, generic};

    /// `x' = x cos t`, `x = exp(sin t)`.
    struct Driven;
    impl Equations<1> for Driven {
        fn rates<R: Real>(&self, t: R, &[x]: &[R; 1]) -> [R; 1] {
            [x * t.cos()]
        }
    }

    #[test]
    fn thirty_digits_of_a_known_solution() {
        let times = [1, 3, 5].map(|k| Digits71::from_ratio(k, 1));
        let one = [Digits71::one()];
        let (states, evaluations) =
            extrapolate(&generic(Driven), Digits71::zero(), &one, &times, 1e-32, |_| true).unwrap();
        for (t, state) in times.iter().zip(&states) {
            let exact = t.sin().exp();
            assert!((state[0] - exact).abs().to_f64() < 1e-30);
        }
        assert!(evaluations < 20_000, "{evaluations}");
    }

    #[test]
    fn doubles_backwards_and_a_span_of_zero() {
        let (states, _) = extrapolate(&generic(Driven), 2.0, &[1.0], &[1.0, 0.0], 1e-13, |_| true).unwrap();
        assert!((states[1][0] - (-(2.0_f64.sin())).exp()).abs() < 1e-12);
        let (states, evaluations) =
            extrapolate(&generic(Driven), 2.0, &[1.0], &[2.0], 1e-13, |_| true).unwrap();
        assert_eq!((states, evaluations), (vec![[1.0]], 0));
    }

    #[test]
    fn a_pole_is_an_underflow_and_a_watcher_can_stop() {
        struct Pole;
        impl Equations<1> for Pole {
            fn rates<R: Real>(&self, _t: R, &[x]: &[R; 1]) -> [R; 1] {
                [x * x]
            }
        }
        let run = |watch: &dyn Fn(f64) -> bool| extrapolate(&generic(Pole), 0.0, &[1.0], &[2.0], 1e-9, watch);
        assert_eq!(run(&|_| true).unwrap_err(), Stop::Underflow);
        assert_eq!(run(&|t| t < 0.5).unwrap_err(), Stop::Cancelled);
    }
}
