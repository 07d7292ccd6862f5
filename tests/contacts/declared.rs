//! The systems of these tests: those of the reference scenes, as their README declares them, and further ones. Three of them are
//! measured, too, and stand in `guen-benchmarks`.

use guen::mechanical_system;
pub use guen_benchmarks::contacts::{BouncingBall, PendulumStop, StickSlip, bouncing_ball, stick_slip};

mechanical_system! {
    pub system BowlingBall {
        constants { m = 7, a = 27/250, g = 9.81, mu = 3/20, c = 4, J = 2/5*m*a^2 }
        coordinates { x, z, phi }
        parameters { u = dot(x); w = dot(z); spin = dot(phi); }
        kinetic_energy = m/2*(u^2 + w^2) + J/2*spin^2;
        potential_energy = m*g*z;
        switches { brake: (t - 3)*(9/2 - t); }
        forces { -c*(t - 3)*brake along dot(phi); }
        contacts { lane: gap = z - a, slip = dot(x) - a*dot(phi), friction = mu, restitution = 0; }
    }
}

mechanical_system! {
    pub system KaneImpact {
        constants { e = 7/10, mu = 1/2, h }
        coordinates { p, q }
        let elbow = vec(sin(p), -cos(p));
        let tip = elbow + vec(sin(q), -cos(q));
        bodies {
            upper { mass: 1, inertia: diag(0, 0, 1/12), center: elbow/2, orientation: rot_z(p) }
            lower { mass: 1, inertia: diag(0, 0, 1/12), center: (elbow + tip)/2, orientation: rot_z(q) }
        }
        parameters { u = dot(p); w = dot(q); }
        contacts { floor: gap = tip.y + h, slip = dot(tip).x, friction = mu, restitution = e; }
    }
}

mechanical_system! {
    pub system PainleveRod {
        constants { m = 1, l = 1, g = 9.81, mu = 2, J = m*l^2/3 }
        coordinates { x, z, theta }
        let tip = vec(x - l*cos(theta), z - l*sin(theta));
        bodies { rod { mass: m, inertia: diag(0, 0, J), center: vec(x, z), orientation: rot_z(theta) } }
        gravity = vec(0, -g);
        parameters { u = dot(x); w = dot(z); omega = dot(theta); }
        contacts { end: gap = tip.y, slip = dot(tip).x, friction = mu, restitution = 0; }
        scene Sliding { modes { end: slip; } track theta, u; }
    }
}

mechanical_system! {
    pub system PuckIncline {
        constants { m = 1, g = 9.81, sa = 5/13, ca = 12/13, mu = 5/6 }
        coordinates { x, y, n }
        particles { m at vec(x, y, n); }
        gravity = g*vec(sa, 0, -ca);
        parameters { v = dot(vec(x, y, n)); }
        contacts { plane: gap = n, slip = vec(dot(x), dot(y)), friction = mu, restitution = 0; }
    }
}

mechanical_system! {
    pub system ThrownBall {
        constants { m = 1, a = 1/10, J = 1/250, g = 9.81, e = 1/2, mu = 1/5 }
        coordinates { x, z, phi }
        parameters { u = dot(x); w = dot(z); spin = dot(phi); }
        kinetic_energy = m/2*(u^2 + w^2) + J/2*spin^2;
        potential_energy = m*g*z;
        contacts { floor: gap = z - a, slip = dot(x) - a*dot(phi), friction = mu, restitution = e; }
    }
}

mechanical_system! {
    pub system TwoBalls {
        constants { mA = 1, mB = 2, e = 1/2 }
        coordinates { xA, xB }
        parameters { a = dot(xA); b = dot(xB); }
        kinetic_energy = mA/2*a^2 + mB/2*b^2;
        contacts { wall: gap = xB, restitution = e; pair: gap = xA - xB, restitution = e; }
    }
}

mechanical_system! {
    /// The wheel of the design: driven, on a road with ice.
    pub system Wheel {
        constants { m > 0 = 20, a > 0 = 3/10, J > 0 = 1, c >= 0 = 1/2, g = 9.81, mu_road = 4/5, mu_ice = 1/10, e in 0..1 = 0 }
        inputs { torque }
        coordinates { x, z, phi }
        bodies { wheel { mass: m, center: vec(x, z), inertia: diag(0, 0, J), orientation: rot_z(-phi) } }
        gravity = vec(0, -g);
        parameters { speed_ahead = dot(x); up = dot(z); spin = dot(phi); }
        forces { torque along spin; -c*speed_ahead along speed_ahead; }
        switches { ice: (x - 5)*(9 - x); }
        let p = vec(x, z - a);
        contacts {
            /// The tyre on the road.
            tyre: gap = z - a, slip = wheel.velocity_at(p).x, friction = mu_road + (mu_ice - mu_road)*ice, restitution = e;
        }
        outputs { force = reaction(tyre); }
        scene Rolling { modes { tyre: stick; } track speed_ahead; }
        scene Turning { modes { tyre: stick; } track spin, speed_ahead, phi; provide force, energy, reactions(tyre); }
        scene Flying { modes { tyre: open; } provide force; }
    }
}

