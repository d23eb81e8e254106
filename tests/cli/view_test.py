# SPDX-License-Identifier: Apache-2.0
"""view: one page with the layers of an EXR file, packed as half floats, or with the patches of a solution."""
import base64
import json
import math
import re
import shutil
import struct
import subprocess
import unittest
import zlib

import exr
import program


def plane(data, at, columns, count):
    """Residuals of the MED predictor (ISO 14495-1), low bytes and then high bytes, as console/src/unpack.js has them."""
    numbers = []
    for i in range(count):
        left = numbers[i - 1] if i % columns else None
        above = numbers[i - columns] if i >= columns else None
        guess = 0x8000
        if left is not None and above is not None:
            corner = numbers[i - columns - 1]
            guess = min(left, above) if corner >= max(left, above) else max(left, above) if corner <= min(left, above) else left + above - corner
        elif left is not None or above is not None:
            guess = left if left is not None else above
        folded = data[at + i] | data[at + count + i] << 8
        numbers.append((guess + ((folded >> 1) ^ -(folded & 1))) & 0xffff)
    return numbers


def half(ordered):
    bits = ordered - 0x8000 if ordered >= 0x8000 else 0x8000 | (0x8000 - ordered)
    return struct.unpack("<e", struct.pack("<H", bits))[0]


class View(program.Case):
    @unittest.skipUnless(shutil.which("chromium"), "there is no chromium")
    def test_a_browser_shows_it(self):
        self.write("ball.toml", program.BALL)
        self.done("render", "ball.toml", "--camera", "A", "--error", "0.3", "--aov", "depth", "-o", "a.exr", "-q")
        self.done("view", "a.exr", "-o", "page.html", "-q")
        shown = subprocess.run(["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--virtual-time-budget=10000", "--dump-dom",
                                f"--user-data-dir={self.folder / 'profile'}", (self.folder / "page.html").as_uri()],
                               capture_output=True, text=True, timeout=120).stdout
        self.assertIn('data-ready="picture"', shown)
        self.assertRegex(shown, r'<output id="stops">[0-9.]+ cd/m²</output>')
        self.assertEqual(re.findall(r"<option[^>]*>([^<]*)</option>", shown), ["picture", "Z"])

    def solution_page(self):
        self.write("ball.toml", program.BALL)
        self.done("solve", "ball.toml", "-o", "ball.h5", "-q", "--set", "quality.patch_edge=0.5")
        self.done("view", "ball.h5", "-q")
        return (self.folder / "ball.html").read_text(encoding="utf-8")

    def test_a_solution_is_a_page_with_its_patches(self):
        """The blobs are the file's numbers: corners as they are, luminances of the sum over light groups."""
        try:
            import h5py
        except ImportError:
            self.skipTest("there is no h5py")
        page = self.solution_page()
        self.assertNotIn("http://", page.replace("http-equiv", ""))
        blobs = {k: zlib.decompress(base64.b64decode(text)) for k, text in re.findall(r'<script type="text/plain" id="(b\d+)">([^<]*)<', page)}
        data = json.loads(re.search(r'<script type="application/json" id="data">(.*?)</script>', page, re.S)[1])
        with h5py.File(self.folder / "ball.h5") as file:
            self.assertEqual(blobs[data["corners"]], file["corners"][:].tobytes())
            self.assertEqual(blobs[data["object"]], file["object"][:].astype("<u4").tobytes())
            total = file["radiosity"][:].astype(float).sum(axis=1) @ (0.2126, 0.7152, 0.0722)
        layers = {layer["name"]: layer for layer in data["layers"]}
        self.assertEqual(layers["radiosity"]["unit"], "lm/m²")
        for name, factor in (("radiosity", 1), ("luminance", 1 / math.pi)):
            values = struct.unpack(f"<{len(total)}f", blobs[layers[name]["data"]])
            for value, expected in zip(values, total):
                self.assertAlmostEqual(value, factor * expected, delta=1e-5 * factor * expected + 1e-12)
        self.assertEqual({name for name in layers if name.startswith("radiosity by")}, {"radiosity by lamp", "radiosity by sun"})
        self.write("not.h5", "no solution")
        self.says(self.refused("view", "not.h5"), "not.h5")

    @unittest.skipUnless(shutil.which("chromium"), "there is no chromium")
    def test_a_browser_turns_a_solution(self):
        self.solution_page()
        shown = subprocess.run(["chromium", "--headless", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
                                "--virtual-time-budget=10000", "--dump-dom", f"--user-data-dir={self.folder / 'profile'}",
                                (self.folder / "ball.html").as_uri()], capture_output=True, text=True, timeout=120).stdout
        self.assertIn('data-ready="radiosity"', shown)
        self.assertRegex(shown, r'<output id="stops">[0-9.e+]+ lm/m²</output>')

    def test_the_page_has_the_values(self):
        self.write("ball.toml", program.BALL)
        self.done("render", "ball.toml", "--camera", "A", "--error", "0.3", "--per-light", "--aov", "object,depth,normal", "-o", "a.exr", "-q")
        self.done("view", "a.exr", "-q")
        page = (self.folder / "a.html").read_text(encoding="utf-8")
        self.assertNotIn("http://", page.replace("http-equiv", ""))
        blobs = {k: base64.b64decode(text) for k, text in re.findall(r'<script type="text/plain" id="(b\d+)">([^<]*)<', page)}
        data = json.loads(re.search(r'<script type="application/json" id="data">(.*?)</script>', page, re.S)[1])
        self.assertEqual([layer["name"] for layer in data["layers"]], ["picture", "N", "Z", "light_lamp", "light_sun", "object"])
        self.assertEqual(data["layers"][0]["unit"], "cd/m²")
        self.assertEqual(next(one for one in data["layers"] if one["name"] == "object")["names"], ["floor", "ball"])
        _, width, height, layers = exr.read(self.folder / "a.exr")
        count = width * height
        for layer in data["layers"]:
            packed = zlib.decompress(blobs[layer["data"]])
            green = plane(packed, 0, width, count)
            for c, name in enumerate(layer["channels"]):
                other = green if c == 1 or len(layer["channels"]) == 1 else [
                    (one + g - 0x8000) & 0xffff for one, g in zip(plane(packed, (2 if c == 0 else 4) * count, width, count), green)]
                scale = 2.0 ** layer["exponent"]
                for found, value in zip(other, layers[name]):
                    if math.isfinite(value):
                        self.assertLessEqual(abs(half(found) * scale - value), 2**-11 * abs(value) + 2**-24 * scale)


if __name__ == "__main__":
    unittest.main()
