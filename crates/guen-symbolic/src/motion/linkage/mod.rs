//! The equations of bodies that hang on each other, in the axes of each: Newton's and Euler's equations from link to link.
//!
//! In the world's axes the velocity of the seventh link of an arm is a sum over seven joints of products of seven
//! rotations. In its own axes it is that of the sixth, turned by one angle, and the turn of one joint. So velocities and
//! accelerations at `eta' = 0` go outwards along the tree, wrenches and the inertia of all that a link carries come back:
//!
//! ```text
//! omega = R^T omega_p + w,   alpha = R^T alpha_p + (R^T omega_p) x w + w'
//! a = R^T (a_p + U_p r) + 2 (R^T omega_p) x n + n' + w x n,   U = [alpha]x + [omega]x [omega]x
//! F = m a + U h,   N = I alpha + omega x I omega + h x a
//! ```
//!
//! with the pose `R, r` of a link in its parent, its motion `w, n` there, mass `m`, first moment `h` and moment of inertia `I`
//! about the origin of its axes. The virtual work along `X_s` of all wrenches is a row of the equations; that of what a
//! link carries, moved along `X_t`, an entry of the mass matrix. Parameters may be any, and so may constraints:
//! displacements are those of the operators.
//!
//! Sources: the recursions are the recursive Newton-Euler and the composite-rigid-body algorithm (Featherstone, Rigid Body
//! Dynamics Algorithms, 2008, chapters 5 and 6), here over operators in place of joints.

mod tree;
mod vector;

pub(super) use self::tree::Tree;
use self::tree::{Link, about};
use self::vector::{Matrix, Vector};
use super::velocity_forms::VelocityPartials;
use super::{Equations, Frame, Mechanics, decompose, projection};
use crate::algebra::{ExprId, Graph};
use crate::workbench::Workbench;

/// The tree of a system's bodies; none where no body hangs on another, or masses, inertias or gravity are not constant.
pub(super) fn tree<'a>(
    bench: &mut Workbench,
    system: &'a Mechanics,
    frame: &Frame,
    partials: &mut VelocityPartials,
) -> Option<Tree<'a>> {
    let multibody = system.multibody.as_ref()?;
    let graph = &bench.graph;
    let weights = multibody.bodies.iter().flat_map(|body| body.inertia.iter().chain([&body.mass]));
    let mut weights = weights.chain(&multibody.gravity);
    if !weights.all(|e| graph.roles(*e).is_constant()) {
        return None;
    }
    Tree::new(bench, system, frame, partials)
}

/// The equations of a tree, `s = 1..l`, without the generalised forces; none where the energies beside the bodies' are not
/// quadratic by themselves.
pub(super) fn equations(
    bench: &mut Workbench,
    system: &Mechanics,
    frame: &mut Frame,
    partials: &mut VelocityPartials,
    tree: &Tree<'_>,
) -> Option<Equations> {
    let mut equations = beside(bench, system, frame, partials)?;
    let states = outwards(bench, system, frame, &tree.links);
    let (mass, work) = inwards(&mut bench.graph, &tree.links, &states, system.forms.degrees);
    let graph = &mut bench.graph;
    for (own, row) in equations.mass.iter_mut().zip(mass) {
        own.iter_mut().zip(row).for_each(|(own, entry)| *own = graph.add(*own, entry));
    }
    for (force, work) in equations.forces.iter_mut().zip(work) {
        *force = graph.sub(*force, work);
    }
    Some(equations)
}

