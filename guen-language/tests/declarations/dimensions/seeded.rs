//! Seeded faults: one wrong dimension in a right declaration is one error, at the smallest sum, argument or side that cannot be; and no
//! error in right declarations, whichever units are left out.

use std::collections::BTreeSet;

use guen_language::diagnostics::collect;
use guen_language::{model, parse};

use super::twenty::TWENTY;

/// The faults of a declaration, each with its place: line and column.
fn faults(text: &str) -> Vec<(usize, usize, String)> {
    let (declaration, parsed) = parse::parse(text.parse().expect("tokens"));
    assert!(parsed.is_empty(), "{parsed}\n{text}");
    let declaration = declaration.expect("a declaration");
    let (_, report) = collect(|faults| model::resolve(&declaration, faults).map(|_| ()));
    let place = |fault: &guen_language::diagnostics::Fault| {
        let start = fault.span().start();
        (start.line, start.column, fault.message().to_owned())
    };
    report.faults().iter().map(place).collect()
}

/// The number of a declaration, what is right in it, and what is wrong in its place, with `«` before the token that is underlined.
const SEEDED: [(usize, &str, &str); 44] = [
    (0, "m/2*(dot(xi)^2 + dot(eta)^2 + dot(zeta)^2) +", "1/2*(dot(xi)^2 + dot(eta)^2 + dot(zeta)^2) «+"),
    (0, "- a*cos(psi)*dot(phi);", "«- cos(psi)*dot(phi);"),
    (0, "dot(zeta) - a*cos(theta)*dot(theta)", "dot(zeta) «- a*a*cos(theta)*dot(theta)"),
    (0, "-m*a*g*sin(theta);", "«-m*g*sin(theta);"),
    (1, "y + alpha*sin(phi)", "y «+ slope*sin(phi)"),
    (1, "thrust - c*speed", "thrust «- c*x"),
    (1, "dot(x)*cos(phi) + dot(y)", "dot(x)*cos(phi) «+ y"),
    (2, "rear + base*ahead", "rear «+ ahead"),
    (2, "J/2*(dot(heading)^2 + dot(steering)^2)", "J/2*(dot(heading)^2 «+ steering^2)"),
    (2, "tan(steering)/base", "tan(«steering/base)"),
    (3, "on_table: z = a;", "on_table: z «= a^2;"),
    (3, "velocity_at(contact).x = table.x", "velocity_at(contact).x «= contact.x"),
    (3, "w^2 + i^2 + j^2 + k^2 = 1", "w^2 + i^2 + j^2 «+ x^2 = 1"),
    (4, "coin.center - r*axes.y", "coin.center «- axes.y"),
    (4, "vec(0, 0, -g)", "«vec(0, 0, -g*r)"),
    (4, "diag(I, I, 2*I)", "diag(I, I, «2*m*r)"),
    (5, "vec(x, 0) + l", "vec(x, 0) «+ m"),
    (5, "time/T", "«time"),
    (5, "-c*l^2*w along w", "«-c*l*w along w"),
    (5, "atan2(p.y, p.x)", "«atan2(p.y, v)"),
    (6, "voltage - ohmic*current", "voltage «- R*k*current"),
    (6, "ohmic*current^2 - loss*heat", "ohmic*current^2 «- loss"),
    (6, "(voltage - ohmic*current - k*omega)/L;", "voltage - ohmic*current - k*omega;"),
    (6, "1 + warm*heat", "1 «+ heat"),
    (7, "exp(-(x^2 + y^2)/w^2)", "exp(«-(x^2 + y^2)/w)"),
    (7, "drag(dot(place)) along", "«drag(place) along"),
    (8, "omega^2 + Omega^2*sin(theta)^2", "omega^2 «+ Omega*sin(theta)^2"),
    (8, "-m*g*R*cos(theta) + k", "-m*g*cos(theta) «+ k"),
    (9, "knee + b*vec(cos(q), sin(q))", "knee «+ vec(cos(q), sin(q))"),
    (9, "-damping*(w - dot(q))", "-damping*(w «- q)"),
    (10, "k/2*(z - u)^2", "k/2*(z «- bump*u)^2"),
    (10, "sin(2*pi*s/wave)", "sin(«2*pi*s*wave)"),
    (11, "m*mu/r;", "«mu/r;"),
    (11, "2*pi*sqrt(r^3/mu)", "2*pi*sqrt(r^3/mu) «+ r"),
    (12, "x^2 + y^2 = l^2", "x^2 + y^2 «= l"),
    (13, "1 + pitch*x", "1 «+ x"),
    (13, "q*cross(dot(place), field)", "«q*dot(place)"),
    (14, "acos(R.z.z)", "acos(«l*R.z.z)"),
    (15, "norm(way) - free", "norm(way) «- k"),
    (16, "full - burn*t at", "full «- burn at"),
    (16, "burn*jet + burn*v", "burn*jet «+ burn"),
    (17, "- U*side/sigma", "«- side/sigma"),
    (18, "ki*error - kd*w2", "ki*error «- kd*q2"),
    (19, "(s + r*phi)/length", "(s «+ phi)/length"),
];

