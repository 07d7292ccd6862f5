#!/usr/bin/env python3
"""How the pages look and answer, in a real browser: at three widths, light, dark, with forced colours and on paper.

    python3 tests/browser/looks.py                     # runs the example and tests its pages
    python3 tests/browser/looks.py --pictures FOLDER   # keeps screenshots as well

Contrast is computed: 4.5 for texts, 3 for lines and marks. Exits with 0 if all is well, 1 if a page fails, 77 if there is no browser
and none can be installed.
"""

import argparse
import copy
import json
import pathlib
import subprocess
import sys
import tempfile
import time

from browser import Browser
from checks import ended, kept, require
from place import ROOT, target
from viewer import TIME, load, quiet, scene, settled

HEAD, TAIL = '<script type="application/json" id="motion">', "</script>"

LOOKS = {
    "light": ("light", {}),
    "dark": ("dark", {}),
    "forced": ("dark", {"forced_colors": "active"}),
    "paper": ("dark", {"media": "print"}),
}
WIDTHS = {1600: 900, 800: 600, 390: 844}

# The first colours of the list, in light.
INKS = ["#0072b2", "#c24a00", "#007a58", "#a83f80", "#8a6400", "#4d5661"]

# In the page: contrast of all texts that are seen with what is behind them, and of all marks; the worst ones.
CONTRAST = """
const channels = (text) => (text.match(/[\\d.]+/g) || []).map(Number);
const parsed = (text) => {
  let [r, g, b, a = 1] = channels(text);
  if (text.startsWith('color(')) [r, g, b] = [255 * r, 255 * g, 255 * b];
  return [r, g, b, a];
};
const luminance = ([r, g, b]) => {
  const [x, y, z] = [r, g, b].map((c) => c / 255).map((c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4));
  return 0.2126 * x + 0.7152 * y + 0.0722 * z;
};
const behind = (element) => {
  const layers = [];
  for (let e = element; e; e = e.parentElement) {
    const layer = parsed(getComputedStyle(e).backgroundColor);
    if (layer[3] > 0) layers.push(layer);
    if (layer[3] === 1) break;
  }
  return layers.reverse().reduce((below, [r, g, b, a]) => [r, g, b].map((c, i) => a * c + (1 - a) * below[i]), [255, 255, 255]);
};
const contrast = (a, b) => {
  const [x, y] = [luminance(a), luminance(b)].sort((p, q) => q - p);
  return (x + 0.05) / (y + 0.05);
};
const seen = (e) => e.checkVisibility({ checkOpacity: true, checkVisibilityCSS: true }) && e.getBoundingClientRect().width > 1;
const found = [];
for (const element of document.body.querySelectorAll('*')) {
  if (!seen(element) || element.closest('svg')) continue;
  const style = getComputedStyle(element);
  const words = [...element.childNodes].some((node) => node.nodeType === 3 && node.data.trim());
  if (words) found.push([contrast(parsed(style.color), behind(element)) / 4.5, 'text', element.textContent.trim().slice(0, 40)]);
  if (element.matches('figcaption i, #legend i')) {
    const [colour] = style.backgroundImage.match(/rgba?\\([^)]*[1-9][^)]*\\)/) || [style.backgroundColor];
    const edge = style.boxShadow.match(/rgba?\\([^)]*\\)/);
    const back = behind(element.parentElement);
    const best = Math.max(contrast(parsed(colour), back), edge ? contrast(parsed(edge[0]), back) : 0);
    found.push([best / 3, 'mark', element.parentElement.textContent.trim() + ' ' + colour]);
  }
  if (element.matches('button, select')) found.push([contrast(parsed(style.borderTopColor), behind(element.parentElement)) / 3, 'edge', element.id]);
}
return found.sort((a, b) => a[0] - b[0]);
"""