mechanical_system! {
    /// The wheel as a user declares it who knows that it rolls.
    pub system RollingWheel {
        constants { m > 0 = 20, a > 0 = 3/10, J > 0 = 1, c >= 0 = 1/2, g = 9.81 }
        inputs { torque }
        coordinates { x, z, phi }
        bodies { wheel { mass: m, center: vec(x, z), inertia: diag(0, 0, J), orientation: rot_z(-phi) } }
        gravity = vec(0, -g);
        parameters { speed_ahead = dot(x); }
        forces { torque along dot(phi); -c*speed_ahead along speed_ahead; }
        let p = vec(x, z - a);
        holonomic { touches: z - a = 0; }
        constraints { rolls: wheel.velocity_at(p).x = 0; }
        scene Rolling { track speed_ahead; }
    }
}

mechanical_system! {
    /// The hoop of the paper, rolling.
    pub system Hoop {
        constants { a > 0 = 2, A > 0 = 3/2, C > 0 = 5/2, g = 9.81 }
        coordinates { theta, psi, phi, xi, eta, zeta }
        let rolling = dot(psi)*cos(theta) + dot(phi);
        parameters { eta1 = dot(theta); eta2 = dot(psi)*sin(theta); eta3 = rolling; }
        constraints {
            eta4: dot(xi) = a*sin(theta)*sin(psi)*dot(theta) - a*cos(theta)*cos(psi)*dot(psi) - a*cos(psi)*dot(phi);
            eta5: dot(eta) + a*sin(theta)*cos(psi)*dot(theta) + a*cos(theta)*sin(psi)*dot(psi) + a*sin(psi)*dot(phi) = 0;
            eta6: dot(zeta) - a*cos(theta)*dot(theta) = 0;
        }
        kinetic_energy = 1/2*(dot(xi)^2 + dot(eta)^2 + dot(zeta)^2) + 1/2*(A*eta1^2 + A*eta2^2 + C*eta3^2);
        force_function = -a*g*sin(theta) + 0*(eta4 + eta5 + eta6);
    }
}

mechanical_system! {
    /// The hoop of the paper above a floor.
    pub system HoopOnFloor {
        constants { a > 0 = 2, A > 0 = 3/2, C > 0 = 5/2, g = 9.81, mu >= 0 = 1/2 }
        coordinates { theta, psi, phi, xi, eta, zeta }
        let rolling = dot(psi)*cos(theta) + dot(phi);
        parameters {
            eta1 = dot(theta); eta2 = dot(psi)*sin(theta); eta3 = rolling;
            u = dot(xi); v = dot(eta); w = dot(zeta);
        }
        kinetic_energy = 1/2*(u^2 + v^2 + w^2) + 1/2*(A*eta1^2 + A*eta2^2 + C*eta3^2);
        force_function = -g*zeta;
        let slip_x = dot(xi) - a*sin(theta)*sin(psi)*dot(theta) + a*cos(theta)*cos(psi)*dot(psi) + a*cos(psi)*dot(phi);
        let slip_y = dot(eta) + a*sin(theta)*cos(psi)*dot(theta) + a*cos(theta)*sin(psi)*dot(psi) + a*sin(psi)*dot(phi);
        contacts { floor: gap = zeta - a*sin(theta), slip = vec(slip_x, slip_y), friction = mu; }
        outputs { above = gap(floor); across = slip(floor); force = reaction(floor); }
        scene Rolling { modes { floor: stick; } track eta3, xi; provide force; }
        scene Whole { modes { floor: stick; } track theta, psi, phi, xi, eta, zeta; provide energy, reactions; }
        scene Along { modes { floor: stick; } track u, w; }
        scene Bouncing { modes { floor: open, stick; } }
    }
}

