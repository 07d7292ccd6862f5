#!/usr/bin/env python3
"""Pages whose data are hard to show, in a real browser: long runs, far places, short and long spans, odd names.

    python3 tests/browser/data.py                     # makes the pages and tests them
    python3 tests/browser/data.py --pictures FOLDER   # keeps screenshots as well
    python3 tests/browser/data.py --large 10000000 50 # a run of so many samples and bodies, timed; minutes

Exits with 0 if all is well, 1 if a page fails, 77 if there is no browser and none can be installed.
"""

import argparse
import math
import pathlib
import subprocess
import sys
import time

from browser import Browser
from checks import ended, kept, require
from hands import everywhere
from place import ROOT, target
from viewer import TIME, load, quiet, scene, settled

# A folder for screenshots, if somebody wants them.
PICTURES = None

# What a page of many samples may take to open, and the least frames of a second, drawn by software.
OPENS = 3.0
FRAMES = 30


def to(browser, part):
    """Goes to a part of the motion."""
    browser.run("window.guen.player.setTime(arguments[0] * window.guen.motion.end);", part)
    settled(browser)


def note(browser):
    return browser.run("return document.getElementById('note').textContent;")


def text_of_time(browser):
    return browser.run("return document.getElementById('time').textContent;")


def speeds(browser):
    return browser.run("return [...document.getElementById('speed').options].map((o) => [o.textContent, Number(o.value), o.selected]);")


def far(browser):
    """At 6.4e6 m a circle of 5 m is a circle."""
    origin, points, values, base = browser.run(
        "const m = window.guen.motion; return [m.origin, [...m.paths[0].points], [...m.curves[0].values], m.curves[0].base];"
    )
    require(abs(origin[0] - 6.4e6) < 10, f"the origin is {origin}")
    radii = [((x + origin[0] - 6.4e6) ** 2 + y * y) ** 0.5 for x, y in zip(points[0::3], points[1::3])]
    require(max(abs(radius - 5) for radius in radii) < 1e-5, f"radii from {min(radii)} to {max(radii)}")
    steps = [abs(after - before) for before, after in zip(values, values[1:])]
    require(max(steps) < 0.1 and abs(base - 6.4e6) < 10, f"the curve has steps of {max(steps)} from {base}")
    require("relative to (6400000" in note(browser), f"the note says: {note(browser)}")


def short(browser):
    """Ten microseconds are shown in some twenty seconds, in microseconds."""
    to(browser, 0.5)
    found = text_of_time(browser)
    require("µs" in found and "10.00" in found, f"the time is written {found}")
    chosen = [option for option in speeds(browser) if option[2]]
    require(chosen == [["500 ns a second", 5e-7, True]], f"the pace is {chosen}")
    # One sample on is another text.
    browser.run("const { player, motion } = window.guen; player.setTime(motion.times[501]);")
    settled(browser)
    require(text_of_time(browser) != found, "two samples have one time")
    plays(browser)


def long(browser):
    """A day is played in some twenty seconds."""
    require([option[1] for option in speeds(browser) if option[2]] == [5000], f"the paces are {speeds(browser)}")
    require(" s" in text_of_time(browser) and "100000" in text_of_time(browser), f"the time is written {text_of_time(browser)}")
    plays(browser)


def plays(browser):
    """The whole motion would take some twenty seconds."""
    to(browser, 0)
    browser.run("window.guen.player.setPlaying(true);")
    browser.wait(f"{TIME} > 0", "time goes on")
    before, begin = browser.run(f"return [{TIME} / window.guen.motion.end, performance.now() / 1000];")
    browser.wait(f"{TIME} / window.guen.motion.end > {before + 0.02}", "a fiftieth is played")
    after, finish = browser.run(f"return [{TIME} / window.guen.motion.end, performance.now() / 1000];")
    browser.run("window.guen.player.setPlaying(false);")
    # A slow machine plays more slowly, for a frame shows a quarter of a second at most; none plays faster.
    require(after - before < (1.05 * (finish - begin) + 0.25) / 20, f"{after - before} of the motion in {finish - begin} s")


