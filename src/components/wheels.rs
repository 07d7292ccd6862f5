//! Wheels, blades and casters on the plane `z = 0`.

crate::mechanical_component! {
    /// A wheel that stands upright on the plane `z = 0` and rolls without slipping.
    ///
    /// Its hub may not move across the wheel, and along it only as fast as the wheel turns: the two nonholonomic constraints of
    /// the joint `RollingWheel` of the Modelica Standard Library (`Modelica.Mechanics.MultiBody.Joints`). That the hub stays at
    /// the height of the radius follows from the hub that is given. Two of these wheels on one axle say twice that the axle does
    /// not slide: there use one, and [`SideslipWheel`] for the other.
    ///
    /// The moment of inertia about the vertical belongs to what the wheel is mounted on.
    pub component RollingWheel(
        /// The centre of the wheel.
        hub: vector,
        /// The unit vector along the axle.
        axle: vector,
        /// The unit vector in which the wheel rolls, horizontal and normal to the axle.
        forward: vector,
        /// The radius.
        radius: scalar,
    ) {
        constants {
            /// The mass of the wheel.
            mass >= 0,
            /// The moment of inertia about the axle.
            spin_inertia > 0,
        }
        coordinates {
            /// The angle by which the wheel has turned.
            angle
        }
        particles   { mass at hub; }
        kinetic_energy = 1/2*spin_inertia*dot(angle)^2;
        constraints {
            /// The point of contact does not slip along the wheel.
            rolls: inner(dot(hub), forward) = radius*dot(angle);
            /// The point of contact does not slip across the wheel.
            grips: inner(dot(hub), axle) = 0;
        }
    }
}

crate::mechanical_component! {
    /// A wheel that rolls without slipping along its plane, and slides across it against a viscous force.
    ///
    /// That is the rolling constraint of a wheel set, as `RollingConstraintVerticalWheel` of the Modelica Standard Library has it
    /// where its lateral constraint is left out: several wheels may share an axle or be carried by one rigid frame.
    pub component SideslipWheel(
        /// The centre of the wheel.
        hub: vector,
        /// The unit vector along the axle.
        axle: vector,
        /// The unit vector in which the wheel rolls, horizontal and normal to the axle.
        forward: vector,
        /// The radius.
        radius: scalar,
    ) {
        constants {
            /// The mass of the wheel.
            mass >= 0,
            /// The moment of inertia about the axle.
            spin_inertia > 0,
            /// The force across the wheel at one unit of speed.
            side_damping >= 0,
        }
        coordinates {
            /// The angle by which the wheel has turned.
            angle
        }
        particles   { mass at hub; }
        kinetic_energy = 1/2*spin_inertia*dot(angle)^2;
        let sideslip = inner(dot(hub), axle);
        constraints {
            /// The point of contact does not slip along the wheel.
            rolls: inner(dot(hub), forward) = radius*dot(angle);
        }
        forces      { -side_damping*sideslip along sideslip; }
        outputs     {
            /// The speed across the wheel.
            sideslip_speed = sideslip;
        }
    }
}

crate::mechanical_component! {
    /// A wheel that rolls without slipping along its plane, with a tyre that gives way across it, and recovers as it rolls.
    ///
    /// The point of contact is held to the rim by a spring, and creeps back under it with the distance that the wheel rolls:
    /// `d deflection/dt = sideslip - |speed| deflection/relaxation`. At a constant angle of sideslip the force is, after a way `x`,
    /// `stiffness relaxation (sideslip/speed) (1 - exp(-x/relaxation))`; so `stiffness relaxation` is the cornering stiffness, and at
    /// rest the tyre is a spring. That is the linear relaxation model of tyres that Altair MotionView documents under "Relaxation
    /// Behavior", across the wheel.
    pub component RelaxationTyre(
        /// The centre of the wheel.
        hub: vector,
        /// The unit vector along the axle.
        axle: vector,
        /// The unit vector in which the wheel rolls, horizontal and normal to the axle.
        forward: vector,
        /// The radius.
        radius: scalar,
    ) {
        constants {
            /// The mass of the wheel.
            mass >= 0,
            /// The moment of inertia about the axle.
            spin_inertia > 0,
            /// The stiffness of the tyre across the wheel.
            stiffness >= 0,
            /// The relaxation length.
            relaxation > 0,
        }
        coordinates {
            /// The angle by which the wheel has turned.
            angle
        }
        particles   { mass at hub; }
        kinetic_energy = 1/2*spin_inertia*dot(angle)^2;
        let sideslip = inner(dot(hub), axle);
        let speed    = inner(dot(hub), forward);
        constraints {
            /// The point of contact does not slip along the wheel.
            rolls: speed = radius*dot(angle);
        }
        states {
            /// The way of the rim across the point of contact.
            dot(deflection) = sideslip - abs(speed)/relaxation*deflection;
        }
        forces      { -stiffness*deflection along sideslip; }
        outputs     {
            /// The force of the ground on the wheel, along the axle.
            side_force = -stiffness*deflection;
        }
    }
}

crate::mechanical_component! {
    /// A blade, a keel or a sharp wheel without mass: its point does not move across it.
    ///
    /// It makes a Chaplygin sled of a rigid body, as (3.12) of Pham Guen (1969).
    pub component Blade(
        /// The point of contact.
        point: vector,
        /// The unit vector across the blade.
        across: vector,
    ) {
        constraints {
            /// The point does not slip across the blade.
            grips: inner(dot(point), across) = 0;
        }
    }
}

crate::mechanical_component! {
    /// A caster: a wheel in a fork that swivels about the vertical, and trails behind the swivel.
    ///
    /// Both rolling constraints of [`RollingWheel`] hold at the hub. Towed along a straight line the fork follows
    /// `tan(swivel/2) = C exp(-x/trail)`.
    pub component Caster(
        /// The axis of the swivel, at the height of the hub.
        mount: vector,
        /// The orientation of what the caster is mounted on, its third axis vertical.
        frame: rotation,
    ) {
        constants {
            /// The distance of the hub behind the axis of the swivel.
            trail > 0,
            /// The radius of the wheel.
            radius > 0,
            /// The mass of wheel and fork, at the hub.
            mass >= 0,
            /// The moment of inertia of the wheel about its axle.
            spin_inertia > 0,
            /// The moment of inertia of wheel and fork about the vertical through the hub.
            swivel_inertia >= 0,
        }
        coordinates {
            /// The angle of the fork against the frame.
            swivel,
            /// The angle by which the wheel has turned.
            angle,
        }
        let fork = frame*rot_z(swivel);
        let hub  = mount - trail*fork.x;
        particles   { mass at hub; }
        kinetic_energy = 1/2*spin_inertia*dot(angle)^2 + 1/2*swivel_inertia*inner(angular_velocity(fork), fork.z)^2;
        constraints {
            /// The point of contact does not slip along the wheel.
            rolls: inner(dot(hub), fork.x) = radius*dot(angle);
            /// The point of contact does not slip across the wheel.
            grips: inner(dot(hub), fork.y) = 0;
        }
    }
}
