//! The reference trajectories of `tests/data`: constants, the state at the beginning and at the end, 25 digits rounded to
//! doubles.

use std::error::Error;

use serde_json::Value;

/// One trajectory of a system of `N` equations.
pub struct Case<const N: usize> {
    pub label: String,
    constants: Value,
    pub start: [f64; N],
    /// From zero, in seconds.
    pub span: f64,
    pub end: [f64; N],
}

/// The trajectories of a file, each until the last of its times that is not beyond `longest`.
pub fn read<const N: usize>(text: &str, longest: f64) -> Result<Vec<Case<N>>, Box<dyn Error>> {
    let file: Value = serde_json::from_str(text)?;
    let cases = file["cases"].as_array().ok_or("no cases")?;
    cases.iter().map(|case| one(case, longest)).collect()
}

fn one<const N: usize>(case: &Value, longest: f64) -> Result<Case<N>, Box<dyn Error>> {
    let times = numbers(&case["times"])?;
    let at =
        times.iter().rposition(|time| *time <= longest).filter(|at| *at > 0).ok_or("no time to end at")?;
    Ok(Case {
        label: case["label"].as_str().ok_or("no label")?.to_owned(),
        constants: case["parameters"].clone(),
        start: numbers(&case["states"][0])?.try_into().map_err(|_| "a state of another size")?,
        span: times[at],
        end: numbers(&case["states"][at])?.try_into().map_err(|_| "a state of another size")?,
    })
}

impl<const N: usize> Case<N> {
    /// A constant by its name in the file.
    pub fn constant(&self, name: &str) -> Result<f64, Box<dyn Error>> {
        number(&self.constants[name]).map_err(|error| format!("the constant {name}: {error}").into())
    }

    /// The largest difference between the end and a state that begins with the entries of this system.
    pub fn error(&self, state: &[f64]) -> f64 {
        self.end.iter().zip(state).fold(0.0, |most, (x, y)| f64::max(most, (x - y).abs()))
    }
}

fn numbers(list: &Value) -> Result<Vec<f64>, Box<dyn Error>> {
    list.as_array().ok_or("no list")?.iter().map(number).collect()
}

fn number(value: &Value) -> Result<f64, Box<dyn Error>> {
    Ok(value.as_str().ok_or("no number as text")?.parse()?)
}
