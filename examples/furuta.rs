//! A Furuta pendulum: an arm turns about a vertical shaft and carries a pendulum on its end. Its page takes three lines.
//!
//! ```text
//! cargo run --release --example furuta     # writes target/guen/furuta/furuta.html
//! ```

use std::error::Error;

use guen::prelude::*;
use guen_study::Export;

#[path = "common/folder.rs"]
mod folder;

guen::mechanical_system! {
    /// A pendulum on the end of an arm, which are thin rods. It stands at `lean = 0`.
    pub system Furuta {
        constants   { m = 0.1, r = 0.2, l = 0.3, g = 9.81 }
        coordinates { turn, lean }
        let A = rot_z(turn);
        let P = A*rot_x(lean);
        bodies {
            arm      { mass: m, inertia: diag(0, m*r^2/12, m*r^2/12), center: r/2*A.x, orientation: A }
            pendulum { mass: m, inertia: diag(m*l^2/12, m*l^2/12, 0), center: r*A.x + l/2*P.z, orientation: P }
        }
        gravity = vec(0, 0, -g);
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let path = folder::folder("furuta").join("furuta.html");
    let furuta = Furuta::default().prepare()?;
    let motion = furuta.simulate(&furuta::State { lean: 0.1, ..Default::default() }, 0.0..10.0)?;
    motion.view("A Furuta pendulum", &path)?;
    println!("to play: {}", path.display());
    Ok(())
}
