//! A name is declared before its use.
//!
//! repair: `let twice = 2*half;\n        let half = x/2;` => `let half = x/2;\n        let twice = 2*half;`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = m/2*(u^2 + v^2);
        let twice = 2*half;
        let half = x/2;
        force_function = twice;
    }
}

fn main() {}
