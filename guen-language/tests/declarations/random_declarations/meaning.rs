//! What a declaration means, in numbers: its tree evaluated at one state, without the model, the algebra or the derivation.

use std::collections::BTreeMap;

use guen_language::syntax::{
    AddOperator, ClauseWord, Contact, Declaration, Equation, Expression, ExpressionKind, FunctionDefinition,
    Inertia, Item, MultiplyOperator, Order,
};

use super::analytic::Analytic;
use super::scalar::{Dual, Scalar};
use super::space::{
    Moving, Rigid, Value, Vector, added, applied, composed, cross, inner, quaternion, rates, spin, stretched,
    transposed, turn, velocity, zero,
};

/// All that is declared, at a state.
pub struct Meaning<R> {
    names: BTreeMap<String, Value<R>>,
    functions: BTreeMap<String, FunctionDefinition>,
    /// The places of the functions that the program supplies.
    supplied: BTreeMap<String, usize>,
    /// The values of forms by name, components apart; of constraints the left side less the right.
    pub forms: BTreeMap<String, R>,
    /// The left sides less the right ones of `holonomic`.
    pub positions: Vec<R>,
    pub kinetic_energy: R,
    pub force_function: R,
    /// Forces and what they act along.
    pub works: Vec<(R, R)>,
    /// The components of the outputs; those that depend on accelerations are not numbers.
    pub outputs: Vec<R>,
    /// Centers and orientations of the bodies, row by row, and the positions of the particles.
    poses: [Vec<R>; 2],
    /// What the latter are.
    pub asked: Vec<(usize, Asked)>,
    /// The rates of the states beside the motion.
    pub state_rates: Vec<R>,
    /// The functions of the switches.
    pub switches: Vec<R>,
    pub contacts: Vec<Touch<R>>,
    /// The function of each reset, with its new values.
    pub resets: Vec<(R, Vec<R>)>,
}

/// A contact, grip or latch; zero, or one for the condition of closing, for what is not written.
pub struct Touch<R> {
    pub name: String,
    pub gap: R,
    has_gap: bool,
    /// The velocities that vanish where it holds.
    pub rows: Vec<R>,
    pub friction: R,
    pub stiction: R,
    pub restitution: R,
    pub limit: R,
    /// The row whose reaction presses.
    pub load: Option<String>,
    pub when: R,
    pub release: R,
}

impl<R> Touch<R> {
    /// The velocities that vanish where it sticks.
    pub fn slips(&self) -> &[R] {
        &self.rows[usize::from(self.has_gap)..]
    }
}

/// An output that depends on accelerations.
#[derive(Clone)]
pub enum Asked {
    /// The rate of the component of another one.
    Along(usize),
    /// The reaction of an equation.
    Reaction(String),
}

/// The reason why there is no number.
pub type Missing = String;

impl<R: Analytic> Meaning<R> {
    /// At the time, with coordinates that have rates, and constants and inputs that have none.
    pub fn new(
        declaration: &Declaration,
        time: R,
        known: BTreeMap<String, Moving<R>>,
    ) -> Result<Self, Missing> {
        let rates = known.iter().map(|(name, value)| (format!("{name}_rate"), value.du.clone())).collect();
        let mut names: BTreeMap<String, Value<R>> =
            known.into_iter().map(|(name, value)| (name, Value::Scalar(value))).collect();
        names.insert("t".to_owned(), Value::Scalar(Dual { re: time, du: R::constant(1.0) }));
        names.insert("pi".to_owned(), Value::Scalar(Moving::constant(std::f64::consts::PI)));
        let nothing = R::constant(0.0);
        let mut meaning = Meaning {
            names,
            functions: BTreeMap::new(),
            supplied: BTreeMap::new(),
            // Rates of coordinates, in case they are chosen as parameters.
            forms: rates,
            positions: Vec::new(),
            kinetic_energy: nothing.clone(),
            force_function: nothing,
            works: Vec::new(),
            outputs: Vec::new(),
            poses: Default::default(),
            asked: Vec::new(),
            state_rates: Vec::new(),
            switches: Vec::new(),
            contacts: Vec::new(),
            resets: Vec::new(),
        };
        let gravity = meaning.gravity(declaration)?;
        for item in &declaration.items {
            meaning.read(item, gravity.as_ref())?;
        }
        Ok(meaning)
    }

