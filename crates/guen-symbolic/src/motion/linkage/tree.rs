//! Which link hangs on which: bodies and particles as a tree of axes, each posed in another by few coordinates.
//!
//! Nothing is asked of how they were written. Of two orientations `R_p`, `R_b` the relative one `R_p^T R_b` is looked for
//! as a function of the coordinates that `R_b` has and `R_p` has not: all others are put at values for which the
//! constraints hold, and what comes out is compared with what was declared.

use super::vector::{self, Matrix, Vector};
use crate::algebra::{ExprId, Flow, Substitution};
use crate::motion::velocity_forms::VelocityPartials;
use crate::motion::{Frame, Mechanics, RigidBody};
use crate::workbench::Workbench;

/// A set of axes with an origin. The first of a tree are those of the world.
pub(super) struct Link {
    /// The axes in which this one is posed; older.
    pub(super) parent: usize,
    /// From these axes to the parent's.
    pub(super) rotation: Matrix,
    /// The origin, in the parent's axes.
    pub(super) offset: Vector,
    /// The motion in the parent, `s = 0..l`, in these axes: angular velocity and that of the origin along `X_s`; only
    /// those that do not vanish.
    pub(super) along: Vec<(usize, Vector, Vector)>,
    /// Mass, first moment and moments of second order about the origin, of what moves with the link.
    pub(super) mass: ExprId,
    pub(super) moment: Vector,
    pub(super) inertia: Matrix,
}

/// Where axes are in the world, and which variables that is written in.
struct Pose {
    rotation: Matrix,
    origin: Vector,
    variables: Vec<ExprId>,
}

pub(in crate::motion) struct Tree<'a> {
    pub(super) links: Vec<Link>,
    poses: Vec<Pose>,
    system: &'a Mechanics,
    /// Time and coordinates.
    variables: Vec<ExprId>,
}

impl<'a> Tree<'a> {
    /// The tree of the bodies; `None` where they turn about one axis or not at all, where poses were not found in each
    /// other, or where no link hangs on a link.
    pub(super) fn new(
        bench: &mut Workbench,
        system: &'a Mechanics,
        frame: &Frame,
        partials: &mut VelocityPartials,
    ) -> Option<Self> {
        let bodies = &system.multibody.as_ref()?.bodies;
        let unit = vector::identity(&bench.graph);
        let mut axes = 0..3;
        if axes.any(|k| bodies.iter().filter_map(|body| body.orientation).all(|turned| turned[k] == unit[k]))
        {
            return None;
        }
        let graph = &bench.graph;
        let zero = vector::zero(graph);
        let world = Link {
            parent: 0,
            rotation: unit,
            offset: zero,
            along: Vec::new(),
            mass: graph.zero(),
            moment: zero,
            inertia: [zero; 3],
        };
        let pose = Pose { rotation: unit, origin: zero, variables: Vec::new() };
        let variables = system.forms.coordinates.iter().copied().chain([system.forms.time]).collect();
        let mut tree = Tree { links: vec![world], poses: vec![pose], system, variables };
        for body in bodies {
            tree.hang(bench, frame, partials, body)?;
        }
        tree.links.iter().any(|link| link.parent > 0).then_some(tree)
    }

    /// How many links hang on links.
    pub(in crate::motion) fn joints(&self) -> usize {
        self.links.iter().filter(|link| link.parent > 0).count()
    }

    /// The coordinates, and time, that expressions are written in.
    fn occurring(&self, bench: &Workbench, es: impl IntoIterator<Item = ExprId>) -> Vec<ExprId> {
        let roots: Vec<ExprId> = es.into_iter().collect();
        let symbols = bench.graph.symbols_in(&roots);
        let symbols = symbols.into_iter().map(|symbol| bench.graph.symbol_expr(symbol));
        symbols.filter(|symbol| self.variables.contains(symbol)).collect()
    }

