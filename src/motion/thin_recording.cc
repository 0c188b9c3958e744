#include "thin_recording.h"

#include <algorithm>

namespace stereomotion {
namespace {

// All of the data but its frames.
MotionData WithoutFrames(const MotionData& data) {
  MotionData rest;
  rest.rig = data.rig;
  rest.left_camera = data.left_camera;
  rest.right_camera = data.right_camera;
  rest.balls_in_body_mm = data.balls_in_body_mm;
  rest.structure_covariance_mm2 = data.structure_covariance_mm2;
  rest.structure_known = data.structure_known;
  return rest;
}

// Index into `kept` of the frame nearest to `frame`.
std::size_t NearestKept(const std::vector<std::size_t>& kept, std::size_t frame) {
  const auto after = std::lower_bound(kept.begin(), kept.end(), frame);
  if (after == kept.begin()) return 0;
  if (after == kept.end()) return kept.size() - 1;
  const auto before = after - 1;
  return static_cast<std::size_t>((*after - frame < frame - *before ? after : before) -
                                  kept.begin());
}

void Spread(const PoseSeries& series, const std::vector<std::size_t>& kept, SpinCenter& center) {
  std::vector<CenterState> states(series.size());
  std::vector<Rigid3> poses(series.size());
  for (std::size_t i = 0; i < series.size(); ++i) {
    const std::size_t k = NearestKept(kept, i);
    const double dt_s = SecondsAfterFirst(series, i) - SecondsAfterFirst(series, kept[k]);
    states[i] = Propagated(center.states[k], dt_s);
    poses[i] = kept[k] == i ? center.poses[k] : series[i].world_from_body;
  }
  center.states = std::move(states);
  center.poses = std::move(poses);
}

}  // namespace

std::vector<std::size_t> EveryNthPose(const MotionData& data, std::size_t stride) {
  std::vector<std::size_t> kept;
  std::size_t measured = 0;
  for (std::size_t i = 0; i < data.frames.size(); ++i) {
    if (data.frames[i].pose.measured && measured++ % stride == 0) kept.push_back(i);
  }
  return kept;
}

MotionData FramesAt(const MotionData& data, const std::vector<std::size_t>& kept) {
  MotionData part = WithoutFrames(data);
  for (const std::size_t i : kept) part.frames.push_back(data.frames[i]);
  return part;
}

MotionData FirstPart(const MotionData& data, std::size_t measured) {
  MotionData part = WithoutFrames(data);
  std::size_t count = 0;
  for (const MotionFrame& frame : data.frames) {
    if (frame.pose.measured && count++ == measured) break;
    part.frames.push_back(frame);
  }
  return part;
}

std::vector<bool> SpreadOverSeries(const PoseSeries& series, const std::vector<std::size_t>& kept,
                                   SpinCenterResult& result) {
  for (LawFit& law : result.laws) {
    if (law.center) Spread(series, kept, *law.center);
  }
  if (result.center) Spread(series, kept, *result.center);
  for (int& frame : result.left_out) {
    frame = static_cast<int>(kept[static_cast<std::size_t>(frame)]);
  }
  std::vector<bool> has_state(series.size(), result.law != PathLaw::kFree);
  for (const std::size_t frame : kept) has_state[frame] = true;
  return has_state;
}

CenterState Propagated(const CenterState& state, double dt_s) {
  Eigen::Matrix<double, 9, 9> transition = Eigen::Matrix<double, 9, 9>::Identity();
  transition.block<3, 3>(0, 3) = transition.block<3, 3>(3, 6) = dt_s * Eigen::Matrix3d::Identity();
  transition.block<3, 3>(0, 6) = dt_s * dt_s / 2 * Eigen::Matrix3d::Identity();
  CenterState moved = state;
  moved.position_mm += dt_s * state.velocity_mm_s + dt_s * dt_s / 2 * state.acceleration_mm_s2;
  moved.velocity_mm_s += dt_s * state.acceleration_mm_s2;
  moved.covariance = transition * state.covariance * transition.transpose();
  return moved;
}

}  // namespace stereomotion
