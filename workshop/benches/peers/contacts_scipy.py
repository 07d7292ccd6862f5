"""The scenes with SciPy's `solve_ivp`: terminal events, and the modes by hand."""

import math

import scipy
from scipy.integrate import solve_ivp

from contacts_scenes import BALL, BELT, G, PENDULUM, PUSH, SLOW, belt_mode, friction, rest_after, shortest

VERSION, METHOD = scipy.__version__, "solve_ivp, DOP853, terminal events; the setting is its tolerance"


# A longer step would go through a stop and come back unseen.
LONGEST = 0.25


def event(function, direction):
    function.terminal, function.direction = True, direction
    return function


def piece(rhs, t, y, end, crossing, tolerance, first=None):
    """A smooth piece: its end, and whether the event has ended it."""
    first = first if first is None else min(first, end - t)
    done = solve_ivp(rhs, (t, end), y, method="DOP853", rtol=tolerance, atol=tolerance, events=crossing, first_step=first, max_step=LONGEST)
    return done.t[-1], list(done.y[:, -1]), done.status == 1


def ball(tolerance):
    t, y, times, end = 0.0, list(BALL["start"]), [], BALL["end"]
    floor = event(lambda t, y: y[0], -1)
    first = None
    while True:
        t, y, hit = piece(lambda t, y: [y[1], -G], t, y, end, floor, tolerance, first)
        if not hit:
            return times, y
        times.append(t)
        y = [0.0, -BALL["e"] * y[1]]
        # A first step across the whole flight would miss its end.
        first = y[1] / G / 4
        if y[1] < SLOW:
            times.append(rest_after(t, y[1]))
            return times, [0.0, 0.0]


def pendulum(tolerance):
    t, y, times, end = 0.0, list(PENDULUM["start"]), [], PENDULUM["end"]
    stop = event(lambda t, y: y[0] + PENDULUM["limit"], -1)
    while True:
        t, y, hit = piece(lambda t, y: [y[1], -G * math.sin(y[0])], t, y, end, stop, tolerance)
        if not hit:
            return times, y
        times.append(t)
        y = [-PENDULUM["limit"], -PENDULUM["e"] * y[1]]


def belt(tolerance):
    t, y, times, end, mode = 0.0, list(BELT["start"]), [], BELT["end"], -1
    speed, limit = BELT["speed"], BELT["rest"] * BELT["g"]
    while True:
        if mode == 0:
            rhs, crossing = (lambda t, y: [speed, 0.0]), event(lambda t, y: limit - y[0], -1)
        else:
            rhs = lambda t, y: [y[1], -y[0] - mode * friction(y[1] - speed) * BELT["g"]]
            crossing = event(lambda t, y: mode * (y[1] - speed), -1)
        t, y, hit = piece(rhs, t, y, end, crossing, tolerance)
        if not hit:
            return times, y
        times.append(t)
        # Where it is torn loose its acceleration is zero: without a push the event would fire again at once.
        y[1] = speed if mode else speed - PUSH
        mode = -1 if mode == 0 else belt_mode(y[0])


def runs():
    for scene, function in (("bouncing_ball", ball), ("pendulum_stop", pendulum), ("stick_slip_belt", belt)):
        for digits in range(2, 14):
            tolerance = max(10.0**-digits, 3e-14)
            (times, end), us = shortest(lambda: function(tolerance))
            yield {"scene": scene, "setting": tolerance, "times": times, "end": end, "us": us}
