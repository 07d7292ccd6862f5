//! The base angles that a graph has chosen.

use std::cell::RefCell;
use std::collections::BTreeMap;

use super::id::ExprId;
use super::map::FastMap;
use super::rational::Rational;

/// A combination of monomials and base angles; the number is a multiple of one.
pub(crate) type AngleParts = Vec<(ExprId, Rational)>;

/// The base angles into which arguments of sines and cosines are taken apart.
#[derive(Debug, Default)]
pub(crate) struct BaseAngles {
    /// While a declaration is read: sums are not taken apart at all.
    pub(super) are_whole: bool,
    /// The base angles, once they are chosen.
    pub(super) base: Vec<ExprId>,
    /// Monomials that a base angle of several terms stands for: each by base angles and other monomials.
    pub(super) images: BTreeMap<ExprId, AngleParts>,
    /// Arguments that were taken apart: they are asked for again and again.
    pub(super) known: RefCell<FastMap<ExprId, AngleParts>>,
}
