//! Every link of the pages leads to a file of the repository, and to a heading that is there; every page is in the
//! book; every picture is on a page. Without a network: addresses elsewhere are not followed.

use std::collections::BTreeSet;
use std::path::{Component, Path, PathBuf};

use guen_doctests::{files, pages, root};

/// A path from the root for a link on a page.
fn target(page: &str, link: &str) -> PathBuf {
    let mut target = Path::new(page).parent().unwrap_or(Path::new("")).to_owned();
    for part in Path::new(link).components() {
        match part {
            Component::ParentDir => drop(target.pop()),
            part => target.push(part),
        }
    }
    target
}

fn is_elsewhere(link: &str) -> bool {
    link.starts_with("https://") || link.starts_with("http://")
}

#[test]
fn links_lead_somewhere() {
    let pages = pages();
    let mut faults = Vec::new();
    let mut count = 0;
    for page in &pages {
        for (line, link) in page.links() {
            if is_elsewhere(&link) {
                continue;
            }
            count += 1;
            let (path, place) = link.split_once('#').unwrap_or((&link, ""));
            let file = if path.is_empty() { PathBuf::from(&page.path) } else { target(&page.path, path) };
            let there = match pages.iter().find(|other| Path::new(&other.path) == file) {
                Some(other) => place.is_empty() || other.anchors().iter().any(|anchor| anchor == place),
                None => root().join(&file).is_file() && place.is_empty(),
            };
            // The book consists of `docs/` alone.
            let leaves = page.path.starts_with("docs/") && !file.starts_with("docs");
            if !there || leaves {
                faults.push(format!("{}:{line}: {link}", page.path));
            }
        }
    }
    assert!(
        faults.is_empty(),
        "{} links lead nowhere or out of the book:\n{}",
        faults.len(),
        faults.join("\n")
    );
    assert!(count > 50, "only {count} links were found");
}

#[test]
fn links_are_called_by_titles() {
    let pages = pages();
    let mut faults = Vec::new();
    let mut count = 0;
    for page in &pages {
        for (line, text) in page.prose() {
            for (before, link) in text.match_indices("](").map(|(at, _)| (&text[..at], &text[at + 2..])) {
                let (called, link) = (
                    before.rsplit('[').next().unwrap_or(before),
                    link.split([')', '#']).next().unwrap_or(link),
                );
                count += 1;
                let file = link.rsplit('/').next().unwrap_or(link);
                if !file.is_empty() && called.trim_matches('`').ends_with(file) && file.ends_with(".md") {
                    faults.push(format!("{}:{line}: {called}", page.path));
                }
            }
        }
    }
    assert!(faults.is_empty(), "links are called by their files:\n{}", faults.join("\n"));
    assert!(count > 50, "only {count} links were found");
}

#[test]
fn every_page_is_in_the_book_once() {
    let pages = pages();
    let summary = pages.iter().find(|page| page.path == "docs/SUMMARY.md").expect("the summary");
    let listed: Vec<PathBuf> = summary.links().iter().map(|(_, link)| target(&summary.path, link)).collect();
    let once: BTreeSet<&PathBuf> = listed.iter().collect();
    assert_eq!(once.len(), listed.len(), "a page is listed twice");
    for page in pages.iter().filter(|page| page.path.starts_with("docs/") && page.path != summary.path) {
        assert!(
            listed.iter().any(|path| path == Path::new(&page.path)),
            "{} is not in SUMMARY.md",
            page.path
        );
    }
}

#[test]
fn every_picture_is_on_a_page() {
    let shown: BTreeSet<PathBuf> = pages()
        .iter()
        .flat_map(|page| {
            page.links().into_iter().map(|(_, link)| target(&page.path, &link)).collect::<Vec<_>>()
        })
        .collect();
    let mut pictures = Vec::new();
    files(&root().join("docs/pictures"), &mut pictures);
    for picture in pictures {
        let picture = picture.strip_prefix(root()).expect("below the root");
        assert!(shown.contains(picture), "{} is on no page", picture.display());
    }
}
