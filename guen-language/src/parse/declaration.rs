//! The head of a declaration, and its sections one after the other.

use proc_macro2::{Delimiter, Group, Span, TokenStream, TokenTree};

use super::attributes::docs;
use super::components::{HELP_COMPONENT, component, instance};
use super::cursor::Cursor;
use super::index;
use super::lists::{INPUT, plain_names, stray_semicolon};
use super::names::name;
use super::nesting::Entries;
use super::punctuation::{equals, semicolon};
use super::{
    bodies, constants, contacts, definitions, energies, equations, forces, functions, modes, particles,
    resets, scene, states,
};
use crate::diagnostics::{Fault, Faults, Reported};
use crate::limits::{MAX_COORDINATES, MAX_ENTRIES, MAX_SCENES, MAX_TOKENS};
use crate::names::{PARAMETER_ALIASES, SECTIONS, instead_of_section, nearest_section, quoted};
use crate::syntax::{
    Component, Count, Declaration, Docs, EntryNode, IndexExpression, IndexKind, Item, Name, Section,
    SectionKind, Visibility,
};

const HELP_SYSTEM: &str = "a declaration reads `pub system Name { .. }`";

/// Reads an invocation of the macro.
pub(crate) fn declaration(tokens: TokenStream, faults: &mut Faults) -> Option<Declaration> {
    if has_too_many_tokens(&tokens) {
        faults
            .report(Fault::new(Span::call_site(), format!("a declaration of more than {MAX_TOKENS} tokens")));
        return None;
    }
    let end = tokens.clone().into_iter().last().map_or_else(Span::call_site, |token| token.span());
    let mut cursor = Cursor::new(tokens.clone(), end);
    let declaration = system(&mut cursor, faults).ok();
    if declaration.is_some() {
        after_system(&mut cursor, faults);
    }
    declaration.map(|declaration| Declaration { tokens, ..declaration })
}

/// Reads an invocation of the macro for components.
pub(crate) fn declared_component(tokens: TokenStream, faults: &mut Faults) -> Option<Component> {
    if has_too_many_tokens(&tokens) {
        let text = format!("a component of more than {MAX_TOKENS} tokens");
        faults.report(Fault::new(Span::call_site(), text));
        return None;
    }
    let end = tokens.clone().into_iter().last().map_or_else(Span::call_site, |token| token.span());
    let mut cursor = Cursor::new(tokens, end);
    cursor.open_invisible();
    let crate_path = crate_path(&mut cursor, faults).ok()?;
    let docs = docs(&mut cursor, faults).ok()?;
    let visibility = visibility(&mut cursor, faults);
    if cursor.eat_word("component").is_none() {
        let fault = Fault::new(cursor.span(), format!("expected `component`, found {}", cursor.found()));
        faults.report(if cursor.is_word("system") {
            fault.help("a system is declared by `mechanical_system! { .. }`")
        } else {
            fault.help(HELP_COMPONENT)
        });
        return None;
    }
    let component = component(&mut cursor, faults, docs, visibility).ok()?;
    if !cursor.is_end() {
        let fault = Fault::new(cursor.span(), "expected nothing after the `}` of the component");
        faults.report(fault.help("write a second `mechanical_component! { .. }` for another component"));
    }
    Some(Component { crate_path, ..component })
}

/// Counts without recursion, before anything else walks the tokens.
fn has_too_many_tokens(tokens: &TokenStream) -> bool {
    let mut streams = vec![tokens.clone()];
    let mut count = 0;
    while let Some(stream) = streams.pop() {
        for token in stream {
            count += 1;
            if let TokenTree::Group(group) = token {
                streams.push(group.stream());
            }
        }
        if count > MAX_TOKENS {
            return true;
        }
    }
    false
}

fn system(cursor: &mut Cursor, faults: &mut Faults) -> Result<Declaration, Reported> {
    cursor.open_invisible();
    let crate_path = crate_path(cursor, faults)?;
    let docs = docs(cursor, faults)?;
    let visibility = visibility(cursor, faults);
    if cursor.eat_word("system").is_none() {
        let fault = Fault::new(cursor.span(), format!("expected `system`, found {}", cursor.found()));
        return Err(faults.report(fault.help(HELP_SYSTEM)));
    }
    let name = name(cursor, faults, "the name of the system")?;
    let Some(group) = cursor.eat_group(Delimiter::Brace) else {
        let fault =
            Fault::new(cursor.span(), format!("expected `{{` after `{name}`, found {}", cursor.found()));
        return Err(faults.report(if cursor.is_punct('<') {
            fault.help(
                "remove the parameters: the generated types are generic over the real number by themselves",
            )
        } else {
            fault.help(HELP_SYSTEM)
        }));
    };
    let (items, nesting) = items(&group, faults, &name, Owner::System);
    let (tokens, counts, imported, instances, origins, components) = Default::default();
    Ok(Declaration {
        tokens,
        crate_path,
        docs,
        visibility,
        name,
        items,
        nesting,
        counts,
        imported,
        instances,
        origins,
        components,
        in_mode: None,
        is_outline: false,
        of_modes: Default::default(),
    })
}

