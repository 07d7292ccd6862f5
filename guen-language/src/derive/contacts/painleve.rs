//! Painlevé's paradox: whether the reactions have one value where contacts slip.
//!
//! In a mode whose rows with reactions are `R` these have the matrix `G = D_RR - sum_c v_c e_c^T`: `c` slips, `e_c` picks the row of the force
//! that loads its friction, and `v_c = mu_c D_Rt d_c` with the direction `d_c` of the slip. `D_RR` is positive definite, and falls into
//! blocks: the rows that its entries connect. Where no entry leads from a slip to a row that loads friction, `G` has the blocks of `D` on its
//! diagonal and nothing on one side of it, so that all of its principal minors are positive: for every free motion one reaction. Where a
//! slip reaches the row that loads it and no other such row, and this row is a block by itself, `p = D_nn - mu D_nt d > 0` is left to prove.

use guen_symbolic::{
    ExprId, Function, Graph, Limits, Node, Rational, Role, SignBound, Substitution, Verdict, Workbench,
    normal_coefficients, normal_form,
};

use crate::model::{ContactKind, ContactState, Contacts};

/// The results of the proofs that reactions have one value, mode by mode.
#[derive(Clone, Debug, Default)]
pub struct Painleve {
    /// The pairs of a contact that slips and one that touches for which the proof failed, for each mode.
    pub doubtful: Vec<Vec<(usize, usize)>>,
    /// The contacts whose `p` was proved to be positive.
    pub by_sign: Vec<usize>,
}

impl Painleve {
    /// Whether the reactions have one value in every mode.
    pub fn is_excluded(&self) -> bool {
        self.doubtful.iter().all(Vec::is_empty)
    }
}

/// The functions that the proof is about.
pub(super) struct Matrix<'m> {
    /// The Delassus matrix, its lower triangle row by row.
    pub(super) delassus: &'m [ExprId],
    pub(super) friction: &'m [ExprId],
    /// The reactions of permanent constraints that load grips, each before its derivatives by the forces of the rows.
    pub(super) loads: &'m [ExprId],
    /// Constants with their limits.
    pub(super) limits: &'m [(ExprId, [ExprId; 2])],
}

/// A row and the contact that it belongs to.
#[derive(Clone, Copy)]
struct Row {
    place: usize,
    contact: usize,
}

/// A contact that slips in a mode, with the row that loads it.
struct Slip {
    contact: usize,
    load: Row,
    tangential: Vec<Row>,
    /// The sign of the direction, where one is known.
    sign: Option<i64>,
}

/// Proves, for each of some modes, that the reactions have one value.
pub(super) fn prove(
    bench: &mut Workbench,
    contacts: &Contacts<'_>,
    modes: &[Vec<usize>],
    matrix: &Matrix<'_>,
) -> Painleve {
    let mut rows: Vec<Vec<Row>> = Vec::new();
    let mut count = 0;
    for (contact, entry) in contacts.entries.iter().enumerate() {
        let own = count..count + entry.rows.len();
        count = own.end;
        rows.push(own.map(|place| Row { place, contact }).collect());
    }
    let connected: Vec<bool> =
        matrix.delassus.iter().map(|entry| bench.verdict_on_manifold(*entry) != Verdict::Zero).collect();
    let entry = |v: Row, w: Row| {
        let (high, low) = (v.place.max(w.place), v.place.min(w.place));
        high * (high + 1) / 2 + low
    };
    let mut signs = Signs::new(contacts, matrix);
    let mut found = Painleve::default();
    for mode in modes {
        let states: Vec<ContactState> =
            contacts.entries.iter().zip(mode).map(|(entry, state)| entry.states()[*state]).collect();
        let active = active(contacts, &rows, &states);
        let slips = slips(bench, contacts, &rows, &states, matrix.friction);
        let is_load = |row: Row| slips.iter().any(|slip| slip.load.place == row.place);
        // The rows that load friction and that a slip reaches.
        let reached = |slip: &Slip| {
            let mut next = slip.tangential.clone();
            let mut known: Vec<Row> = Vec::new();
            while let Some(row) = next.pop() {
                for other in &active {
                    if connected[entry(row, *other)] && !known.iter().any(|row| row.place == other.place) {
                        known.push(*other);
                        next.push(*other);
                    }
                }
            }
            known.retain(|row| is_load(*row));
            known
        };
        let all: Vec<Vec<Row>> = slips.iter().map(reached).collect();
        let mut doubtful = Vec::new();
        for (slip, reached) in slips.iter().zip(&all) {
            let load = slip.load;
            let is_alone =
                active.iter().all(|other| other.place == load.place || !connected[entry(load, *other)]);
            let is_own = |reached: &[Row]| reached.iter().any(|row| row.place == load.place);
            let others = all.iter().filter(|reached| is_own(reached)).count();
            if reached.len() == 1
                && is_own(reached)
                && others == 1
                && is_alone
                && signs.is_positive(&mut bench.graph, slip, &entry)
            {
                if !found.by_sign.contains(&slip.contact) {
                    found.by_sign.push(slip.contact);
                }
                continue;
            }
            doubtful.extend(reached.iter().map(|row| (slip.contact, row.contact)));
        }
        // A load that the grip itself changes, or that what it presses does, may grow faster than friction does.
        let mut loads = matrix.loads.chunks(1 + count);
        for (contact, entry) in contacts.entries.iter().enumerate() {
            let Some(load) = entry.load_reaction.and_then(|_| loads.next()) else { continue };
            if !states[contact].slips() || bench.graph.is_zero(matrix.friction[contact]) {
                continue;
            }
            let moving = |row: &Row| {
                let state = states[row.contact];
                !matches!(state, ContactState::Open | ContactState::Free)
            };
            let mut acting: Vec<Row> = rows.iter().flatten().copied().collect();
            acting.retain(moving);
            acting.retain(|row| bench.verdict_on_manifold(load[1 + row.place]) != Verdict::Zero);
            let mut pressing: Vec<usize> = acting.iter().map(|row| row.contact).collect();
            pressing.dedup();
            doubtful.extend(pressing.into_iter().map(|other| (contact, other)));
        }
        found.doubtful.push(doubtful);
    }
    found
}

