//! The system graph that a declaration becomes: frames with their turns, bodies at places in them, forms and loads as they were
//! written.

use guen_language::diagnostics::collect;
use guen_symbolic::elimination_text;

/// The printed graph of a declaration.
fn structure(text: &str) -> String {
    let (declaration, faults) = guen_language::parse::parse(text.parse().unwrap());
    assert!(faults.is_empty(), "{}", faults.to_compile_errors());
    let declaration = declaration.unwrap();
    let (text, faults) = collect(|faults| {
        let model = guen_language::model::resolve(&declaration, faults)?;
        let names: Vec<String> = model.forms.iter().map(|form| form.name.clone()).collect();
        Some(model.mechanics.structure.text(&model.bench.graph, &names))
    });
    assert!(faults.is_empty(), "{}", faults.to_compile_errors());
    text.unwrap()
}

#[track_caller]
fn shows(text: &str, lines: &[&str]) {
    let found = structure(text);
    let expected: String = lines.iter().map(|line| format!("{line}\n")).collect();
    assert!(found == expected, "{found}");
}

#[test]
fn frames_hang_on_each_other_as_they_were_multiplied() {
    shows(
        "system Robot {
            constants { m > 0, I > 0, J > 0, l > 0, tilt, g = 9.81 }
            inputs { motor }
            coordinates { x, y, yaw, roll, arm, slide }
            let A = rot_z(yaw)*rot_x(roll);
            let B = A*rot_y(tilt)*rot_z(arm);
            let p = vec(x, y, 0);
            bodies {
                base { mass: m, inertia: diag(I, I, J), center: p, orientation: A }
                link { mass: m, inertia: sym(I, I, J, 0, 0, I/3), center: p + A*vec(0, 0, l) + (l/2 + slide)*B.x, orientation: B }
            }
            particles { m at p + A*vec(0, l, 0) - l*B.y; }
            gravity = vec(0, 0, -g);
            parameters { v = transpose(A)*dot(p); w = angular_velocity_body(A); bend = dot(arm); out = dot(slide); }
            forces { motor*B.z along link.angular_velocity - base.angular_velocity; }
        }"
        .replace("v = transpose(A)*dot(p); w = angular_velocity_body(A);", "u = dot(x); v = dot(y); turn = dot(yaw); lean = dot(roll);")
        .as_str(),
        &[
            "frame #1: in world about (0, 0, 1) by yaw",
            "frame A: in #1 about (1, 0, 0) by roll",
            "frame #3: in A about (0, 1, 0) by tilt",
            "frame B: in #3 about (0, 0, 1) by arm",
            "body base: m at (x, y, 0), inertia (I, I, J) in A",
            "body link: m at (x, y, 0) + A*(0, 0, l) + B*(1/2*l + slide, 0, 0), inertia (I, I, J, 0, 0, 1/3*I) in B",
            "particle: m at (x, y, 0) + A*(0, l, 0) + B*(0, -l, 0)",
            "gravity (0, 0, -g)",
            "load along (1, 0, 0): spin of B + -1 spin of A",
            "load along (0, 1, 0): spin of B + -1 spin of A",
            "load along (0, 0, 1): spin of B + -1 spin of A",
        ],
    );
}

#[test]
fn a_rolling_wheel_is_a_rate_and_a_lever() {
    shows(
        "system Disc {
            constants { m > 0, I > 0, J > 0, r > 0, g = 9.81 }
            coordinates { x, y, z, yaw, lean, turn }
            let F = rot_z(yaw)*rot_x(lean);
            let p = vec(x, y, z);
            bodies { disc { mass: m, inertia: diag(I, J, I), center: p, orientation: F*rot_y(turn) } }
            gravity = vec(0, 0, -g);
            parameters { spin = angular_velocity_body(F); }
            constraints { rolling: disc.velocity_at(p - r*F.z) = 0; }
        }",
        &[
            "frame #1: in world about (0, 0, 1) by yaw",
            "frame F: in #1 about (1, 0, 0) by lean",
            "frame disc: in F about (0, 1, 0) by turn",
            "body disc: m at (x, y, z), inertia (I, J, I) in disc",
            "gravity (0, 0, -g)",
            "form spin_y: along F*(0, 1, 0): spin of F",
            "form spin_z: along F*(0, 0, 1): spin of F",
            "form rolling_x: along (1, 0, 0): rate of ((x, y, z)) + spin of disc x (F*(0, 0, -r))",
            "form rolling_y: along (0, 1, 0): rate of ((x, y, z)) + spin of disc x (F*(0, 0, -r))",
            "form rolling_z: along (0, 0, 1): rate of ((x, y, z)) + spin of disc x (F*(0, 0, -r))",
        ],
    );
}

