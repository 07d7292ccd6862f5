//! How accurate an integration in double precision can be, from the variational equation along the reference.
//!
//! Three sources of error reach an output time `t_k`, each through the exact growth `P(t_k, t_j)` of a small
//! displacement, which duals integrate along the reference from output time to output time:
//!
//! - the initial state and the constants are decimals, rounded to half an ulp: a fixed displacement, so that its
//!   parts add up by absolute values;
//! - every step rounds the state, its rates and what they are computed from (a relative error of half an ulp in every
//!   argument of the right-hand side, with the derivatives as weights): independent errors, so that their squares
//!   add up. They enter at either end of the interval of their step, whichever grows more (both are added);
//! - every step truncates by at most the tolerance, which is of the order of an ulp, and is treated alike.
//!
//! The bound is the first plus [`DEVIATIONS`] times the root of the sum of squares of the others.

use guen::Dual;
use guen::prelude::*;

/// Relative tolerance of the reference runs: a few roundings.
pub const RTOL: f64 = 4e-16;
/// Absolute tolerance, for entries near zero.
pub const ATOL: f64 = 4e-17;
/// Half an ulp of one: the largest relative error of one rounding, taken as its standard deviation.
const UNIT: f64 = 0.5 * f64::EPSILON;
/// How many standard deviations count as possible: the errors of a few hundred outputs are compared.
const DEVIATIONS: f64 = 4.0;

type Matrix<const N: usize, const M: usize> = [[f64; M]; N];

/// A system twice: in `f64`, and in duals whose directions are the `N` entries of the state, then the constants.
pub struct Subject<S, D, const M: usize> {
    pub system: S,
    pub varied: D,
    pub constants: Vec<f64>,
}

/// For each output time the possible error of each entry of the state.
pub fn bounds<S, D, const N: usize, const M: usize>(
    subject: &Subject<S, D, M>,
    times: &[f64],
    states: &[Vec<f64>],
) -> Vec<[f64; N]>
where
    S: System<f64, N>,
    D: System<Dual<f64, M>, N>,
{
    let state = |k: usize| -> [f64; N] { std::array::from_fn(|i| states[k][i]) };
    let identity: Matrix<N, N> =
        std::array::from_fn(|i| std::array::from_fn(|j| f64::from(u8::from(i == j))));
    // Displacements by the initial state and the constants, and independent errors with their growth so far.
    let mut start = identity;
    let mut by_constants: Vec<[f64; N]> = vec![[0.0; N]; subject.constants.len()];
    let mut errors: Vec<([f64; N], Matrix<N, N>)> = Vec::new();
    let half_ulps = |x: &[f64; N]| x.map(|x| UNIT * x.abs());
    let mut found = vec![half_ulps(&state(0))];
    for k in 1..times.len() {
        let (from, to) = (state(k - 1), times[k]);
        let (growth, forced) = propagate(&subject.varied, times[k - 1], &from, to, subject.constants.len());
        start = product(&growth, &start);
        for (column, forced) in by_constants.iter_mut().zip(&forced) {
            *column = std::array::from_fn(|i| dot(&growth[i], column) + forced[i]);
        }
        for (_, grown) in &mut errors {
            *grown = product(&growth, grown);
        }
        let squares = step_errors(subject, times[k - 1], &from, to);
        errors.push((squares, growth));
        errors.push((squares, identity));
        let (initial, halves) = (half_ulps(&state(0)), half_ulps(&state(k)));
        found.push(std::array::from_fn(|i| {
            let fixed: f64 = (0..N).map(|j| start[i][j].abs() * initial[j]).sum();
            let constants = by_constants.iter().zip(&subject.constants);
            let constants: f64 = constants.map(|(d, c)| d[i].abs() * UNIT * c.abs()).sum();
            let squares: f64 = errors
                .iter()
                .map(|(squares, grown)| (0..N).map(|j| grown[i][j].powi(2) * squares[j]).sum::<f64>())
                .sum();
            // The reference is rounded to f64 before it is compared.
            halves[i] + fixed + constants + DEVIATIONS * squares.sqrt()
        }));
    }
    found
}

/// The growth of displacements from one output time to the next, and the displacement by each constant.
fn propagate<D, const N: usize, const M: usize>(
    varied: &D,
    t: f64,
    state: &[f64; N],
    to: f64,
    constants: usize,
) -> (Matrix<N, N>, Vec<[f64; N]>)
where
    D: System<Dual<f64, M>, N>,
{
    assert_eq!(M, N + constants);
    let seeds: [Dual<f64, M>; N] = std::array::from_fn(|i| Dual::variable(state[i], i));
    // The growth is asked for to a few digits: it weighs errors.
    let end = Integration::new(varied, Dual::constant(t), &seeds)
        .run(&Dop853::new(1e-7, 1e-9).with_max_steps(1_000_000), Dual::constant(to))
        .unwrap()
        .state;
    let growth = end.map(|x| std::array::from_fn(|j| x.tangent[j]));
    let forced = (N..M).map(|c| end.map(|x| x.tangent[c])).collect();
    (growth, forced)
}

/// The sums of squares of the errors of all steps of an interval.
fn step_errors<S, D, const N: usize, const M: usize>(
    subject: &Subject<S, D, M>,
    t: f64,
    state: &[f64; N],
    to: f64,
) -> [f64; N]
where
    S: System<f64, N>,
    D: System<Dual<f64, M>, N>,
{
    let (mut last, mut squares) = (t, [0.0; N]);
    let mut observe = |t: f64, x: &[f64; N]| {
        let h = (t - last).abs();
        last = t;
        let seeds: [Dual<f64, M>; N] = std::array::from_fn(|i| Dual::variable(x[i], i));
        let rates = subject.varied.rhs(Dual::constant(t), &seeds);
        for i in 0..N {
            let arguments = x.iter().chain(&subject.constants);
            let spread: f64 = arguments.zip(&rates[i].tangent).map(|(x, d)| (x * d).abs()).sum();
            let rounding = UNIT * (x[i].abs() + h * (rates[i].value.abs() + spread));
            let truncation = RTOL * x[i].abs() + ATOL;
            squares[i] += (rounding + truncation).powi(2);
        }
        ControlFlow::Continue(())
    };
    method().integrate(&subject.system, t, state, to, &mut observe).unwrap();
    squares
}

/// The method of the reference runs.
pub fn method() -> Dop853 {
    Dop853::new(RTOL, ATOL).with_max_steps(1_000_000)
}

fn product<const N: usize>(a: &Matrix<N, N>, b: &Matrix<N, N>) -> Matrix<N, N> {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..N).map(|k| a[i][k] * b[k][j]).sum()))
}

fn dot<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
