#!/usr/bin/env python3
"""The pages that play a motion, in a real browser: they load without a word on the console, play, pause, and scrub.

    python3 tests/browser/viewer.py                     # runs the examples and tests their pages
    python3 tests/browser/viewer.py --pictures FOLDER   # keeps screenshots as well

Exits with 0 if all is well, 1 if a page fails, 77 if there is no browser and none can be installed.
"""

import argparse
import pathlib
import subprocess
import sys
import time

from browser import Browser
from checks import ended, kept, require
from place import ROOT, target

# Example, its page, and the time at which its picture is taken, as a part of the whole.
PAGES = [
    ("furuta", "furuta/furuta.html", 0.13),
    ("hoop", "hoop/hoop.html", 0.31),
    ("balancing_robot", "balancing_robot/robot.html", 0.3375),
    ("chaplygin_sled", "chaplygin_sled/sled.html", 0.2),
    ("spinning_wheel", "spinning_wheel/wheel.html", 0.42),
    ("rocking_block", "rocking_block/block.html", 0.3),
    ("viewer", "viewer/turntable.html", 0.4),
    ("viewer", "viewer/car.html", 0.5),
]

TIME = "window.guen.player.state.time"


def made(release):
    """Runs the examples that write the pages."""
    for example in dict.fromkeys(example for example, _, _ in PAGES):
        print(f"running the example {example} ..", flush=True)
        mode = ["--release"] if release else []
        command = ["cargo", "run", "--quiet", *mode, "--example", example]
        subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.DEVNULL)


def quiet(browser):
    """Nothing on the console, errors and warnings of the page in particular."""
    said = [message for level, message in browser.console() if level in ("SEVERE", "WARNING")]
    # The driver's own words on what a screenshot costs.
    said = [message for message in said if "GPU stall due to ReadPixels" not in message]
    require(not said, f"the console says: {said}")


def scene(browser):
    """The picture in space alone."""
    bounds = browser.run("const b = document.getElementById('space').getBoundingClientRect(); return [b.x, b.y, b.width, b.height];")
    return browser.picture(bounds)


def settled(browser):
    """Waits for what was asked of the next frames."""
    browser.call(
        "execute/async",
        {"script": "const done = arguments[0]; requestAnimationFrame(() => requestAnimationFrame(() => done(1)));", "args": []},
    )


def load(browser, path):
    browser.open(path.as_uri())
    browser.wait("document.documentElement.dataset.ready === 'true'", "the page is ready")
    settled(browser)
    quiet(browser)


