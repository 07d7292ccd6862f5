//! Checks the syntax tree and makes the model: names, kinds, linear forms, energies; every fault collected.
//!
//! What comes in was parsed without a fault. What goes out is a [`Model`] around a
//! [`guen_symbolic::Mechanics`], in which every expression is an exact one over checked names.

mod accelerations;
mod assumed_rates;
mod bodies;
mod calls;
mod contact;
mod contact_values;
mod declared_functions;
mod dimensions;
mod evaluate;
mod expression_place;
mod forms;
mod functions;
mod jumps;
mod motion_symbols;
mod piecewise;
mod quaternions;
mod rates;
mod resolve;
mod scenes;
mod scope;
mod shapes;
mod spatial;
mod value;

use guen_symbolic::{ExprId, Mechanics, Multivariate, Operation, Workbench};
use proc_macro2::{Ident, Span};

use crate::syntax::{BoundKind, Declaration, Docs, Name, Scene, SuppliedFunction};

pub use contact::{ContactEntry, ContactKind, ContactRow, ContactState, Contacts, SwitchEntry};
pub(crate) use dimensions::check as check_dimensions;
pub use dimensions::{Units, momentum, reaction, residual};
pub use rates::ChosenRates;
pub(crate) use rates::nominal;
pub use resolve::resolve;
pub(crate) use resolve::resolved;
pub(crate) use scenes::is_carried_form;

/// A checked system.
pub struct Model<'a> {
    /// The declaration.
    pub declaration: &'a Declaration,
    /// The expressions and what answers questions about them.
    pub bench: Workbench,
    /// Physical constants in order.
    pub constants: Vec<ConstantEntry<'a>>,
    /// Functions that the program supplies, in order.
    pub functions: Vec<&'a SuppliedFunction>,
    /// Control inputs in order.
    pub inputs: Vec<SymbolEntry<'a>>,
    /// Coordinates in order.
    pub coordinates: Vec<SymbolEntry<'a>>,
    /// The forms `eta_1..eta_n`, parameters first.
    pub forms: Vec<FormEntry<'a>>,
    /// The units of names, where units are declared.
    pub units: Units,
    /// Parameters that the declaration left out, where it did.
    pub chosen: Option<ChosenRates>,
    /// Holonomic equations that follow from others wherever all hold, in the order of the mechanics.
    pub redundant: Vec<RedundantEntry<'a>>,
    /// Bodies in order.
    pub bodies: Vec<BodyEntry>,
    /// Masses and positions of particles in order.
    pub particles: Vec<(ExprId, [ExprId; 3])>,
    /// States beside the motion, in order.
    pub states: Vec<SymbolEntry<'a>>,
    /// Outputs in order.
    pub outputs: Vec<OutputEntry<'a>>,
    /// Unit quaternions among the coordinates, by the indices of `w, x, y, z`.
    pub quaternions: Vec<[usize; 4]>,
    /// Constraints whose reactions outputs use, with the place.
    pub reactions: Vec<(usize, Span)>,
    /// Contacts with their modes, where the declaration has some.
    pub contacts: Option<Contacts<'a>>,
    /// The parameters that follow from others, where the system is another one in a single mode.
    pub followers: Vec<Follower>,
    /// Symbols of reactions that are not determined, where the system is another one in a single mode.
    pub undetermined: Vec<ExprId>,
    /// The reactions that friction depends on, where the system is another one in a mode in which contacts slip.
    pub loads: Vec<Load<'a>>,
    /// The functions that this friction divides by.
    pub divisors: Vec<Divisor>,
    /// Scenes whose names are sound.
    pub scenes: Vec<SceneEntry<'a>>,
    /// Whether the system or a scene provides operators: then all brackets are derived.
    pub provides_operators: bool,
    /// The word by which the system provides its Taylor series.
    pub provides_taylor: Option<&'a Name>,
    /// The word by which the system provides its carried form.
    pub provides_carried: Option<&'a Name>,
    /// The word by which the system provides its right-hand side as a text of C.
    pub provides_source: Option<&'a Name>,
    /// Components of vector equations that are identically `0 = 0`, by name.
    pub left_out: Vec<String>,
    /// Names as the user wrote them.
    pub identifiers: Identifiers,
    /// The mechanical system.
    pub mechanics: Mechanics,
    /// Whether a fault was found in what the motion does not need: nothing but further faults may be derived.
    pub is_partial: bool,
    /// Whether the kinetic energy is more than the words of `kinetic_energy`: particles or bodies add to it.
    pub has_masses: bool,
    /// The word `kinetic_energy`, where the energy is given by a formula.
    pub kinetic_energy_span: Option<Span>,
}

