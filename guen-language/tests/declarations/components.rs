//! Components: a declaration with them is the one that is written out by hand.

use guen_language::derive::{derive, function};
use guen_language::diagnostics::collect;
use guen_language::syntax::Item;
use guen_language::{model, parse};

use crate::common::{derived, evaluated};

/// The bits of the rates at a state where every symbol has a value that follows from its name, in the order of the state, and
/// the cost of the right-hand side.
fn rates(text: &str, meaning: fn(&str) -> String) -> (Vec<u64>, String, Vec<String>) {
    derived(text, |derived| {
        let value = |symbol| {
            let name = meaning(&derived.model.bench.graph.symbol_info(symbol).name);
            name.bytes().fold(0.3, |value, byte| (value * 7.0 + f64::from(byte) / 50.0) % 1.7)
        };
        let rates = evaluated(&derived.system, function::RHS, value).expect("a right-hand side");
        let names = derived.model.coordinates.iter().map(|c| c.name.text.clone());
        let names = names.chain(derived.model.forms.iter().map(|form| form.name.clone())).collect();
        let programs = &derived.system.programs;
        let cost =
            format!("{:?}", programs.functions.iter().find(|f| f.name == function::RHS).map(|f| f.cost));
        (rates.into_iter().map(f64::to_bits).collect(), cost, names)
    })
}

fn faults(text: &str) -> String {
    let (declaration, parsed) = parse::parse(text.parse().unwrap());
    if !parsed.is_empty() {
        return parsed.to_string();
    }
    let declaration = declaration.unwrap();
    let (derived, report) = collect(|faults| derive(model::resolve(&declaration, faults)?, faults));
    assert!(derived.is_none(), "{text}");
    report.to_string()
}

const TROLLEY: &str = "pub system Trolley {
    component Wheel(hub: vector, axle: vector, forward: vector, radius: scalar) {
        constants   { mass > 0, spin_inertia > 0 = 0.1 }
        coordinates { angle }
        particles   { mass at hub; }
        kinetic_energy = 1/2*spin_inertia*dot(angle)^2;
        constraints { rolls: inner(dot(hub), forward) = radius*dot(angle); }
        outputs     { turned = angle; }
    }
    constants   { m > 0, J > 0, b > 0, r > 0 }
    inputs      { u }
    coordinates { x, y, heading }
    let p = vec(x, y, r);
    let ahead = vec(cos(heading), sin(heading));
    let side  = vec(-sin(heading), cos(heading));
    use Wheel as left  { hub: p + b*side, axle: side, forward: ahead, radius: r }
    use Wheel as right { hub: p - b*side, axle: side, forward: ahead, radius: r }
    particles   { m at p; }
    kinetic_energy = J/2*dot(heading)^2;
    constraints { grips: inner(dot(p), side) = 0; }
    forces      { u along dot(left.angle); }
    scene Straight { track left.angle; fix left.mass = 1; }
}";

/// The same, as somebody writes it who has no components.
const BY_HAND: &str = "pub system Trolley {
    constants   { m > 0, J > 0, b > 0, r > 0, left_mass > 0, left_spin_inertia > 0 = 0.1, right_mass > 0, right_spin_inertia > 0 = 0.1 }
    inputs      { u }
    coordinates { x, y, heading, left_angle, right_angle }
    let p = vec(x, y, r);
    let ahead = vec(cos(heading), sin(heading));
    let side  = vec(-sin(heading), cos(heading));
    let left_hub  = p + b*side;
    let right_hub = p - b*side;
    particles   { left_mass at left_hub; right_mass at right_hub; m at p; }
    constraints {
        left_rolls:  inner(dot(left_hub), ahead) = r*dot(left_angle);
        right_rolls: inner(dot(right_hub), ahead) = r*dot(right_angle);
        grips: inner(dot(p), side) = 0;
    }
    kinetic_energy = 1/2*left_spin_inertia*dot(left_angle)^2 + 1/2*right_spin_inertia*dot(right_angle)^2 + J/2*dot(heading)^2;
    forces      { u along dot(left_angle); }
    scene Straight { track left_angle; fix left_mass = 1; }
}";

