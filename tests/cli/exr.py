# SPDX-License-Identifier: Apache-2.0
"""Reads the program's output: scan-line OpenEXR, FLOAT and HALF channels, ZIP. Independent of the
library."""
import array
import struct
import zlib

LINES_PER_BLOCK = 16  # ZIP_COMPRESSION


def _text(data, at):
    end = data.index(b"\0", at)
    return data[at:end].decode(), end + 1


def _unpack(block, size):
    """zlib, then the two byte predictors of OpenEXR's ZIP."""
    if len(block) == size:  # stored
        return block
    raw = bytearray(zlib.decompress(block))
    for i in range(1, len(raw)):
        raw[i] = (raw[i - 1] + raw[i] - 128) & 0xFF
    half = (size + 1) // 2
    out = bytearray(size)
    out[0::2] = raw[:half]
    out[1::2] = raw[half:]
    return bytes(out)


def read(path):
    """(header, width, height, channels): header maps names to str, float, 16 floats or raw bytes.
    """
    with open(path, "rb") as file:
        data = file.read()
    magic, version = struct.unpack_from("<ii", data)
    assert magic == 20000630 and version & 0xFF == 2, "not OpenEXR"
    header, names, at = {}, {}, 8  # names: struct format for a row of so many numbers
    while data[at]:
        name, at = _text(data, at)
        kind, at = _text(data, at)
        size, = struct.unpack_from("<i", data, at)
        value = data[at + 4:at + 4 + size]
        at += 4 + size
        if kind == "string":
            value = value.decode()
        elif kind == "float":
            value, = struct.unpack("<f", value)
        elif kind == "m44f":
            value = struct.unpack("<16f", value)
        elif kind == "chlist":
            place = 0
            while value[place]:
                channel, place = _text(value, place)
                names[channel] = {1: "<%de", 2: "<%df"}[struct.unpack_from("<i", value, place)[0]]
                place += 16
        header[name] = value
    assert header["compression"] == b"\x03", "not ZIP"
    x0, y0, x1, y1 = struct.unpack("<iiii", header["dataWindow"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    blocks = (height + LINES_PER_BLOCK - 1) // LINES_PER_BLOCK
    offsets = struct.unpack_from(f"<{blocks}Q", data, at + 1)
    channels = {name: array.array("f") for name in names}
    for offset in offsets:
        y, size = struct.unpack_from("<ii", data, offset)
        lines = min(LINES_PER_BLOCK, y1 + 1 - y)
        raw = _unpack(data[offset + 8:offset + 8 + size], lines * sum(struct.calcsize(form % width) for form in names.values()))
        start = 0
        for _ in range(lines):
            for name, form in names.items():
                channels[name].extend(struct.unpack_from(form % width, raw, start))
                start += struct.calcsize(form % width)
    return header, width, height, channels


# Number type of a channel in the file, and its struct format.
TYPES = {"uint": (0, "I"), "half": (1, "e"), "float": (2, "f")}


def _attribute(name, kind, value):
    return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value


def pack(width, height, channels, kind="float", corner=(0, 0), display=None, more=(), sampling=1, pixels=True):
    """The bytes of an uncompressed scan-line file. channels: names to one value or to a list of
    all. display: the window (x0, y0, x1, y1), by default the data window. more: (name, type, bytes)
    of further attributes. pixels=False: header and offset table only."""
    number, letter = TYPES[kind]
    x0, y0 = corner
    data = (x0, y0, x0 + width - 1, y0 + height - 1)
    names = sorted(channels)
    listed = b"".join(name.encode() + b"\0" + struct.pack("<iBxxxii", number, 0, sampling, sampling) for name in names)
    head = struct.pack("<ii", 20000630, 2)
    for name, type_name, value in (
            ("channels", "chlist", listed + b"\0"), ("compression", "compression", b"\0"),
            ("dataWindow", "box2i", struct.pack("<iiii", *data)),
            ("displayWindow", "box2i", struct.pack("<iiii", *(display or data))),
            ("lineOrder", "lineOrder", b"\0"), ("screenWindowCenter", "v2f", struct.pack("<ff", 0, 0)),
            ("screenWindowWidth", "float", struct.pack("<f", 1)), *more,
            *([] if any(name == "pixelAspectRatio" for name, _, _ in more)
              else [("pixelAspectRatio", "float", struct.pack("<f", 1))])):
        head += _attribute(name, type_name, value)
    head += b"\0"
    if not pixels:
        return head + struct.pack("<Q", 0) * min(height, 1 << 17)
    size = struct.calcsize(letter) * width * len(names)
    start = len(head) + 8 * height
    lines = []
    for y in range(height):
        line = struct.pack("<ii", y0 + y, size)
        for name in names:
            values = channels[name]
            row = values[y * width:(y + 1) * width] if isinstance(values, list) else [values] * width
            line += struct.pack(f"<{width}{letter}", *row)
        lines.append(line)
    table = b"".join(struct.pack("<Q", start + y * (8 + size)) for y in range(height))
    return head + table + b"".join(lines)
