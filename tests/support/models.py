#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Three small models with textures and the faults of exported meshes; tests/cli/models_test.py has
the right answers.

usage: models.py FOLDER

  crate     OBJ, MTL and PNG: a closed box with a picture on each side; its faces are exported
            twice and inside out
  hall      GLB: a floor of squares (KHR_texture_transform, quantised positions), walls exported
            with both windings, a lamp and a camera in the file
  grille    glTF with separate pictures: a grating cut out by an opacity mask, a screen that emits
            in squares
"""
import json
import pathlib
import sys

import model_kit

SQUARE = [(0, 1, 2), (0, 2, 3)]
# Corners counter-clockwise from the lower left; v points down in glTF.
UV = [(0, 1), (1, 1), (1, 0), (0, 0)]


def squares(light, dark, alpha=None):
    """A picture of 2 x 2 squares, bright at the upper left."""
    def pixel(x, y):
        value = light if (x + y) % 2 == 0 else dark
        return (value,) * 3 if alpha is None else (value,) * 3 + (255 if (x + y) % 2 == 0 else alpha,)
    return model_kit.png(2, 2, pixel, 3 if alpha is None else 4)


def crate(sound=False):
    """Files by name. Each side shows the picture upright from outside: red left, green right."""
    corners = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
    faces = [(0, 1, 5, 4), (1, 3, 7, 5), (3, 2, 6, 7), (2, 0, 4, 6), (4, 5, 7, 6), (2, 3, 1, 0)]
    text = "mtllib crate.mtl\n" + "".join(f"v {x} {y} {z}\n" for x, y, z in corners)
    text += "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl sides\n"
    for face in faces if sound else [face for side in faces for face in (side, side)]:
        words = [f"{vertex + 1}/{k + 1}" for k, vertex in enumerate(face)]
        text += "f " + " ".join(words if sound else words[::-1]) + "\n"
    picture = model_kit.png(64, 64, lambda x, y: (230, 20, 20) if x < 32 else (20, 230, 20))
    return {"crate.obj": text.encode(), "crate.mtl": b"newmtl sides\nKd 1 1 1\nmap_Kd crate side.png\nillum 1\n",
            "crate side.png": picture}


def hall(plain=False, sound=False):
    """plain: the floor's mean instead of its squares. The floor is 4 m wide, its squares 0.25 m."""
    model = model_kit.Model(
        extensionsUsed=["KHR_lights_punctual", "KHR_mesh_quantization", "KHR_texture_transform"],
        extensionsRequired=["KHR_mesh_quantization", "KHR_texture_transform"],
        extensions={"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 300}]}},
        cameras=[{"type": "perspective", "perspective": {"yfov": 0.9, "znear": 0.1, "aspectRatio": 1}}],
        samplers=[{"magFilter": 9728}])
    picture = model.image(squares(255, 0))
    model.json["textures"][picture]["sampler"] = 0
    turn = {"KHR_texture_transform": {"scale": [8, 8], "offset": [0.5, 0]}}
    floor = {"metallicFactor": 0, "baseColorFactor": [0.8, 0.8, 0.8, 1]}
    if plain:
        floor["baseColorFactor"] = [0.4, 0.4, 0.4, 1]
    else:
        floor["baseColorTexture"] = {"index": picture, "extensions": turn}
    floor = model.material(name="floor", pbrMetallicRoughness=floor)
    wall = model.material(name="wall", pbrMetallicRoughness={"metallicFactor": 0, "baseColorFactor": [0.7, 0.7, 0.7, 1]},
                          doubleSided=sound)
    # 16 bits, normalised: 1 is 2 m.
    model.mesh("floor", [(-32767, -32767, 0), (32767, -32767, 0), (32767, 32767, 0), (-32767, 32767, 0)], SQUARE, floor,
               UV, letter="h", normalized=True, scale=[2, 2, 2])
    backs = [] if sound else [(2, 1, 0), (3, 2, 0)]
    model.mesh("back", [(-2, 2, 0), (2, 2, 0), (2, 2, 3), (-2, 2, 3)], SQUARE + backs, wall)
    model.mesh("side", [(-2, -2, 0), (-2, 2, 0), (-2, 2, 3), (-2, -2, 3)], SQUARE + backs, wall)
    model.node(name="bulb", translation=[0.5, -0.5, 2], extensions={"KHR_lights_punctual": {"light": 0}})
    # From the front, slightly downward: a quarter turn about x, minus 0.2 rad.
    model.node(name="eye", camera=0, translation=[0, -5, 2.2], rotation=[0.6313, 0, 0, 0.7755])
    return {"hall.glb": model.glb()}


def grille():
    """A grating 2 m wide with holes over half its area, 1 m above a floor. A screen of 1 m2 below
    it emits 100 cd/m2 from half of its area."""
    model = model_kit.Model(extensionsUsed=["KHR_materials_emissive_strength", "KHR_texture_transform"],
                            samplers=[{"magFilter": 9728}])
    model.json["images"] = [{"uri": "bars%20cut.png"}, {"uri": "squares.png"}]
    model.json["textures"] = [{"source": 0, "sampler": 0}, {"source": 1, "sampler": 0}]
    fine = {"KHR_texture_transform": {"scale": [10, 10]}}
    bars = model.material(name="bars", doubleSided=True, alphaMode="MASK", pbrMetallicRoughness={
        "metallicFactor": 0, "baseColorTexture": {"index": 0, "extensions": fine}})
    screen = model.material(name="screen", emissiveFactor=[1, 1, 1], emissiveTexture={"index": 1},
                            extensions={"KHR_materials_emissive_strength": {"emissiveStrength": 100}},
                            pbrMetallicRoughness={"metallicFactor": 0, "baseColorFactor": [0, 0, 0, 1]})
    floor = model.material(name="floor", pbrMetallicRoughness={"metallicFactor": 0,
                                                               "baseColorFactor": [0.5, 0.5, 0.5, 1]})
    model.mesh("bars", [(-1, -1, 1), (1, -1, 1), (1, 1, 1), (-1, 1, 1)], SQUARE, bars, UV)
    model.mesh("screen", [(2, 0.5, 1), (2, -0.5, 1), (2, -0.5, 2), (2, 0.5, 2)], SQUARE, screen, UV)
    model.mesh("floor", [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], SQUARE, floor)
    tree = {key: value for key, value in model.json.items() if value != []}
    tree["buffers"] = [{"byteLength": len(model.binary), "uri": "grille.bin"}]
    return {"grille.gltf": json.dumps(tree).encode(), "grille.bin": model.binary,
            "bars cut.png": squares(180, 180, alpha=0), "squares.png": squares(255, 0)}


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for files in (crate(), hall(), grille()):
        for name, data in files.items():
            (folder / name).write_bytes(data)


if __name__ == "__main__":
    main()
