#!/usr/bin/env python3
"""Runs `record` over real GigE Vision on loopback: takes, kills, repairs, exports.

The fake cameras write the true time into the first 8 bytes of each image (--stamp): the two images
of a pair must show the same.

Usage: record_test.py PATH/TO/stereomotion PATH/TO/stereomotion_gv_server [unittest options]
"""

import json
import signal
import subprocess
import time

from live_case import LEFT, RIGHT, LiveCase, main, rows, run, small_recording

STAMP_BYTES = 8


def stamp(image):
    """Reads the true time [us] out of a PGM file."""
    data = image.read_bytes()
    header = data.index(b"\n255\n") + len(b"\n255\n")
    return int.from_bytes(data[header:header + STAMP_BYTES], "little")


class Record(LiveCase):
    rate_hz = 25

    def record(self, *more, output="rec.h5"):
        return run("record", "--left", LEFT, "--right", RIGHT, "--output", output, *more,
                   cwd=self.dir)

    def start_record(self, output="rec.h5"):
        with open(self.dir / "record.log", "wb") as log:
            return subprocess.Popen(
                [small_recording.program, "record", "--left", LEFT, "--right", RIGHT, "--output",
                 output], cwd=self.dir, stdout=subprocess.DEVNULL, stderr=log)

    def stamps(self, folder):
        """Gives the pairs of a recorded folder: number -> [true time left, right]."""
        pairs = {}
        for camera in ("cam0", "cam1"):
            for row in rows(self.dir / folder / camera / "timestamps.csv"):
                image = self.dir / folder / camera / f"{int(row['frame']):06d}.pgm"
                if int(row["pair"]) >= 0:
                    pairs.setdefault(int(row["pair"]), []).append(stamp(image))
        return pairs

    def assert_right_pairs(self, folder, least):
        """All pairs are of one moment; nothing is torn or lost within."""
        pairs = self.stamps(folder)
        wrong = [number for number, times in pairs.items()
                 if len(times) != 2 or times[0] != times[1]]
        self.assertEqual(wrong, [])
        self.assertGreaterEqual(len(pairs), least)

    def export(self, recording="rec.h5", output="exported"):
        result = run("record", "--export", recording, "--output", output, "--image-format", "pgm",
                     cwd=self.dir)
        self.assertEqual(result.returncode, 0, result.stderr)

    def test_file_and_its_export(self):
        with self.server():
            result = self.record("--count", 40)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertTrue(result.stdout.endswith("rec.h5\n"), result.stdout)
        live = json.loads((self.dir / "rec.h5.json").read_text())["live"]
        self.assertEqual(live["recorded"]["pairs"], 40)
        self.assertEqual(live["recorded"]["dropped"], 0)
        self.assertEqual(live["end"], "count")
        self.export()
        self.assert_right_pairs("exported", least=40)

    def test_folder(self):
        with self.server():
            result = self.record("--duration", 2, output="rec")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assert_right_pairs("rec", least=10)
        self.assertTrue((self.dir / "rec" / "record.json").exists())

    def test_interrupt_ends_it_cleanly(self):
        with self.server():
            process = self.start_record()
            time.sleep(3)
            process.send_signal(signal.SIGINT)
            self.assertEqual(process.wait(20), 0, (self.dir / "record.log").read_text())
        self.assertFalse((self.dir / "rec.h5.segments" / "unfinished").exists())
        self.export()
        self.assert_right_pairs("exported", least=10)

    def test_killed_one_is_repaired(self):
        with self.server():
            process = self.start_record()
            time.sleep(4)
            process.send_signal(signal.SIGKILL)
            process.wait()
        self.assertFalse((self.dir / "rec.h5").exists())
        result = run("record", "--repair", "rec.h5", cwd=self.dir)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("frames of cam0 are readable", result.stderr)
        self.export()
        self.assert_right_pairs("exported", least=10)

    def test_existing_one_is_kept(self):
        (self.dir / "rec.h5").write_text("dear to me")
        with self.server():
            result = self.record("--count", 5)
            self.assertEqual(result.returncode, 2)
            self.assertIn("rec.h5: exists; give another --output, or --force", result.stderr)
            self.assertEqual((self.dir / "rec.h5").read_text(), "dear to me")
            result = self.record("--count", 5, "--force")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.export()

    def test_no_camera_is_told(self):
        result = self.record("--count", 5)
        self.assertEqual(result.returncode, 3, result.stderr)
        self.assertIn("aravis:127.0.0.1", result.stderr)
        self.assertFalse((self.dir / "rec.h5.segments").exists())
        self.record("--count", 5, output="new/folder/rec.h5")
        self.assertFalse((self.dir / "new").exists(), "nothing was recorded")

    def test_full_disk_is_told(self):
        """The cause, and how far it came; the record of it finds no room, either."""
        (self.dir / "disk").mkdir()
        script = 'mount -t tmpfs -o size=12m tmpfs disk || exit 99; mkdir -p disk/rec.h5.json/x; exec "$@"'
        command = ["unshare", "-rm", "sh", "-c", script, "sh", small_recording.program, "record",
                   "--left", LEFT, "--right", RIGHT, "--output", "disk/rec.h5"]
        with self.server():
            result = subprocess.run(command, cwd=self.dir, text=True, capture_output=True,
                                    timeout=120, check=False)
        if result.returncode == 99 or "unshare" in result.stderr:
            self.skipTest("no small disk: unshare -rm and mount do not work here")
        self.assertEqual(result.returncode, 3, result.stderr)
        self.assertIn("No space left", result.stderr)
        self.assertIn("the recording ended early", result.stderr)
        self.assertNotIn("rec.h5.json", result.stderr)
        self.assertNotIn("too slow", result.stderr)
        self.assertIn("pairs recorded", result.stdout)

    def test_server_that_stops_leaves_what_was_before(self):
        with self.server("--frames", 60):
            result = self.record("--reconnect-s", 0)
        self.assertEqual(result.returncode, 3, result.stderr)
        self.export()
        self.assert_right_pairs("exported", least=10)


if __name__ == "__main__":
    main()
