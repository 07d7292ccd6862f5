//! Straight-line programs as the text of Rust statements.
//!
//! Code is assembled as text and read by the compiler once: that is several times faster than quoting
//! thousands of tokens. Paths go through `__guen`, the alias of the facade's private module.

use std::fmt::Write;

use guen_symbolic::{Function, Instruction, Multivariate, Operation, Rational, SymbolId, Value};

use super::unpacked::Unpacked;
use crate::emit::layouts::supplied::steps as steps_to;
use crate::emit::thresholds::{ANGLE_STEPS, BLOCK_STATEMENTS, LONGEST_IN_PLACE, SPARSE_RESULTS};

/// The name of the functions that the program supplies, a tuple.
pub(super) const SUPPLIED: &str = "functions";

/// The values of symbols in a program: an expression of Rust for each.
pub(super) trait Loads {
    /// The place of a symbol's value.
    fn symbol(&self, symbol: SymbolId) -> String;

    /// The number of functions that the program supplies.
    fn functions(&self) -> usize;
}

/// The way in which the parts of a long body stand.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Parts {
    /// Blocks: a caller with the registers of lanes has all of them.
    Blocks,
    /// Closures, each of which has a frame of its own in a build without optimisation. The numbers that hold three derivatives with
    /// bounds of their roundings are so long that the frame of 600 statements takes 2.7 MB.
    Closures,
}

/// The body of a function: its statements, then its results as an array. Values are called `v0`, `v1`, ..; loads, and
/// what one operation alone uses, stand where they are used. `length` says how long an array is that the function takes.
///
/// Long programs are cut into blocks that hand on what later ones need. Every `let` opens a lexical scope inside the
/// one before, and the compiler's code for debug information recurses over them: five thousand in a row overflow its
/// stack.
pub(super) fn body(
    instructions: &[Instruction],
    outputs: &[Value],
    loads: &dyn Loads,
    parts: Parts,
    length: impl Fn(&str) -> usize,
) -> String {
    let values = instructions.iter().flat_map(Instruction::defined).map(|v| v.index() + 1).max().unwrap_or(0);
    let uses = uses(instructions, outputs, values);
    let loaded: Vec<String> = instructions.iter().filter_map(|step| load(step, loads)).collect();
    let unpacked = Unpacked::new(loaded.iter().map(String::as_str), length);
    let mut writer = Writer {
        names: vec![String::new(); values],
        is_operation: vec![false; values],
        in_place: vec![false; values],
        absorbed: absorbed(instructions, &uses),
        functions: loads.functions(),
        text: String::new(),
    };
    // Where each value is used last; results count as used behind the end.
    let mut last_use = vec![0; values];
    let mut steps: Vec<&Instruction> =
        instructions.iter().filter(|i| !writer.load(i, loads, &unpacked)).collect();
    steps.retain(|step| writer.absorbed[step.result.index()].is_none());
    bring_angles_together(&mut steps, &writer.absorbed);
    bring_derivatives_together(&mut steps);
    for (place, step) in steps.iter().enumerate() {
        for operand in step.operation.operands() {
            last_use[operand.index()] = place;
            if let Some((a, b)) = writer.absorbed[operand.index()] {
                last_use[a.index()] = place;
                last_use[b.index()] = place;
            }
        }
    }
    // Results stand inside of the only block, or behind all of several.
    let is_short = steps.len() <= BLOCK_STATEMENTS;
    for output in outputs {
        last_use[output.index()] = if is_short { steps.len() } else { usize::MAX };
    }
    // Blocks hand on names only.
    let ends = if is_short { vec![steps.len() + 1] } else { block_ends(&steps, BLOCK_STATEMENTS) };
    let block = |place: usize| ends.partition_point(|end| *end <= place);
    for (place, step) in steps.iter().enumerate() {
        let r = step.result.index();
        writer.in_place[r] = uses[r] == 1 && block(last_use[r]) == block(place);
    }
    if is_short {
        writer.statements(&steps);
    } else {
        let mut start = 0;
        for end in ends {
            let block = &steps[start..end];
            start = end;
            let handed: Vec<String> = block
                .iter()
                .flat_map(|step| step.defined())
                .filter(|value| last_use[value.index()] >= end)
                .map(|value| format!("v{},", value.index()))
                .collect();
            let handed = handed.concat();
            let (open, close) = match parts {
                Parts::Blocks => ("", ""),
                Parts::Closures => ("(|| ", ")()"),
            };
            let _ = write!(writer.text, "let ({handed}) = {open}{{");
            writer.statements(block);
            let _ = write!(writer.text, "({handed}) }}{close};");
        }
    }
    let names: Vec<&str> = outputs.iter().map(|output| writer.names[output.index()].as_str()).collect();
    // Where the program supplies functions, `k` holds them beside the values.
    let place = |array: &str| match array {
        "k" if loads.functions() > 0 => "&k.values".to_owned(),
        array => array.to_owned(),
    };
    unpacked.statements(place) + &writer.text + &results(&names)
}