#[test]
fn a_trolley_with_two_wheels_is_the_one_that_is_written_by_hand() {
    let by_hand = |name: &str| name.replace("left_", "left.").replace("right_", "right.");
    let (own, cost, names) = rates(TROLLEY, str::to_owned);
    let (hand, hand_cost, hand_names) = rates(BY_HAND, by_hand);
    let own_order = ["x", "y", "heading", "left.angle", "right.angle", "heading_rate", "left.angle_rate"];
    assert_eq!(names[..7], own_order);
    assert_eq!(hand_names.iter().map(|name| by_hand(name)).collect::<Vec<_>>(), names);
    assert_eq!(own, hand);
    assert_eq!(cost, hand_cost);
}

#[test]
fn instances_in_a_loop_are_those_that_are_written_one_by_one() {
    let wheels = |uses: &str, meaning: fn(&str) -> String| {
        let text = TROLLEY
            .replace("use Wheel as left  { hub: p + b*side, axle: side, forward: ahead, radius: r }", uses);
        let text =
            text.replace("use Wheel as right { hub: p - b*side, axle: side, forward: ahead, radius: r }", "");
        let text = text.replace(
            "u along dot(left.angle); }",
            if uses.contains("for i") { "u along dot(w[0].angle); }" } else { "u along dot(a.angle); }" },
        );
        let from = text.find("scene").unwrap();
        let (own, cost, names) = rates(&format!("{} }}", &text[..from]), meaning);
        (own, cost, names.iter().map(|name| meaning(name)).collect::<Vec<_>>())
    };
    let singly = wheels(
        "use Wheel as a { hub: p - b*side, axle: side, forward: ahead, radius: r }
         use Wheel as b1 { hub: p, axle: side, forward: ahead, radius: r }
         use Wheel as c { hub: p + b*side, axle: side, forward: ahead, radius: r }",
        |name| name.replace("a.", "w[0].").replace("b1.", "w[1].").replace("c.", "w[2]."),
    );
    let looped = wheels(
        "for i in 0..3 { use Wheel as w[i] { hub: p + (i - 1)*b*side, axle: side, forward: ahead, radius: r } }",
        str::to_owned,
    );
    assert_eq!(singly, looped);
    assert_eq!(looped.2[3..6], ["w[0].angle", "w[1].angle", "w[2].angle"]);
}

#[test]
fn components_use_others_and_loops() {
    let chain = "pub system Chain {
        component Link(base: vector) {
            constants { m > 0, l > 0 }
            coordinates { q }
            let tip = base + l*vec(sin(q), -cos(q));
            particles { m at tip; }
        }
        component Leg(base: vector) {
            count n = 2;
            use Link as upper { base }
            for i in 0..n { use Link as toe[i] { base: upper.tip } }
            let end = toe[n-1].tip;
            constants { k >= 0 = 1 }
            potential_energy = k/2*sum(i in 0..n: toe[i].q^2);
        }
        constants { g = 9.81, M > 0 }
        coordinates { x }
        particles { M at vec(x, 0); }
        gravity = vec(0, -g);
        for j in 0..2 { use Leg as leg[j] { base: vec(x + j, 0) } }
        forces { -1*dot(leg[1].toe[0].q) along leg[1].toe[0].q_rate; }
        outputs { foot = leg[0].end; }
        scene One { track leg[0]; fix leg[1].toe[0].m = 1, leg[0].k; }
    }";
    let faulty = faults(chain);
    assert!(faulty.contains("`leg[0].k`"), "{faulty}");
    let (_, _, names) = rates(&chain.replace(", leg[0].k", ""), str::to_owned);
    let own = [
        "x",
        "leg[0].upper.q",
        "leg[0].toe[0].q",
        "leg[0].toe[1].q",
        "leg[1].upper.q",
        "leg[1].toe[0].q",
        "leg[1].toe[1].q",
    ];
    assert_eq!(names[..7], own);
    assert_eq!(names[7..], own.map(|name| format!("{name}_rate")));
}