    /// It may be declared after the bodies, and depends on constants and the time only.
    fn gravity(&self, declaration: &Declaration) -> Result<Option<Vector<R>>, Missing> {
        let gravity = declaration.items.iter().find_map(|item| match item {
            Item::Gravity(quantity) => Some(&quantity.value),
            _ => None,
        });
        gravity.map(|value| self.vector(value)).transpose()
    }

    fn read(&mut self, item: &Item, gravity: Option<&Vector<R>>) -> Result<(), Missing> {
        match item {
            Item::Count(_) => unreachable!("loops are written out"),
            Item::Let(definition) => {
                let value = self.value(&definition.value)?;
                self.names.insert(definition.name.text.clone(), value);
            }
            Item::Function(function) => {
                self.functions.insert(function.name.text.clone(), function.clone());
            }
            Item::Functions(section) => {
                let names = section.entries.iter().map(|function| function.name.text.clone());
                self.supplied = names.enumerate().map(|(place, name)| (name, place)).collect();
            }
            Item::Parameters(section) => {
                for definition in &section.entries {
                    let value = self.value(&definition.value)?;
                    self.form(&definition.name.text, value)?;
                }
            }
            Item::Constraints(section) => {
                for equation in &section.entries {
                    let value = self.difference(equation)?;
                    self.form(&equation.name.text, value)?;
                }
            }
            Item::Holonomic(section) => {
                for equation in &section.entries {
                    let value = self.difference(equation)?;
                    self.positions.extend(components(&value)?.into_iter().map(|e| e.re));
                    let rate = match value {
                        Value::Vector(v) => Value::Vector(rates(&v)),
                        other => Value::Scalar(velocity(scalar_of(&other)?.du)),
                    };
                    self.form(&equation.name.text, rate)?;
                }
            }
            Item::KineticEnergy(quantity) => {
                let energy = self.scalar(&quantity.value)?.re;
                self.kinetic_energy = self.kinetic_energy.plus(&energy);
            }
            Item::ForceFunction(quantity) => {
                let work = self.scalar(&quantity.value)?.re;
                self.force_function = self.force_function.plus(&work);
            }
            Item::PotentialEnergy(quantity) => {
                let energy = self.scalar(&quantity.value)?.re;
                self.force_function = self.force_function.minus(&energy);
            }
            Item::Particles(section) => {
                for particle in &section.entries {
                    let (mass, position) = (self.scalar(&particle.mass)?, self.vector(&particle.position)?);
                    self.weigh(&mass.re, &position, gravity);
                    self.poses[1].extend(position.iter().map(|e| e.re.clone()));
                }
            }
            Item::Bodies(section) => {
                for body in &section.entries {
                    let center = body.center.as_ref().map(|field| self.vector(&field.value)).transpose()?;
                    let orientation = match &body.orientation {
                        Some(field) => match self.value(&field.value)? {
                            Value::Rotation(m) => Some(m),
                            _ => return Err("an orientation that is no rotation".to_owned()),
                        },
                        None => None,
                    };
                    if let (Some(mass), Some(center)) = (&body.mass, &center) {
                        let mass = self.scalar(&mass.value)?.re;
                        self.weigh(&mass, center, gravity);
                    }
                    if let (Some(inertia), Some(m)) = (&body.inertia, &orientation) {
                        let own = applied(&transposed(m), &spin(m)).map(|e| e.re);
                        let moment = self.momentum(&inertia.value, &own)?;
                        let twice = (0..3).fold(R::constant(0.0), |e, i| e.plus(&own[i].times(&moment[i])));
                        self.kinetic_energy = self.kinetic_energy.plus(&twice.scaled(0.5));
                    }
                    let center_and_axes = center.iter().chain(orientation.iter().flatten()).flatten();
                    self.poses[0].extend(center_and_axes.map(|e| e.re.clone()));
                    let body_value = Value::Body(Box::new(Rigid { center, orientation }));
                    self.names.insert(body.name.text.clone(), body_value);
                }
            }
            Item::States(section) => {
                for state in &section.entries {
                    let rate = self.scalar(&state.rate)?.re;
                    self.state_rates.push(rate);
                }
            }
            Item::Forces(section) => {
                for force in &section.entries {
                    let along = components(&self.value(&force.direction)?)?;
                    let force = components(&self.value(&force.force)?)?;
                    self.works.extend(force.into_iter().zip(along).map(|(f, v)| (f.re, v.re)));
                }
            }
            Item::Outputs(section) => {
                for output in &section.entries {
                    if self.asks(&output.name.text) {
                        continue;
                    }
                    let value = self.value(&output.value)?;
                    self.outputs.extend(components(&value)?.into_iter().map(|e| e.re));
                    self.names.insert(output.name.text.clone(), value);
                }
            }
            // Numbers for constants and inputs are given; gravity is known.
            Item::Constants(_) | Item::Inputs(_) | Item::Coordinates(_) | Item::Gravity(_) => {}
            Item::Provide(_) | Item::Scene(_) => {}
            Item::Switches(section) => {
                for switch in &section.entries {
                    let function = self.scalar(&switch.value)?.re;
                    let is_on = if function.value() > 0.0 { 1.0 } else { 0.0 };
                    self.names.insert(switch.name.text.clone(), number(is_on));
                    self.switches.push(function);
                }
            }
            Item::Contacts(section) => {
                for contact in &section.entries {
                    let touch = self.touch(contact)?;
                    self.contacts.push(touch);
                }
            }
            Item::Resets(section) => {
                for reset in &section.entries {
                    let function = self.scalar(&reset.function)?.re;
                    let values = reset.assignments.iter().map(|given| Ok(self.scalar(&given.value)?.re));
                    let values = values.collect::<Result<Vec<R>, Missing>>()?;
                    self.resets.push((function, values));
                }
            }
            Item::Modes(_) => {}
            Item::Component(_) | Item::Use(_) | Item::Argument(_) => unreachable!("unfolded"),
        }
        Ok(())
    }