/// The rows that have reactions in a mode, beside those of what slips.
fn active(contacts: &Contacts<'_>, rows: &[Vec<Row>], states: &[ContactState]) -> Vec<Row> {
    let mut active = Vec::new();
    for ((entry, rows), state) in contacts.entries.iter().zip(rows).zip(states) {
        let normal = usize::from(entry.gap.is_some());
        active.extend(match state {
            ContactState::Open | ContactState::Free => &[],
            ContactState::Closed | ContactState::Locked | ContactState::Stick => &rows[..],
            ContactState::SlipPlus | ContactState::SlipMinus | ContactState::Slip => &rows[..normal],
        });
    }
    active
}

/// The contacts that slip in a mode under friction that some reaction loads.
fn slips(
    bench: &Workbench,
    contacts: &Contacts<'_>,
    rows: &[Vec<Row>],
    states: &[ContactState],
    friction: &[ExprId],
) -> Vec<Slip> {
    let mut slips = Vec::new();
    for (contact, entry) in contacts.entries.iter().enumerate() {
        let sign = match states[contact] {
            ContactState::SlipPlus => Some(1),
            ContactState::SlipMinus => Some(-1),
            ContactState::Slip => None,
            _ => continue,
        };
        let normal = usize::from(entry.gap.is_some());
        let load = match entry.kind {
            ContactKind::Grip => entry.loaded_by.and_then(|row| rows.iter().flatten().nth(row).copied()),
            _ => rows[contact].first().copied(),
        };
        let Some(load) = load.filter(|_| !bench.graph.is_zero(friction[contact])) else { continue };
        let is_open = matches!(states[load.contact], ContactState::Open | ContactState::Free);
        if !is_open {
            slips.push(Slip { contact, load, tangential: rows[contact][normal..].to_vec(), sign });
        }
    }
    slips
}

/// The signs of `p`, each asked for once.
struct Signs<'m> {
    matrix: &'m Matrix<'m>,
    /// Symbols between zero and one, and the magnitudes of slips.
    switches: Vec<ExprId>,
    speeds: Vec<ExprId>,
    stand_ins: Option<Substitution>,
    known: Vec<(usize, Option<i64>, bool)>,
}

impl<'m> Signs<'m> {
    fn new(contacts: &Contacts<'_>, matrix: &'m Matrix<'m>) -> Self {
        let switches = contacts.switches.iter().map(|switch| switch.symbol).collect();
        let speeds = contacts.entries.iter().filter_map(|entry| entry.speed).collect();
        Self { matrix, switches, speeds, stand_ins: None, known: Vec::new() }
    }

    /// Whether `D_nn - mu D_nt d` is seen to be positive for the directions of a slip. Where it slips in a plane, that is linear in the
    /// direction, and looked at in the corners of a square around the unit circle.
    fn is_positive(&mut self, graph: &mut Graph, slip: &Slip, entry: &impl Fn(Row, Row) -> usize) -> bool {
        let known =
            self.known.iter().find(|(contact, sign, _)| (*contact, *sign) == (slip.contact, slip.sign));
        if let Some((_, _, is_positive)) = known {
            return *is_positive;
        }
        let own = self.matrix.delassus[entry(slip.load, slip.load)];
        let friction = self.matrix.friction[slip.contact];
        let corners: Vec<Vec<i64>> = match slip.sign {
            Some(sign) => vec![vec![sign; slip.tangential.len()]],
            None => slip.tangential.iter().fold(vec![Vec::new()], |corners, _| {
                corners
                    .iter()
                    .flat_map(|corner| [1, -1].map(|sign| [&corner[..], &[sign]].concat()))
                    .collect()
            }),
        };
        let is_positive = corners.iter().all(|corner| {
            let mut along = graph.zero();
            for (row, sign) in slip.tangential.iter().zip(corner) {
                let part = self.matrix.delassus[entry(slip.load, *row)];
                let part = graph.scale(part, &Rational::from(*sign));
                along = graph.add(along, part);
            }
            let taken = graph.mul(friction, along);
            let p = graph.sub(own, taken);
            let p = self.stand_ins(graph).of(graph, p);
            is_above_zero(graph, p)
        });
        self.known.push((slip.contact, slip.sign, is_positive));
        is_positive
    }

