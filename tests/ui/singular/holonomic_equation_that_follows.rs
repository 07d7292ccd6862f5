//! A holonomic equation that is a multiple of another one, where parameters are left out.
//!
//! repair: ` double: 2*(p + q) = 0;` => ``

guen::mechanical_system! {
    pub system Pair {
        coordinates { p, q, s }
        particles { 1 at vec(p, q, s); }
        holonomic { closed: p + q = 0; double: 2*(p + q) = 0; }
    }
}

fn main() {}
