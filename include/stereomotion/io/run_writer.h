#pragma once

#include <filesystem>
#include <string>

#include "stereomotion/core/body.h"
#include "stereomotion/io/row_file.h"
#include "stereomotion/io/run_record.h"
#include "stereomotion/pose/pair_measurement.h"

namespace stereomotion {

/// Says what the rows of a RUN are about.
struct RunNames {
  Body body;
  std::string left_camera;
  std::string right_camera;
};

/// Writes a RUN folder: poses.csv, balls.csv, detections.csv as the pairs come, run.json at the
/// end. All files are valid at every moment, and hold the same frame pairs.
class RunWriter {
 public:
  /// Creates the folder and the files with their headers, and a run.json of state "running".
  /// Throws `UserError` where `folder` exists and is not empty and `overwrite` is not set,
  /// `OutputError` where it cannot be written.
  RunWriter(const std::filesystem::path& folder, RunNames names, bool overwrite,
            const RunRecord& record);
  ~RunWriter();

  /// Writes all rows of one frame pair, or throws `OutputError` and leaves none of them.
  void Write(const PairMeasurement& measurement);

  /// Replaces run.json; works on a full disk, because its room was taken at the start.
  void WriteRecord(const RunRecord& record);

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path folder_;
  RunNames names_;
  RowFile record_, balls_, detections_, poses_;
  std::string rows_;
};

}  // namespace stereomotion
