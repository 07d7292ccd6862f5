//! Switches, contacts of every kind and resets of a drawn declaration.

use super::{Draw, NUMBERS, Text, is_smooth};

impl Text {
    /// The sections; a force depends on the switch, and outputs on the contacts. Every row moves a free coordinate of its own, so that
    /// none is a multiple of another.
    pub(super) fn contacts(&mut self, draw: &mut Draw) -> [String; 3] {
        let q = self.coordinates[draw.below(self.coordinates.len())].clone();
        let mut switch = format!("on: {};", self.signal(draw));
        if self.one_formula {
            switch.clear();
        }
        self.forces += &format!("(1/2 - {})*{q} along dot({q}); ", self.on());
        let mut leading = self.free.clone();
        let mut contacts = String::new();
        // What may press on a grip.
        let mut pressing: Vec<String> = Vec::new();
        for (kind, most) in [("wheel", 3), ("stop", 1), ("brake", 2), ("lock", 1)] {
            if leading.is_empty() || draw.once_in(3) {
                continue;
            }
            let rows = leading.split_off(leading.len() - most.min(leading.len()));
            contacts += &match kind {
                "brake" => {
                    pressing.extend(self.equations.iter().cloned());
                    self.grip(draw, &rows, &pressing)
                }
                "lock" => {
                    let (function, when, release) =
                        (self.gap(draw, &rows[0]), self.signal(draw), self.signal(draw));
                    format!("lock: latch = {function}, when = {when}, release = {release};\n")
                }
                _ => self.touch(draw, kind, &rows),
            };
            if kind == "stop" {
                pressing.push(kind.to_owned());
            }
        }
        let resets: String =
            (0..draw.between(1, 2)).map(|k| self.reset(draw, &format!("reset{k}"))).collect();
        [switch, contacts, resets]
    }

