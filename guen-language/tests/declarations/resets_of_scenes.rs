//! Resets of scenes: which ones a scene keeps, and what it keeps because of them.

use crate::common::derived;
use guen_language::derive::DerivedLevel;
use guen_language::model::Model;

/// The names of what a scene keeps, of its resets, each with the variables that it changes, and of its switches; `None` for those of a
/// smooth system.
fn kept(model: &Model<'_>, level: &DerivedLevel) -> (Vec<String>, Option<Vec<String>>) {
    let variables = &level.selection.variables;
    let name = |place: usize| model.variable_name(variables[place]);
    let resets = level.contacts.as_ref().zip(model.contacts.as_ref()).map(|(facts, contacts)| {
        let resets = facts.resets.iter().map(|reset| {
            let changed: Vec<&str> = reset.assignments.iter().map(|(_, place)| name(*place)).collect();
            format!("{}: {}", contacts.resets[reset.reset].name, changed.join(" "))
        });
        let switches = facts.switches.iter().map(|switch| contacts.switches[*switch].name.text.clone());
        resets.chain(switches).collect()
    });
    ((0..variables.len()).map(|place| name(place).to_owned()).collect(), resets)
}

/// Compares the scenes of a declaration with what they should keep: variables, and the resets with what they change and the switches, or
/// `-` for a smooth system.
fn compare(system: &str, scenes: &[(&str, &str, &[&str])]) {
    let written: Vec<String> =
        scenes.iter().enumerate().map(|(i, (scene, ..))| format!("scene S{i} {{ {scene} }}")).collect();
    derived(&system.replace("SCENES", &written.join(" ")), |derived| {
        for (i, (scene, names, resets)) in scenes.iter().enumerate() {
            let several = derived.scenes.iter().find(|level| level.scene.as_ref().unwrap().index == i);
            let one = derived.in_modes.iter().find(|(index, _)| *index == i);
            let (found, of_resets) = match (several, one) {
                (Some(level), None) => kept(&derived.model, level),
                (None, Some((_, own))) => kept(&own.model, &own.scenes[0]),
                _ => panic!("{scene}"),
            };
            assert_eq!(found.join(" "), *names, "{scene}");
            let expected = (*resets != ["-"]).then(|| resets.iter().map(|r| (*r).to_owned()).collect());
            assert_eq!(of_resets, expected, "{scene}");
        }
    });
}

/// Two bodies that know nothing of each other, a clock, a counter, and a state that a force reads.
const APART: &str = "system Apart {
    constants { m > 0, k > 0, period > 0, e }
    coordinates { x, y }
    parameters { v = dot(x); w = dot(y); }
    kinetic_energy = m/2*(v^2 + w^2);
    states { dot(clock) = 1; dot(hits) = 0; dot(gain) = 0; dot(idle) = 0; }
    switches { far: y - 3; near: x - 1; }
    forces { -k*x along v; -k*gain*y*far along w; }
    resets {
        wall: x falls, v = -e*v, hits = hits + 1;
        tick: clock - period rises, clock = 0, gain = near*v;
        stop: y - 5 rises, w = 0;
    }
    outputs { seen = x + w; }
    SCENES
}";

#[test]
fn a_scene_has_the_resets_of_what_it_keeps() {
    compare(
        APART,
        &[
            // The counter is left out of the reset of the body.
            ("track x;", "x v", &["wall: v"]),
            ("track hits;", "x v hits", &["wall: v hits"]),
            // The force reads the gain, which the clock sets to a velocity of the other body where that is near.
            ("track y;", "x y v w clock gain", &["wall: v", "tick: clock gain", "stop: w", "far", "near"]),
            ("track clock;", "clock", &["tick: clock"]),
            // No reset changes it.
            ("track idle;", "idle", &["-"]),
            ("track clock, x;", "x v clock", &["wall: v", "tick: clock"]),
            (
                "track clock; provide seen;",
                "x y v w clock gain",
                &["wall: v", "tick: clock gain", "stop: w", "far", "near"],
            ),
            ("fix idle; track clock;", "clock", &["tick: clock"]),
            ("fix k = 2; track v;", "x v", &["wall: v"]),
        ],
    );
}

/// A reset that another body decides about keeps that body.
#[test]
fn a_reset_keeps_what_it_reads() {
    let system = "system Read {
        constants { m > 0 }
        coordinates { x, y, z }
        parameters { u = dot(x); v = dot(y); w = dot(z); }
        kinetic_energy = m/2*(u^2 + v^2 + w^2);
        states { dot(n) = 0; }
        resets { meets: y - x rises, u = v, n = n + 1; leaves: z rises, v = 1; all: z - 1 rises, n = 0, w = -w; }
        SCENES
    }";
    compare(
        system,
        &[
            ("track x;", "x y z u v w", &["meets: u", "leaves: v", "all: w"]),
            ("track y;", "y z v w", &["leaves: v", "all: w"]),
            ("track w;", "z w", &["all: w"]),
            ("track n;", "x y z u v w n", &["meets: u n", "leaves: v", "all: n w"]),
        ],
    );
}

