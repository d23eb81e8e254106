# SPDX-License-Identifier: Apache-2.0
"""render --over: the scene drawn over a photograph."""
import struct
import unittest
import zlib

import png
import program

FLAT = (60, 70, 80)


def chunk(kind, data):
    return struct.pack(">I4s", len(data), kind) + data + struct.pack(">I", zlib.crc32(kind + data))


def photograph(width, height, colour=FLAT):
    """A PNG file of one colour."""
    rows = (b"\0" + bytes(colour) * width) * height
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


class Over(program.Case):
    def setUp(self):
        super().setUp()
        self.write("ball.toml", program.BALL)
        self.write("photo.png", photograph(120, 90))

    def over(self, *options, name="over.png"):
        self.assertEqual(self.done("render", "ball.toml", "--over", "photo.png", "--png", name, *options), "")
        width, height, channels, data = png.pixels((self.folder / name).read_bytes())
        self.assertEqual((width, height, channels), (120, 90, 3))
        return [tuple(data[k:k + 3]) for k in range(0, len(data), 3)]

    def test_wire_draws_the_edges_and_leaves_the_rest(self):
        pixels = self.over()
        kept = sum(p == FLAT for p in pixels)
        lines = sum(p[1] > 150 and p[0] < 40 for p in pixels)  # green
        self.assertGreater(kept, 0.6 * len(pixels))
        self.assertGreater(lines, 100)
        self.assertEqual([p.name for p in self.folder.iterdir() if p.suffix == ".exr"], [])

    def test_the_outline_of_the_ball_is_where_its_picture_is(self):
        # The ball of radius 0.5 at distance sqrt(9 + 9 + 1.3^2) = 4.44 m is a disc of about 0.5 /
        # 4.44 x 45 / tan(20 deg) = 13.9 px. The camera looks 0.3 m below its centre, which is 0.3
        # cos(elevation) / 4.5 x 123.6 = 7.9 px up.
        before = self.over("--set", "object.floor.translate=[0,0,-100]")
        found = [(k % 120 + 0.5, k // 120 + 0.5) for k, p in enumerate(before) if p[1] > 150 and p[0] < 40]
        self.assertGreater(len(found), 20)
        low_x, high_x = min(x for x, _ in found), max(x for x, _ in found)
        low_y, high_y = min(y for _, y in found), max(y for _, y in found)
        self.assertAlmostEqual((low_x + high_x) / 2, 60, delta=1)
        self.assertAlmostEqual((low_y + high_y) / 2, 45 - 7.9, delta=1.5)
        self.assertAlmostEqual((high_x - low_x) / 2, 13.9, delta=1.5)

    def test_lines_follow_the_camera(self):
        self.assertNotEqual(self.over(), self.over("--set", "camera.A.fov_deg=30"))
        self.assertNotEqual(self.over(), self.over("--camera", "above"))

    def test_blend_is_the_mean_of_photograph_and_picture(self):
        self.done("render", "ball.toml", "-o", "a.exr", "--png", "a.png", "--size", "120x90")
        picture = png.pixels((self.folder / "a.png").read_bytes())[3]
        blended = self.over("--over-style", "blend", "--over-alpha", "0.25")
        for k, pixel in enumerate(blended):
            for c in range(3):
                self.assertAlmostEqual(pixel[c], 0.75 * FLAT[c] + 0.25 * picture[3 * k + c], delta=0.51)

    def test_both_and_the_other_files(self):
        pixels = self.over("--over-style", "both", "-o", "a.exr", "--cctv", "c.png")
        self.assertGreater(sum(p[1] > 150 and p[0] < 40 for p in pixels), 100)
        self.done("render", "ball.toml", "-o", "b.exr", "--size", "120x90")
        self.assertTrue((self.folder / "c.png").exists())
        self.assertEqual((self.folder / "a.exr").read_bytes(), (self.folder / "b.exr").read_bytes())

    def test_same_bytes_on_any_number_of_threads(self):
        self.over("-j", "1", name="one.png")
        self.over("-j", "2", name="two.png")
        self.assertEqual((self.folder / "one.png").read_bytes(), (self.folder / "two.png").read_bytes())

    def test_another_aspect_is_said(self):
        self.write("wide.png", photograph(160, 90))
        run = self.run_program("render", "ball.toml", "--over", "wide.png", "--png", "o.png")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.says(run.stderr, "160 x 90", "32 x 24", "fov_deg = 40", "camera.A.fov_deg")
        self.assertEqual(self.run_program("render", "ball.toml", "--over", "photo.png", "--png", "o.png", "--camera", "A").stderr, "")

    def test_calls_that_do_not_go_together(self):
        over = ("render", "ball.toml", "--over", "photo.png")
        self.says(self.refused(*over), "--png")
        self.says(self.refused(*over, "-o", "a.exr"), "--png")
        self.says(self.refused(*over, "--png", "o.png", "--size", "10x10"), "--size", "photograph")
        self.says(self.refused(*over, "--png", "o.png", "--camera", "all"), "one camera")
        self.says(self.refused(*over, "--png", "o.png", "--crop", "0,0,4x4"), "--crop")
        self.says(self.refused(*over, "--png", "photo.png"), "photo.png", "overwritten")
        self.says(self.refused(*over, "--png", "o.png", "--json"), "--json", "-o")
        self.says(self.refused(*over, "--png", "o.png", "--over-style", "lines"), "wire, blend, both")
        for alpha in ("1.5", "-0.1", "nan", "half", ""):
            self.says(self.refused(*over, "--png", "o.png", "--over-alpha", alpha), "0 to 1")
        self.says(self.refused("render", "ball.toml", "-o", "a.exr", "--over-style", "wire"), "--over PHOTO.png")
        self.says(self.refused("render", "ball.toml", "--png", "a.png"), "--output")

    def test_broken_photographs(self):
        whole = photograph(120, 90)
        for name, data, words in (("cut.png", whole[:-30], "broken PNG"), ("bits.png", whole[:60] + b"x" + whole[61:], "broken PNG"),
                                  ("photo.jpg", b"\xff\xd8\xff\xe0 JFIF", "not a PNG file"), ("empty.png", b"", "not a PNG file"),
                                  ("wide.png", photograph(20000, 1), "16384")):
            self.write(name, data)
            self.says(self.refused("render", "ball.toml", "--over", name, "--png", "o.png"), name, words)
        self.says(self.refused("render", "ball.toml", "--over", "none.png", "--png", "o.png"), "none.png")
        self.assertFalse((self.folder / "o.png").exists())


if __name__ == "__main__":
    unittest.main()
