#!/usr/bin/env python3
"""Runs `stereomotion print-target`: the drawing, what is refused, and what is not overwritten.

Usage: print_target_test.py PATH/TO/stereomotion [unittest options]
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree

PROGRAM = None
SOURCE = pathlib.Path(__file__).resolve().parents[2]
TAGS = ("{type: apriltag_grid, family: tag36h11, rows: 5, cols: 7, tag_size_mm: 25, "
        "tag_spacing_mm: 7.5}")
CHESSBOARD = "{type: chessboard, rows: 6, cols: 9, spacing_mm: 20}"
CIRCLES = ("{type: circle_grid, asymmetric: true, rows: 11, cols: 4, spacing_mm: 15, "
           "circle_diameter_mm: 10}")
SVG = "{http://www.w3.org/2000/svg}"


class PrintTarget(unittest.TestCase):
    def setUp(self):
        self.dir = pathlib.Path(tempfile.mkdtemp(prefix="stereomotion-test-"))

    def tearDown(self):
        shutil.rmtree(self.dir, ignore_errors=True)

    def run_program(self, *arguments):
        return subprocess.run([PROGRAM, "print-target", *map(str, arguments)], cwd=self.dir,
                              text=True, capture_output=True, timeout=60, check=False)

    def target(self, text, more=""):
        (self.dir / "frame.yaml").write_text(
            f"format: stereomotion-frame/1\ntarget: {text}\n{more}")

    def drawn(self, *arguments):
        result = self.run_program("frame.yaml", *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return ElementTree.parse(self.dir / result.stdout.strip()).getroot()

    def refused(self, code, *texts, arguments=("frame.yaml",)):
        result = self.run_program(*arguments)
        self.assertEqual(result.returncode, code, result.stderr)
        for text in texts:
            self.assertIn(text, result.stderr)

    def test_true_millimetres(self):
        """A unit of the drawing is a millimetre; the bar is 100 of them."""
        for text in (TAGS, CHESSBOARD, CIRCLES):
            self.target(text)
            svg = self.drawn("--output", "out.svg", "--force")
            _, _, width, height = svg.get("viewBox").split()
            self.assertEqual((svg.get("width"), svg.get("height")), (width + "mm", height + "mm"))
            bar = svg.find(f".//{SVG}rect[@id='bar_100_mm']")
            self.assertEqual(bar.get("width"), "100")

    def test_what_is_drawn(self):
        self.target(CHESSBOARD)
        path = self.drawn().find(f".//{SVG}g[@id='board']/{SVG}path").get("d")
        self.assertEqual(path.count("M"), 7 * 10 / 2)  # squares, half of them black
        self.assertEqual(path.count("h20.0000v20.0000"), 7 * 10 / 2)
        self.target(CIRCLES)
        circles = self.drawn("--force").findall(f".//{SVG}circle")
        self.assertEqual(len(circles), 44)
        self.assertEqual({circle.get("r") for circle in circles}, {"5.0000"})
        self.target(TAGS)
        paths = self.drawn("--force").findall(f".//{SVG}path[@fill='#000']")
        self.assertEqual("".join(p.get("d") for p in paths).count("h25.0000v25.0000"), 35)

    def test_paper(self):
        self.target(TAGS)
        for page, size in (("a4", "0 0 297 210"), ("a3", "0 0 297 420"),
                           ("letter", "0 0 279.4 215.9")):
            svg = self.drawn("--page", page, "--output", page + ".svg")
            self.assertEqual(svg.get("viewBox"), size)
        self.target(TAGS.replace("25", "60"))
        self.refused(2, "frame.yaml", "--page a4", "--page none", "needs a page of",
                     arguments=("frame.yaml", "--page", "a4"))
        self.assertFalse((self.dir / "board.svg").exists())
        self.drawn()
        self.refused(2, "--page", arguments=("frame.yaml", "--page", "a5"))

    def test_what_is_no_board(self):
        points = SOURCE / "calib/frame_points.yaml"
        self.refused(2, "control_points", "built and surveyed", arguments=(points,))
        self.refused(2, "wand", "not printed", arguments=(SOURCE / "calib/frame_wand.yaml",))
        self.target(CIRCLES.replace(", circle_diameter_mm: 10", ""))
        self.refused(2, "circle_diameter_mm")

    def test_ready_files(self):
        """Cameras and images are not looked at: the board comes before them."""
        for name in ("tags", "chessboard", "circles"):
            file = SOURCE / f"calib/frame_{name}.yaml"
            result = self.run_program(file, "--output", name + ".svg")
            self.assertEqual(result.returncode, 0, result.stderr)
        # The sizes for office paper that calib/frame_tags.yaml names.
        text = (SOURCE / "calib/frame_tags.yaml").read_text()
        sizes = re.findall(r"(A[34]): +tag_size_mm: ([\d.]+), tag_spacing_mm: ([\d.]+)", text)
        self.assertEqual([size[0] for size in sizes], ["A4", "A3"])
        for paper, tag, gap in sizes:
            self.target(TAGS.replace("25", tag).replace("7.5", gap))
            self.drawn("--page", paper.lower(), "--force")

    def test_same_bytes(self):
        self.target(TAGS)
        self.drawn("--output", "a.svg")
        self.drawn("--output", "b.svg")
        self.assertEqual((self.dir / "a.svg").read_bytes(), (self.dir / "b.svg").read_bytes())

    def test_output_exists(self):
        self.target(TAGS)
        (self.dir / "board.svg").write_text("mine")
        self.refused(2, "board.svg: exists; give --force")
        self.assertEqual((self.dir / "board.svg").read_text(), "mine")
        self.drawn("--force")
        self.refused(2, "is the input",
                     arguments=("frame.yaml", "--output", "frame.yaml", "--force"))
        self.refused(2, "is a folder", arguments=("frame.yaml", "--output", "."))
        self.refused(3, "none/x.svg: cannot be written",
                     arguments=("frame.yaml", "--output", "none/x.svg"))
        if os.path.exists("/dev/full"):
            self.refused(3, "No space left", arguments=("frame.yaml", "--output", "/dev/full"))

    def test_wrong_use(self):
        self.refused(2, "nowhere.yaml: cannot be read", arguments=("nowhere.yaml",))
        self.target(TAGS, "targt: 1\n")
        self.refused(2, "unknown key 'targt'", "did you mean 'target'?")
        self.target(CHESSBOARD.replace("9", "8"))
        self.refused(2, "looks the same upside down")
        result = self.run_program("--help")
        self.assertEqual(result.returncode, 0)
        self.assertIn("Example: stereomotion print-target", result.stdout)


if __name__ == "__main__":
    PROGRAM = os.path.abspath(sys.argv.pop(1))
    unittest.main(verbosity=1)
