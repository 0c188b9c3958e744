#!/usr/bin/env python3
"""Runs `stereomotion calibrate` on images that the program renders: finding and labelling.

Usage: calibrate_images_test.py PATH/TO/stereomotion [unittest options]
"""

import re
import shutil
import signal
import subprocess
import time

import calibrate_case
from calibrate_case import BOARD, TURNS, WAND, Case, RenderCase, points_target, project

RODS = {"A": [(-250 + 100 * i, -150 + 20 * i, -200 + 90 * i) for i in range(6)],
        "B": [(-230 + 115 * i, 150 - 10 * i, 220 - 100 * i) for i in range(5)],
        "C": [(50 + 8 * i, -90 + 80 * i, 150 - 20 * i) for i in range(3)]}


class Images(RenderCase):
    """The program renders the images: balls on rods that stand still (a frame) or turn (a wand)."""

    def control_frame(self, factor=(1, 1, 1), diameter_mm=20.0, images=None, seeds=None):
        self.render(RODS, "rec")
        points = {f"{rod}{i}": ball for rod, balls in RODS.items() for i, ball in enumerate(balls)}
        for camera in TURNS:
            (self.dir / f"{camera}_seeds.csv").write_text("id,u_px,v_px\n" + "".join(
                "{},{:.0f},{:.0f}\n".format(name, *project(camera, points[name]))
                for name in points))
        scaled = {name: tuple(f * x for f, x in zip(factor, p)) for name, p in points.items()}
        images, seeds = images or {}, seeds or {}
        self.frame(points_target(scaled, diameter_mm), {
            camera: f"images: rec/{images.get(camera, camera)}/*.png, "
            f"seeds: {seeds.get(camera, camera)}_seeds.csv" for camera in TURNS})

    def test_good_and_same_bytes_on_any_thread_count(self):
        self.control_frame()
        result = self.done(arguments=("--threads", "1"))
        self.assertNotIn("outliers", result.stderr)
        self.assertRegex(result.stdout, r"image points used +(2[4-8]) of \1,")
        first = self.outputs()["rig.yaml"]
        self.done(arguments=("--threads", "3"))
        self.assertEqual(self.outputs()["rig.yaml"], first)

    def test_swapped_cameras(self):
        self.control_frame(seeds={"cam0": "cam1", "cam1": "cam0"})
        self.refused(2, "(swapped_cameras)", "cameras' images or seeds exchanged?")

    def test_folders_of_other_names(self):
        swap = {"cam0": "cam1", "cam1": "cam0"}
        self.control_frame(images=swap, seeds=swap)
        self.done("swapped_cameras")

    def test_wrong_units(self):
        self.control_frame(diameter_mm=2.0)
        self.refused(1, "wrong_units", "expected ball_diameter_mm: 2")
        self.control_frame(diameter_mm=10.0)
        self.done("ball_size")

    def test_contradicting_and_false_seeds(self):
        self.control_frame()
        file = self.dir / "cam0_seeds.csv"
        text = file.read_text()
        file.write_text(text.replace("A0,", "@,").replace("B0,", "A0,").replace("@,", "B0,"))
        self.assertIn("the seeds of A0, B0", self.done("contradicting_seeds").stderr)
        names = re.findall(r"\n(\w+),", text)
        places = re.findall(r"\n\w+(,\d+,\d+)", text)
        file.write_text("id,u_px,v_px\n" + "".join(
            name + place + "\n" for name, place in zip(names, places[7:] + places[:7])))
        self.refused(1, "mislabelled: ")

    def test_mirrored(self):
        self.control_frame(factor=(-1, 1, 1))
        self.refused(1, "mirrored: ", "change the sign of one coordinate")

    def test_mixed_image_sizes(self):
        self.control_frame()
        for camera in TURNS:
            (self.dir / f"rec/{camera}/000001.pgm").write_bytes(b"P5 64 48 255\n" + bytes(64 * 48))
        text = (self.dir / "frame.yaml").read_text().replace("*.png", "0*")
        (self.dir / "frame.yaml").write_text(text)
        self.refused(2, "000001.pgm", "64 x 48", "640 x 512", "mixed_image_sizes")

    def test_unequal_counts_and_missing_images(self):
        self.control_frame()
        shutil.copy(self.dir / "rec/cam0/000000.png", self.dir / "rec/cam0/000001.png")
        self.refused(2, "2 images of cam0 and 1 of cam1")
        shutil.rmtree(self.dir / "rec/cam1")
        self.refused(2, "frame.yaml", "rec/cam1")

    def test_damaged_image(self):
        self.control_frame()
        file = self.dir / "rec/cam1/000000.png"
        file.write_bytes(file.read_bytes()[:-500])
        self.refused(2, "rec/cam1/000000.png: ")

    def wand(self):
        """A rod of three balls that turns, in views of which one is out of focus."""
        self.render({"W": [(-130, 20, 0), (-30, 20, 0), (130, 20, 0)]}, "rec", 2, frames=12)
        self.frame(WAND, {camera: f"images: rec/{camera}/*.png, free: [], initial: "
                          "{fx_px: 800, fy_px: 800, cx_px: 320, cy_px: 256}" for camera in TURNS})

    def test_blurred_view(self):
        self.wand()
        self.render({"W": [(-130, 20, 0), (-30, 20, 0), (130, 20, 0)]}, "blurred", 2, 1.6, 12)
        shutil.copy(self.dir / "blurred/cam1/000003.png", self.dir / "rec/cam1/000003.png")
        self.assertIn("camera cam1, view 3", self.done("blurred_view").stderr)

    def test_view_without_target(self):
        self.wand()
        (self.dir / "rec/cam1/000003.png").unlink()
        self.blank("rec/cam1/000003.pgm")
        text = (self.dir / "frame.yaml").read_text().replace("*.png", "0*")
        (self.dir / "frame.yaml").write_text(text)
        self.assertIn("000003.pgm", self.done("wand_not_found").stderr)

    def test_nothing_to_be_seen(self):
        self.control_frame()
        self.blank("rec/cam0/000000.pgm")
        (self.dir / "rec/cam0/000000.png").unlink()
        text = (self.dir / "frame.yaml").read_text().replace("*.png", "0*")
        (self.dir / "frame.yaml").write_text(text)
        self.refused(1, "too_few_points: rec/cam0/000000.pgm", "seeds")

    def test_board_not_found(self):
        self.blank("cam0/0.pgm", "cam1/0.pgm")
        self.frame(BOARD, {camera: f"images: {camera}" for camera in TURNS})
        self.refused(1, "board_not_found: cam0/0.pgm", "5 × 8 inner corners")

    def test_not_identifiable(self):
        self.control_frame()
        text = re.sub(r", seeds: \w+\.csv", "", (self.dir / "frame.yaml").read_text())
        (self.dir / "frame.yaml").write_text(re.sub(r"    - {id: (B[34]|A[345]).*\n", "", text))
        self.refused(1, "not_identifiable: ", "give seeds")

    def test_too_few_world_points(self):
        self.wand()
        self.blank("cam0/0.pgm", "cam1/0.pgm")
        for camera in TURNS:
            (self.dir / f"{camera}_world.csv").write_text(
                "id,u_px,v_px\nO,100,100\nX,300,100\nY,100,300\n")
        text = (self.dir / "frame.yaml").read_text()
        for camera in TURNS:
            text = text.replace(f"name: {camera},", f"name: {camera}, world_images: "
                                f"{camera}/0.pgm, world_seeds: {camera}_world.csv,")
        (self.dir / "frame.yaml").write_text(
            text + "world_points: {ball_diameter_mm: 20, points: [{id: O, xyz_mm: [0, 0, 0]}, "
            "{id: X, xyz_mm: [300, 0, 0]}, {id: Y, xyz_mm: [0, 300, 0]}]}\n")
        self.refused(1, "too_few_world_points: ")

    def test_interrupt(self):
        """Ctrl-C ends it at once and leaves no half output."""
        self.wand()
        for camera in TURNS:
            for i in range(12, 2000):
                (self.dir / f"rec/{camera}/{i:06}.png").symlink_to(f"{i % 12:06}.png")
        (self.dir / "rig.yaml").write_text("mine")
        command = [Case.program, "calibrate", "frame.yaml"]
        with subprocess.Popen(command, cwd=self.dir, stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, text=True) as process:
            time.sleep(0.5)
            process.send_signal(signal.SIGINT)
            process.communicate(timeout=10)
            self.assertNotEqual(process.returncode, 0)
        self.assertEqual(self.outputs(), {"rig.yaml": b"mine"})


if __name__ == "__main__":
    calibrate_case.main()
