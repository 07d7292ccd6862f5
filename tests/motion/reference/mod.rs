//! The reference trajectories: rates, reactions and energy at the initial state, then the motion itself to the
//! accuracy that double precision allows.

mod accuracy;
mod case;
mod systems;

use accuracy::{Subject, bounds, method};
use case::Case;
use guen::prelude::*;
use guen::steppers::Method;
use guen::{Differentiable, Dual};

/// The largest distance between two vectors, in units of the largest entry of the second.
fn relative(found: &[f64], expected: &[f64]) -> f64 {
    assert_eq!(found.len(), expected.len());
    let largest = expected.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    let distance = found.iter().zip(expected).fold(0.0_f64, |most, (x, y)| most.max((x - y).abs()));
    if distance == 0.0 { 0.0 } else { distance / largest }
}

/// Integrates a case; energies by `energy`, with the derivatives by state and constants.
fn follow<S, D, const N: usize, const M: usize>(
    case: &Case,
    subject: &Subject<S, D, M>,
    start: [f64; N],
    energy: impl Fn(Dual<f64, M>, &[Dual<f64, M>; N]) -> Dual<f64, M>,
    conserved: bool,
) where
    S: System<f64, N> + Differentiable<f64, N>,
    D: System<Dual<f64, M>, N>,
{
    let bounds: Vec<[f64; N]> = bounds(subject, &case.times, &case.states);
    let (mut worst, mut worst_energy, mut drift) = ((0.0, 0.0, 0), 0.0_f64, 0.0_f64);
    let visit = |k: usize, t: f64, x: &[f64; N]| {
        for i in 0..N {
            let error = (x[i] - case.states[k][i]).abs();
            if error > worst.0 * bounds[k][i] {
                worst = (error / bounds[k][i], t, i);
            }
        }
        let seeds = std::array::from_fn(|i| Dual::variable(x[i], i));
        let h = energy(Dual::constant(t), &seeds);
        // To first order in the errors of the state, and the rounding of its own arguments.
        let arguments = x.iter().chain(&subject.constants).zip(&h.tangent);
        let rounding: f64 = arguments.map(|(x, d)| 2.0 * f64::EPSILON * (x * d).abs()).sum();
        let carried: f64 = bounds[k].iter().zip(&h.tangent).map(|(b, d)| (b * d).abs()).sum();
        let bound = rounding + carried + f64::EPSILON * h.value.abs();
        worst_energy = worst_energy.max((h.value - case.energy[k]).abs() / bound);
        if conserved {
            drift = drift.max((h.value - case.energy[0]).abs() / bound);
        }
    };
    let done = method().sample(&subject.system, 0.0, &start, &case.times, visit).unwrap();
    println!(
        "{:24} worst error {:6.3} of the bound {:.1e} (entry {} at t = {}); energy {:6.3}, drift {:6.3}; {} steps",
        case.label,
        worst.0,
        bounds[case.times.iter().position(|t| *t == worst.1).unwrap()][worst.2],
        worst.2,
        worst.1,
        worst_energy,
        drift,
        done.statistics.accepted,
    );
    assert!(worst.0 <= 1.0, "{}: entry {} at t = {}", case.label, worst.2, worst.1);
    assert!(worst_energy <= 1.0 && drift <= 1.0, "{}: energy", case.label);

    // The other methods, on their dense output, to a tolerance: the bounds above are for steps that err by a rounding.
    differentiated(case, &subject.system, &start);
    let tolerance = 1e-9;
    // Two hundred seconds show them no more than twenty, and debug builds are slow.
    let mut case = case.clone();
    case.times.retain(|t| *t <= 20.0);
    let allowed = 10.0 * tolerance / accuracy::RTOL;
    sampled(&case, &subject.system, &start, &bounds, allowed, &Dop853::new(tolerance, tolerance));
    sampled(&case, &subject.system, &start, &bounds, allowed, &Tsit5::new(tolerance, tolerance));
    sampled(&case, &subject.system, &start, &bounds, allowed, &Rk8::new(0.005));
    // Shorter, because debug builds solve linear systems slowly.
    let mut early = case;
    early.times.retain(|t| *t <= 2.0);
    sampled(&early, &subject.system, &start, &bounds, allowed, &Gauss6::new(0.005));
    sampled(&early, &subject.system, &start, &bounds, allowed, &Radau5::new(tolerance, tolerance));
}

