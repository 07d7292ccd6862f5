//! Mechanisms drawn at random, as somebody would declare one who errs now and then: bodies on joints of every kind, rolling
//! wheels, closed loops; with massless links, joints in one place, parallel axes, inertias that no body has, equations that say
//! the same twice.

use super::draw::Draw;

/// A declaration in parts; the bounds of its constants are chosen when it is written.
#[derive(Default)]
pub struct Mechanism {
    made: usize,
    constants: Vec<String>,
    inputs: Vec<String>,
    coordinates: Vec<String>,
    /// Coordinates that no equation has taken the freedom of.
    free: Vec<String>,
    lets: String,
    parameters: String,
    holonomic: String,
    constraints: String,
    bodies: String,
    particles: String,
    forces: String,
    /// A spring.
    spring: String,
    /// All joints turn about `y`, and all points are in one plane.
    planar: bool,
    /// Mistakes are made.
    careless: bool,
}

/// Where a joint can be: an orientation, a point, and the coordinates on the way there.
#[derive(Clone)]
struct JointPlace {
    turn: String,
    point: String,
    way: Vec<String>,
}

const NUMBERS: [&str; 6] = ["1", "2", "1/2", "0.7", "2/3", "5/4"];

impl Mechanism {
    fn fresh(&mut self, letter: &str) -> String {
        self.made += 1;
        format!("{letter}{}", self.made)
    }

    fn constant(&mut self, letter: &str) -> String {
        let name = self.fresh(letter);
        self.constants.push(name.clone());
        name
    }

    fn coordinate(&mut self, letter: &str) -> String {
        let name = self.fresh(letter);
        self.coordinates.push(name.clone());
        self.free.push(name.clone());
        name
    }

    /// A length: mostly a constant.
    fn length(&mut self, draw: &mut Draw) -> String {
        match draw.below(4) {
            0 => draw.pick(&NUMBERS).to_owned(),
            1 if !self.constants.is_empty() => {
                let known: Vec<&String> = self.constants.iter().filter(|c| c.starts_with('l')).collect();
                known.first().map_or_else(|| "1".to_owned(), |name| name.to_string())
            }
            _ => self.constant("l"),
        }
    }

    /// A point of a body, in its axes.
    fn offset(&mut self, draw: &mut Draw) -> String {
        if self.careless && draw.once_in(4) {
            return "vec(0, 0, 0)".to_owned();
        }
        let (a, b) = (self.length(draw), draw.pick(&["0", "0", "1/2"]));
        match draw.below(3) {
            0 => format!("vec({a}, 0, {b})"),
            1 if !self.planar => format!("vec(0, {a}, {b})"),
            _ => format!("vec({b}, 0, -{a})"),
        }
    }

    /// Turns by an angle about an axis of the mechanism.
    fn turn(&self, draw: &mut Draw, angle: &str) -> String {
        match draw.below(8) {
            _ if self.planar => format!("rot_y({angle})"),
            0 => format!("rot(unit(vec(1, 2, 2)), {angle})"),
            1 => format!("rot(unit(vec(0, 1, -1)), {angle})"),
            2 => format!("rot_x({angle})"),
            3 | 4 => format!("rot_y({angle})"),
            _ => format!("rot_z({angle})"),
        }
    }

    fn quaternion(&mut self, draw: &mut Draw) -> (String, Vec<String>) {
        let way: Vec<String> = (0..4).map(|_| self.fresh("e")).collect();
        self.coordinates.extend(way.iter().cloned());
        let q = format!("quaternion({})", way.join(", "));
        let squares: Vec<String> = way.iter().map(|e| format!("{e}^2")).collect();
        let (length, spin, axes) = (self.fresh("unit"), self.fresh("spin"), draw.pick(&["", "_body"]));
        self.holonomic += &format!("{length}: {} = 1; ", squares.join(" + "));
        self.parameters += &format!("{spin} = angular_velocity{axes}({q}); ");
        (q, way)
    }

