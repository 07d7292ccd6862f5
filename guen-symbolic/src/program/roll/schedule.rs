//! Classes in loops, and loops in an order in which every value is made before it is used.

use std::collections::BTreeMap;

use super::classes::{Class, Found, Role};
use super::{FEWEST_TURNS, Line, Loop, Operand, Places, Rolled, RolledStep};
use crate::program::instruction::{Instruction, Operation, Value};

/// Classes that go through the members in one loop.
#[derive(Clone)]
struct Group {
    /// The classes, each with the turn of the loop in which its turn 0 is made.
    members: Vec<(usize, i64)>,
    descends: bool,
}

/// A step of the order: a group, or an instruction that is in none.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Node {
    Group(usize),
    Once(usize),
}

/// The code with loops; none where classes and other instructions wait for each other.
pub(super) fn scheduled(code: (&[Instruction], &[Value], usize), mut found: Found) -> Option<Rolled> {
    /// Members that do not fit into the turns of their loop leave it, and the rest is looked at again.
    const ROUNDS: usize = 12;
    let maker = makers(code.0, code.2);
    for _ in 0..ROUNDS {
        let groups = grouped((code.0, &maker), &found)?;
        if !trim(&mut found, &groups) {
            return Writer::new(code, &maker, &found, &groups).write();
        }
        found.settle(code.0);
    }
    None
}

/// Shortens classes to the turns that all classes of their loop have; tells whether it did.
fn trim(found: &mut Found, groups: &[Group]) -> bool {
    let mut changed = false;
    for group in groups {
        let (from, to) = turns(found, group);
        for (class, shift) in &group.members {
            let class = &mut found.classes[*class];
            let (least, most) = (from - shift, to - shift);
            if class.from == least && class.to() == most {
                continue;
            }
            changed = true;
            if most - least < FEWEST_TURNS {
                class.places.clear();
                continue;
            }
            class.places = class.places[(least - class.from) as usize..(most - class.from) as usize].to_vec();
            class.from = least;
        }
    }
    changed
}

/// The turns of a loop.
fn turns(found: &Found, group: &Group) -> (i64, i64) {
    let classes = || group.members.iter().map(|(class, shift)| (&found.classes[*class], shift));
    let from = classes().map(|(class, shift)| class.from + shift).max().unwrap_or(0);
    let to = classes().map(|(class, shift)| class.to() + shift).min().unwrap_or(0);
    (from, to)
}

/// The classes that a class needs, in turns with a distance.
fn needs(class: &Class) -> impl Iterator<Item = (usize, i64)> {
    class.roles.iter().filter_map(|role| match role {
        Role::Member(other, _, distance) => Some((*other, *distance)),
        _ => None,
    })
}

/// The groups: classes that need each other in turn, and then neighbours that fit into one loop.
fn grouped(code: (&[Instruction], &[usize]), found: &Found) -> Option<Vec<Group>> {
    let alive: Vec<usize> =
        (0..found.classes.len()).filter(|class| !found.classes[*class].places.is_empty()).collect();
    let mut groups: Vec<Group> = Vec::new();
    for members in circles(found, &alive) {
        groups.push(aligned(found, &members)?);
    }
    // From the first to the last, each with those behind it.
    let mut index = 0;
    while index < groups.len() {
        let mut other = index + 1;
        while other < groups.len() {
            let joined: Vec<usize> =
                groups[index].members.iter().chain(&groups[other].members).map(|member| member.0).collect();
            let fits = is_near(code, found, &groups, index, other)
                .then(|| aligned(found, &joined))
                .flatten()
                .filter(|group| {
                    let (from, to) = turns(found, group);
                    let longest = group.members.iter().map(|(class, _)| found.classes[*class].places.len());
                    // A few members at the ends may leave the loop.
                    to - from + FEWEST_TURNS >= longest.max().unwrap_or(0) as i64
                });
            match fits {
                Some(group) => {
                    groups[index] = group;
                    groups.remove(other);
                    other = index + 1;
                }
                None => other += 1,
            }
        }
        index += 1;
    }
    Some(groups)
}

