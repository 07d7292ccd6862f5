//! Geometry of the constraints: from forms to operators, brackets and classification, (1.1)-(1.14).

mod blocks;
mod brackets;
mod closure;
mod dependence;
mod forms;
mod independent;
mod minors;
mod next_level;
mod operators;
mod rates;

pub(crate) use blocks::blocks;
pub use brackets::Brackets;
pub use closure::{Closure, Combination};
pub use dependence::SingularForms;
pub(crate) use dependence::dependence;
pub use forms::{Form, Forms};
pub use independent::independent_rows;
pub(crate) use minors::{ADJUGATE_SIZE, adjugate};
pub use operators::Operators;
pub(crate) use operators::{MANY_COORDINATES, is_nested};
pub use rates::{RateChoice, chosen_rates};