    /// Expressions that take on exactly the values of what has limits: `lower + (upper - lower) sin(w)^2`.
    fn stand_ins(&mut self, graph: &mut Graph) -> &mut Substitution {
        let Self { matrix, switches, speeds, stand_ins, .. } = self;
        stand_ins.get_or_insert_with(|| {
            let unit = [graph.zero(), graph.one()];
            let limited = matrix.limits.iter().copied();
            let limited: Vec<_> = limited.chain(switches.iter().map(|switch| (*switch, unit))).collect();
            let mut pairs = Vec::new();
            for (place, (symbol, [lower, upper])) in limited.into_iter().enumerate() {
                let angle = graph.symbol(&format!("within the limits of {place}"), Role::Constant);
                let sine = graph.sin(angle);
                let square = graph.powi(sine, 2);
                let width = graph.sub(upper, lower);
                let above = graph.mul(width, square);
                pairs.push((symbol, graph.add(lower, above)));
            }
            for (place, speed) in speeds.iter().enumerate() {
                let name = format!("magnitude of {place}");
                pairs.push((*speed, graph.bounded_symbol(&name, Role::Input, SignBound::NonNegative)));
            }
            Substitution::new(pairs)
        })
    }
}

/// Whether an expression is seen to be positive: by the ranges of its terms, or as a quadratic form in the sine and cosine of an angle.
fn is_above_zero(graph: &mut Graph, e: ExprId) -> bool {
    if graph.is_above_zero(e) {
        return true;
    }
    let limits = Limits::default();
    let Some(normal) = normal_form(graph, e, &limits) else { return false };
    graph.is_above_zero(normal) || is_definite(graph, normal, &limits)
}

/// Whether an expression is `(a s^2 + 2 b s c + d c^2)` times what is positive, with `a > 0` and `a d > b^2`, for the sine `s` and the cosine
/// `c` of one of its angles; a number counts as `s^2 + c^2` times itself.
fn is_definite(graph: &mut Graph, e: ExprId, limits: &Limits) -> bool {
    let form = without_positive_factors(graph, e);
    angles(graph, form).into_iter().any(|angle| {
        let (sine, cosine) = graph.sin_cos(angle);
        let variables = ["sine", "cosine"].map(|name| graph.symbol(&format!("the {name}"), Role::Constant));
        let mut polynomial = Substitution::new([(sine, variables[0]), (cosine, variables[1])]);
        let form = polynomial.of(graph, form);
        let Some(coefficients) = normal_coefficients(graph, form, &variables, limits) else { return false };
        let of = |exponents: [u32; 2]| {
            coefficients.iter().find(|(found, _)| **found == exponents).map(|(_, coefficient)| *coefficient)
        };
        let is_quadratic = coefficients
            .iter()
            .all(|(exponents, _)| matches!(exponents[..], [0, 0] | [2, 0] | [1, 1] | [0, 2]));
        if !is_quadratic {
            return false;
        }
        let zero = graph.zero();
        let [alone, sines, mixed, cosines] = [[0, 0], [2, 0], [1, 1], [0, 2]].map(|e| of(e).unwrap_or(zero));
        let (a, d) = (graph.add(alone, sines), graph.add(alone, cosines));
        let product = graph.mul(a, d);
        let square = graph.powi(mixed, 2);
        let quarter = graph.scale(square, &Rational::new(1, 4));
        let determinant = graph.sub(product, quarter);
        [a, determinant].into_iter().all(|e| {
            graph.is_above_zero(e) || normal_form(graph, e, limits).is_some_and(|e| graph.is_above_zero(e))
        })
    })
}

/// An expression without the factors that are seen to be positive.
fn without_positive_factors(graph: &mut Graph, e: ExprId) -> ExprId {
    let Node::Product(factors) = graph.node(e).clone() else { return e };
    let is_positive = |(base, exponent): &(ExprId, i32)| {
        graph.is_above_zero(*base) || exponent % 2 == 0 && graph.vanishes_nowhere(*base)
    };
    let left: Vec<(ExprId, i32)> = factors.into_iter().filter(|factor| !is_positive(factor)).collect();
    graph.product(&left)
}

/// The angles whose sine or cosine an expression has.
fn angles(graph: &Graph, e: ExprId) -> Vec<ExprId> {
    let mut angles = Vec::new();
    for id in graph.reachable(&[e], |_| false) {
        if let Node::Function(Function::Sin | Function::Cos, angle) = graph.node(id)
            && !angles.contains(angle)
        {
            angles.push(*angle);
        }
    }
    angles
}
