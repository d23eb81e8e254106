# SPDX-License-Identifier: Apache-2.0
"""An effect that is off casts no rays and changes no byte; the report lists each active effect."""
import unittest

import exr
import program

DARK_LAMP = '[[light]]\nname = "dark"\ntype = "{}"\n{}\n'
DARK_LAMPS = {
    "point lamps": DARK_LAMP.format("point", "position = [0, 0, 2]\nintensity = 0"),
    "spot lamps": DARK_LAMP.format("spot", "position = [0, 0, 2]\naim = [0, 0, 0]\nintensity = 0\nbeam_deg = 20\nfield_deg = 40"),
    "rectangle lamps": DARK_LAMP.format("rectangle", "center = [0, 0, 2]\nedge_u = [1, 0, 0]\nedge_v = [0, -1, 0]\nexitance = 0"),
    "disk lamps": DARK_LAMP.format("disk", "center = [0, 0, 2]\nnormal = [0, 0, -1]\nradius = 0.3\nexitance = 0"),
}
UNUSED = '[[material]]\nname = "unused"\n'
EARTH = '[earth]\ndirection = [0, -0.8, 0.6]\nmodel = "uniform"\nhalf_angle_deg = {}\nradiance = {}\n'
SHEET = """
[[material]]
name = "sheet"
diffuse = 0.2
{}
[[object]]
name = "sheet"
shape = "quad"
corners = [[-2, 2, 0], [2, 2, 0], [2, 2, 1.5], [-2, 2, 1.5]]
material = "sheet"
"""
BALL = program.BALL
PLAIN = BALL.replace("specular = 0.3\nshininess = 20\n", "")

# Scenes in which an effect has nothing to do: additional text for the scene, inserted first so that
# the indices of lamps and materials shift, and options of the call.
IDLE = {
    "a material that nothing wears, with everything": (UNUSED + "diffuse = 0.1\nspecular = 0.1\nshininess = 5\nmirror = 0.2\ntransmit = 0.2\nior = 1.5\nemit = 4\n", []),
    "emit 0": ("", ["--set", "material.floor.emit=0"]),
    "specular 0": ("", ["--set", "material.floor.specular=0", "--set", "material.floor.shininess=30"]),
    "mirror 0": ("", ["--set", "material.floor.mirror=0"]),
    "transmit 0": ("", ["--set", "material.floor.transmit=0"]),
    "aperture 0 alone": ("", ["--set", "camera.A.aperture=0"]),
    "aperture 0": ("", ["--set", "camera.A.aperture=0", "--set", "camera.A.focus=3"]),
    "the Earth without light, narrow": (EARTH.format(5, 0), []),
    "the Earth without light, wide": (EARTH.format(30, 0), []),
    "ambient 0": ("[ambient]\nradiance = 0\n", []),
} | {f"a dark lamp of the {kind}": (lamp, []) for kind, lamp in DARK_LAMPS.items()}

# A floor under the Sun only: no surface faces another.
FLOOR = PLAIN.replace(PLAIN[PLAIN.index('[[object]]\nname = "ball"'):PLAIN.index("[[light]]")], "").replace(
    PLAIN[PLAIN.index("[[light]]"):PLAIN.index("[sun]")], "")
