//! Parts that touch: stops of a hinge, a foot on level ground.

crate::mechanical_component! {
    /// A hinge or a slide with a stop at either end, and a damper between them.
    ///
    /// The stops are two contacts without friction, with the gaps `angle - lower` and `upper - angle`. They bounce by Poisson's law, and
    /// are never closed both.
    pub component HingeStops(
        /// The angle of the hinge, or the way of the slide.
        angle: scalar,
    ) {
        constants {
            /// The least angle.
            lower,
            /// The largest angle, above the least.
            upper,
            /// The coefficient of restitution of both stops.
            restitution in 0..1 = 0,
            /// The torque of the damper at one unit of speed.
            damping >= 0 = 0,
        }
        forces { -damping*dot(angle) along dot(angle); }
        contacts {
            /// The stop at the least angle.
            lower_stop: gap = angle - lower, restitution = restitution;
            /// The stop at the largest angle.
            upper_stop: gap = upper - angle, restitution = restitution;
        }
        modes { never lower_stop.closed with upper_stop.closed; }
        outputs {
            /// The torque of the stops on the hinge.
            torque = reaction(lower_stop) - reaction(upper_stop);
        }
    }
}

crate::mechanical_component! {
    /// A point that may touch level ground, stick, slip by Coulomb's law and lift off.
    ///
    /// The ground is the plane through the origin that is normal to `up`. In a system that moves in a plane the foot slips along a
    /// line; in space it slips in any direction, and `up` is an axis of the world.
    pub component Foot(
        /// The point: one that is fixed on its body.
        point: vector,
        /// The unit vector away from the ground, an axis of the world.
        up: vector,
    ) {
        constants {
            /// The coefficient of friction.
            friction >= 0,
            /// The coefficient of restitution.
            restitution in 0..1 = 0,
        }
        let velocity = dot(point);
        contacts {
            /// The point against the ground.
            sole:
                gap = inner(point, up), slip = velocity - inner(velocity, up)*up,
                friction = friction, restitution = restitution;
        }
        outputs {
            /// The height of the point above the ground.
            height = gap(sole);
            /// The force of the ground: along `up`, then along the directions of the slip.
            load = reaction(sole);
        }
    }
}
