//! Upper bounds on what a declaration may hold, so that a runaway `macro_rules!` ends in an error at its place
//! and never in an exhausted stack or a compiler that seems to hang.

/// Deepest nesting of an expression: parentheses, calls, signs, powers and `.name` count one each. The stages
/// walk expressions recursively; a level costs the parser some eight frames, 4 to 8 kB without optimisation, so this stays below half of a thread of 2 MB.
pub const MAX_DEPTH: usize = 128;

/// The most operations of an index, parentheses and signs among them: `q[2*(i + 1)]` has three.
pub const MAX_INDEX_OPERATIONS: usize = 64;

/// The most operations of a condition on indices, those of its indices aside.
pub const MAX_CONDITION_OPERATIONS: usize = 64;

/// The most coordinates of a system. The derivation has a limit of its own for those that are coupled densely.
pub const MAX_COORDINATES: usize = 1000;

/// The most entries of any other section, and definitions by `let` and `fn`.
pub const MAX_ENTRIES: usize = 5000;

/// The most sums of products of a Taylor series: while one is computed they are on the stack.
pub const MAX_SERIES_SUMS: usize = 1_500;

/// The most switching functions of piecewise functions in the rates: steppers keep the sides of all of them.
pub const MAX_SWITCHES: usize = 64;

/// The deepest nesting of functions of the declaration that call each other: each adds the depth of its expression to the stack.
pub const MAX_CALL_DEPTH: usize = 16;

/// The most expressions inside of each other in functions that call each other, those of all of them added up: with the deepest expression
/// around the first call, these fit into half of the compiler's stack of 8 MB.
pub const MAX_CALLED_DEPTH: usize = 512;

/// The most calls of functions of the declaration, those inside of functions included: each is evaluated anew.
pub const MAX_CALLS: usize = 10_000;

/// The highest order of a derivative of a function that the program supplies: each takes twice the operations of the one before.
pub const MAX_DERIVATIVES: usize = 4;

/// The most loops and choices inside of each other.
pub const MAX_NESTED_LOOPS: usize = 16;

/// The most branches of a choice: one, and one for each `else if`.
pub const MAX_BRANCHES: usize = 64;

/// The most entries of a declaration once its loops are unfolded.
pub const MAX_UNFOLDED: usize = 1_000_000;

/// The most instances of components, those inside of components included.
pub const MAX_INSTANCES: usize = 1_000;

/// The deepest nesting of components inside of each other.
pub const MAX_COMPONENT_DEPTH: usize = 16;

/// The most scenes: each is derived anew.
pub const MAX_SCENES: usize = 64;

/// The most contacts, grips and latches: each multiplies the modes.
pub const MAX_CONTACTS: usize = 12;

/// The most modes, combinations of the states of contacts.
pub const MAX_MODES: usize = 64;

/// The most tokens of a declaration.
pub const MAX_TOKENS: usize = 200_000;

/// Numbers from 10^-400 to 10^400 are accepted, far wider than any quantity of physics in any unit.
pub const MAX_DECIMAL_ORDER: i64 = 400;

/// The most significant digits of a number, counted without leading and trailing zeros.
pub const MAX_DIGITS: usize = 500;

/// Deepest nesting of an expression together with what its names stand for, in operations after algebra. Reached
/// by long chains of `let`.
pub const MAX_TOTAL_DEPTH: u32 = 2_000;

/// Highest power that algebra may put together: `(x^64)^64` is beyond it.
pub const MAX_EXPONENT: i32 = 1_000;

/// The most different factors of a product: its derivatives grow as the square.
pub const MAX_FACTORS: usize = 100;

/// The most bits of a numerator or denominator that algebra may put together: about 10^400.
pub const MAX_NUMBER_BITS: u64 = 1_330;
