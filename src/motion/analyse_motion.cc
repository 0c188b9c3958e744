#include "stereomotion/motion/analyse_motion.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "filter_segments.h"
#include "fit_recording.h"
#include "motion_warnings.h"

namespace stereomotion {
namespace {

// Fewer poses leave no residual in any law.
constexpr std::size_t kFewestPoses = 3;

std::size_t CountMeasured(const PoseSeries& series) {
  return static_cast<std::size_t>(std::count_if(
      series.begin(), series.end(), [](const PoseSample& pose) { return pose.measured; }));
}

// v and a of the centre by its law; its covariance with the local fit's ω and α is not known.
void MoveToCenter(const CenterState& state, BodyVelocity& velocity) {
  velocity.velocity_mm_s = state.velocity_mm_s;
  velocity.acceleration_mm_s2 = state.acceleration_mm_s2;
  constexpr Eigen::Index kVelocity = 3, kAcceleration = 9;
  for (const auto& [to, from] : {std::pair{kVelocity, Eigen::Index{3}}, {kAcceleration, 6}}) {
    velocity.covariance.middleRows<3>(to).setZero();
    velocity.covariance.middleCols<3>(to).setZero();
    velocity.covariance.block<3, 3>(to, to) = state.covariance.block<3, 3>(from, from);
  }
  velocity.covariance.block<3, 3>(kVelocity, kAcceleration) = state.covariance.block<3, 3>(3, 6);
  velocity.covariance.block<3, 3>(kAcceleration, kVelocity) = state.covariance.block<3, 3>(6, 3);
}

void MakeSamples(const std::vector<BodyVelocity>& velocities, const std::vector<bool>& has_center,
                 MotionAnalysis& analysis) {
  analysis.samples.resize(velocities.size());
  for (std::size_t i = 0; i < velocities.size(); ++i) {
    MotionSample& sample = analysis.samples[i];
    sample.status = velocities[i].status;
    sample.velocity = velocities[i];
    if (!analysis.spin.center || !has_center[i] || sample.status == MotionStatus::kGap) continue;
    sample.center = analysis.spin.center->states[i];
    MoveToCenter(*sample.center, sample.velocity);
  }
}

// |ω| without what its own noise adds to it.
double Rate(const BodyVelocity& velocity) {
  const double noise = velocity.covariance.topLeftCorner<3, 3>().trace();
  return std::sqrt(std::max(0.0, velocity.omega_rad_s.squaredNorm() - noise));
}

// Trapezia between neighbouring frames; gaps count neither as way nor as time. About one axis and
// never back, the first and the last pose tell the way, much better than the sum of all rates.
void MeasureRotation(MotionAnalysis& analysis) {
  double way_rad = 0, time_s = 0;
  for (std::size_t i = 1; i < analysis.samples.size(); ++i) {
    const MotionSample &a = analysis.samples[i - 1], &b = analysis.samples[i];
    if (a.status == MotionStatus::kGap || b.status == MotionStatus::kGap) continue;
    const double dt_s =
        SecondsAfterFirst(analysis.series, i) - SecondsAfterFirst(analysis.series, i - 1);
    way_rad += dt_s * (Rate(a.velocity) + Rate(b.velocity)) / 2;
    time_s += dt_s;
  }
  analysis.total_rad = way_rad;
  constexpr double kSameWay = 0.05;  // what the rates' noise leaves open between to-and-fro and not
  if (analysis.axis && analysis.axis->axis.accepted) {
    const double net_rad = std::abs(analysis.axis->axis.total_rad);
    if (std::abs(net_rad - way_rad) < kSameWay * way_rad) analysis.total_rad = net_rad;
  }
  if (time_s > 0) analysis.mean_rate_rad_s = analysis.total_rad / time_s;
}

}  // namespace

std::size_t JointFitStride(std::size_t measured, std::size_t max_joint_frames) {
  const std::size_t most = std::max<std::size_t>(1, max_joint_frames);
  return std::max<std::size_t>(1, (measured + most - 1) / most);
}

MotionAnalysis AnalyseMotion(const MotionData& data, const AnalyseOptions& options) {
  MotionAnalysis analysis;
  analysis.series = PosesOf(data);
  CheckSeries(analysis.series);
  analysis.samples.resize(analysis.series.size());
  const std::size_t measured = CountMeasured(analysis.series);
  if (measured < kFewestPoses) {
    analysis.spin.verdict = "fewer than three poses: nothing can be said of the motion";
    analysis.warnings.push_back(analysis.spin.verdict);
    return analysis;
  }
  const std::size_t stride = JointFitStride(measured, options.max_joint_frames);
  const std::vector<bool> has_center = FitRecording(data, options, stride, analysis);
  const Eigen::Vector3d near_in_body_mm = Centroid(data.balls_in_body_mm);
  if (auto axis = FindMeanAxis(analysis.series, near_in_body_mm)) {
    if (options.center.with_calibration)
      AddCommonPart(data, analysis.series, near_in_body_mm, *axis);
    analysis.axis = *axis;
  }
  analysis.screws = ScrewAxes(analysis.series, near_in_body_mm);
  MakeSamples(EstimateVelocities(analysis.series, options.velocity), has_center, analysis);
  MeasureRotation(analysis);
  analysis.warnings = MotionWarnings(data, analysis, stride);
  return analysis;
}

}  // namespace stereomotion
