"""`track --stream` and its client, on a recording, without network but for the loopback."""

import json
import pathlib
import socket
import subprocess
import sys
import time

import small_recording
from small_recording import BODY, NOISE, RIG, FolderCase, rows, run

SCENARIO = """format: stereomotion-scenario/1
name: stream
rig: rig.yaml
body: body.yaml
motion:
  law: fixed
  center_in_world_mm: [0, 0, 0]
  axis: [0, 0.3, 1]
  rate_rad_s: 0.4
frames: 24
fps: 30
"""
CLIENT = pathlib.Path(__file__).resolve().parents[2] / "examples" / "stream_client.py"
FRAMES = 24


def free_port(kind=socket.SOCK_STREAM):
    with socket.socket(socket.AF_INET, kind) as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


class StreamCase(FolderCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.write(rig=RIG + NOISE, body=BODY)
        cls.simulate(SCENARIO)

    def arguments(self, *more):
        return ["track", "--left", "rec/cam0", "--right", "rec/cam1", "--rig", "rig.yaml", "--body",
                "body.yaml", "--no-motion", "--force", *map(str, more)]

    def track(self, *more):
        return run(*self.arguments(*more), cwd=self.base)

    def start_client(self, *arguments):
        return subprocess.Popen([sys.executable, CLIENT, *map(str, arguments)], text=True,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE)

    def check_messages(self, messages, run_folder):
        """The stream says what poses.csv says."""
        self.assertEqual(messages[0]["format"], "stereomotion-stream/1")
        self.assertEqual(messages[0]["bodies"], ["body"])
        self.assertEqual(messages[0]["cameras"], ["cam0", "cam1"])
        self.assertFalse(messages[0]["live"])
        self.assertEqual(messages[-1]["end"], "done")
        self.assertEqual(messages[-1]["pairs"], FRAMES)
        poses = [message for message in messages if "frame" in message]
        file = rows(self.base / run_folder / "poses.csv")
        self.assertEqual(len(poses), FRAMES)
        self.assertEqual(len(file), FRAMES)
        for pose, row in zip(poses, file):
            self.check_pose(pose, row)

    def check_pose(self, pose, row):
        self.assertEqual(pose["frame"], int(row["frame"]))
        self.assertEqual(pose["timestamp_ns"], int(row["timestamp_ns"]))
        self.assertEqual(pose["status"], row["status"])
        self.assertEqual(pose["balls"], [int(row["balls_left"]), int(row["balls_right"])])
        self.assertEqual(len(pose["cov"]), 21)
        names = ["qw", "qx", "qy", "qz", "tx_mm", "ty_mm", "tz_mm", "rms_px", "cov_00", "cov_55"]
        values = [*pose["q"], *pose["t_mm"], pose["rms_px"], pose["cov"][0], pose["cov"][20]]
        for name, value in zip(names, values):
            self.assertAlmostEqual(value, float(row[name]), delta=1e-9 * (1 + abs(value)))


class Stream(StreamCase):
    def test_standard_output_holds_the_stream_and_nothing_else(self):
        made = self.track("--output", "out", "--stream", "-")
        self.assertEqual(made.returncode, 0, made.stderr)
        self.check_messages([json.loads(line) for line in made.stdout.splitlines()], "out")
        self.assertIn("out", made.stderr)  # the table and the folder's name

    def test_streaming_changes_no_result(self):
        self.assertEqual(self.track("--output", "with", "--stream", "-").returncode, 0)
        self.assertEqual(self.track("--output", "without").returncode, 0)
        for name in ("poses.csv", "balls.csv", "detections.csv"):
            self.assertEqual((self.base / "with" / name).read_bytes(),
                             (self.base / "without" / name).read_bytes())

    def test_client_on_tcp(self):
        port = free_port()
        clients = [self.start_client(f"tcp://127.0.0.1:{port}", "--json") for _ in range(2)]
        made = self.track("--output", "tcp", "--stream", f"tcp://127.0.0.1:{port}")
        self.assertEqual(made.returncode, 0, made.stderr)
        outputs = [client.communicate(timeout=30) for client in clients]
        complete = [[json.loads(line) for line in out.splitlines()] for out, _ in outputs]
        # The run waits for a first client; the second may come later, but hears hello and end.
        self.check_messages(max(complete, key=len), "tcp")
        for client, messages in zip(clients, complete):
            self.assertEqual(client.returncode, 0)
            self.assertIn("format", messages[0])
            self.assertIn("end", messages[-1])

    def test_client_prints_poses_in_words(self):
        port = free_port()
        client = self.start_client(f"tcp://127.0.0.1:{port}", "--every", 5)
        self.track("--output", "words", "--stream", f"tcp://127.0.0.1:{port}")
        out, _ = client.communicate(timeout=30)
        lines = out.splitlines()
        self.assertEqual(lines[0], "# bodies: body")
        self.assertEqual(lines[-1], f"# end: done, {FRAMES} pairs")
        self.assertEqual(len(lines), 2 + 5)
        self.assertIn("mm", lines[1])

    def test_datagrams(self):
        port = free_port(socket.SOCK_DGRAM)
        client = self.start_client(f"udp://127.0.0.1:{port}", "--json", "--wait-s", 30)
        time.sleep(0.5)  # a datagram that nobody listens to is gone
        made = self.track("--output", "udp", "--stream", f"udp://127.0.0.1:{port}")
        self.assertEqual(made.returncode, 0, made.stderr)
        out, error = client.communicate(timeout=40)
        self.assertEqual(client.returncode, 0, error)
        self.check_messages([json.loads(line) for line in out.splitlines()], "udp")

    def test_client_that_never_reads_loses_whole_lines_and_holds_nothing_up(self):
        port = free_port()
        process = subprocess.Popen(
            [small_recording.program,
             *self.arguments("--output", "slow", "--stream", f"tcp://127.0.0.1:{port}")],
            cwd=self.base, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        with self.connected(port):
            _, error = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 0, error)

    def connected(self, port):
        until = time.monotonic() + 10
        while True:
            try:
                return socket.create_connection(("127.0.0.1", port))
            except OSError:
                if time.monotonic() > until:
                    raise
                time.sleep(0.05)

    def test_client_that_goes_away(self):
        port = free_port()
        process = subprocess.Popen(
            [small_recording.program,
             *self.arguments("--output", "away", "--stream", f"tcp://127.0.0.1:{port}")],
            cwd=self.base, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        self.connected(port).close()
        _, error = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 0, error)
        self.assertEqual(len(rows(self.base / "away" / "poses.csv")), FRAMES)

    def test_port_in_use_leaves_the_run_before(self):
        self.assertEqual(self.track("--output", "kept").returncode, 0)
        before = {file: file.read_bytes() for file in (self.base / "kept").iterdir()}
        with socket.socket() as taken:
            taken.bind(("127.0.0.1", 0))
            taken.listen()
            address = f"tcp://127.0.0.1:{taken.getsockname()[1]}"
            refused = self.track("--output", "kept", "--stream", address)
        self.assertEqual(refused.returncode, 3, refused.stderr)
        self.assertIn("cannot listen there", refused.stderr)
        self.assertEqual(before, {file: file.read_bytes()
                                  for file in (self.base / "kept").iterdir()})

    def test_reader_of_standard_output_that_goes_away(self):
        process = subprocess.Popen(
            [small_recording.program, *self.arguments("--output", "gone", "--stream", "-")],
            cwd=self.base, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        process.stdout.readline()
        process.stdout.close()
        error = process.stderr.read()
        process.stderr.close()
        self.assertEqual(process.wait(timeout=60), 0, error)
        self.assertIn("nobody reads any more", error)
        self.assertEqual(len(rows(self.base / "gone" / "poses.csv")), FRAMES)


class StreamErrors(StreamCase):
    def refused(self, address, code, *words):
        made = self.track("--output", "refused", "--stream", address)
        self.assertEqual(made.returncode, code, made.stderr)
        for word in (address, *words):
            self.assertIn(word, made.stderr)
        self.assertFalse((self.base / "refused" / "poses.csv").exists())

    def test_client_says_what_it_cannot_read(self):
        for text, words, more in (("hello", "expected lines of JSON", ()),
                                  ("[1]", "expected lines of JSON", ()),
                                  ("", "--every: found 0", ("--every", 0))):
            client = subprocess.run([sys.executable, CLIENT, "-", *map(str, more)], text=True,
                                    input=text + "\n", capture_output=True, check=False)
            self.assertIn(words, client.stderr)
            self.assertNotIn("Traceback", client.stderr)

    def test_addresses_that_are_none(self):
        for address in ("stdout", "tcp://127.0.0.1", "tcp://:5555", "tcp://127.0.0.1:port",
                        "tcp://127.0.0.1:0", "tcp://127.0.0.1:65536", "tcp://::1:5555",
                        "http://127.0.0.1:80", "zmq:nothing"):
            self.refused(address, 2, "expected", "tcp://HOST:PORT")

    def test_port_in_use(self):
        with socket.socket() as busy:
            busy.bind(("127.0.0.1", 0))
            busy.listen()
            address = f"tcp://127.0.0.1:{busy.getsockname()[1]}"
            self.refused(address, 3, "cannot listen there", "in use")
            self.refused("zmq+" + address, 3, "in use")

    def test_address_of_another_machine(self):
        self.refused("tcp://192.0.2.1:5555", 3, "cannot listen there")


if __name__ == "__main__":
    small_recording.main()
