#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Cost of a mesh that is finer than the light: the orbiter Atlantis without doors, in N x N cuts.

usage: fine_orbiter.py PROGRAM Atlantis.obj [--cuts 1,8,20] [--error E] [--camera out|fwd] [--keep FOLDER] [--truth]

The mesh is that of the Orbiter simulator, and each triangle is divided into N x N. For each N:
seconds of `inspect` and of `render` on one thread, with patches, peak memory and stated error; the
stages `read` and `build` are loading. With --truth instead: errors of pictures against two
references of 1024 paths per pixel, over all pixels that show the orbiter, and the bias in the
dimmest quarter of its blocks of 6 x 6 pixels. The mesh is orbitersim/orbiter's
Src/Vessel/Atlantis/Atlantis/Meshes/Atlantis.msh (MIT licence), as OBJ.
"""
import argparse
import json
import pathlib
import re
import resource
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "validation"))
import error_truth  # noqa: E402

TRUTH_SIZE = 120, 90
SCENE = """format = 1
[[object]]
name = "orbiter"
mesh = "orbiter.obj"
material = "liner"
rotate = [90, 0, 0]
[[material]]
name = "liner"
diffuse = 0.6
two_sided = true
[sun]
[earth]
[orbit]
altitude_km = 400
attitude = "bay-to-earth"
"""
LAMP = """[[light]]
name = "{}"
type = "spot"
position = {}
aim = {}
beam_deg = 60
field_deg = 135
intensity = 800
"""
CAMERA = """[[camera]]
name = "{}"
position = {}
look_at = {}
up = [0, 0, 1]
fov_deg = 50
resolution = [320, 240]
"""
SCENE += (LAMP.format("fwd-port", [-2.3, 8, -0.5], [0.3, 5, 0]) + LAMP.format("aft-star", [2.3, -3, -0.5], [-0.3, 0, 0]) +
          CAMERA.format("fwd", [-1.8, 11.2, 1.9], [0, 2, 0.3]) + CAMERA.format("out", [9, 22, 16], [0, 0, 0]))
DOORS = ("cargodoor", "radiator")


def read(mesh):
    """(vertices, triangles by group), without the bay's doors and their radiators."""
    vertices, groups, group = [], {}, None
    for line in mesh.read_text().splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            vertices.append(tuple(map(float, words[1:4])))
        elif words[:1] in (["g"], ["o"]):
            group = None if words[1].startswith(DOORS) else groups.setdefault(words[1], [])
        elif words[:1] == ["f"] and group is not None:
            corners = [int(word.split("/")[0]) - 1 for word in words[1:]]
            group += [(corners[0], corners[k], corners[k + 1]) for k in range(1, len(corners) - 1)]
    return vertices, groups


def write_cut(file, vertices, groups, n):
    """The mesh with each triangle divided into n x n with shared corners, and the number of
    triangles."""
    known, count = {}, 0

    def vertex(weights):
        """weights: of the corners, in units of 1/n; zero weights are omitted."""
        key = tuple(sorted(weights))
        if key not in known:
            known[key] = len(known) + 1
            file.write("v {:.9g} {:.9g} {:.9g}\n".format(*(sum(w * vertices[k][axis] for k, w in key) / n for axis in range(3))))
        return known[key]

    for name, triangles in groups.items():
        file.write(f"g {name}\n")
        for a, b, c in triangles:
            grid = [[vertex([(k, w) for k, w in ((a, n - i - j), (b, i), (c, j)) if w]) for j in range(n + 1 - i)]
                    for i in range(n + 1)]
            for i in range(n):
                for j in range(n - i):
                    file.write(f"f {grid[i][j]} {grid[i + 1][j]} {grid[i][j + 1]}\n")
                    if i + j + 2 <= n:
                        file.write(f"f {grid[i + 1][j]} {grid[i + 1][j + 1]} {grid[i][j + 1]}\n")
            count += n * n
    return count


