//! Every method, one line each.

use guen::prelude::*;
use guen::steppers::Method;
use guen::{Differentiable, TaylorSeries};

/// What a method promises of its own accord.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Promise {
    /// The step is the caller's: the guard alone stands between a step too long and the result.
    Fixed,
    /// Errors of this tolerance.
    Adaptive(f64),
}

/// Somebody who is shown all methods.
pub trait Visitor<R: Ordered, S: ?Sized, const N: usize> {
    fn visit<M: Method<R, S, N>>(&mut self, name: &'static str, promise: Promise, method: &M);
}

/// The settings that depend on the question.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// The step of RK4 and of Gauss's methods; RK8 takes four times, Euler an eighth of it.
    pub step: f64,
    /// The tolerances of adaptive methods.
    pub relative: f64,
    pub absolute: f64,
}

/// The adaptive methods, which have to arrive wherever an answer exists and is not refused for a reason.
pub const ADAPTIVE: &[&str] = &["Tsit5", "DOP853", "Taylor", "Radau 5"];

/// The steps that Radau 5 may make: a fifth of what others may, since each takes ten times as long. Where that is not
/// enough it is the wrong method, and says so.
const RADAU_STEPS: u64 = 20_000;

/// Shows all explicit methods but Taylor's, which a chain of twenty links does without.
pub fn explicit<R, S, V, const N: usize>(settings: Settings, visitor: &mut V)
where
    R: Ordered,
    S: System<R, N>,
    V: Visitor<R, S, N>,
{
    let Settings { step, relative, absolute } = settings;
    let h = R::from_f64(step);
    let adaptive = Promise::Adaptive(relative);
    visitor.visit("Euler", Promise::Fixed, &Euler::new(h * R::from_ratio(1, 8)));
    visitor.visit("RK4", Promise::Fixed, &Rk4::new(h));
    visitor.visit("RK8", Promise::Fixed, &Rk8::new(h * R::from_ratio(4, 1)));
    visitor.visit("Tsit5", adaptive, &Tsit5::new(relative, absolute));
    visitor.visit("DOP853", adaptive, &Dop853::new(relative, absolute));
}

/// Shows all methods, in the order of the columns of the table.
pub fn all<R, S, V, const N: usize>(settings: Settings, visitor: &mut V)
where
    R: Ordered,
    S: System<R, N> + Differentiable<R, N> + TaylorSeries<R, N>,
    V: Visitor<R, S, N>,
{
    explicit(settings, visitor);
    let Settings { step, relative, absolute } = settings;
    let h = R::from_f64(step);
    visitor.visit("Taylor", Promise::Adaptive(relative), &Taylor::new(relative, absolute));
    visitor.visit("Gauss 4", Promise::Fixed, &Gauss4::new(h));
    visitor.visit("Gauss 6", Promise::Fixed, &Gauss6::new(h));
    // Of order five and implicit: a digit less keeps it affordable.
    let ten = Promise::Adaptive(10.0 * relative);
    visitor.visit("Radau 5", ten, &Radau5::new(10.0 * relative, 10.0 * absolute).with_max_steps(RADAU_STEPS));
}
