//! The grammar that `docs/language.md` states: sentences drawn from it are read without a fault, its words are the parser's, and its
//! lists of functions, reserved words and units are those of the program.

use std::collections::{BTreeMap, BTreeSet};

use guen_language::syntax::Dimension;
use guen_language::{names, parse};

const PAGE: &str = include_str!("../../../docs/language.md");

/// The right side of a rule.
#[derive(Clone, Debug)]
enum Rule {
    Word(String),
    Name(String),
    Sequence(Vec<Rule>),
    Choice(Vec<Rule>),
    Optional(Box<Rule>),
    Repeated(Box<Rule>),
}

/// Reads what stands right of `:=`.
struct Reader {
    tokens: Vec<String>,
    at: usize,
}

impl Reader {
    fn new(text: &str) -> Self {
        let mut tokens = Vec::new();
        let mut rest = text.trim_start();
        while let Some(first) = rest.chars().next() {
            let length = match first {
                '\'' => 2 + rest[1..].find('\'').expect("the end of a word"),
                '(' | ')' | '[' | ']' | '|' | '*' | '?' => 1,
                _ => rest.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(rest.len()),
            };
            assert!(length > 0, "{rest}");
            tokens.push(rest[..length].to_owned());
            rest = rest[length..].trim_start();
        }
        Reader { tokens, at: 0 }
    }

    fn peek(&self) -> Option<&str> {
        self.tokens.get(self.at).map(String::as_str)
    }

    fn choice(&mut self) -> Rule {
        let mut all = vec![self.sequence()];
        while self.peek() == Some("|") {
            self.at += 1;
            all.push(self.sequence());
        }
        if all.len() == 1 { all.remove(0) } else { Rule::Choice(all) }
    }

    fn sequence(&mut self) -> Rule {
        let mut all = Vec::new();
        while let Some(token) =
            self.peek().map(str::to_owned).filter(|token| !["|", ")", "]"].contains(&&token[..]))
        {
            self.at += 1;
            let mut part = match &token[..] {
                "(" | "[" => {
                    let inside = self.choice();
                    self.at += 1;
                    if token == "[" { Rule::Optional(Box::new(inside)) } else { inside }
                }
                word if word.starts_with('\'') => Rule::Word(word.trim_matches('\'').to_owned()),
                name => Rule::Name(name.to_owned()),
            };
            if self.peek() == Some("*") {
                self.at += 1;
                part = Rule::Repeated(Box::new(part));
            } else if self.peek() == Some("?") {
                self.at += 1;
                part = Rule::Optional(Box::new(part));
            }
            all.push(part);
        }
        Rule::Sequence(all)
    }
}

/// All rules of the page.
fn grammar() -> BTreeMap<String, Rule> {
    let mut found = BTreeMap::new();
    for block in PAGE
        .split("```")
        .skip(1)
        .step_by(2)
        .filter(|block| block.starts_with("text\n") && block.contains(" := "))
    {
        let mut rules: Vec<(String, String)> = Vec::new();
        for line in block.lines().skip(1) {
            match line.split_once(" := ").filter(|(name, _)| !name.contains('\'')) {
                Some((name, rule)) => rules.push((name.trim().to_owned(), rule.to_owned())),
                None => rules.last_mut().expect("a rule").1.push_str(line),
            }
        }
        for (name, rule) in rules {
            let rule = Reader::new(&rule).choice();
            assert!(found.insert(name.clone(), rule).is_none(), "`{name}` has two rules");
        }
    }
    found
}

struct Draw(u64);

