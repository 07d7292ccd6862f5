//! Forms in which a trajectory is looked at: a recording, a table, a plot, a page that plays.

use std::path::Path;

use guen_runtime::steppers::Interpolant;
use guen_runtime::{OutputMap, Simulate, Trajectory};

use crate::error::StudyError;
use crate::plot::Plot;
use crate::recording::Recording;
#[cfg(feature = "viewer")]
use {
    crate::viewer::Viewer,
    guen_runtime::{Bodies, Monitored},
};

/// Parts of a plot's width between two points of a curve.
const PLOT_POINTS: f64 = 1000.0;

/// Pictures of a second on a page.
#[cfg(feature = "viewer")]
const RATE: f64 = 60.0;

/// The fewest and the most samples that a page is made of.
#[cfg(feature = "viewer")]
const SAMPLES: [f64; 2] = [600.0, 1e6];

/// Samples of a step of the method, for what happens within it.
#[cfg(feature = "viewer")]
const PER_STEP: f64 = 4.0;

/// Recordings, tables, plots and pages of a trajectory, with the names of its state's entries; entries without names, as of a closure, go
/// by their numbers.
///
/// ```
/// use guen_runtime::{Simulate, System};
/// use guen_study::Export;
///
/// /// What the macro generates for a declared system.
/// #[derive(Clone, Copy)]
/// struct Oscillator;
/// impl System<f64, 2> for Oscillator {
///     fn rhs(&self, _t: f64, &[x, v]: &[f64; 2]) -> [f64; 2] {
///         [v, -x]
///     }
/// }
/// impl Simulate<f64, 2> for Oscillator {
///     type State = [f64; 2];
///     const STATES: &'static [&'static str] = &["x", "v"];
/// }
///
/// let motion = Oscillator.simulate(&[1.0, 0.0], 0.0..10.0).unwrap();
/// assert_eq!(motion.sampled(0.5).names(), ["x", "v"]);
/// assert!(motion.plot("an oscillation", &["x"])?.to_svg()?.contains("an oscillation"));
/// # Ok::<(), guen_study::StudyError>(())
/// ```
pub trait Export<S, const N: usize> {
    /// The states at all accepted steps, start and end included.
    fn recording(&self) -> Recording<N>;

    /// The states at multiples of `dt` after the start, and at the end.
    fn sampled(&self, dt: f64) -> Recording<N>;

    /// The declared outputs at multiples of `dt` after the start, and at the end, by their names.
    fn sampled_outputs<const K: usize>(&self, dt: f64) -> Recording<K>
    where
        S: OutputMap<f64, N, K>;

    /// Writes the states at multiples of `dt`, and at the end, as comma-separated values: a line with `t` and the names of the
    /// entries, then a line for each time.
    ///
    /// # Errors
    ///
    /// [`StudyError::Io`] with the path.
    fn save_csv(&self, dt: f64, path: impl AsRef<Path>) -> Result<(), StudyError> {
        self.sampled(dt).save_csv(path)
    }

    /// A plot of these entries over time, to be given axes and more curves, and to be [saved](Plot::save).
    ///
    /// # Errors
    ///
    /// [`StudyError::UnknownEntry`] if a name is none of the state's.
    fn plot(&self, title: &str, entries: &[&str]) -> Result<Plot, StudyError>;

    /// Writes a page that plays the motion of the declared bodies, with panels of the states, of the energy and of the
    /// constraints on positions. It is made of 60 samples a second or four a step of the method, whichever are more, but of 600 at least and of
    /// a million at most; the page chooses among them. For other shapes, paths and panels make a [`Viewer`] of
    /// [`sampled`](Self::sampled).
    ///
    /// # Errors
    ///
    /// Those of [`Viewer::write`].
    #[cfg(feature = "viewer")]
    #[cfg_attr(docsrs, doc(cfg(feature = "viewer")))]
    fn view<const B: usize>(&self, title: &str, path: impl AsRef<Path>) -> Result<(), StudyError>
    where
        S: Bodies<f64, N, B> + Monitored<f64, N>;
}

