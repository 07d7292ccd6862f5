//! The right-hand side as a text of C, for `provide source;`: the same straight-line programs, a statement for each operation.

use std::collections::BTreeSet;
use std::fmt::Write;

use guen_symbolic::{
    Function, Instruction, Multivariate, Operation, Rational, SeriesProgram, SymbolId, Value,
};
use proc_macro2::TokenStream;
use quote::quote;

use super::code::{Loads, leading_part};
use super::functions::Places;
use super::series::{Dialect, Recurrences};
use crate::derive::{Subject, function};
use crate::emit::layouts::layout::{Layout, variable_name};
use crate::names::module_name;

/// The constant `SOURCE` and the trait `Sourced`, of a level that provides them; without a program in an outline.
pub(in crate::emit) fn items(subject: &Subject<'_, '_>, layout: &Layout, is_outline: bool) -> TokenStream {
    if !subject.level.provides_source {
        return TokenStream::new();
    }
    let name = name(subject);
    let program = if is_outline { String::new() } else { program(&name, subject, layout) };
    let (steps, adaptive) = (subject.level.steps_in_c(), subject.level.steps_adapt_in_c());
    let series = adaptive && subject.level.series.is_some();
    let Layout { size, constants, hoisted, inputs, .. } = layout;
    let held = (*inputs > 0).then_some(inputs);
    quote! {
        __guen::source!(#name, #program, #steps, #adaptive, #series);
        __guen::sourced!(#size #constants #hoisted #held);
    }
}

/// The word that everything in C begins with: the modules of the system and of the scene.
fn name(subject: &Subject<'_, '_>) -> String {
    let module = |name, what| identifier(&module_name(name, what).to_string());
    let whole = module(&subject.whole.declaration.name.ident, "system");
    match subject.scene() {
        Some((scene, _)) => format!("{whole}_{}", module(&scene.name.ident, "scene")),
        None => whole,
    }
}

/// A name as letters of ASCII, digits and `_`.
fn identifier(name: &str) -> String {
    let name = name.strip_prefix("r#").unwrap_or(name).replace(']', "");
    let letters = name.chars().map(|letter| match letter {
        '[' | '.' => "_".to_owned(),
        letter if letter.is_ascii_alphanumeric() || letter == '_' => letter.to_string(),
        letter => format!("u{:x}", u32::from(letter)),
    });
    letters.collect()
}

/// The sizes and places, `prepare`, the right-hand side, the functions that must not vanish, and the series where it is provided.
fn program(name: &str, subject: &Subject<'_, '_>, layout: &Layout) -> String {
    let Subject { model, level, .. } = subject;
    let places = Places::new(subject, false);
    let Layout { constants, hoisted, size, inputs, .. } = layout;
    let mut text = format!(
        "#define {name}_CONSTANTS {constants}\n#define {name}_PREPARED {hoisted}\n#define {name}_STATES {size}\n#define {name}_INPUTS {inputs}\n"
    );
    let selection = &level.selection;
    let entries = |names: Vec<String>, letter: char| places_of(name, letter, &names, subject);
    let variable = |place: &crate::derive::StateIndex| variable_name(model, *place).text;
    let held = selection.held.iter().map(|held| variable(&held.place));
    let of_constants = selection.constants.iter().map(|c| model.constants[*c].name.text.clone());
    text += &entries(of_constants.chain(held).collect(), 'c');
    text += &entries(selection.variables.iter().map(variable).collect(), 's');
    text += &entries(selection.inputs.iter().map(|u| model.inputs[*u].name.text.clone()).collect(), 'u');
    let _ = write!(
        text,
        "\n/* Computes what depends on constants alone. Returns 0, the number of the first constant that is faulty, counted from 1, or -1. */\n\
         GUEN_FUNCTION int {name}_prepare(const double *c, double *k)\n{{\n    int i;\n    (void)c;\n    (void)k;\n\
         \x20   for (i = 0; i < {name}_CONSTANTS; ++i)\n        if (!guen_is_finite(c[i]))\n            return i + 1;\n{}",
        bounds(subject)
    );
    text += &body(&level.programs.prepare, &level.programs.prepared, "k", &places);
    let _ = write!(
        text,
        "    for (i = 0; i < {name}_PREPARED; ++i)\n        if (!guen_is_finite(k[i]))\n            return -1;\n    return 0;\n}}\n\n\
         /* The rates r of the state s at time t under inputs u. */\n\
         GUEN_FUNCTION void {name}_rhs(\n    const double *c, const double *k, double t, const double *s, const double *u, double *r)\n{{\n\
         \x20   (void)c;\n    (void)k;\n    (void)t;\n    (void)s;\n    (void)u;\n"
    );
    if let Some(rates) = level.program(function::RHS) {
        text += &body(&rates.instructions, &rates.outputs, "r", &places);
    }
    let domain = level.program(function::DOMAIN);
    let _ = write!(
        text,
        "}}\n\n#define {name}_DOMAIN {}\n\n/* The functions d that must not vanish, at the state s at time t. */\n\
         GUEN_FUNCTION void {name}_domain(const double *c, const double *k, double t, const double *s, double *d)\n{{\n\
         \x20   (void)c;\n    (void)k;\n    (void)t;\n    (void)s;\n    (void)d;\n",
        domain.map_or(0, |domain| domain.outputs.len())
    );
    if let Some(domain) = domain {
        text += &body(&domain.instructions, &domain.outputs, "d", &places);
    }
    text += "}\n";
    if let Some(series) = level.series.as_ref().filter(|_| level.steps_adapt_in_c()) {
        text += &series_function(name, &series.held, &places, layout);
    }
    text
}

/// The coefficients of the motion: statements for order zero, then a loop over the orders.
fn series_function(name: &str, series: &SeriesProgram, places: &Places, layout: &Layout) -> String {
    let recurrences = Recurrences::new(series, layout.size, &C(places));
    let [begin, next] = recurrences.in_order();
    let Recurrences { rates, next_rates, kept, now, pairs, .. } = recurrences;
    let (variables, list, count) = (rates.len(), now.len(), pairs.len());
    let assigned = |array: &str, values: &[String]| -> String {
        values.iter().enumerate().map(|(i, value)| format!("    {array}[{i}] = {value};\n")).collect()
    };
    let factors: Vec<String> = pairs.iter().flatten().map(usize::to_string).collect();
    // C has no empty arrays.
    let [states, list_length, sums, kept_length] = [variables, list, count, kept.len()].map(|n| n.max(1));
    let factors = if factors.is_empty() { "0, 0".to_owned() } else { factors.join(", ") };
    format!(
        "\n/* The coefficients x[m] of the motion from the state s at time t up to an order, times scale^m. */\n\
         GUEN_FUNCTION void {name}_series(\n    const double *c, const double *k, double t, const double *s, const double *u, double scale, int order,\n\
         \x20   double x[][{name}_STATES])\n{{\n    static const unsigned short pairs[{}] = {{ {factors} }};\n\
         \x20   double factors[{list_length}][16] = {{ {{ 0.0 }} }}, sums[{sums}][40] = {{ {{ 0.0 }} }}, now[{list_length}] = {{ 0.0 }};\n\
         \x20   double f[{states}], y[{states}], z[{kept_length}] = {{ 0.0 }};\n    int i, m;\n    (void)c;\n    (void)k;\n    (void)t;\n    (void)u;\n    (void)z;\n\
         \x20   for (i = 0; i < {name}_STATES; ++i)\n        x[0][i] = s[i];\n{begin}{}{}\
         \x20   for (m = 1; m <= order; ++m) {{\n    const double count = (double)m, part = 1.0 / count, step = scale * part;\n\
         \x20   for (i = 0; i < {variables}; ++i)\n        y[i] = f[i] * step;\n\
         \x20   for (i = 0; i < {name}_STATES; ++i)\n        x[m][i] = y[i];\n    if (m == order)\n        break;\n{next}{}{}\
         \x20   guen_spread(factors, sums, pairs, {count}, {list}, now, m, order);\n    }}\n}}\n",
        2 * sums,
        assigned("f", &rates),
        assigned("z", &kept),
        assigned("f", &next_rates),
        assigned("now", &now),
    )
}

/// The dialect of C.
struct C<'a>(&'a Places);

impl Dialect for C<'_> {
    fn number(&self, value: &Rational) -> String {
        number(value)
    }

    fn pi(&self) -> String {
        format!("{:?}", std::f64::consts::PI)
    }

    fn symbol(&self, symbol: SymbolId) -> String {
        self.0.symbol(symbol)
    }

    fn call(&self, function: Function, argument: &str) -> String {
        call(function, argument)
    }

    fn apply(&self, function: Multivariate, arguments: &[String]) -> String {
        format!("{}({})", of_several(function), arguments.join(", "))
    }

    fn reciprocal(&self, value: &str) -> String {
        format!("1.0 / ({value})")
    }

    fn sum(&self, place: usize) -> String {
        format!("sums[{place}][m & 31]")
    }

    fn variable(&self, place: usize) -> String {
        format!("y[{place}]")
    }

    fn time(&self) -> String {
        "m == 1 ? scale : 0.0".to_owned()
    }

    fn define(&self, name: &str, value: &str) -> String {
        format!("    const double {name} = {value};\n")
    }

    fn define_both(&self, [sine, cosine]: [&str; 2], angle: &str) -> String {
        format!("    double {sine}, {cosine};\n    guen_sincos({angle}, &{sine}, &{cosine});\n")
    }
}

