# SPDX-License-Identifier: Apache-2.0
"""Faults in parts of pictures and studies: kills, full disks, duplicate starts, other
builds, wrong clocks. No result is lost or merged wrongly: the final result equals that by one
process."""
import os
import pathlib
import random
import shutil
import signal
import subprocess
import time
import unittest

import parts_test
import program
import study_parts_test

ORBIT = study_parts_test.ORBIT
# The call, the folder for `merge`, and the position of the parts' record in it.
WORKS = {
    "render": (parts_test.CALL, "v.exr.parts", "."),
    "study": ((*ORBIT, "o"), "o", "points"),
}


def other_build(folder):
    """The program with another build id, as any change of its code or constants would give."""
    code = pathlib.Path(program.PROGRAM).read_bytes()
    note = b"\x04\0\0\0\x14\0\0\0\x03\0\0\0GNU\0"  # sizes of name and digest, NT_GNU_BUILD_ID
    at = code.index(note) + len(note)
    other = folder / "other"
    other.write_bytes(code[:at] + bytes([code[at] ^ 1]) + code[at + 1:])
    other.chmod(0o755)
    return other


class PartFaults(study_parts_test.StudyPartsCase):
    alone = {}  # results of each work by one process

    def setUp(self):
        super().setUp()
        self.write("ball.toml", parts_test.BALL)

    def outcome(self, name):
        """Output of the work; deletes it."""
        if name == "study":
            found = self.results("o")
            shutil.rmtree(self.folder / "o")
            return found
        names = parts_test.OUTPUTS
        found = {file: (self.folder / file).read_bytes() for file in names}
        shutil.rmtree(self.folder / WORKS[name][1], ignore_errors=True)
        for file in names:
            (self.folder / file).unlink()
        return found

    def works(self):
        """Each work with its results by one process, computed once for all tests."""
        for name, (call, folder, record) in WORKS.items():
            if name not in self.alone:
                self.done(*call, "-q")
                self.alone[name] = self.outcome(name)
            yield name, call, folder, record, self.alone[name]

    def merged(self, name, folder):
        self.done("merge", folder, "-q")
        self.assertEqual([str(path) for path in self.folder.rglob(".*")], [])
        return self.outcome(name)

    def parts(self, call, *numbers, of=2):
        for number in numbers:
            self.done(*call, "--part", f"{number}/{of}", "-q")

    def test_kills_at_random_moments(self):
        """Each part, killed at EARTHSHINE_KILLS (ten) moments."""
        chance, kills = random.Random(1), int(os.environ.get("EARTHSHINE_KILLS", "10"))
        for name, call, folder, _, whole in self.works():
            killed, begun = 0, time.monotonic()
            self.done(*call, "-q")
            seconds = time.monotonic() - begun
            self.outcome(name)
            # A machine that has become faster finishes shares before their kill: the next ones come earlier.
            kill, latest = 0, 0.5 * seconds
            while kill < kills or killed <= kills // 5:
                run = self.started(*call, "--part", f"{chance.randint(1, 3)}/3", "-q")
                time.sleep(latest * (kill % kills + chance.random()) / kills)
                run.send_signal(signal.SIGKILL)
                run.wait()
                kill += 1
                killed += run.returncode == -signal.SIGKILL
                if run.returncode == 0:  # a finished share would be skipped at once
                    latest *= 0.8
                    shutil.rmtree(self.folder / folder)
            self.parts(call, 1, 2, 3, of=3)
            self.assertEqual(self.merged(name, folder), whole)

    def test_two_schedulers_start_the_same_part(self):
        for name, call, folder, _, whole in self.works():
            for part in ("1/2", "2/2"):
                runs = [self.started(*call, "--part", part, "-q") for _ in range(4)]
                self.assertEqual([run.wait() for run in runs], [0] * 4)
            self.assertEqual(self.merged(name, folder), whole)

    def test_a_part_of_another_build(self):
        other = other_build(self.folder)
        for name, call, folder, record, whole in self.works():
            subprocess.run([other, *call, "--part", "1/2", "-q"], cwd=self.folder, check=True)
            self.says(self.refused(*call, "--part", "2/2"), "parts.json", "the program changed")
            self.says(self.refused("merge", folder), "the program changed")
            (self.folder / folder / record / "parts.json").unlink()
            self.parts(call, 2)
            self.says(self.refused("merge", folder, code=1), "--part 1/2")  # the other call's work
                                                                            # does not count
            self.parts(call, 1)
            self.assertEqual(self.merged(name, folder), whole)

    def test_clocks_that_differ_by_an_hour(self):
        for name, call, folder, _, whole in self.works():
            for part in (1, 2):
                self.parts(call, part)
                for path in [*(self.folder / folder).rglob("*"), *self.folder.glob("[ft][0-9].*")]:
                    os.utime(path, (time.time() + 3600, time.time() + 3600 * (-1) ** part))
            self.assertEqual(self.merged(name, folder), whole)

    def test_a_full_disk_in_one_part(self):
        """No file may grow beyond its limit in kB: for the writer this is a full disk (EFBIG for
        ENOSPC)."""
        for name, call, folder, _, whole in self.works():
            self.parts(call, 1)
            before = {path: path.read_bytes() for path in self.folder.rglob("*") if path.is_file()}
            limited = subprocess.run(["bash", "-c", "trap '' XFSZ; ulimit -f 1; exec \"$@\"", "sh", program.PROGRAM, *call,
                                      "--part", "2/2", "-q"], cwd=self.folder, capture_output=True, text=True, check=False)
            self.assertEqual(limited.returncode, 1, limited.stderr)
            self.says(limited.stderr, "cannot be written")
            self.assertEqual({path: path.read_bytes() for path in before}, before)
            self.says(self.refused("merge", folder, code=1), "--part 2/2")
            self.parts(call, 2)
            self.assertEqual(self.merged(name, folder), whole)


if __name__ == "__main__":
    unittest.main()
