//! A linear model on the leaf: positions that the constraints leave independent, and the quasi-velocities.

use core::error::Error;
use core::fmt;

use crate::linear_algebra::dense::{apply, largest, product};
use crate::numbers::real::{Ordered, Real};
use crate::system::derivatives::linearization::{Linearization, OutputLinearization};

/// Four coordinates that are a unit quaternion, by their indices: `w, x, y, z`.
pub type Quaternion = [usize; 4];

/// The kind of a component of a reduced basis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Component {
    /// A coordinate, by its index.
    Coordinate(usize),
    /// A component of the rotation vector of a quaternion, in the body's axes: `q -> q (1 + theta/2)`.
    Rotation {
        /// The index of the quaternion.
        quaternion: usize,
        /// 0, 1 or 2 for the body's `x`, `y` or `z`.
        axis: usize,
    },
    /// A quasi-velocity by its index among the parameters, or behind these a state beside the motion.
    Parameter(usize),
}

/// The name of a component of a reduced basis: that of a coordinate or of a quasi-velocity as it was declared, `theta`, or an axis and
/// the first coordinate of the quaternion that turns about it, `rotation_x(w)`. Compares with text.
///
/// Costs nothing but its place: two words and a letter, no allocation.
///
/// ```
/// use guen_runtime::{Linearization, control::Leaf};
/// let linear = Linearization { a: [[0.0, 1.0], [-1.0, 0.0]], b: [[0.0], [1.0]] };
/// let leaf = Leaf::<f64, 1, 0> {
///     coordinates: [0.0], velocities: [0.0], rows: [], quaternions: &[], independent: [false], names: &["angle", "speed"],
/// };
/// let reduced = leaf.reduce::<2, 1, 2>(&linear, &[0.0; 2]).unwrap();
/// assert_eq!(reduced.names, ["angle", "speed"]);
/// assert_eq!(reduced.place("speed"), Some(1));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ComponentName {
    of: &'static str,
    /// The axis that a quaternion turns about.
    axis: Option<char>,
}

impl ComponentName {
    fn new(
        component: Component,
        coordinates: usize,
        quaternions: &[Quaternion],
        names: &[&'static str],
    ) -> Self {
        let of = |place: usize| names.get(place).copied().unwrap_or_default();
        match component {
            Component::Coordinate(i) => Self { of: of(i), axis: None },
            Component::Parameter(s) => Self { of: of(coordinates + s), axis: None },
            Component::Rotation { quaternion, axis } => {
                let first = quaternions.get(quaternion).map_or("", |[w, ..]| of(*w));
                Self { of: first, axis: Some(['x', 'y', 'z'][axis.min(2)]) }
            }
        }
    }
}

impl fmt::Display for ComponentName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.axis {
            None => f.pad(self.of),
            Some(axis) => write!(f, "rotation_{axis}({})", self.of),
        }
    }
}

impl PartialEq<str> for ComponentName {
    fn eq(&self, other: &str) -> bool {
        let Some(axis) = self.axis else { return self.of == other };
        let turned = other.strip_prefix("rotation_").and_then(|rest| rest.strip_prefix(axis));
        let of = turned.and_then(|rest| rest.strip_prefix('(')).and_then(|rest| rest.strip_suffix(')'));
        of == Some(self.of)
    }
}

impl PartialEq<&str> for ComponentName {
    fn eq(&self, other: &&str) -> bool {
        *self == **other
    }
}

/// The reason why there is no reduced basis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ReduceError {
    /// A name is no coordinate.
    UnknownCoordinate {
        /// The name.
        name: &'static str,
    },
    /// The differentials of the integrable combinations, by the positions that may be dependent, have a smaller rank
    /// than there are combinations: more positions are named independent than are, or the leaf has an edge here.
    Dependent {
        /// The rank found.
        rank: usize,
        /// The rank needed.
        needed: usize,
    },
    /// A differential or a derivative is infinite or NaN.
    NotFinite,
}

impl fmt::Display for ReduceError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::UnknownCoordinate { name } => write!(f, "`{name}` is not a coordinate of this system"),
            Self::Dependent { rank, needed } => write!(
                f,
                "the integrable constraints determine {needed} positions by the others, but {rank} of those that are \
                 not named independent can be solved for here"
            ),
            Self::NotFinite => f.write_str("a derivative or a constraint is not finite"),
        }
    }
}

impl Error for ReduceError {}

