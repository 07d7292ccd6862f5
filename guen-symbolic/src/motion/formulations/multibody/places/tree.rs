//! The tree of axes and points in numbered expressions, and what hangs on it, regrouped.

use super::axes::AllAxes;
use super::combinations::rates_of_coordinates;
use super::pins::{Pins, in_world};
use super::points::{Point, Points, Terms};
use super::rotations::Vector;
use super::shifts::Turned;
use crate::algebra::ExprId;
use crate::motion::Mechanics;
use crate::motion::graph::{FrameId, Place};
use crate::motion::quasi_velocities::velocity_forms::VelocityPartials;
use crate::numbering::{Num, Numbering};
use crate::workbench::Workbench;

pub(in crate::motion) type Vec3 = [Num; 3];
pub(in crate::motion) type Mat3 = [Vec3; 3];

/// A form in the rates of coordinates.
#[derive(Clone, Debug, Default)]
pub(in crate::motion) struct RateForm {
    /// Coordinates with coefficients.
    pub(in crate::motion) terms: Vec<(usize, Num)>,
    /// The value at rest.
    pub(in crate::motion) offset: Option<Num>,
}

/// The turn of axes against their parent's.
#[derive(Clone, Debug)]
pub(in crate::motion) enum Turn {
    World,
    /// About a coordinate axis: cosine, sine, and the rate of the angle.
    About {
        axis: usize,
        cosine: Num,
        sine: Num,
        rate: RateForm,
    },
    /// A turn by any rotation: the matrix to the parent's axes, and the spin against the parent.
    By {
        matrix: Mat3,
        spin: [RateForm; 3],
    },
}

pub(in crate::motion) struct AxesNode {
    pub(in crate::motion) parent: usize,
    pub(in crate::motion) turn: Turn,
}

pub(in crate::motion) struct PointNode {
    pub(in crate::motion) axes: usize,
    pub(in crate::motion) parent: usize,
    /// The vector from the parent's origin, in the axes of the parent.
    pub(in crate::motion) offset: Vec3,
    /// The rate in these axes, where it is not constant.
    pub(in crate::motion) rate: Option<[RateForm; 3]>,
    /// The vector that turns, where the place moves by that alone.
    pub(in crate::motion) arm: Option<Arm>,
}

/// A vector that is constant in axes which hang on those of a point.
pub(in crate::motion) struct Arm {
    pub(in crate::motion) axes: usize,
    pub(in crate::motion) vector: Vec3,
    /// The rate in space by the spin of the axes, along those of the point.
    pub(in crate::motion) by_spin: Mat3,
}

/// The mass that moves with axes: about the origin of a point, or about any.
#[derive(Clone, Debug)]
pub(in crate::motion) struct Content {
    pub(in crate::motion) axes: usize,
    pub(in crate::motion) point: Option<usize>,
    pub(in crate::motion) mass: Num,
    pub(in crate::motion) moment: Vec3,
    /// `xx, yy, zz, xy, yz, zx` about the point.
    pub(in crate::motion) inertia: [Num; 6],
}

/// A body or particle where it was declared, in its axes.
pub(in crate::motion) struct Seat {
    pub(in crate::motion) axes: usize,
    pub(in crate::motion) point: Option<usize>,
    pub(in crate::motion) mass: Num,
    /// The mass centre, seen from the point.
    pub(in crate::motion) center: Vec3,
    /// `xx, yy, zz, xy, yz, zx` about the mass centre.
    pub(in crate::motion) inertia: [Num; 6],
}

/// The tree.
pub(in crate::motion) struct Tree {
    pub(in crate::motion) all: AllAxes,
    pub(super) origins: Points,
    pub(in crate::motion) axes: Vec<AxesNode>,
    pub(in crate::motion) points: Vec<PointNode>,
    pub(in crate::motion) seats: Vec<Seat>,
    pub(in crate::motion) contents: Vec<Content>,
    /// The turns of general axes, whatever these hang on.
    pub(in crate::motion) spins: Vec<DeclaredSpin>,
    pub(in crate::motion) pins: Vec<PinNode>,
}

/// The turn of general axes as it is declared.
pub(in crate::motion) struct DeclaredSpin {
    pub(in crate::motion) axes: usize,
    /// The axes against which they are declared.
    pub(in crate::motion) against: usize,
    /// The matrix to these.
    pub(in crate::motion) matrix: Mat3,
    /// The spin against these, in their own axes, by the rates of coordinates.
    pub(in crate::motion) spin: [RateForm; 3],
}

