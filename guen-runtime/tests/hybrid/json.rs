//! Just enough JSON for the reference scenes.

use std::collections::BTreeMap;

/// A value.
#[derive(Clone, Debug, PartialEq)]
pub enum Json {
    Null,
    Text(String),
    List(Vec<Json>),
    Record(BTreeMap<String, Json>),
}

impl Json {
    /// Reads a text.
    pub fn read(text: &str) -> Self {
        let mut rest = text.trim_start();
        let value = value(&mut rest);
        assert!(rest.trim().is_empty(), "text after the value: {rest}");
        value
    }

    /// The entry of a record; null where there is none.
    pub fn get(&self, key: &str) -> &Json {
        match self {
            Self::Record(record) => record.get(key).unwrap_or(&Self::Null),
            _ => &Self::Null,
        }
    }

    pub fn list(&self) -> &[Json] {
        match self {
            Self::List(list) => list,
            _ => &[],
        }
    }

    pub fn text(&self) -> &str {
        match self {
            Self::Text(text) => text,
            _ => "",
        }
    }

    /// A number, or a fraction of two.
    pub fn number(&self) -> f64 {
        let text = self.text();
        let parsed = match text.split_once('/') {
            Some((a, b)) => a.parse::<f64>().and_then(|a| b.parse::<f64>().map(|b| a / b)),
            None => text.parse(),
        };
        parsed.unwrap_or_else(|_| panic!("no number: {self:?}"))
    }

    pub fn numbers(&self) -> Vec<f64> {
        self.list().iter().map(Self::number).collect()
    }

    pub fn texts(&self) -> Vec<&str> {
        self.list().iter().map(Self::text).collect()
    }
}

fn skip(rest: &mut &str, token: &str) -> bool {
    match rest.strip_prefix(token) {
        Some(after) => {
            *rest = after.trim_start();
            true
        }
        None => false,
    }
}

fn value(rest: &mut &str) -> Json {
    if skip(rest, "{") {
        let mut record = BTreeMap::new();
        while !skip(rest, "}") {
            let key = string(rest);
            assert!(skip(rest, ":"));
            record.insert(key, value(rest));
            skip(rest, ",");
        }
        return Json::Record(record);
    }
    if skip(rest, "[") {
        let mut list = Vec::new();
        while !skip(rest, "]") {
            list.push(value(rest));
            skip(rest, ",");
        }
        return Json::List(list);
    }
    if rest.starts_with('"') {
        return Json::Text(string(rest));
    }
    let end = rest.find([',', ']', '}', '\n']).unwrap_or(rest.len());
    let (word, after) = rest.split_at(end);
    *rest = after.trim_start();
    match word.trim() {
        "null" => Json::Null,
        word => Json::Text(word.to_string()),
    }
}

fn string(rest: &mut &str) -> String {
    let mut characters = rest.char_indices().skip(1);
    let mut text = String::new();
    while let Some((at, c)) = characters.next() {
        match c {
            '"' => {
                *rest = rest[at + 1..].trim_start();
                return text;
            }
            '\\' => match characters.next() {
                Some((_, 'n')) => text.push('\n'),
                Some((_, c)) => text.push(c),
                None => break,
            },
            c => text.push(c),
        }
    }
    panic!("a string without end")
}
