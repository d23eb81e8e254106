#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Seconds until `console --serve` answers with a picture at once, for the first picture and after moves: medians, wall and CPU.

usage: live_moves.py PROGRAM SCENE CAMERA [MOVES]
"""
import http.client
import json
import os
import re
import statistics
import subprocess
import sys
import time


class Live:
    def __init__(self, program, scene, camera):
        self.camera = camera
        self.process = subprocess.Popen([program, "console", scene, "--serve", "-q"], stdout=subprocess.PIPE, text=True)
        address = self.process.stdout.readline()
        port, self.token = re.fullmatch(r"http://127\.0\.0\.1:(\d+)/\?token=([0-9a-f]{32})\n", address).groups()
        self.connection = http.client.HTTPConnection("127.0.0.1", int(port))

    def cpu_s(self):
        with open(f"/proc/{self.process.pid}/stat") as stat:
            fields = stat.read().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def page_data(self):
        self.connection.request("GET", f"/?token={self.token}")
        page = self.connection.getresponse().read().decode()
        return json.loads(re.search(r'id="data">(.*?)</script>', page, re.S).group(1))

    def ask(self, **request):
        start, cpu = time.monotonic(), self.cpu_s()
        body = json.dumps({"camera": self.camera, "columns": 256, "rows": 256, **request})
        self.connection.request("POST", f"/draw?token={self.token}", body)
        answer = self.connection.getresponse()
        content = answer.read()
        if answer.status != 200:
            sys.exit(content.decode())
        return time.monotonic() - start, self.cpu_s() - cpu


def report(name, times):
    wall, cpu = zip(*times)
    print(f"{name:40} {statistics.median(wall):6.3f} s  {statistics.mean(cpu):6.3f} CPU s")


def main():
    program, scene, camera = sys.argv[1:4]
    moves = range(1, 1 + int((sys.argv[4:] or ["8"])[0]))
    live = Live(program, scene, camera)
    try:
        data = live.page_data()
        view = next(one for one in data["cameras"] if one["name"] == camera)
        report("first picture", [live.ask()])
        live.ask(level=1)
        shifted = [[view["position"][0] + 0.01 * k, *view["position"][1:]] for k in moves]
        keys = {key: view[key] for key in ("look_at", "up", "fov_deg")}
        report("camera", [live.ask(view={"position": position, **keys}) for position in shifted])
        for kind in ("light", "object", "joint"):
            one = next((one for one in data["movables"] if one["key"].startswith(kind)), None)
            if one is None:
                continue
            values = [[x + 0.01 * k for x in one["value"]] for k in moves]
            report(one["key"], [live.ask(set={one["key"]: value if len(value) > 1 else value[0]}) for value in values])
    finally:
        live.process.kill()
        live.process.communicate()


if __name__ == "__main__":
    main()
