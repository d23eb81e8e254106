# SPDX-License-Identifier: Apache-2.0
"""degrade --cctv and --describe: shipped cameras, and cameras of camera files and scenes."""
import unittest

import program

CAMERAS = """[[cctv]]
name = "bay"
preset = "ccd-colour"
glare = 0.05

[[cctv]]
name = "quiet"
noise = "spec"
snr_db = 40

[monitor]
rows = 240
"""


class CctvCamera(program.Case):
    def setUp(self):
        super().setUp()
        self.write("cameras.toml", CAMERAS)
        self.write("one.toml", '[[cctv]]\nname = "only"\npreset = "report-1990"\n')

    def test_a_file_is_enough(self):
        self.write("ball.toml", program.BALL)
        self.done("render", "ball.toml", "-o", "a.exr")

        def run(*options):
            return self.json("degrade", "a.exr", "-o", "c.png", *options), (self.folder / "c.png").read_bytes()

        report, _ = run("--cctv", "cameras.toml:quiet")
        self.assertEqual((report["camera"], report["sensor"][1]), ("quiet", 240))
        self.assertAlmostEqual(report["noise"]["a"], 1e-4)
        self.assertEqual(run("--cctv", "sit-monochrome"), run("--preset", "sit-monochrome"))
        # The only camera of a file, and its preset with the preset's monitor.
        only, _ = run("--cctv", "one.toml")
        preset, _ = run("--preset", "report-1990")
        self.assertEqual((only.pop("camera"), preset.pop("camera")), ("only", "report-1990"))
        self.assertEqual(only, preset)
        self.assertEqual(only["noise"]["c"], 0.01)

    def test_a_whole_scene_will_do(self):
        self.write("scene.toml", 'format = 1\n[[object]]\nname = "o"\nmesh = "absent.obj"\n' + CAMERAS)
        self.assertEqual(self.json("degrade", "--describe", "scene.toml:bay")["settings"]["glare"], 0.05)

    def test_description(self):
        self.says(self.done("degrade", "--describe", "sit-monochrome"), "estimate: zoom lens", "27.75 dB at white",
                  'noise = "law", noise_a = ', "cd/m^2")
        told = self.json("degrade", "--describe", "cameras.toml:bay")
        self.assertEqual(told["sources"]["glare"], "cameras.toml:4:1")
        self.assertTrue(told["sources"]["white_lux"].startswith("estimate: "))
        self.assertEqual(told["monitor"]["sources"]["rows"], "cameras.toml:12:1")
        self.assertEqual(told["monitor"]["sources"]["gamma"], "default")
        self.assertEqual(told["units"]["white_lux"], "lx")
        self.assertEqual(set(told["settings"]), set(told["sources"]))
        quiet = self.json("degrade", "--describe", "cameras.toml:quiet")["noise"]
        self.assertAlmostEqual(quiet["snr_db_at_5_percent"], 40 - 26.0206, places=3)
        self.assertIsNone(quiet["equivalent_electrons_at_white"])
        self.assertEqual([form["settings"]["noise"] for form in quiet["other_forms"]], ["law", "report"])

    def test_forms_that_are_printed_can_be_given(self):
        """Each exact form, written to a file, gives the law for which it was printed."""
        for name in ("report-1990", "sit-monochrome", "sit-colour-wheel", "ccd-colour"):
            noise = self.json("degrade", "--describe", name)["noise"]
            for form in noise["other_forms"]:
                if "at" in form["differs"].split():
                    continue
                lines = [f"{key} = {value!r}" if key != "noise" else f'noise = "{value}"'
                         for key, value in form["settings"].items()]
                self.write("form.toml", '[[cctv]]\nname = "form"\n' + "\n".join(lines) + "\n")
                again = self.json("degrade", "--describe", "form.toml")["noise"]
                for key in "abc":
                    self.assertAlmostEqual(again[key], noise[key], delta=1e-9 * (noise[key] or 1), msg=(name, form))

    def test_list_has_every_source(self):
        for preset in self.json("degrade", "--list")["presets"]:
            self.assertEqual(list(preset["settings"]), list(preset["sources"]), preset["name"])
            self.assertEqual(list(preset["monitor"]["settings"]), list(preset["monitor"]["sources"]))
            self.assertTrue(all(preset["sources"].values()))
            self.assertIn("snr_db_at_white", preset["noise"])

    def test_wrong_calls(self):
        def says(argument, *parts):
            self.says(self.refused("degrade", "--describe", argument), *parts)

        says("sit-monocrome", "--describe", 'Did you mean "sit-monochrome"?', "FILE.toml")
        says("absent.toml", "absent.toml")
        says("cameras.toml", "2 cameras", '"bay" or "quiet"', "cameras.toml:bay")
        says("cameras.toml:quite", 'no camera "quite"', 'Did you mean "quiet"?')
        says("cameras.toml:", 'no camera ""')
        says(self.write("none.toml", ""), "no [[cctv]]")
        says(self.write("slip.toml", '[[cctv]]\nname = "a"\n[[camera]]\n'), "slip.toml:3:", "monitor")
        says(self.write("two.toml", '[[cctv]]\nname = "a"\nnoise = "law"\nnoise_a = 0.1\nsnr_db = 3\n'),
             "two.toml:5:1", '"snr_db" stands beside "noise_a"')
        # An error in another camera of the file is reported too.
        says(self.write("bad.toml", CAMERAS.replace("glare", "glair")) + ":quiet", "bad.toml:4:1", "glare")
        for beside in (("--preset", "ideal"), ("--scene", "ball.toml")):
            message = self.refused("degrade", "a.exr", "-o", "c.png", "--cctv", "ideal", *beside)
            self.says(message, "--cctv", "cannot be combined with")
        self.says(self.refused("degrade", "one.toml", "-o", "one.toml", "--cctv", "one.toml"), ".png")


if __name__ == "__main__":
    unittest.main()
