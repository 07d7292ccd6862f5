//! Components and their uses as written.

use std::rc::Rc;

use proc_macro2::{Span, TokenStream};

use super::{Declaration, Docs, EntryNode, Expression, Item, Name, Path, Visibility};
use crate::names::{CARRIED_ITEMS, MODES, REAL, is_generated_item, module_name};

/// `component Name(a: scalar, ..) { sections }`.
#[derive(Debug, Clone)]
pub struct Component {
    /// The path after `crate =`, of one that stands by itself.
    pub crate_path: Option<TokenStream>,
    /// Doc comments of the component.
    pub docs: Docs,
    /// Visibility of what is generated; private inside of a system.
    pub visibility: Visibility,
    /// Name of the component.
    pub name: Name,
    /// The arguments that its user gives.
    pub arguments: Vec<DeclaredArgument>,
    /// Sections and definitions, in the order in which they were written.
    pub items: Vec<Item>,
    /// The order of the items, where loops and conditions stand between them; empty where there are none.
    pub nesting: Vec<EntryNode>,
    /// The components that it uses and does not declare itself.
    pub imported: Vec<Imported>,
}

impl Component {
    /// The arguments that are counts.
    pub fn counts(&self) -> impl Iterator<Item = &DeclaredArgument> {
        self.arguments.iter().filter(|argument| argument.kind == ArgumentKind::Count)
    }
}

/// `name: kind`.
#[derive(Debug, Clone)]
pub struct DeclaredArgument {
    /// Doc comments.
    pub docs: Docs,
    /// The name.
    pub name: Name,
    /// The kind of what is given.
    pub kind: ArgumentKind,
    /// Whether the kind is one; after a fault nothing is said about how the argument is used.
    pub is_sound: bool,
}

/// The kinds of arguments.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ArgumentKind {
    /// A scalar expression.
    Scalar,
    /// A vector expression.
    Vector,
    /// A rotation.
    Rotation,
    /// A declared body.
    Body,
    /// A whole number that the macro knows.
    Count,
}

impl ArgumentKind {
    /// Every kind, in the order in which a help lists them.
    pub const ALL: [ArgumentKind; 5] = [
        ArgumentKind::Scalar,
        ArgumentKind::Vector,
        ArgumentKind::Rotation,
        ArgumentKind::Body,
        ArgumentKind::Count,
    ];

    /// The word in the language.
    pub fn word(self) -> &'static str {
        match self {
            ArgumentKind::Scalar => "scalar",
            ArgumentKind::Vector => "vector",
            ArgumentKind::Rotation => "rotation",
            ArgumentKind::Body => "body",
            ArgumentKind::Count => "count",
        }
    }

    /// The kind that a word names.
    pub fn of_word(word: &str) -> Option<ArgumentKind> {
        ArgumentKind::ALL.into_iter().find(|kind| kind.word() == word)
    }
}

/// `use path as name { argument: e, .. }`.
#[derive(Debug, Clone)]
pub struct Use {
    /// Doc comments.
    pub docs: Docs,
    /// Place of the word `use`.
    pub keyword: Span,
    /// The component.
    pub path: ComponentPath,
    /// The name of the instance.
    pub name: Name,
    /// The arguments as given.
    pub arguments: Vec<GivenArgument>,
}

/// An argument that a use gives, under the name that it has in the instance: what is left once uses are unfolded.
#[derive(Debug, Clone)]
pub struct Argument {
    /// The name in the instance.
    pub name: Name,
    /// The kind that the component declares.
    pub kind: ArgumentKind,
    /// The name of the component.
    pub component: Name,
    /// The argument as given.
    pub given: GivenArgument,
}

/// An instance of a component: what is left of its use once uses are unfolded.
#[derive(Debug, Clone)]
pub struct Instance {
    /// The path of the instance.
    pub path: Path,
    /// Doc comments of the use.
    pub docs: Docs,
    /// The component as the use has it.
    pub component: ComponentPath,
    /// The place of the name of the instance.
    pub place: Span,
    /// The component.
    pub declared: Rc<Component>,
}

impl Instance {
    /// The instance with its component, for a note that ends with a place.
    pub(crate) fn used(&self) -> String {
        format!("in `{}`, a `{}`, used", self.path.text(), self.component.name)
    }
}

/// `name: e`.
#[derive(Debug, Clone)]
pub struct GivenArgument {
    /// The name of the argument.
    pub name: Name,
    /// The expression that is given.
    pub value: Expression,
}

/// The path of a component: a name, or `module::Name`.
#[derive(Debug, Clone)]
pub struct ComponentPath {
    /// The tokens as written.
    pub tokens: TokenStream,
    /// The path without spaces.
    pub text: String,
    /// The last name of the path.
    pub name: Name,
}

impl ComponentPath {
    /// Whether it is a name alone.
    pub fn is_name(&self) -> bool {
        self.name.text == self.text
    }
}

/// A component that is declared elsewhere.
#[derive(Debug, Clone)]
pub struct Imported {
    /// The path, as the uses have it.
    pub path: String,
    /// The component.
    pub component: Component,
    /// Whether mistakes in it have been reported where it is declared.
    pub is_faulty: bool,
}

impl Declaration {
    /// Whether the generated module has an item of its own with the name of a component in the braces or of an instance.
    pub fn takes_name(&self, text: &str) -> bool {
        let is_scene = |item: &Item| matches!(item, Item::Scene(scene) if scene.name.text == text);
        is_generated_item(text)
            || text == REAL
            || CARRIED_ITEMS.contains(&text)
            || text == MODES
            || self.name.text == text
            || self.items.iter().any(is_scene)
    }

    /// Whether the generated module has an item of its own with the name of the module of an instance.
    pub fn takes_module(&self, text: &str) -> bool {
        let is_of_scene = |item: &Item| matches!(item, Item::Scene(scene) if module_name(&scene.name.ident, "scene") == text);
        self.takes_name(text) || self.items.iter().any(is_of_scene)
    }
}

/// The paths of the components that items use and do not declare, each once, in the order of the uses.
pub fn undeclared_components(items: &[Item]) -> Vec<&ComponentPath> {
    let mut found: Vec<&ComponentPath> = Vec::new();
    collect(items, &[], &mut found);
    found
}

fn collect<'a>(items: &'a [Item], outer: &[&'a Name], found: &mut Vec<&'a ComponentPath>) {
    let declared = items.iter().filter_map(|item| match item {
        Item::Component(component) => Some(&component.name),
        _ => None,
    });
    let declared: Vec<&Name> = outer.iter().copied().chain(declared).collect();
    for item in items {
        match item {
            Item::Use(instance) => {
                let path = &instance.path;
                let is_declared = path.is_name() && declared.iter().any(|name| name.text == path.text);
                if !is_declared && found.iter().all(|known| known.text != path.text) {
                    found.push(path);
                }
            }
            Item::Component(component) => collect(&component.items, &declared, found),
            _ => {}
        }
    }
}
