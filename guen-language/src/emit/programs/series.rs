//! Taylor series: the recurrences as Rust, and the trait that steppers ask for.
//!
//! One function: statements for order zero, then a loop over the orders with one statement for each operation. What the
//! loop needs of order zero is handed over in an array.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

use guen_symbolic::{
    Function, Multivariate, Operation, Rational, SeriesProgram, SeriesStep, Start, SymbolId, Value,
};
use proc_macro2::TokenStream;
use quote::quote;

use super::code::{Loads, apply, call, number};
use crate::derive::{Series, Subject};
use crate::emit::layouts::layout::Layout;
use crate::emit::thresholds::BLOCK_STATEMENTS;

/// The trait `TaylorSeries` for what steppers integrate.
pub(in crate::emit) fn items(subject: &Subject<'_, '_>, layout: &Layout) -> TokenStream {
    let Some(Series { held, along_inputs }) = &subject.level.series else { return TokenStream::new() };
    let (size, products) = (layout.size, held.sums.len());
    let (owner, prepared, inputs) = if layout.inputs == 0 {
        (quote!(Prepared<R>), quote!(self), quote!(&[]))
    } else {
        (quote!(Driven<R>), quote!(self.system), quote!(&::core::convert::From::from(self.inputs)))
    };
    let along_inputs = along_inputs.as_ref().map(|series| {
        let (count, products) = (layout.inputs, series.sums.len());
        quote! {
            impl<R: __guen::Real> __guen::DrivenSeries<R, #size, #count> for Prepared<R> {
                const PRODUCTS: usize = #products;

                fn series_along(
                    &self, t: R, state: &[R; #size], inputs: &mut dyn ::core::ops::FnMut(usize, &__guen::Coefficients<R, #size>) -> [R; #count],
                    scale: R, order: usize, coefficients: &mut __guen::Coefficients<R, #size>,
                ) {
                    <R as __guen::Real>::wide(
                        #[inline(always)]
                        || program::series_along(&self.constants, &self.hoisted, t, state, inputs, scale, order, coefficients)
                    )
                }
            }
        }
    });
    quote! {
        #along_inputs

        impl<R: __guen::Real> __guen::TaylorSeries<R, #size> for #owner {
            const PRODUCTS: usize = #products;

            fn series(
                &self, t: R, state: &[R; #size], scale: R, order: usize, coefficients: &mut __guen::Coefficients<R, #size>,
            ) {
                <R as __guen::Real>::wide(
                    #[inline(always)]
                    || program::series(&#prepared.constants, &#prepared.hoisted, t, state, #inputs, scale, order, coefficients)
                )
            }
        }
    }
}

/// A statement that defines one or more values.
struct Statement {
    defines: Vec<String>,
    uses: Vec<String>,
    text: String,
}

/// Statements in blocks that hand on what later ones need: see `code::body`.
fn blocks(statements: &[Statement], needed: &[String]) -> String {
    if statements.len() <= BLOCK_STATEMENTS {
        return statements.iter().map(|statement| statement.text.as_str()).collect();
    }
    let mut last_use: BTreeMap<&str, usize> = BTreeMap::new();
    for (place, statement) in statements.iter().enumerate() {
        statement.uses.iter().for_each(|name| {
            last_use.insert(name, place);
        });
    }
    needed.iter().for_each(|name| {
        last_use.insert(name, usize::MAX);
    });
    let mut text = String::new();
    for (index, block) in statements.chunks(BLOCK_STATEMENTS).enumerate() {
        let end = index * BLOCK_STATEMENTS + block.len();
        let handed: String = block
            .iter()
            .flat_map(|statement| &statement.defines)
            .filter(|name| last_use.get(name.as_str()).is_some_and(|last| *last >= end))
            .map(|name| format!("{name},"))
            .collect();
        let _ = write!(text, "let ({handed}) = {{");
        block.iter().for_each(|statement| text.push_str(&statement.text));
        let _ = write!(text, "({handed}) }};");
    }
    text
}

/// The values of order zero that the loop needs.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Kept {
    Value(Value),
    /// `2 a_0`
    Twice(Value),
    /// `1 / a_0`
    Reciprocal(Value),
    /// `1 / (2 a_0)`
    HalfReciprocal(Value),
}

