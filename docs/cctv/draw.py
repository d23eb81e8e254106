#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Draws docs/images/cctv-chain.svg: a corner of one frame after each stage of the CCTV chain, with the stage's law and
unit, and docs/images/cctv-twin.png: what the camera shows, without noise, its deviation, the probability of detection.
Usage: docs/cctv/draw.py PROGRAM"""
import base64
import html
import json
import math
import pathlib
import struct
import subprocess
import sys
import tempfile
import zlib

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.append(str(ROOT / "tests/cli"))
import exr  # noqa: E402

SCENE, CAMERA, PRESET = ROOT / "scenes/library/sts46/night-lamps.toml", "A", "sit-monochrome"
# Shares of the picture's width and height.
CORNER = (0.28, 0.30, 0.50, 0.375)
TILE, ACROSS = (200, 150), 4


def png(columns, rows, values):
    """8-bit grey picture of numbers from 0 to 255."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    raw = b"".join(b"\0" + bytes(values[y * columns:(y + 1) * columns]) for y in range(rows))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", columns, rows, 8, 0, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(raw, 9)) + chunk(b"IEND", b""))


def srgb(value):
    value = min(max(value, 0.0), 1.0)
    return round(255 * (12.92 * value if value <= 0.0031308 else 1.055 * value ** (1 / 2.4) - 0.055))


def corner(width, height, values):
    x0, y0 = round(CORNER[0] * width), round(CORNER[1] * height)
    columns, rows = round(CORNER[2] * width), round(CORNER[3] * height)
    return columns, rows, [values[y * width + x] for y in range(y0, y0 + rows) for x in range(x0, x0 + columns)]


def picture_of(width, height, values, unit):
    """Light relative to what is nearly its brightest; a signal on the line as the screen would show it."""
    columns, rows, part = corner(width, height, values)
    white = sorted(values)[int(0.995 * (len(values) - 1))] if unit in ("cd/m^2", "lx") else 1.0
    light = (lambda v: max(v, 0.0) ** 2.2) if unit == "line signal" else (lambda v: v / white)
    return png(columns, rows, [srgb(light(value)) for value in part])


def draw_chain(program, folder, picture):
    report = json.loads(subprocess.run(
        [program, "degrade", picture, "-o", folder / "c.png", "--preset", PRESET, "--stages", folder / "stages", "--json",
         "--quiet"], check=True, capture_output=True, text=True).stdout)
    table = {stage["name"]: stage for stage in json.loads(subprocess.run(
        [program, "degrade", "--list", "--json"], check=True, capture_output=True, text=True).stdout)["stages"]}
    width, height = TILE[0] + 16, TILE[1] + 52
    lines = math.ceil(len(report["stages"]) / ACROSS)
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{ACROSS * width + 8}" height="{lines * height + 8}" '
             'font-family="sans-serif" font-size="11">',
             '<rect width="100%" height="100%" fill="white"/>']
    for number, name in enumerate(report["stages"], 1):
        _, columns, rows, channels = exr.read(folder / "stages" / f"{number:02}-{name}.exr")
        stage, at = table[name], ((number - 1) % ACROSS * width + 8, (number - 1) // ACROSS * height + 8)
        data = base64.b64encode(picture_of(columns, rows, channels["Y"], stage["out"])).decode()
        law = stage["law"] if len(stage["law"]) < 38 else stage["law"][:36] + "…"
        parts += [f'<image x="{at[0]}" y="{at[1] + 30}" width="{TILE[0]}" height="{TILE[1]}" '
                  f'style="image-rendering:pixelated" href="data:image/png;base64,{data}"/>',
                  f'<text x="{at[0]}" y="{at[1] + 11}" font-weight="bold">{number}. {name}</text>',
                  f'<text x="{at[0] + TILE[0]}" y="{at[1] + 11}" text-anchor="end" fill="#555">'
                  f'{html.escape(stage["out"])}</text>',
                  f'<text x="{at[0]}" y="{at[1] + 25}" fill="#333">{html.escape(law)}</text>']
    (ROOT / "docs/images/cctv-chain.svg").write_text("\n".join(parts + ["</svg>\n"]))
    print("docs/images/cctv-chain.svg")


def draw_twin(program, folder, picture):
    subprocess.run([program, "degrade", picture, "-o", folder / "c.png", "--preset", PRESET, "--twin", folder / "t.exr",
                    "--quiet"], check=True)
    _, columns, rows, twin = exr.read(folder / "t.exr")
    white = 101.0  # of the screen, with the room's light
    strips = [[value / white for value in twin["Y"]], [value / white for value in twin["twin.Y"]],
              [10 * math.sqrt(value) / white for value in twin["variance.Y"]],
              [value ** 2.2 for value in twin["detection.probability.Y"]]]
    parts = [corner(columns, rows, strip) for strip in strips]
    width, height = parts[0][0], parts[0][1]
    rows_of = []
    for pair in (parts[:2], parts[2:]):
        for y in range(height):
            rows_of += [srgb(value) for value in pair[0][2][y * width:(y + 1) * width]] + [255] * 4
            rows_of += [srgb(value) for value in pair[1][2][y * width:(y + 1) * width]]
        rows_of += [255] * (2 * width + 4) * 4
    (ROOT / "docs/images/cctv-twin.png").write_bytes(png(2 * width + 4, 2 * height + 8, rows_of))
    print("docs/images/cctv-twin.png")


def main():
    program = sys.argv[1]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        subprocess.run([program, "render", SCENE, "--camera", CAMERA, "-o", folder / "view.exr", "--quiet"], check=True)
        draw_chain(program, folder, folder / "view.exr")
        draw_twin(program, folder, folder / "view.exr")


if __name__ == "__main__":
    main()
