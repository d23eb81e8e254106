# SPDX-License-Identifier: Apache-2.0
"""Layers and their names in the header, as compositing and computer-vision programs read them."""
import json
import math
import struct
import unittest

import exr
import program


def ranks(channels, kind, pixel):
    """(bits of the id, coverage) of every rank with coverage."""
    found = []
    for layer in ("00", "01", "02"):
        for name, cover in (("R", "G"), ("B", "A")):
            coverage = channels[f"{kind}{layer}.{cover}"][pixel]
            if coverage > 0:
                bits, = struct.unpack("<I", struct.pack("<f", channels[f"{kind}{layer}.{name}"][pixel]))
                found.append((bits, coverage))
    return found


def manifest(header, kind):
    """Lookup as in a compositing program: by the layer's name among all keys."""
    keys = [name.split("/")[1] for name, value in header.items()
            if name.startswith("cryptomatte/") and name.endswith("/name") and value == kind]
    assert len(keys) == 1 and len(keys[0]) == 7
    prefix = f"cryptomatte/{keys[0]}/"
    assert header[prefix + "hash"] == "MurmurHash3_32"
    assert header[prefix + "conversion"] == "uint32_to_float32"
    return {name: int(bits, 16) for name, bits in json.loads(header[prefix + "manifest"]).items()}


