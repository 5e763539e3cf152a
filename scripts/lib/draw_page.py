#!/usr/bin/env python3
"""Draws the results of a page of mssim web as the page shows them: draw_page.py CHROMIUM PAGE FOLDER OUT.png, of a result folder.

The page keeps its rows in the tab, in case the browser ends it (keptAs in src/web/browser/page.js): it gets those of the folder there.
"""
import base64
import csv
import json
import pathlib
import sys

from browser import Browser


def kept_rows(folder):
    """What the page keeps of its rows; it works out the rest again."""
    with open(folder / "samples.csv", encoding="utf-8", newline="") as file:
        samples = list(csv.DictReader(file))
    names = ("scene", "backend", "integrator")
    with open(folder / "timings.csv", encoding="utf-8", newline="") as file:
        return [{**{name: row[name] for name in (*names, "status", "note")}, "nodes": int(row["nodes"]),
                 "verified": row["verified"] == "true", "position_error": float(row["position_error"] or "nan"),
                 "samples": [float(it["ms_per_step"]) for it in samples if all(it[name] == row[name] for name in names)]}
                for row in csv.DictReader(file)]


def main(chromium, page, folder, out):
    folder = pathlib.Path(folder)
    started = json.loads((folder / "provenance.json").read_text(encoding="utf-8"))["started_utc"]
    kept = {"notes": [], "started": started, "finished": True, "done": 1, "units": 1, "rows": kept_rows(folder)}
    with Browser(chromium, []) as browser:
        browser.resize(1280, 800)
        browser.open(pathlib.Path(page).read_text(encoding="utf-8"))
        browser.value(f"sessionStorage.setItem(keptAs, {json.dumps(json.dumps(kept))})")
        browser.ask("Page.reload")
        browser.until("typeof element === 'function' && Boolean(element('chart').children.length)")
        top, bottom = (browser.value(f"{of}.getBoundingClientRect().{edge} + scrollY")
                       for of, edge in (("element('results-title')", "top"), ("element('chart')", "bottom")))
        clip = {"x": 0, "y": top - 12, "width": 1280, "height": bottom - top + 24, "scale": 1}
        picture = browser.ask("Page.captureScreenshot", format="png", captureBeyondViewport=True, clip=clip)
    pathlib.Path(out).write_bytes(base64.b64decode(picture["data"]))


if __name__ == "__main__":
    main(*sys.argv[1:])
