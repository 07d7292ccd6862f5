//! The text of declarations of robots with limbs on a floating body, and of a chain whose tip is held.
//!
//! Text for the same reasons as in `chains`.

use std::fmt::Write;

/// A link: its carrier, the axis of its joint, and where the joint is in the carrier.
pub type Link = (usize, char, &'static str);

/// A trunk with two legs of six joints, two arms of four, two joints of the chest and two of the neck.
pub const HUMANOID: [Link; 24] = [
    (0, 'z', "0, -l/4, -l/3"),
    (1, 'x', "0, 0, 0"),
    (2, 'y', "0, 0, 0"),
    (3, 'y', "0, 0, -l"),
    (4, 'y', "0, 0, -l"),
    (5, 'x', "0, 0, 0"),
    (0, 'z', "0, l/4, -l/3"),
    (7, 'x', "0, 0, 0"),
    (8, 'y', "0, 0, 0"),
    (9, 'y', "0, 0, -l"),
    (10, 'y', "0, 0, -l"),
    (11, 'x', "0, 0, 0"),
    (0, 'z', "0, 0, l/3"),
    (13, 'y', "0, 0, l/4"),
    (14, 'y', "0, -l/3, l/2"),
    (15, 'x', "0, 0, 0"),
    (16, 'z', "0, 0, 0"),
    (17, 'y', "0, 0, -l"),
    (14, 'y', "0, l/3, l/2"),
    (19, 'x', "0, 0, 0"),
    (20, 'z', "0, 0, 0"),
    (21, 'y', "0, 0, -l"),
    (14, 'z', "0, 0, l"),
    (23, 'y', "0, 0, l/6"),
];

/// A trunk with four legs of three joints.
pub fn quadruped() -> String {
    let corners = ["l, l/2, 0", "l, -l/2, 0", "-l, l/2, 0", "-l, -l/2, 0"];
    let legs = corners.iter().enumerate().flat_map(|(leg, corner)| {
        let hip = 3 * leg + 1;
        [(0, 'x', *corner), (hip, 'y', "0, l/4, 0"), (hip + 1, 'y', "0, 0, -l")]
    });
    declaration(&legs.collect::<Vec<_>>())
}

/// A trunk with two legs of three joints, its orientation a quaternion.
pub fn biped_on_quaternion() -> String {
    let legs = ["0, l/2, 0", "0, -l/2, 0"].iter().enumerate().flat_map(|(leg, corner)| {
        let hip = 3 * leg + 1;
        [(0, 'x', *corner), (hip, 'y', "0, l/4, 0"), (hip + 1, 'y', "0, 0, -l")]
    });
    on_quaternion(&declaration(&legs.collect::<Vec<_>>()))
}

/// Rods on ball joints, the first one on the ground: each with a quaternion of its own, in the world or in the rod before.
pub fn rods(count: usize, is_relative: bool) -> String {
    let list = |entry: &dyn Fn(usize) -> String| (1..=count).map(entry).collect::<Vec<_>>();
    let turn = |i: usize| format!("quaternion(w{i}, x{i}, y{i}, z{i})");
    let lets = list(&|i| {
        let (old, turn) = (i - 1, turn(i));
        let before = if is_relative { format!("R{old}*") } else { String::new() };
        format!(
            "let R{i} = {before}{turn}; let c{i} = e{old} + l{i}/2*R{i}.x; let e{i} = e{old} + l{i}*R{i}.x;"
        )
    });
    format!(
        "pub system Rods {{ constants {{ g = 9.81, {} }} coordinates {{ {} }} let R0 = rot_z(0); let e0 = vec(0, 0, 0); {} \
         holonomic {{ {} }} bodies {{ {} }} parameters {{ {} }} gravity = vec(0, 0, -g); }}",
        list(&|i| format!("l{i} > 0, m{i} > 0, I{i} > 0, J{i} > 0")).join(", "),
        list(&|i| format!("w{i}, x{i}, y{i}, z{i}")).join(", "),
        lets.join(" "),
        list(&|i| format!("unit{i}: w{i}^2 + x{i}^2 + y{i}^2 + z{i}^2 = 1;")).join(" "),
        list(&|i| format!(
            "B{i} {{ mass: m{i}, inertia: diag(J{i}, I{i}, I{i}), center: c{i}, orientation: R{i} }}"
        ))
        .join(" "),
        list(&|i| format!("spin{i} = angular_velocity_body({});", turn(i))).join(" "),
    )
}

/// The same rods, each with a quaternion and its centre as coordinates, pinned to each other by holonomic equations.
pub fn pinned_rods(count: usize) -> String {
    let list = |entry: &dyn Fn(usize) -> String| (1..=count).map(entry).collect::<Vec<_>>();
    let turn = |i: usize| format!("quaternion(w{i}, x{i}, y{i}, z{i})");
    let pin = |i: usize| match i {
        1 => "p1 - l1/2*R1.x = vec(0, 0, 0)".to_owned(),
        _ => format!("p{0} + l{0}/2*R{0}.x = p{i} - l{i}/2*R{i}.x", i - 1),
    };
    format!(
        "pub system Rods {{ constants {{ g = 9.81, {} }} coordinates {{ {} }} {} holonomic {{ {} }} bodies {{ {} }} \
         parameters {{ {} }} gravity = vec(0, 0, -g); }}",
        list(&|i| format!("l{i} > 0, m{i} > 0, I{i} > 0, J{i} > 0")).join(", "),
        list(&|i| format!("a{i}, b{i}, c{i}, w{i}, x{i}, y{i}, z{i}")).join(", "),
        list(&|i| format!("let R{i} = {}; let p{i} = vec(a{i}, b{i}, c{i});", turn(i))).join(" "),
        list(&|i| format!("unit{i}: w{i}^2 + x{i}^2 + y{i}^2 + z{i}^2 = 1; pin{i}: {};", pin(i))).join(" "),
        list(&|i| format!(
            "B{i} {{ mass: m{i}, inertia: diag(J{i}, I{i}, I{i}), center: p{i}, orientation: R{i} }}"
        ))
        .join(" "),
        list(&|i| format!("spin{i} = angular_velocity_body({});", turn(i))).join(" "),
    )
}

/// Rods on hinges at right angles to both of their rods, each with a quaternion and its centre as coordinates: pins and hinges are
/// holonomic equations.
pub fn hinged_rods(count: usize) -> String {
    let list = |entry: &dyn Fn(usize) -> String| (1..=count).map(entry).collect::<Vec<_>>();
    let joint = |i: usize| match i {
        1 => "pin1: p1 - l1/2*R1.x = vec(0, 0, 0); across1: R1.z.x = 0; along1: R1.z.y = 0;".to_owned(),
        _ => format!(
            "pin{i}: p{i} - l{i}/2*R{i}.x = p{old} + l{old}/2*R{old}.x; across{i}: inner(R{i}.z, R{old}.z) = 0; \
             along{i}: inner(R{i}.z, R{old}.x) = 0;",
            old = i - 1
        ),
    };
    let turn = |i: usize| match i {
        1 => "angular_velocity_body(R1).z".to_owned(),
        _ => format!("inner(R{i}.z, angular_velocity(R{i}) - angular_velocity(R{}))", i - 1),
    };
    format!(
        "pub system Rods {{ constants {{ g = 9.81, {} }} coordinates {{ {} }} {} holonomic {{ {} {} }} bodies {{ {} }} \
         parameters {{ {} }} gravity = vec(0, -g, 0); }}",
        list(&|i| format!("l{i} > 0, m{i} > 0, I{i} > 0")).join(", "),
        list(&|i| format!("a{i}, b{i}, c{i}, w{i}, x{i}, y{i}, z{i}")).join(", "),
        list(&|i| format!(
            "let R{i} = quaternion(w{i}, x{i}, y{i}, z{i}); let p{i} = vec(a{i}, b{i}, c{i});"
        ))
        .join(" "),
        list(&|i| format!("unit{i}: w{i}^2 + x{i}^2 + y{i}^2 + z{i}^2 = 1;")).join(" "),
        list(&joint).join(" "),
        list(&|i| format!(
            "B{i} {{ mass: m{i}, inertia: diag(0, I{i}, I{i}), center: p{i}, orientation: R{i} }}"
        ))
        .join(" "),
        list(&|i| format!("turn{i} = {};", turn(i))).join(" "),
    )
}

/// A crane: a tower that slews, a boom that luffs, a cable of so many segments in space and a load on a hook beside its centre.
pub fn crane(segments: usize) -> String {
    format!(
        "pub system Crane {{
            count n = {segments};
            constants {{
                J > 0, mb > 0, Jb > 0, L > 0, m > 0, l > 0, P > 0, A > 0, B > 0, C > 0, h > 0, c >= 0, g = 9.81
            }}
            inputs {{ slew, luff }}
            coordinates {{ yaw, pitch, a[n], b[n], turn, roll, tilt }}
            let R = rot_z(yaw);
            let S = R*rot_y(-pitch);
            let tip = L*S.x;
            let p[0] = tip + l*vec(sin(a[0])*cos(b[0]), sin(b[0]), -cos(a[0])*cos(b[0]));
            for i in 1..n {{ let p[i] = p[i-1] + l*vec(sin(a[i])*cos(b[i]), sin(b[i]), -cos(a[i])*cos(b[i])); }}
            let Q = rot_z(turn)*rot_x(roll)*rot_y(tilt);
            bodies {{
                tower {{ mass: 0, center: vec(0, 0, 0), inertia: diag(J, J, J), orientation: R }}
                boom {{ mass: mb, center: tip/2, inertia: diag(0, Jb, Jb), orientation: S }}
                load {{ mass: P, center: p[n-1] - h*Q.z, inertia: diag(A, B, C), orientation: Q }}
            }}
            particles {{ for i in 0..n {{ m at p[i]; }} }}
            gravity = vec(0, 0, -g);
            forces {{
                slew along dot(yaw);
                luff along dot(pitch);
                for i in 0..n {{ -c*dot(a[i]) along dot(a[i]); }}
            }}
        }}"
    )
}

