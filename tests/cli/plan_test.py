# SPDX-License-Identifier: Apache-2.0
"""plan: the row of each effect, and the key or fact that decides about it."""
import unittest

import program

EARTH = '\n[earth]\ndirection = [0, 0, -1]\nmodel = "uniform"\nradiance = {}\nhalf_angle_deg = {}\n'
SHEET = '\n[[material]]\nname = "sheet"\ndiffuse = 0.1\n{}\n{}'
WORN = """
[[object]]
name = "sheet"
shape = "quad"
corners = [[-2, 2, 0], [2, 2, 0], [2, 2, 1], [-2, 2, 1]]
material = "sheet"
"""


def lamp(kind, keys):
    return f'\n[[light]]\nname = "{kind}"\ntype = "{kind}"\n{keys}\n'


SPOT = lamp("spot", "position = [0, 0, 2]\naim = [0, 0, 0]\nintensity = {}\nbeam_deg = 20\nfield_deg = 40")
DISK = lamp("disk", "center = [0, 0, 2]\nnormal = [0, 0, -1]\nradius = 0.1\nexitance = {}")
RECTANGLE = lamp("rectangle", "center = [0, 0, 2]\nedge_u = [1, 0, 0]\nedge_v = [0, -1, 0]\nexitance = {}")

# Additions to the ball's scene, the call, and the row: effect, whether it runs, required text.
ROWS = [
    ("", [], "interreflection", True, '"floor" has diffuse > 0'),
    ("", ["--indirect", "none"], "interreflection", False, "straight from the sources"),
    ("", ["--indirect", "paths"], "interreflection", True, "diffuse > 0"),
    ("", ["--set", "sun.illuminance=0", "--set", "light.lamp.intensity=0"], "interreflection", False, "no source"),
    ("", [], "sun", True, "up"),
    ("", ["--set", "sun.illuminance=0"], "sun", False, "sun.illuminance is 0"),
    ("\n[earth]\ndirection = [-0.3, 0.2, 1]\naltitude_km = 300\n", [], "sun", False, "behind the Earth"),
    ("", [], "penumbra", True, "0.2666"),
    ("", ["--set", "sun.angular_radius_deg=0"], "penumbra", False, "sun.angular_radius_deg is 0"),
    ("", ["--indirect", "distributed"], "penumbra", False, "distributed"),
    ("", [], "earth", False, "no [earth]"),
    (EARTH.format(0, 60), [], "earth", False, "earth.radiance is 0"),
    (EARTH.format(1, 60), [], "earth", True, "without separate rays"),
    (EARTH.format(1, 5), [], "earth", True, "shadow rays"),
    ("\n[earth]\ndirection = [0, 0, -1]\naltitude_km = 300\nalbedo = 0\n", [], "earth", False, "earth.albedo is 0"),
    ("\n[earth]\ndirection = [-0.3, 0.2, 1]\naltitude_km = 300\n", [], "earth", False, "dark"),
    ("", [], "lamps", True, "lit"),
    ("", ["--set", "light.lamp.intensity=0"], "lamps", False, "every lamp is off"),
    ("", [], "point lamps", True, "1 of 1"),
    ("", ["--set", "light.lamp.intensity=0"], "point lamps", False, "0 of 1"),
    ("", [], "spot lamps", False, 'no [[light]] with type = "spot"'),
    (SPOT.format(5), [], "spot lamps", True, "1 of 1"),
    (SPOT.format(0), [], "spot lamps", False, "0 of 1"),
    (RECTANGLE.format(5), [], "rectangle lamps", True, "1 of 1"),
    (RECTANGLE.format(0), [], "rectangle lamps", False, "0 of 1"),
    (DISK.format(5), [], "disk lamps", True, "1 of 1"),
    (DISK.format(0), [], "disk lamps", False, "0 of 1"),
    (program.IES_LAMP, [], "measured lamps", True, "1 of 1"),
    (SHEET.format("emit = 3", WORN), [], "emitting surfaces", True, '"sheet" has emit > 0'),
    (SHEET.format("emit = 3", ""), [], "emitting surfaces", False, "nothing wears it"),
    (SHEET.format("emit = 0", WORN), [], "emitting surfaces", False, "no material in use has emit > 0"),
    ("\n[ambient]\nradiance = 0.5\n", [], "ambient", True, "above 0"),
    ("\n[ambient]\nradiance = 0\n", [], "ambient", False, "no [ambient] radiance"),
    ("", [], "phong lobe", True, '"paint" has specular > 0'),
    ("", ["--set", "material.paint.specular=0"], "phong lobe", False, "no material in use has specular > 0"),
    ("", [], "glossy reflection", True, "reflects surfaces"),
    ("", ["--indirect", "none"], "glossy reflection", False, "straight from the sources"),
    ("", [], "mirror", False, "no material in use has mirror > 0"),
    (SHEET.format("mirror = 0.5", WORN), [], "mirror", True, '"sheet" has mirror > 0'),
    (SHEET.format("mirror = 0.5", ""), [], "mirror", False, "nothing wears it"),
    (SHEET.format("transmit = 0.5\nior = 1.5", WORN), [], "refraction", True, '"sheet" has transmit > 0'),
    (SHEET.format("transmit = 0.5\nior = 1.5", ""), [], "refraction", False, "nothing wears it"),
    ("", [], "depth of field", False, "no camera has an aperture"),
    ("", ["--camera", "A"], "depth of field", False, 'camera "A" has no aperture'),
    ("", ["--set", "camera.A.aperture=0.1", "--set", "camera.A.focus=3"], "depth of field", True, '"A" has aperture 0.1'),
    ("", ["--set", "camera.A.aperture=0.1", "--set", "camera.A.focus=3", "--camera", "above"], "depth of field", False,
     '"above" has no aperture'),
    ("", [], "light groups", True, "2 group(s)"),
    ("", ["--set", "sun.illuminance=0"], "light groups", False, "1 group(s)"),
    ("", [], "layers", False, "asks for none"),
    ("", ["--per-light", "--aov", "depth,normal"], "layers", True, "one per light group, depth, normal"),
    ("", [], "cctv", False, "no camera names"),
    ("", ["--set", "camera.above.cctv=report-1990"], "cctv", True, '"above" names'),
    ("", ["--set", "camera.above.cctv=report-1990"], "cctv: glare", False, "glare is 0"),
    ("", ["--set", "camera.above.cctv=report-1990"], "cctv: iris", True, "every CCTV picture"),
    ("", ["--cctv"], "cctv: glare", True, "glare is 0."),
]


