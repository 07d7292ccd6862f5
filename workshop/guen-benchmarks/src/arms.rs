//! The text of declarations of arms in space: equal bodies, each turning about an axis of the one before.
//!
//! Text for the same reasons as in `chains`.

use std::fmt::Write;

/// The joints of the longest arm, of which the others are the first ones.
pub const AXES: &str = "zyyxyxyxy";

/// The arms that are declared: axes from the base on, module.
pub const DECLARED: [(&str, &str); 2] = [("zyx", "arm3"), ("zyyxyx", "arm6")];

/// The entries of all joints in one line, with something between them.
fn list(joints: usize, entry: &dyn Fn(usize) -> String, gap: &str) -> String {
    (1..=joints).map(entry).collect::<Vec<_>>().join(gap)
}

/// The declaration of an arm, without the macro around it.
pub fn declaration(name: &str, axes: &str) -> String {
    let joints = axes.len();
    let place = |i: usize| {
        let axis = &axes[i - 1..i];
        let (before, base) = match i {
            1 => (String::new(), "vec(0, 0, 0)".to_owned()),
            _ => (format!("R{}*", i - 1), format!("p{}", i - 1)),
        };
        let end =
            if i == joints { String::new() } else { format!(" let p{i} = {base} + R{i}*vec(l, 0, l/4);") };
        format!("let R{i} = {before}rot_{axis}(q{i}); let c{i} = {base} + R{i}*vec(l/2, l/8, -l/4);{end}")
    };
    format!(
        "pub system {name} {{
            constants {{ m > 0, l > 0, A > 0, B > 0, C > 0, D, g = 9.81 }}
            coordinates {{ {} }}
            {}
            parameters {{ {} }}
            bodies {{ {} }}
            gravity = vec(0, 0, -g);
        }}",
        list(joints, &|i| format!("q{i}"), ", "),
        list(joints, &place, "\n            "),
        list(joints, &|i| format!("w{i} = dot(q{i});"), " "),
        list(
            joints,
            &|i| format!(
                "b{i} {{ mass: m, inertia: sym(A, B, C, D, 0, 0), center: c{i}, orientation: R{i} }}"
            ),
            " "
        ),
    )
}

/// The axes of the longest general arm, of which the others are the first ones.
pub const GENERAL_AXES: &str = "zyzyzyzyz";

/// The declaration of an arm whose bodies differ and have all moments and products of inertia and all components of their offsets.
pub fn general(joints: usize) -> String {
    let constants = |i: usize| {
        let own = format!("m{i} > 0, A{i} > 0, B{i} > 0, C{i} > 0, D{i}, E{i}, F{i}, x{i}, y{i}, z{i}");
        if i == joints { own } else { format!("{own}, u{i}, v{i}, w{i}") }
    };
    let place = |i: usize| {
        let (before, base) = match i {
            1 => (String::new(), String::new()),
            _ => (format!("R{}*", i - 1), format!("p{} + ", i - 1)),
        };
        let (axis, next) =
            (&GENERAL_AXES[i - 1..i], format!(" let p{i} = {base}R{i}*vec(u{i}, v{i}, w{i});"));
        let next = if i == joints { String::new() } else { next };
        format!("let R{i} = {before}rot_{axis}(q{i}); let c{i} = {base}R{i}*vec(x{i}, y{i}, z{i});{next}")
    };
    format!(
        "pub system Arm {{
            constants {{ {}, g = 9.81 }}
            coordinates {{ {} }}
            {}
            parameters {{ {} }}
            bodies {{ {} }}
            gravity = vec(0, 0, -g);
        }}",
        list(joints, &constants, ", "),
        list(joints, &|i| format!("q{i}"), ", "),
        list(joints, &place, "\n            "),
        list(joints, &|i| format!("s{i} = dot(q{i});"), " "),
        list(
            joints,
            &|i| format!(
                "b{i} {{ mass: m{i}, inertia: sym(A{i}, B{i}, C{i}, D{i}, E{i}, F{i}), center: c{i}, orientation: R{i} }}"
            ),
            " "
        ),
    )
}

/// The module of declarations, as the build script writes it.
pub fn declarations() -> String {
    let mut text = String::new();
    for (axes, module) in DECLARED {
        let system = declaration(&(module[..1].to_uppercase() + &module[1..]), axes);
        let _ = writeln!(text, "declared! {{ {}_TEXT,\n{system}\n}}", module.to_uppercase());
    }
    text
}
