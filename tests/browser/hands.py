#!/usr/bin/env python3
"""What hands do on the pages, in a real browser: curves switched and folded, values read, time zoomed, things saved.

    python3 tests/browser/hands.py                     # runs the example and tests its pages
    python3 tests/browser/hands.py --pictures FOLDER   # keeps screenshots as well

Exits with 0 if all is well, 1 if a page fails, 77 if there is no browser and none can be installed.
"""

import argparse
import base64
import csv
import pathlib
import struct
import subprocess
import sys
import tempfile
import time

from browser import Browser
from checks import Failure, ended, kept, require
from looks import CONTRAST, INKS, LOOKS, PLACES, WIDTHS, varied
from place import ROOT, target
from viewer import TIME, load, quiet, scene, settled

ESCAPE, TAB, LEFT, RIGHT, SHIFT = "\ue00c", "\ue004", "\ue012", "\ue014", "\ue008"

# In the page: the pixels of a plot, from a copy.
COPY = """
const pixels = (canvas) => {
  const { width, height } = canvas;
  const pen = Object.assign(document.createElement('canvas'), { width, height }).getContext('2d', { willReadFrequently: true });
  pen.drawImage(canvas, 0, 0);
  return pen.getImageData(0, 0, width, height).data;
};
"""

# In the page: how many pixels of a plot have a colour.
PIXELS = COPY + """
const canvas = document.querySelectorAll('figure canvas')[arguments[0]];
const wanted = [1, 3, 5].map((k) => parseInt(arguments[1].slice(k, k + 2), 16));
const data = pixels(canvas);
let count = 0;
for (let k = 0; k < data.length; k += 4) if (data[k + 3] > 250 && wanted.every((c, i) => Math.abs(data[k + i] - c) < 12)) count += 1;
return count;
"""

# In the page: how far the first curve is drawn from where the samples of the page have it, in pixels, at its worst of many
# columns; the part of them in which it is drawn; and the least and the greatest of its values between the samples.
ASTRAY = COPY + """
const canvas = document.querySelector('figure canvas');
const { span, motion: { curves: [{ times, values, base }] } } = window.guen;
const wanted = [1, 3, 5].map((k) => parseInt(arguments[0].slice(k, k + 2), 16));
const [left, low, high] = ['left', 'low', 'high'].map((name) => Number(canvas.dataset[name]));
const { width, height } = canvas;
const data = pixels(canvas);
const value = (t) => {
  const k = Math.max(0, times.findIndex((later) => later >= t) - 1);
  return base + values[k] + ((values[k + 1] - values[k]) * (t - times[k])) / (times[k + 1] - times[k]);
};
let [worst, seen, least, most] = [0, 0, Infinity, -Infinity];
for (let k = 0; k <= 400; k += 1) {
  const there = value(span.from + ((span.to - span.from) * k) / 400);
  [least, most] = [Math.min(least, there), Math.max(most, there)];
}
for (let x = Math.ceil(left) + 3; x < width - 12; x += 5) {
  const t = span.from + ((x + 0.5 - left) / (width - left - 8)) * (span.to - span.from);
  const drawn = [];
  for (let y = 0; y < height - 20; y += 1) {
    const at = 4 * (y * width + x);
    if (data[at + 3] > 120 && wanted.every((c, i) => Math.abs(data[at + i] - c) < 60)) drawn.push(y + 0.5);
  }
  if (drawn.length === 0) continue;
  seen += 1;
  const there = 6 + ((height - 26) * (high - value(t))) / (high - low);
  worst = Math.max(worst, Math.min(...drawn.map((y) => Math.abs(y - there))));
}
return [worst, seen / Math.floor((width - left - 15) / 5), least, most];
"""

RANGE = """
const { curves } = window.guen.motion.panels[arguments[0]];
const all = arguments[1].flatMap((k) => [...curves[k].values].map((value) => curves[k].base + value));
return [Math.min(...all), Math.max(...all)];
"""


def axis(browser, panel):
    """The least and the greatest value of a panel's axis."""
    return browser.run("const { low, high } = document.querySelectorAll('figure canvas')[arguments[0]].dataset; return [Number(low), Number(high)];", panel)


def fits(found, wanted):
    """Whether an axis shows a range, with a little room."""
    room = 0.061 * (wanted[1] - wanted[0])
    return all(abs(a - b) <= room for a, b in zip(found, wanted)) and found[0] < wanted[0] and found[1] > wanted[1]