/// The places in an array, as an enumeration.
fn places_of(name: &str, array: char, entries: &[String], subject: &Subject<'_, '_>) -> String {
    if entries.is_empty() {
        return String::new();
    }
    let mut taken = BTreeSet::new();
    let mut text = "\nenum {\n".to_owned();
    for (place, entry) in entries.iter().enumerate() {
        let mut word = identifier(entry);
        // `q[1]` and `q_1` may be two names.
        while !taken.insert(word.clone()) {
            word.push('_');
        }
        let unit = subject.model.units.get(entry).map(|unit| format!(" /* {} */", unit.replace("*/", "* /")));
        let _ = writeln!(text, "    {name}_{array}_{word} = {place},{}", unit.unwrap_or_default());
    }
    text + "};\n"
}

/// The tests of the bounds of constants.
fn bounds(subject: &Subject<'_, '_>) -> String {
    let Subject { model, level, .. } = subject;
    let graph = &model.bench.graph;
    let mut text = String::new();
    for (i, constant) in level.selection.constants.iter().map(|c| &model.constants[*c]).enumerate() {
        let limits = constant.limits.map(|limits| limits.map(|limit| graph.as_number(limit).map(number)));
        let within = match limits {
            Some([Some(low), Some(high)]) => Some(format!("c[{i}] >= {low} && c[{i}] <= {high}")),
            _ => constant.bound.map(|bound| format!("c[{i}] {}", bound.relation())),
        };
        if let Some(within) = within {
            let _ = write!(text, "    if (!({within}))\n        return {};\n", i + 1);
        }
    }
    text
}

