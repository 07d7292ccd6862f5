"""Bricard's mechanism of the IFToMM library (A04) in 25 digits: prints `bricard.txt`.

    python3 tests/data/bricard.py > tests/data/bricard.txt        # a minute

Shares nothing with the declaration in `tests/motion/published/bricard.rs`. The joints of a closed ring of six rods of 1 m whose hinges stand at right angles are the
corners of two triangles with a common axis, at the heights `h` and `-h` and with the radii `r` and `R`. With half of the hinges' angles, `u` at the
corners of the first and `v` at those of the second,

    cos(u) cos(v) = 1/2        r = 2 cos(v)/sqrt(3)        R = 2 cos(u)/sqrt(3)        h = sin(u) sin(v)/sqrt(3)

so that `u' = w cos(u) sin(v)`, `v' = -w sin(u) cos(v)` leaves one degree of freedom, seen from the rod that is the ground:

    M w' = -w^2 M'/2 - V'      M(u, v): the kinetic energy at w = 1, twice     the stroke along that motion

which is taken by polynomials in a small time. Extrapolated midpoint rules of order 26 in 45 digits, twice: what both runs agree in is printed.
"""

import sys
from decimal import Decimal as D, getcontext

getcontext().prec = 45
TIMES = [D("0.1"), D(1), D(3), D(10)]
G, LENGTH, MASS, SIDE = D("9.81"), D(1), D(1), D("0.1")
ALONG = MASS * SIDE * SIDE / 6
ACROSS = MASS * (LENGTH * LENGTH + SIDE * SIDE) / 12
ROOT = D(3).sqrt()
PI = D("3.14159265358979323846264338327950288419716939937510582")


def sine_cosine(x):
    """By their series at x/64, doubled six times."""
    x = x / 64
    term, sine, versed, n = x, x, D(0), 1
    while abs(term) > D(10) ** -52:
        term = term * x / (n + 1)
        versed += term if n % 4 == 1 else -term
        term = term * x / (n + 2)
        sine += -term if n % 4 == 1 else term
        n += 2
    for _ in range(6):
        sine, versed = 2 * sine * (1 - versed), 2 * sine * sine
    return sine, 1 - versed


class Jet:
    """A polynomial of degree two in a small time."""

    def __init__(self, a, b=D(0), c=D(0)):
        self.c = (a, b, c)

    def __add__(self, other):
        return Jet(*(a + b for a, b in zip(self.c, other.c)))

    def __sub__(self, other):
        return Jet(*(a - b for a, b in zip(self.c, other.c)))

    def __mul__(self, other):
        if not isinstance(other, Jet):
            return Jet(*(a * other for a in self.c))
        (a, b, c), (d, e, f) = self.c, other.c
        return Jet(a * d, a * e + b * d, a * f + b * e + c * d)

    def __truediv__(self, other):
        (a, b, c), (d, e, f) = self.c, other.c
        x = a / d
        y = (b - x * e) / d
        return Jet(x, y, (c - x * f - y * e) / d)


ZERO = Jet(D(0))


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def minus(a, b):
    return tuple(x - y for x, y in zip(a, b))


def ring(u, v):
    """Along `u' = cos(u) sin(v)`: the corners and the axes of the hinges as a rod that is the ground sees them."""
    (su, cu), (sv, cv) = sine_cosine(u), sine_cosine(v)
    # u' = cu sv, u'' = -su sv u' + cu cv v'; v' = -su cv, v'' = -cu cv u' + su sv v'.
    du, dv = cu * sv, -su * cv
    ddu, ddv = -su * sv * du + cu * cv * dv, -cu * cv * du + su * sv * dv
    sin_u = Jet(su, cu * du, (cu * ddu - su * du * du) / 2)
    cos_u = Jet(cu, -su * du, (-su * ddu - cu * du * du) / 2)
    sin_v = Jet(sv, cv * dv, (cv * ddv - sv * dv * dv) / 2)
    cos_v = Jet(cv, -sv * dv, (-sv * ddv - cv * dv * dv) / 2)
    inner, outer = cos_v * (2 / ROOT), cos_u * (2 / ROOT)
    height = sin_u * sin_v * (1 / ROOT)
    turns = [(D(1), D(0)), (D(1) / 2, ROOT / 2), (D(-1) / 2, ROOT / 2), (D(-1), D(0)), (D(-1) / 2, -ROOT / 2), (D(1) / 2, -ROOT / 2)]
    corners, hinges = [], []
    for k, (c, s) in enumerate(turns):
        radius, up = (inner, height) if k % 2 == 0 else (outer, ZERO - height)
        corners.append((radius * c, radius * s, up))
        # In the plane through the axis and the corner: across the line between its neighbours, and across what leads there.
        if k % 2 == 0:
            aside, along = sin_v * (-2 / ROOT), sin_u / cos_u * (1 / ROOT)
        else:
            aside, along = sin_u * (2 / ROOT), sin_v / cos_v * (1 / ROOT)
        hinges.append((aside * c, aside * s, along))
    x = minus(corners[0], corners[5])
    z = hinges[0]
    y = cross(z, x)
    see = lambda a: (dot(x, a), dot(y, a), dot(z, a))
    return [see(minus(p, corners[0])) for p in corners], [see(z) for z in hinges]