impl DeclaredSpin {
    /// The coordinates in whose rates the spin is written.
    pub(in crate::motion) fn coordinates(&self) -> impl Iterator<Item = usize> {
        self.spin.iter().flat_map(|form| form.terms.iter().map(|(i, _)| *i))
    }
}

/// A point whose coordinates follow from where it is pinned: `c p' + q' + sum of w x r = 0`.
pub(in crate::motion) struct PinNode {
    /// The coordinates of the point, by component.
    pub(in crate::motion) point: [Option<usize>; 3],
    /// The factor `c` of the point.
    pub(in crate::motion) factor: Num,
    /// The rates of what else is given in the world, `q'`.
    pub(in crate::motion) others: [RateForm; 3],
    /// Vectors `r` that are constant in axes.
    pub(in crate::motion) arms: Vec<(usize, Vec3)>,
}

impl Tree {
    /// The tree of a system's bodies.
    pub(in crate::motion) fn new(
        bench: &mut Workbench,
        numbers: &mut Numbering,
        system: &Mechanics,
        partials: &mut VelocityPartials,
    ) -> Option<Self> {
        let structure = &system.structure;
        let mut all = AllAxes::new(bench, structure)?;
        if all.general.len() > 1 && !system.holonomic.is_empty() {
            let rates = rates_of_coordinates(bench, numbers, system)?;
            all.settle_neighbours(bench, numbers, partials, &rates)?;
        }
        let pins = Pins::new(bench, system);
        let mut seats: Vec<(usize, Option<Terms>)> = Vec::new();
        for body in &structure.bodies {
            let center = body.center.as_ref().map(|center| pins.reduced(bench, center));
            let terms = center.map(|center| all.terms(bench, &center));
            // A particle is seen in the youngest axes of its place.
            let youngest = terms.iter().flatten().map(|(axes, _)| *axes).max().unwrap_or(0);
            let axes = body.frame.map_or(youngest, |frame| all.of(frame));
            if let Some(terms) = &terms {
                all.settle(bench, axes, terms);
            }
            seats.push((axes, terms));
        }
        let mut tree = Tree {
            all,
            origins: Points::new(bench),
            axes: Vec::new(),
            points: Vec::new(),
            seats: Vec::new(),
            contents: Vec::new(),
            spins: Vec::new(),
            pins: Vec::new(),
        };
        let mut loaded = Vec::new();
        for (body, (axes, terms)) in structure.bodies.iter().zip(seats) {
            let located = terms.map(|terms| tree.origins.locate(bench, &tree.all, axes, &terms));
            loaded.push((body, axes, located));
        }
        tree.number_axes(bench, numbers, system, partials);
        tree.number_points(bench, numbers, system);
        tree.number_pins(bench, numbers, system, &pins);
        for (body, axes, located) in loaded {
            let zero = bench.graph.zero();
            let tensor = match body.frame {
                Some(frame) => tree.all.tensor(bench, frame, &body.inertia),
                None => [zero; 6],
            };
            tree.load(bench, numbers, axes, located, body.mass, &tensor);
        }
        Some(tree)
    }

    fn number_axes(
        &mut self,
        bench: &mut Workbench,
        numbers: &mut Numbering,
        system: &Mechanics,
        partials: &mut VelocityPartials,
    ) {
        for turn in &self.all.general {
            let matrix = turn.matrix.map(|row| row.map(|e| numbers.import(bench, e)));
            let spin = turn.spin.map(|e| form_of(bench, numbers, partials, e));
            self.spins.push(DeclaredSpin { axes: turn.axes, against: turn.against, matrix, spin });
        }
        for (place, axes) in self.all.list.iter().enumerate() {
            let own = self.spins.iter().find(|found| found.axes == place);
            let turn = match &axes.turned {
                Turned::World => Turn::World,
                Turned::About { axis, turn, angle, .. } => {
                    let [cosine, sine] = turn.map(|e| numbers.import(bench, e));
                    let rate = angle.map(|angle| rate_of(bench, numbers, system, angle)).unwrap_or_default();
                    Turn::About { axis: *axis, cosine, sine, rate }
                }
                Turned::By { matrix, spin } => {
                    let other = self.spins.iter().find(|found| found.axes == axes.parent);
                    let matrix = match (own, other) {
                        // Against the neighbour: the product of the turns against the parent of both.
                        (Some(own), Some(other)) if own.against != axes.parent => {
                            let (back, images) = (columns(&other.matrix), columns(&own.matrix));
                            back.map(|row| images.map(|image| numbers.dot(&row, &image)))
                        }
                        _ => matrix.map(|row| row.map(|e| numbers.import(bench, e))),
                    };
                    let spin = spin.map(|e| form_of(bench, numbers, partials, e));
                    Turn::By { matrix, spin }
                }
            };
            self.axes.push(AxesNode { parent: axes.parent, turn });
        }
    }

