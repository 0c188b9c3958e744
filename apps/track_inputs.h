#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "camera_argument.h"
#include "live_options.h"
#include "stereomotion/capture/recording.h"
#include "stereomotion/io/mask_file.h"
#include "stereomotion/pipeline/measure.h"

namespace stereomotion::app {

/// What the user asked of `track`.
struct TrackOptions {
  std::string left, right;
  std::string recording;  ///< a recording file instead of left and right
  std::string rig = "rig.yaml";
  std::vector<std::string> bodies;  ///< files; none: learned from the recording
  std::string output;
  double fps = 0;
  std::int64_t start = 0;
  std::int64_t count = -1;
  int threads = 0;
  std::string detector = "ml";
  std::int64_t search_every = 1;
  double exposure_ms = 0;       ///< 0: as the recording tells
  std::string mask;             ///< file; empty: none
  std::string learn_mask;       ///< file to write instead of a RUN; empty: measure
  double ball_diameter_mm = 0;  ///< of bodies to be learned; 0: from the images
  bool motion = true;           ///< analyse it at the end
  bool force = false;
  std::string stream;  ///< where poses are sent to; empty: nowhere
  LiveArguments live;
  std::string record;   ///< live: where the images are recorded; empty: nowhere
  double learn_s = 10;  ///< live: so long is recorded to learn the bodies
  std::vector<const CLI::Option*> recorded_only;  ///< options that live cameras have no use for
};

/// All that is known before the measuring starts.
struct TrackInputs {
  MeasureSetup setup;
  std::vector<CameraMask> masks;
  MeasureOptions options;
  bool is_live = false;
  ResolvedCameras cameras;
  std::unique_ptr<Recording> recording;               ///< null: live
  std::array<std::filesystem::path, 2> camera_paths;  ///< folder or video: left, right
  std::vector<std::string> warnings;                  ///< for a person, besides the recording's
};

/// Lists the values of --detector, in the order of `DetectorMethod`.
const std::vector<std::string>& DetectorNames();

/// Reads rig, body, masks and the recording's names and times, and looks at the first images.
/// Throws `UserError` for whatever would make every frame fail. Live cameras are not opened yet.
/// Where `recording` is given, fills `left` and `right` in.
TrackInputs LoadTrackInputs(TrackOptions& options);

/// Opens what is recorded of two cameras into `inputs`.
void OpenRecorded(const TrackOptions& options, const ResolvedCameras& cameras, TrackInputs& inputs);

}  // namespace stereomotion::app
