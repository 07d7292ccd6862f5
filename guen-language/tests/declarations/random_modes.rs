//! Drawn systems with contacts in a single mode, in which some slip and others hold: beside the equations of motion with unknown
//! reactions, solved in numbers.

use crate::common::{derived, evaluated, rounds};
use guen_language::derive::function::{FREE_MOTION, RHS};
use guen_symbolic::{Graph, SymbolId};
use nalgebra::{DMatrix, DVector};

/// The coordinates, and as many parameters.
const N: usize = 4;

/// Numbers that look random, and are the same in every run.
struct Source(u64);

impl Source {
    fn number(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * ((self.0 >> 33) as f64 / (1_u64 << 31) as f64)
    }

    fn below(&mut self, count: usize) -> usize {
        (self.number(0.0, count as f64) as usize).min(count - 1)
    }

    /// A number with three digits, as a declaration has it.
    fn written(&mut self, low: f64, high: f64) -> String {
        format!("({:.2})", self.number(low, high))
    }

    fn coordinate(&mut self) -> String {
        format!("x{}", self.below(N))
    }

    /// A velocity: of some coordinates, with coefficients that depend on places.
    fn velocity(&mut self) -> String {
        let turns = self.below(N);
        let terms = (0..N).map(|i| match i == turns {
            true => format!("({} + sin({})/2)*dot(x{i})", self.written(-1.0, 1.0), self.coordinate()),
            false => format!("{}*dot(x{i})", self.written(-1.0, 1.0)),
        });
        let terms: Vec<String> = terms.collect();
        terms.join(" + ")
    }
}

/// How a contact is in the mode.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Now {
    Open,
    Held,
    /// In the sense of its slip, against it, or along it in a plane.
    Slips(f64),
}

/// A contact with its rows: that of its gap, if it has one, and those of its slip.
struct Contact {
    has_gap: bool,
    slips: usize,
    now: Now,
    /// The largest friction is `coefficient/(1 + fall*speed)` times the load.
    coefficient: f64,
    fall: f64,
    load: Load,
}

#[derive(Clone, Copy, PartialEq)]
enum Load {
    /// Of the gap of the contact itself.
    Own,
    Number(f64),
    /// Of the gap of the wall.
    Wall,
    /// The magnitude of the reaction of the permanent constraint.
    Permanent,
}

struct Drawn {
    text: String,
    contacts: Vec<Contact>,
    has_permanent: bool,
    coordinates: [f64; N],
}

