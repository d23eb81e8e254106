#!/usr/bin/env python3
"""Draws docs/images/effect-*.png: each effect off (left) and on (right), with the commands of TABLE.
Usage: docs/effects/draw.py PROGRAM"""
import pathlib
import struct
import subprocess
import sys
import tempfile
import zlib

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
STILL = ROOT / "scenes/library/still-life/scene.toml"
BAY = ROOT / "scenes/library/sts46"
SMALL = ["--size", "320x240"]
# name: (scene, options of both, options off, options on)
TABLE = {
    "interreflection": (STILL, [], ["--indirect", "none"], []),
    "earthshine": (STILL, [], ["--set", "earth.radiance=0"], []),
    "penumbra": (STILL, [], ["--set", "sun.angular_radius_deg=0"], ["--set", "sun.angular_radius_deg=4"]),
    "highlight": (STILL, [], ["--set", "material.glossy.specular=0"], []),
    "mirror": (STILL, [], ["--set", "material.silver.mirror=0"], []),
    "refraction": (STILL, [], ["--set", "material.glass.ior=1"], []),
    "emitter": (STILL, [], ["--set", "material.panel.emit=0"], []),
    "depth-of-field": (STILL, [], [], ["--set", "camera.front.aperture=0.12"]),
    "pixel-filter": (STILL, ["--crop", "90,60,80x60"], [], ["--set", "camera.front.filter=blackman-harris"]),
    "distributed": (BAY / "day-earthshine.toml", ["--camera", "B"],
                    ["--indirect", "distributed", "--distributed-lights", "16"], []),
    "denoised": (STILL, ["--set", "quality.gather_rays=16"], ["--set", "quality.denoise=false"], []),
}


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def read_png(path):
    """Rows of 8-bit RGB as the program writes them."""
    data, at, packed = path.read_bytes(), 8, b""
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        if kind == b"IHDR":
            columns, rows = struct.unpack(">II", data[at + 8:at + 16])
        if kind == b"IDAT":
            packed += data[at + 8:at + 8 + size]
        at += size + 12
    raw, stride, lines = zlib.decompress(packed), 3 * columns, []
    for row in range(rows):
        start = row * (stride + 1)
        line = bytearray(raw[start + 1:start + 1 + stride])
        above = lines[-1] if lines else bytes(stride)
        for k in range(stride):
            left, up = (line[k - 3] if k >= 3 else 0), above[k]
            corner = above[k - 3] if k >= 3 else 0
            guess = left + up - corner
            nearest = min((abs(guess - left), 0, left), (abs(guess - up), 1, up), (abs(guess - corner), 2, corner))[2]
            line[k] = (line[k] + (0, left, up, (left + up) // 2, nearest)[raw[start]]) & 255
        lines.append(bytes(line))
    return columns, lines


def write_pair(path, left, right):
    columns, rows = left[0] + right[0] + 4, len(left[1])
    raw = b"".join(b"\0" + a + b"\xff" * 12 + b for a, b in zip(left[1], right[1]))
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", columns, rows, 8, 2, 0, 0, 0)) +
                     chunk(b"IDAT", zlib.compress(raw, 9)) + chunk(b"IEND", b""))


def main():
    program = sys.argv[1]
    with tempfile.TemporaryDirectory() as folder:
        for name, (scene, both, off, on) in TABLE.items():
            pictures = []
            for options in (off, on):
                png = pathlib.Path(folder) / "view.png"
                subprocess.run([program, "render", scene, "-o", pathlib.Path(folder) / "view.exr", "--png", png,
                                "--quiet", *SMALL, *both, *options], check=True)
                pictures.append(read_png(png))
            write_pair(ROOT / "docs/images" / f"effect-{name}.png", *pictures)
            print(f"docs/images/effect-{name}.png")


if __name__ == "__main__":
    main()
