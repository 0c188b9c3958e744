#include "analyse_inputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "analyse_markers.h"
#include "motion_run.h"
#include "stereomotion/core/units.h"
#include "stereomotion/core/user_error.h"
#include "stereomotion/io/motion_reader.h"
#include "stereomotion/io/run_reader.h"
#include "stereomotion/motion/pose_noise.h"

namespace stereomotion::app {
namespace {

namespace fs = std::filesystem;

std::string LowerExtension(const fs::path& file) {
  std::string extension = file.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

// Poses that carry no covariance get the one that the user states, or one estimated from them.
void GiveNoise(const AnalyseArguments& arguments, const fs::path& file, MotionData& data,
               std::vector<std::string>& warnings) {
  PoseSeries series = PosesOf(data);
  if (HasCovariances(series)) {
    if (arguments.pose_sigma_deg <= 0 && arguments.pose_sigma_mm <= 0) return;
    throw UserError(
        fmt::format("--pose-sigma-deg, --pose-sigma-mm: {} has covariances of its own (cov_00 …), "
                    "expected poses without; leave the options away",
                    file.string()));
  }
  PoseNoise noise{arguments.pose_sigma_deg / kDegreesPerRadian, arguments.pose_sigma_mm};
  if (noise.rotation_rad <= 0 || noise.translation_mm <= 0) {
    const auto estimated = EstimatePoseNoise(series);
    if (!estimated) {
      throw UserError(
          fmt::format("{}: has no columns cov_00 … cov_55 and too few poses to estimate "
                      "their noise; give --pose-sigma-deg and --pose-sigma-mm",
                      file.string()));
    }
    if (noise.rotation_rad <= 0) noise.rotation_rad = estimated->rotation_rad;
    if (noise.translation_mm <= 0) noise.translation_mm = estimated->translation_mm;
    warnings.push_back(fmt::format(
        "{}: the poses carry no covariance; {:.3g}° and {:.3g} mm a pose are estimated from their "
        "scatter, and all uncertainties rest on that (or give --pose-sigma-deg, --pose-sigma-mm)",
        file.string(), kDegreesPerRadian * noise.rotation_rad, noise.translation_mm));
  }
  GivePoseNoise(noise, series);
  for (std::size_t i = 0; i < series.size(); ++i) data.frames[i].pose = series[i];
}

void LoadPoses(const AnalyseArguments& arguments, AnalyseInputs& inputs) {
  MotionData data;
  for (const PoseSample& pose : ReadPosesCsv(arguments.input)) {
    data.frames.emplace_back().pose = pose;
  }
  GiveNoise(arguments, arguments.input, data, inputs.warnings);
  inputs.bodies.push_back({"body1", inputs.folder, std::move(data)});
}

// Bodies that run.json names but whose poses are gone are left out, not silently.
void NoteLostBodies(const fs::path& run, std::vector<std::string>& warnings) {
  for (const std::string& name : ReadRunOrigin(run).body_folders) {
    if (fs::exists(run / name / "poses.csv")) continue;
    warnings.push_back(
        fmt::format("{}: found no poses.csv of the body '{}' that run.json names; "
                    "it is left out",
                    run.string(), name));
  }
}

// RUN/poses.csv of one body, RUN/<body>/poses.csv of several.
void LoadRun(const AnalyseArguments& arguments, const AnalyseOptions& options,
             AnalyseInputs& inputs) {
  const fs::path run = arguments.input;
  std::vector<fs::path> folders;
  if (fs::exists(run / "poses.csv")) {
    folders.push_back(run);
  } else if (fs::exists(run / "run.json")) {  // else it is a recording, whose truth has poses too
    for (const auto& entry : fs::directory_iterator(run)) {
      if (fs::exists(entry.path() / "poses.csv")) folders.push_back(entry.path());
    }
    NoteLostBodies(run, inputs.warnings);
  }
  if (folders.empty()) {
    throw UserError(run.string() + ": found no poses.csv, expected a RUN that `track` wrote");
  }
  std::sort(folders.begin(), folders.end());
  for (const fs::path& folder : folders) {
    const std::string name = folder == run ? "body" : fs::path(folder).filename().string();
    AnalyseBody body{name,
                     arguments.output.empty() ? folder
                     : folder == run          ? inputs.folder
                                              : inputs.folder / name,
                     ReadRunMotion(folder, options.max_joint_frames)};
    GiveNoise(arguments, folder / "poses.csv", body.data, inputs.warnings);
    inputs.bodies.push_back(std::move(body));
  }
}

}  // namespace

AnalyseInputs LoadAnalyseInputs(const AnalyseArguments& arguments, const AnalyseOptions& options) {
  const fs::path input = fs::path(arguments.input).lexically_normal();
  std::error_code ignored;
  AnalyseInputs inputs;
  if (!fs::exists(input, ignored)) {
    throw UserError(arguments.input +
                    ": no such file or folder, expected a RUN that `track` "
                    "wrote, a CSV file of poses, or a C3D file");
  }
  inputs.is_run = fs::is_directory(input, ignored);
  inputs.folder = !arguments.output.empty() ? fs::path(arguments.output)
                  : inputs.is_run           ? input
                                            : fs::path(input.stem().string() + "-motion");
  const std::string extension = LowerExtension(input);
  const bool markers = extension == ".c3d" || extension == ".n3d";
  if (!markers && (!arguments.points.empty() || arguments.point_sigma_mm > 0)) {
    throw UserError("--points, --point-sigma-mm: are for C3D and N3D files; " + arguments.input +
                    " is none");
  }
  if (markers && (arguments.pose_sigma_deg > 0 || arguments.pose_sigma_mm > 0)) {
    throw UserError("--pose-sigma-deg, --pose-sigma-mm: are for poses; " + arguments.input +
                    " holds markers: --point-sigma-mm");
  }
  if (inputs.is_run) {
    LoadRun(arguments, options, inputs);
  } else if (markers) {
    LoadMarkers(arguments, inputs);
  } else {
    LoadPoses(arguments, inputs);
  }
  if (!arguments.joint.empty() && inputs.bodies.size() != 2) {
    throw UserError(fmt::format("--joint: found {} bodies, expected two (proximal and distal)",
                                inputs.bodies.size()));
  }
  return inputs;
}

}  // namespace stereomotion::app