/// Results as an array: one by one, or where there are many and most are the same value, as in a sparse matrix, that value and the others.
fn results(names: &[&str]) -> String {
    let mut text = String::new();
    // The first zero of a matrix is not far from its beginning.
    let common = names.iter().take(3).max_by_key(|name| names.iter().filter(|other| other == name).count());
    if let Some(common) = common.filter(|_| names.len() > SPARSE_RESULTS) {
        let others: Vec<(usize, &&str)> =
            names.iter().enumerate().filter(|(_, name)| *name != common).collect();
        if 4 * others.len() < names.len() {
            let _ = write!(text, "let mut o = [{common}; {}];", names.len());
            for (place, name) in others {
                let _ = write!(text, "o[{place}] = {name};");
            }
            text.push('o');
            return text;
        }
    }
    let _ = write!(text, "[{}]", names.join(","));
    text
}

/// Returns the number of uses of each value.
fn uses(instructions: &[Instruction], outputs: &[Value], values: usize) -> Vec<usize> {
    let mut uses = vec![0; values];
    for value in instructions.iter().flat_map(|i| i.operation.operands()).chain(outputs.iter().copied()) {
        uses[value.index()] += 1;
    }
    uses
}

/// The factors of products that have no statement of their own, by value: those that one sum uses and nothing else.
/// The sum is written as a call that lets the real fuse both; of two products the first.
fn absorbed(instructions: &[Instruction], uses: &[usize]) -> Vec<Option<(Value, Value)>> {
    let mut factors = vec![None; uses.len()];
    let mut absorbed = vec![None; uses.len()];
    for Instruction { result, operation } in instructions {
        match *operation {
            Operation::Mul(a, b) => factors[result.index()] = Some((a, b)),
            Operation::Add(a, b) | Operation::Sub(a, b) => {
                let product = |v: &Value| uses[v.index()] == 1 && factors[v.index()].is_some();
                if let Some(v) = [a, b].into_iter().find(product) {
                    absorbed[v.index()] = factors[v.index()];
                }
            }
            _ => {}
        }
    }
    absorbed
}

/// Moves sines and cosines behind others on which their angle does not depend, with the few steps that compute the
/// angle, so that two and two have one statement.
fn bring_angles_together(steps: &mut [&Instruction], absorbed: &[Option<(Value, Value)>]) {
    let is_angle = |step: &Instruction| matches!(step.operation, Operation::SinCos { .. });
    let mut place = 0;
    while place < steps.len() {
        let found = is_angle(steps[place])
            .then(|| {
                let later = (place + 1..steps.len()).filter(|other| is_angle(steps[*other]));
                later.into_iter().find_map(|other| Some((other, needed(steps, place, other, absorbed)?)))
            })
            .flatten();
        if let Some((partner, needed)) = found {
            for step in needed {
                steps[place..=step].rotate_right(1);
                place += 1;
            }
            steps[place + 1..=partner].rotate_right(1);
            place += 1;
        }
        place += 1;
    }
}

