//! Names and expressions without indices that have to be computed.

#![expect(
    clippy::boxed_local,
    reason = "the recursion passes pointers on, and what it calls opens them beside its stack"
)]

use proc_macro2::Span;

use super::Unfolder;
use super::arrays::brackets;
use crate::diagnostics::Fault;
use crate::syntax::{
    AddOperator, EntryNode, Expression, ExpressionKind, Factor, Fold, Index, Item, ModeStatement,
    MultiplyOperator, Name, Number, Order, Path, Step, Term,
};

impl Unfolder<'_> {
    /// An expression for the present values of the loop variables.
    pub(super) fn expression(&mut self, e: &Expression) -> Expression {
        *self.unfolded(e)
    }

    /// An expression as [`Unfolder::expression`]. The recursion passes pointers on, and loops instead of iterators: unoptimised builds give every
    /// value a place of its own on the stack, and expressions are nested deep.
    fn unfolded(&mut self, e: &Expression) -> Box<Expression> {
        match &e.kind {
            ExpressionKind::Call { function, arguments, list } => self.call(e, function, arguments, *list),
            ExpressionKind::Field { base, name } => {
                let base = self.unfolded(base);
                self.field(e, base, name)
            }
            ExpressionKind::Method { base, name, arguments, list } => {
                let base = self.unfolded(base);
                let arguments = self.arguments(arguments);
                method(e, base, name, arguments, *list)
            }
            ExpressionKind::Negation(operand) => negation(e, self.unfolded(operand)),
            ExpressionKind::Sum { first, rest } => {
                let own = self.unfolded(first);
                let mut terms = Vec::with_capacity(rest.len() + 1);
                if !is_empty_sum(first, &own) {
                    terms.push(Term { operator: AddOperator::Plus, span: e.span, value: *own });
                }
                for term in rest {
                    let value = self.unfolded(&term.value);
                    if !is_empty_sum(&term.value, &value) {
                        push_term(&mut terms, term, value);
                    }
                }
                sum(e, terms)
            }
            ExpressionKind::Product { first, rest } => {
                let first = self.unfolded(first);
                let mut factors = Vec::with_capacity(rest.len());
                for factor in rest {
                    push_factor(&mut factors, factor, self.unfolded(&factor.value));
                }
                product(e, first, factors)
            }
            ExpressionKind::Power { base, exponent } => {
                let base = self.unfolded(base);
                power(e, base, self.unfolded(exponent))
            }
            ExpressionKind::Comparison { left, order, right } => {
                let left = self.unfolded(left);
                comparison(e, left, *order, self.unfolded(right))
            }
            ExpressionKind::Fold(fold) => self.fold(e, fold),
            ExpressionKind::Missing | ExpressionKind::Number(_) => Box::new(e.clone()),
            ExpressionKind::Name(name) => self.name(e, name),
        }
    }

    fn call(
        &mut self,
        e: &Expression,
        function: &Name,
        arguments: &[Expression],
        list: Span,
    ) -> Box<Expression> {
        if self.is_call_of_array(function, arguments) {
            return with_kind(e, ExpressionKind::Missing);
        }
        let arguments = self.arguments(arguments);
        call_of(e, function, arguments, list)
    }

    fn arguments(&mut self, arguments: &[Expression]) -> Vec<Expression> {
        let mut unfolded = Vec::with_capacity(arguments.len());
        for argument in arguments {
            push(&mut unfolded, self.unfolded(argument));
        }
        unfolded
    }

    fn field(&mut self, e: &Expression, base: Box<Expression>, name: &Name) -> Box<Expression> {
        let kind = match self.member(name) {
            Some(name) => ExpressionKind::Field { base, name },
            None => ExpressionKind::Missing,
        };
        with_kind(e, kind)
    }

    fn name(&mut self, e: &Expression, name: &Name) -> Box<Expression> {
        let kind = self.value(name);
        with_kind(e, kind)
    }

    /// The name of a member of an instance, with its index computed; none after a fault. Whether it has such an entry is asked later.
    pub(super) fn member(&mut self, name: &Name) -> Option<Name> {
        let Index::Written(written) = &name.index else { return Some(name.clone()) };
        let values: Vec<Option<i64>> = written.indices.iter().map(|e| self.number(e)).collect();
        let mut steps = Vec::new();
        for (value, e) in values.into_iter().zip(&written.indices) {
            let value = value?;
            let Ok(at) = usize::try_from(value) else {
                self.faults.report(Fault::new(e.span, format!("`{name}[{value}]` is out of range")));
                return None;
            };
            steps.push(Step::Index { at, of: 0 });
        }
        Some(Name::at(Path { root: name.ident.clone(), module: None, steps }))
    }

    /// A sum or product over a range, written out.
    fn fold(&mut self, e: &Expression, fold: &Fold) -> Box<Expression> {
        self.check_variable(&fold.variable);
        let mut parts = Vec::new();
        let mut is_sound = true;
        self.repeat(&fold.variable, &fold.range, &mut |this| {
            let before = this.faults.count();
            push(&mut parts, this.unfolded(&fold.body));
            is_sound &= this.faults.count() == before;
            this.note_variables(before);
        });
        with_kind(e, if is_sound { folded(fold, parts) } else { ExpressionKind::Missing })
    }

    /// A name in an expression: a loop variable or count is a number, an entry of an array has its place.
    fn value(&mut self, name: &Name) -> ExpressionKind {
        if self.hidden.contains(&name.text) {
            if !matches!(name.index, Index::None) {
                let text = format!("`{name}` is an argument, and has no entries");
                self.faults.report(Fault::new(name.span(), text));
                return ExpressionKind::Missing;
            }
            return ExpressionKind::Name(name.clone());
        }
        if matches!(name.index, Index::None) {
            let is_variable = self.variables.iter().any(|(variable, _)| *variable == name.text);
            if let Some(value) = self.whole_number(&name.text) {
                if is_variable && !self.may_use_variables {
                    let fault = Fault::new(
                        name.span(),
                        format!("loop variable `{name}` stands for no real number here"),
                    );
                    self.faults.report(
                        fault
                            .note("it counts entries; a real number that depends on it has a name of its own")
                            .help(format!(
                                "declare `let number[{name}] = {name};` in a loop, and use `number[{name}]`"
                            )),
                    );
                    return ExpressionKind::Missing;
                }
                return value.map_or(ExpressionKind::Missing, |value| number(value, name.span()).kind);
            }
        }
        match self.used(name) {
            Some(name) => ExpressionKind::Name(name),
            None => ExpressionKind::Missing,
        }
    }

    /// The name of an entry that is used; none after a fault.
    pub(super) fn used(&mut self, name: &Name) -> Option<Name> {
        if self.arrays.is_confused(&name.text) {
            return None;
        }
        if let Index::Member(member) = &name.index {
            let steps: Vec<Option<Name>> = member.steps.iter().map(|step| self.member(step)).collect();
            let texts = steps.into_iter().map(|step| Some(step?.text)).collect::<Option<Vec<String>>>()?;
            return Some(Name { text: texts.join("."), ident: name.ident.clone(), index: Index::None });
        }
        let Index::Written(written) = &name.index else {
            return match self.arrays.of(&name.text) {
                Some(array) if matches!(name.index, Index::None) => {
                    let first = brackets(&vec![0; array.sizes.len()]);
                    let rank = array.rank();
                    let fault = Fault::new(name.span(), format!("`{name}` is an array, and no single value"));
                    self.faults
                        .report(fault.note(format!("it has {rank}: its first entry is `{name}{first}`")).help(
                        format!(
                            "write the entry that is meant, or a sum over all, `sum(i in 0..n: {name}[i])`"
                        ),
                    ));
                    None
                }
                _ => Some(name.clone()),
            };
        };
        let values: Vec<Option<i64>> = written.indices.iter().map(|e| self.number(e)).collect();
        let values = values.into_iter().collect::<Option<Vec<i64>>>()?;
        let Some(array) = self.arrays.of(&name.text) else {
            if self.arrays.is_single(&name.text) || self.counts.contains_key(&name.text) {
                let text = format!("`{name}` is a single value, and no array");
                self.faults.report(Fault::new(written.brackets, text).help(format!("write `{name}`")));
                return None;
            }
            // The model says that it does not know the name.
            return Some(Name { index: Index::None, ..name.clone() });
        };
        if array.sizes.len() != values.len() {
            let rank = array.rank();
            let text = format!("`{name}` has {rank}, and here are {}", values.len());
            let text = if values.len() == 1 { format!("`{name}` has {rank}, and here is one") } else { text };
            self.faults.report(Fault::new(written.brackets, text));
            return None;
        }
        let mut place = Vec::new();
        for ((value, size), e) in values.iter().zip(&array.sizes).zip(&written.indices) {
            match usize::try_from(*value).ok().filter(|index| index < size) {
                Some(index) => place.push(index),
                None if !self.knows_entries => return None,
                None => {
                    let all: Vec<String> = values.iter().map(ToString::to_string).collect();
                    let text = format!("`{name}[{}]` is out of range", all.join(", "));
                    let first = brackets(&vec![0; array.sizes.len()]);
                    let last: Vec<usize> = array.sizes.iter().map(|size| size.saturating_sub(1)).collect();
                    let fault = Fault::new(e.span, text);
                    let fault = match array.sizes.iter().all(|size| *size > 0) {
                        true => fault.note(format!(
                            "`{name}` runs from `{name}{first}` to `{name}{}`",
                            brackets(&last)
                        )),
                        false => fault.note(format!("`{name}` has no entries")),
                    };
                    self.faults
                        .report(fault.help("indices run from 0, and the last one is the length less one"));
                    return None;
                }
            }
        }
        // A gap has been reported where the array is declared.
        array.has(&place).then(|| Name::at(array.path(name.ident.clone(), &place)))
    }

    /// Reports `q(i)` for `q[i]`.
    fn is_call_of_array(&mut self, function: &Name, arguments: &[Expression]) -> bool {
        let is_one = self.arrays.of(&function.text).is_some();
        if !is_one || self.hidden.contains(&function.text) || arguments.is_empty() || arguments.len() > 2 {
            return false;
        }
        let written: Vec<String> = arguments.iter().map(Expression::source).collect();
        let fault = Fault::new(function.span(), format!("`{function}` is an array, and no function"));
        self.faults.report(
            fault
                .note("indices stand in brackets and run from 0")
                .help(format!("write `{function}[{}]`", written.join(", "))),
        );
        true
    }
}

