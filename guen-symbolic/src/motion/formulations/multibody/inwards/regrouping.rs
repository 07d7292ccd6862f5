//! Constants of bodies that move to the parent of a joint, which its turn leaves alone.

use crate::motion::formulations::multibody::places::tree::{
    Content, PointNode, Tree, Turn, Vec3, about, columns, shifted,
};
use crate::motion::formulations::multibody::velocities::variables::{Class, Var, Variables};
use crate::numbering::{Num, Numbering};

impl Tree {
    /// Constants that a turn of a joint leaves alone go to the parent: the mass, the moment along the axis, and so much of
    /// the inertia across it as one of its axes has.
    pub(in crate::motion) fn regroup(&mut self, numbers: &mut Numbering, variables: &Variables) {
        self.hold_ends(numbers, variables);
        // From the youngest axes on: what goes to a parent may go on from there.
        for axes in (1..self.axes.len()).rev() {
            if self.is_fixed(numbers, axes) {
                self.give_to_parent(numbers, axes);
                continue;
            }
            let Turn::About { axis, .. } = self.axes[axes].turn else { continue };
            let (k, parent) = (axis, self.axes[axes].parent);
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            for place in 0..self.contents.len() {
                let content = self.contents[place].clone();
                let is_turned = content.point.is_none_or(|point| self.points[point].rate.is_none());
                let is_constant = content.inertia.iter().chain(&content.moment).chain([&content.mass]);
                let is_constant = is_constant.into_iter().all(|e| numbers.is_constant(*e));
                if content.axes != axes || !is_turned || !is_constant {
                    continue;
                }
                // Nothing goes where less is known.
                let known = |var: Var| usize::from(variables.is_known(var));
                let spins = |axes: usize| known(variables.spin(axes, i)) + known(variables.spin(axes, j));
                let turns = spins(parent) >= spins(axes);
                let moves = content.point.filter(|point| !self.is_end(*point)).is_some_and(|point| {
                    let velocities =
                        |point: usize| (0..3).map(|q| known(variables.velocity(point, q))).sum::<usize>();
                    let (here, there) = (velocities(point), velocities(self.points[point].parent));
                    if self.is_root(point) { there > here } else { there >= here }
                });
                let across = if turns { content.inertia[j] } else { Num::ZERO };
                let (mut moment, mut inertia) = ([Num::ZERO; 3], [Num::ZERO; 6]);
                let mass = if moves { content.mass } else { Num::ZERO };
                moment[k] = if moves && turns { content.moment[k] } else { Num::ZERO };
                (inertia[i], inertia[j]) = (across, across);
                let left = &mut self.contents[place];
                left.mass = numbers.sub(left.mass, mass);
                left.moment[k] = numbers.sub(left.moment[k], moment[k]);
                left.inertia[i] = numbers.sub(left.inertia[i], across);
                left.inertia[j] = numbers.sub(left.inertia[j], across);
                let gone = Content { axes: parent, point: content.point, mass, moment, inertia };
                let gone = self.about_parent(numbers, gone);
                self.put(numbers, gone);
            }
        }
        self.gather_turning(numbers);
        self.contents.retain(|content| {
            let all = content.inertia.iter().chain(&content.moment).chain([&content.mass]);
            content.axes > 0 && !all.into_iter().all(|e| e.is_zero())
                || content.axes == 0 && !content.mass.is_zero()
        });
    }

    /// Puts inertias without mass to what else moves with the same axes: they belong to no point.
    fn gather_turning(&mut self, numbers: &mut Numbering) {
        for place in (0..self.contents.len()).rev() {
            let Content { axes, mass, moment, inertia, .. } = self.contents[place].clone();
            let turns_only = mass.is_zero() && moment.iter().all(|e| e.is_zero());
            let other =
                (0..self.contents.len()).find(|other| *other != place && self.contents[*other].axes == axes);
            if let Some(other) = other.filter(|_| turns_only) {
                let other = &mut self.contents[other];
                other.inertia = [0, 1, 2, 3, 4, 5].map(|q| numbers.add(other.inertia[q], inertia[q]));
                self.contents.remove(place);
            }
        }
    }

    /// Takes what axes carry about a point of theirs that is held, where there is one: a mass there does not move.
    fn hold_ends(&mut self, numbers: &mut Numbering, variables: &Variables) {
        for end in 1..self.points.len() {
            let PointNode { parent, offset, .. } = self.points[end];
            let is_held = (0..3).all(|q| variables.class(variables.velocity(end, q)) == Class::Zero);
            if !self.is_end(end) || !is_held {
                continue;
            }
            let back = offset.map(Num::neg);
            for content in self.contents.iter_mut().filter(|content| content.point == Some(parent)) {
                content.point = Some(end);
                content.move_origin(numbers, &back);
            }
        }
    }

    /// Returns the mass about the point that its point is seen from.
    fn about_parent(&self, numbers: &mut Numbering, mut content: Content) -> Content {
        let point = content.point.filter(|point| !self.is_end(*point));
        if let Some(point) = point {
            let node = &self.points[point];
            content.move_origin(numbers, &node.offset);
        }
        Content { point: point.map(|point| self.points[point].parent), ..content }
    }

