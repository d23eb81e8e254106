# SPDX-License-Identifier: Apache-2.0
"""Studies in parts: the results of one process except seconds, for any order, number and fate of
the parts."""
import json
import random
import signal
import subprocess
import time
import unittest

import program
from tiny_bay import BAY, PLAIN_BAY, Case

ORBIT = ("study", "orbit", "bay.toml", "--positions", "17", "--iris", "normal", "--wanted", "box>=0.5", "-o")  # 2 batches per camera
SEVERAL = {
    "orbit": ORBIT,
    "run": ("study", "run", "s.toml", "-o"),
    "visibility": ("study", "visibility", "bay.toml", "-o"),
    "accuracy": ("study", "accuracy", "bay.toml", "--camera", "A", "--size", "8x8", "--wanted", "0.3", "--lights", "4,8",
                 "--paths", "4,16", "-o"),
}
TIMES = ("seconds", "render_seconds", "costs", "solve_seconds", "wall_seconds", "cpu_seconds", "solve_wall_seconds",
         "solve_cpu_seconds", "estimate_cpu_seconds", "memory_mib", "on_front")


class StudyPartsCase(Case):
    def setUp(self):
        super().setUp()
        self.write("bay.toml", PLAIN_BAY)

    def strip(self, value):
        if isinstance(value, dict):
            return {key: self.strip(item) for key, item in value.items() if key not in TIMES}
        return [self.strip(item) for item in value] if isinstance(value, list) else value

    def results(self, folder):
        """All files of a study: pictures as bytes, tables without costs. Plots and pages contain
        seconds."""
        found = {}
        for path in sorted((self.folder / folder).rglob("*")):
            name = str(path.relative_to(self.folder / folder))
            if name.startswith("points") or path.suffix in (".html", ".svg", ".gp") or path.is_dir():
                continue
            found[name] = path.read_bytes()
            if path.suffix == ".json":
                found[name] = self.strip(json.loads(found[name]))
        return found

    def without_seconds(self, accuracy):
        """Points and limits of an accuracy study. Fronts and prices depend on CPU seconds, memory
        on threads."""
        kept = dict(accuracy)
        kept.pop("accuracy.csv")
        kept["accuracy.json"] = {key: kept["accuracy.json"][key] for key in ("points", "limits", "reference", "not_run")}
        return kept

    def started(self, *arguments):
        run = subprocess.Popen([program.PROGRAM, *arguments], cwd=self.folder, stdin=subprocess.DEVNULL,
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(run.wait)
        self.addCleanup(run.kill)
        return run

    def solutions(self, folder):
        return {path.name: (path.stat().st_ino, path.stat().st_mtime_ns)
                for path in (self.folder / folder / "points").glob("*.h5")}


class StudyParts(StudyPartsCase):
    def test_any_order_and_number(self):
        for name, call in SEVERAL.items():
            self.write("bay.toml", PLAIN_BAY if name == "orbit" else BAY)
            self.done(*call, "w-" + name)
            whole = self.results("w-" + name)
            for count in (1, 5):
                with self.subTest(name, parts=count):
                    folder = f"{name}-{count}"
                    order = list(range(1, count + 1))
                    random.Random(count).shuffle(order)
                    for part in [*order, order[0]]:
                        out = self.done(*call, folder, "--part", f"{part}/{count}", "-q", "-j", 1 + part % 2)
                        self.assertEqual(out, "")
                    # The merge writes the PNGs of clean pictures, of which each has a version by a
                    # common white, and the small pictures, whose selection depends on all verdicts.
                    figures = whole.get("study.json", {}).get("figures", [])
                    clean = {figure[key] for figure in figures if figure["clean"]
                             for key in ("file", "same_file") if key in figure}
                    clean |= {file for file in whole if file.startswith("pictures/small-")}
                    self.assertEqual(set(self.results(folder)) - {"pictures"},
                                     {file for file in whole if file.startswith("pictures")} - clean)
                    self.done("merge", folder, "-q")
                    merged = self.results(folder)
                    if name == "accuracy":
                        self.assertEqual(self.without_seconds(merged), self.without_seconds(whole))
                    else:
                        self.assertEqual(merged, whole)
                    if name in ("orbit", "run"):  # no work was repeated
                        self.assertEqual(set(self.costs(folder).values()), {True})

    def test_one_solution_for_all(self):
        self.done(*ORBIT, "o", "--part", "solve", "-q")
        before = self.solutions("o")
        self.assertEqual(len(before), 1)
        for part in range(1, 5):
            self.done(*ORBIT, "o", "--part", f"{part}/4", "-q")
        self.done("merge", "o", "-q")
        self.assertEqual(self.solutions("o"), before)
        told = next((self.folder / "o" / "points").glob("*.h5.json"))
        told.write_text('{"digest": "0123456789abcdef"}')
        for path in (self.folder / "o" / "points").glob("*.exr"):
            path.with_suffix(".json").unlink()
        self.says(self.refused(*ORBIT, "o", "--part", "1/4"), "another solution than the other parts have read")

    def test_parts_that_solve_at_once_read_one(self):
        runs = [self.started(*ORBIT, "o", "--part", f"{part}/6", "-q") for part in range(1, 7)]
        self.assertEqual([run.wait() for run in runs], [0] * 6)
        self.assertEqual(len(self.solutions("o")), 1)
        self.done(*ORBIT, "w")
        self.done("merge", "o", "-q")
        self.assertEqual(self.results("o"), self.results("w"))

    def test_what_is_missing(self):
        for part in (1, 3, 4):
            self.done(*ORBIT, "o", "--part", f"{part}/4", "-q")
        message = self.refused("merge", "o", code=1)
        self.says(message, "not complete", "--part 2/4", "'box>=0.5'", "camera A of bay.toml, batch 2 of 2")
        self.assertNotIn("--part 1/4", message)
        self.assertFalse((self.folder / "o" / "study.json").exists())
        self.done(*ORBIT, "o", "--part", "2/4", "-q")
        self.done("merge", "o", "-q")

    def test_another_study_or_scene(self):
        self.done(*ORBIT, "o", "--part", "1/2", "-q")
        self.says(self.refused("study", "orbit", "bay.toml", "--positions", "35", "-o", "o", "--part", "2/2"), "its arguments")
        bay = (self.folder / "bay.toml").read_text()
        self.write("bay.toml", bay.replace("intensity = 500", "intensity = 501"))
        self.says(self.refused(*ORBIT, "o", "--part", "2/2"), "the scene, ")
        self.write("bay.toml", bay.replace("fov_deg = 40", "fov_deg = 41"))
        self.says(self.refused("merge", "o"), "the settings changed")

    def test_a_torn_part_is_missing(self):
        """A fifth of the files that a merge reads is broken in turn: it lists the part and writes
        nothing, and the part repairs it."""
        for part in (1, 2):
            self.done(*ORBIT, "o", "--part", f"{part}/2", "-q")
        kept = sorted(path for path in (self.folder / "o" / "points").iterdir()
                      if path.suffix in (".json", ".exr") and not path.name.startswith(("parts", "solution")))
        sound = {path: path.read_bytes() for path in kept}
        self.assertGreater(len(sound), 10)
        for torn in kept[::5]:  # their names are digests, so that all kinds occur
            with self.subTest(torn.name):
                torn.write_bytes(sound[torn][:-20])
                message = self.refused("merge", "o", code=1)
                self.says(message, "not complete", "--part ")
                self.assertFalse((self.folder / "o" / "study.json").exists())
                for part in (1, 2):
                    if f"--part {part}/2" in message:
                        self.done(*ORBIT, "o", "--part", f"{part}/2", "-q")
                self.done("merge", "o", "-q")
                (self.folder / "o" / "study.json").unlink()

    def test_a_merge_does_not_solve(self):
        call = SEVERAL["visibility"]  # its report reads the solution again
        self.done(*call, "o", "--part", "1/1", "-q")
        (solution,) = (self.folder / "o" / "points").glob("solution-*.h5")
        solution.unlink()
        self.says(self.refused("merge", "o", code=1), solution.name, "--part solve")
        self.assertFalse(solution.exists())
        self.done(*call, "o", "--part", "solve", "-q")
        self.done("merge", "o", "-q")

    def test_a_signal_ends_the_wait_for_a_solution(self):
        run = self.started(*ORBIT, "o", "--part", "1/2", "--wait", "60", "-q")
        points = self.folder / "o" / "points"
        while not (points / "parts.json").exists():
            time.sleep(0.01)
        time.sleep(0.5)
        run.send_signal(signal.SIGTERM)
        self.assertEqual(run.wait(30), 1)
        self.assertEqual(list(points.glob("solution*")), [])

    def test_who_solves_waits_for_nobody(self):
        begun = time.monotonic()
        self.done(*ORBIT, "o", "--part", "solve", "--wait", "30", "-q")
        self.assertLess(time.monotonic() - begun, 30.0)

    def test_more_parts_than_work(self):
        note = self.run_program(*ORBIT, "o", "--part", "1/100").stderr
        self.says(note, "part 1 of 100: nothing to do: the study has 4 batches")
        note = self.run_program(*SEVERAL["accuracy"], "a", "--part", "99/100").stderr
        self.says(note, "part 99 of 100: nothing to do: the study has ")

    def test_accuracy_in_too_little_memory(self):
        """A step without enough memory is omitted with the same reason as by one process, by the
        part that owns it."""
        call = (*SEVERAL["accuracy"], "w", "--max-memory", "1MiB", "-q")
        self.done(*call)
        whole = self.without_seconds(self.results("w"))
        self.assertEqual(whole["accuracy.json"]["points"], [])
        for part in (1, 2):
            self.done(*call[:-4], "o", "--max-memory", "1MiB", "--part", f"{part}/2", "-q")
        self.done("merge", "o", "-q")
        self.assertEqual(self.without_seconds(self.results("o")), whole)
        # With more memory the same part computes it.
        for part in (1, 2):
            self.done(*call[:-4], "o", "--part", f"{part}/2", "-q")
        self.done("merge", "o", "-q")
        self.assertEqual(self.results("o")["accuracy.json"]["not_run"], [])

    def test_accuracy_of_a_dark_scene_traces_nothing(self):
        bay = (self.folder / "bay.toml").read_text()
        dark = bay[:bay.index("[[light]]")] + bay[bay.index("[[camera]]"):]
        self.write("bay.toml", dark)
        call = SEVERAL["accuracy"]
        self.done(*call, "o", "--part", "1/1", "-q")
        self.assertEqual(list((self.folder / "o" / "points").glob("*.exr")), [])
        self.says(self.done("merge", "o"), "nothing gives light")

    def test_accuracy_counts_a_torn_picture_as_missing(self):
        call = SEVERAL["accuracy"]
        self.done(*call, "o", "--part", "1/1", "-q")
        for torn in sorted((self.folder / "o" / "points").glob("*.exr"))[::5]:
            torn.write_bytes(torn.read_bytes()[:-20])
            self.says(self.refused("merge", "o", code=1), "--part 1/1")
            self.assertFalse((self.folder / "o" / "accuracy.json").exists())
            self.done(*call, "o", "--part", "1/1", "-q")
        self.done("merge", "o", "-q")

    def test_accuracy_has_no_single_solution(self):
        call = SEVERAL["accuracy"]
        self.says(self.refused(*call, "o", "--part", "solve"), "no solution that all of it reads")
        self.says(self.refused(*call, "o", "--part", "1/2", "--time-limit", "9"), "--time-limit")
        self.done(*call, "o", "--part", "1/2", "-q")
        self.says(self.refused("merge", "o", code=1), "--part 2/2")


if __name__ == "__main__":
    unittest.main()
