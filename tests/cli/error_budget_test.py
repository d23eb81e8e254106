# SPDX-License-Identifier: Apache-2.0
"""The error budget of render and solve: JSON, EXR header, effects that are not captured."""
import json
import math
import unittest

import exr
import program

PARTS = ["camera_samples", "gather_noise", "interreflection", "lobes"]
SURFACE_PARTS = ["form_factor_noise", "lamp_sampling", "patch_size", "solver_residual"]
MIRROR = program.BALL.replace('diffuse = [0.3, 0.4, 0.5]', 'diffuse = [0.3, 0.4, 0.5]\nmirror = 0.5').replace(
    "specular = 0.3\nshininess = 20\n", "")
GLASS = MIRROR.replace("mirror = 0.5", "transmit = 0.5\nior = 1.5")
PLAIN = program.BALL.replace("specular = 0.3\nshininess = 20\n", "")
DARK = program.BALL.replace("[900, 800, 700]", "0").replace("illuminance = 1000", "illuminance = 0")


class ErrorBudget(program.Case):
    def setUp(self):
        super().setUp()
        self.write("ball.toml", program.BALL)

    def render(self, *options, scene="ball.toml", camera="A"):
        return self.json("render", scene, "-o", "a.exr", "-q", "--camera", camera, *options)

    def check(self, error, parts=tuple(PARTS)):
        """Every part is at least 0 and has a bound at least as large; the squares add up to the
        whole."""
        self.assertEqual(sorted(error["parts"]), sorted(parts))
        for of in (error, *error["parts"].values()):
            self.assertTrue(0.0 <= of["estimate"] <= of["bound_95"] < math.inf, error)
        for key in ("estimate", "bound_95"):
            total = math.hypot(*(part[key] for part in error["parts"].values()))
            self.assertAlmostEqual(error[key], total, delta=1e-9 * total)
        self.assertGreater(error["estimate"], 0.0)
        return error

    def test_a_picture_states_its_error(self):
        error = self.check(self.render("--set", "quality.patch_edge=0.25")["error"])
        self.assertEqual(sorted(error), ["bound_95", "estimate", "limit", "not_captured", "parts", "seconds_to_go", "steps", "targets",
                                         "wanted"])
        self.assertIsNone(error["wanted"])
        self.assertLess(error["estimate"], 0.5)
        for part in PARTS:
            self.assertGreater(error["parts"][part]["estimate"], 0.0, part)
        target, = error["targets"]
        self.assertEqual(sorted(target), ["bound_95", "estimate", "luminance_cd_m2", "name", "pixels"])
        self.assertEqual(target["name"], "ball")
        self.assertGreater(target["pixels"], 10)
        self.assertGreater(target["luminance_cd_m2"], 0.0)
        self.assertTrue(0.0 < target["estimate"] <= target["bound_95"])
        header = exr.read(self.folder / "a.exr")[0]
        stated = {name.removeprefix("earthshine:error."): value for name, value in header.items()
                  if name.startswith("earthshine:error.")}
        self.assertEqual(sorted(stated), sorted([*PARTS, "estimate", "bound_95", "not_captured"]))
        for name in PARTS:
            self.assertAlmostEqual(stated[name], error["parts"][name]["estimate"], delta=1e-6)
        self.assertAlmostEqual(stated["estimate"], error["estimate"], delta=1e-6)
        self.assertAlmostEqual(stated["bound_95"], error["bound_95"], delta=1e-6)
        self.assertEqual(stated["not_captured"], "; ".join(error["not_captured"]))

    def test_the_error_is_told_line_by_line(self):
        said = self.run_program("render", "ball.toml", "-o", "a.exr", "--camera", "A", "--error", "0.2").stderr
        self.assertNotIn("\\x0a", said)
        self.assertTrue(any(line.startswith("  error ") for line in said.splitlines()), said)
        self.assertTrue(any(line.startswith("  picture: ") for line in said.splitlines()), said)

    def test_none_is_stated_where_none_is_wanted(self):
        run = self.run_program("render", "ball.toml", "-o", "a.exr", "--no-error", "--set", "quality.error=0.05", "--json")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertNotIn("95 % sure", run.stderr)
        error = json.loads(run.stdout)["error"]
        self.assertEqual((error["estimate"], error["bound_95"], error["wanted"], error["targets"]), (None, None, None, []))
        self.assertEqual(error["not_captured"], self.render()["error"]["not_captured"])

    def test_a_target_is_judged_by_its_own_pixels(self):
        self.write("two.toml", program.BALL.replace(
            'material = "floor"\n\n[[object]]\nname = "ball"', 'material = "floor"\ntarget = true\n\n[[object]]\nname = "ball"'))
        error = self.render(scene="two.toml")["error"]
        self.assertEqual([target["name"] for target in error["targets"]], ["floor", "ball"])
        channels = self.render("--aov", "object", scene="two.toml") and exr.read(self.folder / "a.exr")[3]
        for number, target in enumerate(error["targets"]):
            mine = [k for k, index in enumerate(channels["object"]) if index == number]
            self.assertEqual(target["pixels"], len(mine))
            mean = sum(0.2126 * channels["R"][k] + 0.7152 * channels["G"][k] + 0.0722 * channels["B"][k]
                       for k in mine) / len(mine)
            self.assertAlmostEqual(target["luminance_cd_m2"] / mean, 1.0, places=3)
        away = self.json("render", "ball.toml", "-o", "a.exr", "-q", "--camera", "A", "--crop", "0,0,2x2")["error"]
        self.assertEqual(away["targets"], [{"name": "ball", "pixels": 0, "luminance_cd_m2": None, "estimate": None,
                                            "bound_95": None}])

    def test_a_solve_states_its_error(self):
        error = self.check(self.json("solve", "ball.toml")["error"], SURFACE_PARTS)
        self.assertEqual(sorted(error), ["bound_95", "estimate", "limit", "not_captured", "parts", "seconds_to_go", "steps",
                                         "unweighted", "wanted"])
        self.says(self.done("solve", "ball.toml"), "error ", "95 % sure below", "patches", "unweighted")
        self.done("solve", "ball.toml", "-o", "ball.h5")
        self.assertEqual(self.json("solve", "ball.toml", "--solution", "ball.h5")["error"], error)

    def test_the_same_on_any_number_of_threads_and_from_a_file(self):
        self.done("solve", "ball.toml", "-o", "ball.h5")
        errors, pictures = [], []
        for options in (["-j", 1], ["-j", 2], ["--solution", "ball.h5"]):
            errors.append(self.render(*options)["error"])
            pictures.append((self.folder / "a.exr").read_bytes())
        self.assertEqual(errors[0], errors[1])
        self.assertEqual(errors[0], errors[2])
        self.assertEqual(pictures[0], pictures[1])
        self.assertEqual(pictures[0], pictures[2])

    def test_refined_patches_from_a_file_are_judged_alike(self):
        refined = ["--set", "quality.refine=true", "--set", "quality.max_patches=600"]
        self.done("solve", "ball.toml", "-o", "ball.h5", *refined)
        self.assertEqual(self.render("--solution", "ball.h5", *refined)["error"], self.render(*refined)["error"])

    def test_every_way_to_draw(self):
        for options in (["--crop", "8,6,12x10"], ["--time-limit", "0.2"], ["--per-light"],
                        ["--set", "quality.denoise=false"], ["--set", "quality.refine=true"]):
            self.check(self.render(*options)["error"])
        pixel = self.json("render", "ball.toml", "-q", "--camera", "A", "--only-pixel", "16,12")
        self.check(pixel["error"])
        both = self.render(camera="all")
        self.assertEqual([report["camera"] for report in both], ["A", "above"])
        for report in both:
            self.check(report["error"])
        self.assertNotEqual(both[0]["error"], both[1]["error"])
        self.assertEqual(both[0]["error"], self.render()["error"])

    def test_without_a_solution_nothing_is_lacking_from_it(self):
        for how in ("distributed", "none", "paths"):
            error = self.render("--indirect", how)["error"]
            self.assertGreater(error["estimate"], 0.0, how)
            self.assertEqual(error["parts"]["interreflection"], {"estimate": 0.0, "bound_95": 0.0}, how)
        self.assertEqual(error["parts"]["gather_noise"]["estimate"], 0.0)  # paths

    def test_nothing_lit_has_no_error(self):
        self.write("dark.toml", DARK)
        for how in ("radiosity", "none", "paths"):
            error = self.render("--indirect", how, scene="dark.toml")["error"]
            self.assertIsNone(error["estimate"], how)
            self.assertIsNone(error["bound_95"])
            for part in error["parts"].values():
                self.assertEqual(part, {"estimate": None, "bound_95": None})
            for target in error["targets"]:
                self.assertIsNone(target["estimate"])
            self.assertNotIn("earthshine:error.estimate", exr.read(self.folder / "a.exr")[0])
        self.assertIsNone(self.json("solve", "dark.toml")["error"]["estimate"])
        self.says(self.run_program("render", "dark.toml", "-o", "a.exr", "--camera", "A").stderr, "the error is unknown")

    def test_the_sky_alone_has_no_error(self):
        error = self.render("--set", "camera.A.look_at=[9, -9, 9]")["error"]
        self.assertIsNone(error["estimate"])
        self.assertEqual(error["targets"][0]["pixels"], 0)

    def test_what_is_not_captured_is_said(self):
        """For a curved mirror and a ball of glass, caustics of the lamps and the Sun are named with
        their share and the object."""
        sources = "caustics: light of lamps, Sun and emitters "
        thrown = sources + "that curved mirrors, or two flat mirrors in turn, throw: about "
        through = sources + "through glass that bends it, which casts a shadow: about "
        traced = "caustics: light of sources without size that curved mirrors, or two flat mirrors in turn, throw: about "
        of_ball = ' % of what falls straight from them ("ball")'
        between = "light from surface to surface"
        wide = between + ", and what N lights in place of a wide source change"
        self.write("plain.toml", PLAIN)
        self.write("mirror.toml", MIRROR)
        self.write("wide.toml", MIRROR.replace('type = "point"\nposition = [1.5, 0, 2]\nintensity = [900, 800, 700]', (
            'type = "rectangle"\ncenter = [1.5, 0, 2]\nedge_u = [0, 0.2, 0]\nedge_v = [0.2, 0, 0]\nexitance = 3e4')))
        self.write("glass.toml", GLASS)
        self.write("sheet.toml", GLASS.replace("ior = 1.5", "ior = 1.5\ntwo_sided = true"))
        for scene, how, missing in (
                ("plain", "radiosity", []), ("ball", "radiosity", []), ("mirror", "radiosity", [thrown]),
                ("glass", "radiosity", [through]), ("sheet", "radiosity", []), ("plain", "paths", []), ("ball", "paths", []),
                ("mirror", "paths", [traced]),
                ("wide", "paths", []),  # every source has a size, so that paths hit it
                ("plain", "distributed", [wide]), ("plain", "none", [between]), ("mirror", "none", [between, thrown])):
            found = self.render("--indirect", how, scene=scene + ".toml")["error"]["not_captured"]
            self.assertEqual(len(found), len(missing), (scene, how, found))
            for text, wanted in zip(found, missing):
                if wanted.endswith("about "):
                    self.assertTrue(text.startswith(wanted) and text.endswith(of_ball), text)
                    share = float(text.removeprefix(wanted).removesuffix(of_ball))
                    self.assertTrue(0.1 < share < 50.0, text)
                else:
                    self.assertEqual(text, wanted)
        self.assertTrue(self.json("solve", "mirror.toml")["error"]["not_captured"][0].startswith(thrown))
        text = self.run_program("render", "ball.toml", "-o", "a.exr", "--camera", "A").stderr
        self.says(text, "95 % sure below", "interreflection")


if __name__ == "__main__":
    unittest.main()
