# SPDX-License-Identifier: Apache-2.0
"""Control characters in names of files and objects, and a closed terminal."""
import csv
import fcntl
import io
import os
import pty
import re
import struct
import subprocess
import termios
import time
import unittest

import exr
import program

EVIL = "\x1b]0;owned\x07\x1b[31m\u202egnp\u009b2J"
FORBIDDEN = [chr(c) for c in range(32) if c not in (9, 10)] + ["\x7f", "\u009b", "\u202e", "\u2066", "\u200f"]


class Terminal(program.Case):
    def setUp(self):
        super().setUp()
        self.write("ball.toml", program.BALL)

    def clean(self, *call, shows="", codes=(0, 1, 2)):
        run = self.run_program(*call, text=False)
        self.assertIn(run.returncode, codes, run.stderr)
        for stream in (run.stdout, run.stderr):
            text = stream.decode("utf-8")  # strict
            for letter in FORBIDDEN:
                self.assertNotIn(letter, text, f"{call}: {stream!r}")
        said = (run.stdout + run.stderr).decode("utf-8")
        self.assertIn(shows, said)
        return said

    def test_words_of_the_call(self):
        for call in (["render", "ball.toml", "-o", "a.exr", "--camera", EVIL], ["inspect", EVIL], [EVIL],
                     ["inspect", "ball.toml", "--" + EVIL], ["inspect", "ball.toml", "--set", EVIL],
                     ["inspect", "ball.toml", "--set", f"name={EVIL}"], ["solve", "ball.toml", "-o", f"{EVIL}/a"],
                     ["degrade", EVIL, "-o", "a.png"], ["fit-phong", EVIL], ["report", EVIL],
                     ["degrade", "--describe", EVIL]):
            self.clean(*call, codes=(2,), shows="\\x1b]0;owned\\x07")
        self.clean("inspect", b"caf\xe9.toml", codes=(2,), shows="caf\\xe9.toml")

    def test_names_in_scenes(self):
        scene = program.BALL.replace('name = "ball"', 'name = "red\\u202e\\u009b31m"')
        self.write("evil.toml", scene)
        for command in ("inspect", "solve", "form-factors"):
            self.clean(command, "evil.toml", codes=(0,), shows="red\\u202e\\u009b31m")
        found = self.json("inspect", "evil.toml")
        self.assertIn("red\u202e\u009b31m", [o["name"] for o in found["objects"]])  # unescaped
        self.assertNotIn("\u202e", self.done("inspect", "evil.toml", "--json"))

    def test_names_in_meshes(self):
        self.write("a.mtl", f"newmtl {EVIL}\nKd 0.5 0.5 0.5\n{EVIL} 1 2\n")
        self.write("a.obj", f"mtllib a.mtl\no {EVIL}\n{EVIL}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl {EVIL}\nf 1 2 3\n")
        self.write("a.toml", program.BALL + '\n[[object]]\nname = "it"\nmesh = "a.obj"\n')
        self.clean("inspect", "a.toml", codes=(0,))
        self.write("a.toml", program.BALL + '\n[[object]]\nname = "it"\nmesh = "a.obj"\npart = "x"\n')
        self.clean("inspect", "a.toml", codes=(2,), shows="owned")
        self.write("a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl caf\xe9\nf 1 2 3\n")
        self.write("a.toml", program.BALL + '\n[[object]]\nname = "it"\nmesh = "a.obj"\n')
        self.clean("inspect", "a.toml", codes=(2,), shows="caf\\xe9")

    def test_cells_and_channels(self):
        self.write("a.csv", f"0,1\n{EVIL},2\n")
        self.clean("fit-phong", "a.csv", codes=(2,), shows="owned")
        self.write("a.exr", exr.pack(2, 2, {EVIL.replace(".", ""): 1}))
        self.clean("degrade", "a.exr", "-o", "a.png", codes=(2,), shows="owned")
        self.clean("relight", "a.exr", "-o", "b.exr", codes=(2,))

    def test_cells_that_a_spreadsheet_would_run(self):
        names = {"=1+2": "'=1+2", "@SUM(A1)": "'@SUM(A1)", "+cmd|x": "'+cmd|x", "-cmd": "'-cmd", "-12.5": "-12.5", "+3": "+3",
                 "a=b": "a=b"}
        for name, cell in names.items():
            self.write("ball.toml", program.BALL.replace('name = "ball"', f'name = "{name}"'))
            rows = list(csv.DictReader(io.StringIO(self.done("form-factors", "ball.toml", "--csv"))))
            self.assertEqual(rows[1]["to"], cell)
        self.write("ball.toml", program.BALL.replace('name = "ball"', 'name = "=1+2"'))
        self.done("study", "visibility", "ball.toml", "-o", "v", "--size", "16x16")
        with open(self.folder / "v/results.csv", newline="", encoding="utf-8") as file:
            self.assertEqual({row["target"] for row in csv.DictReader(file)}, {"'=1+2"})

    def test_notes_that_nobody_takes(self):
        """`render 2>&1 | head -1`: the work is done, and the exit code shows that output was lost.
        """
        read_end, write_end = os.pipe()
        os.close(read_end)
        run = self.run_program("render", "ball.toml", "-o", "a.exr", capture_output=False,
                               stdout=write_end, stderr=write_end)
        self.assertEqual(run.returncode, 1)
        self.assertTrue((self.folder / "a.exr").exists())
        run = self.run_program("render", "none.toml", "-o", "a.exr", capture_output=False,
                               stdout=subprocess.DEVNULL, stderr=write_end)
        os.close(write_end)
        self.assertEqual(run.returncode, 2)


