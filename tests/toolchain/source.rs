//! Texts of C (`provide source;`): a compiler of C takes them without a warning, and they compute the bits that Rust does.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::LazyLock;

use guen::steppers::{Cause, Dop853, Guard, Integration, Rk4, Rk8};
use guen::{Simulate, System, mechanical_system};

mechanical_system! {
    /// A hoop that rolls on a plane.
    pub system Hoop {
        constants   { m: kg > 0 = 1, a: m > 0 = 0.4, g: m/s^2 = 9.81 }
        coordinates { x: m, y: m, φ, ψ, θ }
        constraints {
            ahead: dot(x) + a*cos(ψ)*dot(φ) = 0;
            aside: dot(y) + a*sin(ψ)*dot(φ) = 0;
        }
        parameters  { lean = dot(θ); turn = dot(ψ)*sin(θ); roll = dot(φ) + dot(ψ)*cos(θ); }
        kinetic_energy =
            m/2*((dot(x) + a*cos(ψ)*cos(θ)*dot(ψ) - a*sin(ψ)*sin(θ)*dot(θ))^2
            + (dot(y) + a*sin(ψ)*cos(θ)*dot(ψ) + a*cos(ψ)*sin(θ)*dot(θ))^2 + a^2*cos(θ)^2*dot(θ)^2)
            + m*a^2/4*(lean^2 + turn^2 + 2*roll^2);
        potential_energy = m*g*a*sin(θ);
        provide source;
        scene Tilt { fix m = 2, g = 10; track θ, lean, turn, roll; provide source; }
    }
}

