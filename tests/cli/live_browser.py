# SPDX-License-Identifier: Apache-2.0
"""The page of `console --serve` in headless Chromium (console/check_live.mjs).

usage: live_browser.py PROGRAM [OUT [SCENE CAMERA OBJECT LAMP]]    screenshots go to OUT

Exit code 77 without a browser, Node.js, report/node_modules or cpp-httplib.
"""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import urllib.request

os.environ["EARTHSHINE_PROGRAM"] = sys.argv[1]
import tiny_bay  # noqa: E402

TOP = pathlib.Path(__file__).resolve().parent.parent.parent
SKIPPED = 77


def check(program, scene, names, folder, out):
    camera, thing, lamp = names
    server = subprocess.Popen([program, "console", scene, "--serve"], stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, text=True)
    try:
        address = server.stdout.readline().strip()
        if not address:
            words = server.communicate()[1]
            print(words)
            return SKIPPED if "not in this build" in words else 1
        # The page's own data says where things are at the start.
        with urllib.request.urlopen(address) as answer:
            page = answer.read().decode()
        data = json.loads(re.search(r'id="data">(.*?)</script>', page, re.S).group(1))
        movables = {one["key"]: one for one in data["movables"]}
        cameras = {one["name"]: one for one in data["cameras"]}
        expected = folder / "expected.json"
        expected.write_text(json.dumps({"object": movables[f"object.{thing}.translate"], "lamp": movables[f"light.{lamp}.position"],
                                        "camera": cameras[camera]}))
        return subprocess.run(["node", TOP / "console/check_live.mjs", address, expected, *out], check=False).returncode
    finally:
        server.kill()
        server.communicate()


def main():
    if not shutil.which("node"):
        print("skipped: no node")
        return SKIPPED
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        if len(sys.argv) > 3:
            return check(sys.argv[1], sys.argv[3], sys.argv[4:7], folder, sys.argv[2:3])
        # The right lamp is lowered into the view of camera A.
        scene = folder / "bay.toml"
        scene.write_text(tiny_bay.BAY.replace("position = [-1.5, 0, 2]", "position = [-1.5, 0, 1]"))
        return check(sys.argv[1], scene, ("A", "box", "right"), folder, sys.argv[2:3])


if __name__ == "__main__":
    sys.exit(main())
