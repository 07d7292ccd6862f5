"""The scenes with Drake: a hand-made hybrid system in Python, with witness functions, under an adaptive third-order method."""

import math
from importlib.metadata import version

from pydrake.systems.analysis import ResetIntegratorFromFlags, Simulator
from pydrake.systems.framework import LeafSystem, UnrestrictedUpdateEvent, WitnessFunctionDirection

from contacts_scenes import BALL, BELT, G, PENDULUM, PUSH, SLOW, belt_mode, friction, rest_after, shortest

VERSION, METHOD = version("drake"), "LeafSystem with witness functions, runge_kutta3; the setting is its accuracy"


# The height from which the ball flies on.
ABOVE = 1e-14


class Piecewise(LeafSystem):
    """Two states, a right-hand side and an inequality for each mode, and what follows where the inequality ends."""

    def __init__(self, rhs, inside, after, mode):
        super().__init__()
        self.rhs, self.inside, self.after, self.mode, self.times = rhs, inside, after, mode, []
        self.DeclareContinuousState(1, 1, 0)
        hit = UnrestrictedUpdateEvent(system_callback=lambda system, context, event, state: self.hit(context, state))
        positive = lambda context: self.inside(self.mode, self.state(context))
        self.witness = self.MakeWitnessFunction("inside", WitnessFunctionDirection.kPositiveThenNonPositive, positive, hit)

    def state(self, context):
        return context.get_continuous_state_vector().CopyToVector()

    def DoCalcTimeDerivatives(self, context, derivatives):
        derivatives.get_mutable_vector().SetFromVector(self.rhs(self.mode, self.state(context)))

    def DoGetWitnessFunctions(self, context):
        return [self.witness]

    def hit(self, context, state):
        t = context.get_time()
        self.times.append(t)
        self.mode, after = self.after(self.mode, self.state(context), t, self.times)
        state.get_mutable_continuous_state().get_mutable_vector().SetFromVector(after)


def run(system, scene, accuracy):
    simulator = Simulator(system)
    context = simulator.get_mutable_context()
    context.SetContinuousState(list(scene["start"]))
    context.SetAccuracy(accuracy)
    ResetIntegratorFromFlags(simulator, "runge_kutta3", 0.1)
    simulator.get_mutable_integrator().set_target_accuracy(accuracy)
    simulator.get_mutable_integrator().set_fixed_step_mode(False)
    simulator.Initialize()
    simulator.AdvanceTo(scene["end"])
    return system.times, [float(entry) for entry in system.state(simulator.get_context())]


def bounced(mode, y, t, times):
    if BALL["e"] * -y[1] < SLOW * 1e4:
        times.append(rest_after(t, BALL["e"] * -y[1]))
        return "rest", [0.0, 0.0]
    # A witness that is zero at the start of a step does not see its fall.
    return mode, [ABOVE, -BALL["e"] * y[1]]


def ball():
    rhs = lambda mode, y: [0.0, 0.0] if mode == "rest" else [y[1], -G]
    return Piecewise(rhs, lambda mode, y: 1.0 if mode == "rest" else y[0], bounced, "flies")


def pendulum():
    rhs = lambda mode, y: [y[1], -G * math.sin(y[0])]
    after = lambda mode, y, t, times: (mode, [-PENDULUM["limit"], -PENDULUM["e"] * y[1]])
    return Piecewise(rhs, lambda mode, y: y[0] + PENDULUM["limit"], after, "")


def belt():
    speed, limit = BELT["speed"], BELT["rest"] * BELT["g"]
    rhs = lambda mode, y: [speed, 0.0] if mode == 0 else [y[1], -y[0] - mode * friction(y[1] - speed) * BELT["g"]]
    inside = lambda mode, y: limit - y[0] if mode == 0 else mode * (y[1] - speed)
    after = lambda mode, y, t, times: (-1, [y[0], speed - PUSH]) if mode == 0 else (belt_mode(y[0]), [y[0], speed])
    return Piecewise(rhs, inside, after, -1)


def runs():
    for name, scene, made in (("bouncing_ball", BALL, ball), ("pendulum_stop", PENDULUM, pendulum), ("stick_slip_belt", BELT, belt)):
        for digits in range(2, 10):
            accuracy = 10.0**-digits
            (times, end), us = shortest(lambda: run(made(), scene, accuracy))
            yield {"scene": name, "setting": accuracy, "times": times, "end": end, "us": us}