/// The sum or product of some parts.
fn folded(Fold { function, .. }: &Fold, parts: Vec<Expression>) -> ExpressionKind {
    let is_sum = function.text == "sum";
    let span = function.span();
    let mut parts = parts.into_iter();
    let Some(first) = parts.next() else { return number(i64::from(!is_sum), span).kind };
    let first = Box::new(first);
    if parts.len() == 0 {
        return first.kind;
    }
    if is_sum {
        let rest = parts.map(|value| Term { operator: AddOperator::Plus, span, value }).collect();
        ExpressionKind::Sum { first, rest }
    } else {
        let rest = parts.map(|value| Factor { operator: MultiplyOperator::Times, span, value }).collect();
        ExpressionKind::Product { first, rest }
    }
}

/// An expression at the place of another.
fn with_kind(e: &Expression, kind: ExpressionKind) -> Box<Expression> {
    Box::new(Expression { span: e.span, parentheses: e.parentheses, kind })
}

fn call_of(e: &Expression, function: &Name, arguments: Vec<Expression>, list: Span) -> Box<Expression> {
    with_kind(e, ExpressionKind::Call { function: function.clone(), arguments, list })
}

fn method(
    e: &Expression,
    base: Box<Expression>,
    name: &Name,
    arguments: Vec<Expression>,
    list: Span,
) -> Box<Expression> {
    with_kind(e, ExpressionKind::Method { base, name: name.clone(), arguments, list })
}

