"""The stiff flyball governor of the IFToMM library (A05) in 30 digits: prints `governor.txt`.

    python3 tests/data/governor.py > tests/data/governor.txt        # some minutes

Shares nothing with the declaration in `tests/motion/published/governor.rs`: by symmetry both arms move alike and the moment of momentum about the
shaft is kept, so that the angle `q` of the arms from the downward vertical and the height `z` of the slider are left,

    A q'' = w^2 J'(q)/2 - dV/dq - C d' dd/dq        2 (m l^2/4 + i + M l^2) = A
    B z'' = -dV/dz - C d' dd/dz                     w = w0 J(q0)/J(q)

with two spring-dampers of length `d` between the slider's sides and the middles of the arms. Radau's collocation with 12 stages, of order 23, in 45
digits of Python's `decimal`, twice: what both runs agree in is printed.
"""

import sys
from decimal import Decimal as D, getcontext

getcontext().prec = 45
STAGES = 12
TIMES = [D("0.001"), D("0.1"), D(1), D(5), D(10)]


def sine_cosine(x):
    """By their series at x/64, doubled six times."""
    x = x / 64
    square, term, sine, versed, n = x * x, x, x, D(0), 1
    while abs(term) > D(10) ** -52:
        term = term * x / (n + 1)  # x^(n+1)/(n+1)!
        versed += term if n % 4 == 1 else -term
        term = term * x / (n + 2)
        sine += -term if n % 4 == 1 else term
        n += 2
    # 1 - cos is kept, which loses nothing.
    for _ in range(6):
        sine, versed = 2 * sine * (1 - versed), 2 * sine * sine
    return sine, 1 - versed


PI = D("3.14159265358979323846264338327950288419716939937510582")
RHO, SIDE, CUBE, BALL, OFF = D(3000), D("0.01"), D("0.1"), D(5), D("0.05")
L, G, K, C, D0 = D(1), D("9.81"), D(800000), D(40000), D("0.5")
ROD = RHO * L * SIDE * SIDE
SLIDER = RHO * CUBE**3
ACROSS = ROD * (L * L + SIDE * SIDE) / 12
ALONG = ROD * SIDE * SIDE / 6
STILL = ALONG + SLIDER * CUBE * CUBE / 6
A = 2 * (ROD * L * L / 4 + ACROSS + BALL * L * L)
WEIGHT = 2 * (ROD * L / 2 + BALL * L) * G


def moment(s, c):
    """The moment of inertia about the shaft and half its derivative by the angle."""
    middle, end = OFF + L / 2 * s, OFF + L * s
    whole = STILL + 2 * (ROD * middle * middle + ACROSS * s * s + ALONG * c * c + BALL * end * end)
    half = 2 * (ROD * middle * L / 2 + (ACROSS - ALONG) * s + BALL * end * L) * c
    return whole, half


START = PI / 3
MOMENTUM = 2 * PI * moment(*sine_cosine(START))[0]


def rates(x):
    q, z, dq, dz, _ = x
    s, c = sine_cosine(q)
    inertia, half = moment(s, c)
    w = MOMENTUM / inertia
    across, up = L / 2 * s, L - L / 2 * c - z
    d = (across * across + up * up).sqrt()
    by_q, by_z = L / 2 * (across * c + up * s) / d, -up / d
    force = 2 * (K * (d - D0) + C * (by_q * dq + by_z * dz))
    return [dq, dz, (w * w * half - WEIGHT * s - force * by_q) / A, -G - force * by_z / SLIDER, w]


def polynomial(roots):
    p = [D(1)]
    for r in roots:
        p = [a - r * b for a, b in zip([D(0)] + p, p + [D(0)])]
    return p


def value(p, x):
    total = D(0)
    for a in reversed(p):
        total = total * x + a
    return total