/// The equations of the energies beside those of the bodies: of rotors and springs.
fn beside(
    bench: &mut Workbench,
    system: &Mechanics,
    frame: &mut Frame,
    partials: &mut VelocityPartials,
) -> Option<Equations> {
    let multibody = system.multibody.as_ref()?;
    let (l, zero) = (system.forms.degrees, bench.graph.zero());
    if bench.graph.is_zero(multibody.other_energy) {
        let forces = frame.displacements[..l].iter_mut();
        let forces = forces.map(|along| along.of(&mut bench.graph, multibody.other_force_function)).collect();
        return Some(Equations { mass: vec![vec![zero; l]; l], forces });
    }
    let other = Mechanics {
        kinetic_energy: multibody.other_energy,
        force_function: multibody.other_force_function,
        ..system.clone()
    };
    let symbols: Vec<ExprId> = system.velocities.iter().chain(&system.etas).copied().collect();
    let terms = decompose(bench, partials, &symbols, other.kinetic_energy).ok()?;
    Some(projection::equations(bench, &other, frame, partials, &terms, 0..l).equations)
}

/// The motion of a link at `eta' = 0`, in its axes.
struct State {
    spin: Vector,
    /// `alpha`.
    spin_rate: Vector,
    /// `a` of the origin, less gravity.
    acceleration: Vector,
    /// `omega_i omega_j` in the order `xx, yy, zz, xy, yz, zx`.
    squares: [ExprId; 6],
    /// `U`.
    gradient: Matrix,
}

fn outwards(bench: &mut Workbench, system: &Mechanics, frame: &mut Frame, links: &[Link]) -> Vec<State> {
    let graph = &mut bench.graph;
    let zero = vector::zero(graph);
    let gravity = system.multibody.as_ref().map_or(zero, |multibody| multibody.gravity);
    let falling = gravity.map(|e| graph.neg(e));
    let rest = State {
        spin: zero,
        spin_rate: zero,
        acceleration: falling,
        squares: [graph.zero(); 6],
        gradient: [zero; 3],
    };
    let mut states = vec![rest];
    for link in &links[1..] {
        // w, n and their rates.
        let mut own = [zero; 4];
        for (s, spin, velocity) in &link.along {
            let eta = if *s == 0 { graph.one() } else { system.etas[*s - 1] };
            for (place, part) in [spin, velocity].into_iter().enumerate() {
                let rate = part.map(|e| frame.motion.of(graph, e));
                for (total, part) in [(place, part), (place + 2, &rate)] {
                    let moving = vector::scaled(graph, eta, part);
                    own[total] = vector::sum(graph, [&own[total], &moving]);
                }
            }
        }
        let [w, n, w_rate, n_rate] = own;
        let parent = &states[link.parent];
        let carried = vector::applied_back(graph, &link.rotation, &parent.spin);
        let carried = vector::kept(graph, carried);
        let spin = vector::sum(graph, [&carried, &w]);
        let spin = vector::kept(graph, spin);

        let turned = vector::applied_back(graph, &link.rotation, &parent.spin_rate);
        let coriolis = vector::cross(graph, &carried, &w);
        let spin_rate = vector::sum(graph, [&turned, &coriolis, &w_rate]);
        let spin_rate = vector::kept(graph, spin_rate);

        let reached = vector::applied(graph, &parent.gradient, &link.offset);
        let reached = vector::sum(graph, [&parent.acceleration, &reached]);
        let reached = vector::kept(graph, reached);
        let turned = vector::applied_back(graph, &link.rotation, &reached);
        let coriolis = vector::cross(graph, &carried, &n);
        let (around, two) = (vector::cross(graph, &w, &n), 2.into());
        let coriolis = coriolis.map(|e| graph.scale(e, &two));
        let acceleration = [0, 1, 2].map(|i| graph.sum([turned[i], coriolis[i], n_rate[i], around[i]]));
        let acceleration = vector::kept(graph, acceleration);
        states.push(State::new(graph, spin, spin_rate, acceleration));
    }
    states
}

