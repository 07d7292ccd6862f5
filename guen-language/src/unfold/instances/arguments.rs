//! The arguments of a use against those that the component declares.

use crate::diagnostics::{Fault, Faults};
use crate::names::{nearest, quoted};
use crate::syntax::{Argument, Component, DeclaredArgument, Item, Path, Use};

/// The arguments as names of the instance, in the order of the component.
pub(super) fn items(instance: &Use, component: &Component, path: &Path, faults: &mut Faults) -> Vec<Item> {
    let declared = || component.arguments.iter().map(|argument| argument.name.text.as_str());
    for given in &instance.arguments {
        if declared().any(|name| name == given.name.text) {
            continue;
        }
        let text = format!("`{}` has no argument `{}`", component.name, given.name);
        let fault = Fault::new(given.name.span(), text);
        let is_constant = component.items.iter().any(|item| {
            matches!(item, Item::Constants(_))
                && item.declared().iter().any(|name| name.text == given.name.text)
        });
        faults.report(if is_constant {
            fault
                .note(format!("`{}` is a constant of `{}`", given.name, component.name))
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
    let pairs = component.arguments.iter().filter_map(|argument| {
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
