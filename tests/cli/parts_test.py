# SPDX-License-Identifier: Apache-2.0
"""Pictures in parts: the bytes of one process, for any order, number and fate of the
parts."""
import json
import os
import pathlib
import random
import shutil
import struct
import subprocess
import time
import unittest

import exr
import program
from program import BALL, Case

# Pixels whose samples depend on their neighbours, on no other pixel, or on the whole picture.
WAYS = {
    "denoised": ("--set", "quality.denoise=true"),
    "alone": ("--set", "quality.denoise=false", "--indirect", "none"),
    "paths": ("--indirect", "paths"),
    "lights": ("--indirect", "distributed", "--per-light"),
    "to an error": ("--error", "0.2", "--aov", "direct,variance,object,crypto_object"),
}
CALL = ("render", "ball.toml", "--camera", "all", "-o", "v.exr", "--png", "v.png")
OUTPUTS = ("v-A.exr", "v-above.exr", "v-A.png", "v-above.png")


class PartCase(Case):
    def setUp(self):
        super().setUp()
        self.write("ball.toml", BALL)

    def bytes_of(self, names=OUTPUTS):
        return {name: (self.folder / name).read_bytes() for name in names}

    def whole(self, *more, call=CALL, names=OUTPUTS):
        """Output of one process; deletes it."""
        self.done(*call, *more)
        return self.taken(names)

    def taken(self, names=OUTPUTS):
        found = self.bytes_of(names)
        for name in names:
            (self.folder / name).unlink()
        return found

    def started(self, *arguments, **more):
        run = subprocess.Popen([program.PROGRAM, *arguments], cwd=self.folder, stdin=subprocess.DEVNULL,
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, **more)
        self.addCleanup(run.wait)
        self.addCleanup(run.kill)
        return run

    def merged(self):
        for name in OUTPUTS:
            self.assertFalse((self.folder / name).exists(), name)
        self.done("merge", "v.exr.parts", "-q")
        return self.taken()


