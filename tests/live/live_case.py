"""What the end-to-end tests over GigE Vision share: a private network, fake cameras, the truth.

The fake cameras (stereomotion_gv_server) serve a rendered recording to and fro, in step with the
host's clock, so that the device time of a frame tells which image it is: poses.csv can be compared
with the truth at each timestamp, and a wrong pair shows. Python's standard library is all it takes,
and `unshare` and `ip`.
"""

import json
import math
import os
import pathlib
import signal
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "apps"))

import small_recording  # noqa: E402  (tests/apps)
from small_recording import BODY, NOISE, RIG, FolderCase, rows, run  # noqa: E402

SKIPPED = 77  # SKIP_RETURN_CODE
NETWORK = "STEREOMOTION_TEST_NETWORK"
LEFT, RIGHT = "aravis:127.0.0.1", "aravis:127.0.0.2"
EPOCH_NS = 1_700_000_000_000_000_000  # gv_server: device time 0
# Neighbouring images show the body turned by 5 degrees or more; the noise is a hundredth of that.
POSITION_MM, ANGLE_DEG = 0.5, 0.5

SCENARIO = """format: stereomotion-scenario/1
name: live
rig: rig.yaml
body: body.yaml
motion:
  law: uniform
  center_in_world_mm: [0, 0, 0]
  axis: [0.2, 0.3, 1]
  rate_rad_s: %g
  velocity_mm_s: [%g, 0, 0]
sensor: {exposure_s: 0.001}
frames: %d
fps: 25
"""

server_program = None  # `main` takes it from the command line


def private_network():
    """Returns the command that runs another one in a network of its own; None where it may not."""
    for flags in (["-n"], ["-rn"]):
        probe = subprocess.run(["unshare", *flags, "ip", "link", "set", "lo", "up"],
                               capture_output=True, check=False)
        if probe.returncode == 0:
            return ["unshare", *flags]
    return None


def enter_network():
    """Starts the script anew in a network where nobody else is, with two addresses."""
    if os.environ.get(NETWORK) != "1":
        command = private_network()
        if command is None:
            print("skipped: no private network (unshare -n, unshare -rn; ip of iproute2)")
            sys.exit(SKIPPED)
        os.environ[NETWORK] = "1"
        os.execvp(command[0], [*command, sys.executable, *sys.argv])
    for line in ("link set lo up", "addr add 127.0.0.2/8 dev lo"):
        subprocess.run(["ip", *line.split()], check=True)


class Server:
    """Fake cameras that answer. `arguments` as stereomotion_gv_server takes them."""

    def __init__(self, folder, *arguments):
        self.log = folder / f"server-{time.monotonic_ns()}.log"
        with open(self.log, "wb") as stream:
            self.process = subprocess.Popen([server_program, *map(str, arguments)], stdout=stream,
                                            stderr=subprocess.STDOUT)
        end = time.monotonic() + 30
        while "READY" not in self.log.read_text():
            if self.process.poll() is not None or time.monotonic() > end:
                self.stop()
                raise RuntimeError("the fake cameras do not start: " + self.log.read_text())
            time.sleep(0.02)

    def kill(self):
        """As if the plug were pulled."""
        self.process.send_signal(signal.SIGKILL)
        self.process.wait()

    def stop(self):
        if self.process.poll() is None:
            self.process.terminate()
            try:
                self.process.wait(10)
            except subprocess.TimeoutExpired:
                self.kill()

    def __enter__(self):
        return self

    def __exit__(self, *unused):
        self.stop()


