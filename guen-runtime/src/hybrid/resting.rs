//! Sequences of impacts that accumulate: when one is so slow that what is left of it is closed early.

/// The impacts of late, as far as the end of a sequence is judged by them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Resting<const C: usize> {
    /// The error of the time at which a sequence ends that is allowed.
    accuracy: f64,
    speeds: [f64; 4],
    count: u32,
    last: f64,
    took_part: [bool; C],
}

impl<const C: usize> Resting<C> {
    pub(super) fn new(accuracy: f64) -> Self {
        Self { accuracy, speeds: [0.0; 4], count: 0, last: f64::NEG_INFINITY, took_part: [false; C] }
    }

    /// Records an impact with the largest speed of closing. Returns the ratio of the last two speeds, if the last three ratios agree and
    /// are below one.
    pub(super) fn record(&mut self, t: f64, speed: f64, meets: &[bool; C]) -> Option<f64> {
        /// The relative difference of ratios that agree.
        const AGREEMENT: f64 = 1e-2;

        self.took_part = core::array::from_fn(|c| self.took_part[c] || meets[c]);
        self.last = t;
        self.speeds.rotate_right(1);
        self.speeds[0] = speed;
        self.count = self.count.saturating_add(1);
        if self.count < 4 {
            return None;
        }
        let [a, b, c, d] = self.speeds;
        let ratios = [a / b, b / c, c / d];
        let agree = |x: f64, y: f64| (x - y).abs() <= AGREEMENT * y;
        let [first, second, third] = ratios;
        (first < 1.0 - AGREEMENT && agree(first, second) && agree(second, third)).then_some(first)
    }

    /// The rebound below which a sequence is closed, with the acceleration `back` towards the contact. What is left out is wrong by the
    /// third order of the rebound; where an impact sticks also by the second, as far as the contact accelerates `aside` between impacts.
    pub(super) fn slowest(&self, back: f64, aside: f64) -> f64 {
        if !(back > 0.0) {
            return 0.0;
        }
        let third = libm::cbrt(self.accuracy * back * back);
        let second = libm::sqrt(self.accuracy * back * back / aside);
        if second < third { second } else { third }
    }

    /// Ends the sequence, and returns the number of its impacts.
    pub(super) fn finish(&mut self) -> u32 {
        let count = self.count;
        *self = Self::new(self.accuracy);
        count
    }

    /// Forgets the impacts: something else happened.
    pub(super) fn interrupt(&mut self) {
        *self = Self::new(self.accuracy);
    }
}