class SameBytes(PartCase):
    def test_any_order_number_and_threads(self):
        for name, way in WAYS.items():
            whole = self.whole(*way)
            for count in (1, 3, 5):
                with self.subTest(name, parts=count):
                    order = list(range(1, count + 1))
                    random.Random(count).shuffle(order)
                    for part in [*order, order[0]]:  # and one of them twice
                        self.done(*CALL, *way, "--part", f"{part}/{count}", "-j", 1 + part % 3, "-q")
                    self.assertEqual(self.merged(), whole)
                    shutil.rmtree(self.folder / "v.exr.parts")

    def test_folders_that_were_copied_or_renamed(self):
        whole = self.whole()
        for part in (1, 2):
            self.done(*CALL, "--part", f"{part}/2", "-q")
        # With the inputs of the call: the result is written there.
        copy = self.folder / "copy"
        copy.mkdir()
        shutil.copytree(self.folder / "v.exr.parts", copy / "v.exr.parts")
        shutil.copy(self.folder / "ball.toml", copy)
        self.done("merge", "copy/v.exr.parts", "-q")
        self.assertEqual({name: (copy / name).read_bytes() for name in OUTPUTS}, whole)
        self.assertFalse(any((self.folder / name).exists() for name in OUTPUTS))
        # Without inputs: the result has the name of the renamed folder.
        (self.folder / "v.exr.parts").rename(self.folder / "copy/w.exr.parts")
        self.done("merge", "copy/w.exr.parts", "-q")
        self.assertEqual((copy / "w-A.exr").read_bytes(), whole["v-A.exr"])
        for piece in (copy / "w.exr.parts").glob("*.exr"):
            piece.unlink()
        self.says(self.refused("merge", "copy/w.exr.parts", code=1), "copy/w.exr", "--part 1/2", f"missing parts in '{self.folder.resolve()}'")
        (copy / "w.exr.parts").rename(copy / "w")
        self.says(self.refused("merge", "copy/w"), "has the parts of v.exr", ".parts")
        self.done("study", "visibility", "ball.toml", "-o", "d/", "--size", "8x8", "--part", "1/1", "-q")
        (self.folder / "d").rename(self.folder / "e")
        self.done("merge", "e", "-q")
        self.assertTrue((self.folder / "e/report.html").exists())
        self.assertFalse((self.folder / "d").exists())

    def test_the_report_but_for_what_it_took(self):
        whole = self.json(*CALL)
        for part in (2, 1):
            self.done(*CALL, "--part", f"{part}/2", "-q")
        merged = json.loads(self.done("merge", "v.exr.parts", "--json"))
        for report in [*whole, *merged]:
            for key in ("seconds", "peak_memory_mib", "rays"):
                del report[key]
        self.assertEqual(merged, whole)

    def test_shares_are_cameras(self):
        # Two cameras in 3 parts: 0, 1 and 1.
        self.says(self.run_program(*CALL, "--part", "1/3").stderr, "fewer cameras than parts")
        for part, camera in ((2, "A"), (3, "above")):
            before = set((self.folder / "v.exr.parts").glob("*.exr"))
            self.done(*CALL, "--part", f"{part}/3", "-q")
            (piece,) = set((self.folder / "v.exr.parts").glob("*.exr")) - before
            header, *_ = exr.read(piece)
            columns, rows = {"A": (32, 24), "above": (20, 20)}[camera]
            self.assertEqual(struct.unpack("<iiii", header["dataWindow"]), (0, 0, columns - 1, rows - 1))

    def test_a_job_array_says_which_part(self):
        whole = self.whole()
        slurm = {"SLURM_ARRAY_TASK_MIN": "4", "SLURM_ARRAY_TASK_MAX": "5", "SLURM_ARRAY_TASK_COUNT": "2"}
        for task in ("4", "5"):
            run = self.run_program(*CALL, "--part", "auto", env=os.environ | slurm | {"SLURM_ARRAY_TASK_ID": task})
            self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual(self.merged(), whole)
        shutil.rmtree(self.folder / "v.exr.parts")
        for variable, index in (("PBS_ARRAY_INDEX", "1"), ("PBS_ARRAYID", "2"), ("SLURM_ARRAY_TASK_ID", "3")):
            run = self.run_program(*CALL, "--part", "auto/3", env=os.environ | {variable: index})
            self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual(self.merged(), whole)

    def test_one_solution(self):
        self.done(*CALL, "--part", "solve", "-q")
        self.says(self.refused("merge", "v.exr.parts", code=1), "no part was run", "1/N to N/N")
        (solution,) = (self.folder / "v.exr.parts").glob("solution-*.h5")
        before = solution.stat()
        for part in (1, 2):
            self.done(*CALL, "--part", f"{part}/2", "-q")
        after = solution.stat()
        self.assertEqual((before.st_ino, before.st_mtime_ns), (after.st_ino, after.st_mtime_ns))
        self.assertEqual(self.merged(), self.whole())
        # A complete but outdated solution, and a valid solution that the other parts have not read.
        mine = solution.read_bytes()
        self.done("solve", "ball.toml", "--seed", "2", "-o", "other.h5", "-q")
        solution.write_bytes((self.folder / "other.h5").read_bytes())
        self.says(self.refused(*CALL, "--part", "1/2"), "stale")
        solution.write_bytes(mine)
        told = pathlib.Path(str(solution) + ".json")
        told.write_text(told.read_text().replace(json.loads(told.read_text())["digest"], "0123456789abcdef"))
        for call in ((*CALL, "--part", "1/2"), ("merge", "v.exr.parts")):
            self.says(self.refused(*call), "another solution than the other parts have read")

    def test_a_part_waits_for_the_solution(self):
        waits = self.started(*CALL, "--part", "1/2", "--wait", "60", "-q")
        parts = self.folder / "v.exr.parts"
        while not (parts / "parts.json").exists():
            time.sleep(0.01)
        time.sleep(0.5)
        self.assertEqual(list(parts.glob("solution*")), [])
        self.done(*CALL, "--part", "solve", "-q")
        self.assertEqual(waits.wait(), 0)
        self.done(*CALL, "--part", "2/2", "-q")
        self.assertEqual(self.merged(), self.whole())


