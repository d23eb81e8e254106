# SPDX-License-Identifier: Apache-2.0
"""Cameras by K and OpenCV's distortion: a pattern of discs is seen where the equations of OpenCV's documentation
(calib3d; fisheye) put it."""
import math
import unittest

import exr
import program

FX, FY, CX, CY = 150.0, 165.0, 83.0, 57.0  # of 160 x 120, from the picture's corner
POINTS = [(x, y) for x in (-0.8, 0.05, 0.7) for y in (-0.5, 0.1, 0.55)]  # m, at z = 2
RADIUS = 0.03  # m: 2.3 px

# Camera axes are those of the scene: x right, y down, z forward.
SCENE = """format = 1
[[material]]
name = "glow"
diffuse = 0
emit = 100
[[camera]]
name = "A"
position = [0, 0, 0]
look_at = [0, 0, 2]
up = [0, -1, 0]
resolution = [160, 120]
{lens}
[quality]
camera_samples = 256
"""


def scene(lens):
    text = SCENE.format(lens=lens)
    for k, (x, y) in enumerate(POINTS):
        text += (f'[[object]]\nname = "d{k}"\nshape = "disk"\ncenter = [{x}, {y}, 2]\nnormal = [0, 0, -1]\n'
                 f'radius = {RADIUS}\nmaterial = "glow"\n')
    return text


def brown_conrady(x, y, k1, k2, p1, p2, k3):
    r2 = x * x + y * y
    radial = 1 + k1 * r2 + k2 * r2**2 + k3 * r2**3
    return x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x), y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y


def fisheye(x, y, k1, k2, k3, k4):
    r = math.hypot(x, y)
    theta = math.atan(r)
    theta_d = theta * (1 + k1 * theta**2 + k2 * theta**4 + k3 * theta**6 + k4 * theta**8)
    return x * theta_d / r, y * theta_d / r


class Intrinsics(program.Case):
    def centroids(self, lens):
        """Of the light about each expected place; expected and found, px."""
        self.write("a.toml", scene(lens["text"]))
        self.done("render", "a.toml", "-o", "a.exr", "-q", *lens.get("call", ()))
        header, width, height, layers = exr.read(self.folder / "a.exr")
        green, scale = layers["G"], width / 160
        for x, y in POINTS:
            u, v = lens["map"](x / 2, y / 2)
            u, v = scale * (FX * u + CX), height / 120 * (FY * v + CY)
            sums = [0.0, 0.0, 0.0]
            for row in range(max(0, int(v) - 7), min(height, int(v) + 8)):
                for column in range(max(0, int(u) - 7), min(width, int(u) + 8)):
                    light = green[row * width + column]
                    for k, weight in enumerate((1, column + 0.5, row + 0.5)):
                        sums[k] += light * weight
            self.assertGreater(sums[0], 0)
            yield (u, v), (sums[1] / sums[0], sums[2] / sums[0]), header

    # A disc of radius r px, f px from the lens: distortion moves its centroid by at most (r/f)^2 / 8 times the Laplacian
    # of the distortion, 8 k x of k x r^2: here (2.3/150)^2 * 0.3 * 0.4 * 150 = 0.004 px. Noise: 256 samples a pixel.
    def is_seen(self, lens):
        for expected, found, _ in self.centroids(lens):
            self.assertLess(math.dist(expected, found), 0.02, (expected, found))

    def test_k(self):
        self.is_seen({"text": f"fx = {FX}\nfy = {FY}\ncx = {CX}\ncy = {CY}", "map": lambda x, y: (x, y)})

    def test_k_as_a_matrix_with_opencvs_pixels(self):
        self.is_seen({"text": f"K = [[{FX}, 0, {CX - 0.5}], [0, {FY}, {CY - 0.5}], [0, 0, 1]]\npixel_origin = \"center\"",
                      "map": lambda x, y: (x, y)})

    def test_brown_conrady(self):
        k = (-0.25, 0.08, 0.002, -0.003, -0.01)
        self.is_seen({"text": f"fx = {FX}\nfy = {FY}\ncx = {CX}\ncy = {CY}\ndistortion = {list(k)}",
                      "map": lambda x, y: brown_conrady(x, y, *k)})

    def test_fisheye(self):
        k = (0.05, -0.01, 0.003, -0.001)
        self.is_seen({"text": f"fx = {FX}\nfy = {FY}\ncx = {CX}\ncy = {CY}\nfisheye = {list(k)}",
                      "map": lambda x, y: fisheye(x, y, *k)})

    def test_another_size_scales_k(self):
        self.is_seen({"text": f"fx = {FX}\nfy = {FY}\ncx = {CX}\ncy = {CY}", "map": lambda x, y: (x, y),
                      "call": ("--size", "320x240")})

    def test_the_header_has_them(self):
        lens = {"text": f"fx = {FX}\nfy = {FY}\ncx = {CX}\ncy = {CY}\ndistortion = [-0.2, 0.05, 0, 0]", "map": lambda x, y: (x, y)}
        self.write("a.toml", scene(lens["text"]))
        self.done("render", "a.toml", "-o", "a.exr", "-q", "--size", "16x12")
        header = exr.read(self.folder / "a.exr")[0]
        k = [float(word) for word in header["earthshine:camera.K"].split()]
        for found, expected in zip(k, (FX / 10, 0, CX / 10, 0, FY / 10, CY / 10, 0, 0, 1)):
            self.assertAlmostEqual(found, expected, places=9)
        self.assertEqual(header["earthshine:camera.distortion"], "-0.2 0.05 0 0 0")

    def test_refusals(self):
        for lens, words in ((f"fx = {FX}\nfov_deg = 40", "fov_deg"), ("cx = 3", "without"), ("distortion = [1, 2]", "2 numbers"),
                            (f"fx = {FX}\ndistortion = [-3, 0, 0, 0]", "does not reach"), ("K = [1, 2, 3]", "no matrix"),
                            (f"fx = {FX}\nfisheye = [0, 0, 0, 0]\ndistortion = [0, 0, 0, 0]", "cannot be combined"),
                            (f"fx = {FX}\nfisheye = [0, 0, 0, 0]\naperture = 0.1\nfocus = 2", "aperture")):
            self.write("a.toml", scene(lens))
            self.says(self.refused("render", "a.toml", "-o", "a.exr"), "a.toml:", words)


if __name__ == "__main__":
    unittest.main()
