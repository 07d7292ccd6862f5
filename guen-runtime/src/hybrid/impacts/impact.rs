//! Impacts by Poisson's law: compression and expansion, each one complementarity problem over the Delassus matrix.

use super::phase::{Participant, Phase, Solved, Tangential, Unsolved};
use crate::hybrid::filled::filled;
use crate::hybrid::interface::element::{Element, Kind};
use crate::numbers::lift::Lift;

/// The impact of some elements at one state.
#[derive(Clone, Copy, Debug)]
pub(in crate::hybrid) struct Impact<'a, R, const W: usize, const C: usize> {
    pub(in crate::hybrid) elements: &'a [Element; C],
    pub(in crate::hybrid) delassus: &'a [[R; W]; W],
    /// The rates of all rows before it.
    pub(in crate::hybrid) before: [R; W],
    /// The elements that take part: contacts that touch, latches that lock or are locked, grips.
    pub(in crate::hybrid) takes_part: [bool; C],
    pub(in crate::hybrid) friction: [R; C],
    /// The changes of the impulses of permanent constraints that load grips, by unit impulses along the rows.
    pub(in crate::hybrid) loads: &'a [[R; W]; C],
    pub(in crate::hybrid) restitutions: [f64; C],
}

/// The result of an impact.
#[derive(Clone, Copy, Debug)]
pub(in crate::hybrid) struct Struck<const W: usize, const C: usize> {
    /// The impulses along all rows.
    pub(in crate::hybrid) impulses: [f64; W],
    /// The rates of all rows after it.
    pub(in crate::hybrid) after: [f64; W],
    /// Whether the normal rate vanishes after it, and the slip.
    pub(in crate::hybrid) closed: [bool; C],
    pub(in crate::hybrid) sticks: [bool; C],
    /// The change of the kinetic energy, as seen from what moves by itself: half the sum of impulses times rates before and after.
    pub(in crate::hybrid) energy: f64,
}

/// The part of the largest rate before an impact below which a rate after it vanishes.
pub(in crate::hybrid) const STILL: f64 = 1e-11;
/// The gain of energy, relative to what the impulses do, that is rounding.
const GAIN: f64 = 1e-9;

impl<R: Lift<f64>, const W: usize, const C: usize> Impact<'_, R, W, C> {
    /// The largest rate before it.
    fn scale(&self) -> f64 {
        self.before.iter().fold(0.0, |most, rate| most.max(rate.to_f64().abs()))
    }

    /// The phase in which what closes is stopped.
    pub(in crate::hybrid) fn compression(&self) -> Phase<'_, R, W, C> {
        let participants: [Participant<R>; C] = filled(|c| match self.elements[c].kind {
            _ if !self.takes_part[c] => Participant::Absent,
            Kind::Latch => Participant::Locked,
            Kind::Grip => Participant::Grip,
            Kind::Smooth | Kind::Rough => Participant::Contact { floor: R::zero() },
        });
        Phase {
            elements: self.elements,
            delassus: self.delassus,
            before: self.before,
            scale: self.scale(),
            participants,
            friction: self.friction,
            loads: self.loads,
        }
    }

    /// The phase in which contacts give back a part of what stopped them.
    pub(in crate::hybrid) fn expansion(&self, compression: &Solved<R, W, C>) -> Phase<'_, R, W, C> {
        let mut phase = self.compression();
        phase.before = compression.after;
        for (c, participant) in phase.participants.iter_mut().enumerate() {
            if let (Participant::Contact { floor }, Some(row)) = (participant, self.elements[c].normal)
                && compression.impulses[row].to_f64() > 0.0
            {
                *floor = R::lift(self.restitutions[c]) * compression.impulses[row];
            }
        }
        phase
    }

    /// The contacts that close where all do that take part.
    pub(super) fn all_closed(&self) -> [bool; C] {
        filled(|c| self.takes_part[c] && self.elements[c].normal.is_some())
    }
}

