# SPDX-License-Identifier: Apache-2.0
"""Exit code 3: all output was written, but the wanted error was not reached."""
import json
import unittest

import program

FINE = "quality.error=0.002"
LITTLE = 1.0  # MiB for the work: 1.6 % is reached, eight times the wanted error


class StoppedShort(program.Case):
    def setUp(self):
        super().setUp()
        self.write("ball.toml", program.BALL.split("[quality]")[0])
        self.write("fine.toml", program.BALL.split("[quality]")[0] + "[quality]\nerror = 0.002\n")
        self.little = self.work_memory("ball.toml", LITTLE)

    def short(self, *call):
        run = self.run_program(*call)
        self.assertEqual(run.returncode, 3, f"{call}: {run.stderr}")
        lines = [line for line in run.stderr.splitlines() if line.startswith("earthshine: ")]
        self.assertEqual(len(lines), 1, run.stderr)
        self.says(lines[0], "is not reached")
        return run.stdout, lines[0]

    def test_every_command_that_takes_an_error(self):
        for wish in (("--error", "0.002"), ("--set", FINE)):
            self.says(self.short("solve", "ball.toml", *wish, *self.little)[1], "ball.toml", "0.2 %", "--max-memory")
        for wish in (("--error", "0.0001"), ("--set", "quality.error=0.0001")):
            render = ("render", "ball.toml", "-o", "a.exr", "--size", "24x24", "--time-limit", "0.3", "-q", *wish)
            self.says(self.short(*render)[1], "ball.toml", "0.01 %", "--time-limit")
            self.short(*render, "--camera", "A", "--camera", "above")

    def test_what_there_is_was_written(self):
        out, _ = self.short("solve", "ball.toml", "--error", "0.002", *self.little, "-o", "a.h5", "--json")
        error = json.loads(out)["error"]
        self.assertEqual(error["limit"], "memory")
        self.assertGreater(error["seconds_to_go"], 0)
        self.assertTrue((self.folder / "a.h5").exists())
        # The same error after reading it again, and more time does not reduce it.
        out, line = self.short("solve", "ball.toml", "--error", "0.002", "--solution", "a.h5", "--json")
        self.says(line, "used unchanged")
        error = json.loads(out)["error"]
        self.assertEqual((error["limit"], error["seconds_to_go"]), ("given", None))
        self.assertEqual(error["steps"][0]["patches"], json.loads(out)["patches"])
        self.short("render", "ball.toml", "--size", "24x24", "--error", "0.0001", "--time-limit", "0.3", "-o", "a.exr")
        self.assertTrue((self.folder / "a.exr").exists())

    def test_what_is_done_is_done(self):
        self.done("solve", "ball.toml", "--error", "0.3")
        self.done("render", "ball.toml", "-o", "a.exr", "--size", "24x24", "--error", "0.3")
        self.done("render", "ball.toml", "-o", "a.exr", "--size", "24x24", "--time-limit", "0.3")  # no wanted error
        self.done("render", "ball.toml", "-o", "a.exr", "--size", "24x24", "--set", "quality.error=0.02", "--no-error")

    def test_a_scene_alone_changes_nothing(self):
        self.done("solve", "fine.toml", *self.little)

    def test_settings_that_win_over_the_error_are_named(self):
        knobs = ("--set", "quality.patch_edge=1", "--set", "quality.form_factor_rays=16")
        self.says(self.short("solve", "ball.toml", "--error", "0.0001", *knobs)[1], "quality.patch_edge", "form_factor_rays")
        self.done("solve", "fine.toml", *knobs)

    def test_help_says_it(self):
        for call in ([], ["render"], ["study", "run"]):
            self.says(" ".join(self.done(*call, "--help").split()), "Exit codes: 0 done;", "3 done in part: the wanted error was not reached")


if __name__ == "__main__":
    unittest.main()
