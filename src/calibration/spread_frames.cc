#include "spread_frames.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace stereomotion {
namespace {

// Per image: mean and extent along u, v and between them [px].
using Description = Eigen::Matrix<double, 10, 1>;

Description Describe(const RodFrame& frame) {
  Description description;
  for (int camera = 0; camera < 2; ++camera) {
    Eigen::Vector2d mean_px = Eigen::Vector2d::Zero();
    Eigen::Matrix2d moment_px2 = Eigen::Matrix2d::Zero();
    const auto& points = frame.matches.front().points;
    for (const auto& pair : points) mean_px += frame.pixels_px[camera][pair[camera]];
    mean_px /= static_cast<double>(points.size());
    for (const auto& pair : points) {
      const Eigen::Vector2d off_px = frame.pixels_px[camera][pair[camera]] - mean_px;
      moment_px2 += off_px * off_px.transpose() / static_cast<double>(points.size());
    }
    const double between_px2 = moment_px2(0, 1);
    description.segment<5>(5 * camera) << mean_px, std::sqrt(moment_px2(0, 0)),
        std::sqrt(moment_px2(1, 1)), std::copysign(std::sqrt(std::abs(between_px2)), between_px2);
  }
  return description;
}

}  // namespace

std::vector<RodFrame> SpreadFrames(const std::vector<RodFrame>& frames, std::size_t most) {
  std::vector<Description> descriptions;
  Description mean = Description::Zero();
  for (const RodFrame& frame : frames) {
    descriptions.push_back(Describe(frame));
    mean += descriptions.back() / static_cast<double>(frames.size());
  }
  std::vector<double> distance;
  for (const auto& description : descriptions) distance.push_back((description - mean).norm());
  std::vector<RodFrame> chosen;
  while (chosen.size() < std::min(most, frames.size())) {
    const auto next = static_cast<std::size_t>(std::max_element(distance.begin(), distance.end()) -
                                               distance.begin());
    const bool first = chosen.empty();
    chosen.push_back(frames[next]);
    for (std::size_t f = 0; f < frames.size(); ++f) {
      const double apart = (descriptions[f] - descriptions[next]).norm();
      distance[f] = first ? apart : std::min(distance[f], apart);
    }
    distance[next] = -1;  // once each, also where frames are alike
  }
  return chosen;
}

}  // namespace stereomotion
