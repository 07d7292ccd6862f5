"""What the scripts that open pages share: failures, and checks that are run one after the other."""

import pathlib
import sys


class Failure(Exception):
    """A page does not do what it has to."""


def require(holds, what):
    if not holds:
        raise Failure(what)


def ended(checks, well):
    """Runs all checks, pairs of a name and a function; says of each what was found. What a script exits with."""
    failed = False
    for name, check in checks:
        try:
            check()
            print(f"{name}: {well}", flush=True)
        except (Failure, RuntimeError) as failure:
            print(f"{name}: {failure}", file=sys.stderr, flush=True)
            failed = True
    return 1 if failed else 0


def kept(folder, name, picture):
    """Keeps a screenshot; does nothing where nobody wants one."""
    if folder:
        pathlib.Path(folder).mkdir(parents=True, exist_ok=True)
        (pathlib.Path(folder) / f"{name}.png").write_bytes(picture())