def check(browser, path):
    load(browser, path)
    require(browser.run("return document.getElementById('trouble').hidden;"), "the space is not drawn")
    require(browser.run("return performance.getEntriesByType('resource').length;") == 0, "the page loads something")
    end = browser.run("return window.guen.motion.end;")
    require(browser.run(f"return {TIME};") == 0, "the motion does not begin at its start")
    first = scene(browser)

    # It plays: time goes on, at the pace that is asked for, and the picture moves.
    # Slowly, so that a busy machine does not play it to its end between two commands.
    browser.run("document.getElementById('speed').value = '0.1';")
    browser.click("#play")
    browser.wait(f"{TIME} > 0.02", "time goes on")
    require(browser.run("return document.getElementById('play').getAttribute('aria-label');") == "pause", "no button to pause")
    before, begin = browser.run(f"return [{TIME}, performance.now() / 1000];")
    browser.wait(f"{TIME} > {before + 0.1}", "a tenth of a second is played")
    after, finish = browser.run(f"return [{TIME}, performance.now() / 1000];")
    # A slow machine plays more slowly, for a frame shows a quarter of a second at most; none plays faster.
    require(after - before < 0.1 * (1.05 * (finish - begin) + 0.25), f"{after - before} s played in {finish - begin} s")
    browser.click("#play")
    browser.wait("!window.guen.player.state.playing", "the button pauses")
    settled(browser)
    stopped = browser.run(f"return {TIME};")
    moved = scene(browser)
    require(moved != first, "the picture does not move")
    time.sleep(0.3)
    require(browser.run(f"return {TIME};") == stopped, "time goes on while it pauses")
    require(scene(browser) == moved, "the picture moves while it pauses")

    # The space bar is the same button.
    browser.press(" ")
    browser.wait(f"{TIME} > {stopped}", "the space bar plays")
    browser.press(" ")
    browser.wait("!window.guen.player.state.playing", "the space bar pauses")

    # Scrubbing: by the slider, by the keys, by a curve.
    half = end / 2
    browser.run("const s = document.getElementById('slider'); s.value = arguments[0]; s.dispatchEvent(new Event('input'));", half)
    settled(browser)
    require(abs(browser.run(f"return {TIME};") - half) < 1e-6 * end, "the slider does not set the time")
    require(scene(browser) not in (first, moved), "scrubbing does not change the picture")
    browser.press("\ue012")  # arrow to the left
    require(browser.run(f"return {TIME};") < half, "the arrow does not step back")
    browser.press("\ue011")  # home
    settled(browser)
    require(scene(browser) == first, "the start looks otherwise than before")
    browser.press("\ue010")  # end
    require(browser.run(f"return {TIME};") == end, "the end is not reached")
    readings = "return [...document.querySelectorAll('figcaption span')].map((s) => s.textContent).join();"
    settled(browser)
    at_end = browser.run(readings)
    bounds = browser.run("const b = document.querySelector('figure canvas').getBoundingClientRect(); return [b.x, b.y, b.width, b.height];")
    left, top, width, height = bounds
    axis = float(browser.run("return document.querySelector('figure canvas').dataset.left;"))
    point = (round(left + axis + (width - axis - 8) / 4), round(top + height / 2))
    browser.drag(point, point)
    settled(browser)
    require(abs(browser.run(f"return {TIME};") - end / 4) < 0.02 * end, "a click into a curve does not set the time")
    require(browser.run(readings) != at_end, "the readings of the curves do not follow")

    # The view turns under the mouse, and comes back.
    before = scene(browser)
    x, y, w, h = browser.run("const b = document.getElementById('space').getBoundingClientRect(); return [b.x, b.y, b.width, b.height];")
    middle = (round(x + w / 2), round(y + h / 2))
    browser.drag(middle, (middle[0] + 120, middle[1] + 30))
    settled(browser)
    require(scene(browser) != before, "the view does not turn")
    browser.press("r")
    settled(browser)
    require(scene(browser) == before, "the view does not come back")
    browser.press("f")
    settled(browser)
    require(scene(browser) != before, "the view neither follows nor stops to follow")
    browser.press("f")

    # Its end is an end.
    browser.run(f"document.getElementById('speed').value = '20'; window.guen.player.setTime({end} - 0.5); window.guen.player.setPlaying(true);")
    browser.wait(f"{TIME} === {end} && !window.guen.player.state.playing", "it stops at its end")
    quiet(browser)


def narrow(browser, path):
    """On a telephone nothing sticks out to the side."""
    browser.resize(390, 844, mobile=True)
    load(browser, path)
    # A telephone would shrink a page that is too wide: its window is then as wide as the page.
    wide = browser.run("return document.documentElement.scrollWidth;")
    require(wide <= 390, f"the page is {wide} wide on a telephone of 390")
    quiet(browser)


def picture(browser, path, part):
    browser.run("window.guen.player.setTime(arguments[0] * window.guen.motion.end);", part)
    settled(browser)
    return browser.picture()


def whole(browser, path, part, pictures):
    """All of a page: what it does, how it looks, that it fits a telephone."""
    browser.resize(900, 560)
    browser.scheme("light")
    check(browser, path)
    for scheme in ("light", "dark") if pictures else ():
        browser.scheme(scheme)
        browser.resize(1000, 560)
        load(browser, path)
        kept(pictures, f"viewer-{path.stem}-{scheme}", lambda: picture(browser, path, part))
    narrow(browser, path)
    kept(pictures, f"viewer-{path.stem}-narrow", lambda: picture(browser, path, part))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--pictures", type=pathlib.Path, help="a folder for screenshots")
    parser.add_argument("--release", action="store_true", help="run the examples optimised")
    parser.add_argument("--made", action="store_true", help="take the pages as they are, from target/guen")
    parser.add_argument("pages", nargs="*", help="parts of the names of pages; all if there is none")
    arguments = parser.parse_args()
    browser = Browser()
    if not arguments.made:
        made(arguments.release)
    wanted = [(name, part) for _, name, part in PAGES if not arguments.pages or any(some in name for some in arguments.pages)]
    with browser:
        checks = [(name, lambda name=name, part=part: whole(browser, target() / "guen" / name, part, arguments.pictures)) for name, part in wanted]
        return ended(checks, "loads, plays, pauses, scrubs")


if __name__ == "__main__":
    sys.exit(main())
