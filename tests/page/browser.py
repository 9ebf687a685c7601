# SPDX-License-Identifier: Apache-2.0
"""A page in a headless Chromium, spoken to through a pipe (the browser's own protocol): no
driver, no port. find() says which browser there is, or None.
"""
import base64
import json
import os
import select
import shutil
import signal
import subprocess
import tempfile
import time

NAMES = ("chromium", "chromium-browser", "google-chrome-stable", "google-chrome")


def find():
    return next((path for path in map(shutil.which, NAMES) if path), None)


class Browser:
    """with Browser(path, "file:///...") as page: page.run("document.title")"""

    def __init__(self, program, address, size=(1280, 900), dark=False,
                 flags=("--disable-gpu",)):
        self.folder = tempfile.mkdtemp()
        self.errors, self.requests, self.number, self.left = [], [], 0, b""
        down, up = os.pipe(), os.pipe()
        line = [program, "--headless=new", "--no-sandbox", "--remote-debugging-pipe",
                "--no-first-run", "--disable-dev-shm-usage", *flags,
                f"--user-data-dir={self.folder}", "about:blank"]
        self.process = subprocess.Popen(
            ["sh", "-c", f'exec "$@" 3<&{down[0]} 4>&{up[1]}', "sh", *line],
            pass_fds=(down[0], up[1]), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
            start_new_session=True)
        os.close(down[0])
        os.close(up[1])
        self.out, self.into = up[0], down[1]
        self.session = None
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=target,
                                 flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(domain + ".enable")
        self.resize(*size)
        if dark:
            self.call("Emulation.setEmulatedMedia",
                      features=[{"name": "prefers-color-scheme", "value": "dark"}])
        self.loaded = False
        self.call("Page.navigate", url=address)
        while not self.loaded:
            self.read(None)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        os.killpg(self.process.pid, signal.SIGKILL)
        self.process.wait()
        os.close(self.out)
        os.close(self.into)
        shutil.rmtree(self.folder, ignore_errors=True)

    def message(self, limit_s=60):
        end = time.monotonic() + limit_s
        while b"\0" not in self.left:
            ready, _, _ = select.select([self.out], [], [], max(0, end - time.monotonic()))
            more = os.read(self.out, 1 << 20) if ready else b""
            if not more:
                raise RuntimeError("the browser does not answer")
            self.left += more
        one, self.left = self.left.split(b"\0", 1)
        return json.loads(one)

    def read(self, number):
        """Messages up to the answer of that number; None: one of them."""
        while True:
            said = self.message()
            name, what = said.get("method"), said.get("params", {})
            if name == "Page.loadEventFired":
                self.loaded = True
            elif name == "Runtime.exceptionThrown":
                details = what["exceptionDetails"]
                self.errors.append(details.get("exception", {}).get("description",
                                                                    details["text"]))
            elif name == "Log.entryAdded" and what["entry"]["level"] == "error":
                self.errors.append(what["entry"]["text"])
            elif name == "Runtime.consoleAPICalled" and what["type"] in ("error", "warning"):
                self.errors.append(str(what["args"]))
            elif name == "Network.requestWillBeSent":
                self.requests.append(what["request"]["url"])
            if number is None or said.get("id") == number:
                return said

    def call(self, name, **parameters):
        self.number += 1
        ask = {"id": self.number, "method": name, "params": parameters}
        if self.session:
            ask["sessionId"] = self.session
        os.write(self.into, json.dumps(ask).encode() + b"\0")
        said = self.read(self.number)
        if "error" in said:
            raise RuntimeError(f"{name}: {said['error']['message']}")
        return said["result"]

    def run(self, script):
        """The value of an expression; promises are waited for."""
        said = self.call("Runtime.evaluate", expression=script, awaitPromise=True,
                         returnByValue=True)
        if "exceptionDetails" in said:
            raise RuntimeError(said["exceptionDetails"].get("exception", {})
                               .get("description", script))
        return said["result"].get("value")

    def wait(self, script, limit_s=30):
        end = time.monotonic() + limit_s
        while not self.run(script):
            if time.monotonic() > end:
                raise RuntimeError(f"waited in vain for {script}")
            time.sleep(0.05)

    def resize(self, width, height):
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height,
                  deviceScaleFactor=1, mobile=width < 700)

    def mouse(self, kind, x, y, held=True):
        """kind: Pressed, Moved, Released."""
        held = held and kind != "Released"
        self.call("Input.dispatchMouseEvent", type="mouse" + kind, x=x, y=y,
                  button="left" if held or kind == "Released" else "none",
                  buttons=int(held), clickCount=int(kind != "Moved"))

    def click(self, x, y):
        self.mouse("Moved", x, y, held=False)
        self.mouse("Pressed", x, y)
        self.mouse("Released", x, y)

    def downloads(self, folder):
        """What the page saves goes there; the browser's command, not the page's."""
        session, self.session = self.session, None
        self.call("Browser.setDownloadBehavior", behavior="allow", downloadPath=folder)
        self.session = session

    def key(self, name):
        for kind in ("keyDown", "keyUp"):
            self.call("Input.dispatchKeyEvent", type=kind, key=name, code=name)

    def shot(self, path, whole=False):
        size = self.call("Page.getLayoutMetrics")["cssContentSize"]
        clip = {"clip": {"x": 0, "y": 0, "width": size["width"], "height": size["height"],
                         "scale": 1}} if whole else {}
        data = self.call("Page.captureScreenshot", captureBeyondViewport=whole, **clip)["data"]
        with open(path, "wb") as file:
            file.write(base64.b64decode(data))

    def pdf(self, path):
        with open(path, "wb") as file:
            file.write(base64.b64decode(self.call("Page.printToPDF",
                                                  printBackground=True)["data"]))
