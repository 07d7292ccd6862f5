//! The forms may be written otherwise: constraint rows recombined by a regular matrix `B(t, x)` leave the motion and
//! the reaction covector, `eta_s -> eta_s + b_s(t, x)` leaves the motion.

use super::{assert_near, follow};

/// The ball on a table of varying speed, with the given parameters and constraints.
macro_rules! ball {
    ($System:ident, { $($parameters:tt)* }, { $($constraints:tt)* }) => {
        guen::mechanical_system! {
            pub system $System {
                constants { m > 0, a > 0, Omega, swing }
                coordinates { x, y, psi, theta, phi }
                let table = Omega + swing*sin(t);
                let turn_1 = dot(theta)*cos(psi) + dot(phi)*sin(theta)*sin(psi);
                let turn_2 = dot(theta)*sin(psi) - dot(phi)*sin(theta)*cos(psi);
                let turn_3 = dot(psi) + dot(phi)*cos(theta);
                let east = dot(x) - a*turn_2 + table*y;
                let north = dot(y) + a*turn_1 - table*x;
                parameters { $($parameters)* }
                constraints { $($constraints)* }
                kinetic_energy = m/2*(dot(x)^2 + dot(y)^2) + m*a^2/5*(turn_1^2 + turn_2^2 + turn_3^2);
                potential_energy = m/2*(x^2 + 2*y^2);
            }
        }
    };
}

ball!(Plain, { eta1 = turn_1; eta2 = turn_2; eta3 = turn_3; }, { c1: east = 0; c2: north = 0; });
ball!(
    Recombined,
    { eta1 = turn_1; eta2 = turn_2; eta3 = turn_3; },
    { c1: (2 + cos(t))*east + x*north = 0; c2: (3 + sin(t))*north = y*sin(psi)*east; }
);
ball!(
    Shifted,
    { eta1 = turn_1 + t*x; eta2 = turn_2 - cos(psi)*y^2; eta3 = turn_3 + exp(-t)*sin(phi) + 2; },
    { c1: east = 0; c2: north = 0; }
);
ball!(
    Mixed,
    { eta1 = turn_1 + y*turn_3; eta2 = 2*turn_2 + t*turn_1; eta3 = turn_3 + sin(x)*turn_2 + east*x; },
    { c1: east = 0; c2: north = 0; }
);

const CONSTANTS: (f64, f64, f64, f64) = (0.7, 0.25, 1.5, 0.8);
const TIMES: [f64; 4] = [0.3, 0.8, 1.5, 2.4];
const PLACE: [f64; 5] = [0.4, -0.3, 0.3, 1.2, -0.5];
const TURNS: [f64; 3] = [0.6, -0.9, 0.5];

macro_rules! prepared {
    ($System:ident) => {
        $System::new(CONSTANTS.0, CONSTANTS.1, CONSTANTS.2, CONSTANTS.3).prepare().unwrap()
    };
}

fn start() -> [f64; 8] {
    std::array::from_fn(|i| if i < 5 { PLACE[i] } else { TURNS[i - 5] })
}

/// The state of another declaration with the velocities of the plain one; the constraints hold there too.
macro_rules! carried {
    ($module:ident, $system:expr, $t:expr, $state:expr) => {{
        let plain = prepared!(Plain);
        let velocities: [f64; 5] = plain.velocities($t, &plain::State::from($state)).into();
        let place: [f64; 5] = std::array::from_fn(|i| $state[i]);
        let (state, residuals) =
            $module::State::from_velocities($system, $t, &place.into(), &velocities.into());
        assert!(residuals.iter().all(|r: &f64| r.abs() < 1e-13), "{residuals:?}");
        state
    }};
}

/// Same velocities all along: the coordinates of both runs agree.
macro_rules! moves_alike {
    ($test:ident, $System:ident, $module:ident) => {
        #[test]
        fn $test() {
            let (plain, other) = (prepared!(Plain), prepared!($System));
            let begin: [f64; 8] = carried!($module, &other, 0.0, start()).into();
            let expected = follow(&plain, start(), &TIMES);
            let found = follow(&other, begin, &TIMES);
            for (k, t) in TIMES.iter().enumerate() {
                for i in 0..5 {
                    assert_near(found[k][i], expected[k][i], 1e-11);
                }
                let carried: [f64; 8] = carried!($module, &other, *t, expected[k]).into();
                for i in 5..8 {
                    assert_near(found[k][i], carried[i], 1e-10);
                }
            }
        }
    };
}

moves_alike!(recombined_rows_leave_the_motion, Recombined, recombined);
moves_alike!(shifted_parameters_leave_the_motion, Shifted, shifted);
moves_alike!(mixed_parameters_leave_the_motion, Mixed, mixed);

/// `R_i = sum_v lambda_v a_vi`, with `a_vi` from the residuals of unit velocities.
macro_rules! covector {
    ($module:ident, $system:expr, $t:expr, $state:expr) => {{
        let system = $system;
        let state = carried!($module, &system, $t, $state);
        let place = state.coordinates();
        let lambda = <[f64; 2]>::from(system.reactions($t, &state));
        let rows = |velocities: [f64; 5]| -> [f64; 2] {
            $module::State::from_velocities(&system, $t, &place, &velocities.into()).1
        };
        let rest = rows([0.0; 5]);
        let found: [f64; 5] = std::array::from_fn(|i| {
            let mut unit = [0.0; 5];
            unit[i] = 1.0;
            rows(unit).iter().zip(rest).zip(lambda).map(|((a, a0), l)| l * (a - a0)).sum()
        });
        (found, lambda)
    }};
}

#[test]
fn recombined_rows_leave_the_reaction_covector() {
    for (t, state) in TIMES.iter().zip(follow(&prepared!(Plain), start(), &TIMES)) {
        let (expected, plain) = covector!(plain, prepared!(Plain), *t, state);
        let (found, recombined) = covector!(recombined, prepared!(Recombined), *t, state);
        for (x, y) in found.iter().zip(&expected) {
            assert_near(*x, *y, 1e-12);
        }
        // The multipliers themselves do change.
        assert!((plain[0] - recombined[0]).abs() > 1e-3, "{plain:?} and {recombined:?}");
        // Other parameters leave them.
        let (_, shifted) = covector!(shifted, prepared!(Shifted), *t, state);
        assert_near(shifted[0], plain[0], 1e-12);
        assert_near(shifted[1], plain[1], 1e-12);
    }
}
