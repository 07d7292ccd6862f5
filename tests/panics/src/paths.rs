//! What is done with a system: its right-hand side, and runs.

use core::ops::ControlFlow;

use guen::prelude::*;
use guen::steppers::{Bounded, Direction, Event, Method};
use guen::{Coefficients, Differentiable, TaylorSeries};

fn go_on<const N: usize>(_: f64, _: &[f64; N]) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// The rates in place of the state.
pub fn rates<S: System<f64, N>, const N: usize>(system: &S, state: &mut [f64; N], t: f64) -> bool {
    *state = system.rhs(t, state);
    true
}

/// The coefficients of the motion's Taylor series, the highest in place of the state.
pub fn series<S: TaylorSeries<f64, N>, const N: usize>(
    system: &S,
    state: &mut [f64; N],
    t: f64,
    scale: f64,
) -> bool {
    let mut coefficients: Coefficients<f64, N> = [[0.0; N]; guen::HIGHEST_ORDER + 1];
    system.series(t, state, scale, guen::HIGHEST_ORDER, &mut coefficients);
    *state = coefficients[guen::HIGHEST_ORDER];
    true
}

/// A run by any method, with the default guards and an observer.
pub fn run<S, M, const N: usize>(system: &S, method: &M, state: &mut [f64; N], t: f64, span: f64) -> bool
where
    S: System<f64, N>,
    M: Method<f64, S, N>,
{
    let mut steps = 0_u32;
    let run = Integration::new(system, t, state)
        .observe(&mut |_, _| {
            steps = steps.wrapping_add(1);
            ControlFlow::Continue(())
        })
        .run(method, t + span);
    match run {
        Ok(done) => *state = done.state,
        Err(error) => *state = error.state,
    }
    steps > 0 && run.is_ok()
}

/// A run with samples and events.
pub fn watched<S, M, const N: usize>(system: &S, method: &M, state: &mut [f64; N], t: f64, span: f64) -> bool
where
    S: System<f64, N>,
    M: Method<f64, S, N>,
{
    let height = |_t: f64, x: &[f64; N]| x[0];
    let times = [t, t + 0.25 * span, t + 0.5 * span];
    let mut sum = 0.0;
    let run = Integration::new(system, t, state)
        .sample(&times, &mut |_, _, x| sum += x[0])
        .events([Event::new(&height).direction(Direction::Falling)], &mut |event| {
            if event.time > 0.0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        })
        .run(method, t + span);
    state[0] = sum;
    run.is_ok()
}

/// A control period with bounded work.
pub fn period<S: System<f64, N>, const N: usize>(
    system: &S,
    method: &Bounded,
    state: &mut [f64; N],
    t: f64,
    span: f64,
) -> bool {
    match method.advance(system, t, state, t + span) {
        Ok(bound) => {
            *state = bound.state;
            true
        }
        Err(_) => false,
    }
}

/// Landing on times, without an integration.
pub fn landing<S: System<f64, N>, const N: usize>(
    system: &S,
    state: &mut [f64; N],
    t: f64,
    step: f64,
    times: &[f64],
) -> bool {
    let (mut sum, start) = (0.0, *state);
    let run = Rk4::new(step).sample(system, t, &start, times, |_, _, x| sum += x[0]);
    state[0] = sum;
    run.is_ok() && Rk4::new(step).integrate(system, t, &start, t + step, go_on).is_ok()
}

/// The Jacobian's first column.
pub fn slopes<S: Differentiable<f64, N>, const N: usize>(system: &S, state: &mut [f64; N], t: f64) -> bool {
    *state = system.jacobian(t, state).map(|row| row[0]);
    true
}
