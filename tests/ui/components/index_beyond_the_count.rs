//! What a count of a use leads to is told in the component, with the instance.
//!
//! repair: `vec(q[i], q[2])` => `vec(q[i], q[1])`

guen::mechanical_system! {
    pub system Chains {
        component Chain(from: vector, links: count) {
            constants   { m > 0 }
            coordinates { q[links] }
            particles   { for i in 0..links { m at from + vec(q[i], q[2]); } }
        }
        constants { c > 0 }
        particles { c at vec(0, 0); }
        use Chain as chain { from: vec(0, 0), links: 3 }
        use Chain as other { from: vec(1, 0), links: 2 }
    }
}

fn main() {}
