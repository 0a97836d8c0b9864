"""A headless Chromium, driven by W3C WebDriver over chromedriver's port on the loopback interface."""

import base64
import json
import os
import re
import shutil
import signal
import subprocess
import tempfile
import time
import urllib.request

ELEMENT = "element-6066-11e4-a52e-4f735466cecf"  # the standard's key for element references


def program(name):
    path = shutil.which(name)
    if path is None:
        raise FileNotFoundError(f"no {name} here: run scripts/setup")
    return path


class Browser:
    def __init__(self, width=1280, height=900):
        self._home = tempfile.TemporaryDirectory(prefix="lpvmpc-browser-")
        # The driver gets its own session, so that all that it has started ends with it, and its own HOME, so that files
        # of the browser outside its user data are removed as well.
        self._driver = subprocess.Popen([program("chromedriver"), "--port=0"], stdout=subprocess.PIPE, text=True,
                                        start_new_session=True, env={**os.environ, "HOME": self._home.name})
        try:
            self._open(width, height)
        except BaseException:
            self._end()
            raise

    def _open(self, width, height):
        port = None
        for line in self._driver.stdout:
            if match := re.search(r"on port (\d+)", line):
                port = match.group(1)
            if "started successfully" in line:
                break
        assert port, "chromedriver did not start"
        self._url = f"http://127.0.0.1:{port}/session"
        self._session = ""
        arguments = ["--headless=new", "--disable-gpu", "--disable-quic", "--no-first-run",
                     "--disable-background-networking", "--disable-component-update", "--disable-sync",
                     "--force-device-scale-factor=1", f"--window-size={width},{height}",
                     f"--user-data-dir={self._home.name}/data"]
        if os.geteuid() == 0:
            arguments.append("--no-sandbox")  # the sandbox does not work for root
        wanted = {"browserName": "chrome", "goog:chromeOptions": {"binary": program("chromium"), "args": arguments},
                  "goog:loggingPrefs": {"browser": "ALL", "performance": "ALL"}}
        opened = self._call("POST", "", {"capabilities": {"alwaysMatch": wanted}})
        self._session = "/" + opened["sessionId"]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        try:
            self._call("DELETE", "")
        finally:
            self._end()

    def _end(self):
        # Ends only the process group that was made for the driver.
        os.killpg(self._driver.pid, signal.SIGTERM)
        self._driver.wait(timeout=20)
        self._driver.stdout.close()
        for _ in range(50):  # the browser may still write its last files
            try:
                self._home.cleanup()
                return
            except OSError:
                time.sleep(0.1)
        self._home.cleanup()

    def _call(self, method, path, body=None):
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(self._url + self._session + path, data, {"Content-Type": "application/json"},
                                         method=method)
        opener = urllib.request.build_opener(urllib.request.ProxyHandler({}))  # a proxy would not know our loopback
        try:
            with opener.open(request, timeout=60) as answer:
                return json.load(answer)["value"]
        except urllib.error.HTTPError as error:
            raise RuntimeError(f"{method} {path}: {error.read().decode()[:2000]}") from None

    def go(self, path):
        self._call("POST", "/url", {"url": "file://" + os.path.abspath(path)})

    def run(self, script, *arguments):
        return self._call("POST", "/execute/sync", {"script": script, "args": list(arguments)})

    def wait_for(self, script, what, seconds=30):
        end = time.monotonic() + seconds
        while not (value := self.run(script)):
            if time.monotonic() > end:
                raise AssertionError(f"waited {seconds} s in vain for {what}")
            time.sleep(0.05)
        return value

    def point(self, selector, across, down):
        """Moves the mouse to a place of an element, given in shares of its width and height."""
        self.run("document.querySelector(arguments[0]).scrollIntoView({block: 'center'})", selector)
        box = self._box(selector)
        self._mouse([self._move(box, across, down)])

    def drag(self, selector, start, end):
        self.point(selector, *start)
        box = self._box(selector)
        self._mouse([self._move(box, *start), {"type": "pointerDown", "button": 0}, self._move(box, *end),
                     {"type": "pointerUp", "button": 0}])

    def double_click(self, selector):
        self.point(selector, 0.5, 0.5)
        press = [{"type": "pointerDown", "button": 0}, {"type": "pointerUp", "button": 0}]
        self._mouse(press + press)

    def _box(self, selector):
        return self.run("const b = document.querySelector(arguments[0]).getBoundingClientRect();"
                        "return [b.left, b.top, b.width, b.height]", selector)

    @staticmethod
    def _move(box, across, down):
        left, top, width, height = box
        x, y = round(left + across * width), round(top + down * height)
        return {"type": "pointerMove", "duration": 0, "x": x, "y": y}

    def _mouse(self, actions):
        self._call("POST", "/actions", {"actions": [{"type": "pointer", "id": "mouse", "actions": actions}]})

    def log(self, kind):
        return self._call("POST", "/se/log", {"type": kind})

    def requests(self):
        """The addresses of all requests since the last call, without those of the browser's own start page."""
        messages = [json.loads(entry["message"])["message"] for entry in self.log("performance")]
        sent = [message["params"] for message in messages if message["method"] == "Network.requestWillBeSent"]
        return [params["request"]["url"] for params in sent if not params["documentURL"].startswith("chrome:")]

    def devtools(self, command, **parameters):
        return self._call("POST", "/goog/cdp/execute", {"cmd": command, "params": parameters})

    def set_scheme(self, scheme):
        self.devtools("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": scheme}])

    def set_width(self, width, height=900):
        self.devtools("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1,
                      mobile=False)

    def print_pdf(self):
        paper = {"background": True, "page": {"width": 21.0, "height": 29.7},
                 "margin": {"top": 1.2, "bottom": 1.2, "left": 1.2, "right": 1.2}}
        return base64.b64decode(self._call("POST", "/print", paper))

    def screenshot(self):
        """The whole page as PNG."""
        taken = self.devtools("Page.captureScreenshot", format="png", captureBeyondViewport=True)
        return base64.b64decode(taken["data"])
