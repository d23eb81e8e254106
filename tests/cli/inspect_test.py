# SPDX-License-Identifier: Apache-2.0
"""inspect, plan and form-factors on small scenes with known figures."""
import csv
import io
import unittest

import program


class Inspect(program.Case):
    def test_json_says_what_was_read(self):
        self.write("ball.toml", program.BALL)
        report = self.json("inspect", "ball.toml")
        self.assertEqual(report["name"], "ball on a floor")
        floor, ball = report["objects"]
        self.assertEqual((floor["name"], floor["triangles"], floor["target"]), ("floor", 2, False))
        self.assertAlmostEqual(floor["area_m2"], 16.0)
        self.assertEqual((ball["materials"], ball["target"]), (["paint"], True))
        self.assertEqual(report["triangles"], floor["triangles"] + ball["triangles"])
        self.assertEqual([m["name"] for m in report["materials"]], ["floor", "paint"])
        self.assertEqual(sorted(report["light_groups"]), ["lamp", "sun"])
        # Isotropic: flux = 4 pi I.
        self.assertAlmostEqual(report["lamps"][0]["flux_lm"][0], 4 * 3.141592653589793 * 900, places=6)
        self.assertAlmostEqual(sum(x * x for x in report["sun"]["direction"]), 1.0)
        self.assertIsNone(report["earth"])
        self.assertEqual([c["name"] for c in report["cameras"]], ["A", "above"])
        self.assertEqual(report["bounding_box"]["min_m"], [-2, -2, 0])
        self.assertEqual(report["warnings"], [])

    def test_text_names_everything(self):
        self.write("ball.toml", program.BALL)
        self.says(self.done("inspect", "ball.toml"), "ball on a floor", "floor", "paint", "lamp", "sun",
                  "camera above", "target")

    def test_why_the_sky_gives_no_light(self):
        self.write("night.toml", "format = 1\n[orbit]\naltitude_km = 400\nposition_deg = 180\n")
        text = self.done("inspect", "night.toml")
        self.says(text, "gives no light: the Sun is behind the Earth", "gives no light: the part of the Earth in view is dark")
        self.assertNotIn("-0.0", text)

    def test_a_material_is_shown_whole(self):
        self.write("ball.toml", program.BALL.replace("shininess = 20", "mirror = 0.2\ntransmit = 0.1\nior = 1.5\ntwo_sided = true"))
        line = next(line for line in self.done("inspect", "ball.toml").splitlines() if line.startswith("paint"))
        self.assertTrue(line.endswith("  mirror 0.2 0.2 0.2; transmits 0.1 0.1 0.1, ior 1.5; two-sided"), line)

    def test_units_become_metres(self):
        self.write("box.toml", program.CLOSED_BOX.replace('unit = "m"', 'unit = "ft"'))
        area = self.json("inspect", "box.toml")["objects"][0]["area_m2"]
        self.assertAlmostEqual(area, 24 * 0.3048 ** 2)

    def test_overrides_apply(self):
        self.write("ball.toml", program.BALL)
        report = self.json("inspect", "ball.toml", "--set", "camera.above.fov_deg=30",
                           "--set", "light.lamp.intensity=0")
        self.assertEqual(report["cameras"][1]["fov_deg"], 30)
        self.assertEqual(report["light_groups"], ["sun"])

    def test_measured_luminaire_is_shown_like_other_lamps(self):
        self.write("even.ies", program.EVEN_IES)
        self.write("ball.toml", program.BALL + program.IES_LAMP)
        lamp = self.json("inspect", "ball.toml")["lamps"][-1]
        self.assertEqual((lamp["type"], lamp["source"], lamp["group"]), ("ies", "even.ies", "flood"))
        self.assertAlmostEqual(lamp["flux_lm"][1], 2 * 3.141592653589793 * 100)  # 100 cd, downward
                                                                                 # only
        self.says(self.done("inspect", "ball.toml"), "lamp flood: ies (even.ies), group flood, 628.319")
        self.assertIn("flood", self.json("plan", "ball.toml")["light_groups"])
        flux = self.json("inspect", "ball.toml", "--set", "light.flood.flux=300")["lamps"][-1]["flux_lm"]
        self.assertAlmostEqual(flux[0], 300.0)
        landed = [s for s in self.json("solve", "ball.toml")["sources"] if s["name"] == "flood"]
        self.assertAlmostEqual(landed[0]["emitted_lm"][0], 2 * 3.141592653589793 * 100)

    def test_scene_of_the_guide_is_sound(self):
        guide = (program.TOP / "docs" / "guide.md").read_text(encoding="utf-8")
        self.write("ball.toml", guide.split("```toml\n")[1].split("```")[0])
        self.assertEqual(self.json("inspect", "ball.toml")["light_groups"], ["sun", "lamp"])

    def test_library_scenes_are_sound(self):
        scenes = sorted(path for path in (program.TOP / "scenes" / "library").glob("*/*.toml")
                        if path.parent.name != "materials")  # materials to be included, not scenes
        self.assertGreaterEqual(len(scenes), 4)
        for scene in scenes:
            report = self.json("inspect", scene)
            self.assertEqual(report["warnings"], [], scene)
            self.assertTrue(report["light_groups"] and report["cameras"], scene)


