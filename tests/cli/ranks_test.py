# SPDX-License-Identifier: Apache-2.0
"""Ranks of Open MPI write the output of one process. Skipped without earthshine-mpi or mpirun."""
import contextlib
import json
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import time
import unittest

import program
from program import BALL, CLOSED_BOX
from tiny_bay import PLAIN_BAY, Case

MPI = pathlib.Path(program.PROGRAM).with_name("earthshine-mpi")
# More ranks than cores, in a container, as root; without ssh.
ENVIRONMENT = os.environ | {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
                            "OMPI_MCA_rmaps_base_oversubscribe": "1", "OMPI_MCA_plm": "isolated",
                            "OMPI_MCA_mpi_yield_when_idle": "1", "OMPI_MCA_btl_base_warn_component_unused": "0"}
# White walls (closed parts without absorption must be found), a mirror (fractional hits), a box
# that covers part of the floor, and so few rays that hits are borrowed and filled in.
HARD = CLOSED_BOX.replace("diffuse = 0.5", "diffuse = 1.0").replace("form_factor_rays = 64", "form_factor_rays = 8") + """
[[material]]
name = "half a mirror"
diffuse = 0.3
mirror = 0.45

[[object]]
name = "ball"
shape = "sphere"
center = [1.5, 1.4, 0.7]
radius = 0.3
segments = 12
material = "half a mirror"

[[object]]
name = "box"
shape = "box"
min = [0.3, 0.3, 0]
max = [0.8, 0.8, 0.5]
material = "half a mirror"
"""
# An open scene with shadows and two light groups; a closed one, lit by its walls; one without
# settings, refined and sampled in passes until an error is reached.
FREE = BALL.replace("patch_edge = 0.5\nform_factor_rays = 64\n", "")
# A slit to a wide Sun: its penumbrae need many rounds of refinement.
SLIT = """format = 1
name = "slit"
unit = "m"

[[material]]
name = "grey"
diffuse = 0.5
""" + "".join(f"""
[[object]]
name = "{name}"
material = "grey"
shape = "quad"
corners = {corners}
""" for name, corners in (("floor", "[[0, 0, 0], [4, 0, 0], [4, 4, 0], [0, 4, 0]]"), ("left", "[[0, 0, 1], [0, 4, 1], [1.85, 4, 1], [1.85, 0, 1]]"),
                          ("right", "[[2.15, 0, 1], [2.15, 4, 1], [4, 4, 1], [4, 0, 1]]"))) + """
[sun]
direction = [0, 0, 1]
illuminance = 1000
angular_radius_deg = 4
"""
SCENES = {"ball.toml": BALL, "box.toml": CLOSED_BOX, "hard.toml": HARD, "free.toml": FREE, "slit.toml": SLIT, "bay.toml": PLAIN_BAY}
RENDERS = {
    "denoised": ("--set", "quality.denoise=true", "--aov", "variance,object"),
    "alone": ("--set", "quality.denoise=false", "--per-light"),
    "paths": ("--indirect", "paths"),
    "to an error": ("--error", "0.15"),
}


def without_times(text):
    def strip(value):
        if isinstance(value, dict):
            return {key: strip(inner) for key, inner in value.items() if "seconds" not in key and "memory" not in key}
        return [strip(inner) for inner in value] if isinstance(value, list) else value
    return strip(json.loads(text)) if text.startswith("{") else ""


