//! Families that are longer than the size up to which equations are written out: what is derived of them grows with their members.

use std::fmt::Write;

use guen_language::diagnostics::collect;
use guen_language::report::ReportLines;
use guen_language::{derive, emit, model, parse};

/// The size of an expansion.
struct Size {
    operations: f64,
    bytes: f64,
    report: String,
    has_mass: bool,
}

fn size(text: &str) -> Size {
    let (parsed, report) = parse::parse(text.parse().unwrap());
    assert!(report.is_empty(), "{report}");
    let parsed = parsed.unwrap();
    let (model, report) = collect(|faults| model::resolve(&parsed, faults));
    assert!(report.is_empty(), "{report}");
    let (derived, report) = collect(|faults| derive::derive(model.unwrap(), faults));
    assert!(report.is_empty(), "{report}");
    let derived = derived.unwrap();
    let rates = derived.system.program(derive::function::RHS).unwrap().cost;
    let has_mass = derived.system.program(derive::function::MASS_FORM).is_some();
    let report = ReportLines::of(&derived.model, &derived.system).to_text();
    let bytes = emit::emit(derived).to_string().len() as f64;
    Size { operations: f64::from(rates.operations() + rates.sines + rates.calls), bytes, report, has_mass }
}

fn chain(n: usize) -> String {
    format!(
        "pub system Chain {{
            count n = {n};
            constants {{ m[n] > 0, l[n] > 0 = 0.1, c >= 0, g = 9.81 }}
            coordinates {{ q[n] }}
            let p[0] = l[0]*vec(sin(q[0]), -cos(q[0]));
            for i in 1..n {{ let p[i] = p[i-1] + l[i]*vec(sin(q[i]), -cos(q[i])); }}
            parameters {{ for i in 0..n {{ w[i] = dot(q[i]); }} }}
            particles {{ for i in 0..n {{ m[i] at p[i]; }} }}
            forces {{ for i in 1..n {{ -c*(w[i] - w[i-1]) along w[i] - w[i-1]; }} }}
            gravity = vec(0, -g);
        }}"
    )
}

#[test]
fn a_long_chain_costs_for_each_link_what_a_short_one_costs() {
    let [short, middle, long] = [20, 66, 132].map(|n| size(&chain(n)));
    let each = |size: &Size, n: f64| size.operations / n;
    assert!(each(&long, 132.0) < 1.3 * each(&short, 20.0), "{}", long.operations);
    assert!(each(&long, 132.0) < 1.05 * each(&middle, 66.0), "{}", long.operations);
    assert!(long.bytes < 1.2 * middle.bytes, "{} {}", middle.bytes, long.bytes);
    // Written out, a link takes five kilobytes.
    assert!(long.bytes < 80_000.0, "{}", long.bytes);
    assert!(!long.has_mass && short.has_mass);
    assert!(long.report.contains("not written out: of 132 parameters"), "{}", long.report);
    assert!(!short.report.contains("not written out"), "{}", short.report);
    assert!(long.report.contains("\n  and 84 more\n"), "{}", long.report);
    assert!(long.report.lines().count() < 400 && !short.report.contains(" more\n"), "{}", long.report);
}

/// Between the sizes from which equations are put up over the links, and from which they are not written out.
#[test]
fn equations_of_a_chain_grow_with_the_square_of_its_links() {
    let [half, whole] = [30, 60].map(|n| size(&chain(n)));
    assert!(half.has_mass && whole.has_mass);
    // Multiplied out, an entry of the mass matrix has a term for each link behind both: 5.6 times.
    assert!(whole.bytes < 4.0 * half.bytes, "{} {}", half.bytes, whole.bytes);
    assert!(whole.operations < 2.1 * half.operations, "{} {}", half.operations, whole.operations);
}

/// The centre and the inertia of a slender rod.
const SLENDER: &str = "center: tip[i] - l/2*turn[i].x, inertia: diag(0, J, J)";

