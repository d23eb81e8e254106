# SPDX-License-Identifier: Apache-2.0
"""Control characters in names of files and objects, and a closed terminal."""
import csv
import io
import os
import subprocess
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


if __name__ == "__main__":
    unittest.main()