def bounds(browser, selector, which=0):
    return browser.run("const b = document.querySelectorAll(arguments[0])[arguments[1]].getBoundingClientRect(); return [b.x, b.y, b.width, b.height];", selector, which)


def span(browser):
    return browser.run("return [window.guen.span.from, window.guen.span.to, window.guen.motion.end];")


def press_all(browser, *keys):
    """Keys held down together."""
    strokes = [{"type": "keyDown", "value": key} for key in keys] + [{"type": "keyUp", "value": key} for key in reversed(keys)]
    browser.call("actions", {"actions": [{"type": "key", "id": "keyboard", "actions": strokes}]})


def in_plot(browser, part, which=0):
    """A point of the window: a part of a plot's time."""
    browser.run("document.querySelectorAll('figure canvas')[arguments[0]].scrollIntoView({ block: 'center' });", which)
    x, y, width, height = bounds(browser, "figure canvas", which)
    left = float(browser.run("return document.querySelectorAll('figure canvas')[arguments[0]].dataset.left;", which))
    return round(x + left + (width - left - 8) * part), round(y + height / 2)


def switched(browser, page, pictures):
    """Curves are switched on and off, panels folded; the axis fits what is shown."""
    browser.scheme("light")
    browser.resize(1000, 640)
    load(browser, page)
    both, first = browser.run(RANGE, 1, [0, 1]), browser.run(RANGE, 0, [0])
    require(fits(axis(browser, 1), both), "the axis does not fit both curves")
    require(browser.run(PIXELS, 0, INKS[1]) > 50, "the second curve is not drawn at first")
    second = "figure:first-of-type span:nth-of-type(2) .curve"
    state = f"return document.querySelector('{second}').getAttribute('aria-pressed');"
    browser.click(second)
    settled(browser)
    require(browser.run(state) == "false", "a click does not switch a curve off")
    require(browser.run(PIXELS, 0, INKS[1]) == 0, "a curve that is off is drawn")
    require(fits(axis(browser, 0), first), f"the axis shows {axis(browser, 0)} of a curve from {first}")
    # By the keyboard: Tab reaches it, the space bar presses it, and does not play.
    browser.run(f"document.querySelector('{second}').focus();")
    for _ in range(2):
        browser.press(" ")
    settled(browser)
    require(browser.run(state) == "false" and not browser.run("return window.guen.player.state.playing;"), "the space bar does not press the button of a curve")
    reached = browser.run("return [...document.querySelectorAll('figure button, figure canvas')].every((e) => e.tabIndex === 0);")
    require(reached, "the keyboard does not reach all of a panel")
    # A panel is folded, and has no height to speak of.
    before = bounds(browser, "figure", 1)[3]
    browser.click("figure:nth-of-type(2) .fold")
    settled(browser)
    require(bounds(browser, "figure", 1)[3] < before / 2, "a folded panel is as high as before")
    require(browser.run("return document.querySelectorAll('.fold')[1].getAttribute('aria-expanded');") == "false", "a folded panel says otherwise")
    everywhere(browser, "switched", pictures)
    # Paper shows only what is on.
    browser.scheme("light", media="print")
    settled(browser)
    seen = browser.run("return [...document.querySelectorAll('figure')].map((f) => [f.checkVisibility(), [...f.querySelectorAll('span')].filter((s) => s.checkVisibility()).length]);")
    require(seen[:2] == [[True, 1], [False, 0]] and all(on for on, _ in seen[2:-1]), f"paper shows {seen}")
    require(browser.run(PIXELS, 0, INKS[1]) == 0 and browser.run(PIXELS, 0, INKS[0]) > 50, "paper does not show what is on")
    browser.scheme("light")
    # Everything off: an empty panel, and no complaint.
    for _ in range(2):
        browser.run("document.querySelectorAll('.fold')[1].click(); document.querySelectorAll('figure .curve[aria-pressed=true]').forEach((b) => b.click());")
        settled(browser)
    quiet(browser)


def everywhere(browser, name, pictures):
    """The page as it is, at all widths and in all themes: nothing sticks out, everything has contrast."""
    for look, (scheme, others) in LOOKS.items():
        if look == "paper":
            continue
        browser.scheme(scheme, **others)
        for width, height in WIDTHS.items():
            browser.resize(width, height, mobile=width == 390)
            settled(browser)
            where = f"{name}, {width} wide, {look}"
            wrong = browser.run(PLACES, width)
            require(not wrong, f"{where}: {wrong}")
            low = [found for found in browser.run(CONTRAST) if found[0] < 1]
            require(not low, f"{where}: too little contrast: {low}")
            kept(pictures, f"hands-{name}-{look}-{width}", browser.picture)
    browser.scheme("light")
    browser.resize(1000, 640)
    settled(browser)


