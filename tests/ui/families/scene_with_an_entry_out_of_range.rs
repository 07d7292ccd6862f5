//! In a loop of a scene every entry is there.
//!
//! repair: `0..=n` => `0..n`

guen::mechanical_system! {
    pub system Row {
        count n = 3;
        constants   { m > 0 }
        coordinates { q[n] }
        kinetic_energy = sum(i in 0..n: m/2*dot(q[i])^2);
        scene All { for i in 0..=n { track q[i]; } }
    }
}

fn main() {}
