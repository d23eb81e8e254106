#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Materials of mesh files against their models: the table of docs/data/materials.md.

usage: EARTHSHINE_PROGRAM=build/release/earthshine material_maps.py

A plate lies under a vertical point-like Sun; cameras view its centre at angles to the normal. A
reflectance factor is pi L / E, measured in pictures of the program, and computed from the formulas
of glTF 2.0 (appendix B) and of the MTL format (illum 2).
"""
import math
import os
import pathlib
import subprocess
import sys
import tempfile

TOP = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path[:0] = [str(TOP / "tests" / "cli"), str(TOP / "tests" / "support")]
import exr  # noqa: E402
import model_kit  # noqa: E402

ANGLES = (0, 10, 20, 40, 60)
SUN_LX = 1000.0
PLATE = [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)]
SCENE = """format = 1
[[object]]
name = "plate"
mesh = "{mesh}"
[sun]
direction = [0, 0, 1]
illuminance = {lux}
angular_radius_deg = 0
"""
CAMERA = """[[camera]]
name = "{angle}"
position = [{x}, 0, {z}]
look_at = [0, 0, 0]
up = [0, 1, 0]
fov_deg = 0.5
resolution = [4, 4]
"""


def scene(mesh):
    text = SCENE.format(mesh=mesh, lux=SUN_LX)
    for angle in ANGLES:
        a = math.radians(angle)
        text += CAMERA.format(angle=angle, x=5 * math.sin(a), z=5 * math.cos(a))
    return text


def measured(program, folder, mesh):
    """Reflectance factors of the green channel at ANGLES."""
    (folder / "plate.toml").write_text(scene(mesh), encoding="utf-8")
    factors = []
    for angle in ANGLES:
        out = folder / "plate.exr"
        subprocess.run([program, "render", folder / "plate.toml", "-o", out, "--camera", str(angle), "--quiet",
                        "--no-error"], check=True, capture_output=True)
        values = exr.read(out)[3]["G"]
        factors.append(math.pi * sum(values) / len(values) / SUN_LX)
    return factors


def gltf(base, metallic, roughness, f0=0.04):
    """pi f of glTF 2.0, B.3, at normal incidence."""
    a2 = roughness ** 4

    def factor(angle):
        view = math.cos(math.radians(angle))
        half = math.cos(math.radians(angle / 2))
        bulge = half * half * (a2 - 1) + 1
        shadowed = view + math.sqrt(a2 + (1 - a2) * view * view)
        specular = a2 / (bulge * bulge) / (2 * shadowed)  # pi D V
        schlick = (1 - half) ** 5
        metal = specular * (base + (1 - base) * schlick)
        fresnel = f0 + (1 - f0) * schlick
        plain = (1 - fresnel) * base + fresnel * specular
        return metallic * metal + (1 - metallic) * plain
    return [factor(angle) for angle in ANGLES]


def mtl(diffuse, specular, exponent):
    """illum 2: Kd (N L) + Ks (N H)^Ns, H the half vector of light and viewer."""
    return [diffuse + specular * math.cos(math.radians(angle / 2)) ** exponent for angle in ANGLES]


def gltf_file(base, metallic, roughness):
    model = model_kit.Model()
    paint = model.material(name="paint", pbrMetallicRoughness={
        "baseColorFactor": [base] * 3 + [1], "metallicFactor": metallic, "roughnessFactor": roughness})
    model.mesh("plate", PLATE, [(0, 1, 2), (0, 2, 3)], paint)
    return {"plate.glb": model.glb()}


def mtl_file(diffuse, specular, exponent):
    faces = "".join(f"v {x} {y} {z}\n" for x, y, z in PLATE)
    return {"plate.obj": f"mtllib plate.mtl\n{faces}usemtl paint\nf 1 2 3 4\n".encode(),
            "plate.mtl": f"newmtl paint\nKd {diffuse}\nKs {specular}\nNs {exponent}\nillum 2\n".encode()}


# Name, files (the first is the mesh), factors of the model.
CASES = [(f"glTF, metallic {m:g}, base {b:g}, roughness {r:g}", gltf_file(b, m, r), gltf(b, m, r))
         for b, m, r in [(0.5, 0, 1.0), (0.5, 0, 0.5), (0.5, 0, 0.3), (0.9, 1, 1.0), (0.9, 1, 0.5), (0.9, 1, 0.3),
                         (0.5, 0.5, 0.5)]] + [
    (f"MTL, Kd {d:g}, Ks {s:g}, Ns {n:g}", mtl_file(d, s, n), mtl(d, s, n)) for d, s, n in
    [(0.5, 0.0, 10), (0.4, 0.5, 10), (0.4, 0.5, 100)]]


def rows(program):
    """(name, measured, model) of each case."""
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        for name, files, own in CASES:
            for file, data in files.items():
                (folder / file).write_bytes(data)
            yield name, measured(program, folder, next(iter(files))), own


def main():
    print("| material | | " + " | ".join(f"{angle}°" for angle in ANGLES) + " |\n| --- |" + " --- |" * (len(ANGLES) + 1))
    for name, here, own in rows(os.environ["EARTHSHINE_PROGRAM"]):
        print(f"| {name} | its model | " + " | ".join(f"{x:.3f}" for x in own) + " |")
        print("| | here | " + " | ".join(f"{x:.3f}" for x in here) + " |")


if __name__ == "__main__":
    main()
