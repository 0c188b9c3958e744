#include "motion/joint_verdict.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <cstdio>

#include "motion/significance.h"

namespace stereomotion {
namespace {

double LargestSigma(const Eigen::Matrix3d& covariance) {
  return std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance).eigenvalues()[2]);
}

}  // namespace

std::string VerdictOf(const Joint& joint) {
  constexpr double kDegrees = 180 / M_PI;
  const char* const kind = joint.free_axis_in_first ? "hinge" : "ball joint";
  const char* const where =
      joint.free_axis_in_first ? " across the axis and not at all along it" : "";
  char text[300];
  std::snprintf(
      text, sizeof text,
      "%s, range of rotation %.1f°: centre known to ± %.2g mm in the first body and ± %.2g mm "
      "in the second%s",
      kind, joint.range_of_rotation_rad * kDegrees,
      LargestSigma(joint.center_covariance_mm2.topLeftCorner<3, 3>()),
      LargestSigma(joint.center_covariance_mm2.bottomRightCorner<3, 3>()), where);
  std::string verdict = text;
  if (!IsAdequate(joint.chi2, joint.dof)) {
    std::snprintf(text, sizeof text,
                  "; the bodies have no common point: the best one moves by %.2g mm RMS, more than "
                  "noise explains",
                  joint.rms_mm);
    verdict += text;
  }
  return verdict;
}

}  // namespace stereomotion