impl<S, P, const N: usize> Export<S, N> for Trajectory<S, N, f64, P>
where
    S: Simulate<f64, N>,
    P: Interpolant<f64, N>,
{
    fn recording(&self) -> Recording<N> {
        filled::<S, N>(self.iter())
    }

    fn sampled(&self, dt: f64) -> Recording<N> {
        filled::<S, N>(self.sample(dt))
    }

    fn sampled_outputs<const K: usize>(&self, dt: f64) -> Recording<K>
    where
        S: OutputMap<f64, N, K>,
    {
        let mut recording = Recording::new(&S::OUTPUTS).with_units(S::OUTPUT_UNITS);
        self.sample(dt).for_each(|(t, x)| recording.record(t, &self.system().output_values(t, &x.into())));
        recording
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
        let unit = |place: &usize| recording.units().get(*place).copied().unwrap_or_default();
        // A unit that all share stands at the axis, and different ones behind the names.
        let shared = places.first().map(unit).filter(|own| places.iter().all(|place| unit(place) == *own));
        let time = if recording.units().is_empty() { "t" } else { "t [s]" };
        let axis = shared.filter(|unit| !unit.is_empty()).map_or(String::new(), |unit| format!("[{unit}]"));
        Ok(places.iter().zip(entries).fold(Plot::new(title).axes(time, axis), |plot, (place, name)| {
            let name = if shared.is_some() { (*name).to_owned() } else { recording.with_unit(name, *place) };
            plot.line(name, recording.curve(*place))
        }))
    }

    #[cfg(feature = "viewer")]
    fn view<const B: usize>(&self, title: &str, path: impl AsRef<Path>) -> Result<(), StudyError>
    where
        S: Bodies<f64, N, B> + Monitored<f64, N>,
    {
        let span = (self.end_time() - self.start_time()).abs();
        let [fewest, most] = SAMPLES;
        let wanted = (RATE * span).max(PER_STEP * self.iter().count() as f64).clamp(fewest, most);
        let recording = self.sampled(span / wanted.floor());
        Viewer::new(title, &recording).bodies(self.system()).states(&[]).monitored(self.system()).write(path)
    }
}

fn filled<S, const N: usize>(states: impl Iterator<Item = (f64, S::State)>) -> Recording<N>
where
    S: Simulate<f64, N>,
{
    let mut recording = Recording::new(S::STATES).with_units(S::UNITS);
    states.for_each(|(t, state)| recording.record(t, &state.into()));
    recording
}

#[cfg(test)]
mod tests {
    use super::*;
    use guen_runtime::from_fn;

    #[cfg(feature = "viewer")]
    mod pages {
        use super::*;
        use guen_runtime::{Body, System};

        /// A bead that swings fast, many times in a hundredth of a millisecond.
        #[derive(Clone, Copy)]
        struct Bead;

        const RATE: f64 = 1e7;

        impl System<f64, 2> for Bead {
            fn rhs(&self, _t: f64, &[x, v]: &[f64; 2]) -> [f64; 2] {
                [RATE * v, -RATE * x]
            }
        }
        impl Simulate<f64, 2> for Bead {
            type State = [f64; 2];
            const STATES: &'static [&'static str] = &["x", "v"];
        }
        impl Monitored<f64, 2> for Bead {
            fn energy(&self, _t: f64, &[x, v]: &[f64; 2]) -> f64 {
                (x * x + v * v) / 2.0
            }
        }
        impl Bodies<f64, 2, 1> for Bead {
            fn bodies(&self, _t: f64, &[x, _]: &[f64; 2]) -> [Body; 1] {
                let center = Some([x, 0.0, 0.0]);
                [Body { name: "bead", mass: Some(1.0), inertia: None, center, orientation: None }]
            }
        }

        #[test]
        fn short_runs_have_samples() {
            let path = std::env::temp_dir().join(format!("guen-study-short-{}.html", std::process::id()));
            let motion = Bead.simulate(&[1.0, 0.0], 0.0..1e-5).unwrap();
            motion.view("short", &path).unwrap();
            let page = std::fs::read_to_string(&path).unwrap();
            std::fs::remove_file(&path).unwrap();
            // Sixteen swings, in base64 of doubles.
            let (_, times) = page.split_once("\"times\":\"").unwrap();
            let samples = times.split_once('"').unwrap().0.len() * 3 / 4 / 8;
            assert!((601..3000).contains(&samples), "{samples}");
        }
    }

    #[test]
    fn entries_without_names_go_by_their_numbers() {
        let oscillator = from_fn(|_t: f64, &[x, v]: &[f64; 2]| [v, -x]);
        let motion = oscillator.simulate(&[1.0, 0.0], 0.0..1.0).unwrap();
        let mut text = Vec::new();
        motion.sampled(1.0).write_csv(&mut text).unwrap();
        let text = String::from_utf8(text).unwrap();
        assert!(text.starts_with("t,0,1\n0.0,1.0,0.0\n1.0,") && text.lines().count() == 3, "{text}");
        assert!(motion.plot("", &["1"]).is_ok());
        let error = motion.plot("both", &["1", "2"]).unwrap_err();
        assert_eq!(error.to_string(), "picture `both`: the state has no `2`");
    }
}
