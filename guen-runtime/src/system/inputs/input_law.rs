//! Laws for inputs, written for every real.

use core::marker::PhantomData;

use crate::numbers::real::Real;

/// A prepared system with inputs, as a family over every real: its states and its inputs, with named fields. Generated systems
/// are; [`InputLaw`] has an example.
pub trait InputRecords {
    /// A state over another real.
    type StateOver<R: Real>;

    /// The inputs over another real.
    type InputsOver<R: Real>;
}

/// A law for the inputs of the prepared system `P` that is written for every real, so that methods and analyses which need its
/// derivatives can have them: for [`Actuated::with_law`](crate::Actuated::with_law).
///
/// For a generated system `cart` it is `impl InputLaw<cart::Prepared> for Spring`, and its function is
/// `fn at<R: Real>(&self, t: R, state: &cart::State<R>) -> cart::Inputs<R>`.
///
/// ```
/// use guen_runtime::{InputLaw, InputRecords, Real};
///
/// /// What the macro generates.
/// struct Prepared;
/// struct State<R> { x: R, v: R }
/// struct Inputs<R> { force: R }
/// impl InputRecords for Prepared {
///     type StateOver<R: Real> = State<R>;
///     type InputsOver<R: Real> = Inputs<R>;
/// }
///
/// struct Spring { stiffness: f64, damping: f64 }
/// impl InputLaw<Prepared> for Spring {
///     fn at<R: Real>(&self, _t: R, state: &State<R>) -> Inputs<R> {
///         let [stiffness, damping] = [self.stiffness, self.damping].map(R::from_f64);
///         Inputs { force: -stiffness * state.x - damping * state.v }
///     }
/// }
/// assert_eq!(Spring { stiffness: 2.0, damping: 1.0 }.at(0.0, &State { x: 3.0, v: 0.5 }).force, -6.5);
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is no law for the inputs of `{P}`",
    note = "it is written for every real: `fn at<R: Real>(&self, t: R, state: &State<R>) -> Inputs<R>`",
    note = "a closure is for one real: `.with_inputs(|t, state| ..)`"
)]
pub trait InputLaw<P: InputRecords> {
    /// The inputs at a time and state.
    fn at<R: Real>(&self, t: R, state: &P::StateOver<R>) -> P::InputsOver<R>;
}

impl<P: InputRecords, L: InputLaw<P> + ?Sized> InputLaw<P> for &L {
    fn at<R: Real>(&self, t: R, state: &P::StateOver<R>) -> P::InputsOver<R> {
        (**self).at(t, state)
    }
}

/// An [`InputLaw`] of the system `P` with `M` inputs.
#[derive(Debug)]
pub struct SmoothLaw<L, P, const M: usize> {
    pub(crate) law: L,
    system: PhantomData<fn() -> P>,
}

impl<L, P, const M: usize> SmoothLaw<L, P, M> {
    pub(crate) fn new(law: L) -> Self {
        Self { law, system: PhantomData }
    }
}

impl<L: Clone, P, const M: usize> Clone for SmoothLaw<L, P, M> {
    fn clone(&self) -> Self {
        Self::new(self.law.clone())
    }
}

impl<L: Copy, P, const M: usize> Copy for SmoothLaw<L, P, M> {}
