//! Where is the hoop? An extended Kalman filter for a rolling hoop, on a camera and an inclinometer that are noisy.
//!
//! ```text
//! cargo run --release --example estimator
//! ```
//!
//! The filter predicts with the declared hoop and the exact Jacobian of its flow over a period, and corrects with the
//! exact Jacobian of its outputs. It works in the reduced basis: the hoop's height is a sine of its tilt, so that it is
//! no state of the filter, and its covariance is never singular.

use std::error::Error;
use std::process::ExitCode;

use guen::control::FlowMap;
use guen::mechanical_system;
use guen_study::{Plot, Table};
use nalgebra::{SMatrix, SVector};

#[path = "common/folder.rs"]
mod folder;

mechanical_system! {
    /// A hoop of radius `a` that rolls without slipping on a horizontal plane.
    pub system Hoop {
        constants { a > 0, A > 0, C > 0, g = 9.81 }
        coordinates { theta, psi, phi, xi, eta, zeta }
        parameters {
            eta1 = dot(theta);
            eta2 = dot(psi)*sin(theta);
            eta3 = dot(psi)*cos(theta) + dot(phi);
        }
        let frame = rot_z(psi)*rot_x(theta);
        bodies { hoop { mass: 1, inertia: diag(A, A, C), center: vec(xi, eta, zeta), orientation: frame*rot_z(phi) } }
        gravity = vec(0, 0, -g);
        constraints { rolling: hoop.velocity_at(hoop.center - a*frame.y) = 0; }
        outputs {
            /// What the camera sees.
            center = hoop.center;
            tilt = theta;
        }
    }
}

const PERIOD: f64 = 0.02;
const UNTIL: f64 = 20.0;
/// Standard deviations of a measurement: metres, and radians.
const CAMERA: f64 = 0.03;
const INCLINOMETER: f64 = 0.02;
/// What the model does not know of the accelerations, as a standard deviation of the change in one period.
const UNKNOWN: f64 = 3e-3;

/// States of the filter, and measurements.
const Z: usize = hoop::REDUCED;
const P: usize = 4;
const N: usize = 9;

/// What the filter has to reach: errors by its own measure, and by ours.
const BAND: std::ops::Range<f64> = 0.5..2.0;
const TILT_ERROR: f64 = 0.01;
const PLACE_ERROR: f64 = 0.02;

/// Normal deviates by Box and Muller, the same every time.
struct Noise(u64);

impl Noise {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
    }

    fn normal(&mut self) -> f64 {
        (-2.0 * self.uniform().ln()).sqrt() * (2.0 * std::f64::consts::PI * self.uniform()).cos()
    }
}

/// The filter: a state, and the covariance of its error in the reduced basis there.
struct Filter {
    state: [f64; N],
    covariance: SMatrix<f64, Z, Z>,
}

fn matrix<const I: usize, const J: usize>(rows: &[[f64; J]; I]) -> SMatrix<f64, I, J> {
    SMatrix::from_fn(|i, j| rows[i][j])
}

/// Coordinates of the basis: the height follows from the tilt.
const INDEPENDENT: [&str; 5] = ["theta", "psi", "phi", "xi", "eta"];

impl Filter {
    /// `z -> Phi z`, with the Jacobian of the flow between the bases of both ends.
    fn predict(&mut self, hoop: &hoop::Prepared, t: f64) -> Result<(), Box<dyn Error>> {
        let here = hoop.reduce(t, &self.state.into(), &INDEPENDENT)?;
        let flow = FlowMap::new(hoop, t, &self.state, &[], PERIOD, 2)?;
        let there = hoop.reduce(t + PERIOD, &flow.next.into(), &INDEPENDENT)?;
        let phi = matrix(&there.projection) * matrix(&flow.phi) * matrix(&here.basis);
        let unknown = SVector::<f64, Z>::from_fn(|i, _| if i < 5 { 0.0 } else { UNKNOWN * UNKNOWN });
        self.covariance = phi * self.covariance * phi.transpose() + SMatrix::from_diagonal(&unknown);
        self.state = flow.next;
        Ok(())
    }

    /// Takes in a measurement of the outputs.
    fn correct(&mut self, hoop: &hoop::Prepared, t: f64, measured: &[f64; P]) -> Result<(), Box<dyn Error>> {
        let state = self.state.into();
        let basis = hoop.reduce(t, &state, &INDEPENDENT)?;
        let c = matrix(&basis.outputs(&hoop.linearize_outputs(t, &state)).c);
        let expected = outputs(hoop, t, &state);
        let surprise = SVector::<f64, P>::from_fn(|i, _| measured[i] - expected[i]);
        let spread = c * self.covariance * c.transpose() + SMatrix::from_diagonal(&variances());
        let gain = self.covariance * c.transpose() * spread.try_inverse().ok_or("the spread is singular")?;
        let change: [f64; Z] = (gain * surprise).into();
        let moved = basis.lift(&change);
        for (x, dx) in self.state.iter_mut().zip(moved) {
            *x += dx;
        }
        // Along the leaf to first order; the rest by the sine itself.
        self.state[5] = hoop.constants().a * self.state[0].sin();
        let kept = SMatrix::<f64, Z, Z>::identity() - gain * c;
        // In Joseph's form it stays symmetric and positive.
        self.covariance = kept * self.covariance * kept.transpose()
            + gain * SMatrix::from_diagonal(&variances()) * gain.transpose();
        Ok(())
    }
}

fn variances() -> SVector<f64, P> {
    [CAMERA * CAMERA, CAMERA * CAMERA, CAMERA * CAMERA, INCLINOMETER * INCLINOMETER].into()
}

