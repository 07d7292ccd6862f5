//! The progress of a long run: one line on the terminal, which comes late, changes seldom and leaves no trace.
//!
//! What the line says and when it is due are functions of plain numbers; only [`Progress`] knows clock and terminal.

use std::io::{self, IsTerminal, Stderr, Write};
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

/// A run that is over before this shows nothing.
const QUIET: Duration = Duration::from_secs(2);
/// The shortest time between two changes of the line: five a second.
const PAUSE: Duration = Duration::from_millis(200);
/// The number of characters in the bar. With all else the line stays below 80.
const BAR: usize = 30;
/// The part done below which an estimate of the rest would be a guess.
const ESTIMABLE: f64 = 1e-3;

/// A line on standard error that shows how far a run has come and about how long the rest will take.
///
/// - Only if standard error is a terminal; otherwise nothing is ever written and no clock is read.
/// - It appears after two seconds, changes at most five times a second, and is wiped when the value is dropped, also
///   when the run fails or panics.
/// - The part done is that of the simulated time; the rest is estimated as if it went on at the mean pace so far.
///
/// ```
/// use guen_runtime::{from_fn, steppers::Rk4};
/// use guen_study::Progress;
/// use std::ops::ControlFlow;
///
/// let decay = from_fn(|_t: f64, &[x]: &[f64; 1]| [-x]);
/// let mut progress = Progress::new(0.0, 5.0);
/// Rk4::new(1e-3)
///     .integrate(&decay, 0.0, &[1.0], 5.0, |t, _x| {
///         progress.at(t);
///         ControlFlow::Continue(())
///     })
///     .unwrap();
/// progress.finish();
/// ```
#[derive(Debug)]
pub struct Progress {
    from: f64,
    to: f64,
    started: Instant,
    /// Absent if standard error is no terminal.
    painter: Option<Painter<Stderr>>,
}

impl Progress {
    /// Begins to measure a run from one simulated time to another, which may be earlier.
    pub fn new(from: f64, to: f64) -> Self {
        let stderr = io::stderr();
        let painter = stderr.is_terminal().then(|| Painter::new(stderr));
        Self { from, to, started: Instant::now(), painter }
    }

    /// Says that the run has come to the simulated time `t`.
    pub fn at(&mut self, t: f64) {
        if let Some(painter) = &mut self.painter {
            painter.at(part(self.from, self.to, t), self.started.elapsed());
        }
    }

    /// The observer that passes everything on to another one and shows progress besides.
    ///
    /// ```
    /// use guen_runtime::{from_fn, steppers::Rk4};
    /// use guen_study::{Progress, Recording};
    ///
    /// let decay = from_fn(|_t: f64, &[x]: &[f64; 1]| [-x]);
    /// let mut recording = Recording::new(&["x"]);
    /// let mut progress = Progress::new(0.0, 5.0);
    /// let observer = progress.around(recording.observe());
    /// Rk4::new(1e-2).integrate(&decay, 0.0, &[1.0], 5.0, observer).unwrap();
    /// assert_eq!(recording.len(), 500);
    /// ```
    pub fn around<O, const N: usize>(
        &mut self,
        mut observer: O,
    ) -> impl FnMut(f64, &[f64; N]) -> ControlFlow<()>
    where
        O: FnMut(f64, &[f64; N]) -> ControlFlow<()>,
    {
        move |t, state| {
            self.at(t);
            observer(t, state)
        }
    }

    /// Wipes the line, as dropping does.
    pub fn finish(self) {}
}

/// Writes the line whenever it is due, over the one before.
#[derive(Debug)]
struct Painter<W: Write> {
    out: W,
    /// The running time at which the line is due.
    due: Duration,
    /// The number of characters on the screen.
    width: usize,
}

impl<W: Write> Painter<W> {
    fn new(out: W) -> Self {
        Self { out, due: QUIET, width: 0 }
    }

    fn at(&mut self, part: f64, elapsed: Duration) {
        if elapsed >= self.due {
            self.due = elapsed + PAUSE;
            self.paint(&line(part, elapsed));
        }
    }

    /// Carriage return and blanks, for every terminal knows them. The line is a courtesy: if it cannot be written,
    /// the run goes on.
    fn paint(&mut self, text: &str) {
        let width = text.chars().count();
        let wipe = self.width.saturating_sub(width);
        let _ = write!(self.out, "\r{text}{:wipe$}", "").and_then(|()| self.out.flush());
        self.width = width;
    }
}

impl<W: Write> Drop for Painter<W> {
    fn drop(&mut self) {
        if self.width > 0 {
            self.paint("");
            let _ = write!(self.out, "\r").and_then(|()| self.out.flush());
        }
    }
}

