//! Errors name what is guilty, and nothing else.

/// The errors about a declaration: first lines, notes and helps.
fn messages(text: &str) -> Vec<String> {
    let (declaration, report) = guen_language::parse::parse(text.parse().unwrap());
    let report = match declaration {
        Some(declaration) if !report.is_empty() => {
            guen_language::with_further_faults(&text.parse().unwrap(), &declaration, report)
        }
        Some(declaration) => {
            guen_language::diagnostics::collect(|faults| {
                guen_language::derive::derive(guen_language::model::resolve(&declaration, faults)?, faults)
                    .map(|_| ())
            })
            .1
        }
        None => report,
    };
    report.faults().iter().map(|fault| fault.message().to_owned()).collect()
}

#[test]
fn an_array_that_is_too_long_is_blamed_alone() {
    for text in [
        "system S { constants { a[1], b[2000000] } coordinates { x[1] } kinetic_energy = a[0]*dot(x[0])^2; }",
        "system S { count n = 2000000; coordinates { x, q[n] } kinetic_energy = dot(x)^2; }",
        "system S { coordinates { x } for i in 0..2000000 { let p[i] = x; } let q[0] = x; kinetic_energy = dot(q[0])^2; }",
    ] {
        let messages = messages(text);
        assert_eq!(messages.len(), 1, "{messages:#?}");
        assert!(messages[0].starts_with("more than 1000000 entries"), "{messages:#?}");
    }
}

#[test]
fn reserved_names_of_instances_are_refused() {
    let component = "component C() { coordinates { z } kinetic_energy = dot(z)^2; }";
    let uses = "use C as t {} use C as norm {} use C as pi[0] {} use C as __guen {}";
    let messages = messages(&format!(
        "system S {{ {component} {uses} coordinates {{ x }} kinetic_energy = dot(x)^2; outputs {{ o = t.z; }} }}"
    ));
    let told =
        ["`t` is reserved", "`norm` is the name of a function", "`pi` is reserved", "`__guen` is reserved"];
    assert_eq!(messages.len(), told.len(), "{messages:#?}");
    for (message, start) in messages.iter().zip(told) {
        assert!(message.starts_with(&format!("{start} and cannot name an instance")), "{message}");
    }
}

#[test]
fn no_help_names_what_is_private() {
    let component = "component C(p: vector) {
        functions { law(s); } coordinates { z } fn f(x) = x; let _h = z; let open = f(z);
        particles { 1 at p + vec(0, open); } forces { law(_h) along dot(z); }
    }";
    let told = guen_language::expand(
        format!(
            "system S {{ coordinates {{ x }} kinetic_energy = dot(x)^2; {component} use C as c {{ p: vec(x, 0) }}
                outputs {{ a = c.nothing; b = c; d = _h; e = c._hh; }} }}"
        )
        .parse()
        .unwrap(),
    )
    .to_string();
    assert!(told.contains("it has `open`, `z`"), "{told}");
    assert!(told.contains("as `c.open`"), "{told}");
    assert!(!told.contains("`c._h`") && !told.contains("did you mean `_h`"), "{told}");
}

#[test]
fn an_instance_that_is_missing_is_told_once() {
    let component = |count| {
        format!(
            "component P(n: count) {{
                constants {{ k[{count}] = 1 }} coordinates {{ s[n] }}
                kinetic_energy = sum(i in 0..n: dot(s[i])^2);
                contacts {{ for i in 0..n {{ stop[i]: gap = s[i]; }} }} outputs {{ o = s[0]; }}
            }}"
        )
    };
    let rest = |n| {
        format!(
            "for i in 0..2 {{ use P as c[i] {{ n: {n} }} }}
            modes {{ for i in 0..2 {{ c[i].stop: open; }} never c[0].stop[0].closed; }}
            outputs {{ a = gap(c[1].stop[0]); b = c[0].o; d = reaction(c[0].stop[0]); e = unknown; }}
            scene T {{ track c[0].s[0]; fix c[0].k = 3; provide c[0].o; modes {{ c[0].stop[0]: closed; }} }}
            scene U {{ track c; provide reactions(c[0].stop), a; }}"
        )
    };
    for (component, rest, fault) in [
        (component("1"), rest("-1"), "count `n` is -1, and a count is a whole number from 0 on"),
        (component("1"), rest("x"), "`n` of `P` is a count, and this is no whole number"),
        (component("n"), rest("2"), "constants of `P` depend on a count that its uses give"),
        (component("1"), rest("2").replacen("0..2", "0..far", 1), "`far` is no count and no loop variable"),
        (
            component("1"),
            rest("2").replacen("0..2", "0.2", 1),
            "an index is a whole number, and this is `0.2`",
        ),
    ] {
        let messages = messages(&format!(
            "system S {{ coordinates {{ x }} kinetic_energy = dot(x)^2; {component} {rest} }}"
        ));
        assert_eq!(messages.len(), 2, "{messages:#?}");
        assert!(messages[0].starts_with(fault), "{messages:#?}");
        assert!(messages[1].starts_with("unknown name `unknown`"), "{messages:#?}");
    }
}