class OfRanks(Case):
    def setUp(self):
        super().setUp()
        for name, text in SCENES.items():
            self.write(name, text)

    def ranks(self, count, *arguments, code=0, mpirun=(), environment=()):
        run = subprocess.run(["mpirun", *mpirun, "-n", str(count), MPI, *map(str, arguments)], cwd=self.folder,
                             env=ENVIRONMENT | dict(environment), capture_output=True, text=True, stdin=subprocess.DEVNULL, timeout=300, check=False)
        self.assertEqual(run.returncode, code, f"{arguments}: {run.stdout}{run.stderr}")
        return run

    def same(self, call, names, counts):
        """Files, and the output of `--json` without memory, seconds and values that depend on them.
        """
        said = without_times(self.done(*call, "-q"))
        whole = {name: (self.folder / name).read_bytes() for name in names}
        for count in counts:
            for name in names:
                (self.folder / name).unlink()
            with self.subTest(call[0], ranks=count):
                run = self.ranks(count, *call, "-q", "-j", 1 + count % 2)
                self.assertLessEqual(run.stdout.count("light group"), 1)  # one rank writes messages
                self.assertEqual(without_times(run.stdout), said)
                for name in names:
                    self.assertEqual((self.folder / name).read_bytes(), whole[name], name)
                self.assertEqual([p.name for p in self.folder.iterdir() if p.name.startswith(".")], [])

    def without_program(self, study):
        """earthshine-mpi is another program than earthshine, which study.json records."""
        return {key: value for key, value in self.without_times(study).items() if key not in ("build", "provenance")}

    def started(self, count, *arguments):
        """mpirun, and the ranks as soon as all exist."""
        run = subprocess.Popen(["mpirun", "-n", str(count), MPI, *arguments, "-j", "1"], cwd=self.folder,
                               env=ENVIRONMENT | {"PMIX_MCA_gds": "hash"},  # otherwise mpirun may not end (docs/cluster.md)
                               stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        self.addCleanup(run.stderr.close)
        self.addCleanup(run.kill)
        children = pathlib.Path(f"/proc/{run.pid}/task/{run.pid}/children")
        ranks = []
        while len(ranks) < count:
            ranks = children.read_text().split()
        return run, ranks

    @staticmethod
    def processor_seconds(process):
        user, system = pathlib.Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()[11:13]
        return (int(user) + int(system)) / os.sysconf("SC_CLK_TCK")


class Results(OfRanks):
    def test_solutions(self):
        # Loops over patches have chunks of 256; a single chunk is not shared.
        fine = ("--set", "quality.patch_edge=0.1")
        for scene, more, counts in (("ball.toml", fine, (1, 2, 3, 5, 8)), ("box.toml", fine, (3,)), ("free.toml", ("--error", "0.1"), (2, 5)),
                                    ("slit.toml", ("--error", "0.1"), (2,)), ("hard.toml", ("--set", "quality.patch_edge=0.2"), (1, 2, 3, 5, 8))):
            self.same(("solve", scene, "-o", "s.h5", "--json", *more), ("s.h5",), counts)

    def test_rows_that_need_each_other(self):
        """More ranks than the 16 bands in which columns are summed: some ranks then share a band.
        """
        call = ("solve", "hard.toml", "-o", "s.h5", "--set", "quality.patch_edge=0.1")
        report = json.loads(self.done(*call, "--json", "-q"))
        balance = report["balance"]
        self.assertTrue(balance["balanced"] and balance["borrowed"] > 0 and balance["filled"] > 0, balance)
        self.assertGreater(report["back_share"], 0)
        self.same(call, ("s.h5",), (20,))
        self.write("hard.toml", HARD.replace("0.3\nmirror = 0.45", "0.55\nmirror = 0.45"))
        alone = self.refused(*call)
        self.assertIn("a closed part of the scene reflects everything", alone)
        self.assertIn(alone.splitlines()[0], self.ranks(3, *call, code=2).stderr.splitlines())

    def test_refined_patches(self):
        self.same(("solve", "bay.toml", "-o", "s.h5", "--set", "quality.refine=true", "--set", "quality.max_patches=2000"),
                  ("s.h5",), (2, 3))

    def test_pictures(self):
        for name, way in RENDERS.items():
            with self.subTest(name):
                self.same(("render", "ball.toml", "-o", "v.exr", "--png", "v.png", "--camera", "A", *way), ("v.exr", "v.png"),
                          (2, 3) if name != "shared" else (1, 2, 3, 5, 8))

    def test_studies(self):
        call = ("study", "orbit", "bay.toml", "--positions", "17", "--iris", "normal", "--wanted", "box>=0.5", "-o")
        self.done(*call, "w", "-q")
        for count in (2, 3):
            run = self.ranks(count, *call, f"o{count}", "-q", "-j", 1)
            self.assertIn("box", run.stdout)
            self.assertEqual(*(self.without_program(self.study(folder)) for folder in (f"o{count}", "w")))
            for path in (self.folder / "w" / "pictures").iterdir():
                self.assertEqual((self.folder / f"o{count}" / "pictures" / path.name).read_bytes(), path.read_bytes())
        run = self.ranks(2, "study", "visibility", "bay.toml", "-o", "j", "--size", "8x8", "--json")  # only the merge reports
        self.assertEqual(json.loads(run.stdout)["study"], "visibility")
        self.assertNotIn("--json has no effect", run.stderr)



class Faults(OfRanks):
    def test_ranks_that_differ(self):
        """Another scene, setting or mesh on one rank is an error: the ranks could block or mix two
        pictures."""
        (self.folder / "there").mkdir()
        (self.folder / "out").mkdir()  # only for rank 0
        call = [MPI, "render", "ball.toml", "--camera", "A", "-o", "out/v.exr", "-q"]
        for what, text, more in (("ball.toml", BALL.replace("radius = 0.5", "radius = 0.4"), []),
                                 ("ball.toml", BALL + "# a word more\n", []), ("the call", BALL, ["--seed", "2"])):
            self.write("there/ball.toml", text)
            run = subprocess.run(["mpirun", "-n", "2", *call, ":", "-n", "1", "--wdir", "there", *call, *more], cwd=self.folder,
                                 env=ENVIRONMENT, capture_output=True, text=True, stdin=subprocess.DEVNULL, timeout=60, check=False)
            self.assertEqual(run.returncode, 2, run.stderr)
            self.assertEqual(run.stderr.count("earthshine: "), 1, run.stderr)
            self.says(run.stderr, f"rank 0: {what} is not what rank 2 of 3 has")
            self.assertEqual(list((self.folder / "out").iterdir()), [])
        study = [MPI, "study", "orbit", "bay.toml", "-o", "out", "--positions", "3", "--iris", "normal"]  # one rank would block
        run = subprocess.run(["mpirun", "-n", "1", *study, ":", "-n", "1", *study, "--part", "solve"], cwd=self.folder, env=ENVIRONMENT,
                             capture_output=True, text=True, stdin=subprocess.DEVNULL, timeout=60, check=False)
        self.assertEqual(run.returncode, 2, run.stderr)
        self.says(run.stderr, "rank 0: --part is not what rank 1 of 2 has")
        self.write("there/ball.toml", BALL)  # threads and memory may differ between machines
        subprocess.run(["mpirun", "-n", "1", *call, "-j2", ":", "-n", "1", "--wdir", "there", *call, "-j1", "--max-memory", "4GiB"],
                       cwd=self.folder, env=ENVIRONMENT, stdin=subprocess.DEVNULL, timeout=60, check=True)

    def test_what_is_wrong_is_said_once(self):
        run = self.ranks(3, "render", "none.toml", "-o", "v.exr", code=2)
        self.assertEqual(run.stderr.count("earthshine: "), 1, run.stderr)
        self.assertIn("none.toml", run.stderr)
        for call in (("inspect", "ball.toml"), ("render", "ball.toml", "-o", "v.exr", "--part", "1/2"),
                     ("render", "ball.toml", "-o", "v.exr", "--time-limit", "3")):
            self.assertIn("earthshine: ", self.ranks(2, *call, code=2).stderr)

    def test_a_rank_that_dies_ends_the_run(self):
        run, ranks = self.started(3, "render", "ball.toml", "--camera", "A", "-o", "v.exr", "--indirect", "paths",
                                  "--set", "quality.gather_rays=65536")
        # Open MPI has another message for a process that dies before it has joined; joining takes
        # 0.1 s.
        while self.processor_seconds(ranks[1]) < 1.0:
            time.sleep(0.05)
        os.kill(int(ranks[1]), 9)
        _, errors = run.communicate(timeout=60)
        self.assertNotEqual(run.returncode, 0)
        self.assertIn("signal 9", errors)
        self.assertFalse((self.folder / "v.exr").exists())

    def test_a_signal_to_one_rank_ends_all(self):
        """One process ends its picture at a signal; ranks would stop at different places."""
        run, ranks = self.started(2, "render", "ball.toml", "--camera", "A", "-o", "v.exr", "--indirect", "paths",
                                  "--set", "quality.gather_rays=65536")
        while self.processor_seconds(ranks[1]) < 1.0:
            time.sleep(0.05)
        os.kill(int(ranks[1]), signal.SIGTERM)
        run.communicate(timeout=20)
        self.assertNotEqual(run.returncode, 0)
        self.assertEqual([path.name for path in self.folder.iterdir() if "v.exr" in path.name], [])

    def test_a_full_disk(self):
        """A memory file system with room for one page: only rank 0 writes to it; it reports the
        error and ends the others."""
        mounts = ["unshare", "--user", "--map-root-user", "--mount"]
        (self.folder / "full").mkdir()
        if subprocess.run([*mounts, "mount", "-t", "tmpfs", "tmpfs", "full"], cwd=self.folder, capture_output=True,
                          check=False).returncode != 0:
            self.skipTest("no file system can be mounted here")
        script = """mount -t tmpfs -o size=8k tmpfs full && echo older > full/v.exr && "$@"
code=$?; ls -A full; cat full/v.exr; exit $code"""
        call = ("render", "ball.toml", "--camera", "A", "-o", "full/v.exr", "-q")
        run = subprocess.run([*mounts, "bash", "-c", script, "sh", "mpirun", "-n", "3", MPI, *call], cwd=self.folder,
                             env=ENVIRONMENT, capture_output=True, text=True, stdin=subprocess.DEVNULL, timeout=300, check=False)
        self.assertEqual(run.returncode, 1, run.stderr)
        self.assertEqual(run.stderr.count("earthshine: "), 1, run.stderr)
        self.says(run.stderr, "v.exr", "No space left on device")
        self.assertEqual(run.stdout, "v.exr\nolder\n")


class Machines(OfRanks):
    def test_one_solution_for_parts(self):
        """Ranks use the one solution that parts read, by --part solve or before their own shares.
        """
        call = ("study", "orbit", "bay.toml", "--positions", "17", "--iris", "normal", "--wanted", "box>=0.5", "-q", "-o")
        for folder, run in (("w", lambda: self.ranks(1, *call, "w", "--part", "solve")),
                            ("a", lambda: self.ranks(3, *call, "a", "--part", "solve")), ("b", lambda: self.ranks(3, *call, "b"))):
            run()
        solutions = {}
        for folder in "wab":
            (file,) = (self.folder / folder / "points").glob("solution-*.h5")
            solutions[folder] = (file.name, file.read_bytes(), pathlib.Path(f"{file}.json").read_bytes())
        self.assertEqual([solutions["a"], solutions["b"]], [solutions["w"]] * 2)
        subprocess.run([MPI, *call, "a", "--part", "1/1"], cwd=self.folder, check=True)
        subprocess.run([MPI, "merge", "a", "-q"], cwd=self.folder, check=True)
        self.assertEqual(self.without_times(self.study("a")), self.without_times(self.study("b")))
        self.assertIn("does not go with ranks", self.ranks(2, *call, "a", "--part", "1/2", code=2).stderr)

    def test_memory_is_divided(self):
        """The E entries of the matrix have 8 bytes each; one of R ranks has E / R of them. During
        their distribution it has up to half as much again, for rows that it has cast for others,
        while one process needs an additional sixteenth. A rank therefore saves 8 E (17/16 - 3/2 /
        R) bytes, which `plan` states up to 12 MiB of Open MPI. Rows are cast dynamically: on a busy
        machine one rank has up to a quarter of all entries more, so that with two ranks the saving
        is uncertain."""
        call = ("solve", "box.toml", "-o", "s.h5", "--set", "quality.patch_edge=0.04", "--set", "quality.form_factor_rays=1024")
        reports, peaks = {}, {}
        for count in (1, 2, 8):
            with subprocess.Popen(["mpirun", "-n", str(count), MPI, *call, "-q", "--json", "-j", "1"], cwd=self.folder,
                                  env=ENVIRONMENT, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE) as run:
                reports[count] = json.loads(run.stdout.read())
                _, status, usage = os.wait4(run.pid, 0)
                run.returncode = os.waitstatus_to_exitcode(status)
            self.assertEqual(run.returncode, 0)
            peaks[count] = usage.ru_maxrss / 1024  # of the largest process
        entries = reports[1]["nonzeros"] * 8 / 2**20
        self.assertGreater(entries, 0.5 * peaks[1])
        for count in (2, 8):
            self.assertEqual(reports[count]["nonzeros"], reports[1]["nonzeros"])
            spared = entries * (17 / 16 - 3 / 2 / count)
            self.assertGreater(peaks[1] - peaks[count], spared - 24 - entries / 4 if count == 8 else -entries / 2)
            stated = [json.loads(self.done("plan", *call[1:2], *call[4:], "--ranks", n, "--json"))["ranks"]["memory_mib_each"]
                      for n in (1, count)]
            self.assertAlmostEqual(stated[0] - stated[1], spared, delta=16)

    def test_two_machines(self):
        """Two daemons of Open MPI under separate host names with two ranks each: TCP between them,
        no shared memory."""
        if subprocess.run(["unshare", "--uts", "--user", "--map-root-user", "hostname", "one"], capture_output=True,
                          check=False).returncode != 0:
            self.skipTest("no host can be given another name here")
        reach = self.folder / "reach"  # replaces ssh HOST COMMAND
        reach.write_text('#!/bin/sh\nhost=$1; shift\nexec unshare --uts --user --map-root-user sh -c "hostname $host; $*"\n')
        reach.chmod(0o755)
        there = {"OMPI_MCA_plm": "rsh", "OMPI_MCA_plm_rsh_agent": "reach", "OMPI_MCA_oob_tcp_if_include": "lo",
                 "OMPI_MCA_btl_tcp_if_include": "lo", "PATH": f"{self.folder}:{os.environ['PATH']}"}
        hosts = ("--host", "one:2,two:2")
        for call, name in ((("solve", "hard.toml", "--set", "quality.patch_edge=0.2"), "s.h5"),
                           (("render", "ball.toml", "--camera", "A"), "v.exr")):
            self.done(*call, "-o", name, "-q")
            whole = (self.folder / name).read_bytes()
            (self.folder / name).unlink()
            self.ranks(4, *call, "-o", name, "-q", "-j", 1, mpirun=hosts, environment=there)
            self.assertEqual((self.folder / name).read_bytes(), whole)
        said = self.ranks(4, *call, "-o", name, "--max-memory", "40MiB", code=1, mpirun=hosts, environment=there).stderr
        self.says(said, "20 MiB are allowed by --max-memory for each of 2 ranks on this machine")
        # A component for shared memory cannot reach the counter of tiles on the other host.
        said = self.ranks(4, *call, "-o", name, code=1, mpirun=hosts, environment=there | {"OMPI_MCA_osc": "sm"}).stderr
        self.assertEqual(said.count("earthshine: "), 1, said)
        self.says(said, "has no component osc for these machines", "--mca osc ^ucx")

    def test_ranks_share_the_memory_of_a_machine(self):
        """A limit that suffices for one rank is refused for two, before they cast a ray; with a
        larger limit they use the stated memory."""
        call = ("solve", "box.toml", "--set", "quality.patch_edge=0.06", "--set", "quality.form_factor_rays=1024", "-q", "-j", 1)
        plan = {count: json.loads(self.done("plan", "box.toml", *call[2:6], "--ranks", count, "--json"))["ranks"] for count in (1, 2)}
        enough = 1.02 * plan[1]["memory_mib_all"]
        self.assertLess(enough, plan[2]["memory_mib_all"])
        self.ranks(1, *call, "--max-memory", f"{enough:.0f}MiB")
        said = self.ranks(2, *call, "--max-memory", f"{enough:.0f}MiB", code=1).stderr
        self.says(said, "allowed by --max-memory for each of 2 ranks on this machine")
        self.ranks(2, *call, "--max-memory", f"{1.02 * plan[2]['memory_mib_all']:.0f}MiB")

    def test_alone_without_mpirun(self):
        self.done("render", "ball.toml", "--camera", "A", "-o", "v.exr", "-q")
        whole = (self.folder / "v.exr").read_bytes()
        subprocess.run([MPI, "render", "ball.toml", "--camera", "A", "-o", "v.exr", "-q"], cwd=self.folder, check=True)
        self.assertEqual((self.folder / "v.exr").read_bytes(), whole)

    def test_processes_of_srun_that_are_alone(self):
        """srun without --mpi=pmix: only SLURM_STEP_NUM_TASKS shows that there are other processes.
        mpirun with one process is a single process."""
        call = ("inspect", "ball.toml")
        run = subprocess.run([MPI, *call], cwd=self.folder, env=os.environ | {"SLURM_STEP_NUM_TASKS": "4"},
                             capture_output=True, text=True, check=False)
        self.assertEqual(run.returncode, 2, run.stderr)
        self.says(run.stderr, "started 4 processes that do not know of each other", "--mpi=pmix")
        for program_, tasks in ((MPI, "1"), (program.PROGRAM, "4")):
            subprocess.run([program_, *call], cwd=self.folder, env=os.environ | {"SLURM_STEP_NUM_TASKS": tasks},
                           stdout=subprocess.DEVNULL, check=True)

    def test_a_plan_is_made_once(self):
        plan = self.ranks(2, "study", "orbit", "bay.toml", "-o", "o", "--positions", "3", "--dry-run", "--json").stdout
        self.assertTrue(json.loads(plan)["dry_run"])  # two documents would be invalid JSON
        self.assertFalse((self.folder / "o").exists())

    def test_one_rank_writes_to_a_device(self):
        """Without this error each of the three processes would write the picture."""
        call = ("render", "box.toml", "--no-error", "-q", "-o", "a.exr", "--png", "/dev/stdout")
        run = subprocess.run(["mpirun", "-n", "3", MPI, *call], cwd=self.folder, env=ENVIRONMENT, stdin=subprocess.DEVNULL,
                             capture_output=True, timeout=300, check=True)
        self.assertEqual(run.stdout, self.run_program(*call, text=False).stdout)

    def test_work_goes_to_whoever_is_free(self):
        """Two ranks of one thread share W = W1 + W2 CPU seconds of a picture. One is stopped while
        the other works for W. It then has no work left; a static division would leave it all of its
        half."""
        call = ("render", "ball.toml", "--camera", "A", "-o", "v.exr", "--indirect", "paths", "-q", "--set",
                "quality.gather_rays=8192")
        begun = os.times()
        self.done(*call, "-j", "1")
        ended = os.times()
        work = ended.children_user - begun.children_user
        whole = (self.folder / "v.exr").read_bytes()
        run, ranks = self.started(2, *call)
        while self.processor_seconds(ranks[1]) < 0.2 + 0.1 * work:
            time.sleep(0.01)
        os.kill(int(ranks[1]), signal.SIGSTOP)
        at_stop = self.processor_seconds(ranks[1])
        while self.processor_seconds(ranks[0]) < 1.1 * work:
            time.sleep(0.01)
        os.kill(int(ranks[1]), signal.SIGCONT)
        at_end = at_stop
        while run.poll() is None:
            with contextlib.suppress(OSError):
                at_end = self.processor_seconds(ranks[1])
            time.sleep(0.01)
        self.assertEqual(run.returncode, 0)
        self.assertEqual((self.folder / "v.exr").read_bytes(), whole)
        # Half of the work would be 0.4 W more; one row and the encoding of the file are less than
        # 0.2 W.
        self.assertLess(at_end - at_stop, 0.2 * work)


class Kills(OfRanks):
    def test_kills_of_solve_and_render(self):
        """Each rank, killed at EARTHSHINE_KILLS (four) moments: each file is complete or absent, no
        temporary file remains, and the next run writes the bytes of an undisturbed one."""
        kills = int(os.environ.get("EARTHSHINE_KILLS", "4"))
        chance = random.Random(21)
        for call, names in ((("solve", "ball.toml", "-o", "s.h5", "--set", "quality.patch_edge=0.1", "-q"), ("s.h5",)),
                            (("render", "ball.toml", "--camera", "A", "-o", "v.exr", "--png", "v.png", "-q"), ("v.exr", "v.png"))):
            begun = time.monotonic()
            self.ranks(3, *call, "-j", 1)
            seconds = time.monotonic() - begun
            whole = {name: (self.folder / name).read_bytes() for name in names}
            killed = 0
            for kill in range(kills):
                for name in names:
                    (self.folder / name).unlink(missing_ok=True)
                rank, wait = chance.randrange(3), seconds * (kill + chance.random()) / kills
                with self.subTest(call[0], rank=rank, seconds=wait):
                    run, ranks = self.started(3, *call)
                    time.sleep(wait)
                    with contextlib.suppress(ProcessLookupError):  # the run ended first
                        os.kill(int(ranks[rank]), 9)
                    run.communicate(timeout=60)
                    killed += run.returncode != 0
                    for name in names:
                        if (self.folder / name).exists():
                            self.assertEqual((self.folder / name).read_bytes(), whole[name])
            self.ranks(3, *call, "-j", 1)
            self.assertEqual({name: (self.folder / name).read_bytes() for name in names}, whole)
            self.assertEqual([path.name for path in self.folder.iterdir() if path.name.startswith(".")], [])
            self.assertGreater(killed, 0)

    def test_the_next_run_ends_what_a_kill_left(self):
        """Each rank, killed at EARTHSHINE_KILLS (four) moments of a run: the study is complete or
        absent, and the next run writes the undisturbed one."""
        call = ("study", "orbit", "bay.toml", "--positions", "17", "--iris", "normal", "--wanted", "box>=0.5", "-q", "-o")
        begun = time.monotonic()
        self.ranks(3, *call, "w", "-j", 1)
        whole, seconds = self.without_times(self.study("w")), time.monotonic() - begun
        chance = random.Random(20)
        killed = 0
        kills = int(os.environ.get("EARTHSHINE_KILLS", "4"))
        for kill in range(kills):
            folder, rank, wait = f"o{kill}", chance.randrange(3), seconds * (kill + chance.random()) / kills
            with self.subTest(rank=rank, seconds=wait):
                run, ranks = self.started(3, *call, folder)
                time.sleep(wait)
                try:
                    os.kill(int(ranks[rank]), 9)
                except ProcessLookupError:  # the run ended first
                    pass
                run.communicate(timeout=60)
                killed += run.returncode != 0
                if (self.folder / folder / "study.json").exists():
                    self.assertEqual(self.without_times(self.study(folder)), whole)
                subprocess.run([MPI, *call, folder], cwd=self.folder, stdout=subprocess.DEVNULL, check=True)
                self.assertEqual(self.without_times(self.study(folder)), whole)
                for path in (self.folder / "w" / "pictures").iterdir():
                    self.assertEqual((self.folder / folder / "pictures" / path.name).read_bytes(), path.read_bytes())
        self.assertGreater(killed, 0)


if __name__ == "__main__":
    if not MPI.exists() or shutil.which("mpirun") is None:
        sys.exit(77)
    unittest.main()
