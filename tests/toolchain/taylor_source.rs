//! Taylor's method in the text of C (`provide source, taylor;`): its coefficients, steps, samples and statuses have the bits of Rust's.

use std::fmt::Write as _;
use std::path::PathBuf;

use guen::steppers::{Cause, Guard, Integration, Taylor};
use guen::{TaylorSeries, mechanical_system};

use crate::source::{WORDS, answers, bits, compile, draws};

mechanical_system! {
    /// A sled with its blade behind the centre, on an inclined plane.
    pub system Sled {
        constants   { m > 0 = 1, j > 0 = 0.3, b = 0.2, pull = 1 }
        coordinates { x, y, turn }
        constraints { blade: dot(y)*cos(turn) - dot(x)*sin(turn) = 0; }
        parameters  { v = dot(x)*cos(turn) + dot(y)*sin(turn); w = dot(turn); }
        kinetic_energy = m/2*((dot(x) - b*sin(turn)*w)^2 + (dot(y) + b*cos(turn)*w)^2) + j/2*w^2;
        potential_energy = -m*pull*x;
        provide source, taylor;
    }
}

mechanical_system! {
    /// Sines, roots and quotients, inputs, time, a force in a narrow place, a state that is not mechanical.
    pub system Machine {
        constants   { m > 0 = 1, k > 0 = 3, l > 0 = 1, rate = 2, narrow = 4 }
        inputs      { push, turn }
        coordinates { q, r }
        parameters  { v = dot(q); w = dot(r); }
        kinetic_energy = m/2*(v^2 + (1 + q^2)*w^2);
        potential_energy = k/2*(sqrt(l^2 + r^2) - l)^2 + 1/(2 + cos(q)) - cos(r)/4;
        states      { dot(heat) = v^2/(1 + w^2) - heat; }
        forces      {
            push*sin(rate*t) - v/5 along v;
            turn/(1 + (narrow*(q - 1))^2)^4 - w*w/3 + (1 + r^2)/(2 + sin(q)) along w;
        }
        provide source, taylor;
        scene Alone { fix k = 2; track r, w; provide source, taylor; }
    }
}

mechanical_system! {
    /// A particle that a force throws to infinity in a finite time, or whose other force is a number for a while.
    pub system Thrown {
        constants   { m > 0 = 1, k = 1, last = 1 }
        coordinates { x }
        parameters  { v = dot(x); }
        kinetic_energy = m*v^2/2;
        potential_energy = -k*x^4/4;
        forces      { sqrt(last - t) along v; }
        provide source, taylor;
    }
}

mechanical_system! {
    /// A particle in free flight: a polynomial, of which all higher coefficients vanish.
    pub system Flight {
        constants   { g = 9.81 }
        coordinates { x, z }
        parameters  { u = dot(x); w = dot(z); }
        kinetic_energy = (u^2 + w^2)/2;
        potential_energy = g*z;
        provide source, taylor;
    }
}

