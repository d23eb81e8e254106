# SPDX-License-Identifier: Apache-2.0
"""CPU seconds to an error, Earthshine and Blender Cycles on the same scenes: `./dev peers`.

Both programs render tests/data/peers at 256 x 256. Times are of whole processes, with start and
solution. Errors are against references of two other path tracers (tests/data/README.md).
"""
import argparse
import json
import math
import os
import pathlib
import re
import shutil
import statistics
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
TOP = HERE.parent.parent.parent
DATA = TOP / "tests" / "data" / "peers"
sys.path[:0] = [str(HERE), str(TOP / "tests" / "cli")]
import exr  # noqa: E402
import measures  # noqa: E402

# Settings of each program, cheapest first.
EARTHSHINE_ERRORS = [0.2, 0.1, 0.05, 0.02, 0.01, 0.005]
CYCLES_SAMPLES = [16, 64, 256, 1024]
QUICK_ERRORS = [0.2, 0.1, 0.05]
QUICK_SAMPLES = [16, 64]
WANTED = [0.05, 0.02, 0.01]
SEED = 1

# Noise of the references, and the luminance above which a pixel shows the lamp. In the Cornell box
# 0.5 gives the mean without lamp that was stated with the reference, 0.0623386. It excludes every
# pixel of which the lamp covers more than 1/25; above 12.4 the lamp fills the pixel. The other two
# scenes show no lamp or sky.
SCENES = {
    "bay": {"noise": 0.0071, "lamp_above": math.inf, "whole_lamp_above": math.inf},
    "cornell": {"noise": 0.0107, "lamp_above": 0.5, "whole_lamp_above": 12.4},
    "furnace": {"noise": 0.0196, "lamp_above": math.inf, "whole_lamp_above": math.inf},
}


def run(command):
    """CPU seconds, user and system, of the process and its children."""
    with subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True) as process:
        output = process.stdout.read()
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode not in (0, 3):  # 3: wanted error not reached
        sys.exit(f"{' '.join(map(str, command))}\nended with code {process.returncode}:\n{output}")
    return usage.ru_utime + usage.ru_stime


def earthshine(program, scene, setting, picture):
    return [program, "render", scene, "-q", "--seed", str(SEED), "--error", str(setting),
            "-o", picture]


def cycles(program, scene, setting, picture):
    return [program, "-b", "--factory-startup", "--python-exit-code", "1", "--python",
            HERE / "cycles_scene.py", "--", scene, picture, str(setting), str(SEED)]


def read_luminance(picture):
    _, width, height, channels = exr.read(picture)
    return width, height, measures.luminance(*(channels[name] for name in "RGB"))


class Scene:
    def __init__(self, name):
        self.name = name
        self.path = DATA / name / "scene.toml"
        self.noise = SCENES[name]["noise"]
        self.width, self.height, self.reference = measures.read_pfm(
            DATA / name / "reference-256.pfm")
        self.left_out = {"error": self.brighter_than(SCENES[name]["lamp_above"]),
                         "with_edge": self.brighter_than(SCENES[name]["whole_lamp_above"])}
        self.left_out["without_edge"] = measures.widened(self.left_out["error"], self.width,
                                                         self.height)

    def brighter_than(self, limit):
        return {k for k, y in enumerate(self.reference) if y > limit}

    def row(self, setting, seconds, picture):
        width, height, values = read_luminance(picture)
        if (width, height) != (self.width, self.height):
            sys.exit(f"{picture} has {width} x {height} pixels, its reference has not")
        found = {kind: measures.error_of(values, self.reference, self.noise, pixels)
                 for kind, pixels in self.left_out.items()}
        return {"setting": setting, "seconds": seconds, "bias": found["error"][1],
                **{kind: error for kind, (error, _) in found.items()}}


def measure(scene, name, command, program, settings, call):
    """One row per setting. Leaves the pictures in the folder."""
    rows = []
    for setting in settings:
        picture = call.folder / f"{scene.name}-{name}-{setting}.exr"
        note = picture.with_suffix(".json")
        kept = call.keep_cycles and name == "cycles" and picture.exists() and note.exists()
        if kept:
            seconds = json.loads(note.read_text(encoding="utf-8"))["seconds"]
        else:
            seconds = statistics.median(run(command(program, scene.path, setting, picture))
                                        for _ in range(call.repeats))
            note.write_text(json.dumps({"seconds": seconds}), encoding="utf-8")
        rows.append(scene.row(setting, seconds, picture))
        print(f"{scene.name:8} {name:10} {setting:<6} {seconds:8.1f} s {100 * rows[-1]['error']:6.2f} %",
              file=sys.stderr, flush=True)
    return rows


