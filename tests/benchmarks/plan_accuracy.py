# SPDX-License-Identifier: Apache-2.0
"""Accuracy of `plan` for each shipped scene: `render --report` gives expected and actual cost.
Prints a row per scene, light transport and size: ratios of expected to actual CPU seconds and rays,
and the cost of the pilot.

usage: plan_accuracy.py EARTHSHINE [--sizes 64,256] [--indirect radiosity,none] [--scenes cornell,sts46/day]
"""
import argparse
import json
import pathlib
import subprocess
import tempfile

LIBRARY = pathlib.Path(__file__).resolve().parents[2] / "scenes" / "library"


def measure(program, scene, how, size, folder):
    report = folder / "report.json"
    subprocess.run([program, "render", scene, "--size", f"{size}x{size}", "--indirect", how, "-q",
                    "-o", folder / "a.exr", "--report", report], check=True, capture_output=True)
    said = json.loads(report.read_text())
    rays = [sum(row[part]["rays"] for row in said["effects"]) for part in ("expected", "taken")]
    return said["expected"], said["taken"], rays


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--sizes", default="64,256,512,1024")
    parser.add_argument("--indirect", default="radiosity,distributed,none,paths")
    parser.add_argument("--scenes", default="")
    call = parser.parse_args()
    print("| scene | light | pixels | taken, CPU s | expected / taken: seconds | rays | pilot, CPU s |")
    print("| --- | --- | --- | --- | --- | --- | --- |")
    worst = {"seconds": 1.0, "rays": 1.0}
    for scene in sorted(LIBRARY.rglob("*.toml")):
        name = str(scene.relative_to(LIBRARY)).removesuffix(".toml").removesuffix("/scene")
        if not any(name.startswith(wanted) for wanted in call.scenes.split(",")):
            continue
        for how in call.indirect.split(","):
            for size in call.sizes.split(","):
                with tempfile.TemporaryDirectory() as folder:
                    expected, taken, rays = measure(call.program, scene, how, int(size), pathlib.Path(folder))
                ratio = {"seconds": expected["cpu_seconds"] / max(1e-9, taken["cpu_seconds"]),
                         "rays": rays[0] / max(1.0, rays[1])}
                for key, value in ratio.items():
                    worst[key] = max(worst[key], value, 1.0 / max(1e-9, value))
                print(f"| {name} | {how} | {size} | {taken['cpu_seconds']:.2f} | {ratio['seconds']:.2f} "
                      f"| {ratio['rays']:.2f} | {expected['pilot_cpu_seconds']:.2f} |", flush=True)
    print(f"\nFurthest off: seconds by a factor of {worst['seconds']:.2f}, rays by {worst['rays']:.2f}.")


if __name__ == "__main__":
    main()
