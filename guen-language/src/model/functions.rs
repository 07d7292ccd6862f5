//! Calls, methods and components: which function takes what.

use guen_symbolic::{ExprId, Function, Rational, Role, Roles};
use proc_macro2::Span;

use super::accelerations::REACTION;
use super::evaluate::{Evaluated, Evaluator};
use super::expression_place::role_name;
use super::spatial::{cross, inner, plus};
use super::value::{BodyValue, Value, Vector};
use crate::diagnostics::Fault;
use crate::names;
use crate::syntax::{Expression, Name};

impl Evaluator<'_> {
    /// `function(arguments)`.
    pub(super) fn call(&mut self, function: &Name, arguments: &[Expression], list: Span) -> Evaluated {
        if function.text == REACTION && self.scope.category(REACTION).is_none() {
            return self.reaction(function, arguments, list);
        }
        if self.is_of_contact(function) && self.stands_below_contacts(arguments) {
            return self.of_contact(function, arguments, list);
        }
        if !names::is_function(&function.text) {
            return match self.declared_call(function, arguments, list) {
                Some(value) => value,
                None => self.not_a_function(function, arguments),
            };
        }
        if function.text == "select" {
            return self.select(function, arguments, list);
        }
        let mut values = Vec::new();
        for argument in arguments {
            values.push((self.value(argument), argument.span));
        }
        let values: Vec<(Value, Span)> =
            values.into_iter().map(|(v, span)| v.map(|v| (v, span))).collect::<Result<_, _>>()?;
        self.apply_function(function, values, list)
    }

    /// `base.name(arguments)`: the functions of scalars with the base as first argument, powers, or of a body.
    pub(super) fn method(
        &mut self,
        base: &Expression,
        name: &Name,
        arguments: &[Expression],
        list: Span,
    ) -> Evaluated {
        let mut values = vec![(self.value(base), base.span)];
        for argument in arguments {
            values.push((self.value(argument), argument.span));
        }
        let values: Vec<(Value, Span)> =
            values.into_iter().map(|(v, span)| v.map(|v| (v, span))).collect::<Result<_, _>>()?;
        if let (Value::Body(body), _) = &values[0] {
            let body = body.clone();
            return self.body_method(&body, name, &values[1..], list);
        }
        match name.text.as_str() {
            "powi" | "powf" => {
                self.check_count(name, 1, values.len() - 1, list)?;
                let ((base, base_span), (exponent, exponent_span)) = (values[0].clone(), values[1].clone());
                self.raised(base, exponent, base_span, exponent_span)
            }
            "recip" => {
                self.check_count(name, 0, values.len() - 1, list)?;
                let one = Value::Scalar(self.bench.graph.one());
                let (value, span) = values[0].clone();
                self.divided(one, value, name.span(), span)
            }
            text if names::is_function(text) && !matches!(text, "dot" | "select") => {
                self.apply_function(name, values, list)
            }
            text => {
                let mut fault = Fault::new(name.span(), format!("unknown method `{text}`"));
                if names::is_function(text) {
                    fault = fault.help(format!("it is a function, `{text}(..)`"));
                } else if let Some(near) =
                    names::nearest(text, names::SCALAR_FUNCTIONS.iter().copied().chain(["powi"]))
                {
                    fault = fault.help(format!("did you mean `{near}`?"));
                }
                self.fail(fault)
            }
        }
    }

    /// `base.name`: components of vectors, axes of rotations, values of bodies.
    pub(super) fn field(&mut self, base: &Expression, name: &Name) -> Evaluated {
        let value = self.value(base)?;
        let axis = ["x", "y", "z"].iter().position(|axis| *axis == name.text);
        match (&value, axis) {
            (Value::Vector(v), Some(i)) => {
                self.shapes.taken(&mut self.bench.graph, v, i);
                Ok(Value::Scalar(v[i]))
            }
            // The body's axes in the world are the columns of the matrix.
            (Value::Rotation(r), Some(i)) => Ok(Value::Vector(std::array::from_fn(|k| r.matrix[k][i]))),
            (Value::Body(body), _) => {
                let body = body.clone();
                self.body_field(&body, name)
            }
            (Value::Scalar(_), _) => self.fail(
                Fault::new(name.span(), format!("a scalar has no `{}`", name.text))
                    .help("components are of vectors, as in `vec(x, y).x`"),
            ),
            (other, None) => {
                let what = other.kind();
                self.fail(Fault::new(
                    name.span(),
                    format!("{what} has the components `x`, `y` and `z`, and no `{}`", name.text),
                ))
            }
        }
    }

    pub(super) fn not_a_function(&mut self, function: &Name, arguments: &[Expression]) -> Evaluated {
        let text = &function.text;
        let fault = if self.scope.category(text).is_some() {
            // A use all the same, so that nobody hears of it twice.
            let place = self.place.description(self.entry.as_deref());
            let _ = self.scope.look_up(self.faults, function, &place);
            let inside = if arguments.len() == 1 { arguments[0].source() } else { "..".to_owned() };
            Fault::new(function.span(), format!("`{text}` is not a function"))
                .help(format!("a product is written with `*`: `{text}*({inside})`"))
        } else if let Some(later) = self.scope.declared_later(text) {
            Fault::new(function.span(), format!("`{text}` is used before it is declared"))
                .note_place("declared", later)
                .help("move its declaration above this one")
        } else {
            let fault = Fault::new(function.span(), format!("unknown function `{text}`"));
            let own: Vec<String> = self.functions.names().map(str::to_owned).collect();
            let all = names::SCALAR_FUNCTIONS.iter().chain(names::SPATIAL_FUNCTIONS).copied();
            let all = all.chain(own.iter().map(String::as_str));
            if let Some(instead) = self.instead_of_contact(text).or_else(|| instead_of(text)) {
                return self.fail(fault.help(instead));
            }
            match function_synonym(text).or_else(|| names::nearest(text, all)) {
                Some(near) => fault.help(format!("did you mean `{near}`?")),
                None => fault.help(format!(
                    "the functions of scalars are {}",
                    names::quoted(names::SCALAR_FUNCTIONS.iter().copied())
                )),
            }
        };
        self.fail(fault)
    }

    fn check_count(&mut self, function: &Name, expected: usize, found: usize, list: Span) -> Evaluated<()> {
        if expected == found {
            return Ok(());
        }
        let plural = if expected == 1 { "" } else { "s" };
        let were = if found == 1 { "was" } else { "were" };
        let usage = usage(&function.text);
        let fault = Fault::new(
            list,
            format!("`{}` takes {expected} argument{plural}, and {found} {were} given", function.text),
        );
        self.fail(match usage {
            Some(usage) => fault.help(format!("write `{usage}`")),
            None => fault,
        })
    }

    fn apply_function(&mut self, function: &Name, values: Vec<(Value, Span)>, list: Span) -> Evaluated {
        let text = function.text.as_str();
        let simple = match text {
            "asin" => Some(Function::Asin),
            "acos" => Some(Function::Acos),
            "atan" => Some(Function::Atan),
            "sinh" => Some(Function::Sinh),
            "cosh" => Some(Function::Cosh),
            "tanh" => Some(Function::Tanh),
            "exp" => Some(Function::Exp),
            "ln" => Some(Function::Ln),
            "sqrt" => Some(Function::Root(2)),
            "abs" => Some(Function::Abs),
            "sign" => Some(Function::Sign),
            "floor" => Some(Function::Floor),
            _ => None,
        };
        if matches!(text, "min" | "max" | "clamp") {
            return self.extremum(function, &values, list);
        }
        let count = match text {
            "atan2" | "inner" | "cross" | "rot" => 2,
            "quaternion" => 4,
            "vec" if values.len() == 2 => 2,
            "vec" => 3,
            _ => 1,
        };
        self.check_count(function, count, values.len(), list)?;
        if let Some(simple) = simple {
            let x = self.scalar(function, &values[0])?;
            if let Some(number) = self.bench.graph.as_number(x) {
                let outside = match simple {
                    Function::Root(2) => number.is_negative(),
                    Function::Ln => number.is_negative() || number.is_zero(),
                    Function::Asin | Function::Acos => number.abs() > Rational::ONE,
                    _ => false,
                };
                if outside {
                    let number = number.clone();
                    let written = self.bench.graph.number(number);
                    let written = self.bench.graph.text(written);
                    return self
                        .fail(Fault::new(values[0].1, format!("`{text}` is not defined for `{written}`")));
                }
            }
            let value = self.bench.graph.function(simple, x);
            return self.check_size(value, function.span());
        }
        match text {
            "sin" | "cos" | "tan" | "cot" => {
                let x = self.scalar(function, &values[0])?;
                let (s, c) = self.bench.graph.sin_cos(x);
                Ok(Value::Scalar(match text {
                    "sin" => s,
                    "cos" => c,
                    "tan" => {
                        self.check_divisor(c, values[0].1)?;
                        self.bench.graph.div(s, c)
                    }
                    _ => {
                        self.check_divisor(s, values[0].1)?;
                        self.bench.graph.div(c, s)
                    }
                }))
            }
            "atan2" => {
                let (y, x) = (self.scalar(function, &values[0])?, self.scalar(function, &values[1])?);
                Ok(Value::Scalar(self.bench.graph.atan2(y, x)))
            }
            "dot" => self.rate_of(&values[0].0, values[0].1),
            "vec" => {
                let mut components: Vector = [self.bench.graph.zero(); 3];
                for (component, value) in components.iter_mut().zip(&values) {
                    *component = self.scalar(function, value)?;
                }
                Ok(Value::Vector(components))
            }
            "inner" => {
                let (u, v) = (self.vector(function, &values[0])?, self.vector(function, &values[1])?);
                let product = inner(&mut self.bench, &u, &v);
                self.shapes.inner(&mut self.bench.graph, &u, &v, product);
                self.check_size(product, function.span())
            }
            "cross" => {
                let (u, v) = (self.vector(function, &values[0])?, self.vector(function, &values[1])?);
                let product = cross(&mut self.bench, &u, &v);
                self.checked_vector(product, function.span())
            }
            "norm" | "unit" => {
                let v = self.vector(function, &values[0])?;
                let square = inner(&mut self.bench, &v, &v);
                let square = self.bench.tidy(square);
                self.shapes.inner(&mut self.bench.graph, &v, &v, square);
                let length = self.bench.graph.sqrt(square);
                self.shapes.length(&mut self.bench.graph, &v, length);
                if text == "norm" {
                    return Ok(Value::Scalar(length));
                }
                self.check_divisor(length, values[0].1)?;
                let unit = v.map(|e| self.bench.graph.div(e, length));
                let inverse = self.bench.graph.powi(length, -1);
                self.shapes.scaled(&mut self.bench.graph, inverse, &v, unit);
                Ok(Value::Vector(unit))
            }
            "rot_x" | "rot_y" | "rot_z" => {
                let angle = self.angle(function, &values[0])?;
                let (zero, one) = (self.bench.graph.zero(), self.bench.graph.one());
                let mut axis = [zero; 3];
                axis[usize::from(text.as_bytes()[4] - b'x')] = one;
                Ok(Value::Rotation(Box::new(self.turn(axis, angle))))
            }
            "rot" => {
                let axis = self.vector(function, &values[0])?;
                let angle = self.angle(function, &values[1])?;
                if axis.iter().any(|e| !self.bench.graph.roles(*e).is_constant()) {
                    return self.fail(
                        Fault::new(values[0].1, "the axis of a rotation depends on constants only")
                            .help("a turning axis is a product of rotations about fixed ones"),
                    );
                }
                let square = inner(&mut self.bench, &axis, &axis);
                let one = self.bench.graph.one();
                let difference = self.bench.graph.sub(square, one);
                if !self.bench.vanishes(difference) {
                    return self.fail(
                        Fault::new(values[0].1, "the axis of a rotation has unit length")
                            .help("write `unit(axis)`"),
                    );
                }
                Ok(Value::Rotation(Box::new(self.turn(axis, angle))))
            }
            "quaternion" => {
                let mut q = [self.bench.graph.zero(); 4];
                for (component, value) in q.iter_mut().zip(&values) {
                    *component = self.angle(function, value)?;
                }
                self.quaternions.push(q);
                Ok(Value::Rotation(Box::new(self.quaternion(q))))
            }
            "transpose" | "angular_velocity" | "angular_velocity_body" => match &values[0].0 {
                Value::Rotation(r) => Ok(match text {
                    "transpose" => Value::Rotation(Box::new(self.inverse(r))),
                    "angular_velocity" => Value::Vector(r.world_rate),
                    _ => Value::Vector(r.body_rate),
                }),
                other => {
                    let what = other.kind();
                    self.fail(Fault::new(
                        values[0].1,
                        format!("`{text}` takes a rotation, and this is {what}"),
                    ))
                }
            },
            _ => self.fail(Fault::new(function.span(), format!("unknown function `{text}`"))),
        }
    }

    /// `dot(e)`.
    fn rate_of(&mut self, value: &Value, span: Span) -> Evaluated {
        let moving = Roles::of(Role::Velocity).or(Roles::of(Role::QuasiVelocity));
        let without_rate = Roles::of(Role::Input).or(Roles::of(Role::QuasiAcceleration));
        let roles = value.expressions().iter().fold(Roles::NONE, |all, e| all.or(self.bench.graph.roles(*e)));
        let has_states = roles.has(Role::State);
        if has_states {
            self.known_rates(value, span)?;
        }
        let is_along_motion = if self.knows_motion() {
            roles.meets(moving) || has_states
        } else {
            has_states && !roles.meets(moving)
        };
        if is_along_motion && !roles.meets(without_rate) {
            match value {
                Value::Scalar(e) => {
                    let rate = self.measured_rate(*e);
                    return self.check_size(rate, span);
                }
                Value::Vector(v) => {
                    let rates = self.measured_rates(v);
                    return self.checked_vector(rates, span);
                }
                _ => {}
            }
        }
        if roles.meets(moving.or(without_rate)) {
            return self.fail(
                Fault::new(span, "`dot` is the rate of something that depends on time and coordinates only")
                    .note(format!("this contains {}", self.moving_kind(value))),
            );
        }
        match value {
            Value::Scalar(e) => {
                let rate = self.total_rate(*e);
                self.shapes.scalar_rate(&self.bench.graph, *e, rate);
                if self.knows_motion() {
                    self.shapes.rated(*e, rate);
                }
                Ok(Value::Scalar(rate))
            }
            Value::Vector(v) => Ok(Value::Vector(self.vector_rate(v))),
            other => {
                let what = other.kind();
                self.fail(
                    Fault::new(span, format!("`dot` takes a scalar or a vector, and this is {what}"))
                        .help("the rate of a rotation is `angular_velocity(R)`"),
                )
            }
        }
    }

    /// Refuses the rate of something with states whose own rates are declared further down.
    fn known_rates(&mut self, value: &Value, span: Span) -> Evaluated<()> {
        let symbols = self.bench.graph.symbols_in(&value.expressions());
        let graph = &self.bench.graph;
        let unknown = self.states.iter().filter(|(_, rate)| rate.is_none()).find_map(|(state, _)| {
            let symbol = graph.as_symbol(*state)?;
            symbols.contains(&symbol).then(|| graph.symbol_info(symbol).name.clone())
        });
        let Some(name) = unknown else { return Ok(()) };
        let fault = Fault::new(span, format!("the rate of `{name}` is used before it is declared"));
        self.fail(fault.help(format!("declare `dot({name})` above this, or write what it is")))
    }

    /// The first kind of symbol in a value that has no rate of its own.
    fn moving_kind(&self, value: &Value) -> String {
        let graph = &self.bench.graph;
        let symbols = graph.symbols_in(&value.expressions());
        [Role::QuasiAcceleration, Role::Velocity, Role::QuasiVelocity, Role::Input]
            .into_iter()
            .find_map(|role| {
                let symbol = symbols.iter().find(|s| graph.symbol_info(**s).role == role)?;
                let name = &graph.symbol_info(*symbol).name;
                Some(format!(
                    "{} `{name}`",
                    role_name(role).trim_start_matches("a ").trim_start_matches("an ")
                ))
            })
            .map_or_else(|| "a velocity".to_owned(), |text| format!("the {text}"))
    }

    fn body_field(&mut self, body: &BodyValue, name: &Name) -> Evaluated {
        match (name.text.as_str(), &body.center, &body.orientation) {
            ("center", Some((position, _)), _) => Ok(Value::Vector(*position)),
            ("orientation", _, Some(rotation)) => Ok(Value::Rotation(Box::new(rotation.clone()))),
            ("angular_velocity", _, Some(rotation)) => Ok(Value::Vector(rotation.world_rate)),
            ("velocity_at", ..) => self
                .fail(Fault::new(name.span(), "`velocity_at` takes a point").help("write `velocity_at(p)`")),
            ("center", ..) => {
                self.fail(Fault::new(name.span(), format!("body `{}` has no `center`", body.name)))
            }
            ("orientation" | "angular_velocity", ..) => {
                self.fail(Fault::new(name.span(), format!("body `{}` has no `orientation`", body.name)))
            }
            (other, ..) => self.fail(
                Fault::new(name.span(), format!("a body has no `{other}`"))
                    .help("a body has `center`, `orientation`, `angular_velocity` and `velocity_at(p)`"),
            ),
        }
    }

    /// `body.velocity_at(p)`: the velocity of the material point of the body that is at `p`.
    fn body_method(
        &mut self,
        body: &BodyValue,
        name: &Name,
        arguments: &[(Value, Span)],
        list: Span,
    ) -> Evaluated {
        if name.text != "velocity_at" {
            return match self.body_field(body, name) {
                Ok(_) => self.fail(Fault::new(list, format!("`{}` takes no arguments", name.text))),
                Err(reported) => Err(reported),
            };
        }
        self.check_count(name, 1, arguments.len(), list)?;
        let point = self.vector(name, &arguments[0])?;
        let (Some((position, velocity)), Some(rotation)) = (&body.center, &body.orientation) else {
            return self.fail(Fault::new(
                name.span(),
                format!(
                    "body `{}` needs a `center` and an `orientation` for the velocity of its points",
                    body.name
                ),
            ));
        };
        let back = self.opposite_vector(position);
        let arm = self.vector_sum(&point, &back);
        let turning = cross(&mut self.bench, &rotation.world_rate, &arm);
        let velocity = plus(&mut self.bench, velocity, &turning);
        self.shapes.velocity_at(&mut self.bench.graph, (position, rotation.frame), &arm, velocity);
        Ok(Value::Vector(velocity))
    }

    pub(super) fn scalar(&mut self, function: &Name, value: &(Value, Span)) -> Evaluated<ExprId> {
        match &value.0 {
            Value::Scalar(e) => Ok(*e),
            other => {
                let what = other.kind();
                self.fail(Fault::new(
                    value.1,
                    format!("`{}` takes a scalar here, and this is {what}", function.text),
                ))
            }
        }
    }

    fn vector(&mut self, function: &Name, value: &(Value, Span)) -> Evaluated<Vector> {
        match &value.0 {
            Value::Vector(v) => Ok(*v),
            other => {
                let what = other.kind();
                self.fail(Fault::new(
                    value.1,
                    format!("`{}` takes a vector here, and this is {what}", function.text),
                ))
            }
        }
    }

    /// A scalar of time and coordinates, as rotations take them.
    fn angle(&mut self, function: &Name, value: &(Value, Span)) -> Evaluated<ExprId> {
        let e = self.scalar(function, value)?;
        let moving = Roles::of(Role::Velocity).or(Roles::of(Role::QuasiVelocity)).or(Roles::of(Role::Input));
        let moving = moving.or(Roles::of(Role::State));
        if self.bench.graph.roles(e).meets(moving) {
            return self.fail(Fault::new(value.1, "a rotation depends on time and coordinates only"));
        }
        Ok(e)
    }
}

