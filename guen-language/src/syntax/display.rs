//! The tree as text of the language, with every operation in parentheses: what a test or a bug report shows, and
//! text that parses to the same tree again. Documentation is left out. [`Expression::source`] is the same with
//! as few parentheses as a person writes, for messages.

use std::fmt::{self, Display, Formatter, Write};

use super::*;

/// `items` with a separator between them.
fn separated<T: Display>(f: &mut Formatter<'_>, items: &[T], separator: &str) -> fmt::Result {
    for (i, item) in items.iter().enumerate() {
        if i > 0 {
            f.write_str(separator)?;
        }
        write!(f, "{item}")?;
    }
    Ok(())
}

/// A name of an instance, by its steps.
fn separated_steps(f: &mut Formatter<'_>, steps: &[Name]) -> fmt::Result {
    steps.iter().enumerate().try_for_each(|(i, step)| {
        if i > 0 {
            f.write_char('.')?;
        }
        write!(f, "{}", Written(step))
    })
}

/// A name as it was written, with `r#` and with its index.
struct Written<'a>(&'a Name);

impl Display for Written<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let name = self.0;
        let root = match &name.index {
            Index::Member(member) => return separated_steps(f, &member.steps),
            _ => name.root(),
        };
        write!(f, "{root}")?;
        match &name.index {
            Index::None => Ok(()),
            Index::Member(_) => Ok(()),
            Index::Written(written) => {
                f.write_char('[')?;
                separated(f, &written.indices, ", ")?;
                f.write_char(']')
            }
            Index::Entry(path) => {
                let mut steps = path.steps.iter().peekable();
                while let Some(step) = steps.next() {
                    match step {
                        Step::Field(field) => write!(f, ".{field}")?,
                        Step::Index { at, .. } => {
                            write!(f, "[{at}")?;
                            while let Some(Step::Index { at, .. }) =
                                steps.next_if(|step| matches!(step, Step::Index { .. }))
                            {
                                write!(f, ", {at}")?;
                            }
                            f.write_char(']')?;
                        }
                    }
                }
                Ok(())
            }
        }
    }
}

impl Display for IndexExpression {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match &self.kind {
            IndexKind::Missing => f.write_char('?'),
            IndexKind::Number(value) => write!(f, "{value}"),
            IndexKind::Name(name) => write!(f, "{}", name.ident),
            IndexKind::Negation(operand) => write!(f, "(-{operand})"),
            IndexKind::Operation(left, operator, right) => {
                let mark = match operator {
                    IndexOperator::Plus => '+',
                    IndexOperator::Minus => '-',
                    IndexOperator::Times => '*',
                    IndexOperator::Over => '/',
                    IndexOperator::Remainder => '%',
                };
                write!(f, "({left} {mark} {right})")
            }
        }
    }
}

impl Display for Range {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{}..{}{}", self.start, if self.is_closed { "=" } else { "" }, self.end)
    }
}

impl Display for Condition {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Condition::Missing => f.write_char('?'),
            Condition::Comparison(left, comparison, right) => {
                let mark = match comparison {
                    Comparison::Less => "<",
                    Comparison::LessOrEqual => "<=",
                    Comparison::Greater => ">",
                    Comparison::GreaterOrEqual => ">=",
                    Comparison::Equal => "==",
                    Comparison::Unequal => "!=",
                };
                write!(f, "{left} {mark} {right}")
            }
            Condition::Not(inner) => write!(f, "!({inner})"),
            Condition::And(left, right) => write!(f, "({left}) && ({right})"),
            Condition::Or(left, right) => write!(f, "({left}) || ({right})"),
        }
    }
}

/// The entries of a list in their loops and conditions.
fn nested<T: Display>(
    f: &mut Formatter<'_>,
    nodes: &[EntryNode],
    entries: &[T],
    separator: &str,
) -> fmt::Result {
    for (i, node) in nodes.iter().enumerate() {
        if i > 0 {
            f.write_str(separator)?;
        }
        match node {
            EntryNode::Entry(place) => write!(f, "{}", entries[*place])?,
            EntryNode::For(Loop { variable, range, body, .. }) => {
                write!(f, "for {} in {range} {{ ", variable.ident)?;
                nested(f, body, entries, separator)?;
                f.write_str(" }")?;
            }
            EntryNode::If(Conditional { condition, then, otherwise }) => {
                write!(f, "if {condition} {{ ")?;
                nested(f, then, entries, separator)?;
                f.write_str(" }")?;
                if !otherwise.is_empty() {
                    f.write_str(" else { ")?;
                    nested(f, otherwise, entries, separator)?;
                    f.write_str(" }")?;
                }
            }
        }
    }
    Ok(())
}