/// The program that prints the bits of the coefficients at the start and of a run, for each line that it reads.
const PROGRAM: &str = r#"
#define SYSTEM(NAME) \
    if (!strcmp(argument[1], #NAME)) { \
        double c[NAME##_CONSTANTS + 1], k[NAME##_PREPARED + 1], s[NAME##_STATES], u[NAME##_INPUTS + 1], t, settings[6]; \
        while (read_all(c, NAME##_CONSTANTS) && read_all(&t, 1) && read_all(s, NAME##_STATES) && read_all(u, NAME##_INPUTS) && read_all(settings, 6)) { \
            double at = t, times[5], samples[5 * NAME##_STATES], series[33][NAME##_STATES]; \
            guen_adaptive method = { settings[0], settings[1], 0.0, (unsigned long long)settings[3], 0, 0, 0 }; \
            int i, order = (int)settings[2], status; \
            if (NAME##_prepare(c, k)) \
                return 1; \
            i = order >= 2 && order <= 32 ? order : 20; \
            NAME##_series(c, k, t, s, u, 0.25, i, series); \
            print_all(&series[0][0], (i + 1) * NAME##_STATES); \
            for (i = 0; i < 5; ++i) \
                times[i] = i == 4 ? t + settings[4] : t + settings[4] * (i * i) / 17.0; \
            for (i = 0; i < 5 * NAME##_STATES; ++i) \
                samples[i] = 0.0; \
            status = NAME##_taylor(c, k, u, &at, s, t + settings[4], &method, order, (int)settings[5], times, samples); \
            printf("%d %llu %llu %llu ", status, method.evaluations, method.accepted, method.rejected); \
            print_all(&at, 1); \
            print_all(s, NAME##_STATES); \
            print_all(samples, 5 * NAME##_STATES); \
            printf("\n"); \
        } \
    }

int main(int count, char **argument)
{
    if (count < 2)
        return 1;
    SYSTEM(sled)
    SYSTEM(machine)
    SYSTEM(machine_alone)
    SYSTEM(thrown)
    SYSTEM(flight)
    return 0;
}
"#;

fn compiled() -> PathBuf {
    let sources = [sled::SOURCE, machine::SOURCE, machine::alone::SOURCE, thrown::SOURCE, flight::SOURCE];
    let text: String = sources.iter().map(|source| source.to_string()).collect();
    compile(&(text + WORDS + PROGRAM), "series")
}

/// The coefficients and the run of Rust, with the status of the run and the steps that were refused. Settings are tolerances, the order,
/// the number of steps, the span and the number of samples.
fn computed<const N: usize>(
    system: &impl TaylorSeries<f64, N>,
    t: f64,
    s: &[f64; N],
    &[rtol, atol, order, most, span, count]: &[f64; 6],
) -> (String, i32, u64) {
    let known = if (2.0..=32.0).contains(&order) { order as usize } else { 20 };
    let mut series = [[0.0; N]; 33];
    system.series(t, s, 0.25, known, &mut series);
    let mut text = bits(series[..=known].as_flattened());

    let method = Taylor::new(rtol, atol).with_max_steps(most as u64);
    let method = if order == 0.0 { method } else { method.with_order(order as u32) };
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
                cause => panic!("{cause:?}"),
            };
            (status, error.time, error.state, error.statistics)
        }
    };
    let _ = write!(text, "{status} {} {} {} ", work.evaluations, work.accepted, work.rejected);
    text += &(bits(&[time]) + &bits(&state) + &bits(samples.as_flattened()));
    (text.trim().to_owned(), status, work.rejected)
}

/// Settings of all kinds of runs: forwards and backwards, with few samples and many, orders given and chosen.
fn settings(round: usize, draw: &mut impl FnMut() -> f64) -> [f64; 6] {
    let tolerance = 10_f64.powf(-8.0 + 6.0 * draw());
    let order = if round.is_multiple_of(3) { (2 + round / 3 % 31) as f64 } else { 0.0 };
    let span = [0.9, -0.4, 2.5, 0.0, 6.0][round % 5] * (1.0 + draw() / 2.0);
    let most = if round.is_multiple_of(7) { 3.0 } else { 2000.0 };
    let count = (round % 6) as f64;
    match round % 40 {
        11 => [1e-30, 1e-300, order, most, 0.9, 5.0],
        21 => [tolerance, 0.0, order, most, 0.9, 5.0],
        31 => [tolerance, tolerance, 33.0, most, 0.9, 5.0],
        37 => [tolerance, tolerance, 1.0, most, 0.9, 5.0],
        // Tolerances of a few roundings: rates that differ by no more are those of the series.
        13 | 27 => [10_f64.powf(-15.5 + 1.5 * draw()), 1e-300, order, most, 0.9, 5.0],
        // Powers of ten, between whose neighbours orders change.
        19 => [10_f64.powi(-((round / 40) as i32 % 16)), 1e-300, 0.0, most, 2.0, 5.0],
        _ => [tolerance, tolerance * 10.0, order, most, span, count],
    }
}

#[test]
fn taylors_method_has_the_bits_of_rust() {
    let (program, mut draw) = (compiled(), draws());
    let (mut statuses, mut refused) = ([0_u32; 5], 0);
    let mut compare = |name: &str, lines: Vec<(Vec<f64>, (String, i32, u64))>| {
        let (given, expected): (Vec<_>, Vec<_>) = lines.into_iter().unzip();
        let found = answers(&program, name, &given);
        assert_eq!(found.len(), expected.len(), "{name}");
        for ((found, (expected, status, rejected)), given) in found.iter().zip(&expected).zip(&given) {
            assert_eq!(found, expected, "{name} {given:?}");
            statuses[*status as usize] += 1;
            refused += rejected;
        }
    };

    let mut lines = Vec::new();
    for round in 0..300 {
        let settings = settings(round, &mut draw);
        let system = Sled { m: 1.5 + draw(), j: 1.1 + draw(), b: draw(), pull: draw() };
        let (s, t): ([f64; 5], f64) = (std::array::from_fn(|_| 2.0 * draw()), draw());
        let given = [&[system.m, system.j, system.b, system.pull, t], &s[..], &settings].concat();
        lines.push((given, computed(&system.prepare().unwrap(), t, &s, &settings)));
    }
    compare("sled", lines);

    let mut lines = Vec::new();
    for round in 0..800 {
        let mut settings = settings(round, &mut draw);
        // A narrow force leaves no trace in the coefficients: steps are refused there. A quick one makes coefficients overflow.
        let narrow = [3.0, 12.0, 40.0, 400.0][round % 4];
        let rate = if round.is_multiple_of(11) { 1e12 } else { 3.0 * draw() };
        let system = Machine { m: 1.5 + draw(), k: 2.0 + draw(), l: 1.2 + draw(), rate, narrow };
        let far = [1.0, 1e3, 1e180, f64::NAN][if round % 9 == 0 { round / 9 % 4 } else { 0 }];
        let mut s = [2.0 * draw(), draw(), far * draw(), draw(), draw()];
        let mut inputs = machine::Inputs { push: 3.0 * draw(), turn: draw() };
        // Through the narrow force in one step, which would be the last.
        if round % 10 == 4 {
            settings = [1e-5, 1e-5, 0.0, 2000.0, 0.4, 5.0];
            (s[2], inputs.turn) = (3.0 + draw(), 300.0);
            s[0] = 1.0 - 0.18 * s[2] + draw() / 20.0;
        }
        let t = draw();
        let constants = [system.m, system.k, system.l, system.rate, system.narrow, t];
        let given = [&constants, &s[..], &[inputs.push, inputs.turn], &settings].concat();
        lines.push((given, computed(&system.prepare().unwrap().driven(inputs), t, &s, &settings)));
    }
    compare("machine", lines);

    let mut lines = Vec::new();
    for round in 0..100 {
        let settings = settings(round, &mut draw);
        let system = machine::Alone { l: 1.2 + draw(), ..Default::default() };
        let (t, inputs) = (draw(), machine::alone::Inputs { push: draw(), turn: draw() });
        let prepared = system.prepare().unwrap().driven(inputs);
        let s: [f64; 4] = std::array::from_fn(|_| draw());
        let constants = [system.m, system.l, system.rate, system.narrow, t];
        let given = [&constants, &s[..], &[inputs.push, inputs.turn], &settings].concat();
        lines.push((given, computed(&prepared, t, &s, &settings)));
    }
    compare("machine_alone", lines);

    let mut lines = Vec::new();
    for round in 0..300 {
        let [rtol, atol, order, most, _, count] = settings(round, &mut draw);
        let settings = [rtol, atol, order, most, [4.0, -5.0, 1e3][round % 3], count];
        let last = if round.is_multiple_of(2) { 1.1 } else { 1e3 };
        let system = Thrown { m: 1.5 + draw(), k: 2.0 + draw(), last };
        let (s, t) = ([draw(), draw()], draw());
        let given = [&[system.m, system.k, system.last, t], &s[..], &settings].concat();
        lines.push((given, computed(&system.prepare().unwrap(), t, &s, &settings)));
    }
    compare("thrown", lines);

    let mut lines = Vec::new();
    for round in 0..60 {
        let settings = settings(round, &mut draw);
        let system = Flight { g: 9.0 + draw() };
        let (s, t): ([f64; 4], f64) = (std::array::from_fn(|_| draw()), draw());
        let given = [&[system.g, t], &s[..], &settings].concat();
        lines.push((given, computed(&system.prepare().unwrap(), t, &s, &settings)));
    }
    compare("flight", lines);

    // Every end that a run can come to is among them, and steps whose rates are not those of the series.
    println!("runs by status: {statuses:?}, steps refused: {refused}");
    assert!(statuses.iter().all(|count| *count > 20) && refused > 100, "{statuses:?} {refused}");
}

#[test]
fn only_systems_with_a_series_have_the_method() {
    for (source, has) in [(sled::SOURCE, true), (crate::source::hoop::SOURCE, false)] {
        assert_eq!((source.series, source.to_string().contains("_taylor(")), (has, has), "{}", source.name);
    }
}
