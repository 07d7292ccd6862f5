//! Traversals of a graph: the memory of one, and the order of what it found.

use super::id::ExprId;

/// The memory of a traversal: kept, because clearing it would cost more than the nodes that are visited.
#[derive(Default)]
pub(super) struct Search {
    /// The number of the search that has seen a node last.
    seen: Vec<u32>,
    number: u32,
    stack: Vec<u32>,
    height: usize,
}

impl Search {
    pub(super) fn begin(&mut self, nodes: usize) {
        if self.seen.len() < nodes || self.number == u32::MAX {
            let room = nodes.next_power_of_two();
            *self = Search { seen: vec![0; room], number: 0, stack: vec![0; room], height: 0 };
        }
        self.number += 1;
        self.height = 0;
    }

    /// A node to be visited, unless it was pushed before: so the stack has room for it.
    #[inline(always)]
    pub(super) fn push(&mut self, id: ExprId) {
        let (seen, stack): (&mut [u32], &mut [u32]) = (&mut self.seen, &mut self.stack);
        let index = id.0 as usize;
        if seen[index] != self.number {
            seen[index] = self.number;
            stack[self.height] = id.0;
            self.height += 1;
        }
    }

    pub(super) fn pop(&mut self) -> Option<ExprId> {
        if self.height == 0 {
            return None;
        }
        self.height -= 1;
        Some(ExprId(self.stack[self.height]))
    }
}

/// Sorts different identifiers: few by insertion, many by a bit for each.
pub(crate) fn sort_ids(ids: &mut [ExprId]) {
    const INSERTION_SORTED: usize = 12;
    if ids.len() <= INSERTION_SORTED {
        let mut next = 1;
        while next < ids.len() {
            let id = ids[next];
            let mut at = next;
            while at > 0 && ids[at - 1].0 > id.0 {
                ids[at] = ids[at - 1];
                at -= 1;
            }
            ids[at] = id;
            next += 1;
        }
        return;
    }
    let (mut least, mut most) = (u32::MAX, 0);
    let mut index = 0;
    while index < ids.len() {
        let id = ids[index].0;
        if id < least {
            least = id;
        }
        if id > most {
            most = id;
        }
        index += 1;
    }
    let base = least / 64;
    let mut bits = vec![0_u64; (most / 64 - base) as usize + 1];
    let words: &mut [u64] = &mut bits;
    index = 0;
    while index < ids.len() {
        let id = ids[index].0;
        words[(id / 64 - base) as usize] |= 1 << (id % 64);
        index += 1;
    }
    let (mut word, mut next) = (0, 0);
    while word < words.len() {
        let mut left = words[word];
        while left != 0 {
            ids[next] = ExprId((base + word as u32) * 64 + left.trailing_zeros());
            next += 1;
            left &= left - 1;
        }
        word += 1;
    }
}
