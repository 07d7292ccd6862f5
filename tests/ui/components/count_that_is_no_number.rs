//! An argument that is a count is a whole number which the macro knows.
//!
//! repair: `links: c }` => `links: 3 }`

guen::mechanical_system! {
    pub system Chains {
        component Chain(from: vector, links: count) {
            constants   { m > 0 }
            coordinates { q[links] }
            particles   { for i in 0..links { m at from + vec(q[i], 0); } }
        }
        constants { c > 0 }
        particles { c at vec(0, 0); }
        use Chain as chain { from: vec(0, 0), links: c }
        use Chain as other { from: vec(1, 0), links: 2 }
    }
}

fn main() {}
