//! What a scene does not provide cannot be asked for, and the message names the line to add.
use guen::Monitored;

guen::mechanical_system! {
    pub system Sled {
        constants { m > 0, k > 0, alpha }
        inputs { push }
        coordinates { phi, x, y }
        parameters { turning = dot(phi); speed = dot(x)*cos(phi) + dot(y)*sin(phi); }
        constraints { blade: dot(x)*sin(phi) - dot(y)*cos(phi) = 0; }
        let centre = vec(x + alpha*cos(phi), y + alpha*sin(phi));
        kinetic_energy = m/2*inner(dot(centre), dot(centre)) + m/2*k^2*turning^2;
        forces { push along speed; }
        outputs { way = x*cos(phi); }
        scene Turn { track phi; }
        scene Way { track x; provide way; }
    }
}

fn watch(_: &impl Monitored<f64, 3>) {}

fn main() {
    let system = Sled::new(1.0, 1.0, 0.2);
    let turn = sled::Turn::from(system).prepare().unwrap();
    let (state, inputs) = (sled::turn::State::default(), sled::turn::Inputs::default());
    turn.energy(0.0, &state);
    turn.reactions(0.0, &state, &inputs);
    turn.outputs(0.0, &state, &inputs);
    turn.linearize(0.0, &state, &inputs);
    turn.linearize_outputs(0.0, &state, &inputs);
    turn.momenta(0.0, &state);
    turn.velocities(0.0, &state);
    watch(&turn.driven(inputs));
    let way = sled::Way::from(system).prepare().unwrap();
    way.energy(0.0, &Default::default());
    way.linearize_outputs(0.0, &Default::default(), &Default::default());
}
