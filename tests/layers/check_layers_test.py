#!/usr/bin/env python3
"""Proves that check_layers.py finds what it is there to find, on tiny trees, good and bad."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

import check_layers


class CheckLayersTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.root = pathlib.Path(self.folder.name)

    def write(self, path, *lines):
        file = self.root / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text("\n".join(lines) + "\n", encoding="utf-8")

    def violations(self):
        return check_layers.check_tree(self.root.resolve())[1]

    def assert_one_violation(self, start, part):
        found = self.violations()
        self.assertEqual(len(found), 1, found)
        self.assertTrue(found[0].startswith(start), found[0])
        self.assertIn(part, found[0])

    def test_allowed_includes(self):
        self.write("include/stereomotion/core/a.h", "#include <vector>", "#include <Eigen/Core>")
        self.write("include/stereomotion/pose/b.h", '#include "stereomotion/core/a.h"')
        self.write("src/pose/b.cc", '#include "stereomotion/pose/b.h"', "#include <opencv2/core.hpp>",
                   '#include "pose/helper.h"', '#include "helper.h"')
        self.write("src/pose/helper.h", '#include "stereomotion/camera/camera.h"')
        self.write("src/io/c.cc", '#include "stereomotion/simulation/scenario.h"')
        self.assertEqual(self.violations(), [])

    def test_layer_to_the_right(self):
        self.write("include/stereomotion/core/a.h", "", '#include "stereomotion/pose/b.h"')
        self.assert_one_violation("include/stereomotion/core/a.h:2:", "core includes")

    def test_source_file_and_spaces(self):
        self.write("src/camera/a.cc", '  #  include   "stereomotion/stereo/triangulate.h"')
        self.assert_one_violation("src/camera/a.cc:1:", "camera includes")

    def test_capture_sees_only_core(self):
        self.write("src/capture/a.cc", '#include "stereomotion/geometry/so3.h"')
        self.assert_one_violation("src/capture/a.cc:1:", "only core")

    def test_io_sees_no_stage_beside_the_chain(self):
        for other in ("pipeline/measure.h", "capture/x.h", "calibration/x.h", "simulation/render.h"):
            with self.subTest(other):
                self.write("src/io/a.cc", f'#include "stereomotion/{other}"')
                self.assert_one_violation("src/io/a.cc:1:", "io includes")

    def test_chain_sees_nothing_beside_it(self):
        for other in ("capture/x.h", "calibration/x.h", "simulation/x.h", "io/x.h"):
            with self.subTest(other):
                self.write("src/pipeline/a.cc", f'#include "stereomotion/{other}"')
                self.assert_one_violation("src/pipeline/a.cc:1:", "pipeline includes")

    def test_private_header_of_another_layer(self):
        self.write("src/stereo/assign.h")
        self.write("src/detection/a.cc", '#include "stereo/assign.h"')
        self.assert_one_violation("src/detection/a.cc:1:", "detection includes")

    def test_relative_path_is_no_way_round(self):
        self.write("src/stereo/assign.h")
        self.write("src/detection/a.cc", '#include "../stereo/assign.h"')
        self.assert_one_violation("src/detection/a.cc:1:", "detection includes")

    def test_private_header_in_public_one(self):
        self.write("src/pose/helper.h")
        self.write("include/stereomotion/pose/a.h", '#include "pose/helper.h"')
        self.assert_one_violation("include/stereomotion/pose/a.h:1:", "private")

    def test_uninstalled_spelling_in_public_header(self):
        self.write("include/stereomotion/pose/b.h")
        self.write("include/stereomotion/pose/a.h", '#include "b.h"')
        self.assert_one_violation("include/stereomotion/pose/a.h:1:", "stereomotion/pose/b.h")

    def test_library_in_public_header(self):
        for name in ("opencv2/core.hpp", "unistd.h", "nlohmann/json.hpp", "fmt/core.h"):
            with self.subTest(name):
                self.write("include/stereomotion/core/a.h", f"#include <{name}>")
                self.assert_one_violation("include/stereomotion/core/a.h:1:", name)

    def test_apps(self):
        self.write("apps/track.h")
        for name in ("apps/track.h", "track.h", "../../apps/track.h"):
            with self.subTest(name):
                self.write("src/pipeline/a.cc", f'#include "{name}"')
                self.assert_one_violation("src/pipeline/a.cc:1:", "nothing includes apps")

    def test_unknown_layer(self):
        self.write("src/utils/a.cc")
        self.assert_one_violation("src/utils/a.cc:1:", "no layer's folder")

    def test_exit_codes(self):
        def run():
            return subprocess.run([sys.executable, check_layers.__file__, self.root],
                                  capture_output=True, text=True, check=False)

        self.assertEqual(run().returncode, 2, "an empty tree proves nothing")
        self.write("src/core/a.cc")
        self.assertEqual(run().returncode, 0)
        self.write("src/core/a.cc", '#include "stereomotion/pipeline/measure.h"')
        result = run()
        self.assertEqual(result.returncode, 1)
        self.assertIn("src/core/a.cc:1:", result.stdout)


if __name__ == "__main__":
    unittest.main()
