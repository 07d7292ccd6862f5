//! The independent calculation: bodies are placed by hand-written functions of time and coordinates, everything else
//! follows by dual numbers and the law of virtual power, and multipliers are solved for densely.

use guen::{Dual, Real, System};
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

pub type Vector<R> = [R; 3];
pub type Matrix<R> = [[R; 3]; 3];

/// A body where it stands: mass and central inertia in its own axes, its centre, and the matrix of its axes.
pub struct Body<R> {
    pub mass: f64,
    pub inertia: Matrix<f64>,
    pub center: Vector<R>,
    pub rotation: Matrix<R>,
}

/// A system as a person writes it down without the macro.
pub trait ByHand {
    /// The bodies; a particle has no inertia.
    fn bodies<R: Real>(&self, t: R, x: &[R]) -> Vec<Body<R>>;

    /// Parameters and constraints in the order of the declaration, affine in the velocities `v`.
    fn forms<R: Real>(&self, t: R, x: &[R], v: &[R]) -> Vec<R>;

    fn gravity(&self) -> Vector<f64> {
        [0.0; 3]
    }

    /// Other generalised forces, along the coordinates.
    fn forces(&self, _t: f64, x: &[f64], _v: &[f64]) -> Vec<f64> {
        vec![0.0; x.len()]
    }
}

/// The rates of state and the multipliers: `M v' + h = Q + A^T lambda`, `A v' + b = 0`.
pub struct Motion {
    /// The values of all forms.
    pub forms: Vec<f64>,
    /// Their rates; those of the constraints vanish.
    pub rates: Vec<f64>,
    /// One for each constraint.
    pub multipliers: Vec<f64>,
}

/// What the law of virtual power says about a system at given coordinates and velocities; `degrees` forms are
/// parameters.
pub fn motion<H: ByHand>(hand: &H, degrees: usize, t: f64, x: &[f64], v: &[f64]) -> Motion {
    type Jet = Dual<Dual<f64, 1>, 1>;
    let n = x.len();
    // The path x + v s at t + s: values, first and second derivatives.
    let jet = |x: f64, v: f64| -> Jet {
        Dual { value: Dual { value: x, tangent: [v] }, tangent: [Dual::constant(v)] }
    };
    let path: Vec<Jet> = x.iter().zip(v).map(|(x, v)| jet(*x, *v)).collect();
    let moving = hand.bodies(jet(t, 1.0), &path);
    let displaced: Vec<_> =
        (0..n).map(|i| hand.bodies(Dual::constant(t), &along(x, |k| f64::from(u8::from(k == i))))).collect();

    let (mut mass, mut force) = (DMatrix::zeros(n, n), DVector::from(hand.forces(t, x, v)));
    let gravity = Vector3::from(hand.gravity());
    for (b, body) in moving.iter().enumerate() {
        let of = |pick: &dyn Fn(Jet) -> f64| {
            (Vector3::from(body.center.map(pick)), matrix(&body.rotation.map(|row| row.map(pick))))
        };
        let (_, turned) = of(&|e| e.value.value);
        let (_, turning) = of(&|e| e.tangent[0].value);
        let (acceleration, turning2) = of(&|e| e.tangent[0].tangent[0]);
        let omega = axial(&(turning * turned.transpose()));
        let alpha = axial(&(turning2 * turned.transpose()));
        let inertia = turned * matrix(&body.inertia) * turned.transpose();
        let inertial = body.mass * (gravity - acceleration);
        let gyroscopic = -(inertia * alpha + omega.cross(&(inertia * omega)));
        let columns: Vec<(Vector3<f64>, Vector3<f64>)> = displaced
            .iter()
            .map(|bodies| {
                let rate = matrix(&bodies[b].rotation.map(|row| row.map(|e| e.tangent[0])));
                (Vector3::from(bodies[b].center.map(|e| e.tangent[0])), axial(&(rate * turned.transpose())))
            })
            .collect();
        for (i, (p, w)) in columns.iter().enumerate() {
            force[i] += p.dot(&inertial) + w.dot(&gyroscopic);
            for (k, (q, u)) in columns.iter().enumerate() {
                mass[(i, k)] += body.mass * p.dot(q) + w.dot(&(inertia * u));
            }
        }
    }

    let constants = |v: &[f64]| v.iter().map(|v| Dual::constant(*v)).collect::<Vec<Dual<f64, 1>>>();
    let carried = hand.forms(Dual::variable(t, 0), &along(x, |k| v[k]), &constants(v));
    let rows: Vec<Vec<f64>> = (0..n)
        .map(|i| {
            let seeded = along(v, |k| f64::from(u8::from(k == i)));
            hand.forms(Dual::constant(t), &constants(x), &seeded).iter().map(|e| e.tangent[0]).collect()
        })
        .collect();
    let count = carried.len() - degrees;
    let mut system = DMatrix::zeros(n + count, n + count);
    let mut right = DVector::zeros(n + count);
    system.view_mut((0, 0), (n, n)).copy_from(&mass);
    right.rows_mut(0, n).copy_from(&force);
    for j in 0..count {
        right[n + j] = -carried[degrees + j].tangent[0];
        for i in 0..n {
            system[(n + j, i)] = rows[i][degrees + j];
            system[(i, n + j)] = -rows[i][degrees + j];
        }
    }
    let solved = system.full_piv_lu().solve(&right).expect("the motion is determined");
    let rates = carried
        .iter()
        .enumerate()
        .map(|(j, form)| form.tangent[0] + (0..n).map(|i| rows[i][j] * solved[i]).sum::<f64>())
        .collect();
    Motion {
        forms: carried.iter().map(|form| form.value).collect(),
        rates,
        multipliers: solved.rows(n, count).iter().copied().collect(),
    }
}

