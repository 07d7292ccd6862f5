//! Dimensions: what fits is accepted, what does not is told at the smallest place, and units follow where none is written.

mod seeded;
mod twenty;

use guen_language::derive::derive;
use guen_language::diagnostics::collect;
use guen_language::report::ReportLines;
use guen_language::{model, parse, with_further_faults};

use crate::common::derived;

/// A pendulum on a cart that a motor pushes, with a unit for everything or for one thing.
const CART: &str = "pub system Cart {
    constants { m: kg > 0, M: kg > 0, l: m > 0 = 0.5, g: m/s^2 = 9.81, c: N*s/m >= 0, k: N/m, tilt: deg = 30, T: s > 0, I: kg*m^2 > 0 = m*l^2/12 }
    inputs { push: N in -10..10 }
    coordinates { x: m, q: rad }
    let p = vec(x, 0) + l*vec(sin(q + tilt), -cos(q + tilt));
    fn ramp(time) = tanh(time/T);
    parameters { v = dot(x); w = dot(q); }
    particles { M at vec(x, 0); m at p; }
    kinetic_energy = I/2*w^2;
    gravity = vec(0, -g);
    potential_energy = k/2*x^2 + m*g*l*(1 - cos(q));
    forces { push*ramp(t) - c*v along v; -c*l^2*w along w; }
    outputs { height = p.y; speed = dot(p); power = push*v; angle = atan2(p.y, p.x); }
    scene Still { fix l = 1/2, tilt = 10; track q; }
}";

/// The messages of a declaration's faults.
fn faults(text: &str) -> Vec<String> {
    let tokens: proc_macro2::TokenStream = text.parse().unwrap();
    let (declaration, parsed) = parse::parse(tokens.clone());
    let declaration = declaration.unwrap();
    let all = if parsed.is_empty() {
        let (_, report) = collect(|faults| derive(model::resolve(&declaration, faults)?, faults).map(|_| ()));
        report.to_compile_errors().to_string()
    } else {
        with_further_faults(&tokens, &declaration, parsed).to_compile_errors().to_string()
    };
    all.split("compile_error").skip(1).map(str::to_owned).collect()
}

/// A mass that is sprung between two walls, with what is declared before its energies.
fn sprung(before: &str, energy: &str, after: &str) -> String {
    format!(
        "system Sprung {{
            constants {{ m: kg > 0, a: m > 0, k: N/m > 0 }}
            coordinates {{ x: m, z }}
            {before}
            kinetic_energy = m/2*(dot(x)^2 + dot(z)^2);
            potential_energy = {energy};
            contacts {{ floor: gap = x; }}
            {after}
        }}"
    )
}

#[test]
fn a_fault_is_told_once() {
    let energy = "k/2*(x^2 + z^2)";
    let told = |before: &str, energy: &str, after: &str| faults(&sprung(before, energy, after));
    assert_eq!(told("", energy, "outputs { far = gap(floor) + a; }").len(), 0);
    assert!(told("", energy, "outputs { far = gap(floor) + m; }")[0].contains("`gap(floor)` is in m"));
    // `z` has no unit, and is a length by its other uses.
    let found = told("let area = z + a*a;", energy, "");
    assert!(found.len() == 1 && found[0].contains("`z` is in m, and `a*a` is in m^2"), "{found:?}");
    // The uses of `p` disagree until `q` is known to be a length.
    let outputs = "outputs { one = p + m; two = p + a; three = p + q; four = q + a; five = 2*q - a; }";
    let found = told("inputs { p, q }", energy, outputs);
    assert!(found.len() == 1 && found[0].contains("`p` is in m, and `m` is in kg"), "{found:?}");
    // A function, whether anything calls it or not, and however often.
    let function = "fn far(r) = r*(m + a);";
    for energy in [energy, "k/2*(x^2 + z^2) + 0*far(1) + 0*far(a)"] {
        let found = told(function, energy, "");
        assert!(found.len() == 1 && found[0].contains("`m` is in kg, and `a` is in m"), "{found:?}");
    }
    // A component and its instances.
    let component = "component Spring(reach: scalar) { constants { s: N/m > 0, own: m = 2*s } potential_energy = s*reach; }
        use Spring as left { reach: x } use Spring as right { reach: z }";
    let found = told(component, energy, "");
    assert!(found.len() == 2, "{found:?}");
    assert!(
        found[0].contains("`left.own` is in m") && found[1].contains("in `left`, a `Spring`"),
        "{found:?}"
    );
}

