//! Thresholds of cost and of size while programs are made shorter, to be tuned in one place. Each bounds the time of a
//! pass; `docs/design/programs.md` and `docs/design/expansion-time.md` have the figures.

/// The number of names above which only the first candidates are tried.
pub(in crate::program) const NAMES_WITH_CANDIDATES: usize = 150;

/// The number of nodes below which cold functions are lowered as they are.
pub(in crate::program) const COLD_NODES: usize = 60;

/// The estimate beyond which a function is optimised only with names for what is kept whole.
pub(in crate::program) const OPTIMISED_WITHOUT_NAMES: u64 = 400;

/// The cost up to which all effort goes into several formulations that are nearly as cheap: [`FINALISTS`].
pub(in crate::program) const FINALIST_COST: u64 = 300;

/// The number of these formulations.
pub(in crate::program) const FINALISTS: usize = 3;

/// The number of terms that occur elsewhere above which a sum takes no part in a search for common parts: pairs grow with the square.
pub(in crate::program) const SUM_TERMS: usize = 40;

/// The number of pairs of sums that is looked at.
pub(in crate::program) const SUM_PAIRS: usize = 6_000;

/// The number of sums that only subtract beyond which they stay as they are.
pub(in crate::program) const SUBTRACTING_SUMS: usize = 1_000;

/// The number of users above which a factor keeps its sign.
pub(in crate::program) const USERS_OF_A_SIGN: usize = 64;

/// The number of monomials above which they stay as they are.
pub(in crate::program) const MONOMIALS: usize = 20_000;

/// The number of different factors above which monomials do not take part: pairs grow with the square.
pub(in crate::program) const MONOMIAL_FACTORS: usize = 24;

/// The terms that a sum used by two products may have: a rotation does.
pub(in crate::program) const SHARED_TERMS: usize = 2;

/// The terms that a sum used by one product may have.
pub(in crate::program) const SINGLE_TERMS: usize = 12;

/// The number of terms beyond which no sum grows by expansion.
pub(in crate::program) const EXPANDED_TERMS: usize = 100;

/// The depth of sums in sums below which they stay.
pub(in crate::program) const EXPANDED_DEPTH: usize = 3;

/// The number of terms above which sums are not searched for common factors.
pub(in crate::program) const FACTORED_TERMS: usize = 400;

/// Functions with more instructions are not differentiated: see [`Programs::add_jacobian`](crate::program::Programs::add_jacobian).
pub const LARGEST_DIFFERENTIATED: usize = 2_000;

/// Jacobians with more operations are not kept: the user's compiler reads every one of them.
pub const LARGEST_JACOBIAN: u32 = 6_000;

/// The number of instructions below which every order of elimination is tried.
pub(in crate::program) const ORDERED_INSTRUCTIONS: usize = 250;

/// The number of times that a program is optimised as a whole, one after the other.
pub(in crate::program) const MOST_JOINED: usize = 3;

/// The number of instructions above which values are not compared with products of others: there is one for each pair.
pub(in crate::program) const REUSE_INSTRUCTIONS: usize = 600;

/// The number of times that values are compared with products of others.
pub(in crate::program) const REUSE_ROUNDS: usize = 12;

/// The cost of code that is written regularly up to which it is taken, in percent of that of optimised code: in a loop it is short.
pub(in crate::program) const HARDLY_MORE: u64 = 104;
