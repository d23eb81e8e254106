# SPDX-License-Identifier: Apache-2.0
"""dataset: the labels, read as the documentation of BOP and COCO describes them, agree with the pictures; any part, in
any order, makes the same files."""
import json
import math
import struct
import subprocess
import sys
import unittest

import exr
import png
import program
import study_table

SCENE = """format = 1
unit = "cm"
[[material]]
name = "grey"
diffuse = 0.5
[[object]]
name = "cube"
shape = "box"
min = [-20, -30, -10]
max = [20, 30, 10]
material = "grey"
[[object]]
name = "post"
shape = "box"
min = [60, -10, -100]
max = [70, 10, 100]
material = "grey"
[sun]
direction = [1, 0.3, 0.5]
illuminance = 1000
[[light]]
name = "lamp"
type = "point"
position = [200, 200, 200]
intensity = 100
[[camera]]
name = "A"
position = [400, 0, 0]
look_at = [0, 0, 0]
fx = 90
fy = 100
cx = 45
cy = 28
resolution = [80, 60]
"""
CORNERS = [(x, y, z) for x in (-200, 200) for y in (-300, 300) for z in (-100, 100)]  # mm

DATASET = """format = 1
scene = "a.toml"
images = 4
seed = 7
error = 0.3
[camera]
from = "shell"
center = [0, 0, 0]
radius = [1.4, 2.5]
azimuth_deg = [-60, 60]
elevation_deg = [-30, 30]
look_at_target = "cube"
jitter = 0.2
roll_deg = [-20, 20]
clearance = 0.1
[[target]]
name = "cube"
low = [-0.2, -0.2, -0.2]
high = [0.2, 0.2, 0.2]
turns = true
[[target.point]]
name = "corner"
position = [0.2, 0.3, 0.1]
[[target.point]]
name = "middle"
position = [0, 0, 0]
[[vary]]
key = "sun.direction"
direction = true
[[vary]]
key = "light.lamp.intensity"
log_uniform = [10, 1000]
[[vary]]
key = "material.grey.diffuse"
uniform = [[0.1, 0.1, 0.1], [0.8, 0.8, 0.8]]
"""


def hull(points):
    """Counter-clockwise convex hull (Andrew's monotone chain)."""
    points = sorted(points)

    def half(points):
        chain = []
        for p in points:
            while len(chain) > 1 and cross(chain[-2], chain[-1], p) <= 0:
                chain.pop()
            chain.append(p)
        return chain[:-1]

    return half(points) + half(points[::-1])


def cross(a, b, p):
    return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])


def depth_inside(polygon, p):
    """Distance to the nearest side, negative outside."""
    return min(cross(a, b, p) / math.dist(a, b) for a, b in zip(polygon, polygon[1:] + polygon[:1]))


