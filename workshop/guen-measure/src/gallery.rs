//! Pages that play the machines of the book's gallery.
//!
//! ```text
//! cargo run --release -p guen-measure --bin gallery
//! ```
//!
//! Each is declared as in the gallery, simulated for some seconds and written as a page below `guen/gallery` in the target folder, where the
//! program that builds the book finds it. Ends with a nonzero status if an energy that is kept changes.

use std::error::Error;
use std::path::Path;

use guen::prelude::*;
use guen::steppers::Interpolant;
use guen::{Bodies, Monitored};
use guen_study::{Export, Shape, Viewer};

#[path = "../../../examples/common/folder.rs"]
mod folder;

guen_benchmarks::belt_ball! { guen::mechanical_system }
guen_benchmarks::rattleback! { guen::mechanical_system }

guen::mechanical_system! {
    pub system Spherical {
        constants   { m = 1, l = 1, g = 9.81 }
        coordinates { theta, psi }
        let R = rot_z(psi)*rot_y(theta);
        particles { m at -l*R.z; }
        gravity = vec(0, 0, -g);
    }
}

guen::mechanical_system! {
    pub system DoublePendulum {
        constants   { m = 1, l = 0.5, g = 9.81 }
        coordinates { q1, q2 }
        let A = rot_y(-q1);
        let B = rot_y(-q2);
        let joint = -l*A.z;
        bodies {
            upper { mass: m, inertia: diag(m*l^2/12, m*l^2/12, m*l^2/4000), center: joint/2, orientation: A }
            lower { mass: m, inertia: diag(m*l^2/12, m*l^2/12, m*l^2/4000), center: joint - l/2*B.z, orientation: B }
        }
        gravity = vec(0, 0, -g);
    }
}

guen::mechanical_system! {
    /// A board on two steered axles with a rotor.
    pub system Snakeboard {
        constants   { m = 4, I = 0.1, J = 0.04, K = 0.005, l = 0.3 }
        inputs      { swing, steer_front, steer_back }
        coordinates { x, y, theta, psi, front, back }
        let R = rot_z(theta);
        let p = vec(x, y);
        let E = rot_z(theta + front);
        let D = rot_z(theta + back);
        bodies {
            board { mass: m, inertia: diag(I/20, I, I), center: p, orientation: R }
            rotor { mass: m/8, inertia: diag(J/20, J, J), center: p, orientation: rot_z(theta + psi) }
            front_axle { mass: m/8, inertia: diag(K, K/20, K), center: p + l*R.x, orientation: E }
            back_axle { mass: m/8, inertia: diag(K, K/20, K), center: p - l*R.x, orientation: D }
        }
        parameters { speed = inner(R.x, dot(p)); spin = dot(psi); bend = dot(front); turn = dot(back); }
        constraints {
            no_slip_front: inner(E.y, board.velocity_at(p + l*R.x)) = 0;
            no_slip_back: inner(D.y, board.velocity_at(p - l*R.x)) = 0;
        }
        forces { swing along spin; steer_front along bend; steer_back along turn; }
    }
}

guen::mechanical_system! {
    /// Six links, each with a pair of wheels under its middle, and motors in the joints.
    pub system Snake {
        constants   { m = 1, I = 0.01, l = 0.15, c = 0.1 }
        inputs      { u1, u2, u3, u4, u5 }
        coordinates { x, y, q1, q2, q3, q4, q5, q6 }
        let A1 = rot_z(q1); let A2 = rot_z(q2); let A3 = rot_z(q3);
        let A4 = rot_z(q4); let A5 = rot_z(q5); let A6 = rot_z(q6);
        let p1 = vec(x, y);
        let p2 = p1 - l*A1.x - l*A2.x;
        let p3 = p2 - l*A2.x - l*A3.x;
        let p4 = p3 - l*A3.x - l*A4.x;
        let p5 = p4 - l*A4.x - l*A5.x;
        let p6 = p5 - l*A5.x - l*A6.x;
        bodies {
            b1 { mass: m, inertia: diag(I/20, I, I), center: p1, orientation: A1 }
            b2 { mass: m, inertia: diag(I/20, I, I), center: p2, orientation: A2 }
            b3 { mass: m, inertia: diag(I/20, I, I), center: p3, orientation: A3 }
            b4 { mass: m, inertia: diag(I/20, I, I), center: p4, orientation: A4 }
            b5 { mass: m, inertia: diag(I/20, I, I), center: p5, orientation: A5 }
            b6 { mass: m, inertia: diag(I/20, I, I), center: p6, orientation: A6 }
        }
        parameters { speed = inner(A1.x, dot(p1)); turn = dot(q1); }
        constraints {
            w1: inner(A1.y, dot(p1)) = 0; w2: inner(A2.y, dot(p2)) = 0; w3: inner(A3.y, dot(p3)) = 0;
            w4: inner(A4.y, dot(p4)) = 0; w5: inner(A5.y, dot(p5)) = 0; w6: inner(A6.y, dot(p6)) = 0;
        }
        forces {
            u1 along dot(q1) - dot(q2); u2 along dot(q2) - dot(q3); u3 along dot(q3) - dot(q4);
            u4 along dot(q4) - dot(q5); u5 along dot(q5) - dot(q6);
            -c*dot(p1) along dot(p1);
        }
    }
}