/// The words of a language in which recurrences are written.
pub(super) trait Dialect {
    fn number(&self, value: &Rational) -> String;
    fn pi(&self) -> String;
    /// The place of a symbol's value.
    fn symbol(&self, symbol: SymbolId) -> String;
    fn call(&self, function: Function, argument: &str) -> String;
    fn apply(&self, function: Multivariate, arguments: &[String]) -> String;
    fn reciprocal(&self, value: &str) -> String;
    /// The sum of products at a place, for order `m`.
    fn sum(&self, place: usize) -> String;
    /// The coefficient of a variable of order `m`.
    fn variable(&self, place: usize) -> String;
    /// The coefficient of time of order `m`.
    fn time(&self) -> String;
    /// A statement that gives a value its name.
    fn define(&self, name: &str, value: &str) -> String;
    /// A statement that names sine and cosine of an angle.
    fn define_both(&self, names: [&str; 2], angle: &str) -> String;
}

/// The dialect of generated Rust.
struct Rust<'a>(&'a dyn Loads);

impl Dialect for Rust<'_> {
    fn number(&self, value: &Rational) -> String {
        number(value)
    }

    fn pi(&self) -> String {
        "R::pi()".to_owned()
    }

    fn symbol(&self, symbol: SymbolId) -> String {
        self.0.symbol(symbol)
    }

    fn call(&self, function: Function, argument: &str) -> String {
        call(function, argument)
    }

    fn apply(&self, function: Multivariate, arguments: &[String]) -> String {
        apply(function, arguments)
    }

    fn reciprocal(&self, value: &str) -> String {
        format!("R::recip({value})")
    }

    fn sum(&self, place: usize) -> String {
        format!("w.sum({place})")
    }

    fn variable(&self, place: usize) -> String {
        format!("x[{place}]")
    }

    fn time(&self) -> String {
        "if m == 1 { scale } else { R::zero() }".to_owned()
    }

    fn define(&self, name: &str, value: &str) -> String {
        format!("let {name} = {value};")
    }

    fn define_both(&self, [sine, cosine]: [&str; 2], angle: &str) -> String {
        format!("let ({sine}, {cosine}) = R::sin_cos({angle});")
    }
}

struct Writer<'a> {
    series: &'a SeriesProgram,
    dialect: &'a dyn Dialect,
    /// The number of variables of the state.
    states: usize,
    kept: BTreeMap<Kept, usize>,
    /// The operations one after the other that lead to the coefficient of each value.
    depths: Vec<u32>,
}

/// The functions `series` and `series_along`, whose parameters are those of a right-hand side and the request.
pub(super) fn functions(series: &Series, loads: &dyn Loads, layout: &Layout) -> String {
    let mut text = function(&series.held, false, loads, layout);
    if let Some(series) = &series.along_inputs {
        text.push_str(&function(series, true, loads, layout));
    }
    text
}

/// The recurrences of a program in the words of a language.
pub(super) struct Recurrences {
    begin: Vec<Statement>,
    next: Vec<Statement>,
    /// The rates of order zero and of order `m`, the values of order zero that `next` reads as `z`, and the factors of order `m`.
    pub(super) rates: Vec<String>,
    pub(super) next_rates: Vec<String>,
    pub(super) kept: Vec<String>,
    pub(super) now: Vec<String>,
    /// The places of the two factors of each sum.
    pub(super) pairs: Vec<[usize; 2]>,
}

impl Recurrences {
    /// Writes the recurrences of a program for so many variables of the state.
    pub(super) fn new(series: &SeriesProgram, states: usize, dialect: &dyn Dialect) -> Self {
        let mut writer = Writer { series, dialect, states, kept: BTreeMap::new(), depths: depths(series) };
        let values = || (0..series.steps.len()).map(value);
        let next: Vec<Statement> = values().filter_map(|v| writer.next(v)).collect();
        let mut begin: Vec<Statement> = values().filter_map(|v| writer.begin(v)).collect();

        let factors = series.factors();
        let row = |v: Value| factors.binary_search(&v).unwrap_or_default();
        let pairs = series.sums.iter().map(|[a, b]| [row(*a), row(*b)]).collect();
        let now = factors.iter().map(|v| format!("d{}", v.index())).collect();
        let rates = series.rates.iter().map(|v| format!("v{}", v.index())).collect();
        let zero = || dialect.number(&Rational::integer(0));
        let moving = |v: &Value| (!series.is_still(*v)).then(|| format!("d{}", v.index()));
        let next_rates = series.rates.iter().map(|v| moving(v).unwrap_or_else(zero)).collect();

        let mut kept: Vec<String> = vec![String::new(); writer.kept.len()];
        for (what, place) in &writer.kept {
            let (v, text) = match what {
                Kept::Value(v) => (v, format!("v{}", v.index())),
                Kept::Twice(v) => (v, format!("e{}", v.index())),
                Kept::Reciprocal(v) => (v, format!("r{}", v.index())),
                Kept::HalfReciprocal(v) => (v, format!("h{}", v.index())),
            };
            let name = format!("v{}", v.index());
            let value = match what {
                Kept::Value(_) => None,
                Kept::Twice(_) => Some(format!("{name} + {name}")),
                Kept::Reciprocal(_) => Some(dialect.reciprocal(&name)),
                Kept::HalfReciprocal(_) => Some(dialect.reciprocal(&format!("{name} + {name}"))),
            };
            begin.extend(value.map(|value| Statement {
                text: dialect.define(&text, &value),
                uses: vec![name],
                defines: vec![text.clone()],
            }));
            kept[*place] = text;
        }
        Self { begin, next, rates, next_rates, kept, now, pairs }
    }

