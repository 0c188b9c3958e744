#include "stereomotion/motion/joint.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "motion/joint_fit.h"
#include "motion/joint_verdict.h"
#include "stereomotion/motion/one_axis.h"

namespace stereomotion {
namespace {

constexpr std::size_t kLeastFrames = 3;
/// Of Gauss–Newton's information, what must be left when the noise in the Jacobian is taken off.
constexpr double kLeastShare = 0.1;

bool IsWhole(const PoseSample& pose) { return pose.measured && !pose.free_axis_in_world; }

/// Holds the common frames: both poses, and each body as the other sees it.
struct Common {
  std::vector<PosePair> pairs;
  PoseSeries first_from_second, second_from_first;  ///< rotation's covariance only
};

PoseSample Relative(const PoseSample& first, const PoseSample& second) {
  PoseSample relative = first;
  relative.world_from_body = first.world_from_body.Inverse() * second.world_from_body;
  const Eigen::Matrix3d turn = first.world_from_body.rotation.toRotationMatrix();
  relative.covariance.setZero();
  relative.covariance.topLeftCorner<3, 3>() =
      turn.transpose() *
      (first.covariance.topLeftCorner<3, 3>() + second.covariance.topLeftCorner<3, 3>()) * turn;
  return relative;
}

Common CommonFrames(const PoseSeries& first, const PoseSeries& second) {
  Common common;
  std::size_t j = 0;
  for (const PoseSample& a : first) {
    while (j < second.size() && second[j].frame < a.frame) ++j;
    if (j == second.size() || second[j].frame != a.frame) continue;
    if (!IsWhole(a) || !IsWhole(second[j])) continue;
    common.pairs.push_back(
        {a.world_from_body, second[j].world_from_body, a.covariance, second[j].covariance});
    common.first_from_second.push_back(Relative(a, second[j]));
    common.second_from_first.push_back(Relative(second[j], a));
  }
  return common;
}

/// Where two bodies have too few common frames: too few, or a rod's turn about itself is open.
JointFailure WhyTooFew(const PoseSeries& first, const PoseSeries& second) {
  const auto is_rod = [](const PoseSeries& series) {
    const auto is_open = [](const PoseSample& pose) {
      return pose.measured && pose.free_axis_in_world.has_value();
    };
    return std::any_of(series.begin(), series.end(), is_open) &&
           std::none_of(series.begin(), series.end(), IsWhole);
  };
  return is_rod(first) || is_rod(second) ? JointFailure::kOneRod : JointFailure::kTooFewPoses;
}

/// Expresses the swapped bodies' axis in the order of `like`.
OneAxis Swapped(const OneAxis& swapped, const OneAxis& like) {
  OneAxis axis = swapped;
  const double sense = swapped.in_body.dot(like.in_world) < 0 ? -1 : 1;
  axis.in_world = sense * swapped.in_body;
  axis.in_body = sense * swapped.in_world;
  std::swap(axis.covariance_in_world, axis.covariance_in_body);
  return axis;
}

/// Fits the axis in both orders and takes the mean, so that none comes first. Of one axis both
/// agree; of several the best single one depends a little on where residuals are counted.
Expected<OneAxis, AxisFailure> FitAxisOfBoth(const Common& common) {
  const auto forwards = FitOneAxis(common.first_from_second);
  const auto backwards = FitOneAxis(common.second_from_first);
  if (!forwards || !backwards) return forwards ? backwards : forwards;
  const OneAxis other = Swapped(*backwards, *forwards);
  OneAxis mean = *forwards;
  mean.in_body = (mean.in_body + other.in_body).normalized();
  mean.in_world = (mean.in_world + other.in_world).normalized();
  mean.covariance_in_body = (mean.covariance_in_body + other.covariance_in_body) / 2;
  mean.covariance_in_world = (mean.covariance_in_world + other.covariance_in_world) / 2;
  mean.dispersion_rad = (mean.dispersion_rad + other.dispersion_rad) / 2;
  mean.accepted = forwards->accepted && backwards->accepted;
  return mean;
}

double RangeOfRotation(const PoseSeries& series) {
  double least = 1;
  for (std::size_t i = 0; i < series.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double cosine =
          series[i].world_from_body.rotation.dot(series[j].world_from_body.rotation);
      least = std::min(least, std::abs(cosine));
    }
  }
  return 2 * std::acos(least);
}

/// Which way an axis points is open; both bodies must agree on it, whichever is called first: its
/// mean over the run points along the world axis that it is nearest to, not against it.
double SenseOf(const std::vector<PosePair>& pairs, const OneAxis& axis) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const PosePair& pair : pairs) {
    mean += pair.first.rotation * axis.in_world + pair.second.rotation * axis.in_body;
  }
  Eigen::Index largest = 0;
  mean.cwiseAbs().maxCoeff(&largest);
  return mean[largest] < 0 ? -1 : 1;
}