/// Returns what to write for a function of other languages that this one has not.
fn instead_of(text: &str) -> Option<&'static str> {
    Some(match text {
        "ite" | "ifelse" | "if_else" | "cond" | "Piecewise" | "piecewise" | "switch" => {
            "write `select(c >= 0, a, b)`: `a` where the comparison holds, `b` elsewhere"
        }
        "smoothstep" => "with `s = clamp((x - a)/(b - a), 0, 1)` it is `s^2*(3 - 2*s)`",
        "fmod" | "rem" | "remainder" => "the rest of a division by `b` is `x - b*floor(x/b)`",
        "ceil" => "write `-floor(-x)`",
        "round" => "write `floor(x + 1/2)`",
        "trunc" => "write `sign(x)*floor(abs(x))`",
        "fract" | "frac" => "write `x - floor(x)`",
        "saturate" | "sat" | "limit" => "write `clamp(x, low, high)`",
        "lambda" | "Lambda" | "Function" => "a function of one expression is declared by `fn name(x) = e;`",
        "interp"
        | "interp1"
        | "interp1d"
        | "interp2"
        | "lookup"
        | "lookup1"
        | "table"
        | "Table"
        | "CombiTable1D"
        | "CombiTable1Ds"
        | "CombiTable2Ds"
        | "spline"
        | "CubicSpline"
        | "cubic_spline"
        | "cubicspline"
        | "pchip"
        | "PchipInterpolator"
        | "akima"
        | "ppval"
        | "polyval"
        | "griddata"
        | "RegularGridInterpolator"
        | "Grid"
        | "lut"
        | "BSpline"
        | "interpolate"
        | "interpolant" => {
            "declare `functions { curve(x); }`, and give the field `curve` of the struct a `guen::Table` or `guen::Grid`"
        }
        "sec" => "write `1/cos(x)`",
        "csc" | "cosec" => "write `1/sin(x)`",
        "sech" => "write `1/cosh(x)`",
        "csch" => "write `1/sinh(x)`",
        "coth" => "write `1/tanh(x)`",
        "asinh" | "arcsinh" | "arsinh" => "write `ln(x + sqrt(x^2 + 1))`",
        "acosh" | "arccosh" | "arcosh" => "write `ln(x + sqrt(x^2 - 1))`",
        "atanh" | "arctanh" | "artanh" => "write `ln((1 + x)/(1 - x))/2`",
        "acot" | "arccot" => "write `pi/2 - atan(x)`",
        "pow" | "powf" | "powi" => "a power is written `x^2`",
        "square" | "sqr" => "a square is written `x^2`",
        "cbrt" => "a cube root is written `x^(1/3)`",
        "hypot" => "write `sqrt(x^2 + y^2)`",
        "log10" => "write `ln(x)/ln(10)`",
        "log2" => "write `ln(x)/ln(2)`",
        "heaviside" | "Heaviside" | "step" => "a step from 0 to 1 is `select(x >= 0, 1, 0)`",
        "norm2" => "the square of a vector's length is `inner(v, v)`",
        "diff" => "`dot(x)` is the rate of `x`; derivatives of the energies are the macro's work",
        "d" | "dt" | "ddt" | "der" | "derivative" => "the rate of `x` is written `dot(x)`",
        "ddot" => "`dot(x)` is the rate of `x`; accelerations are what the macro derives",
        _ => return None,
    })
}

/// Functions under the names of other languages.
fn function_synonym(text: &str) -> Option<&'static str> {
    Some(match text {
        "log" => "ln",
        "fmin" | "minimum" | "Min" => "min",
        "fmax" | "maximum" | "Max" => "max",
        "arcsin" => "asin",
        "arccos" => "acos",
        "arctan" => "atan",
        "ctg" | "cotan" => "cot",
        "tg" => "tan",
        "sgn" | "signum" => "sign",
        "vector" => "vec",
        "length" | "magnitude" => "norm",
        "normalize" => "unit",
        _ => return None,
    })
}

/// Returns the usage of a function whose arguments have an order that is worth saying.
fn usage(text: &str) -> Option<&'static str> {
    Some(match text {
        "atan2" => "atan2(y, x)",
        "vec" => "vec(x, y, z)` or, in the plane, `vec(x, y)",
        "inner" => "inner(u, v)",
        "cross" => "cross(u, v)",
        "rot" => "rot(axis, angle)",
        "quaternion" => "quaternion(w, x, y, z)",
        "velocity_at" => "body.velocity_at(point)",
        "powi" | "powf" => "x.powi(2)",
        _ => return None,
    })
}
