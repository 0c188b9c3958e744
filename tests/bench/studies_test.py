"""Runs the studies of docs/accuracy.md with few balls: columns, conditions, and errors that theory allows.

usage: studies_test.py STUDY_PROGRAM EXPOSURE_PROGRAM CENTER_PROGRAM
"""
import csv
import math
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

STUDY, EXPOSURE, CENTERS = sys.argv[1:4]
METHODS = {"ml", "wavelet", "centroid", "moments", "simple_blob", "canny_ellipse", "hough"}


def run(program, folder):
    subprocess.run([program, "--quick", "--output", folder], check=True, stderr=subprocess.DEVNULL)


def rows(path):
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


class AccuracyStudy(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with tempfile.TemporaryDirectory() as folder:
            run(STUDY, folder)
            cls.rows = rows(Path(folder) / "accuracy.csv")
            cls.histogram = rows(Path(folder) / "histogram.csv")

    def test_every_sweep_has_every_method(self):
        sweeps = {"snr", "diameter", "grid", "smear", "hidden", "phase", "histogram"}
        self.assertEqual({(row["sweep"], row["method"]) for row in self.rows},
                         {(sweep, method) for sweep in sweeps for method in METHODS})

    def test_columns(self):
        for name in ("found_share", "bias_u_px", "bias_v_px", "bias_along_px", "rmse_px", "bound_px",
                     "ratio", "nees_dof", "worst_z", "coverage_95", "phase_u", "phase_v"):
            self.assertIn(name, self.rows[0])

    def test_ml_lies_at_the_bound_and_nothing_below_it(self):
        # 100 balls: an RMSE over 200 numbers is uncertain by 5 %; four standard errors.
        for row in self.rows:
            if row["sweep"] in ("snr", "diameter", "grid") and row["ratio"]:
                self.assertGreater(float(row["ratio"]), 0.8, row)
                if row["method"] == "ml":
                    self.assertLess(float(row["ratio"]), 1.05 + 0.2, row)
                    self.assertEqual(float(row["found_share"]), 1, row)

    def test_histogram_counts_every_ball_found(self):
        for row in self.rows:
            if row["sweep"] != "histogram":
                continue
            counted = sum(int(bar["balls"]) for bar in self.histogram
                          if bar["method"] == row["method"])
            self.assertEqual(counted, round(float(row["found_share"]) * int(row["balls"])))


class ExposureStudy(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with tempfile.TemporaryDirectory() as folder:
            run(EXPOSURE, folder)
            cls.rows = rows(Path(folder) / "exposure.csv")
            cls.deviations = rows(Path(folder) / "deviation.csv")

    def test_slow_targets_are_measured_at_the_bound(self):
        # 50 repetitions: uncertain by 10 %; four standard errors.
        self.assertEqual({row["series"] for row in self.rows},
                         {"constant_light", "equal_photons", "deviation"})
        for row in self.rows:
            self.assertEqual(row["lost"], "0")
            ratio = float(row["rmse_along_mm"]) / float(row["bound_along_mm"])
            self.assertLess(abs(math.log(ratio)), 0.4, row)

    def test_every_ball_has_a_box(self):
        self.assertEqual(len(self.deviations), 10)
        for row in self.deviations:
            box = [float(row[name]) for name in ("q05_mm", "q25_mm", "median_mm", "q75_mm", "q95_mm")]
            self.assertEqual(box, sorted(box))


class CenterStudy(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with tempfile.TemporaryDirectory() as folder:
            run(CENTERS, folder)
            cls.rows = rows(Path(folder) / "centers.csv")

    def test_every_scene_has_its_baselines_and_our_own(self):
        scenes = {row["scene"] for row in self.rows}
        self.assertEqual(scenes, {"ball", "ball_per_marker", "ball_both_moving",
                                  "ball_both_mirrored", "hinge"})
        for scene in scenes:
            kinds = {row["baseline"] for row in self.rows if row["scene"] == scene}
            self.assertEqual(kinds, {"0", "1"}, scene)

    def test_our_centre_is_found_in_every_trial_and_its_covariance_is_true(self):
        # 12 trials of 2 or 3 degrees of freedom: the NEES/dof is uncertain by √(2/24) = 0.29 at
        # most; five standard errors, for some ten rows.
        for row in self.rows:
            if row["method"] != "stereomotion":
                continue
            self.assertEqual(row["answered"], row["trials"], row)
            self.assertLess(abs(float(row["nees_dof"]) - 1), 1.45, row)

    def test_algebraic_spheres_are_drawn_towards_the_markers(self):
        # Gamage & Lasenby's bias, which the correction takes away: at 20° it is twice the noise.
        rmse = {row["method"]: float(row["rmse"]) for row in self.rows
                if row["scene"] == "ball" and row["range_deg"] == "20"}
        self.assertGreater(rmse["spheres, algebraic"], 1.5 * rmse["spheres, bias-corrected"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
