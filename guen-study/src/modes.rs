//! Forms in which a motion through modes is looked at: both sides of every transition are kept, and told apart.

use std::path::Path;

use guen_runtime::Simulate;
use guen_runtime::hybrid::{Element, HybridSystem, HybridTrajectory, Mode};
use guen_runtime::steppers::Interpolant;

use crate::cell;
use crate::error::StudyError;
use crate::file::replace_file;
use crate::plot::Plot;
use crate::recording::Recording;
#[cfg(feature = "viewer")]
use {
    crate::viewer::Viewer,
    guen_runtime::hybrid::{Transition, TransitionKind},
    guen_runtime::{Bodies, Monitored},
};

/// Parts of a plot's width between two points of a curve.
const PLOT_POINTS: f64 = 1000.0;
/// Pictures of a second on a page, and the fewest and the most samples that it is made of.
#[cfg(feature = "viewer")]
const RATE: f64 = 60.0;
#[cfg(feature = "viewer")]
const SAMPLES: [f64; 2] = [600.0, 1e6];

/// Recordings, tables, plots and pages of a motion through modes, [`HybridTrajectory`].
///
/// Both sides of every transition are kept, with the same time, the one before it first: velocities jump there.
///
/// ```
/// use guen_runtime::hybrid::{Element, FreeMotion, HybridSystem, Mode, Signal};
/// use guen_runtime::{Lift, Real, Simulate, System};
/// use guen_study::ExportModes;
///
/// /// What the macro generates for a declared system.
/// #[derive(Clone, Copy)]
/// struct Ball;
/// # impl System<f64, 2> for Ball {
/// #     fn rhs(&self, _t: f64, &[_, v]: &[f64; 2]) -> [f64; 2] {
/// #         [v, -9.81]
/// #     }
/// # }
/// impl Simulate<f64, 2> for Ball {
///     type State = [f64; 2];
///     const STATES: &'static [&'static str] = &["z", "v"];
/// }
/// # impl HybridSystem<2, 1, 1, 0> for Ball {
/// #     const ELEMENTS: [Element; 1] = [Element::smooth("floor", 0)];
/// #     const SIGNALS: [Signal; 0] = [];
/// #     const COORDINATES: usize = 1;
/// #     type Mode = Mode<1>;
/// #     type Inputs = ();
/// #     fn with_inputs(&self, (): ()) -> Self {
/// #         *self
/// #     }
/// #     fn free_motion<R: Lift<f64>>(&self, _t: R, &[z, v]: &[R; 2], _: &[R; 0], _: &[R; 1]) -> FreeMotion<R, 2, 1, 1> {
/// #         let (zero, one, g) = (R::zero(), R::one(), R::lift(9.81));
/// #         FreeMotion {
/// #             rates: [v, -g], gaps: [z], row_rates: [v], biases: [-g], delassus: [[one]], responses: [[zero, one]],
/// #             friction: [zero], stiction: [zero], limits: [zero],
/// #         }
/// #     }
/// #     fn restitutions(&self) -> [f64; 1] {
/// #         [0.5]
/// #     }
/// #     fn signals<R: Lift<f64>>(&self, _t: R, _: &[R; 2]) -> [R; 0] {
/// #         []
/// #     }
/// # }
///
/// let motion = HybridSystem::simulate(&Ball, &[1.0, 0.0], 0.0..0.7).unwrap();
/// let recording = motion.sampled(0.1);
/// // Eight samples, and both sides of one impact.
/// assert_eq!(recording.len(), 10);
/// let plot = motion.plot("a ball", &["z", "v"])?;
/// assert!(plot.to_svg()?.contains("transition"));
/// # Ok::<(), guen_study::StudyError>(())
/// ```
pub trait ExportModes<H, const N: usize> {
    /// The states at the beginnings of all steps, on both sides of every transition, and at the end.
    fn recording(&self) -> Recording<N>;

    /// The states at multiples of `dt` after the start, on both sides of every transition, and at the end.
    fn sampled(&self, dt: f64) -> Recording<N>;

    /// Writes a line for every time of [`sampled`](Self::sampled) as comma-separated values: `t`, the entries of the state, the state of
    /// every contact by its name, and the force along every row: `floor normal`, `floor along`, `floor across`.
    ///
    /// # Errors
    ///
    /// [`StudyError::Io`] with the path.
    fn save_csv(&self, dt: f64, path: impl AsRef<Path>) -> Result<(), StudyError>;

    /// A plot of these entries over time, with a thin line at every transition.
    ///
    /// # Errors
    ///
    /// [`StudyError::UnknownEntry`] if a name is none of the state's.
    fn plot(&self, title: &str, entries: &[&str]) -> Result<Plot, StudyError>;

