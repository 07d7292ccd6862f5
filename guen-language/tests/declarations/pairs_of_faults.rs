//! Two faults give two errors: every pair of single faults of different entries, put into one declaration in which nothing else is wrong.

use guen_language::diagnostics::collect;
use guen_language::{derive, model, parse, with_further_faults};

use crate::common::by_two_threads;

/// A declaration with an entry of every section that a fault can be in.
const SOUND: &str = "system Cart {
    count n = 2;
    constants {
        m: kg > 0, a: m > 0, J: kg*m^2 > 0, mu >= 0, e in 0..1 = 0, g: m/s^2 = 9.81, k[n]: N/m > 0, c: N*s/m >= 0,
        far: m = 9, tau: s > 0, hold: N*m > 0
    }
    inputs { push: N, pull }
    coordinates { x: m, z, phi: rad, y: m, s[n]: m }
    let height = z - a;
    fn weight(r) = m*g*r;
    parameters { u = dot(x); w = dot(z); spin = dot(phi); for i in 0..n { v[i] = dot(s[i]); } }
    constraints { guide: dot(y) = u; }
    kinetic_energy = m/2*(u^2 + w^2 + dot(y)^2) + J/2*spin^2 + sum(i in 0..n: m/2*v[i]^2);
    potential_energy = weight(z) + sum(i in 0..n: k[i]/2*s[i]^2);
    component Foot(level: scalar, ahead: scalar) {
        constants { rubber > 0, thick: m > 0 }
        contacts { sole: gap = level - thick, slip = ahead, friction = rubber; }
    }
    use Foot as left { level: z - x, ahead: u }
    states { dot(heat) = u^2 - heat/tau; }
    forces { push along u; -c*w along w; for i in 0..n { -pull*v[i] along v[i]; } }
    switches { ice: x - far; }
    contacts {
        floor: gap = height, slip = u - a*spin, friction = mu*(1 - ice), restitution = e;
        wall: gap = far - x;
        axle: grip = spin, limit = hold;
    }
    modes { left.sole: open; axle: stick; never floor.stick with wall.closed; }
    outputs { power = push*u; force = reaction(wall); first = s[0]; grasp = left.rubber; }
    scene Low { fix g = 1; track x; provide power; }
}";

/// The part of a declaration that a fault is in.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Part {
    /// A statement without which no motion can be derived.
    Core,
    /// A statement that the motion does not depend on, or a fault of dimensions, which hides nothing.
    Leaf,
    /// A fault that the derivation finds, in a core that is sound.
    DerivedSystem,
    /// One that leaves no equations of motion.
    Singular,
}

use Part::{Core, DerivedSystem, Leaf, Singular};

