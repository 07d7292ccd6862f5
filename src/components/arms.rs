//! Arms from tables of their joints.

crate::mechanical_component! {
    /// An arm of three links in a plane, each a slender body that turns against the one before it.
    ///
    /// Row `i` of the table is `length[i]`, `center[i]`, `mass[i]`, `inertia[i]`.
    pub component PlanarArm(
        /// The first joint.
        base: vector,
        /// The orientation of what carries the arm: the arm moves normal to its third axis, and points along the first where its
        /// angles are zero.
        frame: rotation,
    ) {
        count n = 3;
        constants {
            /// The distances from each joint to the next, the last to the tip.
            length[n] > 0,
            /// The distances from each joint to the mass centre of its link, along the link.
            center[n],
            /// The masses.
            mass[n] > 0,
            /// The moments of inertia about axes through the mass centres, across the links.
            inertia[n] >= 0,
        }
        inputs {
            /// The torques in the joints.
            torque[n]
        }
        coordinates {
            /// The angles of each link against the one before.
            angle[n]
        }
        let turned[0] = frame*rot_z(angle[0]);
        let joint[0]  = base;
        for i in 1..n {
            let turned[i] = turned[i-1]*rot_z(angle[i]);
            let joint[i]  = joint[i-1] + length[i-1]*turned[i-1].x;
        }
        let tip = joint[n-1] + length[n-1]*turned[n-1].x;
        bodies {
            for i in 0..n {
                link[i] {
                    mass: mass[i], center: joint[i] + center[i]*turned[i].x,
                    inertia: diag(0, inertia[i], inertia[i]), orientation: turned[i]
                }
            }
        }
        forces  { for i in 0..n { torque[i] along dot(angle[i]); } }
        outputs {
            /// The place of the tip.
            tip_place = tip;
        }
    }
}

crate::mechanical_component! {
    /// A spatial arm of six revolute joints from a table of Denavit and Hartenberg's parameters.
    ///
    /// Row `i` of the table is `a[i]`, `alpha[i]`, `d[i]`: the frame of link `i` is that of the link before, turned about its third
    /// axis by the joint's angle, moved along that axis by `d`, along the new first axis by `a`, and turned about that by `alpha`.
    /// Mass centres and inertias are given in the frames of the links.
    pub component SpatialArm(
        /// The origin of the first frame.
        base: vector,
        /// The orientation of the first frame, about whose third axis the first joint turns.
        frame: rotation,
    ) {
        count n = 6;
        constants {
            /// The lengths of the links.
            a[n],
            /// The twists of the links.
            alpha[n],
            /// The offsets along the axes of the joints.
            d[n],
            /// The masses.
            mass[n] > 0,
            /// The first coordinates of the mass centres.
            cx[n] = 0,
            /// The second coordinates of the mass centres.
            cy[n] = 0,
            /// The third coordinates of the mass centres.
            cz[n] = 0,
            /// The moments of inertia about the first axes through the mass centres.
            Ixx[n] >= 0,
            /// The moments of inertia about the second axes.
            Iyy[n] >= 0,
            /// The moments of inertia about the third axes.
            Izz[n] >= 0,
        }
        inputs {
            /// The torques in the joints.
            torque[n]
        }
        coordinates {
            /// The angles of the joints.
            angle[n]
        }
        let swung[0]  = frame*rot_z(angle[0]);
        let turned[0] = swung[0]*rot_x(alpha[0]);
        let origin[0] = base + d[0]*frame.z + a[0]*swung[0].x;
        for i in 1..n {
            let swung[i]  = turned[i-1]*rot_z(angle[i]);
            let turned[i] = swung[i]*rot_x(alpha[i]);
            let origin[i] = origin[i-1] + d[i]*turned[i-1].z + a[i]*swung[i].x;
        }
        let tip = origin[n-1];
        let hand = turned[n-1];
        bodies {
            for i in 0..n {
                link[i] {
                    mass: mass[i], center: origin[i] + turned[i]*vec(cx[i], cy[i], cz[i]),
                    inertia: diag(Ixx[i], Iyy[i], Izz[i]), orientation: turned[i]
                }
            }
        }
        forces  { for i in 0..n { torque[i] along dot(angle[i]); } }
        outputs {
            /// The place of the last frame.
            tip_place = tip;
        }
    }
}
