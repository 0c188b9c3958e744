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

double LargestDistance_mm(const std::vector<Eigen::Vector3d>& points_mm) {
  double largest_mm = 0;
  for (const Eigen::Vector3d& a : points_mm) {
    for (const Eigen::Vector3d& b : points_mm) largest_mm = std::max(largest_mm, (a - b).norm());
  }
  return largest_mm;
}

std::string SomeLabels(const C3dPoints& file, const std::vector<std::size_t>& chosen) {
  constexpr std::size_t kMost = 8;  // a line's worth
  std::vector<std::string> labels;
  for (std::size_t i = 0; i < std::min(kMost, chosen.size()); ++i) {
    labels.push_back(file.labels[chosen[i]]);
  }
  if (chosen.size() > kMost) labels.emplace_back("…");
  return fmt::format("{}", fmt::join(labels, ", "));
}

// Markers of several bodies, such as a whole person's: their joint fit would take minutes to say
// nothing. Skin moves on a segment by some per cent of the cluster's size, bodies by far more.
void CheckRigid(const C3dPoints& file, const std::vector<std::size_t>& chosen,
                const MarkerCluster& cluster, AnalyseInputs& inputs) {
  constexpr double kLargestMisfit = 0.05;  // of the largest distance between two points
  const double size_mm = LargestDistance_mm(cluster.data.balls_in_body_mm);
  if (cluster.rms_mm <= kLargestMisfit * size_mm) return;
  inputs.no_answer = fmt::format(
      "these {} points are not one rigid body (rigid fit: RMS {:.3g} mm of {:.4g} mm): name those "
      "of one body with --points, among {}",
      chosen.size(), cluster.rms_mm, size_mm, SomeLabels(file, chosen));
}

AnalyseBody Cluster(const C3dPoints& file, const std::vector<std::size_t>& chosen,
                    const AnalyseArguments& arguments, AnalyseInputs& inputs) {
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
  CheckRigid(file, chosen, *cluster, inputs);
  inputs.warnings.push_back(
      fmt::format("rigid fit of {} points: RMS distance {:.3g} mm, σ of a "
                  "coordinate {:.3g} mm{}",
                  chosen.size(), cluster->rms_mm, cluster->sigma_mm,
                  arguments.point_sigma_mm > 0 ? " (given)" : " (estimated)"));
  if (cluster->not_rigid > 0) {
    inputs.warnings.push_back(fmt::format("left out, for they do not fit a rigid body: {} {}",
                                          cluster->not_rigid,
                                          cluster->not_rigid == 1 ? "frame" : "frames"));
  }
  return {"", "", cluster->data};
}

}  // namespace

void LoadMarkers(const AnalyseArguments& arguments, AnalyseInputs& inputs) {
  const C3dPoints file = ReadC3d(arguments.input);
  std::vector<std::string> clusters = arguments.points;
  if (clusters.empty()) clusters.emplace_back("*");
  for (const std::string& points : clusters) {
    AnalyseBody body = Cluster(file, Chosen(file, points, arguments.input), arguments, inputs);
    body.name = fmt::format("body{}", inputs.bodies.size() + 1);
    body.folder = clusters.size() == 1 ? inputs.folder : inputs.folder / body.name;
    inputs.bodies.push_back(std::move(body));
  }
}

}  // namespace stereomotion::app