#[test]
fn nothing_is_told_of_what_follows_from_other_faults() {
    for (before, energy, after, message) in [
        // The exponent, the function and the unit are missing.
        ("let n = 2 +;", "k/2*(x^2 + z^2) + 0*x^n", "", "expected"),
        ("fn half(r) r/2;", "k*half(x^2) + half(k)*z^2", "", "expected `=`"),
        (
            "inputs { u: foo }",
            "k/2*(x^2 + z^2)",
            "forces { u*a along dot(x); u along dot(z); }",
            "unknown unit",
        ),
        // Names that are declared twice, and a parameter without a velocity.
        ("let x = 1;", "k/2*z^2", "outputs { o = x + a; p = x + m; }", "`x` is declared twice"),
        (
            "parameters { v = z; }",
            "k/2*(x^2 + z^2)",
            "outputs { o = v + dot(x); }",
            "parameter `v` has no velocity",
        ),
        ("let x = 1;", "k/2*z^2", "outputs { o = a^x + m; }", "`x` is declared twice"),
    ] {
        let found = faults(&sprung(before, energy, after));
        assert!(found.len() == 1 && found[0].contains(message), "{before} {energy} {after}\n{found:?}");
    }
    // Nothing is told of the dimensions of a statement that has another fault.
    let energy = "k/2*(x^2 + z^2)";
    for (before, after, message) in [
        ("", "scene S { fix k = 1, k = m; track x; }", "k"),
        ("", "resets { r: x rises, x = m, x = 1; }", "x"),
        ("inputs { u: N*foo }", "forces { u*a along dot(x); }", "foo"),
    ] {
        let found = faults(&sprung(before, energy, after));
        assert!(found.len() == 1 && found[0].contains(message), "{before} {after}\n{found:?}");
    }
}

/// The declaration without the units of some names.
fn without(names: &[&str]) -> String {
    let mut text = CART.to_owned();
    for name in names {
        let start = text.find(&format!("{name}: ")).unwrap_or_else(|| panic!("`{name}` has no unit"));
        let rest = &text[start + name.len()..];
        let end = rest.find([',', '>', '=', '}']).unwrap();
        let end = rest[..end].find(" in ").unwrap_or(end);
        text.replace_range(start + name.len()..start + name.len() + end, " ");
    }
    text
}

#[test]
fn units_follow_from_others() {
    let all =
        [("m", "kg"), ("x", "m"), ("q", "rad"), ("l", "m"), ("c", "N*s/m"), ("k", "N/m"), ("push", "N")];
    derived(CART, |derived| {
        let units = &derived.model.units;
        for (name, unit) in all {
            assert_eq!(units[name], unit);
        }
        for (name, unit) in
            [("v", "m/s"), ("w", "1/s"), ("height", "m"), ("speed", "m/s"), ("power", "W"), ("angle", "1")]
        {
            assert_eq!(units[name], unit, "{name}");
        }
        let report = ReportLines::of(&derived.model, &derived.system).to_text();
        assert!(report.contains("g: m/s^2 = 9.81") && report.contains("v: m/s"), "{report}");
    });
    // Most follow from the few that are left.
    derived(&without(&["m", "c", "k", "push", "I", "q", "T"]), |derived| {
        let units = &derived.model.units;
        for (name, unit) in [("c", "kg/s"), ("k", "kg/s^2"), ("push", "N"), ("T", "s"), ("q", "1")] {
            assert_eq!(units[name], unit, "{name}");
        }
    });
    // Without any nothing is checked, and nothing said.
    let names = ["m", "M", "l", "g", "c", "k", "tilt", "T", "I", "push", "x", "q"];
    let bare = without(&names).replace("k/2*x^2", "k/2*x");
    derived(&bare, |derived| assert!(derived.model.units.is_empty()));
}

