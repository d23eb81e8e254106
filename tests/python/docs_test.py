# SPDX-License-Identifier: Apache-2.0
"""The scripts of docs/python.md run as they stand there, but for smaller pictures and larger errors."""
import os
import pathlib
import re
import subprocess
import sys
import unittest

import program

TEXT = (program.TOP / "docs" / "python.md").read_text(encoding="utf-8")
SCRIPTS = re.findall(r"```python\n(.*?)```", TEXT, re.S)
SMALLER = (("(512, 512)", "(40, 40)"), ("(256, 256)", "(32, 32)"), ("error=0.05", "error=0.4"), ("error=0.03", "error=0.4"),
           ("range(200)", "range(2)"))


class Docs(program.Case):
    def test_five_scripts_run(self):
        self.assertEqual(len(SCRIPTS), 5)
        for folder in ("scenes", "studies"):
            os.symlink(program.TOP / folder, self.folder / folder)
        for number, script in enumerate(SCRIPTS, 1):
            for long, short in SMALLER:
                script = script.replace(long, short)
            path = pathlib.Path(self.write(f"script{number}.py", script))
            run = subprocess.run([sys.executable, path], cwd=self.folder, capture_output=True, text=True, timeout=600, check=False)
            self.assertEqual(run.returncode, 0, f"script {number}: {run.stderr}")


if __name__ == "__main__":
    unittest.main()
