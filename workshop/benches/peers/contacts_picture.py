"""The picture of `contacts.py`: the error of the end of a run against its time, a panel for each scene, as SVG."""

import math

INKS = {"guen": "#0B62A8", "scipy": "#B8460E", "heyoka": "#0F7B5C", "drake": "#8E3A80", "mujoco": "#7A5C00"}
TITLES = {"bouncing_ball": "a ball that bounces to rest", "pendulum_stop": "a pendulum with a stop", "stick_slip_belt": "a block on a belt"}
WIDTH, HEIGHT, LEFT, TOP, BOTTOM = 300, 320, 46, 44, 44
# Exponents of ten at the ends of the axes; smaller errors are drawn at the lower end.
TIMES, ERRORS = (0, 7), (-16, 2)


def drawn(runs):
    parts = []
    for number, (scene, title) in enumerate(TITLES.items()):
        x0, x1 = number * WIDTH + LEFT, (number + 1) * WIDTH - 8
        y0, y1 = HEIGHT - BOTTOM, TOP
        x = lambda us: x0 + (x1 - x0) * (math.log10(us) - TIMES[0]) / (TIMES[1] - TIMES[0])
        y = lambda error: y0 - (y0 - y1) * (min(max(math.log10(error), ERRORS[0]), ERRORS[1]) - ERRORS[0]) / (ERRORS[1] - ERRORS[0])
        parts.append(f'<text x="{x0}" y="{y1 - 8}" font-weight="600">{title}</text>')
        for power in range(ERRORS[0], ERRORS[1] + 1, 3):
            parts.append(f'<path d="M{x0} {y(10.0**power):.1f}H{x1}" class="grid"/><text x="{x0 - 5}" y="{y(10.0**power) + 4:.1f}" text-anchor="end">1e{power}</text>')
        for power in range(TIMES[0], TIMES[1], 2):
            name = {0: "1 µs", 2: "0.1 ms", 4: "10 ms", 6: "1 s"}[power]
            parts.append(f'<path d="M{x(10.0**power):.1f} {y0}V{y1}" class="grid"/><text x="{x(10.0**power):.1f}" y="{y0 + 16}" text-anchor="middle">{name}</text>')
        for tool, ink in INKS.items():
            points = [(x(run["us"]), y(max(run["end_error"], 1e-300))) for run in runs if run["scene"] == scene and run["tool"] == tool]
            if points:
                parts.append(f'<polyline points="{" ".join(f"{a:.1f},{b:.1f}" for a, b in points)}" fill="none" stroke="{ink}" stroke-width="1.4"/>')
                parts.extend(f'<circle cx="{a:.1f}" cy="{b:.1f}" r="2.6" fill="{ink}"/>' for a, b in points)
    for number, (tool, ink) in enumerate(INKS.items()):
        parts.append(f'<circle cx="{LEFT + 90 * number}" cy="12" r="4" fill="{ink}"/><text x="{LEFT + 90 * number + 9}" y="16">{tool}</text>')
    parts.append(f'<text x="{LEFT}" y="{HEIGHT - 8}">across: the time of a run; up: the largest error of the state at its end</text>')
    style = "text{font:12px system-ui,sans-serif;fill:#1d2126}.grid{stroke:#d5d9de;stroke-width:1}"
    size = f'viewBox="0 0 {3 * WIDTH} {HEIGHT}" width="{3 * WIDTH}" height="{HEIGHT}"'
    return f'<svg xmlns="http://www.w3.org/2000/svg" {size}>\n<title>Error against time of five tools on three scenes with contacts</title>\n<style>{style}</style>\n<rect width="100%" height="100%" fill="#fff"/>\n' + "\n".join(parts) + "\n</svg>\n"
