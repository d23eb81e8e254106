# SPDX-License-Identifier: Apache-2.0
"""Files designed to use memory or time, or to read other files: refused with one line, within the
allowed memory. docs/reliability.md has them as a table. Oversized pictures, meshes and geometry:
memory_test.py. Links in HDF5: tests/base/files/hdf5_file_test.cpp."""
import base64
import json
import os
import resource
import struct
import subprocess
import unittest
import zlib

import exr
import program

ALLOWED_MIB, SLACK_MIB = 300, 64
TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl m\nf 1/1 2/2 3/3\n"
IT = '\n[[object]]\nname = "it"\nmesh = "{}"\n'
POINTS = base64.b64encode(struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)).decode()


def gltf(accessor=None, buffer=None, nodes=None):
    return json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": nodes or [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"} | (accessor or {})],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "buffers": [{"uri": f"data:application/octet-stream;base64,{POINTS}", "byteLength": 36} | (buffer or {})]})


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def zeros_packed(mib):
    packer = zlib.compressobj(9)
    return b"".join([packer.compress(bytes(1 << 20)) for _ in range(mib)] + [packer.flush()])


class Hostile(program.Case):
    def ends(self, code, *call):
        """Runs within the allowed memory; returns the message."""
        with subprocess.Popen([program.PROGRAM, *map(str, call), "--max-memory", f"{ALLOWED_MIB}MiB"], cwd=self.folder,
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (20, 20))) as run:
            said = run.stdout.read()
            _, status, usage = os.wait4(run.pid, 0)
            run.returncode = os.waitstatus_to_exitcode(status)
        self.assertEqual(run.returncode, code, said)
        self.assertLess(usage.ru_maxrss / 1024, ALLOWED_MIB + SLACK_MIB, call)
        return said

    def scene(self, mesh, where="a.toml", **files):
        for name, text in files.items():
            self.write(name.replace("_", "."), text)
        self.write(where, program.BALL + IT.format(mesh) + ('material = "paint"\n' if mesh.endswith("gltf") else ""))
        return where

    def test_nests_of_tables_and_arrays(self):
        deep = 10000
        lines = "[\n" * deep + "]\n" * deep
        for text, said in (("x = " + "[" * deep + "]" * deep, "line is too long"), ("x = " + lines, "a.toml"),
                           ("x = " + "{a=" * deep + "1" + "}" * deep, "line is too long"),
                           ("x = " + "{a=" * 2000 + "1" + "}" * 2000, "a.toml"),
                           ("a." * deep + "a = 1", "too many parts"), ("[" + "a." * deep + "a]", "too many parts"),
                           ("x = " + lines * 60, "is larger than")):
            self.write("a.toml", text + "\n" + program.BALL)
            self.says(self.ends(2, "inspect", "a.toml"), "a.toml", said)
            self.says(self.ends(2, "study", "run", "a.toml", "-o", "d"), "a.toml", said)

    def test_gltf(self):
        tree = [{"children": [k + 1, k + 1]} for k in range(40)] + [{"mesh": 0}]
        sparse = {"count": 1, "indices": {"bufferView": 0, "componentType": 5125}, "values": {"bufferView": 0}}
        for text, said in ((gltf({"count": 10**9, "sparse": sparse}), "an accessor of 1000000000 elements"),
                           (gltf({"sparse": sparse | {"count": 10**12}}), "sparse.count is 1000000000000;"),
                           (gltf(buffer={"byteLength": 1 << 40}), "g.gltf"), (gltf(buffer={"byteLength": -1}), "byteLength"),
                           (gltf(nodes=tree), "is reached twice"), (gltf(nodes=[{"mesh": 0, "children": [0]}]), "is reached twice"),
                           ('{"asset":' + "[" * 100000, "nested too deeply")):
            self.says(self.ends(2, "inspect", self.scene("g.gltf", g_gltf=text)), "g.gltf", said)

    def test_a_buffer_of_hundreds_of_megabytes_in_the_text(self):
        with open(self.folder / "g.gltf", "w", encoding="utf-8") as file:
            head, tail = gltf().split(POINTS)
            file.write(head)
            for _ in range(400):
                file.write("A" * 1000000)
            file.write(tail)
        self.says(self.ends(1, "inspect", self.scene("g.gltf")), "g.gltf", "--max-memory")

    def test_pictures_that_are_packed_small(self):
        """8 x 8 pixels: additional compressed data takes time, but no memory."""
        bomb = zeros_packed(256)
        rows = zlib.compress(bytes(25 * 8))
        header = struct.pack(">IIBBBBB", 8, 8, 8, 2, 0, 0, 0)
        self.write("b.toml", program.BALL)
        for extra, data in ((b"", bomb), (chunk(b"zTXt", b"k\0\0" + bomb), rows), (chunk(b"iCCP", b"k\0\0" + bomb), rows)):
            self.write("p.png", b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + extra + chunk(b"IDAT", data) + chunk(b"IEND", b""))
            self.ends(0, "inspect", self.scene("a.obj", a_obj="mtllib a.mtl\n" + TRIANGLE,
                                               a_mtl="newmtl m\nKd 1 1 1\nmap_Kd p.png\n"))
            self.ends(0, "render", "b.toml", "--camera", "A", "--over", "p.png", "--png", "o.png")

    def test_pictures_of_another_kind(self):
        data = exr.pack(8, 8, {"Y": 1.0})
        deep = data[:8] + b"type\0string\0" + struct.pack("<i", 12) + b"deepscanline" + data[8:]
        name = b"name\0string\0" + struct.pack("<i", 1) + b"p"
        parts = data[:4] + struct.pack("<I", 2 | 0x1000) + (name + data[8:data.index(b"\0\0", 300)]) * 3000
        for picture in (deep, parts):
            self.write("a.exr", picture)
            self.says(self.ends(2, "degrade", "a.exr", "-o", "o.png"), "a.exr")
            self.says(self.ends(2, "relight", "a.exr", "-o", "o.exr"), "a.exr")

    def test_files_of_files_stay_in_the_folder(self):
        """Files that the scene names may be anywhere, because the caller trusts the scene. Files
        that a mesh names may not."""
        (self.folder / "s/in").mkdir(parents=True)
        self.write("out.mtl", "newmtl m\nKd 1 1 1\n")
        self.write("out.bin", base64.b64decode(POINTS))
        self.write("out.obj", TRIANGLE.replace("usemtl m\n", ""))
        self.write("out.ies", program.EVEN_IES)
        for place in ("../../out", self.folder / "out"):
            self.write("s/in/a.toml", program.BALL + IT.format(f"{place}.obj") + 'material = "paint"\n'
                       + program.IES_LAMP.replace("even.ies", f"{place}.ies"))
            self.ends(0, "inspect", "s/in/a.toml")
        os.symlink("../../out.mtl", self.folder / "s/in/link.mtl")
        for place, said in (("../../out", "leads out of the scene's folder"), (self.folder / "out", "is not relative"),
                            ("..\\..\\out", "out"), ("in/../../../out", "leads out")):
            self.write("s/in/a.obj", f"mtllib {place}.mtl\n" + TRIANGLE)
            self.says(self.ends(2, "inspect", self.scene("a.obj", "s/in/a.toml")), "a.obj", said)
            self.write("s/in/g.gltf", gltf(buffer={"uri": f"{place}.bin"}))
            self.says(self.ends(2, "inspect", self.scene("g.gltf", "s/in/a.toml")), "g.gltf", said)
        for place in ("%2e%2e/%2e%2e/out.bin", "file:///etc/passwd", "http://localhost/out.bin"):
            self.write("s/in/g.gltf", gltf(buffer={"uri": place}))
            self.says(self.ends(2, "inspect", self.scene("g.gltf", "s/in/a.toml")), "g.gltf")


if __name__ == "__main__":
    unittest.main()