class Plan(program.Case):
    def test_counts_are_those_of_the_solve(self):
        self.write("ball.toml", program.BALL)
        plan = self.json("plan", "ball.toml")
        solved = self.json("solve", "ball.toml")
        self.assertEqual(plan["patches"], solved["patches"])
        self.assertEqual(plan["rays"], solved["rays"])
        self.assertEqual(plan["right_hand_sides"], 6)
        self.assertEqual([i["gather_rays"] for i in plan["images"]], [32 * 24 * 16, 400 * 16])
        self.assertEqual([i["cctv_stages"] for i in plan["images"]], [[], []])
        for row in plan["effects"]:
            self.assertIsInstance(row["runs"], bool)
            self.assertTrue(row["effect"] and row["why"])
        self.says(self.done("plan", "ball.toml"), "yes", "no ", "patches")

    def test_memory_is_stated_by_part_and_near_what_is_taken(self):
        # Uniform patches: their number is exact, not an upper bound. The room's rows are nearly
        # full.
        self.write("box.toml", program.CLOSED_BOX)
        finer = ("--set", "quality.patch_edge=0.04", "--set", "quality.form_factor_rays=512")
        plan = self.json("plan", "box.toml", *finer)
        memory = plan["images"][0]["memory"]
        self.assertAlmostEqual(sum(memory["parts_mib"].values()), memory["total_mib"], places=6)
        of_scene = memory["total_mib"] - memory["parts_mib"]["program"]
        self.assertGreater(memory["parts_mib"]["form factors"], 0.8 * of_scene)
        taken = self.json("render", "box.toml", "-o", "a.exr", *finer)["peak_memory_mib"]
        self.assertAlmostEqual(memory["total_mib"] / taken, 1, delta=0.25)
        self.says(self.done("plan", "box.toml", *finer), "memory of the solution: about", "form factors")

    def test_cctv_stages(self):
        self.write("ball.toml", program.BALL.replace('name = "above"', 'name = "above"\ncctv = "report-1990"'))
        none, some = self.json("plan", "ball.toml")["images"]
        self.assertEqual(none["cctv_stages"], [])
        self.assertIn("iris", some["cctv_stages"])
        self.assertNotIn("glare", some["cctv_stages"])

    def test_dark_scene_costs_nothing(self):
        self.write("box.toml", program.CLOSED_BOX.replace("emit = 10.0", "emit = 0.0"))
        plan = self.json("plan", "box.toml")
        self.assertEqual((plan["rays"], plan["light_groups"]), (0, []))


