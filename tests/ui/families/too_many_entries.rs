//! Loops write out at most a million entries.
//!
//! repair: `count n = 1000001;` => `count n = 20;`

guen::mechanical_system! {
    pub system Chain {
        count n = 1000001;
        constants { m > 0 }
        coordinates { x }
        kinetic_energy = sum(i in 0..n: m*dot(x)^2/2);
    }
}

fn main() {}
