//! The instances in a component do not depend on the counts that its uses give.
//!
//! repair: `in 0..n` => `in 0..3`

guen::mechanical_system! {
    pub system Rods {
        component Rod(from: vector) {
            constants   { m > 0 }
            coordinates { q }
            particles   { m at from + vec(sin(q), -cos(q)); }
        }
        component Row(_n: count) {
            count n = _n;
            for i in 0..n { use Rod as rod[i] { from: vec(i, 0) } }
        }
        use Row as row { _n: 3 }
    }
}

fn main() {}
