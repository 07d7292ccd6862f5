//! The declaration in words, and the page of rustdoc.

use super::lines::{ReportLines, SectionLines};
use super::mathml::paragraph;
use crate::derive::Subject;
use crate::model::{SymbolEntry, momentum, reaction};
use crate::syntax::{Docs, Item};

/// Constants as they are declared, coordinates and inputs, each with the first line of its documentation.
pub(super) fn declared(subject: &Subject<'_, '_>) -> Vec<SectionLines> {
    let model = subject.model;
    let line = |name: &str, docs: &Docs| {
        // Documentation that a macro writes is not known here.
        let texts = docs.values.iter().filter_map(|value| syn::parse2::<syn::LitStr>(value.clone()).ok());
        let first = texts.map(|text| text.value().trim().to_owned()).find(|text| !text.is_empty());
        first.map_or_else(|| name.to_owned(), |first| format!("{name}: {first}"))
    };
    let unit = |name: &str| model.units.get(name).map_or(String::new(), |unit| format!(": {unit}"));
    let symbols = |entries: &[SymbolEntry<'_>]| -> Vec<String> {
        entries
            .iter()
            .map(|entry| line(&format!("{}{}", entry.name.text, unit(&entry.name.text)), entry.docs))
            .collect()
    };
    let constants = model.declaration.items.iter().flat_map(|item| match item {
        Item::Constants(section) => &section.entries[..],
        _ => &[],
    });
    let constants = constants.zip(&model.constants).map(|(declared, known)| {
        let bound = known.bound.map_or(String::new(), |bound| format!(" {}", bound.relation()));
        let limits = declared.limits.as_deref();
        let limits = limits.map(|[lower, upper]| format!(" in {}..{}", lower.source(), upper.source()));
        let bound = format!("{bound}{}", limits.unwrap_or_default());
        // A number as it was written; with operations the sum and product that were read.
        let written = declared.default.as_ref().map(ToString::to_string).filter(|text| !text.contains('('));
        let default = written.or_else(|| known.default.map(|e| model.bench.graph.text(e)));
        let default = default.map_or(String::new(), |text| format!(" = {text}"));
        line(&format!("{}{}{bound}{default}", known.name.text, unit(&known.name.text)), known.docs)
    });
    let constants = constants.collect();
    let functions = model.functions.iter().map(|function| {
        let arguments: Vec<&str> = function.arguments.iter().map(|name| name.text.as_str()).collect();
        line(&format!("{}({})", function.name.text, arguments.join(", ")), &function.docs)
    });
    let derived = model.forms.iter().map(|form| form.name.as_str());
    let derived = derived.chain(model.outputs.iter().map(|output| output.name.text.as_str()));
    let derived =
        derived.filter(|name| model.units.contains_key(*name)).map(|name| format!("{name}{}", unit(name)));
    let derived: Vec<String> = derived.collect();
    let derivation = &subject.level.derivation;
    let l = derivation.system.forms.degrees;
    let momenta = model.forms.iter().zip(&derivation.known_momentum).filter(|(_, known)| **known);
    let momenta = momenta.map(|(form, _)| momentum(&form.name));
    let reactions = model.forms[l..].iter().zip(&derivation.reactions).filter(|(_, known)| known.is_some());
    let reactions = reactions.map(|(form, _)| reaction(&form.name));
    let of_forms = momenta.chain(reactions).filter(|name| model.units.contains_key(name));
    let of_forms: Vec<String> = of_forms.map(|name| format!("{name}{}", unit(&name))).collect();
    vec![
        SectionLines::words("Constants", constants),
        SectionLines::words("Functions of the program", functions.collect()),
        SectionLines::words("Coordinates", symbols(&model.coordinates)),
        SectionLines::words("Inputs", symbols(&model.inputs)),
        SectionLines::words("States", symbols(&model.states)),
        SectionLines::words("Units that follow", derived),
        SectionLines::words("Units of momenta and reactions", of_forms),
    ]
}