/// The coordinates that are named, among the names of a state, which begin with those of the coordinates.
///
/// # Errors
///
/// [`ReduceError::UnknownCoordinate`].
pub fn independent<const N: usize, const S: usize>(
    names: &[&'static str],
    state: &[&'static str; S],
) -> Result<[bool; N], ReduceError> {
    let mut found = [false; N];
    for name in names {
        let place = state.iter().take(N).position(|known| known == name);
        match place.and_then(|i| found.get_mut(i)) {
            Some(entry) => *entry = true,
            None => return Err(ReduceError::UnknownCoordinate { name }),
        }
    }
    Ok(found)
}

/// The linear model of a system in a basis `z` of its leaf: independent positions, then the quasi-velocities,
/// then the states beside the motion.
///
/// ```text
/// d(state) = E dz      dz = P d(state)      A_z = P (A E - E')      B_z = P B
/// ```
///
/// `E'` is the rate of the basis along the motion; it differs from zero for the rotation components of quaternions
/// alone. `S` states, `M` inputs, `Z` components.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reduced<R, const S: usize, const M: usize, const Z: usize> {
    /// `A_z` and `B_z`.
    pub linear: Linearization<R, Z, M>,
    /// The rates of the components along the motion, for models with an offset.
    pub rates: [R; Z],
    /// `E`, `S` by `Z`.
    pub basis: [[R; Z]; S],
    /// `P`, `Z` by `S`: a left inverse of `E`.
    pub projection: [[R; S]; Z],
    /// The kind of each component.
    pub components: [Component; Z],
    /// The name of each component; empty where the system's states have none.
    pub names: [ComponentName; Z],
}

impl<R: Real, const S: usize, const M: usize, const Z: usize> Reduced<R, S, M, Z> {
    /// The place of the component with this name, if it is one of them.
    pub fn place(&self, name: &str) -> Option<usize> {
        self.names.iter().position(|known| *known == *name)
    }

    /// The components of a small deviation of the state on the leaf.
    pub fn project(&self, deviation: &[R; S]) -> [R; Z] {
        apply(&self.projection, deviation)
    }

    /// The deviation of the state that has these components.
    pub fn lift(&self, components: &[R; Z]) -> [R; S] {
        apply(&self.basis, components)
    }

    /// The linearisation of outputs in this basis: `C E` and `D`.
    pub fn outputs<const P: usize>(
        &self,
        outputs: &OutputLinearization<R, S, M, P>,
    ) -> OutputLinearization<R, Z, M, P> {
        OutputLinearization { c: product(&outputs.c, &self.basis), d: outputs.d }
    }
}

/// A state's leaf: where the motion stays that begins there.
#[derive(Clone, Copy, Debug)]
pub struct Leaf<'a, R, const N: usize, const H: usize> {
    /// The coordinates.
    pub coordinates: [R; N],
    /// The rates of the coordinates.
    pub velocities: [R; N],
    /// The differentials of the integrable combinations by the coordinates, a row for each: `F dx = 0` on the leaf.
    pub rows: [[R; N]; H],
    /// The unit quaternions among the coordinates; the norm of each is one of the combinations.
    pub quaternions: &'a [Quaternion],
    /// Coordinates that are to stay independent; naming a component of a quaternion names its rotation.
    pub independent: [bool; N],
    /// The names of the coordinates, then those of the quasi-velocities; may be empty.
    pub names: &'a [&'static str],
}

