# SPDX-License-Identifier: Apache-2.0
"""Writes glTF, GLB and PNG files for tests, by their specifications and without the program's code.
"""
import json
import struct
import zlib

LETTERS = {"b": 5120, "B": 5121, "h": 5122, "H": 5123, "I": 5125, "f": 5126}


def png(width, height, pixel, channels=3):
    """8 bits per channel; pixel(x, y) returns the values, row 0 at the top."""
    rows = b"".join(b"\0" + bytes(v for x in range(width) for v in pixel(x, y)) for y in range(height))
    colour = {1: 0, 3: 2, 4: 6}[channels]

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, colour, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


class Model:
    """Builder of a glTF file: json is its tree, binary its single buffer."""

    def __init__(self, **tree):
        self.json = {"asset": {"version": "2.0"}, "accessors": [], "bufferViews": [], "meshes": [], "nodes": [],
                     "materials": [], "scene": 0, "scenes": [{"nodes": []}]} | tree
        self.binary = b""

    def view(self, data):
        self.binary += b"\0" * (-len(self.binary) % 4)
        self.json["bufferViews"].append({"buffer": 0, "byteOffset": len(self.binary), "byteLength": len(data)})
        self.binary += data
        return len(self.json["bufferViews"]) - 1

    def accessor(self, rows, letter="f", normalized=False):
        kind = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4", 16: "MAT4"}[len(rows[0])]
        size = struct.calcsize(letter) * len(rows[0])
        stride = size + -size % 4 if kind != "SCALAR" else size
        data = b"".join(struct.pack("<" + letter * len(row), *row).ljust(stride, b"\0") for row in rows)
        view = self.view(data)
        if kind != "SCALAR":
            self.json["bufferViews"][view]["byteStride"] = stride
        accessor = {"bufferView": view, "componentType": LETTERS[letter], "count": len(rows), "type": kind}
        if kind == "VEC3":
            accessor |= {"min": [min(c) for c in zip(*rows)], "max": [max(c) for c in zip(*rows)]}
        if normalized:
            accessor["normalized"] = True
        self.json["accessors"].append(accessor)
        return len(self.json["accessors"]) - 1

    def image(self, data, kind="image/png"):
        """Adds a separate texture with the bytes of a picture."""
        self.json.setdefault("images", []).append({"bufferView": self.view(data), "mimeType": kind})
        self.json.setdefault("textures", []).append({"source": len(self.json["images"]) - 1})
        return len(self.json["textures"]) - 1

    def material(self, **material):
        self.json["materials"].append(material)
        return len(self.json["materials"]) - 1

    def mesh(self, name, positions, triangles, material, uv=None, normals=None, letter="f", normalized=False, **node):
        """Adds a mesh and a node that uses it, both with this name."""
        attributes = {"POSITION": self.accessor(positions, letter, normalized)}
        if uv:
            attributes["TEXCOORD_0"] = self.accessor(uv)
        if normals:
            attributes["NORMAL"] = self.accessor(normals)
        indices = self.accessor([(i,) for triangle in triangles for i in triangle], "I")
        self.json["meshes"].append({"name": name, "primitives": [
            {"attributes": attributes, "indices": indices, "material": material}]})
        return self.node(name=name, mesh=len(self.json["meshes"]) - 1, **node)

    def node(self, **node):
        self.json["nodes"].append(node)
        self.json["scenes"][0]["nodes"].append(len(self.json["nodes"]) - 1)
        return len(self.json["nodes"]) - 1

    def glb(self):
        tree = {key: value for key, value in self.json.items() if value != []}
        tree["buffers"] = [{"byteLength": len(self.binary)}]
        text = json.dumps(tree).encode()
        text += b" " * (-len(text) % 4)
        binary = self.binary + b"\0" * (-len(self.binary) % 4)
        return (struct.pack("<4sII", b"glTF", 2, 12 + 8 + len(text) + 8 + len(binary)) +
                struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary)