fn drawn(source: &mut Source) -> Drawn {
    let energy: Vec<String> = (0..N)
        .flat_map(|i| {
            let own = format!("{}*dot(x{i})^2", source.written(1.0, 2.0));
            let others = (i.saturating_sub(1)..i).map(|j| {
                let (c, x) = (source.written(-0.3, 0.3), source.coordinate());
                format!("{c}*cos({x})*dot(x{i})*dot(x{j})")
            });
            others.chain([own]).collect::<Vec<String>>()
        })
        .collect();
    let potential: Vec<String> = (0..N)
        .map(|i| format!("{}*sin(x{i} + {})", source.written(-2.0, 2.0), source.coordinate()))
        .collect();
    let has_permanent = source.below(3) == 0;
    let parameters: Vec<String> = (0..N - usize::from(has_permanent))
        .map(|i| format!("p{i} = dot(x{i}) + {}*dot(x{});", source.written(-0.2, 0.2), N - 1))
        .collect();
    // Each gap has a coordinate of its own, so that the state can be put onto it.
    let gaps = ["sin(x2)/3", "x3*x2/5", "cos(x2)/2"];
    let mut coordinates: [f64; N] = std::array::from_fn(|_| source.number(-1.0, 1.0));
    let mut contacts: Vec<Contact> = Vec::new();
    let mut clauses = Vec::new();
    let mut states = Vec::new();
    let any_slip = |source: &mut Source, slips: usize| match slips {
        1 => Now::Slips(if source.below(2) == 0 { 1.0 } else { -1.0 }),
        _ => Now::Slips(0.0),
    };
    let word = |now: Now, is_smooth: bool| match now {
        Now::Open => "open",
        Now::Held if is_smooth => "closed",
        Now::Held => "stick",
        Now::Slips(sign) if sign > 0.0 => "slip+",
        Now::Slips(sign) if sign < 0.0 => "slip-",
        Now::Slips(_) => "slip",
    };
    let places = [0, 1, N - 1];
    for (k, name) in ["first", "second", "wall"].into_iter().enumerate() {
        let slips = [1, 2, 0][k];
        let now = match (source.below(4), slips) {
            (0, _) => Now::Open,
            (1, _) | (_, 0) => Now::Held,
            _ => any_slip(source, slips),
        };
        let (coefficient, fall) = (source.number(0.1, 0.6), source.number(0.0, 1.0));
        let velocity = match slips {
            1 => format!(", slip = {}", source.velocity()),
            2 => format!(", slip = vec({}, {})", source.velocity(), source.velocity()),
            _ => String::new(),
        };
        let friction =
            if slips > 0 { format!(", friction = {coefficient}/(1 + {fall}*speed)") } else { String::new() };
        clauses.push(format!("{name}: gap = x{} - {}{velocity}{friction};", places[k], gaps[k]));
        states.push(format!("{name}: {};", word(now, slips == 0)));
        contacts.push(Contact { has_gap: true, slips, now, coefficient, fall, load: Load::Own });
    }
    let now = if source.below(4) == 0 { Now::Held } else { any_slip(source, 1) };
    let (coefficient, fall) = (source.number(0.1, 0.6), source.number(0.0, 1.0));
    let load = match source.below(3) {
        0 => Load::Number(source.number(0.5, 3.0)),
        1 if has_permanent => Load::Permanent,
        _ => Load::Wall,
    };
    let clause = match load {
        Load::Number(load) => format!("{load}"),
        Load::Permanent => "reaction(guide)".to_owned(),
        _ => "reaction(wall)".to_owned(),
    };
    let velocity = source.velocity();
    clauses.push(format!(
        "brake: grip = {velocity}, friction = {coefficient}/(1 + {fall}*speed), load = {clause};"
    ));
    states.push(format!("brake: {};", word(now, false)));
    contacts.push(Contact { has_gap: false, slips: 1, now, coefficient, fall, load });
    let [x0, x1, x2, x3] = &mut coordinates;
    (*x0, *x3) = (x2.sin() / 3.0, x2.cos() / 2.0);
    *x1 = *x3 * *x2 / 5.0;
    let permanent = if has_permanent {
        format!("constraints {{ guide: {} = 0; }}", source.velocity())
    } else {
        String::new()
    };
    // All states of the brake would be more modes than there may be.
    let brakes = if now == Now::Held { "stick, slip+" } else { "slip" };
    let text = format!(
        "system Drawn {{
            coordinates {{ x0, x1, x2, x3 }}
            parameters {{ {} }}
            kinetic_energy = {};
            potential_energy = {};
            forces {{ -dot(x1)/3 along dot(x0) + dot(x1); }}
            {permanent}
            contacts {{ {} }}
            modes {{ brake: {brakes}; }}
            scene Now {{ modes {{ {} }} track x0, x1, x2, x3; }}
        }}",
        parameters.concat(),
        energy.join(" + "),
        potential.join(" + "),
        clauses.concat(),
        states.concat(),
    );
    Drawn { text, contacts, has_permanent, coordinates }
}

/// The equations with unknown reactions: `rate = free + response F`, `bias + D F = 0` for what is held.
struct Equations {
    free: Vec<f64>,
    rows: Vec<f64>,
    biases: Vec<f64>,
    delassus: DMatrix<f64>,
    responses: Vec<Vec<f64>>,
}

impl Equations {
    fn new(list: &[f64], l: usize, contacts: usize, count: usize) -> Self {
        let mut rest = list;
        let mut take = |length: usize| {
            let (own, others) = rest.split_at(length);
            rest = others;
            own.to_vec()
        };
        let free = take(N + l)[N..].to_vec();
        take(contacts);
        let (rows, biases) = (take(count), take(count));
        let lower = take(count * (count + 1) / 2);
        let delassus = DMatrix::from_fn(count, count, |i, j| {
            let (i, j) = (i.max(j), i.min(j));
            lower[i * (i + 1) / 2 + j]
        });
        let responses = (0..count).map(|_| take(l)).collect();
        Equations { free, rows, biases, delassus, responses }
    }
}

