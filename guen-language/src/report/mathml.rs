//! Formulas for rustdoc's pages: MathML, which browsers set without script or network, from the LaTeX of a report.
//!
//! What comes in is what [`guen_symbolic`] writes, a small part of LaTeX; anything else stays readable as a word.

/// A formula as a paragraph that may be broken between its terms.
pub(super) fn paragraph(latex: &str) -> String {
    let mut text = String::from(
        "<div class=\"guen-formula\" style=\"padding-left:2em;text-indent:-2em;margin:.5em 0\">",
    );
    for term in terms(latex) {
        let mut parser = Parser { rest: term };
        text.push_str("<math displaystyle=\"true\"><mrow>");
        parser.row(&mut text, None);
        text.push_str("</mrow></math> ");
    }
    text.push_str("</div>");
    text
}

/// A formula cut before the relations and signs that stand in no parentheses: there lines may break.
fn terms(latex: &str) -> Vec<&str> {
    let mut terms = Vec::new();
    let (mut depth, mut begin) = (0_i32, 0);
    for (i, c) in latex.char_indices() {
        match c {
            '{' | '(' => depth += 1,
            '}' | ')' => depth -= 1,
            '|' => depth += if latex[..i].ends_with("\\left") { 1 } else { -1 },
            // With a space before: not the sign of a first term.
            '+' | '-' | '=' if depth == 0 && latex[..i].ends_with(' ') => {
                terms.push(&latex[begin..i]);
                begin = i;
            }
            _ => {}
        }
    }
    terms.push(&latex[begin..]);
    terms
}

struct Parser<'s> {
    rest: &'s str,
}

