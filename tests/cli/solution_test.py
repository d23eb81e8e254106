# SPDX-License-Identifier: Apache-2.0
"""solve -o and render --solution: a stored solution, its reuse, and its refusal when it is
outdated."""
import json
import os
import resource
import signal
import subprocess
import time
import unittest

import h5py

import program


ALL_BITS = (1 << 64) - 1


def seal(path):
    """Writes a valid seal (base::Digest) into the file's first block."""
    def mix(x):
        x = (x + 0x9e3779b97f4a7c15) & ALL_BITS
        x = ((x ^ (x >> 30)) * 0xbf58476d1ce4e5b9) & ALL_BITS
        x = ((x ^ (x >> 27)) * 0x94d049bb133111eb) & ALL_BITS
        return x ^ (x >> 31)
    data = path.read_bytes()
    content, state = data[512:], 0
    words = [len(content)] + [int.from_bytes(content[at:at + 8], "little") for at in range(0, len(content), 8)]
    for word in words:
        state = mix(state ^ mix(word))
    head = f"Earthshine: HDF5 follows after 512 bytes\nseal {state:016x}\n".encode()
    path.write_bytes(head.ljust(512, b"\0") + content)


class Solution(program.Case):
    def setUp(self):
        super().setUp()
        self.write("ball.toml", program.BALL)

    def bytes_of(self, name):
        return (self.folder / name).read_bytes()

    def render(self, name, *options):
        self.done("render", "ball.toml", "-o", name, "-q", "--camera", "A", *options)
        return self.bytes_of(name)

    def test_a_picture_from_the_file_is_the_picture_byte_for_byte(self):
        self.says(self.done("solve", "ball.toml", "-o", "ball.h5"), "imbalance", "write")
        for options in ([], ["--per-light", "--aov", "albedo"], ["--set", "quality.gather_rays=64", "-j", 1]):
            solved = self.render("solved.exr", *options)
            self.assertEqual(self.render("read.exr", *options, "--solution", "ball.h5"), solved)

    def test_refined_patches_come_back_from_the_file(self):
        refined = ["--set", "quality.refine=true", "--set", "quality.max_patches=400"]
        report = json.loads(self.done("solve", "ball.toml", "-o", "ball.h5", "--json", *refined))
        self.assertGreater(len(report["refinement"]["rounds"]), 1)
        read = json.loads(self.done("solve", "ball.toml", "--solution", "ball.h5", "--json", *refined))
        for of in (report, read):
            del of["seconds"]
        self.assertEqual(read, report)
        solved = self.render("solved.exr", *refined)
        self.assertEqual(self.render("read.exr", *refined, "--solution", "ball.h5"), solved)
        run = self.run_program("render", "ball.toml", "-o", "other.exr", "--solution", "ball.h5")
        self.says(run.stderr, "ball.h5 was solved with other settings", "refine (1, now 0)")

    def test_a_balance_that_misses_less_than_a_millionth_is_no_limit_reached(self):
        self.done("solve", "ball.toml", "-o", "ball.h5")
        for missed, is_told in ((0.9e-6, False), (1.1e-6, True)):
            with h5py.File(self.folder / "ball.h5", "r+") as file:
                file.attrs.modify("balance_balanced", 0)
                file.attrs.modify("balance_after", missed)
                file.attrs.modify("balance_sweeps", 9)
            seal(self.folder / "ball.h5")
            run = self.run_program("render", "ball.toml", "-o", "a.exr", "--camera", "A", "--solution", "ball.h5")
            self.assertEqual(run.returncode, 0, run.stderr)
            self.assertEqual("conserve energy" in run.stderr, is_told, run.stderr)

    def test_reading_skips_the_solve(self):
        self.done("solve", "ball.toml", "-o", "ball.h5")
        plain = json.loads(self.done("render", "ball.toml", "-o", "a.exr", "--json"))
        read = json.loads(self.done("render", "ball.toml", "-o", "a.exr", "--json", "--solution", "ball.h5"))
        self.assertIn("form factors", plain["seconds"])
        self.assertNotIn("form factors", read["seconds"])
        self.assertIn("read solution", read["seconds"])
        for report in (plain, read):
            del report["seconds"], report["peak_memory_mib"]
        self.assertGreater(sum(plain["rays"].pop("direct_by").values()), 0)
        self.assertEqual(read, plain)

    def test_the_file_is_the_same_on_any_number_of_threads(self):
        files = []
        for threads in (1, 2):
            self.done("solve", "ball.toml", "-o", "ball.h5", "-j", threads)
            files.append(self.bytes_of("ball.h5"))
        self.assertEqual(files[0], files[1])

    def test_stale_files_are_refused_with_what_changed(self):
        self.done("solve", "ball.toml", "-o", "ball.h5", "--seed", 3)
        call = ["render", "ball.toml", "-o", "a.exr", "--solution", "ball.h5"]
        self.done(*call, "--seed", 3)
        (self.folder / "a.exr").unlink()
        for option, words in {"--set=material.floor.diffuse=0.1": "the materials changed",
                              "--set=material.floor.specular=0.1": "the materials changed",
                              "--set=light.lamp.intensity=5": "the lights changed",
                              "--set=sun.illuminance=5": "the Sun or the Earth changed"}.items():
            message = self.refused(*call, option, "--seed", 3)
            self.says(message, "ball.h5: is stale", words, "Run \"earthshine solve ball.toml -o ball.h5\" again")
        self.write("ball.toml", program.BALL.replace("radius = 0.5", "radius = 0.501"))
        self.says(self.refused(*call, "--seed", 3), "the geometry changed")
        self.assertFalse((self.folder / "a.exr").exists())

    def test_a_solution_serves_pictures_of_any_accuracy(self):
        """A picture adds what the solution lacks: at another error, seed or patch size it has the error asked for."""
        self.done("solve", "ball.toml", "-o", "ball.h5")
        for options in (("--error", "0.1"), ("--error", "0.03", "--seed", 4), ("--set", "quality.patch_edge=0.6", "--error", "0.05")):
            report = self.json("render", "ball.toml", "-o", "a.exr", "--solution", "ball.h5", "--size", "24x18", *options)
            self.assertLessEqual(report["error"]["estimate"], report["error"]["wanted"])
            self.assertEqual(report["patches"], self.json("solve", "ball.toml", "-o", "again.h5")["patches"])

    def test_an_edited_mesh_makes_it_stale(self):
        def mesh(top):
            self.write("tent.obj", f"v 0 0 0\nv 1 0 0\nv 0 1 {top}\nf 1 2 3\n")
        mesh(1)
        self.write("ball.toml", program.BALL + '[[object]]\nname = "tent"\nmesh = "tent.obj"\nmaterial = "floor"\n')
        self.done("solve", "ball.toml", "-o", "ball.h5")
        self.render("a.exr", "--solution", "ball.h5")
        mesh(1.001)
        self.says(self.refused("render", "ball.toml", "-o", "a.exr", "--solution", "ball.h5"), "the geometry changed")

    def test_what_radiosity_does_not_read_may_change(self):
        self.done("solve", "ball.toml", "-o", "ball.h5")
        self.render("a.exr", "--solution", "ball.h5", "--size", "8x8", "--set", "camera.A.fov_deg=20", "--set",
                    "quality.gather_rays=4")
        self.done("render", "ball.toml", "-o", "a.exr", "--solution", "ball.h5", "--camera", "above", "--cctv", "c.png")

    def test_numpy_opens_it(self):
        report = self.json("solve", "ball.toml", "-o", "ball.h5")
        with h5py.File(self.folder / "ball.h5") as file:
            count = report["patches"]
            radiosity = file["radiosity"][:]
            self.assertEqual(radiosity.shape, (count, 2, 3))
            self.assertEqual(file["radiosity"].attrs["unit"].decode(), "lm/m2")
            self.assertEqual(list(file["group_names"].asstr()), ["sun", "lamp"])
            names = list(file["object_names"].asstr())
            self.assertEqual(names, ["floor", "ball"])
            self.assertEqual(file["corners"].shape, (count, 4, 3))
            self.assertEqual(file.attrs["name"].decode(), "ball on a floor")
            self.assertEqual((file.attrs["seed"], file.attrs["patch_edge_m"]), (1, 0.5))
            self.assertEqual(file.attrs["residual"], report["residual"])
            # The report of each object is the sum over its patches.
            area, owner = file["area"][:], file["object"][:]
            incident = (file["illuminance_direct"][:] + file["illuminance_indirect"][:]).sum(axis=1)
            for index, stated in enumerate(report["objects"]):
                mine = owner == index
                self.assertAlmostEqual(area[mine].sum() / stated["area_m2"], 1, places=12)
                for values, key in ((incident, "illuminance_lx"), (radiosity.sum(axis=1), "radiosity_lm_m2")):
                    mean = (values[mine] * area[mine, None]).sum(axis=0) / area[mine].sum()
                    for channel in range(3):
                        self.assertAlmostEqual(mean[channel] / stated[key][channel], 1, places=5)
            self.assertTrue((file["normal"][:][owner == 0] == [0, 0, 1]).all())

    def test_damaged_and_foreign_files(self):
        self.done("solve", "ball.toml", "-o", "ball.h5")
        sound = self.bytes_of("ball.h5")
        call = ["render", "ball.toml", "-o", "a.exr", "--solution", "bad.h5"]
        flipped = bytearray(sound)
        flipped[len(sound) // 2] ^= 1
        for content, words in ((bytes(flipped), "seal is broken"), (sound[:-1], "seal is broken"), (b"", "no seal"),
                               (sound[:3000], "seal is broken"), (sound[512:], "no seal"), (b"x" * 9999, "no seal")):
            self.write("bad.h5", content)
            self.says(self.refused(*call), "bad.h5: ", words)
        self.write("bad.h5", sound)
        with h5py.File(self.folder / "bad.h5", "r+") as file:
            file["radiosity"][0] = 1e9
        self.says(self.refused(*call), "changed after it was written")
        self.says(self.refused("render", "ball.toml", "-o", "a.exr", "--solution", "none.h5"), "no such file",
                  "earthshine solve ball.toml -o none.h5")
        self.refused("render", "ball.toml", "-o", "a.exr", "--solution", ".")
        self.says(self.refused("render", "ball.toml", "-o", "a.exr", "--solution", "bad.h5", "--indirect", "none"),
                  "--indirect none")
        self.says(self.refused("solve", "ball.toml", "-o", "bad.h5", "--solution", "bad.h5"), "overwritten")

    def test_killed_while_writing(self):
        """The old file remains complete: after a limit on the file's size, which stops the writing
        half-way, and after SIGKILL once the new file has been started."""
        self.done("solve", "ball.toml", "-o", "ball.h5")
        old = self.bytes_of("ball.h5")
        call = [program.PROGRAM, "solve", "ball.toml", "-o", "ball.h5", "-q", "--set", "quality.patch_edge=0.02",
                "--set", "quality.form_factor_rays=4", "--seed", "2"]

        def limit():
            signal.signal(signal.SIGXFSZ, signal.SIG_DFL)
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
            resource.setrlimit(resource.RLIMIT_FSIZE, (100000, 100000))
        run = subprocess.run(call, cwd=self.folder, preexec_fn=limit, capture_output=True, text=True)
        self.assertEqual(run.returncode, 1)
        self.says(run.stderr, "ball.h5")
        self.assertEqual(self.bytes_of("ball.h5"), old)

        def parts():
            return sum(name.endswith(".part") for name in os.listdir(self.folder))
        left = parts()
        with subprocess.Popen(call, cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as run:
            while run.poll() is None and parts() == left:
                time.sleep(0.0005)
            run.kill()
        if run.returncode == 0:
            return  # it ended before the signal
        self.assertEqual(run.returncode, -signal.SIGKILL)
        self.assertEqual(self.bytes_of("ball.h5"), old)

    def test_full_disk(self):
        for option in ("-o", "--glb"):
            message = self.refused("solve", "ball.toml", option, "/dev/full", "-q", code=1)
            self.says(message, "/dev/full", "No space left")
            self.assertEqual(len(message.splitlines()), 1)

    def test_names(self):
        self.assertEqual(self.done("solve", "ball.toml", "-o", "report.json"), "")
        self.assertIn("patches", json.loads(self.bytes_of("report.json")))
        self.says(self.refused("solve", "ball.toml", "-o", "ball.glb"), "--glb")
        self.says(self.refused("solve", "ball.toml", "--glb", "ball.h5"), ".glb")
        (self.folder / "kept.toml").write_text("a scene")
        self.says(self.refused("solve", "ball.toml", "-o", "kept.toml"), "kept.toml", ".h5 or .json")
        self.assertEqual((self.folder / "kept.toml").read_text(), "a scene")
        self.says(self.refused("solve", "ball.toml", "-o", "x", "--glb", "none/x.glb"), "none")


if __name__ == "__main__":
    unittest.main()
