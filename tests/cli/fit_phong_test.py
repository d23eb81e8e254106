# SPDX-License-Identifier: Apache-2.0
"""fit-phong on synthetic measurements."""
import math
import random
import unittest

import program


class FitPhong(program.Case):
    def measured(self, k_d, k_s, n):
        rows = [f"{a},{k_d + k_s * math.cos(math.radians(a)) ** n!r}" for a in range(0, 90, 5)]
        return self.write("paint.csv", "# white paint\nangle_deg,reflectance\n" + "\n".join(rows) + "\n")

    def test_recovers_the_material(self):
        fits = self.json("fit-phong", self.measured(0.3, 0.9, 20))
        for method in ("report", "least_squares"):
            self.assertAlmostEqual(fits[method]["diffuse"], 0.3, places=5)
            self.assertAlmostEqual(fits[method]["specular"], 0.9, places=5)
            self.assertAlmostEqual(fits[method]["shininess"], 20, places=3)
            self.assertLess(fits[method]["residual"], 1e-6)

    def test_table_shows_both_residuals(self):
        self.says(self.done("fit-phong", self.measured(0.2, 0.5, 3)), "1990 report", "least squares", "residual")

    def noisy(self, k_d, k_s, n, share):
        noise = random.Random(5)
        rows = [f"{a},{(k_d + k_s * math.cos(math.radians(a)) ** n) * (1 + share * noise.gauss(0, 1))!r}"
                for a in range(-80, 81, 5)]
        return self.write("noisy.csv", "\n".join(rows) + "\n")

    def test_states_errors_that_hold_the_truth(self):
        fits = self.json("fit-phong", self.noisy(0.3, 0.9, 20, 0.05))
        self.assertEqual(fits["noise"]["model"], "proportional")
        self.assertAlmostEqual(fits["noise"]["level"], 0.05, delta=4 * 0.05 / math.sqrt(60))
        for method in ("report", "least_squares"):
            for key, truth in (("diffuse", 0.3), ("specular", 0.9), ("shininess", 20)):
                error = fits[method]["std_error"][key]
                self.assertGreater(error, 0)
                self.assertLess(abs(fits[method][key] - truth), 4 * error, (method, key))
            self.assertLess(fits[method]["std_error"]["shininess"], 10)
        self.says(self.done("fit-phong", "noisy.csv"), "±", "% of R")
        self.says(self.done("fit-phong", "noisy.csv", "--noise", "constant"), "the same everywhere")
        self.assertEqual(self.json("fit-phong", "noisy.csv", "--noise", "constant")["noise"]["model"], "constant")
        self.says(self.refused("fit-phong", "noisy.csv", "--noise", "white"), "proportional, constant")

    def test_says_what_is_not_determined(self):
        fits = self.json("fit-phong", self.noisy(0.4, 0, 1, 0.05))["least_squares"]
        self.assertEqual((fits["std_error"]["specular"], fits["std_error"]["shininess"]), (None, None))
        self.says(self.done("fit-phong", "noisy.csv"), "k_s and n are not determined", "?")
        fits = self.json("fit-phong", self.noisy(0.4, 0.8, 50000, 0.05))["least_squares"]
        self.assertIsNone(fits["std_error"]["shininess"])
        self.assertIsNotNone(fits["std_error"]["specular"])
        self.says(self.done("fit-phong", "noisy.csv"), "n is not determined")

    def test_broken_data(self):
        self.says(self.refused("fit-phong", "none.csv"), "none.csv")
        self.write("bad.csv", "0,1\n10,0.8\n80,\n")
        self.says(self.refused("fit-phong", "bad.csv"), "bad.csv:3:")
        (self.folder / "binary.csv").write_bytes(b"v/1\x01\x00\x02\n")
        self.says(self.refused("fit-phong", "binary.csv"), "binary.csv:1:", "does not have two columns")
        self.write("few.csv", "0,1\n80,0.5\n")
        self.says(self.refused("fit-phong", "few.csv"), "few.csv", "2 different angles")


if __name__ == "__main__":
    unittest.main()