def percent(value, sign=""):
    return f"{100 * value:{sign}.2f} %"


def series_table(results):
    lines = ["| scene | program, setting | CPU s | error | bias | error with the lamp's edge | "
             "without its neighbours |",
             "| --- | --- | --- | --- | --- | --- | --- |"]
    for scene, programs in results.items():
        shows_lamp = SCENES[scene]["lamp_above"] < math.inf
        for label, rows in programs.items():
            asked = "--error" if label == "Earthshine" else "samples"
            for row in rows:
                edge = [percent(row[k]) if shows_lamp else "" for k in ("with_edge", "without_edge")]
                lines.append(f"| {scene} | {label}, {asked} {row['setting']} | {row['seconds']:.1f} | "
                             f"{percent(row['error'])} | {percent(row['bias'], '+')} | "
                             f"{edge[0]} | {edge[1]} |")
    return lines


def seconds_text(found):
    seconds, how = found
    if how == "never":
        return "never: bias"
    return {"measured": "", "at most": "≤ ", "extrapolated": "~ "}[how] + f"{seconds:.3g}"


def ratio_table(results, key):
    lines = ["| scene | error | Earthshine, CPU s | Cycles, CPU s | ratio |",
             "| --- | --- | --- | --- | --- |"]
    for scene, programs in results.items():
        for wanted in WANTED:
            found = [measures.seconds_to([(r["seconds"], r[key], r["bias"]) for r in rows], wanted)
                     for rows in programs.values()]
            (ours, how), (theirs, _) = found
            ratio = "none" if how == "never" else f"{ours / theirs:.3f}"
            lines.append(f"| {scene} | {100 * wanted:g} % | {seconds_text(found[0])} | "
                         f"{seconds_text(found[1])} | {ratio} |")
    return lines


def document(results, version):
    text = [
        f"Earthshine and {version}, 256 x 256; CPU seconds (user + system) of whole processes. Error: "
        "relative RMSE of luminance, pixel edges included, lamp pixels left out, the reference's own "
        "noise taken off. With the lamp's edge: only pixels that the lamp fills are left out; without "
        "its neighbours: also those beside a lamp pixel.", "",
        *series_table(results), "",
        "CPU seconds to an error, between the rows above by a straight line in log-log; ≤: the cheapest "
        "setting is better already; ~: beyond the best setting, as error ∝ seconds^(-1/2).", "",
        *ratio_table(results, "error"), ""]
    lamp = {name: rows for name, rows in results.items() if SCENES[name]["lamp_above"] < math.inf}
    if lamp:
        text += ["The same with the lamp's edge:", "", *ratio_table(lamp, "with_edge"), ""]
    return "\n".join(text)


def blender_version(program):
    text = subprocess.run([program, "--version"], capture_output=True, text=True, check=True).stdout
    found = re.search(r"Blender (\S+)", text)
    return f"Blender Cycles {found.group(1)}" if found else "Blender Cycles"


def read_call():
    parser = argparse.ArgumentParser(prog="./dev peers", description=__doc__.split("\n", 1)[0])
    parser.add_argument("--quick", action="store_true", help="the cheap settings only")
    parser.add_argument("--keep-cycles", action="store_true",
                        help="do not run Cycles again where its picture is in the folder")
    parser.add_argument("--repeats", type=int, default=1, help="runs per setting; the median counts")
    parser.add_argument("--scene", action="append", choices=SCENES, help="may be repeated")
    parser.add_argument("--folder", type=pathlib.Path, default=TOP / "out" / "peers")
    parser.add_argument("--program", default=TOP / "build" / "release" / "earthshine")
    parser.add_argument("--blender", default=shutil.which("blender"))
    return parser.parse_args()


def main():
    call = read_call()
    if call.blender is None:
        sys.exit("compare.py: there is no blender; ./dev peers installs it")
    call.folder.mkdir(parents=True, exist_ok=True)
    results = {}
    for name in call.scene or SCENES:
        scene = Scene(name)
        results[name] = {
            "Earthshine": measure(scene, "earthshine", earthshine, call.program,
                                  QUICK_ERRORS if call.quick else EARTHSHINE_ERRORS, call),
            "Cycles": measure(scene, "cycles", cycles, call.blender,
                              QUICK_SAMPLES if call.quick else CYCLES_SAMPLES, call)}
    text = document(results, blender_version(call.blender))
    (call.folder.parent / "peers.md").write_text(text, encoding="utf-8")
    print(text)


if __name__ == "__main__":
    main()
