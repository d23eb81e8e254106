# SPDX-License-Identifier: Apache-2.0
"""A cluster of one node on the loopback address, for as long as this runs: the job scripts of docs/cluster.md as an array of
8 of which one task is killed and begun again, then four ranks under srun. What comes out must be what one process writes.

python3 check.py BUILD-FOLDER; needs Slurm, munge and Open MPI. Everything Slurm writes is in a temporary folder."""
import getpass
import os
import pathlib
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time

BUILD = pathlib.Path(sys.argv[1]).resolve()
TOP = pathlib.Path(__file__).resolve().parent.parent.parent
os.environ["EARTHSHINE_PROGRAM"] = str(BUILD / "earthshine")
sys.path.insert(0, str(TOP / "tests" / "cli"))
import tiny_bay  # noqa: E402: needs the two lines above

KILLED = 3  # of the tasks 1 to 8
# The node claims more than there may be (config_overrides), so that the scripts run as they stand. No cgroups and no
# binding to cores, which containers forbid. A task that was killed by signal 9 (code 128 + 9) is put back, and begins
# again when its credential has run out.
CONFIG = """ClusterName=earthshine
SlurmctldHost={host}(127.0.0.1)
SlurmUser={user}
SlurmdUser={user}
SlurmctldPort={ports[0]}
SlurmdPort={ports[1]}
CommunicationParameters=NoCtldInAddrAny,NoInAddrAny
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket,cred_expire=15
CredType=cred/munge
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmdParameters=config_overrides
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU_Memory
SchedulerParameters=batch_sched_delay=0,sched_interval=2
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MailProg=/bin/true
RequeueExit=137
NodeName=check NodeHostname={host} NodeAddr=127.0.0.1 CPUs=16 RealMemory=65536
PartitionName=all Nodes=check Default=YES State=UP
"""


def stop_here(message):
    raise SystemExit(f"cluster-check: {message}")


def call(*words, **more):
    run = subprocess.run([str(word) for word in words], capture_output=True, text=True, timeout=300, stdin=subprocess.DEVNULL,
                         check=False, **more)
    if run.returncode:
        stop_here(f"{' '.join(map(str, words))} ended with code {run.returncode}: {run.stdout}{run.stderr}")
    return run.stdout


def until(what, seconds, found, state=lambda: ""):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        result = found()
        if result:
            return result
        time.sleep(0.02)
    return stop_here(f"no {what} in {seconds} s\n{state()}")


def environment_of(process):
    try:
        return (process / "environ").read_bytes().split(b"\0")
    except OSError:  # it has ended, or is another user's
        return []


class Cluster:
    """Daemons in the foreground, as children; stopped in any case."""

    def __init__(self, folder):
        self.folder = folder
        self.daemons = []
        os.environ["SLURM_CONF"] = str(folder / "slurm.conf")

    def __enter__(self):
        try:
            self.start()
        except BaseException:
            self.stop()
            raise
        return self

    def __exit__(self, *_):
        self.stop()

    def start(self):
        for name in ("state", "spool"):
            (self.folder / name).mkdir()
        key = self.folder / "munge.key"
        key.touch(0o600)
        key.write_bytes(os.urandom(128))
        with socket.socket() as first, socket.socket() as second:
            for one in (first, second):
                one.bind(("127.0.0.1", 0))
            ports = [one.getsockname()[1] for one in (first, second)]
        (self.folder / "slurm.conf").write_text(CONFIG.format(
            host=socket.gethostname().split(".")[0], user=getpass.getuser(), ports=ports, folder=self.folder))
        self.daemon("munged", "--foreground", *(f"--{name}={self.folder}/munge{end}" for name, end in (
            ("key-file", ".key"), ("socket", ".socket"), ("pid-file", ".pid"), ("seed-file", ".seed"))))
        until("socket of munged", 20, (self.folder / "munge.socket").exists)
        self.daemon("slurmctld", "-D", "-c")
        self.daemon("slurmd", "-D", "-c", "-N", "check")
        until("idle node", 60, self.idle)

    def idle(self):
        for name, daemon in self.daemons:
            if daemon.poll() is not None:
                stop_here(f"{name} ended:\n{(self.folder / f'{name}.log').read_text()}")
        run = subprocess.run(["sinfo", "-h", "-o", "%T"], capture_output=True, text=True, timeout=60, check=False)
        return run.stdout.strip() == "idle"

    def daemon(self, name, *options):
        with (self.folder / f"{name}.log").open("wb") as log:
            self.daemons.append((name, subprocess.Popen([shutil.which(name, path="/usr/sbin:" + os.environ["PATH"]), *options],
                                                        stdin=subprocess.DEVNULL, stdout=log, stderr=log)))

    def ours(self):
        """Processes that have this cluster's configuration: jobs and those who watch over them."""
        mark = f"SLURM_CONF={self.folder}/slurm.conf".encode()
        return [process for process in pathlib.Path("/proc").glob("[0-9]*")
                if int(process.name) != os.getpid() and mark in environment_of(process)]

    def stop(self):
        for _, daemon in reversed(self.daemons):
            daemon.terminate()
        for process in self.ours():
            try:
                os.kill(int(process.name), signal.SIGKILL)
            except ProcessLookupError:
                pass
        for _, daemon in self.daemons:
            daemon.wait()