/// The sets of classes that need each other in turn, or single ones.
fn circles(found: &Found, alive: &[usize]) -> Vec<Vec<usize>> {
    let reach: BTreeMap<usize, Vec<bool>> = alive
        .iter()
        .map(|class| {
            let mut seen = vec![false; found.classes.len()];
            let mut stack = vec![*class];
            while let Some(next) = stack.pop() {
                for (other, _) in needs(&found.classes[next]) {
                    if !seen[other] {
                        seen[other] = true;
                        stack.push(other);
                    }
                }
            }
            (*class, seen)
        })
        .collect();
    let mut circles: Vec<Vec<usize>> = Vec::new();
    for class in alive {
        let of = |circle: &Vec<usize>| reach[&circle[0]][*class] && reach[class][circle[0]];
        match circles.iter_mut().find(|circle| of(circle)) {
            Some(circle) => circle.push(*class),
            None => circles.push(vec![*class]),
        }
    }
    circles
}

/// Classes in one loop, if there is a direction in which everything is made before it is used.
fn aligned(found: &Found, members: &[usize]) -> Option<Group> {
    [false, true].into_iter().find_map(|descends| {
        let sign = if descends { -1 } else { 1 };
        let mut shifts: BTreeMap<usize, i64> = members.iter().map(|class| (*class, 0)).collect();
        for round in 0..=members.len() {
            let mut changed = false;
            for class in members {
                for (other, distance) in needs(&found.classes[*class]) {
                    let Some(shift) = shifts.get(&other) else { continue };
                    let least = shift + sign * distance;
                    if shifts[class] < least {
                        shifts.insert(*class, least);
                        changed = true;
                    }
                }
            }
            if !changed {
                let members = shifts.into_iter().map(|(class, shift)| (class, sign * shift)).collect();
                return Some(Group { members, descends });
            }
            if round == members.len() {
                return None;
            }
        }
        None
    })
}

/// Whether two groups can be made one: nothing between them needs one and is needed by the other.
fn is_near(code: (&[Instruction], &[usize]), found: &Found, groups: &[Group], a: usize, b: usize) -> bool {
    let users = Below::new(code.0, code.1, found, groups);
    !users.has_way_around(a, b) && !users.has_way_around(b, a)
}

/// The results of the function that are the values of classes, of those of which all are.
fn results(
    instructions: &[Instruction],
    (outputs, values): (&[Value], usize),
    found: &Found,
) -> BTreeMap<(usize, bool), Places> {
    let mut places: Vec<Vec<i64>> = vec![Vec::new(); values];
    for (place, output) in (0..).zip(outputs) {
        places[output.index()].push(place);
    }
    let mut found_places = BTreeMap::new();
    for (index, class) in found.classes.iter().enumerate() {
        for second in [false, true] {
            let value = |place: &usize| {
                let Instruction { result, operation } = &instructions[*place];
                match operation {
                    Operation::SinCos { cosine, .. } if second => *cosine,
                    _ => *result,
                }
            };
            let [first, next, ..] = &class.places[..] else { continue };
            let [first, next] = [first, next].map(|place| &places[value(place).index()]);
            let runs = first.iter().flat_map(|from| next.iter().map(move |to| (*from, to - from)));
            let mut runs = runs.map(|(from, stride)| Places { origin: from - stride * class.from, stride });
            let run = runs.find(|run| {
                let mut turns = (class.from..).zip(&class.places);
                turns.all(|(turn, place)| outputs.get(run.at(turn) as usize) == Some(&value(place)))
            });
            if let Some(run) = run {
                found_places.insert((index, second), run);
            }
        }
    }
    found_places
}

