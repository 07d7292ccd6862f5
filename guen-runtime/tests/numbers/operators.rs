//! Operators over a prepared system: commutators against the closed form of the bracket, three levels deep.

use guen_runtime::{Coordinate, Dual, Function, Lift, Operator, Real};

/// What a generated `prepare` would return: constants of base `B`.
#[derive(Clone, Debug)]
struct Prepared<B> {
    a: B,
    b: B,
}

/// `X = d/dx + a sin(z) d/dy + x y d/dz`
#[derive(Clone, Copy, Debug, Default)]
struct X;

/// `Y = b z d/dx + cos(x) d/dy + d/dt`
#[derive(Clone, Copy, Debug, Default)]
struct Y;

/// `(X, Y) = X Y - Y X`, by hand:
///
/// ```text
/// X(b z) - Y(1)        = b x y
/// X(cos x) - Y(a sin z) = -sin x          (Y z = 0)
/// 0 - Y(x y)           = -(b z y + x cos x)
/// ```
#[derive(Clone, Copy, Debug, Default)]
struct Bracket;

impl<B: Real> Operator<B, 3> for X {
    type Prepared = Prepared<B>;
    const TIME: bool = false;
    fn coefficients<R: Real + Lift<B>>(p: &Prepared<B>, _t: R, &[x, y, z]: &[R; 3]) -> [R; 3] {
        [R::one(), R::lift(p.a) * z.sin(), x * y]
    }
}

impl<B: Real> Operator<B, 3> for Y {
    type Prepared = Prepared<B>;
    const TIME: bool = true;
    fn coefficients<R: Real + Lift<B>>(p: &Prepared<B>, _t: R, &[x, _, z]: &[R; 3]) -> [R; 3] {
        [R::lift(p.b) * z, x.cos(), R::zero()]
    }
}

impl<B: Real> Operator<B, 3> for Bracket {
    type Prepared = Prepared<B>;
    const TIME: bool = false;
    fn coefficients<R: Real + Lift<B>>(p: &Prepared<B>, _t: R, &[x, y, z]: &[R; 3]) -> [R; 3] {
        let b = R::lift(p.b);
        [b * x * y, -x.sin(), -(b * z * y + x * x.cos())]
    }
}

/// `exp(x y) sin(z) + t^2 x`, with the weaker bound, and for every base.
#[derive(Clone, Copy)]
struct F;

impl<B> Function<3, B> for F {
    fn at<R: Real>(&self, t: R, &[x, y, z]: &[R; 3]) -> R {
        (x * y).exp() * z.sin() + t * t * x
    }
}

const POINTS: [(f64, [f64; 3]); 3] =
    [(0.3, [0.7, -0.4, 1.1]), (-1.2, [0.2, 0.9, -0.6]), (0.0, [-0.5, 0.3, 2.4])];

#[track_caller]
fn assert_close(computed: f64, expected: f64) {
    assert!((computed - expected).abs() < 1e-13 * expected.abs().max(1.0), "{computed} != {expected}");
}

fn prepared() -> Prepared<f64> {
    Prepared { a: 0.8, b: 1.7 }
}

#[test]
fn an_operator_differentiates_along_itself() {
    let p = prepared();
    for (t, [x, y, z]) in POINTS {
        let exp = (x * y).exp();
        let along_x = (y * exp * z.sin() + t * t) + 0.8 * z.sin() * x * exp * z.sin() + x * y * exp * z.cos();
        assert_close(X.apply(&p, &F, t, &[x, y, z]), along_x);
        let along_y = 2.0 * t * x + 1.7 * z * (y * exp * z.sin() + t * t) + x.cos() * x * exp * z.sin();
        assert_close(Y.apply(&p, &F, t, &[x, y, z]), along_y);
    }
}

#[test]
fn applied_to_coordinates_an_operator_gives_its_coefficients() {
    let p = prepared();
    for (t, x) in POINTS {
        let applied = [
            X.apply(&p, &Coordinate::<0>, t, &x),
            X.apply(&p, &Coordinate::<1>, t, &x),
            X.apply(&p, &Coordinate::<2>, t, &x),
        ];
        assert_eq!(applied, X::coefficients(&p, t, &x));
    }
}

#[test]
fn the_commutator_is_the_bracket() {
    let p = prepared();
    for (t, x) in POINTS {
        let commutator = X.apply(&p, &Y.of(&p, F), t, &x) - Y.apply(&p, &X.of(&p, F), t, &x);
        assert_close(commutator, Bracket.apply(&p, &F, t, &x));
    }
}