def running(cluster, task):
    for process in cluster.ours():
        try:
            program = os.readlink(process / "exe")
        except OSError:
            continue
        if program == str(BUILD / "earthshine") and f"SLURM_ARRAY_TASK_ID={task}".encode() in environment_of(process):
            return int(process.name)
    return None


def shown(job):
    return dict(re.findall(r"(\w+)=(\S+)", call("scontrol", "-o", "show", "job", job)))


def logs_of(cluster, work):
    return "".join(f"== {path.name}\n{path.read_text()}" for path in
                   sorted([*cluster.folder.glob("*.log"), *work.glob("*.log"), *work.glob("*.out")]))


def array(cluster, work):
    """submit.sh as docs/cluster.md has it."""
    scripts = re.findall(r"```bash\n(.*?)```", (TOP / "docs" / "cluster.md").read_text(encoding="utf-8"), re.S)
    (work / "array.sh").write_text(scripts[0])
    (work / "submit.sh").write_text(scripts[1])
    merge = int(call("bash", "submit.sh", "s.toml", "parts", cwd=work).split()[-1])
    process = until(f"process of task {KILLED}", 120, lambda: running(cluster, KILLED))
    os.kill(process, signal.SIGKILL)
    until("end of the jobs", 300, lambda: not call("squeue", "-h").strip(), lambda: call("squeue") + logs_of(cluster, work))
    task = shown(f"{merge - 1}_{KILLED}")
    state = shown(merge)["JobState"]
    if state != "COMPLETED" or task["Restarts"] != "1":
        stop_here(f"merge {state}, task {KILLED} begun again {task['Restarts']} times\n{logs_of(cluster, work)}")
    print(f"array of 8: task {KILLED} killed by signal 9 and begun again; then merged by the job that waited for all")


def compare(work, one, many):
    """All files but pages, which hold seconds; study.json without seconds. The parts' own files stay in points/."""
    read = tiny_bay.Case.without_times
    names = [sorted(str(path.relative_to(work / folder)) for path in (work / folder).rglob("*")
                    if path.is_file() and "points" not in path.parts and path.suffix != ".html") for folder in (one, many)]
    if names[0] != names[1]:
        stop_here(f"files {names[0]} of one process, {names[1]} of the array")
    for name in names[0]:
        first, second = ((work / folder / name).read_bytes() for folder in (one, many))
        if name == "study.json":
            first, second = (read(tiny_bay.json.loads(text)) for text in (first, second))
        if first != second:
            stop_here(f"{name} is not what one process wrote")
    print(f"{len(names[0])} files of the study: as one process wrote them")


def ranks(work):
    """The solution and a picture by four ranks, which srun starts."""
    calls = {"solution.h5": ("solve", "bay.toml", "--set", "quality.patch_edge=0.1"),
             "b.exr": ("render", "bay.toml", "--camera", "B")}
    for name, words in calls.items():
        call(BUILD / "earthshine", *words, "-q", "-o", name, cwd=work)
        whole = (work / name).read_bytes()
        (work / name).unlink()
        call("srun", "-Q", "--mpi=pmix", "--kill-on-bad-exit=1", "-n", "4", BUILD / "earthshine-mpi", *words, "-q", "-j", "1", "-o", name, cwd=work)
        if (work / name).read_bytes() != whole:
            stop_here(f"{name} of four ranks is not what one process wrote")
        print(f"srun, 4 ranks, {words[0]}: {name} has the bytes of one process")


def main():
    missing = [name for name in ("munged", "slurmctld", "slurmd", "srun", "sbatch")
               if not shutil.which(name, path="/usr/sbin:" + os.environ["PATH"])]
    if missing:
        stop_here(f"not found: {', '.join(missing)}; install slurm-wlm and munge")
    for number in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP):
        signal.signal(number, lambda *_: sys.exit("cluster-check: stopped"))
    os.environ["PATH"] = f"{BUILD}:{os.environ['PATH']}"
    with tempfile.TemporaryDirectory(prefix="earthshine-cluster-") as name:
        folder = pathlib.Path(name)
        folder.chmod(0o755)  # munge's socket is asked for from outside
        work = folder / "work"
        work.mkdir()
        (work / "bay.toml").write_text(tiny_bay.BAY.replace("gather_rays = 16", "gather_rays = 256"))
        (work / "s.toml").write_text(tiny_bay.STUDY.replace("[180, 0]", str(list(range(0, 360, 6)))))
        call(BUILD / "earthshine", "study", "run", "s.toml", "-o", "whole", "-q", cwd=work)
        with Cluster(folder) as cluster:
            print(f"{call('sinfo', '--version').strip()}: one node on 127.0.0.1")
            array(cluster, work)
            compare(work, "whole", "parts")
            ranks(work)
    print("stopped; nothing is left")


main()
