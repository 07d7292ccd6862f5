//! The code of a study's settings, written by `GUEN_BLESS=1 cargo test -p guen-doctests --test choices`.

#![allow(clippy::all, reason = "the settings are written as the report writes them")]
#![cfg_attr(rustfmt, rustfmt_skip)]

use std::error::Error;

use guen::System;

use crate::{Pendulum, pendulum};

type End<const N: usize> = Result<[f64; N], Box<dyn Error>>;
type Ends = Result<Vec<[f64; 2]>, Box<dyn Error>>;

pub fn rk4(system: &Pendulum, start: [f64; 2]) -> End<2> {
    use guen::{WithScalar, prelude::*};
    let system = system.with_scalar::<f64>()?;
    let method = Rk4::new(0.125);
    let end = Integration::new(&system, 0.0, &start).run(&method, 1.0)?.state;
    Ok(end)
}

pub fn rk8(system: &Pendulum, start: [f64; 2]) -> End<2> {
    use guen::{WithScalar, prelude::*};
    let system = system.with_scalar::<f64>()?;
    let method = Rk8::new(0.125);
    let end = Integration::new(&system, 0.0, &start).run(&method, 1.0)?.state;
    Ok(end)
}

pub fn tsit5(system: &Pendulum, start: [f64; 2]) -> End<2> {
    use guen::{WithScalar, prelude::*};
    let system = system.with_scalar::<f64>()?;
    let method = Tsit5::new(0.001, 0.001);
    let end = Integration::new(&system, 0.0, &start).run(&method, 1.0)?.state;
    Ok(end)
}

pub fn dop853(system: &Pendulum, start: [f64; 2]) -> End<2> {
    use guen::{WithScalar, prelude::*};
    let system = system.with_scalar::<f64>()?;
    let method = Dop853::new(0.01, 0.01);
    let end = Integration::new(&system, 0.0, &start).run(&method, 1.0)?.state;
    Ok(end)
}

pub fn euler(system: &Pendulum, start: [f64; 2]) -> End<2> {
    use guen::{WithScalar, prelude::*};
    let system = system.with_scalar::<f64>()?;
    let method = Euler::new(0.0013812154696132596);
    let end = Integration::new(&system, 0.0, &start).run(&method, 1.0)?.state;
    Ok(end)
}

pub fn bounded_dop853(system: &Pendulum, start: [f64; 2]) -> End<2> {
    use guen::{WithScalar, prelude::*};
    let system = system.with_scalar::<f64>()?;
    let end = Bounded::<f64>::dop853(24).advance(&system, 0.0, &start, 1.0)?.state;
    Ok(end)
}

pub fn bounded_tsit5(system: &Pendulum, start: [f64; 2]) -> End<2> {
    use guen::{WithScalar, prelude::*};
    let system = system.with_scalar::<f64>()?;
    let end = Bounded::<f64>::tsit5(24).advance(&system, 0.0, &start, 1.0)?.state;
    Ok(end)
}

pub fn rk4_in_approx13(system: &Pendulum, start: [f64; 2]) -> End<2> {
    use guen::{WithScalar, prelude::*};
    use guen::Approx13;
    type R = Approx13;
    let system = system.with_scalar::<R>()?;
    let method = Rk4::new(R::from_f64(0.125));
    let (t0, t1) = (R::from_f64(0.0), R::from_f64(1.0));
    let start = start.map(R::from_f64);
    let end = Integration::new(&system, t0, &start).run(&method, t1)?.state.map(R::to_f64);
    Ok(end)
}

pub fn rk8_in_approx13(system: &Pendulum, start: [f64; 2]) -> End<2> {
    use guen::{WithScalar, prelude::*};
    use guen::Approx13;
    type R = Approx13;
    let system = system.with_scalar::<R>()?;
    let method = Rk8::new(R::from_f64(0.125));
    let (t0, t1) = (R::from_f64(0.0), R::from_f64(1.0));
    let start = start.map(R::from_f64);
    let end = Integration::new(&system, t0, &start).run(&method, t1)?.state.map(R::to_f64);
    Ok(end)
}

pub fn tsit5_in_approx13(system: &Pendulum, start: [f64; 2]) -> End<2> {
    use guen::{WithScalar, prelude::*};
    use guen::Approx13;
    type R = Approx13;
    let system = system.with_scalar::<R>()?;
    let method = Tsit5::new(0.001, 0.001);
    let (t0, t1) = (R::from_f64(0.0), R::from_f64(1.0));
    let start = start.map(R::from_f64);
    let end = Integration::new(&system, t0, &start).run(&method, t1)?.state.map(R::to_f64);
    Ok(end)
}