/// A declaration with a quaternion for the angles of the first body.
pub fn on_quaternion(declaration: &str) -> String {
    let [orientation, angles] = ["rot_z(yaw)*rot_y(pitch)*rot_x(roll)", "yaw, pitch, roll"];
    let text = declaration.replace(orientation, "quaternion(qw, qx, qy, qz)");
    let text = text.replace(angles, "qw, qx, qy, qz");
    text.replace("parameters {", "holonomic { length: qw^2 + qx^2 + qy^2 + qz^2 = 1; } parameters {")
}

/// Bodies of general inertia that hang on each other, the first of them floating.
pub fn declaration(links: &[Link]) -> String {
    let constants = |b: usize| {
        let entries = ["x", "y", "z"].map(|c| format!("I{b}{c} > 0, P{b}{c}, c{b}{c}"));
        format!("m{b} > 0, {}", entries.join(", "))
    };
    let all: Vec<String> = (0..=links.len()).map(constants).collect();
    let angles: Vec<String> = (1..=links.len()).map(|i| format!("q{i}")).collect();
    let mut text = format!(
        "pub system Robot {{
            constants {{ l > 0, g = 9.81, {} }}
            coordinates {{ x, y, z, yaw, pitch, roll, {} }}
            let A0 = rot_z(yaw)*rot_y(pitch)*rot_x(roll);
            let p0 = vec(x, y, z);\n",
        all.join(", "),
        angles.join(", "),
    );
    for (i, (carrier, axis, place)) in (1..).zip(links) {
        let _ = writeln!(text, "let A{i} = A{carrier}*rot_{axis}(q{i});");
        let _ = writeln!(text, "let p{i} = p{carrier} + A{carrier}*vec({place});");
    }
    text.push_str("bodies {");
    for b in 0..=links.len() {
        let _ = writeln!(
            text,
            "b{b} {{ mass: m{b}, inertia: sym(I{b}x, I{b}y, I{b}z, P{b}x, P{b}y, P{b}z),
                center: p{b} + A{b}*vec(c{b}x, c{b}y, c{b}z), orientation: A{b} }}"
        );
    }
    text.push_str("} gravity = vec(0, 0, -g);");
    text.push_str("parameters { v = transpose(A0)*dot(p0); w = angular_velocity_body(A0);");
    for angle in &angles {
        let _ = write!(text, "turn_{angle} = dot({angle});");
    }
    text + "} }"
}