    /// Whether axes are turned against their parent by constants.
    fn is_fixed(&self, numbers: &Numbering, axes: usize) -> bool {
        match &self.axes[axes].turn {
            Turn::World => false,
            Turn::About { cosine, sine, .. } => numbers.is_constant(*cosine) && numbers.is_constant(*sine),
            Turn::By { matrix, spin } => {
                let is_still = spin.iter().all(|form| form.terms.is_empty() && form.offset.is_none());
                is_still && matrix.iter().flatten().all(|e| numbers.is_constant(*e))
            }
        }
    }

    /// Gives all that axes carry which are turned by constants to the parent.
    fn give_to_parent(&mut self, numbers: &mut Numbering, axes: usize) {
        let parent = self.axes[axes].parent;
        for place in 0..self.contents.len() {
            let content = self.contents[place].clone();
            let is_constant = content.inertia.iter().chain(&content.moment).chain([&content.mass]);
            let is_constant = is_constant.into_iter().all(|e| numbers.is_constant(*e));
            let slides = |point: usize| self.points[point].rate.is_some() || self.is_end(point);
            if content.axes != axes || !is_constant || content.point.is_some_and(slides) {
                continue;
            }
            let moment = self.inwards(numbers, axes, &content.moment);
            let [xx, yy, zz, xy, yz, zx] = content.inertia;
            let rows =
                [[xx, xy, zx], [xy, yy, yz], [zx, yz, zz]].map(|row| self.inwards(numbers, axes, &row));
            let turned = columns(&rows).map(|column| self.inwards(numbers, axes, &column));
            let inertia =
                [turned[0][0], turned[1][1], turned[2][2], turned[0][1], turned[1][2], turned[2][0]];
            let left = &mut self.contents[place];
            (left.mass, left.moment, left.inertia) = (Num::ZERO, [Num::ZERO; 3], [Num::ZERO; 6]);
            let gone = self.about_parent(numbers, Content { axes: parent, moment, inertia, ..content });
            self.put(numbers, gone);
        }
    }

    /// Whether a point is where something is that slides in the world.
    fn is_root(&self, point: usize) -> bool {
        let mut place = point;
        while self.is_at_rest(place) && place > 0 {
            place = self.points[place].parent;
        }
        self.points[place].rate.is_some()
    }
}

impl Content {
    /// Takes moments about another origin, from which the old one is at `r`: `h + m r`, and
    /// `I + 2 (h.r) 1 - h r^T - r h^T + m (r^2 1 - r r^T)`.
    fn move_origin(&mut self, numbers: &mut Numbering, r: &Vec3) {
        let first = r.map(|e| numbers.mul(self.mass, e));
        let own = about(numbers, &first, r);
        let mixed = shifted(numbers, &self.moment, r);
        self.inertia = [0, 1, 2, 3, 4, 5].map(|q| numbers.sum([self.inertia[q], own[q], mixed[q]]));
        self.moment = [0, 1, 2].map(|q| numbers.add(self.moment[q], first[q]));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algebra::{Graph, Role};
    use crate::motion::formulations::multibody::places::tree::{cross, plus};
    use crate::workbench::Workbench;

    /// Twice the kinetic energy, `m v^2 + 2 h.(v x w) + w.I w`.
    fn energy(numbers: &mut Numbering, content: &Content, v: &Vec3, w: &Vec3) -> Num {
        let [xx, yy, zz, xy, yz, zx] = content.inertia;
        let momentum = [[xx, xy, zx], [xy, yy, yz], [zx, yz, zz]].map(|row| numbers.dot(&row, w));
        let square = numbers.dot(v, v);
        let straight = numbers.mul(content.mass, square);
        let across = cross(numbers, v, w);
        let mixed = numbers.dot(&content.moment, &across);
        let turning = numbers.dot(w, &momentum);
        numbers.sum([straight, mixed, mixed, turning])
    }

    #[test]
    fn a_mass_about_another_origin_has_the_same_energy() {
        let mut bench = Workbench::new(Graph::new());
        let generation = bench.zero.generation();
        let mut numbers = Numbering::new(&mut bench.graph, (0, false), generation);
        let mut drawn: Vec<Num> = (0..19)
            .map(|i| {
                let symbol = bench.graph.symbol(&format!("c{i}"), Role::Constant);
                numbers.import(&mut bench, symbol)
            })
            .collect();
        let mut three = || [0; 3].map(|_| drawn.pop().expect("enough are drawn"));
        let (r, v, w, moment, a, b) = (three(), three(), three(), three(), three(), three());
        let mut content = Content {
            axes: 1,
            point: Some(1),
            mass: drawn[0],
            moment,
            inertia: [a[0], a[1], a[2], b[0], b[1], b[2]],
        };
        let here = energy(&mut numbers, &content, &v, &w);
        content.move_origin(&mut numbers, &r);
        // The new origin is at -r.
        let turning = cross(&mut numbers, &r, &w);
        let there = plus(&mut numbers, &v, &turning);
        assert_eq!(energy(&mut numbers, &content, &there, &w), here);
        assert!(numbers.is_sound());
    }
}