def run(folder, *words):
    """(standard output, CPU seconds)."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(list(map(str, words)), cwd=folder, capture_output=True, text=True)
    if done.returncode not in (0, 3):  # 3: wanted error not reached
        sys.exit(f"{' '.join(map(str, words))}: {done.stderr}")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return done, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def measure(folder, call, n, vertices, groups):
    (folder / "orbiter.toml").write_text(SCENE)
    with open(folder / "orbiter.obj", "w") as file:
        count = write_cut(file, vertices, groups, n)
    program = call.program.resolve()
    _, inspected = run(folder, program, "inspect", "orbiter.toml", "--json", "--threads", 1)
    done, rendered = run(folder, program, "render", "orbiter.toml", "--camera", call.camera, "--error", call.error, "--threads",
                         1, "-o", f"{n}.exr", "--json")
    report = json.loads(done.stdout)
    error, seconds = report["error"]["estimate"], report["seconds"]
    loading = rendered * (seconds["read"] + seconds["build"]) / sum(seconds.values())
    patches = re.search(r"(\d+) patches", done.stderr).group(1)
    memory = re.search(r"peak memory (.*)", done.stderr).group(1)
    print(f"| {count} | {patches} | {inspected:.2f} | {rendered:.1f} | {loading:.1f} | {memory} | {100 * error:.1f} % |", flush=True)


def dim_pixels(luminances):
    """The dimmest quarter of the blocks that show the orbiter."""
    blocks = {}
    for y in range(TRUTH_SIZE[1]):
        for x in range(TRUTH_SIZE[0]):
            blocks.setdefault((x // 6, y // 6), []).append(y * TRUTH_SIZE[0] + x)
    lit = sorted((sum(luminances[k] for k in pixels), pixels) for pixels in blocks.values()
                 if any(luminances[k] > 0 for k in pixels))
    return [k for _, pixels in lit[:len(lit) // 4] for k in pixels]


def truth(folder, call, vertices, groups):
    (folder / "orbiter.toml").write_text(SCENE)
    with open(folder / "orbiter.obj", "w") as file:
        write_cut(file, vertices, groups, 1)
    print("| camera | wanted | CPU s | true | stated | bias | of dim parts |\n| --- | --- | --- | --- | --- | --- | --- |")
    for camera in ("fwd", "out"):
        def picture(name, *words, camera=camera):
            done, seconds = run(folder, call.program.resolve(), "render", "orbiter.toml", "--camera", camera, "--size",
                                "{}x{}".format(*TRUTH_SIZE), "--json", "-o", name, *words)
            return error_truth.picture(folder / name)[0], seconds, json.loads(done.stdout)
        first, second = (picture("reference.exr", "--indirect", "paths", "--set", "quality.gather_rays=1024", "--seed",
                                 seed)[0] for seed in (101, 102))
        middle = [(a + b) / 2 for a, b in zip(first, second)]
        dim = dim_pixels(middle)
        for wanted in ("0.05", "0.02"):
            for seed in (1, 2, 3):
                values, seconds, report = picture("picture.exr", "--error", wanted, "--seed", seed)
                found = error_truth.compare(values, first, second, [m > 0 for m in middle])
                off = sum(values[k] - middle[k] for k in dim) / sum(middle[k] for k in dim)
                stated = report["error"]["estimate"]
                print(f"| {camera} | {wanted} | {seconds:.1f} | {100 * found.error:.1f} % | {100 * stated:.1f} % | "
                      f"{100 * found.bias:.2f} % | {100 * off:.1f} % |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("mesh", type=pathlib.Path)
    parser.add_argument("--cuts", default="1,8,20")
    parser.add_argument("--error", default="0.05")
    parser.add_argument("--camera", default="out")
    parser.add_argument("--keep", type=pathlib.Path, help="scenes and pictures stay there")
    parser.add_argument("--truth", action="store_true", help="errors against paths, not prices")
    call = parser.parse_args()
    vertices, groups = read(call.mesh)
    if call.truth:
        with tempfile.TemporaryDirectory() as temporary:
            return truth(pathlib.Path(temporary), call, vertices, groups)
    print("| triangles | patches | inspect, CPU s | render, CPU s | of it loading | memory | stated |\n"
          "| --- | --- | --- | --- | --- | --- | --- |")
    with tempfile.TemporaryDirectory() as temporary:
        for n in map(int, call.cuts.split(",")):
            folder = call.keep / str(n) if call.keep else pathlib.Path(temporary)
            folder.mkdir(parents=True, exist_ok=True)
            measure(folder, call, n, vertices, groups)


if __name__ == "__main__":
    main()
