# SPDX-License-Identifier: Apache-2.0
"""The layer check finds each planted error, and none in a clean tree."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

CHECK = pathlib.Path(__file__).parent.parent / "check_layers.py"
LICENCE = "// SPDX-License-Identifier: Apache-2.0\n"


class CheckLayers(unittest.TestCase):
    def outcome(self, files):
        with tempfile.TemporaryDirectory() as folder:
            for name, text in files.items():
                path = pathlib.Path(folder, name)
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text)
            run = subprocess.run([sys.executable, CHECK, folder], capture_output=True, text=True)
            return run.returncode, run.stdout

    def faulty(self, name, text, complaint):
        code, out = self.outcome({"base/fine.cpp": LICENCE, name: LICENCE + text})
        self.assertEqual((code, len(out.splitlines())), (1, 1), out)
        self.assertIn(name, out)
        self.assertIn(complaint, out)

    def test_clean_tree_passes(self):
        text = (LICENCE + '#include <cstdio>\n#include "base/error.h"\n// std::cout << 1; exit(0)\n'
                'const char* s = "printf(";\nint n = std::snprintf(b, 2, "x");\nvoid f() { on_exit(1); }\n')
        self.assertEqual(self.outcome({"scenes/a.cpp": text, "app/b.cpp": LICENCE + "std::cout << 1;\n"}),
                         (0, ""))

    def test_empty_tree_fails(self):
        self.assertEqual(self.outcome({})[0], 1)

    def test_upward_include(self):
        self.faulty("radiosity/a.cpp", '\n#include "degrade/parts/iris.h"\n',
                    "a.cpp:3: radiosity may not include degrade/parts/iris.h")

    def test_include_of_a_later_room(self):
        self.faulty("radiosity/patches/a.cpp", '#include "radiosity/solution.h"\n',
                    "room radiosity/patches may not include radiosity/solution.h")
        self.assertEqual(self.outcome({"radiosity/a.cpp": LICENCE + '#include "radiosity/patches/split.h"\n'}),
                         (0, ""))

    def test_every_room_may_include_the_constants_of_its_floor(self):
        text = LICENCE + '#include "raytrace/tuning.h"\n'
        self.assertEqual(self.outcome({"raytrace/share/a.cpp": text}), (0, ""))
        self.assertEqual(self.outcome({"scenes/a.cpp": text})[0], 1)

    def test_unknown_room(self):
        self.faulty("scenes/attic/a.cpp", "", "scenes has no room attic; its rooms are")
        self.faulty("tests/scenes/attic/a_test.cpp", "", "scenes has no room attic; its rooms are")

    def test_full_room(self):
        files = {f"base/files/f{k}.h": LICENCE for k in range(20)}
        self.assertEqual(self.outcome(files), (0, ""))
        self.assertEqual(self.outcome(files | {"base/files/g.cpp": LICENCE}),
                         (1, "base/files: 21 files; at most 20: divide it\n"))

    def test_relative_include(self):
        self.faulty("radiosity/a.cpp", '#include "patches.h"\n', "name it from the top")

    def test_library_outside_its_owner(self):
        for name, include in {"raytrace/a.cpp": "embree3/rtcore.h", "scenes/a.h": "Eigen/Dense",
                              "degrade/a.cpp": "ImfRgba.h", "scenes/b.cpp": "tbb/parallel_for.h",
                              "base/c.cpp": "toml++/toml.h", "app/d.cpp": "png.h",
                              "base/e.cpp": "tiny_gltf.h", "degrade/f.cpp": "nlohmann/json.hpp",
                              "scenes/g.h": "CLI/CLI.hpp", "scenes/h.cpp": "tiny_gltf.h",
                              "radiosity/i.cpp": "hdf5.h", "base/j.cpp": "H5public.h"}.items():
            self.faulty(name, f"#include <{include}>\n", "may include")

    def test_libraries_do_not_print_or_exit(self):
        for line in ("std::cout << 1;", "printf(\"x\");", "std::fprintf(stderr, \"x\");", "exit(1);",
                     "fmt::print(\"x\");", "std::abort();"):
            self.faulty("base/a.cpp", f"void f() {{ {line} }}\n", "does not print or exit")

    def test_long_file(self):
        self.faulty("tests/base/a_test.cpp", "\n" * 500, "501 lines; at most 500")

    def test_missing_licence_line(self):
        code, out = self.outcome({"base/a.h": "#pragma once\n"})
        self.assertEqual((code, out), (1, "base/a.h:1: the first line must be the SPDX licence line\n"))


if __name__ == "__main__":
    unittest.main()