#[test]
fn operators_nest_three_deep() {
    // The commutator of X with the bracket, each bracket once by its closed form and once by nesting.
    let p = prepared();
    let (xf, yf) = (X.of(&p, F), Y.of(&p, F));
    for (t, x) in POINTS {
        let by_nesting = X.apply(&p, &X.of(&p, &yf), t, &x)
            - X.apply(&p, &Y.of(&p, &xf), t, &x)
            - X.apply(&p, &Y.of(&p, &xf), t, &x)
            + Y.apply(&p, &X.of(&p, &xf), t, &x);
        let by_bracket = X.apply(&p, &Bracket.of(&p, F), t, &x) - Bracket.apply(&p, &xf, t, &x);
        assert_close(by_nesting, by_bracket);
    }
}

/// The sum of functions is a function: what a user may write over the same traits.
struct Sum<F, G>(F, G);

impl<B, F: Function<3, B>, G: Function<3, B>> Function<3, B> for Sum<F, G> {
    fn at<R: Real + Lift<B>>(&self, t: R, x: &[R; 3]) -> R {
        self.0.at(t, x) + self.1.at(t, x)
    }
}

/// The commutator of two operators as an operator, its coefficients by nesting: what a user may write.
#[derive(Clone, Copy, Debug)]
struct Commutator<P, Q>(P, Q);

impl<B, P, Q> Operator<B, 3> for Commutator<P, Q>
where
    B: Real,
    P: Operator<B, 3, Prepared = Prepared<B>> + Default,
    Q: Operator<B, 3, Prepared = Prepared<B>> + Default,
{
    type Prepared = Prepared<B>;
    const TIME: bool = false;
    fn coefficients<R: Real + Lift<B>>(p: &Prepared<B>, t: R, x: &[R; 3]) -> [R; 3] {
        fn entry<B, R, P, Q, const I: usize>(p: &Prepared<B>, t: R, x: &[R; 3]) -> R
        where
            B: Real,
            R: Real + Lift<B>,
            P: Operator<B, 3, Prepared = Prepared<B>> + Default,
            Q: Operator<B, 3, Prepared = Prepared<B>> + Default,
        {
            let (first, second) = (P::default(), Q::default());
            first.apply(p, &second.of(p, Coordinate::<I>), t, x)
                - second.apply(p, &first.of(p, Coordinate::<I>), t, x)
        }
        [entry::<B, R, P, Q, 0>(p, t, x), entry::<B, R, P, Q, 1>(p, t, x), entry::<B, R, P, Q, 2>(p, t, x)]
    }
}

impl<P: Default, Q: Default> Default for Commutator<P, Q> {
    fn default() -> Self {
        Self(P::default(), Q::default())
    }
}

/// `Z = y d/dx + x z d/dy + d/dz`
#[derive(Clone, Copy, Debug, Default)]
struct Z;

impl<B: Real> Operator<B, 3> for Z {
    type Prepared = Prepared<B>;
    const TIME: bool = false;
    fn coefficients<R: Real + Lift<B>>(_: &Prepared<B>, _t: R, &[x, y, z]: &[R; 3]) -> [R; 3] {
        [y, x * z, R::one()]
    }
}

#[test]
fn the_commutator_of_coordinates_has_the_coefficients_of_the_bracket() {
    let p = prepared();
    for (t, x) in POINTS {
        let nested = Commutator::<X, Y>::coefficients(&p, t, &x);
        let closed = Bracket::coefficients(&p, t, &x);
        nested.into_iter().zip(closed).for_each(|(nested, closed)| assert_close(nested, closed));
    }
}

#[test]
fn operators_obey_the_jacobi_identity() {
    // (X, (Y, Z)) + (Y, (Z, X)) + (Z, (X, Y)) = 0, four levels of duals on a function
    let p = prepared();
    for (t, x) in POINTS {
        let one = Commutator(X, Commutator(Y, Z)).apply(&p, &F, t, &x);
        let two = Commutator(Y, Commutator(Z, X)).apply(&p, &F, t, &x);
        let three = Commutator(Z, Commutator(X, Y)).apply(&p, &F, t, &x);
        assert!(one.abs() > 1e-3 && two.abs() > 1e-3 && three.abs() > 1e-3, "{one} {two} {three}");
        assert_close(one + two + three, 0.0);
    }
}

#[test]
fn functions_compose_and_bases_may_be_short() {
    let p = Prepared { a: 0.5_f32, b: 1.5 };
    let twice = Sum(Coordinate::<1>, Coordinate::<1>);
    let x = [0.25_f32, 0.5, 1.0];
    let lone: f32 = X.apply(&p, &Coordinate::<1>, 0.0, &x);
    assert_eq!(X.apply(&p, &twice, 0.0, &x), 2.0 * lone);
}

#[test]
fn an_operator_works_in_duals_over_the_base() {
    // d/dx (X y) = d/dx (a sin z) = 0, d/dz (X y) = a cos z
    let p = prepared();
    let x: [Dual<f64, 3>; 3] = std::array::from_fn(|i| Dual::variable(POINTS[0].1[i], i));
    let result = X.apply(&p, &Coordinate::<1>, Dual::zero(), &x);
    assert_eq!(result.tangent, [0.0, 0.0, 0.8 * Real::cos(1.1_f64)]);
}