# In the page: what is wrong with where things are.
PLACES = """
const wide = arguments[0];
const wrong = [];
const box = (id) => document.getElementById(id).getBoundingClientRect();
if (document.documentElement.scrollWidth > wide) wrong.push(`the page is ${document.documentElement.scrollWidth} wide`);
const [stage, legend, foot] = [box('stage'), box('legend'), document.querySelector('footer').getBoundingClientRect()];
const part = (legend.width * legend.height) / (stage.width * stage.height);
if (part > 0.4) wrong.push(`the legend covers ${(100 * part).toFixed(0)} percent of the space`);
const rows = new Set([...document.querySelectorAll('footer button:not(#menu *), footer select, footer input')].filter((e) => e.checkVisibility()).map((e) => {
  const { top, bottom } = e.getBoundingClientRect();
  return Math.round((top + bottom) / 20);
}));
if (rows.size > 2) wrong.push(`${rows.size} rows of controls`);
for (const e of document.querySelectorAll('footer *, header *, figcaption')) {
  const { left, right, width } = e.getBoundingClientRect();
  if (width > 1 && (left < -0.5 || right > wide + 0.5)) wrong.push(`${e.id || e.tagName} sticks out`);
}
window.scrollTo(0, 1e6);
const last = [...document.querySelectorAll('figure canvas')].pop();
if (last) {
  last.scrollIntoView({ block: 'end' });
  const { bottom, top } = last.getBoundingClientRect();
  const f = document.querySelector('footer').getBoundingClientRect();
  if (f.height > 0 && f.top < bottom - 1 && f.bottom > top + 1) wrong.push('the controls cover the last curve');
}
window.scrollTo(0, 0);
return wrong;
"""

# In the page: pictures whose sides are stretched; paper without time or without colours.
PAPER = """
const wrong = [];
for (const canvas of document.querySelectorAll('#paper, figure:not(.folded) canvas')) {
  const { width, height } = canvas.getBoundingClientRect();
  if (!(width > 0 && height > 0)) wrong.push('a picture is missing');
  const fitted = getComputedStyle(canvas).objectFit === 'contain';
  if (!fitted && Math.abs(width / height / (canvas.width / canvas.height) - 1) > 0.02) wrong.push(`a picture is stretched: ${width} x ${height} of ${canvas.width} x ${canvas.height}`);
  const pen = canvas.getContext('2d');
  const { data } = pen.getImageData(0, 0, canvas.width, canvas.height);
  let coloured = 0;
  for (let k = 0; k < data.length; k += 4) if (data[k + 3] > 200 && Math.max(data[k], data[k + 1], data[k + 2]) - Math.min(data[k], data[k + 1], data[k + 2]) > 60) coloured += 1;
  if (coloured < 50) wrong.push(`${canvas.id || 'a curve'} has no colours`);
}
if (!/t = /.test(document.getElementById('paper-time').textContent) || !document.getElementById('paper-time').checkVisibility()) wrong.push('paper has no time');
if ([...document.querySelectorAll('#legend li')].some((e) => !e.checkVisibility())) wrong.push('paper has no legend');
return wrong;
"""


def varied(page, change):
    """The text of a page with other data."""
    before, rest = page.split(HEAD)
    data, after = rest.split(TAIL, 1)
    motion = json.loads(data)
    change(motion)
    return before + HEAD + json.dumps(motion).replace("<", "\\u003c") + TAIL + after


def crowd(motion):
    """Fifty bodies with paths, ten curves in a panel."""
    ball, path, curve = motion["bodies"][0], motion["paths"][0], motion["panels"][0]["curves"][0]
    motion["title"] = "A crowd"
    motion["bodies"] = [{**copy.deepcopy(ball), "name": f"body number {k}"} for k in range(50)]
    motion["paths"] = [{**copy.deepcopy(path), "name": f"path {k}"} for k in range(3)]
    motion["panels"][0]["curves"] = [{**copy.deepcopy(curve), "name": f"curve {k}"} for k in range(10)]


def below(motion):
    """A plane above everything."""
    motion["grounds"] = [{"kind": "plane", "point": [0, 0, 0.5], "normal": [0, 0, 1]}]


def fallen(motion):
    """No ground of its own, and everything below the level one."""
    motion["grounds"], motion["up"] = [], [0, 0, -1]


def many_bodies_alike(motion):
    motion["bodies"] = [motion["bodies"][0]]
    motion["links"] = []


def matters(browser, what):
    """The picture is another one without the first body: so that body is seen."""
    require(hides(browser), what)


def hides(browser):
    before = scene(browser)
    toggle = "window.guen.stage.shown.body(0, arguments[0]); window.guen.player.request();"
    browser.run(toggle, False)
    settled(browser)
    without = scene(browser)
    browser.run(toggle, True)
    settled(browser)
    return before != without


