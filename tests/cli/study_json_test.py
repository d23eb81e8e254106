# SPDX-License-Identifier: Apache-2.0
"""Edited JSON of a study or of a call in parts: it is read, refused in one line or replaced, and
never ends the program by a signal or with a library's message.

Each value in turn gets another type, and files are truncated. One type per value, by a fixed seed;
all types with EARTHSHINE_MUTATIONS=all (minutes).
"""
import copy
import json
import os
import random
import re
import shutil
import unittest

import program
import tiny_bay

KINDS = [None, True, -1e300, 3, "x", "", [], ["x"], {}, {"x": [1]}, [[[1]]]]
ALL = os.environ.get("EARTHSHINE_MUTATIONS") == "all"
DEEP = 100000  # nested lists: a recursive parser needs as many calls on the stack


def places(value, way=()):
    """Only the first entry of a list, because all are read by the same code."""
    yield way
    inner = value.items() if isinstance(value, dict) else enumerate(value[:1]) if isinstance(value, list) else ()
    for key, part in inner:
        yield from places(part, (*way, key))


def changed(value, way, new):
    if not way:
        return new
    whole = copy.deepcopy(value)
    part = whole
    for key in way[:-1]:
        part = part[key]
    part[way[-1]] = new
    return whole


class StudyJson(program.Case):
    def setUp(self):
        super().setUp()
        bay = re.sub("resolution = .*", "resolution = [16, 12]", re.sub("cctv = .*", "", tiny_bay.BAY))
        self.write("bay.toml", bay.replace("patch_edge = 0.5", "patch_edge = 2").replace("_rays = 64", "_rays = 16"))
        self.chance = random.Random(1)

    def sound(self, call, file, what):
        run = self.run_program(*call, "-q", "-j", "1")
        said = run.stderr.strip()
        self.assertIn(run.returncode, (0, 1, 2), f"{what}: {said}")
        self.assertNotRegex(said, r"json\.exception|std::|basic_", what)
        if run.returncode != 0:
            self.assertIn("earthshine: ", said, what)
        return run

    def mutate(self, file, call, again=None):
        """again: a call before each test that restores files which the tested call may have
        repaired."""
        path = self.folder / file
        text = path.read_text(encoding="utf-8")
        value, refused = json.loads(text), 0
        deep = text.rstrip()[:-1] + ', "more": ' + "[" * DEEP + "]" * DEEP + "}"
        texts = {f"cut to {n}": text[:n] for n in (0, 1, len(text) // 2, len(text) - 3)} | {"deep": deep}
        for way in places(value):
            for new in KINDS if ALL else self.chance.sample(KINDS, 1):
                texts[f"{'.'.join(map(str, way))} = {new!r}"] = json.dumps(changed(value, way, new))
        for way in (("settings",), ("provenance",)):
            if way[0] in value:
                texts[f"{way[0]} deep"] = json.dumps(changed(value, way, "HERE")).replace('"HERE"', "[" * DEEP + "]" * DEEP)
        for what, mutated in texts.items():
            path.write_text(mutated, encoding="utf-8")
            refused += self.sound(call, file, f"{file}: {what}").returncode != 0
            if again:
                again()
        path.write_text(text, encoding="utf-8")
        self.assertGreater(refused if again is None else 1, 0)

    def test_report(self):
        self.done("study", "orbit", "bay.toml", "-o", "d", "--positions", "2", "--wanted", "box>=0.5")
        self.mutate("d/study.json", ("report", "d"))

    def test_what_goes_on(self):
        call = ("study", "orbit", "bay.toml", "-o", "d", "--positions", "2")
        self.done(*call)
        kept = self.folder / "kept"
        shutil.copytree(self.folder / "d", kept)

        def again():
            shutil.rmtree(self.folder / "d")
            shutil.copytree(kept, self.folder / "d")

        for path in sorted((self.folder / "d/points").glob("*.json"))[:: 1 if ALL else 4]:
            self.mutate(path.relative_to(self.folder), call, again)

    def test_parts(self):
        call = ("render", "bay.toml", "--camera", "B", "-o", "a.exr")
        for part in ("1/2", "2/2"):
            self.done(*call, "--part", part)
        self.done("merge", "a.exr.parts")
        whole = (self.folder / "a.exr").read_bytes()
        files = sorted((self.folder / "a.exr.parts").glob("*.json"))
        self.assertTrue(any("solution" in path.name for path in files))
        for path in files:
            for reader in (("merge", "a.exr.parts"), (*call, "--part", "1/2")):
                self.mutate(path.relative_to(self.folder), reader, lambda: None)
        for part in ("1/2", "2/2"):
            self.done(*call, "--part", part)
        self.done("merge", "a.exr.parts")
        self.assertEqual((self.folder / "a.exr").read_bytes(), whole)


if __name__ == "__main__":
    unittest.main()