/// Rods of which each is turned against the one before it by some joints.
fn rods(n: usize, coordinates: &str, joints: &str, body: &str) -> Size {
    size(&format!(
        "pub system Rods {{
            count n = {n};
            constants {{ m > 0, l > 0, J > 0, g = 9.81 }}
            coordinates {{ {coordinates} }}
            let turn[0] = {first};
            for i in 1..n {{ let turn[i] = turn[i-1]*{joints}; }}
            let tip[0] = l*turn[0].x;
            for i in 1..n {{ let tip[i] = tip[i-1] + l*turn[i].x; }}
            bodies {{
                for i in 0..n {{
                    rod[i] {{ mass: m, {body}, orientation: turn[i] }}
                }}
            }}
            gravity = vec(0, -g, 0);
        }}",
        first = joints.replace('i', "0")
    ))
}

/// A place is written along turns by the sums of the angles, an orientation by one joint after the other: the same axes.
#[test]
fn a_rod_on_a_hinge_costs_what_any_other_costs() {
    let [short, middle, long] = [6, 40, 200].map(|n| rods(n, "q[n]", "rot_z(q[i])", SLENDER));
    assert!(middle.operations < 63.0 * 40.0, "{}", middle.operations);
    assert!(long.operations < 68.0 * 200.0, "{}", long.operations);
    assert!(short.has_mass && middle.has_mass && !long.has_mass);
}

/// Thirty bodies of any inertia on two hinges each have fewer parameters than the size from which equations are not written out, and
/// equations that are too much work.
#[test]
fn bodies_whose_equations_are_too_much_work_have_rates() {
    let of_any_inertia =
        "center: tip[i] + turn[i]*vec(-l/2, l/3, l/5), inertia: sym(J, J/2, J/3, J/5, J/7, J/11)";
    let [written, work] = [10, 30].map(|n| rods(n, "q[n], p[n]", "rot_z(q[i])*rot_y(p[i])", of_any_inertia));
    assert!(written.has_mass && !work.has_mass);
    assert!(work.report.contains("not written out: of 60 parameters"), "{}", work.report);
    assert!(work.operations < 1.2 * 3.0 * written.operations, "{}", work.operations);
}

/// Parts that springs alone join cost what each costs by itself, and are no more work for being many.
#[test]
fn parts_that_only_forces_couple_cost_what_each_costs() {
    let bodies = |n: usize, kind: &str| {
        size(&format!(
            "pub system Parts {{
                count n = {n};
                constants {{ m > 0, I > 0, r > 0, k, g = 9.81 }}
                coordinates {{ x[n], y[n], {z} qw[n], qx[n], qy[n], qz[n] }}
                for i in 0..n {{ let turn[i] = quaternion(qw[i], qx[i], qy[i], qz[i]); let p[i] = vec(x[i], y[i], {height}); }}
                holonomic {{ for i in 0..n {{ length[i]: qw[i]^2 + qx[i]^2 + qy[i]^2 + qz[i]^2 = 1; }} }}
                bodies {{ for i in 0..n {{ body[i] {{ mass: m, inertia: {inertia}, center: p[i], orientation: turn[i] }} }} }}
                parameters {{ for i in 0..n {{ {parameters} }} }}
                constraints {{ {rolling} }}
                potential_energy = sum(i in 1..n: k/2*inner(p[i] - p[i-1], p[i] - p[i-1]));
                gravity = vec(0, 0, -g);
            }}",
            z = if kind == "free" { "z[n]," } else { "" },
            height = if kind == "free" { "z[i]" } else { "r" },
            inertia = if kind == "free" { "diag(I, 2*I, 5/2*I)" } else { "diag(I, I, I)" },
            parameters = if kind == "free" {
                "v[i] = dot(p[i]); w[i] = angular_velocity_body(turn[i]);"
            } else {
                "w[i] = angular_velocity(turn[i]);"
            },
            rolling = if kind == "free" {
                String::new()
            } else {
                let row = |a: &str| {
                    format!("roll_{a}[i]: body[i].velocity_at(p[i] - vec(0, 0, r)).{a} = 0;")
                };
                format!("for i in 0..n {{ {} {} }}", row("x"), row("y"))
            },
        ))
    };
    for (kind, each) in [("free", 64.0), ("rolling", 48.0)] {
        let [few, many] = [4, 16].map(|n| bodies(n, kind));
        assert!(few.operations < each * 4.0 && many.operations < each * 16.0, "{kind}: {}", many.operations);
        assert!(few.has_mass && many.has_mass);
    }
}

