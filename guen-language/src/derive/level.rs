//! A derivation: the system and its scenes as levels of detail, each with its programs.

use std::rc::Rc;

use guen_symbolic::{Contracted, Derivation, ExprId, FunctionProgram, Programs, SeriesProgram};

use super::brackets::commutator::Commutator;
use super::contacts::ContactFacts;
use super::quantities::jacobians::Jacobians;
use super::quantities::missing_bounds::MissingBounds;
use super::selections::facts::SceneFacts;
use super::selections::selection::{Selection, StateIndex};
use crate::model::Model;
use crate::syntax::{Name, Scene};

/// A derived system with its scenes.
pub struct DerivedSystem<'a> {
    /// The model.
    pub model: Model<'a>,
    /// The system itself.
    pub system: DerivedLevel,
    /// The scenes, in order.
    pub scenes: Vec<DerivedLevel>,
    /// The scenes in a single mode of contacts, each by its place among the scenes and as the only scene of a system of its own.
    pub in_modes: Vec<(usize, DerivedSystem<'a>)>,
}

/// A level of detail: the system itself, or a scene.
pub struct DerivedLevel {
    /// The parts of the model that the level has.
    pub selection: Selection,
    /// The derivation, with the constants that a scene fixes at their values.
    pub derivation: Rc<Derivation>,
    /// The brackets that do not vanish identically.
    pub brackets: Rc<Vec<Commutator>>,
    /// The rates of its variables.
    pub rates: Vec<ExprId>,
    /// The equations of motion (2.7) as expressions that vanish; only of the system itself.
    pub equations: Vec<ExprId>,
    /// The energy integral.
    pub energy: ExprId,
    /// The straight-line code.
    pub programs: Programs,
    /// The program of the places of the bodies of the system itself, with a preparation of its own: nothing is
    /// prepared for programs that never look.
    pub placed: Option<Programs>,
    /// Functions that must not vanish: the domain of the chart.
    pub domain: Vec<ExprId>,
    /// Each of them in words.
    pub domain_names: Vec<String>,
    /// The reason for each of them: what degenerates where it vanishes, and at which states; empty of a carried form.
    pub domain_reasons: Vec<String>,
    /// The number of them, from the first, that guards measure one by one; the others are determinants, and measured
    /// together as the condition of the mass matrix.
    pub singularities: usize,
    /// The texts of the functions at whose zeros the rates change their formula; [`SWITCHES`](super::function::SWITCHES) computes them.
    pub switches: Vec<String>,
    /// Expressions of constants that must not vanish.
    pub constant_pivots: Vec<ExprId>,
    /// The bounds that would save operations; of the system itself.
    pub missing_bounds: Option<MissingBounds>,
    /// The recurrences of its Taylor series, if it provides one.
    pub series: Option<Series>,
    /// Whether its right-hand side is a text of C, too.
    pub provides_source: bool,
    /// The places of the derivatives that have code of their own.
    pub jacobians: Jacobians,
    /// The notation of expressions in the report.
    pub shown: Contracted,
    /// The facts about a scene that its documentation tells; none for the system itself.
    pub scene: Option<SceneFacts>,
    /// The facts about contacts, of a system that has some.
    pub contacts: Option<ContactFacts>,
    /// The level with its elementary functions as states, if that form is provided.
    pub carried: Option<Box<DerivedLevel>>,
}

impl DerivedLevel {
    /// The program of a function, if it computes anything.
    pub fn program(&self, name: &str) -> Option<&FunctionProgram> {
        self.programs.functions.iter().find(|function| function.name == name)
    }
}

/// The recurrences of a level's Taylor series.
pub struct Series {
    /// The series with inputs that are held.
    pub held: SeriesProgram,
    /// The series with inputs that have series of their own, if there are inputs and the motion is analytic in them.
    pub along_inputs: Option<SeriesProgram>,
}

/// A level of detail on its way to Rust items: the system itself, or one of its scenes. Report and emission read the same.
pub(crate) struct Subject<'d, 'a> {
    /// The model.
    pub(crate) model: &'d Model<'a>,
    /// The level.
    pub(crate) level: &'d DerivedLevel,
    /// The model of the system that the level belongs to: another one of a scene in a single mode of contacts.
    pub(crate) whole: &'d Model<'a>,
}

impl<'d, 'a> Subject<'d, 'a> {
    /// The scene, unless it is the system itself.
    pub(crate) fn scene(&self) -> Option<(&'d Scene, &'d SceneFacts)> {
        let facts = self.level.scene.as_ref()?;
        Some((self.model.scenes[facts.index].scene, facts))
    }

    /// The place of a variable in the state of the whole system.
    pub(crate) fn place_in_whole(&self, place: StateIndex) -> StateIndex {
        match std::ptr::eq(self.model, self.whole) {
            true => place,
            false => self.named_in_whole(self.model.variable_name(place)),
        }
    }

    /// The place of a name in the state of the whole system.
    pub(crate) fn named_in_whole(&self, name: &str) -> StateIndex {
        let (_, size) = self.whole.sizes();
        (0..size).find(|place| self.whole.variable_name(*place) == name).expect("a variable of the system")
    }

    /// The name of the struct.
    pub(crate) fn name(&self) -> &'d Name {
        self.scene().map_or(&self.model.declaration.name, |(scene, _)| &scene.name)
    }
}