impl<const W: usize, const C: usize> Impact<'_, f64, W, C> {
    /// The impulses of compression and expansion.
    pub(in crate::hybrid) fn solve(&self) -> Result<Struck<W, C>, Unsolved> {
        let compression = self.compression().solve()?;
        let expansion = self.expansion(&compression).solve()?;
        let impulses: [f64; W] = filled(|w| compression.impulses[w] + expansion.impulses[w]);
        let struck = self.summed(impulses, &expansion.closed, &expansion.tangential);
        let work: f64 = impulses.iter().zip(&self.before).map(|(l, rate)| (l * rate).abs()).sum();
        if struck.energy > GAIN * work {
            return Err(Unsolved::EnergyGain(struck.energy));
        }
        Ok(struck)
    }

    /// The impact that closes all contacts taking part and keeps the friction of an impact before: sticking stays sticking, slip
    /// stays slip.
    pub(in crate::hybrid) fn closing(&self, like: &Struck<W, C>) -> Option<Struck<W, C>> {
        let solved = self.closed_like(like)?;
        Some(self.summed(solved.impulses, &solved.closed, &solved.tangential))
    }

    /// The one phase of such an impact.
    pub(in crate::hybrid) fn closed_like(&self, like: &Struck<W, C>) -> Option<Solved<f64, W, C>> {
        let tangential: [Tangential; C] = filled(|c| {
            if like.sticks[c] {
                Tangential::Stick
            } else {
                Tangential::along(self.elements[c].tangential, &like.after)
            }
        });
        self.compression().with_states(&self.all_closed(), &tangential)
    }

    fn summed(&self, impulses: [f64; W], closed: &[bool; C], tangential: &[Tangential; C]) -> Struck<W, C> {
        let after: [f64; W] = filled(|w| {
            self.before[w] + impulses.iter().zip(&self.delassus[w]).map(|(l, d)| l * d).sum::<f64>()
        });
        let energy = impulses.iter().zip(&self.before).zip(&after).map(|((l, a), b)| 0.5 * l * (a + b)).sum();
        let sticks = filled(|c| self.takes_part[c] && tangential[c] == Tangential::Stick);
        Struck { impulses, after, closed: *closed, sticks, energy }
    }
}

#[cfg(test)]
mod tests {
    use super::{Impact, Struck, Unsolved};
    use crate::hybrid::filled::{filled, table};
    use crate::hybrid::interface::element::{Element, Kind};
    use crate::hybrid::interface::loads::Loads;

    /// Numbers between minus one and one, from a seed.
    struct Random(u64);

    impl Random {
        fn next(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            ((self.0 >> 11) as f64 / (1_u64 << 52) as f64) - 1.0
        }

        /// A symmetric positive definite matrix: rows times their transposes, in `rank` dimensions.
        fn delassus<const W: usize>(&mut self, rank: usize) -> [[f64; W]; W] {
            let rows: [[f64; 12]; W] = table(|_, k| if k < rank { self.next() } else { 0.0 });
            table(|i, j| rows[i].iter().zip(&rows[j]).map(|(a, b)| a * b).sum())
        }
    }

    /// Solves `0 <= q + D x` complementary to `x >= 0` by projected successive relaxation, which shares nothing with the enumeration.
    fn relaxed<const W: usize>(d: &[[f64; W]; W], q: &[f64; W]) -> [f64; W] {
        let mut x = [0.0_f64; W];
        for _ in 0..20_000 {
            for i in 0..W {
                let rate: f64 = q[i] + (0..W).map(|j| d[i][j] * x[j]).sum::<f64>();
                x[i] = f64::max(0.0, x[i] - rate / d[i][i]);
            }
        }
        x
    }

    fn product<const W: usize>(d: &[[f64; W]; W], x: &[f64; W]) -> [f64; W] {
        filled(|i| (0..W).map(|j| d[i][j] * x[j]).sum())
    }

    #[test]
    fn smooth_impacts_are_those_of_another_method() {
        const ELEMENTS: [Element; 3] =
            [Element::smooth("a", 0), Element::smooth("b", 1), Element::smooth("c", 2)];
        let mut random = Random(7);
        for _ in 0..40 {
            let delassus = random.delassus::<3>(6);
            let before: [f64; 3] = filled(|_| random.next());
            let restitutions: [f64; 3] = filled(|_| random.next().abs());
            let impact = Impact {
                elements: &ELEMENTS,
                delassus: &delassus,
                before,
                takes_part: [true; 3],
                friction: [0.0; 3],
                loads: &Loads::none().responses,
                restitutions,
            };
            let Struck { impulses, after, energy, .. } = impact.solve().unwrap();
            let compression = relaxed(&delassus, &before);
            let change = product(&delassus, &compression);
            // Expansion, in the variables beyond their lower bounds.
            let floor: [f64; 3] = filled(|i| restitutions[i] * compression[i]);
            let pushed = product(&delassus, &floor);
            let beyond = relaxed(&delassus, &filled(|i| before[i] + change[i] + pushed[i]));
            for i in 0..3 {
                let expected = compression[i] + floor[i] + beyond[i];
                assert!(
                    (impulses[i] - expected).abs() < 1e-9 * (1.0 + expected),
                    "{impulses:?} {i} {expected}"
                );
                assert!(after[i] >= -1e-12 && impulses[i] >= -1e-12);
            }
            assert!(energy <= 1e-14);
        }
    }

