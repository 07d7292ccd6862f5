//! Exact expressions: a hash-consed graph of sums, products, integer powers and elementary functions.
//!
//! Input: numbers, symbols and operations on them. Output: identifiers of
//! expressions in a normal form that makes equal subexpressions one. The graph never decides whether
//! something vanishes *as a function*: that is the question of `crate::zero`.

mod angles;
mod base_angles;
mod build;
mod derivative;
mod function;
mod functions;
mod gradient;
mod graph;
mod id;
mod map;
mod multivariate;
mod node;
mod ranges;
mod rational;
mod search;
mod substitute;
mod support;
mod symbol;

pub(crate) use base_angles::{AngleParts, BaseAngles};
pub use derivative::Flow;
pub use function::{Function, MAX_ARGUMENTS, Multivariate, SuppliedFunction};
pub(crate) use gradient::gradient;
pub use graph::Graph;
pub(crate) use id::mix;
pub use id::{ExprId, SymbolId};
pub(crate) use map::{FastMap, Key, Ordinal, SortedMap, spread};
pub use node::{Node, PowerError};
pub use ranges::PossibleSigns;
pub use rational::Rational;
pub(crate) use search::sort_ids;
pub use substitute::Substitution;
pub use symbol::{Role, Roles, SignBound, Symbol};