/// The part of the way from one time to another that is behind `t`, between zero and one.
fn part(from: f64, to: f64, t: f64) -> f64 {
    let part = (t - from) / (to - from);
    if part.is_nan() { 0.0 } else { part.clamp(0.0, 1.0) }
}

/// Returns the text of the line.
fn line(part: f64, elapsed: Duration) -> String {
    let full = (part * BAR as f64).floor() as usize;
    // RunningError down: a hundred means done.
    let percent = (100.0 * part).floor();
    let bar = format!("[{}{}] {percent:3} %", "#".repeat(full), "-".repeat(BAR - full));
    if part >= ESTIMABLE {
        let left = elapsed.as_secs_f64() * (1.0 - part) / part;
        format!("{bar}, about {} left", duration(left))
    } else {
        format!("{bar}, {} so far", duration(elapsed.as_secs_f64()))
    }
}

/// A duration in the two largest units that matter, rounded up to full seconds.
fn duration(seconds: f64) -> String {
    const MINUTE: u64 = 60;
    const HOUR: u64 = 60 * MINUTE;
    const DAY: u64 = 24 * HOUR;
    // A cast from `f64` saturates, so the longest estimate is no special case.
    match seconds.ceil() as u64 {
        s if s < MINUTE => format!("{s} s"),
        s if s < HOUR => format!("{} min {:02} s", s / MINUTE, s % MINUTE),
        s if s < DAY => format!("{} h {:02} min", s / HOUR, s % HOUR / MINUTE),
        s if s < 1000 * DAY => format!("{} d {} h", s / DAY, s % DAY / HOUR),
        _ => "more than 1000 d".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const fn seconds(s: u64) -> Duration {
        Duration::from_secs(s)
    }

    #[test]
    fn parts_in_both_directions_and_without_a_way() {
        assert_eq!(part(0.0, 10.0, 2.5), 0.25);
        assert_eq!(part(10.0, 0.0, 2.5), 0.75);
        assert_eq!(part(0.0, 1.0, 1.5), 1.0);
        assert_eq!(part(0.0, 1.0, -0.5), 0.0);
        assert_eq!(part(1.0, 1.0, 1.0), 0.0);
        assert_eq!(part(0.0, 1.0, f64::NAN), 0.0);
    }

    #[test]
    fn the_line_says_part_and_rest() {
        assert_eq!(line(0.5, seconds(10)), "[###############---------------]  50 %, about 10 s left");
        assert_eq!(line(0.0, seconds(3)), "[------------------------------]   0 %, 3 s so far");
        assert_eq!(line(0.999, seconds(2)), "[#############################-]  99 %, about 1 s left");
        assert_eq!(line(1.0, seconds(2)), "[##############################] 100 %, about 0 s left");
        assert!(line(0.25, seconds(60)).ends_with("about 3 min 00 s left"));
        assert!(line(0.001, seconds(1_000_000)).len() < 80);
    }

    #[test]
    fn durations_in_two_units() {
        for (seconds, text) in [
            (0.0, "0 s"),
            (0.2, "1 s"),
            (59.1, "1 min 00 s"),
            (185.0, "3 min 05 s"),
            (7800.0, "2 h 10 min"),
            (200_000.0, "2 d 7 h"),
            (1e300, "more than 1000 d"),
            (f64::INFINITY, "more than 1000 d"),
        ] {
            assert_eq!(duration(seconds), text);
        }
    }

    #[test]
    fn the_line_comes_late_changes_seldom_and_goes() {
        let mut screen = Vec::new();
        let mut painter = Painter::new(&mut screen);
        for millisecond in 0..2000 {
            painter.at(0.1, Duration::from_millis(millisecond));
        }
        assert_eq!(painter.width, 0, "quiet for two seconds");
        for millisecond in 2000..4000 {
            painter.at(0.1, Duration::from_millis(millisecond));
        }
        drop(painter);
        let text = String::from_utf8(screen).unwrap();
        assert_eq!(text.matches('#').count(), 3 * 10, "five lines a second");
        let wiped: Vec<&str> = text.rsplit('\r').take(2).collect();
        assert_eq!(wiped[0], "");
        assert!(wiped[1].len() > 40 && wiped[1].chars().all(|c| c == ' '));
    }

    #[test]
    fn a_shorter_line_covers_a_longer_one() {
        let mut screen = Vec::new();
        let mut painter = Painter::new(&mut screen);
        painter.paint("longer");
        painter.paint("short");
        drop(painter);
        assert_eq!(screen, b"\rlonger\rshort \r     \r");
    }

    #[test]
    fn a_short_run_writes_nothing() {
        let mut screen = Vec::new();
        let mut painter = Painter::new(&mut screen);
        painter.at(1.0, Duration::from_millis(1999));
        drop(painter);
        assert!(screen.is_empty());
    }
}
