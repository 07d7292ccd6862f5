//! A function that the program supplies gives what the same function gives that is written in the declaration: rates, energies, linearisations,
//! reactions, on a terrain as a struct, as a table and as a grid.

use guen::prelude::*;
use guen::{Grid, Smooth, Table};

/// `h sin(x) cos(2 y)`, written for every real.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Waves {
    h: f64,
}

impl Smooth<2> for Waves {
    fn value<R: Real>(&self, [x, y]: [R; 2]) -> R {
        R::from_f64(self.h) * x.sin() * (y + y).cos()
    }
}

guen::mechanical_system! {
    /// A bead on a terrain that the program supplies, with friction.
    pub system Supplied {
        constants   { m > 0, c >= 0, g = 9.81 }
        functions   { ground(x, y); }
        coordinates { x, y, z }
        holonomic   { on_ground: z = ground(x, y); }
        parameters  { u = dot(x); v = dot(y); }
        particles   { m at vec(x, y, z); }
        gravity     = vec(0, 0, -g);
        forces      { -c*(1 + ground(u, x))*u along u; }
        outputs     { slope = dot(ground(x, y)); place = vec(x, y, ground(x, y)); curve = dot(dot(ground(x, y))); }
    }
}

guen::mechanical_system! {
    /// The same with the terrain written out.
    pub system Written {
        constants   { m > 0, c >= 0, h, g = 9.81 }
        coordinates { x, y, z }
        fn ground(x, y) = h*sin(x)*cos(2*y);
        holonomic   { on_ground: z = ground(x, y); }
        parameters  { u = dot(x); v = dot(y); }
        particles   { m at vec(x, y, z); }
        gravity     = vec(0, 0, -g);
        forces      { -c*(1 + ground(u, x))*u along u; }
        outputs     { slope = dot(ground(x, y)); place = vec(x, y, ground(x, y)); curve = dot(dot(ground(x, y))); }
    }
}

fn states() -> impl Iterator<Item = [f64; 5]> {
    (0..20).map(|i| std::array::from_fn(|k| ((i * 7 + k * 3 + 1) as f64 * 0.618).fract() * 4.0 - 2.0))
}

fn assert_near(a: &[f64], b: &[f64], what: &str) {
    assert_eq!(a.len(), b.len());
    for (a, b) in a.iter().zip(b) {
        // Both are sums of some fifty products of numbers below a hundred.
        assert!((a - b).abs() <= 1e-12 * (1.0 + b.abs()), "{what}: {a} and {b}");
    }
}

#[test]
fn a_function_of_the_program_is_the_one_that_is_written_out() {
    let h = 0.7;
    let one = Supplied { m: 2.0, c: 0.3, g: 9.81, ground: Waves { h } }.prepare().unwrap();
    let other = Written { m: 2.0, c: 0.3, h, g: 9.81 }.prepare().unwrap();
    for values in states() {
        let (a, b) = (supplied::State::from(values), written::State::from(values));
        let rates = (<[f64; 5]>::from(one.rhs(0.0, &a)), <[f64; 5]>::from(other.rhs(0.0, &b)));
        assert_near(&rates.0, &rates.1, "rates");
        assert_near(&[one.energy(0.0, &a)], &[other.energy(0.0, &b)], "energy");
        assert_near(&[one.power(0.0, &a)], &[other.power(0.0, &b)], "power");
        assert_near(
            one.linearize(0.0, &a).a.as_flattened(),
            other.linearize(0.0, &b).a.as_flattened(),
            "linearisation",
        );
        assert_near(&[one.reactions(0.0, &a).on_ground], &[other.reactions(0.0, &b).on_ground], "reactions");
        assert_near(&[one.residuals(0.0, &a).on_ground], &[other.residuals(0.0, &b).on_ground], "residuals");
        let (of_one, of_other) = (one.outputs(0.0, &a), other.outputs(0.0, &b));
        assert_near(&[of_one.slope, of_one.curve], &[of_other.slope, of_other.curve], "outputs");
        assert_near(
            one.linearize_outputs(0.0, &a).c.as_flattened(),
            other.linearize_outputs(0.0, &b).c.as_flattened(),
            "linearised outputs",
        );
        assert_near(
            one.jacobian(0.0, &a, |of| of.place).as_flattened(),
            other.jacobian(0.0, &b, |of| of.place).as_flattened(),
            "Jacobian",
        );
        assert_near(
            &one.bias_acceleration(0.0, &a, |of| of.place),
            &other.bias_acceleration(0.0, &b, |of| of.place),
            "bias",
        );
    }
}

