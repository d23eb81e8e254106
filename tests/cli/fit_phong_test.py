# SPDX-License-Identifier: Apache-2.0
"""fit-phong on made-up measurements."""
import math
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

    def test_broken_data(self):
        self.says(self.refused("fit-phong", "none.csv"), "none.csv")
        self.write("bad.csv", "0,1\n10,0.8\n80,\n")
        self.says(self.refused("fit-phong", "bad.csv"), "bad.csv:3:")
        self.write("few.csv", "0,1\n80,0.5\n")
        self.says(self.refused("fit-phong", "few.csv"), "few.csv", "2 different angles")


if __name__ == "__main__":
    unittest.main()