/// Asserts that a system at a state has the forms, the rates and the first reactions of the calculation by hand.
pub fn check<H, S, const N: usize>(
    system: &S,
    hand: &H,
    t: f64,
    state: &[f64; N],
    reactions: &[f64],
    n: usize,
) where
    H: ByHand,
    S: System<f64, N>,
{
    let found = system.rhs(t, state);
    let expected = motion(hand, N - n, t, &state[..n], &found[..n]);
    let scale = found.iter().chain(state).fold(1.0_f64, |most, e| most.max(e.abs()));
    for (j, form) in expected.forms.iter().enumerate() {
        let meant = if n + j < N { state[n + j] } else { 0.0 };
        assert!((form - meant).abs() <= 1e-12 * scale, "form {j}: {form} instead of {meant}");
    }
    close("rates", &found[n..], &expected.rates[..N - n]);
    if !reactions.is_empty() {
        close("reactions", reactions, &expected.multipliers[..reactions.len()]);
    }
}

/// Asserts that two vectors agree to 1e-11 of the larger one.
pub fn close(what: &str, found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len(), "{what}");
    let largest = found.iter().chain(expected).fold(1.0_f64, |most, e| most.max(e.abs()));
    for (i, (found, expected)) in found.iter().zip(expected).enumerate() {
        let error = (found - expected).abs();
        assert!(error <= 1e-11 * largest, "{what}, entry {i}: {found} instead of {expected}");
    }
}

/// Numbers in (-1, 1), the same in every run.
pub struct Numbers(u64);

impl Numbers {
    pub fn new() -> Self {
        Numbers(0x9E37_79B9_7F4A_7C15)
    }

    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    pub fn state<const N: usize>(&mut self) -> [f64; N] {
        std::array::from_fn(|_| self.next())
    }
}

/// Numbers that move at given rates.
fn along(x: &[f64], rate: impl Fn(usize) -> f64) -> Vec<Dual<f64, 1>> {
    x.iter().enumerate().map(|(i, x)| Dual { value: *x, tangent: [rate(i)] }).collect()
}

fn matrix(rows: &Matrix<f64>) -> Matrix3<f64> {
    Matrix3::from_fn(|i, k| rows[i][k])
}

/// The vector of the antisymmetric part.
fn axial(m: &Matrix3<f64>) -> Vector3<f64> {
    Vector3::new(m[(2, 1)] - m[(1, 2)], m[(0, 2)] - m[(2, 0)], m[(1, 0)] - m[(0, 1)]) / 2.0
}

/// A number.
pub fn real<R: Real>(value: f64) -> R {
    R::from_f64(value)
}

/// Coordinates and time on the path with velocities `v`, for functions that differentiate along it.
pub fn moving<R: Real>(t: R, x: &[R], v: &[R]) -> (Dual<R, 1>, Vec<Dual<R, 1>>) {
    let x = x.iter().zip(v).map(|(x, v)| Dual { value: *x, tangent: [*v] }).collect();
    (Dual { value: t, tangent: [R::one()] }, x)
}