/// The instruction that makes each value.
fn makers(instructions: &[Instruction], values: usize) -> Vec<usize> {
    let mut maker = vec![0; values];
    for (place, Instruction { result, operation }) in instructions.iter().enumerate() {
        maker[result.index()] = place;
        if let Operation::SinCos { cosine, .. } = operation {
            maker[cosine.index()] = place;
        }
    }
    maker
}

/// The steps that each step needs.
struct Below<'a> {
    instructions: &'a [Instruction],
    found: &'a Found,
    groups: &'a [Group],
    /// The group of each class.
    group_of: Vec<usize>,
    /// The instruction that makes each value.
    maker: &'a [usize],
}

impl<'a> Below<'a> {
    fn new(
        instructions: &'a [Instruction],
        maker: &'a [usize],
        found: &'a Found,
        groups: &'a [Group],
    ) -> Self {
        let mut group_of = vec![usize::MAX; found.classes.len()];
        for (index, group) in groups.iter().enumerate() {
            group.members.iter().for_each(|(class, _)| group_of[*class] = index);
        }
        Below { instructions, found, groups, group_of, maker }
    }

    /// The step that makes a value.
    fn node(&self, value: Value) -> Node {
        match self.found.made[value.index()] {
            Some((class, ..)) => Node::Group(self.group_of[class]),
            None => Node::Once(self.maker[value.index()]),
        }
    }

    fn needed(&self, node: Node) -> Vec<Node> {
        match node {
            Node::Once(place) => {
                self.instructions[place].operation.operands().map(|v| self.node(v)).collect()
            }
            Node::Group(index) => {
                let mut nodes = Vec::new();
                for (class, _) in &self.groups[index].members {
                    let class = &self.found.classes[*class];
                    nodes.extend(needs(class).map(|(other, _)| Node::Group(self.group_of[other])));
                    nodes.extend(class.aliases.iter().map(|(.., value)| self.node(*value)));
                    for role in &class.roles {
                        if let Role::Outside(value) = role {
                            nodes.push(self.node(*value));
                        }
                    }
                }
                nodes.sort_unstable();
                nodes.dedup();
                nodes.retain(|other| *other != node);
                nodes
            }
        }
    }

    /// Whether the first group needs the second through something else.
    fn has_way_around(&self, a: usize, b: usize) -> bool {
        let mut seen: BTreeMap<Node, ()> = BTreeMap::new();
        let start = self.needed(Node::Group(a));
        let mut stack: Vec<Node> = start.into_iter().filter(|node| *node != Node::Group(b)).collect();
        while let Some(node) = stack.pop() {
            if node == Node::Group(b) {
                return true;
            }
            if seen.insert(node, ()).is_none() {
                stack.extend(self.needed(node));
            }
        }
        false
    }
}

/// Writes the steps.
struct Writer<'a> {
    below: Below<'a>,
    outputs: &'a [Value],
    /// The results of the function that are the values of classes, of those of which all are.
    results: BTreeMap<(usize, bool), Places>,
    /// The arrays of classes and their least turn.
    arrays: BTreeMap<(usize, bool), (usize, i64)>,
    rolled: Rolled,
    /// Values that have been read out of arrays.
    loaded: Vec<bool>,
}

impl<'a> Writer<'a> {
    fn new(
        (instructions, outputs, values): (&'a [Instruction], &'a [Value], usize),
        maker: &'a [usize],
        found: &'a Found,
        groups: &'a [Group],
    ) -> Self {
        let below = Below::new(instructions, maker, found, groups);
        Writer {
            results: results(instructions, (outputs, values), found),
            below,
            outputs,
            arrays: BTreeMap::new(),
            rolled: Rolled::default(),
            loaded: vec![false; values],
        }
    }

    fn write(mut self) -> Option<Rolled> {
        self.find_arrays();
        let order = self.order()?;
        for node in order {
            match node {
                Node::Once(place) => self.once(place),
                Node::Group(index) => self.group(index),
            }
        }
        for output in self.outputs {
            if self.below.found.made[output.index()].is_some() && !self.is_stored(*output) {
                self.load(*output);
            }
        }
        Some(self.rolled)
    }

