"""Our right-hand sides of robots against Pinocchio's articulated body algorithm, and of the bicycle against CasADi, timed in one run.

    python3 -m venv /tmp/peers && /tmp/peers/bin/pip install -r workshop/benches/peers/requirements-bodies.txt
    /tmp/peers/bin/python workshop/benches/peers/bodies.py              # ours compiled for this machine, as the peers are
    /tmp/peers/bin/python workshop/benches/peers/bodies.py --default    # ours as cargo builds by default

A quadruped with 12 joints and a humanoid with 24 float freely, ours posed by three angles, Pinocchio's by a quaternion. Every
body has a mass, a centre and an inertia of its own, drawn by a fixed seed; both sides have these at run time. Places of joints
are numbers in our declaration and data for Pinocchio. Ours computes the rates of all coordinates besides, Pinocchio the
accelerations alone. Pinocchio is compiled with both of its conventions, with and without the instructions of this machine.
The bicycle for CasADi is in `bicycle_casadi.py`: two formulations by hand, each compiled with and without `-ffast-math`.

All programs are shared libraries in one process, which times them in turn over 256 states, after they have agreed. A ratio is
ours / peer, the median of those of the rounds with a 95 percent interval. Not part of the tests. Needs gcc and cargo besides;
Pinocchio's templates take some minutes to compile.
"""

import json
import math
import os
import random
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

import casadi as ca

import bicycle_casadi

HERE = Path(__file__).resolve().parent
ROUNDS = 41
STATES = 256
NATIVE = ["-march=native"]
# Carrier, axis, place of the joint in the carrier.
LEG = lambda x, y, first: [(0, "x", (x, y, 0)), (first, "y", (0, 0.1 if y > 0 else -0.1, 0)), (first + 1, "y", (0, 0, -0.4))]
QUADRUPED = LEG(0.4, 0.2, 1) + LEG(0.4, -0.2, 4) + LEG(-0.4, 0.2, 7) + LEG(-0.4, -0.2, 10)


def humanoid():
    """Two legs of six joints, a waist of two, two arms of four, a head of two."""
    links = []
    for side in (1, -1):
        k = len(links) + 1
        links += [(0, "z", (0, side * 0.1, -0.15)), (k, "x", (0, 0, 0)), (k + 1, "y", (0, 0, 0)), (k + 2, "y", (0, 0, -0.4))]
        links += [(k + 3, "y", (0, 0, -0.4)), (k + 4, "x", (0, 0, 0))]
    torso = len(links) + 2
    links += [(0, "z", (0, 0, 0.15)), (torso - 1, "y", (0, 0, 0.1))]
    for side in (1, -1):
        k = len(links) + 1
        links += [(torso, "y", (0, side * 0.2, 0.3)), (k, "x", (0, 0, 0)), (k + 1, "z", (0, 0, 0)), (k + 2, "y", (0, 0, -0.3))]
    k = len(links) + 1
    return links + [(torso, "z", (0, 0, 0.4)), (k, "y", (0, 0, 0.1))]


def table(links, draw):
    """The lines that both sides read."""
    lines = []
    for carrier, axis, place in [(0, "-", (0, 0, 0)), *links]:
        mass = draw.uniform(0.5, 5)
        # Moments of points of a box, so that there is such a body.
        points = [[draw.uniform(-0.2, 0.2) for _ in range(3)] for _ in range(8)]
        second = lambda i, j: mass / 8 * sum(p[i] * p[j] for p in points)
        xx, yy, zz = second(1, 1) + second(2, 2), second(0, 0) + second(2, 2), second(0, 0) + second(1, 1)
        inertia = [xx, yy, zz, -second(0, 1), -second(1, 2), -second(0, 2)]
        center = [draw.uniform(-0.1, 0.1) for _ in range(3)]
        lines.append(" ".join([str(carrier), axis, *map(repr, place), *(f"{x:.17g}" for x in [mass, *inertia, *center])]))
    return "\n".join(lines) + "\n"


def state_of_robot(joints, draw):
    """The state for us, with angles, and for Pinocchio, with a quaternion: both have the velocities of the base in its own axes."""
    place, angles, moving = ([draw.uniform(-1, 1) for _ in range(n)] for n in (3, 3, joints))
    velocities = [draw.uniform(-1, 1) for _ in range(6 + joints)]
    (sy, sp, sr), (cy, cp, cr) = ([f(angle / 2) for angle in angles] for f in (math.sin, math.cos))
    x, y = cy * cp * sr - sy * sp * cr, cy * sp * cr + sy * cp * sr
    z, w = sy * cp * cr - cy * sp * sr, cy * cp * cr + sy * sp * sr
    return place + angles + moving + velocities, place + [x, y, z, w] + moving + velocities


def state_of_bicycle(draw):
    return [draw.uniform(-0.3, 0.3) for _ in range(10)] + [draw.uniform(-20, -5)]


def run(command, **more):
    return subprocess.run([str(word) for word in command], check=True, stdout=subprocess.PIPE, text=True, **more).stdout


def ours(folder, native):
    """The library of the declared systems."""
    host = next(line.split()[1] for line in run(["rustc", "-vV"]).splitlines() if line.startswith("host"))
    environment = {**os.environ, "ROBOTS": str(folder), "RUSTFLAGS": "-C target-cpu=native" if native else ""}
    command = ["cargo", "build", "--release", "--target", host, "--message-format=json-render-diagnostics"]
    found = [json.loads(line) for line in run(command, cwd=HERE / "bodies", env=environment).splitlines()]
    return next(name for item in found if item.get("target", {}).get("name") == "guen_peers_bodies" for name in item.get("filenames", []))