def tableau(s):
    """Nodes of Radau IIA on (0, 1], and the matrix."""
    p = [D(0)] * (2 * s)
    binomial = 1
    for k in range(s + 1):  # x^(s-1) (x - 1)^s
        p[s - 1 + k] = D(binomial * (-1) ** (s - k))
        binomial = binomial * (s - k) // (k + 1)
    for _ in range(s - 1):
        p = [k * a for k, a in enumerate(p)][1:]
    p = p[: s + 1]
    slope = [k * a for k, a in enumerate(p)][1:]
    nodes, grid = [], [D(i) / 4000 for i in range(4002)]
    for low, high in zip(grid, grid[1:]):
        if value(p, low) * value(p, high) <= 0 and value(p, high) != 0 or value(p, high) == 0:
            x = (low + high) / 2
            for _ in range(60):
                x -= value(p, x) / value(slope, x)
            if not nodes or abs(nodes[-1] - x) > D("1e-9"):
                nodes.append(x)
    assert len(nodes) == s, nodes
    nodes[-1] = D(1)
    matrix = []
    bases = []
    for j, c in enumerate(nodes):
        base = polynomial(nodes[:j] + nodes[j + 1 :])
        scale = value(base, c)
        bases.append([a / scale / (k + 1) for k, a in enumerate(base)])
    for c in nodes:
        matrix.append([c * value(b, c) for b in bases])
    return nodes, matrix


def factored(m):
    n, order = len(m), []
    for k in range(n):
        p = max(range(k, n), key=lambda i: abs(m[i][k]))
        m[k], m[p] = m[p], m[k]
        order.append(p)
        top = m[k]
        for i in range(k + 1, n):
            row = m[i]
            if row[k]:
                f = row[k] = row[k] / top[k]
                for j in range(k + 1, n):
                    row[j] -= f * top[j]
    return m, order


def solved(lu, b):
    m, order = lu
    n = len(b)
    for k, p in enumerate(order):
        b[k], b[p] = b[p], b[k]
    for k in range(n):
        for i in range(k + 1, n):
            b[i] -= m[i][k] * b[k]
    for k in reversed(range(n)):
        b[k] = (b[k] - sum(m[k][j] * b[j] for j in range(k + 1, n))) / m[k][k]
    return b


def jacobian(x):
    """By differences, which is good enough for Newton's method: the first four rates by the first four entries."""
    delta, begin = D(10) ** -22, rates(x)
    columns = []
    for i in range(4):
        y = list(x)
        y[i] += delta
        columns.append([(a - b) / delta for a, b in zip(rates(y), begin)])
    return [[columns[j][i] for j in range(4)] for i in range(4)]


def step(x, h, rule):
    nodes, matrix = rule
    s = len(nodes)
    j = jacobian(x)
    system = [
        [(D(1) if a == b and i == k else D(0)) - h * matrix[a][b] * j[i][k] for b in range(s) for k in range(4)]
        for a in range(s)
        for i in range(4)
    ]
    lu = factored(system)
    change = [[D(0)] * 4 for _ in range(s)]
    for _ in range(200):
        slopes = [rates([a + b for a, b in zip(x, c)] + [D(0)]) for c in change]
        rest = [h * sum(matrix[a][b] * slopes[b][i] for b in range(s)) - change[a][i] for a in range(s) for i in range(4)]
        correction = solved(lu, rest)
        for a in range(s):
            for i in range(4):
                change[a][i] += correction[4 * a + i]
        if max(abs(e) for e in correction) < D(10) ** -39:
            break
    else:
        raise ArithmeticError("Newton's method")
    slopes = [rates([a + b for a, b in zip(x, c)] + [D(0)])[4] for c in change]
    turned = x[4] + h * sum(w * slope for w, slope in zip(matrix[-1], slopes))
    return [a + b for a, b in zip(x, change[-1])] + [turned]


def run(longest):
    rule = tableau(STAGES)
    x, t, h, found = [START, D("0.5"), D(0), D(0), D(0)], D(0), longest / 1000, []
    for end in TIMES:
        while t < end:
            now = min(h, end - t)
            if end - t - now < now / 100:
                now = end - t
            x, t = step(x, now, rule), t + now
            h = min(h * D("1.25"), longest)
        found.append(x)
        print(longest, t, x[0], file=sys.stderr)
    return found


def digits(a, b):
    """The digits in which two numbers agree, at most 25."""
    count = 25
    while count and f"{a:.{count}e}" != f"{b:.{count}e}":
        count -= 1
    return f"{b:.{count}e}"


def main():
    runs = [run(D(text)) for text in sys.argv[1:3]] if len(sys.argv) > 2 else [run(D("0.02")), run(D("0.013"))]
    print("# t, angle of the arms from the downward vertical, height of the slider, their rates, angle of the shaft")
    for t, a, b in zip(TIMES, *runs):
        print(t, *(digits(*pair) for pair in zip(a, b)))


main()
