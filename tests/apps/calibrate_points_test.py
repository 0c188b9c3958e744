#!/usr/bin/env python3
"""Runs `stereomotion calibrate` on control points: each error and warning by its name.

Usage: calibrate_points_test.py PATH/TO/stereomotion [unittest options]
"""

import json
import math
import os
import random
import re
import subprocess

import calibrate_case
from calibrate_case import FOCAL_PX, SIGMA_PX, Case, observe, points_target, scattered


class ControlPoints(Case):
    def setUp(self):
        super().setUp()
        self.points = scattered(30)

    def test_good(self):
        self.measured(points_target(self.points), observe(self.points),
                      "check_points: [P03, P07]\n")
        result = self.done()
        self.assertNotIn("outliers", result.stderr)
        self.assertTrue(result.stdout.endswith("rig.yaml\ncalibration.html\n"))
        found = re.findall(r"fx ([\d.]+) ± ([\d.]+)", result.stdout)
        self.assertEqual(len(found), 2)
        for value, sigma in found:  # 5 sigma: one false alarm in a million
            self.assertLess(abs(float(value) - FOCAL_PX), 5 * float(sigma))
            self.assertLess(float(sigma), 0.01 * FOCAL_PX)
        self.assertIn("over 2, expected", result.stdout)
        names = {w["name"] for w in json.loads(self.outputs()["calibration.json"])["warnings"]}
        self.assertEqual(names, set(re.findall(r"warning: (\w+): ", result.stderr)))

    def test_same_bytes_again_and_former_rig_kept(self):
        self.measured(points_target(self.points), observe(self.points))
        self.done()
        first = self.outputs()
        self.assertIn(b"2023-11-14T22:13:20Z", first["rig.yaml"])
        self.assertIn("rig.yaml.old", self.done().stderr)
        second = self.outputs()
        self.assertEqual(second.pop("rig.yaml.old"), first["rig.yaml"])
        self.assertEqual(second, first)

    def test_too_few_points(self):
        few = dict(list(self.points.items())[:5])
        self.measured(points_target(few), observe(few))
        self.refused(2, "frame.yaml", "5 points", "6 or more")
        seen = observe(self.points)
        seen["cam1"] = seen["cam1"][:5]
        self.measured(points_target(self.points), seen)
        self.refused(1, "frame.yaml: no calibration: too_few_points: camera cam1: sees 5 control")

    def test_coplanar(self):
        flat = scattered(12, (250, 200, 0))
        self.measured(points_target(flat), observe(flat))
        self.refused(2, "points in one plane", "raise some of them")
        self.measured(points_target({**flat, "up": (0, 0, 200), "down": (50, 0, -200)}),
                      observe(flat))
        self.refused(1, "coplanar: camera cam0", "add points off the plane")

    def test_wrong_units(self):
        metres = {name: tuple(x / 1000 for x in p) for name, p in self.points.items()}
        self.measured(points_target(metres), observe(self.points))
        self.refused(2, "metres?")
        # Centimetres of a frame of 50 m, say: nothing in the file is wrong, the distance is.
        huge = {name: tuple(x * 100 for x in p) for name, p in self.points.items()}
        self.measured(points_target(huge), observe(self.points))
        self.done("implausible_distance")

    def test_mirrored(self):
        mirrored = {name: (-x, y, z) for name, (x, y, z) in self.points.items()}
        self.measured(points_target(mirrored), observe(self.points))
        self.refused(1, "mirrored: ")

    def test_mislabelled(self):
        names = list(self.points)
        shifted = dict(zip(names[7:] + names[:7], self.points.values()))
        self.measured(points_target(shifted), observe(self.points))
        self.refused(1, "mislabelled: camera cam0", "are ids exchanged")

    def test_two_exchanged_ids_are_outliers(self):
        seen = observe(self.points)
        exchange = {"P04": "P11", "P11": "P04"}
        seen["cam0"] = [(exchange.get(name, name), *rest) for name, *rest in seen["cam0"]]
        self.measured(points_target(self.points), seen)
        text = self.done("outliers").stderr
        self.assertIn("P04", text)
        self.assertIn("P11", text)

    def test_intrinsics_reduced(self):
        for count in (6, 10):
            some = scattered(count)
            self.measured(points_target(some), observe(some))
            self.assertIn(f"{count} points cannot carry all of",
                          self.done("intrinsics_reduced").stderr)

    def test_no_depth_variation(self):
        flat = scattered(30, (250, 200, 15))
        self.measured(points_target(flat), observe(flat))
        text = self.done("no_depth_variation", "weak_focal_length").stderr
        self.assertIn("focal length and distance are not separable", text)

    def test_poor_coverage(self):
        small = scattered(30, (60, 60, 60))
        self.measured(points_target(small), observe(small))
        self.done("poor_coverage")

    def test_image_noise_and_survey_sigma(self):
        self.measured(points_target(self.points), observe(self.points, 4, noise_px=10 * SIGMA_PX))
        self.done("image_noise")
        moved = {name: tuple(x + random.Random(name).gauss(0, 1) for x in p)
                 for name, p in self.points.items()}
        self.measured(points_target(moved), observe(self.points, 4))
        self.done("survey_sigma")

    def test_systematic_residuals(self):
        """A picture bent as no lens of this model bends it."""
        dense = scattered(250)
        seen = {camera: [(name, u + 2 * math.sin(u / 40), v + 2 * math.sin(u / 30), view)
                         for name, u, v, view in rows] for camera, rows in observe(dense).items()}
        self.measured(points_target(dense), seen)
        self.assertIn("refraction or a wrong lens model", self.done("systematic_residuals").stderr)

    def test_unknown_id_and_wrong_use(self):
        self.measured(points_target(self.points), observe({"Q01": (0, 0, 0), **self.points}))
        self.refused(2, "cam0.csv:2", "Q01")
        self.measured(points_target(self.points), observe(self.points), "check_points: [P99]\n")
        self.refused(2, "frame.yaml", "P99")
        (self.dir / "frame.yaml").unlink()
        self.refused(2, "frame.yaml: cannot be read")
        self.refused(2, "--threads", arguments=("--threads", "999"))

    def test_outputs_not_writable(self):
        self.measured(points_target(self.points), observe(self.points))
        self.refused(2, "none does not exist", arguments=("--output", "none/rig.yaml"))
        self.refused(2, "expected a file", arguments=("--report", "."))
        self.refused(3, "/proc/rig.yaml: cannot be written",
                     arguments=("--output", "/proc/rig.yaml"))
        if os.path.exists("/dev/full"):
            self.refused(3, "No space left", arguments=("--output", "/dev/full"))

    def test_disk_full(self):
        """The rig is written whole, or the one before is there."""
        self.measured(points_target(self.points), observe(self.points))
        self.done()
        (self.dir / "disk").mkdir()
        script = ('mount -t tmpfs -o size=16k tmpfs disk || exit 99; cp rig.yaml disk; "$@"; '
                  "code=$?; cp disk/rig.yaml* .; exit $code")
        result = subprocess.run(
            ["unshare", "-rm", "sh", "-c", script, "sh", Case.program, "calibrate", "frame.yaml",
             "--output", "disk/rig.yaml", "--report", "disk/report.html"], cwd=self.dir, text=True,
            capture_output=True, timeout=60, check=False)
        if result.returncode == 99 or "unshare" in result.stderr:
            self.skipTest("no small disk: unshare -rm and mount do not work here")
        self.assertEqual(result.returncode, 3, result.stderr)
        self.assertIn("No space left", result.stderr)
        whole = [text for name, text in self.outputs().items() if name.startswith("rig.yaml")]
        self.assertTrue(any(text.count(b"upper:") == 1 and text.endswith(b"\n") for text in whole))


if __name__ == "__main__":
    calibrate_case.main()