impl Draw {
    fn below(&mut self, limit: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) as usize) % limit
    }

    fn pick<'a>(&mut self, items: &[&'a str]) -> &'a str {
        items[self.below(items.len())]
    }

    /// Writes a sentence of a rule; the deeper it is, the shorter are its parts.
    fn write(&mut self, rules: &BTreeMap<String, Rule>, rule: &Rule, depth: usize, text: &mut String) {
        match rule {
            Rule::Word(word) => *text += &format!("{word} "),
            Rule::Sequence(all) => all.iter().for_each(|one| self.write(rules, one, depth, text)),
            Rule::Choice(all) => {
                // The first of an expression's alternatives end.
                let most = if depth > 14 { 1 } else { all.len() };
                let one = self.below(most);
                self.write(rules, &all[one], depth, text);
            }
            Rule::Optional(one) => {
                if depth < 14 && self.below(3) == 0 {
                    self.write(rules, one, depth, text);
                }
            }
            Rule::Repeated(one) => {
                for _ in 0..if depth > 10 { 0 } else { self.below(3) } {
                    self.write(rules, one, depth, text);
                }
            }
            Rule::Name(name) => match (&name[..], rules.get(name)) {
                // `-x` is a sign before anything else: deep down it is left out.
                ("unary", _) if depth > 12 => self.write(rules, &rules["primary"], depth + 1, text),
                ("factor", _) if depth > 12 => *text += "1 ",
                (_, Some(rule)) => self.write(rules, rule, depth + 1, text),
                ("name", _) => *text += &format!("{} ", self.pick(&["x", "y1", "mass", "r#type", "θ"])),
                ("function", _) => *text += &format!("{} ", self.pick(&["f", "bump", "height"])),
                ("number", _) => *text += &format!("{} ", self.pick(&["0", "2", "0.5", "6.6e-34"])),
                ("whole", _) => *text += &format!("{} ", self.pick(&["0", "1", "2"])),
                ("positive", _) => *text += &format!("{} ", self.pick(&["2", "3"])),
                ("si", _) => *text += &format!("{} ", self.pick(&["kg", "m", "s", "N", "1", "A"])),
                _ => panic!("`{name}` has no rule"),
            },
        }
    }
}

/// Whether a fault is one of the grammar; what names and indices mean is no matter of it.
fn is_of_the_grammar(fault: &str) -> bool {
    let begins = [
        "expected ",
        "unknown section",
        "unknown unit",
        "`**`",
        "this `;`",
        "a constraint needs",
        "something is missing",
    ];
    begins.iter().any(|start| fault.starts_with(start)) || fault.contains("cannot run into")
}

#[test]
fn sentences_of_the_page_are_read() {
    let rules = grammar();
    let mut draw = Draw(11);
    let (mut read, mut seen) = (0, BTreeSet::<&str>::new());
    let (mut faults, mut refused) = (Vec::new(), 0);
    for _ in 0..600 {
        let mut text = String::new();
        draw.write(&rules, &Rule::Name("system".to_owned()), 0, &mut text);
        let (_, report) = parse::parse(text.parse().unwrap_or_else(|error| panic!("{error}: {text}")));
        let wrong: Vec<&str> = report
            .faults()
            .iter()
            .map(|fault| fault.message())
            .filter(|fault| is_of_the_grammar(fault))
            .collect();
        // With another word in its place the sentence is none.
        let damaged = text.replace(" along ", " at ");
        if damaged != text {
            let (_, report) = parse::parse(damaged.parse().expect("tokens"));
            assert!(report.faults().iter().any(|fault| is_of_the_grammar(fault.message())), "{damaged}");
            refused += 1;
        }
        if wrong.is_empty() {
            read += 1;
            seen.extend(names::SECTIONS.iter().copied().filter(|word| text.contains(&format!("{word} "))));
        } else {
            faults.push(format!("{wrong:?} in {text}"));
        }
    }
    assert!(faults.is_empty(), "{} of 600:\n{}", faults.len(), faults[..faults.len().min(5)].join("\n"));
    assert!(refused >= 10, "{refused}");
    assert!(read == 600 && seen.len() == names::SECTIONS.len(), "{seen:?}");
}

/// Every section, statement and field of the parser is a word of the grammar, and has a row in the page's tables.
#[test]
fn the_page_has_the_words_of_the_parser() {
    let rules = format!("{:?}", grammar());
    let all = names::SECTIONS.iter().chain(names::PARAMETER_ALIASES).chain(names::SCENE_STATEMENTS);
    for word in all.chain(names::BODY_FIELDS).chain(names::FOLDS) {
        assert!(rules.contains(&format!("Word({word:?})")), "`{word}` is not in the grammar");
    }
    for word in names::SECTIONS.iter().filter(|word| !["scene", "provide"].contains(word)) {
        let begins = |line: &str| {
            line.starts_with("| `") && line.split(" | ").next().is_some_and(|cell| cell.contains(word))
        };
        assert!(PAGE.lines().any(begins), "`{word}` has no row");
    }
    let is_there = |word: &str| {
        let parts = PAGE.split(|c: char| !(c.is_alphanumeric() || c == '_' || c == 'π'));
        parts.into_iter().any(|part| part == word)
    };
    for word in names::SCALAR_FUNCTIONS.iter().chain(names::SPATIAL_FUNCTIONS).chain(names::RESERVED_WORDS) {
        assert!(is_there(word) || *word == "π", "`{word}` is not on the page");
    }
    for unit in Dimension::names() {
        assert!(is_there(unit), "`{unit}` is not on the page");
    }
}
