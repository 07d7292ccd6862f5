//! Declarations drawn at random: bodies and particles on joints of every kind, on each other and on moving bases, forces,
//! constraints of both kinds, parameters.

mod contacts;

use super::draw::Draw;
use super::functions::function;

/// A declaration that grows.
#[derive(Default)]
struct Text {
    made: usize,
    constants: Vec<String>,
    inputs: Vec<String>,
    coordinates: Vec<String>,
    /// Those that no equation binds so far.
    free: Vec<String>,
    lets: String,
    parameters: String,
    constraints: String,
    holonomic: String,
    /// Constraints that speak of bodies.
    after: String,
    bodies: String,
    particles: String,
    forces: String,
    outputs: String,
    /// Bodies, each with a point that it carries.
    rigid: Vec<(String, String)>,
    /// The parameters that are scalars and named.
    named: Vec<String>,
    /// The states beside the motion.
    states: Vec<String>,
    /// The equations of one component.
    equations: Vec<String>,
    /// Whether every function has one formula everywhere.
    one_formula: bool,
}

const NUMBERS: [&str; 8] = ["1", "2", "1/2", "3/10", "0.7", "1.5", "2/3", "5/4"];
const AXES: [&str; 3] = ["x", "y", "z"];

impl Text {
    fn fresh(&mut self, letter: &str) -> String {
        self.made += 1;
        format!("{letter}{}", self.made)
    }

    fn constant(&mut self) -> String {
        let name = self.fresh("k");
        self.constants.push(format!("{name} > 0"));
        name
    }

    fn coordinate(&mut self, letter: &str) -> String {
        let name = self.bound(letter);
        self.free.push(name.clone());
        name
    }

    /// A coordinate whose velocity a constraint or a spin gives.
    fn bound(&mut self, letter: &str) -> String {
        let name = self.fresh(letter);
        self.coordinates.push(name.clone());
        name
    }

    /// An orientation by a quaternion of length one.
    fn quaternion(&mut self, draw: &mut Draw) -> String {
        let [w, x, y, z] = [0; 4].map(|_| self.bound("e"));
        let (length, spin, axes) = (self.fresh("length"), self.fresh("spin"), draw.pick(&["", "_body"]));
        self.holonomic += &format!("{length}: {w}^2 + {x}^2 + {y}^2 + {z}^2 = 1; ");
        self.parameters += &format!("{spin} = angular_velocity{axes}(quaternion({w}, {x}, {y}, {z})); ");
        format!("quaternion({w}, {x}, {y}, {z})")
    }

    /// A ball or a thin disc that rolls on the plane, or on one that turns.
    fn rolling(&mut self, draw: &mut Draw) -> (String, String) {
        let (name, touch) = (self.fresh("B"), self.fresh("touch"));
        let [x, y] = [0; 2].map(|_| self.bound("p"));
        let [mass, a, b, radius] = [0; 4].map(|_| self.constant());
        let (rotation, center) = if draw.once_in(2) {
            (self.quaternion(draw), format!("vec({x}, {y}, {radius})"))
        } else {
            let [yaw, lean, roll] = [0; 3].map(|_| self.coordinate("q"));
            let mut upright = format!("rot_z({yaw})*rot_x({lean})");
            if self.made.is_multiple_of(2) {
                self.lets += &format!("fn upright{name}(turn, {lean}) = rot_z(turn)*rot_x({lean});\n");
                upright = format!("upright{name}({yaw}, {lean})");
            }
            (format!("{upright}*rot_y({roll})"), format!("vec({x}, {y}, 0) + {radius}*({upright}).z"))
        };
        self.lets += &format!("let R{name} = {rotation};\nlet o{name} = {center};\n");
        self.bodies += &format!(
            "{name} {{ mass: {mass}, inertia: diag({a}, {a} + {b}, {b}), center: o{name}, orientation: R{name} }}\n"
        );
        let moving = if draw.once_in(3) { format!("cos(t)/2*vec(-{y}, {x}, 0)") } else { "0".to_owned() };
        self.after += &format!("{touch}: {name}.velocity_at(vec({x}, {y}, 0)) = {moving}; ");
        (format!("R{name}"), format!("o{name}"))
    }

