#!/usr/bin/env python3
"""Runs `stereomotion calibrate` on rendered captures of known rigs, and tracks with the result.

Usage: calibrate_data_test.py PATH/TO/stereomotion PATH/TO/shared/data [unittest options]
$STEREOMOTION_SHARED_DATA goes before that path.
"""

import math
import os
import pathlib
import re
import subprocess
import sys

import calibrate_case
from calibrate_case import Case

DATA = None


def focal_lengths(rig):
    return [float(f) for f in re.findall(r"fx_px: ([\d.]+)", rig.read_text())]


class Rendered(Case):
    def run_program(self, *arguments):
        result = subprocess.run([Case.program, *map(str, arguments)], cwd=self.dir, text=True,
                                capture_output=True, timeout=120, check=False)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result

    def capture(self, name):
        folder = DATA / "rendered" / name
        if not folder.is_dir():
            print(f"skipped: {folder} is not there")
            self.skipTest(f"{folder} is not there")
        self.folder = folder
        return self.run_program("calibrate", folder / "frame.yaml")

    def check_focal_lengths(self, stdout):
        """Against the truth: within 4 of the stated sigmas."""
        truth = focal_lengths(self.folder / "truth/rig.yaml")
        stated = re.findall(r"fx ([\d.]+) ± ([\d.]+)", stdout)
        self.assertEqual(len(stated), len(truth))
        for (value, sigma), true in zip(stated, truth):
            self.assertLess(abs(float(value) - true), 4 * float(sigma))

    def test_points_then_track(self):
        result = self.capture("calib_points")
        self.assertIn("120 of 120", result.stdout)
        self.check_focal_lengths(result.stdout)
        easy = DATA / "rendered/easy"
        self.run_program("track", "--left", easy / "cam0", "--right", easy / "cam1", "--body",
                         easy / "body.yaml", "--fps", "30", "--output", "run")
        rows = (self.dir / "run/poses.csv").read_text().splitlines()
        self.assertTrue(all(row.split(",")[2] == "ok" for row in rows[1:]))

    def test_wrong_coordinate_is_named(self):
        """P05 is 100 mm off in the file: it is left out, and not silently."""
        self.capture("calib_points")
        frame = (self.folder / "frame.yaml").read_text().replace("[119.3481,", "[219.3481,")
        for camera in ("cam0", "cam1"):
            frame = frame.replace(f"images: {camera}", f"images: {self.folder}/{camera}")
            frame = frame.replace(f"seeds: {camera}", f"seeds: {self.folder}/{camera}")
        (self.dir / "wrong.yaml").write_text(frame)
        result = self.run_program("calibrate", "wrong.yaml", "--output", "wrong_rig.yaml")
        self.assertRegex(result.stderr, r"points_not_found: .*cam1/000001\.png: .* P05:")
        self.assertIn("116 of 116", result.stdout)

    def test_tags(self):
        result = self.capture("calib_tags")
        used, seen = map(int, re.search(r"used +(\d+) of (\d+)", result.stdout).groups())
        self.assertEqual(seen, 2880)
        self.assertGreater(used, 0.99 * seen)
        self.check_focal_lengths(result.stdout)

    def test_wand(self):
        result = self.capture("calib_wand")
        self.assertTrue(math.isfinite(focal_lengths(self.dir / "rig.yaml")[0]))
        self.check_focal_lengths(result.stdout)
        self.assertIn("no_depth_variation", result.stderr)


if __name__ == "__main__":
    DATA = pathlib.Path(os.environ.get("STEREOMOTION_SHARED_DATA", sys.argv.pop(2))).resolve()
    calibrate_case.main()