/// `crate = path;`, if it stands here.
fn crate_path(cursor: &mut Cursor, faults: &mut Faults) -> Result<Option<TokenStream>, Reported> {
    const HELP: &str = "write `crate = ::name_of_guen;` with the name under which the crate is a dependency";
    if !(cursor.is_word("crate") && cursor.is_punct_at(1, '=')) {
        return Ok(None);
    }
    cursor.skip(2);
    cursor.open_invisible();
    let start = cursor.span();
    let mut path = Vec::new();
    if cursor.is_pair(':', ':') {
        path.extend([cursor.next(), cursor.next()]);
    }
    loop {
        if cursor.ident_at(0).is_none() {
            let fault = Fault::new(cursor.span(), format!("expected a path, found {}", cursor.found()));
            return Err(faults.report(fault.help(HELP)));
        }
        path.push(cursor.next());
        if !cursor.is_pair(':', ':') {
            break;
        }
        path.extend([cursor.next(), cursor.next()]);
    }
    if cursor.eat(';').is_none() {
        let fault =
            Fault::new(cursor.span(), format!("expected `;` after the path, found {}", cursor.found()));
        faults.report(fault.help(HELP));
        // Without a `;` the declaration may begin right here.
        if cursor.ident_at(0).is_none() && !cursor.is_punct('#') {
            cursor.skip(1);
        }
    }
    let path: TokenStream = path.into_iter().flatten().collect();
    if path.is_empty() {
        return Err(faults.report(Fault::new(start, "expected a path").help(HELP)));
    }
    Ok(Some(path))
}

/// `pub`, `pub(crate)`, `pub(super)`, `pub(self)`, `pub(in path)` or nothing.
fn visibility(cursor: &mut Cursor, faults: &mut Faults) -> Visibility {
    cursor.open_invisible();
    let Some(span) = cursor.eat_word("pub") else { return Visibility::Private };
    let Some(group) = cursor.eat_group(Delimiter::Parenthesis) else { return Visibility::Public(span) };
    let mut inside = Cursor::inside(&group);
    let is_path = inside.eat_word("in").is_some();
    let path: Vec<TokenTree> = std::iter::from_fn(|| inside.next()).collect();
    let is_word = |word: &str| matches!(path.as_slice(), [TokenTree::Ident(only)] if only == word);
    if !(is_word("crate") || is_word("super") || is_word("self") || is_path && !path.is_empty()) {
        faults.report(
            Fault::new(group.span_open(), "this visibility is unknown")
                .help("write `pub`, `pub(crate)`, `pub(super)`, `pub(in path)` or nothing"),
        );
        return Visibility::Public(span);
    }
    Visibility::Restricted { span, path: path.into_iter().collect() }
}

fn after_system(cursor: &mut Cursor, faults: &mut Faults) {
    if cursor.is_end() {
        return;
    }
    let start = cursor.span();
    while !cursor.is_end() && !cursor.is_word("system") {
        cursor.skip(1);
    }
    if cursor.is_end() {
        faults.report(Fault::new(start, "expected nothing after the `}` of the system").help("remove this"));
    } else {
        let fault = Fault::new(cursor.span(), "one invocation of the macro declares one system");
        faults.report(fault.help("write a second `mechanical_system! { .. }` for this one"));
    }
}

/// The owner of the items.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Owner {
    System,
    Component,
}

/// The items of a system or component that have been read so far.
struct Progress {
    owner: Owner,
    items: Entries<Item>,
    first: [Option<Span>; SectionKind::ALL.len()],
    scenes: usize,
    definitions: usize,
    has_unknown: bool,
}

