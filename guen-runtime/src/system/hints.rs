//! Messages for calls that come too early: constants that are not prepared, and prepared systems whose inputs nobody has set.
//!
//! Constants have no method [`simulate`](crate::Simulate::simulate), and without this module the compiler would say only that.
//! [`Unprepared`] gives them methods of the same names, and [`Actuated`](crate::Actuated) one to a prepared system without inputs, with a
//! bound that no type fulfils: the error for that bound is our message.
//! The methods take `&mut self`, which the compiler tries after the `&self` of the real ones. They are written out and not made by a
//! macro, because the compiler would show the macro in its message.

/// The constants of a system, before `prepare`.
#[doc(hidden)]
pub trait Unprepared {
    /// Answers with the message of its bound.
    fn simulate<Start, Span, Motion>(&mut self, _: Start, _: Span) -> Motion
    where
        Self: Preparation,
    {
        self.never()
    }

    /// Answers with the message of its bound.
    fn simulation<Start, Simulation>(&mut self, _: Start) -> Simulation
    where
        Self: Preparation,
    {
        self.never()
    }

    /// Answers with the message of its bound.
    fn with_inputs<Law, Driven>(&mut self, _: Law) -> Driven
    where
        Self: Preparation,
    {
        self.never()
    }

    /// Answers with the message of its bound.
    fn with_law<Law, Driven>(&mut self, _: Law) -> Driven
    where
        Self: Preparation,
    {
        self.never()
    }

    /// Answers with the message of its bound.
    fn rhs<Time, State, Rates>(&mut self, _: Time, _: State) -> Rates
    where
        Self: Preparation,
    {
        self.never()
    }

    /// Answers with the message of its bound.
    fn energy<Time, State, Energy>(&mut self, _: Time, _: State) -> Energy
    where
        Self: Preparation,
    {
        self.never()
    }
}

/// The bound of [`Unprepared`]: nothing implements it.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not prepared: constants become a system by `.prepare()?`",
    label = "`.prepare()?` is missing before this call"
)]
#[doc(hidden)]
pub trait Preparation {
    /// The answer to a call that does not compile.
    fn never<Answer>(&self) -> Answer;
}

/// The bound of [`simulate`](crate::Actuated::simulate) before there are inputs: nothing implements it.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has inputs that nobody has set: `.with_inputs(|t, state| ..)` makes them functions, `.driven(inputs)` holds them",
    label = "`.with_inputs(..)` is missing before this call"
)]
#[doc(hidden)]
pub trait Inputs {
    /// The answer to a call that does not compile.
    fn never<Answer>(&self) -> Answer;
}
