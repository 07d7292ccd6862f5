#!/usr/bin/env python3
"""Instructions of runs with the default guard, relative to those of runs that test for finite states alone.

A run is made once and twice; the difference is the count of one. Needs valgrind. Prints the table of docs/extremes.md, and
ends with a nonzero status if a ratio is above 1.03.

    python3 benches/guard_instructions.py [word in the names of runs, such as hoop or rk4 ...]
"""

import json
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

LIMIT = 1.03


def benchmark() -> str:
    """The program of `cargo bench -p guen-benchmarks --bench guards`."""
    command = ["cargo", "bench", "-p", "guen-benchmarks", "--bench", "guards", "--no-run", "--message-format=json"]
    lines = subprocess.run(command, check=True, capture_output=True, text=True).stdout.splitlines()
    artifacts = (json.loads(line) for line in lines)
    found = [a["executable"] for a in artifacts if a.get("target", {}).get("name") == "guards" and a.get("executable")]
    return found[-1]


def instructions(program: str, *words: str) -> int:
    command = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", program, *words]
    text = subprocess.run(command, check=True, capture_output=True, text=True).stderr
    return int(re.search(r"Collected : (\d+)", text).group(1))


def one(program: str, run: str, guard: str) -> int:
    return instructions(program, run, guard, "2") - instructions(program, run, guard)


def main() -> None:
    program = benchmark()
    runs = subprocess.run([program, "list"], check=True, capture_output=True, text=True).stdout.split()
    wanted = [run for run in runs if not sys.argv[1:] or any(word in run.split(":") for word in sys.argv[1:])]
    with ThreadPoolExecutor(2) as pool:
        counts = list(pool.map(lambda run: [one(program, run, guard) for guard in ["plain", "guarded"]], wanted))
    ratios = {run: guarded / plain for run, (plain, guarded) in zip(wanted, counts)}
    systems = list(dict.fromkeys(run.split(":")[0] for run in wanted))
    methods = list(dict.fromkeys(run.split(":")[1] for run in wanted))
    print(f"| method | {' | '.join(systems)} |\n|{' --- |' * (len(systems) + 1)}")
    for method in methods:
        cells = [ratios.get(f"{system}:{method}") for system in systems]
        print(f"| {method} | {' | '.join(f'{cell:.4f}' if cell else '' for cell in cells)} |", flush=True)
    beyond = [f"{run}: {ratio:.4f}, allowed are {LIMIT}" for run, ratio in ratios.items() if ratio > LIMIT]
    sys.exit("\n".join(beyond) or 0)


if __name__ == "__main__":
    main()