    /// Centers and orientations of the bodies, then the positions of the particles.
    pub fn placed(&self) -> Vec<R> {
        let [bodies, particles] = &self.poses;
        bodies.iter().chain(particles).cloned().collect()
    }

    /// Whether an output depends on accelerations, by its name.
    fn asks(&mut self, name: &str) -> bool {
        let first = self.outputs.len();
        if name == "moving_along" {
            let count = if matches!(self.names["moving"], Value::Vector(_)) { 3 } else { 1 };
            self.asked.extend((first..first + count).map(|place| (place, Asked::Along(place - count))));
            self.outputs.resize(first + count, R::constant(f64::NAN));
            return true;
        }
        let Some(equation) = name.strip_suffix("_reaction") else { return false };
        self.asked.push((first, Asked::Reaction(equation.to_owned())));
        self.outputs.push(R::constant(f64::NAN));
        true
    }

    /// The contact whose gap a row is the rate of, by the row's place among all.
    pub fn contact_of_row(&self, row: usize) -> Option<&String> {
        let mut first = 0;
        let gaps = self.contacts.iter().map(|touch| {
            first += touch.rows.len();
            (first - touch.rows.len(), touch)
        });
        let mut gaps = gaps.filter(|(_, touch)| touch.has_gap);
        gaps.find(|(first, _)| *first == row).map(|(_, touch)| &touch.name)
    }