    /// The switch, or the number that it is everywhere.
    fn on(&self) -> &'static str {
        if self.one_formula { "2/3" } else { "on" }
    }

    /// A function that passes through zero, of everything but inputs.
    fn signal(&mut self, draw: &mut Draw) -> String {
        let q = self.coordinates[draw.below(self.coordinates.len())].clone();
        let (number, function) = (draw.pick(&NUMBERS), self.function(draw, 1));
        match (draw.below(4), self.states.first()) {
            (0, _) => format!("sin(3*t) + {number}*{q}"),
            (1, Some(state)) => format!("{state} - 1 + {q}*({function})"),
            (2, _) => format!("{q} - ({function})"),
            _ => format!("dot({q}) - {number}*({function})"),
        }
    }

    /// A function without kinks, at which velocities would jump.
    pub(super) fn smooth(&mut self, draw: &mut Draw) -> String {
        loop {
            let function = self.function(draw, 1);
            if is_smooth(&function) {
                return function;
            }
        }
    }

    /// A coordinate whose velocity does not depend on this one, or the time.
    fn other(&self, draw: &mut Draw, q: &str) -> String {
        let others: Vec<&String> = self.free.iter().filter(|other| *other != q).collect();
        others.get(draw.below(others.len().max(1))).map_or("t".to_owned(), |other| other.to_string())
    }

    fn gap(&mut self, draw: &mut Draw, q: &str) -> String {
        if self.one_formula && draw.once_in(2) {
            let other = self.other(draw, q);
            return format!("2*{q} - {}*sin({other}) + cos(t)/7", draw.pick(&NUMBERS));
        }
        let (number, function) = (draw.pick(&NUMBERS), self.smooth(draw));
        let height = match self.rigid.last() {
            Some((_, origin)) if draw.once_in(2) => format!(" + inner({origin}, vec(1/5, {number}, 1/3))"),
            _ => String::new(),
        };
        format!("2*{q} + {q}^3/5 + ({function})/4 - t/7{height}")
    }

    /// A velocity along a coordinate, and that of a point of a body.
    fn velocity(&mut self, draw: &mut Draw, q: &str) -> String {
        if self.one_formula && draw.once_in(2) {
            let other = self.other(draw, q);
            return format!("dot({q}) - cos({other})*dot({other}) + sin(t)");
        }
        let other = self.coordinates[draw.below(self.coordinates.len())].clone();
        let (number, function) = (draw.pick(&NUMBERS), self.function(draw, 1));
        match self.rigid.last() {
            Some((body, origin)) if draw.once_in(2) => format!(
                "(3 + sin({other}))*dot({q}) + inner({body}.velocity_at({origin} + vec(0, {number}, {q})), vec(1, 2, 2)/9)"
            ),
            _ => format!("(2 + tanh({function}))*dot({q}) + dot({other} - {number}*t)/5"),
        }
    }

    /// One velocity, or two as a vector.
    fn velocities(&mut self, draw: &mut Draw, along: &[String]) -> String {
        match along {
            [q] => self.velocity(draw, q),
            [first, second, ..] => {
                format!("vec({}, {})", self.velocity(draw, first), self.velocity(draw, second))
            }
            [] => unreachable!("a row has a coordinate"),
        }
    }

    fn touch(&mut self, draw: &mut Draw, name: &str, rows: &[String]) -> String {
        let mut clauses = format!("{name}: gap = {}", self.gap(draw, &rows[0]));
        // Of a rough contact it is a vector.
        let normal = if rows.len() > 1 { ".x" } else { "" };
        self.outputs +=
            &format!("{name}_gap = 3*gap({name});\n{name}_reaction = reaction({name}){normal};\n");
        if let along @ [_, ..] = &rows[1..] {
            let q = self.coordinates[0].clone();
            let slip = self.velocities(draw, along);
            let on = self.on();
            clauses += &format!(", slip = {slip}, friction = 3/10 + speed/(9 + speed) + {on}/7 + cos({q})/9");
            if draw.once_in(2) {
                clauses += &format!(", stiction = 7/10 + {on}*cos({q} - t)/9");
            }
            let component = if along.len() > 1 { ".y" } else { "" };
            self.outputs += &format!("{name}_slip = slip({name}){component}*{q};\n");
        }
        if draw.once_in(2) {
            clauses += &format!(", restitution = {}", draw.pick(&["1/2", "0.7", "e"]));
        }
        if draw.once_in(2) {
            clauses += &format!(", when = {}", self.signal(draw));
        }
        clauses + ";\n"
    }

    fn grip(&mut self, draw: &mut Draw, rows: &[String], pressing: &[String]) -> String {
        let velocity = self.velocities(draw, rows);
        let held = self.inputs.first().or(self.states.last()).unwrap_or(&self.coordinates[0]).clone();
        let q = self.coordinates[draw.below(self.coordinates.len())].clone();
        let limit = if draw.once_in(2) {
            let row = match pressing {
                [] => self.guide(draw),
                all => all[draw.below(all.len())].clone(),
            };
            format!("friction = 1/5 + 1/(3 + speed), load = reaction({row})")
        } else if draw.once_in(2) {
            format!("limit = 2 + {held}^2 + {}*dot({q})^2", self.on())
        } else {
            format!("friction = 1/5 + 1/(3 + speed), load = 3 + {held}^2*cos({q})")
        };
        format!("brake: grip = {velocity}, {limit};\n")
    }

    /// A further coordinate that a constraint moves.
    fn guide(&mut self, draw: &mut Draw) -> String {
        let q = self.coordinates[draw.below(self.coordinates.len())].clone();
        let (name, bound) = (self.fresh("guide"), self.bound("w"));
        let number = draw.pick(&NUMBERS);
        self.constraints += &format!("{name}: dot({bound}) = {number}*cos({q})*dot({q}) + {q}*t/5; ");
        self.equations.push(name.clone());
        name
    }

    fn reset(&mut self, draw: &mut Draw, name: &str) -> String {
        let variables = [&self.coordinates[..], &self.named, &self.states].concat();
        let held = self.inputs.first().or(self.states.last()).unwrap_or(&self.coordinates[0]).clone();
        let direction = draw.pick(&["rises", "falls"]);
        let mut text = format!("{name}: {} {direction}", self.signal(draw));
        for place in draw.permutation(variables.len()).into_iter().take(draw.between(1, 3)) {
            let (variable, other) = (&variables[place], &variables[draw.below(variables.len())]);
            let number = draw.pick(&NUMBERS);
            let function = self.function(draw, 1);
            text += &match draw.below(3) {
                0 => format!(", {variable} = -{number}*{other}"),
                1 => format!(", {variable} = {other} + {}*{held}*{number}", self.on()),
                _ => format!(", {variable} = {variable}/2 + ({function})*{held} - t/3"),
            };
        }
        text + ";\n"
    }
}