fn negation(e: &Expression, operand: Box<Expression>) -> Box<Expression> {
    with_kind(e, ExpressionKind::Negation(operand))
}

/// The sum of terms; zero without one. The operator of the first is a sign.
fn sum(e: &Expression, mut terms: Vec<Term>) -> Box<Expression> {
    if terms.is_empty() {
        return with_kind(e, number(0, e.span).kind);
    }
    let Term { operator, value, .. } = terms.remove(0);
    let mut first = Box::new(value);
    if operator == AddOperator::Minus {
        first = Box::new(Expression::new(first.span, ExpressionKind::Negation(first)));
    }
    match terms.is_empty() {
        true => with_kind(e, first.kind),
        false => with_kind(e, ExpressionKind::Sum { first, rest: terms }),
    }
}

/// Whether a term was a sum over an empty range. Beside other terms it is left out, because these may be vectors.
fn is_empty_sum(written: &Expression, unfolded: &Expression) -> bool {
    let is_sum = matches!(&written.kind, ExpressionKind::Fold(fold) if fold.function.text == "sum");
    is_sum && matches!(&unfolded.kind, ExpressionKind::Number(number) if number.text == "0")
}

fn product(e: &Expression, first: Box<Expression>, rest: Vec<Factor>) -> Box<Expression> {
    with_kind(e, ExpressionKind::Product { first, rest })
}