    fn hang(
        &mut self,
        bench: &mut Workbench,
        frame: &Frame,
        partials: &mut VelocityPartials,
        body: &RigidBody,
    ) -> Option<()> {
        let rotation = body.orientation;
        let entries = rotation.iter().flatten().flatten().chain(body.center.iter().flatten()).copied();
        let own = self.occurring(bench, entries);
        // In the axes that leave the fewest variables; of these the youngest.
        let left = |pose: &Pose| own.iter().filter(|x| !pose.variables.contains(x)).count();
        let mut parents: Vec<(usize, usize)> = Vec::new();
        for (place, pose) in self.poses.iter().enumerate().rev() {
            if pose.variables.iter().all(|x| own.contains(x)) {
                parents.push((left(pose), place));
            }
        }
        parents.sort_by_key(|(left, _)| *left);
        parents.into_iter().find_map(|(_, parent)| self.hang_on(bench, frame, partials, body, parent))
    }

    fn hang_on(
        &mut self,
        bench: &mut Workbench,
        frame: &Frame,
        partials: &mut VelocityPartials,
        body: &RigidBody,
        parent: usize,
    ) -> Option<()> {
        let pose = &self.poses[parent];
        let turned = body.orientation.unwrap_or(pose.rotation);
        let center = body.center.unwrap_or(pose.origin);
        let has = |e: &ExprId| pose.variables.contains(e);
        let fixed: Vec<ExprId> = self.variables.iter().copied().filter(has).collect();
        let mut resting = self.resting(bench, &fixed);
        // R_p^T R_b and R_p^T (c_b - o_p), of the variables that are left.
        let rotation_there = pose.rotation.map(|row| row.map(|e| resting.of(&mut bench.graph, e)));
        let turned_there = turned.map(|row| row.map(|e| resting.of(&mut bench.graph, e)));
        let away = vector::minus(&mut bench.graph, &center, &pose.origin);
        let away_there = away.map(|e| resting.of(&mut bench.graph, e));
        let back = vector::transposed(&rotation_there);
        let relative = vector::product(&mut bench.graph, &back, &turned_there);
        let relative = relative.map(|row| row.map(|e| bench.tidy(e)));
        let offset = vector::applied(&mut bench.graph, &back, &away_there);
        let offset = offset.map(|e| bench.tidy(e));
        if !self.is_pose(bench, parent, (&turned, &center), (&relative, &offset)) {
            return None;
        }
        let moving = self.occurring(bench, relative.iter().flatten().copied());
        // The origin where an axis of the turn is, if there is one that stays.
        let arm = self.arm(bench, &relative, &offset, &moving);
        let turned_arm = vector::applied(&mut bench.graph, &relative, &arm);
        let origin = vector::minus(&mut bench.graph, &offset, &turned_arm).map(|e| bench.tidy(e));
        let is_fixed = self.occurring(bench, origin).is_empty();
        let (parent, origin) = if is_fixed || moving.is_empty() {
            (parent, origin)
        } else {
            // First to where the body is, then turned there.
            let axes = self.poses[parent].rotation;
            let unit = vector::identity(&bench.graph);
            let link = self.link(bench, frame, parent, (&axes, &center), unit, origin);
            (link, vector::zero(&bench.graph))
        };
        let arm_in_world = vector::applied(&mut bench.graph, &turned, &arm);
        let origin_in_world = vector::minus(&mut bench.graph, &center, &arm_in_world);
        let link = if moving.is_empty() && self.occurring(bench, origin).is_empty() {
            None
        } else {
            let link = self.link(bench, frame, parent, (&turned, &origin_in_world), relative, origin);
            // Seen from axes that do not turn the angular velocity is the declared one.
            let around = self.poses[self.links[link].parent].rotation;
            if let Some(spin) = body.spin
                && self.occurring(bench, around.into_iter().flatten()).is_empty()
            {
                self.spin_as_declared(bench, frame, partials, link, spin);
            }
            Some(link)
        };
        match link {
            Some(link) => {
                let unit = vector::identity(&bench.graph);
                self.load(bench, link, body, &unit, &arm);
            }
            // Fixed to its parent.
            None => self.load(bench, parent, body, &relative, &offset),
        }
        Some(())
    }