    /// The statements of order zero that lead to something, one after another, and those of order `m`.
    pub(super) fn in_order(&self) -> [String; 2] {
        [
            needed(&self.begin, self.rates.iter().chain(&self.kept)),
            needed(&self.next, self.next_rates.iter().chain(&self.now)),
        ]
    }
}

/// The statements from which results follow.
fn needed<'a>(statements: &'a [Statement], results: impl Iterator<Item = &'a String>) -> String {
    let mut names: BTreeSet<&str> = results.map(String::as_str).collect();
    let mut kept: Vec<&str> = Vec::new();
    for statement in statements.iter().rev() {
        if statement.defines.iter().any(|name| names.contains(name.as_str())) {
            names.extend(statement.uses.iter().map(String::as_str));
            kept.push(&statement.text);
        }
    }
    kept.into_iter().rev().collect()
}

/// Writes one of the functions. Where inputs have series, `u` gives their coefficients, order by order: `g` of order zero, `y` of order `m`.
fn function(series: &SeriesProgram, along_inputs: bool, loads: &dyn Loads, layout: &Layout) -> String {
    let Layout { size, constants, hoisted, inputs, .. } = layout;
    let Recurrences { begin, next, rates, next_rates, kept, now, pairs } =
        Recurrences::new(series, *size, &Rust(loads));
    let begun: Vec<String> = rates.iter().chain(&kept).cloned().collect();
    let used: Vec<String> = next_rates.iter().chain(&now).cloned().collect();
    let (variables, sums, count) = (rates.len(), pairs.len(), kept.len());
    // A row is padded to whole registers.
    let row = if sums <= 4 { sums.next_power_of_two() } else { sums.next_multiple_of(8) };
    let factors: String = pairs.iter().map(|[a, b]| format!("[{}, {}],", now[*a], now[*b])).collect();
    let (rates, kept) = (rates.join(","), kept.join(","));
    let (name, given, first, further) = if along_inputs {
        let given = format!("&mut dyn FnMut(usize, &__guen::Coefficients<R, {size}>) -> [R; {inputs}]");
        ("series_along", given, "let g = u(0, out);", "let y = u(m, out);")
    } else {
        ("series", format!("&[R; {inputs}]"), "", "")
    };
    let (begin, next, next_rates) = (blocks(&begin, &begun), blocks(&next, &used), next_rates.join(","));
    format!(
        "#[inline(always)] pub(super) fn {name}<R: __guen::Real>(
            c: &[R; {constants}], k: &[R; {hoisted}], t: R, s: &[R; {size}], u: {given},
            scale: R, order: usize, out: &mut __guen::Coefficients<R, {size}>,
        ) {{
            let order = if order > __guen::HIGHEST_ORDER {{ __guen::HIGHEST_ORDER }} else {{ order }};
            out[0] = *s;
            {first}
            {begin}
            let mut f: [R; {variables}] = [{rates}];
            let z: [R; {count}] = [{kept}];
            let mut w = __guen::Convolutions::<R, {sums}, {row}>::new(order);
            let mut m = 1_usize;
            while m <= order {{
                let count = R::from_f64(m as f64);
                let part = R::recip(count);
                let step = scale * part;
                let mut x = f;
                let mut i = 0_usize;
                while i < {variables} {{ x[i] = x[i] * step; i += 1; }}
                i = 0;
                while i < {size} {{ out[m][i] = x[i]; i += 1; }}
                if m == order {{ break; }}
                {further}
                {next}
                f = [{next_rates}];
                w.push(&[{factors}], m);
                m += 1;
            }}
        }}"
    )
}

