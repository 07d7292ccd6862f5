//! Recordings as JSON: every bit comes back, and what is no recording of this state is refused.

use guen_study::{Recording, StudyError};
use serde::de::DeserializeSeed;

use crate::{Folder, Random, write};

const NAMES: &[&str] = &["x", "v"];

fn read(text: &str) -> Result<Recording<2>, serde_json::Error> {
    Recording::stored(NAMES).deserialize(&mut serde_json::Deserializer::from_str(text))
}

fn bits(recording: &Recording<2>) -> Vec<[u64; 3]> {
    recording.iter().map(|(t, &[x, v])| [t, x, v].map(f64::to_bits)).collect()
}

#[test]
fn random_bits_come_back() {
    let mut random = Random(7);
    let mut recording = Recording::new(NAMES);
    let mut t = -1e3;
    for _ in 0..100_000 {
        t += f64::from_bits(random.bits() >> 12 | 1023 << 52) - 1.0;
        recording.record(t, &[random.bits(), random.bits()].map(f64::from_bits));
    }
    recording.record(t, &[f64::INFINITY, f64::NEG_INFINITY]);
    recording.record(f64::INFINITY, &[f64::NAN, -f64::NAN]);
    let folder = Folder::new("bits");
    let path = folder.0.join("deep/run.json");
    recording.save_json(&path).unwrap();
    let back = Recording::load_json(NAMES, &path).unwrap();
    assert_eq!(bits(&back), bits(&recording));
    assert_eq!((back.seen(), back.stride()), (recording.seen(), recording.stride()));
}

#[test]
fn thinned_recordings_come_back_and_go_on() {
    for samples in [0, 1, 2, 9, 10, 11, 777] {
        let mut recording = Recording::new(NAMES).with_limit(10);
        for k in 0..samples {
            recording.record(-f64::from(k), &[f64::from(k), 0.0]);
        }
        let mut back = read(&serde_json::to_string(&recording).unwrap()).unwrap();
        assert_eq!(back, recording);
        for k in samples..2 * samples + 5 {
            recording.record(-f64::from(k), &[f64::from(k), 0.0]);
            back.record(-f64::from(k), &[f64::from(k), 0.0]);
        }
        assert_eq!(back, recording, "{samples}");
    }
}

/// A recording of three samples with some of its text replaced.
fn replaced(from: &str, to: &str) -> String {
    let mut recording = Recording::new(NAMES);
    for t in [0.0, 1.0, 2.0] {
        recording.record(t, &[t, -t]);
    }
    let text = serde_json::to_string(&recording).unwrap();
    assert!(text.contains(from), "{text}");
    text.replace(from, to)
}

#[test]
fn what_is_no_recording_of_this_state_is_refused() {
    assert!(read(&replaced("\"x\"", "\"x\"")).is_ok());
    // A jump has two samples at one time.
    assert!(read(&replaced("[0.0,1.0,2.0]", "[0.0,1.0,1.0]")).is_ok());
    for (from, to, message) in [
        ("\"x\"", "\"y\"", "a recording of [\"y\", \"v\"], and not of [\"x\", \"v\"]"),
        ("[\"x\",\"v\"]", "[\"v\",\"x\"]", "and not of"),
        ("[0.0,1.0,2.0]", "[0.0,2.0,1.0]", "neither rise nor fall throughout: t = 1.0 at place 2"),
        ("[0.0,1.0,2.0]", "[1.0,0.0,2.0]", "neither rise nor fall throughout: t = 0.0 at place 1"),
        ("[0.0,1.0,2.0]", "[0.0,\"NaN\",2.0]", "neither rise nor fall throughout: t = NaN at place 1"),
        ("[0.0,1.0,2.0]", "[\"NaN\",1.0,2.0]", "neither rise nor fall"),
        ("[0.0,1.0,2.0]", "[0.0,1.0]", "2 times and 3 states"),
        ("[0.0,1.0,2.0]", "[0.0,1.0,null]", "invalid type: null"),
        ("[1.0,-1.0]", "[1.0]", "invalid length 1"),
        ("\"seen\":3", "\"seen\":30", "not as many as are kept of 30 with a stride of 1"),
        ("\"stride\":1", "\"stride\":3", "with a stride of 3"),
        ("\"stride\":1", "\"stride\":0", "with a stride of 0"),
        ("\"seen\":3", "\"seen\":3,\"more\":1", "unknown field `more`"),
    ] {
        let error = read(&replaced(from, to)).unwrap_err().to_string();
        assert!(error.contains(message), "{to}: {error}");
    }
    let folder = Folder::new("refused");
    let path = folder.0.join("run.json");
    let load = || Recording::<2>::load_json(NAMES, &path);
    assert!(matches!(load(), Err(StudyError::Read { path: at, .. }) if at == path));
    write(&path, &(replaced("", "") + "x"));
    assert!(load().unwrap_err().to_string().contains("trailing characters"));
    let text = replaced("", "");
    for length in 0..text.len() {
        write(&path, &text[..length]);
        assert!(load().is_err(), "{length} of {} bytes", text.len());
    }
}

#[test]
fn times_out_of_order_are_not_written() {
    for times in [&[0.0, 1.0, 0.5][..], &[0.0, f64::NAN], &[f64::NAN], &[1.0, 0.0, 0.5]] {
        let mut recording = Recording::new(NAMES);
        times.iter().for_each(|t| recording.record(*t, &[0.0; 2]));
        let folder = Folder::new("disorder");
        let path = folder.0.join("run.json");
        let error = recording.save_json(&path).unwrap_err().to_string();
        assert!(error.contains("neither rise nor fall throughout"), "{error}");
        assert!(!path.exists());
    }
}
