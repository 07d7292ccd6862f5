//! A system whose rates call every elementary function, with an input and explicit time; a scene that fixes a constant; and
//! one with a constraint on positions.

use guen::prelude::*;
use guen::{Guarded, RunningError};

guen::mechanical_system! {
    /// A bead in a valley, with drag, a motor and everything else.
    pub system Bead {
        constants   { m > 0, k > 0, nu, l > 0 }
        inputs      { push }
        coordinates { x, y }
        parameters  { u = dot(x); v = dot(y); }
        kinetic_energy   = m/2*(u^2 + v^2);
        potential_energy = k*sqrt(l^2 + x^2) + exp(-y/4) + ln(cosh(x)) + cos(x - 2*y);
        forces {
            push - tanh(v)*exp(-u^2) - ln(2 + u^2) along u;
            sin(nu*t)*atan(x) + asin(sin(y)/2) + atan2(1 + y^2, 2 + x^2) along v;
        }
        provide carried;
        scene Soft { fix k = 1, nu = 2; provide carried; }
    }
}

guen::mechanical_system! {
    /// A rod between two walls in redundant coordinates.
    pub system Ladder {
        constants   { m > 0, l > 0, g = 9.81 }
        coordinates { phi, x, y }
        parameters  { omega = dot(phi); }
        holonomic   { right: x = l*cos(phi); up: y = l*sin(phi); }
        kinetic_energy   = m/2*(dot(x)^2 + dot(y)^2) + m/6*l^2*omega^2;
        potential_energy = m*g*y;
        provide carried;
    }
}

fn go_on<const N: usize>(_: f64, _: &[f64; N]) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

const START: bead::State = bead::State { x: 0.4, y: -0.3, u: 0.2, v: 0.7 };

#[test]
fn every_function_is_carried() {
    assert_eq!((bead::carried::COST.calls, bead::carried::COST.roots), (0, 0));
    const { assert!(bead::COST.calls >= 10 && bead::COST.roots >= 1) }
    let prepared = Bead::new(1.2, 2.0, 1.7, 0.5).prepare().unwrap();
    let carried = prepared.carried().unwrap();
    let inputs = bead::Inputs { push: 0.3 };
    let (full, own) = (prepared.driven(inputs), carried.driven(inputs));
    let method = Dop853::new(1e-12, 1e-12);
    let end = method.integrate(&full, 0.5, &START.into(), 4.5, go_on).unwrap().state;
    let done = method.integrate(&own, 0.5, &START.carried(&carried, 0.5).into(), 4.5, go_on).unwrap();
    for (x, y) in end.iter().zip(&done.state) {
        assert!((x - y).abs() < 1e-9, "{x} and {y}");
    }
    assert!(carried.drift(4.5, &done.state.into()) < 1e-9);
    // Roots, the argument of the logarithm and the radius of the angle must not vanish; the input is the system's own.
    assert_eq!(bead::carried::SINGULARITIES.len(), 4, "{:?}", bead::carried::SINGULARITIES);
    let mut values = [RunningError::once(0.0); 8];
    let written =
        own.singularities(RunningError::once(4.5), &done.state.map(RunningError::once), &mut values);
    assert!(written >= 4 && values[..written].iter().all(|value| value.value > 0.0));
    // In the scene the names are the same, and the constants are gone.
    let soft = bead::Soft::new(1.2, 0.5).prepare().unwrap().carried().unwrap();
    assert_eq!(bead::soft::carried::COST.calls, 0);
    assert_eq!(soft.system().constants().l, 0.5);
}

#[test]
#[allow(clippy::needless_range_loop, reason = "rows and columns of a matrix")]
fn implicit_methods_have_its_derivatives() {
    let prepared = Bead::new(1.2, 2.0, 1.7, 0.5).prepare().unwrap();
    let carried = prepared.carried().unwrap();
    let own = carried.driven(bead::Inputs { push: 0.3 });
    let state: [f64; bead::carried::State::NAMES.len()] = START.carried(&carried, 0.5).into();
    let jacobian = guen::Differentiable::jacobian(&own, 0.5, &state);
    let h = 1e-6;
    for j in 0..state.len() {
        let moved = |h: f64| own.rhs(0.5, &std::array::from_fn(|i| state[i] + if i == j { h } else { 0.0 }));
        let (ahead, behind) = (moved(h), moved(-h));
        for i in 0..state.len() {
            let slope = (ahead[i] - behind[i]) / (2.0 * h);
            assert!((jacobian[i][j] - slope).abs() < 1e-8, "{i}, {j}");
        }
    }
}

