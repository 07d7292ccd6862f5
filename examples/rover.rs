//! A rover with six driven wheels from one component: it turns on the spot, and then drives a curve.
//!
//! ```text
//! cargo run --release --example rover
//! ```

use std::error::Error;

use guen::prelude::*;

guen::mechanical_component! {
    /// A wheel with a motor. It rolls without slipping along its plane, and slides across it against a viscous force.
    pub component DrivenWheel(hub: vector, axle: vector, forward: vector) {
        constants   { mass > 0 = 2, radius > 0 = 0.15, spin_inertia > 0 = 0.03, grip >= 0 = 400 }
        inputs      { torque }
        coordinates { angle }
        particles   { mass at hub; }
        kinetic_energy = 1/2*spin_inertia*dot(angle)^2;
        constraints { rolls: inner(dot(hub), forward) = radius*dot(angle); }
        let sideslip = inner(dot(hub), axle);
        forces      { torque along dot(angle); -grip*sideslip along sideslip; }
    }
}

guen::mechanical_system! {
    /// A rigid rover on six wheels, three on a side.
    pub system Rover {
        constants   { m > 0 = 60, J > 0 = 8, length > 0 = 0.5, width > 0 = 0.4 }
        coordinates { x, y, heading }
        let place = vec(x, y);
        let frame = rot_z(heading);
        particles   { m at place; }
        kinetic_energy = J/2*dot(heading)^2;
        parameters  { ahead = inner(dot(place), frame.x); aside = inner(dot(place), frame.y); turning = dot(heading); }
        for i in 0..3 {
            use DrivenWheel as left[i]  { hub: place + frame*vec((1 - i)*length,  width, 0), axle: frame.y, forward: frame.x }
            use DrivenWheel as right[i] { hub: place + frame*vec((1 - i)*length, -width, 0), axle: frame.y, forward: frame.x }
        }
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let rover = Rover::default().prepare()?;
    println!("{} states, {} operations in a right-hand side", rover::State::NAMES.len(), rover::COST.total());
    let torques = |left: f64, right: f64| rover::Inputs {
        left: [rover::left::Inputs { torque: left }; 3],
        right: [rover::right::Inputs { torque: right }; 3],
    };
    let start = rover::State::default();
    let turned = rover.driven(torques(-20.0, 20.0)).simulate(&start, 0.0..1.0)?.end();
    println!("turned on the spot by {:.3} rad: {:.1e} m away", turned.heading, turned.x.hypot(turned.y));
    if turned.x.hypot(turned.y) > 1e-9 || turned.heading < 0.1 {
        return Err("a rover with opposed torques turns on the spot".into());
    }
    let curve = rover.driven(torques(6.0, 7.0)).simulate(&start, 0.0..5.0)?.end();
    println!(
        "after a curve of five seconds at ({:.2}, {:.2}), heading {:.2}",
        curve.x, curve.y, curve.heading
    );
    // Each wheel has turned as far as its hub has gone.
    let drive = (curve.left[0].angle + curve.right[0].angle) * 0.15 / 2.0;
    if curve.heading <= 0.0 || drive < curve.x {
        return Err("stronger motors on the right turn it to the left".into());
    }
    Ok(())
}