/// Springs between beams have sums as factors, which are shorter as the projection gave them than multiplied out, however many there are.
#[test]
fn beams_with_springs_cost_what_each_costs() {
    let beams = |n: usize| {
        size(&format!(
            "pub system Beams {{
                count n = {n};
                constants {{ m > 0, I > 0, l > 0, k, c, g = 9.81 }}
                coordinates {{ x[n], y[n], q[n] }}
                for i in 0..n {{ let end[i] = l/2*vec(cos(q[i]), sin(q[i])); let p[i] = vec(x[i], y[i]); }}
                kinetic_energy = sum(i in 0..n: m/2*inner(dot(p[i]), dot(p[i])) + I/2*dot(q[i])^2);
                potential_energy = sum(i in 0..n: m*g*y[i])
                    + sum(i in 1..n: k/2*norm(p[i] - end[i] - p[i-1] - end[i-1])^2 + c/2*(q[i] - q[i-1])^2);
            }}"
        ))
    };
    let [few, many] = [10, 20].map(beams);
    assert!(many.operations < 2.15 * few.operations, "{} {}", few.operations, many.operations);
}

/// A net of particles with a root for each spring: no point modulo the prime has all of them.
#[test]
fn nets_of_particles_have_as_many_springs_as_they_need() {
    let net = |n: usize| {
        size(&format!(
            "pub system Net {{
                count n = {n};
                constants {{ m > 0, k >= 0, l > 0, g = 9.81 }}
                coordinates {{ x[n, n], y[n, n], z[n, n] }}
                for i in 0..n {{ for j in 0..n {{ let p[i, j] = vec(x[i, j], y[i, j], z[i, j]); }} }}
                particles {{ for i in 0..n {{ for j in 0..n {{ m at p[i, j]; }} }} }}
                potential_energy = sum(i in 1..n: sum(j in 0..n: k/2*(norm(p[i, j] - p[i-1, j]) - l)^2))
                    + sum(i in 0..n: sum(j in 1..n: k/2*(norm(p[i, j] - p[i, j-1]) - l)^2));
                gravity = vec(0, 0, -g);
            }}"
        ))
    };
    let [small, large] = [6, 10].map(net);
    let springs = |n: f64| 2.0 * n * (n - 1.0);
    assert!(
        large.operations / springs(10.0) < 1.05 * small.operations / springs(6.0),
        "{}",
        large.operations
    );
    assert!(small.has_mass && !large.has_mass);
}

/// Each joint moves all links beyond it; in the rates of the base angles it moves one.
#[test]
fn a_long_chain_in_relative_angles_costs_for_each_link_what_a_short_one_costs() {
    let joints = |n: usize| {
        size(&format!(
            "pub system Joints {{
                count n = {n};
                constants {{ m[n] > 0, l[n] > 0 = 0.1, c >= 0, g = 9.81 }}
                coordinates {{ q[n] }}
                let a[0] = q[0];
                let p[0] = l[0]*vec(sin(a[0]), -cos(a[0]));
                for i in 1..n {{ let a[i] = a[i-1] + q[i]; let p[i] = p[i-1] + l[i]*vec(sin(a[i]), -cos(a[i])); }}
                parameters {{ for i in 0..n {{ w[i] = dot(q[i]); }} }}
                particles {{ for i in 0..n {{ m[i] at p[i]; }} }}
                forces {{ for i in 1..n {{ -c*w[i] along w[i]; }} }}
                gravity = vec(0, -g);
            }}"
        ))
    };
    let [short, stated, long] = [20, 40, 100].map(joints);
    let each = |size: &Size, n: f64| size.operations / n;
    assert!(each(&stated, 40.0) < 1.15 * each(&short, 20.0), "{}", stated.operations);
    assert!(each(&long, 100.0) < 1.3 * each(&short, 20.0), "{}", long.operations);
    assert!(stated.has_mass && stated.bytes < 1.0e6, "{}", stated.bytes);
    assert!(!long.has_mass && long.bytes < 3.0e5, "{}", long.bytes);
}