def near(found, wanted, part=0.02):
    """Whether two spans are one, to a part of the motion."""
    return all(abs(a - b) <= part * found[2] for a, b in zip(found, wanted))


def zoomed(browser, page, pictures):
    """The time is zoomed by the mouse, the wheel, the keys and two fingers, and read under the pointer."""
    browser.scheme("light")
    browser.resize(1000, 640)
    load(browser, page)
    end = span(browser)[2]
    browser.drag(in_plot(browser, 0.25), in_plot(browser, 0.5))
    settled(browser)
    require(near(span(browser), (end / 4, end / 2)), f"a drag shows {span(browser)}")
    require(browser.run(f"return {TIME};") == 0, "a drag sets the time")
    marks = browser.run("return document.getElementById('part').checkVisibility() && document.querySelector('#part span').textContent;")
    require(marks and marks.endswith(" s") and " to " in marks, f"the page says of the part: {marks}")
    everywhere(browser, "zoomed", pictures)
    # The other curves off, the first one is where its samples are, however near one comes.
    browser.run("document.querySelectorAll('figure:first-of-type .curve')[1].click();")
    for from_, to in ((0, 1), (0.25, 0.5), (0.3, 0.31), (0.30031, 0.30187)):
        browser.run("const { span, motion } = window.guen; span.set(arguments[0] * motion.end, arguments[1] * motion.end);", from_, to)
        settled(browser)
        worst, drawn, *range_ = browser.run(ASTRAY, INKS[0])
        # Under the dots of the samples and the cursor no pixel has the colour of the line alone.
        require(drawn > 0.9 and worst < 1.6, f"from {from_} to {to} the curve is {worst} pixels astray, and drawn in {drawn} of the columns")
        require(fits(axis(browser, 0), range_), f"from {from_} to {to} the axis shows {axis(browser, 0)} of {range_}")
    # What runs out of the part turns over to the next one.
    browser.run("const { span, motion, player } = window.guen; span.set(0, motion.end / 4); player.setTime(motion.end / 5);")
    settled(browser)
    browser.run("window.guen.player.setTime(0.3 * window.guen.motion.end);")
    settled(browser)
    require(near(span(browser), (end / 4, end / 2)), f"the next page is {span(browser)}")

    # Back: a double click, Escape, 0 in the plot, the button.
    x, y = in_plot(browser, 0.5)
    clicks = [{"type": "pointerMove", "origin": "viewport", "duration": 0, "x": x, "y": y}, *[{"type": kind, "button": 0} for kind in ("pointerDown", "pointerUp") * 2]]
    ways = {
        "a double click": lambda: browser.call("actions", {"actions": [{"type": "pointer", "id": "mouse", "actions": clicks}]}),
        "Escape": lambda: browser.press(ESCAPE),
        "the button": lambda: browser.click("#part button"),
        "0 in the plot": lambda: (browser.run("document.querySelector('figure canvas').focus();"), browser.press("0")),
    }
    for way, does in ways.items():
        browser.run("const { span, motion } = window.guen; span.set(motion.end / 4, motion.end / 3);")
        settled(browser)
        does()
        settled(browser)
        require(span(browser)[:2] == [0, end] and browser.run("return document.getElementById('part').hidden;"), f"{way} does not show the whole time")

    # The wheel with Ctrl keeps the time below the pointer, and without it scrolls.
    x, y = in_plot(browser, 0.75)
    wheel = "document.querySelector('figure canvas').dispatchEvent(Object.assign(new WheelEvent('wheel', { deltaY: -100, ctrlKey: arguments[0], clientX: arguments[1], cancelable: true, bubbles: true })));"
    browser.run(wheel, False, x)
    require(span(browser)[:2] == [0, end], "the wheel alone zooms")
    browser.run(wheel, True, x)
    found = span(browser)
    require(found[1] - found[0] < 0.8 * end and abs((0.75 * end - found[0]) / (found[1] - found[0]) - 0.75) < 0.01, f"the wheel shows {found}")
    # The keyboard, with the plot in focus: nearer, farther, aside. The view stays as it is.
    eye = "return window.guen.stage.camera.position.toArray();"
    before = browser.run(eye)
    browser.press(ESCAPE)
    browser.run("document.querySelector('figure canvas').focus(); window.guen.player.setTime(window.guen.motion.end / 2);")
    settled(browser)
    browser.press("+")
    require(near(span(browser), (end / 6, end * 5 / 6)), f"plus shows {span(browser)}")
    press_all(browser, SHIFT, RIGHT)
    require(near(span(browser), (end / 3, end)), f"shift and the arrow show {span(browser)}")
    press_all(browser, SHIFT, LEFT)
    browser.press("-")
    require(span(browser)[:2] == [0, end], f"minus shows {span(browser)}")
    require(browser.run(eye) == before, "keys of a plot move the eye")

    # Below the pointer all panels read the values at its time.
    move = {"type": "pointerMove", "origin": "viewport", "duration": 0}
    hover = lambda x, y: browser.call("actions", {"actions": [{"type": "pointer", "id": "mouse", "actions": [{**move, "x": x, "y": y}]}]})
    read = "return [...document.querySelectorAll('figcaption data')].map((d) => d.textContent);"
    browser.run("document.querySelectorAll('figure:first-of-type .curve')[1].click();")
    hover(*in_plot(browser, 0.2))
    settled(browser)
    hovered = browser.run(read)
    at = browser.run("return window.guen.probe.time;")
    require(abs(at - 0.2 * end) < 0.01 * end and browser.run(f"return {TIME};") == end / 2, "the pointer reads another time, or sets it")
    kept(pictures, "hands-hover", browser.picture)
    hover(5, 200)
    settled(browser)
    require(browser.run(read) != hovered and browser.run("return window.guen.probe.time;") is None, "the pointer has left, and is read")
    browser.run("window.guen.player.setTime(arguments[0]);", at)
    settled(browser)
    require(browser.run(read) == hovered and len(hovered) == 10, f"below the pointer it reads {hovered}")

    # Two fingers: what they hold stays below them. One finger sets the time.
    browser.resize(390, 844, mobile=True)
    browser.devtools("Emulation.setTouchEmulationEnabled", enabled=True, maxTouchPoints=2)
    settled(browser)
    touch = lambda kind, *points: browser.devtools("Input.dispatchTouchEvent", type=kind, touchPoints=[{"x": x, "y": y, "id": k} for k, (x, y) in enumerate(points)])
    hold, spread = [[in_plot(browser, part) for part in parts] for parts in ((0.4, 0.6), (0.1, 0.9))]
    touch("touchStart", hold[0])
    touch("touchStart", *hold)
    for k in range(1, 5):
        touch("touchMove", *[tuple(round(a + (b - a) * k / 4) for a, b in zip(*pair)) for pair in zip(hold, spread)])
    touch("touchEnd")
    settled(browser)
    # 0.4 and 0.6 of the time are at 0.1 and 0.9 of the plot.
    require(near(span(browser), (0.375 * end, 0.625 * end)), f"two fingers show {span(browser)}")
    browser.run("window.guen.span.reset();")
    settled(browser)
    touch("touchStart", in_plot(browser, 0.3))
    touch("touchEnd")
    settled(browser)
    require(abs(browser.run(f"return {TIME};") - 0.3 * end) < 0.01 * end, "a finger does not set the time")
    require(browser.run("return window.guen.probe.time;") is None, "a finger that is gone is read")
    browser.devtools("Emulation.setTouchEmulationEnabled", enabled=False)
    quiet(browser)


