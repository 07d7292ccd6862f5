//! A declaration and its sections as written.

use std::cell::OnceCell;
use std::rc::Rc;

use proc_macro2::{Span, TokenStream};

use super::{
    Argument, Component, Contact, Docs, EntryNode, Expression, Imported, IndexExpression, Instance,
    ModeStatement, Name, Reset, SingleMode, Switch, Unit, Use, Visibility,
};

/// A declaration: one `system` with its sections.
#[derive(Debug, Clone)]
pub struct Declaration {
    /// The tokens of the invocation.
    pub tokens: TokenStream,
    /// The path after `crate =`: how the facade is called in the user's crate, where that is not `::guen`.
    pub crate_path: Option<TokenStream>,
    /// Doc comments of the system.
    pub docs: Docs,
    /// Visibility of what is generated.
    pub visibility: Visibility,
    /// Name of the system.
    pub name: Name,
    /// Sections, definitions and scenes, in the order in which they were written: a name is declared before use.
    pub items: Vec<Item>,
    /// The order of the items, where loops and conditions stand between them; empty where there are none.
    pub nesting: Vec<EntryNode>,
    /// The counts, once they are known, each with whether anything uses it.
    pub counts: Vec<(Name, bool)>,
    /// The components that it uses and does not declare itself.
    pub imported: Vec<Imported>,
    /// The instances of components, once uses are unfolded, each behind the one that it is a part of.
    pub instances: Vec<Instance>,
    /// The components that are declared in the braces, each with its constants as a declaration.
    pub components: Vec<(Rc<Component>, Declaration)>,
    /// The instance that each item comes from, as a place in `instances`; empty where there are none.
    pub origins: Vec<Option<usize>>,
    /// The mode that all contacts stay in; of the declaration of one mode of another declaration.
    pub in_mode: Option<SingleMode>,
    /// Whether it stands in for a faulty declaration.
    pub is_outline: bool,
    /// The declarations of the modes to which scenes are restricted.
    pub of_modes: OnceCell<Vec<Declaration>>,
}

/// A section, a `let`, a function or a scene.
#[derive(Debug, Clone)]
pub enum Item {
    /// `count n = 20;`. There is none left once loops are unfolded.
    Count(Count),
    /// `constants { .. }`.
    Constants(Section<Constant>),
    /// `functions { name(x, y); .. }`.
    Functions(Section<SuppliedFunction>),
    /// `inputs { .. }`.
    Inputs(Section<Plain>),
    /// `coordinates { .. }`.
    Coordinates(Section<Plain>),
    /// `let name = e;`.
    Let(Definition),
    /// `fn name(x, y) = e;`.
    Function(FunctionDefinition),
    /// `parameters { name = e; .. }`.
    Parameters(Section<Definition>),
    /// `constraints { name: e = e; .. }`.
    Constraints(Section<Equation>),
    /// `holonomic { name: e = e; .. }`.
    Holonomic(Section<Equation>),
    /// `kinetic_energy = e;`.
    KineticEnergy(Quantity),
    /// `particles { e at e; .. }`.
    Particles(Section<Particle>),
    /// `bodies { name { .. } .. }`.
    Bodies(Section<Body>),
    /// `gravity = e;`.
    Gravity(Quantity),
    /// `force_function = e;`.
    ForceFunction(Quantity),
    /// `potential_energy = e;`.
    PotentialEnergy(Quantity),
    /// `states { dot(name) = e; .. }`.
    States(Section<State>),
    /// `forces { e along e; .. }`.
    Forces(Section<Force>),
    /// `switches { name: e; .. }`.
    Switches(Section<Switch>),
    /// `contacts { name: gap = e, ..; .. }`.
    Contacts(Section<Contact>),
    /// `resets { name: e rises, variable = e, ..; .. }`.
    Resets(Section<Reset>),
    /// `modes { contact: state, ..; .. }`.
    Modes(Section<ModeStatement>),
    /// `outputs { name = e; .. }`.
    Outputs(Section<Definition>),
    /// `component Name(a: scalar) { .. }`.
    Component(Component),
    /// `use Name as name { a: e }`.
    Use(Use),
    /// An argument of an instance. There is none before uses are unfolded.
    Argument(Argument),
    /// `provide name, ..;` of the whole system.
    Provide(Section<Provide>),
    /// `scene Name { .. }`.
    Scene(Scene),
}

