//! Tables, plots and pages of motions through modes: both sides of every transition, the states of contacts and their forces.

use guen::hybrid::TransitionKind;
use guen::prelude::*;
use guen::{Cause, InputLaw};

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

mechanical_system! {
    /// A particle on a line that is pushed against a wall.
    pub system PushedBead {
        constants { m > 0 = 1, l = 1/4 }
        inputs { push }
        coordinates { x }
        parameters { v = dot(x); }
        particles { m at vec(x, 0); }
        forces { push along v; }
        contacts { wall: gap = l - x, restitution = 1/2; }
    }
}

/// A spring to a point behind the wall, that swings.
#[derive(Clone, Copy)]
struct Spring;

impl InputLaw<pushed_bead::Prepared> for Spring {
    fn at<R: Real>(&self, t: R, state: &pushed_bead::State<R>) -> pushed_bead::Inputs<R> {
        let [stiffness, damping, target] = [60.0, 1.0, 0.3].map(R::from_f64);
        pushed_bead::Inputs { push: stiffness * (target * t.cos() - state.x) - damping * state.v }
    }
}

/// Motions under a law are looked at as all others.
#[test]
fn a_motion_under_a_law_has_tables_plots_and_pages() {
    let bead = PushedBead::default().prepare().unwrap();
    let start = pushed_bead::State::default();
    let motion = bead.simulation(&start).law(Spring).run(0.0..2.0).unwrap();
    let by_law = bead.with_law(Spring);
    let same = by_law.simulate(&start, 0.0..2.0).unwrap();
    assert_eq!(motion.transitions(), same.transitions());
    assert_eq!(motion.transitions()[0].kind, TransitionKind::Impact);
    assert_eq!(motion.recording().names(), ["x", "v"]);
    let plot = motion.plot("a bead", &["x"]).unwrap().to_svg().unwrap();
    assert!(plot.contains("transition"));
    assert!(motion.plot_reactions("a bead").to_svg().unwrap().contains("wall"));
    assert_eq!(motion.reaction_of("wall", 2.0).unwrap(), [0.0; 3]);
    let folder = std::env::temp_dir().join(format!("guen-by-law-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let (table, page) = (folder.join("bead.csv"), folder.join("bead.html"));
    motion.save_csv(0.5, &table).unwrap();
    motion.view(&by_law, "a bead", &page).unwrap();
    let text = std::fs::read_to_string(&table).unwrap();
    assert!(text.starts_with("t,x,v,wall,wall\n"), "{text}");
    assert!(std::fs::read_to_string(&page).unwrap().contains("impact: wall"));
    std::fs::remove_dir_all(&folder).unwrap();
    // The energy is that of the bead, and rates without contacts are refused.
    assert_eq!(by_law.energy(0.0, &pushed_bead::State { x: 0.1, v: 2.0 }.into()), 2.0);
    let error = Integration::new(&by_law, 0.0, &[0.0, 0.0]).run(&Dop853::new(1e-9, 1e-9), 1.0).unwrap_err();
    assert_eq!(error.cause, Cause::Contacts);
}
