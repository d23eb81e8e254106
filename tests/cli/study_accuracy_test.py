# SPDX-License-Identifier: Apache-2.0
"""study accuracy: its folder, resuming after a kill, errors, and studies without measurements."""
import csv
import json
import math
import os
import pathlib
import shutil
import signal
import subprocess
import tempfile
import time
import unittest
import xml.etree.ElementTree as xml

import program

# Few pixels and rays: a second of work.
CALL = ("--size", "12x9", "--wanted", "0.5,0.3", "--reference-factor", "1", "--paths", "2,8")


class Accuracy(program.Case):
    kept = []

    def setUp(self):
        super().setUp()
        scene = program.BALL[:program.BALL.index("[quality]")]
        self.write("ball.toml", scene)
        # The fastest ladder, for tests that do not depend on measured values.
        ball = scene[scene.index('[[object]]\nname = "ball"'):scene.index("[[light]]")]
        self.write("floor.toml", scene.replace(ball, "").replace('material = "floor"', 'material = "paint"'))

    def study(self, *more, scene="floor.toml", folder="d"):
        return ("study", "accuracy", scene, "-o", folder, "--camera", "A", *CALL, *more)

    def finished(self, folder="d"):
        """The folder of an undisturbed run, made once for all tests."""
        if not Accuracy.kept:
            Accuracy.kept.append(tempfile.TemporaryDirectory(prefix="earthshine accuracy "))
            self.done(*self.study(folder=folder))
            shutil.copytree(self.folder / folder, pathlib.Path(Accuracy.kept[0].name) / "d")
            return
        shutil.copytree(pathlib.Path(Accuracy.kept[0].name) / "d", self.folder / folder)

    def result(self, folder="d"):
        return json.loads((self.folder / folder / "accuracy.json").read_text(encoding="utf-8"),
                          parse_constant=lambda word: self.fail(f"{word} in the JSON"))

    def table(self, folder="d"):
        with open(self.folder / folder / "accuracy.csv", newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def parts(self, folder="d"):
        return {path.name: path.stat().st_mtime_ns for path in (self.folder / folder / "points").iterdir()}

    def figures(self, value):
        """Without values that depend on seconds: the seconds, the front, and its consequences."""
        value = {key: found for key, found in value.items() if key not in ("front", "worth", "wanted", "reference")}
        for row in value["points"]:
            for key in [key for key in row if "seconds" in key or key == "on_front"]:
                del row[key]
        return value


class Folder(Accuracy):
    def test_tables_plots_and_json(self):
        text = self.done(*self.study(folder="new/a 'b' $(c)", scene="ball.toml"))
        folder = "new/a 'b' $(c)"
        self.says(text, "radiosity error=", "paths samples=2", "Limit of radiosity", "the cheapest way", "30 %", "CPU s")
        names = sorted(os.listdir(self.folder / folder))
        plots = ["error-seconds.gp", "error-settings.gp"]
        if shutil.which("gnuplot"):
            plots += ["error-seconds.svg", "error-settings.svg"]
            for stem in ("error-seconds", "error-settings"):
                picture = (self.folder / folder / f"{stem}.svg").read_text(encoding="utf-8")
                xml.fromstring(picture)
                self.says(picture, "error")
        self.assertEqual(names, sorted(["accuracy.csv", "accuracy.json", "points", *plots]))
        result, rows = self.result(folder), self.table(folder)
        self.assertEqual(len(rows), len(result["points"]))
        for row, record in zip(rows, result["points"]):
            self.assertEqual(row["method"], record["method"])
            self.assertEqual(float(row["error"]), record["error"])
            self.assertGreaterEqual(record["error_high"], record["error"])
            self.assertLessEqual(record["error_low"], record["error"])
            self.assertGreater(record["cpu_seconds"], 0)
            self.assertGreater(record["memory_mib"], 0)
        methods = {row["method"] for row in rows}
        self.assertEqual(methods, {"radiosity", "direct", "paths"})  # no wide source: no distributed lights
        self.assertEqual([answer["wanted"] for answer in result["wanted"]], [0.5, 0.3])
        front = [result["points"][k] for k in result["front"]]
        self.assertEqual(front, sorted(front, key=lambda row: row["cpu_seconds"]))
        self.assertEqual([row["on_front"] for row in result["points"]].count(True), len(front))

    def test_a_setting_is_a_call_that_works(self):
        shutil.copy(self.folder / "floor.toml", self.folder / "my ball's.toml")
        self.done(*self.study("--set", "light.lamp.intensity=500", scene="my ball's.toml"))
        answer = next(answer for answer in self.result()["wanted"] if answer["reached"])
        call = answer["setting"]["command"]
        self.says(call, "--size 12x9", "light.lamp.intensity=500")
        run = subprocess.run(["sh", "-c", call.replace("earthshine", '"$0"', 1), program.PROGRAM],
                             cwd=self.folder, capture_output=True, text=True, timeout=120)
        self.assertEqual(run.returncode, 0, call + run.stderr)

    def test_without_gnuplot_the_figures_are_there_all_the_same(self):
        (self.folder / "d").mkdir()
        (self.folder / "d" / "error-seconds.svg").write_text("old")
        run = self.run_program(*self.study("-q"), env={"PATH": str(self.folder)})
        self.assertEqual(run.returncode, 0, run.stderr)
        self.says(run.stderr, "gnuplot-nox", "error-seconds.gp")
        self.assertEqual(sorted(os.listdir(self.folder / "d")),
                         ["accuracy.csv", "accuracy.json", "error-seconds.gp", "error-settings.gp", "points"])

    def test_names_do_not_reach_the_plots_as_commands(self):
        evil = "a'; system('touch owned'); set title `touch owned` $(touch owned)"
        scene = (self.folder / "floor.toml").read_text().replace('"ball on a floor"', json.dumps(evil))
        self.write("evil.toml", scene)
        self.done(*self.study(scene="evil.toml"))
        self.assertFalse((self.folder / "d" / "owned").exists() or (self.folder / "owned").exists())
        if shutil.which("gnuplot"):
            self.says((self.folder / "d" / "error-seconds.svg").read_text(), "touch owned")


class GoesOn(Accuracy):
    def test_a_killed_run_goes_on_to_the_same_figures(self):
        self.finished("whole")
        process = subprocess.Popen([program.PROGRAM, *self.study()], cwd=self.folder, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL)
        points = self.folder / "d" / "points"
        until = time.monotonic() + 60
        while time.monotonic() < until and process.poll() is None:
            if points.is_dir() and len(list(points.glob("*.json"))) >= 6:
                break
            time.sleep(0.002)
        process.send_signal(signal.SIGKILL)
        process.wait()
        before = self.parts()
        self.assertFalse((self.folder / "d" / "accuracy.json").exists(), "it ended before it was killed")
        self.done(*self.study())
        after = self.parts()
        for name in (name for name in before if name.endswith(".json")):
            self.assertEqual(before[name], after[name], f"{name} was recomputed")
        self.assertEqual(self.figures(self.result()), self.figures(self.result("whole")))

    def test_a_finished_run_does_nothing_again(self):
        self.finished()
        before, result = self.parts(), self.result()
        self.done(*self.study())
        self.assertEqual(before, self.parts())
        self.assertEqual(result, self.result())

    def test_what_changed_is_done_again_and_what_did_not_is_not(self):
        self.finished()
        before = set(self.parts())
        self.done(*self.study("--set", "material.paint.specular=0.2"))
        self.assertFalse([name for name in before if name not in self.parts()])
        fresh = len(self.parts()) - len(before)
        self.assertGreaterEqual(fresh, len(before))  # the lobe is in every picture
        for change in (("--seed", "7"), ("--set", "camera.A.fov_deg=39")):
            count = len(self.parts())
            self.done(*self.study(*change))
            self.assertGreaterEqual(len(self.parts()) - count, len(before), change)
        count = len(self.parts())
        call = [word if word != "0.5,0.3" else "0.4,0.3" for word in self.study()]
        self.done(*call)  # another wanted error, the same ladder
        self.assertEqual(len(self.parts()), count)

    def test_torn_and_foreign_parts_are_named_and_done_again(self):
        self.finished()
        result = self.result()
        parts = sorted((self.folder / "d" / "points").glob("*.json"))
        reference, step = (next(part for part in parts if f'"{kind}"' in part.read_text()) for kind in ("reference", "step"))
        shutil.copy(reference.with_suffix(".exr"), step.with_suffix(".exr"))
        # The names of files depend on the build, and so does their order.
        torn, original, copied, pictureless, wordy, a_list = [part for part in parts if part not in (reference, step)][:6]
        torn.write_text(torn.read_text()[:40])
        shutil.copy(original, copied)
        pictureless.with_suffix(".exr").write_bytes(b"torn")
        wordy.write_text(wordy.read_text().replace('"cpu_seconds": ', '"cpu_seconds": "x", "y": '))
        a_list.write_text("[1, 2]")
        run = self.run_program(*self.study())
        self.assertEqual(run.returncode, 0, run.stderr)
        self.says(run.stderr, "is broken", "belongs to something else", "has lost its picture",
                  "has another picture", "it is recomputed")
        self.assertEqual(self.figures(self.result()), self.figures(result))

    def test_ctrl_c_says_what_is_finished(self):
        process = subprocess.Popen([program.PROGRAM, *self.study()], cwd=self.folder, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, text=True)
        points = self.folder / "d" / "points"
        while process.poll() is None and not (points.is_dir() and list(points.glob("*.json"))):
            time.sleep(0.002)
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=60)
        self.assertEqual((process.returncode, out), (1, ""), err)
        self.says(err, "interrupted", "finished in d", "goes on")

    def test_a_time_limit_leaves_out_and_says_so(self):
        result = self.json(*self.study("--time-limit", "0.001"))
        self.assertEqual(result["points"], [])
        self.says(result["not_run"][0]["why"], "time limit")
        self.assertEqual(self.table(), [])
        whole = self.json(*self.study())
        self.assertEqual(whole["not_run"], [])


