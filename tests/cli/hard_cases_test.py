# SPDX-License-Identifier: Apache-2.0
"""Scenes on which an error estimate may fail: the bound holds, or the missing light is named."""
import math
import sys
import unittest

import program

sys.path.insert(0, str(program.TOP / "tests" / "validation"))
import error_truth  # noqa: E402
import hard_scenes  # noqa: E402


class HardCases(program.Case):
    def picture(self, hard, *options, name="out.exr"):
        """(report, luminances)."""
        self.write("hard.toml", hard.text)
        report = self.json("render", "hard.toml", "--error", "0.1", "-o", name, *options, code=(0, 3))
        return report, error_truth.picture(self.folder / name)[0]

    def references(self, hard, paths, size):
        """Luminances of two pictures of the path tracer."""
        self.write("hard.toml", hard.text)
        found = []
        for seed in (71, 72):
            self.done("render", "hard.toml", "--size", size, "--indirect", "paths", "--seed", seed,
                      "--set", f"quality.gather_rays={paths}", "-o", "paths.exr")
            found.append(error_truth.picture(self.folder / "paths.exr")[0])
        return found

    def holds(self, hard, paths, size="16x16"):
        """The true error of the picture, by two runs of the path tracer, is within the stated
        bound."""
        report, light = self.picture(hard, "--size", size)
        truth = error_truth.compare(light, *self.references(hard, paths, size))
        error = report["error"]
        # The standard error of the square includes the references' noise.
        self.assertLess(truth.error**2, error["bound_95"]**2 + 4 * truth.squared_error_std, (truth.error, error))
        self.assertLess(error["estimate"], error["bound_95"])
        return truth, error

    def test_a_small_emitter_that_form_factor_rays_would_miss(self):
        hard = hard_scenes.small_emitter()
        self.holds(hard, 256)
        self.mean_is_known(hard)

    def mean_is_known(self, hard):
        """The mean illuminance by conservation: the error of a mean is at most the RMS error, which
        is stated relative to the RMS, and the RMS is not smaller than the mean."""
        solved = self.json("solve", "hard.toml", "--error", "0.1", code=(0, 3))
        area = sum(thing["area_m2"] for thing in solved["objects"])
        mean = sum(thing["area_m2"] * thing["illuminance_lx"][1] for thing in solved["objects"]) / area
        self.assertLess(abs(mean / hard.mean - 1), max(solved["error"]["bound_95"], 1e-6))

    def test_an_emitter_that_form_factors_carry(self):
        self.holds(hard_scenes.wide_emitter(), 256)

    def test_a_small_spot_in_the_sun_lights_the_room(self):
        self.holds(hard_scenes.sun_spot(), 2048, "8x8")

    def test_a_room_lit_through_a_pinhole(self):
        """At most 3 of 8 pictures exceed their bound, which holds in 95 of 100 cases: more have a
        probability of 70 x 0.05^4 = 4e-4."""
        hard = hard_scenes.pinhole()
        references, passed = self.references(hard, 4096, "16x16"), 0
        for seed in range(1, 9):
            report, light = self.picture(hard, "--size", "16x16", "--seed", seed)
            truth, error = error_truth.compare(light, *references), report["error"]
            # The standard error of the square includes the references' noise.
            passed += truth.error**2 >= error["bound_95"]**2 + 4 * truth.squared_error_std
            self.assertLess(error["estimate"], error["bound_95"])
            # Light leaks along walls and floors must stay far below the light through the hole.
            self.assertLess(abs(truth.bias), 0.25 + 4 * math.sqrt(truth.squared_error_std))
        self.assertLess(passed, 4)

    def test_a_room_lit_through_a_pinhole_reaches_its_error(self):
        """Most samples find no light, so that the stated error rises repeatedly: about fifty
        rounds. The time limit ends the test if the rounds do not."""
        self.write("hard.toml", hard_scenes.pinhole().text)
        report = self.json("render", "hard.toml", "--error", "0.05", "--size", "12x12", "--time-limit", 300, "-o", "out.exr")
        self.assertLessEqual(report["error"]["estimate"], 0.05)

    def test_all_light_is_indirect(self):
        self.holds(hard_scenes.baffle(), 1024)

    def test_a_picture_of_one_pixel(self):
        """The error of one pixel exceeds its bound in one of twenty cases: in at most 7 of 40
        pictures (8 or more have a probability of 7e-4 if the bound is right, and of 0.8 if it is
        exceeded in one of four)."""
        hard = hard_scenes.one_pixel()
        self.write("hard.toml", hard.text)
        self.done("render", "hard.toml", "--size", "1x1", "--indirect", "paths", "--seed", 71, "--set", "quality.gather_rays=65536",
                  "-o", "paths.exr")
        truth = error_truth.picture(self.folder / "paths.exr")[0][0]
        passed = 0
        for seed in range(40):
            report, light = self.picture(hard, "--size", "1x1", "--seed", seed)
            passed += abs(light[0] / truth - 1) > report["error"]["bound_95"]
        self.assertLess(passed, 8)

    def test_next_to_nothing_to_see(self):
        truth, error = self.holds(hard_scenes.black_picture(), 256)
        self.assertLess(truth.mean, 1e-11)
        self.assertLess(error["bound_95"], 0.2)  # relative, as always

    def test_a_hundred_reflections(self):
        hard = hard_scenes.white_room()
        report, light = self.picture(hard)
        for value in light:
            self.assertAlmostEqual(value, hard.light, delta=1e-4 * hard.light)
        self.assertLess(report["error"]["estimate"], 1e-4)
        self.mean_is_known(hard)

    def test_a_hundred_reflections_of_a_lamp(self):
        hard = hard_scenes.lit_white_room()
        self.picture(hard)
        self.mean_is_known(hard)

    def test_a_target_in_full_shadow_is_less_sure_than_the_picture(self):
        hard = hard_scenes.shadowed_target()
        report, light = self.picture(hard, "--size", "48x48")
        target, = report["error"]["targets"]
        self.assertEqual(target["name"], hard.target)
        self.assertLess(target["luminance_cd_m2"], 0.2 * sum(light) / len(light))
        self.assertGreater(target["bound_95"], 2 * report["error"]["bound_95"])

    def test_a_caustic_is_named(self):
        report, _ = self.picture(hard_scenes.caustic())
        # Of 20000 lx the ball receives 1/4 of 1 m2, the floor 1/sqrt 2 of 16 m2 without the ball's
        # shadow: 0.9 pi/4 / (16 / sqrt 2).
        named, = report["error"]["not_captured"]
        self.says(named, "caustics", "curved mirrors")
        self.assertAlmostEqual(float(named.split("about ")[1].split(" %")[0]), 100 * 0.9 * math.pi / 4 / (16 / math.sqrt(2)), delta=1.0)
        report, _ = self.picture(hard_scenes.small_emitter(), "--size", "8x8")
        self.assertEqual(report["error"]["not_captured"], [])

    def test_nothing_to_state(self):
        for hard in (hard_scenes.sky_alone(), hard_scenes.no_light()):
            report, light = self.picture(hard, "--size", "8x8")
            self.assertEqual(max(light), 0)
            self.assertFalse(report["error"]["estimate"])
            self.assertFalse(report["error"]["bound_95"])


