#!/usr/bin/env python3
"""Instructions of runs with the default guard, relative to those of runs that test for finite states alone; and those of runs of
Taylor's method, relative to what they are without the comparison of rates.

A run is made once and twice; the difference is the count of one. Taylor's method is run with its comparison and without. Needs
valgrind. Prints the tables of docs/design/guards.md and docs/design/narrow-features.md, and ends with a nonzero status if a ratio is above 1.03, or one of the second
table above its limit.

    python3 workshop/benches/guard_instructions.py [word in the names of runs, such as hoop or rk4 ...]
"""

import json
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

LIMIT = 1.03
# What the comparison of rates may cost in percent: three from twenty coordinates on, more where series are short.
CHECKED = {"chain20": 3.0, "hoop": 6.0, "sled": 9.0}


def benchmark() -> str:
    """The program of `cargo bench -p guen-benchmarks --bench guards`."""
    command = ["cargo", "bench", "-p", "guen-benchmarks", "--bench", "guards", "--no-run", "--message-format=json"]
    lines = subprocess.run(command, check=True, capture_output=True, text=True).stdout.splitlines()
    artifacts = (json.loads(line) for line in lines)
    found = [a["executable"] for a in artifacts if a.get("target", {}).get("name") == "guards" and a.get("executable")]
    return found[-1]


def instructions(program: str, *words: str) -> int:
    """The instructions of a run."""
    command = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", program, *words]
    text = subprocess.run(command, check=True, capture_output=True, text=True).stderr
    return int(re.search(r"Collected : (\d+)", text).group(1))


def one(program: str, run: str, guard: str) -> int:
    return instructions(program, run, guard, "2") - instructions(program, run, guard)


def compared(program: str, run: str) -> float:
    """What Taylor's method takes more than without the comparison of rates, in percent."""
    return 100 * (one(program, run, "plain") / one(program, f"{run}-blind", "plain") - 1)


def main() -> None:
    program = benchmark()
    runs = subprocess.run([program, "list"], check=True, capture_output=True, text=True).stdout.split()
    runs = [run for run in runs if not run.endswith("-blind")]
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
    taylor = {system: compared(program, f"{system}:taylor") for system in CHECKED if f"{system}:taylor" in wanted}
    if taylor:
        print(f"\n| comparison of rates | {' | '.join(taylor)} |\n|{' --- |' * (len(taylor) + 1)}")
        print(f"| taylor | {' | '.join(f'{more:.1f} %' for more in taylor.values())} |")
    beyond += [f"{system}: {r:.2f} %, allowed are {CHECKED[system]} %" for system, r in taylor.items() if r > CHECKED[system]]
    sys.exit("\n".join(beyond) or 0)


if __name__ == "__main__":
    main()
