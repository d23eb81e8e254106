# SPDX-License-Identifier: Apache-2.0
"""The lighting console in headless Chromium (console/check.mjs) against the program's own pictures: clean pictures with random
lamp settings by `relight`, monitors of all built-in cameras by `degrade` without noise, targets by `study`.

usage: console_browser.py PROGRAM [OUT]    screenshots go to OUT

Exit code 77 without a browser, Node.js or report/node_modules.
"""
import base64
import json
import os
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile

os.environ["EARTHSHINE_PROGRAM"] = sys.argv[1]
import exr  # noqa: E402
import study_table  # noqa: E402
import tiny_bay  # noqa: E402

TOP = pathlib.Path(__file__).resolve().parent.parent.parent
SKIPPED = 77
LIGHTS = ("left", "right", "sun", "earth")
SEED = 7


class Bench:
    def __init__(self, program, folder):
        self.program, self.folder = program, folder

    def run(self, *arguments):
        done = subprocess.run([self.program, *map(str, arguments)], cwd=self.folder, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise RuntimeError(f"{arguments}: {done.stderr}")
        return done.stdout

    def png(self, path):
        return base64.b64encode((self.folder / path).read_bytes()).decode()

    def planes(self, path, names):
        channels = exr.read(self.folder / path)[3]
        return [list(channels[name]) for name in names]


def setting(draw):
    """A factor for each light: off, dimmed, or coloured. In the form of the page's fragment and of --set."""
    fragment, calls = [], []
    for light in LIGHTS:
        kind = draw.random()
        if kind < 0.2:
            fragment.append(f"off.{light}=true")
            calls += ["--set", f"{light}=0"]
        elif kind < 0.9:
            factor = round(draw.uniform(0, 2.5), 3)
            fragment.append(f"l.{light}={factor}")
            calls += ["--set", f"{light}={factor}"]
    return "&".join(fragment), calls


def clean(bench, draw, count):
    pictures = []
    for camera in ("A", "B"):
        for _ in range(count):
            fragment, calls = setting(draw)
            bench.run("relight", f"layers/{camera}.exr", *calls, "-o", "r.exr", "--png", "r.png", "-q")
            pictures.append({"text": f"camera={camera}&{fragment}", "sums": bench.planes("r.exr", "RGB"), "png": bench.png("r.png")})
    # Hue of a tint in sRGB: half of full scale, 0x80, is 0.2159 in linear light.
    bench.run("relight", "layers/A.exr", "--set", "left=1,0.21586050011,0", "-o", "r.exr", "--png", "r.png", "-q")
    pictures.append({"text": "camera=A&t.left=%23ff8000", "sums": bench.planes("r.exr", "RGB"), "png": bench.png("r.png")})
    return pictures


def monitor(bench, draw):
    cases = []
    presets = [entry["name"] for entry in json.loads(bench.run("degrade", "--list", "--json"))["presets"]]
    for preset in presets:
        fragment, calls = setting(draw)
        bench.run("relight", "layers/A.exr", *calls, "-o", "r.exr", "-q")
        report = json.loads(bench.run("degrade", "r.exr", "--preset", preset, "--off", "signal-noise", "--off", "read-noise", "-o", "m.png",
                                      "--json", "-q"))
        cases.append({"text": f"camera=A&view=monitor&model={preset}&{fragment}", "png": bench.png("m.png"), "f_number": report["f_number"]})
    return cases


def targets(bench):
    bench.run("study", "visibility", "bay.toml", "--size", "48x48", "-o", "study", "-q")
    study = study_table.opened(json.loads((bench.folder / "study" / "study.json").read_text(encoding="utf-8")))
    found = []
    for camera in ("A", "B"):
        rows = [row for row in study["results"] if row["camera"] == camera]
        found.append({"text": f"camera={camera}", "targets": [{"name": row["target"], "luminance": row["luminance"], "weber": row["weber"]} for row in rows]})
    return found


def main():
    program, out = pathlib.Path(sys.argv[1]).resolve(), [pathlib.Path(name).resolve() for name in sys.argv[2:]]
    node = shutil.which("node") or shutil.which("nodejs")
    if not node or not (TOP / "report" / "node_modules").is_dir():
        print("skipped: no Node.js or no report/node_modules")
        return SKIPPED
    with tempfile.TemporaryDirectory() as name:
        bench, draw = Bench(program, pathlib.Path(name)), random.Random(SEED)
        # Each built-in camera has its own monitor; the scene's small one would replace it.
        (bench.folder / "bay.toml").write_text(tiny_bay.BAY.replace(tiny_bay.SMALL_MONITOR, ""), encoding="utf-8")
        bench.run("console", "bay.toml", "-o", "console.html", "--layers", "layers", "-q")
        words = ["camera=A", "camera=A&l.left=0.5&t.right=%23ff8000", "camera=A&view=monitor&c.iris=fixed&c.f_number=8&m.gamma=2", "camera=A&white=50"]
        expected = {"cameras": 2, "patience": 5, "clean": clean(bench, draw, 3), "monitor": monitor(bench, draw), "targets": targets(bench),
                    "words": words, "words_file": str(bench.folder / "words.json")}
        (bench.folder / "expected.json").write_text(json.dumps(expected), encoding="utf-8")
        code = subprocess.run([node, TOP / "console" / "check.mjs", bench.folder / "console.html", bench.folder / "expected.json", *out]).returncode
        if code != 0:
            return code
        for said in json.loads((bench.folder / "words.json").read_text(encoding="utf-8")):
            (bench.folder / "s.toml").write_text(said["study"], encoding="utf-8")
            bench.run("study", "run", "s.toml", "-o", "d", "--dry-run")
            print(f"ok    the program reads the study of {said['text']}")
        return 0


if __name__ == "__main__":
    sys.exit(main())