fn outputs(hoop: &hoop::Prepared, t: f64, state: &hoop::State) -> [f64; P] {
    let hoop::Outputs { center, tilt } = hoop.outputs(t, state);
    [center[0], center[1], center[2], tilt]
}

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let hoop = Hoop { a: 0.5, A: 0.125, C: 0.25, g: 9.81 }.prepare()?;
    let mut noise = Noise(20);
    let mut truth = hoop::State {
        theta: 1.3,
        zeta: 0.5 * 1.3_f64.sin(),
        eta1: 0.1,
        eta2: 0.4,
        eta3: 5.0,
        ..Default::default()
    };

    // The filter begins with a guess that is off by what its covariance says.
    let spread = [0.05, 0.2, 0.2, 0.1, 0.1, 0.3, 0.3, 0.5];
    let mut guess: [f64; N] = truth.into();
    for (place, size) in [0, 1, 2, 3, 4, 6, 7, 8].into_iter().zip(spread) {
        guess[place] += size * noise.normal();
    }
    guess[5] = 0.5 * guess[0].sin();
    let covariance = SMatrix::from_diagonal(&SVector::from(spread.map(|s| s * s)));
    let mut filter = Filter { state: guess, covariance };

    let mut record = Vec::new();
    let mut consistency = 0.0;
    for k in 1..=(UNTIL / PERIOD) as usize {
        let t = (k - 1) as f64 * PERIOD;
        truth = guen::steppers::rk4::step(&hoop, t, &truth.into(), PERIOD).into();
        // The floor is not even.
        truth.eta1 += UNKNOWN * noise.normal();
        truth.eta2 += UNKNOWN * noise.normal();
        truth.eta3 += UNKNOWN * noise.normal();
        filter.predict(&hoop, t)?;
        let exact = outputs(&hoop, t + PERIOD, &truth);
        let deviations = variances().map(f64::sqrt);
        let measured = std::array::from_fn(|i| exact[i] + deviations[i] * noise.normal());
        filter.correct(&hoop, t + PERIOD, &measured)?;
        let (exact, found): ([f64; N], [f64; N]) = (truth.into(), filter.state);
        let error = SVector::<f64, Z>::from_iterator(
            [0, 1, 2, 3, 4, 6, 7, 8].into_iter().map(|i| found[i] - exact[i]),
        );
        // The mean square of the error in units of its own covariance: one, if the filter knows what it knows.
        let inverse = filter.covariance.try_inverse().ok_or("the covariance is singular")?;
        consistency += (error.transpose() * inverse * error)[0] / Z as f64;
        record.push((t + PERIOD, truth, hoop::State::from(found), measured, filter.covariance));
    }
    consistency /= record.len() as f64;

    let mut table =
        Table::new(&["t", "tilt", "estimated", "xi", "estimated", "eta2", "estimated", "phi - estimated"])
            .digits(4);
    for (t, s, e, ..) in record.iter().step_by(record.len() / 10) {
        table.row(&[*t, s.theta, e.theta, s.xi, e.xi, s.eta2, e.eta2, s.phi - e.phi]);
    }
    println!("{table}\n");
    let pictures = folder::folder("estimator");
    Plot::new("The hoop's centre from above")
        .equal_scale(true)
        .axes("xi in m", "eta in m")
        .line("measured", record.iter().map(|(_, _, _, m, _)| (m[0], m[1])))
        // Broad and behind: the estimate lies on it.
        .band("true", record.iter().map(|(_, s, ..)| (s.xi, s.eta)))
        .line("estimated", record.iter().map(|(_, _, e, ..)| (e.xi, e.eta)))
        .save(pictures.join("track.svg"))?;
    let sigma = |k: usize| record.iter().map(move |(t, _, _, _, p)| (*t, 2.0 * p[(k, k)].sqrt()));
    // A point that is not a number breaks the curve: the bounds above and below are two parts of one curve.
    let gap = [(f64::NAN, f64::NAN)];
    Plot::new("The error of the tilt, and two standard deviations of the filter")
        .axes("t in s", "rad")
        .line("error", record.iter().map(|(t, s, e, ..)| (*t, e.theta - s.theta)))
        .line("two standard deviations", sigma(0).chain(gap).chain(sigma(0).map(|(t, s)| (t, -s))))
        .save(pictures.join("tilt.svg"))?;
    Plot::new("What is not measured: the turning eta2")
        .axes("t in s", "rad/s")
        .band("true", record.iter().map(|(t, s, ..)| (*t, s.eta2)))
        .line("estimated", record.iter().map(|(t, _, e, ..)| (*t, e.eta2)))
        .save(pictures.join("turning.svg"))?;
    println!("pictures: track.svg, tilt.svg and turning.svg in {}", pictures.display());

    let half = record.len() / 2;
    let root = |f: &dyn Fn(&hoop::State, &hoop::State) -> f64| {
        let sum: f64 = record[half..].iter().map(|(_, s, e, ..)| f(s, e)).sum();
        (sum / (record.len() - half) as f64).sqrt()
    };
    let tilt = root(&|s, e| (s.theta - e.theta).powi(2));
    let place = root(&|s, e| (s.xi - e.xi).powi(2) + (s.eta - e.eta).powi(2));
    println!(
        "errors in the second half: tilt {tilt:.4} rad (measured to {INCLINOMETER}), place {place:.4} m (to {CAMERA})"
    );
    println!("mean square of the error in units of its covariance: {consistency:.2}");
    let works = BAND.contains(&consistency) && tilt < TILT_ERROR && place < PLACE_ERROR;
    Ok(if works { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
