# SPDX-License-Identifier: Apache-2.0
"""[orbit] for users: output of inspect, tables of attitudes, and errors."""
import math
import unittest

import program

ORBIT = program.BALL.replace("""[sun]
direction = [-0.3, 0.2, 1]
illuminance = 1000
""", """[orbit]
altitude_km = 425
""")
TABLE = ORBIT.replace("altitude_km = 425\n", 'altitude_km = 425\nattitude_table = "turns.csv"\n')
HEAD = "position_deg,yaw_deg,pitch_deg,roll_deg\n"


class Orbit(program.Case):
    def setUp(self):
        super().setUp()
        self.assertIn("[orbit]", ORBIT)

    def inspected(self, text, *settings):
        self.write("scene.toml", text)
        return self.json("inspect", "scene.toml", *[word for s in settings for word in ("--set", s)])

    def assertNear(self, found, wanted):
        for a, b in zip(found, wanted, strict=True):
            self.assertAlmostEqual(a, b, places=9)

    def test_inspect_tells_period_and_eclipse(self):
        orbit = self.inspected(ORBIT, "orbit.position_deg=90", "sun.angular_radius_deg=0")["orbit"]
        self.assertAlmostEqual(orbit["time_s"], orbit["period_s"] / 4)
        # Behind the Earth in its shadow cylinder: 0.387 of the orbit at 425 km.
        umbra = orbit["umbra"]
        self.assertAlmostEqual((umbra["end_deg"] - umbra["begin_deg"]) / 360, 0.387, places=3)
        self.assertAlmostEqual(umbra["begin_s"] / orbit["period_s"], umbra["begin_deg"] / 360)
        self.assertEqual(umbra, orbit["penumbra"])
        high = self.inspected(ORBIT, "orbit.beta_deg=75")["orbit"]
        self.assertEqual((high["umbra"], high["penumbra"]), (None, None))
        self.assertIsNone(self.inspected(program.BALL)["orbit"])
        self.says(self.done("inspect", "scene.toml"), "lamp")
        self.write("scene.toml", ORBIT)
        self.says(self.done("inspect", "scene.toml"), "orbit: 425 km", "hidden from 110.")

    def test_attitudes(self):
        kept = self.inspected(ORBIT, "orbit.attitude=inertial", "orbit.position_deg=60")
        self.assertNear(kept["sun"]["direction"], (0, 0, -1))  # as at noon, bay to the Earth
        self.assertNear(kept["earth"]["direction"], (math.sin(math.pi / 3), 0, 0.5))  # behind the
                                                                                      # orbiter, aft
        self.write("turns.csv", HEAD + "0,0,0,0\n90,0,0,90\n")
        turned = self.inspected(TABLE, "orbit.position_deg=30")
        self.assertNear(turned["earth"]["direction"], (0, 0.5, -math.sqrt(0.75)))
        self.assertTrue(turned["orbit"]["attitude_table"].endswith("turns.csv"))
        self.assertIsNone(turned["orbit"]["attitude"])

    def test_tables_lie_beside_the_scene(self):
        (self.folder / "in").mkdir()
        self.write("in/turns.csv", HEAD + "0,0,0,0\n")
        self.write("in/scene.toml", TABLE)
        self.done("inspect", "in/scene.toml")
        self.write("scene.toml", TABLE)
        self.says(self.refused("inspect", "scene.toml"), "scene.toml:", "turns.csv", "No such file")

    def test_broken_tables(self):
        self.write("scene.toml", TABLE)
        for csv, *parts in (("", "turns.csv", "no lines"), (HEAD, "no rows"), (HEAD + "0,0,0\n", "turns.csv:2", "3 columns"),
                            (HEAD + "0,nan,0,0\n", "turns.csv:2:3", "yaw_deg", "nan"),
                            (HEAD + "5,0,0,0\n4,0,0,0\n", "turns.csv:3:1", "4 after 5"),
                            ("time_s,qw,qx,qy,qz\n0,0,0,0,0\n", "turns.csv:2", "length 0"),
                            ("time_s,qw,qx,qy\n", "turns.csv:1", "qz"), (b"\x00\xff" * 3000, "turns.csv:1:1")):
            self.write("turns.csv", csv)
            self.says(self.refused("inspect", "scene.toml"), *parts)
        self.write("turns.csv", HEAD + "0,0,0,0\n90,0,0,0\n")
        self.says(self.refused("inspect", "scene.toml", "--set", "orbit.position_deg=91"), "turns.csv", "from position_deg 0 to 90")

    def test_albedo_by_latitude_needs_the_pole(self):
        earth = program.BALL + "[earth]\ndirection = [0, 0, 1]\naltitude_km = 425\n"
        self.write("scene.toml", earth)
        self.says(self.refused("inspect", "scene.toml", "--set", "earth.albedo_by=latitude"), "north", "[x, y, z]")
        self.done("inspect", "scene.toml", "--set", "earth.albedo_by=latitude", "--set", "earth.north=[0, 1, 0]")
        self.says(self.refused("inspect", "scene.toml", "--set", "earth.north=[0, 1, 0]"), 'albedo_by = "latitude"')

    def test_another_latitude_makes_a_solution_stale(self):
        self.write("scene.toml", ORBIT + '[earth]\nalbedo_by = "latitude"\n')
        plane = ("--set", "orbit.inclination_deg=28.5", "--set", "quality.patch_edge=2")
        self.done("solve", "scene.toml", "-o", "a.h5", *plane)
        picture = ("render", "scene.toml", "--camera", "A", "--solution", "a.h5", "-o", "a.exr")
        self.done(*picture, *plane)
        self.says(self.refused(*picture, *plane, "--set", "orbit.noon_argument_deg=40"), "the Sun or the Earth changed")


if __name__ == "__main__":
    unittest.main()