    /// The residual of Coulomb's law and of the complementarity of one phase, written down once more.
    fn residual(floor: f64, mu: f64, (rate, slip): (f64, f64), (normal, along): (f64, f64)) -> f64 {
        let complementary = f64::min(rate, normal - floor).abs();
        let outside = f64::max(0.0, along.abs() - mu * normal);
        // Where there is slip, the impulse is at the cone's edge, against it.
        let against = slip.abs().min((along + mu * normal * slip.signum()).abs());
        complementary.max(outside).max(against)
    }

    #[test]
    fn rough_impacts_satisfy_their_laws_and_gain_no_energy() {
        const ELEMENTS: [Element; 2] = [Element::rough("a", 0, &[1]), Element::rough("b", 2, &[3])];
        let mut random = Random(11);
        let (mut solved, mut several, mut gained) = (0, 0, 0);
        for _ in 0..400 {
            let delassus = random.delassus::<4>(8);
            let mut before: [f64; 4] = filled(|_| random.next());
            before[0] = -before[0].abs();
            let friction: [f64; 2] = filled(|_| random.next().abs());
            // Without expansion the whole impact is one phase.
            let mut impact = Impact {
                elements: &ELEMENTS,
                delassus: &delassus,
                before,
                takes_part: [true; 2],
                friction,
                loads: &Loads::none().responses,
                restitutions: [0.0; 2],
            };
            match impact.solve() {
                Ok(Struck { impulses, after, .. }) => {
                    solved += 1;
                    for c in 0..2 {
                        let (n, t) = (2 * c, 2 * c + 1);
                        let worst =
                            residual(0.0, friction[c], (after[n], after[t]), (impulses[n], impulses[t]));
                        assert!(worst < 1e-9 * (1.0 + impulses[n]), "{worst:e}");
                    }
                    let change = product(&delassus, &impulses);
                    for w in 0..4 {
                        assert!(
                            (after[w] - before[w] - change[w]).abs()
                                < 1e-9 * (1.0 + impulses[0] + impulses[2])
                        );
                    }
                }
                Err(Unsolved::Several) => several += 1,
                Err(why) => panic!("{why:?}"),
            }
            // One contact alone never gains.
            impact.takes_part = [true, false];
            impact.restitutions = [random.next().abs(); 2];
            match impact.solve() {
                Ok(struck) => assert!(struck.energy <= 1e-12),
                Err(Unsolved::EnergyGain(_)) => gained += 1,
                Err(why) => panic!("{why:?}"),
            }
        }
        assert!(solved > 380, "{solved} solved, {several} with several solutions");
        assert_eq!(gained, 0);
    }

    #[test]
    fn spatial_impacts_slip_against_their_friction() {
        const ELEMENTS: [Element; 1] = [Element::rough("a", 0, &[1, 2])];
        let mut random = Random(3);
        let mut slipped = 0;
        for _ in 0..200 {
            let delassus = random.delassus::<3>(7);
            let mut before: [f64; 3] = filled(|_| random.next());
            before[0] = -before[0].abs();
            let mu = random.next().abs();
            let impact = Impact {
                elements: &ELEMENTS,
                delassus: &delassus,
                before,
                takes_part: [true],
                friction: [mu],
                loads: &Loads::none().responses,
                restitutions: [0.0],
            };
            let Struck { impulses, after, energy, .. } = impact.solve().unwrap();
            let (along, slip) = (libm::hypot(impulses[1], impulses[2]), libm::hypot(after[1], after[2]));
            assert!(after[0].abs() < 1e-10 && along <= mu * impulses[0] * (1.0 + 1e-9) && energy < 1e-12);
            if slip > 1e-6 {
                slipped += 1;
                for k in 1..3 {
                    assert!((impulses[k] * slip + mu * impulses[0] * after[k]).abs() < 1e-9 * impulses[0]);
                }
            }
        }
        assert!(slipped > 50, "{slipped}");
    }

