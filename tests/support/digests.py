#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Digests of a program's results for every shipped scene. They show that a change of the code, or
another number of threads or ranks, changes no result.

usage: digests.py [--scene NAME] [--threads N[,M ...]] [--ranks R[,S ...]] PROGRAM [OTHER]

Renders, relights, solves, degrades and studies each scene small. Prints one line per result, "name
digest". With OTHER or several numbers of threads prints only different results, and exits with 1 if
there are any. With --ranks prints results of PROGRAM (earthshine-mpi) that differ between so many
ranks of mpirun and one process (render, solve, study orbit and visibility; the rest runs in one
process). Times, memory sizes, paths and versions are excluded.
"""
import argparse
import csv
import hashlib
import json
import os
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
# Keys whose values depend on the run, not on the result.
OF_THE_RUN = re.compile(r"build|scene_digest|seconds|_s$|time|memory|mib|bytes|version|date|command|written|file|path|folder|free")


def plain(value):
    if isinstance(value, dict):
        return {key: plain(inner) for key, inner in value.items() if not OF_THE_RUN.search(key.lower())}
    return [plain(inner) for inner in value] if isinstance(value, list) else value


def timeless(value):
    """The data from which the report can still be drawn."""
    if isinstance(value, dict):
        return {key: None if key == "provenance" or key.endswith("seconds") else timeless(inner) for key, inner in value.items()}
    return [timeless(inner) for inner in value] if isinstance(value, list) else value


# Costs are compared between numbers of threads but not of ranks, because ranks use each other's
# results.
WITHOUT_COSTS = " without costs"


def by_costs(study):
    return {"": study, WITHOUT_COSTS: study | {"costs": []}} if "costs" in study else {"": study}


def digest(data):
    return hashlib.sha256(data if isinstance(data, bytes) else json.dumps(data).encode()).hexdigest()[:16]


def of_file(path):
    if path.suffix == ".exr":
        _, columns, rows, channels = exr.read(path)
        return digest({name: digest(bytes(values)) for name, values in channels.items()} | {"": [columns, rows]})
    if path.suffix == ".csv":
        rows = list(csv.DictReader(path.open()))
        return digest(plain(rows))
    return digest(path.read_bytes())


# In a container, as root, more ranks than cores; without ssh.
ENVIRONMENT = os.environ | {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
                            "OMPI_MCA_rmaps_base_oversubscribe": "1", "OMPI_MCA_plm": "isolated", "OMPI_MCA_mpi_yield_when_idle": "1"}


def run(program, *arguments):
    by_ranks = arguments[0] in ("render", "solve") or arguments[:2] in (("study", "orbit"), ("study", "visibility"))
    if program[0] == "mpirun" and not by_ranks:
        program = program[3:]
    done = subprocess.run([*program, *map(str, arguments), "--quiet", "--seed", "5"], cwd=TOP, env=ENVIRONMENT,
                          stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)
    if done.returncode not in (0, 3):  # 3: done, wanted error not reached
        sys.exit(f"{' '.join(map(str, arguments))}: exit {done.returncode}\n{done.stderr}")
    return done.stdout


def of_scene(program, scene, out):
    name = f"{scene.parent.name}/{scene.stem}"
    picture = out / "picture.exr"
    report = lambda *call: digest(plain(json.loads(run(program, *call, "--json"))))  # noqa: E731
    for how in ("radiosity", "distributed", "paths"):
        more = ["--set", "quality.gather_rays=8"] if how != "radiosity" else ["--per-light"]
        yield f"{name} render {how} report", report("render", scene, *SMALL, "--indirect", how, "-o", picture, "--png",
                                                    out / "picture.png", *more)
        for file in (picture, out / "picture.png"):
            yield f"{name} render {how} {file.suffix}", of_file(file)
        if how == "radiosity":
            groups = json.loads(run(program, "relight", picture, "-o", out / "relit.exr", "--json"))["groups"]
            run(program, "relight", picture, "-o", out / "relit.exr", "--set", groups[0]["name"] + "=0.5")
            yield f"{name} relight", of_file(out / "relit.exr")
    for monitor in ("cctv.exr", "cctv.png"):
        run(program, "degrade", picture, "-o", out / monitor, "--preset", PRESET)
        yield f"{name} degrade {monitor}", of_file(out / monitor)
    yield f"{name} solve", report("solve", scene, "--error", "0.3", "-o", out / "kept.h5", "--glb", out / "kept.glb")
    yield f"{name} solve glb", of_file(out / "kept.glb")
    yield f"{name} form-factors", report("form-factors", scene, "--error", "0.05")
    yield f"{name} plan", report("plan", scene, *SMALL)
    yield f"{name} inspect", report("inspect", scene)


def of_studies(program, out):
    bay = TOP / "scenes" / "library" / "sts46" / "night-lamps.toml"
    box = TOP / "scenes" / "library" / "closed-box" / "scene.toml"
    for study in (["visibility", bay, *SMALL], ["orbit", bay, *SMALL, "--positions", "3"],
                  ["compare", box, "--lights", "4", "--size", "16x12"]):
        folder = out / study[0]
        run(program, "study", *study, "-o", folder)
        for file in sorted(folder.rglob("*")):
            if file.suffix in (".csv", ".png"):
                yield f"study {study[0]} {file.relative_to(folder)}", of_file(file)
        for path in sorted(folder.glob("*.json")):
            for costs, stated_study in by_costs(json.loads(path.read_text())).items():
                yield f"study {study[0]} {path.name}{costs}", digest(plain(stated_study))
        # Their names contain the build that wrote them.
        for number, found in enumerate(sorted(of_file(file) for file in folder.rglob("points/*.exr"))):
            yield f"study {study[0]} points {number}", found
        page, file = folder / "report.html", folder / "study.json"
        if file.exists():
            made, stated = page.read_bytes(), by_costs(json.loads(file.read_text()))
            run(program, "report", folder)
            yield f"study {study[0]} drawn anew", str(made == page.read_bytes())
            for costs, stated_study in stated.items():
                file.write_text(json.dumps(timeless(stated_study)))
                run(program, "report", folder)
                yield f"study {study[0]} report.html{costs}", of_file(page)


def results(program, only):
    with tempfile.TemporaryDirectory() as temporary:
        out = pathlib.Path(temporary)
        for scene in sorted((TOP / "scenes" / "library").glob("[!m]*/*.toml")):  # not materials
            if only is None or only in str(scene):
                yield from of_scene(program, scene, out)
        if only is None or only == "studies":
            yield from of_studies(program, out)


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("\n\n")[1].removeprefix("usage: "))
    parser.add_argument("--scene")
    parser.add_argument("--threads", default="0")
    parser.add_argument("--ranks", default="")
    parser.add_argument("programs", nargs="+")
    call = parser.parse_args()
    runs = [[program, "-j", threads] for threads in call.threads.split(",") for program in call.programs]
    runs += [["mpirun", "-n", ranks, *runs[0]] for ranks in call.ranks.split(",") if ranks]
    first = dict(results(runs[0], call.scene))
    if len(runs) == 1:
        for name, value in first.items():
            print(name, value)
        return 0
    wrong = 0
    for other in runs[1:]:
        second = dict(results(other, call.scene))
        names = [name for name in sorted(first.keys() | second.keys()) if other[0] != "mpirun" or name + WITHOUT_COSTS not in first]
        different = [name for name in names if first.get(name) != second.get(name)]
        for name in different:
            print(f"{name}: {first.get(name)} {second.get(name)}")
        print(f"{' '.join(other)}: {len(names)} results, {len(different)} differ", file=sys.stderr)
        wrong += len(different)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
