//! Exact algebra and the derivation of the equations of motion, (1.1)-(2.10) of Pham Guen (1969).
//!
//! This crate knows neither tokens nor the language of the macro. What comes in is a [`Graph`] of
//! expressions and the forms, energies and forces over it; what goes out are operators, brackets,
//! classification, equations of motion and straight-line programs. The folders are the pipeline:
//!
//! `algebra` (expressions) -> `zero` (does it vanish?) -> `normal` (polynomial normal forms) -> `print`
//! -> `geometry` (forms, operators, brackets, class) -> `motion` (equations) -> `program` (straight-line code).
#![cfg_attr(docsrs, feature(doc_cfg))]
#![forbid(unsafe_code)]
#![warn(unreachable_pub)]

mod algebra;
mod geometry;
mod motion;
mod normal;
mod numbering;
mod print;
mod program;
mod workbench;
mod zero;

pub use algebra::{
    ExprId, Flow, Function, Graph, MAX_ARGUMENTS, Multivariate, Node, PossibleSigns, PowerError, Rational,
    Role, Roles, SignBound, Substitution, SuppliedFunction, Symbol, SymbolId,
};
pub use geometry::{
    Brackets, Closure, Combination, Form, Forms, Operators, RateChoice, SingularForms, chosen_rates,
    independent_rows,
};
pub use motion::{
    BodyNode, COUPLED_COORDINATES, Class, Dependence, Derivation, DerivationError, Energies, FirstOrderState,
    Force, FormShape, Formulated, Frame, FrameId, FrameNode, Holonomic, KineticTerm, Mechanics, Motion,
    MotionEquations, MotionSymbol, Multibody, NotQuadratic, Place, REFUTED, RigidBody, Solution, SystemGraph,
    Turn, Velocity, VelocityComponent, VelocityForm, VelocityPartials, WRITTEN_OUT_PARAMETERS, decompose,
    elimination_text, equations_by_definition, formulation_names,
};
pub use normal::{Limits, normal_coefficients, normal_form};
pub use print::{Contracted, Notation, greek_letter, latex_name};
pub use program::{
    Arithmetic, ArrayIndex, Arrays, Carried, CarriedFunction, Formulation, FunctionProgram, Instruction,
    LARGEST_DIFFERENTIATED, LARGEST_JACOBIAN, Line, Loop, NotAnalytic, NotCarried, Operand, Operation,
    OperationCount, Pattern, Places, ProgramBuilder, Programs, Rolled, RolledStep, SeriesProgram, SeriesStep,
    Start, SymbolInStep, Value, evaluate_function, evaluate_prepare, weighted_cost,
};
pub use workbench::{MAX_WORK, Workbench};
pub use zero::{Real, Redundant, Verdict, ZeroTest, evaluate, evaluate_f64};