def seen_from_everywhere(browser, pages):
    browser.scheme("light")
    browser.resize(800, 600)
    load(browser, pages["below"])
    require(browser.run("return window.guen.motion.ground.glass;"), "a ground above everything is not see-through")
    browser.press("2")
    settled(browser)
    matters(browser, "a body below the ground is not seen from above")
    load(browser, pages["fallen"])
    require(not browser.run("return window.guen.motion.ground.shown;"), "a motion below the level ground has one")
    load(browser, pages["turntable"])
    require(browser.run("return window.guen.motion.ground.shown && !window.guen.motion.ground.glass;"), "no ground where one is said")
    browser.press("5")
    settled(browser)
    # Through the ground and past the table: the ball at the rim.
    browser.run("window.guen.stage.shown.body(1, false); window.guen.player.request();")
    settled(browser)
    matters(browser, "from below nothing is seen")

    # As far away as one gets, everything is still there; fit brings it back.
    distance = "return window.guen.stage.camera.position.distanceTo(window.guen.stage.controls.target);"
    load(browser, pages["turntable"])
    first = browser.run(distance)
    for _ in range(40):
        browser.press("-")
    settled(browser)
    far = browser.run(distance)
    require(2 * first < far < 12 * first, f"far is {far / first} times as far as at first")
    matters(browser, "from far away nothing is seen")
    for _ in range(80):
        browser.press("+")
    settled(browser)
    require(browser.run(distance) > 0, "the eye is where it looks")
    browser.run("const s = window.guen.stage; s.controls.target.x += 1e6; s.camera.position.x += 1e6; window.guen.player.request();")
    settled(browser)
    strayed = browser.run("return window.guen.stage.controls.target.distanceTo(window.guen.stage.center) / window.guen.stage.radius;")
    require(strayed < 3, f"the view strays by {strayed} sizes")
    browser.click("#fit")
    settled(browser)
    require(abs(browser.run(distance) / first - 1) < 1e-3, "fit does not show everything")
    matters(browser, "after fit nothing is seen")
    quiet(browser)


def keyboard(browser, path):
    browser.scheme("light")
    browser.resize(1000, 600)
    load(browser, path)
    browser.run("document.getElementById('space').focus();")
    eye = "return window.guen.stage.camera.position.toArray();"
    for key, what in [("\ue012", "left"), ("\ue014", "right"), ("\ue013", "up"), ("\ue015", "down"), ("+", "plus"), ("-", "minus")]:
        before = browser.run(eye)
        browser.press(key)
        settled(browser)
        require(browser.run(eye) != before, f"the key {what} does nothing to the view")
    require(browser.run(f"return {TIME};") == 0, "an arrow in the space sets the time")
    # One sample forward and back, from the page.
    browser.run("document.activeElement.blur();")
    times = browser.run("return [...window.guen.motion.times.slice(0, 3)];")
    for key, expected in [(".", times[1]), (".", times[2]), (",", times[1]), (",", times[0]), (",", times[0])]:
        browser.press(key)
        require(browser.run(f"return {TIME};") == expected, f"`{key}` does not go to {expected}")
    # A list has its own keys, a button its space bar.
    browser.run("document.getElementById('speed').focus();")
    browser.press("\ue015")
    browser.press("\ue011")
    require(browser.run("return document.getElementById('speed').value;") == "0.1", "the list of speeds does not get its keys")
    require(browser.run(f"return {TIME};") == times[0], "a key of the list sets the time")
    browser.run("document.getElementById('loop').focus();")
    browser.press(" ")
    require(browser.run("return document.getElementById('loop').getAttribute('aria-pressed');") == "true", "the space bar does not press a button")
    require(not browser.run("return window.guen.player.state.playing;"), "the space bar plays beside a button")
    # What loops goes on.
    browser.run("document.activeElement.blur(); document.getElementById('speed').value = '20'; window.guen.player.setTime(window.guen.motion.end - 0.2); window.guen.player.setPlaying(true);")
    browser.wait(f"{TIME} < window.guen.motion.end / 2", "it begins again")
    require(browser.run("return window.guen.player.state.playing;"), "it stops at its end although it loops")
    browser.run("window.guen.player.setPlaying(false);")

    # What a screen reader is told.
    told = browser.run(
        """return [...document.querySelectorAll('canvas:not([hidden]), input, select, footer button')].map((e) =>
            [e.id || e.tagName, e.getAttribute('aria-label') || e.textContent.trim(), e.getAttribute('role') || e.tagName, e.tabIndex]);"""
    )
    require(all(name for _, name, _, _ in told), f"something has no name: {told}")
    require(browser.run("return document.getElementById('space').tabIndex;") == 0, "the keyboard does not reach the space")
    live = browser.run("return [...document.querySelectorAll('output, [aria-live]:not([aria-live=off]), [role=timer]')].filter((e) => e.getAttribute('aria-live') !== 'off').length;")
    require(live == 0, "the time is announced in every frame")
    spoken = browser.run("return document.getElementById('slider').getAttribute('aria-valuetext');")
    require(spoken.startswith("t ="), "the slider does not say its time")
    # A body is chosen, read, hidden, labelled and followed.
    browser.run("document.querySelector('#legend li button').click();")
    settled(browser)
    card = browser.run("return [...document.querySelectorAll('#card dd')].map((e) => e.textContent);")
    require(len(card) == 6 and all(card), f"the card of a body: {card}")
    press = "[...document.querySelectorAll('#card button')].forEach((b) => arguments[0].includes(b.textContent) && b.click());"
    browser.run(press, ["label"])
    settled(browser)
    labels = "return [...document.querySelectorAll('#labels span')].filter((s) => !s.hidden).length;"
    require(browser.run(labels) == 1, "no label")
    browser.run(press, ["hide", "follow"])
    settled(browser)
    require(browser.run(labels) == 0, "what is hidden has a label")
    require(not browser.run("return window.guen.stage.movers[0].group.visible;"), "hidden is shown")
    require(browser.run("return document.getElementById('follow').getAttribute('aria-pressed');") == "true", "it does not follow")
    quiet(browser)
    # Who wants no motion gets none that nobody has asked for.
    browser.scheme("light", prefers_reduced_motion="reduce")
    load(browser, path)
    before = scene(browser)
    settled(browser)
    require(scene(browser) == before and not browser.run("return document.getAnimations().length || window.guen.player.state.playing;"), "something moves by itself")