def square_of_rate(a):
    """The square of the rate of a vector, to first order."""
    total = [D(0), D(0)]
    for entry in a:
        _, b, c = entry.c
        total[0] += b * b
        total[1] += 4 * b * c
    return total


def energy(u, v):
    """`M`, `M'`, `V`, `V'`."""
    corners, hinges = ring(u, v)
    inertia, slope, potential, force = D(0), D(0), D(0), D(0)
    for i in range(5):
        rod = minus(corners[i + 1], corners[i])
        center = tuple((a + b) * (D(1) / 2) for a, b in zip(corners[i + 1], corners[i]))
        across = cross(hinges[i], rod)
        # The spin about the rod.
        rate = sum(a.c[1] * b.c[0] for a, b in zip(across, hinges[i]))
        rate_slope = sum(2 * a.c[2] * b.c[0] + a.c[1] * b.c[1] for a, b in zip(across, hinges[i]))
        for weight, (value, first) in ((MASS, square_of_rate(center)), (ACROSS, square_of_rate(rod))):
            inertia += weight * value
            slope += weight * first
        inertia += ALONG * rate * rate
        slope += 2 * ALONG * rate * rate_slope
        potential += MASS * G * center[1].c[0]
        force += MASS * G * center[1].c[1]
    return inertia, slope, potential, force


def rates(x):
    u, v, w = x
    (su, cu), (sv, cv) = sine_cosine(u), sine_cosine(v)
    inertia, slope, _, force = energy(u, v)
    return [w * cu * sv, -w * su * cv, -(w * w * slope / 2 + force) / inertia]


def step(x, h, columns):
    """Extrapolated midpoint rules."""
    table = []
    begin = rates(x)
    for k in range(columns):
        n = 2 * (k + 1)
        d = h / n
        old, new = x, [a + d * b for a, b in zip(x, begin)]
        for _ in range(n - 1):
            old, new = new, [a + 2 * d * b for a, b in zip(old, rates(new))]
        smooth = [(a + b + d * c) / 2 for a, b, c in zip(new, old, rates(new))]
        row = [smooth]
        for j in range(k):
            ratio = D(k + 1) / D(k - j)
            row.append([a + (a - b) / (ratio * ratio - 1) for a, b in zip(row[j], table[j])])
        table = row
    return table[-1]


START = [PI / 4, PI / 4, D(0)]


def checked():
    """The ring is closed by rods of one metre, and hinges that follow each other stand at right angles."""
    v = D("0.9")
    _, cv = sine_cosine(v)
    u = D("0.6")
    for _ in range(60):
        su, cu = sine_cosine(u)
        u += (cu * cv - D(1) / 2) / (su * cv)
    corners, hinges = ring(u, v)
    for k in range(6):
        rod, following = minus(corners[(k + 1) % 6], corners[k]), hinges[(k + 1) % 6]
        found = [dot(rod, rod).c[0] - 1, dot(rod, rod).c[1], dot(rod, hinges[k]).c[0], dot(rod, following).c[0], dot(hinges[k], following).c[0], dot(hinges[k], hinges[k]).c[0] - 1]
        assert max(abs(e) for e in found) < D(10) ** -38, (k, found)


def run(h, columns):
    x, t, found = list(START), D(0), []
    whole = energy(x[0], x[1])[2]
    for end in TIMES:
        count = int(((end - t) / h).to_integral_value(rounding="ROUND_CEILING"))
        for _ in range(count):
            x = step(x, (end - t) / count, columns)
        t = end
        inertia, _, potential, _ = energy(x[0], x[1])
        print(h, t, x[0], "energy off by", inertia * x[2] * x[2] / 2 + potential - whole, file=sys.stderr)
        # Both angles and their rates, of the hinges.
        du, dv, _ = rates(x)
        found.append([2 * x[0], 2 * x[1], 2 * du, 2 * dv])
    return found


def digits(a, b):
    """The digits in which two numbers agree, at most 25."""
    count = 25
    while count and f"{a:.{count}e}" != f"{b:.{count}e}":
        count -= 1
    return f"{b:.{count}e}"


def main():
    checked()
    runs = [run(D("0.05"), 13), run(D("0.035"), 13)]
    print("# t, angle of the first hinge, of the second, their rates")
    for t, a, b in zip(TIMES, *runs):
        print(t, *(digits(*pair) for pair in zip(a, b)))


main()
