//! Mechanisms with figures that others have published, or that a closed form gives.
//!
//! Each module names the source of its figures and says how many digits of them are right. Tolerances are those digits, or
//! what the method of the test can reach where that is less.

mod bars;
mod bicycle;
mod bricard;
mod closed_forms;
mod disc;
mod governor;
mod linkages;
mod rattleback;
mod times;
mod tops;
mod wheels;

/// Fails where two lists differ by more than the tolerance, relative to the larger of the expected entry and `scale`.
#[track_caller]
fn close(what: &str, found: &[f64], expected: &[f64], scale: f64, tolerance: f64) {
    assert_eq!(found.len(), expected.len(), "{what}");
    for (i, (a, b)) in found.iter().zip(expected).enumerate() {
        let error = (a - b).abs() / b.abs().max(scale);
        assert!(error <= tolerance, "{what}, entry {i}: {a} instead of {b}, off by {error:.1e}");
    }
}

/// The last column of the table in `docs/published.md`.
#[test]
fn the_page_says_what_the_rates_cost() {
    let costs = [
        ("Whipple's bicycle", bicycle::whipple::COST),
        ("Andrews' squeezer", linkages::squeezer::COST),
        ("car axis", linkages::car_axis::COST),
        ("heavy top", tops::heavy_top::COST),
        ("stiff flyball governor", governor::governor::COST),
        ("rattleback", rattleback::rattleback::COST),
        ("rolling disc", disc::disc::COST),
        ("rolling wheel", wheels::rolling_wheel::COST),
        ("driven wheel set", wheels::wheel_set::COST),
        ("two four-bars in a row", bars::bars::COST),
        ("Bricard's mechanism", bricard::bricard::COST),
    ];
    let page = include_str!("../../../docs/published.md");
    let differing = costs.iter().filter(|(name, cost)| {
        let row =
            page.lines().find(|line| line.starts_with(&format!("| {name}"))).expect("a row of the table");
        let said = row.trim_end_matches([' ', '|']).rsplit('|').next().expect("a last column");
        said.trim() != cost.total().to_string()
    });
    let differing: Vec<String> = differing.map(|(name, cost)| format!("{name}: {}", cost.total())).collect();
    assert!(differing.is_empty(), "not on the page: {differing:?}");
}
