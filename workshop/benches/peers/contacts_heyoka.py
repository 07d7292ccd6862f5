"""The scenes with heyoka: terminal events on its Taylor series, and the modes by hand. Integrators are compiled before they are timed."""

import heyoka as hy

from contacts_scenes import BALL, BELT, G, PENDULUM, PUSH, SLOW, belt_mode, rest_after, shortest

VERSION, METHOD = hy.__version__, "taylor_adaptive, terminal events; the setting is its tolerance"


def compiled(equations, event, direction, tolerance):
    return hy.taylor_adaptive(equations, [0.0, 0.0], tol=tolerance, t_events=[hy.t_event(event, direction=direction)])


def piece(integrator, t, y, end):
    """A smooth piece: its end, and whether the event has ended it."""
    integrator.time = t
    integrator.state[:] = y
    outcome = integrator.propagate_until(end)[0]
    return integrator.time, list(integrator.state), outcome != hy.taylor_outcome.time_limit


def impacts(integrator, scene, place, factor):
    """A run with impacts, until the rebound is slow."""
    t, y, times, end = 0.0, list(scene["start"]), [], scene["end"]
    # Only at the start: a cooldown that is reset at an impact loses the next one.
    integrator.reset_cooldowns()
    while True:
        t, y, hit = piece(integrator, t, y, end)
        if not hit:
            return times, y
        times.append(t)
        y = [place, -factor * y[1]]
        # Below 1e-5 m/s flights are shorter than the cooldown, and the ball falls through the floor.
        if scene is BALL and y[1] < 100 * SLOW:
            times.append(rest_after(t, y[1]))
            return times, [0.0, 0.0]


def belt(integrators):
    t, y, times, mode = 0.0, list(BELT["start"]), [], -1
    integrators[mode].reset_cooldowns()
    while True:
        t, y, hit = piece(integrators[mode], t, y, BELT["end"])
        if not hit:
            return times, y
        times.append(t)
        mode = -1 if mode == 0 else belt_mode(y[0])
        # An event that is zero at the start would fire again at once.
        y[1] = BELT["speed"] + mode * PUSH
        integrators[mode].reset_cooldowns()


def runs():
    x, v = hy.make_vars("x", "v")
    falling, rising = hy.event_direction.negative, hy.event_direction.positive
    speed, limit = BELT["speed"], BELT["rest"] * BELT["g"]
    for digits in range(2, 16):
        tolerance = 10.0**-digits
        ball = compiled([(x, v), (v, hy.expression(-G))], x, falling, tolerance)
        pendulum = compiled([(x, v), (v, -G * hy.sin(x))], x + PENDULUM["limit"], falling, tolerance)
        slips = {
            sign: compiled([(x, v), (v, -x - sign * limit / (1.0 + BELT["delta"] * sign * (v - speed)))], v - speed, direction, tolerance)
            for sign, direction in ((-1, rising), (1, falling))
        }
        slips[0] = compiled([(x, v), (v, hy.expression(0.0))], x - limit, rising, tolerance)
        for scene, run in (
            ("bouncing_ball", lambda: impacts(ball, BALL, 0.0, BALL["e"])),
            ("pendulum_stop", lambda: impacts(pendulum, PENDULUM, -PENDULUM["limit"], PENDULUM["e"])),
            ("stick_slip_belt", lambda: belt(slips)),
        ):
            (times, end), us = shortest(run, most=50)
            yield {"scene": scene, "setting": tolerance, "times": times, "end": end, "us": us}