def clicked(browser, path):
    """A click on a body chooses it."""
    browser.resize(800, 600)
    browser.scheme("light")
    load(browser, path)
    at = browser.run("const b = document.getElementById('space').getBoundingClientRect(); const p = window.guen.stage.onScreen(window.guen.stage.movers[0].group.position); return [Math.round(b.x + p[0]), Math.round(b.y + p[1])];")
    browser.drag(at, at)
    settled(browser)
    require(browser.run("return document.querySelector('#card .name').textContent;") == browser.run("return window.guen.motion.bodies[0].name;"), "a click on a body does not choose it")


def shrunk(browser, width, height):
    """A picture for a page of several: at most 640 wide."""
    return browser.picture((0, 0, width, height), min(1, 640 / width))


def looks(browser, name, path, pictures, some=tuple(LOOKS)):
    for look, (scheme, others) in ((look, LOOKS[look]) for look in some):
        browser.scheme(scheme, **others)
        for width, height in WIDTHS.items():
            browser.resize(width, height, mobile=width == 390)
            if width == 1600:
                load(browser, path)
            settled(browser)
            where = f"{width} wide, {look}"
            if look == "paper":
                wrong = browser.run(PAPER)
                require(not wrong, f"{where}: {wrong}")
            else:
                wrong = browser.run(PLACES, width)
                require(not wrong, f"{where}: {wrong}")
            found = browser.run(CONTRAST)
            kinds = {kind for _, kind, _ in found}
            require({"text", "mark"} <= kinds, f"{where}: nothing to compare but {kinds}")
            require(found[0][0] >= 1, f"{where}: too little contrast: {[f for f in found if f[0] < 1]}")
            if pictures:
                browser.run("window.guen.player.setTime(0.4 * window.guen.motion.end);")
                settled(browser)
                kept(pictures, f"looks-{name}-{look}-{width}", lambda: shrunk(browser, width, height))
    browser.scheme("light")


def printed(browser, path):
    """Really printed: the event comes, and the page has its pictures afterwards as before."""
    browser.scheme("dark")
    browser.resize(1000, 600)
    load(browser, path)
    browser.run("window.paper = 0; window.addEventListener('beforeprint', () => { const p = document.getElementById('paper'); window.paper = p.hidden ? 0 : p.width; });")
    before = scene(browser)
    pdf = browser.devtools("Page.printToPDF", printBackground=False)["data"]
    require(len(pdf) > 20_000, "a print without pictures")
    require(browser.run("return window.paper;") > 1000, "no picture is made for paper")
    # The end of printing comes when it comes.
    for _ in range(40):
        settled(browser)
        if scene(browser) == before:
            break
        time.sleep(0.1)
    require(scene(browser) == before, "after printing the page looks otherwise")
    return pdf


