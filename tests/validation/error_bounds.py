# SPDX-License-Identifier: Apache-2.0
"""Validates stated errors. `./dev validate --errors` runs this; its output is a part of
docs/data/validation.md.

    error_bounds.py PROGRAM [--quick] [--only NAME] [--cache DIR] [--seed N]

Renders and solves shipped scenes, hard scenes and random rooms with many settings. Compares the
stated error with the true error against independent references, whose noise cancels
(error_truth.py).

Pictures are compared with path-traced ones of all light paths except caustics, as many as the true
error needs. Radiosities are compared with two solutions of ten times the patches or, for scenes
with a wanted error, with solutions to half of the smallest one: uniform patches of any number are
too large where light comes through a window. Of every scene, pictures are also rendered to 5, 2 and
1 %.

Exit code 1 unless at least 90 % of the true errors are within the bounds and the median of bound
over true error is at most 3. References are kept in DIR (out/error-references).
"""
import argparse
import concurrent.futures
import hashlib
import json
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time

import error_scenes
import error_tables
import error_truth
import hard_scenes

TOP = pathlib.Path(__file__).resolve().parents[2]
FINER = 10  # of the references, in patches
REFERENCE_RAYS = 512  # form-factor rays per patch of a reference, at least those of the settings
REFERENCE_PATHS = 1024  # per pixel of a reference picture
# Reference pictures are doubled in number until each true error is known to this share of itself or
# of its bound.
SURE, MOST_REFERENCES = 0.1, 32
MOST_PATCHES = 100000  # of a reference solution: 5 GB
HARD = ("small emitter", "sun spot", "pinhole", "baffle")


