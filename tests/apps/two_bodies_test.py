#!/usr/bin/env python3
"""Measures two bodies that move on their own about a common point, from images to their joint.

Usage: two_bodies_test.py PATH/TO/stereomotion [unittest options]
`simulate` renders each body; an image of both has the brighter of every two pixels.
"""

import json
import math
import os
import shutil
import struct
import subprocess
import time
import zlib

import small_recording
from small_recording import RIG, FolderCase, main, rows, run

FRAMES = 16
BALLS = 10  # of each body
MOST_CHI2 = 33.1  # χ² of six degrees of freedom exceeds it once in 100 000 runs

BODIES = {"thigh": """format: stereomotion-body/1
name: thigh
rods:
  - name: A
    ball_diameter_mm: 20
    balls_mm: [[-150,-60,0],[-110,-60,0],[-55,-60,0],[15,-60,0],[100,-60,0]]
  - name: B
    ball_diameter_mm: 20
    balls_mm: [[-140,-10,30],[-60,-4,36],[-20,-1,39],[35,3.125,43.125],[140,11,51]]
""", "shank": """format: stereomotion-body/1
name: shank
rods:
  - name: A
    ball_diameter_mm: 20
    balls_mm: [[-150,60,0],[-60,60,0],[-30,60,0],[60,60,0],[100,60,0]]
  - name: B
    ball_diameter_mm: 20
    balls_mm: [[-140,100,30],[-110,100,30],[0,100,30],[45,100,30],[140,100,30]]
"""}
# Where the joint is in each body; in the world it rests at the origin.
CENTER_MM = {"thigh": [0, 90, 20], "shank": [0, -20, 10]}
SCENARIO = """format: stereomotion-scenario/1
name: {name}
rig: rig.yaml
body: {name}.yaml
motion:
  law: fixed
  center_in_body_mm: {center}
  center_in_world_mm: [0, 0, 0]
  axis: {axis}
  rate_rad_s: {rate}
frames: {frames}
fps: 30
seed: {seed}
"""


def unfilter(kind, row, above):
    """Undoes a PNG filter of 8-bit grey (RFC 2083, 6)."""
    if kind == 2:
        return bytearray((x + b) & 255 for x, b in zip(row, above))
    out, left, corner = bytearray(), 0, 0
    for x, b in zip(row, above):
        if kind == 1:
            guess = left
        elif kind == 3:
            guess = (left + b) >> 1
        elif kind == 4:
            to_left, to_above, to_corner = abs(b - corner), abs(left - corner), abs(
                left + b - 2 * corner)
            guess = left if to_left <= min(to_above, to_corner) else (
                b if to_above <= to_corner else corner)
        else:
            guess = 0
        left, corner = (x + guess) & 255, b
        out.append(left)
    return out


def read_png(file):
    data, packed, at = file.read_bytes(), b"", 8
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        if kind == b"IHDR":
            width, height, bits, color = struct.unpack(">IIBB", data[at + 8:at + 18])
            assert (bits, color) == (8, 0), "simulate writes 8-bit grey"
        if kind == b"IDAT":
            packed += data[at + 8:at + 8 + size]
        at += 12 + size
    raw, above, image = zlib.decompress(packed), bytearray(width), bytearray()
    for v in range(height):
        start = v * (width + 1)
        above = unfilter(raw[start], raw[start + 1:start + 1 + width], above)
        image += above
    return width, height, image


def compose(folder, names):
    """Makes folder/rec of the recordings folder/NAME."""
    for camera in ("cam0", "cam1"):
        (folder / "rec" / camera).mkdir(parents=True)
        shutil.copy(folder / names[0] / camera / "timestamps.csv", folder / "rec" / camera)
        for frame in range(FRAMES):
            images = [read_png(folder / name / camera / f"{frame:06d}.png") for name in names]
            width, height, _ = images[0]
            (folder / "rec" / camera / f"{frame:06d}.pgm").write_bytes(
                b"P5 %d %d 255\n" % (width, height) + bytes(map(max, images[0][2], images[1][2])))


