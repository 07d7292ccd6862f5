#!/usr/bin/env python3
"""Makes the pictures of the book and the README that programs draw, and puts them into docs/pictures.

    python3 workshop/book/pictures.py             # runs the examples, a few minutes
    python3 workshop/book/pictures.py --check     # ends with a nonzero status if a picture would change

Drawings are not made by it: they are by hand. A curve of the programs has more points than a page can show; those that are off
by less than a tenth of a point from the line through their neighbours (Ramer, Douglas and Peucker) are left out.
"""

import argparse
import os
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
PICTURES = ROOT / "docs/pictures"
# Where programs leave theirs.
TARGET = ROOT / os.environ.get("CARGO_TARGET_DIR", "target") / "guen"
# The programs' units are tenths of a point.
TOLERANCE = 1.0

FIRST = "cargo test --quiet -p guen-doctests --test blocks first_system"
SCENES = "cargo run --quiet --release -p guen-measure --bin scenes"
# What is drawn: the file in docs/pictures, the file that the program writes, the program.
MADE = [
    ("first-track.svg", TARGET.parent / "tmp/pages/track.svg", FIRST),
    ("scenes-contact.svg", TARGET / "scenes/contact.svg", SCENES),
    *(
        (picture, TARGET / example / f"{file}.svg", f"cargo run --quiet --release --example {example}")
        for picture, example, file in [
            ("hoop-track.svg", "hoop", "track"),
            ("sled-track.svg", "chaplygin_sled", "track"),
            ("example-appell.svg", "appell", "axis"),
            ("example-balancing-robot.svg", "balancing_robot", "balance"),
            ("example-ensemble.svg", "ensemble", "spread"),
            ("example-estimator.svg", "estimator", "track"),
            ("example-identification.svg", "identification", "track"),
            ("example-sled-tracking.svg", "sled_tracking", "path"),
            ("example-spinning-wheel.svg", "spinning_wheel", "speeds"),
            ("example-stick-slip.svg", "stick_slip", "phase"),
            ("example-rocking-block.svg", "rocking_block", "tilt"),
            ("example-billiard-ball.svg", "billiard_ball", "track"),
            ("example-breaking-loose.svg", "breaking_loose", "track"),
            ("example-door-latch.svg", "door_latch", "angle"),
            ("example-walker.svg", "walker", "legs"),
        ]
    ),
]


def simplified(points):
    """The ends, and between them recursively the point that is farthest from their line, if it is far."""
    keep, spans = {0, len(points) - 1}, [(0, len(points) - 1)]
    while spans:
        first, last = spans.pop()
        (ax, ay), (bx, by) = points[first], points[last]
        dx, dy = bx - ax, by - ay
        length = (dx * dx + dy * dy) ** 0.5

        def distance(k):
            x, y = points[k][0] - ax, points[k][1] - ay
            along = (x * dx + y * dy) / length if length else 0.0
            if not 0.0 <= along <= length or not length:
                return min((x * x + y * y) ** 0.5, ((x - dx) ** 2 + (y - dy) ** 2) ** 0.5)
            return abs(x * dy - y * dx) / length

        if last - first > 1:
            far = max(range(first + 1, last), key=distance)
            if distance(far) > TOLERANCE:
                keep.add(far)
                spans += [(first, far), (far, last)]
    return [points[k] for k in sorted(keep)]


def smaller(svg):
    def line(found):
        points = [tuple(map(float, pair.split(","))) for pair in found[1].split()]
        return 'points="' + " ".join(f"{x:g},{y:g}" for x, y in simplified(points)) + '"'

    return re.sub(r'points="([^"]*)"', line, svg)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true", help="write nothing, compare")
    check = parser.parse_args().check
    run, changed = set(), []
    for picture, file, command in MADE:
        if command not in run:
            run.add(command)
            print(f"$ {command}", flush=True)
            subprocess.run(command.split(), cwd=ROOT, check=True, stdout=subprocess.DEVNULL)
        made = smaller(file.read_text())
        target = PICTURES / picture
        if not target.exists() or target.read_text() != made:
            changed.append(picture)
            if not check:
                # Whole or not at all.
                temporary = target.with_suffix(".tmp")
                temporary.write_text(made)
                temporary.replace(target)
        print(f"  {picture}: {len(made)} bytes", flush=True)
    print("changed: " + (", ".join(changed) or "none"))
    if check and changed:
        sys.exit(1)


main()