/// The part, what is right, what is wrong, and how the message begins.
const FAULTS: [(Part, &str, &str, &str); 54] = [
    // The grammar.
    (Core, "inputs { push: N, pull }", "inputs { push: N pull }", "expected"),
    (Core, "spin = dot(phi);", "spin == dot(phi);", "expected `=`, found `==`"),
    (Core, "= u^2 - heat/tau;", "= u^2 - ;", "expected"),
    (Core, "fn weight(r) =", "fn weight(r)", "expected"),
    (Leaf, "power = push*u;", "power push*u;", "expected"),
    (Leaf, "friction = mu*(1 - ice)", "frction = mu*(1 - ice)", "unknown word `frction`"),
    (Leaf, "push along u;", "push alng u;", "expected"),
    (Leaf, "track x;", "trak x;", ""),
    // Counts, components and instances, which many names depend on.
    (Core, "count n = 2;", "count n = 2 +;", "expected"),
    (Core, "count n = 2;", "count n == 2;", "expected"),
    (Core, "component Foot(level: scalar,", "component Foot(level: scalr,", "expected a kind of argument"),
    (Core, "constants { rubber > 0,", "constants { rubber >> 0,", "a bound compares with `0`"),
    (Core, "use Foot as left {", "use Foot left {", "expected"),
    (Core, "use Foot as left {", "use Foot as {", "expected"),
    (Core, "friction = rubber;", "friction = rubbr;", "unknown name `rubbr` in component `Foot`"),
    // Loops and components.
    (Core, "{ v[i] = dot(s[i]); }", "{ v[i] = dot(s[i + 1]); }", "`s[2]` is out of range"),
    (Leaf, "along v[i];", "along v[i + 1];", "`v[2]` is out of range"),
    (Core, "level: z - x, ahead: u", "level: z - x", ""),
    (Core, "sum(i in 0..n: m/2*v[i]^2)", "sum(i in 0..n: m/2*v[i]^2*i)", ""),
    // Names and kinds.
    (Core, "let height = z - a;", "let height = z - b;", "unknown name `b`"),
    (Core, "guide: dot(y) = u;", "guide: dot(y) = u^2;", "constraint `guide` is not"),
    (
        Core,
        "sum(i in 0..n: k[i]/2*s[i]^2)",
        "sum(i in 0..n: k[i]/2*v[i]^2)",
        "the force function cannot depend",
    ),
    (Core, "J/2*spin^2", "J/2*spin^3", "the kinetic energy is not quadratic"),
    (Core, "e in 0..1 = 0", "e in 0..1 = 2", ""),
    (Core, "w = dot(z);", "w = z;", "parameter `w` has no velocity"),
    (Leaf, "-c*w along w;", "-c*w along z;", "what follows `along` is a velocity"),
    (Leaf, "ice: x - far;", "ice: 5;", "the switch `ice` never changes"),
    (Leaf, "gap = far - x;", "gap = far - u;", "the gap of `wall` depends on a velocity"),
    (Leaf, "limit = hold;", "limit = -hold;", "the limit of `axle` is below zero"),
    (Leaf, "axle: stick;", "axle: open;", "`axle` has no state `open`"),
    (Leaf, "with wall.closed;", "with wal.closed;", "unknown contact `wal`"),
    (Leaf, "force = reaction(wall);", "force = reaction(wal);", "unknown"),
    (Leaf, "power = push*u;", "power = push*uu;", "unknown name `uu`"),
    (Leaf, "fix g = 1;", "fix gg = 1;", ""),
    (Leaf, "track x;", "track xx;", ""),
    (Leaf, "provide power;", "provide powr;", ""),
    (Leaf, "restitution = e;", "restitution = e + 1;", "restitution `e + 1` of `floor` may lie outside"),
    (Leaf, "friction = rubber;", "friction = -rubber;", "the friction of `left.sole` is below zero"),
    // Dimensions.
    (Leaf, "push along u;", "push + m*(g + a) along u;", "this sum adds different dimensions"),
    (Leaf, "let height = z - a;", "let height = z - a*a;", "this sum adds different dimensions"),
    (Leaf, "fn weight(r) = m*g*r;", "fn weight(r) = (m + a)*g*r;", "this sum adds different dimensions"),
    (Leaf, "J/2*spin^2", "(J + m)/2*spin^2", "this sum adds different dimensions"),
    (Leaf, "= u^2 - heat/tau;", "= u^2 - heat;", "the sides of this equation have different dimensions"),
    (Leaf, "limit = hold;", "limit = hold + m;", "this sum adds different dimensions"),
    (Leaf, "gap = level - thick,", "gap = level - thick*(1 + thick),", "this sum adds different dimensions"),
    (Leaf, "power = push*u;", "power = push*u + u*(m + a);", "this sum adds different dimensions"),
    (Leaf, "gap = far - x;", "gap = far - phi;", "this sum adds different dimensions"),
    (Leaf, "fix g = 1;", "fix g = a;", "`g` is in m/s^2, and this is in m"),
    (Leaf, "k[i]/2*s[i]^2", "k[i]/2*(s[i] + m)^2", "this sum adds different dimensions"),
    (Leaf, "guide: dot(y) = u;", "guide: dot(y) = u + (a - a);", "this sum adds different dimensions"),
    (Leaf, "level: z - x,", "level: z - x*x,", "this sum adds different dimensions"),
    // The derivation.
    (Singular, "J/2*spin^2", "0*spin^2", "cannot solve for the accelerations"),
    (DerivedSystem, "slip = u - a*spin", "slip = w", "the slip of `floor` is the rate of its gap"),
    (DerivedSystem, "gap = far - x;", "gap = y - x;", "the gap of `wall` never changes"),
];

/// Pairs of statements: a fault in the first one hides a fault in the second. Without a count nothing is known of entries, without the
/// name of an instance nothing of its members, and without the rates nothing of their energy.
const LOST: [(&str, &str); 5] = [
    ("count n", "[i"),
    ("use Foot", "level - thick"),
    ("use Foot", "= rubber;"),
    ("use Foot", "with wall.closed;"),
    ("{ v[i] =", "J/2*spin^2"),
];

