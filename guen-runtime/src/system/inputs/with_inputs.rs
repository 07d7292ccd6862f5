//! Systems whose inputs are functions of time and state, as systems: rates, derivatives, series, bodies and outputs.

use super::actuated::{Actuated, StateOf, WithInputs};
use super::input_law::{InputLaw, InputRecords, SmoothLaw};
use super::input_values::InputValues;
use crate::numbers::dual::Dual;
use crate::numbers::lift::Lift;
use crate::numbers::power_series::PowerSeries;
use crate::numbers::real::{Ordered, Real};
use crate::system::constraints::auxiliary_states::AuxiliaryStates;
use crate::system::constraints::positions_error::PositionsError;
use crate::system::derivatives::differentiable::Differentiable;
use crate::system::derivatives::linearization::{Liftable, Linearizable, Linearization, seeded};
use crate::system::derivatives::series::{Coefficients, DrivenSeries, TaylorSeries};
use crate::system::forward::forward;
use crate::system::guarded::Guarded;
use crate::system::observables::bodies::{Bodies, Body};
use crate::system::observables::outputs::OutputMap;
use crate::system::simulate::Simulate;
use crate::system::{Monitored, System};

impl<S, F, R, const N: usize> WithInputs<S, F, R, N>
where
    R: Real,
    S: Actuated<R, N>,
    F: InputValues<S, R, N>,
{
    /// The inputs at a time and state.
    pub fn inputs(&self, t: R, state: &StateOf<S, R, N>) -> S::Inputs {
        self.law.values(t, state)
    }

    /// The system with inputs held at what the law says at a time and state.
    #[inline]
    fn at(&self, t: R, state: &[R; N]) -> S::Driven {
        self.system.held(self.law.values(t, &(*state).into()))
    }

    /// The system with whatever inputs, for what does not depend on them.
    #[inline]
    fn anywhere(&self) -> S::Driven {
        self.system.held(S::Inputs::default())
    }
}

impl<S, F, R, const N: usize> System<R, N> for WithInputs<S, F, R, N>
where
    R: Real,
    S: Actuated<R, N>,
    F: InputValues<S, R, N>,
{
    forward!(self -> self.anywhere(), |t, state| self.at(t, state); System<R, N>, restore);

    #[inline]
    fn guarded(&self) -> impl Guarded<R, N> {
        self
    }
}

impl<S, F, R, const N: usize> Guarded<R, N> for WithInputs<S, F, R, N>
where
    R: Real,
    S: Actuated<R, N>,
    F: InputValues<S, R, N>,
{
    forward!(self -> self.anywhere().guarded(), |t, state| self.at(t, state).guarded(); Guarded<R, N>);
}

impl<S, F, R, const N: usize> AuxiliaryStates<R, N> for WithInputs<S, F, R, N>
where
    R: Real,
    S: Actuated<R, N>,
    S::Driven: AuxiliaryStates<R, N>,
    F: InputValues<S, R, N>,
{
    fn renormalize(&self, t: R, state: &mut [R; N]) {
        self.anywhere().renormalize(t, state);
    }
}

impl<S, F, R, const N: usize> Monitored<R, N> for WithInputs<S, F, R, N>
where
    R: Real,
    S: Actuated<R, N>,
    S::Driven: Monitored<R, N>,
    F: InputValues<S, R, N>,
{
    forward!(self -> self.anywhere(), |t, state| self.at(t, state); Monitored<R, N>);
}

impl<S, F, R, const N: usize> Simulate<R, N> for WithInputs<S, F, R, N>
where
    R: Real,
    S: Actuated<R, N>,
    F: InputValues<S, R, N>,
{
    type State = <S::Driven as Simulate<R, N>>::State;
    const STATES: &'static [&'static str] = S::Driven::STATES;
    const UNITS: &'static [&'static str] = S::Driven::UNITS;
    const DOMAIN: &'static [&'static str] = S::Driven::DOMAIN;
    const SWITCHES: &'static [&'static str] = S::Driven::SWITCHES;
    const DECLARATION: u64 = S::Driven::DECLARATION;

    fn onto_constraints(&self, t: R, state: &mut [R; N]) -> Result<(), PositionsError>
    where
        R: Ordered,
    {
        self.anywhere().onto_constraints(t, state)
    }
}

impl<S, F, R, const N: usize, const B: usize> Bodies<R, N, B> for WithInputs<S, F, R, N>
where
    R: Real,
    S: Actuated<R, N>,
    S::Driven: Bodies<R, N, B>,
    F: InputValues<S, R, N>,
{
    #[inline]
    fn bodies(&self, t: R, state: &[R; N]) -> [Body<R>; B] {
        self.anywhere().bodies(t, state)
    }
}