def make_recording(folder, motions):
    """motions: (body, axis, rate_rad_s), two of them."""
    folder.mkdir()
    (folder / "rig.yaml").write_text(RIG)
    for seed, (name, axis, rate) in enumerate(motions):
        (folder / f"{name}.yaml").write_text(BODIES[name])
        (folder / "scenario.yaml").write_text(SCENARIO.format(
            name=name, center=CENTER_MM[name], axis=axis, rate=rate, frames=FRAMES, seed=seed + 1))
        made = run("simulate", "scenario.yaml", "--output", name, cwd=folder)
        if made.returncode != 0:
            raise RuntimeError("simulate failed: " + made.stderr)
    compose(folder, [name for name, _, _ in motions])


def track(folder, *more, rec="rec"):
    result = run("track", "--left", f"{rec}/cam0", "--right", f"{rec}/cam1", "--body", "thigh.yaml",
                 "--body", "shank.yaml", *more, cwd=folder)
    if result.returncode != 0:
        raise AssertionError(result.stderr)
    return result


def make_long(folder, turns):
    """Makes folder/long of folder/rec: there and back again, without a jump."""
    order = (list(range(FRAMES)) + list(range(FRAMES - 2, 0, -1))) * turns
    for camera in ("cam0", "cam1"):
        (folder / "long" / camera).mkdir(parents=True)
        stamps = ["frame,timestamp_ns"]
        for i, frame in enumerate(order):
            os.link(folder / "rec" / camera / f"{frame:06d}.pgm",
                    folder / "long" / camera / f"{i:06d}.pgm")
            stamps.append(f"{i},{i * 33333333}")
        (folder / "long" / camera / "timestamps.csv").write_text("\n".join(stamps) + "\n")


def wait_for_rows(file, count, process):
    while not file.exists() or file.read_bytes().count(b"\n") < count:
        if process.poll() is not None:
            raise AssertionError("the run ended before it could be killed")
        time.sleep(0.01)


def solve(matrix, vector):
    """Gauss-Jordan with pivoting."""
    n = len(vector)
    rows_ = [list(matrix[i]) + [vector[i]] for i in range(n)]
    for i in range(n):
        pivot = max(range(i, n), key=lambda r: abs(rows_[r][i]))
        rows_[i], rows_[pivot] = rows_[pivot], rows_[i]
        for r in range(n):
            if r == i:
                continue
            factor = rows_[r][i] / rows_[i][i]
            rows_[r] = [x - factor * y for x, y in zip(rows_[r], rows_[i])]
    return [rows_[i][n] / rows_[i][i] for i in range(n)]


def chi2(error, covariance):
    return sum(a * b for a, b in zip(error, solve(covariance, error)))


