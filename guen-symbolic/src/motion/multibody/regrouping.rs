//! Constants of bodies that move to the parent of a joint, which its turn leaves alone.

use super::tree::{Content, Tree, Turn, about, shifted};
use super::variables::{Var, Variables};
use crate::numbering::{Num, Numbering};

impl Tree {
    /// Constants that a turn of a joint leaves alone go to the parent: the mass, the moment along the axis, and so much of
    /// the inertia across it as one of its axes has.
    pub(super) fn regroup(&mut self, numbers: &mut Numbering, variables: &Variables) {
        // From the youngest axes on: what goes to a parent may go on from there.
        for axes in (1..self.axes.len()).rev() {
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
                let moves = content.point.is_some_and(|point| {
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
                let mut point = None;
                if let Some(own) = content.point {
                    let node = &self.points[own];
                    point = Some(node.parent);
                    let r = node.offset;
                    // About the parent's origin: h + m r, and I + 2 (h.r) 1 - h r^T - r h^T + m (r^2 1 - r r^T).
                    let first = r.map(|e| numbers.mul(mass, e));
                    let own = about(numbers, &first, &r);
                    let mixed = shifted(numbers, &moment, &r);
                    for q in 0..6 {
                        inertia[q] = numbers.sum([inertia[q], own[q], mixed[q]]);
                    }
                    moment = [0, 1, 2].map(|q| numbers.add(moment[q], first[q]));
                }
                self.put(numbers, Content { axes: parent, point, mass, moment, inertia });
            }
        }
        self.contents.retain(|content| {
            let all = content.inertia.iter().chain(&content.moment).chain([&content.mass]);
            content.axes > 0 && !all.into_iter().all(|e| e.is_zero())
                || content.axes == 0 && !content.mass.is_zero()
        });
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
