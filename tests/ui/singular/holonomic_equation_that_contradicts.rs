//! A holonomic equation that no other leaves room for.
//!
//! repair: ` other: 2*(p + q) = 1;` => ``

guen::mechanical_system! {
    pub system Pair {
        coordinates { p, q, s }
        particles { 1 at vec(p, q, s); }
        holonomic { closed: p + q = 0; other: 2*(p + q) = 1; }
    }
}

fn main() {}
