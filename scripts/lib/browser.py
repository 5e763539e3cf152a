"""A chromium without a window, which shows pages of mssim web."""
import http.server
import json
import os
import subprocess
import sys
import tempfile
import threading
import time


class Browser:
    """A chromium with a folder of its own, which ends with it. It shows pages from localhost."""

    def __init__(self, chromium, flags):
        self.folder = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        self.page, self.number, self.read, self.session = b"", 0, b"", {}
        self.is_isolated = True  # from other origins: the clock is finer, samples are shorter, and threads share memory
        browser = self

        class Handler(http.server.BaseHTTPRequestHandler):
            def do_GET(self):
                self.send_response(200)
                self.send_header("Content-Type", "text/html; charset=utf-8")
                if browser.is_isolated:
                    self.send_header("Cross-Origin-Opener-Policy", "same-origin")
                    self.send_header("Cross-Origin-Embedder-Policy", "require-corp")
                self.end_headers()
                self.wfile.write(browser.page)

            def log_message(self, *arguments):
                pass

        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        threading.Thread(target=self.server.serve_forever, daemon=True).start()
        # chromium reads requests (of the Chrome DevTools Protocol) from 3 and writes to 4, each with a 0 at its end.
        requests, self.to = os.pipe()
        self.answers, answers = os.pipe()
        self.process = subprocess.Popen(
            ["bash", "-c", f'exec "$@" 3<&{requests} 4>&{answers}', "bash", chromium, "--headless=new", "--no-sandbox",
             "--disable-gpu-watchdog", "--no-first-run", f"--user-data-dir={self.folder.name}", "--remote-debugging-pipe", *flags],
            pass_fds=(requests, answers), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(requests)
        os.close(answers)
        target = self.ask("Target.createTarget", url="about:blank")["targetId"]
        self.session = {"sessionId": self.ask("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]}

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.terminate()
        self.process.wait()
        self.server.shutdown()
        self.folder.cleanup()

    def ask(self, method, **parameters):
        self.number += 1
        os.write(self.to, json.dumps({"id": self.number, "method": method, "params": parameters, **self.session}).encode() + b"\0")
        while True:
            while b"\0" not in self.read:
                self.read += os.read(self.answers, 1 << 20) or sys.exit("chromium has ended")
            text, self.read = self.read.split(b"\0", 1)
            answer = json.loads(text)
            if answer.get("id") == self.number:
                return answer["result"] if "result" in answer else sys.exit(f"{method}: {answer}")

    def value(self, script):
        """What a script gives, in the page."""
        answer = self.ask("Runtime.evaluate", expression=script, awaitPromise=True, returnByValue=True)
        return answer["result"].get("value") if "exceptionDetails" not in answer else sys.exit(f"{script}: {answer}")

    def until(self, script, seconds=240):
        end = time.monotonic() + seconds
        while not self.value(script):
            time.sleep(0.05)
            if time.monotonic() > end:
                sys.exit(f"not in {seconds} s: {script}: {self.value('document.body.innerText')}")

    def open(self, page, query=""):
        self.page = page.encode()
        self.ask("Page.navigate", url=f"http://localhost:{self.server.server_port}/?{query}")
        self.until("document.readyState === 'complete' && Boolean(element('support').textContent)")

    def press(self, key, **more):
        for kind in ("keyDown", "keyUp"):
            self.ask("Input.dispatchKeyEvent", type=kind, key=key, code=key, **more)

    def resize(self, width, height, dark=False):
        self.ask("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=width < 600)
        self.ask("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}])
        self.value("new Promise(resolve => requestAnimationFrame(() => requestAnimationFrame(resolve)))")

    def results(self):
        """What the page has measured, when it has."""
        self.until("Boolean(session?.finished)")
        return self.value("about().then(it => session.results(it))")
