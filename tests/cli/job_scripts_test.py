# SPDX-License-Identifier: Apache-2.0
"""The job scripts of docs/cluster.md: bash parses them, and an array run by hand gives the study of
one process."""
import os
import pathlib
import re
import subprocess
import unittest

import program
from tiny_bay import Case

SCRIPTS = re.findall(r"```bash\n(.*?)```", (program.TOP / "docs" / "cluster.md").read_text(encoding="utf-8"), re.S)


class JobScripts(Case):
    def test_bash_reads_them(self):
        self.assertEqual(len(SCRIPTS), 3)
        for script in SCRIPTS:
            run = subprocess.run(["bash", "-n"], input=script, capture_output=True, text=True, check=False)
            self.assertEqual((run.returncode, run.stderr), (0, ""), script)

    def test_arrays_run(self):
        self.done("study", "run", "s.toml", "-o", "w")
        slurm, _, pbs = SCRIPTS
        for name, script, index, size in (("o", slurm, "SLURM_ARRAY_TASK_ID", r"--array=1-(\d+)"),
                                          ("p", pbs, "PBS_ARRAY_INDEX", r"-J 1-(\d+)")):
            self.write("array.sh", script.replace("--wait 3600", ""))
            tasks = int(re.search(size, script).group(1))
            path = f"{pathlib.Path(program.PROGRAM).parent}:{os.environ['PATH']}"
            for task in range(tasks, 0, -1):
                run = subprocess.run(["bash", "array.sh"], cwd=self.folder, capture_output=True, text=True, check=False,
                                     env=os.environ | {"STUDY": "s.toml", "OUT": name, "PATH": path, index: str(task)})
                self.assertEqual(run.returncode, 0, run.stderr)
            self.done("merge", name, "-q")
            self.assertEqual(self.without_times(self.study(name)), self.without_times(self.study("w")))


if __name__ == "__main__":
    unittest.main()
