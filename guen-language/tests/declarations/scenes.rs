//! Scenes of systems drawn at random: what each keeps is what its programs need, and no more, as finite differences of the
//! whole system's program show; and its rates are those of the whole.

use std::collections::BTreeSet;

use crate::common::{derived, evaluated, rounds};
use guen_language::derive::{DerivedLevel, DerivedSystem};
use guen_language::model;
use guen_symbolic::{Role, SymbolId};

/// A fixed sequence of numbers that looks random (a linear congruential generator, upper bits).
pub struct Sequence(pub u64);

impl Sequence {
    fn below(&mut self, limit: usize) -> usize {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((self.0 >> 33) as usize) % limit
    }

    fn unit(&mut self) -> f64 {
        0.5 + self.below(1 << 20) as f64 / f64::from(1 << 20)
    }

    fn pick<'a>(&mut self, list: &[&'a str]) -> &'a str {
        list[self.below(list.len())]
    }
}

const N: usize = 5;

/// A system of five coordinates and three to five parameters, sparsely coupled by forms, energies and forces; a scene for
/// each variable, one of them with a fixed constant.
pub fn declaration(draw: &mut Sequence) -> String {
    let coordinate = |draw: &mut Sequence| draw.pick(&["x1", "x2", "x3", "x4", "x5"]);
    let constrained = draw.below(3);
    let l = N - constrained;
    let mut text =
        String::from("pub system Drawn { constants { a, b, m > 0 } coordinates { x1, x2, x3, x4, x5 } ");
    let mut forms = Vec::new();
    for i in 1..=N {
        // A triangle of forms is independent: the velocity of its own, and of an earlier coordinate.
        let mut form = format!("dot(x{i})");
        if draw.below(3) == 0 {
            form = format!("{form}*(2 + sin({}))", coordinate(draw));
        }
        if i > 1 && draw.below(2) == 0 {
            let other = 1 + draw.below(i - 1);
            form =
                format!("{form} + {}*cos({})*dot(x{other})", draw.pick(&["1", "a", "b"]), coordinate(draw));
        }
        forms.push(form);
    }
    let list = |range: std::ops::Range<usize>, end: &dyn Fn(usize, &str) -> String| -> String {
        range.map(|i| end(i, &forms[i])).collect()
    };
    text += &format!("parameters {{ {} }} ", list(0..l, &|i, form| format!("e{} = {form}; ", i + 1)));
    if constrained > 0 {
        text += &format!("constraints {{ {} }} ", list(l..N, &|i, form| format!("c{}: {form} = 0; ", i + 1)));
    }
    let masses: Vec<String> = (1..=N)
        .map(|i| match draw.below(3) {
            0 => format!("(2 + sin({}))*dot(x{i})^2", coordinate(draw)),
            _ => format!("dot(x{i})^2"),
        })
        .collect();
    text += &format!("kinetic_energy = m/2*({}); ", masses.join(" + "));
    let potentials: Vec<String> = (0..2)
        .map(|_| match draw.below(3) {
            0 => format!("a*sin({})*{}", coordinate(draw), coordinate(draw)),
            1 => format!("b*{}^2", coordinate(draw)),
            // Written in two coordinates, and a constant.
            _ => {
                let (p, q) = (coordinate(draw), coordinate(draw));
                format!("(sin({p} + {q}) - sin({p})*cos({q}) - cos({p})*sin({q}))")
            }
        })
        .collect();
    text += &format!("potential_energy = {}; ", potentials.join(" + "));
    text += &format!("outputs {{ looked_at = {}*e1; size = a + b; }} ", coordinate(draw));
    for i in 1..=N {
        text += &format!("scene OfX{i} {{ track x{i}; }} scene WithoutA{i} {{ track x{i}; fix a = 0; }} ");
    }
    text += "scene Parameters { provide energy, looked_at; } }";
    text
}