# In the page: colours of the picture where the tips of a body's axes have to be, nearer to the eye than the body; by its pose alone.
TIPS = """
const { stage, motion, player } = window.guen;
const { camera } = stage;
const { poses, times } = motion.bodies[0];
const k = times.findIndex((t) => t >= player.state.time);
const [x, y, z, a, b, c, w] = poses.subarray(7 * k, 7 * k + 7);
const columns = [
  [1 - 2 * (b * b + c * c), 2 * (a * b + w * c), 2 * (a * c - w * b)],
  [2 * (a * b - w * c), 1 - 2 * (a * a + c * c), 2 * (b * c + w * a)],
  [2 * (a * c + w * b), 2 * (b * c - w * a), 1 - 2 * (a * a + b * b)],
];
stage.draw(false);
const space = document.getElementById('space');
const copy = Object.assign(document.createElement('canvas'), { width: space.width, height: space.height });
const pen = copy.getContext('2d', { willReadFrequently: true });
pen.drawImage(space, 0, 0);
const found = [];
columns.forEach((axis, i) => {
  const place = (part) => camera.position.clone().set(...[x, y, z].map((p, j) => p + part * motion.axes[0] * axis[j]));
  if (place(1).distanceTo(camera.position) > place(0).distanceTo(camera.position)) return;
  const at = stage.onScreen(place(0.86));
  const [r, g, b_] = pen.getImageData(at[0] * space.width / space.clientWidth, at[1] * space.height / space.clientHeight, 1, 1).data;
  found.push([i, [r, g, b_].indexOf(Math.max(r, g, b_)), [r, g, b_]]);
});
return found;
"""


