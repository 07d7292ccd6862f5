//! A reference case as numbers: read from the files in `tests/data`, decimal strings rounded once to `f64`.

use serde_json::Value;

/// One trajectory of a system.
#[derive(Clone)]
pub struct Case {
    pub label: String,
    constants: Value,
    coordinates: Value,
    quasi_velocities: Value,
    pub qdot: Vec<f64>,
    pub eta_dot: Vec<f64>,
    pub lambda: Vec<f64>,
    pub times: Vec<f64>,
    pub states: Vec<Vec<f64>>,
    pub energy: Vec<f64>,
}

/// The cases of a file.
pub fn read(text: &str) -> Vec<Case> {
    let file: Value = serde_json::from_str(text).unwrap();
    let coordinates = names(&file["coordinates"], |name| name.clone());
    let etas = names(&file["quasi_velocities"], |entry| entry["name"].clone());
    let cases = file["cases"].as_array().unwrap();
    assert!(cases.len() >= 3, "every file has three cases at least");
    cases
        .iter()
        .map(|case| {
            let rates = &case["at_t0"];
            let read = Case {
                label: case["label"].as_str().unwrap().to_owned(),
                constants: case["parameters"].clone(),
                coordinates: case["coordinates"].clone(),
                quasi_velocities: case["quasi_velocities"].clone(),
                qdot: coordinates.iter().map(|name| number(&rates["qdot"][name])).collect(),
                eta_dot: etas.iter().map(|name| number(&rates["eta_dot"][name])).collect(),
                lambda: numbers(&rates["lambda"]),
                times: numbers(&case["times"]),
                states: case["states"].as_array().unwrap().iter().map(numbers).collect(),
                energy: numbers(&case["energy"]),
            };
            assert_eq!(read.times.len(), read.states.len());
            assert_eq!(read.times.len(), read.energy.len());
            assert_eq!(read.energy[0], number(&rates["energy"]));
            read
        })
        .collect()
}

impl Case {
    /// A physical constant by name.
    pub fn constant(&self, name: &str) -> f64 {
        number(&self.constants[name])
    }

    /// A coordinate or quasi-velocity of the initial state by name.
    pub fn initial(&self, name: &str) -> f64 {
        let value = &self.coordinates[name];
        number(if value.is_null() { &self.quasi_velocities[name] } else { value })
    }
}

fn names(list: &Value, name: impl Fn(&Value) -> Value) -> Vec<String> {
    list.as_array().unwrap().iter().map(|entry| name(entry).as_str().unwrap().to_owned()).collect()
}

fn numbers(list: &Value) -> Vec<f64> {
    list.as_array().unwrap().iter().map(number).collect()
}

fn number(value: &Value) -> f64 {
    value.as_str().unwrap_or_else(|| panic!("{value} is not a decimal string")).parse().unwrap()
}