/// The mark before and behind a formula that is a line of a page.
const FORMULA: &str = "$$";

/// A page with its formulas as MathML. That is made where rustdoc reads the page, and not where a system is expanded.
pub fn set(page: &str) -> String {
    let mut text = String::new();
    for line in page.lines() {
        match line.strip_prefix(FORMULA).and_then(|rest| rest.strip_suffix(FORMULA)) {
            Some(formula) => text.push_str(&paragraph(formula)),
            None => text.push_str(line),
        }
        text.push('\n');
    }
    text
}

impl ReportLines {
    /// The whole as Markdown for rustdoc: formulas as LaTeX between `$$`, for [`set`] to set, and what is longer than a few
    /// lines as text.
    pub fn to_page(&self) -> String {
        let sections = self.sections.iter();
        page(&self.summary, sections.map(|section| (section.title, &section.text[..], &section.latex[..])))
    }
}

/// The sections that a page begins with, where all of their formulas can be set: what most readers come for.
const FIRST: [&str; 2] = ["Equations of motion", "Velocities"];

/// Formulas that are longer are left to the text: a page of one formula helps no reader.
const FORMULA_CHARACTERS: usize = 1500;

/// A page of a summary and sections: title, lines, formulas. The equations come first, unless they are too long to be read.
pub(crate) fn page<'s>(
    summary: &str,
    sections: impl Iterator<Item = (&'s str, &'s [String], &'s [String])>,
) -> String {
    let mut sections: Vec<_> = sections.collect();
    sections.sort_by_key(|(title, _, formulas)| {
        let is_legible = formulas.iter().all(|formula| formula.len() <= FORMULA_CHARACTERS);
        FIRST.iter().position(|first| is_legible && title.starts_with(first)).unwrap_or(FIRST.len())
    });
    let mut text = format!("{summary}\n");
    for (title, lines, formulas) in sections {
        text.push_str(&format!("\n# {title}\n\n"));
        for (formula, plain) in formulas.iter().zip(lines) {
            if formula.len() <= FORMULA_CHARACTERS {
                text.push_str(&format!("{FORMULA}{formula}{FORMULA}\n\n"));
            } else {
                text.push_str(&format!("```text\n{plain}\n```\n\n"));
            }
        }
        for line in lines.iter().skip(formulas.len()) {
            // What has operators of the language in it would be taken for Markdown.
            text.push_str(&format!("- {}\n", escaped(line)));
        }
    }
    text
}

/// Words of a report as Markdown; what is between backticks stays code.
fn escaped(line: &str) -> String {
    let mut escaped = String::new();
    let mut in_code = false;
    for c in line.chars() {
        in_code ^= c == '`';
        if !in_code && "\\*_[]<>#|~".contains(c) {
            escaped.push('\\');
        }
        escaped.push(c);
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::page;

    fn headings(formula: &str) -> Vec<String> {
        let (words, formula) = (["a".to_owned()], [formula.to_owned()]);
        let sections: [(&str, &[String], &[String]); 4] = [
            ("Coordinates", &words, &[]),
            ("Velocities (1.8)", &words, &["v = 0".to_owned()]),
            ("Equations of motion (2.7)", &words, &formula),
            ("Momenta (2.8)", &words, &[]),
        ];
        let text = page("A system.", sections.into_iter());
        assert!(text.starts_with("A system.\n"), "{text}");
        text.lines().filter_map(|line| line.strip_prefix("# ")).map(str::to_owned).collect()
    }

    #[test]
    fn a_page_begins_with_its_equations_where_they_can_be_read() {
        let [equations, velocities] = ["Equations of motion (2.7)", "Velocities (1.8)"];
        assert_eq!(headings("x = 0"), [equations, velocities, "Coordinates", "Momenta (2.8)"]);
        let long = "x + ".repeat(1000);
        assert_eq!(headings(&long), [velocities, "Coordinates", equations, "Momenta (2.8)"]);
    }
}
