# SPDX-License-Identifier: Apache-2.0
"""The harness that judges stated errors (tests/validation/error_bounds.py): does it find a known error?"""
import math
import pathlib
import random
import sys
import unittest

import program

sys.path.insert(0, str(program.TOP / "tests" / "validation"))
import error_bounds  # noqa: E402
import error_scenes  # noqa: E402
import error_truth  # noqa: E402


def noisy(values, sigma, seed):
    chance = random.Random(seed)
    return [v + chance.gauss(0, sigma) for v in values]


class Truth(unittest.TestCase):
    def test_the_references_noise_drops_out(self):
        # L = R + 0.05: the products' mean is 0.05^2, their variance sigma^4 + 2 0.05^2 sigma^2.
        number, sigma, off = 40000, 0.1, 0.05
        truth = [1.0] * number
        found = error_truth.compare([v + off for v in truth], noisy(truth, sigma, 1), noisy(truth, sigma, 2))
        spread = math.sqrt((sigma**4 + 2 * off**2 * sigma**2) / number)
        self.assertLess(abs(found.error**2 - off**2), 4 * spread)
        self.assertAlmostEqual(found.doubt, spread, delta=0.05 * spread)
        self.assertAlmostEqual(found.bias, off, delta=4 * sigma / math.sqrt(2 * number))

    def test_only_pixels_that_count(self):
        found = error_truth.compare([3.0, 9.0], [2.0, 1.0], [2.0, 1.0], [1.0, 0.0])
        self.assertEqual((found.error, found.bias, found.mean), (0.5, 0.5, 2.0))

    def test_bright_pixels_count_in_proportion(self):
        # Mean (16 * 1 + 48) / 17 = 64 / 17, so that 48 counts with w = 4 (64 / 17) / 48 = 16 / 51: one of 17 squares is (8 w)^2.
        truth = [1.0] * 16 + [48.0]
        found = error_truth.compare(truth[:-1] + [56.0], truth, truth)
        mean, w = 64 / 17, 16 / 51
        self.assertAlmostEqual(found.error, math.sqrt((w * 8)**2 / 17) / mean, places=12)
        self.assertAlmostEqual(found.bias, 8 / 17 / mean, places=12)

    def test_every_room_is_the_same_everywhere(self):
        # Scenes are part of the published table: they must not move with a Python's random module.
        self.assertEqual(error_bounds.hash_of(*(error_scenes.room(n) for n in range(error_scenes.ROOMS)))[:16], ROOMS)


ROOMS = "bc08492c13b19c31"


class Harness(program.Case):
    def setUp(self):
        super().setUp()
        self.write("flood.ies", error_scenes.IES)
        self.bench = error_bounds.Bench(pathlib.Path(program.PROGRAM), self.folder, self.folder / "cache", 1)

    def test_radiosity_by_means_of_patches(self):
        # With M = 10 on every wall, rho 0.5 on all: B = 20 at each of the points, on patches of whatever size.
        import h5py
        self.write("box.toml", program.CLOSED_BOX)
        for name, edge in (("a.h5", 0.5), ("b.h5", 0.21)):
            self.bench.json("solve", "box.toml", "-o", name, "--set", f"quality.patch_edge={edge}")
        own = error_truth.Solution(self.folder / "a.h5")
        where, order = own.points(own.draw(100, 1), 2, 1)
        self.assertEqual(len(order), 100)
        for name in ("a.h5", "b.h5"):
            values = error_truth.Solution(self.folder / name).at(where)
            self.assertEqual(len(values), 400)
            self.assertLess(abs(values - 20).max(), 1e-4)
        # One that is brighter by 10 % everywhere.
        with h5py.File(self.folder / "a.h5", "a") as file:
            file["radiosity"][:] *= 1.1
        found = error_truth.compare_solutions(*(self.folder / name for name in ("a.h5", "b.h5", "b.h5")), patches=100)
        self.assertAlmostEqual(found.error, 0.1, places=5)

    def test_points_of_a_patch_are_the_patch_s(self):
        # The mean over a patch of the fine solution, read at points of that patch alone, is the area's mean of the fine patches
        # in it: of B = the number of the facet and side, exactly that.
        import h5py
        self.write("box.toml", program.CLOSED_BOX)
        for name, edge in (("a.h5", 0.5), ("b.h5", 0.21)):
            self.bench.json("solve", "box.toml", "-o", name, "--set", f"quality.patch_edge={edge}")
            solution = error_truth.Solution(self.folder / name)
            with h5py.File(self.folder / name, "a") as file:
                for k, (_, _, first, count) in enumerate(solution.sides()):
                    file["radiosity"][first:first + count] = k + 1
        found = error_truth.compare_solutions(*(self.folder / name for name in ("a.h5", "b.h5", "b.h5")), patches=200)
        self.assertGreater(found.mean, 1)
        self.assertAlmostEqual(found.error, 0, places=9)

    def test_an_emitter_in_the_picture_does_not_count(self):
        emitter = program.CLOSED_BOX.replace("emit = 10.0", "") + """
[[material]]
name = "panel"
diffuse = 0.2
emit = 50
[[object]]
name = "panel"
shape = "quad"
corners = [[1.9, 1.2, 0.8], [1.9, 1.9, 0.8], [1.9, 1.9, 1.4], [1.9, 1.2, 1.4]]
inward = true
material = "panel"
"""
        self.write("panel.toml", emitter)
        seen = self.bench.sources_seen(self.folder / "panel.toml", [])
        self.assertEqual(len(seen), 24 * 16)
        self.assertTrue(0 < sum(seen) < len(seen) / 2)

    def test_a_room_from_end_to_end(self):
        error_bounds.REFERENCE_GATHER, kept = 64, error_bounds.REFERENCE_GATHER
        self.addCleanup(setattr, error_bounds, "REFERENCE_GATHER", kept)
        case = ("room 5", error_scenes.room(5), ["--size", "24x24"], ["coarse patches"])
        rows = self.bench.rows(*case)
        self.assertEqual([row.kind for row in rows], ["solve", "picture"])
        for row in rows:
            self.assertTrue(0 < row.truth.error < 0.5, row)
            self.assertGreater(row.bound, row.estimate)
        stamp = [path.stat().st_mtime_ns for path in (self.folder / "cache").glob("*/*.h5")]
        self.assertEqual([row.truth.error for row in self.bench.rows(*case)], [row.truth.error for row in rows])
        self.assertEqual([path.stat().st_mtime_ns for path in (self.folder / "cache").glob("*/*.h5")], stamp)


if __name__ == "__main__":
    unittest.main()
