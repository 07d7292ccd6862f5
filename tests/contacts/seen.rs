//! Tables, plots and pages of motions through modes: both sides of every transition, the states of contacts and their forces.

use guen::hybrid::TransitionKind;
use guen::prelude::*;

use crate::declared::*;

/// A bowling ball that slides, rolls, is braked, and rolls again.
fn motion() -> guen::hybrid::HybridTrajectory<bowling_ball::Prepared, bowling_ball::State, 6, 2, 1, 1> {
    let ball = BowlingBall::default().prepare().unwrap();
    let start = bowling_ball::State { z: 0.108, u: 8.0, ..Default::default() };
    ball.simulation(&start).tolerance(1e-11).run(0.0..5.0).unwrap()
}

#[test]
fn a_table_has_both_sides_of_transitions_with_modes_and_forces() {
    let motion = motion();
    let path = std::env::temp_dir().join(format!("guen-modes-{}.csv", std::process::id()));
    motion.save_csv(0.5, &path).unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    std::fs::remove_file(&path).unwrap();
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("t,x,z,phi,u,w,spin,lane,lane normal,lane along"));
    let rows: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
    let aside = motion.transitions().iter().filter(|at| (at.t / 0.5).fract() != 0.0).count();
    let on = motion.transitions().len() - aside;
    assert_eq!(rows.len(), 11 + 2 * aside + on, "{text}");
    let rolls = motion.transitions().iter().find(|at| at.kind == TransitionKind::Sticks).unwrap();
    let time = format!("{:?}", rolls.t);
    let sides: Vec<&Vec<&str>> = rows.iter().filter(|row| row[0] == time).collect();
    // Before it slides with friction against the slip; after it rolls, without a force along the lane.
    assert_eq!([sides[0][7], sides[1][7]], ["slip+", "stick"]);
    let force = |row: &[&str], column: usize| row[column].parse::<f64>().unwrap();
    let weight = 7.0 * 9.81;
    assert!((force(sides[0], 8) - weight).abs() < 1e-9 && (force(sides[0], 9) + 0.15 * weight).abs() < 1e-9);
    assert!((force(sides[1], 8) - weight).abs() < 1e-9 && force(sides[1], 9).abs() < 1e-9);
}

#[test]
fn recordings_and_plots_show_transitions() {
    let motion = motion();
    let recording = motion.recording();
    for transition in motion.transitions() {
        let states: Vec<_> =
            recording.iter().filter(|(t, _)| *t == transition.t).map(|(_, state)| *state).collect();
        assert_eq!(states, [transition.state_before, transition.state_after]);
    }
    assert!(recording.times().is_sorted());
    let plot = motion.plot("a bowling ball", &["u", "spin"]).unwrap().to_svg().unwrap();
    let told = format!("dashed lines at {} transitions", motion.transitions().len());
    assert!(plot.contains(&told), "{told}");
    assert!(motion.plot("a bowling ball", &["v"]).is_err());
    let forces = motion.plot_reactions("forces").to_svg().unwrap();
    assert!(forces.contains("lane normal") && forces.contains("lane along"));
}
