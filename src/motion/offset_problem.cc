#include "motion/offset_problem.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "motion/filter_segments.h"
#include "motion/path_stencil.h"
#include "stereomotion/core/units.h"

namespace stereomotion {
namespace {

constexpr int kMostNodes = OffsetNormals::kBand + 1;
constexpr int kFewestNodes = 3;         // velocity and acceleration
constexpr double kFarthestPeriods = 3;  // between neighbours: beyond, no polynomial is the path

/// Tells whether the image points determine a pose: three balls, with a row to spare.
bool DeterminePose(const MotionFrame& frame) {
  constexpr std::size_t kFewestPoints = 4, kFewestBalls = 3;
  std::set<int> balls;
  for (const ImagePoint& point : frame.image_points) balls.insert(point.ball);
  return frame.image_points.size() >= kFewestPoints && balls.size() >= kFewestBalls;
}

}  // namespace

OffsetProblem::OffsetProblem(const MotionData& data, CommonErrors errors)
    : data_(data), errors_(std::move(errors)) {
  const PoseSeries series = PosesOf(data);
  CheckSeries(series);
  period_s_ = MedianPeriodS(series);
  ChooseFrames();
  MakeStencils();
}

void OffsetProblem::ChooseFrames() {
  std::vector<std::size_t> run;
  const auto finish = [&] {
    if (run.size() >= kFewestNodes) frames_.insert(frames_.end(), run.begin(), run.end());
    run.clear();
  };
  for (std::size_t i = 0; i < data_.frames.size(); ++i) {
    const MotionFrame& frame = data_.frames[i];
    if (!frame.pose.measured || frame.pose.free_axis_in_world || !DeterminePose(frame)) continue;
    const auto since = [&](std::size_t j) {
      return SecondsBetween(data_.frames[j].pose.timestamp_ns, frame.pose.timestamp_ns);
    };
    if (!run.empty() && since(run.back()) > kFarthestPeriods * period_s_) finish();
    run.push_back(i);
  }
  finish();
}

void OffsetProblem::MakeStencils() {
  const int size = static_cast<int>(frames_.size());
  const auto after = [&](int j, int k) {
    return SecondsBetween(data_.frames[frames_[k]].pose.timestamp_ns,
                          data_.frames[frames_[j]].pose.timestamp_ns);
  };
  int begin = 0, end = 0;  // of the run without long gaps
  for (int k = 0; k < size; ++k) {
    if (k == end) {
      begin = k;
      for (end = k + 1; end < size && after(end, end - 1) <= kFarthestPeriods * period_s_;) ++end;
    }
    const int count = std::min(kMostNodes, end - begin);
    PathStencil stencil;
    stencil.first = std::clamp(k - count / 2, begin, end - count);
    stencil.self = k - stencil.first;
    for (int s = 0; s < count; ++s) stencil.times_s.push_back(after(stencil.first + s, k));
    stencils_.push_back(stencil);
    MotionFrame image_only = data_.frames[frames_[k]];
    image_only.space_points.clear();
    points_.push_back(ObservationsOf(data_, image_only));
  }
}

OffsetUnknowns OffsetProblem::Start(double offset_s) const {
  OffsetUnknowns start{{}, offset_s, Eigen::VectorXd::Zero(errors_.root.cols())};
  for (const std::size_t i : frames_) start.poses.push_back(data_.frames[i].pose.world_from_body);
  return start;
}

Rigid3 OffsetProblem::PoseAt(const std::vector<Rigid3>& poses, int k, double offset_s) const {
  return EvaluatePath(stencils_[k], poses, offset_s).world_from_body;
}

}  // namespace stereomotion
