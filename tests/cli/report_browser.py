# SPDX-License-Identifier: Apache-2.0
"""The report in headless Chromium (report/check.mjs): errors, keyboard, accessibility, print.

usage: report_browser.py PROGRAM [OUT]    screenshots and a PDF go to OUT

Exit code 77 without a browser, Node.js or report/node_modules.
"""
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

import report_sample
import study_table

TOP = pathlib.Path(__file__).resolve().parent.parent.parent
SKIPPED = 77

# Hostile names of cameras, targets, lamps, groups and studies. If one were executed, `owned` would
# exist.
HOSTILE = {
    "B": "B" + "W" * 10000,
    "C": "</script><script>window.owned = 1</script>",
    "tss": "\"><img src=x onerror='window.owned = 1'>",
    "eureca": "\u202egnp.exe\u2066 \U0001f680\U0001f469\u200d\U0001f680\u0000",
    "grapple-fixture": "]]>--><!--<style>*{display:none}</style>",
    "bay lamps on": "<svg onload=window.owned=1> " + "x" * 10000,
    "bay-lamps": "');window.owned=1;('\u2028 \U0001f6f0\ufe0f",
    "STS-46, day and night": "javascript:window.owned=1//" + "\u05d0" * 10000,
    "STS-46 payload bay": "\u202e" * 10000,
}


def hostile(value):
    """The study with these names, wherever a name is a whole value."""
    if isinstance(value, dict):
        return {hostile(key): hostile(item) for key, item in value.items()}
    if isinstance(value, list):
        return [hostile(item) for item in value]
    return HOSTILE.get(value, value) if isinstance(value, str) else value


def main():
    program, out = pathlib.Path(sys.argv[1]).resolve(), [pathlib.Path(name).resolve() for name in sys.argv[2:]]
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
        study = folder / "study.json"
        # Of at most 100 results: few targets, many, and two scenes.
        for page, results in (("few.html", report_sample.study(8)), ("many.html", report_sample.study(9, targets=5, lamps=1)),
                              ("two.html", report_sample.two_scenes(report_sample.study(4)))):
            small = folder / "small"
            shutil.copytree(TOP / "tests" / "data" / "report" / "pictures", small / "pictures", dirs_exist_ok=True)
            (small / "study.json").write_text(json.dumps(study_table.closed(results)), encoding="utf-8")
            subprocess.run([program, "report", small], check=True)
            pages.append(folder / page)
            (small / "report.html").rename(pages[-1])
        study.write_text(json.dumps(hostile(json.loads(study.read_text(encoding="utf-8")))), encoding="utf-8")
        subprocess.run([program, "report", folder], check=True)
        pages.append(folder / "report.html")
        if "<script>" not in pages[0].read_text(encoding="utf-8"):
            print("skipped: the program was built without the report's script")
            return SKIPPED
        return subprocess.run([node, TOP / "report" / "check.mjs", *pages, *out]).returncode


if __name__ == "__main__":
    sys.exit(main())