    /// A body, or what somebody takes for one.
    fn body(&mut self, draw: &mut Draw, place: &JointPlace) -> String {
        let name = self.fresh("B");
        if self.careless && draw.once_in(5) {
            // A link without mass.
            return name;
        }
        let mass = match draw.below(10) {
            0 => draw.pick(&NUMBERS).to_owned(),
            1 if self.careless => "0".to_owned(),
            2 if self.careless => "-1/3".to_owned(),
            _ => self.constant("m"),
        };
        let offset = self.offset(draw);
        let center = if draw.once_in(3) {
            place.point.clone()
        } else {
            format!("{} + {}*{offset}", place.point, place.turn)
        };
        if draw.once_in(5) {
            self.particles += &format!("{mass} at {center}; ");
            return name;
        }
        let inertia = match draw.below(9) {
            0 if self.careless => "diag(0, 0, 0)".to_owned(),
            1 if self.careless => format!("diag({}, 0, 0)", self.constant("J")),
            2 if self.careless => "diag(1, 1, 5)".to_owned(),
            3 => {
                let [a, b] = [0; 2].map(|_| self.constant("J"));
                format!("sym(2 + {a}, 2 + {b}, 3, 0.2, -0.3, 1/4)")
            }
            4 | 5 => {
                let [a, b] = [0; 2].map(|_| self.constant("J"));
                format!("diag({a}, {b}, {a})")
            }
            _ => {
                let [a, b, c] = [0; 3].map(|_| self.constant("J"));
                format!("diag({a}, {b}, {c})")
            }
        };
        self.bodies += &format!(
            "{name} {{ mass: {mass}, inertia: {inertia}, center: {center}, orientation: {} }}\n",
            place.turn
        );
        if draw.once_in(4)
            && let Some(first) = self.coordinates.first().cloned()
        {
            let drag = self.constant("c");
            self.forces += &format!("-{drag}*dot({first}) along dot({first}); ");
        }
        name
    }

    /// A joint on a body: the place that it carries.
    fn joint(&mut self, draw: &mut Draw, on: &JointPlace) -> JointPlace {
        let offset = self.offset(draw);
        let name = self.fresh("P");
        let (mut point, mut way) = (format!("{} + {}*{offset}", on.point, on.turn), on.way.clone());
        let count = if self.planar { 6 } else { 11 };
        let turn = match draw.below(count) {
            0 => {
                let s = self.coordinate("s");
                point += &format!(" + {s}*{}*vec(4/5, 0, -3/5)", on.turn);
                way.push(s);
                on.turn.clone()
            }
            1 if self.careless => on.turn.clone(),
            // A screw, a cylindrical joint.
            6 => {
                let q = self.coordinate("q");
                point += &format!(" + {}*{q}*{}.z", self.length(draw), on.turn);
                way.push(q.clone());
                format!("{}*rot_z({q})", on.turn)
            }
            7 => {
                let [q, s] = ["q", "s"].map(|letter| self.coordinate(letter));
                point += &format!(" + {s}*{}.z", on.turn);
                way.extend([q.clone(), s]);
                format!("{}*rot_z({q})", on.turn)
            }
            8 => {
                let [a, b] = [0; 2].map(|_| self.coordinate("q"));
                way.extend([a.clone(), b.clone()]);
                format!("{}*rot_x({a})*rot_y({b})", on.turn)
            }
            9 if self.coordinates.len() < 6 => {
                let (q, four) = self.quaternion(draw);
                way.extend(four);
                format!("{}*{q}", on.turn)
            }
            _ => {
                let q = self.coordinate("q");
                way.push(q.clone());
                format!("{}*{}", on.turn, self.turn(draw, &q))
            }
        };
        self.lets += &format!("let R{name} = {turn};\nlet o{name} = {point};\n");
        JointPlace { turn: format!("R{name}"), point: format!("o{name}"), way }
    }