/// Names at their places: for editors, which lead from a use to the declaration, and for the compiler's lint on what
/// is never used.
pub struct Identifiers {
    /// Every declared name.
    pub declared: Vec<Ident>,
    /// Every use of a name.
    pub used: Vec<Ident>,
    /// Declared names that something has to use and nothing does, and that do not begin with `_`.
    pub unused: Vec<Ident>,
}

impl Identifiers {
    /// Adds the counts of the declaration, each with whether anything uses it.
    fn with_counts(mut self, counts: &[(Name, bool)]) -> Self {
        for (name, is_used) in counts {
            let list = if *is_used { &mut self.declared } else { &mut self.unused };
            list.push(name.ident.clone());
        }
        self
    }
}

impl Model<'_> {
    /// Leaves out forces and outputs, of which some are missing.
    fn keep_core(&mut self) {
        let mechanics = [Some(&mut self.mechanics), self.contacts.as_mut().map(|c| &mut c.mechanics)];
        for mechanics in mechanics.into_iter().flatten() {
            let zero = self.bench.graph.zero();
            mechanics.forces.iter_mut().for_each(|force| force.magnitude = zero);
            mechanics.outputs.iter_mut().for_each(|output| *output = zero);
        }
    }

    /// A body whose mass or a moment of inertia is a negative number, or whose inertia in numbers no body can have.
    pub(crate) fn suspicious_body(&self) -> Option<&str> {
        let body = self.bodies.iter().find(|body| {
            let moments = body.inertia.iter().flat_map(|entries| &entries[..3]);
            body.is_impossible || body.mass.iter().chain(moments).any(|e| self.is_negative(*e))
        });
        let particle =
            || self.particles.iter().any(|(mass, _)| self.is_negative(*mass)).then_some("particles");
        body.map(|body| body.name.as_str()).or_else(particle)
    }

    /// The name of the function that an operation calls.
    pub(crate) fn called(&self, operation: &Operation) -> String {
        match operation {
            Operation::Call(function, _) => function.name().to_owned(),
            Operation::Apply(Multivariate::Supplied { function, .. }, _) => {
                self.bench.graph.supplied_functions()[usize::from(*function)].name.clone()
            }
            Operation::Apply(function, _) => function.name().to_owned(),
            _ => "an operation".to_owned(),
        }
    }

    /// Whether an expression depends on constants alone, and on no function that the program supplies.
    pub(crate) fn is_constant(&self, e: ExprId) -> bool {
        let graph = &self.bench.graph;
        graph.roles(e).is_constant() && !graph.has_supplied(e)
    }

    /// Whether an expression is a negative number.
    pub(crate) fn is_negative(&self, e: ExprId) -> bool {
        self.bench.graph.as_number(e).is_some_and(|number| number.to_f64() < 0.0)
    }

    /// The last operator whose brackets are derived.
    pub fn last_operator(&self) -> usize {
        if self.provides_operators { self.coordinates.len() } else { self.mechanics.forms.degrees }
    }
}

/// A reaction that friction depends on.
pub struct Load<'a> {
    /// The contact or grip that slips.
    pub name: &'a Name,
    /// The symbol that stands for it in forces, outputs and rates.
    pub symbol: ExprId,
    /// The symbol of the reaction, which the derivation knows.
    pub reaction: ExprId,
    /// Whether its magnitude is meant.
    pub is_magnitude: bool,
}

/// A function that must not vanish beside those that follow from the motion.
pub struct Divisor {
    /// The place among the outputs of the mechanics.
    pub output: usize,
    /// The reason: what is not there where it vanishes.
    pub origin: String,
}

/// A physical constant.
pub struct ConstantEntry<'a> {
    /// Name as written.
    pub name: &'a Name,
    /// Documentation as written.
    pub docs: &'a Docs,
    /// The promise.
    pub bound: Option<BoundKind>,
    /// The least and the largest value, of constants, where they are declared.
    pub limits: Option<[ExprId; 2]>,
    /// The default, of earlier constants.
    pub default: Option<ExprId>,
    /// Whether the constant follows others until it is set: its field is a `Derived<R>`, and no plain number. The entries of an array have one
    /// type, so that one which follows others makes all of them such.
    pub is_derived: bool,
    /// The symbol.
    pub symbol: ExprId,
}

