//! The places of the declared bodies, from which a picture of a motion is drawn.

use crate::numbers::real::Real;

/// A rigid body or particle as it was declared, at one moment.
///
/// What the declaration leaves out is `None`: a body without `center` has no place, one without `orientation` does not turn.
/// Particles have a mass and a center, and the names `particle 1`, `particle 2`, .. in the order of their declaration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body<R = f64> {
    /// The name.
    pub name: &'static str,
    /// The mass, if it depends on constants alone.
    pub mass: Option<R>,
    /// The matrix entries `xx, yy, zz, xy, yz, zx` of its inertia about the mass centre, in body axes, if
    /// they depend on constants alone.
    pub inertia: Option<[R; 6]>,
    /// The mass centre, in the world's axes.
    pub center: Option<[R; 3]>,
    /// The matrix from body axes to the world's, row by row: its columns are the body's axes.
    pub orientation: Option<[[R; 3]; 3]>,
}

/// A system with `B` declared bodies and particles over a state of `N` reals. Generated systems that declare some are.
///
/// ```
/// use guen_runtime::{Bodies, Body};
///
/// /// A bead on a vertical wire: its state is its height and its velocity.
/// struct Bead;
///
/// impl Bodies<f64, 2, 1> for Bead {
///     fn bodies(&self, _t: f64, &[z, _]: &[f64; 2]) -> [Body; 1] {
///         let center = Some([0.0, 0.0, z]);
///         [Body { name: "bead", mass: Some(0.1), inertia: None, center, orientation: None }]
///     }
/// }
/// assert_eq!(Bead.bodies(0.0, &[2.0, 0.0])[0].center, Some([0.0, 0.0, 2.0]));
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no declared bodies over a state of {N} reals",
    note = "systems that declare `bodies` or `particles` have; others are drawn by placing bodies by hand"
)]
pub trait Bodies<R: Real, const N: usize, const B: usize> {
    /// The bodies and then the particles, in the order of their declaration. No allocation.
    fn bodies(&self, t: R, state: &[R; N]) -> [Body<R>; B];
}

impl<R: Real, S: Bodies<R, N, B> + ?Sized, const N: usize, const B: usize> Bodies<R, N, B> for &S {
    #[inline]
    fn bodies(&self, t: R, state: &[R; N]) -> [Body<R>; B] {
        (**self).bodies(t, state)
    }
}
