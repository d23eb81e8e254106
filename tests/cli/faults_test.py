# SPDX-License-Identifier: Apache-2.0
"""Failing system calls in every command that writes: no file is torn, every failure is reported,
and the next run writes the bytes of an undisturbed one.

Also: the process is killed before any of the calls that change files, which are all the states that
files can be in; a power failure at the same time, which drops unflushed data and names in unflushed
folders; file systems without links, locks, or renaming onto an existing file; clocks that jump.

Tests some calls of each kind. EARTHSHINE_FAULTS=all tests all calls and prints a table (an hour).
EARTHSHINE_FAULTS=NAME does so for one command or one column of the table; the slowest command,
`study accuracy`, is tested only with it. Exit code 77 where calls cannot be intercepted: not on
Linux on x86-64, or with a sanitizer, which needs to be preloaded itself.
"""
import csv
import errno
import io
import json
import os
import pathlib
import platform
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest

import program
import tiny_bay

QUALITY = "[quality]\npatch_edge = 2\nrefine = false\nform_factor_rays = 16\ngather_rays = 4\n"
SCENES = {name: re.sub("resolution = .*", "resolution = [16, 12]", re.sub("cctv = .*", "", text.split("[quality]")[0])) + QUALITY
          for name, text in (("ball.toml", program.BALL.replace("[quality]", tiny_bay.SMALL_MONITOR + "[quality]")), ("bay.toml", tiny_bay.BAY))}
STUDY = """format = 1
scene = "bay.toml"
targets = ["box"]
cameras = ["B"]
size = "16x12"

[orbit]
positions_deg = [0]

[[picture]]
name = "noon"
camera = "B"
position_deg = 0
"""
RENDER = ("render", "ball.toml", "--camera", "A", "-o", "a.exr")
ORBIT = ("study", "orbit", "bay.toml", "-o", "d", "--positions", "2")
SOLVE = ("solve", "ball.toml", "-o", "s.h5", "--glb", "s.glb")
RUN = ("study", "run", "s.toml", "-o", "d")
VISIBILITY = ("study", "visibility", "bay.toml", "-o", "d")
COMPARE = ("study", "compare", "ball.toml", "-o", "d", "--lights", "2")
PICTURES = (*RENDER, "--png", "a.png")
PART = (*RUN, "--part", "solve")
ACCURACY = ("study", "accuracy", "ball.toml", "-o", "d", "--wanted", "0.5", "--lights", "2", "--paths", "2")
DEGRADE = ("degrade", "a.exr", "-o", "c.png", "--scene", "ball.toml")
RELIGHT = ("relight", "a.exr", "--set", "sun=0.5", "-o", "b.exr", "--png", "b.png")
OLDER = ("--seed", "2")
# Calls before the test, which write its inputs and older results; the tested call.
COMMANDS = {
    "render": ([(*PICTURES, *OLDER)], PICTURES),
    "render --part": ([(*RENDER, *OLDER)], (*RENDER, "--part", "1/2")),
    "merge": ([(*RENDER, *OLDER), (*RENDER, "--part", "1/2"), (*RENDER, "--part", "2/2")], ("merge", "a.exr.parts")),
    "solve": ([(*SOLVE, *OLDER)], SOLVE),
    "degrade": ([RENDER, (*DEGRADE, *OLDER)], DEGRADE),
    "relight": ([(*RENDER, *OLDER, "--per-light"), RELIGHT, (*RENDER, "--per-light")], RELIGHT),
    "fit-phong": ([], ("fit-phong", "paint.csv")),
    "study run": ([(*RUN, *OLDER)], RUN),
    "study run --part solve": ([(*RUN, *OLDER)], PART),
    "study orbit": ([(*ORBIT, *OLDER)], ORBIT),
    "study visibility": ([(*VISIBILITY, *OLDER)], VISIBILITY),
    "study compare": ([(*COMPARE, *OLDER)], COMPARE),
    "study accuracy": ([(*ACCURACY, *OLDER)], ACCURACY),
    "report": ([ORBIT], ("report", "d")),
}
DEAR = ("study accuracy",)  # only on request
# Kind of call, error, and whether all later calls fail too.
FAULTS = {
    "full disk": ("write", errno.ENOSPC, True),
    "write": ("write", errno.EIO, False),
    "rename": ("rename", errno.EIO, False),
    "open": ("open", errno.EIO, False),
    "flush": ("fsync", errno.EIO, False),
    "memory": ("memory", errno.ENOMEM, True),
    "memory once": ("memory", errno.ENOMEM, False),
    "kill": ("end", 0, False),
    "power cut": ("end", 0, False),
}
# A missing feature of a file system, or a clock error; whether the work must succeed, or may be
# refused with all files kept.
PLACES = {
    "no links": ({"FAULT_KIND": "link", "FAULT_ERROR": errno.EPERM}, True),
    "no locks": ({"FAULT_KIND": "lock", "FAULT_ERROR": errno.EOPNOTSUPP}, True),
    "no locks on this mount": ({"FAULT_KIND": "lock", "FAULT_ERROR": errno.ENOSYS}, True),
    "no lock server": ({"FAULT_KIND": "lock", "FAULT_ERROR": errno.ENOLCK}, True),
    "no flush of folders and files": ({"FAULT_KIND": "fsync", "FAULT_ERROR": errno.EINVAL}, True),
    "no rename onto a file": ({"FAULT_KIND": "over", "FAULT_ERROR": errno.EEXIST}, False),
    "clock that jumps by an hour": ({"FAULT_KIND": "lock", "FAULT_AT": 0, "FAULT_CLOCK": 3600}, True),
}
UNFINISHED = re.compile(r"(^|/)\.[^/]*\.part$")
WANTED = os.environ.get("EARTHSHINE_FAULTS", "")
PICKED = 1  # calls per kind of fault and command, unless all are tested