/// Reads what the braces of a system or component hold.
pub(crate) fn items(
    group: &Group,
    faults: &mut Faults,
    name: &Name,
    owner: Owner,
) -> (Vec<Item>, Vec<EntryNode>) {
    let mut progress = Progress {
        owner,
        items: Entries::new(),
        first: [None; SectionKind::ALL.len()],
        scenes: 0,
        definitions: 0,
        has_unknown: false,
    };
    fill(group, faults, &mut progress);
    if !progress.has_unknown && owner == Owner::System {
        missing(&progress, faults, name);
    }
    progress.items.nesting()
}

fn fill(group: &Group, faults: &mut Faults, progress: &mut Progress) {
    let mut cursor = Cursor::inside_system(group);
    while !cursor.is_end() {
        let before = cursor.position();
        if stray_semicolon(&mut cursor, faults) || block(&mut cursor, faults, progress) {
            continue;
        }
        if item(&mut cursor, faults, progress).is_err() {
            cursor.recover();
        }
        if cursor.position() == before {
            cursor.skip(1);
        }
    }
}

/// Reads a loop or a choice around definitions, if one begins here.
fn block(cursor: &mut Cursor, faults: &mut Faults, progress: &mut Progress) -> bool {
    let mut items = std::mem::replace(&mut progress.items, Entries::new());
    let found = items.block(cursor, faults, &mut |group, faults, items| {
        std::mem::swap(items, &mut progress.items);
        fill(group, faults, progress);
        std::mem::swap(items, &mut progress.items);
    });
    progress.items = items;
    found
}

/// Refuses sections in loops: a section has the loop inside.
fn only_definitions(
    kind: SectionKind,
    keyword: Span,
    progress: &Progress,
    faults: &mut Faults,
) -> Result<(), Reported> {
    if !progress.items.is_inside() || matches!(kind, SectionKind::Let | SectionKind::Use) {
        return Ok(());
    }
    let word = kind.word();
    let fault = Fault::new(
        keyword,
        format!("a loop or choice outside of sections holds `let` and `use`, and no `{word}`"),
    );
    Err(faults.report(match kind {
        _ if kind.is_quantity() => fault.help(format!("write `{word} = sum(i in 0..n: e);`")),
        SectionKind::Count | SectionKind::Function | SectionKind::Scene | SectionKind::Provide => {
            fault.help("write it outside of the loop")
        }
        _ => {
            fault.help(format!("write the loop inside of the section, `{word} {{ for i in 0..n {{ .. }} }}`"))
        }
    }))
}

/// `count name = value;` behind the word.
fn count(cursor: &mut Cursor, faults: &mut Faults, docs: Docs) -> Result<Count, Reported> {
    let name = name(cursor, faults, "the name of a count")?;
    let span = cursor.span();
    let value = equals(cursor, faults, &format!("`{name}`"), "a count reads `count n = 20;`")
        .and_then(|_| index::index(cursor, faults));
    match value {
        Ok(value) => {
            semicolon(cursor, faults, |_| false);
            Ok(Count { docs, name, value })
        }
        Err(Reported { .. }) => {
            cursor.recover();
            Ok(Count { docs, name, value: IndexExpression { span, kind: IndexKind::Missing } })
        }
    }
}

/// Sections that a system cannot be without.
fn missing(progress: &Progress, faults: &mut Faults, name: &Name) {
    let has = |kind: SectionKind| progress.first[kind as usize].is_some();
    if has(SectionKind::Use) {
        // Components may have both: whether they do is asked where they are unfolded.
        return;
    }
    if !has(SectionKind::Coordinates) {
        let fault = Fault::new(name.span(), format!("system `{name}` has no `coordinates`"));
        faults.report(fault.help("add `coordinates { x, y }`"));
    }
    if !has(SectionKind::KineticEnergy) && !has(SectionKind::Particles) && !has(SectionKind::Bodies) {
        let fault = Fault::new(name.span(), format!("system `{name}` has no kinetic energy"));
        faults.report(fault.help("add `kinetic_energy = e;`, `particles { .. }` or `bodies { .. }`"));
    }
}

