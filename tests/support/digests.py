#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Digests of what a program makes of every shipped scene, to show that a change of the code changed no result.

usage: digests.py PROGRAM [OTHER]

Renders, solves, degrades and studies each scene small. Prints one line per result, "name digest"; with OTHER only
those that differ, and exits with 1 if any does. Times, sizes of memory, paths and versions are left out.
"""
import csv
import hashlib
import json
import pathlib
import re
import subprocess
import sys
import tempfile

TOP = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(TOP / "tests" / "cli"))
import exr  # noqa: E402

PRESET = "sit-monochrome"
SMALL = ["--size", "40x30", "--error", "0.2"]
# Keys whose values are those of a run, not of its result.
OF_THE_RUN = re.compile(r"build|seconds|_s$|time|memory|mib|bytes|version|date|command|written|file|path|folder|free")


def plain(value):
    if isinstance(value, dict):
        return {key: plain(inner) for key, inner in value.items() if not OF_THE_RUN.search(key.lower())}
    return [plain(inner) for inner in value] if isinstance(value, list) else value


def digest(data):
    return hashlib.sha256(data if isinstance(data, bytes) else json.dumps(data).encode()).hexdigest()[:16]


def of_file(path):
    if path.suffix == ".exr":
        _, columns, rows, channels = exr.read(path)
        return digest({name: digest(bytes(values)) for name, values in channels.items()} | {"": [columns, rows]})
    if path.suffix == ".json":
        return digest(plain(json.loads(path.read_text())))
    if path.suffix == ".csv":
        rows = list(csv.DictReader(path.open()))
        return digest(plain(rows))
    return digest(path.read_bytes())


def run(program, *arguments):
    done = subprocess.run([program, *map(str, arguments), "--quiet", "--seed", "5"], cwd=TOP,
                          capture_output=True, text=True, check=False)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, arguments))}: exit {done.returncode}\n{done.stderr}")
    return done.stdout


def results(program):
    scenes = sorted((TOP / "scenes" / "library").rglob("*.toml"))
    with tempfile.TemporaryDirectory() as temporary:
        out = pathlib.Path(temporary)
        for scene in scenes:
            name = f"{scene.parent.name}/{scene.stem}"
            picture = out / "picture.exr"
            for how in ("radiosity", "distributed", "paths"):
                more = ["--set", "quality.gather_rays=8"] if how != "radiosity" else ["--per-light"]
                text = run(program, "render", scene, *SMALL, "--indirect", how, "-o", picture, "--png",
                           out / "picture.png", "--json", *more)
                yield f"{name} render {how} report", digest(plain(json.loads(text)))
                for file in (picture, out / "picture.png"):
                    yield f"{name} render {how} {file.suffix}", of_file(file)
            for monitor in ("cctv.exr", "cctv.png"):
                run(program, "degrade", picture, "-o", out / monitor, "--preset", PRESET)
                yield f"{name} degrade {monitor}", of_file(out / monitor)
            text = run(program, "solve", scene, "--error", "0.3", "--json")
            yield f"{name} solve", digest(plain(json.loads(text)))
            yield f"{name} plan", digest(plain(json.loads(run(program, "plan", scene, *SMALL, "--json"))))
            text = run(program, "inspect", scene, "--json")
            yield f"{name} inspect", digest(plain(json.loads(text)))
        bay = TOP / "scenes" / "library" / "sts46" / "night-lamps.toml"
        for study in (["visibility", bay, *SMALL], ["orbit", bay, *SMALL, "--positions", "3"]):
            folder = out / study[0]
            run(program, "study", *study, "-o", folder)
            for file in sorted(folder.rglob("*")):
                if file.suffix in (".csv", ".png") or file.name == "study.json":
                    yield f"study {study[0]} {file.relative_to(folder)}", of_file(file)
            # Their names hold the build that made them.
            for number, found in enumerate(sorted(of_file(file) for file in folder.rglob("points/*.exr"))):
                yield f"study {study[0]} points {number}", found


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    first = dict(results(sys.argv[1]))
    if len(sys.argv) == 2:
        for name, value in first.items():
            print(name, value)
        return 0
    second = dict(results(sys.argv[2]))
    different = [name for name in sorted(first.keys() | second.keys()) if first.get(name) != second.get(name)]
    for name in different:
        print(f"{name}: {first.get(name)} {second.get(name)}")
    print(f"{len(first)} results, {len(different)} differ", file=sys.stderr)
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