def drawn_high(browser):
    """How high the first curve is drawn anywhere, as a part of its panel: its pixels, from the top on."""
    return browser.run(
        """
        const canvas = document.querySelector('figure canvas');
        const { width, height } = canvas;
        const copy = Object.assign(document.createElement('canvas'), { width, height });
        const pen = copy.getContext('2d', { willReadFrequently: true });
        pen.drawImage(canvas, 0, 0);
        const { data } = pen.getImageData(0, 0, width, height);
        const left = Number(canvas.dataset.left) * devicePixelRatio;
        for (let y = 0; y < height; y += 1) for (let x = Math.ceil(left); x < width - 8; x += 1) {
          const at = 4 * (y * width + x);
          const [r, g, b, a] = data.subarray(at, at + 4);
          // Coloured, and not a line of the grid.
          if (a > 60 && Math.max(r, g, b) - Math.min(r, g, b) > 60) return y / height;
        }
        return 1;
        """
    )


def million(browser):
    """A pulse of one sample in a million is there, in the data and in the picture; the page says what it left out."""
    to(browser, 0)
    most, count = browser.run("const c = window.guen.motion.curves[0]; return [Math.max(...c.values) + c.base, c.values.length];")
    require(most > 4 and count < 100_000, f"the largest of {count} values is {most}")
    # The cursor stands at the start, where the wave is not high.
    require(drawn_high(browser) < 0.15, f"the pulse is drawn at {drawn_high(browser)} of the height")
    require("of 1000000 samples" in note(browser), f"the note says: {note(browser)}")


def complete(browser):
    counts = browser.run("const m = window.guen.motion; return [m.bodies[0].poses.length / 7, m.curves[1].values.length, document.querySelectorAll('[id^=part-]').length];")
    require(counts == [1_000_000, 1_000_000, 0], f"counts are {counts}")
    million_values = browser.run("return Math.max(...Array.from({length: 1000}, (_, k) => window.guen.motion.curves[0].values[654321]));")
    require(million_values > 4, "the pulse is missing")
    require(drawn_high(browser) < 0.15, "the pulse is not drawn")
    require("samples" not in note(browser), f"the note says: {note(browser)}")


def names(browser):
    """Names are texts, whatever they are."""
    require(not browser.run("return Boolean(window.broken);"), "a name is executed")
    require(browser.run("return document.querySelectorAll('img, main svg[onload], b b').length;") == 0, "a name is markup")
    legend = browser.run("return document.getElementById('legend').textContent;")
    captions = browser.run("return [...document.querySelectorAll('figcaption')].map((c) => c.textContent).join();")
    for name in ("<img src=x onerror=", "&lt;b&gt; & ' \" \\ ` ${window", "маятник Фуко", "振り子", "עגלה (1)", "مذبذب 2"):
        require(name in legend and name in captions, f"`{name}` is not in the legends")
    # A name from right to left does not turn the number beside it.
    for name in ("עגלה (1)", "\u202ereversed", "مذبذب 2"):
        require(f"\u2068{name}\u2069" in captions, f"`{name}` is not kept apart from what stands beside it")


def thousand(browser):
    require(browser.run("return window.guen.motion.bodies.length;") == 1000, "bodies are missing")
    frames = frames_of(browser)
    require(frames > 1, f"{frames} frames in a second")


def single(browser):
    """One sample is a picture with its time, and nothing to play."""
    require(text_of_time(browser) == "t = 2.5 s", f"the time is written {text_of_time(browser)}")
    require("one sample" in note(browser), f"the note says: {note(browser)}")
    shown = browser.run("return ['play', 'slider', 'loop', 'speed', 'fit'].filter((id) => document.getElementById(id).checkVisibility());")
    require(shown == ["fit"], f"controls are {shown}")
    require(drawn_high(browser) < 1, "the curve has no point")
    for key in (" ", ".", ",", "\ue010", "\ue011", "l", "2", "f"):
        browser.press(key)
        settled(browser)
    place = browser.run("return window.guen.stage.movers[0].group.position.toArray();")
    require([round(x, 6) for x in place] == [1, 2, 0.3], f"the body is at {place}")
    before = scene(browser)
    browser.run("window.guen.stage.shown.body(0, false); window.guen.player.request();")
    settled(browser)
    require(scene(browser) != before, "the body is not seen")
    browser.run("window.guen.stage.shown.body(0, true);")


