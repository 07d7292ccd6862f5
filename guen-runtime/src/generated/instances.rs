//! The constants of components as parts of those of systems.

/// The types of the constants of the instances of components that a system or a component has, by their places.
///
/// The module of a system cannot name what is in scope around it, in a body of a function for instance. An implementation beside
/// the module can. `Functions` is the tuple of the types of the functions that the program supplies to an instance.
#[doc(hidden)]
pub trait Instances<const PLACE: usize, Functions = ()> {
    /// The struct of the component.
    type Constants<R>;
}
