//! A mode of contacts of a drawn declaration: what holds in it as further constraints, and the friction of what slips.

use guen_language::model::Model;
use guen_language::parse;
use guen_language::syntax::{ClauseWord, Contact, Declaration, Expression, ExpressionKind, Item};
use nalgebra::{DMatrix, DVector};

use super::declared::Declared;
use super::draw::Draw;
use super::meaning::{Meaning, row_of};
use super::multipliers::{self, Multipliers};
use super::scalar::Dual;
use super::{Numbers, numbers_of};

/// The contacts of a declaration.
pub fn contacts(declaration: &Declaration) -> impl Iterator<Item = &Contact> {
    declaration.items.iter().flat_map(|item| match item {
        Item::Contacts(section) => &section.entries[..],
        _ => &[],
    })
}

/// The words of the states of a contact.
pub fn states(contact: &Contact) -> &'static [&'static str] {
    let slip = velocities(contact);
    let has_gap = contact.clause(ClauseWord::Gap).is_some();
    match (has_gap, slip, slip.is_some_and(is_vector)) {
        (true, Some(_), true) => &["open", "stick", "slip"],
        (true, Some(_), false) => &["open", "stick", "slip+", "slip-"],
        (true, None, _) => &["open", "closed"],
        (false, Some(_), true) => &["stick", "slip"],
        (false, Some(_), false) => &["stick", "slip+", "slip-"],
        (false, None, _) => &["free", "locked"],
    }
}

/// What vanishes where a contact sticks.
fn velocities(contact: &Contact) -> Option<&Expression> {
    let clause = contact.clause(ClauseWord::Slip).or(contact.clause(ClauseWord::Grip));
    clause.map(|clause| &clause.value)
}

fn is_vector(slip: &Expression) -> bool {
    matches!(&slip.kind, ExpressionKind::Call { function, .. } if function.text == "vec")
}

/// A mode as a scene says it, and what holds in it as constraints.
#[derive(Default)]
pub struct Mode {
    pub states: String,
    /// The names of the contacts so far.
    contacts: Vec<String>,
    holonomic: String,
    constraints: String,
    /// The names of these equations, component by component.
    pub forms: Vec<String>,
    pub slides: Vec<Slide>,
}

/// A contact that slips.
pub struct Slide {
    /// By its place among the contacts.
    contact: usize,
    /// The equation whose reaction presses; else there is a limit.
    pub pressing: Option<String>,
    /// Whether it presses in both directions, as the equations of the declaration do.
    pub either_way: bool,
    /// Along a line, the sign of the slip.
    sign: Option<f64>,
}

impl Mode {
    /// With a state for each contact.
    pub fn new(declaration: &Declaration, states: &[&str]) -> Self {
        let mut mode = Mode::default();
        let all = contacts(declaration).zip(states).enumerate();
        all.for_each(|(place, (contact, state))| mode.add(place, contact, state));
        mode
    }

    fn add(&mut self, place: usize, contact: &Contact, state: &str) {
        let clause = |word: ClauseWord| contact.clause(word).map(|clause| &clause.value);
        let name = &contact.name.text;
        self.states += &format!("{name}: {state}; ");
        self.contacts.push(name.clone());
        if ["open", "free"].contains(&state) {
            return;
        }
        let mut pressing = clause(ClauseWord::Load).and_then(row_of);
        let mut either_way = pressing.is_some();
        if let Some(other) = pressing.as_mut().filter(|other| self.contacts.contains(other)) {
            other.push_str("_gap");
            either_way = false;
        }
        if let Some(gap) = clause(ClauseWord::Gap).or(clause(ClauseWord::Latch)) {
            self.holonomic += &format!("{name}_gap: {gap} = 0; ");
            pressing = Some(format!("{name}_gap"));
            self.forms.push(format!("{name}_gap"));
        }
        if state.starts_with("slip") {
            let sign = match state {
                "slip+" => Some(1.0),
                "slip-" => Some(-1.0),
                _ => None,
            };
            // Under an open contact nothing presses.
            if either_way || pressing.iter().all(|form| self.forms.contains(form)) {
                self.slides.push(Slide { contact: place, pressing, either_way, sign });
            }
        } else if let Some(slip) = velocities(contact) {
            self.constraints += &format!("{name}_slip: {slip} = 0; ");
            if is_vector(slip) {
                self.forms.extend(["x", "y"].map(|axis| format!("{name}_slip_{axis}")));
            } else {
                self.forms.push(format!("{name}_slip"));
            }
        }
    }

    /// The declaration with these equations among its own.
    pub fn among(&self, declaration: &Declaration) -> Declaration {
        let text = format!(
            "system Held {{ holonomic {{ {} }} constraints {{ {} }} }}",
            self.holonomic, self.constraints
        );
        let (held, _) = parse::parse(text.parse().expect("tokens"));
        let mut all = declaration.clone();
        all.items.extend(held.expect("a declaration").items);
        all
    }

