//! A declaration as a system in numbers, and states to look at it.

use std::collections::BTreeMap;

use guen_language::syntax::Declaration;
use nalgebra::{DMatrix, DVector};

use super::analytic::Analytic;
use super::draw::Draw;
use super::meaning::{Asked, Meaning};
use super::multipliers::Multipliers;
use super::scalar::{Dual, solve};

/// What is declared, and the places of its symbols in a point: time, coordinates, velocities, constants and inputs.
pub struct Declared<'a> {
    declaration: &'a Declaration,
    pub n: usize,
    pub degrees: usize,
    pub x: Vec<usize>,
    pub velocities: Vec<usize>,
    pub coordinates: Vec<String>,
    pub held: Vec<String>,
    forms: Vec<String>,
}

impl<'a> Declared<'a> {
    /// With the names of coordinates, of constants and inputs, and of the forms, parameters first.
    pub fn new(
        declaration: &'a Declaration,
        coordinates: Vec<String>,
        held: Vec<String>,
        forms: Vec<String>,
        degrees: usize,
    ) -> Self {
        let n = coordinates.len();
        Declared {
            declaration,
            n,
            degrees,
            x: (1..=n).collect(),
            velocities: (n + 1..=2 * n).collect(),
            coordinates,
            held,
            forms,
        }
    }

    /// The place of the reaction of an equation among all reactions.
    pub fn reaction(&self, name: &str) -> Option<usize> {
        self.forms[self.degrees..].iter().position(|form| form == name)
    }

    /// What it means at a point.
    pub fn meaning<R: Analytic>(&self, point: &[R]) -> Meaning<R> {
        let mut known = BTreeMap::new();
        for (i, name) in self.coordinates.iter().enumerate() {
            let value = Dual { re: point[self.x[i]].clone(), du: point[self.velocities[i]].clone() };
            known.insert(name.clone(), value);
        }
        for (name, value) in self.held.iter().zip(&point[2 * self.n + 1..]) {
            known.insert(name.clone(), Dual { re: value.clone(), du: R::constant(0.0) });
        }
        Meaning::new(self.declaration, point[0].clone(), known)
            .unwrap_or_else(|missing| panic!("{missing} in {}", self.declaration))
    }

    /// A random state on the constraints with positions at 1e-14 of them; `None` where they were not found.
    pub fn state(&self, draw: &mut Draw) -> Option<(Vec<f64>, Vec<f64>)> {
        let mut point = self.start(draw);
        point.extend(self.held.iter().map(|_| draw.real(0.5, 1.5)));
        self.closed(draw, point)
    }

    /// A random state, in every third of which one coordinate is zero, or nearly so: there a quotient may have become zero by zero. With two
    /// coordinates at zero, which are equal, branches of functions would meet.
    pub fn state_with_zero(&self, draw: &mut Draw) -> Option<(Vec<f64>, Vec<f64>)> {
        let mut point = self.start(draw);
        point.extend(self.held.iter().map(|_| draw.real(0.5, 1.5)));
        if draw.once_in(3) {
            point[1 + draw.below(self.n)] = 0.0;
        }
        self.closed(draw, point)
    }

    /// A random state at given constants and inputs.
    pub fn state_of(&self, draw: &mut Draw, held: Vec<f64>) -> Option<(Vec<f64>, Vec<f64>)> {
        let point = [self.start(draw), held].concat();
        self.closed(draw, point)
    }

    /// Time, coordinates and velocities to begin with.
    fn start(&self, draw: &mut Draw) -> Vec<f64> {
        let mut point = vec![draw.real(-1.0, 1.0)];
        point.extend((0..self.n).map(|_| draw.real(-1.0, 1.0)));
        point.extend((0..self.n).map(|_| 0.0));
        point
    }

    /// The nearest point on the constraints, about, and random velocities there.
    fn closed(&self, draw: &mut Draw, mut point: Vec<f64>) -> Option<(Vec<f64>, Vec<f64>)> {
        for _ in 0..40 {
            let left = self.meaning(&point).positions;
            let largest = left.iter().fold(0.0_f64, |most, e| most.max(e.abs()));
            if largest <= 1e-14 {
                let etas: Vec<f64> = (0..self.degrees).map(|_| draw.real(-1.5, 1.5)).collect();
                self.set_velocities(&mut point, &etas);
                // Where the function of a switch is zero, rounding decides whether the switch is on.
                let switches = self.meaning(&point).switches;
                return switches.iter().all(|function| function.abs() > 1e-9).then_some((point, etas));
            }
            let mut slopes = DMatrix::zeros(left.len(), self.n);
            for (i, x) in self.x.iter().enumerate() {
                let moving = self.meaning(&lift(&point, |k| if k == *x { 1.0 } else { 0.0 })).positions;
                slopes.set_column(i, &DVector::from_iterator(left.len(), moving.iter().map(|e| e.du)));
            }
            // Outside of the domain of a root or a logarithm no decomposition ends.
            if !slopes.iter().chain(&left).all(|e| e.is_finite()) {
                return None;
            }
            let step = slopes.svd(true, true).solve(&DVector::from_vec(left), 1e-9).ok()?;
            for (x, step) in self.x.iter().zip(step.iter()) {
                point[*x] -= step.clamp(-0.3, 0.3);
            }
        }
        None
    }

