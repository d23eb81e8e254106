# SPDX-License-Identifier: Apache-2.0
"""study orbit, study run and study visibility: what they write, and that a run that was ended goes on."""
import csv
import json
import os
import random
import re
import signal
import subprocess
import time
import unittest

import program

# A box on a floor under two lamps, along an orbit, before two cameras of which one has a CCTV; another box
# stands where neither looks.
BAY = """format = 1
name = "tiny bay"
unit = "m"

[[material]]
name = "white"
diffuse = 0.6

[[material]]
name = "paint"
diffuse = [0.3, 0.4, 0.5]

[[object]]
name = "floor"
shape = "quad"
corners = [[-2, -2, 0], [2, -2, 0], [2, 2, 0], [-2, 2, 0]]
material = "white"

[[object]]
name = "box"
shape = "box"
min = [-0.4, -0.4, 0]
max = [0.4, 0.4, 0.6]
material = "paint"
target = true

[[object]]
name = "far"
shape = "box"
min = [40, 40, 0]
max = [41, 41, 1]
material = "paint"
target = true

[[light]]
name = "left"
group = "bay"
type = "point"
position = [1.5, 0, 2]
intensity = [900, 800, 700]

[[light]]
name = "right"
group = "bay"
type = "point"
position = [-1.5, 0, 2]
intensity = 500

[sun]

[earth]

[orbit]
altitude_km = 425
attitude = "bay-to-space"

[[camera]]
name = "A"
position = [3, -3, 2]
look_at = [0, 0, 0.4]
up = [0, 0, 1]
fov_deg = 40
resolution = [48, 48]
cctv = "sit-monochrome"

[[camera]]
name = "B"
position = [0, 0, 6]
look_at = [0, 0, 0]
up = [0, 1, 0]
fov_deg = 50
resolution = [48, 48]

[quality]
patch_edge = 0.5
refine = false
form_factor_rays = 64
gather_rays = 16
"""

STUDY = """format = 1
name = "day and night"
scene = "bay.toml"
targets = ["box"]
size = "32x32"
wanted = ["box>=0.5"]
iris = ["fixed", "normal"]

[orbit]
positions_deg = [180, 0]

[[lamps]]
name = "on"

[[lamps]]
name = "right alone"
others = "off"
set = { right = 0.5 }

[[picture]]
name = "noon"
camera = "A"
position_deg = 0

[[picture]]
name = "few lights"
camera = "A"
position_deg = 0
shows = "distributed"
lights = 4

[[picture]]
name = "night"
camera = "A"
position_deg = 180
lamps = "right alone"
shows = "cctv"

[[pair]]
title = "both"
left = "noon"
right = "night"
"""

VERDICTS = {"identified", "recognised", "detected", "doubtful", "not-seen", "out-of-view", "hidden"}


class Case(program.Case):
    def setUp(self):
        super().setUp()
        self.write("bay.toml", BAY)
        self.write("s.toml", STUDY)

    def files(self, folder):
        return sorted(os.listdir(self.folder / folder))

    def all_files(self, folder):
        return sorted(str(path.relative_to(self.folder / folder)) for path in (self.folder / folder).rglob("*"))

    def study(self, folder):
        text = (self.folder / folder / "study.json").read_text(encoding="utf-8")
        return json.loads(text, parse_constant=lambda word: self.fail(f"{word} in the JSON"))

    def no_nonsense(self, folder):
        """No number that is none in anything a person reads."""
        for name in ("study.json", "results.csv", "report.html"):
            text = (self.folder / folder / name).read_text(encoding="utf-8")
            text = re.sub(r"<(script|style|svg)\b.*?</\1>", "", text, flags=re.S)
            self.assertNotRegex(text, r"(?i)(?<![\w.-])-?(nan|inf|infinity)(?![\w-])", name)
        return self.study(folder)

    @staticmethod
    def without_times(study):
        """What must be the same on every run."""
        def strip(value):
            if isinstance(value, dict):
                return {key: strip(item) for key, item in value.items()
                        if key not in ("seconds", "render_seconds", "costs")}
            return [strip(item) for item in value] if isinstance(value, list) else value
        return strip(study)

    def costs(self, folder):
        return {cost["stage"]: cost["found"] for cost in self.study(folder)["costs"]}

    def refused_cleanly(self, *arguments, folder="d"):
        message = self.refused(*arguments, "-o", folder)
        self.assertEqual(len([line for line in message.splitlines() if line.startswith("earthshine: ")]), 1, message)
        self.assertFalse((self.folder / folder).exists(), f"{arguments}: {message}")
        return message