/// The ends of blocks of so many statements; what one evaluation computes stays together.
fn block_ends(steps: &[&Instruction], statements: usize) -> Vec<usize> {
    let mut ends = Vec::new();
    let mut end = 0;
    while end < steps.len() {
        end = (end + statements).min(steps.len());
        while end < steps.len() && is_one_evaluation(steps[end - 1], steps[end]) {
            end += 1;
        }
        ends.push(end);
    }
    ends
}

/// Moves derivatives of a function that the program supplies behind the first one with the same arguments: one evaluation
/// computes all of them.
fn bring_derivatives_together(steps: &mut [&Instruction]) {
    let mut place = 0;
    while place < steps.len() {
        let first = steps[place];
        place += 1;
        while matches!(first.operation, Operation::Apply(Multivariate::Supplied { .. }, _))
            && let Some(other) = steps[place..].iter().position(|other| is_one_evaluation(first, other))
        {
            steps[place..=place + other].rotate_right(1);
            place += 1;
        }
    }
}

/// Whether two instructions are derivatives of one function that the program supplies at the same arguments.
fn is_one_evaluation(a: &Instruction, b: &Instruction) -> bool {
    match (&a.operation, &b.operation) {
        (
            Operation::Apply(Multivariate::Supplied { function, .. }, arguments),
            Operation::Apply(Multivariate::Supplied { function: other, .. }, others),
        ) => function == other && arguments == others,
        _ => false,
    }
}

/// The way from the result of an evaluation with derivatives up to an order to one of them.
fn derivative(order: usize, orders: &[u8]) -> String {
    let arguments = orders.iter().enumerate();
    let tangents =
        arguments.flat_map(|(i, count)| std::iter::repeat_n(format!(".tangent[{i}]"), (*count).into()));
    let tangents: Vec<String> = tangents.collect();
    let values = ".value".repeat(order - tangents.len());
    format!("{values}{}", tangents.concat())
}

/// The steps between two that the later one needs, in their order; `None` if it needs the earlier one, or many.
fn needed(
    steps: &[&Instruction],
    first: usize,
    last: usize,
    absorbed: &[Option<(Value, Value)>],
) -> Option<Vec<usize>> {
    let operands = |step: &Instruction| -> Vec<Value> {
        let factors = |v: Value| absorbed[v.index()].map(|(a, b)| [a, b]);
        step.operation
            .operands()
            .flat_map(|v| [v].into_iter().chain(factors(v).into_iter().flatten()))
            .collect()
    };
    let mut values = operands(steps[last]);
    let mut found = Vec::new();
    for place in (first..last).rev() {
        if steps[place].defined().any(|value| values.contains(&value)) {
            if place == first || found.len() == ANGLE_STEPS {
                return None;
            }
            found.push(place);
            values.extend(operands(steps[place]));
        }
    }
    found.reverse();
    Some(found)
}

/// The place of a value that an instruction loads, if it is a load.
fn load(instruction: &Instruction, loads: &dyn Loads) -> Option<String> {
    match &instruction.operation {
        Operation::Symbol(symbol) => Some(loads.symbol(*symbol)),
        Operation::Prepared(k) => Some(format!("k[{k}]")),
        _ => None,
    }
}

struct Writer {
    /// The text of each value where it is used.
    names: Vec<String>,
    /// Whether that is an operation, which stands in parentheses beside an operator.
    is_operation: Vec<bool>,
    /// Whether it may be an expression: one place uses the value.
    in_place: Vec<bool>,
    /// The factors of products that are written inside of a sum.
    absorbed: Vec<Option<(Value, Value)>>,
    /// The number of functions that the program supplies.
    functions: usize,
    text: String,
}

