#!/usr/bin/env python3
"""Runs `check` over real GigE Vision on loopback: a camera that dies, an interruption, a short look.

Usage: check_live_test.py PATH/TO/stereomotion PATH/TO/stereomotion_gv_server [unittest options]
"""

import json
import signal
import subprocess
import time

from live_case import LEFT, RIGHT, LiveCase, Server, main, run, small_recording


class Check(LiveCase):
    rate_hz = 25

    def arguments_of(self, *more):
        return ["check", "--left", LEFT, "--right", RIGHT, "--json", *map(str, more)]

    def start(self, *more):
        return subprocess.Popen([small_recording.program, *self.arguments_of(*more)], cwd=self.dir,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def findings(self, output):
        return json.loads(output)["findings"]

    def test_camera_that_dies_while_it_is_looked_at(self):
        """It is named, and nobody is sent to look after the trigger."""
        with Server(self.dir, *self.common(), *self.camera("cam0")), \
                Server(self.dir, *self.common(), *self.camera("cam1")) as right:
            process = self.start("--seconds", 5)
            time.sleep(3)
            right.kill()
            output, errors = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 1, errors)
        silent = [one for one in self.findings(output)
                  if one["topic"] == "rate" and one["camera"] == RIGHT]
        self.assertEqual([one["verdict"] for one in silent], ["mend"], output)
        self.assertIn("fell silent", silent[0]["advice"])
        for one in self.findings(output):
            self.assertNotIn("--trigger", one["advice"], one)

    def test_interrupted_look_says_so(self):
        with self.server():
            process = self.start("--seconds", 60)
            time.sleep(3)
            process.send_signal(signal.SIGINT)
            output, errors = process.communicate(timeout=60)
        self.assertIn("interrupted", output, errors)

    def test_short_look(self):
        """What one camera sent before the other one is not held against them."""
        with self.server():
            result = run(*self.arguments_of("--seconds", 0.5), cwd=self.dir)
        sync = [one for one in self.findings(result.stdout) if one["topic"] == "sync"]
        self.assertNotEqual(sync[0]["verdict"], "mend", result.stdout)


if __name__ == "__main__":
    main()