fn power(e: &Expression, base: Box<Expression>, exponent: Box<Expression>) -> Box<Expression> {
    with_kind(e, ExpressionKind::Power { base, exponent })
}

fn comparison(
    e: &Expression,
    left: Box<Expression>,
    order: Order,
    right: Box<Expression>,
) -> Box<Expression> {
    with_kind(e, ExpressionKind::Comparison { left, order, right })
}

fn push(list: &mut Vec<Expression>, value: Box<Expression>) {
    list.push(*value);
}

fn push_term(terms: &mut Vec<Term>, term: &Term, value: Box<Expression>) {
    terms.push(Term { operator: term.operator, span: term.span, value: *value });
}

fn push_factor(factors: &mut Vec<Factor>, factor: &Factor, value: Box<Expression>) {
    factors.push(Factor { operator: factor.operator, span: factor.span, value: *value });
}

/// A whole number as an expression.
fn number(value: i64, span: Span) -> Expression {
    let text = value.unsigned_abs().to_string();
    let number = Number { digits: text.clone(), exponent: 0, text };
    let number = Expression::new(span, ExpressionKind::Number(number));
    match value < 0 {
        true => Expression::new(span, ExpressionKind::Negation(Box::new(number))),
        false => number,
    }
}

/// The order of the entries of a section, where loops stand between them.
pub(super) fn section_nesting(item: &Item) -> Option<&[EntryNode]> {
    let nesting = match item {
        Item::Constants(section) => &section.nesting,
        Item::Functions(section) => &section.nesting,
        Item::Inputs(section) | Item::Coordinates(section) => &section.nesting,
        Item::Parameters(section) | Item::Outputs(section) => &section.nesting,
        Item::Constraints(section) | Item::Holonomic(section) => &section.nesting,
        Item::Particles(section) => &section.nesting,
        Item::Bodies(section) => &section.nesting,
        Item::States(section) => &section.nesting,
        Item::Switches(section) => &section.nesting,
        Item::Contacts(section) => &section.nesting,
        Item::Resets(section) => &section.nesting,
        Item::Modes(section) => &section.nesting,
        Item::Forces(section) => &section.nesting,
        Item::Scene(scene) => {
            let mut sections = scene.modes.iter().map(|section| &section.nesting);
            sections.find(|nesting| !nesting.is_empty()).unwrap_or(&scene.nesting)
        }
        _ => return None,
    };
    (!nesting.is_empty()).then_some(nesting)
}

