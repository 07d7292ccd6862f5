//! Contacts of a motion through modes on its page: where they are, and the forces there.

use super::{Fault, Viewer};
use crate::modes::ExportModes;

/// The place of a contact, and the directions along which its gap and its slip grow, for [`Viewer::contact`].
///
/// ```
/// use guen_study::ContactFrame;
///
/// // The lowest point of a wheel of radius 0.3 that rolls along `x` on the plane `x, y`.
/// let frame = |x: f64, y: f64| ContactFrame::at([x, y - 0.3, 0.0]).normal([0.0, 1.0, 0.0]).along([1.0, 0.0, 0.0]);
/// assert_eq!(frame(2.0, 0.3), frame(2.0, 0.3));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactFrame {
    point: [f64; 3],
    normal: [f64; 3],
    tangents: [[f64; 3]; 2],
}

impl ContactFrame {
    /// A contact at a point, without directions yet: what has none has no arrow.
    #[must_use]
    pub fn at(point: [f64; 3]) -> Self {
        Self { point, normal: [0.0; 3], tangents: [[0.0; 3]; 2] }
    }

    /// The direction of the normal force: that in which the point moves when the gap grows at a rate of one.
    #[must_use]
    pub fn normal(self, direction: [f64; 3]) -> Self {
        Self { normal: direction, ..self }
    }

    /// The direction of a slip of one, or of the first component of the slip.
    #[must_use]
    pub fn along(mut self, direction: [f64; 3]) -> Self {
        self.tangents[0] = direction;
        self
    }

    /// The direction of the second component of the slip.
    #[must_use]
    pub fn across(mut self, direction: [f64; 3]) -> Self {
        self.tangents[1] = direction;
        self
    }
}

impl<const N: usize> Viewer<'_, N> {
    /// The forces of a declared contact, grip or latch as arrows from its point: the normal force, and the friction if it has a slip. The track of
    /// the point is drawn with them. Arrows have the scale of [`force`](Viewer::force), and vanish where the contact is open.
    ///
    /// A gap is a number, so that the page cannot know where it is: the function says it. A name that no contact has is an error when the
    /// page is made.
    ///
    /// ```
    /// use guen_runtime::hybrid::{Element, FreeMotion, HybridSystem, Mode, Signal};
    /// use guen_runtime::{Bodies, Body, Lift, Monitored, Real, Simulate, System};
    /// use guen_study::{ContactFrame, ExportModes, Recording, Viewer};
    /// # #[derive(Clone, Copy)]
    /// # struct Ball;
    /// # impl System<f64, 2> for Ball {
    /// #     fn rhs(&self, _t: f64, &[_, v]: &[f64; 2]) -> [f64; 2] {
    /// #         [v, -9.81]
    /// #     }
    /// # }
    /// # impl Simulate<f64, 2> for Ball {
    /// #     type State = [f64; 2];
    /// #     const STATES: &'static [&'static str] = &["z", "v"];
    /// # }
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
    /// // `Ball` is a declared system with the contact `floor`.
    /// let motion = HybridSystem::simulate(&Ball, &[0.2, 0.0], 0.0..1.5).unwrap();
    /// let played = motion.played();
    /// let floor = |_: f64, &[_, _]: &[f64; 2]| ContactFrame::at([0.0; 3]).normal([0.0, 0.0, 1.0]);
    /// let page = Viewer::new("A ball", &played).contact(&motion, "floor", floor).to_html()?;
    /// assert!(page.contains(r#""name":"force of floor","kind":"arrow""#));
    /// assert!(Viewer::new("A ball", &played).contact(&motion, "flor", floor).to_html().is_err());
    /// # Ok::<(), guen_study::StudyError>(())
    /// ```
    pub fn contact<H>(
        mut self,
        motion: &impl ExportModes<H, N>,
        name: &str,
        frame: impl Fn(f64, &[f64; N]) -> ContactFrame,
    ) -> Self {
        let Some(kinds) = motion.kinds_of_forces(name) else {
            let known = motion.contacts();
            self.fault.get_or_insert_with(|| Fault::UnknownContact { name: name.to_owned(), known });
            return self;
        };
        self = self.path(name, |t, x| frame(t, x).point);
        let [normal, friction] = kinds;
        let whole = format!("force of {name}");
        let [normal_name, friction_name] = if normal && friction {
            [format!("normal force of {name}"), format!("friction of {name}")]
        } else {
            [whole.clone(), whole]
        };
        let at = |t| motion.reaction_of(name, t).unwrap_or_default();
        if normal {
            self = self.force(normal_name, |t, x| {
                let frame = frame(t, x);
                [frame.point, frame.normal.map(|entry| at(t)[0] * entry)]
            });
        }
        if friction {
            self = self.force(friction_name, |t, x| {
                let (frame, [_, along, across]) = (frame(t, x), at(t));
                let [a, b] = frame.tangents;
                [frame.point, std::array::from_fn(|i| along * a[i] + across * b[i])]
            });
        }
        self
    }
}
