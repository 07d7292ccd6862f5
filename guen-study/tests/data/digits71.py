"""Values that tests/digits71.rs compares with, by mpmath in 400 bits:

    pip install mpmath==1.4.1
    python digits71.py > digits71.txt

A line is a function, its arguments, a semicolon and the value in 80 digits. An argument is exact: a list of
`mantissa:exponent` whose sum, with `mantissa * 2^exponent`, it is; each mantissa fits 63 bits.
"""

import random

from mpmath import mp, mpf

mp.prec = 400
draw = random.Random(1969)


def number(low, high):
    """A number of 237 bits between the bounds, as parts and as a value."""
    while True:
        # 3 parts of 62 bits and one of 51.
        exponent = draw.randint(low, high)
        parts, place = [], exponent
        for bits in (62, 62, 62, 51):
            place -= bits
            mantissa = draw.getrandbits(bits) | (1 << (bits - 1) if not parts else 0)
            parts.append((mantissa, place))
        if draw.random() < 0.5:
            parts = [(-m, e) for m, e in parts]
        return parts


def value(parts):
    return sum((mpf(m) * mpf(2) ** e for m, e in parts), mpf(0))


def show(name, arguments, result):
    texts = [",".join(f"{m}:{e}" for m, e in parts) for parts in arguments]
    print(name, *texts, ";", mp.nstr(result, 80, strip_zeros=False, min_fixed=1, max_fixed=0))


def positive(parts):
    return [(abs(m), e) for m, e in parts]


ONE = {
    "sqrt": (mp.sqrt, -60, 60, positive),
    "root3": (lambda x: mp.sign(x) * mp.cbrt(abs(x)), -60, 60, None),
    "root5": (lambda x: mp.sign(x) * mp.root(abs(x), 5), -60, 60, None),
    "exp": (mp.exp, -40, 6, None),
    "ln": (mp.log, -80, 80, positive),
    "sin": (mp.sin, -40, 40, None),
    "cos": (mp.cos, -40, 40, None),
    "tan": (mp.tan, -40, 20, None),
    "asin": (mp.asin, -40, 0, None),
    "acos": (mp.acos, -40, 0, None),
    "atan": (mp.atan, -40, 40, None),
    "sinh": (mp.sinh, -40, 5, None),
    "cosh": (mp.cosh, -40, 5, None),
    "tanh": (mp.tanh, -40, 5, None),
}
for name, (function, low, high, restrict) in ONE.items():
    for _ in range(60):
        x = number(low, high)
        x = restrict(x) if restrict else x
        show(name, [x], function(value(x)))
# Close to multiples of pi/2, and to one where the logarithm vanishes.
for k in (1, 2, 3, 7, 100, 12345):
    m = int(mp.floor(k * mp.pi / 2 * mpf(2) ** 40))
    for name in ("sin", "cos", "tan"):
        show(name, [[(m, -40)]], ONE[name][0](mpf(m) * mpf(2) ** -40))
for k in (20, 40, 60):
    x = [(1, 0), (1, -k)]
    show("ln", [x], mp.log(value(x)))
TWO = {
    "add": lambda x, y: x + y,
    "subtract": lambda x, y: x - y,
    "multiply": lambda x, y: x * y,
    "divide": lambda x, y: x / y,
    "atan2": lambda y, x: mp.atan2(y, x),
}
for name, function in TWO.items():
    for _ in range(60):
        x, y = number(-20, 20), number(-20, 20)
        show(name, [x, y], function(value(x), value(y)))
show("pi", [], mp.pi)