pub fn dop853_in_approx13(system: &Pendulum, start: [f64; 2]) -> End<2> {
    use guen::{WithScalar, prelude::*};
    use guen::Approx13;
    type R = Approx13;
    let system = system.with_scalar::<R>()?;
    let method = Dop853::new(0.01, 0.01);
    let (t0, t1) = (R::from_f64(0.0), R::from_f64(1.0));
    let start = start.map(R::from_f64);
    let end = Integration::new(&system, t0, &start).run(&method, t1)?.state.map(R::to_f64);
    Ok(end)
}

pub fn rk4_in_approx7(system: &Pendulum, start: [f64; 2]) -> End<2> {
    use guen::{WithScalar, prelude::*};
    use guen::Approx7;
    type R = Approx7;
    let system = system.with_scalar::<R>()?;
    let method = Rk4::new(R::from_f64(0.125));
    let (t0, t1) = (R::from_f64(0.0), R::from_f64(1.0));
    let start = start.map(R::from_f64);
    let end = Integration::new(&system, t0, &start).run(&method, t1)?.state.map(R::to_f64);
    Ok(end)
}

pub fn rk8_in_approx7(system: &Pendulum, start: [f64; 2]) -> End<2> {
    use guen::{WithScalar, prelude::*};
    use guen::Approx7;
    type R = Approx7;
    let system = system.with_scalar::<R>()?;
    let method = Rk8::new(R::from_f64(0.125));
    let (t0, t1) = (R::from_f64(0.0), R::from_f64(1.0));
    let start = start.map(R::from_f64);
    let end = Integration::new(&system, t0, &start).run(&method, t1)?.state.map(R::to_f64);
    Ok(end)
}

pub fn tsit5_in_approx7(system: &Pendulum, start: [f64; 2]) -> End<2> {
    use guen::{WithScalar, prelude::*};
    use guen::Approx7;
    type R = Approx7;
    let system = system.with_scalar::<R>()?;
    let method = Tsit5::new(0.001, 0.001);
    let (t0, t1) = (R::from_f64(0.0), R::from_f64(1.0));
    let start = start.map(R::from_f64);
    let end = Integration::new(&system, t0, &start).run(&method, t1)?.state.map(R::to_f64);
    Ok(end)
}

pub fn dop853_in_approx7(system: &Pendulum, start: [f64; 2]) -> End<2> {
    use guen::{WithScalar, prelude::*};
    use guen::Approx7;
    type R = Approx7;
    let system = system.with_scalar::<R>()?;
    let method = Dop853::new(0.01, 0.01);
    let (t0, t1) = (R::from_f64(0.0), R::from_f64(1.0));
    let start = start.map(R::from_f64);
    let end = Integration::new(&system, t0, &start).run(&method, t1)?.state.map(R::to_f64);
    Ok(end)
}

pub fn rk4_in_fused(system: &Pendulum, start: [f64; 2]) -> End<2> {
    use guen::{WithScalar, prelude::*};
    use guen::Fused;
    type R = Fused;
    let system = system.with_scalar::<R>()?;
    let method = Rk4::new(R::from_f64(0.125));
    let (t0, t1) = (R::from_f64(0.0), R::from_f64(1.0));
    let start = start.map(R::from_f64);
    let end = Integration::new(&system, t0, &start).run(&method, t1)?.state.map(R::to_f64);
    Ok(end)
}

pub fn rk8_in_fused(system: &Pendulum, start: [f64; 2]) -> End<2> {
    use guen::{WithScalar, prelude::*};
    use guen::Fused;
    type R = Fused;
    let system = system.with_scalar::<R>()?;
    let method = Rk8::new(R::from_f64(0.125));
    let (t0, t1) = (R::from_f64(0.0), R::from_f64(1.0));
    let start = start.map(R::from_f64);
    let end = Integration::new(&system, t0, &start).run(&method, t1)?.state.map(R::to_f64);
    Ok(end)
}

pub fn tsit5_in_fused(system: &Pendulum, start: [f64; 2]) -> End<2> {
    use guen::{WithScalar, prelude::*};
    use guen::Fused;
    type R = Fused;
    let system = system.with_scalar::<R>()?;
    let method = Tsit5::new(0.001, 0.001);
    let (t0, t1) = (R::from_f64(0.0), R::from_f64(1.0));
    let start = start.map(R::from_f64);
    let end = Integration::new(&system, t0, &start).run(&method, t1)?.state.map(R::to_f64);
    Ok(end)
}