#[test]
fn a_vector_that_is_declared_twice_has_one_fault() {
    let messages = messages(
        "system S {
            coordinates { x, y, z, u } kinetic_energy = dot(x)^2 + dot(z)^2;
            parameters { v = dot(vec(x, y)); v = vec(dot(z), 0); }
            holonomic { c: vec(z, u) = vec(x, y); c: vec(0, z, u) = 0; }
            forces { c_x along v_x; }
        }",
    );
    assert_eq!(messages, ["`v` is declared twice", "`c` is declared twice"]);
}

#[test]
fn a_second_scene_of_one_name_is_told_whatever_the_first_has() {
    let messages = messages(
        "system S {
            coordinates { x, y } kinetic_energy = dot(x)^2 + dot(y)^2;
            scene Low { track q; } scene Low { track x; } scene CASE { track r; } scene Case { track y; }
        }",
    );
    assert_eq!(
        messages,
        [
            "unknown name `q` in a scene",
            "`Low` is declared twice",
            "unknown name `r` in a scene",
            "a scene cannot be called `Case` here"
        ]
    );
}

#[test]
fn a_name_of_an_array_of_instances_stands_for_all() {
    let component = "component Leg(n: count) {
        constants { k = 1 } coordinates { s[n] } parameters { for i in 0..n { v[i] = dot(s[i]); } }
        kinetic_energy = sum(i in 0..n: v[i]^2);
        contacts { stop: gap = s[0]; for i in 0..n { grips[i]: grip = v[i], limit = 1; } } outputs { o = k*s[0]; }
    }
    component Pair() { for i in 0..2 { use Leg as leg[i] { n: 2 } } }";
    let uses = "for i in 0..2 { use Pair as pair[i] {} }";
    let text = |modes: &str, scene: &str| {
        format!(
            "system S {{ coordinates {{ x }} kinetic_energy = dot(x)^2; {component} {uses} modes {{ {modes} }}
                scene Some {{ {scene} }} }}"
        )
    };
    let short = text(
        "pair.leg.stop: open; pair[0].leg.grips: slip+; pair[1].leg[0].grips: slip+; pair.leg[1].grips[0]: slip+; pair[1].leg[1].grips[1]: slip+;",
        "track pair[1].leg.v; fix pair.leg.k = 2; provide pair.leg[0].o; modes { pair.leg[0].grips: slip+; }",
    );
    // The second statement about one contact is a fault.
    assert_eq!(messages(&short), ["the states of `pair[0].leg[1].grips[0]` are given twice"]);
    let short = short.replace("pair.leg[1].grips[0]", "pair[1].leg[1].grips[0]");
    let legs = ["pair[0].leg[0]", "pair[0].leg[1]", "pair[1].leg[0]", "pair[1].leg[1]"];
    let modes: String = legs
        .iter()
        .map(|leg| format!("{leg}.stop: open; {leg}.grips[0]: slip+; {leg}.grips[1]: slip+;"))
        .collect();
    let fixes: String = legs.iter().map(|leg| format!("fix {leg}.k = 2;")).collect();
    let long = text(
        &modes,
        &format!(
            "track pair[1].leg[0].v[0], pair[1].leg[0].v[1], pair[1].leg[1].v[0], pair[1].leg[1].v[1]; {fixes}
            provide pair[0].leg[0].o, pair[1].leg[0].o;"
        ),
    );
    assert_eq!(messages(&short), Vec::<String>::new());
    let expanded = |text: &str| {
        let text = guen_language::expand(text.parse().unwrap()).to_string();
        text.split("REPORT").skip(1).map(str::to_owned).collect::<String>().len()
    };
    assert_eq!(expanded(&short), expanded(&long));
}

