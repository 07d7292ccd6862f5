"""A headless Chromium by WebDriver, with the standard library alone.

Chromium and its driver are Debian's packages `chromium` and `chromium-driver`; they are installed where that is possible.
"""

import base64
import json
import os
import shutil
import socket
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.request

# What the scripts exit with where no browser can be had: neither success nor a failure of the pages.
NO_BROWSER = 77

FLAGS = [
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--disable-dev-shm-usage",
    "--hide-scrollbars",
    # WebGL by software, the same everywhere.
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
]


def installed():
    """Paths of the browser and of its driver; ends the program if they cannot be had."""
    names = ["chromium", "chromedriver"]
    found = [shutil.which(name) for name in names]
    if not all(found) and os.geteuid() == 0 and shutil.which("apt-get"):
        print("installing chromium and chromium-driver ..", flush=True)
        quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        subprocess.run(["apt-get", "update"], check=False, **quiet)
        packages = ["chromium", "chromium-driver"]
        subprocess.run(["apt-get", "install", "-y", "--no-install-recommends", *packages], check=False, **quiet)
        found = [shutil.which(name) for name in names]
    if not all(found):
        missing = ", ".join(name for name, path in zip(names, found) if not path)
        print(f"no browser to test with: {missing} is missing, and cannot be installed from here", file=sys.stderr)
        sys.exit(NO_BROWSER)
    return found


class Browser:
    """One window. Use it as a context."""

    def __init__(self, width=1280, height=800):
        self.chromium, self.driver = installed()
        self.size = (width, height)

    def __enter__(self):
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            port = free.getsockname()[1]
        self.profile = tempfile.mkdtemp(prefix="guen-browser-")
        self.process = subprocess.Popen(
            [self.driver, f"--port={port}"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        )
        self.base = f"http://127.0.0.1:{port}"
        self.session = None
        try:
            self._wait_until_up()
            arguments = [*FLAGS, f"--user-data-dir={self.profile}", f"--window-size={self.size[0]},{self.size[1]}"]
            wanted = {
                "browserName": "chrome",
                "goog:loggingPrefs": {"browser": "ALL"},
                "goog:chromeOptions": {"binary": self.chromium, "args": arguments},
            }
            answer = self._call("POST", "/session", {"capabilities": {"alwaysMatch": wanted}})
            self.session = answer["sessionId"]
            self.resize(*self.size)
        except BaseException:
            self.__exit__(None, None, None)
            raise
        return self

    def __exit__(self, *_):
        if self.session:
            try:
                self._call("DELETE", f"/session/{self.session}")
            except (OSError, RuntimeError):
                pass
        self.process.terminate()
        try:
            self.process.wait(20)
        except subprocess.TimeoutExpired:
            self.process.kill()
        shutil.rmtree(self.profile, ignore_errors=True)

    def _wait_until_up(self):
        for _ in range(200):
            try:
                if self._call("GET", "/status")["ready"]:
                    return
            except OSError:
                time.sleep(0.1)
        raise RuntimeError("the driver of the browser does not answer")

    def _call(self, method, path, body=None):
        data = json.dumps(body if body is not None else {}).encode() if method == "POST" else None
        request = urllib.request.Request(self.base + path, data, {"Content-Type": "application/json"}, method=method)
        try:
            with urllib.request.urlopen(request, timeout=180) as answer:
                return json.load(answer)["value"]
        except urllib.error.HTTPError as error:
            raise RuntimeError(json.load(error)["value"]["message"]) from None

    def call(self, path, body=None):
        """A command of the session."""
        return self._call("POST", f"/session/{self.session}/{path}", body)

    def devtools(self, command, **parameters):
        """A command of the DevTools protocol."""
        return self.call("goog/cdp/execute", {"cmd": command, "params": parameters})

    def open(self, url):
        """Loads a page; what the last one said on the console is forgotten."""
        self.console()
        self.call("url", {"url": url})

    def run(self, script, *arguments):
        """The value of a function's body in the page."""
        return self.call("execute/sync", {"script": script, "args": list(arguments)})

    def wait(self, script, what, seconds=60):
        """Waits until an expression holds."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if self.run(f"return Boolean({script});"):
                return
            time.sleep(0.05)
        raise RuntimeError(f"still not so after {seconds} s: {what}")

    def console(self):
        """What the console has got since the last question."""
        return [(entry["level"], entry["message"]) for entry in self.call("se/log", {"type": "browser"})]

    def click(self, selector):
        """A click by the mouse in the middle of an element."""
        found = self.call("element", {"using": "css selector", "value": selector})
        element = next(iter(found.values()))
        self.call(f"element/{element}/click")

    def press(self, key):
        """A key, to whatever has the focus."""
        strokes = [{"type": "keyDown", "value": key}, {"type": "keyUp", "value": key}]
        self.call("actions", {"actions": [{"type": "key", "id": "keyboard", "actions": strokes}]})

    def drag(self, start, end):
        """The mouse pressed at one point of the window, moved, and released at another."""
        move = {"type": "pointerMove", "origin": "viewport"}
        steps = [
            {**move, "duration": 0, "x": start[0], "y": start[1]},
            {"type": "pointerDown", "button": 0},
            {**move, "duration": 120, "x": end[0], "y": end[1]},
            {"type": "pointerUp", "button": 0},
        ]
        self.call("actions", {"actions": [{"type": "pointer", "id": "mouse", "actions": steps}]})

    def resize(self, width, height, scale=1, mobile=False):
        """The size of the page, in its own pixels."""
        self.devtools(
            "Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=scale, mobile=mobile
        )

    def scheme(self, name, media="", **others):
        """`light` or `dark`; `media="print"` is paper, others are features such as `forced_colors="active"`."""
        features = {"prefers-color-scheme": name, **{key.replace("_", "-"): value for key, value in others.items()}}
        pairs = [{"name": key, "value": value} for key, value in features.items()]
        self.devtools("Emulation.setEmulatedMedia", media=media, features=pairs)

    def picture(self, clip=None, scale=1):
        """A screenshot as PNG, smaller by a scale; `clip` is left, top, width, height."""
        parameters = {"format": "png"}
        if clip:
            parameters["clip"] = {**dict(zip(("x", "y", "width", "height"), clip)), "scale": scale}
        return base64.b64decode(self.devtools("Page.captureScreenshot", **parameters)["data"])