/// A coordinate, an input or a state.
pub struct SymbolEntry<'a> {
    /// Name as written.
    pub name: &'a Name,
    /// Documentation as written.
    pub docs: &'a Docs,
    /// The symbol.
    pub symbol: ExprId,
    /// The least and the largest value, of constants, where an input declares them.
    pub limits: Option<[ExprId; 2]>,
}

/// The section that a form comes from.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum FormKind {
    /// `parameters`.
    Parameter,
    /// `constraints`.
    Constraint,
    /// `holonomic`.
    Holonomic,
}

/// An entry of the list of the `n` forms.
pub struct FormEntry<'a> {
    /// The name, with the component where a vector was written.
    pub name: String,
    /// The entry's name as written.
    pub written: &'a Name,
    /// Documentation as written.
    pub docs: &'a Docs,
    /// The section that it comes from.
    pub kind: FormKind,
    /// Whether the kinetic energy mentions the name.
    pub mentioned_in_energy: bool,
}

impl FormEntry<'_> {
    /// The name with the place of what was written: of the component, where a vector was written, and of the rate of a coordinate.
    pub fn own_name(&self) -> Name {
        self.written.part(&self.name).unwrap_or_else(|| self.written.clone())
    }
}

/// A holonomic equation that follows from others wherever all hold, and is no form.
pub struct RedundantEntry<'a> {
    /// The declaration of the equation.
    pub entry: FormEntry<'a>,
    /// The forms that it is dependent on, whose reactions it leaves undetermined.
    pub beside: Vec<usize>,
}

/// The mass, inertia, centre and orientation of a body.
pub struct BodyEntry {
    /// The name.
    pub name: String,
    /// The mass, if there is one.
    pub mass: Option<ExprId>,
    /// The matrix entries `xx, yy, zz, xy, yz, zx` of its inertia, if it has one.
    pub inertia: Option<[ExprId; 6]>,
    /// The mass centre, if it has one.
    pub center: Option<[ExprId; 3]>,
    /// The matrix of its orientation, row by row, if it has one.
    pub orientation: Option<[[ExprId; 3]; 3]>,
    /// Whether its inertia is given in numbers that no distribution of mass has, and it turns about more than one axis.
    pub is_impossible: bool,
}

/// A scene whose names are sound.
pub struct SceneEntry<'a> {
    /// The scene as it was written.
    pub scene: &'a Scene,
    /// The constants that it fixes.
    pub fixes: Vec<FixedConstant<'a>>,
    /// The parameters and coordinates that it holds at their initial values.
    pub held: Vec<&'a Name>,
    /// The modes of the contacts that the scene has.
    pub modes: SceneModes,
}

impl SceneEntry<'_> {
    /// The states of the contacts, where the scene has a single mode.
    pub fn single_mode(&self) -> Option<&[usize]> {
        match &self.modes {
            SceneModes::One(mode) => Some(mode),
            _ => None,
        }
    }
}

/// The modes of a scene: states of the contacts, in the order of [`ContactEntry::states`].
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum SceneModes {
    /// The scene is of a system without contacts and switches.
    Without,
    /// One mode, in which the scene is a smooth system.
    One(Vec<usize>),
    /// The modes through which the scene runs.
    Several(Vec<Vec<usize>>),
}

/// A parameter of the whole system that follows from others in the mode of the only scene.
pub struct Follower {
    /// The name.
    pub name: String,
    /// The place of its value among the outputs of the mechanics.
    pub output: usize,
}

/// A constant that a scene fixes.
pub struct FixedConstant<'a> {
    /// The name after `fix`.
    pub name: &'a Name,
    /// The symbol.
    pub symbol: ExprId,
    /// The value, a number or made of constants that are not fixed.
    pub value: ExprId,
}

/// An output: a scalar, or the three components of a vector.
pub struct OutputEntry<'a> {
    /// Name as written.
    pub name: &'a Name,
    /// Documentation as written.
    pub docs: &'a Docs,
    /// Indices into the outputs of the mechanics: one for a scalar, three for a vector.
    pub components: Vec<usize>,
}
