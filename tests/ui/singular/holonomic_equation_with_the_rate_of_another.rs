//! A holonomic equation that is a function of what another one holds.
//!
//! repair: ` again: sin(p + q) = 0;` => ``

guen::mechanical_system! {
    pub system Pair {
        coordinates { p, q, s }
        parameters { w = dot(s); }
        particles { 1 at vec(p, q, s); }
        holonomic { closed: p + q = 0; again: sin(p + q) = 0; }
    }
}

fn main() {}