#[test]
fn loops_edges_and_moving_belts_keep_what_they_are_made_of() {
    shows(
        "system Loop {
            constants { m > 0, a > 0, b > 0, u, r > 0, d > 0 }
            coordinates { p, q, x }
            let A = rot_z(p);
            let B = rot_z(q);
            bodies {
                one { mass: m, inertia: diag(0, 0, m), center: a*A.x, orientation: A }
                two { mass: m, inertia: diag(0, 0, m), center: a*A.x + b*B.x, orientation: B }
            }
            particles { m at vec(x, 0); }
            holonomic { closed: a*A.x + b*B.x = vec(x, d); }
            constraints { belt: inner(A.y, two.velocity_at(vec(x, d)) - vec(u, 0)) = r*dot(p) - r*dot(p); }
        }"
        .replace(
            "constraints { belt: inner(A.y, two.velocity_at(vec(x, d)) - vec(u, 0)) = r*dot(p) - r*dot(p); }",
            "parameters { turn = inner(A.y, two.velocity_at(a*A.x) - vec(u, 0))/r; }",
        )
        .as_str(),
        &[
            "frame A: in world about (0, 0, 1) by p",
            "frame B: in world about (0, 0, 1) by q",
            "body one: m at A*(a, 0, 0), inertia (0, 0, m) in A",
            "body two: m at A*(a, 0, 0) + B*(b, 0, 0), inertia (0, 0, m) in B",
            "particle: m at (x, 0, 0)",
            "form turn: along A*(0, 1, 0): 1/r rate of (A*(a, 0, 0)) + 1/r ((-u, 0, 0))",
            "form closed_x: along (1, 0, 0): rate of ((-x, -d, 0) + A*(a, 0, 0) + B*(b, 0, 0))",
            "form closed_y: along (0, 1, 0): rate of ((-x, -d, 0) + A*(a, 0, 0) + B*(b, 0, 0))",
        ],
    );
    // A contact that is found by the length of a vector; only frames of which something speaks are shown.
    let disc = structure(
        "system Edge {
            constants { m > 0, I > 0, J > 0, r > 0 }
            coordinates { x, y, w, i, j, k }
            let R = quaternion(w, i, j, k);
            let unused = rot_x(w);
            let up = vec(0, 0, 1);
            let p = vec(x, y, r);
            let low = p - r*unit(up - inner(up, R.z)*R.z);
            bodies { disc { mass: m, inertia: diag(I, I, J), center: p, orientation: R } }
            parameters { spin = angular_velocity_body(R); }
            constraints { east: disc.velocity_at(low).x = 0; north: disc.velocity_at(low).y = 0; }
            holonomic { whole: w^2 + i^2 + j^2 + k^2 = 1; }
            outputs { idle = unused.x; }
        }",
    );
    for line in [
        "frame R: in world by a rotation",
        "length sqrt(",
        "form east: along (1, 0, 0): rate of ((x, y, r)) + spin of R x (",
        "form spin_x: along R*(1, 0, 0): spin of R",
    ] {
        assert!(disc.contains(line), "{disc}");
    }
    assert!(!disc.contains("unused") && !disc.contains("form whole"), "{disc}");
}

/// The height of a point of contact changes as fast as the body moves there, and is written so where other constraints speak of that velocity.
#[test]
fn the_height_of_a_contact_is_a_component_of_a_velocity() {
    let disc = |rows: &str| {
        structure(&format!(
            "system Edge {{
                constants {{ m > 0, I > 0, J > 0, r > 0 }}
                coordinates {{ x, y, z, yaw, lean, turn }}
                let R = rot_z(yaw)*rot_x(lean)*rot_z(turn);
                let up = vec(0, 0, 1);
                let p = vec(x, y, z);
                let low = p - r*unit(up - inner(up, R.z)*R.z);
                bodies {{ disc {{ mass: m, inertia: diag(I, I, J), center: p, orientation: R }} }}
                holonomic {{ on: low.z = 0; high: (p + R.z).z = 2; }}
                constraints {{ {rows} }}
            }}"
        ))
    };
    let rolling = "form on: along (0, 0, 1): rate of ((x, y, z)) + spin of R x (";
    for rows in [
        "east: disc.velocity_at(low).x = 0; north: disc.velocity_at(low).y = 0;",
        "track: inner(cross(R.z, up), disc.velocity_at(low)) = 0;",
    ] {
        let graph = disc(rows);
        assert!(
            graph.contains(rolling)
                && graph.contains("form high: along (0, 0, 1): rate of ((x, y, z) + #2*(0, 0, 1))\n"),
            "{graph}"
        );
    }
    assert!(!disc("still: dot(yaw) = 0;").contains(rolling));
}

/// The page that tells the way from a body to its rates shows the graph of its own declaration.
#[test]
fn the_page_shows_the_graph_of_its_declaration() {
    let page = include_str!("../../../docs/design/derivation.md");
    let mut blocks = page.split("```text\n").skip(1).map(|rest| rest.split("```").next().unwrap());
    let (declaration, shown) = (blocks.next().unwrap(), blocks.next().unwrap());
    let graph = structure(declaration);
    for line in shown.lines() {
        assert!(graph.lines().any(|other| other == line), "{line}\nis not in\n{graph}");
    }
    let is_tree = |line: &&str| line.starts_with("frame") || line.starts_with("body");
    assert_eq!(graph.lines().filter(is_tree).count(), shown.lines().filter(is_tree).count());
}

/// The page shows which unknowns follow from what, and the patterns of the matrices, as they are today.
#[test]
fn the_page_shows_the_patterns_of_its_matrices() {
    let page = include_str!("../../../docs/design/derivation.md");
    let declaration = page.split("```text\n").nth(1).unwrap().split("```").next().unwrap();
    let (declaration, _) = guen_language::parse::parse(declaration.parse().unwrap());
    let declaration = declaration.unwrap();
    let (found, _) = collect(|faults| {
        let mut model = guen_language::model::resolve(&declaration, faults)?;
        elimination_text(&mut model.bench, &model.mechanics)
    });
    let found = found.unwrap();
    let missing = found.split("\n\n").filter(|part| !page.contains(part.trim_end()));
    let missing: Vec<&str> = missing.collect();
    assert!(missing.is_empty(), "the page does not show\n{}", missing.join("\n\n"));
}
