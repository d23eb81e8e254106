# SPDX-License-Identifier: Apache-2.0
"""Input that is certainly a mistake: one warning each, equal in every command that uses it and in
reports."""
import json
import unittest

import program

# A housing around a lamp, as in luminaires: every ray from the lamp ends on a black back.
HOUSING = """
[[object]]
name = "housing"
shape = "box"
min = [1.4, -0.1, 1.9]
max = [1.6, 0.1, 2.1]
material = "floor"
"""
SHUT_IN = 'all light of lamp "lamp" ends on the black back of the object "housing"'


class Plausible(program.Case):
    def warned(self, *arguments, code=(0, 3)):
        """Warnings of a call, on standard error or in its text."""
        run = self.run_program(*arguments)
        self.assertIn(run.returncode, code, run.stderr)
        lines = (run.stderr + run.stdout).splitlines()
        return [line.removeprefix("warning: ") for line in lines if line.startswith("warning: ")]

    def test_every_command_says_it_once(self):
        self.write("s.toml", program.BALL + HOUSING)
        for call in (("render", "s.toml", "--camera", "A", "-o", "o.exr", "--no-error"), ("solve", "s.toml"),
                     ("plan", "s.toml"), ("inspect", "s.toml"),
                     ("study", "visibility", "s.toml", "-o", "v", "--size", "8x8"),
                     ("study", "compare", "s.toml", "--camera", "A", "-o", "c", "--size", "8x8", "--lights", "2")):
            said = [line for line in self.warned(*call) if SHUT_IN in line]
            self.assertEqual(len(said), 1, call)
            self.says(said[0], "inward", "two-sided")
        self.assertIn("Found on loading: all light of lamp", (self.folder / "v" / "report.html").read_text("utf-8"))
        self.assertIn("Found on loading: all light of lamp", (self.folder / "c" / "compare.html").read_text("utf-8"))

    def test_json_has_it(self):
        self.write("s.toml", program.BALL + HOUSING)
        for call in (("render", "s.toml", "--camera", "A", "-o", "o.exr", "--no-error"), ("solve", "s.toml"),
                     ("plan", "s.toml"), ("inspect", "s.toml")):
            self.says(" ".join(self.json(*call)["warnings"]), SHUT_IN)
        self.done("render", "s.toml", "--camera", "A", "-o", "o.exr", "--no-error", "--report", "r.json")
        self.says(" ".join(json.loads((self.folder / "r.json").read_text())["warnings"]), SHUT_IN)

    def test_form_factors_need_no_light(self):
        self.write("s.toml", program.BALL + HOUSING)
        self.assertEqual(self.warned("form-factors", "s.toml"), [])

    def test_plan_calls_a_lamp_that_is_on_on(self):
        self.write("s.toml", program.BALL + HOUSING)
        rows = {row["effect"]: row for row in self.json("plan", "s.toml")["effects"]}
        self.assertFalse(rows["lamps"]["runs"])
        self.says(rows["lamps"]["why"], "no lamp that is on matters")
        self.says(rows["point lamps"]["why"], "closed walls")

    def test_the_sun_behind_the_earth_is_said_where_it_would_shine(self):
        scene = program.BALL.split("[sun]")[0] + "[[camera]]" + program.BALL.split("[[camera]]", 1)[1]
        self.write("s.toml", scene + "\n[orbit]\naltitude_km = 400\nposition_deg = 180\n")
        self.assertEqual(self.warned("solve", "s.toml"), [])  # a night with lamps is intentional
        self.write("s.toml", scene + "\n[orbit]\naltitude_km = 400\nposition_deg = 109.7\n")
        hidden = "of the Sun; take another position_deg"
        for call in (("render", "s.toml", "--camera", "A", "-o", "o.exr", "--no-error"), ("solve", "s.toml"),
                     ("study", "visibility", "s.toml", "-o", "v", "--size", "8x8")):
            self.assertEqual(len([line for line in self.warned(*call) if hidden in line]), 1, call)
        self.says((self.folder / "v" / "report.html").read_text("utf-8"), hidden)
        # The orbit has a night; inspect reports for each light whether it shines.
        self.assertEqual(self.warned("study", "orbit", "s.toml", "--positions", "2", "-o", "w", "--size", "8x8"), [])
        self.assertEqual(self.warned("inspect", "s.toml"), [])

    def test_a_study_without_light_says_so(self):
        dark = program.BALL.replace("[900, 800, 700]", "0").replace("illuminance = 1000", "illuminance = 0")
        self.write("s.toml", dark)
        for call in (("render", "s.toml", "--camera", "A", "-o", "o.exr"), ("solve", "s.toml"),
                     ("study", "visibility", "s.toml", "-o", "v", "--size", "8x8")):
            self.assertEqual(len([line for line in self.warned(*call) if "nothing gives light" in line]), 1, call)
        self.says((self.folder / "v" / "report.html").read_text("utf-8"), "nothing gives light")
        self.write("lit.toml", program.BALL)
        self.write("study.toml", 'format = 1\nscene = "lit.toml"\nsize = "8x8"\n[[lamps]]\nname = "off"\nset = { lamp = 0, sun = 0 }\n')
        self.assertTrue(any("no condition of the study has any light" in line
                            for line in self.warned("study", "run", "study.toml", "-o", "w")))

    def test_a_view_of_backs_is_said_by_render_and_the_report(self):
        # From below, the floor shows only its back.
        scene = program.BALL.replace("position = [0, 0, 6]", "position = [0, 0, -3]")
        self.write("s.toml", scene)
        said = self.warned("render", "s.toml", "--camera", "above", "-o", "o.exr", "--no-error")
        self.assertEqual(len([line for line in said if 'most of what camera "above" sees (100 %) is back faces' in line]), 1)
        self.assertEqual(self.warned("render", "s.toml", "--camera", "A", "-o", "o.exr", "--no-error"), [])
        self.warned("study", "visibility", "s.toml", "-o", "v", "--size", "8x8")
        self.says((self.folder / "v" / "report.html").read_text("utf-8"), "is back faces, which are black")

    def test_mtl_tr_1_is_named(self):
        self.write("m.mtl", "newmtl a\nKd .5 .5 .5\nTr 1.0\nillum 1\n")
        self.write("m.obj", "mtllib m.mtl\nusemtl a\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\nf 1 2 3 4\n")
        self.write("s.toml", program.BALL + '\n[[object]]\nname = "o"\nmesh = "m.obj"\n')
        self.says(" ".join(self.json("inspect", "s.toml")["warnings"]), '"a" neither reflects nor stops light', "Tr 1")

    def test_inspect_shows_bounds_and_what_runs_through_what(self):
        self.write("s.toml", program.BALL.replace("center = [0, 0, 0.7]", "center = [0, 0, 0.3]"))
        report = self.json("inspect", "s.toml")
        self.assertEqual(report["objects"][0]["bounds"], {"min_m": [-2, -2, 0], "max_m": [2, 2, 0]})
        pairs = report["crossings"]["pairs"]
        self.assertEqual([pair["objects"] for pair in pairs], [["floor", "ball"]])
        # A ball of 12 segments, 0.5 m, cut 0.3 m below its centre: a dodecagon about the circle of
        # 0.4 m.
        self.assertAlmostEqual(pairs[0]["line_m"], 2 * 3.14159 * 0.4, delta=0.1 * 2 * 3.14159 * 0.4)
        self.says(self.done("inspect", "s.toml"), "bounds", "floor and ball run through one another")
        self.write("apart.toml", program.BALL)
        self.assertEqual(self.json("inspect", "apart.toml")["crossings"], {"pairs": [], "complete": True})


if __name__ == "__main__":
    unittest.main()
