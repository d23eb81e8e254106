# SPDX-License-Identifier: Apache-2.0
"""Ctrl-C and time limits while `render` still solves: it writes a picture; `solve` writes its
current solution."""
import json
import signal
import subprocess
import time
import unittest

import exr
import program

# A solve of minutes, which the picture needs.
LONG = ("--set", "quality.patch_edge=0.02", "--set", "quality.form_factor_rays=65536")
STOP_S = 2.0  # after the start: long after the scene is read, long before it is solved
WHITE = (0.2126, 0.7152, 0.0722)


def mean(path):
    _, _, _, channels = exr.read(path)
    values = [sum(w * v for w, v in zip(WHITE, rgb)) for rgb in zip(*(channels[c] for c in "RGB"))]
    return sum(values) / len(values)


class BrokenOff(program.Case):
    def setUp(self):
        super().setUp()
        self.write("ball.toml", program.BALL.split("[quality]")[0])
        self.call = ("render", "ball.toml", "-o", "a.exr", "--camera", "A", "--size", "96x72", *LONG)
        self.done("render", "ball.toml", "-o", "whole.exr", "--camera", "A", "--size", "96x72", "--error", "0.01")

    def stopped(self, *call, signal_number=signal.SIGINT, after_s=STOP_S):
        """(exit code, output, messages, seconds since the signal)."""
        process = subprocess.Popen([program.PROGRAM, *call], cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        time.sleep(after_s)
        self.assertIsNone(process.poll())
        process.send_signal(signal_number)
        start = time.monotonic()
        out, err = process.communicate(timeout=60)
        return process.returncode, out, err, time.monotonic() - start

    def stopped_with_result(self, *call, signal_number=signal.SIGINT):
        """stopped(), later if a busy machine had not begun the work that can be kept."""
        for doublings in range(8):
            result = self.stopped(*call, signal_number=signal_number, after_s=STOP_S * 2 ** doublings)
            if result[0] != -signal_number:
                break
        return result

    def is_the_picture(self, stated):
        """Paths without a solution give the light of the whole picture: means differ by no more
        than the pixel errors."""
        header, width, height, _ = exr.read(self.folder / "a.exr")
        self.assertEqual((width, height), (96, 72))
        self.assertLess(abs(mean(self.folder / "a.exr") / mean(self.folder / "whole.exr") - 1), stated)
        return header

    def test_ctrl_c_in_the_solve_gives_a_picture(self):
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            code, out, err, seconds = self.stopped_with_result(*self.call, "--json", signal_number=number)
            self.assertEqual(code, 1, err)
            self.says(err, "interrupted", "a.exr, which says it is partial")
            report = json.loads(out)
            self.assertEqual(report["patches"], 0)
            self.assertGreater(report["error"]["estimate"], 0.02)
            header = self.is_the_picture(report["error"]["bound_95"])
            self.assertEqual(header["earthshine:partial"], "yes")
            self.assertLess(seconds, 10)  # the solve would take minutes

    def test_every_picture_says_that_it_is_partial(self):
        mark = b"earthshine:partial\0yes"
        self.done("render", "ball.toml", "-o", "a.exr", "--camera", "A", "--size", "96x72", "--png", "a.png", "--cctv", "c.png")
        pngs = ("a.png", "c.png")
        for png in pngs:
            self.assertNotIn(mark, (self.folder / png).read_bytes())
        _, _, err, _ = self.stopped_with_result(*self.call, "--png", "a.png", "--cctv", "c.png", "--per-light")
        self.says(err, "a.exr, a.png, c.png, which say they are partial")
        self.write("photo.png", (self.folder / "a.png").read_bytes())
        _, _, err, _ = self.stopped_with_result("render", "ball.toml", "--camera", "A", "--over", "photo.png", "--over-style", "both", "--png", "o.png", *LONG)
        self.says(err, "in o.png, which says it is partial")
        self.done("degrade", "a.exr", "-o", "d.png", "--twin", "t.exr")
        self.assertEqual(exr.read(self.folder / "t.exr")[0]["earthshine:partial"], "yes")
        self.done("relight", "a.exr", "--set", "lamp=0.5", "--png", "r.png")
        for png in (*pngs, "o.png", "d.png", "r.png"):
            self.assertIn(mark, (self.folder / png).read_bytes())

    def test_it_says_what_is_missing(self):
        _, _, err, _ = self.stopped_with_result(*self.call, "--error", "0.02")
        self.says(err, "the solve was broken off", "stopped:", "is not reached: it was stopped")

    def test_of_several_cameras_the_first_is_drawn(self):
        self.stopped_with_result(*self.call, "--camera", "above")
        self.assertTrue((self.folder / "a-A.exr").exists())
        self.assertFalse((self.folder / "a-above.exr").exists())

    def test_a_probe_says_what_it_knows(self):
        code, out, _, _ = self.stopped_with_result("render", "ball.toml", "--camera", "A", "--size", "96x72", "--probe", "48,50", *LONG)
        self.assertEqual(code, 1)
        self.says(out, "light by source")

    def test_a_part_of_a_picture_is_not_begun(self):
        code, _, _, _ = self.stopped(*self.call, "--part", "1/2")
        self.assertEqual(code, -signal.SIGINT)
        self.assertFalse((self.folder / "a.exr").exists())

    def test_where_nothing_could_be_kept_it_is_said(self):
        for study in ("compare", "visibility"):
            code, out, err, seconds = self.stopped("study", study, "ball.toml", "-o", "d", "--camera", "A", "-q", *LONG)
            self.assertEqual((code, out), (-signal.SIGINT, ""))
            self.assertEqual(err, "earthshine: interrupted: ended without what was under way\n")
            self.assertLess(seconds, 5)  # immediate, except for other processes

    def test_a_solve_keeps_what_it_had_come_to(self):
        code, out, err, seconds = self.stopped_with_result("solve", "ball.toml", "--error", "0.0005", "-o", "a.h5", "--json")
        self.assertEqual(code, 1, err)
        self.says(err, "interrupted", "The partial result is in a.h5")
        report = json.loads(out)
        self.assertEqual(report["error"]["limit"], "stopped")
        self.assertGreater(report["error"]["estimate"], 0.0005)
        self.assertLess(seconds, 10)  # the wanted error would take minutes
        self.done("render", "ball.toml", "-o", "a.exr", "--camera", "A", "--size", "96x72", "--error", "0.005", "--solution", "a.h5")
        self.is_the_picture(0.03)

    def test_a_time_limit_in_the_solve(self):
        limited = ("render", "ball.toml", "-o", "a.exr", "--camera", "A", "--size", "96x72", "--time-limit", "0.001", "--json")
        report = json.loads(self.done(*limited))
        self.assertEqual(report["patches"], 0)
        self.assertEqual(self.is_the_picture(report["error"]["bound_95"])["earthshine:partial"], "no")
        start = time.monotonic()
        report = json.loads(self.done(*self.call, "--time-limit", "1", "--json"))
        self.assertEqual(report["patches"], 0)
        self.assertLess(time.monotonic() - start, 10)
        self.is_the_picture(report["error"]["bound_95"])


if __name__ == "__main__":
    unittest.main()