/// Statements, then the results in an array.
fn body(instructions: &[Instruction], outputs: &[Value], results: &str, places: &Places) -> String {
    let last = |step: &Instruction| match step.operation {
        Operation::SinCos { cosine, .. } => step.result.index().max(cosine.index()),
        _ => step.result.index(),
    };
    let values = instructions.iter().map(|step| last(step) + 1).max().unwrap_or(0);
    let mut names: Vec<String> = (0..values).map(|v| format!("v{v}")).collect();
    let mut text = String::new();
    for Instruction { result, operation } in instructions {
        let name = |value: &Value| names[value.index()].as_str();
        let value = match operation {
            // Loads and numbers need no statement: they stand where they are used.
            Operation::Symbol(symbol) => Err(places.symbol(*symbol)),
            Operation::Prepared(k) => Err(format!("k[{k}]")),
            Operation::Number(value) => Err(number(value)),
            Operation::Pi => Err(format!("{:?}", std::f64::consts::PI)),
            Operation::Add(a, b) => Ok(format!("{} + {}", name(a), name(b))),
            Operation::Sub(a, b) => Ok(format!("{} - {}", name(a), name(b))),
            Operation::Mul(a, b) => Ok(format!("{} * {}", name(a), name(b))),
            Operation::Div(a, b) => Ok(format!("{} / {}", name(a), name(b))),
            Operation::Neg(a) => Ok(format!("-{}", name(a))),
            Operation::Call(function, a) => Ok(call(*function, name(a))),
            Operation::Apply(function, arguments) => {
                let arguments: Vec<&str> = arguments.iter().map(name).collect();
                Ok(format!("{}({})", of_several(*function), arguments.join(", ")))
            }
            Operation::SinCos { angle, cosine } => {
                let (sine, cosine) = (format!("v{}", result.index()), format!("v{}", cosine.index()));
                let _ = write!(
                    text,
                    "    double {sine}, {cosine};\n    guen_sincos({}, &{sine}, &{cosine});\n",
                    name(angle)
                );
                continue;
            }
        };
        match value {
            Ok(expression) => {
                let _ = writeln!(text, "    double v{} = {expression};", result.index());
            }
            Err(load) => names[result.index()] = load,
        }
    }
    for (i, output) in outputs.iter().enumerate() {
        let _ = writeln!(text, "    {results}[{i}] = {};", names[output.index()]);
    }
    text
}