mechanical_system! {
    /// Functions of all kinds, inputs, bounds, limits, names that are alike.
    pub system Cart {
        constants   { m > 0, k >= 0 = 3, slope in -1..1 = 1/7, q_1 = 2, r#type != 0 = 1/3 }
        inputs      { push, pull[2] in -1..1 }
        coordinates { q[2], angle }
        parameters  { v[0] = dot(q[0]); v[1] = dot(q[1]); w = dot(angle); }
        kinetic_energy = m/2*(v[0]^2 + v[1]^2) + w^2/2;
        potential_energy = k/2*(q[0] - q[1])^2 + cos(angle)*slope;
        states      { dot(heat) = push*push - heat/3; }
        forces {
            push*min(v[0], q_1) + sqrt(1 + v[0]^2) along v[0];
            pull[0]*max(q[0], v[1]) - r#type*abs(v[1])*v[1] + sign(pull[1]) along v[1];
            select(w >= 1/10, -w, floor(3*angle)/10) + sin(q[0]*q[1]) - cot(angle)/100 along w;
        }
        provide source;
    }
}

mechanical_system! {
    /// A block on a floor, in the mode in which it glides.
    pub system Block {
        constants   { m > 0 = 2, g = 9.81 }
        inputs      { push }
        coordinates { x, z }
        parameters  { v = dot(x); w = dot(z); }
        kinetic_energy = m/2*(v^2 + w^2);
        potential_energy = m*g*z;
        forces      { push along v; -v^3 along v; }
        contacts    { floor: gap = z; }
        scene Slides { modes { floor: closed; } track v; provide source; }
    }
}

mechanical_system! {
    /// A pendulum that is driven and damped: rates that depend on time, and decays that let steps grow.
    pub system Swing {
        constants   { l > 0 = 1, g = 9.81, damping >= 0 = 0.1, rate = 2 }
        inputs      { push }
        coordinates { q }
        parameters  { w = dot(q); }
        kinetic_energy = l^2*w^2/2;
        potential_energy = -g*l*cos(q);
        states      { dot(wear) = w^2/(1 + w^2) - wear; }
        forces      { push*sin(rate*t) - damping*w along w; }
        provide source;
    }
}

mechanical_system! {
    /// A particle that a force throws to infinity in a finite time, or whose other force is a number for a while.
    pub system Escape {
        constants   { m > 0 = 1, k = 1, last = 1 }
        coordinates { x }
        parameters  { v = dot(x); }
        kinetic_energy = m*v^2/2;
        potential_energy = -k*x^4/4;
        forces      { sqrt(last - t) along v; }
        provide source;
    }
}

mechanical_system! {
    /// Redundant coordinates: their constraint is restored after steps, which C does not do.
    pub system Bead {
        constants   { r > 0 = 1, g = 9.81 }
        coordinates { x, y }
        holonomic   { circle: x^2 + y^2 = r^2; }
        parameters  { pace = x*dot(y) - y*dot(x); }
        particles   { 1 at vec(x, y); }
        gravity     = vec(0, -g);
        provide source;
    }
}

mechanical_system! {
    /// The system of the page `docs/source.md`.
    pub system Pendulum {
        constants   { m: kg > 0 = 1, l: m > 0 = 0.5, g: m/s^2 = 9.81 }
        inputs      { torque: N*m }
        coordinates { q: rad }
        particles   { m at l*vec(sin(q), -cos(q)); }
        gravity     = vec(0, -g);
        parameters  { w = dot(q); }
        forces      { torque along w; }
        provide source;
    }
}

/// Functions that read words of 64 bits as doubles, and print doubles as such words; all NaN are one.
pub(crate) const WORDS: &str = r#"
#include <stdio.h>
#include <string.h>

static int read_all(double *x, int count)
{
    int i;
    for (i = 0; i < count; ++i) {
        unsigned long long bits;
        if (scanf("%llx", &bits) != 1)
            return 0;
        x[i] = guen_from_bits(bits);
    }
    return 1;
}

static void print_all(const double *x, int count)
{
    int i;
    for (i = 0; i < count; ++i) {
        if (x[i] == x[i])
            printf("%llx ", guen_bits(x[i]));
        else
            printf("nan ");
    }
}
"#;

/// The program that prints the bits of `prepare`, the rates, and the ends of two runs, for each line that it reads.
const PROGRAM: &str = r#"
#define SYSTEM(NAME, RUNS) \
    if (!strcmp(argument[1], #NAME)) { \
        double c[NAME##_CONSTANTS + 1], k[NAME##_PREPARED + 1], s[NAME##_STATES], u[NAME##_INPUTS + 1], r[NAME##_STATES], t, settings[6]; \
        while (read_all(c, NAME##_CONSTANTS) && read_all(&t, 1) && read_all(s, NAME##_STATES) && read_all(u, NAME##_INPUTS) && read_all(settings, 6)) { \
            int status = NAME##_prepare(c, k); \
            printf("%d ", status); \
            if (status) { \
                printf("\n"); \
                continue; \
            } \
            NAME##_rhs(c, k, t, s, u, r); \
            print_all(r, NAME##_STATES); \
            RUNS \
            printf("\n"); \
        } \
    }
#define ADAPTIVE(NAME) { \
        double at = t, x[NAME##_STATES], times[5], samples[5 * NAME##_STATES]; \
        guen_adaptive method = { settings[0], settings[1], settings[2], (unsigned long long)settings[3], 0, 0, 0 }; \
        int i, status; \
        for (i = 0; i < 5; ++i) \
            times[i] = i == 4 ? t + settings[4] : t + settings[4] * (i * i) / 17.0; \
        for (i = 0; i < 5 * NAME##_STATES; ++i) \
            samples[i] = 0.0; \
        memcpy(x, s, sizeof x); \
        status = NAME##_dop853(c, k, u, &at, x, t + settings[4], &method, (int)settings[5], times, samples); \
        printf("%d %llu %llu %llu ", status, method.evaluations, method.accepted, method.rejected); \
        print_all(&at, 1); \
        print_all(x, NAME##_STATES); \
        print_all(samples, 5 * NAME##_STATES); \
    }
#define RUN(NAME, METHOD) { \
        double at = t, x[NAME##_STATES]; \
        memcpy(x, s, sizeof x); \
        printf("%d ", NAME##_##METHOD(c, k, u, &at, x, t + 0.73, 0.05)); \
        print_all(x, NAME##_STATES); \
    }

int main(int count, char **argument)
{
    if (count < 2)
        return 1;
    SYSTEM(hoop, RUN(hoop, rk4) RUN(hoop, rk8) ADAPTIVE(hoop))
    SYSTEM(hoop_tilt, RUN(hoop_tilt, rk4) RUN(hoop_tilt, rk8) ADAPTIVE(hoop_tilt))
    SYSTEM(cart, RUN(cart, rk4) RUN(cart, rk8))
    SYSTEM(block_slides, RUN(block_slides, rk4) RUN(block_slides, rk8) ADAPTIVE(block_slides))
    SYSTEM(swing, ADAPTIVE(swing))
    SYSTEM(escape, ADAPTIVE(escape))
    SYSTEM(bead, )
    return 0;
}
"#;

/// Compiles a text of C, in which every warning is an error.
pub(crate) fn compile(text: &str, name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("guen-source-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("pendulum.h"), pendulum::SOURCE.to_string()).unwrap();
    let (file, program) = (folder.join(format!("{name}.c")), folder.join(name));
    std::fs::write(&file, text).unwrap();
    let made = Command::new("cc")
        .args(["-std=c99", "-O2", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-o"])
        .args([&program, &file])
        .arg("-lm")
        .output()
        .expect("the compiler `cc`, which Rust links with, too");
    assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
    program
}

/// The compiled program.
static COMPILED: LazyLock<PathBuf> = LazyLock::new(compiled);

fn compiled() -> PathBuf {
    let mut text = String::new();
    // Twice: the second time a text says nothing.
    for _ in 0..2 {
        for source in [
            hoop::SOURCE,
            hoop::tilt::SOURCE,
            cart::SOURCE,
            block::slides::SOURCE,
            swing::SOURCE,
            escape::SOURCE,
            bead::SOURCE,
        ] {
            text += &source.to_string();
        }
    }
    compile(&(text + WORDS + PROGRAM), "systems")
}

/// The lines that a program prints for lines of numbers, asked for a system.
pub(crate) fn answers(program: &Path, system: &str, lines: &[Vec<f64>]) -> Vec<String> {
    let mut text = String::new();
    for value in lines.iter().flatten() {
        let _ = write!(text, "{:x} ", value.to_bits());
    }
    let mut child =
        Command::new(program).arg(system).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
    let mut input = child.stdin.take().unwrap();
    let writer = std::thread::spawn(move || input.write_all(text.as_bytes()));
    let output = child.wait_with_output().unwrap();
    writer.join().unwrap().unwrap();
    String::from_utf8(output.stdout).unwrap().lines().map(|line| line.trim().to_owned()).collect()
}

/// The bits of a state as the program prints them; all NaN are one.
pub(crate) fn bits(state: &[f64]) -> String {
    let word = |x: &f64| if x.is_nan() { "nan ".to_owned() } else { format!("{:x} ", x.to_bits()) };
    state.iter().map(word).collect()
}

/// The results of Rust: the status of `prepare`, the rates and the runs. None where a run comes to an edge of the chart, for which the text of C
/// has no check.
fn computed<const N: usize>(
    system: &impl System<f64, N>,
    t: f64,
    s: &[f64; N],
    runs: Runs<'_>,
) -> Option<String> {
    let mut text = format!("0 {}", bits(&system.rhs(t, s)));
    if let Runs::Fixed | Runs::All(_) = runs {
        let go = |_: f64, _: &[f64; N]| std::ops::ControlFlow::Continue(());
        let ends = [
            Rk4::new(0.05).integrate(system, t, s, t + 0.73, go).ok()?.state,
            Rk8::new(0.05).integrate(system, t, s, t + 0.73, go).ok()?.state,
        ];
        ends.iter().for_each(|end| text += &format!("0 {}", bits(end)));
    }
    if let Runs::All(settings) | Runs::Adaptive(settings) = runs {
        text += &adaptive(system, t, s, settings)?;
    }
    Some(text.trim().to_owned())
}

/// The runs that are compared.
#[derive(Clone, Copy)]
enum Runs<'a> {
    None,
    Fixed,
    /// With DOP853, under these settings.
    All(&'a [f64; 6]),
    /// DOP853 alone.
    Adaptive(&'a [f64; 6]),
}

/// A run of DOP853 as the program in C prints it. Settings are tolerances, the first step, the number of steps, the span and the number of samples.
fn adaptive<const N: usize>(
    system: &impl System<f64, N>,
    t: f64,
    s: &[f64; N],
    &[rtol, atol, first, most, span, count]: &[f64; 6],
) -> Option<String> {
    let method = Dop853::new(rtol, atol).with_max_steps(most as u64);
    let method = if first != 0.0 { method.with_first_step(first) } else { method };
    let times: [f64; 5] =
        std::array::from_fn(|i| if i == 4 { t + span } else { t + span * (i * i) as f64 / 17.0 });
    let mut samples = [[0.0; N]; 5];
    let run = Integration::new(system, t, s)
        .guard(Guard::FINITE)
        .sample(&times[..count as usize], &mut |k, _, state| samples[k] = *state)
        .run(&method, t + span);
    let (status, time, state, work) = match run {
        Ok(done) => (0, done.time, done.state, done.statistics),
        Err(error) => {
            let status = match error.cause {
                Cause::Setting(_) => 1,
                Cause::StepUnderflow => 2,
                Cause::NotFinite => 3,
                Cause::TooManySteps { .. } => 4,
                _ => return None,
            };
            (status, error.time, error.state, error.statistics)
        }
    };
    let work = format!("{status} {} {} {} ", work.evaluations, work.accepted, work.rejected);
    Some(work + &bits(&[time]) + &bits(&state) + &bits(samples.as_flattened()))
}

/// Settings of all kinds of runs: forwards and backwards, with few samples and many, tolerances that are met and one that cannot be.
fn settings(round: usize, draw: &mut impl FnMut() -> f64) -> [f64; 6] {
    let tolerance = 10_f64.powf(-7.0 + 4.0 * draw());
    let first = if round.is_multiple_of(3) { 0.2 + 0.1 * draw() } else { 0.0 };
    let span = [0.9, -0.4, 2.5, 0.0, 1.5][round % 5] * (1.0 + draw() / 2.0);
    let most = if round.is_multiple_of(7) { 3.0 } else { 2000.0 };
    let usual = [tolerance, tolerance * 10.0, first, most, span, (round % 6) as f64];
    match round % 40 {
        11 => [1e-300, 1e-300, first, most, 0.9, 5.0],
        21 => [tolerance, 0.0, first, most, 0.9, 5.0],
        31 => [tolerance, tolerance, -1.0, most, 0.9, 5.0],
        _ => usual,
    }
}

/// Numbers that are the same in every run of the tests, between -1 and 1.
pub(crate) fn draws() -> impl FnMut() -> f64 {
    let mut state = 0x2545_f491_4f6c_dd1d_u64;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

#[test]
fn bits_are_those_of_rust() {
    let mut draw = draws();
    let compare = |name: &str, lines: Vec<(Vec<f64>, String)>| {
        assert!(lines.len() > 40, "{name} {}", lines.len());
        let (given, expected): (Vec<_>, Vec<_>) = lines.into_iter().unzip();
        let found = answers(&COMPILED, name, &given);
        assert_eq!(found.len(), expected.len(), "{name}");
        for ((found, expected), given) in found.iter().zip(&expected).zip(&given) {
            assert_eq!(found, expected, "{name} {given:?}");
        }
    };

    let mut lines = Vec::new();
    for round in 0..200 {
        let system = Hoop { m: 1.5 + draw(), a: 0.6 + draw() / 2.0, g: 9.81 };
        // Angles near and far, where they are reduced in another way.
        let far = [1.0, 1e5, 1e7, 1e19, 1e300][round % 5];
        let s: [f64; 8] = std::array::from_fn(|i| {
            if i == 4 { 1.2 + draw() / 2.0 } else { draw() * if i == 3 { far } else { 1.0 } }
        });
        let t = draw();
        let settings = settings(round, &mut draw);
        let mut given = vec![system.m, system.a, system.g, t];
        given.extend(s);
        given.extend(settings);
        lines.extend(
            computed(&system.prepare().unwrap(), t, &s, Runs::All(&settings)).map(|bits| (given, bits)),
        );
    }
    compare("hoop", lines);

    let mut lines = Vec::new();
    for round in 0..120 {
        let settings = settings(round, &mut draw);
        let system = hoop::Tilt { a: 0.6 + draw() / 2.0 };
        let (s, t) = ([1.4 + draw() / 4.0, draw() / 2.0, draw(), draw()], draw());
        let given = [&[system.a, t], &s[..], &settings].concat();
        lines.extend(
            computed(&system.prepare().unwrap(), t, &s, Runs::All(&settings)).map(|bits| (given, bits)),
        );
    }
    compare("hoop_tilt", lines);

    let mut lines = Vec::new();
    for _ in 0..200 {
        let system =
            Cart { k: 2.0 + draw(), slope: draw(), q_1: draw(), r#type: 0.5, ..Cart::new(2.0 + draw()) };
        let s: [f64; 7] = std::array::from_fn(|i| if i == 2 { 1.5 + draw() } else { 2.0 * draw() });
        let inputs = cart::Inputs { push: draw(), pull: [draw(), draw()] };
        let t = draw();
        let mut given = vec![system.m, system.k, system.slope, system.q_1, system.r#type, t];
        given.extend(s);
        given.extend([inputs.push, inputs.pull[0], inputs.pull[1]]);
        given.extend([0.0; 6]);
        lines.extend(
            computed(&system.prepare().unwrap().driven(inputs), t, &s, Runs::Fixed).map(|bits| (given, bits)),
        );
    }
    compare("cart", lines);

    let mut lines = Vec::new();
    for round in 0..50 {
        let settings = settings(round, &mut draw);
        let system = block::Slides { m: 2.0 + draw(), ..Default::default() };
        let (s, push, t) = ([2.0 + draw()], 30.0 * (1.1 + draw()), draw());
        let given = [&[system.m, system.g, t, s[0], push], &settings[..]].concat();
        let driven = system.prepare().unwrap().driven(block::slides::Inputs { push });
        lines.extend(computed(&driven, t, &s, Runs::All(&settings)).map(|bits| (given, bits)));
    }
    compare("block_slides", lines);

    let mut lines = Vec::new();
    for round in 0..400 {
        let settings = settings(round, &mut draw);
        let system = Swing { l: 1.1 + draw(), damping: 1.0 + draw(), ..Swing::default() };
        // Among them states and inputs that are not finite, and those whose rates are not.
        let far = [1.0, 1.0, 1e3, 1e180, f64::NAN][if round % 9 == 0 { round / 9 % 5 } else { 0 }];
        let s = [3.0 * draw(), far * draw(), draw()];
        let (push, t) = (if round == 100 { f64::INFINITY } else { 5.0 * draw() }, 10.0 * draw());
        let given =
            [&[system.l, system.g, system.damping, system.rate, t], &s[..], &[push], &settings].concat();
        let driven = system.prepare().unwrap().driven(swing::Inputs { push });
        lines.extend(computed(&driven, t, &s, Runs::Adaptive(&settings)).map(|bits| (given, bits)));
    }
    // Every end that a run can come to is among them.
    for status in ["0", "1", "2", "3", "4"] {
        // After the status of `prepare` and three rates.
        assert!(lines.iter().any(|(_, line)| line.split(' ').nth(4) == Some(status)), "{status}");
    }
    compare("swing", lines);

    let (mut lines, mut stopped) = (Vec::new(), [0; 2]);
    for round in 0..300 {
        let [rtol, atol, first, _, _, count] = settings(round, &mut draw);
        // With a first step beyond the end a state is not finite, and with short ones steps become too small.
        let first = if round % 4 == 1 { 1e3 } else { first };
        let settings = [rtol, atol, first, 2000.0, [4.0, -5.0, 1e3][round % 3], count];
        let system = Escape {
            m: 1.5 + draw(),
            k: 2.0 + draw(),
            last: if round.is_multiple_of(2) { 1.1 } else { 1e3 },
        };
        let (s, t) = ([draw(), draw()], draw());
        let given = [&[system.m, system.k, system.last, t], &s[..], &settings].concat();
        lines.extend(computed(&system.prepare().unwrap(), t, &s, Runs::Adaptive(&settings)).map(|bits| {
            // The status of the run after that of `prepare` and two rates, then its accepted steps.
            let words: Vec<&str> = bits.split(' ').collect();
            let is_late = words[5] != "0";
            stopped[0] += usize::from(is_late && words[3] == "2");
            stopped[1] += usize::from(is_late && words[3] == "3");
            (given, bits)
        }));
    }
    println!("stopped after accepted steps: {stopped:?}");
    assert!(stopped[0] > 50 && stopped[1] > 20, "{stopped:?}");
    compare("escape", lines);

    let mut lines = Vec::new();
    for _ in 0..50 {
        let system = Bead { r: 1.0, g: 9.0 + draw() };
        let (angle, pace) = (3.0 * draw(), draw());
        let s = [angle.cos(), angle.sin(), pace];
        let given = [&[1.0, system.g, 0.0, s[0], s[1], pace], &[0.0; 6][..]].concat();
        lines.extend(computed(&system.prepare().unwrap(), 0.0, &s, Runs::None).map(|bits| (given, bits)));
    }
    compare("bead", lines);
}

#[test]
fn the_program_of_the_page_prints_what_rust_computes() {
    let page = include_str!("../../docs/source.md");
    let program = page.split("```c\n").nth(1).unwrap().split("```").next().unwrap();
    let output = Command::new(compile(program, "page")).output().unwrap();
    assert!(output.status.success());
    let pendulum = Pendulum::default().prepare().unwrap().driven(pendulum::Inputs { torque: 0.0 });
    let go = |_: f64, _: &[f64; 2]| std::ops::ControlFlow::Continue(());
    let end = Rk4::new(0.01).integrate(&pendulum, 0.0, &[1.0, 0.0], 2.0, go).unwrap();
    let printed = String::from_utf8(output.stdout).unwrap();
    let angle: f64 = printed.trim().strip_prefix("2 ").unwrap().parse().unwrap();
    assert!((angle - end.state[0]).abs() < 1e-5 && angle.abs() > 0.01, "{printed} {:?}", end.state);

    // The second block, behind the declarations of the first.
    let further = page.split("```c\n").nth(2).unwrap().split("```").next().unwrap();
    let (before, _) = program.split_once("    if (").unwrap();
    let after = r#"printf("%d %llx\n", status, guen_bits(samples[2 * pendulum_STATES]));"#;
    let text = format!("{before}    pendulum_prepare(c, k);\n{further}{after}\n    return 0;\n}}\n");
    let output = Command::new(compile(&text, "page_adaptive")).output().unwrap();
    let end = Dop853::new(1e-9, 1e-12).integrate(&pendulum, 0.0, &[1.0, 0.0], 2.0, go).unwrap();
    let printed = String::from_utf8(output.stdout).unwrap();
    assert_eq!(printed.trim(), format!("0 {}", bits(&end.state[..1]).trim()));
}

#[test]
fn constants_out_of_their_bounds_are_told_by_their_number() {
    let status = |c: [f64; 5]| {
        let given = [&c[..], &[0.0; 17]].concat();
        answers(&COMPILED, "cart", &[given])[0].split(' ').next().unwrap().parse::<i32>().unwrap()
    };
    assert_eq!(status([1.0, 1.0, 0.5, 1.0, 1.0]), 0);
    assert_eq!(status([0.0, 1.0, 0.5, 1.0, 1.0]), 1);
    assert_eq!(status([1.0, -1.0, 0.5, 1.0, 1.0]), 2);
    assert_eq!(status([1.0, 1.0, 1.5, 1.0, 1.0]), 3);
    assert_eq!(status([1.0, 1.0, 0.5, f64::NAN, 1.0]), 4);
    assert_eq!(status([1.0, 1.0, 0.5, 1.0, 0.0]), 5);
    // Finite, and its reciprocal is not.
    assert_eq!(status([1e-320, 1.0, 0.5, 1.0, 1.0]), -1);
}

#[test]
fn systems_have_the_digests_of_their_declarations() {
    let digests = [
        <hoop::Prepared as Simulate<f64, 8>>::DECLARATION,
        <hoop::tilt::Prepared as Simulate<f64, 4>>::DECLARATION,
        <bead::Prepared as Simulate<f64, 3>>::DECLARATION,
        <block::slides::Driven as Simulate<f64, 1>>::DECLARATION,
        <pendulum::Driven as Simulate<f64, 2>>::DECLARATION,
    ];
    assert!((0..5).all(|i| digests[i] != 0 && !digests[..i].contains(&digests[i])), "{digests:x?}");
}

#[test]
fn places_have_names_and_texts_say_what_they_have() {
    let text = cart::SOURCE.to_string();
    for line in
        ["cart_c_type = 4,", "cart_s_q_0 = 0,", "cart_s_heat = 6,", "cart_u_pull_1 = 2,", "cart_c_q_1 = 3,"]
    {
        assert!(text.contains(line), "{line}");
    }
    let text = hoop::SOURCE.to_string();
    assert!(text.contains("hoop_c_m = 0, /* kg */") && text.contains("hoop_s_u3b8 = 4,"));
    assert_eq!(text.matches("#include").count(), 1);
    assert!(!bead::SOURCE.steps && !bead::SOURCE.to_string().contains("rk4"));
    assert!(
        cart::SOURCE.to_string().contains("int cart_rk8(") && !cart::SOURCE.to_string().contains("dop853")
    );
    assert!(hoop::SOURCE.to_string().contains("int hoop_dop853("));
    for (report, line) in [
        (
            cart::REPORT.to_string(),
            "no DOP853 in the text of C: its steps would have to begin anew at the zeros of",
        ),
        (bead::REPORT.to_string(), "no steppers in the text of C: constraints of positions"),
    ] {
        assert!(report.contains(line), "{report}");
    }
    assert!(!hoop::REPORT.to_string().contains("text of C"));
}
