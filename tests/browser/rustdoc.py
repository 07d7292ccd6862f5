#!/usr/bin/env python3
"""The documentation of a declared system, as rustdoc makes it, in a real browser: its formulas are set, nothing sticks out.

    python3 tests/browser/rustdoc.py                     # documents the examples and tests their pages
    python3 tests/browser/rustdoc.py --pictures FOLDER   # keeps screenshots as well

Exits with 0 if all is well, 1 if a page fails, 77 if there is no browser and none can be installed.
"""

import argparse
import pathlib
import subprocess
import sys

from browser import Browser
from place import ROOT, target

# Example, page of the type below the folder of documentation, and headings that it has to have.
PAGES = [
    ("hoop", "hoop/hoop/struct.Hoop.html"),
    ("balancing_robot", "balancing_robot/plant/robot/struct.Robot.html"),
]
HEADINGS = ["Coordinates", "Forms", "Operators", "Brackets", "Classification", "Velocities", "Equations of motion", "Domain", "Cost"]


def faults(browser):
    """What is wrong with the page that is shown."""
    headings = browser.run("return [...document.querySelectorAll('.docblock h2')].map((h) => h.textContent);")
    for wanted in HEADINGS:
        if not any(wanted in heading for heading in headings):
            yield f"no heading `{wanted}` among {headings}"
    if not headings[0].endswith("Equations of motion (2.7)"):
        yield f"the page begins with `{headings[0]}`"
    # A formula that no browser understands has no height; one that was taken for text has no elements.
    sizes = browser.run("return [...document.querySelectorAll('.guen-formula math')].map((m) => [m.getBoundingClientRect().height, m.children.length]);")
    if len(sizes) < 10:
        yield f"only {len(sizes)} parts of formulas"
    if any(height < 5 or children == 0 for height, children in sizes):
        yield "a formula is not set"
    wide = browser.run("return [...document.querySelectorAll('.guen-formula')].filter((f) => f.scrollWidth > f.clientWidth + 1).length;")
    if wide:
        yield f"{wide} formulas are wider than the page"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--pictures", type=pathlib.Path, help="a folder for screenshots")
    parser.add_argument("--made", action="store_true", help="take the documentation as it is")
    arguments = parser.parse_args()
    browser = Browser()
    if not arguments.made:
        examples = [part for example, _ in PAGES for part in ("--example", example)]
        command = ["cargo", "doc", "--quiet", "--no-deps", "--document-private-items", *examples]
        subprocess.run(command, cwd=ROOT, check=True)
    failed = False
    with browser:
        for example, page in PAGES:
            for scheme in ("light", "dark"):
                browser.scheme(scheme)
                browser.resize(1000, 900)
                browser.open((target() / "doc" / page).as_uri())
                for fault in faults(browser):
                    print(f"{example}: {fault}", file=sys.stderr)
                    failed = True
                if arguments.pictures:
                    arguments.pictures.mkdir(parents=True, exist_ok=True)
                    browser.run("[...document.querySelectorAll('.docblock h2')].find((h) => h.textContent.includes('Equations of motion')).scrollIntoView();")
                    (arguments.pictures / f"rustdoc-{example}-{scheme}.png").write_bytes(browser.picture())
            print(f"{example}: its documentation is {'faulty' if failed else 'set'}", flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
