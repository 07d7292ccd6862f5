//! Pages that play: below a picture of a motion, a link to the page on which it moves. The examples and the program `gallery` make
//! these pages; a book that is built without them has none of the links.

use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use mdbook_driver::MDBook;
use mdbook_driver::book::BookItem;

/// A picture of the pages, and the page that a program leaves below `guen` in the target folder.
const PLAYED: [(&str, &str); 12] = [
    ("viewer-hoop-light.png", "hoop/hoop.html"),
    ("viewer-robot-light.png", "balancing_robot/robot.html"),
    ("viewer-car-dark.png", "viewer/car.html"),
    ("ball-on-table.svg", "viewer/turntable.html"),
    ("balancing-robot.svg", "balancing_robot/robot.html"),
    ("chaplygin-ball.svg", "gallery/chaplygin-ball.html"),
    ("rattleback.svg", "gallery/rattleback.html"),
    ("spherical-pendulum.svg", "gallery/spherical-pendulum.html"),
    ("double-pendulum.svg", "gallery/double-pendulum.html"),
    ("snakeboard.svg", "gallery/snakeboard.html"),
    ("snake-robot.svg", "gallery/snake-robot.html"),
    ("bicycle.svg", "gallery/bicycle.html"),
];

/// The folder of the book for these pages.
const FOLDER: &str = "live";

/// A page to be copied into the book.
fn name(page: &str) -> &str {
    page.rsplit('/').next().unwrap_or(page)
}

/// Adds the links; returns the pages that they lead to.
pub fn link(book: &mut MDBook, made: &Path) -> BTreeSet<PathBuf> {
    let mut linked = BTreeSet::new();
    book.book.for_each_mut(|item| {
        if let BookItem::Chapter(chapter) = item
            && let Some(path) = &chapter.path
        {
            let up = "../".repeat(path.components().count() - 1);
            chapter.content = with_links(&chapter.content, &up, |page| {
                let page = made.join(page);
                let text = fs::read_to_string(&page).ok()?;
                let (_, title) = text.split_once("<title>")?;
                linked.insert(page);
                Some(title.split_once("</title>")?.0.to_owned())
            });
        }
    });
    linked
}

/// A page with a line below each picture whose motion can be played; `title` is that of a page that there is.
fn with_links(text: &str, up: &str, mut title: impl FnMut(&str) -> Option<String>) -> String {
    let mut with = String::new();
    for line in text.split_inclusive('\n') {
        with += line;
        let shown = PLAYED
            .iter()
            .find(|(picture, _)| line.starts_with("![") && line.contains(&format!("/{picture})")));
        if let Some((page, title)) = shown.and_then(|(_, page)| Some((page, title(page)?))) {
            with += &format!(
                "\n<p class=\"live\"><a href=\"{up}{FOLDER}/{}\">Play: {title}</a></p>\n\n",
                name(page)
            );
        }
    }
    with
}

/// Copies pages into a built book.
pub fn copy(pages: &BTreeSet<PathBuf>, folder: &Path) -> io::Result<()> {
    for page in pages {
        let into = folder.join(FOLDER);
        fs::create_dir_all(&into)?;
        fs::copy(page, into.join(page.file_name().unwrap_or_default()))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_of_a_motion_leads_to_the_page_that_plays_it() {
        let page = "Words.\n\n![A car](pictures/viewer-car-dark.png)\n\n![Other](pictures/other.svg)\n";
        let with = with_links(page, "../", |page| (page == "viewer/car.html").then(|| "A car".to_owned()));
        let line = "<a href=\"../live/car.html\">Play: A car</a>";
        assert!(with.contains(line) && with.matches("Play").count() == 1, "{with}");
        // What is not there is not linked.
        assert_eq!(with_links(page, "", |_| None), page);
    }
}