    /// Three links in a vertical plane that close a loop.
    fn loop_of_links(&mut self, draw: &mut Draw) {
        let [first, second, third] = [self.coordinate("q"), self.bound("r"), self.bound("r")];
        let [l, m, n, mass] = [0; 4].map(|_| self.constant());
        let (arm, closed) = (self.fresh("arm"), self.fresh("closed"));
        let (across, up) = draw.pick(&[("vec(1, 0, 0)", "vec(0, 0, 1)"), ("vec(1, 0)", "vec(0, 1)")]);
        let by_function = self.made.is_multiple_of(2);
        let link = |length: &str, angle: &str| {
            if by_function {
                format!("link{arm}({angle}, {length})")
            } else {
                format!("{length}*(cos({angle})*{across} + sin({angle})*{up})")
            }
        };
        if by_function {
            self.lets += &format!(
                "fn way{arm}(angle) = cos(angle)*{across} + sin(angle)*{up};\nfn link{arm}(angle, t_) = t_*way{arm}(angle);\n"
            );
        }
        self.lets += &format!("let {arm} = {} + {};\n", link(&l, &first), link(&m, &second));
        self.holonomic +=
            &format!("{closed}: {arm} = {}*{across} + {}; ", draw.pick(&NUMBERS), link(&n, &third));
        self.particles += &format!("{mass} at {arm}; ");
    }

    fn vector(&mut self, draw: &mut Draw) -> String {
        let mut entry = || match draw.below(5) {
            0 | 1 => "0".to_owned(),
            2 => self.constant(),
            _ => draw.pick(&NUMBERS).to_owned(),
        };
        format!("vec({}, {}, {})", entry(), entry(), entry())
    }

    /// A turn by one angle.
    fn turn(&mut self, draw: &mut Draw, angle: &str) -> String {
        let axis = draw.pick(&AXES);
        match draw.below(8) {
            // Two components of the spin are one expression.
            0..3 => format!("rot(unit(vec(1, 2, 2)), {angle})"),
            3 => format!("rot(unit(vec(0, 1, -1)), {angle})"),
            4 => format!("rot_{axis}({} - {angle})", draw.pick(&NUMBERS)),
            5 => format!("rot_{axis}(2*{angle} + t/3)"),
            _ => format!("rot_{axis}({angle})"),
        }
    }

    /// The pose of a body on another, or on the base where that is empty: orientation and origin.
    fn joint(&mut self, draw: &mut Draw, (around, origin): (&str, &str)) -> (String, String) {
        let turned = |by: &str| if around.is_empty() { by.to_owned() } else { format!("{around}*{by}") };
        let still = if around.is_empty() { "rot_z(0)" } else { around };
        let offset = self.vector(draw);
        let at = if draw.once_in(4) { origin.to_owned() } else { format!("{origin} + {}", turned(&offset)) };
        let large = self.coordinates.len() > 6;
        match draw.below(if large { 6 } else { 9 }) {
            0 => {
                let (s, pitch) = (self.coordinate("q"), self.constant());
                let up = turned("vec(0, 0, 1)");
                (turned(&format!("rot_z({s})")), format!("{at} + {pitch}*{s}*{up}"))
            }
            1 => {
                let s = self.coordinate("s");
                (still.to_owned(), format!("{at} + {s}*{}", turned("vec(3/5, 0, -4/5)")))
            }
            2 => {
                let (a, b) = (self.coordinate("q"), self.coordinate("q"));
                (turned(&format!("rot_x({a})*rot_y({b})")), at)
            }
            3 => {
                let q = self.coordinate("q");
                (turned(&format!("rot_{}(sin(t)/2)*rot_y({q})", draw.pick(&AXES))), at)
            }
            6 => {
                let [a, b, c] = [0; 3].map(|_| self.coordinate("q"));
                let last = draw.pick(&["y", "z"]);
                (turned(&format!("rot_z({a})*rot_x({b} + 4/5)*rot_{last}({c})")), at)
            }
            place @ (7 | 8) => {
                let q = self.quaternion(draw);
                let at = if place == 7 {
                    let [x, y, z] = [0; 3].map(|_| self.coordinate("s"));
                    format!("{at} + vec({x}, {y}, {z})")
                } else {
                    at
                };
                (turned(&q), at)
            }
            _ => {
                let q = self.coordinate("q");
                (turned(&self.turn(draw, &q)), at)
            }
        }
    }