/// Reads a section, a definition or a scene.
fn item(cursor: &mut Cursor, faults: &mut Faults, progress: &mut Progress) -> Result<(), Reported> {
    let docs = docs(cursor, faults)?;
    if cursor.is_word("pub") {
        let fault = Fault::new(cursor.span(), "`pub` may stand only before `system`");
        faults.report(fault.help("remove it: everything that is generated is as visible as the system"));
        cursor.skip(1);
        cursor.eat_group(Delimiter::Parenthesis);
    }
    let keyword = cursor.span();
    let Some(word) = cursor.ident_at(0).map(ToString::to_string) else {
        progress.has_unknown = true;
        let fault = Fault::new(keyword, format!("expected a section, found {}", cursor.found()));
        return Err(
            faults.report(fault.help(format_args!("the sections are {}", quoted(SECTIONS.iter().copied()))))
        );
    };
    let Some(kind) = SectionKind::of_word(&word) else {
        progress.has_unknown = true;
        unknown(cursor, faults, &word);
        return Ok(());
    };
    if let Err(reported) = only_definitions(kind, keyword, progress, faults) {
        // Nothing is said of a section that is there and missing at once.
        progress.first[kind as usize].get_or_insert(keyword);
        cursor.skip(1);
        return cursor.eat_group(Delimiter::Brace).map(|_| ()).ok_or(reported);
    }
    once(kind, (&word, keyword), progress, faults);
    cursor.skip(1);
    if progress.owner == Owner::Component {
        only_of_systems(kind, keyword, faults);
    }
    let item = match kind {
        SectionKind::Count => {
            progress.definitions += 1;
            too_many(progress.definitions, MAX_ENTRIES, "definitions", keyword, faults)?;
            Item::Count(count(cursor, faults, docs)?)
        }
        SectionKind::Component => {
            progress.definitions += 1;
            too_many(progress.definitions, MAX_ENTRIES, "definitions", keyword, faults)?;
            Item::Component(component(cursor, faults, docs, Visibility::Private)?)
        }
        SectionKind::Use => {
            progress.definitions += 1;
            too_many(progress.definitions, MAX_ENTRIES, "definitions", keyword, faults)?;
            Item::Use(instance(cursor, faults, docs, keyword)?)
        }
        SectionKind::Let => {
            progress.definitions += 1;
            too_many(progress.definitions, MAX_ENTRIES, "`let` definitions", keyword, faults)?;
            Item::Let(definitions::definition_of_let(cursor, faults, docs)?)
        }
        SectionKind::Function => {
            progress.definitions += 1;
            too_many(progress.definitions, MAX_ENTRIES, "definitions", keyword, faults)?;
            Item::Function(functions::function(cursor, faults, docs)?)
        }
        SectionKind::Scene => {
            progress.scenes += 1;
            too_many(progress.scenes, MAX_SCENES, "scenes", keyword, faults)?;
            Item::Scene(scene::scene(cursor, faults, docs, keyword)?)
        }
        SectionKind::Provide => Item::Provide(Section::new(docs, keyword, scene::provides(cursor, faults))),
        _ if kind.is_quantity() => {
            let quantity = energies::quantity(cursor, faults, docs, &word, keyword);
            match kind {
                SectionKind::KineticEnergy => Item::KineticEnergy(quantity),
                SectionKind::Gravity => Item::Gravity(quantity),
                SectionKind::ForceFunction => Item::ForceFunction(quantity),
                _ => Item::PotentialEnergy(quantity),
            }
        }
        _ => {
            let Some(group) = cursor.eat_group(Delimiter::Brace) else {
                let fault = Fault::new(
                    cursor.span(),
                    format!("expected `{{` after `{word}`, found {}", cursor.found()),
                );
                return Err(faults.report(fault.help(format_args!("write `{word} {{ .. }}`"))));
            };
            section(kind, &group, faults, docs, keyword)
        }
    };
    progress.items.push(item);
    Ok(())
}

/// Refuses in a component what a system alone may have.
fn only_of_systems(kind: SectionKind, keyword: Span, faults: &mut Faults) {
    let word = kind.word();
    let fault = Fault::new(keyword, format!("a component has no `{word}`"));
    faults.report(match kind {
        SectionKind::Gravity => fault
            .note("`gravity` of the system acts on the particles and bodies of its components too")
            .help("declare it in the system"),
        SectionKind::Scene | SectionKind::Provide => {
            fault.help("declare it in the system that uses the component")
        }
        SectionKind::Component => fault.help("declare the inner component beside this one"),
        _ => return,
    });
}

