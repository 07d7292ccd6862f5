//! The hybrid state of a run between two steps, and the functions that have fired there.

use crate::hybrid::events::watched::{Function, Sides};
use crate::hybrid::filled::filled;
use crate::hybrid::mode_dynamics::in_mode::InMode;

/// The functions that have reached zero.
#[derive(Clone, Copy, Debug)]
pub(in crate::hybrid) struct Fired<const C: usize, const S: usize> {
    pub(super) gap: [bool; C],
    /// The gaps among them that have not been above zero since the mode began, as far as a step can tell: their contacts have not left.
    pub(super) grounded: [bool; C],
    pub(super) normal: [bool; C],
    pub(super) cone: [[bool; 2]; C],
    pub(super) slip: [bool; C],
    pub(super) signals: [bool; S],
    pub(super) regularity: bool,
    pub(super) shared: bool,
}

impl<const C: usize, const S: usize> Default for Fired<C, S> {
    fn default() -> Self {
        let no = [false; C];
        Self {
            gap: no,
            grounded: no,
            normal: no,
            cone: [[false; 2]; C],
            slip: no,
            signals: [false; S],
            regularity: false,
            shared: false,
        }
    }
}

impl<const C: usize, const S: usize> Fired<C, S> {
    pub(in crate::hybrid) fn add(&mut self, function: Function) {
        match function {
            Function::Gap(c) => self.gap[c] = true,
            Function::Normal(c) => self.normal[c] = true,
            Function::Cone(c, positive) => self.cone[c][usize::from(!positive)] = true,
            Function::Slip(c) => self.slip[c] = true,
            Function::Signal(s) => self.signals[s] = true,
            Function::Regularity => self.regularity = true,
            Function::Shared => self.shared = true,
        }
    }

    /// Adds a function that has reached zero where the mode begins.
    pub(in crate::hybrid) fn add_at_beginning(&mut self, function: Function) {
        if let Function::Gap(c) = function {
            self.grounded[c] = true;
        }
    }

    /// Whether anything has fired.
    pub(in crate::hybrid) fn any(&self) -> bool {
        self.elements().contains(&true) || self.signals.contains(&true) || self.regularity || self.shared
    }

    /// The elements of which a function has reached zero.
    pub(super) fn elements(&self) -> [bool; C] {
        filled(|c| self.gap[c] || self.normal[c] || self.cone[c] != [false; 2] || self.slip[c])
    }
}

/// The hybrid state of a run between two steps: its time, its state and its mode.
#[derive(Clone, Copy, Debug)]
pub(in crate::hybrid) struct HybridState<H, const N: usize, const W: usize, const C: usize, const S: usize> {
    pub(in crate::hybrid) t: f64,
    pub(in crate::hybrid) state: [f64; N],
    pub(in crate::hybrid) in_mode: InMode<H, N, W, C, S>,
    pub(in crate::hybrid) sides: Sides<C, S>,
    /// The states of grips and latches that a run begins with are not known yet.
    pub(in crate::hybrid) begins: bool,
}
