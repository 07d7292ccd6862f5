//! A fault in a loop hides no unknown name, neither beside it nor outside of the loop.
//!
//! repair: `q[i+1]` => `q[i]`
//! repair: `gg*q[i]` => `g*q[i]`
//! repair: `mass*` => `m*`
//! errors: 3

guen::mechanical_system! {
    pub system Points {
        count n = 3;
        constants { m > 0, g > 0 }
        coordinates { q[n] }
        for i in 0..n { let height[i] = sin(q[i+1]); }
        for i in 0..n { let depth[i] = gg*q[i]; }
        kinetic_energy = sum(i in 0..n: mass*dot(q[i])^2/2);
        potential_energy = sum(i in 0..n: g*height[i] - depth[i]);
        outputs { fastest = q_rate[2]; }
    }
}

fn main() {}
