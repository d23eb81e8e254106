# SPDX-License-Identifier: Apache-2.0
"""Interrupted visibility studies resume from finished results."""
import json
import os
import pathlib
import random
import shlex
import signal
import subprocess
import time
import unittest

import program
from tiny_bay import BAY, PLAIN_BAY, Case


class Resume(Case):
    CALL = ("study", "orbit", "bay.toml", "--positions", "12", "--wanted", "box>=0.5")

    def setUp(self):
        super().setUp()
        self.write("bay.toml", PLAIN_BAY)

    def started(self, *arguments):
        run = subprocess.Popen([program.PROGRAM, *arguments], cwd=self.folder, stdin=subprocess.DEVNULL,
                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        self.addCleanup(run.stderr.close)
        self.addCleanup(run.wait)
        self.addCleanup(run.kill)
        return run

    def test_a_killed_run_goes_on(self):
        begin = time.monotonic()
        self.done(*self.CALL, "-o", "whole")
        took = time.monotonic() - begin
        # Files of an incomplete write, and of a write in progress.
        points = self.folder / "o" / "points"
        points.mkdir(parents=True)
        gone = self.started("--version")
        gone.wait()
        torn = [points.parent / f".study.json.{gone.pid}-3.part", points / f".0123.exr.{gone.pid}-0.part"]
        at_work = points / f".4567.exr.{os.getpid()}-0.part"
        for path in (*torn, at_work):
            path.write_bytes(b"half")
        chance = random.Random(1)
        ended = 0
        for _ in range(5):
            run = self.started(*self.CALL, "-o", "o")
            time.sleep(took * chance.random())
            run.send_signal(signal.SIGKILL)
            run.wait()
            ended += run.returncode == -signal.SIGKILL
        self.assertGreater(ended, 0)
        facts = [json.loads(path.with_suffix(".json").read_text())["facts"]
                 for path in (self.folder / "o" / "points").glob("*.exr") if path.with_suffix(".json").exists()]
        whole_pictures = [of_one for of_one in facts if "relative_noise" in of_one]  # not its noise
        last = self.run_program(*self.CALL, "-o", "o")
        self.assertEqual(last.returncode, 0, last.stderr)
        self.assertNotIn("recomputed", last.stderr)
        self.assertEqual(self.without_times(self.study("o")), self.without_times(self.study("whole")))
        found = [stage for stage, found in self.costs("o").items() if found and stage.startswith("picture")]
        self.assertEqual(len(found), len(whole_pictures))
        at_work.unlink()
        self.assertEqual(self.all_files("o"), self.all_files("whole"))  # no torn or temporary files

    def test_a_target_that_moves_is_judged_anew(self):
        """Motion blurs a target on the monitor; the picture is of standing objects and stays."""
        call = ("study", "visibility", "bay.toml", "--size", "16x12", "-q", "-o")
        self.done(*call, "o")
        moving = PLAIN_BAY.replace('name = "box"\n', 'name = "box"\nvelocity = [3, 0, 0]\n', 1)
        self.assertNotEqual(moving, PLAIN_BAY)
        self.write("bay.toml", moving)
        self.done(*call, "o")
        self.done(*call, "fresh")
        self.assertEqual(self.without_times(self.study("o")), self.without_times(self.study("fresh")))
        found = self.costs("o")
        self.assertTrue(all(known == (not stage.startswith("conditions")) for stage, known in found.items()), found)

    def test_torn_parts_are_done_again(self):
        self.done(*self.CALL, "-o", "o")
        whole = self.without_times(self.study("o"))
        points = self.folder / "o" / "points"
        for path in points.glob("*"):
            path.write_bytes(path.read_bytes()[:100])
        run = self.run_program(*self.CALL, "-o", "o")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.says(run.stderr, "recomputed")
        self.assertEqual(self.without_times(self.study("o")), whole)
        self.assertEqual(set(self.costs("o").values()), {False})

    def test_work_of_another_constant_is_not_believed(self):
        """Changes one constant in one source file; compiles and links the program like the build.
        """
        build, top = pathlib.Path(program.PROGRAM).parent, pathlib.Path(__file__).resolve().parents[2]
        source, constant = top / "degrade/parts/iris.cpp", "constexpr double normal_power = "
        code = source.read_text(encoding="utf-8")
        self.assertEqual(code.count(constant), 1)
        changed, objects, other = self.folder / "iris.cpp", self.folder / "iris.o", self.folder / "other"
        changed.write_text(code.replace(constant, constant + "1.0 + "), encoding="utf-8")

        def compiles_source(line):
            """The source itself, or the file that includes all of its folder."""
            file = pathlib.Path(line[line.index("-c") + 1]) if "-c" in line else source.parent
            return file == source or (file.suffix == ".cxx" and f'"{source}"' in file.read_text(encoding="utf-8"))
        commands = subprocess.run(["ninja", "-C", build, "-t", "commands", "earthshine"], capture_output=True, text=True,
                                  check=True).stdout
        lines = [shlex.split(line) for line in commands.splitlines()]
        compiled = next(line for line in lines if compiles_source(line))
        together = pathlib.Path(compiled[compiled.index("-c") + 1])
        if together != source:
            text = together.read_text(encoding="utf-8").replace(str(source), str(changed))
            changed = self.folder / "together.cxx"
            changed.write_text(text, encoding="utf-8")
        linked = [word for word in lines[-1] if word not in (":", "&&")]
        for line, option, path in ((compiled, "-c", changed), (compiled, "-o", objects),
                                   (compiled, "-MF", objects.with_suffix(".d")), (linked, "-o", other)):
            line[line.index(option) + 1] = str(path)
        linked.insert(1, str(objects))  # before the library with the original
        for line in (compiled, linked):
            subprocess.run(line, cwd=build, check=True)
        self.done(*self.CALL, "-o", "o")
        run = subprocess.run([other, *self.CALL, "-o", "o"], cwd=self.folder, capture_output=True, text=True, check=False)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual(set(self.costs("o").values()), {False})
        # Each program finds its own results.
        self.done(*self.CALL, "-o", "o")
        self.assertEqual(set(self.costs("o").values()), {True})

    def test_a_changed_digit_is_found(self):
        self.done(*self.CALL, "-o", "o")
        whole = self.without_times(self.study("o"))
        changed = 0
        for path in (self.folder / "o" / "points").glob("*.json"):
            part = json.loads(path.read_text())
            for key, value in part["facts"].items():
                if isinstance(value, float):
                    part["facts"][key] = value * 1.5 + 1.0
                    changed += 1
            path.write_text(json.dumps(part))
        self.assertGreater(changed, 0)
        run = self.run_program(*self.CALL, "-o", "o")
        self.says(run.stderr, "is broken; it is recomputed")
        self.assertEqual(self.without_times(self.study("o")), whole)

    @staticmethod
    def cpu_seconds(run):
        fields = pathlib.Path(f"/proc/{run.pid}/stat").read_text().rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def test_a_signal_ends_a_solve_at_once(self):
        """A signal ends a solve at once, without a stored solution."""
        call = ("study", "orbit", "bay.toml", "--positions", "4", "-o", "o", "--set", "quality.patch_edge=0.1",
                "--set", "quality.form_factor_rays=16384")
        for number in (signal.SIGINT, signal.SIGTERM):
            run = self.started(*call)
            while run.poll() is None and self.cpu_seconds(run) < 1.0:  # about 0.1 before the solve, 5 in it
                time.sleep(0.01)
            run.send_signal(number)
            run.communicate()
            self.assertEqual(run.returncode, -number)
            self.assertEqual(list(self.folder.glob("o/points/solution-*.h5")), [])

    def leaves_at_once(self, run, after):
        """Ctrl-C, after this many more CPU seconds, ends the run within 1.5 CPU seconds."""
        taken = self.cpu_seconds(run) + after
        while run.poll() is None and self.cpu_seconds(run) < taken:
            time.sleep(0.01)
        run.send_signal(signal.SIGINT)
        errors = run.stderr.read()
        _, status, usage = os.wait4(run.pid, 0)
        self.assertEqual(os.waitstatus_to_exitcode(status), 1, errors)
        self.says(errors, "interrupted", "again")
        self.assertLess(usage.ru_utime + usage.ru_stime - taken, 1.5)

    def test_a_signal_leaves_a_picture_at_once(self):
        """Unfinished pictures are not kept, so that a signal ends them at once."""
        run = self.started("study", "orbit", "bay.toml", "--positions", "4", "-o", "o", "--size", "512x512")
        while run.poll() is None and not list(self.folder.glob("o/points/solution-*.h5")):
            time.sleep(0.01)
        self.leaves_at_once(run, 0.3)

    def test_a_signal_leaves_a_picture_by_spread_lights_at_once(self):
        """The same for a picture by distributed lights, also in its initial sampling."""
        self.write("study.toml", '''format = 1
scene = "bay.toml"
size = "128x128"
[orbit]
positions = 4
[[picture]]
name = "spread"
camera = "A"
shows = "distributed"
lights = 65536
''')
        run = self.started("study", "run", "study.toml", "-o", "o")
        while run.poll() is None and not list(self.folder.glob("o/points/*.json")):
            time.sleep(0.01)
        self.leaves_at_once(run, 1.0)
        self.assertEqual(list(self.folder.glob("o/pictures/*.exr")), [])

    def test_an_interrupted_run_says_so_and_goes_on(self):
        self.write("bay.toml", BAY)
        call = ("study", "orbit", "bay.toml", "--positions", "4", "-o", "o", "--wanted", "box>=0.5",
                "--error", "0.001")
        run = self.started(*call)
        while run.poll() is None and not list(self.folder.glob("o/points/solution-*.h5")):
            time.sleep(0.01)
        time.sleep(0.3)
        run.send_signal(signal.SIGINT)
        _, errors = run.communicate()
        self.assertEqual(run.returncode, 1, errors)
        self.says(errors, "interrupted", "again")
        study = self.no_nonsense("o")
        self.assertFalse(study["complete"])
        self.assertEqual(len(study["conditions"]), 4)
        self.done("report", "o")
        self.says((self.folder / "o" / "report.html").read_text(encoding="utf-8"), "stopped")
        self.done(*call)
        self.assertTrue(self.study("o")["complete"])
        self.assertEqual(len(self.study("o")["results"]), 4 * 2 * 2)


if __name__ == "__main__":
    unittest.main()
