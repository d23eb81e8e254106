# SPDX-License-Identifier: Apache-2.0
"""Tests that the validation of stated errors (tests/validation/error_bounds.py) finds a known
error."""
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
        # L = R + 0.05: the mean of the products is 0.05^2, their variance sigma^4 + 2 0.05^2
        # sigma^2.
        number, sigma, off = 40000, 0.1, 0.05
        truth = [1.0] * number
        found = error_truth.compare([v + off for v in truth], noisy(truth, sigma, 1), noisy(truth, sigma, 2))
        spread = math.sqrt((sigma**4 + 2 * off**2 * sigma**2) / number)
        self.assertLess(abs(found.error**2 - off**2), 4 * spread)
        self.assertAlmostEqual(found.squared_error_std, spread, delta=0.05 * spread)
        self.assertAlmostEqual(found.of_references, spread, delta=0.05 * spread)
        self.assertAlmostEqual(found.bias, off, delta=4 * sigma / math.sqrt(2 * number))

    def test_more_references_tell_it_better(self):
        # For k references, the mean over all pairs of (off + e)(off + e') has the variance 4 off^2
        # sigma^2 / k + 2 sigma^4 / (k (k - 1)).
        number, sigma, off, k = 10000, 0.1, 0.05, 6
        first, second, *more = (noisy([1.0] * number, sigma, seed) for seed in range(k))
        found = error_truth.compare([1.0 + off] * number, first, second, None, more)
        spread = math.sqrt((4 * off**2 * sigma**2 / k + 2 * sigma**4 / (k * (k - 1))) / number)
        self.assertLess(abs(found.error**2 - off**2), 4 * spread)
        self.assertAlmostEqual(found.squared_error_std, spread, delta=0.05 * spread)
        self.assertAlmostEqual(found.of_references, spread, delta=0.05 * spread)

    def test_what_pixels_differ_by_is_no_doubt_of_these(self):
        # A tenth of the pixels has the error o. As a sample, the mean square has the standard
        # deviation o^2 sqrt(0.09 / N), in addition to the references' noise of variance 4 (o^2 /
        # 10) s^2 / k + 2 s^4 / (k (k - 1)).
        number, sigma, off, k = 10000, 0.1, 0.5, 4
        light = [1.0 + off * (p % 10 == 0) for p in range(number)]
        first, second, *more = (noisy([1.0] * number, sigma, seed) for seed in range(k))
        found = error_truth.compare(light, first, second, None, more)
        spread = math.sqrt((0.4 * off**2 * sigma**2 / k + 2 * sigma**4 / (k * (k - 1))) / number)
        self.assertAlmostEqual(found.of_references, spread, delta=0.05 * spread)
        self.assertAlmostEqual(found.squared_error_std, math.sqrt(0.09 * off**4 / number + spread**2), delta=0.05 * found.squared_error_std)
        self.assertLess(abs(found.error**2 - off**2 / 10), 4 * spread)

    def test_an_outlier_is_no_certainty(self):
        # One of four references differs by d in one of 100 pixels: s^2 = d^2 / 4, and 2 s^4 / (4 *
        # 5) is the smallest uncertainty.
        truth, d = [1.0] * 100, 0.4
        found = error_truth.compare(truth, [1.0 + d, *truth[1:]], truth, None, [truth, truth])
        mean = 1.0 + d / 400
        self.assertAlmostEqual(found.of_references, (d**2 / 4) * math.sqrt(2 / 20) / 100 / mean**2, places=12)

    def test_only_pixels_that_count(self):
        found = error_truth.compare([3.0, 9.0], [2.0, 1.0], [2.0, 1.0], [1.0, 0.0])
        self.assertEqual((found.error, found.bias, found.mean), (0.5, 0.5, 2.0))

    def test_bright_pixels_count_in_proportion(self):
        # Mean (16 * 1 + 48) / 17 = 64 / 17, so that 48 has the weight w = 4 (64 / 17) / 48 = 16 /
        # 51: one of 17 squares is (8 w)^2.
        truth = [1.0] * 16 + [48.0]
        found = error_truth.compare(truth[:-1] + [56.0], truth, truth)
        mean, w = 64 / 17, 16 / 51
        self.assertAlmostEqual(found.error, math.sqrt((w * 8)**2 / 17) / mean, places=12)
        self.assertAlmostEqual(found.bias, 8 / 17 / mean, places=12)

    def test_pixels_about_a_source(self):
        seen = [0] * 12
        seen[0] = seen[11] = 1  # of 4 x 3: opposite corners
        self.assertEqual([int(near) for near in error_bounds.with_neighbours(seen, 4)], [1, 1, 0, 0, 1, 1, 1, 1, 0, 0, 1, 1])

    def test_what_is_asked_for_as_overrides(self):
        self.assertEqual(error_bounds.overrides(error_scenes.ASKED["error, 8 gather rays"]),
                         ["quality.error=0.05", "quality.gather_rays=8"])

    def test_every_room_is_the_same_everywhere(self):
        # The scenes are part of the published table: they must not depend on Python's random
        # module.
        self.assertEqual(error_bounds.hash_of(*(error_scenes.room(n) for n in range(error_scenes.ROOMS)))[:16], ROOMS)


