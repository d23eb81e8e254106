# SPDX-License-Identifier: Apache-2.0
"""Invalid cameras are refused with their position; pixel filters."""
import json
import unittest

import exr
import program

ROOM = program.CLOSED_BOX
CAMERA_LINE = ROOM[:ROOM.index("position")].count("\n") + 1


class Cameras(program.Case):
    def broken(self, old, new, *parts, scene=ROOM):
        self.assertIn(old, scene)
        self.write("scene.toml", scene.replace(old, new, 1))
        message = self.refused("render", "scene.toml", "-o", "a.exr", "-q")
        self.assertEqual(len(message.splitlines()), 1, message)
        self.says(message, *parts)

    def test_field_of_view(self):
        for value in ("0", "180", "-10", "nan", "inf", "361", '"wide"'):
            self.broken("fov_deg = 60", f"fov_deg = {value}", f"scene.toml:{CAMERA_LINE + 3}:1", "fov_deg")

    def test_look_at_is_the_position(self):
        where = f"scene.toml:{CAMERA_LINE + 1}:1"
        self.broken("look_at = [2, 2, 1.5]", "look_at = [0.4, 0.5, 0.6]", where, "own position")
        # A thousandth of a millimetre at 100 km is only rounding.
        self.broken("position = [0.4, 0.5, 0.6]\nlook_at = [2, 2, 1.5]",
                    "position = [100000, 0, 0]\nlook_at = [100000.000001, 0, 0]", where, "own position")

    def test_up_along_the_view(self):
        for look_at in ("[0.4, 0.5, 2]", "[0.4, 0.5, -7]", "[0.4, 0.5000001, 2]"):
            self.broken("look_at = [2, 2, 1.5]", f"look_at = {look_at}", f"scene.toml:{CAMERA_LINE + 2}:1", "parallel to up")
        self.broken("up = [0, 0, 1]", "up = [0, 0, 0]", f"scene.toml:{CAMERA_LINE + 2}:1", "no length")

    def test_resolution(self):
        for value in ("[0, 16]", "[24, -1]", "[24]", "[16385, 16]", "[24, 1e9]", "[2.5, 16]", "24", "[1000000000000000000000, 1]"):
            self.broken("resolution = [24, 16]", f"resolution = {value}", f"scene.toml:{CAMERA_LINE + 4}:")

    def test_size_option(self):
        self.write("scene.toml", ROOM)
        for size in ("0x10", "10x", "x10", "10", "-4x4", "10x10x10", "1e3x10", "99999x10", "10 x 10", ""):
            self.says(self.refused("render", "scene.toml", "-o", "a.exr", "--size", size), "--size", "COLUMNSxROWS")

    def test_focus_and_aperture_go_together(self):
        for line, word in (("focus = 2", "aperture"), ("aperture = 0.1", "focus"), ("focus = 0\naperture = 0.1", "above 0"),
                           ("focus = 2\naperture = -1", "aperture"), ("focus = nan\naperture = 1", "focus")):
            self.broken("fov_deg = 60", line, f"scene.toml:{CAMERA_LINE + 3}" if word != "aperture" else "scene.toml:", word)

    def test_camera_inside_a_body(self):
        self.broken("inward = true\n", "", f"scene.toml:{CAMERA_LINE - 1}:1", 'camera "inside"', '"room"', "inward = true")
        ball = program.BALL.replace("position = [3, -3, 2]", "position = [0.1, 0, 0.8]")
        self.write("ball.toml", ball)
        self.says(self.refused("render", "ball.toml", "-o", "a.exr", "-q"), 'camera "A"', '"ball"', "two_sided")
        self.done("render", "ball.toml", "-o", "a.exr", "-q", "--camera", "above")
        self.done("render", "ball.toml", "-o", "a.exr", "-q", "--set", "material.paint.two_sided=true")
        self.write("scene.toml", ROOM)
        self.done("render", "scene.toml", "-o", "a.exr", "-q")

    def test_of_several_cameras_those_inside_a_body_are_skipped(self):
        """Exit code 3: the others are drawn."""
        self.write("ball.toml", program.BALL.replace("position = [3, -3, 2]", "position = [0.1, 0, 0.8]"))
        run = self.run_program("render", "ball.toml", "--camera", "all", "-o", "a.exr", "--size", "16x16", "--json")
        self.assertEqual(run.returncode, 3, run.stderr)
        self.assertEqual([report["camera"] for report in json.loads(run.stdout)], ["above"])
        self.says(run.stderr, "skipped: ", 'camera "A"', '"ball"', "cameras inside a body were skipped: A")
        self.assertFalse((self.folder / "a-A.exr").exists())
        self.done("render", "ball.toml", "--camera", "above", "-o", "b.exr", "--size", "16x16")
        self.assertEqual(exr.read(self.folder / "a-above.exr")[3], exr.read(self.folder / "b.exr")[3])
        self.says(self.refused("render", "ball.toml", "--camera", "A", "-o", "c.exr"), 'camera "A"')  # no other

    def test_a_study_skips_cameras_inside_a_body(self):
        self.write("ball.toml", program.BALL.replace("position = [3, -3, 2]", "position = [0.1, 0, 0.8]"))
        run = self.run_program("study", "visibility", "ball.toml", "-o", "v", "--size", "16x16", "--json")
        self.assertEqual(run.returncode, 3, run.stderr)
        self.says(run.stderr, "cameras inside a body were skipped: A")
        study = json.loads(run.stdout)
        self.says(json.dumps(study), "is inside a body and was skipped")
        self.assertEqual([camera["name"] for camera in study["cameras"]], ["above"])

    def test_overrides_have_their_place_too(self):
        self.write("scene.toml", ROOM)
        self.says(self.refused("render", "scene.toml", "-o", "a.exr", "--set", "camera.inside.fov_deg=180"), "fov_deg", "below 180")


class Filters(program.Case):
    def render(self, *settings):
        self.write("ball.toml", program.BALL)
        options = [part for setting in settings for part in ("--set", setting)]
        self.done("render", "ball.toml", "-o", "a.exr", "-q", *options)
        header, _, _, channels = exr.read(self.folder / "a.exr")
        return header, channels

    def test_box_is_the_default_and_others_differ(self):
        header, box = self.render()
        self.assertEqual(header["earthshine:camera.filter"], "box")
        self.assertEqual(self.render("camera.A.filter=box", "camera.A.filter_width=1")[1], box)
        for name, width in (("triangle", 2), ("gaussian", 3), ("blackman-harris", 4)):
            header, other = self.render(f"camera.A.filter={name}")
            self.assertEqual(header["earthshine:camera.filter"], name)
            self.assertAlmostEqual(header["earthshine:camera.filter_width_px"], width)
            self.assertNotEqual(other["G"], box["G"])
            # The light of the whole picture is unchanged.
            self.assertAlmostEqual(sum(other["G"]) / sum(box["G"]), 1, delta=0.05)

    def test_broken_filters(self):
        self.write("ball.toml", program.BALL)
        for setting, words in (("filter=sinc", "gaussian"), ("filter=gausian", '"gaussian"'), ("filter=3", "filter"),
                               ("filter_width=0", "above 0"), ("filter_width=17", "16"), ("filter_width=nan", "filter_width")):
            self.says(self.refused("inspect", "ball.toml", "--set", f"camera.A.{setting}"), words)


if __name__ == "__main__":
    unittest.main()
