//! Content that comes by itself: curves of states, outputs and energies, and arrows of forces.

use guen_runtime::{Monitored, OutputMap};

use super::drawable::is_drawable;
use super::{Link, LinkKind, Viewer, fit};

impl<const N: usize> Viewer<'_, N> {
    /// Curves of all entries of the state, by their names. Entries with one unit share a panel; those without, in the order of
    /// the entries, are in panels of their own: rates are seldom of the size of angles.
    ///
    /// `units` are those of the entries, in their order; what is beyond its end, or empty, has none. Where there are none they are those of
    /// the recording, which trajectories of systems with [units](crate::Recording::with_units) bring along.
    ///
    /// ```
    /// use guen_study::{Recording, Viewer};
    ///
    /// let mut recording = Recording::new(&["x", "y", "v"]);
    /// for k in 0..100 {
    ///     let t = f64::from(k);
    ///     recording.record(t, &[t.sin(), t.cos(), 0.1 * t]);
    /// }
    /// let page = Viewer::new("States", &recording).states(&["m", "m", "m/s"]).to_html()?;
    /// assert!(page.contains(r#""name":"state in m""#) && page.contains(r#""name":"state in m/s""#));
    /// # Ok::<(), guen_study::StudyError>(())
    /// ```
    pub fn states(mut self, units: &[&str]) -> Self {
        let names = self.samples.names();
        let name = |i: usize| names.get(i).map_or_else(|| i.to_string(), |name| (*name).to_owned());
        let known = self.samples.units();
        let units = if units.is_empty() { known } else { units };
        let unit = |i: usize| units.get(i).copied().unwrap_or_default();
        let mut shown = [false; N];
        for first in 0..N {
            if shown[first] {
                continue;
            }
            let together = |i: &usize| *i == first || !unit(first).is_empty() && unit(*i) == unit(first);
            self = match unit(first) {
                "" => self.panel(name(first)),
                unit => self.panel(format!("state in {unit}")),
            };
            for i in (first..N).filter(together) {
                shown[i] = true;
                self = self.curve(name(i), move |_, state| state[i]);
            }
        }
        self
    }

    /// Curves of all declared outputs, by their names; those of one vector share a panel.
    ///
    /// ```
    /// use guen_runtime::{OutputMap, System};
    /// use guen_study::{Recording, Viewer};
    ///
    /// /// A falling stone: what the macro generates for a system with an output.
    /// struct Stone;
    /// impl System<f64, 2> for Stone {
    ///     fn rhs(&self, _t: f64, &[_, v]: &[f64; 2]) -> [f64; 2] {
    ///         [v, -9.81]
    ///     }
    /// }
    /// impl OutputMap<f64, 2, 1> for Stone {
    ///     type Outputs = f64;
    ///     const OUTPUTS: [&'static str; 1] = ["height"];
    ///     fn output_values(&self, _t: f64, &[z, _]: &[f64; 2]) -> [f64; 1] {
    ///         [z]
    ///     }
    ///     fn named_outputs(values: &[f64; 1]) -> f64 {
    ///         values[0]
    ///     }
    /// }
    /// let mut recording = Recording::new(&["z", "v"]);
    /// (0..100).for_each(|k| recording.record(f64::from(k), &[1.0, 0.0]));
    /// let page = Viewer::new("A stone", &recording).outputs(&Stone).to_html()?;
    /// assert!(page.contains(r#""name":"height""#));
    /// # Ok::<(), guen_study::StudyError>(())
    /// ```
    pub fn outputs<S, const K: usize>(mut self, system: &S) -> Self
    where
        S: OutputMap<f64, N, K> + ?Sized,
    {
        let whole = |name: &'static str| name.split_once('.').map_or(name, |(vector, _)| vector);
        let mut before = None;
        for (i, name) in S::OUTPUTS.into_iter().enumerate() {
            if before != Some(whole(name)) {
                let unit = S::OUTPUT_UNITS.get(i).copied().unwrap_or_default();
                let unit = if unit.is_empty() { String::new() } else { format!(" in {unit}") };
                self = self.panel(format!("output {}{unit}", whole(name)));
                before = Some(whole(name));
            }
            self = self.curve(name, |t, state| system.output_values(t, state)[i]);
        }
        self
    }

    /// Panels with the energy, with its change since the start, and with the largest residual of the constraints on
    /// positions, if there are any.
    pub fn monitored<S>(self, system: &S) -> Self
    where
        S: Monitored<f64, N> + ?Sized,
    {
        let start = self.samples.first().map_or(0.0, |(t, state)| system.energy(t, state));
        let mut samples = self.samples.iter();
        let is_constrained = samples.any(|(t, state)| system.residual(t, state) != 0.0);
        let page = self
            .panel("energy")
            .curve("h", |t, state| system.energy(t, state))
            .panel("energy since the start")
            .curve("h - h(0)", |t, state| system.energy(t, state) - start);
        if !is_constrained {
            return page;
        }
        page.panel("residual of the constraints").curve("largest", |t, state| system.residual(t, state))
    }

    /// Curves of what is left of each constraint, by its name in the declaration: for a panel that is folded until somebody asks.
    ///
    /// A generated system has the names and the values: `Residuals::NAMES`, and the method `residuals` of what was prepared. Those of
    /// velocity constraints say how well the velocities keep them, those of holonomic ones how far the coordinates have drifted.
    ///
    /// ```
    /// use guen_study::{Recording, Viewer};
    ///
    /// // A point on the unit circle, in steps of Euler's method.
    /// let mut recording = Recording::new(&["x", "y"]);
    /// let mut state = [1.0, 0.0];
    /// for k in 0..100 {
    ///     recording.record(0.01 * f64::from(k), &state);
    ///     state = [state[0] - 0.01 * state[1], state[1] + 0.01 * state[0]];
    /// }
    /// let page = Viewer::new("Drift", &recording).residuals(&["circle"], |_, [x, y]| [x * x + y * y - 1.0]);
    /// assert!(page.to_html()?.contains(r#""name":"residuals of the constraints","folded":1"#));
    /// # Ok::<(), guen_study::StudyError>(())
    /// ```
    pub fn residuals<const K: usize>(
        mut self,
        names: &[&str; K],
        values: impl Fn(f64, &[f64; N]) -> [f64; K],
    ) -> Self {
        self = self.panel("residuals of the constraints").folded();
        for (i, name) in names.iter().enumerate() {
            self = self.curve(*name, |t, state| values(t, state)[i]);
        }
        self
    }

    /// A force, or another vector that is no length, as an arrow from a moving point: its foot, and the vector in its own unit.
    ///
    /// Arrows of forces have one scale, with which the largest of them is seen: a quarter of the space that the motion takes up.
    /// The page says the scale. An input, a reaction and a weight are shown by it;
    /// [`arrow`](Viewer::arrow) is for vectors in lengths of the motion.
    ///
    /// ```
    /// use guen_study::{Pose, Recording, Shape, Viewer};
    ///
    /// let mut recording = Recording::new(&["x"]);
    /// (0..100).for_each(|k| recording.record(f64::from(k), &[0.01 * f64::from(k)]));
    /// // A weight of 9.81 mN on a motion of a metre.
    /// let page = Viewer::new("A weight", &recording)
    ///     .body("bead", [Shape::sphere(0.05)], |_, x| Pose::at([x[0], 0.0, 0.5]))
    ///     .force("weight in N", |_, x| [[x[0], 0.0, 0.5], [0.0, 0.0, -0.00981]])
    ///     .to_html()?;
    /// assert!(page.contains("Arrows of forces"));
    /// # Ok::<(), guen_study::StudyError>(())
    /// ```
    pub fn force(
        mut self,
        name: impl Into<String>,
        foot_and_vector: impl FnMut(f64, &[f64; N]) -> [[f64; 3]; 2],
    ) -> Self {
        let name = name.into();
        let ends = self.sampled(&name, foot_and_vector, |ends| is_drawable(ends.as_flattened()));
        self.links.push(Link { name, kind: LinkKind::Force, radius: 0.0, ends });
        fit::relieve(&mut self);
        self
    }
}
