//! Systems with functions in lanes: each lane has its own functions, and the bits that it has alone.

use guen::lanes::{LaneTask, Lanes, Width, dispatch};
use guen::prelude::*;
use guen::{Laned, Smooth, Table};

guen::mechanical_system! {
    pub system Track {
        constants   { m > 0, g = 9.81 }
        functions   { height(x); push(t); }
        coordinates { x }
        parameters  { u = dot(x); }
        particles   { m at vec(x, height(x)); }
        gravity     = vec(0, -g);
        forces      { push(t) along u; }
    }
}

guen::mechanical_system! {
    pub system Pushed {
        constants   { m > 0 }
        inputs      { force }
        functions   { height(x); }
        coordinates { x }
        parameters  { u = dot(x); }
        particles   { m at vec(x, height(x)); }
        forces      { force along u; }
    }
}

/// A parabola.
#[derive(Clone, Copy)]
struct Bowl(f64);

impl Smooth<1> for Bowl {
    fn value<R: Real>(&self, [x]: [R; 1]) -> R {
        R::from_f64(self.0) * x * x
    }
}

struct Compare<F>(fn(usize) -> F);

impl<F: Smooth<1>> LaneTask for Compare<F> {
    type Output = ();

    fn run<L: Lanes>(self) {
        let members: Vec<_> = (0..L::COUNT)
            .map(|i| {
                let (m, push) = (1.0 + i as f64, 0.3 * i as f64);
                Track { m, g: 9.81, height: self.0(i), push }.prepare().unwrap()
            })
            .collect();
        let all = Laned::gather::<L>(|lane| &members[lane]);
        let states: Vec<[f64; 2]> = (0..L::COUNT).map(|i| [0.3 * i as f64 - 0.7, 0.5]).collect();
        let state: [L; 2] = std::array::from_fn(|k| L::from_fn(|lane| states[lane][k]));
        let rates = System::rhs(&all, L::from_f64(0.2), &state);
        for lane in 0..L::COUNT {
            let alone = System::rhs(&members[lane], 0.2, &states[lane]);
            assert_eq!(rates.map(|rate| rate.lane(lane)), alone);
        }
        let driven: Vec<_> = (0..L::COUNT)
            .map(|i| {
                let pushed = Pushed { m: 1.0, height: self.0(i) }.prepare().unwrap();
                pushed.driven(pushed::Inputs { force: i as f64 })
            })
            .collect();
        let all = Laned::gather::<L>(|lane| &driven[lane]);
        let rates = System::rhs(&all, L::from_f64(0.2), &state);
        for lane in 0..L::COUNT {
            let alone = System::rhs(&driven[lane], 0.2, &states[lane]);
            assert_eq!(rates.map(|rate| rate.lane(lane)), alone);
        }
    }
}

#[test]
fn every_lane_has_the_bits_of_its_own_functions() {
    for width in [Width::One, Width::Four, Width::Eight] {
        dispatch(width, Compare(|i| Bowl(0.2 * i as f64)));
        // One table in all lanes, whose arguments lie in different pieces.
        dispatch(width, Compare(|_| Table::new([(-0.5, 0.0), (0.1, 0.4), (0.6, 0.1), (1.0, 0.3)]).unwrap()));
        dispatch(
            width,
            Compare(|i| Table::monotone([(-0.5, 0.0), (0.1, 0.1 * i as f64), (1.0, 0.3)]).unwrap()),
        );
    }
}