    /// A plot of the forces along all rows over time, with a thin line at every transition.
    fn plot_reactions(&self, title: &str) -> Plot;

    /// The names of all contacts, grips and latches, in the order of their declaration.
    fn contacts(&self) -> Vec<&'static str>;

    /// Whether an element has a normal force, and whether it has friction; nothing for a name that no element has.
    fn kinds_of_forces(&self, contact: &str) -> Option<[bool; 2]>;

    /// The force of an element along its normal, along its slip and across it, zero where it has none; nothing for a name that no element has. At
    /// a transition that after it, of several possible ones the smallest.
    fn reaction_of(&self, contact: &str, t: f64) -> Option<[f64; 3]>;

    /// The states that a page plays: evenly spaced in time, one at each, after a transition that falls on it.
    #[cfg(feature = "viewer")]
    #[cfg_attr(docsrs, doc(cfg(feature = "viewer")))]
    fn played(&self) -> Recording<N>;

    /// A page that plays the motion of the declared bodies by the states of [`played`](Self::played). It says in words what every contact
    /// does, marks the transitions, and has panels of the states, of the forces of contacts, of gaps and of slips. It can be described further: where
    /// a [`contact`](Viewer::contact) is, so that its forces are seen, what is up, rods between points, curves.
    #[cfg(feature = "viewer")]
    #[cfg_attr(docsrs, doc(cfg(feature = "viewer")))]
    fn viewer<'a, const B: usize>(&self, system: &H, title: &str, played: &'a Recording<N>) -> Viewer<'a, N>
    where
        H: Bodies<f64, N, B> + Monitored<f64, N>;

    /// Writes the page of [`viewer`](Self::viewer).
    ///
    /// # Errors
    ///
    /// Those of [`Viewer::write`].
    #[cfg(feature = "viewer")]
    #[cfg_attr(docsrs, doc(cfg(feature = "viewer")))]
    fn view<const B: usize>(&self, system: &H, title: &str, path: impl AsRef<Path>) -> Result<(), StudyError>
    where
        H: Bodies<f64, N, B> + Monitored<f64, N>,
    {
        self.viewer(system, title, &self.played()).write(path)
    }
}

/// A moment of a motion: its time, its state, and the mode and the forces there.
struct Moment<const N: usize, const W: usize, const C: usize> {
    t: f64,
    state: [f64; N],
    mode: Mode<C>,
    reactions: [f64; W],
}

impl<H, X, P, const N: usize, const W: usize, const C: usize, const S: usize> ExportModes<H, N>
    for HybridTrajectory<H, X, N, W, C, S, P>
