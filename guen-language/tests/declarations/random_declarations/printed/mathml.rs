//! MathML, as far as pages use it.

use super::math::{Math, script};
use super::term::Unread;

/// An element with what is in it.
#[derive(Debug)]
struct Element {
    tag: String,
    attributes: String,
    inner: Vec<Node>,
}

#[derive(Debug)]
enum Node {
    Element(Element),
    Text(String),
}

/// The page that a formula in LaTeX becomes.
pub fn page(formula: &str) -> String {
    guen_language::report::set(&format!("$${formula}$$")).trim_end().to_owned()
}

/// Reads a paragraph: one formula, over several `math` elements where lines may break.
pub fn read(page: &str) -> Result<Vec<Math>, Unread> {
    let mut rest = page;
    let nodes = nodes(&mut rest, None)?;
    let [Node::Element(paragraph)] = &nodes[..] else { return Err(format!("no paragraph: {page}")) };
    let mut items = Vec::new();
    for node in &paragraph.inner {
        match node {
            Node::Element(math) if math.tag == "math" => flat(&math.inner, &mut items)?,
            Node::Text(text) if text.trim().is_empty() => {}
            node => return Err(format!("{node:?}")),
        }
    }
    fenced(&mut items.into_iter().peekable(), None)
}

/// A part, or a mark that opens or closes.
#[derive(Debug)]
enum Part {
    Math(Math),
    Open(char),
    Close(char),
    Apply,
}

fn nodes(rest: &mut &str, until: Option<&str>) -> Result<Vec<Node>, Unread> {
    let mut found = Vec::new();
    loop {
        if rest.is_empty() {
            return if until.is_none() { Ok(found) } else { Err(format!("<{until:?}> is open")) };
        }
        if let Some(after) = rest.strip_prefix("</") {
            let (tag, after) = after.split_once('>').ok_or("a tag without end")?;
            *rest = after;
            return if until == Some(tag) { Ok(found) } else { Err(format!("</{tag}> in <{until:?}>")) };
        }
        if let Some(after) = rest.strip_prefix('<') {
            let (head, after) = after.split_once('>').ok_or("a tag without end")?;
            *rest = after;
            let (whole, is_empty) = match head.strip_suffix('/') {
                Some(head) => (head, true),
                None => (head, false),
            };
            let (tag, attributes) = whole.split_once(' ').unwrap_or((whole, ""));
            let inner = if is_empty { Vec::new() } else { nodes(rest, Some(tag))? };
            found.push(Node::Element(Element {
                tag: tag.to_owned(),
                attributes: attributes.to_owned(),
                inner,
            }));
            continue;
        }
        let end = rest.find('<').unwrap_or(rest.len());
        let (text, after) = rest.split_at(end);
        *rest = after;
        let text = text.replace("&lt;", "<").replace("&gt;", ">").replace("&#8289;", "\u{2061}");
        found.push(Node::Text(text.replace("&amp;", "&")));
    }
}