def decoded(segmentation):
    """COCO's uncompressed RLE: runs of 0 and 1 by turns, down the columns."""
    height, width = segmentation["size"]
    mask, at, value = [0] * (width * height), 0, 0
    for run in segmentation["counts"]:
        for k in range(at, at + run):
            mask[k % height * width + k // height] = value
        at, value = at + run, 1 - value
    assert at == width * height
    return mask


class Dataset(program.Case):
    def setUp(self):
        super().setUp()
        self.write("a.toml", SCENE)
        self.write("set.toml", DATASET)

    def files(self, folder):
        top = self.folder / folder
        return {str(path.relative_to(top)): path.read_bytes() for path in sorted(top.rglob("*")) if path.is_file()}

    def bop(self, name):
        return json.loads((self.folder / "out/train/000000" / name).read_text())

    def test_labels_agree_with_the_pictures(self):
        self.done("dataset", "set.toml", "-o", "out", "-q")
        cameras, poses, facts = (self.bop(f"scene_{name}.json") for name in ("camera", "gt", "gt_info"))
        coco = json.loads((self.folder / "out/annotations.json").read_text())
        self.assertEqual(set(cameras), {"0", "1", "2", "3"})
        boxes_seen = 0
        for image in range(4):
            camera, pose, fact = cameras[str(image)], poses[str(image)][0], facts[str(image)][0]
            k, r, t = camera["cam_K"], pose["cam_R_m2c"], pose["cam_t_m2c"]
            self.assertEqual(k, [90, 0, 44.5, 0, 100, 27.5, 0, 0, 1])

            def project(point):
                x, y, z = (sum(r[3 * row + c] * point[c] for c in range(3)) + t[row] for row in range(3))
                return k[0] * x / z + k[2], k[4] * y / z + k[5], z

            # The mask is what the pixels' centres, which have whole numbers, see of the cube.
            outline = hull([project(corner)[:2] for corner in CORNERS])
            width, height, _, whole = png.pixels((self.folder / f"out/train/000000/mask/{image:06}_000000.png").read_bytes())
            visible = png.pixels((self.folder / f"out/train/000000/mask_visib/{image:06}_000000.png").read_bytes())[3]
            for pixel, value in enumerate(whole):
                inside = depth_inside(outline, (pixel % width, pixel // width))
                if abs(inside) > 0.01:
                    self.assertEqual(value, 255 if inside > 0 else 0, (image, pixel, inside))
                self.assertLessEqual(visible[pixel], value)
            self.assertEqual(fact["px_count_all"], sum(whole) // 255)
            self.assertEqual(fact["px_count_visib"], sum(visible) // 255)
            self.assertAlmostEqual(fact["visib_fract"], sum(visible) / sum(whole))
            # Depth in 16 bits against the layer of the EXR file.
            data = png.pixels((self.folder / f"out/train/000000/depth/{image:06}.png").read_bytes())[3]
            depth = exr.read(self.folder / f"out/images/{image:06}.exr")[3]["Z"]
            for stored, metres in zip(struct.unpack(f">{width * height}H", data), depth):
                expected = 1000 * metres if math.isfinite(metres) else 0
                self.assertLessEqual(abs(stored * camera["depth_scale"] - expected), 0.51 * camera["depth_scale"])
            for note in (one for one in coco["annotations"] if one["image_id"] == image):
                self.assertEqual([255 * bit for bit in decoded(note["segmentation"])], list(visible))
                columns = [p % width for p, value in enumerate(visible) if value]
                rows = [p // width for p, value in enumerate(visible) if value]
                self.assertEqual(note["bbox"], [min(columns), min(rows), max(columns) - min(columns) + 1, max(rows) - min(rows) + 1])
                self.assertEqual(note["area"], sum(visible) // 255)
                x, y, seen = note["keypoints"][:3]
                u, v, _ = project((200, 300, 100))
                if seen:
                    self.assertLess(math.dist((x, y), (u, v)), 1e-6)
                self.assertIn(note["keypoints"][5], (0, 1), "the middle of the cube is hidden")
                boxes_seen += 1
        self.assertGreater(boxes_seen, 2)
        drawn = [json.loads((self.folder / f"out/images/{k:06}.json").read_text())["drawn"] for k in range(4)]
        self.assertEqual(len({str(one["set"]) for one in drawn}), 4)
        model = (self.folder / "out/models/obj_000001.ply").read_text().splitlines()
        corners = {tuple(map(float, line.split())) for line in model[model.index("end_header") + 1:][:int(model[3].split()[2])]}
        self.assertEqual(corners, set(CORNERS))
        size = json.loads((self.folder / "out/models/models_info.json").read_text())["1"]
        self.assertAlmostEqual(size["diameter"], math.dist(CORNERS[0], CORNERS[-1]), places=6)

    def check_outlines(self, images):
        """Masks are what the pixels' centres see of the model at the labelled pose; counts and boxes are those of its
        whole silhouette, also beyond the picture. The model is convex."""
        lines = (self.folder / "out/models/obj_000001.ply").read_text().splitlines()
        model = [tuple(map(float, line.split())) for line in lines[lines.index("end_header") + 1:][:int(lines[3].split()[2])]]
        for image in images:
            camera, pose, fact = (self.bop(f"scene_{name}.json")[str(image)] for name in ("camera", "gt", "gt_info"))
            k, r, t = camera["cam_K"], pose[0]["cam_R_m2c"], pose[0]["cam_t_m2c"]
            points = [[sum(r[3 * row + c] * p[c] for c in range(3)) + t[row] for row in range(3)] for p in model]
            outline = hull([(k[0] * x / z + k[2], k[4] * y / z + k[5]) for x, y, z in points])
            width, height, _, mask = png.pixels((self.folder / f"out/train/000000/mask/{image:06}_000000.png").read_bytes())
            inside, near = [], 0
            for y in range(-height, 2 * height):
                for x in range(-width, 2 * width):
                    depth = depth_inside(outline, (x, y))
                    near += abs(depth) < 0.01
                    if depth > 0:
                        inside.append((x, y))
                    if 0 <= x < width and 0 <= y < height and abs(depth) > 0.01:
                        self.assertEqual(mask[y * width + x], 255 if depth > 0 else 0, (image, x, y, depth))
            self.assertLessEqual(abs(fact[0]["px_count_all"] - len(inside)), near)
            self.assertAlmostEqual(fact[0]["visib_fract"], fact[0]["px_count_visib"] / fact[0]["px_count_all"])
            if near == 0:
                left, top = min(x for x, _ in inside), min(y for _, y in inside)
                right, bottom = max(x for x, _ in inside), max(y for _, y in inside)
                self.assertEqual(fact[0]["bbox_obj"], [left, top, right - left + 1, bottom - top + 1])
        return self.bop("scene_gt.json"), self.bop("scene_gt_info.json")

    def test_targets_that_the_frame_cuts_count_beyond_it(self):
        self.write("set.toml", DATASET.replace('from = "shell"', 'from = "scene"').replace('look_at_target = "cube"\n', "look_at = [0, -1.6, 0.4]\n")
                   .replace("jitter = 0.2", "jitter = 0").replace("images = 4", "images = 2"))
        for line in ("center", "radius", "azimuth_deg", "elevation_deg"):
            text = (self.folder / "set.toml").read_text()
            self.write("set.toml", "".join(l for l in text.splitlines(True) if not l.startswith(line)))
        self.done("dataset", "set.toml", "-o", "out", "-q")
        _, facts = self.check_outlines(range(2))
        self.assertTrue(any(0 < facts[k][0]["visib_fract"] < 0.9 for k in facts), facts)

    def test_labels_follow_what_hangs_on_joints(self):
        """By an angle that is drawn, by the Sun, and by a table of the time; with and without a drawn pose."""
        subprocess.run([sys.executable, program.TOP / "scenes/time/circle_to_oem.py", "-o", "t.oem", "--start", "2026-03-01T12:00:00",
                        "--hours", "1", "--altitude", "425", "--inclination", "28.5", "--node", "300"], cwd=self.folder, check=True)
        self.write("j.csv", "utc, j\n2026-03-01T12:00:00, 0\n2026-03-01T12:01:00, 160\n")
        scene = SCENE.replace('name = "cube"\n', 'name = "cube"\njoint = "j"\n')
        joint = '[[joint]]\nname = "j"\npivot = [0, 20, 0]\naxis = [0, 1, 1]\n'
        still = DATASET.replace("low = [-0.2, -0.2, -0.2]\nhigh = [0.2, 0.2, 0.2]\nturns = true\n", "")
        for name, how, varied in (
                ("angle", "angle_deg = 20\n", '[[vary]]\nkey = "joint.j.angle_deg"\nuniform = [-150, 150]\n'),
                ("sun", 'follows = "sun"\nnormal = [1, 0, 0]\n', ""),
                ("time", 'angle_deg = "j.csv"\n', '[[vary]]\nkey = "time.moment"\nchoice = [%s]\n' % ", ".join(
                    f'"2026-03-01T12:00:{k:02}Z"' for k in range(60)))):
            for kind, recipe in (("still", still), ("drawn", DATASET)):
                sky = '[time]\nstart = "2026-03-01T12:00:00Z"\n[orbit]\ntrajectory = "t.oem"\n'
                self.write("a.toml", (scene.replace("[sun]\ndirection = [1, 0.3, 0.5]\n", sky + "[sun]\n") if name == "time" else scene)
                           + joint + how)
                self.write("set.toml", (recipe.replace('[[vary]]\nkey = "sun.direction"\ndirection = true\n', "")
                                        if name == "time" else recipe) + varied)
                self.done("dataset", "set.toml", "-o", "out", "-q")
                poses, _ = self.check_outlines(range(4))
                self.assertEqual(len({str(pose[0]["cam_R_m2c"]) for pose in poses.values()}), 4, (name, kind))

    def test_cctv_pictures_are_on_the_grid_of_the_labels(self):
        """Where the layers have light the picture has: more often than with the layers moved by a pixel."""
        self.write("a.toml", SCENE.replace("fx = 90", "fx = 100").replace("cx = 45", "cx = 40").replace("cy = 28", "cy = 30") +
                   'cctv = "plain"\n[[cctv]]\nname = "plain"\n')
        self.write("set.toml", DATASET.replace("error = 0.3", "error = 0.3\ncctv = true").replace("images = 4", "images = 1")
                   .replace('[[vary]]\nkey = "sun.direction"\ndirection = true\n', ""))
        self.done("dataset", "set.toml", "-o", "out", "-q")
        width, height, channels, shown = png.pixels((self.folder / "out/train/000000/rgb/000000.png").read_bytes())
        self.assertEqual((width, height, channels), (80, 60, 1))
        note = json.loads((self.folder / "out/annotations.json").read_text())
        self.assertEqual((note["images"][0]["width"], note["images"][0]["height"]), (80, 60))
        light = exr.read(self.folder / "out/images/000000.exr")[3]["G"]
        black = min(shown)

        def agree(dx, dy):
            return sum((light[(y + dy) * width + x + dx] > 0) == (shown[y * width + x] > black + 10)
                       for y in range(1, height - 1) for x in range(1, width - 1))

        for dx, dy in ((1, 0), (-1, 0), (0, 1), (0, -1)):
            self.assertGreater(agree(0, 0), agree(dx, dy))
        self.assertGreater(agree(0, 0), 0.95 * (width - 2) * (height - 2))

    def test_parts_in_any_order_make_the_same_files(self):
        self.done("dataset", "set.toml", "-o", "out", "-q", "--threads", "1")
        self.done("dataset", "set.toml", "-o", "parts", "-q", "--images", "2-3")
        self.assertFalse((self.folder / "parts/annotations.json").exists())
        before = (self.folder / "parts/images/000003.json").stat().st_mtime_ns
        self.done("dataset", "set.toml", "-o", "parts", "-q")
        self.assertEqual(before, (self.folder / "parts/images/000003.json").stat().st_mtime_ns)  # not drawn again
        self.assertEqual(self.files("out"), self.files("parts"))

    def test_motion_is_in_the_pictures_and_labels_are_of_one_instant(self):
        """The picture of a moving target is that of `render` with what was drawn; the labels are those of the still
        target, which is where it is in the middle of the exposure of the middle row."""
        drawn = {}
        for name, motion, shutter in (("still", "", ""), ("moving", "velocity = [30, 0, 40]\nspin = [0, 90, 0]\n", "exposure_s = 0.5\nline_s = 0.01\n")):
            self.write("a.toml", SCENE.replace('name = "cube"\n', 'name = "cube"\n' + motion) + shutter)
            self.done("dataset", "set.toml", "-o", name, "-q", "--images", "2")
            drawn[name] = json.loads((self.folder / f"{name}/images/000002.json").read_text())
        for key in ("scene_camera", "scene_gt", "scene_gt_info", "annotations"):
            self.assertEqual(drawn["moving"][key], drawn["still"][key], key)
        pose, sets = drawn["moving"]["drawn"]["camera"], drawn["moving"]["drawn"]["set"]
        for key, unit in (("position", 100), ("look_at", 100), ("up", 1)):
            sets.append(f"camera.A.{key}={[unit * x for x in pose[key + ('' if key == 'up' else '_m')]]}")
        self.done("render", "a.toml", "--camera", "A", "--aov", "object,depth,normal", "--seed", str(drawn["moving"]["drawn"]["seed"]),
                  "-o", "own.exr", "-q", *(word for one in sets for word in ("--set", one)))
        pictures = [exr.read(self.folder / file)[3] for file in ("own.exr", "moving/images/000002.exr", "still/images/000002.exr")]
        self.assertEqual(pictures[0], pictures[1])
        for layer in ("Z", "object"):
            self.assertEqual(pictures[1][layer], pictures[2][layer])
        self.assertNotEqual(pictures[1]["R"], pictures[2]["R"])

    def test_targets_are_judged_as_a_study_judges_them(self):
        """The same scene and pose in `study visibility`: what depends on geometry alone is equal. Both pictures have a
        stated error of at most 2 %, independent of each other, so that means over a target, whose noise is at most
        the picture's, differ by less than 4 * 2^(1/2) * 2 % = 11.3 %; the SNR is between a power 1/2 (photons) and 1
        (readout) of the light."""
        for cctv, chosen in (("", "eye"), ('cctv = "sit-monochrome"\n', "signal")):
            self.write("a.toml", SCENE + cctv)
            self.write("set.toml", DATASET.replace("error = 0.3", f"error = 0.02\ncctv = {'true' if cctv else 'false'}"))
            self.done("dataset", "set.toml", "-o", f"out-{chosen}", "-q", "--images", "2")
            image = json.loads((self.folder / f"out-{chosen}/images/000002.json").read_text())
            pose, sets = image["drawn"]["camera"], image["drawn"]["set"]
            for key, unit in (("position", 100), ("look_at", 100), ("up", 1)):
                sets.append(f"camera.A.{key}={[unit * x for x in pose[key + ('' if key == 'up' else '_m')]]}")
            self.done("study", "visibility", "a.toml", "-o", f"study-{chosen}", "-q", *(word for one in sets for word in ("--set", one)))
            expected = study_table.opened(json.loads((self.folder / f"study-{chosen}/study.json").read_text()))["results"][0]
            target = image["targets"][0]
            self.assertEqual(target["name"], "cube")
            self.assertGreater(target["pixels"], 30)
            for key in ("verdict", "pixels", "visible_fraction", "cut_by_frame", "angle_deg", "tv_lines"):
                value = expected[key]
                if isinstance(value, float):
                    self.assertAlmostEqual(target[key], value, delta=1e-3 * value, msg=key)  # study.json: four digits
                else:
                    self.assertEqual(target[key], value, key)
            for key in ("luminance", "surround"):
                self.assertLess(abs(target[key] / expected[key] - 1), 0.113, key)
            self.assertEqual(target["signal"] is None, chosen == "eye")
            if cctv:
                self.assertLess(abs(math.log(target["signal"]["snr"] / expected["signal"]["snr"])), 0.113)

    def test_the_camera_is_never_in_a_body(self):
        text = DATASET.replace("radius = [1.4, 2.5]", "radius = [0.05, 0.15]").replace("[-30, 30]", "[0, 90]").replace("clearance = 0.1\n", "")
        self.write("set.toml", text.replace("turns = true", "").replace("low = [-0.2, -0.2, -0.2]", "low = [0, 0, 0]").replace(
            "high = [0.2, 0.2, 0.2]", "high = [0, 0, 0]").replace('look_at_target = "cube"', "look_at = [3, 0, 0]"))
        self.done("dataset", "set.toml", "-o", "out", "-q", "--images", "0")
        x, y, z = json.loads((self.folder / "out/images/000000.json").read_text())["drawn"]["camera"]["position_m"]
        self.assertFalse(abs(x) < 0.2 and abs(y) < 0.3 and abs(z) < 0.1)
        self.assertLess(math.hypot(x, y, z), 0.15 + 1e-12)

    def test_refusals(self):
        for old, new, words in (("images = 4", "images = 0", "images"), ("turns = true", "turn = true", "turns"),
                                ('name = "cube"', 'name = "cub"', "look_at_target"), ("direction = true", "", "law"),
                                ("[1.4, 2.5]", "[2.5, 1.4]", "radius"), ("log_uniform = [10", "log_uniform = [-10", "above 0")):
            self.write("set.toml", DATASET.replace(old, new, 1))
            self.says(self.refused("dataset", "set.toml", "-o", "out"), "set.toml", words)
        vary = '[[vary]]\nkey = "{}"\nuniform = [1, 2]\n'
        for key in ("translate", "scale", "target", "min"):
            self.write("set.toml", DATASET + vary.format("object.cube." + key))
            self.says(self.refused("dataset", "set.toml", "-o", "out"), "set.toml", "the pose or the shape of a target")
        self.write("set.toml", DATASET + vary.format("unit"))
        self.says(self.refused("dataset", "set.toml", "-o", "out"), "set.toml", "sets the unit")
        self.write("set.toml", DATASET.replace("seed = 7", 'seed = 7\nset = ["unit=m"]'))
        self.says(self.refused("dataset", "set.toml", "-o", "out"), "set.toml", "sets the unit")
        self.write("set.toml", DATASET)
        self.says(self.refused("dataset", "set.toml", "-o", "out", "--images", "3-9"), "--images", "0 to 3")
        self.says(self.refused("dataset", "set.toml", "-o", "out", "--seed", "5"), "--seed", "no effect")

    def test_a_scene_in_another_folder_is_part_of_the_key(self):
        """Recipe and scene may have one file name: a change of the scene makes the image anew."""
        (self.folder / "sub").mkdir()
        self.write("sub/set.toml", SCENE)
        self.write("set.toml", DATASET.replace("a.toml", "sub/set.toml"))
        self.done("dataset", "set.toml", "-o", "out", "-q")
        lists = [self.folder / "out/train/000000/scene_gt.json", self.folder / "out/annotations.json"]
        before = (self.folder / "out/images/000000.json").read_text()
        self.write("sub/set.toml", SCENE.replace("diffuse = 0.5", "diffuse = 0.6"))
        self.done("dataset", "set.toml", "-o", "out", "-q", "--images", "0")
        self.assertNotEqual((self.folder / "out/images/000000.json").read_text(), before)
        self.assertFalse(any(path.exists() for path in lists))  # the others are of the scene before

    def test_a_file_that_an_image_draws_is_part_of_its_key(self):
        """A mesh chosen by [[vary]] is no file of the scene; its change makes the image anew."""
        mesh = "v 0 0 0\nv 0 {0} 0\nv 0 0 {0}\nf 1 2 3\n"
        self.write("one.obj", mesh.format(10))
        self.write("a.toml", SCENE + '[[object]]\nname = "sheet"\nmesh = "one.obj"\nmaterial = "grey"\n')
        self.write("two.obj", mesh.format(20))
        self.write("set.toml", DATASET.replace("images = 4", "images = 2") + '[[vary]]\nkey = "object.sheet.mesh"\nchoice = ["two.obj"]\n')
        self.done("dataset", "set.toml", "-o", "out", "-q")
        self.write("two.obj", mesh.format(90))
        self.done("dataset", "set.toml", "-o", "out", "-q")
        self.done("dataset", "set.toml", "-o", "anew", "-q")
        self.assertEqual(self.files("out"), self.files("anew"))

    def test_the_original_of_a_target_keeps_its_shape(self):
        self.write("a.toml", SCENE.replace('name = "cube"\n', 'name = "cube"\ntranslate = [0, 0, 90]\n') +
                   '[[object]]\nname = "copy"\ninstance_of = "cube"\ntranslate = [0, 90, 0]\n')
        copy = DATASET.replace('name = "cube"', 'name = "copy"').replace('look_at_target = "cube"', 'look_at_target = "copy"')
        for key, values in (("max", "[[20, 30, 10], [30, 30, 10]]"), ("segments", "[3, 4]")):
            self.write("set.toml", copy + f'[[vary]]\nkey = "object.cube.{key}"\nuniform = {values}\n')
            self.says(self.refused("dataset", "set.toml", "-o", "out"), "set.toml", f"object.cube.{key}", "the original of the target", "copy")

    def test_a_lost_picture_is_drawn_again(self):
        self.write("set.toml", DATASET)
        self.done("dataset", "set.toml", "-o", "out", "-q", "--images", "0-1")
        pictures = [self.folder / "out/train/000000/rgb/000000.png", self.folder / "out/images/000001.exr"]
        before = [path.read_bytes() for path in pictures]
        pictures[0].unlink()
        pictures[1].write_bytes(b"")
        self.done("dataset", "set.toml", "-o", "out", "-q", "--images", "0-1")
        self.assertEqual([path.read_bytes() for path in pictures], before)

    def test_lists_are_of_whole_images_and_a_missed_error_is_named_again(self):
        self.write("set.toml", DATASET.replace("images = 4", "images = 2"))
        self.done("dataset", "set.toml", "-o", "out", "-q")
        (self.folder / "out/train/000000/rgb/000001.png").unlink()
        lists = [self.folder / "out/train/000000/scene_gt.json", self.folder / "out/annotations.json"]
        for path in lists:
            path.unlink()
        self.done("dataset", "set.toml", "-o", "out", "-q", "--images", "0")
        self.assertFalse(any(path.exists() for path in lists))
        # An image that was made before without its error.
        record = self.folder / "out/images/000000.json"
        self.assertIn('"reached": true', record.read_text())
        record.write_text(record.read_text().replace('"reached": true', '"reached": false'))
        run = self.run_program("dataset", "set.toml", "-o", "out", "-q")
        self.assertEqual(run.returncode, 3, run.stderr)
        self.says(run.stderr, "do not have their error: 0")


if __name__ == "__main__":
    unittest.main()
