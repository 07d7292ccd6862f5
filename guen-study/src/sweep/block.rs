//! The rows of some motions, column by column.

use super::random::mixed;

/// A column of rows.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Column {
    pub(super) name: String,
    /// The unit as it was declared; empty where there is none.
    pub(super) unit: String,
}

impl Column {
    pub(super) fn new(name: impl Into<String>, unit: impl Into<String>) -> Self {
        Self { name: name.into(), unit: unit.into() }
    }
}

/// The reason why a motion has no row of numbers, or no further one.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Fault {
    /// The last good time, where one is known.
    pub(super) time: Option<f64>,
    pub(super) cause: String,
}

/// Rows, column by column: numbers of motions, points of the design, and values that are kept.
#[derive(Clone, Debug, Default)]
pub(super) struct Block {
    pub(super) motions: Vec<u64>,
    pub(super) points: Vec<Vec<f64>>,
    pub(super) kept: Vec<Vec<f64>>,
    /// The index of a row among those of its motion.
    pub(super) places: Vec<u32>,
    /// Rows without values, in order.
    pub(super) faults: Vec<(usize, Fault)>,
}

impl Block {
    pub(super) fn new(axes: usize, kept: usize) -> Self {
        Self { points: vec![Vec::new(); axes], kept: vec![Vec::new(); kept], ..Self::default() }
    }

    /// Removes all rows, and keeps the memory.
    pub(super) fn clear(&mut self) {
        let Self { motions, points, kept, places, faults } = self;
        motions.clear();
        points.iter_mut().chain(kept).for_each(Vec::clear);
        places.clear();
        faults.clear();
    }

    /// The number of rows.
    pub(super) fn len(&self) -> usize {
        self.motions.len()
    }

    fn begin(&mut self, motion: u64, point: &[f64], place: u32) {
        self.motions.push(motion);
        self.places.push(place);
        self.points.iter_mut().zip(point).for_each(|(column, value)| column.push(*value));
    }

    /// Adds the row of a motion, with as many values as are kept.
    pub(super) fn push(
        &mut self,
        motion: u64,
        point: &[f64],
        place: u32,
        mut kept: impl Iterator<Item = f64>,
    ) {
        self.begin(motion, point, place);
        // Of no times there are no extrema.
        self.kept.iter_mut().for_each(|column| column.push(kept.next().unwrap_or(f64::NAN)));
    }

    /// Adds a row that says why there are no values.
    pub(super) fn push_fault(&mut self, motion: u64, point: &[f64], fault: Fault) {
        self.faults.push((self.len(), fault));
        self.begin(motion, point, u32::MAX);
        self.kept.iter_mut().for_each(|column| column.push(f64::NAN));
    }

    /// The fault of each row, or none.
    pub(super) fn faults(&self) -> impl Iterator<Item = Option<&Fault>> + '_ {
        let mut faults = self.faults.iter().peekable();
        (0..self.len()).map(move |row| faults.next_if(|(at, _)| *at == row).map(|(_, fault)| fault))
    }

    /// A digest of all bits, whatever they are written as: 128 bits that depend on every bit of every column in order. It
    /// finds errors, and withstands no attack, at a tenth of what a cryptographic one takes.
    pub(super) fn digest(&self) -> String {
        let mut digest = [0_u64, 1];
        let mut take = |word: u64| {
            let [first, second] = digest;
            digest = [mixed(first ^ word), mixed(second.wrapping_add(word))];
        };
        self.motions.iter().for_each(|motion| take(*motion));
        for column in self.points.iter().chain(&self.kept) {
            column.iter().for_each(|value| take(value.to_bits()));
        }
        for (row, fault) in &self.faults {
            take(*row as u64);
            take(fault.time.map_or(u64::MAX, f64::to_bits));
            take(fault.cause.len() as u64);
            for bytes in fault.cause.as_bytes().chunks(8) {
                // The length tells zeros that fill up from those that are there.
                let mut word = [0; 8];
                word[..bytes.len()].copy_from_slice(bytes);
                take(u64::from_le_bytes(word));
            }
        }
        let [first, second] = digest;
        format!("{first:016x}{second:016x}")
    }
}
