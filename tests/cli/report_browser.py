# SPDX-License-Identifier: Apache-2.0
"""The report in headless Chromium (report/check.mjs): errors, keyboard, accessibility, print.

usage: report_browser.py PROGRAM OUT    screenshots and a PDF go to OUT

Exit code 77 where there is no browser, no Node.js or no report/node_modules.
"""
import pathlib
import shutil
import subprocess
import sys
import tempfile

TOP = pathlib.Path(__file__).resolve().parent.parent.parent
SKIPPED = 77


def main():
    program, out = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    node = shutil.which("node") or shutil.which("nodejs")
    if not node or not (TOP / "report" / "node_modules").is_dir():
        print("skipped: no Node.js or no report/node_modules")
        return SKIPPED
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name) / "study"
        shutil.copytree(TOP / "tests" / "data" / "report", folder)
        pages = []
        for page, more in (("full.html", []), ("plain.html", ["--plain"])):
            subprocess.run([program, "report", folder, *more], check=True)
            pages.append(folder / page)
            (folder / "report.html").rename(pages[-1])
        if "<script>" not in pages[0].read_text(encoding="utf-8"):
            print("skipped: the program was built without the report's script")
            return SKIPPED
        return subprocess.run([node, TOP / "report" / "check.mjs", *pages, out]).returncode


if __name__ == "__main__":
    sys.exit(main())
