//! Systems with contacts: three of the reference scenes, as the README of the scenes declares them.

use guen::mechanical_system;

mechanical_system! {
    /// A ball that bounces on a floor.
    pub system BouncingBall {
        constants { g = 9.81, e = 4/5 }
        coordinates { z }
        parameters { v = dot(z); }
        kinetic_energy = 1/2*v^2;
        potential_energy = g*z;
        contacts { floor: gap = z, restitution = e; }
    }
}

mechanical_system! {
    /// A pendulum that hits a stop.
    pub system PendulumStop {
        constants { l = 1, g = 9.81, e = 3/5, limit = 1/5 }
        coordinates { theta }
        parameters { omega = dot(theta); }
        kinetic_energy = l^2/2*omega^2;
        potential_energy = -g*l*cos(theta);
        contacts { stop: gap = theta + limit, restitution = e; }
    }
}

mechanical_system! {
    /// A mass on a spring that a moving belt drags along.
    pub system StickSlip {
        constants { m = 1, k = 1, vb = 1/5, mus = 1/10, delta = 3, g = 10 }
        coordinates { x, z }
        parameters { u = dot(x); w = dot(z); }
        kinetic_energy = m/2*(u^2 + w^2);
        potential_energy = k/2*x^2 + m*g*z;
        contacts { belt: gap = z, slip = dot(x) - vb, friction = mus/(1 + delta*speed), restitution = 0; }
    }
}