fn value(index: usize) -> Value {
    Value::new(index)
}

/// The operations one after the other that lead to the coefficient of each value. Sums are known before.
fn depths(series: &SeriesProgram) -> Vec<u32> {
    let mut depths: Vec<u32> = Vec::with_capacity(series.steps.len());
    for step in &series.steps {
        let own = match step {
            SeriesStep::Still(_) | SeriesStep::Time | SeriesStep::Variable(_) | SeriesStep::Input(_) => 0,
            SeriesStep::Product(..) | SeriesStep::Along(..) | SeriesStep::SquareRoot(..) => 2,
            SeriesStep::Quotient(..) => 3,
            _ => 1,
        };
        // The second factor of a derivative may come later, and is not needed.
        let operands = step.operands();
        let deepest = operands.iter().filter_map(|v| depths.get(v.index())).max();
        depths.push(own + if own == 0 { 0 } else { deepest.copied().unwrap_or_default() });
    }
    depths
}

impl Writer<'_> {
    fn keep(&mut self, what: Kept) -> String {
        let next = self.kept.len();
        format!("z[{}]", self.kept.entry(what).or_insert(next))
    }

    fn zero(&self) -> String {
        self.dialect.number(&Rational::integer(0))
    }

    fn zeroth(&mut self, v: Value) -> String {
        self.keep(Kept::Value(v))
    }

    /// The statement for order zero.
    fn begin(&self, v: Value) -> Option<Statement> {
        let step = &self.series.steps[v.index()];
        let name = format!("v{}", v.index());
        let at = |v: &Value| format!("v{}", v.index());
        let start = |start: &Start| self.start(v, start);
        let text = match step {
            SeriesStep::Still(operation) => match operation {
                Operation::Number(value) => self.dialect.number(value),
                Operation::Pi => self.dialect.pi(),
                Operation::Symbol(symbol) => self.dialect.symbol(*symbol),
                Operation::Prepared(k) => format!("k[{k}]"),
                Operation::Add(a, b) => format!("{} + {}", at(a), at(b)),
                Operation::Sub(a, b) => format!("{} - {}", at(a), at(b)),
                Operation::Neg(a) => format!("-{}", at(a)),
                Operation::Mul(a, b) => format!("{} * {}", at(a), at(b)),
                Operation::Div(a, b) => format!("{} / {}", at(a), at(b)),
                Operation::Call(function, a) => self.dialect.call(*function, &at(a)),
                Operation::Apply(function, arguments) => {
                    let arguments: Vec<String> = arguments.iter().map(at).collect();
                    self.dialect.apply(*function, &arguments)
                }
                // Series programs have none.
                Operation::SinCos { .. } => return None,
            },
            SeriesStep::Time => "t".to_owned(),
            SeriesStep::Input(i) => format!("g[{i}]"),
            SeriesStep::Variable(i) => match i.checked_sub(self.states) {
                None => format!("s[{i}]"),
                Some(place) => return Some(start(&self.series.carried[place])),
            },
            SeriesStep::Add(a, b) => format!("{} + {}", at(a), at(b)),
            SeriesStep::Sub(a, b) => format!("{} - {}", at(a), at(b)),
            SeriesStep::Neg(a) => format!("-{}", at(a)),
            SeriesStep::Scale(a, b) | SeriesStep::Product(a, b, _) => format!("{} * {}", at(a), at(b)),
            SeriesStep::Quotient(a, b, _) => format!("{} / {}", at(a), at(b)),
            SeriesStep::SquareRoot(a, _) => self.dialect.call(Function::Root(2), &at(a)),
            SeriesStep::Along(..) | SeriesStep::Derivative(_) => self.zero(),
            SeriesStep::Integral(function, _) => return Some(start(function)),
        };
        let uses = match step {
            SeriesStep::Along(..) | SeriesStep::Derivative(_) => Vec::new(),
            _ => step.operands().iter().map(at).collect(),
        };
        Some(Statement { text: self.dialect.define(&name, &text), uses, defines: vec![name] })
    }

    /// Returns the statement that starts a function; sine and cosine of one angle together where both are there.
    fn start(&self, v: Value, start: &Start) -> Statement {
        let name = format!("v{}", v.index());
        let uses: Vec<String> = start.operands().iter().map(|v| format!("v{}", v.index())).collect();
        if let Start::Call(Function::Sin, angle) = start
            && let Some(cosine) = self.beginning_with(Start::Call(Function::Cos, *angle))
        {
            let cosine = format!("v{}", cosine.index());
            let text = self.dialect.define_both([&name, &cosine], &uses[0]);
            return Statement { text, uses, defines: vec![name, cosine] };
        }
        let text = match start {
            Start::Call(Function::Cos, angle)
                if self.beginning_with(Start::Call(Function::Sin, *angle)).is_some() =>
            {
                return Statement { text: String::new(), uses: Vec::new(), defines: Vec::new() };
            }
            Start::Call(function, _) => self.dialect.call(*function, &uses[0]),
            Start::Atan2(..) => self.dialect.apply(Multivariate::Atan2, &uses),
        };
        Statement { text: self.dialect.define(&name, &text), uses, defines: vec![name] }
    }

    /// The value that begins in a way.
    fn beginning_with(&self, wanted: Start) -> Option<Value> {
        let series = self.series;
        let begins = |step: &SeriesStep| match step {
            SeriesStep::Variable(i) => {
                i.checked_sub(self.states).is_some_and(|place| series.carried[place] == wanted)
            }
            SeriesStep::Integral(start, _) => *start == wanted,
            _ => false,
        };
        series.steps.iter().position(begins).map(value)
    }

    /// The statement for order `m`.
    fn next(&mut self, v: Value) -> Option<Statement> {
        let series = self.series;
        let step = &series.steps[v.index()];
        let name = format!("d{}", v.index());
        let still = |v: &Value| series.is_still(*v);
        let at = |v: &Value| format!("d{}", v.index());
        let dialect = self.dialect;
        let sum = |place| dialect.sum(place);
        let mut uses: Vec<String> = step.operands().iter().filter(|v| !still(v)).map(at).collect();
        let text = match step {
            SeriesStep::Still(_) => return None,
            SeriesStep::Time => self.dialect.time(),
            SeriesStep::Variable(i) => self.dialect.variable(*i),
            SeriesStep::Input(i) => format!("y[{i}]"),
            SeriesStep::Add(a, b) if still(a) => at(b),
            SeriesStep::Add(a, b) if still(b) => at(a),
            SeriesStep::Add(a, b) => format!("{} + {}", at(a), at(b)),
            SeriesStep::Sub(a, b) if still(a) => format!("-{}", at(b)),
            SeriesStep::Sub(a, b) if still(b) => at(a),
            SeriesStep::Sub(a, b) => format!("{} - {}", at(a), at(b)),
            SeriesStep::Neg(a) => format!("-{}", at(a)),
            SeriesStep::Scale(k, a) => format!("{} * {}", self.zeroth(*k), at(a)),
            SeriesStep::Product(a, b, place) if a == b => {
                format!("{} + {} * {}", sum(*place), self.keep(Kept::Twice(*a)), at(a))
            }
            SeriesStep::Product(a, b, place) => {
                // The factor that is computed later is added last, so that the sum does not wait for it.
                let (early, late) =
                    if self.depths[a.index()] > self.depths[b.index()] { (b, a) } else { (a, b) };
                let (of_early, of_late) = (self.zeroth(*late), self.zeroth(*early));
                format!("({} + {of_early} * {}) + {of_late} * {}", sum(*place), at(early), at(late))
            }
            SeriesStep::Along(a, b, place) => {
                uses.truncate(1);
                format!("{} + {} * {}", sum(*place), at(a), self.zeroth(*b))
            }
            SeriesStep::Quotient(a, b, place) => {
                let (quotient, reciprocal) = (self.zeroth(v), self.keep(Kept::Reciprocal(*b)));
                if still(a) {
                    format!("-({} + {quotient} * {}) * {reciprocal}", sum(*place), at(b))
                } else if self.depths[a.index()] > self.depths[b.index()] {
                    format!("({} - ({} + {quotient} * {})) * {reciprocal}", at(a), sum(*place), at(b))
                } else {
                    format!("(({} - {}) - {quotient} * {}) * {reciprocal}", at(a), sum(*place), at(b))
                }
            }
            SeriesStep::SquareRoot(a, place) => {
                let reciprocal = self.keep(Kept::HalfReciprocal(v));
                format!("({} - {}) * {reciprocal}", at(a), sum(*place))
            }
            SeriesStep::Derivative(a) => format!("count * {}", at(a)),
            SeriesStep::Integral(_, rate) if still(rate) => self.zero(),
            SeriesStep::Integral(_, rate) => {
                uses = vec![at(rate)];
                format!("{} * part", at(rate))
            }
        };
        Some(Statement { text: self.dialect.define(&name, &text), uses, defines: vec![name] })
    }
}
