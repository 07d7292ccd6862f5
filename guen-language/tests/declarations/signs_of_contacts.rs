//! Conditions and coefficients of contacts that are refused because of their sign: against values drawn at random, and examples that are
//! accepted.

use crate::common::{fault_messages, rounds};

/// The messages for a ball with a contact that says something more.
fn messages(clauses: &str) -> Vec<String> {
    let text = format!(
        "system Ball {{
            constants {{ m > 0, c >= 0, f, e in 0..1 = 1/2, k in 1..2 = 1 }}
            coordinates {{ x, z }}
            parameters {{ u = dot(x); w = dot(z); }}
            kinetic_energy = m/2*(u^2 + w^2);
            switches {{ ice: x - 5; }}
            forces {{ -c*e*k*f*ice*u along u; }}
            contacts {{ floor: gap = z, {clauses}; }}
        }}"
    );
    fault_messages(&text)
}

/// An expression with its values at some points.
#[derive(Clone)]
struct Drawn {
    text: String,
    values: Vec<f64>,
}

/// Numbers that look random, and are the same in every run.
struct Source(u64);

impl Source {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        self.0 >> 33
    }

    fn below(&mut self, count: usize) -> usize {
        usize::try_from(self.next()).expect("31 bits") % count
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        // The ends are drawn, too: there are the signs that are not seen inside.
        match self.below(6) {
            0 => low,
            1 => high,
            _ => low + (high - low) * (self.next() as f64 / (1_u64 << 31) as f64),
        }
    }
}

const POINTS: usize = 200;

/// The symbols with their values, as their bounds allow.
fn symbols(source: &mut Source, in_condition: bool) -> Vec<Drawn> {
    let mut all =
        vec![("m", [0.01, 9.0]), ("c", [0.0, 9.0]), ("f", [-9.0, 9.0]), ("e", [0.0, 1.0]), ("k", [1.0, 2.0])];
    if in_condition {
        all.extend([("x", [-9.0, 9.0]), ("u", [-9.0, 9.0]), ("ice", [0.0, 1.0])]);
    }
    all.into_iter()
        .map(|(name, [low, high])| {
            let whole = name == "ice";
            let value = |source: &mut Source| match whole {
                true => source.below(2) as f64,
                false => source.between(low, high),
            };
            Drawn { text: name.to_owned(), values: (0..POINTS).map(|_| value(source)).collect() }
        })
        .collect()
}

fn draw(source: &mut Source, symbols: &[Drawn], depth: usize) -> Drawn {
    if depth == 0 || source.below(4) == 0 {
        if source.below(3) == 0 {
            let number = source.below(7);
            return Drawn { text: format!("{number}/2"), values: vec![number as f64 / 2.0; POINTS] };
        }
        return symbols[source.below(symbols.len())].clone();
    }
    let a = draw(source, symbols, depth - 1);
    let of_one =
        |text: String, of: fn(f64) -> f64| Drawn { text, values: a.values.iter().map(|a| of(*a)).collect() };
    match source.below(8) {
        0 => of_one(format!("({})^2", a.text), |a| a * a),
        1 => of_one(format!("(-({}))", a.text), |a| -a),
        2 => of_one(format!("cos({})", a.text), f64::cos),
        3 => of_one(format!("exp({})", a.text), f64::exp),
        place => {
            let b = draw(source, symbols, depth - 1);
            let pairs = a.values.iter().zip(&b.values);
            let (sign, values): (_, Vec<f64>) = match place {
                4 | 5 => ('+', pairs.map(|(a, b)| a + b).collect()),
                6 => ('-', pairs.map(|(a, b)| a - b).collect()),
                _ => ('*', pairs.map(|(a, b)| a * b).collect()),
            };
            Drawn { text: format!("({} {sign} {})", a.text, b.text), values }
        }
    }
}

/// The size below which the sign of a sampled value is rounding.
const ROUNDING: f64 = 1e-9;

#[test]
fn a_condition_that_is_refused_has_one_sign() {
    let mut source = Source(7);
    let mut refused = [0; 2];
    for _ in 0..rounds(150) {
        let symbols = symbols(&mut source, true);
        let drawn = draw(&mut source, &symbols, 3);
        let found = messages(&format!("when = {}", drawn.text)).join("; ");
        let size = |value: &f64| ROUNDING * (1.0 + value.abs());
        match found.as_str() {
            "the condition of `floor` never holds" => {
                refused[0] += 1;
                assert!(drawn.values.iter().all(|v| *v <= size(v)), "{}: {:?}", drawn.text, drawn.values);
            }
            "the condition of `floor` always holds" => {
                refused[1] += 1;
                assert!(drawn.values.iter().all(|v| *v >= -size(v)), "{}: {:?}", drawn.text, drawn.values);
            }
            // Others have values that are no numbers, or are too large.
            _ => {}
        }
    }
    assert!(refused.iter().all(|count| *count >= 5), "{refused:?}");
}

#[test]
fn a_restitution_that_is_refused_has_values_outside() {
    let mut source = Source(11);
    let (mut refused, mut accepted) = (0, 0);
    for _ in 0..rounds(150) {
        let symbols = symbols(&mut source, false);
        let drawn = draw(&mut source, &symbols, 2);
        let found = messages(&format!("restitution = {}", drawn.text)).join("; ");
        let is_outside = |v: &f64| !(-ROUNDING..=1.0 + ROUNDING).contains(v);
        if found.contains("may lie outside")
            && !found.contains("`f`")
            && !found.contains("`m`")
            && !found.contains("`c`")
        {
            refused += 1;
            assert!(drawn.values.iter().any(is_outside), "{}: {found}", drawn.text);
        } else if found.contains("lies outside") {
            refused += 1;
            // An end that is not taken on may be met by rounding.
            assert!(
                drawn.values.iter().all(|v| is_outside(v) || (v * (1.0 - v)).abs() < 0.1),
                "{}: {found}",
                drawn.text
            );
        } else if found.is_empty() {
            accepted += 1;
        }
    }
    assert!(refused >= 10 && accepted >= 10, "{refused} {accepted}");
}

#[test]
fn what_may_have_either_sign_is_accepted() {
    for clauses in [
        "when = f - 1",
        "when = ice",
        "when = x*ice - u",
        "when = k - 1",
        "when = cos(x)",
        "restitution = e",
        "restitution = 1 - e",
        // Its terms reach 2, and it never exceeds 1/2.
        "restitution = 2*e*(1 - e)",
        "restitution = k/2",
        "restitution = f/2",
        "slip = u, friction = f",
        "slip = u, friction = k - 1",
        "slip = u, friction = c*speed",
        "slip = u, friction = k, stiction = 2*k",
        "slip = u, friction = 0",
    ] {
        assert_eq!(messages(clauses), [""; 0], "{clauses}");
    }
}