    /// What is on a joint: a body, or particles that no turn leaves where they are.
    fn load(&mut self, draw: &mut Draw, name: &str, rotation: &str, origin: &str) {
        let away = self.vector(draw);
        let center =
            if draw.once_in(3) { origin.to_owned() } else { format!("{origin} + {rotation}*{away}") };
        if draw.once_in(3) {
            for place in ["vec(0.3, 0.4, 0.5)", "vec(-0.3, 0.7, 0.2)", "vec(0.9, -0.2, -0.6)"] {
                let mass = self.constant();
                self.particles += &format!("{mass} at {origin} + {rotation}*{place}; ");
            }
            return;
        }
        let [mass, a, b, c] = [0; 4].map(|_| self.constant());
        let inertia = if draw.once_in(2) {
            format!("diag({a} + {b}, {b} + {c}, {a} + {c})")
        } else {
            format!("sym(3 + {a}, 3 + {b}, 3 + {c}, 0.2, -0.3, {}/4)", draw.pick(&NUMBERS))
        };
        self.bodies += &format!(
            "{name} {{ mass: {mass}, inertia: {inertia}, center: {center}, orientation: {rotation} }}\n"
        );
        self.rigid.push((name.to_owned(), origin.to_owned()));
        if draw.once_in(3) {
            // A body need not turn, and a force along nothing is an error.
            let (drag, first) = (self.constant(), self.coordinates[0].clone());
            self.forces += &format!(
                "-{drag}*{name}.angular_velocity along {name}.angular_velocity + vec(0, 7/5*dot({first}), 0); "
            );
        }
        if draw.once_in(3) {
            let output = self.fresh("seen");
            self.outputs +=
                &format!("{output} = {name}.velocity_at({origin} + vec(1, 0, {}));\n", draw.pick(&NUMBERS));
        }
    }

    /// A coordinate that is no longer free.
    fn bind(&mut self, draw: &mut Draw) {
        let bound = self.free.swap_remove(draw.below(self.free.len()));
        let (a, b) =
            (self.free[draw.below(self.free.len())].clone(), self.free[draw.below(self.free.len())].clone());
        let (name, number) = (self.fresh("c"), draw.pick(&NUMBERS));
        self.equations.push(name.clone());
        match draw.below(6) {
            0 => self.constraints += &format!("{name}: dot({bound}) = {number}*cos({a})*dot({b}); "),
            1 => {
                self.constraints +=
                    &format!("{name}: dot({bound}) - {number}*dot({a})*(1 + {b}^2) + sin(t)/3 = 0; ");
            }
            2 => self.holonomic += &format!("{name}: {bound} = {number}*sin({a}) + {b}/4; "),
            3 => self.constraints += &format!("{name}: dot({bound}) = {b}*dot({a}) - {a}*dot({b}); "),
            4 => {
                self.constraints += &format!(
                    "{name}: dot({bound}) + tanh({a})*dot({a}) = exp({b}/3)*dot({b}) - atan2({a}, 2 + t^2); "
                );
            }
            _ => self.holonomic += &format!("{name}: {bound} + {bound}^3/10 = {number}*cos({a}) + t/5; "),
        }
    }

