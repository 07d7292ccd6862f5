//! Of the rates of coordinates that could be parameters the macro chooses as many as there are degrees of freedom.
//!
//! repair: `-c*y_rate along y_rate` => `-c*dot(y) along dot(y)`

guen::mechanical_system! {
    pub system Blade {
        constants { m > 0, J > 0, c >= 0 }
        coordinates { heading, x, y }
        constraints { blade: dot(x)*sin(heading) = dot(y)*cos(heading); }
        kinetic_energy = m/2*(dot(x)^2 + dot(y)^2) + J/2*heading_rate^2;
        forces { -c*y_rate along y_rate; }
    }
}

fn main() {}