    /// The turn of its loop in which a class makes a turn of its own.
    fn shift(&self, class: usize) -> i64 {
        let group = &self.below.groups[self.below.group_of[class]];
        group.members.iter().find(|(other, _)| *other == class).map_or(0, |(_, shift)| *shift)
    }

    /// Gives an array to every class of which a value is used elsewhere than in its own turn of its own loop.
    fn find_arrays(&mut self) {
        let Below { instructions, found, group_of, .. } = &self.below;
        let mut bounds: BTreeMap<(usize, bool), (i64, i64)> = BTreeMap::new();
        let mut need = |class: usize, second: bool, turn: i64| {
            let own = &found.classes[class];
            let slot = bounds.entry((class, second)).or_insert((own.from, own.to()));
            *slot = (slot.0.min(turn), slot.1.max(turn + 1));
        };
        for (index, class) in found.classes.iter().enumerate().filter(|(_, class)| !class.places.is_empty()) {
            for role in &class.roles {
                if let Role::Member(other, second, distance) = *role {
                    let is_local = group_of[other] == group_of[index]
                        && self.shift(index) == self.shift(other) + distance
                        && !class.aliases.iter().any(|alias| (alias.0, alias.1) == (other, second));
                    if !is_local {
                        need(other, second, class.from + distance);
                    }
                }
                if let Role::Outside(value) = role
                    && let Some((other, turn, second)) = found.made[value.index()]
                {
                    need(other, second, turn);
                }
            }
            class.aliases.iter().for_each(|(other, second, turn, _)| need(*other, *second, *turn));
        }
        for Instruction { result, operation } in *instructions {
            if found.made[result.index()].is_none() {
                for value in operation.operands() {
                    if let Some((class, turn, second)) = found.made[value.index()] {
                        need(class, second, turn);
                    }
                }
            }
        }
        for output in self.outputs {
            if let Some((class, turn, second)) = found.made[output.index()] {
                // Written by the loop itself where results and turns go together.
                if !self.is_stored(*output) {
                    need(class, second, turn);
                }
            }
        }
        for (key, (from, to)) in bounds {
            self.arrays.insert(key, (self.rolled.arrays.len(), from));
            self.rolled.arrays.push((to - from) as usize);
        }
    }

    /// Whether a loop writes a value to every result that it is.
    fn is_stored(&self, value: Value) -> bool {
        let Some((class, turn, second)) = self.below.found.made[value.index()] else { return false };
        let run = self.results.get(&(class, second));
        run.is_some_and(|run| self.outputs.get(run.at(turn) as usize) == Some(&value))
    }

    /// The steps in an order in which each comes behind what it needs: those that are not in loops as early as they may.
    fn order(&self) -> Option<Vec<Node>> {
        let results = self.outputs.iter().map(|output| self.below.node(*output));
        let nodes: Vec<Node> = (0..self.below.groups.len()).map(Node::Group).chain(results).collect();
        let mut done: BTreeMap<Node, bool> = BTreeMap::new();
        let mut order = Vec::new();
        for root in nodes {
            let mut stack = vec![(root, false)];
            while let Some((node, entered)) = stack.pop() {
                match done.get(&node) {
                    Some(true) => continue,
                    // It waits for itself.
                    Some(false) if !entered => return None,
                    _ => {}
                }
                if entered {
                    done.insert(node, true);
                    order.push(node);
                    continue;
                }
                done.insert(node, false);
                stack.push((node, true));
                for other in self.below.needed(node) {
                    match done.get(&other) {
                        Some(true) => {}
                        Some(false) => return None,
                        None => stack.push((other, false)),
                    }
                }
            }
        }
        Some(order)
    }

