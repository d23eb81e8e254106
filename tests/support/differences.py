#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Differences between pictures of two builds, such as other compilers or other versions of Embree.

usage: differences.py [--scene NAME] PROGRAM OTHER

Renders every shipped scene small with both programs, in three ways and through the CCTV camera.
Prints a row per picture: the number of different pixels, and the largest difference relative to the
picture's mean. Then compares the verdicts of two studies. Exit code 1 if a difference is above 1e-5
or a verdict differs.
"""
import argparse
import itertools
import json
import pathlib
import subprocess
import sys
import tempfile

from digests import PRESET, SMALL, TOP
import exr

MOST = 1e-5
WAYS = {"radiosity": [], "distributed": ["--set", "quality.gather_rays=8"], "paths": ["--set", "quality.gather_rays=8"]}


def run(program, *arguments):
    done = subprocess.run([program, *map(str, arguments), "-q", "--seed", "5", "-j", "1"], cwd=TOP, capture_output=True,
                          text=True, check=False)
    if done.returncode:
        sys.exit(f"{program} {' '.join(map(str, arguments))}: exit {done.returncode}\n{done.stderr}")


def pixels(path):
    _, columns, rows, channels = exr.read(path)
    return columns * rows, [values for name, values in channels.items() if name in "RGBY"]


def compare(name, one, other):
    (count, mine), (_, theirs) = pixels(one), pixels(other)
    mean = sum(map(sum, mine)) / (len(mine) * count)
    most = max(abs(a - b) for a, b in zip(itertools.chain(*mine), itertools.chain(*theirs)))
    apart = sum(any(a[k] != b[k] for a, b in zip(mine, theirs)) for k in range(count))
    print(f"| {name} | {apart} of {count} | {most / mean if mean > 0 else most:.1e} |", flush=True)
    return mean > 0 and most > MOST * mean


def pictures(programs, scene, out):
    name, wrong = f"{scene.parent.name}/{scene.stem}", 0
    for way, more in WAYS.items():
        for program, file in zip(programs, ("a.exr", "b.exr")):
            run(program, "render", scene, *SMALL, "--indirect", way, "-o", out / file, *more)
        wrong += compare(f"{name}, {way}", out / "a.exr", out / "b.exr")
    for program, file in zip(programs, ("c.exr", "d.exr")):  # of one picture: differences added by
                                                             # the camera's chain
        run(program, "degrade", out / "a.exr", "-o", out / file, "--preset", PRESET)
    return wrong + compare(f"{name}, degrade", out / "c.exr", out / "d.exr")


def verdicts(programs, out):
    bay, wrong = TOP / "scenes" / "library" / "sts46" / "night-lamps.toml", 0
    for study, more in (("visibility", []), ("orbit", ["--positions", "3"])):
        found = []
        for program, folder in zip(programs, (out / "e", out / "f")):
            run(program, "study", study, bay, *SMALL, *more, "-o", folder / study)
            table = json.loads((folder / study / "study.json").read_text(encoding="utf-8"))["results"]
            results = [dict(zip(table["columns"], row)) for row in table["rows"]]
            found.append({(r["condition"], r["camera"], r["target"]): (r["verdict"], r["probability.detect"]) for r in results})
        mine, theirs = found
        others = sum(mine[key][0] != theirs[key][0] for key in mine)
        chance = max(abs((mine[key][1] or 0) - (theirs[key][1] or 0)) for key in mine)
        print(f"\nstudy {study}: {len(mine)} verdicts, {others} differ; P(detect) by {chance:.1e} at most", flush=True)
        wrong += others
    return wrong


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("\n\n")[1].removeprefix("usage: "))
    parser.add_argument("--scene", default="")
    parser.add_argument("programs", nargs=2)
    call = parser.parse_args()
    print("| picture | pixels that differ | largest difference / mean |\n| --- | --- | --- |")
    with tempfile.TemporaryDirectory() as temporary:
        out, wrong = pathlib.Path(temporary), 0
        for scene in sorted((TOP / "scenes" / "library").rglob("*.toml")):
            if call.scene in str(scene):
                wrong += pictures(call.programs, scene, out)
        if call.scene in ("", "studies"):
            wrong += verdicts(call.programs, out)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
