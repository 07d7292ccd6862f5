//! Arrays in every section, and what they are in Rust.

use guen::mechanical_system;

mechanical_system! {
    /// Carts on a line, each with a pendulum, coupled by springs of two indices.
    pub system Carts {
        count n = 3;
        count pairs = n*(n - 1)/2;
        constants {
            m[n] > 0 = 1,
            for i in 0..n { J[i] > 0 = (i + 1)/10 }
            k[n, n] >= 0,
            L > 0 = 2,
            for i in 0..n { l[i] > 0 = L/(i + 1) }
            g = 9.81,
        }
        inputs { push[n] in -10..10, brake }
        coordinates { for i in 0..n { x[i], angle[i] } }
        fn hung(s, turn, length) = vec(s, 0, 0) + length*vec(sin(turn), 0, -cos(turn));
        for i in 0..n {
            let frame[i] = rot_y(-angle[i]);
            let center[i] = hung(x[i], angle[i], l[i]);
        }
        parameters {
            for i in 0..n {
                speed[i] = dot(x[i]);
                if i % 2 == 0 { turning[i] = dot(angle[i]); } else { turning[i] = 2*dot(angle[i]); }
            }
        }
        particles { for i in 0..n { m[i] at vec(x[i], 0, 0); } }
        bodies {
            for i in 0..n {
                bob[i] { mass: m[i]/2, center: center[i], inertia: diag(J[i], J[i], J[i]), orientation: frame[i] }
            }
        }
        gravity = vec(0, 0, -g);
        force_function = -sum(i in 0..n: sum(j in 0..i: k[i, j]*(x[i] - x[j])^2/2)) - sum(i in 3..n: x[i]);
        forces {
            for i in 0..n { push[i] - brake*speed[i] along speed[i]; }
        }
        for i in 0..n { let i_plus[i] = i + 1; }
        for j in 0..=1 { let j_plus[j] = j - 1/2; }
        outputs {
            for i in 0..n { place[i] = bob[i].center; }
            for i in 0..n { for j in 0..2 { grid[i, j] = i_plus[i]*x[i] + j_plus[j]; } }
            count_of_pairs = pairs + 0*x[0];
            heights = product(i in 0..n: bob[i].center.z);
            spin = bob[n-1].angular_velocity;
        }

        scene Ends { track x[0], angle[0]; fix m = 2, k[1, 0] = 0, k[2, 0] = 0; provide place, heights; }
    }
}

/// The values of the right-hand side by hand.
fn accelerations(system: &Carts, state: &carts::State, inputs: &carts::Inputs) -> ([f64; 3], [f64; 3]) {
    let (mut cart, mut bob) = ([0.0; 3], [0.0; 3]);
    for i in 0..3 {
        let length = 2.0 / (i as f64 + 1.0);
        let (sine, cosine) = state.angle[i].sin_cos();
        let rate = state.turning[i] / [1.0, 2.0, 1.0][i];
        let (m, half) = (system.m[i], system.m[i] / 2.0);
        let mut force = inputs.push[i] - inputs.brake * state.speed[i];
        for j in 0..3 {
            let k = if j < i {
                system.k[i][j]
            } else if j > i {
                system.k[j][i]
            } else {
                0.0
            };
            force -= k * (state.x[i] - state.x[j]);
        }
        // (m + half) a + half*length*cosine*b = force + half*length*sine*rate^2
        // half*length*cosine*a + (half*length^2 + J) b = -half*g*length*sine
        let matrix = [m + half, half * length * cosine, half * length * length + system.J[i]];
        let right = [force + half * length * sine * rate * rate, -half * system.g * length * sine];
        let determinant = matrix[0] * matrix[2] - matrix[1] * matrix[1];
        cart[i] = (right[0] * matrix[2] - right[1] * matrix[1]) / determinant;
        bob[i] = (matrix[0] * right[1] - matrix[1] * right[0]) / determinant * [1.0, 2.0, 1.0][i];
    }
    (cart, bob)
}