/// Samples on the dense output, against the reference.
fn sampled<S, M, const N: usize>(
    case: &Case,
    system: &S,
    start: &[f64; N],
    bounds: &[[f64; N]],
    allowed: f64,
    method: &M,
) where
    S: System<f64, N>,
    M: Method<f64, S, N>,
{
    let mut worst = 0.0_f64;
    let result = Integration::new(system, 0.0, start)
        .sample(&case.times, &mut |k, _, x| {
            for i in 0..N {
                worst = worst.max((x[i] - case.states[k][i]).abs() / bounds[k][i]);
            }
        })
        .run(method, *case.times.last().unwrap());
    let name = std::any::type_name::<M>().rsplit("::").next().unwrap();
    if let Err(error) = result {
        // A fixed step may be too long for a case, and then says so; an adaptive one has no excuse.
        let too_long = matches!(
            error.cause,
            Cause::Energy { .. } | Cause::Step { .. } | Cause::ApproachingSingularity { .. }
        );
        assert!(too_long && error.statistics.rejected == 0, "{error}");
        assert!(worst <= allowed, "{}: {name}, until it was stopped", case.label);
        assert!(["Rk8", "Gauss6"].contains(&name), "{name}: {error}");
        println!("{:24} {name}: {error}", case.label);
        return;
    }
    println!("{:24} {name}: {worst:.1e} of the bound, {allowed:.1e} allowed", case.label);
    assert!(worst <= allowed, "{}: {name}", case.label);
}

/// The derivatives that implicit methods take, against differences of the rates.
fn differentiated<S, const N: usize>(case: &Case, system: &S, start: &[f64; N])
where
    S: Differentiable<f64, N>,
{
    let (jacobian, rates) = (system.jacobian(0.0, start), system.rhs(0.0, start));
    let difference = |along: &[f64; N], dt: f64| -> [f64; N] {
        // The error of a central difference of this step: about the square of it, and its reciprocal in roundings.
        let h = 1e-5;
        let at = |s: f64| system.rhs(s * dt, &std::array::from_fn(|i| start[i] + s * along[i]));
        let (ahead, behind) = (at(h), at(-h));
        std::array::from_fn(|i| (ahead[i] - behind[i]) / (2.0 * h))
    };
    for j in 0..N {
        let unit = std::array::from_fn(|i| f64::from(u8::from(i == j)));
        let column = jacobian.map(|row| row[j]);
        let expected = difference(&unit, 0.0);
        let size = expected.iter().fold(1.0_f64, |most, x| most.max(x.abs()));
        let off = column.iter().zip(expected).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
        assert!(off <= 1e-5 * size, "{}: column {j} of the Jacobian: {off:e}", case.label);
    }
    let (along, expected) = (system.along(0.0, start, 1.0, &rates), difference(&rates, 1.0));
    let size = expected.iter().fold(1.0_f64, |most, x| most.max(x.abs()));
    let off = along.iter().zip(expected).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
    assert!(off <= 1e-5 * size, "{}: second derivatives: {off:e}", case.label);
}

