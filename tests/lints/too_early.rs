//! Simulating constants, or a system without its inputs: the message names the call that is missing.
use guen::prelude::*;

mechanical_system! {
    pub system Lift {
        constants { m > 0 }
        inputs { force }
        coordinates { z }
        parameters { w = dot(z); }
        kinetic_energy = m/2*w^2;
        forces { force along w; }
        scene Height { track z; }
    }
}

fn main() {
    let start = lift::State { z: 0.0, w: 1.0 };
    let lift = Lift::new(1.0);
    let motion = lift.simulate(&start, 0.0..1.0).unwrap();
    let _ = motion.at(0.5);
    let _ = lift.simulation(&start).method(Rk8::new(0.1));
    let _ = lift.with_inputs(|_, _| lift::Inputs { force: 1.0 });
    let prepared = lift.prepare().unwrap();
    let _ = prepared.simulate(&start, 0.0..1.0);
    let _ = Radau5::new(1e-6, 1e-6).integrate(&lift, 0.0, &[0.0, 1.0], 1.0, |_, _| ControlFlow::Continue(()));
    let scene = lift::Height::new(1.0);
    let _ = scene.simulate(&lift::height::State { z: 0.0, w: 1.0 }, 0.0..1.0);
    let _ = lift.energy(0.0, &start);
    let _ = scene.rhs(0.0, &lift::height::State { z: 0.0, w: 1.0 });
}