#[test]
fn faults_are_told_at_their_place() {
    let changed = |from: &str, to: &str| {
        assert!(TROLLEY.contains(from), "{from}");
        faults(&TROLLEY.replace(from, to))
    };
    let cases = [
        ("hub: p + b*side", "hub: x", "argument `hub` of `Wheel` is a vector, and this is a scalar"),
        ("hub: p + b*side, ", "", "`Wheel` is used without its argument `hub`"),
        ("hub: p + b*side", "hubb: p, hub: p", "`Wheel` has no argument `hubb`"),
        ("hub: p + b*side", "hub: p, mass: 1", "is a constant of `Wheel`"),
        ("use Wheel as left", "use Wheal as left", "unknown component `Wheal`\nhelp: did you mean `Wheel`?"),
        ("dot(left.angle)", "dot(angle)", "`angle` is private to the component that declares it"),
        ("dot(left.angle)", "dot(left.angel)", "has no `angel`\nhelp: did you mean `angle`?"),
        ("dot(left.angle)", "dot(left.radius)", "`radius` is private to component `Wheel`"),
        ("dot(left.angle)", "dot(left)", "`left` is an instance of `Wheel`, and no value"),
        ("radius*dot(angle)", "radius*dot(angle) + b", "unknown name `b` in component `Wheel`"),
        ("mass at hub", "mass at mass", "in `left`, a `Wheel`, used at line"),
        ("use Wheel as right", "use Wheel as left", "`left` is declared twice"),
        ("track left.angle", "track left.angel", "`left.angel`"),
        (
            "let p = vec(x, y, r);",
            "let p = vec(x, y, r) + 0*left.angle*vec(1, 0);",
            "`left` is used before it is declared",
        ),
    ];
    for (from, to, message) in cases {
        let found = changed(from, to);
        assert!(found.contains(message), "{from} -> {to}:\n{found}");
        assert!(found.matches("line ").count() <= 3, "{from} -> {to}:\n{found}");
    }
}

#[test]
fn scenes_by_loops_are_those_written_out() {
    let chain = |scenes: &str| {
        format!(
            "pub system Chain {{ count n = 4; constants {{ m[n] > 0, slope[2] = 5, g = 9.81 }} coordinates {{ q[n], x[2, 2] }}
             kinetic_energy = sum(i in 0..n: m[i]/2*dot(q[i])^2) + sum(i in 0..2: sum(j in 0..2: dot(x[i, j])^2));
             potential_energy = sum(i in 0..n: g*m[i]*sin(slope[0])*q[i]) + slope[1]*x[1, 0];
             outputs {{ for i in 0..2 {{ e[i] = q[i]; }} }} {scenes} }}"
        )
    };
    let expanded = |scenes: &str| {
        let text = guen_language::expand(chain(scenes).parse().unwrap()).to_string();
        assert!(!text.contains("compile_error"), "{}", &text[..400.min(text.len())]);
        // Without the list of names as they are written.
        let (before, behind) = text.split_once("uses ! (").unwrap();
        format!("{before}{}", behind.split_once(')').unwrap().1)
    };
    let by_loops = expanded(
        "scene S { for i in 0..n { if i % 2 == 0 { track q[i]; } else { fix m[i] = 2; } } for i in 0..2 { fix slope[i] = 10; provide e[i]; } }
         scene T { for i in 0..2 { for j in i..2 { track x[i, j]; } } if n > 4 { track q[5]; } fix slope = 30; }",
    );
    let by_hand = expanded(
        "scene S { track q[0]; fix m[1] = 2; track q[2]; fix m[3] = 2; fix slope[0] = 10; provide e[0]; fix slope[1] = 10; provide e[1]; }
         scene T { track x[0, 0], x[0, 1]; track x[1, 1]; fix slope[0] = 30; fix slope[1] = 30; }",
    );
    assert!(by_loops == by_hand);
}

