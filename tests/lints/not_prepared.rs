//! Integrating constants, or a system without its inputs: the message names the call that is missing.
use guen::prelude::*;

mechanical_system! {
    pub system Lift {
        constants { m > 0 }
        inputs { force }
        coordinates { z }
        parameters { w = dot(z); }
        kinetic_energy = m/2*w^2;
        forces { force along w; }
    }
}

fn main() {
    let method = Dop853::new(1e-9, 1e-9);
    let lift = Lift::new(1.0);
    let _ = Integration::new(&lift, 0.0, &[0.0, 0.0]).run(&method, 1.0);
    let prepared = lift.prepare().unwrap();
    let _ = Integration::new(&prepared, 0.0, &[0.0, 0.0]).run(&method, 1.0);
    let start = lift::State { z: 0.0, w: 1.0 };
    let _ = prepared.simulate(&start, 0.0..1.0);
    let _ = prepared.simulation(&start).run(0.0..1.0);
    let pulled = prepared.with_inputs(|_t, state| lift::Inputs { force: -state.z });
    let _ = pulled.simulation(&start).method(Radau5::new(1e-6, 1e-6)).run(0.0..1.0);
    let _ = pulled.simulation(&start).method(Taylor::new(1e-6, 1e-6)).run(0.0..1.0);
}