where
    H: HybridSystem<N, W, C, S> + Simulate<f64, N> + Clone,
    H::Mode: Into<Mode<C>>,
    X: Copy + From<[f64; N]> + Into<[f64; N]>,
    P: Interpolant<f64, N>,
{
    fn recording(&self) -> Recording<N> {
        let mut recording = Recording::new(H::STATES).with_units(H::UNITS);
        let mut sides = self.transitions().iter().peekable();
        for t in self.times() {
            while let Some(transition) = sides.next_if(|transition| transition.t <= t) {
                recording.record(transition.t, &transition.state_before);
                recording.record(transition.t, &transition.state_after);
            }
            if recording.last().is_none_or(|(last, _)| last < t) {
                recording.record(t, &self.at(t).into());
            }
        }
        recording
    }

    fn sampled(&self, dt: f64) -> Recording<N> {
        let mut recording = Recording::new(H::STATES).with_units(H::UNITS);
        moments(self, dt, &mut |moment| recording.record(moment.t, &moment.state));
        recording
    }

    fn save_csv(&self, dt: f64, path: impl AsRef<Path>) -> Result<(), StudyError> {
        replace_file(path, |out| {
            let names = Recording::<N>::new(H::STATES).with_units(H::UNITS);
            write!(out, "{}", if H::UNITS.is_empty() { "t" } else { "t [s]" })?;
            for entry in 0..N {
                let name = H::STATES.get(entry).map_or_else(|| entry.to_string(), |name| (*name).to_owned());
                write!(out, ",{}", cell::text(&names.with_unit(&name, entry)))?;
            }
            for element in &H::ELEMENTS {
                write!(out, ",{}", cell::text(element.name))?;
            }
            for name in names_of_rows::<W>(&H::ELEMENTS) {
                write!(out, ",{}", cell::text(&name))?;
            }
            writeln!(out)?;
            let mut written = Ok(());
            moments(self, dt, &mut |Moment { t, state, mode, reactions }| {
                let mut line = format!("{t:?}");
                state.iter().for_each(|x| line += &format!(",{x:?}"));
                mode.0.iter().for_each(|state| line += &format!(",{state}"));
                reactions.iter().for_each(|force| line += &format!(",{force:?}"));
                if written.is_ok() {
                    written = writeln!(out, "{line}");
                }
            });
            written
        })
    }

    fn plot(&self, title: &str, entries: &[&str]) -> Result<Plot, StudyError> {
        let recording = self.sampled((self.end_time() - self.start_time()).abs() / PLOT_POINTS);
        let place = |name: &&str| {
            recording.position(name).ok_or_else(|| StudyError::UnknownEntry {
                title: title.to_owned(),
                name: (*name).to_owned(),
                known: recording.names(),
            })
        };
        let places = entries.iter().map(place).collect::<Result<Vec<usize>, _>>()?;
        let time = if recording.units().is_empty() { "t" } else { "t [s]" };
        let plot =
            Plot::new(title).axes(time, "").moments("transition", self.transitions().iter().map(|at| at.t));
        Ok(places.iter().zip(entries).fold(plot, |plot, (place, name)| {
            plot.line(recording.with_unit(name, *place), recording.curve(*place))
        }))
    }

    fn plot_reactions(&self, title: &str) -> Plot {
        let mut curves: [Vec<(f64, f64)>; W] = core::array::from_fn(|_| Vec::new());
        moments(self, (self.end_time() - self.start_time()).abs() / PLOT_POINTS, &mut |moment| {
            curves.iter_mut().zip(moment.reactions).for_each(|(curve, force)| curve.push((moment.t, force)));
        });
        let plot =
            Plot::new(title).axes("t", "").moments("transition", self.transitions().iter().map(|at| at.t));
        names_of_rows::<W>(&H::ELEMENTS)
            .into_iter()
            .zip(curves)
            .fold(plot, |plot, (name, curve)| plot.line(name, curve))
    }

    fn contacts(&self) -> Vec<&'static str> {
        H::ELEMENTS.iter().map(|element| element.name).collect()
    }

    fn kinds_of_forces(&self, contact: &str) -> Option<[bool; 2]> {
        let element = H::ELEMENTS.iter().find(|element| element.name == contact)?;
        Some([element.normal.is_some(), !element.tangential.is_empty()])
    }

    fn reaction_of(&self, contact: &str, t: f64) -> Option<[f64; 3]> {
        let element = H::ELEMENTS.iter().find(|element| element.name == contact)?;
        let reactions = self.reactions_at(t);
        let mut force = [0.0; 3];
        let rows = element.normal.map(|row| (0, row));
        let slips = element.tangential.iter().enumerate().map(|(k, row)| (k + 1, *row));
        rows.into_iter().chain(slips).for_each(|(k, row)| force[k] = reactions[row]);
        Some(force)
    }

    #[cfg(feature = "viewer")]
    fn played(&self) -> Recording<N> {
        let span = (self.end_time() - self.start_time()).abs();
        let [fewest, most] = SAMPLES;
        let wanted = (RATE * span).max(4.0 * self.times().count() as f64).clamp(fewest, most);
        let mut recording = Recording::new(H::STATES).with_units(H::UNITS);
        self.sample(span / wanted.floor()).for_each(|(t, x)| recording.record(t, &x.into()));
        recording
    }

    #[cfg(feature = "viewer")]
    fn viewer<'a, const B: usize>(&self, system: &H, title: &str, played: &'a Recording<N>) -> Viewer<'a, N>
    where
        H: Bodies<f64, N, B> + Monitored<f64, N>,
    {
        let mut viewer = Viewer::new(title, played).bodies(system).states(&[]);
        for (c, element) in H::ELEMENTS.iter().enumerate() {
            let word = |mode: H::Mode| Into::<Mode<C>>::into(mode).0[c].word();
            let first = (self.start_time(), word(self.mode_at(self.start_time())));
            let later = self.transitions().iter().map(|at| (at.t, word(at.after)));
            let mut changes: Vec<(f64, &str)> = vec![first];
            changes.extend(later);
            changes.dedup_by(|later, before| later.1 == before.1);
            viewer = viewer.words(element.name, changes);
        }
        for transition in self.transitions() {
            viewer = viewer.mark(transition.t, told::<H, N, W, C, S>(transition));
        }
        let names = names_of_rows::<W>(&H::ELEMENTS);
        viewer = viewer.panel("forces of contacts");
        for (row, name) in names.iter().enumerate() {
            viewer = viewer.curve(name, move |t, _| self.reactions_at(t)[row]);
        }
        let free = |t: f64, x: &[f64; N]| self.in_mode_at(t).map(|mode| mode.reactions(t, x).free);
        let with_gap = || H::ELEMENTS.iter().enumerate().filter(|(_, element)| element.normal.is_some());
        if with_gap().next().is_some() {
            viewer = viewer.panel("gaps");
        }
        for (c, element) in with_gap() {
            viewer = viewer.curve(element.name, move |t, x| free(t, x).map_or(0.0, |free| free.gaps[c]));
        }
        let slips: Vec<usize> = H::ELEMENTS.iter().flat_map(|element| element.tangential).copied().collect();
        if !slips.is_empty() {
            viewer = viewer.panel("slips");
        }
        for row in slips {
            viewer =
                viewer.curve(&names[row], move |t, x| free(t, x).map_or(0.0, |free| free.row_rates[row]));
        }
        viewer.monitored(system)
    }
}