/// The rates of a vector on a path.
pub fn rate<R: Real>(v: &Vector<Dual<R, 1>>) -> Vector<R> {
    v.map(|e| e.tangent[0])
}

/// The angular velocity of a matrix on a path, in the world.
pub fn spin<R: Real>(m: &Matrix<Dual<R, 1>>) -> Vector<R> {
    let entry = |i: usize, k: usize| {
        (0..3).fold(R::zero(), |sum, j| {
            sum + m[i][j].tangent[0] * m[k][j].value - m[k][j].tangent[0] * m[i][j].value
        })
    };
    let half = real::<R>(0.5);
    [half * entry(2, 1), half * entry(0, 2), half * entry(1, 0)]
}

/// The velocity of the point of a body that is at `p`.
pub fn velocity_at<R: Real>(body: &Body<Dual<R, 1>>, p: &Vector<R>) -> Vector<R> {
    let turning = cross(&spin(&body.rotation), &minus(p, &body.center.map(|e| e.value)));
    plus(&rate(&body.center), &turning)
}

pub fn plus<R: Real>(a: &Vector<R>, b: &Vector<R>) -> Vector<R> {
    std::array::from_fn(|i| a[i] + b[i])
}

pub fn minus<R: Real>(a: &Vector<R>, b: &Vector<R>) -> Vector<R> {
    std::array::from_fn(|i| a[i] - b[i])
}

pub fn times<R: Real>(a: R, v: &Vector<R>) -> Vector<R> {
    v.map(|e| a * e)
}

pub fn inner<R: Real>(a: &Vector<R>, b: &Vector<R>) -> R {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn cross<R: Real>(a: &Vector<R>, b: &Vector<R>) -> Vector<R> {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub fn apply<R: Real>(m: &Matrix<R>, v: &Vector<R>) -> Vector<R> {
    m.map(|row| inner(&row, v))
}

pub fn product<R: Real>(a: &Matrix<R>, b: &Matrix<R>) -> Matrix<R> {
    a.map(|row| std::array::from_fn(|k| inner(&row, &[b[0][k], b[1][k], b[2][k]])))
}

pub fn column<R: Real>(m: &Matrix<R>, k: usize) -> Vector<R> {
    [m[0][k], m[1][k], m[2][k]]
}

pub fn transposed<R: Real>(m: &Matrix<R>) -> Matrix<R> {
    std::array::from_fn(|k| column(m, k))
}

pub fn rot_x<R: Real>(angle: R) -> Matrix<R> {
    let (s, c, o, l) = (angle.sin(), angle.cos(), R::zero(), R::one());
    [[l, o, o], [o, c, -s], [o, s, c]]
}

pub fn rot_y<R: Real>(angle: R) -> Matrix<R> {
    let (s, c, o, l) = (angle.sin(), angle.cos(), R::zero(), R::one());
    [[c, o, s], [o, l, o], [-s, o, c]]
}

pub fn rot_z<R: Real>(angle: R) -> Matrix<R> {
    let (s, c, o, l) = (angle.sin(), angle.cos(), R::zero(), R::one());
    [[c, -s, o], [s, c, o], [o, o, l]]
}

/// The rotation of a unit quaternion, scalar part first, from the images of the axes `q e q*`.
pub fn by_quaternion<R: Real>(q: &[R]) -> Matrix<R> {
    let hamilton = |a: [R; 4], b: [R; 4]| -> [R; 4] {
        let (u, v) = ([a[1], a[2], a[3]], [b[1], b[2], b[3]]);
        let w = plus(&plus(&times(a[0], &v), &times(b[0], &u)), &cross(&u, &v));
        [a[0] * b[0] - inner(&u, &v), w[0], w[1], w[2]]
    };
    let q = [q[0], q[1], q[2], q[3]];
    let conjugate = [q[0], -q[1], -q[2], -q[3]];
    let columns: Matrix<R> = std::array::from_fn(|k| {
        let mut e = [R::zero(); 4];
        e[k + 1] = R::one();
        let image = hamilton(hamilton(q, e), conjugate);
        [image[1], image[2], image[3]]
    });
    transposed(&columns)
}

pub fn diagonal(moments: [f64; 3]) -> Matrix<f64> {
    let [a, b, c] = moments;
    [[a, 0.0, 0.0], [0.0, b, 0.0], [0.0, 0.0, c]]
}

pub const POINT: Matrix<f64> = [[0.0; 3]; 3];

pub fn upright<R: Real>() -> Matrix<R> {
    rot_z(R::zero())
}