impl Writer {
    /// Takes in a load, which needs no statement; tells whether it was one.
    fn load(&mut self, instruction: &Instruction, loads: &dyn Loads, unpacked: &Unpacked) -> bool {
        let name = load(instruction, loads).map(|name| unpacked.local(name));
        let is_load = name.is_some();
        for value in instruction.defined() {
            self.names[value.index()] = name.clone().unwrap_or_else(|| format!("v{}", value.index()));
        }
        is_load
    }

    fn statements(&mut self, mut steps: &[&Instruction]) {
        while let [step, rest @ ..] = steps {
            let derivatives = 1 + rest.iter().take_while(|other| is_one_evaluation(step, other)).count();
            if self.evaluation(&steps[..derivatives]) {
                steps = &steps[derivatives..];
                continue;
            }
            steps = match rest {
                [other, rest @ ..] if self.pair(step, other) => rest,
                _ => {
                    self.statement(step);
                    rest
                }
            };
        }
    }

    /// Writes one evaluation of a function that the program supplies, and a statement for each derivative; unless they are none.
    fn evaluation(&mut self, steps: &[&Instruction]) -> bool {
        let Operation::Apply(Multivariate::Supplied { function, .. }, arguments) = &steps[0].operation else {
            return false;
        };
        let orders = |step: &Instruction| match step.operation {
            Operation::Apply(Multivariate::Supplied { orders, .. }, _) => orders,
            _ => Default::default(),
        };
        let total = |step: &&Instruction| orders(step).iter().map(|count| usize::from(*count)).sum::<usize>();
        let order = steps.iter().map(total).max().unwrap_or(0);
        let given: Vec<&str> = arguments.iter().map(|v| self.names[v.index()].as_str()).collect();
        let names: Vec<usize> = steps.iter().map(|step| step.result.index()).collect();
        let first = names[0];
        let given = given.join(", ");
        // With a blank in front of every point: `0.1` would be a number.
        let place: Vec<String> =
            steps_to(usize::from(*function), self.functions).iter().map(|step| format!(".{step}")).collect();
        let place = place.join(" ");
        let _ =
            write!(self.text, "let d{first} = __guen::derivatives_{order}(&{SUPPLIED} {place}, [{given}]);");
        for (step, name) in steps.iter().zip(names) {
            let _ = write!(self.text, "let v{name} = d{first}{};", derivative(order, &orders(step)));
        }
        true
    }

    /// Writes one statement for two sines and cosines, unless they are none, or one is of the other.
    fn pair(&mut self, first: &Instruction, second: &Instruction) -> bool {
        let (Operation::SinCos { angle, cosine }, Operation::SinCos { angle: next, cosine: next_cosine }) =
            (&first.operation, &second.operation)
        else {
            return false;
        };
        if first.defined().any(|value| value == *next) {
            return false;
        }
        let _ = write!(
            self.text,
            "let ((v{}, v{}), (v{}, v{})) = R::sin_cos_pair({}, {});",
            first.result.index(),
            cosine.index(),
            second.result.index(),
            next_cosine.index(),
            self.names[angle.index()],
            self.names[next.index()],
        );
        true
    }

    fn statement(&mut self, Instruction { result, operation }: &Instruction) {
        let r = result.index();
        if let Operation::SinCos { angle, cosine } = operation {
            let angle = &self.names[angle.index()];
            let _ = write!(self.text, "let (v{r}, v{}) = R::sin_cos({angle});", cosine.index());
            return;
        }
        let (expression, is_operation) = self.expression(operation);
        if self.in_place[r] && expression.len() <= LONGEST_IN_PLACE {
            self.names[r] = expression;
            self.is_operation[r] = is_operation;
        } else {
            let _ = write!(self.text, "let v{r} = {expression};");
        }
    }