impl Display for Expression {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match &self.kind {
            ExpressionKind::Missing => f.write_str("?"),
            ExpressionKind::Number(number) => write!(f, "{number}"),
            ExpressionKind::Name(name) => write!(f, "{}", Written(name)),
            ExpressionKind::Call { function, arguments, .. } => {
                write!(f, "{}(", function.ident)?;
                separated(f, arguments, ", ")?;
                f.write_char(')')
            }
            // `1.x` and `1..x` are other tokens than a number, a point and a name.
            ExpressionKind::Field { base, name } if base.as_number().is_some() => {
                write!(f, "({base}).{}", name.ident)
            }
            ExpressionKind::Field { base, name } => write!(f, "{base}.{}", name.ident),
            ExpressionKind::Method { base, name, arguments, .. } => {
                match base.as_number() {
                    Some(number) => write!(f, "({number}).{}(", name.ident)?,
                    None => write!(f, "{base}.{}(", name.ident)?,
                }
                separated(f, arguments, ", ")?;
                f.write_char(')')
            }
            ExpressionKind::Negation(operand) => write!(f, "(-{operand})"),
            ExpressionKind::Sum { first, rest } => {
                rest.iter().try_for_each(|_| f.write_char('('))?;
                write!(f, "{first}")?;
                rest.iter().try_for_each(|term| {
                    let sign = if term.operator == AddOperator::Plus { '+' } else { '-' };
                    write!(f, " {sign} {})", term.value)
                })
            }
            ExpressionKind::Product { first, rest } => {
                rest.iter().try_for_each(|_| f.write_char('('))?;
                write!(f, "{first}")?;
                rest.iter().try_for_each(|factor| {
                    let sign = if factor.operator == MultiplyOperator::Times { '*' } else { '/' };
                    write!(f, "{sign}{})", factor.value)
                })
            }
            ExpressionKind::Power { base, exponent } => write!(f, "({base}^{exponent})"),
            ExpressionKind::Comparison { left, order, right } => {
                write!(f, "{left} {} {right}", order.sign())
            }
            ExpressionKind::Fold(fold) => {
                let Fold { function, variable, range, body } = &**fold;
                write!(f, "{}({} in {range}: {body})", function.ident, variable.ident)
            }
        }
    }
}

impl Display for Plain {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{}", Written(&self.name))?;
        self.unit.iter().try_for_each(|unit| write!(f, ": {}", unit.text))?;
        if let Some(limits) = &self.limits {
            write!(f, " in {}..{}", limits[0], limits[1])?;
        }
        Ok(())
    }
}

impl Display for Constant {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{}", Written(&self.name))?;
        self.unit.iter().try_for_each(|unit| write!(f, ": {}", unit.text))?;
        if let Some(bound) = self.bound {
            write!(f, " {}", bound.kind.relation())?;
        }
        if let Some(limits) = &self.limits {
            write!(f, " in {}..{}", limits[0], limits[1])?;
        }
        self.default.iter().try_for_each(|default| write!(f, " = {default}"))
    }
}

impl Display for Definition {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{} = {};", Written(&self.name), self.value)
    }
}

impl Display for Equation {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {} = {};", Written(&self.name), self.left, self.right)
    }
}

impl Display for Particle {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{} at {};", self.mass, self.position)
    }
}

impl Display for State {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "dot({}", Written(&self.name))?;
        self.unit.iter().try_for_each(|unit| write!(f, ": {}", unit.text))?;
        write!(f, ") = {};", self.rate)
    }
}

impl Display for Force {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{} along {};", self.force, self.direction)
    }
}

impl Display for Switch {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {};", self.name.ident, self.value)
    }
}

impl Display for Clause {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{} = {}", self.word.text(), self.value)
    }
}

impl Display for Contact {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{}: ", self.name.ident)?;
        separated(f, &self.clauses, ", ")?;
        f.write_char(';')
    }
}

impl Display for Reset {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {} {}", self.name.ident, self.function, self.crossing.word())?;
        let mut assignments = self.assignments.iter();
        assignments.try_for_each(|given| write!(f, ", {} = {}", given.variable, given.value))?;
        f.write_char(';')
    }
}

impl Display for ModeStatement {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            ModeStatement::States { contact, states } => {
                let states: Vec<_> = states.iter().map(|state| state.text.as_str()).collect();
                write!(f, "{}: {};", contact.ident, states.join(", "))
            }
            ModeStatement::Never { combination, .. } => {
                let pairs = combination.iter();
                let pairs: Vec<_> =
                    pairs.map(|(contact, state)| format!("{}.{}", contact.ident, state.text)).collect();
                write!(f, "never {};", pairs.join(" with "))
            }
        }
    }
}

