#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Hard cases with a wanted error: the stated error, the true error, and the path tracer's cost.

usage: hard_cases.py PROGRAM [--error E] [--time-limit S] [--only NAME]

The true error is measured with two runs of the path tracer (tests/validation/error_truth.py). The
last column is the message if a limit came first.
"""
import argparse
import json
import pathlib
import resource
import subprocess
import sys
import tempfile

TOP = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(TOP / "tests" / "validation"))
import error_scenes  # noqa: E402
import error_truth  # noqa: E402
import hard_scenes  # noqa: E402

NAMES = ("sun spot", "pinhole", "baffle", "small emitter", "lamp at a wall", "corridor", "lit white room", "room 8")
# Paths of a reference, per pixel: enough for its noise to be below the measured error.
PATHS = {"lit white room": 128, "pinhole": 65536, "corridor": 65536, "sun spot": 16384, "room 8": 16384}


def scenes():
    """(name, scene, options of the path tracer)."""
    known = {hard.name: (hard.text, hard.traced or hard.text) for hard in hard_scenes.all_of_them()}
    known["room 8"] = (error_scenes.room(8),) * 2
    return [(name, *known[name]) for name in NAMES]


def run(folder, program, *words):
    """(report, standard error, CPU seconds)."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([program, *map(str, words), "--json"], cwd=folder, capture_output=True, text=True)
    if done.returncode not in (0, 3):  # 3: wanted error not reached
        sys.exit(f"{' '.join(map(str, words))}: {done.stderr}")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return json.loads(done.stdout), done.stderr, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("--error", default="0.05")
    parser.add_argument("--time-limit", default="120")
    parser.add_argument("--size", default="32x32")
    parser.add_argument("--only", action="append")
    call = parser.parse_args()
    program = call.program.resolve()
    print("| case | stated | bound 95 % | true | CPU s | paths: CPU s, noise | says |\n| --- | --- | --- | --- | --- | --- | --- |")
    for name, text, traced in scenes():
        if call.only and name not in call.only:
            continue
        with tempfile.TemporaryDirectory() as temporary:
            folder = pathlib.Path(temporary)
            (folder / "flood.ies").write_text(error_scenes.IES)
            (folder / "scene.toml").write_text(text)
            (folder / "traced.toml").write_text(traced)
            paths, references = 0.0, []
            for seed in (71, 72):
                _, _, seconds = run(folder, program, "render", "traced.toml", "--size", call.size, "--indirect", "paths", "--seed",
                                    seed, "--set", f"quality.gather_rays={PATHS.get(name, 4096)}", "-o", "paths.exr", "-q")
                references.append(error_truth.picture(folder / "paths.exr")[0])
                paths += seconds / 2
            report, said, seconds = run(folder, program, "render", "scene.toml", "--size", call.size, "--error", call.error,
                                        "--time-limit", call.time_limit, "-o", "out.exr")
            truth = error_truth.compare(error_truth.picture(folder / "out.exr")[0], *references)
            noise = error_truth.compare(references[0], references[1], references[1]).error / 2**0.5
        error = report["error"]
        known = [f"{100 * x:.2g} %" if x is not None else "none" for x in (error["estimate"], error["bound_95"])]
        says = "; ".join(line.strip() for line in said.splitlines() if "limit" in line or "needs" in line or "not captured" in line)
        print(f"| {name} | {known[0]} | {known[1]} | {100 * truth.error:.2g} ± "
              f"{100 * truth.squared_error_std / max(2 * truth.error, 1e-9):.1g} % | {seconds:.3g} | {paths:.3g}, {100 * noise:.2g} % | {says} |",
              flush=True)


if __name__ == "__main__":
    main()
