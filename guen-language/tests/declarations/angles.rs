//! What the choice of angles costs: a system declared in relative angles, in absolute ones, or by rotations that are
//! composed, is one system, and its right-hand side may not cost much more in one declaration than in another.

use crate::common::derived;

/// The weighted operation count of the right-hand side, and the number of sines.
fn cost(text: &str) -> (u64, u32) {
    derived(text, |derived| {
        let cost = derived.system.programs.functions[0].cost;
        (cost.weighted(), cost.sines)
    })
}

fn list(links: usize, entry: impl Fn(usize) -> String, gap: &str) -> String {
    (1..=links).map(entry).collect::<Vec<_>>().join(gap)
}

/// A chain of point masses; `angles` are the words between the coordinates and the places `x_i, y_i`.
fn chain(links: usize, angles: &str, places: impl Fn(usize) -> String) -> String {
    format!(
        "pub system Chain {{
            constants {{ m > 0, l > 0, g = 9.81 }}
            coordinates {{ {} }}
            {angles}
            parameters {{ {} }}
            particles {{ {} }}
            gravity = vec(0, -g, 0);
        }}",
        list(links, |i| format!("q{i}"), ", "),
        list(links, |i| format!("w{i} = dot(q{i});"), " "),
        list(links, |i| format!("m at {};", places(i)), " "),
    )
}

fn absolute(links: usize) -> String {
    let lets =
        list(links, |i| format!("let x{i} = x{0} + l*sin(q{i}); let y{i} = y{0} - l*cos(q{i});", i - 1), " ");
    chain(links, &format!("let x0 = 0; let y0 = 0; {lets}"), |i| format!("vec(x{i}, y{i}, 0)"))
}

fn relative(links: usize) -> String {
    let lets = list(
        links,
        |i| {
            format!(
                "let s{i} = s{0} + q{i}; let x{i} = x{0} + l*sin(s{i}); let y{i} = y{0} - l*cos(s{i});",
                i - 1
            )
        },
        " ",
    );
    chain(links, &format!("let s0 = 0; let x0 = 0; let y0 = 0; {lets}"), |i| format!("vec(x{i}, y{i}, 0)"))
}

fn composed(links: usize) -> String {
    let lets =
        list(links, |i| format!("let R{i} = R{0}*rot_z(q{i}); let p{i} = p{0} - l*R{i}.y;", i - 1), " ");
    chain(links, &format!("let R0 = rot_z(0); let p0 = vec(0, 0, 0); {lets}"), |i| format!("p{i}"))
}

#[test]
fn relative_angles_cost_what_absolute_ones_do() {
    // Golden values; five links had 773 in relative angles and 1008 by rotations when sums were multiplied out.
    for (links, least) in [(2, [69, 73, 73]), (3, [137, 147, 147]), (5, [313, 341, 341])] {
        for (text, golden) in [absolute(links), relative(links), composed(links)].iter().zip(least) {
            let (weight, sines) = cost(text);
            println!("{links} links: {weight}");
            assert!(weight <= golden, "{links} links cost {weight}, not {golden}");
            assert_eq!(sines as usize, links);
        }
    }
}

#[test]
fn parallel_axes_in_space_add_up() {
    let arm = |axes: &str| {
        let joints = axes.len();
        let lets = list(
            joints,
            |i| {
                let axis = &axes[i - 1..i];
                let next =
                    if i < joints { format!("let p{i} = p{} + l*R{i}.x;", i - 1) } else { String::new() };
                format!("let R{i} = R{0}*rot_{axis}(q{i}); let c{i} = p{0} + l/2*R{i}.x; {next}", i - 1)
            },
            " ",
        );
        format!(
            "pub system Arm {{
                constants {{ m > 0, l > 0, A > 0, B > 0, C > 0, g = 9.81 }}
                coordinates {{ {} }}
                let R0 = rot_z(0); let p0 = vec(0, 0, 0);
                {lets}
                bodies {{ {} }}
                gravity = vec(0, 0, -g);
                parameters {{ {} }}
            }}",
            list(joints, |i| format!("q{i}"), ", "),
            list(
                joints,
                |i| format!("b{i} {{ mass: m, inertia: diag(A, B, C), center: c{i}, orientation: R{i} }}"),
                " "
            ),
            list(joints, |i| format!("w{i} = dot(q{i});"), " "),
        )
    };
    // 138 and 503 before turns about one axis were joined; 109 where an acceleration is put back into the other's
    // equation, which costs digits.
    for (axes, golden) in [("zyy", 113), ("zyyy", 202)] {
        let (weight, sines) = cost(&arm(axes));
        println!("{axes}: {weight}");
        assert!(weight <= golden, "{axes} costs {weight}, not {golden}");
        assert_eq!(sines as usize, axes.len() - 1);
    }
}

#[test]
fn a_heading_costs_nothing() {
    // A car with one trailer, in absolute and in relative headings: the accelerations do not depend on the heading.
    let car = |first: &str| {
        format!(
            "pub system Car {{
                constants {{ m > 0, I > 0, L > 0, d > 0, h > 0 }}
                inputs {{ push, steer }}
                coordinates {{ x, y, th0, th1, phi }}
                let R0 = rot_z(th0); {first} let F = R0*rot_z(phi);
                let p0 = vec(x, y, 0); let front = p0 + L*R0.x; let p1 = p0 - h*R0.x - d*R1.x;
                bodies {{
                    car {{ mass: m, inertia: diag(0, 0, I), center: p0 + L/3*R0.x, orientation: R0 }}
                    wheel {{ mass: m/10, inertia: diag(0, 0, I/10), center: front, orientation: F }}
                    trailer {{ mass: m/2, inertia: diag(0, 0, I/2), center: p1 + d/4*R1.x, orientation: R1 }}
                }}
                parameters {{ speed = inner(R0.x, dot(p0)); rate = dot(phi); }}
                constraints {{
                    rear: inner(R0.y, car.velocity_at(p0)) = 0;
                    steering: inner(F.y, wheel.velocity_at(front)) = 0;
                    axle: inner(R1.y, trailer.velocity_at(p1)) = 0;
                }}
                forces {{ push along speed; steer along dot(phi); }}
            }}"
        )
    };
    // 234 in absolute headings before; 146 where an acceleration is put back into the other's equation, which costs digits.
    for first in ["let R1 = rot_z(th1);", "let R1 = R0*rot_z(th1);", "let R1 = rot_z(th0 - th1);"] {
        let (weight, sines) = cost(&car(first));
        println!("{first}: {weight}");
        assert!(weight <= 166, "{first} costs {weight}");
        assert_eq!(sines, 3);
    }
}

#[test]
fn turns_that_meet_become_one() {
    let pendulum = |rotation: &str| {
        format!(
            "pub system Pendulum {{
                constants {{ m > 0, l > 0, g = 9.81 }}
                coordinates {{ q }}
                let R = {rotation};
                particles {{ m at -l*R.y; }}
                gravity = vec(0, -g, 0);
                parameters {{ w = dot(q); }}
            }}"
        )
    };
    let plain = cost(&pendulum("rot_z(q)"));
    for rotation in [
        "rot_z(q/2)*rot_z(q/2)",
        "rot_z(2*q)*transpose(rot_z(q))",
        "rot_x(q)*rot_y(1)*rot_y(-1)*rot_x(-q)*rot_z(q)",
        "rot(vec(0, 0, -1), q)*rot_z(2*q)",
    ] {
        assert_eq!(cost(&pendulum(rotation)), plain, "{rotation}");
    }
}
