# SPDX-License-Identifier: Apache-2.0
"""solve --glb: files for other viewers."""
import unittest

import glb
import program


class Glb(program.Case):
    def setUp(self):
        super().setUp()
        self.write("ball.toml", program.BALL)

    def test_structure(self):
        self.done("solve", "ball.toml", "--glb", "ball.glb")
        scene = glb.read((self.folder / "ball.glb").read_bytes())
        root, *nodes = scene.json["nodes"]
        self.assertEqual((root["name"], root["children"]), ("ball on a floor", [1, 2]))
        self.assertEqual([node["name"] for node in nodes], ["floor", "ball"])
        self.assertEqual(scene.json["extensionsUsed"], ["KHR_materials_unlit"])
        self.assertIn("KHR_materials_unlit", scene.json["materials"][0]["extensions"])
        for node in nodes:
            primitive, = scene.json["meshes"][node["mesh"]]["primitives"]
            place = scene.values(primitive["attributes"]["POSITION"], bounds=True)
            colour = scene.values(primitive["attributes"]["COLOR_0"])
            self.assertEqual(len(place), len(colour))
            indices = [index for index, in scene.values(primitive["indices"])]
            self.assertEqual(len(indices) % 3, 0)
            self.assertLess(max(indices), len(place))
            self.assertTrue(all(0 <= c <= 1 for vertex in colour for c in vertex))

    def test_colours_times_the_scale_are_the_radiosity(self):
        # The closed box has 20 lm/m2 everywhere and is therefore middle grey.
        self.write("box.toml", program.CLOSED_BOX)
        self.done("solve", "box.toml", "--glb", "box.glb")
        scene = glb.read((self.folder / "box.glb").read_bytes())
        extras = scene.json["nodes"][0]["extras"]
        self.assertAlmostEqual(0.18 * extras["radiosity_lm_m2_per_unit"], 20, places=5)
        self.assertEqual(extras["clipped_area_share"], 0)
        attributes = scene.json["meshes"][0]["primitives"][0]["attributes"]
        for vertex in scene.values(attributes["COLOR_0"]):
            for channel in vertex:
                self.assertAlmostEqual(channel, 0.18, places=6)

    def test_a_scene_may_use_it_as_a_mesh(self):
        self.done("solve", "ball.toml", "--glb", "ball.glb", "-o", "ball.h5")
        self.write("again.toml", 'format = 1\nname = "again"\n[[material]]\nname = "white"\ndiffuse = 1\n' + "".join(
            f'[[object]]\nname = "{part}"\nmesh = "ball.glb"\npart = "{part}"\nmaterial = "white"\n'
            for part in ("floor", "ball")))
        first, second = self.json("inspect", "ball.toml"), self.json("inspect", "again.toml")
        self.assertAlmostEqual(second["area_m2"] / first["area_m2"], 1, places=5)
        for before, after in zip(first["objects"], second["objects"]):
            self.assertEqual(before["name"], after["name"])
            self.assertAlmostEqual(after["area_m2"] / before["area_m2"], 1, places=5)
        for end in ("min_m", "max_m"):
            for before, after in zip(first["bounding_box"][end], second["bounding_box"][end]):
                self.assertAlmostEqual(before, after, places=5)

    def test_from_a_stored_solution(self):
        self.done("solve", "ball.toml", "--glb", "a.glb", "-o", "ball.h5")
        self.done("solve", "ball.toml", "--glb", "b.glb", "--solution", "ball.h5")
        self.assertEqual((self.folder / "a.glb").read_bytes(), (self.folder / "b.glb").read_bytes())

    def test_no_light_is_black(self):
        self.write("box.toml", program.CLOSED_BOX.replace("emit = 10.0", "emit = 0.0"))
        self.done("solve", "box.toml", "--glb", "box.glb", "-o", "box.h5")
        scene = glb.read((self.folder / "box.glb").read_bytes())
        self.assertEqual(scene.json["nodes"][0]["extras"]["radiosity_lm_m2_per_unit"], 0)
        self.done("render", "box.toml", "-o", "box.exr", "--solution", "box.h5")


if __name__ == "__main__":
    unittest.main()
