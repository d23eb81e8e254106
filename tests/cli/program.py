# SPDX-License-Identifier: Apache-2.0
"""Runs the built program in a temporary folder; small scenes of the tests."""
import json
import os
import pathlib
import subprocess
import tempfile
import unittest

PROGRAM = os.environ["EARTHSHINE_PROGRAM"]
TOP = pathlib.Path(__file__).resolve().parent.parent.parent

# A closed room: every patch has radiosity M / (1 - rho). Only the walls emit.
CLOSED_BOX = """format = 1
name = "closed box"
unit = "m"

[[material]]
name = "wall"
diffuse = 0.5
emit = 10.0

[[object]]
name = "room"
shape = "box"
min = [0, 0, 0]
max = [2, 2, 2]
inward = true
material = "wall"

[[camera]]
name = "inside"
position = [0.4, 0.5, 0.6]
look_at = [2, 2, 1.5]
up = [0, 0, 1]
fov_deg = 60
resolution = [24, 16]

[quality]
patch_edge = 0.5
form_factor_rays = 64
gather_rays = 16
"""

# 100 cd in all directions below, and a lamp with this light above the ball's floor.
EVEN_IES = """IESNA:LM-63-2002
[LUMINAIRE] even
TILT=NONE
1 1000 1 3 1 1 2 0.1 0.1 0
1 1 50
0 45 90
0
100 100 100
"""
IES_LAMP = """
[[light]]
name = "flood"
type = "ies"
file = "even.ies"
position = [0, 0, 2.5]
aim = [0, 0, 0]
"""

# A ball on a floor under a lamp and the Sun, open above: two light groups, shadows, a highlight.
BALL = """format = 1
name = "ball on a floor"
unit = "m"

[[material]]
name = "floor"
diffuse = [0.6, 0.5, 0.4]

[[material]]
name = "paint"
diffuse = [0.3, 0.4, 0.5]
specular = 0.3
shininess = 20

[[object]]
name = "floor"
shape = "quad"
corners = [[-2, -2, 0], [2, -2, 0], [2, 2, 0], [-2, 2, 0]]
material = "floor"

[[object]]
name = "ball"
shape = "sphere"
center = [0, 0, 0.7]
radius = 0.5
segments = 12
material = "paint"
target = true

[[light]]
name = "lamp"
type = "point"
position = [1.5, 0, 2]
intensity = [900, 800, 700]

[sun]
direction = [-0.3, 0.2, 1]
illuminance = 1000

[[camera]]
name = "A"
position = [3, -3, 2]
look_at = [0, 0, 0.4]
up = [0, 0, 1]
fov_deg = 40
resolution = [32, 24]

[[camera]]
name = "above"
position = [0, 0, 6]
look_at = [0, 0, 0]
up = [0, 1, 0]
fov_deg = 50
resolution = [20, 20]

[quality]
patch_edge = 0.5
form_factor_rays = 64
gather_rays = 16
"""


class Case(unittest.TestCase):
    """A test with a temporary folder, in which the program runs."""

    def setUp(self):
        self._folder = tempfile.TemporaryDirectory(prefix="earthshine cli ")  # with blanks
        self.addCleanup(self._folder.cleanup)
        self.folder = pathlib.Path(self._folder.name)

    def write(self, name, text):
        path = self.folder / name
        if isinstance(text, bytes):
            path.write_bytes(text)
        else:
            path.write_text(text, encoding="utf-8")
        return name

    def run_program(self, *arguments, timeout=600, **more):
        return subprocess.run([PROGRAM, *map(str, arguments)], cwd=self.folder, timeout=timeout,
                              stdin=subprocess.DEVNULL,
                              **({"capture_output": True, "text": True} | more))

    def done(self, *arguments, code=0):
        """Runs the program and returns standard output. Requires exit code `code`, a number or
        several: 0, or 3 (wanted error not reached)."""
        run = self.run_program(*arguments)
        self.assertIn(run.returncode, code if isinstance(code, tuple) else (code,), f"{arguments}: {run.stderr}")
        return run.stdout

    def json(self, *arguments, code=0):
        return json.loads(self.done(*arguments, "--json", code=code),
                          parse_constant=lambda word: self.fail(f"{word} in the JSON"))

    def refused(self, *arguments, code=2):
        """Runs the program. Requires the exit code, one message with the program's name, and no
        standard output."""
        run = self.run_program(*arguments)
        self.assertEqual(run.returncode, code, f"{arguments}: {run.stdout}{run.stderr}")
        self.assertEqual(run.stdout, "")
        message = run.stderr.strip()
        self.assertTrue(any(line.startswith("earthshine: ") for line in message.splitlines()), message)
        return message

    def work_memory(self, scene, mib):
        """--max-memory that leaves this much for the work, beyond plan's figure for the program."""
        of_program = self.json("plan", scene)["memory"]["parts_mib"]["program"]
        return "--max-memory", f"{of_program + mib:.2f}MiB"

    def says(self, message, *parts):
        for part in parts:
            self.assertIn(part, message)
