# SPDX-License-Identifier: Apache-2.0
"""Pipes and devices as inputs and outputs: no command blocks for ever or reads without end."""
import os
import signal
import subprocess
import time
import unittest

import program
import tiny_bay

TRIANGLE = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n"
GLTF = """{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
"meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
"bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"uri": "pipe", "byteLength": 36}]}"""
OBJECT = "\n[[object]]\nname = \"it\"\nmesh = \"{}\"\n"
WAIT_S = 20  # for a busy machine; a blocked program would wait for ever


class Pipes(program.Case):
    def setUp(self):
        super().setUp()
        os.mkfifo(self.folder / "pipe")
        for ending in ("toml", "obj", "stl", "ply", "gltf", "glb", "exr", "png", "h5", "csv", "mtl"):
            os.mkfifo(self.folder / f"pipe.{ending}")
        self.write("ball.toml", program.BALL)

    def run_program(self, *arguments, timeout=WAIT_S, **more):
        return super().run_program(*arguments, timeout=timeout, **more)

    def refuses(self, *call, name="pipe"):
        message = self.refused(*call)
        errors = [line for line in message.splitlines() if not line.startswith("note: ")]
        self.assertEqual(len(errors), 1, message)
        self.says(errors[0], name, "is a pipe or a device", "a file on disk is wanted here")

    def test_scene_study_and_camera(self):
        self.refuses("inspect", "pipe.toml")
        self.refuses("render", "pipe.toml", "-o", "a.exr")
        self.refuses("study", "run", "pipe.toml", "-o", "d")
        self.refuses("degrade", "certify", "pipe.toml")
        self.refuses("inspect", "/dev/zero", name="/dev/zero")
        self.write("s.toml", tiny_bay.STUDY.replace("bay.toml", "pipe.toml"))
        self.refuses("study", "run", "s.toml", "-o", "d")

    def test_meshes_and_what_they_name(self):
        for ending in ("obj", "stl", "ply", "gltf", "glb"):
            self.write("a.toml", program.BALL + OBJECT.format(f"pipe.{ending}"))
            self.refuses("inspect", "a.toml")
            os.symlink("/dev/zero", self.folder / f"zero.{ending}")
            self.write("a.toml", program.BALL + OBJECT.format(f"zero.{ending}"))
            self.refuses("inspect", "a.toml", name=f"zero.{ending}")
        self.write("a.obj", TRIANGLE.replace("a.mtl", "pipe.mtl"))
        self.write("a.toml", program.BALL + OBJECT.format("a.obj"))
        self.refuses("inspect", "a.toml")
        self.write("a.gltf", GLTF)
        self.write("a.toml", program.BALL + OBJECT.format("a.gltf") + 'material = "paint"\n')
        message = self.refused("inspect", "a.toml")
        self.says(message, "a.gltf", "pipe", "is a pipe or a device")

    def test_pictures_tables_and_solutions(self):
        self.refuses("degrade", "pipe.exr", "-o", "a.png")
        self.refuses("degrade", "/dev/zero", "-o", "a.png", name="/dev/zero")
        self.refuses("relight", "pipe.exr", "-o", "a.exr")
        self.refuses("fit-phong", "pipe.csv")
        self.refuses("render", "ball.toml", "-o", "a.exr", "--solution", "pipe.h5")
        self.refuses("render", "ball.toml", "--camera", "A", "--over", "pipe.png", "--png", "a.png")

    def test_outputs(self):
        self.refuses("solve", "ball.toml", "-o", "pipe")
        self.refuses("render", "ball.toml", "-o", "pipe.exr")
        self.refuses("render", "ball.toml", "-o", "a.exr", "--png", "pipe.png")
        (self.folder / "d").mkdir()
        os.mkfifo(self.folder / "d/report.html")
        self.write("bay.toml", tiny_bay.BAY)
        self.refuses("study", "orbit", "bay.toml", "-o", "d", name="report.html")

    def test_results_of_a_study(self):
        (self.folder / "d").mkdir()
        os.mkfifo(self.folder / "d/study.json")
        self.says(self.refused("report", "d"), "study.json", "cannot be read")

    def test_devices_that_never_wait_and_standard_output_are_written(self):
        self.done("render", "ball.toml", "-o", "/dev/null", "--size", "8x8")
        self.says(self.refused("solve", "ball.toml", "-o", "/dev/full", code=1), "/dev/full")
        run = self.run_program("render", "ball.toml", "-o", "a.exr", "--size", "8x8", "--png", "/dev/stdout",
                               text=False)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual(run.stdout[:4], b"\x89PNG")

    def ends_at_once(self, run, call):
        time.sleep(1.0)
        self.assertIsNone(run.poll(), call)
        run.send_signal(signal.SIGTERM)
        start = time.monotonic()
        try:
            run.wait(timeout=WAIT_S)
        finally:
            run.kill()
        self.assertLess(time.monotonic() - start, 5.0, call)  # a second on an idle machine
        self.assertNotEqual(run.returncode, 0)

    def test_end_is_at_once_where_nobody_reads(self):
        """A full pipe blocks the writer; SIGTERM ends it within a second."""
        read_end, write_end = os.pipe()
        os.set_blocking(write_end, False)
        try:
            while os.write(write_end, b"x" * 4096):
                pass
        except BlockingIOError:
            pass
        os.set_blocking(write_end, True)
        render = ["render", "ball.toml", "-o", "a.exr", "--json"]
        # With a camera the first note comes with the picture.
        for stream, call in (("stdout", render), ("stderr", render), ("stderr", [*render, "--camera", "A"]),
                             ("stdout", ["inspect", "ball.toml"])):
            streams = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL} | {stream: write_end}
            with subprocess.Popen([program.PROGRAM, *call], cwd=self.folder, **streams) as run:
                self.ends_at_once(run, call)
        os.close(read_end)
        os.close(write_end)


    def test_end_is_at_once_while_plots_are_drawn(self):
        (self.folder / "bin").mkdir()
        self.write("bin/gnuplot", "#!/bin/sh\ntouch started\nexec sleep 60\n")
        (self.folder / "bin/gnuplot").chmod(0o755)
        call = [program.PROGRAM, "study", "accuracy", "ball.toml", "-o", "d", "--size", "8x8", "--camera", "A", "-q",
                "--set", "quality.patch_edge=1", "--wanted", "0.9"]
        with subprocess.Popen(call, cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                              env=os.environ | {"PATH": f"{self.folder}/bin:{os.environ['PATH']}"}) as run:
            while run.poll() is None and not (self.folder / "d/started").exists():
                time.sleep(0.05)
            self.ends_at_once(run, call)


if __name__ == "__main__":
    unittest.main()
