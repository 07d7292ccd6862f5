//! A number for each node of a net, zero at first: the memory of one traversal.
//!
//! Long families are optimised level by level, and a level has few of the nodes of its net. A table of all nodes for every pass
//! over a level would be of second order. So tables are kept by the net, and given back with zeros where a traversal has written.

use std::cell::RefCell;
use std::rc::Rc;

use super::terms::NetId;

/// The tables of a net that no traversal has at present; all their numbers are zero.
#[derive(Default)]
pub(super) struct Tables(Rc<RefCell<Vec<Vec<u32>>>>);

impl Tables {
    /// A number for each of the nodes of a net.
    pub(super) fn marks(&self, nodes: usize) -> Marks {
        let mut values = self.0.borrow_mut().pop().unwrap_or_default();
        if values.len() < nodes {
            values = vec![0; nodes.next_power_of_two()];
        }
        Marks { values, written: Vec::new(), home: Rc::clone(&self.0) }
    }
}

/// A number for each node, zero where none was set.
pub(super) struct Marks {
    values: Vec<u32>,
    /// The nodes whose numbers have been set.
    written: Vec<NetId>,
    home: Rc<RefCell<Vec<Vec<u32>>>>,
}

impl Marks {
    /// The number of a node; zero also for those that the net did not have yet.
    #[inline(always)]
    pub(super) fn get(&self, id: NetId) -> u32 {
        let values: &[u32] = &self.values;
        let index = id.0 as usize;
        if index < values.len() { values[index] } else { 0 }
    }

    #[inline(always)]
    pub(super) fn set(&mut self, id: NetId, number: u32) {
        let values: &mut [u32] = &mut self.values;
        let index = id.0 as usize;
        if values[index] == 0 {
            self.written.push(id);
        }
        values[index] = number;
    }

    /// The nodes whose numbers have been set, in the order in which they were.
    pub(super) fn written(&self) -> &[NetId] {
        &self.written
    }
}

impl Drop for Marks {
    fn drop(&mut self) {
        let mut values = std::mem::take(&mut self.values);
        let all: &mut [u32] = &mut values;
        for id in &self.written {
            all[id.0 as usize] = 0;
        }
        self.home.borrow_mut().push(values);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_come_back_clean() {
        let tables = Tables::default();
        let (first, last) = (NetId(0), NetId(9));
        let mut one = tables.marks(10);
        one.set(last, 7);
        // Two traversals at once do not see each other.
        let mut other = tables.marks(10);
        assert_eq!((other.get(last), one.get(last), one.get(first)), (0, 7, 0));
        other.set(first, 1);
        other.set(first, 2);
        assert_eq!((other.get(first), other.written()), (2, &[first][..]));
        drop((one, other));
        let again = [tables.marks(10), tables.marks(10)];
        assert!(again.iter().all(|marks| marks.get(first) == 0 && marks.get(last) == 0));
        // A net that has grown gets a longer table; a node that came later has none.
        assert_eq!((tables.marks(1000).get(NetId(999)), tables.marks(10).get(NetId(1_000_000))), (0, 0));
    }
}