def two(browser, name):
    """What two runs on one page have in common, and tell of each other."""
    require("slower begins at t = 1 s. slower ends at t = 7 s" in note(browser), f"the note says: {note(browser)}")
    require(browser.run("return window.guen.motion.end;") == 10, "the clock is not that of the longer run")
    legend = browser.run("return [...document.querySelectorAll('#legend li')].map((li) => li.textContent);")
    things = ["ball", "velocity", "way"]
    require(legend == ["quick", *[f"{one} · quick" for one in things], "slower", *[f"{one} · slower" for one in things]], f"the legend: {legend}")
    curves = browser.run("return [...document.querySelectorAll('figcaption')].map((c) => [c.querySelector('b').textContent, ...[...c.querySelectorAll('.curve')].map((b) => [b.textContent, b.querySelector('i').style.background])]);")
    (place, *three), (angle, *one) = curves
    require((place, angle) == ("place in m", "angle in rad"), f"the panels are {place} and {angle}")
    require([name for name, _ in three + one] == ["x · quick", "y · quick", "x · slower", "angle · slower"], f"the curves are {three + one}")
    solid, dashed = three[0][1], three[2][1]
    require("gradient" in dashed and "gradient" not in solid and solid[solid.index("rgb"):].split(")")[0] in dashed, f"the marks are {solid} and {dashed}")
    # Both are where their own recordings have them, and who has ended stands still.
    for t, angles in ((0.5, (0.5, 0.9)), (5, (5, 4.5)), (9, (9, 6.3))):
        browser.run("window.guen.player.setTime(arguments[0]);", t)
        settled(browser)
        found = browser.run("const { stage, motion } = window.guen; return stage.movers.map(({ body, group }) => group.position.clone().sub(motion.runs[body.run].shift ?? { x: 0, y: 0, z: 0 }).toArray());")
        for run, (place, angle) in enumerate(zip(found, angles)):
            off = math.dist(place, (2 * math.cos(angle), 2 * math.sin(angle), 0.3))
            require(off < 1e-3, f"at {t} run {run} is {off} away from its place")
        readings = browser.run("return [...document.querySelectorAll('figcaption data')].map((d) => d.textContent);")
        require([text == "–" for text in readings] == [False, False, t != 5, t != 5], f"at {t} the curves read {readings}")
    # One sample on, of whichever run.
    browser.run("window.guen.player.setTime(1);")
    settled(browser)
    browser.press(".")
    require(0 < browser.run(f"return {TIME};") - 1 < 0.02, "no sample of either run comes next")
    # A run is switched off as a whole.
    browser.run("document.querySelectorAll('#legend .run input')[1].click();")
    settled(browser)
    require(browser.run("return window.guen.stage.movers.map(({ group }) => group.visible);") == [True, False], "a run is not switched off as a whole")
    browser.run("document.querySelectorAll('#legend .run input')[1].click(); window.guen.player.setTime(3);")
    settled(browser)
    everywhere(browser, name, PICTURES)


def ghost(browser):
    """A ghost is faint, in the same place, and of the same colour."""
    inks = browser.run("return window.guen.stage.movers.map(({ group }) => { let m; group.traverse((p) => (m ??= p.material)); return [m.color.getHexString(), m.opacity]; });")
    require(inks[0][0] == inks[1][0] and inks[0][1] == 1 and inks[1][1] < 0.5, f"colours and opacities are {inks}")
    two(browser, "ghost")


