//! A hash map for look-ups whose every step is an index into a slice.
//!
//! The macro's own code runs without optimisation: there each layer of a generic container is a call of its own, and
//! the standard map costs ten times what it does elsewhere. This one is two slices and a loop. It iterates in the order
//! of insertion, so that nothing that comes out of it depends on hashes.

use std::fmt;
use std::ops::Index;

use super::id::{ExprId, SymbolId, mix};

/// A key of a [`FastMap`].
pub(crate) trait Key: Eq {
    /// A fixed mixing of the key; the low bits choose the place.
    fn hash(&self) -> u32;
}

/// Fibonacci hashing (Knuth, The Art of Computer Programming 3, 6.4): the high bits of a product are well mixed.
pub(crate) fn spread(value: u64) -> u32 {
    (value.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 32) as u32
}

impl Key for ExprId {
    fn hash(&self) -> u32 {
        spread(self.0 as u64)
    }
}

impl Key for SymbolId {
    fn hash(&self) -> u32 {
        spread(self.0 as u64)
    }
}

impl Key for (ExprId, u32) {
    fn hash(&self) -> u32 {
        spread((self.0.0 as u64) << 32 | self.1 as u64)
    }
}

impl Key for (ExprId, ExprId) {
    fn hash(&self) -> u32 {
        spread((self.0.0 as u64) << 32 | self.1.0 as u64)
    }
}

impl Key for Box<[(ExprId, i32)]> {
    fn hash(&self) -> u32 {
        let mut hash = 0;
        for (base, e) in self {
            hash = mix(hash ^ (base.0 as u64) << 32 ^ *e as u32 as u64);
        }
        spread(hash)
    }
}

#[derive(Clone)]
struct Entry<K, V> {
    hash: u32,
    key: K,
    value: V,
}

/// A map that only grows, iterated in the order of insertion.
#[derive(Clone)]
pub(crate) struct FastMap<K, V> {
    /// Slots with one more than the index of an entry, zero for none; a power of two of them, or none at all.
    slots: Vec<u32>,
    entries: Vec<Entry<K, V>>,
}

/// The first table: small maps are many.
const FEWEST_SLOTS: usize = 16;

impl<K: Key, V> FastMap<K, V> {
    /// The slot of a key, or the free one where it belongs; there are slots.
    fn slot(&self, hash: u32, key: &K) -> usize {
        let slots: &[u32] = &self.slots;
        let entries: &[Entry<K, V>] = &self.entries;
        let mask = slots.len() - 1;
        let mut at = hash as usize & mask;
        loop {
            let found = slots[at] as usize;
            if found == 0 {
                return at;
            }
            let entry = &entries[found - 1];
            if entry.hash == hash && entry.key == *key {
                return at;
            }
            at = (at + 1) & mask;
        }
    }

    /// The index of a key's entry.
    fn find(&self, key: &K) -> Option<usize> {
        if self.entries.is_empty() {
            return None;
        }
        let slot = self.slot(key.hash(), key);
        let slots: &[u32] = &self.slots;
        match slots[slot] {
            0 => None,
            found => Some(found as usize - 1),
        }
    }

    /// The index of a key's entry, which is made if there is none; whether it was there.
    fn place(&mut self, key: K, value: impl FnOnce() -> V) -> (usize, bool) {
        if self.slots.len() <= 2 * self.entries.len() {
            self.grow();
        }
        let hash = key.hash();
        let slot = self.slot(hash, &key);
        let slots: &mut [u32] = &mut self.slots;
        if slots[slot] != 0 {
            return (slots[slot] as usize - 1, true);
        }
        let index = self.entries.len();
        slots[slot] = index as u32 + 1;
        self.entries.push(Entry { hash, key, value: value() });
        (index, false)
    }

    fn grow(&mut self) {
        let mut slots = vec![0_u32; (4 * self.entries.len()).next_power_of_two().max(FEWEST_SLOTS)];
        let table: &mut [u32] = &mut slots;
        let mask = table.len() - 1;
        let entries: &[Entry<K, V>] = &self.entries;
        let mut index = 0;
        while index < entries.len() {
            let mut at = entries[index].hash as usize & mask;
            while table[at] != 0 {
                at = (at + 1) & mask;
            }
            index += 1;
            table[at] = index as u32;
        }
        self.slots = slots;
    }

    pub(crate) fn get(&self, key: &K) -> Option<&V> {
        match self.find(key) {
            Some(index) => Some(&self.entries[index].value),
            None => None,
        }
    }

    pub(crate) fn get_mut(&mut self, key: &K) -> Option<&mut V> {
        match self.find(key) {
            Some(index) => Some(&mut self.entries[index].value),
            None => None,
        }
    }

    pub(crate) fn contains_key(&self, key: &K) -> bool {
        self.find(key).is_some()
    }

    /// Sets a value; returns the one before.
    pub(crate) fn insert(&mut self, key: K, value: V) -> Option<V> {
        let mut value = Some(value);
        let (index, known) = self.place(key, || value.take().expect("asked for once"));
        if known { value.map(|value| std::mem::replace(&mut self.entries[index].value, value)) } else { None }
    }

    /// The value of a key, which starts with what is given.
    pub(crate) fn or_insert_with(&mut self, key: K, value: impl FnOnce() -> V) -> &mut V {
        let (index, _) = self.place(key, value);
        &mut self.entries[index].value
    }