    fn touch(&mut self, contact: &Contact) -> Result<Touch<R>, Missing> {
        let clause = |word: ClauseWord| contact.clause(word).map(|clause| &clause.value);
        let or = |word: ClauseWord, inside: &Self, missing: f64| match clause(word) {
            Some(e) => inside.scalar(e).map(|value| value.re),
            None => Ok(R::constant(missing)),
        };
        let name = &contact.name.text;
        let (mut gap, mut rows) = (R::constant(0.0), Vec::new());
        if let Some(e) = clause(ClauseWord::Gap).or(clause(ClauseWord::Latch)) {
            let value = self.scalar(e)?;
            gap = value.re.clone();
            rows.push(velocity(value.du.clone()).re);
            self.names.insert(format!("gap({name})"), Value::Scalar(value));
        }
        let has_gap = !rows.is_empty();
        let mut slips = Vec::new();
        if let Some(e) = clause(ClauseWord::Slip).or(clause(ClauseWord::Grip)) {
            let value = self.value(e)?;
            slips = components(&value)?.into_iter().map(|e| e.re).collect();
            // The plane of the slip is that of the first two axes.
            slips.truncate(2);
            self.names.insert(format!("slip({name})"), value);
        }
        let square = slips.iter().fold(R::constant(0.0), |sum, slip| sum.plus(&slip.times(slip)));
        let speed = if slips.is_empty() { Some(square) } else { square.function("sqrt") };
        rows.extend(slips);
        let mut sliding = self.beside();
        sliding.names.insert("speed".to_owned(), Value::Scalar(velocity(speed.ok_or("a speed")?)));
        let mut resting = self.beside();
        resting.names.insert("speed".to_owned(), number(0.0));
        let mut friction = or(ClauseWord::Friction, &sliding, 0.0)?;
        let mut stiction = match clause(ClauseWord::Stiction) {
            Some(_) => or(ClauseWord::Stiction, self, 0.0)?,
            None => or(ClauseWord::Friction, &resting, 0.0)?,
        };
        let mut limit = or(ClauseWord::Limit, self, 0.0)?;
        let load = clause(ClauseWord::Load).and_then(row_of);
        // The coefficient and the load of a grip are its limit, unless that is a reaction.
        if let Some(load) = clause(ClauseWord::Load).filter(|_| load.is_none()) {
            limit = friction.times(&self.scalar(load)?.re);
            (friction, stiction) = (R::constant(0.0), R::constant(0.0));
        }
        Ok(Touch {
            name: name.clone(),
            gap,
            has_gap,
            rows,
            friction,
            stiction,
            restitution: or(ClauseWord::Restitution, self, 0.0)?,
            limit,
            load,
            when: or(ClauseWord::When, self, 1.0)?,
            release: or(ClauseWord::Release, self, -1.0)?,
        })
    }

    fn form(&mut self, name: &str, value: Value<R>) -> Result<(), Missing> {
        match &value {
            Value::Vector(v) => {
                let (stem, index) = name.split_at(name.find('[').unwrap_or(name.len()));
                for (axis, e) in ["x", "y", "z"].iter().zip(v) {
                    let name = format!("{stem}_{axis}{index}");
                    self.forms.insert(name.clone(), e.re.clone());
                    self.names.insert(name, Value::Scalar(e.clone()));
                }
            }
            other => {
                self.forms.insert(name.to_owned(), scalar_of(other)?.re);
            }
        }
        self.names.insert(name.to_owned(), value);
        Ok(())
    }

    /// Kinetic energy and weight of a mass.
    fn weigh(&mut self, mass: &R, position: &Vector<R>, gravity: Option<&Vector<R>>) {
        let v = rates(position);
        let twice = mass.times(&inner(&v, &v).re);
        self.kinetic_energy = self.kinetic_energy.plus(&twice.scaled(0.5));
        if let Some(gravity) = gravity {
            let work = mass.times(&inner(gravity, position).re);
            self.force_function = self.force_function.plus(&work);
        }
    }

    /// `J omega` in the body's axes.
    fn momentum(&self, inertia: &Inertia, own: &[R; 3]) -> Result<[R; 3], Missing> {
        let read = |e: &Expression| self.scalar(e).map(|e| e.re);
        let none = R::constant(0.0);
        let matrix: [[R; 3]; 3] = match inertia {
            Inertia::Missing => return Err("no inertia".to_owned()),
            Inertia::Diagonal(entries) => {
                let [a, b, c] = &**entries;
                let (a, b, c) = (read(a)?, read(b)?, read(c)?);
                [[a, none.clone(), none.clone()], [none.clone(), b, none.clone()], [none.clone(), none, c]]
            }
            Inertia::Symmetric(entries) => {
                let entries: Result<Vec<R>, Missing> = entries.iter().map(read).collect();
                let at = entries?;
                [[0, 3, 5], [3, 1, 4], [5, 4, 2]].map(|row| row.map(|i: usize| at[i].clone()))
            }
        };
        Ok(matrix.map(|row| (0..3).fold(R::constant(0.0), |sum, i| sum.plus(&row[i].times(&own[i])))))
    }