class Edges(program.Case):
    def test_no_pixel_of_the_bay_is_off_by_more_than_its_noise(self):
        """At the feet of walls and across facets of foil, light changes within a pixel. Without
        sharing between neighbours the stated error is pure noise, and the true error must equal it
        (four standard errors of its square)."""
        library = program.TOP / "scenes" / "library" / "sts46"
        (self.folder / "meshes").symlink_to(library / "meshes")
        self.write("bay.toml", (library / "day-sun.toml").read_text().replace("error = 0.05", "# error"))
        view = ("render", "bay.toml", "--camera", "B", "--size", "32x32", "-q")
        paths = []
        for seed in (71, 72):
            self.done(*view, "--indirect", "paths", "--set", "quality.gather_rays=1024", "--seed", seed, "-o", "paths.exr")
            paths.append(error_truth.picture(self.folder / "paths.exr")[0])
        keys = ("denoise=false", "gather_rays=1024", "camera_samples=256", "patch_edge=0.45", "form_factor_rays=64", "refine=false")
        settings = [word for key in keys for word in ("--set", f"quality.{key}")]
        stated = self.json(*view, *settings, "-o", "bay.exr")["error"]["estimate"]
        truth = error_truth.compare(error_truth.picture(self.folder / "bay.exr")[0], *paths)
        self.assertLess(abs(truth.error**2 - stated**2), 4 * truth.squared_error_std)


if __name__ == "__main__":
    unittest.main()
