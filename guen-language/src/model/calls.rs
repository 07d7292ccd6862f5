//! Functions of the declaration, `fn name(x, y) = e;`: a call is the expression with the arguments in place of their names.

use std::collections::BTreeSet;
use std::rc::Rc;

use guen_symbolic::{ExprId, MAX_ARGUMENTS};
use proc_macro2::Span;

use super::evaluate::{Evaluated, Evaluator};
use super::scope::Category;
use super::value::Value;
use crate::diagnostics::Fault;
use crate::limits::{MAX_CALL_DEPTH, MAX_CALLED_DEPTH, MAX_CALLS};
use crate::names;
use crate::syntax::{Expression, ExpressionKind, FunctionDefinition, Name, SuppliedFunction};

impl Evaluator<'_> {
    /// `fn name(x, y) = e;`: its names are checked here, its kinds where it is called.
    pub(super) fn function(&mut self, function: &FunctionDefinition) {
        self.entry = Some(function.name.text.clone());
        self.place = super::expression_place::ExpressionPlace::Let;
        let before = self.faults.count();
        let mut own: BTreeSet<&str> = BTreeSet::new();
        for parameter in &function.parameters {
            let text = parameter.text.as_str();
            if names::is_reserved(text) {
                let what = if names::is_function(text) { "the name of a function" } else { "reserved" };
                self.faults.report(
                    Fault::new(parameter.span(), format!("`{text}` is {what} and cannot name an argument"))
                        .help("choose another name"),
                );
            } else if !own.insert(text) {
                self.faults.report(Fault::new(parameter.span(), format!("`{text}` is an argument twice")));
            } else if !text.starts_with('_')
                && !function.value.mentions(text)
                && !function.value.has_missing()
            {
                let fault = Fault::new(
                    parameter.span(),
                    format!("`{}` does not use its argument `{text}`", function.name),
                );
                self.faults.report(fault.help(format!("remove it, or call it `_{text}`")));
            }
        }
        self.names_inside(&function.value, function, &own);
        let mut function = function.clone();
        if self.faults.count() > before {
            // Nothing is said about its calls.
            function.value = Expression::missing(function.value.span);
        }
        self.functions.by_name.insert(function.name.text.clone(), Rc::new(function.clone()));
        self.scope.declare(self.faults, &function.name, Category::Function, None);
    }

    /// Reports what is not declared in front of a function that uses it.
    fn names_inside(&mut self, e: &Expression, function: &FunctionDefinition, own: &BTreeSet<&str>) {
        match &e.kind {
            ExpressionKind::Name(name) if !own.contains(name.text.as_str()) => {
                // Its faults are reported; the value is asked for by calls.
                let _ = self.name(name);
            }
            ExpressionKind::Call { function: called, .. } if called.text == function.name.text => {
                self.faults.report(
                    Fault::new(called.span(), format!("`{called}` uses itself")).help(
                        "a function is one expression of its arguments and of what is declared before it",
                    ),
                );
            }
            ExpressionKind::Call { function: called, arguments, .. }
                if !names::is_function(&called.text)
                    && self.functions.get(&called.text).is_none()
                    && !self.functions.supplied.contains_key(&called.text)
                    && called.text != super::accelerations::REACTION =>
            {
                let _ = self.not_a_function(called, arguments);
            }
            _ => {}
        }
        e.children().into_iter().for_each(|child| self.names_inside(child, function, own));
    }

    /// Refuses the name of a function where a value is meant.
    pub(super) fn function_as_value(&mut self, name: &Name) -> Evaluated {
        self.scope.mark_used(name);
        let parameters = match self.functions.get(&name.text) {
            Some(function) => usage(function),
            None => match self.functions.supplied.get(&name.text) {
                Some((_, arguments)) => format!("{name}({})", arguments.join(", ")),
                None => format!("{name}(..)"),
            },
        };
        self.fail(
            Fault::new(name.span(), format!("`{name}` is a function, and no value"))
                .help(format!("write `{parameters}`")),
        )
    }

    /// A function that the program supplies.
    pub(super) fn supplied_function(&mut self, function: &SuppliedFunction) {
        self.entry = Some(function.name.text.clone());
        let mut own: BTreeSet<&str> = BTreeSet::new();
        for argument in &function.arguments {
            if !own.insert(&argument.text) {
                let text = format!("`{argument}` is an argument twice");
                self.faults.report(Fault::new(argument.span(), text));
            }
        }
        let found = function.arguments.len();
        if let Some(first) = function.arguments.get(MAX_ARGUMENTS) {
            let text = format!("a function of {found} arguments, and {MAX_ARGUMENTS} are allowed");
            self.faults.report(Fault::new(first.span(), text));
        }
        let arguments: Vec<&str> = function.arguments.iter().map(|name| name.text.as_str()).collect();
        self.scope.declare(self.faults, &function.name, Category::Function, None);
        if self.functions.get(&function.name.text).is_none() {
            let is_sound = (1..=MAX_ARGUMENTS).contains(&found);
            let declared =
                is_sound.then(|| self.bench.graph.declare_function(&function.name.text, &arguments));
            let arguments = arguments.into_iter().map(str::to_owned).collect();
            self.functions.supplied.entry(function.name.text.clone()).or_insert((declared, arguments));
        }
    }

    /// A call of a function that the program supplies.
    fn supplied_call(&mut self, name: &Name, arguments: &[Expression], list: Span) -> Option<Evaluated> {
        let (function, expected) = self.functions.supplied.get(&name.text)?.clone();
        self.scope.mark_used(name);
        let values: Vec<(Evaluated, Span)> =
            arguments.iter().map(|argument| (self.value(argument), argument.extent())).collect();
        let Some(function) = function else { return Some(Err(self.faults.reported_before())) };
        if values.len() != expected.len() {
            let usage = format!("{name}({})", expected.join(", "));
            return Some(self.wrong_count(name, &usage, [expected.len(), values.len()], list));
        }
        if let Some(what) = self.place.without_functions() {
            let fault = Fault::new(name.span(), format!("{what}, and no function that the program supplies"));
            return Some(
                self.fail(fault.help("compute the number in the program, and hand it over as a constant")),
            );
        }
        let mut scalars = Vec::new();
        for (value, span) in values {
            scalars.push(value.and_then(|value| self.scalar(name, &(value, span))));
        }
        let scalars: Evaluated<Vec<ExprId>> = scalars.into_iter().collect();
        Some(scalars.and_then(|scalars| {
            let value = self.bench.graph.multivariate(function, &scalars);
            self.check_size(value, name.span())
        }))
    }

    fn wrong_count(
        &mut self,
        name: &Name,
        usage: &str,
        [expected, found]: [usize; 2],
        list: Span,
    ) -> Evaluated {
        let plural = if expected == 1 { "" } else { "s" };
        let were = if found == 1 { "was" } else { "were" };
        let text = format!("`{name}` takes {expected} argument{plural}, and {found} {were} given");
        self.fail(Fault::new(list, text).help(format!("write `{usage}`")))
    }

    /// A call of a function of the declaration.
    pub(super) fn declared_call(
        &mut self,
        name: &Name,
        arguments: &[Expression],
        list: Span,
    ) -> Option<Evaluated> {
        if let Some(value) = self.supplied_call(name, arguments, list) {
            return Some(value);
        }
        let function = self.functions.by_name.get(&name.text).cloned()?;
        self.scope.mark_used(name);
        Some(self.called(name, &function, arguments, list))
    }

    fn called(
        &mut self,
        name: &Name,
        function: &FunctionDefinition,
        arguments: &[Expression],
        list: Span,
    ) -> Evaluated {
        let values: Vec<Evaluated> = arguments.iter().map(|argument| self.value(argument)).collect();
        let (expected, found) = (function.parameters.len(), values.len());
        if expected != found {
            return self.wrong_count(name, &usage(function), [expected, found], list);
        }
        let values = values.into_iter().collect::<Evaluated<Vec<Value>>>()?;
        if function.value.has_missing() {
            // Its fault was reported where it is declared.
            return Err(self.faults.reported_before());
        }
        let functions = &mut self.functions;
        functions.calls += 1;
        if functions.frames.len() >= MAX_CALL_DEPTH {
            let text = format!("more than {MAX_CALL_DEPTH} functions call each other here");
            return self.fail(Fault::new(name.span(), text).help("write some of them out"));
        }
        if functions.calls > MAX_CALLS {
            let text =
                format!("more than {MAX_CALLS} calls of functions, those inside of functions included");
            return self
                .fail(Fault::new(name.span(), text).help("give a value that is used often a name by `let`"));
        }
        let depth = function.value.depth();
        if functions.depth + depth > MAX_CALLED_DEPTH {
            let text =
                format!("functions that call each other nest more than {MAX_CALLED_DEPTH} expressions here");
            return self.fail(Fault::new(name.span(), text).help("give parts of them names with `let`"));
        }
        let names = function.parameters.iter().map(|parameter| parameter.text.clone());
        let before = self.faults.count();
        functions.frames.push(names.zip(values).collect());
        functions.depth += depth;
        let value = self.value(&function.value);
        self.functions.depth -= depth;
        self.functions.frames.pop();
        // Of a chain of calls the first and the last.
        let is_outermost = self.functions.frames.is_empty() && self.functions.noted > before;
        let since = if is_outermost { before } else { before.max(self.functions.noted) };
        self.faults.note_since(since, &format!("in the call of `{name}`"), name.span());
        self.functions.noted = self.faults.count();
        value
    }

    /// Whether the expression of a function brings in one of these kinds of symbol by itself, whatever its arguments.
    pub(super) fn brings_in(&self, function: &str, roles: guen_symbolic::Roles) -> bool {
        let Some(function) = self.functions.get(function) else { return false };
        let own: BTreeSet<&str> =
            function.parameters.iter().map(|parameter| parameter.text.as_str()).collect();
        let mut found = Vec::new();
        self.culprits_beside(&own, &function.value, roles, &mut found);
        !found.is_empty()
    }
}

/// `name(x, y)`.
fn usage(function: &FunctionDefinition) -> String {
    let parameters: Vec<&str> = function.parameters.iter().map(|parameter| parameter.text.as_str()).collect();
    format!("{}({})", function.name, parameters.join(", "))
}
