#pragma once

#include <array>
#include <filesystem>
#include <string>

#include "stereomotion/detection/detect_balls.h"
#include "tests/support/statistics.h"

namespace stereomotion::testing {

/// Holds the outline centres that a detector gives on a recording, against the truth.
struct DetectionScore {
  int images = 0;
  int shown =
      0;  ///< balls that lie inside an image and are visible by at least the share asked for
  int found = 0;                        ///< of them: measured (`ok`) within one pixel of the truth
  int false_detections = 0;             ///< measured, but nowhere near a ball of the truth
  int wrong = 0;                        ///< measured, near a ball, but beyond 5 σ in a component
  ErrorStatistics centers;              ///< of the found ones, 2 components
  std::array<ErrorStatistics, 2> axes;  ///< u, v

  [[nodiscard]] double recall() const { return static_cast<double>(found) / shown; }
  [[nodiscard]] double false_per_image() const {
    return static_cast<double>(false_detections) / images;
  }
  [[nodiscard]] double axis_rmse_px() const;
};

/// Detects the balls of both cameras' images, each with the noise learned from its first eight
/// images as `track` does it, and compares them with the truth of the recording. Balls visible by
/// less than `least_visible` are neither asked for nor false.
DetectionScore ScoreDetections(const std::filesystem::path& recording,
                               const DetectionOptions& options = {}, double least_visible = 0.9);

/// Spells the figures as one row.
std::string DetectionRow(const std::string& name, const DetectionScore& score);
std::string DetectionHeader();

}  // namespace stereomotion::testing
