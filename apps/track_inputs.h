#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "stereomotion/capture/recording.h"
#include "stereomotion/pipeline/measure.h"

namespace stereomotion::app {

/// What the user asked of `track`.
struct TrackOptions {
  std::string left, right;
  std::string rig = "rig.yaml";
  std::string body;
  std::string output;
  double fps = 0;
  std::int64_t start = 0;
  std::int64_t count = -1;
  int threads = 0;
  bool force = false;
};

/// All that is read before the measuring starts.
struct TrackInputs {
  MeasureSetup setup;
  MeasureOptions options;
  std::unique_ptr<Recording> recording;
};

/// Reads rig, body and the recording's names and times, and looks at the first images. Throws
/// `UserError` for whatever would make every frame fail.
TrackInputs LoadTrackInputs(const TrackOptions& options);

}  // namespace stereomotion::app