    /// Numbers the pins whose levers are constant.
    fn number_pins(
        &mut self,
        bench: &mut Workbench,
        numbers: &mut Numbering,
        system: &Mechanics,
        pins: &Pins,
    ) {
        for pin in &pins.list {
            let index = |x: ExprId| system.forms.coordinates.iter().position(|y| *y == x);
            let point = pin.point.map(|x| x.and_then(index));
            let world = in_world(bench, &pin.declared);
            let mut others = world.map(|e| rate_of(bench, numbers, system, e));
            for (form, own) in others.iter_mut().zip(point) {
                form.terms.retain(|(i, _)| Some(*i) != own);
            }
            let mut terms = self.all.terms(bench, &pin.declared);
            terms.retain(|(axes, _)| *axes > 0);
            if terms.iter().flat_map(|(_, v)| v).any(|e| !bench.graph.roles(*e).is_constant()) {
                continue;
            }
            let arms =
                terms.into_iter().map(|(axes, v)| (axes, v.map(|e| numbers.import(bench, e)))).collect();
            let factor = numbers.import(bench, pin.factor);
            self.pins.push(PinNode { point, factor, others, arms });
        }
    }

    /// A vector of axes in the world, by the turns that are declared.
    pub(in crate::motion) fn in_world(&self, numbers: &mut Numbering, axes: usize, v: &Vec3) -> Vec3 {
        let (mut place, mut v) = (axes, *v);
        while place > 0 {
            match self.spins.iter().find(|found| found.axes == place) {
                Some(DeclaredSpin { matrix, against, .. }) => {
                    v = matrix.map(|row| numbers.dot(&row, &v));
                    place = *against;
                }
                None => {
                    v = self.inwards(numbers, place, &v);
                    place = self.axes[place].parent;
                }
            }
        }
        v
    }

    /// Numbers the points that have none yet.
    fn number_points(&mut self, bench: &mut Workbench, numbers: &mut Numbering, system: &Mechanics) {
        for point in &self.origins.list[self.points.len()..] {
            let offset = point.offset.map(|e| numbers.import(bench, e));
            let rate = point.slides.then(|| point.offset.map(|e| rate_of(bench, numbers, system, e)));
            let arm = point.arm.map(|(axes, vector)| {
                let vector = vector.map(|e| numbers.import(bench, e));
                let mut columns = [[Num::ZERO; 3]; 3];
                for (r, column) in columns.iter_mut().enumerate() {
                    let mut unit = [Num::ZERO; 3];
                    unit[r] = Num::ONE;
                    let turned = cross(numbers, &unit, &vector);
                    *column = self.seen_in(numbers, point.axes, axes, &turned);
                }
                Arm { axes, vector, by_spin: [0, 1, 2].map(|q| columns.map(|column| column[q])) }
            });
            self.points.push(PointNode { axes: point.axes, parent: point.parent, offset, rate, arm });
        }
    }

    /// The point and the offset of a place in the youngest axes of its terms, or in axes that are given.
    pub(in crate::motion) fn locate(
        &mut self,
        bench: &mut Workbench,
        numbers: &mut Numbering,
        system: &Mechanics,
        place: &Place,
        axes: Option<usize>,
    ) -> (usize, Vec3) {
        let terms = self.all.terms(bench, place);
        let axes = axes.unwrap_or_else(|| terms.iter().map(|(axes, _)| *axes).max().unwrap_or(0));
        let (point, offset) = self.origins.locate(bench, &self.all, axes, &terms);
        self.number_points(bench, numbers, system);
        (point, offset.map(|e| numbers.import(bench, e)))
    }

    /// The point at a place, in axes on which it is fixed.
    pub(in crate::motion) fn point_at(
        &mut self,
        bench: &mut Workbench,
        numbers: &mut Numbering,
        system: &Mechanics,
        place: &Place,
        axes: usize,
    ) -> usize {
        let terms = self.all.terms(bench, place);
        let (parent, offset) = self.origins.locate(bench, &self.all, axes, &terms);
        let point = self.origins.push(Point { axes, parent, offset, slides: false, arm: None });
        self.number_points(bench, numbers, system);
        point
    }

