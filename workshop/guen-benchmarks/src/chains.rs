//! The text of declarations of planar chains: equal point masses on massless links, hanging from the origin.
//!
//! Text, because three things are made of it: the declared systems of this crate (its build script writes them), the
//! tables of cost and time against the number of links, and the peers' programs that are compared with ours.

use std::fmt::Write;

/// Which angles are coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Angles {
    /// Each link's from the vertical, zero downwards.
    Absolute,
    /// The first link's from the vertical, each further one's from the link before.
    Relative,
}

/// The chains that are declared: links, angles, module.
pub const DECLARED: [(usize, Angles, &str); 8] = [
    (2, Angles::Absolute, "chain2"),
    (5, Angles::Absolute, "chain5"),
    (10, Angles::Absolute, "chain10"),
    (20, Angles::Absolute, "chain20"),
    (2, Angles::Relative, "joints2"),
    (5, Angles::Relative, "joints5"),
    (10, Angles::Relative, "joints10"),
    (20, Angles::Relative, "joints20"),
];

/// The declaration of a chain, without the macro around it.
pub fn declaration(name: &str, links: usize, angles: Angles) -> String {
    let list =
        |entry: &dyn Fn(usize) -> String, gap: &str| (1..=links).map(entry).collect::<Vec<_>>().join(gap);
    let angle = |i: usize| match angles {
        Angles::Relative if i > 1 => format!("let angle{i} = angle{} + q{i};", i - 1),
        _ => format!("let angle{i} = q{i};"),
    };
    let place = |i: usize| {
        let arm = format!("vec(l*sin(angle{i}), -l*cos(angle{i}))");
        if i == 1 { format!("let p1 = {arm};") } else { format!("let p{i} = p{} + {arm};", i - 1) }
    };
    format!(
        "pub system {name} {{
            constants {{ m > 0, l > 0, g = 9.81 }}
            coordinates {{ {} }}
            {}
            parameters {{ {} }}
            particles {{ {} }}
            gravity = vec(0, -g);
        }}",
        list(&|i| format!("q{i}"), ", "),
        list(&|i| format!("{} {}", angle(i), place(i)), "\n            "),
        list(&|i| format!("w{i} = dot(q{i});"), " "),
        list(&|i| format!("m at p{i};"), " "),
    )
}

/// The name of the system whose module has this name: `chain5` is of `Chain5`.
pub fn system_name(module: &str) -> String {
    module[..1].to_uppercase() + &module[1..]
}

/// The module of declarations, as the build script writes it.
pub fn declarations() -> String {
    let mut text = String::new();
    for (links, angles, module) in DECLARED {
        let system = declaration(&system_name(module), links, angles);
        let _ = writeln!(text, "declared! {{ {}_TEXT,\n{system}\n}}", module.to_uppercase());
    }
    text
}
