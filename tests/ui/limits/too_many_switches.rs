//! The rates have at most 64 switching functions.
//!
//! repair: `abs(x - 0)` => `x`

guen::mechanical_system! {
    pub system Comb {
        coordinates { x }
        parameters { v = dot(x); }
        kinetic_energy = v^2/2;
        forces {
            -(abs(x - 0) + abs(x - 1) + abs(x - 2) + abs(x - 3) + abs(x - 4)) along v;
            -(abs(x - 5) + abs(x - 6) + abs(x - 7) + abs(x - 8) + abs(x - 9)) along v;
            -(abs(x - 10) + abs(x - 11) + abs(x - 12) + abs(x - 13) + abs(x - 14)) along v;
            -(abs(x - 15) + abs(x - 16) + abs(x - 17) + abs(x - 18) + abs(x - 19)) along v;
            -(abs(x - 20) + abs(x - 21) + abs(x - 22) + abs(x - 23) + abs(x - 24)) along v;
            -(abs(x - 25) + abs(x - 26) + abs(x - 27) + abs(x - 28) + abs(x - 29)) along v;
            -(abs(x - 30) + abs(x - 31) + abs(x - 32) + abs(x - 33) + abs(x - 34)) along v;
            -(abs(x - 35) + abs(x - 36) + abs(x - 37) + abs(x - 38) + abs(x - 39)) along v;
            -(abs(x - 40) + abs(x - 41) + abs(x - 42) + abs(x - 43) + abs(x - 44)) along v;
            -(abs(x - 45) + abs(x - 46) + abs(x - 47) + abs(x - 48) + abs(x - 49)) along v;
            -(abs(x - 50) + abs(x - 51) + abs(x - 52) + abs(x - 53) + abs(x - 54)) along v;
            -(abs(x - 55) + abs(x - 56) + abs(x - 57) + abs(x - 58) + abs(x - 59)) along v;
            -(abs(x - 60) + abs(x - 61) + abs(x - 62) + abs(x - 63) + abs(x - 64)) along v;
        }
    }
}

fn main() {}
