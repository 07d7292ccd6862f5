//! All entries of an array have a default, or none.
//!
//! repair: `} else { k[i] }` => `} else { k[i] = 3 }`

guen::mechanical_system! {
    pub system Chain {
        count n = 4;
        constants   { m[n] > 0, l > 0, c >= 0, g = 9.81, for i in 0..2 { if i > 0 { k[i] = 2 } else { k[i] } } }
        coordinates { q[n] }
        let p[0] = l*vec(sin(q[0]), -cos(q[0]));
        for i in 1..n { let p[i] = p[i-1] + l*vec(sin(q[i]), -cos(q[i])); }
        particles { for i in 0..n { m[i] at p[i]; } }
        forces    { for i in 1..n { -c*(dot(q[i]) - dot(q[i-1])) along dot(q[i]) - dot(q[i-1]); } }
        force_function = k[0]*q[0] + k[1]*q[1];
        gravity = vec(0, -g);
    }
}

fn main() {}
