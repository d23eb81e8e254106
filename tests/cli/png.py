# SPDX-License-Identifier: Apache-2.0
"""Reads the program's PNG files of 8 and 16 bits with Python's zlib."""
import struct
import zlib


def paeth(a, b, c):
    """Of left a, above b and above left c, the nearest to a + b - c (PNG specification, 9.4)."""
    p = a + b - c
    return min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]


def pixels(data):
    """Width, height, channels and all bytes, rows from the top; 16-bit numbers with the high byte first."""
    width, height, depth, colour = struct.unpack(">IIBB", data[16:26])
    channels = {0: 1, 2: 3}[colour]
    assert data[:8] == b"\x89PNG\r\n\x1a\n" and depth in (8, 16)
    pixel = channels * depth // 8
    at, packed = 8, b""
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        if kind == b"IDAT":
            packed += data[at + 8:at + 8 + size]
        at += 12 + size
    raw, stride = zlib.decompress(packed), width * pixel
    above, rows = bytearray(stride), bytearray()
    for y in range(height):
        method, row = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for x in range(stride):
            left = row[x - pixel] if x >= pixel else 0
            corner = above[x - pixel] if x >= pixel else 0
            row[x] = row[x] + [0, left, above[x], (left + above[x]) // 2, paeth(left, above[x], corner)][method] & 255
        rows += row
        above = row
    return width, height, channels, bytes(rows)
