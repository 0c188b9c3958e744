#!/usr/bin/env python3
"""Tracks over GigE Vision while something fails: no wrong pair is ever measured.

Usage: faults_test.py PATH/TO/stereomotion PATH/TO/stereomotion_gv_server [Packets|Links|Clocks]
"""

import signal
import subprocess
import time

from live_case import LEFT, LiveCase, Server, Truth, main, run

# What is measured is recorded, too: its images tell when they were taken.
PATIENT = ("--queue-s", 60, "--record", "rec")
HOUR_S = 3600


class FaultCase(LiveCase):
    def assert_done(self, result, code=0):
        self.assertEqual(result.returncode, code, result.stderr)


class Packets(FaultCase):
    def test_few_packets_are_lost(self):
        """0.1 ‰ of jumbo packets: 95 % of the pairs are whole at least."""
        with self.server("--lost-per-mille", 0.1):
            result = self.track("--packet-size", 8000, "--duration", 4, *PATIENT)
        self.assert_done(result)
        self.check_poses(least=60)
        self.check_stamps(least=60)
        # Images that the busy host did not even send are no lost packets' fault.
        live = self.result()["live"]
        torn = sum(camera["counts"]["incomplete"] for camera in live["cameras"])
        self.assertGreaterEqual(live["pairs"], 0.95 * (live["pairs"] + torn), torn)
        self.assert_counts_add_up()

    def test_many_packets_are_lost(self):
        """2 ‰ of small packets: many images are torn, none of them is measured."""
        with self.server("--lost-per-mille", 2):
            result = self.track("--packet-size", 1400, "--duration", 4, *PATIENT)
        self.assert_done(result)
        self.check_poses(least=10)
        self.check_stamps(least=10)
        counts = [camera["counts"] for camera in self.result()["live"]["cameras"]]
        self.assertGreater(sum(count["incomplete"] for count in counts), 10, counts)
        self.assert_counts_add_up()


class Links(FaultCase):
    """Cameras, links and clients fail."""

    def test_the_link_is_cut_for_a_second(self):
        with self.server():
            process = self.start_track("--duration", 7, *PATIENT)
            self.wait_for_rows(10)
            subprocess.run(["ip", "link", "set", "lo", "down"], check=True)
            time.sleep(1)
            subprocess.run(["ip", "link", "set", "lo", "up"], check=True)
            self.assertEqual(process.wait(60), 0, (self.dir / "run.log").read_text())
        table = self.check_poses(least=50)
        self.check_stamps(least=50)
        times = [int(row["timestamp_ns"]) for row in table]
        self.assertGreater(max(b - a for a, b in zip(times, times[1:])), 0.9e9, "no gap at all")

    def test_a_camera_is_restarted(self):
        """The run goes on with both when it is back; meanwhile left images have no partner."""
        with Server(self.dir, *self.common(), *self.camera("cam0")):
            right = Server(self.dir, *self.common(), *self.camera("cam1"))
            process = self.start_track("--duration", 16, *PATIENT)
            self.wait_for_rows(10)
            right.kill()
            time.sleep(1)
            with Server(self.dir, *self.common(), *self.camera("cam1")):
                self.assertEqual(process.wait(90), 0, (self.dir / "run.log").read_text())
        table = self.check_poses(least=100)
        self.assertGreater(self.result()["live"]["cameras"][1]["counts"]["reopened"], 0)
        self.check_stamps(least=100)
        after = [row["status"] for row in table[-25:]]
        self.assertGreaterEqual(after.count("ok"), 10, "not measured again after the restart")

    def test_a_camera_that_counts_from_zero_after_its_restart(self):
        """Frame numbers and clock begin anew: a new epoch, paired anew."""
        with Server(self.dir, *self.common(), *self.camera("cam0")):
            right = Server(self.dir, *self.common(), *self.camera("cam1", "--clock-from-start"))
            process = self.start_track("--duration", 16, *PATIENT)
            self.wait_for_rows(10)
            right.kill()
            with Server(self.dir, *self.common(), *self.camera("cam1", "--clock-from-start")):
                self.assertEqual(process.wait(90), 0, (self.dir / "run.log").read_text())
        table = self.check_poses(least=100)
        self.check_stamps(least=100)
        after = [row["status"] for row in table[-25:]]
        self.assertGreaterEqual(after.count("ok"), 10, "not measured again after the restart")

    def test_a_camera_that_never_comes_back_ends_the_run(self):
        with Server(self.dir, *self.common(), *self.camera("cam0")):
            right = Server(self.dir, *self.common(), *self.camera("cam1"))
            process = self.start_track("--reconnect-s", 2, *PATIENT)
            self.wait_for_rows(10)
            right.kill()
            self.assertEqual(process.wait(60), 3)
        self.check_poses(least=8)
        self.assertEqual(self.result()["live"]["end"], "camera_lost")
        log = (self.dir / "run.log").read_text()
        self.assertIn("127.0.0.2", log)

    def test_a_killed_client_is_replaced_at_once(self):
        """The cameras are still controlled by the dead one for some seconds."""
        with self.server():
            process = self.start_track(output="killed")
            self.wait_for_rows(5, output="killed")
            process.send_signal(signal.SIGKILL)
            process.wait()
            result = self.track("--count", 40, *PATIENT)
        self.assert_done(result)
        self.check_poses(least=38)

    def test_a_camera_is_controlled_by_another_program(self):
        with self.server():
            process = self.start_track("--duration", 30, output="first")
            self.wait_for_rows(5, output="first")
            result = self.track("--count", 20, output="second")
            process.terminate()
            process.wait(30)
        self.assertEqual(result.returncode, 3, result.stderr)
        self.assertIn("127.0.0.1", result.stderr)
        self.assertIn("controlled", result.stderr)
        self.check_poses(output="first", least=5)

    def test_a_camera_that_falls_silent(self):
        """It answers, but sends no images: it is opened anew."""
        with self.server(right=("--frames", 30)):
            result = self.track("--duration", 13, *PATIENT)
        self.assert_done(result)
        self.check_poses(least=30)
        self.check_stamps(least=30)
        live = self.result()["live"]
        self.assertGreater(live["cameras"][1]["counts"]["reopened"], 0)
        self.assertTrue(any("no image came" in text for text in live["warnings"]), live["warnings"])