class Orbit(Case):
    CALL = ("study", "orbit", "bay.toml", "--positions", "6", "--wanted", "box>=0.5", "--iris", "fixed,peak")

    def test_folder_and_results(self):
        printed = self.json(*self.CALL, "-o", "o")
        study = self.no_nonsense("o")
        self.assertEqual(printed, study)
        self.assertEqual(self.files("o"), ["pictures", "points", "report.html", "results.csv", "study.json"])
        self.assertEqual((study["format"], study["study"], study["complete"], study["targets"]),
                         (1, "visibility", True, ["box", "far"]))
        self.assertEqual([camera["name"] for camera in study["cameras"]], ["A", "B"])
        self.assertEqual([camera["cctv"] for camera in study["cameras"]], ["sit-monochrome", None])
        positions = [condition["position_deg"] for condition in study["conditions"]]
        self.assertEqual(positions, [0, 60, 120, 180, 240, 300])
        phases = [condition["phase"] for condition in study["conditions"]]
        self.assertEqual(phases, ["day", "day", "eclipse", "eclipse", "eclipse", "day"])
        for condition in study["conditions"]:
            self.assertGreaterEqual(set(condition), {"id", "scene", "name", "lamps", "time_s", "sun_share",
                                                     "factors", "earth_error"})
        self.assertEqual(len(study["results"]), 6 * 2 * 2)
        ids = {condition["id"] for condition in study["conditions"]}
        for result in study["results"]:
            self.assertIn(result["condition"], ids)
            self.assertIn(result["verdict"], VERDICTS)
            cctv = result["camera"] == "A"
            if result["target"] == "far":
                self.assertEqual((result["verdict"], result["luminance"], result["lit_fraction"], result["signal"]),
                                 ("out-of-view", None, None, None))
                self.assertEqual(set(result["probability"].values()), {None})
                continue
            self.assertEqual((result["signal"] is not None, result["monitor"] is not None), (cctv, cctv))
            self.assertGreater(result["pixels"], 0)
            self.assertTrue(all(0 <= p <= 1 for p in result["probability"].values()))
            light = sum(source["luminance"] for source in result["light_by"])
            self.assertAlmostEqual(light / result["luminance"], 1, places=4)
            self.assertLessEqual(result["luminance_error"], result["luminance_bound"])
        # Under the same lamps and the same sky on either side of noon there is the same light.
        detect = {(line["camera"], line["target"]): line["detect"] for line in study["timelines"]}
        self.assertEqual(set(detect), {(c, t) for c in "AB" for t in ("box", "far")})
        self.assertEqual(detect["A", "far"], [None] * 6)
        self.assertEqual(study["timelines"][0]["position_deg"], positions)
        for figure in study["figures"]:
            self.assertTrue((self.folder / "o" / figure["file"]).is_file())
            self.assertTrue((self.folder / "o" / figure["exr"]).is_file())
        self.assertGreater(len(study["pairs"]), 0)
        answer, = study["answers"]
        self.assertTrue(answer["found"])
        self.assertIn(answer["camera"], "AB")
        for begin, end in answer["arcs_deg"]:
            self.assertLess(begin, end)
        rows = list(csv.DictReader((self.folder / "o" / "results.csv").read_text(encoding="utf-8").splitlines()))
        self.assertEqual([(row["camera"], row["target"], row["verdict"]) for row in rows],
                         [(result["camera"], result["target"], result["verdict"]) for result in study["results"]])

    def test_same_results_on_any_number_of_threads_and_again(self):
        for threads in ("1", "2"):
            self.done(*self.CALL, "-o", threads, "-j", threads)
        first = self.study("1")
        self.assertEqual(self.without_times(first), self.without_times(self.study("2")))
        self.assertEqual(set(self.costs("1").values()), {False})
        run = self.run_program(*self.CALL, "-o", "1")
        self.assertEqual((run.returncode, run.stderr.count("done again")), (0, 0), run.stderr)
        self.assertEqual(self.without_times(self.study("1")), self.without_times(first))
        self.assertEqual(self.costs("1"), {f"{what} s0 {camera}": True for what in ("picture", "conditions")
                                           for camera in "AB"})

    def test_positions_may_be_listed_in_any_order(self):
        study = self.json("study", "orbit", "bay.toml", "-o", "o", "--at", "180,0,90", "--camera", "B",
                          "--wanted", "box>=0.5")
        self.assertEqual([condition["position_deg"] for condition in study["conditions"]], [0, 90, 180])
        for begin, end in study["answers"][0]["arcs_deg"]:
            self.assertLessEqual(begin, end)

    def test_dry_run_writes_nothing_and_knows_what_is_there(self):
        text = self.done(*self.CALL, "-o", "o", "--dry-run")
        self.says(text, "6 places", "camera A", "camera B")
        self.assertFalse((self.folder / "o").exists())
        self.done(*self.CALL, "-o", "o", "--camera", "A")
        before = self.all_files("o")
        plan = self.json(*self.CALL, "-o", "o", "--dry-run")
        self.assertEqual([camera["found"] for camera in plan["scenes"][0]["cameras"]], [True, False])
        self.assertEqual(self.all_files("o"), before)

    def test_what_changed_is_done_again(self):
        call = ("study", "orbit", "bay.toml", "-o", "o", "--at", "0", "--camera", "B")
        self.done(*call)
        for more in (("--set", "quality.gather_rays=32"), ("--set", "light.left.intensity=10"), ("--seed", "2"),
                     ("--size", "40x40"), ("--set", "camera.B.fov_deg=51"), ("--set", "orbit.altitude_km=500")):
            self.done(*call, *more)
            self.assertFalse(self.costs("o")["picture s0 B"], more)
        # Another position has the picture of another sky.
        self.done(*call[:5], "--at", "10", "--camera", "B")
        self.assertFalse(self.costs("o")["picture s0 B"])
        # What is asked about the picture does not change it.
        self.done(*call, "--wanted", "box>=0.9")
        self.assertTrue(self.costs("o")["picture s0 B"])