guen::mechanical_system! {
    /// Rear wheel, frame, fork and front wheel; the first two coordinates are the rear contact.
    pub system Bicycle {
        constants {
            rr = 0.35, rf = 0.3, base = 1, trail = 0.05, rake = -0.3, mr = 2, mb = 80, mh = 3, mf = 2, I = 0.06, J = 9, K = 10, L = 3, g = 9.81
        }
        inputs { handle }
        coordinates { x, y, yaw, lean, pitch, steer, rear, front }
        let up = vec(0, 0, 1);
        let F = rot_z(yaw)*rot_x(lean);
        let B = F*rot_y(pitch);
        let H = B*rot_y(rake)*rot_z(steer);
        let W = H*rot_y(front);
        let hub = vec(x, y, 0) + rr*F.z;
        let nose = hub + base*B.x;
        let tip = nose + trail*H.x - base/2*H.z;
        let contact = tip - rf*unit(up - inner(up, H.y)*H.y);
        bodies {
            back { mass: mr, inertia: diag(I, 2*I, I), center: hub, orientation: F*rot_y(rear) }
            frame { mass: mb, inertia: sym(J, K, L, 0, 0, -J/4), center: hub + base/2*B.x + base/3*B.z, orientation: B }
            fork { mass: mh, inertia: diag(I, I, I/3), center: nose + trail/2*H.x, orientation: H }
            wheel { mass: mf, inertia: diag(I, 2*I, I), center: tip, orientation: W }
        }
        gravity = -g*up;
        parameters { fall = dot(lean); turn = dot(steer); drive = dot(rear); }
        constraints {
            behind: back.velocity_at(vec(x, y, 0)) = 0;
            ahead: wheel.velocity_at(contact) = 0;
        }
        forces { handle*H.z along fork.angular_velocity - frame.angular_velocity; }
        outputs { height = contact.z; }
    }
}

/// Samples of a second.
const RATE: f64 = 60.0;

