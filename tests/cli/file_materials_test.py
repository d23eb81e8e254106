# SPDX-License-Identifier: Apache-2.0
"""Materials, lamps and cameras of mesh files, from the file to the picture."""
import math
import sys
import unittest

import exr
import program

sys.path[:0] = [str(program.TOP / "tests" / "validation"), str(program.TOP / "tests" / "support")]
import material_maps  # noqa: E402
import model_kit  # noqa: E402

FLOOR = [(-50, -50, 0), (50, -50, 0), (50, 50, 0), (-50, 50, 0)]
SQUARE = [(0, 1, 2), (0, 2, 3)]


class Maps(program.Case):
    def test_a_highlight_is_as_bright_as_its_model_has_it_where_it_is_brightest(self):
        for name, here, own in material_maps.rows(program.PROGRAM):
            # A weak highlight of a dielectric may be missing: at most 0.04 of the reflected light.
            # The roughest metals reflect the right amount of light, but uniformly instead of
            # brighter to the sides.
            if "metallic 1, base 0.9, roughness 1" in name:
                self.assertAlmostEqual(here[0], 0.9 * (2 * (1 - math.log(2))) ** 2, delta=1e-3)
                continue
            self.assertAlmostEqual(here[0] / own[0], 1.0, delta=0.03, msg=name)
            if name.startswith("MTL"):
                continue
            lost = max(abs(a - b) for a, b in zip(here, own))
            self.assertLess(lost, 0.16 * own[0] + 0.08, name)


class FileLamps(program.Case):
    def model(self):
        model = model_kit.Model(extensionsUsed=["KHR_lights_punctual"], extensions={"KHR_lights_punctual": {
            "lights": [{"type": "point", "intensity": 80, "color": [1, 1, 0.5]},
                       {"type": "spot", "intensity": 500, "spot": {"innerConeAngle": 0.3, "outerConeAngle": 0.6}}]}},
            cameras=[{"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.1, "aspectRatio": 1}}])
        white = model.material(name="white", pbrMetallicRoughness={"baseColorFactor": [0.5, 0.5, 0.5, 1],
                                                                   "metallicFactor": 0})
        model.mesh("floor", FLOOR, SQUARE, white)
        model.node(name="bulb", translation=[0, 0, 2], extensions={"KHR_lights_punctual": {"light": 0}})
        model.node(name="torch", translation=[20, 0, 3], extensions={"KHR_lights_punctual": {"light": 1}})
        model.node(name="eye", camera=0, translation=[0, 0, 5])
        return model.glb()

    def test_lamps_of_the_file_light_its_faces_and_its_camera_sees_them(self):
        self.write("a.glb", self.model())
        scene = 'format = 1\n[[object]]\nname = "room"\nmesh = "a.glb"\n'
        self.write("a.toml", scene + "lights = true\ncameras = true\n")
        report = self.json("inspect", "a.toml")
        self.assertEqual([lamp["name"] for lamp in report["lamps"]], ["room.bulb", "room.torch"])
        self.assertEqual([camera["name"] for camera in report["cameras"]], ["room.eye"])
        self.assertEqual(report["objects"][0]["unused"], "")
        self.assertAlmostEqual(report["lamps"][0]["flux_lm"][0], 4 * math.pi * 80)
        self.done("render", "a.toml", "-o", "a.exr", "--size", "33x33")
        green = exr.read(self.folder / "a.exr")[3]["G"]
        # Below the bulb: L = rho E / pi, E = I / h^2. The torch, 20 m away, shines elsewhere.
        self.assertAlmostEqual(green[16 * 33 + 16], 0.5 * 80 / 4 / math.pi, delta=0.01)
        self.write("a.toml", scene)
        self.assertEqual(self.json("inspect", "a.toml")["lamps"], [])

    def test_what_gives_more_light_than_it_gets_is_said(self):
        self.write("a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl bright\nf 1 2 3\n")
        self.write("a.mtl", "newmtl bright\nKd 1 1 1\nKs 1 1 1\nNs 10\n")
        self.write("a.toml", 'format = 1\n[[object]]\nname = "o"\nmesh = "a.obj"\n')
        report = self.json("inspect", "a.toml")
        self.says(" ".join(report["warnings"]), '"bright"', "1.167")
        self.assertAlmostEqual(report["materials"][0]["reflected_share"][0], 1.0)


if __name__ == "__main__":
    unittest.main()
