# SPDX-License-Identifier: Apache-2.0
"""A small scene along an orbit, a study file for it, and checks of result folders for tests of
studies."""
import json
import os
import re

import program
import study_table

# The monitor takes most of the time of a study of small pictures: a ninth of the resels, one pixel
# each.
SMALL_MONITOR = "[monitor]\nrows = 96\ncolumns = 128\npixels_per_resel = 1\n"

# A box on a floor under two lamps, along an orbit, with two cameras, one of them CCTV; another box
# outside both views.
BAY = """format = 1
name = "tiny bay"
unit = "m"

[[material]]
name = "white"
diffuse = 0.6

[[material]]
name = "paint"
diffuse = [0.3, 0.4, 0.5]

[[object]]
name = "floor"
shape = "quad"
corners = [[-2, -2, 0], [2, -2, 0], [2, 2, 0], [-2, 2, 0]]
material = "white"

[[object]]
name = "box"
shape = "box"
min = [-0.4, -0.4, 0]
max = [0.4, 0.4, 0.6]
material = "paint"
target = true

[[object]]
name = "far"
shape = "box"
min = [40, 40, 0]
max = [41, 41, 1]
material = "paint"
target = true

[[light]]
name = "left"
group = "bay"
type = "point"
position = [1.5, 0, 2]
intensity = [900, 800, 700]

[[light]]
name = "right"
group = "bay"
type = "point"
position = [-1.5, 0, 2]
intensity = 500

[sun]

[earth]

[orbit]
altitude_km = 425
attitude = "bay-to-space"

""" + SMALL_MONITOR + """
[[camera]]
name = "A"
position = [3, -3, 2]
look_at = [0, 0, 0.4]
up = [0, 0, 1]
fov_deg = 40
resolution = [48, 48]
cctv = "sit-monochrome"

[[camera]]
name = "B"
position = [0, 0, 6]
look_at = [0, 0, 0]
up = [0, 1, 0]
fov_deg = 50
resolution = [48, 48]

[quality]
patch_edge = 0.5
refine = false
form_factor_rays = 64
gather_rays = 16
"""

# Small, and seen by a camera without stages: for tests of files.
PLAIN_BAY = BAY.replace("[48, 48]", "[16, 16]").replace("sit-monochrome", "plain") + '\n[[cctv]]\nname = "plain"\n'

STUDY = """format = 1
name = "day and night"
scene = "bay.toml"
targets = ["box"]
size = "32x32"
wanted = ["box>=0.5"]
iris = ["fixed", "normal"]

[orbit]
positions_deg = [180, 0]

[[lamps]]
name = "on"

[[lamps]]
name = "right alone"
others = "off"
set = { right = 0.5 }

[[picture]]
name = "noon"
camera = "A"
position_deg = 0

[[picture]]
name = "few lights"
camera = "A"
position_deg = 0
shows = "distributed"
lights = 4

[[picture]]
name = "night"
camera = "A"
position_deg = 180
lamps = "right alone"
shows = "cctv"

[[pair]]
title = "both"
left = "noon"
right = "night"
"""

VERDICTS = {"identified", "recognised", "detected", "doubtful", "not-seen", "out-of-view", "hidden"}


class Case(program.Case):
    def setUp(self):
        super().setUp()
        self.write("bay.toml", BAY)
        self.write("s.toml", STUDY)

    def files(self, folder):
        return sorted(os.listdir(self.folder / folder))

    def all_files(self, folder):
        return sorted(str(path.relative_to(self.folder / folder)) for path in (self.folder / folder).rglob("*"))

    def study(self, folder):
        text = (self.folder / folder / "study.json").read_text(encoding="utf-8")
        return study_table.opened(json.loads(text, parse_constant=lambda word: self.fail(f"{word} in the JSON")))

    def printed(self, *call):
        return study_table.opened(self.json(*call))

    def no_nonsense(self, folder):
        """No NaN or infinity in any output."""
        for name in ("study.json", "results.csv", "report.html"):
            text = (self.folder / folder / name).read_text(encoding="utf-8")
            text = re.sub(r"<(script|style|svg)\b.*?</\1>", "", text, flags=re.S)
            text = re.sub(r"base64,[\w+/=]*", "", text)  # a picture's bytes may contain "+nan/"
            self.assertNotRegex(text, r"(?i)(?<![\w.-])-?(nan|inf|infinity)(?![\w-])", name)
        return self.study(folder)

    @staticmethod
    def without_times(study):
        """Values that must be equal in every run."""
        def strip(value):
            if isinstance(value, dict):
                return {key: strip(item) for key, item in value.items()
                        if key not in ("seconds", "render_seconds", "costs")}
            return [strip(item) for item in value] if isinstance(value, list) else value
        return strip(study)

    def costs(self, folder):
        return {cost["stage"]: cost["found"] for cost in self.study(folder)["costs"]}

    def refused_cleanly(self, *arguments, folder="d"):
        message = self.refused(*arguments, "-o", folder)
        self.assertEqual(len([line for line in message.splitlines() if line.startswith("earthshine: ")]), 1, message)
        self.assertFalse((self.folder / folder).exists(), f"{arguments}: {message}")
        return message
