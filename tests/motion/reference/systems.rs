//! The six reference systems, in the coordinates, forms and energies of their files.

guen::mechanical_system! {
    /// A hoop that rolls without slipping.
    pub system Hoop {
        constants { A > 0, C > 0, a > 0, m > 0, g }
        coordinates { th, psi, phi, xi, eta, zeta }
        parameters {
            eta1 = dot(th);
            eta2 = dot(psi)*sin(th);
            eta3 = dot(psi)*cos(th) + dot(phi);
        }
        constraints {
            c1: dot(xi) - a*sin(th)*sin(psi)*dot(th) + a*cos(th)*cos(psi)*dot(psi) + a*cos(psi)*dot(phi) = 0;
            c2: dot(eta) + a*sin(th)*cos(psi)*dot(th) + a*cos(th)*sin(psi)*dot(psi) + a*sin(psi)*dot(phi) = 0;
            c3: dot(zeta) - a*cos(th)*dot(th) = 0;
        }
        kinetic_energy = m*(dot(xi)^2 + dot(eta)^2 + dot(zeta)^2)/2
                       + (A*(dot(th)^2 + dot(psi)^2*sin(th)^2) + C*(dot(phi) + dot(psi)*cos(th))^2)/2;
        force_function = -m*g*zeta;
    }
}

guen::mechanical_system! {
    /// Appell's holonomic companion of the hoop.
    pub system Appell {
        constants { A > 0, C > 0, a > 0, m > 0, g }
        coordinates { th, psi, phi, xi, eta, zeta }
        parameters {
            eta1 = dot(th);
            eta2 = dot(psi)*sin(th);
            eta3 = dot(psi)*cos(th) + dot(phi);
        }
        constraints {
            c1: dot(xi) + a*sin(th)*dot(th) = 0;
            c2: dot(eta) = 0;
            c3: dot(zeta) - a*cos(th)*dot(th) = 0;
        }
        kinetic_energy = m*(dot(xi)^2 + dot(eta)^2 + dot(zeta)^2)/2
                       + (A*(dot(th)^2 + dot(psi)^2*sin(th)^2) + (C + m*a^2)*(dot(phi) + dot(psi)*cos(th))^2)/2;
        force_function = -m*g*zeta;
    }
}

guen::mechanical_system! {
    /// Chaplygin's sled on an incline.
    pub system Sled {
        constants { alpha, beta, k != 0, m > 0, incl, g }
        coordinates { phi, xi, eta }
        parameters {
            eta1 = dot(phi);
            eta2 = dot(xi)*cos(phi) + dot(eta)*sin(phi);
        }
        constraints { c1: dot(xi)*sin(phi) - dot(eta)*cos(phi) = 0; }
        kinetic_energy = m*((dot(xi) - (alpha*sin(phi) + beta*cos(phi))*dot(phi))^2
                          + (dot(eta) + (alpha*cos(phi) - beta*sin(phi))*dot(phi))^2)/2
                       + m*k^2*dot(phi)^2/2;
        force_function = m*g*sin(incl)*(xi + alpha*cos(phi) - beta*sin(phi));
    }
}

guen::mechanical_system! {
    /// A homogeneous ball on a table that turns evenly.
    pub system BallConst {
        constants { m > 0, a > 0, Om0 }
        coordinates { x, y, psi, th, phi }
        parameters {
            eta1 = dot(th)*cos(psi) + dot(phi)*sin(th)*sin(psi);
            eta2 = dot(th)*sin(psi) - dot(phi)*sin(th)*cos(psi);
            eta3 = dot(psi) + dot(phi)*cos(th);
        }
        constraints {
            c1: dot(x) - a*(dot(th)*sin(psi) - dot(phi)*sin(th)*cos(psi)) + Om0*y = 0;
            c2: dot(y) + a*(dot(th)*cos(psi) + dot(phi)*sin(th)*sin(psi)) - Om0*x = 0;
        }
        kinetic_energy = m*(dot(x)^2 + dot(y)^2)/2
                       + m*a^2/5*(dot(th)^2 + dot(psi)^2 + dot(phi)^2 + 2*dot(psi)*dot(phi)*cos(th));
    }
}

guen::mechanical_system! {
    /// A homogeneous ball on a table that turns at a varying speed.
    pub system BallVarying {
        constants { m > 0, a > 0, Om0, Om1, nu }
        coordinates { x, y, psi, th, phi }
        let speed = Om0 + Om1*sin(nu*t);
        parameters {
            eta1 = dot(th)*cos(psi) + dot(phi)*sin(th)*sin(psi);
            eta2 = dot(th)*sin(psi) - dot(phi)*sin(th)*cos(psi);
            eta3 = dot(psi) + dot(phi)*cos(th);
        }
        constraints {
            c1: dot(x) - a*(dot(th)*sin(psi) - dot(phi)*sin(th)*cos(psi)) + speed*y = 0;
            c2: dot(y) + a*(dot(th)*cos(psi) + dot(phi)*sin(th)*sin(psi)) - speed*x = 0;
        }
        kinetic_energy = m*(dot(x)^2 + dot(y)^2)/2
                       + m*a^2/5*(dot(th)^2 + dot(psi)^2 + dot(phi)^2 + 2*dot(psi)*dot(phi)*cos(th));
    }
}

guen::mechanical_system! {
    /// A free rigid body in Euler's angles and its angular velocity.
    pub system EulerTop {
        constants { I1 > 0, I2 > 0, I3 > 0 }
        coordinates { psi, th, phi }
        parameters {
            p = dot(psi)*sin(th)*sin(phi) + dot(th)*cos(phi);
            q = dot(psi)*sin(th)*cos(phi) - dot(th)*sin(phi);
            r = dot(psi)*cos(th) + dot(phi);
        }
        kinetic_energy = (I1*(dot(psi)*sin(th)*sin(phi) + dot(th)*cos(phi))^2
                        + I2*(dot(psi)*sin(th)*cos(phi) - dot(th)*sin(phi))^2
                        + I3*(dot(psi)*cos(th) + dot(phi))^2)/2;
    }
}
