//! Runs that know nothing of contacts: methods refuse the system itself, and take it in a mode.

use core::ops::ControlFlow;

use guen::lanes::{Backend, LaneTask, Lanes, Width, dispatch_on};
use guen::prelude::*;
use guen::steppers::{Gauss4, Radau5, reversible};
use guen::{Actuated, IntegrationError, Laned, System, WithScalar};

use crate::declared::*;

guen::mechanical_system! {
    /// A bead that a grip may hold on its wire; another one beside it for a constraint on positions.
    pub system Bead {
        constants { F > 0 = 1, push = 1/2 }
        coordinates { x, y }
        parameters { v = dot(x); }
        holonomic { u: y - x = 0; }
        kinetic_energy = 1/2*v^2 + 0*u;
        forces { push along dot(x); }
        contacts { hold: grip = dot(x), limit = F; }
    }
}

guen::mechanical_system! {
    /// A slider that is turned back at one, without anything that touches.
    pub system Returned {
        constants { m > 0 = 1 }
        inputs { force }
        coordinates { x }
        parameters { v = dot(x); }
        kinetic_energy = m/2*v^2;
        forces { force along v; }
        resets { back: x - 1 rises, v = -v; }
        scene Free { fix m = 2; track x; }
    }
}

/// The run ended before its first step, with the reason.
fn is_refused<R: Real + PartialEq, const N: usize>(error: &IntegrationError<R, N>, start: &[R; N]) {
    assert_eq!(error.cause, Cause::Contacts);
    assert!(error.state == *start && error.statistics.accepted == 0);
    assert!(error.to_string().contains("`in_mode(mode)`"), "{error}");
}

#[test]
fn every_method_refuses_a_system_with_contacts() {
    let ball = BouncingBall::default().prepare().unwrap();
    let start = [1.0, 0.0];
    let run = |done: Result<_, IntegrationError<f64, 2>>| is_refused(&done.map(drop).unwrap_err(), &start);
    macro_rules! refused {
        ($($method:expr),*) => {
            $(run(Integration::new(&ball, 0.0, &start).run(&$method, 3.0).map(drop));)*
        };
    }
    refused!(
        Dop853::new(1e-9, 1e-9),
        Tsit5::new(1e-6, 1e-6),
        Rk4::new(0.01),
        Rk8::new(0.01),
        Euler::new(0.01)
    );
    refused!(Radau5::new(1e-6, 1e-6), Gauss4::new(0.01));
    run(Rk4::new(0.01).integrate(&ball, 0.0, &start, 3.0, |_, _| ControlFlow::Continue(())).map(drop));
}

#[test]
fn resets_without_contacts_are_refused_alike() {
    let slider = Returned::default().prepare().unwrap();
    let driven = slider.driven(returned::Inputs { force: 0.0 });
    let start = [0.5, 1.0];
    let method = Dop853::new(1e-9, 1e-9);
    is_refused(&Integration::new(&driven, 0.0, &start).run(&method, 2.0).unwrap_err(), &start);
    let by_law = slider.with_inputs(|_, _| returned::Inputs { force: 0.0 });
    is_refused(&Integration::new(&by_law, 0.0, &start).run(&method, 2.0).unwrap_err(), &start);
    let over_duals = Dop853::new(1e-9, 1e-9);
    is_refused(&reversible(&slider, &[0.0], &over_duals, 0.0, &start, 2.0, 1e-6).unwrap_err(), &start);
    let scene = returned::Free::default().prepare().unwrap().driven(returned::free::Inputs { force: 0.0 });
    is_refused(&Integration::new(&scene, 0.0, &start).run(&method, 2.0).unwrap_err(), &start);
    let end = driven.simulate(&start.into(), 0.0..2.0).unwrap().end();
    assert!((end.x + 0.5).abs() < 1e-12 && end.v == -1.0, "{end:?}");

    let ball = BouncingBall::default().prepare().unwrap();
    let over_duals = Dop853::new(1e-9, 1e-9);
    is_refused(&reversible(&ball, &[], &over_duals, 0.0, &[1.0, 0.0], 1.0, 1e-6).unwrap_err(), &[1.0, 0.0]);
}

#[test]
fn other_reals_and_held_inputs_refuse_too() {
    let ball = BouncingBall::default().prepare().unwrap().with_scalar::<f32>().unwrap();
    let start = bouncing_ball::State { z: 1.0_f32, v: 0.0 };
    let error = ball.simulate(&start, 0.0..3.0).unwrap_err();
    assert_eq!((error.time, error.cause), (0.0, Cause::Contacts));

    let wheel = Wheel::default().prepare().unwrap();
    let start = wheel::State { z: 0.3, ..Default::default() }.into();
    let driven = wheel.driven(wheel::Inputs { torque: 1.0 });
    is_refused(
        &Integration::new(&driven, 0.0, &start).run(&Dop853::new(1e-9, 1e-9), 1.0).unwrap_err(),
        &start,
    );
    let law = Actuated::with_inputs(wheel, |_t, _state| wheel::Inputs { torque: 1.0 });
    is_refused(&Integration::new(&law, 0.0, &start).run(&Dop853::new(1e-9, 1e-9), 1.0).unwrap_err(), &start);
}

#[test]
fn a_grip_beside_a_constraint_on_positions_is_not_ignored() {
    let bead = Bead::default().prepare().unwrap();
    let start = [0.0; 3];
    let method = Dop853::new(1e-9, 1e-9);
    is_refused(&Integration::new(&bead, 0.0, &start).run(&method, 1.0).unwrap_err(), &start);
    is_refused(
        &Integration::new(&guen::projected(&bead), 0.0, &start).run(&method, 1.0).unwrap_err(),
        &start,
    );
    let single = bead.with_scalar::<f32>().unwrap();
    let error = single.simulate(&Default::default(), 0.0..1.0).unwrap_err();
    assert_eq!((error.time, error.cause), (0.0, Cause::Contacts));
    // Through its modes the grip holds.
    assert_eq!(bead.simulate(&Default::default(), 0.0..1.0).unwrap().end().x, 0.0);
}

#[test]
fn methods_take_the_system_in_a_mode_and_its_own_rates_stay() {
    let ball = BouncingBall::default().prepare().unwrap();
    assert_eq!(System::rhs(&ball, 0.0, &[1.0, 2.0]), [2.0, -9.81]);
    let flight = ball.in_mode(bouncing_ball::Mode { floor: bouncing_ball::Floor::Open });
    let done = Integration::new(&flight, 0.0, &[1.0, 0.0]).run(&Rk4::new(0.01), 0.4).unwrap();
    assert!((done.state[0] - (1.0 - 9.81 / 2.0 * 0.16)).abs() < 1e-12);
}

struct Falling(bouncing_ball::Prepared);

impl LaneTask for Falling {
    type Output = Vec<Cause>;

    fn run<L: Lanes>(self) -> Self::Output {
        let balls = <bouncing_ball::Prepared as Laned<2>>::gather::<L>(|_| &self.0);
        let start = [L::from_f64(1.0), L::from_f64(0.0)];
        let ends = Rk4::new(0.01).integrate_in_lanes(&balls, 0.0, &start, 3.0);
        ends.into_iter().map(|end| end.unwrap_err().cause).collect()
    }
}

#[test]
fn lanes_refuse_too() {
    let ball = BouncingBall::default().prepare().unwrap();
    let causes = dispatch_on(Backend::Portable, Width::Four, Falling(ball));
    assert!(!causes.is_empty() && causes.iter().all(|cause| *cause == Cause::Contacts));
}
