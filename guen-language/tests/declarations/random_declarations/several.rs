//! Scenes of drawn declarations that run through some modes of contacts. Rows that no mode lets move are zero in all of them: there the programs
//! of the scene are those of the whole system. Modes in which something holds, and nothing slips in space, move as the mechanism with these
//! constraints and with friction.

use guen_language::derive::{DerivedLevel, DerivedSystem, derive, function};
use guen_language::diagnostics::collect;
use guen_language::model::{self, ContactState};
use guen_language::parse;
use guen_language::syntax::Declaration;

use super::draw::Draw;
use super::modes::{Mode, contacts, in_numbers, states};
use super::{contacts as programs, grammar, held, scenes};
use crate::common::{by_two_threads, rounds};

/// A scene of several modes; some of few, some that track all there is.
fn scene(draw: &mut Draw, declaration: &Declaration) -> String {
    let few = draw.once_in(2);
    let mut modes = String::new();
    let mut count = 1;
    loop {
        for contact in contacts(declaration) {
            let mut all = states(contact);
            // Every second one is never open.
            if ["open", "free"].contains(&all[0]) && draw.once_in(2) {
                all = &all[1..];
            }
            let most = if count > 1 && few { 1 } else { draw.between(1, all.len()) };
            let mut places = draw.permutation(all.len());
            // In scenes of few modes, what can slip does so more often: the last state of its list.
            if few && draw.once_in(2) {
                places.sort_unstable_by(|a, b| b.cmp(a));
            }
            let mut chosen: Vec<&str> = places[..most].iter().map(|place| all[*place]).collect();
            // A scene has both directions of a slip, or one.
            chosen.sort_unstable();
            modes += &format!("{}: {}; ", contact.name, chosen.join(", "));
            count *= most;
        }
        if count > 1 {
            break;
        }
        modes.clear();
    }
    let names = scenes::Names::of(declaration);
    let variables = [&names.coordinates[..], &names.parameters, &names.states].concat();
    let tracked = if draw.once_in(2) { variables } else { scenes::some(draw, &variables, 2) };
    format!("scene Some {{ modes {{ {modes}}} track {}; }}", tracked.join(", "))
}

/// What holds in all modes of a level.
fn resting(derived: &DerivedSystem<'_>, level: &DerivedLevel) -> Mode {
    let model = &derived.model;
    let modes = &level.contacts.as_ref().expect("contacts").modes;
    let entries = model.contacts.iter().flat_map(|contacts| &contacts.entries).enumerate();
    let words = entries.map(|(place, entry)| {
        let mut known = modes.iter().map(|mode| entry.states()[mode[place]]);
        let first = known.next().expect("a mode");
        let others: Vec<ContactState> = known.filter(|state| *state != first).collect();
        let is_open = |state: &ContactState| matches!(state, ContactState::Open | ContactState::Free);
        if others.is_empty() {
            first.signed_word()
        } else if is_open(&first) || others.iter().any(is_open) {
            "open"
        } else {
            "slip"
        }
    });
    Mode::new(model.declaration, &words.collect::<Vec<&str>>())
}

#[derive(Default)]
struct Seen {
    programs: programs::Seen,
    rests: usize,
    held: Vec<held::Seen>,
}

fn look_at(derived: &DerivedSystem<'_>, draw: &mut Draw) -> Seen {
    let model = &derived.model;
    let Some(level) = derived.scenes.first() else { return Seen::default() };
    let Some(facts) = &level.contacts else { return Seen::default() };
    let resting = resting(derived, level);
    let all = resting.among(model.declaration);
    let on = in_numbers(&all, model, &resting.forms, draw);
    let held = facts.eliminated.iter().enumerate().map(|(k, place)| {
        let entries = model.contacts.iter().flat_map(|contacts| &contacts.entries);
        let words =
            entries.zip(&facts.modes[*place]).map(|(entry, state)| entry.states()[*state].signed_word());
        let mode = Mode::new(model.declaration, &words.collect::<Vec<&str>>());
        held::look_at(model, &mode, (model, level, &function::mode_rates(k)), draw)
    });
    let held = held.collect();
    Seen { programs: programs::look_at(derived, level, &on, draw), rests: resting.forms.len(), held }
}

#[test]
fn contacts_of_drawn_declarations_run_through_some_modes() {
    let rounds = rounds(8);
    // From seeds on among whose first scenes some slip along a line.
    let seeds: Vec<u64> = (30..30 + rounds).collect();
    let found = by_two_threads(&seeds, |seed| {
        let plain = match seed % 3 {
            0 => grammar::with_contacts(*seed),
            _ => grammar::with_contacts_of_one_formula(*seed),
        };
        let (declaration, _) = parse::parse(plain.parse().expect("tokens"));
        let mut draw = Draw::new(seed.rotate_left(29));
        let declaration = declaration.expect("a declaration");
        // Few have contacts of no kind.
        if contacts(&declaration).next().is_none() {
            return Ok(Seen::default());
        }
        let text = scenes::with(&plain, &[scene(&mut draw, &declaration)]);
        let (declaration, _) = parse::parse(text.parse().expect("tokens"));
        let declaration = declaration.expect("a declaration");
        let (derived, faults) = collect(|faults| derive(model::resolve(&declaration, faults)?, faults));
        match derived {
            Some(derived) if faults.is_empty() => Ok(look_at(&derived, &mut draw)),
            _ => Err(format!("{seed}: {}\n{text}", faults.faults()[0].message())),
        }
    });
    for message in found.iter().filter_map(|found| found.as_ref().err()) {
        println!("{message}");
    }
    let seen: Vec<&Seen> = found.iter().filter_map(|found| found.as_ref().ok()).collect();
    let sum = |of: fn(&Seen) -> usize| seen.iter().map(|seen| of(seen)).sum::<usize>();
    let states = sum(|seen| seen.programs.states);
    let rests = sum(|seen| if seen.programs.states > 0 { seen.rests } else { 0 });
    let held = sum(|seen| seen.held.iter().map(|held| held.states).sum());
    let slides = sum(|seen| seen.held.iter().map(|held| held.slides).sum());
    let worst =
        seen.iter().flat_map(|seen| seen.held.iter().map(|held| held.worst).chain([seen.programs.worst]));
    println!(
        "{states} states of {rounds} systems, {rests} rows that rest, {held} states of modes that hold with {slides} slips, at most {:.1e} of condition times scale",
        worst.fold(0.0, f64::max)
    );
    assert!(states as u64 >= rounds && rests > 0 && held > 0 && slides > 0, "{states} states");
    assert_eq!(seen.len(), found.len());
}