def beside(browser):
    """What stands beside has room, its name, and its own places."""
    boxes = browser.run("return window.guen.motion.runs.map((run, k) => { const p = window.guen.motion.paths[k].points; let [a, b] = [Infinity, -Infinity]; const { camera, controls } = window.guen.stage; const right = camera.position.clone().set(1, 0, 0).applyQuaternion(camera.quaternion); for (let i = 0; i < p.length; i += 3) { const x = p[i] * right.x + p[i + 1] * right.y + p[i + 2] * right.z; a = Math.min(a, x); b = Math.max(b, x); } return [a, b]; });")
    require(boxes[1][0] > boxes[0][1] + 0.6, f"the runs reach from and to {boxes}")
    shown = "return [...document.querySelectorAll('#labels span')].filter((s) => !s.hidden).map((s) => s.textContent);"
    require(browser.run(shown) == ["quick", "slower"], f"names: {browser.run(shown)}")
    two(browser, "beside")
    browser.run("[...document.querySelectorAll('#legend li button')].find((b) => b.textContent.includes('slower')).click(); window.guen.player.setTime(1);")
    settled(browser)
    place = browser.run("return document.querySelector('#card dd:nth-of-type(2)').textContent;")
    require(place == "1.243, 1.567, 0.3", f"the card says {place}")


def frames_of(browser, seconds=3):
    """Frames of a second while it plays."""
    browser.run("window.frames_drawn = 0; const { player } = window.guen; player.setTime(0); player.setPlaying(true); const count = () => { window.frames_drawn += 1; requestAnimationFrame(count); }; requestAnimationFrame(count);")
    time.sleep(1)
    before, begin = browser.run("return [window.frames_drawn, performance.now()];")
    time.sleep(seconds)
    after, end = browser.run("return [window.frames_drawn, performance.now()];")
    browser.run("window.guen.player.setPlaying(false);")
    return (after - before) / (end - begin) * 1000


CHECKS = {"far": far, "short": short, "long": long, "million": million, "complete": complete, "names": names, "single": single, "ghost": ghost, "beside": beside, "thousand": thousand}


def large(browser, folder, samples, bodies, made):
    """Opens and plays a run of many samples, against the clock."""
    if not made:
        make(folder, samples, bodies)
    path = folder / "large.html"
    begin = time.monotonic()
    load(browser, path)
    opened = time.monotonic() - begin
    inside = browser.run("return performance.now() / 1000;")
    frames = frames_of(browser, 6)
    print(f"{samples} samples of {bodies} bodies: {path.stat().st_size} bytes, opens in {opened:.2f} s ({inside:.2f} s by the page's clock), {frames:.1f} frames in a second")
    print(note(browser))
    require(opened < OPENS, f"it takes {opened:.2f} s to open, more than {OPENS}")
    require(frames >= FRAMES, f"{frames:.1f} frames in a second, less than {FRAMES}")


def make(folder, *arguments):
    command = ["cargo", "run", "--quiet", "--release", "-p", "guen-measure", "--bin", "pages", "--", str(folder), *map(str, arguments)]
    subprocess.run(command, cwd=ROOT, check=True)


def whole(browser, folder, name, pictures):
    browser.resize(1000, 640)
    browser.scheme("light")
    load(browser, folder / f"{name}.html")
    CHECKS[name](browser)
    quiet(browser)
    to(browser, 0.3)
    kept(pictures, f"data-{name}", browser.picture)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--pictures", type=pathlib.Path, help="a folder for screenshots")
    parser.add_argument("--made", type=pathlib.Path, help="take the pages of this folder as they are")
    parser.add_argument("--large", nargs=2, type=int, metavar=("SAMPLES", "BODIES"), help="time a page of so much")
    parser.add_argument("pages", nargs="*", help="names of pages; all if there is none")
    arguments = parser.parse_args()
    global PICTURES
    PICTURES = arguments.pictures
    browser = Browser()
    folder = arguments.made or target() / "guen" / "data"
    if arguments.large:
        with browser:
            browser.resize(1280, 800)
            size = " x ".join(map(str, arguments.large))
            return ended([(size, lambda: large(browser, folder, *arguments.large, arguments.made))], "quick enough")
    if not arguments.made:
        make(folder)
    wanted = [name for name in CHECKS if not arguments.pages or name in arguments.pages]
    with browser:
        return ended([(name, lambda name=name: whole(browser, folder, name, arguments.pictures)) for name in wanted], "as it should be")


if __name__ == "__main__":
    sys.exit(main())
