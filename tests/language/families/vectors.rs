//! Arrays of vectors and quaternions, units, rates that the macro chooses, entries of arrays in scenes, files.

use guen::prelude::*;

guen::mechanical_system! {
    /// Balls that spin freely and fly, in quaternions.
    pub system Balls {
        count n = 2;
        constants   { J[n] > 0, m > 0 = 1 }
        coordinates { w[n], i[n], j[n], k[n], place[n, 3] }
        holonomic   { for b in 0..n { length[b]: w[b]^2 + i[b]^2 + j[b]^2 + k[b]^2 = 1; } }
        bodies {
            for b in 0..n {
                ball[b] {
                    mass: m,
                    center: vec(place[b, 0], place[b, 1], place[b, 2]),
                    inertia: diag(J[b], J[b], J[b]),
                    orientation: quaternion(w[b], i[b], j[b], k[b]),
                }
            }
        }
        parameters {
            for b in 0..n { spin[b] = ball[b].angular_velocity; }
            for b in 0..n { v[b] = dot(ball[b].center); }
        }
        outputs {
            for b in 0..n { momentum[b] = J[b]*spin[b]; }
            sideways = spin_x[1] + v[0].y;
        }
        scene First { track place[0, 1], spin[0]; }
    }
}

#[test]
fn vectors_have_entries_and_components() {
    let balls = Balls::new([0.5, 2.0]).prepare().unwrap();
    let state = balls::State {
        w: [1.0; 2],
        place: [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]],
        spin_x: [0.1, 0.2],
        spin_y: [0.3, 0.4],
        v_y: [0.7, 0.9],
        ..Default::default()
    };
    assert_eq!(balls::State::NAMES[8..10], ["place[0][0]", "place[0][1]"]);
    assert_eq!(balls::State::NAMES[14..18], ["spin_x[0]", "spin_y[0]", "spin_z[0]", "spin_x[1]"]);
    let outputs = balls.outputs(0.0, &state);
    assert_eq!(outputs.momentum[1], [0.4, 0.8, 0.0]);
    assert_eq!(outputs.sideways, 0.2 + 0.7);
    let rates = balls.rhs(0.0, &state);
    assert_eq!(rates.place[1], [0.0, 0.9, 0.0]);
    assert_eq!(rates.i, [0.05, 0.1]);
    let text = serde_json::to_string(&balls.constants()).unwrap();
    assert_eq!(text, r#"{"J":[0.5,2.0],"m":1.0}"#);
    assert_eq!(serde_json::from_str::<Balls>(&text).unwrap(), balls.constants());
    let text = serde_json::to_string(&state).unwrap();
    assert!(text.contains(r#""place":[[1.0,2.0,3.0],[4.0,5.0,6.0]]"#), "{text}");
    assert_eq!(serde_json::from_str::<balls::State>(&text).unwrap(), state);
    let missing = serde_json::from_str::<Balls>(r#"{"J":[0.5],"m":1}"#).unwrap_err();
    assert!(missing.to_string().contains("an array of 2 entries"), "{missing}");
    // The scene has one ball of the two: entries have fields of their own.
    let scene = balls::First::from(balls.constants()).prepare().unwrap();
    let own = balls::first::State::from(&state);
    assert_eq!((own.place_0_1, own.spin_x_0), (2.0, 0.1));
    assert_eq!(scene.rhs(0.0, &own).place_0_1, 0.7);
    assert_eq!(own.within(state), state);
    assert_eq!(balls::first::State::NAMES[0], "place[0][1]");
}

guen::mechanical_system! {
    /// Masses in a row with springs, with units; their rates are chosen.
    pub system Row {
        count n = 40;
        constants   { m[n]: kg > 0 = 1, k[n]: N/m >= 0 = 100, c: N*s/m >= 0 }
        coordinates { x[n]: m }
        kinetic_energy   = sum(i in 0..n: m[i]/2*dot(x[i])^2);
        potential_energy = k[0]/2*x[0]^2 + sum(i in 1..n: k[i]/2*(x[i] - x[i-1])^2);
        forces { for i in 0..n { -c*x_rate[i] along x_rate[i]; } }
        provide taylor;
    }
}

#[test]
fn rates_that_are_chosen_are_arrays() {
    let row = Row::new(0.5);
    assert_eq!(row.k, [100.0; 40]);
    let row = row.prepare().unwrap();
    let mut state = row::State::default();
    state.x[3] = 1.0;
    state.x_rate[20] = 2.0;
    let rates = row.rhs(0.0, &state);
    assert_eq!(rates.x_rate[2..6], [100.0, -200.0, 100.0, 0.0]);
    assert_eq!((rates.x[20], rates.x_rate[20]), (2.0, -1.0));
    assert_eq!(row::State::NAMES[43], "x_rate[3]");
    assert_eq!(row::State::<f64>::default(), row::State::from([0.0; 80]));
    let motion = row.simulate(&state, 0.0..0.1).unwrap();
    assert!(motion.end().x[3] < 1.0);
}

/// Declarations that come out of other macros.
macro_rules! masses {
    ($Name:ident, $count:literal, $i:ident) => {
        guen::mechanical_system! {
            pub system $Name {
                count size = $count;
                constants   { m[size] > 0 }
                coordinates { x[size] }
                parameters  { for $i in 0..size { v[$i] = dot(x[$i]); } }
                kinetic_energy = sum($i in 0..size: m[$i]*v[$i]^2/2);
                forces { for i in 0..size { if i > 0 && i < size - 1 { x[i-1] - 2*x[i] + x[i+1] along v[i]; } } }
            }
        }
    };
}

masses!(Several, 4, index);

#[test]
fn other_macros_may_write_families() {
    let rates = Several::new([2.0; 4])
        .prepare()
        .unwrap()
        .rhs(0.0, &several::State { x: [0.0, 1.0, 0.0, 2.0], v: [0.0; 4] });
    assert_eq!(rates.v, [0.0, -1.0, 1.5, 0.0]);
}