    /// What everything stands on: the ground, a body that floats, one that rolls, a cart on wheels.
    fn base(&mut self, draw: &mut Draw) -> JointPlace {
        let name = self.fresh("P");
        let mut way = Vec::new();
        let (turn, point) = match draw.below(10) {
            0 if self.planar => {
                let [x, z, q] = ["x", "z", "q"].map(|letter| self.coordinate(letter));
                way.extend([x.clone(), z.clone(), q.clone()]);
                (format!("rot_y({q})"), format!("vec({x}, 0, {z})"))
            }
            0 => {
                let [x, y, z] = ["x", "y", "z"].map(|letter| self.coordinate(letter));
                let (q, four) = self.quaternion(draw);
                way.extend([x.clone(), y.clone(), z.clone()]);
                way.extend(four);
                (q, format!("vec({x}, {y}, {z})"))
            }
            1 | 2 if !self.planar => return self.disc(draw),
            3 | 4 if !self.planar => return self.cart(draw),
            // A platform that is moved.
            5 => ("rot_y(sin(t)/2)".to_owned(), "vec(cos(t)/3, 0, t/4)".to_owned()),
            _ => ("rot_z(0)".to_owned(), "vec(0, 0, 0)".to_owned()),
        };
        self.lets += &format!("let R{name} = {turn};\nlet o{name} = {point};\n");
        let place = JointPlace { turn: format!("R{name}"), point: format!("o{name}"), way };
        if !place.way.is_empty() {
            self.body(draw, &place);
        }
        place
    }

    /// A disc that rolls on the plane.
    fn disc(&mut self, draw: &mut Draw) -> JointPlace {
        let [name, touch] = ["B", "touch"].map(|letter| self.fresh(letter));
        let [x, y] = ["x", "y"].map(|letter| self.coordinate(letter));
        self.free.clear();
        let [yaw, lean, roll] = [0; 3].map(|_| self.coordinate("q"));
        let (radius, mass, a, c) =
            (self.length(draw), self.constant("m"), self.constant("J"), self.constant("J"));
        let upright = format!("rot_z({yaw})*rot_x({lean})");
        self.lets += &format!(
            "let R{name} = {upright}*rot_y({roll});\nlet o{name} = vec({x}, {y}, 0) + {radius}*({upright}).z;\n"
        );
        self.bodies += &format!(
            "{name} {{ mass: {mass}, inertia: diag({a}, {c}, {a}), center: o{name}, orientation: R{name} }}\n"
        );
        self.constraints += &format!("{touch}: {name}.velocity_at(vec({x}, {y}, 0)) = 0; ");
        JointPlace { turn: format!("R{name}"), point: format!("o{name}"), way: Vec::new() }
    }

    /// A cart on two wheels: neither slips along, one of them not across either; a careless one says it of both.
    fn cart(&mut self, draw: &mut Draw) -> JointPlace {
        let name = self.fresh("B");
        let [x, y] = ["x", "y"].map(|letter| self.coordinate(letter));
        let yaw = self.coordinate("q");
        let (half, radius) = (self.length(draw), self.length(draw));
        self.lets += &format!("let R{name} = rot_z({yaw});\nlet o{name} = vec({x}, {y}, {radius});\n");
        let place = JointPlace { turn: format!("R{name}"), point: format!("o{name}"), way: Vec::new() };
        self.body(draw, &place);
        let mut taken = vec![y, x];
        for (side, sign) in [("left", "+"), ("right", "-")] {
            let (wheel, rolls, grips) = (self.fresh("W"), self.fresh("rolls"), self.fresh("grips"));
            let roll = self.coordinate("q");
            let [mass, a, c] = ["m", "J", "J"].map(|letter| self.constant(letter));
            let hub = format!("o{name} {sign} {half}*R{name}.y");
            self.bodies += &format!(
                "{wheel} {{ mass: {mass}, inertia: diag({a}, {c}, {a}), center: {hub}, orientation: R{name}*rot_y({roll}) }}\n"
            );
            let at = format!("{wheel}.velocity_at({hub} - vec(0, 0, {radius}))");
            self.constraints += &format!("{rolls}: inner({at}, R{name}.x) = 0; ");
            self.free.retain(|q| *q != roll);
            if side == "left" || self.careless && draw.once_in(2) {
                self.constraints += &format!("{grips}: inner({at}, R{name}.y) = 0; ");
                if let Some(lost) = taken.pop() {
                    self.free.retain(|q| *q != lost);
                }
            }
        }
        place
    }