class Nothing(Accuracy):
    def test_no_light_no_surface_or_only_sources(self):
        scene = (self.folder / "ball.toml").read_text()
        dark = scene[:scene.index("[[light]]")] + scene[scene.index("[[camera]]"):]
        self.write("dark.toml", dark)
        self.write("box.toml", program.CLOSED_BOX.replace("diffuse = 0.5", "diffuse = 0"))
        self.write("away.toml", scene.replace("look_at = [0, 0, 0.4]", "look_at = [3, -3, 9]\n").replace("up = [0, 0, 1]", "up = [0, 1, 0]"))
        hidden = scene.replace('direction = [-0.3, 0.2, 1]', 'direction = [-0.3, 0.2, -1]').replace("[900, 800, 700]", "[0, 0, 0]")
        self.write("hidden.toml", hidden)
        for name, word in (("dark", "gives light"), ("box", "reflects"), ("away", "no pixel"), ("hidden", "light")):
            folder = "out-" + name
            call = ["study", "accuracy", name + ".toml", "-o", folder, *CALL]
            text = self.done(*call)
            self.says(text, "Nothing was measured", word)
            result = self.result(folder)
            self.says(result["nothing_to_measure"], word)
            self.assertEqual(result["points"], [])
            self.assertEqual((self.folder / folder / "accuracy.csv").read_text(), "")


