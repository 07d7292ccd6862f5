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
