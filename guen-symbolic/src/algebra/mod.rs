//! Exact expressions: a hash-consed graph of sums, products, integer powers and elementary functions.
//!
//! What comes in are numbers, symbols and operations on them; what goes out are identifiers of
//! expressions in a normal form that makes equal subexpressions one. The graph never decides whether
//! something vanishes *as a function*: that is the question of `crate::zero`.

mod angles;
mod build;
mod derivative;
mod functions;
mod graph;
mod map;
mod ranges;
mod rational;
mod search;
mod substitute;
mod symbol;

pub(crate) use angles::{AngleParts, BaseAngles};
pub use derivative::Flow;
pub use functions::Function;
pub(crate) use graph::mix;
pub use graph::{ExprId, Graph, Node, PowerError, SymbolId};
pub(crate) use map::{FastMap, Key, Ordinal, SortedMap, spread};
pub use rational::Rational;
pub(crate) use search::sort_ids;
pub use substitute::Substitution;
pub use symbol::{Bound, Role, Roles, Symbol};
