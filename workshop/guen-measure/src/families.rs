//! How families grow: expansion, emitted text and operations of systems whose members are declared by a loop.
//!
//! ```text
//! cargo run -p guen-measure --bin families
//! cargo run -p guen-measure --bin families -- snake       # those with this word in their names
//! cargo run -p guen-measure --bin families -- --quick     # small families: that it works
//! cargo run -p guen-measure --bin families -- rods 50 100 # with these numbers of members
//! ```
//!
//! Without `--release`, as cargo builds procedural macros. The times are processor times of the stages outside of a compiler, the least of
//! three expansions (of one, where it takes seconds). Behind each table stand the exponents between its last two sizes.

use std::env;

use guen_benchmarks::timing::processor_time;
use guen_language::diagnostics::collect;
use guen_language::{derive, emit, model, parse};
use guen_study::Table;

/// A family: its name, its declaration for a number of members, and the numbers that are tried.
struct Family {
    name: &'static str,
    declaration: fn(usize) -> String,
    sizes: &'static [usize],
}

const FAMILIES: [Family; 4] = [
    Family { name: "row of springs", declaration: row, sizes: &[10, 20, 50, 100, 200] },
    Family { name: "chain of particles", declaration: chain, sizes: &[10, 20, 50, 100] },
    Family { name: "chain of rods", declaration: rods, sizes: &[5, 10, 20, 40] },
    Family { name: "snake with casters", declaration: snake, sizes: &[5, 10, 20, 30] },
];

/// Masses in a row, joined by springs and dampers.
fn row(n: usize) -> String {
    format!(
        "pub system Row {{
            count n = {n};
            constants {{ m[n] > 0, k[n] >= 0, c >= 0 }}
            coordinates {{ x[n] }}
            kinetic_energy = sum(i in 0..n: m[i]/2*dot(x[i])^2);
            potential_energy = k[0]/2*x[0]^2 + sum(i in 1..n: k[i]/2*(x[i] - x[i-1])^2);
            forces {{ for i in 0..n {{ -c*x_rate[i] along x_rate[i]; }} }}
        }}"
    )
}

/// The chain of the contract.
fn chain(n: usize) -> String {
    format!(
        "pub system Chain {{
            count n = {n};
            constants {{ m[n] > 0, l[n] > 0 = 0.1, c >= 0, g = 9.81 }}
            coordinates {{ q[n] }}
            let p[0] = l[0]*vec(sin(q[0]), -cos(q[0]));
            for i in 1..n {{ let p[i] = p[i-1] + l[i]*vec(sin(q[i]), -cos(q[i])); }}
            parameters {{ for i in 0..n {{ w[i] = dot(q[i]); }} }}
            particles {{ for i in 0..n {{ m[i] at p[i]; }} }}
            forces {{ for i in 1..n {{ -c*(w[i] - w[i-1]) along w[i] - w[i-1]; }} }}
            gravity = vec(0, -g);
        }}"
    )
}

/// Rods on hinges, as bodies.
fn rods(n: usize) -> String {
    format!(
        "pub system Rods {{
            count n = {n};
            constants {{ m > 0, l > 0, J > 0, g = 9.81 }}
            coordinates {{ q[n] }}
            let turn[0] = rot_z(q[0]);
            for i in 1..n {{ let turn[i] = turn[i-1]*rot_z(q[i]); }}
            let tip[0] = l*turn[0].x;
            for i in 1..n {{ let tip[i] = tip[i-1] + l*turn[i].x; }}
            bodies {{
                for i in 0..n {{
                    rod[i] {{ mass: m, center: tip[i] - l/2*turn[i].x, inertia: diag(0, J, J), orientation: turn[i] }}
                }}
            }}
            gravity = vec(0, -g, 0);
        }}"
    )
}

