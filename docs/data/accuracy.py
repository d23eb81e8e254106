#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures what accuracy costs on the shipped scenes: runs `study accuracy` on each (or goes on with what is kept in
out/accuracy), copies the plots to docs/images and writes the tables of docs/data/accuracy.md between its markers. With names
of plots it does so for these alone and leaves the other chapters as they are.
Usage: docs/data/accuracy.py PROGRAM [NAME ...]"""
import json
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
PAGE = ROOT / "docs/data/accuracy.md"
BEGIN, END = "<!-- docs/data/accuracy.py writes this: begin -->", "<!-- docs/data/accuracy.py writes this: end -->"
# Name of the plots, scene, camera, size.
VIEWS = [
    ("closed-box", "closed-box/scene", None, "64x64"),
    ("furnace", "furnace/scene", None, "64x64"),
    ("cornell", "cornell-box/scene", None, "96x96"),
    ("still-life", "still-life/scene", None, "96x72"),
    ("day", "sts46/day-earthshine", "B", "64x64"),
    ("sun", "sts46/day-sun", "B", "64x64"),
    ("night", "sts46/night-lamps", "B", "64x64"),
    ("lamp-failed", "sts46/night-lamp-failed", "B", "64x64"),
]


def percent(value):
    return "–" if value is None else f"{100 * value:.2g} %"


def seconds(value):
    return "–" if value is None else f"{value:.2g}" if value < 10 else f"{value:.0f}"


def count(value):
    return "" if value is None else f"{value:,.0f}".replace(",", " ")


def study(program, scene, camera, size, folder):
    call = ["study", "accuracy", f"scenes/library/{scene}.toml", "--size", size, "--lights", "4,16,64", "--time-limit", "360", "-o",
            str(folder.relative_to(ROOT))]
    call += ["--camera", camera] if camera else []
    subprocess.run([program, *call], cwd=ROOT, check=True, stdout=subprocess.DEVNULL)
    return json.loads((folder / "accuracy.json").read_text()), "earthshine " + " ".join(call)


def short(command):
    """The settings of a call alone."""
    words = command.split()
    kept = [word for word in words[words.index("--size") + 2:words.index("-o")]]
    return "`" + (" ".join(kept) or "as it is") + "`"


def table(head, rows):
    return "\n".join(["| " + " | ".join(head) + " |", "|" + " --- |" * len(head)] +
                     ["| " + " | ".join(row) + " |" for row in rows]) + "\n"


def points_of(result):
    rows = []
    for point in result["points"]:
        front = "●" if point["on_front"] else ""
        rows.append((front, point["method"], point["series"], short(point["command"]), percent(point["error"]),
                     percent(point["setting_error"]), percent(point["estimate"]), percent(point["bound_95"]),
                     seconds(point["cpu_seconds"]), count(point["memory_mib"]), count(point["patches"])))
    return table(("front", "method", "varied", "settings", "error", "of the setting", "stated", "stated bound", "CPU s",
                  "MiB", "patches"), rows)


def laws_of(result):
    rows = []
    for law in result["laws"]:
        if law["exponent"] is None:
            continue
        uncertainty = f" ± {law['exponent_std_error']:.2f}" if law["exponent_std_error"] is not None else ""
        rows.append((f"{law['method']} {law['series']}", law["x"], f"{law['exponent']:.2f}{uncertainty}", percent(law["floor"])))
    return table(("series", "x", "error ~ x^-p, p", "floor"), rows)


def wanted_of(result):
    rows = []
    for wanted in result["wanted"]:
        for method, found in wanted["methods"].items():
            setting, apart = found["setting"], found["setting_apart_from_limit"]
            taken = setting or apart
            how = "" if setting else "apart from the method's limit" if apart else "not reached"
            rows.append((percent(wanted["wanted"]), method, short(taken["command"]) if taken else "–",
                         seconds(taken["cpu_seconds"]) if taken else "–", count(taken["memory_mib"]) if taken else "", how))
    return table(("wanted", "method", "settings", "CPU s", "MiB", ""), rows)


def chapter(name, result, command):
    limits = "; ".join(f"{limit['method']} {percent(limit['error'])}" for limit in result["limits"] if limit["error"])
    title = f"{result['scene'].removeprefix('scenes/library/')}, camera {result['camera']}"
    text = [f"### {title}, {result['columns']} x {result['rows']}", "", f"`{command}`", "",
            f"![Error against CPU seconds and memory](../images/accuracy-{name}-seconds.svg)",
            f"![Error against each setting](../images/accuracy-{name}-settings.svg)", "",
            f"Reference: two pictures of {result['reference']['paths_per_pixel']} paths a pixel, which resolve errors from "
            f"{percent(result['reference']['resolution'])} on. Limits that no setting gets past: {limits or 'none'}.", ""]
    text += [found["sentence"] for found in result["worth"]]
    return "\n".join(text) + "\n\n" + wanted_of(result) + "\n" + laws_of(result) + "\n" + points_of(result)


def chapters_of(page):
    """The chapters between the markers, by the name of their plots."""
    chapters = page.split(BEGIN)[1].split(END)[0].strip().split("\n### ")
    chapters = ["### " + chapter.removeprefix("### ").strip() + "\n" for chapter in chapters if chapter]
    return {re.search(r"images/accuracy-(.*)-seconds.svg", chapter)[1]: chapter for chapter in chapters}


def main():
    program = str(pathlib.Path(sys.argv[1]).resolve())
    wanted = sys.argv[2:] or [name for name, *_ in VIEWS]
    page = PAGE.read_text()
    chapters = chapters_of(page)
    for name, scene, camera, size in VIEWS:
        if name not in wanted:
            continue
        folder = ROOT / "out/accuracy" / name
        folder.parent.mkdir(parents=True, exist_ok=True)
        result, command = study(program, scene, camera, size, folder)
        for plot in ("seconds", "settings"):
            shutil.copy(folder / f"error-{plot}.svg", ROOT / f"docs/images/accuracy-{name}-{plot}.svg")
        chapters[name] = chapter(name, result, command)
    before, after = page.split(BEGIN)[0], page.split(END)[1]
    text = "\n".join(chapters[name] for name, *_ in VIEWS if name in chapters)
    PAGE.write_text(before + BEGIN + "\n\n" + text + "\n" + END + after)


if __name__ == "__main__":
    main()