impl Parser<'_> {
    fn next(&mut self) -> Option<char> {
        let c = self.rest.chars().next()?;
        self.rest = &self.rest[c.len_utf8()..];
        Some(c)
    }

    fn next_if(&mut self, is_it: impl Fn(char) -> bool) -> Option<char> {
        self.rest.chars().next().filter(|c| is_it(*c))?;
        self.next()
    }

    fn eat(&mut self, text: &str) -> bool {
        let rest = self.rest.strip_prefix(text);
        self.rest = rest.unwrap_or(self.rest);
        rest.is_some()
    }

    /// Atoms with their scripts, up to a closing mark or the end.
    fn row(&mut self, out: &mut String, until: Option<&str>) {
        while !self.rest.is_empty() {
            if until.is_some_and(|mark| self.eat(mark)) {
                return;
            }
            let start = out.len();
            self.atom(out);
            self.scripts(out, start);
        }
    }

    /// `_{..}` and `^{..}` behind what was written from `start` on.
    fn scripts(&mut self, out: &mut String, start: usize) {
        let (mut below, mut above) = (None, None);
        while let Some(mark) = self.next_if(|c| c == '_' || c == '^') {
            let mut script = String::new();
            self.argument(&mut script);
            *(if mark == '_' { &mut below } else { &mut above }) = Some(script);
        }
        let (tag, scripts) = match (below, above) {
            (None, None) => return,
            (Some(below), None) => ("msub", below),
            (None, Some(above)) => ("msup", above),
            (Some(below), Some(above)) => ("msubsup", below + &above),
        };
        let base = out.split_off(start);
        out.push_str(&format!("<{tag}>{}{scripts}</{tag}>", single(&base)));
    }

    /// Writes a group, or an atom, as one element.
    fn argument(&mut self, out: &mut String) {
        if self.eat("{") {
            out.push_str("<mrow>");
            self.row(out, Some("}"));
            out.push_str("</mrow>");
        } else {
            self.atom(out);
        }
    }

    /// The text of a group of letters, Greek ones among them as groups of their own.
    fn verbatim(&mut self) -> String {
        self.eat("{");
        let (mut text, mut depth) = (String::new(), 0);
        while let Some(c) = self.next() {
            match c {
                '{' => depth += 1,
                '}' if depth == 0 => break,
                '}' => depth -= 1,
                '\\' => {
                    let mut name = String::new();
                    while let Some(c) = self.next_if(|c| depth > 0 && c.is_ascii_alphabetic()) {
                        name.push(c);
                    }
                    match guen_symbolic::greek_letter(&name) {
                        Some(letter) => text.push(letter),
                        None => text.push_str(&name),
                    }
                }
                c => text.push(c),
            }
        }
        text
    }

    fn atom(&mut self, out: &mut String) {
        let Some(c) = self.next() else { return };
        match c {
            '\\' => self.command(out),
            '{' => {
                out.push_str("<mrow>");
                self.row(out, Some("}"));
                out.push_str("</mrow>");
            }
            '0'..='9' => {
                let mut digits = String::from(c);
                while let Some(c) = self.next_if(|c| c.is_ascii_digit() || c == '.') {
                    digits.push(c);
                }
                element(out, "mn", &digits);
            }
            // A sign that a term begins with is still one between terms; the space before it is that between the formulas.
            '+' | '=' => out.push_str(&format!("<mo form=\"infix\"{}>{c}</mo>", lead(out))),
            '-' if self.rest.starts_with(' ') => {
                out.push_str(&format!("<mo form=\"infix\"{}>−</mo>", lead(out)));
            }
            '-' => out.push_str("<mo form=\"prefix\">−</mo>"),
            '(' | '[' => out.push_str(&format!("<mo form=\"prefix\">{c}</mo>")),
            ')' | ']' => out.push_str(&format!("<mo form=\"postfix\">{c}</mo>")),
            ',' | '|' => element(out, "mo", &c.to_string()),
            ' ' => {}
            c => element(out, "mi", &c.to_string()),
        }
    }

    fn command(&mut self, out: &mut String) {
        let mut name = String::new();
        while let Some(c) = self.next_if(|c| c.is_ascii_alphabetic()) {
            name.push(c);
        }
        match name.as_str() {
            // `\,` and other marks.
            "" => {
                let mark = self.next();
                out.push_str(if mark == Some(',') { "<mspace width=\"0.17em\"/>" } else { "" });
            }
            "frac" => {
                out.push_str("<mfrac>");
                self.argument(out);
                self.argument(out);
                out.push_str("</mfrac>");
            }
            "sqrt" => {
                let mut order = String::new();
                if self.eat("[") {
                    order.push_str("<mrow>");
                    self.row(&mut order, Some("]"));
                    order.push_str("</mrow>");
                }
                let tag = if order.is_empty() { "msqrt" } else { "mroot" };
                out.push_str(&format!("<{tag}>"));
                self.argument(out);
                out.push_str(&format!("{order}</{tag}>"));
            }
            "dot" | "ddot" | "dddot" => {
                self.eat(" ");
                // As an accent, browsers set the dot into the letter.
                out.push_str("<mover>");
                self.argument(out);
                out.push_str(&format!("<mo>{}</mo></mover>", ".".repeat(name.len() - 2)));
            }
            "mathrm" | "text" | "operatorname" | "mathit" => {
                let words = self.verbatim();
                match name.as_str() {
                    "text" => element(out, "mtext", &words),
                    "operatorname" => self.function(out, &words),
                    // A letter alone would stand in italics.
                    _ if words.chars().count() == 1 => {
                        let start = out.len();
                        element(out, "mi", &words);
                        out.insert_str(start + "<mi".len(), " mathvariant=\"normal\"");
                    }
                    _ => element(out, "mi", &words),
                }
            }
            "left" => {
                // With what it closes one thing, which may have an exponent.
                let (mark, end) = if self.eat("|") { ('|', "\\right|") } else { ('(', "\\right)") };
                self.eat("(");
                out.push_str(&format!("<mrow><mo form=\"prefix\">{mark}</mo>"));
                self.row(out, Some(end));
                let mark = if mark == '|' { '|' } else { ')' };
                out.push_str(&format!("<mo form=\"postfix\">{mark}</mo></mrow>"));
            }
            // Without an opening mark: the mark itself follows.
            "right" => self.atom(out),
            "quad" => out.push_str("<mspace width=\"1em\"/>"),
            "ldots" => out.push_str("<mo>…</mo>"),
            "ge" => out.push_str("<mo form=\"infix\">≥</mo>"),
            "neq" => out.push_str("<mo form=\"infix\">≠</mo>"),
            "partial" => out.push_str("<mi>∂</mi>"),
            "circ" => out.push_str("<mo>∘</mo>"),
            name => match guen_symbolic::greek_letter(name) {
                Some(letter) => element(out, "mi", &letter.to_string()),
                None => self.function(out, name),
            },
        }
    }

    /// A function with its exponent, and its argument to come.
    fn function(&mut self, out: &mut String, name: &str) {
        let start = out.len();
        element(out, "mi", name);
        self.scripts(out, start);
        out.push_str("<mo>&#8289;</mo><mspace width=\"0.17em\"/>");
    }
}

