"""A headless Chromium, driven over its debugging pipe: opens a page, runs scripts in it, takes
pictures, and records what the page says and asks for. Needs nothing but Python and Chromium."""

import base64
import json
import os
import select
import shutil
import subprocess
import tempfile
import time


class Timeout(Exception):
    pass


def find():
    """Path of a Chromium or None; the environment variable CHROMIUM goes first."""
    names = [os.environ.get("CHROMIUM", ""), "chromium", "chromium-browser", "google-chrome"]
    return next((path for path in map(shutil.which, filter(None, names)) if path), None)


class Browser:
    """with Browser(path, width, height) as browser: ..."""

    def __init__(self, path, width=1200, height=800):
        self.folder = tempfile.mkdtemp(prefix="quadcover-browser-")
        self.messages, self.requests, self.buffer, self.number = [], [], b"", 0
        to_browser, self.write_end = os.pipe()
        self.read_end, from_browser = os.pipe()
        options = ["--headless=new", "--no-sandbox", "--remote-debugging-pipe", "--disable-gpu-sandbox",
                   "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--hide-scrollbars",
                   "--no-first-run", "--disable-background-networking", "--disable-dev-shm-usage",
                   f"--user-data-dir={self.folder}", f"--window-size={width},{height}"]

        def descriptors():  # Chromium reads commands from 3 and answers on 4.
            one, two = os.dup(to_browser), os.dup(from_browser)
            high, higher = os.dup(one), os.dup(two)
            os.dup2(high, 3)
            os.dup2(higher, 4)

        self.process = subprocess.Popen([path, *options, "about:blank"], close_fds=False,
                                        preexec_fn=descriptors, stdout=subprocess.DEVNULL,
                                        stderr=subprocess.DEVNULL)
        os.close(to_browser)
        os.close(from_browser)
        target = self.call("Target.createTarget", url="about:blank")
        self.session = self.call("Target.attachToTarget", targetId=target["targetId"],
                                 flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(domain + ".enable")
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height,
                  deviceScaleFactor=1, mobile=False)

    session = None

    def __enter__(self):
        return self

    def __exit__(self, *_):
        os.close(self.write_end)
        os.close(self.read_end)
        self.process.terminate()
        self.process.wait(20)
        shutil.rmtree(self.folder, ignore_errors=True)

    def call(self, method, seconds=60, **params):
        """One command of the Chrome DevTools Protocol; what happens meanwhile is recorded."""
        self.number += 1
        message = {"id": self.number, "method": method, "params": params}
        if self.session:
            message["sessionId"] = self.session
        os.write(self.write_end, json.dumps(message).encode() + b"\0")
        end = time.monotonic() + seconds
        while True:
            answer = self._read(end, method)
            if answer.get("id") == self.number:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']['message']}")
                return answer["result"]
            self._record(answer)

    def _read(self, end, what):
        while b"\0" not in self.buffer:
            ready, _, _ = select.select([self.read_end], [], [], max(end - time.monotonic(), 0))
            data = os.read(self.read_end, 1 << 20) if ready else b""
            if not data:
                raise Timeout(f"no answer to {what}")
            self.buffer += data
        text, self.buffer = self.buffer.split(b"\0", 1)
        return json.loads(text)

    def _record(self, event):
        method, params = event.get("method"), event.get("params", {})
        if method == "Runtime.consoleAPICalled":
            words = [str(a.get("value", a.get("description"))) for a in params["args"]]
            self.messages.append((params["type"], " ".join(words)))
        elif method == "Runtime.exceptionThrown":
            details = params["exceptionDetails"]
            self.messages.append(("exception", details.get("exception", {}).get("description", details["text"])))
        elif method == "Log.entryAdded":
            self.messages.append((params["entry"]["level"], params["entry"]["text"]))
        elif method == "Network.requestWillBeSent":
            self.requests.append(params["request"]["url"])

    def open(self, path, seconds=60):
        """Loads a file and waits until the report is complete; its time in seconds."""
        self.messages, self.requests = [], []
        self.call("Page.navigate", url="file://" + os.path.abspath(path))
        end = time.monotonic() + seconds
        while not self.run("document.readyState === 'complete' && !!window.quadcover"):
            if time.monotonic() > end:
                raise Timeout(f"{path} does not load")
            time.sleep(0.02)
        # Reading the picture back waits for the processor which draws it.
        return self.run("quadcover.ready.then((view) => { view?.render(); view?.canvas.toDataURL(); "
                        "return performance.now() / 1000; })", seconds)

    def run(self, script, seconds=60):
        """The value of an expression in the page; promises are awaited."""
        answer = self.call("Runtime.evaluate", seconds, expression=script, awaitPromise=True,
                           returnByValue=True)
        if "exceptionDetails" in answer:
            raise RuntimeError(answer["exceptionDetails"].get("exception", {}).get("description"))
        return answer["result"].get("value")

    def picture(self, file, kind="png", **clip):
        """Writes what is seen; clip: x, y, width, height, scale."""
        options = {"clip": {"scale": 1, **clip}} if clip else {}
        if kind == "jpeg":
            options["quality"] = 82
        data = self.call("Page.captureScreenshot", format=kind, **options)["data"]
        with open(file, "wb") as out:
            out.write(base64.b64decode(data))
