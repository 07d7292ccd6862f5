//! Scenes of drawn declarations in a single mode of contacts: the mechanism with what holds as further constraints, and with the friction of
//! what slips, by Lagrange's equations with multipliers.

use guen_language::derive::{Derived, derive, function};
use guen_language::diagnostics::collect;
use guen_language::syntax::{ClauseWord, Contact, Declaration, ExpressionKind, Item};
use guen_language::{model, parse};
use nalgebra::{DMatrix, DVector};

use super::declared::Declared;
use super::draw::Draw;
use super::meaning::Meaning;
use super::multipliers::{self, Multipliers};
use super::scalar::Dual;
use super::{LARGEST, Numbers, ROUNDING, STATES, grammar, numbers, scenes};
use crate::common::{by_two_threads, evaluated, rounds};

/// A mode as a scene says it, and what holds in it as constraints.
#[derive(Default)]
struct Mode {
    states: String,
    holonomic: String,
    constraints: String,
    /// The names of these equations, component by component.
    forms: Vec<String>,
    slides: Vec<Slide>,
}

/// A contact that slips.
struct Slide {
    /// By its place among the contacts.
    contact: usize,
    /// The equation whose reaction presses, by its place among those of the mode; a grip has a limit.
    gap: Option<usize>,
    /// Along a line, the sign of the slip.
    sign: Option<f64>,
}

impl Mode {
    fn drawn(draw: &mut Draw, declaration: &Declaration) -> Self {
        let mut mode = Mode::default();
        for item in &declaration.items {
            if let Item::Contacts(section) = item {
                section.entries.iter().enumerate().for_each(|(place, own)| mode.add(draw, place, own));
            }
        }
        mode
    }

    fn add(&mut self, draw: &mut Draw, place: usize, contact: &Contact) {
        let clause = |word: ClauseWord| contact.clause(word).map(|clause| &clause.value);
        let name = &contact.name.text;
        let slip = clause(ClauseWord::Slip).or(clause(ClauseWord::Grip));
        let in_plane = slip.is_some_and(
            |slip| matches!(&slip.kind, ExpressionKind::Call { function, .. } if function.text == "vec"),
        );
        let (slides, sign) = match draw.below(2) {
            _ if in_plane => ("slip", None),
            0 => ("slip+", Some(1.0)),
            _ => ("slip-", Some(-1.0)),
        };
        let state = match (clause(ClauseWord::Gap), slip) {
            (Some(_), Some(_)) => draw.pick(&["open", "stick", slides]),
            (Some(_), None) => draw.pick(&["open", "closed"]),
            (None, Some(_)) => draw.pick(&["stick", slides]),
            (None, None) => draw.pick(&["free", "locked"]),
        };
        self.states += &format!("{name}: {state}; ");
        if ["open", "free"].contains(&state) {
            return;
        }
        let mut pressing = None;
        if let Some(gap) = clause(ClauseWord::Gap).or(clause(ClauseWord::Latch)) {
            self.holonomic += &format!("{name}_gap: {gap} = 0; ");
            pressing = Some(self.forms.len());
            self.forms.push(format!("{name}_gap"));
        }
        if state == slides {
            self.slides.push(Slide { contact: place, gap: pressing, sign });
        } else if let Some(slip) = slip {
            self.constraints += &format!("{name}_slip: {slip} = 0; ");
            if in_plane {
                self.forms.extend(["x", "y"].map(|axis| format!("{name}_slip_{axis}")));
            } else {
                self.forms.push(format!("{name}_slip"));
            }
        }
    }

    /// The declaration with these equations among its own.
    fn among(&self, declaration: &Declaration) -> Declaration {
        let text = format!(
            "system Held {{ holonomic {{ {} }} constraints {{ {} }} }}",
            self.holonomic, self.constraints
        );
        let (held, _) = parse::parse(text.parse().expect("tokens"));
        let mut all = declaration.clone();
        all.items.extend(held.expect("a declaration").items);
        all
    }
}

