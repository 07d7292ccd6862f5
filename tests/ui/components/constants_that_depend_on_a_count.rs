//! The constants of a component do not depend on the counts that its uses give.
//!
//! repair: `m > 0, share = 1/links` => `m > 0, share = 1/2`

guen::mechanical_system! {
    pub system Chains {
        component Chain(from: vector, links: count) {
            constants   { m > 0, share = 1/links }
            coordinates { q[links] }
            particles   { for i in 0..links { m at from + share*vec(q[i], 0); } }
        }
        constants { c > 0 }
        particles { c at vec(0, 0); }
        use Chain as chain { from: vec(0, 0), links: 3 }
        use Chain as other { from: vec(1, 0), links: 2 }
    }
}

fn main() {}
