//! Operations that differ in their indices alone.

use super::{ArrayIndex, Arrays, FEWEST_TURNS, kind, shapes};
use std::collections::BTreeMap;

use crate::program::instruction::{Instruction, Operation, Value};
use crate::program::shape::{Indices, Shape};

/// Operations of one shape, one for each turn.
pub(super) struct Class {
    /// The place of the instruction of each turn, from the turn `from` on.
    pub(super) places: Vec<usize>,
    /// The least turn.
    pub(super) from: i64,
    /// The operands.
    pub(super) roles: Vec<Role>,
    /// Operands that are values of no class, stored where a member of it would be: turn of the operand, class, second, value.
    pub(super) aliases: Vec<(usize, bool, i64, Value)>,
}

/// An operand of a class.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Role {
    /// One value.
    Outside(Value),
    /// An element of an array that the function takes: in the turn 0, and the stride.
    Given(char, i64, i64),
    /// The result, or the second one, of a class in the turn with this distance.
    Member(usize, bool, i64),
}

/// The classes, and what each value is in.
pub(super) struct Found {
    pub(super) classes: Vec<Class>,
    /// The class and turn that make a value, and whether it is the second one.
    pub(super) made: Vec<Option<(usize, i64, bool)>>,
    /// The places of values that the function is given.
    pub(super) given: Vec<Option<ArrayIndex>>,
}

impl Class {
    pub(super) fn to(&self) -> i64 {
        self.from + self.places.len() as i64
    }
}

/// Finds the classes; shapes are looked at so deep.
pub(super) fn find(
    (instructions, _, values): (&[Instruction], &[Value], usize),
    (indices, arrays): (&Indices, &dyn Arrays),
    prepared: &[Shape],
    depth: usize,
) -> Found {
    let leaf = |operation: &Operation| match operation {
        Operation::Symbol(symbol) => indices.of(*symbol),
        Operation::Prepared(k) => prepared.get(*k).copied().unwrap_or_default(),
        Operation::Number(value) => Shape::of_kind(value.hash64() | 1),
        _ => Shape::of_kind(5),
    };
    let shapes = shapes(instructions, values, &leaf, depth);
    let mut given = vec![None; values];
    let mut groups: BTreeMap<u64, Vec<(i64, usize)>> = BTreeMap::new();
    for (place, Instruction { result, operation }) in instructions.iter().enumerate() {
        match operation {
            Operation::Symbol(symbol) => given[result.index()] = arrays.symbol(*symbol),
            Operation::Prepared(k) => given[result.index()] = Some(('k', *k)),
            _ => {}
        }
        let shape = shapes[result.index()];
        if kind(operation) != 0
            && let Some(index) = shape.index
        {
            groups.entry(shape.hash).or_default().push((index, place));
        }
    }
    let mut found = Found { classes: Vec::new(), made: vec![None; values], given };
    for (_, members) in groups {
        if let Some((from, places)) = longest(members) {
            found.classes.push(Class { places, from, roles: Vec::new(), aliases: Vec::new() });
        }
    }
    found.settle(instructions);
    found
}

/// The longest stretch of members with indices one after another, none of them twice.
fn longest(mut members: Vec<(i64, usize)>) -> Option<(i64, Vec<usize>)> {
    members.sort_unstable();
    let is_single = |at: usize| {
        let index = members[at].0;
        (at == 0 || members[at - 1].0 != index) && members.get(at + 1).is_none_or(|next| next.0 != index)
    };
    let (mut best, mut start) = (0..0, 0);
    for at in 0..=members.len() {
        let goes_on =
            at < members.len() && is_single(at) && (at == start || members[at].0 == members[at - 1].0 + 1);
        if !goes_on {
            if at - start > best.len() {
                best = start..at;
            }
            start = if at < members.len() && is_single(at) { at } else { at + 1 };
        }
    }
    if (best.len() as i64) < FEWEST_TURNS {
        return None;
    }
    Some((members[best.start].0, members[best].iter().map(|member| member.1).collect()))
}

impl Found {
    /// Shortens classes until the operands of all members have one role each.
    pub(super) fn settle(&mut self, instructions: &[Instruction]) {
        loop {
            self.note_members(instructions);
            let mut changed = false;
            for index in 0..self.classes.len() {
                if !self.classes[index].places.is_empty() {
                    changed |= self.settle_class(instructions, index);
                }
            }
            if !changed {
                return;
            }
        }
    }

