//! What a scene fixes without a value is at rest, whatever else is fixed.
//!
//! repair: `, x; }` => `; }`

guen::mechanical_system! {
    pub system Sled {
        constants { m > 0, alpha, k > 0, g = 9.81, incline }
        inputs { push }
        coordinates { phi, x, y }
        parameters { turning = dot(phi); speed = dot(x)*cos(phi) + dot(y)*sin(phi); }
        constraints { blade: dot(x)*sin(phi) - dot(y)*cos(phi) = 0; }
        let centre = vec(x + alpha*cos(phi), y + alpha*sin(phi));
        kinetic_energy = m/2*inner(dot(centre), dot(centre)) + m/2*k^2*turning^2;
        potential_energy = -m*g*sin(incline)*x;
        forces { push along speed; }
        outputs { height = -sin(incline)*x; }
        scene Small { track phi; fix alpha = 0, x; }
    }
}

fn main() {}
