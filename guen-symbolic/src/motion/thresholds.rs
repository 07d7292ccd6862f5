//! Thresholds of cost and of size on the way to the rates, to be tuned in one place. Each is where the golden costs
//! (`tests/costs.txt`) and the steps of expansions are best together; `docs/design/formulations.md` and `docs/design/expansion-time.md`
//! have the figures.

/// The number of parameters, and of frames that turn, from which on equations are not multiplied out.
pub(in crate::motion) const MULTIPLIED_PARAMETERS: usize = 6;

/// The number of parameters of a system without constraints and without bodies that turn above which its rates are looked for without
/// its equations.
pub(in crate::motion) const STATED_PARAMETERS: usize = 24;

/// The number of parameters of a system without constraints above which its equations are not written out: their mass matrix
/// has an entry for each pair.
pub const WRITTEN_OUT_PARAMETERS: usize = 64;

/// The number of coordinates above which systems are derived that are chains, trees or nets of particles, and no others: work and memory of
/// everything else grow with the square of their number at least.
pub const COUPLED_COORDINATES: usize = 200;

/// The number of parameters that no energy couples above which equations are not written out: their matrix has a diagonal.
pub(in crate::motion) const DIAGONAL_PARAMETERS: usize = 200;

/// The estimate for each parameter above which constraint forces of a large system are not taken.
pub(in crate::motion) const FORCES_PER_PARAMETER: usize = 400;

/// The cost of the velocities above which equations are not multiplied out.
pub(in crate::motion) const MULTIPLIED_VELOCITIES: u64 = 4000;

/// The number of products, one for each term of the energy in each entry of the mass matrix, above which equations are stated in
/// the rates of the base angles, if there are any.
pub(in crate::motion) const MASS_PRODUCTS: usize = 20_000;

/// The number of parameters above which inertial forces as derivatives of the mass matrix take more operations than accelerations.
pub(in crate::motion) const DIFFERENTIATED_PARAMETERS: usize = 4;

/// The estimate of rates by bodies up to which all ways to the rates are looked at.
pub(in crate::motion) const ALL_WAYS: u64 = 150;

/// The estimate of rates by bodies up to which others are looked at, unless these cannot promise less.
pub(in crate::motion) const OTHER_WAYS: u64 = 600;

/// The share of a derivation's work above which no other independent velocities are looked for: reactions and momenta are to come. A platform on six legs
/// is at 0.51, and the other velocities take less than a tenth.
pub(in crate::motion) const WORK_BEFORE_INDEPENDENT: f64 = 0.6;

/// The estimate above which a further form of equations is not worth the time to optimise it.
pub(in crate::motion) const FURTHER_FORMS: u64 = 1000;

/// The estimate up to which all forms of equations are tried.
pub(in crate::motion) const ALL_FORMS: u64 = 600;

/// The estimated cost below which momenta, reactions and the equations shown stay as they are.
pub(in crate::motion) const RESTATED: u64 = 600;

/// The number of products above which two products are not compared term by term.
pub(in crate::motion) const CANCELLATION_PRODUCTS: usize = 1000;

/// The weight up to which velocities on the constraints stay as the operators have them.
pub(in crate::motion) const VELOCITY_WEIGHT: u64 = 4;

/// Equations that promise no more than so many times the cost of the shortest are left to the optimiser, as a fraction: a program
/// for each is most of the work.
pub(in crate::motion) const CLOSE_PROMISE: (u64, u64) = (5, 4);

/// The number of sums above which they are not compared with each other.
pub(in crate::motion) const COMPARED_SUMS: usize = 400;

/// The number of products for every angle of a form from which on it is not looked at.
pub(in crate::motion) const PRODUCTS_OF_AN_ANGLE: usize = 400;

/// The number of velocity forms above which no nearest form is looked for in systems of more than [`COUPLED_COORDINATES`]: the search
/// compares all pairs.
pub(in crate::motion) const COMPARED_FORMS: usize = 64;

/// The number of forms of the energy for each parameter above which no constraint forces between them are unknowns.
pub(in crate::motion) const MOST_FORMS: usize = 4;

/// The cost of a mass matrix below which it is not replaced by constraint forces as unknowns.
pub(in crate::motion) const DENSE_COST: usize = 12;

/// The number of parameters of a block above which it is not balanced.
pub(in crate::motion) const BALANCED_PARAMETERS: usize = 3;

/// The weighted cost of the entries of such a block above which they are not multiplied out: 92 for a load on a cable, at most 320 in 500 drawn
/// mechanisms. A block of 2,700 exhausted the derivation.
pub(in crate::motion) const BALANCED_COST: u64 = 400;

/// The choices of forms that are tried for such a block: those of a body, three spins and the speed of its centre, are 20.
pub(in crate::motion) const BALANCED_CHOICES: usize = 20;

/// The size up to which components in a body's axes are written out; others are computed once, and their squares are not multiplied out.
pub(in crate::motion) const COMPONENT_TERMS: usize = 5;

/// The estimate of all components beyond which their derivatives are not multiplied out: that only costs time.
pub(in crate::motion) const COMPONENTS_DIFFERENTIATED: u64 = 300;

/// The size up to which blocks are solved without names for intermediate results.
pub(in crate::motion) const BLOCK_WRITTEN_OUT: usize = 2;

/// The number of values at points beyond which no constant is tried: each may take one of every expression of the energy.
pub(in crate::motion) const VALUES_AT_POINTS: usize = 400_000;
