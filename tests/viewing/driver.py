"""Controls a browser by the WebDriver protocol: Chromium and its driver, without further modules."""
import base64
import json
import shutil
import subprocess
import time
import urllib.error
import urllib.request

ELEMENT = "element-6066-11e4-a52e-4f735466cecf"


def missing():
    """The missing program, or None."""
    if not (shutil.which("chromium") or shutil.which("google-chrome")):
        return "chromium"
    return None if shutil.which("chromedriver") else "chromium-driver"


class Browser:
    def __init__(self, profile, size=(1280, 720)):
        self.driver = subprocess.Popen(["chromedriver", "--port=0"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        for line in self.driver.stdout:
            if "started successfully on port" in line:
                self.base = "http://127.0.0.1:" + line.rstrip().rstrip(".").rsplit(" ", 1)[1]
                break
        arguments = ["--headless=new", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--disable-dev-shm-usage",
                     f"--user-data-dir={profile}", "--window-size=%d,%d" % size]
        options = {"goog:chromeOptions": {"args": arguments, "binary": shutil.which("chromium") or shutil.which("google-chrome")},
                   "goog:loggingPrefs": {"browser": "ALL"}}
        self.session = self.call("POST", "/session", {"capabilities": {"alwaysMatch": options}}, rooted=True)["sessionId"]
        self.resize(*size)

    def call(self, method, path, body=None, rooted=False):
        url = self.base + path if rooted else f"{self.base}/session/{self.session}{path}"
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(url, data, {"Content-Type": "application/json"}, method=method)
        try:
            with urllib.request.urlopen(request, timeout=120) as answer:
                return json.loads(answer.read())["value"]
        except urllib.error.HTTPError as error:
            raise RuntimeError(error.read().decode()[:1000]) from None

    def open(self, address):
        self.call("POST", "/url", {"url": address})

    def reload(self):
        self.call("POST", "/refresh", {})

    def set_online(self, online):
        conditions = {"offline": not online, "latency": 0, "throughput": -1}
        self.call("POST", "/chromium/network_conditions", {"network_conditions": conditions})

    def resize(self, width, height):
        """Sets the inner size of the window."""
        self.call("POST", "/window/rect", {"width": width, "height": height})
        inner = self.run("return [innerWidth, innerHeight]")
        self.call("POST", "/window/rect", {"width": 2 * width - inner[0], "height": 2 * height - inner[1]})

    def run(self, script, *arguments):
        return self.call("POST", "/execute/sync", {"script": script, "args": list(arguments)})

    def run_async(self, script, *arguments):
        """Runs a script that passes its result to its last argument."""
        return self.call("POST", "/execute/async", {"script": script, "args": list(arguments)})

    def until(self, script, seconds=60):
        """Waits until the script returns a true value, and returns it."""
        end = time.monotonic() + seconds
        while True:
            value = self.run("return " + script)
            if value:
                return value
            if time.monotonic() > end:
                raise RuntimeError(f"never: {script}; {self.run('return document.body.innerText')[:500]}")
            time.sleep(0.05)

    def pointer(self, *actions, held=None):
        """Each event: ("move", x, y), ("down",), ("up",), ("wait", ms); positions in the window; optionally while a key
        is held."""
        steps = []
        for action in actions:
            if action[0] == "move":
                steps.append({"type": "pointerMove", "duration": 0, "x": round(action[1]), "y": round(action[2])})
            elif action[0] == "wait":
                steps.append({"type": "pause", "duration": action[1]})
            else:
                steps.append({"type": "pointerDown" if action[0] == "down" else "pointerUp", "button": 0})
        self.hold("keyDown", held)
        self.call("POST", "/actions", {"actions": [{"type": "pointer", "id": "mouse", "actions": steps}]})
        self.hold("keyUp", held)

    def hold(self, what, key):
        if key:
            self.call("POST", "/actions", {"actions": [{"type": "key", "id": "keys", "actions": [{"type": what, "value": key}]}]})

    def wheel(self, x, y, delta):
        scroll = {"type": "scroll", "x": round(x), "y": round(y), "deltaX": 0, "deltaY": delta, "duration": 0}
        self.call("POST", "/actions", {"actions": [{"type": "wheel", "id": "wheel", "actions": [scroll]}]})

    def press(self, key, held=()):
        steps = [{"type": "keyDown", "value": other} for other in held]
        steps += [{"type": "keyDown", "value": key}, {"type": "keyUp", "value": key}]
        steps += [{"type": "keyUp", "value": other} for other in held]
        self.call("POST", "/actions", {"actions": [{"type": "key", "id": "keys", "actions": steps}]})

    def screenshot(self, path):
        with open(path, "wb") as file:
            file.write(base64.b64decode(self.call("GET", "/screenshot")))

    def log(self):
        """The browser's error messages."""
        return [entry["message"] for entry in self.call("POST", "/se/log", {"type": "browser"}) if entry["level"] == "SEVERE"]

    def end(self):
        try:
            self.call("DELETE", "")
        finally:
            self.driver.terminate()
            self.driver.wait(timeout=20)
            self.driver.stdout.close()