def files_of(folder):
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def cut_power(folder, old, log):
    """Drops data that did not reach the disk: bytes written after a file's last flush, names given
    after their folder's last flush."""
    lines = [line.split() for line in log.read_text().splitlines()]
    last = {(what, int(inode)): k for k, (what, inode) in enumerate(lines)}
    for path in [path for path in folder.rglob("*") if path.is_file()]:
        own, above = path.stat().st_ino, path.parent.stat().st_ino
        name = str(path.relative_to(folder))
        if last.get(("r", own), -1) > last.get(("s", above), -1):
            path.unlink()
            if name in old:
                path.write_bytes(old[name])
        elif last.get(("w", own), -1) > last.get(("s", own), -1):
            path.write_bytes(b"")


def results_of(files):
    """Without a study's record of finished work, and without the page that shows it."""
    found = dict(files)
    if "d/study.json" in found:
        found["d/study.json"] = tiny_bay.Case.without_times(json.loads(found["d/study.json"]))
        found["d/report.html"] = b""
    return steady(found) if "d/accuracy.csv" in found else found


def without_seconds(data):
    """A cached result without its times and its digest; other data unchanged."""
    if not isinstance(data, bytes) or not data.startswith(b'{\n  "cache_key"'):
        return data
    return re.sub(rb'"(gather_seconds|seconds|digest)": [^,\n]*', b"", data)


def steady(files):
    """Results that do not depend on seconds; of the accuracy study the pictures and their errors.
    """
    found = {path: data if path.endswith(".exr") else b"" for path, data in files.items()}
    rows = csv.DictReader(io.StringIO(files["d/accuracy.csv"].decode()))
    found["d/accuracy.csv"] = [[row[key] for key in ("method", "series", "setting", "error", "bias", "bound_95")] for row in rows]
    return found


