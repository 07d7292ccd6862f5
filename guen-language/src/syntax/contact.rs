//! Contacts, grips, latches, switches and modes as written.

use proc_macro2::Span;

use super::{Declaration, Docs, Equation, Expression, Item, Name, Path};
use crate::names::{MODES, is_generated_type_or_constant, is_rust_keyword, type_name};

/// `name: word = e, word = e, ..;` of `contacts`.
#[derive(Debug, Clone)]
pub struct Contact {
    /// Doc comments.
    pub docs: Docs,
    /// The name.
    pub name: Name,
    /// The clauses, in the order in which they were written, each word at most once.
    pub clauses: Vec<Clause>,
}

/// `word = e` of a contact.
#[derive(Debug, Clone)]
pub struct Clause {
    /// The word.
    pub word: ClauseWord,
    /// Place of the word.
    pub keyword: Span,
    /// The value.
    pub value: Expression,
}

/// The name of the magnitude of the slip, in `friction` alone.
pub const SPEED: &str = "speed";

/// The words of a contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ClauseWord {
    /// The distance that stays nonnegative.
    Gap,
    /// The velocity that vanishes until its force is too large.
    Grip,
    /// The function that locks at zero.
    Latch,
    /// The velocity along the contact.
    Slip,
    /// The coefficient of friction.
    Friction,
    /// The coefficient that limits sticking.
    Stiction,
    /// The coefficient of restitution.
    Restitution,
    /// The largest force of a grip.
    Limit,
    /// The normal force of a grip.
    Load,
    /// The condition under which an open contact closes.
    When,
    /// The function whose rise unlocks a latch.
    Release,
}

impl ClauseWord {
    /// Every word, the kinds of contacts first.
    pub const ALL: [ClauseWord; 11] = [
        ClauseWord::Gap,
        ClauseWord::Grip,
        ClauseWord::Latch,
        ClauseWord::Slip,
        ClauseWord::Friction,
        ClauseWord::Stiction,
        ClauseWord::Restitution,
        ClauseWord::Limit,
        ClauseWord::Load,
        ClauseWord::When,
        ClauseWord::Release,
    ];

    /// The word in the language.
    pub fn text(self) -> &'static str {
        match self {
            ClauseWord::Gap => "gap",
            ClauseWord::Grip => "grip",
            ClauseWord::Latch => "latch",
            ClauseWord::Slip => "slip",
            ClauseWord::Friction => "friction",
            ClauseWord::Stiction => "stiction",
            ClauseWord::Restitution => "restitution",
            ClauseWord::Limit => "limit",
            ClauseWord::Load => "load",
            ClauseWord::When => "when",
            ClauseWord::Release => "release",
        }
    }

    /// The names that mean something else in the clause than around it.
    pub fn own_names(self) -> &'static [&'static str] {
        match self {
            ClauseWord::Friction => &[SPEED],
            _ => &[],
        }
    }

    /// Whether the word says what kind of contact it is.
    pub fn is_kind(self) -> bool {
        matches!(self, ClauseWord::Gap | ClauseWord::Grip | ClauseWord::Latch)
    }
}

impl Contact {
    /// The clause of a word, if it is there.
    pub fn clause(&self, word: ClauseWord) -> Option<&Clause> {
        self.clauses.iter().find(|clause| clause.word == word)
    }
}

/// The type of the states of a contact, in the module of its instance: of `left.front_foot[0]` it is `FrontFoot` in `left`.
pub fn type_of_states(contact: &Name) -> StatesType {
    let plain = || vec![contact.root().to_string().trim_start_matches("r#").to_owned()];
    let mut path = contact.path().map_or_else(plain, Path::names);
    let last = path.pop().unwrap_or_default();
    StatesType { module: path, name: type_name(&last), contact: last }
}

/// A type of states: the entries of an array have one, and so have instances that are entries of an array.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct StatesType {
    /// The module of the instance, seen from that of the system.
    pub module: Vec<String>,
    /// The name.
    pub name: String,
    /// The name of the contact in its module.
    pub contact: String,
}

/// `name: e;` of `switches`.
#[derive(Debug, Clone)]
pub struct Switch {
    /// Doc comments.
    pub docs: Docs,
    /// The name.
    pub name: Name,
    /// The function: the switch is 1 where it is positive, 0 elsewhere.
    pub value: Expression,
}

