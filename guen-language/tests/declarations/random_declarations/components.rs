//! Components drawn at random, each system written twice: by components that use others, in loops and with counts, and by hand, as
//! the generator here writes instances out. Both have one meaning, which is computed from the tree of the second.

use guen_language::derive::function;

use super::difference;
use super::draw::Draw;
use super::families::values;
use super::functions;
use crate::common::{by_two_threads, derived, rounds};

/// The sections of a system that is written by hand, in the order in which their entries come.
#[derive(Default)]
struct Sections(Vec<(&'static str, String)>);

impl Sections {
    fn add(&mut self, section: &'static str, entry: &str) {
        match self.0.iter_mut().find(|(known, _)| *known == section) {
            Some((_, text)) => text.push_str(entry),
            None => self.0.push((section, entry.to_owned())),
        }
    }

    fn text(&self) -> String {
        let written = |(section, text): &(&str, String)| match *section {
            "kinetic_energy" | "potential_energy" => format!("{section} = {} 0;\n", text),
            "let" => format!("{text}\n"),
            _ => format!("{section} {{ {text} }}\n"),
        };
        // Parameters stand behind what they are made of, and forces behind parameters.
        let order = [
            "constants",
            "inputs",
            "coordinates",
            "let",
            "parameters",
            "constraints",
            "states",
            "particles",
            "kinetic_energy",
            "potential_energy",
            "forces",
            "outputs",
        ];
        let of =
            |name: &str| self.0.iter().find(|(known, _)| *known == name).map_or_else(String::new, written);
        format!("system Drawn {{\n{}gravity = vec(0, -9.81, 1/3);\n}}", order.map(of).concat())
    }
}

/// The properties of a pendulum that are drawn.
struct Bob {
    bump: String,
    has_input: bool,
    has_state: bool,
    /// The coordinate that has no name of its own, so that its rate is chosen.
    is_bare: bool,
}

impl Bob {
    fn drawn(draw: &mut Draw) -> Self {
        Bob {
            // Both arguments are used.
            bump: format!("{} + a*b/7", functions::function(draw, ["a", "b"], 1)),
            has_input: draw.once_in(2),
            has_state: draw.once_in(2),
            is_bare: draw.once_in(3),
        }
    }

    fn component(&self) -> String {
        let or_none = |is_there: bool, text: &str| if is_there { text.to_owned() } else { String::new() };
        format!(
            "component Bob(anchor: vector, drive: scalar) {{
                constants {{ m > 0 = 2, l > 0, c >= 0, turns > 0 = 3/2 + m }}
                {}
                coordinates {{ q }}
                fn bump(a, b) = {};
                fn twice(q) = 2*bump(q, drive);
                let end = anchor + l*vec(sin(q), -cos(q), 0);
                parameters {{ w = {}; }}
                {}
                particles {{ m at end; }}
                kinetic_energy = turns*dot(q)^2/10;
                potential_energy = twice(q)/5;
                forces {{ -c*w{}{} along w; }}
                outputs {{ tip = end; bend = bump(drive, q); }}
            }}\n",
            or_none(self.has_input, "inputs { u }"),
            self.bump,
            if self.is_bare { "dot(q)" } else { "dot(q)*(2 + sin(q)/3)" },
            or_none(self.has_state, "states { dot(z) = q - 2*z; }"),
            or_none(self.has_input, " + u"),
            or_none(self.has_state, " - z"),
        )
    }

    /// An instance by hand.
    fn write(&self, into: &mut Sections, name: &str, anchor: &str, drive: &str) {
        let n = name;
        // In parentheses, so that an argument stays one.
        let bump = |a: &str, b: &str| {
            let words = self.bump.split_inclusive(|c: char| !c.is_alphanumeric() && c != '_');
            let replaced = words.map(|word| {
                let (stem, rest) = match word.char_indices().last() {
                    Some((at, c)) if !c.is_alphanumeric() && c != '_' => word.split_at(at),
                    _ => (word, ""),
                };
                let stem = match stem {
                    "a" => format!("({a})"),
                    "b" => format!("({b})"),
                    _ => stem.to_owned(),
                };
                stem + rest
            });
            replaced.collect::<String>()
        };
        into.add(
            "constants",
            &format!("{n}_m > 0 = 2, {n}_l > 0, {n}_c >= 0, {n}_turns > 0 = 3/2 + {n}_m, "),
        );
        if self.has_input {
            into.add("inputs", &format!("{n}_u, "));
        }
        into.add("coordinates", &format!("{n}_q, "));
        let (q, w) = (format!("{n}_q"), format!("{n}_w"));
        into.add(
            "let",
            &format!("let {n}_drive = {drive}; let {n}_end = {anchor} + {n}_l*vec(sin({q}), -cos({q}), 0); "),
        );
        let rate = if self.is_bare { format!("dot({q})") } else { format!("dot({q})*(2 + sin({q})/3)") };
        into.add("parameters", &format!("{w} = {rate}; "));
        if self.has_state {
            into.add("states", &format!("dot({n}_z) = {q} - 2*{n}_z; "));
        }
        into.add("particles", &format!("{n}_m at {n}_end; "));
        into.add("kinetic_energy", &format!("{n}_turns*dot({q})^2/10 + "));
        let drive = format!("{n}_drive");
        into.add("potential_energy", &format!("2*({})/5 + ", bump(&q, &drive)));
        let input = if self.has_input { format!(" + {n}_u") } else { String::new() };
        let state = if self.has_state { format!(" - {n}_z") } else { String::new() };
        into.add("forces", &format!("-{n}_c*{w}{input}{state} along {w}; "));
        into.add("outputs", &format!("{n}_tip = {n}_end; {n}_bend = {}; ", bump(&drive, &q)));
    }
}

