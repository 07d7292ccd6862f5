//! Words and marks of a page: the modes of contacts over time, and their transitions.

use super::Viewer;
use super::drawable::is_drawable;

/// A moment that the page marks.
#[derive(Clone, Debug)]
pub(super) struct Mark {
    pub(super) time: f64,
    pub(super) text: String,
}

/// A name with the word that holds from each of some times on.
#[derive(Clone, Debug)]
pub(super) struct Words {
    pub(super) name: String,
    pub(super) changes: Vec<Mark>,
}

/// Letters of JSON around a text and its time.
const AROUND: usize = 32;

/// The bytes of marks and words in the file.
pub(super) fn bytes(marks: &[Mark], words: &[Words]) -> usize {
    let changes = words.iter().flat_map(|words| &words.changes);
    changes.chain(marks).map(|mark| mark.text.len() + AROUND).sum()
}

impl<const N: usize> Viewer<'_, N> {
    /// Marks a moment: a thin line across all curves and at the slider, and this text below the title from that time on. The keys `[`
    /// and `]` go from mark to mark.
    ///
    /// ```
    /// use guen_study::{Recording, Viewer};
    ///
    /// let mut recording = Recording::new(&["z"]);
    /// (0..100).for_each(|k| recording.record(f64::from(k), &[(f64::from(k) - 50.0).abs()]));
    /// let page = Viewer::new("A bounce", &recording).curve("z", |_, x| x[0]).mark(50.0, "impact: floor");
    /// assert!(page.to_html()?.contains(r#""time":50,"text":"impact: floor""#));
    /// # Ok::<(), guen_study::StudyError>(())
    /// ```
    pub fn mark(mut self, time: f64, text: impl Into<String>) -> Self {
        let text = text.into();
        self.require(is_drawable(&[time]), || format!("the mark `{text}`"));
        self.marks.push(Mark { time, text });
        self
    }

    /// A name whose word changes with time, such as a contact that sticks and slips: the page says below its title which word holds. Each
    /// pair is a time and the word that holds from then on.
    ///
    /// ```
    /// use guen_study::{Recording, Viewer};
    ///
    /// let mut recording = Recording::new(&["x"]);
    /// (0..100).for_each(|k| recording.record(f64::from(k), &[1.0]));
    /// let page = Viewer::new("A belt", &recording).curve("x", |_, x| x[0]).words("belt", [(0.0, "stick"), (30.0, "slip+")]);
    /// assert!(page.to_html()?.contains(r#""time":30,"text":"slip+""#));
    /// # Ok::<(), guen_study::StudyError>(())
    /// ```
    pub fn words(
        mut self,
        name: impl Into<String>,
        changes: impl IntoIterator<Item = (f64, impl Into<String>)>,
    ) -> Self {
        let name = name.into();
        let changes: Vec<Mark> =
            changes.into_iter().map(|(time, text)| Mark { time, text: text.into() }).collect();
        self.require(changes.iter().all(|mark| is_drawable(&[mark.time])), || format!("the words of {name}"));
        self.words.push(Words { name, changes });
        self
    }
}