    /// Holds a point of the mechanism in place.
    fn close(&mut self, draw: &mut Draw, place: &JointPlace) {
        let rows = if self.planar { 2 } else { 3 };
        let mut taken: Vec<String> = place.way.iter().filter(|q| self.free.contains(q)).cloned().collect();
        if taken.len() <= rows {
            return;
        }
        taken.drain(..taken.len() - rows);
        self.free.retain(|q| !taken.contains(q));
        let offset = self.offset(draw);
        let closed = self.fresh("closed");
        let tip = format!("{} + {}*{offset}", place.point, place.turn);
        let held = if draw.once_in(2) { "vec(1, 0, 1/2)" } else { "vec(3/2, 0, 0)" };
        if self.planar {
            for axis in ["x", "z"] {
                self.holonomic += &format!("{closed}{axis}: ({tip} - {held}).{axis} = 0; ");
            }
        } else {
            self.holonomic += &format!("{closed}: {tip} = {held}; ");
        }
        if self.careless && draw.once_in(3) {
            let again = self.fresh("again");
            self.holonomic += &format!("{again}: 2*({tip}).x = 2*({held}).x; ");
            self.free.pop();
        }
    }

    /// The declaration, with bounds on those constants of which this is true.
    pub fn text(&self, is_bounded: impl Fn(usize) -> bool) -> String {
        let bound =
            |(i, name): (usize, &String)| if is_bounded(i) { format!("{name} > 0") } else { name.clone() };
        let mut constants: Vec<String> = self.constants.iter().enumerate().map(bound).collect();
        constants.push("g = 9.81".to_owned());
        let rates: String = self.free.iter().map(|q| format!("v_{q} = dot({q}); ")).collect();
        let section = |word: &str, entries: &str| {
            if entries.is_empty() { String::new() } else { format!("{word} {{ {entries} }}\n") }
        };
        format!(
            "system Mechanism {{\nconstants {{ {} }}\n{}{}{}{}{}{}{}{}{}{}gravity = vec(0, 0, -g);\n}}",
            constants.join(", "),
            section("inputs", &self.inputs.join(", ")),
            section("coordinates", &self.coordinates.join(", ")),
            self.lets,
            section("holonomic", &self.holonomic),
            section("bodies", &self.bodies),
            section("constraints", &self.constraints),
            section("particles", &self.particles),
            section("parameters", &(self.parameters.clone() + &rates)),
            section("forces", &self.forces),
            self.spring,
        )
    }

    /// How many constants could have bounds.
    pub fn constants(&self) -> usize {
        self.constants.len()
    }
}

/// A mechanism; the same for the same seed.
pub fn drawn(seed: u64) -> Mechanism {
    let mut draw = Draw::new(seed ^ 0x6d65_6368);
    let draw = &mut draw;
    let mut mechanism =
        Mechanism { planar: draw.once_in(2), careless: draw.once_in(3), ..Mechanism::default() };
    let mut places = vec![mechanism.base(draw)];
    for _ in 0..draw.between(1, 4) {
        // Mostly on the last one: chains.
        let on = if draw.once_in(3) { draw.below(places.len()) } else { places.len() - 1 };
        let place = mechanism.joint(draw, &places[on].clone());
        mechanism.body(draw, &place);
        places.push(place);
    }
    if draw.once_in(3)
        && let Some(place) = places.last().cloned()
    {
        mechanism.close(draw, &place);
    }
    if draw.once_in(3)
        && let Some(q) = mechanism.coordinates.last().cloned()
    {
        let stiffness = mechanism.constant("k");
        mechanism.spring = format!("potential_energy = {stiffness}/2*({q} - 1/3)^2;\n");
    }
    if draw.once_in(3) {
        let push = mechanism.fresh("u");
        let along = mechanism.coordinates.first().cloned();
        mechanism.forces += &along.map_or(String::new(), |q| format!("{push} along dot({q}); "));
        mechanism.inputs.push(push);
    }
    mechanism
}
