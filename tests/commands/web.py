#!/usr/bin/env python3
"""Opens pages of mssim web in chromium, without a window, and uses them as a person would.

As a program: web.py CHROMIUM PAGE FOLDER runs the checks of web_test.sh, and leaves results as FOLDER/NAME.json.
"""
import base64
import concurrent.futures
import csv
import io
import itertools
import json
import pathlib
import re
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts" / "lib"))
from browser import Browser  # pylint: disable=wrong-import-position

BACKENDS = ["javascript", "wasm", "wasm-threads", "webgpu"]
WEBGPU = ["--enable-unsafe-webgpu", "--use-webgpu-adapter=swiftshader"]
MODULE = "[A-Za-z0-9+/=]{999,}"


def rows_of(text):
    return list(csv.DictReader(io.StringIO(json.loads(text)["timings_csv"])))


def query_of(scenes, integrators="semi-euler", rounds=1, seconds=0.002, threads=2, more=""):
    return f"auto={scenes}&integrators={integrators}&rounds={rounds}&seconds={seconds}&threads={threads}{more}"


# What kernels may have wrong: text of the page's part for them, and what stands there instead. The reference stays right.
WEBGPU_MUTANTS = {
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
WASM_MUTANTS = {
    "the last spring is missing": ("if (i >= count) continue", "if (i >= count - 1) continue"),
    "half of the damping is missing": ("4 * c] = material[name]", "4 * c] = material[name] * (name === 'damping' ? 0.5 : 1)"),
    "stiffness is 1 % too large": ("= material.stiffness * system.restLengths[s];", "= 1.01 * material.stiffness * system.restLengths[s];"),
    "another dt": ("data.integrators.indexOf(integrator), dt,", "data.integrators.indexOf(integrator), 1.002 * dt,"),
    "pins move": ("system.free[node] / mass", "1 / mass"),
    "no air": ("n, threads, system.viscous_damping", "n, threads, 0"),
    "the floor does not brake": ("...system.floor))", "system.floor[0], system.floor[1], 0))"),
}
# Instructions of a module, f32x4.*, which take and give as much: those of the springs and of the integrator.
WASM_MODULE_MUTANTS = {
    "a magnitude for a root": (b"\xfd\xe3\x01", b"\xfd\xe0\x01"),
    "forces pull both ends the same way": (b"\xfd\xe5\x01\xfd\x0b\x04\x00", b"\xfd\xe4\x01\xfd\x0b\x04\x00"),
}
THREADS_MUTANTS = {
    "a spring between two threads pulls at one": ("one === other ? [one] : [one, other]", "[one]"),
    "a thread leaves its last node": ("end = owner.filter(its => its <= thread).length", "end = owner.filter(its => its <= thread).length - thread"),
    # i32.eq between the threads that have come and all, before a constant that tells the place.
    "threads do not wait for each other": (b"\x46\x0d\x00\x41\xc0\x84\x3d", b"\x47\x0d\x00\x41\xc0\x84\x3d"),
}


def expect(condition, what):
    if not condition:
        sys.exit(what)


def is_timed(row):
    return row["verified"] == "true" and row["status"] == "ok" and float(row["ms_per_step"]) > 0


def check_rows(browser, page):
    """Every explicit integrator on a cloth and on bodies."""
    every = browser.open(page) or browser.value("data.integrators.map(({name}) => name)")
    browser.open(page, query_of("cloth2500,bodies3858", ",".join(every), 3, 0.005))
    rows = rows_of(result := browser.results())
    expect(len(rows) == 2 * len(BACKENDS) * len(every), f"{len(rows)} rows")
    expect({row["backend"] for row in rows} == set(BACKENDS), "a backend has no row")
    for row in rows:
        expect(is_timed(row), f"not right: {row}")
    expect(browser.value("Math.abs(session.done / session.units - 1) < 1e-6"), "the progress does not end at its end")
    return {"result": result}


def mutated(page, right, wrong):
    """The page with something else in the place of a text, which it has once."""
    expect(page.count(right) == 1, f"the page has {page.count(right)} times: {right}")
    return page.replace(right, wrong)


def with_mutant(page, backend, right, wrong):
    if isinstance(right, str):
        return mutated(page, right, wrong)
    before, text, after = re.split(f'(?<="{backend.replace("-", "_")}":")({MODULE})', page)
    module = base64.b64decode(text)
    # Compilers that unroll loops, or copy them for cases, write these instructions several times.
    expect(right in module, f"the module of {backend} has not {right}")
    return before + base64.b64encode(module.replace(right, wrong)).decode() + after


def check_mutants(browser, page):
    """A page has a mutant of WebGPU and one of the modules, as long as there are some."""
    def of(mutants, *backends):
        return [(backends, name, change) for name, change in mutants.items()]

    of_wasm = of(WASM_MUTANTS, "wasm", "wasm-threads") + of(WASM_MODULE_MUTANTS, "wasm") + of(THREADS_MUTANTS, "wasm-threads")
    for pair in itertools.zip_longest(of(WEBGPU_MUTANTS, "webgpu"), of_wasm):
        mutants, changed = list(filter(None, pair)), page
        for backends, _, change in mutants:
            changed = with_mutant(changed, backends[0], *change)
        browser.open(changed, query_of("bodies3858" if "slices" in mutants[0][1] else "cloth2500"))
        rows = {row["backend"]: row for row in rows_of(browser.results())}
        for backends, name, _ in mutants:
            for wrong in map(rows.pop, backends):
                expect(wrong["status"].startswith("failed") and not wrong["ms_per_step"], f"not noticed: {name}: {wrong}")
        expect(rows and all(map(is_timed, rows.values())), f"others fail: {mutants}: {rows}")


def check_accidents(browser, page):
    """The GPU is lost, a row of the CPU fails then, and a buffer is too large for the GPU: other rows stay."""
    browser.open(page, query_of("cloth2500,cloth4900,bodies3858", rounds=5, seconds=0.05, more="&lose=1.5"))
    rows = rows_of(lost := browser.results())
    expect(any("lost the GPU" in row["status"] + row["note"] for row in rows if row["backend"] == "webgpu"),
           f"nothing says that the device was lost: {rows}")
    expect(len(rows) >= 6 and all(is_timed(row) for row in rows if row["backend"] != "webgpu"), f"rows are gone: {rows}")
    sample = "  async sample(row, system) {"
    third = mutated(page, sample, sample + """
      if (row.backend === 'wasm' && row.samples.length > 1) {
        this.device.destroy();
        await this.device.lost;
        throw new Error('ended');
      }""")
    browser.open(third, query_of("cloth2500", rounds=4))
    failed = browser.results()
    rows = {row["backend"]: row for row in rows_of(failed)}
    ended = rows.pop("wasm")
    expect(ended["status"] == "failed: ended" and ended["rounds"] == "2" and not ended["ms_per_step"], f"not failed after two samples: {ended}")
    expect(all(map(is_timed, rows.values())) and "lost the GPU" in rows["webgpu"]["note"], f"not right: {rows}")
    browser.open(page.replace("if (bytes > device.limits[limit])", "if (bytes > 100000)"), query_of("cloth2500,cloth4900"))
    rows = {(row["scene"], row["backend"]): row for row in rows_of(browser.results())}
    large = rows.pop(("cloth4900", "webgpu"))
    expect(large["status"].startswith("unsupported") and "maxStorageBufferBindingSize" in large["status"] and not large["ms_per_step"],
           f"no limit is named: {large}")
    expect(all(map(is_timed, rows.values())), f"not right: {rows}")
    return {"lost": lost, "failed": failed}


def check_person(browser, page):
    """By keyboard: start, hide the page for a while, stop, and load it again."""
    browser.open(page, "rounds=100&seconds=0.02&integrators=semi-euler")
    for _ in range(100):
        browser.press("Tab")
        if browser.value("document.activeElement.id") == "start":
            break
    browser.press("Enter", text="\r")
    browser.until("session?.rows.some(row => row.samples.length)")
    hide = "Object.defineProperty(document, 'hidden', {value: %s, configurable: true}); document.dispatchEvent(new Event('visibilitychange'))"
    browser.value(hide % "true")
    browser.until("session.hidden")
    before = browser.value("session.done")
    time.sleep(0.5)
    expect(browser.value("session.done") == before, "the page measures while it is hidden")
    browser.value(hide % "false")
    browser.until(f"session.done > {before}")
    expect("left" in browser.value("element('left').textContent"), "the page does not say how much time is left")
    expect(browser.value("document.activeElement.id") == "stop", "the focus is not on Stop")
    browser.press("Enter", text="\r")
    results = browser.results()
    expect("early" in browser.value("element('state').textContent") and browser.value("element('bar').value") < 1,
           "the page says that it is done, though it was stopped")
    for what in "hidden", "stopped":
        expect(any(what in note for note in json.loads(results)["provenance"]["noise"]), f"no note says that it was {what}: {results}")
    rows = browser.value("element('rows').children.length")
    browser.ask("Page.reload")
    browser.until("typeof element === 'function' && Boolean(element('rows').children.length)")
    expect(browser.value("element('rows').children.length") == rows, "rows are gone after loading the page again")
    expect(rows_of(browser.results()) == rows_of(results), "rows have changed after loading the page again")
    for width in 360, 1280:
        for dark in False, True:
            browser.resize(width, 800, dark)
            expect(browser.value("document.documentElement.scrollWidth") <= width, f"the page is wider than {width}")
            last = "last" if width == 1280 else "nth"  # of a phone's columns, those up to the time
            expect(browser.value(f"document.querySelector('thead th:{last}-child{'' if last == 'last' else '(4)'}').getBoundingClientRect().right")
                   <= width, f"columns of the table are hidden in a page of {width}")
    # Stop while wasm is verified.
    verify = "async function verify(backend, system, reference, row, pause) {"
    browser.open(mutated(page, verify, verify + " while (row.backend === 'wasm') await pause();"), "integrators=semi-euler")
    browser.value("void measure()")
    browser.until("session && !session.finished && session.rows.some(row => row.backend === 'wasm')")
    browser.value("session.stopping = true")
    rows = rows_of(browser.results())
    expect([row["backend"] for row in rows] == ["javascript"] and rows[0]["status"].startswith("not timed"),
           f"rows without an end of their verification: {rows}")


def check_without(browser, page):
    """There is no WebGPU, no isolation, or no module; settings of the address."""
    interval = "document.querySelector('#rows td:nth-child(5)').textContent"
    browser.open(page, query_of("cloth2500", rounds=12, threads="03"))
    rows = rows_of(without := browser.results())
    expect(" to " in browser.value(interval), "the page does not show the interval of twelve rounds")
    expect({row["backend"]: row["threads"] for row in rows} == {"javascript": "1", "wasm": "1", "wasm-threads": "3"}, f"threads: {rows}")
    expect(json.loads(without)["provenance"]["threads"]["asked_for"] == 3, f"threads of the run: {without}")
    expect("webgpu" not in [row["backend"] for row in rows] and all(map(is_timed, rows)), f"rows without WebGPU: {rows}")
    expect("WebGPU" in browser.value("element('notes').textContent"), "the page does not say that there is no WebGPU")
    browser.open(page, query_of("cloth2500,nosuch", rounds=0))
    browser.until("element('state').textContent.includes('auto nosuch, rounds 0 (1 to 100)')")
    browser.open(page, query_of("cloth2500", rounds=2.5, more="&integrator=rk4&webgpu=off"))
    browser.until("element('state').textContent.includes('rounds 2.5 (1 to 100), integrator rk4, webgpu off')")
    browser.open(page, "rounds=500&seconds=abc&threads=1e2&integrator=rk4")
    browser.until("element('state').textContent.includes('rounds 500 (1 to 100), threads 1e2 (2 to 99), seconds abc (0.001 to 10), integrator rk4')")
    expect(browser.value("element('start').disabled"), "the page measures with settings that it does not know")
    browser.is_isolated = False
    browser.open(page, query_of("cloth2500"))
    rows = rows_of(browser.results())
    expect([row["backend"] for row in rows] == ["javascript", "wasm"] and all(map(is_timed, rows)), f"rows without isolation: {rows}")
    expect(not browser.value(interval), "the page shows an interval of one round")
    expect("Cross-Origin-Embedder-Policy" in browser.value("element('notes').textContent"), "the page does not say how to isolate it")
    browser.is_isolated = True
    # A page of an mssim that was built without a compiler for WebAssembly.
    browser.open(re.sub(rf'"(wasm\w*)":"{MODULE}"', r'"\1":null', page), query_of("cloth2500"))
    rows = rows_of(browser.results())
    expect([row["backend"] for row in rows] == ["javascript"] and is_timed(rows[0]), f"rows without a module: {rows}")
    for where in "notes", "module":
        expect("wasm-ld" in browser.value(f"element('{where}').textContent"), f"the page does not say that there is no wasm in: {where}")
    return {"without": without}


def main(chromium, page_file, folder):
    page = pathlib.Path(page_file).read_text(encoding="utf-8")

    def run(flags, *checks):
        with Browser(chromium, flags) as browser:
            return [found for check in checks for found in (check(browser, page) or {}).items()]

    with concurrent.futures.ThreadPoolExecutor() as pool:
        parts = [pool.submit(run, WEBGPU, check_rows, check_accidents), pool.submit(run, WEBGPU, check_mutants, check_person),
                 pool.submit(run, ["--disable-features=WebGPU"], check_without)]
    for name, text in [found for part in parts for found in part.result()]:
        (pathlib.Path(folder) / f"{name}.json").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
