# SPDX-License-Identifier: Apache-2.0
"""Reads a GLB file and checks it against glTF 2.0: chunks, alignment, ranges, bounds."""
import json
import struct

NUMBERS = {5125: ("I", 4), 5126: ("f", 4)}
COMPONENTS = {"SCALAR": 1, "VEC3": 3}


def demand(holds, what):
    if not holds:
        raise AssertionError(what)


class Glb:
    def __init__(self, data):
        magic, version, length = struct.unpack_from("<4sII", data)
        demand((magic, version, length) == (b"glTF", 2, len(data)), f"head {magic} {version} {length}")
        chunks, at = [], 12
        while at < len(data):
            size, kind = struct.unpack_from("<I4s", data, at)
            demand(size % 4 == 0 and at + 8 + size <= len(data), f"chunk {kind} of {size} bytes")
            chunks.append((kind, data[at + 8:at + 8 + size]))
            at += 8 + size
        demand([kind for kind, _ in chunks] == [b"JSON", b"BIN\0"], [kind for kind, _ in chunks])
        self.json, self.binary = json.loads(chunks[0][1]), chunks[1][1]
        buffer, = self.json["buffers"]
        demand("uri" not in buffer and 0 <= len(self.binary) - buffer["byteLength"] < 4, buffer)
        demand(self.json["asset"]["version"] == "2.0", self.json["asset"])
        used = {node.get("mesh") for node in self.json["nodes"]}
        demand(used - {None} == set(range(len(self.json["meshes"]))), "a mesh without a node")

    def values(self, number, bounds=False):
        accessor = self.json["accessors"][number]
        view = self.json["bufferViews"][accessor["bufferView"]]
        letter, width = NUMBERS[accessor["componentType"]]
        components = COMPONENTS[accessor["type"]]
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        size = accessor["count"] * components * width
        demand(start % 4 == 0 and accessor["count"] > 0 and size <= view["byteLength"], accessor)
        demand(view.get("byteOffset", 0) + view["byteLength"] <= self.json["buffers"][0]["byteLength"], view)
        demand(view["target"] == (34963 if components == 1 else 34962), view)
        rows = list(struct.iter_unpack(f"<{components}{letter}", self.binary[start:start + size]))
        if bounds:
            demand(accessor["min"] == [min(column) for column in zip(*rows)], "min")
            demand(accessor["max"] == [max(column) for column in zip(*rows)], "max")
        return rows


def read(data):
    return Glb(data)