impl Mode {
    /// The motion at a point and its unit of rounding; `None` where it slips in another sense, and close to a paradox.
    fn motion(&self, declared: &Declared<'_>, point: &[f64], permanent: usize) -> Option<(Multipliers, f64)> {
        let meaning = declared.meaning(point);
        let columns: Vec<Meaning<Dual<f64>>> = declared.by_velocities(point).collect();
        // The friction of each contact by a unit of its load, or at its limit, as a generalised force.
        let mut forces: Vec<Vec<f64>> = Vec::new();
        for slide in &self.slides {
            let touch = &meaning.contacts[slide.contact];
            let normal = usize::from(slide.gap.is_some());
            let slips = &touch.rows[normal..];
            let speed = slips.iter().fold(0.0_f64, |speed, slip| speed.hypot(*slip));
            if slide.sign.is_some_and(|sign| sign * slips[0] < 0.0) || speed < 0.05 {
                return None;
            }
            let size = if slide.gap.is_some() { touch.friction } else { touch.limit };
            let force = columns.iter().map(|column| {
                let rows = &column.contacts[slide.contact].rows[normal..];
                rows.iter().zip(slips).map(|(row, slip)| -size * slip / speed * row.du).sum()
            });
            forces.push(force.collect());
        }
        let sum = |loads: &[f64]| -> Vec<f64> {
            let of = |i: usize| forces.iter().zip(loads).map(|(force, load)| force[i] * load).sum();
            (0..declared.n).map(of).collect()
        };
        // Reactions are affine in the loads, and are the loads of what has a gap.
        let count = self.slides.len();
        let pressed = |motion: &Multipliers| -> DVector<f64> {
            let loads = self
                .slides
                .iter()
                .map(|slide| slide.gap.map_or(1.0, |gap| motion.reactions[permanent + gap]));
            DVector::from_iterator(count, loads)
        };
        let free = multipliers::solve(declared, point)?;
        let first = pressed(&free);
        let mut matrix = DMatrix::identity(count, count);
        for k in 0..count {
            let one: Vec<f64> = (0..count).map(|i| if i == k { 1.0 } else { 0.0 }).collect();
            let change = pressed(&multipliers::pushed(declared, point, &sum(&one))?) - &first;
            matrix.set_column(k, &(matrix.column(k) - change));
        }
        let inverse = matrix.try_inverse().filter(|inverse| count == 0 || inverse.amax() < 1e2)?;
        let steepest = if count == 0 { 0.0 } else { inverse.amax() };
        let loads = inverse * first;
        let largest = loads.iter().fold(1.0_f64, |most, load| most.max(load.abs()));
        let motion = multipliers::pushed(declared, point, &sum(loads.as_slice()))?;
        let unit = motion.condition * motion.scale.max(free.scale) * (1.0 + steepest) * largest;
        Some((motion, unit))
    }
}

/// The coordinates whose velocities the constraints leave free, as many as there are degrees of freedom: those that are furthest from
/// what the constraints say.
fn free_coordinates(rows: &[DVector<f64>], n: usize) -> Vec<usize> {
    let mut known: Vec<DVector<f64>> = Vec::new();
    let apart = |known: &[DVector<f64>], row: &DVector<f64>| {
        known.iter().fold(row.clone(), |left, own| &left - own * own.dot(&left))
    };
    for row in rows {
        let left = apart(&known, row);
        known.push(left.normalize());
    }
    let mut free = Vec::new();
    while known.len() < n {
        let candidates = (0..n).map(|i| {
            let mut unit = DVector::zeros(n);
            unit[i] = 1.0;
            (i, apart(&known, &unit))
        });
        let (i, left) = candidates.max_by(|a, b| a.1.norm().total_cmp(&b.1.norm())).expect("a coordinate");
        known.push(left.normalize());
        free.push(i);
    }
    free
}

#[derive(Default)]
struct Seen {
    states: usize,
    held: usize,
    slides: usize,
    worst: f64,
}

