# SPDX-License-Identifier: Apache-2.0
"""No output of any command may be one of its inputs, under any name; tested before any work."""
import hashlib
import os
import pathlib
import shutil
import unittest

import program
import tiny_bay

TRIANGLE = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n"
GLTF = """{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
"meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "images": [{"uri": "skin.png"}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
"bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"uri": "a.bin", "byteLength": 36}]}"""
SCENE = tiny_bay.BAY.replace("[orbit]\naltitude_km = 425\nattitude = \"bay-to-space\"",
                             "[orbit]\naltitude_km = 425\nattitude_table = \"turns.csv\"") + program.IES_LAMP + """
[[object]]
name = "triangle"
mesh = "a.obj"
translate = [0, 0, 3]

[[object]]
name = "other"
mesh = "a.gltf"
material = "white"
translate = [0, 0, 4]
"""
INPUTS = ["scene.toml", "a.obj", "a.mtl", "a.gltf", "a.bin", "skin.png", "even.ies", "turns.csv"]


class InputsKept(program.Case):
    def setUp(self):
        super().setUp()
        self.write("a.obj", TRIANGLE)
        self.write("a.mtl", "newmtl red\nKd 0.5 0.1 0.1\n")
        self.write("a.gltf", GLTF)
        self.write("a.bin", b"\0" * 12 + b"\0\0\x80\x3f" + b"\0" * 8 + b"\0" * 4 + b"\0\0\x80\x3f" + b"\0" * 4)
        self.write("skin.png", "not read")
        self.write("even.ies", program.EVEN_IES)
        self.write("turns.csv", "time_s,yaw_deg,pitch_deg,roll_deg\n0,0,0,0\n9000,0,0,0\n")
        self.write("scene.toml", SCENE)
        self.done("inspect", "scene.toml")
        self.before = self.digests()

    def digests(self):
        return {str(path.relative_to(self.folder)): hashlib.sha256(path.read_bytes()).hexdigest()
                for path in self.folder.rglob("*") if path.is_file()}

    def kept(self, *call, name):
        message = self.refused(*call)
        self.says(message, name, "is read", "overwritten")
        self.assertEqual(self.digests(), self.before, f"{call}: {message}")

    def test_every_input_of_a_scene(self):
        for name in INPUTS:
            self.kept("solve", "scene.toml", "-o", name, name=name)

    def test_pictures_of_materials_that_are_not_read(self):
        """Bump maps, and all maps of a mesh with a material of the scene."""
        names = ("skin of a.png", "bump.png", "shine.png", "quoted.png", "elsewhere.png")
        for name in names:
            self.write(name, "not read")
        self.write("a.mtl", "newmtl red\nKd 0.5 0.1 0.1\nmap_Bump -bm 0.3 bump.png\nmap_Ks ./shine.png\nmap_Kd -s 2 2 skin of a.png\n"
                            f'MAP_KE "quoted.png"\nbump -bm 2 {self.folder.resolve()}/elsewhere.png\n')
        self.write("own.toml", SCENE.replace('mesh = "a.obj"', 'mesh = "a.obj"\nmaterial = "white"'))
        self.before = self.digests()
        for scene in ("scene.toml", "own.toml"):
            for name in names:
                self.kept("render", scene, "-o", "fresh.exr", "--png", name, name=name)

    def test_by_links_of_both_kinds_and_other_spellings(self):
        os.link(self.folder / "a.obj", self.folder / "hard.h5")
        os.symlink("a.bin", self.folder / "soft.exr")
        os.symlink("even.ies", self.folder / "soft.png")
        self.before = self.digests()
        self.kept("solve", "scene.toml", "-o", "hard.h5", name="hard.h5")
        self.kept("render", "scene.toml", "-o", "soft.exr", name="soft.exr")
        self.kept("render", "scene.toml", "-o", "b.exr", "--png", "soft.png", name="soft.png")
        self.kept("solve", "scene.toml", "-o", f"../{self.folder.name}/./a.obj", name="a.obj")

    def test_every_output(self):
        os.link(self.folder / "a.bin", self.folder / "x.glb")
        for ending in ("exr", "png", "json"):
            os.link(self.folder / "a.obj", self.folder / f"x.{ending}")
        self.before = self.digests()
        self.kept("solve", "scene.toml", "--glb", "x.glb", name="x.glb")
        render = ["render", "scene.toml"]
        for option, name in (("-o", "x.exr"), ("--png", "x.png"), ("--cctv", "x.png"), ("--range", "x.exr"),
                             ("--report", "x.json")):
            more = [] if option == "-o" else ["-o", "fresh.exr"]
            self.kept(*render, *more, option, name, name=name)

    def test_folder_of_a_study(self):
        """Any file of the folder. Pictures and points have unique names."""
        for command, file in (("orbit", "results.csv"), ("visibility", "report.html"), ("compare", "compare.json"),
                              ("accuracy", "accuracy.csv")):
            folder = self.folder / command
            folder.mkdir()
            os.link(self.folder / "turns.csv", folder / file)
            self.before = self.digests()
            self.kept("study", command, "scene.toml", "-o", command, name=file)
        self.write("s.toml", tiny_bay.STUDY.replace("bay.toml", "scene.toml"))
        (self.folder / "d").mkdir()
        os.symlink("../s.toml", self.folder / "d/study.json")
        self.before = self.digests()
        self.kept("study", "run", "s.toml", "-o", "d", name="study.json")

    def test_inputs_inside_the_folder_of_a_study(self):
        for room in ("pictures", "points"):
            (self.folder / "e" / room).mkdir(parents=True)
            shutil.copy(self.folder / "a.obj", self.folder / "e" / room / "a.obj")
            shutil.copy(self.folder / "a.mtl", self.folder / "e" / room / "a.mtl")
            self.write("in.toml", SCENE.replace('"a.obj"', f'"e/{room}/a.obj"'))
            self.says(self.refused("study", "orbit", "in.toml", "-o", "e"), f"e/{room}", "which is read")

    def test_pictures_and_cameras(self):
        self.write("scene.toml", program.BALL)
        self.done("render", "scene.toml", "-o", "p.exr", "--per-light", "--size", "8x8")
        os.link(self.folder / "p.exr", self.folder / "again.exr")
        self.write("cam.toml", "[[cctv]]\nname = \"mine\"\n")
        os.link(self.folder / "cam.toml", self.folder / "cam.json")
        self.before = self.digests()
        self.kept("relight", "p.exr", "--set", "lamp=0.5", "-o", "again.exr", name="again.exr")
        self.kept("degrade", "p.exr", "-o", "again.exr", name="again.exr")
        self.kept("degrade", "p.exr", "-o", "o.png", "--twin", "again.exr", name="again.exr")
        self.kept("degrade", "certify", "cam.toml", "-o", "cam.json", name="cam.json")
        self.says(self.refused("degrade", "p.exr", "-o", "o.png", "--stages", "."), "p.exr", "which is read")
        self.assertEqual(self.digests(), self.before)

    def test_mesh_of_the_scene_that_degrade_reads(self):
        self.write("b.toml", program.BALL)
        self.done("render", "b.toml", "-o", "p.exr", "--size", "8x8")
        os.link(self.folder / "a.obj", self.folder / "x.png")
        self.before = self.digests()
        self.kept("degrade", "p.exr", "-o", "x.png", "--scene", "scene.toml", name="x.png")

    def test_solution(self):
        self.write("scene.toml", program.BALL)
        self.done("solve", "scene.toml", "-o", "s.h5")
        os.symlink("s.h5", self.folder / "t.exr")
        self.before = self.digests()
        self.kept("render", "scene.toml", "--solution", "s.h5", "-o", "t.exr", name="t.exr")
        self.kept("solve", "scene.toml", "--solution", "s.h5", "-o", "s.h5", name="s.h5")

    def test_report(self):
        """The page would overwrite the results from which it is drawn."""
        folder = pathlib.Path(self.folder / "r")
        folder.mkdir()
        self.write("r/study.json", "{}")
        os.symlink("study.json", folder / "report.html")
        self.before = self.digests()
        self.kept("report", "r", name="report.html")


if __name__ == "__main__":
    unittest.main()
