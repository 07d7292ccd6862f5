//! Recordings as serde sees them.

use std::borrow::Cow;
use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use serde::de::{Deserialize, DeserializeSeed, Deserializer, Error};
use serde::ser::{Error as _, Serialize, Serializer};

use crate::Recording;
use crate::error::{StudyError, from_path};
use crate::exact::Exact;
use crate::file::replace_file;

/// A recording in a file: the names are text there, while those of a recording live as long as the program.
#[derive(serde::Serialize, serde::Deserialize)]
#[serde(rename = "Recording", deny_unknown_fields)]
struct Stored<'a> {
    names: Vec<Cow<'a, str>>,
    times: Vec<Exact>,
    /// A row for each time.
    states: Vec<Vec<Exact>>,
    limit: Option<usize>,
    stride: u64,
    seen: u64,
}

impl<const N: usize> Serialize for Recording<N> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if let Some(message) = disorder(&self.times) {
            return Err(S::Error::custom(message));
        }
        let limit = Some(self.limit).filter(|limit| *limit != usize::MAX);
        Stored {
            names: self.names.iter().map(|name| Cow::Borrowed(*name)).collect(),
            times: self.times.iter().copied().map(Exact).collect(),
            states: self.states.iter().map(|state| state.map(Exact).to_vec()).collect(),
            limit,
            stride: self.stride,
            seen: self.seen,
        }
        .serialize(serializer)
    }
}

/// The reason why these times are not those of a run: it goes one way, and is at the same time twice only where its state jumps.
fn disorder(times: &[f64]) -> Option<String> {
    let backwards = times.first() > times.last();
    let ordered = |pair: &[f64]| if backwards { pair[0] >= pair[1] } else { pair[0] <= pair[1] };
    let fault = match times {
        // Alone it has no neighbour to be compared with.
        [only] if only.is_nan() => Some(0),
        _ => times.windows(2).position(|pair| !ordered(pair)).map(|place| place + 1),
    };
    fault.map(|place| {
        format!(
            "the times of a recording neither rise nor fall throughout: t = {:?} at place {place}",
            times[place]
        )
    })
}

/// Reads a recording of a state with given names: see [`Recording::stored`].
#[derive(Clone, Copy, Debug)]
pub struct StoredRecording<const N: usize> {
    names: &'static [&'static str],
}

impl<const N: usize> Recording<N> {
    /// Returns a reader for recordings in files: their names have to be these, by which a file of another system is
    /// recognised. A recording that was read can be continued.
    ///
    /// Every number comes back to the bit, NaN and infinities too: in formats for people those are texts, such as `"inf"`. Refused are
    /// other names, times that neither rise nor fall throughout (equal neighbours are allowed: a state may jump), and counts that do not
    /// fit the samples. A recording with such times is not written either.
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

    /// Writes the recording as JSON to a file, whole or not at all: see [`replace_file`].
    ///
    /// ```
    /// use guen_study::Recording;
    ///
    /// let mut recording = Recording::new(&["x"]).with_units(&["m"]);
    /// recording.record(0.1, &[f64::INFINITY]);
    /// let path = std::env::temp_dir().join(format!("guen-docs-{}.json", std::process::id()));
    /// recording.save_json(&path)?;
    /// // The file has no units: they are given with the names.
    /// assert_eq!(Recording::<1>::load_json(&["x"], &path)?.with_units(&["m"]), recording);
    /// # std::fs::remove_file(&path).unwrap();
    /// # Ok::<(), guen_study::StudyError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`StudyError::Io`] with the path, also for times that neither rise nor fall throughout.
    pub fn save_json(&self, path: impl AsRef<Path>) -> Result<(), StudyError> {
        replace_file(path, |out| Ok(serde_json::to_writer(out, self)?))
    }

    /// Reads a recording of a state with these names from a file of JSON. The file has no units, which
    /// [`with_units`](Recording::with_units) gives to what is read.
    ///
    /// # Errors
    ///
    /// [`StudyError::Read`] with the path: there is no such file, or it is no recording of such a state; see
    /// [`stored`](Recording::stored).
    pub fn load_json(names: &'static [&'static str], path: impl AsRef<Path>) -> Result<Self, StudyError> {
        let path = path.as_ref();
        let file = File::open(path).map_err(from_path(path))?;
        let mut reader = serde_json::Deserializer::from_reader(BufReader::new(file));
        let recording = Self::stored(names).deserialize(&mut reader).map_err(from_path(path))?;
        reader.end().map_err(from_path(path))?;
        Ok(recording)
    }
}

impl<'de, const N: usize> DeserializeSeed<'de> for StoredRecording<N> {
    type Value = Recording<N>;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Recording<N>, D::Error> {
        let Stored { names, times, states, limit, stride, seen } = Stored::deserialize(deserializer)?;
        if names != self.names || names.len() != N {
            return Err(D::Error::custom(format!("a recording of {names:?}, and not of {:?}", self.names)));
        }
        let times: Vec<f64> = times.into_iter().map(|Exact(t)| t).collect();
        if times.len() != states.len() {
            return Err(D::Error::custom(format!("{} times and {} states", times.len(), states.len())));
        }
        if let Some(message) = disorder(&times) {
            return Err(D::Error::custom(message));
        }
        if expected(stride, seen) != Some(times.len() as u64) {
            let kept = times.len();
            return Err(D::Error::custom(format!(
                "{kept} samples, and not as many as are kept of {seen} with a stride of {stride}"
            )));
        }
        let states: Result<Vec<[Exact; N]>, _> = states.into_iter().map(<[Exact; N]>::try_from).collect();
        let states =
            states.map_err(|state| D::Error::invalid_length(state.len(), &"an entry for each name"))?;
        let states = states.into_iter().map(|state| state.map(|Exact(x)| x)).collect();
        let limit = limit.unwrap_or(usize::MAX).max(2);
        Ok(Recording { names: self.names, units: &[], times, states, limit, stride, seen })
    }
}

/// Returns the number of samples that are kept of those seen: every one whose number the stride divides, and the
/// newest. None if there is no such stride.
fn expected(stride: u64, seen: u64) -> Option<u64> {
    if !stride.is_power_of_two() {
        return None;
    }
    let Some(newest) = seen.checked_sub(1) else { return Some(0) };
    Some(newest / stride + 1 + u64::from(!newest.is_multiple_of(stride)))
}
