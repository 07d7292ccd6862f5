//! An index has at most 64 operations.
//!
//! repair: `-----------------------------------------------------------------i` => `i`

guen::mechanical_system! {
    pub system Points {
        count n = 3;
        constants { m > 0 }
        coordinates { x[n] }
        parameters { for i in 0..n { v[i] = dot(x[-----------------------------------------------------------------i]); } }
        kinetic_energy = m/2*sum(i in 0..n: v[i]^2);
    }
}

fn main() {}