    fn load(
        &mut self,
        bench: &mut Workbench,
        numbers: &mut Numbering,
        axes: usize,
        located: Option<(usize, Vector)>,
        mass: ExprId,
        tensor: &[ExprId; 6],
    ) {
        let own = tensor.map(|e| numbers.import(bench, e));
        let mut seat = Seat { axes, point: None, mass: Num::ZERO, center: [Num::ZERO; 3], inertia: own };
        if let Some((point, center)) = located {
            seat.point = Some(point);
            seat.mass = numbers.import(bench, mass);
            seat.center = center.map(|e| numbers.import(bench, e));
        }
        let Seat { point, mass, center, inertia, .. } = &seat;
        let moment = center.map(|e| numbers.mul(*mass, e));
        let steiner = about(numbers, &moment, center);
        let inertia = [0, 1, 2, 3, 4, 5].map(|i| numbers.add(inertia[i], steiner[i]));
        self.put(numbers, Content { axes, point: *point, mass: *mass, moment, inertia });
        self.seats.push(seat);
    }

    /// Adds to what a point carries.
    pub(in crate::motion) fn put(&mut self, numbers: &mut Numbering, content: Content) {
        let same = |known: &&mut Content| known.axes == content.axes && known.point == content.point;
        match self.contents.iter_mut().find(same) {
            Some(known) => {
                known.mass = numbers.add(known.mass, content.mass);
                known.moment = [0, 1, 2].map(|i| numbers.add(known.moment[i], content.moment[i]));
                known.inertia = [0, 1, 2, 3, 4, 5].map(|i| numbers.add(known.inertia[i], content.inertia[i]));
            }
            None => self.contents.push(content),
        }
    }

    /// Whether a point is where the one is that it is seen from.
    pub(in crate::motion) fn is_at_rest(&self, point: usize) -> bool {
        let node = &self.points[point];
        node.rate.is_none() && node.offset.iter().all(|e| e.is_zero())
    }

    /// Whether a point is fixed in the axes of the one that it is seen from: one of which forms alone speak.
    pub(in crate::motion) fn is_end(&self, point: usize) -> bool {
        let node = &self.points[point];
        point > 0 && node.axes == self.points[node.parent].axes && node.rate.is_none() && node.arm.is_none()
    }

    /// Whether general axes hang on others than those against which they are declared.
    pub(in crate::motion) fn has_neighbours(&self) -> bool {
        self.spins.iter().any(|declared| self.axes[declared.axes].parent != declared.against)
    }

    /// The axes of a frame.
    pub(in crate::motion) fn axes_of(&self, frame: FrameId) -> usize {
        self.all.of(frame)
    }

    /// Terms of a place by axes, in numbered expressions.
    pub(in crate::motion) fn terms(
        &self,
        bench: &mut Workbench,
        numbers: &mut Numbering,
        place: &Place,
    ) -> Vec<(usize, Vec3)> {
        let terms = self.all.terms(bench, place);
        terms.into_iter().map(|(axes, v)| (axes, v.map(|e| numbers.import(bench, e)))).collect()
    }

    /// A vector in the axes of a parent's, of axes.
    pub(in crate::motion) fn outwards(&self, numbers: &mut Numbering, axes: usize, v: &Vec3) -> Vec3 {
        match &self.axes[axes].turn {
            Turn::World => *v,
            Turn::About { axis, cosine, sine, .. } => turned(numbers, *axis, *cosine, *sine, v),
            Turn::By { matrix, .. } => {
                [0, 1, 2].map(|q| numbers.dot(&[matrix[0][q], matrix[1][q], matrix[2][q]], v))
            }
        }
    }

    /// A vector of axes in those of their parent.
    pub(in crate::motion) fn inwards(&self, numbers: &mut Numbering, axes: usize, v: &Vec3) -> Vec3 {
        match &self.axes[axes].turn {
            Turn::World => *v,
            Turn::About { axis, cosine, sine, .. } => turned(numbers, *axis, *cosine, sine.neg(), v),
            Turn::By { matrix, .. } => matrix.map(|row| numbers.dot(&row, v)),
        }
    }

    /// A vector of some axes seen in others.
    pub(in crate::motion) fn seen_in(
        &self,
        numbers: &mut Numbering,
        axes: usize,
        from: usize,
        v: &Vec3,
    ) -> Vec3 {
        let (mut place, mut v) = (from, *v);
        while !self.all.hangs_on(axes, place) {
            v = self.inwards(numbers, place, &v);
            place = self.axes[place].parent;
        }
        let mut way = Vec::new();
        let mut target = axes;
        while target != place {
            way.push(target);
            target = self.axes[target].parent;
        }
        for axes in way.into_iter().rev() {
            v = self.outwards(numbers, axes, &v);
        }
        v
    }
}