SPOT = DARK_LAMP.format("spot", "position = [0, 0, 1]\naim = [0, 0, {}]\nintensity = 100\nbeam_deg = 20\nfield_deg = {}")
FLAT = DARK_LAMP.format("rectangle", "center = [0, 0, 1]\nedge_u = [1, 0, 0]\nedge_v = [0, {}, 0]\nexitance = 9")
BELOW = EARTH.replace("[0, -0.8, 0.6]", "[0, 0, -1]")
FACING = "diffuse = 0.5\n[[object]]\nname = \"lid\"\nshape = \"quad\"\ncorners = [[-1, -1, 3], [-1, 1, 3], [1, 1, 3], [1, -1, 3]]\nmaterial = \"lid\"\n"
LID = '[[material]]\nname = "lid"\n' + FACING
# Additions to the floor, the row, whether the effect is found to be irrelevant, and the reason.
MATTERS = [
    ("", [], "interreflection", True, "no surface is in front of another"),
    (LID, [], "interreflection", False, ""),
    (LID, ["--set", "material.lid.diffuse=1e-6", "--set", "material.floor.diffuse=1e-5"], "interreflection", True, "wanted error is 0.02"),
    (LID, ["--set", "material.lid.diffuse=1e-6", "--set", "material.floor.diffuse=3e-5"], "interreflection", False, ""),
    (LID, ["--set", "material.lid.diffuse=1e-6", "--set", "material.floor.diffuse=3e-5", "--error", "0.1"], "interreflection", True, "error is 0.1"),
    (BELOW.format(60, 100), [], "earth", True, "below the horizon"),
    (BELOW.format(60, 100) + LID, [], "earth", False, ""),
    (BELOW.format(60, 100), ["--set", "material.floor.two_sided=true"], "earth", False, ""),
    (EARTH.format(60, 100), [], "earth", False, ""),
    ("", ["--set", "sun.direction=[0.1, 0, -1]"], "sun", True, "below the horizon"),
    ("", ["--set", "sun.direction=[1, 0, -0.001]"], "sun", False, ""),  # half of its disc is above
                                                                        # the horizon
    (SPOT.format(5, 40), [], "spot lamps", True, "in reach of lamp \"dark\""),
    (SPOT.format(5, 179), [], "spot lamps", True, "in reach"),
    (SPOT.format(0, 40), [], "spot lamps", False, ""),
    (FLAT.format(1), ["--camera", "A", "--set", "camera.A.position=[3, -3, 0.5]"], "rectangle lamps", True, "in reach"),
    (FLAT.format(1), ["--camera", "A"], "rectangle lamps", False, ""),  # the camera sees its front
                                                                        # from above
    (FLAT.format(-1), ["--camera", "A", "--set", "camera.A.position=[3, -3, 0.5]"], "rectangle lamps", False, ""),
]

# A closed box around a lamp, seen from inside.
QUAD = '[[object]]\nname = "{}"\nshape = "quad"\ncorners = {}\nmaterial = "{}"\n'
CORNERS = {"x0": [[0, 0, 0], [0, 1, 0], [0, 1, 1], [0, 0, 1]], "x1": [[1, 0, 0], [1, 0, 1], [1, 1, 1], [1, 1, 0]],
           "y0": [[0, 0, 0], [0, 0, 1], [1, 0, 1], [1, 0, 0]], "y1": [[0, 1, 0], [1, 1, 0], [1, 1, 1], [0, 1, 1]],
           "z0": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], "z1": [[0, 0, 1], [0, 1, 1], [1, 1, 1], [1, 0, 1]]}
PLACED = {face: [[x - 0.5, y - 0.5, z * 0.5 + 0.2] for x, y, z in corners] for face, corners in CORNERS.items()}
SHORT = [[min(x, 0.499), y, z] for x, y, z in PLACED["z1"]]
SHUT_IN = ('[[material]]\nname = "wall"\ndiffuse = 0.5\n[[material]]\nname = "lid"\ndiffuse = 0.1\n{}\n'
           + "".join(QUAD.format(face, corners, "wall") for face, corners in PLACED.items() if face != "z1") + "CUT"
           + '[[light]]\nname = "in"\ntype = "point"\nposition = [0, 0, 0.4]\nintensity = 100\n')
LID_ON = QUAD.format("z1", PLACED["z1"], "lid")
# Additional keys of the lid, the lid, and whether the lamp is found to be irrelevant.
SHUT = {"shut": ("", LID_ON, True), "a lid a millimetre short": ("", QUAD.format("z1", SHORT, "lid"), False),
        "no lid": ("", "", False), "a lid of glass": ("transmit = 0.5\nior = 1.5", LID_ON, False),
        "a lid that mirrors": ("mirror = 0.5", LID_ON, False), "a lid of two sides": ("two_sided = true", LID_ON, False)}


def with_more(scene, more):
    """Inserts text after the head, before the scene's tables."""
    at = scene.index("[[material]]")
    return scene[:at] + more + scene[at:]


