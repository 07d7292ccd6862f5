//! The systems whose scenes are looked at in more than one way.

hoop! { guen::mechanical_system;
    outputs {
        height = a*sin(theta);
        trace = vec(xi - a*cos(theta)*sin(psi), eta + a*cos(theta)*cos(psi), 0);
        nodding = dot(eta1);
    }
    scene Tilt { track theta; }
    scene Unit { track theta; fix a = 1, g = 9.81; provide energy; }
    scene Contact { track theta; provide reactions(eta4), linearization; }
    scene Told { provide energy, reactions, linearization, height, trace, nodding; }
    scene Numbers { track theta, psi; fix a = 1/2, A = 1/8, C = A*2, g = 9.81; provide reactions, operators; }
    scene Everything { track theta, psi, phi, xi, eta, zeta, eta1, eta2, eta3; }
    scene Nodding { track theta; provide nodding; }
}

sled! { guen::mechanical_system;
    scene Turn { track phi; }
    scene Centred { track phi; fix alpha = 0; }
    scene Level { fix incline = 0; }
    scene Straight { fix beta = 0; }
    scene Flat { fix incline = 0, beta = 0; provide energy, reactions, linearization; }
}

appell! { guen::mechanical_system;
    outputs { axial = dot(eta3*sin(theta)); }
    scene Rolling { fix eta3; provide energy; }
    scene Measured { fix eta3; provide energy, reactions, linearization, axial; }
    scene Spinning { fix eta3, a = 3/4; }
}

guen::mechanical_system! {
    /// A car with two trailers on its rear axle and behind each other; five wheels spin.
    pub system Convoy {
        constants {
            m > 0, J > 0, I > 0, m1 >= 0, K1 >= 0, m2 >= 0, K2 >= 0, base > 0, half > 0, r > 0, d1 > 0, d2 > 0, drag >= 0
        }
        inputs { drive, steering }
        coordinates { x, y, heading, steer, first, second, left, right, front, wheel1, wheel2 }
        let v = dot(x)*cos(heading) + dot(y)*sin(heading);
        let x1 = x - d1*cos(first);
        let y1 = y - d1*sin(first);
        let x2 = x1 - d2*cos(second);
        let y2 = y1 - d2*sin(second);
        parameters {
            speed = v;
            turn = dot(steer);
        }
        constraints {
            rear: dot(x)*sin(heading) - dot(y)*cos(heading) = 0;
            ahead: base*dot(heading)*cos(steer) - v*sin(steer) = 0;
            one: d1*dot(first) - v*sin(heading - first) = 0;
            two: d2*dot(second) - v*cos(heading - first)*sin(first - second) = 0;
            rolls_left: r*dot(left) = v - half*dot(heading);
            rolls_right: r*dot(right) = v + half*dot(heading);
            rolls_front: r*dot(front)*cos(steer) = v;
            rolls1: r*dot(wheel1) = v*cos(heading - first);
            rolls2: r*dot(wheel2) = v*cos(heading - first)*cos(first - second);
        }
        kinetic_energy = m/2*(dot(x)^2 + dot(y)^2) + J/2*dot(heading)^2 + I/2*dot(steer)^2
            + m1/2*(dot(x1)^2 + dot(y1)^2) + K1/2*dot(first)^2
            + m2/2*(dot(x2)^2 + dot(y2)^2) + K2/2*dot(second)^2
            + I/2*(dot(left)^2 + dot(right)^2 + dot(front)^2 + dot(wheel1)^2 + dot(wheel2)^2);
        forces {
            drive - drag*speed along speed;
            steering along turn;
        }
        scene Course { track x, y, heading; }
        scene Dash { track speed, steer, heading; }
        scene Alone { track x, y, heading; fix m1 = 0, K1 = 0, m2 = 0, K2 = 0; }
        scene Hitch { track first, second; }
        scene Aim { track steer; }
    }
}

pub const HOOP: Hoop = Hoop { a: 0.5, A: 0.125, C: 0.25, g: 9.81 };
pub const SLED: Sled = Sled { m: 1.3, alpha: 0.4, beta: -0.3, k: 0.7, incline: 0.2, g: 9.81 };
pub const APPELL: Appell = Appell { a: 0.75, A: 0.6, C: 0.9, g: 9.81 };
pub const CONVOY: Convoy = Convoy {
    m: 1.2,
    J: 0.8,
    I: 0.05,
    m1: 0.7,
    K1: 0.2,
    m2: 0.5,
    K2: 0.1,
    base: 1.1,
    half: 0.4,
    r: 0.3,
    d1: 0.9,
    d2: 1.3,
    drag: 0.2,
};
