# SPDX-License-Identifier: Apache-2.0
"""Meshes with faults of exporters: the picture is the one of the sound mesh, and the fault is
named."""
import json
import sys
import unittest

import program

sys.path[:0] = [str(program.TOP / "tests" / "validation"), str(program.TOP / "tests" / "support")]
import error_truth  # noqa: E402
import model_kit  # noqa: E402

CORNERS = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
CUBE = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
SQUARE = [(0, 1, 3, 2)]
SCENE = """format = 1
[[material]]
name = "white"
diffuse = 0.5
{sheet}
[[object]]
name = "thing"
mesh = "thing.obj"
material = "white"
{more}
[[object]]
name = "floor"
shape = "quad"
corners = [[-2, -2, -0.5], [3, -2, -0.5], [3, 3, -0.5], [-2, 3, -0.5]]
material = "white"
{on_floor}
[[light]]
name = "lamp"
type = "point"
position = [-0.4, 0.3, 2.0]
flux = 1000.0
[[camera]]
name = "A"
position = [-1.5, -2, 2]
look_at = [0.5, 0.5, 0]
resolution = [16, 12]
"""


def turned(faces):
    return [face[::-1] for face in faces]


class MeshFaults(program.Case):
    def picture(self, faces, sheet="", more="", on_floor=""):
        """(luminances, standard error)."""
        self.write("thing.obj", "".join(f"v {x} {y} {z}\n" for x, y, z in CORNERS) +
                   "".join("f " + " ".join(str(k + 1) for k in face) + "\n" for face in faces))
        self.write("scene.toml", SCENE.format(sheet=sheet, more=more, on_floor=on_floor))
        run = self.run_program("render", "scene.toml", "-o", "out.exr", "--set", "quality.gather_rays=16")
        self.assertEqual(run.returncode, 0, run.stderr)
        return error_truth.picture(self.folder / "out.exr")[0], run.stderr

    def test_a_sheet_with_both_windings_is_a_two_sided_sheet(self):
        right, _ = self.picture(SQUARE, sheet="two_sided = true")
        for back in (turned(SQUARE), [turned(SQUARE)[0][1:] + turned(SQUARE)[0][:1]]):
            found, said = self.picture(SQUARE + back)
            self.says(said, '"thing"', "back to back")
            # The floor then has another material, but in pixels the values are equal.
            self.assertLess(max(abs(a - b) for a, b in zip(found, right)), 0.02 * max(right))
            self.assertGreater(sum(found), 0.0)

    def test_faces_that_stand_twice_give_the_same_bytes(self):
        right, _ = self.picture(CUBE)
        found, said = self.picture(CUBE + CUBE[:2])
        self.says(said, "2 faces stood twice")
        self.assertEqual(found, right)

    def test_a_lamp_lands_what_it_gives(self):
        """A lamp's landed and escaped light add up to its flux, also with duplicate faces."""
        self.picture(CUBE + CUBE[:3])
        for group in self.json("solve", "scene.toml")["groups"]:
            given, landed, escaped = (group[key][1] for key in ("given_lm", "landed_lm", "escaped_at_once_lm"))
            self.assertAlmostEqual((landed + escaped) / given, 1.0, places=6)

    def test_a_body_inside_out_is_seen_from_outside(self):
        right, _ = self.picture(CUBE)
        found, said = self.picture(turned(CUBE))
        self.says(said, "inside out", 'orient = "as-is"')
        self.assertLess(abs(sum(found) / sum(right) - 1.0), 0.01)
        black, said = self.picture(turned(CUBE), more='orient = "as-is"')
        self.assertNotIn("inside out", said)
        self.assertLess(sum(black), 0.8 * sum(right))

    def test_a_paper_that_lies_on_the_floor_is_seen_whole(self):
        """A paper on a floor in one plane shows the paper, as it does a millimetre higher."""
        paper = ('[[material]]\nname = "dark"\ndiffuse = 0.1\n[[object]]\nname = "paper"\nshape = "quad"\nmaterial = "dark"\n'
                 'corners = [[-1.5, -1.5, {0}], [2, -1.5, {0}], [2, 2, {0}], [-1.5, 2, {0}]]\n')
        right, _ = self.picture(SQUARE, on_floor=paper.format(-0.499))
        found, said = self.picture(SQUARE, on_floor=paper.format(-0.5))
        self.says(said, '"floor" and "paper": 12.2 m2', "lie in one plane")
        wrong = sum(abs(a - b) for a, b in zip(found, right)) / sum(right)
        self.assertLess(wrong, 0.02)
        self.assertEqual(self.json("inspect", "scene.toml")["objects"][2]["surface"]["triangles_on_others"], 2)

    def test_inspect_shows_what_is_left(self):
        self.picture(CUBE[:5], more='orient = "as-is"')
        surface = self.json("inspect", "scene.toml")["objects"][0]["surface"]
        self.assertEqual(surface, {"parts": 1, "closed_parts": 0, "inward_parts": 0, "open_edges": 4,
                                   "non_manifold_edges": 0, "mixed_edges": 0, "triangles_on_others": 0})
        self.says(self.done("inspect", "scene.toml"), "open edges", "non-manifold", "wound apart")

    def test_what_a_material_library_says_in_vain_is_named(self):
        self.write("thing.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvt 0 0\nusemtl wood\nf 1 2 3\n")
        self.write("a.mtl", "newmtl wood\nKd 0.5 0.5 0.5\nKa 1 1 1\nPr 0.5\nillum 2\nmap_Kd wood.png\n"
                            "newmtl glass\nd 1.0\nTr 0.0\nTf 1 1 1\nmap_Ka wood.png\nbump wood.png\n")
        self.write("scene.toml", SCENE.format(sheet="", more="", on_floor="").replace('mesh = "thing.obj"\nmaterial = "white"',
                                                                         'mesh = "thing.obj"'))
        run = self.run_program("inspect", "scene.toml", "--json")
        self.assertEqual(run.returncode, 0, run.stderr)
        report = self.json("inspect", "scene.toml")
        self.says(" ".join(report["warnings"]), "a.mtl", '"bump" (1)', '"Pr" (1)',
                  "a texture is left out", "a.mtl:6:8", '"wood.png"', "No such file")
        for neutral in ("Tr", "Tf", "map_Ka"):
            self.assertNotIn(neutral, " ".join(report["warnings"]))
        self.assertEqual(report["objects"][0]["unused"], "1 Pr, 1 bump, 1 vn, 1 vt; round_deg rounds the surface by the normals")

    def read(self, ending, data):
        """inspect's messages on a mesh: its refusal, or its warnings and the list of unused
        features."""
        self.write("thing." + ending, data)
        self.write("scene.toml", SCENE.format(sheet="", more="", on_floor="").replace("thing.obj", "thing." + ending))
        run = self.run_program("inspect", "scene.toml", "--json")
        if run.returncode != 0:
            self.assertEqual(run.returncode, 2, run.stderr)
            return run.stderr
        report = json.loads(run.stdout)
        return " ".join(report["warnings"] + [report["objects"][0]["unused"]])

    def test_a_file_that_is_cut_off_or_goes_on_is_not_read_as_whole(self):
        facet = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
        self.says(self.read("stl", "solid a\n" + facet), "thing.stl:8", "endsolid", "cut off")
        self.assertEqual(self.read("stl", "solid a\n" + facet + "endsolid a\n"), "")
        head = ("ply\nformat ascii {}\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                "element face 1\nproperty list uchar int vertex_index\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
        self.says(self.read("ply", head.format("1.0") + "3 0 2 1\n"), "thing.ply:14", "1 of \"face\"")
        self.says(self.read("ply", head.format("2.0")), "thing.ply:2", "1.0")
        self.assertEqual(self.read("ply", head.format("1.0")), "")

    def test_values_that_gltf_does_not_have_are_refused_or_named(self):
        def glb(**more):
            model = model_kit.Model(cameras=[{"type": "perspective", "perspective": {"yfov": 4, "znear": 1}}])
            node = more.pop("node", {})
            model.mesh("thing", [(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)], model.material(**more), **node)
            return model.glb()
        self.says(self.read("glb", glb(emissiveFactor=[5, 0, 0])), "materials[0].emissiveFactor[0] is 5", "yfov is 4")
        self.assertNotIn("orthographic", self.read("glb", glb()))
        for place, more in (("materials[0].pbrMetallicRoughness.baseColorFactor is a list of 3",
                             {"pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0]}}),
                            ("materials[0].alphaMode is \"Blend\"", {"alphaMode": "Blend"}),
                            ("nodes[0].extensions.KHR_lights_punctual.light is \"0\"",
                             {"node": {"extensions": {"KHR_lights_punctual": {"light": "0"}}}}),
                            ("projection", {"node": {"matrix": [1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}})):
            self.says(self.read("glb", glb(**more)), "thing.glb", place)


if __name__ == "__main__":
    unittest.main()