    /// The right-hand side of a statement with one result, and whether it is an operation and not a call.
    fn expression(&self, operation: &Operation) -> (String, bool) {
        let name = |value: &Value| self.names[value.index()].as_str();
        let operand = |value: &Value| match self.is_operation[value.index()] {
            true => format!("({})", name(value)),
            false => name(value).to_owned(),
        };
        let product = |value: &Value| self.absorbed[value.index()];
        let fused = |method: &str, [a, b, c]: [&Value; 3]| {
            (format!("R::{method}({}, {}, {})", name(a), name(b), name(c)), false)
        };
        let (sign, a, b) = match operation {
            Operation::Add(a, b) => match (product(a), product(b)) {
                (Some((x, y)), _) => return fused("times_plus", [&x, &y, b]),
                (_, Some((x, y))) => return fused("times_plus", [&x, &y, a]),
                _ => ('+', a, b),
            },
            Operation::Sub(a, b) => match (product(a), product(b)) {
                (Some((x, y)), _) => return fused("times_minus", [&x, &y, b]),
                (_, Some((x, y))) => return fused("minus_times", [a, &x, &y]),
                _ => ('-', a, b),
            },
            Operation::Mul(a, b) => ('*', a, b),
            Operation::Div(a, b) => ('/', a, b),
            Operation::Neg(a) => return (format!("-{}", operand(a)), true),
            Operation::Number(value) => return (number(value), false),
            Operation::Pi => return ("R::pi()".to_owned(), false),
            Operation::Call(function, a) => return (call(*function, name(a)), false),
            Operation::Apply(function, arguments) => {
                let arguments: Vec<String> = arguments.iter().map(|v| name(v).to_owned()).collect();
                return (apply(*function, &arguments), false);
            }
            // Loads have no statement, and a pair is no expression.
            Operation::Symbol(_) | Operation::Prepared(_) | Operation::SinCos { .. } => {
                return (String::new(), false);
            }
        };
        (format!("{} {sign} {}", operand(a), operand(b)), true)
    }
}

/// A call of a function of several arguments.
pub(super) fn apply(function: Multivariate, arguments: &[String]) -> String {
    let arguments = arguments.join(", ");
    match function {
        Multivariate::Minimum => format!("__guen::minimum({arguments})"),
        Multivariate::Maximum => format!("__guen::maximum({arguments})"),
        Multivariate::Select => format!("__guen::select({arguments})"),
        known => format!("R::{}({arguments})", known.name()),
    }
}

pub(super) fn call(function: Function, argument: &str) -> String {
    let name = match function {
        Function::Root(2) => "sqrt",
        Function::Root(q) => return format!("R::root({argument}, {q}u32)"),
        other => other.name(),
    };
    format!("R::{name}({argument})")
}

/// An exact number: a ratio of machine integers, or binary parts that reach beyond every real in use.
pub(super) fn number(value: &Rational) -> String {
    // Ratios of integers below 2^53 are rounded once by every real.
    if let Some((n, d)) = value.to_i64_pair() {
        return match (n, d) {
            (0, _) => "R::zero()".to_owned(),
            (1, 1) => "R::one()".to_owned(),
            _ => format!("R::from_ratio({n}, {d})"),
        };
    }
    let parts: Vec<String> = binary_parts(value).into_iter().map(|(m, e)| format!("({m}, {e})")).collect();
    format!("R::from_parts(&[{}])", parts.join(", "))
}

/// `value = sum m 2^e` in descending magnitude: first rounded to 53 bits, then remainders, 330 bits in all.
fn binary_parts(value: &Rational) -> Vec<(i64, i32)> {
    const BINARY_PARTS: usize = 6;
    let mut rest = value.clone();
    let mut parts = Vec::new();
    for _ in 0..BINARY_PARTS {
        if rest.is_zero() {
            break;
        }
        let (mantissa, exponent) = leading_part(&rest);
        let part = &Rational::integer(mantissa) * &power_of_two(exponent);
        rest = &rest - &part;
        parts.push((mantissa, exponent));
    }
    parts
}