/// The words that begin an item.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[allow(missing_docs, reason = "each is named as the variant of `Item` that it begins")]
pub enum SectionKind {
    Count,
    Constants,
    Functions,
    Inputs,
    Coordinates,
    Let,
    Function,
    Parameters,
    Constraints,
    Holonomic,
    KineticEnergy,
    Particles,
    Bodies,
    Gravity,
    ForceFunction,
    PotentialEnergy,
    States,
    Forces,
    Switches,
    Contacts,
    Resets,
    Modes,
    Outputs,
    Component,
    Use,
    Provide,
    Scene,
}

impl SectionKind {
    /// Every kind, in the order of [`crate::names::SECTIONS`].
    pub const ALL: [SectionKind; 27] = [
        SectionKind::Count,
        SectionKind::Constants,
        SectionKind::Functions,
        SectionKind::Inputs,
        SectionKind::Coordinates,
        SectionKind::Let,
        SectionKind::Function,
        SectionKind::Parameters,
        SectionKind::Constraints,
        SectionKind::Holonomic,
        SectionKind::KineticEnergy,
        SectionKind::Particles,
        SectionKind::Bodies,
        SectionKind::Gravity,
        SectionKind::ForceFunction,
        SectionKind::PotentialEnergy,
        SectionKind::States,
        SectionKind::Forces,
        SectionKind::Switches,
        SectionKind::Contacts,
        SectionKind::Resets,
        SectionKind::Modes,
        SectionKind::Outputs,
        SectionKind::Component,
        SectionKind::Use,
        SectionKind::Provide,
        SectionKind::Scene,
    ];

    /// The word in the language.
    pub fn word(self) -> &'static str {
        crate::names::SECTIONS[self as usize]
    }

    /// The kind that a word begins, be it another name of the section.
    pub fn of_word(word: &str) -> Option<SectionKind> {
        let word = if crate::names::PARAMETER_ALIASES.contains(&word) {
            SectionKind::Parameters.word()
        } else {
            word
        };
        SectionKind::ALL.into_iter().find(|kind| kind.word() == word)
    }

    /// Whether a system may have several.
    pub fn may_repeat(self) -> bool {
        matches!(
            self,
            SectionKind::Count
                | SectionKind::Let
                | SectionKind::Function
                | SectionKind::Component
                | SectionKind::Use
                | SectionKind::Scene
        )
    }

    /// Whether the word is followed by `= e;`.
    pub fn is_quantity(self) -> bool {
        matches!(
            self,
            SectionKind::KineticEnergy
                | SectionKind::Gravity
                | SectionKind::ForceFunction
                | SectionKind::PotentialEnergy
        )
    }
}

/// A section with entries.
#[derive(Debug, Clone)]
pub struct Section<T> {
    /// Doc comments of the section.
    pub docs: Docs,
    /// Place of the word that begins it.
    pub keyword: Span,
    /// The entries of the section.
    pub entries: Vec<T>,
    /// The order of the entries, where loops and conditions stand between them; empty where there are none.
    pub nesting: Vec<EntryNode>,
}

impl<T> Section<T> {
    /// A section of entries that stand one behind the other.
    pub fn new(docs: Docs, keyword: Span, entries: Vec<T>) -> Self {
        Section { docs, keyword, entries, nesting: Vec::new() }
    }
}

/// `count name = value`.
#[derive(Debug, Clone)]
pub struct Count {
    /// Doc comments.
    pub docs: Docs,
    /// The name.
    pub name: Name,
    /// The value.
    pub value: IndexExpression,
}

/// A coordinate, or an input with or without limits: `name`, `name in lower..upper`.
#[derive(Debug, Clone)]
pub struct Plain {
    /// Doc comments.
    pub docs: Docs,
    /// The name.
    pub name: Name,
    /// The unit, if one is declared.
    pub unit: Option<Unit>,
    /// The least and the largest value, of an input that has limits.
    pub limits: Option<Box<[Expression; 2]>>,
}

/// `name`, `name > 0`, `name = e`, `name > 0 = e`.
#[derive(Debug, Clone)]
pub struct Constant {
    /// Doc comments.
    pub docs: Docs,
    /// The name.
    pub name: Name,
    /// The unit, if one is declared.
    pub unit: Option<Unit>,
    /// The bound, if one is declared.
    pub bound: Option<WrittenBound>,
    /// The least and the largest value, of a constant that has limits.
    pub limits: Option<Box<[Expression; 2]>>,
    /// The default, if one is declared.
    pub default: Option<Expression>,
}