/// The value of a symbol in a program of a level: constants and variables of the whole system, by name.
fn run(
    derived: &DerivedSystem<'_>,
    level: &DerivedLevel,
    name: &str,
    constants: [f64; 3],
    state: &[f64],
) -> Vec<f64> {
    let graph = &derived.model.bench.graph;
    let variables: Vec<_> =
        (0..state.len()).map(|p| graph.as_symbol(derived.model.variable(p)).unwrap()).collect();
    let value = |symbol: SymbolId| match graph.symbol_info(symbol).role {
        Role::Constant => {
            let is_it = |c: &&model::ConstantEntry<'_>| graph.as_symbol(c.symbol) == Some(symbol);
            constants[derived.model.constants.iter().position(|c| is_it(&c)).unwrap()]
        }
        _ => {
            let place = variables.iter().position(|known| *known == symbol).unwrap();
            let kept = level.selection.variables.contains(&place);
            assert!(kept, "`{name}` reads `{}`, which left", derived.model.variable_name(place));
            state[place]
        }
    };
    evaluated(level, name, value).expect("a program")
}

/// Which rates of the whole system change with which variable, somewhere.
fn pattern(derived: &DerivedSystem<'_>, constants: [f64; 3], draw: &mut Sequence) -> Vec<Vec<bool>> {
    let size = derived.system.selection.variables.len();
    let mut depends = vec![vec![false; size]; size];
    for _ in 0..6 {
        let state: Vec<f64> = (0..size).map(|_| draw.unit()).collect();
        let rates = run(derived, &derived.system, "rhs", constants, &state);
        for j in 0..size {
            let mut moved = state.clone();
            moved[j] += 0.25;
            for (i, rate) in run(derived, &derived.system, "rhs", constants, &moved).into_iter().enumerate() {
                depends[i][j] |= (rate - rates[i]).abs() > 1e-10 * (1.0 + rate.abs());
            }
        }
    }
    depends
}

fn closed(depends: &[Vec<bool>], start: impl IntoIterator<Item = usize>) -> BTreeSet<usize> {
    let mut kept: BTreeSet<usize> = start.into_iter().collect();
    while let Some(more) =
        kept.iter().find_map(|i| (0..depends.len()).find(|j| depends[*i][*j] && !kept.contains(j)))
    {
        kept.insert(more);
    }
    kept
}

#[test]
fn what_is_kept_is_what_the_numbers_need() {
    let rounds = rounds(4);
    let mut draw = Sequence(11);
    let (mut smaller, mut parts, mut scenes) = (0, 0, 0);
    for _ in 0..rounds {
        let text = declaration(&mut draw);
        derived(&text, |derived| {
            let size = derived.system.selection.variables.len();
            let general = pattern(derived, [0.7, -0.4, 1.3], &mut draw);
            let without_a = pattern(derived, [0.0, -0.4, 1.3], &mut draw);
            for (number, level) in derived.scenes.iter().enumerate() {
                let fixed = number < 2 * N && number % 2 == 1;
                let depends = if fixed { &without_a } else { &general };
                let start: Vec<usize> = if number < 2 * N { vec![number / 2] } else { (N..size).collect() };
                let expected = closed(depends, start);
                let kept: BTreeSet<usize> = level.selection.variables.iter().copied().collect();
                if number < 2 * N {
                    assert_eq!(kept, expected, "scene {number} of\n{text}");
                } else {
                    assert!(kept.is_superset(&expected), "scene {number} of\n{text}");
                }
                let constants = [if fixed { 0.0 } else { 0.7 }, -0.4, 1.3];
                let state: Vec<f64> = (0..size).map(|_| draw.unit()).collect();
                let whole = run(derived, &derived.system, "rhs", constants, &state);
                let rates = run(derived, level, "rhs", constants, &state);
                for (rate, place) in rates.iter().zip(&level.selection.variables) {
                    let same = (rate - whole[*place]).abs() <= 1e-11 * (1.0 + rate.abs());
                    assert!(same, "{rate} and {} of {place} in scene {number} of\n{text}", whole[*place]);
                }
                if number == 2 * N {
                    for name in ["energy", "outputs"] {
                        let (a, b) = (
                            run(derived, level, name, constants, &state)[0],
                            run(derived, &derived.system, name, constants, &state)[0],
                        );
                        assert!((a - b).abs() <= 1e-11 * (1.0 + a.abs()), "{name}: {a} and {b} of\n{text}");
                    }
                }
                scenes += 1;
                smaller += usize::from(kept.len() < size);
                parts += usize::from(level.scene.as_ref().unwrap().is_part);
            }
        });
    }
    println!("{scenes} scenes, {smaller} smaller than their systems, {parts} parts of their programs");
    assert!(smaller > scenes / 4 && smaller < scenes, "{smaller} of {scenes} are smaller");
}
