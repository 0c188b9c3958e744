#!/usr/bin/env python3
"""Runs `stereomotion convert` from format to format: exit codes, messages, and the same rig again.

Usage: convert_test.py PATH/TO/stereomotion [unittest options]
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

PROGRAM = None

RIG = """format: stereomotion-rig/1
cameras:
  - name: cam0
    image_size_px: [640, 512]
    intrinsics: {fx_px: 800.5, fy_px: 801, cx_px: 320, cy_px: 256}
    distortion: [%s]
    cam_from_world: {qw: 1, qx: 0, qy: 0, qz: 0, tx_mm: 200, ty_mm: 0, tz_mm: 1500}
  - name: cam1
    image_size_px: [640, 512]
    intrinsics: {fx_px: 800, fy_px: 800, cx_px: 310, cy_px: 250}
    distortion: [%s]
    cam_from_world: {qw: 0.8, qx: 0, qy: 0.6, qz: 0, tx_mm: -200, ty_mm: 10, tz_mm: 1500}
covariance: {parameters: [cam0.fx_px, cam1.tx_mm], upper: [0.09, 0.01, 0.04]}
"""
NONE = "0, 0, 0, 0, 0"
RADIAL = "-0.1, 0.02, 0.001, 0.0005, 0"
FULL = "-0.1, 0.02, 0.001, 0.0005, 0.03"


def numbers(text):
    """All numbers of a rig file's cameras, without its notes."""
    text = re.sub("#.*|covariance:(.|\n)*|calibration:(.|\n)*", "", text)
    return [float(n) for n in re.findall(r"(?<![\w.])-?\d+\.?\d*(?:e-?\d+)?", text)]