/// Chains that hang on a cart, whose links turn with inertias of their own, in relative angles and in absolute ones.
#[test]
fn chains_on_carts_and_with_inertias_are_taken_link_by_link() {
    let chain = |n: usize, first: &str, angle: &str, rest: &str| {
        size(&format!(
            "pub system Chain {{
                count n = {n};
                constants {{ M > 0, m[n] > 0, J[n] > 0, l[n] > 0, k >= 0, g = 9.81 }}
                coordinates {{ x, q[n] }}
                let a[0] = q[0];
                let p[0] = {first} + l[0]*vec(sin(a[0]), -cos(a[0]));
                for i in 1..n {{ let a[i] = {angle}; let p[i] = p[i-1] + l[i]*vec(sin(a[i]), -cos(a[i])); }}
                particles {{ M at vec(x, 0); for i in 0..n {{ m[i] at p[i]; }} }}
                gravity = vec(0, -g);
                {rest}
            }}"
        ))
    };
    let turning = "kinetic_energy = sum(i in 0..n: J[i]*dot(a[i])^2/2);";
    let springs = "potential_energy = sum(i in 0..n: k*q[i]^2/2);";
    for (first, angle, rest) in [
        ("vec(x, 0)", "q[i]", springs),
        ("vec(x, 0)", "a[i-1] + q[i]", springs),
        ("vec(0, 0)", "q[i]", turning),
        ("vec(0, 0)", "a[i-1] + q[i]", turning),
    ] {
        let [short, stated, long] = [20, 40, 70].map(|n| chain(n, first, angle, rest));
        let each = |size: &Size, n: f64| size.operations / n;
        assert!(stated.has_mass && stated.bytes < 1.0e6, "{angle} {rest} {}", stated.bytes);
        assert!(!long.has_mass && long.bytes < 2.5e5, "{angle} {rest} {}", long.bytes);
        // In relative angles the first links are irregular, and there are few others yet.
        let most = if angle == "q[i]" { 1.3 } else { 1.7 };
        assert!(
            each(&long, 70.0) < most * each(&short, 20.0),
            "{angle} {rest} {} {}",
            short.operations,
            long.operations
        );
    }
}

/// In polar coordinates the velocity `r phi'` is not the rate of any function of positions. No constraint force may be introduced along it.
#[test]
fn velocities_that_are_no_rates_are_not_taken_for_such() {
    let polar = size(
        "pub system Polar {
            count n = 15;
            constants { m[n] > 0, k > 0 }
            coordinates { r[n], phi[n] }
            kinetic_energy = sum(i in 0..n: m[i]/2*(dot(r[i])^2 + r[i]^2*dot(phi[i])^2)) + (dot(r[0]) + dot(r[1]))^2/2;
            potential_energy = sum(i in 0..n: k/2*r[i]^2);
        }",
    );
    // phi'' = -2 r' phi'/r and r'' = r phi'^2 - k/m r; the first two are coupled.
    assert!(polar.operations <= 10.0 * 15.0, "{}", polar.operations);
}