class Faults(PartCase):
    def test_what_is_missing_is_listed_with_its_command(self):
        self.done(*CALL, "--set", "camera.A.fov_deg=30 ", "--part", "2/3", "-q")
        message = self.refused("merge", "v.exr.parts", code=1)
        self.says(message, "not complete", "camera above", "--part 3/3", "'camera.A.fov_deg=30 '")
        self.assertNotIn("--part 2/3", message)
        self.assertFalse((self.folder / "v-A.exr").exists())
        self.done(*CALL, "--set", "camera.A.fov_deg=30 ", "--part", "3/3", "-q")
        self.assertEqual(self.merged(), self.whole("--set", "camera.A.fov_deg=30 "))

    def test_a_part_of_another_scene_or_setting(self):
        self.done(*CALL, "--part", "1/2", "-q")
        self.says(self.refused(*CALL, "--seed", "2", "--part", "2/2"), "its arguments")
        self.says(self.refused(*CALL, "--part", "2/3"), "the number of parts (there: 2)")
        self.write("ball.toml", BALL.replace("radius = 0.5", "radius = 0.4"))
        self.says(self.refused(*CALL, "--part", "2/2"), "the scene changed")
        self.write("ball.toml", BALL.replace("position = [3, -3, 2]", "position = [3, -3, 3]"))
        self.says(self.refused("merge", "v.exr.parts"), "the cameras changed")
        self.write("ball.toml", BALL.replace("gather_rays = 16", "gather_rays = 32"))
        self.says(self.refused("merge", "v.exr.parts"), "the settings changed")

    def test_a_torn_part_is_missing(self):
        for part in (1, 2):
            self.done(*CALL, "--part", f"{part}/2", "-q")
        whole = self.whole()
        torn = sorted((self.folder / "v.exr.parts").glob("*.exr"))[0]
        torn.write_bytes(torn.read_bytes()[:-20])
        self.says(self.refused("merge", "v.exr.parts", code=1), "has lost its picture", "--part")
        for part in (1, 2):
            self.done(*CALL, "--part", f"{part}/2", "-q")
        self.assertEqual(self.merged(), whole)

    def test_a_disk_that_is_full(self):
        """ENOSPC by a memory file system that is filled while a part is missing."""
        script = """set -e
mount -t tmpfs -o size=4m tmpfs full; cp ball.toml full; cd full
"$@" --part 1/2 -q
dd if=/dev/zero of=filler bs=1k 2>/dev/null || true
for words in "--part 2/2" ""; do
  if [ "$words" ]; then set +e; "$@" --part 2/2 -q; else set +e; "$0" merge v.exr.parts; fi
  test $? = 1 || exit 9; set -e
done
ls -A v.exr.parts | grep '^[.]' && exit 8
rm filler
"$@" --part 2/2 -q; "$0" merge v.exr.parts -q; cp v-*.exr v-*.png ..
"""
        (self.folder / "full").mkdir()
        mounts = ["unshare", "--user", "--map-root-user", "--mount"]
        if subprocess.run([*mounts, "mount", "-t", "tmpfs", "tmpfs", "full"], cwd=self.folder, capture_output=True,
                          check=False).returncode != 0:
            self.skipTest("no file system can be mounted here")
        whole = self.whole()
        run = subprocess.run([*mounts, "bash", "-c", script, program.PROGRAM, program.PROGRAM, *CALL], cwd=self.folder,
                             capture_output=True, text=True, check=False)
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        self.says(run.stderr, "No space left on device", "is not complete", "--part 2/2")
        self.assertEqual(self.bytes_of(), whole)

    def test_calls_that_cannot_be_shared_out(self):
        self.says(self.refused("render", "ball.toml", "--only-pixel", "1,1", "--part", "1/2"), "--only-pixel")
        self.says(self.refused(*CALL, "--time-limit", "3", "--part", "1/2"), "--time-limit")
        self.says(self.refused(*CALL, "--part", "3/2"), "3", "1 to 2")
        self.says(self.refused(*CALL, "--part", "half"), "K/N")
        self.says(self.refused(*CALL, "--part", "auto"), "SLURM_ARRAY_TASK_ID", "K/N")
        self.says(self.refused("merge", "."), "parts.json")
        for call in (CALL, ("study", "visibility", "ball.toml", "-o", "d", "--size", "8x8")):
            run = self.run_program(*call, "--part", "1/2", "--json")
            self.assertEqual((run.returncode, run.stdout), (0, ""))
            self.says(run.stderr, "note: --json has no effect: a part reports nothing, and merge --json all of it")


if __name__ == "__main__":
    unittest.main()
