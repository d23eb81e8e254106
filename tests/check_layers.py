#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Keeps the layers apart: base < scenes < radiosity < raytrace < degrade < studies < app < python, and their
rooms.

usage: check_layers.py [ROOT]

Fails on an upward include, a room that is too full or unknown, a library used outside its owner, a library that prints or exits, a file
that is too long, and a missing licence line. Prints one line per fault.
"""
import fnmatch
import pathlib
import re
import sys

# Floors, and the rooms of each: a file may include its own room and those before it. "." is the floor's own
# folder.
ROOMS = {
    "base": [".", "numbers", "ranks", "input", "files", "pixels"],
    "scenes": ["texture", ".", "view", "text", "reflect", "light", "mesh/gltf", "mesh", "sky", "time", "effects", "health", "round", "plausible", "read", "pose"],
    "radiosity": ["patches", "bodies", "factors", "objects", "direct", ".", "store", "exact/polygon",
                  "exact/occlusion", "exact"],
    "raytrace": ["camera", "frame", "light", "incoming", "surfaces", "solve_control", "paths", "share", "gather", "shade",
                 "witness", "adaptive", "."],
    "degrade": ["stage", "parts", "moments", ".", "settings", "range", "certify"],
    "studies": [".", "cost", "targets", "light", "sight", "why", "orbit",
                "compare", "accuracy"],
    "app": [".", "parts", "cctv", "call", "render", "tools", "study", "report", "views", "visibility", "compare",
            "accuracy", "console", "dataset"],
    "python": ["."],
}
LAYERS = list(ROOMS)
MOST_FILES = 20  # in a room
# Constants that every room of their floor may include.
FOR_ALL_ROOMS = {"raytrace/tuning.h"}

# Library -> (what its includes look like, the files that may use it).
OWNERS = {
    "Embree": (r"embree[34]?/", ["scenes/ray_query.cpp", "scenes/ray_structure.*"]),
    "Eigen": (r"Eigen/", ["radiosity/*", "degrade/*", "studies/*"]),
    "OpenEXR": (r"(OpenEXR/|Imath/|Imf|Imath|Iex|half\.h)", ["base/files/exr_*"]),
    "ERFA": (r"erfam?\.h", ["scenes/time/astronomy.cpp"]),
    "oneTBB": (r"(tbb|oneapi)/", ["base/parallel.cpp"]),
    "Open MPI": (r"mpi\.h", ["base/ranks/open_mpi.cpp"]),
    "toml++": (r"toml(\+\+|plusplus)", ["scenes/text/toml_file.cpp"]),
    "libpng": (r"png\.h", ["base/files/png_file.cpp", "base/pixels/png_pixels.cpp"]),
    "zlib": (r"zlib\.h", ["base/files/deflate.cpp"]),
    "libjpeg-turbo": (r"j(peglib|config|error|morecfg)\.h", ["base/pixels/jpeg_pixels.cpp"]),
    "tinygltf": (r"tiny_?gltf", ["scenes/mesh/gltf/*"]),
    "cpp-httplib": (r"httplib\.h", ["app/console/serve.cpp"]),
    "HDF5": (r"(hdf5(_hl)?|H5\w*)\.h", ["base/files/hdf5_handle.h"]),
    "CLI11": (r"CLI/", ["app/*"]),
    "pybind11": (r"pybind11/|Python\.h", ["python/module.cpp"]),
    "nlohmann-json": (r"nlohmann/", ["app/*", "scenes/mesh/gltf/json.cpp"]),
}

LINE_LIMIT = 500
# Files allowed up to LONGER_LIMIT lines, and why.
LONGER_LIMIT = 400
LONGER = {}

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
PRINTS = re.compile(
    r"\bstd::(cout|cerr|clog)\b|\bfmt::print\b"
    r"|(?<![\w.>])(?:std::|::)?(printf|fprintf|vprintf|puts|fputs|putchar|perror|exit|_exit|quick_exit|abort)\s*\(")


def code_lines(text):
    """Lines with comments and the contents of strings blanked out, line numbers kept."""
    pattern = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"', re.S)
    return pattern.sub(lambda m: re.sub(r"[^\n]", " ", m.group()), text).split("\n")


def owner_fault(name, include):
    for library, (pattern, owners) in OWNERS.items():
        if re.match(pattern, include):
            if not any(fnmatch.fnmatch(name, owner) for owner in owners):
                return f"only {', '.join(owners)} may include {library} ({include})"
    return None


def room_of(name):
    """The folder of a file below its floor; "." for the floor's own."""
    return "/".join(name.split("/")[1:-1]) or "."


