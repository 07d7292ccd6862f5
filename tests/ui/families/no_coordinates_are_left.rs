//! A system has at least one coordinate.
//!
//! repair: `count n = 0;` => `count n = 2;`

guen::mechanical_system! {
    pub system Chain {
        count n = 0;
        coordinates { q[n] }
        kinetic_energy = sum(i in 0..n: dot(q[i])^2);
    }
}

fn main() {}
