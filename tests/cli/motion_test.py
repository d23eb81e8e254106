# SPDX-License-Identifier: Apache-2.0
"""Motion blur and rolling shutter: an edge that moves by v pixels during an exposure has a linear ramp of v pixels; a
rolling shutter shears an upright edge by line_s times its speed; a scene where nothing moves has the bytes of a still
one.

The camera is 2 m above the edge of a bright quad, with 64 px of focal length: 32 px per metre. The edge of the still
picture is at x = 32 px."""
import math
import unittest

import exr
import program

SCENE = """format = 1
[[material]]
name = "panel"
diffuse = 0
emit = 3141.592653589793
[[object]]
name = "left"
shape = "quad"
corners = [[-4, -4, 0], [0, -4, 0], [0, 4, 0], [-4, 4, 0]]
material = "panel"
{object}
[[light]]
name = "lamp"
type = "point"
position = [0, 0, 3]
intensity = 1
{light}
[[camera]]
name = "A"
position = [0, 0, 2]
look_at = [0, 0, 0]
up = [0, 1, 0]
fx = 64
resolution = [64, 64]
{camera}
"""
SURFACES = """
[[material]]
name = "grey"
diffuse = 0.5
[[object]]
name = "floor"
shape = "quad"
corners = [[-4, -4, -0.5], [4, -4, -0.5], [4, 4, -0.5], [-4, 4, -0.5]]
material = "grey"
[[object]]
name = "cube"
shape = "box"
min = [0.1, -0.3, -0.4]
max = [0.6, 0.3, -0.1]
material = "grey"
{cube}
"""
FULL = 1000.0  # cd/m2: exitance over pi