#[test]
fn what_is_left_out_changes_nothing_that_is_right() {
    let names = ["m", "M", "l", "g", "c", "k", "T", "I", "push", "x", "q"];
    // All subsets of at most three; in a run of all tests, which are not optimised, every fourth one.
    let step = if std::env::var_os("GUEN_ROUNDS").is_some() { 1 } else { 4 };
    let mut place = 0;
    for a in 0..names.len() {
        for b in a..names.len() {
            for c in b..names.len() {
                place += 1;
                if place % step != 0 {
                    continue;
                }
                let mut left = vec![names[a], names[b], names[c]];
                left.dedup();
                let text = without(&left);
                assert_eq!(faults(&text), Vec::<String>::new(), "without {left:?}");
            }
        }
    }
}

/// Each with the part of the message that names what is wrong.
#[test]
fn what_does_not_fit_is_told_where_it_is() {
    let sums = "this sum adds different dimensions";
    let cases = [
        ("k/2*x^2 +", "k/2*x +", "`k/2*x` is in kg*m/s^2 (N), and `m*g*l*(1 - cos(q))` is in kg*m^2/s^2 (J)"),
        ("m*g*l*(1", "m*g*(1", sums),
        ("1 - cos(q)", "l - cos(q)", "`l` is in m, and `cos(q)` is a number"),
        ("vec(x, 0) + l", "vec(x, 0) + m", sums),
        ("- c*v along", "- c*x along", sums),
        ("push*ramp", "k*ramp", "and `c*v` is in kg*m/s^2 (N)"),
        ("-c*l^2*w along w", "-c*l*w along w", "a force along a velocity in 1/s is in kg*m^2/s^2 (J)"),
        ("-c*l^2*w along w", "-c*l^2*w along v", "a force along a velocity in m/s is in kg*m/s^2 (N)"),
        ("time/T", "time", "an argument of `tanh` is a number, and this is in s"),
        ("ramp(t)", "ramp(l)", "in the call of `ramp`"),
        ("M at vec(x, 0)", "l at vec(x, 0)", "a mass at a place in m is in kg, and this is in m"),
        ("M at vec(x, 0)", "M at vec(x, q)", "the components of this vector have different dimensions"),
        ("vec(0, -g)", "vec(0, -g*l)", "gravity is in m/s^2, and this is in m^2/s^2"),
        ("I/2*w^2", "I/2*w", "the kinetic energy is in kg*m^2/s^2 (J), and this is in kg*m^2/s"),
        ("sin(q + tilt)", "sin(x + tilt)", sums),
        ("sin(q + tilt)", "sin(q*l)", "an argument of `sin` is a number, and this is in m"),
        ("atan2(p.y, p.x)", "atan2(p.y, v)", "the arguments of `atan2` have different dimensions"),
        ("power = push*v", "power = push*v + w", sums),
        ("power = push*v", "power = exp(push)", "an argument of `exp` is a number"),
        ("power = push*v", "power = 2^(x/l)*x + m", "the exponent is not a number"),
        ("g: m/s^2", "g: m/s", "(J)"),
        ("x: m", "x: s", sums),
        ("c: N*s/m", "c: N", sums),
        ("k: N/m", "k: N", sums),
        ("l: m >", "l: kg >", sums),
        ("I: kg*m^2 > 0 = m*l^2/12", "I: kg*m^2 > 0 = m*l/12", "`I` is in kg*m^2, and this is in kg*m"),
        ("-10..10", "-10..m", "`push` is in kg*m/s^2 (N), and this is in kg"),
        ("fix l = 1/2", "fix l = g", "`l` is in m, and this is in m/s^2"),
        ("x: m", "x: mm", "unknown unit `mm`"),
        ("x: m", "x: f64", "names have no types"),
        ("x: m", "x: metre", "the units are"),
        ("q: rad", "q: deg", "only constants may be given in degrees"),
        ("tilt: deg", "tilt: deg/s", "`deg` stands alone"),
        ("l: m >", "l: >", "expected a unit"),
        ("g: m/s^2", "g: m/s^", "expected the power of a unit"),
        ("g: m/s^2", "g: m/s^(1/0)", "a power by zero"),
        ("g: m/s^2", "g: (m/s", "unclosed"),
    ];
    for (right, wrong, expected) in cases {
        assert!(CART.contains(right), "{right}");
        if expected == "unclosed" {
            continue;
        }
        let found = faults(&CART.replacen(right, wrong, 1));
        assert!(found.iter().any(|fault| fault.contains(expected)), "`{wrong}`: {found:#?}");
        let limit = if wrong.contains(':') { 6 } else { 1 };
        assert!(found.len() <= limit, "`{wrong}`: {found:#?}");
    }
    // Two faults are two errors.
    let two =
        CART.replace("M at vec(x, 0)", "l at vec(x, 0)").replace("power = push*v", "power = push*v + w");
    assert_eq!(faults(&two).len(), 2);
}