    fn note_members(&mut self, instructions: &[Instruction]) {
        self.made.fill(None);
        for (index, class) in self.classes.iter().enumerate() {
            for (turn, place) in (class.from..).zip(&class.places) {
                let Instruction { result, operation } = &instructions[*place];
                self.made[result.index()] = Some((index, turn, false));
                if let Operation::SinCos { cosine, .. } = operation {
                    self.made[cosine.index()] = Some((index, turn, true));
                }
            }
        }
    }

    /// Shortens a class; tells whether it did.
    fn settle_class(&mut self, instructions: &[Instruction], index: usize) -> bool {
        let class = &self.classes[index];
        let count = class.places.len();
        let operands = |at: usize| instructions[class.places[at]].operation.operands().collect::<Vec<_>>();
        let middle = count / 2;
        let turn = |at: usize| class.from + at as i64;
        let is_commutative =
            matches!(instructions[class.places[0]].operation, Operation::Add(..) | Operation::Mul(..));
        let (own, next) = (operands(middle), operands(middle + 1));
        let role_of = |own: Value, next: Value| self.role(own, next, turn(middle));
        let straight: Option<Vec<Role>> = own.iter().zip(&next).map(|(a, b)| role_of(*a, *b)).collect();
        let crossed = || own.iter().zip(next.iter().rev()).map(|(a, b)| role_of(*a, *b)).collect();
        let roles: Option<Vec<Role>> = straight.or_else(|| if is_commutative { crossed() } else { None });
        let Some(roles) = roles else {
            self.classes[index].places.clear();
            return true;
        };
        // The members around the middle whose operands fit.
        let mut aliases: Vec<Vec<(usize, bool, i64, Value)>> = vec![Vec::new(); count];
        let mut slots: BTreeMap<(usize, bool, i64), Value> = BTreeMap::new();
        let mut fits = |at: usize| -> bool {
            let mut values = operands(at);
            let misses = |values: &[Value]| {
                values.iter().zip(&roles).filter(|(v, role)| !self.plays(**v, **role, turn(at))).count()
            };
            if is_commutative && misses(&values) > 0 {
                let mut other = values.clone();
                other.reverse();
                if misses(&other) < misses(&values) {
                    values = other;
                }
            }
            let mut own = Vec::new();
            for (value, role) in values.iter().zip(&roles) {
                if self.plays(*value, *role, turn(at)) {
                    continue;
                }
                let Role::Member(class, second, distance) = *role else { return false };
                let of = turn(at) + distance;
                let other = &self.classes[class];
                let is_taken = (other.from..other.to()).contains(&of);
                let key = (class, second, of);
                if is_taken
                    || self.made[value.index()].is_some()
                    || slots.get(&key).is_some_and(|v| v != value)
                {
                    return false;
                }
                slots.insert(key, *value);
                own.push((class, second, of, *value));
            }
            aliases[at] = own;
            true
        };
        let (mut from, mut to) = (middle, middle);
        while to < count && fits(to) {
            to += 1;
        }
        while from > 0 && fits(from - 1) {
            from -= 1;
        }
        let is_same = from == 0 && to == count;
        let class = &mut self.classes[index];
        class.roles = roles;
        class.aliases = aliases[from..to].concat();
        if to.saturating_sub(from) < FEWEST_TURNS as usize {
            class.places.clear();
            return true;
        }
        class.places = class.places[from..to].to_vec();
        class.from += from as i64;
        !is_same
    }

    /// The role of an operand that is the first value in one turn and the other in the next.
    fn role(&self, own: Value, next: Value, turn: i64) -> Option<Role> {
        if own == next {
            return Some(Role::Outside(own));
        }
        if let (Some((array, a)), Some((other, b))) = (self.given[own.index()], self.given[next.index()]) {
            let stride = b as i64 - a as i64;
            return (array == other).then_some(Role::Given(array, a as i64 - stride * turn, stride));
        }
        let ((class, a, second), (other, b, other_second)) =
            (self.made[own.index()]?, self.made[next.index()]?);
        ((class, second) == (other, other_second) && b == a + 1).then_some(Role::Member(
            class,
            second,
            a - turn,
        ))
    }

    fn plays(&self, value: Value, role: Role, turn: i64) -> bool {
        match role {
            Role::Outside(other) => value == other,
            Role::Given(array, first, stride) => self.given[value.index()]
                .is_some_and(|(letter, at)| letter == array && at as i64 == first + stride * turn),
            Role::Member(class, second, distance) => {
                self.made[value.index()] == Some((class, turn + distance, second))
            }
        }
    }
}