fn look_at(text: &str, derived: &Derived<'_>, mode: &Mode, draw: &mut Draw) -> Seen {
    let all = mode.among(derived.model.declaration);
    let Numbers { coordinates, held, .. } = numbers(derived);
    let names = |list: &[(String, _)]| list.iter().map(|(name, _)| name.clone()).collect::<Vec<String>>();
    let (coordinates, held) = (names(&coordinates), names(&held));
    let n = coordinates.len();
    let declared_forms = &derived.model.forms[derived.model.mechanics.forms.degrees..];
    let permanent = declared_forms.len();
    let constraints: Vec<String> =
        declared_forms.iter().map(|form| form.name.clone()).chain(mode.forms.iter().cloned()).collect();
    // The rows of the constraints at some point tell which velocities can be given.
    let bare = Declared::new(&all, coordinates.clone(), held.clone(), Vec::new(), 0);
    let point: Vec<f64> = (0..1 + 2 * n + held.len()).map(|_| draw.real(0.3, 0.9)).collect();
    let columns: Vec<Meaning<_>> = bare.by_velocities(&point).collect();
    let matrix = DMatrix::from_fn(constraints.len(), n, |row, i| columns[i].forms[&constraints[row]].du);
    let rows: Vec<DVector<f64>> = matrix.row_iter().map(|row| row.transpose()).collect();
    let free = free_coordinates(&rows, n);
    let degrees = free.len();
    let mut forms: Vec<String> = free.iter().map(|i| format!("{}_rate", coordinates[*i])).collect();
    forms.extend(constraints);
    let declared = Declared::new(&all, coordinates.clone(), held.clone(), forms, degrees);

    let (_, own) = &derived.in_modes[0];
    let (graph, level) = (&own.model.bench.graph, &own.scenes[0]);
    let mut seen = Seen::default();
    // Every second state slips in the other sense.
    for _ in 0..4 * STATES {
        if seen.states == STATES {
            break;
        }
        let Some((point, _)) = declared.state(draw) else { continue };
        let Some((reference, unit)) = mode.motion(&declared, &point, permanent) else { continue };
        if unit > LARGEST {
            continue;
        }
        let moving = declared.along_motion(&point, &reference.second);
        let place = |list: &[String], name: &str| list.iter().position(|known| known == name);
        let value = |name: &str| match (place(&coordinates, name), place(&held, name)) {
            _ if name == "t" => point[0],
            (Some(i), _) => point[1 + i],
            (_, Some(i)) => point[1 + 2 * n + i],
            _ => moving.forms.get(name).unwrap_or_else(|| panic!("no `{name}` in\n{text}")).re,
        };
        let rates = evaluated(level, function::RHS, |symbol| value(&graph.symbol_info(symbol).name));
        let states = own.model.states.iter().map(|state| &state.name.text);
        for (found, variable) in rates.expect("a program").iter().zip(&level.selection.variables) {
            let name = own.model.variable_name(*variable);
            let expected = match (place(&coordinates, name), states.clone().position(|state| *state == name))
            {
                (Some(i), _) => point[1 + n + i],
                (_, Some(state)) => moving.state_rates[state].re,
                _ => moving.forms[name].du,
            };
            let ratio = (found - expected).abs() / unit;
            assert!(
                ratio <= ROUNDING,
                "{name}: {found}, and not {expected}, in\n{}\nof\n{text}",
                mode.states
            );
            seen.worst = seen.worst.max(ratio);
        }
        seen.states += 1;
        seen.held += mode.forms.len();
        seen.slides += mode.slides.len();
    }
    seen
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
        let mode = Mode::drawn(&mut draw, &declaration);
        let names = scenes::Names::of(&declaration);
        let tracked = [&names.coordinates[..], &names.states].concat().join(", ");
        let text =
            scenes::with(&plain, &[format!("scene Now {{ modes {{ {}}} track {tracked}; }}", mode.states)]);
        let (declaration, _) = parse::parse(text.parse().expect("tokens"));
        let declaration = declaration.expect("a declaration");
        let (derived, faults) = collect(|faults| derive(model::resolve(&declaration, faults)?, faults));
        match derived {
            Some(derived) if faults.is_empty() => Ok(look_at(&text, &derived, &mode, &mut draw)),
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
    let worst = seen.iter().map(|seen| seen.worst).fold(0.0, f64::max);
    println!(
        "{states} states of {rounds} systems, {} refused, {held} held rows, {slides} slips, at most {worst:.1e} of condition times scale",
        refused.len()
    );
    assert!(states as u64 >= rounds && held > 0 && slides > 0, "{states} states");
}
