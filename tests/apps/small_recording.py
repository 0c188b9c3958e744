"""What the tests that measure a recording share: two small cameras, a body, how to run the program.

Python's standard library is all it takes.
"""

import csv
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

RIG = """format: stereomotion-rig/1
cameras:
  - name: cam0
    image_size_px: [640, 512]
    intrinsics: {fx_px: 800, fy_px: 800, cx_px: 320, cy_px: 256}
    distortion: [0, 0, 0, 0, 0]
    cam_from_world: {qw: 1, qx: 0, qy: 0, qz: 0, tx_mm: 200, ty_mm: 0, tz_mm: 1500}
  - name: cam1
    image_size_px: [640, 512]
    intrinsics: {fx_px: 800, fy_px: 800, cx_px: 320, cy_px: 256}
    distortion: [0, 0, 0, 0, 0]
    cam_from_world: {qw: 1, qx: 0, qy: 0, qz: 0, tx_mm: -200, ty_mm: 0, tz_mm: 1500}
"""
NOISE = "noise: {gain_e_per_dn: 58.8, read_e: 8, black_dn: 0, saturation_dn: 255}\n"
BODY = """format: stereomotion-body/1
name: body
rods:
  - name: A
    ball_diameter_mm: 20
    balls_mm: [[-150,-60,0],[-110,-60,0],[-55,-60,0],[15,-60,0],[100,-60,0]]
  - name: B
    ball_diameter_mm: 20
    balls_mm: [[-140,60,30],[-60,66,36],[-20,69,39],[35,73.125,43.125],[140,81,51]]
"""

program = None  # what is tested; `main` takes it from the command line


def run(*arguments, cwd, timeout=120, **options):
    return subprocess.run([program, *map(str, arguments)], cwd=cwd, text=True,
                          capture_output=True, timeout=timeout, check=False, **options)


def rows(file):
    with open(file, newline="", encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


class FolderCase(unittest.TestCase):
    """A folder `base` for all tests of a class."""

    @classmethod
    def setUpClass(cls):
        cls.base = pathlib.Path(tempfile.mkdtemp(prefix="stereomotion-test-"))

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.base, ignore_errors=True)

    @classmethod
    def write(cls, **texts):
        """Writes NAME.yaml for every NAME=text."""
        for name, text in texts.items():
            (cls.base / f"{name}.yaml").write_text(text, encoding="utf-8")

    @classmethod
    def simulate(cls, scenario, output="rec"):
        cls.write(scenario=scenario)
        made = run("simulate", "scenario.yaml", "--output", output, cwd=cls.base)
        if made.returncode != 0:
            raise RuntimeError("simulate failed: " + made.stderr)


def main():
    global program
    program = os.path.abspath(sys.argv.pop(1))
    unittest.main("__main__", verbosity=1)
