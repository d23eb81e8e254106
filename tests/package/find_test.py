# SPDX-License-Identifier: Apache-2.0
"""usage: find_test.py CMAKE BUILD COMPILER SCENE

Installs the build into a folder, builds a project that links it by find_package(Earthshine), and renders with it and with the
installed program: both see the same light."""
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "cli"))
import exr  # noqa: E402

HERE = pathlib.Path(__file__).resolve().parent


def run(*call):
    return subprocess.run(list(map(str, call)), check=True, capture_output=True, text=True).stdout


def main(cmake, build, compiler, scene):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        run(cmake, "--install", build, "--prefix", folder / "prefix")
        run(cmake, "-S", HERE / "project", "-B", folder / "build", f"-DCMAKE_PREFIX_PATH={folder / 'prefix'}",
            f"-DCMAKE_CXX_COMPILER={compiler}", "-DCMAKE_BUILD_TYPE=Release")
        run(cmake, "--build", folder / "build")
        found = float(run(folder / "build" / "mean_luminance", scene))
        run(folder / "prefix" / "bin" / "earthshine", "render", scene, "--size", "16x16", "--indirect", "none", "--no-error", "-q",
            "-o", folder / "a.exr")
        channels = exr.read(folder / "a.exr")[3]
        pixels = len(channels["R"])
        told = sum(0.2126 * r + 0.7152 * g + 0.0722 * b for r, g, b in zip(*(channels[c] for c in "RGB"))) / pixels
        # The same samples: they differ by the digits that are printed.
        assert abs(found / told - 1) < 1e-4, (found, told)


if __name__ == "__main__":
    main(*sys.argv[1:])
