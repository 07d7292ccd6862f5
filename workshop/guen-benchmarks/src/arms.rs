//! The text of declarations of arms in space: equal bodies, each turning about an axis of the one before.
//!
//! Text for the same reasons as in `chains`.

use std::fmt::Write;

/// The joints of the longest arm, of which the others are the first ones.
pub const AXES: &str = "zyyxyxyxy";

/// The arms that are declared: axes from the base on, module.
pub const DECLARED: [(&str, &str); 2] = [("zyx", "arm3"), ("zyyxyx", "arm6")];

/// The declaration of an arm, without the macro around it.
pub fn declaration(name: &str, axes: &str) -> String {
    let joints = axes.len();
    let list =
        |entry: &dyn Fn(usize) -> String, gap: &str| (1..=joints).map(entry).collect::<Vec<_>>().join(gap);
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
        list(&|i| format!("q{i}"), ", "),
        list(&place, "\n            "),
        list(&|i| format!("w{i} = dot(q{i});"), " "),
        list(
            &|i| format!(
                "b{i} {{ mass: m, inertia: sym(A, B, C, D, 0, 0), center: c{i}, orientation: R{i} }}"
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
