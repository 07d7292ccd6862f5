//! The progress of a long run: one line on the terminal, which comes late, changes seldom and leaves no trace; in a log file a
//! few plain lines.
//!
//! The text of a line and the time of the next one are computed by pure functions; only [`Progress`] reads the clock, the
//! terminal and the environment.

use std::io::{self, IsTerminal, Stderr, Write};
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

/// A run that is over before this shows nothing.
const QUIET: Duration = Duration::from_secs(2);
/// The shortest time between two changes of the line: five a second.
const PAUSE: Duration = Duration::from_millis(200);
/// The number of characters in the bar. With all else the line stays below 80.
const BAR: usize = 30;
/// The room of a line beside its bar.
const BESIDE: usize = 34;
/// The first line in a log file, and the part of the running time between two of them: a day's run has a hundred.
const FIRST_LOGGED: Duration = Duration::from_secs(10);
const LOG_PART: u32 = 10;
/// The part done below which an estimate of the rest would be a guess.
const ESTIMABLE: f64 = 1e-3;

/// A line on standard error that shows how far a run has come and about how long the rest will take.
///
/// - On a terminal it appears after two seconds, changes at most five times a second, has at most 79 characters, or as many as
///   `COLUMNS` says, and is wiped when the value is dropped, also when the run fails or panics.
/// - In a log file, a pipe or a terminal called `dumb` it is a line of plain text, without a bar: the first one after ten seconds, another
///   one whenever the run has taken a tenth longer. A day's run writes a hundred.
/// - Nothing is written by a progress that is [`silent`](Progress::silent), nor by any while the environment variable
///   `GUEN_PROGRESS` is `never`; `GUEN_PROGRESS=plain` asks for plain lines on a terminal, too.
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
    /// Absent if nobody wants to see it.
    painter: Option<Painter<Stderr>>,
}

impl Progress {
    /// Begins to measure a run from one simulated time to another, which may be earlier.
    pub fn new(from: f64, to: f64) -> Self {
        let stderr = io::stderr();
        let variable = |name: &str| std::env::var(name).ok();
        let style = Style::of(
            stderr.is_terminal(),
            variable("TERM").as_deref(),
            variable("GUEN_PROGRESS").as_deref(),
            variable("COLUMNS").as_deref(),
        );
        let painter = style.map(|style| Painter::new(stderr, style));
        Self { from, to, started: Instant::now(), painter }
    }

    /// Shows nothing: for programs whose user has said so.
    ///
    /// ```
    /// use guen_study::Progress;
    ///
    /// let is_quiet = std::env::args().any(|argument| argument == "--quiet");
    /// let progress = Progress::new(0.0, 10.0);
    /// let mut progress = if is_quiet { progress.silent() } else { progress };
    /// progress.at(5.0);
    /// ```
    pub fn silent(self) -> Self {
        Self { painter: None, ..self }
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

/// The form in which progress is shown.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Style {
    /// One line with a bar, painted over and over.
    Bar {
        /// The number of characters in the bar.
        bar: usize,
    },
    /// Lines of a log.
    Log,
}

impl Style {
    /// The style for a terminal or something else, by the environment variables `TERM`, `GUEN_PROGRESS` and `COLUMNS`.
    fn of(
        is_terminal: bool,
        term: Option<&str>,
        wanted: Option<&str>,
        columns: Option<&str>,
    ) -> Option<Self> {
        // A line that fills the last column makes some terminals begin another one.
        let columns = columns.and_then(|text| text.parse::<usize>().ok()).unwrap_or(80).saturating_sub(1);
        match wanted {
            Some("never") => None,
            Some("plain") => Some(Self::Log),
            _ if is_terminal && term != Some("dumb") => {
                Some(Self::Bar { bar: columns.saturating_sub(BESIDE).min(BAR) })
            }
            _ => Some(Self::Log),
        }
    }
}

/// Writes the line whenever it is due, over the one before or below it.
#[derive(Debug)]
struct Painter<W: Write> {
    out: W,
    style: Style,
    /// The running time at which the line is due.
    due: Duration,
    /// The number of characters on the screen.
    width: usize,
}

impl<W: Write> Painter<W> {
    fn new(out: W, style: Style) -> Self {
        let due = if style == Style::Log { FIRST_LOGGED } else { QUIET };
        Self { out, style, due, width: 0 }
    }