    /// Puts variables at numbers: zero, or where constraints on positions hold that are seen to for zeros and ones.
    fn resting(&self, bench: &mut Workbench, fixed: &[ExprId]) -> Substitution {
        let (zero, one) = (bench.graph.zero(), bench.graph.one());
        let mut values: Vec<(ExprId, ExprId)> = Vec::new();
        for constraint in &self.system.holonomic {
            let own = self.occurring(bench, [constraint.equation]);
            if !own.iter().any(|x| fixed.contains(x)) {
                continue;
            }
            // A quaternion without its vector, say.
            let chosen = own.iter().find_map(|chosen| {
                let values: Vec<(ExprId, ExprId)> =
                    own.iter().map(|x| (*x, if x == chosen { one } else { zero })).collect();
                let value =
                    Substitution::new(values.iter().copied()).of(&mut bench.graph, constraint.equation);
                bench.graph.is_zero(value).then_some(values)
            });
            values.extend(chosen.into_iter().flatten());
        }
        let others: Vec<_> =
            fixed.iter().filter(|x| values.iter().all(|(known, _)| known != *x)).copied().collect();
        values.extend(others.into_iter().map(|x| (x, zero)));
        values.retain(|(x, _)| fixed.contains(x));
        Substitution::new(values)
    }

    /// Whether a relative pose is one, of axes at right angles: at points modulo p, where the constraints on positions hold.
    fn is_pose(
        &self,
        bench: &mut Workbench,
        parent: usize,
        (turned, center): (&Matrix, &Vector),
        (relative, offset): (&Matrix, &Vector),
    ) -> bool {
        let pose = &self.poses[parent];
        let whole = vector::product(&mut bench.graph, &pose.rotation, relative);
        let back = vector::transposed(relative);
        let square = vector::product(&mut bench.graph, &back, relative);
        let unit = vector::identity(&bench.graph);
        let mut differences: Vec<ExprId> = Vec::new();
        for (a, b) in square.iter().flatten().zip(unit.iter().flatten()) {
            differences.push(bench.graph.sub(*a, *b));
        }
        for (a, b) in whole.iter().flatten().zip(turned.iter().flatten()) {
            differences.push(bench.graph.sub(*a, *b));
        }
        let reached = vector::applied(&mut bench.graph, &pose.rotation, offset);
        let reached = vector::sum(&mut bench.graph, [&reached, &pose.origin]);
        differences.extend(vector::minus(&mut bench.graph, &reached, center));
        let on_manifold = !self.system.holonomic.is_empty();
        (0..2).all(|sample| {
            let residues = bench.zero.residues(&mut bench.graph, sample, &differences, on_manifold);
            residues.is_some_and(|residues| residues.iter().all(|residue| *residue == 0))
        })
    }

    /// Where the body is seen from an origin that its turn leaves where it is, in its own axes: `b` with
    /// `R^T r' = e x b` for a turn about `e` by one coordinate; zero if there is none.
    fn arm(&self, bench: &mut Workbench, relative: &Matrix, offset: &Vector, moving: &[ExprId]) -> Vector {
        let none = vector::zero(&bench.graph);
        let [x] = moving else { return none };
        let (axis, velocity) = self.slope(bench, relative, offset, *x);
        if !self.occurring(bench, axis.iter().chain(&velocity).copied()).is_empty() {
            return none;
        }
        vector::cross(&mut bench.graph, &velocity, &axis).map(|e| bench.tidy(e))
    }

    /// Angular velocity and velocity of the origin for `x' = 1`, in the axes of the link.
    fn slope(
        &self,
        bench: &mut Workbench,
        rotation: &Matrix,
        offset: &Vector,
        x: ExprId,
    ) -> (Vector, Vector) {
        let mut by_x = Flow::partial(&bench.graph, x);
        let rates = rotation.map(|row| row.map(|e| by_x.of(&mut bench.graph, e)));
        let back = vector::transposed(rotation);
        let spin = vector::product(&mut bench.graph, &back, &rates);
        let spin = vector::axial(&mut bench.graph, &spin);
        let velocity = offset.map(|e| by_x.of(&mut bench.graph, e));
        let velocity = vector::applied(&mut bench.graph, &back, &velocity);
        (spin.map(|e| bench.tidy(e)), velocity.map(|e| bench.tidy(e)))
    }

