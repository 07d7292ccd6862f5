"""The scenes of `contacts.py`: constants, what is compared, and how a run is judged by the reference."""

import json
import math
import time
from pathlib import Path

DATA = Path(__file__).resolve().parents[3] / "tests/data/hybrid"

G = 9.81
BALL = {"e": 0.8, "start": (1.0, 0.0), "end": 5.0}
PENDULUM = {"e": 0.6, "limit": 0.2, "start": (1.0, 0.0), "end": 10.0}
BELT = {"speed": 0.2, "rest": 0.1, "delta": 3.0, "g": 10.0, "start": (1.5, 0.0), "end": 40.0}

# Impacts of the ball that are compared: of infinitely many those before the rebound is slower than 0.5 m/s.
IMPACTS = 10
SCENES = {"bouncing_ball": IMPACTS, "pendulum_stop": 6, "stick_slip_belt": 7}


def friction(slip):
    """The coefficient of the belt."""
    return BELT["rest"] / (1 + BELT["delta"] * abs(slip))


def judged(run):
    """The largest error of the times, and that of the state at the end. A run that has missed an event has no error of times."""
    reference = json.loads((DATA / f"{run['scene']}.json").read_text())
    wanted = [float(event["t"]) for event in reference["events"]][: SCENES[run["scene"]]]
    last = reference["samples"][-1]
    end = [float(last["coordinates"][0]), float(last["velocities"][0])]
    found = run["times"]
    # Our state has both coordinates of the block.
    state = run["end"] if len(run["end"]) == 2 else [run["end"][0], run["end"][2]]
    worst = None
    if found is not None and len(found) >= len(wanted):
        worst = max(abs(a - b) for a, b in zip(found, wanted))
    end_error = float(max(abs(a - b) for a, b in zip(state, end)))
    count = 0 if found is None else min(len(found), len(wanted))
    worst = None if worst is None else float(worst)
    return {"found": count, "wanted": len(wanted), "time_error": worst, "end_error": end_error if math.isfinite(end_error) else math.inf}


def shortest(run, most=5, seconds=0.3):
    """The result of a run, and the shortest time of several in microseconds."""
    best, begun = math.inf, time.perf_counter()
    for _ in range(most):
        start = time.perf_counter_ns()
        result = run()
        best = min(best, (time.perf_counter_ns() - start) / 1e3)
        if time.perf_counter() - begun > seconds:
            break
    return result, best


def rest_after(t, rebound):
    """The end of infinitely many impacts of the ball after one of them."""
    return t + 2 * rebound / G / (1 - BALL["e"])


# The slip that a block is given where it is torn loose.
PUSH = 1e-12

# A rebound from which on a hand-written program takes the ball to rest.
SLOW = 1e-7


def belt_mode(x):
    """What the block does where its slip has come to an end: -1 and 1 slip, 0 sticks."""
    limit = BELT["rest"] * BELT["g"]
    return 0 if abs(x) <= limit else (1 if x < 0 else -1)
