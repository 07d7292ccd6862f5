//! The places of a declaration, each with the kinds of symbol that it allows.

use guen_symbolic::{Role, Roles};

/// A place for an expression.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum ExpressionPlace {
    /// The default of a constant.
    Default,
    /// A limit of an input.
    Limit,
    /// The value of a constant that a scene fixes.
    Fixed,
    /// The right side of a `let`.
    Let,
    /// A parameter.
    Parameter,
    /// A constraint.
    Constraint,
    /// A holonomic constraint.
    Holonomic,
    /// The kinetic energy.
    KineticEnergy,
    /// The force function or the potential energy.
    ForceFunction,
    /// The gravity vector.
    Gravity,
    /// The mass of a particle or body, or an entry of an inertia.
    Mass,
    /// A position or an orientation.
    Position,
    /// The rate of a state.
    StateRate,
    /// A generalised force.
    Force,
    /// The velocity form behind `along`.
    Direction,
    /// An output.
    Output,
    /// The function of a switch.
    Switch,
    /// The function at whose zero a reset happens.
    ResetFunction,
    /// A new value of a reset.
    ResetValue,
    /// The gap of a contact.
    Gap,
    /// The function of a latch.
    Latch,
    /// The velocity along a contact.
    Slip,
    /// The velocity of a grip.
    Grip,
    /// A coefficient of friction.
    Friction,
    /// A coefficient that limits sticking.
    Stiction,
    /// A coefficient of restitution.
    Restitution,
    /// The condition of a contact.
    Condition,
    /// The limit of a grip.
    GripForce,
    /// The load of a grip.
    GripLoad,
}

impl ExpressionPlace {
    /// The place in a sentence, by the name of the entry where it has one.
    pub(super) fn description(self, entry: Option<&str>) -> String {
        let (named, nameless) = match self {
            ExpressionPlace::Default => ("the default of", "the default of a constant"),
            ExpressionPlace::Limit => ("a limit of", "a limit of an input"),
            ExpressionPlace::Fixed => ("the value of", "the value of a constant"),
            ExpressionPlace::Let => ("", "a `let`"),
            ExpressionPlace::Parameter => ("parameter", "a parameter"),
            ExpressionPlace::Constraint => ("constraint", "a constraint"),
            ExpressionPlace::Holonomic => ("holonomic constraint", "a holonomic constraint"),
            ExpressionPlace::KineticEnergy => return "the kinetic energy".to_owned(),
            ExpressionPlace::ForceFunction => return "the force function".to_owned(),
            ExpressionPlace::Gravity => return "`gravity`".to_owned(),
            ExpressionPlace::Mass => return "a mass or an inertia".to_owned(),
            ExpressionPlace::Position => return "a position or an orientation".to_owned(),
            ExpressionPlace::StateRate => ("the rate of state", "the rate of a state"),
            ExpressionPlace::Force => return "a force".to_owned(),
            ExpressionPlace::Direction => return "the velocity after `along`".to_owned(),
            ExpressionPlace::Output => ("output", "an output"),
            ExpressionPlace::Switch => ("the switch", "a switch"),
            ExpressionPlace::ResetFunction => ("the function of reset", "the function of a reset"),
            ExpressionPlace::ResetValue => ("a value of reset", "a value of a reset"),
            ExpressionPlace::Gap => ("the gap of", "a gap"),
            ExpressionPlace::Latch => ("the latch", "a latch"),
            ExpressionPlace::Slip => ("the slip of", "a slip"),
            ExpressionPlace::Grip => ("the grip", "a grip"),
            ExpressionPlace::Friction => ("the friction of", "a coefficient of friction"),
            ExpressionPlace::Stiction => ("the stiction of", "a coefficient of stiction"),
            ExpressionPlace::Restitution => ("the restitution of", "a coefficient of restitution"),
            ExpressionPlace::Condition => ("the condition of", "the condition of a contact"),
            ExpressionPlace::GripForce => ("the limit of", "the limit of a grip"),
            ExpressionPlace::GripLoad => ("the load of", "the load of a grip"),
        };
        match entry {
            None => nameless.to_owned(),
            Some(name) if named.is_empty() => format!("`{name}`"),
            Some(name) => format!("{named} `{name}`"),
        }
    }

