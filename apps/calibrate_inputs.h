#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "commands.h"
#include "stereomotion/calibration/calibration.h"
#include "stereomotion/calibration/target_observation.h"
#include "stereomotion/io/frame_file.h"

namespace stereomotion::app {

/// What was found in the images of a calibration.
struct CalibrateInputs {
  FrameFile file;  ///< cameras' image sizes filled in
  std::vector<TargetObservation> observations;
  /// The observations' covariances are true, not mere weights (see `CalibrateOptions`).
  bool image_sigma_known = true;
  std::vector<CalibrationNote> notes;
  /// Why one of the cameras saw nothing in any image: then there is nothing to calibrate from.
  std::optional<CalibrationNote> blind_camera;
  bool interrupted = false;  ///< by SIGINT or SIGTERM: nothing else holds
};

/// Reads frame.yaml and its images and finds the target in them, on `threads` threads (0: one a
/// core). Throws `UserError` for files that cannot be meant. Images without the target are told in
/// `notes`; exchanged cameras throw.
CalibrateInputs LoadCalibrateInputs(const std::filesystem::path& frame, int threads,
                                    const CommonOptions& common);

}  // namespace stereomotion::app
