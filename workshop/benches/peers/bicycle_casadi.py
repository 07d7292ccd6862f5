"""The bicycle of `bodies/src/lib.rs` for CasADi, written as well as we can by hand.

What a person does who wants few operations: heading and place are left out of the dynamics; axes that stand on each other, lean,
pitch with the tilt of the fork, steer; each wheel leaves its axial spin behind, the rest of it belongs to frame or fork, so that two
bodies are left; the origin of the fork is slid along the steering axis; at the front contact the vertical and the axle are
directions that do not know the wheel's spin, so that two unknowns are solved for, and the third after them. Accelerations
come from derivatives with the rates of yaw, pitch and front wheel held as symbols, once the constraints are differentiated.
Constants are numbers, so that CasADi folds them; ours are given at run time.
"""

import casadi as ca

CONSTANTS = dict(
    w=1.02, c=0.08, tilt=0.3141592653589793, g=9.81, rR=0.3, rF=0.35,
    mR=2.0, Rxx=0.0603, Ryy=0.12,
    mB=85.0, xB=0.3, zB=-0.9, Bxx=9.2, Byy=11.0, Bzz=2.8, Bxz=2.4,
    mH=4.0, xH=0.9, zH=-0.7, Hxx=0.05892, Hyy=0.06, Hzz=0.00708, Hxz=-0.00756,
    mF=3.0, Fxx=0.1405, Fyy=0.28,
)


def turned(axis, s, c, v):
    """Components of `v` in axes that are turned about an axis (1 or 2) by an angle with this sine and cosine."""
    x, y, z = v
    return [c * x - s * z, y, s * x + c * z] if axis == 1 else [c * x + s * y, c * y - s * x, z]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def plus(*vectors):
    return [sum(entries[1:], entries[0]) for entries in zip(*vectors)]


def composite(parts):
    """Mass, place of the centre, moments (xx, yy, zz, xz) about the origin of bodies in the plane y = 0."""
    mass = sum(m for m, *_ in parts)
    x, z = (sum(part[0] * part[k] for part in parts) / mass for k in (1, 2))
    moments = [0.0] * 4
    for m, a, b, (xx, yy, zz, xz) in parts:
        for i, value in enumerate((xx + m * b * b, yy + m * (a * a + b * b), zz + m * a * a, xz - m * a * b)):
            moments[i] += value
    return mass, x, z, moments


def rebased(sine, cosine, moments):
    """Moments in axes that are turned about y by an angle."""
    xx, yy, zz, xz = moments
    cs = sine * cosine
    return [
        cosine**2 * xx + sine**2 * zz - 2 * cs * xz, yy,
        sine**2 * xx + cosine**2 * zz + 2 * cs * xz, cs * (xx - zz) + (cosine**2 - sine**2) * xz,
    ]