def scriptless(browser, page, pictures):
    """Where no script runs, there are pictures with their times, at every width, in the dark and on paper."""
    browser.devtools("Emulation.setScriptExecutionDisabled", value=True)
    ask = lambda script: browser.devtools("Runtime.evaluate", expression=script, returnByValue=True)["result"]["value"]
    try:
        for look, (scheme, others) in LOOKS.items():
            for width, height in WIDTHS.items():
                browser.scheme(scheme, **others)
                browser.resize(width, height, mobile=width < 500)
                browser.open(page.as_uri())
                require(ask("document.documentElement.dataset.ready === undefined"), "a script has run")
                times = ask("[...document.querySelectorAll('.still figcaption')].map((c) => c.textContent)")
                require(len(times) == 3 and all(text.startswith("t = ") for text in times), f"the scene is shown at {times}")
                seen = ask("[...document.querySelectorAll('body > :not(noscript), main *')].filter((e) => e.checkVisibility()).map((e) => e.id || e.tagName)")
                require(seen == [], f"beside the pictures there are {seen}")
                small = ask("[...document.querySelectorAll('.still figure svg')].filter((e) => !(e.getBoundingClientRect().width > Math.min(300, innerWidth - 60) && e.querySelectorAll('polyline, polygon').length > 3)).length")
                require(small == 0, f"{small} pictures are empty or small")
                wide = ask("document.documentElement.scrollWidth")
                require(wide <= width, f"the pictures are {wide} wide on {width}")
                low = [found for found in ask(f"(() => {{{CONTRAST}}})()") if found[0] < 1]
                require(not low, f"{look}: too little contrast: {low[:3]}")
                kept(pictures, f"looks-scriptless-{page.stem}-{look}-{width}", lambda: shrunk(browser, width, height))
        require(len(browser.devtools("Page.printToPDF")["data"]) > 20_000, "nothing is printed")
    finally:
        browser.devtools("Emulation.setScriptExecutionDisabled", value=False)
        browser.scheme("light")


def colours(browser, path):
    """No two of a few things have one colour; of many curves none looks as another one."""
    browser.scheme("light")
    browser.resize(1000, 600)
    load(browser, path)
    marks = browser.run("return [...document.querySelectorAll('figure')].map((f) => [...f.querySelectorAll('i')].map((i) => i.style.background || i.style.backgroundImage));")
    require(all(len(set(some)) == len(some) for some in marks), f"two curves look alike: {marks}")
    marks = browser.run("return [...document.querySelectorAll('#legend i')].map((i) => i.style.getPropertyValue('--mark'));")
    # Colours of its own are the author's.
    few = [mark for mark in marks[:6] if marks.count(mark) == 1 or mark in INKS]
    require(len(set(few)) == len(few), f"two things have one colour: {few}")
    last = marks[-1]
    require(last != marks[0], "a path has the colour of the first body")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--pictures", type=pathlib.Path, help="a folder for screenshots")
    parser.add_argument("--made", action="store_true", help="take the pages as they are, from target/guen")
    arguments = parser.parse_args()
    browser = Browser()
    if not arguments.made:
        subprocess.run(["cargo", "run", "--quiet", "--example", "viewer"], cwd=ROOT, check=True, stdout=subprocess.DEVNULL)
    turntable = target() / "guen/viewer/turntable.html"
    with tempfile.TemporaryDirectory() as folder, browser:
        pages = {"turntable": turntable, "car": turntable.with_name("car.html")}
        for change in (crowd, below, fallen):
            pages[change.__name__] = pathlib.Path(folder) / f"{change.__name__}.html"
            pages[change.__name__].write_text(varied(turntable.read_text(), change))
        checks = [
            ("seen from everywhere", lambda: seen_from_everywhere(browser, pages)),
            ("the keyboard", lambda: keyboard(browser, pages["turntable"])),
            ("a click", lambda: clicked(browser, pages["turntable"])),
            ("colours", lambda: [colours(browser, pages[name]) for name in ("turntable", "car", "crowd")]),
            ("print", lambda: printed(browser, pages["turntable"])),
            ("without scripts", lambda: [scriptless(browser, pages[name], arguments.pictures) for name in ("turntable", "car")]),
            ("looks", lambda: looks(browser, "turntable", pages["turntable"], arguments.pictures)),
            ("looks of a crowd", lambda: looks(browser, "crowd", pages["crowd"], arguments.pictures, ["light", "forced"])),
        ]
        return ended(checks, "as it has to be")


if __name__ == "__main__":
    sys.exit(main())