/// The parts of a row, rows in it dissolved where they stand for themselves.
fn flat(nodes: &[Node], out: &mut Vec<Part>) -> Result<(), Unread> {
    for node in nodes {
        let element = match node {
            Node::Element(element) => element,
            Node::Text(text) if text.trim().is_empty() => continue,
            Node::Text(text) => return Err(format!("`{text}` outside of an element")),
        };
        let text: String = element
            .inner
            .iter()
            .map(|node| if let Node::Text(text) = node { &text[..] } else { "" })
            .collect();
        let upright = element.attributes.contains("mathvariant=\"normal\"") || text.chars().count() > 1;
        let part = match &element.tag[..] {
            "mspace" => continue,
            "mrow" => {
                // A row around all there is; fences may be open in it.
                if nodes.len() == 1 {
                    flat(&element.inner, out)?;
                    continue;
                }
                let mut inner = row(&element.inner)?;
                Part::Math(if inner.len() == 1 { inner.remove(0) } else { Math::Group(inner) })
            }
            "mn" => Part::Math(Math::Number(text)),
            "mi" => Part::Math(Math::Word { text, upright }),
            "mtext" => Part::Math(Math::Prose(text)),
            "mo" => match &text[..] {
                "\u{2061}" => Part::Apply,
                "(" => Part::Open('('),
                ")" => Part::Close('('),
                "|" if element.attributes.contains("prefix") => Part::Open('|'),
                "|" if element.attributes.contains("postfix") => Part::Close('|'),
                "−" => Part::Math(Math::Mark('-')),
                "∘" => Part::Math(Math::Word { text, upright: false }),
                text => Part::Math(Math::Mark(text.chars().next().ok_or("an empty operator")?)),
            },
            "mfrac" => {
                let [above, below] = children(element)?;
                Part::Math(Math::Fraction(above, below))
            }
            "msqrt" => Part::Math(Math::Root(None, row(&element.inner)?)),
            "mroot" => {
                let [inner, order] = children(element)?;
                Part::Math(Math::Root(Some(order), inner))
            }
            "msub" => {
                let [base, below] = children(element)?;
                Part::Math(script(Math::Group(base), Some(below), None))
            }
            "msup" => {
                let [base, above] = children(element)?;
                Part::Math(script(Math::Group(base), None, Some(above)))
            }
            "msubsup" => {
                let [base, below, above] = children(element)?;
                Part::Math(script(Math::Group(base), Some(below), Some(above)))
            }
            "mover" => match &element.inner[..] {
                [base, Node::Element(mark)] => {
                    let dots = match &mark.inner[..] {
                        [Node::Text(dots)] if dots.chars().all(|c| c == '.') => dots.len(),
                        _ => return Err(format!("{mark:?}")),
                    };
                    Part::Math(Math::Dotted(dots, row(std::slice::from_ref(base))?))
                }
                _ => return Err(format!("{element:?}")),
            },
            _ => return Err(format!("<{}>", element.tag)),
        };
        // What a function is applied to follows its name.
        match part {
            Part::Apply => match out.pop() {
                Some(Part::Math(name)) => out.push(Part::Math(function(name)?)),
                other => return Err(format!("{other:?} is applied")),
            },
            part => out.push(part),
        }
    }
    Ok(())
}

fn function(name: Math) -> Result<Math, Unread> {
    match name {
        Math::Word { text, .. } => Ok(Math::Function(text)),
        Math::Script { base, below, above } => {
            Ok(Math::Script { base: Box::new(function(*base)?), below, above })
        }
        other => Err(format!("{other:?} is applied")),
    }
}

/// The arguments of an element that has so many, each of them one element.
fn children<const N: usize>(element: &Element) -> Result<[Vec<Math>; N], Unread> {
    let rows: Result<Vec<Vec<Math>>, Unread> =
        element.inner.iter().map(|node| row(std::slice::from_ref(node))).collect();
    rows?.try_into().map_err(|rows: Vec<_>| format!("<{}> of {}", element.tag, rows.len()))
}

fn row(nodes: &[Node]) -> Result<Vec<Math>, Unread> {
    let mut parts = Vec::new();
    flat(nodes, &mut parts)?;
    fenced(&mut parts.into_iter().peekable(), None)
}

fn fenced(
    parts: &mut std::iter::Peekable<std::vec::IntoIter<Part>>,
    until: Option<char>,
) -> Result<Vec<Math>, Unread> {
    let mut items = Vec::new();
    while let Some(part) = parts.next() {
        match part {
            Part::Math(math) => items.push(math),
            Part::Open(mark) => items.push(Math::Fenced(mark, fenced(parts, Some(mark))?)),
            Part::Close(mark) if until == Some(mark) => return Ok(items),
            Part::Close(mark) => return Err(format!("`{mark}` closes nothing")),
            Part::Apply => return Err("a function of nothing".to_owned()),
        }
    }
    if until.is_none() { Ok(items) } else { Err(format!("no end of `{until:?}`")) }
}
