"""Right-hand sides by SymPy: Kane's equations, common subexpressions, C.

Every system is set up in the best form that we know for Kane's method: speeds that fulfil the constraints, velocities
of points and bodies as functions of them. (Declared with its constraints, as ours is, a system costs SymPy more.) Each
model returns rates in the order of our state, coordinates first. Constants are numbers or symbols, as the caller likes.
"""

import sympy as sp
from sympy.codegen.rewriting import create_expand_pow_optimization
from sympy.physics.mechanics import KanesMethod, Particle, Point, ReferenceFrame, RigidBody, dynamicsymbols, inertia


class Model:
    """Coordinates, speeds, their kinematics, and what moves with which force."""

    def __init__(self, coordinates, speeds):
        self.q = dynamicsymbols(coordinates, real=True)
        self.u = dynamicsymbols(speeds, real=True)
        self.rates = {}
        self.bodies, self.loads = [], []
        self.space = ReferenceFrame("N")

    def particle(self, name, mass, velocity, force=None):
        """A point mass, or the mass centre of a body, with a velocity given in any frame."""
        point = Point(name)
        point.set_vel(self.space, velocity)
        self.bodies.append(Particle(name, point, mass))
        if force is not None:
            self.loads.append((point, force))

    def body(self, name, mass, dyadic, frame, velocity, force=None):
        point = Point(name)
        point.set_vel(self.space, velocity)
        self.bodies.append(RigidBody(name, point, frame, mass, (dyadic, point)))
        if force is not None:
            self.loads.append((point, force))

    def mass_and_force(self):
        t = dynamicsymbols._t
        kinematics = [q.diff(t) - self.rates[q] for q in self.q]
        kane = KanesMethod(self.space, q_ind=self.q, u_ind=self.u, kd_eqs=kinematics)
        kane.kanes_equations(self.bodies, self.loads or None)
        plain = {x: sp.Symbol(f"{x.func.__name__}_", real=True) for x in (*self.q, *self.u)}
        substitute = lambda e: e.xreplace(plain)
        symbols = [plain[x] for x in (*self.q, *self.u)]
        velocities = [substitute(sp.sympify(self.rates[q])) for q in self.q]
        return symbols, velocities, kane.mass_matrix.applyfunc(substitute), kane.forcing.applyfunc(substitute)


def hoop(k):
    a, A, C, g = (k[name] for name in ("a", "A", "C", "g"))
    return _rolling(a, A, C, g, C, lambda B, N, theta, u: (-a * u[2] * B.x + a * u[0] * B.z))


def appell(k):
    a, A, C, g = (k[name] for name in ("a", "A", "C", "g"))
    velocity = lambda B, N, theta, u: -a * sp.sin(theta) * u[0] * N.x + a * sp.cos(theta) * u[0] * N.z
    return _rolling(a, A, C, g, C + a**2, velocity)


def _rolling(a, A, C, g, axial, velocity):
    model = Model("theta psi phi xi eta zeta", "eta1 eta2 eta3")
    theta, psi, phi, xi, eta, zeta = model.q
    u1, u2, u3 = model.u
    N = model.space
    level = N.orientnew("A", "Axis", [psi, N.z])
    B = level.orientnew("B", "Axis", [theta, level.x])
    turning = u2 / sp.sin(theta)
    B.set_ang_vel(N, u1 * B.x + u2 * B.y + turning * sp.cos(theta) * B.z)
    spinning = B.orientnew("S", "Axis", [phi, B.z])
    spinning.set_ang_vel(N, u1 * B.x + u2 * B.y + u3 * B.z)
    v = velocity(B, N, theta, model.u)
    model.body("hoop", 1, inertia(B, A, A, axial), spinning, v, -g * N.z)
    model.rates = {theta: u1, psi: turning, phi: u3 - turning * sp.cos(theta)}
    for x, axis in ((xi, N.x), (eta, N.y), (zeta, N.z)):
        model.rates[x] = v.dot(axis)
    return model


def sled(k):
    m, alpha, beta, radius = (k[name] for name in ("m", "alpha", "beta", "k"))
    model = Model("phi xi eta", "eta1 eta2")
    phi, xi, eta = model.q
    u1, u2 = model.u
    N = model.space
    B = N.orientnew("B", "Axis", [phi, N.z])
    B.set_ang_vel(N, u1 * B.z)
    v = (u2 - beta * u1) * B.x + alpha * u1 * B.y
    model.body("sled", m, inertia(B, 0, 0, m * radius**2), B, v, m * k["g"] * sp.sin(k["incline"]) * N.x)
    model.rates = {phi: u1, xi: u2 * sp.cos(phi), eta: u2 * sp.sin(phi)}
    return model


def turntable(k):
    m, a, omega = (k[name] for name in ("m", "a", "Omega"))
    model = Model("x y psi theta phi", "eta1 eta2 eta3")
    x, y, psi, theta, phi = model.q
    u1, u2, u3 = model.u
    N = model.space
    ball = ReferenceFrame("S")
    ball.set_ang_vel(N, u1 * N.x + u2 * N.y + u3 * N.z)
    moment = sp.Rational(2, 5) * m * a**2
    east, north = a * u2 - omega * y, omega * x - a * u1
    model.body("ball", m, inertia(N, moment, moment, moment), ball, east * N.x + north * N.y)
    spinning = (u1 * sp.sin(psi) - u2 * sp.cos(psi)) / sp.sin(theta)
    model.rates = {
        x: east,
        y: north,
        psi: u3 - spinning * sp.cos(theta),
        theta: u1 * sp.cos(psi) + u2 * sp.sin(psi),
        phi: spinning,
    }
    return model