/// Links on casters under their middles, joined at their ends.
fn snake(n: usize) -> String {
    format!(
        "pub system Snake {{
            count n = {n};
            constants {{ m > 0, J > 0, l > 0 }}
            inputs {{ torque[n-1] }}
            coordinates {{ x, y, q[n] }}
            for i in 0..n {{ let link[i] = rot_z(q[i]); }}
            let p[0] = vec(x, y);
            for i in 1..n {{ let p[i] = p[i-1] - l*link[i-1].x - l*link[i].x; }}
            bodies {{
                for i in 0..n {{ b[i] {{ mass: m, inertia: diag(0, 0, J), center: p[i], orientation: link[i] }} }}
            }}
            parameters {{ speed = inner(link[0].x, dot(p[0])); turning = dot(q[0]); }}
            constraints {{ for i in 0..n {{ caster[i]: inner(link[i].y, dot(p[i])) = 0; }} }}
            forces {{ for i in 0..n-1 {{ torque[i] along dot(q[i+1]) - dot(q[i]); }} }}
        }}"
    )
}

fn main() {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let is_quick = arguments.iter().any(|argument| argument == "--quick");
    let numbers: Vec<usize> = arguments.iter().filter_map(|argument| argument.parse().ok()).collect();
    let is_word = |argument: &&String| !argument.starts_with("--") && argument.parse::<usize>().is_err();
    let asked: Vec<&String> = arguments.iter().filter(is_word).collect();
    for Family { name, declaration, sizes } in FAMILIES {
        if !asked.is_empty() && !asked.iter().any(|word| name.contains(word.as_str())) {
            continue;
        }
        let mut table =
            Table::new(&["members", "expansion / ms", "emitted / kB", "operations", "per member"]).digits(4);
        let mut rows: Vec<[f64; 4]> = Vec::new();
        let sizes = if numbers.is_empty() { sizes } else { &numbers[..] };
        for size in sizes.iter().take(if is_quick { 1 } else { usize::MAX }) {
            match measured(&declaration(*size)) {
                Ok([time, bytes, operations]) => {
                    let members = *size as f64;
                    rows.push([members, time, bytes, operations]);
                    table.row(&[members, time * 1e3, bytes / 1e3, operations, operations / members]);
                }
                Err(error) => {
                    eprintln!("{name}, {size}: {error}");
                    break;
                }
            }
        }
        println!("{name}\n\n{table}");
        if let [.., a, b] = &rows[..] {
            let exponent = |column: usize| (b[column] / a[column]).ln() / (b[0] / a[0]).ln();
            let [time, bytes, operations] = [1, 2, 3].map(exponent);
            println!("exponents of the last two sizes: {time:.2}, {bytes:.2}, {operations:.2}");
        }
        println!();
    }
}

/// The time of an expansion in seconds, the bytes that it emits, and the operations of a right-hand side.
fn measured(text: &str) -> Result<[f64; 3], String> {
    let mut best = [f64::INFINITY, 0.0, 0.0];
    for _ in 0..3 {
        let tokens = text.parse().map_err(|error| format!("{error:?}"))?;
        let start = processor_time();
        let (parsed, report) = parse::parse(tokens);
        let parsed = parsed.filter(|_| report.is_empty()).ok_or_else(|| report.to_string())?;
        let (resolved, report) = collect(|faults| model::resolve(&parsed, faults));
        let resolved = resolved.ok_or_else(|| report.to_string())?;
        let (derived, report) = collect(|faults| derive::derive(resolved, faults));
        let derived = derived.ok_or_else(|| report.to_string())?;
        let rates = derived.system.program(derive::function::RHS).map(|program| program.cost);
        let cost = rates.unwrap_or_default();
        let operations = f64::from(cost.operations() + cost.sines + cost.calls);
        let bytes = emit::emit(derived).to_string().len() as f64;
        let time = processor_time() - start;
        best = [best[0].min(time), bytes, operations];
        if time > 2.0 {
            break;
        }
    }
    Ok(best)
}