    /// The value of a key, which starts with its default.
    pub(crate) fn or_default(&mut self, key: K) -> &mut V
    where
        V: Default,
    {
        self.or_insert_with(key, V::default)
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    pub(crate) fn len(&self) -> usize {
        self.entries.len()
    }

    /// Returns the entries in the order in which they were made.
    pub(crate) fn iter(&self) -> impl Iterator<Item = (&K, &V)> {
        self.entries.iter().map(|entry| (&entry.key, &entry.value))
    }

    /// Returns the entries with their keys and values, in the order of insertion.
    pub(crate) fn into_pairs(self) -> impl Iterator<Item = (K, V)> {
        self.entries.into_iter().map(|entry| (entry.key, entry.value))
    }
}

impl<K, V> Default for FastMap<K, V> {
    fn default() -> Self {
        FastMap { slots: Vec::new(), entries: Vec::new() }
    }
}

impl<K: Key, V> Index<&K> for FastMap<K, V> {
    type Output = V;
    fn index(&self, key: &K) -> &V {
        self.get(key).expect("the key is in the map")
    }
}

impl<K: Key, V> Extend<(K, V)> for FastMap<K, V> {
    fn extend<I: IntoIterator<Item = (K, V)>>(&mut self, pairs: I) {
        for (key, value) in pairs {
            self.insert(key, value);
        }
    }
}

impl<K: Key, V> FromIterator<(K, V)> for FastMap<K, V> {
    fn from_iter<I: IntoIterator<Item = (K, V)>>(pairs: I) -> Self {
        let mut map = FastMap::default();
        map.extend(pairs);
        map
    }
}

impl<K: fmt::Debug, V: fmt::Debug> fmt::Debug for FastMap<K, V> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_map().entries(self.entries.iter().map(|entry| (&entry.key, &entry.value))).finish()
    }
}

/// A key of a [`SortedMap`].
pub(crate) trait Ordinal: Copy {
    /// The place in the order.
    fn ordinal(self) -> u32;
}

impl Ordinal for ExprId {
    fn ordinal(self) -> u32 {
        self.0
    }
}

/// A map of a few entries in ascending order: a list that is searched.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(crate) struct SortedMap<K, V>(Vec<(K, V)>);

impl<K: Ordinal, V> SortedMap<K, V> {
    pub(crate) fn with_capacity(capacity: usize) -> Self {
        SortedMap(Vec::with_capacity(capacity))
    }

    /// A map of entries that are in ascending order.
    pub(crate) fn from_sorted(entries: Vec<(K, V)>) -> Self {
        SortedMap(entries)
    }

    /// Returns the place of a key, or the place where it would have to be put.
    fn place(&self, key: K) -> Result<usize, usize> {
        let entries: &[(K, V)] = &self.0;
        let ordinal = key.ordinal();
        let (mut low, mut high) = (0, entries.len());
        while low < high {
            // Most maps are filled in order: often the end is the place.
            let at = if high == entries.len() { high - 1 } else { (low + high) / 2 };
            let other = entries[at].0.ordinal();
            if other == ordinal {
                return Ok(at);
            }
            if other < ordinal {
                low = at + 1;
            } else {
                high = at;
            }
        }
        Err(low)
    }

    /// The value of a key, which starts with the one given.
    pub(crate) fn or_insert(&mut self, key: K, value: V) -> &mut V {
        let at = match self.place(key) {
            Ok(at) => at,
            Err(at) => {
                if at == self.0.len() {
                    self.0.push((key, value));
                } else {
                    self.0.insert(at, (key, value));
                }
                at
            }
        };
        &mut self.0[at].1
    }

    pub(crate) fn get(&self, key: K) -> Option<&V> {
        match self.place(key) {
            Ok(at) => Some(&self.0[at].1),
            Err(_) => None,
        }
    }

    pub(crate) fn remove(&mut self, key: K) -> Option<V> {
        match self.place(key) {
            Ok(at) => Some(self.0.remove(at).1),
            Err(_) => None,
        }
    }

    /// The entries in ascending order.
    pub(crate) fn entries(&self) -> &[(K, V)] {
        &self.0
    }

    /// Returns the entries with their keys and values, in order.
    pub(crate) fn into_entries(self) -> Vec<(K, V)> {
        self.0
    }
}

impl<K, V> Default for SortedMap<K, V> {
    fn default() -> Self {
        SortedMap(Vec::new())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sorted_maps_stay_sorted() {
        let mut map: SortedMap<ExprId, u32> = SortedMap::default();
        for n in 0..200_u32 {
            // 77 and 200 have no factor in common: every key once, in no order.
            *map.or_insert(ExprId(n * 77 % 200), 1) += n;
        }
        *map.or_insert(ExprId(77), 0) += 10;
        assert_eq!(map.get(ExprId(77)), Some(&12));
        assert_eq!(map.remove(ExprId(77)), Some(12));
        assert_eq!(map.get(ExprId(77)), None);
        assert!(map.entries().windows(2).all(|pair| pair[0].0 < pair[1].0));
        assert_eq!(map.into_entries().len(), 199);
    }

    #[test]
    fn finds_what_was_put_in() {
        let mut map: FastMap<ExprId, u32> = FastMap::default();
        assert!(map.is_empty() && map.get(&ExprId(3)).is_none());
        for n in (0..1000).rev() {
            assert_eq!(map.insert(ExprId(n), n), None);
            *map.or_default(ExprId(n)) += 1;
        }
        assert_eq!(map.insert(ExprId(7), 0), Some(8));
        for n in 0..1000 {
            assert_eq!(map[&ExprId(n)], if n == 7 { 0 } else { n + 1 });
        }
        assert!(!map.contains_key(&ExprId(1000)));
        let keys: Vec<u32> = map.iter().map(|(key, _)| key.0).collect();
        assert!(keys.windows(2).all(|pair| pair[0] == pair[1] + 1), "the order is that of insertion");
    }
}
