//! Components by themselves: faults of all stages are told at once, and nothing that follows from one of them.

use guen_language::expand_component;

/// A component with an entry of every kind that a fault can be in.
const SOUND: &str = "pub component Leg(hip: vector, side: scalar, n: count) {
    constants { m: kg > 0, reach: m > 0 = 1/2, stiff[2]: N/m > 0, twice: m = 2*reach }
    coordinates { q[n] }
    fn far(r) = r*reach;
    for i in 0..n { let foot[i] = hip + vec(far(q[i]), side, 0); }
    parameters { for i in 0..n { w[i] = dot(q[i]); } }
    particles { for i in 0..n { m at foot[i]; } }
    potential_energy = stiff[0]/2*q[0]^2;
    contacts { sole: gap = foot[0].z; }
    modes { sole: open, closed; }
    outputs { tip = foot[n - 1]; }
}";

/// The right text, the wrong one, and how the message begins.
const FAULTS: [(&str, &str, &str); 14] = [
    ("side: scalar,", "side: scalr,", "expected a kind of argument"),
    ("m: kg > 0", "m: kgg > 0", "unknown unit `kgg`"),
    ("fn far(r) =", "fn far(r)", "expected"),
    ("m at foot[i];", "m on foot[i];", "expected"),
    ("sole: gap = foot[0].z;", "sole: gp = foot[0].z;", "unknown word `gp`"),
    ("coordinates { q[n] }", "coordinates { q[n], sin }", "`sin` is the name of a function"),
    ("stiff[0]/2*q[0]^2", "stif[0]/2*q[0]^2", "unknown name `stif` in component `Leg`"),
    ("w[i] = dot(q[i]);", "w[i] = dot(p[i]);", "unknown name `p` in component `Leg`"),
    ("sole: open,", "soles: open,", "unknown contact `soles` in component `Leg`"),
    ("tip = foot[n - 1];", "tip = foot[n - 1] + fot(1);", "unknown function `fot`"),
    ("reach: m > 0 = 1/2", "reach: m > 0 = -1/2", "this default does not keep the bound `> 0`"),
    ("twice: m = 2*reach", "twice: m = 2*m", "`twice` is in m, and this is in kg"),
    ("twice: m = 2*reach", "twice: m = 2*vec(1, 0)", ""),
    ("vec(far(q[i]), side, 0)", "vec(far(q[i]), sid, 0)", "unknown name `sid` in component `Leg`"),
];

fn messages(text: &str) -> Vec<String> {
    let items = expand_component(text.parse().expect("tokens")).to_string();
    let message = |rest: &str| rest.split(['"', '\\']).nth(1).map(str::to_owned);
    items.split("compile_error").skip(1).filter_map(message).collect()
}

#[test]
fn one_fault_gives_one_error_and_two_give_two() {
    assert_eq!(messages(SOUND), [""; 0]);
    let mut wrong = Vec::new();
    for (i, (right, fault, begin)) in FAULTS.iter().enumerate() {
        assert_eq!(SOUND.matches(right).count(), 1, "{right}");
        let text = SOUND.replacen(right, fault, 1);
        let found = messages(&text);
        if found.len() != 1 || !found[0].starts_with(begin) {
            wrong.push(format!("{fault}: {found:?}"));
        }
        for (other, also, also_begin) in &FAULTS[..i] {
            // Two of one statement are told one after the other, and of `m` nothing is known without its unit.
            if right == other || fault.contains("2*m") && also.contains("kgg") {
                continue;
            }
            let found = messages(&text.replacen(other, also, 1));
            let is_told = |begin: &str| found.iter().any(|message| message.starts_with(begin));
            if found.len() != 2 || !is_told(begin) || !is_told(also_begin) {
                wrong.push(format!("{fault}\n{also}: {found:?}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}\n{}", wrong.len(), wrong.join("\n"));
}
