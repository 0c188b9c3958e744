#include "tests/support/motion_score.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

#include "stereomotion/geometry/so3.h"
#include "tests/support/motion_bound.h"

namespace stereomotion::testing {
namespace {

const TrueFrame& TrueFrameOf(const PoseSample& sample, const Truth& truth) {
  return truth.at(sample.frame);
}

/// The axis that the body truly turns about, in the world and in the body.
struct TrueAxis {
  Eigen::Vector3d in_world, in_body;
};

TrueAxis AxisOf(const Truth& truth) {
  const TrueFrame& first = truth.begin()->second;
  const Eigen::Vector3d in_world = first.omega_rad_s.normalized();
  return {in_world, first.world_from_body.rotation.conjugate() * in_world};
}

/// Columns along which a quantity is compared: across the axis, or all.
Eigen::MatrixXd Ways(bool one_axis, const Eigen::Vector3d& axis) {
  if (one_axis) return Across(axis);
  return Eigen::Matrix3d::Identity();
}

Eigen::Matrix3d TotalCovariance(const SpinCenter& center) {
  if (!center.calibration_covariance_mm2) return center.covariance_mm2;
  return center.covariance_mm2 + *center.calibration_covariance_mm2;
}

void ScoreCenter(const SpinCenter& center, const Truth& truth, bool one_axis,
                 ErrorStatistics& errors, double& error_mm, double& sigma_mm) {
  const TrueFrame& first = truth.begin()->second;
  const Eigen::Vector3d true_mm = first.world_from_body.Inverse() * first.center_mm;
  const Eigen::MatrixXd ways = Ways(one_axis, AxisOf(truth).in_body);
  const Eigen::VectorXd error = ways.transpose() * (center.in_body_mm - true_mm);
  const Eigen::MatrixXd covariance = ways.transpose() * TotalCovariance(center) * ways;
  errors.Add(error, covariance);
  error_mm = error.norm();
  sigma_mm = std::sqrt(covariance.trace());
}

void ScoreAxis(const MeanAxis& mean, const Truth& truth, MotionScore& score) {
  const OneAxis& axis = mean.axis;
  const AxisCommonPart common = mean.common.value_or(AxisCommonPart{});
  const TrueAxis true_axis = AxisOf(truth);
  const auto world = Across(true_axis.in_world);
  const auto body = Across(true_axis.in_body);
  score.axis_in_world.Add(
      world.transpose() * (axis.in_world - true_axis.in_world),
      world.transpose() * (axis.covariance_in_world + common.covariance_in_world) * world);
  score.axis_in_body.Add(
      body.transpose() * (axis.in_body - true_axis.in_body),
      body.transpose() * (axis.covariance_in_body + common.covariance_in_body) * body);
}

void ScoreVelocity(const MotionSample& sample, const TrueFrame& truth, ErrorStatistics& omega,
                   ErrorStatistics& velocity) {
  if (sample.status == MotionStatus::kGap) return;
  omega.Add(sample.velocity.omega_rad_s - truth.omega_rad_s,
            sample.velocity.covariance.topLeftCorner<3, 3>());
  // A law without velocity states an exact zero.
  if (sample.center && !sample.center->covariance.block<3, 3>(3, 3).isZero(0)) {
    velocity.Add(sample.center->velocity_mm_s - truth.velocity_mm_s,
                 sample.center->covariance.block<3, 3>(3, 3));
  }
}

std::string Text(const ErrorStatistics& errors) {
  if (errors.samples() == 0) return fmt::format("{:>8}", "-");
  return fmt::format("{:8.2f}", errors.nees_per_dof());
}

}  // namespace

double SigmaAcross(const SpinCenterResult& result, PathLaw law) {
  for (const LawFit& fit : result.laws) {
    if (fit.law != law || !fit.center) continue;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(fit.center->covariance_mm2);
    return std::sqrt(eigen.eigenvalues()[2]);
  }
  return std::numeric_limits<double>::quiet_NaN();
}

MotionScore ScoreMotion(const MotionAnalysis& given, const MotionAnalysis& chosen,
                        const MotionData& data, const Truth& truth, bool one_axis) {
  MotionScore score;
  score.frames = static_cast<int>(data.frames.size());
  score.range_rad = given.spin.range_of_rotation_rad;
  score.chosen = chosen.spin.law;
  score.evidence_open = chosen.spin.evidence_open;
  if (given.spin.center) {
    ScoreCenter(*given.spin.center, truth, one_axis, score.center_given, score.given_error_mm,
                score.given_sigma_mm);
  }
  if (chosen.spin.center) {
    ScoreCenter(*chosen.spin.center, truth, one_axis, score.center_chosen, score.chosen_error_mm,
                score.chosen_sigma_mm);
  }
  if (one_axis && given.axis) ScoreAxis(*given.axis, truth, score);
  const std::size_t last = given.samples.size() - 1;
  const std::size_t frames[] = {0, last / 2, last};
  for (std::size_t i = 0; i < 3; ++i) {
    ScoreVelocity(given.samples[frames[i]], TrueFrameOf(given.series[frames[i]], truth),
                  score.omega[i], score.velocity[i]);
  }
  if (given.time_offset) {
    score.offset_s = given.time_offset->offset_s;
    score.offset_u_s = given.time_offset->u_s;
  }
  return score;
}

std::string MotionScoreHeader() {
  return fmt::format("{:16} {:>6} {:>8} | {:^26} | {:^40} | {:^17} | {:^26} | {:^26} | {:^16}\n",
                     "", "frames", "range °", "centre, true law: mm, σ, z²",
                     "chosen law, open?, mm, σ, z²", "axis z² w, b", "ω z² first, middle, last",
                     "v z² first, middle, last", "offset, u ms");
}

std::string MotionScoreRow(const std::string& name, const MotionScore& score) {
  constexpr double kDegree = M_PI / 180;
  return fmt::format(
      "{:16} {:6d} {:8.2f} | {:8.4g} {:8.4g} {} | {:>12} {:>4} {:8.4g} {:8.4g} {} | {} {} | {} {} "
      "{} | {} {} {} | {:8.4f} {:7.4f}\n",
      name, score.frames, score.range_rad / kDegree, score.given_error_mm, score.given_sigma_mm,
      Text(score.center_given), LawWord(score.chosen), score.evidence_open ? "open" : "",
      score.chosen_error_mm, score.chosen_sigma_mm, Text(score.center_chosen),
      Text(score.axis_in_world), Text(score.axis_in_body), Text(score.omega[0]),
      Text(score.omega[1]), Text(score.omega[2]), Text(score.velocity[0]), Text(score.velocity[1]),
      Text(score.velocity[2]), 1e3 * score.offset_s, 1e3 * score.offset_u_s);
}

}  // namespace stereomotion::testing