    /// States beside the motion, for every third declaration: a force and an output that depend on them, and a name above them. They are
    /// drawn apart, so that everything else is drawn as without them.
    fn states(&mut self, draw: &mut Draw) -> String {
        if !draw.once_in(3) {
            return String::new();
        }
        let names: Vec<String> = (0..draw.between(1, 3)).map(|k| format!("z{k}")).collect();
        let mut rates = String::new();
        for name in &names {
            let (number, q) =
                (draw.pick(&NUMBERS), self.coordinates[draw.below(self.coordinates.len())].clone());
            let other = names[draw.below(names.len())].clone();
            let mut rate = match draw.below(6) {
                0 => format!("{q} - {number}*t"),
                1 => format!("(dot({q}) - {name})/{number}"),
                2 => format!("{number}*sin({other}) - lag*{name}*dot({q})^2"),
                3 => format!("{other}*{q} - tanh({name}) + exp(-t)"),
                4 => format!("-{number}*{name} + {}", self.function(draw, 1)),
                _ => format!("{number}/(2 + {name}^2)"),
            };
            if let Some(input) = self.inputs.first().filter(|_| draw.once_in(2)) {
                rate += &format!(" + {input}*{other}");
            }
            rates += &format!("dot({name}) = {rate}; ");
        }
        self.states.clone_from(&names);
        let (last, q) = (names[names.len() - 1].clone(), self.coordinates[0].clone());
        self.lets += &format!("let lag = {} + {last}/7;\n", draw.pick(&NUMBERS));
        if draw.once_in(3) {
            self.outputs += &format!("lagging = lag*{};\n", names[0]);
        } else {
            self.forces += &format!("{} - lag*dot({q}) along dot({q}); ", names[0]);
        }
        rates
    }

    /// Functions that the program supplies: in a position, in an energy, in forces, in an equation and in an
    /// output. They are drawn apart, so that everything else is drawn as without them.
    fn supplied(&mut self, draw: &mut Draw) -> (String, String) {
        let [a, b] = [0; 2].map(|_| self.coordinates[draw.below(self.coordinates.len())].clone());
        let (heights, number) = (self.fresh("seen"), draw.pick(&NUMBERS));
        self.particles += &format!("{number} at vec({b}/3, ground({a}, 2*{b}), curve({a})); ");
        self.forces += &format!("curve(dot({a})) - ground({b}, t)*dot({a}) along dot({a}); ");
        self.outputs += &format!("{heights} = vec(dot(ground({a}, {b})), curve(curve({b})), 0);\n");
        if draw.once_in(2) {
            let (name, bound) = (self.fresh("h"), self.bound("w"));
            self.holonomic += &format!("{name}: {bound} = ground({a}, {b}) + curve(t); ");
        }
        let landscape = format!(" + ground(curve({b}), {a})/3");
        ("ground(across, along); curve(at);".to_owned(), landscape)
    }

    /// A function of some coordinates.
    fn function(&mut self, draw: &mut Draw, depth: usize) -> String {
        loop {
            let names = [0; 2].map(|_| self.coordinates[draw.below(self.coordinates.len())].clone());
            let found = function(draw, names.each_ref().map(|name| &name[..]), depth);
            if !self.one_formula
                || is_smooth(&found) && !["select(", "sign("].iter().any(|f| found.contains(f))
            {
                return found;
            }
        }
    }

    /// Outputs that depend on accelerations and reactions: the rate of another output, and the reaction of an equation. They are drawn apart, so
    /// that everything else is drawn as without them.
    fn asked(&mut self, draw: &mut Draw) {
        let q = self.coordinates[draw.below(self.coordinates.len())].clone();
        let number = draw.pick(&NUMBERS);
        if draw.once_in(2) {
            let moving = match (draw.below(3), self.rigid.last(), self.named.last()) {
                (0, Some((body, origin)), _) => {
                    format!(
                        "{body}.velocity_at({origin} + vec({q}, 0, {number})) + {body}.angular_velocity/3"
                    )
                }
                (1, _, Some(parameter)) => format!("{parameter}*cos(t) - {q}*dot({q})"),
                _ => format!("dot({q})*({})", self.smooth(draw)),
            };
            self.outputs += &format!("moving = {moving};\nmoving_along = dot({moving});\n");
        }
        // What a reaction of `|q| = 1` is depends on what `T` is off it, and so may others beside it.
        if !self.holonomic.contains("length")
            && let Some(equation) = self.equations.last()
            && draw.once_in(2)
        {
            self.outputs += &format!("{equation}_reaction = reaction({equation});\n");
        }
    }