/// `R^T v` for a turn about a coordinate axis.
pub(super) fn turned(numbers: &mut Numbering, axis: usize, cosine: Num, sine: Num, v: &Vec3) -> Vec3 {
    let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut image = *v;
    let (a, b) = (numbers.mul(cosine, v[i]), numbers.mul(sine, v[j]));
    image[i] = numbers.add(a, b);
    let (a, b) = (numbers.mul(cosine, v[j]), numbers.mul(sine, v[i]));
    image[j] = numbers.sub(a, b);
    image
}

/// `[alpha]x + [omega]x [omega]x`: the acceleration of a point that is fixed in axes, for its place there.
pub(in crate::motion) fn gradient(n: &mut Numbering, w: &Vec3, alpha: &Vec3) -> [Vec3; 3] {
    let [xx, yy, zz] = w.map(|e| n.square(e));
    let (xy, yz, zx) = (n.mul(w[0], w[1]), n.mul(w[1], w[2]), n.mul(w[2], w[0]));
    [
        [n.add(yy, zz).neg(), n.sub(xy, alpha[2]), n.add(zx, alpha[1])],
        [n.add(xy, alpha[2]), n.add(zz, xx).neg(), n.sub(yz, alpha[0])],
        [n.sub(zx, alpha[1]), n.add(yz, alpha[0]), n.add(xx, yy).neg()],
    ]
}

pub(in crate::motion) fn cross(numbers: &mut Numbering, a: &Vec3, b: &Vec3) -> Vec3 {
    [0, 1, 2].map(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let (plus, minus) = (numbers.mul(a[j], b[k]), numbers.mul(a[k], b[j]));
        numbers.sub(plus, minus)
    })
}

pub(in crate::motion) fn plus(numbers: &mut Numbering, a: &Vec3, b: &Vec3) -> Vec3 {
    [0, 1, 2].map(|i| numbers.add(a[i], b[i]))
}

pub(in crate::motion) fn columns(m: &Mat3) -> Mat3 {
    [0, 1, 2].map(|q| m.map(|row| row[q]))
}

/// `(h.r) 1 - h r^T` for `h = m r`: the inertia of a mass away from a point.
pub(in crate::motion) fn about(numbers: &mut Numbering, h: &Vec3, r: &Vec3) -> [Num; 6] {
    let squares = [0, 1, 2].map(|i| numbers.mul(h[i], r[i]));
    let products = [(0, 1), (1, 2), (2, 0)].map(|(i, k)| numbers.mul(h[i], r[k]));
    [
        numbers.add(squares[1], squares[2]),
        numbers.add(squares[2], squares[0]),
        numbers.add(squares[0], squares[1]),
        products[0].neg(),
        products[1].neg(),
        products[2].neg(),
    ]
}

/// `2 (h.r) 1 - h r^T - r h^T`.
pub(in crate::motion) fn shifted(numbers: &mut Numbering, h: &Vec3, r: &Vec3) -> [Num; 6] {
    let diagonal = [0, 1, 2].map(|i| {
        let product = numbers.mul(h[i], r[i]);
        numbers.add(product, product)
    });
    let products = [(0, 1), (1, 2), (2, 0)].map(|(i, k)| {
        let (a, b) = (numbers.mul(h[i], r[k]), numbers.mul(r[i], h[k]));
        numbers.add(a, b).neg()
    });
    [
        numbers.add(diagonal[1], diagonal[2]),
        numbers.add(diagonal[2], diagonal[0]),
        numbers.add(diagonal[0], diagonal[1]),
        products[0],
        products[1],
        products[2],
    ]
}

/// The rate of a function of time and coordinates.
fn rate_of(bench: &mut Workbench, numbers: &mut Numbering, system: &Mechanics, e: ExprId) -> RateForm {
    let mut form = RateForm::default();
    for (i, x) in system.forms.coordinates.iter().enumerate() {
        let slope = bench.partial(e, *x);
        let slope = numbers.import(bench, slope);
        if !slope.is_zero() {
            form.terms.push((i, slope));
        }
    }
    let slope = bench.partial(e, system.forms.time);
    form.offset = Some(numbers.import(bench, slope)).filter(|e| !e.is_zero());
    form
}

/// A form linear in the velocities.
fn form_of(
    bench: &mut Workbench,
    numbers: &mut Numbering,
    partials: &mut VelocityPartials,
    e: ExprId,
) -> RateForm {
    let Some(form) = partials.affine(bench, e) else { return RateForm::default() };
    let terms = form.on_velocities.iter().map(|(i, b)| (*i, numbers.import(bench, *b))).collect();
    let offset = Some(numbers.import(bench, form.offset)).filter(|e| !e.is_zero());
    RateForm { terms, offset }
}
