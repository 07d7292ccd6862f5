//! The operations of large systems are golden values too: `tests/costs_of_large.txt`.

use std::path::Path;

#[path = "../../../tests/golden/lines.rs"]
#[allow(dead_code, reason = "the rest is for systems that are compiled")]
mod lines;

use crate::common::by_two_threads;
use crate::families::chains::{Angles, declaration};
use crate::families::{arms, bars, robots};

/// How the file is written anew.
const COMMAND: &str = "cargo test --release -p guen-language --test declarations large_costs -- --ignored";

#[test]
#[ignore = "takes a minute without optimisation; `.ci/run` runs it in a release build"]
fn costs_of_large_systems_are_those_of_the_file() {
    let rows = [
        ("arm7", arms::declaration("Arm", &arms::AXES[..7])),
        ("arm8", arms::declaration("Arm", &arms::AXES[..8])),
        ("arm9", arms::declaration("Arm", arms::AXES)),
        ("general7", arms::general(7)),
        ("general8", arms::general(8)),
        ("general9", arms::general(9)),
        ("humanoid", robots::declaration(&robots::HUMANOID)),
        ("humanoid-quat", robots::on_quaternion(&robots::declaration(&robots::HUMANOID))),
        ("held7", robots::held()),
        ("joints40", declaration("Chain", 40, Angles::Relative)),
        // Without the rates of the base angles the derivation gives up on it.
        ("joints64", declaration("Chain", 64, Angles::Relative)),
        ("joints40-0", declaration("Chain", 40, Angles::Relative).replace(" > 0", "")),
        ("crane4", robots::crane(4)),
        ("crane12", robots::crane(12)),
        ("bars10", bars::in_angles(10)),
        ("bars10-xy", bars::in_points(10)),
        ("bars40", bars::in_angles(40)),
        ("bars40-xy", bars::in_points(40)),
        ("hinged1", robots::hinged_rods(1)),
        ("hinged2", robots::hinged_rods(2)),
        ("hinged3", robots::hinged_rods(3)),
    ];
    let header =
        format!("# Operations of large systems, written by `GUEN_BLESS=1 {COMMAND}`.\n# As in costs.txt.\n");
    let rows = by_two_threads(&rows, |(name, text)| lines::row(name, text));
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/costs_of_large.txt");
    lines::compared(&file, &(header + &rows.concat()), COMMAND);
}
