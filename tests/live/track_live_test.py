#!/usr/bin/env python3
"""Runs `cameras`, `check`, `record` and `track` over real GigE Vision on loopback, fault free.

Usage: track_live_test.py PATH/TO/stereomotion PATH/TO/stereomotion_gv_server [unittest options]
"""

import json
import subprocess

from live_case import LEFT, RIGHT, LiveCase, main, run

PAIRS = 50
COMPARED = ("poses.csv", "balls.csv", "detections.csv")


class TrackLive(LiveCase):
    # Nothing may be dropped where a replay is compared: a slow machine gets a long queue.
    PATIENT = ("--queue-s", 60)

    def replay(self, recording="rec.h5", output="replay", *more):
        result = run(
            "track", "--recording", recording, "--rig", self.base / "rig.yaml", "--body",
            self.base / "body.yaml", "--output", output, "--no-motion", *more, cwd=self.dir)
        self.assertEqual(result.returncode, 0, result.stderr)

    def assert_same(self, first, second):
        for name in COMPARED:
            left, right = self.dir / first / name, self.dir / second / name
            self.assertTrue(left.read_bytes() == right.read_bytes(),
                            subprocess.run(["diff", left, right], capture_output=True, text=True,
                                           check=False).stdout[:2000])

    def test_replay_of_what_was_recorded_gives_the_same_bytes(self):
        with self.server():
            result = self.track("--record", "rec.h5", "--count", PAIRS, *self.PATIENT)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.check_poses(least=PAIRS - 2)
        self.assertEqual(self.result()["live"]["dropped_pairs"], 0)
        self.assert_counts_add_up()
        self.replay()
        self.assert_same("run", "replay")

    def test_searching_around_known_balls_is_replayed_the_same(self):
        more = ("--search-every", 5)
        with self.server():
            result = self.track("--record", "rec.h5", "--count", PAIRS, *self.PATIENT, *more)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.check_poses(least=PAIRS - 2)
        self.replay("rec.h5", "replay", *more)
        self.assert_same("run", "replay")

    def test_what_record_wrote_is_tracked(self):
        with self.server():
            result = run("record", "--left", LEFT, "--right", RIGHT, "--output",
                                         "rec.h5", "--count", PAIRS, cwd=self.dir)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.replay()
        self.check_poses(least=PAIRS - 2, output="replay")

    def test_cameras_are_listed(self):
        with self.server():
            result = run("cameras", "--json", cwd=self.dir)
        self.assertEqual(result.returncode, 0, result.stderr)
        found = {camera["address"]: camera for camera in json.loads(result.stdout)}
        left = found["127.0.0.1"]
        self.assertEqual((left["width_px"], left["height_px"]), self.size)
        self.assertEqual(left["serial"], "L")
        self.assertIn("Mono8", left["pixel_formats"])
        self.assertTrue(left["uri"].startswith("aravis:"), left)
        self.assertEqual(found["127.0.0.2"]["serial"], "R")

    def test_no_camera_says_what_to_check(self):
        result = run("cameras", cwd=self.dir)
        self.assertEqual(result.returncode, 1, result.stdout)
        self.assertIn("no camera found", result.stderr)

    def test_check_finds_all_well(self):
        with self.server():
            result = run(
                "check", "--left", LEFT, "--right", RIGHT, "--rig", self.base / "rig.yaml",
                "--body", self.base / "body.yaml", "--seconds", 1.5, "--json", cwd=self.dir)
        self.assertIn(result.returncode, (0, 1), result.stdout + result.stderr)
        found = json.loads(result.stdout)
        self.assertEqual(found["ready"], result.returncode == 0)
        for finding in found["findings"]:
            # A busy machine loses images; that is not what is tested here.
            if finding["topic"] not in ("rate", "sync", "camera"):
                self.assertEqual(finding["verdict"], "good", finding)

    def test_cameras_are_opened_by_serial_and_by_name_of_the_rig(self):
        text = (self.base / "rig.yaml").read_text()
        for name, serial in (("cam0", "L"), ("cam1", "R")):
            text = text.replace(f"- name: {name}\n",
                                f"- name: {name}\n    source: aravis:{serial}\n")
        (self.dir / "rig.yaml").write_text(text)
        with self.server():
            result = run("track", "--left", "cam0", "--right", "cam1", "--body",
                                         self.base / "body.yaml", "--output", "run", "--count", 20,
                                         "--no-motion", *self.PATIENT, cwd=self.dir)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.check_poses(least=18)

    def test_interrupt_ends_cleanly(self):
        with self.server():
            process = self.start_track(*self.PATIENT)
            self.wait_for_rows(10)
            process.terminate()
            self.assertEqual(process.wait(30), 0, (self.dir / "run.log").read_text())
        table = self.check_poses(least=8)
        record = self.result()
        self.assertEqual((record["state"], record["live"]["end"]), ("done", "interrupted"))
        self.assertEqual(record["frames"]["read"], len(table))

    def test_latency_is_reported(self):
        with self.server():
            result = self.track("--count", 30)
        self.assertEqual(result.returncode, 0, result.stderr)
        latency = self.result()["live"]["latency_ms"]
        self.assertGreater(latency["median"], 0)
        self.assertGreaterEqual(latency["p99"], latency["median"])


if __name__ == "__main__":
    main()
