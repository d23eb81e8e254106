# SPDX-License-Identifier: Apache-2.0
"""solve: the closed box, the energy of every light group, keys for scripts."""
import json
import unittest

import program


class Solve(program.Case):
    def test_closed_box_reaches_emission_over_one_minus_reflectance(self):
        # B = M + rho B in every patch, hence B = M / (1 - rho) = 10 / 0.5, and E = B.
        self.write("box.toml", program.CLOSED_BOX)
        solved = self.json("solve", "box.toml")
        room, = solved["objects"]
        self.assertAlmostEqual(room["area_m2"], 24.0)
        for channel in range(3):
            self.assertAlmostEqual(room["radiosity_lm_m2"][channel], 20.0, places=5)
            self.assertAlmostEqual(room["illuminance_lx"][channel], 20.0, places=5)

    def test_closed_box_with_white_walls(self):
        text = program.CLOSED_BOX.replace("diffuse = 0.5", "diffuse = [0.9, 0.999, 0.99999]")
        self.write("box.toml", text)
        room, = self.json("solve", "box.toml", "--set", "quality.solver_tolerance=1e-12")["objects"]
        for radiosity, expected in zip(room["radiosity_lm_m2"], (1e2, 1e4, 1e6)):
            self.assertLess(abs(radiosity / expected - 1), 1e-6)

    def test_every_group_balances(self):
        self.write("ball.toml", program.BALL)
        groups = self.json("solve", "ball.toml")["groups"]
        self.assertEqual(sorted(group["name"] for group in groups), ["lamp", "sun"])
        for group in groups:
            self.assertLessEqual(group["imbalance"], 1e-9)
            for channel in range(3):
                into = group["emitted_lm"][channel] + group["landed_lm"][channel]
                out = group["absorbed_lm"][channel] + group["escaped_lm"][channel]
                self.assertGreater(into, 0)
                self.assertLessEqual(abs(into - out), 1e-9 * into)

    def test_the_ledger_closes_from_what_lamps_give(self):
        self.write("ball.toml", program.BALL)
        solved = self.json("solve", "ball.toml")
        flux = {source["group"]: source for source in solved["sources"]}
        for group in solved["groups"]:
            for channel in range(3):
                given = group["given_lm"][channel]
                at_once = group["escaped_at_once_lm"][channel] + group["lost_at_once_lm"][channel]
                ends = at_once + group["absorbed_lm"][channel] + group["escaped_lm"][channel]
                self.assertLessEqual(abs(given - ends), 1e-9 * given)
                if group["name"] in flux:
                    self.assertAlmostEqual(given, flux[group["name"]]["emitted_lm"][channel])
                    self.assertAlmostEqual(group["landed_lm"][channel], flux[group["name"]]["landed_lm"][channel])
        lamp, = [group for group in solved["groups"] if group["name"] == "lamp"]
        self.assertGreater(lamp["escaped_at_once_lm"][1], 0)
        self.says(self.done("solve", "ball.toml"), "given lm", "out at once", "landed lm", "absorbed lm")

    def test_keys(self):
        self.write("ball.toml", program.BALL)
        solved = self.json("solve", "ball.toml")
        self.assertLessEqual({"patches", "rays", "seconds", "iterations", "residual", "groups", "objects",
                              "sources", "balance", "nonzeros", "shadow_rays", "warnings", "refinement"}, solved.keys())
        self.assertEqual(solved["rays"], 64 * solved["patches"])
        self.assertLessEqual(solved["residual"], 1e-8)
        self.assertTrue(all(seconds >= 0 for seconds in solved["seconds"].values()))
        self.assertIn("lamp", [source["name"] for source in solved["sources"]])

    def test_text_and_file(self):
        self.write("ball.toml", program.BALL)
        table = self.done("solve", "ball.toml")
        self.says(table, "lamp", "sun", "ball", "patches", "imbalance")
        printed = self.json("solve", "ball.toml")
        self.says(table, f"{printed['iterations']} iterations",
                  f"in {printed['balance']['sweeps']} sweeps\n", f"to {printed['solver_error']:.2g};")
        self.assertEqual(self.done("solve", "ball.toml", "-o", "solved.json"), "")
        written = json.loads((self.folder / "solved.json").read_text())
        printed = self.json("solve", "ball.toml")
        for report in (written, printed):
            del report["seconds"]
        self.assertEqual(written, printed)

    def test_same_on_any_number_of_threads(self):
        self.write("ball.toml", program.BALL)
        reports = [self.json("solve", "ball.toml", "-j", threads, "--seed", 5) for threads in (1, 2, 3)]
        for report in reports:
            del report["seconds"]
        self.assertEqual(reports[0], reports[1])
        self.assertEqual(reports[0], reports[2])
        self.assertNotEqual(reports[0]["objects"], self.json("solve", "ball.toml", "--seed", 6)["objects"])

    def test_refinement(self):
        self.write("ball.toml", program.BALL)
        even = self.json("solve", "ball.toml")
        self.assertEqual(even["refinement"], {"rounds": [], "rays": 0})  # patch_edge only: uniform patches
        budget = even["patches"] + 150
        call = ("ball.toml", "--set", f"quality.max_patches={budget}")
        refined = self.json("solve", *call)
        rounds = refined["refinement"]["rounds"]
        self.assertGreater(len(rounds), 1)
        self.assertEqual(rounds[-1]["patches"], refined["patches"])
        self.assertTrue(even["patches"] < refined["patches"] <= budget)
        self.assertLess(rounds[-1]["error"], rounds[0]["error"])
        self.assertGreater(refined["refinement"]["rays"], 0)
        self.says(self.done("solve", *call), "refined in", "estimated error")
        plan = self.json("plan", *call)
        self.assertEqual((plan["patches"], plan["patches_at_most"]), (budget, True))
        self.says(self.done("plan", *call), f"at most {budget} patches")

    def test_no_light(self):
        self.write("box.toml", program.CLOSED_BOX.replace("emit = 10.0", "emit = 0.0"))
        solved = self.json("solve", "box.toml")
        self.assertEqual((solved["rays"], solved["groups"]), (0, []))
        self.says(self.done("solve", "box.toml"), "nothing gives light")


if __name__ == "__main__":
    unittest.main()
