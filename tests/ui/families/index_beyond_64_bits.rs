//! Whole numbers have 64 bits.
//!
//! repair: `q[i + 9223372036854775807]` => `q[i]`

guen::mechanical_system! {
    pub system Chain {
        count n = 4;
        constants   { m[n] > 0, l > 0, c >= 0, g = 9.81 }
        coordinates { q[n] }
        let p[0] = l*vec(sin(q[0]), -cos(q[0]));
        for i in 1..n { let p[i] = p[i-1] + l*vec(sin(q[i]), -cos(q[i])); }
        particles { for i in 0..n { m[i] at p[i]; } }
        forces    { for i in 1..n { -c*(dot(q[i]) - dot(q[i-1])) along dot(q[i + 9223372036854775807]) - dot(q[i-1]); } }
        gravity = vec(0, -g);
    }
}

fn main() {}