mechanical_system! {
    /// Four links, two feet that stick or slip, a knee that stops, a latch, a grip at the hip that a smooth stop loads, a rod on
    /// top that keeps its height above a moving floor.
    pub system Walker {
        constants { g = 9.81, l > 0 = 2/3, mu >= 0 = 7/10, e in 0..1 = 1/4, rate = 3 }
        inputs { hip }
        coordinates { x, z, q1, q2, q3, q4 }
        let p0 = vec(x, z);
        let p1 = p0 + l*vec(sin(q1), -cos(q1));
        let foot1 = p1 + l*vec(sin(q2), -cos(q2));
        let p3 = p0 + l*vec(sin(q3), -cos(q3));
        let foot2 = p3 + l*vec(sin(q4), -cos(q4));
        particles { 5 at p0; 1 at p1; 1/2 at foot1; 1 at p3; 1/2 at foot2; }
        gravity = vec(0, -g);
        switches { late: t - 1; }
        forces { hip*(1 + late) along dot(q1) - dot(q3); }
        contacts {
            heel: gap = foot1.y, slip = dot(foot1).x - sin(rate*t), friction = mu*(1 + 1/(1 + speed)), restitution = e;
            toe: gap = foot2.y - sin(x)/10, slip = dot(foot2).x, friction = mu, stiction = 1;
            knee: gap = q1 - q2;
            lock: latch = q3 - q4, when = z, release = t - 2;
            brake: grip = dot(q1) - dot(q3), friction = mu, load = reaction(knee);
        }
        modes { heel: open, stick; toe: open, slip; knee: open, closed; lock: free, locked; never heel.open with toe.open; }
    }
}

mechanical_system! {
    /// A table on feet, declared by a loop.
    pub system Feet {
        count n = 3;
        constants { m > 0 = 2, J > 0 = 1, reach[n] = 1, g = 9.81, mu >= 0 = 1/2 }
        coordinates { x, z, tilt }
        parameters { u = dot(x); w = dot(z); omega = dot(tilt); }
        kinetic_energy = m/2*(u^2 + w^2) + J/2*omega^2;
        potential_energy = m*g*z;
        for i in 0..n { let foot[i] = vec(x + (i - 1)*reach[i]*cos(tilt), z + (i - 1)*reach[i]*sin(tilt)); }
        contacts {
            for i in 0..n { leg[i]: gap = foot[i].y, slip = dot(foot[i]).x, friction = mu; }
        }
        modes { for i in 0..n { leg[i]: open, stick; } never leg[0].open with leg[2].open; }
        outputs { load = reaction(leg[2]).x; }
        scene Tipping { modes { leg[0]: open, stick; leg[1]: open; leg[2]: open, stick; } track x; }
    }
}

mechanical_system! {
    /// A ball that bounces under a motor whose current settles, and a filter of its speed.
    pub system MotorBall {
        constants { m > 0 = 2, g = 9.81, e in 0..1 = 1/2, L > 0 = 1/4, k = 3, tau > 0 = 1/2 }
        inputs { voltage }
        coordinates { z }
        parameters { v = dot(z); }
        kinetic_energy = m/2*v^2;
        potential_energy = m*g*z;
        states { dot(current) = (voltage - current)/L; dot(slow) = (v - slow)/tau; dot(worn) = abs(v); }
        forces { k*max(current, 0) along v; }
        contacts { floor: gap = z, restitution = e; }
        outputs { force = reaction(floor); }
        scene Resting { modes { floor: open; } track slow; }
    }
}

mechanical_system! {
    /// Contacts that are entries of an array, and one of an instance.
    pub system Row {
        component Wall(p: scalar) { contacts { c: gap = p; } }
        coordinates { x, y[2], z }
        parameters { u = dot(x); for i in 0..2 { v[i] = dot(y[i]); } w = dot(z); }
        kinetic_energy = u^2/2 + v[0]^2/2 + v[1]^2/2 + w^2/2;
        potential_energy = 3*y[0] + 4*y[1] + 5*z;
        use Wall as a { p: z }
        contacts { for i in 0..2 { floor[i]: gap = y[i]; } }
        scene Held { modes { floor[0]: closed; floor[1]: open; a.c: closed; } track x, v[1]; provide reactions; }
    }
}

mechanical_system! {
    /// A ball above a table that shakes many times while the ball falls, which takes one step of a method of high order.
    pub system Shaken {
        constants { m > 0 = 1, g = 9.81, A = 1/1000, om = 200, e in 0..1 = 4/5 }
        coordinates { z }
        parameters { v = dot(z); }
        particles { m at vec(0, z); }
        gravity = vec(0, -g);
        contacts { table: gap = z - A*sin(om*t), restitution = e; }
    }
}

mechanical_system! {
    /// A block on a rough floor that shakes while the block slides.
    pub system Sliding {
        constants { m > 0 = 1, g = 9.81, A = 1/10, om = 20, mu = 1/5, T > 0 = 1 }
        coordinates { x }
        parameters { u = dot(x); }
        kinetic_energy = m/2*u^2;
        contacts { floor: grip = u - A*om/T*cos(om*t/T), limit = mu*m*g/T^2; }
    }
}

mechanical_system! {
    /// A body that nothing moves, with a clock.
    pub system Ticking {
        constants { om = 100 }
        coordinates { x }
        states { dot(n) = 0; }
        parameters { v = dot(x); }
        kinetic_energy = v^2/2;
        resets { tick: sin(om*t) rises, n = n + 1; }
    }
}
