//! Formulas in the language's own grammar, with primes for rates and with named unknowns behind their coefficients.

use super::names::Name;
use super::term::{Term, Unread};

/// Reads all of a text.
pub fn read(text: &str) -> Result<Term, Unread> {
    let mut reader = Reader { rest: text };
    let term = reader.sum()?;
    if reader.rest.is_empty() { Ok(term) } else { Err(format!("`{}` is left of `{text}`", reader.rest)) }
}

struct Reader<'t> {
    rest: &'t str,
}

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

    /// `a + b - c`, the first with a sign or without.
    fn sum(&mut self) -> Result<Term, Unread> {
        let mut terms = vec![(self.eat("-"), self.named()?)];
        loop {
            let minus = if self.eat(" + ") {
                false
            } else if self.eat(" - ") {
                true
            } else {
                break;
            };
            terms.push((minus, self.named()?));
        }
        Ok(match &terms[..] {
            [(false, one)] => one.clone(),
            _ => Term::Sum(terms),
        })
    }

    /// A product, and after a space the named thing that it is the coefficient of.
    fn named(&mut self) -> Result<Term, Unread> {
        let product = self.product()?;
        let follows = self.rest.strip_prefix(' ').and_then(|rest| rest.chars().next());
        if follows.is_some_and(|c| c.is_alphabetic() || c == '_') && self.eat(" ") {
            return Ok(Term::Product(vec![(false, product), (false, self.atom()?)]));
        }
        Ok(product)
    }

    /// From the left: `a/b*c` is `(a/b)*c`.
    fn product(&mut self) -> Result<Term, Unread> {
        let mut factors = vec![(false, self.power()?)];
        loop {
            let over = if self.eat("*") {
                false
            } else if self.eat("/") {
                true
            } else {
                break;
            };
            factors.push((over, self.power()?));
        }
        Ok(if factors.len() == 1 { factors.remove(0).1 } else { Term::Product(factors) })
    }

    fn power(&mut self) -> Result<Term, Unread> {
        let base = self.atom()?;
        if !self.eat("^") {
            return Ok(base);
        }
        let (p, q) = self.atom()?.as_ratio()?;
        Ok(Term::Power(Box::new(base), p, q))
    }

    fn atom(&mut self) -> Result<Term, Unread> {
        if self.eat("(") {
            let inner = self.sum()?;
            return if self.eat(")") { Ok(inner) } else { Err(format!("`)` before `{}`", self.rest)) };
        }
        if let Some(variable) = self.rest.strip_prefix("d/d")
            && !variable.starts_with("ot(")
        {
            self.rest = variable;
            return Ok(Term::Name(Name::Partial(Box::new(Name::Text(self.path().to_owned())))));
        }
        let digits = self.rest.len() - self.rest.trim_start_matches(|c: char| c.is_ascii_digit()).len();
        if digits > 0 {
            let (number, rest) = self.rest.split_at(digits);
            self.rest = rest;
            return Term::digits(number);
        }
        let word = self.path();
        if word.is_empty() {
            return Err(format!("nothing before `{}`", self.rest));
        }
        if !self.eat("(") {
            let mut name = word.to_owned();
            while self.eat("'") {
                name.push('\'');
            }
            return Ok(Term::Name(Name::Text(name)));
        }
        let mut arguments = vec![self.sum()?];
        // The condition of `select`.
        self.eat(" >= 0");
        while self.eat(", ") {
            arguments.push(self.sum()?);
        }
        if !self.eat(")") {
            return Err(format!("`)` before `{}`", self.rest));
        }
        match (word, &arguments[..]) {
            ("dot", [Term::Name(Name::Text(name))]) => Ok(Term::Name(Name::Text(format!("dot({name})")))),
            _ => Ok(Term::Call(word.to_owned(), arguments)),
        }
    }

    /// A name with the places in arrays and the fields behind it: `q`, `q[3]`, `k[1][2]`, `rear[2].angle`.
    fn path(&mut self) -> &'t str {
        let begin = self.rest;
        self.word();
        while self.eat("[") || self.eat(".") {
            self.word();
            self.eat("]");
        }
        &begin[..begin.len() - self.rest.len()]
    }

    fn word(&mut self) {
        self.rest = self.rest.trim_start_matches(|c: char| c.is_alphanumeric() || c == '_');
    }
}
