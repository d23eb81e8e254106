#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures the tables of docs/scaling.md: `solve` and `render` with one thread per rank on 1 and 2
ranks, and the memory of each rank.

usage: ranks_scaling.py BUILD-FOLDER [solve] [render] [memory] [--repeat N]

Wall seconds are valid only on an idle machine. CPU seconds, over all ranks, are also valid on a
busy one: the excess over one rank is waiting (a waiting rank spins) and duplicated work. The
fastest of N runs (3) counts. All three take a quarter of an hour."""
import argparse
import json
import os
import pathlib
import subprocess
import tempfile
import time

SCENES = pathlib.Path(__file__).resolve().parent.parent.parent / "scenes" / "library" / "sts46"
SUN = str(SCENES / "day-sun.toml")
CALLS = {
    "solve": ("solve", SUN, "--set", "quality.patch_edge=0.06", "--set", "quality.form_factor_rays=1024", "-j", "1"),
    "render": ("render", SUN, "--camera", "B", "--size", "384x384", "--no-error", "--set", "quality.gather_rays=128", "-j", "1"),
    "memory": ("solve", SUN, "--set", "quality.patch_edge=0.12", "--set", "quality.form_factor_rays=512", "-j", "1"),
}
ENVIRONMENT = os.environ | {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
                            "OMPI_MCA_rmaps_base_oversubscribe": "1", "OMPI_MCA_plm": "isolated"}


def peak_mib(process):
    """VmHWM, the peak memory of the process; empty once it has ended."""
    try:
        lines = pathlib.Path(f"/proc/{process}/status").read_text().splitlines()
    except OSError:
        return None
    return next((int(line.split()[1]) / 1024 for line in lines if line.startswith("VmHWM")), None)


def run(program, ranks, call, file):
    """Wall and CPU seconds, and the peak memory of each rank."""
    output = ["-q", "-o", str(file)]
    begun, before = time.monotonic(), os.times()
    process = subprocess.Popen(["mpirun", "-n", str(ranks), program, *call, *output], env=ENVIRONMENT, stdin=subprocess.DEVNULL,
                               stdout=subprocess.DEVNULL)
    peaks = {}
    children = pathlib.Path(f"/proc/{process.pid}/task/{process.pid}/children")
    while process.poll() is None:
        try:
            for child in children.read_text().split():
                peaks[int(child)] = peak_mib(child) or peaks.get(int(child), 0.0)
        except OSError:
            pass
        time.sleep(0.02)
    seconds, after = time.monotonic() - begun, os.times()
    if process.returncode:
        raise SystemExit(f"{ranks} ranks ended with code {process.returncode}")
    return seconds, after.children_user + after.children_system - before.children_user - before.children_system, list(peaks.values())


def scaling(program, name, repeat, folder):
    print(f"\n| {name} | 1 rank | 2 ranks | efficiency |\n| --- | --- | --- | --- |")
    runs, bytes_of = {}, {}
    for ranks in (1, 2):
        file = folder / (f"{ranks}.h5" if name == "solve" else f"{ranks}.exr")
        runs[ranks] = [run(program, ranks, CALLS[name], file) for _ in range(repeat)]
        bytes_of[ranks] = file.read_bytes()
    wall, cpu = ({ranks: min(one[k] for one in some) for ranks, some in runs.items()} for k in (0, 1))
    print(f"| wall s | {wall[1]:.1f} | {wall[2]:.1f} | {wall[1] / wall[2] / 2:.2f} |")
    print(f"| CPU s, all ranks | {cpu[1]:.1f} | {cpu[2]:.1f} | {cpu[1] / cpu[2]:.2f} |")
    print(f"the same bytes: {bytes_of[1] == bytes_of[2]}")


def memory(program, folder):
    print("\n| ranks | first rank, MiB | stated | others | stated |\n| --- | --- | --- | --- | --- |")
    for ranks in (1, 2, 4):
        plan = json.loads(subprocess.run([program, "plan", *CALLS["memory"][1:], "--ranks", str(ranks), "--json", "-q"], check=True,
                                         capture_output=True, text=True).stdout)["ranks"]
        _, _, peaks = run(program, ranks, CALLS["memory"], folder / "memory.h5")
        others = f"{min(peaks[1:]):.0f} to {max(peaks[1:]):.0f} | {plan['memory_mib_others']:.0f}" if ranks > 1 else " | "
        print(f"| {ranks} | {peaks[0]:.0f} | {plan['memory_mib_each']:.0f} | {others} |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("what", nargs="*", help=", ".join(CALLS) + ": which, or all")
    parser.add_argument("--repeat", type=int, default=3)
    call = parser.parse_args()
    program = str(call.build.resolve() / "earthshine-mpi")
    with tempfile.TemporaryDirectory() as folder:
        for name in call.what or CALLS:
            if name == "memory":
                memory(program, pathlib.Path(folder))
            else:
                scaling(program, name, call.repeat, pathlib.Path(folder))


if __name__ == "__main__":
    main()
