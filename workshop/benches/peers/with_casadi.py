"""Right-hand sides by CasADi: projection with derivatives by automatic differentiation, C from an `SX` graph.

A system is a list of scalar velocities, linear in the speeds, each with its inertia and with what acts along it besides.
For the rows `v = B(q) u` with inertias `w` the speeds follow from `sum w B B^T u' = sum B (force - w (dB/dt) u)`, where
`dB/dt u` is a directional derivative. The matrix is factored as `L D L^T` in a straight line.
"""

import os
import tempfile

import casadi as ca


class Model:
    def __init__(self, coordinates, speeds):
        self.q, self.u = ca.SX.sym("q", coordinates), ca.SX.sym("u", speeds)
        self.rates, self.rows = [], []

    def row(self, velocity, inertia, force=0):
        self.rows.append((velocity, inertia, force))

    def derivatives(self):
        rates = ca.vertcat(*self.rates)
        velocity = ca.vertcat(*[row[0] for row in self.rows])
        inertia = ca.vertcat(*[row[1] for row in self.rows])
        force = ca.vertcat(*[row[2] for row in self.rows])
        partial = ca.jacobian(velocity, self.u)
        at_rest = ca.jtimes(velocity, self.q, rates)
        mass = ca.mtimes(partial.T, partial * ca.repmat(inertia, 1, partial.shape[1]))
        acting = ca.mtimes(partial.T, force - inertia * at_rest)
        return ca.vertcat(rates, _solved(mass, acting))


def _solved(mass, force):
    size = force.shape[0]
    m = {(i, j): mass[i, j] for i in range(size) for j in range(i + 1)}
    b, inverse = [force[i] for i in range(size)], []
    for j in range(size):
        inverse.append(1 / m[j, j])
        for i in range(j + 1, size):
            factor = m[i, j] * inverse[j]
            for t in range(i, size):
                m[t, i] = m[t, i] - factor * m[t, j]
            b[i] = b[i] - factor * b[j]
    solved = [None] * size
    for i in reversed(range(size)):
        rest = b[i]
        for t in range(i + 1, size):
            rest = rest - m[t, i] * solved[t]
        solved[i] = rest * inverse[i]
    return ca.vertcat(*solved)


def _spinning(model, omega, frame, moments):
    """A body's angular velocity in axes that turn with `frame`."""
    momentum = [moment * w for moment, w in zip(moments, omega)]
    gyroscopic = ca.cross(ca.vertcat(*frame), ca.vertcat(*momentum))
    for i in range(3):
        model.row(omega[i], moments[i], -gyroscopic[i])


def hoop(k):
    a, A, C, g = (k[name] for name in ("a", "A", "C", "g"))
    model = Model(6, 3)
    u1, u2, u3 = ca.vertsplit(model.u)
    s, c, turning, frame = _tilted(model)
    _spinning(model, (u1, u2, u3), frame, (A, A, C))
    velocity = ca.vertcat(-a * u3, 0, a * u1)
    acceleration = ca.cross(ca.vertcat(*frame), velocity)
    for v, turned, weight in zip(ca.vertsplit(velocity), ca.vertsplit(acceleration), (0, -g * s, -g * c)):
        model.row(v, 1, weight - turned)
    sp, cp = ca.sin(model.q[1]), ca.cos(model.q[1])
    level = -a * u1 * s
    model.rates += [-a * u3 * cp - level * sp, -a * u3 * sp + level * cp, a * u1 * c]
    return model


def appell(k):
    a, A, C, g = (k[name] for name in ("a", "A", "C", "g"))
    model = Model(6, 3)
    u1, u2, u3 = ca.vertsplit(model.u)
    s, c, turning, frame = _tilted(model)
    _spinning(model, (u1, u2, u3), frame, (A, A, C + a**2))
    model.row(-a * s * u1, 1)
    model.row(a * c * u1, 1, -g)
    model.rates += [-a * s * u1, 0, a * c * u1]
    return model


def _tilted(model):
    u1, u2, u3 = ca.vertsplit(model.u)
    s, c = ca.sin(model.q[0]), ca.cos(model.q[0])
    turning = u2 / s
    model.rates = [u1, turning, u3 - turning * c]
    return s, c, turning, (u1, u2, turning * c)


def sled(k):
    m, alpha, beta, radius = (k[name] for name in ("m", "alpha", "beta", "k"))
    model = Model(3, 2)
    u1, u2 = ca.vertsplit(model.u)
    s, c = ca.sin(model.q[0]), ca.cos(model.q[0])
    slope = m * k["g"] * ca.sin(k["incline"])
    along, across = u2 - beta * u1, alpha * u1
    model.row(along, m, slope * c + m * u1 * across)
    model.row(across, m, -slope * s - m * u1 * along)
    model.row(u1, m * radius**2)
    model.rates = [u1, u2 * c, u2 * s]
    return model