#[test]
fn counts_as_arguments_are_numbers_of_the_instance() {
    let by_counts = "pub system Chains {
        component Chain(from: vector, links: count) {
            count last = links - 1;
            constants   { m > 0, l > 0 }
            coordinates { q[links] }
            let p[0] = from + l*vec(sin(q[0]), -cos(q[0]));
            for i in 1..links { let p[i] = p[i-1] + l*vec(sin(q[i]), -cos(q[i])); }
            let end = p[last];
            particles   { for i in 0..links { m/links at p[i]; } }
        }
        component Pair(from: vector, links: count) {
            use Chain as upper { from, links }
            use Chain as lower { from: upper.end, links: 2*links - links/2 - 2 }
        }
        count n = 3;
        gravity = vec(0, -9.81);
        use Pair as pair { from: vec(0, 0), links: n }
        for i in 0..2 { use Chain as chain[i] { from: vec(i, 1), links: i + 1 } }
    }";
    let by_hand = "pub system Chains {
        constants   { m_u > 0, l_u > 0, m_l > 0, l_l > 0, m_0 > 0, l_0 > 0, m_1 > 0, l_1 > 0 }
        coordinates { u_0, u_1, u_2, l0, l1, l2, a, b_0, b_1 }
        let p0 = l_u*vec(sin(u_0), -cos(u_0));
        let p1 = p0 + l_u*vec(sin(u_1), -cos(u_1));
        let p2 = p1 + l_u*vec(sin(u_2), -cos(u_2));
        let p3 = p2 + l_l*vec(sin(l0), -cos(l0));
        let p4 = p3 + l_l*vec(sin(l1), -cos(l1));
        let p5 = p4 + l_l*vec(sin(l2), -cos(l2));
        let r0 = vec(0, 1) + l_0*vec(sin(a), -cos(a));
        let s0 = vec(1, 1) + l_1*vec(sin(b_0), -cos(b_0));
        let s1 = s0 + l_1*vec(sin(b_1), -cos(b_1));
        gravity = vec(0, -9.81);
        particles {
            m_u/3 at p0; m_u/3 at p1; m_u/3 at p2; m_l/3 at p3; m_l/3 at p4; m_l/3 at p5;
            m_0 at r0; m_1/2 at s0; m_1/2 at s1;
        }
    }";
    let meaning = |name: &str| {
        let pairs = [("pair.upper.", "_u"), ("pair.lower.", "_l"), ("chain[0].", "_0"), ("chain[1].", "_1")];
        let coordinates = [
            ("pair.upper.q[0]", "u_0"),
            ("pair.upper.q[1]", "u_1"),
            ("pair.upper.q[2]", "u_2"),
            ("pair.lower.q[0]", "l0"),
            ("pair.lower.q[1]", "l1"),
            ("pair.lower.q[2]", "l2"),
            ("chain[0].q[0]", "a"),
            ("chain[1].q[0]", "b_0"),
            ("chain[1].q[1]", "b_1"),
        ];
        let rates = coordinates.map(|(own, hand)| (own.replace(".q[", ".q_rate["), format!("{hand}_rate")));
        let known = coordinates.iter().find(|(own, _)| *own == name).map(|(_, hand)| (*hand).to_owned());
        let rate = rates.iter().find(|(own, _)| own == name).map(|(_, hand)| hand.clone());
        let constant =
            pairs.iter().find_map(|(own, hand)| Some(format!("{}{hand}", name.strip_prefix(own)?)));
        known.or(rate).or(constant).unwrap_or_else(|| name.to_owned())
    };
    let (bits, cost, names) = rates(by_counts, meaning);
    assert_eq!(names.len(), 18);
    let (expected, expected_cost, _) = rates(by_hand, str::to_owned);
    assert_eq!((bits, cost), (expected, expected_cost));
}

