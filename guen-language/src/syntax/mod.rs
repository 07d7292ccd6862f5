//! The syntax tree: what was written, with the place of every word, and nothing decided about its meaning.
//!
//! Where the parser reported a fault the tree holds [`ExpressionKind::Missing`], so that the names around it are
//! still known to whoever emits signatures after an error. A tree whose report is empty has none of them, has
//! every section at most once, and has a `coordinates` section.
//!
//! Counts, loops, conditions on indices and indices as they were written are in the tree until `unfold` has written them out.

mod component;
mod contact;
mod digest;
mod display;
mod expression;
mod index;
mod name;
mod number;
mod section;
mod unit;
mod walk;

pub use component::{
    Argument, ArgumentKind, Component, ComponentPath, DeclaredArgument, GivenArgument, Imported, Instance,
    Use, undeclared_components,
};
pub use contact::{
    Clause, ClauseWord, Contact, Crossing, HeldContact, ModeStatement, Reset, ResetAssignment, SPEED,
    SingleMode, SlipDirection, StatesType, Switch, type_of_states,
};
pub use digest::digest_of;
pub use expression::{AddOperator, Expression, ExpressionKind, Factor, Fold, MultiplyOperator, Order, Term};
pub use index::{
    Comparison, Condition, Conditional, EntryNode, Index, IndexExpression, IndexKind, IndexOperator, Loop,
    Path, Range, Step, WrittenIndex, WrittenMember,
};
pub use name::{Docs, Name, Visibility};
pub use number::{Number, NumberProblem};
pub use unit::{Dimension, Unit};

pub use section::{
    Body, BodyField, BoundKind, Constant, Count, Declaration, Definition, Equation, Fix, Force,
    FunctionDefinition, Inertia, Item, Particle, Plain, Provide, Quantity, Scene, SceneStatement, Section,
    SectionKind, State, SuppliedFunction, WrittenBound,
};