#[test]
fn functions_of_instances_are_called_as_they_are_written() {
    let component = "component Motor(angle: scalar) {
        functions { drag(w); } fn half(x) = x/2;
        forces { half(drag(dot(angle))) + angle along dot(angle); } outputs { o = angle + sin(half(dot(angle)*drag(angle))); }
    }";
    let told = guen_language::expand(
        format!(
            "system S {{ constants {{ m: kg > 0 }} coordinates {{ x: m }} {component} kinetic_energy = m/2*dot(x)^2;
                for i in 0..2 {{ use Motor as drive[i] {{ angle: x }} }} }}"
        )
        .parse()
        .unwrap(),
    )
    .to_string();
    assert!(
        told.contains("`drive[0].half(drive[0].drag(dot(drive[0].angle))) + drive[0].angle` is in m"),
        "{told}"
    );
    assert!(!told.contains("`drive_0_"), "{told}");
}

#[test]
fn a_fixed_value_lies_between_the_limits() {
    let fixed = |fixes: &str| {
        messages(&format!(
            "system S {{
                constants {{ most = 10, k in -3..most = 2, turn: deg in -90..90 = 5, a[2] in 1/4..1/2 = 1/3, e in 0..1 = 0 }}
                coordinates {{ x }} kinetic_energy = dot(x)^2; outputs {{ o = k + turn + a[0]*a[1] + e*x; }}
                scene Some {{ track x; {fixes} }}
            }}"
        ))
    };
    let outside = |name: &str| vec![format!("this value lies outside of the limits of `{name}`")];
    assert_eq!(fixed("fix turn = 100;"), outside("turn"));
    assert_eq!(fixed("fix turn = -91;"), outside("turn"));
    assert_eq!(fixed("fix a[1] = 1;"), outside("a[1]"));
    assert_eq!(fixed("fix a = 0;"), outside("a[0]"));
    assert_eq!(fixed("fix e = -1;"), outside("e"));
    assert_eq!(fixed("fix k = -4;"), outside("k"));
    assert_eq!(fixed("fix k = 20, most = 15;"), outside("k"));
    // The program may give another value to the constants in the limit, or to what is fixed.
    for fixes in ["fix k = 20;", "fix k = 20, most = 30;", "fix turn = 90, a = 1/2, e = 0;", "fix a[0] = e;"]
    {
        assert!(fixed(fixes).is_empty(), "{fixes}: {:?}", fixed(fixes));
    }
}

#[test]
fn an_empty_list_of_reactions_is_told() {
    let messages = messages(
        "system S {
            coordinates { x, y } constraints { c: dot(x) = dot(y); } kinetic_energy = dot(x)^2 + dot(y)^2;
            scene Some { provide reactions(); track q; }
        }",
    );
    assert_eq!(messages, ["`reactions()` names nothing", "unknown name `q` in a scene"]);
}

#[test]
fn a_family_without_contacts_has_modes() {
    for n in [0, 1] {
        let messages = messages(&format!(
            "system S {{
                count n = {n}; coordinates {{ x, q[n] }} kinetic_energy = dot(x)^2 + sum(i in 0..n: dot(q[i])^2);
                contacts {{ for i in 0..n {{ c[i]: gap = q[i]; }} }} modes {{ for i in 0..n {{ c[i]: open; }} }}
                scene Some {{ track x; modes {{ for i in 0..n {{ c[i]: open; }} }} }}
            }}"
        ));
        assert!(messages.is_empty(), "{messages:#?}");
    }
}

#[test]
fn declared_names_are_offered_as_wholes() {
    let told = guen_language::expand(
        "system S {
            component Leg(p: scalar) {
                functions { law(x); } constants { k[2] = 1 } coordinates { z } let _half = z/2; fn twice(x) = 2*x;
                kinetic_energy = k[0]*dot(z)^2 + k[1]*p^2; forces { law(_half) + twice(z) along dot(z); }
            }
            component Pair(p: scalar) { for i in 0..2 { use Leg as leg[i] { p } } }
            coordinates { x, y[3] } kinetic_energy = dot(x)^2 + sum(i in 0..3: dot(y[i])^2);
            for i in 0..2 { use Pair as pair[i] { p: x } }
            scene Some { track pair.leg.unknown; }
        }"
        .parse()
        .unwrap(),
    )
    .to_string();
    let offered = "declared so far are `pair.leg.k`, `x`, `y`, `pair.leg.z`";
    assert!(told.contains(&format!("{offered}\\n")) || told.contains(&format!("{offered}\"")), "{told:.900}");
}

#[test]
fn a_component_that_is_zero_is_not_tracked() {
    let messages = messages(
        "system S {
            coordinates { x, y } parameters { v = vec(dot(x), dot(y)); } kinetic_energy = inner(v, v);
            scene Some { track v_z; } scene Other { track v_z, v_x; }
        }",
    );
    let told = ["Some", "Other"].map(|scene| format!("`v_z` is zero, and scene `{scene}` cannot track it"));
    assert_eq!(messages, told);
}