/// An arm of a slider with pendulums, which uses the component of these.
struct Arm {
    is_chain: bool,
    is_tied: bool,
    further: usize,
}

impl Arm {
    fn component(&self) -> String {
        let anchor = if self.is_chain { "first.end" } else { "hub" };
        let of_slider = match self.is_tied {
            true => "constraints { tie: dot(s) = dot(first.q)*cos(s); }",
            false => "parameters { v = dot(s); }",
        };
        let slider_before = if self.is_tied { "" } else { of_slider };
        let slider_behind = if self.is_tied { of_slider } else { "" };
        format!(
            "component Arm(anchor: vector, drive: scalar, n: count) {{
                count all = 2*n - n;
                constants {{ M > 0, reach[2] > 0 = 1/3 }}
                coordinates {{ s }}
                {slider_before}
                let hub = anchor + vec(s, reach[1], 0);
                for i in 0..all {{ let shift[i] = vec(0, i + 1, reach[i % 2]); }}
                use Bob as first {{ anchor: hub, drive }}
                for i in 0..{} {{ if i % 2 == 0 {{ use Bob as further[i/2] {{ anchor: {anchor}, drive: s }} }} }}
                {slider_behind}
                particles {{ for i in 0..n {{ M at hub + shift[n - 1 - i]; }} }}
                kinetic_energy = M*dot(s)^2/7;
                potential_energy = product(i in 0..n: cos(s - reach[i % 2])) + reach[0]*s^2;
            }}\n",
            2 * self.further
        )
    }

    /// An instance by hand.
    fn write(&self, bob: &Bob, into: &mut Sections, name: &str, anchor: &str, drive: &str, n: usize) {
        let (a, s) = (name, format!("{name}_s"));
        into.add("constants", &format!("{a}_M > 0, {a}_r0 > 0 = 1/3, {a}_r1 > 0 = 1/3, "));
        into.add("coordinates", &format!("{s}, "));
        if !self.is_tied {
            into.add("parameters", &format!("{a}_v = dot({s}); "));
        }
        into.add("let", &format!("let {a}_hub = {anchor} + vec({s}, {a}_r1, 0); "));
        bob.write(into, &format!("{a}_first"), &format!("{a}_hub"), drive);
        let further = if self.is_chain { format!("{a}_first_end") } else { format!("{a}_hub") };
        for i in 0..self.further {
            bob.write(into, &format!("{a}_further_{i}"), &further, &s);
        }
        if self.is_tied {
            into.add("constraints", &format!("{a}_tie: dot({s}) = dot({a}_first_q)*cos({s}); "));
        }
        for i in (0..n).rev() {
            into.add("particles", &format!("{a}_M at {a}_hub + vec(0, {} + 1, {a}_r{}); ", i, i % 2));
        }
        into.add("kinetic_energy", &format!("{a}_M*dot({s})^2/7 + "));
        let product: String = (0..n).map(|i| format!("cos({s} - {a}_r{})*", i % 2)).collect();
        into.add("potential_energy", &format!("{product}1 + {a}_r0*{s}^2 + "));
    }
}

