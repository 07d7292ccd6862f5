//! Small systems, each with one reason for which something is needed or not.

guen::mechanical_system! {
    /// `y` and `z` are in the energies of `x`, and leave: one cancels, the other by an identity.
    pub system Needless {
        constants { m > 0, k }
        coordinates { x, y, z }
        parameters { u = dot(x); v = dot(y); w = dot(z); }
        kinetic_energy = m/2*u^2 + m/2*v^2 + m*(cos(x - y)^2 + sin(x - y)^2)/2*w^2;
        potential_energy = k/2*x^2 + (x + y)^2/2 - (x - y)^2/2 - 2*x*y + k/4*z^4
            + (sin(y)^2 + cos(y)^2)*x^3 + k*x*y - (y + 1)^2*k*x/4 + (y - 1)^2*k*x/4 + k/6*y^3;
        forces { k*sin(x) along v; }
        scene Cancels { track x; }
        scene Identity { track z; }
        scene Pulled { track y; }
    }
}

guen::mechanical_system! {
    /// The plane problem of two bodies; `areal` is conserved.
    pub system Kepler {
        constants { mu > 0 }
        coordinates { r, phi }
        parameters { radial = dot(r); areal = r^2*dot(phi); }
        kinetic_energy = 1/2*(dot(r)^2 + r^2*dot(phi)^2);
        force_function = mu/r;
        scene Distance { track r; }
        scene Reduced { track r; fix areal; provide energy; }
        scene Orbit { track r, phi; fix areal, mu = 1; }
    }
}

guen::mechanical_system! {
    /// A bead in a dish that is shaken in one direction.
    pub system Bead {
        constants { m > 0, k, nu }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = m/2*(u^2 + v^2);
        potential_energy = k/2*(x - sin(nu*t))^2 + k/4*y^4;
        scene Shaken { track x; }
        scene Free { track y; }
    }
}

guen::mechanical_system! {
    /// Two masses, and three inputs of which each mass has two; limits on one.
    pub system Pair {
        constants { m > 0, k, limit > 0 }
        inputs { one in -limit..limit, two, both }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = m/2*(u^2 + v^2);
        potential_energy = k/4*(x^4 + y^4);
        forces { one + both along u; two*both along v; }
        outputs { effort = one*u + two*u; pull = vec(one, 2*x, 0); jolt = dot(u); }
        scene Left { track x; }
        scene Right { track y; provide linearization; }
        scene Told { track x; provide effort, pull, linearization; }
        scene Jolt { track y; provide jolt; }
        scene Limited { track x; fix limit = k*2, k = 3/4; }
    }
}

guen::mechanical_system! {
    /// A free body in space that falls.
    pub system SpinningBody {
        constants { m > 0, I1 > 0, I2 > 0, I3 > 0, g }
        coordinates { w, i, j, k, x, y, z }
        let R = quaternion(w, i, j, k);
        bodies { body { mass: m, inertia: diag(I1, I2, I3), center: vec(x, y, z), orientation: R } }
        gravity = vec(0, 0, -g);
        parameters {
            omega = transpose(R)*angular_velocity(R);
            vx = dot(x); vy = dot(y); vz = dot(z);
        }
        holonomic { length: w^2 + i^2 + j^2 + k^2 = 1; }
        scene One { track w; }
        scene Euler { track omega; }
        scene Fall { track z; }
    }
}

guen::mechanical_system! {
    /// Ties whose reactions have accelerations: of `u`, which depends on `y`, and of `turn`, which rests.
    pub system Tied {
        constants { m > 0, k }
        coordinates { w, x, y, z, c, d }
        parameters { s = dot(w); u = dot(x); v = dot(y); turn = dot(c); }
        constraints { cord: dot(z) = dot(x); gear: dot(d) = dot(c); }
        kinetic_energy = m/2*(dot(w)^2 + dot(x)^2 + dot(y)^2 + dot(z)^2 + dot(c)^2 + dot(d)^2);
        potential_energy = k*x*y + k*(d - c);
        scene Cord { track w; provide reactions(cord); }
        scene Gear { track w; fix turn; provide reactions(gear); }
    }
}

pub const TIED: Tied = Tied { m: 1.3, k: 0.7 };
pub const NEEDLESS: Needless = Needless { m: 1.3, k: 0.7 };
pub const KEPLER: Kepler = Kepler { mu: 1.2 };
pub const BEAD: Bead = Bead { m: 1.3, k: 0.7, nu: 2.1 };
pub const PAIR: Pair = Pair { m: 1.3, k: 0.7, limit: 2.0 };
pub const SPINNING_BODY: SpinningBody = SpinningBody { m: 1.3, I1: 0.5, I2: 0.7, I3: 0.9, g: 9.81 };
