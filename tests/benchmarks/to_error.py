# SPDX-License-Identifier: Apache-2.0
"""CPU seconds to a true error, compared with the program's path tracer. Prints a table as Markdown.

    to_error.py PROGRAM [--scene SCENE.toml]... [--camera C]... [--size 256x256] [--errors 0.05,0.02] [--paths 512]
                        [--references 2] [--cache DIR]

Truth: path-traced pictures of independent noise and all light paths (error_truth.py); two, or more
for small errors of noisy scenes. They are kept in DIR. Errors and mean luminances are over pixels
whose centre shows a surface, as for stated errors. The difference of the references gives the path
tracer's noise with the same weights. Its time for the same error is its seconds times (its noise /
the error)^2. Its seconds are measured with a sixteenth of the paths in the same run as the compared
picture, because references may be from another day or machine.
"""
import argparse
import json
import math
import os
import pathlib
import subprocess
import sys

TOP = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TOP / "tests" / "validation"))
import error_truth  # noqa: E402

SCENES = [TOP / "scenes/library/sts46" / f"{name}.toml" for name in ("night-lamps", "day-sun", "day-earthshine")]
FIRST_SEED = 11  # of the references
TIMED = 16  # the path tracer is timed with this fraction of its paths, 1/TIMED


def run(*words):
    """(standard output, CPU seconds)."""
    process = subprocess.Popen(list(map(str, words)), stdout=subprocess.PIPE, text=True)
    out = process.stdout.read()
    _, status, used = os.wait4(process.pid, 0)
    if os.waitstatus_to_exitcode(status) not in (0, 3):  # 3: wanted error not reached
        raise SystemExit(f"to_error: {' '.join(map(str, words))} ended with status {status}")
    return out, used.ru_utime + used.ru_stime


def trace_paths(call, scene, camera, paths, seed, picture):
    """CPU seconds."""
    return run(call.program, "render", scene, "--camera", camera, "--size", call.size,
               "--indirect", "paths", "--set", f"quality.gather_rays={paths}", "--seed", seed, "-q", "-o", picture)[1]


def shows_surface(call, scene, camera):
    """Per pixel: 1 if its centre shows a surface, 0 if it shows the sky."""
    picture = call.cache / f"{scene.stem}-{camera}-{call.size}-objects.exr"
    if not picture.exists():
        run(call.program, "render", scene, "--camera", camera, "--size", call.size,
            "--indirect", "none", "--no-error", "--aov", "object", "-q", "-o", picture)
    return [float(thing >= 0) for thing in error_truth.picture(picture, "object")[1]]


def references(call, scene, camera):
    """Luminances of each reference."""
    found = []
    for seed in range(FIRST_SEED, FIRST_SEED + call.references):
        picture = call.cache / f"{scene.stem}-{camera}-{call.size}-{call.paths}-{seed}.exr"
        if not picture.exists():
            unfinished = picture.with_suffix(".part.exr")
            trace_paths(call, scene, camera, call.paths, seed, unfinished)
            unfinished.rename(picture)
        found.append(error_truth.picture(picture)[0])
    return found


def noise(first, second, counts):
    """Noise of one of the two, relative to their mean, with the weights of compare()."""
    pairs = [(a, b) for a, b, c in zip(first, second, counts) if c]
    mean = sum(map(sum, pairs)) / (2 * len(pairs))
    square = sum((error_truth.weight((a + b) / 2, mean) * (a - b))**2 for a, b in pairs) / (2 * len(pairs))
    return math.sqrt(square) / mean


def rows(call, scene, camera):
    first, second, *more = references(call, scene, camera)
    counts = shows_surface(call, scene, camera)
    of_paths = noise(first, second, counts)
    timed = max(1, call.paths // TIMED)
    path_seconds = trace_paths(call, scene, camera, timed, FIRST_SEED, call.cache / "timed.exr") * call.paths / timed
    for asked in call.errors:
        picture = call.cache / "picture.exr"
        out, seconds = run(call.program, "render", scene, "--camera", camera, "--size", call.size,
                           "--error", asked, "--seed", call.seed, "-q", "--json", "-o", picture)
        error = json.loads(out)["error"]
        truth = error_truth.compare(error_truth.picture(picture)[0], first, second, counts, more)
        unsure = truth.squared_error_std / (2 * truth.error) if truth.error > 0 else math.sqrt(truth.squared_error_std)
        paths = path_seconds * (of_paths / max(truth.error, 1e-6))**2
        yield (f"| {scene.stem} {camera} | {100 * asked:g} % | {100 * error['estimate']:.1f}, {100 * error['bound_95']:.1f} % | "
               f"{100 * truth.error:.1f} ± {100 * unsure:.1f} % | {100 * truth.bias:+.2f} % | {seconds:.1f} | {paths:.0f} | "
               f"{seconds / paths:.3f} |")


def main():
    parser = argparse.ArgumentParser(description="CPU seconds to a true error, beside a path tracer's")
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("--scene", action="append", type=pathlib.Path, help="a file; default: three of sts46")
    parser.add_argument("--camera", action="append")
    parser.add_argument("--size", default="256x256")
    parser.add_argument("--errors", type=lambda text: [float(one) for one in text.split(",")], default=[0.05, 0.02])
    parser.add_argument("--paths", type=int, default=512, help="a pixel, of each reference")
    parser.add_argument("--references", type=int, default=2)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--cache", type=pathlib.Path, default=TOP / "out" / "error-references")
    call = parser.parse_args()
    call.program = call.program.resolve()
    call.cache.mkdir(parents=True, exist_ok=True)
    print("| scene | asked | stated, bound | true | bias | CPU s | paths, CPU s | ratio |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- |")
    for scene in call.scene or SCENES:
        for camera in call.camera or ["B"]:
            for row in rows(call, scene, camera):
                print(row, flush=True)


if __name__ == "__main__":
    main()
