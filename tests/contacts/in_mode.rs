//! A system in one mode is a smooth system like any other: for every method, in lanes, and for what differentiates it.

use guen::lanes::{Backend, LaneTask, Lanes, Width, dispatch_on};
use guen::prelude::*;
use guen::steppers::{Gauss4, Gauss6, Radau5, Taylor};
use guen::{Differentiable, System};

use crate::declared::*;

/// A hoop that rolls: it sticks to its floor.
fn stuck() -> (hoop_on_floor::Prepared, [f64; 12], [f64; 9]) {
    let (floor, hoop) = (HoopOnFloor::default().prepare().unwrap(), Hoop::default().prepare().unwrap());
    let mut rolling = hoop::State::from([1.0, 0.2, 0.3, 0.1, 0.4, 0.0, 0.3, 1.2, 0.9]);
    rolling.zeta = 2.0 * rolling.theta.sin();
    let rate = hoop.rhs(0.0, &rolling);
    let hoop::State { theta, psi, phi, xi, eta, zeta, eta1, eta2, eta3 } = rolling;
    let (u, v, w) = (rate.xi, rate.eta, rate.zeta);
    let state = hoop_on_floor::State { theta, psi, phi, xi, eta, zeta, eta1, eta2, eta3, u, v, w };
    (floor, state.into(), rolling.into())
}

const MODE: hoop_on_floor::Mode = hoop_on_floor::Mode { floor: hoop_on_floor::Floor::Stick };

/// The rolling hoop itself, which is derived with its constraints, is the measure of all methods.
#[test]
fn every_method_runs_a_mode() {
    let (floor, start, rolling) = stuck();
    let in_mode = floor.in_mode(MODE);
    let hoop = Hoop::default().prepare().unwrap();
    let exact = Integration::new(&hoop, 0.0, &rolling).run(&Dop853::new(1e-13, 1e-13), 0.5).unwrap().state;
    macro_rules! runs {
        ($($method:expr, $accuracy:literal;)*) => {
            $(
                let done = Integration::new(&in_mode, 0.0, &start).run(&$method, 0.5).unwrap();
                let off = (0..9).map(|i| (done.state[i] - exact[i]).abs()).fold(0.0, f64::max);
                assert!(off < $accuracy, "{}: {off:e}", stringify!($method));
                // It touches and does not slip.
                let left = in_mode.reactions(0.5, &done.state).free;
                assert!(left.gaps[0].abs() < 1e-12 && left.row_rates.iter().all(|rate| rate.abs() < 1e-12));
            )*
        };
    }
    runs! {
        Rk4::new(1e-3), 1e-9;
        Rk8::new(1e-2), 1e-11;
        Tsit5::new(1e-10, 1e-10), 1e-8;
        Dop853::new(1e-12, 1e-12), 1e-10;
        Gauss4::new(5e-3), 1e-7;
        Gauss6::new(1e-2), 1e-9;
        Radau5::new(1e-10, 1e-10), 1e-7;
        Taylor::new(1e-14, 1e-14), 1e-11;
    }
}

#[test]
fn the_linearisation_of_a_mode_is_that_of_differences() {
    let (floor, start, _) = stuck();
    let in_mode = floor.in_mode(MODE);
    let jacobian = Differentiable::<f64, 12>::jacobian(&in_mode, 0.0, &start);
    for j in 0..12 {
        let rates = |size: f64| {
            let mut moved = start;
            moved[j] += size;
            System::<f64, 12>::rhs(&in_mode, 0.0, &moved)
        };
        let (ahead, behind) = (rates(1e-5), rates(-1e-5));
        for i in 0..12 {
            let difference = (ahead[i] - behind[i]) / 2e-5;
            assert!((jacobian[i][j] - difference).abs() < 1e-7 * (1.0 + difference.abs()), "{i} {j}");
        }
    }
}

/// The rates of a mode in lanes, beside those of its members alone.
struct InLanes(hoop_on_floor::Prepared, [f64; 12]);

impl LaneTask for InLanes {
    type Output = bool;

    fn run<L: Lanes>(self) -> bool {
        let in_mode = self.0.in_mode(MODE);
        let of = |lane: usize| -> [f64; 12] {
            std::array::from_fn(|i| self.1[i] + 0.01 * (lane * (i + 1)) as f64)
        };
        let state: [L; 12] = std::array::from_fn(|i| L::from_fn(|lane| of(lane)[i]));
        let found = System::<L, 12>::rhs(&in_mode, L::from_f64(0.0), &state);
        (0..L::COUNT).all(|lane| {
            let alone = System::<f64, 12>::rhs(&in_mode, 0.0, &of(lane));
            (0..12).all(|i| found[i].lane(lane) == alone[i])
        })
    }
}

/// States off the floor in all lanes but the first, restored together and alone.
struct Restored(hoop_on_floor::Prepared, [f64; 12]);

impl LaneTask for Restored {
    type Output = bool;

    fn run<L: Lanes>(self) -> bool {
        let in_mode = self.0.in_mode(MODE);
        let of = |lane: usize| -> [f64; 12] {
            std::array::from_fn(|i| self.1[i] + 1e-6 * (lane * (i + 1)) as f64)
        };
        let mut state: [L; 12] = std::array::from_fn(|i| L::from_fn(|lane| of(lane)[i]));
        System::<L, 12>::restore(&in_mode, L::from_f64(0.0), &mut state).unwrap();
        (0..L::COUNT).all(|lane| {
            let mut alone = of(lane);
            System::<f64, 12>::restore(&in_mode, 0.0, &mut alone).unwrap();
            let stays = alone == of(lane);
            stays == (lane == 0) && (0..12).all(|i| state[i].lane(lane) == alone[i])
        })
    }
}

/// Whether a state moves is asked in every lane, and not in the first for all.
#[test]
fn each_lane_is_restored_by_itself() {
    let (floor, start, _) = stuck();
    let mut on_floor = start;
    System::<f64, 12>::restore(&floor.in_mode(MODE), 0.0, &mut on_floor).unwrap();
    for width in [Width::One, Width::Four, Width::Eight] {
        assert!(dispatch_on(Backend::Portable, width, Restored(floor, on_floor)));
    }
}

#[test]
fn lanes_have_the_bits_of_single_members() {
    let (floor, start, _) = stuck();
    for width in [Width::One, Width::Four, Width::Eight] {
        assert!(dispatch_on(Backend::Portable, width, InLanes(floor, start)));
    }
}