class Bench:
    """The program, and a folder for its files."""

    def __init__(self, program, folder, cache, seed):
        self.program, self.folder, self.cache, self.seed = program, folder, cache, seed
        self.reader = program.parent / "tests" / "validation" / "earthshine_surfaces"

    def json(self, *words):
        run = subprocess.run([self.program, *map(str, words), "-q", "--json", "-j", "1"], cwd=self.folder,
                             stdin=subprocess.DEVNULL, capture_output=True, text=True)
        if run.returncode not in (0, 3):  # 3: wanted error not reached, which is under test
            raise RuntimeError(f"{' '.join(map(str, words))}: {run.stderr.strip()}")
        return json.loads(run.stdout)

    def scene(self, name, source, more):
        """(path, text for the key of its references) of a scene given as a file or as text."""
        if isinstance(source, pathlib.Path):
            # Without its quality settings, which would fix values under test.
            text = re.sub(r"^\[quality\]\n(.+\n)*", "", source.read_text(), flags=re.MULTILINE)
            folder = self.folder / name.replace("/", "-").replace(" ", "-")  # cases run in parallel
            folder.mkdir(exist_ok=True)
            meshes = sorted(source.parent.glob("meshes/*"))
            if meshes and not (folder / "meshes").exists():
                (folder / "meshes").symlink_to(source.parent / "meshes")
            (folder / source.name).write_text(text)
            return folder / source.name, "".join([text, *map(str, more), *(hash_of(m.read_bytes()) for m in meshes)])
        path = self.folder / (name.replace(" ", "-") + ".toml")
        path.write_text(source)
        return path, source

    def sources_seen(self, path, more):
        """Pixels in which a camera sample hit a source: with black surfaces nothing else emits."""
        black = []
        for material in self.json("inspect", path)["materials"]:
            for key in ("diffuse", "specular", "mirror", "transmit"):
                black += ["--set", f"material.{material['name']}.{key}=0"]
        out = path.with_name(f"{path.stem}-black.exr")
        self.json("render", path, "-o", out, "--indirect", "none", *more, *black,
                  *error_scenes.knobs(camera_samples=64))
        return [light > 0 for light in error_truth.picture(out)[0]]

    def folder_of(self, path, text, more):
        """Folder of the references of a scene, by what its pictures show."""
        folder = self.cache / hash_of(text, str(REFERENCE_PATHS), "no caustics")[:16]
        if not (folder / "seen").exists():
            folder.mkdir(parents=True, exist_ok=True)
            self.json("render", path, *more, "--indirect", "none", "--aov", "object", "-o", folder / "objects.exr")
            seen = json.dumps([int(one) for one in self.sources_seen(path, more)])
            keep(folder / "seen", lambda new: new.write_text(seen))
        return folder

    def pictures(self, folder, path, more, count):
        """Luminances of so many path-traced pictures."""
        found = []
        for k in range(1, count + 1):
            words = ["--indirect", "paths", "--no-caustics", *error_scenes.knobs(gather_rays=REFERENCE_PATHS), "--seed", 9000 + k]
            keep(folder / f"{k}.exr", lambda new: self.json("render", path, *words, *more, "-o", new))
            found.append(error_truth.picture(folder / f"{k}.exr")[0])
        return found

    def solutions(self, folder, path, patches, rays, asked):
        """Arguments of two reference solutions for earthshine_surfaces; empty if a scene needs too
        many patches."""
        if FINER * patches > MOST_PATCHES:
            return []
        errors = [float(value) for setting in asked for key, value in zip(*[iter(error_scenes.ASKED[setting])] * 2) if key == "--error"]
        words = error_scenes.knobs(max_patches=rounded_up(FINER * patches), form_factor_rays=max(REFERENCE_RAYS, rays), refine="true")
        words = ["--error", str(min(errors) / 2)] if errors else words
        found = [[folder / f"{hash_of(*words)[:16]}-{k}.h5", 9000 + k, *overrides(words)] for k in (1, 2)]
        for solution, seed, *_ in found:
            keep(solution, lambda new: self.json("solve", path, *words, "--seed", seed, "-o", new))
        return found

    def true_errors(self, folder, path, more, judged):
        """Tests pictures, given as (luminances, bound), against as many references as they need."""
        _, things = error_truth.picture(folder / "objects.exr", "object")
        count = 2
        while True:
            first, second, *others = self.pictures(folder, path, more, count)
            seen = with_neighbours(json.loads((folder / "seen").read_text()), error_truth.columns(folder / "1.exr"))
            counts = [float(thing >= 0 and not source) for thing, source in zip(things, seen)]
            found = [error_truth.compare(light, first, second, counts, others) for light, _ in judged]
            if count >= MOST_REFERENCES or all(error_tables.relative_uncertainty(one, bound) <= SURE for one, (_, bound) in zip(found, judged)):
                return found
            count *= 2

    def rows(self, name, source, more, asked):
        """Runs all tests of one scene."""
        path, text = self.scene(name, source, more)
        runs = []
        for setting in asked:
            words = error_scenes.ASKED[setting] + ["--seed", self.seed]
            stem = self.folder / f"{name} {setting}".replace(" ", "-").replace("/", "-")
            of_picture = setting in error_scenes.PICTURES
            solved = None if of_picture else self.json("solve", path, *words, "-o", f"{stem}.h5")
            rendered = self.json("render", path, *words, *more, "-o", f"{stem}.exr")
            runs.append((setting, stem, solved, rendered))
        solves = [solved for _, _, solved, _ in runs if solved]
        patches = max((solved["patches"] for solved in solves), default=MOST_PATCHES)
        rays = max((solved["rays"] // max(1, solved["patches"]) for solved in solves), default=0)
        folder = self.folder_of(path, text, more)
        solutions = self.solutions(folder, path, patches, power_of_two(rays),
                                   [one for one in asked if one not in error_scenes.PICTURES])
        lights = [(error_truth.picture(f"{stem}.exr")[0], rendered["error"]["bound_95"] or 0.0) for _, stem, _, rendered in runs]
        found = []
        for (setting, stem, solved, rendered), of_picture in zip(runs, self.true_errors(folder, path, more, lights)):
            own = [f"{stem}.h5", self.seed, *overrides(error_scenes.ASKED[setting])]
            truths = [("picture", rendered, of_picture)]
            if solutions and solved:
                surface = error_truth.radiosities(self.reader, path, [own, *solutions])
                truths.insert(0, ("solve", solved, error_truth.compare(*surface)))
            for kind, report, truth in truths:
                error = report["error"]
                if truth.mean == 0:
                    continue  # no pixel counts
                parts = {key: part["estimate"] for key, part in error["parts"].items()}
                found.append(error_tables.Row(kind, name, setting, report["patches"], error["estimate"] or 0.0,
                                 error["bound_95"] or 0.0, parts, truth))
        return found


def cases(quick):
    """All scenes and settings, as error_scenes.cases()."""
    yield from error_scenes.cases(quick)
    for hard in [] if quick else hard_scenes.all_of_them():
        if hard.name in HARD:
            yield hard.name, hard.text, [], ["error 0.05", "few form-factor rays"]


def keep(path, make):
    """Makes the file unless it exists; an existing file is complete."""
    if not path.exists():
        new = path.with_name(f"new-{os.getpid()}-{path.name}")
        make(new)
        new.replace(path)


def hash_of(*what):
    digest = hashlib.sha256()
    for one in what:
        digest.update(one if isinstance(one, bytes) else str(one).encode())
    return digest.hexdigest()


def with_neighbours(seen, columns):
    """Also the neighbours of pixels that show a source: only one picture's samples may hit a sliver
    of it there, which would dominate the difference."""
    near = [False] * len(seen)
    for k, is_seen in enumerate(seen):
        for x in range(max(0, k % columns - 1), min(columns, k % columns + 2)) if is_seen else ():
            for row in range(max(0, k // columns - 1), min(len(seen) // columns, k // columns + 2)):
                near[row * columns + x] = True
    return near


def overrides(words):
    """The --set and --error arguments, as KEY=VALUE."""
    given = {"--set": "", "--error": "quality.error="}
    return [given[key] + value for key, value in zip(words[::2], words[1::2])]


def power_of_two(number):
    return 1 << max(0, math.ceil(math.log2(max(1, number))))


def rounded_up(number):
    """Rounded to a power of the root of two, so that a program with slightly different patches
    finds its references."""
    return math.ceil(2 ** (math.ceil(2 * math.log2(number)) / 2))


def main():
    parser = argparse.ArgumentParser(description="are the stated errors honest?")
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("--quick", action="store_true", help="a few scenes")
    parser.add_argument("--only", action="append", help="the scene of this name")
    parser.add_argument("--cache", type=pathlib.Path, default=TOP / "out" / "error-references")
    parser.add_argument("--seed", type=int, default=1, help="of the runs that are judged")
    parser.add_argument("-j", "--jobs", type=int, default=os.cpu_count())
    call = parser.parse_args()
    rows = []
    with tempfile.TemporaryDirectory(prefix="errors-") as folder:
        bench = Bench(call.program.resolve(), pathlib.Path(folder), call.cache.resolve(), call.seed)
        (bench.folder / "flood.ies").write_text(error_scenes.IES)
        chosen = [case for case in cases(call.quick) if not call.only or case[0] in call.only]
        started = time.monotonic()
        with concurrent.futures.ThreadPoolExecutor(call.jobs) as pool:
            for k, found in enumerate(pool.map(lambda case: bench.rows(*case), chosen)):
                rows += found
                print(f"{k + 1} of {len(chosen)} scenes, {time.monotonic() - started:.0f} s: {chosen[k][0]}", file=sys.stderr)
                for row in found:
                    print(f"  {row.kind:8}{row.asked:22}{error_tables.percent(row.truth.error):>9} bound {error_tables.percent(row.bound):>8}, "
                          f"ratio {row.ratio:.2f}", file=sys.stderr, flush=True)
    return 0 if error_tables.write(rows) else 1


if __name__ == "__main__":
    sys.exit(main())
