# SPDX-License-Identifier: Apache-2.0
"""Renders one of our scene files with Blender Cycles. Runs inside Blender:

    blender -b --factory-startup --python-exit-code 1 --python cycles_scene.py -- \\
        SCENE.toml OUT.exr SAMPLES SEED

Reads the part of the format that the comparison needs: OBJ meshes, whole or by part, diffuse and
emitting materials, the Sun, the uniform Earth, one pinhole camera. Anything else is refused, so that
the two programs never render different scenes.
"""
import math
import pathlib
import sys
import tomllib

import bpy
import mathutils

KEYS = {
    "": {"format", "name", "unit", "material", "object", "sun", "earth", "camera"},
    "material": {"name", "diffuse", "emit", "two_sided"},
    "object": {"name", "mesh", "part", "material"},
    "sun": {"direction", "illuminance", "angular_radius_deg"},
    "earth": {"direction", "model", "radiance", "half_angle_deg"},
    "camera": {"name", "position", "look_at", "up", "fov_deg", "resolution"},
}


def check_keys(table, kind):
    unknown = set(table) - KEYS[kind]
    if unknown:
        sys.exit(f"{kind or 'scene'}: {', '.join(sorted(unknown))} not known to the Cycles side")


def colour(value):
    return [float(value)] * 3 if isinstance(value, (int, float)) else [float(v) for v in value]


def read_part(path, part):
    """Vertices of the file, and the polygons of all groups of this name; None: of the whole file."""
    vertices, polygons, group = [], [], ""
    for line in path.read_text(encoding="utf-8").splitlines():
        words = line.split()
        if not words:
            continue
        if words[0] == "v":
            vertices.append(tuple(map(float, words[1:4])))
        elif words[0] in ("g", "o"):
            group = words[1]
        elif words[0] == "f" and part in (None, group):
            polygons.append([int(word.split("/")[0]) - 1 for word in words[1:]])
    if not polygons:
        sys.exit(f"{path}: no part {part}")
    return vertices, polygons


def make_material(table):
    material = bpy.data.materials.new(table["name"])
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    out = nodes.new("ShaderNodeOutputMaterial")
    emit = colour(table.get("emit", 0.0))
    if max(emit) > 0.0:
        if max(colour(table["diffuse"])) > 0.0:
            sys.exit(f"{table['name']}: emits and reflects, not known to the Cycles side")
        # Cycles emits from both sides; the backs of these lamps face out of the rooms. `emit` is
        # exitance, the shader needs radiance.
        shader = nodes.new("ShaderNodeEmission")
        shader.inputs["Strength"].default_value = max(emit) / math.pi
        shader.inputs["Color"].default_value = [e / max(emit) for e in emit] + [1.0]
    else:
        shader = nodes.new("ShaderNodeBsdfDiffuse")  # Lambert at roughness 0, equal on both sides
        shader.inputs["Color"].default_value = colour(table["diffuse"]) + [1.0]
        shader.inputs["Roughness"].default_value = 0.0
    links.new(shader.outputs[0], out.inputs["Surface"])
    return material


def make_objects(scene, folder):
    materials = {table["name"]: make_material(table) for table in scene["material"]}
    for table in scene["object"]:
        mesh = bpy.data.meshes.new(table["name"])
        vertices, polygons = read_part(folder / table["mesh"], table.get("part"))
        mesh.from_pydata(vertices, [], polygons)
        mesh.materials.append(materials[table["material"]])
        bpy.context.collection.objects.link(bpy.data.objects.new(table["name"], mesh))


def make_sun(table):
    data = bpy.data.lights.new("sun", "SUN")
    light = colour(table.get("illuminance", 133100.0))
    data.energy = max(light)  # irradiance of a plate that faces it
    data.color = [c / max(light) for c in light]
    data.angle = math.radians(2.0 * table.get("angular_radius_deg", 0.2666))
    sun = bpy.data.objects.new("sun", data)
    sun.rotation_mode = "QUATERNION"
    sun.rotation_quaternion = mathutils.Vector(table["direction"]).to_track_quat("Z", "Y")
    bpy.context.collection.objects.link(sun)