class TwoBodies(FolderCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.dir = cls.base / "ball"
        make_recording(cls.dir, [("thigh", [0, 0.2, 1], -0.7), ("shank", [1, 0, 1], 0.9)])
        cls.result = track(cls.dir, "--output", "run")

    def test_poses_are_the_truth(self):
        for name in BODIES:
            found = rows(self.dir / "run" / name / "poses.csv")
            truth = rows(self.dir / name / "truth/poses.csv")
            total = 0
            for row, true in zip(found, truth, strict=True):
                self.assertEqual(row["status"], "ok")
                error = [float(row[k]) - float(true[k]) for k in ("tx_mm", "ty_mm", "tz_mm")]
                cov = [[float(row[f"cov_{min(i, j)}{max(i, j)}"]) for j in (3, 4, 5)]
                       for i in (3, 4, 5)]
                total += chi2(error, cov)
            dof = 3 * FRAMES
            self.assertLess(total, dof + 5 * math.sqrt(2 * dof), name)
            self.assertGreater(total, dof / 4, name)  # where two noises meet, the brighter wins

    def test_joint_is_the_truth(self):
        joint = json.loads((self.dir / "run/joint.json").read_text())
        self.assertEqual((joint["first"], joint["second"]), ("thigh", "shank"))
        center = joint["center"]
        error = [a - b for name, key in (("thigh", "in_first_mm"), ("shank", "in_second_mm"))
                 for a, b in zip(center[key], CENTER_MM[name])]
        self.assertIsNone(center["free_axis_in_first"])
        self.assertLess(chi2(error, center["covariance_mm2"]), MOST_CHI2)
        self.assertLess(max(map(abs, error)), 1)

    def test_killed_run_has_whole_rows(self):
        make_long(self.dir, turns=40)
        track_ = [small_recording.program, "track", "--left", "long/cam0", "--right", "long/cam1",
                  "--body", "thigh.yaml", "--body", "shank.yaml", "--output", "killed",
                  "--threads", "1"]
        with subprocess.Popen(track_, cwd=self.dir, stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL) as process:
            wait_for_rows(self.dir / "killed/shank/poses.csv", 20, process)
            process.kill()
        counts = []
        for name in BODIES:
            folder = self.dir / "killed" / name
            for file in ("poses.csv", "balls.csv", "detections.csv"):
                lines = (folder / file).read_text().split("\n")
                self.assertEqual(lines.pop(), "", file)  # the last line has its end
                self.assertEqual({line.count(",") for line in lines}, {lines[0].count(",")}, file)
            frames = [row["frame"] for row in rows(folder / "poses.csv")]
            counts.append(len(frames))
            self.assertEqual(frames, [str(i) for i in range(len(frames))])
            balls = [row["frame"] for row in rows(folder / "balls.csv")]
            self.assertEqual(balls[:BALLS * len(frames)],
                             [frame for frame in frames for _ in range(BALLS)])
            self.assertIn(len(balls), (BALLS * len(frames), BALLS * (len(frames) + 1)))
        self.assertLess(counts[0], 2 * 40 * FRAMES - 1, "killed too late to tell")
        self.assertLessEqual(max(counts) - min(counts), 1)
        state = json.loads((self.dir / "killed/run.json").read_text())["state"]
        self.assertEqual(state, "running")
        # What there is can be analysed.
        again = run("analyse", "killed/thigh", cwd=self.dir)
        self.assertEqual(again.returncode, 0, again.stderr)

    def test_refine_takes_one_body(self):
        refused = run("calibrate", "--refine", "run", "--output", "new.yaml", cwd=self.dir)
        self.assertEqual(refused.returncode, 2, refused.stderr)
        self.assertIn("expected the folder of one (--refine): run/thigh, run/shank", refused.stderr)
        for name in BODIES:
            result = run("calibrate", "--refine", f"run/{name}", "--output", f"{name}-new.yaml",
                         cwd=self.dir)
            self.assertIn(result.returncode, (0, 1), result.stderr)
            self.assertNotIn("run.json", result.stderr)

    def test_mask_never_covers_a_body(self):
        """Balls near the joint move by little more than their size: refused, not masked."""
        result = run("track", "--left", "rec/cam0", "--right", "rec/cam1", "--body", "thigh.yaml",
                     "--body", "shank.yaml", "--learn-mask", "mask.yaml", cwd=self.dir)
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertIn("does not move enough", result.stderr)
        self.assertFalse((self.dir / "mask.yaml").exists())

    def test_outcome_is_told(self):
        self.assertIn("joint of thigh and shank", self.result.stdout)
        self.assertIn("<p>joint of thigh and shank: ball joint",
                      (self.dir / "run/report.html").read_text())
        record = json.loads((self.dir / "run/run.json").read_text())
        self.assertEqual([b["tracked"] for b in record["bodies"]], [FRAMES, FRAMES])


if __name__ == "__main__":
    main()
