#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Cost of 1000 copies of a part of 9800 triangles (`instance_of`), under a lamp and the Sun.

usage: instances.py PROGRAM [--error E] [--keep FOLDER]

CPU seconds and memory of `inspect`, of `render --indirect none` and of `render --error E`, 256 x
256, on one thread.
"""
import argparse
import math
import pathlib
import random
import re
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from fine_orbiter import run  # noqa: E402

STEPS, COPIES, ROW = 70, 1000, 32
SCENE = """format = 1
[[material]]
name = "white"
diffuse = [0.7, 0.6, 0.5]
[[material]]
name = "grey"
diffuse = 0.5
[[object]]
name = "floor"
shape = "quad"
material = "grey"
corners = [[-3, -3, 0], [35, -3, 0], [35, 35, 0], [-3, 35, 0]]
[[light]]
name = "lamp"
type = "point"
position = [16, 10, 6]
flux = 200000
[sun]
direction = [0.4, -0.5, 0.7]
[[camera]]
name = "A"
position = [-6, -8, 9]
look_at = [14, 14, 0]
up = [0, 0, 1]
fov_deg = 42
resolution = [256, 256]
"""


def write_part(path):
    """A ring with five bulges."""
    with open(path, "w") as file:
        for i in range(STEPS):
            for j in range(STEPS):
                a, b = 2 * math.pi * i / STEPS, 2 * math.pi * j / STEPS
                r = 0.13 * (1 + 0.2 * math.cos(5 * a))
                away = 0.28 + r * math.cos(b)
                file.write(f"v {away * math.cos(a):.6f} {away * math.sin(a):.6f} {r * math.sin(b):.6f}\n")
        for i in range(STEPS):
            for j in range(STEPS):
                near, far, on = i * STEPS + 1, (i + 1) % STEPS * STEPS + 1, (j + 1) % STEPS
                file.write(f"f {near + j} {far + j} {far + on}\nf {near + j} {far + on} {near + on}\n")


def scene():
    random.seed(1)
    text = SCENE
    for k in range(COPIES):
        what = 'mesh = "part.obj"\nmaterial = "white"' if k == 0 else 'instance_of = "part-0"'
        turned = [random.randrange(360) for _ in range(3)]
        text += f'[[object]]\nname = "part-{k}"\n{what}\ntranslate = [{k % ROW}, {k // ROW}, 0.9]\nrotate = {turned}\n'
    return text


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("--error", default="0.05")
    parser.add_argument("--keep", type=pathlib.Path, help="scene and pictures stay there")
    call = parser.parse_args()
    program = call.program.resolve()
    with tempfile.TemporaryDirectory() as temporary:
        folder = call.keep or pathlib.Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        write_part(folder / "part.obj")
        (folder / "scene.toml").write_text(scene())
        _, seconds = run(folder, program, "inspect", "scene.toml", "--json", "--threads", 1)
        print(f"inspect: {seconds:.1f} s", flush=True)
        for name, words in (("none", ("--indirect", "none")), ("error", ("--error", call.error))):
            done, seconds = run(folder, program, "render", "scene.toml", *words, "--threads", 1, "-o", f"{name}.exr", "--png",
                                f"{name}.png")
            memory = re.search(r"peak memory (.*)", done.stderr).group(1)
            print(f"render {' '.join(words)}: {seconds:.1f} s, {memory}", flush=True)


if __name__ == "__main__":
    main()
