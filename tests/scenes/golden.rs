//! Variables and operations of scenes as golden values: what a scene keeps, and what it costs.

use guen::{Cost, Level};

use crate::models::{appell, convoy, hoop, sled};

/// Operations without calls, and calls.
fn counted(cost: Cost) -> (u32, u32) {
    (cost.total() - cost.calls, cost.calls)
}

/// The tilt of the hoop: four variables of nine, thirteen operations and one sine and cosine pair.
#[test]
fn the_tilt_of_the_hoop() {
    assert_eq!(hoop::State::NAMES.len(), 9);
    assert_eq!(hoop::tilt::State::NAMES, ["theta", "eta1", "eta2", "eta3"]);
    assert_eq!(counted(hoop::tilt::COST), (13, 1));
    assert_eq!(hoop::tilt::INFO.bytes::<f64>(), 32);
    // What is fixed changes no variable, and what is provided only what it needs.
    assert_eq!(hoop::unit::State::NAMES, hoop::tilt::State::NAMES);
    assert_eq!(counted(hoop::unit::COST), (13, 1));
    assert_eq!(hoop::nodding::State::NAMES, hoop::tilt::State::NAMES);
    assert_eq!(hoop::contact::State::NAMES, ["theta", "psi", "eta1", "eta2", "eta3"]);
    assert_eq!(counted(hoop::contact::COST), (13, 1));
    assert_eq!(hoop::told::State::NAMES, ["theta", "psi", "xi", "eta", "eta1", "eta2", "eta3"]);
    assert_eq!(hoop::everything::State::NAMES, hoop::State::NAMES);
    assert_eq!(counted(hoop::everything::COST), counted(hoop::COST));
    // All constants are numbers: nothing is left to prepare.
    assert_eq!((counted(hoop::numbers::COST), hoop::numbers::PREPARE_COST.total()), ((13, 1), 0));
}

#[test]
fn the_sled() {
    assert_eq!(sled::turn::State::NAMES, ["phi", "eta1", "eta2"]);
    assert_eq!(sled::centred::State::NAMES, ["phi", "eta1"]);
    assert_eq!(sled::level::State::NAMES, ["eta1", "eta2"]);
    assert_eq!(sled::straight::State::NAMES, ["phi", "eta1", "eta2"]);
    assert_eq!(sled::flat::State::NAMES, ["eta1", "eta2"]);
    assert_eq!(counted(sled::turn::COST), (12, 1));
    // Symmetric and turning about its blade: it turns evenly.
    assert_eq!(counted(sled::centred::COST), (0, 0));
    assert_eq!(counted(sled::level::COST), (8, 0));
    assert_eq!(counted(sled::straight::COST), (8, 1));
    assert_eq!(counted(sled::flat::COST), (4, 0));
}

/// What is fixed at zero takes with it all that it multiplied, and its name.
#[test]
fn what_a_zero_multiplied_is_gone() {
    let rates = |report: &'static guen::Report| report.lines("Rates").join("\n");
    assert!(rates(&sled::turn::REPORT).contains("beta"));
    for report in [&sled::straight::REPORT, &sled::flat::REPORT] {
        assert!(!rates(report).contains("beta"), "{report}");
    }
    assert!(rates(&sled::straight::REPORT).contains("sin(incline)"));
    assert_eq!(
        sled::flat::REPORT.lines("Rates"),
        ["eta1' = -alpha*eta1*eta2/(alpha^2 + k^2)", "eta2' = alpha*eta1^2"]
    );
    assert_eq!(sled::flat::REPORT.lines("Constants that are fixed"), ["incline = 0", "beta = 0"]);
}

#[test]
fn a_parameter_at_rest_becomes_a_constant() {
    for names in
        [appell::rolling::State::NAMES, appell::measured::State::NAMES, appell::spinning::State::NAMES]
    {
        assert_eq!(names, ["theta", "eta1", "eta2"]);
    }
    assert_eq!(counted(appell::rolling::COST), (9, 1));
    let left = appell::rolling::REPORT.lines("Variables that left");
    assert_eq!(left.last(), Some(&"eta3: its rate vanishes identically, and it is a constant here"));
}

/// Eleven coordinates of which three are tracked.
#[test]
fn the_convoy() {
    assert_eq!(convoy::State::NAMES.len(), 13);
    assert_eq!(
        convoy::course::State::NAMES,
        ["x", "y", "heading", "steer", "first", "second", "speed", "turn"]
    );
    assert_eq!(convoy::dash::State::NAMES, ["heading", "steer", "first", "second", "speed", "turn"]);
    assert_eq!(convoy::hitch::State::NAMES, convoy::dash::State::NAMES);
    assert_eq!(convoy::aim::State::NAMES, ["steer", "turn"]);
    // The inputs that are needed.
    assert_eq!(convoy::dash::Inputs::NAMES, ["drive", "steering"]);
    assert_eq!(convoy::aim::Inputs::NAMES, ["steering"]);
    let reasons = convoy::course::REPORT.lines("Variables that are kept");
    assert_eq!(reasons[3], "steer: the rate of heading depends on it");
    assert_eq!(reasons[4], "first: the rate of speed depends on it");
}

#[test]
fn levels_side_by_side() {
    let expected = "\
level       variables  bytes  operations  calls  prepared once
Hoop                9     72          24      2             18
Tilt                4     32          13      1             10
Unit                4     32          13      1             11
Contact             5     40          13      1             11
Told                7     56          22      2             16
Numbers             5     40          13      1              0
Everything          9     72          24      2             11
Nodding             4     32          13      1             11";
    assert_eq!(hoop::levels().to_string(), expected);
    let expected = "\
level   variables  bytes  operations  calls  prepared once
Convoy         13    104          95      4            150
Course          8     64          81      4             63
Dash            6     48          70      4             64
Alone           8     64          55      4             31
Hitch           6     48          70      4             64
Aim             2     16           1      0              1";
    assert_eq!(convoy::levels().to_string(), expected);
    for (info, level) in hoop::LEVELS.iter().zip(["Hoop", "Tilt", "Unit", "Contact", "Told", "Numbers"]) {
        assert_eq!(info.name, level);
    }
    assert_eq!(<hoop::tilt::Prepared as Level<f64, 4, 9>>::INFO, hoop::LEVELS[1]);
    assert_eq!(hoop::LEVELS[0].variables, hoop::State::NAMES);
}