def pinocchio(folder):
    """Its libraries: with the instructions of this machine, and without."""
    prefix = Path(ca.__file__).parents[1] / "cmeel.prefix"
    # Its variant of joints is longer than lists of boost are by default.
    defines = [f'-DROBOTS="{folder}"', "-DNDEBUG", "-DBOOST_MPL_LIMIT_LIST_SIZE=30", "-DBOOST_MPL_CFG_NO_PREPROCESSED_HEADERS"]
    include = [f"-I{prefix}/include", f"-I{prefix}/include/eigen3"]
    link = [f"-L{prefix}/lib", "-lpinocchio_default", f"-Wl,-rpath,{prefix}/lib"]
    libraries = {}
    for name, flags in (("native", NATIVE), ("default", [])):
        libraries[name] = folder / f"pinocchio_{name}.so"
        source = HERE / "with_pinocchio.cpp"
        run(["g++", "-std=c++17", "-O3", "-w", *flags, *defines, *include, "-shared", "-fPIC", source, "-o", libraries[name], *link])
    return libraries


def casadi(folder):
    """Libraries of both formulations with and without `-ffast-math`, and how many operations each has."""
    libraries = {}
    for held in (False, True):
        q, u, out = bicycle_casadi.rates(held)
        function = ca.Function("generated", [ca.vertcat(q, u)], [out])
        here = os.getcwd()
        os.chdir(folder)
        function.generate("generated.c", {"with_header": False})
        os.chdir(here)
        text = (folder / "generated.c").read_text()
        # The arithmetic alone: CasADi's own wrapper passes pointers through a table.
        text += "\nvoid bicycle(const double *state, double *rates) {\n"
        text += "    const double *arg[1] = {state};\n    double *res[1] = {rates};\n    casadi_f0(arg, res, 0, 0, 0);\n}\n"
        name = "rates held" if held else "through the solution"
        (folder / "generated.c").write_text(text)
        for math in ([], ["-ffast-math"]):
            library = folder / f"casadi_{held}_{len(math)}.so"
            run(["gcc", "-O3", *NATIVE, *math, "-shared", "-fPIC", folder / "generated.c", "-o", library, "-lm"])
            title = f"CasADi, {name}, {function.n_instructions()} instructions{', fast-math' if math else ''}"
            libraries[title] = (library, "bicycle")
    return libraries


def written(path, states):
    """States in binary, and how many numbers each has."""
    path.write_bytes(b"".join(struct.pack(f"{len(state)}d", *state) for state in states))
    return path, len(states[0])


def compare(title, folder, own, peers, common):
    """Prints a line for each peer, with the ratios of our programs to it. A program is a library, a function, states and their size; `common` are as many of the last
    rates as both sides have."""
    programs = [*own.values(), *peers.values()]
    lines = run([folder / "clock", ROUNDS, *(word for program in programs for word in program)]).splitlines()
    rates = [[float.fromhex(word) for word in line.split()][-common:] for line in lines[: len(programs)]]
    for name, found in zip([*own, *peers], rates):
        scale = max(map(abs, rates[0]))
        worst = max(abs(a - b) for a, b in zip(rates[0], found)) / scale
        if not worst < 1e-9:
            sys.exit(f"{title}: {name} differs by {worst:.1e} of the largest rate")
    times = [[float(word) for word in line.split()] for line in lines[len(programs) :]]
    for k, name in enumerate([*own, *peers]):
        line = f"{title if k == 0 else '':12}{name:60}{min(row[k] for row in times):9.1f} ns"
        for j in range(len(own) if k >= len(own) else 0):
            ratios = sorted(row[j] / row[k] for row in times)
            # Order statistics that hold the median with 95 percent.
            line += f"   {ratios[ROUNDS // 2]:.3f} [{ratios[13]:.3f}, {ratios[27]:.3f}]"
        print(line)


def main():
    draw = random.Random(1)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        robots = {"quadruped": QUADRUPED, "humanoid": humanoid()}
        for robot, links in robots.items():
            (folder / f"{robot}.robot").write_text(table(links, draw))
        run(["gcc", "-O2", HERE / "bodies.c", "-o", folder / "clock", "-ldl"])
        library = ours(folder, "--default" not in sys.argv)
        declared = lambda system, states: {
            title: (library, system + ending, *states) for title, ending in (("declared", ""), ("declared, over Fused", "_fused"))
        }
        peers = {
            f"Pinocchio, {convention}, {flags}": (built, convention)
            for flags, built in pinocchio(folder).items()
            for convention in ("local", "world")
        }
        states = written(folder / "bicycle.states", [state_of_bicycle(draw) for _ in range(STATES)])
        theirs = {title: (*program, *states) for title, program in casadi(folder).items()}
        compare("bicycle", folder, declared("bicycle", states), theirs, states[1])
        for robot, links in robots.items():
            pairs = [state_of_robot(len(links), draw) for _ in range(STATES)]
            angles, quaternions = (written(folder / f"{robot}.{k}", [pair[k] for pair in pairs]) for k in (0, 1))
            theirs = {title: (built, f"{robot}_{convention}", *quaternions) for title, (built, convention) in peers.items()}
            compare(robot, folder, declared(robot, angles), theirs, 6 + len(links))


main()
