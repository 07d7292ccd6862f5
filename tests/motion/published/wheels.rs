//! The rolling wheel and the driven wheel set of Multibody.jl's tests, whose figures are published to a thousandth. The wheel was recomputed
//! in 30 digits. Axes as there: `y` points up, a wheel turns about its `z`.

use guen::prelude::*;

use super::close;

guen::mechanical_system! {
    pub system RollingWheel {
        constants { r > 0 = 0.3, m > 0 = 2, axial > 0 = 0.06, across > 0 = 0.12, g = 9.80665 }
        coordinates { x, z, yaw, lean, spin }
        let L = rot_y(yaw)*rot_x(lean);
        let contact = vec(x, 0, z);
        let center = contact + r*L.y;
        bodies { wheel { mass: m, inertia: diag(across, across, axial), center: center, orientation: L*rot_z(spin) } }
        gravity = vec(0, -g, 0);
        parameters {
            leaning = inner(L.x, wheel.angular_velocity);
            turning = inner(L.y, wheel.angular_velocity);
            rolling = inner(L.z, wheel.angular_velocity);
        }
        constraints { on_ground: wheel.velocity_at(contact) = 0; }
        outputs { place = center; }
    }
}

#[test]
fn rolling_wheel_is_where_it_is_published_to_be_after_four_seconds() {
    let system = RollingWheel::default().prepare().unwrap();
    let start = rolling_wheel::State { x: 0.2, z: 0.2, leaning: -1.0, rolling: -5.0, ..Default::default() };
    let end = Integration::new(&system, 0.0, &start.into()).run(&Dop853::new(1e-13, 1e-13), 4.0);
    let end = end.unwrap().state;
    let place = system.outputs(4.0, &end.into()).place;
    close("published", &[place[0], place[2]], &[0.162547, -2.23778], 1.0, 1e-3);
    let computed = [0.1630034830, 0.2608480821, -2.2376143417];
    close("computed in 30 digits", &place, &computed, 1.0, 1e-10);
}

guen::mechanical_system! {
    /// Two wheels on one axle, each driven by a torque that the frame between them takes up, and a body ahead of the axle.
    pub system WheelSet {
        coordinates { x, z, yaw, one, two }
        let M = rot_y(yaw);
        let middle = vec(x, 1/10, z);
        let left_hub = middle + M*vec(0, 0, 1/4);
        let right_hub = middle - M*vec(0, 0, 1/4);
        let down = vec(0, -1/10, 0);
        bodies {
            left { mass: 1/2, inertia: diag(0.02, 0.02, 0.01), center: left_hub, orientation: M*rot_z(one) }
            right { mass: 1/2, inertia: diag(0.02, 0.02, 0.01), center: right_hub, orientation: M*rot_z(two) }
            load { mass: 0.01, inertia: diag(0.001, 0.001, 0.001), center: middle + M.x/5, orientation: M }
        }
        parameters { speed = inner(M.x, dot(middle)); turn = dot(yaw); }
        constraints {
            left_rolls: inner(M.x, left.velocity_at(left_hub + down)) = 0;
            right_rolls: inner(M.x, right.velocity_at(right_hub + down)) = 0;
            sideways: inner(M.z, left.velocity_at(left_hub + down)) = 0;
        }
        forces { 2*sin(2*pi*t) along dot(one); 2*cos(2*pi*t) along dot(two); }
    }
}

#[test]
fn wheel_set_runs_along_its_published_track() {
    let x = [
        0.1, 0.0611068, -0.0658862, -0.270161, -0.519216, -0.741042, -0.834663, -0.820189, -0.821855,
        -0.862654, -0.888457,
    ];
    let z = [
        0.1, 0.101768, 0.122277, 0.169771, 0.193664, 0.120891, -0.0183936, -0.0968069, -0.100183, -0.102072,
        -0.10982,
    ];
    let times: Vec<f64> = (0..=10).map(|k| f64::from(k) / 10.0).collect();
    let system = WheelSet::new().prepare().unwrap();
    let start = wheel_set::State { x: 0.1, z: 0.1, ..Default::default() };
    let mut seen = 0;
    Integration::new(&system, 0.0, &start.into())
        .sample(&times, &mut |k, _, state| {
            close("place", &state[..2], &[x[k], z[k]], 1.0, 1e-3);
            seen += 1;
        })
        .run(&Dop853::new(1e-12, 1e-12), 1.0)
        .unwrap();
    assert_eq!(seen, times.len());
}