    fn parameter(&mut self, draw: &mut Draw, q: &str) {
        let (name, number) = (self.fresh("v"), draw.pick(&NUMBERS));
        let other = self.free[draw.below(self.free.len())].clone();
        // Each has its own velocity with a coefficient that no other takes away.
        let parameter = match draw.below(8) {
            0 => format!("{name} = (2 + sin({other}))*dot({q}); "),
            3 => format!("{name} = (5 + tanh({}))*dot({q}); ", self.function(draw, 1)),
            1 => format!("{name} = dot({q}) - {number}*t; "),
            2 => format!("{name} = dot({q} + {q}^3/5 + t*{number}); "),
            _ => format!("{name} = dot({q}); "),
        };
        // Some are left out, and the macro chooses what completes the others.
        if !self.made.is_multiple_of(3) {
            self.parameters += &parameter;
            self.named.push(name);
        }
    }
}

/// Whether a function has no kinks.
fn is_smooth(function: &str) -> bool {
    !["abs(", "max(", "min(", "clamp("].iter().any(|kinked| function.contains(kinked))
}

/// A declaration; the same for the same seed.
pub fn drawn(seed: u64) -> String {
    written(seed, Parts::Motion)
}

/// The declaration of a seed, every third one with functions that the program supplies.
pub fn with_functions(seed: u64) -> String {
    written(seed, Parts::Functions)
}

/// The declaration of a seed with a switch, contacts and resets.
pub fn with_contacts(seed: u64) -> String {
    written(seed, Parts::ContactsAndResets)
}

/// The same without resets.
pub fn with_contacts_alone(seed: u64) -> String {
    written(seed, Parts::Contacts)
}

/// The same with functions of one formula everywhere, and without the switch.
pub fn with_contacts_of_one_formula(seed: u64) -> String {
    written(seed, Parts::ContactsOfOneFormula)
}

/// The declaration of a seed with functions of one formula everywhere.
pub fn of_one_formula(seed: u64) -> String {
    written(seed, Parts::OneFormula)
}

/// The sections of a drawn declaration that not every one has.
#[derive(PartialEq)]
enum Parts {
    Motion,
    OneFormula,
    Functions,
    Contacts,
    ContactsOfOneFormula,
    ContactsAndResets,
}

