"""Our Taylor series against heyoka's on the paper's hoop, ten seconds, timed in one run.

    python3 -m venv /tmp/heyoka && /tmp/heyoka/bin/pip install -r workshop/benches/peers/requirements-heyoka.txt
    /tmp/heyoka/bin/python workshop/benches/peers/taylor_heyoka.py
    /tmp/heyoka/bin/python workshop/benches/peers/taylor_heyoka.py --all      # every setting of both

Both start from the state of the reference in `tests/data` and are judged by their largest error in any entry of the end
state. heyoka compiles for this machine when it runs; ours is compiled with `-C target-cpu=native`, and once more as cargo
does by default. For heyoka the equations are written as a person would who knows the fewest operations (its automatic
simplification works on top), constants as numbers; ours are derived from the declaration, constants given at run time.

A time is the shortest of many runs. Rounds alternate between both sides; a ratio is the median of those of the rounds,
with the least and the largest. Settings: tolerances at every half power of ten, for us with orders 8 to 32 besides
the default; for heyoka, whose order follows from its tolerance, with and without its `high_accuracy`. For each accuracy the
fastest setting that reaches it counts; `default` is our fastest without choosing an order. Not part of the tests.
"""

import json
import os
import statistics
import subprocess
import sys
import time
from pathlib import Path

import heyoka
import numpy

ROOT = Path(__file__).resolve().parents[3]
ACCURACIES = [1e-3, 1e-6, 1e-9, 1e-12]
ROUNDS = 15
RUNS = 60
ORDERS = ["default", *range(8, 33, 2)]


