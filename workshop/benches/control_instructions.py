#!/usr/bin/env python3
"""Instructions of one control period of the balancing robot, for 10,000 random states one by one.

Needs valgrind. Callgrind writes a profile whenever the function returns; its total is the instructions of that call.
Ends with a nonzero status unless all totals are the same.

    python3 workshop/benches/control_instructions.py [states]
"""

import collections
import json
import pathlib
import re
import subprocess
import sys
import tempfile

FUNCTION = "control_period"


def benchmark() -> str:
    """The program of `cargo bench -p guen-benchmarks --bench control`."""
    command = ["cargo", "bench", "-p", "guen-benchmarks", "--bench", "control", "--no-run", "--message-format=json"]
    lines = subprocess.run(command, check=True, capture_output=True, text=True).stdout.splitlines()
    artifacts = (json.loads(line) for line in lines)
    found = [a["executable"] for a in artifacts if a.get("target", {}).get("name") == "control" and a.get("executable")]
    return found[-1]


def symbol(program: str) -> str:
    """The function's name in the program, which carries a hash."""
    names = subprocess.run(["nm", program], check=True, capture_output=True, text=True).stdout
    found = [line.split()[-1] for line in names.splitlines() if FUNCTION in line]
    if not found:
        sys.exit(f"{FUNCTION} is not in {program}")
    return found[0]


def main() -> None:
    states = int(sys.argv[1]) if len(sys.argv) > 1 else 10_000
    program = benchmark()
    name = symbol(program)
    counts: collections.Counter[int] = collections.Counter()
    with tempfile.TemporaryDirectory() as folder:
        place = pathlib.Path(folder)
        command = ["valgrind", "--tool=callgrind", "--demangle=no", f"--toggle-collect={name}", f"--dump-after={name}"]
        command += [f"--callgrind-out-file={place}/out", program, "--periods", str(states)]
        subprocess.run(command, check=True, capture_output=True)
        for path in place.iterdir():
            total = re.search(r"^(?:totals|summary): (\d+)", path.read_text(), re.MULTILINE)
            if total and int(total[1]) > 0:
                counts[int(total[1])] += 1
    if sum(counts.values()) != states:
        sys.exit(f"{sum(counts.values())} calls were counted, and {states} made")
    for count, calls in sorted(counts.items()):
        print(f"{count} instructions in {calls} states")
    if len(counts) > 1:
        sys.exit("the number of instructions depends on the state")


main()