pub fn dop853_in_fused(system: &Pendulum, start: [f64; 2]) -> End<2> {
    use guen::{WithScalar, prelude::*};
    use guen::Fused;
    type R = Fused;
    let system = system.with_scalar::<R>()?;
    let method = Dop853::new(0.01, 0.01);
    let (t0, t1) = (R::from_f64(0.0), R::from_f64(1.0));
    let start = start.map(R::from_f64);
    let end = Integration::new(&system, t0, &start).run(&method, t1)?.state.map(R::to_f64);
    Ok(end)
}

pub fn rk4_in_std(system: &Pendulum, start: [f64; 2]) -> End<2> {
    use guen::{WithScalar, prelude::*};
    use guen::Std;
    type R = Std;
    let system = system.with_scalar::<R>()?;
    let method = Rk4::new(R::from_f64(0.125));
    let (t0, t1) = (R::from_f64(0.0), R::from_f64(1.0));
    let start = start.map(R::from_f64);
    let end = Integration::new(&system, t0, &start).run(&method, t1)?.state.map(R::to_f64);
    Ok(end)
}

pub fn rk8_in_std(system: &Pendulum, start: [f64; 2]) -> End<2> {
    use guen::{WithScalar, prelude::*};
    use guen::Std;
    type R = Std;
    let system = system.with_scalar::<R>()?;
    let method = Rk8::new(R::from_f64(0.125));
    let (t0, t1) = (R::from_f64(0.0), R::from_f64(1.0));
    let start = start.map(R::from_f64);
    let end = Integration::new(&system, t0, &start).run(&method, t1)?.state.map(R::to_f64);
    Ok(end)
}

pub fn tsit5_in_std(system: &Pendulum, start: [f64; 2]) -> End<2> {
    use guen::{WithScalar, prelude::*};
    use guen::Std;
    type R = Std;
    let system = system.with_scalar::<R>()?;
    let method = Tsit5::new(0.001, 0.001);
    let (t0, t1) = (R::from_f64(0.0), R::from_f64(1.0));
    let start = start.map(R::from_f64);
    let end = Integration::new(&system, t0, &start).run(&method, t1)?.state.map(R::to_f64);
    Ok(end)
}

pub fn dop853_in_std(system: &Pendulum, start: [f64; 2]) -> End<2> {
    use guen::{WithScalar, prelude::*};
    use guen::Std;
    type R = Std;
    let system = system.with_scalar::<R>()?;
    let method = Dop853::new(0.01, 0.01);
    let (t0, t1) = (R::from_f64(0.0), R::from_f64(1.0));
    let start = start.map(R::from_f64);
    let end = Integration::new(&system, t0, &start).run(&method, t1)?.state.map(R::to_f64);
    Ok(end)
}

pub fn rk4_in_f32(system: &Pendulum, start: [f64; 2]) -> End<2> {
    use guen::{WithScalar, prelude::*};
    type R = f32;
    let system = system.with_scalar::<R>()?;
    let method = Rk4::new(R::from_f64(0.125));
    let (t0, t1) = (R::from_f64(0.0), R::from_f64(1.0));
    let start = start.map(R::from_f64);
    let end = Integration::new(&system, t0, &start).run(&method, t1)?.state.map(R::to_f64);
    Ok(end)
}

pub fn rk8_in_f32(system: &Pendulum, start: [f64; 2]) -> End<2> {
    use guen::{WithScalar, prelude::*};
    type R = f32;
    let system = system.with_scalar::<R>()?;
    let method = Rk8::new(R::from_f64(0.125));
    let (t0, t1) = (R::from_f64(0.0), R::from_f64(1.0));
    let start = start.map(R::from_f64);
    let end = Integration::new(&system, t0, &start).run(&method, t1)?.state.map(R::to_f64);
    Ok(end)
}

pub fn tsit5_in_f32(system: &Pendulum, start: [f64; 2]) -> End<2> {
    use guen::{WithScalar, prelude::*};
    type R = f32;
    let system = system.with_scalar::<R>()?;
    let method = Tsit5::new(0.001, 0.001);
    let (t0, t1) = (R::from_f64(0.0), R::from_f64(1.0));
    let start = start.map(R::from_f64);
    let end = Integration::new(&system, t0, &start).run(&method, t1)?.state.map(R::to_f64);
    Ok(end)
}

