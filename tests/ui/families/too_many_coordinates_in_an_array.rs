//! A system has at most 200 coordinates.
//!
//! repair: `count n = 201;` => `count n = 20;`

guen::mechanical_system! {
    pub system Chain {
        count n = 201;
        coordinates { q[n] }
        kinetic_energy = sum(i in 0..n: dot(q[i])^2/2);
    }
}

fn main() {}
