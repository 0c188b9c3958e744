#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "stereomotion/core/body.h"
#include "stereomotion/io/row_file.h"
#include "stereomotion/io/run_record.h"
#include "stereomotion/pose/pair_measurement.h"

namespace stereomotion {

/// Says what the rows of a RUN are about.
struct RunNames {
  std::vector<Body> bodies;  ///< several: each has a folder of its name in RUN
  std::string left_camera;
  std::string right_camera;
};

/// Refuses a folder that `PrepareRunFolder` would refuse, and changes nothing. Throws `UserError`.
void CheckRunFolder(const std::filesystem::path& folder, bool overwrite);

/// Makes the folder for a RUN, or takes an empty one; of one that is used, with `overwrite` only,
/// and takes away the results that a run before left there and in its bodies' folders; other files
/// stay. Throws `UserError` where `folder` exists and is not empty and `overwrite` is not set,
/// `OutputError` where it cannot be made.
void PrepareRunFolder(const std::filesystem::path& folder, bool overwrite);

/// Writes a RUN folder: poses.csv, balls.csv, detections.csv of every body as the pairs come
/// (`FolderOfBody`), run.json at the end. All files are valid at every moment, and hold the same
/// frame pairs.
class RunWriter {
 public:
  /// Creates the folder and the files with their headers, and a run.json of state "running".
  /// Throws `UserError` where `folder` exists and is not empty and `overwrite` is not set,
  /// `OutputError` where it cannot be written.
  RunWriter(const std::filesystem::path& folder, RunNames names, bool overwrite,
            const RunRecord& record);
  ~RunWriter();

  /// Takes what was measured of one body; with the last body of a frame pair, writes all rows of
  /// that pair, or throws `OutputError` and leaves none of them.
  void Write(const PairMeasurement& measurement);

  /// Replaces run.json; works on a full disk, because its room was taken at the start.
  void WriteRecord(const RunRecord& record);

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

 private:
  struct BodyFiles;
  void WritePair();

  std::filesystem::path folder_;
  RunNames names_;
  RowFile record_;
  std::vector<std::unique_ptr<BodyFiles>> files_;  ///< one a body
};

}  // namespace stereomotion
