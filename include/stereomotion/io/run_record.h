#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "stereomotion/core/run_summary.h"

namespace stereomotion {

/// Names one input of a run, with what identifies its content.
struct RunInput {
  std::string role;    ///< rig, body, left, right
  std::string path;    ///< as the user gave it
  std::string sha256;  ///< of the file, or of the images that were read (docs/formats.md)
};

/// Tells how much of a camera's images a mask covers.
struct MaskRecord {
  std::string camera;
  int regions = 0;
  std::int64_t pixels = 0;
};

/// Names a body of a run, and where its files are.
struct BodyRecord {
  std::string name;
  std::string folder;  ///< within RUN; ".": RUN itself
};

/// Holds what run.json tells: how a RUN came about.
struct RunRecord {
  std::string version;
  std::vector<std::string> command;
  std::string started;            ///< ISO 8601, UTC
  std::string state = "running";  ///< running, done, interrupted, output_failed
  std::vector<RunInput> inputs;
  std::string left_camera, right_camera;
  std::int64_t left_frames = 0, right_frames = 0;
  std::int64_t unpaired_left = 0, unpaired_right = 0;
  bool paired_by_time = false;
  int threads = 0;
  std::string detector;  ///< ml, wavelet, centroid
  int search_every = 1;
  double exposure_us = 0;  ///< given by the user for frames that do not tell theirs; 0: none
  std::vector<MaskRecord> masks;
  std::vector<BodyRecord> bodies;
  bool bodies_learned = false;  ///< from the recording; else from body files
  RunSummary summary;
  std::string live_json;              ///< run.json's object `live` as JSON; empty: recorded images
  std::vector<std::string> warnings;  ///< besides those of `summary`
};

/// Spells a record as run.json (format stereomotion-run/1).
std::string RunJson(const RunRecord& record);

}  // namespace stereomotion
