# SPDX-License-Identifier: Apache-2.0
"""new: a scene file that renders without changes; manual and completion: every command and option of the help."""
import re
import subprocess
import unittest

import exr
import program

# Two objects; the material of the second one is undefined.
OBJ = """mtllib two.mtl
o table
usemtl wood
v -1 -1 0
v 1 -1 0
v 1 1 0
v -1 1 0
f 1 2 3 4
o shade
usemtl paper
v 0 0 1
v 0.5 0 1
v 0 0.5 2
f 5 6 7
"""
MTL = "newmtl wood\nKd 0.4 0.3 0.2\n"


class New(program.Case):
    def picture_of(self, scene):
        self.done("render", scene, "--size", "16x16", "--error", "0.5", "-o", "a.exr", "-q")
        return exr.read(self.folder / "a.exr")[3]

    def test_a_mesh_becomes_a_scene_that_shows_all_of_it(self):
        (self.folder / "meshes").mkdir()
        self.write("meshes/two.obj", OBJ)
        self.write("meshes/two.mtl", MTL)
        self.done("new", "mine.toml", "meshes/two.obj", "-q")
        text = (self.folder / "mine.toml").read_text(encoding="utf-8")
        for line in ('part = "table"', 'part = "shade"', 'mesh = "meshes/two.obj"', 'name = "paper"', '# name = "wood"',
                     "# diffuse = [0.4, 0.3, 0.2]", "2 x 2 x 2"):
            self.assertIn(line, text)
        found = self.json("inspect", "mine.toml")
        self.assertEqual([(one["name"], one["polygons"]) for one in found["objects"]], [("table", 1), ("shade", 1)])
        layers = self.picture_of("mine.toml")
        self.assertGreater(max(layers["G"]), 0)
        # The corner pixels miss all objects: the objects are completely in the picture.
        corners = [layers["G"][k] for k in (0, 15, 240, 255)]
        self.assertEqual(corners, [0, 0, 0, 0])

    def test_without_a_mesh_it_has_shapes(self):
        self.done("new", "mine.toml", "-q")
        self.assertGreater(max(self.picture_of("mine.toml")["G"]), 0)

    def test_a_file_that_stands_upright_in_y_is_turned(self):
        self.write("t.gltf", """{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0, "name": "wall"}],
          "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
          "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 5, 0]}],
          "bufferViews": [{"buffer": 0, "byteLength": 36}],
          "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAoEAAAAAA"}]}""")
        self.done("new", "mine.toml", "t.gltf", "-q")
        self.assertIn('axes = "y-up"', (self.folder / "mine.toml").read_text(encoding="utf-8"))
        bounds = self.json("inspect", "mine.toml")["objects"][0]["bounds"]
        self.assertEqual(bounds["max_m"][2], 5)

    def test_refused(self):
        self.write("there.toml", "format = 1\n")
        self.says(self.refused("new", "there.toml"), "is there already")
        self.says(self.refused("new", "mine.obj"), ".toml")
        self.says(self.refused("new", "mine.toml", "none.obj"), "none.obj", "cannot open")
        self.assertFalse((self.folder / "mine.toml").exists())


class Pages(program.Case):
    def test_the_man_page_and_the_completions_have_every_command_and_option(self):
        texts = [self.done("manual").replace("\\-", "-"), *(self.done("completion", shell) for shell in ("bash", "zsh", "fish"))]
        for command in ("render", "solve", "new", "degrade", "study"):
            shown = self.done(command, "--help")
            options = set(re.findall(r"^  (?:-\w, )?--([\w-]+)", shown, re.M))
            self.assertIn("threads", options)
            for text in texts:
                self.assertIn(command, text)
                for option in options:
                    self.assertIn(option, text)
        if subprocess.run(["bash", "-c", "true"], check=False).returncode == 0:
            self.write("bash", texts[1])
            run = subprocess.run(["bash", "-c", 'source ./bash; COMP_WORDS=(earthshine study vis); COMP_CWORD=2; _earthshine; echo "${COMPREPLY[@]}"'],
                                 cwd=self.folder, capture_output=True, text=True, check=True)
            self.assertEqual(run.stdout.strip(), "visibility")
        self.says(self.refused("completion", "tcsh"), "bash")


if __name__ == "__main__":
    unittest.main()
