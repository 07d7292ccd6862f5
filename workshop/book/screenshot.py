#!/usr/bin/env python3
"""Photographs pages of the built book in a headless Chromium.

    python3 workshop/book/screenshot.py                               # the picture of the README: docs/pictures/book.png
    python3 workshop/book/screenshot.py target/shots                  # every page, light and dark, to be looked at

Needs `chromium` (or CHROMIUM, its path), and the book: cargo run --manifest-path workshop/book/Cargo.toml. Nothing is fetched.
"""

import argparse
import os
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
BOOK = pathlib.Path(os.environ.get("CARGO_TARGET_DIR") or ROOT / "target").absolute() / "book"
QUIET = [
    "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
    "--disable-component-update", "--disable-sync", "--hide-scrollbars",
]


def photograph(page, picture, width, height, dark=False):
    with tempfile.TemporaryDirectory() as profile:
        command = [
            os.environ.get("CHROMIUM", "chromium"), *QUIET,
            # The book follows the reader's preference of light or dark.
            *(["--blink-settings=preferredColorScheme=0"] if dark else []),
            f"--window-size={width},{height}", f"--user-data-dir={profile}", f"--screenshot={picture}", page.as_uri(),
        ]
        subprocess.run(command, check=True, timeout=120, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", nargs="?", type=pathlib.Path, help="photograph every page into this folder")
    folder = parser.parse_args().folder
    if not (BOOK / "index.html").exists():
        sys.exit("there is no book: cargo run --manifest-path workshop/book/Cargo.toml")
    if not folder:
        picture = ROOT / "docs/pictures/book.png"
        photograph(BOOK / "index.html", picture, 1120, 640)
        print(f"{picture}: {picture.stat().st_size} bytes")
        return
    folder.mkdir(parents=True, exist_ok=True)
    for page in sorted(BOOK.rglob("*.html")):
        name = "-".join(page.relative_to(BOOK).with_suffix("").parts)
        if name in ("404", "print", "toc"):
            continue
        for dark in (False, True):
            photograph(page, (folder / f"{name}{'-dark' * dark}.png").resolve(), 1250, 1400, dark)
        print(name, flush=True)


main()
