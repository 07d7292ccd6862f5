//! Whole numbers at compile time: indices, ranges of loops, conditions on indices.

use proc_macro2::{Ident, Span};

use super::Name;

/// An expression of whole numbers, counts and loop variables.
#[derive(Debug, Clone)]
pub struct IndexExpression {
    /// The token that names the node.
    pub span: Span,
    /// The kind of the expression.
    pub kind: IndexKind,
}

/// The kinds of expressions of whole numbers.
#[derive(Debug, Clone)]
pub enum IndexKind {
    /// Something whose fault has been reported.
    Missing,
    /// A number.
    Number(i64),
    /// A count or a loop variable.
    Name(Name),
    /// `-operand`.
    Negation(Box<IndexExpression>),
    /// `left operator right`.
    Operation(Box<IndexExpression>, IndexOperator, Box<IndexExpression>),
}

/// The operators of whole numbers. Division is Rust's: it cuts off what is left.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum IndexOperator {
    /// `+`.
    Plus,
    /// `-`.
    Minus,
    /// `*`.
    Times,
    /// `/`.
    Over,
    /// `%`.
    Remainder,
}

/// `start..end` or `start..=end`.
#[derive(Debug, Clone)]
pub struct Range {
    /// The first number.
    pub start: IndexExpression,
    /// The number behind the last, or the last.
    pub end: IndexExpression,
    /// Whether the end belongs to the range.
    pub is_closed: bool,
    /// Place of the `..`.
    pub span: Span,
}

/// A condition on indices.
#[derive(Debug, Clone)]
pub enum Condition {
    /// Something whose fault has been reported.
    Missing,
    /// `left < right`.
    Comparison(IndexExpression, Comparison, IndexExpression),
    /// `!condition`.
    Not(Box<Condition>),
    /// `left && right`.
    And(Box<Condition>, Box<Condition>),
    /// `left || right`.
    Or(Box<Condition>, Box<Condition>),
}

/// The comparisons of whole numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Comparison {
    /// `<`.
    Less,
    /// `<=`.
    LessOrEqual,
    /// `>`.
    Greater,
    /// `>=`.
    GreaterOrEqual,
    /// `==`.
    Equal,
    /// `!=`.
    Unequal,
}

/// The index of a name, if it has one.
#[derive(Debug, Clone, Default)]
pub enum Index {
    /// A name without an index.
    #[default]
    None,
    /// An index as it was written. There is none left once loops are unfolded.
    Written(Box<WrittenIndex>),
    /// A name of an instance as it was written in a scene, by its steps. There is none left once uses are unfolded.
    Member(Box<WrittenMember>),
    /// The entry of an array, or a member of a component: what is left once loops are unfolded.
    Entry(Box<Path>),
}

/// `left.q[3]` in a scene.
#[derive(Debug, Clone)]
pub struct WrittenMember {
    /// The names between the points, each with its index.
    pub steps: Vec<Name>,
}

/// `[i]` or `[i, j]` behind a name.
#[derive(Debug, Clone)]
pub struct WrittenIndex {
    /// The indices.
    pub indices: Vec<IndexExpression>,
    /// The brackets.
    pub brackets: Span,
}

/// The way from a field of the generated structs to a value inside of it: `q[3]`, `left.angle`, `rear[2].angle`.
#[derive(Debug, Clone)]
pub struct Path {
    /// The field.
    pub root: Ident,
    /// The name of the module of the instance that the field is, where it is not that of the field: in what stands in for a faulty
    /// declaration, an instance may have the name of another item.
    pub module: Option<Ident>,
    /// The steps from there.
    pub steps: Vec<Step>,
}

/// A step of a path.
#[derive(Debug, Clone)]
pub enum Step {
    /// The entry `at` of an array that has so many entries.
    Index {
        /// The place of the entry.
        at: usize,
        /// The length of the array.
        of: usize,
    },
    /// A field of a struct.
    Field(Ident),
}

/// The order of the entries of a section, where loops and conditions stand between them.
#[derive(Debug, Clone)]
pub enum EntryNode {
    /// The entry of this place in the list.
    Entry(usize),
    /// `for i in 0..n { .. }`.
    For(Loop),
    /// `if i < k { .. } else { .. }`.
    If(Conditional),
}

/// `for variable in range { body }`.
#[derive(Debug, Clone)]
pub struct Loop {
    /// Place of the `for`.
    pub keyword: Span,
    /// The loop variable.
    pub variable: Name,
    /// The numbers that it runs through.
    pub range: Range,
    /// The entries inside.
    pub body: Vec<EntryNode>,
}

/// `if condition { then } else { otherwise }`.
#[derive(Debug, Clone)]
pub struct Conditional {
    /// The condition.
    pub condition: Condition,
    /// The entries where it holds.
    pub then: Vec<EntryNode>,
    /// The entries where it does not.
    pub otherwise: Vec<EntryNode>,
}

impl Path {
    /// The names on the way, without `r#` and indices: of `leg[1].foot` they are `leg` and `foot`.
    pub fn names(&self) -> Vec<String> {
        let fields = self.steps.iter().filter_map(|step| match step {
            Step::Field(field) => Some(field),
            Step::Index { .. } => None,
        });
        let plain = |ident: &Ident| ident.to_string().trim_start_matches("r#").to_owned();
        std::iter::once(&self.root).chain(fields).map(plain).collect()
    }

    /// The module of the instance that the field is.
    pub fn module(&self) -> &Ident {
        self.module.as_ref().unwrap_or(&self.root)
    }

    /// The path as text: `q[3]`, `k[1][2]`, `rear[2].angle`.
    pub fn text(&self) -> String {
        self.written("[", "]", ".")
    }

    /// The identifier of the path, which no other path of a sound declaration has but by chance: `q_3`.
    pub fn flat(&self) -> Ident {
        let text = self.written("_", "", "_");
        Ident::new(text.trim_start_matches("r#"), self.root.span())
    }

    fn written(&self, open: &str, close: &str, point: &str) -> String {
        let root = self.root.to_string();
        let mut text = root.trim_start_matches("r#").to_owned();
        for step in &self.steps {
            match step {
                Step::Index { at, .. } => text.extend([open, &at.to_string(), close]),
                Step::Field(name) => text.extend([point, name.to_string().trim_start_matches("r#")]),
            }
        }
        text
    }
}