impl<'a, R: Ordered, const N: usize, const H: usize> Leaf<'a, R, N, H> {
    /// The leaf of a state, whose first entries are the coordinates, with the differentials row by row.
    ///
    /// ```
    /// use guen_runtime::control::Leaf;
    /// let leaf = Leaf::<f64, 2, 1>::at(&[1.0, 2.0, 0.5], [0.5, 0.0], &[0.0, 1.0], &[], [false; 2], &[]);
    /// assert_eq!((leaf.coordinates, leaf.rows), ([1.0, 2.0], [[0.0, 1.0]]));
    /// ```
    ///
    /// Zeros stand where a list ends before.
    pub fn at(
        state: &[R],
        velocities: [R; N],
        differentials: &[R],
        quaternions: &'a [Quaternion],
        independent: [bool; N],
        names: &'a [&'static str],
    ) -> Self {
        let of = |list: &[R], i: usize| list.get(i).copied().unwrap_or_else(R::zero);
        let rows = core::array::from_fn(|row| core::array::from_fn(|i| of(differentials, row * N + i)));
        let coordinates = core::array::from_fn(|i| of(state, i));
        Self { coordinates, velocities, rows, quaternions, independent, names }
    }

    /// The linear model in a basis of the leaf.
    ///
    /// ```text
    /// dx_dep = -F_dep^-1 F_ind dx_ind
    /// ```
    ///
    /// The dependent positions are chosen by complete pivoting among those that are not to stay independent. Exact at
    /// every state, equilibrium or not: the leaf is kept by the motion, and the independent positions are coordinates on
    /// it. Takes `Z = S - H` components.
    ///
    /// ```
    /// use guen_runtime::{Linearization, control::{Component, Leaf}};
    /// // Two coordinates with x' = y' = v: on the leaf x - y = const one of them is enough.
    /// let linear = Linearization { a: [[0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [0.0, 0.0, 0.0]], b: [[0.0], [0.0], [1.0]] };
    /// let leaf = Leaf {
    ///     coordinates: [0.0, 0.0], velocities: [0.0, 0.0], rows: [[1.0, -1.0]], quaternions: &[], independent: [false, true],
    ///     names: &["x", "y", "v"],
    /// };
    /// let reduced = leaf.reduce::<3, 1, 2>(&linear, &[0.0; 3]).unwrap();
    /// assert_eq!(reduced.components, [Component::Coordinate(1), Component::Parameter(0)]);
    /// assert_eq!(reduced.names, ["y", "v"]);
    /// assert_eq!(reduced.linear.a, [[0.0, 1.0], [0.0, 0.0]]);
    /// assert_eq!(reduced.lift(&[0.1, 0.0]), [0.1, 0.1, 0.0]);
    /// ```
    ///
    /// # Errors
    ///
    /// [`ReduceError`].
    pub fn reduce<const S: usize, const M: usize, const Z: usize>(
        &self,
        linear: &Linearization<R, S, M>,
        rates: &[R; S],
    ) -> Result<Reduced<R, S, M, Z>, ReduceError> {
        let slots = self.slots();
        let count = N - self.quaternions.len();
        let solved = self.solve(&slots[..count])?;
        let mut basis = [[R::zero(); Z]; S];
        let mut turning = [[R::zero(); Z]; S];
        let mut projection = [[R::zero(); S]; Z];
        let mut components = [Component::Parameter(0); Z];
        let mut z = 0;
        for (place, slot) in slots[..count].iter().enumerate() {
            if solved.is_dependent[place] || z >= Z {
                continue;
            }
            self.displace(*slot, R::one(), &mut basis, &mut turning, z);
            for (k, dependent) in solved.dependent[..solved.rank].iter().enumerate() {
                self.displace(slots[*dependent], solved.gain[k][place], &mut basis, &mut turning, z);
            }
            self.measure(*slot, &mut projection[z]);
            components[z] = *slot;
            z += 1;
        }
        for parameter in 0..S.saturating_sub(N) {
            if z < Z {
                basis[N + parameter][z] = R::one();
                projection[z][N + parameter] = R::one();
                components[z] = Component::Parameter(parameter);
                z += 1;
            }
        }
        let mut moved = product(&linear.a, &basis);
        for i in 0..S {
            for j in 0..Z {
                moved[i][j] -= turning[i][j];
            }
        }
        let linear = Linearization { a: product(&projection, &moved), b: product(&projection, &linear.b) };
        let all = linear.a.iter().flatten().chain(linear.b.iter().flatten());
        if !all.copied().all(Real::is_finite) {
            return Err(ReduceError::NotFinite);
        }
        let names = components.map(|one| ComponentName::new(one, N, self.quaternions, self.names));
        Ok(Reduced { linear, rates: apply(&projection, rates), basis, projection, components, names })
    }

    /// Coordinates that are no part of a quaternion as they are, and the rotations of the quaternions, in order.
    fn slots(&self) -> [Component; N] {
        let mut slots = [Component::Parameter(0); N];
        let mut count = 0;
        for i in 0..N {
            let member = self.quaternions.iter().position(|q| q.contains(&i));
            let slot = match member {
                None => Component::Coordinate(i),
                Some(quaternion) => {
                    // The first three of the four coordinates, in order, stand for the three axes.
                    let axis = self.quaternions[quaternion].iter().filter(|j| **j < i).count();
                    if axis == 3 {
                        continue;
                    }
                    Component::Rotation { quaternion, axis }
                }
            };
            slots[count] = slot;
            count += 1;
        }
        slots
    }

    /// `dx` of a displacement along a slot: four components of `q e_axis / 2`, or one.
    fn direction(&self, slot: Component, of: &[R; N]) -> [(usize, R); 4] {
        match slot {
            Component::Rotation { quaternion, axis } => {
                let members = self.quaternions[quaternion];
                let [w, x, y, z] = members.map(|i| of[i]);
                // (w + v) e = -v.e + w e + v x e
                let image = match axis {
                    0 => [-x, w, z, -y],
                    1 => [-y, -z, w, x],
                    _ => [-z, y, -x, w],
                };
                let half = R::from_ratio(1, 2);
                core::array::from_fn(|k| (members[k], half * image[k]))
            }
            Component::Coordinate(i) => [(i, R::one()), (i, R::zero()), (i, R::zero()), (i, R::zero())],
            Component::Parameter(_) => [(0, R::zero()); 4],
        }
    }

    fn displace<const S: usize, const Z: usize>(
        &self,
        slot: Component,
        by: R,
        basis: &mut [[R; Z]; S],
        turning: &mut [[R; Z]; S],
        column: usize,
    ) {
        for (i, part) in self.direction(slot, &self.coordinates) {
            basis[i][column] += by * part;
        }
        if matches!(slot, Component::Rotation { .. }) {
            for (i, part) in self.direction(slot, &self.velocities) {
                turning[i][column] += by * part;
            }
        }
    }

    /// The row of `P`: a coordinate itself, or `theta = 2 (q* dq)/|q|^2`.
    fn measure<const S: usize>(&self, slot: Component, row: &mut [R; S]) {
        let mut scale = R::one();
        if let Component::Rotation { quaternion, .. } = slot {
            let square = self.quaternions[quaternion]
                .iter()
                .fold(R::zero(), |sum, i| sum + self.coordinates[*i] * self.coordinates[*i]);
            // q e_axis / 2 has the length |q|/2.
            scale = R::from_ratio(4, 1) / square;
        }
        for (i, part) in self.direction(slot, &self.coordinates) {
            row[i] += scale * part;
        }
    }

    /// Solves for the slots that depend on the others.
    fn solve(&self, slots: &[Component]) -> Result<Solved<R, N, H>, ReduceError> {
        /// An entry that is smaller than this beside the largest one of its row is no pivot.
        const LEAST_PIVOT: f64 = 1e-10;
        let mut f = [[R::zero(); N]; H];
        for (row, given) in f.iter_mut().zip(&self.rows) {
            // Rows are compared without their units, which are those of the combinations.
            let size = largest(given.iter().copied());
            if !size.is_finite() {
                return Err(ReduceError::NotFinite);
            }
            let size = if size > 0.0 { R::from_f64(size) } else { R::one() };
            for (entry, slot) in row.iter_mut().zip(slots) {
                let along = self.direction(*slot, &self.coordinates);
                *entry = along.iter().fold(R::zero(), |sum, (i, part)| sum + given[*i] / size * *part);
            }
        }
        let is_free = |slot: &Component| match *slot {
            Component::Coordinate(i) => !self.independent[i],
            Component::Rotation { quaternion, .. } => {
                self.quaternions[quaternion].iter().all(|i| !self.independent[*i])
            }
            Component::Parameter(_) => false,
        };
        let mut solved = Solved { rank: 0, dependent: [0; H], is_dependent: [false; N], gain: f };
        let needed = H.saturating_sub(self.quaternions.len());
        while solved.rank < needed {
            let k = solved.rank;
            let mut best = (LEAST_PIVOT, None);
            for (i, row) in f.iter().enumerate().skip(k) {
                for (j, slot) in slots.iter().enumerate() {
                    let size = row[j].to_f64().abs();
                    if size > best.0 && is_free(slot) && !solved.is_dependent[j] {
                        best = (size, Some((i, j)));
                    }
                }
            }
            let Some((i, j)) = best.1 else {
                return Err(ReduceError::Dependent { rank: k, needed });
            };
            f.swap(k, i);
            let pivot = f[k];
            f[k] = pivot.map(|entry| entry / pivot[j]);
            let unit = f[k];
            for (other, row) in f.iter_mut().enumerate() {
                if other != k {
                    let factor = row[j];
                    for (entry, one) in row.iter_mut().zip(&unit) {
                        *entry -= factor * *one;
                    }
                }
            }
            solved.dependent[k] = j;
            solved.is_dependent[j] = true;
            solved.rank += 1;
        }
        solved.gain = f.map(|row| row.map(|entry| -entry));
        Ok(solved)
    }
}

/// `dy_dependent = gain dy_independent`.
struct Solved<R, const N: usize, const H: usize> {
    rank: usize,
    dependent: [usize; H],
    is_dependent: [bool; N],
    gain: [[R; N]; H],
}
