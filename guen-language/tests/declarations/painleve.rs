//! Painlevé's paradox: what is proved of it, against the matrices of the reactions in numbers, and where it is known to occur.

use guen_language::derive::{DerivedSystem, Painleve};
use guen_language::model::{ContactKind, ContactState};
use guen_language::report::ReportLines;
use guen_symbolic::evaluate_f64;
use nalgebra::DMatrix;

use crate::common::derived;

/// A uniform rod of length `2 l` with an end on the floor.
fn rod(constants: &str, friction: &str) -> String {
    format!(
        "system Rod {{
            constants {{ m > 0, l > 0, g = 9.81, {constants} }}
            coordinates {{ x, z, theta }}
            switches {{ ice: x - 5; }}
            let tip = vec(x - l*cos(theta), z - l*sin(theta));
            bodies {{ rod {{ mass: m, inertia: diag(0, 0, m*l^2/3), center: vec(x, z), orientation: rot_z(theta) }} }}
            gravity = vec(0, -g);
            parameters {{ u = dot(x); w = dot(z); omega = dot(theta); }}
            contacts {{ end: gap = tip.y, slip = dot(tip).x, friction = {friction}; }}
        }}"
    )
}

/// A particle with contacts.
fn particle(constants: &str, contacts: &str) -> String {
    format!(
        "system Particle {{
            constants {{ m > 0, {constants} }}
            coordinates {{ x, y, z }}
            particles {{ m at vec(x, y, z); }}
            parameters {{ u = dot(x); v = dot(y); w = dot(z); }}
            contacts {{ {contacts} }}
        }}"
    )
}

/// The modes in words in which a reaction may have no value or several, separated by semicolons.
fn doubtful(derived: &DerivedSystem<'_>) -> String {
    let contacts = derived.model.contacts.as_ref().unwrap();
    let facts = derived.system.contacts.as_ref().unwrap();
    let Painleve { doubtful, .. } = &facts.painleve;
    assert_eq!(doubtful.len(), facts.modes.len());
    let modes = facts.modes.iter().zip(doubtful).filter(|(_, doubtful)| !doubtful.is_empty());
    let modes = modes.map(|(mode, _)| {
        let states = contacts.entries.iter().zip(mode);
        states.map(|(entry, state)| entry.states()[*state].signed_word()).collect::<Vec<_>>().join(" ")
    });
    modes.collect::<Vec<_>>().join("; ")
}

/// A number of a sequence that is the same on every machine, between zero and one.
fn drawn(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 11) as f64 / (1_u64 << 53) as f64
}

/// The least principal minor, relative to that of the Delassus matrix, of the matrices of the reactions in modes without doubt and in
/// the others, at drawn states and constants.
fn least_minors(derived: &DerivedSystem<'_>, limits: &[(&str, f64, f64)]) -> [f64; 2] {
    let contacts = derived.model.contacts.as_ref().unwrap();
    let facts = derived.system.contacts.as_ref().unwrap();
    let graph = &derived.model.bench.graph;
    let friction: Vec<_> =
        contacts.entries.iter().map(|entry| entry.friction.unwrap_or(graph.zero())).collect();
    let roots = [&facts.delassus[..], &friction].concat();
    let count = facts.rows.len();
    let mut first = Vec::new();
    contacts.entries.iter().fold(0, |row, entry| {
        first.push(row);
        row + entry.rows.len()
    });
    let mut seed = 7;
    let mut least = [f64::INFINITY; 2];
    for _ in 0..600 {
        let mut numbers = std::collections::BTreeMap::new();
        for symbol in graph.symbols() {
            let name = graph.symbol_info(symbol).name.to_string();
            let part = drawn(&mut seed);
            let (low, high) = match limits.iter().find(|(known, ..)| *known == name) {
                Some((_, low, high)) => (*low, *high),
                None if name.starts_with("speed") => (0.0, 3.0),
                None if ["m", "l"].contains(&&name[..]) => (0.3, 2.0),
                None if name == "ice" => (0.0, 1.0),
                None => (-3.2, 3.2),
            };
            numbers.insert(symbol, low + (high - low) * part);
        }
        let values = evaluate_f64(graph, &roots, &|symbol| numbers[&symbol]);
        let d = |v: usize, w: usize| values[v.max(w) * (v.max(w) + 1) / 2 + v.min(w)];
        for (mode, doubts) in facts.modes.iter().zip(&facts.painleve.doubtful) {
            let states: Vec<_> =
                contacts.entries.iter().zip(mode).map(|(entry, state)| entry.states()[*state]).collect();
            let mut rows = Vec::new();
            let mut slips = Vec::new();
            let turn = 6.3 * drawn(&mut seed);
            for (c, entry) in contacts.entries.iter().enumerate() {
                let normal = usize::from(entry.kind != ContactKind::Grip);
                let direction: &[f64] = match states[c] {
                    ContactState::Open | ContactState::Free => continue,
                    ContactState::SlipPlus => &[1.0],
                    ContactState::SlipMinus => &[-1.0],
                    ContactState::Slip => &[turn.cos(), turn.sin()],
                    _ => &[],
                };
                let held = if direction.is_empty() { entry.rows.len() } else { normal };
                rows.extend(first[c]..first[c] + held);
                let load = if normal == 1 { Some(first[c]) } else { entry.loaded_by };
                if let Some(load) = load.filter(|_| !direction.is_empty()) {
                    slips.push((
                        load,
                        first[c] + normal,
                        direction.to_vec(),
                        values[facts.delassus.len() + c],
                    ));
                }
            }
            for set in 1_u32..1 << rows.len() {
                let own: Vec<usize> =
                    (0..rows.len()).filter(|i| set >> i & 1 == 1).map(|i| rows[i]).collect();
                let symmetric = DMatrix::from_fn(own.len(), own.len(), |i, j| d(own[i], own[j]));
                let matrix = DMatrix::from_fn(own.len(), own.len(), |i, j| {
                    let mut entry = d(own[i], own[j]);
                    for (_, along, direction, mu) in slips.iter().filter(|(load, ..)| *load == own[j]) {
                        let part = direction.iter().enumerate().map(|(k, part)| d(own[i], along + k) * part);
                        entry -= mu * part.sum::<f64>();
                    }
                    entry
                });
                let relative = matrix.determinant() / symmetric.determinant();
                let place = usize::from(!doubts.is_empty());
                least[place] = least[place].min(relative);
            }
            assert!(rows.iter().all(|row| *row < count));
        }
    }
    least
}