/// Degrees become radians in `prepare`, in scenes, and in defaults that are made of others.
#[test]
fn degrees_are_converted() {
    use guen_language::derive::function;
    let system = |units: [&str; 2], defaults: &str, scene: &str| {
        format!(
            "pub system Spring {{
                constants {{ a{} = 30, {defaults} k = 2, J = 1 }}
                coordinates {{ q{} }}
                parameters {{ w = dot(q); }}
                kinetic_energy = J/2*w^2;
                force_function = k*sin(q - a);
                {scene}
            }}",
            units[0], units[1]
        )
    };
    let rate = |text: &str, scene: bool| {
        derived(text, |derived| {
            let level = if scene { &derived.scenes[0] } else { &derived.system };
            let value = |symbol| match derived.model.bench.graph.symbol_info(symbol).name.as_str() {
                "a" => 30.0,
                "b" => 1.2,
                "k" => 2.0,
                "J" => 1.0,
                _ => 0.4,
            };
            crate::common::evaluated(level, function::RHS, value).unwrap()[1]
        })
    };
    let angle = |a: f64| 2.0 * (0.4 - a).cos();
    let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-15, "{a} {b}");
    close(rate(&system([": deg", ""], "", ""), false), angle(30_f64.to_radians()));
    close(rate(&system([": rad", ""], "", ""), false), angle(30.0));
    let fixed = |value: &str| format!("scene Fixed {{ track q; fix a = {value}; }}");
    close(rate(&system([": deg", ""], "", &fixed("50")), true), angle(50_f64.to_radians()));
    close(rate(&system([": deg", ": rad"], "b: rad = 1,", &fixed("b/2")), true), angle(0.6));
}

/// Momenta, reactions and what is left of constraints have the units that follow from their forms.
#[test]
fn momenta_and_reactions_have_units() {
    // A sled, rods that close a loop, and a coin: a speed, an angular velocity, a vector constraint, positions.
    let wanted: [(usize, &[(&str, &str)]); 4] = [
        (
            1,
            &[
                ("dT/dspeed", "kg*m/s"),
                ("dT/dturning", "kg*m^2/s"),
                ("reaction(blade)", "N"),
                ("blade", "m/s"),
            ],
        ),
        (4, &[("dT/dtipping", "kg*m^2/s"), ("reaction(contact_x)", "N"), ("dT/dcontact_y", "kg*m/s")]),
        (9, &[("reaction(closed_x)", "N"), ("residual(closed_x)", "m"), ("closed_x", "m/s")]),
        (12, &[("reaction(rod)", "kg/s^2"), ("residual(rod)", "m^2")]),
    ];
    // In rustdoc, too.
    let items = guen_language::expand(twenty::TWENTY[1].parse().unwrap()).to_string();
    assert!(items.contains("\"The multiplier of `blade`.\"] # [doc = \"\"] # [doc = \"In N.\"]"));
    for (number, wanted) in wanted {
        derived(twenty::TWENTY[number], |derived| {
            for (name, unit) in wanted {
                assert_eq!(
                    derived.model.units.get(*name).map(String::as_str),
                    Some(*unit),
                    "{name} of {number}"
                );
            }
            let report = ReportLines::of(&derived.model, &derived.system).to_text();
            let lines = report.lines().skip_while(|line| *line != "Units of momenta and reactions").skip(1);
            let lines: Vec<&str> = lines.take_while(|line| !line.is_empty()).map(str::trim).collect();
            assert!(!lines.is_empty(), "{report}");
            for (name, unit) in
                wanted.iter().filter(|(name, _)| name.starts_with("dT") || name.starts_with("reaction"))
            {
                let line = format!("{name}: {unit}");
                assert!(lines.contains(&&line[..]), "{line} in {lines:?}");
            }
        });
    }
}