#[test]
fn constraints_on_positions_and_energies_are_still_watched() {
    let prepared = Ladder::new(2.0, 1.5).prepare().unwrap();
    let carried = prepared.carried().unwrap();
    let phi = 1.2_f64;
    let start = ladder::State { phi, x: 1.5 * phi.cos(), y: 1.5 * phi.sin(), omega: 0.0 };
    let lifted = start.carried(&carried, 0.0);
    let off = ladder::carried::State { x: lifted.x + 0.125, ..lifted };
    let invariants = carried.conserved(0.0, &off.into());
    assert_eq!((invariants.energy.is_some(), invariants.carried), (true, 0.0));
    // Relative to the size of its terms and their uncertainty, which is some units.
    assert!((0.125 / 8.0..0.125).contains(&invariants.residual), "{}", invariants.residual);
    assert!(carried.conserved(0.0, &lifted.into()).residual < 1e-15);
    assert_eq!(carried.energy(0.0, &lifted.into()), prepared.energy(0.0, &start));
    let end = Dop853::new(1e-11, 1e-11).integrate(&carried, 0.0, &lifted.into(), 1.0, go_on).unwrap().state;
    let full = Dop853::new(1e-11, 1e-11).integrate(&prepared, 0.0, &start.into(), 1.0, go_on).unwrap().state;
    assert!(end.iter().zip(&full).all(|(x, y)| (x - y).abs() < 1e-9));
}

/// Pulls back, by the carried functions too.
#[derive(Clone, Copy)]
struct Back;

impl InputLaw<bead::carried::Prepared> for Back {
    fn at<R: Real>(&self, t: R, s: &bead::carried::State<R>) -> bead::Inputs<R> {
        bead::Inputs { push: R::from_f64(-0.5) * s.u + (t - s.x).sin() }
    }
}

impl InputLaw<bead::Prepared> for Back {
    fn at<R: Real>(&self, t: R, s: &bead::State<R>) -> bead::Inputs<R> {
        bead::Inputs { push: R::from_f64(-0.5) * s.u + (t - s.x).sin() }
    }
}

#[test]
fn inputs_are_those_of_the_system() {
    let prepared = Bead::new(1.2, 2.0, 1.7, 0.5).prepare().unwrap();
    let carried = prepared.carried().unwrap();
    let start = START.carried(&carried, 0.0);
    let exact = prepared.simulation(&START).law(Back).tolerance(1e-12).run(0.0..3.0).unwrap();
    let closure = |t: f64, s: &bead::carried::State| InputLaw::<bead::carried::Prepared>::at(&Back, t, s);
    let near = |name: &str, end: bead::carried::State| {
        let off = f64::max((end.x - exact.end().x).abs(), (end.v - exact.end().v).abs());
        assert!(off < 1e-7, "{name}: {off:e}");
    };
    near("closure", carried.simulation(&start).inputs(closure).run(0.0..3.0).unwrap().end());
    let radau = Radau5::new(1e-10, 1e-10);
    near("law", carried.simulation(&start).law(Back).method(radau).run(0.0..3.0).unwrap().end());
    let renormalized = guen::renormalized(carried.with_law(Back));
    let rk8 = Rk8::new(0.01).integrate(&renormalized, 0.0, &start.into(), 3.0, go_on).unwrap();
    near("renormalized", rk8.state.into());
    let held = |t: f64, s: &bead::carried::State| bead::Inputs { push: (t - s.x).sin() };
    let by_system = |t: f64, s: &bead::State| bead::Inputs { push: (t - s.x).sin() };
    let motion = carried.simulation(&start).hold(0.25, held).tolerance(1e-11).run(0.0..3.0).unwrap();
    let same = prepared.simulation(&START).hold(0.25, by_system).tolerance(1e-11).run(0.0..3.0).unwrap();
    assert!((motion.end().x - same.end().x).abs() < 1e-8);
    // The derivatives are those of an own system, and those of its driven form.
    let (state, inputs) = (start.into(), bead::Inputs { push: 0.3 });
    let found = guen::Linearizable::linearization(&carried, 0.5, &state, &[0.3]);
    assert_eq!(found.a, guen::Differentiable::jacobian(&carried.driven(inputs), 0.5, &state));
    let (u, by_push) = (START.u, 1.0 / 1.2);
    assert_eq!(bead::carried::State::NAMES[2], "u");
    assert!((found.b[2][0] - by_push).abs() < 1e-15 && u == start.u);
}