    fn difference(&self, equation: &Equation) -> Result<Value<R>, Missing> {
        match (self.value(&equation.left)?, self.value(&equation.right)?) {
            (Value::Vector(a), Value::Vector(b)) => Ok(Value::Vector(added(&a, &b, -1.0))),
            // `0` stands for the zero vector.
            (Value::Vector(a), Value::Scalar(_)) => Ok(Value::Vector(a)),
            (Value::Scalar(_), Value::Vector(b)) => Ok(Value::Vector(b.map(|e| e.scaled(-1.0)))),
            (a, b) => Ok(Value::Scalar(scalar_of(&a)?.minus(&scalar_of(&b)?))),
        }
    }

    fn scalar(&self, e: &Expression) -> Result<Moving<R>, Missing> {
        scalar_of(&self.value(e)?)
    }

    fn vector(&self, e: &Expression) -> Result<Vector<R>, Missing> {
        match self.value(e)? {
            Value::Vector(v) => Ok(v),
            _ => Err(format!("`{e}` is no vector")),
        }
    }

    fn value(&self, e: &Expression) -> Result<Value<R>, Missing> {
        match &e.kind {
            ExpressionKind::Fold(_) => unreachable!("loops are written out"),
            ExpressionKind::Missing => Err("a hole".to_owned()),
            ExpressionKind::Number(number) => {
                let value: f64 = number.text.replace('_', "").parse().map_err(|_| format!("`{e}`"))?;
                Ok(Value::Scalar(Moving::constant(value)))
            }
            ExpressionKind::Name(name) => {
                self.names.get(&name.text).cloned().ok_or_else(|| format!("`{}`", name.text))
            }
            ExpressionKind::Negation(operand) => multiplied(&number(-1.0), &self.value(operand)?),
            ExpressionKind::Sum { first, rest } => {
                let mut sum = self.value(first)?;
                for term in rest {
                    let sign = if term.operator == AddOperator::Plus { 1.0 } else { -1.0 };
                    sum = match (&sum, self.value(&term.value)?) {
                        (Value::Vector(a), Value::Vector(b)) => Value::Vector(added(a, &b, sign)),
                        (a, b) => Value::Scalar(scalar_of(a)?.plus(&scalar_of(&b)?.scaled(sign))),
                    };
                }
                Ok(sum)
            }
            ExpressionKind::Product { first, rest } => self.product(first, rest),
            ExpressionKind::Power { base, exponent } => {
                let (base, exponent) = (self.scalar(base)?, self.scalar(exponent)?.value());
                let whole = exponent as i32;
                if f64::from(whole) == exponent {
                    return Ok(Value::Scalar(if whole == 0 {
                        Moving::constant(1.0)
                    } else {
                        base.power(whole)
                    }));
                }
                // x^a = exp(a ln x)
                let power = base.function("ln").and_then(|e| e.scaled(exponent).function("exp"));
                power.map(Value::Scalar).ok_or_else(|| "a power".to_owned())
            }
            ExpressionKind::Field { base, name } => self.field(&self.value(base)?, &name.text),
            ExpressionKind::Method { base, name, arguments, .. } => {
                let base = self.value(base)?;
                if let (Value::Body(body), "velocity_at", [p]) = (&base, &name.text[..], &arguments[..]) {
                    let v = body.velocity_at(&self.vector(p)?);
                    return v.map(Value::Vector).ok_or_else(|| "a body without a pose".to_owned());
                }
                let mut all = vec![base];
                for argument in arguments {
                    all.push(self.value(argument)?);
                }
                call(&name.text, &all)
            }
            ExpressionKind::Comparison { .. } => Err("a comparison alone".to_owned()),
            ExpressionKind::Call { function, arguments, .. } if function.text == "select" => {
                let ExpressionKind::Comparison { left, order, right } = &arguments[0].kind else {
                    return Err("a condition".to_owned());
                };
                let [a, b] = [left, right].map(|side| self.value(side).and_then(|value| scalar_of(&value)));
                let (a, b) = (a?.value(), b?.value());
                let holds = match order {
                    Order::AtLeast => a >= b,
                    Order::AtMost => a <= b,
                    Order::Above => a > b,
                    Order::Below => a < b,
                };
                self.value(&arguments[if holds { 1 } else { 2 }])
            }
            ExpressionKind::Call { function, arguments, .. }
                if ["gap", "slip"].contains(&function.text.as_str()) =>
            {
                let name = format!("{}({})", function.text, arguments[0]);
                self.names.get(&name).cloned().ok_or(name)
            }
            ExpressionKind::Call { function, arguments, .. } => {
                let all: Result<Vec<Value<R>>, Missing> = arguments.iter().map(|e| self.value(e)).collect();
                if let Some(place) = self.supplied.get(&function.text) {
                    return supplied(*place, &all?).map(Value::Scalar);
                }
                match self.functions.get(&function.text) {
                    Some(function) => self.called(function, all?),
                    None => call(&function.text, &all?),
                }
            }
        }
    }