/// Systems whose mass matrix couples neighbours only, and those in relative angles, cost no more than before.
#[test]
fn coupled_neighbours_and_relative_angles_cost_what_they_did() {
    let neighbours = size(
        "pub system Row {
            count n = 30;
            constants { m[n] > 0, k > 0 }
            coordinates { x[n] }
            kinetic_energy = sum(i in 0..n: m[i]/2*dot(x[i])^2) + sum(i in 1..n: (dot(x[i]) + dot(x[i-1]))^2/2);
            potential_energy = sum(i in 1..n: k/2*(x[i] - x[i-1])^2);
        }",
    );
    assert!(neighbours.operations <= 204.0, "{}", neighbours.operations);
    let joints = size(
        "pub system Joints {
            count n = 30;
            constants { m > 0, l > 0, g = 9.81 }
            coordinates { q[n] }
            let a[0] = q[0];
            let p[0] = l*vec(sin(a[0]), -cos(a[0]));
            for i in 1..n { let a[i] = a[i-1] + q[i]; let p[i] = p[i-1] + l*vec(sin(a[i]), -cos(a[i])); }
            particles { for i in 0..n { m at p[i]; } }
            gravity = vec(0, -g);
        }",
    );
    assert!(joints.operations <= 470.0, "{}", joints.operations);
}

/// The momenta are the derivatives of the energy: of links behind a support that is moved, in parameters that mix, of a tree, in space.
#[test]
fn momenta_over_the_links_are_slopes_of_the_energy() {
    let chain = |constants: &str, start: &str, parameters: &str, before: &str| {
        format!(
            "pub system Links {{
                count n = 26;
                constants {{ m[n] > 0, l > 0, g = 9.81 {constants} }}
                coordinates {{ q[n] }}
                parameters {{ {parameters} }}
                let p[0] = {start} + l*vec(sin(q[0]), -cos(q[0]));
                for i in 1..n {{ let p[i] = p[{before}] + l*vec(sin(q[i]), -cos(q[i])); }}
                particles {{ for i in 0..n {{ m[i] at p[i]; }} }}
                gravity = vec(0, -g);
            }}"
        )
    };
    let mixed = "w[0] = dot(q[0]); for i in 1..n { w[i] = 2*dot(q[i]) - dot(q[i-1])/3; }";
    let space = "pub system Links {
        count n = 13;
        constants { m > 0, l > 0, k >= 0 }
        coordinates { a[n], b[n] }
        let p[0] = vec(cos(a[0])*cos(b[0]), sin(a[0])*cos(b[0]), sin(b[0]));
        for i in 1..n { let p[i] = p[i-1] + l*vec(cos(a[i])*cos(b[i]), sin(a[i])*cos(b[i]), sin(b[i])); }
        particles { for i in 0..n { m at p[i]; } }
        potential_energy = k*inner(p[n-1], p[n-1])/2;
    }";
    let cases = [
        chain("", "vec(0, 0)", "", "i-1"),
        chain(", a, W", "vec(a*sin(W*t), 0)", "", "i-1"),
        chain("", "vec(0, 0)", mixed, "i-1"),
        chain("", "vec(0, 0)", "", "(i-1)/2"),
        space.to_owned(),
    ];
    for text in cases {
        let (parsed, _) = parse::parse(text.parse().unwrap());
        let parsed = parsed.unwrap();
        let (derived, report) = collect(|faults| derive::derive(model::resolve(&parsed, faults)?, faults));
        assert!(report.is_empty(), "{report}");
        let mut derived = derived.unwrap();
        let (bench, derivation) = (&mut derived.model.bench, &derived.system.derivation);
        assert!(derivation.is_by("constraint forces"), "{text}");
        let without_others = derivation.declined.iter().any(|(_, why)| *why == "the parameters are many");
        assert!(without_others, "{:?} {text}", derivation.declined);
        assert_eq!(derivation.energies.momenta.len(), 26);
        for (momentum, eta) in derivation.energies.momenta.iter().zip(&derivation.system.etas) {
            let slope = bench.partial(derivation.energies.kinetic, *eta);
            let difference = bench.graph.sub(*momentum, slope);
            assert!(bench.vanishes(difference), "{text}");
        }
    }
}

