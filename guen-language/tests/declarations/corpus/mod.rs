//! The corpus of the damage test and of the fuzz target: sound declarations, texts that once failed, how tokens are
//! damaged, and what must hold whatever comes in.

use std::collections::BTreeSet;
use std::panic::{AssertUnwindSafe, catch_unwind};

use guen_language::diagnostics::{FaultReport, collect};
use guen_language::names::is_generated_item;
use guen_language::syntax::Declaration;
use guen_language::{derive, emit, expand_outline, model, parse, with_further_faults};
use proc_macro2::{Delimiter, Group, Span, TokenStream, TokenTree};

/// Sound declarations, small, with every section between them.
pub const SOUND: [&str; 10] = [
    "/// Resets of a system, of a loop and of an instance.
    system Clocked {
        component Counter(angle: scalar) {
            states { dot(turns) = 0; }
            resets { around: angle - 1 rises, turns = turns + 1; back: angle falls, turns = 0; }
        }
        count n = 2;
        constants { m > 0, period > 0 }
        inputs { push }
        coordinates { q[n] }
        parameters { for i in 0..n { w[i] = dot(q[i]); } }
        kinetic_energy = sum(i in 0..n: m/2*w[i]^2);
        states { dot(clock) = 1; }
        use Counter as left { angle: q[0] }
        switches { far: q[1] - 1; }
        forces { push*far along w[0]; }
        contacts { floor: gap = q[1]; }
        resets {
            tick: clock - period rises, clock = 0, w[1] = -w[1]*(1 - far), left.turns = push;
            for i in 0..n { end[i]: q[i] - 2 falls, q[i] = q[i] - 1, w[i] = dot(q[i])/2; }
        }
    }",
    "/// Components that use others.
    system Rover {
        component Motor(speed: scalar) {
            constants { gear > 0 = 3, twice = 2*gear }
            functions { torque(w); }
            fn scaled(x) = twice*x;
            forces { torque(scaled(speed)) along speed; }
        }
        component Leg(hip: vector, side: rotation, base: body, n: count) {
            constants { m > 0, reach[2] = 1/2 }
            coordinates { q[2] }
            for i in 0..n { let foot[i] = hip + side*vec(reach[i % 2]*q[0], 0, q[1]); }
            parameters { for i in 0..2 { w[i] = dot(q[i]); } }
            use Motor as motor { speed: w[0] }
            particles { for i in 0..n { if i != 1 { m at foot[i]; } else { m at foot[0] + base.center; } } }
            outputs { tip = foot[n - 1]; _own = motor.twice; }
        }
        count k = 2;
        constants { M > 0, g = 9.81 }
        coordinates { x }
        bodies { hull { mass: M, center: vec(x, 0, 1), inertia: diag(1, 1, 1), orientation: rot_y(x) } }
        parameters { u = dot(x); }
        for i in 0..k { use Leg as leg[i] { hip: hull.center, side: rot_z(x), base: hull, n: i + 1 } }
        use Motor as drive { speed: u - leg[1].w[0] }
        gravity = vec(0, 0, -g);
        outputs { height = leg[k-1].tip.z; }
        scene Still { track leg[0].q[0]; fix leg[0].m = 1, drive.gear = 2; provide height; }
    }",
    "/// A chain by a loop.
    system Chain {
        count n = 2 + 1;
        constants { m[n] > 0, k[n, 2] = 1/2, for i in 0..n { if i < 2 { l[i] = i } else { l[i] = 2*i - 1 } } }
        inputs { u[n] }
        coordinates { q[n] }
        let p[0] = vec(l[0] + q[0], k[0, 0]);
        for i in 1..=n-1 { let p[i] = p[i-1] + k[i % 2, 1]*vec(sin(q[i]), cos(q[i])); }
        parameters { for i in 0..n { w[i] = dot(q[i]); } }
        particles { for i in 0..n { m[i] at p[i]; } }
        bodies { for i in 0..1 { b[i] { inertia: diag(1, 1, 1), orientation: rot_z(q[i]) } } }
        potential_energy = sum(i in 1..n: l[i]*(q[i] - q[i-1])^2) + product(i in 0..n: q[i]);
        forces { for i in 0..n { if !(i == 1) && (i >= 0 || i != n) { u[i] along w[i]; } } u[1] along w[1]; }
        scene First { track q[0], w; fix m = 1, k[0, 1] = 2; }
    }",
    "/// A bead on a turning hoop.
    pub system Bead {
        constants { m > 0, R > 0, Omega, g = 9.81, k >= 0 = m*g/2 }
        coordinates { theta }
        parameters { omega = dot(theta); }
        kinetic_energy = m/2*R^2*(omega^2 + Omega^2*sin(theta)^2);
        potential_energy = -m*g*R*cos(theta) + k*theta^2/2;
    }",
    "pub system Sled {
        constants { m > 0, k > 0, alpha, incline, g = 9.81 }
        inputs { thrust }
        coordinates { phi, x, y }
        parameters { turning = dot(phi); speed = dot(x)*cos(phi) + dot(y)*sin(phi); }
        constraints { blade: dot(x)*sin(phi) = dot(y)*cos(phi); }
        let center_x = x + alpha*cos(phi);
        let center_y = y + alpha*sin(phi);
        kinetic_energy = m/2*(dot(center_x)^2 + dot(center_y)^2) + m/2*k^2*turning^2;
        force_function = m*g*sin(incline)*center_x;
        forces { thrust - 0.1*speed along speed; }
        outputs { height = center_x*tan(incline); place = vec(x, y); }
    }",
    "system Wheel {
        constants { m > 0, J > 0, a > 0 }
        coordinates { x, y, phi }
        let contact = vec(x, y - a);
        bodies { wheel { mass: m, inertia: diag(J, J, J), center: vec(x, y), orientation: rot_z(phi) } }
        gravity = vec(0, -9.81);
        holonomic { on_ground: y = a; }
        parameters { spin = dot(phi); }
        constraints { rolling: inner(wheel.velocity_at(contact), vec(1, 0)) = 0; }
    }",
    "pub(crate) system Pendulum {
        constants { l > 0, m > 0 }
        coordinates { x, y }
        holonomic { rod: x^2 + y^2 = l^2; }
        parameters { v = dot(x)*y - x*dot(y); }
        particles { m at vec(x, y); m/2 at vec(x, 0, -y); }
        gravity = vec(0, -9.81, 0);
    }",
    "system Shaken {
        constants { c != 0, m > 0 }
        coordinates { r#type, η }
        parameters { u = dot(r#type) - 2*cos(t); v = dot(η)*exp(-η/2) + u; }
        kinetic_energy = (m*u^2 + m*v^2)/2 + c*u + 1;
        force_function = -(r#type - η).powi(2)/2 + sqrt(1 + η^2) - ln(2) + pi;
    }",
    "system Plane {
        constants { m > 0 }
        coordinates { x, y }
        let p = vec(x, y);
        parameters { w = dot(p); }
        kinetic_energy = m/2*inner(dot(p), dot(p)) + 0*w_x;
        forces { -w along dot(p); (m/2)*unit(vec(1, 1)) along w; }
    }",
    "system Motor {
        constants { J: kg*m^2 > 0, R: Ohm, L: H > 0, k: N*m/A }
        inputs { u: V }
        coordinates { phi: rad }
        parameters { omega = dot(phi); }
        states { dot(current: A) = (u - R*current - k*omega)/L; dot(seen) = dot(omega) - seen/(1*t); dot(charge) = current; }
        kinetic_energy = J/2*omega^2;
        forces { k*current along omega; }
        outputs { slope = dot(current); }
        scene Electric { track current; provide slope; }
    }",
];

