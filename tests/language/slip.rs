//! Events that reactions decide: a disc that rolls off a cylinder slips, or would leave it, where statics by hand says.

use guen::prelude::*;

guen::mechanical_system! {
    /// A disc of radius `a` that rolls on the outside of a fixed cylinder, its centre at the distance `l` from the axis.
    pub system Disc {
        constants   { m > 0, a > 0, l > 0, g = 9.81 }
        coordinates { phi, r, beta }
        parameters  { omega = dot(phi); }
        let centre = vec(r*sin(phi), r*cos(phi));
        kinetic_energy   = m/2*inner(dot(centre), dot(centre)) + m/4*a^2*dot(beta)^2;
        potential_energy = m*g*centre.y;
        holonomic   { contact: r = l; }
        constraints { grip: l*dot(phi) - a*dot(beta) = 0; }
    }
}

const MASS: f64 = 1.7;
const GRAVITY: f64 = 9.81;
const LENGTH: f64 = 1.3;
const BEGIN: f64 = 0.05;

fn prepared() -> disc::Prepared {
    Disc::new(MASS, 0.3, LENGTH).prepare().unwrap()
}

fn start() -> [f64; 4] {
    disc::State { phi: BEGIN, r: LENGTH, ..Default::default() }.into()
}

/// Normal force and friction at an angle, from rest at [`BEGIN`]: `3/4 l phi'^2 = g (cos(phi_0) - cos(phi))`,
/// `N = m g cos(phi) - m l phi'^2`, `F = m g sin(phi)/3`.
fn by_hand(phi: f64) -> (f64, f64) {
    let normal = GRAVITY * (phi.cos() - 4.0 / 3.0 * (BEGIN.cos() - phi.cos()));
    (MASS * normal, MASS * GRAVITY * phi.sin() / 3.0)
}

/// Where a function that falls crosses zero, by bisection.
fn root(function: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = (BEGIN, 1.5);
    for _ in 0..60 {
        let middle = (low + high) / 2.0;
        if function(middle) > 0.0 { low = middle } else { high = middle }
    }
    low
}

#[test]
fn it_slips_where_friction_is_used_up() {
    let system = prepared();
    for friction in [0.1, 0.3, 0.8] {
        let reserve = |t: f64, x: &[f64; 4]| {
            let reactions = system.reactions(t, &disc::State::from(*x));
            friction * reactions.contact - reactions.grip.abs()
        };
        let leaves = |t: f64, x: &[f64; 4]| system.reactions(t, &disc::State::from(*x)).contact;
        let expected = root(|phi| {
            let (normal, tangent) = by_hand(phi);
            friction * normal - tangent
        });
        let mut at = Vec::new();
        let tolerance = 1e-9;
        let done = Integration::new(&system, 0.0, &start())
            .events(
                [
                    Event::new(&reserve).direction(Direction::Falling).within(tolerance),
                    Event::new(&leaves).direction(Direction::Falling).within(tolerance).terminal(),
                ],
                &mut |event| {
                    at.push(*event);
                    ControlFlow::Continue(())
                },
            )
            .run(&Dop853::new(1e-12, 1e-12), 10.0)
            .unwrap();
        assert_eq!(done.outcome, Outcome::Event(1));
        let [slip, leave] = at[..] else { panic!("{} events", at.len()) };
        // Past the crossing by at most the tolerance.
        let [phi, _, _, omega] = slip.state;
        assert!(
            phi >= expected - 1e-11 && phi <= expected + omega * tolerance + 1e-11,
            "{phi} and {expected}"
        );
        assert!(reserve(slip.time, &slip.state) <= 0.0 && slip.index == 0);
        // It would leave at cos(phi) = 4/7 cos(phi_0), the text-book's value.
        assert!((leave.state[0].cos() - 4.0 / 7.0 * BEGIN.cos()).abs() < 2e-9);
        assert!(leave.time > slip.time);
    }
}

#[test]
fn the_reactions_are_those_of_statics() {
    let system = prepared();
    Dop853::new(1e-12, 1e-12)
        .integrate(&system, 0.0, &start(), 1.5, |t, x| {
            let reactions = system.reactions(t, &disc::State::from(*x));
            let (normal, tangent) = by_hand(x[0]);
            assert!(
                (reactions.contact - normal).abs() < 1e-9 && (reactions.grip.abs() - tangent).abs() < 1e-9
            );
            ControlFlow::Continue(())
        })
        .unwrap();
}
