#!/usr/bin/env python3
"""Follows pages of the book literally, as a new user would, in an empty folder, and prints the seconds it took.

    python3 workshop/book/chapter.py                               # docs/start/first-system.md
    python3 workshop/book/chapter.py README.md                     # or another page that tells how to begin
    python3 workshop/book/chapter.py docs/start/first-system.md docs/start/accuracy.md    # the second goes on where the first ends

Blocks of `sh` are run in their order; `cd` is kept. A block behind `<!-- file: path -->` is written to that file. Every line of
a block behind `<!-- prints -->` has to be among what the command before it printed. One thing differs from the page: what
`cargo add` takes from a registry comes from this repository, by `--path`. Ends with a nonzero status where a command
fails or a line is missing.
"""

import argparse
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
PATHS = {"guen": ROOT, "guen-study": ROOT / "guen-study"}


def steps(page):
    """Yields ("sh", text), ("file", path, text) and ("prints", text) in the order of the page."""
    marker = None
    block = None
    for line in page.splitlines():
        if block is not None:
            if line.startswith("```"):
                language, text = block[0], "\n".join(block[1:]) + "\n"
                if language == "sh":
                    yield ("sh", text)
                elif marker:
                    yield (*marker, text)
                marker, block = None, None
            else:
                block.append(line)
        elif line.startswith("```"):
            block = [line[3:].strip()]
        elif found := re.fullmatch(r"<!-- (file: (\S+)|prints) -->", line.strip()):
            marker = ("file", found[2]) if found[2] else ("prints",)


def from_here(words):
    """The commands for one line of the page: `cargo add` names folders of the repository."""
    if words[:2] != ["cargo", "add"]:
        return [words]
    names = [word for word in words[2:] if word in PATHS]
    others = [word for word in words[2:] if word not in PATHS]
    return [["cargo", "add", name, "--path", str(PATHS[name]), *others] for name in names]


def run(words, folder, environment):
    print(f"$ {' '.join(words)}", flush=True)
    begin = time.perf_counter()
    done = subprocess.run(words, cwd=folder, env=environment, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    print(f"  {time.perf_counter() - begin:.1f} s", flush=True)
    if done.returncode:
        sys.exit(f"{done.stdout}\n`{' '.join(words)}` ended with status {done.returncode}")
    return done.stdout


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("pages", nargs="*", default=["docs/start/first-system.md"], help="paths from the root of the repository")
    pages = [(ROOT / page).read_text() for page in parser.parse_args().pages]
    environment = {key: value for key, value in os.environ.items() if key not in ("CARGO_TARGET_DIR", "RUSTFLAGS")}
    commands = lines = 0
    with tempfile.TemporaryDirectory(prefix="guen-chapter-") as empty:
        folder, printed = pathlib.Path(empty), ""
        begin = time.perf_counter()
        for kind, *what in (step for page in pages for step in steps(page)):
            if kind == "file":
                (folder / what[0]).write_text(what[1])
            elif kind == "prints":
                for line in filter(None, map(str.strip, what[0].splitlines())):
                    lines += 1
                    if line not in (other.strip() for other in printed.splitlines()):
                        sys.exit(f"{printed}\nthe page says that this is printed, and it is not: {line}")
            else:
                printed = ""
                for words in map(str.split, what[0].splitlines()):
                    if words and words[0] == "cd":
                        folder = folder / words[1]
                    else:
                        for command in from_here(words):
                            commands += 1
                            printed += run(command, folder, environment)
        seconds = time.perf_counter() - begin
    if not commands or not lines:
        sys.exit("nothing could be followed")
    print(f"{commands} commands, {lines} lines as the page has them: {seconds:.0f} s from an empty folder")


main()