/// The value rounded to 53 bits, ties to even.
pub(super) fn leading_part(value: &Rational) -> (i64, i32) {
    let (n, d) = value.abs().to_big_pair();
    // 2^52 <= |value| 2^-e < 2^54, then corrected to below 2^53.
    let mut exponent = n.bits() as i32 - d.bits() as i32 - 53;
    loop {
        let scaled = &value.abs() * &power_of_two(-exponent);
        let (sn, sd) = scaled.to_big_pair();
        // floor(value + 1/2), one less at a tie with an odd result.
        let doubled = (&sn << 1usize) + &sd;
        let divisor = &sd << 1usize;
        let rounded = &doubled / &divisor;
        let is_tie = (&doubled % &divisor).bits() == 0;
        if rounded.bits() <= 53 {
            let mut mantissa = i64::try_from(rounded).unwrap_or_default();
            if is_tie && mantissa % 2 != 0 {
                mantissa -= 1;
            }
            return (if value.is_negative() { -mantissa } else { mantissa }, exponent);
        }
        exponent += 1;
    }
}

fn power_of_two(exponent: i32) -> Rational {
    Rational::integer(2).powi(exponent).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn leading_parts_are_rounded_as_doubles() {
        for (digits, exponent, double) in [
            ("662607015", -42, 6.62607015e-34),
            ("1", 300, 1e300),
            ("123456789012345678901", -3, 123456789012345678.901),
        ] {
            let value = Rational::from_decimal(digits, exponent).unwrap();
            let (m, e) = leading_part(&value);
            assert_eq!(m as f64 * 2f64.powi(e), double, "{digits}e{exponent}");
            let sum: Rational =
                binary_parts(&value).into_iter().map(|(m, e)| &Rational::integer(m) * &power_of_two(e)).sum();
            let error = (&sum - &value).abs().to_f64() / value.to_f64();
            assert!(error < 1e-90, "{error}");
        }
    }

    /// The text of a right-hand side, without blanks and without the type of the functions.
    fn rates(declaration: &str) -> String {
        let text = crate::expand(declaration.parse().unwrap()).to_string();
        let text: String = text.split_whitespace().collect();
        let from = text.find("rhs(t;").unwrap();
        let to = from + text[from..].find("velocities(t;").unwrap();
        text[from..to].replace("R::", "")
    }

    #[test]
    fn angles_known_together_have_one_call_and_nested_ones_do_not() {
        let of = |potential: &str| {
            rates(&format!(
                "pub system S {{ coordinates {{ x, y }} parameters {{ u = dot(x); v = dot(y); }}
                 kinetic_energy = (u^2 + v^2)/2; potential_energy = {potential}; }}"
            ))
        };
        let together = of("sin(x)*cos(y)");
        assert!(together.contains("=sin_cos_pair(*s0,*s1)"), "{together}");
        assert_eq!(together.matches("sin_cos").count(), 1, "{together}");
        // The angle of the second is made first.
        let added = of("sin(x)*sin(x + 2*y)");
        assert!(added.contains("sin_cos_pair") && !added.contains("sin_cos("), "{added}");
        let nested = of("sin(sin(x))*y - cos(sin(x))");
        assert_eq!(
            (nested.matches("sin_cos(").count(), nested.matches("sin_cos_pair").count()),
            (2, 0),
            "{nested}"
        );
    }

    #[test]
    fn of_many_results_that_are_the_same_the_others_are_written() {
        let mut names = vec!["z"; 2_000];
        assert_eq!(results(&names[..3]), "[z,z,z]");
        (names[7], names[1_999]) = ("a", "b");
        assert_eq!(results(&names), "let mut o = [z; 2000];o[7] = a;o[1999] = b;o");
        names[..600].fill("a");
        assert!(results(&names).starts_with("[a,"));
    }

    #[test]
    fn a_product_in_one_sum_is_written_inside_of_it() {
        let rates = rates(
            "pub system S { coordinates { x, y } parameters { u = dot(x); v = dot(y); }
             kinetic_energy = (u^2 + v^2)/2; forces { 3*x*y + u along u; u - x*x along v; } }",
        );
        assert!(rates.contains("times_plus(") && rates.contains("minus_times("), "{rates}");
        assert!(!rates.contains('+') && !rates.contains("u-"), "{rates}");
    }
}
