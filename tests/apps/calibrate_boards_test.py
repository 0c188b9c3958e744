#!/usr/bin/env python3
"""Runs `stereomotion calibrate` on boards and wands: each error and warning by its name.

Usage: calibrate_boards_test.py PATH/TO/stereomotion [unittest options]
"""

import math
import re

import calibrate_case
from calibrate_case import BOARD, CORNERS, FOCAL_PX, WAND, Case, observe, pose_of_board, turned


class Boards(Case):
    def board(self, views, place=pose_of_board, drop=()):
        seen = observe(CORNERS, views, place)
        for camera, unseen in drop:
            seen[camera] = [row for row in seen[camera] if row[3] not in unseen]
        self.measured(BOARD, seen)

    def test_good(self):
        self.board(12)
        result = self.done()
        for name in ("outliers", "few_views", "similar_views", "weak_focal_length", "board_shape"):
            self.assertNotIn(name, result.stderr)
        for value, sigma in re.findall(r"fx ([\d.]+) ± ([\d.]+)", result.stdout):
            self.assertLess(abs(float(value) - FOCAL_PX), 5 * float(sigma))

    def test_few_views(self):
        self.board(3)
        self.assertIn("3 view(s)", self.done("few_views").stderr)

    def test_similar_views(self):
        def parallel(view, point):
            x, y, z = turned(point, 0.3, 0.02 * view)
            return (x + 30 * view - 100, y + 20 * (view % 3), z + 40 * view)
        self.board(8, parallel)
        self.done("similar_views")

    def test_too_few_views(self):
        self.board(2)
        self.refused(1, "too_few_views", "2 view(s), expected at least 3")

    def test_views_of_one_camera_only(self):
        self.board(8, drop=(("cam0", range(4)), ("cam1", range(4, 8))))
        self.refused(1, "no_common_view: camera cam1", "both see it at the same time")
        self.board(8, drop=(("cam1", range(8)),))
        self.refused(2, "cam1.csv: holds no rows")

    def test_board_shape(self):
        """A board bent by 1 mm, which the file calls exact."""
        bent = {name: (x, y, 1.0 * (x / 140) ** 2) for name, (x, y, z) in CORNERS.items()}
        self.measured(BOARD, observe(bent, 15, pose_of_board))
        self.done("board_shape")

    def test_wrong_units(self):
        self.measured(BOARD.replace("40", "0.04"), observe(CORNERS, 4, pose_of_board))
        self.refused(2, "metres?", "40 mm")


class Wand(Case):
    def test_good(self):
        balls = {"0": (-130, 0, 0), "1": (-30, 0, 0), "2": (130, 0, 0)}
        self.measured(WAND, observe(balls, 80, lambda view, point: pose_of_board(
            view, turned(point, 0, math.pi / 2 * (view % 2)))))
        result = self.done()
        for value, sigma in re.findall(r"fx ([\d.]+) ± ([\d.]+)", result.stdout):
            self.assertLess(abs(float(value) - FOCAL_PX), 5 * float(sigma))

    def test_too_few_views(self):
        balls = {"0": (-130, 0, 0), "1": (-30, 0, 0), "2": (130, 0, 0)}
        self.measured(WAND, observe(balls, 2, pose_of_board))
        self.refused(1, "no_start: ", "relative orientation")


if __name__ == "__main__":
    calibrate_case.main()