#[test]
fn seeded_faults_are_told_where_they_are() {
    let mut seen = BTreeSet::new();
    let mut wrong = Vec::new();
    for (number, right, seeded) in SEEDED {
        let text = TWENTY[number];
        assert!(text.contains(right), "`{right}` in number {number}");
        seen.insert(number);
        let marked = text.replacen(right, seeded, 1);
        let place = marked.find('«');
        let text = marked.replace('«', "");
        let found = faults(&text);
        let expected = place.map(|place| {
            let before = &text[..place];
            let line = before.matches('\n').count() + 1;
            (line, before.len() - before.rfind('\n').map_or(0, |at| at + 1))
        });
        let at = found.first().map(|(line, column, _)| (*line, *column));
        // Without a mark the fault is at the `=` of the entry.
        if found.len() != 1 || (expected.is_some() && at != expected) {
            wrong.push(format!("number {number}, `{seeded}`: {found:?}, and not {expected:?}"));
        }
    }
    assert_eq!(seen.len(), TWENTY.len(), "{seen:?}");
    assert!(wrong.is_empty(), "{} of {}:\n{}", wrong.len(), SEEDED.len(), wrong.join("\n"));
}

/// The places of the units of a declaration: `: unit` as far as a `,`, a bound, a default, limits or a bracket.
fn units(text: &str) -> Vec<std::ops::Range<usize>> {
    let mut found = Vec::new();
    for (word, close) in [("constants {", '}'), ("inputs {", '}'), ("coordinates {", '}'), ("states {", '}')]
    {
        let Some(start) = text.find(word) else { continue };
        let end = start + text[start..].find(close).expect("the end of a section");
        let mut at = start;
        while let Some(colon) = text[at..end].find(": ").map(|colon| at + colon) {
            let rest = &text[colon..end];
            let stops = [",", " >", " =", " in ", " }", ")", " }"];
            // `:` and the unit after it.
            let length = stops.iter().filter_map(|stop| rest.find(stop)).min().unwrap_or(rest.len());
            found.push(colon..colon + length);
            at = colon + length;
        }
    }
    found
}

#[test]
fn right_declarations_have_no_faults_whichever_units_are_left_out() {
    let mut looked_at = 0;
    let mut seed = 1_u64;
    for (number, text) in TWENTY.iter().enumerate() {
        assert_eq!(faults(text), [], "number {number}");
        let places = units(text);
        assert!(places.len() > 3, "{places:?}");
        for round in 0..places.len() + 2 {
            // Each alone, then several at once.
            let left: Vec<usize> = (0..places.len())
                .filter(|place| {
                    seed =
                        seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                    if round < places.len() { *place == round } else { seed >> 63 == 1 }
                })
                .collect();
            let mut variant = (*text).to_owned();
            // Degrees are a conversion, and no matter of dimensions alone.
            for place in left.iter().rev().filter(|place| !text[places[**place].clone()].contains("deg")) {
                variant.replace_range(places[*place].clone(), "");
            }
            assert_eq!(faults(&variant), [], "number {number} without {left:?}:\n{variant}");
            looked_at += 1;
        }
    }
    println!("{looked_at} right declarations");
    assert!(looked_at >= 100);
}
