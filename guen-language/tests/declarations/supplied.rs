//! Functions that the program supplies: how often they are evaluated, what their calls cost, and which dimensions they have.

use crate::common::derived;

fn expanded(text: &str) -> String {
    guen_language::expand(text.parse().unwrap()).to_string()
}

/// A bead on a terrain by an equation, with a force of the same function elsewhere.
const BEAD: &str = "pub system Bead {
    constants   { m > 0, g = 9.81 }
    functions   { ground(x, y); }
    coordinates { x, y, z }
    holonomic   { on_ground: z = ground(x, y); }
    parameters  { u = dot(x); v = dot(y); }
    particles   { m at vec(x, y, z); }
    gravity     = vec(0, 0, -g);
    forces      { -ground(u, v) along u; }
}";

#[test]
fn derivatives_at_the_same_arguments_are_one_evaluation() {
    let text: String = expanded(BEAD).split_whitespace().collect();
    let start = text.find("rhs(t;").unwrap();
    let rates = &text[start..start + text[start..].find("velocities(t;").unwrap()];
    // `ground(x, y)` to the second order and `ground(u, v)` by itself.
    assert_eq!(rates.matches("derivatives_2(").count(), 1, "{rates}");
    assert_eq!(rates.matches("derivatives_0(").count(), 1, "{rates}");
    assert_eq!(rates.matches("__guen::derivatives_").count(), 2, "{rates}");
    // Five derivatives are used, and two calls are counted.
    assert!(rates.matches(".tangent[").count() >= 5, "{rates}");
    derived(BEAD, |derived| {
        let rates = derived.system.program("rhs").unwrap();
        assert_eq!(rates.cost.calls, 2);
    });
}

#[test]
fn other_systems_have_nothing_of_it() {
    let text = expanded(&BEAD.replace("functions   { ground(x, y); }", "fn ground(x, y) = x*y;"));
    for word in ["Function", "Hoisted", "Smooth", "derivatives_"] {
        assert!(!text.contains(word), "{word}");
    }
}

#[test]
fn dimensions_of_functions_follow_from_their_calls() {
    let cart = |force: &str| {
        format!(
            "pub system Cart {{ constants {{ m: kg > 0 }} functions {{ thrust(speed); }} coordinates {{ x: m }}
             parameters {{ v = dot(x); }} kinetic_energy = m/2*v^2; forces {{ {force} along v; }}
             outputs {{ push = thrust(2*v); }} }}"
        )
    };
    derived(&cart("thrust(v)"), |derived| assert_eq!(derived.model.units["push"], "N"));
    // A function has one dimension, and so has each argument.
    let wrong = expanded(&cart("thrust(v) + thrust(x)"));
    assert!(wrong.contains("an argument of `thrust` is in m/s, and this is in m"), "{wrong}");
    let wrong = expanded(&cart("m*thrust(v) + thrust(v)"));
    assert!(wrong.contains("this sum adds different dimensions"), "{wrong}");
}

#[test]
fn a_faulty_declaration_keeps_the_fields_of_its_functions() {
    let text = expanded(&BEAD.replace("-ground(u, v)", "-grund(u, v)"));
    assert!(
        text.contains("did you mean `ground`?") && text.contains("pub ground : GroundFunction"),
        "{text}"
    );
}

/// A cart with two tracks, the functions of which are those of the component.
const TRACKS: &str = "pub system Cart {
    component Slope(s: scalar) { functions { height(x); } fn twice(x) = 2*x; potential_energy = twice(height(twice(s))); }
    component Track(s: scalar) { use Slope as slope { s } }
    constants   { m > 0 }
    coordinates { x }
    parameters  { u = dot(x); }
    for i in 0..3 { use Track as track[i] { s: x } }
    use Slope as slope { s: 3*x }
    kinetic_energy = m/2*u^2;
}";

#[test]
fn functions_of_components_are_differentiated_as_those_of_systems() {
    derived(TRACKS, |derived| {
        let names: Vec<&str> =
            derived.model.functions.iter().map(|function| function.name.text.as_str()).collect();
        let [a, b, c] = ["track[0].slope.height", "track[1].slope.height", "track[2].slope.height"];
        assert_eq!(names, [a, b, c, "slope.height"]);
        assert_eq!(derived.system.program("rhs").unwrap().cost.calls, 4);
    });
}

#[test]
fn the_functions_of_an_array_have_one_type() {
    let text = expanded(TRACKS);
    let start = text.find("pub struct Cart").unwrap();
    let head: String = text[start..start + text[start..].find('{').unwrap()]
        .split_whitespace()
        .collect::<Vec<_>>()
        .join(" ");
    let [first, second] = ["TrackSlopeHeightFunction", "SlopeHeightFunction"];
    let kinds = [first, second].map(|kind| format!("{kind} = :: core :: primitive :: f64"));
    assert_eq!(head, format!("pub struct Cart < R = f64 , {} >", kinds.join(" , ")));
    let faulty = expanded(&TRACKS.replace("s: 3*x", "s: 3*y"));
    assert!(faulty.contains("unknown name `y`") && faulty.contains(first), "{faulty}");
}
