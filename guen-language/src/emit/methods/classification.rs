//! Classification and costs as constants, and the marker traits.

use guen_symbolic::Class;
use proc_macro2::TokenStream;

use crate::derive::{Subject, function};
use crate::emit::layouts::layout::Layout;
use crate::emit::layouts::text::{counts, tokens};

/// The traits that mark classes and properties.
const MARKERS: [&str; 8] = [
    "Holonomic",
    "LieGroup",
    "Nonholonomic",
    "IncompleteLieGroup",
    "Scleronomic",
    "Rheonomic",
    "Catastatic",
    "Conservative",
];

pub(in crate::emit) fn items(subject: &Subject<'_, '_>, layout: &Layout, is_outline: bool) -> TokenStream {
    let derivation = &subject.level.derivation;
    let system = &layout.system;
    let class = match derivation.class {
        _ if is_outline => "Undecided",
        Class::LieGroup => "HolonomicConstant",
        Class::Holonomic => "HolonomicVariable",
        Class::IncompleteLieGroup => "NonholonomicConstant",
        Class::Nonholonomic => "NonholonomicVariable",
        Class::Undecided => "Undecided",
    };
    let growth = &derivation.closure.growth;
    let steps = growth.len();
    let integrable = derivation.closure.integrable.len();
    let unfinished = (!derivation.closure.complete)
        .then_some(" The brackets of this system were not followed to the end: this is what is known.");
    let complete = derivation.closure.complete;
    let (scleronomic, catastatic, conservative) =
        (derivation.scleronomic, derivation.catastatic, derivation.conservative);
    let rhs = subject.level.program(function::RHS).map(|f| f.cost).unwrap_or_default();
    let (cost, prepare_cost) = (counts(&rhs), counts(&subject.level.programs.prepare_cost));
    let domain = &subject.level.domain_names;
    let domain_count = domain.len();
    let mut markers = Vec::new();
    match derivation.class {
        Class::LieGroup => markers.extend(["Holonomic", "LieGroup"]),
        Class::Holonomic => markers.push("Holonomic"),
        Class::IncompleteLieGroup => markers.extend(["Nonholonomic", "IncompleteLieGroup"]),
        Class::Nonholonomic => markers.push("Nonholonomic"),
        Class::Undecided => {}
    }
    markers.push(if scleronomic { "Scleronomic" } else { "Rheonomic" });
    if catastatic {
        markers.push("Catastatic");
    }
    if conservative {
        markers.push("Conservative");
    }
    if is_outline {
        markers = MARKERS.to_vec();
    }
    let owners: &[&str] = if layout.inputs > 0 { &["Prepared", "Driven"] } else { &["Prepared"] };
    // The macro knows no further parameters.
    let further = owners.iter().filter(|_| !layout.supplied.is_empty()).flat_map(|owner| {
        markers.iter().map(move |marker| format!("impl<R> __guen::{marker} for {owner}<R> {{}} "))
    });
    let further: String = further.collect();
    let owners = if layout.supplied.is_empty() { owners } else { &[] };
    let owners: String = owners.iter().map(|owner| format!("[{}] {owner} ", markers.join(" "))).collect();
    let list = |counts: &[u32]| counts.iter().map(ToString::to_string).collect::<Vec<_>>().join(" ");
    let growth = growth.iter().map(ToString::to_string).collect::<Vec<_>>().join(" ");
    let unfinished = unfinished.map(|note| format!("{note:?}")).unwrap_or_default();
    let literals =
        |texts: &[String]| texts.iter().map(|text| format!("{text:?}")).collect::<Vec<_>>().join(" ");
    let switches = &subject.level.switches;
    let switches = match switches.len() {
        0 => String::new(),
        count => format!(
            "/// The functions at whose zeros the rates change their formula, in the names of the declaration: those of `min`, `max`,
            /// `select` and the others. Methods that choose their steps locate these zeros.
            pub const SWITCHES: [&str; {count}] = [{}];",
            switches.iter().map(|text| format!("{text:?}")).collect::<Vec<_>>().join(", "),
        ),
    };
    tokens(&format!(
        "{switches} __guen::facts! {{ {system} {class} [{growth}] {steps} {integrable} {complete} [{unfinished}] {scleronomic} {catastatic}
        {conservative} [{}] [{}] [{}] [{}] {domain_count} {owners} }} {further}",
        list(&cost),
        list(&prepare_cost),
        literals(domain),
        literals(&subject.level.domain_reasons),
    ))
}
