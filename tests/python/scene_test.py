# SPDX-License-Identifier: Apache-2.0
"""Scenes in Python: read, changed, solved; what stays warm, what is refused."""
import json
import tomllib
import unittest

import numpy as np

import earthshine
import program

# A box that the file places by a turn, a scale and a shift, lengths in centimetres.
PLACED = program.BALL.replace('unit = "m"', 'unit = "cm"').replace("[quality]", """[[object]]
name = "crate"
shape = "box"
min = [-10, -20, -30]
max = [10, 20, 30]
material = "paint"
translate = [100, 50, 80]
rotate = [10, 20, 30]
scale = 0.5

[quality]""")


class Scenes(program.Case):
    def load(self, text=program.BALL, **more):
        self.write("ball.toml", text)
        return earthshine.load(self.folder / "ball.toml", **more)

    def same_bytes(self, scene, frame, *arguments):
        """The frame's file and that of `render` with the scene's settings."""
        frame.save(self.folder / "python.exr")
        settings = [word for setting in scene.settings for word in ("--set", setting)]
        self.done("render", str(self.folder / "ball.toml"), *settings, *arguments, "-o", "program.exr", "-q")
        self.assertEqual((self.folder / "python.exr").read_bytes(), (self.folder / "program.exr").read_bytes())

    def test_the_same_bytes_as_the_program(self):
        scene = self.load(set={"camera.A.fov_deg": 35, "light.lamp.intensity": [700, 800, 900]})
        frame = scene.render("A", error=0.3, layers=["depth", "object"], per_light=True, seed=5)
        self.same_bytes(scene, frame, "--camera", "A", "--error", "0.3", "--aov", "depth,object", "--per-light", "--seed", "5")
        self.same_bytes(scene, scene.render("above", indirect="none"), "--camera", "above", "--indirect", "none")

    def test_a_new_camera_lamp_and_pose_give_the_bytes_of_a_cold_call(self):
        scene = self.load()
        scene.render("A", error=0.3)
        scene.cameras["A"].position = (2.5, -3, 2)
        self.same_bytes(scene, scene.render("A", error=0.3), "--camera", "A", "--error", "0.3")
        scene.sun.direction = [0.3, 0.2, 1]
        scene.lights["lamp"].intensity = 300
        self.same_bytes(scene, scene.render("A", error=0.3), "--camera", "A", "--error", "0.3")
        scene.objects["ball"].translate = (0.2, 0.1, 0)
        self.same_bytes(scene, scene.render("A", error=0.3), "--camera", "A", "--error", "0.3")

    def test_motion_gives_the_bytes_of_the_program(self):
        """Of a warm scene: a moving camera with a rolling shutter, then a moving body, drawn as a mean of instants that
        each solve for themselves."""
        scene = self.load()
        still = scene.render("A", error=0.3)
        camera, ball = scene.cameras["A"], scene.objects["ball"]
        camera.exposure_s, camera.line_s, camera.velocity = 0.5, 0.005, (0.4, 0, 0)
        moved = scene.render("A", error=0.3)
        self.same_bytes(scene, moved, "--camera", "A", "--error", "0.3")
        ball.velocity, ball.spin = (0, 0.3, 0), (0, 0, 30)
        both = scene.render("A", error=0.3, layers=["depth"])
        self.same_bytes(scene, both, "--camera", "A", "--error", "0.3", "--aov", "depth")
        for one, other in ((still, moved), (moved, both)):
            self.assertFalse(np.array_equal(one.rgb, other.rgb))
        # A given solution holds the light of one instant.
        with self.assertRaises(earthshine.Error) as refused:
            scene.render("A", error=0.5, solution=scene.solve(error=0.5))
        self.assertIn("solution", str(refused.exception))
        self.assertIn("moves during the exposure", str(refused.exception))

    def test_only_what_changes_is_computed(self):
        scene = self.load()
        self.assertEqual(scene.work, {"read": 1, "structured": 1, "solved": 0, "drawn": 0})
        scene.render("A", error=0.5)
        scene.render("above", error=0.5)
        scene.render("A", error=0.5, size=(20, 20), layers=["depth"])
        self.assertEqual(scene.work, {"read": 1, "structured": 1, "solved": 1, "drawn": 3})
        scene.cameras["A"].fov_deg = 30
        scene.render("A", error=0.5)
        self.assertEqual(scene.work, {"read": 2, "structured": 1, "solved": 1, "drawn": 4})
        scene.lights["lamp"].intensity = 10
        scene.render("A", error=0.5)
        self.assertEqual(scene.work, {"read": 3, "structured": 1, "solved": 2, "drawn": 5})
        scene.objects["ball"].translate = (0, 0, 0.5)
        scene.render("A", error=0.5)
        self.assertEqual(scene.work, {"read": 4, "structured": 2, "solved": 3, "drawn": 6})
        # Back to light that is still known.
        scene.objects["ball"].translate = (0, 0, 0)
        scene.render("A", error=0.5)
        self.assertEqual(scene.work, {"read": 5, "structured": 3, "solved": 3, "drawn": 7})

    def test_k_replaces_the_field_of_view(self):
        scene = self.load()
        k = np.array([[40, 0, 15], [0, 44, 13], [0, 0, 1]])
        scene.cameras["A"].K = k
        scene.cameras["A"].distortion = [-0.1, 0.01, 0, 0]
        self.assertTrue(np.allclose(scene.cameras["A"].K, k))
        frame = scene.render("A", error=0.5)
        self.assertTrue(np.allclose(frame.K, k))

    def test_values_are_those_in_force(self):
        scene = self.load(set=["camera.A.fov_deg=35", "material.paint.two_sided=true"])
        self.assertEqual(list(scene.cameras), ["A", "above"])
        self.assertEqual(list(scene.objects), ["floor", "ball"])
        self.assertEqual(scene.light_groups, ["sun", "lamp"])
        self.assertEqual(scene.cameras["A"].fov_deg, 35)
        self.assertEqual(scene.cameras["A"].filter, "box")  # a default
        self.assertIs(scene.materials["paint"].two_sided, True)
        np.testing.assert_array_equal(scene.lights["lamp"].intensity, [900, 800, 700])
        self.assertEqual(scene.sun.illuminance, 1000)
        self.assertTrue(scene.objects["ball"].target)
        with self.assertRaises(AttributeError):
            _ = scene.cameras["A"].colour
        with self.assertRaisesRegex(KeyError, "A, above"):
            _ = scene.cameras["B"]

    def test_a_pose_maps_the_mesh_to_the_scene(self):
        scene = self.load(PLACED)
        crate = scene.objects["crate"]
        corners = np.array([[x, y, z, 1] for x in (-0.1, 0.1) for y in (-0.2, 0.2) for z in (-0.3, 0.3)])
        turn = np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1]])
        poses = [crate.pose, np.eye(4), np.block([[0.3 * turn, np.array([[1.0], [2.0], [3.0]])], [np.zeros((1, 3)), 1.0]])]
        for pose in poses:
            crate.pose = pose
            np.testing.assert_allclose(crate.pose, pose, atol=1e-12)
            placed = (corners @ pose.T)[:, :3]
            np.testing.assert_allclose(crate.info["bounds_m"], [placed.min(0), placed.max(0)], atol=1e-9)
        for wrong in (np.diag([1, 1, -1, 1]), np.zeros((4, 4)), np.eye(3), [[1, 1, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]):
            with self.assertRaises(ValueError):
                crate.pose = wrong

    def test_a_camera_pose_comes_back(self):
        scene = self.load(PLACED)
        camera = scene.cameras["A"]
        pose = camera.to_world
        scene.cameras["above"].to_world = pose
        np.testing.assert_allclose(scene.cameras["above"].to_world, pose, atol=1e-12)
        scene.cameras["above"].to_world_gl = camera.to_world_gl
        np.testing.assert_allclose(scene.cameras["above"].to_world, pose, atol=1e-12)

    def test_what_is_refused_says_where_and_what(self):
        text = program.BALL.replace("fov_deg = 40", "fov_deg = 400")
        line = text[:text.index("fov_deg = 400")].count("\n") + 1
        with self.assertRaises(earthshine.Error) as refused:
            self.load(text)
        error = refused.exception
        self.assertEqual((error.file, error.line, error.column), (str(self.folder / "ball.toml"), line, 1))
        self.says(error.found, "fov_deg", "400")
        self.says(error.allowed, "below 180")
        self.assertEqual(error.blame, "input")
        scene = self.load()
        scene.cameras["A"].positon = (1, 2, 3)
        with self.assertRaises(earthshine.Error) as refused:
            scene.render("A")
        self.says(str(refused.exception), "positon", "position")
        self.assertEqual(scene.settings, [])  # the scene is as it was
        scene.render("A", error=0.5)
        for wrong in ({"error": 0}, {"error": 2}, {"size": (0.5, 3)}, {"layers": ["dept"]}, {"indirect": "rays"}, {"seed": -1}, {"crop": (1, 2)},
                      {"size": (0, 0)}, {"crop": (0, 0, 0, 0)}):
            with self.assertRaises(earthshine.Error, msg=wrong):
                scene.render("A", **wrong)

    def test_a_mapping_is_a_scene(self):
        tree = tomllib.loads(program.BALL)
        from_tree = earthshine.load_dict(tree).render("A", error=0.3)
        from_file = self.load().render("A", error=0.3)
        np.testing.assert_array_equal(from_tree.rgb, from_file.rgb)
        tree["camera"] = {one.pop("name"): one for one in tree["camera"]}
        self.assertEqual(list(earthshine.load_dict(tree).cameras), ["A", "above"])

    def test_a_solution_is_the_program_s(self):
        scene = self.load()
        solution = scene.solve(seed=3)
        solution.save(self.folder / "python.h5")
        self.done("solve", str(self.folder / "ball.toml"), "--seed", "3", "-o", "program.h5", "-q")
        self.assertEqual((self.folder / "python.h5").read_bytes(), (self.folder / "program.h5").read_bytes())
        patches = len(solution.area)
        self.assertEqual(solution.radiosity.shape, (patches, 2, 3))
        self.assertEqual(solution.centre.shape, (patches, 3))
        areas = np.bincount(solution.object, weights=solution.area)
        np.testing.assert_allclose(areas, [o.info["area_m2"] for o in scene.objects.values()], rtol=1e-12)
        frame = scene.render("A", seed=3, solution=solution)
        self.done("render", str(self.folder / "ball.toml"), "--camera", "A", "--seed", "3", "--solution", "program.h5", "-o", "a.exr", "-q")
        np.testing.assert_array_equal(frame["G"], earthshine.open_frame(self.folder / "a.exr")["G"])
        scene.lights["lamp"].intensity = 1
        with self.assertRaisesRegex(earthshine.Error, "another scene"):
            scene.render("A", solution=solution)

    def test_form_factors_and_plan_are_the_program_s(self):
        scene = self.load()
        found = scene.form_factors()
        told = self.json("form-factors", "ball.toml", "-q")
        self.assertEqual(found.objects, told["objects"])
        np.testing.assert_array_equal(found.F, told["F"])
        np.testing.assert_allclose(found.F.sum(1) + found.sky + found.black, 1, atol=1e-9)
        plan = scene.plan("A", error=0.2)
        rows = self.json("plan", "ball.toml", "--camera", "A", "--error", "0.2", "-q")["effects"]
        self.assertEqual([(row["effect"], row["runs"], row["why"]) for row in plan["effects"]],
                         [(row["effect"], row["runs"], row["why"]) for row in rows])

    def test_a_study_is_a_table(self):
        self.load()
        found = earthshine.visibility(self.folder / "ball.toml", self.folder / "out", size=(24, 24), error=0.3)
        self.done("study", "visibility", str(self.folder / "ball.toml"), "--size", "24x24", "--error", "0.3", "-o", "program", "-q")
        self.assertEqual((self.folder / "out" / "results.csv").read_text(), (self.folder / "program" / "results.csv").read_text())
        self.assertEqual(list(found.records.camera), ["A", "above"])
        self.assertEqual(found.records.target.tolist(), ["ball", "ball"])
        self.assertTrue((found.records.visible_fraction > 0).all())
        json.dumps(found.json)


if __name__ == "__main__":
    unittest.main()
