# SPDX-License-Identifier: Apache-2.0
"""The lighting console in headless Chromium (console/check.mjs) against the program's own pictures: clean pictures with random
lamp settings by `relight`, monitors of all built-in cameras by `degrade` without noise, verdicts by `study`.

usage: console_browser.py PROGRAM [OUT]    screenshots go to OUT

Exit code 77 without a browser, Node.js or report/node_modules.
"""
import base64
import itertools
import json
import os
import pathlib
import random
import re
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


def page_data(path):
    return json.loads(re.search(r'id="data">(.*?)</script>', path.read_text(encoding="utf-8"), re.S).group(1))


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


# More targets on the floor: small, dim, nearly as bright as the floor, moving.
TARGETS = "".join(f"""
[[material]]
name = "m{k}"
diffuse = {albedo}

[[object]]
name = "t{k}"
shape = "box"
min = [{x}, {y}, 0]
max = [{x + side}, {y + side}, {side}]
material = "m{k}"
target = true
{motion}
""" for k, (x, y, side, albedo, motion) in enumerate((
    (0.6, -1.2, 0.1, 0.05, ""), (1.0, 0.6, 0.3, 0.5, ""), (-1.2, -1.2, 0.06, 0.8, ""), (-1.3, 0.9, 0.4, 0.57, ""),
    (0.2, 1.1, 0.2, 0.2, "velocity = [0.5, 0.2, 0]"))))
POSITIONS = (0, 180)
# Camera model of A, settings of its camera. B has its own eye in one of them.
MODELS = (("sit-monochrome", {"iris": "peak"}), ("sit-monochrome", {"iris": "fixed", "f_number": 4}), ("sit-colour-wheel", {"iris": "average"}),
          ("ccd-colour", {"iris": "normal"}), ("ccd-colour", {"iris": "fixed", "f_number": 11, "gain_db": 20}), ("report-1990", {"iris": "normal"}),
          ("ideal", {"iris": "peak"}), ("sit-monochrome", {"iris": "normal", "gain_max_db": 6}))
SETTINGS = 13  # of the lamps for each model, at each place: 208 in all


def toml(settings):
    return "".join(f"{name} = {json.dumps(value)}\n" for name, value in settings.items())


def verdicts(bench, draw, presets):
    """Verdicts and figures of `study run` at random settings of lamps, Sun and Earth, for each camera model and place, in the page's words."""
    cases = []
    for k, (preset, settings) in enumerate(MODELS):
        camera, lamps, wanted = "BAAABAAA"[k], [], []
        for n in range(SETTINGS):
            # Log-uniform over five decades, so that targets lie on both sides of all thresholds.
            wanted.append({light: 0 if draw.random() < 0.2 else float(f"{4 * 10 ** draw.uniform(-5, 0):.4g}") for light in LIGHTS})
            lamps.append(f'[[lamps]]\nname = "s{n}"\nset = {{ {", ".join(f"{light} = {factor}" for light, factor in wanted[n].items())} }}\n')
        monitor = next(entry["monitor"] for entry in presets if entry["name"] == preset)
        by_eye = k == 0  # B has no CCTV of its own
        (bench.folder / "v.toml").write_text(
            f'format = 1\nname = "v"\nscene = "bay.toml"\ncameras = ["{camera}"]\nsize = "48x48"\n' + "\n".join(lamps) +
            f'\n[[cctv]]\nname = "own"\npreset = "{preset}"\n{toml(settings)}\n[monitor]\n{toml(monitor)}\n[camera_models]\n'
            f'{camera} = "{"none" if by_eye else "own"}"\n[orbit]\npositions_deg = {list(POSITIONS)}\n', encoding="utf-8")
        bench.run("study", "run", "v.toml", "-o", "verdicts", "-q")
        study = study_table.opened(json.loads((bench.folder / "verdicts" / "study.json").read_text(encoding="utf-8")))
        condition = {entry["id"]: (entry["lamps"], entry["position_deg"]) for entry in study["conditions"]}
        for n, place in itertools.product(range(SETTINGS), range(len(POSITIONS))):
            own = "" if by_eye else f"&model={preset}&" + "&".join(f"c.{name}={value}" for name, value in settings.items())
            cases.append({"text": f"camera={camera}&place={place}&" + "&".join(f"l.{light}={factor}" for light, factor in wanted[n].items()) + own,
                          "targets": [{"name": row["target"], "verdict": row["verdict"], "luminance": row.get("luminance"), "weber": row.get("weber"),
                                       "chances": list(row["probability"].values()) if row.get("probability") else None,
                                       "reasons": row["reasons"] if n < 3 and row["why_of"] is None else [],
                                       **{name: (row.get("signal") or {}).get(name) for name in ("snr", "snr_d")}}
                                      for row in study["results"] if condition[row["condition"]] == (f"s{n}", POSITIONS[place])]})
    return cases


def of_study(bench):
    """A study along the orbit, and its console: verdicts at each stop."""
    bench.run("study", "orbit", "bay.toml", "--at", ",".join(map(str, POSITIONS)), "--size", "48x48", "-o", "orbit", "-q")
    bench.run("console", "orbit", "-o", "study.html", "-q")
    study = study_table.opened(json.loads((bench.folder / "orbit" / "study.json").read_text(encoding="utf-8")))
    place_of = {entry["id"]: POSITIONS.index(entry["position_deg"]) for entry in study["conditions"]}
    return [{"text": f"camera={camera}&place={place}",
             "targets": [{"name": row["target"], "verdict": row["verdict"], "luminance": row.get("luminance"), "weber": row.get("weber"), "reasons": [],
                          "chances": list(row["probability"].values()) if row.get("probability") else None}
                         for row in study["results"] if (row["camera"], place_of[row["condition"]]) == (camera, place)]}
            for camera in "AB" for place in range(len(POSITIONS))]


def main():
    program, out = pathlib.Path(sys.argv[1]).resolve(), [pathlib.Path(name).resolve() for name in sys.argv[2:]]
    node = shutil.which("node") or shutil.which("nodejs")
    if not node or not (TOP / "report" / "node_modules").is_dir():
        print("skipped: no Node.js or no report/node_modules")
        return SKIPPED
    with tempfile.TemporaryDirectory() as name:
        bench, draw = Bench(program, pathlib.Path(name)), random.Random(SEED)
        # Each built-in camera has its own monitor; the scene's small one would replace it. At this error a study needs no
        # samples for its settings, so that page and study have the same picture.
        scene = tiny_bay.BAY.replace(tiny_bay.SMALL_MONITOR, "").replace("[quality]", "[quality]\nerror = 1")
        (bench.folder / "bay.toml").write_text(scene + TARGETS, encoding="utf-8")
        bench.run("console", "bay.toml", "-o", "console.html", "--layers", "layers", "-q")
        bench.run("console", "bay.toml", "-o", "orbit.html", "--positions", str(len(POSITIONS)), "-q")
        presets = page_data(bench.folder / "orbit.html")["presets"]
        words = ["camera=A", "camera=A&l.left=0.5&t.right=%23ff8000", "camera=A&view=monitor&c.iris=fixed&c.f_number=8&m.gamma=2", "camera=A&white=50"]
        expected = {"cameras": 2, "clean": clean(bench, draw, 3), "monitor": monitor(bench, draw), "verdicts": [{"page": str(bench.folder / "orbit.html"), "cases": verdicts(bench, draw, presets)},
                                 {"page": str(bench.folder / "study.html"), "cases": of_study(bench)}],
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
