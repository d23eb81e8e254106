#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Rough metals of glTF against Blender Cycles: mean of a picture of a sunlit ball.

usage: EARTHSHINE_PROGRAM=build/release/earthshine metals.py [BLENDER]

A ball of base colour 0.9, by roughness, is lit by a Sun at an angle to the camera's direction; the
background is black. Cycles uses the Glossy BSDF with single scattering (GGX) and with multiple
scattering (MULTI_GGX), without Fresnel. Prints the ratio of our mean to each. The Blender part of
the script runs inside Blender.
"""
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile

ROUGHNESS = (0.3, 0.5, 0.7, 0.85, 1.0)
ANGLES = (0, 60, 120)
RINGS, SECTORS = 96, 192
SIZE = 64
ASIDE_M = 10.0


def ball():
    """Vertices and triangles of a ball of radius 1."""
    vertices = [(0.0, 0.0, 1.0)]
    for i in range(1, RINGS):
        t = math.pi * i / RINGS
        vertices += [(math.sin(t) * math.cos(2 * math.pi * j / SECTORS), math.sin(t) * math.sin(2 * math.pi * j / SECTORS),
                      math.cos(t)) for j in range(SECTORS)]
    vertices.append((0.0, 0.0, -1.0))
    last = len(vertices) - 1
    faces = []
    for j in range(SECTORS):
        k = (j + 1) % SECTORS
        faces.append((0, 1 + j, 1 + k))
        faces.append((last, last - SECTORS + k, last - SECTORS + j))
        for i in range(RINGS - 2):
            a, b = 1 + i * SECTORS, 1 + (i + 1) * SECTORS
            faces += [(a + j, b + j, b + k), (a + j, b + k, a + k)]
    return vertices, faces


def sun(angle):
    """Direction to the Sun; the camera is along +x."""
    return math.cos(math.radians(angle)), math.sin(math.radians(angle)), 0.0


def in_blender():
    import bpy
    import mathutils
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    vertices, faces = ball()
    mesh = bpy.data.meshes.new("ball")
    mesh.from_pydata(vertices, [], faces)
    material = bpy.data.materials.new("metal")
    material.use_nodes = True
    nodes = material.node_tree.nodes
    nodes.clear()
    shader, out = nodes.new("ShaderNodeBsdfGlossy"), nodes.new("ShaderNodeOutputMaterial")
    shader.inputs["Color"].default_value = [0.9, 0.9, 0.9, 1]
    material.node_tree.links.new(shader.outputs[0], out.inputs["Surface"])
    mesh.materials.append(material)
    scene.collection.objects.link(bpy.data.objects.new("ball", mesh))
    light = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    light.data.energy, light.data.angle = 1.0, 0.0
    scene.collection.objects.link(light)
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.location = (ASIDE_M, 0, 0)
    camera.rotation_euler = mathutils.Vector((-1, 0, 0)).to_track_quat("-Z", "Y").to_euler()
    camera.data.angle = 2 * math.asin(1.1 / ASIDE_M)
    scene.collection.objects.link(camera)
    scene.camera = camera
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.max_bounces = 16, False, 0
    scene.cycles.filter_width = 0.01
    scene.render.resolution_x = scene.render.resolution_y = SIZE
    scene.render.image_settings.file_format = "OPEN_EXR"
    means = {}
    with tempfile.TemporaryDirectory() as folder:
        scene.render.filepath = folder + "/a.exr"
        for kind in ("GGX", "MULTI_GGX"):
            shader.distribution = kind
            for roughness in ROUGHNESS:
                shader.inputs["Roughness"].default_value = roughness
                for angle in ANGLES:
                    light.rotation_euler = (-mathutils.Vector(sun(angle))).to_track_quat("-Z", "Y").to_euler()
                    bpy.ops.render.render(write_still=True)
                    image = bpy.data.images.load(scene.render.filepath)
                    means[f"{kind} {roughness} {angle}"] = sum(list(image.pixels)[1::4]) / SIZE ** 2
                    bpy.data.images.remove(image)
    print("MEANS " + json.dumps(means))


def ours(program, folder):
    top = pathlib.Path(__file__).resolve().parents[3]
    sys.path[:0] = [str(top / "tests" / "cli"), str(top / "tests" / "support")]
    import exr
    import model_kit
    vertices, faces = ball()
    means = {}
    for roughness in ROUGHNESS:
        model = model_kit.Model()
        model.material(name="metal", pbrMetallicRoughness={"baseColorFactor": [0.9, 0.9, 0.9, 1],
                                                           "roughnessFactor": roughness})
        model.mesh("ball", vertices, faces, 0)
        (folder / "ball.glb").write_bytes(model.glb())
        for angle in ANGLES:
            x, y, z = sun(angle)
            # A Sun of strength 1 in Blender gives 1 W/m^2 on a plane that faces it.
            (folder / "ball.toml").write_text(f"""format = 1
[[object]]
name = "ball"
mesh = "ball.glb"
axes = "as-is"
[[light]]
name = "sun"
type = "distant"
direction = [{x}, {y}, {z}]
illuminance = 1
[[camera]]
name = "c"
position = [{ASIDE_M}, 0, 0]
look_at = [0, 0, 0]
fov_deg = {2 * math.degrees(math.asin(1.1 / ASIDE_M))}
resolution = [{SIZE}, {SIZE}]
""", encoding="utf-8")
            subprocess.run([program, "render", folder / "ball.toml", "-o", folder / "a.exr", "--quiet", "--indirect",
                            "none", "--error", "0.01"], check=True, capture_output=True)
            values = exr.read(folder / "a.exr")[3]["G"]
            means[f"{roughness} {angle}"] = sum(values) / len(values)
    return means


def main():
    blender = sys.argv[1] if len(sys.argv) > 1 else "blender"
    run = subprocess.run([blender, "-b", "--factory-startup", "--python-exit-code", "1", "--python", __file__, "--",
                          "inside"], check=True, capture_output=True, text=True)
    theirs = json.loads(next(line for line in run.stdout.splitlines() if line.startswith("MEANS "))[6:])
    with tempfile.TemporaryDirectory() as temporary:
        means = ours(os.environ["EARTHSHINE_PROGRAM"], pathlib.Path(temporary))
    print("| roughness | " + " | ".join(f"Sun at {a}°: single, multiple" for a in ANGLES) + " |")
    print("| --- |" + " --- |" * len(ANGLES))
    for roughness in ROUGHNESS:
        cells = []
        for angle in ANGLES:
            mean = means[f"{roughness} {angle}"]
            cells.append(", ".join(f"{mean / theirs[f'{kind} {roughness} {angle}']:.2f}" for kind in ("GGX", "MULTI_GGX")))
        print(f"| {roughness} | " + " | ".join(cells) + " |")


if __name__ == "__main__":
    if "inside" in sys.argv:
        in_blender()
    else:
        main()
