# SPDX-License-Identifier: Apache-2.0
"""Invalid visibility studies: one clear line, and no work is started."""
import os
import unittest

from tiny_bay import BAY, STUDY, Case


class Refused(Case):
    def orbit(self, *more, scene="bay.toml"):
        return self.refused_cleanly("study", "orbit", scene, *more)

    def test_wrong_calls(self):
        self.says(self.orbit("--camera", "Z"), '"Z"', "A", "B")
        self.says(self.orbit("--wanted", "lid>=0.5"), '"lid"', "box", "far")
        self.says(self.orbit("--wanted", "box"), "TARGET>=P")
        self.says(self.orbit("--iris", "wide"), "wide")
        self.says(self.orbit("--camera", "A,Z"), '"Z"', "A, B")
        self.says(self.refused_cleanly("study", "compare", "bay.toml", "--camera", "A,B"), '"A,B"', "looks through one")
        for positions in ("0", "-3", "3601", "x", "1.5"):
            self.says(self.orbit(f"--positions={positions}"), "--positions")
        for at in ("361", "x", "0,0", "1,", "nan", "inf"):
            self.says(self.orbit(f"--at={at}"), "--at")
        self.says(self.orbit("--size", "0x4"), "--size")
        self.refused_cleanly("study", "orbit", "none.toml")
        self.refused_cleanly("study", "visibility", "bay.toml", "--wanted", "lid>=0.5")
        self.refused_cleanly("study", "visibility", "bay.toml", "--camera", "Z")

    def test_scenes_that_will_not_do(self):
        still = (BAY.replace('[orbit]\naltitude_km = 425\nattitude = "bay-to-space"\n', "")
                 .replace("[sun]", "[sun]\ndirection = [0, 0, 1]"))
        for earth in ("", "[earth]\ndirection = [0, 0, -1]\naltitude_km = 425\n"):
            self.write("still.toml", still.replace("[earth]\n", earth))
            self.says(self.orbit(scene="still.toml"), "still.toml: has no [orbit]", "altitude_km")
        self.write("inside.toml", BAY.replace("position = [0, 0, 6]", "position = [0, 0, 0.3]"))
        self.says(self.orbit("--camera", "B", scene="inside.toml"), "box")
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
        run(STUDY + "\0", "bad.toml:", "NUL", "a TOML file is plain text")
        run(STUDY.replace("[180, 0]", "[180, nan]"), "bad.toml:10", "nan", "-360 to 360")
        run(STUDY.replace("right = 0.5", "right = -0.5"), "bad.toml:18", "-0.5", "from 0")
        run(STUDY.replace("set = { right = 0.5 }", "set = { moon = 0.5 }"), '"moon"', "left")
        run(STUDY.replace("position_deg = 180", "position_deg = 90"), "bad.toml:", "90", "positions")
        run(STUDY.replace('lamps = "right alone"', 'lamps = "none"'), "bad.toml:", '"none"', "right alone")
        run(STUDY.replace('camera = "A"', 'camera = "Z"'), "bad.toml:", '"Z"')
        run(STUDY.replace('"box>=0.5"', '"lid>=0.5"'), '"lid"')
        run(STUDY.replace('wanted = ["box>=0.5"]', 'cameras = ["Z"]'), '"Z"')
        run(STUDY.replace("size =", "camera_models = { Z = \"sit-monochrome\" }\nsize ="), '"Z"', "A, B")
        run(STUDY.replace("size =", "camera_models = { A = \"betacam\" }\nsize ="), "bad.toml:5:1: camera_models: ", "betacam")
        run(STUDY.replace('shows = "cctv"', 'shows = "cctv"\n').replace('camera = "A"\nposition_deg = 180',
                                                                        'camera = "B"\nposition_deg = 180'), '"B"', "CCTV")
        run(STUDY.replace('shows = "cctv"', 'shows = "cctv"\ncctv = "betacam"'), "bad.toml:", '[[picture]] "night"', "betacam")
        run(STUDY.replace("bay.toml", "none.toml"), "bad.toml:3:1: ", '"none.toml"', "No such file")
        run(STUDY.replace("format = 1", "format = 3"), "bad.toml:1:1: ", "the number 3", "reads format = 1")
        run(STUDY.replace('scene = "bay.toml"', "scenes = []"), "bad.toml:3:1: ", '"scenes"', "Name a scene file")
        run(BAY, "bad.toml:", "[[object]] makes this a scene file", "study visibility")
        self.write("still.toml", BAY.replace('[orbit]\naltitude_km = 425\nattitude = "bay-to-space"\n', "")
                   .replace("[sun]\n\n[earth]\n", ""))
        run(STUDY.replace("bay.toml", "still.toml"), "bad.toml:9:2: ", "still.toml has no [orbit]")
        run(STUDY.replace("size =", 'set = ["quality.nonsense=3"]\nsize ='), "bad.toml:5:1: set quality.nonsense=3")
        self.assertNotIn("--set", self.refused("study", "run", "bad.toml", "-o", "d"))
        self.says(self.refused_cleanly("study", "run", "gone.toml"), "gone.toml")

    def test_what_has_no_effect_is_said(self):
        def told(*call, more=()):
            run = self.run_program("study", *call, "-o", "d", "--dry-run", *more)
            self.assertEqual(run.returncode, 0, run.stderr)
            return run.stderr
        self.write("idle.toml", STUDY.replace('wanted = ["box>=0.5"]', 'set = ["orbit.position_deg=30"]').replace(
            "position_deg = 0\n\n", 'position_deg = 0\nlights = 8\ncctv = "ideal"\n\n').replace("lights = 4", 'lights = 4\ncctv = "ideal"'))
        said = told("run", "idle.toml", more=("--exposure", "own", "--curve", "clip"))
        self.says(said, "note: iris has no effect", "note: orbit.position_deg has no effect")
        self.assertRegex(said, r'idle.toml:2\d:1: "lights" in \[\[picture\]\] "noon" has no effect: it shows "clean"')
        self.assertRegex(said, r'idle.toml:3\d:1: "cctv" in \[\[picture\]\] "few lights" has no effect: it shows "distributed"')
        self.assertEqual(said.count('"cctv" in'), 2)
        self.assertEqual(told("run", "s.toml"), "")
        self.assertEqual(told("run", "idle.toml", more=("-q",)), "")
        self.says(told("orbit", "bay.toml", "--at", "0", "--iris", "peak", "--set", "orbit.position_deg=30"),
                  "note: --iris has no effect", "note: orbit.position_deg has no effect")
        self.assertNotIn("position_deg", told("visibility", "bay.toml", "--set", "orbit.position_deg=30"))

    def test_folder_that_cannot_be(self):
        self.says(self.refused("study", "run", "s.toml", "-o", "bay.toml"), "bay.toml", "folder")
        (self.folder / "o" / "study.json").mkdir(parents=True)
        self.says(self.refused("study", "run", "s.toml", "-o", "o"), "study.json", "folder")
        self.assertEqual(self.all_files("o"), ["study.json"])

    @unittest.skipIf(os.geteuid() == 0, "the superuser may write anywhere")
    def test_folder_that_is_not_writable(self):
        (self.folder / "o").mkdir(mode=0o500)
        self.says(self.refused("study", "run", "s.toml", "-o", "o", code=1), "cannot be written")


if __name__ == "__main__":
    unittest.main()