#[test]
fn scenes_in_one_mode_have_rates_of_entries() {
    let text = "pub system Row {
        constants   { m > 0 }
        coordinates { q[2], x[2], y[2] }
        kinetic_energy = sum(i in 0..2: m/2*(dot(q[i])^2 + dot(x[i])^2 + dot(y[i])^2));
        parameters  { for i in 0..2 { v[i] = vec(dot(x[i]), dot(y[i])); } }
        contacts    { for i in 0..2 { low[i]: gap = q[i] + 1; } }
        scene Free  { modes { low: open; } track q, v[1]; }
    }";
    let expanded = guen_language::expand(text.parse().unwrap()).to_string();
    assert!(!expanded.contains("compile_error"), "{}", &expanded[..400]);
    assert!(expanded.contains("q_rate : [R ; 2usize]"));
}

/// A chain, and a component that uses one and has no loop itself.
const CHAINED: &str = "pub system Chained {
    component Chain(a: vector, n: count) {
        constants   { m > 0 }
        inputs      { u[n] }
        coordinates { q[n] }
        let e[0] = a;
        for i in 0..n { let e[i+1] = e[i] + vec(sin(q[i]), cos(q[i])); }
        parameters  { for i in 0..n { w[i] = dot(q[i]); } }
        particles   { for i in 0..n { m at e[i+1]; } }
        bodies      { for i in 0..n { b[i] { mass: m, center: e[i], inertia: diag(1, 1, 1), orientation: rot_z(q[i]) } } }
        states      { for i in 0..n { dot(s[i]) = q[i] - s[i]; } }
        switches    { for i in 0..n { past[i]: q[i] - 1; } }
        contacts    { for i in 0..n { end[i]: gap = e[i+1].y - 1/2; } }
        forces      { for i in 0..n { u[i] along w[i]; } }
        outputs     { for i in 0..n { turned[i] = q[i]; } }
    }
    component Wrap(a: vector) {
        use Chain as c { a, n: 2 }
        let tip = c.e[2];
        outputs { first = c.turned[1]; }
        forces  { -c.s[1] along c.w[1]; }
    }
    constants   { M > 0 }
    coordinates { x }
    particles   { M at vec(x, 0); }
    use Wrap as w { a: vec(x, 0) }
    use Chain as c { a: vec(x, 1), n: 2 }
    ITEMS
}";

#[test]
fn entries_of_an_instance_are_read_where_nothing_else_is_counted() {
    let uses = [
        "outputs { y = c.e[2]; }",
        "outputs { y = c.q[0]; }",
        "let ee = c.e[2]; outputs { y = ee.x; }",
        "outputs { y = w.c.e[1].x + w.tip.y; }",
        "outputs { y = c.b[1].center; }",
        "outputs { load = reaction(c.end[0]); clearance = gap(c.end[1]); }",
        "forces { -dot(c.q[1]) along c.w[1]; }",
        "forces { vec(1, 0) along dot(c.e[2]); }",
        "forces { c.past[0] along dot(x); }",
        "use Chain as d { a: c.e[2], n: 1 }",
        "scene S { track c.q[0], w.c.q[1]; provide c.turned[1]; }",
        "resets { r: c.e[1].y + x rises, x = 0; }",
    ];
    for items in uses {
        let (declaration, report) = parse::parse(CHAINED.replace("ITEMS", items).parse().unwrap());
        assert!(report.is_empty(), "{items}\n{report}");
        let declaration = declaration.unwrap();
        let (model, report) = collect(|faults| model::resolve(&declaration, faults));
        assert!(model.is_some() && report.is_empty(), "{items}\n{report}");
    }
    let items = "forces { -dot(c.q[1]) along dot(c.e[2]).x; }";
    let plain = rates(&CHAINED.replace("ITEMS", items), str::to_owned);
    let counted = rates(&CHAINED.replace("ITEMS", &format!("let _unused[0] = 1; {items}")), str::to_owned);
    assert_eq!(plain, counted);
}

