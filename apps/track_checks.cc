#include "track_checks.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "stereomotion/core/user_error.h"
#include "stereomotion/io/output_error.h"

namespace stereomotion::app {
namespace {

namespace fs = std::filesystem;

/// A mask that covers more than this share of an image hides balls, too.
constexpr double kMuch = 0.1;

void RefuseInput(const fs::path& target, const fs::path& input) {
  std::error_code none;
  if (fs::equivalent(target, input, none)) {
    throw UserError(target.string() + ": is an input, expected another --learn-mask");
  }
}

// A mask may lie in a camera's folder; an image there is no place for one.
void RefuseImage(const fs::path& target, const fs::path& camera) {
  std::error_code none;
  const fs::path file = fs::canonical(target, none);
  const bool is_mask = file.extension() == ".yaml" || file.extension() == ".yml";
  if (!is_mask && fs::is_directory(camera, none) &&
      fs::equivalent(file.parent_path(), camera, none)) {
    throw UserError(target.string() + ": lies among the images of " + camera.string() +
                    ", expected another --learn-mask");
  }
}

// Only creating a file tells whether one can be created.
void RequireWritable(const fs::path& target) {
  std::error_code none;
  const bool is_special = fs::exists(target, none) && !fs::is_regular_file(target, none);
  if (is_special) throw UserError(target.string() + ": is no file, expected one (--learn-mask)");
  fs::path probe = fs::exists(target, none) ? fs::canonical(target, none) : target;
  probe += ".part" + std::to_string(getpid());
  const int fd = open(probe.c_str(), O_CREAT | O_WRONLY | O_CLOEXEC, 0666);
  if (fd < 0) throw OutputError(target.string() + ": cannot be written: " + std::strerror(errno));
  close(fd);
  unlink(probe.c_str());
}

void AddMaskWarning(const ImageMask& mask, const RigCamera& camera, const std::string& name,
                    std::vector<std::string>& warnings) {
  if (mask.empty()) return;
  const double pixels = static_cast<double>(camera.width_px) * camera.height_px;
  const double share = static_cast<double>(mask.CountMasked()) / pixels;
  if (share <= kMuch) return;
  warnings.push_back(
      fmt::format("{}: {:.0f} % of the images of {} are masked; balls are not seen there", name,
                  100 * share, camera.name));
}

}  // namespace

std::vector<std::string> ExposureWarnings(const RecordingReport& report, double exposure_ms) {
  if (!(exposure_ms > 0) || report.left_with_exposure + report.right_with_exposure == 0) return {};
  const std::int64_t left = report.left_frames - report.left_with_exposure;
  const std::int64_t right = report.right_frames - report.right_with_exposure;
  if (left + right == 0) {
    return {"--exposure-ms is not used: the recording tells each frame's exposure"};
  }
  return {
      fmt::format("--exposure-ms is used for {} left and {} right frames only: the recording tells "
                  "the exposure "
                  "of the others",
                  left, right)};
}

std::vector<std::string> MaskWarnings(const MeasureSetup& setup, const std::string& name) {
  if (setup.left_mask.empty() && setup.right_mask.empty()) {
    return {name + ": masks nothing of the cameras that are measured"};
  }
  std::vector<std::string> warnings;
  const auto& cameras = setup.rig.cameras;
  AddMaskWarning(setup.left_mask, cameras[static_cast<std::size_t>(setup.left_camera)], name,
                 warnings);
  AddMaskWarning(setup.right_mask, cameras[static_cast<std::size_t>(setup.right_camera)], name,
                 warnings);
  return warnings;
}

void CheckMaskTarget(const TrackOptions& options, const TrackInputs& inputs) {
  const fs::path target = options.learn_mask;
  std::error_code none;
  if (fs::exists(target, none)) {
    RefuseInput(target, options.rig);
    RefuseInput(target, options.body);
    for (const Side side : {Side::kLeft, Side::kRight}) {
      for (const fs::path& file : inputs.recording->InputFiles(side)) RefuseInput(target, file);
    }
    for (const fs::path& camera : inputs.camera_paths) RefuseImage(target, camera);
    if (!options.force) {
      throw UserError(options.learn_mask + ": exists; give --force to overwrite, or another name");
    }
  }
  RequireWritable(target);
}

}  // namespace stereomotion::app
