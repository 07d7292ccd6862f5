//! What stands in for a faulty declaration has the signatures of the real items.

use std::collections::BTreeSet;

use guen_language::derive::derive;
use guen_language::diagnostics::collect;
use guen_language::model;
use guen_language::names::module_name;
use guen_language::syntax::{Declaration, Fix, Item};
use guen_language::{expand_outline, parse};
use proc_macro2::{Delimiter, Group, TokenStream, TokenTree};

use crate::common::fault_messages;

/// The signatures of items without documentation, attributes and bodies.
fn signatures(items: TokenStream, scope: &Scope, found: &mut BTreeSet<String>) {
    let mut trees = items.into_iter().peekable();
    let mut head: Vec<TokenTree> = Vec::new();
    while let Some(tree) = trees.next() {
        match &tree {
            TokenTree::Punct(mark) if mark.as_char() == '#' => drop(trees.next()),
            TokenTree::Punct(mark) if mark.as_char() == ';' => {
                scope.add(&std::mem::take(&mut head), None, found)
            }
            TokenTree::Group(body) if body.delimiter() == Delimiter::Brace && !is_value(&head) => {
                scope.add(&std::mem::take(&mut head), Some(body.stream()), found);
            }
            _ => head.push(tree),
        }
    }
}

fn is_word(tree: &TokenTree, word: &str) -> bool {
    matches!(tree, TokenTree::Ident(ident) if ident == word)
}

fn is_mark(tree: &TokenTree, mark: char) -> bool {
    matches!(tree, TokenTree::Punct(punct) if punct.as_char() == mark)
}

/// Whether the head of an item is already at the value of a constant.
fn is_value(head: &[TokenTree]) -> bool {
    head.iter().any(|tree| is_word(tree, "const")) && head.iter().any(|tree| is_mark(tree, '='))
}

/// Macros of the runtime that take what was derived beside sizes and names.
const OF_DERIVATION: [&str; 11] = [
    "facts",
    "reported",
    "operators",
    "reduce",
    "domain",
    "dynamics",
    "motion_of_system",
    "prepare",
    "prepared",
    "program",
    "source",
];

/// A scope of items: the path of modules and impls, and whether it is a scene or a carried form, whose variables and
/// sizes are known by the derivation alone.
struct Scope {
    path: String,
    modules: usize,
}

impl Scope {
    fn inside(&self, head: &[TokenTree], modules: usize) -> Scope {
        Scope { path: format!("{}{} :: ", self.path, self.text(head)), modules: self.modules + modules }
    }

    fn text(&self, trees: &[TokenTree]) -> String {
        let text = trees.iter().cloned().collect::<TokenStream>();
        if self.modules < 2 { text.to_string() } else { without_numbers(text).to_string() }
    }

    fn add(&self, head: &[TokenTree], body: Option<TokenStream>, found: &mut BTreeSet<String>) {
        let has = |word| head.iter().any(|tree| is_word(tree, word));
        let path = &self.path;
        if let Some(place) = head.iter().position(|tree| is_mark(tree, '!')) {
            let name = &head[..place];
            // The places of names are no items.
            if name.last().is_some_and(|word| is_word(word, "uses")) {
                return;
            }
            let is_of_derivation =
                name.iter().any(|word| OF_DERIVATION.iter().any(|known| is_word(word, known)));
            let mut arguments = body.unwrap_or_else(|| head[place + 1..].iter().cloned().collect());
            if name.last().is_some_and(|word| is_word(word, "record")) && self.modules < 2 {
                return found.extend(fields(arguments).into_iter().map(|field| format!("{path}{field}")));
            }
            if is_of_derivation || self.modules > 1 {
                arguments = TokenStream::new();
            }
            found.insert(format!("{path}{} ! {arguments}", self.text(name)));
        } else if has("mod") {
            let is_private = ["program", "placed", "missing"].into_iter().any(has);
            let inside = self.inside(head, 1);
            body.filter(|_| !is_private).into_iter().for_each(|body| signatures(body, &inside, found));
        } else if has("impl") {
            found.insert(format!("{path}{}", self.text(head)));
            // Methods of traits have the signatures of the trait.
            let inside = self.inside(head, 0);
            body.filter(|_| !has("for")).into_iter().for_each(|body| signatures(body, &inside, found));
        } else if has("struct") {
            found.insert(format!("{path}{}", self.text(head)));
            let fields: Vec<TokenTree> = body.into_iter().flatten().collect();
            for field in fields.split(|tree| is_mark(tree, ',')) {
                if let Some(start) = field.iter().position(|tree| is_word(tree, "pub")) {
                    found.insert(format!("{path}{} {{ {} }}", self.text(head), self.text(&field[start..])));
                }
            }
        } else if has("pub") && !has("use") && !has("missing") && !has("super") {
            let end = head.iter().position(|tree| has("const") && is_mark(tree, '='));
            found.insert(format!("{path}{}", self.text(&head[..end.unwrap_or(head.len())])));
        }
    }
}

