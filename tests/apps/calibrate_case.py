"""What the tests of `stereomotion calibrate` share: a projector, writers of frame.yaml, a case.

Image points are projected here; Python's standard library is all it takes.
"""

import math
import os
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile
import unittest

FOCAL_PX, WIDTH_PX, HEIGHT_PX = 800, 640, 512
DISTANCE_MM = 1500
TURNS = {"cam0": 0.3, "cam1": -0.3}  # of the cameras about the world's y axis, rad
SIGMA_PX = 0.05


def turned(point, rx, ry):
    """`point` turned about x, then about y."""
    x, y, z = point
    y, z = math.cos(rx) * y - math.sin(rx) * z, math.sin(rx) * y + math.cos(rx) * z
    return (math.cos(ry) * x + math.sin(ry) * z, y, -math.sin(ry) * x + math.cos(ry) * z)


def project(camera, point):
    """The pixel of a world point; the world's origin is DISTANCE_MM before both cameras."""
    x, y, z = turned(point, 0, TURNS[camera])
    z += DISTANCE_MM
    return (WIDTH_PX / 2 + FOCAL_PX * x / z, HEIGHT_PX / 2 + FOCAL_PX * y / z)


def scattered(count, extent_mm=(250, 200, 250), seed=7):
    """Control points {id: place}, no two nearer than a ball."""
    generator = random.Random(seed)
    return {f"P{i:02}": tuple(generator.uniform(-e, e) for e in extent_mm) for i in range(count)}


def observe(points, views=1, place=lambda view, point: point, noise_px=SIGMA_PX):
    """Observations [(id, u, v, view)] of each camera."""
    generator = random.Random(3)
    return {camera: [(name, *(x + generator.gauss(0, noise_px)
                              for x in project(camera, place(view, point))), view)
                     for view in range(views) for name, point in points.items()]
            for camera in TURNS}


def points_target(points, diameter_mm=0):
    lines = [f"    - {{id: {name}, xyz_mm: [{x:.6f}, {y:.6f}, {z:.6f}], sigma_mm: 0.02}}\n"
             for name, (x, y, z) in points.items()]
    return (f"  type: control_points\n  ball_diameter_mm: {diameter_mm}\n  points:\n" +
            "".join(lines))


BOARD = "  {type: chessboard, rows: 5, cols: 8, spacing_mm: 40}\n"
CORNERS = {f"{row}.{col}": ((col - 3.5) * 40, (row - 2) * 40, 0)
           for row in range(5) for col in range(8)}
WAND = "  {type: wand, ball_diameter_mm: 20, distances_mm: [0, 100, 260]}\n"


def pose_of_board(view, point):
    """Boards tilted in all directions, at different distances."""
    generator = random.Random(view)
    x, y, z = turned(point, generator.uniform(-0.6, 0.6), generator.uniform(-0.6, 0.6))
    return (x + generator.uniform(-90, 90), y + generator.uniform(-70, 70),
            z + generator.uniform(-250, 250))


class Case(unittest.TestCase):
    """Makes a folder for each test, and runs the program in it."""

    program = None

    def setUp(self):
        self.dir = pathlib.Path(tempfile.mkdtemp(prefix="stereomotion-test-"))

    def tearDown(self):
        shutil.rmtree(self.dir, ignore_errors=True)

    def frame(self, target, cameras, more=""):
        lines = "".join(f"  - {{name: {name}, {keys}}}\n" for name, keys in cameras.items())
        (self.dir / "frame.yaml").write_text(
            f"format: stereomotion-frame/1\ntarget:\n{target}cameras:\n{lines}{more}")

    def measured(self, target, observations, more="", keys=""):
        """Writes a frame.yaml with `observations:`."""
        for camera, rows in observations.items():
            (self.dir / (camera + ".csv")).write_text("id,u_px,v_px,view,sigma_px\n" + "".join(
                f"{name},{u:.5f},{v:.5f},{view},{SIGMA_PX}\n" for name, u, v, view in rows))
        self.frame(target, {camera: f"observations: {camera}.csv, "
                            f"image_size_px: [{WIDTH_PX}, {HEIGHT_PX}]" + keys
                            for camera in observations}, more)

    def calibrate(self, *more, **options):
        environment = dict(os.environ, SOURCE_DATE_EPOCH="1700000000")
        return subprocess.run([Case.program, "calibrate", "frame.yaml", *more], cwd=self.dir,
                              text=True, capture_output=True, timeout=120, check=False,
                              env=environment, **options)

    def done(self, *warnings, arguments=()):
        result = self.calibrate(*arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        for name in warnings:
            self.assertIn(f"warning: {name}: ", result.stderr)
        return result

    def refused(self, code, *texts, arguments=()):
        """Checks exit code and message, and that no output was touched."""
        before = self.outputs()
        result = self.calibrate(*arguments)
        self.assertEqual(result.returncode, code, result.stderr)
        for text in texts:
            self.assertIn(text, result.stderr)
        self.assertEqual(self.outputs(), before)
        return result

    def outputs(self):
        return {file.name: file.read_bytes() for pattern in ("rig.*", "calibration.*")
                for file in self.dir.glob(pattern)}


RIG = "format: stereomotion-rig/1\ncameras:\n" + "".join(
    f"""  - name: {camera}
    image_size_px: [{WIDTH_PX}, {HEIGHT_PX}]
    intrinsics: {{fx_px: {FOCAL_PX}, fy_px: {FOCAL_PX}, cx_px: 320, cy_px: 256}}
    distortion: [0, 0, 0, 0, 0]
    cam_from_world: {{qw: {math.cos(turn / 2)}, qx: 0, qy: {math.sin(turn / 2)}, qz: 0,
                     tx_mm: 0, ty_mm: 0, tz_mm: {DISTANCE_MM}}}
""" for camera, turn in TURNS.items())
SCENARIO = """format: stereomotion-scenario/1
name: frame
rig: rig.yaml
body: body.yaml
motion: {law: fixed, center_in_world_mm: [0, 0, 0], axis: [0.3, 1, 0.2], rate_rad_s: %g}
light: {blur_px: %g}
frames: %d
fps: 30
"""


class RenderCase(Case):
    """Lets the program render what the cameras see."""

    def render(self, rods, output, rate=0.0, blur_px=0.6, frames=1):
        shutil.rmtree(self.dir / output, ignore_errors=True)
        folder = self.dir / "scene"
        folder.mkdir(exist_ok=True)
        (folder / "rig.yaml").write_text(RIG)
        (folder / "body.yaml").write_text(
            "format: stereomotion-body/1\nname: frame\nrods:\n" + "".join(
                f"  - name: {name}\n    ball_diameter_mm: 20\n    balls_mm: "
                f"{[list(ball) for ball in balls]}\n" for name, balls in rods.items()))
        (folder / "scene.yaml").write_text(SCENARIO % (rate, blur_px, frames))
        made = subprocess.run([Case.program, "simulate", "scene/scene.yaml", "--output", output],
                              cwd=self.dir, capture_output=True, text=True, check=False, timeout=60)
        self.assertEqual(made.returncode, 0, made.stderr)

    def blank(self, *names):
        """Writes images in which nothing is to be seen."""
        for name in names:
            (self.dir / name).parent.mkdir(exist_ok=True)
            (self.dir / name).write_bytes(f"P5 {WIDTH_PX} {HEIGHT_PX} 255\n".encode() +
                                          bytes([20]) * (WIDTH_PX * HEIGHT_PX))


def main():
    """Takes the program's path from the command line and runs the tests."""
    Case.program = os.path.abspath(sys.argv.pop(1))
    unittest.main(verbosity=1)