/// The system of a seed by components and by hand.
fn drawn(seed: u64) -> [String; 2] {
    let mut draw = Draw::new(seed);
    let draw = &mut draw;
    let bob = Bob::drawn(draw);
    let arm = Arm { is_chain: draw.once_in(2), is_tied: draw.once_in(3), further: draw.below(3) };
    let (n, singles) = (draw.below(4), draw.below(3));
    let drive = functions::function(draw, ["x", "y"], 0);
    let head = "component Unused(x: scalar) { constants { k > 0 } potential_energy = k*x; }\n";
    let by_component = format!(
        "system Drawn {{
            {}{}{head}
            count n = {n};
            constants   {{ m > 0 }}
            coordinates {{ x, y }}
            let place = vec(x, y, x*y/3);
            let drive = {drive};
            parameters  {{ u = dot(x); v = dot(y); }}
            use Arm as left {{ anchor: place, drive, n }}
            for i in 0..{singles} {{ use Bob as single[i] {{ anchor: place + left.first.end, drive: left.s }} }}
            particles   {{ m at place; }}
            forces      {{ -left.first.w along dot(left.hub.y); }}
            outputs     {{ height = left.hub.y + left.first.q; }}
            gravity     = vec(0, -9.81, 1/3);
        }}",
        bob.component(),
        arm.component()
    );
    let mut by_hand = Sections::default();
    by_hand.add("constants", "m > 0, ");
    by_hand.add("coordinates", "x, y, ");
    by_hand.add("let", &format!("let place = vec(x, y, x*y/3); let drive = {drive}; "));
    by_hand.add("parameters", "u = dot(x); v = dot(y); ");
    arm.write(&bob, &mut by_hand, "left", "place", "drive", n);
    for i in 0..singles {
        bob.write(&mut by_hand, &format!("single_{i}"), "place + left_first_end", "left_s");
    }
    by_hand.add("particles", "m at place; ");
    by_hand.add("forces", "-left_first_w along dot(left_hub.y); ");
    by_hand.add("outputs", "height = left_hub.y + left_first_q; ");
    [by_component, by_hand.text()]
}

#[test]
fn instances_are_what_they_are_written_out() {
    let rounds = rounds(16);
    let seeds: Vec<u64> = (0..rounds).collect();
    let states: usize = by_two_threads(&seeds, |seed| {
        let [by_component, by_hand] = drawn(*seed);
        let numbers = |values: Vec<Vec<u64>>| -> Vec<Vec<f64>> {
            values.into_iter().map(|list| list.into_iter().map(f64::from_bits).collect()).collect()
        };
        let (names, found) = derived(&by_component, |derived| {
            let names: Vec<String> =
                derived.system.programs.functions.iter().map(|program| program.name.clone()).collect();
            (names, numbers(values(derived).1))
        });
        derived(&by_hand, |derived| {
            let expected = numbers(values(derived).1);
            for (name, (found, expected)) in names.iter().zip(found.iter().zip(expected)) {
                // Functions that may vanish come in the order in which the declaration has them.
                let in_order = |mut values: Vec<f64>| {
                    // A switch is a difference of either sign.
                    if name == function::SWITCHES {
                        values.iter_mut().for_each(|value| *value = value.abs());
                    }
                    if [function::SWITCHES, function::DOMAIN].contains(&name.as_str()) {
                        values.sort_by(f64::total_cmp);
                    }
                    values
                };
                let (found, expected) = (in_order(found.clone()), in_order(expected));
                let size = expected.iter().fold(1.0_f64, |most, value| most.max(value.abs()));
                assert_eq!(found.len(), expected.len(), "{name} of\n{by_component}\n{by_hand}");
                // Derivatives by states and other orders of equal sums differ by rounding; a wrong term by more.
                let differs = |(a, b): (&f64, &f64)| (a - b).abs() > 1e-9 * size;
                let wrong = found.iter().zip(&expected).any(differs);
                assert!(!wrong, "{name}: {found:?}, and not {expected:?}, of\n{by_component}\n{by_hand}");
            }
            assert!(derived.system.program(function::RHS).is_some());
            difference(&by_hand, derived, *seed).1
        })
    })
    .into_iter()
    .sum();
    assert!(states as u64 >= rounds, "{states} states only");
}