class Clocks(FaultCase):
    """Clocks, frame numbers and formats are odd."""

    def test_one_camera_is_faster(self):
        """0.3 %: the cameras are in step for moments only; only those are measured."""
        with self.server(right=("--rate-factor", 1.003)):
            result = self.track("--duration", 7, *PATIENT)
        self.check_poses(least=0)
        self.check_stamps(most_us=1e6 / self.rate_hz / 4, least=0)
        self.assertIn(result.returncode, (0, 1), result.stderr)
        live = self.result()["live"]
        self.assertTrue(live["free_running"], live)
        self.assertTrue(any("trigger" in warning for warning in live["warnings"]), live["warnings"])

    def test_clocks_are_hours_apart(self):
        offset_s = 5 * HOUR_S
        with self.server(right=("--clock-offset-s", offset_s)):
            result = self.track("--duration", 3, *PATIENT)
        self.assert_done(result)
        self.check_poses(least=25)
        self.check_stamps(least=25)
        live = self.result()["live"]
        self.assertAlmostEqual(live["clock_offset_s"], offset_s, delta=0.02)

    def test_the_left_clock_is_hours_behind(self):
        offset_s = -7 * HOUR_S
        with self.server(left=("--clock-offset-s", offset_s)):
            result = self.track("--duration", 3, *PATIENT)
        self.assert_done(result)
        self.check_poses(Truth(self.base / "served", self.rate_hz, offset_s), least=25)

    def test_clocks_are_about_a_period_apart(self):
        """By their times alone each image fits the neighbour of its true partner nearly as well."""
        for offset_s in (0.041, -0.02, 0.012):
            with self.subTest(offset_s=offset_s):
                output, recording = f"run{offset_s}", f"rec{offset_s}"
                with self.server(right=("--clock-offset-s", offset_s)):
                    result = self.track("--duration", 3, "--queue-s", 60, "--record", recording,
                                        output=output)
                self.assert_done(result)
                self.check_poses(output=output, least=25)
                self.check_stamps(recording=recording, least=25)

    def test_a_clock_drifts(self):
        """100 ppm against the other: 1 ms in 10 s."""
        with self.server(right=("--clock-drift-ppm", 100, "--clock-offset-s", 1000)):
            result = self.track("--duration", 5, *PATIENT)
        self.assert_done(result)
        self.check_poses(least=60)
        self.check_stamps(least=60)

    def test_frame_numbers_wrap(self):
        """16 bit; one camera without 0, the other with it."""
        with self.server(left=("--first-id", 65500),
                         right=("--first-id", 65510, "--ids-with-zero")):
            result = self.track("--count", 80, *PATIENT)
        self.assert_done(result)
        table = self.check_poses(least=78)
        self.check_stamps(least=78)
        # One a period, whatever the camera's counter does and the host's load makes it skip.
        truth = Truth(self.base / "served", self.rate_hz)
        starts = {truth.tick(int(row["timestamp_ns"])) - int(row["frame"]) for row in table}
        self.assertEqual(len(starts), 1, starts)
        self.assertGreater(int(table[-1]["frame"]), 70)

    def test_a_pixel_format_that_the_camera_does_not_have(self):
        with self.server():
            result = self.track("--pixel-format", "Mono12Packed")
        self.assertEqual(result.returncode, 3, result.stderr)
        self.assertIn("Mono12Packed", result.stderr)
        self.assertIn("Mono8", result.stderr, "the message must say what is offered")
        self.assertFalse((self.dir / "run").exists())

    def test_a_camera_that_changes_its_format(self):
        """What is not the format agreed on is counted, never measured."""
        with self.server(right=("--change-format-after", 40)):
            result = self.track("--duration", 6, *PATIENT)
        self.check_poses(least=10)
        self.assertIn(result.returncode, (0, 3), result.stderr)
        counts = self.result()["live"]["cameras"][1]["counts"]
        self.assertGreater(counts["wrong_format"], 10, counts)

    def test_a_missing_camera(self):
        with Server(self.dir, *self.common(), *self.camera("cam0")):
            result = run(
                "track", "--left", LEFT, "--right", "aravis:NoSuchCamera", "--rig",
                self.base / "rig.yaml", "--body", self.base / "body.yaml", cwd=self.dir)
        self.assertEqual(result.returncode, 3, result.stderr)
        self.assertIn("NoSuchCamera", result.stderr)
        self.assertIn("Aravis-Fake-L", result.stderr, "the message must say what is there")


if __name__ == "__main__":
    main()