    /// A further link, without mass.
    fn link(
        &mut self,
        bench: &mut Workbench,
        frame: &Frame,
        parent: usize,
        (turned, origin): (&Matrix, &Vector),
        rotation: Matrix,
        offset: Vector,
    ) -> usize {
        let l = self.system.forms.degrees;
        let moving = self.occurring(bench, rotation.iter().flatten().chain(&offset).copied());
        let slopes: Vec<(ExprId, Vector, Vector)> = moving
            .into_iter()
            .map(|x| {
                let (spin, velocity) = self.slope(bench, &rotation, &offset, x);
                (x, spin, velocity)
            })
            .collect();
        let mut along = Vec::new();
        for s in 0..=l {
            let parts = [false, true].map(|straight| {
                [0, 1, 2].map(|i| {
                    let terms: Vec<ExprId> = slopes
                        .iter()
                        .map(|(x, spin, velocity)| {
                            let rate = match self.system.forms.coordinates.iter().position(|known| known == x)
                            {
                                Some(place) => frame.operators.xi[s][place],
                                None if s == 0 => bench.graph.one(),
                                None => bench.graph.zero(),
                            };
                            bench.graph.mul(if straight { velocity[i] } else { spin[i] }, rate)
                        })
                        .collect();
                    let sum = bench.graph.sum(terms);
                    bench.tidy(sum)
                })
            });
            let [spin, velocity] = parts;
            if !vector::vanishes(&bench.graph, &spin) || !vector::vanishes(&bench.graph, &velocity) {
                along.push((s, spin, velocity));
            }
        }
        let entries = turned.iter().flatten().chain(origin).copied();
        let variables = self.occurring(bench, entries);
        let zero = vector::zero(&bench.graph);
        let mass = bench.graph.zero();
        self.links.push(Link { parent, rotation, offset, along, mass, moment: zero, inertia: [zero; 3] });
        self.poses.push(Pose { rotation: *turned, origin: *origin, variables });
        self.links.len() - 1
    }

    /// Angular velocities along the operators from the form that the declaration has.
    fn spin_as_declared(
        &mut self,
        bench: &mut Workbench,
        frame: &Frame,
        partials: &mut VelocityPartials,
        link: usize,
        declared: Vector,
    ) {
        let forms = declared.map(|e| partials.affine(bench, e));
        let [Some(x), Some(y), Some(z)] = forms else { return };
        let zero = vector::zero(&bench.graph);
        let mut along: Vec<(usize, Vector, Vector)> = Vec::new();
        for s in 0..=self.system.forms.degrees {
            let spin = [&x, &y, &z].map(|form| {
                let component = frame.component(bench, form, s);
                bench.tidy(component)
            });
            let known = self.links[link].along.iter().find(|(known, ..)| *known == s);
            let velocity = known.map_or(zero, |(_, _, velocity)| *velocity);
            if !vector::vanishes(&bench.graph, &spin) || !vector::vanishes(&bench.graph, &velocity) {
                along.push((s, spin, velocity));
            }
        }
        self.links[link].along = along;
    }

    /// Loads a link with a body whose axes and centre are at rest in it.
    fn load(&mut self, bench: &mut Workbench, link: usize, body: &RigidBody, axes: &Matrix, center: &Vector) {
        let graph = &mut bench.graph;
        let link = &mut self.links[link];
        if body.center.is_some() {
            link.mass = graph.add(link.mass, body.mass);
            let moment = vector::scaled(graph, body.mass, center);
            link.moment = vector::sum(graph, [&link.moment, &moment]);
            let own = about(graph, body.mass, center);
            link.inertia = [0, 1, 2].map(|i| vector::sum(graph, [&link.inertia[i], &own[i]]));
        }
        if body.orientation.is_some() {
            let [xx, yy, zz, xy, yz, zx] = body.inertia;
            let own = [[xx, xy, zx], [xy, yy, yz], [zx, yz, zz]];
            let turned = vector::product(graph, axes, &own);
            let turned = vector::product(graph, &turned, &vector::transposed(axes));
            link.inertia = [0, 1, 2].map(|i| vector::sum(graph, [&link.inertia[i], &turned[i]]));
        }
    }
}

/// `m (b^2 1 - b b^T)`.
pub(super) fn about(graph: &mut crate::algebra::Graph, mass: ExprId, b: &Vector) -> Matrix {
    let square = vector::dot(graph, b, b);
    [0, 1, 2].map(|i| {
        [0, 1, 2].map(|k| {
            let outer = graph.mul(b[i], b[k]);
            let straight = if i == k { square } else { graph.zero() };
            let difference = graph.sub(straight, outer);
            graph.mul(mass, difference)
        })
    })
}