impl State {
    fn new(graph: &mut Graph, spin: Vector, spin_rate: Vector, acceleration: Vector) -> Self {
        let pairs = [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0)];
        let squares = pairs.map(|(i, k)| {
            let product = graph.mul(spin[i], spin[k]);
            graph.keep(product)
        });
        let [xx, yy, zz, xy, yz, zx] = squares;
        let [x, y, z] = spin_rate;
        let mut diagonal = |a, b| {
            let sum = graph.add(a, b);
            graph.neg(sum)
        };
        let (dx, dy, dz) = (diagonal(yy, zz), diagonal(zz, xx), diagonal(xx, yy));
        let mut pair = |square, rate| (graph.add(square, rate), graph.sub(square, rate));
        let ((yx, xy), (zy, yz), (xz, zx)) = (pair(xy, z), pair(yz, x), pair(zx, y));
        let gradient = [[dx, xy, xz], [yx, dy, yz], [zx, zy, dz]].map(|row| vector::kept(graph, row));
        State { spin, spin_rate, acceleration, squares, gradient }
    }

    /// Force, and moment about the origin, of what moves with the link.
    fn wrench(&self, graph: &mut Graph, link: &Link) -> (Vector, Vector) {
        let straight = vector::scaled(graph, link.mass, &self.acceleration);
        let turning = vector::applied(graph, &self.gradient, &link.moment);
        let force = vector::sum(graph, [&straight, &turning]);
        // I alpha + omega x I omega, by the products of the spins.
        let [xx, yy, zz, xy, yz, zx] = self.squares;
        let diagonal = [xx, yy, zz];
        let opposite = [yz, zx, xy];
        let lever = vector::cross(graph, &link.moment, &self.acceleration);
        let moment = [0, 1, 2].map(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            let inertia = &link.inertia;
            let difference = graph.sub(inertia[k][k], inertia[j][j]);
            let squares = graph.sub(diagonal[j], diagonal[k]);
            let squares = graph.keep(squares);
            let back = graph.neg(self.gradient[k][i]);
            let terms = [
                (inertia[i][i], self.spin_rate[i]),
                (difference, opposite[i]),
                (inertia[i][k], self.gradient[j][i]),
                (inertia[i][j], back),
                (inertia[j][k], squares),
            ];
            let terms = terms.map(|(a, b)| graph.mul(a, b));
            graph.sum(terms.into_iter().chain([lever[i]]))
        });
        (force, moment)
    }
}

/// What a link carries, itself included, about its origin.
#[derive(Clone)]
struct Load {
    mass: ExprId,
    moment: Vector,
    inertia: Matrix,
    force: Vector,
    torque: Vector,
}

/// The mass matrix, and the virtual work of all wrenches along `X_1..X_l`.
fn inwards(graph: &mut Graph, links: &[Link], states: &[State], l: usize) -> (Vec<Vec<ExprId>>, Vec<ExprId>) {
    let mut loads: Vec<Load> = Vec::new();
    for (link, state) in links.iter().zip(states) {
        let (force, torque) = state.wrench(graph, link);
        let &Link { mass, moment, inertia, .. } = link;
        loads.push(Load { mass, moment, inertia, force, torque });
    }
    let mut mass: Vec<Vec<Vec<ExprId>>> = vec![vec![Vec::new(); l]; l];
    let mut work: Vec<Vec<ExprId>> = vec![Vec::new(); l];
    for i in (1..links.len()).rev() {
        let link = &links[i];
        let load = loads[i].kept(graph);
        for (s, spin, velocity) in link.along.iter().filter(|(s, ..)| *s > 0) {
            let row = s - 1;
            work[row].push(power(graph, (spin, velocity), (&load.torque, &load.force)));
            // The momentum of what is carried, moved along X_s.
            let straight = vector::scaled(graph, load.mass, velocity);
            let turning = vector::cross(graph, spin, &load.moment);
            let mut momentum = vector::sum(graph, [&straight, &turning]);
            let own = vector::applied(graph, &load.inertia, spin);
            let lever = vector::cross(graph, &load.moment, velocity);
            let mut angular = vector::sum(graph, [&own, &lever]);
            for (t, spin, velocity) in link.along.iter().filter(|(t, ..)| *t > 0) {
                mass[row][t - 1].push(power(graph, (spin, velocity), (&angular, &momentum)));
            }
            let mut place = i;
            while links[place].parent > 0 {
                (angular, momentum) = links[place].seen_from_parent(graph, (&angular, &momentum));
                (angular, momentum) = (vector::kept(graph, angular), vector::kept(graph, momentum));
                place = links[place].parent;
                for (t, spin, velocity) in links[place].along.iter().filter(|(t, ..)| *t > 0) {
                    let entry = power(graph, (spin, velocity), (&angular, &momentum));
                    mass[row][t - 1].push(entry);
                    mass[t - 1][row].push(entry);
                }
            }
        }
        if link.parent > 0 {
            let parent = &mut loads[link.parent];
            link.hand_over(graph, &load, parent);
        }
    }
    let mass: Vec<Vec<ExprId>> =
        mass.into_iter().map(|row| row.into_iter().map(|terms| graph.sum(terms)).collect()).collect();
    let work = work.into_iter().map(|terms| graph.sum(terms)).collect();
    (mass, work)
}

