//! Names of the functions, in the order in which they are built.

/// The rates of the state.
pub const RHS: &str = "rhs";
/// The velocities `x'` of a state.
pub const VELOCITIES: &str = "velocities";
/// The values of all forms at given velocities.
pub const FORMS: &str = "forms";
/// The energy integral.
pub const ENERGY: &str = "energy";
/// The kinetic energy.
pub const KINETIC_ENERGY: &str = "kinetic_energy";
/// The force function.
pub const FORCE_FUNCTION: &str = "force_function";
/// The momenta.
pub const MOMENTA: &str = "momenta";
/// The reactions at given accelerations.
pub const REACTIONS: &str = "reactions";
/// The rate of the energy integral at given accelerations.
pub const POWER: &str = "power";
/// The outputs.
pub const OUTPUTS: &str = "outputs";
/// The holonomic constraints, then those that follow from them.
pub const POSITIONS: &str = "positions";
/// The values of [`POSITIONS`], then the derivatives of each by the coordinates, one constraint after the other. There is no such
/// program without holonomic constraints.
pub const GRADIENTS: &str = "gradients";
/// The lower triangle of the mass matrix, where it is not diagonal.
pub const MASS: &str = "mass";
/// Centers and orientations of the bodies, then the positions of the particles.
pub const BODIES: &str = "bodies";
/// The functions that must not vanish.
pub const DOMAIN: &str = "domain";
/// The functions at whose zeros the rates change their formula.
pub const SWITCHES: &str = "switches";
/// The expressions of constants that must not vanish.
pub const PIVOTS: &str = "pivots";
/// Coordinates that a scene leaves out and that holonomic equations say of what it keeps.
pub const DETERMINED: &str = "determined";
/// The differentials of the integrable combinations of constraints, row by row.
pub const LEAF: &str = "leaf";
/// The lower triangle of the mass matrix, the bias, and the matrix of the inputs.
pub const MASS_FORM: &str = "mass_form";
/// The bias of the mass form without the declared forces; only where there are some.
pub const COASTING: &str = "coasting";
/// The reactions as a covector on the velocities; only where all are known.
pub const REACTION_COVECTOR: &str = "reaction_covector";
/// The derivatives of the rates by state and inputs, those that do not vanish.
pub const LINEARIZATION: &str = "linearization";
/// The derivatives of the outputs likewise.
pub const OUTPUT_LINEARIZATION: &str = "output_linearization";
/// The coefficients of `X_0`, then of `X_1`, and so on.
pub const OPERATORS: &str = "operators";
/// The coefficients of the brackets that do not vanish, in their order.
pub const BRACKETS: &str = "brackets";
/// The functions that are carried as states, at a state without them.
pub const CARRY: &str = "carry";
/// Functions that vanish where carried functions have the values that they stand for.
pub const INVARIANTS: &str = "invariants";
/// Carried functions, closer to their relations.
pub const RENORMALIZED: &str = "renormalized";
/// The motion without the forces of contacts and what these forces do to it: rates, gaps, rows, their rates, the lower triangle of
/// the Delassus matrix, the responses row by row, coefficients of friction and stiction, limits.
pub const FREE_MOTION: &str = "free_motion";
/// The rates without the forces of contacts.
pub const FREE_RATES: &str = "free_rates";
/// The rows of contacts.
pub const ROW_RATES: &str = "row_rates";
/// The parts of the rows without velocities; only where some differ from zero.
pub const ROW_DRIFTS: &str = "row_drifts";
/// The conditions under which contacts close, then those under which latches are released; only where some are declared.
pub const CONDITIONS: &str = "conditions";
/// The reactions of permanent constraints that load grips, each with its derivatives by the forces of all rows; only where there are some.
pub const LOADS: &str = "loads";
/// The new values of all resets; only where there are some.
pub const RESETS: &str = "resets";
/// The functions of switches, resets and branches.
pub const SIGNALS: &str = "signals";
/// The coefficients of restitution.
pub const RESTITUTIONS: &str = "restitutions";
/// The rates of a mode, by its place among those that have a program of their own.
pub fn mode_rates(place: usize) -> String {
    format!("{MODE_RATES}{place}")
}

/// The first letters of the names of [`mode_rates`].
pub const MODE_RATES: &str = "mode_rates_";
/// The outputs with the forces of contacts.
pub const CONTACT_OUTPUTS: &str = "contact_outputs";