    /// The expression of a function where its arguments have these values.
    fn called(&self, function: &FunctionDefinition, values: Vec<Value<R>>) -> Result<Value<R>, Missing> {
        let mut inside = self.beside();
        inside.names.extend(function.parameters.iter().map(|parameter| parameter.text.clone()).zip(values));
        inside.value(&function.value)
    }

    /// Names and functions alone, to which more can be added.
    fn beside(&self) -> Self {
        let nothing = R::constant(0.0);
        Meaning {
            names: self.names.clone(),
            functions: self.functions.clone(),
            supplied: self.supplied.clone(),
            forms: BTreeMap::new(),
            positions: Vec::new(),
            kinetic_energy: nothing.clone(),
            force_function: nothing,
            works: Vec::new(),
            outputs: Vec::new(),
            poses: Default::default(),
            asked: Vec::new(),
            state_rates: Vec::new(),
            switches: Vec::new(),
            contacts: Vec::new(),
            resets: Vec::new(),
        }
    }

    /// From the right, so that `a*R*v` is `a*(R*v)`; a quotient is a product with the reciprocal.
    fn product(
        &self,
        first: &Expression,
        rest: &[guen_language::syntax::Factor],
    ) -> Result<Value<R>, Missing> {
        let mut factors = vec![self.value(first)?];
        for factor in rest {
            let value = self.value(&factor.value)?;
            factors.push(match factor.operator {
                MultiplyOperator::Times => value,
                MultiplyOperator::Over => Value::Scalar(scalar_of(&value)?.reciprocal()),
            });
        }
        let mut product = factors.pop().ok_or_else(|| "an empty product".to_owned())?;
        for factor in factors.iter().rev() {
            product = multiplied(factor, &product)?;
        }
        Ok(product)
    }

    fn field(&self, base: &Value<R>, name: &str) -> Result<Value<R>, Missing> {
        let place = ["x", "y", "z"].iter().position(|axis| *axis == name);
        let found = match (base, name, place) {
            (Value::Vector(v), _, Some(i)) => Some(Value::Scalar(v[i].clone())),
            (Value::Rotation(m), _, Some(k)) => Some(Value::Vector([0, 1, 2].map(|i| m[i][k].clone()))),
            (Value::Body(body), "center", _) => body.center.clone().map(Value::Vector),
            (Value::Body(body), "orientation", _) => body.orientation.clone().map(Value::Rotation),
            (Value::Body(body), "angular_velocity", _) => {
                body.orientation.as_ref().map(|m| Value::Vector(spin(m)))
            }
            _ => None,
        };
        found.ok_or_else(|| format!("no `{name}`"))
    }
}

/// The row in `reaction(row)`.
pub fn row_of(load: &Expression) -> Option<String> {
    match &load.kind {
        ExpressionKind::Call { function, arguments, .. } if function.text == "reaction" => {
            Some(arguments[0].to_string())
        }
        _ => None,
    }
}

fn number<R: Analytic>(value: f64) -> Value<R> {
    Value::Scalar(Moving::constant(value))
}

fn scalar_of<R: Analytic>(value: &Value<R>) -> Result<Moving<R>, Missing> {
    match value {
        Value::Scalar(e) => Ok(e.clone()),
        _ => Err("a scalar is wanted".to_owned()),
    }
}

fn components<R: Analytic>(value: &Value<R>) -> Result<Vec<Moving<R>>, Missing> {
    match value {
        Value::Vector(v) => Ok(v.to_vec()),
        other => Ok(vec![scalar_of(other)?]),
    }
}

fn multiplied<R: Analytic>(a: &Value<R>, b: &Value<R>) -> Result<Value<R>, Missing> {
    Ok(match (a, b) {
        (Value::Scalar(a), Value::Scalar(b)) => Value::Scalar(a.times(b)),
        (Value::Scalar(a), Value::Vector(v)) | (Value::Vector(v), Value::Scalar(a)) => {
            Value::Vector(stretched(v, a))
        }
        (Value::Rotation(m), Value::Vector(v)) => Value::Vector(applied(m, v)),
        (Value::Rotation(a), Value::Rotation(b)) => Value::Rotation(composed(a, b)),
        _ => return Err("no product".to_owned()),
    })
}

