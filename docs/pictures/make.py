#!/usr/bin/env python3
"""Makes the screenshots of this folder anew, in a headless browser; see tests/browser.

    python3 docs/pictures/make.py

The drawings (*.svg) are made by hand or by examples, as the pages that show them say.
"""

import pathlib
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
SCRIPTS = HERE.parents[1] / "tests/browser"

PICTURES = ["viewer-hoop-light.png", "viewer-robot-light.png", "viewer-car-dark.png", "rustdoc-hoop-light.png"]

# Pictures are in the history for ever.
LARGEST = 150_000


def main():
    with tempfile.TemporaryDirectory() as folder:
        for script in ("viewer.py", "rustdoc.py"):
            done = subprocess.run([sys.executable, SCRIPTS / script, "--pictures", folder], check=False)
            if done.returncode != 0:
                return done.returncode
        for name in PICTURES:
            made = pathlib.Path(folder) / name
            size = made.stat().st_size
            if size > LARGEST:
                print(f"{name} has {size} bytes, more than {LARGEST}", file=sys.stderr)
                return 1
            shutil.copyfile(made, HERE / name)
            print(f"{name}: {size} bytes")
    return 0


if __name__ == "__main__":
    sys.exit(main())
