//! Twenty declarations of different kinds with a unit for every name, in which every dimension is right.

/// Each declaration has its own words: energies or bodies, forces of every kind, functions, states, scenes.
pub const TWENTY: [&str; 20] = [
    // 0: a hoop that rolls, by its energies.
    "system Hoop {
        constants { m: kg > 0, a: m > 0, A: kg*m^2 > 0, C: kg*m^2 > 0, g: m/s^2 = 9.81 }
        coordinates { theta: rad, psi: rad, phi: rad, xi: m, eta: m, zeta: m }
        parameters { eta1 = dot(theta); eta2 = dot(psi)*sin(theta); eta3 = dot(psi)*cos(theta) + dot(phi); }
        constraints {
            eta4: dot(xi) = a*sin(theta)*sin(psi)*dot(theta) - a*cos(theta)*cos(psi)*dot(psi) - a*cos(psi)*dot(phi);
            eta5: dot(eta) + a*sin(theta)*cos(psi)*dot(theta) + a*cos(theta)*sin(psi)*dot(psi) + a*sin(psi)*dot(phi) = 0;
            eta6: dot(zeta) - a*cos(theta)*dot(theta) = 0;
        }
        kinetic_energy = m/2*(dot(xi)^2 + dot(eta)^2 + dot(zeta)^2) + 1/2*(A*eta1^2 + A*eta2^2 + C*eta3^2);
        force_function = -m*a*g*sin(theta);
    }",
    // 1: a sled on a slope with a motor.
    "system Sled {
        constants { m: kg > 0, k: m > 0, alpha: m, slope: deg = 10, c: N*s/m >= 0, g: m/s^2 = 9.81 }
        inputs { thrust: N in -20..20 }
        coordinates { phi: rad, x: m, y: m }
        parameters { turning = dot(phi); speed = dot(x)*cos(phi) + dot(y)*sin(phi); }
        constraints { blade: dot(x)*sin(phi) = dot(y)*cos(phi); }
        let center_x = x + alpha*cos(phi);
        let center_y = y + alpha*sin(phi);
        kinetic_energy = m/2*(dot(center_x)^2 + dot(center_y)^2) + m/2*k^2*turning^2;
        force_function = m*g*sin(slope)*center_x;
        forces { thrust - c*speed along speed; }
        outputs { place = vec(center_x, center_y); side = reaction(blade); }
    }",
    // 2: a car with front steering.
    "system Car {
        constants { m: kg > 0, J: kg*m^2 > 0, base: m > 0, c: N*s/m >= 0 }
        inputs { thrust: N }
        coordinates { x: m, y: m, heading: rad, steering: rad }
        let rear = vec(x, y);
        let ahead = vec(cos(heading), sin(heading));
        let left = vec(-sin(heading), cos(heading));
        let front = rear + base*ahead;
        parameters { speed = inner(dot(rear), ahead); steer = dot(steering); }
        constraints {
            rear_grip: inner(dot(rear), left) = 0;
            front_grip: inner(dot(front), cos(steering)*left - sin(steering)*ahead) = 0;
        }
        particles { m at rear + base/2*ahead; }
        kinetic_energy = J/2*(dot(heading)^2 + dot(steering)^2);
        forces { thrust - c*speed along speed; }
        outputs { curvature = tan(steering)/base; }
    }",
    // 3: a ball on a table that turns.
    "system Ball {
        constants { m: kg > 0, a: m > 0, Omega: 1/s, J: kg*m^2 > 0 = 2/5*m*a^2 }
        coordinates { w: 1, i: 1, j: 1, k: 1, x: m, y: m, z: m }
        holonomic { unit_length: w^2 + i^2 + j^2 + k^2 = 1; on_table: z = a; }
        let contact = vec(x, y, 0);
        bodies { ball { mass: m, center: vec(x, y, z), inertia: diag(J, J, J), orientation: quaternion(w, i, j, k) } }
        let table = Omega*cross(vec(0, 0, 1), contact);
        parameters { spin = ball.angular_velocity; }
        constraints { rolling_x: ball.velocity_at(contact).x = table.x; rolling_y: ball.velocity_at(contact).y = table.y; }
    }",
    // 4: a coin.
    "system Coin {
        constants { m: kg = 0.1, r: m = 0.05, g: m/s^2 = 9.81, I: kg*m^2 = 1/4*m*r^2 }
        coordinates { x: m, y: m, z: m, heading: rad, lean: rad, roll: rad }
        let axes = rot_z(heading)*rot_x(lean);
        bodies { coin { mass: m, inertia: diag(I, I, 2*I), center: vec(x, y, z), orientation: axes*rot_z(roll) } }
        gravity = vec(0, 0, -g);
        constraints { contact: coin.velocity_at(coin.center - r*axes.y) = 0; }
        parameters { tipping = dot(lean); turning = dot(heading); spinning = dot(roll); }
        outputs { low = coin.center.z - r*sin(lean); }
    }",
    // 5: a pendulum on a cart, with a ramp.
    "system Cart {
        constants { m: kg > 0, M: kg > 0, l: m > 0 = 0.5, g: m/s^2 = 9.81, c: N*s/m >= 0, k: N/m, T: s > 0 }
        inputs { push: N in -10..10 }
        coordinates { x: m, q: rad }
        fn ramp(time) = tanh(time/T);
        let p = vec(x, 0) + l*vec(sin(q), -cos(q));
        parameters { v = dot(x); w = dot(q); }
        particles { M at vec(x, 0); m at p; }
        gravity = vec(0, -g);
        potential_energy = k/2*x^2;
        forces { push*ramp(t) - c*v along v; -c*l^2*w along w; }
        outputs { height = p.y; power = push*v; angle = atan2(p.y, p.x); }
        scene Still { fix l = 1/2; track q; }
    }",
    // 6: a motor with its current and its heat.
    "system Motor {
        constants { J: kg*m^2 > 0, R: Ohm > 0, L: H > 0, k: N*m/A, b: N*m*s >= 0, C: J/K > 0, loss: W/K >= 0, warm: 1/K }
        inputs { voltage: V in -12..12 }
        coordinates { phi: rad }
        parameters { omega = dot(phi); }
        let ohmic = R*(1 + warm*heat);
        states {
            dot(current: A) = (voltage - ohmic*current - k*omega)/L;
            dot(heat: K) = (ohmic*current^2 - loss*heat)/C;
        }
        kinetic_energy = J/2*omega^2;
        forces { k*current - b*omega along omega; }
        outputs { power = voltage*current; slope = dot(current); }
    }",
    // 7: a bead on a landscape.
    "system Bead {
        constants { m: kg > 0, h: m = 0.3, a: m = 1, w: m > 0 = 0.5, c: kg/m >= 0, g: m/s^2 = 9.81 }
        coordinates { x: m, y: m }
        fn bump(x, y) = h*exp(-(x^2 + y^2)/w^2);
        fn height(x) = bump(x - a, y) + bump(x + a, y);
        fn drag(v) = -c*norm(v)*v;
        let place = vec(x, y, height(x));
        particles { m at place; }
        gravity = vec(0, 0, -g);
        forces { drag(dot(place)) along dot(place); }
    }",
    // 8: a bead on a hoop that turns.
    "system Turning {
        constants { m: kg > 0, R: m > 0, Omega: 1/s, k: N*m >= 0, g: m/s^2 = 9.81 }
        coordinates { theta: rad }
        parameters { omega = dot(theta); }
        kinetic_energy = m/2*R^2*(omega^2 + Omega^2*sin(theta)^2);
        potential_energy = -m*g*R*cos(theta) + k*theta^2/2;
    }",
    // 9: four bars that close a loop.
    "system Bars {
        constants { m: kg > 0, a: m > 0, b: m > 0, c: m > 0, d: m > 0, g: m/s^2 = 9.81, damping: N*m*s >= 0 }
        coordinates { p: rad, q: rad, r: rad }
        let knee = a*vec(cos(p), sin(p));
        let hand = knee + b*vec(cos(q), sin(q));
        holonomic { closed: hand = vec(d, 0) + c*vec(cos(r), sin(r)); }
        parameters { w = dot(p); }
        particles { m at knee; m at hand; }
        gravity = vec(0, -g);
        forces { -damping*(w - dot(q)) along w - dot(q); }
    }",
    // 10: a quarter of a car on a road.
    "system Suspension {
        constants { body: kg > 0, wheel: kg > 0, k: N/m > 0, tyre: N/m > 0, c: N*s/m >= 0, bump: m, pace: m/s, wave: m > 0 }
        coordinates { z: m, u: m }
        fn road(s) = bump*sin(2*pi*s/wave);
        parameters { v = dot(z); w = dot(u); }
        kinetic_energy = body/2*v^2 + wheel/2*w^2;
        potential_energy = k/2*(z - u)^2 + tyre/2*(u - road(pace*t))^2;
        forces { -c*(v - w) along v - w; }
        outputs { comfort = dot(v); load = tyre*(road(pace*t) - u); }
    }",
    // 11: a satellite.
    "system Satellite {
        constants { m: kg > 0, mu: m^3/s^2 > 0, area: m^2 >= 0, density: kg/m^3, scale: m > 0, R: m > 0 }
        coordinates { r: m, phi: rad }
        parameters { climb = dot(r); turn = dot(phi); }
        kinetic_energy = m/2*(climb^2 + r^2*turn^2);
        force_function = m*mu/r;
        forces { -density*exp((R - r)/scale)*area*r*turn*sqrt(climb^2 + r^2*turn^2)/2 along r*turn; }
        outputs { energy_per_mass = (climb^2 + r^2*turn^2)/2 - mu/r; period = 2*pi*sqrt(r^3/mu); }
    }",
    // 12: a spherical pendulum in the plane of its rod.
    "system Rod {
        constants { m: kg > 0, l: m > 0, g: m/s^2 = 9.81 }
        coordinates { x: m, y: m }
        holonomic { rod: x^2 + y^2 = l^2; }
        parameters { v = (dot(x)*y - x*dot(y))/l; }
        particles { m at vec(x, y); }
        gravity = vec(0, -g, 0);
        outputs { pull = 2*l*reaction(rod); }
    }",
    // 13: a charge in a field.
    "system Charge {
        constants { m: kg > 0, q: C, B: T, E: V/m, pitch: 1/m }
        coordinates { x: m, y: m, z: m }
        let place = vec(x, y, z);
        let field = B*vec(0, 0, 1 + pitch*x);
        particles { m at place; }
        potential_energy = -q*E*x;
        forces { q*cross(dot(place), field) along dot(place); }
        outputs { frequency = q*norm(field)/m; }
    }",
    // 14: a heavy top.
    "system Top {
        constants { m: kg > 0, l: m > 0, A: kg*m^2 > 0, C: kg*m^2 > 0, g: m/s^2 = 9.81, drag: N*m*s >= 0 }
        coordinates { a: rad, b: rad, c: rad }
        let R = rot_z(a)*rot_x(b)*rot_z(c);
        bodies { top { mass: m, center: l*R.z, inertia: sym(A, A, C, 0, 0, 0), orientation: R } }
        gravity = vec(0, 0, -g);
        parameters { spin = angular_velocity_body(R); }
        forces { -drag*top.angular_velocity along top.angular_velocity; }
        outputs { nod = acos(R.z.z); swing = top.velocity_at(2*l*R.z); }
    }",
    // 15: a spring that is stretched between two particles.
    "system Spring {
        constants { m: kg > 0, k: N/m > 0, free: m > 0, c: N*s/m >= 0 }
        coordinates { x: m, y: m, u: m, v: m }
        let p = vec(x, y);
        let q = vec(u, v);
        let way = q - p;
        let stretch = norm(way) - free;
        particles { m at p; m at q; }
        potential_energy = k/2*stretch^2;
        forces { -c*inner(dot(way), unit(way)) along inner(dot(way), unit(way)); }
    }",
    // 16: a rocket that burns.
    "system Rocket {
        constants { full: kg > 0, burn: kg/s > 0, jet: m/s > 0, g: m/s^2 = 9.81, drag: kg/m >= 0 }
        coordinates { h: m }
        parameters { v = dot(h); }
        particles { full - burn*t at vec(0, h); }
        gravity = vec(0, -g);
        forces { burn*jet + burn*v - drag*v*abs(v) along v; }
        outputs { share = v/jet; left = full - burn*t; }
    }",
    // 17: a wheel whose tyre relaxes.
    "system Tyre {
        constants { m: kg > 0, I: kg*m^2 > 0, k: N/m > 0, sigma: m > 0, lever: m > 0, U: m/s > 0 }
        coordinates { y: m, psi: rad }
        parameters { v = dot(y); r = dot(psi); }
        states { dot(side: m) = v - lever*r + U*psi - U*side/sigma; }
        kinetic_energy = m/2*v^2 + I/2*r^2;
        forces { -k*side along v - lever*r; }
        outputs { force = k*side; slip = side/sigma; }
        scene Shimmy { track side; }
    }",
    // 18: an arm with two joints under a controller with integrators.
    "system Arm {
        constants { m1: kg > 0, m2: kg > 0, l1: m > 0, l2: m > 0, kp: N*m, ki: N*m/s, kd: N*m*s, g: m/s^2 = 9.81 }
        inputs { wanted: rad, torque: N*m }
        coordinates { q1: rad, q2: rad }
        let knee = l1*vec(sin(q1), -cos(q1));
        let hand = knee + l2*vec(sin(q1 + q2), -cos(q1 + q2));
        parameters { w1 = dot(q1); w2 = dot(q2); }
        states { dot(error: s) = wanted - q2; }
        particles { m1 at knee; m2 at hand; }
        gravity = vec(0, -g);
        forces { torque along w1; kp*(wanted - q2) + ki*error - kd*w2 along w2; }
        outputs { tip = hand; acceleration = dot(dot(hand)); }
    }",
    // 19: a trolley on a rope that a winch winds.
    "system Winch {
        constants { m: kg > 0, J: kg*m^2 > 0, r: m > 0, EA: N > 0, length: m > 0, eta: Pa*s*m^2 >= 0, slope: rad, g: m/s^2 = 9.81 }
        inputs { torque: N*m }
        coordinates { s: m, phi: rad }
        let strain = (s + r*phi)/length;
        parameters { v = dot(s); omega = dot(phi); }
        kinetic_energy = m/2*v^2 + J/2*omega^2;
        potential_energy = EA*length/2*strain^2 + m*g*s*sin(slope);
        forces { torque along omega; -eta*dot(strain) along length*dot(strain); }
        outputs { tension = EA*strain + eta*dot(strain); power = torque*omega; }
    }",
];