/// The text of a mark at a transition: its kind and the elements that take part, `impact: floor`.
#[cfg(feature = "viewer")]
fn told<H, const N: usize, const W: usize, const C: usize, const S: usize>(
    transition: &Transition<H::Mode, N, W, C>,
) -> String
where
    H: HybridSystem<N, W, C, S>,
{
    let elements = H::ELEMENTS.iter().zip(transition.elements).filter(|(_, taking_part)| *taking_part);
    let signal = transition.signal.and_then(|signal| H::SIGNALS.get(signal)).map(|signal| signal.name);
    let names: Vec<&str> = elements.map(|(element, _)| element.name).chain(signal).collect();
    // The end of its impacts is a time, and the kind of a mark a word.
    let kind = match transition.kind {
        TransitionKind::Rest { .. } => "rest".to_owned(),
        kind => kind.to_string(),
    };
    match names.as_slice() {
        [] => kind,
        names => format!("{kind}: {}", names.join(", ")),
    }
}

/// Visits the multiples of `dt`, both sides of every transition, and the end, in the order of time.
fn moments<H, X, P, const N: usize, const W: usize, const C: usize, const S: usize>(
    motion: &HybridTrajectory<H, X, N, W, C, S, P>,
    dt: f64,
    visit: &mut dyn FnMut(Moment<N, W, C>),
) where
    H: HybridSystem<N, W, C, S> + Clone,
    H::Mode: Into<Mode<C>>,
    X: Copy + From<[f64; N]> + Into<[f64; N]>,
    P: Interpolant<f64, N>,
{
    let mut transitions = motion.transitions().iter().peekable();
    let mut last = None;
    let mut reactions = motion.reactions_at(motion.start_time());
    for (t, x) in motion.sample(dt) {
        while let Some(transition) = transitions.next_if(|transition| transition.t <= t) {
            let (state, mode) = (transition.state_before, transition.before.into());
            // The forces before are those where this mode was seen last; after it those of the next one.
            let before = motion.reactions_before(transition.t).unwrap_or(reactions);
            visit(Moment { t: transition.t, state, mode, reactions: before });
            let (state, mode) = (transition.state_after, transition.after.into());
            reactions = motion.reactions_at(transition.t);
            visit(Moment { t: transition.t, state, mode, reactions });
            last = Some(transition.t);
        }
        if last != Some(t) {
            reactions = motion.reactions_at(t);
            visit(Moment { t, state: x.into(), mode: motion.mode_at(t).into(), reactions });
        }
    }
}

/// The names of rows: that of the element, and which of its rows it is where it has several.
fn names_of_rows<const W: usize>(elements: &[Element]) -> Vec<String> {
    let mut names = vec![String::new(); W];
    for element in elements {
        let several = usize::from(element.normal.is_some()) + element.tangential.len() > 1;
        let words = ["along", "across"];
        let tangential = element.tangential.iter().copied().zip(words);
        for (row, word) in element.normal.map(|row| (row, "normal")).into_iter().chain(tangential) {
            if let Some(name) = names.get_mut(row) {
                *name = if several { format!("{} {word}", element.name) } else { element.name.to_owned() };
            }
        }
    }
    names
}

#[cfg(test)]
mod tests {
    use super::{Element, names_of_rows};

    #[test]
    fn rows_are_named_by_their_contact_and_direction() {
        let elements =
            [Element::grip("brake", &[3]), Element::rough("floor", 0, &[1, 2]), Element::smooth("stop", 4)];
        let names = ["floor normal", "floor along", "floor across", "brake", "stop"];
        assert_eq!(names_of_rows::<5>(&elements), names);
    }
}