#[test]
fn an_index_behind_a_point_is_not_passed_over() {
    let with_items = |items: &str| faults(&CHAINED.replace("ITEMS", items));
    let wrong = with_items("outputs { y = c.e[3]; }");
    assert!(wrong.contains("`c` has no entry `c.e[3]`"), "{wrong}");
    let wrong = with_items("outputs { y = w.tip[0]; }");
    assert!(wrong.contains("`w` has no entry `w.tip[0]`"), "{wrong}");
    let wrong = with_items("let p = vec(x, 0); outputs { y = p.x[0]; }");
    assert!(wrong.contains("`x` has no entries"), "{wrong}");
    let alone = "pub system Alone {
        coordinates { x }
        let p = vec(x, 0);
        particles { 1 at p; }
        outputs { y = p.x[0]; }
    }";
    let wrong = faults(alone);
    assert!(wrong.contains("a vector has the components `x`, `y` and `z`, and no `x[0]`"), "{wrong}");
}

#[test]
fn a_fault_in_an_index_behind_a_point_is_told_once() {
    let message =
        |index: &str| faults(&CHAINED.replace("ITEMS", &format!("outputs {{ y = c.q[{index}]; }}")));
    for (index, expected) in [
        ("k", "`k` is no count and no loop variable"),
        ("-1", "`q[-1]` is out of range"),
        ("1/0", "this index divides by zero"),
    ] {
        let found = message(index);
        assert!(found.contains(expected) && found.matches("line ").count() == 1, "{found}");
    }
    let found = faults(&CHAINED.replace("ITEMS", "scene S { track c.q[k]; }"));
    assert_eq!(found.matches("line ").count(), 1, "{found}");
}

#[test]
fn an_array_of_instances_in_an_instance_is_tracked_by_its_name() {
    let text = "pub system Rows {
        component Bob(a: vector) {
            constants   { m > 0 }
            coordinates { q[2] }
            particles   { m at a + vec(q[0], q[1]); }
            states      { dot(lag) = q[0] - lag; }
        }
        component Row(a: vector) {
            coordinates { z }
            particles   { 1 at a + vec(z, 0); }
            for i in 0..2 { use Bob as s[i] { a } }
        }
        component Block(a: vector) { for i in 0..2 { use Row as row[i] { a } } }
        coordinates { x }
        particles   { 1 at vec(x, 0); }
        use Block as o { a: vec(0, 0) }
        scene S { track NAMES; }
    }";
    let tracked = |names: &str| {
        let (declaration, report) = parse::parse(text.replace("NAMES", names).parse().unwrap());
        assert!(report.is_empty(), "{report}");
        let declaration = declaration.unwrap();
        let (model, report) = collect(|faults| model::resolve(&declaration, faults));
        assert!(model.is_some() && report.is_empty(), "{names}\n{report}");
        let scene = declaration.items.iter().find_map(|item| match item {
            Item::Scene(scene) => Some(scene.tracks.iter().map(|name| name.text.clone()).collect()),
            _ => None,
        });
        let mut names: Vec<String> = scene.unwrap();
        names.sort();
        names
    };
    assert_eq!(tracked("o.row[1].s"), tracked("o.row[1].s[0], o.row[1].s[1]"));
    assert_eq!(tracked("o.row"), tracked("o.row[0], o.row[1]"));
    assert_eq!(tracked("o.row"), tracked("o"));
    assert_eq!(tracked("o.row[0].s").len(), 6);
}
