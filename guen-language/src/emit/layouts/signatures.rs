//! Signatures of methods that a system has and a scene may lack: of the real items and of the hints in their place.
//!
//! Methods that macros of the runtime write have theirs there, too; a test compares them with these.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};

use super::layout::{Layout, inputs};

/// A method of time and state, and of the inputs where it is driven.
#[derive(Clone, Copy)]
pub(in crate::emit) struct Signature {
    pub(in crate::emit) method: &'static str,
    is_driven: bool,
    returns: Returns,
}

/// The type that a method returns.
#[derive(Clone, Copy)]
enum Returns {
    Real,
    /// The record of this name, with named fields.
    Record(&'static str),
    Linearization,
    /// The linearisation of so many scalar outputs.
    OutputLinearization(usize),
}

pub(in crate::emit) const ENERGY: Signature = Signature::of("energy", Returns::Real);
pub(in crate::emit) const KINETIC_ENERGY: Signature = Signature::of("kinetic_energy", Returns::Real);
pub(in crate::emit) const FORCE_FUNCTION: Signature = Signature::of("force_function", Returns::Real);
pub(in crate::emit) const VELOCITIES: Signature = Signature::of("velocities", Returns::Record("Coordinates"));
pub(in crate::emit) const MOMENTA: Signature = Signature::of("momenta", Returns::Record("Momenta"));
pub(in crate::emit) const RESIDUALS: Signature = Signature::of("residuals", Returns::Record("Residuals"));
pub(in crate::emit) const OUTPUTS: Signature = Signature::driven("outputs", Returns::Record("Outputs"));
pub(in crate::emit) const REACTIONS: Signature = Signature::driven("reactions", Returns::Record("Reactions"));
pub(in crate::emit) const POWER: Signature = Signature::driven("power", Returns::Real);
pub(in crate::emit) const LINEARIZE: Signature = Signature::driven("linearize", Returns::Linearization);

/// The method for so many scalar outputs.
pub(in crate::emit) const fn linearize_outputs(rows: usize) -> Signature {
    Signature::driven("linearize_outputs", Returns::OutputLinearization(rows))
}

impl Signature {
    const fn of(method: &'static str, returns: Returns) -> Self {
        Self { method, is_driven: false, returns }
    }

    const fn driven(method: &'static str, returns: Returns) -> Self {
        Self { method, is_driven: true, returns }
    }

    /// `pub fn ... -> ...`, with the path to the module of the records.
    pub(in crate::emit) fn head(self, layout: &Layout, records: &TokenStream) -> TokenStream {
        let name = format_ident!("{}", self.method);
        let parameter = self.is_driven.then(|| inputs(layout).0);
        let (size, count) = (layout.size, layout.inputs);
        let returns = match self.returns {
            Returns::Real => quote!(R),
            Returns::Record(name) => {
                let name = format_ident!("{name}");
                quote!(#records #name<R>)
            }
            Returns::Linearization => quote!(__guen::Linearization<R, #size, #count>),
            Returns::OutputLinearization(rows) => {
                quote!(__guen::OutputLinearization<R, #size, #count, #rows>)
            }
        };
        quote!(pub fn #name(&self, t: R, state: &State<R> #parameter) -> #returns)
    }
}