class AtTerminal(program.Case):
    """Both streams are a terminal, which wraps lines where the program does not."""

    def on_terminal(self, columns, *call):
        """What the program wrote, as (seconds since its start, text)."""
        command = [program.PROGRAM, *call]
        start = time.monotonic()
        child, screen = pty.fork()
        if child == 0:
            try:
                fcntl.ioctl(1, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
                os.chdir(self.folder)
                os.execv(command[0], command)
            finally:
                os._exit(127)
        written = []
        while True:
            try:
                data = os.read(screen, 1 << 16)
            except OSError:  # the child closed its end
                break
            if not data:
                break
            written.append((time.monotonic() - start, data.decode()))
        os.close(screen)
        self.assertEqual(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), 0, written)
        return written

    def lines(self, columns, *call):
        """Those that stay, without the progress line."""
        text = "".join(text for _, text in self.on_terminal(columns, *call))
        return [re.split(r"\x1b\[2K", line.rstrip("\r"))[-1].lstrip("\r") for line in text.split("\n")]

    def test_results_and_notes_wrap_between_words(self):
        self.write("ball.toml", program.BALL)
        narrow = self.lines(50, "render", "ball.toml", "-o", "a.exr", "--size", "16x16", "--error", "0.3")
        self.assertLessEqual(max(map(len, narrow)), 50)
        self.says(" ".join(" ".join(narrow).split()), "gather rays and", "camera samples a pixel; noise")
        for call in (("inspect", "ball.toml"), ("plan", "ball.toml"), ("solve", "ball.toml")):
            wide, narrow = self.lines(400, *call), self.lines(50, *call)
            self.assertLessEqual(max(len(line) for line in narrow if " " in line.strip()), 50, call)
            longest = max(wide, key=len)
            self.assertIn(longest.split()[-1], " ".join(narrow).split())  # no word is cut

    def test_json_is_not_wrapped(self):
        self.write("ball.toml", program.BALL)
        self.assertEqual(self.lines(40, "inspect", "ball.toml", "--json"), self.lines(400, "inspect", "ball.toml", "--json"))

    def test_each_camera_is_named_with_its_file(self):
        self.write("ball.toml", program.BALL)
        text = self.run_program("render", "ball.toml", "--camera", "all", "-o", "a.exr", "--png", "b.png", "--size", "16x16").stderr
        self.says(text, "camera A: a-A.exr, b-A.png\n", "camera above: a-above.exr, b-above.png\n")
        self.assertEqual(text.count("form factors"), 1)  # which serve both

    def progress(self, columns, *call):
        """(seconds, share, seconds to go) of each drawing of the progress line, and its longest."""
        drawn, longest = [], 0
        for seconds, text in self.on_terminal(columns, *call):
            for line in re.findall(r"[^\r\n\x1b]* s, about [^\r\n\x1b]* to go", text):
                line = re.sub(r"^\[2K", "", line)
                longest = max(longest, len(line))
                share, rest = re.search(r"(\d+) % .* about (.*) to go", line).groups()
                units = {"h": 3600, "min": 60, "s": 1}
                drawn.append((seconds, int(share), sum(int(n) * units[u] for n, u in re.findall(r"(\d+) (h|min|s)", rest))))
        return drawn, longest

    def test_progress_of_several_pictures_never_falls(self):
        long_name = "a-long-name-" * 12 + ".toml"
        self.write(long_name, program.BALL)
        for columns, call in ((60, ("render", long_name, "--camera", "all", "-o", "a.exr", "--size", "48x48", "--error", "0.01")),
                              (60, ("study", "visibility", long_name, "-o", "v", "--size", "48x48", "--error", "0.03"))):
            drawn, longest = self.progress(columns, *call)
            shares = [share for _, share, _ in drawn]
            self.assertTrue(drawn)
            self.assertEqual(shares, sorted(shares))
            self.assertLess(longest, columns)


if __name__ == "__main__":
    unittest.main()
