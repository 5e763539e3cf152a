#!/usr/bin/env python3
"""Opens pages in chromium, one after the other, and collects the results that they post.

browse(chromium, flags, jobs) -> {name: text of the results}; jobs: {name: (text of the page, its query)}.
As a program: web.py MSSIM PAGE FOLDER runs the checks of web_test.sh, and leaves a result as FOLDER/result.json.
"""
import csv
import http.server
import io
import json
import pathlib
import subprocess
import sys
import tempfile
import threading

WEBGPU = ["--enable-unsafe-webgpu", "--use-webgpu-adapter=swiftshader"]
DRIVER = b"""<!DOCTYPE html><iframe id="page" style="width:100%;height:90vh"></iframe><script>
let at = -1;
setInterval(async () => {
  const next = Number(await (await fetch('/next')).text());
  if (next !== at) document.getElementById('page').src = `/page/${at = next}`;
}, 50);
</script>"""


def browse(chromium, flags, jobs, seconds=240):
    names, results, done = list(jobs), {}, threading.Event()

    class Handler(http.server.BaseHTTPRequestHandler):
        def reply(self, body, kind="text/html", location=None):
            self.send_response(302 if location else 200)
            self.send_header("Content-Type", kind + "; charset=utf-8")
            self.send_header("Content-Length", str(len(body)))
            # The clock of isolated pages is finer, and samples are shorter.
            self.send_header("Cross-Origin-Opener-Policy", "same-origin")
            self.send_header("Cross-Origin-Embedder-Policy", "require-corp")
            if location:
                self.send_header("Location", location)
            self.end_headers()
            self.wfile.write(body)

        def do_GET(self):
            path, _, query = self.path.partition("?")
            if path == "/":
                self.reply(DRIVER)
            elif path == "/next":
                self.reply(str(len(results)).encode(), "text/plain")
            elif path.startswith("/page/") and int(path[6:]) < len(names):
                page, wanted = jobs[names[int(path[6:])]]
                if query != wanted:
                    self.reply(b"", location=f"{path}?{wanted}")
                else:
                    self.reply(page.encode())
            else:
                self.reply(b"")

        def do_POST(self):
            body = self.rfile.read(int(self.headers["Content-Length"])).decode()
            self.reply(b"the test's folder", "text/plain")
            if len(results) < len(names):
                results[names[len(results)]] = body
            if len(results) == len(names):
                done.set()

        def log_message(self, *arguments):
            pass

    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    with start(chromium, flags, f"http://localhost:{server.server_port}/"):
        if not done.wait(seconds):
            raise SystemExit(f"no result of {names[len(results)]} in {seconds} s")
    server.shutdown()
    return results


class start:
    """A chromium with a folder of its own, which ends with it."""

    def __init__(self, chromium, flags, address):
        self.folder = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        self.process = subprocess.Popen(
            [chromium, "--headless=new", "--no-sandbox", "--disable-gpu-watchdog", "--no-first-run",
             f"--user-data-dir={self.folder.name}", "--remote-debugging-port=0", *flags, address],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.terminate()
        self.process.wait()
        self.folder.cleanup()


def rows_of(text):
    return list(csv.DictReader(io.StringIO(json.loads(text)["timings_csv"])))


# What a kernel may have wrong: text of the page's WebGPU part, and what stands there instead. The reference stays right.
MUTANTS = {
    "a force with the other sign": ("spring_pull(dot(d, d),", "-spring_pull(dot(d, d),"),
    "springs act from one end": ("for (const end of [1, -1])", "for (const end of [1])"),
    "a spring is missing at the right edge": ("column + ${c} < ${grid.columns})", "column + ${c} < ${grid.columns - 1})"),
    "half of the damping is missing": ("f32(material[name] / mass)", "f32((name === 'damping' ? 0.5 : 1) * material[name] / mass)"),
    "stiffness is 1 % too large": ("f32(material.stiffness * rest / mass)", "f32(1.01 * material.stiffness * rest / mass)"),
    "another dt": ("return factor === 1 ? term[2] : `${f32(factor)}", "return factor === 1 ? term[2] : `${f32(1.002 * factor)}"),
    "pins move": ("if (is_free == 0) { a = vec3f(); }", ""),
    "a node is left out": ("if (i >= ${system.nodes}u)", "if (i >= ${system.nodes - 1}u)"),
    "a stale state": ("odd && pair < 2 ? 1 - pair : pair", "pair"),
    "no air": ("f32(system.viscous_damping)", "f32(0)"),
    "the floor does not brake": ("floor_velocity(v_next, ${f32(restitution)}, ${f32(friction)})", "floor_velocity(v_next, ${f32(restitution)}, 0)"),
    "the last springs of slices are missing": ("entry < first_entry[i / ${sliceLanes}u + 1u]", "entry + 1u < first_entry[i / ${sliceLanes}u + 1u]"),
}


def mutated(page, name):
    old, new = MUTANTS[name]
    if page.count(old) != 1:
        raise SystemExit(f"the page has {page.count(old)} times: {old}")
    return page.replace(old, new)


def expect(condition, what):
    if not condition:
        raise SystemExit(what)


def main(chromium, page_file, folder):
    page = pathlib.Path(page_file).read_text()
    every = ",".join(integrator["name"] for integrator in json.loads(page.split("const data =\n", 1)[1].split(";\n", 1)[0])["integrators"])
    two = "auto=cloth2500,bodies3858&rounds=1&seconds=0.002"
    jobs = {"all": (page, f"auto=cloth2500,bodies3858&rounds=3&seconds=0.005&integrators={every}"),
            "lost": (page, "auto=cloth2500,cloth4900,bodies3858&rounds=5&seconds=0.05&integrators=semi-euler&lose=1.5")}
    jobs.update({name: (mutated(page, name), two + "&integrators=semi-euler,midpoint") for name in MUTANTS})
    results = browse(chromium, WEBGPU, jobs)
    rows = rows_of(results["all"])
    expect(len(rows) == 2 * 2 * len(every.split(",")), f"{len(rows)} rows")
    for row in rows:
        expect(row["verified"] == "true" and row["status"] == "ok" and float(row["ms_per_step"]) > 0, f"not right: {row}")
    for name in MUTANTS:
        bad = [row for row in rows_of(results[name]) if row["backend"] == "webgpu" and row["status"].startswith("failed")]
        expect(bad and not any(row["ms_per_step"] for row in bad), f"not noticed: {name}")
        expect(all(row["verified"] == "true" for row in rows_of(results[name]) if row["backend"] == "javascript"),
               f"javascript fails: {name}")
    lost = rows_of(results["lost"])
    expect(any("lost the GPU" in row["status"] + row["note"] for row in lost if row["backend"] == "webgpu"),
           f"nothing says that the device was lost: {lost}")
    expect(len(lost) == 6 and all(row["status"] == "ok" for row in lost if row["backend"] == "javascript"), f"rows are gone: {lost}")
    without = browse(chromium, ["--disable-features=WebGPU,WebGPUService"],
                     {"without": (page, "auto=cloth2500&rounds=2&seconds=0.002&integrators=semi-euler&webgpu=no")})
    expect([row["backend"] for row in rows_of(without["without"])] == ["javascript"], "rows without WebGPU")
    for name, text in (("result", results["all"]), ("lost", results["lost"]), ("without", without["without"])):
        (pathlib.Path(folder) / f"{name}.json").write_text(text)


if __name__ == "__main__":
    main(*sys.argv[1:])