/// A chain of seven joints about oblique axes, the fourth a slide, whose tip is held by three equations.
pub fn held() -> String {
    let axes = ["0, 1, -1", "2, 1, -2", "1, 0, 1", "", "1, 2, 2", "0, 1, -1", "2, 1, -2"];
    let list = |entry: &dyn Fn(usize) -> String| (1..=axes.len()).map(entry).collect::<String>();
    let place = |i: usize| {
        let (before, base) = match i {
            1 => (String::new(), String::new()),
            _ => (format!("R{}*", i - 1), format!("o{} + ", i - 1)),
        };
        match axes[i - 1] {
            "" => format!(
                "let R{i} = R{0}; let o{i} = {base}{before}vec(l{i}, 0, 1/3) + q{i}*{before}vec(4/5, 0, -3/5);",
                i - 1
            ),
            axis => format!(
                "let R{i} = {before}rot(unit(vec({axis})), q{i}); let o{i} = {base}{before}vec(l{i}, 1/4, 1/3);"
            ),
        }
    };
    format!(
        "pub system Held {{
            constants {{ g = 9.81, {} }}
            coordinates {{ {} }}
            {}
            holonomic {{ tip: o7 + R7*vec(1/2, 0, 1/3) = vec(3/2, 0, 0); }}
            bodies {{ {} }}
            parameters {{ w1 = dot(q1); w2 = dot(q2); w3 = dot(q3); w4 = dot(q4); }}
            gravity = vec(0, 0, -g);
        }}",
        list(&|i| format!("l{i} > 0, m{i} > 0, J{i} > 0, K{i} > 0, L{i} > 0, ")),
        list(&|i| format!("q{i}, ")),
        list(&place),
        list(&|i| format!(
            "B{i} {{ mass: m{i}, inertia: diag(J{i}, K{i}, L{i}), center: o{i} + R{i}*vec(1/2, 0, l{i}), orientation: R{i} }}"
        )),
    )
}

