# SPDX-License-Identifier: Apache-2.0
"""--error: the program continues until its estimate reaches the error, or names the limit that came
first."""
import unittest

import exr
import program

# The ball's scene without settings: the program chooses patches, rays and samples.
OPEN = program.BALL.split("[quality]")[0]


class WantedError(program.Case):
    def rendered(self, *options, scene=OPEN, code=0):
        self.write("scene.toml", scene)
        return self.json("render", "scene.toml", "-o", "out.exr", "--size", "48x36", *options, code=code)["error"]

    def test_the_estimate_ends_within_the_wanted_error(self):
        for wanted in (0.2, 0.05, 0.02):
            error = self.rendered("--error", wanted)
            self.assertEqual(error["wanted"], wanted)
            self.assertIsNone(error["limit"], error)
            self.assertLessEqual(error["estimate"], wanted)
            self.assertGreater(error["estimate"], 0)
            self.assertEqual(error["steps"][0]["stage"], "solve")
            self.assertEqual(error["steps"][-1]["stage"], "picture")
            self.assertEqual(error["steps"][-1]["estimate"], error["estimate"])

    def test_less_error_takes_more_rays(self):
        self.write("scene.toml", OPEN)
        cast = []
        for wanted in (0.2, 0.02):
            rays = self.json("render", "scene.toml", "-o", "out.exr", "--size", "48x36", "--error", wanted)["rays"]
            cast.append(sum(count for count in rays.values() if isinstance(count, int)))
        self.assertGreater(cast[1], 1.5 * cast[0])  # with those of the solve, 16 rays per patch for
                                                    # either error

    def test_parts_add_up_in_squares(self):
        error = self.rendered("--error", 0.05)
        squares = sum(part["estimate"]**2 for part in error["parts"].values())
        self.assertAlmostEqual(squares**0.5, error["estimate"], places=9)
        self.assertGreaterEqual(error["bound_95"], error["estimate"])

    def test_given_settings_win(self):
        fixed = OPEN + "[quality]\nerror = 0.001\npatch_edge = 1\nform_factor_rays = 16\n"
        error = self.rendered(scene=fixed)
        self.assertEqual([step["form_factor_rays"] for step in error["steps"] if step["stage"] == "solve"], [16])
        self.assertIsNone(error["limit"])  # the picture compensates for errors of the solution
        self.assertLessEqual(error["estimate"], 0.001)

    def test_of_paths_the_rays_that_are_set_win_and_are_named(self):
        few = ("--set", "quality.gather_rays=4", "--indirect", "paths")
        self.write("scene.toml", OPEN)
        report = self.json("render", "scene.toml", "-o", "out.exr", "--size", "48x36", "--error", 0.001, *few, code=3)
        error = report["error"]
        self.assertEqual(error["limit"], "settings")
        # The error of the mean of n paths falls as sqrt(1 / n); the sampling stage takes at least
        # the time of sampling.
        self.assertGreater(error["seconds_to_go"], 0)
        self.assertLessEqual(error["seconds_to_go"],
                             report["seconds"]["render"] * ((error["estimate"] / 0.001) ** 2 - 1))
        self.assertEqual(self.rendered("--error", 1, *few)["limit"], None)
        run = self.run_program("render", "scene.toml", "-o", "out.exr", "--size", "48x36", "--error", 0.001, *few)
        self.assertIn("quality.gather_rays as are set (--indirect paths)", run.stderr)
        # A scene's own wanted error does not change the exit code.
        fixed = self.rendered(*few, scene=OPEN + "[quality]\nerror = 0.001\n")
        self.assertEqual(fixed["limit"], "settings")

    def test_a_time_limit_comes_first_and_is_named(self):
        # 0.7 s reach 0.0005 on two cores; this takes thousands of times as long.
        error = self.rendered("--error", 0.00001, "--time-limit", 0.7, code=3)
        self.assertEqual(error["limit"], "time")
        self.assertGreater(error["estimate"], 0.00001)
        self.assertGreater(error["seconds_to_go"], 0)
        run = self.run_program("render", "scene.toml", "-o", "out.exr", "--size", "48x36", "--error", 0.00001,
                               "--time-limit", 0.7)
        self.assertRegex(run.stderr, r"not reached: --time-limit came first; it needs about [\d.]+ \w+.* more")

    def test_memory_comes_first_and_is_named(self):
        self.write("scene.toml", OPEN)
        error = self.json("solve", "scene.toml", "--error", 0.002, *self.work_memory("scene.toml", 4.8), code=3)["error"]
        self.assertEqual(error["limit"], "memory")
        self.assertGreater(error["estimate"], 0.002)

    def test_work_that_cannot_fit_at_all_is_refused(self):
        self.write("scene.toml", OPEN)
        message = self.refused("solve", "scene.toml", "--error", 0.1, "--max-memory", "3MiB", code=1)
        self.says(message, "3 MiB are allowed by --max-memory", "Lower quality.max_patches")

    def test_a_solve_alone_reaches_it_and_serves_pictures(self):
        self.write("scene.toml", OPEN)
        error = self.json("solve", "scene.toml", "--error", 0.1, "-o", "light.h5")["error"]
        self.assertIsNone(error["limit"], error)
        self.assertLessEqual(error["estimate"], 0.1)
        picture = self.json("render", "scene.toml", "--error", 0.1, "--solution", "light.h5", "-o", "out.exr",
                            "--size", "48x36")["error"]
        self.assertLessEqual(picture["estimate"], 0.1)

    def test_the_same_bytes_on_any_number_of_threads(self):
        pictures = []
        for threads in (1, 2):
            self.rendered("--error", 0.05, "-j", threads)
            pictures.append((self.folder / "out.exr").read_bytes())
        self.assertEqual(*pictures)

    def test_light_layers_add_up_in_pictures_that_were_blended(self):
        self.rendered("--error", 0.02, "--per-light")
        _, _, _, channels = exr.read(self.folder / "out.exr")
        for c in "RGB":
            layers = [values for name, values in channels.items() if name.startswith("light_") and name.endswith(c)]
            self.assertGreater(len(layers), 1)
            for total, *parts in zip(channels[c], *layers):
                self.assertLessEqual(abs(total - sum(parts)), 1e-6 * abs(total))

    def test_a_crop_is_drawn_once_with_the_first_settings(self):
        error = self.rendered("--error", 0.05, "--crop", "10,8,16x12")
        self.assertEqual([step["stage"] for step in error["steps"]].count("picture"), 1)

    def test_nothing_lit_has_no_error(self):
        dark = OPEN.replace("illuminance = 1000", "illuminance = 0").replace("[900, 800, 700]", "[0, 0, 0]")
        error = self.rendered("--error", 0.02, scene=dark)
        self.assertIsNone(error["estimate"])
        self.assertIsNone(error["limit"])

    def test_sizes_of_memory_are_read_strictly(self):
        self.write("scene.toml", OPEN)
        for size in ("", "12", "12KiB", "-1GiB", "nanGiB", "1e99GiB", "2 GiB"):
            message = self.refused("render", "scene.toml", "-o", "out.exr", "--max-memory", size)
            self.says(message, "--max-memory")


    def test_a_small_picture_full_of_edges(self):
        report = self.json("render", program.TOP / "scenes/library/sts46/day-earthshine.toml", "--camera", "A", "--size", "64x64",
                           "--indirect", "none", "--error", "0.04", "-o", "bay.exr")
        error = report["error"]
        self.assertIsNone(error["limit"])
        self.assertLess(error["estimate"], 0.04)


if __name__ == "__main__":
    unittest.main()
