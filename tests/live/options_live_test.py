#!/usr/bin/env python3
"""What `track` does with live cameras besides tracking: streams, learns bodies, checks sizes, drops.

Usage: options_live_test.py PATH/TO/stereomotion PATH/TO/stereomotion_gv_server [unittest options]
"""

import hashlib
import json
import pathlib
import resource
import signal
import socket
import subprocess
import sys
import time

from live_case import LEFT, RIGHT, RIG, LiveCase, main, rows, run, small_recording

CLIENT = pathlib.Path(__file__).resolve().parents[2] / "examples" / "stream_client.py"
PORT = 42312  # in a network of our own


class OptionsLive(LiveCase):
    def test_stream_says_what_poses_csv_says(self):
        client = subprocess.Popen(
            [sys.executable, CLIENT, f"tcp://127.0.0.1:{PORT}", "--json", "--wait-s", "30"],
            text=True, stdout=subprocess.PIPE)
        with self.server():
            result = self.track("--duration", 5, "--stream", f"tcp://127.0.0.1:{PORT}")
        out, _ = client.communicate(timeout=30)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(client.returncode, 0)
        messages = [json.loads(line) for line in out.splitlines()]
        self.assertTrue(messages[0]["live"])
        self.assertEqual(messages[-1]["end"], "duration")
        table = {int(row["frame"]): row for row in rows(self.dir / "run" / "poses.csv")}
        poses = [message for message in messages if "frame" in message]
        self.assertGreater(len(poses), 20)
        for pose in poses:
            row = table[pose["frame"]]
            self.assertEqual((pose["timestamp_ns"], pose["status"]),
                             (int(row["timestamp_ns"]), row["status"]))
            self.assertGreater(pose["latency_ms"], 0)
            if pose["status"] == "ok":
                # poses.csv is corrected for the motion within the exposure.
                self.assertAlmostEqual(pose["t_mm"][0], float(row["tx_mm"]), delta=0.05)

    def test_bodies_are_learned_first(self):
        with self.server():
            result = run("track", "--left", LEFT, "--right", RIGHT, "--rig",
                         self.base / "rig.yaml", "--output", self.dir / "run", "--learn-s", 3,
                         "--count", 20, "--no-motion", "--queue-s", 60, cwd=self.dir)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("move and turn them", result.stderr)
        self.assertTrue((self.dir / "run" / "learn.h5").exists())
        self.assertTrue((self.dir / "run" / "body.yaml").exists())
        self.assertTrue(self.result()["bodies"][0]["learned"])
        table = rows(self.dir / "run" / "poses.csv")
        self.assertGreater(sum(row["status"] == "ok" for row in table), 15)
        self.assertEqual(self.result()["live"]["pairs"], 20)

    def test_what_cannot_be_written_is_told_before_learning(self):
        learn = ("track", "--left", LEFT, "--right", RIGHT, "--rig", self.base / "rig.yaml",
                 "--output", "run", "--learn-s", 60)
        (self.dir / "old.h5").write_text("precious")
        with self.server(), socket.socket() as taken:
            result = run(*learn, "--record", "old.h5", cwd=self.dir, timeout=30)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertIn("old.h5: exists", result.stderr)
            self.take_port(taken)
            result = run(*learn, "--stream", f"tcp://127.0.0.1:{PORT}", cwd=self.dir, timeout=30)
            self.assertEqual(result.returncode, 3, result.stderr)
            self.assertIn("cannot listen there", result.stderr)
        self.assertFalse((self.dir / "run").exists())

    def test_run_and_recording_stay_where_the_new_one_cannot_start(self):
        with self.server():
            first = self.track("--count", 5, "--record", "rec.h5")
            self.assertEqual(first.returncode, 0, first.stderr)
            before = self.files()
            force = ("--force", "--record", "rec.h5")
            absent = run(*["aravis:127.0.0.9" if one == RIGHT else one
                           for one in self.arguments(*force)], cwd=self.dir)
            self.assertEqual(absent.returncode, 3, absent.stderr)
            self.assertEqual(self.files(), before)
            with socket.socket() as taken:
                self.take_port(taken)
                busy = self.track(*force, "--stream", f"tcp://127.0.0.1:{PORT}")
            self.assertEqual(busy.returncode, 3, busy.stderr)
            self.assertEqual(self.files(), before)
            both = self.track("--force", "--record", "run")
            self.assertEqual(both.returncode, 2, both.stderr)
            self.assertEqual(self.files(), before)

    @staticmethod
    def take_port(taken):
        taken.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)  # of another test
        taken.bind(("127.0.0.1", PORT))
        taken.listen()

    def files(self):
        return {file: hashlib.sha256(file.read_bytes()).hexdigest() for file in self.dir.rglob("*")
                if file.is_file() and not file.name.startswith("server-")}

    def test_one_camera_under_two_names(self):
        with self.server():
            for name in ("aravis:L", "aravis:Aravis-Fake-L"):
                result = run(*[name if one == RIGHT else one for one in self.arguments()],
                             cwd=self.dir)
                self.assertEqual(result.returncode, 2, result.stderr)
                for word in (LEFT, name, "both are the same camera"):
                    self.assertIn(word, result.stderr)

    def test_warnings_are_told_once(self):
        with self.server(right=("--rate-factor", 1.02)):
            result = self.track("--duration", 8)
        self.assertIn(result.returncode, (0, 1), result.stderr)
        self.assertEqual(result.stderr.count("free-run against each other"), 1, result.stderr)

    def test_closed_terminal_ends_cleanly(self):
        with self.server():
            process = self.start_track("--queue-s", 60)
            self.wait_for_rows(10)
            process.send_signal(signal.SIGHUP)
            self.assertEqual(process.wait(30), 0, (self.dir / "run.log").read_text())
        self.assertEqual(self.result()["live"]["end"], "interrupted")

    def test_interrupt_while_the_cameras_are_opened(self):
        (self.dir / "rec.h5").write_text("precious")
        arguments = ["aravis:127.0.0.9" if one == RIGHT else one
                     for one in self.arguments("--record", "rec.h5", "--force")]
        with self.server():
            process = subprocess.Popen([small_recording.program, *map(str, arguments)],
                                       cwd=self.dir, stderr=subprocess.DEVNULL)
            while process.poll() is None and not (self.dir / "run").exists():
                time.sleep(0.01)
            # Asking for a camera that is not there takes seconds.
            process.send_signal(signal.SIGINT)
            self.assertEqual(process.wait(30), 3)
        self.assertEqual((self.dir / "rec.h5").read_text(), "precious")

    def test_recording_that_fails_is_told_at_once(self):
        with self.server():
            process = self.start_track("--duration", 8, "--record", "rec.h5", "--queue-s", 60)
            self.wait_for_rows(10)
            (self.dir / "rec.h5.segments").rename(self.dir / "away")  # as if the disk were gone
            self.assertEqual(process.wait(60), 3)
        told = (self.dir / "run.log").read_text()
        live = self.result()["live"]
        self.assertEqual(live["end"], "duration")
        self.assertTrue(live["problem"])
        self.assertEqual(live["problem"], live["recorded"]["problem"])
        self.assertEqual(told.count("the recording has ended"), 1, told)
        self.assertNotIn("too slow", told)

    def test_rig_of_another_image_size(self):
        text = (self.base / "rig.yaml").read_text().replace("[640, 512]", "[640, 480]")
        (self.dir / "rig.yaml").write_text(text)
        with self.server():
            result = run("track", "--left", LEFT, "--right", RIGHT, "--body",
                         self.base / "body.yaml", "--output", "run", cwd=self.dir)
        self.assertEqual(result.returncode, 2, result.stderr)
        for word in (LEFT, "640 x 512", "640 x 480", "rig.yaml", "cam0"):
            self.assertIn(word, result.stderr)
        self.assertFalse((self.dir / "run").exists())

    def test_what_is_dropped_is_told(self):
        """With room for a pair or two only, the while that learning the noise takes is lost."""
        (self.dir / "rig.yaml").write_text(RIG)  # without noise
        self.rate_hz = 100
        with self.server():
            result = run("track", "--left", LEFT, "--right", RIGHT, "--body",
                         self.base / "body.yaml", "--output", "run", "--duration", 5, "--queue-s",
                         0.01, "--threads", 1, "--detector", "wavelet", "--no-motion",
                         cwd=self.dir)
        self.assertIn(result.returncode, (0, 1), result.stderr)
        statuses = self.statuses(self.check_poses(least=0))
        record = self.result()
        self.assertEqual(statuses.get("dropped", 0), record["live"]["dropped_pairs"])
        self.assertEqual(statuses.get("dropped", 0), record["frames"]["lost"].get("dropped", 0))
        self.assertEqual(sum(statuses.values()), record["frames"]["read"])
        self.assert_counts_add_up()

    def test_software_trigger_as_the_rig_says(self):
        text = (self.base / "rig.yaml").read_text()
        for name, uri in (("cam0", LEFT), ("cam1", RIGHT)):
            block = f'{{camera: "{uri}", trigger: software, frame_rate_hz: 8, exposure_us: 900}}'
            text = text.replace(f"- name: {name}\n", f"- name: {name}\n    source: {block}\n")
        (self.dir / "rig.yaml").write_text(text)
        with self.server():
            result = run("track", "--left", "cam0", "--right", "cam1", "--body",
                         self.base / "body.yaml", "--output", "run", "--count", 15, "--no-motion",
                         "--exposure-us", 1100, cwd=self.dir)
        self.assertEqual(result.returncode, 0, result.stderr)
        live = self.result()["live"]
        self.assertEqual(live["pairs"], 15)
        self.assertGreater(live["period_s"], 0.1)
        self.assertIn("trigger: software", (self.dir / "run" / "rig.yaml").read_text())

    def test_full_disk_ends_the_run_and_the_cameras(self):
        def small_files():
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (60000, 60000))

        with self.server():
            result = run(*self.arguments("--duration", 60), cwd=self.dir, timeout=50,
                         preexec_fn=small_files)
            self.assertEqual(result.returncode, 3, result.stderr)
            self.assertIn("cannot be written", result.stderr)
            record = self.result()
            self.assertEqual((record["state"], record["live"]["end"]),
                             ("output_failed", "output_failed"))
            # The cameras are free again.
            again = self.track("--count", 3, output="again")
        self.assertEqual(again.returncode, 0, again.stderr)

    def test_camera_that_is_not_there(self):
        with self.server():
            result = run("track", "--left", LEFT, "--right", "aravis:127.0.0.9", "--rig",
                         self.base / "rig.yaml", "--body", self.base / "body.yaml", "--output",
                         "run", cwd=self.dir)
        self.assertEqual(result.returncode, 3, result.stderr)
        self.assertIn("aravis:127.0.0.9", result.stderr)
        self.assertFalse((self.dir / "run").exists())


if __name__ == "__main__":
    main()
