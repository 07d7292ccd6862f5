//! Components of vehicles, machines and robots, to be used in systems of one's own.
//!
//! | component | arguments | what it is |
//! | --- | --- | --- |
//! | [`RollingWheel`] | `hub, axle, forward, radius` | a wheel that rolls without slipping |
//! | [`SideslipWheel`] | `hub, axle, forward, radius` | a wheel that rolls, and slides across against a viscous force |
//! | [`RelaxationTyre`] | `hub, axle, forward, radius` | a wheel that rolls on a tyre with a relaxation length |
//! | [`Blade`] | `point, across` | a point that does not move across a blade |
//! | [`Caster`] | `mount, frame` | a wheel in a fork that swivels and trails |
//! | [`SpringDamper`] | `from, to` | a spring and a damper between two points |
//! | [`StribeckFriction`] | `speed` | Coulomb, Stribeck and viscous friction, smooth |
//! | [`GearMotor`] | `angle` | a motor with a winding and a gear |
//! | [`ResistiveGearMotor`] | `angle` | the same without inductance |
//! | [`HingeStops`] | `angle` | stops at both ends of a hinge or slide |
//! | [`Foot`] | `point, up` | a point that touches level ground, sticks and slips |
//! | [`Cable`] | `from, to, segments` | an elastic cable with mass |
//! | [`PlanarArm`] | `base, frame` | three links in a plane |
//! | [`SpatialArm`] | `base, frame` | six joints by Denavit and Hartenberg's table |
//!
//! ```
//! use guen::components::{Blade, SpringDamper};
//! use guen::prelude::*;
//!
//! mechanical_system! {
//!     /// A sleigh on a blade, tied to the origin by a spring.
//!     pub system Sleigh {
//!         constants   { m > 0, J > 0 }
//!         coordinates { x, y, heading }
//!         let place = vec(x, y);
//!         particles   { m at place; }
//!         kinetic_energy = J/2*dot(heading)^2;
//!         use Blade as blade { point: place, across: vec(-sin(heading), cos(heading)) }
//!         use SpringDamper as leash { from: vec(0, 0), to: place }
//!     }
//! }
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let leash = SpringDamper::new(3.0);
//! let sleigh = Sleigh { m: 1.0, J: 0.1, leash }.prepare()?;
//! let motion = sleigh.simulate(&sleigh::State { x: 1.0, heading: 0.3, ..Default::default() }, 0.0..1.0)?;
//! assert!(motion.end().x < 1.0);
//! # Ok(())
//! # }
//! ```

mod arms;
mod cables;
mod contacts;
mod drives;
mod wheels;

pub use arms::{PlanarArm, SpatialArm, planar_arm, spatial_arm};
pub use cables::{Cable, cable};
pub use contacts::{Foot, HingeStops, foot, hinge_stops};
pub use drives::{
    GearMotor, ResistiveGearMotor, SpringDamper, StribeckFriction, gear_motor, resistive_gear_motor,
    spring_damper, stribeck_friction,
};
pub use wheels::{
    Blade, Caster, RelaxationTyre, RollingWheel, SideslipWheel, blade, caster, relaxation_tyre,
    rolling_wheel, sideslip_wheel,
};