/// A ball above a floor, one that the floor holds, and a reset that throws it up.
const RACKET: &str = "system Racket {
    constants { m > 0, up, height, g, mu >= 0 }
    coordinates { x, z }
    parameters { u = dot(x); w = dot(z); }
    kinetic_energy = m/2*(u^2 + w^2);
    potential_energy = m*g*z;
    states { dot(clock) = 1; dot(ticks) = 0; }
    contacts { floor: gap = z, slip = u, friction = mu; }
    resets { racket: z - height falls, w = up; tick: clock - 1 rises, clock = 0, ticks = ticks + 1; }
    outputs { force = reaction(floor); }
    SCENES
}";

#[test]
fn scenes_in_modes_have_the_resets_of_what_they_keep_and_of_what_rests() {
    compare(
        RACKET,
        &[
            ("track z;", "z u w", &["racket: w"]),
            ("modes { floor: slip; }", "z u w", &["racket: w"]),
            // The height is zero in these modes, unless the racket changes that.
            ("modes { floor: stick, slip; } track u;", "z u w", &["racket: w"]),
            ("modes { floor: stick; } track clock;", "z w clock", &["racket: w", "tick: clock"]),
            ("modes { floor: open; } track u;", "z u w", &["racket: w"]),
        ],
    );
    // Without the racket nothing moves the row of the floor.
    let clocked = RACKET.replace("racket: z - height falls, w = up;", "");
    compare(
        &clocked,
        &[
            ("modes { floor: stick, slip; } track u;", "u", &[]),
            ("modes { floor: stick, slip; } track u, clock;", "u clock", &["tick: clock"]),
            ("modes { floor: slip; } track u, ticks;", "u clock ticks", &["tick: clock ticks"]),
            ("modes { floor: open; } track x;", "x u", &["-"]),
            ("modes { floor: open; } track ticks;", "z u w clock ticks", &["tick: clock ticks"]),
        ],
    );
}

/// An equation that a reset may break eliminates no coordinate, and a variable that jumps is not recovered as an integral.
#[test]
fn resets_keep_the_equations_that_they_may_break() {
    let system = |resets: &str| {
        format!(
            "system Belt {{
                constants {{ m > 0, k > 0 }}
                coordinates {{ x, y, s }}
                parameters {{ v = dot(x); r = dot(s); }}
                holonomic {{ belt: x + y = 0; }}
                kinetic_energy = m/2*(dot(x)^2 + dot(y)^2 + r^2);
                forces {{ -k*y along v; }}
                states {{ dot(sum) = s; dot(count) = 0; }}
                resets {{ {resets} }}
                SCENES
            }}"
        )
    };
    // `y` is `-x`, and either leaves.
    compare(&system("far: s - 1 rises, s = 0;"), &[("track v;", "y v", &["-"])]);
    compare(
        &system("turn: x - 1 rises, x = -x, y = -y;"),
        &[("track v;", "x y v", &["turn: x y"]), ("track s;", "s r", &["-"])],
    );
    compare(&system("turn: s - 1 rises, y = 2;"), &[("track v;", "x y s v r", &["turn: y"])]);
    for (resets, expected) in [
        ("far: x - 1 rises, v = 0;", vec![vec!["s", "sum"]; 1]),
        ("far: x - 1 rises, v = 0, s = 0;", Vec::new()),
        ("far: x - 1 rises, v = 0, sum = 0;", vec![vec!["s"]]),
    ] {
        let text = system(resets).replace("SCENES", "scene Turns { track r; } scene Moves { track v, r; }");
        derived(&text, |derived| {
            for name in ["Turns", "Moves"] {
                let is_it = |index: usize| derived.model.scenes[index].scene.name.text == name;
                let several = derived.scenes.iter().find(|level| is_it(level.scene.as_ref().unwrap().index));
                let one = derived.in_modes.iter().find(|(index, _)| is_it(*index));
                let (model, level) = match (several, one) {
                    (Some(level), _) => (&derived.model, level),
                    (_, Some((_, own))) => (&own.model, &own.scenes[0]),
                    _ => panic!("{name}"),
                };
                let names = |layer: &Vec<guen_language::derive::Quadrature>| {
                    let names = layer.iter().map(|known| model.variable_name(known.place).to_owned());
                    names.filter(|name| !["x", "y", "v", "count"].contains(&name.as_str())).collect()
                };
                let layers: Vec<Vec<String>> =
                    level.scene.as_ref().unwrap().quadratures.iter().map(names).collect();
                let layers: Vec<String> = layers.into_iter().flatten().collect();
                let expected: Vec<&str> = expected.iter().flatten().copied().collect();
                assert_eq!(layers, expected, "{resets} {name}");
            }
        });
    }
}
