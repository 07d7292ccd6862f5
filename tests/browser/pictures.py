#!/usr/bin/env python3
"""Makes the screenshots of docs/pictures anew that show the viewer and rustdoc, in a headless browser.

    python3 tests/browser/pictures.py          # all
    python3 tests/browser/pictures.py looks.py # those that one script makes
"""

import pathlib
import shutil
import subprocess
import sys
import tempfile

SCRIPTS = pathlib.Path(__file__).resolve().parent
PICTURED = SCRIPTS.parents[1] / "docs/pictures"

LOOKS = [f"looks-turntable-{look}-{width}.png" for look in ("light", "dark", "forced", "paper") for width in (1600, 800, 390)]
PICTURES = {
    "viewer.py": ["viewer-hoop-light.png", "viewer-robot-light.png", "viewer-car-dark.png", "viewer-block-light.png"],
    "rustdoc.py": ["rustdoc-hoop-light.png"],
    "looks.py": [*LOOKS, "looks-scriptless-car-light-800.png", "looks-scriptless-car-dark-800.png"],
}

# Pictures are in the history for ever.
LARGEST = 150_000


# All of them together: 3 MB.
ALL = 3_000_000


def main():
    wanted = sys.argv[1:] or list(PICTURES)
    with tempfile.TemporaryDirectory() as folder:
        for script in wanted:
            done = subprocess.run([sys.executable, SCRIPTS / script, "--pictures", folder], check=False)
            if done.returncode != 0:
                return done.returncode
        for name in (name for script in wanted for name in PICTURES[script]):
            made = pathlib.Path(folder) / name
            size = made.stat().st_size
            if size > LARGEST:
                print(f"{name} has {size} bytes, more than {LARGEST}", file=sys.stderr)
                return 1
            shutil.copyfile(made, PICTURED / name)
            print(f"{name}: {size} bytes")
    size = sum(path.stat().st_size for path in PICTURED.iterdir())
    if size > ALL:
        print(f"all pictures have {size} bytes, more than {ALL}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
