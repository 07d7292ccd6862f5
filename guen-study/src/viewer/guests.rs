//! Further recordings on a page: beside the first one or as its ghosts, with one clock.

use super::phases::{Mark, Words};
use super::{Curve, Fault, Link, MovingBody, MovingPoint, Panel, Viewer, fit, page};
use crate::error::StudyError;

/// A further recording: what it shows, at its own times.
#[derive(Clone, Debug)]
pub(super) struct Guest {
    pub(super) name: String,
    pub(super) is_ghost: bool,
    /// The time of its first sample.
    pub(super) start: f64,
    /// All times of its samples, since the first.
    pub(super) times: Vec<f64>,
    /// The times that the page steps through, since the first.
    pub(super) steps: Vec<f64>,
    pub(super) bodies: Vec<MovingBody>,
    pub(super) paths: Vec<MovingPoint>,
    pub(super) links: Vec<Link>,
    pub(super) panels: Vec<Panel>,
    pub(super) marks: Vec<Mark>,
    pub(super) words: Vec<Words>,
}

impl<const N: usize> Viewer<'_, N> {
    /// Another run in the same space and at the same time, faint: another tolerance, another controller, a scene beside the system
    /// that it is of. Its name is its title, or what [`called`](Viewer::called) says.
    ///
    /// Bodies and paths with the name of one of this page have its colour, curves in a panel of the same name, too; they are dashed. All runs
    /// follow one clock, that of their recordings: who ends before others stands still from there on, and the page says
    /// when. Ground, view and size are those of this page.
    ///
    /// ```
    /// use guen_study::{Pose, Recording, Shape, Viewer};
    ///
    /// let fall = |seconds: u32| {
    ///     let mut recording = Recording::new(&["t"]);
    ///     (0..=60 * seconds).map(|k| f64::from(k) / 60.0).for_each(|t| recording.record(t, &[t]));
    ///     recording
    /// };
    /// let (long, short) = (fall(3), fall(2));
    /// let ball = |name, recording, drag: f64| {
    ///     let height = move |t: f64| 50.0 - 4.9 * t * t * (1.0 - drag * t);
    ///     Viewer::new(name, recording)
    ///         .body("ball", [Shape::sphere(1.0)], move |t, _| Pose::at([0.0, 0.0, height(t)]))
    ///         .panel("height in m")
    ///         .curve("z", move |t, _: &[f64; 1]| height(t))
    /// };
    /// let page = ball("in vacuum", &long, 0.0).ghost(ball("in air", &short, 0.1)).to_html()?;
    /// assert!(page.contains("in air ends at t = 2 s"));
    /// # Ok::<(), guen_study::StudyError>(())
    /// ```
    pub fn ghost<const M: usize>(self, other: Viewer<'_, M>) -> Self {
        self.with_guest(other, true)
    }

    /// Another run at the same time, as [`ghost`](Viewer::ghost) has it, but next to this one and in full colour: it is moved to the
    /// right, as the view begins, by as much as both need. Places that the page tells are those of the run itself.
    pub fn beside<const M: usize>(self, other: Viewer<'_, M>) -> Self {
        self.with_guest(other, false)
    }

    /// The name of this run where there are several on a page; its title unless told.
    ///
    /// ```
    /// use guen_study::{Recording, Viewer};
    ///
    /// let mut recording = Recording::new(&["x"]);
    /// (0..100).for_each(|k| recording.record(f64::from(k), &[1.0]));
    /// let run = |name| Viewer::new("Two tolerances", &recording).called(name).curve("x", |_, x| x[0]);
    /// let page = run("1e-10").ghost(run("1e-4")).to_html()?;
    /// assert!(page.contains(r#""run":"1e-10""#) && page.contains(r#""name":"1e-4""#));
    /// # Ok::<(), guen_study::StudyError>(())
    /// ```
    pub fn called(mut self, name: impl Into<String>) -> Self {
        self.name = Some(name.into());
        self
    }

    fn with_guest<const M: usize>(mut self, other: Viewer<'_, M>, is_ghost: bool) -> Self {
        let fault = page::check(&other).err().map(|error| match error {
            StudyError::NotDrawable { title, what, time } => {
                Fault::NotDrawable { what: format!("{what} of {title}"), time }
            }
            StudyError::UnknownBody { title, name } => {
                Fault::UnknownBody { name: format!("{name} of {title}") }
            }
            StudyError::UnknownContact { title, name, known } => {
                Fault::UnknownContact { name: format!("{name} of {title}"), known }
            }
            StudyError::Times { title, time } => Fault::Times { title, time },
            StudyError::TooLarge { bytes, .. } => Fault::TooLarge { bytes },
            _ => Fault::NothingToDraw { title: other.title.clone() },
        });
        if let Some(fault) = fault {
            self.fault.get_or_insert(fault);
            return self;
        }
        let Viewer { title, name, samples, bodies, paths, links, panels, marks, words, guests, .. } = other;
        self.guests.push(Guest {
            name: name.unwrap_or(title),
            is_ghost,
            start: samples.start,
            times: samples.times,
            steps: samples.steps,
            bodies,
            paths,
            links,
            panels,
            marks,
            words,
        });
        self.guests.extend(guests);
        fit::relieve(&mut self);
        self
    }

    /// The name of the first run.
    pub(super) fn own_name(&self) -> &str {
        self.name.as_deref().unwrap_or(&self.title)
    }

    /// The first time of any run.
    pub(super) fn start(&self) -> f64 {
        self.guests.iter().fold(self.samples.start, |first, guest| first.min(guest.start))
    }

    pub(super) fn all_bodies(&self) -> impl Iterator<Item = &MovingBody> {
        self.bodies.iter().chain(self.guests.iter().flat_map(|guest| &guest.bodies))
    }

    pub(super) fn all_paths(&self) -> impl Iterator<Item = &MovingPoint> {
        self.paths.iter().chain(self.guests.iter().flat_map(|guest| &guest.paths))
    }

    pub(super) fn all_links(&self) -> impl Iterator<Item = &Link> {
        self.links.iter().chain(self.guests.iter().flat_map(|guest| &guest.links))
    }

    pub(super) fn all_curves(&self) -> impl Iterator<Item = &Curve> {
        let panels = self.panels.iter().chain(self.guests.iter().flat_map(|guest| &guest.panels));
        panels.flat_map(|panel| &panel.curves)
    }

    /// The runs that begin after or end before another one: what the page says of them.
    pub(super) fn told_ends(&self) -> Option<String> {
        let last = |times: &[f64]| times.last().copied().unwrap_or(0.0);
        let own = (self.own_name(), self.samples.start, self.samples.start + last(&self.samples.times));
        let guests = self.guests.iter().map(|g| (g.name.as_str(), g.start, g.start + last(&g.times)));
        let runs: Vec<(&str, f64, f64)> = std::iter::once(own).chain(guests).collect();
        let first = runs.iter().map(|run| run.1).fold(f64::INFINITY, f64::min);
        let end = runs.iter().map(|run| run.2).fold(f64::NEG_INFINITY, f64::max);
        let unit = self.view.time_unit.as_deref().unwrap_or("s");
        let told = |time: f64| format!("t = {} {unit}", crate::table::significant(time, 6));
        // Differences that no eye sees are none.
        let near = 1e-6 * (end - first);
        let texts: Vec<String> = runs
            .iter()
            .flat_map(|&(name, from, to)| {
                let begins = (from > first + near).then(|| format!("{name} begins at {}.", told(from)));
                let ends =
                    (to < end - near).then(|| format!("{name} ends at {}, and stands still then.", told(to)));
                begins.into_iter().chain(ends)
            })
            .collect();
        (!texts.is_empty()).then(|| texts.join(" "))
    }
}
