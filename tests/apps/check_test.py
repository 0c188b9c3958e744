#!/usr/bin/env python3
"""Runs `check` on recordings that are as they should be, and on spoilt ones: what is wrong is said.

Usage: check_test.py PATH/TO/stereomotion [unittest options]
The recordings are rendered by the program itself; Python's standard library is all it takes.
"""

import json
import shutil

from small_recording import BODY, NOISE, RIG, FolderCase, main, run

SCENARIO = """format: stereomotion-scenario/1
name: check
rig: %s
body: %s
motion:
  law: fixed
  center_in_world_mm: [0, 0, 0]
  axis: [0, 0.3, 1]
  rate_rad_s: %g
%s
frames: %d
fps: 30
"""
MANY, FEW = 10, 3  # the fewest that tell a drift; as few as tell the rest, for rendering takes time
# The cameras see one rod and a half of it; the file says two.
HALF_BODY = BODY[:BODY.index("  - name: B")].replace(",[15,-60,0],[100,-60,0]]", "]")
SMALL_BODY = BODY.replace("ball_diameter_mm: 20", "ball_diameter_mm: 6")


class Check(FolderCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.write(rig=RIG, noisy=RIG + NOISE, body=BODY, half=HALF_BODY, small=SMALL_BODY)
        cls.render("good", frames=MANY)
        cls.render("dark", "light: {ball_level: 0.012, background_level: 0.004}")
        cls.render("bright", "light: {ball_level: 1.3}")
        cls.render("glaring", "light: {ball_level: 4}")
        cls.render("blurred", "light: {blur_px: 3}")
        cls.render("grey", "light: {ball_level: 0.9, background_level: 0.5}")
        cls.render("fast", "sensor: {exposure_s: 0.016}", rate=12)
        cls.render("half", body="half.yaml")
        cls.render("small", body="small.yaml")

    @classmethod
    def render(cls, name, more="", body="body.yaml", rate=1.5, frames=FEW):
        cls.simulate(SCENARIO % ("rig.yaml", body, rate, more, frames), name)

    def check(self, rec, *more, left=None, right=None):
        return run("check", "--left", left or f"{rec}/cam0", "--right", right or f"{rec}/cam1",
                   *more, cwd=self.base)

    def findings(self, rec, *more, code=None, **cameras):
        result = self.check(rec, "--json", *more, **cameras)
        self.assertIn(result.returncode, (0, 1), result.stderr)
        document = json.loads(result.stdout)
        self.assertEqual(document["format"], "stereomotion-check/1")
        self.assertEqual(document["ready"], result.returncode == 0)
        if code is not None:
            self.assertEqual(result.returncode, code, result.stdout)
        worst = {}
        order = ("good", "mind", "mend")
        for finding in document["findings"]:
            before = worst.get(finding["topic"])
            if before is None or order.index(finding["verdict"]) > order.index(before["verdict"]):
                worst[finding["topic"]] = finding
            if finding["verdict"] == "mend":
                self.assertTrue(finding["advice"], finding)
        return worst

    def body(self, rec, **options):
        return self.findings(rec, "--rig", "rig.yaml", "--body", "body.yaml", **options)

    def test_good_recording_is_ready(self):
        found = self.body("good", code=0)
        for topic, finding in found.items():
            self.assertEqual(finding["verdict"], "good", finding)
        for topic in ("rate", "sync", "image_size", "balls", "exposure", "background", "focus",
                      "smear", "size", "coverage", "noise", "body", "body_balls", "residuals",
                      "reflections"):
            self.assertIn(topic, found)
        self.assertAlmostEqual(found["rate"]["values"]["rate_hz"], 30, delta=0.1)
        self.assertAlmostEqual(found["focus"]["values"]["blur_px"], 0.6, delta=0.1)
        # 20 mm at 1.5 m, f = 800 px
        self.assertAlmostEqual(found["size"]["values"]["diameter_px"], 10.7, delta=0.5)
        self.assertEqual(found["balls"]["values"]["balls"], 10)
        self.assertEqual(found["body"]["values"]["pose_share"], 1)

    def test_words_for_a_person(self):
        result = self.check("good")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertTrue(result.stdout.rstrip().endswith("READY"), result.stdout)
        result = self.check("blurred")
        self.assertEqual(result.returncode, 1)
        self.assertIn("MEND  focus", result.stdout)
        self.assertIn("NOT READY", result.stdout)

    def test_without_rig_and_body(self):
        (self.base / "bare").mkdir()  # without rig.yaml
        result = run("check", "--left", "../good/cam0", "--right", "../good/cam1", "--json",
                     cwd=self.base / "bare")
        self.assertEqual(result.returncode, 0, result.stderr)
        found = {finding["topic"] for finding in json.loads(result.stdout)["findings"]}
        self.assertIn("focus", found)
        self.assertNotIn("body", found)
        self.assertNotIn("image_size", found)

    def test_dark(self):
        found = self.findings("dark", code=1)
        self.assertEqual(found["exposure"]["verdict"], "mend")
        self.assertIn("too dark", found["exposure"]["advice"])

    def test_saturated(self):
        found = self.findings("bright", code=1)
        self.assertEqual(found["exposure"]["verdict"], "mend")
        self.assertIn("too bright", found["exposure"]["advice"])

    def test_far_too_bright_to_be_balls(self):
        found = self.findings("glaring", code=1)
        self.assertEqual(found["balls"]["verdict"], "mend")
        self.assertIn("too bright", found["balls"]["advice"])

    def test_blurred(self):
        found = self.body("blurred", code=1)
        self.assertEqual(found["focus"]["verdict"], "mend")
        self.assertIn("focus", found["focus"]["advice"])
        self.assertGreater(found["focus"]["values"]["blur_px"], 2.5)

    def test_bright_background(self):
        found = self.findings("grey")
        self.assertEqual(found["background"]["verdict"], "mind")

    def test_motion_smear(self):
        found = self.findings("fast")
        self.assertGreater(found["smear"]["values"]["smear_px"], 3)

    def test_half_of_the_balls_hidden(self):
        found = self.body("half", code=1)
        self.assertEqual(found["body"]["verdict"], "mend", found["body"])

    def test_small_balls(self):
        found = self.findings("small")
        self.assertNotEqual(found["size"]["verdict"], "good")
        self.assertLess(found["size"]["values"]["diameter_px"], 6)

    def test_cameras_exchanged(self):
        """The rig then belongs to other cameras: no pose, or none that fits."""
        shutil.copytree(self.base / "good" / "cam1", self.base / "swapped" / "cam0")
        shutil.copytree(self.base / "good" / "cam0", self.base / "swapped" / "cam1")
        found = self.body("swapped", code=1)
        self.assertEqual(found["body"]["verdict"], "mend")
        self.assertIn("the cameras are swapped", found["body"]["advice"])

    def shifted(self, name, times):
        """A copy whose right images have other times."""
        shutil.copytree(self.base / "good", self.base / name)
        file = self.base / name / "cam1" / "timestamps.csv"
        lines = file.read_text().splitlines()
        for i, line in enumerate(lines[1:]):
            cells = line.split(",")
            cells[1] = str(int(cells[1]) + times(i))
            lines[i + 1] = ",".join(cells)
        file.write_text("\n".join(lines) + "\n")

    def test_free_running_cameras(self):
        self.shifted("drifting", lambda i: i * 500_000)  # half a millisecond a frame
        found = self.findings("drifting", code=1)
        self.assertEqual(found["sync"]["verdict"], "mend")
        self.assertIn("trigger", found["sync"]["advice"])

    def test_images_without_partner(self):
        self.shifted("partners", lambda i: 17_000_000)  # more than half a period
        found = self.findings("partners", code=1)
        self.assertEqual(found["sync"]["verdict"], "mend")

    def test_no_ball(self):
        folder = self.base / "nothing"
        for camera in ("cam0", "cam1"):
            (folder / camera).mkdir(parents=True)
            for i in range(8):
                pixels = bytes((u * 7 + v * 13 + i * 5) % 3 + 2
                               for v in range(96) for u in range(128))
                (folder / camera / f"{i}.pgm").write_bytes(b"P5\n128 96\n255\n" + pixels)
        found = self.findings("nothing", "--fps", 30, code=1)
        self.assertEqual(found["balls"]["verdict"], "mend")
        self.assertIn("lens cap", found["balls"]["advice"])
        self.assertEqual(found["sync"]["verdict"], "mind", "paired without times")

    def test_other_image_size(self):
        (self.base / "other.yaml").write_text(RIG.replace("[640, 512]", "[1280, 1024]"))
        found = self.findings("good", "--rig", "other.yaml", "--body", "body.yaml", code=1)
        self.assertEqual(found["image_size"]["verdict"], "mend")
        self.assertNotIn("body", found)

    def test_wrong_use(self):
        for arguments, words in (
                (("--exposure-us", "1000"), ("--exposure-us", "live")),
                (("--rig", "none.yaml"), ("none.yaml",)),
                (("--rig", "rig.yaml", "--body", "none.yaml"), ("none.yaml",))):
            result = self.check("good", *arguments)
            self.assertEqual(result.returncode, 2, result.stdout + result.stderr)
            for word in words:
                self.assertIn(word, result.stderr)
        self.assertEqual(self.check("none").returncode, 2)


if __name__ == "__main__":
    main()