impl Drawn {
    /// The forces of all rows as `constant + factors unknowns`: the unknowns are the reactions of the rows that are held, and that of the
    /// permanent constraint with its sign.
    fn forces(&self, held: &[usize], slips: &[f64], sign: f64) -> (DVector<f64>, DMatrix<f64>) {
        let count = slips.len();
        let (mut constant, mut factors) = (DVector::zeros(count), DMatrix::zeros(count, held.len() + 1));
        for (unknown, row) in held.iter().enumerate() {
            factors[(*row, unknown)] = 1.0;
        }
        let mut first = 0;
        let wall = 5;
        for contact in &self.contacts {
            let along =
                first + usize::from(contact.has_gap)..first + usize::from(contact.has_gap) + contact.slips;
            if let Now::Slips(sense) = contact.now {
                let own = &slips[along.clone()];
                let speed = if sense == 0.0 { own[0].hypot(own[1]) } else { sense * own[0] };
                let friction = contact.coefficient / (1.0 + contact.fall * speed);
                for row in along.clone() {
                    let direction = if sense == 0.0 { slips[row] / speed } else { sense };
                    let force = -friction * direction;
                    let unknown = |row: usize| held.iter().position(|known| *known == row);
                    match contact.load {
                        Load::Number(load) => constant[row] += force * load,
                        Load::Permanent => factors[(row, held.len())] += force * sign,
                        Load::Own => factors[(row, unknown(first).unwrap())] += force,
                        Load::Wall => {
                            if let Some(unknown) = unknown(wall) {
                                factors[(row, unknown)] += force;
                            }
                        }
                    }
                }
            }
            first = along.end;
        }
        (constant, factors)
    }

    /// The rows that are held.
    fn held(&self) -> Vec<usize> {
        let mut first = 0;
        let mut held = Vec::new();
        for contact in &self.contacts {
            let normal = usize::from(contact.has_gap);
            let rows = match contact.now {
                Now::Open => 0,
                Now::Held => normal + contact.slips,
                Now::Slips(_) => normal,
            };
            held.extend(first..first + rows);
            first += normal + contact.slips;
        }
        held
    }
}

/// The rates of the parameters, of all equations at once; `None` close to a paradox.
fn rates(drawn: &Drawn, equations: &Equations, load: &[f64]) -> Option<Vec<f64>> {
    let held = drawn.held();
    let size = held.len() + 1;
    let mut found = Vec::new();
    for sign in [1.0, -1.0] {
        let (constant, factors) = drawn.forces(&held, &equations.rows, sign);
        let mut matrix = DMatrix::zeros(size, size);
        let mut right = DVector::zeros(size);
        let (pressed, given) = (&equations.delassus * &factors, &equations.delassus * &constant);
        for (i, row) in held.iter().enumerate() {
            matrix.row_mut(i).copy_from(&pressed.row(*row));
            right[i] = -equations.biases[*row] - given[*row];
        }
        // lambda = load_0 + sum_r load_r F_r.
        matrix[(size - 1, size - 1)] = 1.0;
        if let [free, slopes @ ..] = load {
            let slopes = DVector::from_column_slice(slopes);
            for unknown in 0..size {
                matrix[(size - 1, unknown)] -= slopes.dot(&factors.column(unknown));
            }
            right[size - 1] = free + slopes.dot(&constant);
        }
        let unknowns = matrix.clone().lu().solve(&right)?;
        let is_small = unknowns.iter().all(|u| u.abs() < 1e4);
        if !is_small || matrix.determinant().abs() < 1e-6 {
            return None;
        }
        if load.is_empty() || unknowns[size - 1] * sign >= 0.0 {
            let forces = constant + factors * unknowns;
            let rate = |s: usize| {
                let pressed =
                    forces.iter().zip(&equations.responses).map(|(force, response)| force * response[s]);
                equations.free[s] + pressed.sum::<f64>()
            };
            found.push((0..equations.free.len()).map(rate).collect::<Vec<f64>>());
        }
        if load.is_empty() {
            break;
        }
    }
    // Two or none: the magnitude of the reaction has several values, or none.
    (found.len() == 1).then(|| found.remove(0))
}

