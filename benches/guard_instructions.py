#!/usr/bin/env python3
"""Instructions of runs with the default guard, relative to those of runs that test for finite states alone; and those of runs of
Taylor's method, relative to what they are without the comparison of rates.

A run is made once and twice; the difference is the count of one. What is not inlined is counted by itself: the comparison within a
step, that at its end, and half of the polynomial with its slope there. Needs valgrind. Prints the tables of docs/extremes.md, and
ends with a nonzero status if a ratio is above 1.03, or one of the second table above its limit.

    python3 benches/guard_instructions.py [word in the names of runs, such as hoop or rk4 ...]
"""

import json
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

LIMIT = 1.03
# What the comparison of rates may cost, in whole percent: three from twenty coordinates on, six below.
CHECKED = {"chain20": 1.03, "hoop": 1.06, "sled": 1.06}
# Functions of the comparison, and the part of each that is there for it: of a polynomial with its slope at most half.
PARTS = {"*agrees_inside*": 1.0, "*Defect*is_none*": 1.0, "*change_and_slope*": 0.5}


def benchmark() -> str:
    """The program of `cargo bench -p guen-benchmarks --bench guards`."""
    command = ["cargo", "bench", "-p", "guen-benchmarks", "--bench", "guards", "--no-run", "--message-format=json"]
    lines = subprocess.run(command, check=True, capture_output=True, text=True).stdout.splitlines()
    artifacts = (json.loads(line) for line in lines)
    found = [a["executable"] for a in artifacts if a.get("target", {}).get("name") == "guards" and a.get("executable")]
    return found[-1]


def instructions(program: str, *words: str, within: str = "") -> int:
    """The instructions of a run, or those of one function with all that it calls."""
    options = [f"--toggle-collect={within}"] if within else []
    command = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", *options, program, *words]
    text = subprocess.run(command, check=True, capture_output=True, text=True).stderr
    return int(re.search(r"Collected : (\d+)", text).group(1))


def one(program: str, run: str, guard: str) -> int:
    return instructions(program, run, guard, "2") - instructions(program, run, guard)


def compared(program: str, run: str) -> float:
    """Instructions of Taylor's method relative to those without the comparison of rates."""
    whole = one(program, run, "plain")
    check = sum(part * instructions(program, run, "plain", within=name) for name, part in PARTS.items())
    return whole / (whole - check)


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
    taylor = {system: compared(program, f"{system}:taylor") for system in CHECKED if f"{system}:taylor" in wanted}
    if taylor:
        print(f"\n| comparison of rates | {' | '.join(taylor)} |\n|{' --- |' * (len(taylor) + 1)}")
        print(f"| taylor | {' | '.join(f'{ratio:.4f}' for ratio in taylor.values())} |")
    beyond += [f"{system}: {r:.4f}, allowed are {CHECKED[system]}" for system, r in taylor.items() if round(r, 2) > CHECKED[system]]
    sys.exit("\n".join(beyond) or 0)


if __name__ == "__main__":
    main()
