//! Times declared systems on request, a line for each line that is read: the partner of `workshop/benches/peers/compare.py`.
//!
//! ```text
//! list                            what there is: name, size, operations, constants
//! conditions                      how this program was compiled, and for what
//! states SYSTEM FILE              writes the states in binary
//! rates SYSTEM PROGRAM INDEX      the rates at one of them
//! time SYSTEM PROGRAM MODE        nanoseconds; MODE is throughput or latency
//! ```
//!
//! The program is `default`, or `glibc` for the sines and cosines of the platform's C library.

use std::collections::BTreeMap;
use std::error;
use std::io::{self, BufRead, Write};

use guen::System;
use guen_benchmarks::platform::{OnPlatform, Platform};
use guen_benchmarks::timing::{Batch, Latency, STATES, Throughput, conditions};
use guen_benchmarks::{Random, Subject, Visitor, visit_all};

/// One request and its answer.
struct Request<'a> {
    words: Vec<&'a str>,
    answer: String,
    batches: &'a mut BTreeMap<String, Batch>,
}

impl Visitor for Request<'_> {
    fn visit<S: Subject<N>, const N: usize>(&mut self, _: S) {
        if self.words[0] == "list" {
            let constants = S::CONSTANTS.iter().map(|(name, (num, den))| format!(" {name}={num}/{den}"));
            let constants: String = constants.collect();
            let gap = if self.answer.is_empty() { "" } else { ";" };
            self.answer += &format!("{gap}{} {N} {}{constants}", S::NAME, S::COST.total());
        } else if self.words.get(1) == Some(&S::NAME) {
            let mut random = Random::new(1);
            let states: Vec<[f64; N]> = (0..STATES).map(|_| S::state(&mut random)).collect();
            match self.words.get(2) {
                Some(&"default") => self.run(S::declared::<f64>(), &states),
                Some(&"glibc") => self.run(OnPlatform(S::declared::<Platform>()), &states),
                Some(path) => {
                    let bytes: Vec<u8> = states.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
                    let written = guen_study::replace_file(path, |file| file.write_all(&bytes));
                    self.answer = written.map_or_else(|error| error.to_string(), |()| "written".to_owned());
                }
                None => {}
            }
        }
    }
}

impl Request<'_> {
    fn run<const N: usize>(&mut self, system: impl System<f64, N>, states: &[[f64; N]]) {
        let key = self.words.join(" ");
        let mut timed = |program: &mut dyn guen_benchmarks::timing::Timed| {
            let batch = self.batches.entry(key.clone()).or_insert_with(|| Batch::of(program));
            format!("{:.6}", batch.nanoseconds(program))
        };
        self.answer = match (self.words[0], self.words.get(3)) {
            ("rates", Some(index)) => {
                let rates = system.rhs(0.0, &states[index.parse::<usize>().unwrap_or(0)]);
                rates.map(|rate| format!("{rate:e}")).join(" ")
            }
            ("time", Some(&"latency")) => timed(&mut Latency { system, start: states[0] }),
            ("time", _) => timed(&mut Throughput { system, states }),
            _ => String::new(),
        };
    }
}

fn main() -> Result<(), Box<dyn error::Error>> {
    let mut batches = BTreeMap::new();
    for line in io::stdin().lock().lines() {
        let line = line?;
        let words: Vec<&str> = line.split_whitespace().collect();
        let answer = match words.first() {
            None => continue,
            Some(&"conditions") => conditions().trim_end().replace('\n', ";"),
            Some(_) => {
                let mut request = Request { words, answer: String::new(), batches: &mut batches };
                visit_all(&mut request);
                request.answer
            }
        };
        println!("{answer}");
        io::stdout().flush()?;
    }
    Ok(())
}
