//! The text of declarations of bars in a row: uprights of equal length, hinged to the ground at equal distances, and bars that join the
//! tip of each to that of the next. With `n` loops that is the `n`-four-bar mechanism of the IFToMM library of benchmark problems.

/// In the angles of the bars: `a0` to `an` of the uprights, `b1` to `bn` of the others.
pub fn in_angles(loops: usize) -> String {
    let list = |first: usize, entry: &dyn Fn(usize) -> String, gap: &str| {
        (first..=loops).map(entry).collect::<Vec<_>>().join(gap)
    };
    format!(
        "pub system Bars {{
            constants {{ g = 9.81 }}
            coordinates {{ {}, {} }}
            {}
            bodies {{
                {}
                {}
            }}
            gravity = vec(0, -g);
            parameters {{ turn = dot(a0); }}
            holonomic {{ {} }}
        }}",
        list(0, &|i| format!("a{i}"), ", "),
        list(1, &|i| format!("b{i}"), ", "),
        list(0, &|i| format!("let t{i} = vec({i}, 0) + rot_z(a{i}).x;"), "\n            "),
        list(
            0,
            &|i| bar(&format!("upright{i}"), &format!("vec({i}, 0)"), &format!("rot_z(a{i})")),
            "\n                "
        ),
        list(
            1,
            &|i| bar(&format!("bar{i}"), &format!("t{}", i - 1), &format!("rot_z(b{i})")),
            "\n                "
        ),
        list(1, &|i| format!("c{i}: t{} + rot_z(b{i}).x = t{i};", i - 1), " "),
    )
}

/// A uniform bar of one kilogramme and one metre.
fn bar(name: &str, foot: &str, orientation: &str) -> String {
    format!(
        "{name} {{ mass: 1, inertia: diag(0, 0, 1/12), center: {foot} + {orientation}.x/2, orientation: {orientation} }}"
    )
}

/// In the places `(x0, y0)` to `(xn, yn)` of the tips: the kinetic energy of a bar is a sixth of its mass times the sum of the squares
/// of the velocities of its ends and their product.
pub fn in_points(loops: usize) -> String {
    let list = |first: usize, entry: &dyn Fn(usize) -> String, gap: &str| {
        (first..=loops).map(entry).collect::<Vec<_>>().join(gap)
    };
    let square = |i: usize| format!("inner(dot(p{i}), dot(p{i}))");
    let joined = |i: usize| {
        let before = i - 1;
        format!("({} + inner(dot(p{before}), dot(p{i})) + {})", square(before), square(i))
    };
    format!(
        "pub system Bars {{
            constants {{ g = 9.81 }}
            coordinates {{ {} }}
            {}
            kinetic_energy = ({} + {})/6;
            potential_energy = g/2*({} + {});
            parameters {{ turn = x0*dot(y0) - y0*dot(x0); }}
            holonomic {{ {} {} }}
        }}",
        list(0, &|i| format!("x{i}, y{i}"), ", "),
        list(0, &|i| format!("let p{i} = vec(x{i}, y{i});"), " "),
        list(0, &square, " + "),
        list(1, &joined, " + "),
        list(0, &|i| format!("y{i}"), " + "),
        list(1, &|i| format!("y{} + y{i}", i - 1), " + "),
        list(0, &|i| format!("u{i}: (x{i} - {i})^2 + y{i}^2 = 1;"), " "),
        list(1, &|i| format!("c{i}: (x{i} - x{0})^2 + (y{i} - y{0})^2 = 1;", i - 1), " "),
    )
}
