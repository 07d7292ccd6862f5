"""Three scenes with contacts: guen beside SciPy, heyoka, Drake and MuJoCo, error against time, in one run.

    python3 -m venv /tmp/contacts && /tmp/contacts/bin/pip install -r workshop/benches/peers/requirements-contacts.txt
    /tmp/contacts/bin/python workshop/benches/peers/contacts.py                   # the table
    /tmp/contacts/bin/python workshop/benches/peers/contacts.py --picture FILE    # and a picture

The scenes are those of `tests/data/hybrid`, whose numbers are right to 30 digits. A peer that is not installed is said so; with none of them
the program ends with 77. Times of runs are the shortest of several, in one thread. Python calls the right-hand sides of SciPy and of Drake, so that their
times say little about their methods; heyoka compiles its own, and MuJoCo has its own. Not part of the tests.
"""

import argparse
import json
import subprocess
import sys
from pathlib import Path

import contacts_picture
from contacts_scenes import SCENES, judged

ROOT = Path(__file__).resolve().parents[3]


def ours():
    """What our program prints, a dictionary a line."""
    command = ["cargo", "run", "--quiet", "--release", "-p", "guen-measure", "--bin", "contacts"]
    text = subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True).stdout
    return [{"tool": "guen", **json.loads(line)} for line in text.splitlines()]


def peers():
    """The runs of every peer, and the versions; peers that are not there are told."""
    runs, versions = [], []
    for name in ("scipy", "heyoka", "drake", "mujoco"):
        try:
            module = __import__(f"contacts_{name}")
        except ImportError as error:
            print(f"{name}: not here ({error})", file=sys.stderr)
            continue
        versions.append(f"{name} {module.VERSION}: {module.METHOD}")
        for run in module.runs():
            runs.append({"tool": name, **run})
    return runs, versions


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--picture", type=Path, help="a file for the picture, as SVG")
    arguments = parser.parse_args()
    theirs, versions = peers()
    if not versions:
        print("none of the peers is installed", file=sys.stderr)
        return 77
    runs = [{**run, **judged(run)} for run in ours() + theirs]
    print("guen: DOP853, the setting is its tolerance", *versions, sep="\n")
    for scene in SCENES:
        print(f"\n{scene}\n| tool | setting | events | largest error of a time | error of the end | time of a run, us |\n| --- | ---: | ---: | ---: | ---: | ---: |")
        for run in (run for run in runs if run["scene"] == scene):
            error = "-" if run["time_error"] is None else f"{run['time_error']:.1e}"
            print(f"| {run['tool']} | {run['setting']:g} | {run['found']} of {run['wanted']} | {error} | {run['end_error']:.1e} | {run['us']:.3g} |")
    if arguments.picture:
        arguments.picture.write_text(contacts_picture.drawn(runs))
    return 0


if __name__ == "__main__":
    sys.exit(main())
