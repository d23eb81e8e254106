# SPDX-License-Identifier: Apache-2.0
"""Output files, and files that must be unchanged after an error."""
import os
import pty
import resource
import signal
import struct
import subprocess
import time
import unittest
import zlib

import program


def png_size(data):
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    width, height, depth, colour = struct.unpack(">IIBB", data[16:26])
    at, packed = 8, b""
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        if kind == b"IDAT":
            packed += data[at + 8:at + 8 + size]
        at += 12 + size
    channels = {0: 1, 2: 3}[colour]
    assert depth == 8 and len(zlib.decompress(packed)) == height * (1 + width * channels)
    return width, height


class Output(program.Case):
    def setUp(self):
        super().setUp()
        self.write("ball.toml", program.BALL)

    def files(self):
        return sorted(os.listdir(self.folder))

    def test_three_pictures_of_one_run(self):
        self.assertEqual(self.done("render", "ball.toml", "-o", "a.exr", "--png", "a.png", "--cctv", "c.png"), "")
        self.assertEqual(png_size((self.folder / "a.png").read_bytes()), (32, 24))
        width, height = png_size((self.folder / "c.png").read_bytes())
        self.assertAlmostEqual(width / height, 4 / 3, delta=0.01)
        self.assertEqual(self.files(), ["a.exr", "a.png", "ball.toml", "c.png"])  # no other file
                                                                                  # remains

    def test_folder_that_is_not_there_is_named_before_any_work(self):
        for option in ("-o", "--png", "--cctv"):
            outputs = {"-o": "a.exr"}
            outputs[option] = "none/a.exr" if option == "-o" else "none/a.png"
            call = [word for pair in outputs.items() for word in pair]
            self.says(self.refused("render", "ball.toml", *call, "--set", "quality.gather_rays=65536"), "none")
        self.refused("solve", "ball.toml", "-o", "none/a.json")
        self.assertEqual(self.files(), ["ball.toml"])

    def test_wrong_names(self):
        self.says(self.refused("render", "ball.toml", "-o", "a.png"), ".exr")
        self.says(self.refused("render", "ball.toml", "-o", "a.exr", "--png", "a.exr"), ".png")
        self.says(self.refused("render", "ball.toml", "-o", "a.exr", "--png", "b.png", "--cctv", "./b.png"), "twice")
        self.says(self.refused("solve", "ball.toml", "-o", "ball.toml"), "overwritten")
        (self.folder / "folder.exr").mkdir()
        self.says(self.refused("render", "ball.toml", "-o", "folder.exr"), "folder")

    def test_places_that_may_not_be_looked_into(self):
        """Unreadable input: exit code 2, as given in the call. Unwritable output: 1. An invalid
        name: 2."""
        self.folder.chmod(0o777)
        self.done("render", "ball.toml", "-o", "p.exr", "--size", "8x8")
        for name, mode in (("closed", 0), ("ro", 0o555)):
            (self.folder / name).mkdir()
            (self.folder / name).chmod(mode)
            self.addCleanup((self.folder / name).chmod, 0o777)

        def as_nobody():
            if os.geteuid() == 0:
                os.setgroups([])
                os.setgid(65534)
                os.setuid(65534)
        long = "n" * 300
        render, study = ["render", "ball.toml", "--camera", "A"], ["study", "visibility", "ball.toml", "-o"]
        for code, call in ((2, ["degrade", "closed/p.exr", "-o", "x.png"]), (2, ["merge", "closed"]), (2, ["report", "closed"]),
                           (2, [*render, "-o", "x.exr", "--solution", "closed/s.h5"]), (1, [*render, "-o", "closed/x.exr"]),
                           (1, [*render, "-o", "ro/x.exr"]), (1, [*study, "ro"]), (1, [*study, "ro/d"]), (1, [*study, "closed/d"]),
                           (1, ["degrade", "p.exr", "-o", "x.png", "--stages", "ro/s"]), (2, [*render, "-o", long + ".exr"]),
                           (2, ["solve", "ball.toml", "--glb", long + ".glb"]), (2, [*study, long]), (2, [*study, "ball.toml/d"])):
            try:
                run = self.run_program(*call, preexec_fn=as_nobody)
            except (OSError, subprocess.SubprocessError) as error:
                self.skipTest(f"the program cannot be run as another user: {error}")
            why = "Not a directory" if "ball.toml/d" in call else "File name too long" if code == 2 and long in "".join(call) else "Permission denied"
            self.assertEqual(run.returncode, code, f"{call}: {run.stderr}")
            self.says(run.stderr, why, "closed" if "closed" in "".join(call) else call[-1][:20])
            self.assertNotIn("filesystem error", run.stderr)
            self.assertNotIn("patches", run.stderr)  # before any work

    def test_old_picture_is_kept_when_the_run_fails(self):
        self.write("a.exr", "old")
        self.refused("render", "ball.toml", "-o", "a.exr", "--camera", "none")
        self.refused("render", "ball.toml", "-o", "a.exr", "--set", "material.paint.specular=9")
        self.assertEqual((self.folder / "a.exr").read_text(), "old")

    def test_interrupted_while_writing(self):
        """The old picture remains, without other files, at whatever time the signal arrives."""
        call = [program.PROGRAM, "render", "ball.toml", "-o", "a.exr", "-q", "--size", "768x768", "--indirect",
                "none", "--set", "quality.camera_samples=4", "--aov", "albedo,normal,position,depth,range"]
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            self.write("a.exr", "old")
            with subprocess.Popen(call, cwd=self.folder, stderr=subprocess.DEVNULL, preexec_fn=lambda:
                                  [signal.signal(n, signal.SIG_DFL) for n in (signal.SIGINT, signal.SIGHUP)]) as run:
                while run.poll() is None and not any(name.endswith(".part") for name in self.files()):
                    time.sleep(0.002)
                run.send_signal(number)
            self.assertEqual(self.files(), ["a.exr", "ball.toml"])
            if run.returncode == 0:
                continue  # it ended before the signal
            self.assertEqual(run.returncode, -number)
            self.assertEqual((self.folder / "a.exr").read_text(), "old")

    def test_killed_while_writing(self):
        """The next run that writes the file removes temporary files of a killed run."""
        call = [program.PROGRAM, "render", "ball.toml", "-o", "a.exr", "-q", "--size", "768x768", "--indirect",
                "none", "--set", "quality.camera_samples=4", "--aov", "albedo,normal,position,depth,range"]
        left = []
        while not left:
            (self.folder / "a.exr").unlink(missing_ok=True)
            with subprocess.Popen(call, cwd=self.folder, stderr=subprocess.DEVNULL) as run:
                def parts():
                    try:
                        return [path for path in self.folder.glob(".*.part") if path.stat().st_size > 0]
                    except FileNotFoundError:  # it has just been renamed
                        return []
                while run.poll() is None and not parts():
                    time.sleep(0.002)
                run.kill()
            left = parts()
        self.assertFalse((self.folder / "a.exr").exists())
        self.done("render", "ball.toml", "-o", "a.exr", "--size", "8x8")
        self.assertEqual(self.files(), ["a.exr", "ball.toml"])

    def test_full_disk(self):
        self.says(self.refused("render", "ball.toml", "-o", "/dev/full", code=1), "/dev/full")
        with open("/dev/full", "w") as full:
            for call in (["inspect", "ball.toml"], ["--help"], ["--version"], ["solve", "ball.toml", "--json"]):
                run = self.run_program(*call, capture_output=False, stdout=full, stderr=subprocess.PIPE)
                self.assertEqual(run.returncode, 1)
                self.assertIn("standard output", run.stderr)

    def test_files_beyond_the_limit_on_their_size(self):
        # SIGXFSZ would kill the program and leave the temporary file; Python ignores it, also for
        # children.
        limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))  # noqa: E731
        for call in (["render", "ball.toml", "-o", "a.exr"], ["solve", "ball.toml", "-o", "a.h5"]):
            run = self.run_program(*call, preexec_fn=limit)
            self.assertEqual(run.returncode, 1, run.stderr)
            self.assertIn("a." + call[-1].split(".")[1], run.stderr)
            self.assertEqual(self.files(), ["ball.toml"])

    def test_closed_pipe(self):
        read_end, write_end = os.pipe()
        os.close(read_end)
        run = self.run_program("inspect", "ball.toml", capture_output=False, stdout=write_end,
                               stderr=subprocess.PIPE)
        os.close(write_end)
        self.assertEqual(run.returncode, 1)
        self.assertIn("standard output", run.stderr)

    def on_a_terminal(self, *options):
        master, slave = pty.openpty()
        run = self.run_program("render", "ball.toml", "-o", "a.exr", "--camera", "A", *options,
                               capture_output=False, stdout=subprocess.DEVNULL, stderr=slave)
        os.write(slave, b".")  # so that input is available
        os.close(slave)
        text = os.read(master, 1 << 16).decode()
        os.close(master)
        self.assertEqual(run.returncode, 0, text)
        return text

    def test_progress_bar_on_a_terminal_only(self):
        text = self.on_a_terminal()
        self.assertIn("render", text)
        self.assertRegex(text, r"\r\x1b\[2Kcamera A +\d+ %")
        self.assertEqual(self.on_a_terminal("--quiet"), ".")
        self.assertNotIn("\r", self.run_program("render", "ball.toml", "-o", "a.exr").stderr)


if __name__ == "__main__":
    unittest.main()
