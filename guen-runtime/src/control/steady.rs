//! Equilibria and steady motions: states and inputs at which given rates vanish.

use core::error::Error;
use core::fmt;

use crate::linear_algebra::dense::{Basis, dot, largest, length, transpose};
use crate::numbers::real::Ordered;
use crate::system::derivatives::linearization::{Linearizable, Linearization};

/// The reason why there is no steady motion.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum SteadyError {
    /// A name is none of the system's state or inputs.
    UnknownName {
        /// The name.
        name: &'static str,
    },
    /// The steady motions here are a family: so many further quantities have to be fixed.
    Family {
        /// The number of quantities that are left open.
        dimension: usize,
    },
    /// No steady motion near the guess has the fixed quantities.
    NotFound {
        /// The largest rate that should vanish, where the search ended.
        residual: f64,
    },
    /// A rate or a derivative is infinite or NaN.
    NotFinite,
}

impl fmt::Display for SteadyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::UnknownName { name } => write!(f, "`{name}` is neither in the state nor among the inputs"),
            Self::Family { dimension } => {
                write!(
                    f,
                    "the steady motions here are a family of dimension {dimension}: fix as many quantities"
                )
            }
            Self::NotFound { residual } => {
                write!(
                    f,
                    "no steady motion near the guess has the fixed quantities; a rate of {residual:e} is left"
                )
            }
            Self::NotFinite => f.write_str("a rate or a derivative is not finite"),
        }
    }
}

impl Error for SteadyError {}

/// The settings of a search for a steady motion: see [`steady`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SteadyMotion<const N: usize, const M: usize> {
    /// States whose rate need not vanish, such as the place of a car that drives in a circle. They stay as in the guess.
    pub drifting: [bool; N],
    /// Further states that stay as in the guess.
    pub fixed_states: [bool; N],
    /// Inputs that stay as in the guess.
    pub fixed_inputs: [bool; M],
}

