//! Cables with mass.

crate::mechanical_component! {
    /// An elastic cable with mass between two points, as a chain of springs with masses between them.
    ///
    /// The mass of a segment sits in halves at its ends, and a segment pulls along its line with a stiffness and a damping: a
    /// discretisation by lumped masses, of which eight show the first swings of a cable. A segment pushes when it is pressed. Neighbouring nodes must not meet.
    pub component Cable(
        /// One end.
        from: vector,
        /// The other end.
        to: vector,
        /// The number of springs.
        segments: count,
    ) {
        count n = segments;
        constants {
            /// The mass of the whole cable.
            mass > 0,
            /// The length without force.
            length > 0,
            /// The force that would double the length, `E A`.
            stiffness > 0,
            /// The force for a strain that grows by one in one unit of time.
            damping >= 0 = 0,
        }
        coordinates {
            /// The places of the inner nodes, from `from` to `to`.
            x[n-1],
            /// The second coordinates of the inner nodes.
            y[n-1],
            /// The third coordinates of the inner nodes.
            z[n-1],
        }
        let node[0] = from;
        for i in 1..n { let node[i] = vec(x[i-1], y[i-1], z[i-1]); }
        let node[n] = to;
        for i in 0..n { let strain[i] = norm(node[i+1] - node[i])*n/length - 1; }
        particles {
            mass/(2*n) at from;
            for i in 1..n { mass/n at node[i]; }
            mass/(2*n) at to;
        }
        potential_energy = stiffness*length/(2*n)*sum(i in 0..n: strain[i]^2);
        forces { for i in 0..n { -damping*length/n*dot(strain[i]) along dot(strain[i]); } }
        outputs {
            /// The pull at the first end.
            tension_from = stiffness*strain[0] + damping*dot(strain[0]);
            /// The pull at the other end.
            tension_to = stiffness*strain[n-1] + damping*dot(strain[n-1]);
        }
    }
}