    /// The rule of the place, for a note.
    pub(super) fn rule(self) -> Option<&'static str> {
        Some(match self {
            ExpressionPlace::Default => "a default is a number, or made of constants declared before it",
            ExpressionPlace::Limit => "the limits of inputs are made of numbers and constants",
            ExpressionPlace::Fixed => "a constant is fixed to a number, or to an expression of constants",
            ExpressionPlace::Gravity => "gravity is one vector for the whole system, of constants and `t`",
            ExpressionPlace::Mass => "a mass depends on time and coordinates at most",
            ExpressionPlace::Position => "positions and orientations depend on time and coordinates",
            ExpressionPlace::Gap | ExpressionPlace::Latch => "it depends on constants, time and coordinates",
            ExpressionPlace::Friction => {
                "it depends on constants, time, coordinates, switches, and on `speed`, the magnitude of the slip"
            }
            ExpressionPlace::Stiction => "it depends on constants, time, coordinates and switches",
            ExpressionPlace::Restitution => "it depends on constants alone",
            ExpressionPlace::Switch | ExpressionPlace::ResetFunction => {
                "its zero is located between two changes of the inputs, so that it depends on everything but these"
            }
            _ => return None,
        })
    }

    /// The kinds of symbol that may occur.
    pub(super) fn allowed(self) -> Roles {
        let constants = Roles::of(Role::Constant);
        let timed = constants.or(Roles::of(Role::Time));
        let positions = timed.or(Roles::of(Role::Coordinate));
        let velocities = positions.or(Roles::of(Role::Velocity)).or(Roles::of(Role::QuasiVelocity));
        let all = velocities.or(Roles::of(Role::Input)).or(Roles::of(Role::State));
        match self {
            ExpressionPlace::Default
            | ExpressionPlace::Limit
            | ExpressionPlace::Fixed
            | ExpressionPlace::Restitution => constants,
            ExpressionPlace::Gravity => timed,
            ExpressionPlace::Holonomic
            | ExpressionPlace::ForceFunction
            | ExpressionPlace::Mass
            | ExpressionPlace::Position
            | ExpressionPlace::Gap
            | ExpressionPlace::Latch => positions,
            ExpressionPlace::Friction | ExpressionPlace::Stiction => positions.or(Roles::of(Role::Input)),
            ExpressionPlace::Parameter
            | ExpressionPlace::Constraint
            | ExpressionPlace::KineticEnergy
            | ExpressionPlace::Direction
            | ExpressionPlace::Slip
            | ExpressionPlace::Grip => velocities,
            ExpressionPlace::Switch | ExpressionPlace::ResetFunction => velocities.or(Roles::of(Role::State)),
            ExpressionPlace::Let
            | ExpressionPlace::Force
            | ExpressionPlace::Condition
            | ExpressionPlace::GripForce
            | ExpressionPlace::GripLoad
            | ExpressionPlace::ResetValue => all,
            ExpressionPlace::StateRate | ExpressionPlace::Output => {
                all.or(Roles::of(Role::QuasiAcceleration))
            }
        }
    }
}

impl ExpressionPlace {
    /// The rule of a place where no function that the program supplies may stand: its value is computed where functions are not known.
    pub(super) fn without_functions(self) -> Option<&'static str> {
        Some(match self {
            ExpressionPlace::Default => "a default is a number, or made of constants declared before it",
            ExpressionPlace::Limit => "the limits of inputs are made of numbers and constants",
            ExpressionPlace::Fixed => "a constant is fixed to a number, or to an expression of constants",
            ExpressionPlace::Restitution => "a coefficient of restitution is made of numbers and constants",
            _ => return None,
        })
    }

    /// Whether it is a part of a contact.
    pub(super) fn is_of_contact(self) -> bool {
        matches!(
            self,
            ExpressionPlace::Gap
                | ExpressionPlace::Latch
                | ExpressionPlace::Slip
                | ExpressionPlace::Grip
                | ExpressionPlace::Friction
                | ExpressionPlace::Stiction
                | ExpressionPlace::Restitution
                | ExpressionPlace::Condition
                | ExpressionPlace::GripForce
                | ExpressionPlace::GripLoad
        )
    }
}

/// Returns the words for a kind of symbol.
pub(super) fn role_name(role: Role) -> &'static str {
    match role {
        Role::Time => "the time",
        Role::Constant => "a physical constant",
        Role::Coordinate => "a coordinate",
        Role::Velocity => "a velocity",
        Role::QuasiVelocity => "a quasi-velocity",
        Role::QuasiAcceleration => "an acceleration",
        Role::State => "a state",
        Role::Input => "an input",
    }
}

/// Every kind of symbol, in the order in which a message names the first that is not allowed.
pub(super) const ROLES: [Role; 8] = [
    Role::QuasiAcceleration,
    Role::State,
    Role::Input,
    Role::Velocity,
    Role::QuasiVelocity,
    Role::Coordinate,
    Role::Time,
    Role::Constant,
];
