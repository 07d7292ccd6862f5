//! Forces on bodies that a displacement strains: see `strain`.

use super::assembly::Assembly;
use crate::motion::formulations::multibody::outwards::kinematics::Kinematics;
use crate::motion::formulations::multibody::places::shifts::Turned;
use crate::motion::formulations::multibody::places::tree::{Seat, Vec3, cross, plus};
use crate::motion::formulations::multibody::velocities::strain::{
    NOTHING, Strain, applied, displaced, displacement, own, turn,
};
use crate::motion::formulations::multibody::velocities::variables::Var;
use crate::motion::quasi_velocities::velocity_forms::VelocityPartials;
use crate::numbering::Rates;

impl Kinematics<'_> {
    /// `s`, in the axes of each point.
    fn strained_points(&mut self, strain: &Strain) -> Vec<Vec3> {
        let tree = self.tree;
        let mut points = vec![NOTHING];
        for node in &tree.points[1..] {
            let axes = tree.points[node.parent].axes;
            let before = strain.of(self.numbers, axes, &node.offset);
            let before = plus(self.numbers, &before, &points[node.parent]);
            let turned = node.axes != axes;
            points.push(if turned { tree.outwards(self.numbers, node.axes, &before) } else { before });
        }
        points
    }

    /// `F`, in the axes; `None` where an angular velocity is written in parameters, or is driven.
    fn curls(&mut self, partials: &mut VelocityPartials, strain: &Strain) -> Option<Vec<Vec3>> {
        let (tree, system, frame) = (self.tree, self.system, self.frame);
        let mut curls: Vec<Vec3> = vec![NOTHING];
        for (index, node) in tree.axes.iter().enumerate().skip(1) {
            let mut curl = tree.outwards(self.numbers, index, &curls[node.parent]);
            let of = displaced(self.bench, self.numbers, (system, frame), tree, (index, strain.form));
            if let Some((matrix, along)) = of {
                let strain = own(self.bench, self.numbers, (system, tree), (index, matrix), &along)?;
                let carried = self.spin(node.parent);
                let carried = tree.outwards(self.numbers, index, &carried);
                let back = carried.map(|e| self.numbers.mul(strain, e).neg());
                let turn = turn(self.numbers, (system, tree), index, &along);
                let relative = self.relative_spin(index);
                let turning = cross(self.numbers, &relative, &turn);
                let own = self.curl_of(partials, index, &along)?;
                curl = [0, 1, 2].map(|q| self.numbers.sum([curl[q], back[q], turning[q], own[q]]));
            }
            curls.push(curl);
        }
        Some(curls)
    }

    /// `d omega(x', X)` of axes against their parent.
    fn curl_of(&mut self, partials: &mut VelocityPartials, axes: usize, along: &Rates) -> Option<Vec3> {
        let Turned::By { spin, .. } = &self.tree.all.list[axes].turned else { return None };
        let motion = self.motion();
        let mut curl = NOTHING;
        for (q, component) in spin.iter().enumerate() {
            let form = partials.affine(self.bench, *component).filter(|form| form.on_etas.is_empty())?;
            if !self.numbers.slope_of(self.bench, along, form.offset).is_zero() {
                return None;
            }
            for (i, b) in form.on_velocities {
                let rate = self.numbers.slope_of(self.bench, &motion, b);
                let slope = self.numbers.slope_of(self.bench, along, b);
                let velocity = self.value(self.variables.rate(i));
                let first = self.numbers.mul(rate, displacement(self.system, along, i));
                let second = self.numbers.mul(slope, velocity);
                curl[q] = self.numbers.sum([curl[q], first, second.neg()]);
            }
        }
        Some(curl)
    }
}

impl Assembly<'_> {
    /// The inertia of all bodies along the parameter of a displacement, so far as they are strained.
    pub(in crate::motion) fn strained(
        &mut self,
        partials: &mut VelocityPartials,
        strain: &Strain,
    ) -> Option<()> {
        let own = self.kinematics.variables.eta(strain.form);
        let points = self.kinematics.strained_points(strain);
        let curls = self.kinematics.curls(partials, strain)?;
        for seat in &self.kinematics.tree.seats {
            if let Some(point) = seat.point {
                self.strained_mass(own, (strain, &points[point]), (seat, point));
            }
            self.strained_turn(own, &curls[seat.axes], seat);
        }
        Some(())
    }

    /// `m a.s` of a mass centre at `c`, with `s + e c` for `s`; its momentum goes to the velocities of the point.
    fn strained_mass(&mut self, own: Var, (strain, s): (&Strain, &Vec3), (seat, point): (&Seat, usize)) {
        if !strain.is_at(seat.axes) && s.iter().all(|e| e.is_zero()) {
            return;
        }
        let variables = self.kinematics.variables;
        let acceleration = [0, 1, 2].map(|q| self.kinematics.acceleration(point, q));
        let gradient = self.kinematics.gradient(seat.axes);
        let w = self.kinematics.spin(seat.axes);
        let n = &mut *self.kinematics.numbers;
        let c = &seat.center;
        let h = c.map(|c| n.mul(seat.mass, c));
        let stretched = strain.of(n, seat.axes, &h);
        let shifted = s.map(|s| n.mul(seat.mass, s));
        let whole = plus(n, &shifted, &stretched);
        // m (s + e c).(a + U c)
        let turned = applied(n, &gradient, &h);
        let (straight, mixed) = (n.dot(&whole, &acceleration), n.dot(s, &turned));
        let mut force = n.add(straight, mixed);
        let moment = cross(n, &h, s);
        for k in 0..3 {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            let (above, below) = (n.mul(stretched[i], c[j]), n.mul(stretched[j], c[i]));
            let even = n.add(above, below);
            let product = n.mul(w[i], w[j]);
            let diagonal = n.mul(stretched[k], c[k]);
            let own = n.mul(diagonal, gradient[k][k]);
            let across = n.mul(even, product);
            force = n.sum([force, own, across]);
        }
        self.push(own, force.neg());
        for q in 0..3 {
            self.add(own, variables.velocity(point, q), whole[q]);
            self.add(own, variables.spin(seat.axes, q), moment[q]);
        }
    }

    /// `(I omega).F`.
    fn strained_turn(&mut self, own: Var, curl: &Vec3, seat: &Seat) {
        if curl.iter().all(|e| e.is_zero()) || seat.inertia.iter().all(|e| e.is_zero()) {
            return;
        }
        let w = self.kinematics.spin(seat.axes);
        let [xx, yy, zz, xy, yz, zx] = seat.inertia;
        let n = &mut *self.kinematics.numbers;
        let momentum = applied(n, &[[xx, xy, zx], [xy, yy, yz], [zx, yz, zz]], &w);
        let force = n.dot(&momentum, curl);
        self.push(own, force.neg());
    }
}