/// Texts that once failed.
pub const ONCE_FAILED: [&str; 12] = [
    "",
    "system",
    "system A {}",
    // A power of powers left the machine integers.
    "system A { coordinates { x } parameters { u = dot(x); } kinetic_energy = u^2; force_function = (((((x+1)^64)^64)^64)^64)^64; }",
    "system A { coordinates { x } let a = x^32; let b = a^64; let c = b^64; parameters { u = dot(x); } kinetic_energy = u^2; force_function = c.powi(64).powi(64); }",
    // A coefficient doubled its digits with every square.
    "system A { coordinates { x } let a = (3*x)^64; let b = a^8; let c = b*b*b*b; let d = c*c*c*c; parameters { u = dot(x); } kinetic_energy = u^2; force_function = d; }",
    "system A { coordinates { x } parameters { u = dot(x); } kinetic_energy = u^2/(x - x); force_function = 0^-1; }",
    "system A { coordinates { } kinetic_energy = 1; }",
    "system A { coordinates { } parameters { } particles { } }",
    "system A { coordinates { x, x } parameters { x = dot(x); } kinetic_energy = dot(x)^2; }",
    "system State { coordinates { x } parameters { u = dot(x); } kinetic_energy = u^2; }",
    "system A { coordinates { x } bodies { b { mass: 1, center: vec(b, x) } } parameters { u = dot(b.center); } }",
];

/// Tokens that take the place of others.
pub fn strangers() -> Vec<TokenTree> {
    let text = "x y m 0 1 2 1e300 t pi dot sin sqrt vec inner cross unit rot_z norm u v w + - * / ^ = : ; , . > ! \
                (x) (0) (x - x) {} let parameters constraints holonomic coordinates at along theta tan ln abs \
                functions component use as count for in if leg drive motor torque .w";
    text.parse::<TokenStream>().unwrap().into_iter().collect()
}

