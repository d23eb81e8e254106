# SPDX-License-Identifier: Apache-2.0
"""degrade on EXR files of all kinds: a result, or one clear error."""
import json
import math
import struct
import time
import unittest

import exr
import program

# CIE XYZ as primaries, as in programs that write X, Y and Z to R, G and B.
XYZ = struct.pack("<8f", 1, 0, 0, 1, 0, 0, 1 / 3, 1 / 3)


class DegradeInputs(program.Case):
    def answer(self, data, *options):
        self.write("in.exr", data)
        return self.json("degrade", "in.exr", "-o", "out.png", "--preset", "ideal", *options)

    def error(self, data, *parts):
        self.write("in.exr", data)
        message = self.refused("degrade", "in.exr", "-o", "out.png", "--preset", "ideal")
        self.assertEqual(len(message.splitlines()), 1, message)
        self.says(message, "in.exr", *parts)
        self.assertFalse((self.folder / "out.png").exists())

    def metered(self, *arguments, **more):
        return self.answer(exr.pack(*arguments, **more))["metered_cd_m2"]

    def test_channels_by_other_names(self):
        """Grey of 7 cd/m2 is 7 cd/m2 under any channel name, and a colour has its Rec. 709
        luminance."""
        green = 0.7152 * 5
        for channels, wanted in (({"Y": 7}, 7), ({"luminance": 7}, 7), ({"L": 7}, 7), ({"beauty.Y": 7}, 7),
                                 ({"R": 0, "G": 5, "B": 0}, green), ({"r": 0, "g": 5, "b": 0}, green),
                                 ({"rgba.red": 0, "rgba.green": 5, "rgba.blue": 0}, green),
                                 ({"V.Combined.R": 0, "V.Combined.G": 5, "V.Combined.B": 0,
                                   "V.Diff.R": 9, "V.Diff.G": 9, "V.Diff.B": 9}, green),
                                 ({"R": 0, "G": 5, "B": 0, "A": 0.5, "Z": math.inf, "id": 3}, green),
                                 ({"X": 4, "Y": 7, "Z": 2}, 7)):
            self.assertAlmostEqual(self.metered(8, 6, channels), wanted, delta=wanted * 1e-4, msg=channels)

    def test_alpha_is_in_the_colour_already(self):
        """OpenEXR's colours are premultiplied: a pixel of half coverage has half the light."""
        self.assertAlmostEqual(self.metered(8, 6, {"R": 2, "G": 2, "B": 2, "A": 0.25}), 2, delta=1e-4)

    def test_other_primaries(self):
        """If R, G, B contain X, Y, Z, the second one is the luminance."""
        chromaticities = [("chromaticities", "chromaticities", XYZ)]
        value = self.metered(8, 6, {"R": 4, "G": 7, "B": 2}, more=chromaticities)
        self.assertAlmostEqual(value, 7, delta=1e-3)

    def test_number_types_and_white_luminance(self):
        for kind in ("half", "float", "uint"):
            self.assertAlmostEqual(self.metered(5, 4, {"Y": 3}, kind=kind), 3, delta=1e-4, msg=kind)
        white = [("whiteLuminance", "float", struct.pack("<f", 250))]
        self.assertAlmostEqual(self.metered(5, 4, {"Y": 0.5}, more=white), 125, delta=1e-2)

    def test_windows(self):
        """The picture is the intersection of data and display window; overscan is not metered."""
        for corner in ((-70, 5), (0, 0), (12, -300)):
            self.assertAlmostEqual(self.metered(5, 4, {"Y": 3}, corner=corner), 3, delta=1e-4)
        frame = [9 if x in (0, 7) or y in (0, 5) else 2 for y in range(6) for x in range(8)]
        report = self.answer(exr.pack(8, 6, {"Y": frame}, corner=(-1, -1), display=(0, 0, 5, 3)))
        self.assertAlmostEqual(report["metered_cd_m2"], 2, delta=1e-4)
        self.assertEqual((report["picture"]["columns"], report["picture"]["rows"]), (6, 4))
        self.assertNotIn("crop_of", report["picture"])
        # 2 cd/m2 in the display window (0, 0) to (9, 5), 90 in the overscan; x0, x1, y0, y1 of the
        # data window.
        for x0, x1, y0, y1 in ((-4, 13, 0, 5), (0, 9, -3, 8), (-1, 9, 0, 5), (-4, 13, -3, 4), (-4, 5, 0, 5), (3, 20, 2, 9)):
            light = [2 if 0 <= x <= 9 and 0 <= y <= 5 else 90 for y in range(y0, y1 + 1) for x in range(x0, x1 + 1)]
            data = exr.pack(x1 - x0 + 1, y1 - y0 + 1, {"Y": light}, corner=(x0, y0), display=(0, 0, 9, 5))
            report = self.answer(data)
            self.assertAlmostEqual(report["metered_cd_m2"], 2, delta=1e-4, msg=(x0, x1, y0, y1))
            left, top, right, bottom = max(x0, 0), max(y0, 0), min(x1, 9), min(y1, 5)
            picture = report["picture"]
            self.assertEqual((picture["columns"], picture["rows"]), (right - left + 1, bottom - top + 1))
            whole = (left, top, right, bottom) == (0, 0, 9, 5)
            self.assertEqual(picture.get("crop_of"), None if whole else {"columns": 10, "rows": 6, "x": left, "y": top})

    def test_a_crop_says_so(self):
        data = exr.pack(8, 6, {"Y": 3}, corner=(20, 10), display=(0, 0, 99, 49))
        crop = self.answer(data)["picture"]["crop_of"]
        self.assertEqual(crop, {"columns": 100, "rows": 50, "x": 20, "y": 10})
        run = self.run_program("degrade", "in.exr", "-o", "out.png", "--preset", "ideal")
        self.says(run.stderr, "in.exr is a crop", "only this part")

    def test_pictures_of_a_sequence_have_windows_of_their_own(self):
        self.write("a.exr", exr.pack(8, 6, {"Y": 3}))
        self.write("b.exr", exr.pack(8, 6, {"Y": 3}, display=(0, 0, 9, 9)))
        run = self.run_program("degrade", "a.exr", "b.exr", "-o", "o#.png", "--preset", "ideal", "--json")
        self.says(run.stderr, "b.exr is a crop")
        frames = json.loads(run.stdout)["frames"]
        self.assertNotIn("crop_of", frames[0]["picture"])
        self.assertEqual(frames[1]["picture"]["crop_of"], {"columns": 10, "rows": 10, "x": 0, "y": 0})

    def test_sizes(self):
        for width, height, sensor in ((1, 1, [300, 300]), (1, 700, [1, 300]), (700, 1, [400, 1]), (3, 4, [225, 300])):
            report = self.answer(exr.pack(width, height, {"Y": 3}))
            self.assertEqual(report["sensor"], sensor)
            self.assertAlmostEqual(report["metered_cd_m2"], 3, delta=1e-4)

    def test_a_large_picture_is_read_in_strips(self):
        """20 000 x 20 000 is 1.6 GB per channel, but needs little memory if averaged while it is
        read. Here 20 000 x 900."""
        ramp = [float(x) for x in range(20000)] * 900
        report = self.answer(exr.pack(20000, 900, {"Y": ramp}, kind="half"))
        self.assertTrue(report["picture"]["read_in_strips"])
        self.assertEqual(report["sensor"], [400, 18])
        # The peak iris meters the 99.5 % quantile of the averages: of 400 columns of 50, the third
        # from the right.
        self.assertAlmostEqual(report["metered_cd_m2"], 20000 - 2.5 * 50, delta=60)

    def test_claims_without_pixels_are_refused_at_once(self):
        start = time.monotonic()
        self.error(exr.pack(100000, 100000, {"Y": 0}, pixels=False), "100000 x 100000", "65536")
        self.error(exr.pack(60000, 60000, {"Y": 0}, pixels=False), "60000 x 60000", "1073741824")
        self.error(exr.pack(20000, 20000, {"Y": 0}, pixels=False), "incomplete")
        self.error(exr.pack(2000000000, 3, {"Y": 0}, pixels=False), "image header")
        self.assertLess(time.monotonic() - start, 10)

    def test_values_that_are_no_light(self):
        for value, word in ((math.nan, "not a number"), (math.inf, "infinite"), (-math.inf, "infinite")):
            values = [1.0] * 48
            values[2 * 8 + 3] = value
            self.error(exr.pack(8, 6, {"R": 1, "G": values, "B": 1}), "pixel (3, 2)", '"G"', word)
            self.error(exr.pack(8, 6, {"Y": values}, kind="half"), "pixel (3, 2)", '"Y"', word)
        values = [1.0] * 46 + [-2.0, -0.0]
        self.assertEqual(self.answer(exr.pack(8, 6, {"Y": values}))["negative_pixels"], 1)

    def test_pictures_that_cannot_be_read(self):
        self.error(exr.pack(4, 4, {"N.X": 1, "Depth": 2}), '"Depth", "N.X"', "R, G and B, or Y")
        self.error(exr.pack(4, 4, {"a.R": 1, "a.G": 1, "a.B": 1, "b.R": 1, "b.G": 1, "b.B": 1}), '"a", "b"', "layers")
        self.error(exr.pack(4, 4, {"R": 1, "G": 1}), '"G", "R"')
        self.error(exr.pack(4, 4, {"Z": 1}), '"Z"')
        self.error(exr.pack(5, 4, {"Y": 3}, corner=(10, 0), display=(0, 0, 9, 5)), "outside of the picture", "(10, 0) to (14, 3)")
        self.error(exr.pack(4, 4, {"Y": 1, "RY": 1, "BY": 1}), "chroma", '"RY"')
        self.error(exr.pack(4, 4, {"Y": 1}, sampling=2, pixels=False), "reduced resolution")
        wide = [("pixelAspectRatio", "float", struct.pack("<f", 2))]
        self.error(exr.pack(4, 4, {"Y": 1}, more=wide), "square")
        dark = [("whiteLuminance", "float", struct.pack("<f", 0))]
        self.error(exr.pack(4, 4, {"Y": 1}, more=dark), "whiteLuminance")
        self.error(b"", "OpenEXR")
        self.error(b"no picture at all", "OpenEXR")
        whole = exr.pack(4, 4, {"Y": 1})
        for size in range(0, len(whole), 37):
            self.error(whole[:size], "in.exr")


if __name__ == "__main__":
    unittest.main()
