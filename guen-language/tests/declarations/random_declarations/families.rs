//! Families drawn at random, each written twice: by counts, arrays, loops and sums, and member by member, as the generator here
//! writes loops out. Both have equal programs to the bit, and what the second means is computed from its tree.

use guen_language::derive::{DerivedSystem, function};
use guen_symbolic::{ExprId, SymbolId};

use super::difference;
use super::draw::Draw;
use crate::common::{by_two_threads, derived, evaluated, rounds};

/// The same declaration by loops and by hand.
struct Pair {
    by_loop: String,
    by_hand: String,
}

/// A family that grows: its sections by loop and by hand.
#[derive(Default)]
struct Family {
    sections: Vec<(&'static str, String, String)>,
}

impl Family {
    /// An entry for each index of a range; `entry` writes it from the text of an index and of its neighbours.
    fn each(
        &mut self,
        section: &'static str,
        (start, end): (usize, usize),
        range: &str,
        by_loop: &str,
        by_hand: impl Fn(usize) -> String,
    ) {
        let written: String = (start..end).map(by_hand).collect();
        self.add(section, &format!("for i in {range} {{ {by_loop} }} "), &written);
    }

    fn add(&mut self, section: &'static str, by_loop: &str, by_hand: &str) {
        match self.sections.iter_mut().find(|(known, ..)| *known == section && section != "let") {
            Some((_, first, second)) => {
                first.push_str(by_loop);
                second.push_str(by_hand);
            }
            None => self.sections.push((section, by_loop.to_owned(), by_hand.to_owned())),
        }
    }

