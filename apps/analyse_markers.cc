#include "analyse_markers.h"

#include <fmt/format.h>

#include <algorithm>

#include "stereomotion/core/user_error.h"
#include "stereomotion/io/c3d_file.h"
#include "stereomotion/motion/marker_cluster.h"

namespace stereomotion::app {
namespace {

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

}  // namespace

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

}  // namespace stereomotion::app
