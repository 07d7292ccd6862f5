//! The arguments of a use against those that the component declares.

use crate::diagnostics::{Fault, Faults};
use crate::names::{nearest, quoted};
use crate::syntax::{
    AddOperator, Argument, ArgumentKind, Component, DeclaredArgument, Expression, ExpressionKind, Item,
    MultiplyOperator, Name, Path, Use,
};

/// The arguments as names of the instance, in the order of the component.
pub(super) fn items(instance: &Use, component: &Component, path: &Path, faults: &mut Faults) -> Vec<Item> {
    let declared = || component.arguments.iter().map(|argument| argument.name.text.as_str());
    for given in &instance.arguments {
        if declared().any(|name| name == given.name.text) {
            continue;
        }
        let text = format!("`{}` has no argument `{}`", component.name, given.name);
        let fault = Fault::new(given.name.span(), text);
        let in_struct = component.items.iter().find_map(|item| {
            let what = match item {
                Item::Constants(_) => "constant",
                Item::Functions(_) => "function",
                _ => return None,
            };
            item.declared().iter().any(|name| name.text == given.name.text).then_some(what)
        });
        faults.report(if let Some(what) = in_struct {
            fault
                .note(format!("`{}` is a {what} of `{}`", given.name, component.name))
                .help(format!("give it where the system is made, in the field `{}`", instance.name))
        } else if let Some(near) = nearest(&given.name.text, declared()) {
            fault.help(format!("did you mean `{near}`?"))
        } else if component.arguments.is_empty() {
            fault.note(format!("`{}` has no arguments", component.name))
        } else {
            fault.help(format!("the arguments are {}", quoted(declared())))
        });
    }
    let missing: Vec<&DeclaredArgument> = component
        .arguments
        .iter()
        .filter(|argument| instance.arguments.iter().all(|given| given.name.text != argument.name.text))
        .collect();
    if !missing.is_empty() {
        let names = quoted(missing.iter().map(|argument| argument.name.text.as_str()));
        let what = if missing.len() == 1 { "argument" } else { "arguments" };
        let of = format!("`{}` is used without its {what} {names}", component.name);
        let kinds: Vec<String> =
            missing.iter().map(|argument| format!("{}: {}", argument.name, argument.kind.word())).collect();
        let fault = Fault::new(instance.path.name.span(), of);
        faults.report(fault.note(format!("declared as {}", kinds.join(", "))).help(format!(
            "write `use {} as {} {{ {} }}`",
            instance.path.text,
            instance.name,
            missing.iter().map(|argument| format!("{}: ..", argument.name)).collect::<Vec<_>>().join(", ")
        )));
    }
    // Nothing is known of a value whose kind is not.
    let values = component
        .arguments
        .iter()
        .filter(|argument| argument.is_sound && argument.kind != ArgumentKind::Count);
    let pairs = values.filter_map(|argument| {
        Some((argument, instance.arguments.iter().find(|given| given.name.text == argument.name.text)?))
    });
    let items = pairs.map(|(argument, given)| {
        Item::Argument(Argument {
            name: super::prefix::name(&argument.name, path),
            kind: argument.kind,
            component: component.name.clone(),
            given: given.clone(),
        })
    });
    items.collect()
}

/// The values of the counts among the arguments; none where one is missing or no count.
pub(super) fn counts<'c>(
    instance: &Use,
    component: &'c Component,
    faults: &mut Faults,
) -> Option<Vec<(&'c Name, i64)>> {
    let (mut counts, mut are_sound) = (Vec::new(), true);
    for argument in component.counts() {
        let name = &argument.name;
        let Some(given) = instance.arguments.iter().find(|given| given.name.text == name.text) else {
            // It is reported with the other arguments.
            items(instance, component, &super::prefix::path_of(&instance.name), faults);
            return None;
        };
        let value = &given.value;
        match whole(value) {
            Some(number) if number >= 0 => counts.push((name, number)),
            Some(number) => {
                are_sound = false;
                let text = format!("count `{name}` is {number}, and a count is a whole number from 0 on");
                faults.report(Fault::new(value.extent(), text));
            }
            None if value.has_missing() => return None,
            None => {
                are_sound = false;
                let text =
                    format!("`{name}` of `{}` is a count, and this is no whole number", component.name);
                let fault = Fault::new(value.extent(), text);
                faults.report(fault.note(
                    "a count is known while the program is compiled: it is made of numbers, counts and loop variables",
                ));
            }
        }
    }
    // The number of faults does not tell: in a loop the same one is reported once.
    are_sound.then_some(counts)
}

/// The value of an expression of whole numbers, as indices are computed: a quotient is cut off.
fn whole(e: &Expression) -> Option<i64> {
    match &e.kind {
        ExpressionKind::Number(number) => number.text.replace('_', "").parse().ok(),
        ExpressionKind::Negation(operand) => whole(operand)?.checked_neg(),
        ExpressionKind::Sum { first, rest } => rest.iter().try_fold(whole(first)?, |sum, term| {
            let value = whole(&term.value)?;
            match term.operator {
                AddOperator::Plus => sum.checked_add(value),
                AddOperator::Minus => sum.checked_sub(value),
            }
        }),
        ExpressionKind::Product { first, rest } => rest.iter().try_fold(whole(first)?, |product, factor| {
            let value = whole(&factor.value)?;
            match factor.operator {
                MultiplyOperator::Times => product.checked_mul(value),
                MultiplyOperator::Over => product.checked_div(value),
            }
        }),
        _ => None,
    }
}
