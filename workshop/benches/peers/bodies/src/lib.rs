//! Declared systems behind an interface of C: each has a function that reads a state and writes its rates. States are those of the
//! declarations, coordinates first.

use guen::{Fused, Real, WithScalar};

mod bicycle {
    guen::mechanical_system! {
        /// The bicycle of `tests/motion/published`, with all its constants given at run time.
        pub system Whipple {
            constants {
                w > 0, c, tilt, g = 9.81, rR > 0, rF > 0, mR > 0, Rxx > 0, Ryy > 0, mB > 0, xB, zB, Bxx > 0, Byy > 0, Bzz > 0, Bxz,
                mH > 0, xH, zH, Hxx > 0, Hyy > 0, Hzz > 0, Hxz, mF > 0, Fxx > 0, Fyy > 0
            }
            coordinates { x, y, yaw, lean, pitch, steer, rear, front }
            let L = rot_z(yaw)*rot_x(lean);
            let B = L*rot_y(pitch);
            let S = B*rot_y(tilt)*rot_z(steer);
            let H = S*rot_y(-tilt);
            let contact = vec(x, y, 0);
            let hub = contact - rR*L.z;
            let foot = hub + B*vec(w + c, 0, rR);
            let nose = foot + H*vec(-c, 0, -rF);
            let touch = nose + rF*unit(vec(0, 0, 1) - H.y.z*H.y);
            bodies {
                rear_wheel { mass: mR, inertia: diag(Rxx, Ryy, Rxx), center: hub, orientation: L*rot_y(rear) }
                rider { mass: mB, inertia: sym(Bxx, Byy, Bzz, 0, 0, Bxz), center: hub + B*vec(xB, 0, rR + zB), orientation: B }
                fork { mass: mH, inertia: sym(Hxx, Hyy, Hzz, 0, 0, Hxz), center: foot + H*vec(xH - w - c, 0, zH), orientation: H }
                front_wheel { mass: mF, inertia: diag(Fxx, Fyy, Fxx), center: nose, orientation: H*rot_y(front) }
            }
            gravity = vec(0, 0, g);
            parameters { roll_rate = dot(lean); steer_rate = dot(steer); turning = dot(rear); }
            constraints {
                behind: rear_wheel.velocity_at(contact) = 0;
                ahead: front_wheel.velocity_at(touch) = 0;
            }
        }
    }

    pub type System = whipple::Prepared;

    pub fn prepared() -> System {
        let system = Whipple {
            w: 1.02,
            c: 0.08,
            tilt: std::f64::consts::PI / 10.0,
            g: 9.81,
            rR: 0.3,
            rF: 0.35,
            mR: 2.0,
            Rxx: 0.0603,
            Ryy: 0.12,
            mB: 85.0,
            xB: 0.3,
            zB: -0.9,
            Bxx: 9.2,
            Byy: 11.0,
            Bzz: 2.8,
            Bxz: 2.4,
            mH: 4.0,
            xH: 0.9,
            zH: -0.7,
            Hxx: 0.05892,
            Hyy: 0.06,
            Hzz: 0.00708,
            Hxz: -0.00756,
            mF: 3.0,
            Fxx: 0.1405,
            Fyy: 0.28,
        };
        system.prepare().expect("a bicycle")
    }
}

mod quadruped {
    include!(concat!(env!("OUT_DIR"), "/quadruped.rs"));
}

mod humanoid {
    include!(concat!(env!("OUT_DIR"), "/humanoid.rs"));
}

/// Functions of C with the rates of a system, over `f64` and over `Fused`, whose sums of products round once where the peers' do.
macro_rules! served {
    ($name:ident, $fused:ident, $size:literal) => {
        /// Reads a state and writes its rates.
        ///
        /// # Safety
        ///
        /// Both point to as many numbers as the state has.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $name(state: *const [f64; $size], rates: *mut [f64; $size]) {
            static SYSTEM: std::sync::LazyLock<$name::System> = std::sync::LazyLock::new($name::prepared);
            unsafe { *rates = guen::System::rhs(&*SYSTEM, 0.0, &*state) };
        }

        /// Reads a state and writes its rates.
        ///
        /// # Safety
        ///
        /// Both point to as many numbers as the state has.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $fused(state: *const [f64; $size], rates: *mut [f64; $size]) {
            type System = <$name::System as WithScalar<$size>>::Over<Fused>;
            static SYSTEM: std::sync::LazyLock<System> =
                std::sync::LazyLock::new(|| $name::prepared().with_scalar().expect("the same constants"));
            let state = unsafe { (*state).map(Fused::from_f64) };
            let found = guen::System::rhs(&*SYSTEM, Fused::from_f64(0.0), &state);
            unsafe { *rates = found.map(Fused::to_f64) };
        }
    };
}

served!(bicycle, bicycle_fused, 11);
served!(quadruped, quadruped_fused, 36);
served!(humanoid, humanoid_fused, 60);