ROOMS = "bc08492c13b19c31"


class Harness(program.Case):
    def setUp(self):
        super().setUp()
        self.write("flood.ies", error_scenes.IES)
        self.bench = error_bounds.Bench(pathlib.Path(program.PROGRAM), self.folder, self.folder / "cache", 1)

    def test_radiosities_of_solutions(self):
        # With M = 10 and rho 0.5 on every wall, B = 20 at each point for patches of any size.
        self.write("box.toml", program.CLOSED_BOX)
        solutions = []
        for name, edge in (("a.h5", 0.5), ("b.h5", 0.21)):
            knob = f"quality.patch_edge={edge}"
            self.bench.json("solve", "box.toml", "-o", name, "--seed", "3", "--set", knob)
            solutions.append([self.folder / name, 3, knob])
        found = error_truth.radiosities(self.bench.reader, self.folder / "box.toml", solutions, points=500)
        self.assertEqual([len(column) for column in found], [500, 500])
        self.assertLess(max(abs(value - 20) for column in found for value in column), 1e-4)
        # A solution that is 10 % brighter everywhere.
        brighter = ["--seed", "3", "--set", "quality.patch_edge=0.5", "--set", "material.wall.emit=11"]
        self.bench.json("solve", "box.toml", "-o", "c.h5", *brighter)
        solutions[0] = [self.folder / "c.h5", 3, "quality.patch_edge=0.5", "material.wall.emit=11"]
        first, second = error_truth.radiosities(self.bench.reader, self.folder / "box.toml", solutions, points=500)
        self.assertAlmostEqual(error_truth.compare(first, second, second).error, 0.1, places=5)
        # A solution with other settings is refused.
        with self.assertRaises(RuntimeError):
            error_truth.radiosities(self.bench.reader, self.folder / "box.toml", [[self.folder / "a.h5", 4, "quality.patch_edge=0.5"]])

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
        error_bounds.REFERENCE_PATHS, kept = 64, error_bounds.REFERENCE_PATHS
        self.addCleanup(setattr, error_bounds, "REFERENCE_PATHS", kept)
        case = ("room 5", error_scenes.room(5), ["--size", "24x24"], ["coarse patches"])
        rows = self.bench.rows(*case)
        self.assertEqual([row.kind for row in rows], ["solve", "picture"])
        for row in rows:
            self.assertTrue(0 < row.truth.error < 0.5, row)
            self.assertGreater(row.bound, row.estimate)
        stamp = [path.stat().st_mtime_ns for path in (self.folder / "cache").glob("*/*")]
        self.assertEqual([row.truth.error for row in self.bench.rows(*case)], [row.truth.error for row in rows])
        self.assertEqual([path.stat().st_mtime_ns for path in (self.folder / "cache").glob("*/*")], stamp)

    def test_references_are_drawn_until_they_tell(self):
        # A picture with the error 0.01, references with the deviation 0.3. With k references the
        # square, 1e-4, has the standard error sqrt((4e-4 0.09 / k + 2 0.0081 / (k (k - 1))) / N).
        # It must be at most a tenth of 2 0.01 0.002, for a bound of 0.02. With N = 10 000 it is
        # 1.6e-4 for 8, 7.5e-5 for 16 and 3.7e-5 for 32, the first one below 4e-5.
        number, sigma = 10000, 0.3
        asked = []

        def pictures(_folder, _path, _more, count):
            asked.append(count)
            return [noisy([1.0] * number, sigma, seed) for seed in range(count)]
        self.bench.pictures = pictures
        self.write("seen", str([0] * number))
        self.addCleanup(setattr, error_truth, "picture", error_truth.picture)
        self.addCleanup(setattr, error_truth, "columns", error_truth.columns)
        error_truth.picture = lambda *_: (None, [0.0] * number)
        error_truth.columns = lambda _: 100
        found, = self.bench.true_errors(self.folder, None, [], [([1.01] * number, 0.02)])
        self.assertEqual(asked, [2, 4, 8, 16, 32])
        self.assertLess(abs(found.error**2 - 1e-4), 4 * 3.7e-5)
        asked.clear()
        self.bench.true_errors(self.folder, None, [], [([1.01] * number, 1.0)])
        self.assertEqual(asked, [2])


if __name__ == "__main__":
    unittest.main()
