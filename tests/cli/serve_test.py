# SPDX-License-Identifier: Apache-2.0
"""console --serve: pictures of a moving scene, and requests that are refused."""
import http.client
import json
import math
import os
import re
import signal
import socket
import struct
import subprocess
import unittest

import program
import tiny_bay


class Served(tiny_bay.Case):
    """A running server."""
    SCENE = tiny_bay.BAY + '\n[[joint]]\nname = "hinge"\npivot = [0, 0, 0]\naxis = [0, 0, 1]\nangle_deg = 10\n'

    def setUp(self):
        super().setUp()
        self.write("bay.toml", self.SCENE)
        self.serve()

    def serve(self, *options):
        self.process = subprocess.Popen([os.environ["EARTHSHINE_PROGRAM"], "console", "bay.toml", "--serve", *options], cwd=self.folder,
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        address = self.process.stdout.readline()
        if not address:
            words = self.process.communicate()[1]
            self.skipTest("built without cpp-httplib") if "not in this build" in words else self.fail(words)
        self.port, self.token = re.fullmatch(r"http://127\.0\.0\.1:(\d+)/\?token=([0-9a-f]{32})\n", address).groups()

    def stop(self):
        if self.process.poll() is None:
            self.process.kill()
        self.process.communicate()

    def tearDown(self):
        self.stop()
        super().tearDown()

    def ask(self, method="POST", path="/draw", body="{}", token=None, headers=None):
        connection = http.client.HTTPConnection("127.0.0.1", int(self.port))
        connection.request(method, f"{path}?token={token or self.token}", body, headers or {})
        answer = connection.getresponse()
        content = answer.read()
        connection.close()
        return answer.status, content

    def picture(self, **request):
        status, content = self.ask(body=json.dumps({"camera": "A", "columns": 24, "rows": 20, **request}))
        self.assertEqual(status, 200, content)
        length = struct.unpack("<I", content[:4])[0]
        head = json.loads(content[4:4 + length])
        count = head["columns"] * head["rows"]
        values = struct.unpack(f"<{(len(content) - 4 - length) // 4}f", content[4 + length:])
        # Of a picture at once the object and the depth of each pixel follow.
        self.layers = values[3 * count:]
        self.assertEqual(len(self.layers), 2 * 24 * 20 if request.get("level", 0) == 0 else 0)
        return head, [values[c * count:(c + 1) * count] for c in range(3)]


class Serve(Served):
    def test_pictures_of_a_moving_scene(self):
        status, page = self.ask("GET", "/", None)
        self.assertEqual(status, 200)
        data = json.loads(re.search(r'id="data">(.*?)</script>', page.decode(), re.S).group(1))
        self.assertEqual({one["key"]: one["value"] for one in data["movables"]},
                         {"light.left.position": [1.5, 0, 2], "light.right.position": [-1.5, 0, 2], "object.floor.translate": [0, 0, 0],
                          "object.box.translate": [0, 0, 0], "object.far.translate": [0, 0, 0], "joint.hinge.angle_deg": [10]})
        at_once, _ = self.picture()  # before any solution: samples of a quarter of the columns and rows
        self.assertEqual((at_once["kind"], at_once["columns"], at_once["rows"], at_once["error"]), ("samples", 16, 16, None))
        errors = []
        for level in (2, 3, 4):
            head, planes = self.picture(level=level)
            errors.append(head["error"]["bound_95"])
            self.assertLess(head["error"]["bound_95"], data["level_errors"][level - 1])
        self.assertEqual(errors, sorted(errors, reverse=True))
        coarse, patches = self.picture()
        self.assertEqual((coarse["kind"], coarse["columns"], coarse["rows"]), ("patches", 24, 20))
        # Means over the picture: patches of 0.5 m beside lamps at 2 m blur shadows, but keep the light.
        self.assertAlmostEqual(sum(patches[1]) / sum(planes[1]), 1, delta=0.3)
        # The present camera as `view` gives the same bytes; a camera far below sees the floor's black back or nothing.
        camera = data["cameras"][0]
        view = {key: camera[key] for key in ("position", "look_at", "up", "fov_deg")}
        self.assertEqual(self.picture(view=view)[1], patches)
        self.assertNotEqual(self.picture(view=view | {"fov_deg": 20})[1], patches)
        moved, _ = self.picture(set={"light.left.position": [1.5, 0, 0.5]})
        self.assertEqual(moved["kind"], "samples")  # the light is not solved yet
        self.assertEqual(self.picture()[1], patches)  # moved back

    def test_a_scene_that_is_edited_meanwhile(self):
        """The lamps are those of the file that was read last, by name."""
        self.picture(set={"light.right.position": [-1.5, 0, 3]})
        text = (self.folder / "bay.toml").read_text()
        start = text.index("[[light]]", text.index("[[light]]") + 1)
        end = text.find("[[", start + 2)
        self.write("bay.toml", text[:start] + (text[end:] if end > 0 else ""))
        self.picture(level=1, set={"object.floor.translate": [0, 0, 0.01]})  # reads the file again
        status, words = self.ask(body=json.dumps({"camera": "A", "set": {"light.right.position": [-1.5, 0, 4]}}))
        self.assertEqual(status, 400, words[:200])
        self.says(words.decode(), "light.right.position", "not in the scene")

    def test_views_are_checked_at_each_pose(self):
        """A body that is moved over a camera, or a camera that is moved into a body, is refused as render refuses it."""
        inside = {"position": [0, 0, 0.3], "look_at": [1, 0, 0.3], "up": [0, 0, 1], "fov_deg": 40}
        for level in (0, 1):
            self.picture(level=level)
            for more in ({"set": {"object.box.translate": [3, -3, 1.7]}}, {"view": inside}):
                status, words = self.ask(body=json.dumps({"camera": "A", "columns": 24, "rows": 20, "level": level, **more}))
                self.assertEqual(status, 400, (level, more))
                self.says(words.decode(), '"A"', '"box"')
            self.picture(level=level)

    def test_a_port_in_use(self):
        run = self.run_program("console", "bay.toml", "--serve", "--port", self.port)
        self.assertEqual(run.returncode, 2, run.stdout)
        self.says(run.stderr, "--port", self.port, "not free")

    def test_a_level_is_the_picture_of_render(self):
        # Size of level 1: half the columns and rows.
        _, planes = self.picture(level=1, columns=48, rows=48, set={"light.left.position": [1.5, 0, 1]})
        self.done("render", "bay.toml", "--camera", "A", "--size", "24x24", "--error", "0.3", "--set", "light.left.position=[1.5,0,1]", "-o", "r.exr", "-q")
        import exr
        channels = exr.read(self.folder / "r.exr")[3]
        for plane, name in zip(planes, "RGB"):
            self.assertEqual(list(plane), list(channels[name]))

    def test_only_the_page_s_own_requests_are_answered(self):
        good = json.dumps({"camera": "A", "columns": 16, "rows": 16})
        own, localhost = f"127.0.0.1:{self.port}", f"localhost:{self.port}"
        self.assertEqual(self.ask(body=good, headers={"Host": localhost, "Origin": f"http://{localhost}"})[0], 200)
        for words, call in (("without the token", {"token": "0" * 32}), ("without the token", {"token": self.token[:-1]}),
                            ("without the token", {"token": self.token + "0"}), ("without the token", {"token": f"{self.token}&token=0"}),
                            ("another host", {"headers": {"Host": f"evil.example:{self.port}"}}), ("another host", {"headers": {"Host": "127.0.0.1"}}),
                            ("another origin", {"headers": {"Origin": "http://evil.example"}}), ("another origin", {"headers": {"Origin": "null"}}),
                            ("another origin", {"headers": {"Host": own, "Origin": f"https://{own}"}})):
            for method, path in (("GET", "/"), ("POST", "/draw"), ("GET", "/nothing")):
                status, content = self.ask(method, path, good if method == "POST" else None, **call)
                self.assertEqual((status, content.decode().count("\n")), (403, 1), call)
                self.assertIn(words, content.decode())
        self.assertEqual(self.ask("GET", "/nothing", None)[0], 404)
        # The socket listens on the loopback address alone.
        others = {info[4][0] for info in socket.getaddrinfo(socket.gethostname(), None, socket.AF_INET)} - {"127.0.0.1"}
        for other in [one for one in others if not one.startswith("127.")]:
            with self.assertRaises(OSError):
                socket.create_connection((other, int(self.port)), 1)

    def test_wrong_requests_say_what_is_wrong(self):
        self.assertEqual(self.ask(body=" " * (64 * 1024 + 1))[0], 413)
        for body, words in (("", "JSON"), ("[]", "JSON"), ("{", "JSON"), ("[" * 60000, "JSON"), ('{"camera": "A"}x', "JSON"), ("{}", "camera"),
                            ('{"camera": 1}', "camera"), ('{"camera": "Z"}', "camera"), ('{"camera": "A", "extra": 1}', "extra"),
                            ('{"camera": "A", "columns": 100000}', "columns"), ('{"camera": "A", "columns": 16.5}', "columns"),
                            ('{"camera": "A", "rows": "16"}', "rows"), ('{"camera": "A", "level": 7}', "level"), ('{"camera": "A", "level": -1}', "level"),
                            ('{"camera": "A", "view": []}', "view"), ('{"camera": "A", "view": {}}', "view.position"),
                            ('{"camera": "A", "view": {"position": [0, 0, 1e999], "look_at": [0, 0, 0], "up": [0, 1, 0], "fov_deg": 40}}', "JSON|view.position"),
                            ('{"camera": "A", "view": {"position": [0, 0, NaN], "look_at": [0, 0, 0], "up": [0, 1, 0], "fov_deg": 40}}', "JSON"),
                            ('{"camera": "A", "view": {"position": [0, 0, 1], "look_at": [0, 0, 1], "up": [0, 1, 0], "fov_deg": 40}}', "direction"),
                            ('{"camera": "A", "view": {"position": [0, 0, 1], "look_at": [0, 0, 0], "up": [0, 1, 0], "fov_deg": 0}}', "fov_deg"),
                            ('{"camera": "A", "set": {"quality.error": 1}}', "quality.error"), ('{"camera": "A", "set": {"object.box.mesh": "/etc/passwd"}}', "object.box.mesh"),
                            ('{"camera": "A", "set": {"light.left.position": 1}}', "light.left.position"),
                            ('{"camera": "A", "set": {"light.none.position": [0, 0, 0]}}', "light.none.position"),
                            ('{"camera": "A", "set": {"light.left.position": [0, 0, "1"]}}', "light.left.position")):
            status, content = self.ask(body=body)
            self.assertEqual((status, content.decode().count("\n")), (400, 1), (body[:80], content))
            self.assertRegex(content.decode(), words)
        self.picture()  # it goes on

    def test_the_end(self):
        for sent in (signal.SIGINT,):
            self.process.send_signal(sent)
            self.assertEqual(self.process.wait(5), 0)
        self.assertEqual(self.files("."), ["bay.toml", "s.toml"])  # nothing is written


class Moves(Served):
    """Objects, joints and lamps that move in the loaded scene, one after another."""
    SCENE = tiny_bay.BAY.replace('name = "box"', 'name = "box"\njoint = "hinge"', 1).replace('name = "left"', 'name = "left"\njoint = "hinge"', 1) + (
        '\n[[joint]]\nname = "hinge"\npivot = [0, 0, 0]\naxis = [0, 0, 1]\nangle_deg = 10\n')

    def test_a_move_gives_the_picture_of_a_scene_read_with_it(self):
        moves = ({"object.box.translate": [0.3, -0.2, 0.1]}, {"joint.hinge.angle_deg": 75}, {"light.left.position": [1, 0.5, 1]},
                 {"object.floor.translate": [0, 0, -0.5], "joint.hinge.angle_deg": -20, "light.right.position": [-1, 0, 1]}, {})
        found = []
        for move in moves:
            head, planes = self.picture(set=move)
            found.append((head, planes, self.layers))
        for move, (head, planes, layers) in zip(moves, found):
            self.stop()
            self.serve(*[text for key, value in move.items() for text in ("--set", f"{key}={json.dumps(value)}")])
            fresh, wanted = self.picture()
            marks = {one["key"]: one["at"] for one in fresh["marks"]}
            for one in head["marks"]:
                for k in range(3):
                    self.assertAlmostEqual(one["at"][k], marks[one["key"]][k], delta=1e-12)
            # The same bytes but for a ray that meets an edge: coordinates differ by 1e-15 m. In this scene none does.
            self.assertEqual(layers[:480], self.layers[:480])
            for mine, own in zip(planes, wanted):
                for a, b in zip(mine, own):
                    self.assertAlmostEqual(a, b, delta=1e-5 * max(own))
        self.assertEqual(len({planes[1] for _, planes, _ in found}), len(moves))

    def test_marks_and_layers_say_where_things_are(self):
        head, _ = self.picture(set={"object.box.translate": [0.3, 0.2, 0.1]})
        box = next(one for one in head["marks"] if one["key"] == "object.box.translate")
        # The box's middle is 0.3 m high; the hinge turns its place by 10 degrees about z, and its bounds about their middle.
        c, s = math.cos(math.radians(10)), math.sin(math.radians(10))
        for found, wanted in zip(box["at"], (0.3 * c - 0.2 * s, 0.3 * s + 0.2 * c, 0.4)):
            self.assertAlmostEqual(found, wanted, delta=1e-12)
        for k, column in enumerate(((c, s, 0), (-s, c, 0), (0, 0, 1))):
            for found, wanted in zip(box["rotation"][k], column):
                self.assertAlmostEqual(found, wanted, delta=1e-12)
        # Camera A sees the box in its middle, nearer than the box's middle and by less than half its diagonal.
        camera = head["camera"]
        along = [b - a for a, b in zip(camera["position"], camera["look_at"])]
        middle = sum(a * (m - p) for a, m, p in zip(along, box["at"], camera["position"])) / math.hypot(*along)
        pixel = 10 * 24 + 12
        self.assertEqual(self.layers[pixel], box["object"])
        self.assertTrue(middle - 0.5 * math.hypot(0.8, 0.8, 0.6) < self.layers[480 + pixel] < middle)


class Calls(tiny_bay.Case):
    def test_options_that_write_do_not_go_with_it(self):
        for option in (("-o", "c.html"), ("--camera", "A"), ("--json",), ("--positions", "4")):
            self.says(self.refused("console", "bay.toml", "--serve", *option), "--serve")


class WithoutSolution(Served):
    """A plate under a lamp: nothing reflects light onto anything."""
    SCENE = """format = 1
[[material]]
name = "grey"
diffuse = 0.5
[[object]]
name = "plate"
shape = "quad"
corners = [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]
material = "grey"
[[light]]
name = "lamp"
type = "point"
position = [0, 0, 1]
intensity = 100
[[camera]]
name = "A"
position = [0, -1, 2]
look_at = [0, 0, 0]
"""

    def test_a_picture_at_once_after_a_finer_one(self):
        means = []
        for level in (0, 1, 0):
            _, planes = self.picture(level=level)
            means.append(sum(planes[1]) / len(planes[1]))
        self.assertGreater(means[1], 0)
        for mean in means:
            self.assertAlmostEqual(mean, means[1], delta=0.3 * means[1])  # level 1 is to 30 %


if __name__ == "__main__":
    unittest.main()
