//! Faults beside components that are imported, which are told before the compiler looks for these.

use guen_language::{expand, expand_component, expand_component_with, expand_with};

use crate::random_declarations::printed::systems;

const CART: &str = "system Cart {
    constants { m > 0 }
    coordinates { x }
    use parts::Wheel as wheel { hub: x }
    kinetic_energy = m/2*dot(x)^2 + wheel.energy;
    forces { -dot(wheel.angle) along dot(x); }
}";

/// A component with a fault that imports another.
const AXLE: &str = "pub component Axle(hub: scalar) {
    constants { m >> 0 }
    use parts::Wheel as wheel { hub: hub }
}";

/// The component, as its macro adds it to the system.
const WHEEL: &str = "{ { pub component Wheel(hub: scalar) {
    constants { inertia > 0 }
    coordinates { angle }
    let energy = inertia/2*dot(angle)^2;
    constraints { rolls: dot(hub) = dot(angle); }
} } }";

/// The errors of the first expansion, which ends with a call of the component.
fn errors(text: &str) -> Vec<String> {
    let items = expand(text.parse().expect("tokens")).to_string();
    assert!(items.contains("parts :: Wheel ! {"), "{items}");
    messages(&items)
}

/// The errors of the second expansion, with the component.
fn further_errors(text: &str) -> Vec<String> {
    messages(&expand_with(format!("{{ {text} }} {WHEEL}").parse().expect("tokens")).to_string())
}

fn messages(items: &str) -> Vec<String> {
    let message = |rest: &str| rest.split(['"', '\\']).nth(1).map(str::to_owned);
    items.split("compile_error").skip(1).filter_map(message).collect()
}

#[test]
fn faults_of_the_grammar_and_unknown_names_do_not_wait_for_components() {
    assert_eq!(errors(CART), [""; 0]);
    assert_eq!(errors(&CART.replace("m/2", "M/2")), ["unknown name `M` in system `Cart`"]);
    let damaged = CART.replace("m > 0", "m >> 0").replace("-dot(wheel", "-dott(wheel");
    assert_eq!(errors(&damaged).len(), 1, "{:?}", errors(&damaged));
    let twice = CART.replace("m > 0", "m >> 0").replace("along", "allong");
    assert_eq!(errors(&twice).len(), 2, "{:?}", errors(&twice));
    let component =
        "pub component Axle(hub: scalar) { constants { m >> 0 } use parts::Wheel as wheel { hub: hub } }";
    let items = expand_component(component.parse().expect("tokens")).to_string();
    assert!(items.contains("parts :: Wheel ! {") && items.matches("compile_error").count() == 1, "{items}");
}

#[test]
fn what_is_told_before_components_are_found_is_not_told_again() {
    assert_eq!(further_errors(CART), [""; 0]);
    let unknown = CART.replace("m/2", "M/2");
    assert_eq!((errors(&unknown).len(), further_errors(&unknown)), (1, Vec::new()));
    let damaged = CART.replace("m > 0", "m >> 0");
    assert_eq!((errors(&damaged).len(), further_errors(&damaged)), (1, Vec::new()));
    let both = unknown.replace("wheel.angle", "wheel.angel");
    assert_eq!(errors(&both).len(), 1);
    assert_eq!(further_errors(&both), ["`wheel`, a `Wheel`, has no `angel`"]);
    let axle = format!("{{ {AXLE} }} {WHEEL}");
    assert_eq!(messages(&expand_component_with(axle.parse().expect("tokens")).to_string()), [""; 0]);
}

/// Nothing declares a component with a fault in its head, and yet it is no macro.
#[test]
fn damaged_components_are_not_looked_for() {
    for head in ["Wheel hub", "Wheel(hub scalar)", "Wheel<T>(hub: scalar)", "(hub: scalar)"] {
        let text = format!(
            "system Cart {{
                component {head} {{ coordinates {{ angle }} kinetic_energy = dot(angle)^2; }}
                coordinates {{ x }}
                use Wheel as wheel {{ hub: x }}
                kinetic_energy = dot(x)^2;
                forces {{ wheel.angle along dot(x); }}
            }}"
        );
        let items = expand(text.parse().expect("tokens")).to_string();
        assert!(!items.contains("Wheel !"), "{head}: {items}");
        assert_eq!(messages(&items).len(), 1, "{head}: {items}");
    }
}

#[test]
fn sound_systems_with_imports_have_no_error_before_them() {
    let systems = systems::with_imports();
    let sound = systems.iter().filter(|(_, file)| !systems::may_be_wrong(file));
    let mut count = 0;
    for (text, file) in sound {
        let items = expand(text.parse().expect("tokens")).to_string();
        assert!(!items.contains("compile_error"), "{}: {text}\n{items}", file.display());
        count += 1;
    }
    assert!(count >= 25, "{count}");
}

/// Generated code has a real type `R`, which hides what is imported by that name.
#[test]
fn components_are_imported_by_other_names_than_the_real_type() {
    let spring = "{ { pub component R(length: scalar) {
        constants { k >= 0 }
        potential_energy = k/2*length^2;
    } } }";
    let cart = |path: &str| {
        let text = format!(
            "system Cart {{ constants {{ m > 0 }} coordinates {{ x }} kinetic_energy = m/2*dot(x)^2; use {path} as left {{ length: x }} }}"
        );
        messages(&expand_with(format!("{{ {text} }} {spring}").parse().expect("tokens")).to_string())
    };
    assert_eq!(cart("R"), ["a component cannot be used by the name `R`"]);
    assert_eq!(cart("springs::R"), [""; 0]);
}