    fn text(&self, by_loop: bool) -> String {
        let sections = self.sections.iter().map(|(section, first, second)| {
            let entries = if by_loop { first } else { second };
            match *section {
                "let" | "count" => format!("{entries}\n"),
                section if entries.is_empty() && section != "constants" => String::new(),
                section @ ("kinetic_energy" | "potential_energy") => format!("{section} = {entries};\n"),
                section => format!("{section} {{ {entries} }}\n"),
            }
        });
        format!("system Family {{\n{}gravity = vec(0, -9.81, 1/3);\n}}", sections.collect::<String>())
    }
}

/// A family of the seed: carts on lines, pendulums that hang on them or on each other, springs and dampers between neighbours or
/// as a tree, some velocities bound to those before them.
fn drawn(seed: u64) -> Pair {
    let mut draw = Draw::new(seed);
    let draw = &mut draw;
    let n = draw.between(1, 5);
    let last = n - 1;
    let mut family = Family::default();
    let is_chain = !draw.once_in(4);
    let is_tree = draw.once_in(2);
    let by_function = draw.once_in(2);
    let bound = if draw.once_in(2) && n > 1 { draw.between(1, n - 1) } else { 0 };
    family.add("count", &format!("count n = {n}; count k = n*n - {};", n * n - bound), "");
    family.add("constants", "m[n] > 0 = 2, s[n, n] >= 0, c >= 0, ", "");
    let masses: String = (0..n).map(|i| format!("m_{i} > 0 = 2, ")).collect();
    let springs: String = (0..n * n).map(|e| format!("s_{}_{} >= 0, ", e / n, e % n)).collect();
    family.add("constants", "", &format!("{masses}{springs}c >= 0, "));
    family.each("constants", (0, n), "0..n", "l[i] > 0 = (i + 1)/3, ", |i| {
        format!("l_{i} > 0 = ({i} + 1)/3, ")
    });
    family.add("inputs", "u[n]", &(0..n).map(|i| format!("u_{i}, ")).collect::<String>());
    family.each("coordinates", (0, n), "0..n", "x[i], q[i],", |i| format!("x_{i}, q_{i}, "));
    if by_function {
        let text = "fn arm(angle, length) = length*vec(sin(angle), -cos(angle), 0);";
        family.add("let", text, text);
    }
    let arm = |q: &str, l: &str| match by_function {
        true => format!("arm({q}, {l})"),
        false => format!("{l}*vec(sin({q}), -cos({q}), 0)"),
    };
    let base = |i: &str| format!("vec({i}, 0, 0)");
    family.add(
        "let",
        &format!("let p[0] = {} + {};", base("x[0]"), arm("q[0]", "l[0]")),
        &format!("let p_0 = {} + {};", base("x_0"), arm("q_0", "l_0")),
    );
    let parent = |i: usize| if is_tree { (i - 1) / 2 } else { i - 1 };
    let written = if is_tree { "(i - 1)/2" } else { "i - 1" };
    let (hung, hung_by_hand): (String, Box<dyn Fn(usize) -> String>) = if is_chain {
        (
            format!("p[{written}] + {}", base("x[i]")),
            Box::new(|i| format!("p_{} + {}", parent(i), base(&format!("x_{i}")))),
        )
    } else {
        (base("x[i]"), Box::new(|i| base(&format!("x_{i}"))))
    };
    family.each("let", (1, n), "1..n", &format!("let p[i] = {hung} + {};", arm("q[i]", "l[i]")), |i| {
        format!("let p_{i} = {} + {};", hung_by_hand(i), arm(&format!("q_{i}"), &format!("l_{i}")))
    });
    family.each("parameters", (0, n), "0..=n-1", "w[i] = dot(q[i]); ", |i| format!("w_{i} = dot(q_{i}); "));
    family.each("parameters", (0, n - bound), "0..n-k", "v[i] = dot(x[i]); ", |i| {
        format!("v_{i} = dot(x_{i}); ")
    });
    family.each(
        "constraints",
        (n - bound, n),
        "n-k..n",
        "tie[i - (n-k)]: dot(x[i]) = dot(x[i-1])*cos(q[i]); ",
        |i| format!("tie_{}: dot(x_{i}) = dot(x_{})*cos(q_{i}); ", i - (n - bound), i.wrapping_sub(1)),
    );
    family.each("particles", (0, n), "0..n", "m[i] at p[i]; ", |i| format!("m_{i} at p_{i}; "));
    family.each("particles", (0, n), "0..n", "m[n-1-i]/2 at vec(x[i], 1, 0); ", |i| {
        format!("m_{}/2 at vec(x_{i}, 1, 0); ", last - i)
    });
    let turning: Vec<String> = (0..n).map(|i| format!("dot(q_{i})^2/10")).collect();
    family.add("kinetic_energy", "sum(i in 0..n: dot(q[i])^2/10)", &turning.join(" + "));
    // A sum over the pairs below the diagonal, and a product.
    let rows: Vec<String> = (0..n)
        .map(|i| {
            let row: Vec<String> = (0..i).map(|j| format!("s_{i}_{j}*(x_{i} - x_{j})^2/2")).collect();
            if row.is_empty() { "0".to_owned() } else { format!("({})", row.join(" + ")) }
        })
        .collect();
    let product: Vec<String> = (0..n).map(|i| format!("cos(q_{i})")).collect();
    family.add(
        "potential_energy",
        "sum(i in 0..n: sum(j in 0..i: s[i, j]*(x[i] - x[j])^2/2)) + product(i in 0..n: cos(q[i])) + x[0]^2",
        &format!("{} + {} + x_0^2", rows.join(" + "), product.join("*")),
    );
    family.each(
        "forces",
        (0, n),
        "0..n",
        "if i % 2 == 0 { u[i] - c*w[i] along w[i]; } else if i > 0 && i <= n { -c*dot(x[i]) along dot(x[i]); } ",
        |i| match i % 2 {
            0 => format!("u_{i} - c*w_{i} along w_{i}; "),
            _ => format!("-c*dot(x_{i}) along dot(x_{i}); "),
        },
    );
    let unused = (0..n).filter(|i| i % 2 == 1).map(|i| format!("u_{i} along w_{i}; ")).collect::<String>();
    family.add("forces", "for i in 0..n { if !(i % 2 == 0) { u[i] along w[i]; } }", &unused);
    family.each("outputs", (0, n), "0..n", "place[i] = p[i]; ", |i| format!("place_{i} = p_{i}; "));
    // Every constant is used.
    let all: Vec<String> = (0..n * n).map(|e| format!("s_{}_{}", e / n, e % n)).collect();
    family.add(
        "outputs",
        "stiffness = sum(a in 0..n: sum(b in 0..n: s[a, b])) + 0*x[0]; ",
        &format!("stiffness = {} + 0*x_0; ", sums_of_rows(&all, n)),
    );
    Pair { by_loop: family.text(true), by_hand: family.text(false) }
}

/// The sum of all entries, row by row.
fn sums_of_rows(entries: &[String], n: usize) -> String {
    let rows: Vec<String> = entries.chunks(n).map(|row| format!("({})", row.join(" + "))).collect();
    format!("({})", rows.join(" + "))
}

/// The values of every program of a derivation where its symbols, in the order of their declaration, have fixed values.
pub(super) fn values(derived: &DerivedSystem<'_>) -> (Vec<String>, Vec<Vec<u64>>) {
    let model = &derived.model;
    let symbol = |e: ExprId| model.bench.graph.as_symbol(e);
    let mechanics = &model.mechanics;
    let constants = model.constants.iter().map(|entry| entry.symbol);
    let all: Vec<SymbolId> = constants
        .chain([mechanics.forms.time])
        .chain(mechanics.forms.coordinates.iter().copied())
        .chain(mechanics.velocities.iter().copied())
        .chain(mechanics.etas.iter().copied())
        .chain(mechanics.accelerations.iter().copied())
        .chain(mechanics.inputs.iter().copied())
        .filter_map(symbol)
        .collect();
    let value = |symbol: SymbolId| {
        let place = all.iter().position(|known| *known == symbol).map_or(0, |place| place + 1);
        0.3 + (place as f64 * 0.618_034).fract()
    };
    let mut found = Vec::new();
    let mut costs = vec![format!("{:?}", derived.system.programs.prepare_cost)];
    for program in &derived.system.programs.functions {
        costs.push(format!("{}: {:?}", program.name, program.cost));
        let values = evaluated(&derived.system, &program.name, value).unwrap_or_default();
        found.push(values.into_iter().map(f64::to_bits).collect());
    }
    (costs, found)
}

#[test]
fn families_are_what_they_are_written_out() {
    let rounds = rounds(16);
    let seeds: Vec<u64> = (0..rounds).collect();
    let states: usize = by_two_threads(&seeds, |seed| {
        let Pair { by_loop, by_hand } = drawn(*seed);
        let of_loop = derived(&by_loop, values);
        derived(&by_hand, |derived| {
            let of_hand = values(derived);
            assert_eq!(of_loop.0, of_hand.0, "{by_loop}\n{by_hand}");
            assert!(of_loop.1 == of_hand.1, "{by_loop}\n{by_hand}");
            assert!(derived.system.program(function::RHS).is_some());
            difference(&by_hand, derived, *seed).1
        })
    })
    .into_iter()
    .sum();
    assert!(states as u64 >= rounds, "{states} states only");
}