pub fn dop853_in_f32(system: &Pendulum, start: [f64; 2]) -> End<2> {
    use guen::{WithScalar, prelude::*};
    type R = f32;
    let system = system.with_scalar::<R>()?;
    let method = Dop853::new(0.01, 0.01);
    let (t0, t1) = (R::from_f64(0.0), R::from_f64(1.0));
    let start = start.map(R::from_f64);
    let end = Integration::new(&system, t0, &start).run(&method, t1)?.state.map(R::to_f64);
    Ok(end)
}

pub fn gauss_4(system: &Pendulum, start: [f64; 2]) -> End<2> {
    use guen::{WithScalar, prelude::*};
    let system = system.with_scalar::<f64>()?;
    let method = Gauss4::new(0.125);
    let end = Integration::new(&system, 0.0, &start).run(&method, 1.0)?.state;
    Ok(end)
}

pub fn gauss_6(system: &Pendulum, start: [f64; 2]) -> End<2> {
    use guen::{WithScalar, prelude::*};
    let system = system.with_scalar::<f64>()?;
    let method = Gauss6::new(0.125);
    let end = Integration::new(&system, 0.0, &start).run(&method, 1.0)?.state;
    Ok(end)
}

pub fn radau_5(system: &Pendulum, start: [f64; 2]) -> End<2> {
    use guen::{WithScalar, prelude::*};
    let system = system.with_scalar::<f64>()?;
    let method = Radau5::new(0.01, 0.01);
    let end = Integration::new(&system, 0.0, &start).run(&method, 1.0)?.state;
    Ok(end)
}

pub fn taylor(system: &Pendulum, start: [f64; 2]) -> End<2> {
    use guen::{WithScalar, prelude::*};
    let system = system.with_scalar::<f64>()?;
    let method = Taylor::new(0.01, 0.01);
    let end = Integration::new(&system, 0.0, &start).run(&method, 1.0)?.state;
    Ok(end)
}

pub fn rk4_in_f64_lanes(system: &Pendulum, starts: Vec<[f64; 2]>) -> Ends {
    use guen::{WithScalar, prelude::*, study::Ensemble};
    let system = system.with_scalar::<f64>()?;
    let ensemble = Ensemble::of_states(system, starts);
    let ends = ensemble.integrate(&Rk4::new(0.125), 0.0, 1.0);
    ends.into_iter().map(|end| Ok(end?.state)).collect()
}

pub fn rk8_in_f64_lanes(system: &Pendulum, starts: Vec<[f64; 2]>) -> Ends {
    use guen::{WithScalar, prelude::*, study::Ensemble};
    let system = system.with_scalar::<f64>()?;
    let ensemble = Ensemble::of_states(system, starts);
    let ends = ensemble.integrate(&Rk8::new(0.125), 0.0, 1.0);
    ends.into_iter().map(|end| Ok(end?.state)).collect()
}

pub fn rk4_in_approx7_lanes(system: &Pendulum, starts: Vec<[f64; 2]>) -> Ends {
    use guen::{WithScalar, prelude::*, study::Ensemble};
    let system = system.with_scalar::<f64>()?;
    let ensemble = Ensemble::of_states(system, starts).with_scalar::<guen::Approx7Functions>();
    let ends = ensemble.integrate(&Rk4::new(0.125), 0.0, 1.0);
    ends.into_iter().map(|end| Ok(end?.state)).collect()
}

pub fn rk8_in_approx7_lanes(system: &Pendulum, starts: Vec<[f64; 2]>) -> Ends {
    use guen::{WithScalar, prelude::*, study::Ensemble};
    let system = system.with_scalar::<f64>()?;
    let ensemble = Ensemble::of_states(system, starts).with_scalar::<guen::Approx7Functions>();
    let ends = ensemble.integrate(&Rk8::new(0.125), 0.0, 1.0);
    ends.into_iter().map(|end| Ok(end?.state)).collect()
}

pub fn rk4_carried<S: System<f64, N>, const N: usize>(system: &S, start: [f64; N]) -> End<N> {
    // `system` and `start` are those of the form `carried`
    use guen::prelude::*;
    let method = Rk4::new(0.125);
    let end = Integration::new(&system, 0.0, &start).run(&method, 1.0)?.state;
    Ok(end)
}