/// Writes the page of a motion, with what is added to the bodies that it draws by itself.
fn page<S, P, const N: usize, const B: usize>(
    folder: &Path,
    name: &str,
    title: &str,
    motion: &guen::Trajectory<S, N, f64, P>,
    add: impl for<'a> FnOnce(Viewer<'a, N>) -> Viewer<'a, N>,
) -> Result<(), Box<dyn Error>>
where
    S: Simulate<f64, N> + Bodies<f64, N, B> + Monitored<f64, N>,
    P: Interpolant<f64, N>,
{
    let path = folder.join(name);
    let recording = motion.sampled(1.0 / RATE);
    let page = Viewer::new(title, &recording).bodies(motion.system()).states(&[]).monitored(motion.system());
    add(page).write(&path)?;
    println!("{title}: {} samples, {}", recording.len(), path.display());
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = folder::folder("gallery");
    let ball = BeltBall { m: 1.0, a: 0.3, A: 0.02, B: 0.03, C: 0.04, u: 0.6, nu: 1.5 }.prepare()?;
    let start = belt_ball::State { w: 1.0, spin_x: 1.0, spin_y: 0.5, spin_z: 2.0, ..Default::default() };
    page(
        &folder,
        "chaplygin-ball.html",
        "Chaplygin's ball on a belt",
        &ball.simulate(&start, 0.0..20.0)?,
        |page| page.drawn("ball", [Shape::sphere(0.3)]),
    )?;

    let stone = Rattleback {
        m: 1.0,
        a: 0.2,
        b: 0.03,
        c: 0.02,
        h: 0.01,
        A: 0.0002,
        B: 0.0016,
        C: 0.0017,
        D: -0.00002,
        g: 9.81,
    }
    .prepare()?;
    // It is spun the way that it does not like.
    let half_degree = 0.5_f64.to_radians();
    let start = rattleback::State {
        z: 0.01,
        roll: half_degree,
        pitch: half_degree,
        spin_z: -5.0,
        ..Default::default()
    };
    page(&folder, "rattleback.html", "A rattleback", &stone.simulate(&start, 0.0..5.0)?, |page| page)?;

    let start = spherical::State { theta: 1.0, psi_rate: 1.5, ..Default::default() };
    let motion = Spherical::default().prepare()?.simulate(&start, 0.0..20.0)?;
    page(&folder, "spherical-pendulum.html", "A spherical pendulum", &motion, |page| {
        page.rod("string", 0.01, |_, s| {
            let (sine, cosine) = s[0].sin_cos();
            [[0.0; 3], [-sine * s[1].cos(), -sine * s[1].sin(), -cosine]]
        })
    })?;

    let start = double_pendulum::State { q1: 2.0, q2: 2.5, ..Default::default() };
    let motion = DoublePendulum::default().prepare()?.simulate(&start, 0.0..20.0)?;
    let energy: Vec<f64> = motion.energy().map(|(_, h)| h).collect();
    let change = energy.iter().map(|h| (h - energy[0]).abs()).fold(0.0, f64::max);
    if change > 1e-6 {
        return Err(format!("the energy of the double pendulum changes by {change}").into());
    }
    page(&folder, "double-pendulum.html", "A double pendulum", &motion, |page| page)?;

    // The rotor swings while the axles steer against each other, at one frequency.
    let board = Snakeboard::default().prepare()?;
    let motion = board
        .simulation(&snakeboard::State { front: 0.3, back: -0.3, ..Default::default() })
        .inputs(|t, s| snakeboard::Inputs {
            swing: 0.6 * (2.0 * t).sin(),
            steer_front: 0.4 * (0.5 * (2.0 * t).cos() - s.front) - 0.06 * s.bend,
            steer_back: 0.4 * (-0.5 * (2.0 * t).cos() - s.back) - 0.06 * s.turn,
        })
        .run(0.0..20.0)?;
    page(&folder, "snakeboard.html", "A snakeboard", &motion, |page| {
        page.drawn("board", [Shape::cuboid([0.7, 0.12, 0.02])])
            .drawn("rotor", [Shape::cuboid([0.5, 0.05, 0.02]).at([0.0, 0.0, 0.1])])
            .drawn("front_axle", [Shape::rod([0.0, -0.12, -0.03], [0.0, 0.12, -0.03], 0.02)])
            .drawn("back_axle", [Shape::rod([0.0, -0.12, -0.03], [0.0, 0.12, -0.03], 0.02)])
            .path("middle", |_, s| [s[0], s[1], 0.0])
    })?;

    // A wave of torques through the joints.
    let wave = |t: f64, k: f64| 0.25 * (2.0 * t - 0.9 * k).sin();
    let start =
        snake::State { q1: 0.3, q2: 0.1, q3: -0.2, q4: -0.3, q5: -0.1, q6: 0.2, ..Default::default() };
    let motion = Snake::default()
        .prepare()?
        .simulation(&start)
        .inputs(move |t, _| snake::Inputs {
            u1: wave(t, 0.0),
            u2: wave(t, 1.0),
            u3: wave(t, 2.0),
            u4: wave(t, 3.0),
            u5: wave(t, 4.0),
        })
        .run(0.0..10.0)?;
    page(&folder, "snake-robot.html", "A snake of six links", &motion, |page| {
        page.path("head", |_, s| [s[0], s[1], 0.0])
    })?;

    // Pitched so that the front wheel is on the ground.
    let bicycle = Bicycle::default().prepare()?;
    let upright = |pitch: f64| bicycle::State { pitch, lean: 0.05, drive: 15.0, ..Default::default() };
    let still = bicycle::Inputs { handle: 0.0 };
    let height =
        |pitch: f64| bicycle.outputs(0.0, &bicycle::State { lean: 0.0, ..upright(pitch) }, &still).height;
    let (mut low, mut high) = (-1.0, 1.0);
    for _ in 0..60 {
        let middle = (low + high) / 2.0;
        if (height(middle) > 0.0) == (height(low) > 0.0) { low = middle } else { high = middle }
    }
    // Steered into the side to which it leans.
    let motion = bicycle
        .simulation(&upright(low))
        .inputs(|_, s| bicycle::Inputs {
            handle: -60.0 * s.lean - 12.0 * s.fall - 30.0 * s.steer - 4.0 * s.turn,
        })
        .run(0.0..10.0)?;
    page(&folder, "bicycle.html", "A bicycle that is steered into its fall", &motion, |page| {
        let wheel = |radius: f64| [Shape::ring(radius, 0.02).about([0.0, 1.0, 0.0])];
        let (hub, nose, saddle) = ([-0.5, 0.0, -0.33], [0.5, 0.0, -0.33], [-0.1, 0.0, 0.1]);
        let tube = |from, to| Shape::rod(from, to, 0.025);
        let rider = Shape::cuboid([0.22, 0.36, 0.6]).at([-0.1, 0.0, 0.45]);
        page.drawn("back", wheel(0.35))
            .drawn("frame", [tube(hub, nose), tube(hub, saddle), tube(nose, saddle), rider])
            .drawn("fork", [tube([-0.025, 0.0, 0.2], [0.025, 0.0, -0.5])])
            .drawn("wheel", wheel(0.3))
            .follow("frame")
    })?;
    Ok(())
}
