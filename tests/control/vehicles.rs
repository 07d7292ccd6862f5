//! A robot that balances on two wheels, and a car with two trailers.

robot!(guen::mechanical_system;
    outputs {
        /// What an accelerometer in the chassis measures, in the world's axes.
        felt = dot(dot(chassis.center)) + vec(0, 0, g);
        pitching = dot(fall);
        grip = reaction(rolling);
    }
);
train!(guen::mechanical_system);

/// The robot with figures of a small one.
pub fn small_robot() -> robot::Prepared {
    Robot { m: 10.0, mw: 1.0, h: 0.5, b: 0.3, r: 0.1, A: 0.5, B: 0.4, C: 0.2, I: 0.003, J: 0.005, g: 9.81 }
        .prepare()
        .unwrap()
}

/// The car with its trailers.
pub fn small_train() -> train::Prepared {
    Train { m: 3.0, I: 1.3, l: 1.1, d: 0.9, k: 0.3 }.prepare().unwrap()
}
