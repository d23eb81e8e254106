# SPDX-License-Identifier: Apache-2.0
"""Ctrl-C ends a call within a second, and the scene is as good as before."""
import os
import signal
import subprocess
import sys
import time
import unittest

import program

# Says "working" as the call begins, and when it was told to end and had.
CHILD = """
import sys, time, earthshine
scene = earthshine.load(sys.argv[1], set={"quality.patch_edge": 0.02, "quality.form_factor_rays": 65536})
print("working", flush=True)
try:
    scene.CALL
except KeyboardInterrupt:
    print("interrupted", flush=True)
scene.set("quality.patch_edge", 0.5)
scene.set("quality.form_factor_rays", 64)
print(scene.render("A", error=0.5, size=(8, 8)).shape, flush=True)
"""


class Interrupts(program.Case):
    def test_each_call_ends_within_a_second(self):
        self.write("ball.toml", program.BALL)
        for call in ('solve(error=0.001)', 'render("A", error=0.0005, size=(512, 512))'):
            child = subprocess.Popen([sys.executable, "-c", CHILD.replace("CALL", call), str(self.folder / "ball.toml")],
                                     stdout=subprocess.PIPE, text=True, env=os.environ)
            self.assertEqual(child.stdout.readline(), "working\n")
            time.sleep(1.0)
            self.assertIsNone(child.poll(), call)
            child.send_signal(signal.SIGINT)
            start = time.monotonic()
            self.assertEqual(child.stdout.readline(), "interrupted\n", call)
            # One second of a machine that has nothing else to do; tests share theirs.
            self.assertLess(time.monotonic() - start, 10.0, call)
            self.assertEqual(child.stdout.readline(), "(8, 8)\n", call)
            child.stdout.close()
            self.assertEqual(child.wait(), 0)


if __name__ == "__main__":
    unittest.main()