/// `name: e rises, variable = e, ..;` of `resets`.
#[derive(Debug, Clone)]
pub struct Reset {
    /// Doc comments.
    pub docs: Docs,
    /// The name.
    pub name: Name,
    /// The function at whose zero the reset happens.
    pub function: Expression,
    /// The direction in which the function goes through zero.
    pub crossing: Crossing,
    /// The new values.
    pub assignments: Vec<ResetAssignment>,
}

/// The direction in which a function goes through zero.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Crossing {
    /// From below.
    Rises,
    /// From above.
    Falls,
}

impl Crossing {
    /// The word of the language.
    pub fn word(self) -> &'static str {
        match self {
            Crossing::Rises => "rises",
            Crossing::Falls => "falls",
        }
    }
}

/// `variable = e` of a reset.
#[derive(Debug, Clone)]
pub struct ResetAssignment {
    /// The variable, a name.
    pub variable: Expression,
    /// Place of the `=`.
    pub equals: Span,
    /// The value behind the reset.
    pub value: Expression,
}

/// A statement of `modes`.
#[derive(Debug, Clone)]
pub enum ModeStatement {
    /// `contact: state, state;`: the states that the contact has.
    States {
        /// The contact.
        contact: Name,
        /// The states of the contact.
        states: Vec<Name>,
    },
    /// `never contact.state with contact.state ..;`: a combination that does not occur.
    Never {
        /// Place of the word `never`.
        keyword: Span,
        /// The contacts, each with its state.
        combination: Vec<(Name, Name)>,
    },
}

/// The mode of a declaration that is another one in a single mode.
#[derive(Debug, Clone, Default)]
pub struct SingleMode {
    /// Contact by contact, the equations that hold in the mode.
    pub contacts: Vec<HeldContact>,
    /// The parameters of the other declaration that are none here: they follow from those that are left.
    pub followers: Vec<Name>,
    /// The parameters among them that the scene tracks.
    pub tracked: Vec<String>,
    /// The variables that resets of the other declaration change.
    pub reset: Vec<String>,
    /// The mode in words.
    pub words: String,
}

/// The direction of a slip that goes on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SlipDirection {
    /// Along its line, where the velocity is positive.
    Positive,
    /// Along its line, where the velocity is negative.
    Negative,
    /// In its plane, along the velocity.
    Velocity,
}

/// A contact that stays in one state.
#[derive(Debug, Clone, Default)]
pub struct HeldContact {
    /// The equation of its gap, where that stays zero.
    pub gap: Option<Equation>,
    /// Whether that equation is one of the gap's rate.
    pub gap_by_rate: bool,
    /// The equations of its slip, where that stays zero.
    pub slip: Vec<Equation>,
    /// The direction in which it slips, where it does.
    pub slides: Option<SlipDirection>,
    /// Whether each row is a constraint of the mode.
    pub rows: Vec<bool>,
    /// Whether its reactions are not determined, because its rows depend on others.
    pub is_undetermined: bool,
}

impl HeldContact {
    /// Whether a constraint is one of its rows.
    pub fn has(&self, form: &str) -> bool {
        let equations = self.gap.iter().chain(&self.slip);
        let mut names = equations.map(|equation| &equation.name);
        names.any(|name| {
            name.text == form || ["_x", "_y", "_z"].iter().any(|axis| name.suffixed(axis).text == form)
        })
    }
}

impl Declaration {
    /// Tells why the states of a contact cannot be this type, if they cannot.
    pub fn takes_type(&self, states: &StatesType) -> Option<String> {
        let name = states.name.as_str();
        let mut path = states.module.clone();
        path.push(states.name.clone());
        let is_instance = self.instances.iter().any(|instance| instance.path.names() == path);
        if !states.module.is_empty() {
            let of = states.module.join(".");
            let is_taken =
                name == MODES || is_generated_type_or_constant(name) || is_rust_keyword(name) || is_instance;
            return is_taken.then(|| format!("the module of `{of}` has an item of this name"));
        }
        let mut scenes = self.items.iter().filter_map(|item| match item {
            Item::Scene(scene) => Some(&scene.name.text),
            _ => None,
        });
        if name == MODES || is_generated_type_or_constant(name) || is_rust_keyword(name) {
            Some(format!("the module of `{}` has an item of this name", self.name))
        } else if name == self.name.text {
            Some("this is the name of the system".to_owned())
        } else if scenes.any(|scene| scene == name) {
            Some("this is the name of a scene".to_owned())
        } else if self.components.iter().any(|(component, _)| component.name.text == name) {
            Some("this is the name of a component".to_owned())
        } else if is_instance {
            Some("this is the name of an instance".to_owned())
        } else {
            None
        }
    }
}