class Resume(Case):
    CALL = ("study", "orbit", "bay.toml", "--positions", "12", "--wanted", "box>=0.5")

    def started(self, *arguments):
        run = subprocess.Popen([program.PROGRAM, *arguments], cwd=self.folder, stdin=subprocess.DEVNULL,
                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        self.addCleanup(run.stderr.close)
        self.addCleanup(run.wait)
        self.addCleanup(run.kill)
        return run

    def test_a_killed_run_goes_on(self):
        begin = time.monotonic()
        self.done(*self.CALL, "-o", "whole")
        took = time.monotonic() - begin
        chance = random.Random(1)
        ended = 0
        for _ in range(5):
            run = self.started(*self.CALL, "-o", "o")
            time.sleep(took * chance.random())
            run.send_signal(signal.SIGKILL)
            run.wait()
            ended += run.returncode == -signal.SIGKILL
        self.assertGreater(ended, 0)
        whole_pictures = [path.stem for path in (self.folder / "o" / "points").glob("*.exr")
                          if path.with_suffix(".json").exists()]
        last = self.run_program(*self.CALL, "-o", "o")
        self.assertEqual(last.returncode, 0, last.stderr)
        self.assertNotIn("done again", last.stderr)
        self.assertEqual(self.without_times(self.study("o")), self.without_times(self.study("whole")))
        found = [stage for stage, found in self.costs("o").items() if found and stage.startswith("picture")]
        self.assertEqual(len(found), len(whole_pictures))
        self.assertEqual(self.all_files("o"), self.all_files("whole"))  # nothing torn or temporary beside them

    def test_torn_parts_are_done_again(self):
        self.done(*self.CALL, "-o", "o")
        whole = self.without_times(self.study("o"))
        points = self.folder / "o" / "points"
        for path in points.glob("*"):
            path.write_bytes(path.read_bytes()[:100])
        run = self.run_program(*self.CALL, "-o", "o")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.says(run.stderr, "done again")
        self.assertEqual(self.without_times(self.study("o")), whole)
        self.assertEqual(set(self.costs("o").values()), {False})

    def test_an_interrupted_run_says_so_and_goes_on(self):
        call = ("study", "orbit", "bay.toml", "--positions", "4", "-o", "o", "--wanted", "box>=0.5",
                "--set", "quality.gather=per-sample", "--set", "quality.gather_rays=2048")
        run = self.started(*call)
        while run.poll() is None and not (self.folder / "o" / "points").exists():
            time.sleep(0.01)
        time.sleep(0.3)
        run.send_signal(signal.SIGINT)
        _, errors = run.communicate()
        self.assertEqual(run.returncode, 1, errors)
        self.says(errors, "interrupted", "again")
        study = self.no_nonsense("o")
        self.assertFalse(study["complete"])
        self.assertEqual(len(study["conditions"]), 4)
        self.done("report", "o")
        self.says((self.folder / "o" / "report.html").read_text(encoding="utf-8"), "stopped")
        self.done(*call)
        self.assertTrue(self.study("o")["complete"])
        self.assertEqual(len(self.study("o")["results"]), 4 * 2 * 2)


class Run(Case):
    def test_a_study_file(self):
        text = self.done("study", "run", "s.toml", "-o", "o")
        self.says(text, "box", "right alone", "box>=0.5")
        study = self.no_nonsense("o")
        self.assertEqual(study["name"], "day and night")
        self.assertEqual([(c["position_deg"], c["lamps"]) for c in study["conditions"]],
                         [(0, "on"), (180, "on"), (0, "right alone"), (180, "right alone")])
        self.assertEqual(study["targets"], ["box"])
        self.assertEqual([figure["name"] for figure in study["figures"]], ["noon", "few lights", "night"])
        self.assertEqual([pair["title"] for pair in study["pairs"]], ["both"])
        self.assertEqual(len(study["results"]), 4 * 2)
        light = {source["group"]: source["luminance"] for source in study["results"][3]["light_by"]}
        self.assertEqual(light["bay"], 0)
        self.assertGreater(light["right"], 0)
        self.says(self.done("study", "run", "s.toml", "-o", "o", "--dry-run"), "picture found")

    def test_two_scenes_with_cameras_of_the_same_names(self):
        self.write("dim.toml", BAY.replace("intensity = 500", "intensity = 5"))
        self.write("two.toml", STUDY.replace('scene = "bay.toml"', 'scenes = ["bay.toml", "dim.toml"]'))
        study = self.json("study", "run", "two.toml", "-o", "o")
        self.assertEqual([scene["id"] for scene in study["scenes"]], ["s0", "s1"])
        self.assertEqual([(c["scene"], c["name"]) for c in study["cameras"]],
                         [("s0", "A"), ("s0", "B"), ("s1", "A"), ("s1", "B")])
        self.assertEqual([figure["name"] for figure in study["figures"]], ["noon", "few lights", "night"])
        self.assertEqual(len(study["results"]), 2 * 4 * 2)
        # The pictures are those of the first scene.
        self.done("study", "run", "s.toml", "-o", "one")
        for figure in study["figures"]:
            self.assertEqual((self.folder / "o" / figure["file"]).read_bytes(),
                             (self.folder / "one" / figure["file"]).read_bytes())


class Visibility(Case):
    def test_wanted_and_iris(self):
        printed = self.json("study", "visibility", "bay.toml", "-o", "v", "--wanted", "box>=0.9", "--iris", "peak,average")
        answer, = printed["answers"]
        self.assertEqual((answer["wanted"], answer["target"], answer["least"]), ("box>=0.9", "box", 0.9))
        self.assertEqual(answer["arcs_deg"], [])
        self.assertIn(answer["iris"], (None, "peak", "average"))
        self.assertEqual([(row["camera"], row["target"]) for row in printed["targets"]],
                         [(c, t) for c in "AB" for t in ("box", "far")])
        self.assertTrue(all(row["verdict"] in VERDICTS for row in printed["targets"]))
        self.no_nonsense("v")
        self.says(self.done("study", "visibility", "bay.toml", "-o", "w", "--dry-run"), "1 places", "camera B")
        self.assertFalse((self.folder / "w").exists())


class Refused(Case):
    def orbit(self, *more, scene="bay.toml"):
        return self.refused_cleanly("study", "orbit", scene, *more)

    def test_wrong_calls(self):
        self.says(self.orbit("--camera", "Z"), '"Z"', "A", "B")
        self.says(self.orbit("--wanted", "lid>=0.5"), '"lid"', "box", "far")
        self.says(self.orbit("--wanted", "box"), "TARGET>=P")
        self.says(self.orbit("--iris", "wide"), "wide")
        for positions in ("0", "-3", "3601", "x", "1.5"):
            self.says(self.orbit(f"--positions={positions}"), "--positions")
        for at in ("361", "x", "0,0", "1,", "nan", "inf"):
            self.says(self.orbit(f"--at={at}"), "--at")
        self.says(self.orbit("--size", "0x4"), "--size")
        self.refused_cleanly("study", "orbit", "none.toml")
        self.refused_cleanly("study", "visibility", "bay.toml", "--wanted", "lid>=0.5")
        self.refused_cleanly("study", "visibility", "bay.toml", "--camera", "Z")

    def test_scenes_that_will_not_do(self):
        self.write("still.toml", BAY.replace('[orbit]\naltitude_km = 425\nattitude = "bay-to-space"\n', "")
                   .replace("[sun]", "[sun]\ndirection = [0, 0, 1]").replace("[earth]\n", ""))
        self.says(self.orbit(scene="still.toml"), "[orbit]", "altitude_km")
        self.write("inside.toml", BAY.replace("position = [0, 0, 6]", "position = [0, 0, 0.3]"))
        self.says(self.orbit(scene="inside.toml"), "box")
        self.write("blind.toml", BAY.split("[[camera]]")[0])
        self.says(self.orbit(scene="blind.toml"), "camera")
        for altitude in ("0", "-400", "nan"):
            self.write("low.toml", BAY.replace("altitude_km = 425", f"altitude_km = {altitude}"))
            self.says(self.orbit(scene="low.toml"), "low.toml:", "altitude_km")

    def test_study_files_that_will_not_do(self):
        def run(text, *words):
            self.write("bad.toml", text)
            self.says(self.refused_cleanly("study", "run", "bad.toml"), *words)
        run(STUDY.replace('targets = ["box"]', 'targets = ["bok"]'), '"bok"', '"box"')
        run(STUDY.replace("set = { right = 0.5 }", "set = { moon = 0.5 }"), '"moon"', "left")
        run(STUDY.replace("position_deg = 180", "position_deg = 90"), "bad.toml:", "90", "positions")
        run(STUDY.replace('lamps = "right alone"', 'lamps = "none"'), "bad.toml:", '"none"', "right alone")
        run(STUDY.replace('camera = "A"', 'camera = "Z"'), "bad.toml:", '"Z"')
        run(STUDY.replace('"box>=0.5"', '"lid>=0.5"'), '"lid"')
        run(STUDY.replace('wanted = ["box>=0.5"]', 'cameras = ["Z"]'), '"Z"')
        run(STUDY.replace("size =", "camera_models = { Z = \"sit-monochrome\" }\nsize ="), '"Z"', "A, B")
        run(STUDY.replace("size =", "camera_models = { A = \"betacam\" }\nsize ="), "betacam")
        run(STUDY.replace('shows = "cctv"', 'shows = "cctv"\n').replace('camera = "A"\nposition_deg = 180',
                                                                        'camera = "B"\nposition_deg = 180'), '"B"', "CCTV")
        run(STUDY.replace("bay.toml", "none.toml"), "none.toml")
        self.says(self.refused_cleanly("study", "run", "gone.toml"), "gone.toml")

    def test_folder_that_cannot_be(self):
        self.says(self.refused("study", "run", "s.toml", "-o", "bay.toml"), "bay.toml", "folder")
        (self.folder / "o" / "study.json").mkdir(parents=True)
        self.says(self.refused("study", "run", "s.toml", "-o", "o"), "study.json", "folder")
        self.assertEqual(self.all_files("o"), ["study.json"])

    @unittest.skipIf(os.geteuid() == 0, "the superuser may write anywhere")
    def test_folder_that_is_not_writable(self):
        (self.folder / "o").mkdir(mode=0o500)
        self.says(self.refused("study", "run", "s.toml", "-o", "o", code=1), "cannot be written")


class Empty(Case):
    def judged(self, scene, *more):
        self.write("empty.toml", scene)
        self.done("study", "orbit", "empty.toml", "-o", "o", "--at", "0,180", *more)
        return self.no_nonsense("o")

    def test_a_camera_that_sees_nothing(self):
        study = self.judged(BAY.replace("look_at = [0, 0, 0]", "look_at = [0.5, 0.5, 12]"), "--camera", "B",
                            "--wanted", "box>=0.5")
        self.assertEqual({result["verdict"] for result in study["results"]}, {"out-of-view"})
        answer, = study["answers"]
        self.assertEqual((answer["found"], answer["least_factor"], answer["arcs_deg"]), (False, None, []))

    def test_a_scene_without_targets(self):
        study = self.judged(BAY.replace("target = true\n", ""))
        self.assertEqual((study["targets"], study["results"], study["timelines"]), ([], [], []))
        self.assertEqual((self.folder / "o" / "results.csv").read_text(), "")
        self.says(self.done("study", "orbit", "empty.toml", "-o", "o", "--at", "0,180"), "No object is a target")

    def test_a_target_that_is_hidden(self):
        lid = BAY.replace('[[light]]\nname = "left"', '[[object]]\nname = "lid"\nshape = "box"\nmin = [-1, -1, 1]\n'
                          'max = [1, 1, 1.2]\nmaterial = "white"\n\n[[light]]\nname = "left"')
        study = self.judged(lid, "--camera", "B", "--wanted", "box>=0.5")
        for result in study["results"]:
            if result["target"] == "box":
                self.assertEqual((result["verdict"], result["pixels"], result["visible_fraction"]), ("hidden", 0, 0))
                self.says(result["why"], "lid")

    def test_no_light_at_all(self):
        dark = BAY.replace("[900, 800, 700]", "0").replace("intensity = 500", "intensity = 0")
        study = self.judged(dark, "--wanted", "box>=0.5")
        for result in study["results"]:
            if result["condition"] == "s0-c1" and result["target"] == "box":
                self.assertEqual((result["verdict"], result["luminance"], result["lit_fraction"]), ("not-seen", 0, 0))
                self.assertIsNone(result["luminance_error"])


if __name__ == "__main__":
    unittest.main()
