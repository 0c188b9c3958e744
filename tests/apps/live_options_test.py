"""The options of live cameras, as far as they can be refused without cameras."""

import small_recording
from small_recording import BODY, NOISE, RIG, FolderCase, run

SCENARIO = """format: stereomotion-scenario/1
name: live
rig: rig.yaml
body: body.yaml
motion:
  law: fixed
  center_in_world_mm: [0, 0, 0]
  axis: [0, 0.3, 1]
  rate_rad_s: 0.4
frames: 3
fps: 30
"""


class LiveOptions(FolderCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.write(rig=RIG + NOISE, body=BODY)
        cls.simulate(SCENARIO)

    def refused(self, *arguments, words):
        made = run("track", "--rig", "rig.yaml", "--body", "body.yaml", "--output", "refused",
                   *arguments, cwd=self.base)
        self.assertEqual(made.returncode, 2, made.stderr)
        for word in words:
            self.assertIn(word, made.stderr)
        self.assertFalse((self.base / "refused").exists())

    def test_options_of_live_cameras_with_a_recording(self):
        for option in (("--exposure-us", 100), ("--gain-db", 1), ("--frame-rate", 10),
                       ("--region", "0,0,10,10"), ("--pixel-format", "Mono8"),
                       ("--packet-size", 1500), ("--trigger", "software"), ("--ptp",),
                       ("--set", "A=b"), ("--pair-tolerance-ms", 1), ("--reconnect-s", 1),
                       ("--queue-s", 1), ("--duration", 1), ("--record", "new.h5")):
            self.refused("--left", "rec/cam0", "--right", "rec/cam1", *option,
                         words=[option[0], "the images are recorded"])

    def test_options_of_recordings_with_live_cameras(self):
        for option in (("--fps", 10), ("--start", 1), ("--learn-mask", "mask.yaml")):
            self.refused_without_output("--left", "aravis:1", "--right", "aravis:2", *option,
                                        words=[option[0], "the cameras are live"])

    def refused_without_output(self, *arguments, words):
        made = run("track", "--rig", "rig.yaml", "--body", "body.yaml", *arguments, cwd=self.base)
        self.assertEqual(made.returncode, 2, made.stderr)
        for word in words:
            self.assertIn(word, made.stderr)

    def test_record_without_a_live_camera(self):
        for left, right, words in (
                ("cam9", "aravis:2", ("--left cam9", "neither a camera of", "nor a folder")),
                ("aravis:1", "127.0.0.1", ("--right 127.0.0.1", "neither a camera of")),
                ("rec/cam0", "aravis:2", ("--left rec/cam0", "recorded already"))):
            made = run("record", "--left", left, "--right", right, "--output", "no.h5",
                       cwd=self.base)
            self.assertEqual(made.returncode, 2, made.stderr)
            for word in words:
                self.assertIn(word, made.stderr)

    def test_record_with_options_of_another_task(self):
        for arguments in (("--repair", "rec.h5", "--output", "no.h5"),
                          ("--repair", "rec.h5", "--left", "aravis:1"),
                          ("--repair", "rec.h5", "--duration", 3),
                          ("--export", "rec.h5", "--output", "no", "--count", 3),
                          ("--left", "aravis:1", "--right", "aravis:2", "--output", "no",
                           "--image-format", "tif")):
            made = run("record", *arguments, cwd=self.base)
            self.assertEqual(made.returncode, 2, made.stderr)
            self.assertIn(arguments[-2], made.stderr)

    def test_one_live_one_recorded(self):
        self.refused("--left", "aravis:1", "--right", "rec/cam1",
                     words=["aravis:1", "rec/cam1", "one is a live camera"])

    def test_set_for_a_side_that_there_is_not(self):
        self.refused("--left", "aravis:127.0.0.1", "--right", "aravis:127.0.0.2", "--set",
                     "middle:x=3", words=["--set", "'middle'", "left:", "right:"])

    def test_recording_where_it_cannot_be_meant(self):
        live = ("--left", "aravis:1", "--right", "aravis:2")
        for place, words in (("h10.h5:cam0", ["both cameras go into it"]), (".h5", ["a name"]),
                             ("refused/", ["--record and --output", "two places"])):
            self.refused(*live, "--record", place, words=["--record", place, *words])
        (self.base / "old.H5").write_text("precious")
        self.refused(*live, "--record", "old.H5", words=["old.H5: exists", "--force"])

    def test_one_camera_twice(self):
        self.refused("--left", "aravis:1", "--right", "aravis:1", words=["aravis:1", "two cameras"])

    def test_values_that_cannot_be_meant(self):
        live = ("--left", "aravis:1", "--right", "aravis:2")
        for option, value in (("--region", "0,0,10"), ("--region", "0,0,0,5"),
                              ("--region", "a,b,c,d"), ("--exposure-us", -1), ("--queue-s", 0),
                              ("--frame-rate", 0), ("--trigger", "hand"), ("--packet-size", 5),
                              ("--timestamp-at", "noon"), ("--set", "gain"), ("--set", "=3"),
                              ("--set", "left:=3"), ("--duration", 0)):
            self.refused(*live, option, value, words=[option])

    def test_cameras_are_required(self):
        self.refused("--left", "rec/cam0", words=["--right is required", "--recording"])
        self.refused(words=["--left is required"])

    def test_recording_or_cameras(self):
        self.refused("--recording", "rec.h5", "--left", "rec/cam0", words=["--recording"])
        self.refused("--recording", "none.h5", words=["none.h5"])


if __name__ == "__main__":
    small_recording.main()