def framed(browser, page, pictures):
    """Axes of bodies, names, and arrows are switched by buttons and keys."""
    browser.scheme("light")
    browser.resize(1000, 640)
    load(browser, page)
    seen = set()
    browser.press("a")
    for sample in range(3, 900, 41):
        browser.run("const { player, motion } = window.guen; player.setTime(motion.times[arguments[0]]);", sample)
        settled(browser)
        for axis_, colour, pixel in browser.run(TIPS):
            require(axis_ == colour, f"at sample {sample} the tip of axis {'xyz'[axis_]} has the colour {pixel}")
            seen.add(axis_)
    require(seen == {0, 1, 2}, f"only the axes {seen} were seen")
    require(browser.run("return document.getElementById('axes').getAttribute('aria-pressed');") == "true", "the button of the axes is not pressed")
    require(len(browser.run("return window.guen.motion.axes;")) == browser.run("return window.guen.motion.bodies.length;"), "a body has no axes")
    named = "return [...document.querySelectorAll('#labels span')].filter((s) => !s.hidden).map((s) => s.textContent);"
    browser.press("n")
    settled(browser)
    require(browser.run(named) == ["ball", "table", "force at the contact in N"], f"names: {browser.run(named)}")
    everywhere(browser, "framed", pictures)
    # What is hidden has no name and no axes; an arrow is switched like a body.
    for name, row in (("ball", 1), ("force at the contact in N", 3)):
        before = scene(browser)
        browser.run(f"document.querySelector('#legend li:nth-child({row}) input').click();")
        settled(browser)
        off = scene(browser)
        require(off != before and name not in browser.run(named), f"{name} is not switched off")
        browser.run(f"document.querySelector('#legend li:nth-child({row}) input').click();")
        settled(browser)
        require(scene(browser) != off and name in browser.run(named), f"{name} does not come back")
    framed_ = scene(browser)
    browser.run("document.getElementById('axes').click(); document.getElementById('names').click();")
    settled(browser)
    require(browser.run(named) == [] and scene(browser) != framed_, "axes or names stay")
    quiet(browser)


def residuals(browser, page):
    """What is left of each constraint is a panel that is folded until somebody asks."""
    browser.scheme("light")
    browser.resize(1000, 640)
    load(browser, page)
    last = "figure:last-of-type"
    inside = f"return [...document.querySelectorAll('{last} .curve')].filter((b) => b.checkVisibility()).map((b) => b.textContent);"
    require(browser.run(inside) == [], "residuals are shown at first")
    require(browser.run("return document.querySelectorAll('.fold[aria-expanded=false]').length;") == 1, "another panel is folded")
    browser.run(f"document.querySelector('{last} .fold').focus();")
    browser.press(" ")
    settled(browser)
    require(browser.run(inside) == ["rolling_x", "rolling_y", "length"], f"the curves are {browser.run(inside)}")
    browser.run("window.guen.player.setTime(20);")
    settled(browser)
    which = browser.run("return document.querySelectorAll('figure').length;") - 1
    require(browser.run(PIXELS, which, INKS[2]) > 50, "the residual of the length is not drawn")
    low, high = axis(browser, which)
    require(-1e-12 < low < high < 1e-12, f"residuals from {low} to {high}")
    quiet(browser)


