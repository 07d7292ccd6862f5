//! Springs, friction and motors between the parts of a machine.

crate::mechanical_component! {
    /// A spring and a damper side by side between two points.
    ///
    /// Both act along the line between the points, as `SpringDamperParallel` of the Modelica Standard Library
    /// (`Modelica.Mechanics.MultiBody.Forces`). The points must not meet.
    pub component SpringDamper(
        /// One end.
        from: vector,
        /// The other end.
        to: vector,
    ) {
        constants {
            /// The stiffness.
            stiffness >= 0,
            /// The force of the damper at one unit of speed.
            damping >= 0 = 0,
            /// The length without force.
            rest >= 0 = 0,
        }
        let length = norm(to - from);
        potential_energy = stiffness/2*(length - rest)^2;
        forces  { -damping*dot(length) along dot(length); }
        outputs {
            /// The force that pulls the ends together.
            tension = stiffness*(length - rest) + damping*dot(length);
        }
    }
}

crate::mechanical_component! {
    /// Friction that falls from its greatest value to a lower one as the speed grows, smoothed around rest.
    ///
    /// The force is `(kinetic + (breakaway - kinetic) exp(-(v/stribeck)^2)) tanh(v/smoothing) + viscous v`: Coulomb, Stribeck and
    /// viscous friction with a `tanh` in place of the jump (Andersson, Söderberg, Björklund, *Tribology International* 40 (2007)).
    /// It creeps at rest: below `smoothing` it is viscous. Where sticking matters, contacts are the better model.
    pub component StribeckFriction(
        /// The speed between the surfaces: any expression that is linear in the velocities.
        speed: scalar,
    ) {
        constants {
            /// The force at high speed, without its viscous part.
            kinetic >= 0,
            /// The force just above rest.
            breakaway >= 0,
            /// The speed at which the force has fallen.
            stribeck > 0,
            /// The viscous force at one unit of speed.
            viscous >= 0 = 0,
            /// The speed within which the force rises from zero.
            smoothing > 0 = 0.001,
        }
        let dry   = (kinetic + (breakaway - kinetic)*exp(-(speed/stribeck)^2))*tanh(speed/smoothing);
        let drag  = dry + viscous*speed;
        forces  { -drag along speed; }
        outputs {
            /// The friction force, against the speed.
            force = drag;
        }
    }
}

crate::mechanical_component! {
    /// A direct-current motor behind a gear, with the current of its winding as a state.
    ///
    /// The winding obeys `voltage = resistance current + inductance d current/dt + constant rotor_speed`, the rotor turns `ratio` times
    /// as fast as the output, and its inertia counts `ratio^2` there. Resistor, inductor and electromotive force in series are the
    /// armature of `DC_PermanentMagnet` of the Modelica Standard Library (`Modelica.Electrical.Machines.BasicMachines.DCMachines`).
    pub component GearMotor(
        /// The angle of the output against the housing.
        angle: scalar,
    ) {
        constants {
            /// The resistance of the winding.
            resistance > 0,
            /// The inductance of the winding.
            inductance > 0,
            /// The torque for one unit of current, which is the voltage for one unit of the rotor's speed.
            constant > 0,
            /// The turns of the rotor for one of the output.
            ratio > 0 = 1,
            /// The moment of inertia of the rotor about its axle.
            rotor_inertia >= 0 = 0,
        }
        inputs {
            /// The voltage at the winding.
            voltage
        }
        let rotor_speed = ratio*dot(angle);
        states {
            /// The current in the winding.
            dot(current) = (voltage - resistance*current - constant*rotor_speed)/inductance;
        }
        kinetic_energy  = 1/2*rotor_inertia*rotor_speed^2;
        forces  { ratio*constant*current along dot(angle); }
        outputs {
            /// The torque at the output, without what accelerates the rotor.
            torque = ratio*constant*current;
        }
    }
}

crate::mechanical_component! {
    /// A direct-current motor behind a gear whose winding has no inductance: its current follows the voltage at once.
    ///
    /// That is [`GearMotor`] where the machine is slow against the winding. The winding obeys `voltage = resistance current + constant rotor_speed`, the rotor turns `ratio` times as fast as the output,
    /// and its inertia counts `ratio^2` there.
    pub component ResistiveGearMotor(
        /// The angle of the output against the housing.
        angle: scalar,
    ) {
        constants {
            /// The resistance of the winding.
            resistance > 0,
            /// The torque for one unit of current, which is the voltage for one unit of the rotor's speed.
            constant > 0,
            /// The turns of the rotor for one of the output.
            ratio > 0 = 1,
            /// The moment of inertia of the rotor about its axle.
            rotor_inertia >= 0 = 0,
        }
        inputs {
            /// The voltage at the winding.
            voltage
        }
        let rotor_speed = ratio*dot(angle);
        let current     = (voltage - constant*rotor_speed)/resistance;
        kinetic_energy  = 1/2*rotor_inertia*rotor_speed^2;
        forces  { ratio*constant*current along dot(angle); }
        outputs {
            /// The current in the winding.
            winding_current = current;
            /// The torque at the output, without what accelerates the rotor.
            torque = ratio*constant*current;
        }
    }
}
