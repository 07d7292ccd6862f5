//! Thresholds of cost and of size while programs are derived, to be tuned in one place. Estimates and costs are in units of a
//! multiplication. Where a commit decided a value its figure stands beside it; the others are where the golden costs
//! (`tests/costs.txt`) and the steps of expansions are best together.

use guen_symbolic::MAX_WORK;

/// The estimate of the rates beyond which they are not written out as normal forms: these run into their limits there, and only
/// cost time.
pub(super) const WRITTEN_OUT_RATES: u64 = 600;

/// The estimate of one form of the rates, as a fraction of the least, beyond which it is not made a program: a form may come out cheaper
/// although it looks more expensive, but hardly by more than half.
pub(super) const PROMISING_FORM: (u64, u64) = (3, 2);

/// The estimate beyond which reactions get no program of their own: they are a part of the program of the covector.
pub(super) const SHARED_REACTIONS: u64 = 1000;

/// The cost of a carried variable for a stepper in each of its stages: half of the coefficients of a stage, for methods of
/// order 8.
pub(super) const CARRIED_VARIABLE_COST: u64 = 6;

/// The number of modes of a scene above which all of them share one program. Rates of their own take 44 operations for a leg on its foot, in
/// place of 162 and a solve; each is one more derivation, and one more program.
pub(super) const ELIMINATED_MODES: usize = 4;

/// The work of a derivation above which there is no second one, with the bounds that are missing. It tells of operations where it is made: a
/// road train without a bound takes 1,054 in place of 325. Of 146 declarations with bounds eight lose operations without them.
pub(super) const REPEATED_DERIVATION: u64 = MAX_WORK / 4;