def top(k):
    model = Model("psi theta phi", "p q r")
    psi, theta, phi = model.q
    p, q, r = model.u
    N = model.space
    body = ReferenceFrame("B")
    body.set_ang_vel(N, p * body.x + q * body.y + r * body.z)
    model.body("top", 1, inertia(body, k["I1"], k["I2"], k["I3"]), body, 0 * N.x)
    turning = (p * sp.sin(phi) + q * sp.cos(phi)) / sp.sin(theta)
    model.rates = {
        psi: turning,
        theta: p * sp.cos(phi) - q * sp.sin(phi),
        phi: r - turning * sp.cos(theta),
    }
    return model


def car(trailers):
    def build(k):
        m, J, I, l, M, K, d = (k[name] for name in ("m", "J", "I", "l", "M", "K", "d"))
        model = Model(" ".join(["x", "y", "heading", "steering"] + [f"trailer{i}" for i in range(trailers)]), "speed turning")
        x, y, heading, steering = model.q[:4]
        speed, turning = model.u
        N = model.space
        bend = speed * sp.tan(steering) / l
        model.rates = {x: speed * sp.cos(heading), y: speed * sp.sin(heading), heading: bend, steering: turning}
        ahead, angle = speed, heading

        def wheel(name, mass, moment, angle, rate, along):
            frame = N.orientnew(name, "Axis", [angle, N.z])
            frame.set_ang_vel(N, rate * N.z)
            model.body(name, mass, inertia(frame, 0, 0, moment), frame, along * frame.x)

        wheel("car", m, J, heading, bend, speed)
        front = ReferenceFrame("W")
        front.set_ang_vel(N, (bend + turning) * N.z)
        model.body("front", 0, inertia(N, 0, 0, I), front, 0 * N.x)
        for i in range(trailers):
            own = model.q[4 + i]
            turn = ahead * sp.sin(angle - own) / d
            ahead, angle = ahead * sp.cos(angle - own), own
            model.rates[own] = turn
            wheel(f"trailer{i}", M, K, own, turn, ahead)
        return model

    return build


def chain(links, relative):
    def build(k):
        m, l, g = (k[name] for name in ("m", "l", "g"))
        numbers = range(1, links + 1)
        model = Model(" ".join(f"q{i}" for i in numbers), " ".join(f"w{i}" for i in numbers))
        N = model.space
        x, y, angle, rate = 0, 0, 0, 0
        for i in range(links):
            angle = angle + model.q[i] if relative else model.q[i]
            rate = rate + model.u[i] if relative else model.u[i]
            x, y = x + l * rate * sp.cos(angle), y + l * rate * sp.sin(angle)
            model.particle(f"m{i}", m, x * N.x + y * N.y, -m * g * N.y)
            model.rates[model.q[i]] = model.u[i]
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
# Explicit solutions, simplified, pay up to here; beyond it a factorisation of the matrix does.
SMALL = {"hoop", "sled", "appell", "turntable", "top", "chain2", "joints2"}


def c_function(name, suffix, constants, fixed):
    """The text of a function in C, and its operations as SymPy counts them."""
    values = {n: sp.Rational(*v) for n, v in constants} if fixed else {n: sp.Symbol(n, positive=True) for n, _ in constants}
    symbols, velocities, mass, force = MODELS[name](values).mass_and_force()
    candidates = [_factored(velocities, mass, force)]
    if name in SMALL:
        explicit = mass.LUsolve(force)
        candidates.append(_shared(velocities + list(explicit)))
        candidates.append(_shared(velocities + [sp.simplify(e) for e in explicit]))
    count = lambda program: sum(e.count_ops() for _, e in program[0]) + sum(e.count_ops() for e in program[1])
    steps, outputs = min(candidates, key=count)
    expand = create_expand_pow_optimization(6)
    code = lambda e: sp.ccode(expand(e))
    lines = [f"static void {name}_{suffix}(const double *restrict given, const double *restrict state, double *restrict rates) {{"]
    if not fixed:
        lines += [f"    const double {n} = given[{i}];" for i, (n, _) in enumerate(constants)]
    else:
        lines += ["    (void)given;"]
    lines += [f"    const double {s} = state[{i}]; (void){s};" for i, s in enumerate(symbols)]
    lines += [f"    const double {s} = {code(e)};" for s, e in steps]
    lines += [f"    rates[{i}] = {code(e)};" for i, e in enumerate(outputs)]
    return "\n".join(lines + ["}"]), count((steps, outputs))


def _shared(expressions):
    return sp.cse(expressions, symbols=sp.numbered_symbols("z"), list=True)


def _factored(velocities, mass, force):
    """Entries with common subexpressions, then L D L^T of the matrix as a straight line."""
    size = len(force)
    lower = [(i, j) for i in range(size) for j in range(i + 1)]
    steps, outputs = _shared(list(velocities) + [mass[i, j] for i, j in lower] + list(force))
    names = sp.numbered_symbols("f")

    def named(e):
        e = sp.sympify(e)
        if e.is_Number or e.is_Symbol:
            return e
        name = next(names)
        steps.append((name, e))
        return name

    velocities, outputs = outputs[: len(velocities)], outputs[len(velocities) :]
    m = {place: named(e) for place, e in zip(lower, outputs)}
    b = [named(e) for e in outputs[len(lower) :]]
    inverse = []
    for j in range(size):
        inverse.append(named(1 / m[j, j]))
        for i in range(j + 1, size):
            factor = named(m[i, j] * inverse[j])
            for t in range(i, size):
                m[t, i] = named(m[t, i] - factor * m[t, j])
            b[i] = named(b[i] - factor * b[j])
    solved = [None] * size
    for i in reversed(range(size)):
        rest = b[i]
        for t in range(i + 1, size):
            rest = rest - m[t, i] * solved[t]
        solved[i] = named(rest * inverse[i])
    return steps, list(velocities) + solved