class Motion(program.Case):
    def picture(self, *, more="", quality=("--error", "0.05"), layers=(), name="out", **parts):
        self.write("a.toml", SCENE.format(**({"object": "", "camera": "", "light": ""} | parts)) + more)
        self.done("render", "a.toml", "-o", f"{name}.exr", "-q", *quality, *(("--aov", ",".join(layers)) if layers else ()))
        _, width, height, channels = exr.read(self.folder / f"{name}.exr")
        self.assertEqual((width, height), (64, 64))
        return channels

    def rows(self, channels, name="R"):
        return [channels[name][64 * y:64 * y + 64] for y in range(64)]

    def edge(self, row):
        """Where the edge is by the light in the row: exact for any blur inside of the picture."""
        return sum(row) / FULL

    def check_ramp(self, rows):
        """8 px: the share of the time in which pixel i is left of the edge, which goes from 28 to 36 px, is linear.
        Samples: 256 in a pixel, whose share has a standard error of at most 1/2 / 256^(1/2) = 0.031; four of them."""
        means = [sum(row[i] for row in rows) / (64 * FULL) for i in range(64)]
        for i, mean in enumerate(means):
            expected = min(1.0, max(0.0, (36 - (i + 0.5)) / 8))
            self.assertAlmostEqual(mean, expected, delta=4 * 0.5 / (256 * 64)**0.5 + 1e-3, msg=i)

    def test_a_moving_camera_makes_a_linear_ramp(self):
        samples = ("--set", "quality.camera_samples=256", "--no-error")
        self.check_ramp(self.rows(self.picture(camera="velocity = [0.25, 0, 0]\nexposure_s = 1", quality=samples)))
        # Half of the exposure at twice the speed is the same.
        self.check_ramp(self.rows(self.picture(camera="velocity = [-0.5, 0, 0]\nexposure_s = 0.5", quality=samples)))
        self.check_ramp(self.rows(self.picture(
            camera="velocity = [0.25, 0, 0]\nexposure_s = 1",
            quality=("--indirect", "paths", "--set", "quality.gather_rays=256", "--no-error"))))

    def test_a_moving_object_makes_a_linear_ramp(self):
        """8 instants a pixel apart, each with a box of a pixel: the ramp is exact but for samples."""
        samples = ("--set", "quality.camera_samples=2048", "--no-error")
        self.check_ramp(self.rows(self.picture(object="velocity = [0.25, 0, 0]", camera="exposure_s = 1", quality=samples)))
        # Relative motion counts: both move alike, and the edge stays sharp to the half pixel of an instant.
        still = self.rows(self.picture(object="velocity = [0.25, 0, 0]", quality=samples,
                                       camera="velocity = [0.25, 0, 0]\nexposure_s = 1"))
        for row in still:
            self.assertAlmostEqual(row[30], FULL, delta=1)
            self.assertAlmostEqual(row[33], 0, delta=1)

    def test_instants_are_a_pixel_apart_along_the_finer_side_of_pixels(self):
        """Pixels four times as high as wide: the motion of 8 px counts, not the 2 px that it would have upright."""
        self.check_ramp(self.rows(self.picture(
            object="velocity = [0.25, 0, 0]", camera="fy = 17\nexposure_s = 1",
            quality=("--set", "quality.camera_samples=2048", "--no-error"))))

    def test_a_moving_face_hides_the_face_that_it_lies_on(self):
        """A black floor in the plane of the panel: an emitter is in front of it, at each instant where it is then. The edge
        goes from 16 to 48 px."""
        floor = """
[[material]]
name = "black"
[[object]]
name = "floor"
shape = "quad"
corners = [[-4, -4, 0], [4, -4, 0], [4, 4, 0], [-4, 4, 0]]
material = "black"
"""
        row = self.rows(self.picture(object="velocity = [1, 0, 0]", camera="exposure_s = 1", more=floor,
                                     quality=("--set", "quality.camera_samples=256", "--no-error")))[32]
        self.assertAlmostEqual(row[8], FULL, delta=1)
        self.assertAlmostEqual(row[56], 0, delta=1)
        self.assertAlmostEqual(row[24], 0.75 * FULL, delta=0.05 * FULL)

    def test_a_rolling_shutter_shears(self):
        """32 px/s and 1/256 s a row: an eighth of a pixel a row, the middle of the picture in place. An edge is a share of
        a pixel with 64 samples: a standard error of at most 1/16 px, four of them 1/4; the mean over rows is
        nearer."""
        samples = ("--set", "quality.camera_samples=64", "--no-error")
        for order, sign in (("down", -1), ("up", 1)):
            rows = self.rows(self.picture(camera=f'velocity = [1, 0, 0]\nline_s = 0.00390625\nrow_order = "{order}"', quality=samples))
            off = [self.edge(row) - (32 + sign * (y - 31.5) / 8) for y, row in enumerate(rows)]
            self.assertLess(max(map(abs, off)), 0.25)
            self.assertLess(abs(sum(off)) / 64, 4 / 16 / 8)
        # An object: its instants are a pixel apart, so that rows are off by up to half a pixel.
        rows = self.rows(self.picture(object="velocity = [1, 0, 0]", camera="line_s = 0.00390625", quality=samples))
        off = [self.edge(row) - (32 + (y - 31.5) / 8) for y, row in enumerate(rows)]
        self.assertLess(max(map(abs, off)), 0.75)
        self.assertLess(abs(sum(off)) / 64, 4 / 16 / 8)
        # Exposure and readout: the same shear, each row's ramp has its middle there.
        rows = self.rows(self.picture(object="velocity = [1, 0, 0]", camera="line_s = 0.00390625\nexposure_s = 0.25", quality=samples))
        off = [self.edge(row) - (32 + (y - 31.5) / 8) for y, row in enumerate(rows)]
        self.assertLess(max(map(abs, off)), 0.75)
        self.assertLess(abs(sum(off)) / 64, 4 / 16 / 8)

    def test_spin(self):
        """A camera that turns about its axis by 10 degrees each way, row by row: the edge of row y is turned by
        the angle of its time. A quad that turns about a point of the edge looks the same, turned the other way."""
        samples = ("--set", "quality.camera_samples=64", "--no-error")
        camera = self.rows(self.picture(camera="spin = [0, 0, 20]\nline_s = 0.015625", quality=samples))
        quad = self.rows(self.picture(object="spin = [0, 0, -20]\nspin_about = [0, 0, 0]", camera="line_s = 0.015625", quality=samples))
        for y in range(64):
            angle = math.radians(20 * (y - 31.5) / 64)
            expected = 32 + (31.5 - y) * math.tan(angle)
            self.assertAlmostEqual(self.edge(camera[y]), expected, delta=0.3)
            self.assertAlmostEqual(self.edge(quad[y]), expected, delta=0.8)

    def test_what_does_not_move_has_the_bytes_of_a_still_picture(self):
        pictures = [self.picture(more=SURFACES.format(cube=""), camera=camera, quality=("--error", "0.1"))
                    for camera in ("", "exposure_s = 1\nline_s = 0.01", "velocity = [1, 0, 0]")]
        self.assertEqual(pictures[0], pictures[1])
        self.assertEqual(pictures[0], pictures[2])

    def test_a_picture_in_motion_agrees_with_all_light_paths(self):
        """Camera, cube and lamp move: with the residual and a solution for each instant the picture converges to the path
        tracer's. Means over 8 x 8 pixels of diffuse surfaces differ by less than 4 standard errors of the stated
        error (2 %, of the mean luminance of the picture) and the paths' (by their two halves)."""
        parts = {"camera": "velocity = [0.2, 0, 0]\nspin = [0, 0, 5]\nexposure_s = 1", "light": "velocity = [0, 0.5, 0]",
                 "more": SURFACES.format(cube="velocity = [0, 0.3, 0]\nspin = [0, 0, 20]")}
        own = self.picture(quality=("--error", "0.02"), **parts)
        paths = [self.picture(quality=("--indirect", "paths", "--set", "quality.gather_rays=256", "--no-error", "--seed", str(seed)), **parts)
                 for seed in (1, 2)]

        def tiles(rows):
            return [sum(rows[y][x] for y in range(ty, ty + 8) for x in range(tx, tx + 8)) / 64
                    for ty in range(0, 64, 8) for tx in range(48, 64, 8)]  # without the panel that shines
        found, first, second = (tiles(self.rows(one)) for one in (own, *paths))
        mean = sum(found) / len(found)
        noise = (sum((a - b)**2 for a, b in zip(first, second)) / len(first))**0.5 / 2
        for a, b, c in zip(found, first, second):
            self.assertLess(abs(a - (b + c) / 2), 4 * (noise + 0.02 * mean))

    def test_layers_are_of_the_middle_of_the_exposure(self):
        moving = self.picture(more=SURFACES.format(cube="velocity = [0.5, 0, 0]"), camera="exposure_s = 1", layers=("object", "depth"))
        still = self.picture(more=SURFACES.format(cube=""), layers=("object", "depth"))
        for layer in ("object", "Z"):
            self.assertEqual(moving[layer], still[layer])
        self.assertNotEqual(moving["R"], still["R"])

    def test_the_same_bytes_on_any_number_of_threads(self):
        for threads in ("1", "2"):
            self.picture(name=f"on-{threads}", more=SURFACES.format(cube="velocity = [0.1, 0, 0]"), camera="velocity = [0.1, 0, 0]\nexposure_s = 1",
                         quality=("--error", "0.2", "--threads", threads))
        self.assertEqual((self.folder / "on-1.exr").read_bytes(), (self.folder / "on-2.exr").read_bytes())

    def test_refusals(self):
        for camera, words in (("exposure_s = -1", ("exposure_s",)), ('row_order = "up"', ("row_order", "line_s")),
                              ('line_s = 1\nrow_order = "left"', ("row_order", "down"))):
            self.write("a.toml", SCENE.format(object="", light="", camera=camera))
            self.says(self.refused("render", "a.toml", "-o", "out.exr"), "a.toml", *words)
        self.write("a.toml", SCENE.format(object="velocity = [1, 0, 0]", light="", camera="exposure_s = 1"))
        self.done("solve", "a.toml", "-o", "a.h5", "-q")
        self.says(self.refused("render", "a.toml", "-o", "out.exr", "--solution", "a.h5", "--no-error"), "--solution", "moves")
        self.says(self.refused("render", "a.toml", "-o", "out.exr", "--part", "1/2", "--no-error"), "--part", "moves")


if __name__ == "__main__":
    unittest.main()
