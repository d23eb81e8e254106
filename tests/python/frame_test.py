# SPDX-License-Identifier: Apache-2.0
"""Pictures in Python: layers without copies, cameras as matrices, other lamp settings, the CCTV chain."""
import gc
import threading
import time
import unittest

import numpy as np

import earthshine
import program


class Frames(program.Case):
    def setUp(self):
        super().setUp()
        self.write("ball.toml", program.BALL)
        self.scene = earthshine.load(self.folder / "ball.toml")

    def test_layers_are_views_that_outlive_the_scene(self):
        frame = self.scene.render("A", error=0.5, layers=["depth", "normal"], per_light=True)
        self.assertEqual(frame.shape, (24, 32))
        self.assertTrue({"R", "G", "B", "Z", "N.X", "light_sun.R", "light_lamp.B"} <= set(frame))
        red = frame["R"]
        self.assertEqual((red.dtype, red.shape), (np.float32, (24, 32)))
        self.assertFalse(red.flags.owndata or red.flags.writeable)
        self.assertTrue(np.shares_memory(red, frame["R"]))
        before = red.copy()
        del self.scene, frame
        gc.collect()
        np.testing.assert_array_equal(red, before)

    def test_layers_say_what_they_are(self):
        frame = self.scene.render("A", error=0.5, layers=["depth", "normal", "object", "variance"], per_light=True)
        self.assertEqual([frame.unit(c) for c in ("R", "light_sun.G", "Z", "N.X", "variance")],
                         ["cd/m2", "cd/m2", "m", "1", "(cd/m2)^2"])
        self.assertEqual(frame.rgb.shape, (24, 32, 3))
        total = frame.layer("light_sun") + frame.layer("light_lamp")
        np.testing.assert_allclose(total, frame.rgb, rtol=1e-5)  # light adds up, to rounding
        self.assertTrue(0 < frame.error["estimate"] <= 0.5)
        self.assertEqual(frame.header["earthshine:camera"], "A")
        self.assertTrue(frame.mask("ball").any())

    def test_the_matrices_project_points_to_their_pixels(self):
        frame = self.scene.render("A", error=0.5, layers=["position", "depth"], size=(40, 30))
        seen = np.isfinite(frame["Z"])
        points = frame.layer("P")[seen].astype(float)
        camera = frame.to_camera @ np.c_[points, np.ones(len(points))].T
        pixels = frame.K @ camera[:3]
        rows, columns = np.nonzero(seen)
        # Positions are floats: 2e-7 of 5 m, seen by a focal length of 41 px at 3 m and more.
        np.testing.assert_allclose(pixels[:2] / pixels[2], [columns + 0.5, rows + 0.5], atol=1e-4)
        np.testing.assert_allclose(camera[2], frame["Z"][seen], rtol=1e-6)

    def test_lamp_settings_are_those_of_the_program(self):
        frame = self.scene.render("A", error=0.3, per_light=True, layers=["object"])
        frame.save(self.folder / "a.exr")
        frame.relight({"sun": 0.25, "lamp": (2, 1, 0)}).save(self.folder / "python.exr")
        self.done("relight", "a.exr", "--set", "sun=0.25", "--set", "lamp=2,1,0", "-o", "program.exr", "-q")
        self.assertEqual((self.folder / "python.exr").read_bytes(), (self.folder / "program.exr").read_bytes())
        with self.assertRaisesRegex(earthshine.Error, "it has sun, lamp"):
            frame.relight({"moon": 1})

    def test_the_monitor_is_that_of_the_program(self):
        frame = self.scene.render("A", error=0.3, seed=4)
        frame.save(self.folder / "a.exr")
        shown = earthshine.degrade(frame, "sit-monochrome", seed=9, twin=True)
        shown.save(self.folder / "python.png")
        self.done("degrade", "a.exr", "--preset", "sit-monochrome", "--seed", "9", "-o", "program.png", "-q")
        self.assertEqual((self.folder / "python.png").read_bytes(), (self.folder / "program.png").read_bytes())
        self.assertEqual(shown.pixels.dtype, np.uint8)
        self.assertIn("detection.probability.Y", shown.twin)
        again = earthshine.degrade(frame.luminance, "sit-monochrome", seed=9)
        self.assertEqual(again.pixels.shape, shown.pixels.shape)
        other = earthshine.degrade(frame, "sit-monochrome", seed=10)
        self.assertFalse(np.array_equal(shown.pixels, other.pixels))
        with self.assertRaises(ValueError):
            earthshine.degrade(np.zeros((2, 2, 2)))
        with self.assertRaisesRegex(earthshine.Error, "sit-monochrome"):
            earthshine.degrade(frame, "sit-monochrom")

    def test_the_interpreter_goes_on_meanwhile(self):
        ends = []
        thread = threading.Thread(target=lambda: ends.append(self.scene.render("A", error=0.02, size=(96, 96))))
        thread.start()
        time.sleep(0.05)  # this thread comes back to the interpreter while the other one works
        self.assertEqual(ends, [])
        thread.join()
        self.assertEqual(len(ends), 1)


if __name__ == "__main__":
    unittest.main()