def saved(browser, folder, ending, seconds=40):
    """The one file in a folder, when it is whole; it is taken away."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        found = list(folder.glob(f"*.{ending}"))
        if found and not list(folder.glob("*.crdownload")):
            content = found[0].read_bytes()
            require(found[0].stem == "A-ball-on-a-turntable", f"the file is called {found[0].name}")
            found[0].unlink()
            return content
        time.sleep(0.1)
    raise Failure(f"no file .{ending} is saved")


def menu(browser, name):
    browser.click("#more")
    browser.click(f"#{name}")


def kept_by_readers(browser, page, folder, pictures):
    """A picture, the values, a film, a link: by buttons and keys, and without network."""
    browser.scheme("light")
    browser.resize(1000, 640)
    load(browser, page)
    browser.devtools("Browser.setDownloadBehavior", behavior="allow", downloadPath=str(folder))
    browser.run("window.guen.player.setTime(4); document.getElementById('names').click();")
    browser.click("#more")
    settled(browser)
    everywhere(browser, "menu", pictures)
    browser.press(ESCAPE)
    require(browser.run("return document.getElementById('menu').hidden && document.activeElement.id === 'more';"), "Escape does not close the menu")

    for way in (lambda: menu(browser, "picture"), lambda: browser.press("p")):
        way()
        png = saved(browser, folder, "png")
        width, height = struct.unpack(">II", png[16:24])
        require(png[:8] == b"\x89PNG\r\n\x1a\n" and width == 1600 and height > 1000, f"a picture of {width} x {height}")
        colours = browser.run(
            """const image = new Image(); image.src = arguments[0]; return image.decode().then(() => {
              const pen = Object.assign(document.createElement('canvas'), { width: image.width, height: image.height }).getContext('2d', { willReadFrequently: true });
              pen.drawImage(image, 0, 0);
              const { data } = pen.getImageData(0, 0, image.width, image.height);
              let [faint, blue] = [0, 0];
              for (let k = 0; k < data.length; k += 4) { if (data[k + 3] < 255) faint += 1; if (data[k + 2] > data[k] + 90) blue += 1; }
              return [faint, blue]; });""",
            "data:image/png;base64," + base64.b64encode(png).decode(),
        )
        require(colours[0] == 0 and colours[1] > 500, f"pixels that are see-through and blue: {colours}")
        if pictures:
            (pathlib.Path(pictures) / "hands-saved.png").write_bytes(png)

    menu(browser, "values")
    head, *rows = csv.reader(saved(browser, folder, "csv").decode().splitlines())
    held = browser.run("const { curves, start } = window.guen.motion; return [start, curves.map((c) => c.name), curves.map((c) => [[...c.times], [...c.values].map((v) => c.base + v)])];")
    require(head[0] == "t in s" and [name.split(": ")[1] for name in head[1:]] == held[1] and head[1] == "place on the table in m: x", f"the heading is {head}")
    for k, (times, values) in enumerate(held[2]):
        found = [(float(row[0]), float(row[k + 1])) for row in rows if row[k + 1]]
        require(found == [(held[0] + t, v) for t, v in zip(times, values)], f"the values of {head[k + 1]} are not those of the page")

    # The address has it all, and another window shows it.
    browser.run("const { stage, player, span } = window.guen; stage.turn(0.7, 0.2); stage.zoom(0.6); span.set(2, 9); player.setTime(3.25);")
    settled(browser)
    eye = browser.run("return window.guen.stage.eye();")
    browser.press("k")
    settled(browser)
    address = browser.run("return location.href;")
    require("#t=3.25&camera=" in address and "part=2,9" in address, f"the address is {address}")
    told = browser.run("return document.getElementById('told').textContent;")
    require(told.startswith("The address of this page"), f"it is told: {told}")
    browser.open("about:blank")
    browser.open(address)
    browser.wait("document.documentElement.dataset.ready === 'true'", "the page is ready")
    settled(browser)
    found = browser.run(f"return [{TIME}, window.guen.span.from, window.guen.span.to, window.guen.stage.eye()];")
    require(found[:3] == [3.25, 2, 9] and all(abs(a - b) < 1e-6 for a, b in zip(found[3], eye)), f"the link shows {found}, not {eye}")
    # One that follows; and one that says nothing that can be understood.
    browser.press("f")
    browser.run("window.guen.stage.turn(0.5, 0);")
    settled(browser)
    browser.press("k")
    address, eye = browser.run("return [location.href, window.guen.stage.eye()];")
    browser.open("about:blank")
    browser.open(address)
    browser.wait("document.documentElement.dataset.ready === 'true'", "the page is ready")
    settled(browser)
    found = browser.run("return window.guen.stage.eye();")
    require("follow=0" in address and all(abs(a - b) < 1e-6 for a, b in zip(found, eye)), f"the link that follows shows {found}, not {eye}")
    require(browser.run("return document.getElementById('follow').getAttribute('aria-pressed');") == "true", "the link does not follow")
    before = browser.run("return window.guen.stage.eye();")
    for wrong in ("#t=NaN&camera=1,2", "#camera=a,b,c,d,e,f&t=", "#part=5,1&follow=99", "#%%%"):
        browser.run("location.hash = arguments[0];", wrong)
        settled(browser)
    require(browser.run("return window.guen.stage.eye();") == before and browser.run(f"return {TIME};") == 3.25, "an address without sense changes the view")

    # A link goes before what the page follows by itself.
    browser.open(f"{page.with_name('car.html').as_uri()}#t=2&camera=9,8,7,1,2,0")
    browser.wait("document.documentElement.dataset.ready === 'true'", "the page is ready")
    settled(browser)
    found = browser.run("return [window.guen.stage.eye(), document.getElementById('follow').getAttribute('aria-pressed')];")
    require(found[1] == "false" and all(abs(a - b) < 1e-6 for a, b in zip(found[0], (9, 8, 7, 1, 2, 0))), f"the link shows {found} of a page that follows a car")
    browser.open("about:blank")
    load(browser, page)

    # A film of the part of the time that is shown.
    browser.run("window.guen.span.set(2, 3); document.getElementById('more').click(); document.getElementById('film').click();")
    film = saved(browser, folder, "webm")
    require(film[:4] == b"\x1a\x45\xdf\xa3" and len(film) > 5000, f"a film of {len(film)} bytes")
    require(not browser.run("return window.guen.player.state.playing;") and span(browser)[:2] == [2, 3], "after the film it is otherwise than before")
    quiet(browser)
    # Where there is no recorder a message says so.
    browser.run("window.MediaRecorder = undefined; document.getElementById('film').click();")
    told = browser.run("const t = document.getElementById('told'); return t.checkVisibility() && t.textContent;")
    require("makes no films" in str(told), f"without a recorder it says {told}")
    kept(pictures, "hands-told", browser.picture)
    browser.press("?")
    settled(browser)
    require(browser.run("return document.getElementById('help').open;"), "no list of keys")
    everywhere(browser, "help", pictures)
    # While it is open keys do nothing else; Escape closes it.
    browser.press("k")
    browser.press(ESCAPE)
    require(not browser.run("return document.getElementById('help').open;") and span(browser)[:2] == [2, 3], "Escape does more or less than closing the list")
    listed = browser.run("return document.getElementById('help').textContent;")
    known = browser.run("return [...document.querySelectorAll('footer [title], #switches [title]')].map((e) => e.title);")
    require(all(word in listed for word in ("save a picture", "turn the view", "axes")) and len(known) > 10, "a key is not listed")
    require(browser.run("return performance.getEntriesByType('resource').length;") == 0, "saving loads something")
    quiet(browser)
    (folder / "film.webm").write_bytes(film)
    browser.open((folder / "film.webm").as_uri())
    browser.wait("document.querySelector('video').readyState >= 2", "the film can be played", 20)
    sides = browser.run("const v = document.querySelector('video'); return [v.videoWidth, v.videoHeight];")
    require(sides[0] > 500 and sides[1] > 300 and sides[0] % 2 == sides[1] % 2 == 0, f"the film has the sides {sides}")


def noise(browser, page):
    """What is rounding beside the other curves of its panel reads as nothing; a panel of nothing else keeps its values."""
    load(browser, page)
    read = "return [...document.querySelectorAll('figcaption data')].map((d) => d.textContent);"
    found = browser.run(read)
    require(found[1] == "0", f"rounding reads {found[1]}")
    require(found[2] == "4.63e−17", f"a panel of small values reads {found[2]}")
    quiet(browser)


def packed(values):
    return base64.b64encode(struct.pack(f"<{len(values)}f", *values)).decode()


def noisy(motion):
    """Beside a curve of the size one another one of rounding, and a panel with this alone."""
    count = len(base64.b64decode(motion["times"])) // 8
    one = {"name": "one", "values": packed([1 - k / count for k in range(count)])}
    nothing = {"name": "nothing", "values": packed([4.63e-17 * (1 - k / count) for k in range(count)])}
    motion["panels"] = [{"name": "both", "curves": [one, nothing]}, {"name": "alone", "curves": [nothing]}]


# Times of the marks that are put on the turntable's page, and their texts.
MARKS = [(0.5, "impact: floor"), (1.25, "slips: tyre"), (2.0, "rest: floor")]


def marked(motion):
    """Marks, and a name whose word changes at the second one."""
    motion["marks"] = [{"time": time, "text": text} for time, text in MARKS]
    changes = [{"time": 0, "text": "stick"}, {"time": MARKS[1][0], "text": "slip+"}]
    motion["words"] = [{"name": "tyre", "changes": changes}]


def modes(browser, page):
    """Words tell what holds, marks lie in the curves and at the slider, and keys and buttons go from one to the next."""
    browser.resize(900, 560)
    load(browser, page)
    said = "return ['#words .now', '#happened .now', '#when'].map((part) => document.querySelector(part).textContent);"
    now = f"return {TIME};"
    require(browser.run(said) == ["stick", "–", ""], f"before the first mark the page says {browser.run(said)}")
    for number, (time, text) in enumerate(MARKS):
        browser.press("]")
        settled(browser)
        require(browser.run(now) == time, f"the key leads to {browser.run(now)}")
        word, happened, when = browser.run(said)
        require((word, happened) == ("slip+" if number > 0 else "stick", text), f"at {time} the page says {word}, {happened}")
        require(f"{time}" in when, f"the time of the mark is {when}")
    browser.press("]")
    settled(browser)
    require(browser.run(now) == MARKS[-1][0], "a key leads beyond the last mark")
    browser.click("#mark-back")
    settled(browser)
    require(browser.run(now) == MARKS[1][0] and browser.run(said)[0] == "slip+", "the button does not lead back")
    browser.press("[")
    settled(browser)
    require(browser.run(said)[0] == "stick", "before its change the word is another one")
    lines = browser.run("return document.querySelector('#marks path').getAttribute('d').match(/M/g).length;")
    require(lines == len(MARKS), f"{lines} lines at the slider")
    # In the plot: at a mark a line of dashes goes from the top to the bottom, and beside it none.
    upright = COPY + """