pub fn rk8_carried<S: System<f64, N>, const N: usize>(system: &S, start: [f64; N]) -> End<N> {
    // `system` and `start` are those of the form `carried`
    use guen::prelude::*;
    let method = Rk8::new(0.125);
    let end = Integration::new(&system, 0.0, &start).run(&method, 1.0)?.state;
    Ok(end)
}

pub fn tsit5_carried<S: System<f64, N>, const N: usize>(system: &S, start: [f64; N]) -> End<N> {
    // `system` and `start` are those of the form `carried`
    use guen::prelude::*;
    let method = Tsit5::new(0.001, 0.001);
    let end = Integration::new(&system, 0.0, &start).run(&method, 1.0)?.state;
    Ok(end)
}

pub fn dop853_carried<S: System<f64, N>, const N: usize>(system: &S, start: [f64; N]) -> End<N> {
    // `system` and `start` are those of the form `carried`
    use guen::prelude::*;
    let method = Dop853::new(0.01, 0.01);
    let end = Integration::new(&system, 0.0, &start).run(&method, 1.0)?.state;
    Ok(end)
}

pub fn closures_dop853<S: System<f64, N>, const N: usize>(system: &S, start: [f64; N]) -> End<N> {
    use guen::prelude::*;
    let method = Dop853::new(0.01, 0.01);
    let end = Integration::new(&system, 0.0, &start).run(&method, 0.25)?.state;
    Ok(end)
}

pub fn closures_euler<S: System<f64, N>, const N: usize>(system: &S, start: [f64; N]) -> End<N> {
    use guen::prelude::*;
    let method = Euler::new(0.0078125);
    let end = Integration::new(&system, 0.0, &start).run(&method, 0.25)?.state;
    Ok(end)
}

pub fn closures_bounded_tsit5<S: System<f64, N>, const N: usize>(system: &S, start: [f64; N]) -> End<N> {
    use guen::prelude::*;
    let end = Bounded::<f64>::tsit5(24).advance(&system, 0.0, &start, 0.25)?.state;
    Ok(end)
}

pub const DECLARED: &[(&str, fn(&Pendulum, [f64; 2]) -> End<2>)] = &[
    ("rk4", rk4),
    ("rk8", rk8),
    ("tsit5", tsit5),
    ("dop853", dop853),
    ("euler", euler),
    ("bounded_dop853", bounded_dop853),
    ("bounded_tsit5", bounded_tsit5),
    ("rk4_in_approx13", rk4_in_approx13),
    ("rk8_in_approx13", rk8_in_approx13),
    ("tsit5_in_approx13", tsit5_in_approx13),
    ("dop853_in_approx13", dop853_in_approx13),
    ("rk4_in_approx7", rk4_in_approx7),
    ("rk8_in_approx7", rk8_in_approx7),
    ("tsit5_in_approx7", tsit5_in_approx7),
    ("dop853_in_approx7", dop853_in_approx7),
    ("rk4_in_fused", rk4_in_fused),
    ("rk8_in_fused", rk8_in_fused),
    ("tsit5_in_fused", tsit5_in_fused),
    ("dop853_in_fused", dop853_in_fused),
    ("rk4_in_std", rk4_in_std),
    ("rk8_in_std", rk8_in_std),
    ("tsit5_in_std", tsit5_in_std),
    ("dop853_in_std", dop853_in_std),
    ("rk4_in_f32", rk4_in_f32),
    ("rk8_in_f32", rk8_in_f32),
    ("tsit5_in_f32", tsit5_in_f32),
    ("dop853_in_f32", dop853_in_f32),
    ("gauss_4", gauss_4),
    ("gauss_6", gauss_6),
    ("radau_5", radau_5),
    ("taylor", taylor),
];

pub const GIVEN: &[(&str, fn(&pendulum::Carried<f64>, [f64; 4]) -> End<4>)] = &[
    ("rk4_carried", rk4_carried),
    ("rk8_carried", rk8_carried),
    ("tsit5_carried", tsit5_carried),
    ("dop853_carried", dop853_carried),
    ("closures_dop853", closures_dop853),
    ("closures_euler", closures_euler),
    ("closures_bounded_tsit5", closures_bounded_tsit5),
];

pub const LANES: &[(&str, fn(&Pendulum, Vec<[f64; 2]>) -> Ends)] = &[
    ("rk4_in_f64_lanes", rk4_in_f64_lanes),
    ("rk8_in_f64_lanes", rk8_in_f64_lanes),
    ("rk4_in_approx7_lanes", rk4_in_approx7_lanes),
    ("rk8_in_approx7_lanes", rk8_in_approx7_lanes),
];
