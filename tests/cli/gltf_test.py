# SPDX-License-Identifier: Apache-2.0
"""Features of glTF files beyond plain triangles: features that change the picture are used or
named."""
import json
import math
import sys
import unittest

import exr
import program

sys.path.insert(0, str(program.TOP / "tests" / "support"))
import model_kit  # noqa: E402

SQUARE = [(-0.5, -0.5, 0), (0.5, -0.5, 0), (0.5, 0.5, 0), (-0.5, 0.5, 0)]
FACES = [(0, 1, 2), (0, 2, 3)]
GREY = {"name": "g", "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.5, 0.5, 1], "metallicFactor": 0}}
SCENE = """format = 1
[[object]]
name = "o"
mesh = "m.glb"
axes = "as-is"
"""
SUN = """[sun]
direction = [0, 0, 1]
illuminance = 1000
angular_radius_deg = 0
"""
CAMERA = """[[camera]]
name = "c"
position = [0, 0, 5]
look_at = [0, 0, 0]
up = [0, 1, 0]
fov_deg = 10
resolution = [16, 16]
"""


def square(material=None, **node):
    """A model of one square metre in z = 0 that faces +z, and its primitive."""
    model = model_kit.Model()
    model.material(**(material or GREY))
    model.mesh("square", SQUARE, FACES, 0, **node)
    return model, model.json["meshes"][0]["primitives"][0]


class Gltf(program.Case):
    def put(self, model, scene=SCENE + SUN):
        self.write("m.glb", model.glb())
        self.write("s.toml", scene)

    def inspected(self, model, scene=SCENE + SUN):
        self.put(model, scene)
        return self.json("inspect", "s.toml")

    def object_of(self, model, scene=SCENE + SUN):
        return self.inspected(model, scene)["objects"][0]

    def factors(self, model, scene=SCENE + SUN + CAMERA, channel="G"):
        """pi L / E of each pixel, row by row."""
        self.put(model, scene)
        run = self.run_program("render", "s.toml", "-o", "out.exr", "--no-error", "--quiet")
        self.assertEqual(run.returncode, 0, run.stderr)
        return [math.pi * v / 1000 for v in exr.read(self.folder / "out.exr")[3][channel]]

    def test_a_constant_colour_of_vertices_multiplies_the_base_colour(self):
        # glTF 2.0, 3.9.2: 0.5 times 0.2 is 0.1. The same for bytes, which are always normalised.
        for rows, letter, normalized in [([(0.2, 0.2, 0.2, 1)] * 4, "f", False), ([(0.2, 0.2, 0.2)] * 4, "f", False),
                                         ([(51, 51, 51, 255)] * 4, "B", True), ([(13107,) * 3] * 4, "H", True)]:
            model, primitive = square()
            primitive["attributes"]["COLOR_0"] = model.accessor(rows, letter, normalized)
            report = self.inspected(model)
            self.assertAlmostEqual(report["materials"][0]["diffuse"][0], 0.1, places=6)
            self.assertEqual(report["warnings"], [])
            self.assertEqual(report["objects"][0]["unused"], "")
            for factor in self.factors(model):
                self.assertAlmostEqual(factor, 0.1, delta=1e-4)

    def test_a_colour_that_varies_over_a_triangle_shows_and_has_its_mean(self):
        # From 0 at x = -0.5 to 1 at 0.5: the mean over the square is 0.5, and 0.5 times this is
        # 0.25.
        model, primitive = square()
        primitive["attributes"]["COLOR_0"] = model.accessor([(x + 0.5,) * 3 for x, _, _ in SQUARE])
        self.assertAlmostEqual(self.inspected(model)["materials"][0]["diffuse"][0], 0.25, places=6)
        factors = self.factors(model)
        width = 2 * 5 * math.tan(math.radians(5))
        for column in range(2, 14):
            x = ((column + 0.5) / 16 - 0.5) * width
            self.assertAlmostEqual(factors[8 * 16 + column], 0.5 * (x + 0.5), delta=0.01)

    def test_colours_of_metal_reach_what_it_reflects(self):
        metal = {"name": "steel", "pbrMetallicRoughness": {"roughnessFactor": 0}}
        model, primitive = square(metal)
        primitive["attributes"]["COLOR_0"] = model.accessor([(0.8, 0.4, 0.2)] * 4)
        material = self.inspected(model)["materials"][0]
        for c, share in enumerate((0.8, 0.4, 0.2)):
            self.assertAlmostEqual(material["mirror"][c], share, places=6)

    def test_the_scene_s_material_of_a_name_stands_for_its_colours_too(self):
        model, primitive = square()
        primitive["attributes"]["COLOR_0"] = model.accessor([(0.2, 0.2, 0.2)] * 4)
        report = self.inspected(model, SCENE + SUN + '[[material]]\nname = "g"\ndiffuse = 0.9\n')
        self.assertEqual([m["name"] for m in report["materials"]], ["g"])

    def test_default_morph_weights_move_the_vertices(self):
        # Twice as wide by the mesh's weights; by the node's 0.5 it is 1.5 x 1.5.
        for node, area in [({}, 4.0), ({"weights": [0.5]}, 2.25)]:
            model, primitive = square(**node)
            primitive["targets"] = [{"POSITION": model.accessor(SQUARE)}]
            model.json["meshes"][0]["weights"] = [1.0]
            self.assertAlmostEqual(self.object_of(model)["area_m2"], area, places=5)

    def test_skins_pose_their_vertices_wherever_their_node_is(self):
        model, primitive = square(translation=[100, 0, 0], skin=0)
        primitive["attributes"] |= {"JOINTS_0": model.accessor([(0, 0, 0, 0)] * 4, "B"),
                                    "WEIGHTS_0": model.accessor([(255, 0, 0, 0)] * 4, "B", True)}
        joint = model.node(scale=[2, 2, 2], name="joint")
        model.json["skins"] = [{"joints": [joint]}]
        report = self.inspected(model)
        self.assertAlmostEqual(report["objects"][0]["area_m2"], 4.0, places=5)
        # Half of the weight is on a joint 2 m above, shifted back by its inverse bind matrix: 1 m
        # up.
        lifted, primitive = square(skin=0)
        identity = [1.0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
        primitive["attributes"] |= {"JOINTS_0": lifted.accessor([(0, 1, 0, 0)] * 4, "B"),
                                    "WEIGHTS_0": lifted.accessor([(0.5, 0.5, 0, 0)] * 4)}
        joints = [lifted.node(name="low"), lifted.node(name="high", translation=[0, 0, 3])]
        inverse = lifted.accessor([tuple(identity), tuple(identity[:14] + [-1.0, 1.0])])
        lifted.json["skins"] = [{"joints": joints, "inverseBindMatrices": inverse}]
        factors = self.factors(lifted, SCENE + SUN + CAMERA.replace("fov_deg = 10", "fov_deg = 30"))
        # 1 m wide at 4 of 5 m: of 16 pixels over 2 x 4 tan 15 deg it fills 7.46 per side.
        lit = sum(1 for f in factors if f > 0.25)
        self.assertAlmostEqual(math.sqrt(lit), 16 / (8 * math.tan(math.radians(15))), delta=1.0)

    def test_instances_of_a_node_are_all_there(self):
        model, _ = square(extensions={"EXT_mesh_gpu_instancing": {"attributes": {}}})
        table = model.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]
        table["TRANSLATION"] = model.accessor([(0, 0, 0), (2, 0, 0), (4, 0, 0)])
        model.json["extensionsUsed"] = ["EXT_mesh_gpu_instancing"]
        self.assertAlmostEqual(self.object_of(model)["area_m2"], 3.0, places=5)
        table["SCALE"] = model.accessor([(1, 1, 1), (2, 2, 2), (3, 3, 3)])
        table["ROTATION"] = model.accessor([(0, 0, 0, 1.0)] * 3)
        self.assertAlmostEqual(self.object_of(model)["area_m2"], 14.0, places=5)
        table["SCALE"] = model.accessor([(1, 1, 1)] * 2)
        self.put(model)
        run = self.run_program("inspect", "s.toml")
        self.assertEqual(run.returncode, 2)
        self.says(run.stderr, "EXT_mesh_gpu_instancing", "2 and 3 values")

    def test_directional_lights_are_distant_lamps(self):
        # 500 lx along -z, by the node, at any position.
        model, _ = square()
        model.node(name="L", translation=[0, 0, 2], extensions={"KHR_lights_punctual": {"light": 0}})
        model.json |= {"extensionsUsed": ["KHR_lights_punctual"], "extensions": {
            "KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": 500}]}}}
        scene = SCENE + "lights = true\n" + CAMERA
        report = self.inspected(model, scene)
        self.assertEqual(report["lamps"][0]["type"], "distant")
        self.assertEqual(report["lamps"][0]["illuminance_lx"], [500, 500, 500])
        for factor in self.factors(model, scene):
            self.assertAlmostEqual(factor, 0.5 * 0.5, delta=1e-4)

    def test_distant_lamps_of_a_scene_shine_as_a_point_sun_does(self):
        model, _ = square()
        lamp = '[[light]]\nname = "far"\ntype = "distant"\ndirection = [0, 3, 4]\nilluminance = 1000\n'
        sun = '[sun]\ndirection = [0, 3, 4]\nilluminance = 1000\nangular_radius_deg = 0\n'
        by_lamp = self.factors(model, SCENE + CAMERA + lamp)
        self.assertAlmostEqual(by_lamp[0], 0.8 * 0.5, delta=1e-4)
        for a, b in zip(by_lamp, self.factors(model, SCENE + CAMERA + sun)):
            self.assertAlmostEqual(a, b, delta=1e-5)

    def test_a_primitive_without_material_has_the_format_s_default(self):
        model, primitive = square()
        del primitive["material"]
        report = self.inspected(model)
        self.assertEqual(report["materials"][0]["name"], "glTF default")
        # Metallic 1, roughness 1: albedo of GGX for uniform light, (2 (1 - ln 2))^2.
        self.assertAlmostEqual(report["materials"][0]["diffuse"][0], (2 * (1 - math.log(2))) ** 2, delta=1e-3)

    def test_lengths_are_metres_whatever_the_scene_s_unit(self):
        for unit, metres in [("m", 1), ("mm", 1e-3), ("in", 0.0254)]:
            scene = SCENE.replace("format = 1", f'format = 1\nunit = "{unit}"')
            self.assertAlmostEqual(self.object_of(square()[0], scene)["area_m2"], 1.0, places=6)
            # translate and scale are from the scene.
            half = scene + f"scale = 0.5\ntranslate = [0, 0, {1 / metres}]\n"
            self.assertAlmostEqual(self.object_of(square()[0], half)["area_m2"], 0.25, places=6)

    def test_axes_stand_a_file_upright_or_leave_it(self):
        # In its file the square faces +z; with y up turned to z up it faces -y.
        up = SCENE.replace("as-is", "y-up")
        lit = '[sun]\ndirection = [0, -1, 0]\nilluminance = 1000\nangular_radius_deg = 0\n'
        camera = CAMERA.replace("[0, 0, 5]", "[0, -5, 0]").replace("[0, 1, 0]", "[0, 0, 1]")
        for factor in self.factors(square()[0], up + lit + camera):
            self.assertAlmostEqual(factor, 0.5, delta=1e-4)
        self.assertEqual(self.inspected(square()[0], up)["warnings"], [])
        silent = self.inspected(square()[0], SCENE.replace('axes = "as-is"\n', ""))
        self.says(" ".join(silent["warnings"]), "m.glb", "+Y is up", 'axes = "y-up"')

    def test_axes_turn_other_formats_too(self):
        self.write("m.obj", "v 0 0 0\nv 1 0 0\nv 1 2 3\nusemtl w\nf 1 2 3\n")
        scene = 'format = 1\n[[material]]\nname = "w"\n[[object]]\nname = "o"\nmesh = "m.obj"\n'
        for keys, highest in [("", [1, 2, 3]), ('axes = "as-is"\n', [1, 2, 3]), ('axes = "y-up"\n', [1, 0, 2])]:
            self.write("s.toml", scene + keys)
            report = self.json("inspect", "s.toml")
            self.assertEqual(report["bounding_box"]["max_m"], highest)
            self.assertEqual(report["warnings"], [])

    def test_the_program_s_own_glb_comes_back_as_it_went_in(self):
        box = """format = 1
[[material]]
name = "w"
diffuse = 0.5
[[object]]
name = "o"
MESH
material = "w"
"""
        self.write("s.toml", box.replace("MESH", 'shape = "box"\nmin = [0, 0, 0]\nmax = [1, 2, 3]') + SUN)
        run = self.run_program("solve", "s.toml", "--glb", "out.glb")
        self.assertEqual(run.returncode, 0, run.stderr)
        camera = CAMERA.replace("[0, 0, 5]", "[0.5, 1, 20]").replace("[0, 0, 0]", "[0.5, 1, 0]")
        camera = camera.replace("fov_deg = 10", "fov_deg = 10.8")
        pictures = []
        for mesh in ('shape = "box"\nmin = [0, 0, 0]\nmax = [1, 2, 3]', 'mesh = "out.glb"'):
            for unit in ("", 'unit = "mm"\n') if "glb" in mesh else ("",):
                view = camera if not unit else camera.replace("[0.5, 1, 20]", "[500, 1000, 20000]").replace(
                    "[0.5, 1, 0]", "[500, 1000, 0]")
                self.write("back.toml", box.replace("MESH", mesh).replace("format = 1\n", "format = 1\n" + unit) + SUN +
                           view)
                report = self.json("inspect", "back.toml")
                self.assertEqual(report["warnings"], [])
                run = self.run_program("render", "back.toml", "-o", "out.exr", "--quiet", "--aov", "depth", "--no-error")
                self.assertEqual(run.returncode, 0, run.stderr)
                pictures.append(exr.read(self.folder / "out.exr")[3]["G"])
        for other in pictures[1:]:
            for a, b in zip(pictures[0], other):
                self.assertAlmostEqual(a, b, delta=1e-3 * max(pictures[0]))

    def test_emission_by_a_second_set_of_coordinates(self):
        # White at u = 0, black at u = 1; in the second set all corners are at the black end.
        picture = model_kit.png(2, 1, lambda x, y: (255 - 255 * x,) * 3)
        for second, emitted in [(0.25, math.pi), (0.75, 0.0)]:
            model, primitive = square(GREY | {"emissiveFactor": [1, 1, 1]})
            attributes = primitive["attributes"]
            attributes["TEXCOORD_0"] = model.accessor([(0.5, 0.5)] * 4)
            attributes["TEXCOORD_1"] = model.accessor([(second, 0.5)] * 4)
            texture = model.image(picture)
            model.json["materials"][0]["emissiveTexture"] = {"index": texture, "texCoord": 1}
            for base in (False, True):
                if base:
                    model.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {"index": texture}
                report = self.inspected(model)
                self.assertAlmostEqual(report["materials"][0]["emit_lm_m2"][0], emitted, delta=1e-3)
                self.assertEqual(report["warnings"], [])

    def test_textures_of_glossiness_and_transmission_count_by_their_means(self):
        # Glossiness 0.5 by alpha: roughness 0.5, no mirror. Specular 1 times sRGB 188 is 0.5 in
        # linear light.
        glossy = {"name": "s", "extensions": {"KHR_materials_pbrSpecularGlossiness": {
            "diffuseFactor": [0, 0, 0, 1], "specularGlossinessTexture": {"index": 0}}}}
        model, primitive = square(glossy)
        model.image(model_kit.png(1, 1, lambda x, y: (188, 188, 188, 128), 4))
        primitive["attributes"]["TEXCOORD_0"] = model.accessor([(0, 0)] * 4)
        report = self.inspected(model)
        self.assertEqual(report["materials"][0]["mirror"], [0, 0, 0])
        self.assertGreater(report["materials"][0]["specular"][0], 0.1)
        self.says(" ".join(report["warnings"]), "specular-glossiness maps, but for their means")
        # Half of the glass transmits light: red 128 of a linear texture.
        glass = {"name": "t", "doubleSided": True, "pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0},
                 "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1,
                                                               "transmissionTexture": {"index": 0}}}}
        model, primitive = square(glass)
        model.image(model_kit.png(1, 1, lambda x, y: (128, 0, 0)))
        primitive["attributes"]["TEXCOORD_0"] = model.accessor([(0, 0)] * 4)
        report = self.inspected(model)
        self.assertAlmostEqual(report["materials"][0]["transmit"][0], 128 / 255 * 0.96, delta=1e-3)

    def test_what_is_not_used_is_named_by_every_command(self):
        model, _ = square(GREY | {"extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 1},
                                                 "KHR_materials_sheen": {}},
                                  "normalTexture": {"index": 0}})
        model.json["extensionsUsed"] = ["KHR_materials_clearcoat", "KHR_materials_sheen", "EXT_lights_image_based"]
        model.image(model_kit.png(1, 1, lambda x, y: (128, 128, 255)))
        named = ("m.glb: not used, and the picture would change by it", "KHR_materials_clearcoat (1)",
                 "KHR_materials_sheen (1)", "normal maps (1)", "EXT_lights_image_based (1)")
        self.put(model, SCENE + SUN + CAMERA)
        for command in (["render", "s.toml", "-o", "out.exr"], ["solve", "s.toml"]):
            run = self.run_program(*command)
            self.assertEqual(run.returncode, 0, run.stderr)
            self.says(run.stderr, *named)
        # No warning for a material that the scene replaces.
        override = SCENE + 'material = "w"\n[[material]]\nname = "w"\ndiffuse = 0.5\n' + SUN
        self.assertNotIn("clearcoat", " ".join(self.inspected(model, override)["warnings"]))

    def test_draco_that_is_only_called_used_is_refused_with_the_command(self):
        model, primitive = square()
        primitive["extensions"] = {"KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {"POSITION": 0}}}
        del model.json["accessors"][0]["bufferView"]
        model.json["extensionsUsed"] = ["KHR_draco_mesh_compression"]
        self.put(model)
        run = self.run_program("inspect", "s.toml")
        self.assertEqual(run.returncode, 2)
        self.says(run.stderr, "KHR_draco_mesh_compression", "npx @gltf-transform/cli copy")
        # meshopt's plain form would be in a buffer that does not exist.
        model, _ = square()
        model.json["extensionsUsed"] = ["EXT_meshopt_compression"]
        data = model.glb()
        text = json.loads(data[20:20 + int.from_bytes(data[12:16], "little")])
        text["bufferViews"][0] |= {"extensions": {"EXT_meshopt_compression": {"buffer": 0}}}
        self.write("m.gltf", json.dumps(text))
        self.write("s.toml", SCENE.replace("m.glb", "m.gltf"))
        run = self.run_program("inspect", "s.toml")
        self.assertEqual(run.returncode, 2)
        self.says(run.stderr, "EXT_meshopt_compression", "npx @gltf-transform/cli copy")


if __name__ == "__main__":
    unittest.main()
