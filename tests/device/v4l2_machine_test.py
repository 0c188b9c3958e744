#!/usr/bin/env python3
"""V4L2 on a real kernel, in an emulated machine with four virtual cameras.

Usage: v4l2_machine_test.py PROGRAM FOLDER_OF_TEST_PROGRAMS SOURCES KEPT_FOLDER [unittest options]

vivid makes dropped buffers, error flags, a disconnected camera (v4l2_vivid_test); two v4l2loopback
devices are fed the images of data/demo, which `track` measures and records live in the machine.
Debian's kernel is downloaded into KEPT_FOLDER once. Where that or qemu is missing, the test is
skipped (exit code 77).
"""

import csv
import json
import math
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

from debian_kernel import DebianKernel, Unavailable
from virtual_machine import run_in_machine

SKIPPED = 77  # ctest: SKIP_RETURN_CODE
MODULES = {
    # One camera with the single-planar interface, one with the multi-planar.
    "vivid": "n_devs=2 node_types=0x1,0x1 num_inputs=1,1 input_types=0x0,0x0 multiplanar=1,2",
    "v4l2loopback": "video_nr=10,11 card_label=left,right exclusive_caps=0,0 max_buffers=16",
}
PAIRS = 20  # of data/demo
# The emulated machine has hiccups, and v4l2loopback stamps no times: slowly, and within less than
# half a period (500 ms), so that no wrong pair can form.
RATE_HZ, TOLERANCE_MS = 2, 200
# Without hurry: the whole takes about 75 s on two cores, 150 s where others load them, too.
MACHINE_S, FEED_READY_S, TRACK_S = 240, 60, 150

SCRIPT = """
cd '{sources}'
'{tools}/v4l2_vivid_test' --gtest_color=no --gtest_output=json:/mnt/vivid.json > /mnt/vivid.txt 2>&1
'{tools}/v4l2_feed' data/demo/cam0 /dev/video10 data/demo/cam1 /dev/video11 {rate} \\
  > /mnt/feed.txt 2>&1 & feed=$!
for ((i = 0; i < {ready} * 5; ++i)); do
  if grep -q ready /mnt/feed.txt; then break; fi
  sleep 0.2
done
timeout {track_s} '{program}' track --left v4l2:/dev/video10 --right v4l2:/dev/video11 \\
  --rig data/demo/rig.yaml --body data/demo/body.yaml --no-motion --count {pairs} \\
  --pair-tolerance-ms {tolerance} --output /mnt/live --record /dev/shm/rec.h5 > /mnt/track.txt 2>&1
echo $? > /mnt/track.code
kill $feed
cp -r /dev/shm/rec.h5* /mnt/
"""

program = tools = sources = kept = None


def rows(file):
    with open(file, newline="", encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


def without_time(row):
    return {name: text for name, text in row.items() if name != "timestamp_ns"}


class Machine(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.base = pathlib.Path(tempfile.mkdtemp(prefix="stereomotion-v4l2-"))
        script = SCRIPT.format(sources=sources, tools=tools, program=program, rate=RATE_HZ,
                               ready=FEED_READY_S, pairs=PAIRS, tolerance=TOLERANCE_MS,
                               track_s=TRACK_S)
        cls.code, cls.console = run_in_machine(KERNEL, MODULES, script, cls.base, MACHINE_S)

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.base)

    def text(self, name):
        file = self.base / name
        return file.read_text(errors="replace") if file.exists() else self.console

    def track(self, output, *cameras):
        """Measures a recording on this machine; returns the rows of poses.csv."""
        folder = self.base / output
        subprocess.run([program, "track", *cameras, "--rig", sources / "data/demo/rig.yaml",
                        "--body", sources / "data/demo/body.yaml", "--no-motion", "--quiet",
                        "--output", folder], check=True, timeout=60)
        return rows(folder / "poses.csv")

    def test_the_machine_ran(self):
        self.assertEqual(self.code, 0, self.console)

    def test_vivid_and_its_faults(self):
        text = self.text("vivid.txt")
        self.assertTrue((self.base / "vivid.json").exists(), text)
        result = json.loads((self.base / "vivid.json").read_text())
        self.assertGreater(result["tests"], 10)
        self.assertEqual(result["failures"] + result["errors"], 0, text)

    def test_images_and_poses_are_those_that_were_fed(self):
        self.assertEqual(self.text("track.code").strip(), "0", self.text("track.txt"))
        demo = [sources / "data/demo/cam0", sources / "data/demo/cam1"]
        recorded = [f"{self.base / 'rec.h5'}:{name}" for name in ("cam0", "cam1")]
        same = subprocess.run([tools / "same_images", *demo, *recorded], text=True,
                              capture_output=True, timeout=60, check=False)
        self.assertEqual(same.returncode, 0, same.stdout + same.stderr)

        fed = self.track("fed", "--left", demo[0], "--right", demo[1])
        replayed = self.track("replayed", "--recording", self.base / "rec.h5")
        live = rows(self.base / "live/poses.csv")
        self.assertEqual(len(fed), PAIRS)
        self.assertEqual([without_time(row) for row in replayed],
                         [without_time(row) for row in fed])
        self.check_live(live, replayed)

    def check_live(self, live, replayed):
        """Measured by the emulated processor: the same but for roundings of another instruction set."""
        self.assertEqual(len(live), len(replayed))
        for row, expected in zip(live, replayed):
            for exact in ("frame", "timestamp_ns", "status", "balls_left", "balls_right"):
                self.assertEqual(row[exact], expected[exact])
            for name in ("qw", "qx", "qy", "qz", "tx_mm", "ty_mm", "tz_mm"):
                self.assertTrue(math.isclose(float(row[name]), float(expected[name]), abs_tol=1e-6),
                                f"{name}: {row[name]} and {expected[name]}")

    def test_the_report_counts_what_came(self):
        live = json.loads(self.text("live/run.json"))["live"]
        self.assertEqual(live["end"], "count")
        self.assertEqual(live["pairs"], PAIRS)
        for camera, name in zip(live["cameras"], ("left", "right")):
            self.assertEqual(camera["protocol"], "V4L2")
            self.assertEqual(camera["model"], name)
            self.assertEqual(camera["counts"]["lost"] + camera["counts"]["incomplete"], 0)


if __name__ == "__main__":
    program, tools, sources, kept = (pathlib.Path(path).resolve() for path in sys.argv[1:5])
    try:
        KERNEL = DebianKernel(kept)
    except Unavailable as reason:
        print(f"skipped: {reason}")
        sys.exit(SKIPPED)
    os.umask(0o022)
    unittest.main(argv=[sys.argv[0], *sys.argv[5:]])
