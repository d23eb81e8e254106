# SPDX-License-Identifier: Apache-2.0
"""degrade: the CCTV stage on pictures that render wrote."""
import unittest

import program


class Degrade(program.Case):
    def setUp(self):
        super().setUp()
        self.write("ball.toml", program.BALL.replace('name = "above"', 'name = "above"\ncctv = "ccd-colour"'))

    def picture(self, name):
        return (self.folder / name).read_bytes()

    def test_alone_is_the_same_as_within_render(self):
        self.done("render", "ball.toml", "-o", "a.exr", "--camera", "above", "--cctv", "whole.png", "--seed", 4)
        # The picture's header names the camera.
        self.done("degrade", "a.exr", "-o", "alone.png", "--scene", "ball.toml", "--seed", 4)
        self.assertEqual(self.picture("whole.png"), self.picture("alone.png"))
        self.done("degrade", "a.exr", "-o", "other.png", "--scene", "ball.toml", "--camera", "A", "--seed", 4)
        self.assertNotEqual(self.picture("whole.png"), self.picture("other.png"))

    def test_same_seed_and_frame_same_bytes_on_any_number_of_threads(self):
        self.done("render", "ball.toml", "-o", "a.exr")

        def run(*options):
            self.done("degrade", "a.exr", "-o", "c.png", "--preset", "sit-monochrome", *options)
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
        stages = self.json("degrade", "a.exr", "-o", "c.png")["stages"]
        self.assertIn("spread", stages)
        fewer = self.json("degrade", "a.exr", "-o", "c.png", "--off", "spread")["stages"]
        self.assertEqual(fewer, [stage for stage in stages if stage != "spread"])
        self.refused("degrade", "a.exr", "-o", "c.png", "--off", "nothing")

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

    def test_wrong_settings_are_refused_by_every_command(self):
        table = '\n[[cctv]]\nname = "mine"\ngama = 2\n'
        self.write("ball.toml", program.BALL + table)
        self.says(self.refused("inspect", "ball.toml"), "ball.toml:", "gama", "gamma")


if __name__ == "__main__":
    unittest.main()