#[test]
fn arrays_stand_in_every_section() {
    let springs = [[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [1.0, 2.0, 0.0]];
    let declared = Carts::new(springs);
    assert_eq!(declared.J, [0.1, 0.2, 0.3]);
    assert_eq!(declared.constants_resolved_l(), [2.0, 1.0, 2.0 / 3.0]);
    let system = declared.prepare().unwrap();
    let state = carts::State {
        x: [0.1, -0.3, 0.7],
        angle: [0.4, -0.9, 1.3],
        speed: [0.2, 0.5, -0.6],
        turning: [1.1, -0.4, 0.3],
    };
    let inputs = carts::Inputs { push: [1.0, -2.0, 0.5], brake: 0.3 };
    let rates = system.rhs(0.0, &state, &inputs);
    let (cart, bob) = accelerations(&declared, &state, &inputs);
    for i in 0..3 {
        assert!((rates.speed[i] - cart[i]).abs() < 1e-12, "{i}: {} {}", rates.speed[i], cart[i]);
        assert!((rates.turning[i] - bob[i]).abs() < 1e-12, "{i}: {} {}", rates.turning[i], bob[i]);
        assert_eq!(rates.angle[i], state.turning[i] / [1.0, 2.0, 1.0][i]);
    }
    assert_eq!(carts::State::NAMES[..4], ["x[0]", "angle[0]", "x[1]", "angle[1]"]);
    assert_eq!(carts::State::NAMES[6..8], ["speed[0]", "turning[0]"]);
    let outputs = system.outputs(0.0, &state, &inputs);
    assert_eq!(outputs.count_of_pairs, 3.0);
    assert_eq!(outputs.grid[2][1], 3.0 * 0.7 + 0.5);
    assert!((outputs.place[1][2] + 0.9_f64.cos()).abs() < 1e-15);
    let heights: f64 = (0..3).map(|i| outputs.place[i][2]).product();
    assert!((outputs.heights - heights).abs() < 1e-15);
    assert!((outputs.spin[1] + 0.3).abs() < 1e-15, "{:?}", outputs.spin);
    let (lower, upper) = system.limits();
    assert_eq!((lower.push, upper.push), ([-10.0; 3], [10.0; 3]));
    assert!(lower.brake.is_infinite());
    assert_eq!(
        system.clamped(&carts::Inputs { push: [20.0, -20.0, 1.0], brake: 3.0 }).push,
        [10.0, -10.0, 1.0]
    );
}

impl Carts {
    fn constants_resolved_l(&self) -> [f64; 3] {
        self.resolved().l.map(|l| l.value().unwrap())
    }
}

#[test]
fn a_scene_has_entries() {
    let springs = [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 2.0, 0.0]];
    let declared = Carts { m: [2.0; 3], ..Carts::new(springs) };
    let system = declared.prepare().unwrap();
    let full = carts::State {
        x: [0.1, -0.3, 0.7],
        angle: [0.4, -0.9, 1.3],
        speed: [0.2, 0.5, -0.6],
        turning: [1.1, -0.4, 0.3],
    };
    let inputs = carts::Inputs { push: [1.0, -2.0, 0.5], brake: 0.3 };
    let scene = carts::Ends::of(&declared, &full).unwrap();
    println!("{:?}", carts::ends::State::NAMES);
    let prepared = scene.prepare().unwrap();
    let own = carts::ends::State::from(&full);
    let rates = prepared.rhs(0.0, &own, &carts::ends::Inputs::from(inputs));
    let whole = system.rhs(0.0, &full, &inputs);
    assert_eq!(own.within(full), full);
    let back = rates.within(whole);
    for (a, b) in <[f64; 12]>::from(back).into_iter().zip(<[f64; 12]>::from(whole)) {
        assert!((a - b).abs() < 1e-12);
    }
    assert_eq!(scene.system().m, [2.0; 3]);
}
