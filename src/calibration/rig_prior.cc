#include "rig_prior.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace stereomotion {
namespace {

constexpr int kIntrinsics = CameraModel::kNumParameters;
// Relative difference of variances and covariance up to which two parameters move as one: above the
// rounding of numbers that were written and read, below any real difference.
constexpr double kTied = 1e-9;
constexpr double kFixedRad = 1e-9, kFixedMm = 1e-6;
constexpr double kLeastEigenvalue = 1e-10;  // of the correlation matrix
constexpr double kNegative = -1e-4;         // beyond what rounding to five digits does

bool MoveAsOne(const RigCovariance& covariance, int i, int j) {
  const double a = covariance.matrix(i, i), b = covariance.matrix(j, j);
  return std::abs(a - b) <= kTied * a && std::abs(a - covariance.matrix(i, j)) <= kTied * a;
}

// Rows of the old covariance that the prior takes over, and the parameters that they are.
struct Selection {
  std::vector<int> rows;  ///< −1: known exactly
  std::vector<RigParameter> parameters;
};

void SelectIntrinsics(const Rig& rig, PriorPlan& plan, Selection& selection) {
  plan.intrinsic_unknown.resize(rig.cameras.size());
  for (auto& unknown : plan.intrinsic_unknown) unknown.fill(-1);
  if (!rig.covariance) return;
  const RigCovariance& covariance = *rig.covariance;
  for (int i = 0; i < static_cast<int>(covariance.parameters.size()); ++i) {
    const RigParameter& parameter = covariance.parameters[i];
    if (parameter.index >= kIntrinsics || !(covariance.matrix(i, i) > 0)) continue;
    int unknown = -1;
    for (std::size_t s = 0; s < selection.rows.size() && unknown < 0; ++s) {
      if (MoveAsOne(covariance, i, selection.rows[s])) unknown = static_cast<int>(s);
    }
    if (unknown < 0) {
      unknown = static_cast<int>(selection.rows.size());
      selection.rows.push_back(i);
      selection.parameters.push_back(parameter);
    }
    plan.intrinsic_unknown[parameter.camera][parameter.index] = unknown;
  }
}

void SelectFirstPose(const Rig& rig, PriorPlan& plan, Selection& selection) {
  plan.camera_fixed.assign(rig.cameras.size(), false);
  Selection pose;
  bool known = false;
  for (int index = kIntrinsics; index < RigParameter::kPerCamera; ++index) {
    int row = rig.covariance ? PlaceOf(*rig.covariance, {0, index}) : -1;
    if (row >= 0 && !(rig.covariance->matrix(row, row) > 0)) row = -1;
    known |= row >= 0;
    pose.rows.push_back(row);
    pose.parameters.push_back({0, index});
  }
  plan.camera_fixed[0] = !known;
  if (!known) return;
  selection.rows.insert(selection.rows.end(), pose.rows.begin(), pose.rows.end());
  selection.parameters.insert(selection.parameters.end(), pose.parameters.begin(),
                              pose.parameters.end());
}

Eigen::MatrixXd Select(const Rig& rig, const Selection& selection) {
  const auto size = static_cast<Eigen::Index>(selection.rows.size());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(size, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    for (Eigen::Index j = 0; j < size; ++j) {
      if (selection.rows[i] < 0 || selection.rows[j] < 0) continue;
      matrix(i, j) = rig.covariance->matrix(selection.rows[i], selection.rows[j]);
    }
    if (selection.rows[i] >= 0) continue;
    const double sigma = selection.parameters[i].index < kIntrinsics + 3 ? kFixedRad : kFixedMm;
    matrix(i, i) = sigma * sigma;
  }
  return matrix;
}

void MakeDefinite(Eigen::MatrixXd& covariance) {
  const Eigen::VectorXd sigma = covariance.diagonal().cwiseSqrt();
  const Eigen::VectorXd inverse = sigma.cwiseInverse();
  const Eigen::MatrixXd correlation = inverse.asDiagonal() * covariance * inverse.asDiagonal();
  const double least = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(correlation).eigenvalues()[0];
  if (!(least > kNegative)) {
    throw std::invalid_argument("RefineRig: the rig's covariance is not positive semi-definite");
  }
  if (least >= kLeastEigenvalue) return;
  covariance.diagonal() *= 1 + kLeastEigenvalue - least;
}

}  // namespace

int PlaceOf(const RigCovariance& covariance, const RigParameter& parameter) {
  for (std::size_t i = 0; i < covariance.parameters.size(); ++i) {
    const RigParameter& one = covariance.parameters[i];
    if (one.camera == parameter.camera && one.index == parameter.index) return static_cast<int>(i);
  }
  return -1;
}

PriorPlan PlanPrior(const Rig& rig) {
  PriorPlan plan;
  Selection selection;
  SelectIntrinsics(rig, plan, selection);
  SelectFirstPose(rig, plan, selection);
  if (selection.rows.empty()) return plan;
  plan.prior = BundlePrior{rig.cameras, {selection.parameters, Select(rig, selection)}};
  MakeDefinite(plan.prior->covariance.matrix);
  return plan;
}

}  // namespace stereomotion
