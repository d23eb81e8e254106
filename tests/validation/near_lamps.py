#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Point lamps close to a floor, with spots of light narrower than a pixel: mean of a picture over
the exact mean.

usage: near_lamps.py PROGRAM

A lamp of intensity I sends the flux I W into the solid angle W. A vertical picture of the area A of
a floor of reflectance rho therefore has the mean rho I W / (pi A). A rectangle below the lamp at
distance h has
  W = sum of +- atan(a b / (h sqrt(a^2 + b^2 + h^2))) over its corners (a, b).
"""
import math
import pathlib
import subprocess
import sys
import tempfile

import error_truth

FLUX, RHO, FOOT, DISTANCE, FIELD_DEG, EDGE_PX = 1000.0, 0.5, (0.013, 0.021), 4.0, 40.0, 33
SCENE = """format = 1
[[material]]
name = "white"
diffuse = {rho}
[[object]]
name = "floor"
shape = "quad"
material = "white"
corners = [[-2, -2, 0], [2, -2, 0], [2, 2, 0], [-2, 2, 0]]
[[light]]
name = "lamp"
type = "point"
position = [{x}, {y}, {height}]
flux = {flux}
[[camera]]
name = "A"
position = [0, 0, {distance}]
look_at = [0, 0, 0]
up = [0, 1, 0]
fov_deg = {field}
resolution = [{edge}, {edge}]
"""
HALF = DISTANCE * math.tan(math.radians(FIELD_DEG / 2))


def exact_mean(height):
    def corner(a, b):
        return math.atan(a * b / (height * math.sqrt(a * a + b * b + height * height)))

    xs, ys = ((-HALF - foot, HALF - foot) for foot in FOOT)
    angle = sum(corner(a, b) * (1 if i == j else -1) for i, a in enumerate(xs) for j, b in enumerate(ys))
    return RHO * FLUX / (4 * math.pi) * angle / math.pi / (2 * HALF)**2


def drawn_mean(program, folder, height, seed):
    (folder / "scene.toml").write_text(SCENE.format(rho=RHO, x=FOOT[0], y=FOOT[1], height=height, flux=FLUX, distance=DISTANCE,
                                                    field=FIELD_DEG, edge=EDGE_PX))
    run = subprocess.run([program, "render", folder / "scene.toml", "--error", "0.05", "--seed", str(seed), "-q", "-o",
                          folder / "picture.exr"], check=False)
    if run.returncode not in (0, 3):  # 3: wanted error not reached
        sys.exit(run.returncode)
    values = error_truth.picture(folder / "picture.exr")[0]
    return sum(values) / len(values)


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    print("| height | pixel over height | mean over exact |\n| --- | --- | --- |")
    with tempfile.TemporaryDirectory() as temporary:
        for height in (0.3, 0.1, 0.03, 0.01, 0.003, 0.001, 0.0003):
            shares = [drawn_mean(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(temporary), height, seed) / exact_mean(height)
                      for seed in (1, 2, 3)]
            print(f"| {1000 * height:g} mm | {2 * HALF / EDGE_PX / height:.1f} | " +
                  ", ".join(f"{share:.3f}" for share in shares) + " |", flush=True)


if __name__ == "__main__":
    main()