def include_fault(layer, name, quote, include):
    if quote == "<":
        return None
    top = include.split("/")[0]
    if top not in LAYERS:
        return f'"{include}": name it from the top, as "{layer}/…"'
    if LAYERS.index(top) > LAYERS.index(layer):
        return f"{layer} may not include {include}"
    if top == layer and include not in FOR_ALL_ROOMS:
        here, there = room_of(name), room_of(include)
        rooms = ROOMS[layer]
        if here in rooms and there in rooms and rooms.index(there) > rooms.index(here):
            return f"room {layer}/{here} may not include {include}"
    return None


def check_layer_file(layer, name, text):
    faults = []
    for number, line in enumerate(text.split("\n"), 1):
        found = INCLUDE.match(line)
        if not found:
            continue
        for fault in (include_fault(layer, name, *found.groups()), owner_fault(name, found.group(2))):
            if fault:
                faults.append(f"{name}:{number}: {fault}")
    if layer != "app":
        for number, line in enumerate(code_lines(text), 1):
            found = PRINTS.search(line)
            if found:
                faults.append(f"{name}:{number}: a library does not print or exit ({found.group().strip()})")
    return faults


def check_form(name, text):
    faults = []
    lines = text.split("\n")
    if "SPDX-License-Identifier: Apache-2.0" not in "\n".join(lines[:2]):
        faults.append(f"{name}:1: the first line must be the SPDX licence line")
    count = text.count("\n")
    limit = LONGER_LIMIT if name in LONGER else LINE_LIMIT
    if name.endswith((".cpp", ".h")) and count > limit:
        faults.append(f"{name}: {count} lines; at most {limit}: split it by stage")
    return faults


def check_rooms(names):
    """Every source file stands in a known room that is not too full; tests stand where what they test does."""
    faults = []
    files = {}
    for name in names:
        floor, room = name.removeprefix("tests/").split("/")[0], room_of(name.removeprefix("tests/"))
        if floor not in ROOMS:
            continue
        files.setdefault(name.rsplit("/", 1)[0], []).append(name)
        if room not in ROOMS[floor]:
            faults.append(f"{name}: {floor} has no room {room}; its rooms are {', '.join(ROOMS[floor])}")
    for folder, inside in files.items():
        if len(inside) > MOST_FILES:
            faults.append(f"{folder}: {len(inside)} files; at most {MOST_FILES}: divide it")
    return faults


def check(root):
    faults = []
    scripts = [path for path in (root / "dev", root / ".ci" / "run") if path.exists()]
    sources = [path for folder in LAYERS + ["tests"] for pattern in ("*.cpp", "*.h", "*.py")
               for path in sorted((root / folder).rglob(pattern))]
    for path in scripts + sources:
        name = path.relative_to(root).as_posix()
        text = path.read_text(encoding="utf-8")
        faults += check_form(name, text)
        layer = name.split("/")[0]
        if layer in LAYERS and path.suffix in (".cpp", ".h"):
            faults += check_layer_file(layer, name, text)
    names = [path.relative_to(root).as_posix() for path in sources if path.suffix in (".cpp", ".h")]
    return faults + check_rooms(names), len(sources)


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent.parent)
    faults, count = check(root)
    for fault in faults:
        print(fault)
    if count == 0:
        print(f"{root}: no sources found")
    return 1 if faults or count == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
