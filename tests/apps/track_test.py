#!/usr/bin/env python3
"""Runs `track` with its options: detectors, partial search, masks, exposure, report.

Usage: track_test.py PATH/TO/stereomotion [unittest options]
The recordings are rendered by the program itself; Python's standard library is all it takes.
"""

import json
import pathlib
import re
import shutil
import tempfile
import xml.etree.ElementTree

from small_recording import BODY, NOISE, RIG, FolderCase, main, rows, run

FRAMES = 12
# Where no ball of the body ever is, 1.5 m before the cameras; and what it looks like to them.
LAMP_MM = (-250, 180, 0)

SCENARIO = """format: stereomotion-scenario/1
name: track
rig: rig.yaml
body: body.yaml
motion:
  law: fixed
  center_in_world_mm: [0, 0, 0]
  axis: [0, 0.3, 1]
  rate_rad_s: %g
false_balls:
  - {xyz_mm: [%g, %g, %g], diameter_mm: 16}
frames: %d
fps: 30
"""


def project(camera, p_mm):
    depth = p_mm[2] + 1500
    shift = 200 if camera == "cam0" else -200
    return 320 + 800 * (p_mm[0] + shift) / depth, 256 + 800 * p_mm[1] / depth


class Track(FolderCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.write(rig=RIG, body=BODY)
        for name, rate in (("moving", 1.5), ("resting", 0)):
            cls.simulate(SCENARIO % (rate, *LAMP_MM, FRAMES), name)

    def setUp(self):
        self.dir = pathlib.Path(tempfile.mkdtemp(dir=self.base))
        shutil.copy(self.base / "rig.yaml", self.dir)
        shutil.copy(self.base / "body.yaml", self.dir)

    def track(self, *more, rec="moving", output="run"):
        outputs = [] if "--learn-mask" in more else ["--output", output]
        return run("track", "--left", self.base / rec / "cam0", "--right", self.base / rec / "cam1",
                   "--body", "body.yaml", *outputs, *more, cwd=self.dir)

    def record(self, *more, output="run", **options):
        result = self.track(*more, output=output, **options)
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads((self.dir / output / "run.json").read_text())

    def near_lamp(self, folder):
        """Counts the detections where the lamp is."""
        found = 0
        for row in rows(self.dir / folder / "detections.csv"):
            u, v = project(row["camera"], LAMP_MM)
            found += abs(float(row["outline_u_px"]) - u) < 4 and abs(
                float(row["outline_v_px"]) - v) < 4
        return found

    def test_detectors(self):
        for name in ("ml", "wavelet", "centroid"):
            record = self.record("--detector", name, output=name)
            self.assertEqual(record["detector"], name)
            self.assertEqual(record["frames"]["tracked"], FRAMES, name)
        self.assertEqual(self.record()["detector"], "ml")
        result = self.track("--detector", "best", output="none")
        self.assertEqual(result.returncode, 2)
        self.assertIn("best", result.stderr)

    def test_noise_of_the_rig_is_reported(self):
        self.assertEqual(self.record(output="a")["noise"]["left"]["origin"], "learned")
        (self.dir / "rig.yaml").write_text(RIG + NOISE)
        noise = self.record(output="b")["noise"]
        for camera in ("left", "right"):
            self.assertEqual(noise[camera], {"gain_e_per_dn": 58.8, "read_e": 8.0, "black_dn": 0.0,
                                             "saturation_dn": 255.0, "origin": "rig",
                                             "pairs_used": 0})

    def test_partial_search(self):
        record = self.record("--search-every", 4, "--threads", 1, output="one")
        self.assertEqual(record["search"]["every"], 4)
        self.assertEqual(record["frames"]["tracked"], FRAMES)
        # The first two, for the velocities; then every fourth.
        self.assertLessEqual(record["search"]["whole_left"], 2 + FRAMES // 4)
        self.record("--search-every", 4, "--threads", 3, output="three")
        for name in ("poses.csv", "balls.csv", "detections.csv"):
            self.assertEqual((self.dir / "one" / name).read_bytes(),
                             (self.dir / "three" / name).read_bytes(), name)
        self.record(output="whole")
        self.assertEqual(len(rows(self.dir / "one/detections.csv")),
                         len(rows(self.dir / "whole/detections.csv")))
        result = self.track("--search-every", 0, output="none")
        self.assertEqual(result.returncode, 2)

    def test_mask_is_learned_and_used(self):
        self.record(output="without")
        self.assertEqual(self.near_lamp("without"), 2 * FRAMES)
        result = self.track("--learn-mask", "mask.yaml")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stdout.splitlines()[-1], "mask.yaml")
        self.assertFalse((self.dir / "run").exists())
        record = self.record("--mask", "mask.yaml", output="masked")
        self.assertEqual([(m["camera"], m["regions"]) for m in record["masks"]],
                         [("cam0", 1), ("cam1", 1)])
        self.assertIn(("mask", 64), [(i["role"], len(i["sha256"])) for i in record["inputs"]])
        self.assertEqual(self.near_lamp("masked"), 0)
        self.assertEqual(record["frames"]["tracked"], FRAMES)
        self.assertIn('class="mask"', (self.dir / "masked/report.html").read_text())
        again = self.track("--learn-mask", "mask.yaml")
        self.assertEqual(again.returncode, 2)
        self.assertIn("--force", again.stderr)

    def test_mask_of_a_resting_body_is_refused(self):
        result = self.track("--learn-mask", "mask.yaml", rec="resting")
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertIn("does not move enough", result.stderr)
        self.assertFalse((self.dir / "mask.yaml").exists())

    def test_mask_of_too_few_pairs_is_refused(self):
        result = self.track("--learn-mask", "mask.yaml", "--count", 9)
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertIn("fewer than 10 pairs", result.stderr)

    def test_mask_never_replaces_an_input(self):
        for name in ("cam0", "cam1"):
            shutil.copytree(self.base / "moving" / name, self.dir / name)
        image = next((self.dir / "cam1").glob("*.png"))
        for target in ("rig.yaml", "body.yaml", "cam1/timestamps.csv", image):
            before = (self.dir / target).read_bytes()
            result = run("track", "--left", "cam0", "--right", "cam1", "--body", "body.yaml",
                         "--learn-mask", target, "--force", cwd=self.dir)
            self.assertEqual(result.returncode, 2, target)
            self.assertIn("expected another --learn-mask", result.stderr)
            self.assertEqual((self.dir / target).read_bytes(), before)

    def test_mask_target_is_checked_first(self):
        result = self.track("--learn-mask", "none/mask.yaml")
        self.assertEqual(result.returncode, 3)
        self.assertIn("none/mask.yaml: cannot be written", result.stderr)
        for more in (("--mask", ""), ("--learn-mask", ""), ("--learn-mask", "m", "--output", "r")):
            self.assertEqual(self.track(*more).returncode, 2, more)

    def test_mask_of_a_body_that_is_not_recognised_is_refused(self):
        (self.dir / "body.yaml").write_text(
            BODY.split("  - name: B")[0].replace(
                "[-110,-60,0],[-55,-60,0],[15,-60,0],[100,-60,0]",
                "[-127,-60,0],[-104,-60,0],[20,-60,0],[390,-60,0]"))
        result = self.track("--learn-mask", "mask.yaml", rec="resting")
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertIn("the body is not found", result.stderr)
        self.assertIn("warning", result.stderr)
        self.assertFalse((self.dir / "mask.yaml").exists())

    def test_large_or_useless_mask_is_warned_of(self):
        for polygon, text in (("[[[0, 0], [639, 0], [639, 60], [0, 60]]]", "12 % of the images of"),
                              ("[]", "masks nothing")):
            (self.dir / "mask.yaml").write_text(
                f"format: stereomotion-mask/1\ncameras:\n  cam0: {polygon}\n")
            warnings = self.record("--mask", "mask.yaml", "--force")["warnings"]
            self.assertTrue(any("mask.yaml" in w and text in w for w in warnings), warnings)
            self.assertIn(text, (self.dir / "run/report.html").read_text())

    def test_report_that_cannot_be_written(self):
        (self.dir / "run/report.html").mkdir(parents=True)
        (self.dir / "run/report.html/file").write_text("")
        result = self.track("--force")
        self.assertEqual(result.returncode, 3, result.stderr)
        state = json.loads((self.dir / "run/run.json").read_text())["state"]
        self.assertEqual(state, "output_failed")

    def test_bad_mask(self):
        (self.dir / "mask.yaml").write_text(
            "format: stereomotion-mask/1\ncameras:\n  cam2: [[[1, 1], [9, 1], [9, 9]]]\n")
        result = self.track("--mask", "mask.yaml")
        self.assertEqual(result.returncode, 2)
        self.assertIn("mask.yaml:3: cameras.cam2: unknown key 'cam2'", result.stderr)
        result = self.track("--mask", "mask.yaml", "--learn-mask", "new.yaml")
        self.assertEqual(result.returncode, 2)

    def test_exposure(self):
        result = self.track("--exposure-ms", 4)
        self.assertIn("--exposure-ms is not used", result.stderr)
        warnings = json.loads((self.dir / "run/run.json").read_text())["warnings"]
        self.assertTrue(any("--exposure-ms is not used" in w for w in warnings), warnings)
        self.assertEqual(self.track("--exposure-ms", -1, output="none").returncode, 2)
        for camera in ("cam0", "cam1"):
            shutil.copytree(self.base / "moving" / camera, self.dir / camera)
            times = self.dir / camera / "timestamps.csv"
            times.write_text("\n".join(line.rsplit(",", 1)[0]
                                       for line in times.read_text().splitlines()) + "\n")
        given = run("track", "--left", "cam0", "--right", "cam1", "--body", "body.yaml", "--output",
                    "given", "--exposure-ms", 8, cwd=self.dir)
        self.assertNotIn("not used", given.stderr)
        record = json.loads((self.dir / "given/run.json").read_text())
        self.assertEqual(record["exposure"]["given_us"], 8000)
        # The same as what the recording told.
        self.assertEqual((self.dir / "given/poses.csv").read_bytes(),
                         (self.dir / "run/poses.csv").read_bytes())

    def test_report(self):
        self.record()
        page = (self.dir / "run/report.html").read_text()
        xml.etree.ElementTree.fromstring(page.replace("<!DOCTYPE html>", ""))
        for text in (f"found in {FRAMES} of {FRAMES} frame pairs", "Noise model", "Path", "cam1"):
            self.assertIn(text, page)
        self.assertNotRegex(page, re.compile(r'(src|href)="|\bnan\b|\binf\b', re.I))

    def test_report_without_poses(self):
        (self.dir / "body.yaml").write_text(
            BODY.split("  - name: B")[0].replace(
                "[-110,-60,0],[-55,-60,0],[15,-60,0],[100,-60,0]",
                "[-127,-60,0],[-104,-60,0],[20,-60,0],[390,-60,0]"))
        result = self.track()
        self.assertEqual(result.returncode, 1, result.stderr)
        page = (self.dir / "run/report.html").read_text()
        xml.etree.ElementTree.fromstring(page.replace("<!DOCTYPE html>", ""))
        self.assertIn("No pose was found", page)


# Two bodies in one: both halves of what the images show are rigid.
UPPER = """format: stereomotion-body/1
name: upper
rods:
  - name: A
    ball_diameter_mm: 20
    balls_mm: [[-150,-60,0],[-110,-60,0],[-55,-60,0],[15,-60,0],[100,-60,0]]
  - name: B
    ball_diameter_mm: 20
    balls_mm: [[-140,-20,30],[-60,-14,36],[-20,-11,39],[35,-6.875,43.125],[140,1,51]]
"""
LOWER = """format: stereomotion-body/1
name: lower
rods:
  - name: A
    ball_diameter_mm: 20
    balls_mm: [[-150,60,0],[-60,60,0],[-30,60,0],[60,60,0],[100,60,0]]
  - name: B
    ball_diameter_mm: 20
    balls_mm: [[-140,100,30],[-110,100,30],[0,100,30],[45,100,30],[140,100,30]]
"""


class SeveralBodies(FolderCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.dir = cls.base
        rods = LOWER.split("rods:\n")[1].replace("name: A", "name: C").replace("name: B", "name: D")
        cls.write(rig=RIG, upper=UPPER, lower=LOWER, body=UPPER + rods)
        cls.simulate((SCENARIO % (1.5, *LAMP_MM, FRAMES)).split("false_balls:")[0]
                     + f"frames: {FRAMES}\nfps: 30\n")

    def track(self, output, *bodies, more=()):
        given = [word for body in bodies for word in ("--body", body)]
        result = run("track", "--left", "rec/cam0", "--right", "rec/cam1", *given, "--output",
                     output, *more, cwd=self.dir)
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads((self.dir / output / "run.json").read_text())

    def test_each_has_its_folder(self):
        record = self.track("two", "upper.yaml", "lower.yaml")
        self.assertEqual([(b["name"], b["folder"], b["tracked"], b["lost"], b["learned"])
                          for b in record["bodies"]],
                         [("upper", "upper", FRAMES, {}, False),
                          ("lower", "lower", FRAMES, {}, False)])
        self.assertEqual(record["frames"]["tracked"], FRAMES)
        self.assertEqual(sum(i["role"] == "body" for i in record["inputs"]), 2)
        self.assertFalse((self.dir / "two/poses.csv").exists())
        for name in ("upper", "lower"):
            folder = self.dir / "two" / name
            for file in ("balls.csv", "body.yaml", "motion.csv", "motion.json", "axes.csv"):
                self.assertTrue((folder / file).exists(), file)
            self.assertTrue(all(row["status"] == "ok" for row in rows(folder / "poses.csv")))
            # A detection is matched by its own body only.
            matched = [row["rod"] != "" for row in rows(folder / "detections.csv")]
            self.assertEqual(sum(matched), FRAMES * 20)
            self.assertEqual(len(matched), FRAMES * 40)
        page = (self.dir / "two/report.html").read_text()
        xml.etree.ElementTree.fromstring(page.replace("<!DOCTYPE html>", ""))
        for text in ("upper: Motion", "lower: Motion", "lower: Path", "upper: the pose was found"):
            self.assertIn(text, page)

    def test_order_decides_nothing(self):
        self.track("one", "upper.yaml", "lower.yaml", more=("--no-motion",))
        self.track("other", "lower.yaml", "upper.yaml", more=("--no-motion", "--threads", 1))
        for name in ("upper", "lower"):
            for file in ("poses.csv", "balls.csv", "detections.csv"):
                self.assertEqual((self.dir / "one" / name / file).read_bytes(),
                                 (self.dir / "other" / name / file).read_bytes(), file)
            self.assertFalse((self.dir / "one" / name / "motion.csv").exists())

    def test_poses_are_those_of_each_alone(self):
        self.track("together", "upper.yaml", "lower.yaml", more=("--no-motion",))
        for name in ("upper", "lower"):
            self.track("alone-" + name, name + ".yaml", more=("--no-motion",))
            self.assertEqual((self.dir / "together" / name / "poses.csv").read_bytes(),
                             (self.dir / ("alone-" + name) / "poses.csv").read_bytes())

    def test_force_leaves_nothing_of_the_run_before(self):
        self.track("again", "upper.yaml", "lower.yaml")
        self.track("again", "upper.yaml", more=("--force",))
        left = {str(p.relative_to(self.dir / "again"))
                for p in (self.dir / "again").rglob("*") if p.is_file()}
        self.assertEqual(left - {"upper/body.yaml", "lower/body.yaml"},
                         {"run.json", "report.html", "rig.yaml", "body.yaml", "poses.csv",
                          "balls.csv", "detections.csv", "motion.csv", "motion.json", "axes.csv"})

    def test_body_that_is_not_there(self):
        (self.dir / "absent.yaml").write_text(LOWER.replace("lower", "absent").replace(
            "[-60,60,0],[-30,60,0],[60,60,0]", "[-95,60,0],[-10,60,0],[35,60,0]").replace(
            "[-110,100,30],[0,100,30],[45,100,30]", "[-60,100,30],[-20,100,30],[90,100,30]"))
        record = self.track("absent", "upper.yaml", "absent.yaml")
        self.assertEqual([b["tracked"] for b in record["bodies"]], [FRAMES, 0])
        self.assertEqual(record["frames"]["tracked"], 0)
        self.assertTrue(any(w.startswith("body 'absent':") for w in record["warnings"]))


class LearnedBody(FolderCase):
    """Without --body: the body is learned, and its file measures the recording as it was."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.dir = cls.base
        cls.write(rig=RIG, body=BODY)
        cls.simulate(SCENARIO % (1.5, *LAMP_MM, FRAMES))

    def track(self, output, *more):
        result = run("track", "--left", "rec/cam0", "--right", "rec/cam1", "--output", output,
                     "--no-motion", *more, cwd=self.dir)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertNotIn("[#", result.stderr)  # a progress bar is for terminals
        record = json.loads((self.dir / output / "run.json").read_text())
        self.assertEqual(record["frames"]["tracked"], FRAMES)
        return record

    def test_its_file_gives_the_same_run(self):
        learned = self.track("learned")
        self.assertTrue(learned["bodies"][0]["learned"])
        self.assertEqual(learned["warnings"], [])
        body = (self.dir / "learned/body.yaml").read_text()
        self.assertIn("covariance:", body)
        again = self.track("again", "--body", "learned/body.yaml")
        self.assertFalse(again["bodies"][0]["learned"])
        for name in ("poses.csv", "balls.csv", "detections.csv"):
            self.assertEqual((self.dir / "learned" / name).read_bytes(),
                             (self.dir / "again" / name).read_bytes(), name)
        # ... and, a body of no covariance changes no pose: that is a common part only.
        plain = body.split("covariance:")[0]
        (self.dir / "plain.yaml").write_text(plain)
        self.track("plain", "--body", "plain.yaml")
        self.assertEqual((self.dir / "learned/poses.csv").read_bytes(),
                         (self.dir / "plain/poses.csv").read_bytes())


class Motion(FolderCase):
    """The end of a run of one body."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.dir = cls.base
        cls.write(rig=RIG + NOISE, body=BODY)
        cls.simulate(SCENARIO % (1.5, *LAMP_MM, FRAMES))

    def track(self, *more):
        return run("track", "--left", "rec/cam0", "--right", "rec/cam1", "--body", "body.yaml",
                   *more, cwd=self.dir)

    def test_motion_is_written_and_told(self):
        result = self.track("--output", "run")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("rotation", result.stdout)
        self.assertEqual(result.stdout.splitlines()[-1], "run")
        self.assertEqual(len(rows(self.dir / "run/motion.csv")), FRAMES)
        answer = json.loads((self.dir / "run/motion.json").read_text())
        self.assertEqual(answer["format"], "stereomotion-motion/1")
        page = (self.dir / "run/report.html").read_text()
        for text in ("Angular velocity", "law of the centre", "Evidence for the law"):
            self.assertIn(text, page)
        self.assertNotRegex(page, re.compile(r"\bnan\b|\binf\b", re.I))

    def test_copies_are_what_the_run_used(self):
        self.track("--output", "first", "--no-motion")
        again = run("track", "--left", "rec/cam0", "--right", "rec/cam1", "--rig", "first/rig.yaml",
                    "--body", "first/body.yaml", "--output", "second", "--no-motion", cwd=self.dir)
        self.assertEqual(again.returncode, 0, again.stderr)
        for file in ("poses.csv", "balls.csv", "rig.yaml"):
            kept = [(self.dir / run / file).read_text() for run in ("first", "second")]
            if file == "rig.yaml":  # the source it names differs
                kept = [re.sub(r".*source.*\n", "", text) for text in kept]
            self.assertEqual(*kept, file)

    def test_one_pose_does_not_lose_the_run(self):
        result = self.track("--output", "short", "--count", 1)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(len(rows(self.dir / "short/poses.csv")), 1)
        record = json.loads((self.dir / "short/run.json").read_text())
        self.assertEqual(record["state"], "done")
        self.assertTrue((self.dir / "short/report.html").exists())

    def test_users_files_are_never_overwritten(self):
        before = [(self.dir / name).read_bytes() for name in ("rig.yaml", "body.yaml")]
        result = self.track("--output", ".", "--force", "--count", 3)
        self.assertEqual(result.returncode, 0, result.stderr)
        result = self.track("--output", ".", "--force", "--count", 2)  # now it is a RUN
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(before, [(self.dir / n).read_bytes() for n in ("rig.yaml", "body.yaml")])


if __name__ == "__main__":
    main()
