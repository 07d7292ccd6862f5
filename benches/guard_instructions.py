#!/usr/bin/env python3
"""Instructions of runs with the default guard, relative to those of runs that test for finite states alone.

Needs valgrind. Ends with a nonzero status if a ratio is above 1.03.

    python3 benches/guard_instructions.py
"""

import json
import re
import subprocess
import sys

LIMIT = 1.03
METHODS = ["euler", "rk4", "rk8", "gauss4", "gauss6", "tsit5", "dop853", "radau5"]


def benchmark() -> str:
    """The program of `cargo bench --bench guards`."""
    command = ["cargo", "bench", "--bench", "guards", "--no-run", "--message-format=json"]
    lines = subprocess.run(command, check=True, capture_output=True, text=True).stdout.splitlines()
    artifacts = (json.loads(line) for line in lines)
    found = [a["executable"] for a in artifacts if a.get("target", {}).get("name") == "guards" and a.get("executable")]
    return found[-1]


def instructions(program: str, run: str, guard: str) -> int:
    command = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", program, run, guard]
    text = subprocess.run(command, check=True, capture_output=True, text=True).stderr
    return int(re.search(r"Collected : (\d+)", text).group(1))


def main() -> None:
    program = benchmark()
    # What a program does that makes no run: it is part of every count.
    idle = instructions(program, "none", "plain")
    worst = 0.0
    print(f"{'run':16} {'instructions':>14} {'guarded to plain':>18}")
    for system in ["hoop", "chain5"]:
        for method in METHODS:
            run = f"{system}:{method}"
            plain, guarded = (instructions(program, run, guard) - idle for guard in ["plain", "guarded"])
            worst = max(worst, guarded / plain)
            print(f"{run:16} {plain:14,} {guarded / plain:18.4f}")
    sys.exit(0 if worst <= LIMIT else 1)


if __name__ == "__main__":
    main()