/// A function of C, of one argument.
fn call(function: Function, argument: &str) -> String {
    let name = match function {
        Function::Sin => "guen_sin",
        Function::Cos => "guen_cos",
        Function::Sign => "guen_sign",
        Function::Abs => "fabs",
        Function::Ln => "log",
        Function::Root(2) => "sqrt",
        Function::Root(3) => "cbrt",
        Function::Root(q) => return format!("guen_root({argument}, {q}u)"),
        Function::Asin
        | Function::Acos
        | Function::Atan
        | Function::Exp
        | Function::Sinh
        | Function::Cosh
        | Function::Tanh
        | Function::Floor => function.name(),
    };
    format!("{name}({argument})")
}

/// A function of C, of several arguments; functions of the program are refused before.
fn of_several(function: Multivariate) -> &'static str {
    match function {
        Multivariate::Atan2 => "atan2",
        Multivariate::Select => "guen_select",
        Multivariate::Minimum => "guen_minimum",
        Multivariate::Maximum => "guen_maximum",
        Multivariate::Supplied { .. } => "supplied",
    }
}

/// An exact number as the double next to it, with the digits that tell it from its neighbours.
fn number(value: &Rational) -> String {
    if value.is_zero() {
        return "0.0".to_owned();
    }
    let (mantissa, exponent) = leading_part(value);
    // In two factors, of which no power of two underflows on the way.
    let half = exponent / 2;
    let double = mantissa as f64 * 2f64.powi(half) * 2f64.powi(exponent - half);
    match double < 0.0 {
        true => format!("({double:e})"),
        false => format!("{double:e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_the_doubles_next_to_them() {
        for (digits, exponent, text) in [
            ("1", -1, "1e-1"),
            ("-25", -1, "(-2.5e0)"),
            ("123456789012345678901", -3, "1.2345678901234568e17"),
            ("1", 300, "1e300"),
            ("0", 0, "0.0"),
        ] {
            assert_eq!(number(&Rational::from_decimal(digits, exponent).unwrap()), text);
        }
    }

    #[test]
    fn names_become_words_of_c() {
        assert_eq!(identifier("r#type"), "type");
        assert_eq!(identifier("wheel[2].speed"), "wheel_2_speed");
        assert_eq!(identifier("φ"), "u3c6");
    }
}