/// The fields of a record, as `Record field`.
fn fields(arguments: TokenStream) -> Vec<String> {
    let trees = arguments.into_iter().filter(|tree| !is_mark(tree, '#'));
    let trees: Vec<TokenTree> = trees.filter(|tree| !matches!(tree, TokenTree::Group(_))).collect();
    let entries = trees[2..].split(|tree| is_mark(tree, ',')).filter_map(|entry| entry.first());
    entries.map(|field| format!("{} {field}", trees[0])).collect()
}

fn without_numbers(tokens: TokenStream) -> TokenStream {
    let kept = tokens.into_iter().filter(|tree| !matches!(tree, TokenTree::Literal(_)));
    let kept = kept.map(|tree| match tree {
        TokenTree::Group(group) => Group::new(group.delimiter(), without_numbers(group.stream())).into(),
        other => other,
    });
    kept.collect()
}

/// The modules of scenes of which the derivation alone knows which inputs they have, or which constants follow others.
fn unknown_scene(declaration: &Declaration) -> impl Fn(&Item) -> Option<String> {
    let has_inputs = declaration.items.iter().any(|item| matches!(item, Item::Inputs(_)));
    move |item| {
        let Item::Scene(scene) = item else { return None };
        let is_number = |fix: &Fix| fix.value.as_ref().is_none_or(|value| value.as_number().is_some());
        let is_known = !has_inputs && scene.fixes.iter().all(is_number);
        (!is_known).then(|| format!("pub mod {} ::", module_name(&scene.name.ident, "scene")))
    }
}

/// The signatures of the real items that are not among those of the outline.
pub fn missing(declaration: &Declaration, items: TokenStream) -> Vec<String> {
    let (mut wanted, mut there) = (BTreeSet::new(), BTreeSet::new());
    let stand_in = guen_language::outline::sound(declaration);
    let (_, report) = collect(|faults| derive(model::resolve(&stand_in, faults)?, faults));
    if !report.is_empty() {
        return report
            .errors()
            .map(|(_, message)| format!("what stands in has a fault: {message}"))
            .collect();
    }
    let crate_root = Scope { path: String::new(), modules: 0 };
    signatures(items, &crate_root, &mut wanted);
    signatures(expand_outline(declaration), &crate_root, &mut there);
    let unknown: Vec<String> = declaration.items.iter().filter_map(unknown_scene(declaration)).collect();
    let is_known = |item: &&String| !unknown.iter().any(|module| item.contains(module));
    let [wanted, there] = [wanted, there].map(without_digests);
    wanted.difference(&there).filter(is_known).cloned().collect()
}

/// Signatures without digests of declarations, and without the numbers of a text of C: what stands in for a faulty declaration has others.
fn without_digests(signatures: BTreeSet<String>) -> BTreeSet<String> {
    let is_digest = |word: &str| word.parse::<u64>().is_ok_and(|number| number > u64::from(u32::MAX));
    let without = |item: String| {
        let item = item.split(" :: sourced ! (").next().unwrap_or_default();
        let words: Vec<&str> = item.split(' ').map(|word| if is_digest(word) { "_" } else { word }).collect();
        words.join(" ")
    };
    signatures.into_iter().map(without).collect()
}

/// The outline of a declaration as text without blanks.
fn of(text: &str) -> String {
    let (declaration, _) = parse::parse(text.parse().unwrap());
    let items = expand_outline(&declaration.unwrap()).to_string();
    items.split_whitespace().collect()
}

#[test]
fn forms_need_not_be_as_many_as_coordinates() {
    for forms in [
        "parameters { u = dot(x); }",
        "parameters { u = dot(x); v = dot(y); w = dot(x); }",
        "parameters { u = dot(x); } constraints { a: dot(y) = 0; b: dot(x) = 0; c: vec(x, y, 0) = vec(y, x, x); }",
        "holonomic { a: x = y; b: x + y = 0; c: x = 2*y; }",
        "",
    ] {
        let outline =
            of(&format!("system S {{ coordinates {{ x, y }} {forms} kinetic_energy = dot(x)^2; }}"));
        assert!(outline.contains("structS<R=f64>"), "{forms}: {outline}");
        assert!(outline.contains("Coordinates2usize"), "{forms}: {outline}");
    }
    assert!(of("system S { kinetic_energy = 1; }").contains("structS<R=f64>"));
    let carried = |parameters: &str| {
        of(&format!(
            "system S {{ coordinates {{ x }} {parameters} provide carried, taylor; kinetic_energy = y; }}"
        ))
    };
    assert!(carried("parameters { u = dot(x); }").contains("modcarried"));
    let written = |further: &str| {
        of(&format!(
            "system S {{ functions {{ f(x); }} coordinates {{ x }} parameters {{ u = dot(x); }} kinetic_energy = u^2; potential_energy = f(x) + y; {further} }}"
        ))
    };
    assert!(written("provide source;").contains("source!(\"s\",\"\",true,true,false)"));
    let in_scene = written("contacts { floor: gap = x; } scene T { provide source; }");
    assert!(in_scene.contains("source!(\"s_t\",\"\",true,true,false)"), "{in_scene}");
    // Without an equation of motion there is nothing to carry.
    assert!(carried("").contains("structS<R=f64>"));
}