    /// `x'` from `eta_1..eta_l`, the other forms zero.
    fn set_velocities(&self, point: &mut [f64], etas: &[f64]) {
        let forms = self.forms_at(point);
        let matrix = forms.iter().map(|row| row[..self.n].to_vec()).collect();
        let wanted = etas.iter().copied().chain(std::iter::repeat(0.0));
        let right = forms.iter().zip(wanted).map(|(row, eta)| vec![eta - row[self.n]]).collect();
        for (v, value) in self.velocities.iter().zip(solve(matrix, right)) {
            // A velocity that is zero is zero, and not a rounding error below it, whose `floor` is -1.
            point[*v] = if value[0].abs() < 1e-14 { 0.0 } else { value[0] };
        }
    }

    /// `a_j1..a_jn, a_j0` for each form: it is affine in the velocities.
    pub fn forms_at<R: Analytic>(&self, point: &[R]) -> Vec<Vec<R>> {
        let mut moving = point.to_vec();
        let mut at = |moved: Option<usize>| {
            for (i, v) in self.velocities.iter().enumerate() {
                moving[*v] = R::constant(if moved == Some(i) { 1.0 } else { 0.0 });
            }
            let mut forms = self.meaning(&moving).forms;
            self.forms.iter().map(|name| forms.remove(name).expect("a form")).collect::<Vec<R>>()
        };
        let offsets = at(None);
        let columns: Vec<Vec<R>> = (0..self.n).map(|i| at(Some(i))).collect();
        let row = |j: usize| {
            let own = columns.iter().map(|column| column[j].minus(&offsets[j]));
            own.chain([offsets[j].clone()]).collect()
        };
        (0..self.n).map(row).collect()
    }

    /// `T°`.
    pub fn kinetic<R: Analytic>(&self, point: Vec<R>) -> R {
        self.meaning(&point).kinetic_energy
    }

    /// `U`.
    pub fn potential<R: Analytic>(&self, point: &[R]) -> R {
        self.meaning(point).force_function
    }

    /// `Q_i`: each force times the derivative of what it acts along by `x_i'`.
    pub fn generalised_forces(&self, point: &[f64]) -> Vec<f64> {
        let along =
            |meaning: Meaning<Dual<f64>>| meaning.works.iter().map(|(force, form)| force.re * form.du).sum();
        self.by_velocities(point).map(along).collect()
    }

    /// What the declaration means, with derivatives by one velocity after the other.
    pub fn by_velocities<'p>(&'p self, point: &'p [f64]) -> impl Iterator<Item = Meaning<Dual<f64>>> + 'p {
        self.velocities.iter().map(|v| self.meaning(&lift(point, |k| if k == *v { 1.0 } else { 0.0 })))
    }

    /// What it means, with rates along a motion: time, coordinates and velocities move, constants, inputs and states beside it do not.
    pub fn along_motion(&self, point: &[f64], second: &[f64]) -> Meaning<Dual<f64>> {
        let n = self.n;
        self.meaning(&lift(point, |k| match k {
            0 => 1.0,
            k if k <= n => point[n + k],
            k if k <= 2 * n => second[k - n - 1],
            _ => 0.0,
        }))
    }

    /// The components of the outputs in a motion.
    pub fn outputs(&self, point: &[f64], motion: &Multipliers) -> Vec<f64> {
        let Meaning { mut outputs, asked, .. } = self.meaning(point);
        let moving = self.along_motion(point, &motion.second).outputs;
        for (place, asked) in asked {
            outputs[place] = match asked {
                Asked::Along(other) => moving[other].du,
                // That of a contact is a force of its own.
                Asked::Reaction(equation) => {
                    self.reaction(&equation).map_or(0.0, |place| motion.reactions[place])
                }
            };
        }
        outputs
    }

    /// The point with all parameters and constraints zero.
    pub fn at_rest(&self, point: &[f64]) -> Vec<f64> {
        let mut resting = point.to_vec();
        self.set_velocities(&mut resting, &vec![0.0; self.degrees]);
        resting
    }

    /// The rates of a point along the motion at `x'' = 0`.
    pub fn rates(&self, point: &[f64], _accelerations: &[f64]) -> Vec<f64> {
        let mut rates = vec![0.0; point.len()];
        rates[0] = 1.0;
        for (x, v) in self.x.iter().zip(&self.velocities) {
            rates[*x] = point[*v];
        }
        rates
    }
}

/// The point with each symbol moving at a rate.
pub fn lift(point: &[f64], rate: impl Fn(usize) -> f64) -> Vec<Dual<f64>> {
    point.iter().enumerate().map(|(k, value)| Dual { re: *value, du: rate(k) }).collect()
}
