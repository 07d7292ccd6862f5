#!/usr/bin/env python3
"""The book in a real browser: its texts and links have contrast, its formulas are set, nothing sticks out of a telephone.

    cargo run --manifest-path workshop/book/Cargo.toml && python3 tests/browser/book.py

Exits with 0 if all is well, 1 if a page fails, 77 if there is no browser and none can be installed.
"""

import os
import pathlib
import sys

from browser import Browser
from looks import CONTRAST
from place import ROOT

BOOK = pathlib.Path(os.environ.get("CARGO_TARGET_DIR") or ROOT / "target").absolute() / "book"

# A page, and the fewest formulas that it has.
PAGES = [("index", 0), ("viewing", 2), ("theory/displacements", 3), ("theory/classification", 1), ("theory/equations", 3)]


def faults(browser, formulas):
    """What is wrong with the page that is shown."""
    low = [found for found in browser.run(CONTRAST) if found[0] < 1]
    if low:
        yield f"too little contrast: {low[:5]}"
    # What no browser understands has no height; what stayed TeX has a dollar outside of code.
    sizes = browser.run("return [...document.querySelectorAll('main math')].map((m) => m.getBoundingClientRect().height);")
    if len(sizes) < formulas or any(height < 5 for height in sizes):
        yield f"formulas of these heights: {sizes}, at least {formulas} are wanted"
    left = browser.run(
        """const main = document.querySelector('main').cloneNode(true);
        main.querySelectorAll('code, pre').forEach((code) => code.remove());
        return main.textContent.match(/.{0,20}\\$.{0,20}/g);"""
    )
    if left:
        yield f"no formula: {left}"


def main():
    if not (BOOK / "index.html").exists():
        sys.exit("there is no book: cargo run --manifest-path workshop/book/Cargo.toml")
    failed = False
    with Browser() as browser:
        for page, formulas in PAGES:
            for scheme in ("light", "dark"):
                browser.scheme(scheme)
                browser.resize(1100, 900)
                browser.open((BOOK / f"{page}.html").as_uri())
                found = list(faults(browser, formulas))
                browser.resize(390, 844, mobile=True)
                wide = browser.run("return document.documentElement.scrollWidth;")
                if wide > 390:
                    found.append(f"{wide} wide on a telephone of 390")
                for fault in found:
                    print(f"{page}, {scheme}: {fault}", file=sys.stderr)
                failed = failed or bool(found)
        print(f"the book: {'faulty' if failed else 'set and legible'}", flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
