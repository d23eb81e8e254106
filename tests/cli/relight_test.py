# SPDX-License-Identifier: Apache-2.0
"""relight: weighted sums of light layers."""
import array
import unittest

import exr
import program


def single(value):
    """Rounded to single precision."""
    return array.array("f", [value])[0]


class Relight(program.Case):
    def setUp(self):
        super().setUp()
        self.write("ball.toml", program.BALL)
        self.done("render", "ball.toml", "--camera", "A", "--size", "16x16", "--error", "0.3", "--per-light", "--aov", "object,direct,depth",
                  "-o", "a.exr", "-q")

    def layers(self, name):
        return exr.read(self.folder / name)[3]

    def test_the_picture_is_the_weighted_sum_to_rounding(self):
        before = self.layers("a.exr")
        self.done("relight", "a.exr", "--set", "sun=0.25", "--set", "lamp=2,1,0", "-o", "b.exr")
        after = self.layers("b.exr")
        for colour, lamp in zip("RGB", (2, 1, 0)):
            for whole, sun_light, lamp_light in zip(after[colour], before[f"light_sun.{colour}"], before[f"light_lamp.{colour}"]):
                expected = single(0.25 * sun_light) + single(lamp * lamp_light)
                self.assertEqual(whole, single(expected))
        self.assertEqual(list(after["Z"]), list(before["Z"]))
        self.assertFalse([name for name in after if name.startswith("direct.")])

    def test_with_one_group_it_is_the_layer_of_that_group(self):
        self.done("relight", "a.exr", "--set", "lamp=0", "-o", "b.exr")
        after = self.layers("b.exr")
        self.assertEqual(list(after["G"]), list(self.layers("a.exr")["light_sun.G"]))
        self.assertEqual(set(after["light_lamp.G"]), {0.0})

    def test_factors_of_one_change_nothing(self):
        self.done("relight", "a.exr", "--set", "lamp=1", "-o", "b.exr")
        before, after = self.layers("a.exr"), self.layers("b.exr")
        self.assertEqual({name: list(values) for name, values in before.items()},
                         {name: list(values) for name, values in after.items()})

    def test_objects_have_their_light_by_group(self):
        report = self.json("relight", "a.exr", "--set", "sun=0.5", "-o", "b.exr")
        self.assertEqual([thing["name"] for thing in report["objects"]], ["floor", "ball"])
        for thing in report["objects"]:
            self.assertAlmostEqual(sum(thing["by_group"].values()) / thing["luminance"], 1, places=6)
            self.assertGreater(thing["pixels"], 0)

    def test_wrong_calls(self):
        for call, words in (((), "-o is missing"), (("-o", "b.exr", "--set", "moon=1"), "it has lamp, sun"),
                            (("-o", "b.exr", "--set", "sun=-1"), "not a group and its factor"),
                            (("-o", "b.exr", "--set", "sun=nan"), "not a group and its factor"),
                            (("-o", "b.exr", "--set", "sun=1,2"), "not a group and its factor"),
                            (("-o", "b.exr", "--set", "sun=1", "--set", "sun=2"), "twice"), (("-o", "b.png", "--set", "sun=1"), "ends in .exr"),
                            (("--png", "b.toml", "--set", "sun=1"), "ends in .png")):
            self.says(self.refused("relight", "a.exr", *call), words)
        self.done("render", "ball.toml", "--camera", "A", "--size", "8x8", "--error", "0.3", "-o", "plain.exr", "-q")
        self.says(self.refused("relight", "plain.exr", "-o", "b.exr"), "--per-light")
        self.assertFalse((self.folder / "b.exr").exists())


if __name__ == "__main__":
    unittest.main()