class Plan(program.Case):
    def row(self, added, call, effect):
        self.write("even.ies", program.EVEN_IES)
        self.write("scene.toml", program.BALL + added)
        rows = {row["effect"]: row for row in self.json("plan", "scene.toml", *call)["effects"]}
        self.assertIn(effect, rows)
        return rows[effect]

    def test_every_row_says_what_decided(self):
        for added, call, effect, runs, why in ROWS:
            with self.subTest(effect=effect, added=added, call=call):
                row = self.row(added, call, effect)
                self.assertIs(row["runs"], runs, row["why"])
                self.assertIn(why, row["why"])

    def test_only_stages_of_a_wanted_cctv_picture_have_rows(self):
        self.write("scene.toml", program.BALL)
        names = [row["effect"] for row in self.json("plan", "scene.toml")["effects"]]
        self.assertFalse([name for name in names if name.startswith("cctv:")])
        self.assertEqual(len(names), len(set(names)))

    def test_every_stage_says_which_settings_decide(self):
        """An effect that can be off names a setting; the named settings switch it on or off."""
        listed = self.done("degrade", "--list").split("stages, in order\n")[1].split("\n\n")[0]
        stages = [line.split()[0] for line in listed.splitlines() if line.startswith("  ")]
        self.assertGreater(len(stages), 20)
        seen = {}
        for preset in ("ideal", "report-1990", "sit-monochrome", "sit-colour-wheel", "ccd-colour"):
            self.write("scene.toml", program.BALL)
            rows = self.json("plan", "scene.toml", "--camera", "A", "--set", f"camera.A.cctv={preset}")["effects"]
            planned = {row["effect"][6:]: row for row in rows if row["effect"].startswith("cctv: ")}
            self.assertEqual(list(planned), stages)
            for name, row in planned.items():
                seen.setdefault(name, set()).add((row["runs"], row["why"]))
        for name, rows in seen.items():
            always = {why for _, why in rows} == {"part of every CCTV picture"}
            if always:
                self.assertEqual({runs for runs, _ in rows}, {True}, name)
            else:
                self.assertTrue(all(" is " in why for _, why in rows), name)
            # The same settings give the same decision.
            self.assertEqual(len(rows), len({why for _, why in rows}), name)

    def test_cameras_and_sizes_are_those_of_the_call(self):
        self.write("scene.toml", program.BALL)
        images = self.json("plan", "scene.toml", "--camera", "above", "--size", "10x6")["images"]
        self.assertEqual([(i["camera"], i["resolution"], i["gather_rays"]) for i in images],
                         [("above", [10, 6], 16 * 60)])
        straight = self.json("plan", "scene.toml", "--indirect", "none")
        self.assertEqual((straight["rays"], [i["gather_rays"] for i in straight["images"]]), (0, [0, 0]))
        self.assertNotIn("form factors", straight["memory"]["parts_mib"])

    def test_without_light_there_is_nothing_to_solve(self):
        self.write("ball.toml", program.BALL)
        dark = self.done("plan", "ball.toml", "--set", "sun.illuminance=0", "--set", "light.lamp.intensity=0")
        self.assertIn("no radiosity", dark)
        self.assertNotIn("patches with", dark)

    def test_what_does_not_fit_is_said(self):
        self.write("ball.toml", program.BALL)
        call = ("plan", "ball.toml", "--set", "quality.patch_edge=0.02", "--set", "quality.refine=false")
        self.assertIn("that may not fit: 30 MiB are allowed by --max-memory", self.done(*call, "--max-memory", "30MiB"))
        self.assertNotIn("may not fit", self.done(*call))

    def test_ranks(self):
        """Seconds as in docs/scaling.md, t (s + (1 - s) / R) + b / W, with the seconds of one
        process at R = 1. The entries of the matrix are divided between ranks; the vectors of the
        linear solve are on rank 0 only. Memory in all is that of rank 0 plus that of the others."""
        self.write("scene.toml", program.BALL)
        self.assertNotIn("ranks", self.json("plan", "scene.toml"))
        stated = {}
        for count in (1, 2, 64):
            plan = self.json("plan", "scene.toml", "--set", "quality.patch_edge=0.01", "--ranks", count)
            ranks = plan["ranks"]
            most = max(part["memory"]["total_mib"] for part in (plan, *plan["images"]))
            each = ranks["memory_mib_each"]
            self.assertEqual(ranks["count"], count)
            others = ranks["memory_mib_others"]
            self.assertAlmostEqual(ranks["memory_mib_all"], each + (count - 1) * others, delta=1e-9 * count * each)
            if count == 1:  # the libraries of Open MPI
                self.assertAlmostEqual(each - most, 12e6 / 2**20, delta=1e-6)
            else:
                self.assertNotEqual(each, most)
            stated[count] = (each, others)
            whole = plan["expected"]["seconds"]
            self.assertAlmostEqual(ranks["shared_seconds"] + ranks["unshared_seconds"], whole, delta=1e-9 * whole)
            self.assertGreater(ranks["unshared_seconds"], 0)  # energy ledger
            self.assertEqual(ranks["exchanged_bytes"] > 0, count > 1)
            expected = (ranks["unshared_seconds"] + ranks["shared_seconds"] / count
                        + ranks["exchanged_bytes"] / ranks["network_bytes_per_second"])
            self.assertAlmostEqual(ranks["seconds"], expected, delta=1e-9 * whole)
        for each, others in (stated[2], stated[64]):
            self.assertLess(others, each)
        self.assertLess(stated[64], stated[2])
        # Without a solve only pixels are exchanged, 24 bytes each, and all work is shared.
        ranks = self.json("plan", "scene.toml", "--indirect", "none", "--ranks", "2")["ranks"]
        self.assertEqual((ranks["exchanged_bytes"], ranks["unshared_seconds"]), (24 * (32 * 24 + 20 * 20), 0))
        self.assertIn("MiB in the first rank, ", self.done("plan", "scene.toml", "--ranks", "4"))
        for wrong in ("0", "-1", "two"):
            self.says(self.refused("plan", "scene.toml", "--ranks", wrong), "--ranks")

    def test_patches_are_those_that_are_cut_where_lamps_are_near(self):
        self.write("scene.toml", program.BALL)
        counts = []
        for height in (2, 0.1):
            options = ["--set", "quality.patch_edge=0.8", "--set", "quality.refine=false",
                       "--set", f"light.lamp.position=[1.5, 0, {height}]"]
            plan = self.json("plan", "scene.toml", *options)
            counts.append(plan["patches"])
            self.assertEqual(plan["expected"]["patches"], plan["patches"])
            self.assertEqual(self.json("solve", "scene.toml", *options)["patches"], plan["patches"])
        self.assertGreater(counts[1], counts[0])

    def test_bad_options_are_refused_as_render_refuses_them(self):
        self.write("scene.toml", program.BALL)
        self.says(self.refused("plan", "scene.toml", "--aov", "depth", "--indirect", "paths"), "--aov", "--indirect paths")
        self.says(self.refused("plan", "scene.toml", "--camera", "A,above,A"), "--camera", "names A twice")
        self.says(self.refused("plan", "scene.toml", "--aov", "deep"), "deep", "depth")
        self.says(self.refused("plan", "scene.toml", "--camera", "B"), '"B"', "A, above")
        self.says(self.refused("plan", "scene.toml", "--size", "10"), "COLUMNSxROWS")


if __name__ == "__main__":
    unittest.main()
