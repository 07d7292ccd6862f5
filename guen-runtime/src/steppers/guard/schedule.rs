//! The schedule of a guard: checks are as far apart as their cost asks for, so that they take less than three
//! hundredths of a run.

use crate::system::check_costs::CheckCosts;

/// The number of right-hand sides until the sizes of entries are known.
const EVALUATIONS_UNTIL_SIZES: u32 = 160;
/// The number of right-hand sides of fixed steps from one check to the next, at least: beside rates that are cheap, what is done for
/// the sake of a check costs as much as one of them.
const EVALUATIONS_BETWEEN_CHECKS: f64 = 224.0;
/// The costs of a check from one to the next, at least: at 2.5 percent, the rest up to three is for what a step does for the guard.
const COSTS_BETWEEN_CHECKS: f64 = 40.0;
/// Checks of the singularities alone may take a fiftieth,
const COSTS_BETWEEN_SINGULARITIES: f64 = 50.0;
/// and a hundred-and-sixtieth where steps are not fixed, as much as further checks on the way to a singularity take there,
const COSTS_BETWEEN_FREE_SINGULARITIES: f64 = 160.0;
/// and both together so little.
const COSTS_TOGETHER: f64 = 34.0;
/// The further work of a check of a fixed step, in right-hand sides: an estimate of its error, which takes three and
/// sums over the state. At least so many, and at most, beside right-hand sides that are cheap for a state so long.
const COST_OF_A_DEFECT: [f64; 2] = [4.0, 10.0];

/// The steps between checks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::steppers) struct Schedule {
    /// Steps after which the sizes of entries are known.
    pub young: u32,
    /// The steps from one check of the singularities alone to the next, at most; never where somebody has chosen how often to
    /// check.
    pub singularities: u32,
    /// The steps from one check of everything to the next.
    pub every: u32,
}

impl Schedule {
    /// Creates the schedule of a method that evaluates so often in a step, `fixed` if of a fixed length, and a system
    /// with these costs of checks. `chosen` is the number of steps between two checks that somebody has set.
    pub(super) fn new(
        evaluations: u32,
        CheckCosts { all, singularities }: CheckCosts,
        fixed: bool,
        chosen: Option<u32>,
    ) -> Self {
        let evaluations = evaluations.max(1);
        let in_steps = |right_hand_sides: f64| (right_hand_sides / f64::from(evaluations)) as u32;
        let young = (EVALUATIONS_UNTIL_SIZES / evaluations).max(1);
        if let Some(chosen) = chosen {
            return Self { young, singularities: u32::MAX, every: chosen.max(1) };
        }
        if !fixed {
            // Steps as long as the tolerance allows may lead through a singularity and back in a few: each is checked, if that is
            // cheap enough.
            let between = if singularities > 0.0 {
                in_steps(COSTS_BETWEEN_FREE_SINGULARITIES * singularities).max(1)
            } else {
                young
            };
            let every = young.max(in_steps(COSTS_BETWEEN_CHECKS * f64::from(all)));
            return Self { young, singularities: between, every };
        }
        // Before the step and after it; NaN is no price.
        let both = (2.0 * singularities).max(0.0);
        let between =
            in_steps(f64::max(EVALUATIONS_BETWEEN_CHECKS, COSTS_BETWEEN_SINGULARITIES * both)).max(1);
        let spent = both / (f64::from(between) * f64::from(evaluations));
        // What singularities leave; of an infinite price a fiftieth is spent.
        let left =
            (1.0 / COSTS_TOGETHER - spent).max(1.0 / COSTS_TOGETHER - 1.0 / COSTS_BETWEEN_SINGULARITIES);
        let [least, most] = COST_OF_A_DEFECT.map(|estimate| f64::from(all) + estimate);
        let every = f64::max(COSTS_BETWEEN_CHECKS * most, least / left);
        let every = between.max(in_steps(every));
        // A check of everything includes the singularities.
        let every =
            if both > 0.0 { every.checked_next_multiple_of(between).unwrap_or(u32::MAX) } else { every };
        Self { young, singularities: between, every }
    }

