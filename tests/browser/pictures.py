#!/usr/bin/env python3
"""Makes the screenshots of docs/pictures anew that show the viewer and rustdoc, in a headless browser.

    python3 tests/browser/pictures.py
"""

import pathlib
import shutil
import subprocess
import sys
import tempfile

SCRIPTS = pathlib.Path(__file__).resolve().parent
PICTURED = SCRIPTS.parents[1] / "docs/pictures"

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
            shutil.copyfile(made, PICTURED / name)
            print(f"{name}: {size} bytes")
    return 0


if __name__ == "__main__":
    sys.exit(main())