const canvas = document.querySelector('figure canvas');
const { span, player } = window.guen;
const data = pixels(canvas);
const x = Math.round(Number(canvas.dataset.left) + (canvas.width - Number(canvas.dataset.left) - 8) * arguments[0] / span.to);
let count = 0;
for (let y = 8; y < canvas.height - 24; y += 1) if (data[4 * (y * canvas.width + x) + 3] > 100) count += 1;
return count / (canvas.height - 32);
"""
    browser.run("window.guen.player.setTime(0);")
    settled(browser)
    for time, _ in MARKS:
        found, beside = browser.run(upright, time), browser.run(upright, time + 0.15)
        require(found > beside + 0.2, f"at the mark {found:.2f} of the height is drawn, beside it {beside:.2f}")
    # The pointer reads the mark.
    left, top, width, height = browser.run("const b = document.querySelector('figure canvas').getBoundingClientRect(); return [b.x, b.y, b.width, b.height];")
    axis, end = (float(browser.run(f"return {value};")) for value in ("document.querySelector('figure canvas').dataset.left", "window.guen.motion.end"))
    at = left + axis + (width - axis - 8) * MARKS[1][0] / end
    move = {"type": "pointerMove", "origin": "viewport", "duration": 0, "x": round(at), "y": round(top + height / 2)}
    browser.call("actions", {"actions": [{"type": "pointer", "id": "mouse", "actions": [move]}]})
    settled(browser)
    told = browser.run("return document.querySelector('figure canvas').dataset.told;")
    require(MARKS[1][1] in told, f"the pointer reads {told}")
    quiet(browser)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--pictures", type=pathlib.Path, help="a folder for screenshots")
    parser.add_argument("--made", action="store_true", help="take the pages as they are, from target/guen")
    parser.add_argument("checks", nargs="*", help="parts of the names of checks; all if there is none")
    arguments = parser.parse_args()
    browser = Browser()
    if not arguments.made:
        subprocess.run(["cargo", "run", "--quiet", "--example", "viewer"], cwd=ROOT, check=True, stdout=subprocess.DEVNULL)
    turntable = target() / "guen/viewer/turntable.html"
    with tempfile.TemporaryDirectory() as folder, browser:
        pages = {}
        for change in (noisy, marked):
            pages[change.__name__] = pathlib.Path(folder) / f"{change.__name__}.html"
            pages[change.__name__].write_text(varied(turntable.read_text(), change))
        checks = [
            ("curves on and off", lambda: switched(browser, turntable, arguments.pictures)),
            ("time zoomed", lambda: zoomed(browser, turntable, arguments.pictures)),
            ("axes and names", lambda: framed(browser, turntable, arguments.pictures)),
            ("residuals", lambda: residuals(browser, turntable)),
            ("saved", lambda: kept_by_readers(browser, turntable, pathlib.Path(folder), arguments.pictures)),
            ("marks and modes", lambda: modes(browser, pages["marked"])),
            ("rounding", lambda: noise(browser, pages["noisy"])),
        ]
        wanted = [check for check in checks if not arguments.checks or any(part in check[0] for part in arguments.checks)]
        return ended(wanted, "as it has to be")


if __name__ == "__main__":
    sys.exit(main())
