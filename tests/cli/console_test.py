# SPDX-License-Identifier: Apache-2.0
"""console: the page of a scene, and its layers against the EXR layers of `--layers`."""
import base64
import json
import re
import shutil
import struct
import unittest
import zlib

import exr
import program
import tiny_bay


def half_of_ordered(number):
    bits = number - 0x8000 if number >= 0x8000 else 0x8000 | (0x8000 - number)
    return struct.unpack("<e", struct.pack("<H", bits))[0]


def unpacked(data, columns, count, at):
    """Decodes a plane of numbers from its residuals (MED of ISO 14495-1), low bytes before high bytes."""
    plane = []
    for i in range(count):
        left = plane[i - 1] if i % columns else None
        above = plane[i - columns] if i >= columns else None
        if left is not None and above is not None:
            corner = plane[i - columns - 1]
            guess = min(left, above) if corner >= max(left, above) else max(left, above) if corner <= min(left, above) else left + above - corner
        else:
            guess = left if left is not None else above if above is not None else 0x8000
        folded = data[at + i] | data[at + count + i] << 8
        plane.append((guess + ((folded >> 1) ^ -(folded & 1))) & 0xffff)
    return plane


class Console(tiny_bay.Case):
    def page(self, path):
        """The data of a page, and the bytes of one of its elements."""
        html = (self.folder / path).read_text(encoding="utf-8")
        data = json.loads(re.search(r'id="data">(.*?)</script>', html, re.S).group(1))
        return html, data, lambda name: zlib.decompress(base64.b64decode(re.search(f'id="{name}">(.*?)</script>', html).group(1)))

    def test_layers_are_those_of_the_picture_to_a_half_float(self):
        self.done("console", "bay.toml", "--camera", "A", "--size", "16x12", "--error", "0.3", "--layers", "layers", "-o", "c.html", "-q")
        _, data, blob = self.page("c.html")
        layers = exr.read(self.folder / "layers" / "A.exr")[3]
        camera, count = data["cameras"][0], 16 * 12
        self.assertEqual([light["name"] for light in data["lights"] if light["kind"] == "lamp"], ["left", "right"])
        self.assertEqual(len(camera["layers"]), len(data["lights"]))
        for layer in camera["layers"]:
            name = data["lights"][layer["light"]]["name"]
            raw = blob(layer["data"])
            green = unpacked(raw, 16, count, 0)
            planes = {"G": green}
            for colour, at in (("R", 2), ("B", 4)):
                planes[colour] = [(d + g - 0x8000) & 0xffff for d, g in zip(unpacked(raw, 16, count, at * count), green)]
            largest = max(abs(v) for colour in "RGB" for v in layers[f"light_{name}.{colour}"])
            for colour, plane in planes.items():
                for number, value in zip(plane, layers[f"light_{name}.{colour}"]):
                    # Rounding to 11 bits: half a unit of the last place is 2^-12 to 2^-11 of the
                    # value. Below 2^-14 of the half's unit, 2^-28 of the largest, steps are
                    # uniform.
                    self.assertLessEqual(abs(half_of_ordered(number) * 2.0**layer["exponent"] - value), max(2**-11 * abs(value), 2**-38 * largest))

    def test_the_same_call_gives_the_same_page_and_draws_nothing_again(self):
        call = ("console", "bay.toml", "--size", "16x12", "--error", "0.3", "-q")
        self.done(*call, "-o", "c.html", "-j", "1")
        first = (self.folder / "c.html").read_bytes()
        stored = sorted((path, path.stat().st_mtime_ns) for path in (self.folder / "c.layers").rglob("*.exr"))
        self.done(*call, "-o", "c.html", "-j", "2")
        self.assertEqual(first, (self.folder / "c.html").read_bytes())
        self.assertEqual(stored, sorted((path, path.stat().st_mtime_ns) for path in (self.folder / "c.layers").rglob("*.exr")))

    def test_an_orbit_has_sun_and_earth_at_each_place(self):
        report = self.json("console", "bay.toml", "--camera", "B", "--size", "12x12", "--error", "0.3", "--positions", "4", "-o", "c.html")
        _, data, _ = self.page("c.html")
        self.assertEqual([place["position_deg"] for place in data["places"]], [0, 90, 180, 270])
        self.assertEqual([place["phase"] for place in data["places"]][::2], ["day", "eclipse"])
        lights = {light["name"]: k for k, light in enumerate(data["lights"])}
        suns = {layer["place"] for layer in data["cameras"][0]["layers"] if layer["light"] == lights["sun"]}
        self.assertIn(0, suns)
        self.assertNotIn(2, suns)  # in the Earth's shadow
        self.assertEqual({layer["place"] for layer in data["cameras"][0]["layers"] if layer["light"] == lights["left"]}, {None})
        self.assertEqual(report["bytes"], (self.folder / "c.html").stat().st_size)

    def test_a_study_gives_its_places_settings_and_verdicts(self):
        self.done("study", "run", "s.toml", "-o", "d", "-q")
        report = self.json("console", "d", "-o", "c.html")
        self.assertFalse((self.folder / "c.layers").exists())  # all light is the study's
        _, data, _ = self.page("c.html")
        study = self.study("d")
        self.assertEqual([place["position_deg"] for place in data["places"]], [0, 180])
        self.assertEqual([setting["name"] for setting in data["study"]["settings"]], ["on", "right alone"])
        names = [light["name"] for light in data["lights"]]
        alone = dict(zip(names, data["study"]["settings"][1]["factors"]))
        self.assertEqual((alone["left"] if "left" in alone else [0, 0, 0], alone["right"], alone["sun"]), ([0, 0, 0], [0.5] * 3, [1, 1, 1]))
        conditions = {entry["id"]: (entry["lamps"], entry["position_deg"]) for entry in study["conditions"]}
        for row in study["results"]:
            lamps, position = conditions[row["condition"]]
            number = 2 * ["on", "right alone"].index(lamps) + [0, 180].index(position)
            self.assertEqual(data["study"]["judged"][row["camera"]][row["target"]][number], [row["verdict"], row["why"]])
        self.assertEqual([camera["camera"] for camera in report["cameras"]], ["A", "B"])

    def test_a_study_without_its_light_is_drawn_again_and_a_changed_scene_is_refused(self):
        self.done("study", "visibility", "bay.toml", "--size", "16x12", "--error", "0.3", "-o", "d", "-q")
        shutil.rmtree(self.folder / "d" / "points")
        self.done("console", "d", "--camera", "A", "-o", "c.html", "-q")
        _, data, _ = self.page("c.html")
        self.assertEqual((data["cameras"][0]["columns"], data["cameras"][0]["rows"], len(data["cameras"])), (16, 12, 1))
        for option in (("--set", "quality.error=0.1"), ("--size", "8x8"), ("--positions", "4")):
            self.says(self.refused("console", "d", *option, "-o", "n.html"), option[0], "study")
        self.write("bay.toml", tiny_bay.BAY.replace("intensity = 500", "intensity = 501"))
        self.says(self.refused("console", "d", "-o", "n.html"), "bay.toml", "has changed since the study", "the lights")
        self.write("bay.toml", tiny_bay.BAY)
        self.done("console", "d", "-o", "same.html", "-q")
        fields = tiny_bay.BAY.replace("fov_deg = 40", "fov_deg = 41")
        self.assertNotEqual(fields, tiny_bay.BAY)
        self.write("bay.toml", fields)
        self.says(self.refused("console", "d", "-o", "n.html"), "has changed since the study", "camera A")
        results = self.folder / "d" / "study.json"
        results.write_text(re.sub(r'"seed": 1', '"seed": "one"', results.read_text(), count=1))
        self.says(self.refused("console", "d", "-o", "n.html"), "study.json", "seed")
        results.unlink()
        self.says(self.refused("console", "d", "-o", "n.html"), "study.json", "cannot be read")
        self.assertFalse((self.folder / "n.html").exists())

    def test_names_do_nothing_in_the_page(self):
        self.write("odd.toml", tiny_bay.BAY.replace('"left"', '"</script><script>window.owned = 1</script>"').replace('"tiny bay"', '"<img src=x onerror=alert(1)>"'))
        self.done("console", "odd.toml", "--camera", "A", "--size", "8x8", "--error", "0.5", "-o", "c.html", "-q")
        html, data, _ = self.page("c.html")
        self.assertNotIn("<img", html)
        self.assertEqual(len(re.findall(r"<script>", html)), 1)
        self.assertIn("</script><script>window.owned = 1</script>", [light["name"] for light in data["lights"]])
        self.assertIn("script-src 'sha256-", html)

    def test_wrong_calls(self):
        for call, words in ((("-o", "c.exr"), "ends in .html"), (("--layers", "d", "--positions", "4"), "--positions"), (("--camera", "Z"), "Z"),
                            (("--positions", "1"), "--positions"), (("-o", "bay.toml"), "bay.toml")):
            self.says(self.refused("console", "bay.toml", *call), words)
        self.assertFalse((self.folder / "console.html").exists())


if __name__ == "__main__":
    unittest.main()
