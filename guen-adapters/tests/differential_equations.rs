//! The sled by methods of `differential-equations`, explicit and implicit, against our own.

mod common;

use common::{case, distance, end, sled};
use differential_equations::linalg::Matrix;
use differential_equations::ode::ODE;
use differential_equations::prelude::*;
use guen_adapters::ByDuals;
use guen_adapters::differential_equations::Adapted;

#[test]
fn an_explicit_method_arrives_where_ours_does() {
    let (system, inputs, start, span) = case(0.1);
    let adapted = Adapted::with_inputs(system, inputs);
    let method = ExplicitRungeKutta::dop853().rtol(1e-12).atol(1e-12);
    let done = IVP::ode(&adapted, 0.0, span, start).method(method).solve().unwrap();
    assert!(distance(done.y.last().unwrap(), &end(0.1)) < 1e-9);
}

#[test]
fn an_implicit_method_is_given_the_jacobian() {
    let (system, inputs, start, span) = case(40.0);
    let adapted = Adapted::with_inputs(system, inputs);
    let method = ImplicitRungeKutta::radau5().rtol(1e-9).atol(1e-9);
    let done = IVP::ode(&adapted, 0.0, span, start).method(method).solve().unwrap();
    assert!(distance(done.y.last().unwrap(), &end(40.0)) < 1e-6);
    // By code and by duals, and not by differences: the last bits agree.
    let mut matrices = [Matrix::zeros(5, 5), Matrix::zeros(5, 5)];
    let [code, duals] = &mut matrices;
    adapted.jacobian(0.3, &start, code);
    Adapted::new(ByDuals(system.driven(inputs))).jacobian(0.3, &start, duals);
    let expected = system.linearize(0.3, &sled::State::from(start), &inputs);
    for (i, row) in expected.a.iter().enumerate() {
        for (j, entry) in row.iter().enumerate() {
            assert_eq!(code[(i, j)], *entry);
            assert!((duals[(i, j)] - entry).abs() <= 1e-13 * (1.0 + entry.abs()));
        }
    }
}

#[test]
fn the_carried_form_is_a_system_too() {
    let (system, inputs, start, span) = case(0.1);
    let carried = system.carried().unwrap();
    let begin: [f64; 7] = sled::State::from(start).carried(&carried, 0.0).into();
    let method = ExplicitRungeKutta::dop853().rtol(1e-12).atol(1e-12);
    let adapted = Adapted::new(ByDuals(carried.driven(inputs)));
    let done = IVP::ode(&adapted, 0.0, span, begin).method(method).solve().unwrap();
    assert!(distance(done.y.last().unwrap(), &end(0.1)) < 1e-9);
}
