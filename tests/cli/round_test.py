# SPDX-License-Identifier: Apache-2.0
"""Round bodies from coarse meshes: exact if the answer does not depend on the shape, else close to
the true sphere."""
import math
import unittest

import exr
import program


def sphere(segments, normals=True):
    """Latitudes and longitudes of the unit sphere, as OBJ."""
    rings = segments // 2
    points = [(0, 0, 1)] + [
        (math.sin(math.pi * j / rings) * math.cos(2 * math.pi * k / segments),
         math.sin(math.pi * j / rings) * math.sin(2 * math.pi * k / segments), math.cos(math.pi * j / rings))
        for j in range(1, rings) for k in range(segments)] + [(0, 0, -1)]

    def at(j, k):
        return 1 if j == 0 else len(points) if j == rings else 2 + (j - 1) * segments + k % segments
    text = "".join(f"v {x} {y} {z}\n" for x, y, z in points)
    if normals:
        text += "".join(f"vn {x} {y} {z}\n" for x, y, z in points)
    for j in range(rings):
        for k in range(segments):
            face = list(dict.fromkeys([at(j, k), at(j + 1, k), at(j + 1, k + 1), at(j, k + 1)]))
            text += "f " + " ".join(f"{i}//{i}" if normals else f"{i}" for i in face) + "\n"
    return text


SCENE = """format = 1
[[material]]
name = "m"
diffuse = 0.5
emit = {emit}
[[object]]
name = "ball"
mesh = "ball.obj"
material = "m"
{keys}
"""
SUN = """[sun]
direction = [0, -1, 0.5]
illuminance = 1000
angular_radius_deg = 0
[[camera]]
name = "A"
position = [0, -40, 0]
look_at = [0, 0, 0]
up = [0, 0, 1]
fov_deg = 3
resolution = [48, 48]
"""


class Round(program.Case):
    def test_a_furnace_stays_exact(self):
        # B = M / (1 - rho) in every closed room of any shape: L = 10 / 0.5 / pi.
        self.write("ball.obj", sphere(8, normals=False))
        self.write("room.toml", SCENE.format(emit=10, keys="inward = true\nsmooth_deg = 60\nround_deg = 15") + """
[[camera]]
name = "A"
position = [0.1, 0.2, 0]
look_at = [1, 0, 0]
resolution = [12, 12]
""")
        report = self.json("inspect", "room.toml")["objects"][0]
        self.assertGreater(report["triangles"], 400)
        self.assertEqual(report["surface"]["open_edges"], 0)
        self.done("render", "room.toml", "-o", "a.exr", "--no-error")
        for value in exr.read(self.folder / "a.exr")[3]["G"]:
            self.assertAlmostEqual(value / (20 / math.pi), 1.0, places=4)

    def picture(self, keys):
        """Mean difference from the true sphere, relative to its largest radiance."""
        self.write("ball.obj", sphere(16))
        self.write("ball.toml", SCENE.format(emit=0, keys=keys) + SUN)
        self.done("render", "ball.toml", "-o", "a.exr", "--indirect", "none", "--no-error")
        seen = exr.read(self.folder / "a.exr")[3]["G"]
        pixel = 40 * math.tan(math.radians(1.5)) / 24
        toward = (-1 / math.sqrt(1.25), 0.5 / math.sqrt(1.25))
        off = count = 0
        for y in range(48):
            for x in range(48):
                px, pz = (x + 0.5 - 24) * pixel, (24 - y - 0.5) * pixel
                if px * px + pz * pz > 0.8:  # pixels at the silhouette are mixtures
                    continue
                depth = -math.sqrt(1 - px * px - pz * pz)
                cosine = max(0.0, toward[0] * depth + toward[1] * pz)
                off += abs(seen[48 * y + x] - 500 / math.pi * cosine)
                count += 1
        return off / count / (500 / math.pi)

    def test_a_coarse_sphere_is_lit_like_the_true_one(self):
        flat, rounded = self.picture(""), self.picture("round_deg = 2")
        self.assertGreater(flat, 0.03)
        self.assertLess(rounded, 0.012)

    def test_what_does_not_go_is_refused(self):
        self.write("ball.obj", sphere(8, normals=False))
        self.write("ball.toml", SCENE.format(emit=1, keys="round_deg = 5"))
        self.says(self.refused("inspect", "ball.toml"), "ball.toml:10:1", "no vertex normals", "smooth_deg")
        self.write("ball.toml", SCENE.format(emit=1, keys="round_deg = 0.1"))
        self.says(self.refused("inspect", "ball.toml"), "round_deg", "0.25")


if __name__ == "__main__":
    unittest.main()