class Convert(unittest.TestCase):
    def setUp(self):
        self.dir = pathlib.Path(tempfile.mkdtemp(prefix="stereomotion-test-"))
        self.write("rig.yaml", RIG % (RADIAL, RADIAL))

    def tearDown(self):
        shutil.rmtree(self.dir, ignore_errors=True)

    def write(self, name, text):
        (self.dir / name).write_text(text)

    def convert(self, *arguments):
        return subprocess.run([PROGRAM, "convert", *arguments], cwd=self.dir, text=True,
                              capture_output=True, timeout=60, check=False)

    def done(self, *arguments):
        result = self.convert(*arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result

    def refused(self, code, *texts, arguments):
        result = self.convert(*arguments)
        self.assertEqual(result.returncode, code, result.stderr)
        for text in texts:
            self.assertIn(text, result.stderr)

    def same(self, first, second, places=9):
        one = numbers((self.dir / first).read_text())
        other = numbers((self.dir / second).read_text())
        self.assertEqual(len(one), len(other))
        self.assertGreater(len(one), 30)
        for a, b in zip(one, other):
            self.assertAlmostEqual(a, b, places)

    def test_there_and_back(self):
        """Formats without a world start from a rig whose world is cam0."""
        self.done("rig.yaml", "--to", "opencv-xml", "--output", "world.xml")
        self.done("world.xml", "--to", "rig", "--output", "cam0.yaml")
        for to, name in (("opencv-yaml", "a.yml"), ("opencv-xml", "a.xml"),
                         ("kalibr", "a.yaml"), ("anipose", "a.toml")):
            self.done("cam0.yaml", "--to", to, "--output", name)
            self.done(name, "--to", "rig", "--output", to + "-back.yaml")
            self.same("cam0.yaml", to + "-back.yaml")
        self.done("cam0.yaml", "--to", "ros", "--output", "ros")
        self.done("ros/left.yaml", "ros/right.yaml", "--to", "rig", "--output", "ros-back.yaml")
        self.same("cam0.yaml", "ros-back.yaml")

    def test_own_format_keeps_covariance_and_origin(self):
        result = self.done("rig.yaml", "--to", "rig", "--output", "copy.yaml")
        self.assertEqual(result.stdout, "copy.yaml\n")
        text = (self.dir / "copy.yaml").read_text()
        self.assertIn("upper: [0.09, 0.01,", text)
        self.assertIn('source: "rig.yaml"', text)
        self.same("rig.yaml", "copy.yaml")

    def test_losses_are_told(self):
        result = self.done("rig.yaml", "--to", "kalibr", "--output", "k.yaml")
        self.assertIn("Kalibr's format holds no covariance", result.stderr)
        self.assertIn("holds no world; it becomes the frame of cam0", result.stderr)
        self.write("full.yaml", RIG % (FULL, RADIAL))
        self.refused(2, "k3 of camera cam0", "--drop-distortion",
                     arguments=("full.yaml", "--to", "kalibr", "--output", "x.yaml"))
        self.assertFalse((self.dir / "x.yaml").exists())

    def test_dlt(self):
        to_dlt = ("rig.yaml", "--to", "dlt", "--output", "dlt.csv")
        self.refused(2, "the distortion of camera cam0", "--drop-distortion", arguments=to_dlt)
        self.assertIn("is left out", self.done(*to_dlt, "--drop-distortion").stderr)
        self.assertEqual((self.dir / "dlt.csv").read_text().count("\n"), 11)
        self.write("plain.yaml", RIG % (NONE, NONE))
        for pixels in ("zero-based", "dltdv8", "dltdv5"):
            self.done("plain.yaml", "--to", "dlt", "--output", "dlt.csv", "--dlt-pixels", pixels,
                      "--force")
            self.done("--image-size", "640x512", "--image-size", "640x512", "dlt.csv", "--to", "rig",
                      "--output", "back.yaml", "--dlt-pixels", pixels, "--force")
            self.same("plain.yaml", "back.yaml", 6)
        self.refused(2, "v counts upwards", "--dlt-pixels dltdv5",
                     arguments=("dlt.csv", "--to", "rig", "--output", "x", "--image-size",
                                "640x512"))

    def test_dlt_needs_image_size(self):
        self.write("plain.yaml", RIG % (NONE, NONE))
        self.done("plain.yaml", "--to", "dlt", "--output", "dlt.csv")
        self.refused(2, "give --image-size", arguments=("dlt.csv", "--to", "rig", "--output", "x"))
        for size in ("640", "640x", "x512", "640x512x3", "0x512", "-1x5", "640,512"):
            self.refused(2, f"--image-size: found '{size}'", "1280x1024",
                         arguments=("dlt.csv", "--to", "rig", "--output", "x",
                                    "--image-size=" + size))
        self.refused(2, "--image-size is not used here",
                     arguments=("rig.yaml", "--to", "rig", "--output", "x", "--image-size", "6x5"))
        self.refused(2, "2.12e+06 mm apart",
                     arguments=("dlt.csv", "--to", "anipose", "--output", "x", "--image-size",
                                "640x512", "--dlt-unit", "m"))

    def test_file_that_is_no_rig_alone(self):
        self.done("rig.yaml", "--to", "ros", "--output", "ros")
        self.refused(2, "one camera of a ROS pair", "convert left.yaml right.yaml",
                     arguments=("ros/left.yaml", "--to", "rig", "--output", "x"))

    def test_output_exists(self):
        self.write("there.yaml", "mine")
        arguments = ("rig.yaml", "--to", "rig", "--output", "there.yaml")
        self.refused(2, "there.yaml: exists; give --force", arguments=arguments)
        self.assertEqual((self.dir / "there.yaml").read_text(), "mine")
        self.done(*arguments, "--force")
        self.refused(2, "is the input",
                     arguments=("rig.yaml", "--to", "kalibr", "--output", "rig.yaml", "--force"))
        self.done("rig.yaml", "--to", "ros", "--output", "ros")
        self.refused(2, "left.yaml: exists", arguments=("rig.yaml", "--to", "ros", "--output",
                                                        "ros"))
        self.refused(2, "is a folder", arguments=("rig.yaml", "--to", "rig", "--output", "ros"))
        self.refused(2, "expected a folder",
                     arguments=("rig.yaml", "--to", "ros", "--output", "there.yaml"))

    def test_output_not_writable(self):
        self.refused(3, "/proc/x: cannot be written",
                     arguments=("rig.yaml", "--to", "rig", "--output", "/proc/x"))
        self.refused(3, "/proc/x", arguments=("rig.yaml", "--to", "ros", "--output", "/proc/x"))
        self.refused(3, "none/x: cannot be written",
                     arguments=("rig.yaml", "--to", "rig", "--output", "none/x"))
        if os.path.exists("/dev/full"):
            self.refused(3, "No space left",
                         arguments=("rig.yaml", "--to", "rig", "--output", "/dev/full"))

    def test_wrong_use(self):
        self.refused(2, "nowhere.yaml: cannot be read",
                     arguments=("nowhere.yaml", "--to", "rig", "--output", "x"))
        self.refused(2, "--to", arguments=("rig.yaml", "--to", "matlab", "--output", "x"))
        self.refused(2, "--output", arguments=("rig.yaml", "--to", "rig"))
        self.refused(2, "a ROS camera_info file",
                     arguments=("rig.yaml", "rig.yaml", "--to", "kalibr", "--output", "x"))
        self.assertIn("stereomotion convert rig.yaml", self.done("--help").stdout)


if __name__ == "__main__":
    PROGRAM = os.path.abspath(sys.argv.pop(1))
    unittest.main(verbosity=1)