/// The function that programs evaluate by numbers in place of one that nobody supplies: a sine of a sum with other factors for each
/// function and argument.
fn supplied<R: Analytic>(place: usize, arguments: &[Value<R>]) -> Result<Moving<R>, Missing> {
    let mut angle = Moving::constant((7 * place + 3) as f64 / 10.0);
    for (k, argument) in arguments.iter().enumerate() {
        let factor = (17 + 2 * k + place % 3) as f64 / 16.0;
        angle = angle.plus(&scalar_of(argument)?.scaled(factor));
    }
    angle.function("sin").ok_or_else(|| "a sine".to_owned())
}

fn call<R: Analytic>(name: &str, arguments: &[Value<R>]) -> Result<Value<R>, Missing> {
    let wrong = || format!("`{name}` of these");
    Ok(match (name, arguments) {
        ("dot", [Value::Scalar(e)]) => Value::Scalar(velocity(e.du.clone())),
        ("dot", [Value::Vector(v)]) => Value::Vector(rates(v)),
        ("vec", [x, y]) => Value::Vector([scalar_of(x)?, scalar_of(y)?, zero()]),
        ("vec", [x, y, z]) => Value::Vector([scalar_of(x)?, scalar_of(y)?, scalar_of(z)?]),
        ("inner", [Value::Vector(a), Value::Vector(b)]) => Value::Scalar(inner(a, b)),
        ("cross", [Value::Vector(a), Value::Vector(b)]) => Value::Vector(cross(a, b)),
        ("norm", [Value::Vector(v)]) => Value::Scalar(inner(v, v).function("sqrt").ok_or_else(wrong)?),
        ("unit", [Value::Vector(v)]) => {
            let length = inner(v, v).function("sqrt").ok_or_else(wrong)?;
            Value::Vector(stretched(v, &length.reciprocal()))
        }
        ("rot_x" | "rot_y" | "rot_z", [angle]) => {
            let axis = [0, 1, 2]
                .map(|i| Moving::constant(if ["rot_x", "rot_y", "rot_z"][i] == name { 1.0 } else { 0.0 }));
            Value::Rotation(turn(&axis, &scalar_of(angle)?).ok_or_else(wrong)?)
        }
        ("rot", [Value::Vector(axis), angle]) => {
            Value::Rotation(turn(axis, &scalar_of(angle)?).ok_or_else(wrong)?)
        }
        ("quaternion", [w, x, y, z]) => {
            let q = [scalar_of(w)?, scalar_of(x)?, scalar_of(y)?, scalar_of(z)?];
            Value::Rotation(quaternion(&q))
        }
        ("transpose", [Value::Rotation(m)]) => Value::Rotation(transposed(m)),
        ("angular_velocity", [Value::Rotation(m)]) => Value::Vector(spin(m)),
        ("angular_velocity_body", [Value::Rotation(m)]) => {
            Value::Vector(applied(&transposed(m), &spin(m)).map(|e| velocity(e.re)))
        }
        ("powi", [x, exponent]) => Value::Scalar(scalar_of(x)?.power(scalar_of(exponent)?.value() as i32)),
        ("atan2", [y, x]) => Value::Scalar(scalar_of(y)?.arc_tangent_2(&scalar_of(x)?)),
        ("min" | "max", [first, rest @ ..]) => {
            let mut found = scalar_of(first)?;
            for other in rest {
                let other = scalar_of(other)?;
                if (other.value() < found.value()) == (name == "min") {
                    found = other;
                }
            }
            Value::Scalar(found)
        }
        ("clamp", [x, low, high]) => {
            let (x, low, high) = (scalar_of(x)?, scalar_of(low)?, scalar_of(high)?);
            let above = if x.value() < low.value() { low } else { x };
            Value::Scalar(if above.value() > high.value() { high } else { above })
        }
        (_, [Value::Scalar(e)]) => Value::Scalar(e.function(name).ok_or_else(wrong)?),
        _ => return Err(wrong()),
    })
}