class FormFactors(program.Case):
    def test_keys_and_closure(self):
        self.write("ball.toml", program.BALL)
        found = self.json("form-factors", "ball.toml")
        self.assertEqual(found["objects"], ["floor", "ball"])
        self.assertAlmostEqual(found["area_m2"][0], 16.0)
        for i in range(2):
            self.assertAlmostEqual(sum(found["F"][i]) + found["sky"][i] + found["black"][i], 1.0, places=12)
            self.assertTrue(all(f >= 0 for f in found["F"][i]))
            self.assertEqual(len(found["std_error"][i]), 2)
        self.assertEqual(found["F"][0][0], 0)  # a plane does not see itself
        self.assertLess(found["max_row_error"], 1e-9)
        self.assertGreaterEqual(found["max_reciprocity_error"], 0)

    def test_walls_of_a_cube(self):
        # Opposite faces 0.199825, adjacent ones 0.200044.
        faces = {"low": "[[0,0,0],[1,0,0],[1,1,0],[0,1,0]]", "high": "[[0,0,1],[0,1,1],[1,1,1],[1,0,1]]",
                 "side": "[[0,0,0],[0,0,1],[1,0,1],[1,0,0]]"}
        text = 'format = 1\nname = "faces"\nunit = "m"\n[[material]]\nname = "m"\ndiffuse = 0.5\n'
        for name, corners in faces.items():
            text += f'[[object]]\nname = "{name}"\nshape = "quad"\ncorners = {corners}\nmaterial = "m"\n'
        self.write("faces.toml", text + "[quality]\npatch_edge = 0.25\nform_factor_rays = 4096\n")
        found = self.json("form-factors", "faces.toml", "--raw")
        for i, j, exact in [(0, 1, 0.199825), (0, 2, 0.200044), (2, 0, 0.200044)]:
            self.assertLess(abs(found["F"][i][j] - exact), 4 * found["std_error"][i][j])
        self.assertFalse(found["balanced"])
        self.says(self.done("form-factors", "faces.toml", "--method", "rays"), "low", "high", "side",
                  "sky", "balanced")
        balanced = self.json("form-factors", "faces.toml", "--method", "rays")
        self.assertTrue(balanced["balanced"])
        self.assertLess(balanced["max_reciprocity_error"], 1e-12)
        self.assertGreater(balanced["before"]["max_reciprocity_error"], 1e-6)

        exact = self.json("form-factors", "faces.toml")
        self.assertEqual(exact["method"], "exact")
        for i, j, value in [(0, 1, 0.19982489569838), (0, 2, 0.2000437760754), (2, 0, 0.2000437760754)]:
            self.assertAlmostEqual(exact["F"][i][j], value, delta=1e-7)
        self.assertIn("exact", self.refused("form-factors", "faces.toml", "--method", "guess"))

    def test_exact_refuses_mirrors_and_auto_takes_rays_for_them(self):
        self.write("ball.toml", program.BALL.replace("shininess = 20", "mirror = 0.2"))
        self.says(self.refused("form-factors", "ball.toml", "--method", "exact"), "mirror", "rays")
        self.assertEqual(self.json("form-factors", "ball.toml")["method"], "rays")

    def test_csv_has_a_line_per_pair_with_names_quoted(self):
        self.write("ball.toml", program.BALL.replace('name = "ball"', 'name = "ball, \\"big\\""'))
        found = self.json("form-factors", "ball.toml")
        rows = list(csv.DictReader(io.StringIO(self.done("form-factors", "ball.toml", "--csv"))))
        self.assertEqual([(r["from"], r["to"]) for r in rows[:4]],
                         [("floor", "floor"), ("floor", 'ball, "big"'), ("floor", "(sky)"),
                          ("floor", "(black backs)")])
        self.assertEqual(len(rows), 8)
        self.assertAlmostEqual(float(rows[1]["F"]), found["F"][0][1])
        self.assertAlmostEqual(float(rows[1]["std_error"]), found["std_error"][0][1])
        self.refused("form-factors", "ball.toml", "--csv", "--json")


if __name__ == "__main__":
    unittest.main()
