# SPDX-License-Identifier: Apache-2.0
"""study orbit, study run and study visibility: their output."""
import csv
import math
import json
import unittest

from tiny_bay import BAY, STUDY, VERDICTS, Case


class Orbit(Case):
    CALL = ("study", "orbit", "bay.toml", "--positions", "6", "--wanted", "box>=0.5", "--iris", "fixed,peak")

    def check_thumbnails(self, study):
        """Small pictures: the first position, midnight, each position at which a verdict changes,
        and each position at which a target that is not hidden is missed."""
        wanted = set()
        for camera in {result["camera"] for result in study["results"]}:
            before = None
            for condition in study["conditions"]:
                verdicts = [result["verdict"] for result in study["results"]
                            if (result["camera"], result["condition"]) == (camera, condition["id"])]
                missed = {"doubtful", "not-seen"} & set(verdicts)
                if condition["position_deg"] in (0, 180) or verdicts != before or missed:
                    wanted.add((camera, condition["id"]))
                before = verdicts
        shown = study["thumbnails"]
        self.assertEqual({(small["camera"], small["condition"]) for small in shown}, wanted)
        cctv = {camera["name"]: camera["cctv"] is not None for camera in study["cameras"]}
        for small in shown:
            self.assertEqual(small["monitor_file"] is not None, cctv[small["camera"]])
            for file in filter(None, (small["file"], small["monitor_file"])):
                self.assertTrue((self.folder / "o" / file).is_file(), file)
        page = (self.folder / "o" / "report.html").read_text(encoding="utf-8")
        self.assertEqual(page.count('<figure id="p'), len(shown))

    def test_folder_and_results(self):
        printed = self.printed(*self.CALL, "-o", "o")
        study = self.no_nonsense("o")
        self.assertEqual(printed, study)
        self.assertEqual(self.files("o"), ["pictures", "points", "report.html", "results.csv", "study.json"])
        self.assertEqual((study["format"], study["study"], study["complete"], study["targets"]),
                         (2, "visibility", True, ["box", "far"]))
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
                self.assertIsNone(result["probability"])
                continue
            self.assertEqual((result["signal"] is not None, result["monitor"] is not None), (cctv, cctv))
            self.assertGreater(result["pixels"], 0)
            self.assertTrue(all(0 <= p <= 1 for p in result["probability"].values()))
            # Groups below a hundredth are omitted, and each figure has four digits.
            self.assertAlmostEqual(sum(result["light_by"].values()) / result["luminance"], 1, delta=0.03)
            self.assertLessEqual(result["luminance_error"], result["luminance_bound"])
        # Each part of a result has its columns, even if it is missing.
        columns = json.loads((self.folder / "o" / "study.json").read_text(encoding="utf-8"))["results"]["columns"]
        for column in ("probability.identify", "signal.mean", "monitor.threshold", "eye.probability.detect"):
            self.assertEqual(columns.count(column), 1, column)
        # Positions on either side of noon with the same lamps and sky have the same light.
        detect = {(c, t): [r["probability"] and r["probability"]["detect"] for r in study["results"]
                           if (r["camera"], r["target"]) == (c, t)] for c in "AB" for t in ("box", "far")}
        self.assertEqual(detect["A", "far"], [None] * 6)
        page = (self.folder / "o" / "report.html").read_text(encoding="utf-8")
        self.assertEqual(page.count('<figure class="timeline"'), len(detect))
        for figure in study["figures"]:
            self.assertTrue((self.folder / "o" / figure["file"]).is_file())
            self.assertTrue((self.folder / "o" / figure["exr"]).is_file())
        self.assertGreater(len(study["pairs"]), 0)
        self.check_thumbnails(study)
        answer, = study["answers"]
        self.assertTrue(answer["found"])
        self.assertIn(answer["camera"], "AB")
        self.says(answer["text"], f"best by camera {answer['camera']}", "deg")
        for begin, end in answer["arcs_deg"]:
            self.assertLess(begin, end)
            self.assertTrue(0 <= begin < 360 and end <= begin + 360)
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
        self.assertEqual((run.returncode, run.stderr.count("recomputed")), (0, 0), run.stderr)
        self.assertEqual(self.without_times(self.study("1")), self.without_times(first))
        self.assertEqual(self.costs("1"), {f"{what} s0 {camera}": True for what in ("picture", "conditions")
                                           for camera in "AB"})

    def test_positions_may_be_listed_in_any_order(self):
        study = self.printed("study", "orbit", "bay.toml", "-o", "o", "--at", "180,0,90", "--camera", "B",
                          "--wanted", "box>=0.5")
        self.assertEqual([condition["position_deg"] for condition in study["conditions"]], [0, 90, 180])
        for begin, end in study["answers"][0]["arcs_deg"]:
            self.assertLessEqual(begin, end)

    def test_the_orbit_is_in_the_results(self):
        # The bay toward the Sun: its axis is the Sun's direction, cos b cos p along the zenith,
        # -cos b sin p along the motion and sin b along the normal (scenes/sky/orbit.h). The Sun's
        # centre is at the angle t from the Earth's, cos t = -cos b cos p. With radii E (sin E =
        # 6371 / 6796) and S = 0.2666 deg the umbra has t < E - S and the penumbra t < E + S, which
        # differ by 0.63 deg.
        study = self.printed("study", "orbit", "bay.toml", "-o", "o", "--at", "0", "--camera", "B", "--set", "orbit.beta_deg=30",
                             "--set", 'orbit.attitude="bay-to-sun"')
        orbit = study["scenes"][0]["orbit"]
        self.assertEqual((orbit["altitude_km"], orbit["beta_deg"], orbit["attitude"]), (425, 30, "bay-to-sun"))
        earth = math.degrees(math.asin(6371 / 6796))
        for name, seen in (("umbra_deg", earth - 0.2666), ("penumbra_deg", earth + 0.2666)):
            half = math.degrees(math.acos(math.cos(math.radians(seen)) / math.cos(math.radians(30))))
            for angle, expected in zip(orbit[name][0], (180 - half, 180 + half), strict=True):
                self.assertAlmostEqual(angle, expected, delta=0.02)
        for axis, (cosine, sine) in zip(orbit["bay"], ((1, 0), (0, 1), (-1, 0), (0, -1)), strict=True):
            self.assertAlmostEqual(axis["zenith"], math.cos(math.radians(30)) * cosine, places=6)
            self.assertAlmostEqual(axis["forward"], -math.cos(math.radians(30)) * sine, places=6)
            self.assertAlmostEqual(axis["normal"], 0.5, places=6)

    def test_the_terminal_states_the_figure_that_decides(self):
        dim = BAY.replace("intensity = [900, 800, 700]", "intensity = 0.01").replace("intensity = 500", "intensity = 0.01")
        self.write("dim.toml", dim)
        text = self.done("study", "orbit", "dim.toml", "-o", "o", "--at", "180", "--camera", "A")
        self.assertRegex(text, r"at 180 deg: (contrast on the monitor|signal to noise|cycles across it) [\d.e-]+, (threshold|needed) [\d.]+; ")

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
        for more in (("--set", "quality.error=0.04"), ("--set", "light.left.intensity=10"), ("--seed", "2"),
                     ("--size", "40x40"), ("--set", "camera.B.fov_deg=51"), ("--set", "orbit.altitude_km=500")):
            self.done(*call, *more)
            self.assertFalse(self.costs("o")["picture s0 B"], more)
        # Another position has another sky and another picture.
        self.done(*call[:5], "--at", "10", "--camera", "B")
        self.assertFalse(self.costs("o")["picture s0 B"])
        # Queries about the picture do not change it.
        self.done(*call, "--wanted", "box>=0.9")
        self.assertTrue(self.costs("o")["picture s0 B"])


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
        light = study["results"][3]["light_by"]
        self.assertNotIn("bay", light)
        self.assertGreater(light["right"], 0)
        self.says(self.done("study", "run", "s.toml", "-o", "o", "--dry-run"), "picture found")

    def test_a_coloured_factor_is_in_the_results_and_the_report(self):
        """Light through three filters: a factor per colour, in study.json and on the page."""
        self.write("c.toml", STUDY.replace("set = { right = 0.5 }", "set = { right = [1, 0.5, 0.2] }"))
        self.done("study", "run", "c.toml", "-o", "o")
        coloured = [list(c["factors"].values()) for c in self.study("o")["conditions"] if c["factors"]]
        self.assertEqual(coloured, [[[1, 0.5, 0.2]]] * 2)
        page = (self.folder / "o" / "report.html").read_text(encoding="utf-8")
        self.assertIn("right 1 0.5 0.2", page)
        self.done("report", "o")
        self.assertEqual((self.folder / "o" / "report.html").read_text(encoding="utf-8"), page)

    def test_two_scenes_with_cameras_of_the_same_names(self):
        self.write("dim.toml", BAY.replace("intensity = 500", "intensity = 5"))
        self.write("two.toml", STUDY.replace('scene = "bay.toml"', 'scenes = ["bay.toml", "dim.toml"]'))
        study = self.printed("study", "run", "two.toml", "-o", "o")
        self.assertEqual([scene["id"] for scene in study["scenes"]], ["s0", "s1"])
        self.assertEqual([(c["scene"], c["name"]) for c in study["cameras"]],
                         [("s0", "A"), ("s0", "B"), ("s1", "A"), ("s1", "B")])
        self.assertEqual([figure["name"] for figure in study["figures"]], ["noon", "few lights", "night"])
        self.assertEqual(len(study["results"]), 2 * 4 * 2)
        # Both have the same name: their files distinguish them.
        text = self.done("study", "run", "two.toml", "-o", "o")
        self.says(text, "in tiny bay (bay.toml):", "in tiny bay (dim.toml):", "camera A in tiny bay (dim.toml): ")
        self.assertNotRegex(text, r"\bs[01] ")
        # The pictures are those of the first scene.
        self.done("study", "run", "s.toml", "-o", "one")
        for figure in study["figures"]:
            self.assertEqual((self.folder / "o" / figure["file"]).read_bytes(),
                             (self.folder / "one" / figure["file"]).read_bytes())


class Visibility(Case):
    def test_wanted_and_iris(self):
        printed = self.printed("study", "visibility", "bay.toml", "-o", "v", "--wanted", "box>=0.9", "--iris", "peak,average")
        answer, = printed["answers"]
        self.assertEqual((answer["wanted"], answer["target"], answer["least"]), ("box>=0.9", "box", 0.9))
        self.assertEqual(answer["arcs_deg"], [])
        self.assertIn(answer["iris"], (None, "peak", "average"))
        self.assertEqual([(row["camera"], row["target"]) for row in printed["results"]],
                         [(c, t) for c in "AB" for t in ("box", "far")])
        self.assertTrue(all(row["verdict"] in VERDICTS for row in printed["results"]))
        self.no_nonsense("v")
        for cameras in ([], ["--camera", "A,B"]):
            self.says(self.done("study", "visibility", "bay.toml", "-o", "w", "--dry-run", *cameras), "1 places", "camera B")
        self.assertFalse((self.folder / "w").exists())


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
        self.assertEqual((study["targets"], study["results"]), ([], []))
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