impl Display for Inertia {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let (word, entries): (_, &[Expression]) = match self {
            Inertia::Missing => return f.write_char('?'),
            Inertia::Diagonal(entries) => ("diag", entries.as_slice()),
            Inertia::Symmetric(entries) => ("sym", entries.as_slice()),
        };
        write!(f, "{word}(")?;
        separated(f, entries, ", ")?;
        f.write_char(')')
    }
}

impl Display for Body {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{} {{ ", Written(&self.name))?;
        self.mass.iter().try_for_each(|field| write!(f, "mass: {}, ", field.value))?;
        self.inertia.iter().try_for_each(|field| write!(f, "inertia: {}, ", field.value))?;
        self.center.iter().try_for_each(|field| write!(f, "center: {}, ", field.value))?;
        self.orientation.iter().try_for_each(|field| write!(f, "orientation: {}, ", field.value))?;
        f.write_char('}')
    }
}

impl Display for Fix {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{}", Written(&self.name))?;
        self.value.iter().try_for_each(|value| write!(f, " = {value}"))
    }
}

impl Display for Provide {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{}", Written(&self.name))?;
        if let Some(names) = &self.of {
            f.write_char('(')?;
            for (i, name) in names.iter().enumerate() {
                write!(f, "{}{}", if i > 0 { ", " } else { "" }, Written(name))?;
            }
            f.write_char(')')?;
        }
        Ok(())
    }
}

impl Display for Scene {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "scene {} {{", self.name.ident)?;
        if !self.tracks.is_empty() {
            let names: Vec<_> = self.tracks.iter().map(|name| Written(name).to_string()).collect();
            write!(f, " track {};", names.join(", "))?;
        }
        if !self.fixes.is_empty() {
            f.write_str(" fix ")?;
            separated(f, &self.fixes, ", ")?;
            f.write_char(';')?;
        }
        if !self.provides.is_empty() {
            f.write_str(" provide ")?;
            separated(f, &self.provides, ", ")?;
            f.write_char(';')?;
        }
        for section in &self.modes {
            f.write_char(' ')?;
            braces(f, SectionKind::Modes, section, " ")?;
        }
        f.write_str(" }")
    }
}

/// A section in braces.
fn braces<T: Display>(
    f: &mut Formatter<'_>,
    kind: SectionKind,
    section: &Section<T>,
    separator: &str,
) -> fmt::Result {
    write!(f, "{} {{ ", kind.word())?;
    match section.nesting.is_empty() {
        true => separated(f, &section.entries, separator)?,
        false => nested(f, &section.nesting, &section.entries, separator)?,
    }
    f.write_str(" }")
}

impl Display for Component {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "component {}(", self.name.ident)?;
        let arguments: Vec<String> =
            self.arguments.iter().map(|a| format!("{}: {}", a.name.ident, a.kind.word())).collect();
        write!(f, "{}) {{ ", arguments.join(", "))?;
        separated(f, &self.items, " ")?;
        f.write_str(" }")
    }
}

impl Display for SuppliedFunction {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let arguments: Vec<_> = self.arguments.iter().map(|name| name.ident.to_string()).collect();
        write!(f, "{}({});", self.name.ident, arguments.join(", "))
    }
}

impl Display for Use {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let arguments: Vec<String> =
            self.arguments.iter().map(|a| format!("{}: {}", a.name.ident, a.value)).collect();
        write!(f, "use {} as {} {{ {} }}", self.path.text, self.name.ident, arguments.join(", "))
    }
}

impl Display for Item {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let kind = self.kind();
        match self {
            Item::Count(count) => write!(f, "count {} = {};", count.name.ident, count.value),
            Item::Constants(section) => braces(f, kind, section, ", "),
            Item::Functions(section) => braces(f, kind, section, " "),
            Item::Inputs(section) | Item::Coordinates(section) => braces(f, kind, section, ", "),
            Item::Let(definition) => write!(f, "let {definition}"),
            Item::Function(function) => {
                let parameters: Vec<_> =
                    function.parameters.iter().map(|name| name.ident.to_string()).collect();
                write!(f, "fn {}({}) = {};", function.name.ident, parameters.join(", "), function.value)
            }
            Item::Parameters(section) | Item::Outputs(section) => braces(f, kind, section, " "),
            Item::Constraints(section) | Item::Holonomic(section) => braces(f, kind, section, " "),
            Item::Particles(section) => braces(f, kind, section, " "),
            Item::Bodies(section) => braces(f, kind, section, " "),
            Item::States(section) => braces(f, kind, section, " "),
            Item::Forces(section) => braces(f, kind, section, " "),
            Item::Switches(section) => braces(f, kind, section, " "),
            Item::Contacts(section) => braces(f, kind, section, " "),
            Item::Resets(section) => braces(f, kind, section, " "),
            Item::Modes(section) => braces(f, kind, section, " "),
            Item::KineticEnergy(quantity)
            | Item::Gravity(quantity)
            | Item::ForceFunction(quantity)
            | Item::PotentialEnergy(quantity) => write!(f, "{} = {};", kind.word(), quantity.value),
            Item::Provide(section) => {
                f.write_str("provide ")?;
                separated(f, &section.entries, ", ")?;
                f.write_char(';')
            }
            Item::Component(component) => write!(f, "{component}"),
            Item::Use(instance) => write!(f, "{instance}"),
            Item::Argument(argument) => write!(f, "let {} = {};", argument.name, argument.given.value),
            Item::Scene(scene) => write!(f, "{scene}"),
        }
    }
}

