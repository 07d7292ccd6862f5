"""Our right-hand sides against C that SymPy and CasADi generate for the same systems, timed in one run.

    python3 -m venv /tmp/peers && /tmp/peers/bin/pip install -r workshop/benches/peers/requirements.txt
    /tmp/peers/bin/python workshop/benches/peers/compare.py                # all systems
    /tmp/peers/bin/python workshop/benches/peers/compare.py hoop chain5    # some of them

Both sides are compiled for this machine. Long-lived processes time one batch after the other on the same processor; in
every round each program has one batch, in another order each time, and the ratios are taken within the rounds. Not
part of the tests. Needs gcc and cargo besides.
"""

import json
import os
import random
import subprocess
import sys
import tempfile
from pathlib import Path

import with_casadi
import with_sympy

ROOT = Path(__file__).resolve().parents[3]
ROUNDS = 31
PEERS = {"sympy": with_sympy, "casadi": with_casadi}
FLAGS = {"O3": ["-O3", "-march=native"], "fast": ["-O3", "-march=native", "-ffast-math"]}


def main():
    wanted = sys.argv[1:]
    processor = min(os.sched_getaffinity(0))
    with tempfile.TemporaryDirectory() as folder:
        ours = Server(built_by_cargo(), processor)
        systems = [describe(line) for line in ours.ask("list").split(";")]
        systems = [s for s in systems if s[0] in with_sympy.MODELS and (not wanted or s[0] in wanted)]
        operations = generate(systems, Path(folder))
        peers = {flag: Server(compiled(Path(folder), flag), processor) for flag in FLAGS}
        print(ours.ask("conditions").replace(";", "\n"))
        print("c compiler      ", run(["gcc", "--version"]).splitlines()[0] + ";", "; ".join(" ".join(f) for f in FLAGS.values()))
        print(f"{ROUNDS} rounds; nanoseconds are the shortest; ratios are declared / peer, medians with their 95 percent interval")
        print("`glibc`: the declared system with the sines of the platform's C library, as the peers have them\n")
        print(f"{'':39}{'throughput':^48}   {'latency':^48}")
        columns = f"{'ns':>7} {'default':>21} {'glibc':>19}"
        print(f"{'system':12}{'program':20}{'ops':>5}   {columns}   {columns}")
        for name, size, operations_of_ours, constants in systems:
            compare(name, size, operations_of_ours, constants, ours, peers, operations, Path(folder))


def run(command, **more):
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True, **more).stdout


def built_by_cargo():
    """The program that times the declared systems, for this processor and not for the oldest one."""
    host = next(line.split()[1] for line in run(["rustc", "-vV"]).splitlines() if line.startswith("host"))
    command = ["cargo", "build", "--release", "--target", host, "-p", "guen-measure", "--bin", "serve", "--message-format=json-render-diagnostics"]
    environment = {**os.environ, "RUSTFLAGS": "-C target-cpu=native"}
    output = subprocess.run(command, cwd=ROOT, env=environment, check=True, stdout=subprocess.PIPE, text=True).stdout
    found = [json.loads(line).get("executable") for line in output.splitlines()]
    return next(path for path in found if path)


def describe(line):
    name, size, operations, *constants = line.split()
    pairs = [constant.split("=") for constant in constants]
    return name, int(size), int(operations), [(n, tuple(int(part) for part in value.split("/"))) for n, value in pairs]


def generate(systems, folder):
    """Writes `generated.c` and returns how many operations each program has."""
    texts, table, operations = [], [], {}
    for name, size, _, constants in systems:
        for peer, module in PEERS.items():
            for fixed in (True, False):
                program = f"{peer}_{'fixed' if fixed else 'free'}"
                print(f"generating {name} {program}", file=sys.stderr)
                text, count = module.c_function(name, program, constants, fixed)
                texts.append(text)
                operations[name, program] = count
                table.append(f'    {{"{name}", "{program}", {size}, {name}_{program}}},')
    texts.append("static const struct { const char *system, *program; int size; rates_fn rates; } PROGRAMS[] = {")
    (folder / "generated.c").write_text("\n".join([*texts, *table, "    {0, 0, 0, 0},\n};\n"]))
    return operations


def compiled(folder, flag):
    target = folder / f"peers_{flag}"
    run(["gcc", "-std=gnu11", *FLAGS[flag], f"-I{folder}", str(ROOT / "workshop/benches/peers/harness.c"), "-o", str(target), "-lm"])
    return str(target)


class Server:
    """A process that answers a line with a line."""

    def __init__(self, command, processor):
        pinned = lambda: os.sched_setaffinity(0, {processor})
        self.process = subprocess.Popen([command], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, preexec_fn=pinned)

    def ask(self, line):
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()
        return self.process.stdout.readline().strip()


def compare(name, size, operations_of_ours, constants, ours, peers, operations, folder):
    states = folder / f"{name}.states"
    ours.ask(f"states {name} {states}")
    for server in peers.values():
        server.ask(f"load {name} {states} " + " ".join((n / d).hex() for _, (n, d) in constants))
    contenders = {("ours", "default"): ours, ("ours", "glibc"): ours}
    for program in [p for s, p in operations if s == name]:
        for flag, server in peers.items():
            agree(name, program, size, ours, server)
            contenders[program, flag] = server
    order = list(contenders)
    results = {}
    for mode in ("throughput", "latency"):
        times = {contender: [] for contender in order}
        for _ in range(ROUNDS):
            random.shuffle(order)
            for program, variant in order:
                wanted = variant if program == "ours" else program
                times[program, variant].append(float(contenders[program, variant].ask(f"time {name} {wanted} {mode}")))
        results[mode] = times
    for variant in ("default", "glibc"):
        best = "   ".join(f"{min(results[mode]['ours', variant]):7.2f}{'':41}" for mode in results)
        print(f"{name:12}{'declared, ' + variant:20}{operations_of_ours:5}   {best}".rstrip())
    for program, flag in sorted(c for c in contenders if c[0] != "ours"):
        cells = []
        for times in results.values():
            own = times[program, flag]
            ratios = [cell([a / b for a, b in zip(times["ours", variant], own)]) for variant in ("default", "glibc")]
            cells.append(f"{min(own):7.2f} {ratios[0]:>20} {ratios[1]:>20}")
        print(f"{'':12}{program + ' ' + flag:20}{operations[name, program]:5}   {'   '.join(cells)}", flush=True)


def cell(ratios):
    """Median, and the interval between the order statistics that leave out 2.5 percent on either side."""
    ratios.sort()
    n = len(ratios)
    probability = cumulated = 0.5**n
    out = 0
    while out + 1 < n // 2:
        probability *= (n - out) / (out + 1)
        if cumulated + probability > 0.025:
            break
        cumulated += probability
        out += 1
    return f"{ratios[n // 2]:.3f} [{ratios[out]:.3f}, {ratios[n - 1 - out]:.3f}]"


def agree(name, program, size, ours, server):
    """What is faster but another system is no peer."""
    for index in (0, 1, 2, 500):
        expected = [float(x) for x in ours.ask(f"rates {name} default {index}").split()]
        found = [float(x) for x in server.ask(f"rates {name} {program} {index}").split()]
        scale = max(abs(x) for x in expected)
        worst = max(abs(a - b) for a, b in zip(expected, found, strict=True))
        if not worst <= 1e-8 * scale:
            sys.exit(f"{name}: {program} differs from ours by {worst:g} of {scale:g}:\n{expected}\n{found}")


if __name__ == "__main__":
    main()
