//! Thresholds of size in what is emitted, and the costs of checks by which a guard decides how often it checks, to be tuned in one
//! place: `docs/design/expansion-time.md` and `docs/design/guards.md` have the figures.

/// The number of statements from which on a program is cut into blocks or closures of as many. Every `let` opens a scope inside
/// the one before, and five thousand in a row overflow the compiler's stack.
pub(super) const BLOCK_STATEMENTS: usize = 100;

/// The number of results above which a sparse array is one value and the others: a row of 200 springs is emitted in 0.67 MB in place
/// of 1.3.
pub(super) const SPARSE_RESULTS: usize = 1_000;

/// The number of steps that may stand between two evaluations of a sine that are brought together: an angle is a sum of a few terms.
pub(super) const ANGLE_STEPS: usize = 6;

/// The most characters of an expression that is written in place. A longer one gets a statement of its own, so that
/// expressions nest a few levels deep.
pub(super) const LONGEST_IN_PLACE: usize = 48;

/// The number of entries from which on code goes through an array, rather than to name its entries one by one: a chain of 1,000
/// links is emitted in 107 kB in place of 1.5 MB.
pub(super) const LONG_ARRAY: usize = 25;

/// The least number of directions of duals in which a long function is evaluated. With fewer, up to 8, the runtime inlines their operations,
/// which takes rustc minutes of a long function.
pub(super) const CALLED_DIRECTIONS: usize = 9;

/// The number of places of a pattern that cost rustc as much as an index: arrays that patterns take apart saved 35 of the 377 million
/// instructions of the hoop's expansion.
pub(super) const ELEMENTS_PER_INDEX: usize = 2;

/// The cost of a sum over stages, for each entry of the state.
pub(super) const STAGE_COST: u64 = 4;

/// The cost of the calls, comparisons and copies of a check, whatever the system: counted for a particle without forces, whose estimates
/// of errors by RK8 have more operations than all of its right-hand sides.
pub(super) const CHECK_OVERHEAD: u64 = 240;

/// The costs beside a check of singularities alone: counted for Appell's system in lanes, which is the most expensive beside its
/// right-hand side.
pub(super) const SINGULARITY_CHECK_OVERHEAD: u64 = 120;

/// The costs, times those of an operation, of an operation whose rounding is counted and of a function.
pub(super) const COUNTED_ROUNDING: [u64; 2] = [4, 2];

/// The cost of the comparisons of a function that must not vanish, or of one that is carried.
pub(super) const COMPARISON_COST: u64 = 20;

/// The cost of checking a second system beside its operations, counted for the hoop.
pub(super) const SECOND_SYSTEM_COST: u64 = 150;

/// The part of [`SECOND_SYSTEM_COST`] that a check of singularities alone has.
pub(super) const SECOND_SYSTEM_SINGULARITIES: u64 = 40;
