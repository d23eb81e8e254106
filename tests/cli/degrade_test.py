# SPDX-License-Identifier: Apache-2.0
"""degrade: the CCTV stage for pictures by render."""
import math
import unittest

import exr
import program
from tiny_bay import SMALL_MONITOR

# The monitor takes most of the time in these cases.
SMALL = '[[cctv]]\nname = "small"\npreset = "sit-monochrome"\n\n' + SMALL_MONITOR


class Degrade(program.Case):
    def setUp(self):
        super().setUp()
        self.write("ball.toml", program.BALL.replace('name = "above"', 'name = "above"\ncctv = "ccd-colour"') + "\n" + SMALL_MONITOR)
        self.write("small.toml", SMALL)

    def picture(self, name):
        return (self.folder / name).read_bytes()

    def test_alone_is_the_same_as_within_render(self):
        self.done("render", "ball.toml", "-o", "a.exr", "--camera", "above", "--cctv", "whole.png", "--seed", 4)
        # The header of the picture names the camera.
        self.done("degrade", "a.exr", "-o", "alone.png", "--scene", "ball.toml", "--seed", 4)
        self.assertEqual(self.picture("whole.png"), self.picture("alone.png"))
        self.done("degrade", "a.exr", "-o", "other.png", "--scene", "ball.toml", "--camera", "A", "--seed", 4)
        self.assertNotEqual(self.picture("whole.png"), self.picture("other.png"))

    def test_same_seed_and_frame_same_bytes_on_any_number_of_threads(self):
        self.done("render", "ball.toml", "-o", "a.exr")

        def run(*options):
            self.done("degrade", "a.exr", "-o", "c.png", "--cctv", "small.toml", *options)
            return self.picture("c.png")

        one = run("-j", "1")
        self.assertEqual(one, run("-j", "2"))
        self.assertEqual(one, run("--frame", "0", "--seed", "1"))
        self.assertNotEqual(one, run("--frame", "1"))
        self.assertNotEqual(one, run("--seed", "2"))

    def test_report(self):
        self.done("render", "ball.toml", "-o", "a.exr")
        report = self.json("degrade", "a.exr", "-o", "c.png")
        self.assertEqual(report["camera"], "sit-monochrome")
        self.assertEqual(report["sensor"], [400, 300])
        self.assertGreater(report["f_number"], 0)
        self.assertIn("no --preset", self.run_program("degrade", "a.exr", "-o", "c.png").stderr)

    def test_a_stage_left_out(self):
        self.done("render", "ball.toml", "-o", "a.exr")
        stages = self.json("degrade", "a.exr", "-o", "c.png", "--cctv", "small.toml")["stages"]
        self.assertIn("spread", stages)
        fewer = self.json("degrade", "a.exr", "-o", "c.png", "--cctv", "small.toml", "--off", "spread")["stages"]
        self.assertEqual(fewer, [stage for stage in stages if stage != "spread"])
        self.refused("degrade", "a.exr", "-o", "c.png", "--off", "nothing")

    def test_a_still_shown_for_some_frames(self):
        self.done("render", "ball.toml", "-o", "a.exr")
        report = self.json("degrade", "a.exr", "-o", "f-##.png", "--cctv", "small.toml", "--frames", 3, "--frame", 8)
        self.assertEqual([frame["frame"] for frame in report["frames"]], [8, 9, 10])
        frames = [self.picture(f"f-{number:02}.png") for number in (8, 9, 10)]
        self.assertEqual(len(set(frames)), 3)
        # The same sequence frame by frame gives the same bytes.
        self.done("degrade", "a.exr", "-o", "g-#.png", "--cctv", "small.toml", "--frames", 3, "--frame", 8)
        self.assertEqual(frames, [self.picture(f"g-{number}.png") for number in (8, 9, 10)])

    def test_iris_that_needs_time_and_light_that_lags(self):
        table = '\n[[cctv]]\nname = "slow"\niris_slew = 1.0\nlag = 0.4\n\n' + SMALL_MONITOR
        self.write("ball.toml", program.BALL.replace('name = "above"', 'name = "above"\ncctv = "slow"') + table)
        self.done("render", "ball.toml", "-o", "a.exr", "--camera", "above")
        self.done("render", "ball.toml", "-o", "b.exr", "--camera", "above", "--set", "sun.illuminance=1000")
        at_rest = self.json("degrade", "b.exr", "-o", "c.png", "--scene", "ball.toml")["f_number"]
        opened = self.json("degrade", "b.exr", "-o", "c.png", "--scene", "ball.toml", "--f-number", 8 * at_rest)
        self.assertAlmostEqual(opened["f_number"] / at_rest, 8 / 2 ** 0.5, 5)
        frames = self.json("degrade", "a.exr", "b.exr", "-o", "m#.png", "--scene", "ball.toml")["frames"]
        self.assertEqual(len(frames), 2)
        self.assertIn("lag", frames[1]["stages"])

    def test_fields_of_an_interlaced_camera(self):
        table = '\n[[cctv]]\nname = "woven"\ninterlace = true\n\n' + SMALL_MONITOR
        self.write("ball.toml", program.BALL.replace('name = "above"', 'name = "above"\ncctv = "woven"') + table)
        self.done("render", "ball.toml", "-o", "a.exr", "--camera", "above")
        self.done("degrade", "a.exr", "-o", "one.png", "--scene", "ball.toml")
        self.done("degrade", "a.exr", "a.exr", "--fields", "-o", "two.png", "--scene", "ball.toml")
        self.assertEqual(self.picture("one.png"), self.picture("two.png"))
        self.says(self.refused("degrade", "a.exr", "--fields", "-o", "x.png", "--scene", "ball.toml"), "even number")
        self.says(self.refused("degrade", "a.exr", "a.exr", "--fields", "-o", "x.png", "--preset", "ideal"), "interlace")

    def test_sequences_need_a_place_for_the_number(self):
        self.done("render", "ball.toml", "-o", "a.exr")
        self.says(self.refused("degrade", "a.exr", "-o", "x.png", "--frames", 2), "#")
        self.says(self.refused("degrade", "a.exr", "a.exr", "-o", "x#.png", "--frames", 2), "--frames")

    def test_the_picture_after_each_stage(self):
        self.done("render", "ball.toml", "-o", "a.exr")
        report = self.json("degrade", "a.exr", "-o", "c.png", "--stages", "steps", "--cctv", "small.toml")
        names = sorted(path.name for path in (self.folder / "steps").iterdir())
        self.assertEqual(names, [f"{number:02}-{stage}.exr" for number, stage in enumerate(report["stages"], 1)])

    def test_the_analytic_twin(self):
        self.done("render", "ball.toml", "-o", "a.exr")
        report = self.json("degrade", "a.exr", "-o", "noisy.exr", "--twin", "twin.exr", "--cctv", "small.toml")
        _, width, height, twin = exr.read(self.folder / "twin.exr")
        _, _, _, noisy = exr.read(self.folder / "noisy.exr")
        self.assertEqual((width, height), (report["columns"], report["rows"]))
        self.assertEqual(sorted(twin), ["Y", "crushed.Y", "detection.probability.Y", "detection.snr.Y", "mean.Y",
                                        "saturated.Y", "snr.Y", "twin.Y", "variance.Y"])
        self.assertEqual(twin["Y"], noisy["Y"])
        quiet = ["--cctv", "small.toml", "--off", "signal-noise", "--off", "read-noise"]
        self.done("degrade", "a.exr", "-o", "clean.exr", *quiet)
        self.assertEqual(twin["twin.Y"], exr.read(self.folder / "clean.exr")[3]["Y"])
        self.assertLess(report["twin"]["detectable_share"], 1)
        for wrong in (["--twin", "t.png"], ["--twin", "t.exr", "--target-resels", 4], ["--twin", "noisy.exr"]):
            self.refused("degrade", "a.exr", "-o", "noisy.exr", *wrong)

    # Light is additive: the camera's picture of the sum of the light layers is its picture of the
    # scene.
    def test_lights_may_be_mixed_before_the_camera_sees_them(self):
        self.done("render", "ball.toml", "-o", "a.exr", "--per-light")
        header, width, height, channels = exr.read(self.folder / "a.exr")
        layers = {}
        for name, values in channels.items():
            if "." in name and name.rsplit(".", 1)[1] in "RGB":
                layers.setdefault(name.rsplit(".", 1)[0], {})[name[-1]] = values
        lights = [layer for name, layer in layers.items() if name not in ("direct", "indirect", "specular", "variance")]
        self.assertGreater(len(lights), 1)
        for colour in "RGB":
            for values in zip(channels[colour], *(layer[colour] for layer in lights)):
                self.assertAlmostEqual(values[0], sum(values[1:]), delta=1e-4 * max(1, values[0]))

    def test_what_the_viewer_sees_as_numbers(self):
        self.done("render", "ball.toml", "-o", "a.exr")
        report = self.json("degrade", "a.exr", "-o", "c.exr", "--cctv", "small.toml")
        _, _, _, channels = exr.read(self.folder / "c.exr")
        self.assertEqual(sorted(channels), ["Y"])
        monitor = report["monitor"]
        veil = monitor["reflectance"] * monitor["room_illuminance"] / math.pi
        self.assertGreaterEqual(min(channels["Y"]), monitor["black_luminance"] + veil - 1e-4)
        self.assertLessEqual(max(channels["Y"]), monitor["white_luminance"] + veil + 1e-4)

    def test_fall_off_needs_the_field_of_view(self):
        table = '\n[[cctv]]\nname = "simple"\nfall_off = 4\n\n' + SMALL_MONITOR
        self.write("ball.toml", program.BALL.replace('name = "above"', 'name = "above"\ncctv = "simple"') + table)
        self.done("render", "ball.toml", "-o", "a.exr", "--camera", "above", "--cctv", "whole.png")
        self.done("degrade", "a.exr", "-o", "alone.png", "--scene", "ball.toml")
        self.assertEqual(self.picture("whole.png"), self.picture("alone.png"))
        self.done("degrade", "a.exr", "-o", "wide.png", "--scene", "ball.toml", "--fov", 120)
        self.assertNotEqual(self.picture("alone.png"), self.picture("wide.png"))

    def test_list(self):
        self.says(self.done("degrade", "--list"), "sit-monochrome", "ccd-colour", "stages")
        listed = self.json("degrade", "--list")
        self.assertIn("sit-monochrome", [preset["name"] for preset in listed["presets"]])

    def test_wrong_calls(self):
        self.done("render", "ball.toml", "-o", "a.exr")
        self.says(self.refused("degrade"), "EXR")
        self.says(self.refused("degrade", "a.exr"), "-o")
        self.says(self.refused("degrade", "a.exr", "-o", "c.jpg"), ".png")
        self.says(self.refused("degrade", "none.exr", "-o", "c.png"), "none.exr")
        self.says(self.refused("degrade", "ball.toml", "-o", "c.png"), "ball.toml")
        self.says(self.refused("degrade", "a.exr", "-o", "c.png", "--preset", "sit"), "sit-monochrome")
        self.says(self.refused("degrade", "a.exr", "-o", "c.png", "--preset", "x", "--scene", "ball.toml"), "--scene")
        self.says(self.refused("degrade", "a.exr", "-o", "c.png", "--camera", "A"), "--scene")
        self.says(self.refused("degrade", "a.exr", "-o", "c.png", "--scene", "ball.toml", "--camera", "Q"), '"Q"')
        self.write("cut.exr", self.picture("a.exr")[:-100])
        self.says(self.refused("degrade", "cut.exr", "-o", "c.png"), "cut.exr")

    def test_options_without_effect_or_number(self):
        self.done("render", "ball.toml", "-o", "a.exr")
        for wrong, said in ((["--f-number", "nan"], "0.5"), (["--fov", "inf"], "179"), (["--cctv", ""], "--cctv"),
                            (["--preset", "ideal", "--f-number", 8], "iris_rate"),
                            (["--target-resels", 7], "--twin")):
            self.says(self.refused("degrade", "a.exr", "-o", "c.png", *wrong), said)
        self.says(self.refused("degrade", "a.exr", "-o", "##-#.png", "--frames", 2), "has # in two places")
        run = self.run_program("degrade", "a.exr", "-o", "c.png", "--preset", "ideal", "--fov", 30)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.says(run.stderr, 'note: --fov has no effect: "ideal" has no fall_off')

    def test_iris_on_its_way_is_no_failure_of_its_range(self):
        self.done("render", "ball.toml", "-o", "a.exr")
        report = self.json("degrade", "a.exr", "-o", "c.png", "--preset", "sit-monochrome", "--f-number", 900)
        self.assertTrue(report["iris_moving"])
        self.assertFalse(report["underexposed"] or report["blown"])

    def test_wrong_settings_are_refused_by_every_command(self):
        table = '\n[[cctv]]\nname = "mine"\ngama = 2\n'
        self.write("ball.toml", program.BALL + table)
        self.says(self.refused("inspect", "ball.toml"), "ball.toml:", "gama", "gamma")


if __name__ == "__main__":
    unittest.main()
