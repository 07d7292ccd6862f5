//! Recordings as serde sees them.

use std::borrow::Cow;

use serde::de::{Deserialize, DeserializeSeed, Deserializer, Error};
use serde::ser::{Serialize, Serializer};

use crate::Recording;

/// What is written: the names are text in a file, while those of a recording live as long as the program.
#[derive(serde::Serialize, serde::Deserialize)]
#[serde(rename = "Recording")]
struct Stored<'a> {
    names: Vec<Cow<'a, str>>,
    times: Vec<f64>,
    /// A row for each time.
    states: Vec<Vec<f64>>,
    limit: Option<usize>,
    stride: u64,
    seen: u64,
}

impl<const N: usize> Serialize for Recording<N> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let limit = Some(self.limit).filter(|limit| *limit != usize::MAX);
        Stored {
            names: self.names.iter().map(|name| Cow::Borrowed(*name)).collect(),
            times: self.times.clone(),
            states: self.states.iter().map(|state| state.to_vec()).collect(),
            limit,
            stride: self.stride,
            seen: self.seen,
        }
        .serialize(serializer)
    }
}

/// Reads a recording of a state with given names: see [`Recording::stored`].
#[derive(Clone, Copy, Debug)]
pub struct StoredRecording<const N: usize> {
    names: &'static [&'static str],
}

impl<const N: usize> Recording<N> {
    /// What reads a recording from a file: its names have to be these, which is how a file of another system is told.
    /// What was read can be recorded to further.
    ///
    /// ```
    /// use guen_study::Recording;
    /// use serde::de::DeserializeSeed;
    ///
    /// let mut recording = Recording::new(&["x", "v"]);
    /// recording.record(0.5, &[1.0, 2.0]);
    /// let text = serde_json::to_string(&recording)?;
    /// let mut reader = serde_json::Deserializer::from_str(&text);
    /// assert_eq!(Recording::<2>::stored(&["x", "v"]).deserialize(&mut reader)?, recording);
    /// let mut reader = serde_json::Deserializer::from_str(&text);
    /// assert!(Recording::<2>::stored(&["x", "y"]).deserialize(&mut reader).is_err());
    /// # Ok::<(), serde_json::Error>(())
    /// ```
    pub fn stored(names: &'static [&'static str]) -> StoredRecording<N> {
        StoredRecording { names }
    }
}

impl<'de, const N: usize> DeserializeSeed<'de> for StoredRecording<N> {
    type Value = Recording<N>;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Recording<N>, D::Error> {
        let Stored { names, times, states, limit, stride, seen } = Stored::deserialize(deserializer)?;
        if names != self.names || names.len() != N {
            return Err(D::Error::custom(format!("a recording of {names:?}, and not of {:?}", self.names)));
        }
        if times.len() != states.len() || !stride.is_power_of_two() {
            return Err(D::Error::custom("times and states of a recording do not fit"));
        }
        let states: Result<Vec<[f64; N]>, _> = states.into_iter().map(<[f64; N]>::try_from).collect();
        let states =
            states.map_err(|state| D::Error::invalid_length(state.len(), &"an entry for each name"))?;
        let limit = limit.unwrap_or(usize::MAX).max(2);
        Ok(Recording { names: self.names, times, states, limit, stride, seen })
    }
}
