# SPDX-License-Identifier: Apache-2.0
"""--max-memory holds while files and geometry are read, and sizes stated in files are not trusted.
"""
import os
import resource
import struct
import subprocess
import unittest
import zlib

import exr
import program

SPHERE = """
[[object]]
name = "s{0}"
shape = "sphere"
center = [{0}, 0, 9]
radius = 0.4
segments = {1}
material = "paint"
"""
SLACK_MIB = 64


class Memory(program.Case):
    def peak_mib(self, *call, code):
        """Peak memory of this run."""
        with subprocess.Popen([program.PROGRAM, *map(str, call)], cwd=self.folder, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True, preexec_fn=lambda: resource.setrlimit(
                                  resource.RLIMIT_AS, (4 << 30, 4 << 30))) as run:
            said = run.stdout.read()
            _, status, usage = os.wait4(run.pid, 0)
            run.returncode = os.waitstatus_to_exitcode(status)
        self.assertEqual(run.returncode, code, said)
        return usage.ru_maxrss / 1024, said

    def spheres(self, count, segments):
        self.write("many.toml", program.BALL + "".join(SPHERE.format(k, segments) for k in range(count)))

    def test_geometry_that_does_not_fit(self):
        for count, segments, allowed in ((40, 4096, 500), (40, 1024, 300), (2, 1024, 300), (1, 1024, 100)):
            self.spheres(count, segments)
            for call in (("inspect",), ("solve",), ("render", "-o", "a.exr")):
                if (count, call[0]) == (2, "inspect"):
                    continue  # fits
                peak, said = self.peak_mib(call[0], "many.toml", *call[1:], "--max-memory", f"{allowed}MiB", code=1)
                self.assertLess(peak, allowed + SLACK_MIB, f"{count} {segments} {call}")
                self.says(said, "many.toml", "--max-memory")

    def test_geometry_that_fits_is_read(self):
        self.spheres(1, 1024)
        peak, _ = self.peak_mib("inspect", "many.toml", "--max-memory", "300MiB", code=0)
        self.assertLess(peak, 300)

    def test_a_mesh_that_does_not_fit(self):
        with open(self.folder / "a.obj", "wb") as file:
            file.truncate(400 << 20)  # sparse: no space on the disk
        self.write("a.toml", program.BALL + '\n[[object]]\nname = "it"\nmesh = "a.obj"\n')
        peak, said = self.peak_mib("inspect", "a.toml", "--max-memory", "100MiB", code=1)
        self.assertLess(peak, 100)
        self.says(said, "a.obj", "--max-memory")

    def test_what_was_read_before_leaves_its_room(self):
        """Files of comments and one triangle, increasingly large, one after the other. The last one
        of 64 MiB, its numbers of the same size and the program's 14 MiB are 142 of 160. If freed
        memory of the first two, of 48 and 56, counted, there would not be room."""
        for k, (name, size) in enumerate((("a", 48), ("b", 56), ("c", 64))):
            (self.folder / f"{name}.obj").write_bytes(f"v {3 + k} 0 5\nv {4 + k} 0 5\nv {3 + k} 1 5\nf 1 2 3\n".encode() +
                                                      (b"#" * 63 + b"\n") * (size << 14))
        self.write("abc.toml", program.BALL + "".join(
            f'\n[[object]]\nname = "{name}"\nmesh = "{name}.obj"\nmaterial = "paint"\n' for name in "abc"))
        peak, _ = self.peak_mib("inspect", "abc.toml", "--max-memory", "160MiB", code=0)
        self.assertLess(peak, 160)

    def write_large_picture(self):
        def chunk(kind, data):
            return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
        self.write("p.png", b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 16384, 12288, 8, 2, 0, 0, 0)) +
                   chunk(b"IDAT", zlib.compress(bytes(1 << 20))) + chunk(b"IEND", b""))

    def test_a_texture_that_does_not_fit(self):
        self.write_large_picture()
        self.write("a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl m\nf 1/1 2/2 3/3\n")
        self.write("a.mtl", "newmtl m\nKd 1 1 1\nmap_Kd p.png\n")
        self.write("a.toml", program.BALL + '\n[[object]]\nname = "it"\nmesh = "a.obj"\n')
        peak, said = self.peak_mib("inspect", "a.toml", "--max-memory", "300MiB", code=1)
        self.assertLess(peak, 300 + SLACK_MIB)
        self.says(said, "p.png", "--max-memory")

    def test_a_photograph_that_does_not_fit(self):
        self.write_large_picture()
        self.write("b.toml", program.BALL)
        peak, said = self.peak_mib("render", "b.toml", "--camera", "A", "--over", "p.png", "--png", "o.png",
                                   "--max-memory", "300MiB", code=1)
        self.assertLess(peak, 300 + SLACK_MIB)
        self.says(said, "p.png", "--max-memory")

    def test_an_attribute_of_gigabytes_in_a_small_picture(self):
        data = exr.pack(8, 8, {"Y": 1.0})
        evil = data[:8] + b"story\0string\0" + struct.pack("<i", 800 << 20) + data[8:] + b" " * 2000
        self.write("a.exr", evil)
        self.write("b.toml", program.BALL)
        for call in (("degrade", "a.exr", "-o", "o.png"), ("relight", "a.exr", "-o", "o.exr")):
            peak, said = self.peak_mib(*call, code=2)
            self.assertLess(peak, 100)
            self.says(said, "a.exr", "announces 838860800 bytes")


if __name__ == "__main__":
    unittest.main()
