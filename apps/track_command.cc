#include <memory>

#include "commands.h"
#include "live_options.h"
#include "number_within.h"
#include "stereomotion/core/user_error.h"
#include "track_inputs.h"
#include "track_run.h"

namespace stereomotion::app {
namespace {

void AddCameraOptions(CLI::App& track, TrackOptions& options) {
  auto* left = track.add_option("--left", options.left,
                                "The left camera: folder of images, video, REC.h5:NAME, aravis:ID, "
                                "v4l2:DEVICE or a name of the rig");
  auto* right = track.add_option("--right", options.right, "The right camera");
  track
      .add_option("--recording", options.recording,
                  "A recording file (….h5) instead of --left and --right")
      ->check(NotEmpty())
      ->excludes(left)
      ->excludes(right);
}

void RequireCameras(const TrackOptions& options) {
  if (!options.recording.empty()) return;
  const char* missing = options.left.empty() ? "--left" : options.right.empty() ? "--right" : "";
  if (*missing == '\0') return;
  throw UserError(std::string(missing) +
                  " is required: expected --left CAM and --right CAM, or --recording REC.h5");
}

void AddRecordedOptions(CLI::App& track, TrackOptions& options) {
  auto* fps =
      track.add_option("--fps", options.fps, "Frames a second, where the recording has no times");
  fps->check(NumberWithin(kLowestFps, kHighestFps));
  auto* start = track.add_option("--start", options.start, "First pair, from 0");
  start->check(WholeNumberWithin(0, kMostFrames));
  options.recorded_only = {fps, start};
}

// What is asked of live cameras, and where poses go.
void AddLiveRunOptions(CLI::App& track, TrackOptions& options) {
  constexpr double kShortest_s = 1, kLongest_s = 600;
  track
      .add_option("--stream", options.stream,
                  "Sends poses as JSON lines at once: - (standard output), tcp://HOST:PORT "
                  "(listens), udp://HOST:PORT, zmq+tcp://HOST:PORT")
      ->check(NotEmpty("an address"));
  AddLiveOptions(track, options.live);
  auto* record = track.add_option("--record", options.record,
                                  "Records the images at the same time: REC.h5, or a folder");
  auto* learn = track.add_option("--learn-s", options.learn_s,
                                 "Without --body: so long is recorded first to learn the bodies");
  record->check(NotEmpty())->group("Live cameras");
  learn->check(NumberWithin(kShortest_s, kLongest_s))
      ->capture_default_str()
      ->excludes(track.get_option("--body"))
      ->group("Live cameras");
  options.live.options.insert(options.live.options.end(), {record, learn});
  options.recorded_only.push_back(track.get_option("--learn-mask"));
}

// What changes how the images are measured.
void AddMeasuringOptions(CLI::App& track, TrackOptions& options) {
  constexpr std::int64_t kMostBetween = 10000;  // nobody waits longer for a ball to be seen
  constexpr double kShortest_ms = 1e-4, kLongest_ms = 1e5;
  track
      .add_option("--detector", options.detector,
                  "How a ball's centre is measured. ml: fit under the sensor's noise, the most "
                  "accurate; wavelet: edge points and an ellipse, for whole balls (no poses where "
                  "rods cut them or they smear); centroid: the fastest, for whole balls")
      ->check(CLI::IsMember(DetectorNames()))
      ->capture_default_str();
  track
      .add_option("--search-every", options.search_every,
                  "Search every Nth pair whole, the others only where the balls seen before should "
                  "be. Faster; a ball that comes into sight may be found N - 1 pairs late")
      ->check(WholeNumberWithin(1, kMostBetween))
      ->capture_default_str();
  track
      .add_option("--exposure-ms", options.exposure_ms,
                  "How long a frame was exposed, where the recording does not tell: fast curved "
                  "motion is corrected for it")
      ->check(NumberWithin(kShortest_ms, kLongest_ms));
  auto* mask = track.add_option("--mask", options.mask,
                                "Places in the images where nothing is a ball (mask.yaml)");
  mask->check(NotEmpty());
  track
      .add_option("--learn-mask", options.learn_mask,
                  "Instead of measuring: write a mask of what stays bright in this recording, best "
                  "one without the body, else one in which it moves")
      ->check(NotEmpty())
      ->excludes(mask)
      ->excludes(track.get_option("--output"));
}

// What is done before the measuring and after it.
void AddBodyOptions(CLI::App& track, TrackOptions& options) {
  constexpr double kSmallest_mm = 0.5, kLargest_mm = 500;  // as in a body file
  track
      .add_option("--ball-diameter-mm", options.ball_diameter_mm,
                  "Without --body: diameter of the balls; by default as large as they look")
      ->check(NumberWithin(kSmallest_mm, kLargest_mm))
      ->excludes(track.get_option("--body"));
  track.add_flag("!--no-motion", options.motion,
                 "Do not work out the motion at the end (`analyse` does it later)");
}

}  // namespace

Run AddTrackCommand(CLI::App& app) {
  auto options = std::make_shared<TrackOptions>();
  CLI::App* track = app.add_subcommand("track", "Measures bodies in image pairs, recorded or live");
  AddCameraOptions(*track, *options);
  track->add_option("--rig", options->rig, "The calibrated cameras")->capture_default_str();
  track
      ->add_option("--body", options->bodies,
                   "A body and its rods (body.yaml); may be given several times. None: the bodies "
                   "are learned from the recording")
      ->allow_extra_args(false);
  track->add_option("--output", options->output,
                    "Folder for the results; run-DATE-TIME by default");
  AddRecordedOptions(*track, *options);
  track->add_option("--count", options->count, "How many pairs")
      ->check(WholeNumberWithin(1, kMostFrames));
  track->add_option("--threads", options->threads, "Threads; 0: one a core. Results do not change")
      ->check(WholeNumberWithin(0, kMostThreads))
      ->capture_default_str();
  AddMeasuringOptions(*track, *options);
  AddBodyOptions(*track, *options);
  AddLiveRunOptions(*track, *options);
  track->add_flag("--force", options->force, "Overwrite an existing output");
  track->footer(
      "Examples:\n"
      "  stereomotion track --left rec/cam0 --right rec/cam1 --rig rec/rig.yaml --body body.yaml\n"
      "  stereomotion track --left cam0 --right cam1 --body thigh.yaml --body shank.yaml\n"
      "  stereomotion track --left cam0 --right cam1 --ball-diameter-mm 16\n"
      "  stereomotion track --left cam0 --right cam1 --body body.yaml --detector centroid\n"
      "  stereomotion track --left cam0 --right cam1 --body body.yaml --search-every 10\n"
      "  stereomotion track --left empty/cam0 --right empty/cam1 --body body.yaml --learn-mask "
      "mask.yaml\n"
      "  stereomotion track --left aravis:CAM-1 --right aravis:CAM-2 --body body.yaml --record "
      "take1.h5\n"
      "  stereomotion track --recording take1.h5 --body body.yaml --stream tcp://127.0.0.1:5555\n"
      "  stereomotion track --left cam0 --right cam1 --body body.yaml --mask mask.yaml");
  return [options](const CommonOptions& common) {
    RequireCameras(*options);
    return RunTrack(*options, common);
  };
}

}  // namespace stereomotion::app
