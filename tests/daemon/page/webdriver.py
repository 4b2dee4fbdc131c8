"""Drives a browser by chromedriver's plain WebDriver protocol (https://www.w3.org/TR/webdriver2/), with only the
standard library."""

import base64
import json
import re
import subprocess
import tempfile
import time
import urllib.error
import urllib.request

ELEMENT = "element-6066-11e4-a52e-4f735466cecf"  # the key that the protocol gives an element's id

DIRECT = urllib.request.build_opener(urllib.request.ProxyHandler({}))  # ignores proxies of the environment

KEYS = {"TAB": "\ue004", "ENTER": "\ue007", "ESCAPE": "\ue00c", "SPACE": " ", "END": "\ue010", "HOME": "\ue011",
        "DELETE": "\ue017", "LEFT": "\ue012", "UP": "\ue013", "RIGHT": "\ue014", "DOWN": "\ue015"}


def start_driver(attempts=5):
    """Returns a listening chromedriver and its port. It chooses a free IPv4 port and ends if another process has this
    port of IPv6; then it is started again, up to `attempts` times. RuntimeError with its output if none listens."""
    said = []
    for _ in range(attempts):
        with tempfile.TemporaryFile("w+") as errors:
            driver = subprocess.Popen(["chromedriver", "--port=0"], stdout=subprocess.PIPE, stderr=errors, text=True)
            for line in driver.stdout:
                if found := re.search(r"started successfully on port (\d+)", line):
                    return driver, found[1]
                said.append(line)
            driver.wait()
            errors.seek(0)
            said.append(errors.read())
    raise RuntimeError("chromedriver did not start:\n" + "".join(said))


class Browser:
    """Headless Chromium with a profile of its own; a context manager."""

    def __init__(self, width=1200, height=900):
        self.profile = tempfile.TemporaryDirectory()
        self.driver, port = start_driver()
        self.base = f"http://127.0.0.1:{port}"
        arguments = ["--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run",
                     "--hide-scrollbars", "--lang=en", f"--window-size={width},{height}",
                     f"--user-data-dir={self.profile.name}"]
        capabilities = {"browserName": "chrome", "goog:chromeOptions": {"args": arguments},
                        "goog:loggingPrefs": {"browser": "ALL"}}
        session = self.ask("POST", "/session", {"capabilities": {"alwaysMatch": capabilities}})
        self.base += f"/session/{session['sessionId']}"

    def __enter__(self):
        return self

    def __exit__(self, *_):
        try:
            self.ask("DELETE", "", None)
        finally:
            self.driver.terminate()
            self.driver.wait()
            self.profile.cleanup()

    def ask(self, method, path, body):
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(self.base + path, data, {"Content-Type": "application/json"}, method=method)
        try:
            with DIRECT.open(request, timeout=60) as response:
                return json.load(response)["value"]
        except urllib.error.HTTPError as error:
            raise RuntimeError(json.load(error)["value"]["message"]) from None

    def open(self, url):
        self.ask("POST", "/url", {"url": url})

    def script(self, text, *arguments):
        """Runs a function body in the page and returns its value."""
        return self.ask("POST", "/execute/sync", {"script": text, "args": list(arguments)})

    def text(self, selector):
        return self.script("return document.querySelector(arguments[0])?.innerText ?? null", selector)

    def texts(self, selector):
        return self.script("return [...document.querySelectorAll(arguments[0])].map(e => e.innerText)", selector)

    def visible(self, selector):
        return self.script("return document.querySelector(arguments[0])?.checkVisibility() ?? false", selector)

    def click(self, selector):
        found = self.ask("POST", "/element", {"using": "css selector", "value": selector})
        self.ask("POST", f"/element/{found[ELEMENT]}/click", {})

    def double_click(self, selector):
        """Double-clicks the middle of the element with mouse events."""
        found = self.ask("POST", "/element", {"using": "css selector", "value": selector})
        self.script("document.querySelector(arguments[0]).scrollIntoView({block: 'center'})", selector)
        click = [{"type": "pointerDown", "button": 0}, {"type": "pointerUp", "button": 0}]
        move = {"type": "pointerMove", "origin": found, "x": 0, "y": 0}
        mouse = {"type": "pointer", "id": "mouse", "actions": [move, *click, *click]}
        self.ask("POST", "/actions", {"actions": [mouse]})

    def press(self, *keys):
        """Presses keys, given by their name in KEYS or as text."""
        actions = []
        for key in keys:
            for value in [KEYS[key]] if key in KEYS else key:
                actions += [{"type": "keyDown", "value": value}, {"type": "keyUp", "value": value}]
        self.ask("POST", "/actions", {"actions": [{"type": "key", "id": "keyboard", "actions": actions}]})

    def devtools(self, command, **parameters):
        return self.ask("POST", "/goog/cdp/execute", {"cmd": command, "params": parameters})

    def prefer(self, scheme):
        self.devtools("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": scheme}])

    def set_width(self, width, height=900):
        self.devtools("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1,
                      mobile=False)

    def screenshot(self, path):
        """Saves a picture of the whole page, beyond the window."""
        image = self.devtools("Page.captureScreenshot", captureBeyondViewport=True)
        with open(path, "wb") as file:
            file.write(base64.b64decode(image["data"]))

    def complaints(self):
        """Returns the errors and warnings of the browser's console since the last call, e.g. of the content policy."""
        return [entry["message"] for entry in self.ask("POST", "/se/log", {"type": "browser"})
                if entry["level"] in ("SEVERE", "WARNING")]

    def wait(self, what, condition, seconds=10):
        """Waits until condition() is true and returns its value."""
        end = time.monotonic() + seconds
        while not (value := condition()):
            if time.monotonic() > end:
                raise AssertionError(f"{what}: not within {seconds} s")
            time.sleep(0.05)
        return value