    /// The impulses of spatial contacts of which each has three rows, by projections onto their cones with de Saxcé's change of rates: an
    /// iteration that knows no states and no directions.
    fn projected<const W: usize, const C: usize>(
        delassus: &[[f64; W]; W],
        before: &[f64; W],
        friction: &[f64; C],
    ) -> [f64; W] {
        let largest = (0..W).map(|w| delassus[w].iter().map(|entry| entry.abs()).sum()).fold(0.0, f64::max);
        let step = 0.7 / largest;
        let mut x = [0.0; W];
        for _ in 0..40_000 {
            let change = product(delassus, &x);
            for c in 0..C {
                let [n, s, t] = [3 * c, 3 * c + 1, 3 * c + 2];
                let rate = |w: usize| before[w] + change[w];
                let slip = libm::hypot(rate(s), rate(t));
                let mu = friction[c];
                let normal = x[n] - step * (rate(n) + mu * slip);
                let (first, second) = (x[s] - step * rate(s), x[t] - step * rate(t));
                let along = libm::hypot(first, second);
                let (normal, along_of_one) = if along <= mu * normal {
                    (normal, 1.0)
                } else if mu * along <= -normal {
                    (0.0, 0.0)
                } else {
                    let projected = (mu * along + normal) / (1.0 + mu * mu);
                    (projected, mu * projected / along)
                };
                (x[n], x[s], x[t]) = (normal, along_of_one * first, along_of_one * second);
            }
        }
        x
    }

    #[test]
    fn two_spatial_slips_in_one_impact_are_those_of_another_method() {
        const ELEMENTS: [Element; 2] = [Element::rough("a", 0, &[1, 2]), Element::rough("b", 3, &[4, 5])];
        let mut random = Random(5);
        let (mut both, mut refused) = (0, 0);
        for _ in 0..16 {
            let delassus = random.delassus::<6>(12);
            let mut before: [f64; 6] = filled(|_| random.next());
            (before[0], before[3]) = (-before[0].abs(), -before[3].abs());
            let friction: [f64; 2] = filled(|_| 0.4 * random.next().abs());
            let impact = Impact {
                elements: &ELEMENTS,
                delassus: &delassus,
                before,
                takes_part: [true; 2],
                friction,
                loads: &Loads::none().responses,
                restitutions: [0.0; 2],
            };
            let Ok(Struck { impulses, after, energy, .. }) = impact.solve() else {
                refused += 1;
                continue;
            };
            assert!(energy <= 1e-12, "{energy:e}");
            let mut slipped = 0;
            for c in 0..2 {
                let [n, s, t] = [3 * c, 3 * c + 1, 3 * c + 2];
                let (along, slip) = (libm::hypot(impulses[s], impulses[t]), libm::hypot(after[s], after[t]));
                let limit = friction[c] * impulses[n];
                assert!(f64::min(after[n], impulses[n]).abs() < 1e-10 && along <= limit + 1e-10);
                if slip > 1e-9 && impulses[n] > 1e-9 {
                    slipped += 1;
                    for w in [s, t] {
                        assert!((impulses[w] * slip + limit * after[w]).abs() < 1e-12 * (1.0 + impulses[n]));
                    }
                }
            }
            both += i32::from(slipped == 2);
            let other = projected(&delassus, &before, &friction);
            let change = product(&delassus, &other);
            for w in 0..6 {
                let off = (before[w] + change[w] - after[w]).abs();
                assert!(off < 1e-7, "row {w} of {impulses:?} by {off:e}, {other:?}");
            }
        }
        assert!(both >= 6 && refused == 0, "{both} with two slips, {refused} refused");
    }

    /// All twelve contacts that a declaration may have hit at once: `2^12` states in each phase.
    #[test]
    fn twelve_smooth_contacts_at_once() {
        let elements: [Element; 12] = core::array::from_fn(|c| Element::smooth("stop", c));
        let mut random = Random(13);
        let delassus = random.delassus::<12>(12);
        let impact = Impact {
            elements: &elements,
            delassus: &delassus,
            before: filled(|_| random.next()),
            takes_part: [true; 12],
            friction: [0.0; 12],
            loads: &Loads::none().responses,
            restitutions: [0.5; 12],
        };
        let Struck { impulses, after, energy, .. } = impact.solve().unwrap();
        assert!(energy < 0.0 && impulses.iter().chain(&after).all(|entry| *entry > -1e-9));
    }

    #[test]
    fn a_latch_that_locks_stops_what_it_holds() {
        const ELEMENTS: [Element; 2] = [Element::latch("bolt", 0), Element::smooth("stop", 1)];
        assert_eq!(ELEMENTS[0].kind, Kind::Latch);
        let delassus = [[2.0, 1.0], [1.0, 3.0]];
        let impact = Impact {
            elements: &ELEMENTS,
            delassus: &delassus,
            before: [-1.0, 0.0],
            takes_part: [true, true],
            friction: [0.0; 2],
            loads: &Loads::none().responses,
            restitutions: [0.0; 2],
        };
        let Struck { impulses, after, .. } = impact.solve().unwrap();
        // The bolt alone would open the stop: its impulse is a half.
        assert!(after[0].abs() < 1e-15 && (impulses[0] - 0.5).abs() < 1e-15 && impulses[1] == 0.0);
        assert!((after[1] - 0.5).abs() < 1e-15);
    }
}
