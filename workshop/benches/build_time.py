#!/usr/bin/env python3
"""What a new project pays for guen: packages compiled and seconds, beside those of nalgebra alone.

    python3 workshop/benches/build_time.py                # one build of each
    python3 workshop/benches/build_time.py --repeats 3    # the least of three, taken in turn
    python3 workshop/benches/build_time.py --optimised    # instead: macros built with optimisation, and what a changed file waits for

Every build begins with an empty target folder; sources are fetched before and not counted. The projects with guen declare the hoop of the
README and integrate it. With `--optimised` they declare the bicycle of the tests, and the second build, after the file was touched, expands
it again. `processor` adds up the seconds of all cores and depends less on what else the machine does.
"""

import argparse
import json
import os
import pathlib
import re
import resource
import shutil
import subprocess
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
GUEN = f'guen = {{ path = "{ROOT}"'
STUDY = f'guen-study = {{ path = "{ROOT}/guen-study" }}'
PROJECTS = {
    "nalgebra alone": ('nalgebra = "0.35"', False),
    "guen": (GUEN + " }", True),
    "guen without its features": (GUEN + ", default-features = false }", True),
    "guen and guen-study": (GUEN + " }\n" + STUDY, True),
}
ENVIRONMENT = {key: value for key, value in os.environ.items() if key not in ("CARGO_TARGET_DIR", "RUSTFLAGS")}
PLAIN = "fn main() {}\n"


def declaration():
    """The hoop of the README."""
    return re.search(r"```rust\n(.*?)```", (ROOT / "README.md").read_text(), re.S)[1]


def build(folder, options):
    """Packages compiled, wall seconds, processor seconds."""
    before, begin = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    command = ["cargo", "build", "--offline", "--message-format", "json", *options]
    done = subprocess.run(command, cwd=folder, env=ENVIRONMENT, check=True, text=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    wall, after = time.perf_counter() - begin, resource.getrusage(resource.RUSAGE_CHILDREN)
    lines = [json.loads(line) for line in done.stdout.splitlines()]
    fresh = {line["package_id"] for line in lines if line["reason"] == "compiler-artifact" and not line["fresh"]}
    return len(fresh) - 1, wall, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def prepare(folder, dependencies, declares):
    (folder / "src").mkdir(parents=True)
    manifest = f'[package]\nname = "new"\nversion = "0.1.0"\nedition = "2024"\n[workspace]\n[dependencies]\n{dependencies}\n'
    (folder / "Cargo.toml").write_text(manifest)
    (folder / "src/main.rs").write_text(declaration() if declares else PLAIN)
    subprocess.run(["cargo", "fetch", "--quiet"], cwd=folder, env=ENVIRONMENT, check=True)


def measure(folder, options):
    shutil.rmtree(folder / "target", ignore_errors=True)
    return build(folder, options)


def bicycle():
    """The largest declaration of the tests, as a program."""
    text = (ROOT / "tests/spatial/bicycle.rs").read_text()
    return text[text.index("guen::mechanical_system!") :].partition("\n}\n")[0] + "\n}\n" + PLAIN


def optimised():
    """Builds with each level of the macro's optimisation: from nothing, and after a change of the own file."""
    print(f"| build-override | first build | processor | changed file | processor |\n{'| --- ' * 5}|")
    for level in range(4):
        with tempfile.TemporaryDirectory(prefix="guen-build-") as place:
            folder = pathlib.Path(place) / "new"
            prepare(folder, PROJECTS["guen"][0], True)
            (folder / "src/main.rs").write_text(bicycle())
            options = ["--config", f"profile.dev.build-override.opt-level={level}"]
            _, first, work = build(folder, options)
            (folder / "src/main.rs").touch()
            _, again, less = build(folder, options)
        print(f"| `opt-level = {level}` | {first:.0f} s | {work:.0f} s | {again:.1f} s | {less:.1f} s |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--repeats", type=int, default=1)
    parser.add_argument("--optimised", action="store_true")
    arguments = parser.parse_args()
    if arguments.optimised:
        optimised()
        return
    repeats = arguments.repeats
    with tempfile.TemporaryDirectory(prefix="guen-build-") as empty:
        folders = {}
        for name, (dependencies, declares) in PROJECTS.items():
            folders[name] = pathlib.Path(empty) / name.replace(" ", "-")
            prepare(folders[name], dependencies, declares)
        found = {}
        for _ in range(repeats):
            for options in ([], ["--release"]):
                for name, folder in folders.items():
                    found.setdefault((name, *options), []).append(measure(folder, options))
                    print(".", end="", flush=True)
    print(f"\n\n| a new project with | profile | packages | seconds | processor |\n{'| --- ' * 5}|")
    for (name, *options), runs in found.items():
        packages, wall, processor = (min(run[k] for run in runs) for k in range(3))
        profile = "release" if options else "dev"
        print(f"| {name} | {profile} | {packages} | {wall:.0f} | {processor:.0f} |")


main()
