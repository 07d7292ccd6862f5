//! A four-legged robot from one leg: a torso that floats, and twelve joints with motors. It tucks its legs in free fall.
//!
//! ```text
//! cargo run --release --example quadruped
//! ```

use std::error::Error;

use guen::prelude::*;

guen::mechanical_component! {
    /// A leg: the hip turns about the long axis of the torso and across it, the knee across. The springs hold a pose.
    pub component Leg(hip: vector, torso: rotation) {
        constants   { m > 0 = 0.6, l > 0 = 0.25, k >= 0 = 8, c >= 0 = 0.2, knee_rest = 1.2 }
        inputs      { spread_torque, swing_torque, knee_torque }
        coordinates { spread, swing, knee }
        let upper = torso*rot_x(spread)*rot_y(swing);
        let lower = upper*rot_y(knee);
        let elbow = hip - l*upper.z;
        let foot  = elbow - l*lower.z;
        bodies {
            thigh { mass: m,   center: hip - l/2*upper.z,   inertia: diag(m*l^2/12, m*l^2/12, m*l^2/200), orientation: upper }
            shank { mass: m/2, center: elbow - l/2*lower.z, inertia: diag(m*l^2/24, m*l^2/24, m*l^2/400), orientation: lower }
        }
        potential_energy = k/2*(spread^2 + swing^2 + (knee - knee_rest)^2);
        forces {
            spread_torque - c*dot(spread) along dot(spread);
            swing_torque - c*dot(swing) along dot(swing);
            knee_torque - c*dot(knee) along dot(knee);
        }
        outputs     { foot_place = foot; }
    }
}

guen::mechanical_system! {
    /// A torso with four legs.
    pub system Quadruped {
        constants   { M > 0 = 8, a > 0 = 0.25, b > 0 = 0.12, I > 0 = 0.15, g = 9.81 }
        coordinates { x, y, z, yaw, pitch, roll }
        let place = vec(x, y, z);
        let torso = rot_z(yaw)*rot_y(pitch)*rot_x(roll);
        bodies      { trunk { mass: M, center: place, inertia: diag(I/2, I, I), orientation: torso } }
        gravity     = vec(0, 0, -g);
        for i in 0..2 {
            use Leg as left[i]  { hip: place + torso*vec((1 - 2*i)*a,  b, 0), torso }
            use Leg as right[i] { hip: place + torso*vec((1 - 2*i)*a, -b, 0), torso }
        }
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let robot = Quadruped::default().prepare()?;
    println!(
        "{} states, {} operations in a right-hand side",
        quadruped::State::NAMES.len(),
        quadruped::COST.total()
    );
    let start = quadruped::State { z: 3.0, ..Default::default() };
    let motion = robot.driven(quadruped::Inputs::default()).simulate(&start, 0.0..0.5)?;
    let end = motion.end();
    println!("after half a second in free fall the knees have bent to {:.3} rad", end.left[0].knee);
    // The same leg on both sides: the robot does not roll or yaw, and its knees agree.
    let uneven = end.roll.abs() + end.yaw.abs() + (end.left[0].knee - end.right[0].knee).abs();
    if uneven > 1e-9 || end.left[0].knee < 0.5 {
        return Err("a symmetric robot tucks its legs alike".into());
    }
    Ok(())
}