/// A floating body on three legs of three joints, mounted at a third of a turn from each other and tilted by a constant.
pub fn tripod() -> String {
    "pub system Tripod {
        count n = 3;
        constants { M > 0, A > 0, B > 0, C > 0, m > 0, J > 0, K > 0, L > 0, r > 0, l > 0, tilt, twist, g = 9.81 }
        coordinates { x, y, z, yaw, pitch, roll, q[n], e[n], k[n] }
        let R = rot_z(yaw)*rot_y(pitch)*rot_x(roll);
        let c = vec(x, y, z);
        for i in 0..n {
            let U[i] = R*rot_z(2*pi/3*i)*rot_x(tilt)*rot_z(q[i])*rot_x(twist);
            let V[i] = U[i]*rot_z(e[i]);
            let W[i] = V[i]*rot_y(k[i]);
            let hip[i] = c + R*rot_z(2*pi/3*i)*vec(r, 0, 0);
            let knee[i] = hip[i] + l*V[i].x;
        }
        bodies {
            plate { mass: M, inertia: diag(A, B, C), center: c, orientation: R }
            for i in 0..n {
                hip_link[i] { mass: m, inertia: diag(J, K, L), center: hip[i] + l/5*U[i].x, orientation: U[i] }
                thigh[i] { mass: m, inertia: diag(J, K, L), center: hip[i] + l/2*V[i].x, orientation: V[i] }
                shank[i] { mass: m, inertia: diag(J, K, L), center: knee[i] + l/2*W[i].x, orientation: W[i] }
            }
        }
        gravity = vec(0, 0, -g);
        parameters {
            v = dot(c);
            w = angular_velocity_body(R);
            for i in 0..n { a[i] = dot(q[i]); b[i] = dot(e[i]); d[i] = dot(k[i]); }
        }
    }"
    .to_owned()
}
