# SPDX-License-Identifier: Apache-2.0
"""Gaps, steps and distances from 1 mm to 10 000 km: single precision near a surface matters, not
the scene's size."""
import math
import unittest

import exr
import program

MATERIALS = """format = 1
[[material]]
name = "w"
diffuse = 0.5
[[material]]
name = "panel"
diffuse = 0.5
emit = 1000
"""


def quad(name, material, corners):
    return f'[[object]]\nname = "{name}"\nshape = "quad"\nmaterial = "{material}"\ncorners = {corners}\n'


def box(name, low, high):
    return f'[[object]]\nname = "{name}"\nshape = "box"\nmaterial = "w"\nmin = {list(low)}\nmax = {list(high)}\n'


class Precision(program.Case):
    def test_a_gap_of_5_mm_beside_a_satellite(self):
        """Squares of 1 m, one of which emits 1000 lm/m2: F = 0.99012 by the closed form, E = 1000 F
        / (1 - 0.25 F^2) = 1312 lx on the other, to 0.1 % (uniform squares)."""
        gap = quad("lo", "panel", [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]) + quad(
            "hi", "w", [[0, 0, 0.005], [0, 1, 0.005], [1, 1, 0.005], [1, 0, 0.005]])
        for place in (None, (0, 0, 2000), (1200, -900, 1500), (8000, 5000, 3000)):
            far = "" if place is None else box("satellite", place, [x + 1.6 for x in place])
            self.write("s.toml", MATERIALS + gap + far)
            objects = {entry["name"]: entry for entry in self.json("solve", "s.toml", "--error", "0.02")["objects"]}
            self.assertAlmostEqual(objects["hi"]["illuminance_lx"][1], 1312, delta=30, msg=str(place))

    def test_the_shadow_of_a_step_of_1_mm(self):
        """h / tan 5 degrees = 11.43 mm. Pixels of 0.5 mm: 20 mm of the picture are left of the
        step."""
        for half in (1, 50, 5000):
            self.write("s.toml", MATERIALS + quad("plane", "w", [[-half, -half, 0], [half, -half, 0], [half, half, 0], [-half, half, 0]]) +
                       box("slab", (0, -0.5, 0), (0.5, 0.5, 0.001)) +
                       "[sun]\ndirection = [0.99619470, 0, 0.08715574]\nilluminance = 10000\nangular_radius_deg = 0\n"
                       '[[camera]]\nname = "A"\nposition = [-0.01, 0, 1]\nlook_at = [-0.01, 0, 0]\nup = [0, 1, 0]\n'
                       "fov_deg = 0.1145915\nresolution = [60, 4]\n")
            self.done("render", "s.toml", "-o", "o.exr", "--indirect", "none", "--no-error")
            _, width, _, channels = exr.read(self.folder / "o.exr")
            row = list(channels["G"])[:width]
            lit = max(row)
            shadow_mm = 0.5 * sum(1 - value / lit for value in row if value < 0.999 * lit)
            self.assertAlmostEqual(shadow_mm, 1 / math.tan(math.radians(5)), delta=0.25, msg=f"plane of {2 * half} m")

    def test_a_camera_far_away(self):
        """A field of 1 m at any distance: the same picture with both objects."""
        means = []
        for away in (10, 3e5, 1e7):
            self.write("s.toml", MATERIALS + quad("p", "w", [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]) +
                       box("cap", (-0.2, -0.2, 0.1), (0.2, 0.2, 0.15)) + "[sun]\ndirection = [0.3, 0.1, 1]\nilluminance = 1000\n"
                       f'[[camera]]\nname = "A"\nposition = [0, {-away * math.sqrt(0.5)}, {away * math.sqrt(0.5)}]\n'
                       f"look_at = [0, 0, 0]\nfov_deg = {2 * math.degrees(math.atan(0.5 / away))}\nresolution = [32, 32]\n")
            self.done("render", "s.toml", "-o", "o.exr", "--error", "0.01")
            values = list(exr.read(self.folder / "o.exr")[3]["G"])
            self.assertGreater(min(values), 0.0, away)
            means.append(sum(values) / len(values))
        for mean in means[1:]:
            self.assertAlmostEqual(mean, means[0], delta=0.02 * means[0])  # 10 m has visible perspective
        self.assertAlmostEqual(means[2], means[1], delta=0.005 * means[1])


if __name__ == "__main__":
    unittest.main()