/// Directions in which the centres are determined: all, or all but along the axis of both bodies.
Eigen::MatrixXd Determined(const std::optional<OneAxis>& hinge) {
  if (!hinge) return Matrix6d::Identity();
  Vector6d along;
  along << hinge->in_world, hinge->in_body;
  const Eigen::MatrixXd q = Eigen::HouseholderQR<Vector6d>(along).householderQ();
  return q.rightCols(5);
}

/// Covariance in the determined directions (see axis_fit.cc for the two Hessians); nothing where
/// noise makes most of what tells the centre.
std::optional<Matrix6d> CovarianceOf(const JointFit& fit, const Eigen::MatrixXd& basis) {
  const Eigen::MatrixXd newton = basis.transpose() * fit.gauss_newton * basis;
  const Eigen::MatrixXd hessian = basis.transpose() * fit.hessian * basis;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> share(hessian, newton,
                                                                        Eigen::EigenvaluesOnly);
  if (share.eigenvalues()[0] < kLeastShare) return std::nullopt;
  const Eigen::MatrixXd inverse = hessian.inverse();
  return Matrix6d(basis * inverse * newton * inverse * basis.transpose());
}

void UseAxis(const OneAxis& axis, double sense, bool is_hinge, Joint& joint) {
  joint.axis_in_first = sense * axis.in_world;
  joint.axis_in_second = sense * axis.in_body;
  joint.axis_covariance_in_first = axis.covariance_in_world;
  joint.axis_covariance_in_second = axis.covariance_in_body;
  joint.axis_dispersion_rad = axis.dispersion_rad;
  if (is_hinge) joint.free_axis_in_first = joint.axis_in_first;
}

void UseCenters(const JointFit& fit, const Matrix6d& covariance, std::size_t frames, int unknowns,
                Joint& joint) {
  joint.center_in_first_mm = fit.centers_mm.head<3>();
  joint.center_in_second_mm = fit.centers_mm.tail<3>();
  joint.center_covariance_mm2 = covariance;
  joint.chi2 = fit.chi2;
  joint.dof = 3 * static_cast<int>(frames) - unknowns;
  joint.rms_mm = std::sqrt(fit.squares_mm2 / static_cast<double>(frames));
}

}  // namespace

Expected<Joint, JointFailure> FindJoint(const PoseSeries& first, const PoseSeries& second) {
  const Common common = CommonFrames(first, second);
  if (common.pairs.size() < kLeastFrames) return Unexpected{WhyTooFew(first, second)};
  const Expected<OneAxis, AxisFailure> axis = FitAxisOfBoth(common);
  if (!axis) return Unexpected{JointFailure::kNoRelativeRotation};
  std::optional<OneAxis> hinge;
  if (axis->accepted) hinge = *axis;
  JointFit fit = FitJoint(common.pairs, Determined(hinge));
  std::optional<Matrix6d> covariance = CovarianceOf(fit, Determined(hinge));
  if (!covariance && !hinge) {  // a second axis, but too little of it to tell the centre along it
    hinge = *axis;
    fit = FitJoint(common.pairs, Determined(hinge));
    covariance = CovarianceOf(fit, Determined(hinge));
  }
  if (!covariance) return Unexpected{JointFailure::kNoRelativeRotation};
  Joint joint;
  joint.range_of_rotation_rad = RangeOfRotation(common.first_from_second);
  UseAxis(*axis, SenseOf(common.pairs, *axis), hinge.has_value(), joint);
  UseCenters(fit, *covariance, common.pairs.size(), hinge ? 5 : 6, joint);
  joint.verdict = VerdictOf(joint);
  return joint;
}

}  // namespace stereomotion