/// A chain that is written out entry by entry against the same chain by a loop.
#[test]
fn a_long_chain_by_hand_is_the_same() {
    let n = 70;
    // In the order of the entries of the arrays: where terms stand in sums follows the order of the declaration.
    let mut text = String::from("pub system Chain { constants {");
    (0..n).for_each(|i| write!(text, "m{i} > 0, ").unwrap());
    (0..n).for_each(|i| write!(text, "l{i} > 0 = 0.1, ").unwrap());
    text.push_str("c >= 0, g = 9.81 } coordinates { q0");
    (1..n).for_each(|i| write!(text, ", q{i}").unwrap());
    text.push_str(" } let p0 = l0*vec(sin(q0), -cos(q0));");
    (1..n).for_each(|i| write!(text, "let p{i} = p{} + l{i}*vec(sin(q{i}), -cos(q{i}));", i - 1).unwrap());
    text.push_str(" parameters {");
    (0..n).for_each(|i| write!(text, "w{i} = dot(q{i});").unwrap());
    text.push_str(" } particles {");
    (0..n).for_each(|i| write!(text, "m{i} at p{i};").unwrap());
    text.push_str(" } forces {");
    (1..n).for_each(|i| write!(text, "-c*(w{i} - w{0}) along w{i} - w{0};", i - 1).unwrap());
    text.push_str(" } gravity = vec(0, -g); }");
    assert_eq!(size(&text).operations.to_bits(), size(&chain(n)).operations.to_bits());
}

#[test]
fn masses_that_nothing_couples_keep_their_mass_matrix() {
    let row = "pub system Row {
        count n = 80;
        constants { m[n] > 0, k > 0 }
        coordinates { x[n] }
        kinetic_energy = sum(i in 0..n: m[i]/2*dot(x[i])^2);
        potential_energy = k/2*x[0]^2 + sum(i in 1..n: k/2*(x[i] - x[i-1])^2);
    }";
    assert!(size(row).has_mass);
}

#[test]
fn a_long_chain_has_scenes_series_and_outputs() {
    let base = chain(65);
    let with = |more: &str| {
        let end = base.rfind('}').unwrap();
        format!("{}{more} }}", &base[..end])
    };
    for more in [
        "outputs { tip = p[n-1]; energy_of_last = m[n-1]/2*inner(dot(p[n-1]), dot(p[n-1])); }",
        "inputs { u } outputs { tip = u*p[n-1]; }",
        "states { dot(filtered) = q[n-1] - filtered; }",
        "scene Bare { fix c = 0; }",
        "contacts { floor: gap = 100 + p[n-1].y; }",
    ] {
        let found = size(&with(more));
        assert!(found.operations < 56.0 * 65.0, "{more}: {}", found.operations);
    }
}

