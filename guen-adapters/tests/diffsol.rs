//! The sled by methods of `diffsol`, against our own.

mod common;

use common::{case, distance, end};
use diffsol::{MatrixCommon, NalgebraLU, NalgebraMat, OdeSolverMethod};
use guen_adapters::ByDuals;
use guen_adapters::diffsol::problem;

type M = NalgebraMat<f64>;

#[test]
fn a_stiff_sled_arrives_where_ours_does() {
    let (system, inputs, start, span) = case(40.0);
    let problem = problem::<M, _, 5, 1>(system, inputs, 0.0, start, [1e-9, 1e-9]).unwrap();
    let mut solver = problem.bdf::<NalgebraLU<f64>>().unwrap();
    let (states, times, _) = solver.solve(span).unwrap();
    let last = states.inner().column(times.len() - 1).iter().copied().collect::<Vec<_>>();
    let error = distance(&last, &end(40.0));
    assert!(error < 1e-5, "{error:e}");
}

#[test]
fn a_method_of_runge_kutta_takes_the_same_problem() {
    let (system, inputs, start, span) = case(0.1);
    let problem =
        problem::<M, _, 5, 0>(ByDuals(system.driven(inputs)), [], 0.0, start, [1e-10, 1e-10]).unwrap();
    let mut solver = problem.tsit45().unwrap();
    let (states, times, _) = solver.solve(span).unwrap();
    let last = states.inner().column(times.len() - 1).iter().copied().collect::<Vec<_>>();
    let error = distance(&last, &end(0.1));
    assert!(error < 1e-6, "{error:e}");
}
