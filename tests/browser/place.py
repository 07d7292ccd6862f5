"""Where things are: the repository, and the folder that cargo builds in."""

import json
import pathlib
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]


def target():
    """The folder that cargo builds in, wherever the user wants it."""
    command = ["cargo", "metadata", "--format-version", "1", "--no-deps"]
    answer = subprocess.run(command, cwd=ROOT, check=True, capture_output=True).stdout
    return pathlib.Path(json.loads(answer)["target_directory"])