class Layers(program.Case):
    def render(self, text, *options):
        self.write("scene.toml", text)
        self.done("render", "scene.toml", "-o", "out.exr", "-q", "--indirect", "none", *options)
        return exr.read(self.folder / "out.exr")

    def test_object_picked_by_name_is_the_object_of_the_id_layer(self):
        header, width, height, channels = self.render(
            program.BALL, "--size", "48x40", "--set", "quality.gather_rays=256",
            "--aov", "object,material,crypto_object,crypto_material")
        for kind, layer, names in (("CryptoObject", "object", "objects"), ("CryptoMaterial", "material", "materials")):
            ids, listed = manifest(header, kind), json.loads(header[f"earthshine:{names}"])
            self.assertEqual(sorted(ids), sorted(listed))
            numbers = channels[layer]
            for y in range(1, height - 1):
                for x in range(1, width - 1):
                    pixel = y * width + x
                    around = {numbers[pixel + dy * width + dx] for dy in (-1, 0, 1) for dx in (-1, 0, 1)}
                    if len(around) != 1:
                        continue  # near an edge the matte is partial
                    number = int(numbers[pixel])
                    expected = [] if number < 0 else [(ids[listed[number]], 1.0)]
                    self.assertEqual(ranks(channels, kind, pixel), expected)
        partial = [pixel for pixel in range(width * height) if 0 < channels["CryptoObject00.G"][pixel] < 1]
        self.assertGreater(len(partial), 20)
        for pixel in partial:
            covered = [coverage for _, coverage in ranks(channels, "CryptoObject", pixel)]
            self.assertEqual(covered, sorted(covered, reverse=True))
            self.assertLessEqual(sum(covered), 1.0)
        # The matte's mean is the object's share of the picture; the ids give it except for edge
        # pixels.
        ball = sum(coverage for pixel in range(width * height) for bits, coverage in
                   ranks(channels, "CryptoObject", pixel) if bits == manifest(header, "CryptoObject")["ball"])
        self.assertLess(abs(ball - sum(n == 1 for n in channels["object"])), 0.25 * len(partial))

    def test_matte_is_made_of_the_pictures_own_samples(self):
        """A panel of one radiance L before black: each pixel is L times the panel's coverage for
        any filter and lens, because both are the same mean of the same samples."""
        panel = """format = 1
[[material]]
name = "panel"
emit = 10.0
[[object]]
name = "panel"
shape = "quad"
corners = [[-1, -0.8, 0], [1.1, -1, 0], [1, 0.9, 0], [-0.9, 1, 0]]
material = "panel"
[[camera]]
name = "A"
position = [0, 0, 4]
look_at = [0, 0, 0]
up = [0, 1, 0]
resolution = [30, 20]
focus = 2
aperture = 0.1
"""
        for shape, width in (("box", 1), ("gaussian", 3)):
            _, _, _, channels = self.render(
                panel, "--aov", "crypto_object", "--set", "quality.camera_samples=16", "--set", f"camera.A.filter={shape}", "--set", f"camera.A.filter_width={width}")
            partial = 0
            for luminance, coverage in zip(channels["R"], channels["CryptoObject00.G"]):
                self.assertAlmostEqual(luminance, coverage * 10 / math.pi, places=5)
                partial += 0 < coverage < 1
            self.assertGreater(partial, 40)

    def test_names_may_hold_anything(self):
        odd = 'm\u00e4d"chen \\\\ 1'  # TOML escapes quote and backslash once more
        toml = odd.replace('"', '\\"')
        header = self.render(program.BALL.replace('name = "ball"\n', f'name = "{toml}"\n', 1),
                             "--aov", "object,crypto_object")[0]
        name = odd.replace("\\\\", "\\")
        self.assertIn(name, manifest(header, "CryptoObject"))
        self.assertIn(name, json.loads(header["earthshine:objects"]))

    def test_positions_project_to_their_pixels_by_the_header(self):
        for size in ("32x24", "300x200"):
            header, width, height, channels = self.render(program.BALL, "--size", size, "--aov", "position,depth,range")
            k = [float(word) for word in header["earthshine:camera.K"].split()]
            pose = [float(word) for word in header["earthshine:camera.to_world"].split()]
            self.assertEqual((len(k), len(pose)), (9, 16))
            ndc, camera = header["worldToNDC"], header["worldToCamera"]
            seen = 0
            for pixel, z in enumerate(channels["Z"]):
                if math.isinf(z):
                    continue
                seen += 1
                place = [channels[f"P.{axis}"][pixel] for axis in "XYZ"]
                centre = (pixel % width + 0.5, pixel // width + 0.5)
                away = [place[i] - pose[4 * i + 3] for i in range(3)]
                x, y, depth = (sum(pose[4 * i + axis] * away[i] for i in range(3)) for axis in range(3))
                self.assertAlmostEqual(depth, z, delta=1e-5)
                self.assertAlmostEqual(math.dist(place, pose[3:12:4]), channels["range"][pixel], delta=1e-5)
                self.assertAlmostEqual(k[0] * x / depth + k[2], centre[0], delta=1e-4)
                self.assertAlmostEqual(k[4] * y / depth + k[5], centre[1], delta=1e-4)
                row = place + [1.0]
                u, v, _, w = (sum(row[i] * ndc[4 * i + j] for i in range(4)) for j in range(4))
                self.assertAlmostEqual(u / w * width, centre[0], delta=3e-4)  # the matrix is single
                                                                              # precision
                self.assertAlmostEqual(v / w * height, centre[1], delta=3e-4)
                self.assertAlmostEqual(sum(row[i] * camera[4 * i + 2] for i in range(4)), z, delta=1e-5)
            self.assertGreater(seen, width * height / 4)

    def test_screen_window_is_the_picture_at_distance_one(self):
        header = self.render(program.BALL)[0]
        self.assertAlmostEqual(header["screenWindowWidth"], 2 * math.tan(math.radians(20)) * 32 / 24, places=6)

    def test_lens_stands_in_the_standard_attributes(self):
        header = self.render(program.BALL, "--set", "camera.A.focus=4", "--set", "camera.A.aperture=0.1")[0]
        self.assertEqual(header["focus"], 4.0)
        self.assertNotIn("aperture", header)  # it would be an f-number, which fov_deg does not
                                              # define
        self.assertNotIn("focus", self.render(program.BALL)[0])

    def test_variance_is_that_of_the_mean(self):
        """Four times the samples of both kinds leave a quarter of the variance, over the picture."""
        def total(times):
            return sum(self.render(program.BALL, "--aov", "variance", "--set", "quality.denoise=false",
                                   "--set", f"quality.camera_samples={4 * times}",
                                   "--set", f"quality.gather_rays={16 * times}")[3]["variance"])
        few, many = total(1), total(4)
        self.assertGreater(many, 0)
        self.assertAlmostEqual(few / many, 4, delta=1.5)

    def test_names_stand_only_where_numbers_need_them(self):
        header, _, _, channels = self.render(program.BALL, "--aov", "depth")
        self.assertFalse([name for name in header if name.startswith("cryptomatte/") or name.endswith("objects")])
        self.assertEqual(set(channels), {"R", "G", "B", "Z"})

    def test_same_bytes_on_any_number_of_threads(self):
        layers = "normal,position,crypto_object,crypto_material,variance"
        self.render(program.BALL, "--aov", layers, "-j", "1")
        one = (self.folder / "out.exr").read_bytes()
        self.render(program.BALL, "--aov", layers, "-j", "2")
        self.assertEqual(one, (self.folder / "out.exr").read_bytes())

    def test_unknown_layer_names_those_there_are(self):
        self.write("scene.toml", program.BALL)
        self.says(self.refused("render", "scene.toml", "-o", "a.exr", "--aov", "crypto"), '"crypto"', "crypto_object")


if __name__ == "__main__":
    unittest.main()