/// The stream with one token damaged, as `below` chooses: a number below the one given.
pub fn damaged(
    stream: TokenStream,
    pool: &[TokenTree],
    below: &mut dyn FnMut(usize) -> usize,
) -> TokenStream {
    let mut tokens: Vec<TokenTree> = stream.into_iter().collect();
    let groups: Vec<usize> =
        (0..tokens.len()).filter(|i| matches!(tokens[*i], TokenTree::Group(_))).collect();
    if !groups.is_empty() && below(6) > 0 {
        let at = groups[below(groups.len())];
        if let TokenTree::Group(group) = &tokens[at] {
            let delimiter = match below(40) {
                0 => Delimiter::None,
                1 => Delimiter::Brace,
                2 => Delimiter::Parenthesis,
                3 => Delimiter::Bracket,
                _ => group.delimiter(),
            };
            let mut inner = Group::new(delimiter, damaged(group.stream(), pool, below));
            inner.set_span(group.span());
            tokens[at] = TokenTree::Group(inner);
        }
    } else if !tokens.is_empty() {
        let (at, other) = (below(tokens.len()), below(tokens.len()));
        match below(5) {
            0 => drop(tokens.remove(at)),
            1 => tokens.insert(other, tokens[at].clone()),
            2 => tokens.swap(at, other),
            3 => {
                // Another word of the same declaration: names stay known, meanings do not.
                let mut token = tokens[other].clone();
                token.set_span(tokens[at].span());
                tokens[at] = token;
            }
            _ => {
                let mut token = pool[below(pool.len())].clone();
                relocate(&mut token, tokens[at].span());
                tokens[at] = token;
            }
        }
    }
    tokens.into_iter().collect()
}

/// A token with all that is inside of it at another place.
fn relocate(token: &mut TokenTree, span: Span) {
    if let TokenTree::Group(group) = token {
        let inside = group.stream().into_iter().map(|mut token| {
            relocate(&mut token, span);
            token
        });
        let mut moved = Group::new(group.delimiter(), inside.collect());
        moved.set_span(span);
        *token = TokenTree::Group(moved);
    } else {
        token.set_span(span);
    }
}

type Extent = ((usize, usize), (usize, usize));

fn place(span: Span) -> Extent {
    let (start, end) = (span.start(), span.end());
    ((start.line, start.column), (end.line, end.column))
}

/// The places of all tokens, of groups also of their delimiters.
fn places(stream: TokenStream, found: &mut BTreeSet<Extent>) {
    for token in stream {
        found.insert(place(token.span()));
        if let TokenTree::Group(group) = token {
            found.insert(place(group.span_open()));
            found.insert(place(group.span_close()));
            places(group.stream(), found);
        }
    }
}

/// A faulty declaration has an outline unless the system's name is among the faults.
fn outline(declaration: &Declaration) {
    let is_empty = expand_outline(declaration).is_empty();
    assert_eq!(is_empty, is_generated_item(&declaration.name.text), "outline of {declaration:?}");
}

/// What the whole pipeline makes of a stream: the reports, and the work where it came to its end.
pub fn pipeline(stream: TokenStream) -> (Vec<FaultReport>, u64) {
    let (declaration, report) = parse::parse(stream.clone());
    let mut reports = vec![report];
    let mut work = 0;
    let Some(declaration) = declaration else { return (reports, work) };
    if !reports[0].is_empty() {
        reports =
            reports.into_iter().map(|report| with_further_faults(&stream, &declaration, report)).collect();
        outline(&declaration);
        return (reports, work);
    }
    let (derived, report) = collect(|faults| {
        let model = model::resolve(&declaration, faults)?;
        work = model.bench.graph.work();
        derive::derive(model, faults)
    });
    match derived {
        Some(derived) if report.is_empty() => {
            work = derived.model.bench.graph.work();
            assert!(!emit::emit(derived).is_empty());
        }
        _ => {
            assert!(!report.is_empty(), "a stage failed without a message");
            outline(&declaration);
        }
    }
    reports.push(report);
    (reports, work)
}

/// Runs the pipeline and checks what must hold for any input. Returns whether there were errors, and the work.
pub fn check(stream: &TokenStream) -> (bool, u64) {
    let result = catch_unwind(AssertUnwindSafe(|| pipeline(stream.clone())));
    let (reports, work) = result.unwrap_or_else(|_| panic!("a panic on:\n{stream}"));
    let mut known = BTreeSet::new();
    places(stream.clone(), &mut known);
    for fault in reports.iter().flat_map(FaultReport::faults) {
        let is_inside = known.contains(&place(fault.span())) || stream.is_empty();
        assert!(
            is_inside,
            "an error outside of the tokens: {fault}\nat {:?}\nof:\n{stream}",
            place(fault.span())
        );
        let message = fault.message();
        assert!(!message.contains('\n') && !message.ends_with('.') && !message.is_empty(), "{message}");
        assert!(!fault.to_string().contains("this is a bug"), "{fault}\nof:\n{stream}");
    }
    (reports.iter().any(|report| !report.is_empty()), work)
}