/// Names that are reserved or declared twice are fields all the same.
#[test]
fn faulty_names_are_fields() {
    let outline = of(
        "system S { constants { m, pi } coordinates { m, x } parameters { t = dot(x); __guen_y = dot(m); } outputs { energy = x; } }",
    );
    for field in ["pubpi:R", "#[doc=\"Thecoordinate`other_m`.\"]pubm:R", "pubenergy:R"] {
        assert!(outline.contains(field), "{field} is not in {outline}");
    }
    assert!(outline.contains("]pubt:R") && outline.contains("]pub__guen_y:R"), "{outline}");
}

/// Two fields of one name would be an error of the compiler beside ours.
#[test]
fn no_field_is_there_twice() {
    for faulty in [
        "coordinates { x, x, y } parameters { x = dot(x); y = dot(y); }",
        "coordinates { x, y, z, a } parameters { w = vec(dot(x), dot(y), dot(z)); w_x = dot(x); }",
        "coordinates { x, y, z } parameters { u = dot(x); } constraints { u: dot(x) = 0; c: dot(y) = 0; c: dot(z) = 0; }",
        "coordinates { a, b, c, d } parameters { u = dot(a); }",
    ] {
        let (declaration, _) = parse::parse(format!("system S {{ {faulty} }}").parse().unwrap());
        let mut seen = BTreeSet::new();
        for record in records(expand_outline(&declaration.unwrap())) {
            fields(record)
                .into_iter()
                .for_each(|field| assert!(seen.insert(field.clone()), "{faulty}: {field}"));
        }
        assert!(seen.len() > 5, "{faulty}");
    }
}

/// The arguments of `record!`.
fn records(items: TokenStream) -> Vec<TokenStream> {
    let trees: Vec<TokenTree> = items.into_iter().collect();
    let mut found = Vec::new();
    for (place, tree) in trees.iter().enumerate() {
        let TokenTree::Group(group) = tree else { continue };
        let before = &trees[place.saturating_sub(2)..place];
        match before {
            [name, mark] if is_word(name, "record") && is_mark(mark, '!') => found.push(group.stream()),
            _ => found.extend(records(group.stream())),
        }
    }
    found
}

/// The name of a system may be the fault; then there would be two items of one name.
#[test]
fn a_name_that_is_taken_has_no_outline() {
    assert_eq!(of("system State { coordinates { x } parameters { u = dot(x); } kinetic_energy = u^2; }"), "");
}

/// A module of an instance beside an item of that name would be an error of the compiler beside ours.
#[test]
fn an_instance_whose_name_is_taken_has_a_module_of_another_name() {
    for (instance, further, fault) in [
        ("program", "", "the module of the system has an item `program` of its own"),
        ("carried", "provide carried;", "the module of the system has an item `carried` of its own"),
        ("Mode", "", "the module of the system has an item `Mode` of its own"),
        ("Cart", "", "the module of the system has an item `Cart` of its own"),
        ("Turned", "scene Turned { track x; }", "scene `Turned` has a type of that name"),
        ("turned", "scene Turned { track x; }", "scene `Turned` has a module of that name"),
    ] {
        let text = format!(
            "system Cart {{
                component Wheel(hub: vector) {{
                    constants {{ m > 0 }} coordinates {{ z }} particles {{ m at hub + vec(0, z); }} contacts {{ sole: gap = z; }}
                }}
                coordinates {{ x }}
                particles {{ 1 at vec(x, 0); }}
                use Wheel as {instance} {{ hub: vec(x, 0) }}
                {further}
            }}"
        );
        let (declaration, report) = parse::parse(text.parse().unwrap());
        let messages = report.to_string();
        let expected = format!("an instance cannot be called `{instance}`\nnote: {fault}");
        assert!(messages.contains(&expected) && report.faults().len() == 1, "{messages}");
        let outline: String = expand_outline(&declaration.unwrap()).to_string().split_whitespace().collect();
        for module in ["State<R>", "Constants<R>", "Mode"] {
            let field = format!("pub{instance}:other_{instance}::{module},");
            assert!(outline.contains(&field), "{field} is not in {outline}");
        }
        assert!(outline.contains(&format!("pubmodother_{instance}{{")), "{outline}");
        let scenes = further.matches("scene").count();
        assert_eq!(outline.matches("pubuseturned::Turned;").count(), scenes, "{outline}");
        assert_eq!(outline.matches("pubmodturned{").count(), scenes, "{outline}");
    }
    let text = "system Cart {
        component Wheel(hub: vector) { coordinates { z } particles { 1 at hub + vec(0, z); } }
        coordinates { x }
        particles { 1 at vec(x, 0); }
        contacts { foot: gap = x; }
        use Wheel as Foot { hub: vec(x, 0) }
    }";
    let found = fault_messages(text);
    assert_eq!(found, ["a contact cannot be called `foot` here"]);
}
