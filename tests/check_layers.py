#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Keeps the layers apart: base < scenes < radiosity < raytrace < degrade < studies < app.

usage: check_layers.py [ROOT]

Fails on an upward include, a library used outside its owner, a library that prints or exits, a file
that is too long, and a missing licence line. Prints one line per fault.
"""
import fnmatch
import pathlib
import re
import sys

# Each may include itself and those before it.
LAYERS = ["base", "scenes", "radiosity", "raytrace", "degrade", "studies", "app"]

# Library -> (what its includes look like, the files that may use it).
OWNERS = {
    "Embree": (r"embree[34]?/", ["scenes/ray_query.cpp"]),
    "Eigen": (r"Eigen/", ["radiosity/*", "degrade/*"]),
    "OpenEXR": (r"(OpenEXR/|Imath/|Imf|Imath|Iex|half\.h)", ["base/exr_*"]),
    "oneTBB": (r"(tbb|oneapi)/", ["base/parallel.cpp"]),
    "toml++": (r"toml(\+\+|plusplus)", ["scenes/toml_file.cpp"]),
    "libpng": (r"png\.h", ["base/png_file.cpp", "base/png_reader.cpp"]),
    "tinygltf": (r"tiny_?gltf", ["scenes/gltf_model.cpp", "scenes/gltf_writer.cpp"]),
    "HDF5": (r"(hdf5(_hl)?|H5\w*)\.h", ["base/hdf5_handle.h"]),
    "CLI11": (r"CLI/", ["app/*"]),
    "nlohmann-json": (r"nlohmann/", ["app/*"]),
}

LINE_LIMIT = 300
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


def include_fault(layer, quote, include):
    if quote == "<":
        return None
    top = include.split("/")[0]
    if top not in LAYERS:
        return f'"{include}": name it from the top, as "{layer}/…"'
    if LAYERS.index(top) > LAYERS.index(layer):
        return f"{layer} may not include {include}"
    return None


def check_layer_file(layer, name, text):
    faults = []
    for number, line in enumerate(text.split("\n"), 1):
        found = INCLUDE.match(line)
        if not found:
            continue
        for fault in (include_fault(layer, *found.groups()), owner_fault(name, found.group(2))):
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
    return faults, len(sources)


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