class Faults(program.Case):
    @classmethod
    def setUpClass(cls):
        cls.made = tempfile.TemporaryDirectory(prefix="earthshine-shim-")
        cls.addClassCleanup(cls.made.cleanup)
        cls.shim = pathlib.Path(cls.made.name) / "shim.so"
        source = pathlib.Path(__file__).with_name("fault_shim.c")
        subprocess.run(["cc", "-O1", "-shared", "-fPIC", "-o", cls.shim, source], check=True)

    def setUp(self):
        super().setUp()
        self.count = pathlib.Path(self.made.name) / "count"
        self.log = pathlib.Path(self.made.name) / "log"
        self.found, self.ended = [], 0

    def run_faulty(self, folder, call, kind, at=0, number=errno.EIO, stays=False, more=None):
        fault = {"LD_PRELOAD": self.shim, "FAULT_KIND": kind, "FAULT_AT": at, "FAULT_ERROR": number, "FAULT_STAYS": int(stays),
                 "FAULT_COUNT": self.count, "PATH": "/nowhere"}  # no gnuplot: it would start under
                                                                 # the filter
        fault |= more or {}
        return subprocess.run([program.PROGRAM, *call, "-j", "1", "-q"], cwd=folder, timeout=120, stdin=subprocess.DEVNULL,
                              capture_output=True, env=os.environ | {key: str(value) for key, value in fault.items()}, check=False)

    def before(self, name):
        """A folder with the inputs and with results of another seed. Created in its final place,
        because parts record their folder."""
        folder = self.folder / "now"
        folder.mkdir()
        rows = [f"{a},{0.3 + 0.9 * (1 - a / 90)}" for a in range(0, 90, 10)]
        for file, text in (SCENES | {"s.toml": STUDY, "paint.csv": "\n".join(rows) + "\n"}).items():
            (folder / file).write_text(text, encoding="utf-8")
        for call in COMMANDS[name][0]:
            done = self.run_faulty(folder, call, "fsync")
            self.assertEqual(done.returncode, 0, f"{call}: {done.stderr}")
        if name == "report":
            (folder / "d/report.html").write_text("older", encoding="utf-8")
        return folder.rename(self.folder / "before")

    def copy(self, folder):
        there = self.folder / "now"
        shutil.rmtree(there, ignore_errors=True)
        shutil.copytree(folder, there)
        return there

    def judge(self, what, old, new, folder, run, call):
        """Returns whether the run failed; appends errors to `found`."""
        title = what.split(", ")[1]
        killed = run.returncode == -signal.SIGKILL and title.startswith(("kill", "power"))
        if title.startswith("power"):
            cut_power(folder, old, self.log)
        now = files_of(folder)
        torn = [path for path, data in now.items() if data not in (old.get(path), new["files"].get(path))
                and not (killed and UNFINISHED.search(path))]
        lost = [path for path in old if path not in now and path in new["files"]]
        said = run.stderr.decode("utf-8", "replace").strip()
        if torn or lost:
            self.found.append(f"{what}: torn or left: {torn}, lost: {lost}, exit {run.returncode}: {said}")
        if run.returncode == 0:
            if now != new["files"] or run.stdout != new["stdout"]:
                self.found.append(f"{what}: exit 0, other results: {[p for p in new['files'] if now.get(p) != new['files'][p]]}")
            return False
        if run.returncode < 0 and title.startswith("memory"):
            self.ended += 1  # in a library that cannot report it: HDF5, oneTBB
        elif not killed and (run.returncode not in (1, 2) or "earthshine: " not in said):
            self.found.append(f"{what}: exit {run.returncode}: {said!r}")
        again = self.run_faulty(folder, call, "fsync")
        there = results_of(files_of(folder))
        other = [path for path in there.keys() | new["results"].keys() if there.get(path) != new["results"].get(path)]
        if again.returncode != 0 or other:
            self.found.append(f"{what}: afterwards exit {again.returncode}, other: {other}: {again.stderr!r}")
        return True

    def places(self, name, before, old, new):
        for title, (fault, works) in PLACES.items():
            folder = self.copy(before)
            run = self.run_faulty(folder, COMMANDS[name][1], "", 1, stays=True, more=fault)
            now, kept = results_of(files_of(folder)), results_of(old)
            wanted = new["results"]
            if "FAULT_CLOCK" in fault:  # these contain seconds
                now, wanted = ({path: without_seconds(data) for path, data in files.items() if path not in ("d/compare.json", "d/compare.csv")}
                               for files in (now, wanted))
            other = [path for path in now.keys() | wanted.keys() if now.get(path) != wanted.get(path)]
            done = run.returncode == 0 and not other
            refused = run.returncode == 1 and b"earthshine: " in run.stderr and all(now.get(path) == kept[path] for path in kept)
            if not (done or (refused and not works)):
                self.found.append(f"{name}, {title}: exit {run.returncode}, other: {other}: {run.stderr!r}")

    def sweep(self, name):
        call = COMMANDS[name][1]
        before = self.before(name)
        old = files_of(before)
        counts = {}
        for kind in {kind for kind, _, _ in FAULTS.values()}:
            folder = self.copy(before)
            run = self.run_faulty(folder, call, kind)
            self.assertEqual(run.returncode, 0, run.stderr)
            counts[kind] = int(self.count.read_text())
            files = files_of(folder)
            new = {"files": files, "results": results_of(files), "stdout": run.stdout}
        self.assertNotEqual(new["files"] if call[0] != "fit-phong" else None, old, "the run writes nothing")
        row = []
        for title, (kind, number, stays) in FAULTS.items():
            more = {"FAULT_LOG": self.log} if title == "power cut" else {}
            most = counts[kind]
            picks = range(1, most + 1) if WANTED in ("all", name, title) else sorted({1 + most * (2 * k + 1) // (2 * PICKED) for k in range(PICKED)} if most else ())
            failed = 0
            for at in picks:
                folder = self.copy(before)
                run = self.run_faulty(folder, call, kind, at, number, stays, more)
                failed += self.judge(f"{name}, {title} {at} of {most}", old, new, folder, run, call)
            row.append(f"{len(picks)}, {failed}" + (f", {self.ended}" if self.ended else ""))
            self.ended = 0
        self.places(name, before, old, new)
        if WANTED:
            print(f"| `{name}` | {' | '.join(row)} |", flush=True)
        if self.found:
            self.fail("\n".join(self.found))


def case_of(name):
    return lambda self: self.sweep(name)


for command in COMMANDS:
    if WANTED in ("all", command, *FAULTS) or (not WANTED and command not in DEAR):
        setattr(Faults, "test_" + command.replace(" ", "_").replace("-", ""), case_of(command))

if __name__ == "__main__":
    if sys.platform != "linux" or platform.machine() != "x86_64" or not shutil.which("cc") or \
            any(name in pathlib.Path(program.PROGRAM).read_bytes() for name in (b"__asan_init", b"__tsan_init")):
        print("skipped: system calls cannot be made to fail here")
        sys.exit(77)
    unittest.main()