class SourcesThatReflect(Accuracy):
    def test_a_room_that_glows_is_measured_by_what_its_walls_reflect(self):
        # Every wall emits M = 10 lm/m2 and reflects half: B = M / (1 - 0.5) = 20, of which 10 / pi
        # cd/m2 is reflected light. Light reflected once is half of this: direct pictures have an
        # error of 50 %. The solution is exact here.
        self.write("room.toml", program.CLOSED_BOX)
        self.done("study", "accuracy", "room.toml", "-o", "d", *CALL)
        result = self.result()
        self.assertIsNone(result["nothing_to_measure"])
        self.assertEqual(result["pixels_compared"], 12 * 9)
        self.assertAlmostEqual(result["mean_luminance_cd_m2"], 10 / math.pi, delta=0.05 * 10 / math.pi)
        limit = {entry["method"]: entry["error"] for entry in result["limits"]}
        self.assertAlmostEqual(limit["direct"], 0.5, delta=0.05)
        for point in result["points"]:
            if point["method"] == "radiosity":
                self.assertTrue(point["below_resolution"], point["command"])


class Refused(Accuracy):
    def test_wrong_calls(self):
        for option, values in {"--wanted": ("", "0", "2", "x", "0.1,", "nan", "-0.1"), "--lights": ("1", "4,x", ""),
                               "--paths": ("1", "", "4.5"), "--reference-factor": ("0.5", "inf", "x"),
                               "--time-limit": ("0", "-1", "x")}.items():
            for value in values:
                message = self.refused("study", "accuracy", "ball.toml", "-o", "d", f"{option}={value}")
                self.says(message, option)
        self.says(self.refused("study", "accuracy", "ball.toml"), "--output")
        self.says(self.refused("study", "accuracy", "ball.toml", "-o", "d", "--camera", "none"), '"none"', "above")
        self.assertEqual(sorted(os.listdir(self.folder)), ["ball.toml", "floor.toml"])

    def test_folders_that_cannot_be(self):
        self.says(self.refused("study", "accuracy", "ball.toml", "-o", "ball.toml"), "ball.toml", "folder")
        (self.folder / "d").mkdir()
        (self.folder / "d" / "points").write_text("")
        self.says(self.refused("study", "accuracy", "ball.toml", "-o", "d"), "points", "folder")
        if os.geteuid() != 0:
            (self.folder / "e").mkdir(mode=0o500)
            self.says(self.refused("study", "accuracy", "ball.toml", "-o", "e", code=1), "e")
        self.says(self.refused("study", "accuracy", "ball.toml", "-o", "/proc/none"), "/proc/none")

    def test_scene_without_cameras(self):
        self.write("bare.toml", program.BALL.split("[[camera]]")[0])
        self.says(self.refused("study", "accuracy", "bare.toml", "-o", "d"), "camera")


if __name__ == "__main__":
    unittest.main()
