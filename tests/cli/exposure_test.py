# SPDX-License-Identifier: Apache-2.0
"""Brightness of PNGs: --exposure and --curve of render, and one white for all pictures of a study.
"""
import math
import unittest

import exr
import png
import tiny_bay
from program import CLOSED_BOX


def srgb(linear):
    linear = min(1.0, max(0.0, linear))
    curve = 12.92 * linear if linear <= 0.0031308 else 1.055 * linear ** (1 / 2.4) - 0.055
    return round(255 * curve)


class Render(tiny_bay.Case):
    def setUp(self):
        super().setUp()
        # M / (1 - rho) = 20 lm/m^2 from every wall: 20 / pi cd/m^2 everywhere.
        self.write("box.toml", CLOSED_BOX)

    def byte(self, *options):
        self.done("render", "box.toml", "-o", "a.exr", "--png", "a.png", "--quiet", *options)
        rgb = png.pixels((self.folder / "a.png").read_bytes())[3]
        self.assertLessEqual(max(rgb) - min(rgb), 2)  # noise
        return rgb[len(rgb) // 2]

    def test_white_by_luminance(self):
        level = 20 / math.pi
        self.assertAlmostEqual(self.byte("--exposure", "20cd/m2"), srgb(level / 20), delta=1)
        self.assertAlmostEqual(self.byte("--exposure", "40"), srgb(level / 40), delta=1)
        self.assertEqual(self.byte("--exposure", "5", "--curve", "clip"), 255)
        # Linear to 0.6 of white, then 1 - 0.4 exp(-(x - 0.6) / 0.4).
        x = level / 5
        self.assertAlmostEqual(self.byte("--exposure", "5"), srgb(1 - 0.4 * math.exp(-(x - 0.6) / 0.4)), delta=1)

    def test_white_by_exposure_value(self):
        # White of EV 4 at ISO 100 is 78 / 65 * 16 = 19.2 cd/m^2.
        self.assertAlmostEqual(self.byte("--exposure", "4EV"), srgb(20 / math.pi / 19.2), delta=1)

    def test_white_by_percentile(self):
        self.assertEqual(self.byte("--exposure", "auto:100", "--curve", "clip"), 255)
        self.assertAlmostEqual(self.byte("--exposure", "auto"), srgb(1 - 0.4 / math.e), delta=1)

    def test_own_is_what_is_done_without(self):
        self.assertEqual(self.byte("--exposure", "own"), self.byte())

    def test_what_is_refused(self):
        for text in ("bright", "12ev", "auto:0", "auto:101", "-3", "nan", "61EV", ""):
            run = self.refused("render", "box.toml", "-o", "a.exr", "--png", "a.png", "--exposure", text)
            self.assertIn("is not own, auto, auto:PERCENT", run)
        self.assertIn("not one of shoulder, clip",
                      self.refused("render", "box.toml", "-o", "a.exr", "--png", "a.png", "--exposure", "auto",
                                   "--curve", "soft"))
        self.assertIn("none is written", self.refused("render", "box.toml", "-o", "a.exr", "--exposure", "auto"))


class Probe(tiny_bay.Case):
    """Sources of the light at a pixel."""

    def setUp(self):
        super().setUp()
        self.write("box.toml", CLOSED_BOX)

    def test_half_of_a_furnace_is_its_own(self):
        # B = M / (1 - rho): of 20 lm/m^2 the wall emits 10. Of the 10 that it reflects, the other
        # walls emitted half and reflected half.
        report = self.json("render", "box.toml", "--probe", "12,8")
        pixel = report["pixel"]
        self.assertAlmostEqual(pixel["luminance_cd_m2"], 20 / math.pi, delta=0.02)
        self.assertAlmostEqual(sum(entry["share"] for entry in pixel["light_by"]), 1, places=5)
        shares = {(entry["from"], entry["reflected"]): entry["share"] for entry in pixel["light_from"]}
        self.assertEqual(set(shares), {("its own light", False), ("wall", False), ("room", True)})
        self.assertAlmostEqual(shares["its own light", False], 0.5, delta=0.005)
        self.assertAlmostEqual(shares["wall", False], 0.25, delta=0.005)
        self.assertAlmostEqual(shares["room", True], 0.25, delta=0.005)
        self.assertAlmostEqual(pixel["left_over"], 0, delta=0.015)
        said = self.done("render", "box.toml", "--probe", "12,8", "--quiet")
        self.assertIn("by way of room", said)
        self.assertIn("straight from its own light", said)

    def test_what_is_refused(self):
        self.assertIn("is not X,Y", self.refused("render", "box.toml", "--probe", "1"))
        self.says(self.refused("render", "box.toml", "--probe", "9999,0"), "--probe: 9999,0 lies outside", "0,0 to ")
        self.assertIn("--probe: belongs to one camera",
                      self.refused("render", "bay.toml", "--probe", "1,1", "--camera", "all"))
        self.assertIn("reads the radiosity solution",
                      self.refused("render", "box.toml", "--probe", "1,1", "--indirect", "none"))
        self.refused("render", "box.toml", "--probe", "1,1", "--only-pixel", "1,1")


class Study(tiny_bay.Case):
    CALL = ("study", "orbit", "bay.toml", "--at", "0,180", "--camera", "B")

    def check_pixel(self, figure, file, white):
        picture = exr.read(self.folder / "o" / figure["exr"])[3]
        width, _, _, rgb = png.pixels((self.folder / "o" / file).read_bytes())
        level = picture["G"]
        at = len(level) // 2 + width // 2
        colour = [picture[c][at] for c in "RGB"]
        y = 0.2126 * colour[0] + 0.7152 * colour[1] + 0.0722 * colour[2]
        x = y / white
        shown = x if x <= 0.6 else 1 - 0.4 * math.exp(-(x - 0.6) / 0.4)
        scaled = [shown * c / y for c in colour]
        most = max(1.0, *scaled)
        for k in range(3):
            self.assertAlmostEqual(rgb[3 * at + k], srgb(scaled[k] / most), delta=2)

    def test_all_pictures_may_have_one_white(self):
        study = self.printed(*self.CALL, "-o", "o", "--exposure", "auto")
        for result in study["results"]:
            if result["target"] != "box":
                continue
            shares = [*result["light_from"].values(), *result["light_by_way_of"].values()]
            # No highlights: direct and indirect light are all, up to the rays' noise.
            self.assertAlmostEqual(sum(shares), 1, delta=0.06)
        clean = [figure for figure in study["figures"] if figure["clean"]]
        white, = {figure["white_cd_m2"] for figure in clean}
        self.assertEqual(len(clean), 2)
        for figure in clean:
            self.assertNotIn("same_file", figure)
            self.check_pixel(figure, figure["file"], white)

    def test_each_has_its_own_and_a_common_one_at_the_button(self):
        study = self.printed(*self.CALL, "-o", "o")
        day, night = study["figures"]
        # Lamps of some 1000 cd stay as they are; the Sun's 130 000 lx go.
        self.assertGreater(day["white_cd_m2"], 5 * night["white_cd_m2"])
        self.assertEqual(day["same_white_cd_m2"], night["same_white_cd_m2"])
        for figure in (day, night):
            self.check_pixel(figure, figure["same_file"], figure["same_white_cd_m2"])
        page = (self.folder / "o" / "report.html").read_text(encoding="utf-8")
        for figure in (day, night):
            self.assertIn(f"EV {math.log2(figure['white_cd_m2'] / 1.2):.1f}, white at", page)
        again = self.json(*self.CALL, "-o", "o", "--exposure", "100cd/m2")
        self.assertEqual({figure["white_cd_m2"] for figure in again["figures"] if figure["clean"]}, {100.0})


class BlackBack(tiny_bay.Case):
    # A panel whose back faces camera B, with no light through it, in front of the floor.
    PANEL = """
[[object]]
name = "panel"
shape = "quad"
corners = [[-0.5, -0.5, 1], [-0.5, 0.5, 1], [0.5, 0.5, 1], [0.5, -0.5, 1]]
material = "paint"
target = true
"""

    def test_it_is_no_target(self):
        scene = (self.folder / "bay.toml").read_text(encoding="utf-8")
        (self.folder / "bay.toml").write_text(scene + self.PANEL,
                                              encoding="utf-8")
        study = self.printed("study", "orbit", "bay.toml", "--at", "0,180", "--camera", "B", "-o", "o")
        panel = [result for result in study["results"] if result["target"] == "panel"]
        self.assertEqual([result["black_back"] for result in panel], [1.0, 1.0])
        for result in panel:
            self.assertIn(result["verdict"], ("doubtful", "not-seen"))
            self.assertIn("black back seen (100 % of it)", result["why"])
            self.assertEqual(result["reasons"][0]["cause"], "black-back")
        note = "Camera B looks at the black back of panel (100 % of what it sees, in 2 of 2 results)"
        self.assertTrue(any(note in said for said in study["notes"]))
        self.assertIn(note, self.done("study", "orbit", "bay.toml", "--at", "0,180", "--camera", "B", "-o", "o"))
        self.assertIn(note, (self.folder / "o" / "report.html").read_text(encoding="utf-8"))
        two = scene + self.PANEL.replace('"paint"', '"sheet"') + """
[[material]]
name = "sheet"
diffuse = [0.3, 0.4, 0.5]
two_sided = true
"""
        (self.folder / "bay.toml").write_text(two, encoding="utf-8")
        study = self.printed("study", "orbit", "bay.toml", "--at", "0,180", "--camera", "B", "-o", "two")
        self.assertEqual({result["black_back"] for result in study["results"] if result["target"] == "panel"}, {0.0})
        self.assertFalse(any("black back" in said for said in study["notes"]))


if __name__ == "__main__":
    unittest.main()
