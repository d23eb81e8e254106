# SPDX-License-Identifier: Apache-2.0
"""render: pixels, layers, header, and equal bytes for equal seeds."""
import math
import resource
import unittest

import exr
import program


# A mirror ball above a floor, lit by a wide Sun.
CAUSTIC = """format = 1
[[material]]
name = "floor"
diffuse = 0.5
[[material]]
name = "mirror"
mirror = 1.0
[[object]]
name = "floor"
shape = "quad"
corners = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
material = "floor"
[[object]]
name = "ball"
shape = "sphere"
center = [0.5, 0.5, 0.5]
radius = 0.4
material = "mirror"
[sun]
direction = [1.0, 0.0, 0.3]
illuminance = 1000
angular_radius_deg = 10
[[camera]]
name = "above"
position = [0.5, -1, 1.5]
look_at = [0.5, 0.5, 0]
fov_deg = 40
resolution = [24, 24]
"""


class Render(program.Case):
    def setUp(self):
        super().setUp()
        self.write("box.toml", program.CLOSED_BOX)
        self.write("ball.toml", program.BALL)

    def render(self, scene, *options, name="out.exr"):
        self.assertEqual(self.done("render", scene, "-o", name, *options), "")
        return exr.read(self.folder / name)

    def bytes_of(self, scene, *options):
        self.done("render", scene, "-o", "bytes.exr", *options)
        return (self.folder / "bytes.exr").read_bytes()

    def test_closed_box_is_the_same_radiance_everywhere(self):
        # L = B / pi = 20 / pi in every direction.
        _, width, height, channels = self.render("box.toml")
        self.assertEqual((width, height), (24, 16))
        for name in "RGB":
            self.assertEqual(len(channels[name]), 24 * 16)
            for value in channels[name]:
                self.assertAlmostEqual(value, 20 / math.pi, places=4)

    def test_size_and_camera(self):
        header, width, height, channels = self.render("ball.toml", "--camera", "above", "--size", "10x6")
        self.assertEqual((width, height), (10, 6))
        self.assertEqual(header["earthshine:camera"], "above")
        self.assertTrue(all(math.isfinite(v) and v >= 0 for name in "RGB" for v in channels[name]))
        self.assertGreater(max(channels["R"]), 0)

    def test_layers_of_the_lights_sum_to_the_picture(self):
        _, _, _, channels = self.render("ball.toml", "--per-light")
        self.assertEqual({name for name in channels if name.startswith("light_")},
                         {f"light_{group}.{c}" for group in ("lamp", "sun") for c in "RGB"})
        for c in "RGB":
            for whole, lamp, sun in zip(channels[c], channels[f"light_lamp.{c}"], channels[f"light_sun.{c}"]):
                self.assertLessEqual(abs(whole - lamp - sun), 1e-6 * max(whole, 1e-3))

    def test_a_lamp_switched_off_leaves_the_other_layer(self):
        same = ("--set", "quality.denoise=false")  # denoising depends on the noise of all light
        both = self.render("ball.toml", "--per-light", *same)[3]
        sun = self.render("ball.toml", "--set", "light.lamp.intensity=0", *same)[3]
        for c in "RGB":
            for a, b in zip(both[f"light_sun.{c}"], sun[c]):
                self.assertLessEqual(abs(a - b), 1e-4 * max(a, b, 1e-3))

    def test_further_layers(self):
        _, _, _, channels = self.render("ball.toml", "--camera", "above", "--aov",
                                        "albedo,normal,position,depth,range,object,material")
        middle = 10 * 20 + 10  # near the axis: the top of the ball, 4.8 m below the camera
        self.assertAlmostEqual(channels["Z"][middle], 4.8, delta=0.1)
        self.assertGreaterEqual(channels["range"][middle], channels["Z"][middle])
        self.assertEqual(channels["object"][middle], 1)
        self.assertEqual(channels["material"][middle], 1)
        self.assertGreater(channels["N.Z"][middle], 0.8)
        self.assertAlmostEqual(channels["albedo.G"][middle], 0.4, places=5)
        self.assertAlmostEqual(channels["P.Z"][middle], 1.2, delta=0.1)

    def test_same_bytes_on_any_number_of_threads(self):
        one = self.bytes_of("ball.toml", "--per-light", "--aov", "depth", "-j", "1", "--seed", "9")
        self.assertEqual(one, self.bytes_of("ball.toml", "--per-light", "--aov", "depth", "-j", "2", "--seed", "9"))
        self.assertEqual(one, self.bytes_of("ball.toml", "--per-light", "--aov", "depth", "--seed", "9"))
        self.assertNotEqual(one, self.bytes_of("ball.toml", "--per-light", "--aov", "depth", "--seed", "10"))

    def test_same_bytes_with_and_without_the_other_pictures(self):
        self.assertEqual(self.bytes_of("ball.toml"), self.bytes_of("ball.toml", "--png", "a.png", "--json"))

    def test_header_says_where_the_picture_comes_from(self):
        header = self.render("ball.toml", "--seed", "18446744073709551615", "--error", "0.1",
                             "--set", "quality.gather_rays=4")[0]
        self.assertEqual(header["earthshine:scene"], "ball.toml")
        self.assertEqual(header["earthshine:seed"], "18446744073709551615")
        self.assertEqual(header["earthshine:indirect"], "radiosity")
        self.assertIn("quality.gather_rays=4", header["earthshine:set"])
        self.assertIn("quality.error=0.1", header["earthshine:set"])
        self.assertEqual(header["earthshine:gather_rays"], 4)
        self.assertGreater(header["earthshine:patches"], 0)
        self.assertLessEqual(header["earthshine:residual"], 1e-8)
        self.assertRegex(header["earthshine:version"], r"^\d+\.\d+\.\d+$")
        self.assertEqual(header["earthshine:camera.position_m"], "3 -3 2")
        self.assertAlmostEqual(header["earthshine:camera.fov_deg"], 40, places=4)
        self.assertEqual(header["whiteLuminance"], 1.0)
        self.assertFalse([name for name in header if "seconds" in name or "thread" in name])

    def test_timings_are_written_on_request(self):
        header = self.render("ball.toml", "--timings")[0]
        seconds = {name: value for name, value in header.items() if name.startswith("earthshine:seconds.")}
        self.assertIn("earthshine:seconds.render", seconds)
        self.assertIn("earthshine:seconds.read", seconds)
        self.assertTrue(all(value >= 0 for value in seconds.values()))

    def test_indirect_is_one_of_four_words(self):
        self.write("ball.toml", program.BALL)
        for how in ("1", "Radiosity", ""):
            self.says(self.refused("render", "ball.toml", "-o", "a.exr", "--indirect", how),
                      "radiosity, distributed, none, paths")

    def test_paths_agree_with_radiosity_and_carry_their_variance(self):
        radiosity = sum(self.render("ball.toml")[3]["G"])
        header, _, _, paths = self.render("ball.toml", "--indirect", "paths", "--per-light")
        self.assertEqual(header["earthshine:indirect"], "paths")
        # The tolerance of the sum is from the pixels' variances; patches add about 1 %.
        error = 4 * sum(paths["variance"]) ** 0.5 + 0.02 * radiosity
        self.assertLess(error, 0.1 * radiosity)
        self.assertAlmostEqual(sum(paths["G"]), radiosity, delta=error)
        self.assertIn("light_lamp.R", paths)

    def test_paths_refuse_what_they_do_not_have(self):
        self.write("ball.toml", program.BALL)
        for arguments, words in ((("--aov", "depth"), ("--aov", "--indirect paths")),
                                 (("--set", "quality.gather_rays=1"), ("1 paths", "2 or more"))):
            self.says(self.refused("render", "ball.toml", "-o", "a.exr", "--indirect", "paths", *arguments), *words)

    def test_paths_without_caustics_are_what_pictures_converge_to(self):
        self.write("caustic.toml", CAUSTIC)
        paths = ("--indirect", "paths", "--set", "quality.gather_rays=1024")

        def summed(*options):
            header, _, _, light = self.render("caustic.toml", *options)
            return header, sum(light["G"]), sum(light["variance"]) ** 0.5 if "variance" in light else 0.0
        _, everything, of_everything = summed(*paths)
        header, gathered, of_gathered = summed(*paths, "--no-caustics")
        shown, picture, _ = summed("--error", "0.02")
        # The ball reflects sunlight onto the floor: a quarter of all light, eighteen times the
        # noise of the paths.
        self.assertGreater(everything - gathered, 8 * math.hypot(of_everything, of_gathered))
        # The error of the mean is at most the RMS error of the pixels.
        bound = float(shown["earthshine:error.bound_95"])
        self.assertLess(abs(picture - gathered), 4 * of_gathered + bound * gathered)
        self.assertEqual(header["earthshine:caustics"], "no")
        self.assertIn("Sun", header["earthshine:error.not_captured"])
        self.says(self.refused("render", "caustic.toml", "-o", "a.exr", "--no-caustics"),
                  "--no-caustics", "belongs to --indirect paths, not radiosity")

    def test_indirect_light_adds(self):
        sums = {how: sum(self.render("ball.toml", "--indirect", how)[3]["G"])
                for how in ("none", "distributed", "radiosity")}
        self.assertGreater(sums["none"], 0)
        self.assertGreater(sums["radiosity"], sums["none"])
        # Lamp and Sun are small, so that the distributed lights equal the direct light.
        self.assertAlmostEqual(sums["distributed"] / sums["none"], 1, delta=0.02)

    def test_lights_over_an_area_stand_for_the_earth(self):
        # A plate of 2 m under a uniform Earth of half angle 60 degrees: L = rho L_earth sin^2 = 0.5 x 100 x 0.75.
        plate = program.BALL[program.BALL.index("[[object]]"):program.BALL.index("[[object]]\nname = \"ball\"")]
        area = '[[area]]\nname = "panel"\ncenter = [0, 0, 4]\nedge_u = [0, 9, 0]\nedge_v = [9, 0, 0]\n'
        earth = '[earth]\ndirection = [0, 0, 1]\nmodel = "uniform"\nradiance = 100\nhalf_angle_deg = 60\n'
        camera = '[[camera]]\nname = "A"\nposition = [0, 0, 1]\nlook_at = [0, 0, 0]\nup = [0, 1, 0]\nfov_deg = 1\n' \
                 'resolution = [4, 4]\n'
        material = '[[material]]\nname = "floor"\ndiffuse = 0.5\n'
        self.write("plate.toml", "format = 1\n" + material + plate + area + earth + camera)
        over = ("--indirect", "distributed", "--distributed-lights", "4096", "--distributed-over")
        header, _, _, channels = self.render("plate.toml", *over, "panel")
        self.assertEqual(header["earthshine:distributed_over"], "panel")
        self.assertAlmostEqual(sum(channels["G"]) / 16 / 37.5, 1, delta=2e-3)
        self.says(self.refused("render", "plate.toml", "-o", "a.exr", *over, "pannel"), "its areas are panel")
        self.says(self.refused("render", "plate.toml", "-o", "a.exr", *over, "panel", "--set",
                               "area.panel.center=[0,0,-4]"), "does not light")
        self.says(self.refused("render", "plate.toml", "-o", "a.exr", "--distributed-over", "panel"),
                  "--indirect distributed")
        flat = area.replace("[9, 0, 0]", "[0, 3, 0]")
        self.write("flat.toml", "format = 1\n" + material + plate + flat + earth + camera)
        self.says(self.refused("inspect", "flat.toml"), "edge_v", "not parallel")

    def test_what_cannot_fit_into_memory_is_refused_before_the_work(self):
        # 2^28 pixels of 9 channels are 9 GiB, and rendering needs several times as much; a limit of
        # the address space replaces a small machine.
        self.write("ball.toml", program.BALL)
        limit = 4 << 30
        def refused(*arguments):
            run = self.run_program(*arguments, timeout=60, preexec_fn=lambda: resource.setrlimit(
                resource.RLIMIT_AS, (limit, limit)))
            self.assertEqual(run.returncode, 1, run.stderr)
            self.assertFalse((self.folder / "big.exr").exists())
            return run.stderr
        self.says(refused("render", "ball.toml", "-o", "big.exr", "--size", "16384x16384", "--per-light"),
                  "needs about", "GiB (picture", "are free", "Lower --size")
        self.says(refused("solve", "ball.toml", "--set", "quality.max_patches=30000000"),
                  "form factors", "are free", "quality.max_patches")
        self.says(refused("form-factors", "ball.toml", "--method", "rays", "--set", "quality.patch_edge=0.0015",
                          "--set", "quality.form_factor_rays=4096"), "form factors", "are free")

    def test_report(self):
        report = self.json("render", "ball.toml", "-o", "a.exr")
        self.assertEqual((report["columns"], report["rows"]), (32, 24))
        self.assertGreater(report["rays"]["camera"], 0)
        self.assertGreater(report["peak_memory_mib"], 1)
        stages = self.run_program("render", "ball.toml", "-o", "a.exr").stderr
        self.says(stages, "read", "render", "total", "peak memory", "rays/s")
        self.assertEqual(self.run_program("render", "ball.toml", "-o", "a.exr", "-q", "--camera", "A").stderr, "")


if __name__ == "__main__":
    unittest.main()
