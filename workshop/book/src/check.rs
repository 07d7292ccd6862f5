//! What a built book has to keep: every link within it leads to a page, and to a place on that page, that is there;
//! nothing that a browser loads by itself (pictures, scripts, styles) comes from a network. A link that a reader may
//! click, and that leads out, is nobody's fault; it is not followed.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io;
use std::path::{Component, Path, PathBuf};

/// What [`check`] has seen.
pub struct Found {
    pub pages: usize,
    pub links: usize,
    /// One line for each link that leads nowhere, or is loaded from elsewhere.
    pub faults: Vec<String>,
}

/// Reads all pages below a folder.
pub fn check(folder: &Path) -> io::Result<Found> {
    let mut pages = BTreeMap::new();
    collect(folder, &mut pages)?;
    let places: BTreeMap<&PathBuf, BTreeSet<String>> =
        pages.iter().map(|(path, text)| (path, attributes(text, "id").map(decoded).collect())).collect();
    let mut found = Found { pages: pages.len(), links: 0, faults: Vec::new() };
    for (page, text) in &pages {
        let name = page.strip_prefix(folder).unwrap_or(page).display();
        // mdBook's page for addresses that do not exist is served from anywhere.
        if page.ends_with("404.html") {
            continue;
        }
        for link in attributes(text, "href").chain(attributes(text, "src")) {
            found.links += 1;
            if let Some(fault) = fault_of(&link, page, &places) {
                found.faults.push(format!("{name}: `{link}` {fault}"));
            }
        }
        for loaded in loaded_from_elsewhere(text) {
            found.faults.push(format!("{name}: `{loaded}` would be loaded from a network"));
        }
    }
    Ok(found)
}

fn collect(folder: &Path, pages: &mut BTreeMap<PathBuf, String>) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            collect(&path, pages)?;
        } else if path.extension().is_some_and(|extension| extension == "html") {
            let text = fs::read_to_string(&path)?;
            pages.insert(path, text);
        }
    }
    Ok(())
}

/// The reason why a link leads nowhere, if it does.
fn fault_of(link: &str, page: &Path, places: &BTreeMap<&PathBuf, BTreeSet<String>>) -> Option<&'static str> {
    let leads_out = |scheme: &str| link.starts_with(scheme);
    if ["http://", "https://", "mailto:", "javascript:", "data:"].into_iter().any(leads_out) {
        return None;
    }
    let (path, place) = link.split_once('#').unwrap_or((link, ""));
    let path = path.split('?').next().unwrap_or(path);
    let target = match path {
        "" => page.to_owned(),
        path => joined(page.parent()?, &decoded(path.to_owned())),
    };
    if !target.is_file() {
        return Some("is not there");
    }
    let known = places.get(&target);
    (!place.is_empty() && known.is_some_and(|known| !known.contains(&decoded(place.to_owned()))))
        .then_some("has no such place")
}

fn joined(folder: &Path, path: &str) -> PathBuf {
    let mut target = folder.to_owned();
    for part in Path::new(path).components() {
        match part {
            Component::ParentDir => drop(target.pop()),
            Component::Normal(part) => target.push(part),
            _ => {}
        }
    }
    target
}

/// The values of an attribute in all tags of a page, in double quotes as mdBook writes them.
fn attributes<'a>(text: &'a str, name: &'a str) -> impl Iterator<Item = String> + 'a {
    tags(text).filter_map(move |tag| attribute(tag, name))
}

fn attribute(tag: &str, name: &str) -> Option<String> {
    let mut rest = tag;
    while let Some(at) = rest.find(name) {
        let (before, after) = (&rest[..at], &rest[at + name.len()..]);
        if before.ends_with(char::is_whitespace)
            && let Some(value) = after.strip_prefix("=\"")
        {
            return value.split('"').next().map(str::to_owned);
        }
        rest = after;
    }
    None
}

/// The opening tags of a page, without what scripts and comments contain.
fn tags(text: &str) -> impl Iterator<Item = &str> {
    let mut rest = text;
    std::iter::from_fn(move || {
        loop {
            rest = &rest[rest.find('<')? + 1..];
            if let Some(comment) = rest.strip_prefix("!--") {
                rest = &comment[comment.find("-->")?..];
                continue;
            }
            let end = rest.find('>')?;
            let tag = &rest[..end];
            rest = &rest[end..];
            if tag == "script" || tag.starts_with("script ") {
                rest = &rest[rest.find("</script").unwrap_or(rest.len() - 1)..];
            }
            if tag.starts_with(char::is_alphabetic) {
                return Some(tag);
            }
        }
    })
}

/// What a browser would fetch without being asked.
fn loaded_from_elsewhere(text: &str) -> Vec<String> {
    let mut found = Vec::new();
    for tag in tags(text) {
        let name = tag.split_whitespace().next().unwrap_or("");
        let link = match name {
            "a" => None,
            "link" => attribute(tag, "href"),
            _ => attribute(tag, "src"),
        };
        found.extend(link.filter(|link| link.starts_with("//") || link.starts_with("http")));
    }
    found
}

/// An address as a file or an `id` writes it: `%20` and the five entities of HTML.
fn decoded(text: String) -> String {
    let text = text.replace("&amp;", "&").replace("&quot;", "\"").replace("&#39;", "'");
    let mut bytes = Vec::new();
    let mut rest = text.as_bytes();
    while let [first, tail @ ..] = rest {
        let code = tail.get(..2).and_then(|two| u8::from_str_radix(std::str::from_utf8(two).ok()?, 16).ok());
        match code {
            Some(code) if *first == b'%' => {
                bytes.push(code);
                rest = &tail[2..];
            }
            _ => {
                bytes.push(*first);
                rest = tail;
            }
        }
    }
    String::from_utf8(bytes).unwrap_or(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tags_of_scripts_and_comments_are_skipped() {
        let page = r#"<a href="x.html">y</a><!-- <a href="no"> --><script src="s.js">"<a href='no'>"</script><p id="z">"#;
        assert_eq!(attributes(page, "href").collect::<Vec<_>>(), ["x.html"]);
        assert_eq!(attributes(page, "id").collect::<Vec<_>>(), ["z"]);
        assert_eq!(attributes(page, "src").collect::<Vec<_>>(), ["s.js"]);
    }

    #[test]
    fn what_is_loaded_and_what_is_clicked() {
        let page = r#"<a href="https://a"></a><img alt="" src="https://b"><link rel="x" href="//c"><img src="d.svg">"#;
        assert_eq!(loaded_from_elsewhere(page), ["https://b", "//c"]);
    }

    #[test]
    fn broken_links_are_found() {
        let folder = std::env::temp_dir().join(format!("guen-book-{}", std::process::id()));
        fs::create_dir_all(folder.join("a")).unwrap();
        fs::write(folder.join("index.html"), r##"<a href="a/b.html#here"><a href="#top"><p id="top">"##)
            .unwrap();
        let wrong = r#"<a href="../index.html#none"><img src="c.svg"><p id="here">"#;
        fs::write(folder.join("a/b.html"), wrong).unwrap();
        let found = check(&folder).unwrap();
        fs::remove_dir_all(&folder).unwrap();
        assert_eq!((found.pages, found.links), (2, 4));
        assert_eq!(found.faults.len(), 2, "{:?}", found.faults);
        assert!(found.faults[0].contains("no such place") && found.faults[1].contains("is not there"));
    }
}
