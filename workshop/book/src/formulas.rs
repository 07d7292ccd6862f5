//! Formulas of pages as MathML, which browsers set without a script: `$..$` in a line, and blocks of the language `math`.

use mdbook_driver::MDBook;
use mdbook_driver::book::BookItem;
use pulldown_latex::config::DisplayMode;
use pulldown_latex::{Parser, RenderConfig, Storage, push_mathml};

/// Replaces the formulas of all chapters; the faults are formulas that are none, with their chapter.
pub fn set(book: &mut MDBook) -> Vec<String> {
    let mut faults = Vec::new();
    book.book.for_each_mut(|item| {
        if let BookItem::Chapter(chapter) = item {
            let (text, wrong) = replaced(&chapter.content);
            faults.extend(wrong.into_iter().map(|fault| format!("{}: {fault}", chapter.name)));
            chapter.content = text;
        }
    });
    faults
}

/// A page with MathML for formulas, and what is no formula.
fn replaced(page: &str) -> (String, Vec<String>) {
    let (mut text, mut faults) = (String::new(), Vec::new());
    let mut lines = page.split_inclusive('\n');
    while let Some(line) = lines.next() {
        let fence = line.trim_start();
        if !fence.starts_with("```") {
            text += &within(line, &mut faults);
            continue;
        }
        let block: String = lines.by_ref().take_while(|line| !line.trim_start().starts_with("```")).collect();
        if fence.trim_end() == "```math" {
            text += &format!(
                "<div class=\"formula\">{}</div>\n",
                mathml(&block, DisplayMode::Block, &mut faults)
            );
        } else {
            text += &format!("{line}{block}```\n");
        }
    }
    (text, faults)
}

/// A line with its formulas between `$` and `$`, but for those in code.
fn within(line: &str, faults: &mut Vec<String>) -> String {
    line.split('`')
        .enumerate()
        .map(|(k, part)| if k % 2 == 0 { in_words(part, faults) } else { part.to_owned() })
        .collect::<Vec<_>>()
        .join("`")
}

fn in_words(part: &str, faults: &mut Vec<String>) -> String {
    let pieces: Vec<&str> = part.split('$').collect();
    // A lone sign is one of money, or of a shell.
    if pieces.len() % 2 == 0 {
        return part.to_owned();
    }
    let set = pieces.iter().enumerate().map(|(k, piece)| {
        if k % 2 == 0 { (*piece).to_owned() } else { mathml(piece, DisplayMode::Inline, faults) }
    });
    set.collect()
}

/// TeX as MathML, in one line: Markdown ends an element of HTML at an empty one.
fn mathml(tex: &str, display_mode: DisplayMode, faults: &mut Vec<String>) -> String {
    let storage = Storage::new();
    let events: Vec<_> = Parser::new(tex, &storage).collect();
    if let Some(Err(error)) = events.iter().find(|event| event.is_err()) {
        faults.push(format!("`{}` is no formula: {error}", tex.trim()));
    }
    let mut made = String::new();
    let config = RenderConfig { display_mode, ..Default::default() };
    if let Err(error) = push_mathml(&mut made, events.into_iter(), config) {
        faults.push(format!("`{}` cannot be set: {error}", tex.trim()));
    }
    made.replace('\n', " ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formulas_are_set_and_code_is_not() {
        let page = "`$a$` is $\\dot\\eta_1$ and costs 5 $.\n\n```sh\necho $x $y\n```\n\n```math\n\\frac{a}{b}\n```\nend\n";
        let (text, faults) = replaced(page);
        assert_eq!(faults, [""; 0]);
        assert!(
            text.contains("`$a$`") && text.contains("echo $x $y") && text.contains("costs 5 $."),
            "{text}"
        );
        assert_eq!(text.matches("<math").count(), 1, "a line with three signs stays");
        assert!(text.contains("<mfrac>") && text.ends_with("end\n"), "{text}");
        let (text, _) = replaced("is $\\dot\\eta_1$, `x`\n");
        assert!(text.contains("<math") && !text.contains('$') && text.ends_with("`x`\n"), "{text}");
        let (_, faults) = replaced("is $\\nosuch{$\n");
        assert!(faults.iter().any(|fault| fault.contains("`\\nosuch{` is no formula")), "{faults:?}");
    }
}