    /// Returns the number of steps until the next check of the singularities, so many steps after everything was checked, if
    /// that should be within `soonest` steps: a multiple of `apart`, or of its half, or of the half of that, counted
    /// from that check. So runs in lanes check after the same steps, wherever each of them is.
    #[inline]
    pub(super) fn next(apart: u32, soonest: u32, since: u32) -> u32 {
        let mut apart = apart.min(1 << 31);
        while apart > soonest {
            apart /= 2;
        }
        let apart = apart.max(1);
        apart - since % apart
    }
}

#[cfg(test)]
mod tests {
    use super::{CheckCosts, Schedule};

    fn costs(all: u32, singularities: f64) -> CheckCosts {
        CheckCosts { all, singularities }
    }

    #[test]
    fn checks_take_less_than_three_hundredths_of_a_run() {
        for evaluations in [1, 4, 12, 40] {
            for check in [1, 5, 20, 300] {
                for singularities in [0.0, 0.1, 1.0, 2.5, 40.0] {
                    let of = f64::from(evaluations);
                    let Schedule { singularities: between, every, .. } =
                        Schedule::new(evaluations, costs(check, singularities), true, None);
                    let (between, every) = (f64::from(between) * of, f64::from(every) * of);
                    // Rounded down to whole steps, in the worst case a part of thirteen.
                    let most = 1.08 / 34.0;
                    let price = f64::from(check) + 4.0;
                    assert!(price / every + 2.0 * singularities / between < most, "{every} {between}");
                    assert!(
                        (price + 6.0) / every < 1.08 / 40.0 && 2.0 * singularities / between < 1.08 / 50.0
                    );
                    // Both meet.
                    assert!(singularities == 0.0 || every % between == 0.0, "{every} {between}");
                    // Nothing is checked more rarely than it has to be.
                    let least = f64::from((224 / evaluations).max(1)) * of;
                    assert!(between == least || 2.0 * singularities / between > 1.0 / 51.0);
                    let meeting = if singularities > 0.0 { between } else { 0.0 };
                    let alone = every - meeting;
                    assert!(
                        (price + 6.0) / alone > 0.9 / 40.0
                            || price / alone + 2.0 * singularities / between > 0.9 / 34.0
                            || alone <= least
                    );
                    let free = Schedule::new(evaluations, costs(check, singularities), false, None);
                    assert!(f64::from(free.every) * of <= every);
                    assert!(
                        free.singularities == 1
                            || singularities / (f64::from(free.singularities) * of) < 1.4 / 160.0
                            || singularities == 0.0
                    );
                }
            }
        }
    }

    #[test]
    fn singularities_are_checked_in_time_and_together() {
        for singularities in [1, 13, 40, 200, u32::MAX] {
            for soonest in [1, 2, 3, 7, 20, 39, 40, 1000, u32::MAX] {
                for since in [0, 1, 5, 20, 39, 40, 123] {
                    let next = Schedule::next(singularities, soonest, since);
                    assert!(
                        (1..=soonest.min(singularities)).contains(&next),
                        "{singularities} {soonest} {since}: {next}"
                    );
                    // Wherever a run is, it comes to the same steps.
                    let apart = Schedule::next(singularities, soonest, 0);
                    assert!(
                        (since + next).is_multiple_of(apart),
                        "{singularities} {soonest} {since}: {next}"
                    );
                }
            }
        }
        // One that is near to a singularity, one that is nearer and one that is far check at multiples of 10, 20 and 40 steps.
        for (soonest, apart) in [(19, 10), (20, 20), (55, 40)] {
            let mut since = 0;
            while since < 120 {
                since += Schedule::next(40, soonest, since);
                assert_eq!(since % apart, 0);
            }
        }
    }

    #[test]
    fn what_is_chosen_is_done_and_no_price_breaks_it() {
        let chosen = Schedule::new(4, costs(7, 2.0), true, Some(0));
        assert_eq!(chosen, Schedule { young: 40, singularities: u32::MAX, every: 1 });
        // RK4 with a check of two right-hand sides: every 40 times twelve of them, singularities every 224.
        let usual = Schedule::new(4, costs(2, 0.0), true, None);
        assert_eq!(usual, Schedule { young: 40, singularities: 56, every: 120 });
        for price in [f64::NAN, -1.0] {
            assert_eq!(Schedule::new(4, costs(2, price), true, None), usual);
        }
        let dear = Schedule::new(0, costs(u32::MAX, f64::INFINITY), true, None);
        assert_eq!((dear.singularities, dear.every), (u32::MAX, u32::MAX));
    }
}
