//! A snake of thirty links on casters: waves of its joints, from head to tail, drive it forwards.
//!
//! ```text
//! cargo run --release --example snake
//! ```

use std::error::Error;

use guen::prelude::*;

guen::mechanical_component! {
    /// A caster that is fixed under a link: it rolls easily along the link, and hardly slides across.
    pub component FixedCaster(hub: vector, frame: rotation) {
        constants { drag >= 0 = 0.02, grip >= 0 = 20 }
        let ahead = inner(dot(hub), frame.x);
        let aside = inner(dot(hub), frame.y);
        forces    { -drag*ahead along ahead; -grip*aside along aside; }
        outputs   { sideslip = aside; }
    }
}

guen::mechanical_system! {
    /// Thirty links in a row, with springs in the joints whose rest angles are a travelling wave.
    pub system Snake {
        count n = 30;
        constants   { m > 0 = 0.1, J > 0 = 0.0001, l > 0 = 0.1, k >= 0 = 4, c >= 0 = 0.2, bend = 0.35, rate = 4, lag = 0.42 }
        coordinates { x, y, phi[n] }
        let joint[0] = vec(x, y);
        for i in 0..n {
            let frame[i]   = rot_z(phi[i]);
            let joint[i+1] = joint[i] - l*frame[i].x;
        }
        bodies {
            for i in 0..n {
                link[i] { mass: m, center: (joint[i] + joint[i+1])/2, inertia: diag(J, J, J), orientation: frame[i] }
            }
        }
        parameters { u = dot(x); v = dot(y); for i in 0..n { w[i] = dot(phi[i]); } }
        for i in 0..n { use FixedCaster as caster[i] { hub: link[i].center, frame: frame[i] } }
        for i in 1..n { let wave[i-1] = bend*sin(rate*t - i*lag); }
        forces { for i in 1..n { k*(wave[i-1] - phi[i-1] + phi[i]) - c*(w[i-1] - w[i]) along w[i-1] - w[i]; } }
        outputs { middle = sum(i in 0..n: link[i].center)/n; }
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let way = |rate: f64| -> Result<[f64; 3], Box<dyn Error>> {
        let snake = Snake { rate, ..Snake::default() }.prepare()?;
        let motion = snake.simulate(&snake::State::default(), 0.0..6.0)?;
        let (start, end) = (snake.outputs(0.0, &snake::State::default()), snake.outputs(6.0, &motion.end()));
        Ok(std::array::from_fn(|i| end.middle[i] - start.middle[i]))
    };
    println!("{} states, {} operations in a right-hand side", snake::State::NAMES.len(), snake::COST.total());
    let (forwards, backwards) = (way(4.0)?, way(-4.0)?);
    println!(
        "a wave towards the tail: {:.2} m ahead, one towards the head: {:.2} m",
        forwards[0], backwards[0]
    );
    if forwards[0] < 0.5 || backwards[0] > -0.5 {
        return Err("waves drive a snake the other way".into());
    }
    Ok(())
}
