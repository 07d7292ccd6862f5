//! LaTeX mathematics, as far as reports use it.

use super::math::{Math, script};
use super::names::greek;
use super::term::Unread;

/// Reads all of a formula.
pub fn read(text: &str) -> Result<Vec<Math>, Unread> {
    let mut reader = Reader { rest: text };
    let items = reader.row(None)?;
    if reader.rest.is_empty() { Ok(items) } else { Err(format!("`{}` is left", reader.rest)) }
}

struct Reader<'t> {
    rest: &'t str,
}

const FUNCTIONS: [&str; 14] = [
    "sin", "cos", "tan", "cot", "arcsin", "arccos", "arctan", "sinh", "cosh", "tanh", "ln", "exp", "min",
    "max",
];

impl<'t> Reader<'t> {
    fn eat(&mut self, mark: &str) -> bool {
        match self.rest.strip_prefix(mark) {
            Some(rest) => {
                self.rest = rest;
                true
            }
            None => false,
        }
    }

    fn next(&mut self) -> Option<char> {
        let c = self.rest.chars().next()?;
        self.rest = &self.rest[c.len_utf8()..];
        Some(c)
    }

    /// Letters of a command behind its backslash.
    fn letters(&mut self) -> &'t str {
        let end = self.rest.find(|c: char| !c.is_ascii_alphabetic()).unwrap_or(self.rest.len());
        let (letters, rest) = self.rest.split_at(end);
        self.rest = rest;
        letters
    }

    /// Up to a closing mark, which is taken, or to the end.
    fn row(&mut self, until: Option<&str>) -> Result<Vec<Math>, Unread> {
        let mut items: Vec<Math> = Vec::new();
        loop {
            if self.rest.is_empty() {
                return if until.is_none() { Ok(items) } else { Err(format!("no {until:?}")) };
            }
            if until.is_some_and(|mark| self.eat(mark)) {
                return Ok(items);
            }
            if self.eat(" ") || self.eat("\\,") || self.eat("\\quad") {
                continue;
            }
            if self.rest.starts_with(['^', '_']) {
                let base = items.pop().ok_or("a script of nothing")?;
                let (mut below, mut above) = (None, None);
                while let Some(mark) = self.rest.chars().next().filter(|c| ['^', '_'].contains(c)) {
                    self.next();
                    let place = if mark == '_' { &mut below } else { &mut above };
                    if place.replace(self.argument()?).is_some() {
                        return Err("two scripts at one place".to_owned());
                    }
                }
                items.push(script(base, below, above));
                continue;
            }
            items.push(self.item()?);
        }
    }

    /// A group, or one character or command.
    fn argument(&mut self) -> Result<Vec<Math>, Unread> {
        if self.eat("{") { self.row(Some("}")) } else { Ok(vec![self.item()?]) }
    }

    fn item(&mut self) -> Result<Math, Unread> {
        let c = self.next().ok_or("nothing")?;
        Ok(match c {
            '\\' => return self.command(),
            '{' => Math::Group(self.row(Some("}"))?),
            '(' => Math::Fenced('(', self.row(Some(")"))?),
            '0'..='9' => {
                let mut digits = String::from(c);
                while let Some(digit) = self.rest.chars().next().filter(char::is_ascii_digit) {
                    self.next();
                    digits.push(digit);
                }
                Math::Number(digits)
            }
            '+' | '-' | '=' | ',' => Math::Mark(c),
            c if c.is_alphabetic() => Math::Word { text: c.to_string(), upright: false },
            c => return Err(format!("`{c}` before `{}`", self.rest)),
        })
    }

    fn command(&mut self) -> Result<Math, Unread> {
        let name = self.letters();
        Ok(match name {
            "frac" => Math::Fraction(self.argument()?, self.argument()?),
            "sqrt" => {
                let order = if self.eat("[") { Some(self.row(Some("]"))?) } else { None };
                Math::Root(order, self.argument()?)
            }
            "dot" | "ddot" => {
                self.eat(" ");
                Math::Dotted(name.len() - 2, self.argument()?)
            }
            "left" if self.eat("(") => Math::Fenced('(', self.row(Some("\\right)"))?),
            "left" if self.eat("|") => Math::Fenced('|', self.row(Some("\\right|"))?),
            // Parentheses that lines may break in.
            "bigl" if self.eat("(") => Math::Fenced('(', self.row(Some("\\bigr)"))?),
            "mathrm" => Math::Word { text: self.words()?, upright: true },
            "operatorname" => Math::Function(self.words()?),
            "text" => Math::Prose(self.words()?),
            "neq" => Math::Mark('≠'),
            "ge" => Math::Mark('≥'),
            "ldots" => Math::Mark('…'),
            "partial" => Math::Word { text: "∂".to_owned(), upright: false },
            "circ" => Math::Word { text: "∘".to_owned(), upright: false },
            name if FUNCTIONS.contains(&name) => Math::Function(name.to_owned()),
            name => match greek(name) {
                Some(letter) => Math::Word { text: letter.to_owned(), upright: false },
                None => return Err(format!("`\\{name}`")),
            },
        })
    }

    /// The text of a group, Greek letters and escaped marks among it.
    fn words(&mut self) -> Result<String, Unread> {
        if !self.eat("{") {
            return Err(format!("no group before `{}`", self.rest));
        }
        let (mut text, mut depth) = (String::new(), 0);
        loop {
            match self.next().ok_or("an open group")? {
                '{' => depth += 1,
                '}' if depth == 0 => return Ok(text),
                '}' => depth -= 1,
                '\\' => match self.letters() {
                    "" => text.extend(self.next()),
                    letters => text.push_str(greek(letters).ok_or_else(|| format!("`\\{letters}`"))?),
                },
                c => text.push(c),
            }
        }
    }
}