impl Display for Declaration {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        if let Some(path) = &self.crate_path {
            writeln!(f, "crate = {path};")?;
        }
        let visibility = self.visibility.outside().to_string();
        writeln!(
            f,
            "{visibility}{}system {} {{",
            if visibility.is_empty() { "" } else { " " },
            self.name.ident
        )?;
        match self.nesting.is_empty() {
            true => self.items.iter().try_for_each(|item| writeln!(f, "    {item}"))?,
            false => nested(f, &self.nesting, &self.items, "\n    ")?,
        }
        f.write_char('}')
    }
}

/// The precedence of the outermost operation of an expression: how tightly it binds.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Binding {
    Comparison,
    Sum,
    Product,
    Sign,
    Power,
    Operand,
}

impl Expression {
    /// The expression as a person would write it.
    pub fn source(&self) -> String {
        let mut text = String::new();
        // Writing into a string cannot fail.
        let _ = self.write(&mut text, Binding::Sum);
        text
    }

    fn binding(&self) -> Binding {
        match &self.kind {
            ExpressionKind::Comparison { .. } => Binding::Comparison,
            ExpressionKind::Sum { .. } => Binding::Sum,
            ExpressionKind::Product { .. } => Binding::Product,
            ExpressionKind::Negation(_) => Binding::Sign,
            ExpressionKind::Power { .. } => Binding::Power,
            _ => Binding::Operand,
        }
    }

    fn write(&self, text: &mut String, least: Binding) -> fmt::Result {
        if self.binding() < least {
            text.push('(');
            self.write(text, Binding::Sum)?;
            text.push(')');
            return Ok(());
        }
        match &self.kind {
            ExpressionKind::Missing | ExpressionKind::Number(_) | ExpressionKind::Name(_) => {
                write!(text, "{self}")
            }
            ExpressionKind::Call { function, arguments, .. } => {
                write!(text, "{}", Written(function))?;
                list(text, arguments)
            }
            ExpressionKind::Field { base, name } => {
                base.write_before_point(text)?;
                write!(text, ".{}", name.ident)
            }
            ExpressionKind::Method { base, name, arguments, .. } => {
                base.write_before_point(text)?;
                write!(text, ".{}", name.ident)?;
                list(text, arguments)
            }
            ExpressionKind::Fold(fold) => {
                let Fold { function, variable, range, body } = &**fold;
                write!(text, "{}({} in {range}: {})", function.ident, variable.ident, body.source())
            }
            ExpressionKind::Negation(operand) => {
                text.push('-');
                operand.write(text, Binding::Sign)
            }
            ExpressionKind::Sum { first, rest } => {
                first.write(text, Binding::Sum)?;
                rest.iter().try_for_each(|term| {
                    text.push_str(if term.operator == AddOperator::Plus { " + " } else { " - " });
                    term.value.write(text, Binding::Product)
                })
            }
            ExpressionKind::Product { first, rest } => {
                first.write(text, Binding::Product)?;
                rest.iter().try_for_each(|factor| {
                    text.push(if factor.operator == MultiplyOperator::Times { '*' } else { '/' });
                    factor.value.write(text, Binding::Sign)
                })
            }
            ExpressionKind::Comparison { left, order, right } => {
                left.write(text, Binding::Sum)?;
                write!(text, " {} ", order.sign())?;
                right.write(text, Binding::Sum)
            }
            ExpressionKind::Power { base, exponent } => {
                base.write(text, Binding::Operand)?;
                text.push('^');
                exponent.write(text, Binding::Sign)
            }
        }
    }

    fn write_before_point(&self, text: &mut String) -> fmt::Result {
        if self.as_number().is_some() {
            return write!(text, "({self})");
        }
        self.write(text, Binding::Operand)
    }
}

fn list(text: &mut String, arguments: &[Expression]) -> fmt::Result {
    text.push('(');
    for (i, argument) in arguments.iter().enumerate() {
        if i > 0 {
            text.push_str(", ");
        }
        argument.write(text, Binding::Comparison)?;
    }
    text.push(')');
    Ok(())
}