    fn at(&mut self, part: f64, elapsed: Duration) {
        if elapsed < self.due {
            return;
        }
        let text = told(part, elapsed);
        match self.style {
            Style::Bar { bar } => {
                self.due = elapsed + PAUSE;
                self.paint(&with_bar(part, bar, &text));
            }
            Style::Log => {
                self.due = elapsed + elapsed / LOG_PART;
                // A courtesy, too.
                let _ = writeln!(self.out, "{text}").and_then(|()| self.out.flush());
            }
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

/// The part done, and the rest.
fn told(part: f64, elapsed: Duration) -> String {
    // Rounded down: a hundred means done.
    let percent = (100.0 * part).floor();
    if part >= ESTIMABLE {
        let left = elapsed.as_secs_f64() * (1.0 - part) / part;
        let left = duration(left);
        let about = if left.starts_with("more") { "" } else { "about " };
        format!("{percent:3} %, {about}{left} left")
    } else {
        format!("{percent:3} %, {} so far", duration(elapsed.as_secs_f64()))
    }
}

/// The text with a bar before it, of so many characters; none where there is no room.
fn with_bar(part: f64, bar: usize, text: &str) -> String {
    if bar == 0 {
        return text.to_owned();
    }
    let full = (part * bar as f64).floor() as usize;
    format!("[{}{}] {text}", "#".repeat(full), "-".repeat(bar - full))
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
        let line = |part, elapsed| with_bar(part, BAR, &told(part, elapsed));
        assert_eq!(line(0.5, seconds(10)), "[###############---------------]  50 %, about 10 s left");
        assert_eq!(line(0.0, seconds(3)), "[------------------------------]   0 %, 3 s so far");
        assert_eq!(line(0.999, seconds(2)), "[#############################-]  99 %, about 1 s left");
        assert_eq!(line(1.0, seconds(2)), "[##############################] 100 %, about 0 s left");
        assert!(line(0.25, seconds(60)).ends_with("about 3 min 00 s left"));
    }

    #[test]
    fn lines_hold_in_the_columns_there_are() {
        for columns in [None, Some(200), Some(80), Some(60), Some(40), Some(36)] {
            let text = columns.map(|columns: usize| columns.to_string());
            let Some(Style::Bar { bar }) = Style::of(true, None, None, text.as_deref()) else { panic!() };
            for part in [0.0, 9e-4, 1e-3, 0.0123, 0.5, 0.999, 1.0] {
                for elapsed in [0, 59, 3_599, 86_399, 900 * 86_400, 86_400_000] {
                    let line = with_bar(part, bar, &told(part, seconds(elapsed)));
                    assert!(line.chars().count() < columns.unwrap_or(80).min(80), "{columns:?}: {line}");
                }
            }
        }
        assert_eq!(Style::of(true, None, None, Some("80")), Some(Style::Bar { bar: BAR }));
        assert_eq!(with_bar(0.5, 0, " 50 %"), " 50 %");
    }

    #[test]
    fn what_is_no_terminal_gets_lines_and_whoever_wants_none_gets_none() {
        let bar = Some(Style::Bar { bar: BAR });
        assert_eq!(Style::of(true, Some("xterm"), None, None), bar);
        assert_eq!(Style::of(true, Some("dumb"), None, None), Some(Style::Log));
        assert_eq!(Style::of(true, None, Some("plain"), None), Some(Style::Log));
        assert_eq!(Style::of(false, Some("xterm"), None, None), Some(Style::Log));
        for is_terminal in [true, false] {
            assert_eq!(Style::of(is_terminal, Some("xterm"), Some("never"), None), None);
        }
        assert!(Progress::new(0.0, 1.0).silent().painter.is_none());
    }

    #[test]
    fn a_log_has_few_plain_lines() {
        let mut log = Vec::new();
        let mut painter = Painter::new(&mut log, Style::Log);
        for second in 0..86_400_u32 {
            painter.at(f64::from(second) / 86_400.0, seconds(second.into()));
        }
        drop(painter);
        let text = String::from_utf8(log).unwrap();
        assert!(text.starts_with("  0 %, 10 s so far\n") && text.ends_with(" left\n"), "{text}");
        assert!(text.chars().all(|c| c == '\n' || !c.is_control()) && !text.contains(['#', '[']));
        assert!((60..110).contains(&text.lines().count()), "{}", text.lines().count());
        // A short run is none of a log's business.
        let mut log = Vec::new();
        Painter::new(&mut log, Style::Log).at(0.5, Duration::from_millis(9_999));
        assert!(log.is_empty());
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
        let mut painter = Painter::new(&mut screen, Style::Bar { bar: BAR });
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
        let mut painter = Painter::new(&mut screen, Style::Bar { bar: BAR });
        painter.paint("longer");
        painter.paint("short");
        drop(painter);
        assert_eq!(screen, b"\rlonger\rshort \r     \r");
    }

    #[test]
    fn a_short_run_writes_nothing() {
        let mut screen = Vec::new();
        let mut painter = Painter::new(&mut screen, Style::Bar { bar: BAR });
        painter.at(1.0, Duration::from_millis(1999));
        drop(painter);
        assert!(screen.is_empty());
    }
}