fn written(seed: u64, parts: Parts) -> String {
    let mut draw = Draw::new(seed);
    let draw = &mut draw;
    let mut text = Text {
        one_formula: [Parts::OneFormula, Parts::ContactsOfOneFormula].contains(&parts),
        ..Text::default()
    };
    let mut poses = vec![if draw.once_in(4) {
        (format!("rot_z({}*t)", draw.pick(&NUMBERS)), "vec(sin(t)/2, 0, 0)".to_owned())
    } else {
        (String::new(), "vec(0, 0, 0)".to_owned())
    }];
    if draw.once_in(5) {
        poses.push(text.rolling(draw));
    }
    if draw.once_in(6) {
        text.loop_of_links(draw);
    }
    for _ in 0..draw.between(1, 3) {
        let (around, origin) = poses[draw.below(poses.len())].clone();
        let (rotation, at) = text.joint(draw, (&around, &origin));
        let name = text.fresh("B");
        text.lets += &format!("let R{name} = {rotation};\nlet o{name} = {at};\n");
        let pose = (format!("R{name}"), format!("o{name}"));
        text.load(draw, &name, &pose.0, &pose.1);
        if draw.once_in(3) {
            let (push, along) = (text.fresh("u"), text.coordinates[0].clone());
            text.inputs.push(push.clone());
            text.forces += &format!(
                "{push}*vec(1, {}, 0) along dot({} + {along}*vec(0, 7/5, 0)); ",
                draw.pick(&NUMBERS),
                pose.1
            );
        }
        if draw.once_in(4) {
            let (drag, along) = (text.constant(), text.coordinates[0].clone());
            text.lets += &format!("fn drag{drag}(v) = -{drag}*norm(v + vec(0.1, 0.2, 0.3))*v;\n");
            text.forces += &format!("drag{drag}(dot({0})) along dot({0} + {along}*vec(7/5, 1, 0)); ", pose.1);
        }
        poses.push(pose);
    }
    for _ in 0..draw.below(3) {
        if text.free.len() > 1 {
            text.bind(draw);
        }
    }
    for q in text.free.clone() {
        text.parameter(draw, &q);
    }
    if draw.once_in(3) {
        let (name, value) = (text.fresh("seen"), text.function(draw, 2));
        text.outputs += &format!("{name} = vec({value}, 1, 0)/(1 + dot({})^2);\n", text.coordinates[0]);
    }
    if draw.once_in(3) {
        let (push, along) = (text.function(draw, 2), text.coordinates[0].clone());
        let step = if text.one_formula { "sin" } else { draw.pick(&["abs", "sign", "floor", "2*abs"]) };
        text.forces += &format!("({push})*{step}(dot({along})) along dot({along}); ");
    }
    let states = text.states(&mut Draw::new(seed.rotate_left(23)));
    let landscape = text.function(draw, 2);
    let mut apart = Draw::new(seed.rotate_left(41));
    let (supplied, further) = if parts == Parts::Functions && apart.once_in(3) {
        text.supplied(&mut apart)
    } else {
        Default::default()
    };
    let [switches, contacts, resets] = match parts {
        Parts::Motion | Parts::OneFormula | Parts::Functions => Default::default(),
        _ => text.contacts(&mut Draw::new(seed.rotate_left(51))),
    };
    text.asked(&mut Draw::new(seed.rotate_left(33)));
    let resets = if parts == Parts::ContactsAndResets { resets } else { String::new() };
    // Every coordinate has some inertia.
    let sluggish: Vec<String> = text.coordinates.iter().map(|q| format!("dot({q})^2/20")).collect();
    // The momentum of a constraint.
    let leaning = match text.constraints.split_once(':') {
        Some((name, _)) => format!(" + {name}*dot({})/7 + {name}^2/9", text.coordinates[0]),
        None => String::new(),
    };
    let spring = &text.coordinates[draw.below(text.coordinates.len())];
    let bouncing = if contacts.is_empty() { "" } else { ", e in 0..1" };
    let section = |word: &str, entries: &str| {
        if entries.is_empty() { String::new() } else { format!("{word} {{ {entries} }}\n") }
    };
    let sections = [
        section("functions", &supplied),
        section("inputs", &text.inputs.join(", ")),
        section("coordinates", &text.coordinates.join(", ")),
        text.lets.clone(),
        section("parameters", &text.parameters),
        section("holonomic", &text.holonomic),
        section("bodies", &text.bodies),
        section("constraints", &(text.constraints + &text.after)),
        section("states", &states),
        section("particles", &text.particles),
        section("switches", &switches),
        section("contacts", &contacts),
        section("resets", &resets),
        section("forces", &text.forces),
        section("outputs", &text.outputs),
    ];
    format!(
        "system Drawn{seed} {{\nconstants {{ {}{bouncing} }}\n{}kinetic_energy = {};\npotential_energy = 3/4*{spring}^2 + {landscape}{further};\n\
         gravity = vec(0, 1/5, -g);\n}}",
        [&text.constants[..], &["g = 9.81".to_owned()]].concat().join(", "),
        sections.concat(),
        sluggish.join(" + ") + &leaning,
    )
}