#[test]
fn motions_are_those_of_the_function_that_is_written_out() {
    let h = 0.2;
    let one = Supplied { m: 1.0, c: 0.1, g: 9.81, ground: Waves { h } }.prepare().unwrap();
    let other = Written { m: 1.0, c: 0.1, h, g: 9.81 }.prepare().unwrap();
    let given = supplied::Coordinates { x: 0.4, y: 0.2, z: 0.0 };
    let start = one.consistent(0.0, &given, &["x", "y"]).unwrap();
    assert!((start.z - h * 0.4_f64.sin() * 0.4_f64.cos()).abs() < 1e-15);
    let values = [start.x, start.y, start.z, 0.3, -0.2];
    let ends = (
        <[f64; 5]>::from(one.simulate(&supplied::State::from(values), 0.0..3.0).unwrap().end()),
        <[f64; 5]>::from(other.simulate(&written::State::from(values), 0.0..3.0).unwrap().end()),
    );
    for (a, b) in ends.0.iter().zip(ends.1) {
        // Both have tolerances of 1e-9 in each step.
        assert!((a - b).abs() < 1e-7, "{ends:?}");
    }
}

guen::mechanical_system! {
    /// A bead on a track.
    pub system OnTable {
        constants   { m > 0, g = 9.81 }
        functions   { track(x); }
        coordinates { x }
        parameters  { u = dot(x); }
        particles   { m at vec(x, track(x)); }
        gravity     = vec(0, -g);
    }
}

guen::mechanical_system! {
    /// A bead on `3/2 x - x^3/2`.
    pub system OnCubic {
        constants   { m > 0, g = 9.81 }
        coordinates { x }
        parameters  { u = dot(x); }
        particles   { m at vec(x, 3/2*x - x^3/2); }
        gravity     = vec(0, -g);
    }
}

/// The natural spline through three points whose first piece is `3/2 x - x^3/2`.
const HUMP: [(f64, f64); 3] = [(0.0, 0.0), (1.0, 1.0), (2.0, 0.0)];

#[test]
fn a_bead_on_a_table_moves_as_on_its_cubic() {
    let table = OnTable { m: 0.5, g: 9.81, track: Table::new(HUMP).unwrap() }.prepare().unwrap();
    let cubic = OnCubic { m: 0.5, g: 9.81 }.prepare().unwrap();
    for i in 1..20 {
        let (x, u) = (0.05 * f64::from(i), 0.3 * f64::from(i) - 2.0);
        let (a, b) = (on_table::State { x, u }, on_cubic::State { x, u });
        assert_near(&[table.rhs(0.0, &a).u], &[cubic.rhs(0.0, &b).u], "rates on a table");
        let (a, b) = (table.linearize(0.0, &a).a, cubic.linearize(0.0, &b).a);
        assert_near(a.as_flattened(), b.as_flattened(), "linearisation on a table");
        // The other piece is the mirror image.
        let mirrored = on_table::State { x: 2.0 - x, u: -u };
        assert_near(
            &[table.rhs(0.0, &mirrored).u],
            &[-cubic.rhs(0.0, &on_cubic::State { x, u }).u],
            "mirror",
        );
    }
}

guen::mechanical_system! {
    /// A bead on a terrain in two coordinates.
    pub system OnGrid {
        constants   { m > 0, g = 9.81 }
        functions   { ground(x, y); }
        coordinates { x, y }
        parameters  { u = dot(x); v = dot(y); }
        particles   { m at vec(x, y, ground(x, y)); }
        gravity     = vec(0, 0, -g);
    }
}

guen::mechanical_system! {
    /// A bead on a product of two cubics.
    pub system OnProduct {
        constants   { m > 0, g = 9.81 }
        coordinates { x, y }
        fn hump(x)  = 3/2*x - x^3/2;
        parameters  { u = dot(x); v = dot(y); }
        particles   { m at vec(x, y, hump(x)*hump(y)); }
        gravity     = vec(0, 0, -g);
    }
}

