//! Kernels for graphics processors, on the CPU: a compiler of C takes their texts, loops stand in for threads, and motions have the bits of
//! ensembles in lanes.

use std::collections::BTreeMap;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::{Arc, Mutex, OnceLock};

use guen::steppers::{Cause, Dop853, Rk4, Rk8};
use guen::{IntegrationError, Kernel, KernelMethod, Laned, Sourced};
use guen_study::{
    Device, DeviceFault, DeviceMethod, End, Ensemble, KernelBatch, KernelEngine, KernelOutcome, Sampled,
};

use super::source::{Bead, Cart, Escape, Hoop, Swing, bead, cart, draws, hoop, swing};

/// The words of the dialect in C, and the coordinates of a thread.
const BEFORE: &str = r#"
#define GUEN_KERNEL static
#define GUEN_FUNCTION static inline
typedef struct { unsigned x, y, z; } coordinates;
static coordinates threadIdx, blockIdx, blockDim;
"#;

/// The words with which C++ compiles a kernel without defining `GUEN_KERNEL` first.
const BEFORE_DIALECT: &str = r#"
#define __global__ static
#define __device__
#undef GUEN_KERNEL
#define GUEN_KERNEL extern "C"
#define GUEN_FUNCTION static inline
typedef struct { unsigned x, y, z; } coordinates;
static coordinates threadIdx, blockIdx, blockDim;
"#;

/// Reads a batch in words, runs blocks of 32 threads one by one, and writes the outcome. Threads without a motion come last: a word that one
/// of them wrote would be seen.
const AFTER: &str = r#"
#include <stdio.h>
#include <stdlib.h>

static void *words(unsigned long long count, int are_read)
{
    void *all = calloc((size_t)count + 1, 8);
    if (!all || (are_read && fread(all, 8, (size_t)count, stdin) != count))
        exit(1);
    return all;
}

int main(void)
{
    unsigned long long *head = (unsigned long long *)words(8, 1), count = head[0], systems = head[1], stops = head[2], keep = head[3];
    double *settings = (double *)words(4, 1), *begin = (double *)words(1, 1), *times = (double *)words(stops, 1);
    double *numbers = (double *)words(head[4], 1), *starts = (double *)words(head[5], 1);
    unsigned long long of_ends = head[6], of_samples = head[7];
    double *ends = (double *)words(of_ends, 0), *samples = (double *)words(of_samples, 0);
    unsigned long long *work = (unsigned long long *)words(4 * count, 0), block, thread;
    blockDim.x = 32;
    for (block = 0; block < (count + 31) / 32; ++block)
        for (thread = 0; thread < 32; ++thread) {
            blockIdx.x = (unsigned)block;
            threadIdx.x = (unsigned)thread;
            ENTRY(count, systems, numbers, starts, *begin, settings, (int)stops, times, (int)keep, ends, samples, work);
        }
    fwrite(ends, 8, (size_t)of_ends, stdout);
    fwrite(samples, 8, (size_t)of_samples, stdout);
    fwrite(work, 8, (size_t)(4 * count), stdout);
    return 0;
}
"#;

/// A stand-in for a device: a program for each kernel, compiled as C or as C++.
struct Compiled {
    is_cpp: bool,
}

/// The programs by their names, each compiled once.
static PROGRAMS: Mutex<BTreeMap<String, Arc<OnceLock<PathBuf>>>> = Mutex::new(BTreeMap::new());

impl Compiled {
    fn engine(is_cpp: bool) -> Box<dyn KernelEngine> {
        Box::new(Self { is_cpp })
    }

    fn program(&self, kernel: &Kernel) -> PathBuf {
        let language = if self.is_cpp { "cpp" } else { "c" };
        let name = format!("{}_{}_{language}", kernel.entry(), kernel.method().stepper());
        let program = PROGRAMS.lock().unwrap().entry(name.clone()).or_default().clone();
        program.get_or_init(|| compile(kernel, &name, self.is_cpp)).clone()
    }
}

/// Whether the compiler takes C++, too.
fn has_cpp() -> bool {
    let asked = Command::new("cc").args(["-xc++", "-fsyntax-only", "/dev/null"]).output();
    asked.is_ok_and(|output| output.status.success())
}

