# SPDX-License-Identifier: Apache-2.0
"""study: the folder of results, its tables, and errors."""
import csv
import html
import json
import os
import re
import unittest

import png
import program
import study_table


class Study(program.Case):
    def setUp(self):
        super().setUp()
        self.write("ball.toml", program.BALL)
        self.write("monitored.toml", program.BALL.replace("resolution = [32, 24]",
                                                          'resolution = [32, 24]\ncctv = "sit-monochrome"'))

    def files(self, folder):
        return sorted(os.listdir(self.folder / folder))

    def table(self, folder, name):
        with open(self.folder / folder / name, newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def result(self, folder, name):
        return json.loads((self.folder / folder / name).read_text(encoding="utf-8"),
                          parse_constant=lambda word: self.fail(f"{word} in the JSON"))

    def png(self, folder, name):
        return (self.folder / folder / name).read_bytes()

    def png_size(self, folder, name):
        return png.pixels(self.png(folder, name))[:2]


class Compare(Study):
    METHODS = ["reference", "radiosity", "distributed-4", "distributed-16", "direct"]
    PICTURES = ["reference.png"] + [f"{kind}{method}.png" for method in METHODS[1:] for kind in ("", "difference-")]

    def test_folder_holds_tables_and_pictures(self):
        text = self.done("study", "compare", "ball.toml", "-o", "new/folder", "--lights", "16,4")
        self.assertEqual(self.files("new/folder"),
                         sorted(["compare.csv", "compare-targets.csv", "compare.json", "compare-lights.csv", "compare.html"]
                                + self.PICTURES))
        self.says(text, *self.METHODS, "factor 1.5", "ball: 16 distributed lights would", "noise-floor")
        for picture in self.PICTURES:
            self.assertEqual(self.png_size("new/folder", picture), (32, 24))

    def test_page_has_pictures_verdicts_and_a_legend(self):
        hostile = '<script>alert("1 & 2")</script>'
        self.write("ball.toml", program.BALL.replace('name = "ball on a floor"', f"name = '{hostile}'")
                   .replace('name = "ball"', "name = '<b>ball'"))
        verdicts = self.json("study", "compare", "ball.toml", "-o", "d", "--lights", "4,16")["verdicts"]
        page = (self.folder / "d" / "compare.html").read_text(encoding="utf-8")
        self.assertEqual(re.findall(r'<img src="([^"]*)"', page), self.PICTURES)
        self.says(html.unescape(page), *[verdict["sentence"] for verdict in verdicts],
                  *[sign + limit for sign in "×÷" for limit in ("1.1", "1.5", "2", "4")])
        self.says(page, f"<h1>{html.escape(hostile)}, camera A</h1>", "image-rendering: pixelated")
        self.assertNotIn("<script", page)
        self.assertNotIn("<b>", page)
        # One entry for each possible colour of a difference picture; no picture has other colours.
        legend = set(re.findall(r'fill="#(\w{6})"', page))
        self.assertEqual(len(legend), 10)
        for picture in self.PICTURES[2::2]:
            values = png.pixels(self.png("d", picture))[3]
            self.assertLessEqual({bytes(values[i:i + 3]).hex() for i in range(0, len(values), 3)}, legend, picture)

    def test_tables_say_what_the_json_says(self):
        printed = self.json("study", "compare", "ball.toml", "-o", "d", "--lights", "4,16", "--size", "24x18")
        self.assertEqual(printed, self.result("d", "compare.json"))
        self.assertEqual((printed["camera"], printed["columns"], printed["rows"]), ("A", 24, 18))
        methods = self.table("d", "compare.csv")
        self.assertEqual([row["method"] for row in methods], self.METHODS + ["noise-floor"])
        self.assertEqual([row["lights"] for row in methods], ["", "", "4", "16", "", ""])
        for row, record in zip(methods, printed["methods"]):
            self.assertEqual(float(row["relative_rmse"]), record["relative_rmse"])
        self.assertEqual([float(methods[0][key]) for key in ("relative_rmse", "bias", "off_share")], [0, 0, 0])
        targets = self.table("d", "compare-targets.csv")
        self.assertEqual([(row["target"], row["method"]) for row in targets],
                         [("ball", method) for method in self.METHODS])
        self.assertEqual([verdict["target"] for verdict in printed["verdicts"]], ["ball"])

    def test_the_earths_lights_over_an_area_have_rows_of_their_own(self):
        earth = '\n[earth]\ndirection = [0, 0, 1]\nmodel = "uniform"\nradiance = 100\nhalf_angle_deg = 60\n'
        area = '\n[[area]]\nname = "panel"\ncenter = [0, 0, 9]\nedge_u = [0, 30, 0]\nedge_v = [30, 0, 0]\n'
        self.write("day.toml", program.BALL[:program.BALL.index("[sun]")] + program.BALL[program.BALL.index("[[camera]]"):]
                   + earth + area)
        call = ("study", "compare", "day.toml", "-o", "d", "--lights", "4,64", "--distributed-over")
        self.says(self.done(*call, "panel"), "distributed-64", "area-4", "area-64", "rays", "64 distributed lights")
        rows = {row["method"]: row for row in self.table("d", "compare.csv")}
        self.assertEqual([rows[m]["area"] for m in ("distributed-64", "area-64")], ["", "panel"])
        self.assertGreater(int(rows["area-64"]["rays"]), int(rows["area-4"]["rays"]))
        self.assertGreater(float(rows["area-4"]["relative_rmse"]), float(rows["area-64"]["relative_rmse"]))
        self.says(self.refused(*call, "lid"), "its areas are panel")

    def test_the_rule_decides(self):
        targets = self.json("study", "compare", "ball.toml", "-o", "d", "--lights", "4")["targets"]
        for row in targets:
            off = not 1 / 1.5 <= row["luminance_ratio"] <= 1.5
            self.assertEqual(row["misleads"], off or abs(row["contrast_difference"]) > 0.1, row)

    def test_percentages_are_plain_numbers(self):
        text = self.done("study", "compare", "ball.toml", "-o", "d", "--lights", "2", "--camera", "A", "--size", "2x2",
                         "--set", "quality.camera_samples=1", "--set", "quality.denoise=false")
        self.assertRegex(text, r"noisier, \d+ %, .*: radiosity \([0-9.]+ \+- [0-9.]+ %\)")

    def test_same_bytes_on_any_number_of_threads(self):
        def pictures(threads):
            self.done("study", "compare", "ball.toml", "-o", threads, "--lights", "4", "-j", threads)
            return [self.png(threads, name) for name in self.files(threads) if name.endswith(".png")]
        self.assertEqual(pictures("1"), pictures("2"))

    def test_pictures_share_one_exposure(self):
        # The walls' radiance is M / pi, after one reflection 1.5 and after all 2 times this. Each
        # picture with its own exposure would be middle grey, 118. With the reference's exposure the
        # direct light is a signal of 0.18 x 0.75, sRGB 103; its noise reduces the mean slightly.
        self.write("box.toml", program.CLOSED_BOX)
        self.done("study", "compare", "box.toml", "-o", "d", "--lights", "4")
        for method, grey in (("reference", 118), ("direct", 103)):
            values = png.pixels(self.png("d", f"{method}.png"))[3]
            self.assertAlmostEqual(sum(values) / len(values), grey, delta=3, msg=method)

    def test_dry_run_has_all_methods_and_writes_nothing(self):
        """The whole is the sum of its parts; a time limit ends pictures, not solves."""
        call = ("study", "compare", "ball.toml", "-o", "d", "--lights", "4,16", "--dry-run")
        plan = self.json(*call)
        self.assertEqual([row["method"] for row in plan["methods"]], self.METHODS)
        self.assertAlmostEqual(plan["seconds"], plan["solve_seconds"] + sum(row["seconds"] for row in plan["methods"]), places=9)
        limited = self.json(*call, "--time-limit", "0.001")
        self.assertEqual(limited["seconds"], max(limited["solve_seconds"], 0.001))
        self.says(self.done(*call), *self.METHODS, "solutions", "about")
        self.assertFalse((self.folder / "d").exists())

    def test_time_limit_names_the_pictures_that_it_ended(self):
        call = ("study", "compare", "ball.toml", "-o", "d", "--lights", "4", "--time-limit", "0.001", "--error", "0.0001")
        run = self.run_program(*call)
        self.assertEqual(run.returncode, 3, run.stderr)
        self.says(run.stderr, "time limit", "reference", "radiosity")
        self.assertIn("radiosity", self.result("d", "compare.json")["stopped_by_time_limit"])

    def test_scene_without_targets_is_compared_all_the_same(self):
        self.write("box.toml", program.CLOSED_BOX)
        text = self.done("study", "compare", "box.toml", "-o", "d", "--lights", "4")
        self.says(text, "no object as a target")
        self.assertEqual((self.folder / "d" / "compare-targets.csv").read_text(), "")


# A lit plate under an area lamp, one light group, with parameters.
PLATE = """format = 1
name = "plate"
unit = "m"

[[material]]
name = "paint"
diffuse = {diffuse}
emit = {emit}

[[object]]
name = "ground"
shape = "quad"
corners = [[-2, -2, 0], [2, -2, 0], [2, 2, 0], [-2, 2, 0]]
material = "paint"

[[object]]
name = "plate"
shape = "quad"
corners = [[{x}, -0.5, 0.1], [{x_end}, -0.5, 0.1], [{x_end}, 0.5, 0.1], [{x}, 0.5, 0.1]]
material = "paint"
target = true

{light}

[[camera]]
name = "above"
position = [0, 0, 3]
look_at = [0, 0, 0]
up = [0, 1, 0]
fov_deg = 50
resolution = [16, 16]

[quality]
patch_edge = 1.0
form_factor_rays = 64
gather_rays = 16
"""
PANEL = """[[light]]
name = "panel"
type = "rectangle"
center = [0, 0, 2]
edge_u = [0, 0.5, 0]
edge_v = [0.5, 0, 0]
exitance = 1000
"""
SUN = "[sun]\ndirection = [0, 0, 1]\nilluminance = 1000\n"


class CompareCases(Study):
    def compared(self, diffuse=0.5, emit=0.0, x=-0.5, light=PANEL):
        self.write("plate.toml", PLATE.format(diffuse=diffuse, emit=emit, x=x, x_end=x + 1, light=light))
        printed = self.json("study", "compare", "plate.toml", "-o", "d", "--lights", "4,16")
        for name in self.files("d"):
            if name.endswith(".csv"):
                text = (self.folder / "d" / name).read_text(encoding="utf-8").lower()
                self.assertNotRegex(text, r"(^|,)-?(nan|inf)", name)
        return printed

    def test_each_number_of_lights_has_a_row(self):
        methods = {row["lights"]: row for row in self.compared()["methods"]}
        rows = self.table("d", "compare-lights.csv")
        self.assertEqual([row["lights"] for row in rows], ["4", "16"])
        for row in rows:
            self.assertEqual(float(row["relative_rmse"]), methods[int(row["lights"])]["relative_rmse"])

    def test_a_target_out_of_view_has_no_figures(self):
        printed = self.compared(x=9.0)
        self.assertEqual(printed["verdicts"][0], {"target": "plate", "verdict": "not-in-view",
                                                  "sentence": "plate: not in view."})
        self.assertTrue(all(row["luminance_cd_m2"] is None and row["decided"] is None for row in printed["targets"]))

    def test_black_surfaces_leave_nothing_between_the_methods(self):
        printed = self.compared(diffuse=0.0)
        self.assertEqual({row["relative_rmse"] for row in printed["methods"]}, {0})
        self.says(printed["verdicts"][0]["sentence"], "black by every method")

    def test_a_target_that_is_a_source_is_said_to_be(self):
        self.says(self.compared(emit=500.0)["verdicts"][0]["sentence"], "plate (itself a source): 16 distributed lights")

    def test_without_anything_wide_the_approximation_is_direct_light(self):
        printed = self.compared(light=SUN)
        self.assertFalse(printed["wide_sources"])
        # The number of lights then has no effect.
        self.assertEqual(printed["methods"][2]["relative_rmse"], printed["methods"][3]["relative_rmse"])
        self.says(self.done("study", "compare", "plate.toml", "-o", "d", "--lights", "4"), "direct light alone")


class Visibility(Study):
    ENGINE = ["pictures", "points", "report.html", "results.csv", "study.json"]  # files of every visibility study
    BEFORE = ["ball.toml", "monitored.toml"]

    def test_all_cameras_by_default(self):
        text = self.done("study", "visibility", "monitored.toml", "-o", "v")
        self.says(text, "camera", "visible", "contrast", "above", "P(detect)")
        self.assertEqual(self.files("v"), self.ENGINE)
        rows = self.table("v", "results.csv")
        self.assertEqual([(row["camera"], row["target"]) for row in rows], [("A", "ball"), ("above", "ball")])
        for row in rows:
            self.assertEqual(float(row["visible_fraction"]), 1)
            self.assertEqual(row["cut_by_frame"], "false")
            self.assertGreater(int(row["pixels"]), 0)
        # Only camera A has a CCTV camera.
        self.assertTrue(0 <= float(rows[0]["saturated"]) <= 1)
        self.assertLess(float(rows[0]["shown_from"]), float(rows[0]["shown_to"]))
        self.assertEqual([rows[1][key] for key in ("saturated", "crushed", "shown_from", "shown_to")], [""] * 4)

    def test_chosen_cameras_and_json(self):
        printed = self.json("study", "visibility", "monitored.toml", "-o", "v", "--camera", "above",
                            "--camera", "A", "--camera", "above", "--size", "16x12")
        self.assertEqual(printed, self.result("v", "study.json"))
        self.assertEqual([camera["name"] for camera in printed["cameras"]], ["above", "A"])
        self.assertIsNone(study_table.opened(printed)["results"][0]["shown_to"])
        clean = [figure["file"] for figure in printed["figures"] if figure["clean"]]
        self.assertEqual([self.png_size("v", name) for name in clean], [(16, 12)] * 2)

    def test_camera_names_become_safe_file_names(self):
        scene = program.BALL.replace('name = "A"', 'name = "../A b"').replace('name = "above"', 'name = ".._A/b"')
        self.write("names.toml", scene)
        printed = self.json("study", "visibility", "names.toml", "-o", "v")
        self.assertEqual(self.files("v"), self.ENGINE)
        self.assertEqual(self.files("."), sorted([*self.BEFORE, "names.toml", "v"]))
        files = {figure["file"] for figure in printed["figures"]}
        self.assertEqual(len(files), 2)
        self.assertTrue(all((self.folder / "v" / name).is_file() for name in files))

    def test_text_in_the_table_is_quoted(self):
        self.write("names.toml", program.BALL.replace('name = "ball"', "name = 'a \"b\", c'"))
        self.done("study", "visibility", "names.toml", "-o", "v", "--camera", "A")
        self.assertEqual(self.table("v", "results.csv")[0]["target"], 'a "b", c')


class Refused(Study):
    def test_studies_that_are_not_there_name_those_that_are(self):
        self.says(self.refused("study", "tides", "ball.toml", "-o", "d"), '"tides"', "visibility", "compare", "orbit")
        self.says(self.refused("study", "compre", "ball.toml", "-o", "d"), 'did you mean "compare"?')
        self.says(self.refused("study"), "study --help")

    def test_wrong_calls(self):
        self.says(self.refused("study", "compare", "ball.toml"), "study compare", "--output")
        for lights in ("", "1", "4,", "4,x", "-4", "4.5"):
            self.says(self.refused("study", "compare", "ball.toml", "-o", "d", f"--lights={lights}"), "--lights")
        self.says(self.refused("study", "visibility", "ball.toml", "-o", "d", "--camera", "none"), '"none"', "above")
        self.says(self.refused("study", "visibility", "ball.toml", "-o", "d", "--lights", "4"), '"--lights"')
        self.assertEqual(self.files("."), ["ball.toml", "monitored.toml"])  # no work was started

    def test_folder_that_cannot_be(self):
        self.says(self.refused("study", "compare", "ball.toml", "-o", "ball.toml"), "ball.toml", "folder")
        (self.folder / "d" / "compare.csv").mkdir(parents=True)
        self.says(self.refused("study", "compare", "ball.toml", "-o", "d"), "compare.csv", "folder")

    def test_scene_without_cameras(self):
        self.write("bare.toml", program.BALL.split("[[camera]]")[0])
        for study in ("visibility", "compare"):
            self.says(self.refused("study", study, "bare.toml", "-o", "d"), "camera")


if __name__ == "__main__":
    unittest.main()