class Server:
    """Our program, which answers line by line."""

    def __init__(self, flags):
        host = next(line.split()[1] for line in output(["rustc", "-vV"]).splitlines() if line.startswith("host"))
        command = ["cargo", "build", "--release", "--target", host, "-p", "guen-measure", "--bin", "taylor", "--message-format=json-render-diagnostics"]
        found = [json.loads(line).get("executable") for line in output(command, cwd=ROOT, env={**os.environ, "RUSTFLAGS": flags}).splitlines()]
        # Kept apart from the next build, which has other flags.
        path = next(path for path in found if path)
        kept = Path(path).with_name("taylor-" + ("native" if flags else "default"))
        kept.write_bytes(Path(path).read_bytes())
        kept.chmod(0o755)
        self.process = subprocess.Popen([str(kept)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def ask(self, request):
        self.process.stdin.write(request + "\n")
        self.process.stdin.flush()
        return self.process.stdout.readline().strip()

    def run(self, setting):
        error, steps, microseconds = self.ask("run {} {}".format(*setting)).split()
        return float(error), int(steps), float(microseconds)


class Heyoka:
    """heyoka on the same problem, an integrator for each setting, compiled once."""

    def __init__(self, constants, begin, end, span):
        self.begin, self.end, self.span, self.integrators = begin, end, span, {}
        self.equations = equations(*constants)

    def run(self, setting):
        tolerance, accurate = setting
        if setting not in self.integrators:
            self.integrators[setting] = heyoka.taylor_adaptive(self.equations, self.begin, tol=tolerance, high_accuracy=accurate)
        integrator, shortest = self.integrators[setting], float("inf")
        for _ in range(RUNS):
            integrator.time = 0.0
            integrator.state[:] = self.begin
            start = time.perf_counter_ns()
            result = integrator.propagate_until(self.span)
            shortest = min(shortest, time.perf_counter_ns() - start)
        return float(numpy.max(numpy.abs(integrator.state - self.end))), result[3], shortest / 1e3


def output(command, **more):
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True, **more).stdout


def equations(a, A, C, g):
    """The hoop's nine rates in the smallest program that we know: 24 operations and two angles."""
    theta, psi, phi, xi, eta, zeta, eta1, eta2, eta3 = heyoka.make_vars("theta", "psi", "phi", "xi", "eta", "zeta", "eta1", "eta2", "eta3")
    sine, cosine = heyoka.sin(theta), heyoka.cos(theta)
    k1, k2, k3, k4, k5 = A / (A + a * a), (C + a * a) / (A + a * a), a * g / (A + a * a), C / A, a * a / (C + a * a)
    w = eta2 / sine
    c, p, v = cosine * w, a * eta1, a * eta3
    u = p * sine
    return [
        (theta, eta1),
        (psi, w),
        (phi, eta3 - c),
        (xi, u * heyoka.sin(psi) - v * heyoka.cos(psi)),
        (eta, -u * heyoka.cos(psi) - v * heyoka.sin(psi)),
        (zeta, p * cosine),
        (eta1, eta2 * (k1 * c - k2 * eta3) - k3 * cosine),
        (eta2, eta1 * (k4 * eta3 - c)),
        (eta3, k5 * eta1 * eta2),
    ]


def fastest(results, accuracy):
    """The setting that reaches an accuracy in the least time; none if no one does."""
    reached = [(microseconds, setting) for setting, (error, _, microseconds) in results.items() if error <= accuracy]
    return min(reached, key=lambda pair: pair[0])[1] if reached else None


def compare(name, ours, theirs, setting, peer):
    """A line for two settings, timed in turn."""
    found, known = [], []
    for number in range(ROUNDS):
        if number % 2:
            found.append(ours.run(setting))
            known.append(theirs.run(peer))
        else:
            known.append(theirs.run(peer))
            found.append(ours.run(setting))
    ratios = sorted(f[2] / k[2] for f, k in zip(found, known))
    shortest = lambda runs: min(run[2] for run in runs)
    print(
        f"{name:10} | {setting[0]:7} {setting[1]:>7} {found[0][0]:8.1e} {found[0][1]:5} {shortest(found):7.1f} |"
        f" {peer[0]:8.1e} {'high' if peer[1] else '':4} {known[0][0]:8.1e} {known[0][1]:5} {shortest(known):7.1f} |"
        f" {statistics.median(ratios):5.2f} [{ratios[0]:.2f}, {ratios[-1]:.2f}]"
    )


def main():
    os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})
    sides = {"native": Server("-C target-cpu=native"), "default": Server("")}
    problem = [float(word) for word in sides["native"].ask("problem").split()]
    constants, span, begin, end = problem[:4], problem[4], numpy.array(problem[5:14]), numpy.array(problem[14:])
    theirs = Heyoka(constants, begin, end, span)
    tolerances = [10 ** (-k / 2) for k in range(6, 33)]
    settings = [(f"{tolerance:.1e}", order) for tolerance in tolerances for order in ORDERS if order == "default" or order >= 14 or tolerance > 1e-9]
    results = {setting: sides["native"].run(setting) for setting in settings}
    peers = {setting: theirs.run(setting) for setting in [(tolerance, accurate) for tolerance in tolerances for accurate in (False, True)]}
    print(sides["native"].ask("conditions").replace(";", "\n"))
    print(f"heyoka           {heyoka.__version__}, shortest of {RUNS} runs in each of {ROUNDS} rounds, as ours of 101\n")
    if "--all" in sys.argv:
        for setting, (error, steps, microseconds) in [*results.items(), *peers.items()]:
            print(f"{setting!s:24} {error:8.1e} {steps:5} {microseconds:8.1f}")
    print(f"{'':10} | {'guen':38} | {'heyoka':37} |")
    print(f"{'build':10} | {'tol':7} {'order':>7} {'error':>8} {'steps':>5} {'us':>7} | {'tol':>8} {'':4} {'error':>8} {'steps':>5} {'us':>7} | guen / heyoka")
    limit = min(error for error, _, _ in peers.values())
    for accuracy in [*ACCURACIES, limit]:
        peer = fastest(peers, accuracy)
        default = fastest({setting: result for setting, result in results.items() if setting[1] == "default"}, accuracy)
        print(f"error at most {accuracy:.1e}" + (", the least that heyoka reaches" if accuracy == limit else ""))
        for build, ours in sides.items():
            for setting in dict.fromkeys([fastest(results, accuracy), default]):
                if setting and peer:
                    compare(build, ours, theirs, setting, peer)


if __name__ == "__main__":
    main()
