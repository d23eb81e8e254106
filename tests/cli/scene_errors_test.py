# SPDX-License-Identifier: Apache-2.0
"""Broken scenes: the error has the position, the value found and the allowed values; exit code 2.
"""
import os
import unittest

import program

BOX = program.CLOSED_BOX
TRIANGLE = """[[object]]
name = "part"
mesh = "part.obj"
material = "wall"
"""


class BrokenScenes(program.Case):
    def broken(self, text, *parts, more=()):
        self.write("scene.toml", text)
        message = self.refused("inspect", "scene.toml", *more)
        self.says(message, "scene.toml", *parts)
        return message

    def replaced(self, old, new, *parts):
        self.assertIn(old, BOX)
        line = BOX[:BOX.index(old)].count("\n") + 1 + new.split("\n").index(new.split("\n")[-1])
        return self.broken(BOX.replace(old, new, 1), f"scene.toml:{line}:", *parts)

    def test_missing_scene(self):
        self.says(self.refused("render", "none.toml", "-o", "a.exr"), "none.toml")
        self.says(self.refused("inspect", self.folder), str(self.folder))

    def test_syntax(self):
        self.replaced("diffuse = 0.5", "diffuse = = 0.5")
        self.broken("")
        self.broken("format = 2\n", "format")
        self.write("scene.toml", b"\xff\xfe\x00\x01")
        self.refused("inspect", "scene.toml")
        self.broken("format = 1.0\n", "1.0", "the whole number 1")
        self.broken("format = 1e300\n", "the number 1e+300")

    def test_files_of_another_kind(self):
        self.broken('format = 1\nscene = "bay.toml"\n', "scene.toml:2:1: ", "a study file", "earthshine study run")
        self.write("a.exr", b"\x76\x2f\x31\x01" + bytes(2 << 20))
        self.says(self.refused("render", "a.exr", "-o", "b.exr"), "a.exr: is an OpenEXR picture", "a TOML file is wanted")

    def test_unknown_key_names_the_nearest(self):
        self.replaced("diffuse = 0.5", "difuse = 0.5", '"difuse"', '"diffuse"')
        self.replaced("patch_edge = 0.5", "patch_edgs = 0.5", "patch_edgs", "patch_edge")
        self.replaced("[quality]", "[qualty]", "qualty", "quality")

    def test_wrong_type(self):
        self.replaced("diffuse = 0.5", 'diffuse = "white"', "diffuse")
        self.replaced("max = [2, 2, 2]", "max = [2, 2]", "max")
        self.replaced('name = "room"', "name = 7", "name")

    def test_out_of_range(self):
        self.replaced("diffuse = 0.5", "diffuse = 1.5", "diffuse", "1.5")
        self.replaced("diffuse = 0.5", "diffuse = -0.1", "diffuse")
        self.replaced("fov_deg = 60", "fov_deg = 180", "fov_deg")
        self.replaced("resolution = [24, 16]", "resolution = [0, 16]", "resolution")
        self.replaced("form_factor_rays = 64", "form_factor_rays = 0", "form_factor_rays")

    def test_not_finite(self):
        self.replaced("diffuse = 0.5", "diffuse = nan", "diffuse")
        self.replaced("emit = 10.0", "emit = inf", "emit")
        self.replaced("min = [0, 0, 0]", "min = [0, nan, 0]", "min")

    def test_energy(self):
        self.broken(BOX.replace("diffuse = 0.5", "diffuse = 0.8\nspecular = 0.9\nshininess = 2"), "wall", "1.25")

    def test_undefined_material(self):
        self.replaced('material = "wall"', 'material = "walls"', '"walls"', '"wall"')

    def test_missing_mesh(self):
        self.broken(BOX + TRIANGLE, "part.obj")

    def test_broken_meshes(self):
        for obj in ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n",
                    "v 0 0 0\nv 1 0\nv 0 1 0\nf 1 2 3\n", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2\n"):
            self.write("part.obj", obj)
            self.write("scene.toml", BOX + TRIANGLE)
            self.says(self.refused("inspect", "scene.toml"), "part.obj:")

    def test_text_called_gltf(self):
        for name in ("part.glb", "part.gltf"):
            self.write(name, "solid part\n")
            self.write("scene.toml", BOX + TRIANGLE.replace("part.obj", name))
            message = self.refused("inspect", "scene.toml")
            self.says(message, name, "no JSON at line 1, column 1", "begins with the letters glTF")
            self.assertNotIn("exception", message)

    def test_broken_luminaires(self):
        lines = program.EVEN_IES.split("\n")
        for ies, place in ((program.EVEN_IES[:-8], "even.ies:8"), (program.EVEN_IES.replace("100 100", "100 nan"), "even.ies:8:5"),
                           (program.EVEN_IES.replace("0 45 90", "0 45 30"), "even.ies:6:6"),
                           ("\n".join(lines[:3]), "even.ies:3"), ("", "even.ies")):
            self.write("even.ies", ies)
            self.write("scene.toml", BOX + program.IES_LAMP)
            self.says(self.refused("inspect", "scene.toml"), place)
        (self.folder / "even.ies").unlink()
        self.broken(BOX + program.IES_LAMP, "even.ies", "No such file")
        os.mkfifo(self.folder / "even.ies")
        self.broken(BOX + program.IES_LAMP, "even.ies", "a pipe or a device")

    def test_degenerate_triangles_are_counted_not_refused(self):
        self.write("part.obj", "v 0.5 0.5 0.5\nv 1 0.5 0.5\nv 0.5 1 0.5\nv 1.5 0.5 0.5\nf 1 2 3\nf 1 2 4\nf 1 1 2\n")
        self.write("scene.toml", BOX + TRIANGLE)
        run = self.run_program("inspect", "scene.toml", "--json")
        self.assertEqual(run.returncode, 0, run.stderr)
        report = self.json("inspect", "scene.toml")
        part = [o for o in report["objects"] if o["name"] == "part"][0]
        self.assertEqual((part["degenerate"], part["triangles"]), (2, 1))
        self.assertAlmostEqual(part["area_m2"], 0.125)
        self.assertTrue(any("2" in warning and "part" in warning for warning in report["warnings"]))
        self.assertIn("warning", self.run_program("solve", "scene.toml").stderr)

    def test_duplicate_names(self):
        self.broken(BOX + BOX[BOX.index("[[object]]"):BOX.index("[[camera]]")], "room")
        self.broken(BOX + BOX[BOX.index("[[material]]"):BOX.index("[[object]]")], "wall")

    def test_light_beyond_the_numbers_of_a_picture(self):
        self.replaced("emit = 10.0", "emit = 1e200", "emit", "1e+15")
        self.write("scene.toml", program.BALL)
        for setting in ("light.lamp.intensity=1e308", "sun.illuminance=1e40"):
            self.says(self.refused("solve", "scene.toml", "--set", setting), "1e+15")

    def test_light_whose_squares_are_no_numbers(self):
        self.write("scene.toml", BOX)
        for emit, warned in (("1e-15", True), ("1e-9", False)):
            run = self.run_program("plan", "scene.toml", "--set", f"material.wall.emit={emit}")
            self.assertEqual("are the units right?" in run.stderr, warned, run.stderr)

    def test_names_that_no_picture_can_hold(self):
        self.write("scene.toml", program.BALL)
        for key in ("light.lamp.group", "light.lamp.name", "material.paint.light", "object.ball.name"):
            self.says(self.refused("inspect", "scene.toml", "--set", f"{key}={'x' * 201}"), "201 bytes", "200")
        self.done("render", "scene.toml", "-o", "a.exr", "--per-light", "--set", "light.lamp.group=" + "x" * 200)

    def test_overrides_are_checked_like_the_file(self):
        self.write("scene.toml", BOX)
        self.says(self.refused("inspect", "scene.toml", "--set", "quality.gather_ray=4"), "gather_ray")
        self.says(self.refused("inspect", "scene.toml", "--set", "camera.outside.fov_deg=4"), "outside")
        self.says(self.refused("inspect", "scene.toml", "--set", "camera.inside.fov_deg=999"), "fov_deg")


if __name__ == "__main__":
    unittest.main()