/// Calls a function with every name that an item declares or that stands in its expressions, be it behind a point: an entry of an
/// instance's array has its index there, `chain.q[1]`.
pub(super) fn names(item: &Item, visit: &mut dyn FnMut(&Name)) {
    declared(item, visit);
    for e in expressions(item) {
        names_in(e, visit);
    }
}

/// Whether a sum or product over a range stands in an item.
pub(super) fn has_fold(item: &Item) -> bool {
    fn inside(e: &Expression) -> bool {
        matches!(e.kind, ExpressionKind::Fold(_)) || e.children().into_iter().any(inside)
    }
    expressions(item).into_iter().any(inside)
}

fn names_in(e: &Expression, visit: &mut dyn FnMut(&Name)) {
    if let ExpressionKind::Name(name) | ExpressionKind::Field { name, .. } = &e.kind {
        visit(name);
    }
    e.children().into_iter().for_each(|child| names_in(child, visit));
}

fn contacts_in(statement: &ModeStatement, visit: &mut dyn FnMut(&Name)) {
    match statement {
        ModeStatement::States { contact, .. } => visit(contact),
        ModeStatement::Never { combination, .. } => {
            combination.iter().for_each(|(contact, _)| visit(contact));
        }
    }
}

fn declared(item: &Item, visit: &mut dyn FnMut(&Name)) {
    match item {
        Item::Constants(section) => section.entries.iter().for_each(|entry| visit(&entry.name)),
        Item::Inputs(section) | Item::Coordinates(section) => {
            section.entries.iter().for_each(|entry| visit(&entry.name));
        }
        Item::Functions(section) => section.entries.iter().for_each(|entry| visit(&entry.name)),
        Item::Let(definition) => visit(&definition.name),
        Item::Use(instance) => visit(&instance.name),
        Item::Parameters(section) | Item::Outputs(section) => {
            section.entries.iter().for_each(|entry| visit(&entry.name));
        }
        Item::Constraints(section) | Item::Holonomic(section) => {
            section.entries.iter().for_each(|entry| visit(&entry.name));
        }
        Item::Bodies(section) => section.entries.iter().for_each(|entry| visit(&entry.name)),
        Item::States(section) => section.entries.iter().for_each(|entry| visit(&entry.name)),
        Item::Switches(section) => section.entries.iter().for_each(|entry| visit(&entry.name)),
        Item::Contacts(section) => section.entries.iter().for_each(|entry| visit(&entry.name)),
        Item::Resets(section) => section.entries.iter().for_each(|entry| visit(&entry.name)),
        Item::Modes(section) => section.entries.iter().for_each(|statement| contacts_in(statement, visit)),
        Item::Scene(scene) => {
            let statements = scene.modes.iter().flat_map(|section| &section.entries);
            statements.for_each(|statement| contacts_in(statement, visit));
            scene.tracks.iter().for_each(&mut *visit);
            scene.fixes.iter().for_each(|fix| visit(&fix.name));
            scene.provides.iter().for_each(|provide| {
                visit(&provide.name);
                provide.of.iter().flatten().for_each(&mut *visit);
            });
        }
        Item::Provide(section) => section.entries.iter().for_each(|entry| visit(&entry.name)),
        _ => {}
    }
}

fn expressions(item: &Item) -> Vec<&Expression> {
    match item {
        Item::Scene(scene) => scene.fixes.iter().filter_map(|fix| fix.value.as_ref()).collect(),
        _ => item.expressions(),
    }
}