def turntable(k):
    m, a, omega = (k[name] for name in ("m", "a", "Omega"))
    model = Model(5, 3)
    x, y, psi, theta, phi = ca.vertsplit(model.q)
    u1, u2, u3 = ca.vertsplit(model.u)
    east, north = a * u2 - omega * y, omega * x - a * u1
    for v, inertia in ((east, m), (north, m), *((u, 0.4 * m * a**2) for u in (u1, u2, u3))):
        model.row(v, inertia)
    spinning = (u1 * ca.sin(psi) - u2 * ca.cos(psi)) / ca.sin(theta)
    model.rates = [east, north, u3 - spinning * ca.cos(theta), u1 * ca.cos(psi) + u2 * ca.sin(psi), spinning]
    return model


def top(k):
    model = Model(3, 3)
    psi, theta, phi = ca.vertsplit(model.q)
    p, q, r = ca.vertsplit(model.u)
    _spinning(model, (p, q, r), (p, q, r), (k["I1"], k["I2"], k["I3"]))
    turning = (p * ca.sin(phi) + q * ca.cos(phi)) / ca.sin(theta)
    model.rates = [turning, p * ca.cos(phi) - q * ca.sin(phi), r - turning * ca.cos(theta)]
    return model


def car(trailers):
    def build(k):
        m, J, I, l, M, K, d = (k[name] for name in ("m", "J", "I", "l", "M", "K", "d"))
        model = Model(4 + trailers, 2)
        speed, turning = ca.vertsplit(model.u)
        heading, steering = model.q[2], model.q[3]
        bend = speed * ca.tan(steering) / l
        model.rates = [speed * ca.cos(heading), speed * ca.sin(heading), bend, turning]
        # Accelerations across an axle do no work.
        for v, inertia in ((speed, m), (bend, J), (bend + turning, I)):
            model.row(v, inertia)
        ahead, angle = speed, heading
        for i in range(trailers):
            own = model.q[4 + i]
            turn = ahead * ca.sin(angle - own) / d
            ahead, angle = ahead * ca.cos(angle - own), own
            model.rates.append(turn)
            model.row(ahead, M)
            model.row(turn, K)
        return model

    return build


def chain(links, relative):
    def build(k):
        m, l, g = (k[name] for name in ("m", "l", "g"))
        model = Model(links, links)
        x, y, angle, rate = 0, 0, 0, 0
        for i in range(links):
            angle = angle + model.q[i] if relative else model.q[i]
            rate = rate + model.u[i] if relative else model.u[i]
            x, y = x + l * rate * ca.cos(angle), y + l * rate * ca.sin(angle)
            model.row(x, m)
            model.row(y, m, -m * g)
        model.rates = ca.vertsplit(model.u)
        return model

    return build


MODELS = {
    "hoop": hoop,
    "sled": sled,
    "appell": appell,
    "turntable": turntable,
    "top": top,
    **{f"car{n}": car(n) for n in (1, 2, 3)},
    **{f"chain{n}": chain(n, False) for n in (2, 5, 10, 20)},
    **{f"joints{n}": chain(n, True) for n in (2, 5, 10)},
}


def c_function(name, suffix, constants, fixed):
    """The text of a function in C, and the number of its operations."""
    symbols = ca.SX.sym("k", len(constants))
    values = {n: v[0] / v[1] if fixed else symbols[i] for i, (n, v) in enumerate(constants)}
    model = MODELS[name](values)
    rates = ca.cse(model.derivatives())
    title = f"{name}_{suffix}_casadi"
    function = ca.Function(title, [symbols, ca.vertcat(model.q, model.u)], [rates])
    with tempfile.TemporaryDirectory() as folder:
        here = os.getcwd()
        os.chdir(folder)
        try:
            function.generate(f"{title}.c", {"with_header": False})
            with open(f"{title}.c") as file:
                text = file.read()
        finally:
            os.chdir(here)
    # The arithmetic alone: CasADi's own wrapper passes pointers through a table.
    start = text.index(f"static int casadi_f0(")
    body = text[start : text.index("\n}\n", start) + 3].replace("casadi_f0", title).replace("casadi_real", "double").replace("casadi_int", "long long")
    wrapper = (
        f"static void {name}_{suffix}(const double *restrict k, const double *restrict s, double *restrict r) {{\n"
        f"    const double *arg[2] = {{k, s}};\n    double *res[1] = {{r}};\n    {title}(arg, res, 0, 0, 0);\n}}"
    )
    return body + wrapper, function.n_instructions()
