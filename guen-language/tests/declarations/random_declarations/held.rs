//! Scenes of drawn declarations in a single mode of contacts: the mechanism with what holds as further constraints, and with the friction of
//! what slips, by Lagrange's equations with multipliers.

use guen_language::derive::{DerivedLevel, derive, function};
use guen_language::diagnostics::collect;
use guen_language::model::{self, Model};
use guen_language::parse;

use super::draw::Draw;
use super::modes::{Mode, contacts, in_numbers, states};
use super::{LARGEST, ROUNDING, STATES, grammar, scenes};
use crate::common::{by_two_threads, evaluated, rounds};

/// How much was compared, and the largest difference in units of rounding.
#[derive(Default)]
pub struct Seen {
    pub states: usize,
    held: usize,
    pub slides: usize,
    /// Slips under reactions of constraints, and under those of other contacts.
    pressed: [usize; 2],
    pub worst: f64,
}

/// The rates of a program of a level, over the symbols of a model, against those of the mechanism in a mode.
pub fn look_at(
    whole: &Model<'_>,
    mode: &Mode,
    (model, level, program): (&Model<'_>, &DerivedLevel, &str),
    draw: &mut Draw,
) -> Seen {
    let all = mode.among(whole.declaration);
    let declared = in_numbers(&all, whole, &mode.forms, draw);
    let n = declared.n;
    let mut seen = Seen::default();
    // Every second state slips in the other sense.
    for _ in 0..4 * STATES {
        if seen.states == STATES {
            break;
        }
        let Some((point, _)) = declared.state_with_zero(draw) else { continue };
        let Some((reference, unit)) = mode.motion(&declared, &point) else { continue };
        if unit > LARGEST {
            continue;
        }
        let moving = declared.along_motion(&point, &reference.second);
        let place = |list: &[String], name: &str| list.iter().position(|known| known == name);
        let coordinate = |name: &str| place(&declared.coordinates, name);
        let value = |name: &str| match (coordinate(name), place(&declared.held, name)) {
            _ if name == "t" => point[0],
            (Some(i), _) => point[1 + i],
            (_, Some(i)) => point[1 + 2 * n + i],
            _ => moving.forms.get(name).unwrap_or_else(|| panic!("no `{name}` in\n{all}")).re,
        };
        let graph = &model.bench.graph;
        let rates = evaluated(level, program, |symbol| value(&graph.symbol_info(symbol).name));
        let states = model.states.iter().map(|state| &state.name.text);
        for (found, variable) in rates.expect("a program").iter().zip(&level.selection.variables) {
            let name = model.variable_name(*variable);
            let expected = match (coordinate(name), states.clone().position(|state| *state == name)) {
                (Some(i), _) => point[1 + n + i],
                (_, Some(state)) => moving.state_rates[state].re,
                _ => moving.forms[name].du,
            };
            let ratio = (found - expected).abs() / unit;
            assert!(
                ratio <= ROUNDING,
                "{name}: {found}, and not {expected}, in\n{}\nof\n{}",
                mode.states,
                whole.declaration
            );
            seen.worst = seen.worst.max(ratio);
        }
        seen.states += 1;
        seen.held += mode.forms.len();
        seen.slides += mode.slides.len();
        for slide in &mode.slides {
            seen.pressed[0] += usize::from(slide.either_way);
            seen.pressed[1] += usize::from(!slide.either_way && slide.pressing.is_some());
        }
    }
    seen
}

/// A state of a contact; every second one is the last of its list, in which what can slip does.
fn state(draw: &mut Draw, states: &[&'static str]) -> &'static str {
    if draw.once_in(2) { states[states.len() - 1] } else { draw.pick(states) }
}

#[test]
fn contacts_of_drawn_declarations_hold_in_one_mode() {
    let rounds = rounds(8);
    let seeds: Vec<u64> = (0..rounds).collect();
    let found = by_two_threads(&seeds, |seed| {
        let plain = grammar::with_contacts_alone(*seed);
        let (declaration, _) = parse::parse(plain.parse().expect("tokens"));
        let declaration = declaration.expect("a declaration");
        let mut draw = Draw::new(seed.rotate_left(13));
        let chosen: Vec<&str> =
            contacts(&declaration).map(|contact| state(&mut draw, states(contact))).collect();
        let mode = Mode::new(&declaration, &chosen);
        let names = scenes::Names::of(&declaration);
        let tracked = [&names.coordinates[..], &names.states].concat().join(", ");
        let text =
            scenes::with(&plain, &[format!("scene Now {{ modes {{ {}}} track {tracked}; }}", mode.states)]);
        let (declaration, _) = parse::parse(text.parse().expect("tokens"));
        let declaration = declaration.expect("a declaration");
        let (derived, faults) = collect(|faults| derive(model::resolve(&declaration, faults)?, faults));
        match derived {
            Some(derived) if faults.is_empty() => {
                let (_, own) = &derived.in_modes[0];
                let level = (&own.model, &own.scenes[0], function::RHS);
                Ok(look_at(&derived.model, &mode, level, &mut draw))
            }
            _ => Err(format!("{seed}: {}", faults.faults()[0].message())),
        }
    });
    let refused: Vec<&String> = found.iter().filter_map(|found| found.as_ref().err()).collect();
    for message in &refused {
        println!("{message}");
        assert!(message.ends_with("nothing moves in the mode of scene `Now`"));
    }
    let seen: Vec<&Seen> = found.iter().filter_map(|found| found.as_ref().ok()).collect();
    let sum = |of: fn(&Seen) -> usize| seen.iter().map(|seen| of(seen)).sum::<usize>();
    let (states, held, slides) = (sum(|seen| seen.states), sum(|seen| seen.held), sum(|seen| seen.slides));
    let pressed = [0, 1].map(|kind| seen.iter().map(|seen| seen.pressed[kind]).sum::<usize>());
    let worst = seen.iter().map(|seen| seen.worst).fold(0.0, f64::max);
    println!(
        "{states} states of {rounds} systems, {} refused, {held} held rows, {slides} slips, {pressed:?} of them under reactions of constraints and of contacts, at most {worst:.1e} of condition times scale",
        refused.len()
    );
    assert!(states as u64 >= rounds && held > 0 && slides > 0, "{states} states");
}
