//! Chains of point masses on rods.

use guen::mechanical_system;
use guen::prelude::*;

mechanical_system! {
    /// A chain of five rods.
    pub system Chain {
        count n = 5;
        constants   { m[n] > 0, l[n] > 0 = 0.1, c >= 0 = 0.01, g = 9.81 }
        coordinates { q[n] }
        let p[0] = l[0]*vec(sin(q[0]), -cos(q[0]));
        for i in 1..n { let p[i] = p[i-1] + l[i]*vec(sin(q[i]), -cos(q[i])); }
        parameters { for i in 0..n { w[i] = dot(q[i]); } }
        particles  { for i in 0..n { m[i] at p[i]; } }
        forces     { for i in 1..n { -c*(w[i] - w[i-1]) along w[i] - w[i-1]; } }
        gravity = vec(0, -g);
        outputs {
            kinetic = sum(i in 0..n: m[i]/2*inner(dot(p[i]), dot(p[i])));
            tip = p[n-1];
            for i in 0..n { height[i] = p[i].y; }
        }
    }
}

mod by_hand {
    guen::mechanical_system! {
        /// The same chain, without a loop.
        pub system Chain {
            constants {
                m0 > 0, m1 > 0, m2 > 0, m3 > 0, m4 > 0,
                l0 > 0 = 0.1, l1 > 0 = 0.1, l2 > 0 = 0.1, l3 > 0 = 0.1, l4 > 0 = 0.1, c >= 0 = 0.01, g = 9.81
            }
            coordinates { q0, q1, q2, q3, q4 }
            let p0 = l0*vec(sin(q0), -cos(q0));
            let p1 = p0 + l1*vec(sin(q1), -cos(q1));
            let p2 = p1 + l2*vec(sin(q2), -cos(q2));
            let p3 = p2 + l3*vec(sin(q3), -cos(q3));
            let p4 = p3 + l4*vec(sin(q4), -cos(q4));
            parameters { w0 = dot(q0); w1 = dot(q1); w2 = dot(q2); w3 = dot(q3); w4 = dot(q4); }
            particles { m0 at p0; m1 at p1; m2 at p2; m3 at p3; m4 at p4; }
            forces {
                -c*(w1 - w0) along w1 - w0;
                -c*(w2 - w1) along w2 - w1;
                -c*(w3 - w2) along w3 - w2;
                -c*(w4 - w3) along w4 - w3;
            }
            gravity = vec(0, -g);
            outputs {
                kinetic = m0/2*inner(dot(p0), dot(p0)) + m1/2*inner(dot(p1), dot(p1)) + m2/2*inner(dot(p2), dot(p2))
                    + m3/2*inner(dot(p3), dot(p3)) + m4/2*inner(dot(p4), dot(p4));
                tip = p4;
                height0 = p0.y; height1 = p1.y; height2 = p2.y; height3 = p3.y; height4 = p4.y;
            }
        }
    }
}

#[test]
fn a_loop_is_what_it_is_written_out() {
    let masses = [0.5, 0.4, 0.3, 0.2, 0.1];
    let family = Chain::new(masses).prepare().unwrap();
    let [m0, m1, m2, m3, m4] = masses;
    let single = by_hand::Chain::new(m0, m1, m2, m3, m4).prepare().unwrap();
    assert_eq!(chain::COST, by_hand::chain::COST);
    assert_eq!(chain::PREPARE_COST, by_hand::chain::PREPARE_COST);
    let values: [f64; 10] = [0.3, -0.2, 0.9, 1.4, 2.0, 0.1, -0.7, 0.4, 1.1, -2.0];
    let (state, other) = (chain::State::from(values), by_hand::chain::State::from(values));
    let rates: [f64; 10] = family.rhs(0.0, &state).into();
    let others: [f64; 10] = single.rhs(0.0, &other).into();
    assert_eq!(rates, others);
    assert_eq!(state.q, [0.3, -0.2, 0.9, 1.4, 2.0]);
    assert_eq!(state.w[4], -2.0);
    let (outputs, of_other) = (family.outputs(0.0, &state), single.outputs(0.0, &other));
    assert_eq!((outputs.kinetic, outputs.tip), (of_other.kinetic, of_other.tip));
    assert_eq!(outputs.height[3], of_other.height3);
    assert_eq!(
        chain::State::NAMES,
        ["q[0]", "q[1]", "q[2]", "q[3]", "q[4]", "w[0]", "w[1]", "w[2]", "w[3]", "w[4]"]
    );
}

#[test]
fn fields_are_arrays() {
    let chain = Chain { m: [1.0; 5], l: [0.1; 5], c: 0.0, g: 9.81 }.prepare().unwrap();
    assert_eq!(chain.constants().l, [0.1; 5]);
    let start = chain::State { q: [0.1; 5], ..Default::default() };
    assert_eq!(start.w, [0.0; 5]);
    assert_eq!(
        format!("{:?}", chain::State::from([1.0; 10])),
        "State { q: [1.0, 1.0, 1.0, 1.0, 1.0], w: [1.0, 1.0, 1.0, 1.0, 1.0] }"
    );
    let motion = chain.simulate(&start, 0.0..0.5).unwrap();
    assert!((chain.energy(0.5, &motion.end()) - chain.energy(0.0, &start)).abs() < 1e-7);
    let error = Chain { m: [1.0, 1.0, 1.0, -1.0, 1.0], l: [0.1; 5], c: 0.0, g: 9.81 }.prepare().unwrap_err();
    assert!(error.to_string().contains("m[3]"), "{error}");
}