    fn load(&mut self, value: Value) {
        if let Some((class, turn, second)) = self.below.found.made[value.index()]
            && !std::mem::replace(&mut self.loaded[value.index()], true)
            && let Some((array, from)) = self.arrays.get(&(class, second))
        {
            self.rolled.steps.push(RolledStep::Load { array: *array, at: (turn - from) as usize, value });
        }
    }

    fn once(&mut self, place: usize) {
        let instruction = self.below.instructions[place].clone();
        // What the function is given stands where it is used.
        if matches!(instruction.operation, Operation::Symbol(_) | Operation::Prepared(_)) {
            return;
        }
        for value in instruction.operation.operands() {
            self.load(value);
        }
        self.rolled.steps.push(RolledStep::Once(instruction));
    }

    fn group(&mut self, index: usize) {
        let (instructions, found) = (self.below.instructions, self.below.found);
        let groups: &'a [Group] = self.below.groups;
        let group = &groups[index];
        let mut values = Vec::new();
        let mut stores = Vec::new();
        for (class, _) in &group.members {
            let class = &found.classes[*class];
            for (other, second, turn, value) in &class.aliases {
                values.push(*value);
                if let Some((array, from)) = self.arrays.get(&(*other, *second)) {
                    stores.push(RolledStep::Store {
                        array: *array,
                        at: (turn - from) as usize,
                        value: *value,
                    });
                }
            }
            for role in &class.roles {
                if let Role::Outside(value) = role {
                    values.push(*value);
                }
            }
        }
        values.into_iter().for_each(|value| self.load(value));
        let steps = &mut self.rolled.steps;
        for store in stores {
            if !steps.contains(&store) {
                steps.push(store);
            }
        }
        let (from, to) = turns(found, group);
        // Within a turn: what others of the same turn need comes first.
        let mut order: Vec<usize> = Vec::new();
        let mut left: Vec<usize> = group.members.iter().map(|member| member.0).collect();
        while let Some(at) = left.iter().position(|class| {
            needs(&found.classes[*class]).all(|(other, distance)| {
                !left.contains(&other) || self.shift(*class) != self.shift(other) + distance
            })
        }) {
            order.push(left.remove(at));
        }
        order.extend(left);
        let mut lines: Vec<Line> = Vec::new();
        for class in &order {
            let own = &found.classes[*class];
            let shift = self.shift(*class);
            let first = instructions[own.places[0]].operation.clone();
            let operands = own.roles.iter().map(|role| match *role {
                Role::Outside(value) => Operand::Outside(value),
                Role::Given(array, first, stride) => {
                    Operand::Given { array, first: (first + stride * own.from) as usize, stride }
                }
                Role::Member(other, second, distance) => match self.arrays.get(&(other, second)) {
                    Some((array, least))
                        if !(order.contains(&other)
                            && shift == self.shift(other) + distance
                            && !own.aliases.iter().any(|alias| (alias.0, alias.1) == (other, second))) =>
                    {
                        Operand::Element(*array, distance - shift - least)
                    }
                    _ => Operand::Line(
                        order.iter().position(|class| *class == other).unwrap_or(usize::MAX),
                        second,
                    ),
                },
            });
            let of = |second: bool| {
                let slot = self.arrays.get(&(*class, second));
                (slot.map(|(array, least)| (*array, -shift - least)), self.results.get(&(*class, second)))
            };
            let [(a, out_a), (b, out_b)] = match first {
                Operation::SinCos { .. } => [of(false), of(true)],
                _ => [of(false), (None, None)],
            };
            let shifted = |run: &Places| Places { origin: run.at(-shift), ..*run };
            let outputs = [out_a, out_b].map(|run| run.map(shifted));
            let operands = operands.collect();
            lines.push(Line { operation: first, operands, stores: [a, b], outputs });
        }
        self.rolled.steps.push(RolledStep::Loop(Loop { from, to, descends: group.descends, lines }));
    }
}
