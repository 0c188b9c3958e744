#!/usr/bin/env python3
"""Tracks 2 × 640×480 at 200 Hz for long, with a stream client: memory is flat, counts add up.

Usage: soak_test.py PATH/TO/stereomotion PATH/TO/stereomotion_gv_server [unittest options]
$STEREOMOTION_SOAK_S: how long [s]; 600 by default.
"""

import json
import os
import re
import socket
import threading
import time

from live_case import SCENARIO, LiveCase, main, rows

DURATION_S = float(os.environ.get("STEREOMOTION_SOAK_S", "600"))
STEP_MB = 0.2  # less than an image: 0.3 MB
QUEUE_MB = 2 * 200 * 0.31  # a second of pairs
PORT = 42311  # in a network of our own
RIG = """format: stereomotion-rig/1
cameras:
  - name: cam0
    image_size_px: [640, 480]
    intrinsics: {fx_px: 800, fy_px: 800, cx_px: 320, cy_px: 240}
    distortion: [0, 0, 0, 0, 0]
    cam_from_world: {qw: 1, qx: 0, qy: 0, qz: 0, tx_mm: 200, ty_mm: 0, tz_mm: 1500}
  - name: cam1
    image_size_px: [640, 480]
    intrinsics: {fx_px: 800, fy_px: 800, cx_px: 320, cy_px: 240}
    distortion: [0, 0, 0, 0, 0]
    cam_from_world: {qw: 1, qx: 0, qy: 0, qz: 0, tx_mm: -200, ty_mm: 0, tz_mm: 1500}
"""


def resident_mb(pid):
    with open(f"/proc/{pid}/status", encoding="ascii") as status:
        found = re.search(r"VmRSS:\s+(\d+) kB", status.read())
    return int(found.group(1)) / 1024 if found else None


class Client(threading.Thread):
    """Reads the stream to its end; keeps counts only."""

    def __init__(self, port):
        super().__init__(daemon=True)
        self.port, self.poses, self.hello, self.end, self.last_frame = port, 0, None, None, -1
        self.in_order = True

    def run(self):
        for _ in range(100):
            try:
                connection = socket.create_connection(("127.0.0.1", self.port), 1)
                break
            except OSError:
                time.sleep(0.1)
        else:
            return
        connection.settimeout(None)
        with connection, connection.makefile("rb") as lines:
            for line in lines:
                self.take(json.loads(line))

    def take(self, message):
        if self.hello is None:
            self.hello = message
        elif "frame" in message:
            self.poses += 1
            self.in_order = self.in_order and message["frame"] > self.last_frame
            self.last_frame = message["frame"]
        else:
            self.end = message


class Soak(LiveCase):
    rate_hz = 200
    images = 60
    rig = RIG
    size = (640, 480)

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        # Slow enough for its turning points to be motion that a body can make.
        cls.simulate(SCENARIO % (0.004 * 25, 0.1 * 25, cls.images), "slow")

    def common(self, *more):
        return ["--recording", self.base / "slow", "--rate", self.rate_hz, *more]

    def watch(self, process):
        """Samples its memory [MB] every second until it ends."""
        samples = []
        while process.poll() is None:
            memory = resident_mb(process.pid)
            if memory:
                samples.append(memory)
            time.sleep(1)
        return samples

    def test_memory_is_flat_and_counts_add_up(self):
        client = Client(PORT)
        with self.server("--images", self.images):
            process = self.start_track("--duration", DURATION_S, "--search-every", 10,
                                       "--stream", f"tcp://127.0.0.1:{PORT}")
            client.start()
            samples = self.watch(process)
            self.assertEqual(process.returncode, 0, (self.dir / "run.log").read_text())
        client.join(10)
        self.check_memory(samples)
        self.check_counts(client)

    def check_memory(self, samples):
        """What grows with every pair creeps; a pool of frames grows by a step when the machine was
        busy, up to what the queue may hold."""
        warm = samples[min(60, len(samples) // 3):]
        changes = [b - a for a, b in zip(warm, warm[1:])]
        creep = sum(change for change in changes if 0 < change < STEP_MB)
        print(f"memory: {warm[0]:.1f} MB after the first minute, {warm[-1]:.1f} MB at the end, of "
              f"that crept {creep:.2f} MB; {len(samples)} samples")
        # 16 bytes a pair would be 2 MB in ten minutes.
        self.assertLess(creep, 1, samples[::10])
        self.assertLess(warm[-1] - warm[0], QUEUE_MB, samples[::10])

    def check_counts(self, client):
        self.assert_counts_add_up()
        record = self.result()
        live = record["live"]
        statuses = self.statuses(rows(self.dir / "run" / "poses.csv"))
        total = sum(statuses.values())
        print(f"pairs: {live['pairs']}, rows: {statuses}, streamed: {client.poses}")
        self.assertEqual(statuses.get("dropped", 0), live["dropped_pairs"])
        self.assertEqual(statuses.get("no_pair", 0), live["cameras"][0]["unpaired"])
        self.assertEqual(total, live["pairs"] + live["cameras"][0]["unpaired"])
        # The server skips images where the machine has no time for it: those were never sent.
        self.assertGreater(live["pairs"], 0.5 * self.rate_hz * DURATION_S)
        self.assertEqual(client.hello["format"], "stereomotion-stream/1")
        self.assertTrue(client.in_order)
        self.assertIsNotNone(client.end, "the stream did not say that it ended")
        self.assertGreater(client.poses, 0.5 * total)


if __name__ == "__main__":
    main()