/// The bound that is promised of a constant.
#[derive(Debug, Clone, Copy)]
pub struct WrittenBound {
    /// The kind of the bound.
    pub kind: BoundKind,
    /// Place of the comparison.
    pub span: Span,
}

/// The promises.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BoundKind {
    /// `> 0`.
    Positive,
    /// `>= 0`.
    Nonnegative,
    /// `!= 0`.
    Nonzero,
}

impl BoundKind {
    /// The bound as it is written.
    pub fn relation(self) -> &'static str {
        match self {
            Self::Positive => "> 0",
            Self::Nonnegative => ">= 0",
            Self::Nonzero => "!= 0",
        }
    }
}

/// `name = e`.
#[derive(Debug, Clone)]
pub struct Definition {
    /// Doc comments.
    pub docs: Docs,
    /// The name.
    pub name: Name,
    /// The expression that the name stands for.
    pub value: Expression,
}

/// `fn name(parameters) = e`.
#[derive(Debug, Clone)]
pub struct FunctionDefinition {
    /// Doc comments.
    pub docs: Docs,
    /// The name.
    pub name: Name,
    /// The names of its arguments.
    pub parameters: Vec<Name>,
    /// The expression that a call stands for.
    pub value: Expression,
}

/// `name(x, y)` in `functions`: a function that the program supplies.
#[derive(Debug, Clone)]
pub struct SuppliedFunction {
    /// Doc comments.
    pub docs: Docs,
    /// The name.
    pub name: Name,
    /// The names of its arguments.
    pub arguments: Vec<Name>,
}

/// `name: left = right`.
#[derive(Debug, Clone)]
pub struct Equation {
    /// Doc comments.
    pub docs: Docs,
    /// The name.
    pub name: Name,
    /// The left side.
    pub left: Expression,
    /// Place of the `=`.
    pub equals: Span,
    /// The right side.
    pub right: Expression,
}

/// `keyword = e;`.
#[derive(Debug, Clone)]
pub struct Quantity {
    /// Doc comments.
    pub docs: Docs,
    /// Place of the word in front.
    pub keyword: Span,
    /// The expression.
    pub value: Expression,
}

/// `mass at position`.
#[derive(Debug, Clone)]
pub struct Particle {
    /// Doc comments.
    pub docs: Docs,
    /// The mass.
    pub mass: Expression,
    /// Place of the `at`.
    pub at: Span,
    /// The position.
    pub position: Expression,
}

/// `name { mass: e, inertia: .., center: e, orientation: e }`.
#[derive(Debug, Clone)]
pub struct Body {
    /// Doc comments.
    pub docs: Docs,
    /// The name.
    pub name: Name,
    /// The mass; present exactly if `center` is.
    pub mass: Option<BodyField<Expression>>,
    /// The inertia about the mass centre in body axes; present exactly if `orientation` is.
    pub inertia: Option<BodyField<Inertia>>,
    /// Position of the mass centre.
    pub center: Option<BodyField<Expression>>,
    /// The rotation from body axes to the world's.
    pub orientation: Option<BodyField<Expression>>,
}

/// A field of a body.
#[derive(Debug, Clone)]
pub struct BodyField<T> {
    /// Place of the field's name.
    pub keyword: Span,
    /// The value of the section.
    pub value: T,
}

/// An inertia tensor.
#[derive(Debug, Clone)]
pub enum Inertia {
    /// Something whose fault has been reported.
    Missing,
    /// `diag(xx, yy, zz)`.
    Diagonal(Box<[Expression; 3]>),
    /// `sym(xx, yy, zz, xy, yz, zx)`, entries of the matrix.
    Symmetric(Box<[Expression; 6]>),
}

/// `dot(name) = rate` or `dot(name: unit) = rate`.
#[derive(Debug, Clone)]
pub struct State {
    /// Doc comments.
    pub docs: Docs,
    /// The name.
    pub name: Name,
    /// The unit of the state, if one is declared.
    pub unit: Option<Unit>,
    /// Place of the `=`.
    pub equals: Span,
    /// The rate.
    pub rate: Expression,
}

