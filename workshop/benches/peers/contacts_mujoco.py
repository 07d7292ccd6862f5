"""The scenes with MuJoCo: a stop as the limit of a joint, dry friction as the loss of a joint, fixed steps.

A stop is a spring with a damper that acts while it presses. Its damping is chosen so that it throws back with the restitution of the scene, and its
stiffness so that a contact takes twenty steps. The friction of the belt is set anew before each step, for MuJoCo's does not depend on the speed.
"""

import math

import mujoco

from contacts_scenes import BALL, BELT, PENDULUM, friction, shortest

VERSION, METHOD = mujoco.__version__, "RK4, soft constraints; the setting is the step"
STEPS_IN_CONTACT = 20


def returned(damping):
    """The part of the speed that a spring with a damper gives back, let go where its force is zero."""
    root = math.sqrt(1 - damping * damping)
    angle = math.atan2(2 * damping * root, 2 * damping * damping - 1)
    return math.exp(-damping * angle / root) * abs(math.cos(angle) - damping / root * math.sin(angle))


def damping_for(restitution):
    low, high = 0.0, 0.7
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if returned(middle) > restitution else (low, middle)
    return low


def stop(step, restitution):
    """The reference of a constraint: stiffness and damping, both negative as MuJoCo wants them."""
    frequency = math.pi / (STEPS_IN_CONTACT * step)
    return f"{-frequency**2} {-2 * damping_for(restitution) * frequency}"


HARD = "0.9999 0.9999 0.001 0.5 2"


def model(step, gravity, joint, place):
    return mujoco.MjModel.from_xml_string(
        f"""<mujoco><option timestep="{step}" gravity="{gravity}" integrator="RK4"/><worldbody><body>
        <joint name="q" damping="0" {joint}/><inertial pos="{place}" mass="1" diaginertia="1e-9 1e-9 1e-9"/></body></worldbody></mujoco>"""
    )


def impacts(made, scene, limit):
    """Runs to the end, and tells when the limit was reached from above, on a line between steps."""

    def run():
        data = mujoco.MjData(made)
        data.qpos[0], data.qvel[0] = scene["start"]
        times, before = [], data.qpos[0] - limit
        for _ in range(round(scene["end"] / made.opt.timestep)):
            mujoco.mj_step(made, data)
            now = data.qpos[0] - limit
            if before > 0 >= now:
                times.append(data.time + made.opt.timestep * now / (before - now))
            before = now
        return times, [float(data.qpos[0]), float(data.qvel[0])]

    def timed():
        data = mujoco.MjData(made)
        data.qpos[0], data.qvel[0] = scene["start"]
        mujoco.mj_step(made, data, round(scene["end"] / made.opt.timestep))

    return run(), shortest(timed)[1]


def belt(made):
    """The position over the belt is the coordinate, so that the loss of the joint is the friction; modes are not told."""

    def run():
        data, speed = mujoco.MjData(made), BELT["speed"]
        data.qpos[0], data.qvel[0] = BELT["start"][0], BELT["start"][1] - speed
        for _ in range(round(BELT["end"] / made.opt.timestep)):
            made.dof_frictionloss[0] = friction(data.qvel[0]) * BELT["g"]
            data.qfrc_applied[0] = -(data.qpos[0] + speed * data.time)
            mujoco.mj_step(made, data)
        return None, [float(data.qpos[0] + speed * BELT["end"]), float(data.qvel[0] + speed)]

    return shortest(run)


def runs():
    for step in (1e-2, 3e-3, 1e-3, 3e-4, 1e-4):
        step = 1 / round(1 / step)
        slide = 'type="slide" axis="0 0 1"'
        ball = model(step, "0 0 -9.81", f'{slide} limited="true" range="0 100" solreflimit="{stop(step, BALL["e"])}" solimplimit="{HARD}"', "0 0 0")
        hinge = f'type="hinge" axis="0 -1 0" limited="true" range="{math.degrees(-PENDULUM["limit"])} 170"'
        pendulum = model(step, "0 0 -9.81", f'{hinge} solreflimit="{stop(step, PENDULUM["e"])}" solimplimit="{HARD}"', "0 0 -1")
        block = model(step, "0 0 0", f'{slide} frictionloss="1" solreffriction="{2 * step} 1" solimpfriction="{HARD}"', "0 0 0")
        results = [
            ("bouncing_ball", *impacts(ball, BALL, 0.0)),
            ("pendulum_stop", *impacts(pendulum, PENDULUM, -PENDULUM["limit"])),
            ("stick_slip_belt", *belt(block)),
        ]
        for scene, (times, end), us in results:
            yield {"scene": scene, "setting": step, "times": times, "end": end, "us": us}