/// The attribute of a sign that is the first thing of a term.
fn lead(out: &str) -> &'static str {
    if out.ends_with("<math displaystyle=\"true\"><mrow>") { " lspace=\"0.05em\"" } else { "" }
}

/// Returns one element, whatever the number of those inside.
fn single(elements: &str) -> String {
    format!("<mrow>{elements}</mrow>")
}

fn element(out: &mut String, tag: &str, text: &str) {
    out.push_str(&format!("<{tag}>"));
    for c in text.chars() {
        match c {
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '&' => out.push_str("&amp;"),
            c => out.push(c),
        }
    }
    out.push_str(&format!("</{tag}>"));
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The content of a formula of one term.
    fn math(latex: &str) -> String {
        let text = paragraph(latex);
        let (_, text) = text.split_once("<mrow>").unwrap();
        text.strip_suffix("</mrow></math> </div>").unwrap().to_owned()
    }

    #[test]
    fn what_reports_are_made_of() {
        assert_eq!(math(r"\frac{1}{2}"), "<mfrac><mrow><mn>1</mn></mrow><mrow><mn>2</mn></mrow></mfrac>");
        assert_eq!(
            math(r"\dot{\eta}_{1}"),
            "<msub><mrow><mover><mrow><mi>η</mi></mrow><mo>.</mo></mover></mrow><mrow><mn>1</mn></mrow></msub>"
        );
        assert_eq!(
            math(r"\sin^{2}\theta"),
            "<msup><mrow><mi>sin</mi></mrow><mrow><mn>2</mn></mrow></msup><mo>&#8289;</mo><mspace width=\"0.17em\"/><mi>θ</mi>"
        );
        assert_eq!(math(r"\sqrt[3]{x}"), "<mroot><mrow><mi>x</mi></mrow><mrow><mn>3</mn></mrow></mroot>");
        assert_eq!(math(r"\mathrm{a{\alpha}{\beta}}"), "<mi>aαβ</mi>");
        assert_eq!(math(r"\text{a < b}"), "<mtext>a &lt; b</mtext>");
        assert_eq!(
            math(r"\left(a - b\right)"),
            "<mrow><mo form=\"prefix\">(</mo><mi>a</mi><mo form=\"infix\">−</mo><mi>b</mi><mo form=\"postfix\">)</mo></mrow>"
        );
        assert_eq!(
            math(r"\left|a\right|^{2}"),
            "<msup><mrow><mrow><mo form=\"prefix\">|</mo><mi>a</mi><mo form=\"postfix\">|</mo></mrow></mrow><mrow><mn>2</mn></mrow></msup>"
        );
        assert_eq!(math(r"\mathrm{o}"), "<mi mathvariant=\"normal\">o</mi>");
    }

    #[test]
    fn lines_break_between_terms_only() {
        assert_eq!(terms("a = b + (c - d) - e^{f + g}"), ["a ", "= b ", "+ (c - d) ", "- e^{f + g}"]);
        assert_eq!(terms("-a"), ["-a"]);
        assert_eq!(terms(r"\left|a - b\right| - c"), [r"\left|a - b\right| ", "- c"]);
    }

    #[test]
    fn every_element_is_closed() {
        let lines = [
            r"X_{2} = \frac{1}{\sin\theta}\,\frac{\partial}{\partial \psi} - \cot\theta\,\frac{\partial}{\partial \phi}",
            r"\left(\frac{\partial T^\circ}{\partial \eta_{4}}\right) = \left|x\right|\,e^{-\mathrm{rate}\,t}",
            r"\operatorname{atan2}\left(y, x\right)^{2} \quad\text{(the rate of }f = 0\text{)}",
            r"\unknown{x}^_} {",
        ];
        for line in lines {
            let text = paragraph(line);
            let mut open = Vec::new();
            for tag in text.split('<').skip(1).map(|rest| rest.split('>').next().unwrap()) {
                match tag.strip_prefix('/') {
                    Some(name) => assert_eq!(open.pop(), Some(name), "{line}: {text}"),
                    None if tag.ends_with('/') => {}
                    None => open.push(tag.split(' ').next().unwrap()),
                }
            }
            assert!(open.is_empty(), "{line}: {text}");
        }
    }
}