/// Families in which velocities are written relative to others in many ways. What is derived of them is proved against the definition, so
/// that it is enough that something is.
#[test]
fn particles_are_taken_relative_to_what_they_are_written_with() {
    let family = |positions: &str, particles: &str| {
        format!(
            "pub system Family {{
                count n = 70;
                constants {{ m[n] > 0, M > 0, l > 0, g = 9.81 }}
                coordinates {{ q[n] }}
                {positions}
                particles {{ {particles} }}
                gravity = vec(0, -g);
            }}"
        )
    };
    let links = "for i in 1..n { let p[i] = p[i-1] + l*vec(sin(q[i]), -cos(q[i])); }";
    let all = "for i in 0..n { m[i] at p[i]; }";
    let cases = [
        // A support that time drives, with a mass of its own, and one that rests.
        (format!("let base = vec(sin(3*t), t^2); let p[0] = base + l*vec(sin(q[0]), -cos(q[0])); {links}"), format!("M at base; {all}")),
        // A support whose velocity has more than eight terms: the velocities of the links are written with that sum.
        (
            format!(
                "let base = vec(sum(k in 1..12: sin(k*t)/k), t^2);
                 let p[0] = base + l*vec(sin(q[0]), -cos(q[0])); {links}"
            ),
            format!("M at base; {all}"),
        ),
        (format!("let base = vec(1, 2); let p[0] = base + l*vec(sin(q[0]), -cos(q[0])); {links}"), format!("M at base; {all}")),
        // Two masses at every joint, one of them beside it.
        (
            format!("let p[0] = l*vec(sin(q[0]), -cos(q[0])); {links}"),
            format!("{all} for i in 0..n {{ M at p[i]; }}"),
        ),
        // A tree: every member hangs on the one with half its number.
        (
            "let p[0] = l*vec(sin(q[0]), -cos(q[0]));
             for i in 1..n { if i < 3 { let p[i] = p[0] + l*vec(sin(q[i]), -cos(q[i])); } else { let p[i] = p[i-2] + l*vec(sin(q[i]), -cos(q[i])); } }"
                .to_owned(),
            all.to_owned(),
        ),
        // Multiples of others, and nothing shared at all.
        (
            "let p[0] = l*vec(sin(q[0]), -cos(q[0])); for i in 1..n { let p[i] = p[i-1]/2 + l*vec(sin(q[i]), -cos(q[i])); }".to_owned(),
            all.to_owned(),
        ),
        ("for i in 0..n { let p[i] = vec(2*i + q[i], -q[i]); }".to_owned(), all.to_owned()),
    ];
    for (positions, particles) in cases {
        let found = size(&family(&positions, &particles));
        assert!(
            found.operations < 90.0 * 70.0 && found.bytes < 1_000_000.0,
            "{positions}: {} {}",
            found.operations,
            found.bytes
        );
    }
}

/// Bodies that attract each other in pairs, of which no loop is made: operations grow with the pairs.
#[test]
fn pairs_of_members_are_written_out() {
    let bodies = "pub system Bodies {
        count n = 24;
        constants { m[n] > 0, G > 0 }
        coordinates { x[n], y[n], z[n] }
        particles { for i in 0..n { m[i] at vec(x[i], y[i], z[i]); } }
        potential_energy = -sum(i in 1..n: sum(j in 0..i: G*m[i]*m[j]/sqrt((x[i]-x[j])^2 + (y[i]-y[j])^2 + (z[i]-z[j])^2)));
    }";
    let found = size(bodies);
    assert!(found.operations < 30.0 * 276.0, "{}", found.operations);
}

/// Of eight points modulo the prime hardly one has the roots of six lengths: numbered at none, seven bodies on six springs took 22,092 operations.
#[test]
fn bodies_on_many_springs_are_taken_body_by_body() {
    let moored = size(
        "pub system Moored {
            count n = 6;
            constants { m > 0, l > 0, J > 0, k >= 0, s, g = 9.81 }
            coordinates { x, y, z, yaw, pitch, roll, q[n] }
            let R[0] = rot_z(yaw)*rot_y(pitch)*rot_x(roll);
            let p[0] = vec(x, y, z);
            for i in 0..n {
                if i % 2 == 0 { let R[i+1] = R[i]*rot_z(q[i]); } else { let R[i+1] = R[i]*rot_y(q[i]); }
                let p[i+1] = p[i] + l*R[i+1].x;
            }
            for i in 0..n { let at[i] = s*i; }
            bodies { for i in 0..n+1 { b[i] { mass: m, inertia: diag(J, 2*J, 2*J), center: p[i], orientation: R[i] } } }
            potential_energy = sum(i in 0..n: k/2*(norm(p[i+1] - vec(at[i], 0, s)) - l)^2);
            gravity = vec(0, 0, -g);
        }",
    );
    assert!(moored.operations < 2_400.0, "{}", moored.operations);
}