impl<const N: usize, const M: usize> SteadyMotion<N, M> {
    /// Names what drifts and what stays, out of the names of the state and of the inputs.
    ///
    /// ```
    /// use guen_runtime::control::{SteadyError, SteadyMotion};
    /// let held = SteadyMotion::of_names(&["x"], &["f"], &["x", "v"], &["f"]).unwrap();
    /// assert_eq!(held.drifting, [true, false]);
    /// assert_eq!((held.fixed_states, held.fixed_inputs), ([false, false], [true]));
    /// assert_eq!(SteadyMotion::of_names(&["f"], &[], &["x"], &["f"]), Err(SteadyError::UnknownName { name: "f" }));
    /// ```
    ///
    /// # Errors
    ///
    /// [`SteadyError::UnknownName`].
    pub fn of_names(
        drifting: &[&'static str],
        fixed: &[&'static str],
        states: &[&'static str; N],
        inputs: &[&'static str; M],
    ) -> Result<Self, SteadyError> {
        let (drifting, _) = named(drifting, states, &[])?;
        let (fixed_states, fixed_inputs) = named(fixed, states, inputs)?;
        Ok(Self { drifting, fixed_states, fixed_inputs })
    }
}

/// Finds names among those of the state and of the inputs.
///
/// # Errors
///
/// [`SteadyError::UnknownName`].
pub fn named<const N: usize, const M: usize>(
    names: &[&'static str],
    states: &[&'static str; N],
    inputs: &[&'static str; M],
) -> Result<([bool; N], [bool; M]), SteadyError> {
    let (mut in_states, mut in_inputs) = ([false; N], [false; M]);
    for name in names {
        if let Some(i) = states.iter().position(|known| known == name) {
            in_states[i] = true;
        } else if let Some(i) = inputs.iter().position(|known| known == name) {
            in_inputs[i] = true;
        } else {
            return Err(SteadyError::UnknownName { name });
        }
    }
    Ok((in_states, in_inputs))
}

/// A state and inputs near a guess at which all rates vanish that do not drift.
///
/// ```text
/// r_i(t, s, u) = 0 for all i that do not drift;   (ds, du) from the linearisation, by Gauss and Newton
/// ```
///
/// - What is fixed or drifts stays as in the guess. Directions that no rate depends on stay as well; if any are left
///   at the end, there is a family of solutions, and that is reported: a car's steady turns have a speed and a radius,
///   and both have to be chosen.
/// - Steps are halved as long as they do not make the rates smaller, and made as long as they do.
/// - Units decide nothing: rates and unknowns are scaled until the derivatives of each are about one at most. Derivatives that are roundings beside
///   others of their rate count as none: below `1e-12` of them by a state, below a few roundings by an input. A direction counts as one that the rates
///   depend on if more than `1e-9` of it is left beside the others.
///
/// ```
/// use guen_runtime::{Linearizable, Linearization, control::{SteadyError, SteadyMotion, steady}};
///
/// /// `x'' = u - sin(x)`.
/// struct Pendulum;
/// impl Linearizable<f64, 2, 1> for Pendulum {
///     fn rates(&self, _t: f64, [x, v]: &[f64; 2], [u]: &[f64; 1]) -> [f64; 2] {
///         [*v, u - x.sin()]
///     }
///     fn linearization(&self, _t: f64, [x, _]: &[f64; 2], _: &[f64; 1]) -> Linearization<f64, 2, 1> {
///         Linearization { a: [[0.0, 1.0], [-x.cos(), 0.0]], b: [[0.0], [1.0]] }
///     }
/// }
/// let holding = SteadyMotion { drifting: [false; 2], fixed_states: [true, false], fixed_inputs: [false] };
/// let (state, [torque]) = steady(&Pendulum, 0.0, &[0.5, 1.0], &[0.0], &holding).unwrap();
/// assert!(state == [0.5, 0.0] && (torque - 0.5_f64.sin()).abs() < 1e-15);
/// // Every angle can be held by some torque.
/// let open = SteadyMotion { fixed_states: [false; 2], ..holding };
/// assert_eq!(steady(&Pendulum, 0.0, &[0.5, 1.0], &[0.0], &open), Err(SteadyError::Family { dimension: 1 }));
/// ```
///
/// # Errors
///
/// [`SteadyError`].
pub fn steady<R: Ordered, S, const N: usize, const M: usize>(
    system: &S,
    t: R,
    state: &[R; N],
    inputs: &[R; M],
    request: &SteadyMotion<N, M>,
) -> Result<([R; N], [R; M]), SteadyError>
where
    S: Linearizable<R, N, M> + ?Sized,
{
    const NEWTON_STEPS: usize = 100;
    const STEP_HALVINGS: usize = 30;
    const INDEPENDENT: f64 = 1e-9;
    /// Roundings of the largest terms that a rate has had, as the linearisation tells them, that count as none.
    const RATE_ROUNDINGS: f64 = 1e3;

    let open = |j: usize| {
        if j < N { !request.drifting[j] && !request.fixed_states[j] } else { !request.fixed_inputs[j - N] }
    };
    let unknowns = (0..N + M).filter(|j| open(*j)).count();
    let rates = |s: &[R; N], u: &[R; M]| {
        let mut rates = system.rates(t, s, u);
        for (rate, drifts) in rates.iter_mut().zip(&request.drifting) {
            if *drifts {
                *rate = R::zero();
            }
        }
        rates
    };
    let (mut s, mut u) = (*state, *inputs);
    let mut r = rates(&s, &u);
    // The largest terms of each rate so far.
    let mut terms = [0.0; N];
    for _ in 0..NEWTON_STEPS {
        let linear = system.linearization(t, &s, &u);
        let all_finite =
            linear.a.iter().flatten().chain(linear.b.iter().flatten()).chain(&r).all(|x| x.is_finite());
        if !all_finite {
            return Err(SteadyError::NotFinite);
        }
        for (i, most) in terms.iter_mut().enumerate().filter(|(i, _)| !request.drifting[*i]) {
            let products = linear.a[i].iter().zip(&s).chain(linear.b[i].iter().zip(&u)).map(|(x, y)| *x * *y);
            *most = f64::max(*most, largest(products.chain([r[i]])));
        }
        let units = Units::of(&linear, &request.drifting, &open);
        let (by_state, by_input) = (transpose(&units.scaled.a), transpose(&units.scaled.b));
        let column = |j: usize| {
            let column = by_state.get(j).or_else(|| by_input.get(j.wrapping_sub(N)))?;
            open(j).then_some(*column)
        };
        let without_units = |rates: &[R; N]| core::array::from_fn::<R, N, _>(|i| rates[i] * units.rates[i]);
        let r_scaled = without_units(&r);
        let size = length(&r_scaled).to_f64();
        if !size.is_finite() {
            return Err(SteadyError::NotFinite);
        }
        let mut basis = Basis::<R, N>::new();
        let order = basis.add_all(N + M, column, INDEPENDENT);
        let rank = basis.count;
        // R y = -Q^T r, backwards.
        let mut y = [R::zero(); N];
        for k in (0..rank).rev() {
            let q = &basis.vectors[k];
            let mut rest = -dot(q, &r_scaled);
            let entry = |j: usize| column(order[j]).map_or(R::zero(), |c| dot(q, &c));
            for (j, value) in y.iter().enumerate().take(rank).skip(k + 1) {
                rest -= entry(j) * *value;
            }
            y[k] = rest / entry(k);
        }
        let moved = |factor: R| {
            let (mut s, mut u) = (s, u);
            for (j, change) in order.iter().zip(&y).take(rank) {
                let (place, unit) = if *j < N {
                    (&mut s[*j], units.states[*j])
                } else {
                    (&mut u[*j - N], units.inputs[*j - N])
                };
                *place += factor * *change * unit;
            }
            (s, u)
        };
        let mut factor = R::one();
        let mut accepted = None;
        for _ in 0..STEP_HALVINGS {
            let (trial_s, trial_u) = moved(factor);
            let trial = rates(&trial_s, &trial_u);
            let new = length(&without_units(&trial)).to_f64();
            if new < size * (1.0 - 1e-4 * factor.to_f64()) {
                accepted = Some((trial_s, trial_u, trial));
                break;
            }
            factor *= R::from_ratio(1, 2);
        }
        match accepted {
            Some(next) => (s, u, r) = next,
            // No step makes the rates smaller: what is left of them is rounding, or no zero is near.
            None => {
                // Where all terms are rounding, as of a car that has come to rest, the rate without its unit tells.
                let rounding = RATE_ROUNDINGS * R::epsilon().to_f64();
                let is_left = |i: usize| {
                    let [rate, without_unit] = [r[i], r_scaled[i]].map(|rate| rate.abs().to_f64());
                    rate > rounding * terms[i] && without_unit > rounding
                };
                if (0..N).any(is_left) {
                    return Err(SteadyError::NotFound { residual: largest(r.iter().copied()) });
                }
                return match unknowns - rank {
                    0 => Ok((s, u)),
                    dimension => Err(SteadyError::Family { dimension }),
                };
            }
        }
    }
    Err(SteadyError::NotFound { residual: largest(r.iter().copied()) })
}

/// Derivatives without their units, and the powers of two that take them away.
struct Units<R, const N: usize, const M: usize> {
    scaled: Linearization<R, N, M>,
    rates: [R; N],
    states: [R; N],
    inputs: [R; M],
}

impl<R: Ordered, const N: usize, const M: usize> Units<R, N, M> {
    /// Scales rates and unknowns in turn until the largest derivative of each is about one; rates that drift, and derivatives that are none beside the
    /// largest of their rate, are zero.
    fn of(linear: &Linearization<R, N, M>, drifting: &[bool; N], open: &impl Fn(usize) -> bool) -> Self {
        /// Derivatives by states that are so small beside the others of their rate, and beside all that are open, are roundings; those by
        /// inputs, which nothing cancels in as a rule, where they are some roundings of the others.
        const NONE: f64 = 1e-12;
        const ROUNDINGS: f64 = 4.0;
        const SWEEPS: usize = 8;
        let rounding = ROUNDINGS * R::epsilon().to_f64();
        let rows = || linear.a.iter().zip(&linear.b).zip(drifting).filter(|(_, drifts)| !**drifts);
        let of_open =
            rows().flat_map(|((by_state, by_input), _)| by_state.iter().chain(by_input).enumerate());
        let all = largest(of_open.filter(|(j, _)| open(*j)).map(|(_, x)| *x));
        let mut scaled = *linear;
        for ((by_state, by_input), drifts) in scaled.a.iter_mut().zip(&mut scaled.b).zip(drifting) {
            let most = largest(by_state.iter().chain(by_input.iter()).copied());
            let is_none = |x: &R, least: f64| *drifts || x.abs().to_f64() <= least;
            by_state.iter_mut().filter(|x| is_none(x, NONE * most.min(all))).for_each(|x| *x = R::zero());
            by_input.iter_mut().filter(|x| is_none(x, rounding * most)).for_each(|x| *x = R::zero());
        }
        let (mut rates, mut states, mut inputs) = ([R::one(); N], [R::one(); N], [R::one(); M]);
        for _ in 0..SWEEPS {
            for (i, rate) in rates.iter_mut().enumerate() {
                let by_states = scaled.a[i].iter().enumerate().filter(|(j, _)| open(*j));
                let by_inputs = scaled.b[i].iter().enumerate().filter(|(j, _)| open(N + *j));
                let up = to_one::<R>(largest(by_states.chain(by_inputs).map(|(_, x)| *x)));
                scaled.a[i].iter_mut().chain(&mut scaled.b[i]).for_each(|x| *x *= up);
                *rate *= up;
            }
            for (j, state) in states.iter_mut().enumerate() {
                let up = to_one::<R>(largest(scaled.a.iter().map(|row| row[j])));
                scaled.a.iter_mut().for_each(|row| row[j] *= up);
                *state *= up;
            }
            for (j, input) in inputs.iter_mut().enumerate() {
                let up = to_one::<R>(largest(scaled.b.iter().map(|row| row[j])));
                scaled.b.iter_mut().for_each(|row| row[j] *= up);
                *input *= up;
            }
        }
        Self { scaled, rates, states, inputs }
    }
}

/// The power of two that makes about one of a size; one for zero.
fn to_one<R: Ordered>(size: f64) -> R {
    let power = R::from_f64(libm::exp2(-libm::round(libm::log2(size))));
    if power.is_finite() && power > R::zero() { power } else { R::one() }
}
