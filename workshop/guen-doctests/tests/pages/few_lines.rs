//! The first page that plays takes at most four lines beside the declaration, and the example shows the same one.

use std::path::Path;

/// The most lines of `main`, without the one that says that all went well.
const MOST: usize = 4;

/// The lines between the first one that begins so and the next one that ends a block.
fn block<'t>(text: &'t str, begin: &str) -> Vec<&'t str> {
    let lines = text.lines().skip_while(|line| !line.starts_with(begin)).skip(1);
    lines.take_while(|line| *line != "}").collect()
}

#[test]
fn a_page_that_plays_takes_few_lines() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let [page, example] = ["docs/viewing.md", "examples/furuta.rs"]
        .map(|path| std::fs::read_to_string(root.join(path)).unwrap());
    let first = page.split("```").nth(1).unwrap();
    let declared = block(first, "guen::mechanical_system!");
    assert!(declared.len() > 5);
    assert_eq!(declared, block(&example, "guen::mechanical_system!"));
    let main = block(first, "fn main()");
    let (last, told) = main.split_last().unwrap();
    assert_eq!(last.trim(), "Ok(())");
    assert!((1..=MOST).contains(&told.len()) && told.iter().any(|line| line.contains(".view(")), "{told:?}");
    // The example makes the page that the browser's tests open by the same lines, to another place.
    let made = block(&example, "fn main()");
    assert!(told[..told.len() - 1].iter().all(|line| made.contains(line)), "{made:?}");
}