fn folder() -> PathBuf {
    let folder = std::env::temp_dir().join(format!("guen-kernels-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

/// The program of a kernel, in which every warning is an error.
fn compile(kernel: &Kernel, name: &str, is_cpp: bool) -> PathBuf {
    let (before, ending, flags) = match is_cpp {
        true => (BEFORE_DIALECT, "cc", ["-xc++", "-std=c++11", "-ffp-contract=off"]),
        false => (BEFORE, "c", ["-xc", "-std=c99", "-Wpedantic"]),
    };
    let text = format!("{before}{kernel}{}", AFTER.replace("ENTRY", &kernel.entry().to_string()));
    let file = folder().join(format!("{name}.{ending}"));
    let program = folder().join(name);
    std::fs::write(&file, text).unwrap();
    let made = Command::new("cc")
        .args(flags)
        .args(["-O1", "-Wall", "-Wextra", "-Werror", "-o"])
        .args([&program, &file])
        .arg("-lm")
        .output()
        .unwrap();
    assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
    program
}

fn run(program: &Path, batch: &KernelBatch<'_>) -> KernelOutcome {
    let [of_ends, of_samples, of_work] = batch.lengths();
    let head = [
        batch.motions,
        batch.systems,
        batch.times.len(),
        usize::from(batch.keep),
        batch.numbers.len(),
        batch.starts.len(),
        of_ends,
        of_samples,
    ];
    let doubles = [&batch.settings[..], &[batch.t0], batch.times, &batch.numbers, &batch.starts].concat();
    let words = head.iter().map(|word| *word as u64).chain(doubles.iter().map(|number| number.to_bits()));
    let bytes: Vec<u8> = words.flat_map(u64::to_ne_bytes).collect();
    let mut child = Command::new(program).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
    let mut input = child.stdin.take().unwrap();
    let writer = std::thread::spawn(move || input.write_all(&bytes));
    let output = child.wait_with_output().unwrap();
    writer.join().unwrap().unwrap();
    assert!(output.status.success(), "{:?}", output.status);
    let words: Vec<u64> =
        output.stdout.as_chunks().0.iter().map(|bytes| u64::from_ne_bytes(*bytes)).collect();
    assert_eq!(words.len(), of_ends + of_samples + of_work);
    let (ends, rest) = words.split_at(of_ends);
    let (samples, work) = rest.split_at(of_samples);
    let numbers = |words: &[u64]| words.iter().map(|word| f64::from_bits(*word)).collect();
    KernelOutcome { ends: numbers(ends), samples: numbers(samples), work: work.to_vec() }
}

impl KernelEngine for Compiled {
    fn run(&self, kernel: &Kernel, batch: &KernelBatch<'_>) -> Result<KernelOutcome, DeviceFault> {
        Ok(run(&self.program(kernel), batch))
    }
}

/// Everything of an end in words, which tell NaN and signs of zero from others.
fn words<const N: usize>(end: &End<N>) -> (String, Vec<u64>) {
    let bits = |time: f64, state: &[f64; N]| [time].iter().chain(state).map(|x| x.to_bits()).collect();
    match end {
        Ok(end) => (format!("{:?} {:?}", end.outcome, end.statistics), bits(end.time, &end.state)),
        Err(error) => {
            let IntegrationError { time, state, cause, statistics } = error;
            (format!("{cause:?} {statistics:?}"), bits(*time, state))
        }
    }
}

fn all_words<const N: usize>(motion: &Sampled<N>) -> (Vec<u64>, (String, Vec<u64>)) {
    (motion.states.as_flattened().iter().map(|x| x.to_bits()).collect(), words(&motion.end))
}

/// Whether the guard has stopped a motion on the CPU by a check that is not made after every step on a device: that of single steps, or one
/// between the states that are seen.
fn is_of_guard<const N: usize>(end: &End<N>) -> bool {
    end.as_ref().is_err_and(|error| {
        matches!(error.cause, Cause::Energy { .. } | Cause::Step { .. } | Cause::Condition { .. })
    })
}

/// The motions of a comparison: those that ended in an error on the CPU, those that were computed there again, and those that only a guard
/// has stopped there.
#[derive(Debug)]
struct Counts {
    failed: usize,
    again: usize,
    unseen: usize,
}

/// Compares ends and samples of an ensemble on the stand-in with those on the CPU.
fn compare<S, M, const N: usize>(
    what: &str,
    ensemble: &Ensemble<S, N>,
    method: &M,
    t0: f64,
    times: &[f64],
    is_cpp: bool,
) -> Counts
where
    S: Laned<N> + Sourced<N> + Clone + Sync,
    M: DeviceMethod,
{
    let on_cpu = ensemble.clone().on(Device::Cpu);
    // Batches that are no multiple of a block, with a rest.
    let on_device = ensemble.clone().on_engine(Compiled::engine(is_cpp)).with_batch(45);
    let last = *times.last().unwrap();
    let (found, expected) = (on_device.integrate(method, t0, last), on_cpu.integrate(method, t0, last));
    assert_eq!(
        (found.device, &found.fault, expected.device),
        (Device::Cuda(0), &None, Device::Cpu),
        "{what}"
    );
    assert_eq!(found.motions.len(), ensemble.len());
    let mut counts = Counts { failed: 0, again: found.again, unseen: 0 };
    for (index, (found, expected)) in found.motions.iter().zip(&expected.motions).enumerate() {
        counts.failed += usize::from(expected.is_err());
        if found.is_ok() && is_of_guard(expected) {
            counts.unseen += 1;
        } else {
            assert_eq!(words(found), words(expected), "{what}: end {index}");
        }
    }
    let (found, expected) = (on_device.sample(method, t0, times), on_cpu.sample(method, t0, times));
    for (index, (found, expected)) in found.motions.iter().zip(&expected.motions).enumerate() {
        if !(found.end.is_ok() && is_of_guard(&expected.end)) {
            assert_eq!(all_words(found), all_words(expected), "{what}: samples {index}");
        }
    }
    println!("{what}: {counts:?}");
    counts
}

const TIMES: [f64; 4] = [0.2, 0.31, 0.9, 1.7];
/// With a turn back, which methods with a fixed step make.
const TURNING: [f64; 5] = [0.2, 1.3, 1.3, 0.9, 1.7];
/// Times with a turn back, before which few hoops fall over.
const SHORT: [f64; 4] = [0.1, 0.33, 0.2, 0.4];

#[test]
fn motions_have_the_bits_of_ensembles_in_lanes() {
    let mut draw = draws();
    let hoops = Ensemble::of_systems((0..101).map(|_| {
        let hoop = Hoop { m: 1.5 + draw(), a: 0.6 + draw() / 2.0, g: 9.81 };
        let start: [f64; 8] =
            std::array::from_fn(|i| draw() / 4.0 + [0.0, 0.0, 0.0, 0.0, 1.5, 0.0, 0.0, 9.0][i]);
        (hoop.prepare().unwrap(), start)
    }));
    let swings = Ensemble::of_systems((0..101).map(|_| {
        let swing = Swing { l: 1.5 + draw(), damping: 1.0 + draw(), ..Swing::default() };
        let inputs = swing::Inputs { push: 5.0 * draw() };
        (swing.prepare().unwrap().driven(inputs), [3.0 * draw(), draw(), draw()])
    }));
    let adaptive = Dop853::new(1e-9, 1e-10);
    for counts in [
        compare("hoop, RK4", &hoops, &Rk4::new(0.005), 0.0, &SHORT, false),
        compare("hoop, RK8", &hoops, &Rk8::new(0.02), 0.0, &SHORT, false),
        compare("hoop, DOP853", &hoops, &adaptive, 0.0, &[0.1, 0.11, 0.4], false),
        compare("swing, RK4", &swings, &Rk4::new(0.01), -1.0, &TURNING, false),
        compare("swing, RK8", &swings, &Rk8::new(0.05), -1.0, &TURNING, false),
        compare("swing, DOP853", &swings, &adaptive, 2.0, &[2.0, 1.0, 0.5], false),
    ] {
        assert!(counts.again < 40 && counts.unseen < 3, "{counts:?}");
    }
    // The dialect as it is, which is C++.
    if has_cpp() {
        for counts in [
            compare("swing, RK8 in C++", &swings, &Rk8::new(0.05), -1.0, &TURNING, true),
            compare("swing, DOP853 in C++", &swings, &adaptive, -1.0, &TIMES, true),
        ] {
            assert!(counts.again == 0, "{counts:?}");
        }
    } else {
        println!("`cc` compiles no C++: the dialect is tested as C alone");
    }
}

#[test]
fn one_system_moves_from_many_states_and_scenes_have_kernels() {
    let mut draw = draws();
    let cart = Cart::new(1.7).prepare().unwrap().driven(cart::Inputs { push: 0.3, pull: [0.1, -0.2] });
    let starts = (0..70).map(|_| std::array::from_fn(|i| draw() + if i == 2 { 1.5 } else { 0.0 }));
    let carts = Ensemble::of_states(cart, starts.collect::<Vec<[f64; 7]>>());
    let counts = compare("cart, RK4", &carts, &Rk4::new(0.01), 0.5, &TURNING, false);
    assert!(counts.again < 20 && counts.unseen < 5, "{counts:?}");
    let tilt = hoop::Tilt { a: 0.6 }.prepare().unwrap();
    let starts = (0..33).map(|_| [1.4 + draw() / 4.0, draw() / 4.0, draw() / 4.0, 9.0 + draw()]);
    let tilts = Ensemble::of_states(tilt, starts.collect::<Vec<[f64; 4]>>());
    let counts = compare("tilt, RK8", &tilts, &Rk8::new(0.02), 0.0, &SHORT, false);
    assert!(counts.again < 10 && counts.unseen < 3, "{counts:?}");
}

#[test]
fn motions_that_fail_fail_alone_with_the_cause_of_the_cpu() {
    let mut draw = draws();
    let escapes = Ensemble::of_systems((0..97).map(|i| {
        let last = if i % 3 == 0 { 0.6 } else { 1e3 };
        let escape = Escape { m: 60.0 + 50.0 * draw(), k: 1.0 + draw(), last };
        let start = [if i == 50 { f64::NAN } else { draw() }, draw()];
        (escape.prepare().unwrap(), start)
    }));
    let few = Dop853::new(1e-9, 1e-9).with_max_steps(25);
    for (what, counts) in [
        ("RK4", compare("escape, RK4", &escapes, &Rk4::new(0.01), 0.0, &TURNING, false)),
        ("RK8", compare("escape, RK8", &escapes, &Rk8::new(0.05), 0.0, &TURNING, false)),
        ("DOP853", compare("escape, DOP853", &escapes, &few, 0.0, &TIMES, false)),
    ] {
        assert!(counts.failed > 20 && counts.again > 20 && counts.again < 80, "{what}: {counts:?}");
    }
    let ends = escapes.clone().on_engine(Compiled::engine(false)).integrate(&few, 0.0, 1.7).motions;
    let has = |wanted: &dyn Fn(&Cause) -> bool| {
        ends.iter().any(|end| end.as_ref().is_err_and(|error| wanted(&error.cause)))
    };
    assert!(has(&|cause| *cause == Cause::NotFinite));
    assert!(has(&|cause| matches!(cause, Cause::TooManySteps { limit: 25 })));
}

#[test]
fn settings_without_sense_are_errors_of_every_member() {
    let swing = Swing::default().prepare().unwrap().driven(swing::Inputs { push: 0.0 });
    let swings = Ensemble::of_states(swing, [[1.0, 0.0, 0.0], [0.5, 0.1, 0.0]]);
    let on_device = |method: &dyn Fn(&guen_study::OnDevice<swing::Driven, 3>) -> Vec<End<3>>| {
        let found = method(&swings.clone().on_engine(Compiled::engine(false)));
        let expected = method(&swings.clone().on(Device::Cpu));
        assert!(found.len() == 2 && found.iter().all(Result::is_err));
        assert_eq!(
            found.iter().map(words).collect::<Vec<_>>(),
            expected.iter().map(words).collect::<Vec<_>>()
        );
    };
    for step in [0.0, -0.1, f64::NAN, f64::INFINITY] {
        on_device(&|swings| swings.integrate(&Rk4::new(step), 0.0, 1.0).motions);
    }
    for (t0, t1) in [(f64::NAN, 1.0), (0.0, f64::INFINITY), (f64::INFINITY, f64::INFINITY)] {
        on_device(&|swings| swings.integrate(&Rk8::new(0.1), t0, t1).motions);
        on_device(&|swings| swings.integrate(&Dop853::new(1e-6, 1e-6), t0, t1).motions);
    }
    for first in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let method = Dop853::new(1e-6, 1e-6).with_first_step(first);
        on_device(&|swings| swings.integrate(&method, 0.0, 1.0).motions);
    }
    on_device(&|swings| swings.integrate(&Dop853::new(-1.0, 1e-6), 0.0, 1.0).motions);
    on_device(&|swings| {
        let sampled = swings.sample(&Dop853::new(1e-6, 1e-6), 0.0, &[1.0, 0.5]).motions;
        sampled.into_iter().map(|motion| motion.end).collect()
    });
}

#[test]
fn edges_of_charts_are_found_after_every_step() {
    // Hoops that fall over: on the other side of the chart's edge their motion means nothing, and steps of this size pass it.
    let hoop = Hoop::default().prepare().unwrap();
    let starts = (0..40).map(|i| [0.0, 0.0, 0.0, 0.0, 1.2, 0.1, 0.01 * f64::from(i), 0.02 * f64::from(i)]);
    let hoops = Ensemble::of_states(hoop, starts.collect::<Vec<[f64; 8]>>());
    for (step, at_least) in [(0.1, 20), (0.003, 20)] {
        let method = Rk4::new(step);
        let counts = compare(&format!("falling hoops, {step}"), &hoops, &method, 0.0, &[1.0, 3.0], false);
        assert!(counts.failed >= at_least && counts.unseen < 3, "{counts:?}");
    }
    let counts = compare("falling hoops, DOP853", &hoops, &Dop853::new(1e-8, 1e-8), 0.0, &[1.0, 3.0], false);
    assert!(counts.failed > 5 && counts.unseen == 0, "{counts:?}");
}

#[test]
fn methods_that_a_text_has_not_are_told_and_computed_on_the_cpu() {
    let cart = Cart::new(1.7).prepare().unwrap().driven(cart::Inputs { push: 0.3, pull: [0.1, -0.2] });
    let carts = Ensemble::of_states(cart, [[0.1, 0.2, 1.5, 0.0, 0.1, 0.2, 0.0]]);
    let method = Dop853::new(1e-6, 1e-6);
    let expected = carts.clone().on(Device::Cpu).integrate(&method, 0.0, 1.0);
    let found = carts.on_engine(Compiled::engine(false)).integrate(&method, 0.0, 1.0);
    assert_eq!(found.fault, Some(DeviceFault::NoMethod { method: "dop853" }));
    assert_eq!((found.device, &found.motions), (Device::Cpu, &expected.motions));
    assert!(bead::SOURCE.kernel(KernelMethod::Rk4).is_none());
    let bead = Bead { r: 1.0, g: 9.81 }.prepare().unwrap();
    let beads = Ensemble::of_states(bead, [[1.0, 0.0, 0.0]]).on_engine(Compiled::engine(false));
    let fault = beads.integrate(&Rk4::new(0.01), 0.0, 1.0).fault.unwrap();
    assert_eq!(fault.to_string(), "the system's text of C has no `rk4`");
}

#[test]
fn without_a_device_the_cpu_computes_and_the_run_says_why() {
    let swing = Swing::default().prepare().unwrap().driven(swing::Inputs { push: 0.0 });
    let swings = Ensemble::of_states(swing, [[1.0, 0.0, 0.0], [0.5, 0.1, 0.0]]);
    let expected = swings.integrate(&Rk4::new(0.01), 0.0, 1.0);
    // There are fewer devices than that in every machine.
    let on_device = swings.on(Device::Cuda(1000));
    let fault = on_device.fault().cloned().expect("no such device");
    assert_eq!(on_device.device(), Device::Cpu);
    let run = on_device.integrate(&Rk4::new(0.01), 0.0, 1.0);
    assert_eq!((run.device, run.fault, run.motions), (Device::Cpu, Some(fault), expected));
}

/// An engine that stops, or returns arrays of wrong lengths.
struct Broken(bool);

impl KernelEngine for Broken {
    fn run(&self, _kernel: &Kernel, _batch: &KernelBatch<'_>) -> Result<KernelOutcome, DeviceFault> {
        match self.0 {
            true => Err(DeviceFault::Stopped { reason: "out of memory".to_owned() }),
            false => Ok(KernelOutcome { ends: vec![0.0; 3], samples: Vec::new(), work: Vec::new() }),
        }
    }
}

#[test]
fn a_device_that_stops_loses_nothing() {
    let swing = Swing::default().prepare().unwrap().driven(swing::Inputs { push: 0.0 });
    let swings = Ensemble::of_states(swing, [[1.0, 0.0, 0.0], [0.5, 0.1, 0.0]]);
    let expected = swings.integrate(&Rk4::new(0.01), 0.0, 1.0);
    for stops in [true, false] {
        let run = swings.clone().on_engine(Box::new(Broken(stops))).integrate(&Rk4::new(0.01), 0.0, 1.0);
        assert!(matches!(run.fault, Some(DeviceFault::Stopped { .. })), "{:?}", run.fault);
        assert_eq!((run.device, run.motions), (Device::Cpu, expected.clone()));
    }
}