/// The value of a variable by its name: `x0`, `p0`.
fn value(graph: &Graph, symbol: SymbolId, coordinates: &[f64], parameters: &[f64]) -> f64 {
    let name = &graph.symbol_info(symbol).name;
    let place = name[1..].parse::<usize>();
    match (&name[..1], place) {
        ("x", Ok(place)) => coordinates[place],
        ("p", Ok(place)) => parameters[place],
        ("t", Err(_)) => 0.5,
        // The programs of the whole system hold the speed of a slip where they compute friction, which is not looked at here.
        _ if name.starts_with("speed of ") => 0.0,
        _ => panic!("{name}"),
    }
}

#[test]
fn drawn_contacts_slip_and_hold_in_one_mode() {
    let mut source = Source(7);
    let (mut compared, mut slipping, mut magnitudes) = (0, 0, 0);
    for round in 0..rounds(5) {
        let drawn = drawn(&mut source);
        let slips = drawn.contacts.iter().filter(|contact| matches!(contact.now, Now::Slips(_))).count();
        let held = drawn.held().len();
        if held + usize::from(drawn.has_permanent) >= N {
            continue;
        }
        derived(&drawn.text, |derived| {
            let l = N - usize::from(drawn.has_permanent);
            let graph = &derived.model.bench.graph;
            let (_, own) = &derived.in_modes[0];
            let level = &own.scenes[0];
            for _ in 0..20 {
                let at = |parameters: &[f64]| {
                    let value = |symbol: SymbolId| value(graph, symbol, &drawn.coordinates, parameters);
                    let list = evaluated(&derived.system, FREE_MOTION, value).expect("a program");
                    Equations::new(&list, l, drawn.contacts.len(), 7)
                };
                let at_rest = at(&vec![0.0; l]).rows;
                let columns: Vec<Vec<f64>> = (0..l)
                    .map(|s| at(&(0..l).map(|i| f64::from(u8::from(i == s))).collect::<Vec<f64>>()).rows)
                    .collect();
                // The nearest velocities that keep what is held.
                let held = drawn.held();
                let rows = DMatrix::from_fn(held.len(), l, |i, s| columns[s][held[i]] - at_rest[held[i]]);
                let mut parameters = DVector::from_fn(l, |_, _| source.number(-1.0, 1.0));
                if !held.is_empty() {
                    let off = &rows * &parameters + DVector::from_fn(held.len(), |i, _| at_rest[held[i]]);
                    let Some(inverse) = (&rows * rows.transpose()).try_inverse() else { continue };
                    parameters -= rows.transpose() * inverse * off;
                }
                let parameters: Vec<f64> = parameters.iter().copied().collect();
                let equations = at(&parameters);
                // A slip goes on in its sense.
                let mut places = drawn.contacts.iter().scan(0, |first, contact| {
                    let own = *first + usize::from(contact.has_gap);
                    *first = own + contact.slips;
                    Some((contact, own))
                });
                let is_against = |(contact, place): (&Contact, usize)| match contact.now {
                    Now::Slips(sense) => sense * equations.rows[place] < -0.3,
                    _ => false,
                };
                if places.any(is_against) {
                    continue;
                }
                let of_whole = |symbol: SymbolId| value(graph, symbol, &drawn.coordinates, &parameters);
                let load = match drawn.contacts[3].load {
                    Load::Permanent => evaluated(&derived.system, "loads", of_whole).expect("a program"),
                    _ => Vec::new(),
                };
                let Some(expected) = rates(&drawn, &equations, &load) else { continue };
                let graph = &own.model.bench.graph;
                let of_scene = |symbol: SymbolId| value(graph, symbol, &drawn.coordinates, &parameters);
                let found = evaluated(level, RHS, of_scene).expect("a program");
                let scale = expected.iter().fold(1.0, |a: f64, b| a.max(b.abs()));
                for (place, found) in level.selection.variables.iter().zip(&found) {
                    let name = own.model.variable_name(*place);
                    let Some(place) = name.strip_prefix('p').and_then(|place| place.parse::<usize>().ok())
                    else {
                        continue;
                    };
                    let expected = expected[place];
                    assert!(
                        (found - expected).abs() < 1e-9 * scale,
                        "{round}, {name}: {found} {expected}\n{}",
                        drawn.text
                    );
                    compared += 1;
                }
                slipping += slips;
                magnitudes += usize::from(!load.is_empty() && matches!(drawn.contacts[3].now, Now::Slips(_)));
            }
        });
    }
    println!("{compared} rates, {slipping} slips, {magnitudes} under the magnitude of a reaction");
    assert!(compared > 5 && slipping > 5);
}
