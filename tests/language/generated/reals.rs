//! The generated code over other reals: `f32`, duals, duals over duals; and in a function that is generic.

use guen::prelude::*;

hoop!(guen::mechanical_system);
cart!(guen::mechanical_system);

const STATE: [f64; 9] = [1.2, 0.3, 0.1, 2.0, -1.0, 0.9, 0.1, 0.4, 5.0];

#[test]
fn single_precision_runs() {
    let double = Hoop::new(0.8, 0.5, 1.1).prepare().unwrap();
    let single = Hoop::<f32>::new(0.8, 0.5, 1.1).prepare().unwrap();
    let start = STATE.map(|x| x as f32);
    let mut end = start;
    let done = Rk4::new(0.001_f32).integrate(&single, 0.0, &start, 1.0, |_, x| {
        end = *x;
        ControlFlow::Continue(())
    });
    assert!(done.is_ok());
    let expected = Integration::new(&double, 0.0, &STATE).run(&Dop853::new(1e-12, 1e-12), 1.0).unwrap().state;
    for (x, y) in end.iter().zip(&expected) {
        assert!((f64::from(*x) - y).abs() < 2e-4 * (1.0 + y.abs()), "{x} and {y}");
    }
    assert_ne!(end, start);
}

/// A dual in a constant gives the derivative of a rate by it: `eta1' = .. - a g cos(theta)/(A + a^2)`.
#[test]
fn duals_through_constants() {
    type D = Dual<f64, 1>;
    let (a, across, along) = (0.8, 0.5, 1.1);
    let c = D::constant;
    let system = Hoop { a: c(a), A: c(across), C: c(along), g: D::variable(9.81, 0) }.prepare().unwrap();
    let rate = system.rhs(c(0.0), &STATE.map(c).into());
    let expected = -a * STATE[0].cos() / (across + a * a);
    assert!((rate.eta1.tangent[0] - expected).abs() < 1e-15);
    assert_eq!(rate.eta2.tangent[0], 0.0);
}

/// The same derivative by lifting a prepared system, one level deeper: mixed second derivatives of the energy.
#[test]
fn duals_over_duals() {
    type D = Dual<Dual<f64, 1>, 1>;
    let system = Hoop::new(0.8, 0.5, 1.1).prepare().unwrap();
    let lifted: hoop::Prepared<D> = system.lift();
    let mut state = STATE.map(|x| D::constant(Dual::constant(x)));
    state[6] = D { value: Dual::variable(STATE[6], 0), tangent: [Dual::constant(1.0)] };
    let h = lifted.energy(D::constant(Dual::constant(0.0)), &state.into());
    assert!((h.tangent[0].tangent[0] - (0.5 + 0.64)).abs() < 1e-15);
    assert!((h.value.value - system.energy(0.0, &STATE.into())).abs() < 1e-14);
}

/// Everything is generic: a function over any real takes the generated types.
#[test]
fn generic_functions() {
    fn total<R: Real>(cart: &cart::Prepared<R>, state: &cart::State<R>, push: R) -> R {
        let inputs = cart::Inputs { push, wind: R::zero() };
        cart.rhs(R::zero(), state, &inputs).v + cart.outputs(R::zero(), state, &inputs).height
    }
    let (x, phi, v, omega) = (0.0, 0.7, 0.1, 0.2);
    let double = total(&Cart::new(2.0, 0.6).prepare().unwrap(), &cart::State { x, phi, v, omega }, 1.0);
    let state = cart::State { x: 0.0_f32, phi: 0.7, v: 0.1, omega: 0.2 };
    let single = total(&Cart::<f32>::new(2.0, 0.6).prepare().unwrap(), &state, 1.0);
    assert!((double - f64::from(single)).abs() < 1e-5, "{double} and {single}");
}