/// A test of a system against its file: constants, coordinates, quasi-velocities, then how reactions are read.
macro_rules! reference {
    (
        $test:ident: $file:literal, $System:ident in $module:ident,
        constants { $($constant:ident),* }, coordinates { $($x:ident),* }, parameters { $($eta:ident),* },
        size $N:literal + $C:literal, conserved $conserved:literal,
        reactions |$system:ident, $state:ident| $reactions:expr
    ) => {
        #[test]
        fn $test() {
            use systems::{$System, $module as module};
            type Varied = Dual<f64, { $N + $C }>;
            for case in case::read(include_str!(concat!("../../data/", $file))) {
                let system = $System { $($constant: case.constant(stringify!($constant))),* }.prepare().unwrap();
                let mut direction = $N..;
                let varied = $System::<Varied> {
                    $($constant: Dual::variable(case.constant(stringify!($constant)), direction.next().unwrap())),*
                }.prepare().unwrap();
                assert_eq!(direction.next(), Some($N + $C));
                let start = module::State {
                    $($x: case.initial(stringify!($x)),)* $($eta: case.initial(stringify!($eta))),*
                };

                let rate: [f64; $N] = system.rhs(0.0, &start).into();
                let expected: Vec<f64> = case.qdot.iter().chain(&case.eta_dot).copied().collect();
                let deviation = relative(&rate, &expected);
                assert!(deviation <= 1e-13, "{}: rates {deviation:e}", case.label);

                let velocities: [f64; $N - 0 $(- { let _ = stringify!($eta); 1 })*] =
                    std::array::from_fn(|i| case.qdot[i]);
                let coordinates = module::Coordinates { $($x: start.$x),* };
                let (found, residuals) =
                    module::State::from_velocities(&system, 0.0, &coordinates, &velocities.into());
                let (found, direct): ([f64; $N], [f64; $N]) = (found.into(), start.into());
                let largest = direct.iter().chain(&velocities).fold(0.0_f64, |m, x| m.max(x.abs()));
                assert!(relative(&found, &direct) <= 1e-14 * (1.0 + largest), "{}: velocities", case.label);
                assert!(residuals.iter().all(|r| r.abs() <= 1e-14 * (1.0 + largest)), "{residuals:?}");

                let ($system, $state) = (&system, &start);
                let reactions: Vec<f64> = $reactions;
                let deviation = relative(&reactions, &case.lambda);
                assert!(deviation <= 1e-12, "{}: reactions {deviation:e}", case.label);

                let energy = |t: Varied, state: &[Varied; $N]| {
                    let state = (*state).into();
                    varied.kinetic_energy(t, &state) - varied.force_function(t, &state)
                };
                let h = system.kinetic_energy(0.0, &start) - system.force_function(0.0, &start);
                assert!((h - case.energy[0]).abs() <= 1e-14 * case.energy[0].abs(), "{}: energy", case.label);
                let constants = vec![$(case.constant(stringify!($constant))),*];
                let subject = Subject { system, varied, constants };
                follow(&case, &subject, direct, energy, $conserved);
            }
        }
    };
}

reference! {
    hoop: "01_hoop_rolling.json", Hoop in hoop,
    constants { A, C, a, m, g }, coordinates { th, psi, phi, xi, eta, zeta }, parameters { eta1, eta2, eta3 },
    size 9 + 5, conserved true,
    reactions |system, state| <[f64; 3]>::from(system.reactions(0.0, state)).to_vec()
}

reference! {
    appell: "02_appell_holonomic.json", Appell in appell,
    constants { A, C, a, m, g }, coordinates { th, psi, phi, xi, eta, zeta }, parameters { eta1, eta2, eta3 },
    size 9 + 5, conserved true,
    reactions |system, state| <[f64; 3]>::from(system.reactions(0.0, state)).to_vec()
}

reference! {
    sled: "03_sled_incline.json", Sled in sled,
    constants { alpha, beta, k, m, incl, g }, coordinates { phi, xi, eta }, parameters { eta1, eta2 },
    size 5 + 6, conserved true,
    reactions |system, state| <[f64; 1]>::from(system.reactions(0.0, state)).to_vec()
}

reference! {
    ball_at_constant_speed: "04a_ball_turntable_const.json", BallConst in ball_const,
    constants { m, a, Om0 }, coordinates { x, y, psi, th, phi }, parameters { eta1, eta2, eta3 },
    size 8 + 3, conserved false,
    reactions |system, state| <[f64; 2]>::from(system.reactions(0.0, state)).to_vec()
}

reference! {
    ball_at_varying_speed: "04b_ball_turntable_varying.json", BallVarying in ball_varying,
    constants { m, a, Om0, Om1, nu }, coordinates { x, y, psi, th, phi }, parameters { eta1, eta2, eta3 },
    size 8 + 5, conserved false,
    reactions |system, state| <[f64; 2]>::from(system.reactions(0.0, state)).to_vec()
}

reference! {
    euler_top: "05_euler_top.json", EulerTop in euler_top,
    constants { I1, I2, I3 }, coordinates { psi, th, phi }, parameters { p, q, r },
    size 6 + 3, conserved true,
    reactions |_system, _state| Vec::new()
}