class Truth:
    """Tells which pose belongs to a timestamp of the left camera."""

    def __init__(self, recording, rate_hz, clock_offset_s=0):
        self.poses = [[float(row[name]) for name in ("qw", "qx", "qy", "qz")] +
                      [float(row[f"t{axis}_mm"]) for axis in "xyz"]
                      for row in rows(recording / "truth" / "poses.csv")]
        self.period_ns = round(1e6 / rate_hz) * 1000
        self.shift_ns = EPOCH_NS - round(clock_offset_s * 1e9)

    def tick(self, timestamp_ns):
        """Counts the periods since 1970: the same for two images that belong together."""
        return (timestamp_ns + self.shift_ns + self.period_ns // 2) // self.period_ns

    def pose(self, timestamp_ns):
        count = len(self.poses)
        place = self.tick(timestamp_ns) % (2 * count - 2)
        return self.poses[place if place < count else 2 * count - 2 - place]

    def error(self, row):
        """Gives the distance [mm] and the angle [deg] of a row of poses.csv from the truth."""
        true = self.pose(int(row["timestamp_ns"]))
        turn = abs(sum(float(row[name]) * value
                       for name, value in zip(("qw", "qx", "qy", "qz"), true)))
        distance = math.dist([float(row[f"t{axis}_mm"]) for axis in "xyz"], true[4:])
        return distance, math.degrees(2 * math.acos(min(1.0, turn)))


class LiveCase(FolderCase):
    """Renders a recording once; runs the program against fake cameras that serve it."""

    rate_hz = 25
    images = 24
    rig = RIG
    size = (640, 512)

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        # The angle between neighbouring images is the same at any rate.
        cls.write(rig=cls.rig + NOISE, body=BODY)
        cls.simulate(SCENARIO % (0.09 * 25, 2.0 * 25, cls.images), "served")

    def setUp(self):
        self.dir = self.base / self.id().rsplit(".", 1)[-1]
        self.dir.mkdir()

        began = time.monotonic()
        self.addCleanup(lambda: print(f"{self.id()}: {time.monotonic() - began:.1f} s"))

    def camera(self, name, *more):
        address, serial = ("127.0.0.1", "L") if name == "cam0" else ("127.0.0.2", "R")
        return ["--camera", name, "--address", address, "--serial", serial, *more]

    def common(self, *more):
        return ["--recording", self.base / "served", "--rate", self.rate_hz, "--stamp", *more]

    def server(self, *common, left=(), right=()):
        """Both cameras in one process."""
        return Server(self.dir, *self.common(*common), *self.camera("cam0", *left),
                      *self.camera("cam1", *right))

    def arguments(self, *more, output="run"):
        return ["track", "--left", LEFT, "--right", RIGHT, "--rig", self.base / "rig.yaml",
                "--body", self.base / "body.yaml", "--output", self.dir / output, "--no-motion",
                *more]

    def track(self, *more, output="run", timeout=120):
        return run(*self.arguments(*more, output=output), cwd=self.dir,
                                   timeout=timeout)

    def start_track(self, *more, output="run"):
        """Starts it and does not wait; stderr goes to a file."""
        with open(self.dir / f"{output}.log", "wb") as log:
            return subprocess.Popen(
                [small_recording.program, *map(str, self.arguments(*more, output=output))],
                cwd=self.dir, stdout=subprocess.DEVNULL, stderr=log)

    def wait_for_rows(self, count, output="run", timeout_s=30):
        """Waits until so many pairs are in poses.csv (it is written in blocks)."""
        file = self.dir / output / "poses.csv"
        end = time.monotonic() + timeout_s
        while time.monotonic() < end:
            if file.exists() and file.read_bytes().count(b"\n") > count:
                return
            time.sleep(0.05)
        self.fail(f"{file}: no {count} rows in {timeout_s} s: " +
                  (self.dir / f"{output}.log").read_text())

    def result(self, output="run"):
        return json.loads((self.dir / output / "run.json").read_text())

    def check_poses(self, truth=None, least=1, output="run"):
        """No pose may be wrong; at least so many there must be. Returns all rows."""
        truth = truth or Truth(self.base / "served", self.rate_hz)
        table = rows(self.dir / output / "poses.csv")
        poses = [row for row in table if row["status"] == "ok"]
        wrong = []
        for row in poses:
            distance, angle = truth.error(row)
            if distance > POSITION_MM or angle > ANGLE_DEG:
                wrong.append((row["frame"], row["timestamp_ns"], distance, angle))
        self.assertEqual(wrong[:5], [], f"{len(wrong)} of {len(poses)} poses are wrong")
        self.assertGreaterEqual(len(poses), least, self.statuses(table))
        times = [int(row["timestamp_ns"]) for row in table]
        self.assertEqual(times, sorted(times), "times must not go back")
        self.assertEqual(len(set(times)), len(times), "a time comes twice")
        return table

    def stamps(self, camera, recording="rec"):
        """Reads the pair's number and the true time [us] of every recorded image."""
        found = {}
        folder = self.dir / recording / camera
        for row in rows(folder / "timestamps.csv"):
            if int(row["pair"]) < 0:
                continue
            with open(folder / f"{int(row['frame']):06d}.pgm", "rb") as image:
                for _ in range(3):  # P5, size, largest value
                    image.readline()
                found[int(row["pair"])] = int.from_bytes(image.read(8), "little", signed=True)
        return found

    def check_stamps(self, most_us=0, least=1, recording="rec"):
        """The server wrote into each image when it was taken: both of a pair at one time."""
        left, right = self.stamps("cam0", recording), self.stamps("cam1", recording)
        self.assertEqual(left.keys(), right.keys())
        wrong = [(pair, time_us, right[pair]) for pair, time_us in left.items()
                 if abs(right[pair] - time_us) > most_us]
        self.assertEqual(wrong[:5], [], f"{len(wrong)} of {len(left)} pairs are wrong")
        self.assertGreaterEqual(len(left), least)

    @staticmethod
    def statuses(table):
        counts = {}
        for row in table:
            counts[row["status"]] = counts.get(row["status"], 0) + 1
        return counts

    def assert_counts_add_up(self, output="run"):
        """Every image that came is in a pair, or counted as one that is not.

        Those that arrive while the run ends belong to nothing any more.
        """
        live = self.result(output)["live"]
        for camera in live["cameras"]:
            came = camera["counts"]["frames"]
            told = live["pairs"] + camera["unpaired"]
            self.assertGreaterEqual(came, told, live)
            self.assertLessEqual(came, told + 3, live)


def main():
    global server_program
    enter_network()
    server_program = os.path.abspath(sys.argv.pop(2))
    small_recording.main()