class Effects(program.Case):
    def render(self, scene, *call):
        self.write("scene.toml", scene)
        report = self.json("render", "scene.toml", "--camera", "A", "-o", "a.exr", "-q", *call)
        return exr.read(self.folder / "a.exr"), report

    def same(self, picture, other):
        """The channels are bitwise equal."""
        first, second = ({name: values.tobytes() for name, values in p[3].items()} for p in (picture, other))
        self.assertEqual(first, second)

    def test_an_idle_effect_costs_no_ray_and_no_byte(self):
        for scene in (BALL, PLAIN):
            for how in ([], ["--indirect", "none"], ["--indirect", "paths"]):
                picture, report = self.render(scene, *how)
                for name, (more, sets) in IDLE.items():
                    if scene is PLAIN and name != "specular 0" and how:
                        continue
                    with self.subTest(name=name, how=how):
                        idle, cost = self.render(with_more(scene, more), *how, *sets)
                        self.assertEqual(cost["rays"], report["rays"])
                        self.assertEqual(cost["patches"], report["patches"])
                        self.same(idle, picture)

    def test_dark_sources_leave_the_others_alone(self):
        without = BALL.replace("[sun]\ndirection = [-0.3, 0.2, 1]\nilluminance = 1000\n", "")
        picture, report = self.render(without)
        dark, cost = self.render(BALL, "--set", "sun.illuminance=0")
        self.assertEqual(cost["rays"], report["rays"])
        self.same(dark, picture)

    def test_without_light_nothing_is_solved(self):
        _, report = self.render(BALL, "--set", "sun.illuminance=0", "--set", "light.lamp.intensity=0")
        rays = report["rays"]
        self.assertEqual((rays["form_factors"], rays["direct"], rays["shadow"], rays["gather"], rays["lobe"]), (0,) * 5)

    def test_black_surfaces_are_not_solved_for(self):
        _, report = self.render(BALL, "--set", "material.floor.diffuse=0", "--set", "material.paint.diffuse=0")
        rays = report["rays"]
        self.assertEqual((report["patches"], rays["form_factors"], rays["gather"], rays["lobe"]), (0, 0, 0, 0))
        self.assertGreater(rays["shadow"], 0)  # highlights

    def test_each_kind_of_ray_has_a_counter_of_its_own(self):
        lit = {"point lamps": ("", [])}
        for kind, lamp in DARK_LAMPS.items():
            if kind != "point lamps":
                lit[kind] = (lamp.replace("intensity = 0", "intensity = 9").replace("exitance = 0", "exitance = 9"), [])
        lit["sun"] = ("", [])
        lit["earth"] = (EARTH.format(5, 100), [])
        lit["emitting surfaces"] = (SHEET.format("emit = 5").replace("-2, 2,", "-0.2, 2,").replace("[2, 2,", "[0.2, 2,"), [])
        self.write("even.ies", program.EVEN_IES)
        lit["measured lamps"] = (program.IES_LAMP, [])
        for kind, (more, sets) in lit.items():
            with self.subTest(kind=kind):
                rays = self.render(with_more(BALL, more), *sets)[1]["rays"]
                self.assertGreater(rays["shadow_by"][kind], 0)
                self.assertGreater(rays["direct_by"][kind], 0)
                self.assertEqual(sum(rays["shadow_by"].values()), rays["shadow"])
                self.assertEqual(sum(rays["direct_by"].values()), rays["direct"])
                runs = {"point lamps", "sun", kind}
                self.assertEqual({k for k, n in rays["shadow_by"].items() if n > 0}, runs)
                self.assertEqual({k for k, n in rays["direct_by"].items() if n > 0}, runs)

    def test_specular_rays_are_told_apart(self):
        def kinds(scene, *call):
            rays = self.render(scene, *call)[1]["rays"]
            return {k for k in ("lobe", "mirror", "refraction", "layers") if rays[k] > 0}
        mirror = BALL + SHEET.format("mirror = 0.5\n")
        glass = BALL + SHEET.format("transmit = 0.5\nior = 1.5\n")
        self.assertEqual(kinds(PLAIN), set())
        self.assertEqual(kinds(BALL), {"lobe"})
        self.assertEqual(kinds(BALL, "--indirect", "none"), set())
        self.assertEqual(kinds(mirror), {"lobe", "mirror"})
        self.assertEqual(kinds(glass), {"lobe", "refraction"})
        self.assertEqual(kinds(glass, "--indirect", "paths"), {"lobe", "refraction"})
        self.assertEqual(kinds(PLAIN, "--aov", "depth"), {"layers"})
        self.assertEqual(kinds(PLAIN, "--aov", "crypto_object"), {"layers"})
        self.assertEqual(kinds(PLAIN, "--per-light"), set())

    def test_report_sets_what_was_expected_beside_what_was_taken(self):
        self.write("scene.toml", BALL)
        # A second of work or more, so that time outside all rows is a small share, also on a busy
        # machine.
        size = [more for name in ("A", "above") for more in ("--set", f"camera.{name}.resolution=[192,144]")]
        said = self.json("render", "scene.toml", "-o", "a.exr", "--report", "r.json", "--camera", "A,above", "-q", *size)
        report = program.json.loads((self.folder / "r.json").read_text())
        rows = {row["effect"]: row for row in report["effects"]}
        plan = {row["effect"]: row for row in self.json("plan", "scene.toml", *size)["effects"]}
        self.assertEqual(rows.keys(), plan.keys())
        for name, row in rows.items():
            self.assertEqual((row["runs"], row["why"]), (plan[name]["runs"], plan[name]["why"]))
            if not row["runs"]:
                for part in (row["expected"], row["taken"], plan[name]):
                    self.assertEqual((part["rays"], part["seconds"]), (0, 0), name)
        shadow = sum(s["rays"]["shadow_by"]["sun"] for s in said) + said[0]["rays"]["direct_by"]["sun"]
        self.assertEqual(rows["sun"]["taken"]["rays"], shadow)
        self.assertEqual(report["taken"]["patches"], said[0]["patches"])
        # Every ray of the call is in one row.
        pictures = ("camera", "shadow", "gather", "lobe", "mirror", "refraction", "planning", "layers")
        cast = sum(s["rays"][kind] for s in said for kind in pictures)
        cast += said[0]["rays"]["form_factors"] + said[0]["rays"]["direct"]
        self.assertEqual(sum(row["taken"]["rays"] for row in rows.values()), cast)
        # Every second too, except the time of direct light between its sources.
        total = report["taken"]["seconds"]
        self.assertAlmostEqual(sum(row["taken"]["seconds"] for row in rows.values()), total, delta=0.05 * total)
        # Uniform patches: counts follow from the sizes; the number of camera samples is a rough
        # estimate.
        self.assertEqual(report["expected"]["patches"], report["taken"]["patches"])
        for name in ("interreflection", "sun", "point lamps", "camera rays", "glossy reflection"):
            ratio = rows[name]["expected"]["rays"] / rows[name]["taken"]["rays"]
            self.assertTrue(0.5 < ratio < 2, (name, ratio))
        self.says(self.refused("render", "scene.toml", "-o", "a.exr", "--report", "r.txt"), "--report", ".json")

    def test_what_cannot_matter_is_found_and_nothing_else(self):
        for more, call, effect, found, why in MATTERS:
            with self.subTest(effect=effect, more=more, call=call):
                self.write("scene.toml", with_more(FLOOR, more))
                rows = {row["effect"]: row for row in self.json("plan", "scene.toml", *call)["effects"]}
                self.assertIs(rows[effect]["runs"], not found, rows[effect]["why"])
                self.assertEqual("cannot matter" in rows[effect]["why"], found)
                self.assertIn(why, rows[effect]["why"])
                self.assertEqual("skipped_error" in rows[effect], found)
                if found:
                    self.assertLessEqual(rows[effect]["skipped_error"], 1e-3 * 0.1 * 1.0001)
                    rows = {r["effect"]: r for r in self.json("plan", "scene.toml", "--all-effects", *call)["effects"]}
                    self.assertTrue(rows[effect]["runs"])

    def test_a_solution_that_was_read_is_not_on_the_bill(self):
        self.write("scene.toml", BALL)
        self.done("solve", "scene.toml", "-o", "s.h5", "-q")
        said = self.json("render", "scene.toml", "-o", "a.exr", "--report", "r.json", "--camera", "A", "-q", "--solution", "s.h5")
        report = program.json.loads((self.folder / "r.json").read_text())
        self.assertEqual(report["solution"], "s.h5")
        pictures = ("camera", "shadow", "gather", "lobe", "mirror", "refraction", "planning", "layers")
        self.assertEqual(sum(row["taken"]["rays"] for row in report["effects"]), sum(said["rays"][k] for k in pictures))
        rows = {row["effect"]: row for row in report["effects"]}
        self.assertEqual(rows["interreflection"]["taken"]["rays"], said["rays"]["gather"])
        self.assertEqual(rows["sun"]["taken"]["rays"], said["rays"]["shadow_by"]["sun"])
        ratio = rows["interreflection"]["expected"]["rays"] / rows["interreflection"]["taken"]["rays"]
        self.assertTrue(0.5 < ratio < 2, ratio)
        self.assertNotIn("direct_by", said["rays"])

    def test_lights_behind_closed_walls_are_found_and_those_behind_leaking_ones_are_not(self):
        """A lamp in a box on the floor. It is relevant if the lid is short, of glass or missing."""
        for name, (wall, cut, found) in SHUT.items():
            with self.subTest(name=name):
                scene = with_more(FLOOR, SHUT_IN.format(wall)).replace("CUT", cut)
                self.write("scene.toml", scene)
                rows = {row["effect"]: row for row in self.json("plan", "scene.toml", "--camera", "A")["effects"]}
                self.assertIs(rows["point lamps"]["runs"], not found, rows["point lamps"]["why"])
                self.assertEqual("closed walls" in rows["point lamps"]["why"], found)
                if not found:
                    continue
                # Direct light only, so that patches have no effect.
                skipped, cost = self.render(scene, "--indirect", "none")
                whole, price = self.render(scene, "--indirect", "none", "--all-effects")
                self.assertEqual(cost["rays"]["shadow_by"]["point lamps"], 0)
                self.assertGreater(price["rays"]["shadow_by"]["point lamps"], 0)
                self.same(skipped, whole)
                inside = self.json("plan", "scene.toml", "--camera", "A", "--set", "camera.A.position=[0, 0, 0.4]",
                                   "--set", "camera.A.look_at=[0, 0, 1]", "--set", "camera.A.up=[0, 1, 0]")
                rows = {row["effect"]: row for row in inside["effects"]}
                self.assertTrue(rows["point lamps"]["runs"])
                for effect in ("sun", "penumbra"):
                    self.assertIn("cannot matter", rows[effect]["why"])

    def test_lights_on_an_area_do_not_set_with_the_earth(self):
        # The disc's upper edge is 3 degrees below the floor's horizon; the area on its side is
        # above the floor.
        area = '[[area]]\nname = "sky"\ncenter = [3, 0, 1]\nedge_u = [0, 0, 1]\nedge_v = [0, 1, 0]\n'
        earth = BELOW.format(3, 100).replace("direction = [0, 0, -1]", "direction = [1, 0, -0.1051]")
        self.assertIn("-0.1051", earth)
        self.write("scene.toml", with_more(FLOOR, area + earth))
        for over, runs in ((["--distributed-over", "sky"], True), ([], False)):
            rows = self.json("plan", "scene.toml", "--indirect", "distributed", *over)["effects"]
            self.assertEqual([row["runs"] for row in rows if row["effect"] == "earth"], [runs])

    def test_what_is_skipped_was_not_in_the_picture(self):
        away = ["--set", "camera.A.position=[3, -3, 0.5]"]
        for more, sets in [("", []), (BELOW.format(60, 100), []), (SPOT.format(5, 40), []), (FLAT.format(1), away)]:
            with self.subTest(more=more):
                skipped, cost = self.render(with_more(FLOOR, more), *sets)
                whole, price = self.render(with_more(FLOOR, more), "--all-effects", *sets)
                for channel in "RGB":
                    a, b = skipped[3][channel], whole[3][channel]
                    self.assertAlmostEqual(sum(a) / sum(b), 1, delta=0.01)
                    lit = max(b)
                    self.assertLess(max(abs(x - y) for x, y in zip(a, b)), 0.25 * lit)  # only at
                                                                                        # edges
                rays, paid = cost["rays"], price["rays"]
                self.assertEqual((rays["form_factors"], rays["gather"]), (0, 0))
                self.assertGreater(paid["form_factors"], 0)
                for kind in ("earth", "spot lamps", "rectangle lamps"):
                    self.assertEqual((rays["shadow_by"][kind], rays["direct_by"][kind]), (0, 0))


if __name__ == "__main__":
    unittest.main()
