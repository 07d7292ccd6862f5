//! Constants at construction: zero, negative, infinite, subnormal.

use super::systems::{Chain20, Damped, EulerTop, Hoop, Sled, Turntable};
use super::{Answer, Line, Task, Verdict};
use guen::ConstantsError;

fn answer<T>(by: &'static str, prepared: Result<T, ConstantsError>) -> Answer {
    let verdict = match prepared {
        Ok(_) => Verdict::Silent { error: f64::INFINITY, allowed: 0.0 },
        Err(error) => {
            let short = match error {
                ConstantsError::NotFinite { .. } => "not finite",
                ConstantsError::OutOfBound { .. } => "out of bound",
                ConstantsError::SingularPivot { .. } => "singular",
                ConstantsError::NotPhysical { .. } => "no body",
                _ => "other",
            };
            Verdict::Refused { short: short.to_owned(), text: error.to_string() }
        }
    };
    Answer { by, verdict }
}

guen::mechanical_system! {
    /// A body that turns and falls, whose constants have no declared bounds.
    system Brick {
        constants { m, A, B, C, g = 9.81 }
        coordinates { z, psi, theta, phi }
        parameters {
            v = dot(z);
            p = dot(psi)*sin(theta)*sin(phi) + dot(theta)*cos(phi);
            q = dot(psi)*sin(theta)*cos(phi) - dot(theta)*sin(phi);
            r = dot(psi)*cos(theta) + dot(phi);
        }
        bodies {
            brick {
                mass: m, inertia: diag(A, B, C), center: vec(0, 0, z),
                orientation: rot_z(psi)*rot_x(theta)*rot_z(phi),
            }
        }
        gravity = vec(0, 0, -g);
    }
}

/// A system with one constant after the other at each of the values that it must not have.
macro_rules! refused {
    ($line:expr, $prepare:ident, $System:ident { $($constant:ident: $value:expr),* }; $($bad:ident = $at:expr),* $(,)?) => {
        let usual = $System { $($constant: $value),* };
        $($line.answers.push(answer(
            concat!(stringify!($System), ": ", stringify!($bad), " = ", stringify!($at)),
            $System { $bad: $at, ..usual }.$prepare(),
        ));)*
    };
}

fn ask() -> Line {
    let mut line = Line {
        system: "constants",
        asked: "masses and inertias that are zero, negative, infinite, no number, or subnormal".to_owned(),
        against: "what `prepare` says, `prepare_physical` of the brick".to_owned(),
        answers: Vec::new(),
    };
    refused!(line, prepare, Hoop { a: 1.0, A: 0.5, C: 1.0, g: 9.81 };
        a = 0.0, a = -1.0, A = 0.0, A = -0.5, C = 0.0, C = -1.0, A = f64::INFINITY, C = f64::NAN, g = f64::INFINITY,
        g = f64::NAN, A = 1e-320, a = 1e200);
    refused!(line, prepare, Sled { m: 1.0, alpha: 0.2, beta: 0.3, k: 0.4, incline: 0.3, g: 9.81 };
        m = 0.0, m = -1.0, k = 0.0, k = -1.0, m = f64::INFINITY, beta = f64::NAN, alpha = 1e200);
    refused!(line, prepare, EulerTop { I1: 1.0, I2: 2.0, I3: 3.0 };
        I1 = 0.0, I2 = -1.0, I3 = f64::INFINITY, I3 = 1e-320);
    refused!(line, prepare, Turntable { m: 1.0, a: 0.1, Omega: 1.0, swing: 0.0, nu: 0.0 };
        m = 0.0, a = 0.0, a = -0.1, Omega = f64::INFINITY, nu = f64::NAN);
    refused!(line, prepare, Chain20 { m: 1.0, M: 1.0, l: 0.1, g: 9.81 };
        m = 0.0, M = 0.0, M = -1.0, l = 0.0, M = f64::INFINITY, g = f64::NAN);
    refused!(line, prepare, Damped { m: 1.0, k: 1.0, c: 0.0 }; m = 0.0, c = -1.0, k = f64::INFINITY, m = 1e-320);
    // No bound is declared: what a body can be says it, if it is asked.
    refused!(line, prepare_physical, Brick { m: 1.0, A: 2.0, B: 3.0, C: 4.0, g: 9.81 };
        m = 0.0, m = -1.0, m = f64::INFINITY, A = 0.0, A = -2.0, B = 6.5, C = 5.5, C = f64::INFINITY, C = f64::NAN);
    line
}

pub fn tasks() -> Vec<Task> {
    vec![Task::new("constants", true, ask)]
}
