#include "analyse_inputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "motion_run.h"
#include "stereomotion/core/user_error.h"
#include "stereomotion/io/c3d_file.h"
#include "stereomotion/io/motion_reader.h"
#include "stereomotion/motion/marker_cluster.h"
#include "stereomotion/motion/pose_noise.h"

namespace stereomotion::app {
namespace {

namespace fs = std::filesystem;
constexpr double kDegPerRad = 57.29577951308232;

std::string LowerExtension(const fs::path& file) {
  std::string extension = file.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

// Poses that carry no covariance get the one that the user states, or one estimated from them.
void GiveNoise(const AnalyseArguments& arguments, const fs::path& file, MotionData& data,
               std::vector<std::string>& warnings) {
  PoseSeries series = PosesOf(data);
  if (HasCovariances(series)) return;
  PoseNoise noise{arguments.pose_sigma_deg / kDegPerRad, arguments.pose_sigma_mm};
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
        file.string(), kDegPerRad * noise.rotation_rad, noise.translation_mm));
  }
  GivePoseNoise(noise, series);
  for (std::size_t i = 0; i < series.size(); ++i) data.frames[i].pose = series[i];
}

// * stands for any text.
bool Matches(std::string_view pattern, std::string_view label) {
  const std::size_t star = pattern.find('*');
  if (star == std::string_view::npos) return pattern == label;
  if (label.substr(0, star) != pattern.substr(0, star)) return false;
  for (std::size_t skip = star; skip <= label.size(); ++skip) {
    if (Matches(pattern.substr(star + 1), label.substr(skip))) return true;
  }
  return false;
}

std::vector<std::string> Words(const std::string& text) {
  std::vector<std::string> words(1);
  for (const char c : text) {
    if (c == ',') {
      words.emplace_back();
    } else {
      words.back() += c;
    }
  }
  return words;
}

std::vector<std::size_t> Chosen(const C3dPoints& file, const std::string& points,
                                const std::string& path) {
  std::vector<std::size_t> chosen;
  for (const std::string& pattern : Words(points)) {
    const std::size_t before = chosen.size();
    for (std::size_t k = 0; k < file.labels.size(); ++k) {
      const bool twice = std::find(chosen.begin(), chosen.end(), k) != chosen.end();
      if (Matches(pattern, file.labels[k]) && !twice) chosen.push_back(k);
    }
    if (chosen.size() == before) {
      throw UserError(
          fmt::format("{}: --points: found no point '{}' besides those named before, "
                      "expected among {}",
                      path, pattern, fmt::join(file.labels, ", ")));
    }
  }
  return chosen;
}

AnalyseBody Cluster(const C3dPoints& file, const std::vector<std::size_t>& chosen,
                    const AnalyseArguments& arguments, std::vector<std::string>& warnings) {
  MarkerSeries markers{file.rate_hz, file.first_frame, {}};
  for (const auto& frame : file.points_mm) {
    auto& points = markers.points_mm.emplace_back();
    for (const std::size_t k : chosen) points.push_back(frame[k]);
  }
  const auto cluster = MakeCluster(markers, arguments.point_sigma_mm);
  if (!cluster) {
    throw UserError(arguments.input +
                    (cluster.error() == ClusterFailure::kTooFewMarkers
                         ? ": found fewer than three points, or points on one line, expected three "
                           "or more of one rigid body (--points)"
                         : ": found fewer than two frames with three points, expected more"));
  }
  warnings.push_back(
      fmt::format("rigid fit of {} points: RMS distance {:.3g} mm, σ of a "
                  "coordinate {:.3g} mm{}",
                  chosen.size(), cluster->rms_mm, cluster->sigma_mm,
                  arguments.point_sigma_mm > 0 ? " (given)" : " (estimated)"));
  if (cluster->not_rigid > 0) {
    warnings.push_back(
        fmt::format("{} frames do not fit a rigid body and were left out", cluster->not_rigid));
  }
  return {"", "", cluster->data};
}

void LoadMarkers(const AnalyseArguments& arguments, AnalyseInputs& inputs) {
  const C3dPoints file = ReadC3d(arguments.input);
  std::vector<std::string> clusters = arguments.points;
  if (clusters.empty()) clusters.emplace_back("*");
  for (const std::string& points : clusters) {
    AnalyseBody body =
        Cluster(file, Chosen(file, points, arguments.input), arguments, inputs.warnings);
    body.name = fmt::format("body{}", inputs.bodies.size() + 1);
    body.folder = clusters.size() == 1 ? inputs.folder : inputs.folder / body.name;
    inputs.bodies.push_back(std::move(body));
  }
}

void LoadPoses(const AnalyseArguments& arguments, AnalyseInputs& inputs) {
  MotionData data;
  for (const PoseSample& pose : ReadPosesCsv(arguments.input)) {
    data.frames.emplace_back().pose = pose;
  }
  GiveNoise(arguments, arguments.input, data, inputs.warnings);
  inputs.bodies.push_back({"body1", inputs.folder, std::move(data)});
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
  if (inputs.is_run) {
    LoadRun(arguments, options, inputs);
  } else if (markers) {
    LoadMarkers(arguments, inputs);
  } else {
    LoadPoses(arguments, inputs);
  }
  return inputs;
}

}  // namespace stereomotion::app
