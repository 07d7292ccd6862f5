//! From forms to operators, brackets and classification, (1.1)-(1.14).

mod brackets;
mod closure;
mod forms;
mod inverse;

pub use brackets::Brackets;
pub use closure::{Closure, Combination};
pub use forms::{Form, Forms};
pub(crate) use inverse::{MANY, adjugate, dependence, is_nested};
pub use inverse::{Operators, SingularForms};