/// A section in braces.
fn section(kind: SectionKind, group: &Group, faults: &mut Faults, docs: Docs, keyword: Span) -> Item {
    fn of<T>(docs: Docs, keyword: Span, entries: Entries<T>) -> Section<T> {
        entries.section(docs, keyword)
    }
    match kind {
        SectionKind::Constants => Item::Constants(of(docs, keyword, constants::constants(group, faults))),
        SectionKind::Functions => Item::Functions(of(docs, keyword, functions::supplied(group, faults))),
        SectionKind::Inputs => {
            Item::Inputs(of(docs, keyword, plain_names(group, faults, INPUT, MAX_ENTRIES)))
        }
        SectionKind::Coordinates => {
            let names = plain_names(group, faults, "the name of a coordinate", MAX_COORDINATES);
            if group.stream().is_empty() {
                let fault = Fault::new(keyword, "`coordinates` declares nothing");
                faults.report(
                    fault.help("write `coordinates { x, y }`; a component without any has no such section"),
                );
            }
            Item::Coordinates(of(docs, keyword, names))
        }
        SectionKind::Parameters => {
            Item::Parameters(of(docs, keyword, definitions::parameters(group, faults)))
        }
        SectionKind::Constraints => Item::Constraints(of(docs, keyword, equations::equations(group, faults))),
        SectionKind::Holonomic => Item::Holonomic(of(docs, keyword, equations::equations(group, faults))),
        SectionKind::Particles => Item::Particles(of(docs, keyword, particles::particles(group, faults))),
        SectionKind::Bodies => Item::Bodies(of(docs, keyword, bodies::bodies(group, faults))),
        SectionKind::States => Item::States(of(docs, keyword, states::states(group, faults))),
        SectionKind::Forces => Item::Forces(of(docs, keyword, forces::forces(group, faults))),
        SectionKind::Switches => Item::Switches(of(docs, keyword, contacts::switches(group, faults))),
        SectionKind::Contacts => Item::Contacts(of(docs, keyword, contacts::contacts(group, faults))),
        SectionKind::Resets => Item::Resets(of(docs, keyword, resets::resets(group, faults))),
        SectionKind::Modes => Item::Modes(of(docs, keyword, modes::modes(group, faults))),
        // The kinds without braces have been told apart before.
        _ => Item::Outputs(of(docs, keyword, definitions::outputs(group, faults))),
    }
}

fn too_many(count: usize, most: usize, what: &str, span: Span, faults: &mut Faults) -> Result<(), Reported> {
    if count <= most {
        return Ok(());
    }
    Err(faults.report(Fault::new(span, format!("more than {most} {what}"))))
}

/// Every section at most once, and one way to give the potential.
fn once(kind: SectionKind, (word, keyword): (&str, Span), progress: &mut Progress, faults: &mut Faults) {
    let first = progress.first[kind as usize];
    let other = match kind {
        SectionKind::ForceFunction => progress.first[SectionKind::PotentialEnergy as usize],
        SectionKind::PotentialEnergy => progress.first[SectionKind::ForceFunction as usize],
        _ => None,
    };
    if let Some(first) = first.filter(|_| !kind.may_repeat()) {
        let fault =
            Fault::new(keyword, format!("section `{word}` is given twice")).note_place("first given", first);
        let names = quoted(PARAMETER_ALIASES.iter().copied());
        let fault = match kind {
            SectionKind::Parameters => fault.note(format!("`parameters`, {names} are names of one section")),
            _ => fault,
        };
        faults.report(if kind.is_quantity() {
            fault.help("add both up in one expression")
        } else {
            fault.help("move the entries into one section")
        });
    } else if let Some(other) = other {
        let fault = Fault::new(keyword, "`force_function` and `potential_energy` are both given");
        faults.report(
            fault
                .note_place("the other is given", other)
                .help("keep one of them: each is the negative of the other"),
        );
    } else {
        progress.first[kind as usize] = Some(keyword);
    }
}

/// Reports a word that begins no section, and passes what it was to begin.
fn unknown(cursor: &mut Cursor, faults: &mut Faults, word: &str) {
    let fault = Fault::new(cursor.span(), format!("unknown section `{word}`"));
    faults.report(match (instead_of_section(word), nearest_section(word)) {
        (Some(instead), _) => fault.help(instead),
        (None, Some(near)) => fault.help(format_args!("did you mean `{near}`?")),
        (None, None) => fault.help(format_args!("the sections are {}", quoted(SECTIONS.iter().copied()))),
    });
    cursor.skip(1);
    if cursor.eat_group(Delimiter::Brace).is_some() {
        return;
    }
    if cursor.ident_at(0).is_some()
        && cursor.group_at(1, Delimiter::Brace).is_some()
        && !cursor.starts_section()
    {
        cursor.skip(2);
        return;
    }
    cursor.recover();
}