def make_world(earth):
    """The Earth's disc: constant radiance within a cone, black outside."""
    world = bpy.data.worlds.new("sky")
    bpy.context.scene.world = world
    world.use_nodes = True
    nodes, links = world.node_tree.nodes, world.node_tree.links
    nodes.clear()
    out = nodes.new("ShaderNodeOutputWorld")
    background = nodes.new("ShaderNodeBackground")
    background.inputs["Color"].default_value = [0.0, 0.0, 0.0, 1.0]
    links.new(background.outputs[0], out.inputs["Surface"])
    if earth is None:
        return
    if earth["model"] != "uniform":
        sys.exit("earth: only the uniform model is known to the Cycles side")
    radiance = colour(earth["radiance"])
    background.inputs["Color"].default_value = [r / max(radiance) for r in radiance] + [1.0]
    direction = nodes.new("ShaderNodeTexCoord")
    towards = nodes.new("ShaderNodeVectorMath")
    towards.operation = "DOT_PRODUCT"
    towards.inputs[1].default_value = mathutils.Vector(earth["direction"]).normalized()
    within = nodes.new("ShaderNodeMath")
    within.operation = "GREATER_THAN"
    within.inputs[1].default_value = math.cos(math.radians(earth["half_angle_deg"]))
    strength = nodes.new("ShaderNodeMath")
    strength.operation = "MULTIPLY"
    strength.inputs[1].default_value = max(radiance)
    links.new(direction.outputs["Generated"], towards.inputs[0])
    links.new(towards.outputs["Value"], within.inputs[0])
    links.new(within.outputs[0], strength.inputs[0])
    links.new(strength.outputs[0], background.inputs["Strength"])


def make_camera(table):
    data = bpy.data.cameras.new(table["name"])
    data.sensor_fit = "VERTICAL"
    data.sensor_height = 24.0
    data.lens = 12.0 / math.tan(math.radians(table["fov_deg"]) / 2.0)
    data.clip_start, data.clip_end = 1e-4, 1e6
    camera = bpy.data.objects.new(table["name"], data)
    position, look_at, up = (mathutils.Vector(v) for v in (table["position"], table["look_at"], table.get("up", (0, 0, 1))))
    back = (position - look_at).normalized()
    right = up.cross(back).normalized()
    axes = mathutils.Matrix((right, back.cross(right), back)).transposed()
    camera.matrix_world = mathutils.Matrix.Translation(position) @ axes.to_4x4()
    bpy.context.collection.objects.link(camera)
    bpy.context.scene.camera = camera


def set_up_render(resolution, out, samples, seed):
    render = bpy.context.scene.render
    render.engine = "CYCLES"
    render.resolution_x, render.resolution_y = resolution
    render.resolution_percentage = 100
    render.filepath = out
    render.image_settings.file_format = "OPEN_EXR"
    render.image_settings.color_mode = "RGB"
    render.image_settings.color_depth = "32"
    render.image_settings.exr_codec = "ZIP"
    cycles = bpy.context.scene.cycles
    cycles.device = "CPU"
    cycles.samples = samples
    cycles.seed = seed
    cycles.use_adaptive_sampling = False
    cycles.use_denoising = False
    cycles.pixel_filter_type = "BOX"
    cycles.filter_width = 1.0
    # All bounces, as in the reference, and no option that trades bias for noise.
    for bounces in ("max_bounces", "diffuse_bounces", "glossy_bounces", "transmission_bounces"):
        setattr(cycles, bounces, 1024)
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0.0
    cycles.light_sampling_threshold = 0.0
    cycles.blur_glossy = 0.0


def main(scene_path, out, samples, seed):
    path = pathlib.Path(scene_path)
    scene = tomllib.loads(path.read_text(encoding="utf-8"))
    check_keys(scene, "")
    for kind in ("material", "object", "camera"):
        for table in scene[kind]:
            check_keys(table, kind)
    if "sun" in scene:
        check_keys(scene["sun"], "sun")
    if "earth" in scene:
        check_keys(scene["earth"], "earth")
    if scene.get("unit", "m") != "m":
        sys.exit("only metres are known to the Cycles side")
    bpy.ops.wm.read_factory_settings(use_empty=True)
    make_objects(scene, path.parent)
    if "sun" in scene:
        make_sun(scene["sun"])
    make_world(scene.get("earth"))
    camera = scene["camera"][0]
    make_camera(camera)
    set_up_render(camera["resolution"], out, int(samples), int(seed))
    bpy.ops.render.render(write_still=True)


main(*sys.argv[sys.argv.index("--") + 1:])
