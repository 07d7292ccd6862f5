//! Every coordinate is used.
//!
//! repair: `count n = 3;` => `count n = 2;`

guen::mechanical_system! {
    pub system Points {
        count n = 3;
        constants { m > 0 }
        coordinates { q[n] }
        parameters { v = dot(q[0]); w = dot(q[1]); }
        kinetic_energy = m/2*(v^2 + w^2);
    }
}

fn main() {}
