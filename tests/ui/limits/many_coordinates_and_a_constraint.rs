//! Beyond 200 coordinates a system is of particles that are coupled sparsely, and has no constraints.
//!
//! repair: `count n = 201;` => `count n = 20;`

guen::mechanical_system! {
    pub system Row {
        count n = 201;
        coordinates { x[n] }
        parameters { for i in 0..n-1 { v[i] = dot(x[i+1]); } }
        constraints { wall: dot(x[0]) = 0; }
        kinetic_energy = sum(i in 0..n: dot(x[i])^2/2);
    }
}

fn main() {}
