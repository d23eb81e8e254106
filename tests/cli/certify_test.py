# SPDX-License-Identifier: Apache-2.0
"""degrade certify: a camera's datasheet, each number with its law."""
import json
import unittest

import program


class Certify(program.Case):
    def test_datasheet_says_what_was_measured_that_it_passes_and_what_the_documentation_shows(self):
        text = self.done("degrade", "certify", "sit-monochrome")
        self.says(text, "certificate of sit-monochrome", "photon transfer", "slanted edge", "iris", "raster",
                  "repeatability", "SNR on the line, at white", "MTF50", "four standard errors", "0 fail")
        self.assertNotIn("FAIL", text)
        said = [line.split() for line in text.splitlines()]
        rows = [line for line in (program.TOP / "docs/cctv.md").read_text().splitlines() if line.startswith("  pass ")]
        self.assertGreater(len(rows), 10)
        for row in rows:
            self.assertIn(row.split(), said)

    def test_json_has_every_number_of_the_datasheet(self):
        sheet = self.json("degrade", "certify", "sit-monochrome", "--seed", 7)
        self.assertEqual(sheet["camera"], "sit-monochrome")
        self.assertEqual(sheet["seed"], 7)
        self.assertTrue(sheet["passed"])
        self.assertEqual(sheet["fail"], 0)
        self.assertEqual(sheet["pass"] + sheet["does_not_apply"], len(sheet["rows"]))
        rows = {row["name"]: row for row in sheet["rows"]}
        self.assertEqual(len(rows), len(sheet["rows"]))
        electrons = rows["electrons at white"]
        self.assertEqual(electrons["expected"], 640)
        self.assertTrue(electrons["four_standard_errors"])
        self.assertLess(abs(electrons["measured"] - 640), electrons["tolerance"])
        for row in sheet["rows"]:
            if row["verdict"] == "does not apply":
                self.assertTrue(row["why"], row)
            else:
                self.assertEqual(row["verdict"], "pass")
                self.assertLessEqual(abs(row["measured"] - row["expected"]), row["tolerance"], row)
                self.assertTrue(row["law"], row)
        self.assertEqual(len(sheet["photon_transfer"]), 12)
        self.assertEqual([point["cycles_per_resel"] for point in sheet["mtf"]][::10], [0, 0.25, 0.5])

    def test_same_seed_same_numbers_on_any_number_of_threads(self):
        def run(*options):
            return self.done("degrade", "certify", "report-1990", "--json", *options)

        one = run("-j", "1")
        self.assertEqual(one, run("-j", "2"))
        self.assertNotEqual(one, run("--seed", "2"))

    def test_file_holds_the_json(self):
        text = self.done("degrade", "certify", "ideal", "-o", "ideal.json")
        self.says(text, "certificate of ideal")
        self.assertEqual(json.loads((self.folder / "ideal.json").read_text()), self.json("degrade", "certify", "ideal"))

    def test_camera_of_a_file(self):
        self.write("mine.toml", '[[cctv]]\nname = "mine"\npreset = "report-1990"\nnoise = "photon"\nelectrons_at_white = 300\n')
        rows = {row["name"]: row for row in self.json("degrade", "certify", "mine.toml")["rows"]}
        self.assertEqual(rows["electrons at white"]["expected"], 300)

    def test_wrong_calls(self):
        self.says(self.refused("degrade", "certify"), "CAMERA")
        self.says(self.refused("degrade", "certify", "sit"), "sit-monochrome")
        self.says(self.refused("degrade", "certify", "ideal", "ideal"), '"ideal"')
        self.says(self.refused("degrade", "certify", "ideal", "--jason"), "--json")
        self.says(self.refused("degrade", "certify", "ideal", "-o", "no/such/folder.json"), "no/such")

    def test_word_that_is_no_picture_is_not_taken_for_a_command(self):
        self.says(self.refused("degrade", "a.exr", "b", "-o", "c.png"), "earthshine: ")
        self.says(self.done("degrade", "--help"), "certify")


if __name__ == "__main__":
    unittest.main()