def rates(held):
    """`q`, `u` and the rates of the state; with the dependent rates held as symbols for derivatives, or not."""
    k = CONSTANTS
    q, u = ca.SX.sym("q", 8), ca.SX.sym("u", 3)
    yaw, lean, pitch, steer = q[2], q[3], q[4], q[5]
    falling, turning, driving = u[0], u[1], u[2]
    w = ca.SX.sym("w", 3)  # yaw, pitch, front
    st, ct = float(ca.sin(k["tilt"])), float(ca.cos(k["tilt"]))
    based = lambda v: turned(1, st, ct, v)
    sl, cl = ca.sin(lean), ca.cos(lean)
    sp, cp = ca.sin(pitch + k["tilt"]), ca.cos(pitch + k["tilt"])
    ss, cs = ca.sin(steer), ca.cos(steer)

    # Constants: the steering axis is at (reach, 0, 0) of the tilted frame axes, seen from the rear hub.
    foot = based([k["w"] + k["c"], 0.0, k["rR"]])
    reach, slid = foot[0], foot[2]
    nose = plus(based([-k["c"], 0.0, -k["rF"]]), [0.0, 0.0, slid])
    fork_place = plus(based([k["xH"] - k["w"] - k["c"], 0.0, k["zH"]]), [0.0, 0.0, slid])
    frame_place = based([k["xB"], 0.0, k["rR"] + k["zB"]])
    frame = composite([
        (k["mB"], frame_place[0], frame_place[2], rebased(st, ct, (k["Bxx"], k["Byy"], k["Bzz"], k["Bxz"]))),
        (k["mR"], 0.0, 0.0, (k["Rxx"], 0.0, k["Rxx"], 0.0)),
    ])
    fork = composite([
        (k["mH"], fork_place[0], fork_place[2], rebased(st, ct, (k["Hxx"], k["Hyy"], k["Hzz"], k["Hxz"]))),
        (k["mF"], nose[0], nose[2], (k["Fxx"], 0.0, k["Fxx"], 0.0)),
    ])

    # Spins and velocities, each in its own axes.
    def motion(w):
        leaning = [falling, w[0] * sl, w[0] * cl]
        wheel = leaning[1] + driving
        hub = [-k["rR"] * wheel, k["rR"] * falling, 0]
        tilted = turned(1, sp, cp, plus(leaning, [0, w[1], 0]))
        at_hub = turned(1, sp, cp, hub)
        head = plus(at_hub, [0, tilted[2] * reach, -tilted[1] * reach])
        steered = plus(turned(2, ss, cs, tilted), [0, 0, turning])
        at_head = turned(2, ss, cs, head)
        front = steered[1] + w[2]
        return dict(leaning=leaning, wheel=wheel, tilted=tilted, at_hub=at_hub, steered=steered, at_head=at_head, front=front)

    # The front contact: radial, along the axle, ahead.
    up = turned(2, ss, cs, turned(1, sp, cp, [0, sl, cl]))
    size = ca.sqrt(up[0] * up[0] + up[2] * up[2])
    radial = [up[0] / size, up[2] / size]

    def contact(w):
        m = motion(w)
        v, spin = m["at_head"], m["steered"]
        hub = plus(v, [spin[1] * nose[2], spin[2] * nose[0] - spin[0] * nose[2], -spin[1] * nose[0]])
        return [
            hub[0] * radial[0] + hub[2] * radial[1],
            hub[1] + k["rF"] * (spin[2] * radial[0] - spin[0] * radial[1]),
            hub[0] * radial[1] - hub[2] * radial[0] + k["rF"] * m["front"],
        ]

    rows = ca.vertcat(*contact(w))
    by_w, by_u = ca.jacobian(rows, w), ca.jacobian(rows, u)

    def solved(right):
        """w of `by_w w = right`: radial and axle do not know the front wheel."""
        a, b, c, d = by_w[0, 0], by_w[0, 1], by_w[1, 0], by_w[1, 1]
        inverse = 1 / (a * d - b * c)
        first = [(d * right[0, i] - b * right[1, i]) * inverse for i in range(right.shape[1])]
        second = [(a * right[1, i] - c * right[0, i]) * inverse for i in range(right.shape[1])]
        third = [(right[2, i] - by_w[2, 0] * first[i] - by_w[2, 1] * second[i]) / by_w[2, 2] for i in range(right.shape[1])]
        return ca.vertcat(ca.horzcat(*first), ca.horzcat(*second), ca.horzcat(*third))

    dependence = solved(-by_u)
    values = ca.mtimes(dependence, u)
    of = values if not held else w
    m = motion([of[i] for i in range(3)])
    sy, cy = ca.sin(yaw), ca.cos(yaw)
    # The hub is above the contact along the lean axes: the contact moves as the wheel rolls.
    ahead = -k["rR"] * driving
    place = [ahead * cy, ahead * sy]
    qdot = ca.vertcat(*place, of[0], falling, of[1], turning, driving, of[2])

    velocities = ca.vertcat(*m["tilted"], *m["at_hub"], *m["steered"], *m["at_head"], m["wheel"], m["front"])
    bias = ca.jtimes(velocities, q, qdot)
    if held:
        coefficients = ca.jacobian(velocities, u) + ca.mtimes(ca.jacobian(velocities, w), dependence)
        free = solved(-ca.jtimes(rows, q, qdot))
        bias += ca.mtimes(ca.jacobian(velocities, w), free)
    else:
        coefficients = ca.jacobian(velocities, u)

    # Momenta of both bodies and both axial spins: what acts on them, less what turning axes and the bias take.
    def forces(body, at, spin, v, axes, weight):
        mass, x, z, (xx, yy, zz, xz) = body
        b = lambda i: bias[at + i]
        column = lambda j: [coefficients[at + i, j] for i in range(6)]
        def momenta(p):
            om, vel = p[:3], p[3:]
            linear = [mass * (vel[0] + om[1] * z), mass * (vel[1] + om[2] * x - om[0] * z), mass * (vel[2] - om[1] * x)]
            angular = [
                xx * om[0] + xz * om[2] - mass * z * vel[1],
                yy * om[1] + mass * (z * vel[0] - x * vel[2]),
                xz * om[0] + zz * om[2] + mass * x * vel[1],
            ]
            return linear, angular
        linear, angular = momenta(spin + v)
        lost_linear, lost_angular = momenta([b(i) for i in range(6)])
        gyro_linear = cross(spin, linear)
        gyro_angular = plus(cross(spin, angular), cross(v, linear))
        pull = [mass * k["g"] * e for e in weight]
        moment = [-z * pull[1], z * pull[0] - x * pull[2], x * pull[1]]
        right = [a - b_ - c for a, b_, c in zip(moment + pull, lost_angular + lost_linear, gyro_angular + gyro_linear)]
        columns = [column(j) for j in range(3)]
        carried = [sum(momenta(c)[::-1], []) for c in columns]
        return columns, carried, right

    down_frame = turned(1, sp, cp, [0, sl, cl])
    down_fork = turned(2, ss, cs, down_frame)
    mass = [[0] * 3 for _ in range(3)]
    force = [0] * 3
    for columns, carried, right in (
        forces(frame, 0, m["tilted"], m["at_hub"], None, down_frame),
        forces(fork, 6, m["steered"], m["at_head"], None, down_fork),
    ):
        for i in range(3):
            force[i] += sum(a * b for a, b in zip(columns[i], right))
            for j in range(i + 1):
                mass[i][j] += sum(a * b for a, b in zip(columns[i], carried[j]))
    # Axial spins: the rate of the component along the axle, and the gyroscopic moment across it, which the axes carry.
    for at, moment, spin, axes, of_axes in ((12, k["Ryy"], m["wheel"], m["tilted"], 0), (13, k["Fyy"], m["front"], m["steered"], 6)):
        momentum = moment * spin
        across = [-axes[2] * momentum, 0, axes[0] * momentum]  # axes x (0, momentum, 0)
        for i in range(3):
            column = coefficients[at, i]
            force[i] -= moment * column * bias[at] + coefficients[of_axes, i] * across[0] + coefficients[of_axes + 2, i] * across[2]
            for j in range(i + 1):
                mass[i][j] += moment * column * coefficients[at, j]

    # L D L^T in a straight line.
    d, l = [], [[0] * 3 for _ in range(3)]
    for j in range(3):
        for i in range(j, 3):
            entry = mass[i][j] - sum(l[i][t] * l[j][t] * d[t] for t in range(j))
            if i == j:
                d.append(entry)
                inverse = 1 / entry
            else:
                l[i][j] = entry * inverse
    y = []
    for i in range(3):
        y.append(force[i] - sum(l[i][t] * y[t] for t in range(i)))
    x = [0] * 3
    for i in reversed(range(3)):
        x[i] = y[i] / d[i] - sum(l[t][i] * x[t] for t in range(i + 1, 3))
    out = ca.vertcat(qdot, *x)
    if held:
        out = ca.substitute(out, w, values)
    return q, u, ca.cse(out)


if __name__ == "__main__":
    for held in (False, True):
        q, u, out = rates(held)
        f = ca.Function("bicycle", [ca.vertcat(q, u)], [out])
        print(held, f.n_instructions())
        print(f([0.1, 0.2, 0.3, 0.15, 0.02, 0.25, 0.1, 0.2, 0.3, -0.4, -12.0]))