    /// The motion at a point and its unit of rounding; `None` where it slips in another sense, and close to a paradox.
    pub fn motion(&self, declared: &Declared<'_>, point: &[f64]) -> Option<(Multipliers, f64)> {
        let meaning = declared.meaning(point);
        let columns: Vec<Meaning<Dual<f64>>> = declared.by_velocities(point).collect();
        // The friction of each contact by a unit of its load, or at its limit, as a generalised force.
        let mut forces: Vec<Vec<f64>> = Vec::new();
        for slide in &self.slides {
            let touch = &meaning.contacts[slide.contact];
            let slips = touch.slips();
            let speed = slips.iter().fold(0.0_f64, |speed, slip| speed.hypot(*slip));
            if slide.sign.is_some_and(|sign| sign * slips[0] < 0.0) || speed < 0.05 {
                return None;
            }
            let size = if slide.pressing.is_some() { touch.friction } else { touch.limit };
            let force = columns.iter().map(|column| {
                let rows = column.contacts[slide.contact].slips();
                rows.iter().zip(slips).map(|(row, slip)| -size * slip / speed * row.du).sum()
            });
            forces.push(force.collect());
        }
        let sum = |loads: &[f64]| -> Vec<f64> {
            let of = |i: usize| forces.iter().zip(loads).map(|(force, load)| force[i] * load).sum();
            (0..declared.n).map(of).collect()
        };
        // Reactions are affine in the loads, and are the loads of what something presses on.
        let count = self.slides.len();
        let pressed = |motion: &Multipliers| -> DVector<f64> {
            let load = |slide: &Slide| match &slide.pressing {
                Some(form) => motion.reactions[declared.reaction(form).expect("an equation")],
                None => 1.0,
            };
            DVector::from_iterator(count, self.slides.iter().map(load))
        };
        let free = multipliers::solve(declared, point)?;
        let first = pressed(&free);
        let mut slopes = DMatrix::zeros(count, count);
        for k in 0..count {
            let one: Vec<f64> = (0..count).map(|i| if i == k { 1.0 } else { 0.0 }).collect();
            slopes.set_column(k, &(pressed(&multipliers::pushed(declared, point, &sum(&one))?) - &first));
        }
        // A reaction that presses either way is one or the other.
        let mut found = [1.0, -1.0].into_iter().filter_map(|sign| {
            let signs = self.slides.iter().map(|slide| if slide.either_way { sign } else { 1.0 });
            let signs = DMatrix::from_diagonal(&DVector::from_iterator(count, signs));
            let inverse = (DMatrix::identity(count, count) - &signs * &slopes).try_inverse()?;
            let loads = &inverse * signs * &first;
            let steepest = if count == 0 { 0.0 } else { inverse.amax() };
            let is_one =
                self.slides.iter().zip(loads.iter()).all(|(slide, load)| !slide.either_way || *load > 0.0);
            (steepest < 1e2 && is_one).then_some((loads, steepest))
        });
        let (loads, steepest) = found.next()?;
        if self.slides.iter().any(|slide| slide.either_way) && found.next().is_some() {
            return None;
        }
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

/// A declaration in which more holds than in that of a model, in numbers: velocities are given by coordinates that the constraints leave free.
pub fn in_numbers<'a>(
    all: &'a Declaration,
    model: &Model<'_>,
    further: &[String],
    draw: &mut Draw,
) -> Declared<'a> {
    let Numbers { coordinates, held, .. } = numbers_of(model);
    let names = |list: &[(String, _)]| list.iter().map(|(name, _)| name.clone()).collect::<Vec<String>>();
    let (coordinates, held) = (names(&coordinates), names(&held));
    let n = coordinates.len();
    let own = model.forms[model.mechanics.forms.degrees..].iter().map(|form| form.name.clone());
    let constraints: Vec<String> = own.chain(further.iter().cloned()).collect();
    // The rows of the constraints at some point tell which velocities can be given.
    let bare = Declared::new(all, coordinates.clone(), held.clone(), Vec::new(), 0);
    let point: Vec<f64> = (0..1 + 2 * n + held.len()).map(|_| draw.real(0.3, 0.9)).collect();
    let columns: Vec<Meaning<_>> = bare.by_velocities(&point).collect();
    let matrix = DMatrix::from_fn(constraints.len(), n, |row, i| columns[i].forms[&constraints[row]].du);
    let rows: Vec<DVector<f64>> = matrix.row_iter().map(|row| row.transpose()).collect();
    let free = free_coordinates(&rows, n);
    let degrees = free.len();
    let mut forms: Vec<String> = free.iter().map(|i| format!("{}_rate", coordinates[*i])).collect();
    forms.extend(constraints);
    Declared::new(all, coordinates, held, forms, degrees)
}
