//! A system that provides its carried form cannot have the name of that form.
//!
//! repair: `system Carried` => `system Pendulum`

guen::mechanical_system! {
    pub system Carried {
        constants { m > 0, l > 0, g = 9.81 }
        coordinates { angle }
        parameters { rate = dot(angle); }
        kinetic_energy = m/2*l^2*rate^2;
        potential_energy = -m*g*l*cos(angle);
        provide carried;
    }
}

fn main() {}
