# SPDX-License-Identifier: Apache-2.0
"""render --range: readings of a range sensor."""
import math
import unittest

import exr
import program

SENSOR = """
[[range_sensor]]
name = "lidar"
noise_m = 0.003
noise_m_per_m2 = 0.0005
max_incidence_deg = 75
max_range_m = 20
quantum_m = 0.001
"""
SCENE = program.BALL.replace('name = "A"\n', 'name = "A"\nrange_sensor = "lidar"\n', 1) + SENSOR


class Range(program.Case):
    def sense(self, text, *options, name="range.exr"):
        self.write("scene.toml", text)
        self.done("render", "scene.toml", "--range", name, "-q", *options)
        return exr.read(self.folder / name)

    def test_without_a_sensor_the_ranges_are_exact(self):
        header, width, height, channels = self.sense(program.BALL)
        self.assertEqual((width, height, set(channels)), (32, 24, {"range", "valid"}))
        self.assertEqual(header["earthshine:range_sensor"], "exact")
        self.done("render", "scene.toml", "-o", "a.exr", "-q", "--indirect", "none", "--aov", "range")
        for exact, sensed, valid in zip(exr.read(self.folder / "a.exr")[3]["range"], channels["range"], channels["valid"]):
            self.assertEqual((sensed, valid), (0, 0) if math.isinf(exact) else (exact, 1))
        self.says(self.run_program("render", "scene.toml", "--range", "b.exr").stderr, "names no range_sensor")

    def test_errors_are_those_of_the_sensor(self):
        exact = self.sense(program.BALL, "--size", "160x120")[3]["range"]
        header, _, _, channels = self.sense(SCENE, "--size", "160x120")
        self.assertEqual(header["earthshine:range_sensor"], "lidar")
        self.assertAlmostEqual(header["earthshine:noise_m_per_m2"], 0.0005, places=9)
        self.assertIn("earthshine:camera.K", header)
        # Each error over its deviation: mean 0, variance 1 with standard error sqrt(2/n); the step
        # of 1 mm adds q^2/12.
        scaled = [(sensed - true) / math.hypot(0.003 + 0.0005 * true**2, 0.001 / math.sqrt(12))
                  for true, sensed, valid in zip(exact, channels["range"], channels["valid"]) if valid]
        count = len(scaled)
        self.assertGreater(count, 5000)
        self.assertLess(abs(sum(scaled) / count), 4 / math.sqrt(count))
        self.assertLess(abs(sum(e * e for e in scaled) / count - 1), 4 * math.sqrt(2 / count))
        self.assertTrue(any(true > 0 and not valid for true, valid in zip(exact, channels["valid"])))

    def test_same_bytes_on_any_number_of_threads_and_beside_the_picture(self):
        self.sense(SCENE, "-j", "1", name="one.exr")
        self.sense(SCENE, "-j", "2", "-o", "a.exr", "--indirect", "none", name="two.exr")
        self.sense(SCENE, "--seed", "2", name="other.exr")
        one, two, other = ((self.folder / name).read_bytes() for name in ("one.exr", "two.exr", "other.exr"))
        self.assertEqual(one, two)
        self.assertNotEqual(one, other)

    def test_alone_it_solves_nothing(self):
        self.write("scene.toml", SCENE)
        report = self.json("render", "scene.toml", "--range", "a.exr")
        self.assertEqual(set(report["seconds"]), {"read", "build", "range"})
        counts = report["range"]
        self.assertEqual(counts.pop("sensor"), "lidar")
        self.assertEqual(sum(counts.values()), 32 * 24)
        self.assertGreater(counts["empty"], 0)
        report = self.json("render", "scene.toml", "--range", "a.exr", "-o", "b.exr", "--indirect", "none")
        self.assertEqual(report["range"]["returned"], counts["returned"])

    def test_alone_it_takes_no_option_of_a_picture(self):
        self.write("scene.toml", SCENE)
        for option in (["--report", "r.json"], ["--timings"], ["--per-light"], ["--aov", "depth"], ["--error", "0.1"],
                       ["--no-error"], ["--indirect", "none"], ["--time-limit", "1"], ["--all-effects"],
                       ["--solution", "s.h5"]):
            self.says(self.refused("render", "scene.toml", "--range", "a.exr", *option), option[0], "--range alone", "-o FILE.exr")
            self.assertFalse((self.folder / "a.exr").exists())

    def test_an_unknown_sensor_is_named_with_its_place(self):
        scene = SCENE.replace('range_sensor = "lidar"', 'range_sensor = "radar"', 1)
        self.write("scene.toml", scene)
        line = scene.splitlines().index('range_sensor = "radar"') + 1
        self.says(self.refused("inspect", "scene.toml"), f"scene.toml:{line}:", 'no range sensor "radar"', '"lidar"')

    def test_several_cameras_have_files_and_noise_of_their_own(self):
        scene = SCENE.replace('name = "above"\n', 'name = "above"\nrange_sensor = "lidar"\n', 1)
        self.write("scene.toml", scene)
        reports = self.json("render", "scene.toml", "--range", "r.exr", "--camera", "A,above")
        self.assertEqual([report["camera"] for report in reports], ["A", "above"])
        alone = self.sense(scene, "--camera", "above")[3]["range"]
        self.assertEqual(exr.read(self.folder / "r-above.exr")[3]["range"], alone)
        self.assertTrue((self.folder / "r-A.exr").exists())

    def test_range_beside_lines_over_a_photograph(self):
        self.write("scene.toml", SCENE)
        self.done("render", "scene.toml", "-o", "a.exr", "--png", "photo.png", "--indirect", "none", "--camera", "A")
        self.done("render", "scene.toml", "--camera", "A", "--over", "photo.png", "--png", "over.png", "--range", "r.exr")
        self.assertTrue((self.folder / "over.png").exists())
        self.assertEqual(exr.read(self.folder / "r.exr")[1:3], (32, 24))

    def test_plan_says_why(self):
        self.write("scene.toml", SCENE)
        rows = {row["effect"]: row for row in self.json("plan", "scene.toml")["effects"]}
        self.assertTrue(rows["range sensor"]["runs"])
        self.write("plain.toml", program.BALL)
        rows = {row["effect"]: row for row in self.json("plan", "plain.toml")["effects"]}
        self.assertFalse(rows["range sensor"]["runs"])
        self.says(rows["range sensor"]["why"], "no camera names a range_sensor")

    def test_set_reaches_the_sensor(self):
        header = self.sense(SCENE, "--set", "range_sensor.lidar.noise_m=0.5")[0]
        self.assertEqual(header["earthshine:noise_m"], 0.5)

    def test_what_is_wrong_is_said(self):
        self.write("scene.toml", SCENE)
        self.says(self.refused("render", "scene.toml", "--range", "a.png"), "--range", ".exr")
        self.says(self.refused("render", "scene.toml", "--range", "a.exr", "-o", "./a.exr"), "twice")
        self.says(self.refused("render", "scene.toml", "--range", "a.exr", "--png", "a.png"), "--output")
        self.says(self.refused("render", "scene.toml", "--range", "a.exr", "--set", "range_sensor.lidar.noise=1"),
                  '"noise"', "noise_m")
        self.says(self.refused("plan", "scene.toml", "--set", "range_sensor.lidar.dropout=2"), "dropout", "between 0 and 1")
        self.says(self.refused("plan", "scene.toml", "--set", "camera.A.range_sensor=radar"), "radar", "lidar")
        self.write("twice.toml", SCENE + SENSOR)
        self.says(self.refused("plan", "twice.toml"), "lidar")


if __name__ == "__main__":
    unittest.main()