impl<S, F, R, const N: usize, const K: usize> OutputMap<R, N, K> for WithInputs<S, F, R, N>
where
    R: Real,
    S: Actuated<R, N>,
    S::Driven: OutputMap<R, N, K>,
    F: InputValues<S, R, N>,
{
    type Outputs = <S::Driven as OutputMap<R, N, K>>::Outputs;
    const OUTPUTS: [&'static str; K] = <S::Driven as OutputMap<R, N, K>>::OUTPUTS;
    const OUTPUT_UNITS: &'static [&'static str] = <S::Driven as OutputMap<R, N, K>>::OUTPUT_UNITS;

    fn output_values(&self, t: R, state: &[R; N]) -> [R; K] {
        self.at(t, state).output_values(t, state)
    }

    fn named_outputs(values: &[R; K]) -> Self::Outputs {
        <S::Driven as OutputMap<R, N, K>>::named_outputs(values)
    }
}

/// The law's derivatives by the state: of each input by each entry.
fn slopes<L, S, R, const N: usize, const M: usize>(law: &L, t: R, state: &[R; N]) -> [Dual<R, N>; M]
where
    R: Real,
    S: InputRecords,
    L: InputLaw<S>,
    S::StateOver<Dual<R, N>>: From<[Dual<R, N>; N]>,
    S::InputsOver<Dual<R, N>>: Into<[Dual<R, N>; M]>,
{
    law.at(Dual::constant(t), &seeded(state).into()).into()
}

impl<S, L, R, const N: usize, const M: usize> Differentiable<R, N> for WithInputs<S, SmoothLaw<L, S, M>, R, N>
where
    R: Real,
    S: Actuated<R, N> + InputRecords + Linearizable<R, N, M> + Liftable<R, N, M>,
    S::Inputs: Into<[R; M]>,
    L: InputLaw<S>,
    SmoothLaw<L, S, M>: InputValues<S, R, N>,
    S::StateOver<Dual<R, N>>: From<[Dual<R, N>; N]>,
    S::InputsOver<Dual<R, N>>: Into<[Dual<R, N>; M]>,
    S::StateOver<Dual<R, 1>>: From<[Dual<R, 1>; N]>,
    S::InputsOver<Dual<R, 1>>: Into<[Dual<R, 1>; M]>,
    Dual<R, 1>: Lift<R>,
{
    /// `A + B K` with the system's own linearisation, and `K` of the law by dual numbers.
    fn jacobian(&self, t: R, state: &[R; N]) -> [[R; N]; N] {
        let inputs = self.inputs(t, &(*state).into()).into();
        let Linearization { mut a, b } = self.system.linearization(t, state, &inputs);
        let slopes: [Dual<R, N>; M] = slopes::<L, S, R, N, M>(&self.law.law, t, state);
        for (row, by_inputs) in a.iter_mut().zip(&b) {
            for (by_input, slope) in by_inputs.iter().zip(&slopes) {
                for (entry, slope) in row.iter_mut().zip(&slope.tangent) {
                    *entry += *by_input * *slope;
                }
            }
        }
        a
    }

    fn along(&self, t: R, state: &[R; N], dt: R, dx: &[R; N]) -> [R; N] {
        let time = Dual { value: t, tangent: [dt] };
        let state: [Dual<R, 1>; N] = core::array::from_fn(|i| Dual { value: state[i], tangent: [dx[i]] });
        let inputs = self.law.law.at(time, &state.into()).into();
        self.system.lifted_rates(time, &state, &inputs).map(|rate| rate.tangent[0])
    }
}

/// The recurrences of the system along the law's own series, which the law is asked for in [`PowerSeries`], order by order: with
/// `p` orders, a product of the law takes some `p^3/6` products for each step.
impl<S, L, R, const N: usize, const M: usize> TaylorSeries<R, N> for WithInputs<S, SmoothLaw<L, S, M>, R, N>
where
    R: Real,
    S: Actuated<R, N> + InputRecords + DrivenSeries<R, N, M>,
    L: InputLaw<S>,
    SmoothLaw<L, S, M>: InputValues<S, R, N>,
    S::StateOver<PowerSeries<R>>: From<[PowerSeries<R>; N]>,
    S::InputsOver<PowerSeries<R>>: Into<[PowerSeries<R>; M]>,
{
    const PRODUCTS: usize = S::PRODUCTS;

    fn series(&self, t: R, state: &[R; N], scale: R, order: usize, coefficients: &mut Coefficients<R, N>) {
        let time = PowerSeries::line(t, scale);
        let mut known = state.map(PowerSeries::constant);
        let mut inputs = |k: usize, motion: &Coefficients<R, N>| {
            for (series, coefficient) in known.iter_mut().zip(motion.get(k).into_iter().flatten()) {
                series.know(k, *coefficient);
            }
            self.law.law.at(time, &known.into()).into().map(|input| input.coefficient(k))
        };
        self.system.series_along(t, state, &mut inputs, scale, order, coefficients);
    }
}

impl<S, L, R, const N: usize, const M: usize> Linearizable<R, N, 0>
    for WithInputs<S, SmoothLaw<L, S, M>, R, N>
where
    R: Real,
    Self: Differentiable<R, N>,
{
    fn rates(&self, t: R, state: &[R; N], _inputs: &[R; 0]) -> [R; N] {
        self.rhs(t, state)
    }

    fn linearization(&self, t: R, state: &[R; N], _inputs: &[R; 0]) -> Linearization<R, N, 0> {
        Linearization { a: self.jacobian(t, state), b: [[]; N] }
    }
}