#[test]
fn a_bead_on_a_grid_moves_as_on_its_bicubic() {
    let knots = HUMP.map(|(x, _)| x);
    let values = HUMP.map(|(_, a)| HUMP.map(|(_, b)| a * b));
    let ground = Grid::new(knots, knots, values).unwrap();
    let grid = OnGrid { m: 0.5, g: 9.81, ground }.prepare().unwrap();
    let product = OnProduct { m: 0.5, g: 9.81 }.prepare().unwrap();
    for values in states() {
        let [x, y, u, v] = [values[0], values[1], values[2], values[3]];
        let (x, y) = (0.25 * (x + 2.0), 0.25 * (y + 2.0));
        let (a, b) = (on_grid::State { x, y, u, v }, on_product::State { x, y, u, v });
        let (one, other) = (<[f64; 4]>::from(grid.rhs(0.0, &a)), <[f64; 4]>::from(product.rhs(0.0, &b)));
        assert_near(&one, &other, "rates on a grid");
        let (a, b) = (grid.linearize(0.0, &a).a, product.linearize(0.0, &b).a);
        assert_near(a.as_flattened(), b.as_flattened(), "linearisation on a grid");
    }
}

guen::mechanical_system! {
    /// A chain on a bumpy floor that the program supplies: rates of more than a hundred statements.
    pub system LongSupplied {
        count n = 4;
        constants   { m[n] > 0, l > 0, g = 9.81 }
        functions   { bump(x); drag(speed, place); }
        coordinates { q[n] }
        let p[0] = l*vec(sin(q[0]), -cos(q[0]));
        for i in 1..n { let p[i] = p[i-1] + l*vec(sin(q[i]), -cos(q[i])); }
        parameters  { for i in 0..n { w[i] = dot(q[i]); } }
        particles   { for i in 0..n { m[i] at p[i] + vec(0, bump(p[i].x)); } }
        gravity     = vec(0, -g);
        forces      { for i in 0..n { -drag(w[i], p[i].y) along w[i]; } }
    }
}

guen::mechanical_system! {
    /// The same with the functions written out.
    pub system LongWritten {
        count n = 4;
        constants   { m[n] > 0, l > 0, h, g = 9.81 }
        fn bump(x)  = h*sin(x);
        fn drag(speed, place) = h*sin(speed)*cos(2*place);
        coordinates { q[n] }
        let p[0] = l*vec(sin(q[0]), -cos(q[0]));
        for i in 1..n { let p[i] = p[i-1] + l*vec(sin(q[i]), -cos(q[i])); }
        parameters  { for i in 0..n { w[i] = dot(q[i]); } }
        particles   { for i in 0..n { m[i] at p[i] + vec(0, bump(p[i].x)); } }
        gravity     = vec(0, -g);
        forces      { for i in 0..n { -drag(w[i], p[i].y) along w[i]; } }
    }
}

/// `h sin x`.
#[derive(Clone, Copy)]
struct Bump(f64);

impl Smooth<1> for Bump {
    fn value<R: Real>(&self, [x]: [R; 1]) -> R {
        R::from_f64(self.0) * x.sin()
    }
}

#[test]
fn long_programs_hand_values_of_functions_from_block_to_block() {
    let (m, h) = ([1.0, 0.5, 2.0, 0.7], 0.3);
    let one = LongSupplied { m, l: 0.4, g: 9.81, bump: Bump(h), drag: Waves { h } }.prepare().unwrap();
    let other = LongWritten { m, l: 0.4, h, g: 9.81 }.prepare().unwrap();
    assert!(long_supplied::COST.total() > 200);
    for values in states() {
        let q = std::array::from_fn(|k| values[k]);
        let w = std::array::from_fn(|k| values[4 - k]);
        let a = one.rhs(0.0, &long_supplied::State { q, w }).w;
        let b = other.rhs(0.0, &long_written::State { q, w }).w;
        for (a, b) in a.iter().zip(b) {
            // The mass matrix has a condition of some hundreds.
            assert!((a - b).abs() < 1e-10 * (1.0 + b.abs()), "{a} {b}");
        }
    }
}
