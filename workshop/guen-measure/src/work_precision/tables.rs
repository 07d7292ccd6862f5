//! What was found, as text.

use guen_study::significant;

use super::methods::METHODS;
use super::systems::Problem;
use super::timing::{Spread, Times};

/// The cheapest setting of a method that holds an accuracy.
pub struct Choice {
    pub method: &'static str,
    /// Index of the accuracy.
    pub accuracy: usize,
    /// The step or the tolerance.
    pub value: f64,
    pub evaluations: u64,
    pub error: f64,
}

/// What was measured on one problem; times in the order of the choices.
pub struct Findings {
    pub problem: &'static str,
    pub case: String,
    pub span: f64,
    pub choices: Vec<Choice>,
    pub times: Times,
}

impl Findings {
    fn choice(&self, method: &str, accuracy: usize) -> Option<usize> {
        self.choices.iter().position(|choice| choice.method == method && choice.accuracy == accuracy)
    }

    /// The choice with the least median among those for an accuracy.
    fn fastest(&self, accuracy: usize) -> Option<usize> {
        let choices = (0..self.choices.len()).filter(|at| self.choices[*at].accuracy == accuracy);
        choices.min_by(|a, b| self.median(*a).total_cmp(&self.median(*b)))
    }

    fn median(&self, choice: usize) -> f64 {
        self.times.of(choice).map_or(f64::INFINITY, |time| time.median)
    }

    /// Prints for each accuracy all methods, and what their times are of DOP853's and of RK4's.
    pub fn print(&self, accuracies: &[f64]) {
        println!(
            "{}, {}, over {} s; with an apostrophe: the carried form; with two: that in `Fused`\n",
            self.problem, self.case, self.span
        );
        for (accuracy, limit) in accuracies.iter().enumerate() {
            println!(
                "error at most {limit:e}\n{:<8} {:>10} {:>11} {:>11} {:>9} {:>10}",
                "method", "setting", "evaluations", "us", "error", "of DOP853"
            );
            let base = self.choice("DOP853", accuracy);
            for at in METHODS.into_iter().filter_map(|method| self.choice(method, accuracy)) {
                let Choice { method, value, evaluations, error, .. } = &self.choices[at];
                let ratio = base.and_then(|base| self.times.ratio(at, base)).map_or(String::new(), shown);
                println!(
                    "{method:<8} {:>10} {evaluations:>11} {:>11.2} {error:>9.1e}       {ratio}",
                    significant(*value, 3),
                    1e6 * self.median(at),
                );
            }
            for method in METHODS {
                let carried = self.choice(&format!("{method}'"), accuracy);
                if let (Some(plain), Some(carried)) = (self.choice(method, accuracy), carried) {
                    let ratio = self.times.ratio(carried, plain).map_or(String::new(), shown);
                    println!("carried, of the time of {method} as it is: {ratio}");
                }
            }
            if let Some((fastest, ratio)) = self.of_rk4(accuracy) {
                println!("the fastest, {fastest}, of RK4's time: {}", shown(ratio));
            }
            println!();
        }
    }

    /// The fastest method for an accuracy, and the ratio of its time to RK4's.
    fn of_rk4(&self, accuracy: usize) -> Option<(&'static str, Spread)> {
        let (fastest, plain) = (self.fastest(accuracy)?, self.choice("RK4", accuracy)?);
        Some((self.choices[fastest].method, self.times.ratio(fastest, plain)?))
    }
}

/// A ratio with its quartiles.
fn shown(ratio: Spread) -> String {
    format!("{:.2} [{:.2}, {:.2}]", ratio.median, ratio.quartiles.0, ratio.quartiles.1)
}

/// All problems together, as tables for a page: microseconds and evaluations, then how much less than RK4's time.
pub fn summary(all: &[Findings], accuracies: &[f64]) {
    let head: Vec<String> = accuracies.iter().map(|accuracy| format!("{accuracy:e}")).collect();
    let rule = "| --- ".repeat(1 + accuracies.len());
    for findings in all {
        println!(
            "{}, {}, {} s: microseconds (evaluations)\n",
            findings.problem, findings.case, findings.span
        );
        println!("| method | {} |\n{rule}|", head.join(" | "));
        for method in METHODS {
            let cells = (0..accuracies.len()).map(|accuracy| match findings.choice(method, accuracy) {
                Some(at) => {
                    let microseconds = significant(1e6 * findings.median(at), 3);
                    format!("{microseconds} ({})", thousands(findings.choices[at].evaluations))
                }
                None => String::new(),
            });
            println!("| {method} | {} |", cells.collect::<Vec<_>>().join(" | "));
        }
        println!();
    }
    println!("The fastest, of RK4's time\n\n| system | {} |\n{rule}|", head.join(" | "));
    for findings in all {
        let cells = (0..accuracies.len()).map(|accuracy| match findings.of_rk4(accuracy) {
            Some((method, ratio)) => format!("{method} {}", shown(ratio)),
            None => {
                findings.fastest(accuracy).map_or(String::new(), |at| findings.choices[at].method.to_owned())
            }
        });
        println!("| {}, {} | {} |", findings.problem, findings.case, cells.collect::<Vec<_>>().join(" | "));
    }
    println!();
}

/// Every setting of a method that was tried.
pub fn print_tried(problem: &Problem, method: &str, tried: impl Iterator<Item = (f64, u64, f64)>) {
    println!("{}, {}: {method}, every setting that was tried", problem.system, problem.case);
    println!("{:>12} {:>11} {:>9}", "setting", "evaluations", "error");
    for (value, evaluations, error) in tried {
        println!("{:>12} {evaluations:>11} {error:>9.1e}", significant(value, 4));
    }
    println!();
}

/// A number with its thousands apart.
fn thousands(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (k, digit) in digits.chars().enumerate() {
        if k > 0 && (digits.len() - k).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}