/// The product of a twist and a wrench, or of a twist and a momentum.
fn power(
    graph: &mut Graph,
    (spin, velocity): (&Vector, &Vector),
    (torque, force): (&Vector, &Vector),
) -> ExprId {
    let (turning, straight) = (vector::dot(graph, spin, torque), vector::dot(graph, velocity, force));
    graph.add(turning, straight)
}

impl Link {
    /// A wrench or a momentum in the parent's axes, about the parent's origin.
    fn seen_from_parent(&self, graph: &mut Graph, (torque, force): (&Vector, &Vector)) -> (Vector, Vector) {
        let force = vector::applied(graph, &self.rotation, force);
        let force = vector::kept(graph, force);
        let torque = vector::applied(graph, &self.rotation, torque);
        let lever = vector::cross(graph, &self.offset, &force);
        (vector::sum(graph, [&torque, &lever]), force)
    }

    /// Adds what the link carries to the load of its parent.
    fn hand_over(&self, graph: &mut Graph, load: &Load, parent: &mut Load) {
        let (torque, force) = self.seen_from_parent(graph, (&load.torque, &load.force));
        parent.force = vector::sum(graph, [&parent.force, &force]);
        parent.torque = vector::sum(graph, [&parent.torque, &torque]);
        parent.mass = graph.add(parent.mass, load.mass);
        let moment = vector::applied(graph, &self.rotation, &load.moment);
        let moment = vector::kept(graph, moment);
        let away = vector::scaled(graph, load.mass, &self.offset);
        parent.moment = vector::sum(graph, [&parent.moment, &moment, &away]);
        // R I R^T + 2 (h.r) 1 - h r^T - r h^T + m (r^2 1 - r r^T)
        let half = vector::product(graph, &self.rotation, &load.inertia).map(|row| vector::kept(graph, row));
        let turned = vector::product(graph, &half, &vector::transposed(&self.rotation));
        let along = vector::dot(graph, &moment, &self.offset);
        let twice = graph.scale(along, &2.into());
        let shifted = about(graph, load.mass, &self.offset);
        let mut inertia = parent.inertia;
        for i in 0..3 {
            for k in i..3 {
                let straight = if i == k { twice } else { graph.zero() };
                let (a, b) = (graph.mul(moment[i], self.offset[k]), graph.mul(self.offset[i], moment[k]));
                let (a, b) = (graph.neg(a), graph.neg(b));
                let sum = graph.sum([parent.inertia[i][k], turned[i][k], straight, a, b, shifted[i][k]]);
                (inertia[i][k], inertia[k][i]) = (sum, sum);
            }
        }
        parent.inertia = inertia;
    }
}

impl Load {
    fn kept(&self, graph: &mut Graph) -> Load {
        Load {
            mass: self.mass,
            moment: vector::kept(graph, self.moment),
            inertia: self.inertia.map(|row| vector::kept(graph, row)),
            force: vector::kept(graph, self.force),
            torque: vector::kept(graph, self.torque),
        }
    }
}
