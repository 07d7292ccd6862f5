//! A system has at most 1000 coordinates.
//!
//! repair: `count n = 1001;` => `count n = 20;`

guen::mechanical_system! {
    pub system Chain {
        count n = 1001;
        coordinates { q[n] }
        kinetic_energy = sum(i in 0..n: dot(q[i])^2/2);
    }
}

fn main() {}
