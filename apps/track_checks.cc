#include "track_checks.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "stereomotion/core/output_error.h"
#include "stereomotion/core/user_error.h"
#include "stereomotion/pose/body_confusion.h"

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

std::string RodNames(const Body& body, const BodyConfusion& found, bool first) {
  std::string names;
  for (const auto& rods : found.rods) {
    const int rod = first ? rods.first : rods.second;
    names += (names.empty() ? "" : " and ") + body.rods[static_cast<std::size_t>(rod)].name;
  }
  return fmt::format("{} {} of '{}'", found.rods.size() > 1 ? "rods" : "rod", names, body.name);
}

std::string ConfusionText(const Body& a, const Body& b, const BodyConfusion& found) {
  return fmt::format(
      "{} lie on {} within {:.2f} mm (swap margin: RMS distance of the balls after "
      "the best alignment), expected at least {:.2f} mm",
      RodNames(a, found, true), RodNames(b, found, false), found.margin_mm, found.needed_mm);
}

constexpr const char* kMakeThemDiffer =
    "Thread the balls of one body at other distances, or put its rods at other places to each "
    "other, and measure it again";

// What one pair of bodies gives reason to warn of, or nothing.
std::string CheckTwo(const Body& a, const Body& b) {
  const auto whole = FindConfusion(a, b);
  if (whole && whole->alike()) {
    throw UserError(fmt::format("--body: the bodies '{}' and '{}' look alike: {}. {}", a.name,
                                b.name, ConfusionText(a, b, *whole), kMakeThemDiffer));
  }
  const ConfusionOptions options;
  const auto part = FindConfusion(a, b, options, options.rods.min_balls);
  if (!part || !part->alike()) return "";
  return fmt::format(
      "the bodies '{}' and '{}' may be taken for each other where only {} balls a rod "
      "are seen: of these, {}",
      a.name, b.name, options.rods.min_balls, ConfusionText(a, b, *part));
}

}  // namespace

std::vector<std::string> CheckBodiesDiffer(const std::vector<Body>& bodies) {
  std::vector<std::string> warnings;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    for (std::size_t j = i + 1; j < bodies.size(); ++j) {
      const std::string warning = CheckTwo(bodies[i], bodies[j]);
      if (!warning.empty()) warnings.push_back(warning);
    }
  }
  return warnings;
}

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
    for (const std::string& body : options.bodies) RefuseInput(target, body);
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