/// `force along direction`.
#[derive(Debug, Clone)]
pub struct Force {
    /// Doc comments.
    pub docs: Docs,
    /// The force.
    pub force: Expression,
    /// Place of the `along`.
    pub along: Span,
    /// The velocity form that it does work on.
    pub direction: Expression,
}

/// `scene Name { .. }`.
#[derive(Debug, Clone)]
pub struct Scene {
    /// Doc comments.
    pub docs: Docs,
    /// Place of the `scene`.
    pub keyword: Span,
    /// The name.
    pub name: Name,
    /// The names that the scene tracks, of all `track` statements in order.
    pub tracks: Vec<Name>,
    /// The names that the scene fixes, of all `fix` statements in order.
    pub fixes: Vec<Fix>,
    /// The quantities that the scene provides beside the state, of all `provide` statements in order.
    pub provides: Vec<Provide>,
    /// The `modes { .. }` of the scene, in order.
    pub modes: Vec<Section<ModeStatement>>,
    /// The statements as written where loops and conditions stand between them. There is none left once loops are unfolded.
    pub statements: Vec<SceneStatement>,
    /// The order of the statements; empty where there are no loops and conditions.
    pub nesting: Vec<EntryNode>,
}

/// A statement of a scene.
#[derive(Debug, Clone)]
pub enum SceneStatement {
    /// `track name, ..;`.
    Track(Vec<Name>),
    /// `fix name = e, ..;`.
    Fix(Vec<Fix>),
    /// `provide name, ..;`.
    Provide(Vec<Provide>),
    /// `modes { .. }`.
    Modes(Section<ModeStatement>),
}

impl Scene {
    /// Adds a statement behind the others.
    pub fn add(&mut self, statement: SceneStatement) {
        match statement {
            SceneStatement::Track(names) => self.tracks.extend(names),
            SceneStatement::Fix(fixes) => self.fixes.extend(fixes),
            SceneStatement::Provide(provides) => self.provides.extend(provides),
            SceneStatement::Modes(section) => self.modes.push(section),
        }
    }
}

/// `name = e` or `name` after `fix`.
#[derive(Debug, Clone)]
pub struct Fix {
    /// The constant, parameter or coordinate that is fixed.
    pub name: Name,
    /// The value of a constant; none for a parameter or coordinate that stays at its initial value.
    pub value: Option<Expression>,
}

/// `name` or `name(names)` after `provide`.
#[derive(Debug, Clone)]
pub struct Provide {
    /// The quantity.
    pub name: Name,
    /// The names in parentheses, if there are parentheses.
    pub of: Option<Vec<Name>>,
}

impl Item {
    /// Returns the word that begins the item.
    pub fn kind(&self) -> SectionKind {
        match self {
            Item::Count(_) => SectionKind::Count,
            Item::Constants(_) => SectionKind::Constants,
            Item::Functions(_) => SectionKind::Functions,
            Item::Inputs(_) => SectionKind::Inputs,
            Item::Coordinates(_) => SectionKind::Coordinates,
            Item::Let(_) => SectionKind::Let,
            Item::Function(_) => SectionKind::Function,
            Item::Parameters(_) => SectionKind::Parameters,
            Item::Constraints(_) => SectionKind::Constraints,
            Item::Holonomic(_) => SectionKind::Holonomic,
            Item::KineticEnergy(_) => SectionKind::KineticEnergy,
            Item::Particles(_) => SectionKind::Particles,
            Item::Bodies(_) => SectionKind::Bodies,
            Item::Gravity(_) => SectionKind::Gravity,
            Item::ForceFunction(_) => SectionKind::ForceFunction,
            Item::PotentialEnergy(_) => SectionKind::PotentialEnergy,
            Item::States(_) => SectionKind::States,
            Item::Forces(_) => SectionKind::Forces,
            Item::Switches(_) => SectionKind::Switches,
            Item::Contacts(_) => SectionKind::Contacts,
            Item::Resets(_) => SectionKind::Resets,
            Item::Modes(_) => SectionKind::Modes,
            Item::Outputs(_) => SectionKind::Outputs,
            Item::Component(_) => SectionKind::Component,
            Item::Use(_) | Item::Argument(_) => SectionKind::Use,
            Item::Provide(_) => SectionKind::Provide,
            Item::Scene(_) => SectionKind::Scene,
        }
    }
}