/// The messages for a declaration.
fn messages(text: &str) -> Vec<String> {
    let tokens: proc_macro2::TokenStream = text.parse().expect("tokens");
    let (declaration, report) = parse::parse(tokens.clone());
    let declaration = declaration.expect("a head");
    let report = if report.is_empty() {
        collect(|faults| derive::derive(model::resolve(&declaration, faults)?, faults).map(|_| ())).1
    } else {
        with_further_faults(&tokens, &declaration, report)
    };
    report.faults().iter().map(|fault| fault.message().to_owned()).collect()
}

fn with(faults: &[usize]) -> String {
    let mut text = SOUND.to_owned();
    for fault in faults {
        let (_, right, wrong, _) = FAULTS[*fault];
        assert_eq!(text.matches(right).count(), 1, "`{right}` in\n{text}");
        text = text.replacen(right, wrong, 1);
    }
    text
}

/// Faults in tokens that do not balance are not told by the parser.
fn is_balanced(fault: usize) -> bool {
    let (_, _, wrong, _) = FAULTS[fault];
    wrong.matches('(').count() == wrong.matches(')').count()
}

/// The place of the statement that a text begins in.
fn statement(text: &str) -> usize {
    let before = SOUND.split(text).next().unwrap_or_default();
    before.matches(';').count()
}

#[test]
fn a_fault_gives_one_error() {
    assert_eq!(messages(SOUND), [""; 0]);
    let mut wrong = Vec::new();
    for fault in (0..FAULTS.len()).filter(|fault| is_balanced(*fault)) {
        let (.., message) = FAULTS[fault];
        let found = messages(&with(&[fault]));
        if found.len() != 1 || !found[0].starts_with(message) {
            wrong.push(format!("{:?}: {found:?}", FAULTS[fault]));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Of one pair in four: all of them take a minute unoptimised.
#[test]
fn two_faults_give_two_errors() {
    check_pairs(4);
}

#[test]
#[ignore = "`.ci/run` asks for it, optimised"]
fn every_two_faults_give_two_errors() {
    check_pairs(1);
}

/// Checks one pair of faults out of so many.
fn check_pairs(out_of: usize) {
    let usable: Vec<usize> = (0..FAULTS.len()).filter(|fault| is_balanced(*fault)).collect();
    let alone: Vec<Vec<String>> = by_two_threads(&usable, |fault| messages(&with(&[*fault])));
    let mut pairs = Vec::new();
    for (i, first) in usable.iter().enumerate() {
        for (j, second) in usable.iter().enumerate().take(i) {
            let (_, one, wrong, _) = FAULTS[*first];
            let (_, other, also_wrong, _) = FAULTS[*second];
            let is_same = statement(one) == statement(other) || wrong == also_wrong;
            // Nothing is said of the states of a contact that is faulty.
            let of_axle = [one, other].iter().all(|text| ["axle: stick;", "limit = hold;"].contains(text));
            let is_lost = LOST.iter().any(|(of, lost)| {
                one.starts_with(of) && other.contains(lost) || other.starts_with(of) && one.contains(lost)
            });
            if !is_same && !of_axle && !is_lost {
                pairs.push((i, j));
            }
        }
    }
    assert!(pairs.len() > 1_000, "{}", pairs.len());
    let pairs: Vec<(usize, usize)> = pairs.into_iter().step_by(out_of).collect();
    let found = by_two_threads(&pairs, |(i, j)| messages(&with(&[usable[*i], usable[*j]])));
    let mut wrong = Vec::new();
    for ((i, j), found) in pairs.iter().zip(found) {
        let parts = [FAULTS[usable[*i]].0, FAULTS[usable[*j]].0];
        let needed = |part: Part| match part {
            DerivedSystem => parts.iter().any(|other| matches!(other, Core | Singular)),
            Singular => parts.contains(&Core),
            Core | Leaf => false,
        };
        let is_underived = parts.into_iter().any(needed);
        // Names that nothing declares are told of the system where loops cannot be written out.
        let begin = |message: &str| message.split(" in ").next().map(String::from);
        let of_one = |fault: usize| {
            let message = alone[fault].first();
            message.is_some_and(|message| found.iter().any(|other| begin(other) == begin(message)))
        };
        let is_told = |fault: usize| of_one(fault) || needed(FAULTS[usable[fault]].0);
        let count = if is_underived { 1 } else { 2 };
        if found.len() != count || !is_told(*i) || !is_told(*j) {
            wrong.push(format!("{:?}\n{:?}\n    {found:?}", FAULTS[usable[*i]], FAULTS[usable[*j]]));
        }
    }
    assert!(wrong.is_empty(), "{} of {}\n{}", wrong.len(), pairs.len(), wrong.join("\n"));
}
