# SPDX-License-Identifier: Apache-2.0
"""The three models of tests/support/models.py, textured and faulty, against known answers."""
import math
import sys
import unittest

import exr
import program

sys.path.insert(0, str(program.TOP / "tests" / "support"))
import model_kit  # noqa: E402
import models  # noqa: E402

OBJECT = 'format = 1\n[[object]]\nname = "o"\nmesh = "{}"\n'
CAMERA = """[[camera]]
name = "{name}"
position = {position}
look_at = {look_at}
up = {up}
fov_deg = {fov}
resolution = [{size}, {size}]
"""


def srgb(byte):
    share = byte / 255
    return share / 12.92 if share <= 0.04045 else ((share + 0.055) / 1.055) ** 2.4


class Models(program.Case):
    def put(self, files):
        for name, data in files.items():
            self.write(name, data)

    def render(self, scene, *options):
        run = self.run_program("render", scene, "-o", "out.exr", *options)
        self.assertEqual(run.returncode, 0, run.stderr)
        return exr.read(self.folder / "out.exr")[3], run.stderr

    def camera(self, name, position, look_at, up="[0, 0, 1]", fov=40, size=32):
        return CAMERA.format(name=name, position=position, look_at=look_at, up=up, fov=fov, size=size)

    def test_sides_of_the_crate_show_their_picture_upright(self):
        scene = OBJECT.format("crate.obj")
        sides = {"front": "[0.5, -2, 0.5]", "right": "[3, 0.5, 0.5]", "rear": "[0.5, 3, 0.5]", "left": "[-2, 0.5, 0.5]"}
        for name, position in sides.items():
            scene += self.camera(name, position, "[0.5, 0.5, 0.5]", fov=20)
        self.write("crate.toml", scene + "[sun]\ndirection = [-1, -2, 3]\n")
        self.put(models.crate())
        said = " ".join(self.json("inspect", "crate.toml")["warnings"])
        self.says(said, "6 faces stood twice", "inside out")
        for name in sides:
            faulty = self.render("crate.toml", "--camera", name, "--aov", "albedo", "--no-error")[0]
            left, right = 16 * 32 + 10, 16 * 32 + 21
            self.assertAlmostEqual(faulty["albedo.R"][left], srgb(230), delta=1e-3, msg=name)
            self.assertAlmostEqual(faulty["albedo.G"][left], srgb(20), delta=1e-3, msg=name)
            self.assertAlmostEqual(faulty["albedo.G"][right], srgb(230), delta=1e-3, msg=name)
        faulty = self.render("crate.toml", "--camera", "front")[0]
        self.put(models.crate(sound=True))
        self.assertEqual(self.json("inspect", "crate.toml")["warnings"], [])
        sound = self.render("crate.toml", "--camera", "front")[0]
        for a, b in zip(faulty["G"], sound["G"]):
            self.assertLessEqual(abs(a - b), 0.02 * max(sound["G"]))
        self.assertGreater(sum(sound["G"]), 0)

    def hall(self, **how):
        self.put(models.hall(**how))
        self.write("hall.toml", OBJECT.format("hall.glb") + "lights = true\ncameras = true\n" +
                   self.camera("wall", "[0, -4, 1.5]", "[0, 2, 1.5]", fov=15) +
                   self.camera("below", "[0, 0, 6]", "[0, 0, 0]", up="[0, 1, 0]", fov=7.152669, size=48))

    def test_a_floor_of_squares_bleeds_its_mean_and_shows_its_squares(self):
        means = {}
        for plain in (True, False):
            self.hall(plain=plain)
            floor, = (m for m in self.json("inspect", "hall.toml")["materials"] if m["name"] == "floor")
            self.assertAlmostEqual(floor["diffuse"][0], 0.4, delta=0.002)
            wall = self.render("hall.toml", "--camera", "wall", "--error", "0.01")[0]
            means[plain] = sum(wall["G"]) / len(wall["G"])
        # The squares are a quarter of a metre; hundreds of them light the wall.
        self.assertAlmostEqual(means[False] / means[True], 1.0, delta=0.01)
        # 0.75 m about the floor's centre from 6 m above: 16 pixels per square. u grows with x, v
        # against y. The scale's offset of half a period puts a dark square right of u = 1/2 just
        # above the centre.
        below = self.render("hall.toml", "--camera", "below", "--aov", "albedo", "--no-error")[0]
        for y in range(48):
            for x in range(48):
                metres = ((x + 0.5 - 24) / 64, (24 - y - 0.5) / 64)
                u, v = 8 * (0.5 + metres[0] / 4) + 0.5, 8 * (0.5 - metres[1] / 4)
                light = (math.floor(2 * u) + math.floor(2 * v)) % 2 == 0
                self.assertAlmostEqual(below["albedo.R"][48 * y + x], 0.8 if light else 0.0, delta=1e-3, msg=(x, y))
        bright = sum(value for value, albedo in zip(below["R"], below["albedo.R"]) if albedo > 0.5)
        self.assertGreater(bright, 0.98 * sum(below["R"]))

    def test_walls_with_both_windings_are_sheets(self):
        self.hall()
        faulty, said = self.render("hall.toml", "--camera", "o.eye", "--size", "48x48")
        self.says(said, "back to back")
        self.hall(sound=True)
        sound, said = self.render("hall.toml", "--camera", "o.eye", "--size", "48x48")
        self.assertNotIn("back to back", said)
        self.assertAlmostEqual(sum(faulty["G"]) / sum(sound["G"]), 1.0, delta=0.01)

    def grille(self, more):
        self.put(models.grille())
        self.write("grille.toml", OBJECT.format("grille.gltf") + more)

    def test_light_comes_through_the_holes_of_a_mask(self):
        # The Sun over a grating with holes over half its area: half of the floor is lit. 2 m have
        # 20 squares per side. The floor therefore sends half of the light that it would send
        # without the grating, plus light that the grating reflects down to it.
        self.grille("[sun]\ndirection = [0, 0, 1]\nilluminance = 1000\nangular_radius_deg = 0\n" +
                    self.camera("floor", "[0, 0, 0.9]", "[0, 0, 0]", up="[0, 1, 0]", fov=90, size=64) +
                    self.camera("above", "[0, 0, 9]", "[0, 0, 0]", up="[0, 1, 0]", fov=10, size=64))
        solved = self.json("solve", "grille.toml", "-o", "grille.h5")
        sun, = (g for g in solved["groups"] if g["name"] == "sun")
        self.assertAlmostEqual(sun["landed_lm"][1] / 1000 / 4, 1.0, delta=0.02)  # 4 m2, on the
                                                                                 # floor or the
                                                                                 # grating
        self.assertLess(sun["imbalance"], 1e-6)
        floor = self.render("grille.toml", "--camera", "floor", "--indirect", "none", "--no-error")[0]
        lit = sum(1 for value in floor["G"] if value > 80) / len(floor["G"])
        self.assertAlmostEqual(lit, 0.5, delta=0.02)
        # The screen beside it adds 1 %.
        self.assertAlmostEqual(max(floor["G"]), 0.5 * 1000 / math.pi, delta=2.5)
        seen = self.render("grille.toml", "--camera", "above", "--aov", "object,albedo", "--no-error", "--solution",
                           "grille.h5")[0]
        self.assertTrue(any(abs(a - 0.5) < 1e-6 for a in seen["albedo.G"]))
        self.assertTrue(any(abs(a - srgb(180)) < 1e-3 for a in seen["albedo.G"]))
        paths = self.render("grille.toml", "--camera", "above", "--indirect", "paths", "--set",
                            "quality.gather_rays=64", "--no-error")[0]
        self.assertAlmostEqual(sum(seen["G"]) / sum(paths["G"]), 1.0, delta=0.01)

    def test_a_screen_shines_from_its_light_squares(self):
        self.grille(self.camera("screen", "[-2, 0, 1.5]", "[2, 0, 1.5]", fov=13, size=32))
        solved = self.json("solve", "grille.toml")
        screen, = (g for g in solved["groups"] if g["name"] == "screen")
        # 1 m2, half of it with pi 100 lm/m2.
        self.assertAlmostEqual(screen["given_lm"][1] / (50 * math.pi), 1.0, delta=0.005)
        seen = self.render("grille.toml", "--camera", "screen", "--no-error")[0]["G"]
        self.assertAlmostEqual(max(seen), 100.0, delta=0.01)
        # Bright at the upper left, as in the picture.
        self.assertAlmostEqual(seen[10 * 32 + 10], 100.0, delta=0.01)
        self.assertLess(seen[10 * 32 + 21], 1.0)
        self.assertAlmostEqual(seen[21 * 32 + 21], 100.0, delta=0.01)

    def test_memory_is_stated_and_another_picture_is_another_solution(self):
        self.hall()
        report = self.json("inspect", "hall.toml")
        texture, = next(m["textures"] for m in report["materials"] if m["name"] == "floor")
        self.assertEqual((texture["use"], texture["size"]), ("diffuse", [2, 2]))
        self.assertAlmostEqual(report["texture_mib"] * 2**20, 8 * 4)  # 8 bytes for each of 2 x 2
                                                                      # texels
        self.assertIn("textures", self.json("plan", "hall.toml")["memory"]["parts_mib"])
        self.put(models.crate())
        self.write("crate.toml", OBJECT.format("crate.obj") + "[sun]\ndirection = [-1, -2, 3]\n" +
                   self.camera("front", "[0.5, -2, 0.5]", "[0.5, 0.5, 0.5]"))
        self.done("solve", "crate.toml", "-o", "crate.h5")
        self.done("render", "crate.toml", "-o", "a.exr", "--solution", "crate.h5")
        self.write("crate side.png", model_kit.png(64, 64, lambda x, y: (20, 20, 230)))
        self.says(self.refused("render", "crate.toml", "-o", "a.exr", "--solution", "crate.h5"), "materials")

    def test_a_texture_that_is_not_there_is_named_and_the_colour_stays(self):
        files = models.crate()
        del files["crate side.png"]
        self.put(files)
        self.write("crate.toml", OBJECT.format("crate.obj"))
        report = self.json("inspect", "crate.toml")
        self.says(" ".join(report["warnings"]), "crate side.png", "a texture is left out")
        self.assertEqual(report["materials"][0]["diffuse"], [1.0, 1.0, 1.0])


if __name__ == "__main__":
    unittest.main()