/// A declaration, the limits of its constants, and the modes for which nothing is proved.
type Case<'c> = (String, &'c [(&'c str, f64, f64)], &'c str);

/// Modes for which it is proved have matrices all of whose principal minors are positive; those of a system for which it is not have some
/// that are not.
#[test]
fn it_is_excluded_where_no_minor_vanishes() {
    let grip = "a: gap = z, slip = u, friction = mu; b: grip = u + w, limit = 1;";
    let both = "slip+; slip-";
    let cases: [Case; 10] = [
        // By hand: (1/m)(1 + 3 c^2 - 3 mu s c) is positive for mu < 4/3.
        (rod("mu in 0..13/10", "mu"), &[("mu", 0.0, 1.3)], ""),
        (rod("mu in 0..7/5", "mu"), &[("mu", 0.0, 1.4)], both),
        (rod("mu > 0", "mu"), &[("mu", 0.0, 4.0)], both),
        (rod("mu in 0..1, d >= 0", "mu/(1 + d*speed)"), &[("mu", 0.0, 1.0), ("d", 0.0, 2.0)], ""),
        (rod("mu in 0..1/4", "mu + ice"), &[("mu", 0.0, 0.25)], ""),
        // Its slip is against the floor in one direction.
        (
            particle("k in 0..3, mu in 0..2", "a: gap = z, slip = u + k*w, friction = mu;"),
            &[("k", 0.0, 3.0), ("mu", 0.0, 2.0)],
            "slip+",
        ),
        // No entry of D couples gap and slip, and a grip that holds does.
        (particle("mu in 0..3", grip), &[("mu", 0.0, 3.0)], "slip+ stick; slip- stick"),
        (
            particle(
                "mu in 0..3",
                "a: gap = z; b: grip = u, friction = mu, load = reaction(a); c: grip = u + w, limit = 1;",
            ),
            &[("mu", 0.0, 3.0)],
            "closed slip+ stick; closed slip- stick",
        ),
        (particle("mu > 0", "a: gap = z, slip = vec(u, v), friction = mu;"), &[("mu", 0.0, 4.0)], ""),
        (
            particle("mu in 0..1/2", "a: gap = z, slip = vec(u + w/2, v - w/2), friction = mu;"),
            &[("mu", 0.0, 0.5)],
            "",
        ),
    ];
    for (text, limits, expected) in cases {
        derived(&text, |derived| {
            assert_eq!(doubtful(derived), expected, "{text}");
            let [sure, other] = least_minors(derived, limits);
            assert!(sure > 0.0, "{sure}\n{text}");
            assert_eq!(other <= 0.0, !expected.is_empty(), "{other}\n{text}");
        });
    }
}

/// Two contacts that slip are beyond the proof by signs, be there a paradox or none; so is a gap that another one is coupled with.
#[test]
fn several_contacts_are_not_decided_by_signs() {
    let wedge = particle(
        "mu in 0..1/10",
        "a: gap = z, slip = u + w/9, friction = mu; b: gap = z + y, slip = u, friction = 0;",
    );
    derived(&wedge, |derived| {
        // Where the other is open, it is alone.
        let modes = doubtful(derived);
        assert!(modes.contains("slip+ stick") && modes.contains("slip- stick"), "{modes}");
        assert!(!modes.contains("open"), "{modes}");
        let [sure, _] = least_minors(derived, &[("mu", 0.0, 0.1)]);
        assert!(sure > 0.0, "{sure}");
    });
}

#[test]
fn the_report_has_the_reason() {
    let report =
        |text: &str| derived(text, |derived| ReportLines::of(&derived.model, &derived.system).to_text());
    let proved = report(&rod("mu in 0..1", "mu"));
    assert!(
        proved.contains(
            "where end slips, its reaction has one value: p = D_nn - mu D_nt > 0 by the bounds of constants"
        ),
        "{proved}"
    );
    let unknown = report(&rod("mu > 0", "mu"));
    assert!(
        unknown.contains("where end slips, its reaction may have no value, or several (Painlevé)"),
        "{unknown}"
    );
}
